r"""Pressure of the slices of a contact: the mesh-independent peak where a contact ends at a sharp edge.

At a sharp edge and at a relief start the half-space has an infinite pressure, and the largest cell grows with the
grid. The force is finite: averaged over a length that does not depend on the grid, or over the contact where that is
shorter, it is a line load q, which a Hertz
line contact of the curvature k of that slice carries with the pressure

.. math:: p = \sqrt{q E^* k / \pi} .

On smooth contacts that is less than the peak: 0.886 of it on a circle, 0.984 on an ellipse of an aspect of 5, 0.994 of
10.

References
----------
Johnson 1985, Contact Mechanics, eqs. 4.43 to 4.45.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.loaded.tooth_contact import LoadedContact
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.pressure_map import slice_middles
from loaded_tca.separation.normal_gap import NormalGap

AVERAGED_OVER = 0.25
"""Length along the contact over which a line load is averaged, over the normal module."""


def averaged_line_load(force: Array, borders: Array, length: float) -> tuple[Array, Array]:
    """Line load averaged over a length along the contact, where it may be largest.

    Parameters
    ----------
    force : (ny,) array [N]
        Of the slices.
    borders : (ny + 1,) array [mm]
        Of the slices along the contact, ascending.
    length : float [mm]
        Over which the line load is averaged: beyond the slices there is none.

    Returns
    -------
    places, line_load : (2 ny + 2,) array [mm], [N/mm]
        Middles of the stretches that begin or end at a border, and their line loads; between them it changes linearly.

    Examples
    --------
    >>> places, line_load = averaged_line_load(np.array([1.0, 3.0]), np.array([0.0, 1.0, 2.0]), 1.0)
    >>> places, line_load
    (array([-0.5,  0.5,  0.5,  1.5,  1.5,  2.5]), array([0., 1., 1., 3., 3., 0.]))
    """
    places = np.sort(np.concatenate([borders - 0.5 * length, borders + 0.5 * length]))
    carried = np.concatenate([[0.0], np.cumsum(force)])
    below, above = (np.interp(places + half, borders, carried) for half in (-0.5 * length, 0.5 * length))
    return places, (above - below) / length


def loaded_length(force: Array, borders: Array) -> float:
    """Length of an even line load with the scatter of the given one, at most that of the slices that carry it [mm].

    Examples
    --------
    >>> round(loaded_length(np.array([0.0, 2.0, 2.0, 2.0]), np.arange(5.0)), 12)
    3.0
    """
    middles, widths = 0.5 * (borders[:-1] + borders[1:]), np.diff(borders)
    share = force / force.sum()
    scatter = share @ ((middles - share @ middles) ** 2 + widths**2 / 12.0)
    carrying = np.flatnonzero(force)
    return min(math.sqrt(12.0 * float(scatter)), float(borders[carrying[-1] + 1] - borders[carrying[0]]))


def largest_slice_pressures(
    pair: GearPair, contacts: Sequence[LoadedContact]
) -> list[tuple[float, tuple[float, float]]]:
    """Largest pressure of the slices of each of several contacts under load, and its place.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of LoadedContact
        At least one, each under a load > 0.

    Returns
    -------
    list of (float, (float, float)) [MPa], [mm]
        The pressure, not above the cap, and the place across and along the contact, from the contact point.
    """
    slices = [_slices(pair, loaded) for loaded in contacts]
    count = max(len(y) for _, y, _ in slices)
    rows = [np.pad(row, ((0, 0), (0, count - row.shape[1])), "edge") for row in slices]
    x, y, line_load = np.stack(rows, axis=1)
    axes = np.array([loaded.separation.axes for loaded in contacts])
    curvature = NormalGap(pair, [loaded.contact for loaded in contacts], axes).curvature_across(x, y)
    pressure = np.sqrt(line_load * pair.contact_modulus * np.maximum(curvature, 0.0) / math.pi)
    top = np.arange(len(slices)), pressure.argmax(axis=1)
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    found = np.minimum(pressure[top], cap), x[top], y[top]
    return [(highest, (across, along)) for highest, across, along in zip(*map(np.ndarray.tolist, found), strict=True)]


def _slices(pair: GearPair, loaded: LoadedContact) -> Array:
    """Places across and along where the line load may be largest, and the line load there: (3, n) [mm], [N/mm]."""
    separation, pressure = loaded.separation, loaded.solution.pressure
    dy, (carrying, middles) = separation.spacing[1], slice_middles(separation.x, pressure)
    borders = np.append(separation.y, separation.y[-1] + dy) - 0.5 * dy
    if carrying.size > 1:  # the last slices end where their material does
        first, last = carrying[[0, -1]]
        part = np.where(pressure > 0.0, separation.cover, 0.0).max(axis=0)
        borders[first], borders[last + 1] = borders[first + 1] - part[first] * dy, borders[last] + part[last] * dy
    length = min(AVERAGED_OVER * pair.module, loaded_length(loaded.slice_force, borders))
    y, line_load = averaged_line_load(loaded.slice_force, borders, length)
    y = np.clip(y, borders[carrying[0]], borders[carrying[-1] + 1])
    return np.stack([np.interp(y, separation.y[carrying], middles), y, line_load])
