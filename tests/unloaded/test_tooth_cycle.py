"""The height of one tooth pair over its way through the mesh: slope, reach, summits."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import GeometryError, trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import trace_teeth
from loaded_tca.unloaded.tooth_cycle import (
    REACH,
    height_and_slope,
    pitches_within_reach,
    reach,
    teeth_between,
    tooth_cycle,
)
from tests.samples.gear_pairs import gear_pair

BOTH = FlankModifications(lead_crowning=0.02, profile_crowning=0.01)
RELIEF = FlankModifications(
    lead_crowning=0.02, tip_relief=0.02, tip_relief_start=108.0, tip_relief_form="linear", helix_slope=0.01
)
TILTED = Mounting(out_of_plane=1e-3)
KINDS = [
    gear_pair(BOTH, mounting=TILTED),
    gear_pair(RELIEF, mounting=TILTED, helix_deg=15.0),
    gear_pair(BOTH, mounting=TILTED, helix_deg=-30.0, width=60.0, driving="wheel"),
    gear_pair(FlankModifications(profile_crowning=0.02), mounting=TILTED, helix_deg=15.0),
]

kinds = pytest.mark.parametrize("pair", KINDS)


@kinds
def test_slope_is_that_of_the_heights(pair):
    """In surface, tip, side and relief start contact alike, although the point of contact moves."""
    own, nudge = np.linspace(*reach(pair), 60), 1e-5
    _, slope = height_and_slope(pair, own)
    before, after = (height_and_slope(pair, own + way * nudge)[0] for way in (-1.0, 1.0))
    assert_allclose(slope, (after - before) / (2.0 * nudge), atol=1e-5)  # curvature times nudge at a change of edge


@kinds
def test_slope_of_surface_contact_is_the_ratio_of_the_levers_less_that_of_the_gears(pair):
    path = trace_contact(pair, np.linspace(-0.4, 0.4, 9) * pair.pitch)
    _, slope = height_and_slope(pair, path.pinion_angle)
    levers = pair.driving * pair.base_radii[1] * (path.pinion_lever / path.wheel_lever - pair.ratio)
    free = ~path.on_edge & ~path.on_relief_start
    assert_allclose(slope[free], levers[free], atol=1e-7)


@pytest.mark.quick_cases("pair0")
@kinds
def test_every_tooth_outside_the_reach_lags_beyond_it(pair):
    low, high = reach(pair)
    phi1 = np.linspace(0.0, 1.0, 13) * pair.pitch
    teeth = np.arange(-6, 7)
    own = phi1 - teeth[:, None] * pair.pitch
    height = height_and_slope(pair, own.ravel())[0].reshape(own.shape)
    lag = height.max(axis=0) - height
    assert (lag[(own < low) | (own > high)] > REACH * pair.module).all()


def pair_span(pair, positions):
    """Pitches between tooth pairs within reach at positions of a pitch."""
    mesh = trace_teeth(pair, pair.pitch * np.linspace(-0.5, 0.5, positions))
    return max(int(np.ptp(mesh.pairs[near])) for near in np.isfinite(mesh.initial_separation).T)


@pytest.mark.parametrize("pair", [*KINDS, gear_pair(BOTH, width=10.0), gear_pair(BOTH, helix_deg=15.0)])
def test_pitches_within_reach_are_those_of_many_positions(pair):
    assert pitches_within_reach(pair) == pair_span(pair, 33)


def test_pitches_within_reach_do_not_follow_from_both_ends_of_a_pitch():
    assert pair_span(KINDS[0], 2) < pitches_within_reach(KINDS[0])


@kinds
def test_sampled_heights_are_those_of_the_teeth(pair):
    cycle, teeth, index = tooth_cycle(pair), np.array([0, 1, -1]), np.array([-16, 0, 5])
    assert_allclose(cycle.sampled(index, teeth), cycle.heights(index * cycle.step, teeth), rtol=0, atol=1e-11)


@pytest.mark.quick_cases("pair0")
@kinds
def test_summits_are_level_and_between_lower_heights(pair):
    cycle = tooth_cycle(pair)
    assert len(cycle.extrema)
    beside = [height_and_slope(pair, cycle.extrema + way * 1e-3)[0] for way in (-1.0, 0.0, 1.0)]
    assert ((beside[1] - beside[0]) * (beside[1] - beside[2]) > 0.0).all()


def test_teeth_between_two_angles_begin_with_pair_zero():
    assert teeth_between(0.0, 1.0, (-1.2, 1.2), 1.0).tolist() == [0, 1, -1, 2]
    assert teeth_between(10.0, 10.0, (-0.7, 0.7), 1.0).tolist() == [10]


def test_flanks_without_a_common_region_have_no_reach():
    with pytest.raises(GeometryError, match="no common flank"):
        reach(gear_pair(mounting=Mounting(axial_offset=30.0)))
