r"""The ease-off topography: how much a flank lacks of the conjugate of its mating flank, point by point.

.. math:: \delta(P) = \frac{E_0 - E(P)}{r_{b2}\,(z_1/z_2)\,|\nabla F|} \ge 0

with the largest lead E of :mod:`loaded_tca.flank_maps.conjugate`, E_0 its highest value on the map and \|grad F\| of
the unmodified flank: material removed along the normal, counted as ``FlankModifications`` count it. Zero where the
flanks are nearest, and everywhere for conjugate flanks; a modified pinion with an unmodified wheel shows its
modification, and to first order the modifications of both gears and the mounting errors add up. It depends neither on
the position nor on the number of teeth in contact.

Engineers call a field on a flank by its second-order coefficients,

.. math:: f = a_1 + a_2 x + a_3 y + a_4 x y + a_5 x^2 + a_6 y^2

by least squares, x lengthwise and y along the profile, both from the middle: the polynomial of
:class:`loaded_tca.flanks.FlankModifications`, read the other way round.

References
----------
Stadtfeld 1993, Handbook of Bevel and Hypoid Gears (ease-off); Litvin & Fuentes 2004, Gear Geometry and Applied Theory,
chapter 6 (conjugated surfaces).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, GearName, Mask
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flank_maps.conjugate import (
    ROUNDING,
    conjugate_contact,
    exchanged,
    mated_grid,
    problems_of_map,
)
from loaded_tca.flanks.base import Flank, FlankFrame
from loaded_tca.flanks.spline import flank_coordinates
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.units import MICROMETRES


@dataclass(frozen=True)
class SecondOrder:
    """Second-order coefficients of material removed from a part of a flank.

    Attributes
    ----------
    polynomial : 6 floats [mm, 1, 1, 1/mm, 1/mm, 1/mm]
        a1 to a6, as ``FlankModifications(polynomial=...)`` takes them.
    origin : (float, float) [mm]
        Lengthwise and profile coordinate of the middle, x = y = 0.
    size : (float, float) [mm]
        Length and height of the part in these coordinates, in its middle.
    arcs : (float, float)
        Millimetres on the surface, in the middle, for one of x and one of y.
    residual : float [mm]
        Root of the mean square that the polynomial misses.
    """

    polynomial: tuple[float, ...]
    origin: tuple[float, float]
    size: tuple[float, float]
    arcs: tuple[float, float]
    residual: float

    @property
    def named(self) -> dict[str, float]:
        """All angles, slopes, crownings and the twist by names with their units, for tables."""
        arcmin, um = math.degrees(60.0), MICROMETRES
        return {
            "spiral angle [arcmin]": arcmin * self.spiral_angle,
            "pressure angle [arcmin]": arcmin * self.pressure_angle,
            "lengthwise slope [um]": um * self.lengthwise_slope,
            "profile slope [um]": um * self.profile_slope,
            "lengthwise crowning [um]": um * self.lengthwise_crowning,
            "profile crowning [um]": um * self.profile_crowning,
            "twist [um]": um * self.twist,
            "residual, rms [um]": um * self.residual,
        }

    @property
    def spiral_angle(self) -> float:
        """Angle [rad] by which the flank is turned lengthwise; positive: material off towards the heel (z > 0)."""
        return math.atan(self.polynomial[1] / self.arcs[0])

    @property
    def pressure_angle(self) -> float:
        """Angle [rad] by which the flank is turned along the profile; positive: material off towards the tip."""
        return math.atan(self.polynomial[2] / self.arcs[1])

    @property
    def lengthwise_slope(self) -> float:
        """C_H_beta, the rise over the length [mm]."""
        return self.polynomial[1] * self.size[0]

    @property
    def profile_slope(self) -> float:
        """C_H_alpha, the rise over the height [mm]."""
        return self.polynomial[2] * self.size[1]

    @property
    def twist(self) -> float:
        """S, the lengthwise slope at the tip less that at the foot [mm]."""
        return self.polynomial[3] * self.size[0] * self.size[1]

    @property
    def lengthwise_crowning(self) -> float:
        """C_beta, at both ends of the length [mm]."""
        return self.polynomial[4] * (0.5 * self.size[0]) ** 2

    @property
    def profile_crowning(self) -> float:
        """C_alpha, at both ends of the height [mm]."""
        return self.polynomial[5] * (0.5 * self.size[1]) ** 2

    def __repr__(self) -> str:
        angles = [60.0 * math.degrees(angle) for angle in (self.spiral_angle, self.pressure_angle)]
        lengths = [1e3 * length for length in (self.lengthwise_crowning, self.profile_crowning, self.twist)]
        spiral, pressure, beta, alpha, twist = (f"{plain(round(value, 4) + 0.0, 3)}" for value in (*angles, *lengths))
        return (
            f"SecondOrder(spiral angle {spiral} arcmin, pressure angle {pressure} arcmin, "
            f"crownings {beta} um and {alpha} um, twist {twist} um)"
        )


def second_order(flank: Flank, rho: Array, z: Array, removed: Array) -> SecondOrder:
    """Second-order coefficients of material removed at a grid of points of a flank.

    Parameters
    ----------
    flank : Flank
    rho, z, removed : (profile, lengthwise) array [mm]
        The grid, evenly spaced, and the material removed; at least three each way.

    Returns
    -------
    SecondOrder

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> flank = cylindrical_pair(CylindricalMesh(*gears)).pinion.flank
    >>> rho, z = flank.grid(9, 9)
    >>> second_order(flank, rho, z, 0.010 * (z / 12.5) ** 2)
    SecondOrder(spiral angle 0 arcmin, pressure angle 0 arcmin, crownings 10 um and 0 um, twist 0 um)
    """
    x, y = flank_lengths(flank, rho, z)
    length, height = x[:, -1] - x[:, 0], y[-1] - y[0]
    origin = (float((x[:, 0] + 0.5 * length).mean()), float((y[0] + 0.5 * height).mean()))
    size = (float(length.mean()), float(height.mean()))
    u, v = ((part - middle) / (0.5 * whole) for part, middle, whole in zip((x, y), origin, size, strict=True))
    terms = np.stack([np.ones_like(u), u, v, u * v, u**2, v**2], axis=-1).reshape(-1, 6)
    scaled = np.linalg.lstsq(terms, removed.ravel())[0]
    missed = removed.ravel() - terms @ scaled
    half = 0.5 * np.array(size)
    lengths = np.array([1.0, half[0], half[1], half[0] * half[1], half[0] ** 2, half[1] ** 2])
    middle_rho, middle_z = (part[central(u.shape)].mean() for part in (rho, z))
    theta, along = flank.theta(middle_rho, middle_z), flank.lengthwise_coordinate(middle_rho, middle_z)
    up = flank.profile_coordinate(middle_rho, middle_z) * flank.profile_unit
    steps = np.linalg.inv(np.array([[along.rho, along.z], [up.rho, up.z]], dtype=float))
    tangents = np.array([[1.0, middle_rho * theta.rho, 0.0], [0.0, middle_rho * theta.z, 1.0]], dtype=float)
    arcs = np.linalg.norm(steps.T @ tangents, axis=-1).tolist()
    return SecondOrder(
        polynomial=tuple((scaled / lengths).tolist()),
        origin=origin,
        size=size,
        arcs=(arcs[0], arcs[1]),
        residual=float(np.sqrt((missed**2).mean())),
    )


def flank_lengths(flank: Flank, rho: Array, z: Array) -> tuple[Array, Array]:
    """Lengthwise and profile coordinate (...) of points of a flank, both in mm."""
    profile, lengthwise = flank_coordinates(flank, rho, z)
    return lengthwise, profile * flank.profile_unit


def central(shape: tuple[int, ...]) -> tuple[slice, ...]:
    """The middle of a grid: along each axis its central point, or the central two."""
    return tuple(slice((count - 1) // 2, count // 2 + 1) for count in shape)


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

    @property
    def named(self) -> dict[str, float]:
        """Corners, angles, slopes, crownings and the twist by names with their units."""
        places = [f"{height}, {end}" for height in ("foot", "tip") for end in ("toe or z < 0", "heel or z > 0")]
        corners = (MICROMETRES * self.corners).ravel().tolist()
        return {f"{place} [um]": value for place, value in zip(places, corners, strict=True)} | self.second_order.named

    def __repr__(self) -> str:
        shape = " x ".join(str(count) for count in self.ease_off.shape)
        return f"EaseOffMap({self.gear}, {shape} points, up to {plain(1e3 * float(self.ease_off.max()))} um)"


@checked
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
    >>> ease_off = ease_off_map(pair)
    >>> (1e3 * ease_off.corners).round(6).tolist()
    [[10.0, 10.0], [10.0, 10.0]]
    >>> ease_off.second_order
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
