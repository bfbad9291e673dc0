r"""Pressure of the slices of a contact: the mesh-independent peak where a contact ends at a sharp edge.

At a sharp edge and at a relief start the half-space has an infinite pressure, and the largest cell grows with the
grid. The force is finite: averaged over a length that does not depend on the grid, or over the contact where that is
shorter, it is a line load q, which a Hertz
line contact of the curvature k of that slice carries with the pressure

.. math:: p = \sqrt{q E^* k / \pi} .

On smooth contacts that is less than the peak: 0.886 of it on a circle, 0.984 on an ellipse of an aspect of 5, 0.994 of
10. So the peak is that of the cells where these have a top that is larger, in slices that stand no nearer than half of
that length to one that reaches an edge or a relief start: a contact whose end comes to an edge keeps the peak that it
has elsewhere.

References
----------
Johnson 1985, Contact Mechanics, eqs. 4.43 to 4.45.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact.patch import peak_pressure, reaches_border, top_weights
from loaded_tca.edges.places import dilated, has_relief_starts
from loaded_tca.loaded.line_load import SliceLoads, stretch_parts
from loaded_tca.separation import Separation
from loaded_tca.separation.arcs import arcs_beside
from loaded_tca.separation.flank_places import past_relief_starts
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import ContactPoint

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from loaded_tca.pairs.gear_pair import GearPair

NEAREST = 1.5
"""Slices from one that reaches an edge or a relief start, within which no cell tells what a finer grid could count."""
JUMP, ACROSS = 0.1, 1e-3
"""Relative change of a curvature over the length in which a peak is known to lie, from which on a relief starts there;
and between two sides of a step, from which on its start lies between them. Such a step across, over the width of a
cell."""
APART = 0.25
"""Distance of two tops over the length of their contact: a single top, of an ellipse, has 97 % of it over as much."""
ROUNDS, BETWEEN = 2, 17
"""How often places between those beside the largest pressure are tried, and how many."""

UnderPressure = tuple[ContactPoint, Separation, Array]
"""A contact under load: its contact point, its grid and the pressure (nx, ny) [MPa] there."""


@dataclass(frozen=True, eq=False)
class SlicePeak:
    """Largest pressure of the slices of a contact.

    Attributes
    ----------
    pressure : float [MPa]
        Not above the cap.
    place : (float, float) [mm]
        Across and along the contact, from the contact point.
    resolution : float [mm]
        Length along the contact by which the place is known.
    slices : SliceLoads
    curvature : (n,) array or None [1/mm]
        Across the contact, at the places of ``slices``; None where the pressure is at the cap, or there is none.
    error : float
        Relative change if cells counted from a slice nearer to the edge or the relief start on, or farther from it.
    steepness : float [1/mm]
        Relative growth of the curvature at the place across the contact: the middles of slices go with their forces.
    """

    pressure: float
    place: tuple[float, float]
    resolution: float
    slices: SliceLoads
    curvature: Array | None
    error: float = 0.0
    steepness: float = 0.0

    @property
    def slopes(self) -> Array:
        """Derivative (nx, ny) of the pressure by the forces of the cells [1/mm^2]; zero at the cap."""
        if self.curvature is None:
            return np.zeros(self.slices.arms.shape)
        by_slice = _relative_slopes(self.slices, self.place[1], self.curvature)
        return 0.5 * self.pressure * (by_slice + self.steepness * self.slices.middle_slopes(self.place[1]))


@dataclass(frozen=True, eq=False)
class InnerPeak:
    """Largest pressure in the slices of a contact that are apart from those that reach an edge or a relief start.

    Attributes
    ----------
    pressure : float [MPa]
    place : (float, float) [mm]
        Across and along the contact, from the contact point.
    cells : (nx, ny) array [MPa]
        Pressure of these cells; zero in the others.
    error : float
        As of a :class:`SlicePeak`.
    """

    pressure: float
    place: tuple[float, float]
    cells: Array
    error: float = 0.0


def rough_peaks(pair: GearPair, contacts: Sequence[UnderPressure]) -> list[SlicePeak | InnerPeak]:
    """Peaks of several contacts that reach edges or relief starts: the larger one of their slices and inner cells.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of (ContactPoint, Separation, (nx, ny) array [MPa])
        Each under a load > 0.
    """
    of_slices = largest_slice_pressures(pair, contacts) if contacts else []
    return [
        _with_inner_cells(pair, separation, pressure, peak)
        for (_, separation, pressure), peak in zip(contacts, of_slices, strict=True)
    ]


def _with_inner_cells(
    pair: GearPair, separation: Separation, pressure: Array, of_slices: SlicePeak
) -> SlicePeak | InnerPeak:
    """The larger peak, of the slices or of the inner cells, and by how much it hangs on which cells are inner ones.

    Where the contact reaches an edge is known to a slice: a finer grid may count cells from as much nearer on.
    """
    if pressure.max() <= of_slices.pressure:
        return of_slices
    step = separation.spacing[1]
    rough = separation.y[(_rough_cells(pair, separation, pressure) & (pressure > 0.0)).any(axis=0)]
    away = np.abs(separation.y[:, None] - rough).min(axis=1, initial=math.inf)
    reach = 0.5 * (of_slices.slices.length + step)
    nearer = min(reach, max(reach - step, NEAREST * step))
    peak, *others = (
        _inner_peak(pair, separation, pressure, of_slices, away > least) or of_slices
        for least in (reach, nearer, reach + step)
    )
    return replace(peak, error=max(abs(other.pressure / peak.pressure - 1.0) for other in others))


def _inner_peak(
    pair: GearPair, separation: Separation, pressure: Array, of_slices: SlicePeak, inner: Mask
) -> InnerPeak | None:
    """Top of the cells in inner slices (ny,); None where that of the slices is as large, or they have none."""
    cells = np.where(inner, pressure, 0.0)
    if cells.max() <= of_slices.pressure:
        return None
    across, along = np.unravel_index(int(cells.argmax()), cells.shape)
    beside = pressure[max(across - 1, 0) : across + 2, max(along - 1, 0) : along + 2]
    if beside.max() > cells[across, along]:  # it rises towards the edge
        return None
    of_cell = pair.max_pressure is not None or reaches_border(cells)
    largest = float(cells.max()) if of_cell else peak_pressure(cells)
    return InnerPeak(largest, (float(separation.x[across]), float(separation.y[along])), cells)


def _rough_cells(pair: GearPair, separation: Separation, pressure: Array) -> Mask:
    """Cells (nx, ny) beside those that an edge cuts or an arc lies on, and in the contact on both sides of a start."""
    rough = dilated(separation.cover < 1.0)
    if pair.sharp is not pair:
        rough |= dilated(arcs_beside(pair, separation, pressure > 0.0).any(axis=-1))
    if has_relief_starts(pair):
        for past in past_relief_starts(pair, separation, dilated(pressure > 0.0)):
            rough |= dilated(past > 0.0) & dilated(past <= 0.0)
    return rough


def largest_slice_pressures(pair: GearPair, contacts: Sequence[UnderPressure]) -> list[SlicePeak]:
    """Largest pressure of the slices of each of several contacts under load, its place and its derivative.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of (ContactPoint, Separation, (nx, ny) array [MPa])
        At least one, each under a load > 0.

    Notes
    -----
    In the derivative the place of the largest pressure along the contact is held: p dq/2q + p dk/2k, k at the middle
    of the force across, which moves. Where the average has room in the contact, q k is that of a parabola through the
    place and those one slice before and after it, since on even grids two places may be alike. Where the contact is
    shorter than the length of the average, that grows with it.
    """
    return _slice_peaks(pair, contacts, lambda _, __, pressure: pressure)


def other_slice_pressures(
    pair: GearPair, contacts: Sequence[UnderPressure], places: Sequence[float]
) -> list[SlicePeak | None]:
    """Largest local maximum of the slice pressures of each contact, apart from a place along it; None without any.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of (ContactPoint, Separation, (nx, ny) array [MPa])
        At least one, each under a load > 0.
    places : sequence of float [mm]
        Stretches over which is averaged do not overlap that about the place, and the other one lies a quarter of the
        contact's length away, beyond what one top has within a few percent of its pressure.
    """

    def apart(slices: Sequence[SliceLoads], along: Array, pressure: Array) -> Array:
        least = np.array([max(one.length, APART * (one.ends[1] - one.ends[0])) for one in slices])
        padded = np.pad(pressure, ((0, 0), (1, 1)))
        tops = (pressure >= padded[:, :-2]) & (pressure >= padded[:, 2:])
        return np.where(tops & (np.abs(along - np.array(places)[:, None]) > least[:, None]), pressure, 0.0)

    return [peak if peak.pressure > 0.0 else None for peak in _slice_peaks(pair, contacts, apart)]


def _slice_peaks(
    pair: GearPair, contacts: Sequence[UnderPressure], wanted: Callable[[Sequence[SliceLoads], Array, Array], Array]
) -> list[SlicePeak]:
    """Peak of each contact at the largest ``wanted`` of its slices, and of places and pressures (contacts, n) there."""
    slices = [SliceLoads(pair.module, separation, pressure) for _, separation, pressure in contacts]
    axes = np.array([separation.axes for _, separation, _ in contacts])
    gap = NormalGap(pair.sharp, [contact for contact, *_ in contacts], axes)
    count = max(each.places.size for each in slices)
    places = np.stack([np.pad(each.places, (0, count - each.places.size), "edge") for each in slices])
    pressure, bends = _slice_pressures(pair, gap, slices, places)
    finest, pressure = places, wanted(slices, places, pressure)
    known = pressure.max(axis=1) > 0.0
    for _ in range(ROUNDS):  # where the curvature jumps the largest pressure is at the jump, between two places
        top = pressure.argmax(axis=1, keepdims=True)
        below, above = (np.take_along_axis(finest, np.clip(top + k, 0, finest.shape[1] - 1), 1) for k in (-1, 1))
        finest = below + (above - below) * np.linspace(0.0, 1.0, BETWEEN)
        pressure, _ = _slice_pressures(pair, gap, slices, finest)
    pressure = np.where(known[:, None], pressure, 0.0)
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    tops = pressure.argmax(axis=1)
    at = np.array([each.at(along[top])[:2] for each, along, top in zip(slices, finest, tops, strict=True)])
    steepness = _steepness(gap, at, np.array([separation.spacing[0] for _, separation, _ in contacts]))
    peaks = []
    for k, highest in enumerate(pressure[np.arange(tops.size), tops].tolist()):
        curvature, resolution = bends[k] if 0.0 < highest < cap else None, float(np.diff(finest[k]).max())
        place = float(at[k, 0]), float(at[k, 1])
        numbers = resolution, slices[k], curvature
        peaks.append(SlicePeak(min(highest, cap), place, *numbers, steepness=float(steepness[k])))
    return peaks


def _steepness(gap: NormalGap, places: Array, widths: Array) -> Array:
    """Relative growth (contacts,) of the curvatures across contacts at places (contacts, 2) [1/mm], zero at jumps.

    By a difference over a small part of the ``widths`` (contacts,) of the cells.
    """
    step = ACROSS * widths
    x = places[:, :1] + step[:, None] * [-1.0, 0.0, 1.0]
    low, middle, high = np.maximum(gap.curvature_across(x, np.broadcast_to(places[:, 1:], x.shape)), 0.0).T
    part = np.divide(high - low, middle, out=np.zeros(step.size), where=middle > 0.0)
    return np.asarray(np.where(np.abs(part) < JUMP, part / (2.0 * step), 0.0))


def _slice_pressures(
    pair: GearPair, gap: NormalGap, slices: Sequence[SliceLoads], places: Array
) -> tuple[Array, Array]:
    """Pressure of the slices at places (contacts, n) along them [MPa], and the curvature across [1/mm]."""
    x, y, line_load = (np.stack(part) for part in zip(*map(SliceLoads.at, slices, places), strict=True))
    bends = np.maximum(gap.curvature_across(x, y), 0.0)
    return np.sqrt(line_load * pair.contact_modulus * bends / math.pi), bends


def _relative_slopes(slices: SliceLoads, place: float, curvature: Array) -> Array:
    """Derivative (ny,) [1/N] of the line load at a place by the forces of its slices, over that line load."""
    places, weights = place + slices.step * np.array([-1.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    parts = stretch_parts(slices.borders, places, slices.length)
    loads = (parts * slices.force).sum(axis=1)
    half = 0.5 * slices.length
    if slices.ends[0] <= places[0] - half and places[2] + half <= slices.ends[1]:
        bends = np.interp(places, slices.y, curvature[: slices.y.size])
        if (loads * bends).argmax() == 1:
            weights = top_weights(loads * bends) * bends
    by_length = slices.least_at_ends(place) / (parts[1] @ slices.force) - 1.0 / slices.length
    return np.asarray(weights @ parts / (weights @ loads) + by_length * slices.length_slopes)
