"""The maximum of the ease-off: certified against dense grids, on edges and relief starts, crowning 1 pm to 1 mm."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca import trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.unloaded import search
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import climb
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair, highest_on_grid, pairs, transmission_error_at

ROUNDING = 1e-14  # rad, angles of order 0.1
STATIONARY = 1e-9  # residual at which rounding ends a Newton iteration on a ridge of ratio 1e6


def lead_over_grid(pair, path, row):
    """How far the point found lies ahead of every point of a dense grid [rad]; negative if it lies behind."""
    best = highest_on_grid(pair, path.pinion_angle[row])
    return pair.driving * (path.transmission_error[row] - best)


@pytest.mark.thorough
@given(pairs(), st.floats(-0.5, 0.5))
@settings(max_examples=60)
def test_no_point_of_both_flanks_touches_before_the_contact_point(pair, turn):
    path = trace_contact(pair, np.array([turn, turn - 0.2]) * pair.pitch, warn=False)
    for row in range(2):
        assert lead_over_grid(pair, path, row) >= -ROUNDING
        if not path.on_relief_start[row]:
            assert path.residual[row] < STATIONARY


@pytest.mark.thorough
@given(pairs(), st.floats(-0.5, 0.5))
@settings(max_examples=20)
def test_contact_point_lies_on_both_flanks(pair, turn):
    path = trace_contact(pair, [turn * pair.pitch], warn=False)
    rho, z = path.pinion_radius, path.pinion_axial
    theta = pair.pinion.flank.theta(rho, z).value + pair.sense * path.pinion_angle
    assert_allclose(path.point[0], [*(rho * np.cos(theta)), *(rho * np.sin(theta)), *z], atol=1e-10)  # mm
    lag, _ = transmission_error_at(pair, path.pinion_angle, rho, z)
    assert_allclose(path.transmission_error, lag, atol=ROUNDING)
    assert pair.pinion.flank.inside(rho, z, tolerance=1e-7).all()
    assert pair.wheel.flank.inside(path.wheel_radius, path.wheel_axial, tolerance=1e-7).all()


@pytest.mark.quick_cases(every=9)
@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
@pytest.mark.parametrize("crowning", [1e-9, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2, 1.0])
@pytest.mark.parametrize("tilt", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
def test_contact_is_found_from_a_picometre_to_a_millimetre_of_crowning(helix_deg, crowning, tilt):
    pair = gear_pair(
        FlankModifications(lead_crowning=crowning), mounting=Mounting(out_of_plane=tilt), helix_deg=helix_deg
    )
    path = trace_contact(pair, [-0.06, 0.0, 0.045])
    assert path.in_contact.all()
    assert min(lead_over_grid(pair, path, row) for row in range(3)) >= -ROUNDING
    assert path.residual.max() < 2e-9  # the tilt itself where it is too small to be called an edge contact


@pytest.mark.quick_cases(every=5)
@pytest.mark.parametrize("tilt", [0.0, 1e-13, 1e-10, 1e-7, 1e-4, 1e-2])
@pytest.mark.parametrize("width", [10.0, 40.0])
def test_contact_of_an_unmodified_helical_pair_is_found_however_small_its_misalignment(tilt, width):
    """A ridge as flat as rounding, and bent: what a straight step along it cannot follow."""
    pair = gear_pair(mounting=Mounting(out_of_plane=tilt), helix_deg=25.0, width=width)
    path = trace_contact(pair, np.linspace(-0.4, 0.4, 3) * pair.pitch)
    assert min(lead_over_grid(pair, path, row) for row in range(3)) >= -ROUNDING


def test_contact_at_the_end_of_a_face_with_a_helix_slope_is_found_on_a_ridge_without_curvature():
    """The ease-off rises evenly to the side of the face: no curvature tells a Newton step its length."""
    mesh = CylindricalMesh(
        CylindricalGear(47, 3.0, 28.36, profile_shift=0.1), CylindricalGear(78, 3.0, 28.36, profile_shift=0.2)
    )
    sloped = FlankModifications(helix_slope=-0.0177, root_relief=0.039, root_relief_start=235.5)
    pair = cylindrical_pair(
        mesh,
        modifications=(FlankModifications(profile_crowning=8e-5), sloped),
        mounting=Mounting(centre_distance_error=-0.4),
    )
    path = trace_contact(pair, np.linspace(-0.5, 0.5, 41) * pair.pitch)
    assert path.on_edge.all()
    assert min(lead_over_grid(pair, path, row) for row in range(41)) >= -ROUNDING


def test_higher_of_two_hills_is_found_with_hollow_crowning():
    """Material added at both ends of the face and a slight tilt: a hill at either end, one a little higher."""
    hollow = FlankModifications(lead_crowning=-0.01)
    for tilt, end in ((1e-5, 12.5), (-1e-5, -12.5)):
        path = trace_contact(gear_pair(hollow, mounting=Mounting(out_of_plane=tilt)))
        assert_allclose(path.pinion_axial, end, atol=0.05)
        assert path.on_edge.all()


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=10)
def test_every_random_start_climbs_to_the_same_maximum(seed):
    rng = np.random.default_rng(seed)
    pair = gear_pair(FlankModifications(lead_crowning=0.01, profile_crowning=0.01), helix_deg=15.0)
    rho, z = pair.pinion.flank.grid(2, 2)
    starts = [rng.uniform(part.min(), part.max(), 300) for part in (rho, z)]
    found = climb(EaseOff(pair), np.full(300, 0.02), *starts)
    assert found.converged.all()
    assert_allclose(found.value, found.value.max(), rtol=0, atol=1e-12)  # mm; coordinates of 100 mm: 1e-14 seen
    assert found.iterations.mean() < 12


def test_ascent_of_which_hardly_a_step_is_accepted_rises_along_its_slope_instead():
    """Conjugate flanks, from a corner near the base cone: steps halved 26 times over did not end in 300 iterations."""
    pinion, wheel = (
        CylindricalGear(teeth, 3.0, 25.0, helix_angle=hand * math.radians(15.0), profile_shift=shift)
        for teeth, hand, shift in ((23, 1, 0.3), (61, -1, -0.2))
    )
    pair = cylindrical_pair(CylindricalMesh(pinion, wheel))
    found = climb(EaseOff(pair), np.array([-0.45 * pair.pitch]), np.array([35.5545]), np.array([12.5]))
    assert found.converged.all()
    assert_allclose(found.value, 0.0, atol=1e-12)  # mm; coordinates of 100 mm
    assert found.iterations.max() < 40  # 13 seen


def test_ascent_outside_both_flanks_without_any_step_left_ends():
    """Three pitches before the pitch point nothing is in common: 300 steps of no length, most of the time of a scan."""
    pinion, wheel = (
        CylindricalGear(teeth, 1.75, 30.0, helix_angle=hand * math.radians(27.0), profile_shift=shift)
        for teeth, hand, shift in ((23, -1, 0.25), (71, 1, -0.17))
    )
    pair = cylindrical_pair(CylindricalMesh(pinion, wheel, centre_distance=92.5))
    found = climb(EaseOff(pair), np.array([-3.0 * pair.pitch]), np.array([24.7743]), np.array([-14.0]))
    assert not found.converged.any()
    assert found.iterations.max() < 10  # 2 seen


# Relief starts


def linear_relief(amount=0.2, start=106.0):
    return FlankModifications(lead_crowning=0.002, tip_relief=amount, tip_relief_start=start, tip_relief_form="linear")


def test_contact_rests_on_the_start_of_a_linear_relief():
    pair = gear_pair(linear_relief())
    path = trace_contact(pair, np.linspace(0.3, 0.9, 61) * pair.pitch)
    assert path.on_relief_start.sum() > 5
    assert not (path.on_relief_start & path.on_edge).any()
    assert_allclose(path.pinion_radius[path.on_relief_start], 53.0, atol=1e-8)
    assert_allclose(path.pinion_axial[path.on_relief_start], 0.0, atol=1e-6)
    for row in range(len(path)):
        assert lead_over_grid(pair, path, row) >= -ROUNDING


def test_error_is_continuous_where_the_contact_reaches_and_leaves_a_relief_start():
    pair = gear_pair(linear_relief(), helix_deg=10.0)
    angles = np.linspace(0.2, 1.0, 401) * pair.pitch
    path = trace_contact(pair, angles)
    assert path.on_relief_start.any()
    assert np.ptp(np.flatnonzero(path.on_relief_start)) + 1 == path.on_relief_start.sum(), "one stretch"
    step = angles[1] - angles[0]
    slopes = np.diff(path.transmission_error) / step
    # the relief of 0.2 mm over 1 mm of radius, 2.4 mm of roll length: a slope of 0.083 at most
    assert np.abs(slopes).max() < 0.083
    assert np.abs(np.diff(slopes)).max() < 5e-3, "and its slope has no jump: the contact rests meanwhile"


@pytest.mark.parametrize("driving", ["pinion", "wheel"])
def test_contact_on_a_relief_start_is_the_maximum_of_a_grid_that_holds_the_relief_start(driving):
    pair = gear_pair(wheel=linear_relief(start=175.0), driving=driving)
    path = trace_contact(pair, -pair.driving * np.linspace(0.4, 0.8, 41) * pair.pitch)
    rows = np.flatnonzero(path.on_relief_start)
    assert rows.size > 2
    assert_allclose(path.wheel_radius[rows], 87.5, atol=1e-8)
    rho, z = pair.pinion.flank.grid(4001, 3)
    for row in rows:
        lag, there = transmission_error_at(pair, path.pinion_angle[row], rho, z)
        best = np.where(there, pair.driving * lag, -np.inf).max()
        # a grid of 1.7 um misses the top of slopes of up to 0.2 by 3e-4 mm over r_b2 at most, a ridge of them by less
        assert 0.0 <= pair.driving * path.transmission_error[row] - best + ROUNDING < 4e-6


@pytest.mark.thorough
def test_contact_is_found_across_relief_starts_in_whatever_order_they_lie():
    """Linear tip and root relief that overlap, and the mating gear's: the way up may cross the later start first."""
    mesh = cylindrical_mesh((19, 58), width=8.87, shifts=(0.3, 0.3))
    active = mesh.pinion_active_profile
    low, high = 2.0 * active.start_radius, 2.0 * active.end_radius
    middle = 0.5 * (low + high)
    both = FlankModifications(
        lead_crowning=1e-5,
        tip_relief=0.002,
        tip_relief_start=middle - 0.02,
        tip_relief_form="linear",
        root_relief=0.025,
        root_relief_start=middle + 0.02,
        root_relief_form="linear",
        end_relief=0.025,
        end_relief_length=4.0,
    )
    wheel = mesh.wheel_active_profile
    start = wheel.start_radius + wheel.end_radius
    mating = FlankModifications(lead_crowning=0.015, tip_relief=0.024, tip_relief_start=start, tip_relief_form="linear")
    for driving in ("pinion", "wheel"):
        for sense in ("positive", "negative"):
            pair = cylindrical_pair(mesh, modifications=(both, mating), driving=driving, sense=sense)
            path = trace_contact(pair, np.linspace(-1.2, 1.2, 25) * pair.pitch)
            for row in np.flatnonzero(path.in_contact):
                assert lead_over_grid(pair, path, row) >= -ROUNDING


def test_crossings_go_on_from_piece_to_piece_but_never_straight_back():
    multipliers = np.array([[0.0, 0.3], [0.2, 0.1], [0.0, 0.0], [0.5, 0.0]])
    row, relief_start = search._crossings(multipliers, np.array([-1, -1, -1, 0]))
    assert list(zip(row.tolist(), relief_start.tolist(), strict=True)) == [(0, 1), (1, 0), (1, 1)]


def test_radius_of_contact_never_leaves_the_flanks_of_a_pair_turned_far():
    pair = gear_pair(FlankModifications(lead_crowning=0.01), mounting=Mounting(math.radians(1.0), math.radians(-1.0)))
    path = trace_contact(pair, np.linspace(-1.3, 1.3, 53) * pair.pitch)
    inside = path.in_contact
    assert pair.pinion.flank.inside(path.pinion_radius[inside], path.pinion_axial[inside], tolerance=1e-7).all()
    assert pair.wheel.flank.inside(path.wheel_radius[inside], path.wheel_axial[inside], tolerance=1e-7).all()


def test_raised_side_of_a_narrow_wheel_is_found_between_the_points_of_the_scan():
    """A wheel that stands out by 10 um within 0.5 mm of its sides (negative end relief), inside the pinion's face."""
    raised = FlankModifications(end_relief=-0.01, end_relief_length=0.5)
    pinion, wheel = (CylindricalGear(z, 3.0, b) for z, b in ((34, 25.0), (57, 20.0)))
    crowned = FlankModifications(lead_crowning=0.001)
    pair = cylindrical_pair(CylindricalMesh(pinion, wheel), modifications=(crowned, raised))
    path = trace_contact(pair, [0.0])
    assert path.on_edge.all()
    assert_allclose(abs(path.pinion_axial[0]), 10.0, atol=1e-9)
    # 10 um less the crowning of the pinion at z = 10 mm
    assert_allclose(path.transmission_error[0] * pair.base_radii[1], 0.01 - 0.001 * (20.0 / 25.0) ** 2, rtol=1e-6)


def with_faces(widths, helix_deg, modifications):
    """Spur or helical pair 34/57, module 3 mm, with a face width of its own for each gear."""
    gears = [
        CylindricalGear(z, 3.0, width, helix_angle=math.radians(beta))
        for z, width, beta in zip((34, 57), widths, (helix_deg, -helix_deg), strict=True)
    ]
    return cylindrical_pair(CylindricalMesh(*gears), modifications=modifications)


def hidden_basins():
    """Pairs whose highest point lies on a side of the wheel, between the points of a grid over the pinion."""
    hollow = FlankModifications(lead_crowning=-0.5, profile_crowning=0.01)
    yield pytest.param(with_faces((50.0, 2.0), 0.0, (hollow, FlankModifications())), 0.0, id="saddle, narrow wheel")
    raised = FlankModifications(lead_crowning=0.004, end_relief=-0.005, end_relief_length=3.0)
    for helix in (10.0, 20.0, 30.0):
        for width in (24.0, 24.999):
            pair = with_faces((25.0, width), helix, (FlankModifications(), raised))
            yield pytest.param(pair, 0.1, id=f"raised end, {helix:g} deg, {width:g} mm")


@pytest.mark.parametrize(("pair", "share"), list(hidden_basins()))
def test_basin_on_a_edge_of_the_wheel_is_found(pair, share):
    path = trace_contact(pair, [share * pair.pitch], warn=False)
    assert path.on_edge.all()
    assert lead_over_grid(pair, path, 0) >= -ROUNDING


@pytest.mark.thorough
def test_long_bent_ridge_is_climbed_to_its_end(monkeypatch):
    """Unmodified, turned by a microradian, wider than is allowed: a ridge that is level to 1e-4 mm and winds."""
    monkeypatch.setattr("loaded_tca.pairs.cylindrical.LARGEST_TURN", math.inf)
    gears = [
        CylindricalGear(z, 2.298922117910948, 185.8487990044376, helix_angle=s * 0.6548669727032047, profile_shift=x)
        for z, s, x in ((14, -1.0, -0.44666563633052614), (62, 1.0, 0.030512516822514324))
    ]
    mounting = Mounting(1.0475209411321293e-06, -4.0585536516680183e-07, 0.00042831598104167625, 0.0)
    pair = cylindrical_pair(CylindricalMesh(*gears), mounting=mounting, driving="wheel")
    path = trace_contact(pair, np.linspace(-0.5, 0.5, 15), warn=False)
    assert path.in_contact.all()
    assert min(lead_over_grid(pair, path, row) for row in range(15)) >= -ROUNDING


def test_no_positions_give_no_contacts():
    assert len(search.first_touch(gear_pair(), np.zeros(0)).value) == 0


def test_whole_turns_of_gears_of_equal_teeth_change_nothing():
    pair = gear_pair(teeth=(30, 30))
    here, turned = trace_contact(pair, [0.02, 0.02 + 2.0 * math.pi]).transmission_error
    assert_allclose(turned, here, atol=ROUNDING)
