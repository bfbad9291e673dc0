"""Grids that move with their contacts: gaps and parts of cells against sampling both flanks anew, contact points."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene, trace_contact
from loaded_tca.results.gap_growth import moved
from loaded_tca.separation.box import Box
from loaded_tca.separation.gap_change import contact_changes
from loaded_tca.separation.pair_change import pair_changes
from loaded_tca.separation.sample import SLIVER, sample_separations
from tests.samples.results import SCENES

STEP = 2e-5
"""Of the key, either side [mm]: contacts move by up to 1 um."""
GAP = 1e-7
"""Asked for [mm/mm]."""
COVER = 1e-3
"""Asked for, of the largest change; cells that the sampling rounds to none or all of their material are left out."""
OFFSET, DISTANCE = "mounting.offset_mm", "mounting.centre_distance_error_mm"
TIP_ROUNDING = "pinion.tip_rounding_mm", "wheel.tip_rounding_mm"
CASES = {
    "tip edge of the pinion": ("helical", DISTANCE, 1.0, 0, None),
    "tip edge of the wheel": ("helical", DISTANCE, -1.0, 4, None),
    "free, its end cut off": ("helical", DISTANCE, -0.75, None, None),
    "spiral bevel": ("spiral_bevel", OFFSET, 0.1, None, None),
    "straight bevel": ("straight_bevel", "mounting.pinion_axial_mm", 0.6, None, None),
    "arc of the pinion's tip": ("spiral_bevel", "mounting.shaft_angle_error_deg", 1.1, 0, TIP_ROUNDING[0]),
    "arc of the wheel's tip": ("spiral_bevel", "mounting.wheel_axial_mm", -1.1, 4, TIP_ROUNDING[1]),
}


@cache
def case(name):
    file, key, pitches, edge, rounding = CASES[name]
    scene = read_scene(SCENES / f"{file}.toml")
    if rounding is not None:
        scene = scene.with_changes({rounding: 0.15})
    pair = scene.pair()
    contact = trace_contact(pair, [pitches * pair.pitch], warn=False)[0]
    assert edge is None or contact.edges[edge], "the contact point lies on that edge"
    (separation,) = sample_separations(pair, [contact], cells=[(24, 28)], loads=[1000.0], boxes=[None])
    active = np.isfinite(separation.cut_gap) & (separation.gap.clip(max=1.0) < 0.02)
    (change,) = pair_changes(scene, [key])
    found = contact_changes(pair, [contact], [separation], [active], [change])
    sides = [scene.with_changes({key: by}).pair() for by in (-STEP, STEP)]
    return contact, separation, active, found, sides


@pytest.mark.parametrize("name", CASES)
def test_gaps_and_parts_of_cells_change_as_between_grids_sampled_anew(name):
    contact, separation, active, found, sides = case(name)
    follows = found.followed(np.ones(np.count_nonzero(active)), [separation])
    anew = []
    for side, by in zip(sides, (-STEP, STEP), strict=True):
        there = moved(separation, by * follows.motions[0, 0])
        touching = trace_contact(side, [contact.pinion_angle], warn=False)[0]
        (one,) = sample_separations(
            side, [replace(touching, point=there.origin)], cells=[active.shape], loads=[None], boxes=[Box.of(there)]
        )
        anew.append(one)
    both = (np.isfinite(anew[0].cut_gap) & np.isfinite(anew[1].cut_gap))[active]
    low, high = (one.cut_gap[active][both] for one in anew)
    assert_allclose(follows.gaps[0][both], (high - low) / (2.0 * STEP), rtol=0, atol=GAP)
    covers = ((anew[1].cover - anew[0].cover) / (2.0 * STEP))[active]
    cut = (separation.cover > 2.0 * SLIVER) & (separation.cover < 1.0 - 2.0 * SLIVER)
    if cut[active].any():
        atol = COVER * np.abs(covers[cut[active]]).max()
        assert_allclose(follows.covers[0][cut[active]], covers[cut[active]], rtol=0, atol=atol)


@pytest.mark.parametrize("name", CASES)
def test_contact_points_and_levers_change_as_those_traced_anew_on_edges_too(name):
    contact, separation, _, found, sides = case(name)
    low, high = (trace_contact(side, [contact.pinion_angle], warn=False)[0] for side in sides)
    moved_by = (high.point - low.point) / (2.0 * STEP) @ separation.axes[:2].T
    points = found.at_points
    assert_allclose(points.shifts[0, 0], moved_by, rtol=0, atol=1e-4 * np.linalg.norm(moved_by))
    for gear, levers in zip(("pinion", "wheel"), points.levers[:, 0, 0], strict=True):
        grown = (getattr(high, f"{gear}_lever") - getattr(low, f"{gear}_lever")) / (2.0 * STEP)
        assert_allclose(levers, grown, rtol=1e-4, atol=1e-5)
    turn = (high.transmission_error - low.transmission_error) / (2.0 * STEP)
    assert_allclose(points.turns[0, 0], -turn, rtol=1e-6)


def test_grid_of_a_contact_on_the_tip_edge_of_the_wheel_moves_with_it():
    contact, separation, active, found, _ = case("tip edge of the wheel")
    follows = found.followed(np.ones(np.count_nonzero(active)), [separation])
    held, left = (np.linalg.norm(part) for part in (found.border.rates[0], follows.covers[0, found.border.cell]))
    assert contact.on_edge
    assert left < 0.5 * held, "the edge stays where it is in the grid, but for its ends, where others cut it off"


def test_grid_of_a_contact_on_a_tip_edge_goes_along_it_with_the_crown():
    """The gap along the edge is a parabola: its least place is the contact point, to 0.3 with an end that is cut."""
    contact, separation, active, *_ = case("tip edge of the pinion")
    scene = read_scene(SCENES / "helical.toml")
    changes = pair_changes(scene, ["mounting.misalignment_um"])
    found = contact_changes(scene.pair(), [contact], [separation], [active], changes)
    follows = found.followed(np.ones(np.count_nonzero(active)), [separation]).motions[0, 0, :2]
    point = found.at_points.shifts[0, 0]
    assert_allclose(follows, point, rtol=0, atol=0.3 * np.linalg.norm(point))
