"""Pictures of a revolution: curves and orders that they show are those of the result."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse_revolution, read_scene
from loaded_tca.errors import InputError
from loaded_tca.plots import (
    REVOLUTION_PICTURES,
    plot_revolution_error,
    plot_revolution_shares,
    plot_revolution_spectrum,
    plot_revolution_waterfall,
)
from loaded_tca.plots.revolution import revolution_figures
from loaded_tca.plots.style import png_of
from tests.samples.shared import made_once

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")
CHANGES = {
    "analysis.cells": [12, 16],
    "analysis.accuracy": None,
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "revolution.positions_per_pitch": 4,
}


@made_once
def turn():
    return analyse_revolution(read_scene("examples/scenes/revolution_helical.toml").with_changes(CHANGES))


def test_orders_over_the_torque_need_two_torques():
    whole = turn()
    assert list(revolution_figures(whole)) == list(REVOLUTION_PICTURES)
    one = replace(whole, dataset=whole.dataset.isel(torque=[0]))
    assert set(REVOLUTION_PICTURES) - set(revolution_figures(one)) == {"revolution_waterfall"}
    with pytest.raises(InputError, match="the revolution has one; allowed two or more"):
        plot_revolution_waterfall(one)


@pytest.mark.quick_cases("revolution_error")
@pytest.mark.parametrize("name", REVOLUTION_PICTURES)
def test_picture_is_drawn(name):
    assert png_of(REVOLUTION_PICTURES[name](turn())).startswith(b"\x89PNG")


def test_error_is_that_of_the_result():
    rigid, loaded = plot_revolution_error(turn()).axes
    assert_allclose(rigid.lines[0].get_ydata(), turn().error_um())
    curve = turn().error_um(1)
    assert_allclose(loaded.lines[1].get_ydata(), curve - curve.mean())


def test_mesh_orders_stand_at_multiples_of_the_teeth():
    (axes,) = plot_revolution_spectrum(turn()).axes
    mesh = next(line for line in axes.lines if line.get_label() == "mesh orders")
    order, amplitude, kind = turn().spectrum(1)
    assert mesh.get_xdata().tolist() == [24.0]  # of four positions in a pitch the second one has no phase
    assert_allclose(mesh.get_ydata(), amplitude[order == 24.0])
    assert kind[order == 24.0].tolist() == ["mesh 1"]


def test_band_of_shares_holds_the_mean_and_every_tooth_its_pressure():
    curves, pinion, wheel_teeth = plot_revolution_shares(turn(), 0).axes
    assert set(pinion.get_xticks() % 1.0) == set(wheel_teeth.get_xticks() % 1.0) == {0.0}
    mean = curves.lines[0].get_ydata()
    assert 0.9 < mean.max() <= 1.0
    assert_allclose(mean.sum(), 4.0, rtol=0.02)  # of each position all shares are one; ends of the turn are left out
    wheel = turn().by_tooth("wheel").peak_pressure.values[0]
    assert_allclose(wheel_teeth.lines[0].get_ydata(), wheel)
    assert_allclose(pinion.lines[0].get_ydata(), turn().by_tooth("pinion").peak_pressure.values[0])
    assert np.isfinite(wheel).all()
