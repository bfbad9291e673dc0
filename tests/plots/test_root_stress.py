import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view
from numpy.testing import assert_allclose

from loaded_tca.errors import NotAskedError
from loaded_tca.plots import (
    PICTURES,
    plot_all,
    plot_root_stress,
    plot_root_stress_cycle,
    plot_root_stress_over_torque,
    png_of,
)
from loaded_tca.plots.style import note_of
from tests.samples.root_stress import result

WITHOUT = {"analysis.root_stress": False}


def panels(figure):
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def test_maps_of_both_gears_have_one_scale_of_colours_without_an_end_that_is_cut_off():
    cycle = result()
    figures = [plot_root_stress(cycle), plot_root_stress(cycle, 0)]
    assert [len(panels(figure)) for figure in figures] == [6, 6]
    shown = [axes for figure in figures for axes in panels(figure)]
    norms = {(mesh.norm.vmin, mesh.norm.vmax) for axes in shown for mesh in axes.collections}
    assert len(norms) == 1
    ((low, high),) = norms
    assert low == -high
    envelopes = [part[1] for one in cycle.root_stress for part in (one.largest, one.smallest)]
    assert high == max(np.abs(part).max() for part in envelopes)


def test_maps_are_those_of_the_asked_torque_with_the_back_on_the_left():
    cycle = result()
    first = panels(plot_root_stress(cycle, 0))[0]
    in_contact, back = first.collections
    one = cycle.root_stress[0]
    for side, mesh in enumerate((in_contact, back)):  # a field between four nodes has their mean
        corners = sliding_window_view(one.at_tension[0, side], (2, 2))
        assert_allclose(mesh.get_array(), corners.mean(axis=(2, 3)), rtol=1e-12, atol=1e-9)  # sums in another order
    assert back.get_coordinates()[..., 0].max() < 0.0 < in_contact.get_coordinates()[..., 0].min()
    told = [text.get_text() for text in first.texts]
    assert f"{cycle.root_tension[0, :, 0].max():.0f}" in told


def test_white_bands_beside_the_tooth_are_told():
    """Between the grey of the tooth, which ends at 10 deg, and the first stress at 15 deg."""
    figure = plot_root_stress(result(), 0)
    (in_contact, _) = panels(figure)[0].collections
    assert in_contact.get_coordinates()[..., 0].min() >= 15.0 - 0.1
    assert "white bands beside the tooth: not evaluated, the flank or less than 15 deg" in note_of(figure)


def test_curves_over_the_mesh_are_those_of_both_gears_on_one_axis():
    cycle = result()
    first, second = plot_root_stress_cycle(cycle).axes
    assert first.get_ylim() == second.get_ylim()
    for gear, axes in enumerate((first, second)):
        heights = [line.get_ydata() for line in axes.lines]
        for curve in (*cycle.root_tension[..., gear], *cycle.root_compression[..., gear]):
            assert any(np.array_equal(curve, one) for one in heights)


def test_lines_stand_where_the_number_of_loaded_pairs_changes():
    cycle = result()
    changes = np.flatnonzero(np.diff(cycle.loaded_pairs[1]))
    assert changes.size
    axes = plot_root_stress_cycle(cycle).axes[1]
    upright = sorted(line.get_xdata()[0] for line in axes.lines if len(set(line.get_xdata())) == 1)
    angle = np.degrees(cycle.pinion_angle)
    assert_allclose(upright, 0.5 * (angle[changes] + angle[changes + 1]))


@pytest.mark.thorough
def test_curves_over_the_torque_rise_with_it():
    cycle = result(**{"analysis.torques_Nm": (200.0, 100.0)})
    axes = plot_root_stress_over_torque(cycle).axes[0]
    curves = {line.get_label(): line for line in axes.lines}
    tension = curves["wheel: largest tension"]
    assert_allclose(tension.get_xdata(), [100.0, 200.0])
    assert_allclose(tension.get_ydata(), cycle.root_tension[::-1, :, 1].max(axis=1))
    assert len([label for label in curves if "ISO 6336-3" in label]) == 2
    bevel = plot_root_stress_over_torque(result("mesh_cycle_bevel")).axes[0]
    assert not [line for line in bevel.lines if "ISO" in line.get_label()]


@pytest.mark.quick_cases("plot_root_stress_over_torque")
@pytest.mark.parametrize("plot", [plot_root_stress, plot_root_stress_cycle, plot_root_stress_over_torque])
def test_pictures_are_drawn_without_load_too(plot):
    assert png_of(plot(result(**{"analysis.torques_Nm": (0.0, 0.001)})))


@pytest.mark.parametrize("plot", [plot_root_stress, plot_root_stress_cycle, plot_root_stress_over_torque])
def test_pictures_say_which_key_is_missing(plot):
    with pytest.raises(NotAskedError, match=r"set analysis.root_stress = true"):
        plot(result(**WITHOUT))


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_pictures_are_among_those_of_a_result_that_has_them(tmp_path):
    names = {name for name in PICTURES if name.startswith("root_stress")}
    assert len(names) == 3
    assert names <= {path.stem for path in plot_all(result(), tmp_path)}
    alone = result(**{"analysis.torques_Nm": (100.0,), "analysis.positions": 1})
    assert names & {path.stem for path in plot_all(alone, tmp_path)} == {"root_stress"}
    assert not names & {path.stem for path in plot_all(result(**WITHOUT), tmp_path)}
    assert not [path for path in tmp_path.iterdir() if path.stem in names]  # those of an earlier result are removed
