"""The picture to look at first: its panels are those that a pair has, with the numbers of the scene."""

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from numpy.testing import assert_allclose

from loaded_tca.plots import plot_first_look
from loaded_tca.plots.style import note_of
from loaded_tca.scene import read_scene

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
HELICAL = SCENES / "helical.toml"
ROUNDING = 1e-9
"""Relative, of numbers that go through angles and roll lengths."""


@cache
def drawn(name, changes=()):
    scene = read_scene(SCENES / f"{name}.toml").with_changes(dict(changes))
    return scene, plot_first_look(scene)


def titles(figure):
    return [axes.get_title().split(",")[0] for axes in figure.axes]


def panel(figure, title):
    return next(axes for axes in figure.axes if axes.get_title().startswith(title))


def line(axes, label):
    return next(one.get_xydata() for one in axes.lines if one.get_label() == label)


def test_modifications_are_removed_where_the_scene_says():
    """A parabola to the ends of the face; of the wheel's tip relief all at its tip, at its roll angle, none below."""
    relief = (("wheel.modifications.tip_relief_um", 12.0), ("wheel.modifications.tip_relief_start_mm", 181.0))
    scene, figure = drawn("helical", relief)
    face = line(panel(figure, "modifications along the face"), "pinion")
    half, amount = 0.5 * scene.pinion.face_width_mm, scene.pinion.modifications.lead_crowning_um
    assert_allclose(face[:, 1], amount * (face[:, 0] / half) ** 2, rtol=1e-6, atol=1e-6)
    profile = line(panel(figure, "modifications along the profile"), "wheel")
    wheel = scene.mesh().wheel
    start, tip = (np.degrees(wheel.roll_length(radius) / wheel.base_radius) for radius in (90.5, wheel.tip_radius))
    assert_allclose(profile[-1], [tip, 12.0], rtol=1e-6)
    assert_allclose(profile[profile[:, 0] < start, 1], 0.0, atol=1e-6)
    assert (profile[profile[:, 0] > start, 1] > 0.0).all()


def test_panels_that_would_be_empty_are_left_out():
    """Of a pair with crowning alone that of the profile."""
    teeth = "teeth in mesh at the pitch point"
    assert titles(drawn("helical")[1]) == [teeth, "modifications along the face", "pinion", "wheel"]


def test_bevel_pairs_have_blanks_with_the_dimensions_of_their_cones():
    scene, figure = drawn("straight_bevel")
    blanks = ["blank of the pinion", "blank of the wheel"]
    modified = ["modifications along the profile", "modifications along the face"]
    assert titles(figure) == [*blanks, *modified, "straight flank of the pinion", "straight flank of the wheel"]
    mesh = scene.mesh()
    for title, gear in zip(blanks, (mesh.pinion, mesh.wheel), strict=True):
        heel = line(panel(figure, title), "pitch cone")[-1]
        assert_allclose(2.0 * heel[1], gear.teeth * gear.outer_module, rtol=ROUNDING)  # outer pitch diameter
        assert_allclose(np.hypot(*heel), gear.outer_cone_distance, rtol=ROUNDING)
        corners = panel(figure, title).patches[0].get_xy()
        assert_allclose(np.hypot(*corners.T).max(), gear.outer_cone_distance, rtol=ROUNDING)
    assert "tip clearance at the root of the pinion" in note_of(figure)


def test_path_of_contact_goes_from_the_beginning_to_the_end_of_a_tooth():
    """Unmodified flanks that stand true touch from A to E, whose diameters the path of contact has."""
    scene, figure = drawn("helical")
    path, mesh = line(panel(figure, "pinion"), "contact points without load"), scene.mesh()
    ends = [
        2.0 * np.hypot(length, mesh.pinion.base_radius) for length in (mesh.path_of_contact.A, mesh.path_of_contact.E)
    ]
    assert_allclose(sorted(path[[0, -1], 1]), ends, rtol=1e-5)  # contact_span narrows the ends down so far
    assert_allclose(path[:, 0], 0.0, atol=1e-3)  # in the middle of a crowned face


def test_active_part_of_an_undercut_pair_is_that_of_the_path_as_analysed():
    """The wheel's tip is not reached: its flank ends at A, so far from T2 on the line of action."""
    scene, figure = drawn("undercut_10x40")
    mesh = scene.mesh()
    line = np.sqrt(mesh.working_centre_distance**2 - (mesh.pinion.base_radius + mesh.wheel.base_radius) ** 2)
    begin = np.sqrt(mesh.pinion.form_radius**2 - mesh.pinion.base_radius**2)
    end = 2.0 * np.hypot(line - begin, mesh.wheel.base_radius)
    axes = next(one for one in figure.axes if f" to {end:.2f} mm" in one.get_title())
    grey, active = (patch.get_xy()[:, 1] for patch in axes.patches[:2])
    assert_allclose(active.max(), end, rtol=1e-5)  # interpolated between points along the profile
    assert_allclose(grey.max(), 2.0 * mesh.wheel.tip_radius, rtol=ROUNDING)
    rows = {label: cells for label, *cells in scene.geometry_rows()}
    assert rows["end of active profile d_Na [mm]"][1] == f"{end:.4f}"


@pytest.mark.thorough
def test_legend_of_the_teeth_does_not_hide_the_line_of_action():
    figure = drawn("undercut_10x40")[1]
    figure.canvas.draw()
    assert figure.legends[0].get_window_extent().y1 <= min(axes.get_window_extent().y0 for axes in figure.axes)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["rack_and_pinion", "hypoid_13x42", "double_helical", "planet_ring", "measured_flank"])
def test_every_family_has_its_panels(name):
    _, figure = drawn(name)
    assert titles(figure)[0].startswith("blank" if name == "hypoid_13x42" else "teeth in mesh")
    assert all(axes.has_data() for axes in figure.axes)
    if name == "rack_and_pinion":  # one unit for a roll angle and a straight flank
        assert panel(figure, "modifications along the profile").get_xlabel().startswith("height")


def test_check_writes_the_picture(run, tmp_path, monkeypatch):
    titles = []
    monkeypatch.setattr("loaded_tca.plots.plot_first_look", lambda scene: titles.append(scene.title) or Figure())
    code, out, _ = run("check", SCENES / "spur.toml", "--out", tmp_path / "out")
    assert (code, out.splitlines()[-1]) == (0, f"Written to {tmp_path / 'out'}: first_look.png")
    assert titles == [out.splitlines()[0]]
    assert (tmp_path / "out" / "first_look.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_check_writes_the_pictures_of_both_meshes_of_a_stage(run, tmp_path):
    code, out, _ = run("check", SCENES.parent / "stages" / "wind_spur.toml", "--out", tmp_path / "out")
    assert (code, out.split(": ")[-1]) == (0, "first_look_sun.png, first_look_ring.png\n")


def test_pictures_of_a_stage_have_the_names_of_its_gears(run, tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr("loaded_tca.plots.png_of", lambda figure: figures.append(figure) or b"")
    run("check", SCENES.parent / "stages" / "wind_spur.toml", "--out", tmp_path / "out")
    for figure, gears in zip(figures, (("sun", "planet"), ("planet", "ring")), strict=True):
        words = " ".join(text.get_text() for text in figure.findobj(Text))
        assert not re.search("pinion|wheel", words)
        labels = [text.get_text() for text in figure.legends[0].get_texts()]
        assert all(any(label.startswith(f"{gear}, ") for label in labels) for gear in gears)
