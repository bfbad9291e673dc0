import io
import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.path import Path as Outline
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from loaded_tca.errors import InputError
from loaded_tca.plots import (
    plot_all,
    plot_contact_path,
    plot_full_mesh,
    plot_line_load_distribution,
    plot_peak_pressure,
    plot_pressure_envelope,
    plot_pressure_map,
    plot_stress_below,
    plot_teeth,
    plot_transmission_error,
    png_of,
    save_figure,
)
from loaded_tca.plots.flanks import CELLS_OF_SPIKES, ToPicture
from loaded_tca.plots.pressure_map import pressure_seen
from loaded_tca.plots.style import LARGEST_PICTURE, over_a_stretch
from loaded_tca.results.key_figures import ARCSEC
from loaded_tca.results.subsurface import stress_below
from tests.refusals import refused_calls
from tests.samples.pictures import told
from tests.samples.results import PER_PAIR, PER_POSITION, changed, changed_scene, result, with_a_gap

PLOTS = [plot_contact_path, plot_peak_pressure, plot_pressure_map, plot_transmission_error]


def nothing_touches():
    cycle = result()
    unknown = {name: np.full((1, 5), np.nan) for name in PER_POSITION}
    unknown |= {name: np.full((1, 5, 1), np.nan) for name in PER_PAIR if getattr(cycle, name).dtype.kind == "f"}
    return replace(changed(cycle, **unknown), maps=(((None,),) * 5,))


CASES = {
    "point contact": result,
    "several torques": lambda: result(torques=(20.0, 50.0, 80.0)),
    "positions without contact": with_a_gap,
    "edge contact, no Hertz": lambda: result("misaligned", positions=2),
    "line contact": lambda: result("fzg_c14", positions=3),
    "straight bevel pair": lambda: result("straight_bevel", positions=3),
    "spiral bevel pair": lambda: result("spiral_bevel", positions=3),
    "no load": lambda: result(torques=(0.0,), positions=2),
    "one position": lambda: result(positions=1),
    "title with signs of TeX": lambda: changed_scene(
        result(), {"title": "$x_1 \\frac{ 100 %, " + 13 * "a long title "}
    ),
}


def texts(figure):
    figure.draw_without_rendering()
    found = [told(figure)]
    for axes in figure.axes:
        found += [axes.get_title(), axes.get_xlabel(), axes.get_ylabel()]
        found += [child.get_ylabel() for child in axes.child_axes]
    return "\n".join(found)


def test_picture_of_too_many_colours_has_a_palette_and_stays_white_and_small(rng):
    """Thousands of lines, each of its own colour: 600 kB with all of their colours."""
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.add_subplot()
    lines = LineCollection(rng.uniform(size=(3000, 2, 2)), linewidths=1.0)
    lines.set_array(rng.uniform(size=3000))
    axes.add_collection(lines)
    content = png_of(figure)
    assert len(content) < LARGEST_PICTURE
    picture = Image.open(io.BytesIO(content))
    assert picture.mode == "P"
    assert picture.convert("RGB").getpixel((0, 0)) == (255, 255, 255)


def test_picture_of_few_colours_keeps_each():
    figure = Figure(figsize=(2.0, 2.0), facecolor="#12ab37", layout="constrained")
    picture = Image.open(io.BytesIO(png_of(figure)))
    assert (picture.mode, picture.getcolors()) == ("RGB", [(240 * 240, (0x12, 0xAB, 0x37))])
    assert picture.info["dpi"] == pytest.approx((120.0, 120.0), abs=0.1)  # stored in dots per metre


def test_each_flank_has_the_pressure_that_it_sees_and_keeps_it():
    """In one frame the wheel, which is larger, carries load farther from its axis; fields are computed once."""
    low, high = np.array([-20.0, 0.0]), np.array([20.0, 200.0])
    pictures = [ToPicture(result().gear_pair, gear) for gear in ("pinion", "wheel")]
    pinion, wheel = (pressure_seen(result(), 0, to_picture, low, high)[1] for to_picture in pictures)
    assert np.argmax(np.isfinite(wheel).any(axis=1)) > np.argmax(np.isfinite(pinion).any(axis=1))
    assert pressure_seen(result(), 0, pictures[1], low, high)[1] is wheel


@pytest.mark.quick_cases("no load")
@pytest.mark.parametrize("case", CASES)
def test_every_case_gives_every_picture(case, tmp_path):
    paths = plot_all(CASES[case](), tmp_path)
    always = {"contact_path", "transmission_error", "peak_pressure", "pressure_map"}
    assert {path.stem for path in paths} - {"pressure_map_hertz", "pressure_map_edge"} == always
    assert sorted(os.listdir(tmp_path)) == sorted(path.name for path in paths)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in paths)


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_map_with_the_ellipse_is_drawn_too_where_the_highest_pressure_has_none(tmp_path):
    hertz = result().hertz_pressure.copy()
    hertz[0][result().peak_contact(0)] = np.nan
    assert "pressure_map_hertz" in {path.stem for path in plot_all(changed(result(), hertz_pressure=hertz), tmp_path)}
    assert "pressure_map_hertz" not in {path.stem for path in plot_all(result(positions=1), tmp_path)}


@pytest.mark.usefixtures("blank_pictures")
def test_pictures_of_an_earlier_result_do_not_stay(tmp_path):
    for name in ("pressure_map_hertz.png", "pressure_map_edge.png", "mine.png"):
        (tmp_path / name).write_bytes(b"old")
    paths = plot_all(result(positions=1), tmp_path)
    assert sorted(os.listdir(tmp_path)) == sorted(["mine.png", *(path.name for path in paths)])


@pytest.mark.usefixtures("blank_pictures")
def test_peak_at_a_edge_has_a_map_of_its_own(tmp_path):
    cycle = result()
    relief_start = np.zeros((1, 5, 1), dtype=bool)
    relief_start[0, 4] = True
    assert cycle.peak_contact(0) != (4, 0)
    drawn = plot_all(changed(cycle, on_relief_start=relief_start), tmp_path)
    assert "pressure_map_edge" in {path.stem for path in drawn}


@pytest.mark.parametrize(("rounded", "kind"), [(False, "a sharp"), (True, "a rounded")])
def test_map_at_an_edge_tells_the_pressure_there_and_why_cells_have_less(rounded, kind):
    cycle = result()
    at = cycle.peak_contact(0)
    pressure, is_rounded = np.full((1, 5, 1), np.nan), np.full((1, 5, 1), rounded)
    pressure[0][at] = 2061.4
    found = told(plot_pressure_map(changed(cycle, edge_pressure=pressure, edge_is_rounded=is_rounded), *at[:1]))
    assert f"pressure at {kind} edge 2061 MPa" in found
    assert ("force of a cell that the edge cuts" in found) == (not rounded)
    assert "pressure at" not in told(plot_pressure_map(cycle, *at[:1])).partition("contact pressure")[2]


@pytest.mark.usefixtures("blank_pictures")
def test_map_and_flanks_of_one_torque_and_position(tmp_path):
    paths = plot_all(result(torques=(20.0, 80.0)), tmp_path, torque=0, position=3)
    assert {path.stem for path in paths} == {"contact_path", "transmission_error", "peak_pressure", "pressure_map"}


@pytest.mark.usefixtures("blank_pictures")
def test_nothing_touching_gives_all_but_the_pressure_map(tmp_path):
    assert "pressure_map" not in {path.stem for path in plot_all(nothing_touches(), tmp_path)}


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("plot", PLOTS)
def test_pictures_tell_load_position_and_units(plot):
    shown = texts(plot(result()))
    assert result().scene.title in shown
    assert "pinion torque 130 N m" in shown
    assert "pinion angle -5.294" in shown
    assert "[mm]" in shown or "[deg]" in shown


@pytest.mark.thorough
def test_transmission_error_is_drawn_in_arcsec_and_micrometres():
    figure = plot_transmission_error(result())
    absolute, _ = figure.axes
    unloaded, loaded = absolute.get_lines()
    assert_allclose(loaded.get_xdata(), np.degrees(result().pinion_angle))
    assert_allclose(loaded.get_ydata(), result().transmission_error[0] * ARCSEC)
    assert_allclose(unloaded.get_ydata(), result().path.transmission_error * ARCSEC)
    assert "[arcsec]" in texts(figure)
    assert "[µm]" in texts(figure)


def test_rounding_of_the_transmission_error_is_not_blown_up():
    for axes in plot_transmission_error(result(torques=(0.0,), positions=2)).axes:
        assert np.ptp(axes.get_ylim()) >= 0.02 * (1.0 - 1e-9)


def test_peak_pressure_is_drawn_beside_hertz():
    (axes,) = plot_peak_pressure(result(torques=(20.0, 50.0))).axes
    labels = axes.get_legend_handles_labels()[1]
    assert labels == ["pinion torque 20 N m", "pinion torque 50 N m", "after Hertz"]
    peak, hertz = axes.get_lines()[:2]
    assert_allclose(peak.get_ydata(), result(torques=(20.0, 50.0)).peak_pressure[0, :, 0])
    assert_allclose(hertz.get_ydata(), result(torques=(20.0, 50.0)).hertz_pressure[0, :, 0])
    assert hertz.get_zorder() < peak.get_zorder()
    assert hertz.get_color() == peak.get_color()


def drawn(axes, marker):
    """Lines of one marker that have points, not those of the legend."""
    return [line for line in axes.get_lines() if line.get_marker() == marker and len(line.get_xdata())]


def test_marks_at_a_edge_have_the_colours_of_their_torques():
    (axes,) = plot_peak_pressure(result("misaligned", positions=2, torques=(20.0, 80.0))).axes
    marks = [*drawn(axes, "x"), *drawn(axes, "^")]
    colours = {line.get_label(): line.get_color() for line in axes.get_lines() if "torque" in line.get_label()}
    assert {line.get_color() for line in marks} == set(colours.values())
    assert len(colours) == 2


def test_pressure_over_the_positions_begins_at_zero_with_its_markers_whole():
    (axes,) = plot_peak_pressure(result()).axes
    low, high = axes.get_ylim()
    assert low == 0.0
    assert high > 1.05 * result().peak_pressure.max()


def test_edge_contacts_are_marked_and_no_hertz_is_drawn():
    (axes,) = plot_peak_pressure(result("misaligned", positions=2)).axes
    labels = [line.get_label() for line in axes.get_lines()]
    assert "after Hertz" not in labels
    crosses = [*drawn(axes, "x"), *drawn(axes, "^")]
    assert sum(len(line.get_xdata()) for line in crosses) == 2
    assert {line.get_linestyle() for line in crosses} == {"None"}
    assert any("at a sharp edge (mesh-dependent)" in label for label in labels)
    assert_allclose(axes.get_lines()[0].get_ydata(), result("misaligned", positions=2).peak_pressure[0, :, 0])


def test_high_peaks_at_a_edge_do_not_rule_the_axis():
    cycle = result("mesh_cycle_helical", positions=5, torques=(260.0,))
    (axes,) = plot_peak_pressure(cycle).axes
    assert axes.get_ylim()[1] < np.nanmax(cycle.edge_pressure)
    assert "above" in axes.get_lines()[-1].get_label()
    (arrows,) = drawn(axes, "^")
    assert (arrows.get_ydata() < axes.get_ylim()[1]).all()


def test_rounded_edges_have_filled_markers_that_the_axis_follows():
    """A sharp one has a cross, or a triangle above the axis, as before."""
    cycle = result("misaligned", positions=2)
    rounded = np.array([True, False]).reshape(cycle.edge_is_rounded.shape)
    peak = float(cycle.peak_pressure.max())
    shown = np.where(rounded, 3.0 * peak, 2.0 * peak)
    (axes,) = plot_peak_pressure(changed(cycle, edge_is_rounded=rounded, edge_pressure=shown)).axes
    (filled,), (cross,) = drawn(axes, "p"), drawn(axes, "x")
    assert_allclose(filled.get_xydata(), [[np.degrees(cycle.pinion_angle[0]), 3.0 * peak]])
    assert_allclose(cross.get_xydata(), [[np.degrees(cycle.pinion_angle[1]), 2.0 * peak]])
    assert axes.get_ylim()[1] > 3.0 * peak
    assert filled.get_fillstyle() == "full"
    labels = axes.get_legend_handles_labels()[1]
    assert {"at a rounded edge", "at a sharp edge (mesh-dependent)"} <= set(labels)
    (all_rounded,) = plot_peak_pressure(changed(cycle, edge_is_rounded=np.ones_like(rounded))).axes
    assert "mesh-dependent" not in " ".join(all_rounded.get_legend_handles_labels()[1])


@pytest.mark.thorough
def test_labels_of_many_torques_stay_few():
    cycle = result(torques=tuple(float(torque) for torque in range(1, 31)), positions=1)
    labels = plot_peak_pressure(cycle).axes[0].get_legend_handles_labels()[1]
    assert len(labels) <= 8 + 3


def test_pressure_map_draws_the_ellipse_and_tells_its_scale():
    figure = plot_pressure_map(result(), position=2)
    axes = figure.axes[0]
    (ellipse,) = axes.patches
    assert_allclose(ellipse.width, 2.0 * result().hertz_semi_major[0, 2, 0])
    assert_allclose(ellipse.height, 2.0 * result().hertz_semi_minor[0, 2, 0])
    assert f"(drawn {axes.get_aspect():g} times larger)" in axes.get_ylabel()
    assert "position 3 of 5: pinion angle 0 deg" in texts(figure)


def test_pressure_map_marks_the_point_that_its_title_names():
    """Of gears that moved on their supports, whose map has another point in its middle."""
    cycle = result()
    one, path = cycle.maps[0][2][0], cycle.paths[0]
    moved = replace(cycle, paths=(replace(path, point=path.point + 0.3 * one.axes[1] - 0.1 * one.axes[0]),))
    for drawn, place in ((cycle, (0.0, 0.0)), (moved, (0.3, -0.1))):
        axes = plot_pressure_map(drawn, position=2).axes[0]
        (mark,) = (line for line in axes.lines if line.get_label() == "unloaded contact point")
        assert_allclose(np.ravel(mark.get_data()), place, atol=1e-3)  # cells of the search for the point


def test_pressure_map_leaves_cells_without_material_to_the_grey_ground():
    cycle = result("misaligned", positions=2)
    axes = plot_pressure_map(cycle, position=0).axes[0]
    ground = axes.collections[0].get_array().reshape(cycle.maps[0][0][0].gap.shape)
    assert (ground.mask == np.isinf(cycle.maps[0][0][0].gap)).all()


def test_pressure_map_tells_its_directions():
    cycle = result()
    one = cycle.maps[0][2][0]
    figure = plot_pressure_map(cycle, position=2)
    shown = texts(figure)
    assert "z > 0 on the right" in shown
    assert "pinion's tip on top" in shown
    assert figure.axes[0].xaxis.get_inverted() == (one.axes[1, 2] < 0)
    radius = np.hypot(*(one.origin + 0.1 * one.axes[0])[:2])
    assert figure.axes[0].yaxis.get_inverted() == (radius < cycle.path.pinion_radius[2])


def ends_of(collection):
    """Lower left and upper right of what is drawn of patches or of cells."""
    places = np.concatenate([path.vertices for path in collection.get_paths()])
    return places.min(axis=0), places.max(axis=0)


def test_contacts_of_positions_without_pressure_drawn_are_pale():
    cycle = result(positions=9)
    figure = plot_contact_path(cycle)
    pale, areas = figure.axes[0].collections
    loaded = [row[0].pressure > 0.0 for row in cycle.maps[0]]
    drawn = {round(8 * part / 6) for part in range(7)}
    assert areas.get_array().count() == sum(loaded[position].sum() for position in drawn)
    patches = sum(int((path.codes == Outline.MOVETO).sum()) for path in pale.get_paths())
    assert patches == sum(loaded[position].any(axis=0).sum() for position in {*range(9)} - drawn)
    pale_low, pale_high = ends_of(pale)
    low, high = ends_of(areas)
    assert (low < pale_low).all()
    assert (pale_high < high).all()
    assert figure.legends[0].get_title().get_text() == "pressure drawn at 7 of 9 positions, contacts of the others pale"


def test_contact_areas_lie_around_the_path_within_the_flank():
    cycle = result()
    for axes, radius in zip(
        plot_contact_path(cycle).axes, (cycle.path.pinion_radius, cycle.path.wheel_radius), strict=False
    ):
        (areas,) = axes.collections
        pressure = np.concatenate([row[0].pressure[row[0].pressure > 0.0] for row in cycle.maps[0]])
        values = areas.get_array()
        assert_array_equal(values.compressed(), pressure)  # of each map in turn, nothing between two of them
        corners = areas.get_coordinates()[:-1, :-1][~np.ma.getmaskarray(values)]
        ends = np.cumsum([(row[0].pressure > 0.0).sum() for row in cycle.maps[0]])
        for area, own in zip(np.split(corners, ends[:-1]), radius, strict=True):
            assert area[:, 0].min() < 0.0 < area[:, 0].max()
            assert area[:, 1].min() < 2.0 * own < area[:, 1].max()
            assert abs(area[:, 0]).max() < 13.5  # half of the face, and a part of a cell


@pytest.mark.quick_cases("straight_bevel")
@pytest.mark.parametrize("name", ["helical", "straight_bevel", "spiral_bevel"])
def test_flanks_are_drawn_with_the_part_that_the_mate_reaches(name):
    """The outline is the edge of the flank in its frame; the tip is common, the bottom of the reached part higher."""
    cycle = result(name)
    pair = cycle.gear_pair
    for axes, flank in zip(plot_contact_path(cycle).axes, (pair.pinion.flank, pair.wheel.flank), strict=False):
        whole, reached = (patch.get_path() for patch in axes.patches)
        across, up = flank.frame.to_picture(*flank.grid(33, 9))
        inner = np.stack([across[1:-1, 1:-1].ravel(), up[1:-1, 1:-1].ravel()], axis=-1)
        assert whole.contains_points(inner).all()
        assert_allclose(whole.get_extents().get_points(), [[across.min(), up.min()], [across.max(), up.max()]])
        assert whole.contains_points(reached.vertices[:-1] * 0.999 + inner.mean(axis=0) * 0.001).all()
        assert reached.get_extents().y0 > whole.get_extents().y0
        assert (axes.get_xlabel(), axes.get_ylabel()) == flank.frame.labels


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["straight_bevel", "spiral_bevel"])
def test_pictures_of_bevel_pairs_speak_of_toe_and_heel(name):
    cycle = result(name, positions=3)
    figure = plot_pressure_map(cycle, position=0)
    shown = texts(figure)
    assert "the heel on the right" in shown
    assert "pinion's tip on top" in shown
    assert "pitch cone" in shown
    one, frame = cycle.maps[0][0][0], cycle.gear_pair.pinion.flank.frame
    ends = one.origin, one.origin + 0.01 * one.axes[0], one.origin + 0.01 * one.axes[1]
    at, across, along = (frame.to_picture(np.hypot(*p[:2]), p[2]) for p in ends)
    assert figure.axes[0].yaxis.get_inverted() == (across[1] < at[1])
    assert figure.axes[0].xaxis.get_inverted() == (along[0] < at[0])
    flanks = plot_contact_path(cycle)
    assert "toe left, heel right" in texts(flanks)
    assert "concave" in flanks.axes[0].get_title() or name == "straight_bevel"


def test_colours_of_the_flanks_begin_at_zero():
    cycle = result()
    limits = plot_contact_path(cycle).axes[0].collections[0].get_clim()
    assert limits == (0.0, cycle.peak_pressure.max())
    assert limits[1] >= max(one.pressure.max() for (one,) in cycle.maps[0])


@pytest.mark.thorough
def test_pictures_of_one_torque_say_which_of_several():
    cycle = result(torques=(20.0, 80.0))
    for plot in (plot_contact_path, plot_pressure_map):
        assert "pinion torque 80 N m (the largest of 2)" in texts(plot(cycle))
        assert "pinion torque 20 N m (number 1 of 2)" in texts(plot(cycle, torque=0))


@pytest.mark.thorough
def test_pictures_without_load_say_so():
    cycle = result(torques=(0.0,), positions=2)
    figure = plot_pressure_map(cycle)
    assert "no contact pressure, pinion torque 0 N m" in texts(figure)
    assert len(figure.axes) == 1  # no colour bar
    assert "no load, no pressure" in [text.get_text() for text in figure.axes[0].texts]
    flanks = plot_contact_path(cycle)
    assert "no load, no pressure on the flanks" in texts(flanks)
    assert len(flanks.axes) == 2
    assert flanks.legends[0].get_title().get_text() == "pressure drawn at 0 of 2 positions"


def test_lines_of_a_title_are_no_wider_than_the_picture_and_none_is_a_mere_end():
    figure = plot_stress_below(stress_below(result("fzg_c14", positions=3)))
    figure.draw_without_rendering()
    (title,) = [text for text in figure.texts if text.get_text() == figure.get_suptitle()]
    assert title.get_window_extent().width < figure.bbox.width
    assert min(len(line) for line in title.get_text().splitlines()) > 10


def test_hertz_is_drawn_where_it_holds_over_a_stretch_alone():
    assert_array_equal(over_a_stretch(np.array([1.0, np.nan, 2.0, 3.0])), [np.nan] * 4)
    assert_array_equal(over_a_stretch(np.array([1.0, np.nan, 2.0, 3.0, 4.0])), [np.nan, np.nan, 2.0, 3.0, 4.0])
    assert_array_equal(over_a_stretch(np.array([1.0, 2.0])), [1.0, 2.0])  # there are no more positions
    assert_array_equal(over_a_stretch(np.array([1.0, np.nan])), [np.nan, np.nan])
    cycle = result()
    single = np.where(np.arange(5) == 2, cycle.hertz_pressure[0, :, 0], np.nan)[None, :, None]
    labels = plot_peak_pressure(changed(cycle, hertz_pressure=single)).axes[0].get_legend_handles_labels()[1]
    assert "after Hertz" not in labels


def test_area_of_a_line_after_hertz_is_a_strip():
    cycle = result("fzg_c14", positions=1)
    (strip,) = plot_pressure_map(cycle).axes[0].patches
    assert isinstance(strip, Rectangle)
    assert_allclose(strip.get_width(), 14.0, rtol=1e-6)
    assert_allclose(strip.get_height(), 2.0 * cycle.hertz_semi_minor.item())


def test_pictures_touch_no_global_state():
    before = sys.modules.get("matplotlib.pyplot")
    plot_peak_pressure(result())
    assert sys.modules.get("matplotlib.pyplot") is before


test_plots_refuses = refused_calls(
    (lambda: plot_pressure_map(with_a_gap(), position=1), "is not in contact"),
    (lambda tmp_path: save_figure(Figure(), tmp_path / "absent" / "a.png"), "cannot be written", InputError),
    error=IndexError,
)


@pytest.mark.parametrize(("name", "torques"), [("fzg_c14", None), ("mesh_cycle_helical", (260.0,))])
def test_colours_of_a_edge_map_do_not_follow_its_spike(name, torques):
    """A line that ends at the faces, and a tip corner, whose cells are nearly all above its peak pressure."""
    cycle = result(name, positions=3, torques=torques)
    at = cycle.edge_contact(0)
    bar = plot_pressure_map(cycle, at[0], 0, at[1]).axes[-1]
    one = cycle.maps[0][at[0]][at[1]].pressure
    assert cycle.peak_pressure[0][at] <= bar.get_ylim()[1] < one.max()
    assert (one > bar.get_ylim()[1]).sum() <= 0.05 * (one > 0.0).sum() + 1
    assert f"up to {one.max():.0f}" in bar.get_ylabel()


@pytest.mark.parametrize(("part", "told"), [(0.001, False), (0.1, True)])
def test_legend_of_the_flanks_names_a_grey_area_only_where_it_is_seen(part, told, monkeypatch):
    scene = result().scene
    pair = scene.pair()
    heights = [flank.profile_coordinate(*flank.grid(129, 33)).value for flank in (pair.pinion.flank, pair.wheel.flank)]
    starts = tuple(float(height.min() + part * np.ptp(height)) for height in heights)
    monkeypatch.setattr(type(scene), "active_starts", lambda _: starts)
    monkeypatch.setattr(type(scene), "active_ends", lambda _: (np.inf, np.inf))
    names = [text.get_text() for text in plot_contact_path(result()).legends[0].get_texts()]
    assert ("flank that the mating gear does not reach" in names) is told


@pytest.mark.parametrize("position", [None, 0])
def test_pressure_maps_of_several_torques_have_one_scale(position):
    cycle = result("mesh_cycle_helical", positions=3, torques=(40.0, 260.0))
    ends = {plot_pressure_map(cycle, position, torque).axes[-1].get_ylim() for torque in (0, 1)}
    ((low, high),) = ends
    assert low == 0.0
    assert high >= np.nanmax(cycle.peak_pressure)


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("plot", [plot_contact_path, plot_full_mesh, plot_pressure_envelope, plot_teeth])
def test_pressures_on_the_flanks_have_one_scale_for_all_torques(plot):
    cycle = result("mesh_cycle_helical", positions=3, torques=(40.0, 260.0))
    bars = [plot(cycle, torque=torque).axes[-1] for torque in (0, 1)]
    assert bars[0].get_ylim() == bars[1].get_ylim()
    assert bars[0].get_ylim()[1] >= np.nanmax(cycle.peak_pressure)


def test_line_loads_on_the_flanks_have_one_scale_for_all_torques():
    cycle = result("mesh_cycle_helical", positions=3, torques=(40.0, 260.0))
    ends = [plot_line_load_distribution(cycle, torque).axes[-1].get_ylim()[1] for torque in (0, 1)]
    assert_allclose(ends, np.nanmax(cycle.line_load))


def test_scale_of_a_pressure_map_can_be_given():
    bar = plot_pressure_map(result(), position=2, highest=5e3).axes[-1]
    assert bar.get_ylim() == (0.0, 5e3)
    with pytest.raises(InputError, match=r"^highest: -1.0 is not positive and finite$"):
        plot_pressure_map(result(), highest=-1.0)
    with pytest.raises(InputError, match=r"^highest: 'a' is not positive and finite$"):
        plot_pressure_map(result(), highest="a")


def test_words_on_the_end_of_the_colours_are_those_of_the_pictures():
    files = Path(__file__).parents[2] / "docs" / "reference" / "files.md"
    for words in (files.read_text(encoding="utf-8"), plot_pressure_map.__doc__):
        assert f"at most {100.0 * CELLS_OF_SPIKES:g} % of the cells under pressure lie beyond" in " ".join(
            words.split()
        )
