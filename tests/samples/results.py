"""Small results that the tests of files, tables and pictures share, and what makes two results the same."""

import warnings
from dataclasses import fields, is_dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import xarray
from numpy.testing import assert_array_equal

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.results.quantities import CYCLE, PAIRS, QUANTITIES
from loaded_tca.scene import Scene, read_scene
from tests.samples.shared import made_once

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
FLANKS_ALONE = {"analysis.compliance": "contact", "analysis.free_edges": False}
"""Half-spaces: nothing but the contact, as Hertz has it."""
ONE_PAIR = {**FLANKS_ALONE, "analysis.load_sharing": False}
"""And one tooth pair that carries the whole load."""
PER_POSITION, PER_PAIR = ([name for name, (axes, *_) in QUANTITIES.items() if axes == one] for one in (CYCLE, PAIRS))


@made_once
def result(name="helical", positions=5, torques=None, title=None):
    """Analysis of an example scene on a coarse grid, of half-spaces; the load is shared in mesh cycles alone."""
    changes = {
        **(FLANKS_ALONE if name.startswith("mesh_cycle") else ONE_PAIR),
        "analysis.positions": positions,
        "analysis.accuracy": None,
        "analysis.cells": (20, 24),
        "analysis.torques_Nm": torques,
    }
    if title is not None:
        changes["title"] = title
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # edge contacts are wanted here
        return analyse(read_scene(SCENES / f"{name}.toml").with_changes(changes))


@cache
def with_a_gap():
    """A result whose second position does not touch, and whose last map is smaller than the others."""
    whole = result(torques=(20.0, 80.0))
    numbers = {name: _blanked(getattr(whole, name), np.s_[:, 1]) for name in (*PER_POSITION, *PER_PAIR)}
    numbers["unloaded_transmission_error"] = _blanked(whole.unloaded_transmission_error, 1)
    path = {
        entry.name: _blanked(getattr(whole.path, entry.name), 1)
        for entry in fields(whole.path)
        if entry.name != "pinion_angle"
    }
    small = whole.maps[0][-1][0]
    small = replace(small, x=small.x[4:-4], pressure=small.pressure[4:-4], gap=small.gap[4:-4], cover=small.cover[4:-4])
    maps = tuple((row[0], (None,), *row[2:-1], (small,)) for row in whole.maps)
    path = replace(whole.path, **path)
    return replace(changed(whole, **numbers), path=path, paths=(path,), maps=maps)


def changed(cycle, **numbers):
    """The result with other arrays in its dataset."""
    variables = {name: cycle.dataset[name].copy(data=np.asarray(values)) for name, values in numbers.items()}
    return replace(cycle, dataset=cycle.dataset.assign(variables))


def changed_scene(cycle, changes):
    """The result with other values in its scene."""
    return replace(cycle, scene=cycle.scene.with_changes(changes))


def _blanked(values, place):
    values = values.copy()
    values[place] = np.nan if values.dtype.kind == "f" else 0
    return values


def assert_same(first, second):
    """Equal to the last bit, arrays of the same type, NaN where NaN is."""
    if isinstance(first, xarray.Dataset):
        xarray.testing.assert_identical(first, second)
        assert {name: one.dtype for name, one in first.variables.items()} == {
            name: one.dtype for name, one in second.variables.items()
        }
    elif isinstance(first, Scene):
        assert first == second
    elif is_dataclass(first):
        assert type(first) is type(second)
        for entry in (entry for entry in fields(first) if entry.compare):
            assert_same(getattr(first, entry.name), getattr(second, entry.name))
    elif isinstance(first, tuple):
        assert len(first) == len(second)
        for one, other in zip(first, second, strict=True):
            assert_same(one, other)
    elif isinstance(first, np.ndarray):
        assert first.dtype == second.dtype
        assert_array_equal(first, second, strict=True)  # exact: copied, or read from a file that keeps every digit
    else:
        assert first == second or (first != first and second != second)  # NaN is the same as NaN
