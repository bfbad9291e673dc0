"""Where one tooth pair hands over to the next, and the step that a tooth edge bridges there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.path import ContactPoint, trace_contact
from loaded_tca.unloaded.tooth_cycle import ToothCycle

SECTIONS, SECTION_PASSES = 16, 4
"""The end of a surface contact is found by cutting a pitch into 16 parts, four times over."""
ENDS = 4
"""The tips and roots of both gears come first in the order of ``_edges_held``, before the sides."""

Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Transfer:
    """Where one tooth pair hands over to another.

    Attributes
    ----------
    pinion_angle : float [rad]
    transmission_error : float [rad]
    pairs : (int, int)
        The leading pair before and after.
    contacts : (ContactPoint, ContactPoint)
        Of the two pairs, each in its own angles.
    """

    pinion_angle: float
    transmission_error: float
    pairs: tuple[int, int]
    contacts: tuple[ContactPoint, ContactPoint]

    @property
    def is_continuous(self) -> bool:
        """Whether the curves cross inside both their ranges.

        Neither contact rests on a tip or a root, where the path of contact has come to its end. Flanks that touch
        along their sides all the way (misaligned, without lead crowning) have curves of their own, which may cross; a
        side that only one of the two contacts rests on is an end like a tip.
        """
        first, second = (_edges_held(contact.edges) for contact in self.contacts)
        return not first[:ENDS].any() and bool((first == second).all())

    def jump(self, pair: GearPair) -> float:
        """Change of the transmission error over the edge contact [rad]; NaN if none but that within a pitch."""
        if self.is_continuous:
            return 0.0
        first, second = (_edges_held(contact.edges) for contact in self.contacts)
        common = first & second
        common[:ENDS] = False
        before, after = (_end_of(pair, one, common, way) for one, way in zip(self.contacts, (-1.0, 1.0), strict=True))
        return after - before


def find_transfers(cycle: ToothCycle, low: float, high: float, teeth: NDArray[np.int_]) -> tuple[Transfer, ...]:
    """Transfers among tooth pairs between two pinion angles, in their order."""
    angles, pairs = cycle.changes(low, high, teeth)
    if not len(angles):
        return ()
    path = trace_contact(cycle.pair, (angles - pairs * cycle.pair.pitch).ravel(), warn=False)
    return tuple(
        Transfer(
            float(angle), float(path.transmission_error[k]), (int(old), int(new)), (path[k], path[k + len(angles)])
        )
        for k, (angle, old, new) in enumerate(zip(angles, *pairs, strict=True))
    )


def _edges_held(edges: Bools) -> Bools:
    """Tips and roots of both gears, then the sides of either: where two faces end together, their edges alternate."""
    pinion, wheel = edges[..., : len(EDGE_NAMES)], edges[..., len(EDGE_NAMES) :]
    return np.concatenate([pinion[..., :2], wheel[..., :2], pinion[..., 2:] | wheel[..., 2:]], axis=-1)


def _end_of(pair: GearPair, contact: ContactPoint, edges: Bools, way: float) -> float:
    """Transmission error where a contact rests on ``edges`` alone again, going one way; NaN if not within a pitch."""
    start, length = contact.pinion_angle, way * pair.pitch
    for _ in range(SECTION_PASSES):
        path = trace_contact(pair, start + length * np.linspace(0.0, 1.0, SECTIONS + 1), warn=False)
        free = path.in_contact & (_edges_held(path.edges) == edges).all(axis=-1)
        if not free.any():
            return math.nan
        first = int(free.argmax())
        if first == 0:
            break
        start, length = float(path.pinion_angle[first - 1]), length / SECTIONS
    return float(path.transmission_error[first])
