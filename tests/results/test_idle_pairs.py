"""Where first order ends since a tooth pair comes under load or leaves it, beside analyses before and beyond."""

import warnings
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, read_scene
from loaded_tca import warning_kinds as kinds
from loaded_tca.errors import AccuracyWarning, noted_accuracy_warnings
from loaded_tca.results.idle_pairs import idle_pairs, warn_of_pairs
from loaded_tca.results.sensitivities import TORQUE
from loaded_tca.warning_kinds import kind_of
from tests.samples.results import FLANKS_ALONE, SCENES

CROWNING, AXIAL = "pinion.modifications.profile_crowning_um", "mounting.wheel_axial_mm"
MIDDLE = 1
"""Position at which one pair carries all, and both others nearly touch."""


SOFT = tuple(tuple((3e-6 if i < 3 else 1e-9) * (i == j) for j in range(6)) for i in range(6))
ON_SUPPORTS = {"pinion.support.compliance": SOFT}


@cache
def solved(name="mesh_cycle_helical", torque=60.0, **changes):
    usual = {"analysis.cells": (12, 16), "analysis.accuracy": None, "analysis.positions": 3}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # few cells, contacts on edges
        scene = read_scene(SCENES / f"{name}.toml").with_changes(FLANKS_ALONE | usual | changes)
        return analyse(scene.with_changes({"analysis.torques_Nm": (torque,)}))


def told(result, tolerances):
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_pairs(result.sensitivities([*tolerances]), tolerances)
    return [one for one in sentences if kind_of(one) is kinds.PAIR_COMES_OR_GOES]


@pytest.mark.parametrize(
    "at",
    [
        {"analysis.compliance": "contact"},
        pytest.param({"analysis.compliance": "contact+tooth"}, marks=pytest.mark.thorough),
        pytest.param(ON_SUPPORTS, marks=pytest.mark.thorough),
    ],
    ids=["contact", "contact+tooth", "supports"],
)
def test_pair_comes_under_load_where_it_is_told_and_carries_no_more_than_is_told(at):
    """Less crowning closes the gap of the next pair by what the parabola is there."""
    result = solved(**at)
    assert np.count_nonzero(result.load_share[0, MIDDLE]) == 1
    (sentence,) = told(result, {CROWNING: 3.0, TORQUE: 1.0})
    assert f"({CROWNING}; 1 of 2 keys)" in sentence
    change, share = float(sentence.split("change by ")[1].split()[0]), float(sentence.split("up to ")[1].split("%")[0])
    crowning = result.scene.pinion.modifications.profile_crowning_um
    before, beyond, end = (
        solved(**at, **{CROWNING: crowning + by}).load_share[0, MIDDLE] for by in (0.9 * change, 1.1 * change, -3.0)
    )
    assert np.count_nonzero(before) == 1
    assert np.count_nonzero(beyond) == 2
    # told as if the other pair gave nothing of the load up, and as of a contact that no tip cuts: 24 % for 6 %
    assert 0.2 * share < 100.0 * np.delete(end, 1).max() < share


def test_nothing_is_told_within_smaller_tolerances_and_of_changes_that_open():
    assert told(solved(), {CROWNING: 1.0, "pinion.modifications.lead_crowning_um": 3.0, TORQUE: 1.0}) == []


def test_pair_that_carries_little_leaves_within_the_tolerance():
    result = solved("straight_bevel", 5.0)
    (sentence,) = told(result, {AXIAL: 0.03})
    change = float(sentence.split("change by ")[1].split()[0])
    with noted_accuracy_warnings(given=False):  # within a usual change, too
        shares, slopes = result.load_share[0], result.sensitivities([AXIAL]).load_share[0, ..., 0]
    left = -shares[shares > 0.0] / slopes[shares > 0.0]
    assert np.abs(left / change - 1.0).min() < 0.1  # two digits are told


def test_opening_closes_with_the_torque_as_the_gears_turn_on():
    """The teeth do not bend: idle pairs come nearer by the lever times the rotation, and by nothing else."""
    low, high = (idle_pairs(solved(torque=torque).sensitivities([CROWNING])) for torque in (55.0, 60.0))
    assert (low.places == high.places).all()
    turned = solved(torque=55.0).transmission_error - solved(torque=60.0).transmission_error
    assert_allclose(low.opening - high.opening, low.lever * turned[*low.places[:2]], rtol=1e-9)
    assert (low.opening > high.opening).all()


def test_supports_move_idle_pairs_with_those_under_load():
    """The pinion goes back by 6 um at the base circle; gaps beside the loaded contact change by the tilt alone."""
    rigid, moved = solved(), solved(**ON_SUPPORTS)
    driven = moved.gear_pair.base_radii[1] * (rigid.transmission_error - moved.transmission_error)
    assert (driven > 0.006).all()
    (soft,) = moved.sensitivities([CROWNING, TORQUE]).parts
    opening, slopes = idle_pairs(soft).opening, idle_pairs(soft).slopes
    assert_allclose(opening, idle_pairs(rigid.sensitivities([CROWNING, TORQUE])).opening, rtol=0.03)  # um of 1e-5 rad
    # what the torque moves the gears by moves all pairs alike, in proportion to it: 60 N m
    assert_allclose(slopes[1] * 60.0 * moved.gear_pair.base_radii[1], -driven.mean(), rtol=0.02)
    assert len(told(moved, {CROWNING: 3.0, TORQUE: 1.0})) == 1


def test_one_pair_alone_has_no_others_that_come():
    assert told(solved(**{"analysis.load_sharing": False}), {CROWNING: 3.0}) == []
