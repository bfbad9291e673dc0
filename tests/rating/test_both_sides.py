"""Ratings of the flanks of both sides under reversed bins: symmetry of the pair, sums of roots, what is refused."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.plots import plot_safeties, plot_sn_curves
from loaded_tca.rating import root_safeties
from loaded_tca.tribology.contact_slices import largest_pressures
from tests.rating.test_spectrum import GIVEN, SLOPES, bins
from tests.refusals import refusals
from tests.samples.rating import RATED, solved
from tests.samples.root_stress import analysed
from tests.samples.root_stress import result as with_roots
from tests.samples.shared import made_once

FLANKS = {"analysis.root_stress": False}
MIRRORED = 1e-5
"""Of damages: the pair is its own mirror image; pressures, whose 14th power they grow with, are solved to 1e-7."""


@made_once
def coast_result(**changes):
    return analysed(with_roots().scene.with_changes(changes).coast_side())


def reversed_first(*rows):
    """Bins of which the first is reversed."""
    first, *others = bins(*rows)
    return [first | {"reversed": True}, *others]


def both_sides(cases, changes=FLANKS):
    """The spur pair under bins, its drive side alone and with the coast side."""
    spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": cases}
    whole = solved(**GIVEN | SLOPES | spectrum | changes)
    return whole.rating(), whole.rating(coast=coast_result(**changes))


ROWS = (200.0, 10.0), (100.0, 30.0)


def test_flanks_of_a_side_have_the_damage_of_the_bins_that_load_them():
    spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": bins(*ROWS)}
    plain = solved(**GIVEN | SLOPES | spectrum | FLANKS).rating()
    alone, rated = both_sides(reversed_first(*ROWS))
    damage = rated.dataset.damage
    for mode in ("flank", "local_flank"):
        coast = mode.replace("flank", "coast_flank")
        assert_array_equal(damage.sel(mode=coast)[1], 0.0)
        assert_array_equal(damage.sel(mode=mode), alone.dataset.damage.sel(mode=mode))
        # the mirror image of a spur pair is the pair itself, and so is the damage of its other flanks
        assert_allclose(damage.sel(mode=coast)[0], plain.dataset.damage.sel(mode=mode)[0], rtol=MIRRORED)
    assert (damage.sel(mode="coast_flank")[0] > 0.0).all()
    assert_allclose(rated.miner_sum, rated.damage.sum(axis=0))
    assert_allclose(rated.flank_safety, plain.flank_safety, rtol=MIRRORED)


def test_roots_carry_the_bins_of_both_sides():
    alone, rated = both_sides(reversed_first(*ROWS))
    # K_Hbeta is given, so that reversed bins stress roots after the standard as the same torque does the other way
    assert_allclose(rated.sigma_F, alone.sigma_F, rtol=MIRRORED)
    assert (rated.dataset.damage.sel(mode="root") > 0.0).all()
    # annex B of ISO 6336-3:2006, case-hardened: R = -1.2 times the smaller load over the larger one, not below -1.2
    sensitivity, ratio = 0.8 - 0.15 * rated.Y_S, np.array([[-1.2 * 100.0 / 200.0], [-1.2]])
    assert_allclose(rated.Y_M, 1.0 / (1.0 - ratio * (1.0 - sensitivity) / (1.0 + sensitivity)), rtol=1e-9)


def test_rating_does_not_depend_on_which_side_is_called_drive(monkeypatch):
    numbers = (
        "Y_M",
        "sigma_F",
        "root_safety",
        "local_Y_M",
        "local_root_stress",
        "local_root_safety",
        "local_root_angle",
    )
    other, whole, rated = with_roots().scene.coast_side(), with_roots(), []
    # a spur pair is its own mirror image: one result stands for both sides
    largest = largest_pressures(whole)
    monkeypatch.setattr("loaded_tca.rating.solved.largest_pressures", lambda _: largest)
    for scenes, flipped in (((whole.scene, other), False), ((other, whole.scene), True)):
        cases = [each | {"reversed": each["pinion_torque_Nm"] < 150.0} for each in bins(*ROWS, (100.0, 5.0))]
        cases[2]["reversed"] = False
        if flipped:
            cases = [each | {"reversed": not each["reversed"]} for each in cases]
        spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": cases}
        scene = scenes[0].with_changes(RATED).with_changes(GIVEN | SLOPES | spectrum)
        rated.append(replace(whole, scene=scene).rating(coast=replace(whole, scene=scenes[1])))
    # stress ratios follow from torques alone: the rating of one side has them without the result of the other
    rated += [replace(each.result, scene=each.scene).rating() for each in rated]
    for other, name in product(rated[1:], numbers):
        assert_allclose(other.values(name), rated[0].values(name), rtol=1e-9, err_msg=name)
    for other, mode in product(rated[1:], ("root", "local_root")):
        assert_allclose(*(each.dataset.miner_sum.sel(mode=mode) for each in (other, rated[0])), rtol=1e-9)
    assert_allclose(rated[0].local_stress_ratio[1:], -1.2)  # bins of the smaller torque, of both sides
    assert (rated[0].local_stress_ratio[0] <= -0.6).all()
    assert_allclose(root_safeties(rated[0], 0, 1).safety.min(), rated[0].local_root_safety[0, 1], rtol=1e-9)
    assert_allclose(root_safeties(rated[2], 0, 1).safety.min(), rated[2].local_root_safety[0, 1], rtol=1e-9)
    of_one = [any("local stresses of the analysed side" in note for note in each.notes()) for each in rated]
    assert of_one == [False, False, True, True]


@pytest.mark.thorough
def test_local_roots_of_reversed_bins_have_the_tension_of_the_coast_side():
    alone, rated = both_sides(reversed_first(*ROWS), {})
    # meshes of both sides of a tooth
    assert_allclose(rated.local_root_stress[0], alone.local_root_stress[0], rtol=1e-3)
    # the larger torque of the other bin presses roots to R = -1.2 everywhere: the largest tension decides
    factor = rated.K_A[1] * rated.K_gamma[1] * rated.K_v[1]
    tension = factor * np.nanmax(rated.result.root_tension[0], axis=0)
    for each in (rated, alone):  # R follows from torques, with or without the result of the coast side
        assert_allclose(each.local_stress_ratio[1], -1.2)
        assert_allclose(each.local_root_stress[1], tension, rtol=1e-9)


def test_face_load_factor_of_a_reversed_bin_is_that_of_its_side():
    cases = reversed_first(*ROWS)
    spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": cases, "rating.face_load_factor": "analysis"}
    whole, coast = solved(**GIVEN | SLOPES | FLANKS | spectrum), coast_result(**FLANKS)
    crowded = replace(coast, dataset=coast.dataset.assign(face_load_factor=0.0 * coast.dataset.face_load_factor + 3.0))
    rated = whole.rating(coast=crowded)
    assert_allclose(rated.K_Hbeta, [3.0, whole.face_load_factor[0]])


def test_error_of_the_damage_is_told_for_both_sides():
    cases = reversed_first((160.0, 10.0), (140.0, 30.0))  # between two torques that were solved: no estimate
    with pytest.warns(AccuracyWarning, match="no estimate of its error: 2 analysed torques"):
        _, rated = both_sides(cases)
    assert np.isnan(rated.interpolation_error).all()
    assert any("load the coast flanks and the roots" in note for note in rated.notes())


def test_pictures_and_tables_have_the_coast_flanks():
    _, rated = both_sides(reversed_first(*ROWS))
    assert "coast flank: safety in the required life" in rated.summary()
    assert rated.key_figures()[0]["pinion_coast_flank_spectrum_safety"] == rated.dataset.spectrum_safety.sel(
        gear="pinion", mode="coast_flank"
    )
    labels = [label.get_text() for label in plot_safeties(rated).axes[0].get_yticklabels()]
    assert labels[-2:] == ["coast flank, ISO 6336-2", "coast flank, local"]
    assert len([axes for axes in plot_sn_curves(rated).axes if axes.get_visible()]) == len(rated.modes)
    with pytest.raises(InputError, match="a rating of both sides has no derivatives"):
        rated.sensitivities(["pinion.modifications.lead_crowning_um"])


def refused(cases, coast_changes):
    spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": cases}
    whole, coast = solved(**GIVEN | FLANKS | spectrum), coast_result(**FLANKS)
    return whole.rating(coast=replace(coast, scene=coast.scene.with_changes(coast_changes)))


test_refusals_of_coast_sides = refusals(
    refused,
    (bins(*ROWS), {}, "coast: the scene has no load spectrum with reversed bins"),
    (reversed_first(*ROWS), {"analysis.root_stress": True}, "coast: analysis.root_stress is not false"),
    (reversed_first(*ROWS), {"pair.driving": "pinion"}, r"coast: the section \[pair\] of its scene differs"),
    (
        reversed_first(*ROWS),
        {"pinion.face_width_mm": 21.0},
        r"coast: the section \[pinion\] of its scene differs",
    ),
)
