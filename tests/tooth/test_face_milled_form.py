"""Complete teeth of face-milled gears: slot widths, the root cone with its own apex, fillets of the blades."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.gears import Cutter, FaceMilledMesh
from loaded_tca.pairs import mating_teeth
from loaded_tca.pairs.face_milled import face_milled_pair
from loaded_tca.tooth import ArcFillet, Resolution, build_tooth, tooth_forms
from tests.samples.face_milled import published_pinion, published_wheel

SIGMA = np.radians(95.0)


def mesh(pinion=None, wheel=None):
    return FaceMilledMesh(pinion or published_pinion(), wheel or published_wheel(), SIGMA)


def flanks(gears, member):
    """Flanks of the sides s = +1 and s = -1 of the pinion or the wheel."""
    pairs = [face_milled_pair(*gears.gears, pinion_flank=flank) for flank in ("concave", "convex")]
    both = sorted((getattr(pair, member).flank for pair in pairs), key=lambda flank: -flank.side)
    return both[0], both[1]


def test_tooth_is_what_the_cutter_leaves_of_the_pitch():
    """A slot of the flat wheel is that of the blades: their distance at the tips, and wider by their angles above."""
    gears = mesh()
    form, gear = tooth_forms(gears)[1], gears.wheel
    plus, minus = flanks(gears, "wheel")
    rho, z = (part[0, 1] for part in plus.grid(9, 3))  # on the form line at mid-face
    tooth = 2.0 * form.half_thickness_angle + float(plus.theta(rho, z).value) - float(minus.theta(rho, z).value)
    height = np.hypot(rho, z) * np.sin(np.arctan2(rho, z) - gear.blank.root_angle)
    slot = (2.0 * np.pi / gear.teeth - tooth) * rho * np.cos(np.radians(35.0))
    point_width = 96.439269791 - 94.060730209
    flat = point_width + 2.0 * height * np.tan(np.radians(20.0))
    assert_allclose(slot, flat, rtol=0.02)  # the blades are hollow, and the wheel is not quite flat


def test_root_lies_on_the_cone_of_the_blank_about_its_own_apex():
    gears = mesh(replace(published_pinion(), blank=replace(published_pinion().blank, root_apex=0.4)))
    form = tooth_forms(gears)[0]
    tooth = build_tooth(flanks(gears, "pinion"), form, Resolution(9, 5, 3, 7))
    root = tooth.outline[0]
    rho, z = np.hypot(root[:, 0], root[:, 1]), root[:, 2]
    assert_allclose(np.arctan2(rho, z + 0.4), gears.pinion.blank.root_angle, atol=1e-12)


def test_fillet_is_the_larger_edge_radius_or_one_of_a_basic_rack():
    pinion = published_pinion()
    rounder = replace(pinion.cutter, convex=replace(pinion.cutter.convex, edge_radius=0.3))
    sharp = Cutter(*(replace(blade, edge_radius=0.0) for blade in (pinion.cutter.concave, pinion.cutter.convex)))
    radii = [
        tooth_forms(mesh(replace(pinion, cutter=cutter)))[0].fillet.radius for cutter in (pinion.cutter, rounder, sharp)
    ]
    assert radii[:2] == [0.20845, 0.3]
    assert_allclose(radii[2], 0.38 * 2.94, rtol=0.01)  # mean normal module
    assert tooth_forms(mesh(), fillet_radius=0.5)[1].fillet == ArcFillet(0.5)


def test_tooth_of_the_other_hand_is_the_mirror_image():
    gears = mesh()
    hands = {"left": "right", "right": "left"}
    mirrored = mesh(*(replace(gear, blank=replace(gear.blank, hand=hands[gear.blank.hand])) for gear in gears.gears))
    resolution = Resolution(9, 5, 3, 7)
    left, right = (
        build_tooth(flanks(one, "pinion"), tooth_forms(one)[0], resolution).outline for one in (gears, mirrored)
    )
    assert_allclose(right, left[::-1] * [1.0, -1.0, 1.0], atol=1e-9)


def test_teeth_in_mesh_touch_with_the_flanks_in_contact():
    gears = mesh()
    pair, backs = (face_milled_pair(*gears.gears, pinion_flank=flank) for flank in ("concave", "convex"))
    teeth = mating_teeth(tooth_forms(gears), pair, backs, Resolution(5, 3, 2, 5))
    assert teeth.pinion.teeth == 19
    assert_allclose(2.0 * teeth.pinion.half_thickness_angle, 0.1888, rtol=0.01)


def test_one_blade_makes_no_tooth():
    pinion = published_pinion()
    with pytest.raises(InputError, match=r"cutter\.convex: missing"):
        tooth_forms(mesh(replace(pinion, cutter=Cutter(pinion.cutter.concave))))
