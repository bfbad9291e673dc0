"""The V-H check under load: each variant in its cell, on the flank where its pressure is."""

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.plots import plot_loaded_vh_check, png_of
from loaded_tca.plots.style import ACCENT
from loaded_tca.studies import load_study, run_study, vh_study
from tests.samples.pictures import told
from tests.samples.results import changed, result
from tests.samples.study_datasets import LEAD, dataset

V, H = "mounting.offset_mm", "mounting.pinion_axial_mm"


def cycle():
    return result("mesh_cycle_bevel", positions=3, torques=(0.2, 0.8))


def study(status=("ok",) * 6):
    """H from 0.02 down to -0.02, V of two values: variants need not be in the order of their values."""
    h, v = np.repeat([0.02, 0.0, -0.02], 2), np.tile([0.01, -0.01], 3)
    return dataset({H: h, V: v}, {}, list(status))


def panels(figure, rows=2, columns=3):
    return np.array(figure.axes[: rows * columns], dtype=object).reshape(rows, columns)


def framed(axes):
    return to_hex(axes.spines["top"].get_edgecolor()) == ACCENT


@pytest.mark.thorough
def test_variants_lie_where_their_errors_say():
    """Variant 1 alone has an edge: V = -0.01 below, H = 0.02 on the right."""
    off = changed(cycle(), on_edge=np.zeros_like(cycle().on_edge))
    on = changed(cycle(), on_edge=np.ones_like(cycle().on_edge))
    figure = plot_loaded_vh_check(study(), {k: on if k == 1 else off for k in range(6)})
    found = panels(figure)
    assert [[framed(axes) for axes in row] for row in found] == [[False] * 3, [False, False, True]]
    assert [axes.get_ylabel() for axes in found[:, 0]] == ["0.01", "-0.01"]
    assert [axes.get_xlabel() for axes in found[-1]] == ["-0.02", "0", "0.02"]
    assert figure.get_supylabel() == "V: offset [mm]"
    assert figure.get_supxlabel() == "H: axial displacement of the pinion [mm]"
    assert "6 variants: 6 ok" in told(figure)
    assert len(png_of(figure)) > 10_000


@pytest.mark.parametrize("count", [1, 2])
def test_legend_lies_within_a_picture_of_few_columns(count):
    """Title, note, names and legend lie within the picture, and the legend not over the panels."""
    h, v = np.repeat(0.01 * np.arange(count), 3), np.tile([0.05, 0.0, -0.05], count)
    one = changed(cycle(), on_edge=np.ones_like(cycle().on_edge))
    variants = dataset({H: h, V: v}, {}, ["ok"] * 3 * count)
    figure = plot_loaded_vh_check(variants, dict.fromkeys(range(3 * count), one))
    figure.draw_without_rendering()
    (legend,) = figure.legends
    for part in (legend, *figure.texts):
        box = part.get_window_extent()
        assert box.x0 >= 0.0, part
        assert box.x1 <= figure.bbox.x1, part
    assert legend.get_window_extent().y1 <= min(axes.get_tightbbox().y0 for axes in panels(figure, 3, count).ravel())


@pytest.mark.thorough
def test_legend_below_the_panels_tells_what_frames_and_dots_are():
    for on_edge, told_there in ((True, ["edge contact within the pitch"]), (False, [])):
        one = changed(cycle(), on_edge=np.full_like(cycle().on_edge, on_edge))
        figure = plot_loaded_vh_check(study(), dict.fromkeys(range(6), one))
        (legend,) = figure.legends
        assert [text.get_text() for text in legend.texts] == ["centre of the force", *told_there]
    assert legend.get_title().get_text() == "in each cell the tip is on top, the heel on the right; places in mm"
    figure.draw_without_rendering()
    name = figure._supxlabel.get_window_extent()
    assert legend.get_window_extent().y1 < name.y0
    assert name.y1 < min(axes.get_tightbbox().y0 for axes in panels(figure)[-1])
    assert "\n" not in figure.get_suptitle()


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_pattern_lies_around_the_centre_of_the_force(gear):
    """On a crowned flank the pressure is highest near it, and all cells share the scale of the highest peak."""
    figure = plot_loaded_vh_check(study(), dict.fromkeys(range(6), cycle()), gear=gear)
    axes = panels(figure)[0, 0]
    (mesh,) = [one for one in axes.collections if isinstance(one, QuadMesh)]
    row, column = np.unravel_index(np.nanargmax(mesh.get_array()), mesh.get_array().shape)
    corners = mesh.get_coordinates()[row, column]
    (dot,) = axes.lines
    span = np.ptp(axes.dataLim.get_points(), axis=0)
    assert np.all(np.abs(corners - dot.get_xydata()[0]) < 0.25 * span)
    assert_allclose(mesh.norm.vmax, np.nanmax(cycle().peak_pressure[1]), rtol=1e-12)  # the same number
    title = told(figure)
    assert f"loaded contact pattern on the {gear}, pinion torque 0.8 N m" in title


@pytest.mark.thorough
def test_smaller_torque_has_a_smaller_pattern():
    def size(torque):
        figure = plot_loaded_vh_check(study(), dict.fromkeys(range(6), cycle()), torque=torque)
        (mesh,) = [one for one in panels(figure)[0, 0].collections if isinstance(one, QuadMesh)]
        return np.isfinite(mesh.get_array().filled(np.nan)).sum()

    assert size(0) < size(1)


def test_failed_variants_are_named_in_their_cells():
    status = ["ok", "refused", "ok", "ok", "not converged", "ok"]
    kept = {k: cycle() for k in range(6) if status[k] == "ok"}
    found = panels(plot_loaded_vh_check(study(status), kept))
    texts = [[[text.get_text() for text in axes.texts] for axes in row] for row in found]
    assert texts == [[["not converged"], [], []], [[], [], ["refused"]]]


def test_cells_without_a_load_are_empty():
    empty = result("mesh_cycle_bevel", positions=3, torques=(0.0,))
    found = panels(plot_loaded_vh_check(study(), dict.fromkeys(range(6), empty)))
    assert not found[0, 0].collections


@pytest.mark.thorough
def test_kept_results_are_drawn_from_their_directory(tmp_path):
    few = {"analysis.positions": 2, "analysis.torques_Nm": [0.8]}
    grid = vh_study(cycle().scene.with_changes(few), v=[0.0], h=[0.0, 0.01])
    run_study(grid, out=tmp_path / "vh.nc", keep_maps=range(2))
    found = load_study(tmp_path / "vh.nc")
    assert found[H].attrs["sampling"] == "factor"
    shown = panels(plot_loaded_vh_check(found, tmp_path / "vh_maps"), 1, 2)
    assert all(axes.collections for axes in shown.ravel())
    (tmp_path / "vh_maps" / "1.nc").unlink()
    with pytest.raises(InputError, match=r"1\.nc: cannot be read"):
        plot_loaded_vh_check(found, tmp_path / "vh_maps")


@pytest.mark.parametrize(
    "keys", [{V: [0.0]}, {V: [0.0], H: [0.0], LEAD: [0.0]}, {V: [0.0], "analysis.compliance": ["contact"]}]
)
def test_other_studies_than_of_two_numbers_are_told(keys):
    with pytest.raises(
        InputError, match=r"V-H check: the study varies mounting\.offset_mm.*; allowed two keys with numbers"
    ):
        plot_loaded_vh_check(dataset(keys, {}), {0: cycle()})


def test_study_of_which_nothing_is_ok_is_told():
    with pytest.raises(InputError, match="V-H check: none of the 6 variants is ok; the first: it is refused"):
        plot_loaded_vh_check(study(["refused"] * 6), {})
