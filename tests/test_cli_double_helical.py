"""The commands for double helical pairs."""

import csv
import json
import math

import pytest

from loaded_tca import InputError, read_scene
from loaded_tca.cli import main
from loaded_tca.cli.inputs import directory_of
from loaded_tca.double_helical import DoubleHelicalResult
from loaded_tca.plots import DOUBLE_HELICAL_PICTURES
from loaded_tca.reports import write_html_report
from loaded_tca.results.tolerances import default_tolerances
from loaded_tca.studies import Study, rank_variants, run_study
from tests.samples.double_helical import FEW, SCENE, analysed, unlike_halves

FILES = ["double_helical.csv", "double_helical.json", "double_helical.nc", "half_a.nc", "half_b.nc"]


def put(directory, *names):
    """Files of an older result."""
    for name in names:
        (directory / name).parent.mkdir(parents=True, exist_ok=True)
        (directory / name).write_bytes(b"old")


@pytest.fixture
def written(tmp_path, monkeypatch, capsys):
    """Directory of a run whose analysis is not done again."""
    (tmp_path / "scene.toml").write_text(unlike_halves().to_toml())
    asked = []

    def ready(scene, **_):
        asked.append(scene)
        return analysed()[0]

    monkeypatch.setattr("loaded_tca.double_helical.analyse_double_helical", ready)
    assert main(["run", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")]) == 0
    assert asked == [unlike_halves()]
    assert "share of half a in the torque, mean" in capsys.readouterr().out
    return tmp_path / "out"


@pytest.mark.usefixtures("blank_pictures")
def test_run_writes_both_halves_with_tables_and_pictures(written):
    pictures = [f"{name}.png" for name in DOUBLE_HELICAL_PICTURES]
    assert sorted(path.name for path in written.iterdir()) == sorted(FILES + pictures)
    result = DoubleHelicalResult.load(written)
    figures = json.loads((written / "double_helical.json").read_text())["torques"][0]
    assert figures["half_b_torque_share"] == 0.5
    assert figures["axial_motion_mean_um"] == pytest.approx(1e3 * result.axial_motion.mean())
    with (written / "double_helical.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["axial_motion_um"]) for row in rows] == pytest.approx(1e3 * result.axial_motion[0])


@pytest.mark.usefixtures("blank_pictures")
def test_commands_for_one_pair_name_the_files_of_the_halves(written, capsys):
    assert main(["plot", str(written)]) == 2
    assert "a double helical pair, not the result of a mesh cycle; half_a.nc and half_b.nc" in capsys.readouterr().err
    assert main(["run", str(SCENE.with_name("helical.toml")), "--out", str(written)]) == 2
    assert "holds a double helical pair (double_helical.nc)" in capsys.readouterr().err


@pytest.mark.usefixtures("blank_pictures")
def test_files_of_a_half_replace_none_of_the_pair(written):
    """They go into a folder of the half."""
    before = {path: path.read_bytes() for path in written.iterdir()}
    for command in ("dynamics", "report"):
        assert main([command, str(written / "half_b.nc")]) == 0
    assert {path: path.read_bytes() for path in written.iterdir() if path.is_file()} == before
    assert {path.name for path in (written / "half_b").iterdir()} > {"dynamics.csv", "report.html"}


GONE = (
    *("report.html", "sensitivities.csv", "rating.json", "root_safety.png"),
    *("half_a/dynamics.csv", "half_a/report.html", "half_a/torque_80_Nm_position_2/pressure_map.png"),
    "half_a_under_400_Nm/report.html",
)
KEPT = "notes.txt", "half_a/notes.txt", "half_b/result.nc", "half_b/report.html", "halves/report.html"


@pytest.mark.usefixtures("blank_pictures")
def test_run_leaves_no_file_of_an_earlier_pair_and_of_its_halves(written):
    """But those of the user, and of a result that has a folder with the name of a half for its own."""
    put(written, *GONE, *KEPT)
    assert main(["run", str(written.parent / "scene.toml"), "--out", str(written)]) == 0
    assert not [name for name in GONE if (written / name).exists()]
    assert all((written / name).read_bytes() == b"old" for name in KEPT)
    assert {path.name for path in written.iterdir() if path.is_dir()} == {"half_a", "half_b", "halves"}


def test_report_of_a_half_under_another_torque_goes_into_a_folder_of_its_own(tmp_path):
    assert directory_of(tmp_path / "half_a_under_400_Nm.nc") == tmp_path / "half_a_under_400_Nm"
    assert directory_of(tmp_path / "result.nc") == tmp_path


CHANGED = "--set", "pair.axial_stiffness_N_per_um=20", "--set", "wheel.apex_runout_um=12"


def test_check_describes_both_halves(capsys):
    changes = [part for key, value in FEW.items() for part in ("--set", f"{key}={str(value).lower()}")]
    assert main(["check", str(SCENE), *changes, *CHANGED]) == 0
    lines = capsys.readouterr().out.splitlines()
    by_label = {line[:44].strip(): line[44:].split() for line in lines}
    assert by_label["face width of a half [mm]"] == ["40.0000", "40.0000"]
    assert by_label["apex runout, peak to peak [um]"] == ["0", "12"]
    assert by_label["floating along its axis"] == ["pinion,", "on", "20", "N/um"]
    # T/2 tan(beta)/r at the reference circle, 2 r = 29 * 4 mm/cos(beta)
    axial = 800e3 * math.sin(math.radians(15.0)) / 58.0
    assert float(by_label["axial force of a half, even shares [N]"][0]) == pytest.approx(axial, abs=0.1)
    assert by_label["pinion.modifications.helix_slope_um"] == ["8.0"]
    assert sum(line.startswith("half ") for line in lines) == 2


def test_check_shows_the_mounting_errors_that_the_scene_has(capsys):
    """Not those of the halves, which follow from unlike face widths, levers and the errors of the whole wheel."""
    wide = ["--set", "pinion.face_width_mm=104"]
    assert main(["check", str(SCENE), *wide]) == 0
    assert [line.split() for line in capsys.readouterr().out.splitlines() if "mounting" in line] == [
        ["mounting", "errors", "none"]
    ]
    errors = ["--set", "mounting.axial_offset_mm=0.3", "--set", "mounting.half_b.out_of_plane_deg=0.005"]
    assert main(["check", str(SCENE), *wide, *errors]) == 0
    assert [line.split() for line in capsys.readouterr().out.splitlines() if "mounting" in line] == [
        ["mounting.axial_offset_mm", "0.3"],
        ["mounting.half_b.out_of_plane_deg", "0.005"],
    ]


@pytest.mark.parametrize("command", ["vh", "ease-off", "measured"])
def test_commands_that_take_one_pair_refuse_two_halves(command, tmp_path, capsys):
    assert main([command, str(SCENE), "--out", str(tmp_path)]) == 2
    assert (
        "pair.double_helical: found true; allowed false here, where one pair of flanks is needed"
        in capsys.readouterr().err
    )


def test_sides_and_supports_are_not_compared(tmp_path, capsys):
    assert main(["run", str(SCENE), "--coast", "--out", str(tmp_path)]) == 2
    assert "--coast, --rigid: not allowed with double helical pairs" in capsys.readouterr().err


@pytest.mark.usefixtures("blank_pictures")
def test_study_keeps_the_figures_of_both_halves_and_has_a_report(tmp_path, monkeypatch):
    monkeypatch.setattr("loaded_tca.studies.double_helical.analyse_double_helical", lambda _: analysed()[0])
    study = Study(unlike_halves(), {"pair.gap_mm": [10.0, 20.0]})
    rows = run_study(study, out=tmp_path / "study.nc")
    assert rows["half_b_torque_share"].values.tolist() == [[0.5], [0.5]]
    assert rank_variants(rows)["rank"].tolist() == [1, 2]  # by the transmission error, of which both have the same
    report = write_html_report(rows, tmp_path / "report.html", date="2026-03-04T05:06:07+00:00")
    assert "Half b, z from the groove outwards" in report.read_text()
    with pytest.raises(InputError, match="keep_maps: not of a study of double helical pairs"):
        run_study(study, out=tmp_path / "study.nc", keep_maps=[0])


def test_sensitivities_of_both_halves_are_written_for_keys_and_tolerances(tmp_path, capsys):
    analysed()[0].save(tmp_path)
    keys = "pair.apex_offset_mm=0.02", "load.pinion_torque_Nm=16"
    assert main(["sensitivities", str(tmp_path), "--keys", *keys]) == 0
    text = capsys.readouterr().out
    assert "pair.apex_offset_mm = 0.02" in text
    assert "pressure b" in text
    with (tmp_path / "sensitivities.csv").open(newline="") as file:
        apex, torque = csv.DictReader(file)
    # the pinion floats after the wheel's apex: um per mm, um for 0.02 mm; the halves keep their shares
    assert float(apex["axial_motion_mean_um_per_unit"]) == pytest.approx(1000.0)
    assert float(apex["axial_motion_mean_um_per_tolerance"]) == pytest.approx(20.0)
    assert float(apex["half_a_torque_share_per_unit"]) == pytest.approx(0.0, abs=1e-12)  # rounding
    # line loads of a contact whose edges hold it grow in proportion to the force, and less where it spreads
    load = analysed()[0].line_load[0, :, 0].max()
    assert 0.3 * load < 100.0 * float(torque["half_a_line_load_N_per_mm_per_tolerance"]) < 1.1 * load
    assert main(["sensitivities", str(tmp_path), "--torque", "7"]) == 2
    assert "--torque 7: the result has 1600 N m" in capsys.readouterr().err


def test_usual_keys_of_double_helical_pairs_have_half_b_and_the_apex():
    keys = [*default_tolerances(read_scene(SCENE))]
    assert "pinion.half_b.modifications.helix_slope_um" in keys
    assert "pair.apex_offset_mm" in keys
    assert "mounting.half_b" not in keys
    assert [key for key in keys if key.startswith("mounting.")] == [
        f"mounting.{name}"
        for name in ("in_plane_deg", "out_of_plane_deg", "centre_distance_error_mm", "axial_offset_mm")
    ]
