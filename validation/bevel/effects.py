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
    """Transmission error at the pitch point [rad] of small displacements d of the wheel: it follows the flank.

    The normal out of the pinion is n = e_y + tan(alpha) e_u - tan(beta) e_R, the lever of its y component the pitch
    radius of the wheel: -(n . d)/(R_m sin(delta_2)). A larger shaft angle takes the wheel outwards by R_m times it.
    """
    gear = gears.mesh.pinion
    sine, cosine = sin(gear.pitch_angle), cos(gear.pitch_angle)
    outwards, heelwards = np.array([cosine, 0.0, -sine]), np.array([sine, 0.0, cosine])
    normal = [0.0, 1.0, 0.0] + tan(gear.pressure_angle) * outwards - tan(gear.spiral_angle) * heelwards
    origin, _ = mounting.place(gears.mesh.shaft_angle)
    displacement = origin + gear.mean_cone_distance * mounting.shaft_angle_error * outwards
    return -float(normal @ displacement) / (gear.mean_cone_distance * sin(gears.mesh.wheel.pitch_angle))


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
