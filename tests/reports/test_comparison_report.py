"""The report of several results: what differs, key figures side by side with their marks, pictures."""

import re
from html import unescape
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from loaded_tca import cli
from loaded_tca.errors import InputError
from loaded_tca.reports import comparison_page, write_html_report
from loaded_tca.reports import page as report_page
from loaded_tca.results import compare_results
from tests.samples.results import changed, changed_scene, result

pytest.importorskip("jinja2", reason="reports: the package jinja2 is not installed")
NAME = "<script>alert(1)</script> & b"
"""Of a result, as --names may be."""


def cycle():
    return result("mesh_cycle_spur", positions=5, torques=(40.0, 130.0))


def with_error(times=1.0):
    peaks, error = times * cycle().peak_pressure, np.full_like(cycle().discretisation_error, 0.01)
    return changed(cycle(), peak_pressure=peaks, discretisation_error=error)


def rows(text):
    """Cells of all rows of all tables."""
    cells = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in re.findall(r"<tr[^>]*>(.*?)</tr>", text)]
    return [[unescape(cell).replace("\N{NO-BREAK SPACE}", " ") for cell in row] for row in cells]


@pytest.fixture
def written(tmp_path, monkeypatch):
    """Write a report with the place of a picture, but without drawing it."""
    monkeypatch.setattr(report_page, "svg_of", lambda *_: "<svg></svg>")
    monkeypatch.setattr(comparison_page, "comparison_figures", lambda *_: {"compared_maps": Figure()})

    def written(results, **options):
        path = write_html_report(compare_results(results), tmp_path / "both.html", **options)
        return path.read_text(encoding="utf-8")

    return written


def test_report_has_what_differs_and_key_figures_of_every_shared_torque(written):
    crowned = changed_scene(with_error(1.5), {"pinion.modifications.lead_crowning_um": 7.5})
    text = written({"a": with_error(), NAME: crowned})
    table = rows(text)
    assert ["pinion lead crowning [µm]", "pinion.modifications.lead_crowning_um", "5.0", "7.5"] in table
    peaks = np.nanmax(cycle().peak_pressure, axis=(1, 2))
    pressure = [row for row in table if row[0] == "peak pressure [MPa]"]
    assert [row[1:3] for row in pressure] == [[f"{one:.4g}", f"{1.5 * one:.4g}"] for one in peaks[::-1]]
    assert [row[3].split()[1:] for row in pressure] == [["(+50.0", "%)", "●"]] * 2
    assert ["peak pressure", "1.00%", "1.00%"] in table
    assert comparison_page.COMPARISON_PICTURES["compared_maps"].caption in text


def test_names_and_titles_are_text(written):
    text = written({"a": with_error(), NAME: with_error(1.01)})
    assert "<script>" not in text
    assert text.count("&lt;script&gt;alert(1)&lt;/script&gt; &amp; b") > 2
    assert " ○</td>" in text  # 1 % of errors of 1 % each


def test_scenes_that_do_not_differ_and_many_torques_are_told(written):
    torques = (10.0, 20.0, 30.0, 40.0)
    one = result(torques=torques)
    text = written({"a": one, "b": one}, torque=20e3)
    assert "Nothing but the title, the torques or the version" in text
    assert re.findall(r"<caption>Under (\S+) N m", text) == ["20", "40", "10"]
    assert "The table of <code>loaded-tca compare</code> has all torques." in text


def test_many_results_stand_in_several_tables(written):
    text = written({name: cycle() for name in "abcdef"})
    heads = [row[:2] + row[2::2] for row in rows(text) if "difference" in row]
    assert heads == [["", "a", "b", "c", "d"], ["", "a", "e", "f"]] * 2


def test_torque_that_a_report_does_not_take_is_refused(tmp_path):
    with pytest.raises(InputError, match="torque: 50 N m; the results share 40, 130 N m"):
        write_html_report(compare_results([cycle(), cycle()]), tmp_path / "a.html", torque=50e3)
    with pytest.raises(InputError, match=r"torque: 40000\.0; a MeshCycle has all torques"):
        write_html_report(cycle(), tmp_path / "a.html", torque=40e3)
    assert not any(tmp_path.iterdir())


def test_command_writes_the_report_of_several_results(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(comparison_page, "comparison_figures", lambda *_: {})
    for name in ("old", "new"):
        Path(name).mkdir()
        cycle().save(Path(name, "result.nc"))
    assert cli.main(["report", "old", "new/result.nc", "--out", "both.html", "--torque", "40"]) == 0
    assert capsys.readouterr().out == "Written to .: both.html\n"
    assert ["", "old", "new", "difference"] in rows(Path("both.html").read_text(encoding="utf-8"))
    for arguments, said in (
        (["old", "new"], "--out: missing; several results have no directory in common, give a file"),
        (["old", "new", "--out", "new/result.nc"], "--out: new/result.nc: would replace the input"),
        (
            ["old", "new", "--out", "a.html", "--rank-by", "x"],
            "--rank-by: only for a study; a comparison has no ranking",
        ),
        (
            ["old", "new", "--out", "a.html", "--axes", "x", "y"],
            "--axes: only for a study; a comparison varies no keys",
        ),
        (["old", "new", "--out", "a.html", "--coast", "b"], "--coast: only for one result; a comparison has no rating"),
        (["old", "--coast", "new", "--out", "new/result.nc"], "--out: new/result.nc: would replace the input"),
        (["old", "--coast", "new", "--interactive"], "coast: not allowed; the interactive page has no rating"),
        (["old", "new", "--out", "a.html", "--names", "b"], "--names b: 2 results need 2 different names"),
        (["old", "--torque", "40"], "--names, --torque: only for a comparison; give two results or more"),
    ):
        assert cli.main(["report", *arguments]) == 2
        assert said in capsys.readouterr().err
    assert not Path("a.html").exists()
