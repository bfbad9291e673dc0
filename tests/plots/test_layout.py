"""Layout whose first pass goes by estimates: near what is measured, and pictures as of two measured passes."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.testing import assert_array_equal

from loaded_tca.plots import layout
from loaded_tca.plots.layout import estimated_at_first, estimated_box

PIXEL = 1.0
NEAR = 14.0
"""Points: a digit or two of tick labels, and half a line."""


def panels():
    """Two rows with a colour bar, a second scale, titles and labels of several lines, on which ticks depend."""
    figure = Figure(figsize=(8.0, 6.0), layout="constrained", dpi=120)
    (first, second), (third, fourth) = figure.subplots(2, 2)
    figure.colorbar(first.pcolormesh(np.arange(12.0).reshape(3, 4)), ax=first, label="pressure [MPa]")
    second.plot([0.0, 1.0], [-2000.0, 500.0])
    second.set(title="a title\nof two lines", ylabel="share of\nthe torque [%]", xlabel="angle [deg]")
    second.twinx().set(ylim=(0.0, 1e-3), ylabel="at the base circle [µm]")
    third.set(xlim=(0.0, 12345.0), ylabel="stress")
    fourth.set_axis_off()
    figure.suptitle("all of it")
    return figure


def positions(figure):
    return np.array([axes.get_position().extents for axes in figure.axes]) * [*figure.bbox.size, *figure.bbox.size]


@pytest.mark.thorough
def test_panels_lie_where_two_measured_passes_put_them():
    """Within a pixel."""
    measured, estimated = panels(), panels()
    FigureCanvasAgg(measured).draw()
    with estimated_at_first(estimated):
        FigureCanvasAgg(estimated).draw()
    np.testing.assert_allclose(positions(estimated), positions(measured), atol=PIXEL)


@pytest.mark.thorough
def test_each_panel_is_measured_in_one_pass_of_two():
    """Colour bars are measured twice in a pass; what is in space is measured always."""
    figure, calls = panels(), []
    space = figure.add_subplot(3, 3, 9, projection="3d")
    for axes in figure.axes:
        measured = axes.get_tightbbox
        axes.get_tightbbox = lambda *a, _m=measured, _x=axes, **k: calls.append(_x) or _m(*a, **k)
    with estimated_at_first(figure):
        FigureCanvasAgg(figure).draw()
    counts = {axes.get_label() or axes.name: calls.count(axes) for axes in figure.axes}
    assert counts == {"<colorbar>": 2, "rectilinear": 1, "3d": 2}
    assert calls.count(space) == 2


@pytest.mark.thorough
def test_estimates_are_near_what_is_measured():
    figure = panels()
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    for axes in figure.axes:
        measured = axes.get_tightbbox(canvas.get_renderer(), for_layout_only=True)
        assert estimated_box(axes).extents == pytest.approx(measured.extents, abs=NEAR * figure.dpi / 72.0)


def test_ticks_and_texts_made_once_draw_the_same_picture(monkeypatch):
    """Ticks depend on where a panel lies and on its limits, those of a colour bar and of a second scale, too.

    Copies of the first tick have what was asked of all, and what was asked of that one; so has their grid.
    """
    pictures = []
    for quick in (True, False):
        if not quick:
            for name, nothing in (("MEASURED_AGAIN", ()), ("TICKS", ()), ("LAYOUT_OF_TEXT", "_nothing")):
                monkeypatch.setattr(layout, name, nothing)
        figure = Figure(figsize=(3.0, 2.0), layout="constrained")
        axes = figure.add_subplot(ylabel="stress", title="at the root", xscale="log", xlim=(0.3, 40.0))
        figure.colorbar(axes.pcolormesh(np.arange(1.0, 5.0), np.arange(4.0), np.arange(9.0).reshape(3, 3)))
        axes.secondary_yaxis("right", functions=(lambda x: 2.0 * x, lambda x: 0.5 * x))
        axes.grid(alpha=0.3)
        axes.plot([1.0, 30.0], [0.5, 2.0], label="measured")
        axes.legend(title="pinion")
        axes.tick_params("x", labelrotation=30.0)
        axes.yaxis.get_major_ticks(1)[0].label1.set_color("red")
        axes.yaxis.get_major_ticks(1)[0].tick1line.set_markersize(8.0)
        canvas = FigureCanvasAgg(figure)
        with estimated_at_first(figure):
            canvas.draw()
            axes.set_title("another, longer title")
            canvas.draw()
        pictures.append(np.array(canvas.buffer_rgba()))
    assert_array_equal(*pictures)


def test_copies_of_ticks_change_alone_afterwards():
    """A notebook may give one tick another size or place."""
    figure = Figure(figsize=(2.0, 2.0))
    axes = figure.add_subplot()
    with estimated_at_first(figure):
        FigureCanvasAgg(figure).draw()
    first, second, *_ = ticks = axes.xaxis.get_major_ticks()
    second.label1.set_fontsize(30.0)
    second.tick1line.set_markersize(20.0)
    assert first.label1.get_fontsize() < second.label1.get_fontsize()
    assert first.tick1line.get_markersize() < second.tick1line.get_markersize()
    assert_array_equal([tick.get_loc() for tick in ticks], axes.get_xticks())


def test_figures_measure_as_before_afterwards():
    """Whoever draws the figure again, in a notebook, gets the layout of Matplotlib."""
    figure = panels()
    with pytest.raises(RuntimeError), estimated_at_first(figure):
        raise RuntimeError
    methods = [method for _, method, _ in layout.TICKS]
    replaced = "get_tightbbox", layout.LAYOUT_OF_TEXT, *layout.MEASURED_AGAIN, *methods
    assert not any(name in vars(artist) for artist in figure.findobj() for name in replaced)
