"""First guess of how tooth pairs give way, before their gaps are known: after Hertz, by curvatures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.edges.places import edge_distances
from loaded_tca.loaded.balance import PowerLaw
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded import ContactPoint, relative_curvature
from loaded_tca.unloaded.curvature import relative_curvatures

SLENDER, LINE_EXPONENT = 4.0, 0.9
"""Deformation of a contact along the face: so many times F/(E* b), and its growth with the force."""
SLICES = 8
"""Of a line."""


def first_law(pair: GearPair, contact: ContactPoint, load: float) -> tuple[PowerLaw, float]:
    """Hertz's law of the curvatures at a contact point, or of a slender contact over the face; half of its length [mm].

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    load : float [N]
        Positive.
    """
    curvature = relative_curvature(pair, contact)
    longest = math.hypot(pair.face_width, pair.pinion.flank.extent[0])
    if curvature.across >= curvature.along > 0.0:
        ellipse = point_contact(load, (curvature.across, curvature.along), pair.contact_modulus)
        longest = min(ellipse.semi_major, longest)
        if 2.0 * ellipse.semi_major < pair.face_width:
            return PowerLaw(load, ellipse.approach), longest
    return PowerLaw(load, SLENDER * load / (pair.contact_modulus * pair.face_width), LINE_EXPONENT), longest


@dataclass(frozen=True, eq=False)
class ExpectedLine:
    """Slices along a contact, as ``ContactGrid`` has them, and how they share its load.

    Attributes
    ----------
    y : (ny,) array [mm]
        Middles of the slices along the contact, from the contact point.
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        Rows: across, along and normal to the contact.
    force_line : (ny,) array [mm]
        Where across the contact the forces act, from the contact point.
    force : (ny,) array
        Of the slices, in any unit.
    """

    y: Array
    origin: Array
    axes: Array
    force_line: Array
    force: Array


def expected_lines(
    pair: GearPair, contacts: Sequence[ContactPoint], half_lengths: Sequence[float]
) -> list[ExpectedLine]:
    """Lines along n contacts, their line loads those of ellipses that are cut off where the flanks end.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of n ContactPoint
    half_lengths : sequence of n float [mm]
        Of the ellipses.
    """
    axes = np.array([curvature.axes for curvature in relative_curvatures(pair, contacts)])
    origins, middles = np.array([one.point for one in contacts]), (2.0 * np.arange(SLICES) + 1.0) / SLICES - 1.0
    y = np.asarray(half_lengths)[:, None] * middles
    points = origins[:, None] + y[..., None] * axes[:, None, 1]
    there = edge_distances(pair.sharp, *pair.on_flanks(points)).min(axis=-1) >= 0.0
    there |= ~there.any(axis=1, keepdims=True)  # in a corner of a flank
    force = np.where(there, 1.0 - middles**2, 0.0)
    held = np.zeros(SLICES)
    return [ExpectedLine(y[n], origins[n], axes[n], held, force[n]) for n in range(len(contacts))]
