"""Derivatives of safeties: the chain rule beside closed forms, beside ratings over the torque, and beside analyses."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning, InputError, noted_accuracy_warnings
from loaded_tca.rating import slopes as rating_slopes
from loaded_tca.scene import read_scene
from tests.samples.rating import RATED, bevel_solved, solved
from tests.samples.results import FLANKS_ALONE, SCENES
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
    assert {*slopes()[0][1].data_vars} == {*SAFETIES[:3], "damage", "life_hours"}


def moved_face(whole, growth, by):
    """Ratings of a result whose K_Hbeta is moved along its derivatives by changes of the first key."""
    slope = growth.face_load_factor[..., 0]
    face = whole.dataset["face_load_factor"]
    moved = [replace(whole, dataset=whole.dataset.assign(face_load_factor=face + part * slope)) for part in (-by, by)]
    return [each.rating() for each in moved]


BINS = [{"pinion_torque_Nm": torque, "hours": hours} for torque, hours in ((100.0, 30.0), (150.0, 20.0), (200.0, 10.0))]
HEAVY = {"operation.application_factor": 1.6, "rating.required_flank_safety": 1.9, "rating.required_root_safety": 5.0}
"""All stresses lie on the first slopes of their curves, so that damage is one power of them."""


LIFE = {"rating.life_hours": 60.0, "load.pinion_torque_Nm": 200.0}


@cache
def of_spectrum():
    """The spur pair under three bins, of which the middle one was not solved, and its derivatives."""
    spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": BINS, "rating.life_hours": None}
    with pytest.warns(AccuracyWarning, match="no estimate of its error: 2 analysed torques"):
        rated = solved(**SMALL, **HEAVY, **spectrum).rating()
    growth = rated.result.sensitivities([CROWNING])
    return rated, growth, rating_slopes.rating_slopes(rated, growth)


def test_safety_of_a_spectrum_follows_those_of_its_bins_by_their_damage():
    rated, _, found = of_spectrum()
    for mode, name in enumerate(SAFETIES[:3]):
        for gear in range(2):
            each, safety = rated.endurances[rated.modes[mode]][gear], rated.spectrum_safety[gear, mode]
            level = safety * each.stress
            lives = [each.curve.life(level * part) for part in (1.0 - 1e-6, 1.0, 1.0 + 1e-6)]
            assert_allclose((each.cycles / lives[1]).sum(), 1.0, rtol=1e-9)
            growth = each.cycles * (1.0 / lives[2] - 1.0 / lives[0])  # of the damage of each bin, by its stress
            expected = (growth * found[name].values[:, gear, 0] / rated.values(name)[:, gear]).sum() / growth.sum()
            relative = found.spectrum_safety.values[gear, mode, 0] / safety
            # differences over 1e-4 of safeties that are iterated to 1e-12, of changes of 1e-4 per um
            assert_allclose(relative, expected, rtol=1e-5)


def test_life_of_a_spectrum_falls_as_its_damage_grows():
    rated, _, found = of_spectrum()
    assert_allclose(found.miner_sum, found.damage.sum("case"), rtol=1e-9)
    relative = found.miner_sum.values[..., 0] / rated.miner_sum
    assert_allclose(found.life_hours.values[..., 0] / rated.life_hours, -relative, rtol=1e-5)
    slope = np.log(1.9 * rated.sigma_H[0, 0] / (1.9 * rated.sigma_H[2, 0]))
    exponent = np.log(rated.damage[0, 0, 0] / 30.0 / (rated.damage[2, 0, 0] / 10.0)) / slope  # of one line of the curve
    expected = -exponent * (rated.damage * found.flank_safety.values / rated.flank_safety[..., None])[:, 0, :1].sum(0)
    assert_allclose(found.miner_sum.values[0, 0], expected, rtol=1e-5)


@pytest.mark.filterwarnings("ignore:rating. the damage of the spectrum has no estimate")  # two torques
def test_bins_between_solved_torques_follow_them():
    rated, growth, found = of_spectrum()
    low, high = moved_face(rated.result, growth, 1e-3)
    for name in ("flank_safety", "root_safety", "spectrum_safety", "life_hours"):
        expected = (high.values(name) - low.values(name)) / 2e-3
        got = found[name].values[..., 0]
        if name not in SAFETIES:
            expected, got = expected[:, :2], got[:, :2]  # K_Hbeta alone is moved here, not the pressure
        assert_allclose(got, expected, rtol=1e-5)


def test_torque_of_a_spectrum_is_no_key():
    with pytest.raises(InputError, match=r"load.pinion_torque_Nm: a load spectrum has the torques of its bins"):
        of_spectrum()[0].sensitivities([TORQUE])


@cache
def of_bevels():
    """The spiral bevel pair by method B with K_Hbeta of the analysis, and its derivatives."""
    with noted_accuracy_warnings(given=False):  # contacts of 8 x 12 cells
        rated = bevel_solved(**{"rating.face_load_factor": "analysis"}).rating()
        growth = rated.result.sensitivities([CROWNING, TORQUE])
        return rated, growth, rating_slopes.rating_slopes(rated, growth)


def test_safeties_of_bevel_pairs_follow_the_face_load_factor_and_the_torque():
    rated, growth, found = of_bevels()
    with noted_accuracy_warnings(given=False):
        low, high = moved_face(rated.result, growth, 1e-3)
    for name in SAFETIES[:2]:
        expected = (high.values(name) - low.values(name)) / 2e-3
        assert_allclose(found[name].sel(key=CROWNING), expected, rtol=1e-5)
    # over the torque times K_v K_Hbeta K_Halpha, all of which fall with it, and by less than it grows
    exponent = found.root_safety.sel(key=TORQUE).values * 1e-3 * rated.torque[:, None] / rated.root_safety
    assert ((exponent > -1.0) & (exponent < 0.0)).all()


def test_transverse_load_factor_of_bevel_pairs_follows_the_largest_share():
    _, growth, _ = of_bevels()
    by_share = {"rating.transverse_load_factor": "analysis", "rating.dynamic_factor": "given"}
    with noted_accuracy_warnings(given=False):
        rated = bevel_solved(**by_share).rating()
        found = rating_slopes.rating_slopes(rated, growth)
    shares = np.nan_to_num(rated.result.load_share[0])
    place = np.unravel_index(shares.argmax(), shares.shape)
    assert rated.K_Halpha[0] > 1.0
    relative = np.nan_to_num(growth.load_share[0][place]) / shares[place]
    # K_Hbeta is given: S_F falls with the torque, of the first key not at all, and with the share
    expected = -relative - [0.0, 1e3 / rated.torque[0]]
    assert_allclose(found.root_safety[0, 0] / rated.root_safety[0, 0], expected, rtol=1e-6, atol=1e-12)


def test_transverse_load_factor_of_cylindrical_pairs_is_held():
    whole, growth = of_spectrum()[0].result, of_spectrum()[1]
    scene = whole.scene.with_changes({"load.case": None, "rating.transverse_load_factor": "analysis"} | LIFE)
    for factor, count in ((1.05, 1), (9.0, 0)):  # within the bounds of the standard, and above them
        ones = 0.0 * whole.dataset["transverse_load_factor"]
        rated = replace(whole, scene=scene, dataset=whole.dataset.assign(transverse_load_factor=ones + factor)).rating()
        with noted_accuracy_warnings(given=False) as told:
            rating_slopes.rating_slopes(rated, growth)
        assert sum(sentence.startswith("rating: derivatives hold K_Halpha") for sentence in told) == count


def test_contacts_that_decide_nearly_alike_are_told():
    slopes = np.array([[[1.0, 2.0]], [[1.01, 1.0]]])
    with pytest.warns(
        AccuracyWarning, match=r"largest stresses of two contacts differ by 0.3%; .* by up to 50% \(second; 1 of 2"
    ):
        rating_slopes._warn_of_kinks("local safety of roots", ["first", "second"], slopes, np.array([0.003]))


def test_farther_contacts_are_told_where_a_small_change_reaches_them():
    """1.9 % less, which derivatives of 1 and 3 % per um make up in 0.95 um, and those of 1 and 2.8 % in 1.06 um."""
    near, far = (np.array([[[0.01]], [[slope]]]) for slope in (0.03, 0.028))
    with pytest.warns(AccuracyWarning, match=r"of two contacts differ by 1.9%; .* by up to 67%"):
        rating_slopes._warn_of_kinks("local safety of roots", ["key_um"], near, np.array([0.019]))
    rating_slopes._warn_of_kinks("local safety of roots", ["key_um"], far, np.array([0.019]))


@pytest.mark.thorough
def test_safeties_follow_the_torque_as_ratings_do():
    cycle = result(**{"analysis.torques_Nm": tuple(np.linspace(120.0, 160.0, 9))})
    rated = replace(cycle, scene=cycle.scene.with_changes(RATED).with_changes(METHOD_B)).rating()
    with coarsely(), noted_accuracy_warnings(given=False) as told:
        found = rated.sensitivities([TORQUE])
    assert any("largest stresses of two contacts differ by" in sentence for sentence in told)  # from 145 N m on
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
    # contacts reach sharp edges, and another strip of the face carries nearly as much
    with coarsely(), noted_accuracy_warnings(given=False):
        for by in (-step, 0.0, step):
            cycle = analysed(scene("mesh_cycle_helical", **changes | {key: middle + by}))
            rated.append(replace(cycle, scene=cycle.scene.with_changes(RATED)).rating())
        found = rated[1].sensitivities([key])
    for name in SAFETIES:
        expected = (rated[2].values(name) - rated[0].values(name)) / (2.0 * step)
        # differences of analyses on grids made anew; at roots places are discrete and the stress ratio is held
        assert_allclose(found[name].values[..., 0], expected, rtol=0.0, atol=0.05 * np.abs(expected).max())


def test_root_tension_is_differentiated_where_it_decides():
    """The stress at a place is linear in forces and torque: its derivatives are those of each place, not of the top."""
    cycle = result()
    rated = replace(cycle, scene=cycle.scene.with_changes(RATED)).rating()
    growth = cycle.sensitivities([TORQUE])
    tension = cycle.root_stress[0].largest[1]
    position = int(cycle.root_tension[1, :, 0].argmax())
    tooth, *top = cycle.root_tension_place[1, position, 0].tolist()
    beside = [top[0], top[1], top[2] + 1]
    with coarsely():
        stress, slope = growth.root_stress_at(0, 1, position, [tooth, *beside])
    assert_allclose(stress, tension[tuple(beside)], rtol=1e-6)  # that of the envelope, of the same position
    held = rated.inputs.solved
    moved = replace(held, root_nodes=np.array(held.root_nodes))
    moved.root_nodes[1, 0] = beside
    with coarsely():
        none, (_, more) = (rating_slopes._beside_largest(each, growth, [0, 1])[:, 0, 0] for each in (held, moved))
        _, at_top = growth.root_stress_at(0, 1, position, [tooth, *top])
    assert_allclose(more, slope[0] / stress - at_top[0] / tension[tuple(top)], rtol=1e-9)
    assert none[1] == 0.0 or (held.root_nodes[1, 0] != top).any()


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("name", "key", "middle", "step", "cells", "torques"),
    [
        ("spiral_bevel_blank", CROWNING, 10.0, 0.5, (16, 24), (150.0, 300.0)),
        ("face_milled_19x62", PROFILE, 5.0, 1.0, (32, 48), (60.0, 120.0)),
        ("hypoid_13x42", CROWNING, 8.0, 4.0, (24, 36), (300.0, 600.0)),
    ],
)
def test_safeties_of_bevel_and_hypoid_pairs_follow_modifications_as_analyses_do(
    name, key, middle, step, cells, torques
):
    changes = {**FLANKS_ALONE, "analysis.positions": 5, "analysis.accuracy": None, "analysis.cells": cells}
    base = read_scene(SCENES / f"{name}.toml").with_changes(changes | {"analysis.torques_Nm": torques})
    rated = []
    with noted_accuracy_warnings(given=False):  # contacts reach edges
        for by in (-step, 0.0, step):
            cycle = analyse(base.with_changes({key: middle + by}))
            rated.append(replace(cycle, scene=cycle.scene.with_changes(RATED)).rating())
    with noted_accuracy_warnings(given=False) as told:
        found = rated[1].sensitivities([key])
    warned = any(words in sentence for sentence in told for words in ("peak pressure", "another contact decides"))
    for safety in SAFETIES[:2] if warned else SAFETIES[:3]:
        expected = (rated[2].values(safety) - rated[0].values(safety)) / (2.0 * step)
        # analyses on grids made anew scatter by some per cent of what they differ
        assert_allclose(found[safety].values[..., 0], expected, rtol=0.0, atol=0.05 * np.abs(expected).max())
