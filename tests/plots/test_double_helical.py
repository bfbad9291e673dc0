"""Pictures of double helical pairs: curves of the numbers of the result, with axes that say what they are."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.plots import (
    DOUBLE_HELICAL_PICTURES,
    double_helical_figures,
    plot_half_envelope,
    plot_halves_axial_motion,
    plot_halves_face_load,
    plot_halves_shares,
)
from tests.samples.double_helical import analysed


@pytest.fixture(scope="module")
def result():
    return analysed()[0]


CURVES = [name for name in DOUBLE_HELICAL_PICTURES if name.startswith("halves_")]


@pytest.mark.parametrize("name", CURVES)
def test_picture_has_named_axes(name, result):
    (axes,) = DOUBLE_HELICAL_PICTURES[name](result).axes
    assert axes.get_xlabel()
    assert axes.get_ylabel()


def test_load_over_both_halves_is_the_normal_force_of_the_shares(result):
    axes = plot_halves_face_load(result).axes[0]
    first, second = (patch.get_data() for patch in axes.patches if hasattr(patch, "get_data"))
    assert_allclose((first.edges[0], first.edges[-1]), (10.0, 50.0), atol=0.1)  # half a lies above the groove
    assert_allclose((second.edges[0], second.edges[-1]), (-50.0, -10.0), atol=0.1)
    for half, cycle, stairs in zip((0, 1), result.halves, (first, second), strict=True):
        force = float(np.nan_to_num(cycle.normal_force)[0, 0].sum())  # of the only place of the pitch that counts
        assert_allclose(stairs.values @ np.diff(stairs.edges), force, rtol=1e-6), half


@pytest.mark.parametrize("half", [0, 1])
def test_pattern_of_a_half_has_its_highest_pressure(half, result):
    """Cells have the pressure of the maps of that half, under the torque nearest to its mean share."""
    name, cycle = "ab"[half], result.halves[half]
    figure = DOUBLE_HELICAL_PICTURES[f"half_envelope_{name}"](result)
    share = result.torque_share[-1, :, half].mean() * result.torque[-1]
    nearest = int(np.abs(cycle.torque - share).argmin())
    highest = max(one.pressure.max() for row in cycle.maps[nearest] for one in row if one is not None)
    for axes in figure.axes[:2]:
        (mesh,) = axes.collections
        # places between the middles of cells see a little less than the highest cell
        assert 0.8 * highest < np.nanmax(mesh.get_array()) <= highest * (1.0 + 1e-9)
    assert f"pressure envelope of half {name} under {1e-3 * cycle.torque[nearest]:g} N m" in figure.get_suptitle()
    shares = result.dataset.torque_share.copy()
    shares[..., half] = 0.0
    idle = replace(result, dataset=result.dataset.assign(torque_share=shares))
    assert not DOUBLE_HELICAL_PICTURES[f"half_envelope_{name}"].has(idle)
    with pytest.raises(InputError, match="half: 2 is no index from 0 to 1"):
        plot_half_envelope(result, 2)


def test_curves_are_those_of_the_result(result):
    axes = plot_halves_shares(result, torque=0).axes[0]
    assert_allclose(axes.lines[1].get_ydata(), 100.0 * result.torque_share[0, :, 1])
    axes = plot_halves_axial_motion(result).axes[0]
    assert_allclose(axes.lines[0].get_ydata(), 1e3 * result.axial_motion[0])
    with pytest.raises(InputError, match="torque"):
        plot_halves_shares(result, torque=7)


def test_gears_that_are_held_have_no_motion_to_draw(result):
    held = replace(result, scene=result.scene.with_changes({"pair.floating": "none"}))
    assert "halves_axial_motion" not in double_helical_figures(held)
