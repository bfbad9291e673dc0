"""Half a tooth of a cylindrical gear in its transverse section, as a closed outline: what finite elements need."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from loaded_tca.errors import InputError
from loaded_tca.gears.cylindrical import CylindricalGear

RIM_MODULES = 2.0
"""Depth below the root circle to which the outline goes by default, in normal modules; at most half the radius."""


def half_tooth(gear: CylindricalGear, points: int) -> dict[str, NDArray[np.float64]]:
    """Parts of the outline of half a tooth, from the middle of its tip to the middle of the space.

    Parameters
    ----------
    gear : CylindricalGear
    points : int
        Points along each part, at least 2.

    Returns
    -------
    dict of (points, 2) arrays [mm]
        ``tip_land``, ``flank`` (involute), ``fillet`` (trochoid cut by the rack's rounded tip) and ``root_land``; the
        last point of each is the first of the next. The middle of the tooth is the x axis.

    Raises
    ------
    InputError
        If there are fewer than 2 points.

    References
    ----------
    ISO 21771:2007 (involute); ISO 53:1998 (basic rack).

    Examples
    --------
    >>> parts = half_tooth(CylindricalGear(teeth=20, normal_module=3.0, face_width=25.0), 9)
    >>> [round(float(np.hypot(*part[-1])), 6) for part in parts.values()]
    [33.0, 28.2301, 26.25, 26.25]
    """
    if points < 2:
        raise InputError(f"points: {points} is below 2")
    fillet_radius, fillet_angle = gear.root_fillet(points)
    roll = np.linspace(gear.roll_length(gear.tip_radius), gear.roll_length(gear.form_radius), points)
    tangent = roll / gear.base_radius
    flank_radius = np.hypot(roll, gear.base_radius)
    flank_angle = gear.half_thickness_angle_at_base - (tangent - np.arctan(tangent))
    fillet_radius[0], fillet_angle[0] = flank_radius[-1], flank_angle[-1]
    even = np.linspace(0.0, 1.0, points)
    polar = {
        "tip_land": (np.full(points, flank_radius[0]), even * flank_angle[0]),
        "flank": (flank_radius, flank_angle),
        "fillet": (fillet_radius, fillet_angle),
        "root_land": (
            np.full(points, fillet_radius[-1]),
            fillet_angle[-1] + even * (math.pi / gear.teeth - fillet_angle[-1]),
        ),
    }
    return {name: np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1) for name, (r, angle) in polar.items()}


def transverse_profile(gear: CylindricalGear, points: int, inner_radius: float | None = None) -> NDArray[np.float64]:
    """Closed outline of half a tooth with its part of the rim, counter-clockwise.

    It begins in the middle of the tip, follows :func:`half_tooth` to the middle of the space, goes straight to the
    inner circle, along it, and back along the middle of the tooth.

    Parameters
    ----------
    gear : CylindricalGear
    points : int
        Points along each of the four parts of the tooth and along the inner circle.
    inner_radius : float [mm], optional
        Default: that of the bore; of a gear that is solid or has none given, two modules below the root circle, but at
        least half its radius.

    Returns
    -------
    (n, 2) array [mm]
        The middle of the tooth is the x axis; the last point is the first one.

    Raises
    ------
    InputError
        If the inner radius is not between 0 and the root radius, or there are fewer than 2 points.

    Examples
    --------
    >>> transverse_profile(CylindricalGear(teeth=20, normal_module=3.0, face_width=25.0), 9).shape
    (43, 2)
    """
    solid = max(gear.root_radius - RIM_MODULES * gear.normal_module, 0.5 * gear.root_radius)
    default = 0.5 * gear.bore_diameter if gear.bore_diameter else solid
    inner = default if inner_radius is None else inner_radius
    if not 0.0 < inner < gear.root_radius:
        raise InputError(f"inner_radius: {inner} mm is not between 0 and {gear.root_radius:.6g} mm, the root radius")
    parts = list(half_tooth(gear, points).values())
    angle = np.linspace(math.pi / gear.teeth, 0.0, points)
    rim = np.stack([inner * np.cos(angle), inner * np.sin(angle)], axis=-1)
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:]), rim, parts[0][:1]])
