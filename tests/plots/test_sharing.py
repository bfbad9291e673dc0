"""Pictures of the shared load: what is drawn is what the result holds."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.plots import (
    plot_contact_path,
    plot_line_load_distribution,
    plot_load_share,
    plot_path_pressure,
    sharing,
)
from tests.samples.results import changed_scene, result


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


def test_path_without_ends_on_the_flanks_has_no_marks_for_them():
    """Positions end where no contact has left the flanks yet."""
    cycle = result("mesh_cycle_bevel", positions=5, torques=(0.2,))
    assert set(marks(plot_path_pressure(cycle))) <= {"A", "C", "E"}


def test_hertz_is_drawn_beside_the_pressure_of_the_path():
    figure = plot_path_pressure(shared(torques=(40.0,)))
    labels = figure.axes[0].get_legend_handles_labels()[1]
    assert "after Hertz" in labels
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


def test_pair_at_the_pitch_point_has_no_sign():
    labels = plot_load_share(shared()).axes[0].get_legend_handles_labels()[1]
    assert labels == ["tooth pair -1", "tooth pair 0", "tooth pair +1"]


def test_colours_of_the_flanks_do_not_follow_the_spikes_of_edges():
    cycle = shared()
    assert cycle.peak_at_edge.any()
    bar = plot_contact_path(cycle).axes[-1]
    assert_allclose(bar.get_ylim()[1], np.nanmax(cycle.mesh_independent_pressure), rtol=1e-12)


def test_side_on_which_nothing_touches_has_no_mark(monkeypatch):
    def nothing_touches(*_, **__):
        raise GeometryError("no common flank")

    monkeypatch.setattr(sharing, "trace_contact", nothing_touches)
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


def test_load_shares_of_many_torques_stay_few():
    cycle = shared(torques=tuple(float(torque) for torque in range(10, 80, 10)))
    *panels, _ = plot_load_share(cycle).axes
    titles = [axes.get_title() for axes in panels]
    assert titles[0] == "pinion torque 10 N m"
    assert titles[-1] == "pinion torque 70 N m"
    assert len(titles) == 4


def test_contacts_at_an_edge_stand_above_the_pressure_not_at_zero():
    figure = plot_path_pressure(shared(torques=(40.0, 260.0)))
    figure.draw_without_rendering()
    (axes,) = figure.axes
    assert "contact at an edge (its peak is mesh-dependent)" in axes.get_legend_handles_labels()[1]
    marks = [line for line in axes.lines if line.get_marker() == "^" and len(line.get_xdata())]
    curves = [line.get_ydata() for line in axes.lines if line.get_linestyle() == "-" and len(line.get_xdata()) > 2]
    highest = max(float(np.nanmax(curve)) for curve in curves)
    assert marks
    for line in marks:  # their heights are parts of the axis
        assert min(line.get_ydata()) * axes.get_ylim()[1] > 1.02 * highest


def test_letters_say_what_they_are_and_do_not_cover_each_other():
    figure = plot_path_pressure(shared())
    figure.draw_without_rendering()
    (axes,) = figure.axes
    assert sharing.WHAT_LETTERS_ARE in axes.get_xlabel()
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
