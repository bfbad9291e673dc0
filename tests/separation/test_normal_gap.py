"""The gap along the normal and the room to the nearest edge, on places that take Newton's method far."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene, sample_separation, trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.separation import normal_gap
from loaded_tca.separation.normal_gap import ON_EDGE, STEP_ROUNDING, NormalGap
from loaded_tca.unloaded import relative_curvature
from tests.samples.gear_pairs import gear_pair, sam_paper
from tests.samples.results import SCENES
from tests.separation.test_separation import brute_force_gap

GAP = 1e-11  # mm: rounding of coordinates of 100 mm, thrown together over some operations


def gap_of(pair, turn=0.0):
    contact = trace_contact(pair, [turn * pair.pitch])[0]
    return NormalGap(pair, contact, relative_curvature(pair, contact).axes)


def test_gap_on_a_grid_is_the_gap_at_each_of_its_points():
    gap = gap_of(sam_paper(15.0), 0.1)
    x, y = np.linspace(-0.3, 0.3, 4), np.linspace(-14.0, 14.0, 7)
    one_by_one = [[gap.at(x[i : i + 1], y[j : j + 1])[0][0] for j in range(len(y))] for i in range(len(x))]
    assert_allclose(gap.at(x[:, None], y)[0], one_by_one, rtol=0, atol=GAP)


def test_room_of_a_spur_pair_along_the_face_is_the_distance_to_its_side():
    gap, y = gap_of(sam_paper()), np.array([-13.0, -12.0, 11.0, 12.4, 12.5, 12.6])
    room = gap.at(np.zeros(1), y)[1]
    assert_allclose(room, 12.5 - np.abs(y) + ON_EDGE * 3.0, rtol=0, atol=GAP)


def test_room_across_the_profile_ends_at_the_tips():
    pair = sam_paper()
    gap = gap_of(pair)
    _, room = gap.at(np.array([-6.0, 0.0, 6.0]), np.zeros(1))
    assert room[1] > 0.0
    assert (room[[0, 2]] < 0.0).all()


CASES = {
    "spiral bevel": (lambda: read_scene(SCENES / "spiral_bevel.toml").pair(), 0.0, (0.4, 4.5)),
    "misaligned": (lambda: sam_paper(mounting=Mounting(out_of_plane=0.005)), 0.1, (1.5, 9.0)),
    "down to the base circle": (lambda: gear_pair(teeth=(20, 57)), -0.6, (2.5, 14.0)),
    "linear relief": (
        lambda: gear_pair(
            FlankModifications(tip_relief=0.05, tip_relief_start=104.0, tip_relief_form="linear"), helix_deg=15.0
        ),
        0.2,
        (2.0, 14.0),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_gap_far_from_the_contact_equals_the_distance_found_by_bracketing(name):
    make, turn, box = CASES[name]
    pair = make()
    contact = trace_contact(pair, [turn * pair.pitch])[0]
    separation = sample_separation(pair, contact, cells=(8, 6), box=box)
    assert 0 < np.isfinite(separation.gap).sum() < separation.gap.size, "the box goes beyond the flank"
    expected = [[brute_force_gap(pair, contact, separation, i, j) for j in range(6)] for i in range(8)]
    assert (np.isfinite(separation.gap) == np.isfinite(expected)).all()
    assert_allclose(separation.gap, expected, rtol=0, atol=GAP)


def test_normals_that_meet_no_flank_have_no_room():
    pair = sam_paper()
    contact = trace_contact(pair, [0.0])[0]
    away = replace(contact, point=contact.point + 1000.0 * contact.normal)
    _, room = NormalGap(pair, away, relative_curvature(pair, contact).axes).at(
        np.linspace(-50.0, 50.0, 9)[:, None], np.zeros(1)
    )
    assert (room < 0.0).all()


def test_normals_miss_the_flank_of_a_pinion_below_its_base_cylinder_beside_a_rack_too():
    """Where there is room the normal ends on the flank; a rack, a million times as large, leaves that as it is."""
    changes = {"teeth": 12, "modifications.tip_relief_um": 0.0, "modifications.tip_relief_start_mm": 0.0,
               "modifications.profile_crowning_um": 4.0}  # fmt: skip
    scene = read_scene(SCENES / "rack_and_pinion.toml")
    pair = scene.with_changes({f"pinion.{key}": value for key, value in changes.items()}).pair()
    gap, x, y = gap_of(pair, -1.0), np.linspace(0.0, 0.4, 41), np.zeros(1)
    met, rho = np.isfinite(gap.at(x, y)[1]), gap.places(x, y)[0][0]
    (points, _), turn = gap.flank_points(x, y), pair.sense * trace_contact(pair, [-pair.pitch]).pinion_angle
    angle = np.arctan2(points.point[..., 1], points.point[..., 0]) - turn
    aside = points.rho * (angle - pair.pinion.flank.theta(points.rho, points.z).value)
    assert 10 < met.sum() < 20, "from the contact point on to the base cylinder"
    assert (rho[met] > pair.base_radii[0]).all()
    assert_allclose(aside[met], 0.0, rtol=0, atol=GAP)


def test_steps_end_where_the_next_one_is_rounding(monkeypatch):
    """Newton's method from the heights that were found moves nothing."""
    pair = read_scene(SCENES / "spiral_bevel.toml").pair()
    gap = gap_of(pair)
    x, y = np.linspace(-0.1, 0.1, 5)[:, None], np.linspace(-2.0, 2.0, 7)
    finer, there = gap.at(x, y)
    assert (there > 0.0).all()
    monkeypatch.setattr(normal_gap, "STEP_ROUNDING", 1e-3 * STEP_ROUNDING)
    assert_allclose(finer, gap.at(x, y)[0], rtol=0, atol=GAP)


@pytest.mark.parametrize(
    "name", ["helical", "misaligned", "measured_flank", "straight_bevel", "spiral_bevel", "face_milled_19x62_matched"]
)
def test_curvature_across_is_the_second_difference_of_the_gap(name):
    pair = read_scene(SCENES / f"{name}.toml").pair()
    contact = trace_contact(pair, [0.1 * pair.pitch])[0]
    curvature = relative_curvature(pair, contact)
    gap, step = NormalGap(pair, contact, curvature.axes), 2e-3 * pair.module
    x, y = 0.01 * pair.module * np.array([1.0, 0.0, -1.0]), 0.6 * pair.module * np.array([-1.0, 0.0, 1.0])
    before, here, after = (gap.at(x + side * step, y)[0] for side in (-1.0, 0.0, 1.0))
    found = gap.curvature_across(x, y)
    assert_allclose(found, (before - 2.0 * here + after) / step**2, rtol=1e-4)  # of the step's square
    assert_allclose(found[1], curvature.across, rtol=1e-9)


def test_curvature_across_a_relief_start_has_no_spike():
    """A linear relief adds a slope: on either side the curvature is nearly that without it."""
    start = FlankModifications(lead_crowning=0.005, tip_relief=0.03, tip_relief_start=102.0, tip_relief_form="linear")
    plain, relieved = (gap_of(gear_pair(one)) for one in (FlankModifications(lead_crowning=0.005), start))
    x = np.linspace(-0.05, 0.05, 101)
    assert_allclose(relieved.curvature_across(x, np.zeros(1)), plain.curvature_across(x, np.zeros(1)), rtol=2e-2)
