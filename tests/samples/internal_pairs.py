"""Internal pairs that the tests share."""

import math

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, InternalMesh, RingGear
from loaded_tca.pairs import Mounting, internal_pair

NONE = FlankModifications()


def internal_mesh(teeth=(25, 60), module=3.0, width=25.0, helix_deg=0.0, shifts=(0.3, 0.0), distance=None, **ring):
    """Pinion and ring of one hand; the ring's teeth are short enough to leave the pinion's root alone."""
    helix = math.radians(helix_deg)
    transverse = module / math.cos(helix)
    given = {"tip_diameter": teeth[1] * transverse - 1.6 * module, **ring}
    pinion = CylindricalGear(teeth[0], module, width, helix_angle=helix, profile_shift=shifts[0], name="pinion")
    wheel = RingGear(-teeth[1], module, width, helix_angle=helix, profile_shift=shifts[1], name="wheel", **given)
    return InternalMesh(pinion, wheel, distance)


def ring_pair(pinion=NONE, wheel=NONE, mounting=None, driving="pinion", sense="positive", **mesh):
    return internal_pair(
        internal_mesh(**mesh),
        modifications=(pinion, wheel),
        mounting=mounting or Mounting(),
        driving=driving,
        sense=sense,
    )


SCENE = """
title = "planet and ring"
[pair]
type = "cylindrical"
normal_module_mm = 3.0
helix_angle_deg = 15.0
[pinion]
teeth = 25
face_width_mm = 25.0
profile_shift = 0.3
[pinion.modifications]
lead_crowning_um = 5.0
[wheel]
teeth = -60
face_width_mm = 25.0
tip_diameter_mm = 181.5
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 300.0
[analysis]
positions = 3
accuracy = 0.05
"""
