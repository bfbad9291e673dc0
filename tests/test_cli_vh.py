import csv
import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene
from loaded_tca.results import load_result
from tests.samples.results import SCENES

FEW = ("--set", "analysis.positions=3", "--set", "analysis.compliance=contact", "--set", "analysis.cells=[16, 16]")


@pytest.fixture(autouse=True)
def _in_an_empty_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("blank_pictures")
def test_vh_writes_a_row_for_each_pair_of_errors(run):
    """A slope f of the axes moves the contact of a lead parabola c z^2 by f/(2c): 20 um over +-12.5 mm here."""
    changes = ("--set", "pinion.modifications.lead_crowning_um=20.0")
    code, out, errors = run("vh", SCENES / "spur.toml", "--out", "out", "--v", 0, "--h", -0.02, 0, 0.02, *changes)
    assert (code, errors) == (0, [])
    *table, _, written = out.splitlines()
    assert written == "Written to out: vh_check.csv, vh_check.png"
    assert table[1] == "V mounting.in_plane_deg, H mounting.out_of_plane_deg"
    assert table[3].startswith("point on edge: part of the pitch in which the unloaded contact point lies on the edge")
    assert [table[4].split()[-1], table[5].split()[-2:]] == ["point", ["on", "edge"]]
    rows = list(csv.DictReader(Path("out", "vh_check.csv").read_text(encoding="utf-8").splitlines()))
    assert [float(row["mounting.out_of_plane_deg"]) for row in rows] == [-0.02, 0.0, 0.02]
    scene = read_scene(SCENES / "spur.toml")
    half = 0.5 * scene.pair().face_width
    moved = np.radians(0.02) * np.cos(scene.mesh().working_pressure_angle) / (2.0 * 0.02 / half**2)
    shifts = [float(row["shift_lengthwise_mm"]) for row in rows]
    assert_allclose(np.abs(shifts), [moved, 0.0, moved], rtol=0.05, atol=1e-9)  # centres of areas on a grid
    assert shifts[0] * shifts[2] < 0.0
    shown = [list(map(float, line.split())) for line in table[-3:]]
    columns = "centre_lengthwise_mm", "centre_profile_mm", "shift_lengthwise_mm", "shift_profile_mm"
    columns += "size_lengthwise_mm", "size_profile_mm"
    assert_allclose([line[2:8] for line in shown], [[float(row[name]) for name in columns] for row in rows], atol=5e-4)
    assert [line[1] for line in shown] == [-0.02, 0.0, 0.02]


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_vh_takes_steps_of_its_own_and_the_other_gear(run):
    assert run("vh", SCENES / "straight_bevel.toml", "--out", "out", "--gear", "wheel")[0] == 0
    rows = list(csv.DictReader(Path("out", "vh_check.csv").read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 9
    module = read_scene(SCENES / "straight_bevel.toml").pair().module
    assert_allclose(max(float(row["mounting.offset_mm"]) for row in rows), 0.01 * module, rtol=0.5)  # one digit


@pytest.mark.usefixtures("blank_pictures")
def test_vh_under_load_keeps_the_study(run):
    few = (*FEW[:-1], "analysis.cells=[6, 16]")
    code, out, _ = run("vh", SCENES / "spiral_bevel.toml", "--out", "out", "--loaded", "--v", 0, "--h", 0, 0.01, *few)
    assert code == 0
    assert out.startswith("2 variants: 2 ok\n")
    assert out.endswith("\nWritten to out: vh_study.nc, vh_study.csv, vh_under_load.png\n")
    assert "warning: fewer than 8 cells lie across the contact (2 variants)" in out
    table = out.split("loaded contact pattern on the pinion")[1].split("\n\n")[0].splitlines()
    shown = [list(map(float, line.split())) for line in table[-2:]]
    rows = list(csv.DictReader(Path("out", "vh_study.csv").read_text(encoding="utf-8").splitlines()))
    assert [float(row["mounting.pinion_axial_mm"]) for row in rows] == [0.0, 0.01]
    assert all(float(row["peak_pressure_MPa"]) > 0.0 for row in rows)
    assert [line[1] for line in shown] == [0.0, 0.01]
    assert_allclose([line[-1] for line in shown], [float(row["peak_pressure_MPa"]) for row in rows], atol=5e-4)
    assert {path.name for path in Path("out", "vh_study_maps").iterdir()} == {"0.nc", "1.nc"}


def test_vh_refuses_what_is_no_number(run):
    code, _, errors = run("vh", SCENES / "spur.toml", "--out", "out", "--v", "nan")
    assert code == 2
    assert "v: " in errors[0]


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_coast_side_is_analysed_and_compared(run):
    code, out, errors = run("run", SCENES / "spur.toml", "--coast", "--out", "both", *FEW)
    assert (code, [line for line in errors if "warning" not in line]) == (0, [])
    assert "Compared with drive" in out
    compared = json.loads(Path("both", "comparison.json").read_text(encoding="utf-8"))
    assert list(compared["titles"]) == ["drive", "coast"]
    assert load_result("both/coast/result.nc").scene.driving == "wheel"


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_gears_on_supports_are_compared_with_held_ones(run):
    scene = SCENES / "helical_on_supports.toml"
    code, out, errors = run("run", scene, "--rigid", "--out", "both", *FEW)
    assert (code, [line for line in errors if "warning" not in line]) == (0, [])
    assert "Compared with supports" in out
    assert load_result("both/supports/result.nc").scene.is_supported
    assert not load_result("both/rigid/result.nc").scene.is_supported


def test_held_gears_have_no_supports_to_leave_out(run):
    code, _, errors = run("run", SCENES / "spur.toml", "--rigid", "--out", "both")
    assert (code, errors) == (2, ["loaded-tca: no gear has supports; give one a section support or shaft"])


def test_coast_of_a_measured_flank_is_refused(run):
    code, _, errors = run("run", SCENES / "measured_flank.toml", "--coast", "--out", "both")
    assert code == 2
    assert '.flank.form: "measured" is one side of the teeth' in errors[0]
    assert not Path("both").exists()
