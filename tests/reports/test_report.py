"""Reports: all that a customer asks for is on one page, and the page needs nothing else."""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from html import escape
from html.parser import HTMLParser
from pathlib import Path
from string import Formatter

import numpy as np
import pytest
import xarray
from matplotlib.figure import Figure

from loaded_tca import analyse, cli, load_result, read_scene, warning_kinds
from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.plots import plot_pressure_map, plot_transmission_error
from loaded_tca.plots.style import label_of
from loaded_tca.reports import page as report_page
from loaded_tca.reports import report as report_module
from loaded_tca.reports import result_page, write_html_report
from loaded_tca.reports.page import Table, parts_of, tables_of
from loaded_tca.reports.report import study_tables
from loaded_tca.results.figure import COMPARED
from loaded_tca.results.figures import FIGURES
from loaded_tca.results.summary import known_rows, shown
from loaded_tca.studies.design import DesignResult
from loaded_tca.warning_kinds import KINDS, kind_of
from tests.samples.results import SCENES, changed, changed_scene, result
from tests.samples.study_datasets import LEAD, MISALIGNMENT, TIP, dataset, grid, sampled

ROOT = Path(__file__).parents[2]
TORQUES = (20.0, 80.0, 130.0)
WHEN = "2026-03-04T05:06:07+00:00"
VOID = {"meta", "br", "link"}


class Page(HTMLParser):
    """Texts, tables, attributes of all elements of a page; fails where elements do not close in order."""

    def __init__(self, path):
        super().__init__()
        self.open, self.attributes, self.text, self.tables, self.headings = [], [], [], [], []
        self.feed(Path(path).read_text(encoding="utf-8"))
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.attributes += [(tag, name, value) for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("td", "th"):
            self.tables[-1][-1].append("")

    def handle_startendtag(self, tag, attrs):
        self.attributes += [(tag, name, value) for name, value in attrs]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        data = data.replace("\N{NO-BREAK SPACE}", " ")
        if {"td", "th"} & set(self.open):
            self.tables[-1][-1][-1] += data
        if "style" not in self.open:
            self.text.append(data)
        if self.open and self.open[-1] in ("h1", "h2"):
            self.headings.append(data)

    @property
    def words(self):
        return " ".join("".join(self.text).split())

    def rows(self, label):
        return [row for table in self.tables for row in table if row and row[0] == label]


def cycle():
    return result("mesh_cycle_helical", 5, TORQUES)


def undrawn(_, prefix, title):
    """In the place of the drawing of a picture, which takes most of the time of a report."""
    return f'<svg id="{prefix}" role="img" aria-label="{escape(title)}"></svg>'


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """The report of a mesh cycle under three torques, with contacts at edges; few of its pictures are drawn."""
    draw = report_page.svg_of
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(report_page, "svg_of", lambda *one: (draw if one[1] in DRAWN else undrawn)(*one))
        return write_html_report(cycle(), tmp_path_factory.mktemp("report") / "cycle.html", date=WHEN)


@pytest.fixture(scope="module")
def page(path):
    return Page(path)


DRAWN = ("load-share", "peak-pressure", "pressure-map")
"""Of the report of a mesh cycle: curves, and two of an image."""
STUDY_PICTURES = ("study_ranking", "study_lines_peak_pressure_MPa")


@pytest.fixture
def with_one_picture(monkeypatch):
    """Of a result; of studies and designs they are empty, and none is drawn."""
    monkeypatch.setattr(report_page, "svg_of", undrawn)
    monkeypatch.setattr(report_module, "plot_study", lambda *_, **__: dict.fromkeys(STUDY_PICTURES, Figure()))
    for name in ("plot_before_and_after", "plot_peak_to_peak_over_torque"):
        monkeypatch.setattr(report_module, name, lambda _: Figure())
    monkeypatch.setattr(
        result_page, "result_figures", lambda result, **_: {"transmission_error": plot_transmission_error(result)}
    )


@pytest.fixture
def written(tmp_path, with_one_picture):  # noqa: ARG001
    def written(subject, **options):
        return Page(write_html_report(subject, tmp_path / "report.html", **options))

    return written


def test_report_has_its_sections_in_order(page):
    sections = ["Load cases", "What was asked", "Geometry", "Key figures", "Accuracy", "Accuracy warnings", "Pictures"]
    assert page.headings == [cycle().scene.title, *sections, "Appendix: scene file"]


def test_every_table_scrolls_in_its_own_box(page):
    """On a telephone a table is wider than the page, whose other parts shall not move with it."""
    assert page.attributes.count(("div", "class", "box")) == len(page.tables) > 5


def test_every_figure_of_the_summary_is_there_with_its_unit(page):
    figures = cycle().key_figures()
    names = [name for _, names in known_rows(figures) for name in names if name != "pinion_torque_Nm"]
    assert len(names) > 30
    for name in names:
        values = [shown(one[name], name) for one in figures]
        label = label_of(name) + " [%]" * FIGURES[name].is_part
        assert values in [row[1 : 1 + len(TORQUES)] for row in page.rows(label)], name
        unit = re.search(r"_(MPa|deg|mm|um|arcsec|N)$", name)
        assert unit is None or label_of(name).endswith("]")


def test_every_torque_has_its_load_case(page):
    (table,) = [table for table in page.tables if table[0][0] == "pinion torque [N m]" and len(table[0]) > 4]
    assert [row[0] for row in table[1:]] == ["20", "80", "130"]
    force = table[0].index("normal force F_bn [N]")
    mesh = cycle().scene.mesh()
    assert [row[force] for row in table[1:]] == [f"{mesh.normal_force(1e3 * torque):.1f}" for torque in TORQUES]


def test_geometry_is_that_of_the_standards(page, written):
    """The reference diameter is m_n z/cos beta."""
    (diameters,) = page.rows("reference diameter d [mm]")
    assert [float(cell) for cell in diameters[1:]] == pytest.approx(
        [3.0 * teeth / np.cos(np.radians(15.0)) for teeth in (34, 57)], abs=5e-5
    )
    assert "Geometry (ISO 21771)" in page.words
    bevel = written(result("spiral_bevel", 1))
    assert "Geometry (depths by outer modules, about one apex)" in bevel.words
    assert bevel.rows("cone distances R_e, R_m, R_i [mm]")


def test_scene_file_is_there_in_full(page):
    assert " ".join(cycle().scene.to_toml().split()) in page.words


def test_mesh_dependent_figures_are_marked(page):
    (edge,) = page.rows("edge pressure [MPa]")
    assert edge[-1] == "mesh-dependent at sharp edges: not for rating"
    (load,) = page.rows("line load at largest force [N/mm]")
    assert load[-1].startswith("mesh-dependent")
    (peak,) = page.rows("peak pressure [MPa]")
    assert peak[-1].startswith("mesh-independent")
    marked = [value for tag, name, value in page.attributes if (tag, name) == ("tr", "class")]
    assert marked == ["doubt"] * 2


def test_pressure_at_a_rounded_edge_is_told_with_its_error(written):
    figures = cycle()
    known = np.isfinite(figures.edge_pressure)
    one = changed(figures, edge_is_rounded=known, edge_pressure_error=np.where(known, 0.0123, np.nan))
    page = written(one)
    (edge,) = page.rows("edge pressure [MPa]")
    assert edge[-1] == "rounded edge: its error stands below"
    (error,) = page.rows("edge pressure error [%]")
    assert "1.2" in error
    (row,) = page.rows("estimated error of the pressure at rounded edges, largest")
    held = known.any(axis=(1, 2))
    assert row[1:] == ["1.23%" if one else "-" for one in held]
    without_limit = changed(figures, edge_is_rounded=known, edge_pressure_error=np.where(known, np.inf, np.nan))
    (row,) = written(without_limit).rows("estimated error of the pressure at rounded edges, largest")
    assert row[1:] == ["no limit" if one else "-" for one in held]


def test_discretisation_error_is_that_of_the_result(written):
    scene = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(
        {"analysis.positions": 1, "analysis.compliance": "contact", "analysis.free_edges": False}
        | {"analysis.torques_Nm": [40.0, 500.0]}
    )
    with pytest.warns(AccuracyWarning):
        found = analyse(scene)
    page = written(found)
    (row,) = page.rows("estimated discretisation error of the peak pressure, largest")
    errors = [float(np.nanmax(one, initial=-1.0)) for one in found.discretisation_error]
    assert row[1:] == [f"{100.0 * error:.2f}%" if error >= 0.0 else "no estimate" for error in errors]
    assert min(errors) > 0.0
    (peak,) = page.rows(label_of("peak_pressure_MPa"))
    tops = np.nanargmax(found.peak_pressure[:, 0], axis=1)  # beside the peak stands the error of its own contact
    beside = ", ".join(f"{100.0 * found.discretisation_error[t, 0, k]:.2f}%" for t, k in enumerate(tops))
    assert peak[-1].startswith(f"mesh-independent; error of the grid: {beside}; at edges and relief starts")


def test_accuracy_of_figures_is_what_the_studies_show(page):
    """The largest differences of the tables: of faces of 100 mm, and of root tension in the plane and in space."""
    folder = ROOT / "docs" / "studies"
    rows = [
        line.strip("| ").split(" | ")
        for line in (folder / "mesh_cycle_fem.md").read_text(encoding="utf-8").splitlines()
    ]
    faces = [
        np.abs([[float(cell) for cell in row[5:8]] for row in rows if row[0] == width and len(row) > 8]).max(axis=0)
        for width in ("100", "20")
    ]
    table = (folder / "root_stress_fem.md").read_text(encoding="utf-8")
    found = re.findall(r"^\| (\S+).*\| (tension|compression) \|.*\| ([+-][\d.]+) \| [\d.]+ \|$", table, re.M)
    assert len(found) == 16
    roots = [{"tension": [], "compression": []}, {"tension": [], "compression": []}]
    for ring, kind, difference in found:
        roots[ring == "helical"][kind].append(abs(float(difference)))
    differences = [
        *(
            dict(zip(("transmission_error_mean_", "transmission_error_span_", "mesh_stiffness_mean_"), of, strict=True))
            for of in faces
        ),
        *({"root_tension_MPa": max(of["tension"]), "root_compression_MPa": max(of["compression"])} for of in roots),
    ]
    for measured, (kind, said) in zip(differences, COMPARED.items(), strict=True):
        assert {*measured} == {*said}
        for name, difference in measured.items():
            assert difference <= said[name] < difference + 0.3, (kind, name)
    assert page.rows(label_of("transmission_error_mean_um"))[0][-1] == "of the flanks alone: the teeth do not bend"
    assert page.rows(label_of("transmission_error_order_1_um"))[0][-1].startswith("from 5 positions: higher orders")
    assert page.rows(label_of("transverse_load_factor"))[0][-1].startswith("the largest of 5 positions")


@pytest.mark.quick_cases(
    "mesh_cycle_bevel-changes1-no estimate: for teeth of bevel gears this figure was not compared",
    "mesh_cycle_spur-changes3-spur teeth on a face of 33 modules or more: compared gears are",
)
@pytest.mark.parametrize(
    ("name", "changes", "note"),
    [
        ("mesh_cycle_helical", {}, "no estimate: for helical teeth this figure was not compared"),
        ("mesh_cycle_bevel", {}, "no estimate: for teeth of bevel gears this figure was not compared"),
        (
            "mesh_cycle_spur",
            {},
            "spur teeth on a face below 33 modules: compared gears are within {} % of finite",
        ),
        (
            "mesh_cycle_spur",
            {"face_width": 99.0},
            "spur teeth on a face of 33 modules or more: compared gears are",
        ),
    ],
)
def test_accuracy_of_teeth_that_bend_is_that_of_their_kind(written, name, changes, note):
    """Face of 8.3 or 33 modules; of gears that no study has compared there is no number."""
    bending = changed_scene(result(name, 5), {"analysis.compliance": "contact+tooth"})
    page = written(changed(bending, **changes))
    narrow = not changes
    within = {
        "transmission_error_mean_um": (1.1, 2.9),
        "transmission_error_span_um": (0.5, 2.9),
        "mesh_stiffness_mean_N_per_mm_um": (3.1, 5.0),
    }
    for figure, percent in within.items():
        assert page.rows(label_of(figure))[0][-1].startswith(note.format(f"{percent[narrow]:g}")), figure


def test_every_warning_is_told_with_what_it_means(page):
    told = cycle().warnings
    assert told
    for sentence in told:
        assert sentence in page.words
        known = kind_of(sentence)
        assert known.meaning.replace("`", "") in page.words
        assert known.advice.replace("`", "") in page.words


def test_result_without_warnings_says_so_and_one_of_an_earlier_version_too(written):
    assert "None: the analysis met no limit" in written(result("spur", 1)).words
    noted = written(replace(cycle(), dataset=cycle().dataset.assign_attrs(warnings="")))
    assert "the contact reaches an edge of a flank" in noted.words
    assert "met no limit" not in noted.words
    assert "None. The notes above on single figures still hold." in noted.words
    old = replace(cycle(), dataset=cycle().dataset.drop_attrs(deep=False).assign_attrs(version="0.0.1"))
    page = written(old)
    assert "an earlier version wrote the file of this result, without warnings" in page.words
    assert "with loaded_tca 0.0.1" in page.words


def test_warnings_and_date_of_an_analysis_are_kept_in_the_file(tmp_path):
    with pytest.warns(AccuracyWarning) as caught:
        found = analyse(result("spur", 1).scene.with_changes({"analysis.cells": (6, 24)}))
    sentences = tuple(dict.fromkeys(str(one.message) for one in caught))
    assert found.warnings == sentences
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00", found.date)
    found.save(tmp_path / "result.nc")
    again = load_result(tmp_path / "result.nc")
    assert (again.warnings, again.date) == (sentences, found.date)


def test_result_without_warnings_is_kept_as_such(tmp_path):
    clean = replace(cycle(), dataset=cycle().dataset.assign_attrs(warnings=""))
    clean.save(tmp_path / "result.nc")
    assert load_result(tmp_path / "result.nc").warnings == ()


def test_explanations_are_those_of_the_documents():
    """And every warning of an analysis has one."""
    table = (ROOT / "docs" / "reference" / "warnings.md").read_text(encoding="utf-8")
    rows = [line.strip("| ").split(" | ") for line in table.splitlines() if line.startswith("| ")][1:]
    assert len(rows) > 10
    for sentence, meaning, advice, _ in rows:
        known = kind_of(sentence)
        assert (known.meaning, known.advice) == (meaning, advice)
    assert len({one.words for one in KINDS}) == len(KINDS)


def test_free_edges_are_advised_only_where_they_are_left_out():
    told = "the contact reaches an edge of a flank, where the pressure of the map is mesh-dependent"
    left_out = f"{told}; the free edge is left out (analysis.free_edges)"
    assert "free_edges" not in kind_of(told).advice
    assert kind_of(left_out).advice.startswith("`free_edges = true`")


def test_every_kind_of_warning_is_given_and_every_warning_is_of_a_kind():
    code = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "loaded_tca").rglob("*.py"))
    names = [name for name, one in vars(warning_kinds).items() if isinstance(one, warning_kinds.Kind)]
    assert len(names) == len(KINDS)
    for name in names:
        assert re.search(rf"kinds\.{name}\b", code), name
    assert not re.search(
        r"give_accuracy_warning\(\s*f?[\"']", code.replace('give_accuracy_warning("the fit is coarse")', "")
    )


@pytest.mark.parametrize("known", KINDS, ids=lambda one: one.words[:30])
def test_sentence_of_a_kind_is_known_again(known):
    """With values of any length in its fields."""
    fields = {name: 12345.678 if form else "anything" for _, name, form, _ in Formatter().parse(known.template) if name}
    assert kind_of(f"{known.sentence(**fields)} (at 1 of 9 pressure maps; the first: 130 N m)") is known


def test_page_needs_nothing_else(page):
    """No attribute leads out of it; the only addresses are names of the languages."""
    links = [
        (tag, name, value)
        for tag, name, value in page.attributes
        if name in ("src", "href", "xlink:href", "data", "action", "poster")
    ]
    assert links
    assert all(value.startswith(("#", "data:image/png;base64,")) for _, _, value in links)
    assert not [tag for tag, _, _ in page.attributes if tag in ("script", "link", "iframe", "object", "embed", "img")]
    addresses = {value for _, _, value in page.attributes if re.search("https?://", str(value))}
    assert addresses == {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}


def test_page_has_no_resources_in_its_style(path):
    text = path.read_text(encoding="utf-8")
    (style,) = re.findall("<style.*?</style>", text, re.DOTALL)
    assert "url(" not in style
    assert "@import" not in style


def assert_ids_are_told_apart(page):
    ids = [value for _, name, value in page.attributes if name == "id"]
    assert len(ids) > 100
    assert len(ids) == len(set(ids))
    used = {value[1:] for _, name, value in page.attributes if name == "xlink:href" and value.startswith("#")}
    used |= {one for _, _, value in page.attributes for one in re.findall(r"url\(#([^)]*)\)", str(value))}
    assert used
    assert used <= set(ids)


def test_pictures_do_not_use_each_other_s_parts(page):
    assert_ids_are_told_apart(page)


@pytest.mark.thorough
@pytest.mark.parametrize("subject", [cycle, lambda: grid(torques=(40.0, 80.0))], ids=["result", "study"])
def test_pictures_of_a_whole_report_do_not_use_each_other_s_parts(subject, tmp_path):
    """Heat maps of a study under two torques have the same colour bar."""
    assert_ids_are_told_apart(Page(write_html_report(subject(), tmp_path / "report.html")))


def test_every_picture_has_a_caption_and_a_name(page):
    pictures = [value for tag, name, value in page.attributes if (tag, name) == ("svg", "aria-label")]
    assert pictures[0].startswith("at a glance")  # before all tables, without a number
    assert len(pictures) - 1 == 15
    assert all(title in page.words for title in pictures)


def test_text_of_a_scene_stays_text(written):
    title = "<script>alert(1)</script> & 'x' \"y\" $\\alpha$ {{ 7 * 7 }} --> </svg>"
    page = written(changed_scene(cycle(), {"title": title}))
    assert not [tag for tag, _, _ in page.attributes if tag == "script"]
    assert "script" not in page.open
    assert page.headings[0] == title
    assert title in page.words


@pytest.mark.thorough
def test_report_of_the_same_result_is_the_same_file_but_for_its_date(tmp_path, monkeypatch):
    """Each time it is drawn anew: of its pictures one of curves, and one with an image."""
    few = {"transmission_error": plot_transmission_error, "pressure_map": plot_pressure_map}
    monkeypatch.setattr(
        result_page, "result_figures", lambda result, **_: {name: plot(result) for name, plot in few.items()}
    )
    first, second = (
        write_html_report(cycle(), tmp_path / "report.html", date=date).read_text(encoding="utf-8")
        for date in (WHEN, "2027-01-01")
    )
    assert first != second
    assert first.replace("2026-03-04 05:06 UTC", "X") == second.replace("2027-01-01 00:00", "X")


@pytest.mark.thorough
def test_report_has_the_date_and_the_version_of_the_analysis(written):
    dated = replace(cycle(), dataset=cycle().dataset.assign_attrs(date=WHEN, version="9.8.7"))
    assert "analysed2026-03-04 05:06 UTC, with loaded_tca 9.8.7" in written(dated).words.replace(
        "analysed ", "analysed"
    )
    assert "some day" in written(dated, date="some day").words


@pytest.mark.thorough
def test_one_position_and_no_load_have_reports(written):
    assert written(result("spur", 1)).rows("peak pressure [MPa]")
    assert written(result("spur", 1, (0.0,))).rows("peak pressure [MPa]")


def test_many_torques_are_in_tables_that_fit_a_page(written):
    torques = tuple(float(torque) for torque in range(20, 180, 20))
    page = written(result("spur", 1, torques))
    heads = [table[0] for table in page.tables if table[0][0] == "key figure"]
    assert [len(head) - 2 for head in heads] == [4, 4]
    assert [cell for head in heads for cell in head[1:-1]] == [f"{torque:g} N m" for torque in torques]


@pytest.mark.parametrize(("count", "sizes"), [(0, []), (1, [1]), (5, [5]), (6, [3, 3]), (11, [4, 4, 3])])
def test_parts_are_even(count, sizes):
    values = [*range(count)]
    parts = [values[part] for part in parts_of(values, 5)]
    assert [len(part) for part in parts] == sizes
    assert sum(parts, []) == values  # noqa: RUF017


def test_line_without_a_label_names_the_columns_of_the_next_table():
    rows = [("a", "1"), ("", "pinion", "wheel"), ("z", "2", "3")]
    tables = tables_of(rows, "Gears")
    assert tables == (Table((("a", "1"),), (), "Gears"), Table((("z", "2", "3"),), ("", "pinion", "wheel")))
    assert tables[1].columns == 3
    assert tables_of([]) == ()


def test_study_has_a_report(written):
    study = grid()
    page = written(study, date=WHEN)
    assert "What varies" in page.headings
    assert "Ranking" in page.headings
    ranking = next(table for table in page.tables if table[0][0] == "rank")
    spans = study["transmission_error_span_um"].values[:, 0]
    assert ranking[1][1] == str(int(spans.argmin()))
    best = next(table for table in page.tables if table[0][1:3] == ["best", "worst"])
    assert best[1][1:3] == [str(int(spans.argmin())), str(int(spans.argsort(kind="stable")[-1]))]
    assert len(ranking) - 1 == study.sizes["sample"]
    assert page.rows("peak pressure [MPa]")
    assert [value for tag, name, value in page.attributes if (tag, name) == ("svg", "role")]


def test_study_tells_what_failed_and_its_warnings(written):
    study = grid()
    count = study.sizes["sample"]
    status, reason, warned = (np.array([word] * count, dtype=object) for word in ("ok", "", ""))
    status[1], reason[1] = "refused", "pinion: pointed <b>"
    warned[0] = "the contact reaches the border of its grid (at 1 of 9 pressure maps; the first: a)"
    warned[2] = "the contact reaches the border of its grid (at 3 of 9 pressure maps; the first: b)"
    named = {"status": status, "reason": reason, "warnings": warned}
    page = written(study.assign({name: ("sample", values) for name, values in named.items()}))
    assert "refused: pinion: pointed <b> (1)" in page.words
    assert f"the contact reaches the border of its grid (2 of {count} variants)" in page.words
    assert "less torque, or a higher max_pressure_MPa" in page.words


def test_study_of_which_nothing_was_analysed_has_a_report(written):
    study = grid()
    count = study.sizes["sample"]
    refused = {name: ("sample", np.array([name] * count, dtype=object)) for name in ("reason",)}
    refused["status"] = ("sample", np.array(["refused"] * count, dtype=object))
    figures = [name for name, values in study.data_vars.items() if values.dims == ("sample", "torque")]
    page = written(study.drop_vars(figures).assign(refused))
    assert f"{count} refused" in page.words
    assert "Ranking" not in page.headings
    assert "no variant was analysed" in page.words
    assert "met no limit" not in page.words


def test_distributions_have_a_report(written):
    page = written(sampled())
    assert "distributed" in page.words
    assert "Best and worst sample" in page.headings
    assert "Single samples of the distributions, not designs." in page.words


def test_report_of_a_study_is_ranked_by_the_figure_that_is_asked_for(written):
    """The pressure grows with both keys, so that the first variant has the least."""
    page = written(grid(), rank_by="peak_pressure_MPa")
    ranking = next(table for table in page.tables if table[0][0] == "rank")
    assert [row[1] for row in ranking[1:]] == ["0", "1", "2", "3", "4", "5"]
    assert "ranked bypeak pressure [MPa], the least is best" in page.words.replace("ranked by ", "ranked by")


def test_axes_are_those_of_the_pictures_of_a_study(tmp_path, monkeypatch):
    asked, ranking = [], {"study_ranking": None}
    monkeypatch.setattr("loaded_tca.reports.report.plot_study", lambda _, **ways: asked.append(ways) or dict(ranking))
    write_html_report(grid(), tmp_path / "report.html", axes=(TIP, LEAD))
    assert asked[0]["axes"] == (TIP, LEAD)
    with pytest.raises(InputError, match=r"axes: \('a', 'b'\); a MeshCycle varies no keys"):
        write_html_report(cycle(), tmp_path / "report.html", axes=("a", "b"))
    with pytest.raises(InputError, match="axes: not allowed; the interactive page has its own choice of keys"):
        write_html_report(grid(), tmp_path / "report.html", axes=(TIP, LEAD), interactive=True)


@pytest.mark.parametrize(
    ("subject", "told"),
    [
        (grid, r'peak_presure_MPa: no figure of the study; did you mean "peak_pressure_MPa"'),
        (cycle, r"rank_by: 'peak_presure_MPa'; a MeshCycle has no ranking"),
    ],
)
def test_figure_that_cannot_rank_is_one_clear_error(subject, told, tmp_path):
    with pytest.raises(InputError, match=told):
        write_html_report(subject(), tmp_path / "report.html", rank_by="peak_presure_MPa")
    assert not [*tmp_path.iterdir()]


def test_report_ranks_combinations_where_others_scatter(written):
    """The best sample is one of a design that scatters widely; by the quantile the other one is better."""
    page = written(scattering(), date=WHEN)
    ranking = next(table for table in page.tables if table[0][0] == "rank")
    assert [row[:3] for row in ranking[1:]] == [["1", "21", "3"], ["2", "21", "0"]]
    assert [row[3] for row in ranking[1:]] == ["6", "19"]
    best = next(table for table in page.tables if table[0][1:] == ["best", "worst"])
    assert ["pinion lead crowning [µm]", "3", "0"] in best
    assert "Best and worst combination" in page.headings
    assert "95 % quantile over the samples" in page.words
    assert "Over all variants of all combinations together" in page.words


def test_quantiles_of_several_torques_are_those_of_the_largest_value_over_them():
    told = "95 % quantile over the samples"
    assert study_tables(sampled(21))["quantile"] == f"{told} of its largest value over the torques"
    assert study_tables(sampled(21, (80.0,)))["quantile"] == told


def test_report_tells_distributions_and_the_seed(written):
    study = scattering().assign_attrs(seed=7)
    study[MISALIGNMENT].attrs["distribution"] = "norm(0.0, scale=5.0)"
    page = written(study)
    (row,) = page.rows(label_of(MISALIGNMENT))
    assert row[2] == "distributed, norm(0.0, scale=5.0)"
    assert "seed of the samples 7" in page.words.replace("samples7", "samples 7")


def scattering():
    """Crowning 0: spans 0, 1, ... 20 um over the samples; crowning 3: 6 um with each of them."""
    lead, along = np.repeat([0.0, 3.0], 21), np.tile(np.arange(21.0), 2)
    study = dataset({LEAD: lead, MISALIGNMENT: along}, {"transmission_error_span_um": np.where(lead > 0.0, 6.0, along)})
    study[MISALIGNMENT].attrs["sampling"] = "distribution"
    return study


def test_design_has_a_report(written):
    page = written(DesignResult(design_dataset()))
    assert page.rows("pinion lead crowning [µm]") == [
        ["pinion lead crowning [µm]", "pinion.modifications.lead_crowning_um", "1", "12", "5", "7.5"]
    ]
    assert ["by the full analysis", "0.9", "0.4"] in page.tables[1]
    assert "face_load_factor <= 1.9 at 100 N m" in page.words
    assert "lead_crowning_um = 7.5" in page.words
    assert "Appendix: scene file of the start" in page.headings


def test_forged_design_is_bad_input(tmp_path, monkeypatch, capsys):
    from loaded_tca.results.files import write_dataset

    monkeypatch.chdir(tmp_path)
    whole = design_dataset()
    write_dataset("figure.nc", whole.assign_attrs(figure="xyz"))
    write_dataset("bare.nc", whole.drop_vars("value").assign_attrs(limits=3.0))
    assert cli.main(["report", "figure.nc"]) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith("loaded-tca: figure.nc: not the result of a design: figure: 'xyz'; allowed span_um, ")
    assert cli.main(["report", "bare.nc"]) == 2
    told = capsys.readouterr().err
    assert "limits: missing, or no text" in told
    assert "value: missing" in told


def test_design_tells_the_peak_pressure_beside_the_limit_on_another_measure(written):
    """900 MPa and 1e8 times the height of the transmission error, at one position of one sample 40 more."""
    found = design_dataset()
    found["peak_pressure"][1, 0, 0, 3] += 40.0
    page = written(DesignResult(found.assign_attrs(limits="pressure_MPa <= 1150 at 100 N m")))
    assert page.rows("peak pressure, largest over the positions [MPa]")[0][1:4] == ["100", "1100", "1040"]
    assert "pressure_MPa <= 1150 at 100 N m (norm of the pressure, farther than 0.05 modules from the e" in page.words
    assert "above the peak pressure where contacts are large, below it where they are small, by up to a" in page.words


def test_design_marks_figures_beyond_their_limits(written):
    """A design that `optimise` refused, as it is saved of the error."""
    limits = "face_load_factor <= 1.05 at 100 N m\nspan_um <= 0.2 at 100 N m"
    refused = written(DesignResult(design_dataset().assign_attrs(limits=limits)))
    assert refused.rows("K_Hbeta")[0][1:] == ["100", "1.2", "1.1", "1.05, exceeded by 4.8%"]
    assert refused.rows("peak-to-peak loaded transmission error at the wheel's base circle [µm]")[0][-1] == "0.2"
    assert "confirms at least half of the gain, and every limit to 5 %" in refused.words
    beyond = written(DesignResult(design_dataset().assign_attrs(limits="face_load_factor <= 1.01 at 100 N m")))
    assert "Not confirmed." in beyond.words
    assert "face_load_factor is 1.1 by the analysis at 100 N m, its limit 1.01" in beyond.words
    assert "What to do: take more cells of the model" in beyond.words
    assert "confirms at least" not in beyond.words


def test_design_says_that_its_gain_is_not_confirmed(written):
    found = design_dataset()
    found["objective"][1] = 0.85
    page = written(DesignResult(found))
    assert "the objective goes from 0.95 to 0.38 on held contacts, but from 0.9 to 0.85 by the analysis" in page.words
    assert "confirms at least" not in page.words


def test_design_tells_its_scatter_and_seed(written):
    told = {"distributions": f"{MISALIGNMENT}: norm(0.0, scale=5.0)", "seeds": "3 of the samples"}
    scatter = xarray.DataArray([[-4.0], [6.0]], {"scatter_key": [MISALIGNMENT]}, ("sample", "scatter_key"))
    page = written(DesignResult(design_dataset().assign(scatter=scatter).assign_attrs(told)))
    assert page.rows(label_of(MISALIGNMENT))[0][1:] == [MISALIGNMENT, "norm(0.0, scale=5.0)", "-4", "6"]
    assert "3 of the samples" in page.words


def design_dataset():
    scene = cycle().scene
    phase = np.linspace(0.0, 2.0 * np.pi, 5)
    axes = ("design", "sample", "torque", "position")
    height = np.array([2e-6, 1e-6])[:, None, None] * np.ones((2, 2, 1))
    arrays = {
        "transmission_error": (axes, height[..., None] * np.cos(phase)),
        "peak_pressure": (axes, 900.0 + 1e8 * height[..., None] * np.ones(5)),
        "span_um": (axes[:3], 1e5 * height),
        "face_load_factor": (axes[:3], 1.0 + 1e5 * height),
        "value": (("design", "key"), [[5.0], [7.5]]),
        "range": (("key", "bound"), [[1.0, 12.0]]),
        "objective": (("design",), [0.9, 0.4]),
        "held_objective": (("design",), [0.95, 0.38]),
        "history_objective": (("evaluation",), [0.95, 0.5, 0.38]),
    }
    coordinates = {
        "design": ["start", "optimum"],
        "torque": [100e3],
        "key": ["pinion.modifications.lead_crowning_um"],
    }
    attributes = {"kind": "design", "scene_toml": scene.to_toml(), "warnings": "", "objective": "mean"}
    attributes |= {"figure": "span_um", "limits": "face_load_factor <= 1.9 at 100 N m"}
    return xarray.Dataset(arrays, coordinates, attributes)


@pytest.mark.parametrize("subject", [None, {"kind": "study"}, xarray.Dataset()])
def test_other_subjects_are_refused(subject, tmp_path):
    with pytest.raises(
        InputError,
        match=r"report: found a \w+; allowed a result, a whole revolution, a comparison, a stage, a double",
    ):
        write_html_report(subject, tmp_path / "report.html")
    assert not [*tmp_path.iterdir()]


def test_missing_jinja2_is_one_clear_error(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "jinja2", None)
    with pytest.raises(InputError, match=r"needs the package jinja2; .* extra 'report'"):
        write_html_report(cycle(), tmp_path / "report.html")
    assert not [*tmp_path.iterdir()]


@pytest.mark.usefixtures("with_one_picture")
def test_file_that_cannot_be_written_leaves_the_old_one(tmp_path, monkeypatch):
    old = tmp_path / "report.html"
    old.write_text("old")

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(InputError, match=r"report\.html: cannot be written: No space left"):
        write_html_report(cycle(), old)
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]
    assert old.read_text() == "old"


@pytest.mark.thorough
def test_templates_are_part_of_the_wheel(tmp_path):
    if shutil.which("hatchling") is None and not _has_hatchling():
        pytest.skip("hatchling is not installed")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (wheel,) = tmp_path.glob("*.whl")
    listed = subprocess.run(
        [sys.executable, "-m", "zipfile", "-l", str(wheel)], check=True, capture_output=True, text=True
    ).stdout
    templates = sorted(path.name for path in (ROOT / "loaded_tca" / "reports" / "templates").iterdir())
    assert templates
    assert all(f"loaded_tca/reports/templates/{name}" in listed for name in templates)


def _has_hatchling():
    import importlib.util

    return importlib.util.find_spec("hatchling") is not None


@pytest.fixture
def kept(tmp_path, monkeypatch, with_one_picture):  # noqa: ARG001
    """A directory with a result."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    cycle().save(tmp_path / "out" / "result.nc")
    return tmp_path


def test_command_writes_the_report_beside_the_result(kept, capsys):
    assert cli.main(["report", "out"]) == 0
    assert capsys.readouterr().out == "Written to out: report.html\n"
    assert Page(kept / "out" / "report.html").headings[0] == cycle().scene.title


def test_command_takes_a_file_and_a_place(kept, capsys):
    assert cli.main(["report", "out/result.nc", "--out", "elsewhere/mine.html"]) == 0
    assert capsys.readouterr().out == "Written to elsewhere: mine.html\n"
    assert [path.name for path in (kept / "elsewhere").iterdir()] == ["mine.html"]


@pytest.mark.usefixtures("with_one_picture")
def test_command_takes_studies_and_designs(tmp_path, monkeypatch):
    from loaded_tca.results.files import write_dataset

    monkeypatch.chdir(tmp_path)
    (tmp_path / "study").mkdir()
    write_dataset("study/study.nc", grid())
    write_dataset("mine.nc", design_dataset())
    assert cli.main(["report", "study"]) == 0
    assert "What varies" in Page("study/report.html").headings
    assert cli.main(["report", "study", "--rank-by", "peak_pressure_MPa"]) == 0
    ranking = next(table for table in Page("study/report.html").tables if table[0][0] == "rank")
    assert ranking[1][1] == "0"
    assert cli.main(["report", "mine.nc", "--out", "mine.html"]) == 0
    assert "Values of the design" in Page("mine.html").headings


def test_directory_without_a_result_is_the_error_of_plot(kept, capsys):
    (kept / "empty").mkdir()
    told = []
    for command in ("plot", "report"):
        assert cli.main([command, "empty"]) == 2
        told.append(capsys.readouterr().err)
    assert told[0] == told[1]
    assert "empty/result.nc: cannot be read" in told[0]


def test_command_tells_what_cannot_be_written(kept, capsys):
    (kept / "file").write_text("")
    assert cli.main(["report", "out", "--out", "file/report.html"]) == 2
    assert "is a file; give a directory" in capsys.readouterr().err
    assert cli.main(["report", "out", "--out", "out"]) == 2
    assert "out: cannot be written" in capsys.readouterr().err
    assert [path.name for path in (kept / "out").iterdir()] == ["result.nc"]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a system without named pipes")
@pytest.mark.parametrize("name", ["out/result.nc", "link.html", "pipe"])
def test_command_replaces_neither_its_input_nor_what_is_no_file(kept, capsys, name):
    """And says so before it reads the result, which is none here."""
    (kept / "out" / "result.nc").write_text("kept")
    (kept / "link.html").symlink_to("out/result.nc")
    os.mkfifo(kept / "pipe")
    assert cli.main(["report", "out", "--out", name]) == 2
    told = "cannot be written: not a regular file; give the name of a file"
    told = told if name == "pipe" else "would replace the input; give another name"
    assert capsys.readouterr().err == f"loaded-tca: --out: {name}: {told}\n"
    assert (kept / "out" / "result.nc").read_text() == "kept"
    assert (kept / "pipe").is_fifo()


@pytest.mark.usefixtures("kept")
def test_command_without_jinja2_is_bad_input(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "jinja2", None)
    assert cli.main(["report", "out"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
