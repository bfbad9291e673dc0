"""Gears and models that the tests of the tooth compliance share."""

from functools import cache

import numpy as np

from loaded_tca.compliance import FlankLine, GearCompliance, MeshDensity, gear_compliance
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear import Gear

WIDTH = 20.0
COARSE = MeshDensity(lengthwise=4)


def spur_mesh(width=WIDTH, helix_angle=0.0, bore_diameters=(None, None)) -> CylindricalMesh:
    gears = [
        CylindricalGear(teeth=z, normal_module=3.0, face_width=width, helix_angle=beta, bore_diameter=bore)
        for z, beta, bore in zip((25, 37), (helix_angle, -helix_angle), bore_diameters, strict=True)
    ]
    return CylindricalMesh(*gears)


def pinion(bore_diameter=None, width=WIDTH, side=1, material=Material()) -> Gear:
    """Of a spur pair, in contact with the flank of a side."""
    sense = "positive" if side > 0 else "negative"
    mesh = spur_mesh(width, bore_diameters=(bore_diameter, None))
    return cylindrical_pair(mesh, sense=sense, materials=(material, Material())).pinion


@cache
def model(density: MeshDensity = COARSE, side: int = 1, bore_diameter: float | None = None) -> GearCompliance:
    return gear_compliance(pinion(bore_diameter, side=side), density)


PLACES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def line(gear: GearCompliance, height: float, part: float = 1.0, tooth: int = 0, middle: float = 0.5) -> FlankLine:
    """Along a part of the face at a height on the flank."""
    flank = gear.frame.places(np.full(40, height), middle + 0.5 * part * PLACES)
    x, y, z = flank.point.T
    return FlankLine(tooth, np.hypot(x, y), z)


def even(compliance: np.ndarray) -> float:
    """Mean displacement under a unit force spread evenly over the line."""
    return 0.25 * float(WEIGHTS @ compliance @ WEIGHTS)


def within(gear: GearCompliance, height: float, part: float = 1.0, middle: float = 0.5) -> float:
    """Mean displacement of a line of a spur gear under a unit force spread evenly over it."""
    one = line(gear, height, part, middle=middle)
    return even(gear.within(one, np.abs(one.z[:, None] - one.z)))


def between(gear: GearCompliance, at: FlankLine, under: FlankLine) -> float:
    """Mean displacement of the middles below a line under a unit force spread evenly over another."""
    return even(gear.between(at, under))
