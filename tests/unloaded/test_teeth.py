"""Neighbouring teeth: the envelope, its transfers and jumps, its numbers, symmetries, and what is refused."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import AccuracyWarning, GeometryError, InputError, trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded.teeth import MeshPath, trace_teeth
from loaded_tca.unloaded.tooth_cycle import REACH
from tests.refusals import refused_calls
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair, highest_on_grid, pairs

ARCSEC = math.degrees(3600.0)
ROUNDING = 1e-13  # rad; angles of order 0.1, and mm from them: 1e-16 seen
CROSSING = 1e-10  # rad, promised accuracy of a transfer point
LEAD = FlankModifications(lead_crowning=0.02)
BOTH = FlankModifications(lead_crowning=0.02, profile_crowning=0.01)
RELIEF = FlankModifications(lead_crowning=0.02, tip_relief=0.02, tip_relief_start=104.0, tip_relief_form="linear")
TILTED = Mounting(out_of_plane=1e-3)

drives = pytest.mark.parametrize("driving", ["pinion", "wheel"])
kinds = pytest.mark.parametrize("mesh", [{}, {"helix_deg": 15.0}, {"helix_deg": -30.0, "width": 60.0}])


def pitch(pair, count=41, start=-0.5):
    return (start + np.linspace(0.0, 1.0, count)) * pair.pitch


def with_error(pair, function):
    """A MeshPath of the pair with a given transmission error of the order of the mesh."""
    mesh = trace_teeth(pair, pitch(pair, 65, 0.2))
    return replace(mesh, transmission_error=function(2.0 * math.pi * mesh.pinion_angle / pair.pitch))


# The envelope


@pytest.mark.quick_cases("mesh0-pinion")
@drives
@kinds
def test_envelope_is_the_first_touch_over_many_teeth(mesh, driving):
    pair = gear_pair(BOTH, mounting=TILTED, driving=driving, **mesh)
    traced = trace_teeth(pair, pitch(pair, 9))
    for phi1, obtained in zip(traced.pinion_angle, traced.transmission_error, strict=True):
        teeth = trace_contact(pair, phi1 - np.arange(-3, 4) * pair.pitch) if mesh else None
        own = phi1 - np.arange(-1, 2) * pair.pitch
        lags = (teeth or trace_contact(pair, own)).transmission_error * pair.driving
        assert_allclose(obtained * pair.driving, np.nanmax(lags), atol=ROUNDING)


@drives
def test_envelope_lies_above_a_dense_grid_of_all_teeth(driving):
    """The best point of a grid is below the true one by the curvature times its cell squared."""
    pair = gear_pair(BOTH, mounting=TILTED, driving=driving, helix_deg=15.0)
    traced = trace_teeth(pair, pitch(pair, 5))
    for phi1, obtained in zip(traced.pinion_angle, traced.transmission_error, strict=True):
        grid = [highest_on_grid(pair, phi1 - k * pair.pitch, (400, 60)) for k in range(-1, 2)]
        gap = pair.driving * obtained - max(pair.driving * value for value in grid)
        assert 0.0 <= gap < 0.2 / ARCSEC


def test_pair_plus_one_comes_into_mesh_after_pair_zero():
    pair = gear_pair(BOTH)
    mesh = trace_teeth(pair, pitch(pair, 21, 0.0))
    assert mesh.pairs[:3].tolist() == [0, 1, -1]
    assert mesh.leading_pair[[0, -1]].tolist() == [0, 1]
    assert_array_equal(mesh.paths[1].pinion_angle, mesh.pinion_angle - pair.pitch)  # the same operation
    first = mesh.paths[1].pinion_radius[np.flatnonzero(mesh.paths[1].in_contact & ~mesh.paths[1].on_edge)]
    assert (np.diff(first) > 0.0).all(), "it starts at the root of the driving pinion"


@drives
@kinds
def test_transmission_error_repeats_with_the_pitch(mesh, driving):
    pair = gear_pair(BOTH, mounting=TILTED, driving=driving, **mesh)
    traced = trace_teeth(pair, np.linspace(-1.5, 1.5, 61) * pair.pitch)
    first, second, third = (traced.transmission_error[k : k + 20] for k in (0, 20, 40))
    assert_allclose(first, second, atol=ROUNDING)
    assert_allclose(second, third, atol=ROUNDING)
    assert (traced.leading_pair[20:40] - traced.leading_pair[:20] == 1).all()


def test_wheel_angle_follows_the_envelope():
    pair = gear_pair(BOTH)
    mesh = trace_teeth(pair)
    assert_allclose(mesh.wheel_angle - pair.ratio * mesh.pinion_angle, mesh.transmission_error, rtol=0, atol=ROUNDING)
    assert len(mesh) == 21
    assert "tooth pairs" in repr(mesh)


def test_lag_is_zero_for_the_leading_pair_and_positive_or_nan_for_the_others():
    mesh = trace_teeth(gear_pair(BOTH, mounting=TILTED, helix_deg=15.0))
    column = (mesh.pairs[:, None] == mesh.leading_pair).argmax(axis=0)
    assert_allclose(mesh.initial_separation[column, np.arange(len(mesh))], 0.0, atol=ROUNDING)
    assert np.nanmin(mesh.initial_separation) >= -ROUNDING
    far = np.nanmax(mesh.initial_separation) * mesh.pair.base_radii[1]
    assert 0.5 * REACH * mesh.pair.module < far <= REACH * mesh.pair.module


def test_pairs_are_nan_exactly_where_they_lag_beyond_the_reach():
    pair = gear_pair(BOTH, mounting=TILTED, helix_deg=15.0)
    mesh = trace_teeth(pair, pitch(pair, 41))
    for path in mesh.paths:
        own = trace_contact(pair, path.pinion_angle).transmission_error
        near = (mesh.transmission_error - own) * pair.base_radii[1] <= REACH * pair.module
        assert_allclose(path.in_contact, near)
        assert_allclose(path.transmission_error[near], own[near], atol=ROUNDING)


@pytest.mark.quick_cases("0.0-pinion")
@drives
@pytest.mark.parametrize("axial_offset", [0.0, 24.9])
def test_one_position_alone_has_the_teeth_of_many(axial_offset, driving):
    """Also where the flanks share a strip of 0.1 mm, far narrower than the scan that tells the reach."""
    pair = gear_pair(BOTH, mounting=Mounting(axial_offset=axial_offset), driving=driving, helix_deg=15.0)
    many = trace_teeth(pair, pitch(pair, 9))
    alone = [trace_teeth(pair, [angle]) for angle in many.pinion_angle]
    assert_allclose([mesh.transmission_error[0] for mesh in alone], many.transmission_error, atol=ROUNDING)
    assert [mesh.leading_pair[0] for mesh in alone] == many.leading_pair.tolist()


def test_leading_contact_is_that_of_the_leading_pair():
    pair = gear_pair(BOTH, mounting=TILTED)
    mesh = trace_teeth(pair)
    lead = mesh.leading_contact
    assert_allclose(lead.pinion_angle, mesh.pinion_angle - mesh.leading_pair * pair.pitch, rtol=0, atol=ROUNDING)
    assert_allclose(lead.transmission_error, mesh.transmission_error, atol=ROUNDING)
    assert lead.in_contact.all()


# Conjugate gears


@pytest.mark.quick_cases("mesh0-pinion", "mesh2-wheel")
@drives
@kinds
def test_unmodified_aligned_pair_has_no_transmission_error_and_no_jump(mesh, driving):
    traced = trace_teeth(gear_pair(driving=driving, **mesh))
    assert_allclose(traced.transmission_error, 0.0, atol=ROUNDING)
    assert traced.is_continuous
    assert_allclose(traced.jumps, 0.0)
    assert_allclose(traced.harmonics(5).amplitude, 0.0, atol=ROUNDING)


@pytest.mark.thorough
@pytest.mark.parametrize("mesh", [{}, {"teeth": (20, 60), "shifts": (0.3, -0.1)}, {"helix_deg": 15.0}])
def test_contact_ratio_of_unmodified_gears_is_the_geometric_one(mesh):
    """Beyond the path of contact the corner contact lags with the square of the way: by 1 nm after 1/1000 pitch."""
    traced, geometric = trace_teeth(gear_pair(**mesh), [0.0]), cylindrical_mesh(**mesh).total_contact_ratio
    assert_allclose(traced.contact_ratio(0.0), geometric, atol=1e-5)
    corner = [traced.contact_ratio(tolerance) - geometric for tolerance in (1e-8, 1e-6, 1e-4)]
    assert_allclose(np.divide(corner[1:], corner[:-1]), 10.0, rtol=0.08)  # the square root of 100
    assert 1e-3 < corner[1] < 3e-3


def test_contact_ratio_of_crowned_gears_grows_from_one_with_the_tolerance():
    mesh = trace_teeth(gear_pair(BOTH))
    ratios = [mesh.contact_ratio(tolerance) for tolerance in (0.0, 1e-3, 5e-3, 2e-2)]
    assert ratios[0] == pytest.approx(1.0, abs=1e-5)
    assert (np.diff(ratios) > 0.0).all()


def test_contact_ratio_of_parabolas_follows_from_their_coefficient():
    """h = -c x^2: a pair lags by c p (2|x| - p), so that the ratio is 1 + tolerance/(c p^2), p the pitch."""
    pair = gear_pair(BOTH)
    own = np.array([-0.2, 0.0, 0.2]) * pair.pitch
    square = np.polynomial.Polynomial.fit(own, trace_contact(pair, own).transmission_error, 2).convert().coef[2]
    drop = -square * pair.base_radii[1] * pair.pitch**2
    assert_allclose(trace_teeth(pair).contact_ratio(1e-3), 1.0 + 1e-3 / drop, rtol=5e-3)


@pytest.mark.thorough
@given(pairs(), st.sampled_from([0.0, 1e-6, 1e-3, 2e-2]))
@settings(max_examples=3, deadline=None)
def test_contact_ratio_is_never_below_one_and_does_not_depend_on_the_positions(pair, tolerance):
    ratios = [trace_teeth(pair, angles).contact_ratio(tolerance) for angles in ([0.0], pitch(pair, 3, -0.3))]
    assert ratios[0] == ratios[1] >= 1.0


# Transfers and jumps


@pytest.mark.quick_cases("15.0-wheel")
@drives
@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
def test_curves_cross_at_the_transfer_point(helix_deg, driving):
    pair = gear_pair(BOTH, mounting=TILTED, driving=driving, helix_deg=helix_deg)
    (transfer,) = trace_teeth(pair, pitch(pair, 21, 0.0)).transfers
    assert transfer.pairs == (0, 1)
    own = transfer.pinion_angle - np.arange(2) * pair.pitch
    for shift, sign in ((-CROSSING, 1.0), (CROSSING, -1.0)):
        old, new = trace_contact(pair, own + shift).transmission_error
        assert sign * pair.driving * (old - new) > 0.0
    # rad; the same contact from another start, beside rtol
    assert_allclose(transfer.transmission_error, trace_contact(pair, own).transmission_error, atol=1e-12)
    assert transfer.is_continuous


@pytest.mark.thorough
def test_transfer_does_not_depend_on_the_positions():
    pair = gear_pair(BOTH, mounting=TILTED, helix_deg=15.0)
    found = [trace_teeth(pair, pitch(pair, count, 0.0)).transfers[0].pinion_angle for count in (3, 21, 64)]
    assert_allclose(found, found[0], atol=CROSSING)


def test_contacts_of_a_transfer_touch_at_once():
    """Both pairs stand at the same wheel angle, a pitch of the wheel apart."""
    pair = gear_pair(BOTH, mounting=TILTED, helix_deg=15.0)
    transfer = trace_teeth(pair, pitch(pair, 2, 0.0)).transfers[0]
    first, second = transfer.contacts
    # angles of order 0.1 are subtracted
    assert_allclose(first.pinion_angle - second.pinion_angle, pair.pitch, rtol=1e-12)
    assert_allclose(first.wheel_angle - second.wheel_angle, pair.ratio * pair.pitch, rtol=1e-9)


def test_coarse_positions_over_several_pitches_have_every_transfer():
    pair = gear_pair(BOTH)
    mesh = trace_teeth(pair, [0.0, 3.3 * pair.pitch])
    assert [transfer.pairs for transfer in mesh.transfers] == [(0, 1), (1, 2), (2, 3)]
    assert_allclose(np.diff([transfer.pinion_angle for transfer in mesh.transfers]), pair.pitch, atol=CROSSING)


def test_one_transfer_per_pitch_where_it_lies_on_the_ends():
    """Where curves coincide they are parted half a pitch from the pitch point, at the first and the last position."""
    mesh = trace_teeth(gear_pair(teeth=(30, 30)))
    (transfer,) = mesh.transfers
    assert abs(transfer.pinion_angle) == pytest.approx(0.5 * mesh.pair.pitch)


@pytest.mark.thorough
@drives
def test_lead_crowning_alone_leaves_a_straight_line_with_a_jump_under_misalignment(driving):
    pair = gear_pair(LEAD, mounting=TILTED, driving=driving, helix_deg=15.0)
    mesh = trace_teeth(pair, pitch(pair, 201, 0.0))
    bridged = mesh.leading_contact.on_edge.sum() * pair.pitch / 200
    assert not mesh.is_continuous
    inside = np.linspace(-0.2, 0.2, 5) * pair.pitch
    line = np.polynomial.Polynomial.fit(inside, trace_contact(pair, inside).transmission_error, 1).convert()
    (jump,) = mesh.jumps
    assert_allclose(jump, -line.coef[1] * (pair.pitch - bridged), rtol=0.01)  # two positions


@pytest.mark.thorough
@drives
def test_profile_crowning_makes_the_transmission_error_continuous(driving):
    """Parabolas c x^2 on a line of slope s cross inside the path if c > s/(2 x_end - pitch)."""
    teeth, amounts = {"helix_deg": 15.0, "driving": driving, "mounting": TILTED}, np.array([0.0, 0.5, 1.5, 3.0])
    bare = gear_pair(LEAD, **teeth)
    inside = np.linspace(-0.2, 0.2, 5) * bare.pitch
    line = np.polynomial.Polynomial.fit(inside, trace_contact(bare, inside).transmission_error, 1).convert()
    far = np.linspace(0.3, 1.2, 181) * bare.pitch * np.sign(line.coef[1]) * bare.driving
    surface = trace_contact(bare, far)
    end = np.abs(far[surface.on_edge.argmax()])
    radius, active = bare.base_radii[0], cylindrical_mesh(helix_deg=15.0).pinion_active_profile
    half = 0.5 * (active.end_roll_length - active.start_roll_length) / radius
    slope = abs(line.coef[1]) * bare.base_radii[1] * math.cos(math.radians(14.076))
    enough = slope * half**2 / (2.0 * end - bare.pitch)
    found = []
    for amount in amounts * enough:
        crowned = FlankModifications(lead_crowning=0.02, profile_crowning=amount)
        found.append(trace_teeth(gear_pair(crowned, **teeth)).is_continuous)
    assert found == [False, False, True, True]


@pytest.mark.thorough
def test_linear_tip_and_root_relief_make_it_continuous_too():
    relief = FlankModifications(
        lead_crowning=0.02, tip_relief=0.02, tip_relief_start=108.0, root_relief=0.02, root_relief_start=102.0
    )
    mesh = trace_teeth(gear_pair(relief, mounting=TILTED, helix_deg=15.0))
    assert mesh.is_continuous
    assert_allclose(mesh.jumps, 0.0)


@pytest.mark.thorough
def test_corner_contact_belongs_to_the_envelope():
    mesh = trace_teeth(gear_pair(LEAD, mounting=TILTED, helix_deg=15.0), pitch(gear_pair(LEAD, helix_deg=15.0), 81))
    lead = mesh.leading_contact
    assert lead.on_edge.any()
    steps = np.abs(np.diff(mesh.transmission_error))
    assert steps.max() < 0.5 * mesh.peak_to_peak, "the tip bridges the jump in several positions"


# Symmetries


def test_equal_gears_may_be_exchanged():
    """Seen from the wheel the same contact runs backwards: phi2(-phi2(phi1)) = -phi1."""
    crowned = FlankModifications(profile_crowning=0.01)
    pair = gear_pair(crowned, crowned, teeth=(30, 30))
    mesh = trace_teeth(pair, pitch(pair, 20))
    back = trace_teeth(pair, -mesh.wheel_angle[::-1])
    assert_allclose(back.wheel_angle, -mesh.pinion_angle[::-1], atol=ROUNDING)
    assert mesh.mean < 0.0


@pytest.mark.thorough
@given(st.floats(-1e-3, 1e-3), st.sampled_from([0.0, 12.0]))
@settings(max_examples=4)
def test_sense_of_rotation_mirrors_the_pair(angle, helix_deg):
    kwargs = {"pinion": BOTH, "teeth": (25, 25)}
    one = trace_teeth(gear_pair(mounting=Mounting(out_of_plane=angle), helix_deg=helix_deg, **kwargs), None)
    other = gear_pair(mounting=Mounting(out_of_plane=-angle), helix_deg=-helix_deg, sense="negative", **kwargs)
    assert_allclose(trace_teeth(other).transmission_error, one.transmission_error, atol=ROUNDING)


@pytest.mark.thorough
def test_wheel_driving_mirrors_equal_gears():
    """Exchange the two gears and turn time round: driving by the wheel is the negative of driving by the pinion."""
    crowned = FlankModifications(lead_crowning=0.02, profile_crowning=0.01)
    found = {d: trace_teeth(gear_pair(crowned, teeth=(30, 30), driving=d)) for d in ("pinion", "wheel")}
    assert_allclose(found["wheel"].transmission_error, -found["pinion"].transmission_error[::-1], atol=ROUNDING)
    assert found["wheel"].peak_to_peak == pytest.approx(found["pinion"].peak_to_peak)


# Numbers of one pitch


def test_harmonics_of_a_known_function():
    pair = gear_pair(BOTH)
    mesh = with_error(pair, lambda x: -3.0 + 2.0 * np.cos(x + 0.5) + 0.25 * np.cos(3.0 * x - 1.0))
    found = mesh.harmonics(4)
    assert found.order.tolist() == [1, 2, 3, 4]
    # also below: sums of some ten terms of order one, 2e-16 seen
    assert_allclose(found.amplitude, [2.0, 0.0, 0.25, 0.0], atol=1e-12)
    assert_allclose(found.phase[[0, 2]], [0.5, -1.0], atol=1e-12)
    assert mesh.mean == pytest.approx(-3.0)
    assert mesh.area == pytest.approx(-3.0 * pair.pitch)


def test_harmonics_do_not_depend_on_where_the_pitch_starts():
    pair = gear_pair(BOTH, mounting=TILTED)
    found = [trace_teeth(pair, pitch(pair, 41, start)).harmonics(3) for start in (-0.5, 0.3)]
    assert_allclose(found[0].amplitude, found[1].amplitude, rtol=0.01)  # 40 positions on a function with a kink
    assert_allclose(np.exp(1j * found[0].phase), np.exp(1j * found[1].phase), atol=0.02)


CASES = [
    {"pinion": BOTH},
    {"pinion": BOTH, "mounting": TILTED, "helix_deg": 15.0},
    {"pinion": LEAD, "mounting": TILTED, "helix_deg": 15.0},
    {"pinion": RELIEF, "mounting": TILTED, "helix_deg": 15.0},
]


@pytest.mark.thorough
@drives
@pytest.mark.parametrize("case", [CASES[0], *(pytest.param(case, marks=pytest.mark.thorough) for case in CASES[1:])])
def test_peak_to_peak_does_not_depend_on_the_positions(case, driving):
    pair = gear_pair(driving=driving, **case)
    found = [trace_teeth(pair, pitch(pair, count)).peak_to_peak for count in (2, 5, 36)]
    assert_allclose(found, found[0], rtol=1e-9)


@pytest.mark.thorough
@drives
@pytest.mark.parametrize("case", [CASES[1], pytest.param(CASES[2], marks=pytest.mark.thorough)])
def test_peak_to_peak_is_that_of_positions_packed_about_the_highest_and_the_lowest(case, driving):
    """No use is made of the transfer and the summit that the package finds."""
    pair = gear_pair(driving=driving, **case)
    coarse = trace_teeth(pair, pitch(pair, 41))
    values = []
    for pick in (np.argmax, np.argmin):
        centre, width = coarse.pinion_angle[pick(coarse.transmission_error)], pair.pitch / 40
        for _ in range(5):
            fine = trace_teeth(pair, centre + width * np.linspace(-1.0, 1.0, 41))
            centre, width = fine.pinion_angle[pick(fine.transmission_error)], width / 15
        values.append(fine.transmission_error[pick(fine.transmission_error)])
    assert_allclose(coarse.peak_to_peak, values[0] - values[1], rtol=1e-6)


def test_peak_to_peak_of_part_of_a_pitch_is_that_of_its_ends_where_the_error_only_falls():
    pair = gear_pair(BOTH)
    mesh = trace_teeth(pair, np.array([0.1, 0.4]) * pair.pitch)
    # the same two numbers are subtracted
    assert mesh.peak_to_peak == pytest.approx(float(np.ptp(mesh.transmission_error)), rel=1e-12)
    assert trace_teeth(pair, [0.1]).peak_to_peak == 0.0


@pytest.mark.thorough
def test_peak_to_peak_of_some_pitches_is_that_of_one():
    pair = gear_pair(BOTH, mounting=TILTED)
    found = [
        trace_teeth(pair, [start * pair.pitch, end * pair.pitch]).peak_to_peak for start, end in ((0, 1), (-1.2, 2.9))
    ]
    assert found[1] == pytest.approx(found[0], rel=1e-9)


def test_peak_to_peak_of_one_tooth_alone_is_that_of_its_own_curve():
    pair = gear_pair(BOTH)
    mesh = trace_teeth(pair, np.linspace(-0.6, 0.6, 4) * pair.pitch, teeth=[0])
    dense = trace_contact(pair, np.linspace(-0.6, 0.6, 2001) * pair.pitch).transmission_error
    assert_allclose(mesh.peak_to_peak, np.ptp(dense), rtol=1e-6)


@pytest.mark.parametrize("angles", [[0.0], [0.0, 0.01], [0.0, 0.01, 0.05], np.linspace(0.0, 0.9, 30) ** 2])
def test_numbers_of_one_pitch_need_uniform_positions(angles):
    mesh = trace_teeth(gear_pair(BOTH), np.asarray(angles) * 0.2)
    for quantity in (lambda: mesh.mean, lambda: mesh.area, lambda: mesh.harmonics(1)):
        with pytest.raises(InputError, match="do not divide a pitch"):
            quantity()


@pytest.mark.parametrize("count", [0, 10, -1])
def test_harmonics_beyond_the_positions_are_refused(count):
    with pytest.raises(InputError, match=rf"count: found {count}; allowed 1 to 9 with 20 positions per pitch"):
        trace_teeth(gear_pair(BOTH)).harmonics(count)


# What is refused, and warned of


def test_chosen_teeth_alone_make_the_envelope():
    pair = gear_pair(BOTH)
    mesh = trace_teeth(pair, np.linspace(-0.6, 0.6, 13) * pair.pitch, teeth=[0])
    assert (mesh.leading_pair == 0).all()
    assert mesh.transfers == ()
    assert_allclose(mesh.transmission_error, trace_contact(pair, mesh.pinion_angle).transmission_error, atol=ROUNDING)


def test_fillet_interference_is_warned_of_only_where_it_leads():
    """A leading contact on the root form circle warns; one of a tooth that lags does not."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        assert isinstance(trace_teeth(gear_pair(LEAD)), MeshPath)
    hollow = FlankModifications(lead_crowning=0.02, profile_slope=0.3)
    with pytest.warns(AccuracyWarning, match="positions the leading contact lies on a root form circle"):
        trace_teeth(gear_pair(hollow, dedendum_coefficient=1.05))


test_teeth_refuses = refused_calls(
    (
        lambda angles: trace_teeth(gear_pair(), angles),
        r"pinion_angles: .*(finite numbers|increasing angles)",
        [[], [[0.0, 0.1]], [0.0, math.nan], [0.1, 0.0], [0.0, 0.0], 0.0, "ab", [1j]],
    ),
    (lambda teeth: trace_teeth(gear_pair(), teeth=teeth), "whole numbers are asked for", [[], [0, 0], [0.5]]),
    (
        lambda: trace_teeth(gear_pair(), np.linspace(0.0, 3.0, 13) * gear_pair().pitch, teeth=[0]),
        r"none of the tooth pairs \[0\] touches at .* first at pinion angle",
        GeometryError,
    ),
    (lambda: trace_teeth(gear_pair(), teeth=[9]), r"none of the tooth pairs \[9\] comes into reach", GeometryError),
    (lambda: trace_teeth(gear_pair(mounting=Mounting(axial_offset=30.0))), "no common flank", GeometryError),
    (
        lambda teeth: trace_teeth(gear_pair(), [0.0], teeth=teeth),
        r"teeth: .* whole numbers",
        [[math.nan], [math.inf], [10**30, 0], [0.5], 1.5, "ab", [True]],
    ),
    (
        lambda tolerance: trace_teeth(gear_pair()).contact_ratio(tolerance),
        r"tolerance: .* not a length from 0 to 0.15 mm, 0.05 modules",
        [-1.0, 0.16, math.nan, math.inf, "1 um"],
    ),
    (lambda: trace_teeth(gear_pair()).harmonics(2.5), r"count: found 2\.5"),
)
