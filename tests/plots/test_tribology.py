"""Pictures of tribology show the numbers that they name; those whose inputs are missing are not drawn."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import NotAskedError
from loaded_tca.errors import InputError
from loaded_tca.plots import (
    TRIBOLOGY_PICTURES,
    plot_contact_temperature,
    plot_efficiency,
    plot_film_ratio,
    plot_friction_power,
    plot_over_flank,
    plot_sliding_velocities,
    tribology_figures,
)
from tests.samples.tribology import FAMILIES, known, shared

SPEEDS = [500.0, 1500.0]


def found(name="mesh_cycle_spur", **given):
    return known(shared(name), pinion_speed_rpm=SPEEDS, **given)


def heights(figure, panel=0):
    return np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in figure.axes[panel].lines])


@pytest.mark.thorough
@pytest.mark.parametrize("name", FAMILIES)
def test_all_pictures_of_every_family_are_drawn(name):
    assert set(tribology_figures(found(name, permissible_film_ratio=0.2))) == set(TRIBOLOGY_PICTURES)


def test_pictures_without_their_inputs_are_left_out():
    bare = shared("mesh_cycle_spur").tribology()
    assert tribology_figures(bare) == {}
    with pytest.raises(NotAskedError, match="needs pinion_speed_rpm"):
        plot_sliding_velocities(bare)
    assert set(tribology_figures(known(shared("mesh_cycle_spur"), lubricant=None, friction=0.05))) == {
        *("flank_flash_temperature", "flank_friction_power", "sliding_velocities", "efficiency", "friction_power")
    }


def test_curves_over_the_path_reach_the_extremes_at_the_worst_speed():
    one = found()
    assert_allclose(heights(plot_contact_temperature(one)).max(), one.largest_contact_temperature[1, 0])
    values = heights(plot_film_ratio(one))
    assert_allclose(values[values > 0.0].min(), one.least_film_ratio[0, 0])


def test_points_of_the_path_are_marked():
    axes = plot_contact_temperature(found()).axes[0]
    assert {text.get_text() for text in axes.texts} == set("ABCDE")
    assert not {text.get_text() for text in plot_contact_temperature(found("mesh_cycle_bevel")).axes[0].texts}


def test_efficiency_is_drawn_over_speeds_or_torques():
    one = found()
    assert_allclose(heights(plot_efficiency(one)), 100.0 * one.efficiency[:, 0])
    single = known(shared("mesh_cycle_spur"))
    alone = plot_efficiency(single)
    assert alone.axes[0].get_xlabel() == "pinion torque [N m]"
    assert not alone.legends  # one curve, whose name is that of the axis


def test_power_and_velocities_are_those_of_the_tribology():
    one = found()
    assert_allclose(heights(plot_friction_power(one, 0)), one.friction_power[0, 0])
    assert_allclose(heights(plot_sliding_velocities(one)).max(), one.slices(0, 1)["pinion_rolling_velocity"].max())


def test_speed_and_number_are_checked():
    with pytest.raises(InputError, match="speed: 2 is no index from 0 to 1"):
        plot_friction_power(found(), 2)
    with pytest.raises(InputError, match="name: 'beauty'"):
        plot_over_flank(found(), "beauty")
