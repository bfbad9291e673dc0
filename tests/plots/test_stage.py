"""Pictures of stages: curves of the numbers of the result, with axes that say what they are."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.plots import (
    STAGE_PICTURES,
    plot_stage_load_factor,
    plot_stage_shares,
    plot_stage_sun_orbit,
    stage_figures,
)
from loaded_tca.stages import rebalanced
from tests.samples.stages import analysed


@pytest.fixture(scope="module")
def result():
    return analysed()[0]


@pytest.mark.quick_cases("stage_phases")
@pytest.mark.parametrize("name", STAGE_PICTURES)
def test_picture_has_a_title_and_named_axes(name, result):
    figure = STAGE_PICTURES[name](result)
    for axes in figure.axes:
        assert axes.get_title() or (axes.get_xlabel() and axes.get_ylabel())
    figure.canvas.draw()


def test_shares_are_those_of_the_result(result):
    axes = plot_stage_shares(result, torque=0).axes[0]
    assert_allclose(axes.lines[1].get_ydata()[:-1], 100.0 * result.planet_share[0, :, 1])
    with pytest.raises(InputError, match="torque"):
        plot_stage_shares(result, torque=7)


def test_factor_is_drawn_from_even_pins_to_twice_the_errors(result):
    axes = plot_stage_load_factor(result).axes[0]
    amounts, factors = axes.lines[-1].get_data()
    assert_allclose(amounts[[0, -1]], [0.0, 20.0])
    assert_allclose(factors[4], result.mesh_load_factor[np.argmax(result.torque)])


def test_stage_without_pin_errors_has_one_varied(result):
    plain = rebalanced(result, {"stage.pin_tangential_um": None})
    assert plot_stage_load_factor(plain).axes[0].lines[0].get_xdata()[-1] == pytest.approx(30.0)


def test_rigid_sun_has_no_orbit(result):
    figure = plot_stage_sun_orbit(rebalanced(result, {"stage.floating_sun": False}))
    assert any("held rigid" in text.get_text() for text in figure.axes[0].texts)
    drawn = stage_figures(rebalanced(result, {"stage.floating_sun": False}))
    assert list(drawn) == [name for name in STAGE_PICTURES if name != "stage_sun_orbit"]
