import dataclasses

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.testing import assert_allclose

from loaded_tca import solve_contact
from loaded_tca.errors import InputError
from loaded_tca.plots import plot_solution
from loaded_tca.reference.hertz import line_contact, point_contact, point_contact_gap

MODULUS, LOAD, RADII = 115385.0, 100.0, (10.0, 40.0)
POINT = point_contact(LOAD, (1.0 / RADII[0], 1.0 / RADII[1]), MODULUS)


def solution(load=LOAD, cells=(32, 48)):
    size = 2.6 * POINT.semi_minor, 2.6 * POINT.semi_major
    gap, spacing = point_contact_gap(RADII, size, cells)
    return solve_contact(gap, spacing, MODULUS, load=load)


def test_map_and_sections_are_those_of_the_solution_and_hertz():
    one = solution()
    area, across, along, bar = plot_solution(one, POINT).axes
    # four cells are equally far from the middle: the solver leaves 1e-6 between them
    for panel in (across, along):
        assert_allclose(panel.lines[0].get_ydata().max(), one.pressure.max(), rtol=1e-5)
    hertz = across.lines[1]
    beside = 0.5 * one.spacing[1] / POINT.semi_major  # of an even number of cells, none is in the middle
    square = 1.0 - (hertz.get_xdata() / POINT.semi_minor) ** 2 - beside**2
    inside = square > 0.0  # the centre of force is that of the solver, with its tolerance of 1e-6
    assert_allclose(hertz.get_ydata()[inside], POINT.max_pressure * np.sqrt(square[inside]), rtol=1e-5)
    assert area.get_title() == across.get_ylabel() == "contact pressure [MPa]"
    assert bar.get_ylabel() == ""  # beside the label of the next panel
    assert across.get_legend() is None  # outside, not on the curves
    assert (area.get_xlabel(), area.get_aspect()) == ("second axis [mm]", 1.0)


def test_line_after_hertz_has_no_ends():
    line = line_contact(50.0, 1.0 / RADII[0], MODULUS)
    one = solution()
    _, across, along, _ = plot_solution(one, line).axes
    assert_allclose(across.lines[1].get_ydata(), line.pressure(across.lines[1].get_xdata()), rtol=1e-9, atol=1e-3)
    assert_allclose(along.lines[1].get_ydata(), line.pressure(0.5 * one.spacing[0]))


def sections_beside_hertz(gap, spacing, point=POINT, **options):
    """Pressure of the solution along both sections, and of Hertz at the same places."""
    figure = plot_solution(solve_contact(gap, spacing, MODULUS, load=LOAD, warn=False, **options), point)
    for panel in figure.axes[1:3]:
        drawn, hertz = panel.lines
        yield drawn.get_ydata(), np.interp(drawn.get_xdata(), hertz.get_xdata(), hertz.get_ydata())


@pytest.mark.parametrize("turn", [-1.2, -0.6, 0.0, 0.6, 1.2, 0.5 * np.pi])
def test_hertz_lies_where_the_contact_lies(turn):
    """An ellipse turned and shifted on the grid is that of Hertz all the same, along both sections."""
    place = (np.arange(96) - 47.5) * 2.8 * POINT.semi_major / 96
    x, y = place[:, None] - 0.1 * POINT.semi_major, place + 0.15 * POINT.semi_major
    across, along = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    gap = across**2 / (2.0 * RADII[0]) + along**2 / (2.0 * RADII[1])
    for drawn, hertz in sections_beside_hertz(gap, (place[1] - place[0],) * 2):
        # cells at the end of the contact, where the pressure falls as a root, are the worst
        assert np.abs(drawn - hertz)[drawn > 0.5 * POINT.max_pressure].max() < 0.01 * POINT.max_pressure
        assert drawn.max() > 0.99 * POINT.max_pressure


def test_sections_are_in_the_middle_where_many_cells_are_highest():
    """Under a cap the first of the highest cells lies at an end of the contact; its pressure is even."""
    size = 3.0 * POINT.semi_minor, 3.0 * POINT.semi_major
    gap, spacing = point_contact_gap(RADII, size, (48, 48))
    cap = 0.6 * POINT.max_pressure
    pressed = [(drawn > 0.0).sum() for drawn, _ in sections_beside_hertz(gap, spacing, max_pressure=cap)]
    both = solve_contact(gap, spacing, MODULUS, load=LOAD, max_pressure=cap).cells_across
    assert pressed == list(both)  # the longest lines of an ellipse run through its middle


def test_line_across_is_kept_where_the_grid_cuts_it_short():
    gap, spacing = point_contact_gap((RADII[0], np.inf), (0.8, 0.1), (64, 8))
    line = line_contact(LOAD / 0.1, 1.0 / RADII[0], MODULUS)
    (across, hertz), _ = sections_beside_hertz(gap, spacing, line)
    assert hertz.max() > 0.99 * line.max_pressure
    assert (hertz > 0.0).sum() < hertz.size
    assert across.size == 64


def test_fine_ridges_are_averaged_on_the_map():
    """Every other row of cells is under pressure, three rows to a dot: the map is even, no pattern of dots and rows."""
    pressure = np.zeros((900, 4))
    pressure[::2] = 1000.0
    one = dataclasses.replace(solution(0.0, cells=(900, 4)), pressure=pressure)
    figure = plot_solution(one)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    dots, *_ = figure.axes[0].images[0].make_image(canvas.get_renderer())
    middle = dots[8:-8, dots.shape[1] // 2, 2].astype(float)  # blue: 36 of the highest pressure, 255 of white
    assert len(middle) < 400
    assert np.ptp(middle) < 0.2 * 255


def test_load_free_grid_is_drawn_with_hertz():
    assert len(plot_solution(solution(load=0.0), POINT).axes[1].lines) == 2


def test_anything_else_than_hertz_is_refused():
    with pytest.raises(InputError, match=r"hertz: 1250\.0 is neither a PointContact nor a LineContact"):
        plot_solution(solution(), 1250.0)


def test_without_load_the_picture_says_so():
    assert "no load, no pressure" in [text.get_text() for text in plot_solution(solution(load=0.0)).axes[0].texts]


def test_long_grids_say_how_much_larger_they_are_drawn():
    gap, spacing = point_contact_gap((10.0, np.inf), (0.1, 10.0), (64, 16))
    with pytest.warns(UserWarning, match="reaches the border of"):
        area = plot_solution(solve_contact(gap, spacing, MODULUS, load=LOAD)).axes[0]
    assert f"drawn {area.get_aspect():g} times larger" in area.get_ylabel()


def test_gap_is_that_of_the_radii():
    gap, spacing = point_contact_gap((2.0, np.inf), (1.0, 3.0), (4, 3))
    assert spacing == (0.25, 1.0)
    assert_allclose(gap, np.array([0.375, 0.125, 0.125, 0.375])[:, None] ** 2 / 4.0 + np.zeros(3))


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (((0.0, 1.0), (1.0, 1.0), (4, 4)), r"radii\[0\]: 0.0 is not positive"),
        (((1.0, 1.0), (1.0, np.nan), (4, 4)), r"size\[1\]: nan is not positive"),
        (((1.0, 1.0), (1.0, 1.0), (0, 4)), "cells: found 0; allowed whole numbers from 1 on"),
    ],
)
def test_gap_refuses(arguments, told):
    with pytest.raises(InputError, match=told):
        point_contact_gap(*arguments)
