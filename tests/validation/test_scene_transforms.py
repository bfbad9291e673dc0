"""Scenes that are the same pair of gears in other words."""

import math

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.scene import read_scene
from loaded_tca.unloaded import trace_contact
from tests.samples.results import SCENES
from validation.scene_transforms import exchanged

SAME_ANGLE = 1e-10  # [rad] 1e-8 mm on the pitch circles, to which places of contact points are traced
SAME_PLACE = 1e-8  # [mm] the same


def test_exchanged_gears_touch_alike_at_the_angle_where_the_wheel_stands_whatever_the_axial_offset():
    """Equal angles are other states: each gear counts its own from its mid-face, dz tan(beta) along the pitch apart."""
    offset = 1.0
    aligned = read_scene(SCENES / "helical.toml")
    scene = aligned.with_changes({"mounting.axial_offset_mm": offset})
    pair, other = scene.pair(), exchanged(scene).pair()
    path = trace_contact(pair, np.linspace(-0.4, 0.4, 5) * pair.pitch)
    back = trace_contact(other, path.wheel_angle)
    assert_allclose(back.wheel_angle, path.pinion_angle, atol=SAME_ANGLE)
    for one, its_other in (("pinion", "wheel"), ("wheel", "pinion")):
        for place in ("radius", "axial", "lever"):
            seen = getattr(back, f"{one}_{place}")
            assert_allclose(seen, getattr(path, f"{its_other}_{place}"), atol=SAME_PLACE, err_msg=place)
    helix = math.radians(scene.geometry.helix_angle_deg)
    pitch_radius = 0.5 * scene.wheel.teeth * scene.geometry.normal_module_mm / math.cos(helix)
    parted = path.transmission_error - trace_contact(aligned.pair(), path.pinion_angle).transmission_error
    assert_allclose(parted, offset * math.tan(helix) / pitch_radius, rtol=0.0, atol=SAME_ANGLE)
