"""Teeth of face-milled gears, cut after machine settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from loaded_tca.errors import GeometryError
from loaded_tca.flanks.base import ConeFrame, Flank, unmodified
from loaded_tca.flanks.bevel import chebyshev_nodes, face_cone_angles
from loaded_tca.flanks.face_milled import MOST_FLANKS, GeneratedFlank, generated_flank, tooth_angle, tooth_angle_at
from loaded_tca.flanks.modification import FlankModifications, modified
from loaded_tca.gears.face_milled import BLADE_SIGNS, FaceMilledGear
from loaded_tca.plain import plain
from loaded_tca.tooth.families import FILLET_RADIUS_COEFFICIENT, RootCone, ToothForm, ToothGeometry
from loaded_tca.tooth.fillet import ApexSpheres, ArcFillet

TIP_POINTS = 9
"""Points along the face cone at which the thickness of the tooth is checked."""


@dataclass(frozen=True)
class FaceMilledTooth(ToothGeometry):
    """Teeth of a face-milled gear; their root is the root cone of the blank.

    Parameters
    ----------
    gear : FaceMilledGear
    modifications : FlankModifications
    exact : bool
        Solve the generating equations at every point of a flank; otherwise its B-spline is taken.
    """

    gear: FaceMilledGear
    modifications: FlankModifications = FlankModifications()
    exact: bool = False

    @property
    def unmodified(self) -> ToothGeometry:
        """These teeth without modifications."""
        return replace(self, modifications=FlankModifications())

    def nominal(self, side: int) -> Flank:
        """Generated flank of a side.

        Raises
        ------
        InputError
            If the cutter has no blade for it.
        GeometryError
            If the flank is undercut or not cut at all, or meets the other one below the face cone.
        """
        return _nominal(self.gear, side, self.exact)

    def modified(self, nominal: Flank) -> Flank:
        """The flank with its modifications; the profile runs from the form line to the tip."""
        generated, blank = unmodified(nominal), self.gear.blank
        assert isinstance(generated, GeneratedFlank)
        distance, (tip, foot) = blank.middle_cone_distance, generated.mean_cone_angles

        def diameter(angle: float) -> float:
            sine = math.sin(angle)
            return 2.0 * distance * (sine if angle <= 0.5 * math.pi else 2.0 - sine)

        def height(of: float) -> float:
            sine = 0.5 * of / distance
            angle = math.asin(sine) if sine <= 1.0 else math.pi - math.asin(2.0 - sine)
            return generated.mean_height * (angle - foot) / (tip - foot)

        ends = diameter(foot), diameter(tip)
        return modified(nominal, self.modifications, blank.face_width, ends, height, owner=self.gear.name)

    def form(self) -> ToothForm:
        """Spheres about the apex, the root cone, and arcs of the larger edge radius of the blades, or what fits.

        Blades without an edge radius get that of a basic rack, 0.38 mean normal modules.

        Raises
        ------
        InputError
            If the cutter has one blade only.
        """
        gear, blank = self.gear, self.gear.blank
        rho, z = (blank.mean_cone_distance * part(blank.pitch_angle) for part in (math.sin, math.cos))
        half_angle = 0.5 * tooth_angle_at(gear, rho, z)
        radius = max(gear.cutter.blade(flank).edge_radius for flank in BLADE_SIGNS)
        if radius == 0.0:
            spiral = generated_flank(gear, "concave").angles.spiral
            radius = FILLET_RADIUS_COEFFICIENT * 2.0 * rho * math.cos(spiral) / gear.teeth
        root = RootCone(blank.root_angle, -blank.root_apex)
        return ToothForm(gear.teeth, half_angle, ApexSpheres(), root, ArcFillet(radius), largest_that_fits=True)


@lru_cache(maxsize=MOST_FLANKS)
def _nominal(gear: FaceMilledGear, side: int, exact: bool) -> Flank:
    """Generated flank of a side; its B-spline takes far longer than its modifications."""
    flank = generated_flank(gear, gear.flank_name(side))
    if gear.cutter.concave is not None and gear.cutter.convex is not None:
        _require_tip(gear)
    return flank if exact else flank.as_spline()


@lru_cache(maxsize=MOST_FLANKS)
def _require_tip(gear: FaceMilledGear) -> None:
    """Refuse a tooth whose two flanks, cut with one set of machine settings, meet below the face cone."""
    blank = gear.blank
    distance = chebyshev_nodes(blank.cone_distances, TIP_POINTS)
    angle = face_cone_angles((blank.face_angle, blank.face_apex), distance)
    rho, z = distance * np.sin(angle), distance * np.cos(angle)
    thickness = rho * tooth_angle(gear, rho, z)
    worst = int(np.argmin(thickness))
    if not thickness[worst] > 0.0:
        frame = ConeFrame(blank.pitch_angle, blank.middle_cone_distance)
        raise GeometryError(
            f"{gear.name}: pointed tooth: its flanks lie {plain(-thickness[worst], 3)} mm beyond each other at the "
            f"tip, {frame.place(float(rho[worst]), float(z[worst]))}; lower face_angle, or bring the point "
            "radii of the cutter nearer to each other"
        )
