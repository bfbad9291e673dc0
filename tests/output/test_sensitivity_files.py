"""Files and text of sensitivities."""

import csv
import math

import numpy as np
import pytest
import xarray
from numpy.testing import assert_allclose

from loaded_tca.output import sensitivities_text, write_sensitivities
from loaded_tca.results import key_figure_slopes
from tests.samples.results import result

pytestmark = pytest.mark.filterwarnings(  # contacts reach edges, and all is read
    "ignore:an edge of a flank cuts the slices", "ignore:K_Hbeta follows the strip with", "ignore:a tooth pair with"
)
TOLERANCES = {
    "pinion.modifications.lead_crowning_um": 2.0,
    "mounting.out_of_plane_deg": 0.02,
    "load.pinion_torque_Nm": 5.0,
}


@pytest.fixture(scope="module")
def found():
    return result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0)).sensitivities(list(TOLERANCES))


def test_table_has_a_row_for_each_torque_and_key(found, tmp_path):
    written = write_sensitivities(found, TOLERANCES, tmp_path, {"picture.png": b"x"})
    assert [path.name for path in written] == ["sensitivities.nc", "sensitivities.csv", "picture.png"]
    with open(written[1], newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(float(row["pinion_torque_Nm"]), row["key"]) for row in rows] == [
        (torque, key) for torque in (40.0, 260.0) for key in TOLERANCES
    ]
    for name, slopes in key_figure_slopes(found).items():
        for row, slope in zip(rows, slopes.ravel(), strict=True):
            near = {"rtol": 1e-8}  # nine digits
            assert float(row["tolerance"]) == TOLERANCES[row["key"]]
            assert_allclose(float(row[f"{name}_per_unit"]), slope, **near)
            assert_allclose(float(row[f"{name}_per_tolerance"]), slope * TOLERANCES[row["key"]], **near)


def test_what_is_not_known_is_an_empty_cell(tmp_path):
    found = result(positions=1).sensitivities(["load.pinion_torque_Nm"])
    _, path = write_sensitivities(found, TOLERANCES, tmp_path)
    with open(path, newline="") as file:
        (row,) = csv.DictReader(file)
    assert row["face_load_factor_per_unit"] == row["transmission_error_span_um_per_tolerance"] == ""
    assert float(row["peak_pressure_MPa_per_unit"]) > 0.0


def test_file_has_the_derivatives_of_every_position_and_the_tolerances(found, tmp_path):
    path, _ = write_sensitivities(found, TOLERANCES, tmp_path)
    with xarray.open_dataset(path, engine="scipy") as file:
        assert file["key"].values.tolist() == list(TOLERANCES)
        assert file["tolerance"].values.tolist() == list(TOLERANCES.values())
        assert_allclose(file["transmission_error"].values, found.transmission_error, rtol=0)
        assert file.attrs["scene_toml"] == found.result.scene.to_toml()


def test_text_has_the_figures_of_the_table_and_their_sum_of_squares(found):
    lines = sensitivities_text(found, TOLERANCES, 1).splitlines()
    slopes = key_figure_slopes(found)["peak_pressure_MPa"][1]
    assert lines[1].startswith("pinion torque 260 N m")
    lasts = {line.rpartition("  ")[0].strip(): float(line.split()[-1]) for line in lines[4:] if line.count("  ") > 4}
    rows = {label.split("  ")[0]: number for label, number in lasts.items()}
    expected = {
        **dict(zip(TOLERANCES, slopes, strict=True)),
        **{f"{key} = {one:g}": one * slope for (key, one), slope in zip(TOLERANCES.items(), slopes, strict=True)},
        "all of them, independent": math.sqrt(np.square(slopes * list(TOLERANCES.values())).sum()),
    }
    assert [*rows] == [*expected]
    assert_allclose([*rows.values()], [*expected.values()], rtol=5e-3)  # three digits


def test_text_has_a_dash_for_what_is_not_known():
    found = result(positions=1).sensitivities(["load.pinion_torque_Nm"])
    lines = sensitivities_text(found, TOLERANCES, 0).splitlines()
    assert [line.split()[-2] for line in lines[3:] if line.count("  ") > 4] == ["-"] * 4
