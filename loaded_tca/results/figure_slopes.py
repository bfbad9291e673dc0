"""Derivatives of the figures of a contact by the forces of its cells: what sensitivities need of each figure.

The force of a cell is its pressure times dx dy, also where an edge of a flank cuts it. Every derivative is an array on
the grid (nx, ny); it counts for cells under pressure and below the cap, whose forces change.

Derivatives of the largest root stresses by the forces of the cells, and by the motion of their lines.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.compliance import FlankLine, flank_lines, root_stress_model
from loaded_tca.contact.patch import peak_weights, reaches_border, top_weights
from loaded_tca.errors import require
from loaded_tca.results.gap_growth import moved
from loaded_tca.results.root_stress import stress_at_extreme
from loaded_tca.results.slice_pressure import InnerPeak, SlicePeak, UnderPressure
from loaded_tca.separation.normal_gap import NormalGap

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from loaded_tca.arrays import Array, Mask
    from loaded_tca.loaded.loaded_grid import LoadedGrid
    from loaded_tca.loaded.sensitivity import Tangents
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.separation.pair_change import PairChange

EXPONENT = 12.0
"""Of the pressure norm: the norm of an even pressure over 1 mm^2 is that pressure."""
MOST_BENT, FEWEST_FOR_JUMPS = 0.02, 8
"""Of :func:`curvature_jumps_beside`: smooth flanks of helical and hypoid pairs have less than 2e-3; fewer
cells tell of no jump."""


def line_load_slopes(pressure: Array, spacing: tuple[float, float]) -> Array:
    """Derivative of the largest line load by the forces of the cells.

    The largest one is the top of the parabola through the highest slice and its neighbours, since the two in the middle
    of an even grid may be alike; at an end of the contact it is that of the slice. Which slices these are is held.

    Parameters
    ----------
    pressure : (nx, ny) array [MPa]
    spacing : (float, float) [mm]

    Returns
    -------
    (nx, ny) array [1/mm]
        Zero without pressure anywhere.

    Examples
    --------
    >>> line_load_slopes(np.array([[1.0, 3.0, 3.0]]), (0.1, 0.5))
    array([[-0.25,  1.5 ,  0.75]])
    """
    line = pressure.sum(axis=0)
    top, weights = int(line.argmax()), np.zeros(line.size)
    if 0 < top < line.size - 1 and min(line[top - 1], line[top + 1]) > 0.0:
        weights[top - 1 : top + 2] = top_weights(line[top - 1 : top + 2])
    elif line[top] > 0.0:
        weights[top] = 1.0
    return np.asarray(np.broadcast_to(weights / spacing[1], pressure.shape).copy())


def peak_pressure_slopes(
    pair: GearPair, contacts: Sequence[UnderPressure], peaks: Sequence[SlicePeak | InnerPeak | None]
) -> list[Array]:
    """Derivatives of the peak pressures of several contacts by the forces of their cells.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of (ContactPoint, Separation, (nx, ny) array [MPa])
        Each under a load > 0.
    peaks : sequence of SlicePeak, InnerPeak or None
        Of those that reach an edge or a relief start (``on_edge`` or ``on_relief_start`` of the result).

    Returns
    -------
    list of (nx, ny) arrays [1/mm^2]
        Of a smooth contact, and of inner cells, that of the top of the quadratic, the cells that it is fitted to held;
        of the largest cell where none fits, where the pair has a cap on the pressure or the contact reaches the end of
        its grid: as the peak itself. Of the others that of their largest slice pressure, the place along the contact
        held: p dq/2q + p dk/2k. Zero at the cap.
    """
    of_contacts = []
    for (_, separation, pressure), peak in zip(contacts, peaks, strict=True):
        if isinstance(peak, SlicePeak):
            of_contacts.append(peak.slopes)
        else:
            slopes = smooth_peak_slopes(pressure if peak is None else peak.cells, pair.max_pressure)
            of_contacts.append(slopes / (separation.spacing[0] * separation.spacing[1]))
    return of_contacts


def curvature_jumps_beside(pair: GearPair, grid: LoadedGrid) -> bool:
    """Whether the curvature of the gap across a contact jumps within half its width from its peak, as at relief starts.

    The gap before loading, which a grid from a file does not have, is sampled through the peak.

    The size of a jump is that of the second difference over two cells, less what it changes by beside them, times half
    the square of the contact's half width, over the range of the gap there: 0.05 and more where a relief of 30 um
    starts (helical pair, 32 cells).
    """
    pressure = grid.pressure
    row, column = np.unravel_index(int(pressure.argmax()), pressure.shape)
    x, y, pressed = grid.separation.x, grid.separation.y[column], pressure[:, column] > 0.0
    heights, room = NormalGap(pair, grid.contact, grid.separation.axes).at(x[None, :, None], np.full((1, 1, 1), y))
    gap = np.where(room >= 0.0, heights, math.nan)[0, :, 0]
    return _curvature_jumps(gap, pressed, int(row))


def _curvature_jumps(gap: Array, pressed: Mask, row: int) -> bool:
    """Whether the curvature of a gap (nx,), NaN beyond the flanks, jumps within half the pressed cells from one."""
    half, known = 0.5 * np.count_nonzero(pressed), pressed & np.isfinite(gap)
    if gap.size < FEWEST_FOR_JUMPS or not known.any():
        return False
    bends = np.diff(gap, 2)
    changes = np.pad(np.nan_to_num(np.abs(bends[2:] - bends[:-2])), 3, mode="edge")
    jumps = changes[3:-3] - np.maximum(changes[:-6], changes[6:])
    near = np.abs(np.arange(2, gap.size - 2) - row) <= half
    largest = 0.5 * half**2 * float(jumps[near].max(initial=0.0))
    return bool(largest > MOST_BENT * float(np.ptp(gap[known])))


def smooth_peak_slopes(pressure: Array, max_pressure: float | None = None) -> Array:
    """Derivative (nx, ny) of the peak of a smooth contact by the pressures of its cells, held as above."""
    if max_pressure is None and not reaches_border(pressure):
        part = pressure / pressure.max()
        weighted = peak_weights(part) * part
        return np.asarray(weighted / math.sqrt(float((weighted * part).sum())))
    slopes, top = np.zeros(pressure.shape), np.unravel_index(int(pressure.argmax()), pressure.shape)
    slopes[top] = max_pressure is None or pressure[top] < max_pressure
    return slopes


def pressure_norm(
    pressure: Array, cover: Array, spacing: tuple[float, float], exponent: float = EXPONENT
) -> tuple[float, Array]:
    r"""Norm of the pressure of a contact, and its derivative by the forces of the cells.

    .. math:: N = \left(\frac{1}{1\,mm^2} \int p^m dA\right)^{1/m}

    The force of a cell that an edge cuts is spread over its material: with the part c of it, p/c acts on c dx dy. The
    norm tends to the largest pressure on material as m grows. At sharp edges it depends on the grid as that does, so
    limits and objectives should leave such contacts out.

    Parameters
    ----------
    pressure : (nx, ny) array [MPa]
        Mean over the whole cells.
    cover : (nx, ny) array
        Part of each cell that has material.
    spacing : (float, float) [mm]
    exponent : float
        m, at least 1.

    Returns
    -------
    norm : float [MPa]
        Zero without pressure.
    slopes : (nx, ny) array [1/mm^2]
        Exact; nothing is held.

    Raises
    ------
    InputError
        If the exponent is below 1 or not finite.

    Examples
    --------
    >>> norm, slopes = pressure_norm(np.full((2, 2), 800.0), np.ones((2, 2)), (0.5, 0.5))
    >>> round(norm, 9), slopes.round(9)
    (800.0, array([[1., 1.],
           [1., 1.]]))
    """
    require((1.0 <= exponent < math.inf, f"exponent: {exponent} is not between 1 and infinity"))
    on_material = pressure / np.where(cover > 0.0, cover, 1.0)
    largest = float(on_material.max())
    if largest == 0.0:
        return 0.0, np.zeros(pressure.shape)
    whole = float((cover * (on_material / largest) ** exponent).sum()) * spacing[0] * spacing[1]
    norm = largest * whole ** (1.0 / exponent)
    return norm, np.asarray((on_material / norm) ** (exponent - 1.0))


STEP = 1e-2
"""By which a line of forces is shifted to see how the root stress changes, over the width of its grid."""


def root_slopes(
    pair: GearPair,
    gear: int,
    tangents: Tangents,
    places: Sequence[Sequence[int] | None],
    changes: Sequence[PairChange | None],
    motions: Array,
    *,
    at_node: bool = False,
) -> tuple[list[Array], Array]:
    """Derivatives of the stress about the extremes of a gear, which lie at a place in each state.

    It follows the forces, and the lines along which they load the teeth.

    Parameters
    ----------
    pair : GearPair
    gear : int
        0: pinion, 1: wheel.
    tangents : Tangents
        Of all states.
    places : sequence of sequences of int, or None
        Of the extreme in each state; None: no derivative is asked for.
    changes : sequence of PairChange or None
        None of keys that change no gears.
    motions : (keys, grids, 6) array
        Of the grids.
    at_node : bool
        Whether the stress at the places themselves is meant.

    Returns
    -------
    by_force : list of (nx, ny) arrays [MPa/N]
        On each grid.
    moved_lines : (keys, states) array [MPa per unit]
        Growth by the motion of the lines, the forces held.
    """
    grids, model = tangents.grids, root_stress_model((pair.pinion, pair.wheel)[gear])
    by_force, moved_lines = [], np.zeros((len(changes), len(places)))
    in_states = np.split(np.arange(len(grids)), np.flatnonzero(np.diff(tangents.state)) + 1)
    for state, (numbers, place) in enumerate(zip(in_states, places, strict=True)):
        if place is None:
            by_force += [np.zeros(grids[i].active.shape) for i in numbers]
            continue
        loads, per_force = stress_at_extreme(pair, gear, model, [grids[i] for i in numbers], place, at_node=at_node)
        for i, (line, forces) in zip(numbers, loads, strict=True):
            grid, stress = grids[i].separation, per_force(line)
            step = STEP * grid.spacing[0] * len(grid.x)
            shifted = replace(grid, force_line=grid.force_line + step)
            across = (per_force(flank_lines(pair, grids[i].number, shifted)[gear]) - stress) / step
            by_force.append(stress + across * (grid.x[:, None] - grid.force_line))
            for key, change in enumerate(changes):
                if change is not None:
                    growth = _by_moved_line(gear, change, grids[i], motions[key, i], per_force, across)
                    moved_lines[key, state] += growth @ forces
    return by_force, moved_lines


def _by_moved_line(
    gear: int,
    change: PairChange,
    grid: LoadedGrid,
    motion: Array,
    per_force: Callable[[FlankLine], Array],
    across: Array,
) -> Array:
    """Growth of the stress per force of the slices (ny,) [MPa/N per unit], as the line of a grid moves.

    ``across``: that by its shift along x.
    """
    if change.of_modifications:
        return across * motion[0]
    low, high = (
        per_force(flank_lines(side, grid.number, moved(grid.separation, part * change.difference * motion))[gear])
        for side, part in ((change.below, -0.5), (change.above, 0.5))
    )
    return np.asarray((high - low) / change.difference)
