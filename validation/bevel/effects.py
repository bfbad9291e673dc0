"""What a mounting error does to a bevel pair: transmission error, path on the pinion, Hertz pressure along it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import cos, radians, sin, tan

import numpy as np
from numpy.typing import NDArray

from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.teeth import trace_teeth
from validation.bevel.pairs import SPIRAL, BevelGears, spiral_modifications
from validation.unloaded.mounting_error_pairs import ARCSEC

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Effect:
    """The leading contact over one pitch: where it runs, its transmission error, what the pressure is.

    Attributes
    ----------
    pinion_angle, transmission_error : (n,) array [rad, arcsec]
    lengthwise, height : (n,) array [mm]
        R - R_m and height above the pitch cone, on the pinion.
    pressure : (n,) array [MPa]
        After Hertz, under the load of the pair; NaN on an edge.
    on_edge, on_side : (n,) bool array
        Whether the contact lies on any edge; on toe or heel.
    peak_to_peak : float [arcsec]
        Of the gears: the envelope of all teeth over one pitch.
    continuous : bool
        Whether the teeth take over from each other without an edge.
    """

    pinion_angle: Array
    transmission_error: Array
    lengthwise: Array
    height: Array
    pressure: Array
    on_edge: NDArray[np.bool_]
    on_side: NDArray[np.bool_]
    peak_to_peak: float
    continuous: bool

    @property
    def place(self) -> tuple[float, float]:
        """Mean of the path: R - R_m and height [mm]."""
        return float(self.lengthwise.mean()), float(self.height.mean())

    @property
    def mean(self) -> float:
        """Mean transmission error [arcsec]: the constant part, which turns no gear unevenly."""
        return float(self.transmission_error[:-1].mean())

    @property
    def largest_pressure(self) -> float:
        """Largest pressure of the surface contact [MPa]."""
        return float(np.nanmax(self.pressure))


def effect(gears: BevelGears, pair: GearPair) -> Effect:
    """All teeth of a pair over one pitch."""
    mesh = trace_teeth(pair)
    path = mesh.leading_contact
    lengthwise, height = gears.path_on_pinion(path)
    return Effect(
        mesh.pinion_angle,
        mesh.transmission_error * ARCSEC,
        lengthwise,
        height,
        gears.pressures(pair, path),
        path.on_edge,
        path.edges[:, [2, 3, 6, 7]].any(axis=-1),
        mesh.peak_to_peak * ARCSEC,
        mesh.is_continuous,
    )


def first_order_error(gears: BevelGears, mounting: BevelMounting) -> float:
    """Transmission error at the pitch point [rad] of small mounting errors, by virtual work.

    An error opens the contact by its way along the tooth force, and the wheel lags by that much over r_m2. Over the
    tangential force, the tooth force has the textbook components of a right-hand pinion that turns counter-clockwise,
    seen from its heel, and drives:

    - E moves the wheel the way the tangential force pushes it: 1;
    - P and G move pinion and wheel from the apex towards their heels, as their axial forces do:
      tan(alpha) sin(delta_1) + tan(beta) cos(delta_1), and tan(alpha) sin(delta_2) - tan(beta) cos(delta_2);
    - a larger shaft angle lifts the wheel's mean point off the pitch plane by R_m times the error, as the separating
      force does: tan(alpha).

    alpha is the pressure angle of the transverse section, the normal one being given by tan(alpha_n) = tan(alpha)
    cos(beta). Source: Niemann & Winter 1983, Maschinenelemente III, tooth forces of spiral bevel gears.
    """
    pinion, wheel = gears.mesh.pinion, gears.mesh.wheel
    separating, along = tan(pinion.pressure_angle), tan(pinion.spiral_angle)
    opening = (
        mounting.offset
        + mounting.pinion_axial * (separating * sin(pinion.pitch_angle) + along * cos(pinion.pitch_angle))
        + mounting.wheel_axial * (separating * sin(wheel.pitch_angle) - along * cos(wheel.pitch_angle))
        + mounting.shaft_angle_error * pinion.mean_cone_distance * separating
    )
    return -opening / (pinion.mean_cone_distance * sin(wheel.pitch_angle))


def spiral_mounting(e: float = 0.0, h: float = 0.0, gamma_deg: float = 0.0) -> BevelMounting:
    """Delta E, Delta H [mm] and Delta gamma of the source as mounting errors of the package."""
    return BevelMounting(offset=e, pinion_axial=h, shaft_angle_error=-radians(gamma_deg))


@lru_cache
def spiral_effect(c1: float, ct: float, e: float = 0.0, h: float = 0.0, gamma_deg: float = 0.0) -> Effect:
    """Effect of Delta E, Delta H and Delta gamma on the spiral pair."""
    return effect(SPIRAL, SPIRAL.pair(spiral_mounting(e, h, gamma_deg), spiral_modifications(c1, ct)))


@dataclass(frozen=True)
class SingleCurve:
    """Transmission error of one tooth pair over its surface contact: fall before and after the top [arcsec]."""

    before: float
    after: float

    @property
    def fall(self) -> float:
        """From the top to the lower end."""
        return max(self.before, self.after)


def spiral_curve(c1: float, ct: float, e: float = 0.0, h: float = 0.0, positions: int = 49) -> SingleCurve:
    """Curve of one tooth pair of the spiral pair, over two pitches at most."""
    pair = SPIRAL.pair(spiral_mounting(e, h), spiral_modifications(c1, ct))
    path = trace_contact(pair, np.linspace(-1.2, 1.2, positions) * pair.pitch, warn=False)
    curve = path.transmission_error[path.in_contact & ~path.on_edge] * ARCSEC
    top = curve.max()
    return SingleCurve(float(top - curve[0]), float(top - curve[-1]))
