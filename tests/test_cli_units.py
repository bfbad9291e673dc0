"""Scenes of drawings in inches on the command line."""

from pathlib import Path

import pytest

from loaded_tca import cli
from loaded_tca.output import overview
from loaded_tca.output.overview_text import Overview

INCHES = Path(__file__).parents[1] / "examples" / "scenes" / "inches.toml"
SHAFT = """[pinion.shaft]
start_in = -3
torque_at_in = -3
sections = [{ length_in = 6, outer_diameter_in = 1.25 }]
bearings = [
    { at_in = -2.5, radial_stiffness_lbf_per_in = 1e6, axial_stiffness_lbf_per_in = 1e6 },
    { at_in = 2.5, radial_stiffness_lbf_per_in = 1e6 },
]
[wheel]
"""


def check(capsys, path, *changes):
    code = cli.main(["check", str(path), *(word for change in changes for word in ("--set", change))])
    return code, capsys.readouterr()


def title_of(scene):
    """An overview without the rest, whose effort takes a second."""
    return Overview(scene.title, {}, {}, {}, ("effort",))


def test_check_lists_what_the_file_writes_otherwise(capsys, monkeypatch):
    monkeypatch.setattr(overview, "overview_of_scene", title_of)
    code, printed = check(capsys, INCHES)
    assert code == 0
    title, _, lines = printed.out.partition("\nwritten otherwise in the file, and read as\n")
    assert title.splitlines()[0] == "Helical pair 24/71 of 8 normal diametral pitch, in inches"
    read = dict(line.split(maxsplit=1) for line in lines.splitlines())
    assert read["pair.normal_diametral_pitch_per_inch"] == "pair.normal_module_mm = 3.175"
    assert read["load.pinion_torque_lbf_in"] == "load.pinion_torque_Nm = 271.16359"
    assert len(read) == 14


@pytest.mark.parametrize("file", [False, True])
def test_check_lists_torques_of_bins_that_are_in_inches(tmp_path, capsys, monkeypatch, file):
    monkeypatch.setattr(overview, "overview_of_scene", title_of)
    cases = (
        "[[load.case]]\npinion_torque_lbf_in = 2400\nhours = 1\n[[load.case]]\npinion_torque_lbf_in = 12\nhours = 2\n"
    )
    (tmp_path / "bins.csv").write_text("pinion_torque_lbf_in,hours\n2400,1\n12,2\n", encoding="utf-8")
    load = '[load]\nspectrum = "bins.csv"\n' if file else cases
    text = INCHES.read_text(encoding="utf-8").replace("pinion_torque_lbf_in = 2400", "").replace("[load]\n", load)
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    code, printed = check(capsys, tmp_path / "scene.toml")
    assert code == 0
    read = dict(line.split(maxsplit=1) for line in printed.out.splitlines() if line.startswith("  "))
    # 1 lbf in is 0.45359237 kg times 9.80665 m/s^2 times 0.0254 m
    torques = ", ".join(f"{lbf_in * 0.45359237 * 9.80665 * 0.0254:.9g}" for lbf_in in (2400.0, 12.0))
    assert read["load.case.pinion_torque_lbf_in"] == f"load.case.pinion_torque_Nm = [{torques}]"


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (["pinion.face_width_in=-1"], "pinion.face_width_in: found -1; allowed a number above 0, up to 393.701"),
        # told by the geometry of the pair, long after the file is read
        ([], "pinion.bore_diameter_in: found 1.5; allowed up to 1.25, outer_diameter_mm of [[pinion.shaft.sections]]"),
        (["pinion.bore_diameter_mm=40"], "pinion.bore_diameter_mm: found 40; allowed up to 31.75, outer_diameter_mm"),
    ],
)
def test_problems_are_told_in_the_unit_that_is_given(tmp_path, capsys, changes, told):
    scene = tmp_path / "shaft.toml"
    scene.write_text(INCHES.read_text(encoding="utf-8").replace("[wheel]\n", SHAFT), encoding="utf-8")
    code, printed = check(capsys, scene, *changes)
    assert code == 2
    assert told in printed.err
