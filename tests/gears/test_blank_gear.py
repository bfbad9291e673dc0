"""One bevel blank against the cylindrical gear that its normal section shows, and against the crown gear."""

import math
from dataclasses import replace

import pytest
from numpy.testing import assert_allclose

from loaded_tca.gears import BevelBlank, BlankGear, CylindricalGear
from loaded_tca.gears.blank_gear import virtual_curvature

ROUNDING = 1e-11  # of some dozen functions and products, of which parts cancel
CROWN = 1e-6  # a crown gear against one of 90 deg +- 1e-7 rad


def straight(pitch_angle=math.pi / 3.0, teeth=20, module=4.0, **changes):
    """Straight bevel gear without taper, of one module at mid-face."""
    mean = 0.5 * teeth * module / math.sin(pitch_angle)
    usual = {
        "name": "gear",
        "teeth": teeth,
        "pitch_angle": pitch_angle,
        "pressure_angle": math.radians(20.0),
        "cone_distances": (mean - 1.0, mean, mean + 1.0),
        "spiral_angles": (0.0, 0.0, 0.0),
        "mean_addendum": module,
        "mean_dedendum": 1.25 * module,
        "addendum_angle": 0.0,
        "dedendum_angle": 0.0,
        "mean_normal_thickness": 0.5 * math.pi * module,
        "profile_shift": 0.0,
        "smallest_profile_shift": -1.0,
        "face_apex": 0.0,
        "root_apex": 0.0,
    }
    return BlankGear(**(usual | changes))


def test_tip_thickness_is_that_of_the_virtual_spur_gear():
    """At a pitch angle of 60 deg the virtual gear has twice the teeth."""
    spur = CylindricalGear(teeth=40, normal_module=4.0, face_width=10.0)
    assert_allclose(straight().tip_thicknesses[1], spur.tooth_thickness_at(spur.tip_radius), rtol=ROUNDING)


def test_tip_thickness_of_a_crown_gear_is_that_of_a_rack():
    crown = straight(pitch_angle=0.5 * math.pi)
    assert_allclose(crown.tip_thicknesses[1], 2.0 * math.pi - 8.0 * math.tan(math.radians(20.0)), rtol=ROUNDING)


@pytest.mark.parametrize("step", [-1e-7, 1e-7])
def test_tip_thickness_passes_smoothly_through_the_crown_gear(step):
    crown, near = straight(pitch_angle=0.5 * math.pi), straight(pitch_angle=0.5 * math.pi + step)
    assert_allclose(near.tip_thicknesses, crown.tip_thicknesses, rtol=CROWN)
    assert_allclose(near.chordal_thickness, crown.chordal_thickness, rtol=CROWN)
    assert_allclose(near.chordal_addendum, crown.chordal_addendum, rtol=CROWN)


def test_tip_of_an_internal_gear_is_thicker_than_that_of_a_rack():
    """Hollow flanks: the tooth of an internal gear is thicker at its tip than that of an external one."""
    external, crown, internal = (straight(pitch_angle=angle, teeth=60) for angle in (1.3, 0.5 * math.pi, 1.84))
    assert external.tip_thicknesses[1] < crown.tip_thicknesses[1] < internal.tip_thicknesses[1]


def test_flank_of_an_internal_gear_ends_at_its_base_circle():
    deep, deeper = (straight(pitch_angle=2.9, mean_addendum=height) for height in (3.0, 4.0))
    growth = [1.0 + gear.virtual_curvatures[1] * gear.mean_addendum for gear in (deep, deeper)]
    assert max(growth) < math.cos(deep.pressure_angle)
    thickness = [gear.tip_thicknesses[1] / ratio for gear, ratio in zip((deep, deeper), growth, strict=True)]
    assert_allclose(*thickness, rtol=ROUNDING)


def test_virtual_curvature_of_spiral_teeth_is_that_of_the_normal_section_of_a_helical_gear():
    """Small pitch angle: the base cylinder's normal section has rho = r_b tan(alpha_t)/cos(beta_b)."""
    pressure, spiral, delta, distance = math.radians(20.0), 0.6, 1e-5, 1.0e6
    helical = CylindricalGear(teeth=20, normal_module=1.0, face_width=1.0, helix_angle=spiral)
    flank = helical.roll_length(helical.reference_radius) / math.cos(helical.base_helix_angle)
    scale = distance * math.tan(delta) / helical.reference_radius
    virtual = math.sin(pressure) / virtual_curvature(distance, delta, spiral, pressure)
    assert_allclose(virtual, scale * flank, rtol=1e-9)


def test_smallest_profile_shift_is_that_of_the_virtual_spur_gear():
    """Straight teeth without taper at the toe of a narrow face, cut 1.1 modules deep."""
    pair = BevelBlank((12, 40), 4.0, 1e-6, taper="uniform", profile_shift=0.5)
    virtual = 12.0 / math.cos(pair.pinion.pitch_angle)
    usual = 1.1 - 0.5 * virtual * math.sin(math.radians(20.0)) ** 2
    assert_allclose(pair.pinion.smallest_profile_shift, usual, rtol=1e-6)


def test_wheel_beyond_the_crown_gear_is_never_undercut():
    pair = BevelBlank((20, 40), 4.0, 5.0, shaft_angle=math.radians(130.0))
    assert pair.wheel.pitch_angle > 0.5 * math.pi
    assert pair.wheel.smallest_profile_shift == -math.inf


def test_chord_lies_inside_the_arc_by_its_sagitta():
    gear = straight(teeth=12)
    radius = 1.0 / gear.virtual_curvatures[1]
    half = 0.5 * gear.mean_normal_thickness / radius
    assert_allclose(gear.chordal_thickness, 2.0 * radius * math.sin(half), rtol=ROUNDING)
    assert_allclose(gear.chordal_addendum - gear.mean_addendum, 0.5 * radius * (1.0 - math.cos(half)), rtol=1e-9)


def test_slot_and_thickness_and_tool_flanks_fill_the_pitch():
    gear = straight()
    sides = 2.0 * gear.mean_dedendum * math.tan(gear.pressure_angle)
    assert_allclose(gear.slot_widths[1] + sides + gear.normal_thicknesses[1], 4.0 * math.pi, rtol=ROUNDING)


def test_diameters_follow_from_depths_and_pitch_angle():
    gear = straight(addendum_angle=0.02, dedendum_angle=0.03)
    assert_allclose(gear.pitch_diameters[1], 80.0, rtol=ROUNDING)
    assert_allclose(gear.tip_diameters[1], 80.0 + 4.0, rtol=ROUNDING)  # 2 h_a cos 60 deg
    assert_allclose(gear.root_diameters[1], 80.0 - 5.0, rtol=ROUNDING)
    assert_allclose(gear.addenda[2] - gear.addenda[0], 2.0 * math.tan(0.02), rtol=1e-9)
    assert_allclose(gear.dedenda[2] - gear.dedenda[0], 2.0 * math.tan(0.03), rtol=1e-9)


def test_crown_lies_ahead_of_the_pitch_cone_by_the_addendum():
    gear = straight(mean_addendum=0.0)
    raised = replace(gear, mean_addendum=4.0)
    assert_allclose(gear.crown_to_crossing[1], gear.cone_distances[1] * 0.5, rtol=1e-9)
    assert_allclose(gear.crown_to_crossing[1] - raised.crown_to_crossing[1], 4.0 * math.sin(math.pi / 3.0), rtol=1e-9)


def test_transverse_thickness_is_wider_by_the_spiral():
    gear = straight(spiral_angles=(0.5, 0.5, 0.5))
    assert_allclose(gear.mean_transverse_thickness * math.cos(0.5), gear.mean_normal_thickness, rtol=ROUNDING)
