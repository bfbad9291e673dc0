"""Pictures of ratings show the load cases and the damage that they name."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.plots import plot_damage, plot_sn_curves
from tests.samples.rating import solved

SLOPES = {"operation.application_factor": 1.6, "rating.required_flank_safety": 1.9, "rating.required_root_safety": 5.0}


def rated(torques=(), **changes):
    cases = [{"pinion_torque_Nm": float(torque), "hours": 1.0} for torque in torques]
    return solved(**SLOPES | ({"load.case": cases} if cases else {}) | changes).rating()


def test_curves_have_every_load_case_at_its_load_cycles():
    one = rated()
    figure = plot_sn_curves(one)
    assert [axes.get_title() for axes in figure.axes] == ["flank", "root", "local: flank", "local: root"]
    curve, load = figure.axes[1].lines[:2]
    assert_allclose(load.get_xdata(), one.cycles[:, 0])
    assert_allclose(load.get_ydata(), 5.0 * one.sigma_F[:, 0])
    assert_allclose(np.interp(one.cycles[0, 0], curve.get_xdata(), curve.get_ydata()), one.sigma_FG[0, 0], rtol=0.2)


def test_bins_of_another_strength_stand_on_their_side_of_the_curve():
    """Damage is above 1 where a stress is above its strength: by the lives, which the picture does not use."""
    bins = [{"pinion_torque_Nm": 200.0 if side else 100.0, "hours": 1.0, "reversed": side} for side in (False, True)]
    one = rated(**{"load.case": bins, "analysis.torques_Nm": (100.0, 200.0), "rating.required_root_safety": 1.9})
    damage = one.damage[:, 0, 1]
    assert damage[0] < 1.0 < damage[1]
    axes = plot_sn_curves(one).axes[1]
    curve, load = axes.lines[:2]
    knees, levels = np.log(curve.get_xdata()), np.log(curve.get_ydata())
    over = np.log(load.get_ydata()) - np.interp(np.log(load.get_xdata()), knees, levels)
    assert (over > 0.0).tolist() == [False, True]
    assert_allclose(np.exp(over), 1.9 * one.sigma_F[:, 0] / one.sigma_FG[:, 0], rtol=1e-9)  # rounding of logarithms
    assert axes.get_ylabel() == "stress · required safety [MPa]\nscaled to the strength of the curve"
    assert "scaled" not in plot_sn_curves(rated()).axes[1].get_ylabel()


@pytest.mark.parametrize("torques", [(), np.linspace(100.0, 200.0, 45)])
@pytest.mark.filterwarnings("ignore:rating. the damage of the spectrum has no estimate")  # two torques
def test_bars_add_up_to_the_damage(torques):
    one = rated(torques)
    axes = plot_damage(one).axes[1]
    heights = [bar.get_height() for bar in axes.patches]
    assert len(heights) == 2 * (40 if len(torques) else 2)
    assert sum(heights) == pytest.approx(one.damage[:, :, 1].sum(), rel=1e-9)  # rounding of sums
    seen = [height for height in heights if height > 1e-6 * max(heights)]
    low, high = axes.get_ylim()
    assert low < min(seen) <= max(seen) < high
    assert axes.get_yscale() == ("log" if max(seen) > 10.0 * min(seen) else "linear")
    assert axes.get_ylabel() == "damage in 20000 h [-]"


@pytest.mark.filterwarnings("ignore:rating. the damage of the spectrum has no estimate")  # two torques
@pytest.mark.parametrize("torques", [(), np.linspace(100.0, 200.0, 45)])
def test_panels_of_damage_have_axes_of_one_kind(torques):
    """Logarithmic, if the damages of one panel differ by more than a decade."""
    panels = [axes for axes in plot_damage(rated(torques)).axes if any(bar.get_height() > 0.0 for bar in axes.patches)]
    seen = [np.array([bar.get_height() for bar in axes.patches]) for axes in panels]
    spans = [damage.max() / damage[damage > 1e-6 * damage.max()].min() for damage in seen]
    assert len(panels) > 1
    assert {axes.get_yscale() for axes in panels} == {"log" if max(spans) >= 10.0 else "linear"}


@pytest.mark.filterwarnings("ignore:rating. the damage of the spectrum has no estimate")  # two torques
def test_bars_of_one_torque_stand_at_that_torque_alone():
    one = rated([150.0])
    axes = plot_damage(one).axes[1]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["150"]
    assert axes.get_xticks().tolist() == [150.0]
    assert plot_damage(one).get_suptitle() == "damage of 1 bin"
    assert plot_sn_curves(one).get_suptitle() == "S-N curves with 1 bin"
    assert plot_sn_curves(rated()).get_suptitle() == "S-N curves with 2 torques"


def test_torques_above_the_static_strength_have_a_mark():
    axes = plot_damage(rated(**{"rating.required_root_safety": 20.0})).axes[1]
    assert "pinion: above the static strength" in axes.get_legend_handles_labels()[1]
