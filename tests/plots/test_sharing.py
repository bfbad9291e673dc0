"""Pictures of the shared load: what is drawn is what the result holds."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.plain import plain
from loaded_tca.plots import (
    plot_contact_path,
    plot_contact_patterns,
    plot_face_load,
    plot_full_mesh,
    plot_harmonics,
    plot_line_load_distribution,
    plot_load_share,
    plot_path_pressure,
    plot_peak_pressure,
    plot_pressure_envelope,
    sharing,
)
from loaded_tca.plots.flanks import draw_segments
from tests.samples.pictures import told
from tests.samples.results import changed, changed_scene, result, with_a_gap

ROUNDING = 1e-12
"""Of numbers that are drawn; matplotlib moves limits by parts of eps."""


def shared(name="mesh_cycle_helical", torques=(260.0,)):
    return result(name, positions=5, torques=torques)


def marks(figure):
    """Letter -> pinion angle [deg]."""
    return {text.get_text(): text.xy[0] for text in figure.axes[0].texts}


def test_marks_of_a_spur_pair_are_those_of_its_involutes():
    """Without relief a pair touches unloaded as long as its transverse contact ratio says."""
    changes = {f"{gear}.modifications.tip_relief_um": 0.0 for gear in ("pinion", "wheel")}
    cycle = changed_scene(shared("mesh_cycle_spur"), changes)
    mesh = cycle.scene.mesh()
    found = marks(plot_path_pressure(cycle))
    pitch = 360.0 / 34
    assert_allclose((found["E"] - found["A"]) / pitch, mesh.transverse_contact_ratio, rtol=1e-3)
    assert_allclose([found["B"], found["C"], found["D"]], [found["E"] - pitch, 0.0, found["A"] + pitch], atol=1e-9)
    assert found["A"] < found["B"] < found["C"] < found["D"] < found["E"]


@pytest.mark.thorough
def test_path_without_ends_on_the_flanks_has_no_marks_for_them():
    """Positions end where no contact has left the flanks yet."""
    cycle = result("mesh_cycle_bevel", positions=5, torques=(0.2,))
    assert set(marks(plot_path_pressure(cycle))) <= {"A", "C", "E"}


def test_hertz_is_drawn_beside_the_pressure_of_the_path():
    figure = plot_path_pressure(shared(torques=(40.0,)))
    labels = figure.axes[0].get_legend_handles_labels()[1]
    assert "after Hertz, where it holds" in labels
    drawn = [line for line in figure.axes[0].lines if line.get_linestyle() == "--" and len(line.get_xdata())]
    hertz = shared(torques=(40.0,)).hertz_pressure
    assert np.nanmax(drawn[0].get_ydata()) == np.nanmax(hertz)


@pytest.mark.parametrize("name", ["mesh_cycle_helical", "mesh_cycle_bevel"])
def test_line_load_on_the_flanks_carries_the_largest_line_load(name):
    cycle = shared(name, (1.0,))
    figure = plot_line_load_distribution(cycle)
    for axes in figure.axes[:2]:
        (lines,) = [one for one in axes.collections if isinstance(one, LineCollection)]
        # A segment has the mean of its ends; the top of a contact is flat.
        assert_allclose(lines.get_array().max(), np.nanmax(cycle.line_load), rtol=0.01)
    assert "[N/mm]" in figure.axes[2].get_ylabel()


def test_colours_of_line_loads_do_not_follow_a_single_slice():
    """One slice in several hundred has three times the largest line load: the label says so, the colours do not."""
    smooth = shared()
    one = smooth.maps[0][2][1]
    pressure = one.pressure.copy()
    pressure[:, np.flatnonzero(pressure.any(axis=0))[-1]] *= 50.0
    spike = pressure.sum(axis=0).max() * one.spacing[0]
    row = (smooth.maps[0][2][0], replace(one, pressure=pressure), *smooth.maps[0][2][2:])
    maps = ((*smooth.maps[0][:2], row, *smooth.maps[0][3:]), *smooth.maps[1:])
    line_load = smooth.line_load.copy()
    line_load[0, 2, 1] = spike
    assert spike > 1.5 * np.nanmax(smooth.line_load)
    before, after = (
        plot_line_load_distribution(cycle).axes[2]
        for cycle in (smooth, replace(changed(smooth, line_load=line_load), maps=maps))
    )
    assert after.get_ylim()[1] <= 1.1 * before.get_ylim()[1]
    assert before.get_ylabel() == "line load [N/mm]"
    assert after.get_ylabel().endswith(f"single slices up to {plain(spike)}; mesh-dependent at sharp ends")


def test_title_says_how_many_torques_have_panels():
    titles = [
        plot(result(torques=torques)).get_suptitle()
        for plot in (plot_load_share, plot_contact_patterns)
        for torques in ((20.0, 30.0, 40.0, 50.0, 80.0), (20.0, 80.0))
    ]
    assert ["(4 of 5 shown)" in title for title in titles] == [True, False, True, False]
    assert all("pinion torques 20 to 80 N m" in title for title in titles)


def test_lines_on_the_flanks_are_as_segments_one_by_one():
    """Segments of one colour in a row are one line with gaps; the colours are those of their values."""
    rng = np.random.default_rng(5)
    fields = np.stack(np.meshgrid(np.arange(8.0), np.arange(5.0)), axis=-1).reshape(-1, 1, 2)
    places = (fields + rng.uniform(0.2, 0.8, (40, 2, 2))) / (8.0, 5.0)  # each within a field of its own
    values, scale = np.repeat(rng.uniform(0.0, 3.0, 10), 4), Normalize(0.0, 3.0)
    single = LineCollection(list(places), array=values, cmap="viridis", norm=scale, linewidths=2.0)
    pictures = []
    for draw in (lambda axes: draw_segments(axes, places, values, scale), lambda axes: axes.add_collection(single)):
        figure = Figure(figsize=(2.0, 2.0))
        draw(figure.add_axes((0.0, 0.0, 1.0, 1.0), xlim=(0.0, 1.0), ylim=(0.0, 1.0)))
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        pictures.append(np.array(canvas.buffer_rgba()))
    assert_array_equal(*pictures)


def test_pair_at_the_pitch_point_has_no_sign():
    labels = plot_load_share(shared()).axes[0].get_legend_handles_labels()[1]
    assert labels == ["tooth pair -1", "tooth pair 0", "tooth pair +1"]


def test_colours_of_the_flanks_do_not_follow_the_spikes_of_edges():
    cycle = shared()
    bar = plot_contact_path(cycle).axes[-1]
    assert_allclose(bar.get_ylim()[1], np.nanmax(cycle.peak_pressure), rtol=ROUNDING)


def test_side_on_which_nothing_touches_has_no_mark(monkeypatch):
    def nothing_touches(*_, **__):
        raise GeometryError("no common flank")

    monkeypatch.setattr("loaded_tca.unloaded.path.trace_contact", nothing_touches)
    assert set(marks(plot_path_pressure(shared(torques=(40.0,))))) == {"C"}


def test_load_shares_of_all_torques_have_a_panel_each():
    cycle = shared(torques=(40.0, 260.0))
    *panels, below = plot_load_share(cycle).axes
    assert [axes.get_title() for axes in panels] == ["pinion torque 40 N m", "pinion torque 260 N m"]
    for axes, share in zip(panels, cycle.load_share, strict=True):
        drawn = np.array([line.get_ydata() for line in axes.get_lines()])
        assert_allclose(drawn.T, 100.0 * share)
    assert len(below.get_lines()) == 2
    assert len(plot_load_share(cycle, 1).axes) == 2


@pytest.mark.thorough
def test_load_shares_of_many_torques_stay_few():
    cycle = shared(torques=tuple(float(torque) for torque in range(10, 80, 10)))
    *panels, _ = plot_load_share(cycle).axes
    titles = [axes.get_title() for axes in panels]
    assert titles[0] == "pinion torque 10 N m"
    assert titles[-1] == "pinion torque 70 N m"
    assert len(titles) == 4


def test_path_has_the_peak_pressure_of_every_contact():
    """In the order of the angles from the pitch point of each pair."""
    cycle = shared(torques=(40.0, 260.0))
    lines = [line for line in plot_path_pressure(cycle).axes[0].lines if line.get_label().startswith("pinion torque")]
    for line, peaks in zip(lines, cycle.peak_pressure, strict=True):
        assert (np.diff(line.get_xdata()) >= 0.0).all()
        assert_allclose(sorted(line.get_ydata()), sorted(peaks[np.isfinite(peaks)]))


@pytest.mark.thorough
def test_table_of_the_path_has_lengths_roll_angles_and_diameters_beside_those_of_iso():
    """Without modifications both are those of the involutes: E is the tip of the pinion, A that of the wheel."""
    changes = {f"{gear}.modifications.tip_relief_um": 0.0 for gear in ("pinion", "wheel")}
    cycle = changed_scene(shared("mesh_cycle_spur"), changes)
    (table,) = plot_path_pressure(cycle).axes[1].tables
    cells = {at: cell.get_text().get_text() for at, cell in table.get_celld().items()}
    assert [cells[0, k] for k in range(5)] == list("ABCDE")
    assert [cells[row, -1] for row in (1, 2, 3)] == ["from T1 [mm]", "roll angle [deg]", "diameter [mm]"]
    base = 102.0 * np.cos(np.radians(20.0))  # 34 teeth of module 3
    distance, pitch = 0.5 * 91 * 3.0, np.pi * base / 34
    last = 0.5 * np.sqrt(108.0**2 - base**2)
    first = distance * np.sin(np.radians(20.0)) - 0.5 * np.sqrt(177.0**2 - (base * 57 / 34) ** 2)
    lengths = np.array([first, last - pitch, 51.0 * np.sin(np.radians(20.0)), first + pitch, last])
    rows = lengths, np.degrees(2.0 * lengths / base), 2.0 * np.hypot(lengths, 0.5 * base)
    for row, expected in enumerate(rows, start=1):
        for k, value in enumerate(expected):
            own, nominal = cells[row, k].split()
            assert nominal == f"({value:.3f})"
            assert_allclose(float(own), value, atol=5e-3)  # to 5e-5 of four pitches, and three digits


@pytest.mark.thorough
@pytest.mark.parametrize(
    "plot", [plot_harmonics, plot_load_share, plot_path_pressure, sharing.plot_mesh_stiffness, plot_peak_pressure]
)
def test_legends_are_no_wider_than_the_picture(plot):
    figure = plot(shared(torques=(40.0, 130.0, 260.0)))
    figure.draw_without_rendering()
    legend = figure.legends[0].get_window_extent()
    assert figure.bbox.x0 <= legend.x0 < legend.x1 <= figure.bbox.x1


def test_path_of_bevel_gears_has_no_table():
    assert len(plot_path_pressure(result("mesh_cycle_bevel", positions=5, torques=(0.2,))).axes) == 1


def test_orders_of_the_tooth_mesh_are_whole_numbers():
    axes = plot_harmonics(result("mesh_cycle_spur", positions=7, torques=(40.0, 130.0))).axes[0]
    assert axes.get_xticks().tolist() == [1, 2]
    assert axes.figure.axes[1].get_xlabel() == "order of the tooth mesh, of which the positions resolve 2"


@pytest.mark.thorough
def test_positions_too_few_for_any_order_are_told():
    for positions, expected in ((3, True), (4, False)):
        axes = plot_harmonics(result("mesh_cycle_spur", positions=positions, torques=(40.0,))).axes[0]
        assert any("the first needs 4 positions" in text.get_text() for text in axes.texts) is expected


@pytest.mark.thorough
def test_legend_of_the_load_shares_covers_no_curve():
    figure = plot_load_share(shared(torques=(40.0, 260.0)))
    assert all(axes.get_legend() is None for axes in figure.axes)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels[-2:] == ["pinion torque 40 N m", "pinion torque 260 N m"]
    figure.draw_without_rendering()
    assert figure.legends[0].get_window_extent().y1 < min(axes.get_window_extent().y0 for axes in figure.axes)
    widths = [line.get_linewidth() for line in figure.axes[-1].get_lines()]
    assert widths[0] > widths[1]  # where they lie on each other both are seen


def test_phases_are_drawn_where_the_amplitude_is_no_rounding():
    cycle = result("mesh_cycle_spur", positions=9, torques=(40.0, 130.0))
    angle = 34 * cycle.pinion_angle
    waves = np.stack([np.cos(angle + 0.5) + 0.02 * np.cos(2 * angle), np.cos(angle) + 0.005 * np.cos(2 * angle - 1.0)])
    cycle = changed(cycle, transmission_error=1e-5 * waves)
    bars, phases = plot_harmonics(cycle).axes
    first, second = phases.get_lines()
    assert_allclose(first.get_ydata(), [np.degrees(0.5), 0.0], atol=1e-6)
    assert_allclose(second.get_ydata(), [0.0], atol=1e-6)
    places = [[bar.get_x() + 0.5 * bar.get_width() for bar in one] for one in bars.containers]
    assert_allclose(first.get_xdata(), places[0][:2])
    assert_allclose(second.get_xdata(), places[1][:1])
    assert "[deg]" in phases.get_ylabel()


def envelope(cycle):
    """Picture of the pinion's flank: centres of its fields, the pressure in them, and the bar of colours."""
    figure = plot_pressure_envelope(cycle)
    (mesh,) = figure.axes[0].collections
    corners = mesh.get_coordinates()
    return 0.5 * (corners[:-1, :-1] + corners[1:, 1:]), mesh.get_array().filled(0.0), figure.axes[-1], mesh.get_clim()


def test_envelope_has_no_stripes_between_positions():
    """Contacts 1.3 mm apart and 0.2 mm wide: between the first and the last no place of the middle is left out."""
    cycle = shared("mesh_cycle_spur", torques=(130.0,))
    centres, pressure, _, _ = envelope(cycle)
    column = np.argmin(np.abs(centres[0, :, 0]))
    loaded = np.nonzero(pressure[:, column])[0]
    assert (pressure[loaded[0] : loaded[-1] + 1, column] > 0.0).all()
    apart = np.diff(2.0 * np.sort(cycle.peak_radius[np.isfinite(cycle.peak_radius)])).max()
    assert apart > 4.0 * np.nanmax(cycle.contact_width)
    assert centres[loaded[-1], 0, 1] - centres[loaded[0], 0, 1] > 3.0 * apart


@pytest.mark.parametrize("name", ["mesh_cycle_spur", "mesh_cycle_bevel"])
def test_envelope_reaches_the_highest_pressure_of_every_map_and_none_above(name):
    cycle = result(name, positions=5, torques=(1.0,))
    centres, pressure, _, _ = envelope(cycle)
    highest = [one.pressure.max() for row in cycle.maps[0] for one in row if one is not None]
    assert pressure.max() == max(highest)
    frame = cycle.gear_pair.pinion.flank.frame
    for n, k in np.argwhere(cycle.normal_force[0] > 0.0):
        x, y = frame.to_picture(cycle.peak_radius[0, n, k], cycle.peak_axial[0, n, k])
        row, column = np.argmin(np.abs(centres[:, 0, 1] - y)), np.argmin(np.abs(centres[0, :, 0] - x))
        around = pressure[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
        assert around.max() >= cycle.maps[0][n][k].pressure.max()


@pytest.mark.thorough
def test_scale_of_the_envelope_ends_at_the_highest_peak_pressure():
    cycle = shared()
    assert np.nanmax(cycle.edge_pressure) > 1.2 * np.nanmax(cycle.peak_pressure)
    _, _, bar, limits = envelope(cycle)
    assert_allclose(limits, (0.0, np.nanmax(cycle.peak_pressure)), rtol=ROUNDING)
    assert bar._colorbar.extend == "max"
    assert envelope(shared("mesh_cycle_spur", torques=(40.0,)))[2]._colorbar.extend == "neither"


@pytest.mark.thorough
def test_contact_patterns_are_the_envelopes_of_their_torques_on_one_scale():
    cycle = shared("mesh_cycle_spur", torques=(40.0, 130.0))
    *panels, bar = plot_contact_patterns(cycle).axes
    for torque in (0, 1):
        own = plot_pressure_envelope(cycle, torque).axes
        for axes, alone in zip(panels[2 * torque : 2 * torque + 2], own, strict=False):
            drawn, expected = axes.collections[0], alone.collections[0]
            assert_array_equal(drawn.get_array().filled(0.0), expected.get_array().filled(0.0))
            assert_allclose(drawn.get_clim(), (0.0, np.nanmax(cycle.peak_pressure)), rtol=ROUNDING)
            assert (axes.get_xlim(), axes.get_ylim()) == (alone.get_xlim(), alone.get_ylim())
    assert panels[0].get_ylabel().startswith("pinion torque 40 N m\n")
    assert panels[2].get_ylabel().startswith("pinion torque 130 N m\n")
    assert_allclose(bar.get_ylim()[1], np.nanmax(cycle.peak_pressure), rtol=ROUNDING)


@pytest.mark.thorough
def test_contact_patterns_of_many_torques_stay_few():
    cycle = shared(torques=tuple(float(torque) for torque in range(10, 80, 10)))
    *panels, _ = plot_contact_patterns(cycle).axes
    labels = [axes.get_ylabel().splitlines()[0] for axes in panels[::2]]
    assert (labels[0], labels[-1], len(labels)) == ("pinion torque 10 N m", "pinion torque 70 N m", 4)


@pytest.mark.parametrize(
    ("name", "torque"), [("mesh_cycle_helical", 260.0), ("mesh_cycle_bevel", 1.0), ("mesh_cycle_spur", 260.0)]
)
def test_full_mesh_has_every_loaded_pair_where_it_lies_with_its_share(name, torque):
    cycle = shared(name, torques=(torque,))
    figure = plot_full_mesh(cycle, 1)
    loaded = np.flatnonzero(cycle.normal_force[0, 1] > 0.0)
    assert loaded.size > 1
    frames = cycle.gear_pair.pinion.flank.frame, cycle.gear_pair.wheel.flank.frame
    for axes, frame, gear in zip(figure.axes, frames, ("pinion", "wheel"), strict=False):
        (areas,) = axes.collections
        assert areas.get_array().count() == sum((cycle.maps[0][1][k].pressure > 0.0).sum() for k in loaded)
        shares = [float(text.get_text().split()[-2]) for text in axes.texts]
        assert_allclose(sum(shares), 100.0, atol=0.1)  # of three digits each
        for text, column in zip(axes.texts, loaded, strict=True):
            assert text.get_text().startswith(f"pair {cycle.pair[column]:+d}:".replace("+0", "0"))
            radius, axial = (getattr(cycle.paths[column], f"{gear}_{part}")[1] for part in ("radius", "axial"))
            half_way = 3e-3  # mm: contacts lie in the middle of what the load turns their pairs
            assert_allclose(text.xy, frame.to_picture(radius, axial), atol=half_way)
    assert "position 2 of 5: pinion angle" in told(figure)


def test_full_mesh_is_that_of_the_peak_pressure_unless_told():
    cycle = shared()
    assert f"position {cycle.peak_contact(0)[0] + 1} of 5" in told(plot_full_mesh(cycle))
    with pytest.raises(IndexError, match="no tooth pair is in contact"):
        plot_full_mesh(with_a_gap(), 1)


def test_full_mesh_without_load_says_so():
    figure = plot_full_mesh(result(torques=(0.0,), positions=2))
    assert "no load, no pressure on the flanks" in told(figure)
    assert len(figure.axes) == 2  # no bar of colours


@pytest.mark.thorough
def test_rings_mark_positions_at_which_the_contact_of_the_path_reaches_an_edge():
    cycle = result("misaligned", positions=2)
    axes = plot_path_pressure(cycle).axes[0]
    rings = [line for line in axes.lines if line.get_fillstyle() == "none" and len(line.get_xdata())]
    reached = cycle.on_edge[0].astype(bool) & np.isfinite(cycle.peak_pressure[0])
    assert sum(len(line.get_xdata()) for line in rings) == reached.sum() > 0
    assert any("reaches an edge" in label for label in axes.get_legend_handles_labels()[1])


@pytest.mark.thorough
def test_letters_that_are_not_drawn_are_not_explained():
    """Of the spiral bevel pair more than one pair is in contact all the time: no B, no D."""
    figure = plot_path_pressure(result("mesh_cycle_bevel", positions=3))
    drawn = {text.get_text() for text in figure.axes[0].texts}
    label = told(figure).replace("\n", " ")
    assert drawn == {"A", "C", "E"}
    assert {letter for letter in "ABCDE" if f"{letter}: " in label} == drawn


@pytest.mark.thorough
def test_letters_say_what_they_are_and_do_not_cover_each_other():
    figure = plot_path_pressure(shared())
    figure.draw_without_rendering()
    axes, _ = figure.axes
    label = told(figure).replace("\n", " ")
    assert all(f"{letter}: {what}" in label for letter, what in sharing.WHAT_LETTERS_ARE.items())
    boxes = sorted((text.get_window_extent() for text in axes.texts), key=lambda box: box.x0)
    assert len(boxes) == 5
    assert all(one.x1 <= other.x0 for one, other in pairwise(boxes))


@pytest.mark.parametrize("plot", [sharing.plot_line_load, sharing.plot_mesh_stiffness])
def test_markers_at_the_top_are_whole(plot):
    (axes,) = plot(shared()).axes
    low, high = axes.get_ylim()
    highest = max(float(np.nanmax(line.get_ydata())) for line in axes.lines if len(line.get_xdata()))
    assert low == 0.0
    assert high > 1.05 * highest


def test_contact_points_of_every_pair_are_drawn():
    cycle = shared()
    points = [line for line in plot_contact_path(cycle).axes[0].get_lines() if line.get_marker() == "."]
    assert len(points) == len(cycle.pair)
    for line, path in zip(points, cycle.paths, strict=True):
        assert_allclose(line.get_ydata(), 2.0 * path.pinion_radius)


@pytest.mark.parametrize("name", ["mesh_cycle_helical", "mesh_cycle_bevel"])
def test_load_over_the_face_width_carries_the_force_and_has_the_load_factor(name):
    cycle = shared(name, (0.8, 1.6) if "bevel" in name else (40.0, 260.0))
    axes = plot_face_load(cycle).axes[0]
    for torque, steps in enumerate(axes.patches):
        load, borders, _ = steps.get_data()
        force = np.nansum(cycle.normal_force[torque, :-1], axis=-1).mean()  # N; the last position is the first one
        assert_allclose(load @ np.diff(borders), force, rtol=1e-6)
        assert_allclose(load.max() / load.mean(), cycle.face_load_factor[torque], rtol=ROUNDING)
        assert f"K_Hβ = {cycle.face_load_factor[torque]:.3g}" in steps.get_label()
        middles = 0.5 * (borders[1:] + borders[:-1] - borders[0] - borders[-1])
        assert f"centre {np.average(middles, weights=load):+.2g} mm from the middle" in steps.get_label()
    assert axes.get_xlabel() == cycle.gear_pair.pinion.flank.frame.labels[0]


def test_load_over_the_face_width_of_one_position_is_refused():
    """Its last position is the first one of the next pitch: there is none to take the mean of."""
    with pytest.raises(InputError, match="face load: a mean over a pitch; found 1 position, allowed 2 or more"):
        plot_face_load(result(positions=1))


def test_load_over_the_face_width_of_no_load_is_none():
    axes = plot_face_load(shared(torques=(0.0,))).axes[0]
    assert not axes.patches[0].get_data().values.any()
    assert axes.patches[0].get_label() == "pinion torque 0 N m"
