"""Gears, loads and meshes that comparisons of root stress share."""

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from loaded_tca.arrays import Array
from loaded_tca.compliance import FlankLine, MeshDensity, RootStress
from loaded_tca.compliance.body import ToothFrame, gear_nodes
from loaded_tca.compliance.root_stress import OUTLINE, root_influence
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear import Gear

CASE, FINER = "root stress", "finer mesh of the same elements"


def spur_pair_gear(
    teeth: int = 25, width: float = 20.0, shift: float = 0.0, rounding: float = 0.38, helix_deg: float = 0.0
) -> Gear:
    """Pinion of module 3 beside a wheel of 37 teeth."""
    pinion, wheel = (
        CylindricalGear(z, 3.0, width, helix_angle=math.radians(beta), profile_shift=x, root_radius_coefficient=rho)
        for z, beta, x, rho in ((teeth, helix_deg, shift, rounding), (37, -helix_deg, 0.0, 0.38))
    )
    return cylindrical_pair(CylindricalMesh(pinion, wheel)).pinion


def line_on(
    model: RootStress, height: float, part: float = 1.0, middle: float = 0.5, rise: float = 0.0
) -> tuple[FlankLine, Array]:
    """Force of 1 N spread evenly over a part of the face, at a height of the flank of tooth 0 that rises along it."""
    places, weights = np.polynomial.legendre.leggauss(40)
    flank = model.frame.places(height + 0.5 * part * rise * places, middle + 0.5 * part * places)
    x, y, z = flank.point.T
    return FlankLine(0, np.hypot(x, y), z), 0.5 * weights


def model_of(gear: Gear, density: MeshDensity) -> RootStress:
    """Model that is made, not taken from what is kept."""
    frame = ToothFrame(gear, gear_nodes(gear, density, OUTLINE))
    return RootStress(frame, root_influence(frame))


def finer(density: MeshDensity) -> MeshDensity:
    """Half as many elements more in every direction, the outermost layers half as thick."""
    section = {name: 3 * getattr(density, name) // 2 for name in ("through", "flank", "fillet", "land", "rim")}
    layers, coarse = np.arange(section["through"] // 2), np.arange(density.through // 2)
    half = 2.0 * (density.grading**coarse).sum()  # of the tooth, over the thickness of its outermost layer
    grading = float(brentq(lambda grading: (grading**layers).sum() - half, 1.0, 10.0))
    lengthwise = 2 * math.ceil(0.75 * density.lengthwise)
    return replace(density, grading=grading, skin=0.5 * density.skin, lengthwise=lengthwise, **section)
