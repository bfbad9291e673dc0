import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.plots import plot_at_a_glance
from loaded_tca.results.key_figures import mean_over_a_pitch
from tests.samples import root_stress
from tests.samples.pictures import told
from tests.samples.results import result

ROUNDING = 1e-12  # of products, and of a mean that is taken off
CYCLE = {"name": "mesh_cycle_spur", "positions": 5, "torques": (40.0, 130.0)}


def test_sheet_has_the_numbers_of_its_torque():
    cycle = result(**CYCLE)
    figure = plot_at_a_glance(cycle, torque=0)
    assert "pinion torque 40 N m (number 1 of 2)" in told(figure)
    error, orders, shares = figure.axes[3:6]
    curve = cycle.transmission_error[0]
    expected = 1e3 * cycle.wheel_base_radius * (curve - mean_over_a_pitch(curve))
    assert_allclose(error.lines[0].get_ydata(), expected, rtol=ROUNDING)
    assert orders.get_ylabel().endswith("[µm]")
    assert_allclose(sum(line.get_ydata() for line in shares.lines), 100.0, rtol=1e-6)  # the balance's agreement
    assert "centre +0 mm from the middle" in figure.axes[1].get_legend_handles_labels()[1][0]  # a symmetric pair
    cells = {cell.get_text().get_text() for cell in figure.axes[2].tables[0].get_celld().values()}
    assert f"{cycle.key_figures()[0]['face_load_factor']:.4g}" in cells


def test_sheet_shows_root_stress_where_there_is_any():
    cycle = root_stress.result()
    stress = plot_at_a_glance(cycle).axes[5]
    assert stress.get_ylabel() == "largest root stress [MPa]"
    assert_allclose(stress.lines[0].get_ydata(), cycle.root_tension[1, :, 0])
    assert np.all(stress.lines[1].get_ydata() <= 0.0)


def test_nothing_of_the_sheet_covers_the_load_over_the_face():
    figure = plot_at_a_glance(result(**CYCLE))
    figure.canvas.draw()
    face = figure.axes[1]
    assert not face.get_legend().get_window_extent().overlaps(face.get_window_extent())


def test_empty_panel_says_why_within_its_width():
    alone = result("spur", positions=9, torques=(130.0,))
    figure = plot_at_a_glance(alone)
    figure.canvas.draw()
    orders = figure.axes[4]
    (text,) = orders.texts
    assert "no order is known" in text.get_text()
    assert text.get_window_extent().width < orders.get_window_extent().width


def test_one_position_has_no_sheet():
    with pytest.raises(InputError, match="found 1 position, allowed 2 or more"):
        plot_at_a_glance(result(positions=1))
