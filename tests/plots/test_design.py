"""Pictures of a design: what is drawn is what its dataset holds."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray
from numpy.testing import assert_allclose

from loaded_tca import read_scene
from loaded_tca.errors import InputError
from loaded_tca.plots import plot_before_and_after, plot_peak_to_peak_over_torque, plot_robustness, save_figure
from tests.refusals import refusals
from tests.samples.pictures import told
from tests.samples.results import SCENES

TORQUES = np.array([100e3, 300e3])
PLOTS = [plot_before_and_after, plot_peak_to_peak_over_torque]
SCENE = read_scene(SCENES / "mesh_cycle_helical.toml")
LENGTH = 1e3 * SCENE.pair().base_radii[1]
"""At the base circle of the wheel [um] per rad."""


def design(samples=3, torques=TORQUES, positions=9):
    """Two designs with cosines for transmission errors, the second of half the height."""
    phase = np.linspace(0.0, 2.0 * np.pi, positions)
    height = np.array([2e-6, 1e-6])[:, None, None] * (1.0 + 0.1 * np.arange(samples))[:, None] * torques / 100e3
    error = height[..., None] * np.cos(phase) - 1e-4
    axes = ("design", "sample", "torque", "position")
    arrays = {
        "transmission_error": (axes, error),
        "peak_pressure": (axes, 900.0 + 1e8 * height[..., None] * np.ones(positions)),
        "span_um": (axes[:3], 2.0 * LENGTH * height),
        "face_load_factor": (axes[:3], 1.0 + 1e5 * height),
    }
    return xarray.Dataset(arrays, {"design": ["start", "optimum"], "torque": torques}, {"scene_toml": SCENE.to_toml()})


def curves():
    """Objectives over the scatter."""
    values = np.array([[0.2, 0.5, 0.9], [0.25, 0.3, 0.4]])
    told = {"long_name": "mean + 1 standard deviation of the peak-to-peak transmission error", "units": "um"}
    coordinates = {"design": ["start", "optimum"], "multiple": [0.0, 1.0, 2.0]}
    return xarray.Dataset({"objective": (("design", "multiple"), values, told)}, coordinates)


def labels(figure):
    return [text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel())]


def test_lines_are_means_and_bands_the_range_of_the_samples():
    one = design()
    figure = plot_before_and_after(one, torque=0)
    error, pressure, factor, span = figure.axes
    sets = [
        (error, LENGTH * (one["transmission_error"].values[:, :, 0] + 1e-4)),
        (pressure, one["peak_pressure"].values[:, :, 0]),
        (factor, one["face_load_factor"].values),
        (span, one["span_um"].values),
    ]
    for axes, values in sets:
        for of_design, line, band in zip(values, axes.lines, axes.collections, strict=True):
            assert_allclose(line.get_ydata(), of_design.mean(axis=0), rtol=0, atol=1e-9 * values.max())
            border = band.get_paths()[0].vertices[:, 1]
            assert_allclose([border.min(), border.max()], [of_design.min(), of_design.max()], atol=1e-9 * values.max())
    assert_allclose(span.lines[0].get_xdata(), [100.0, 300.0])
    assert "range of 3 samples" in told(figure)
    assert_allclose(error.lines[0].get_xdata()[[0, -1]], [-180.0 / 34, 180.0 / 34])  # a pitch of the pinion


def test_axes_tell_their_units_and_the_torque():
    figure = plot_before_and_after(design())
    over_torque = ["pinion torque [N m]"] * 2
    across, upwards = labels(figure)[::2], labels(figure)[1::2]
    assert across == ["pinion angle [deg], under 300 N m"] * 2 + over_torque
    assert [("[µm]" in label, "[MPa]" in label) for label in upwards] == [
        (True, False),
        (False, True),
        (False, False),
        (True, False),
    ]
    assert [text.get_text().strip() for text in figure.legends[0].get_texts()] == ["start", "optimum"]


def test_peak_to_peak_over_the_torque_is_that_of_the_designs():
    one = design()
    (axes,) = plot_peak_to_peak_over_torque(one).axes
    for line, values in zip(axes.lines, one["span_um"].values, strict=True):
        assert_allclose(line.get_ydata(), values.mean(axis=0))
    assert axes.get_ylim()[0] == 0.0


def test_robustness_curve_is_the_objective_over_the_scatter():
    one = curves()
    (axes,) = plot_robustness(one).axes
    for line, values in zip(axes.lines, one["objective"].values, strict=True):
        assert_allclose(line.get_xydata(), np.stack([[0.0, 1.0, 2.0], values], axis=1))
    assert " ".join(axes.get_ylabel().split()).endswith("peak-to-peak transmission error [µm]")
    assert "multiple" in axes.get_xlabel()


def test_objective_without_a_name_is_called_so():
    one = curves()
    one["objective"].attrs.clear()
    assert plot_robustness(one).axes[0].get_ylabel() == "objective"


@pytest.mark.quick_cases("1-plot_before_and_after", "all-plot_peak_to_peak_over_torque")
@pytest.mark.parametrize("plot", PLOTS)
@pytest.mark.parametrize("one", [design(), design(samples=1), design(torques=TORQUES[:1])], ids=["all", "1", "torque"])
def test_every_picture_is_drawn(plot, one, tmp_path):
    figure = plot(one)
    save_figure(figure, tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 10_000
    assert f"; {SCENE.title}" in told(figure)
    assert ("samples" in told(figure)) == (one.sizes["sample"] > 1)


@pytest.mark.parametrize("plot", PLOTS)
def test_result_of_a_design_is_drawn_as_its_dataset(plot):
    found = plot(SimpleNamespace(dataset=design()))
    assert_allclose(found.axes[0].lines[0].get_ydata(), plot(design()).axes[0].lines[0].get_ydata(), rtol=0)


test_what_a_design_does_not_have_is_told = refusals(
    lambda plot, name: plot(design().drop_vars(name, errors="ignore")),
    (plot_before_and_after, "face_load_factor", "design: face_load_factor missing"),
    (plot_peak_to_peak_over_torque, "span_um", "design: span_um missing"),
    (plot_robustness, "objective", "design: objective missing"),
)


def test_robustness_curve_of_a_result_without_one_is_refused():
    with pytest.raises(InputError, match="no robustness curve; allowed what"):
        plot_robustness(design().assign(objective=("design", [1.0, 0.5])))


def test_designs_under_one_torque_stand_side_by_side_above_it():
    one = design(torques=TORQUES[:1])
    factor = plot_before_and_after(one).axes[2]
    places = [float(line.get_xdata()[0]) for line in factor.lines]
    assert places[0] < places[1]
    # also below: a place on either side, as far away
    assert_allclose(factor.get_xticks(), [1e-3 * TORQUES[0]], rtol=1e-12)
    assert np.mean(places) == pytest.approx(1e-3 * TORQUES[0], rel=1e-12)
    heights = [float(line.get_ydata()[0]) for line in factor.lines]
    assert_allclose(heights, one.face_load_factor.mean("sample").values[:, 0])
