"""The validation table holds, row by row."""

import importlib
import pkgutil
import subprocess
import sys
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from functools import cache, partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import validation
from loaded_tca.flanks import removal
from validation import __main__ as programme
from validation import cases
from validation.cases import Outcome, run_case, run_cases, times
from validation.loaded import limits
from validation.table import Row, moved, render
from validation.unloaded import reduced_tca_tables

ROOT = Path(__file__).parents[2]
# The dissertation's crownings are as thick as a tooth.
pytestmark = pytest.mark.filterwarnings("ignore:.*is more than 1 mm:loaded_tca.errors.AccuracyWarning")


LEAST = {"loaded.root_stress": 60, "loaded.root_stress_cycle": 8, "loaded.root_stress_space": 12}
LEAST |= {"loaded.root_face_load": 5, "calculix.mesh_cycle": 14, "calculix.helical_relief": 11}
"""Rows of cases that have none, or fewer, where a kept table or a part of them is missing."""


short_rows = cache(partial(run_case, which="short_rows"))


DEAR = {
    "calculix.helical_relief",
    "contact.subsurface",
    "loaded.face_ends_space",
    "cylindrical.rack",
    "rating.bevel_solved",
    "rating.spectra",
    "rating.stage_spectra",
    "loaded.error_estimates",
    "unloaded.convergence_from_random_starts",
    "unloaded.involute_pairs",
    "unloaded.internal_pairs",
    "unloaded.reduced_tca_tables",
    "bevel.convergence",
    "bevel.miter_gear_paper",
    "bevel.mounting_errors",
    "bevel.pressure",
    "face_milled.settings",
    "face_milled.swept_cutter",
    "face_milled.duplex_paper",
    "face_milled.hypoid_pair",
    "face_milled.synthesis",
    "face_milled.measured_settings",
    "loaded.limits",
    "loaded.revolution",
    "loaded.rolling_bearings",
    "loaded.cut_contacts",
    "loaded.mesh_stiffness",
    "loaded.local_term",
    "loaded.ring_teeth",
    "loaded.internal_cycle",
    "loaded.root_stress",
    "loaded.root_stress_cycle",
    "loaded.root_stress_space",
    "loaded.root_stress_precision",
    "rating.stages",
    "loaded.root_face_load",
    "loaded.numbers_to_copy",
    "calculix.mesh_cycle",
    "contact.free_block",
    "contact.rounded_edge",
    "contact.wedge",
}
"""Of a second or more each: quicker tests see the faults of what they judge, and make validate has all their rows."""


@pytest.mark.quick_cases(*(case for case in programme.CASES if case not in DEAR))
@pytest.mark.parametrize("case", programme.CASES)
def test_validation_rows_hold(case):
    outcome = short_rows(case)
    failed = [row for row in outcome.rows if not row.holds]
    assert not failed, outcome.traceback + render(failed)
    assert len(outcome.rows) >= LEAST.get(case, 1)


def test_short_and_whole_rows_are_those_of_the_table_where_a_case_has_no_others(monkeypatch):
    some, few, all_rows = ([Row("case", "source", name, 1.0, 1.0, None)] for name in ("some", "few", "all"))
    long = SimpleNamespace(rows=lambda: some, short_rows=lambda: few, whole_rows=lambda: all_rows)
    for name, module in (("long", long), ("plain", SimpleNamespace(rows=lambda: some))):
        monkeypatch.setitem(sys.modules, f"validation.{name}", module)
    assert run_case("long", "short_rows").rows == few
    assert run_case("long", "whole_rows").rows == all_rows
    for which in ("rows", "short_rows", "whole_rows"):
        assert run_case("plain", which).rows == run_case("long").rows == some
        assert run_cases(["plain"], which=which)["plain"].rows == some


def test_command_runs_the_whole_cases_when_asked(monkeypatch, capsys):
    some, all_rows = ([Row("case", "source", name, 1.0, 1.0, None)] for name in ("a few seeds", "every seed"))
    monkeypatch.setitem(sys.modules, "validation.long", SimpleNamespace(rows=lambda: some, whole_rows=lambda: all_rows))
    monkeypatch.setattr(programme, "CASES", ("long",))
    monkeypatch.setattr(programme, "LONG", ())
    for options, what in (([], "a few seeds"), (["--whole"], "every seed")):
        monkeypatch.setattr(sys, "argv", ["validation", "--processes", "1", *options])
        assert programme.main() == 0
        assert what in capsys.readouterr().out


def test_case_that_raises_among_its_rows_has_failed(monkeypatch):
    """Some cases make their rows one by one."""

    def rows():
        yield Row("case", "source", "angle", 1.0, 1.0, None)
        raise ValueError("no second row")

    monkeypatch.setitem(sys.modules, "validation.one_by_one", SimpleNamespace(rows=rows))
    (row,) = run_case("one_by_one").rows
    assert row.quantity == "raised ValueError: no second row"


def test_validation_table_has_a_line_for_every_row():
    outcomes = run_cases(["contact.sphere", "cylindrical.sam_paper"])
    rows = [row for outcome in outcomes.values() for row in outcome.rows]
    assert len(render(rows).splitlines()) == len(rows) + 2


def test_case_that_raises_is_a_row_that_fails_and_the_others_are_run(monkeypatch, capsys):
    def no_rows():
        raise ValueError("f(a) and f(b) must have different signs")

    good = Row("case", "source", "angle", 1.0, 1.0, 1e-3)
    monkeypatch.setitem(sys.modules, "validation.raises", SimpleNamespace(rows=no_rows))
    monkeypatch.setitem(sys.modules, "validation.good", SimpleNamespace(rows=lambda: [good]))
    monkeypatch.setattr(programme, "CASES", ("good", "raises"))
    monkeypatch.setattr(programme, "LONG", ("no_such_case", "good"))
    monkeypatch.setattr(sys, "argv", ["validation", "--processes", "1"])
    assert programme.main() == 1
    table, told = capsys.readouterr()
    assert "raised ValueError: f(a) and f(b) must have different signs" in table
    assert "raised ModuleNotFoundError: No module named 'validation.no_such_case'" in table
    assert table.count("FAILS") == 2
    assert "4 rows, 2 beyond the tolerance" in table
    assert "Traceback" in told
    assert "/4] good: 1 rows, 0 beyond the tolerance" in told
    assert "raised ValueError: f(a) and f(b) must have different signs" in told.splitlines()[-1]
    listed = [line.split()[1:] for line in table.splitlines() if line.endswith(("  good", "  raises"))]
    assert sorted(listed) == [["1", "good"], ["1", "raises"]]


def test_cases_in_two_processes_have_the_rows_of_one(capsys):
    """Whichever ends first; one of them raises an error."""
    cases = ["cylindrical.sam_paper", "no_such_case", "contact.sphere"]
    outcomes = run_cases(cases, processes=2)
    assert list(outcomes) == cases
    assert outcomes["contact.sphere"].rows == run_case("contact.sphere").rows
    assert "No module named 'validation.no_such_case'" in outcomes["no_such_case"].rows[0].quantity
    told = capsys.readouterr().err
    assert [f"[{number}/3]" in told for number in (1, 2, 3)] == [True] * 3
    assert "Traceback" in told


@pytest.mark.thorough
def test_command_runs_the_named_cases_in_two_processes():
    names = ["cylindrical.fzg_c14_geometry", "cylindrical.fzg_c14_root_stress"]
    done = subprocess.run([sys.executable, "-m", "validation", *names], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert ", 0 beyond the tolerance; " in done.stdout.splitlines()[-1]
    assert all(f"  {name}\n" in done.stdout for name in names)


def test_unknown_case_is_refused(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["validation", "contact.spheres"])
    with pytest.raises(SystemExit, match="2"):
        programme.main()
    assert f"no case contact.spheres; there are {programme.CASES[0]}, " in capsys.readouterr().err


class Dying:
    """A pool whose processes die."""

    def __init__(self, *_):
        pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def submit(self, *_):
        future = Future()
        future.set_exception(BrokenProcessPool("A process was terminated abruptly"))
        return future

    def shutdown(self, **_):
        pass


def test_case_whose_process_dies_has_failed(monkeypatch):
    monkeypatch.setattr(cases, "ProcessPoolExecutor", Dying)
    outcomes = run_cases(["contact.sphere", "cylindrical.sam_paper"], processes=2)
    assert [[row.holds for row in outcome.rows] for outcome in outcomes.values()] == [[False], [False]]
    assert "raised BrokenProcessPool: A process was terminated" in outcomes["contact.sphere"].rows[0].quantity


def test_number_of_processes_is_positive(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["validation", "--processes", "0"])
    with pytest.raises(SystemExit, match="2"):
        programme.main()
    assert "--processes: 0 is not positive" in capsys.readouterr().err


def test_times_list_the_longest_case_first():
    row = Row("case", "source", "angle", 1.0, 1.0, None)
    lines = times({"quick": Outcome([row], 0.25), "slow": Outcome([row, row], 1234.5)}).splitlines()
    assert [line.split() for line in lines] == [
        ["seconds", "rows", "case"],
        ["1234.5", "2", "slow"],
        ["0.2", "1", "quick"],
    ]


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


def test_line_of_a_row_tells_its_tolerance_in_two_digits_its_note_and_what_is_assumed():
    line = render([Row("case", "source", "angle", 2.0, 2.03, 0.025, "a load", "sign ignored")]).splitlines()[-1]
    assert line.endswith("2.5e-02  ok; sign ignored; assumed: a load")


def test_row_without_tolerance_is_shown_without_a_verdict():
    (line,) = render([Row("case", "source", "angle", 1.0, 2.0, None)]).splitlines()[2:]
    assert line.endswith("-        shown")
    assert "ok" not in line


def test_rows_are_known_by_their_names_where_others_came_or_went():
    angle, length = (Row("case", "source", name, 1.0, 2.0, None) for name in ("angle", "length"))
    told = moved([length, length], [angle, length])
    assert told == [
        "- case, angle (source)",
        "+ case, length (source)",
        "0 numbers moved by more than 1e-09; rows: 2 before, 2 now",
    ]


def test_logarithmic_steepness_is_judged(monkeypatch):
    monkeypatch.setattr(removal, "LOGARITHMIC_STEEPNESS", 0.97)
    reduced_tca_tables.pair.cache_clear()
    row = reduced_tca_tables._logarithmic_shift(reduced_tca_tables.LINES[9])
    reduced_tca_tables.pair.cache_clear()
    assert not row.holds


@pytest.mark.thorough
def test_maxima_of_tables_3_and_4_say_what_they_judge():
    rows = [row for row in short_rows("unloaded.reduced_tca_tables").rows if "TE(0)" in row.quantity]
    judged = [row for row in rows if row.tolerance is not None]
    assert (len(rows), len(judged)) == (54, 48)
    for row in judged:
        assert row.tolerance == 0.03
        assert row.note == "48 rows, six slopes; sign ignored"
        assert "(inferred)" in row.assumed


@pytest.mark.thorough
def test_start_values_that_are_given_are_not_judged():
    assert not any("theta_p" in row.quantity for row in short_rows("face_milled.duplex_paper").rows)


def test_torque_of_the_pressures_is_their_moment_about_the_axis_of_the_pinion():
    points, axes = np.array([[[30.0, 4.0, 1.0]], [[50.0, 4.0, 9.0]]]), np.array([[1.0, 0, 0], [0, 0, 1.0], [0, 1.0, 0]])
    loaded = SimpleNamespace(
        separation=SimpleNamespace(points=points, axes=axes),
        solution=SimpleNamespace(pressure=np.array([[100.0], [200.0]]), cell_area=0.1),
    )
    np.testing.assert_allclose(limits._torque(loaded), 0.1 * (100.0 * 30.0 + 200.0 * 50.0))


def test_numbers_that_have_moved_are_told():
    before = [Row("case", "source", "angle", 1.0, 2.0, None), Row("case", "source", "length", 0.0, float("nan"), 1e-3)]
    assert moved(before, before) == ["0 numbers moved by more than 1e-09; rows: 2 before, 2 now"]
    now = [Row("case", "source", "angle", 1.0, 2.1, None), Row("case", "source", "length", 1e-15, 0.0, 1e-3)]
    told = moved(now, before)
    assert told[0] == "row 0: case, angle: obtained 2 -> 2.1"
    assert told[1].startswith("row 1: case, length: obtained nan")
    assert len(told) == 3
