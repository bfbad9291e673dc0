"""Pictures of several results on one subject: load over the face, contact patterns, root stress."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.plots import (
    COMPARISON_PICTURES,
    comparison_figures,
    plot_compared_face_load,
    plot_compared_patterns,
    plot_compared_root_stress,
)
from tests.samples import root_stress
from tests.samples.pictures import told
from tests.samples.results import changed, result


def spur():
    return result("mesh_cycle_spur", positions=9, torques=(40.0, 130.0))


def helical():
    return result("mesh_cycle_helical", positions=5, torques=(130.0,))


def bevel():
    return result("straight_bevel", positions=3, torques=(130.0,))


def test_load_over_the_face_adds_up_to_the_force_of_all_pairs():
    (axes,) = plot_compared_face_load({"$x_1": spur(), "b": helical()}).axes
    for steps, cycle, torque in zip(axes.patches, (spur(), helical()), (1, 0), strict=True):
        load, borders, _ = steps.get_data()
        force = np.nansum(cycle.normal_force[torque], axis=-1)[:-1].mean()  # the end of the pitch is its begin
        assert_allclose((load * np.diff(borders)).sum(), force, rtol=0.05)  # both ends are counted: 5 positions
    names = [text.get_text().strip() for text in axes.figure.legends[0].get_texts()]
    assert [name.partition(", K_Hβ = ")[0] for name in names] == [r"\$x_1", "b"]
    assert f"{helical().face_load_factor[0]:.2f}" in names[1]


def test_faces_that_are_counted_otherwise_are_drawn_by_their_parts():
    (axes,) = plot_compared_face_load([helical(), bevel()]).axes
    for steps in axes.patches:
        assert_allclose(steps.get_data()[1][[0, -1]], [0.0, 100.0])
    assert axes.get_xlabel().endswith("[%]")


def test_patterns_have_one_scale_of_colours_and_one_of_lengths():
    higher = changed(helical(), peak_pressure=1.5 * helical().peak_pressure)
    *panels, bar = plot_compared_patterns({"a": spur(), "b": bevel(), "c": higher}).axes
    assert len(panels) == 3
    spans = [np.ptp([axes.get_xbound(), axes.get_ybound()], axis=1) for axes in panels]
    assert_allclose(spans, np.broadcast_to(spans[0], np.shape(spans)))
    highest = max(np.nanmax(cycle.peak_pressure[-1]) for cycle in (spur(), bevel(), higher))
    assert {axes.collections[0].get_clim() for axes in panels} == {(0.0, highest)}
    assert bar.get_ylim() == (0.0, highest)
    assert [axes.get_title().partition("\n")[0] for axes in panels] == ["a", "b", "c"]


def test_root_stress_is_that_of_each_result_that_has_it():
    cycle = root_stress.result()
    more = changed(cycle, root_tension=1.5 * cycle.root_tension)
    without = result("mesh_cycle_spur", positions=5, torques=(100.0, 200.0))
    figure = plot_compared_root_stress({"a": cycle, "b": more, "c": without}, 100e3)
    for gear, axes in enumerate(figure.axes):
        tension = [axes.get_lines()[k].get_ydata() for k in (0, 2)]
        assert_array_equal(tension, [cycle.root_tension[0, :, gear], more.root_tension[0, :, gear]])
        assert_array_equal(axes.get_lines()[1].get_ydata(), cycle.root_compression[0, :, gear])
    assert "without root stress: c" in told(figure)
    with pytest.raises(InputError, match="root stress: 1 of the results have it; a comparison takes two or more"):
        plot_compared_root_stress([cycle, without])


def test_pictures_are_those_that_the_results_have(monkeypatch):
    drawn = {name: picture._replace(draw=lambda *_, **__: None) for name, picture in COMPARISON_PICTURES.items()}
    monkeypatch.setattr("loaded_tca.plots.comparison_subjects.COMPARISON_PICTURES", drawn)
    monkeypatch.setattr("loaded_tca.plots.comparison_subjects.plot_compared_maps", lambda *_, **__: None)
    always = {"comparison", "compared_maps", "compared_patterns"}
    alone = result(positions=1)
    assert {*comparison_figures([alone, alone])} == always
    assert {*comparison_figures([spur(), spur()])} == always | {"compared_face_load"}
    assert {*comparison_figures([root_stress.result()] * 2)} == {*COMPARISON_PICTURES}
    with pytest.raises(InputError, match="a mean over a pitch; found 1 position"):
        plot_compared_face_load([alone, alone])
