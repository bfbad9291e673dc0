"""Numbers of V-H checks as text: centre and size of each pattern, and the pressure of loaded ones."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.plain import plain
from loaded_tca.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import xarray

    from loaded_tca.flank_maps.vh_check import VHCheck
    from loaded_tca.flanks.base import FlankFrame
    from loaded_tca.results.loaded_pattern import LoadedPattern


def vh_text(check: VHCheck, keys: tuple[str, str]) -> str:
    """Return the numbers of a V-H check as text, a line for each pair of errors; places are those of the picture.

    Parameters
    ----------
    check : VHCheck
    keys : (str, str)
        Names of the errors V and H, which end in their units.
    """
    first = check.patterns[0][0]
    on = f"contact pattern on the {first.gear}, marking compound {plain(1e3 * first.compound)} um, no load"
    rows = [
        (
            *(check.v[i], check.h[j]),
            *(*check.centre[i, j], *check.shift[i, j], *check.size[i, j]),
            100.0 * check.edge_share[i, j],
        )
        for i, j in np.ndindex(check.edge_share.shape)
    ]
    heads = "along", "profile", "along", "profile", "along", "profile", "on edge"
    units = (*("[mm]",) * 6, "[%]")
    above = "centre", "", "shift", "", "size", "", "point"
    edge = "point on edge: part of the pitch in which the unloaded contact point lies on the edge of a flank"
    return _table_of_errors(on, check.frame, keys, (above, heads, units), rows, edge)


def loaded_vh_text(
    study: xarray.Dataset, patterns: Mapping[int, LoadedPattern], frame: FlankFrame, keys: tuple[str, str], on: str
) -> str:
    """Return the numbers of a loaded V-H check as text, a line for each variant that is ok; as ``vh_text``.

    Parameters
    ----------
    study : xarray.Dataset
        Of ``vh_study``.
    patterns : mapping of int to LoadedPattern
        By the numbers of the variants.
    frame : FlankFrame
        How the flank is shown.
    keys : (str, str)
        Names of the errors V and H.
    on : str
        What patterns these are.
    """
    errors = [study[key].values for key in keys]
    rows = [
        (*(float(values[k]) for values in errors), *one.centre, *one.size, one.peak_pressure)
        for k, one in sorted(patterns.items())
    ]
    heads = "along", "profile", "along", "profile", "pressure"
    units = (*("[mm]",) * 4, "[MPa]")
    return _table_of_errors(on, frame, keys, (("centre", "", "size", "", "highest"), heads, units), rows)


def _table_of_errors(
    title: str,
    frame: FlankFrame,
    keys: tuple[str, str],
    heads: Sequence[tuple[str, ...]],
    rows: Iterable[Sequence[float]],
    *more: str,
) -> str:
    """A table over V and H with heads in three lines, what its places are, and lines with more about its columns."""
    errors = (("V", "H"), ("", ""), tuple(f"[{unit_of(key)}]" for key in keys))
    lines = [(*error, *head) for error, head in zip(errors, heads, strict=True)]
    lines += [tuple(_cells(row)) for row in rows]
    about = f"V {keys[0]}, H {keys[1]}", f"along: {frame.labels[0]}; profile: {frame.labels[1]}"
    table = ("".join(f"{cell:>12}" for cell in line).rstrip() for line in lines)
    return "\n".join([title, *about, *more, *table])


def _cells(row: Sequence[float]) -> list[str]:
    """Cells of a line: both errors, and places and whatever else follows with three places."""
    return [plain(value) for value in row[:2]] + ["-" if math.isnan(value) else f"{value:z.3f}" for value in row[2:]]
