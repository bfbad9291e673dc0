"""Derivatives of safeties: the chain rule beside closed forms, beside ratings over the torque, and beside analyses."""

import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import AccuracyWarning
from tests.samples.rating import RATED, solved
from tests.samples.root_stress import analysed, coarsely, result, scene

CROWNING, RELIEF = "pinion.modifications.lead_crowning_um", "pinion.modifications.tip_relief_um"
PROFILE, TORQUE = "pinion.modifications.profile_crowning_um", "load.pinion_torque_Nm"
METHOD_B = {
    "rating.dynamic_factor": "method B",
    "rating.transverse_load_factor": "method B",
    "rating.tolerance_class": 6,
}
SAFETIES = "flank_safety", "root_safety", "local_flank_safety", "local_root_safety"
SMALL = {"analysis.root_stress": False}  # linear problems of roots take most of the time


@cache
def slopes():
    """Of the spur pair by method B with K_Hbeta of the analysis, and of the same with K_Hbeta given."""
    keys = [CROWNING, RELIEF, TORQUE]
    rated = [solved(**METHOD_B, **SMALL, **changes).rating() for changes in ({}, {"rating.face_load_factor": 1.2})]
    return [(one, one.sensitivities(keys)) for one in rated]


def test_safeties_of_the_standard_follow_the_face_load_factor():
    rated, found = slopes()[0]
    factor = rated.result.sensitivities([CROWNING]).face_load_factor[..., 0] / rated.K_Hbeta[:, None].T[0]
    flank = found.flank_safety.sel(key=CROWNING).values / rated.flank_safety
    # K_Halpha of a spur pair falls by less as K_Hbeta rises: the bound 1/Z_eps^2 and the deviations over the load
    assert (np.sign(flank) == -np.sign(factor)[:, None]).all()
    assert (np.abs(flank) <= 0.5 * np.abs(factor)[:, None] * (1.0 + 1e-6)).all()
    assert (np.abs(flank) >= 0.3 * np.abs(factor)[:, None]).all()


def test_closed_forms_follow_relief_and_torque_as_their_differences():
    """K_Hbeta is given: what is left of the standard are closed forms of the scene and the torque."""
    rated, found = slopes()[1]
    whole, step = rated.result, 1e-3
    value = whole.scene.pinion.modifications.tip_relief_um
    sides = [replace(whole, scene=whole.scene.with_changes({RELIEF: value + by})).rating() for by in (-step, step)]
    for name in SAFETIES[:2]:
        expected = (sides[1].values(name) - sides[0].values(name)) / (2.0 * step)
        # differences over 1e-3 um of numbers of rounding 1e-16: nine digits, less what the parabola of B_k takes
        assert_allclose(found[name].sel(key=RELIEF), expected, rtol=1e-5)
    torques = whole.dataset["torque"]
    moved = [replace(whole, dataset=whole.dataset.assign_coords(torque=torques + by)).rating() for by in (-10.0, 10.0)]
    for name in SAFETIES[:2]:
        expected = (moved[1].values(name) - moved[0].values(name)) / 0.02  # N m
        assert_allclose(found[name].sel(key=TORQUE), expected, rtol=1e-5)


def test_local_safeties_fall_with_the_torque_as_the_pressure():
    rated, found = slopes()[1]
    pressure = rated.local_flank_stress / np.sqrt(rated.K_v)
    exponent = np.log(pressure[1] / pressure[0]) / np.log(2.0)  # of a power law between 100 and 200 N m
    relative = (
        -found.local_flank_safety.sel(key=TORQUE).values * (1e-3 * rated.torque[:, None]) / rated.local_flank_safety
    )
    relative -= 0.5 * np.log(rated.K_v[1] / rated.K_v[0]) / np.log(2.0)  # K_v falls likewise
    assert_allclose(relative.mean(axis=0), exponent, rtol=0.1)  # exponents of 100 and 200 N m differ by as much


def test_results_without_root_stress_have_no_slopes_of_roots():
    assert {*slopes()[0][1].data_vars} == {*SAFETIES[:3]}


@pytest.mark.thorough
def test_safeties_follow_the_torque_as_ratings_do():
    cycle = result(**{"analysis.torques_Nm": tuple(np.linspace(120.0, 160.0, 9))})
    rated = replace(cycle, scene=cycle.scene.with_changes(RATED).with_changes(METHOD_B)).rating()
    with coarsely():
        found = rated.sensitivities([TORQUE])
    for name in SAFETIES:
        values = rated.values(name)
        # steps of 5 N m, grids made anew, places of roots that are discrete; from 145 N m on another position decides
        expected = (values[3] - values[1]) / 10.0
        assert_allclose(found[name].values[2, :, 0], expected, rtol=0.03)


@pytest.mark.thorough
@pytest.mark.parametrize(("key", "middle", "step"), [(CROWNING, 12.0, 0.5), (PROFILE, 8.0, 0.2)])
def test_safeties_follow_modifications_as_analyses_do(key, middle, step):
    changes = {"analysis.cells": (32, 48), CROWNING: 12.0, PROFILE: 8.0, "analysis.torques_Nm": (150.0, 350.0)}
    rated = []
    for by in (-step, 0.0, step):
        cycle = analysed(scene("mesh_cycle_helical", **changes | {key: middle + by}))
        rated.append(replace(cycle, scene=cycle.scene.with_changes(RATED)).rating())
    with coarsely(), warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # another strip of the face carries nearly as much
        found = rated[1].sensitivities([key])
    for name in SAFETIES:
        expected = (rated[2].values(name) - rated[0].values(name)) / (2.0 * step)
        # differences of analyses on grids made anew; at roots places are discrete and the stress ratio is held
        part = 0.05 if name != "local_root_safety" else 0.2
        assert_allclose(found[name].values[..., 0], expected, rtol=0.0, atol=part * np.abs(expected).max())
