"""Derivatives of the figures of a contact by the forces of its cells: what sensitivities need of each figure.

The force of a cell is its pressure times dx dy, also where an edge of a flank cuts it. Every derivative is an array on
the grid (nx, ny); it counts for cells under pressure and below the cap, whose forces change.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.patch import peak_weights, reaches_border, top_weights
from loaded_tca.errors import require
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.load_factors import (
    STRIPS,
    loaded_maps,
    strip_borders,
    strip_forces,
    strip_motions,
    strip_shares,
)
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.slice_pressure import UnderPressure, largest_slice_pressures
from loaded_tca.unloaded import ContactPath

EXPONENT = 12.0
"""Of the pressure norm: the norm of an even pressure over 1 mm^2 is that pressure."""


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


def peak_pressure_slopes(pair: GearPair, contacts: Sequence[UnderPressure], rough: Sequence[bool]) -> list[Array]:
    """Derivatives of the peak pressures of several contacts by the forces of their cells.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of (ContactPoint, Separation, (nx, ny) array [MPa])
        Each under a load > 0.
    rough : sequence of bool
        Whether each reaches an edge or a relief start (``on_edge`` or ``on_relief_start`` of the result).

    Returns
    -------
    list of (nx, ny) arrays [1/mm^2]
        Of a smooth contact that of the top of the quadratic, the cells that it is fitted to held; of the largest cell
        where none fits, where the pair has a cap on the pressure or the contact reaches the end of its grid: as the
        peak itself. Of a rough contact that of its largest slice pressure, the place along the contact, the curvature
        there and the length of the average held: p dq/2q. Zero at the cap.
    """
    uneven = [contact for contact, is_rough in zip(contacts, rough, strict=True) if is_rough]
    peaks = iter(largest_slice_pressures(pair, uneven) if uneven else ())
    found = []
    for (_, separation, pressure), is_rough in zip(contacts, rough, strict=True):
        if is_rough:
            found.append(np.broadcast_to(next(peaks).slopes, pressure.shape).copy())
        else:
            slopes = smooth_peak_slopes(pressure, pair.max_pressure)
            found.append(slopes / (separation.spacing[0] * separation.spacing[1]))
    return found


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


def face_load_factor_slopes(
    pair: GearPair, path: ContactPath, positions: Sequence[Sequence[PressureMap | None]]
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

    Returns
    -------
    list of lists of (nx, ny) arrays [1/N]
        By position and tooth pair, zero at cells without pressure. None where K_Hbeta does not depend on a pair: it has
        no map, or the position is the last one; everywhere if K_Hbeta itself is NaN, for one position and without load.
    """

    def slopes(one: PressureMap, borders: Array, forces: Array) -> Array:
        largest, total = int(forces.argmax()), float(forces.sum())
        shares, by_cell = strip_shares(pair, one, borders)[0][largest], np.zeros(one.pressure.shape)
        by_cell[one.pressure > 0.0] = (STRIPS * shares - STRIPS * forces[largest] / total) / total
        return by_cell

    return _of_maps(pair, path, positions, slopes)


def face_load_factor_motions(
    pair: GearPair, path: ContactPath, positions: Sequence[Sequence[PressureMap | None]]
) -> list[list[Array | None]]:
    """Derivatives of K_Hbeta under one torque by the motions of the grids and of the common face, the forces held.

    Parameters
    ----------
    pair, path, positions
        As of :func:`face_load_factor_slopes`.

    Returns
    -------
    list of lists of (8,) arrays
        By the motions of the grid as of :class:`loaded_tca.separation.gap_change.MovedContacts`, and by those of the
        lower and the upper end of the common face [1/mm]. None as there.
    """

    def motions(one: PressureMap, borders: Array, forces: Array) -> Array:
        return strip_motions(pair, one, borders, int(forces.argmax())) * (STRIPS / float(forces.sum()))

    return _of_maps(pair, path, positions, motions)


def _of_maps(
    pair: GearPair,
    path: ContactPath,
    positions: Sequence[Sequence[PressureMap | None]],
    derivative: Callable[[PressureMap, Array, Array], Array],
) -> list[list[Array | None]]:
    """A derivative of K_Hbeta by every map, of the map, the borders of the strips and their forces; None without."""
    borders = strip_borders(pair, path)
    forces = sum((strip_forces(pair, one, borders)[0] for one in loaded_maps(positions)), np.zeros(STRIPS))
    by_map: list[list[Array | None]] = [[None] * len(row) for row in positions]
    for n, row in enumerate(positions[:-1] if forces.any() else ()):
        by_map[n] = [None if one is None else derivative(one, borders, forces) for one in row]
    return by_map
