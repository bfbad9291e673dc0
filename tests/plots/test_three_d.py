import sys
from itertools import pairwise, product
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import proj3d
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.plots import save_figure
from loaded_tca.plots.three_d import plot_teeth, show_teeth
from tests.samples.pictures import told
from tests.samples.results import changed_scene, result, with_a_gap

ROUNDING = 1e-12
"""Of numbers that are drawn."""


def axes_of(figure):
    return figure.axes[0]


@pytest.mark.quick_cases("helical")
@pytest.mark.parametrize("name", ["helical", "straight_bevel", "spiral_bevel"])
def test_picture_says_units_load_and_place_and_is_saved(name, tmp_path):
    figure = plot_teeth(result(name, positions=3))
    axes = axes_of(figure)
    assert [axes.get_xlabel(), axes.get_ylabel(), axes.get_zlabel()] == ["x [mm]", "y [mm]", "z [mm]"]
    assert figure.axes[1].get_ylabel() == "contact pressure [MPa]"
    title = told(figure)
    assert "pinion torque" in title
    assert "pinion angle" in title
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["pinion's tooth", "wheel's tooth, see-through", "unloaded contact points of all positions"]
    save_figure(figure, tmp_path / "teeth.png")
    assert (tmp_path / "teeth.png").stat().st_size > 10_000


def test_scales_of_the_three_axes_are_equal():
    axes = axes_of(plot_teeth(result("spiral_bevel", positions=3)))
    spans = np.array([np.ptp(limits) for limits in (axes.get_xlim(), axes.get_ylim(), axes.get_zlim())])
    scale = axes._box_aspect / spans
    assert_allclose(scale, scale[0], rtol=1e-9)


@pytest.mark.thorough
def test_names_of_the_axes_are_upright_and_clear_of_the_numbers():
    for name in ("helical", "spiral_bevel", "misaligned", "fzg_c14"):
        figure = plot_teeth(result(name, positions=3))
        figure.draw_without_rendering()
        axes = axes_of(figure)
        assert [axis.label.get_rotation() for axis in (axes.xaxis, axes.yaxis, axes.zaxis)] == [0.0, 0.0, 90.0]
        legend = figure.legends[0].get_window_extent()
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            name = axis.label.get_window_extent()
            numbers = [one.label1.get_window_extent() for one in axis.get_major_ticks() if one.label1.get_text()]
            assert not name.overlaps(legend)
            assert not name.count_overlaps(numbers)
            assert all(not one.overlaps(other) for one, other in pairwise(numbers))


def test_colours_of_the_teeth_do_not_follow_the_spike_of_an_edge():
    cycle = result("fzg_c14", positions=3)
    bar = plot_teeth(cycle).axes[1]
    assert cycle.on_edge.all()
    assert_allclose(bar.get_ylim()[1], cycle.peak_pressure.max(), rtol=ROUNDING)
    assert bar._colorbar.extend == "max"


def test_colours_of_the_teeth_end_at_the_highest_pressure_of_all_positions():
    cycle = result()
    lowest = int(cycle.peak_pressure[0, :, 0].argmin())
    bar = plot_teeth(cycle, position=lowest).axes[1]
    assert_allclose(bar.get_ylim()[1], np.nanmax(cycle.peak_pressure), rtol=ROUNDING)
    assert bar._colorbar.extend == "neither"


def test_picture_without_load_has_no_pressure():
    figure = plot_teeth(result(torques=(0.0,), positions=2))
    assert len(figure.axes) == 1
    assert "no load, no pressure" in told(figure)


def test_title_is_taken_literally():
    cycle = changed_scene(result(positions=3), {"title": "$x_1 \\frac{ 100 %"})
    assert isinstance(plot_teeth(cycle), Figure)


def test_position_without_contact_is_refused():
    with pytest.raises(GeometryError, match="is not in contact"):
        plot_teeth(with_a_gap(), position=1)


def test_missing_pyvista_is_told_with_the_extra_that_brings_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(InputError, match=r"pyvista is not installed; .* pip install 'loaded_tca\[three-d\]'"):
        show_teeth(result(positions=3))


class Recorder:
    """Stands for pyvista: keeps what it is asked to show."""

    def __init__(self):
        self.meshes, self.points, self.view = [], None, None

    def module(self):
        return SimpleNamespace(PolyData=self.surface, Plotter=self.plotter)

    def plotter(self, off_screen):
        assert off_screen
        return self

    @staticmethod
    def surface(vertices, faces):
        return SimpleNamespace(vertices=vertices, faces=faces, cell_data={})

    def add_mesh(self, mesh, **style):
        self.meshes.append((mesh, style))

    def add_points(self, points, **_):
        self.points = points

    def show_bounds(self, **titles):
        assert all("[mm]" in titles[name] for name in ("xtitle", "ytitle", "ztitle"))

    def view_vector(self, vector, viewup):
        self.view = vector, viewup

    def show(self, **_):
        assert self.meshes


@pytest.mark.parametrize(("torques", "meshes"), [(None, 3), ((0.0,), 2)], ids=["pressure", "no load"])
def test_viewer_gets_both_teeth_the_path_and_the_pressure(monkeypatch, torques, meshes):
    recorder = Recorder()
    monkeypatch.setitem(sys.modules, "pyvista", recorder.module())
    cycle = result(positions=3, torques=torques)
    assert show_teeth(cycle, off_screen=True) is recorder
    assert len(recorder.meshes) == meshes
    assert len(recorder.points) == 3
    for mesh, _ in recorder.meshes:
        faces = mesh.faces.reshape(-1, 4)
        assert (faces[:, 0] == 3).all()
        assert faces.max() == len(mesh.vertices) - 1
    if torques is None:
        mesh, style = recorder.meshes[2]
        assert style["scalars"] in mesh.cell_data
        assert style["clim"] == (0.0, cycle.peak_pressure.max())
        assert style["clim"][1] >= mesh.cell_data["pressure_MPa"].max()
        assert "[MPa]" in style["scalar_bar_args"]["title"]


@pytest.mark.parametrize("name", ["helical", "spiral_bevel"])
def test_teeth_fill_their_frame(name):
    """Their box is seen whole, and reaches over most of the frame in one direction."""
    figure = plot_teeth(result(name, positions=3))
    figure.draw_without_rendering()
    axes = figure.axes[0]
    corners = np.array([*product(axes.get_xlim(), axes.get_ylim(), axes.get_zlim())]).T
    places = axes.transData.transform(np.column_stack(proj3d.proj_transform(*corners, axes.get_proj())[:2]))
    assert (places >= axes.bbox.p0).all()
    assert (places <= axes.bbox.p1).all()
    assert (np.ptp(places, axis=0) / axes.bbox.size).max() > 0.85
