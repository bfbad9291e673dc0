"""Tables of a study: a row for every variant and torque, the failed ones too."""

import csv

import numpy as np
import pytest

from loaded_tca.errors import InputError
from loaded_tca.output.tables import write_study
from tests.samples.study_datasets import LEAD, dataset, grid


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_tables_hold_every_variant_and_torque(tmp_path):
    study = grid(["ok", "refused", *["ok"] * 4], torques=(40.0, 80.0))
    written = write_study(study, tmp_path, {"study_ranking.png": b"picture"})
    assert [path.name for path in written] == ["study.csv", "ranking.csv", "study_ranking.png"]
    table = rows(tmp_path / "study.csv")
    index = [(row["sample"], row["torque_number"]) for row in table]
    assert index == [(str(k), str(t)) for k in range(6) for t in (0, 1)]
    assert [float(table[5][name]) for name in (LEAD, "peak_pressure_MPa")] == [3.0, 530.0]
    assert (table[2]["peak_pressure_MPa"], table[2]["reason"]) == ("", "it is refused")
    ranking = rows(tmp_path / "ranking.csv")
    assert [row["rank"] for row in ranking] == ["1", "2", "3", "4", "5", ""]
    assert ranking[0]["sample"] == "3"


def test_table_begins_with_the_keys_and_has_whole_numbers_for_counts(tmp_path):
    figures = {"positions": [9.0, 9.0, 9.0], "edge_is_rounded": [0.0, 1.0, 0.0], "span_um": [1.0, 2.5, np.inf]}
    write_study(dataset({LEAD: [1.0, 2.0, 3.0]}, figures, ["ok", "refused", "ok"]), tmp_path)
    table = rows(tmp_path / "study.csv")
    assert list(table[0])[:3] == ["sample", "torque_number", LEAD]
    assert [[row[name] for row in table] for name in figures] == [["9", "", "9"], ["0", "", "0"], ["1.0", "", "inf"]]


def test_pictures_of_an_earlier_study_are_removed(tmp_path):
    for name in ("study_lines_a.png", "other.png"):
        (tmp_path / name).write_bytes(b"old")
    write_study(grid(), tmp_path, rank_by="peak_pressure_MPa", largest_is_best=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["other.png", "ranking.csv", "study.csv"]
    assert rows(tmp_path / "ranking.csv")[0]["sample"] == "5"


def test_study_of_which_nothing_is_ok_has_its_tables(tmp_path):
    study = dataset({LEAD: [0.0, 3.0]}, {}, ["refused"] * 2).drop_vars("pinion_torque_Nm")
    write_study(study, tmp_path, rank_by="peak_pressure_MPa")
    for name in ("study.csv", "ranking.csv"):
        assert [row["status"] for row in rows(tmp_path / name)] == ["refused"] * 2


def test_nothing_is_written_for_an_unknown_figure(tmp_path):
    with pytest.raises(InputError, match="anything"):
        write_study(grid(), tmp_path, rank_by="anything")
    assert list(tmp_path.iterdir()) == []
