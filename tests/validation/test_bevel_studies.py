"""The studies of bevel pairs: starts on the flanks, laws of small errors, statements of the source, pictures."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import trace_contact
from loaded_tca.pairs.bevel import BevelMounting
from validation.bevel.convergence import cases
from validation.bevel.effects import effect, first_order_error, spiral_curve, spiral_effect, spiral_mounting
from validation.bevel.mounting_errors import rows as error_rows
from validation.bevel.mounting_errors import signs_together
from validation.bevel.pairs import SPIRAL, STRAIGHT, TABLE_6, spiral_modifications, straight_modifications
from validation.bevel.pictures import draw_error_map
from validation.bevel.spiral_trends import closest_fit, error_map, sign_table
from validation.bevel.straight_trends import straight_effect, trends_of_strong_crowning
from validation.unloaded.convergence_from_random_starts import cases as cylindrical_cases
from validation.unloaded.mounting_error_pairs import ARCSEC
from validation.unloaded.random_starts import COMPONENTS, SPREADS, conventional, points_of, reduced

MOST_STEPS = 7.0  # on average, of the reduced solver
SAGITTA = 0.05  # mm; of the chords between the corners of a conical flank
NOT_STEEPER = 1e-3  # of the first-order law: the second order of errors of 1e-3 mm


@pytest.fixture(scope="module")
def bevel_cases():
    return cases(300)


@pytest.fixture(scope="module")
def small_map():
    return error_map(3, 5)


# Convergence


def test_reduced_solver_reaches_the_contact_from_every_start_in_few_steps(bevel_cases):
    for case in bevel_cases:
        outcome = reduced(case)
        assert outcome.percentage == 100.0
        assert outcome.steps <= MOST_STEPS


@pytest.mark.thorough
def test_conventional_share_falls_with_the_spread_of_the_wheel_angle_whatever_the_normals(bevel_cases):
    for case in bevel_cases:
        for components in COMPONENTS:
            near, wide = (conventional(case, spread, components).percentage for spread in SPREADS)
            assert 0.0 < wide < 0.6 * near


def test_weaker_crowning_costs_steps(bevel_cases):
    strong, weak = (reduced(case).steps for case in bevel_cases[1:])
    assert weak > strong


def test_random_starts_lie_on_both_flanks(bevel_cases):
    for case in (*bevel_cases, *cylindrical_cases(300)[::3]):
        pinion_radius, pinion_axial, wheel_radius, wheel_axial, angle = case.unit_starts.T
        assert case.pair.pinion.flank.inside(pinion_radius, pinion_axial, SAGITTA).all()
        assert case.pair.wheel.flank.inside(wheel_radius, wheel_axial, SAGITTA).all()
        assert np.abs(angle).max() <= 1.0


def test_starts_reach_the_corners_of_the_flank():
    flank = SPIRAL.pair().pinion.flank
    rho, z = flank.grid(2, 2)
    found = points_of(flank, np.array([0.0, 0.0, 1.0, 1.0]), np.array([0.0, 1.0, 0.0, 1.0]))
    assert_allclose(found, [rho.ravel(), z.ravel()])


# Frame and modifications of the study


@pytest.mark.parametrize("gears", [STRAIGHT, SPIRAL])
def test_pitch_point_is_the_origin_of_the_frame(gears):
    gear = gears.mesh.pinion
    pitch, distance = gear.pitch_angle, gear.mean_cone_distance
    points = np.outer([math.sin(pitch), math.cos(pitch)], [1.1 * distance, distance])
    assert_allclose(gears.place(*points), [[0.1 * distance, 0.0], [0.0, 0.0]], atol=1e-12)  # mm; of 100 mm


def test_relief_of_the_spiral_pair_removes_at_its_ends_what_the_source_says():
    pinion, pitch = SPIRAL.pair(pinion=spiral_modifications(0.0, 0.08)).pinion.flank, SPIRAL.mesh.pinion.pitch_angle
    angle, distance = np.array([*SPIRAL.mesh.active_cones[0], pitch]), SPIRAL.mesh.pinion.mean_cone_distance
    removed = pinion.removal(distance * np.sin(angle), distance * np.cos(angle)).value
    assert_allclose(removed, 0.08 * ((angle - pitch) / 0.16) ** 2, atol=1e-12)  # mm; of amounts of 0.1, beside rtol


# Mounting errors


@pytest.mark.parametrize("name", ["offset", "pinion_axial", "wheel_axial", "shaft_angle_error"])
@pytest.mark.parametrize(
    ("gears", "pinion"), [(STRAIGHT, straight_modifications(10.0)), (SPIRAL, spiral_modifications(0.02))]
)
def test_lag_of_a_small_error_is_the_gap_along_the_normal_at_the_pitch_point(gears, pinion, name):
    mounting = BevelMounting(**{name: 1e-5})
    found = trace_contact(gears.pair(mounting, pinion), [0.0]).transmission_error[0]
    assert_allclose(found, first_order_error(gears, mounting), rtol=NOT_STEEPER)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["offset", "pinion_axial", "wheel_axial", "shaft_angle_error"])
def test_error_placed_with_the_wrong_sign_fails_its_rows(monkeypatch, name):
    place = BevelMounting.place

    def wrong(mounting, shaft_angle):
        return place(replace(mounting, **{name: -getattr(mounting, name)}), shaft_angle)

    monkeypatch.setattr(BevelMounting, "place", wrong)
    failed = [row.quantity for row in error_rows() if not row.holds]
    assert [name in quantity for quantity in failed] == [True, True]  # of the straight and of the spiral pair


@pytest.mark.thorough
def test_shaft_angle_leaves_the_motion_of_the_spiral_pair_even():
    one = spiral_effect(0.002, 0.0, gamma_deg=0.2)
    assert one.peak_to_peak < 1e-8
    expected = first_order_error(SPIRAL, spiral_mounting(gamma_deg=0.2)) * ARCSEC
    assert_allclose(one.mean, expected, rtol=0.01)  # the second order of 0.2 deg
    assert one.pressure.max() / one.pressure.min() < 1.1


@pytest.mark.thorough
def test_tip_relief_on_both_gears_carries_the_straight_pair_over_the_step_of_an_axial_error():
    bare = straight_effect("ΔG", 10.0)
    relieved = straight_effect("ΔG", 10.0, relieved="both")
    assert not bare.continuous
    assert bare.on_edge.any()
    assert relieved.continuous
    assert not relieved.on_edge.any()
    assert relieved.peak_to_peak < bare.peak_to_peak


@pytest.mark.thorough
def test_weak_crowning_lets_the_offset_take_the_contact_to_the_heel():
    pair = STRAIGHT.pair(TABLE_6["ΔE"], straight_modifications(2.0))
    one = effect(STRAIGHT, pair)
    assert one.on_side.all()
    assert np.isnan(one.pressure).all()
    assert_allclose(one.lengthwise, 7.0, atol=0.02)  # the heel of the wheel, moved by the offset, ends first in part


@pytest.mark.thorough
def test_more_lead_crowning_brings_the_path_back_and_raises_the_pressure():
    weak, strong = (spiral_effect(c1, 0.08, e=0.08, h=0.08) for c1 in (0.005, 0.02))
    assert abs(strong.place[0]) < 0.5 * abs(weak.place[0])
    assert 1.15 < strong.largest_pressure / weak.largest_pressure < 1.45  # printed: 1.2 to 1.4


@pytest.mark.thorough
def test_curve_of_one_tooth_pair_falls_more_than_that_of_the_gears():
    one = spiral_curve(0.02, 0.08, e=0.04)
    assert max(one.before, one.after) == one.fall
    assert min(one.before, one.after) > spiral_effect(0.02, 0.08, e=0.04).peak_to_peak


# Two errors together


@pytest.mark.thorough
def test_map_is_one_where_the_pair_is_aligned(small_map):
    assert small_map.ratio[1, 1] == 1.0
    assert small_map.deviation[1, 1] == 0.0


@pytest.mark.thorough
def test_offset_moves_the_path_farther_than_the_axial_error(small_map):
    offset, axial = np.abs(small_map.deviation[[0, 2], 1]), np.abs(small_map.deviation[1, [0, 2]])
    assert offset.min() > 2.0 * axial.max()


@pytest.mark.thorough
def test_picture_of_the_map_names_its_units(small_map):
    labels = [label for axes in draw_error_map(small_map).axes for label in (axes.get_xlabel(), axes.get_ylabel())]
    assert "ΔE [mm]" in labels
    assert "ΔH [mm]" in labels
    assert "shift of the path, toe to heel [mm]" in labels


# Statements of the source


@pytest.mark.thorough
def test_pressure_rises_by_less_than_printed_with_ten_times_the_lead_crowning():
    nearer, higher, size = trends_of_strong_crowning()
    assert nearer.holds
    assert higher.holds
    assert not size.holds  # printed: nearly 80 %
    assert size.because.startswith("+63%")


@pytest.mark.thorough
def test_one_load_presses_least_where_the_profiles_fit_best():
    for error in ({"e": 0.08}, {"h": 0.08}):
        height, across, pressure = closest_fit(error)
        assert height[0] < -0.3 < abs(height[1]) < 0.1 < 0.3 < height[2]  # root, next to the pitch cone, tip
        assert pressure[1] < min(pressure[[0, 2]])
        # a line contact's law, nearly: the ellipse is long, its curvature along changes little
        assert_allclose(pressure / pressure[1], np.sqrt(across / across[1]), rtol=0.1)


@pytest.mark.thorough
def test_statements_on_the_spiral_pair_do_not_hold_with_one_set_of_signs(small_map):
    table = sign_table(small_map)
    offset, pinion_root, wheel_root, amplitude, worst = (
        {signs for signs, holds in part.items() if holds} for part in table.values()
    )
    assert offset == {(-1.0, 1.0), (-1.0, -1.0)}
    assert pinion_root == {(1.0, 1.0), (-1.0, 1.0)}
    assert wheel_root == {(1.0, -1.0), (-1.0, -1.0)}
    assert worst == {(-1.0, -1.0)}
    assert not offset & pinion_root & worst
    assert not worst & amplitude
    parts = signs_together(small_map)
    assert [parts[key] for key in ("on_pinion", "on_wheel", "with_amplitude")] == ["none", "(-, -)", "none"]
