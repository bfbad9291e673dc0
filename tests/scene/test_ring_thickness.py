"""Tooth thickness of rings in scenes: the keys of external gears, measured from inside."""

import math

import pytest
from numpy.testing import assert_allclose

from loaded_tca import parse_scene
from tests.refusals import refused_calls
from tests.samples.internal_pairs import SCENE

THIN = -0.06
"""Allowance [mm]."""
BALLS = 5.1


def scene(**changes):
    straight = {"pair.helix_angle_deg": 0.0, "wheel.tip_diameter_mm": 175.2}
    return parse_scene(SCENE).with_changes(straight | {key.replace("__", "."): each for key, each in changes.items()})


@pytest.fixture(scope="module")
def thinned():
    return scene(wheel__thickness_allowance_um=1e3 * THIN)


def test_allowance_span_and_balls_make_the_same_ring(thinned):
    ring = thinned.mesh().ring
    assert_allclose(ring.thickness_allowance, THIN)
    by_span = scene(wheel__span_measurement_mm=ring.span_measurement())
    by_balls = scene(wheel__ball_measurement_mm=ring.ball_measurement(BALLS), wheel__ball_diameter_mm=BALLS)
    for other in (by_span, by_balls):
        assert_allclose(other.mesh().ring.thickness_allowance, THIN, atol=1e-9)
        assert parse_scene(other.to_toml()) == other


def test_balls_are_measured_in_a_ring_with_the_shift_that_the_centre_distance_leaves():
    """x2 after ISO 21771, 5.4.4, written out in one scene; the other finds it, and the allowance on its teeth."""
    module, normal, helix, distance = 2.0, math.radians(20.0), math.radians(10.0), 59.2
    angle = math.atan(math.tan(normal) / math.cos(helix))
    working = math.acos(0.5 * (83 - 25) * module * math.cos(angle) / math.cos(helix) / distance)
    rest = math.tan(angle) - angle - math.tan(working) + working
    shift = 0.5 * (83 - 25) * rest / math.tan(normal) - 0.3
    ring = parse_scene(SCENE).with_changes(
        {
            "pair.normal_module_mm": module,
            "pair.helix_angle_deg": 10.0,
            "pair.centre_distance_mm": distance,
            "wheel.teeth": -83,
            "wheel.tip_diameter_mm": None,
            "wheel.cutter.teeth": 28,
        }
    )
    written = ring.with_changes({"wheel.profile_shift": shift, "wheel.thickness_allowance_um": -70.0}).mesh().ring
    balls = {"wheel.ball_measurement_mm": written.ball_measurement(3.5), "wheel.ball_diameter_mm": 3.5}
    measured = ring.with_changes(balls).mesh().ring
    assert_allclose([measured.profile_shift, measured.thickness_allowance], [shift, -0.07], atol=1e-9)


def test_check_has_thickness_and_backlash_of_a_ring(thinned):
    rows = {name: cells for name, *cells in thinned.geometry_rows()}
    mesh = thinned.mesh()
    assert rows["thickness allowance A_sn [um]"] == ["0.0", "-60.0"]
    span = f"{mesh.ring.span_measurement():.4f} ({mesh.ring.span_teeth})"
    assert rows["span W_k over k teeth (spaces) [mm]"][1] == span
    at_working_circle = -THIN * mesh.wheel_working_radius / mesh.ring.reference_radius
    assert_allclose(mesh.backlash - scene().mesh().backlash, at_working_circle, rtol=1e-8)
    helical = scene(pair__helix_angle_deg=15.0, wheel__tip_diameter_mm=181.5)
    rows = {name: cells for name, *cells in helical.geometry_rows()}
    assert rows["span W_k over k teeth (spaces) [mm]"][1] == "-"
    assert rows["  no span W_k of the wheel"] == [
        "no span touches the helical teeth of a ring, which are hollow; measure between balls"
    ]


def test_complete_teeth_and_form_factors_of_a_ring_follow_its_allowance(thinned):
    nominal, gear = scene().pair().wheel.form, thinned.mesh().ring
    angle = -0.5 * THIN / gear.reference_radius
    assert_allclose(nominal.half_thickness_angle - thinned.pair().wheel.form.half_thickness_angle, angle, rtol=1e-8)
    mesh = thinned.mesh()
    other = scene(
        wheel__profile_shift=mesh.ring.generating_profile_shift,
        pair__centre_distance_mm=mesh.working_centre_distance,
        pinion__profile_shift=mesh.pinion.profile_shift,
    )
    assert_allclose(thinned.root_factors[1], other.root_factors[1], rtol=1e-9)


test_thickness_of_rings_refuses = refused_calls(
    (
        lambda: scene(wheel__thickness_allowance_um=-40.0, wheel__span_measurement_mm=70.0),
        "^wheel.thickness_allowance_um: found -40 beside span_measurement_mm = 70; give one",
    ),
    (lambda: scene(wheel__ball_diameter_mm=5.0), "^wheel.ball_diameter_mm: found 5; it needs ball_measurement_mm"),
    (
        lambda: scene(pair__helix_angle_deg=15.0, wheel__tip_diameter_mm=181.5, wheel__span_measurement_mm=70.0).mesh(),
        "^wheel: span_measurement_mm: no span touches the helical teeth of a ring",
    ),
    (
        lambda: scene(wheel__ball_measurement_mm=190.0, wheel__ball_diameter_mm=BALLS).mesh(),
        "^wheel: ball_measurement_mm: 190 mm between balls of 5.1 mm makes the teeth",
    ),
)
