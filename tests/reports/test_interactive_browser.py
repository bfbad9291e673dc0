"""Interactive pages in a real browser: what they show is in the arrays, by mouse and by keyboard, narrow and dark."""

import json
import math
import re
import shutil
import time
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.reports import explore
from tests.samples import root_stress
from tests.samples.study_datasets import LEAD, grid

webdriver = pytest.importorskip("selenium.webdriver", reason="needs the package selenium")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
DRIVER = shutil.which("chromedriver")
pytestmark = pytest.mark.skipif(not (CHROMIUM and DRIVER), reason="needs a browser: chromium and chromedriver")

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",  # WebGL without a graphics processor
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--host-resolver-rules=MAP * ~NOTFOUND",  # no network
)
PATIENCE = 120.0
"""Seconds after which a page that is not drawn never will be."""
TAB, END, HOME, LEFT, RIGHT, DOWN = "\ue004\ue010\ue011\ue012\ue014\ue015"
"""Keys."""
DIGITS = 1e-4
"""Five significant digits, as pictures show numbers."""


class Browser:
    """A page in a browser of a width, and what tests ask of it."""

    def __init__(self, folder):
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for flag in (*FLAGS, f"--user-data-dir={folder / 'profile'}"):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
        self.folder = folder

    def open(self, page):
        path = page.save(self.folder / "page.html")
        self.driver.get("about:blank")
        self.driver.get_log("performance")  # of what the browser itself begins with
        self.driver.get(path.as_uri())
        self.until(lambda: self.run("return document.documentElement.dataset.ready || !problem.hidden"))
        return self

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, holds):
        end = time.monotonic() + PATIENCE
        while not (value := holds()):
            assert time.monotonic() < end, "the page does not come to it"
            time.sleep(0.05)
        return value

    def settled(self):
        """Wait until the page has drawn what was asked."""
        wait = "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))"
        self.driver.execute_async_script(wait)

    def look(self, width, scheme):
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        self.settled()

    def press(self, name, *keys):
        """Press keys on a control that has the focus."""
        self.run("document.getElementById(arguments[0]).focus()", name)
        for key in keys:
            self.driver.switch_to.active_element.send_keys(key)
        self.settled()

    def point_at(self, picture, x, y, click=False):
        """Move the mouse to a place of a picture, in the units of its axes."""
        find = """const div = document.getElementById(arguments[0]), { xaxis, yaxis } = div._fullLayout;
            div.scrollIntoView({ block: "center" });
            const box = div.getBoundingClientRect();
            const [x, y] = [xaxis, yaxis].map((axis, k) => axis._offset + axis.d2p(arguments[1 + k]));
            return [box.left + x, box.top + y];"""
        place = None
        # pictures that come into the window are drawn, which may move this one
        while (now := self.run(find, picture, x, y)) != place:
            place = now
            self.settled()
        move = {"type": "mouseMoved", "x": place[0], "y": place[1]}
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", move | {"x": place[0] - 2.0})
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", move)
        if click:
            for kind in ("mousePressed", "mouseReleased"):
                press = {"type": kind, "button": "left", "clickCount": 1}
                self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", move | press)

    def hover_text(self, picture):
        find = "return document.querySelector(`#${arguments[0]} .hoverlayer .hovertext`)?.textContent"
        return self.until(lambda: self.run(find, picture))

    def trace(self, picture, number, name):
        find = "return document.getElementById(arguments[0]).data[arguments[1]][arguments[2]]"
        return self.run(find, picture, number, name)

    def show(self, picture):
        """Bring a picture into the window, where it is drawn."""
        self.run("document.getElementById(arguments[0]).scrollIntoView({ block: 'center' })", picture)
        self.settled()
        self.until(lambda: self.run("return document.getElementById(arguments[0]).data !== undefined", picture))

    def numbers(self, picture):
        """Numbers of the heat map of a picture, without those that are missing."""
        values = np.array(self.trace(picture, int(picture == "map"), "z"), dtype=float)
        return np.sort(values[np.isfinite(values)])


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    browser = Browser(tmp_path_factory.mktemp("browser"))
    browser.driver.set_script_timeout(PATIENCE)
    yield browser
    browser.driver.quit()


def subject():
    return root_stress.result()


@pytest.fixture(scope="module")
def page(browser):
    """The page of a result of two torques and five positions, with root stress."""
    return browser.open(explore(subject()))


def reset(page):
    """The page as it begins: the position of the largest pressure under the largest torque."""
    page.look(1200, "light")
    page.run("for (const id of ['pair', 'gear']) document.getElementById(id).selectedIndex = 0")
    place = subject().peak_contact(1)
    page.show("map")
    page.press("position", HOME, *[RIGHT] * place[0])
    page.press("torque", END)
    return place


def loaded_cells(torque, position, pair):
    pressure = subject().maps[torque][position][pair].pressure
    return np.sort(pressure[pressure > 0.0])


def test_page_is_drawn_without_an_error_or_a_request(page):
    """Nor is there a button that sends anything."""
    assert page.run("return problem.hidden")
    pictures = page.run("return [...document.querySelectorAll('.plot')].map((one) => one.id)")
    assert {"map", "flank", "envelope", "line-load", "panel-0", "space"} <= set(pictures)
    for picture in pictures:
        page.show(picture)
        assert page.run("return document.getElementById(arguments[0]).data.length", picture) > 0, picture
    assert [one["message"] for one in page.driver.get_log("browser") if one["level"] == "SEVERE"] == []
    events = [json.loads(one["message"])["message"] for one in page.driver.get_log("performance")]
    asked = [one["params"]["request"]["url"] for one in events if one["method"] == "Network.requestWillBeSent"]
    asked = [url for url in asked if not url.startswith(("data:", "blob:", "about:"))]
    assert asked == [(page.folder / "page.html").as_uri()]
    titles = page.run("return [...document.querySelectorAll('.modebar-btn')].map((one) => one.dataset.title)")
    assert titles
    assert not [title for title in titles if re.search("share|cloud|edit", title, re.IGNORECASE)]


def test_arrow_keys_on_sliders_move_the_map_and_all_that_is_linked(page):
    """Maps within a 65534th of the largest of 1,500 MPa, curves to the last digit."""
    position, pair = reset(page)
    assert_allclose(page.numbers("map"), loaded_cells(1, position, pair), atol=0.03)
    step = 1 if position < 4 else -1
    page.press("position", RIGHT if step > 0 else LEFT)
    beside = position + step
    assert_allclose(page.numbers("map"), loaded_cells(1, beside, subject().peak_column[1, beside]), atol=0.03)
    value = page.run("return document.getElementById('position').getAttribute('aria-valuetext')")
    assert value.startswith(f"{beside + 1} of 5: pinion angle")
    page.press("torque", HOME)
    assert_allclose(page.numbers("map"), loaded_cells(0, beside, subject().peak_column[0, beside]), atol=0.03)
    page.show("panel-1")
    mark = page.run("return document.getElementById('panel-1').layout.shapes[0].x0")
    # deg and um, also below: numbers of the page have all digits
    assert mark == pytest.approx(math.degrees(subject().pinion_angle[beside]), abs=1e-12)
    error = 1e3 * subject().wheel_base_radius * subject().transmission_error
    assert_allclose(page.trace("panel-1", 0, "y"), error[0], rtol=1e-12)
    page.show("line-load")
    loads = page.run("return document.getElementById('line-load').data.map(({ y }) => Math.max(...y))")
    loaded = [one for one in subject().maps[0][beside] if one is not None and one.pressure.any()]
    assert_allclose(loads, [(one.pressure.sum(axis=0) * one.spacing[0]).max() for one in loaded], rtol=1e-4)


def test_hover_shows_the_value_of_the_array(page):
    position, pair = reset(page)
    one = subject().maps[1][position][pair]
    across, along = np.unravel_index(np.abs(one.pressure - 0.6 * one.pressure.max()).argmin(), one.pressure.shape)
    page.point_at("map", float(one.y[along]), float(one.x[across]))
    (value,) = re.findall(r"([\d.]+) MPa", page.hover_text("map"))
    assert float(value) == pytest.approx(one.pressure[across, along], rel=DIGITS)
    error = 1e3 * subject().wheel_base_radius * subject().transmission_error[1, 2]
    page.show("panel-1")
    page.point_at("panel-1", math.degrees(subject().pinion_angle[2]), float(error))
    text = page.hover_text("panel-1")
    (value,) = re.findall(r"under load: ([-\d.]+) µm", text)
    assert float(value) == pytest.approx(error, rel=DIGITS)


@pytest.mark.thorough
def test_click_on_a_curve_sets_the_position(page):
    reset(page)
    page.show("panel-2")
    share = 100.0 * subject().load_share[1, 1, 0]
    page.point_at("panel-2", math.degrees(subject().pinion_angle[1]), float(share), click=True)
    page.until(lambda: page.run("return document.getElementById('position').value") == "1")


@pytest.mark.thorough
def test_flank_of_the_other_gear_is_chosen_by_keyboard(page):
    reset(page)
    page.show("flank")
    diameters = "return document.getElementById('flank').layout.yaxis.range"
    before = page.run(diameters)
    page.press("gear", DOWN)
    assert page.run(diameters)[0] > before[1]  # of the wheel
    position = subject().peak_contact(1)[0]
    largest = max(one.pressure.max() for one in subject().maps[1][position] if one)
    assert page.numbers("flank").max() == pytest.approx(largest, rel=DIGITS)


def test_teeth_are_in_view_from_end_to_end(page):
    """Within the cone of view of 45 deg about the camera, whichever way they turn: the box has the volume 1."""
    reset(page)
    page.show("space")
    sides = page.run(
        "return ['x', 'y', 'z'].map((axis) => {"
        "const all = document.getElementById('space').data.flatMap((trace) => Array.from(trace[axis]));"
        "return all.reduce((a, b) => Math.max(a, b)) - all.reduce((a, b) => Math.min(a, b));"
        "})"
    )
    eye = page.run("return ['x', 'y', 'z'].map((k) => document.getElementById('space').layout.scene.camera.eye[k])")
    radius = 0.5 * math.hypot(*sides) / math.cbrt(math.prod(sides))
    assert math.hypot(*eye) * math.sin(math.radians(22.5)) >= (1.0 - 1e-9) * radius  # sums of rounded numbers


@pytest.mark.thorough
def test_teeth_turn_by_keyboard(page):
    reset(page)
    page.show("space")
    eye = "return document.getElementById('space').layout.scene.camera.eye"
    before = page.run(eye)
    page.press("turn", *[RIGHT] * 3)
    after = page.run(eye)
    turned = math.degrees(math.atan2(after["y"], after["x"]) - math.atan2(before["y"], before["x"]))
    assert turned == pytest.approx(15.0, abs=1e-6)
    assert after["z"] == pytest.approx(before["z"])
    page.press("zoom", RIGHT)
    assert np.linalg.norm([*page.run(eye).values()]) < np.linalg.norm([*after.values()])


@pytest.mark.thorough
def test_tab_key_comes_to_every_control_and_shows_where_it_is(page):
    page.look(1200, "light")
    page.run("document.activeElement.blur(); getSelection().collapse(document.querySelector('h1'), 0)")
    controls = set(page.run("return [...document.querySelectorAll('input, select')].map((one) => one.id)"))
    shown = {}
    for _ in range(150):  # buttons of all pictures, too
        if controls <= shown.keys():
            break
        webdriver.ActionChains(page.driver).send_keys(TAB).perform()
        name, width = page.run(
            "return [document.activeElement].map((at) => [at.id, getComputedStyle(at).outlineWidth])[0]"
        )
        shown[name] = width
    assert controls <= shown.keys()
    assert {shown[name] for name in controls} == {"3px"}


@pytest.mark.quick_cases("1200-light", "400-dark")
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1200, 400])
def test_page_fits_its_window_and_is_legible(page, width, scheme):
    """No sideways scrolling; text on its ground has the contrast of WCAG AA."""
    page.look(width, scheme)
    inside = "return document.documentElement.scrollWidth <= window.innerWidth"
    page.until(lambda: page.run(inside))
    page.show("map")
    widths = "const one = document.getElementById('map'); return [one.clientWidth, one._fullLayout.width]"
    page.until(lambda: abs(np.subtract(*page.run(widths))) < 1.0)  # after the window has changed
    colours = page.run(
        """const style = getComputedStyle(document.documentElement);
        const of = (name) => style.getPropertyValue(`--${name}`).trim();
        const [grounds, texts] = [["ground", "card", "plot"], ["text", "faint"]].map((names) => names.map(of));
        return { grounds, texts, lines: of("lines").split(" ") };"""
    )
    assert (luminance(colours["grounds"][0]) < 0.05) == (scheme == "dark")
    for ground in colours["grounds"]:
        assert min(contrast(text, ground) for text in colours["texts"]) >= 4.5
        assert min(contrast(line, ground) for line in colours["lines"]) >= 2.0  # and dashes tell them apart
    page.until(lambda: page.run("return document.getElementById('map').layout.font.color") == colours["texts"][0])


@pytest.mark.thorough
def test_colours_of_maps_grow_lighter_for_every_reader(page):
    """Lightness alone tells values apart; of curves the dashes do."""
    scale = page.run("return document.getElementById('map')._fullData[1].colorscale")
    levels = [luminance(code) for _, code in scale]
    assert all(second > first for first, second in pairwise(levels))
    page.show("panel-3")
    dashes = page.run("return document.getElementById('panel-3').data.map((one) => one.line.dash)")
    assert len(set(dashes)) == len(dashes)


def luminance(code):
    """Relative luminance of a colour #rrggbb, WCAG 2."""
    parts = np.array([int(code[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(first, second):
    low, high = sorted((luminance(first), luminance(second)))
    return (high + 0.05) / (low + 0.05)


def test_click_on_a_dot_shows_the_numbers_of_its_variant(browser):
    """And a range of an axis of the parallel coordinates leaves the others pale."""
    study = grid(["ok"] * 5 + ["refused"])
    page = browser.open(explore(study))
    page.look(1200, "light")
    assert page.run("return problem.hidden")
    assert page.run("return document.getElementById('variant').value") == "3"  # the best
    error = float(study["transmission_error_span_um"][4, 0])
    page.point_at("scatter", float(study[LEAD][4]), error, click=True)
    page.until(lambda: page.run("return document.getElementById('variant').value") == "4")
    page.settled()
    rows = "[...document.querySelectorAll('#numbers tr')]"
    cells = page.run(f"return {rows}.map((row) => [...row.cells].map((cell) => cell.textContent))")
    assert ["pinion lead crowning [µm]", "6"] in cells
    assert ["peak-to-peak transmission error [µm]", "110"] in cells  # 1 + 3^2 + 10^2
    page.run("return Plotly.restyle('parallel', { 'dimensions[0].constraintrange': [[2, 4]] })")
    page.until(lambda: page.trace("scatter", 0, "marker")["opacity"] == [0.12, 0.12, 1, 1, 0.12])
    page.press("variant", END)
    assert page.run("return document.getElementById('numbers').textContent").startswith("it is refused")
    page.look(400, "dark")
    page.until(lambda: page.run("return document.documentElement.scrollWidth <= window.innerWidth"))
    assert [one["message"] for one in page.driver.get_log("browser") if one["level"] == "SEVERE"] == []
