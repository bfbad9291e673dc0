import csv
import json
import os
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from results import assert_same, result, with_a_gap

from loaded_tca.errors import InputError
from loaded_tca.mesh_cycle import MeshCycle
from loaded_tca.report import positions_csv, summary_json, write_report


def table(cycle):
    return list(csv.DictReader(positions_csv(cycle).splitlines()))


def test_report_is_three_files_and_nothing_else(tmp_path):
    directory = tmp_path / "made" / "here"
    paths = write_report(result(), directory)
    assert [path.name for path in paths] == ["result.nc", "summary.json", "positions.csv"]
    assert sorted(os.listdir(directory)) == sorted(path.name for path in paths)
    assert_same(MeshCycle.load(paths[0]), result())
    assert json.loads(paths[1].read_text(encoding="utf-8"))["title"] == result().title
    assert paths[2].read_bytes() == positions_csv(result()).encode()


def test_report_replaces_an_older_one(tmp_path):
    write_report(result(), tmp_path)
    write_report(with_a_gap(), tmp_path)
    assert_same(MeshCycle.load(tmp_path / "result.nc"), with_a_gap())


def test_file_in_place_of_the_directory_is_told(tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(InputError, match="taken: cannot be made a directory: File exists"):
        write_report(result(), tmp_path / "taken")


def test_table_has_one_row_per_torque_and_position():
    rows = table(result(torques=(20.0, 80.0)))
    assert [(row["pinion_torque_Nm"], row["position"]) for row in rows] == [
        (torque, str(position)) for torque in ("20", "80") for position in range(1, 6)
    ]


def test_table_agrees_with_the_result():
    cycle = result()
    rows = table(cycle)

    def column(name):
        return np.array([float(row[name]) for row in rows])

    nine_digits = {"rtol": 1e-8, "atol": 1e-12}
    assert_allclose(column("pinion_angle_deg"), np.degrees(cycle.pinion_angle), **nine_digits)
    assert_allclose(column("peak_pressure_MPa"), cycle.peak_pressure, **nine_digits)
    arcsec = np.degrees(cycle.transmission_error) * 3600.0
    assert_allclose(column("transmission_error_arcsec"), arcsec, **nine_digits)
    length = cycle.transmission_error * cycle.wheel_base_radius * 1e3
    assert_allclose(column("transmission_error_um"), length, **nine_digits)
    assert_allclose(column("load_share_pair_0"), 1.0, **nine_digits)


def test_every_column_with_a_unit_tells_it():
    pure = {"position", "on_edge", "iterations", "residual", "load_share_pair_0"}
    units = ("_mm", "_MPa", "_N", "_Nm", "_deg", "_arcsec", "_um")
    assert all(name.endswith(units) or name in pure for name in table(result())[0])


def test_positions_that_do_not_touch_are_empty_cells():
    rows = table(with_a_gap())
    assert rows[1]["peak_pressure_MPa"] == ""
    assert rows[1]["pinion_angle_deg"] != ""
    assert "nan" not in positions_csv(with_a_gap())


def test_summary_is_strict_json_with_null_for_the_unknown():
    def refuse(name):
        raise AssertionError(name)

    content = json.loads(summary_json(result("misaligned", positions=2)), parse_constant=refuse)
    (figures,) = content["torques"]
    assert figures["hertz_pressure_there_MPa"] is None
    assert figures["edge_positions"] == 2
    assert content["tooth_pairs_sharing_load"] == 1


def test_summary_keeps_any_script():
    assert json.loads(summary_json(replace(result(), title="歯車 µ")))["title"] == "歯車 µ"
