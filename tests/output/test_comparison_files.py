"""Files of a comparison: what they hold is what the comparison has."""

import csv
import json
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.output import write_comparison
from loaded_tca.results import compare_results
from tests.samples.results import changed, changed_scene, result


@pytest.fixture
def comparison():
    first = result(torques=(20.0, 80.0))
    higher = changed(first, peak_pressure=1.5 * first.peak_pressure, residual=3.0 * first.residual)
    return compare_results({"first": first, "higher": changed_scene(higher, {"mounting.misalignment_um": 3.0})})


def test_table_has_a_row_for_each_torque_and_figure(comparison, tmp_path):
    write_comparison(comparison, tmp_path)
    with (tmp_path / "comparison.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * comparison.figures.sizes["figure"]
    parts = {"first: value": 1.0, "higher: value": 1.5, "higher: difference": 0.5}
    for row, peak in zip(
        (row for row in rows if row["figure"] == "peak_pressure_MPa"),
        np.nanmax(result(torques=(20.0, 80.0)).peak_pressure, axis=(1, 2)),
        strict=True,
    ):
        assert_allclose([float(row[name]) for name in parts], peak * np.array([*parts.values()]), rtol=1e-8)
        assert float(row["higher: relative_difference"]) == pytest.approx(0.5)
    assert [row["pinion_torque_Nm"] for row in rows[:: len(rows) // 2]] == ["20", "80"]
    (residual, _) = [row for row in rows if row["figure"] == "worst_solver_residual"]
    assert 0.0 < float(residual["first: value"]) < 1e-5  # what is rounding elsewhere is none here
    (order, _) = [row for row in rows if row["figure"] == "transmission_error_order_1_um"]
    assert order["first: value"] == order["higher: difference"] == ""  # not known
    frame = comparison.to_pandas()
    assert frame.index.names + list(frame) == list(rows[0])
    assert frame.loc[(80.0, "peak_pressure_MPa"), "higher: relative_difference"] == pytest.approx(0.5)


def test_json_has_keys_figures_and_no_nan(comparison, tmp_path):
    write_comparison(comparison, tmp_path)

    def refuse(constant):
        raise AssertionError(constant)

    content = json.loads((tmp_path / "comparison.json").read_text(encoding="utf-8"), parse_constant=refuse)
    assert content["compared_with"] == "first"
    assert content["differing_keys"] == {"mounting.misalignment_um": {"first": 0.0, "higher": 3.0}}
    assert [one["pinion_torque_Nm"] for one in content["torques"]] == [20.0, 80.0]
    figure = content["torques"][1]["figures"]["peak_pressure_MPa"]
    assert_allclose(figure["value"]["higher"], 1.5 * figure["value"]["first"])
    assert set(figure["difference"]) == set(figure["relative_difference"]) == {"higher"}
    assert math.isclose(figure["relative_difference"]["higher"], 0.5)
    assert content["torques"][0]["figures"]["transmission_error_order_1_um"]["value"]["first"] is None


def test_comparison_that_cannot_be_written_is_told(comparison, tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(InputError, match="cannot be made a directory"):
        write_comparison(comparison, tmp_path / "file" / "below")
