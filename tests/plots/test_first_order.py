"""Scatter to first order beside that of a study: the standard deviations of both are those of their numbers."""

import warnings
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import AccuracyWarning
from loaded_tca.plots import plot_first_order_scatter
from loaded_tca.results import key_figure_slopes
from tests.refusals import refusals
from tests.samples.pictures import told
from tests.samples.results import result
from tests.samples.study_datasets import dataset

KEYS = ("pinion.modifications.lead_crowning_um", "mounting.axial_offset_mm")
TORQUES = (40.0, 260.0)
FIGURE = "peak_pressure_MPa"


@cache
def found():
    slopes = result("mesh_cycle_helical", positions=5, torques=TORQUES).sensitivities(KEYS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts reach edges, and faces are of one width
        key_figure_slopes(slopes)  # all are read, and kept
    return slopes


def study(name=FIGURE, count=500, torques=TORQUES, keys=KEYS, status=None):
    """Normal scatter of both keys, and a figure that follows it linearly."""
    rng = np.random.default_rng(7)
    samples = rng.normal(0.0, [[0.5], [0.02]], (2, count))
    middle = [figures[FIGURE] for figures in found().result.key_figures()]
    values = middle + samples.T @ key_figure_slopes(found())[FIGURE].T
    return dataset(dict(zip(keys, samples, strict=True)), {name: values[:, : len(torques)]}, status, torques)


def numbers_of(title):
    """Standard deviations in the title of a panel: to first order, of the study."""
    return [float(word) for word in title.replace(",", "").split() if word[0].isdigit()]


@pytest.mark.parametrize("torque", [0, 1])
def test_linear_scatter_is_that_of_first_order(torque):
    figure = plot_first_order_scatter(found(), study(), torque)
    (axes,) = [axes for axes in figure.axes if axes.get_visible()]
    first_order, of_study = numbers_of(axes.get_title())
    assert_allclose(of_study, np.std(study()[FIGURE].values[:, torque], ddof=1), rtol=5e-3)  # three digits
    assert_allclose(first_order, of_study, rtol=0.05)  # the samples of both keys are a little correlated
    places, heights = axes.lines[0].get_data()
    step = np.diff(places)[0]
    assert_allclose(heights.sum() * step, 1.0, rtol=1e-3)  # 3.5 standard deviations of it
    middle = found().result.key_figures()[torque][FIGURE]
    assert_allclose(np.sqrt((heights * (places - middle) ** 2).sum() * step), first_order, rtol=0.01)
    area = sum(bar.get_width() * bar.get_height() for bar in axes.patches)
    assert_allclose(area, 1.0)
    assert axes.get_xlabel() == "peak pressure [MPa]"
    assert "scatter by 2 keys" in told(figure)
    assert "500 variants: 500 ok" in told(figure)


test_study_of_something_else_is_refused = refusals(
    lambda changes: plot_first_order_scatter(found(), study(**changes)),
    ({"keys": (KEYS[0], "pinion.teeth")}, "study: varies pinion.teeth, without derivatives in the sensitivities"),
    ({"torques": TORQUES[:1]}, "study: its torques are not those of the result"),
    ({"torques": (40.0, 250.0)}, "study: its torques are not those of the result"),
    ({"name": "crowning_um"}, "study: has none of transmission_error_mean_um"),
    ({"count": 4, "status": 4 * ["refused"]}, "study: has none of transmission_error_mean_um"),
)
