import numpy as np
import pytest
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
    assert_allclose(across.lines[0].get_ydata().max(), one.pressure.max())
    assert_allclose(along.lines[0].get_ydata().max(), one.pressure.max())
    hertz = across.lines[1]
    inside = np.abs(hertz.get_xdata()) <= POINT.semi_minor
    expected = POINT.max_pressure * np.sqrt(1.0 - (hertz.get_xdata()[inside] / POINT.semi_minor) ** 2)
    assert_allclose(hertz.get_ydata()[inside], expected, rtol=1e-9)
    assert area.get_title() == across.get_ylabel() == "contact pressure [MPa]"
    assert bar.get_ylabel() == ""  # beside the label of the next panel
    assert across.get_legend() is None  # outside, not on the curves
    assert (area.get_xlabel(), area.get_aspect()) == ("second axis [mm]", 1.0)


def test_line_after_hertz_has_no_ends():
    line = line_contact(50.0, 1.0 / RADII[0], MODULUS)
    _, across, along, _ = plot_solution(solution(), line).axes
    assert_allclose(across.lines[1].get_ydata(), line.pressure(across.lines[1].get_xdata()))
    assert_allclose(along.lines[1].get_ydata(), line.max_pressure)


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
