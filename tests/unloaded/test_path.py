"""The contact path: conjugate gears, misalignment, symmetries, edges, and what is refused."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import AccuracyWarning, GeometryError, InputError, trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.gears import CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.unloaded import ContactPath, ContactPoint, trace_teeth
from tests.samples.gear_pairs import (
    NONE,
    cylindrical_mesh,
    gear_pair,
    meshes,
    modifications,
    pairs,
    sam_paper,
    transmission_error_at,
)

ARCSEC = math.degrees(1.0) * 3600.0
CONJUGATE = 1e-14  # rad; rounding of angles of order 0.1
SAME_POINT = 1e-6  # mm; the flat direction of a maximum is known to the root of rounding
SAME_ANGLE = 1e-13  # rad; an angle from the other gear, times the ratio: 2e-16 seen
PRINTED = 1e-3  # arcsec per rad: the last digit of the reference slopes

drives = pytest.mark.parametrize("driving", ["pinion", "wheel"])
senses = pytest.mark.parametrize("sense", ["positive", "negative"])


# Conjugate gears


@pytest.mark.quick_cases(every=5)
@drives
@senses
@pytest.mark.parametrize(
    "mesh",
    [
        {},
        {"helix_deg": 15.0},
        {"helix_deg": -30.0},
        {"shifts": (0.4, -0.2)},
        {"helix_deg": 12.0, "shifts": (0.3, 0.2)},
        {"teeth": (16, 24), "module": 4.5, "shifts": (0.1817, 0.1715), "width": 14.0, "distance": 91.5},
        {"distance": 137.5},
    ],
)
def test_transmission_error_of_an_aligned_unmodified_pair_is_nothing_over_the_pitch(mesh, driving, sense):
    pair = gear_pair(driving=driving, sense=sense, **mesh)
    path = trace_contact(pair)
    assert len(path) == 21
    assert_allclose(path.pinion_angle[[0, -1]], [-0.5 * pair.pitch, 0.5 * pair.pitch])
    share = path.in_contact & ~path.on_edge
    assert share.sum() > 10, "about the pitch point both flanks go on"
    assert_allclose(path.transmission_error[share], 0.0, atol=CONJUGATE)
    assert_allclose(path.wheel_angle, path.transmission_error + pair.ratio * path.pinion_angle, atol=CONJUGATE)
    assert path.residual.max() < 1e-12  # iterations end at rounding: 1e-15 seen


@drives
@senses
@pytest.mark.parametrize("helix_deg", [0.0, 15.0, -25.0])
def test_contact_at_zero_angles_is_the_pitch_point_of_the_middle_section(helix_deg, driving, sense):
    mesh = cylindrical_mesh(helix_deg=helix_deg, shifts=(0.2, 0.1))
    crowned = FlankModifications(lead_crowning=0.01)
    path = trace_contact(cylindrical_pair(mesh, modifications=(crowned, NONE), driving=driving, sense=sense), [0.0])
    assert_allclose(path.point[0], [mesh.pinion_working_radius, 0.0, 0.0], atol=SAME_POINT)
    assert_allclose(path.wheel_radius, mesh.wheel_working_radius, rtol=1e-12)  # the root of two squares: 4e-16 seen
    assert_allclose([*path.pinion_axial, *path.wheel_axial, *path.wheel_angle], 0.0, atol=SAME_POINT)


@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
def test_contact_runs_along_the_line_of_action_at_base_speed(helix_deg):
    """In the middle section the point moves by r_b1 per radian, along the common tangent of the base circles."""
    mesh = cylindrical_mesh(helix_deg=helix_deg)
    crowned = FlankModifications(lead_crowning=1e-6)
    pair = cylindrical_pair(mesh, modifications=(crowned, NONE))
    path = trace_contact(pair, np.linspace(-0.04, 0.04, 5))
    alpha = mesh.working_pressure_angle
    travel = pair.base_radii[0] * path.pinion_angle
    expected = [mesh.pinion_working_radius + travel * math.sin(alpha), travel * math.cos(alpha)]
    assert_allclose(path.point[:, :2].T, expected, atol=SAME_POINT)


def test_levers_are_those_of_the_normal_force():
    """r_b cos(beta_b) on either gear."""
    pair, mesh = sam_paper(15.0), cylindrical_mesh(helix_deg=15.0)
    contact = trace_contact(pair, [0.0])[0]
    expected = [radius * math.cos(mesh.pinion.base_helix_angle) for radius in pair.base_radii]
    assert_allclose([contact.pinion_lever, contact.wheel_lever], expected, rtol=1e-9)


@drives
def test_removed_material_lets_the_driven_gear_lag(driving):
    """A profile slope takes off material at the tip; where the pinion touches, the error has the sign of section 6c."""
    pair = gear_pair(FlankModifications(profile_slope=0.01), driving=driving)
    path = trace_contact(pair, [0.0])
    sign = -1.0 if driving == "pinion" else 1.0
    assert sign * path.transmission_error[0] * pair.base_radii[1] > 1e-3


# Misalignment


TABLE_3_AND_4 = [  # dissertation; in-plane and out-of-plane error [deg], slope [arcsec per rad of the pinion]
    (0.05, 0.0, -15.965),
    (-0.05, 0.0, 15.944),
    (0.1, 0.0, -31.951),
    (-0.1, 0.0, 31.866),
    (0.0, 0.05, 42.459),
    (0.0, -0.05, -42.608),
    (0.0, 0.1, 84.768),
    (0.0, -0.1, -85.364),
]


@pytest.mark.parametrize(("in_plane", "out_of_plane", "slope"), TABLE_3_AND_4)
@pytest.mark.filterwarnings("ignore:(pinion|wheel).modifications.lead_crowning")
@pytest.mark.parametrize("crowning", [2.27, 1.0])
def test_slope_of_the_transmission_error_is_that_of_reduced_tca_whatever_the_crowning(
    in_plane, out_of_plane, slope, crowning
):
    pair = gear_pair(
        FlankModifications(lead_crowning=crowning),
        mounting=Mounting(math.radians(in_plane), math.radians(out_of_plane)),
        teeth=(40, 37),
        module=1.0,
        width=20.0,
        helix_deg=14.0,
    )
    error = trace_contact(pair, [-0.01, 0.0, 0.01]).transmission_error * ARCSEC
    assert_allclose((error[2] - error[0]) / 0.02, slope, atol=PRINTED)
    assert_allclose(error[2] - 2.0 * error[1] + error[0], 0.0, atol=1e-4)  # a straight line


@drives
@senses
@pytest.mark.parametrize("mounting", [Mounting(in_plane=1e-6), Mounting(out_of_plane=1e-6), Mounting(-2e-6, 1e-6)])
def test_contact_of_a_crowned_spur_pair_shifts_by_the_misalignment_in_the_plane_of_action(mounting, driving, sense):
    """z = R f with R = b^2/(8 C) and f = delta cos(alpha_wt) - gamma sin(alpha_wt), the pinion driving."""
    crowned = FlankModifications(lead_crowning=0.01)
    pair = gear_pair(crowned, mounting=mounting, driving=driving, sense=sense)
    alpha = cylindrical_mesh().working_pressure_angle
    delta = mounting.out_of_plane if sense == "positive" else -mounting.out_of_plane
    across, apart = delta * math.cos(alpha), mounting.in_plane * math.sin(alpha)
    tilt = across - apart if driving == "pinion" else -(across + apart)
    path = trace_contact(pair, [-0.02, 0.0, 0.02])
    assert_allclose(path.pinion_axial, 25.0**2 / 0.08 * tilt, rtol=1e-3)  # second order: tilt, slope of the crowning


def test_out_of_plane_error_brings_the_contact_to_positive_z():
    path = trace_contact(sam_paper(mounting=Mounting(out_of_plane=1e-4)))
    assert (path.pinion_axial > 0.0).all()


@pytest.mark.parametrize("helix_deg", [15.0, -15.0])
def test_misalignments_of_equal_effect_in_the_plane_of_action_give_equal_errors(helix_deg):
    alpha, crowned = cylindrical_mesh(helix_deg=helix_deg).working_pressure_angle, FlankModifications(lead_crowning=0.5)
    size = 1e-6
    both = [Mounting(in_plane=-size / math.sin(alpha)), Mounting(out_of_plane=size / math.cos(alpha))]
    first, second = (
        trace_contact(gear_pair(crowned, mounting=one, helix_deg=helix_deg), [-0.02, 0.0, 0.02]) for one in both
    )
    assert_allclose(np.diff(first.transmission_error), np.diff(second.transmission_error), rtol=1e-3)
    assert abs(np.diff(first.transmission_error)).min() > 1e-9


def test_centre_distance_error_leaves_the_transmission_error_of_involutes_constant():
    path = trace_contact(
        gear_pair(FlankModifications(lead_crowning=0.01), mounting=Mounting(centre_distance_error=0.2))
    )
    inner = ~path.on_edge
    assert np.ptp(path.transmission_error[inner]) < CONJUGATE


@pytest.mark.parametrize("helix_deg", [0.0, 20.0])
def test_axial_offset_turns_the_wheel_by_its_helix(helix_deg):
    offset, mesh = 0.7, cylindrical_mesh(helix_deg=helix_deg)
    path = trace_contact(gear_pair(mounting=Mounting(axial_offset=offset), helix_deg=helix_deg), [0.0])
    expected = offset * math.tan(mesh.pinion.base_helix_angle) / mesh.wheel.base_radius
    assert_allclose(path.transmission_error, expected, atol=CONJUGATE)


# Symmetries


@pytest.mark.thorough
@given(st.data(), meshes(), st.sampled_from(["pinion", "wheel"]))
@settings(max_examples=20)
def test_negative_sense_is_the_mirror_image_of_the_positive_one(data, mesh, driving):
    """In the x, z plane: the hands change, the out-of-plane error turns round, all else stays."""
    mods = tuple(
        data.draw(modifications(gear, active))
        for gear, active in ((mesh.pinion, mesh.pinion_active_profile), (mesh.wheel, mesh.wheel_active_profile))
    )
    angle = st.floats(-0.01, 0.01)
    mounting = Mounting(data.draw(angle), data.draw(angle), 0.05, 0.3)
    mirrored = CylindricalMesh(
        *(replace(gear, helix_angle=-gear.helix_angle) for gear in (mesh.pinion, mesh.wheel)), mesh.centre_distance
    )
    turned = replace(mounting, out_of_plane=-mounting.out_of_plane)
    one = cylindrical_pair(mesh, modifications=mods, mounting=mounting, driving=driving)
    other = cylindrical_pair(mirrored, modifications=mods, mounting=turned, driving=driving, sense="negative")
    angles = np.linspace(-0.4, 0.4, 3) * one.pitch
    first, second = trace_contact(one, angles), trace_contact(other, angles)
    assert_allclose(second.transmission_error, first.transmission_error, atol=SAME_ANGLE)
    assert_allclose(np.abs(second.residual), np.abs(first.residual), atol=1e-9)


@pytest.mark.thorough
@given(pairs())
@settings(max_examples=20)
def test_turning_back_with_the_wheel_driving_passes_through_the_same_contacts(pair):
    """The same flanks touch at the same places; both angles change their sign."""
    back = replace(pair, sense=-pair.sense, driving=-pair.driving)
    angles = np.linspace(-0.4, 0.4, 3) * pair.pitch
    forth, reverse = trace_contact(pair, angles), trace_contact(back, -angles)
    assert_allclose(reverse.transmission_error, -forth.transmission_error, atol=SAME_ANGLE)


@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
@drives
def test_exchanging_the_gears_exchanges_the_angles(helix_deg, driving):
    """The same pair seen from the wheel: its frame is turned half round about z, the sense is the other one."""
    mesh = cylindrical_mesh(helix_deg=helix_deg)
    mods = (FlankModifications(lead_crowning=0.01, profile_crowning=0.004), FlankModifications(profile_crowning=0.01))
    gamma, apart, offset = 1e-4, 0.1, 0.4
    pair = cylindrical_pair(mesh, modifications=mods, mounting=Mounting(gamma, 0.0, apart, offset), driving=driving)
    distance = mesh.working_centre_distance + apart
    seen = Mounting(
        gamma,
        0.0,
        distance * math.cos(gamma) - offset * math.sin(gamma) - mesh.working_centre_distance,
        -distance * math.sin(gamma) - offset * math.cos(gamma),
    )
    other = cylindrical_pair(
        CylindricalMesh(mesh.wheel, mesh.pinion),
        modifications=mods[::-1],
        mounting=seen,
        driving="wheel" if driving == "pinion" else "pinion",
        sense="negative",
    )
    path = trace_contact(pair, np.linspace(-0.3, 0.3, 5) * pair.pitch)
    assert not path.on_edge.any()
    back = trace_contact(other, path.wheel_angle)
    assert_allclose(back.wheel_angle, path.pinion_angle, atol=SAME_ANGLE)
    assert_allclose(back.transmission_error, -path.transmission_error / pair.ratio, atol=SAME_ANGLE)
    assert_allclose(back.wheel_radius, path.pinion_radius, atol=SAME_POINT)
    assert_allclose(back.pinion_axial, path.wheel_axial, atol=SAME_POINT)


def test_error_does_not_depend_on_the_other_positions_of_the_path():
    pair = sam_paper(15.0, mounting=Mounting(1e-4, 2e-4))
    angles = np.linspace(-0.08, 0.08, 7)
    whole = trace_contact(pair, angles)
    single = [trace_contact(pair, [angle]).transmission_error[0] for angle in angles]
    assert_allclose(single, whole.transmission_error, rtol=0, atol=CONJUGATE)


# Edges


def edges(pair, path):
    """Distances to the eight edges (n, 8) [mm]."""
    own = pair.pinion.flank.edges(path.pinion_radius, path.pinion_axial)
    other = pair.wheel.flank.edges(path.wheel_radius, path.wheel_axial)
    return np.stack([jet.value for jet in (*own, *other)], axis=-1)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("helix_deg", "driving"), [pytest.param(15.0, "pinion", marks=pytest.mark.thorough), (0.0, "wheel")]
)
def test_edge_contact_of_a_growing_misalignment_is_found_and_continuous(helix_deg, driving):
    tilts = np.radians(np.linspace(0.0, 1.0, 101))
    contacts = []
    for tilt in tilts:
        pair = sam_paper(helix_deg, mounting=Mounting(0.3 * tilt, tilt), driving=driving)
        contacts.append(trace_contact(pair, [0.01])[0])
    edge = np.array([contact.on_edge for contact in contacts])
    assert not edge[0]
    assert edge[np.argmax(edge) :].all(), "once on the edge, it stays there"
    assert edge[-1]
    for contact in contacts:
        assert contact.residual < 1e-9
        assert bool(contact.edges.any()) == contact.on_edge
    error = np.array([contact.transmission_error for contact in contacts])
    step = tilts[1] - tilts[0]
    # a turn of the wheel about its middle moves the point that touches by less than half the face per radian
    longest_arm = 1.1 * math.hypot(12.5, 8.0) / 80.0
    assert np.abs(np.diff(error)).max() < longest_arm * step * 1.05
    assert np.abs(np.diff(error, 2)).max() < 0.2 * longest_arm * step, "the slope has no jump either"


def test_edge_contact_lies_on_the_edges_it_names_and_nowhere_beyond():
    for mounting in (Mounting(out_of_plane=0.01), Mounting(out_of_plane=-0.01), Mounting(in_plane=0.02)):
        for pair in (sam_paper(15.0, mounting=mounting), sam_paper(mounting=mounting, driving="wheel")):
            path = trace_contact(pair)
            distances = edges(pair, path)
            assert path.on_edge.all()
            assert distances.min() > -1e-7
            assert np.abs(distances[path.edges]).max() < 1e-7


def test_normal_on_an_edge_is_that_of_the_flank_that_goes_on():
    """The side of the pinion's face ends on the wheel flank: the wheel's normal counts, and the other way round."""
    for narrow, wide in (("pinion", "wheel"), ("wheel", "pinion")):
        mesh = cylindrical_mesh()
        mesh = replace(mesh, **{narrow: replace(getattr(mesh, narrow), face_width=20.0)})
        pair = cylindrical_pair(mesh, mounting=Mounting(out_of_plane=0.01))
        contact = trace_contact(pair, [0.0])[0]
        ends = contact.edges[:4] if narrow == "pinion" else contact.edges[4:]
        assert ends[EDGE_NAMES.index("upper side")]
        axis = np.array([0.0, 0.0, 1.0]) if wide == "pinion" else pair.wheel_axes[2]
        assert_allclose(contact.normal @ axis, 0.0, atol=1e-12)  # a spur flank's normal has no part along its axis
        assert abs(contact.normal @ (pair.wheel_axes[2] if wide == "pinion" else [0.0, 0.0, 1.0])) > 1e-3


@pytest.mark.parametrize(("turn", "edge", "gear"), [(0.9, "tip", 0), (-0.9, "tip", 1)])
def test_contact_beyond_the_nominal_path_runs_on_a_tip_edge(turn, edge, gear):
    pair = gear_pair(FlankModifications(lead_crowning=0.002))
    path = trace_contact(pair, [turn * pair.pitch, 1.1 * turn * pair.pitch])
    assert path.on_edge.all()
    assert path.edges[:, 4 * gear + EDGE_NAMES.index(edge)].all()
    assert path.transmission_error[1] < path.transmission_error[0] < -1e-6
    tip = (path.pinion_radius, path.wheel_radius)[gear]
    assert_allclose(tip, (cylindrical_mesh().pinion, cylindrical_mesh().wheel)[gear].tip_radius, atol=1e-8)


def test_error_of_tip_corner_contact_is_that_of_the_tip_circle_alone():
    pair = gear_pair(FlankModifications(lead_crowning=0.002))
    path = trace_contact(pair, np.array([0.9, 1.0]) * pair.pitch)
    tip = cylindrical_mesh().pinion.tip_radius
    lag, _ = transmission_error_at(pair, path.pinion_angle, np.full(2, tip), np.zeros(2))
    assert_allclose(path.transmission_error, lag, atol=SAME_ANGLE)


def test_contact_on_a_root_form_circle_is_called_a_fillet_interference():
    """The rack is so short that the tip of the wheel reaches below the involute of the pinion."""
    mesh = cylindrical_mesh(teeth=(18, 60), dedendum_coefficient=1.0)
    assert mesh.pinion_active_profile.fillet_interference
    pair = cylindrical_pair(mesh)
    with pytest.warns(
        AccuracyWarning, match="fillet interference: at 1 of 1 positions .* on a root form circle, where"
    ):
        path = trace_contact(pair, [-0.8 * pair.pitch])
    assert path.on_edge.all()
    assert np.flatnonzero(path.edges[0]).tolist() == [EDGE_NAMES.index("root")]


# Rows that cannot touch, and refusals


def test_positions_without_a_common_region_are_not_a_number():
    pair = sam_paper()
    path = trace_contact(pair, [0.0, 1.5, -1.5])
    assert path.in_contact.tolist() == [True, False, False]
    for name in ("transmission_error", "wheel_angle", "pinion_radius", "wheel_axial", "residual", "wheel_lever"):
        assert np.isnan(getattr(path, name)[1:]).all(), name
        assert np.isfinite(getattr(path, name)[0]), name
    assert np.isnan(path.point[1:]).all()
    assert not path.on_edge[1:].any()
    assert np.isfinite(path.pinion_angle).all()
    assert repr(path) == "ContactPath(3 positions, 1 touch, 0 on an edge)"


def test_pair_that_never_touches_is_refused():
    pair = gear_pair(mounting=Mounting(axial_offset=30.0))
    with pytest.raises(GeometryError, match="no common flank: at none of the 21 pinion angles"):
        trace_contact(pair)
    with pytest.raises(GeometryError, match="no common flank"):
        trace_contact(gear_pair(mounting=Mounting(centre_distance_error=8.0)), [0.0])


@pytest.mark.parametrize("angles", [[], [[0.0]], [math.nan], [0.0, math.inf], 0.0])
def test_angles_that_are_no_finite_row_are_refused(angles):
    with pytest.raises(InputError, match=r"pinion_angles: found shape .*; allowed finite numbers in one dimension"):
        trace_contact(sam_paper(), angles)


@pytest.mark.parametrize("angles", ["x", [None, "a"]])
def test_angles_that_are_no_numbers_are_refused(angles):
    with pytest.raises(InputError, match="pinion_angles: an array of finite numbers is asked for"):
        trace_contact(sam_paper(), angles)


@pytest.mark.parametrize(
    "part", [slice(1, None), [1, 2], np.array([2, 0]), np.array([True, False, True]), [False] * 3, [True] * 3, []]
)
def test_part_of_a_path_is_a_path(part):
    path = trace_contact(sam_paper(), [0.0, 0.01, 0.02])
    found = path[part]
    assert isinstance(found, ContactPath)
    for entry in fields(ContactPath):
        assert_array_equal(getattr(found, entry.name), getattr(path, entry.name)[np.arange(3)[part]])  # exact: copied
    assert f"ContactPath({len(found)} positions" in repr(found)


@pytest.mark.parametrize("position", [1, -2, np.int64(1), np.array(1)])
def test_number_of_a_position_gives_its_contact(position):
    path = trace_contact(sam_paper(), [0.0, 0.01, 0.02])
    assert isinstance(path[position], ContactPoint)
    assert path[position].pinion_angle == 0.01
    assert [contact.pinion_angle for contact in path] == [0.0, 0.01, 0.02]


@pytest.mark.parametrize(
    ("position", "error"),
    [
        (3, IndexError),
        (1.5, IndexError),
        ("x", IndexError),
        ((0, 1), IndexError),
        ([True, False], IndexError),
        ([[0, 1]], InputError),
        (None, InputError),
        (True, InputError),
    ],
)
def test_index_that_is_no_part_of_a_path_is_refused(position, error):
    with pytest.raises(error):
        trace_contact(sam_paper(), [0.0, 0.01, 0.02])[position]


def test_one_position_has_the_fields_of_the_path_without_their_first_axis():
    path = trace_contact(sam_paper(), [0.0, 0.01])
    contact = path[1]
    assert contact.transmission_error == path.transmission_error[1]
    assert contact.point.shape == (3,)
    assert contact.line_ends.shape == (2, 3)
    assert contact.edges.shape == (8,)


def test_levers_are_continuous_where_a_contact_leaves_a_relief_start_at_a_common_face_end():
    """Both flanks end there; the normal is that of the wheel, which is smooth along the edge."""
    relief = {"tip_relief_form": "linear"}
    pair = gear_pair(
        FlankModifications(
            lead_crowning=0.0025, profile_crowning=0.0017, tip_relief=0.0228, tip_relief_start=82.7087, **relief
        ),
        FlankModifications(tip_relief=0.016, tip_relief_start=111.3107, **relief),
        teeth=(38, 52),
        module=2.0,
        width=12.96,
        helix_deg=19.248,
        shifts=(0.1242, -0.1242),
    )
    mesh = trace_teeth(pair, np.linspace(-0.19, -0.09, 25) * pair.pitch)
    path = mesh.paths[mesh.pairs.tolist().index(-1)]
    assert path.on_edge.any()
    assert path.on_relief_start[path.on_edge].any()
    assert not path.on_relief_start[path.on_edge].all()
    steps = np.abs(np.diff(path.pinion_lever))
    # the angle of the relief, 2 degrees, goes by in a dozen steps; with the pinion's normal it is a single one
    assert steps.max() < 0.15 * np.ptp(path.pinion_lever)
