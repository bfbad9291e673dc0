"""Pages that scripts write: tables, times, the command line."""

import itertools
import sys

import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

import loaded_tca
from validation import page as module
from validation.page import (
    ROOT,
    SPACED,
    Page,
    formatted,
    in_a_process,
    lines,
    median_ratio,
    medians,
    peak_memory,
    table,
    take_times,
    take_turns,
    timed,
    write_page,
)


def package_path():
    """Where the package was loaded from."""
    return loaded_tca.__file__


def ticking():
    """A clock on which 1, 2, 3, ... seconds pass between one call and the next."""
    return itertools.accumulate(itertools.count()).__next__


def test_a_table_has_a_rule_and_a_line_for_each_row():
    made = table("pair | error [um]", [("spur", 0.5), "helical | 1", iter(["bevel", ""])])
    assert made == "| pair | error [um] |\n|---|---|\n| spur | 0.5 |\n| helical | 1 |\n| bevel |  |"
    assert table(["a", "", "c"], [], SPACED) == "| a |  | c |\n| --- | --- | --- |"
    assert lines([["a", 1], ["b", 2]]) == "| a | 1 |\n| b | 2 |"


def test_numbers_have_one_format():
    assert formatted("+.2f", 1.0, -0.126) == ["+1.00", "-0.13"]


def test_a_page_is_written_with_its_pictures(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["script", "--out", str(tmp_path / "new"), "--runs", "7"])
    given = []

    def make(runs, most_cells, before):
        given.append((runs, most_cells, before))
        return Page("study", "# Über\n", {"picture": Figure(figsize=(2.0, 1.0))}, dots_per_inch=50)

    write_page("First line.\n\nMore.", make, runs=3, most_cells=2.5, before=str)
    assert given == [(7, 2.5, None)]
    assert (tmp_path / "new" / "study.md").read_bytes() == "# Über\n".encode()
    assert imread(tmp_path / "new" / "picture.png").shape[:2] == (50, 100)
    assert capsys.readouterr().out == "# Über\n\n"


def test_pictures_alone_leave_the_page_as_it_is(tmp_path, monkeypatch):
    (tmp_path / "study.md").write_text("by hand")
    monkeypatch.setattr(sys, "argv", ["script", "--out", str(tmp_path)])
    write_page(None, lambda: Page("study", None, {"picture": Figure()}))
    assert (tmp_path / "study.md").read_text() == "by hand"
    assert (tmp_path / "picture.png").exists()


def test_an_unknown_option_is_refused(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["script", "--starts", "3"])
    with pytest.raises(SystemExit):
        write_page("Title.", lambda: pytest.fail("nothing is measured"), runs=1)
    assert "--starts" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("runs", "least", "budget", "taken"),
    [
        (1, 1, 100.0, [1]),
        (4, 1, 100.0, [1, 3, 5, 7]),
        (4, 1, 4.0, [1, 3]),
        (4, 3, 0.0, [1, 3, 5]),
    ],
)
def test_runs_end_when_the_time_is_spent(runs, least, budget, taken):
    results = itertools.count()
    found = timed(lambda: next(results), runs, least=least, budget=budget, clock=ticking())
    assert found == (len(taken) - 1, taken)


def test_calls_take_turns():
    order = []
    calls = {"now": lambda: order.append("now"), "before": lambda: order.append("before")}
    assert take_times(calls, 2, ticking()) == {"now": [1, 5], "before": [3, 7]}
    assert order == ["now", "before"] * 2
    assert take_turns({"a": lambda: 1}, 3) == {"a": [1, 1, 1]}


def test_ratios_are_of_the_same_run():
    assert medians({"now": [3.0, 1.0, 2.0], "before": [1.0, 2.0]}) == {"now": 2.0, "before": 1.5}
    assert median_ratio([1.0, 4.0, 30.0], [1.0, 1.0, 10.0]) == 3.0


@pytest.mark.thorough
def test_a_process_of_its_own_takes_the_package_of_a_checkout(tmp_path):
    (tmp_path / "loaded_tca").mkdir()
    other = tmp_path / "loaded_tca" / "__init__.py"
    other.touch()
    assert in_a_process(module.formatted, ".1f", 2.0) == ["2.0"]
    assert in_a_process(package_path) == str(ROOT / "loaded_tca" / "__init__.py")
    assert in_a_process(package_path, tree=tmp_path) == str(other)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the kernel of Linux counts the memory")
def held_beyond_the_peak():
    before = peak_memory()
    held = bytearray(b"x") * (int(before * 2**30) + 2**26)
    after = peak_memory()
    del held
    return after - before


@pytest.mark.thorough
def test_peak_memory_grows_by_what_is_held():
    """Of a process of its own: the peak of this one is that of all tests before."""
    assert in_a_process(held_beyond_the_peak) > 2**-5
