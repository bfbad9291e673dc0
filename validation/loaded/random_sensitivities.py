"""Derivatives of random pairs to every key, beside differences of whole analyses with two steps.

Pairs are spur, helical, straight and spiral bevel and face-milled. Analyses on either side place their boxes and grids
anew and scatter by that; what slopes over two steps differ by is the scatter of a comparison. Only those that scatter
by less than 5 % are judged. Every derivative is seen in the size of its figure: a slope that changes it by less than 1
% over the usual tolerance of the key counts as one that does. Load shares of analyses jump by up to 1e-4 as grids are
placed anew, which is 10 % of a usual slope over 0.1 um: their steps are wider. Derivatives of load shares that have a
warning of their own are counted by themselves.
"""

import math
import warnings
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from loaded_tca import AccuracyWarning, analyse
from loaded_tca import warning_kinds as kinds
from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import LoadedTCAError, noted_accuracy_warnings
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.sensitivities import TORQUE, Sensitivities
from loaded_tca.results.tolerances import default_tolerances
from loaded_tca.scene import Scene
from loaded_tca.separation.pair_change import value_at
from loaded_tca.warning_kinds import kind_of
from validation.invariances import of_pairs
from validation.random_scenes import random_scene
from validation.table import Row

CASE, SOURCE = "derivatives of random scenes", "differences of whole analyses with two steps"
SEEDS, ALL_SEEDS = (0, 3, 5, 8), range(20)
"""Seeds of the table are a helical, a spur, a straight bevel and a face-milled pair; teeth of two of them bend."""
GRID = {"positions": 5, "cells": (48, 96), "accuracy": None}
SHARE, WARNED = "load share", "load share, with a warning"
STEPS, STEPS_OF_SHARES = (0.1, 0.2), (1.0, 0.5)
"""Over the usual tolerance of a key: step of the slopes that derivatives are seen beside, and of those that show how
much they scatter."""
LEAST, CLEAN, NEAR = 1e-2, 0.05, 0.05
"""Least size of a slope over the figure, for the usual tolerance of a key; scatter of slopes that are judged; and by
what a derivative is near them; all relative."""
MOST_OFF = {"transmission error": 0.05, SHARE: 0.05}
"""Part of the comparisons that may be farther off. The others are shown: strips of K_Hbeta and slices of peaks and line
loads change over at kinks, and edges cut them (``docs/how_it_works/errors.md``)."""


class Comparison(NamedTuple):
    """A derivative of one figure of a scene beside differences: relative error and scatter, the worst of its places."""

    seed: int
    key: str
    error: float
    scatter: float


def comparisons(seeds: Iterable[int]) -> dict[str, list[Comparison]]:
    """By figure, those of all keys of some scenes."""
    found: dict[str, list[Comparison]] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        for seed in seeds:
            for figure, one in _of_scene(seed):
                found.setdefault(figure, []).append(one)
    return found


def rows() -> list[Row]:
    """Parts of the comparisons that are off, by figure, and the median of all errors."""
    return _rows(SEEDS)


def whole_rows() -> list[Row]:
    """The same of all scenes."""
    return _rows(ALL_SEEDS)


def _rows(seeds: Iterable[int]) -> list[Row]:
    found = []
    for figure, every in comparisons(seeds).items():
        clean = [one for one in every if one.scatter < CLEAN]
        off = [one for one in clean if one.error > NEAR]
        if not clean:
            continue
        worst = max(clean, key=lambda one: one.error)
        note = f"{len(off)} of {len(clean)}; worst {worst.error:.2g}: seed {worst.seed}, {worst.key}"
        quantity = f"{figure}: part farther off than {NEAR:.0%}"
        most = MOST_OFF.get(figure)
        found += [
            Row(CASE, SOURCE, quantity, 0.0, len(off) / len(clean), most, note=note),
            Row(CASE, SOURCE, f"{figure}: median error", 0.0, float(np.median([one.error for one in clean])), None),
        ]
    return found


def _of_scene(seed: int) -> Iterator[tuple[str, Comparison]]:
    """Comparisons of one scene, in turn with teeth that bend and without."""
    scene = random_scene(seed, compliance="contact+tooth" if seed % 2 else "contact", **GRID)
    tolerances = {key: size for key, size in default_tolerances(scene).items() if key != TORQUE}
    result = analyse(scene)
    slopes, base = result.sensitivities([*tolerances]), _figures(result, result.pair)
    for number, (key, tolerance) in enumerate(tolerances.items()):
        try:
            by_steps = {part: _differences(scene, result, key, part * tolerance) for part in (*STEPS, *STEPS_OF_SHARES)}
        except LoadedTCAError:
            continue  # an amount below zero, or a start off the flank
        for figure, own in _slopes(slopes, result, number).items():
            near, far = (by_steps[part][figure] for part in (STEPS_OF_SHARES if figure == SHARE else STEPS))
            if near.shape != own.shape or far.shape != own.shape:
                continue  # another tooth pair comes near
            known = np.isfinite(own) & np.isfinite(near) & np.isfinite(far)
            if not known.any():
                continue
            size = np.ptp(base[figure]) if figure == "transmission error" else np.nanmax(np.abs(base[figure]))
            scale = max(float(np.abs(near[known]).max()), LEAST * float(size) / tolerance)
            error, scatter = (float(np.abs(one - near)[known].max()) / scale for one in (own, far))
            name = WARNED if figure == SHARE and _is_warned_of(result, key) else figure
            yield name, Comparison(seed, key, error, scatter)


def _is_warned_of(result: MeshCycle, key: str) -> bool:
    """Whether derivatives of load shares by a key have a warning of their own."""
    slopes = result.sensitivities([key])
    with noted_accuracy_warnings(given=False) as sentences:
        assert slopes.load_share.size
    return any(kind_of(sentence) in (kinds.SHARES_BY_GRIDS, kinds.PAIR_LEAVES) for sentence in sentences)


def _differences(scene: Scene, result: MeshCycle, key: str, step: float) -> dict[str, Array]:
    """Slopes of the figures of the tooth pairs of a result between analyses a step of a key to either side."""
    value = value_at(scene, key)
    low, high = (_figures(analyse(scene.with_changes({key: value + by})), result.pair) for by in (-step, step))
    return {
        name: (high[name] - low[name]) / (2.0 * step) if high[name].shape == low[name].shape else np.full(1, math.nan)
        for name in low
    }


def _figures(result: MeshCycle, pairs: Indices) -> dict[str, Array]:
    """Figures of a result, load shares those of tooth pairs of these numbers."""
    error = result.transmission_error[0]
    return {
        "transmission error": error,
        "peak to peak": np.array([np.ptp(error)]),
        SHARE: of_pairs(result, "load_share", pairs)[0],
        "K_Hbeta": result.face_load_factor[:1],
        "peak pressure": result.peak_pressure[0],
        "line load": result.line_load[0],
    }


def _slopes(slopes: Sensitivities, result: MeshCycle, key: int) -> dict[str, Array]:
    assert result.transmission_error.shape[0] == 1
    return {
        "transmission error": slopes.transmission_error[0, :, key],
        "peak to peak": slopes.peak_to_peak[:1, key],
        SHARE: slopes.load_share[0, ..., key],
        "K_Hbeta": slopes.face_load_factor[:1, key],
        "peak pressure": slopes.peak_pressure[0, ..., key],
        "line load": slopes.line_load[0, ..., key],
    }
