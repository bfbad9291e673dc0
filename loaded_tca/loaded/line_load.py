"""Line load of a contact, averaged over a length along it: what of its slices does not depend on the grid."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.separation import Separation, slice_middles

AVERAGED_OVER = 0.25
"""Length along the contact over which a line load is averaged, over the normal module."""
LEFT_OF_CHANGE = 0.5
"""Error of the line load at a place over its change from a grid half as fine, where it falls with the cell."""
LEFT_BESIDE_END, COMPETES = 0.035, 0.5
"""Error of the pressure of slices beside a sharp end, over the part that a slice has of the averaged length: two grids
may agree by chance (``validation/loaded/error_estimates.py``); and the line load there, over the largest one, from
which the pressure there may be the largest, where the contact is more curved."""
LEFT_BESIDE_ARC = 0.25
"""The same of the line load beside an end on the arc of a rounded edge, before which it rises without the grid's seeing
it: the pressure of a random contact whose two grids agree by chance was off by 0.14 of the part of a slice."""


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
    summed = np.concatenate([[0.0], np.cumsum(force)])
    below, above = (np.interp(places + side * length, borders, summed) for side in (-0.5, 0.5))
    return places, (above - below) / length


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


def loaded_length(force: Array, borders: Array) -> float:
    """Length of an even line load with the scatter of the given one, at most that of the slices that carry it [mm].

    Examples
    --------
    >>> round(loaded_length(np.array([0.0, 2.0, 2.0, 2.0]), np.arange(5.0)), 12)
    3.0
    """
    carrying = force.nonzero()[0]
    even = math.sqrt(12.0 * float(force @ _squares(force, borders)) / float(force.sum()))
    return min(even, float(borders[carrying[-1] + 1] - borders[carrying[0]]))


def loaded_length_slopes(force: Array, borders: Array) -> Array:
    """Derivative (ny,) [mm/N] of that length by the forces, where their scatter sets it.

    Examples
    --------
    >>> loaded_length_slopes(np.array([0.0, 1.0, 2.0, 1.0]), np.arange(5.0)).round(3)
    array([ 1.984,  0.283, -0.283,  0.283])
    """
    squares, whole = _squares(force, borders), float(force.sum())
    scatter = float(force @ squares) / whole
    return np.asarray(6.0 / math.sqrt(12.0 * scatter) * (squares - scatter) / whole)


def _squares(force: Array, borders: Array) -> Array:
    """Squares (ny,) of the distances of the slices from the middle of their forces, in the mean over each [mm^2]."""
    middles = 0.5 * (borders[:-1] + borders[1:])
    return np.asarray((middles - force @ middles / force.sum()) ** 2 + (borders[1:] - borders[:-1]) ** 2 / 12.0)


class SliceLoads:
    """Slices of a contact under pressure, and their line load averaged over a length that no grid has a part in.

    Parameters
    ----------
    module : float [mm]
    separation : Separation
    pressure : (nx, ny) array [MPa]

    Attributes
    ----------
    force, borders : (ny,) array [N], (ny + 1,) array [mm]
        The last slices end where their material does.
    ends : (float, float) [mm]
        Of the slices that carry load.
    length : float [mm]
        Of the average.
    places : (2 ny + 2,) array [mm]
        Along the contact, middles of the stretches over which is averaged; between them the line load is linear.
    x, y : (2 ny + 2,) array [mm]
        The same on the slices that carry load: where the averaged line load may be largest.
    line_load : (2 ny + 2,) array [N/mm]
        There.
    arms : (nx, ny) array [mm]
        From the middles of the slices to their cells under pressure.
    """

    def __init__(self, module: float, separation: Separation, pressure: Array) -> None:
        (dx, dy), (carrying, middles) = separation.spacing, slice_middles(separation.x, pressure)
        self.force = pressure.sum(axis=0) * (dx * dy)
        self.borders = borders = np.append(separation.y, separation.y[-1] + dy) - 0.5 * dy
        if carrying.size > 1:  # the last slices end where their material does
            first, last = carrying[[0, -1]]
            part = np.where(pressure > 0.0, separation.cover, 0.0).max(axis=0)
            borders[first], borders[last + 1] = borders[first + 1] - part[first] * dy, borders[last] + part[last] * dy
        self.ends = borders[carrying[0]], borders[carrying[-1] + 1]
        self.length = min(AVERAGED_OVER * module, loaded_length(self.force, borders))
        self._longest = min(AVERAGED_OVER * module, self.ends[1] - self.ends[0])
        self.places, self.line_load = averaged_line_load(self.force, borders, self.length)
        self._middles = separation.y[carrying], middles
        arms, self._carrying = np.zeros(pressure.shape), carrying
        arms[:, carrying] = np.where(pressure[:, carrying] > 0.0, separation.x[:, None] - middles, 0.0)
        self.arms = arms
        self.x, self.y, _ = self.at(self.places)
        self.step = dy

    def at(self, places: Array) -> tuple[Array, Array, Array]:
        """Where the contact lies at places along it, x and y [mm] on the slices that carry load, and its line load."""
        y = np.minimum(np.maximum(places, self.ends[0]), self.ends[1])
        return np.interp(y, *self._middles), y, np.interp(places, self.places, self.line_load)

    def middle_slopes(self, place: float) -> Array:
        """Derivative (nx, ny) of where the contact lies across at a place along it by the forces of cells [mm/N]."""
        at, by_force = min(max(place, self.ends[0]), self.ends[1]), np.zeros(self.force.size)
        parts = np.array([np.interp(at, self._middles[0], unit) for unit in np.eye(self._carrying.size)])
        by_force[self._carrying] = parts / self.force[self._carrying]
        return np.asarray(self.arms * by_force)

    @property
    def length_slopes(self) -> Array:
        """Derivative (ny,) of the length of the average by the forces of the slices [mm/N]: none of the longest one."""
        if self.length < self._longest:
            return loaded_length_slopes(self.force, self.borders)
        return np.zeros(self.force.size)

    def least_at_ends(self, place: float) -> float:
        """Smaller line load just within the ends of the stretch about a place [N/mm].

        By that the force grows with the length, where it is largest: the stretch ends where both are alike, or one
        jumps to less, as at the end of the contact, and stays there.
        """
        parts = stretch_parts(self.borders, np.array([place]), self.length)[0]
        within = np.flatnonzero((parts > 0.0) & (self.force > 0.0))[[0, -1]]
        return float((self.force / np.diff(self.borders))[within].min())

    def error_of_largest(self, coarser: SliceLoads, *, ends_on_arc: bool = False) -> float:
        """Relative error that the largest line load may have by a coarser grid: of its change, or of competing maxima.

        Pressures grow with the root of the line load: their error is half as large. Where the line load goes on to a
        sharp end, or to an arc, their error is told by the length of the slices, too.
        """
        places, part = np.union1d(self.places, coarser.places), self.step / self.length
        line_load, before = (np.interp(places, each.places, each.line_load) for each in (self, coarser))
        errors, largest = LEFT_OF_CHANGE * np.abs(line_load - before), float(line_load.max())
        if ends_on_arc:
            errors = np.where(self._beside_end(places), np.maximum(errors, LEFT_BESIDE_ARC * part * line_load), errors)
        above, below = float((line_load + errors).max()) / largest, float((line_load - errors).max()) / largest
        change = abs(float(coarser.line_load.max()) / float(self.line_load.max()) - 1.0)
        at_end = float(self.line_load[self._beside_end(self.y)].max(initial=0.0)) > COMPETES * largest
        return max(above - 1.0, 1.0 - below, change, LEFT_BESIDE_END * part if at_end else 0.0)

    def _beside_end(self, places: Array) -> Mask:
        """Which places lie nearer to an end than the length of the average and a slice.

        Whether the last slice counts in the average there is a matter of the grid.
        """
        y = np.clip(places, *self.ends)
        return np.asarray(np.minimum(y - self.ends[0], self.ends[1] - y) < self.length + self.step)
