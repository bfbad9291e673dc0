"""Ring gears: diameters of ISO 21771, fillets that meet flank and root, cutters, refusals."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears import CylindricalGear, PinionCutter, RingGear
from tests.refusals import refused_calls

ROUNDING = 1e-12  # of some dozen functions and products
CUTTER = PinionCutter(25, 0.1, 0.25)


def ring(teeth=-60, **more):
    return RingGear(teeth, 3.0, 25.0, **more)


def test_diameters_are_those_of_iso_21771():
    gear = ring(profile_shift=0.2)
    assert_allclose(2.0 * gear.tip_radius, 180.0 - 6.0 * 1.2)
    assert_allclose(2.0 * gear.root_radius, 180.0 + 6.0 * (1.25 - 0.2))


def test_positive_profile_shift_thickens_the_tooth():
    assert ring(profile_shift=0.2).tooth_thickness - ring().tooth_thickness == pytest.approx(
        1.2 * math.tan(math.radians(20)), rel=ROUNDING
    )


@given(st.floats(0.0, 4.0))
def test_tooth_fills_the_space_of_an_external_gear_of_opposite_shift(height):
    """The space of a ring is the tooth of the external gear of the same teeth."""
    inner, outer = ring(profile_shift=0.1), CylindricalGear(60, 3.0, 25.0, profile_shift=-0.1)
    radius = inner.tip_radius + height
    assert_allclose(2.0 * radius * inner.space_angle_at(radius), outer.tooth_thickness_at(radius), rtol=ROUNDING)


@pytest.mark.parametrize("cutter", [None, CUTTER])
@pytest.mark.parametrize("helix", [0.0, 0.3])
def test_fillet_leads_from_the_involute_to_the_root_circle(cutter, helix):
    gear = ring(helix_angle=helix, cutter=cutter)
    radius, angle = gear.root_fillet(101)
    assert_allclose([radius[0], radius[-1]], [gear.form_radius, gear.root_radius], rtol=ROUNDING)
    assert_allclose(angle[0], 0.5 * gear.tooth_thickness_at(radius[0]) / radius[0], rtol=ROUNDING)
    assert (np.diff(angle) > 0.0).all()
    assert angle[-1] < math.pi / 60


@pytest.mark.parametrize("cutter", [None, CUTTER])
def test_tangents_are_those_of_the_fillet_and_of_the_involute(cutter):
    gear = ring(cutter=cutter)
    radius, angle = gear.root_fillet(4001)
    step = np.stack([np.gradient(radius), radius * np.gradient(angle)])
    step /= np.linalg.norm(step, axis=0)
    tangents = np.stack(gear.root_fillet_tangent(4001))
    assert_allclose(tangents[:, 1:-1], step[:, 1:-1], atol=1e-6)  # central differences over 4000 steps
    roll = gear.roll_length(gear.form_radius)
    along = np.array([gear.base_radius, roll]) / gear.form_radius  # r dpsi/dr = roll/r_b
    assert_allclose(tangents[:, 0], along, rtol=1e-9)


def test_arc_keeps_its_radius():
    gear = ring()
    radius, angle = gear.root_fillet(50)
    place = radius * np.exp(1j * angle)
    a, b, c = place[0], place[20], place[-1]
    sides = abs(a - b), abs(b - c), abs(c - a)
    area = 0.5 * abs(((b - a) * np.conj(c - a)).imag)
    assert_allclose(np.prod(sides) / (4.0 * area), gear.fillet_radius, rtol=1e-9)


def test_fillet_that_does_not_fit_is_fully_rounded():
    gear = ring(root_radius_coefficient=1.5)
    assert gear.fillet_radius < 4.5
    assert_allclose(gear.root_fillet(3)[1][-1], math.pi / 60, rtol=1e-9)


def test_cutter_of_two_gears_shapes_the_fillet_by_rolling():
    """No point of the rolling cutter's rounding reaches beyond the fillet: brute force over its turn."""
    gear = ring(cutter=CUTTER)
    radius, angle = gear.root_fillet(4000)
    distance, start, _ = gear._cutter_rounding_centre(gear.fillet_radius)
    apart = gear._cutting_distance
    turn = np.linspace(-0.25, 0.25, 801)[:, None]
    around = np.linspace(0.0, 2.0 * math.pi, 721)
    x = distance * np.cos(start + turn) + gear.fillet_radius * np.cos(around) + apart
    y = distance * np.sin(start + turn) + gear.fillet_radius * np.sin(around)
    reach, azimuth = np.hypot(x, y), np.arctan2(y, x) - turn * 25.0 / 60.0
    rim = (reach > gear.form_radius) & (reach < gear.root_radius - 0.02)  # the root circle has all angles
    allowed = math.pi / 60 - np.interp(reach[rim], radius, angle)
    behind = reach[rim] * (azimuth[rim] - allowed)
    assert behind.max() < 1e-5  # mm, chords of the fillet
    assert behind.max() > -1e-3  # and it touches


def test_form_circle_by_a_cutter_is_that_of_a_published_report():
    """Ring of the NREL reference gearbox, spur, cut by 30 teeth; d_Ff = 1987.879 mm by KISSsoft."""
    gear = RingGear(
        -93,
        21.0,
        400.0,
        profile_shift=0.1171,
        tip_diameter=1906.081,
        root_diameter=2000.581,
        cutter=PinionCutter(30, 0.0, 0.3),
    )
    assert_allclose(2.0 * gear.form_radius, 1987.879, rtol=0, atol=1e-3)  # its printed digits


test_bad_numbers_are_refused = refused_calls(
    (lambda: ring(teeth=60), "teeth: 60 is not a whole number of -3 or below"),
    (lambda: ring(teeth=-2), "teeth: -2 is not"),
    (lambda: ring(teeth=math.nan), "teeth: nan is not"),
    (lambda: ring(outer_diameter=150.0), "outer_diameter: 150 mm is not above the root diameter"),
    (lambda: ring(root_diameter=170.0), "tip_diameter: 174 mm is not below the root diameter"),
    (lambda: ring(root_radius_coefficient=-0.1), "root_radius_coefficient: -0.1 is negative"),
    (lambda: ring(tip_diameter=-1.0), "tip_diameter: -1.0 is not positive"),
    (lambda: ring(profile_shift=math.inf), "profile_shift: inf is not finite"),
    (lambda: ring(helix_angle=1.2), "helix_angle"),
    (lambda: PinionCutter(2), "cutter: teeth: 2 is not|cutter.teeth: 2 is not"),
    (lambda: PinionCutter(20, math.nan), "profile_shift: nan is not finite"),
    (lambda: PinionCutter(20, 0.0, -1.0), "tip_radius_coefficient: -1.0 is negative"),
    (lambda: ring(cutter=PinionCutter(60)), "cutter.teeth: 60 is not below 60"),
    (lambda: ring(teeth=-60, cutter=PinionCutter(55, 1.0)), "together 1, leave no working pressure angle"),
)

test_rings_that_cannot_exist_are_refused = refused_calls(
    (lambda: ring(tip_diameter=165.0), "tip circle, diameter 165.0000 mm, lies inside the base circle"),
    (lambda: ring(root_diameter=210.0), "the spaces close below the root circle"),
    (lambda: ring(profile_shift=-2.5), "pointed tooth|spaces close"),
    (lambda: ring(tip_diameter=186.6), "no flank is left between the tip circle"),
    error=GeometryError,
)


def test_every_problem_is_told_at_once():
    with pytest.raises(InputError) as caught:
        ring(teeth=5, outer_diameter=-1.0, root_radius_coefficient=-1.0)
    assert len(caught.value.problems) == 3
