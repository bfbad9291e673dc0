"""Interactive pages without a browser: their numbers are those of the arrays, and nothing leads out of them."""

import base64
import html
import json
import re
import sys
import zlib
from html.parser import HTMLParser

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import InputError
from loaded_tca.double_helical import DoubleHelicalResult
from loaded_tca.pairs import mating_teeth
from loaded_tca.plots.flanks import ToPicture
from loaded_tca.plots.pressure_map import pressure_seen
from loaded_tca.plots.style import label_of
from loaded_tca.plots.three_d import DRAWN, LIFT
from loaded_tca.reports import explore, interactive, write_html_report
from loaded_tca.reports.arrays import NOTHING, STEPS, scaled
from loaded_tca.reports.interactive_result import NODES
from loaded_tca.results.summary import shown
from loaded_tca.results.teeth import teeth_in_space
from loaded_tca.stages import StageResult
from tests.samples import root_stress
from tests.samples.results import changed_scene, result, with_a_gap
from tests.samples.study_datasets import LEAD, TIP, dataset, grid

TORQUES = (20.0, 80.0, 130.0)
LARGEST_PAGE = 8e6
"""Bytes of a page of 33 positions under three torques."""
SINGLE = 1e-6
"""Of numbers of single precision and what is computed of a few of them."""
TEXT = "</script><script>alert(\"1\")</script><b title='x'>&amp;"


def cycle():
    return result("mesh_cycle_helical", 5, TORQUES)


class Elements(HTMLParser):
    """Attributes of all elements of a page, and the contents of its scripts by their ids."""

    def __init__(self, text):
        super().__init__()
        self.attributes, self.scripts, self.inside, self.text = [], {}, None, []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.attributes += [(tag, name, value) for name, value in attrs]
        if tag == "script":
            self.inside = dict(attrs).get("id", f"script {len(self.scripts)}")
            self.scripts[self.inside] = ""

    def handle_endtag(self, tag):
        self.inside = None if tag == "script" else self.inside

    def handle_data(self, data):
        if self.inside is None:
            self.text.append(data)
        else:
            self.scripts[self.inside] += data


class Read:
    """A page as its script reads it."""

    def __init__(self, text):
        elements = Elements(text)
        self.elements, self.data = elements, json.loads(elements.scripts["data"])
        self.block = zlib.decompress(base64.b64decode(elements.scripts["block"]))

    def array(self, place):
        count = int(np.prod(place["shape"]))
        kind = np.dtype(place["kind"]).newbyteorder("<")
        return np.frombuffer(self.block, kind, count, place["at"]).reshape(place["shape"])

    def maps(self):
        """Steps of pressure and what places them, by indices of torque, position and pair."""
        cells, pressure, places = (self.array(self.data["maps"][name]) for name in ("cells", "pressure", "places"))
        cell, number, maps = 0, 0, {}
        for place in np.ndindex(cells.shape[:3]):
            if size := int(np.prod(cells[place].astype(int))):
                maps[place] = pressure[cell : cell + size].reshape(cells[place]), places[number]
                cell, number = cell + size, number + 1
        assert (cell, number) == (len(pressure), len(places))
        return maps


@pytest.fixture(scope="module")
def text():
    return explore(cycle()).html


@pytest.fixture(scope="module")
def page(text):
    return Read(text)


def parabolas(nodes, across, along):
    """Values at parts (...) of the way through what values at even nodes (3, 3, 2) say."""
    weights = [
        np.array([2.0 * (s - 0.5) * (s - 1.0), 4.0 * s * (1.0 - s), 2.0 * s * (s - 0.5)]) for s in (across, along)
    ]
    return np.einsum("a...,b...,abk->...k", *weights, nodes)


def test_every_pressure_is_that_of_the_map_within_what_is_said(page):
    """Within a 65534th of the largest; no cell under pressure is left out, and void ones are marked."""
    subject, maps = cycle(), page.maps()
    loaded = {
        (t, n, k)
        for t, rows in enumerate(subject.maps)
        for n, row in enumerate(rows)
        for k, one in enumerate(row)
        if one is not None and one.pressure.any()
    }
    assert maps.keys() == loaded
    for (t, n, k), (steps, place) in maps.items():
        one = subject.maps[t][n][k]
        x0, y0, dx, dy, step = place[:5]
        first = round((x0 - one.x[0]) / dx), round((y0 - one.y[0]) / dy)
        part = tuple(slice(begin, begin + count) for begin, count in zip(first, steps.shape, strict=True))
        assert_allclose([dx, dy], one.spacing, rtol=SINGLE)
        void = steps == NOTHING
        assert_array_equal(void, np.isinf(one.gap[part]) & (one.pressure[part] == 0.0))
        shown = np.where(void, 0.0, steps * step)
        assert_allclose(shown, one.pressure[part], rtol=SINGLE, atol=one.pressure.max() / STEPS)
        assert_array_equal(shown > 0.0, one.pressure[part] > 0.0)
        assert np.count_nonzero(one.pressure[part]) == np.count_nonzero(one.pressure)
        assert_allclose(place[5:8], one.origin, rtol=SINGLE, atol=1e-5)
        assert_allclose(place[8:17].reshape(3, 3), one.axes, atol=SINGLE)


def test_scaled_numbers_keep_the_smallest_and_what_is_missing():
    steps, step = scaled(np.array([0.0, 1e-9, 500.0, 1000.0, np.nan]))
    assert steps.tolist() == [0, 1, 32767, STEPS, NOTHING]
    assert step == 1000.0 / STEPS
    assert scaled(np.array([0.0, np.nan]))[0].tolist() == [0, NOTHING]


def test_cells_lie_on_the_flanks_where_the_result_has_them(page):
    """Parabolas through nine points leave what a fourth derivative makes: 1 um here, of fields of 50 um and more."""
    subject = cycle()
    for (t, n, k), (steps, place) in page.maps().items():
        one, (x0, y0, dx, dy) = subject.maps[t][n][k], place[:4].astype(float)
        x, y = x0 + dx * np.arange(steps.shape[0]), y0 + dy * np.arange(steps.shape[1])
        middles = one.origin + x[:, None, None] * one.axes[0] + y[:, None] * one.axes[1]
        parts = np.meshgrid(*((np.arange(count) + 0.5) / count for count in steps.shape), indexing="ij")
        for gear, nodes in zip(("pinion", "wheel"), np.split(place[17:], 2), strict=True):
            shown = parabolas(nodes.reshape(NODES, NODES, 2), *parts)
            assert_allclose(shown, ToPicture(subject.gear_pair, gear)(middles), atol=2e-3)


def test_curves_are_those_of_the_result_to_the_last_digit(page):
    subject = cycle()
    panels = {one["title"]: one for one in page.data["panels"]}
    um = 1e3 * subject.wheel_base_radius

    def values(title, line):
        (found,) = [one["values"] for one in panels[title]["lines"] if one["name"] == line]
        return np.array(found, dtype=float)

    assert_array_equal(values("Transmission error", "under load"), um * subject.transmission_error)
    unloaded = values("Transmission error", "unloaded")
    assert_array_equal(unloaded, np.tile(um * subject.unloaded_transmission_error, (3, 1)))
    for line in ("under load", "unloaded"):
        swing, whole = (values(f"Transmission error{more}", line) for more in (" less its mean", ""))
        assert_allclose(swing - swing[:, :1], whole - whole[:, :1], atol=1e-12 * np.abs(whole).max())  # one difference
        assert_allclose(np.trapezoid(swing, axis=1), 0.0, atol=1e-12 * np.abs(whole).max())  # over the pitch
    for k, number in enumerate(("-1", "0", "+1")):
        assert_array_equal(values("Share of the torque", f"tooth pair {number}"), 100.0 * subject.load_share[..., k])
        assert_array_equal(values("Peak pressure", f"tooth pair {number}"), subject.peak_pressure[..., k])
        assert_array_equal(values("Pressure at edges", f"tooth pair {number}"), subject.edge_pressure[..., k])
    assert_array_equal(values("Mesh stiffness", "tangent"), subject.mesh_stiffness)
    assert_array_equal(page.data["angle"], np.degrees(subject.pinion_angle))
    assert_array_equal(page.data["peak_column"], subject.peak_column)
    for values_of, name in zip(page.data["hertz"], ("pressure", "semi_minor", "semi_major"), strict=True):
        assert_array_equal(np.array(values_of, dtype=float), getattr(subject, f"hertz_{name}"))


def test_largest_pressure_over_the_mesh_is_that_of_the_picture(page):
    """And the largest of all is that of the largest cell."""
    subject = cycle()
    for gear, flank in zip(("pinion", "wheel"), page.data["flanks"], strict=True):
        low, high, fields = np.array(flank["low"]), np.array(flank["high"]), page.array(flank["envelope"])
        for t, step in enumerate(flank["steps"]):
            shown = np.where(fields[t] == NOTHING, np.nan, fields[t] * step)
            largest = max(one.pressure.max() for row in subject.maps[t] for one in row if one)
            assert_allclose(np.nanmax(shown), largest, rtol=1e-12)  # a step 65534 times
            _, seen = pressure_seen(subject, t, ToPicture(subject.gear_pair, gear), low, high)
            assert_allclose(shown, seen, atol=step)


def test_teeth_stand_where_they_do_in_space(page):
    """As the picture of the teeth has them, by another way: turned about z, then placed with the wheel's frame."""
    subject, teeth = cycle(), page.data["teeth"]
    origin, axes = np.array(teeth["origin"]), np.array(teeth["axes"])
    for n in (0, 3):
        shown = teeth_in_space(subject, mating_teeth(subject.gear_pair, DRAWN), n, 1)
        for gear, mesh in enumerate((shown.pinion, shown.wheel)):
            points = page.array(teeth["solids"][gear]["vertices"]).astype(float)
            angle = teeth["turns"][gear][shown.column][n]
            turn = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
            placed = points @ turn
            placed = origin + placed @ axes if gear else placed
            assert_allclose(placed, mesh.vertices, atol=1e-4)  # single precision of 200 mm
            assert_array_equal(page.array(teeth["solids"][gear]["triangles"]), mesh.triangles)


def test_root_stress_is_that_of_the_result_on_the_fillets():
    subject = root_stress.result()
    page = Read(explore(subject).html)
    teeth = mating_teeth(subject.gear_pair, DRAWN)
    size = np.ptp(teeth.in_mesh(0.0, 0.0)[0].vertices, axis=0).max()
    gears = zip(subject.root_stress, page.data["teeth"]["root"], (teeth.pinion, teeth.wheel), strict=True)
    for one, gear, tooth in gears:
        count = one.point.shape[2]
        along = np.unique(np.linspace(0, count - 1, min(count, 61)).round().astype(int))
        for name in ("at_tension", "largest", "smallest"):
            assert_array_equal(page.array(gear[name]), getattr(one, name)[..., along].astype(np.float32))
        placed = page.array(gear["points"]).astype(float)
        angle = -subject.gear_pair.pinion.flank.side * tooth.half_thickness_angle
        azimuth = np.arctan2(one.point[..., 1], one.point[..., 0])[:, :, along] + angle
        radius = np.hypot(one.point[..., 0], one.point[..., 1])[:, :, along]
        places = np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), one.point[:, :, along, 2]], axis=-1)
        assert_allclose(np.linalg.norm(placed - places, axis=-1), LIFT * size, rtol=1e-3)  # single precision of 80 mm
        assert (np.hypot(placed[..., 0], placed[..., 1]) > radius - 1e-4).all()  # out of the material
    (panel,) = [one for one in page.data["panels"] if one["title"] == "Root stress"]
    values = {line["name"]: np.array(line["values"]) for line in panel["lines"]}
    assert_array_equal(values["pinion, tension"], subject.root_tension[..., 0])
    assert_array_equal(values["wheel, compression"], subject.root_compression[..., 1])


def test_page_of_33_positions_is_within_its_size(text):
    """This one, and two maps of 48 x 64 cells at each position, as if they could not be packed."""
    more = 33 * 3 * 2 * 48 * 64 * 2 * 4 / 3  # two bytes a cell in base64
    assert len(text.encode()) + more < LARGEST_PAGE


def test_nothing_leads_out_of_the_page(page):
    """Its policy forbids any connection; no element names a place, and no button sends anything."""
    attributes = page.elements.attributes
    policy = next(value for tag, name, value in attributes if (tag, name) == ("meta", "content"))
    assert policy == (
        "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:"
    )
    assert not [one for one in attributes if one[1] in ("src", "href", "data", "action", "poster", "srcset")]
    script = page.elements.scripts["script 3"]
    assert "showSendToCloud: false" in script
    assert not re.search(r"https?:|fetch\(|XMLHttpRequest|WebSocket|sendBeacon|import\(", script)


def test_controls_have_labels(page):
    ids = {value for tag, name, value in page.elements.attributes if tag in ("input", "select") and name == "id"}
    labels = {value for tag, name, value in page.elements.attributes if (tag, name) == ("label", "for")}
    assert {"position", "torque", "pair", "gear", "turn", "tilt", "zoom"} <= ids == labels


def test_key_figures_and_warnings_are_there_with_their_accuracy(page):
    words = " ".join("".join(page.elements.text).split()).replace("\N{NO-BREAK SPACE}", " ")
    for label, name in (("peak pressure [MPa]", "peak_pressure_MPa"), ("face load factor K_Hβ", "face_load_factor")):
        values = " ".join(shown(one[name], name) for one in cycle().key_figures())
        assert f"{label}{values}".replace(" ", "") in words.replace(" ", ""), name
    for sentence in cycle().warnings:
        assert sentence in words
    assert "mesh-dependent at sharp edges: not for rating" in words


def test_text_of_a_scene_stays_text():
    subject = changed_scene(cycle(), {"title": TEXT})
    page = explore(subject)
    assert page.title == TEXT
    assert "alert(" not in "".join(Elements(page.html).scripts.values())
    assert html.escape(TEXT, quote=False).replace('"', "&#34;").replace("'", "&#39;") in page.html
    frame = page._repr_html_()
    assert html.unescape(re.fullmatch(r'<iframe title="([^"]*)".*', frame, re.DOTALL)[1]) == TEXT


def test_notebook_shows_the_same_page_in_a_frame(text):
    frame = interactive.InteractivePage("title", text)._repr_html_()
    assert html.unescape(re.search('srcdoc="([^"]*)"></iframe>$', frame)[1]) == text


def test_positions_without_contact_and_torques_without_load_have_pages():
    page = Read(explore(with_a_gap()).html)
    assert all(line["values"][0][1] is None for line in page.data["panels"][0]["lines"])
    assert not [place for place in page.maps() if place[1] == 1]
    page = Read(explore(result("mesh_cycle_helical", 1, (0.0,))).html)
    assert page.maps() == {}
    assert page.data["highest"] > 0.0


def test_study_has_every_number_of_every_variant():
    subject = grid(["ok"] * 5 + ["refused"], (40.0, 80.0))
    words = subject.assign_coords({"pair.side": ("sample", ["left", "right"] * 3, {"sampling": "table"})})
    page = Read(explore(words).html)
    assert [one["label"] for one in page.data["keys"]] == [label_of(key) for key in (LEAD, TIP, "pair.side")]
    assert page.data["keys"][0]["values"] == subject[LEAD].values.tolist()
    assert page.data["keys"][2]["words"] == ["left", "right"]
    assert page.data["keys"][2]["values"] == [0, 1] * 3
    arrays = {one["label"]: page.array(one["values"]) for one in page.data["figures"]}
    for name in ("transmission_error_span_um", "peak_pressure_MPa", "pinion_torque_Nm"):
        assert_array_equal(arrays[label_of(name)], subject[name].values)
    assert page.data["status"] == subject["status"].values.tolist()
    assert page.data["reason"][-1] == "it is refused"
    assert page.data["ranks"] == [4, 2, 3, 1, 5, None]  # (lead - 3)^2 + (tip - 10)^2 is 109, 9, 100, 0, 109
    assert page.data["torques"] == ["pinion torque 40 N m", "pinion torque 80 N m"]


def test_study_is_ranked_and_coloured_by_the_figure_that_is_asked_for():
    page = Read(explore(grid(), rank_by="peak_pressure_MPa").html)
    assert page.data["figures"][0]["label"] == label_of("peak_pressure_MPa")
    assert page.data["ranks"] == [1, 2, 3, 4, 5, 6]  # 500 + 10 lead + tip
    with pytest.raises(InputError, match="no figure of the study"):
        explore(grid(), rank_by="weight_kg")
    with pytest.raises(InputError, match="has no ranking"):
        explore(cycle(), rank_by="peak_pressure_MPa")


def test_study_of_which_nothing_was_analysed_has_a_page():
    page = Read(explore(grid(["refused"] * 6)).html)
    assert page.data["figures"] == []
    assert page.data["ranks"] == [None] * 6


def test_text_of_a_study_stays_text():
    keys = {"pair.side": np.array([TEXT, "left"])}
    subject = dataset(keys, {"peak_pressure_MPa": [1.0, 2.0]}).assign(reason=("sample", ["", TEXT]))
    scripts = Elements(explore(subject).html).scripts
    assert [name for name, content in scripts.items() if "alert(" in content] == ["data"]
    assert "<" not in scripts["data"]


def test_page_is_written_whole_or_not_at_all(tmp_path):
    page = interactive.InteractivePage("title", "<html>")
    assert page.save(tmp_path / "new" / "page.html").read_text(encoding="utf-8") == "<html>"
    with pytest.raises(InputError):
        page.save(tmp_path)


@pytest.mark.parametrize(
    ("subject", "told"),
    [
        (7, "interactive report: found a int; allowed a result or a study"),
        (object.__new__(StageResult), "its parts sun_mesh.nc and ring_mesh.nc beside"),
        (object.__new__(DoubleHelicalResult), "its parts half_a.nc and half_b.nc beside"),
    ],
    ids=["number", "stage", "double helical"],
)
def test_what_has_no_page_is_one_clear_error(subject, told):
    with pytest.raises(InputError, match=re.escape(told)):
        explore(subject)


def test_missing_plotly_is_one_clear_error(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly", None)
    with pytest.raises(InputError, match=r"needs the package plotly; .* extra 'interactive'"):
        write_html_report(cycle(), tmp_path / "page.html", interactive=True)
    assert not [*tmp_path.iterdir()]


def test_command_writes_the_page_beside_the_result(tmp_path, run, monkeypatch, text):
    """The same bytes for the same result."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    cycle().save("out/result.nc")
    assert run("report", "out", "--interactive") == (0, "Written to out: interactive.html\n", [])
    assert (tmp_path / "out" / "interactive.html").read_text(encoding="utf-8") == text
