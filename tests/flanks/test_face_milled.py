"""Generated flanks of published settings: their zero, hand, angles, B-splines; undercut and what cannot be cut."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks import GeneratedFlank
from loaded_tca.flanks.base import outward_normal
from loaded_tca.flanks.face_milled import tooth_angle
from loaded_tca.gears import Blade, Cutter
from tests.refusals import refused_calls
from tests.samples.face_milled import matched_pinion, on_machine, published_pinion, published_wheel

FLANKS = ("concave", "convex")
GEARS = {"pinion": published_pinion, "wheel": published_wheel}
CASES = [(name, flank) for name in GEARS for flank in FLANKS]
ON_SPLINE = 1e-7  # mm, between the B-spline and the exact flank
ROUNDING = 1e-12  # rad or mm; angles of order one: none seen, and 3e-14 mm of a fit to lines of 100 mm
STEP = 1e-4  # mm


def flank_of(name, flank):
    return GeneratedFlank(GEARS[name](), flank)


@pytest.mark.parametrize(("name", "flank"), CASES)
def test_flank_holds_the_pitch_point_at_angle_zero(name, flank):
    gear = GEARS[name]()
    distance, delta = gear.blank.mean_cone_distance, gear.blank.pitch_angle
    theta = GeneratedFlank(gear, flank).theta(
        np.array(distance * math.sin(delta)), np.array(distance * math.cos(delta))
    )
    assert_allclose(theta.value, 0.0, atol=ROUNDING)


@pytest.mark.parametrize(("name", "flank"), CASES)
def test_normal_points_out_of_the_tooth_and_follows_the_mean_spiral_angle(name, flank):
    generated = flank_of(name, flank)
    normal = outward_normal(generated, *generated.grid(5, 5))
    assert (generated.side * normal[..., 1] > 0.5).all()
    hand = {"pinion": -1.0, "wheel": 1.0}[name]
    assert_allclose(generated.angles.spiral, hand * math.radians(35.0), atol=math.radians(0.25))


def test_pressure_angles_of_the_published_pair_miss_each_other():
    """20/20 deg blades do not make up for the tilt of the roots: 1.66 deg on the drive, 2.58 deg on the coast side."""
    missed = [
        math.degrees(flank_of("pinion", flank).angles.pressure - flank_of("wheel", mating).angles.pressure)
        for flank, mating in (("concave", "convex"), ("convex", "concave"))
    ]
    assert_allclose(missed, [1.66, -2.58], atol=0.01)


def test_pressure_angles_of_the_matched_pair_agree():
    angles = GeneratedFlank(matched_pinion(), "concave").angles, flank_of("wheel", "convex").angles
    assert_allclose(angles[0].pressure, angles[1].pressure, atol=2e-6)
    assert_allclose(-angles[0].spiral, angles[1].spiral, atol=2e-6)


@pytest.mark.parametrize(("name", "flank"), CASES)
def test_derivatives_are_those_of_theta(name, flank):
    generated = flank_of(name, flank)
    rho, z = (part[1:-1, 1:-1] for part in generated.grid(5, 5))
    jet = generated.theta(rho, z)
    ahead, behind = generated.theta(rho + STEP, z), generated.theta(rho - STEP, z)
    above, below = generated.theta(rho, z + STEP), generated.theta(rho, z - STEP)
    tolerance = {"rtol": 1e-6, "atol": 1e-10}  # STEP^2 times a third derivative, and rounding over STEP
    assert_allclose((ahead.value - behind.value) / (2.0 * STEP), jet.rho, **tolerance)
    assert_allclose((above.value - below.value) / (2.0 * STEP), jet.z, **tolerance)
    assert_allclose((ahead.rho - behind.rho) / (2.0 * STEP), jet.rho_rho, **tolerance)
    assert_allclose((ahead.z - behind.z) / (2.0 * STEP), jet.rho_z, **tolerance)
    assert_allclose((above.z - below.z) / (2.0 * STEP), jet.z_z, **tolerance)


@pytest.mark.parametrize(("name", "flank"), CASES)
def test_spline_is_the_flank_to_a_tenth_of_a_nanometre(name, flank):
    generated = flank_of(name, flank)
    spline = generated.as_spline()
    assert spline.fit_error.largest < ROUNDING
    assert spline.check_error.largest < ON_SPLINE
    rho, z = (part.ravel() for part in generated.grid(23, 29))
    turn = spline.theta(rho, z).value - generated.theta(rho, z).value
    assert np.abs(rho * turn).max() < ON_SPLINE
    assert generated.side == spline.side


def test_spline_error_falls_with_the_sixth_power_of_the_spacing():
    """Before the near fold below the form line shows: on the wheel, which has none."""
    wheel = flank_of("wheel", "concave")
    errors = [wheel.as_spline((n, n)).check_error.largest for n in (9, 17)]
    assert errors[0] / errors[1] > 0.5 * 2.0**6


@pytest.mark.parametrize("flank", FLANKS)
def test_left_hand_gear_is_the_mirror_image_of_the_right_hand_one(flank):
    left = published_pinion()
    right = replace(left, blank=replace(left.blank, hand="right"))
    first, second = GeneratedFlank(left, flank), GeneratedFlank(right, flank)
    place = first.grid(4, 4)
    assert first.side == -second.side
    assert_allclose(first.theta(*place).value, -second.theta(*place).value, atol=ROUNDING)


def test_theta_goes_on_smoothly_beyond_the_edges():
    generated = flank_of("pinion", "concave")
    rho, z = generated.grid(5, 5)
    for (i, j), outwards in (
        ((-1, 2), (0.3, -0.9)),
        ((0, 2), (-0.9, 0.3)),
        ((2, 0), (-0.3, -0.9)),
        ((2, -1), (0.3, 0.9)),
    ):
        place = np.array([rho[i, j], z[i, j]])
        inside, beyond = (generated.theta(*(place + shift * np.array(outwards))) for shift in (-1e-5, 1e-5))
        slope = inside.rho * outwards[0] + inside.z * outwards[1]
        assert_allclose(beyond.value - inside.value, 2e-5 * slope, atol=1e-8)
        assert_allclose(beyond.rho_rho, inside.rho_rho, rtol=0.05)  # beside the fold the B-spline is that far off


def test_gradient_norm_is_that_of_theta():
    generated = flank_of("pinion", "convex")
    rho, z = generated.grid(6, 6)
    jet = generated.theta(rho, z)
    assert_allclose(generated.gradient_norm(rho, z).value, np.sqrt(rho**-2.0 + jet.rho**2 + jet.z**2), rtol=1e-8)


def test_hollow_blade_takes_material_off_at_both_ends_of_the_profile():
    """Against the straight blade that has its angle halfway up the profile."""
    wheel, middle = published_wheel(), 4.0
    hollow = wheel.cutter.convex
    value, slope, _ = hollow.widening(middle)
    straight = Blade(hollow.point_radius - (value - slope * middle), math.atan(slope), edge_radius=hollow.edge_radius)
    flanks = [GeneratedFlank(replace(wheel, cutter=Cutter(convex=blade)), "convex") for blade in (hollow, straight)]
    profile = [part[:, 2] for part in flanks[0].grid(9, 5)]
    removed = flanks[0].side * (flanks[1].theta(*profile).value - flanks[0].theta(*profile).value)
    assert removed[0] > removed[4] < removed[-1]


def test_tooth_of_the_published_pinion_narrows_to_its_tip():
    pinion = published_pinion()
    flank = GeneratedFlank(pinion, "concave")
    rho, z = (part[:, 2] for part in flank.grid(5, 5))
    thickness = rho * tooth_angle(pinion, rho, z)
    assert (np.diff(thickness) < 0.0).all()
    module = 2.9402
    assert 0.3 * module < thickness[-1] < thickness[0] < math.pi * module


def test_undercut_begins_where_the_generated_surface_turns_back_at_the_form_line():
    """Cut a little less deep than the limit, the sharpness at the form line is small and positive."""
    flank = GeneratedFlank(on_machine(published_pinion(), sliding_base=-1.2), "concave")
    _, points = flank.generation.at_height(flank.generation.blade.form_height, np.array([flank.cone_distances[0]]))
    assert 0.0 < points.sharpness[0] < 0.1
    with pytest.raises(GeometryError, match="undercut"):
        GeneratedFlank(on_machine(published_pinion(), sliding_base=-1.3), "concave")


test_face_milled_refuses = refused_calls(
    (
        lambda: GeneratedFlank(on_machine(published_pinion(), sliding_base=-2.0), "concave"),
        r"pinion, concave flank: undercut: .* 18\.4 mm from R_m to the toe, 2\.\d+",
    ),
    (
        lambda: GeneratedFlank(on_machine(published_pinion(), radial=5.0), "concave"),
        r"pinion, concave flank: the cutter does not cut \d+ of 11 points",
    ),
    (
        lambda: GeneratedFlank(on_machine(published_pinion(), sliding_base=9.0), "convex"),
        r"no flank is left: the form line lies above the face cone",
    ),
    (lambda: GeneratedFlank(matched_pinion(), "convex"), r"cutter\.convex: missing", InputError),
    error=GeometryError,
)


def test_formate_wheel_has_flanks_too():
    wheel = on_machine(published_wheel(), generation="formate")
    generated, formate = (GeneratedFlank(gear, "concave") for gear in (published_wheel(), wheel))
    assert formate.as_spline().check_error.largest < ON_SPLINE
    rho, z = generated.grid(5, 5)
    # a wheel rolls so little that both are alike, and the generated flank is the rounder one
    apart = rho * np.abs(generated.theta(rho, z).value - formate.theta(rho, z).value)
    assert 0.01 < apart.max() < 1.0
