"""Safeties in studies: figures of a result, ranking by the largest, and the probability of a shortfall."""

import numpy as np
import pytest
import xarray
from numpy.testing import assert_allclose

from loaded_tca import parse_scene, read_scene
from loaded_tca.errors import InputError
from loaded_tca.reports.report import scatter_tables
from loaded_tca.studies import (
    Study,
    rank_combinations,
    rank_variants,
    rating_figures,
    shortfall,
    study_summary,
    tolerance_class_study,
)
from loaded_tca.studies.rating import FIGURES
from tests.samples.rating import solved
from tests.samples.results import SCENES

CLASS, SLOPE = "rating.tolerance_class", "pinion.modifications.helix_slope_um"


def rows(safeties, classes=None, **figures):
    """A study of samples (n,) of a safety under one torque, of gears of one class or of several."""
    count = len(safeties)
    words = {name: ("sample", [word] * count) for name, word in {"status": "ok", "reason": "", "warnings": ""}.items()}
    columns = {"S_H_local": safeties, "pinion_torque_Nm": [100.0] * count, **figures}
    data = {name: (("sample", "torque"), np.reshape(values, (count, 1))) for name, values in columns.items()}
    keys = {SLOPE: ("sample", np.arange(count) * 1.0, {"sampling": "table" if classes else "distribution"})}
    if classes:
        keys[CLASS] = ("sample", classes, {"sampling": "table"})
    scene = solved(**{"rating.required_flank_safety": 1.1}).scene
    return xarray.Dataset(data | words, keys, {"scene_toml": scene.to_toml()})


def test_figures_are_the_least_of_both_gears():
    result = solved()
    figures, rated = rating_figures(result), result.rating()
    assert {*figures} == {*FIGURES}
    for name, of in {"S_H": "flank_safety", "S_F_local": "local_root_safety"}.items():
        assert_allclose(figures[name], rated.values(of).min(axis=1), rtol=0.0)
    lives = rated.dataset["life_hours"].sel(mode=["flank", "root"])
    assert_allclose(figures["life_h"], lives.min(["gear", "mode"]), rtol=0.0)
    assert_allclose(figures["life_local_h"], rated.life_hours[..., 2:].min(axis=(1, 2)), rtol=0.0)


def test_scenes_without_strengths_have_none():
    assert rating_figures(solved(**{"wheel.strength": None})) == {}
    assert rating_figures(solved(rating=None)) == {}


def test_local_safety_of_roots_is_unknown_without_root_stress():
    figures = rating_figures(solved(**{"analysis.root_stress": False}))
    assert np.isnan(figures["S_F_local"]).all()
    assert np.isfinite(figures["life_local_h"]).any() or np.isinf(figures["life_local_h"]).all()  # of flanks


def test_largest_safety_ranks_first():
    study = rows([1.3, 1.0, 1.6], life_h=[np.inf, 5.0, np.nan])
    assert rank_variants(study, "S_H_local")["sample"].tolist() == [2, 0, 1]
    ranked = rank_variants(study, "life_h")
    assert ranked["sample"].tolist() == [0, 1, 2]
    assert ranked["rank"].isna().tolist() == [False, False, True]  # a life without end has a rank
    assert rank_variants(study, "S_H_local", largest_is_best=False)["sample"].tolist() == [1, 0, 2]


def test_combinations_have_the_low_quantile_of_safeties():
    study = rows(np.linspace(1.0, 2.0, 21), face_load_factor=np.linspace(1.0, 2.0, 21))
    study = study.assign_coords({"pinion.teeth": ("sample", [20] * 21, {"sampling": "factor"})})
    ranked = rank_combinations(study, "S_H_local").iloc[0]
    assert_allclose([ranked["S_H_local"], ranked["face_load_factor"]], [1.05, 1.95])  # 5 % and 95 % of even steps


def test_shortfall_has_bounds_of_a_binomial_count():
    few = shortfall(rows([1.2, 1.3, 1.05, 1.5])).iloc[0]
    assert (few["below"], few["samples"], few["probability"], few["required"]) == (1, 4, 0.25, 1.1)
    none = shortfall(rows([1.2] * 30)).iloc[0]
    assert none["low"] == 0.0
    assert_allclose(none["high"], 1.0 - 0.025 ** (1.0 / 30.0), rtol=1e-9)  # closed form where nothing happened
    every = shortfall(rows([1.0] * 30)).iloc[0]
    assert_allclose(every["low"], 0.025 ** (1.0 / 30.0), rtol=1e-9)
    assert every["high"] == 1.0


def test_shortfall_of_each_class_stands_in_the_summary():
    study = rows([1.2, 1.3, 1.0, 1.2], [5, 5, 9, 9])
    frame = shortfall(study)
    assert dict(zip(frame[CLASS], frame["probability"], strict=True)) == {5: 0.0, 9: 0.5}
    text = study_summary(study)
    assert "below the required 1.1 under 100 N m, rating.tolerance_class 9: probability 50 % (1 of 2 samples" in text
    with pytest.raises(InputError, match=r"by: 'pinion\.teeth'; allowed"):
        shortfall(study, ["pinion.teeth"])


@pytest.mark.parametrize("values", [["contact", "contact+tooth"], [True, False]])
def test_shortfall_of_designs_of_words_and_booleans_stands_in_the_summary(values):
    study = rows([1.2, 1.0, 1.0, 1.0]).assign_coords(
        {"analysis.compliance": ("sample", [value for value in values for _ in range(2)], {"sampling": "factor"})}
    )
    lines = [line for line in study_summary(study).splitlines() if "below the required" in line]
    for line, value, probability in zip(lines, values, (50, 100), strict=True):
        assert f"under 100 N m, analysis.compliance {value}: probability {probability} %" in line


TORQUE = "load.pinion_torque_Nm"


@pytest.mark.parametrize(
    ("sampling", "torques", "words"),
    [
        ("factor", [200.0, 400.0], ["200 N m, load.pinion_torque_Nm 200", "400 N m, load.pinion_torque_Nm 400"]),
        ("distribution", [np.nan], ["under the torque of each sample: probability 50 %"]),
    ],
)
def test_shortfall_has_the_torque_of_its_samples(sampling, torques, words):
    study = rows([1.2, 1.3, 1.0, 1.05], pinion_torque_Nm=[200.0, 200.0, 400.0, 400.0])
    study = study.assign_coords({TORQUE: ("sample", [200.0, 200.0, 400.0, 400.0], {"sampling": sampling})})
    assert_allclose(shortfall(study)["pinion_torque_Nm"], torques, rtol=0.0)
    text = study_summary(study)
    assert all(word in text for word in words)


def test_safeties_under_a_load_spectrum_stand_once():
    """They are of all bins together: the same number under each torque says nothing of that torque."""
    bins = [{"pinion_torque_Nm": torque, "share": 0.5} for torque in (80.0, 500.0)]
    study = rows([1.2, 1.3, 1.0, 1.05])
    twice = {name: (("sample", "torque"), np.repeat(study[name].values, 2, axis=1)) for name in ("S_H_local",)}
    twice["pinion_torque_Nm"] = ("sample", "torque"), np.tile([80.0, 500.0], (4, 1))
    study = xarray.Dataset({**study[["status", "reason", "warnings"]].data_vars, **twice}, study.coords, study.attrs)
    assert shortfall(study)["pinion_torque_Nm"].tolist() == [80.0, 500.0]  # torques that are load cases by themselves
    scene = parse_scene(study.attrs["scene_toml"], folder=None)
    changes = {"load.pinion_torque_Nm": None, "analysis.torques_Nm": None, "load.case": bins}
    under = study.assign_attrs(scene_toml=scene.with_changes(changes).to_toml())
    (row,) = shortfall(under).to_dict("records")
    assert (row["below"], row["samples"], np.isnan(row["pinion_torque_Nm"])) == (2, 4, True)
    text = study_summary(under)
    assert text.count("below the required 1.1 under the load spectrum: probability 50 %") == 1
    assert text.count("local safety against pitting ") == 2  # its percentiles, and its shortfall
    assert [table.head[0] for table in scatter_tables(under, None)] == ["under the load spectrum"]


def test_required_safety_that_varies_counts_of_each_sample():
    study = rows([1.2, 1.2]).assign_coords({"rating.required_flank_safety": ("sample", [1.0, 1.3])})
    assert shortfall(study, []).iloc[0]["below"] == 1


def test_studies_without_safeties_have_no_shortfall():
    study = rows([np.nan, np.nan])
    assert shortfall(study).empty
    assert "required" not in study_summary(study)


def test_classes_scatter_at_the_same_points_within_their_tolerances():
    scene = solved().scene
    study = tolerance_class_study(scene, [5, 7], samples=4)
    assert [study.changes(variant)[CLASS] for variant in (0, 3, 4, 7)] == [5, 5, 7, 7]
    slopes = np.array([study.changes(variant)[SLOPE] for variant in range(8)]).reshape(2, 4)
    # classes are steps of sqrt(2) in ISO 1328-1, tolerances rounded to 0.1 um or 0.5 um
    assert_allclose(slopes[1], 2.0 * slopes[0], rtol=0.1)
    assert isinstance(study, Study)


REFUSED = [
    ({"classes": []}, r"classes: found \[\]; allowed a list of whole numbers from 1 to 11"),
    ({"classes": [12]}, "classes: found 12; allowed whole numbers from 1 to 11"),
    ({"classes": [6], "samples": 0}, "samples: found 0; allowed a whole number from 1 on"),
]


@pytest.mark.parametrize(("arguments", "words"), REFUSED)
def test_bad_classes_and_samples_are_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        tolerance_class_study(solved().scene, **arguments)


def test_classes_need_strengths():
    with pytest.raises(InputError, match="scene: no strength of both gears and"):
        tolerance_class_study(read_scene(SCENES / "mesh_cycle_spur.toml"), [6])
