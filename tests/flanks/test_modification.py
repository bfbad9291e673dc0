"""Modifications: their definitions at the ends and in the middle, their derivatives, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.flanks import FlankModifications, InvoluteFlank, ModifiedFlank
from loaded_tca.flanks.base import outward_normal
from loaded_tca.flanks.modification import NO_POLYNOMIAL
from loaded_tca.flanks.removal import CircularArc, Term, linear, logarithmic, one_sided_parabola, parabola
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear_pair import cylindrical_basis
from tests.refusals import refusals
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair, meshes, modifications

ROUNDING = 1e-12  # of an amount of 0.02 mm: none seen
OF_ROLL = 1e-10  # of amounts at roll lengths: differences of some 10 mm, 2e-13 seen
OF_REMOVAL = 1e-15  # mm; of amounts up to 0.06 mm that are added up: 1e-17 seen
AMOUNT = 0.02
MESH = cylindrical_mesh(helix_deg=15.0)
GEAR, ACTIVE = MESH.pinion, MESH.pinion_active_profile
HALF = 0.5 * GEAR.face_width
WORKING, TIP = MESH.pinion_working_radius, ACTIVE.end_radius


def modified(side_of="pinion", **amounts):
    """Pinion flank with modifications; the wheel drives to get the other side."""
    pair = cylindrical_pair(MESH, modifications=(FlankModifications(**amounts), FlankModifications()), driving=side_of)
    return pair.pinion.flank


def removed(flank, radius, z):
    return float(flank.removal(np.array(float(radius)), np.array(float(z))).value)


def radius_at(share):
    """Radius at a share of the active profile, 0 at its start, 1 at the tip, counted in roll length."""
    roll = ACTIVE.start_roll_length + share * (ACTIVE.end_roll_length - ACTIVE.start_roll_length)
    return GEAR.radius_at_roll_length(roll)


# Definitions


@pytest.mark.parametrize("form", ["parabolic", "circular", "logarithmic"])
@pytest.mark.parametrize("amount", [AMOUNT, -AMOUNT, 1.0])
def test_lead_crowning_is_nothing_in_the_middle_and_its_amount_at_the_ends(form, amount):
    flank = modified(lead_crowning=amount, lead_crowning_form=form)
    for radius in (WORKING, TIP):
        assert removed(flank, radius, 0.0) == 0.0
        assert_allclose([removed(flank, radius, end) for end in (-HALF, HALF)], amount, rtol=ROUNDING)


def test_lead_crowning_between_the_ends_follows_its_formula():
    z = 0.4 * HALF
    radius = GEAR.face_width**2 / (8.0 * AMOUNT) + 0.5 * AMOUNT
    expected = {
        "parabolic": AMOUNT * 0.16,
        "circular": radius - math.sqrt(radius**2 - z**2),
        "logarithmic": AMOUNT * math.log(1.0 - 0.99 * 0.16) / math.log(0.01),
    }
    for form, value in expected.items():
        flank = modified(lead_crowning=AMOUNT, lead_crowning_form=form)
        # the circular formula as written loses eps * radius = 2e-13 mm
        assert_allclose(removed(flank, WORKING, z), value, rtol=1e-9)


def test_profile_crowning_is_nothing_midway_in_roll_length_and_its_amount_at_both_ends_of_the_active_profile():
    flank = modified(profile_crowning=AMOUNT)
    found = [removed(flank, radius_at(share), 3.0) for share in (0.0, 0.25, 0.5, 1.0)]
    assert_allclose(found, [AMOUNT, 0.25 * AMOUNT, 0.0, AMOUNT], rtol=OF_ROLL, atol=1e-17)  # atol: what is zero


@pytest.mark.parametrize(("form", "power"), [("linear", 1), ("parabolic", 2)])
def test_tip_relief_grows_by_roll_length_from_its_start_to_its_amount_at_the_tip(form, power):
    flank = modified(tip_relief=AMOUNT, tip_relief_start=2.0 * radius_at(0.6), tip_relief_form=form)
    found = [removed(flank, radius_at(share), 0.0) for share in (0.0, 0.59, 0.7, 0.8, 1.0)]
    assert_allclose(found, [0.0, 0.0, AMOUNT * 0.25**power, AMOUNT * 0.5**power, AMOUNT], rtol=OF_ROLL)


@pytest.mark.parametrize(("form", "power"), [("linear", 1), ("parabolic", 2)])
def test_root_relief_grows_from_its_start_to_its_amount_at_the_start_of_the_active_profile(form, power):
    flank = modified(root_relief=AMOUNT, root_relief_start=2.0 * radius_at(0.4), root_relief_form=form)
    found = [removed(flank, radius_at(share), 0.0) for share in (1.0, 0.41, 0.3, 0.2, 0.0)]
    assert_allclose(found, [0.0, 0.0, AMOUNT * 0.25**power, AMOUNT * 0.5**power, AMOUNT], rtol=OF_ROLL)


def test_active_profile_starts_where_the_tip_of_the_mate_reaches():
    """g = a sin(alpha_wt) - sqrt(r_a2^2 - r_b2^2), above the form circle for this pair."""
    reach = MESH.working_centre_distance * math.sin(MESH.working_pressure_angle)
    start = reach - math.sqrt(MESH.wheel.tip_radius**2 - MESH.wheel.base_radius**2)
    assert_allclose(ACTIVE.start_roll_length, start, rtol=1e-11)  # the same difference of lengths: none seen
    assert ACTIVE.start_radius > GEAR.form_radius


@pytest.mark.parametrize("amount", [AMOUNT, -AMOUNT])
def test_slopes_grow_from_nothing_to_their_amount(amount):
    helix, profile = modified(helix_slope=amount), modified(profile_slope=amount)
    assert_allclose(
        [removed(helix, WORKING, z) for z in (-HALF, 0.0, HALF)], [0.0, 0.5 * amount, amount], atol=OF_REMOVAL
    )
    found = [removed(profile, radius_at(share), 0.0) for share in (0.0, 0.5, 1.0)]
    assert_allclose(found, [0.0, 0.5 * amount, amount], atol=OF_REMOVAL)


@pytest.mark.parametrize("length", [4.0, HALF])
def test_end_relief_is_a_parabola_over_its_length_at_both_ends(length):
    flank = modified(end_relief=AMOUNT, end_relief_length=length)
    for end in (1.0, -1.0):
        distances = np.array([length, 0.5 * length, 0.0])
        found = [removed(flank, WORKING, end * (HALF - distance)) for distance in distances]
        assert_allclose(found, [0.0, 0.25 * AMOUNT, AMOUNT], rtol=OF_ROLL)


def test_ends_may_have_reliefs_of_their_own_over_lengths_of_their_own():
    """What is not given of one end is as at both ends."""
    cases = (
        ({"end_relief": 0.02, "end_relief_length": 4.0, "end_relief_upper": 0.05}, (0.02, 4.0), (0.05, 4.0)),
        ({"end_relief": 0.02, "end_relief_length": 4.0, "end_relief_lower_length": 8.0}, (0.02, 8.0), (0.02, 4.0)),
        ({"end_relief": 0.02, "end_relief_length": 4.0, "end_relief_lower": 0.0}, (0.0, 4.0), (0.02, 4.0)),
        ({"end_relief_upper": 0.03, "end_relief_upper_length": 5.0}, (0.0, 4.0), (0.03, 5.0)),
    )
    for amounts, lower, upper in cases:
        flank = modified(**amounts)
        for sign, (amount, length) in ((-1.0, lower), (1.0, upper)):
            found = [removed(flank, WORKING, sign * (HALF - share * length)) for share in (1.0, 0.5, 0.0)]
            assert_allclose(found, [0.0, 0.25 * amount, amount], rtol=OF_ROLL, atol=OF_REMOVAL)


ROLL = math.radians(24.0)
TRANSVERSE = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(15.0)))
BASE = 0.5 * 34 * 3.0 / math.cos(math.radians(15.0)) * math.cos(TRANSVERSE)
"""Base radius of the pinion, by ISO 21771."""


@pytest.mark.parametrize("relief", ["tip_relief", "root_relief"])
@pytest.mark.parametrize("form", ["linear", "parabolic"])
def test_relief_starts_at_the_diameter_of_its_roll_angle_or_roll_length(relief, form):
    """ISO 21771: xi = tan(alpha_y), cos(alpha_y) = d_b/d_y, and the roll length is r_b xi."""
    diameter = 2.0 * BASE / math.cos(math.atan(ROLL))
    start = f"{relief}_start"
    same = {start: diameter}, {f"{start}_roll": ROLL}, {f"{start}_length": BASE * ROLL}
    flanks = [modified(**{relief: AMOUNT, f"{relief}_form": form}, **given) for given in same]
    rho, z = flanks[0].grid(41, 2)
    expected = parts(flanks[0], rho, z)
    assert expected[0].max() > 0.9 * AMOUNT
    for flank in flanks[1:]:
        for found, part in zip(parts(flank, rho, z), expected, strict=True):
            assert_allclose(found, part, rtol=OF_ROLL, atol=1e-13)  # atol: derivatives that are zero


def test_relief_of_a_bevel_gear_starts_at_the_cone_that_its_roll_angle_unwinds():
    """A great circle that rolls on the base cone unwinds w while the gear turns by w/sin(delta_b); R_m w at R_m."""
    pitch, middle = math.atan(0.5), 0.5 * 4.0 * math.hypot(20.0, 40.0) - 10.0
    base, start = math.asin(math.sin(pitch) * math.cos(math.radians(20.0))), pitch + 0.01
    arc = math.acos(math.cos(start) / math.cos(base))
    tip = bevel_mesh((20, 40), 4.0, 20.0, spiral_angle=math.radians(35.0)).pinion.tip_angle
    angle = np.array([start - 1e-6, start + 1e-6, tip])
    ways = {"_roll": arc / math.sin(base), "_length": middle * arc, "": 2.0 * middle * math.sin(start)}
    for way, value in ways.items():
        flank = bevel_modified(tip_relief=AMOUNT, tip_relief_form="linear", **{f"tip_relief_start{way}": value})
        below, above, end = flank.removal(middle * np.sin(angle), middle * np.cos(angle)).value
        assert below == 0.0
        assert above > 0.0
        assert_allclose(end, AMOUNT, rtol=OF_ROLL)


def bevel_modified(**amounts):
    """Pinion flank of a spiral bevel pair with modifications."""
    mesh = bevel_mesh((20, 40), 4.0, 20.0, spiral_angle=math.radians(35.0))
    return bevel_pair(mesh, modifications=(FlankModifications(**amounts), FlankModifications())).pinion.flank


@pytest.mark.parametrize("build", [modified, bevel_modified])
@pytest.mark.parametrize("amount", [AMOUNT, -AMOUNT])
def test_twist_is_the_helix_slope_at_the_tip_less_that_at_the_start_of_the_profile(build, amount):
    """And the profile slope at the upper end less that at the lower end; nothing on the lines through the middle."""
    slopes = {name: build(**{name: 1e-3}) for name in ("profile_slope", "helix_slope")}
    flank = build(twist=amount)
    rho, z = flank.grid(41, 5)
    up, along = (1e3 * slopes[name].removal(rho, z).value for name in ("profile_slope", "helix_slope"))
    assert_allclose(flank.removal(rho, z).value, amount * (up - 0.5) * (along - 0.5), rtol=0, atol=OF_REMOVAL)


@pytest.mark.parametrize("build", [modified, bevel_modified])
def test_squares_of_the_polynomial_are_the_parabolic_crownings(build):
    """a5 = C_beta/(b/2)^2, a6 = C_alpha/(L/2)^2."""
    crowned = build(lead_crowning=0.02, profile_crowning=0.01)
    profile = next(term for term in crowned.terms if term.direction == "profile")
    lengthwise = next(term for term in crowned.terms if term.direction == "lengthwise")
    squares = 0.02 / lengthwise.length**2, 0.01 / (profile.length * crowned.profile_unit) ** 2
    flank = build(polynomial=(0.0, 0.0, 0.0, 0.0, *squares))
    rho, z = flank.grid(7, 7)
    for ours, theirs in zip(parts(flank, rho, z), parts(crowned, rho, z), strict=True):
        assert_allclose(ours, theirs, rtol=1e-11, atol=1e-16)  # atol: what is zero on one side


def parts(flank, rho, z):
    jet = flank.removal(rho, z)
    return np.broadcast_arrays(jet.value, jet.rho, jet.z, jet.rho_rho, jet.rho_z, jet.z_z)


@pytest.mark.parametrize("share", [0.0, 0.25, 1.0])
@pytest.mark.parametrize("z", [-HALF, 3.0])
def test_polynomial_counts_from_the_middle_of_face_and_active_profile_in_millimetres(share, z):
    a = (3e-3, 1e-4, -2e-4, 3e-5, 4e-5, -5e-5)
    y = (share - 0.5) * (ACTIVE.end_roll_length - ACTIVE.start_roll_length)
    expected = a[0] + a[1] * z + a[2] * y + a[3] * z * y + a[4] * z**2 + a[5] * y**2
    assert_allclose(removed(modified(polynomial=a), radius_at(share), z), expected, rtol=OF_ROLL)


@given(st.lists(st.floats(-1e-3, 1e-3), min_size=6, max_size=6), st.floats(0.05, 0.95), st.floats(0.05, 0.95))
@settings(max_examples=40)
def test_derivatives_of_the_polynomial_agree_with_differences(coefficients, height, place):
    flank = bevel_modified(polynomial=tuple(coefficients), twist=0.01)
    corners = np.stack(flank.grid(2, 2))
    rho, z = (corners * np.outer([1.0 - height, height], [1.0 - place, place])).sum(axis=(1, 2))
    step = 1e-4
    around = [(step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)]
    ahead, behind, above, below = (parts(flank, rho + i, z + j) for i, j in around)
    here = parts(flank, np.array(rho), np.array(z))
    # truncation: third derivatives near the base cone times step^2
    assert_allclose(here[1], (ahead[0] - behind[0]) / (2 * step), rtol=1e-6, atol=1e-9)
    assert_allclose(here[2], (above[0] - below[0]) / (2 * step), rtol=1e-6, atol=1e-9)
    seconds = (ahead[1] - behind[1], above[1] - below[1], above[2] - below[2])
    assert_allclose(here[3:], np.array(seconds) / (2 * step), rtol=1e-6, atol=1e-8)


@pytest.mark.thorough
@given(st.data(), meshes())
@settings(max_examples=40)
def test_modifications_add_up(data, mesh):
    whole = data.draw(modifications(mesh.pinion, mesh.pinion_active_profile))
    names = ("lead_crowning", "end_relief", "profile_crowning", "tip_relief", "root_relief", "helix_slope")
    nothing = {**dict.fromkeys((*names, "profile_slope", "twist"), 0.0), "polynomial": NO_POLYNOMIAL}
    single = [replace(whole, **{**nothing, name: getattr(whole, name)}) for name in nothing]

    def field(choice):
        pair = cylindrical_pair(mesh, modifications=(choice, FlankModifications()))
        rho, z = pair.pinion.flank.grid(7, 7)
        return pair.pinion.flank.removal(rho, z).value if isinstance(pair.pinion.flank, ModifiedFlank) else 0.0 * rho

    assert_allclose(field(whole), sum(field(one) for one in single), rtol=0, atol=OF_REMOVAL)


def test_no_modification_leaves_the_nominal_flank():
    assert isinstance(modified(), InvoluteFlank)


# What they do to the flank


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("amount", [1e-3, 1e-5])
def test_amount_is_the_distance_along_the_normal_in_the_limit_of_small_amounts(driver, amount):
    """The distance is found by stepping along the nominal normal until the modified flank is met."""
    amounts = {"lead_crowning": amount, "profile_slope": 0.5 * amount}
    flank, nominal = modified(driver, **amounts), modified(driver)
    rho, z = np.array(52.0), np.array(7.0)
    theta = nominal.theta(rho, z).value
    basis = cylindrical_basis(theta)
    normal = outward_normal(nominal, rho, z) @ basis
    start = rho * basis[0] + z * basis[2]

    def excess(inward):
        x, y, height = start - inward * normal
        return float(flank.theta(np.array(math.hypot(x, y)), np.array(height)).value) - math.atan2(y, x)

    low, high = 0.0, 3.0 * amount
    sign = math.copysign(1.0, excess(low))
    assert excess(high) * sign < 0.0, "the flank recedes into the tooth"
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) * sign > 0.0 else (low, middle)
    # second order: the amount changes along the normal and the flank curves, about amount^2/1 mm
    assert_allclose(low, removed(flank, rho, z), rtol=1e-2 * amount / 1e-3)


@pytest.mark.thorough
@given(st.data(), st.floats(0.02, 0.98), st.floats(-0.49, 0.49))
@settings(max_examples=60)
def test_derivatives_of_every_modified_flank_agree_with_differences(data, height, place):
    mesh = data.draw(meshes())
    choice = data.draw(modifications(mesh.wheel, mesh.wheel_active_profile))
    driver = data.draw(st.sampled_from(["pinion", "wheel"]))
    flank = cylindrical_pair(mesh, modifications=(FlankModifications(), choice), driving=driver).wheel.flank
    low, high = (mesh.wheel.form_radius, mesh.wheel.tip_radius)
    rho, z = low + height * (high - low), place * mesh.wheel.face_width
    step = 1e-4  # mm; the parabolas that start at a line and the ramps switch within it at worst
    points = np.array([(rho + i * step, z + j * step) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    beyond = [jet.value > 0.0 for jet in flank.relief_starts(np.array(rho), np.array(z))]
    jet = flank.theta(points[:, 0], points[:, 1], np.array([beyond]).reshape(1, -1))
    slopes = [np.broadcast_to(part, 9).reshape(3, 3) for part in (jet.rho, jet.z)]
    value = jet.value.reshape(3, 3)
    first = [(value[2, 1] - value[0, 1]) / (2 * step), (value[1, 2] - value[1, 0]) / (2 * step)]
    # rounding 1e-16/1e-4, truncation third derivative * 1e-8
    assert_allclose([slopes[0][1, 1], slopes[1][1, 1]], first, rtol=0, atol=5e-9)
    second = [
        (slopes[0][2, 1] - slopes[0][0, 1]) / (2 * step),
        (slopes[0][1, 2] - slopes[0][1, 0]) / (2 * step),
        (slopes[1][2, 1] - slopes[1][0, 1]) / (2 * step),
        (slopes[1][1, 2] - slopes[1][1, 0]) / (2 * step),
    ]
    here = [np.broadcast_to(part, 9)[4] for part in (jet.rho_rho, jet.rho_z, jet.rho_z, jet.z_z)]
    # where a one-sided parabola starts within the step its second derivative jumps: by 2 C/length^2/r_b at most
    jumps = _jump_near(flank, rho, z, step)
    assert_allclose(here, second, rtol=1e-5, atol=1e-8 + jumps)


def _jump_near(flank, rho, z, step):
    """1e-3 1/mm^2 where a one-sided parabola starts within the step, else nothing."""
    for term in getattr(flank, "terms", ()):
        if isinstance(term, Term) and term.shape is one_sided_parabola:
            t = float(term.coordinate(flank.nominal, np.array(rho), np.array(z)).value)
            if abs(t * term.length) < 10.0 * step:
                return 1.0
    return 0.0


@pytest.mark.parametrize(
    "shape",
    [linear, parabola, one_sided_parabola, logarithmic, CircularArc(0.02, 12.5), CircularArc(1.0, 12.5)],
)
@given(t=st.floats(-1.6, 1.6))
def test_shape_derivatives_agree_with_differences(shape, t):
    step = 1e-5
    if min(abs(t), abs(abs(t) - 1.0)) < 2.0 * step:
        t = 0.5  # the joints are looked at below
    values = np.array([[float(part) for part in shape(np.array(t + k * step))] for k in (-1, 0, 1)])
    differences = (values[2] - values[0]) / (2.0 * step)
    # logarithmic: f''' is 1e4 near the ends of the face
    assert_allclose(values[1, 1:], differences[:2], rtol=2e-5, atol=1e-7)


@pytest.mark.parametrize(("shape", "joint"), [(logarithmic, 1.0), (logarithmic, -1.0), (one_sided_parabola, 0.0)])
def test_shapes_of_two_pieces_join_with_equal_value_and_slope(shape, joint):
    before, after = (shape(np.array(joint + d))[:2] for d in (-1e-12, 1e-12))
    assert_allclose(before, after, atol=1e-9)  # slopes of up to 43 with bends of 4000 over 2e-12


# Relief starts


def test_relief_starts_are_the_starts_of_the_linear_reliefs_only():
    both = modified(
        tip_relief=AMOUNT,
        tip_relief_start=2.0 * radius_at(0.7),
        tip_relief_form="linear",
        root_relief=AMOUNT,
        root_relief_start=2.0 * radius_at(0.3),
        root_relief_form="linear",
    )
    for share, expected in ((0.8, (True, False)), (0.5, (False, False)), (0.2, (False, True))):
        distances = both.relief_starts(np.array(radius_at(share)), np.array(0.0))
        assert tuple(bool(jet.value > 0.0) for jet in distances) == expected
        length = ACTIVE.end_roll_length - ACTIVE.start_roll_length
        # mm; coordinates of some 50 mm are subtracted
        assert_allclose([jet.value for jet in distances], [length * (share - 0.7), length * (0.3 - share)], atol=1e-12)
    assert (
        modified(tip_relief=AMOUNT, tip_relief_start=2.0 * radius_at(0.7)).relief_starts(np.array(52.0), np.array(0.0))
        == ()
    )


def test_flank_continues_smoothly_beyond_a_relief_start_if_told_so():
    flank = modified(tip_relief=AMOUNT, tip_relief_start=2.0 * radius_at(0.7), tip_relief_form="linear")
    rho, z = np.array([radius_at(0.6), radius_at(0.9)]), np.zeros(2)
    ramp, none = (flank.removal(rho, z, np.full((2, 1), side)).value for side in (True, False))
    assert_allclose(ramp, [-AMOUNT / 3.0, AMOUNT * 2.0 / 3.0], rtol=OF_ROLL)
    assert_allclose(none, 0.0)
    assert_allclose(flank.removal(rho, z).value, [0.0, AMOUNT * 2.0 / 3.0], rtol=OF_ROLL)


@pytest.mark.parametrize("form", ["linear", "parabolic"])
def test_value_is_continuous_at_the_start_of_a_relief(form):
    flank = modified(tip_relief=AMOUNT, tip_relief_start=2.0 * radius_at(0.7), tip_relief_form=form)
    values = flank.theta(radius_at(0.7) + np.array([-1e-10, 1e-10]), np.zeros(2)).value
    assert_allclose(values[0], values[1], rtol=0, atol=1e-11)  # rad; 2e-10 mm at 0.008 rad/mm


# Symmetry


@given(st.data(), st.floats(0.05, 0.95), st.floats(-0.5, 0.5))
@settings(max_examples=40)
def test_modified_flank_of_the_other_side_is_the_mirror_image_of_the_other_hand(data, height, place):
    helix = data.draw(st.sampled_from([0.0, 15.0, -25.0]))
    one, other = (cylindrical_mesh(helix_deg=sign * helix) for sign in (1.0, -1.0))
    choice = data.draw(modifications(one.pinion, one.pinion_active_profile))
    both = (choice, FlankModifications())
    first = cylindrical_pair(one, modifications=both).pinion.flank
    second = cylindrical_pair(other, modifications=both, driving="wheel").pinion.flank
    rho = np.array(GEAR.form_radius + height * (TIP - GEAR.form_radius))
    z = np.array(place * GEAR.face_width)
    # the same operations with the signs turned, to the bit
    assert_array_equal(first.theta(rho, z).value, -second.theta(rho, z).value)


# Failure paths


test_modifications_off_the_flank_are_refused = refusals(
    lambda amounts: modified(**amounts),
    *(
        (
            {relief: AMOUNT, f"{relief}_start": diameter},
            rf"pinion.modifications.{relief}_start .*: {diameter:g} mm is not between",
        )
        for relief in ("tip_relief", "root_relief")
        for diameter in (0.0, 90.0, 2.0 * ACTIVE.start_radius, 2.0 * TIP, 130.0)
    ),
    *(
        ({"end_relief": AMOUNT, "end_relief_length": length}, r"end_relief_length: .* mm is not between 0 and 12.5 mm")
        for length in (0.0, -1.0, 1.01 * HALF)
    ),
    *(
        (
            {"end_relief": AMOUNT, "end_relief_length": 3.0, f"end_relief_{end}_length": 13.0},
            f"end_relief_{end}_length: 13 mm is not between 0 and 12.5 mm",
        )
        for end in ("lower", "upper")
    ),
    ({"end_relief_lower": AMOUNT}, r"end_relief_length: 0 mm is not between 0 and 12\.5 mm"),
    ({"end_relief_upper": AMOUNT}, r"end_relief_length: 0 mm is not between 0 and 12\.5 mm"),
    (
        {"lead_crowning": 13.0, "lead_crowning_form": "circular"},
        "lead_crowning: 13 mm is more than a circular arc over 25 mm can fall",
    ),
)


@pytest.mark.parametrize("relief", ["tip_relief", "root_relief"])
def test_roll_angle_or_length_off_the_active_profile_is_refused_in_its_own_unit(relief):
    lengths = [math.sqrt(radius_at(share) ** 2 - BASE**2) for share in (0.0, 1.0)]
    low, high = (f"{math.degrees(length / BASE):.6g}" for length in lengths)
    told = rf"^pinion.modifications.{relief}_start_roll \(roll angle .*\): 5 deg is not between {low} and {high} deg$"
    with pytest.raises(InputError, match=told):
        modified(**{relief: AMOUNT, f"{relief}_start_roll": math.radians(5.0)})
    low, high = (f"{length:.6g}" for length in lengths)
    told = rf"^pinion.modifications.{relief}_start_length \(roll length .*\): 99 mm is not between {low} and {high} mm$"
    with pytest.raises(InputError, match=told):
        modified(**{relief: AMOUNT, f"{relief}_start_length": 99.0})


def test_starts_of_reliefs_that_are_not_there_are_not_looked_at():
    assert isinstance(modified(tip_relief_start=3.0, end_relief_length=999.0), InvoluteFlank)


test_modifications_that_cannot_be_are_refused = refusals(
    lambda amounts: FlankModifications(**amounts),
    (
        {"tip_relief": AMOUNT, "tip_relief_start": 105.0, "tip_relief_start_length": 20.0},
        "^tip_relief_start: found tip_relief_start = 105.0, tip_relief_start_length = 20.0; give one of them$",
    ),
    *(
        ({name: value}, f"{name}: {value} mm is not finite")
        for name in ("lead_crowning", "tip_relief", "end_relief_length", "profile_slope")
        for value in (math.nan, math.inf, "much", None)
    ),
    ({"root_relief_start_roll": math.nan}, r"^root_relief_start_roll: nan rad is not finite$"),
    ({"end_relief_lower": math.nan}, r"^end_relief_lower: nan mm is not finite$"),
    (
        {"lead_crowning_form": "round", "tip_relief_form": "quadratic"},
        (
            "^lead_crowning_form: 'round' is not 'parabolic', 'circular' or 'logarithmic'$",
            "^tip_relief_form: 'quadratic' is not 'parabolic' or 'linear'$",
        ),
    ),
    *(
        ({"polynomial": wrong}, r"polynomial: .* is not six finite numbers, a1 to a6")
        for wrong in ((1.0, 2.0), (0.0,) * 5 + (math.nan,), ("a",) * 6, 3.0, None)
    ),
)


@pytest.mark.parametrize(
    "amounts",
    [
        {"polynomial": (50.1, 0.0, 0.0, 0.0, 0.0, 0.0)},
        {"polynomial": (0.0, -50.1 / HALF, 0.0, 0.0, 0.0, 0.0)},
        {"polynomial": (100.0,) * 6},
        {"polynomial": (0.0, 0.0, 0.0, -100.0, 100.0, 100.0)},
        {"lead_crowning": 50.1},
        {"lead_crowning": 45.0, "end_relief": 5.1, "end_relief_length": 5.0},
    ],
)
def test_more_than_twice_the_longer_side_of_the_flank_is_no_modification(amounts):
    told = r"^pinion.modifications: together they remove or add up to .* mm; allowed up to 50 mm, 2 longer sides"
    with pytest.raises(InputError, match=told):
        modified(**amounts)
    modified(polynomial=(49.9, *[0.0] * 5))


@pytest.mark.parametrize(
    ("name", "amount"), [("lead_crowning", 5.0), ("helix_slope", -1.001), ("twist", 1.001), ("end_relief_upper", 1.5)]
)
def test_micrometres_given_as_millimetres_are_doubted(name, amount):
    told = rf"^pinion.modifications.{name}: {amount:g} mm is more than 1 mm; is its unit right\?$"
    with pytest.warns(AccuracyWarning, match=told):
        modified(**{name: amount}, end_relief_length=5.0)
    assert modified(**{name: 0.999}, end_relief_length=5.0).terms  # and no warning


def test_gear_pair_of_the_helpers_has_the_modified_flank_on_the_gear_asked_for():
    pair = gear_pair(wheel=FlankModifications(lead_crowning=AMOUNT))
    assert isinstance(pair.pinion.flank, InvoluteFlank)
    assert isinstance(pair.wheel.flank, ModifiedFlank)
