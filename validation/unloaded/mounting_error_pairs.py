"""The two pairs whose mounting errors are compared, how large the errors are, and what is computed of each pair."""

from dataclasses import dataclass
from math import degrees, radians

import numpy as np
from numpy.typing import NDArray

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded import ContactPoint, relative_curvature, trace_contact

Array = NDArray[np.float64]
CASE = "reduced-TCA dissertation, mounting errors"
ARCSEC = degrees(3600.0)
FORMS = ("parabolic", "circular", "logarithmic")
ERRORS = ("in_plane", "out_of_plane", "centre_distance_error", "axial_offset")
POSITIONS = 21
ROUNDING = 1e-9
"""Rounding of heights and places [mm]."""


@dataclass(frozen=True)
class Gears:
    """One of the two pairs of the dissertation, module 1 mm, 20 deg."""

    name: str
    teeth: tuple[int, int]
    helix_deg: float
    face_width: float
    crowning: float
    load: float
    material: Material

    @property
    def mesh(self) -> CylindricalMesh:
        """Macro geometry, pinion right-hand."""
        hands = zip(self.teeth, (1.0, -1.0), strict=True)
        return CylindricalMesh(
            *(CylindricalGear(z, 1.0, self.face_width, helix_angle=s * radians(self.helix_deg)) for z, s in hands)
        )

    def pair(self, mounting: Mounting | None = None, **modifications: float | str) -> GearPair:
        """The pair with its lead crowning on the pinion, unless other modifications are given."""
        chosen = {"lead_crowning": self.crowning, **modifications}
        return cylindrical_pair(
            self.mesh,
            modifications=(FlankModifications(**chosen), FlankModifications()),
            mounting=mounting or Mounting(),
            materials=(self.material, self.material),
        )


SPUR = Gears("spur 25/25", (25, 25), 0.0, 10.0, 0.0025 * 5.0**2, 11.2, Material(200e3, 0.3))
"""a1 = 0.0025/mm; F = 56e-6 of E m^2."""
HELICAL = Gears("helical 40/37", (40, 37), 14.0, 20.0, 0.0051 * 10.0**2, 200.0, Material(206e3, 0.3))
"""c1 = 0.0051/mm, the smallest of Table 3."""
PICTURED = {SPUR: SPUR.crowning, HELICAL: 0.03}
"""Lead crowning [mm] of the picture: with 510 um the paths of the helical pair lie on each other."""
LARGEST = {
    SPUR: dict(zip(ERRORS, (0.0175, 0.0175, 0.2, 0.2), strict=True)),
    HELICAL: dict(zip(ERRORS, (radians(0.2), radians(0.2), 0.2, 0.2), strict=True)),
}


def hertz_pressure(pair: GearPair, contact: ContactPoint, load: float) -> float:
    """Largest pressure after Hertz [MPa]; NaN where it does not hold."""
    if contact.on_edge or contact.on_line:
        return float("nan")
    k = relative_curvature(pair, contact)
    return point_contact(load, (k.across, k.along), pair.contact_modulus).max_pressure


def shift(gears: Gears, mounting: Mounting, **modifications: float | str) -> float:
    """Axial coordinate of the contact at phi1 = 0 on the pinion [mm]."""
    return float(trace_contact(gears.pair(mounting, **modifications), [0.0]).pinion_axial[0])


def pressures_along(gears: Gears, mounting: Mounting, points: int = 7, **modifications: float | str) -> Array:
    """Hertz pressure along the surface contact of one tooth pair [MPa]."""
    pair = gears.pair(mounting, **modifications)
    path = trace_contact(pair, np.linspace(-0.7, 0.7, points) * pair.pitch)
    return np.array([hertz_pressure(pair, path[i], gears.load) for i in range(points)])
