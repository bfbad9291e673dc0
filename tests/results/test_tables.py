"""Tables of results as frames of pandas and workbooks of Excel."""

import io
import sys
from dataclasses import replace

import numpy as np
import pandas
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.output.result_files import contacts_csv, positions_csv
from loaded_tca.results.tables import MOST_ROWS, workbook_of
from loaded_tca.studies import to_excel, to_pandas
from tests.samples.results import result
from tests.samples.study_datasets import LEAD, dataset, grid

openpyxl = pytest.importorskip("openpyxl", reason="workbooks: the package openpyxl is not installed")
FORMULA = '=HYPERLINK("http://example.org";"a")'
"""What a spreadsheet would run if it were no text."""


def shared():
    return result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0))


def with_warning(cycle, sentence):
    return replace(cycle, dataset=cycle.dataset.assign_attrs(warnings=sentence))


@pytest.fixture(scope="module")
def workbook(tmp_path_factory):
    """The sheets of a result with warnings that are a formula and have a control character, as a file may."""
    path = with_warning(shared(), f"{FORMULA}\nbell \u0007").to_excel(tmp_path_factory.mktemp("excel") / "result.xlsx")
    return openpyxl.load_workbook(path)


@pytest.mark.parametrize(
    ("name", "written", "index"),
    [
        ("positions", positions_csv, ["pinion_torque_Nm", "position"]),
        ("contacts", contacts_csv, ["pinion_torque_Nm", "position", "tooth_pair"]),
    ],
)
def test_frames_are_the_csv_files_with_all_digits(name, written, index):
    frame, table = shared().to_pandas(name), pandas.read_csv(io.StringIO(written(shared())))
    assert list(frame.index.names) == index
    assert {*frame.reset_index()} == {*table}
    assert frame.index.is_unique
    for head in table.drop(columns="edges", errors="ignore"):
        assert_allclose(frame.reset_index()[head], table[head], rtol=1e-8, atol=1e-6)  # nine digits; zero for rounding


def test_positions_are_the_default_and_figures_have_a_row_for_each_torque():
    cycle = shared()
    assert cycle.to_pandas().equals(cycle.to_pandas("positions"))
    figures = cycle.to_pandas("figures")
    assert figures.index.tolist() == [40.0, 260.0]
    assert figures.index.name == "pinion_torque_Nm"
    assert figures["peak_pressure_MPa"].tolist() == np.nanmax(cycle.peak_pressure, axis=(1, 2)).tolist()


def test_tables_that_a_result_does_not_have_are_refused():
    with pytest.raises(InputError, match=r"table: 'contacts'; the result has figures, positions$"):
        result().to_pandas("contacts")


def test_workbook_has_the_same_numbers_under_the_same_heads(workbook):
    assert workbook.sheetnames == ["figures", "positions", "contacts", "warnings"]
    for name in workbook.sheetnames[:-1]:
        frame = shared().to_pandas(name).reset_index()
        head, *rows = workbook[name].iter_rows(values_only=True)
        assert list(head) == list(frame)
        numbers = frame.select_dtypes("number")
        at = [head.index(column) for column in numbers]
        cells = [[np.nan if row[k] is None else float(row[k]) for k in at] for row in rows]
        assert_allclose(cells, numbers.to_numpy(float), rtol=1e-15)  # a double in its shortest decimals


def test_text_of_a_workbook_is_no_formula_and_has_no_control_characters(workbook):
    cells = {cell.value: cell for row in workbook["warnings"].iter_rows() for cell in row}
    assert cells[FORMULA].data_type == "s"
    assert "bell \N{REPLACEMENT CHARACTER}" in cells
    assert workbook.properties.title == shared().scene.title


def test_warnings_of_a_workbook_say_what_they_mean_and_what_to_do(tmp_path):
    sentence = "the contact reaches the border of its grid (at 1 of 9 pressure maps; the first: 40 N m)"
    path = with_warning(result(), sentence).to_excel(tmp_path / "warned.xlsx")
    table = pandas.read_excel(path, sheet_name="warnings").set_index("kind").loc["warning"]
    assert table["sentence"] == sentence
    assert table["what_to_do"].startswith("less torque")


def test_workbook_that_cannot_be_made_leaves_the_older_one(tmp_path, monkeypatch):
    path = tmp_path / "result.xlsx"
    path.write_bytes(b"older")
    with monkeypatch.context() as patched:
        patched.setitem(sys.modules, "openpyxl", None)
        with pytest.raises(InputError, match=r"needs the package openpyxl; .* extra 'excel'"):
            result().to_excel(path)
    monkeypatch.setattr("loaded_tca.results.tables._laid_out", lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        result().to_excel(path)
    assert [(one.name, one.read_bytes()) for one in tmp_path.iterdir()] == [("result.xlsx", b"older")]


def test_workbooks_of_another_ending_or_with_too_many_rows_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"result\.csv' ends in '\.csv'; a workbook ends in \.xlsx"):
        result().to_excel(tmp_path / "result.csv")
    long = pandas.DataFrame({"a": np.zeros(MOST_ROWS, dtype=bool)})
    with pytest.raises(InputError, match="the sheet contacts has 1048576 rows; a sheet takes 1048575"):
        workbook_of({"contacts": long}, "", "")


def test_frame_of_a_study_has_keys_first_and_counts_as_whole_numbers():
    study = dataset({LEAD: [1.0, 2.0]}, {"positions": [9.0, 9.0], "span_um": [1.0, 2.5]}, ["ok", "refused"])
    frame = to_pandas(study)
    assert frame.index.tolist() == [(0, 0), (1, 0)]
    assert frame.index.names == ["sample", "torque_number"]  # this one has no torques that all variants share
    assert next(iter(frame)) == LEAD
    assert frame["positions"].tolist() == [9, pandas.NA]
    assert frame["span_um"].tolist()[:1] == [1.0]


def test_frame_of_a_study_has_the_torques_that_all_variants_share():
    study = grid(torques=(40.0, 80.2)).assign_coords(torque=[40e3, 1e3 * 80.2])
    frame = to_pandas(study)
    assert frame.index.names == ["sample", "torque_Nm"]
    assert frame.index.tolist() == [(variant, torque) for variant in range(6) for torque in (40.0, 80.2)]
    assert frame["pinion_torque_Nm"].tolist() == 6 * [40.0, 80.2]
    assert "torque" not in frame


def test_workbook_of_a_study_has_variants_ranking_and_counted_warnings(tmp_path):
    study = grid().assign(warnings=("sample", [*["the grid is coarse"] * 2, *[""] * 4]))
    path = to_excel(study, tmp_path / "study.xlsx")
    sheets = pandas.read_excel(path, sheet_name=None)
    assert list(sheets) == ["variants", "ranking", "warnings"]
    assert sheets["variants"][LEAD].tolist() == study[LEAD].values.tolist()
    assert sheets["ranking"]["sample"].iloc[0] == 3
    assert sheets["warnings"]["sentence"].tolist() == ["the grid is coarse (2 of 6 variants)"]


def test_what_is_no_study_has_no_frame_as_one():
    with pytest.raises(InputError, match="study: found a Dataset; allowed what run_study or load_study returns"):
        to_pandas(shared().dataset)
