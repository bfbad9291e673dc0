import csv
import json
import os
import warnings
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.errors import InputError
from loaded_tca.output import describe_results
from loaded_tca.output.result_files import contacts_csv, positions_csv, summary_json, write_report
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import read_scene
from tests.samples.results import SCENES, assert_same, changed, changed_scene, result, with_a_gap


def table(cycle):
    return list(csv.DictReader(positions_csv(cycle).splitlines()))


def shared():
    return result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0))


def contact_rows(cycle):
    return list(csv.DictReader(contacts_csv(cycle).splitlines()))


def test_report_is_three_files_and_nothing_else(tmp_path):
    directory = tmp_path / "made" / "here"
    paths = write_report(result(), directory)
    assert [path.name for path in paths] == ["result.nc", "summary.json", "positions.csv"]
    assert sorted(os.listdir(directory)) == sorted(path.name for path in paths)
    assert_same(MeshCycle.load(paths[0]), result())
    assert json.loads(paths[1].read_text(encoding="utf-8"))["title"] == result().scene.title
    assert paths[2].read_bytes() == positions_csv(result()).encode()


def test_contacts_are_a_fourth_file_where_pairs_share_the_load(tmp_path):
    paths = write_report(shared(), tmp_path)
    assert paths[3].name == "contacts.csv"
    assert paths[3].read_bytes() == contacts_csv(shared()).encode()
    write_report(result(), tmp_path)
    assert not paths[3].exists()


def test_contacts_carry_the_torque_together():
    rows, carried = contact_rows(shared()), {}
    for row in rows:
        at = row["pinion_torque_Nm"], row["position"]
        carried[at] = carried.get(at, 0.0) + float(row["load_share"])
    assert len(carried) == shared().transmission_error.size
    assert_allclose(list(carried.values()), 1.0, rtol=1e-8)  # nine digits


def test_contacts_are_those_of_the_pairs_under_load():
    cycle, rows = shared(), contact_rows(shared())
    assert len(rows) == int((cycle.normal_force > 0.0).sum())
    for row in rows:
        at = (
            [f"{1e-3 * torque:g}" for torque in cycle.torque].index(row["pinion_torque_Nm"]),
            int(row["position"]) - 1,
            cycle.pair.tolist().index(int(row["tooth_pair"])),
        )
        near = {"rtol": 1e-8}  # nine digits
        assert_allclose(float(row["normal_force_N"]), cycle.normal_force[at], **near)
        assert_allclose(float(row["contact_width_mm"]), cycle.contact_width[at], **near)
        assert_allclose(float(row["contact_deformation_um"]), 1e3 * cycle.contact_deformation[at], **near)
        assert_allclose(float(row["contact_point_wheel_diameter_mm"]), 2.0 * cycle.paths[at[2]][at[1]].wheel_radius)
        assert bool(row["edges"]) == (row["on_edge"] == "1") == bool(cycle.on_edge[at])


def test_tooth_pairs_stand_in_the_order_of_the_mesh():
    cycle = shared()
    assert cycle.pair.tolist() == [-1, 0, 1]
    headers = [name for name in table(cycle)[0] if name.startswith("load_share_pair")]
    assert headers == ["load_share_pair_-1", "load_share_pair_0", "load_share_pair_1"]
    for one, other in pairwise(contact_rows(cycle)):
        if one["position"] == other["position"] and one["pinion_torque_Nm"] == other["pinion_torque_Nm"]:
            assert int(one["tooth_pair"]) < int(other["tooth_pair"])


def test_contacts_name_the_tip_that_comes_first_into_mesh():
    early = [row for row in contact_rows(shared()) if row["tooth_pair"] == "1" and "tip" in row["edges"]]
    assert early
    assert {"wheel tip"} == {word for row in early for word in row["edges"].split(" + ") if "tip" in word}


def test_every_column_of_the_contacts_is_in_the_reference_or_tells_its_unit():
    described = describe_results()
    known = {"position", "tooth_pair", "load_share", "edges"}
    units = ("_mm", "_deg", "_Nm")
    for name in contact_rows(shared())[0]:
        assert f"`{name}`" in described or name in known or name.endswith(units)


def test_summary_names_the_pair_at_the_peak():
    (first, *_) = json.loads(summary_json(shared()))["torques"]
    _, column = shared().peak_contact(0)
    assert first["tooth_pair_at_peak"] == shared().pair[column]
    counts = shared().loaded_pairs[0]
    assert (first["fewest_loaded_pairs"], first["most_loaded_pairs"]) == (counts.min(), counts.max())
    (alone,) = json.loads(summary_json(result()))["torques"]
    assert alone["most_loaded_pairs"] is None


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

    nine_digits = {"rtol": 1e-8, "atol": 1e-12}  # atol: what is zero but for rounding
    assert_allclose(column("pinion_angle_deg"), np.degrees(cycle.pinion_angle), **nine_digits)
    assert_allclose(column("peak_pressure_MPa"), cycle.peak_pressure[0, :, 0], **nine_digits)
    arcsec = np.degrees(cycle.transmission_error[0]) * 3600.0
    assert_allclose(column("transmission_error_arcsec"), arcsec, **nine_digits)
    length = cycle.transmission_error[0] * cycle.wheel_base_radius * 1e3
    assert_allclose(column("transmission_error_um"), length, **nine_digits)
    assert_allclose(column("load_share_pair_0"), 1.0, **nine_digits)


def test_every_column_with_a_unit_tells_it():
    pure = {"position", "iterations", "residual", "load_share_pair_0", "cells_across", "cells_along"}
    pure |= {"discretisation_error", "edge_pressure_error"}
    pure |= {"on_edge", "on_relief_start", "edge_is_rounded", "line_load_ratio", "loaded_pairs"}
    units = ("_mm", "_MPa", "_N", "_N_per_mm", "_Nm", "_deg", "_arcsec", "_um", "_N_per_mm_um")
    assert all(name.endswith(units) or name in pure for name in table(result())[0])


def test_table_gives_full_widths_diameters_and_micrometres():
    row, cycle = table(result())[2], result()
    near = {"rtol": 1e-8}  # nine digits
    assert_allclose(float(row["hertz_width_mm"]), 2.0 * cycle.hertz_semi_minor[0, 2, 0], **near)
    assert_allclose(float(row["hertz_length_mm"]), 2.0 * cycle.hertz_semi_major[0, 2, 0], **near)
    assert_allclose(float(row["contact_deformation_um"]), 1e3 * cycle.contact_deformation[0, 2, 0], **near)
    assert_allclose(float(row["peak_pinion_diameter_mm"]), 2.0 * cycle.peak_radius[0, 2, 0], **near)
    assert_allclose(float(row["contact_point_pinion_diameter_mm"]), 2.0 * cycle.path.pinion_radius[2], **near)
    assert_allclose(float(row["central_pressure_MPa"]), cycle.central_pressure[0, 2, 0], **near)


def test_table_shows_zero_for_rounding_but_no_false_residual():
    rows = table(result())
    assert {row["unloaded_transmission_error_arcsec"] for row in rows} == {"0"}
    assert {row["contact_point_pinion_axial_mm"] for row in rows} == {"0"}
    tiny = changed(result(), residual=np.full((1, 5, 1), 1e-12))
    assert {row["residual"] for row in table(tiny)} == {"1e-12"}
    fine = changed(result(), discretisation_error=np.full((1, 5, 1), 7e-7))
    assert {row["discretisation_error"] for row in table(fine)} == {"7e-07"}


def test_line_contact_is_no_longer_than_the_face():
    (row,) = table(result("fzg_c14", positions=1))
    assert float(row["contact_length_mm"]) <= 14.0


def test_table_has_the_pressure_at_an_edge_where_one_is_reached():
    cycle = result("misaligned", positions=2)
    for row, pressure in zip(table(cycle), cycle.edge_pressure[0, :, 0], strict=True):
        assert_allclose(float(row["edge_pressure_MPa"]), pressure, rtol=1e-8)
        assert row["edge_is_rounded"] == "0"
    assert {row["edge_pressure_MPa"] for row in table(result(positions=1))} == {""}


def test_table_and_summary_agree():
    (figures,) = json.loads(summary_json(result()))["torques"]
    row = max(table(result()), key=lambda row: float(row["peak_pressure_MPa"]))
    same = {"peak_pressure_MPa": "peak_pressure_MPa", "contact_deformation_at_peak_um": "contact_deformation_um"}
    same |= {"contact_length_at_peak_mm": "contact_length_mm", "hertz_width_there_mm": "hertz_width_mm"}
    for figure, column in same.items():
        assert_allclose(figures[figure], float(row[column]), rtol=1e-8)


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


def test_counts_are_whole_numbers():
    counts = ("cells", "positions", "most_solver_iterations", "loaded_pairs", "most_loaded", "fewest_loaded")
    for cycle in (result(), shared()):
        figures = json.loads(summary_json(cycle))["torques"][0]
        found = {name: value for name, value in figures.items() if name.startswith(counts) or "_cells_" in name}
        assert len(found) > 6
        assert all(value is None or type(value) is int for value in found.values()), found


def test_full_disk_leaves_the_earlier_report_as_it_was(tmp_path, monkeypatch):
    write_report(shared(), tmp_path)
    (tmp_path / "load_share.png").write_bytes(b"of this report")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def full(path, _):
        raise OSError(28, "No space left on device", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_bytes", full)
        with pytest.raises(InputError, match="cannot be written: No space left on device"):
            write_report(result(), tmp_path, outdated=["load_share.png"])
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    write_report(result(), tmp_path, outdated=["load_share.png"])
    assert sorted(os.listdir(tmp_path)) == ["positions.csv", "result.nc", "summary.json"]


def test_summary_says_what_the_stiffness_is():
    assert json.loads(summary_json(result()))["mesh_stiffness_is"].endswith("teeth do not bend")


def test_summary_tells_the_bores_that_are_held_where_teeth_bend():
    told = [
        json.loads(summary_json(changed_scene(result(), {"analysis.compliance": compliance})))
        for compliance in ("contact+tooth", "contact")
    ]
    pinion, wheel = told[0]["rigid_bore_diameters_mm"]
    assert 0.0 < pinion < wheel
    assert told[1]["rigid_bore_diameters_mm"] is None


def test_every_key_figure_is_in_the_reference():
    page = (Path(__file__).parents[2] / "docs" / "reference" / "key_figures.md").read_text(encoding="utf-8")
    content = json.loads(summary_json(shared()))
    keys = {*content, *(key for figures in content["torques"] for key in figures)} - {"torques"}
    orders = {f"transmission_error_order_{order}_um" for order in (2, 3)}  # shown by the first
    assert [key for key in sorted(keys - orders) if f"`{key}`" not in page] == []


@pytest.mark.quick_cases("misaligned-changes1")
@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("misaligned", {"analysis.cells": (6, 6)}),
        ("misaligned", {"analysis.cells": (20, 20), "load.pinion_torque_Nm": 1e5}),
        ("mesh_cycle_spur", {"pinion.modifications.tip_relief_form": "linear", "analysis.cells": (20, 20)}),
    ],
)
def test_every_warning_of_an_analysis_is_explained(name, changes):
    page = (Path(__file__).parents[2] / "docs" / "reference" / "warnings.md").read_text(encoding="utf-8")
    scene = read_scene(SCENES / f"{name}.toml").with_changes({"analysis.positions": 5, **changes})
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        analyse(scene)
    sentences = {str(entry.message).rpartition(" (at ")[0] for entry in caught}
    assert sentences
    assert [sentence for sentence in sentences if sentence not in page] == []


def test_every_column_is_in_the_reference():
    described = describe_results()
    own = [name for name in table(result())[0] if "contact_point" not in name and "load_share" not in name]
    derived = {"position", "pinion_angle_deg", "unloaded_transmission_error_arcsec", "unloaded_transmission_error_um"}
    derived |= {"transmission_error_um"}
    assert [name for name in own if f"`{name}`" not in described and name not in derived] == []


def test_summary_keeps_any_script():
    assert json.loads(summary_json(changed_scene(result(), {"title": "歯車 µ"})))["title"] == "歯車 µ"
