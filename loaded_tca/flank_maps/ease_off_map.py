r"""The ease-off topography: how much a flank lacks of the conjugate of its mating flank, point by point.

.. math:: \delta(P) = \frac{E_0 - E(P)}{r_{b2}\,(z_1/z_2)\,|\nabla F|} \ge 0

with the largest lead E of :mod:`loaded_tca.flank_maps.conjugate`, E_0 its highest value on the map and \|grad F\| of
the unmodified flank: material removed along the normal, counted as ``FlankModifications`` count it. Zero where the
flanks are nearest, and everywhere for conjugate flanks; a modified pinion with an unmodified wheel shows its
modification, and to first order the modifications of both gears and the mounting errors add up. It depends neither on
the position nor on the number of teeth in contact.

References
----------
Stadtfeld 1993, Handbook of Bevel and Hypoid Gears (ease-off); Litvin & Fuentes 2004, Gear Geometry and Applied Theory,
chapter 6 (conjugated surfaces).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flank_maps.conjugate import (
    ROUNDING,
    GearName,
    conjugate_contact,
    exchanged,
    mated_grid,
    problems_of_map,
)
from loaded_tca.flank_maps.second_order import SecondOrder, central, flank_lengths, second_order
from loaded_tca.flanks.frame import FlankFrame
from loaded_tca.pairs.gear_pair import GearPair

GRID = (31, 41)
FEWEST = 3
EDGE = 2.0 * ROUNDING
"""Distance beyond an edge of the mating gear [modules] that still counts as on it."""


@dataclass(frozen=True, eq=False)
class EaseOffMap:
    """Ease-off of a flank over the part of it that the mating gear reaches.

    Attributes
    ----------
    gear : {"pinion", "wheel"}
    frame : FlankFrame
        How the flank is shown.
    radius, axial : (profile, lengthwise) array [mm]
        (rho, z) of the grid, from the foot to the tip and from toe to heel (z < 0 to z > 0).
    lengthwise, profile : (profile, lengthwise) array [mm]
        Distance from the middle of the face, and the profile coordinate: roll length, of bevel gears R_m times the arc.
    ease_off : (profile, lengthwise) array [mm]
        Material removed along the normal from the conjugate of the mating flank; zero at its highest point.
    mating_radius, mating_axial : (profile, lengthwise) array [mm]
        The point of the mating gear that each point would touch at the constant ratio.
    angle : (profile, lengthwise) array [rad]
        phi1 (wheel: phi2) at which it would.
    covered : (profile, lengthwise) bool array
        Whether the mating gear's flank reaches so far; where not, beside its slanted edges, it was continued.
    second_order : SecondOrder
        Angles, crownings and twist, of the flank turned about its axis until nothing is off in the middle of the map:
        what is off a bevel gear's flank when it is turned grows with the cone distance.
    """

    gear: GearName
    frame: FlankFrame
    radius: Array
    axial: Array
    lengthwise: Array
    profile: Array
    ease_off: Array
    mating_radius: Array
    mating_axial: Array
    angle: Array
    covered: Mask
    second_order: SecondOrder

    @property
    def corners(self) -> Array:
        """Ease-off [mm] at the foot and at the tip (rows), at toe and heel, or z < 0 and z > 0 (columns): (2, 2)."""
        return self.ease_off[[[0], [-1]], [0, -1]]

    def __repr__(self) -> str:
        shape = " x ".join(str(count) for count in self.ease_off.shape)
        return f"EaseOffMap({self.gear}, {shape} points, up to {1e3 * float(self.ease_off.max()):.4g} um)"


def ease_off_map(pair: GearPair, gear: GearName = "pinion", grid: tuple[int, int] = GRID) -> EaseOffMap:
    """Ease-off of a flank against the conjugate of its mating flank.

    The map covers the part of the flank that the mating gear reaches: along the profile from where the mating gear's
    tip works to the own tip (or the mating gear's form circle), lengthwise between the ends of the narrower gear.

    Parameters
    ----------
    pair : GearPair
        Of any kind, its modifications and mounting errors included.
    gear : {"pinion", "wheel"}
        Whose flank.
    grid : (int, int)
        Points along the profile and along the face, edges included; at least 3 each. Odd numbers have a point in the
        middle, where a crowned flank is highest.

    Returns
    -------
    EaseOffMap

    Raises
    ------
    InputError
        If an argument is out of range.
    GeometryError
        If no part of the flank ever meets the mating gear's, or a part of it meets no flank that could be continued so
        far.

    Examples
    --------
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh, modifications=(FlankModifications(lead_crowning=0.01), FlankModifications()))
    >>> found = ease_off_map(pair)
    >>> (1e3 * found.corners).round(6).tolist()
    [[10.0, 10.0], [10.0, 10.0]]
    >>> found.second_order
    SecondOrder(spiral angle 0 arcmin, pressure angle 0 arcmin, crownings 10 um and 0 um, twist 0 um)
    """
    problems = problems_of_map(gear, grid, FEWEST)
    if problems:
        raise InputError(problems)
    pair = pair.sharp  # the arcs of rounded edges are ten times as deep as what a map shows
    seen = pair if gear == "pinion" else exchanged(pair)
    flank, (rho, z) = seen.pinion.flank, mated_grid(seen, *grid)
    contact = conjugate_contact(seen, rho, z)
    if not contact.exists.all():
        lacking = np.argwhere(~contact.exists)
        where = flank.frame.place(float(rho[*lacking[0]]), float(z[*lacking[0]]))
        raise GeometryError(
            f"no ease-off: at {len(lacking)} of {rho.size} points, first at {where}, the flank meets no flank of the "
            "mating gear at the constant ratio; the mounting errors are too large"
        )
    per_lead = 1.0 / (seen.base_radii[1] * seen.ratio * flank.gradient_norm(rho, z).value)
    from_middle = (contact.lead[central(grid)].mean() - contact.lead) * per_lead
    room = np.minimum(contact.profile_room, contact.lengthwise_room)
    return EaseOffMap(
        gear,
        flank.frame,
        rho,
        z,
        *flank_lengths(flank, rho, z),
        (contact.lead.max() - contact.lead) * per_lead,
        contact.mating_radius,
        contact.mating_axial,
        contact.angle,
        room >= -EDGE * pair.module,
        second_order(flank, rho, z, from_middle),
    )
