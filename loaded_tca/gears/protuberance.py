"""Roots that tools with protuberance cut before the flanks are ground: what they leave of a flank, and the notch.

A tool leaves a stock q on the flanks and reaches beyond its straight flank by the protuberance pr, both along the
normal of its flank. Ground flanks are undercut by s_pr = pr - q. Where the stock is larger, the wheel leaves a notch
q - pr deep at the root form circle, as far as the straight flank of the tool went. Lengths are in mm, angles in rad.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import degrees, inf, sqrt
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array, real
from loaded_tca.errors import GeometryError
from loaded_tca.plain import plain
from loaded_tca.roots import find_root

if TYPE_CHECKING:
    from loaded_tca.gears.cylindrical import CylindricalGear

LONGEST_FLANK = 2.0
"""Length of the straight flank of a protuberance over the module, at most."""
SCANNED = 60
"""Points along a protuberance between which the flank is looked for."""
NOTCH_SHARE = 0.2
"""Part of the length of a fillet over which the step of a notch fades out: no element is as small as a notch."""


def protuberance_checks(gear: CylindricalGear) -> Iterator[tuple[bool, str]]:
    """Checks of the protuberance of a tool and of the stock that it leaves."""
    protuberance, stock, angle = real(gear.protuberance), real(gear.grinding_stock), gear.protuberance_angle
    for name, value in (("protuberance", protuberance), ("grinding_stock", stock)):
        fits = 0.0 <= value < 0.25 * gear.normal_module
        yield fits, f"{name}: {plain(value, 6)} mm is not from 0 to a quarter of a module"
    yield (
        protuberance <= 0.0 or stock > 0.0,
        f"protuberance: {plain(protuberance, 6)} mm needs a grinding_stock: without one it would cut into the flank",
    )
    fits = angle is None or 0.0 < real(angle) < gear.pressure_angle
    yield (
        fits,
        f"protuberance_angle: {angle} rad is not between 0 and the pressure angle {plain(gear.pressure_angle, 6)} rad "
        f"({plain(degrees(gear.pressure_angle), 6)} deg)",
    )


def flank_after_protuberance(gear: CylindricalGear) -> float:
    """Slope of the tool's normal where what it undercuts ends on the ground flank.

    Raises
    ------
    GeometryError
        If it does not come back to the flank.
    """
    slopes = np.linspace(gear.pressure_angle, gear.least_slope - LONGEST_FLANK, SCANNED)
    if gear.cut_into_flank(float(slopes[0])) <= 0.0:
        return gear.pressure_angle
    for before, after in pairwise(slopes):
        if gear.cut_into_flank(float(after)) <= 0.0:
            return find_root(gear.cut_into_flank, float(after), float(before))
    raise GeometryError(
        f"{gear.name}: protuberance: the undercut of {plain(gear.residual_undercut, 6)} mm that grinding leaves of it "
        "does not come back to the flank; reduce protuberance_angle or the protuberance"
    )


def without_step(radius: Array, angle: Array, step: float) -> Array:
    """Half thickness angles of a fillet that begins on the ground flank, a step behind that of its tool [rad]."""
    return np.asarray(angle - step * np.maximum(1.0 - _along(radius, angle), 0.0) ** 2)


def tangent_without_step(radius: Array, angle: Array, tangent: tuple[Array, Array], step: float) -> tuple[Array, Array]:
    """Radial and circumferential parts of its unit tangents; ``tangent`` are those that the tool leaves."""
    share = NOTCH_SHARE * _length(radius, angle)[-1]
    around = tangent[1] + radius * step * 2.0 * np.maximum(1.0 - _along(radius, angle), 0.0) / share
    size = np.hypot(tangent[0], around)
    return tangent[0] / size, around / size


def _length(radius: Array, angle: Array) -> Array:
    """Length along a fillet to each of its points [mm]."""
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])


def _along(radius: Array, angle: Array) -> Array:
    """Length along a fillet over the part in which a step fades."""
    length = _length(radius, angle)
    return np.asarray(length / (NOTCH_SHARE * length[-1]))


def notch_factor(depth: float, radius: float) -> float:
    r"""What a grinding notch multiplies the stress correction factor by, :math:`1.3/(1.3 - 0.6\sqrt{t_g/\varrho_g})`.

    Parameters
    ----------
    depth, radius : float [mm]
        t_g and rho_g of the notch.

    References
    ----------
    ISO 6336-3:2006, 7.3, stress correction factor for gears with notches in fillets.

    Examples
    --------
    >>> round(notch_factor(0.05, 1.0), 3)
    1.115
    """
    rest = 1.3 - 0.6 * sqrt(depth / radius) if radius > 0.0 else 0.0
    return 1.3 / rest if rest > 0.0 else inf
