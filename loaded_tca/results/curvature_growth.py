"""Growth of the largest slice pressures with keys of the scene, by the relative curvature at their places."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.loaded.sensitivity import LoadedGrid
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.gap_growth import GapGrowth, moved
from loaded_tca.results.slice_pressure import SlicePeak
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.pair_change import PairChange

STEP = 1e-3
"""Step of the motion of a grid, over the width of its cells."""
JUMP = 0.1
"""Relative change of a curvature over the length in which a peak is known to lie, from which on a relief starts there;
and between two sides of a step, from which on its start lies between them."""
ROUNDS, BETWEEN = 6, 17
"""How often that length is divided on the way to the start, by so many places: to 6e-8 of it."""
FLAT = 1e-12
"""Curvature [1/mm] that is none."""


def curvature_growth(
    pair: GearPair,
    grids: Sequence[LoadedGrid],
    peaks: Sequence[SlicePeak],
    changes: Sequence[PairChange | None],
    growth: GapGrowth,
) -> Array:
    """Relative growth (keys, grids) [1 per unit] of line load times curvature at the peaks of some grids, forces held.

    A peak goes with its grid; one at the start of a relief, where the curvature jumps, goes with the start, to where
    the line load is another.

    Parameters
    ----------
    pair : GearPair
    grids : sequence of LoadedGrid
    peaks : sequence of SlicePeak
        Of the slices of each.
    changes : sequence of PairChange or None
        None of keys that change no gears.
    growth : GapGrowth
        Of these grids.
    """
    along = np.array([[peak.place[1]] for peak in peaks])
    reach = np.array([[peak.resolution] for peak in peaks])
    held = np.zeros((len(grids), growth.motions.shape[-1]))
    ends = along + reach * [-1.0, 1.0]
    at_ends = _log_curvature(pair, grids, held[:, 0], held)(_middles(peaks, ends), ends)
    starts = np.flatnonzero(np.abs(at_ends[:, 1] - at_ends[:, 0]) > JUMP)
    at = starts.tolist()
    rises, level = at_ends[starts, 1] > at_ends[starts, 0], at_ends[starts].mean(axis=1, keepdims=True)

    def grown(gears: GearPair, turns: Array, motions: Array) -> Array:
        """Logarithm (grids,) of line load times curvature at the peaks, the wheel turned and the grids moved."""
        found = _log_curvature(gears, grids, turns, motions)(_middles(peaks, along), along)[:, 0]
        if starts.size:
            bends = _log_curvature(gears, [grids[i] for i in at], turns[starts], motions[starts])
            found[starts] = _at_starts(bends, [peaks[i] for i in at], level, rises, ends[starts])
        return found

    found = np.zeros((len(changes), len(grids)))
    for key, change in enumerate(changes):
        if change is None:
            continue
        turns, motions = growth.turns[key], growth.motions[key]
        of_shape = [
            grown(side, part * change.difference * turns, held)
            for side, part in ((change.below, -0.5), (change.above, 0.5))
        ]
        lengths = np.abs(motions[:, :2]).max(axis=1)
        step = (
            STEP * np.array([grid.separation.spacing[0] for grid in grids]) / np.where(lengths > 0.0, lengths, np.inf)
        )
        of_motion = [grown(pair, 0.0 * turns, part * step[:, None] * motions) for part in (-1.0, 1.0)]
        for (low, high), width in ((of_shape, change.difference), (of_motion, 2.0 * step)):
            change_of_log = np.where(np.abs(high - low) < JUMP, high - low, 0.0)
            found[key] += np.divide(change_of_log, width, out=np.zeros(len(grids)), where=np.asarray(width) > 0.0)
    return found


def _middles(peaks: Sequence[SlicePeak], along: Array) -> Array:
    """Middles across of the slices at places (grids, n) along them [mm]."""
    return np.stack([peak.slices.at(row)[0] for peak, row in zip(peaks, along, strict=True)])


def _log_curvature(
    gears: GearPair, grids: Sequence[LoadedGrid], turns: Array, motions: Array
) -> Callable[[Array, Array], Array]:
    """Logarithm of the curvatures at places (grids, n) across and along, the wheel turned and the grids moved."""
    contacts, axes = [], []
    for grid, turn, motion in zip(grids, turns, motions, strict=True):
        there = moved(grid.separation, motion)
        angle = grid.contact.wheel_angle - gears.driving * turn
        contacts.append(replace(grid.contact, point=there.origin, wheel_angle=angle))
        axes.append(there.axes)
    gap = NormalGap(gears.sharp, contacts, np.array(axes))
    return lambda across, along: np.log(np.maximum(gap.curvature_across(across, along), FLAT))


def _at_starts(
    bends: Callable[[Array, Array], Array], peaks: Sequence[SlicePeak], level: Array, rises: Mask, ends: Array
) -> Array:
    """Logarithm of line load times curvature at the starts of reliefs on which peaks lie, the former over that there.

    A start lies where the curvature passes a ``level`` (grids, 1) between ``ends`` (grids, 2), upwards or not.
    """
    for _ in range(ROUNDS):
        places = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * np.linspace(0.0, 1.0, BETWEEN)
        beyond = (bends(_middles(peaks, places), places) > level) == rises[:, None]
        first = np.clip(beyond.argmax(axis=1), 1, None)[:, None]
        ends = np.take_along_axis(places, first + np.array([-1, 0]), axis=1)
    place = np.where(rises, ends[:, 1], ends[:, 0])[:, None]  # on the side with the larger curvature
    found = bends(_middles(peaks, place), place)[:, 0]
    loads = [peak.slices.at(np.array([y, peak.place[1]]))[2] for peak, (y,) in zip(peaks, place, strict=True)]
    return np.asarray(found + [math.log(there / before) for there, before in loads])
