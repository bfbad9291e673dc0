"""Complete teeth of face-milled gears: slot widths, the root cone with its own apex, fillets of the blades."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import Cutter, FaceMilledMesh
from loaded_tca.pairs import mating_teeth
from loaded_tca.pairs.bevel import face_milled_pair
from loaded_tca.tooth import ArcFillet, FaceMilledTooth, Resolution, build_tooth
from tests.samples.face_milled import published_pinion, published_wheel

SIGMA = np.radians(95.0)


def mesh(pinion=None, wheel=None):
    return FaceMilledMesh(pinion or published_pinion(), wheel or published_wheel(), SIGMA)


def pair_of(gears):
    return face_milled_pair(*gears.gears)


def test_tooth_is_what_the_cutter_leaves_of_the_pitch():
    """A slot of the flat wheel is that of the blades: their distance at the tips, and wider by their angles above."""
    gears = mesh()
    wheel, gear = pair_of(gears).wheel, gears.wheel
    form, (plus, minus) = wheel.form, wheel.flanks
    rho, z = (part[0, 1] for part in plus.grid(9, 3))  # on the form line at mid-face
    tooth = 2.0 * form.half_thickness_angle + float(plus.theta(rho, z).value) - float(minus.theta(rho, z).value)
    height = np.hypot(rho, z) * np.sin(np.arctan2(rho, z) - gear.blank.root_angle)
    slot = (2.0 * np.pi / gear.teeth - tooth) * rho * np.cos(np.radians(35.0))
    point_width = 96.439269791 - 94.060730209
    flat = point_width + 2.0 * height * np.tan(np.radians(20.0))
    assert_allclose(slot, flat, rtol=0.02)  # the blades are hollow, and the wheel is not quite flat


def test_root_lies_on_the_cone_of_the_blank_about_its_own_apex():
    gears = mesh(replace(published_pinion(), blank=replace(published_pinion().blank, root_apex=0.4)))
    pinion = pair_of(gears).pinion
    tooth = build_tooth(pinion.flanks, pinion.form, Resolution(9, 5, 3, 7))
    root = tooth.outline[0]
    rho, z = np.hypot(root[:, 0], root[:, 1]), root[:, 2]
    # rad; of order one, beside rtol
    assert_allclose(np.arctan2(rho, z + 0.4), gears.pinion.blank.root_angle, atol=1e-12)


def test_fillet_is_the_larger_edge_radius_or_one_of_a_basic_rack():
    pinion = published_pinion()
    rounder = replace(pinion.cutter, convex=replace(pinion.cutter.convex, edge_radius=0.3))
    sharp = Cutter(*(replace(blade, edge_radius=0.0) for blade in (pinion.cutter.concave, pinion.cutter.convex)))
    cutters = pinion.cutter, rounder, sharp
    radii = [FaceMilledTooth(replace(pinion, cutter=cutter)).form().fillet.radius for cutter in cutters]
    assert radii[:2] == [0.20845, 0.3]
    assert_allclose(radii[2], 0.38 * 2.94, rtol=0.01)  # mean normal module
    assert FaceMilledTooth(published_wheel()).form().with_arc(0.5).fillet == ArcFillet(0.5)


def test_tooth_of_the_other_hand_is_the_mirror_image():
    gears = mesh()
    hands = {"left": "right", "right": "left"}
    mirrored = mesh(*(replace(gear, blank=replace(gear.blank, hand=hands[gear.blank.hand])) for gear in gears.gears))
    resolution = Resolution(9, 5, 3, 7)
    pinions = [pair_of(one).pinion for one in (gears, mirrored)]
    left, right = (build_tooth(pinion.flanks, pinion.form, resolution).outline for pinion in pinions)
    assert_allclose(right, left[::-1] * [1.0, -1.0, 1.0], atol=1e-9)


def test_teeth_in_mesh_touch_with_the_flanks_in_contact():
    teeth = mating_teeth(pair_of(mesh()), Resolution(5, 3, 2, 5))
    assert teeth.pinion.teeth == 19
    assert_allclose(2.0 * teeth.pinion.half_thickness_angle, 0.1888, rtol=0.01)


def test_one_blade_makes_no_tooth():
    pinion = published_pinion()
    pair = face_milled_pair(replace(pinion, cutter=Cutter(pinion.cutter.concave)), published_wheel())
    for make in (lambda: pair.pinion.form, lambda: pair.pinion.back):
        with pytest.raises(InputError, match=r"cutter\.convex: missing"):
            make()


def test_variants_of_the_micro_geometry_share_their_nominal_flanks():
    plain, crowned = (
        FaceMilledTooth(published_pinion(), FlankModifications(lead_crowning=amount)) for amount in (0.0, 0.01)
    )
    assert crowned.nominal(1) is plain.nominal(1)
    assert crowned.nominal(-1) is not plain.nominal(1)
    assert FaceMilledTooth(published_pinion(), exact=True).nominal(1) is not plain.nominal(1)
    assert FaceMilledTooth(published_wheel()).nominal(1) is not plain.nominal(1)
