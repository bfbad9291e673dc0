"""Gears and models that the tests of the tooth compliance share."""

from functools import cache

import numpy as np

from loaded_tca.compliance import FlankLine, GearCompliance, GearTooth, MeshDensity, gear_compliance
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.tooth import tooth_forms

WIDTH = 20.0
COARSE = MeshDensity(lengthwise=4)


def spur_mesh(width=WIDTH, helix_angle=0.0) -> CylindricalMesh:
    gears = [
        CylindricalGear(teeth=z, normal_module=3.0, face_width=width, helix_angle=beta)
        for z, beta in ((25, helix_angle), (37, -helix_angle))
    ]
    return CylindricalMesh(*gears)


def both_senses(mesh: CylindricalMesh) -> tuple[GearPair, GearPair]:
    return cylindrical_pair(mesh, sense="positive"), cylindrical_pair(mesh, sense="negative")


def pinion(bore_diameter=None, width=WIDTH, **material) -> GearTooth:
    mesh = spur_mesh(width)
    pair, backs = both_senses(mesh)
    return GearTooth(
        (pair.pinion.flank, backs.pinion.flank), tooth_forms(mesh)[0], bore_diameter=bore_diameter, **material
    )


@cache
def model(density: MeshDensity = COARSE, side: int = 1, bore_diameter: float | None = None) -> GearCompliance:
    return gear_compliance(pinion(bore_diameter), side, density)


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
