"""Where the unloaded contact point of a tooth pair comes into its flanks and leaves them."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.errors import GeometryError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.path import ContactPoint, trace_contact

ROUNDS, FINENESS = 4, 13
"""Rounds in which an end of the path of contact is found, and angles of each: to 5e-5 of the span."""
FARTHEST = 4.0
"""Pitches before and after the pitch point up to which the ends are looked for."""


def contact_span(pair: GearPair) -> tuple[ContactPoint | None, ContactPoint | None]:
    """Ends of the contact of a tooth pair within its flanks, modifications and mounting errors included.

    Parameters
    ----------
    pair : GearPair

    Returns
    -------
    at_root, at_tip : ContactPoint or None
        Where the contact point comes to an edge of a flank, towards root and tip of the pinion; None if it comes to
        none within four pitches, or lies on one at the pitch point already. If the pinion drives, contact begins
        towards its root.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh)
    >>> at_root, at_tip = contact_span(pair)
    >>> pitches = float(at_tip.pinion_angle - at_root.pinion_angle) / pair.pitch
    >>> round(pitches, 2), round(mesh.transverse_contact_ratio, 2)
    (1.73, 1.73)
    """
    farthest = FARTHEST * pair.driving * pair.pitch
    return _end_of_contact(pair, -farthest), _end_of_contact(pair, farthest)


def _end_of_contact(pair: GearPair, farthest: float) -> ContactPoint | None:
    """Last contact before the contact point comes to an edge, between the pitch point and an angle [rad]."""
    low, high, last = 0.0, farthest, None
    for _ in range(ROUNDS):
        try:
            path = trace_contact(pair, np.linspace(low, high, FINENESS), warn=False)
        except GeometryError:  # nothing is in contact on that side
            return None
        outside = path.on_edge | ~path.in_contact
        if not outside.any() or outside[0]:
            return None
        first = int(np.argmax(outside))
        low, high, last = path.pinion_angle[first - 1], path.pinion_angle[first], path[first - 1]
    return last


def path_letters(at_root: float, at_tip: float, pitch: float) -> dict[str, float]:
    """Points A, B, D and E of a path of contact, as angles or as lengths on it.

    Parameters
    ----------
    at_root, at_tip : float
        Its ends A and E towards root and tip of the pinion; NaN: not known.
    pitch : float
        In the same unit, negative where the first is larger than the second.

    Returns
    -------
    dict
        Without what is not known, and with B and D only where one pair alone is in contact between them.

    Examples
    --------
    >>> path_letters(0.0, 1.6, 1.0)
    {'A': 0.0, 'B': 0.6000000000000001, 'D': 1.0, 'E': 1.6}
    """
    points = {"A": at_root, "B": at_tip - pitch, "D": at_root + pitch, "E": at_tip}
    alone = 1.0 < (at_tip - at_root) / pitch < 2.0
    return {name: place for name, place in points.items() if math.isfinite(place) and (alone or name in "AE")}


def roll_lengths_of_flanks(
    pair: GearPair, at_root: ContactPoint | None, at_tip: ContactPoint | None
) -> dict[str, float]:
    """Points A, B, D and E of the path of contact of the flanks of a cylindrical pair, as roll lengths of the pinion.

    Parameters
    ----------
    pair : GearPair
    at_root, at_tip : ContactPoint or None
        Its ends, as :func:`contact_span` finds them.

    Returns
    -------
    dict [mm]
        As of :func:`path_letters`.
    """
    coordinate = pair.pinion.flank.profile_coordinate
    begin, end = (
        math.nan if one is None else float(coordinate(np.array(one.pinion_radius), np.array(one.pinion_axial)).value)
        for one in (at_root, at_tip)
    )
    return path_letters(begin, end, pair.pitch * pair.base_radii[0])
