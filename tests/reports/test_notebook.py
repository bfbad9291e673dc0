"""Cards in notebooks: what they say, that their text is text, and how large they are."""

import base64
import io
import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from loaded_tca import read_scene
from loaded_tca.contact import solve_contact
from loaded_tca.errors import InputError
from loaded_tca.plots.style import write_title
from loaded_tca.reference.hertz import point_contact
from loaded_tca.reports import card_of, notebook
from loaded_tca.results import compare_results
from loaded_tca.stages import read_stage
from loaded_tca.studies import DesignResult, Study
from tests.reports.test_report import design_dataset
from tests.samples import double_helical, rating, stages, tribology
from tests.samples.results import SCENES, changed, changed_scene, result, with_a_gap
from tests.samples.study_datasets import LEAD, grid

MOST_BYTES = 60_000
MARKUP = "<img src=x onerror=alert(1)> & 'b' \"c\""
"""What no title, name or warning may become."""
EMPTY = {"br", "img", "meta"}


class Tags(HTMLParser):
    """Refuses HTML whose tags do not close in order; keeps all tags."""

    def __init__(self, html):
        super().__init__()
        self.open, self.tags = [], []
        self.feed(html)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def cycle():
    return result("mesh_cycle_spur", positions=5, torques=(40.0, 130.0))


def scene(name="helical", **changes):
    return read_scene(SCENES / f"{name}.toml").with_changes(changes)


@pytest.fixture
def _undrawn(monkeypatch):
    """Figures are made, but not drawn."""
    monkeypatch.setattr(notebook, "png_of", lambda *_: b"drawn")


@pytest.fixture
def _without_picture(monkeypatch):
    """No figure is made."""
    monkeypatch.setattr(notebook.Card, "_picture", lambda _: "")


def contact():
    """A ball of 10 mm on a plane."""
    x = (np.arange(32) - 15.5) * 0.0225
    return solve_contact(np.add.outer(x**2, x**2) / 20.0, (0.0225, 0.0225), 1e5, load=100.0)


SUBJECTS = {
    "result": (cycle, ["peak pressure [MPa]", "load factor", "130 N m"]),
    "one position without load sharing": (lambda: result(positions=1), ["peak pressure [MPa]"]),
    "double helical pair": (
        lambda: double_helical.analysed()[0],
        ["largest line load of half a; mesh-dependent at sharp ends [N/mm]"],
    ),
    "stage result": (lambda: stages.analysed()[0], ["phases of the sun's meshes", "mesh load factor"]),
    "rating": (lambda: rating.solved().rating(), ["least of all cases", "required"]),
    "tribology": (lambda: tribology.known(cycle()), ["loss factor H_VL"]),
    "scene": (scene, ["pinion torque [N m]", "Geometry (ISO 21771)"]),
    "bevel scene": (lambda: scene("straight_bevel"), ["shaft angle Sigma [deg]"]),
    "rack": (lambda: scene("rack_and_pinion"), ["a scene of type cylindrical"]),
    "double helical scene": (lambda: read_scene(double_helical.SCENE), ["groove [mm]", "half b, z from the groove"]),
    "stage": (lambda: read_stage(stages.STAGE), ["teeth of sun, planet and ring", "Mesh of sun"]),
    "study": (lambda: Study(scene(), {LEAD: [3.0, 5.0]}), ["a study of 2 variants", LEAD, "3.0 ... 5.0"]),
    "design": (lambda: DesignResult(design_dataset()), ["pinion lead crowning [µm]", "start", "optimum"]),
    "sensitivities": (
        lambda: cycle().sensitivities([LEAD]),
        ["under 130 N m", "TE, mean [um]", "per unit of pinion lead crowning [µm]", "largest of 2 torques"],
    ),
    "contact": (contact, ["a contact of two half-spaces on 32x32 cells", "load [N]100", "peak pressure [MPa]"]),
    "comparison": (lambda: compare_results({"a": cycle(), "b": cycle()}), ["Under 130 N m", "difference"]),
}


@pytest.mark.usefixtures("_undrawn")
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # flanks that touch at edges
@pytest.mark.quick_cases("result", "study")
@pytest.mark.parametrize("name", SUBJECTS)
def test_card_has_title_figures_and_a_picture(name):
    make, words = SUBJECTS[name]
    html = make()._repr_html_()
    text = unescape(re.sub(r"<[^>]*>", "", html)).replace("\N{NO-BREAK SPACE}", " ")
    missing = [word for word in words if word not in text]
    assert not missing, text
    tags = Tags(html).tags
    assert {"script", "link", "iframe"}.isdisjoint(tag for tag, _ in tags)
    (picture,) = [attributes for tag, attributes in tags if tag == "img"]
    assert picture["src"] == f"data:image/png;base64,{base64.b64encode(b'drawn').decode()}"
    assert picture["alt"]


@pytest.mark.usefixtures("_without_picture")
def test_text_of_cards_is_text(monkeypatch):
    titled = changed_scene(cycle(), {"title": MARKUP})
    warned = replace(titled, dataset=titled.dataset.assign_attrs(warnings=MARKUP))
    for html in (
        warned._repr_html_(),
        titled.scene._repr_html_(),
        compare_results({MARKUP: warned, "b": cycle()})._repr_html_(),
        Study(titled.scene, {"title": [MARKUP, "b"]})._repr_html_(),
    ):
        assert "img" not in [tag for tag, _ in Tags(html).tags]
        assert "onerror=alert(1)&gt;" in html
    monkeypatch.undo()
    figure = Figure(layout="constrained")
    write_title(figure, MARKUP, "shown")
    (picture,) = [of for tag, of in Tags(notebook.Card("a", "b", draw=lambda: figure).html).tags if tag == "img"]
    assert picture.keys() == {"alt", "src"}
    assert picture["alt"] == f"shown; {MARKUP}"


def test_card_with_its_picture_is_small_and_has_no_colour_of_its_own_for_text():
    html = cycle()._repr_html_()
    assert len(html.encode()) < MOST_BYTES
    picture = re.search(r'src="data:image/png;base64,([^"]+)"', html)[1]
    with Image.open(io.BytesIO(base64.b64decode(picture))) as image:
        assert image.width == pytest.approx(notebook.WIDTH, abs=1)
        assert np.asarray(image.convert("L")).std() > 10.0  # something is drawn
    assert set(re.findall(r"(?<![-\w])color:([^;}]+)", notebook.STYLE)) == {"inherit"}


@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # kinks of spur teeth, told in the card
def test_card_of_sensitivities_has_them_and_what_limits_them():
    slopes = cycle().sensitivities([LEAD])
    card = card_of(slopes)
    ((_, *values),) = [row for row in card.tables[0].rows if row[0] == "per unit of pinion lead crowning [µm]"]
    span = cycle().um_per_rad * slopes.peak_to_peak[-1, 0]
    assert float(values[card.tables[0].head.index("peak to peak [um]") - 1]) == pytest.approx(span, rel=5e-3)
    assert all(sentence in card.html for sentence in card.sentences["warning"])
    halves = card_of(double_helical.analysed()[0].sensitivities([LEAD]))
    assert halves.draw is None
    assert "axial motion [um]" in halves.tables[0].head


@pytest.mark.usefixtures("_without_picture")
def test_card_of_a_contact_has_what_the_solution_has():
    """The closed form of Hertz lies within the error that the card tells."""
    told = dict(card_of(contact()).tables[0].rows)
    ball = point_contact(100.0, (0.1, 0.1), 1e5)
    error = float(told["estimated error of the peak pressure"].rstrip("%")) / 100.0
    assert float(told["peak pressure [MPa]"]) == pytest.approx(ball.max_pressure, rel=error)
    assert card_of(contact()).sentences["note"] == (contact().status.value,)


@pytest.mark.usefixtures("_without_picture")
def test_of_many_torques_the_largest_is_shown():
    html = result(torques=(10.0, 50.0, 20.0, 30.0, 40.0))._repr_html_()
    assert "largest of 5 torques, key_figures() has all" in html
    assert re.findall(r"<th>(\S+)&nbsp;N|<th>([\d.]+)\xa0N", html) == [("", "50")]


def test_picture_is_drawn_when_the_card_is_shown():
    drawn = []
    card = notebook.Card("title", "about", draw=lambda: drawn.append(1) or Figure())
    assert not drawn
    card._repr_html_()
    assert drawn == [1]


def test_gears_that_cannot_be_and_pictures_that_there_are_not_are_told_in_the_card():
    pointed = read_scene(SCENES / "spur.toml").with_changes({"pinion.profile_shift": 2.5})
    assert "pointed" in pointed._repr_html_()

    def refused():
        raise InputError("a < b")

    assert "no picture: a &lt; b" in notebook.Card("title", "about", draw=refused).html
    nowhere = changed(with_a_gap(), peak_pressure=np.full_like(with_a_gap().peak_pressure, np.nan))
    assert notebook.PICTURES[type(nowhere)](nowhere) is None


@pytest.mark.usefixtures("_without_picture")
def test_dataset_of_a_study_has_a_card_on_request():
    html = card_of(grid(["ok", "refused", *["ok"] * 4])).html
    assert "a study: 6 variants: 5 ok, 1 refused" in html
    assert "refused: it is refused (1 variant)" in html
    with pytest.raises(InputError, match="card: found a Dataset; allowed a result, a rating"):
        card_of(cycle().dataset)
