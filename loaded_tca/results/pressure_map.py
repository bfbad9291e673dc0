"""Pressure and gap of one tooth pair at one position on their grid, and how they are laid out in a file.

Edges in a pressure map: cells beside the end of a flank or on the arc of a rounded edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.edges.places import dilated, edge_distances
from loaded_tca.errors import InputError
from loaded_tca.results.quantities import LAID_END_TO_END, MAP_CELLS, MAP_LOADS, MAP_PARTS, SIZES
from loaded_tca.separation.arcs import arcs_beside
from loaded_tca.separation.flank_places import FlankPlaces

if TYPE_CHECKING:
    from collections.abc import Mapping

    from loaded_tca.arrays import Array, Mask
    from loaded_tca.pairs.gear_pair import GearPair


@dataclass(frozen=True, eq=False)
class PressureMap:
    """Pressure and gap of one tooth pair at one position on its grid.

    Attributes
    ----------
    x, y : (nx,), (ny,) array [mm]
        Cell centres across (largest relative curvature) and along the contact, from the contact point.
    spacing : (float, float) [mm]
        Cell sizes (dx, dy).
    pressure : (nx, ny) array [MPa]
        The mean over the whole cell where an edge of a flank cuts it: force = pressure.sum() dx dy.
    gap : (nx, ny) array [mm]
        Deformed gap in the middles of the cells; +inf where a flank ends before it.
    cover : (nx, ny) array
        Part of every cell that has material, from 0 to 1.
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        x, y and the normal out of the pinion, in rows, in the fixed frame.
    force_line : (ny,) array [mm]
        Where across the contact the force of every slice bends the teeth: the centre of its pressure.
    strip_force : (2, 30) array or None [N]
        Force in every strip of the common face, ascending along the pinion's lengthwise coordinate, where the contact
        ends on the arc of a rounded edge, which the cells of the map do not resolve: on columns graded towards the arc,
        and on coarser ones. None: it is that of the cells.
    """

    x: Array
    y: Array
    spacing: tuple[float, float]
    pressure: Array
    gap: Array
    cover: Array
    origin: Array
    axes: Array
    force_line: Array
    strip_force: Array | None = None

    @property
    def borders(self) -> tuple[Array, Array]:
        """Borders of the cells across (nx + 1,) and along the contact (ny + 1,), from the contact point [mm]."""
        dx, dy = self.spacing
        return np.append(self.x, self.x[-1] + dx) - 0.5 * dx, np.append(self.y, self.y[-1] + dy) - 0.5 * dy

    @property
    def slice_force(self) -> Array:
        """Normal force of the cells at each place along the contact (ny,) [N]."""
        return np.asarray(self.pressure.sum(axis=0) * math.prod(self.spacing))

    @property
    def mean_pressure(self) -> float:
        """Mean pressure [MPa] of the cells under pressure, those beside edges among them."""
        return mean_pressure_of(self.pressure)

    @property
    def points(self) -> Array:
        """Cell centres (nx, ny, 3) in the tangent plane, in the fixed frame [mm]."""
        return self.origin + self.x[:, None, None] * self.axes[0] + self.y[:, None] * self.axes[1]

    @property
    def corners(self) -> Array:
        """Corners (nx + 1, ny + 1, 3) of the cells in the tangent plane, in the fixed frame [mm]."""
        x, y = self.borders
        return self.origin + x[:, None, None] * self.axes[0] + y[:, None] * self.axes[1]

    @cached_property
    def beside_end(self) -> Mask:
        """Cells (nx, ny) beside the end of the material or of the grid, or beyond that of the material."""
        beyond = np.pad(np.isinf(self.gap), 1, constant_values=True)
        return dilated(beyond)[1:-1, 1:-1]

    def near_end(self, distance: float) -> Mask:
        """Cells (nx, ny) beside the end of the material or of the grid, or within a distance [mm] of the material's."""
        there = np.isfinite(self.gap)
        if there.all():
            return self.beside_end
        from scipy.ndimage import distance_transform_edt  # which checks of scenes do not need

        away = np.asarray(distance_transform_edt(there, sampling=self.spacing))
        return np.asarray(self.beside_end | (away < distance))

    @cached_property
    def edge_cell(self) -> tuple[int, int]:
        """Indices of the cell with the largest pressure of those beside the end of the material or of the grid."""
        beside = np.where(self.beside_end, self.pressure, -1.0)
        across, along = np.unravel_index(int(beside.argmax()), beside.shape)
        return int(across), int(along)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Radius and axial coordinate on the pinion [mm] of a point of the tangent plane."""
        point = self.origin + x * self.axes[0] + y * self.axes[1]
        return math.hypot(point[0], point[1]), float(point[2])

    def flank_ends_within(self, distance: float) -> bool:
        """Whether a cell without material, its edges counted, lies nearer to the contact point than a distance [mm]."""
        return self._end_of_flank < distance

    @cached_property
    def _end_of_flank(self) -> float:
        """Distance [mm] from the contact point to the nearest cell without material; infinite without one."""
        x, y = (
            np.maximum(np.abs(centres) - 0.5 * step, 0.0)
            for centres, step in zip((self.x, self.y), self.spacing, strict=True)
        )
        return float(np.hypot(x[:, None], y)[np.isinf(self.gap)].min(initial=math.inf))


def mean_pressure_of(pressure: Array) -> float:
    """Mean pressure [MPa] of the cells of a grid that are under pressure; 0 where none is."""
    under = int(np.count_nonzero(pressure))
    return float(pressure.sum()) / under if under else 0.0


Maps = tuple[tuple[tuple[PressureMap | None, ...], ...], ...]
"""By torque, position and tooth pair; None where a pair carries nothing."""


def arrays_of_maps(maps: Maps) -> dict[str, Array]:
    """Arrays of files that hold all maps: grids end to end, the rest by torque, position and pair."""
    shape = len(maps), len(maps[0]), len(maps[0][0])
    present = [((t, n, k), one) for t, n, k in np.ndindex(shape) if (one := maps[t][n][k]) is not None]
    arrays = {name: np.zeros(shape, dtype=int) for name in MAP_CELLS}
    for place, one in present:
        for cells, length in zip(arrays.values(), one.pressure.shape, strict=True):
            cells[place] = length
    for name, (own, _, _) in MAP_PARTS.items():
        parts = [np.asarray(getattr(one, name)) for _, one in present]
        if own in LAID_END_TO_END:
            arrays[f"map_{name}"] = np.concatenate([np.empty(0), *map(np.ravel, parts)])
        else:
            stack = arrays[f"map_{name}"] = np.full((*shape, *(SIZES[axis] for axis in own)), np.nan)
            for (place, _), part in zip(present, parts, strict=True):
                stack[place] = part
    for name, (own, _, _) in MAP_LOADS.items():
        loads = {place: load for place, one in present if (load := getattr(one, name)) is not None}
        if loads:
            stack = arrays[f"map_{name}"] = np.full((*shape, *(SIZES[axis] for axis in own)), np.nan)
            for place, load in loads.items():
                stack[place] = load
    return arrays


def maps_from(arrays: Mapping[str, Array]) -> Maps:
    """Take the maps out of what ``arrays_of_maps`` made of them.

    Raises
    ------
    InputError
        If there are more or fewer values than the cells of all maps.
    """
    counts = np.stack([arrays[name] for name in MAP_CELLS], axis=-1)
    lengths = {("across",): counts[..., 0], ("along",): counts[..., 1], ("across", "along"): counts.prod(axis=-1)}
    ends = {own: np.cumsum(length).reshape(length.shape) for own, length in lengths.items()}
    problems = [
        f"map_{name}: {arrays[f'map_{name}'].size} values, expected {ends[own][-1, -1, -1]} of all maps together"
        for name, (own, _, _) in MAP_PARTS.items()
        if own in ends and arrays[f"map_{name}"].size != ends[own][-1, -1, -1]
    ]
    if problems or (counts < 0).any():
        raise InputError(problems or "map_cells: negative")

    def at(place: tuple[int, int, int]) -> PressureMap | None:
        shape = {"across": int(counts[place][0]), "along": int(counts[place][1])}
        if not all(shape.values()):
            return None
        parts: dict[str, Any] = {}
        for name, (own, _, _) in MAP_PARTS.items():
            values = arrays[f"map_{name}"]
            if own in ends:
                end = int(ends[own][place])
                values = values[end - int(lengths[own][place]) : end].reshape([shape[axis] for axis in own])
            else:
                values = values[place]
            parts[name] = values
        for name in MAP_LOADS.keys() & {key.removeprefix("map_") for key in arrays}:
            if np.isfinite(load := arrays[f"map_{name}"][place]).all():
                parts[name] = load
        dx, dy = parts["spacing"].tolist()
        return PressureMap(**{**parts, "spacing": (dx, dy)})

    torques, positions, pairs = (range(length) for length in counts.shape[:3])
    return tuple(tuple(tuple(at((t, n, k)) for k in pairs) for n in positions) for t in torques)


def arc_cells(pair: GearPair, one: PressureMap) -> Mask:
    """Cells (nx, ny, 8) beside those of a map that bound its pressure on the arc of each edge of both flanks."""
    return dilated(arcs_beside(pair, one, one.pressure > 0.0))


def sharp_edge_cell(pair: GearPair, one: PressureMap) -> tuple[int, int]:
    """Indices of the cell with the largest pressure of those beside the end of the material, but not beside an arc."""
    if pair.sharp is pair:
        return one.edge_cell
    sharp = one.beside_end & ~arc_cells(pair, one).any(axis=-1)
    across, along = np.unravel_index(int(np.where(sharp, one.pressure, -1.0).argmax()), sharp.shape)
    return int(across), int(along)


def place_on_material(pair: GearPair, one: PressureMap, cell: tuple[int, int]) -> tuple[float, float]:
    """Middle of a cell from the contact point [mm]; where that lies beyond an edge, the edge beside it.

    That is where the way from the middle of the nearest cell with material leaves both flanks; their distances to the
    edges are straight over the width of a cell.
    """
    across, along = cell
    middle, there = np.array([one.x[across], one.y[along]]), np.argwhere(np.isfinite(one.gap))
    if np.isfinite(one.gap[cell]) or not there.size:
        return float(middle[0]), float(middle[1])
    inner = np.stack([one.x[there[:, 0]], one.y[there[:, 1]]], axis=-1)
    ends = np.stack([inner[np.hypot(*(inner - middle).T).argmin()], middle])
    within, beyond = edge_distances(pair, *FlankPlaces(pair, one).at(*ends.T))
    crossed = (beyond < 0.0) & (within >= 0.0)
    part = float(np.min(within[crossed] / (within - beyond)[crossed], initial=1.0))
    x, y = (ends[0] + part * (ends[1] - ends[0])).tolist()
    return x, y
