"""The validation table holds, row by row."""

import importlib
import pkgutil
import sys
from types import SimpleNamespace

import pytest

import validation
from validation import __main__ as programme
from validation.__main__ import collect
from validation.table import Row, moved, render


@pytest.fixture(scope="module")
def rows():
    return collect()


def test_validation_rows_hold(rows):
    failed = [row for row in rows if not row.holds]
    assert not failed, render(failed)


def test_validation_table_has_a_line_for_every_row(rows):
    assert len(render(rows).splitlines()) == len(rows) + 2


def test_case_that_raises_is_a_row_that_fails_and_the_others_are_run(monkeypatch, capsys):
    def no_rows():
        raise ValueError("f(a) and f(b) must have different signs")

    good = Row("case", "source", "angle", 1.0, 1.0, 1e-3)
    monkeypatch.setitem(sys.modules, "validation.raises", SimpleNamespace(rows=no_rows))
    monkeypatch.setitem(sys.modules, "validation.good", SimpleNamespace(rows=lambda: [good]))
    monkeypatch.setattr(programme, "CASES", ("good", "raises", "no_such_case", "good"))
    monkeypatch.setattr(sys, "argv", ["validation"])
    assert programme.main() == 1
    table, told = capsys.readouterr()
    assert "raised ValueError: f(a) and f(b) must have different signs" in table
    assert "raised ModuleNotFoundError: No module named 'validation.no_such_case'" in table
    assert table.count("FAILS") == 2
    assert "4 rows, 2 beyond the tolerance" in table
    assert "Traceback" in told


@pytest.mark.parametrize(
    ("expected", "obtained", "tolerance", "holds"),
    [
        (2.0, 2.002, 1e-3, True),
        (2.0, 2.0021, 1e-3, False),
        (0.0, 1e-10, 1e-9, True),
        (1.0, float("nan"), 1e-3, False),
        (1.0, 2.0, None, True),
    ],
)
def test_row_holds_within_its_tolerance(expected, obtained, tolerance, holds):
    assert Row("case", "source", "quantity", expected, obtained, tolerance).holds is holds


@pytest.mark.parametrize("folder", [info.name for info in pkgutil.iter_modules(validation.__path__) if info.ispkg])
def test_folder_lists_what_stands_in_it(folder):
    assert f"| `{folder}` |" in validation.__doc__
    package = importlib.import_module(f"validation.{folder}")
    for info in pkgutil.iter_modules(package.__path__):
        assert f"``{info.name}``" in package.__doc__ or info.name == "__main__"


def test_numbers_that_have_moved_are_told():
    before = [Row("case", "source", "angle", 1.0, 2.0, None), Row("case", "source", "length", 0.0, float("nan"), 1e-3)]
    assert moved(before, before) == ["0 numbers moved by more than 1e-09; rows: 2 before, 2 now"]
    now = [Row("case", "source", "angle", 1.0, 2.1, None), Row("case", "source", "length", 1e-15, 0.0, 1e-3)]
    told = moved(now, before)
    assert told[0] == "row 0: case, angle: obtained 2 -> 2.1"
    assert told[1].startswith("row 1: case, length: obtained nan")
    assert len(told) == 3
