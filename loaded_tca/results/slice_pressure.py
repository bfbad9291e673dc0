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
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation import Separation, slice_middles
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import ContactPoint

AVERAGED_OVER = 0.25
"""Length along the contact over which a line load is averaged, over the normal module."""

UnderPressure = tuple[ContactPoint, Separation, Array]
"""A contact under load: its contact point, its grid and the pressure (nx, ny) [MPa] there."""


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
    return places, (stretch_parts(borders, places, length) * force).sum(axis=1) / length


def stretch_parts(borders: Array, places: Array, length: float) -> Array:
    """Part (m, ny) of each slice that lies within a length [mm] about each of m places.

    Examples
    --------
    >>> stretch_parts(np.array([0.0, 1.0, 2.0]), np.array([1.0, 2.0]), 1.0)
    array([[0.5, 0.5],
           [0. , 0.5]])
    """
    low, high = places[:, None] - 0.5 * length, places[:, None] + 0.5 * length
    within = np.minimum(borders[1:], high) - np.maximum(borders[:-1], low)
    return np.asarray(np.maximum(within, 0.0) / np.diff(borders))


def top_weights(values: Array) -> Array:
    """Weights (3,) of three values at even distances, the middle one the largest, in the top of their parabola.

    They are its derivative by the values too: at its top a parabola is level.

    Examples
    --------
    >>> top_weights(np.array([1.0, 3.0, 3.0]))
    array([-0.125,  0.75 ,  0.375])
    """
    before, after = values[1] - values[0], values[1] - values[2]
    place = 0.5 * (before - after) / (before + after) if before + after > 0.0 else 0.0
    return np.array([0.5 * place * (place - 1.0), 1.0 - place**2, 0.5 * place * (place + 1.0)])


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


@dataclass(frozen=True, eq=False)
class SlicePeak:
    """Largest pressure of the slices of a contact.

    Attributes
    ----------
    pressure : float [MPa]
        Not above the cap.
    place : (float, float) [mm]
        Across and along the contact, from the contact point.
    slopes : (ny,) array [1/mm^2]
        Derivative of the pressure by the forces of the slices; zero at the cap.
    """

    pressure: float
    place: tuple[float, float]
    slopes: Array


def largest_slice_pressures(pair: GearPair, contacts: Sequence[UnderPressure]) -> list[SlicePeak]:
    """Largest pressure of the slices of each of several contacts under load, its place and its derivative.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of (ContactPoint, Separation, (nx, ny) array [MPa])
        At least one, each under a load > 0.

    Notes
    -----
    In the derivative the place of the largest pressure, its curvature and the length of the average are held: p dq/2q.
    Where the average has room in the contact, q k is that of a parabola through the place and those one slice before
    and after it, since on even grids two places may be alike.
    """
    slices = [_Slices(pair, separation, pressure) for _, separation, pressure in contacts]
    count = max(one.y.size for one in slices)
    x, y, line_load = (
        np.stack([np.pad(getattr(one, name), (0, count - one.y.size), "edge") for one in slices])
        for name in ("x", "y", "line_load")
    )
    axes = np.array([separation.axes for _, separation, _ in contacts])
    curvature = np.maximum(
        NormalGap(pair.sharp, [contact for contact, *_ in contacts], axes).curvature_across(x, y), 0.0
    )
    pressure = np.sqrt(line_load * pair.contact_modulus * curvature / math.pi)
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    found = []
    for k, top in enumerate(pressure.argmax(axis=1).tolist()):
        highest, slopes = float(pressure[k, top]), np.zeros(slices[k].force.size)
        if 0.0 < highest < cap:
            slopes = 0.5 * highest * slices[k].relative_slopes(float(y[k, top]), curvature[k])
        found.append(SlicePeak(min(highest, cap), (float(x[k, top]), float(y[k, top])), slopes))
    return found


class _Slices:
    """Slices of a contact: ``x``, ``y`` [mm] where their averaged ``line_load`` [N/mm] may be largest."""

    def __init__(self, pair: GearPair, separation: Separation, pressure: Array) -> None:
        (dx, dy), (carrying, middles) = separation.spacing, slice_middles(separation.x, pressure)
        self.force = pressure.sum(axis=0) * (dx * dy)
        self.borders = borders = np.append(separation.y, separation.y[-1] + dy) - 0.5 * dy
        if carrying.size > 1:  # the last slices end where their material does
            first, last = carrying[[0, -1]]
            part = np.where(pressure > 0.0, separation.cover, 0.0).max(axis=0)
            borders[first], borders[last + 1] = borders[first + 1] - part[first] * dy, borders[last] + part[last] * dy
        self.ends = borders[carrying[0]], borders[carrying[-1] + 1]
        self.length = min(AVERAGED_OVER * pair.module, loaded_length(self.force, borders))
        places, self.line_load = averaged_line_load(self.force, borders, self.length)
        self.y = np.clip(places, *self.ends)
        self.x = np.interp(self.y, separation.y[carrying], middles)
        self.step = dy

    def relative_slopes(self, place: float, curvature: Array) -> Array:
        """Derivative (ny,) [1/N] of the line load at a place by the forces of the slices, over that line load."""
        places, weights = place + self.step * np.array([-1.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
        parts = stretch_parts(self.borders, places, self.length)
        loads = (parts * self.force).sum(axis=1)
        half = 0.5 * self.length
        if self.ends[0] <= places[0] - half and places[2] + half <= self.ends[1]:
            bends = np.interp(places, self.y, curvature[: self.y.size])
            if (loads * bends).argmax() == 1:
                weights = top_weights(loads * bends) * bends
        return np.asarray(weights @ parts / (weights @ loads))
