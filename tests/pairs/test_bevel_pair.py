"""Bevel pairs: frames, conjugate action, line contact, mounting errors, pressure where Hertz holds."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, sample_separation, solve_contact, trace_contact
from loaded_tca.baselines.golden_section import search_golden_section
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.reference import hertz
from loaded_tca.unloaded.teeth import trace_teeth
from tests.refusals import refused_calls

CONJUGATE = 1e-12  # rad; the contract asks for 1e-9
CROWNED = FlankModifications(lead_crowning=0.02, profile_crowning=0.01)
NONE = FlankModifications()
SPIRAL = math.radians(35.0)
DRIVES = list(itertools.product(["pinion", "wheel"], ["positive", "negative"]))

errors = st.floats(-2.0, 2.0)
mountings = st.builds(BevelMounting, errors, errors, errors, st.floats(-0.05, 0.05))


def mesh_of(teeth=(20, 40), shaft_deg=90.0, spiral=0.0, **changes):
    return bevel_mesh(teeth, 4.0, 20.0, shaft_angle=math.radians(shaft_deg), spiral_angle=spiral, **changes)


def crowned(mounting=None, driving="pinion", sense="positive", **mesh):
    return bevel_pair(
        mesh_of(**mesh),
        modifications=(CROWNED, NONE),
        mounting=mounting or BevelMounting(),
        driving=driving,
        sense=sense,
    )


def cone_distance(path):
    return np.linalg.norm(path.point, axis=-1)


# Frames


def test_wheel_frame_without_errors_shares_the_apex():
    sigma = 1.2
    origin, axes = BevelMounting().place(sigma)
    assert_allclose(origin, 0.0)
    expected = [[-math.cos(sigma), 0, math.sin(sigma)], [0, -1, 0], [math.sin(sigma), 0, math.cos(sigma)]]
    assert_allclose(axes, expected)


@given(mountings, st.floats(0.5, 2.6))
def test_wheel_axes_stay_orthonormal_and_right_handed(mounting, sigma):
    _, axes = mounting.place(sigma)
    assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)  # products of unit vectors: 3e-17 seen
    assert_allclose(np.linalg.det(axes), 1.0)


def test_errors_move_the_wheel_as_their_letters_say():
    sigma = 0.5 * math.pi
    assert_allclose(BevelMounting(offset=0.1).place(sigma)[0], [0.0, 0.1, 0.0])
    assert_allclose(BevelMounting(pinion_axial=0.1).place(sigma)[0], [0.0, 0.0, -0.1])
    # 0.1 mm times the cosine of a right angle: 6e-18 seen
    assert_allclose(BevelMounting(wheel_axial=0.1).place(sigma)[0], [0.1, 0.0, 0.0], atol=1e-16)
    _, axes = BevelMounting(shaft_angle_error=0.1).place(sigma)
    assert_allclose(math.acos(axes[2, 2]), sigma + 0.1)


def test_pair_knows_its_sizes():
    mesh = mesh_of(spiral=SPIRAL)
    pair = bevel_pair(mesh)
    assert_allclose(pair.base_radii[0] / pair.base_radii[1], pair.ratio)
    assert_allclose(pair.module, mesh.pinion.mean_normal_module)
    assert (pair.teeth, pair.face_width) == ((20, 40), 20.0)


# Conjugate action


@pytest.mark.quick_cases(every=5)
@pytest.mark.parametrize("spiral", [0.0, SPIRAL])
@pytest.mark.parametrize("shaft_deg", [60.0, 90.0, 120.0])
@pytest.mark.parametrize("teeth", [(17, 17), (20, 40), (24, 72)])
def test_unmodified_pair_turns_evenly_and_touches_in_lines(teeth, shaft_deg, spiral):
    for driving, sense in DRIVES:
        pair = bevel_pair(mesh_of(teeth, shaft_deg, spiral), driving=driving, sense=sense)
        path = trace_contact(pair, np.linspace(-0.5, 0.5, 7) * pair.pitch)
        assert_allclose(path.transmission_error, 0.0, atol=CONJUGATE)
        assert path.on_line.all()
        assert not path.on_edge.any()


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("spiral", [0.0, SPIRAL])
def test_contact_ratio_is_the_turn_over_which_the_unmodified_pair_stays_conjugate(spiral, sense):
    mesh = mesh_of((30, 45), spiral=spiral)
    pair = bevel_pair(mesh, sense=sense)
    phi1 = np.linspace(-1.8, 1.8, 361) * pair.pitch
    path = trace_contact(pair, phi1)
    conjugate = np.abs(path.transmission_error) < CONJUGATE
    total = mesh.transverse_contact_ratio + mesh.overlap_ratio
    assert_allclose(conjugate.sum() * 0.01, total, atol=0.025)  # the angles stand 0.01 of a pitch apart


def test_straight_pair_touches_at_the_pitch_point_at_angle_zero():
    mesh = mesh_of((39, 32))
    contact = trace_contact(bevel_pair(mesh), [0.0])[0]
    distance, delta = mesh.pinion.mean_cone_distance, mesh.pinion.pitch_angle
    assert_allclose(contact.point, [distance * math.sin(delta), 0.0, distance * math.cos(delta)], atol=1e-9)
    assert_allclose([contact.pinion_lever, contact.wheel_lever], bevel_pair(mesh).base_radii, rtol=1e-9)


@pytest.mark.parametrize(("driving", "sense"), DRIVES)
@pytest.mark.parametrize("spiral", [0.0, SPIRAL, -SPIRAL])
def test_pitch_point_lies_on_both_flanks_at_angle_zero(spiral, driving, sense):
    mesh = mesh_of(shaft_deg=75.0, spiral=spiral)
    pair = bevel_pair(mesh, driving=driving, sense=sense)
    distance, delta = mesh.pinion.mean_cone_distance, mesh.pinion.pitch_angle
    rho, azimuth, z = pair.to_wheel(distance * np.array([math.sin(delta), 0.0, math.cos(delta)]))
    found = pair.wheel.flank.theta(rho, z).value - azimuth
    assert_allclose(found, 0.0, atol=1e-14)  # rad; none seen


# Crowned pairs


@pytest.mark.parametrize(("driving", "sense"), DRIVES)
def test_crowned_pair_of_equal_gears_touches_at_the_mean_cone_distance(driving, sense):
    for spiral in (0.0, SPIRAL):
        pair = crowned(driving=driving, sense=sense, teeth=(17, 17), spiral=spiral)
        contact = trace_contact(pair, [0.0])[0]
        assert_allclose(cone_distance(contact), mesh_of((17, 17)).pinion.mean_cone_distance, atol=1e-6)
        assert_allclose(contact.transmission_error, 0.0, atol=1e-12)  # rad; angles of order 0.1: 1e-16 seen
        assert contact.residual < 1e-9


def test_lead_crowning_alone_leaves_the_contact_of_a_straight_pair_on_the_mean_cone_distance():
    pair = bevel_pair(mesh_of(), modifications=(FlankModifications(lead_crowning=0.01), NONE))
    path = trace_contact(pair)
    distance = mesh_of().pinion.mean_cone_distance
    assert_allclose(cone_distance(path), distance, rtol=1e-3)
    assert_allclose(path.transmission_error, 0.0, atol=CONJUGATE)  # the section at R_m is unmodified


def test_negative_sense_of_a_right_hand_pair_mirrors_the_left_hand_pair():
    right = trace_contact(crowned(sense="negative", spiral=SPIRAL))
    left = trace_contact(crowned(spiral=-SPIRAL))
    # rad; angles of order 0.1, beside rtol
    assert_allclose(right.transmission_error, left.transmission_error, atol=1e-13)
    assert_allclose(right.point, left.point * [1.0, -1.0, 1.0], atol=1e-8)


@pytest.mark.thorough
def test_golden_section_agrees_with_the_reduced_solver():
    pair = crowned(spiral=SPIRAL, teeth=(17, 17))
    path = trace_contact(pair, [0.1])
    golden = search_golden_section(pair, path.pinion_angle, sections=24)
    assert_allclose(golden.wheel_angle, path.wheel_angle, atol=1e-10)
    assert_allclose(golden.point, path.point, atol=1e-4)


@pytest.mark.thorough
@pytest.mark.parametrize(("teeth", "spiral"), [((39, 32), 0.0), ((42, 14), SPIRAL)])
def test_teeth_take_over_from_each_other_along_the_whole_path(teeth, spiral):
    mesh = trace_teeth(crowned(teeth=teeth, spiral=spiral, shaft_deg=120.0 if spiral else 90.0))
    assert mesh.is_continuous
    assert 1e-6 < mesh.peak_to_peak < 1e-3


def test_relief_starts_at_a_diameter_of_the_mean_section():
    mesh = mesh_of()
    start = 2.0 * mesh.pinion.mean_cone_distance * math.sin(mesh.pinion.pitch_angle + 0.01)
    relieved = FlankModifications(tip_relief=0.03, tip_relief_start=start)
    flank = bevel_pair(mesh, modifications=(relieved, NONE)).pinion.flank
    angle = mesh.pinion.pitch_angle + np.array([0.0, 0.0099, 0.02])
    removed = flank.removal(70.0 * np.sin(angle), 70.0 * np.cos(angle)).value
    assert_allclose(removed[:2], 0.0)
    assert removed[2] > 1e-4
    tip = mesh.pinion.tip_angle
    assert_allclose(flank.removal(np.array(70.0 * math.sin(tip)), np.array(70.0 * math.cos(tip))).value, 0.03)


# Mounting errors


@pytest.mark.parametrize(("driving", "sign"), [("pinion", 1.0), ("wheel", -1.0)])
def test_offset_moves_the_contact_to_the_heel_if_it_takes_the_wheel_out_of_the_drive(driving, sign):
    """E takes the wheel away from a driving pinion; it closes by turning, which is more at the heel."""
    middle = mesh_of().pinion.mean_cone_distance
    for spiral in (0.0, SPIRAL):
        contact = trace_contact(crowned(BevelMounting(offset=0.05), driving, spiral=spiral), [0.0])[0]
        assert sign * (cone_distance(contact) - middle) > 0.5


@pytest.mark.parametrize("error", [{"pinion_axial": 0.05}, {"wheel_axial": 0.05}])
@pytest.mark.parametrize("driving", ["pinion", "wheel"])
def test_withdrawn_gears_of_a_straight_pair_lag_and_touch_towards_the_heel(error, driving):
    contact = trace_contact(crowned(BevelMounting(**error), driving), [0.0])[0]
    assert cone_distance(contact) - mesh_of().pinion.mean_cone_distance > 0.1
    assert (contact.transmission_error < 0.0) == (driving == "pinion")


def test_shaft_angle_error_leaves_the_contact_of_a_straight_pair_lengthwise_where_it_is():
    aligned = trace_contact(crowned(), [0.0])[0]
    opened = trace_contact(crowned(BevelMounting(shaft_angle_error=1e-3)), [0.0])[0]
    assert_allclose(cone_distance(opened), cone_distance(aligned), atol=0.01)
    assert opened.pinion_radius / opened.pinion_axial > aligned.pinion_radius / aligned.pinion_axial


# Pressure


@pytest.mark.parametrize(
    ("teeth", "spiral"), [((20, 40), 0.0), ((39, 32), 0.0), ((17, 17), SPIRAL), ((20, 40), SPIRAL)]
)
def test_peak_pressure_of_a_crowned_pair_is_that_of_hertz(teeth, spiral):
    pair, load = crowned(teeth=teeth, spiral=spiral), 100.0
    contact = trace_contact(pair, [0.0])[0]
    separation = sample_separation(pair, contact, cells=(32, 32), load=load)
    solution = solve_contact(separation.gap, separation.spacing, pair.contact_modulus, load=load)
    expected = hertz.point_contact(load, separation.curvatures, pair.contact_modulus)
    assert_allclose(solution.peak_pressure, expected.max_pressure, rtol=2e-3)
    assert_allclose(solution.approach, expected.approach, rtol=2e-3)


# Failures


test_bevel_pair_refuses = refused_calls(
    (lambda: crowned(driving="motor"), r"driving: 'motor' is not 'pinion' or 'wheel'"),
    (
        lambda: BevelMounting(offset=math.nan, shaft_angle_error=math.inf),
        ("^offset: nan mm is not finite$", "^shaft_angle_error: inf rad is not finite$"),
    ),
    (
        lambda: bevel_pair(mesh_of(), modifications=(NONE, FlankModifications(tip_relief=0.03, tip_relief_start=10.0))),
        r"wheel\.modifications\.tip_relief_start .* 10 mm is not between",
    ),
)


def test_contact_on_the_root_of_a_bevel_flank_is_called_so():
    """A root cone just below the pitch cone leaves no flank for the tip of the mating gear."""
    mesh = mesh_of((39, 32), root_angles=(math.radians(50.2), None))
    pair = bevel_pair(mesh)
    with pytest.warns(AccuracyWarning, match="fillet interference: at 1 of 1 positions .* on a root form cone, where"):
        path = trace_contact(pair, [-0.6 * pair.pitch])
    assert path.on_edge.all()
