"""Pictures of sensitivities: what is drawn is sensitivity times tolerance, with its unit."""

import math
from functools import cache

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.plots import (
    plot_removal_weights,
    plot_sensitivity_curves,
    plot_tornado,
    plot_transmission_error_band,
    save_figure,
)
from loaded_tca.plots.flanks import ToPicture
from loaded_tca.plots.sensitivities import WITH_MOUNTING, removal_weights
from loaded_tca.results import key_figure_slopes
from loaded_tca.results.key_figures import mean_over_a_pitch
from tests.samples.pictures import told
from tests.samples.results import result

pytestmark = pytest.mark.filterwarnings(
    "ignore:an edge of a flank cuts the slices",
    "ignore:derivatives of the transmission error depend",
    "ignore:derivatives of load shares depend",
    "ignore:K_Hbeta follows the strip with",
    "ignore:a tooth pair with",
)  # contacts reach edges, and all is read
ROUNDING = 1e-12
"""Of numbers that are drawn, after one factor."""
TOLERANCES = {
    "pinion.modifications.lead_crowning_um": 2.0,
    "wheel.modifications.helix_slope_um": 3.0,
    "mounting.centre_distance_error_mm": 0.02,
    "mounting.out_of_plane_deg": 0.01,
    "load.pinion_torque_Nm": 5.0,
}
SPREAD = np.array(list(TOLERANCES.values()))


@cache
def found(name="mesh_cycle_helical", torques=(40.0, 260.0), positions=5, keys=tuple(TOLERANCES)):
    return result(name, positions=positions, torques=torques).sensitivities(keys)


def length(one):
    """Length [um] at the wheel's base circle per rad."""
    return 1e3 * one.result.wheel_base_radius


def test_tornado_leaves_motions_of_gears_out_of_the_mean_transmission_error():
    axes = plot_tornado(found(), TOLERANCES, ["transmission_error_mean_um"], torque=0).axes[0]
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert len(labels) == len(TOLERANCES) - 2
    assert not any("error" in label for label in labels)
    changes = (key_figure_slopes(found())["transmission_error_mean_um"][0] * SPREAD)[[0, 1, 4]]
    assert f"by keys but mounting errors {np.hypot.reduce(changes):.3g}" in axes.get_title()


def test_bars_of_the_tornado_are_sensitivity_times_tolerance_the_longest_on_top():
    figure = plot_tornado(found(), TOLERANCES, torque=0, rigid_motions=True)
    slopes = key_figure_slopes(found())
    panels = [axes for axes in figure.axes if axes.get_visible()]
    assert len(panels) == len(slopes)
    for axes, values in zip(panels, slopes.values(), strict=True):
        raised, lowered = ([bar.get_width() for bar in bars] for bars in axes.containers)
        expected = values[0] * SPREAD
        order = np.argsort(-np.abs(expected))
        assert_allclose(raised, expected[order], rtol=ROUNDING)
        assert_allclose(lowered, -expected[order], rtol=ROUNDING)
        words = ["lead crowning ± 2 µm", "helix slope ± 3 µm", "error ± 0.02 mm", "plane ± 0.01 deg", "torque ± 5 N m"]
        labels = [label.get_text() for label in axes.get_yticklabels()]
        assert all(words[k] in label for k, label in zip(order, labels, strict=True))
        low, high = axes.get_ylim()
        assert low > high  # the first on top
    units = [axes.get_xlabel().partition("[")[2] for axes in panels]
    assert units == ["µm]", "µm]", "µm]", "", "MPa]"]
    assert "40 N m (number 1 of 2)" in told(figure)


def test_tornado_of_many_keys_shows_the_longest_bars(monkeypatch):
    monkeypatch.setattr("loaded_tca.plots.sensitivities.MOST_BARS", 2)
    figure = plot_tornado(found(), TOLERANCES, ["peak_pressure_MPa"])
    (axes,) = figure.axes
    longest = np.sort(np.abs(key_figure_slopes(found())["peak_pressure_MPa"][1] * SPREAD))[:-3:-1]
    assert_allclose(np.abs([bar.get_width() for bar in axes.containers[0]]), longest, rtol=ROUNDING)
    assert "2 of 5 keys" in told(figure)


def test_tornado_leaves_out_figures_that_are_not_known():
    one = found("helical", None, 1, ("load.pinion_torque_Nm",))
    panels = [axes for axes in plot_tornado(one).axes if axes.get_visible()]
    assert ["transmission error" in axes.get_xlabel() for axes in panels] == [True, False]
    asked = plot_tornado(one, figures=["face_load_factor"]).axes[0]
    assert [text.get_text() for text in asked.texts] == ["not known"]


def test_curves_are_sensitivity_times_tolerance():
    figure = plot_sensitivity_curves(found(), TOLERANCES)
    absolute, about_mean = figure.axes
    expected = length(found()) * found().transmission_error[1] * SPREAD
    for k, (one, other) in enumerate(zip(absolute.lines, about_mean.lines, strict=True)):
        assert_allclose(one.get_ydata(), expected[:, k], rtol=ROUNDING)
        assert_allclose(other.get_ydata(), expected[:, k] - mean_over_a_pitch(expected[:, k]), rtol=0, atol=ROUNDING)
    assert len(absolute.lines) == len(TOLERANCES)
    assert all("[µm]" in axes.get_ylabel() for axes in figure.axes)
    assert about_mean.get_xlabel() == "pinion angle [deg]"
    assert absolute.get_legend_handles_labels()[1][0] == "pinion lead crowning + 2 µm"


def test_of_many_curves_those_that_vary_most_are_drawn(monkeypatch):
    monkeypatch.setattr("loaded_tca.plots.sensitivities.MOST_CURVES", 1)
    figure = plot_sensitivity_curves(found(), TOLERANCES)
    swings = np.ptp(found().transmission_error[1] * SPREAD, axis=0)
    (line,) = figure.axes[0].lines
    assert_allclose(np.ptp(line.get_ydata()), length(found()) * swings.max(), rtol=1e-9)
    assert "1 of 5 keys" in told(figure)


def test_band_is_the_root_of_the_sum_of_the_squares():
    figure = plot_transmission_error_band(found(), TOLERANCES)
    angle = np.degrees(found().result.pinion_angle)
    for torque, (absolute, about_mean) in enumerate(zip(figure.axes[::2], figure.axes[1::2], strict=True)):
        slopes = length(found()) * found().transmission_error[torque] * SPREAD
        less_mean = slopes - np.array([mean_over_a_pitch(slope) for slope in slopes.T])
        for axes, parts in ((absolute, slopes), (about_mean, less_mean)):
            curve, sigma = axes.lines[0].get_ydata(), np.sqrt(np.square(parts).sum(axis=1))
            for times, band in zip((1.0, 2.0), axes.collections, strict=True):
                border = band.get_paths()[0].vertices
                for place, middle, one in zip(angle, curve, sigma, strict=True):
                    heights = border[np.isclose(border[:, 0], place), 1]
                    assert_allclose([heights.min(), heights.max()], middle + times * one * np.array([-1.0, 1.0]))
        error = length(found()) * found().result.transmission_error[torque]
        assert_allclose(absolute.lines[0].get_ydata(), error, rtol=ROUNDING)
        assert "[µm]" in absolute.get_ylabel()
    assert "tolerances of 5 keys, to first order" in told(figure)


@pytest.mark.parametrize(("keys", "is_said"), [(0, True), (2, False)])
def test_band_says_that_it_contains_mounting_errors_which_the_tornado_leaves_out(keys, is_said):
    """Not where the tornado shows them, as of mounting errors alone."""
    one = found(keys=tuple(TOLERANCES)[keys:4])
    assert (WITH_MOUNTING in told(plot_transmission_error_band(one, TOLERANCES))) == is_said
    assert any("keys but mounting errors" in axes.get_title() for axes in plot_tornado(one, TOLERANCES).axes) == is_said


def test_band_of_one_torque_is_that_one():
    figure = plot_transmission_error_band(found(), TOLERANCES, torque=0)
    assert len(figure.axes) == 2
    assert "40 N m" in told(figure)


@pytest.mark.thorough
@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_removal_over_a_whole_flank_counts_as_much_as_its_height(gear):
    """1 um off everywhere: 1 um along the normal, 1/cos(beta_b) at the base circle.

    An involute has the arc r dr/r_b, and a helicoid 1/cos(beta_b) of its transverse section.
    """
    one = found(torques=(130.0,), positions=9)
    base = one.result.gear_pair.base_radii[gear == "wheel"]
    middle = 2.0 * math.hypot(base, 0.36 * base)
    low, high = np.array([-14.0, middle - 9.0]), np.array([14.0, middle + 9.0])
    borders, weights = removal_weights(one, 0, ToPicture(one.result.gear_pair, gear), low, high)
    diameter = 0.5 * (borders[1][1:] + borders[1][:-1])
    arc = 0.25 * diameter / base  # ds/d(diameter)
    total = (weights * arc[:, None]).sum() * np.diff(borders[0])[0] * np.diff(borders[1])[0]
    assert_allclose(total, 1.0, rtol=0.01)  # cells in the tangent plane, some half a cell beyond the end of the face


@pytest.mark.thorough
def test_picture_of_removal_has_both_flanks_and_its_unit():
    figure = plot_removal_weights(found())
    shown = [[one for one in axes.collections if isinstance(one, QuadMesh)] for axes in figure.axes[:2]]
    assert [len(one) for one in shown] == [1, 1]
    assert all(one[0].get_array().max() > 0.0 for one in shown)
    assert "[µm]" in figure.axes[2].get_ylabel()
    assert "260 N m (the largest of 2)" in told(figure)


CASES = {
    "spiral bevel pair": ("mesh_cycle_bevel", (0.8,), 4),
    "one pair alone": ("helical", (80.0,), 3),
    "one position": ("helical", (80.0,), 1),
    "contact on edges": ("misaligned", (80.0,), 2),
}


@pytest.mark.thorough
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(
    "plot", [plot_tornado, plot_sensitivity_curves, plot_transmission_error_band, plot_removal_weights]
)
def test_every_picture_of_every_case_is_drawn(case, plot, tmp_path):
    keys = ("pinion.modifications.lead_crowning_um", "load.pinion_torque_Nm")
    figure = plot(found(*CASES[case], keys))
    save_figure(figure, tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 10_000
    assert f"; {found(*CASES[case], keys).result.scene.title}" in told(figure)


def test_without_load_there_is_nothing_to_draw():
    one = found("helical", (0.0, 80.0), 2, ("load.pinion_torque_Nm",))
    with pytest.raises(InputError, match="nothing is under load with pinion torque 0 N m"):
        plot_tornado(one, torque=0)
    for figure in (plot_sensitivity_curves(one, torque=0), plot_removal_weights(one, 0)):
        assert [text.get_text() for text in figure.axes[0].texts] == ["no load, no pressure"]


@pytest.mark.parametrize("plot", [plot_tornado, plot_sensitivity_curves, plot_transmission_error_band])
def test_key_without_a_tolerance_is_refused(plot):
    with pytest.raises(InputError, match=r"tolerances: none given for wheel\.modifications\.helix_slope_um, mounting"):
        plot(found(), {"pinion.modifications.lead_crowning_um": 1.0})


def test_unknown_figure_is_refused():
    with pytest.raises(InputError, match="figures: peak unknown; allowed transmission_error_mean_um, "):
        plot_tornado(found(), TOLERANCES, ["peak"])
