"""Where derivatives hold less than elsewhere: marks of contacts, sizes of kinks, and the warnings of both.

Each has a size: of marks how many of the derivatives of random scenes are off there, by how much
(``docs/how_it_works/sensitivities.md``); of kinks what derivatives on the other side are.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import Array, Mask
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.loaded.sensitivity import LoadedGrid
from loaded_tca.results.figure_slopes import line_load_slopes
from loaded_tca.results.slice_pressure import SlicePeak

TOLD = 0.05
"""Part of a derivative from which on a kink is told."""
LEVEL = 1e-6
"""Relative difference of derivatives between positions that is none."""
LITTLE = 0.05
"""Share of the torque below which a pair has only just come under load."""


def largest_cut(grids: Sequence[LoadedGrid]) -> list[bool]:
    """Whether an edge cuts the slices with the largest line load of each grid."""
    return [_cut(grid, np.asarray(line_load_slopes(grid.pressure, grid.problem.spacing).any(axis=0))) for grid in grids]


def peak_cut(grids: Sequence[LoadedGrid], peaks: Sequence[SlicePeak | None]) -> list[bool]:
    """Whether an edge cuts the slices over which the peak pressure of each grid is averaged, or those beside them."""
    found = []
    for grid, peak in zip(grids, peaks, strict=True):
        if cut := peak is not None:
            borders, reach = peak.slices.borders, 0.5 * peak.slices.length + peak.slices.step
            cut = _cut(grid, (borders[1:] > peak.place[1] - reach) & (borders[:-1] < peak.place[1] + reach))
        found.append(cut)
    return found


def _cut(grid: LoadedGrid, slices: Mask) -> bool:
    """Whether an edge cuts cells under pressure of some slices (ny,) of a grid."""
    return bool(((grid.separation.cover < 1.0) & (grid.pressure > 0.0))[:, slices].any())


def warn_of_strips(keys: Sequence[str], slopes: Array, kinks: Array, lacking: Sequence[float], stacklevel: int) -> None:
    """Tell which derivatives (torque, key) of K_Hbeta are others where another strip has the largest force.

    ``kinks``: the derivative there less that here; ``lacking``: what the other strip lacks under each torque.
    """
    sizes = np.abs(kinks) / np.maximum(np.abs(slopes), np.abs(slopes + kinks)).clip(min=np.finfo(float).tiny)
    worst = np.nan_to_num(sizes).max(axis=0, initial=0.0)
    if (worst > TOLD).any():
        own = int(worst.argmax())
        told = {"key": keys[own], "count": np.count_nonzero(worst > TOLD), "keys": len(keys)}
        sentence = kinds.STRIPS_ALIKE.sentence(lacking=min(lacking), size=worst[own], **told)
        give_accuracy_warning(sentence, stacklevel=stacklevel + 1)


def warn_of_edges(keys: Sequence[str], slopes: Array, kinks: Array, length: float, stacklevel: int) -> None:
    """Tell which derivatives (torque, position, key) of the transmission error have a kink where edges coincide.

    Of the size of what the derivative differs between positions, which is what figures are made of; ``length`` [um/rad]
    by which it is told.
    """
    loaded = np.isfinite(slopes).any(axis=(1, 2))
    slopes, kinks = slopes[loaded], kinks[loaded]
    over_positions = np.nanmax(slopes, axis=1) - np.nanmin(slopes, axis=1)
    largest = np.nanmax(np.abs(slopes), axis=1)
    scale = np.where(over_positions > LEVEL * largest, over_positions, largest)
    sizes = np.abs(kinks).max(axis=1)
    told = (sizes > TOLD * scale).any(axis=0)
    if told.any():
        own = int(np.where(told, sizes.max(axis=0), -1.0).argmax())
        size, unit = length * float(sizes[:, own].max()), keys[own].rpartition("_")[2]
        counted = {"key": keys[own], "count": np.count_nonzero(told), "keys": len(keys)}
        sentence = kinds.EDGES_AT_ONE_PLACE.sentence(size=size, unit=unit, **counted)
        give_accuracy_warning(sentence, stacklevel=stacklevel + 1)
