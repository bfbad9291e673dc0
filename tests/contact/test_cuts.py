"""Cells that an edge of the material cuts: continuity, contact conditions, and every refusal."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.contact import ContactProblem, contact_stiffness, solve_problem
from loaded_tca.contact.cuts import CROWDING, CutCells, crowding_growth
from loaded_tca.contact.grid import Grids
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.errors import InputError
from tests.refusals import refusals

ROUNDING = 1e-12
"""Of transforms over some hundred cells, and of a cap times a cover: 3e-15 was seen."""
MODULUS = 113e3
BOX = (0.6, 22.0)  # mm: half as wide again as the contact, and 2 mm longer
LOAD = 6000.0  # N on 20 mm: 0.4 mm wide under a curvature of 0.1/mm
ALONG = 4e-4  # of the approach: between strips whose ends lie on borders of cells
ACROSS = 4e-3  # the same where the end runs along the strip, in the middle of it, with all its force beside
TOLERANCE = 1e-7


def strip(cells, cut=None, **demand):
    """A cylinder on a plane that ends ``cut`` = (axis, cells before the end), and one cell before the box along it."""
    dx, dy = (length / cells for length in BOX)
    place = np.arange(cells) - 0.5 * (cells - 1)
    cover = np.ones((cells, cells))
    cover[:, 0] = 0.0
    if cut is not None:
        part = np.clip(cut[1] - np.arange(cells), 0.0, 1.0)
        cover *= part[:, None] if cut[0] == 0 else part
    gap = np.where(cover > 0.0, 0.05 * (place * dx)[:, None] ** 2, np.inf)
    return ContactProblem(gap, (dx, dy), MODULUS, cover=cover, **(demand or {"load": LOAD}))


def approach(cells, axis, end):
    return solve_problem(strip(cells, (axis, end)), tolerance=TOLERANCE).approach


@pytest.mark.parametrize(
    ("axis", "cells", "whole", "allowed"), [(1, 16, 14, ALONG), (1, 32, 29, ALONG), (0, 32, 18, ACROSS)]
)
def test_approach_goes_smoothly_from_one_whole_cell_to_the_next(axis, cells, whole, allowed):
    """Beside the cubic through the approaches of strips that end on borders of cells."""
    borders = whole + np.arange(-1.0, 3.0)
    cubic = np.polyfit(borders - whole, [approach(cells, axis, end) for end in borders], 3)
    parts = np.array([0.02, 0.2, 0.5, 0.8, 0.98])
    found = np.array([approach(cells, axis, whole + part) for part in parts])
    assert (np.diff(found) < 0.0).all(), "more material, less approach"
    assert_allclose(found, np.polyval(cubic, parts), rtol=allowed)


def oblique(cells, angle, distance, rng=None):
    """Problem and cover of a strip that ends at a line at an angle, its cells cut as it comes."""
    dx, dy = BOX[0] / cells, BOX[1] / cells
    x, y = ((np.arange(cells) - 0.5 * (cells - 1)) * step for step in (dx, dy))
    nx, ny = np.cos(angle), np.sin(angle)
    room = distance - (nx * x[:, None] / BOX[0] + ny * y / BOX[1])
    cover = np.clip(0.5 + room * cells / (abs(nx) + abs(ny)), 0.0, 1.0)
    if rng is not None:
        cover = np.where(rng.random(cover.shape) < 0.2, rng.random(cover.shape), cover)
    cover[cover < 0.01] = 0.0
    return np.where(cover > 0.0, 0.05 * x[:, None] ** 2 + 1e-5 * (y + 3.0) ** 2, np.inf), (dx, dy), cover


def displacement_of(solution):
    """Displacement under a pressure [mm], cell by cell from the formulas of Love and of cut cells."""
    problem, pressure = solution.problem, solution.pressure
    (nx, ny), (dx, dy) = pressure.shape, problem.spacing
    cover = np.ones((nx, ny)) if problem.cover is None else problem.cover
    kernel = influence_coefficients((nx, ny), dy / dx) * dx / problem.contact_modulus
    found = np.zeros((nx, ny))
    for i, j in np.argwhere(pressure > 0.0):
        found += pressure[i, j] * kernel[np.abs(np.arange(nx) - i)[:, None], np.abs(np.arange(ny) - j)]
        for k in np.flatnonzero(cover[:, j] > 0.0):
            crowded = CROWDING * (1.0 / max(cover[i, j], cover[k, j]) - 1.0)
            found[k, j] += crowded * kernel[abs(i - k), 0] * pressure[i, j]
    return found


@settings(max_examples=25, deadline=None)
@given(
    st.integers(8, 40),
    st.floats(0.0, np.pi),
    st.floats(-0.2, 0.5),
    st.sampled_from([None, 700.0]),
    st.booleans(),
    st.integers(0, 99),
)
def test_contact_conditions_hold_on_cut_cells(cells, angle, distance, cap, ragged, seed):
    gap, spacing, cover = oblique(cells, angle, distance, np.random.default_rng(seed) if ragged else None)
    load = LOAD if cap is None else 0.3 * cap * cover.sum() * spacing[0] * spacing[1]
    problem = ContactProblem(gap, spacing, MODULUS, load=load, max_pressure=cap, cover=cover)
    solution = solve_problem(problem, tolerance=TOLERANCE)
    pressure, limit = solution.pressure, (np.inf if cap is None else cap * cover)
    # also below: pressures are scaled to the load and added up, 5e-16 seen
    assert_allclose(pressure.sum() * solution.cell_area, load, rtol=1e-10)
    assert ((pressure >= 0.0) & (pressure <= limit * (1.0 + ROUNDING))).all()
    on_material = solution.pressure_on_material
    assert_allclose((on_material * cover).sum() * solution.cell_area, load, rtol=1e-10)
    assert (on_material <= (np.inf if cap is None else cap * (1.0 + ROUNDING))).all()
    assert_allclose(on_material[pressure > limit * (1.0 - 1e-9)], cap or 0.0, rtol=2e-9)  # cells at their limit
    excess = (displacement_of(solution) + gap - solution.approach) / solution.approach
    between = (pressure > 0.0) & (pressure < limit * (1.0 - 1e-9))
    assert pressure[between] @ np.abs(excess[between]) <= 2.0 * TOLERANCE * pressure.sum()
    assert excess[pressure == 0.0].min(initial=0.0) >= -2.0 * TOLERANCE
    assert excess[(pressure > 0.0) & ~between].max(initial=0.0) <= 2.0 * TOLERANCE


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_pressure_on_the_material_of_a_cut_cell_is_near_that_of_a_whole_one(part):
    """At the end of a strip, where pressure rises: the strip is a little shorter, and its load the same."""
    whole, cut = (solve_problem(strip(32, (1, end)), tolerance=TOLERANCE) for end in (30.0, 29.0 + part))
    last = 16, 29
    assert_allclose(cut.pressure_on_material[last], whole.pressure[last], rtol=0.04)
    assert_allclose(cut.pressure[last], part * whole.pressure[last], rtol=0.04)


def test_influence_matrix_of_cut_cells_is_symmetric_and_positive_definite():
    gap, spacing, cover = oblique(9, 1.2, 0.1, np.random.default_rng(3))
    grids = Grids.of([ContactProblem(gap, spacing, MODULUS, load=LOAD, cover=cover)])
    unit = np.eye(cover.size).reshape(-1, *cover.shape)
    displaced = grids.operator()
    matrix = np.array([displaced(one[None], np.empty((1, *cover.shape))).ravel() for one in unit])
    assert_allclose(matrix, matrix.T, rtol=0.0, atol=ROUNDING * np.abs(matrix).max())
    assert np.linalg.eigvalsh(matrix)[0] > 0.0


def test_window_of_a_grid_has_the_displacements_of_the_whole():
    gap, spacing, cover = oblique(24, 1.2, 0.1)
    grids = Grids.of([ContactProblem(gap, spacing, MODULUS, load=LOAD, cover=cover)])
    window, pressure = (slice(3, 20), slice(2, 15)), np.zeros((1, *cover.shape))
    pressure[:, *window] = np.random.default_rng(1).random((17, 13))
    whole = grids.operator()(pressure, np.empty(pressure.shape))
    part = grids.operator(window)(pressure, np.empty(pressure.shape))
    assert_allclose(part, whole, rtol=ROUNDING)


def test_cover_of_whole_cells_is_none():
    gap = strip(16).gap
    problem = ContactProblem(gap, (0.1, 1.0), MODULUS, load=LOAD, cover=np.ones(gap.shape))
    assert problem.cover is None
    without = ContactProblem(gap, (0.1, 1.0), MODULUS, load=LOAD)
    # a cover of ones is dropped: the same problem
    assert_array_equal(solve_problem(problem).pressure, solve_problem(without).pressure)


@pytest.mark.parametrize("axis", [0, 1])
def test_slivers_take_no_more_than_twice_the_iterations(axis):
    """Five to nine times as many without the parts in the preconditioner."""
    whole, sliver = (solve_problem(strip(32, (axis, end)), tolerance=TOLERANCE).iterations for end in (18.0, 18.01))
    assert sliver <= 2 * whole


def test_tangent_stiffness_is_that_of_close_loads():
    """Of a flat punch that ends within a cell, whose contact does not grow."""
    problem = strip(24, (1, 18.4))
    gap = np.where(np.isfinite(problem.gap), 0.0, np.inf)
    gap[:6] = gap[18:] = np.inf
    solution = solve_problem(ContactProblem(gap, problem.spacing, MODULUS, load=LOAD, cover=problem.cover))
    assert_allclose(contact_stiffness(solution), LOAD / solution.approach, rtol=1e-5)


def test_material_of_cut_cells_bears_no_more_than_the_cap():
    problem = strip(16, (1, 10.3), load=2.0, max_pressure=1.0)
    most = problem.cover.sum() * problem.cell_area
    with pytest.raises(InputError, match="more than max_pressure on all material can carry"):
        ContactProblem(problem.gap, problem.spacing, MODULUS, load=1.001 * most, max_pressure=1.0, cover=problem.cover)
    full = solve_problem(
        ContactProblem(problem.gap, problem.spacing, MODULUS, load=most, max_pressure=1.0, cover=problem.cover)
    )
    assert_allclose(full.pressure, problem.cover, rtol=1e-9)


test_impossible_covers_are_refused = refusals(
    lambda cover: ContactProblem(np.zeros((2, 2)), (1.0, 1.0), MODULUS, load=1.0, cover=cover),
    (np.ones((2, 3)), r"cover: its shape \(2, 3\) is not that of the gap, \(2, 2\)"),
    ([[1.0, 0.0], [0.5, 1.0]], "cover: 1 cells with a finite gap are not above 0 and at most 1"),
    ([[1.0, 1.2], [np.nan, 1.0]], "cover: 2 cells with a finite gap are not above 0 and at most 1"),
)


def test_displacement_of_cut_cells_grows_with_their_parts_as_between_two_covers(rng):
    shape, aspect, step = (8, 5), 20.0, 1e-6
    cover = np.clip(rng.uniform(-0.5, 1.5, shape), 0.0, 1.0)
    growth = rng.normal(size=(2, *shape)) * ((cover > 0.0) & (cover < 1.0))
    pressure = rng.uniform(1.0, 3.0, shape)

    def displaced(parts):
        out = np.zeros((1, *shape))
        CutCells.of(parts[None], np.array([aspect])).add(pressure[None], out)
        return out[0]

    expected = [(displaced(cover + step * one) - displaced(cover - step * one)) / (2.0 * step) for one in growth]
    found = crowding_growth(cover, growth, pressure, aspect)
    # differences of 1/c, of cells with a hundredth of their material: (step/c)^2
    assert_allclose(found, expected, rtol=0, atol=1e-6 * np.abs(found).max())
