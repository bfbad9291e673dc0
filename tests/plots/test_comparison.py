"""Pictures of several results: each curve and map is that of its result, on scales that all share."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.plots import plot_compared_maps, plot_comparison, png_of
from loaded_tca.results import compare_results
from tests.samples.pictures import told
from tests.samples.results import changed, changed_scene, result, with_a_gap

PANELS = ("error", "about_mean", "harmonics", "stiffness", "pressure", "share")


def spur(torques=(40.0, 130.0), positions=9):
    return result("mesh_cycle_spur", positions=positions, torques=torques)


def helical(torques=(130.0,), positions=5):
    return result("mesh_cycle_helical", positions=positions, torques=torques)


def panels(figure):
    return dict(zip(PANELS, figure.axes, strict=True))


@pytest.mark.thorough
def test_curves_are_those_of_each_result_under_the_shared_torque():
    named = {"spur": spur(), "helical": helical()}
    drawn = panels(plot_comparison(named))
    for k, (cycle, torque) in enumerate(((spur(), 1), (helical(), 0))):
        length = 1e3 * cycle.wheel_base_radius
        curves = {
            "error": length * cycle.transmission_error[torque],
            "stiffness": cycle.mesh_stiffness[torque],
        }
        for panel, curve in curves.items():
            line = drawn[panel].get_lines()[k]
            assert_allclose(line.get_xdata(), np.degrees(cycle.pinion_angle))
            assert_allclose(line.get_ydata(), curve)
        amplitudes = length * cycle.harmonics(8)[torque]
        heights = [bar.get_height() for bar in drawn["harmonics"].containers[k]]
        assert_array_equal(heights, amplitudes)  # exact: the same product, copied
        for panel, values in (("pressure", cycle.peak_pressure), ("share", 100.0 * cycle.load_share)):
            line = drawn[panel].get_lines()[k]
            assert (np.diff(line.get_xdata()) >= 0.0).all()
            assert_allclose(sorted(line.get_ydata()), sorted(values[torque][np.isfinite(values[torque])]))
    assert "[deg]" in drawn["error"].get_xlabel()


def test_transmission_errors_of_different_signs_are_drawn_in_their_own_directions():
    """Of drive and coast side, which lie on both sides of zero, so that both can be read on one axis."""
    other = changed(helical(), transmission_error=-helical().transmission_error)
    axes = panels(plot_comparison([helical(), other]))["error"]
    first, second = (line.get_ydata() for line in axes.get_lines())
    assert_array_equal(first, second)  # exact: one sign
    assert (first > 0.0).all()
    assert axes.get_ylabel() == "size of the transmission error [µm]"


def test_every_tooth_pair_has_its_share_at_the_angle_of_its_own_teeth():
    """Half a pitch before and behind the pitch point a spur pair carries the whole torque together with the next."""
    line = panels(plot_comparison([spur(), spur()]))["share"].get_lines()[0]
    angle, share = line.get_data()
    half = 180.0 / 34
    before, behind = (share[np.isclose(angle, side * half)].mean() for side in (-1.0, 1.0))
    assert_allclose(before + behind, 100.0, rtol=1e-3)  # a pitch apart: other contacts, the same to the grid
    assert_allclose(share[np.isclose(angle, 0.0, atol=1e-9)], 100.0)


def test_pinions_with_other_teeth_are_drawn_over_pitches():
    bevel = result("straight_bevel", positions=3, torques=(130.0,))
    drawn = panels(plot_comparison([helical(), bevel]))
    for line in drawn["error"].get_lines():
        assert_allclose(line.get_xdata()[[0, -1]], [-0.5, 0.5])
    assert drawn["pressure"].get_xlabel().endswith("[pitches]")
    assert drawn["pressure"].get_lines()[0].get_xdata().min() < -0.5  # shared: longer than a pitch


def test_result_without_load_sharing_has_no_harmonics():
    alone = result("spur", positions=9, torques=(130.0,))
    bars = panels(plot_comparison([spur(), alone]))["harmonics"].containers
    assert np.isfinite([bar.get_height() for bar in bars[0]]).any()
    assert not np.isfinite([bar.get_height() for bar in bars[1]]).any()
    texts = panels(plot_comparison([alone, alone]))["harmonics"].texts
    assert "no order is known" in texts[0].get_text()


@pytest.mark.thorough
def test_names_are_taken_literally():
    """Neither TeX, nor left out of the legend for an underscore at the beginning."""
    names = ["_old", "$x_1 \\frac{", "third"]
    named = dict(zip(names, [helical()] * 3, strict=True))
    figure = plot_comparison(named)
    shown = [text.get_text().strip().replace(r"\$", "$") for text in figure.legends[0].get_texts()]
    assert shown == names
    other = {name: changed_scene(cycle, {"title": name}) for name, cycle in named.items()}
    for drawn in (figure, plot_compared_maps(named), plot_comparison(other), plot_compared_maps(other)):
        assert png_of(drawn)


@pytest.mark.thorough
def test_titles_that_differ_give_way_to_the_names():
    other = changed_scene(helical(), {"title": "another"})
    assert f"; {helical().scene.title}; " in told(plot_comparison([helical(), helical()]))
    assert "; a | b; " in told(plot_comparison({"a": helical(), "b": other}))


@pytest.mark.parametrize("plot", [plot_comparison, plot_compared_maps])
def test_torque_that_is_not_shared_is_told(plot):
    comparison = compare_results([spur(), helical()])
    assert "pinion torque 130 N m" in told(plot(comparison, 130e3))
    with pytest.raises(InputError, match="torque: 40 N m; the results share 130 N m"):
        plot(comparison, 40e3)


def test_many_results_are_told_apart():
    lines = panels(plot_comparison([helical()] * 9))["error"].get_lines()
    assert len({(line.get_color(), line.get_marker()) for line in lines}) == 9


def test_maps_share_their_colours_and_lengths():
    more = changed(helical(), peak_pressure=helical().peak_pressure)
    cycles = [spur(), helical(), more]
    figure = plot_compared_maps(dict(zip("abc", cycles, strict=True)), 130e3)
    *drawn, bar = figure.axes
    highest = max(cycle.peak_pressure[cycle.torque == 130e3].max(initial=0.0, where=_known(cycle)) for cycle in cycles)
    for axes, name, cycle in zip(drawn, "abc", cycles, strict=True):
        (k,) = np.flatnonzero(cycle.torque == 130e3)
        position, column = cycle.peak_contact(k)
        one = cycle.maps[k][position][column]
        pressure = axes.collections[1]
        assert_array_equal(pressure.get_array().filled(0.0).reshape(one.pressure.shape), one.pressure)
        assert_allclose(pressure.get_clim()[1], highest, rtol=0.02)  # a map's own peak is that of its cells
        assert pressure.get_clim() == drawn[0].collections[1].get_clim()
        assert (axes.get_xbound(), axes.get_ybound()) == (drawn[0].get_xbound(), drawn[0].get_ybound())
        assert axes.get_aspect() == drawn[0].get_aspect()
        assert axes.get_title().startswith(f"{name}\nposition {position + 1} of {len(cycle.path)}")
    assert bar.get_ylim()[1] == drawn[0].collections[1].get_clim()[1]


def _known(cycle):
    return np.isfinite(cycle.peak_pressure[cycle.torque == 130e3])


def test_maps_of_a_position_are_those_at_the_nearest_part_of_a_pitch():
    """Position 4 of 5 lies a quarter of a pitch behind the middle: position 7 of 9."""
    figure = plot_compared_maps([helical(), spur()], position=3)
    titles = [axes.get_title().splitlines()[1] for axes in figure.axes[:2]]
    assert titles[0].startswith("position 4 of 5, tooth pair")
    assert titles[1].startswith("position 7 of 9, tooth pair")
    assert all(title.endswith("pinion angle 2.647 deg") for title in titles)


@pytest.mark.thorough
def test_maps_where_nothing_touches_or_is_loaded_say_so():
    gap = with_a_gap()
    figure = plot_compared_maps([result(torques=(20.0, 80.0)), gap], position=1)
    assert [text.get_text() for text in figure.axes[1].texts] == ["no tooth pair is in contact here"]
    unloaded = plot_compared_maps([result(torques=(0.0,), positions=2)] * 2)
    assert [text.get_text() for axes in unloaded.axes for text in axes.texts] == ["no load, no pressure"] * 2
    nowhere = plot_compared_maps([gap, gap], position=1)
    assert len(nowhere.axes) == 2  # no bar of colours
    assert png_of(nowhere)


def test_what_lies_beyond_a_smaller_map_is_hatched():
    """A map that fills its panel has no such ground, and none is needed where all are alike."""
    figure = plot_compared_maps([result("misaligned", positions=2), result("helical", positions=2)])
    assert all([patch.get_hatch() for patch in axes.patches if patch.get_hatch()] for axes in figure.axes[:2])
    assert "not in this map" in [text.get_text() for text in figure.legends[0].texts]
    alike = plot_compared_maps([result("helical", positions=2)] * 2)
    assert not [patch for axes in alike.axes for patch in axes.patches if patch.get_hatch()]


def test_cells_without_material_are_grey_and_those_beyond_a_map_white():
    figure = plot_compared_maps([result("misaligned", positions=2), result("helical", positions=2)])
    void = result("misaligned", positions=2)
    (at,) = [void.peak_contact(0)]
    ground = figure.axes[0].collections[0]
    assert_array_equal(
        ground.get_array().mask.reshape(void.maps[0][at[0]][0].gap.shape), np.isinf(void.maps[0][at[0]][0].gap)
    )
    assert_allclose(ground.get_cmap().get_bad()[:3], 0.8)
    assert_allclose(figure.axes[0].get_facecolor()[:3], 1.0)
