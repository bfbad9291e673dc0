"""The command that reads tribology off a result: its files, its summary, what it refuses."""

import csv
import os

import pytest
import xarray
from numpy.testing import assert_allclose

from loaded_tca.plots import TRIBOLOGY_PICTURES
from loaded_tca.tribology import Tribology
from tests.samples.tribology import ROUGHNESS, known, shared

OIL = ("lubricant.viscosity_40_mm2_s=220", "lubricant.viscosity_100_mm2_s=19", "lubricant.oil_temperature_C=80")
ROUGH = tuple(f"{gear}.roughness_Ra_um={ra}" for gear, ra in zip(("pinion", "wheel"), ROUGHNESS, strict=True))
TWO_TORQUES = {"analysis__torques_Nm": (20.0, 130.0), "positions": 17}
pytestmark = pytest.mark.filterwarnings("ignore:tribology:loaded_tca.errors.AccuracyWarning")


def cycle():
    return shared("mesh_cycle_spur", **TWO_TORQUES)


@pytest.fixture
def out(tmp_path, monkeypatch):
    """The directory of a result."""
    monkeypatch.chdir(tmp_path)
    os.mkdir("out")
    cycle().save("out/result.nc")
    return "out"


def settings(*pairs):
    return [part for pair in pairs for part in ("--set", pair)]


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.thorough
def test_command_writes_what_the_call_finds(run, out):
    code, text, _ = run("tribology", out, "--speed", "500", "1500", *settings(*OIL, *ROUGH))
    assert code == 0
    assert text.count("loss factor H_VL") == 2  # the summary of either speed
    assert text.index("pinion at 500 rpm") < text.index("pinion at 1500 rpm")
    assert {*os.listdir(out)} == {"result.nc", *Tribology.file_names(), *(f"{name}.png" for name in TRIBOLOGY_PICTURES)}
    expected = known(cycle(), pinion_speed_rpm=[500.0, 1500.0])
    with xarray.open_dataset(f"{out}/tribology.nc", engine="scipy") as file:
        assert_allclose(file["film_ratio"], expected.film_ratio)
    table = rows(f"{out}/tribology.csv")
    assert [row["pinion_speed_rpm"] for row in table] == ["500", "500", "1500", "1500"]
    films = [float(row["least_film_thickness_um"]) for row in table]
    assert_allclose(films, expected.least_film_thickness.ravel(), rtol=1e-8)  # nine digits
    loss = [float(row["loss_factor"]) for row in table]
    assert_allclose(loss, [*expected.loss_factor, *expected.loss_factor], rtol=1e-8)
    assert len(rows(f"{out}/tribology_slices.csv")) == len(expected.sweep)


def test_command_without_speed_or_oil_has_the_loss_factor_alone(run, out):
    code, text, _ = run("tribology", out, "--out", "alone")
    assert code == 0
    assert "needs pinion_speed_rpm" in text
    assert {*os.listdir("alone")} == {*Tribology.file_names()}
    assert list(rows("alone/tribology.csv")[0]) == ["pinion_speed_rpm", "pinion_torque_Nm", "loss_factor"]


REFUSED = [
    (("--speed", "0"), "operation.pinion_speed_rpm: found 0.0; allowed a number above 0"),
    (("--set", "pinion.teeth=21"), "--set pinion.teeth: needs another analysis"),
    (("--set", "lubricant.base=water"), 'lubricant.base: found "water"'),
    (settings(*OIL, "lubricant.viscosity_100_mm2_s=300"), "lubricant.viscosity_100_mm2_s: found 300"),
]


@pytest.mark.parametrize(("arguments", "words"), REFUSED)
def test_command_refuses_in_one_line(run, out, arguments, words):
    code, _, errors = run("tribology", out, *arguments)
    assert code == 2
    assert any(words in line for line in errors), errors
    assert os.listdir(out) == ["result.nc"]
