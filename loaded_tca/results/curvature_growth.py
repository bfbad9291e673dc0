"""Growth of the relative curvature at places of loaded contacts with keys of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.loaded.sensitivity import LoadedGrid
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.gap_growth import GapGrowth, moved
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.pair_change import PairChange

STEP = 1e-3
"""Step of the motion of a grid, over the width of its cells."""
JUMP = 0.1
"""Relative change of a curvature within a step, from which on the start of a relief lies between."""


def curvature_growth(
    pair: GearPair,
    grids: Sequence[LoadedGrid],
    places: Sequence[tuple[float, float]],
    changes: Sequence[PairChange | None],
    growth: GapGrowth,
) -> Array:
    """Relative growth (keys, grids) [1 per unit] of the curvatures across, at one place of each of some grids.

    Parameters
    ----------
    pair : GearPair
    grids : sequence of LoadedGrid
    places : sequence of (float, float) [mm]
        From the contact point across and along; they go with the grids.
    changes : sequence of PairChange or None
        None of keys that change no gears.
    growth : GapGrowth
        Of these grids.
    """
    x, y = np.array(places)[:, :, None].swapaxes(0, 1)
    found = np.zeros((len(changes), len(grids)))

    def curvature(gears: GearPair, turns: Array, motions: Array) -> Array:
        """Curvatures (grids,), the wheel turned and the grids moved."""
        contacts, axes = [], []
        for grid, turn, motion in zip(grids, turns, motions, strict=True):
            there = moved(grid.separation, motion)
            angle = grid.contact.wheel_angle - pair.driving * turn
            contacts.append(replace(grid.contact, point=there.origin, wheel_angle=angle))
            axes.append(there.axes)
        return np.log(np.maximum(NormalGap(gears.sharp, contacts, np.array(axes)).curvature_across(x, y)[:, 0], FLAT))

    held = np.zeros((len(grids), growth.motions.shape[-1]))
    for key, change in enumerate(changes):
        if change is None:
            continue
        turns, motions = growth.turns[key], growth.motions[key]
        of_shape = [
            curvature(side, part * change.difference * turns, held)
            for side, part in ((change.below, -0.5), (change.above, 0.5))
        ]
        lengths = np.abs(motions[:, :2]).max(axis=1)
        step = (
            STEP * np.array([grid.separation.spacing[0] for grid in grids]) / np.where(lengths > 0.0, lengths, np.inf)
        )
        of_motion = [curvature(pair, 0.0 * turns, part * step[:, None] * motions) for part in (-1.0, 1.0)]
        for (low, high), width in ((of_shape, change.difference), (of_motion, 2.0 * step)):
            grown = np.where(np.abs(high - low) < JUMP, high - low, 0.0)
            found[key] += np.divide(grown, width, out=np.zeros(len(grids)), where=np.asarray(width) > 0.0)
    return found


FLAT = 1e-12
"""Curvature [1/mm] that is none."""
