"""Pictures of studies: what is drawn is what the study holds, and nothing that failed is left out unsaid."""

import itertools

import numpy as np
import pytest
from matplotlib.collections import PolyCollection, QuadMesh
from matplotlib.patches import Rectangle
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.plots import (
    plot_study,
    plot_study_heat_map,
    plot_study_histogram,
    plot_study_lines,
    plot_study_over_torque,
    plot_study_ranking,
    plot_study_scatter_matrix,
    png_of,
)
from loaded_tca.plots.style import label_of
from loaded_tca.studies import rank_combinations
from tests.refusals import refused_calls
from tests.samples.pictures import told
from tests.samples.study_datasets import LEAD, MISALIGNMENT, SCENE, TIP, dataset, grid, sampled

SPAN, PRESSURE = "transmission_error_span_um", "peak_pressure_MPa"
TWO_FAIL = ["ok", "refused", "ok", "ok", "not converged", "ok"]


def title(figure):
    return told(figure)


def crosses(axes):
    """Places of all crosses in a panel."""
    return np.concatenate([np.zeros((0, 2)), *(line.get_xydata() for line in axes.lines if line.get_marker() == "x")])


def curves(axes):
    return [line for line in axes.lines if line.get_marker() != "x"]


def heights(bars):
    return [bar.get_height() for bar in bars.patches]


@pytest.mark.parametrize(
    ("name", "label"),
    [
        (LEAD, "pinion lead crowning [µm]"),
        ("wheel.teeth", "wheel teeth"),
        ("mounting.out_of_plane_deg", "axis error out of plane [deg]"),
        ("load.pinion_torque_Nm", "pinion torque [N m]"),
        ("pinion.material.youngs_modulus_MPa", "pinion Young's modulus [MPa]"),
        ("mesh_stiffness_mean_N_per_mm_um", "mesh stiffness mean [N/(mm µm)]"),
        ("line_load_max_N_per_mm", "line load max [N/mm]"),
        ("normal_force_at_peak_N", "normal force at peak [N]"),
        (SPAN, "peak-to-peak transmission error [µm]"),
        ("stage.pin_tangential_um.0", "stage pin tangential 0 [µm]"),
        ("pinion.shaft.bearings.1.at_mm", "pinion shaft bearings 1 at [mm]"),
        ("face_load_factor", "face load factor K_Hβ"),
    ],
)
def test_names_have_their_units(name, label):
    assert label_of(name) == label


def test_lines_are_the_figure_over_the_first_key_one_for_each_value_of_the_second():
    figure = plot_study_lines(grid(torques=(40.0, 80.0)), PRESSURE, LEAD, TIP)
    assert [axes.get_title() for axes in figure.axes] == ["pinion torque 40 N m", "pinion torque 80 N m"]
    for axes, factor in zip(figure.axes, (0.5, 1.0), strict=True):
        for line, tip in zip(curves(axes), (0.0, 10.0), strict=True):
            assert_allclose(line.get_xdata(), [0.0, 3.0, 6.0])
            # one factor
            assert_allclose(line.get_ydata(), factor * (500.0 + 10.0 * line.get_xdata() + tip), rtol=1e-12)
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("pinion lead crowning [µm]", "peak pressure [MPa]")
    assert [text.get_text() for text in figure.legends[0].texts] == ["0", "10"]
    assert figure.legends[0].get_title().get_text() == "pinion tip relief [µm]"


def test_one_key_has_a_line_for_each_torque():
    figure = plot_study_lines(
        dataset({LEAD: [6.0, 0.0]}, {PRESSURE: [[3.0, 4.0], [1.0, 2.0]]}, torques=(40.0, 80.0)), PRESSURE
    )
    low, high = curves(figure.axes[0])
    assert_allclose([low.get_xdata(), low.get_ydata(), high.get_ydata()], [[0.0, 6.0], [1.0, 3.0], [2.0, 4.0]])
    assert [text.get_text() for text in figure.legends[0].texts] == ["pinion torque 40 N m", "pinion torque 80 N m"]


def test_lines_are_medians_with_a_band_where_other_keys_vary_too():
    """At each crowning misalignments from 0 to 100: the figure is their number."""
    lead, other = (np.array(column) for column in zip(*itertools.product([0.0, 4.0], range(101)), strict=True))
    figure = plot_study_lines(dataset({LEAD: lead, MISALIGNMENT: other}, {PRESSURE: other + lead}), PRESSURE)
    (axes,) = figure.axes
    assert_allclose(curves(axes)[0].get_ydata(), [50.0, 54.0])
    (band,) = [one for one in axes.collections if isinstance(one, PolyCollection)]
    corners = band.get_paths()[0].vertices
    assert_allclose(sorted(set(corners[:, 1].round(9).tolist())), [5.0, 9.0, 95.0, 99.0])
    assert "median and band (5 to 95 %) over the other keys" in title(figure)


def test_lines_mark_where_variants_failed():
    figure = plot_study_lines(grid(TWO_FAIL), PRESSURE, LEAD, TIP)
    assert "6 variants: 4 ok, 1 refused, 1 not converged" in title(figure)
    assert SCENE.title in title(figure)
    assert "pinion torque 80 N m" in title(figure)
    assert "refused, not converged or without this figure" in [text.get_text() for text in figure.legends[0].texts]


def test_crosses_have_the_colour_of_their_line():
    """Variant 1 (0 um, 10 um) and variant 4 (6 um, 0 um) have failed, one of each line."""
    (axes,) = plot_study_lines(grid(TWO_FAIL), PRESSURE, LEAD, TIP).axes
    colours = {line.get_label(): line.get_color() for line in curves(axes)}
    marks = {
        line.get_color(): line.get_xydata() for line in axes.lines if line.get_marker() == "x" and line.get_xdata().size
    }
    assert_allclose(marks[colours["0"]][:, 0], [6.0])
    assert_allclose(marks[colours["10"]][:, 0], [0.0])
    assert marks[colours["0"]][0, 1] != marks[colours["10"]][0, 1]


def test_line_without_a_point_is_a_row_of_crosses():
    figure = plot_study_lines(grid(["ok", "refused"] * 3), PRESSURE, LEAD, TIP)
    assert [line.get_label() for line in curves(figure.axes[0])] == ["0"]
    assert_allclose(crosses(figure.axes[0])[:, 0], [0.0, 3.0, 6.0])
    (legend,) = figure.legends
    assert {line.get_label(): line.get_marker() for line in legend.get_lines()}["10"] == "x"


def test_words_are_ticks_of_their_axis():
    forms = ["parabolic", "circular", "parabolic", "circular"]
    study = dataset(
        {"pinion.modifications.lead_crowning_form": forms, LEAD: [1.0, 1.0, 2.0, 2.0]}, {PRESSURE: [1.0, 2.0, 3.0, 4.0]}
    )
    axes = plot_study_lines(study, PRESSURE, "pinion.modifications.lead_crowning_form", LEAD).axes[0]
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["circular", "parabolic"]
    assert_allclose(curves(axes)[0].get_ydata(), [2.0, 1.0])
    axes = plot_study_heat_map(study, PRESSURE).axes[0]
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["circular", "parabolic"]


def test_many_lines_have_few_labels():
    tips = np.arange(40.0)
    figure = plot_study_lines(grid(tips=tips), PRESSURE, LEAD, TIP)
    assert len(curves(figure.axes[0])) == 40
    assert len(figure.legends[0].texts) == 8
    assert "40 curves, from dark to light; the legend names 8 of them" in title(figure)


def test_axes_choose_the_keys_of_heat_maps_and_lines_of_three():
    keys = [[0.0, 6.0], [0.0, 10.0], [-4.0, 0.0, 4.0]]
    lead, tip, tilt = np.array(list(itertools.product(*keys))).T
    figures = {PRESSURE: 1000.0 + lead + 10.0 * tip + 100.0 * tilt}
    study = dataset({LEAD: lead, TIP: tip, MISALIGNMENT: tilt}, figures)
    for key in (LEAD, TIP, MISALIGNMENT):
        study[key].attrs["sampling"] = "factor"
    heat, lines = f"study_heat_map_{PRESSURE}", f"study_lines_{PRESSURE}"
    usual, chosen = plot_study(study), plot_study(study, axes=(MISALIGNMENT, LEAD))
    for pictures, across, upwards in ((usual, LEAD, TIP), (chosen, MISALIGNMENT, LEAD)):
        axes = pictures[heat].axes[0]
        assert (axes.get_xlabel(), axes.get_ylabel()) == (label_of(across), label_of(upwards))
        assert pictures[lines].axes[0].get_xlabel() == label_of(across)
    (cells,) = (one for one in chosen[heat].axes[0].collections if isinstance(one, QuadMesh))
    # medians over the tip relief: 1000 + lead + 50 + 100 tilt
    assert_allclose(cells.get_array(), 1050.0 + np.add.outer([0.0, 6.0], [-400.0, 0.0, 400.0]))


test_axes_refuse = refused_calls(
    (lambda: plot_study(grid(), axes=(LEAD, LEAD)), f"^axes: found {LEAD}, {LEAD}; allowed two different keys"),
    (lambda: plot_study(grid(), axes=(LEAD,)), f"^axes: found {LEAD}; allowed two different keys"),
    (
        lambda: plot_study(grid(), axes=(LEAD, MISALIGNMENT)),
        f"^axes: {MISALIGNMENT}: not a key with given values in the study; it has {LEAD}, {TIP}",
    ),
)


def test_heat_map_has_the_first_key_to_the_right_and_the_second_upwards():
    """Given in falling order; the cells rise."""
    figure = plot_study_heat_map(grid(leads=(6.0, 0.0, 3.0), tips=(10.0, 0.0)), PRESSURE)
    axes = figure.axes[0]
    (mesh,) = [one for one in axes.collections if isinstance(one, QuadMesh)]
    assert_allclose(mesh.get_array(), [[500.0, 530.0, 560.0], [510.0, 540.0, 570.0]])
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["0", "3", "6"]
    assert [tick.get_text() for tick in axes.get_yticklabels()] == ["0", "10"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("pinion lead crowning [µm]", "pinion tip relief [µm]")
    turned = plot_study_heat_map(grid(), PRESSURE, upwards=LEAD).axes[0]
    assert turned.get_xlabel() == "pinion tip relief [µm]"


def test_heat_map_of_one_key_on_both_axes_is_refused():
    with pytest.raises(InputError, match=f"^across, upwards: found {LEAD} twice; allowed two different keys$"):
        plot_study_heat_map(grid(), SPAN, LEAD, LEAD)


def test_colour_bar_of_a_single_value_shows_that_value_alone():
    figure = plot_study_heat_map(grid(leads=(3.0,), tips=(10.0,)), PRESSURE)
    assert [tick.get_text() for tick in figure.axes[-1].get_yticklabels()] == ["540"]


@pytest.mark.quick_cases("lead1")
@pytest.mark.parametrize("lead", [(1.0,), (1.0, 2.0), (1.0, 2.0, 3.0)])
def test_titles_fit_into_narrow_pictures(lead):
    status = ["refused", *["ok"] * (len(lead) - 1)]
    drawn = [plot_study_heat_map(grid(status, leads=lead, tips=(0.0,)), SPAN)]
    if len(lead) > 1:
        drawn.append(plot_study_histogram(grid(status, leads=lead, tips=(0.0,)), SPAN))
    for figure in drawn:
        figure.draw_without_rendering()
        assert "\n" not in figure.get_suptitle()
        for text in figure.texts:
            extent = text.get_window_extent()
            assert extent.x0 >= 0.0
            assert extent.x1 <= figure.bbox.width
        assert "1 refused" in title(figure)


def test_errors_of_a_vh_check_have_their_letters():
    keys = {"mounting.out_of_plane_deg": [0.0, 0.01], "mounting.in_plane_deg": [0.0, 0.01]}
    axes = plot_study_heat_map(dataset(keys, {PRESSURE: [1.0, 2.0]}), PRESSURE).axes[0]
    assert axes.get_xlabel() == "H: axis error out of plane [deg]"
    assert axes.get_ylabel() == "V: axis error in plane [deg]"
    other = dataset({**keys, LEAD: [0.0, 1.0]}, {PRESSURE: [1.0, 2.0]})
    assert plot_study_heat_map(other, PRESSURE).axes[0].get_xlabel() == "axis error out of plane [deg]"


@pytest.mark.parametrize(("largest", "column", "row"), [(False, 1, 1), (True, 0, 0)])
def test_best_cell_is_framed(largest, column, row):
    """The least at 3 um and 10 um; the largest at 0 um and 0 um, and beside it at 6 um: the first counts."""
    figure = plot_study_heat_map(grid(), SPAN, largest_is_best=largest)
    (frame,) = [one for one in figure.axes[0].patches if isinstance(one, Rectangle)]
    assert_allclose(frame.get_xy(), (column - 0.5, row - 0.5))


def test_heat_map_crosses_failed_cells_and_leaves_out_those_nobody_asked_for():
    figure = plot_study_heat_map(grid(TWO_FAIL).isel(sample=slice(5)), PRESSURE)
    assert_allclose(crosses(figure.axes[0]), [[2.0, 0.0], [0.0, 1.0]])  # (6 um, 10 um) is in no variant
    assert "5 variants: 3 ok, 1 refused, 1 not converged" in title(figure)


def test_heat_map_shows_some_of_many_torques_and_says_so():
    figure = plot_study_heat_map(grid(torques=np.arange(1.0, 11.0)), PRESSURE)
    titles = [axes.get_title() for axes in figure.axes if axes.get_title()]
    assert titles == [f"pinion torque {torque} N m" for torque in (1, 4, 7, 10)]
    assert "4 of 10 torques" in title(figure)


def test_cells_are_medians_over_the_other_keys():
    study = dataset(
        {LEAD: [0.0] * 3 + [1.0] * 3, TIP: [5.0] * 6, MISALIGNMENT: range(6)},
        {PRESSURE: [1.0, 9.0, 2.0, 5.0, 3.0, 4.0]},
    )
    figure = plot_study_heat_map(study, PRESSURE, LEAD, TIP)
    assert_allclose(figure.axes[0].collections[0].get_array(), [[2.0, 4.0]])
    assert "medians over the other keys; the best variant may lie in another cell" in title(figure)
    assert figure.legends[0].get_texts()[0].get_text() == "least median"


def test_histogram_has_its_percentiles_where_they_are():
    """Of 0 to 100 in steps of one the percentiles are their own numbers; half the torque has half of them."""
    figure = plot_study_histogram(sampled(), SPAN)
    assert figure.axes[0].get_xlabel() == "peak-to-peak transmission error [µm]"
    for axes, factor in zip(figure.axes[:2], (0.5, 1.0), strict=True):
        assert_allclose([line.get_xdata()[0] for line in axes.lines], np.multiply(factor, [5.0, 50.0, 95.0]))
        assert sum(heights(axes)) == 101
    assert "5 % at 5, 50 % at 50, 95 % at 95" in figure.axes[1].get_title()
    cumulative = figure.axes[3].lines[0]
    assert_allclose(np.interp(50.0, cumulative.get_xdata()[1:], cumulative.get_ydata()[1:]), 0.5, atol=0.01)


def test_histogram_of_skewed_values_shows_their_shape(rng):
    """Of exponential values 1 - e^(-1) are below their mean, about a tenth of the longest of 400."""
    values = rng.exponential(size=400)
    study = dataset({LEAD: values}, {PRESSURE: values}, sampling="distribution")
    bars = heights(plot_study_histogram(study, PRESSURE).axes[0])
    assert 10 <= len(bars) <= 40
    assert max(bars) < 0.3 * 400
    outlier = dataset({LEAD: values}, {PRESSURE: np.where(np.arange(400) == 0, 1e6, values)}, sampling="distribution")
    assert len(heights(plot_study_histogram(outlier, PRESSURE).axes[0])) == 40


def test_histogram_tells_how_many_failed():
    figure = plot_study_histogram(sampled(8, (80.0,), ["ok"] * 5 + ["fault"] * 3), SPAN)
    assert sum(heights(figure.axes[0])) == 5
    assert "8 variants: 5 ok, 3 fault" in title(figure)


@pytest.mark.parametrize("value", [0.0, 1.5, -1e-9])
def test_histogram_of_a_figure_that_does_not_scatter(value):
    study = sampled(16, (80.0,))
    study[SPAN][:] = value
    axes = plot_study_histogram(study, SPAN).axes[0]
    assert sum(heights(axes)) == 16
    assert_allclose([line.get_xdata()[0] for line in axes.lines], value)


def test_histogram_by_a_key_has_a_cumulative_curve_for_each_value():
    lead = np.repeat([0.0, 4.0], 8)
    study = dataset({LEAD: lead, MISALIGNMENT: np.arange(16.0)}, {PRESSURE: np.arange(16.0)})
    figure = plot_study_histogram(study, PRESSURE, [LEAD])
    assert heights(figure.axes[0]) == []
    low, high = figure.axes[0].lines
    assert np.nanmax(low.get_xdata()[np.isfinite(low.get_xdata())]) == 7.0
    assert np.nanmax(high.get_xdata()[np.isfinite(high.get_xdata())]) == 15.0
    assert [text.get_text() for text in figure.legends[0].texts] == ["0", "4"]


def nine_designs():
    """Each with two samples, in the order of the designs."""
    study = dataset(
        {LEAD: np.repeat(np.arange(9.0), 2), MISALIGNMENT: np.tile([-1.0, 1.0], 9)},
        {SPAN: np.outer(np.arange(18.0), [1.0, 2.0])},
        torques=(40.0, 80.0),
    )
    study[LEAD].attrs["sampling"], study[MISALIGNMENT].attrs["sampling"] = "factor", "distribution"
    return study


def test_histogram_of_many_designs_says_how_many_its_legend_names():
    figure = plot_study_histogram(nine_designs(), SPAN, [LEAD])
    assert (len(figure.axes[0].lines), len(figure.legends[0].texts)) == (9, 5)
    assert "9 curves, from dark to light; the legend names 5 of them" in title(figure)
    few = plot_study_histogram(nine_designs().isel(sample=slice(0, 16)), SPAN, [LEAD])
    assert (len(few.legends[0].texts), "legend" in title(few)) == (8, False)


def test_band_over_the_torque_of_many_designs_says_that_it_mixes_them():
    assert "median and band over 9 designs and their samples together" in title(plot_study_over_torque(nine_designs()))
    assert "median and band over all variants" in title(plot_study_over_torque(sampled()))
    assert "together" not in title(plot_study_over_torque(designs()))


def test_band_over_the_torque_holds_nine_tenths_of_the_variants():
    figure = plot_study_over_torque(sampled())
    axes = figure.axes[0]
    (band,) = [one for one in axes.collections if isinstance(one, PolyCollection)]
    corners = band.get_paths()[0].vertices
    assert_allclose(
        sorted({tuple(corner) for corner in corners.round(9).tolist()}),
        [(40.0, 2.5), (40.0, 47.5), (80.0, 5.0), (80.0, 95.0)],
    )
    assert_allclose(axes.lines[0].get_ydata(), [25.0, 50.0])
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("pinion torque [N m]", "peak-to-peak transmission error [µm]")
    assert [text.get_text() for text in figure.legends[0].texts] == ["5 to 95 %", "median"]


def designs():
    """Two designs with 20 samples each; the luckiest sample is one of the design with the larger scatter."""
    lead = np.repeat([2.0, 6.0], 20)
    span = np.concatenate([np.linspace(3.0, 4.0, 20), np.linspace(0.5, 9.0, 20)])
    study = dataset(
        {LEAD: lead, MISALIGNMENT: np.tile(np.linspace(-9.0, 9.0, 20), 2)},
        {SPAN: np.stack([span, 2.0 * span], axis=1)},
        torques=(40.0, 80.0),
    )
    study[LEAD].attrs["sampling"], study[MISALIGNMENT].attrs["sampling"] = "factor", "distribution"
    return study


def test_ranking_with_distributions_is_of_designs_by_their_quantile():
    figure = plot_study_ranking(designs(), SPAN)
    table = figure.axes[0].tables[0]
    rows = [[table[row, column].get_text().get_text() for column in range(4)] for row in (1, 2)]
    assert [row[2] for row in rows] == ["2", "6"]
    assert [float(row[3]) for row in rows] == pytest.approx([7.9, 17.15], rel=1e-3)  # 95 % of even steps, larger torque
    assert "95 % quantile over the samples" in title(figure)
    figure = plot_study_ranking(designs(), SPAN, largest_is_best=True)
    assert "5 % quantile over the samples" in title(figure)
    assert figure.axes[0].tables[0][1, 2].get_text().get_text() == "2"  # 5 % of the least: 3.05 and 0.925


def test_ranking_of_few_samples_has_dashes_where_its_table_has_nothing():
    """Of fewer than 20 samples there is no standard error of the quantile."""
    study = designs().isel(sample=slice(0, None, 2))
    assert rank_combinations(study, SPAN)["standard_error_um"].isna().all()
    table = cells(plot_study_ranking(study, SPAN))
    (column,) = [n for (row, n), text in table.items() if row == 0 and text.startswith("standard error")]
    assert [table[row, column] for row in (1, 2)] == ["-", "-"]
    assert "nan" not in table.values()


def test_each_design_has_its_band_over_the_torque():
    figure = plot_study_over_torque(designs())
    bands = [one for one in figure.axes[0].collections if isinstance(one, PolyCollection)]
    tops = [band.get_paths()[0].vertices[:, 1].max() for band in bands]
    assert tops == pytest.approx([7.9, 17.15], rel=1e-3)
    assert [text.get_text() for text in figure.legends[0].texts] == ["2", "6"]


@pytest.mark.thorough
def test_heat_map_of_many_cells_takes_no_mask_of_all_samples_for_each():
    """14 400 cells with 14 400 samples: masks would take 207 MB, the picture takes 20."""
    count = 120
    first, second = (values.ravel() for values in np.meshgrid(np.arange(count) * 1.0, np.arange(count) * 1.0))
    figure = plot_study_heat_map(dataset({LEAD: first, TIP: second}, {SPAN: first - second}), SPAN)
    (mesh,) = [one for one in figure.axes[0].collections if isinstance(one, QuadMesh)]
    assert_array_equal(mesh.get_array(), (first - second).reshape(count, count))


def test_nominal_variant_is_drawn_over_the_torque_where_there_is_one():
    study = dataset(
        {MISALIGNMENT: [5.0, 0.0, -5.0]}, {SPAN: [[1.0, 2.0], [3.0, 4.0], [5.0, 7.0]]}, torques=(40.0, 80.0)
    )
    figure = plot_study_over_torque(study)
    assert_allclose(figure.axes[0].lines[-1].get_ydata(), [3.0, 4.0])
    assert [text.get_text() for text in figure.legends[0].texts][-1] == "nominal"


def test_band_of_torques_that_are_a_varied_key():
    torque = np.repeat([40.0, 80.0], 3)
    study = dataset(
        {"load.pinion_torque_Nm": torque}, {SPAN: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], "pinion_torque_Nm": torque}
    )
    assert_allclose(plot_study_over_torque(study).axes[0].lines[0].get_xydata(), [[40.0, 2.0], [80.0, 5.0]])


def test_scatter_matrix_shows_keys_and_figures_and_crosses_what_failed():
    study = sampled(16, (40.0, 80.0), ["refused", *["ok"] * 15])
    figure = plot_study_scatter_matrix(study, [SPAN])
    panels = [
        axes for axes in figure.axes if axes.get_visible() and axes.collections and axes.get_label() != "<colorbar>"
    ]
    assert len(panels) == 3  # below the diagonal of three
    (dots,) = panels[0].collections
    assert_allclose(dots.get_offsets()[:, 0], study[MISALIGNMENT].values[1:])
    assert_allclose(dots.get_array(), study[SPAN].values[1:, 1])
    assert_allclose(crosses(panels[0])[:, 0], -50.0)
    assert "pinion torque 80 N m" in title(figure)
    assert "16 variants: 15 ok, 1 refused" in title(figure)


@pytest.mark.thorough
def test_scatter_matrix_of_many_keys_shows_those_that_matter(rng):
    names = [
        f"wheel.modifications.{name}"
        for name in (
            "lead_crowning_um",
            "end_relief_um",
            "profile_crowning_um",
            "tip_relief_um",
            "root_relief_um",
            "helix_slope_um",
            "twist_um",
        )
    ]
    columns = {name: rng.normal(size=64) for name in names}
    study = dataset(
        columns, {SPAN: sum(part * column for part, column in enumerate(columns.values()))}, sampling="distribution"
    )
    figure = plot_study_scatter_matrix(study, [SPAN])
    labels = {axes.get_xlabel().replace("\n", " ") for axes in figure.axes}
    assert label_of("wheel.modifications.twist_um") in labels
    assert label_of("wheel.modifications.lead_crowning_um") not in labels
    assert "6 of 7 varied keys" in title(figure)


def test_bars_of_a_key_in_equal_steps_stand_over_its_values():
    lead, relief = (list(column) for column in zip(*itertools.product([0.0, 5.0, 10.0], [2.5, 3.0]), strict=True))
    keys = {LEAD: lead, "pinion.modifications.tip_relief_um": relief}
    figure = plot_study_scatter_matrix(dataset(keys, {SPAN: np.arange(6.0)}, sampling="distribution"), [SPAN])
    panels = [axes for axes in figure.axes if axes.patches][:2]
    middles = [[bar.get_x() + 0.5 * bar.get_width() for bar in axes.patches] for axes in panels]
    # also below: half a width is added to the left end
    assert_allclose(middles[0], [0.0, 5.0, 10.0], atol=1e-12)
    assert_allclose(middles[1], [2.5, 3.0], rtol=1e-12)
    assert [heights(axes) for axes in panels] == [[2, 2, 2], [3, 3]]


@pytest.mark.thorough
def test_words_and_whole_numbers_have_their_ticks_in_the_scatter_matrix():
    hand, teeth = (list(column) for column in zip(*itertools.product(["right", "left"], [33, 34, 35]), strict=True))
    keys = {"pinion.hand": hand, "pinion.teeth": teeth, "load.pinion_torque_Nm": np.linspace(70.0, 80.0, 6)}
    figure = plot_study_scatter_matrix(dataset(keys, {SPAN: np.arange(6.0)}, sampling="distribution"), [SPAN])
    png_of(figure)
    lowest = {axes.get_xlabel(): axes for axes in figure.axes if axes.get_xlabel()}
    assert [tick.get_text() for tick in lowest["pinion hand"].get_xticklabels()] == ["left", "right"]
    assert set(lowest["pinion teeth"].get_xticks() % 1.0) == {0.0}
    assert "pinion torque\n[N m]" in lowest  # the unit in one piece
    bars = [heights(axes) for axes in figure.axes if axes.patches][:2]
    assert bars == [[3, 3], [2, 2, 2]]


def cells(figure):
    table = figure.axes[0].tables[0].get_celld()
    return {place: cell.get_text().get_text() for place, cell in table.items()}


def test_ranking_begins_with_the_best_and_counts_the_rest():
    figure = plot_study_ranking(grid(TWO_FAIL))
    table = cells(figure)
    assert [table[row, 1] for row in range(1, 5)] == ["3", "5", "2", "0"]
    assert (5, 0) not in table
    assert table[0, 2].replace("\n", " ") == "pinion lead crowning [µm]"
    assert "6 variants: 4 ok, 1 refused, 1 not converged" in title(figure)
    why = (
        "without a rank: 2 of 6 variants; refused: it is refused (1 of them); "
        "not converged: it is not converged (1 of them); "
    )
    assert why in title(figure)
    assert "without a rank" not in title(plot_study_ranking(grid()))
    long = plot_study_ranking(grid(leads=np.arange(5.0), tips=np.arange(5.0)), PRESSURE)
    assert "20 best of 25 variants, least peak pressure first" in title(long)


@pytest.mark.thorough
def test_ranking_fills_its_picture():
    for figure in (plot_study_ranking(grid()), plot_study_ranking(grid(leads=np.arange(5.0), tips=np.arange(5.0)))):
        figure.draw_without_rendering()
        table = figure.axes[0].tables[0].get_window_extent()
        assert table.y0 < 0.15 * figure.bbox.height
        assert table.y1 < figure._suptitle.get_window_extent().y0


def test_ranking_tells_the_most_frequent_reasons_and_counts_the_others():
    study = grid(["refused"] * 5 + ["ok"])
    study["reason"] = ("sample", ["a\nb", "c", "a\nb", "d", "e", ""])
    why = (
        "without a rank: 5 of 6 variants; refused: a b (2 of them); refused: c (1 of them); refused: d (1 of them); "
        "and 1 more reason; "
    )
    assert why in title(plot_study_ranking(study))


def test_ranking_over_several_torques_says_which_value_counts():
    assert "of each figure the largest over the torques" in title(plot_study_ranking(grid(torques=(40.0, 80.0))))
    assert "over the torques" not in title(plot_study_ranking(grid(torques=(40.0, 80.0)), torque=1))


def names(study, *more):
    pictures = plot_study(study, *more)
    for figure in pictures.values():
        png_of(figure)  # they can be drawn
    return [name.removeprefix("study_") for name in pictures]


@pytest.mark.thorough
def test_pictures_fit_what_varies():
    assert names(grid(), [PRESSURE]) == ["lines_peak_pressure_MPa", "heat_map_peak_pressure_MPa", "ranking"]
    alone = dataset({LEAD: [0.0, 1.0]}, {PRESSURE: [1.0, 2.0]}, sampling="table")
    assert names(alone) == ["lines_peak_pressure_MPa", "ranking"]
    assert names(sampled(16)) == [f"histogram_{SPAN}", "over_torque", "scatter_matrix", "ranking"]
    assert names(sampled(16, (80.0,))) == [f"histogram_{SPAN}", "scatter_matrix", "ranking"]


@pytest.mark.thorough
def test_pictures_of_factors_under_scatter_show_both():
    lead, other = (np.array(column) for column in zip(*itertools.product([0.0, 4.0], np.arange(8.0)), strict=True))
    study = dataset({LEAD: lead, MISALIGNMENT: other}, {PRESSURE: other})
    study[MISALIGNMENT].attrs["sampling"] = "distribution"
    assert names(study) == ["lines_peak_pressure_MPa", "histogram_peak_pressure_MPa", "ranking"]


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_table_of_repeated_values_is_a_grid_and_of_others_a_cloud(rng):
    study = grid()
    for key in study.coords:
        study[key].attrs["sampling"] = "table"
    assert f"heat_map_{SPAN}" in names(study)
    cloud = dataset({LEAD: rng.random(20), TIP: rng.random(20)}, {SPAN: rng.random(20)}, sampling="table")
    assert names(cloud) == [f"histogram_{SPAN}", "scatter_matrix", "ranking"]


def test_few_designs_are_points_over_their_numbers_and_no_distribution():
    study = dataset({LEAD: [1.0, 5.0, 2.0], TIP: [3.0, 1.0, 0.0]}, {SPAN: [4.0, 6.0, 5.0]}, sampling="table")
    assert names(study) == [f"lines_{SPAN}", "ranking"]
    (axes,) = plot_study(study)[f"study_lines_{SPAN}"].axes
    assert_allclose(axes.lines[0].get_xydata(), [[0.0, 4.0], [1.0, 6.0], [2.0, 5.0]])
    assert axes.lines[0].get_linestyle() == "None"
    assert axes.get_xlabel() == "number of the variant"
    assert set(axes.get_xticks() % 1.0) == {0.0}


@pytest.mark.parametrize("rank_by", [None, PRESSURE])
def test_study_of_which_nothing_is_ok_has_a_ranking_that_says_so(rank_by):
    study = dataset({LEAD: [0.0, 3.0]}, {}, ["refused"] * 2).drop_vars("pinion_torque_Nm")
    ((name, figure),) = plot_study(study, rank_by=rank_by).items()
    assert name == "study_ranking"
    assert [text.get_text() for text in figure.axes[0].texts] == ["no variant has any figure"]
    assert "; refused: it is refused (2 of them); " in title(figure)
    assert "2 variants: 2 refused" in title(figure)
    assert png_of(figure)


def test_pictures_of_a_figure_that_no_variant_has_say_so():
    study = grid().assign({PRESSURE: grid()[PRESSURE] * np.nan})
    for figure in plot_study(study, [PRESSURE]).values():
        png_of(figure)
        assert any("no variant has this figure" in text.get_text() for axes in figure.axes for text in axes.texts)
        assert "6 without this figure" in title(figure)


def test_accuracy_warnings_are_counted():
    study = grid()
    study["warnings"] = ("sample", ["", "an edge\na crease", "an edge", "", "", ""])
    assert "6 variants: 6 ok, 2 with accuracy warnings" in title(plot_study_lines(study, PRESSURE))


ABSENT = r"wheel\.teeth: not varied in the study; allowed pinion\.modifications"

test_plots_of_studies_refuse = refused_calls(
    (lambda: plot_study_scatter_matrix(grid(), []), "figures: none to show"),
    (
        lambda draw: draw(grid(), "face_load_factor"),
        "face_load_factor: no figure of the study",
        [plot_study_lines, plot_study_heat_map, plot_study_histogram, plot_study_over_torque],
    ),
    (lambda: plot_study_lines(grid(), PRESSURE, "wheel.teeth"), ABSENT),
    (lambda: plot_study_lines(grid(), PRESSURE, LEAD, "wheel.teeth"), ABSENT),
    (lambda: plot_study_heat_map(grid(), PRESSURE, "wheel.teeth"), ABSENT),
    (lambda: plot_study_histogram(grid(), PRESSURE, ["wheel.teeth"]), ABSENT),
    (
        lambda: plot_study_heat_map(dataset({LEAD: [0.0, 1.0]}, {PRESSURE: [1.0, 2.0]}), PRESSURE),
        r"heat map: needs two keys; the study varies pinion\.\S* alone",
    ),
)


def test_torques_without_a_name_are_numbered():
    study = grid(torques=(40.0, 80.0)).drop_vars("pinion_torque_Nm")
    assert [axes.get_title() for axes in plot_study_lines(study, PRESSURE, LEAD, TIP).axes] == [
        "torque 1 of 2",
        "torque 2 of 2",
    ]
    varied = dataset(
        {LEAD: [0.0, 1.0]},
        {PRESSURE: [[1.0, 2.0]] * 2, "pinion_torque_Nm": [[1.0, 2.0], [1.0, 3.0]]},
        torques=(1.0, 2.0),
    )
    labels = [text.get_text() for text in plot_study_lines(varied, PRESSURE).legends[0].texts]
    assert_array_equal(labels, ["pinion torque 1 N m", "torque 2 of 2"])


@pytest.mark.parametrize("by", [None, TIP])
def test_figures_that_all_torques_share_have_one_panel_of_lines(by):
    study = grid(torques=(40.0, 80.0))
    study[SPAN] = study[SPAN].isel(torque=0).expand_dims(torque=2, axis=1)  # as a safety under a load spectrum
    figure = plot_study_lines(study, SPAN, LEAD, by)
    (axes,) = figure.axes
    assert len(curves(axes)) == (1 if by is None else 2)
    assert ("all torques" in axes.get_legend_handles_labels()[1]) == (by is None)
