"""What is read between the cells: peak, area, semi-axes, and whether a contact ends of itself."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.contact import ContactProblem, patch, solve_contact, solve_problem
from loaded_tca.reference import hertz

ROUNDING = 1e-12
"""Of parabolas through cells, by least squares: 1e-14 was seen."""


def ellipse(shape, centre, axes, angle=0.0):
    """Pressure 1 in the middle of an ellipse, cells of width one."""
    x, y = np.arange(shape[0])[:, None] - centre[0], np.arange(shape[1]) - centre[1]
    along, across = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
    return np.sqrt(np.maximum(0.0, 1.0 - (along / axes[0]) ** 2 - (across / axes[1]) ** 2))


@given(
    offset=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)),
    axes=st.tuples(st.floats(5.0, 18.0), st.floats(5.0, 18.0)),
    angle=st.floats(0.0, math.pi),
)
def test_peak_of_an_ellipse_is_exact_wherever_it_lies(offset, axes, angle):
    pressure = ellipse((40, 40), (19.5 + offset[0], 19.5 + offset[1]), axes, angle)
    assert_allclose(patch.peak_pressure(7.0 * pressure), 7.0, rtol=ROUNDING)


def test_peak_of_other_shapes_is_their_largest_cell():
    rng = np.random.default_rng(3)
    ridge = 1.0 - 0.03 * np.abs(np.arange(20)[:, None] - 9.7) - 0.01 * np.abs(np.arange(20) - 11.2)
    for pressure in (rng.random((30, 30)), ridge, np.eye(20), np.ones((20, 20)), np.ones((1, 1)), np.zeros((4, 4))):
        assert patch.peak_pressure(pressure) == pressure.max()


@given(offset=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)))
def test_peak_where_no_quadratic_fits_is_that_of_parabolas_through_its_cells(offset):
    """Two ellipses: the squares near the top of the higher one are those of a parabola along each axis."""
    two = ellipse((60, 60), (15.0 + offset[0], 30.0 + offset[1]), (9.0, 9.0))
    two = two + 0.9 * ellipse((60, 60), (42.0, 30.0), (9.0, 9.0))
    assert_allclose(patch.peak_pressure(two), 1.0, rtol=ROUNDING)


@given(offset=st.floats(-0.5, 0.5))
def test_peak_on_a_ridge_is_that_of_a_parabola_along_it(offset):
    along, across = np.arange(30) - 14.0 - offset, np.abs(np.arange(40)[:, None] - 20.0)
    square = np.maximum(1.0 - 0.05 * across - (along / 12.0) ** 2, 0.0)
    assert_allclose(patch.peak_pressure(np.sqrt(square)), 1.0, rtol=ROUNDING)


def test_peak_of_many_cells_is_thinned_without_loss():
    pressure = ellipse((600, 500), (300.3, 250.2), (280.0, 200.0))
    assert_allclose(patch.peak_pressure(pressure), 1.0, rtol=ROUNDING)


@given(
    offset=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)),
    axes=st.tuples(st.floats(8.0, 18.0), st.floats(8.0, 18.0)),
    angle=st.floats(0.0, math.pi),
)
def test_area_and_axes_of_an_ellipse(offset, axes, angle):
    pressure = ellipse((48, 48), (23.5 + offset[0], 23.5 + offset[1]), axes, angle)
    area, minor, major = patch.area_and_semi_axes(pressure, (1.0, 1.0), np.ones(pressure.shape))
    # the edge is found to a quarter of a cell all round
    assert_allclose(area, math.pi * axes[0] * axes[1], rtol=0.5 / min(axes))
    assert_allclose([minor, major], sorted(axes), rtol=0.5 / min(axes))


def test_axes_of_a_solved_contact_are_hertz():
    contact = hertz.point_contact(100.0, (0.1, 0.1 / 37.4), 115e3)
    n = 64
    spacing = (3.0 * contact.semi_minor / n, 3.0 * contact.semi_major / n)
    x, y = ((np.arange(n) - (n - 1) / 2) * width for width in spacing)
    solution = solve_contact(0.05 * x[:, None] ** 2 + 0.05 / 37.4 * y**2, spacing, 115e3, load=100.0)
    assert_allclose(solution.semi_axes, (contact.semi_minor, contact.semi_major), rtol=5e-3)  # 43 cells across
    assert_allclose(solution.contact_area, contact.area, rtol=5e-3)


@pytest.mark.thorough
@pytest.mark.quick_cases("8-0.06")
@pytest.mark.parametrize(("across", "bound"), [(5, 0.15), (8, 0.06), (16, 0.02), (32, 0.005)])
def test_area_and_axes_of_solved_ellipses_are_as_exact_as_they_say(across, bound):
    """Beside Hertz; 20 ellipses of any ratio, whose middles lie anywhere in a cell."""
    generator, errors = np.random.default_rng(across), []
    while len(errors) < 20:
        curvatures = 0.1, 0.1 / 10.0 ** generator.uniform(0.0, 3.0)
        contact = hertz.point_contact(100.0, curvatures, 115e3)
        cells = across + generator.uniform(0.0, 1.0), 40.0
        spacing = 2.0 * contact.semi_minor / cells[0], 2.0 * contact.semi_major / cells[1]
        x, y = (
            (np.arange(round(1.3 * count)) - 0.65 * count + generator.uniform(0.0, 1.0)) * step
            for count, step in zip(cells, spacing, strict=True)
        )
        gap = 0.5 * (curvatures[0] * x[:, None] ** 2 + curvatures[1] * y**2)
        solution = solve_contact(gap, spacing, 115e3, load=100.0, warn=False)
        if min(solution.cells_across) == across:
            measured = np.array([solution.contact_area, *solution.semi_axes])
            errors.append(np.abs(measured / (contact.area, contact.semi_minor, contact.semi_major) - 1.0).max())
    assert max(errors) < bound


@pytest.mark.parametrize("cut", [False, True])
@pytest.mark.parametrize("half_lengths", [(1.0, 0.7), (0.7, 1.0)])
def test_area_and_axes_of_a_flat_punch_are_those_of_its_material(half_lengths, cut):
    """Nothing is carried beyond; ends between the borders of cells, which material covers in part or not at all."""
    n, width = 32, 2.4 / 32
    centres = (np.arange(n) + 0.5) * width - 1.2
    parts = [np.clip((half - np.abs(centres)) / width + 0.5, 0.0, 1.0) for half in half_lengths]
    cover = np.outer(*parts) if cut else np.outer(*(part > 0.5 for part in parts)).astype(float)
    gap = np.where(cover > 0.0, 0.0, np.inf)
    problem = ContactProblem(gap, (width, width), 115e3, load=100.0, cover=cover if cut else None)
    solution = solve_problem(problem)
    assert_allclose(solution.contact_area, problem.material_area, rtol=1e-12)  # summed in another order
    # second moments of a rectangle are those of an ellipse with 2/sqrt(3) of its sides; ends to half a cell
    assert_allclose(solution.semi_axes, np.array([0.7, 1.0]) * 2.0 / math.sqrt(3.0), rtol=0.5 * width / 0.7)


def test_area_without_contact_is_zero():
    solution = solve_contact(np.ones((20, 20)), (1.0, 1.0), 1.0, load=0.0)
    assert solution.contact_area == 0.0
    assert solution.semi_axes == (0.0, 0.0)


@pytest.mark.parametrize("turn", [0, 1, 2, 3])
@pytest.mark.parametrize(("end", "reached"), [(30.0, False), (26.2, False), (20.0, True), (15.0, True)])
def test_contact_ends_at_the_material_or_before(end, reached, turn):
    """A circle of radius 10 around 16: ends of itself at 26, unless the material ends first."""
    pressure = ellipse((32, 32), (16.0, 15.5), (10.0, 10.0))
    void = np.broadcast_to(np.arange(32)[:, None] > end, (32, 32))
    pressure = np.where(void, 0.0, pressure)
    assert patch.ends_at_material(np.rot90(pressure, turn), np.rot90(void, turn)) is reached


def test_one_cell_before_the_end_of_the_material_reaches_it_whatever_stands_at_the_other_border():
    pressure = np.zeros((8, 3))
    pressure[0], pressure[-1] = 1.0, 10.0
    void = np.broadcast_to(np.arange(8)[:, None] == 1, (8, 3))
    assert patch.ends_at_material(pressure, void)


@given(offset=st.floats(-0.5, 0.5), radius=st.floats(4.0, 12.0))
def test_ends_of_a_strip_lie_within_its_cells(offset, radius):
    """A Hertzian strip: p^2 is a parabola of half width R, which a chord through its last cells, d and d + 1 from its
    end, leaves by d (d + 1)/(2 R - 2 d - 1), at most 1/(R - 1.5).
    """
    pressure = ellipse((40, 6), (19.5 + offset, 2.5), (radius, 1e9))
    place = np.broadcast_to(np.arange(40.0)[:, None], pressure.shape)
    ends = patch.values_at_ends(pressure, place, np.ones(pressure.shape))
    assert_allclose(
        [ends.min(), ends.max()], [19.5 + offset - radius, 19.5 + offset + radius], atol=1.0 / (radius - 1.5)
    )


@pytest.mark.parametrize("part", [1.0, 0.7, 0.02])
def test_contact_that_the_material_cuts_ends_where_that_does(part):
    pressure = ellipse((20, 20), (9.5, 9.5), (8.0, 8.0))
    cover = np.ones(pressure.shape)
    cover[9], cover[10:] = part, 0.0
    place = np.broadcast_to(np.arange(20.0)[:, None], pressure.shape)
    ends = patch.values_at_ends(np.where(cover > 0.0, pressure, 0.0), place, cover, axes=(0,))
    assert_allclose(ends.max(), 8.5 + part, rtol=ROUNDING)


def test_width_of_a_contact_that_fills_its_material_ends_with_the_parts_of_cut_cells():
    """Three whole cells and 0.4 and 0.3 of one at either end, under an even pressure; a free slice has none."""
    cover = np.array([[0.0, 0.4, 1.0, 1.0, 1.0, 0.3, 0.0]] * 2).T
    pressure = np.where(cover > 0.0, 1.0, 0.0) * [1.0, 0.0]
    assert_allclose(patch.widths(pressure, cover), [3.7, 0.0])
