"""The picture of the stresses below a contact."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from loaded_tca.contact import subsurface_stress
from loaded_tca.plots.pressure_map import plot_subsurface
from loaded_tca.plots.style import save_figure
from tests.refusals import refusals
from tests.samples.pictures import told

DEPTHS = np.linspace(0.0, 2.0, 21)


def circle(depths=DEPTHS, cells=41):
    x = (np.arange(cells) - (cells - 1) / 2) * 3.0 / cells
    pressure = 1000.0 * np.sqrt(np.maximum(0.0, 1.0 - x[:, None] ** 2 - x**2))
    return subsurface_stress(pressure, (3.0 / cells, 3.0 / cells), depths)


@pytest.mark.parametrize(("quantity", "name"), [("max_shear", "shear"), ("von_mises", "von Mises")])
def test_picture_tells_what_and_where_in_its_units(quantity, name, tmp_path):
    stress = circle()
    figure = plot_subsurface(stress, quantity)
    axes = figure.axes[0]
    assert name in told(figure)
    assert axes.get_ylabel() == "depth [mm]"
    assert "[MPa]" in figure.axes[1].get_xlabel()
    label = axes.get_legend_handles_labels()[1][0]
    assert label.startswith(f"{getattr(stress, quantity).max():.4g} MPa")
    low, high = axes.get_ylim()
    assert low > high
    save_figure(figure, tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 10_000


def test_mark_lies_at_the_largest_value_whatever_the_order_of_depths():
    upward = plot_subsurface(circle(DEPTHS[::-1])).axes[0].lines[0]
    downward = plot_subsurface(circle()).axes[0].lines[0]
    np.testing.assert_allclose(upward.get_xydata(), downward.get_xydata())
    assert 0.4 <= downward.get_ydata()[0] <= 0.5


def test_wide_shallow_section_fills_its_picture():
    """A grid ten times as long as it is deep; its bar is as long, so that label and ticks have room."""
    stress = subsurface_stress(circle().sigma_z[0] * 0.0 + 100.0, (0.5, 0.5), DEPTHS)
    figure = plot_subsurface(stress)
    FigureCanvasAgg(figure).draw()
    section, bar = (axes.get_window_extent() for axes in figure.axes[:2])
    assert section.width > 0.8 * figure.bbox.width
    assert bar.width > 0.8 * section.width
    assert section.height + 250.0 > figure.bbox.height  # what stands above and below, in dots
    assert figure.axes[0].get_xlabel().startswith("first axis")


test_what_cannot_be_drawn_is_refused = refusals(
    plot_subsurface,
    (circle(), "pressure", "quantity: 'pressure'"),
    (circle([0.5, 0.5]), "max_shear", "two depths"),
    (subsurface_stress(np.zeros((4, 4)), (1.0, 1.0), DEPTHS), "max_shear", "none anywhere"),
)
