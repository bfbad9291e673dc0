"""Local synthesis: conjugate flanks, what the settings meet at the calculation point, what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.flanks import GeneratedFlank, Mismatch, synthesised_gears
from loaded_tca.flanks.face_milled import conjugate_flank, tooth_angle
from loaded_tca.gears import BevelBlank, HypoidBlank, HypoidCones, PitchConeParameters
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.pairs.bevel import face_milled_pair
from loaded_tca.unloaded import relative_curvature, trace_contact
from tests.refusals import refused_calls
from tests.samples.hypoid import hypoid_blank, hypoid_gears, hypoid_pair

MET = 1e-8  # mm and rad: conditions are met to 1e-10 mm over half a tooth


def mean_point(gear):
    blank = gear.blank
    distance = blank.mean_cone_distance
    return np.array([distance * math.sin(blank.pitch_angle)]), np.array([distance * math.cos(blank.pitch_angle)])


def test_wheel_has_the_angles_of_its_blank():
    blank, (_, wheel) = hypoid_blank(), hypoid_gears()
    drive, coast = (GeneratedFlank(wheel, flank).angles for flank in ("convex", "concave"))
    assert_allclose([drive.pressure, coast.pressure], blank.generated_pressure_angles, atol=MET)
    assert_allclose(drive.spiral, blank.pitch_cones.spiral_angles[1], atol=MET)
    assert_allclose(coast.spiral, drive.spiral, atol=math.radians(0.2))  # of a slot with a duplex taper


@pytest.mark.parametrize("member", [0, 1])
def test_teeth_are_as_thick_as_the_blank_says(member):
    blank, gear = hypoid_blank(), hypoid_gears()[member]
    rho, z = mean_point(gear)
    own = (blank.pinion, blank.wheel)[member]
    thickness = float(rho[0]) * math.cos(own.spiral_angles[1]) * float(tooth_angle(gear, rho, z)[0])
    assert_allclose(thickness, own.mean_normal_thickness, atol=MET)


@pytest.mark.parametrize("member", [0, 1])
def test_cut_is_as_deep_as_the_blank(member):
    """The mean of both blades at P stands over the root plane as P does."""
    gear = hypoid_gears()[member]
    rho, z = mean_point(gear)
    blank = gear.blank
    depth = rho * math.cos(blank.root_angle) - (z + blank.root_apex) * math.sin(blank.root_angle)
    heights = [GeneratedFlank(gear, flank).generation.solve(rho, z).height for flank in ("concave", "convex")]
    assert_allclose(np.mean(heights), depth[0], atol=MET)


@pytest.mark.thorough
@pytest.mark.parametrize(("flank", "mating"), [("concave", "convex"), ("convex", "concave")])
def test_slopes_of_the_pinion_are_those_of_the_conjugate(flank, mating):
    pinion, wheel = hypoid_gears("right")
    rho, z = mean_point(pinion)
    slopes, _ = conjugate_flank(
        GeneratedFlank(wheel, mating), hypoid_blank().cones.frame(1), 13 / 42, float(rho[0]), float(z[0])
    )
    theta = GeneratedFlank(pinion, flank).theta(rho, z)
    assert_allclose([theta.rho[0], theta.z[0]], slopes, atol=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize(
    "mismatch",
    [
        pytest.param(Mismatch(0.010, 0.030), marks=pytest.mark.thorough),
        pytest.param(Mismatch(0.005, 0.060, 0.010), marks=pytest.mark.thorough),
        Mismatch(0.020, 0.050, -0.015),
    ],
)
def test_ease_off_about_p_is_the_mismatch(mismatch):
    """Over a hundredth of the tooth: third orders are a hundredth of a percent there."""
    pinion, wheel = hypoid_gears("right", mismatch)
    blank = hypoid_blank()
    flank, frame = GeneratedFlank(pinion, "concave"), blank.cones.frame(1)
    convex = GeneratedFlank(wheel, "convex")
    own = pinion.blank
    delta, mean = own.pitch_angle, own.mean_cone_distance
    up, along = np.array([math.cos(delta), -math.sin(delta)]), np.array([math.sin(delta), math.cos(delta)])
    at = mean * along
    slopes, bends = conjugate_flank(convex, frame, 13 / 42, *at)
    theta = flank.theta(at[:1], at[1:])
    length = math.hypot(1.0 / at[0], *slopes)
    left = (np.array(bends) - [part[0] for part in theta.bends]) / length  # concave: less Theta is less material
    tensor = np.array([[left[0], left[1]], [left[1], left[2]]])
    half_depth, half_width = 0.5 * blank.working_depth, 0.5 * own.face_width
    removed = [
        0.5 * half_depth**2 * up @ tensor @ up,
        0.5 * half_width**2 * along @ tensor @ along,
        half_depth * half_width * up @ tensor @ along,
    ]
    assert_allclose(removed, [mismatch.profile, mismatch.lengthwise, mismatch.twist], atol=MET)


def test_conjugate_flank_is_what_the_wheel_sweeps():
    """Second derivatives of the envelope are differences of its slopes."""
    _, wheel = hypoid_gears("right")
    flank, frame, step = GeneratedFlank(wheel, "convex"), hypoid_blank().cones.frame(1), 1e-3
    rho, z = 26.7, 68.4
    _, bends = conjugate_flank(flank, frame, 13 / 42, rho, z)
    by_rho = [conjugate_flank(flank, frame, 13 / 42, rho + way * step, z)[0] for way in (1, -1)]
    by_z = [conjugate_flank(flank, frame, 13 / 42, rho, z + way * step)[0] for way in (1, -1)]
    differences = [(one - other) / (2.0 * step) for one, other in (by_rho, by_z)]
    assert_allclose([differences[0][0], differences[0][1], differences[1][1]], bends, rtol=1e-6)
    assert_allclose(differences[1][0], bends[1], rtol=1e-6)


def test_pair_touches_in_p_with_the_ratio_of_the_teeth():
    contact = trace_contact(hypoid_pair(exact=True), [0.0])[0]
    point = hypoid_gears()[0].blank.mean_cone_distance
    assert_allclose(math.hypot(contact.pinion_radius, contact.pinion_axial), point, atol=1e-6)
    assert_allclose(contact.pinion_lever / contact.wheel_lever, 13 / 42, rtol=1e-9)
    assert_allclose(contact.transmission_error, 0.0, atol=1e-12)  # rad; generated to 1e-12 rad


@pytest.mark.parametrize("flank", ["concave", "convex"])
def test_transmission_error_is_a_parabola_of_a_few_arcsec(flank):
    pair = hypoid_pair(pinion_flank=flank)
    path = trace_contact(pair, np.array([-0.5, -0.25, 0.0, 0.25, 0.5]) * pair.pitch)
    error = np.degrees(path.transmission_error) * 3600.0
    assert not path.on_edge.any()
    assert error.argmax() == 2
    assert (error[[0, -1]] > -20.0).all()
    assert (error[[0, -1]] < -5.0).all()


@pytest.mark.thorough
def test_more_lengthwise_crowning_shortens_the_contact():
    pairs = [
        face_milled_pair(*hypoid_gears("left", Mismatch(0.010, crowning)), offset=15.0) for crowning in (0.030, 0.090)
    ]
    weak, strong = (relative_curvature(pair, trace_contact(pair, [0.0])[0]).along for pair in pairs)
    assert strong > 1.3 * weak  # the line of contact is inclined to the tooth: less than three times


@pytest.mark.thorough
@pytest.mark.parametrize("flank", ["concave", "convex"])
def test_formate_wheel_is_cut_at_rest_and_mates_on_both_sides(flank):
    pinion, wheel = hypoid_gears(wheel="formate")
    assert (wheel.machine.generation, pinion.machine.generation) == ("formate", "generated")
    pair = face_milled_pair(pinion, wheel, offset=15.0, pinion_flank=flank)
    path = trace_contact(pair, np.array([-0.5, 0.0, 0.5]) * pair.pitch)
    error = np.degrees(path.transmission_error) * 3600.0
    assert not path.on_edge.any()
    assert ((error[[0, 2]] < -3.0) & (error[[0, 2]] > -15.0)).all()


@pytest.mark.thorough
def test_pinion_of_a_formate_wheel_is_cut_by_a_tilted_cutter():
    """It stands for the wheel, whose cutter stands 24 deg off its axis; the cradle nearly for the wheel's axis."""
    machine = hypoid_gears(wheel="formate")[0].machine
    assert math.degrees(machine.tilt) > 10.0
    assert math.degrees(machine.root_angle) < 5.0


@pytest.mark.thorough
def test_bevel_pairs_without_an_offset_are_synthesised_too():
    sheet = BevelBlank.from_wheel_diameter(
        (14, 39), 176.893, 25.4, spiral_angle=math.radians(35.0), cutter_radius=114.3, profile_shift=0.4
    )
    cones = HypoidCones(pitch_angles((14, 39), 0.5 * math.pi), (sheet.mean_cone_distance,) * 2, 0.0)
    parameters = PitchConeParameters(cones, (math.radians(35.0),) * 2, 0.5)
    pair = face_milled_pair(*synthesised_gears(HypoidBlank((14, 39), parameters, 25.4, 114.3, profile_shift=0.4)))
    path = trace_contact(pair, np.array([-0.25, 0.0, 0.25]) * pair.pitch)
    error = np.degrees(path.transmission_error) * 3600.0
    assert_allclose(error[1], 0.0, atol=1e-3)
    assert (error[[0, 2]] < 0.0).all()


test_synthesis_refuses = refused_calls(
    (
        lambda: synthesised_gears(hypoid_blank(), "straight", wheel="rolled"),
        ("^pinion_hand: 'straight' is not", "^wheel: 'rolled' is not"),
    ),
    (
        lambda: synthesised_gears(hypoid_blank(), edge_radii=(3.0, 3.0)),
        (
            r"^edge_radii: found 3 mm of the pinion; the rounded tips of both blades take 4\.\d+ mm of a slot of 1\.66",
            r"^edge_radii: found 3 mm of the wheel; the rounded tips of both blades take 4\.\d+ mm of a slot of 2\.07",
        ),
    ),
)


@pytest.mark.thorough
def test_mismatch_that_no_settings_of_the_pinion_meet_is_refused():
    with pytest.raises(GeometryError, match=r"^pinion"):
        synthesised_gears(hypoid_blank(), mismatch=Mismatch(profile=2.0))


def test_hands_are_mirror_images_with_the_same_settings():
    for left, right in zip(hypoid_gears("left"), hypoid_gears("right"), strict=True):
        assert left == replace(right, blank=replace(right.blank, hand=left.blank.hand))
        assert left.blank.hand != right.blank.hand
