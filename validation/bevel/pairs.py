"""The two bevel pairs of chapter 5 of the reduced-TCA dissertation, its mounting errors, what is computed of a pair.

The source prints no crowning and no relief of the straight pair, and neither hands, signs nor the start of the relief
of the spiral pair. Taken here: everything on the pinion unless said otherwise; right-hand pinion, which drives with
its concave flank; E, P and G as the package counts them, Delta gamma with the opposite sign (it lessens the shaft
angle); Delta H is P, the displacement of the pinion along its axis, as in a V-H check; the reliefs of the spiral pair
start on the pitch cone and remove at their ends what its equation (13) says, c_t ((u - u_0)/L_t)^2 with u the cone
angle [rad].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.gears.bevel_meshes import BevelMesh
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import ContactPath
from validation.unloaded.mounting_error_pairs import hertz_pressure
from validation.unloaded.random_starts import View

Array = NDArray[np.float64]
NONE = FlankModifications()
LENGTHWISE, HEIGHT = "R - R_m, toe to heel", "height above the pitch cone"


@dataclass(frozen=True)
class BevelGears:
    """A bevel pair of the dissertation, its material, and the normal load [N] of its pressures."""

    name: str
    mesh: BevelMesh
    material: Material
    load: float

    def pair(
        self,
        mounting: BevelMounting | None = None,
        pinion: FlankModifications = NONE,
        wheel: FlankModifications = NONE,
    ) -> GearPair:
        """The pair with modifications and mounting errors; the pinion drives."""
        return bevel_pair(
            self.mesh,
            modifications=(pinion, wheel),
            mounting=mounting or BevelMounting(),
            materials=(self.material, self.material),
        )

    def place(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """R - R_m and height above the pitch cone of points of the pinion [mm]."""
        gear = self.mesh.pinion
        height = rho * cos(gear.pitch_angle) - z * sin(gear.pitch_angle)
        return np.hypot(rho, z) - gear.mean_cone_distance, height

    def path_on_pinion(self, path: ContactPath) -> tuple[Array, Array]:
        """R - R_m and height above the pitch cone of a contact path [mm]."""
        return self.place(path.pinion_radius, path.pinion_axial)

    def pressures(self, pair: GearPair, path: ContactPath) -> Array:
        """Pressure after Hertz at each position [MPa]; NaN on an edge."""
        return np.array([hertz_pressure(pair, path[i], self.load) for i in range(len(path))])

    @cached_property
    def view(self) -> View:
        """The toe-heel, root-tip frame."""
        return View(self.place, ("R - R_m", "height"))


STRAIGHT = BevelGears("straight bevel 39/32", bevel_mesh((39, 32), 2.5, 14.0), Material(206e3, 0.3), 1500.0)
"""Table 5: outer module 2.5 mm, shaft angle 90 deg, 20 deg, b 14 mm; applied load 1.5 kN."""
SPIRAL = BevelGears(
    "spiral bevel 17/17",
    bevel_mesh((17, 17), 1.0, 4.8, spiral_angle=radians(35.0)),
    Material(210e3, 0.3),
    55.5e-6 * 210e3 * 1.0 * 4.8,
)
"""Lengths in modules, so module 1 mm; 35 deg, b 4.8; F = 55.5e-6 of E m b."""
RELIEF_LENGTH = 0.16
"""L_t [rad]."""

TABLE_6 = {
    "ΔE": BevelMounting(offset=0.1),
    "ΔA": BevelMounting(pinion_axial=0.1),
    "ΔG": BevelMounting(wheel_axial=0.1),
    "Δγ": BevelMounting(shaft_angle_error=-radians(0.2)),
}
"""Mounting errors of the straight pair."""


def straight_modifications(
    lead_um: float, form: str = "parabolic", relief_um: float = 0.0, member: int = 0
) -> FlankModifications:
    """Lead crowning, and a parabolic tip relief from halfway between pitch and tip cone on, of pinion (0) or wheel."""
    gear = (STRAIGHT.mesh.pinion, STRAIGHT.mesh.wheel)[member]
    start = gear.diameter_at(0.5 * (gear.pitch_angle + gear.tip_angle))
    return FlankModifications(
        lead_crowning=1e-3 * lead_um, lead_crowning_form=form, tip_relief=1e-3 * relief_um, tip_relief_start=start
    )


def spiral_modifications(c1: float, ct: float = 0.0) -> FlankModifications:
    """Lead parabola c1 (R - R_m)^2; tip and root relief from the pitch cone on.

    They remove ct ((u - u_0)/L_t)^2 at the tip and at the start of the active profile; between, they are parabolas in
    the unwound arc, as reliefs of the package are.
    """
    mesh = SPIRAL.mesh
    pitch, (start, tip) = mesh.pinion.pitch_angle, mesh.active_cones[0]
    diameter = mesh.pinion.diameter_at(pitch)
    return FlankModifications(
        lead_crowning=c1 * (0.5 * mesh.pinion.face_width) ** 2,
        tip_relief=ct * ((tip - pitch) / RELIEF_LENGTH) ** 2,
        tip_relief_start=diameter,
        root_relief=ct * ((pitch - start) / RELIEF_LENGTH) ** 2,
        root_relief_start=diameter,
    )
