"""Load spectra of scenes: bins in the file and in a table beside it, torques that are solved, and every problem."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.scene import parse_scene, read_scene
from tests.refusals import refusals
from tests.samples.results import SCENES

WANTED = {
    "required_flank_safety": 1.1,
    "required_root_safety": 1.4,
    "dynamic_factor": "given",
    "transverse_load_factor": 1.0,
}


def scene(**changes):
    return read_scene(SCENES / "helical.toml").with_changes({"analysis.torques_Nm": None} | changes)


def bins(torques, hours=1.0):
    return [{"pinion_torque_Nm": float(torque), "hours": hours} for torque in torques]


def spectrum(tmp_path, text):
    file = tmp_path / "bins.csv"
    file.write_text(text, encoding="utf-8")
    return scene(**{"load.spectrum": str(file)})


def test_few_torques_are_solved_each_once():
    assert scene(**{"load.case": bins([80.0, 20.0, 0.0, 80.0])}).torques == (20e3, 80e3)


def test_many_torques_are_a_dozen_in_equal_steps_up_to_the_largest():
    torques = np.array(scene(**{"load.case": bins(np.linspace(50.0, 300.0, 500))}).torques)
    assert len(torques) == 12
    assert torques[-1] == 300e3
    assert_allclose(np.diff(torques), np.diff(torques)[0], rtol=1e-3)  # torques between have five digits


def test_of_torques_that_do_next_to_no_damage_the_smallest_is_solved():
    rare = bins(np.linspace(100.0, 300.0, 20)) + bins(np.linspace(1.0, 9.0, 9))
    torques = np.array(scene(**{"load.case": rare}).torques)
    assert_allclose(torques[:2], [3e3, 100e3])  # (9/300)^4 of 1 h is below 1e-4 of all; 1 % of the largest is 3 N m
    assert len(torques) == 12
    assert_allclose(np.diff(torques[1:]), 20e3)
    often = bins(np.linspace(100.0, 300.0, 20)) + bins(np.linspace(1.0, 9.0, 20), hours=1e8)
    assert np.sum(np.array(scene(**{"load.case": often}).torques) < 9e3) == 1


def test_torques_of_the_analysis_go_before_those_of_a_spectrum():
    changes = {"load.case": bins(range(1, 31)), "analysis.torques_Nm": (5.0, 30.0)}
    assert scene(**changes).torques == (5e3, 30e3)


def test_table_takes_the_place_of_its_file_and_stays_in_the_text(tmp_path):
    one = spectrum(tmp_path, "pinion_torque_Nm;hours;reversed;pinion_speed_rpm\n100;2.5;true;900\n300;5;;\n")
    assert one.load.spectrum is None
    assert [case.reversed for case in one.load.case] == [True, False]
    assert [case.pinion_speed_rpm for case in one.load.case] == [900.0, None]
    assert one.load.hours == 7.5
    assert parse_scene(one.to_toml(), folder=None) == one


def test_torques_of_a_file_may_be_in_pounds(tmp_path):
    found = spectrum(tmp_path, "pinion_torque_lbf_in,hours\n1000,1\n2000,1\n").load.case
    assert [case.pinion_torque_Nm for case in found] == pytest.approx([112.9848, 225.9697], rel=1e-6)  # NIST SP 811
    with pytest.raises(InputError, match=r"line 2: pinion_torque_lbf_in: found -1.*; allowed a number from 0 to 8.85"):
        spectrum(tmp_path, "pinion_torque_lbf_in,hours\n-1,1\n")


def test_files_of_spectra_lie_beside_the_scene(tmp_path):
    text = scene().to_toml().replace("pinion_torque_Nm = 130.0", 'spectrum = "bins.csv"')
    assert 'spectrum = "bins.csv"' in text
    (tmp_path / "bins.csv").write_text("pinion_torque_Nm,share\n100,1\n")
    (tmp_path / "scene.toml").write_text(text)
    assert read_scene(tmp_path / "scene.toml").load.case[0].share == 1.0
    with pytest.raises(InputError, match=r"load.spectrum: found \"bins.csv\"; allowed no file here"):
        parse_scene(text, folder=None)


def test_another_load_takes_the_place_of_a_spectrum():
    one = scene(**{"load.case": bins([20.0])})
    assert one.with_changes({"load.pinion_torque_Nm": 5.0}).torques == (5e3,)
    assert one.with_changes({"load.case.0.share": 1.0}).load.case[0].hours is None


def test_coast_side_has_the_bins_that_load_it():
    both = scene(**{"load.case": [*bins([20.0]), {"pinion_torque_Nm": 10.0, "hours": 1.0, "reversed": True}]})
    assert [case.reversed for case in both.coast_side().load.case] == [True, False]
    assert both.coast_side().coast_side().load == both.load
    assert [case.reversed for case in scene(**{"load.case": bins([20.0])}).coast_side().load.case] == [False]


test_bins_refuse = refusals(
    lambda cases: scene(**{"load.case": cases}),
    ([], r"load.case: found \[\]; allowed a list of 1 to 5000 tables of pinion_torque_Nm, "),
    (
        [{"pinion_torque_Nm": 1.0, "hours": 1.0, "share": 0.5}],
        "load.case: table 0: hours: found 1 beside share = 0.5; give one",
    ),
    ([{"pinion_torque_Nm": 1.0}], "load.case: table 0: hours: missing; give hours, or share"),
    (bins([1.0], hours=-1.0), "load.case: table 0: hours: found -1.0; allowed a number from 0 to 100000000"),
    ([{"pinion_torque_Nm": 1.0, "share": -0.1}], "load.case: table 0: share: found -0.1; allowed a number from 0"),
    (bins([-1.0]), "pinion_torque_Nm: found -1.0; allowed .*; reversed = true is the other direction"),
    (bins([1.0, 2.0], hours=0.0), "load.case: the hours sum to 0; allowed above 0"),
    (
        [{"pinion_torque_Nm": 1.0, "share": 0.5}, {"pinion_torque_Nm": 2.0, "share": 0.4}],
        "load.case: the shares sum to 0.9; allowed 1",
    ),
    (
        [*bins([1.0]), {"pinion_torque_Nm": 1.0, "share": 0.5}],
        "load.case: hours of 1 bins and shares of 1; give one of",
    ),
    (bins([0.0]), "load.case: no bin has a pinion_torque_Nm above 0"),
    ([one | {"reversed": True} for one in bins([1.0])], "load.case: all bins are reversed; change pair.driving"),
)
test_loads_refuse = refusals(
    lambda changes: scene(**changes),
    ({"load": {"pinion_torque_Nm": 1.0, "case": bins([1.0])}}, "load.pinion_torque_Nm: found pinion_torque_Nm beside"),
    (
        {"load.case": bins([20.0]), "analysis.torques_Nm": (5.0, 10.0)},
        "load: a bin has 20 N m; allowed up to 10, the largest of analysis.torques_Nm",
    ),
    ({"rating": WANTED}, "rating.life_hours: missing; needed unless load cases have hours"),
    ({"load.spectrum": "nowhere.csv"}, "load.spectrum: nowhere.csv: cannot be read"),
)


def test_hours_of_bins_are_a_life():
    assert scene(**{"load.case": bins([20.0, 30.0]), "rating": WANTED}).rating.life_hours is None


BAD_FILES = [
    ("torque,hours,share\n1,2,3\n", ("unknown column .torque.; did you mean", "no column", "both of")),
    ("pinion_torque_Nm,hours,hours\n1,2,3\n", ("column hours found twice",)),
    ("pinion_torque_Nm,hours\n", ("0 lines of bins; allowed 1 to 5000",)),
    ("pinion_torque_Nm,share\n1,0.5\n", ("the shares sum to 0.5; allowed 1",)),
    (
        "pinion_torque_Nm,hours,reversed\n1,2,true\n-3,a,no\n4,,1\n5,6,0,7\n",
        ("line 3: pinion_torque_Nm: found -3.0", 'line 3: hours: found "a"', 'line 3: reversed: found "no"',
         "line 4: hours: missing", "line 5: more values than"),
    ),
    ("pinion_torque_Nm,hours\n" + "-1,1\n" * 30, (*["pinion_torque_Nm: found -1.0"] * 20, "10 more problems")),
]  # fmt: skip


@pytest.mark.parametrize(("text", "words"), BAD_FILES)
def test_every_problem_of_a_file_is_told(tmp_path, text, words):
    with pytest.raises(InputError) as refused:
        spectrum(tmp_path, text)
    assert len(refused.value.problems) == len(words)
    for problem, expected in zip(refused.value.problems, words, strict=True):
        assert problem.startswith("load.spectrum: ")
        with pytest.raises(InputError, match=expected):
            raise InputError(problem)
