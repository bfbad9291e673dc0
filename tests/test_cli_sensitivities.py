"""The command that shows what keys and their tolerances change: files, words on the terminal, exit codes."""

import csv
import os

import pytest

from loaded_tca.results import default_tolerances, key_figure_slopes
from tests.samples.results import result

# contacts reach edges, faces are of one width, and all is read
pytestmark = pytest.mark.filterwarnings(
    "ignore:an edge of a flank cuts the slices",
    "ignore:edges of both gears",
    "ignore:faces of both gears",
    "ignore:derivatives of the transmission error depend",
    "ignore:K_Hbeta follows the strip with",
)
CROWNING, OFFSET = "pinion.modifications.lead_crowning_um", "mounting.axial_offset_mm"
FILES = [
    "sensitivities.nc",
    "sensitivities.csv",
    "tornado.png",
    "sensitivity_curves.png",
    "transmission_error_band.png",
    "removal_weights.png",
]


def cycle():
    return result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0))


@pytest.fixture
def out(tmp_path, monkeypatch):
    """The directory of a result."""
    monkeypatch.chdir(tmp_path)
    os.mkdir("out")
    cycle().save("out/result.nc")
    return "out"


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.thorough
def test_every_modification_and_mounting_error_is_looked_at(run, out):
    code, text, errors = run("sensitivities", out)
    assert code == 0
    reasons = [
        "an edge of a flank cuts the slices with the largest line load",
        "an edge of a flank cuts the slices with the peak pressure",
        "derivatives of the transmission error depend on the grid",
        "edges of both gears lie at one place",
        "faces of both gears end at one place",
        "peak to peak",
    ]
    sentences = sorted(error.partition(":")[2].strip() for error in errors)
    assert len(sentences) == len(reasons)
    assert all(one.startswith(reason) for one, reason in zip(sentences, reasons, strict=True))
    assert text.splitlines()[1].startswith("pinion torque 260 N m")
    assert text.splitlines()[-1] == f"Written to out: {', '.join(FILES)}"
    assert sorted(os.listdir(out)) == sorted(["result.nc", *FILES])
    found = [(row["key"], float(row["tolerance"])) for row in rows("out/sensitivities.csv")]
    assert found == 2 * list(default_tolerances(cycle().scene).items())


@pytest.mark.usefixtures("blank_pictures")
def test_keys_have_the_tolerances_given_or_the_usual_ones(run, out):
    code, text, _ = run("sensitivities", out, "--keys", f"{OFFSET}=0.05", CROWNING, "--torque", 40, "--out", "there")
    assert code == 0
    assert text.splitlines()[1].startswith("pinion torque 40 N m")
    found = rows("there/sensitivities.csv")
    assert [(row["key"], row["tolerance"]) for row in found] == 2 * [(OFFSET, "0.05"), (CROWNING, "1")]
    slope = key_figure_slopes(cycle().sensitivities([OFFSET]))["peak_pressure_MPa"][0, 0]
    assert float(found[0]["peak_pressure_MPa_per_tolerance"]) == pytest.approx(0.05 * slope, rel=1e-6)


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_those_of_a_torque_go_to_a_directory_of_their_own(run, out):
    assert run("sensitivities", out, "--keys", CROWNING, "--torque", 40)[0] == 0
    assert sorted(os.listdir(out)) == ["result.nc", "torque_40_Nm"]
    assert sorted(os.listdir("out/torque_40_Nm")) == sorted(FILES)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["out", "--keys", "pinion.modifications.crowning_um"], "--keys pinion.modifications.crowning_um: unknown key"),
        (["out", "--keys", "pinion.teeth=1"], "pinion.teeth: does not change the gap alone; allowed are lengths and"),
        (["out", "--keys", "mounting"], "--keys mounting: a section; allowed is one of its keys"),
        (["out", "--keys", CROWNING, f"{CROWNING}=2"], f"--keys {CROWNING}: given twice"),
        (["out", "--keys", f"{CROWNING}=-2"], "allowed KEY or KEY=TOLERANCE, the tolerance a number above 0"),
        (["out", "--keys", f"{CROWNING}=0"], "the tolerance a number above 0"),
        (["out", "--keys", f"{CROWNING}=nan"], "the tolerance a number above 0"),
        (["out", "--keys", f"{CROWNING}=inf"], "the tolerance a number above 0"),
        (["out", "--keys", f"{CROWNING}=much"], "the tolerance a number above 0"),
        (["out", "--keys", "=2"], "allowed KEY or KEY=TOLERANCE"),
        (["out", "--keys"], "argument --keys: expected at least one argument"),
        (["out", "--torque", "41"], "--torque 41: the result has 40, 260 N m"),
        (["nowhere"], "nowhere: cannot be read: No such file or directory"),
        (["out", "--out", "out/result.nc"], "is a file; give a directory"),
    ],
)
def test_bad_input_is_told_and_writes_nothing(refused, out, arguments, told):
    assert told in refused("sensitivities", *arguments)
    assert os.listdir(out) == ["result.nc"]


def test_all_wrong_keys_are_told_at_once(run, out):
    _, _, errors = run("sensitivities", out, "--keys", "pinion.modifications.crown_um", "mounting.offset")
    assert len(errors) == 2
    assert "mounting.axial_offset_mm" in errors[1]


def test_torque_without_load_has_no_sensitivities(refused, tmp_path):
    result(torques=(0.0, 80.0), positions=2).save(tmp_path / "result.nc")
    message = refused("sensitivities", tmp_path, "--keys", CROWNING, "--torque", 0)
    assert message == "nothing is under load with pinion torque 0 N m: no derivatives"
    assert os.listdir(tmp_path) == ["result.nc"]


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_file_of_sensitivities_is_no_result(run, refused, out):
    run("sensitivities", out, "--keys", CROWNING)
    assert refused("plot", "out/sensitivities.nc").startswith("out/sensitivities.nc: not the result of a mesh cycle")
