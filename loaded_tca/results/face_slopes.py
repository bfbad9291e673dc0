"""Derivatives of K_Hbeta by the forces of the cells, the motions of the grids and of the common face.

They are those of the forces in strips that cells have, also where the forces of a result are those of columns.

Where derivatives hold less than elsewhere: marks of contacts, sizes of kinks, and the warnings of both.

Each has a size: of marks how many of the derivatives of random scenes are off there, by how much
(``docs/how_it_works/sensitivities.md``); of kinks what derivatives on the other side are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.contact.patch import top_weights
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.results.figure_slopes import line_load_slopes
from loaded_tca.results.load_factors import (
    STRIPS,
    error_beside_arcs,
    face_ends,
    face_forces,
    strip_motions,
    strip_shares,
)
from loaded_tca.results.slice_pressure import InnerPeak, SlicePeak
from loaded_tca.separation.pair_change import AT_ONE_PLACE, PairChange
from loaded_tca.units import ending_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from loaded_tca.arrays import Array, Indices, Mask
    from loaded_tca.loaded.loaded_grid import LoadedGrid
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.results.pressure_map import PressureMap
    from loaded_tca.unloaded import ContactPath

AS_LARGE, BESIDE = 1e-2, 5e-4
"""Relative difference of the forces of two strips of the face up to which a kink of K_Hbeta is near; and of a strip
beside the largest one, which follows it, but where both are as far from the top."""


def face_load_factor_changes(
    result: CycleNumbers,
    places: Indices,
    grids: Sequence[LoadedGrid],
    motions: Array,
    common_face: Array,
    strips: Sequence[int | None],
) -> tuple[list[Array], Array]:
    """Derivatives of the face load factor of one strip under each torque by forces, and its growth by motions.

    Parameters
    ----------
    result : MeshCycle
    places : (3, grids) int array
        Torque, position and pair of each grid.
    grids : sequence of LoadedGrid
    motions : (keys, grids, 6) array
        Of the grids.
    common_face : (keys, 2) array [mm per unit]
        Motions of its lower and the upper end.
    strips : sequence of int or None
        Strip by torque; None: that with the largest force.

    Returns
    -------
    slopes : list of (nx, ny) arrays [1/N]
        On each grid.
    by_motion : (torque, key) array [1 per unit]
        As grids and the ends of the common face move, forces held; NaN with one position.
    """
    rows = [(result.gear_pair, result.path, maps, strip) for maps, strip in zip(result.maps, strips, strict=True)]
    of_maps, of_motions = (
        [derivative(*row) for row in rows] for derivative in (face_load_factor_slopes, face_load_factor_motions)
    )
    by_motion = np.zeros((len(result.torque), len(motions)))
    by_motion[~np.isfinite(result.face_load_factor)] = np.nan
    slopes = []
    for i, ((t, n, k), grid) in enumerate(zip(places.T.tolist(), grids, strict=True)):
        own = of_maps[t][n][k]
        slopes.append(np.zeros(grid.active.shape) if own is None else own)
        if (moved := of_motions[t][n][k]) is not None:
            by_motion[t] += motions[:, i] @ moved[:6] + common_face @ moved[6:]
    return slopes, by_motion


def common_face_motions(result: CycleNumbers, changes: Sequence[PairChange | None]) -> tuple[Array, Array]:
    """Motions of the ends of the common face with keys, and their kinks.

    Parameters
    ----------
    result : MeshCycle
    changes : sequence of PairChange or None
        None of keys that change no gears.

    Returns
    -------
    motions, kinks : (keys, 2) array [mm per unit]
        Of the lower and the upper end: the mean of both sides of a key, and by growing values less that by falling
        ones, where the faces of both gears end at one place.
    """
    ends = face_ends(result.gear_pair, result.path)
    width = float(ends[:, 1].min() - ends[:, 0].max()) / STRIPS
    at_one_place = np.abs(ends[1] - ends[0]) < AT_ONE_PLACE * width
    ruling = [ends[:, 0].argmax(), ends[:, 1].argmin()], [0, 1]
    motions, kinks = np.zeros((2, len(changes), 2))
    for key, change in enumerate(changes):
        if change is not None and not change.of_modifications:
            low, high = (face_ends(side, result.path) for side in (change.below, change.above))
            by_gear = (high - low) / change.difference
            motions[key] = np.where(at_one_place, by_gear.mean(axis=0), by_gear[ruling])
            kinks[key] = np.where(at_one_place, np.abs(by_gear[1] - by_gear[0]), 0.0) * [1.0, -1.0]
    return motions, kinks


def face_load_factor_slopes(
    pair: GearPair,
    path: ContactPath,
    positions: Sequence[Sequence[PressureMap | None]],
    strip: int | None = None,
) -> list[list[Array | None]]:
    """Derivatives of K_Hbeta under one torque by the forces of the cells of all positions and tooth pairs.

    The strip with the largest force is held.

    Parameters
    ----------
    pair : GearPair
    path : ContactPath
        Unloaded contact, of n positions.
    positions : sequence of sequences
        Pressure maps by n positions and tooth pairs.
    strip : int, optional
        Taken for that with the largest force.

    Returns
    -------
    list of lists of (nx, ny) arrays [1/N]
        By position and tooth pair, zero at cells without pressure. None where K_Hbeta does not depend on a pair: it has
        no map, or the position is the last one; everywhere if K_Hbeta itself is NaN, for one position and without load.
    """

    def slopes(one: PressureMap, borders: Array, forces: Array) -> Array:
        largest, total = int(forces.argmax()) if strip is None else strip, float(forces.sum())
        shares, by_cell = strip_shares(pair, one, borders)[0][largest], np.zeros(one.pressure.shape)
        by_cell[one.pressure > 0.0] = (STRIPS * shares - STRIPS * forces[largest] / total) / total
        return by_cell

    return _of_maps(pair, path, positions, slopes)


def face_load_factor_motions(
    pair: GearPair,
    path: ContactPath,
    positions: Sequence[Sequence[PressureMap | None]],
    strip: int | None = None,
) -> list[list[Array | None]]:
    """Derivatives of K_Hbeta under one torque by the motions of the grids and of the common face, the forces held.

    Parameters
    ----------
    pair, path, positions, strip
        As of :func:`face_load_factor_slopes`.

    Returns
    -------
    list of lists of (8,) arrays
        By the motions of the grid as of :class:`loaded_tca.separation.gap_change.MovedContacts`, and by those of the
        lower and the upper end of the common face [1/mm]. None as there.
    """

    def motions(one: PressureMap, borders: Array, forces: Array) -> Array:
        largest = int(forces.argmax()) if strip is None else strip
        return strip_motions(pair, one, borders, largest) * (STRIPS / float(forces.sum()))

    return _of_maps(pair, path, positions, motions)


def _of_maps(
    pair: GearPair,
    path: ContactPath,
    positions: Sequence[Sequence[PressureMap | None]],
    derivative: Callable[[PressureMap, Array, Array], Array],
) -> list[list[Array | None]]:
    """A derivative of K_Hbeta by every map, of the map, the borders of the strips and their forces; None without."""
    borders, forces = face_forces(pair, path, positions, by_cells=True)
    by_map: list[list[Array | None]] = [[None] * len(row) for row in positions]
    for n, row in enumerate(positions[:-1] if forces.any() else ()):
        by_map[n] = [None if one is None else derivative(one, borders, forces) for one in row]
    return by_map


def rival_strip(
    pair: GearPair, path: ContactPath, positions: Sequence[Sequence[PressureMap | None]]
) -> tuple[int, float] | None:
    """Strip of the face that carries nearly as much as the one that sets K_Hbeta, and what it lacks, relative.

    Another top of the forces along the face within 1 %, or a strip beside the largest one within 0.05 %: what is beside
    it is followed, but of the two in the middle of an aligned pair either may be the larger one.

    Parameters
    ----------
    pair : GearPair
    path : ContactPath
        Unloaded contact, of n positions.
    positions : sequence of sequences
        Pressure maps by n positions and tooth pairs.

    Returns
    -------
    (int, float) or None
        The largest such strip; None if there is none.
    """
    _, forces = face_forces(pair, path, positions, by_cells=True)
    largest = int(forces.argmax())
    ends = np.concatenate([[-np.inf], forces, [-np.inf]])
    lacking = 1.0 - forces / (forces[largest] or 1.0)
    beside = np.abs(np.arange(STRIPS) - largest) <= 1
    rivals = np.where(beside, lacking <= BESIDE, (forces >= ends[:-2]) & (forces >= ends[2:]) & (lacking <= AS_LARGE))
    rivals[largest] = False
    if not rivals.any():
        return None
    rival = int(np.where(rivals, forces, -np.inf).argmax())
    return rival, float(lacking[rival])


def top_strips(result: CycleNumbers) -> list[tuple[list[int], Array]]:
    """Strips beside the largest one on both sides and that one (torque,), with their weights in a parabola's top.

    Where the largest strip lies at an end of the face, or nothing is loaded, it has all the weight.
    """
    count = len(result.torque)
    largest, weights = np.ones(count, dtype=int), np.tile([[0.0], [1.0], [0.0]], count)
    for torque, rows in enumerate(result.maps):
        forces = face_forces(result.gear_pair, result.path, rows, by_cells=True)[1]
        top = int(forces.argmax())
        if 0 < top < STRIPS - 1:
            weights[:, torque] = top_weights(forces[top - 1 : top + 2])
            largest[torque] = top
        else:
            largest[torque] = min(max(top, 1), STRIPS - 2)
            weights[:, torque] = np.eye(3)[top - largest[torque] + 1]
    return [((largest + beside).tolist(), weights[beside + 1]) for beside in (-1, 0, 1)]


TOLD = 0.05
"""Part of a derivative from which on a kink is told."""
TOLD_BESIDE = 0.1
"""The same of that through three strips: differences of analyses scatter by as much."""
LEVEL = 1e-6
"""Relative difference of derivatives between positions that is none."""
LITTLE = 0.05
"""Share of the torque below which a pair has only just come under load."""


def largest_cut(grids: Sequence[LoadedGrid]) -> list[bool]:
    """Whether an edge cuts the slices with the largest line load of each grid."""
    return [_cut(grid, np.asarray(line_load_slopes(grid.pressure, grid.problem.spacing).any(axis=0))) for grid in grids]


def peak_cut(grids: Sequence[LoadedGrid], peaks: Sequence[SlicePeak | InnerPeak | None]) -> list[bool]:
    """Whether an edge cuts the slices over which the peak pressure of each grid is averaged, or those beside them."""
    marks = []
    for grid, peak in zip(grids, peaks, strict=True):
        if cut := isinstance(peak, SlicePeak):
            borders, reach = peak.slices.borders, 0.5 * peak.slices.length + peak.slices.step
            cut = _cut(grid, (borders[1:] > peak.place[1] - reach) & (borders[:-1] < peak.place[1] + reach))
        marks.append(cut)
    return marks


def _cut(grid: LoadedGrid, slices: Mask) -> bool:
    """Whether an edge cuts cells under pressure of some slices (ny,) of a grid."""
    return bool(((grid.separation.cover < 1.0) & (grid.pressure > 0.0))[:, slices].any())


def warn_of_strips(keys: Sequence[str], slopes: Array, kinks: Array, lacking: Sequence[float]) -> None:
    """Tell which derivatives (torque, key) of K_Hbeta are others where another strip has the largest force.

    ``kinks``: the derivative there less that here; ``lacking``: what the other strip lacks under each torque.
    """
    sizes = np.abs(kinks) / np.maximum(np.abs(slopes), np.abs(slopes + kinks)).clip(min=np.finfo(float).tiny)
    worst = np.nan_to_num(sizes).max(axis=0, initial=0.0)
    if (worst > TOLD).any():
        own = int(worst.argmax())
        words = {"key": keys[own], "count": np.count_nonzero(worst > TOLD), "keys": len(keys)}
        sentence = kinds.STRIPS_ALIKE.sentence(lacking=min(lacking), size=worst[own], **words)
        give_accuracy_warning(sentence)


def warn_of_strips_beside(keys: Sequence[str], slopes: Array, through_three: Array) -> None:
    """Tell which derivatives (torque, key) of K_Hbeta are others than those through the strips beside the largest."""
    sizes = np.abs(through_three - slopes) / np.maximum(np.abs(slopes), np.abs(through_three)).clip(
        min=np.finfo(float).tiny
    )
    worst = np.nan_to_num(sizes).max(axis=0, initial=0.0)
    if (worst > TOLD_BESIDE).any():
        own = int(worst.argmax())
        torque = int(np.nan_to_num(sizes[:, own]).argmax())
        words = {"key": keys[own], "count": np.count_nonzero(worst > TOLD_BESIDE), "keys": len(keys)}
        pair = {"slope": slopes[torque, own], "other": through_three[torque, own], "unit": ending_of(keys[own])}
        give_accuracy_warning(kinds.STRIPS_BESIDE.sentence(**words, **pair))


def warn_of_edges(keys: Sequence[str], slopes: Array, kinks: Array, length: float) -> None:
    """Tell which derivatives (torque, position, key) of the transmission error have a kink where edges coincide.

    Of the size of what the derivative differs between positions, which is what figures are made of; ``length`` [um/rad]
    by which it is told.
    """
    _warn_beside_spread(kinds.EDGES_AT_ONE_PLACE, keys, slopes, kinks, length)


def warn_of_grids(keys: Sequence[str], slopes: Array, by_grids: Array, length: float) -> None:
    """Tell which derivatives of the transmission error depend on the grids by ``by_grids``, likewise."""
    _warn_beside_spread(kinds.SLOPES_BY_GRIDS, keys, slopes, by_grids, length)


def _warn_beside_spread(kind: kinds.Kind, keys: Sequence[str], slopes: Array, parts: Array, length: float) -> None:
    loaded = np.isfinite(slopes).any(axis=(1, 2))
    slopes, parts = slopes[loaded], parts[loaded]
    over_positions = np.nanmax(slopes, axis=1) - np.nanmin(slopes, axis=1)
    largest = np.nanmax(np.abs(slopes), axis=1)
    scale = np.where(over_positions > LEVEL * largest, over_positions, largest)
    sizes = np.abs(parts).max(axis=1)
    above = (sizes > TOLD * scale).any(axis=0)
    if above.any():
        own = int(np.where(above, sizes.max(axis=0), -1.0).argmax())
        size, unit = length * float(sizes[:, own].max()), keys[own].rpartition("_")[2]
        counted = {"key": keys[own], "count": np.count_nonzero(above), "keys": len(keys)}
        give_accuracy_warning(kind.sentence(size=size, unit=unit, **counted))


def warn_of_face_ends(keys: Sequence[str], slopes: Array, kinks: Array) -> None:
    """Tell which derivatives (torque, key) of K_Hbeta are others by growing values than by falling ones."""
    sides = np.stack([slopes - 0.5 * kinks, slopes + 0.5 * kinks])
    sizes = np.nan_to_num(np.abs(kinks) / np.abs(sides).max(axis=0).clip(min=np.finfo(float).tiny))
    above = (sizes > TOLD).any(axis=0)
    if above.any():
        torque, own = (int(place) for place in np.unravel_index(int(sizes.argmax()), sizes.shape))
        falling, growing = sides[:, torque, own]
        counted = {"key": keys[own], "count": np.count_nonzero(above), "keys": len(keys)}
        unit = keys[own].rpartition("_")[2]
        sentence = kinds.FACE_ENDS_AT_ONE_PLACE.sentence(falling=falling, growing=growing, unit=unit, **counted)
        give_accuracy_warning(sentence)


def warn_of_end_strips(result: CycleNumbers, keys: Sequence[str], motions: Array, kinks: Array) -> None:
    """Tell where K_Hbeta is that of a strip at an end of the common face which goes with a key.

    ``motions`` and ``kinks`` are those of :func:`common_face_motions`. Where the faces of both gears end at one place
    :func:`warn_of_face_ends` tells it.
    """
    moved = np.where(kinks == 0.0, motions, 0.0) != 0.0
    strips = [
        int(face_forces(result.gear_pair, result.path, rows, by_cells=True)[1].argmax())
        for rows, known in zip(result.maps, np.isfinite(result.face_load_factor).tolist(), strict=True)
        if known
    ]
    at_end = moved @ np.array([0 in strips, STRIPS - 1 in strips])
    if at_end.any():
        first = keys[int(at_end.argmax())]
        counted = {"key": first, "count": np.count_nonzero(at_end), "keys": len(keys)}
        give_accuracy_warning(kinds.FACE_END_IN_LOAD.sentence(**counted))


def warn_of_arcs(result: CycleNumbers, keys: Sequence[str], slopes: Array) -> None:
    """Tell where derivatives (torque, key) of K_Hbeta rest on contacts that end on the arc of an end of the face."""
    errors = np.array([error_beside_arcs(result.gear_pair, result.path, rows) for rows in result.maps])
    moved = (np.nan_to_num(slopes)[errors > TOLD] != 0.0).any(axis=0)
    if moved.any():
        counted = {"key": keys[int(moved.argmax())], "count": np.count_nonzero(moved), "keys": len(keys)}
        give_accuracy_warning(kinds.ARC_IN_LOAD.sentence(error=float(errors.max()), **counted))
