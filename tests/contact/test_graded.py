"""Contact on columns of unlike widths: conditions, equality with uniform grids, closed forms, order, failures."""

import numpy as np
import pytest
import scipy
from numpy.testing import assert_allclose

from loaded_tca.contact import ContactStatus, FreeEdge, GradedProblem, factors_across, solve_contact, solve_graded
from loaded_tca.contact.checks import BYTES_PER_PAIR, columns_memory_problem
from loaded_tca.contact.columns import FineZone, column_borders
from loaded_tca.contact.edges import extra_displacement
from loaded_tca.contact.graded import GradedGrids, Kernel
from loaded_tca.contact.love import column_coefficients, far_from, influence_coefficients
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.reference import hertz, wedge
from loaded_tca.reference.punch import RoundedPunch
from tests.refusals import refusals

CANCELLING = 3e-12
"""Of displacements up to 10 that are subtracted, with forces on a length of 1e5: 2e-13 was seen."""
ROUNDING = 1e-12
"""Of a load: pressures of some thousand cells are scaled to it and added up; 3e-16 was seen."""
E_STAR = 113187.0
LOAD = 112.0
TOLERANCE = 1e-8
HALF = 0.3
CELLS = 36
X = (np.arange(CELLS) + 0.5) * 2.0 * HALF / CELLS - HALF
DX = 2.0 * HALF / CELLS
SQUARED = np.linspace(-np.sqrt(HALF), np.sqrt(HALF), 61)
GRADED = SQUARED * np.abs(SQUARED)
"""Borders of columns whose widths grow from the middle on."""


def middles(borders):
    return 0.5 * (borders[1:] + borders[:-1])


def ellipsoid(x, y):
    return (1.3 * x[:, None] ** 2 + y**2) / 20.0


def graded(gap=ellipsoid, borders=GRADED, load=LOAD, tolerance=TOLERANCE, **options):
    problem = GradedProblem(gap(X, middles(borders)), DX, borders, E_STAR, load, **options)
    return solve_graded(problem, tolerance=tolerance)


def spread(y, stiff=3e-6, length=0.1):
    return stiff * np.exp(-np.abs(y[:, None] - y) / length)


def direct_displacement(solution):
    """Displacement by every cell at every cell, Love's formula written out once more, slices apart."""
    problem = solution.problem
    y, halves = problem.middles, 0.5 * problem.widths
    found = np.empty(solution.pressure.shape)

    def love(a, b):
        return a * np.arcsinh(b / np.abs(a)) + b * np.arcsinh(a / np.abs(b))

    for i, x in enumerate(X):
        near, far = (x - X)[:, None] - 0.5 * DX, (x - X)[:, None] + 0.5 * DX
        for j in range(y.size):
            low, high = y[j] - y - halves, y[j] - y + halves
            kernel = love(far, high) - love(near, high) - love(far, low) + love(near, low)
            found[i, j] = (kernel * solution.pressure).sum() / (np.pi * E_STAR)
    return found


@pytest.mark.quick_cases("options1")
@pytest.mark.parametrize("options", [{}, {"max_pressure": 900.0}])
def test_contact_conditions_hold_by_direct_summation(options):
    solution = graded(**options)
    level = direct_displacement(solution) + solution.problem.gap - solution.approach
    pressure, scale = solution.pressure, solution.approach_under_load
    assert_allclose(pressure.sum(axis=0) @ np.diff(GRADED) * DX, LOAD, rtol=ROUNDING)
    assert pressure.min() >= 0.0
    free = pressure > 0.0
    if options:
        assert pressure.max() == 900.0
        capped = pressure == 900.0
        assert level[capped].max() <= 2.0 * TOLERANCE * scale
        free &= ~capped
    # The residual weights cells with their pressure, so that a single one may be off by more than the tolerance.
    assert np.abs(level[free]).max() < 100.0 * TOLERANCE * scale
    assert level[pressure == 0.0].min() > -2.0 * TOLERANCE * scale
    assert_allclose(solution.gap, level, atol=1e-9 * scale)


def test_even_columns_have_the_coefficients_of_a_uniform_grid():
    found = column_coefficients(20, 0.5, np.arange(31) * 0.7)
    uniform = influence_coefficients((20, 30), 0.7 / 0.5)
    for m, n in ((0, 0), (0, 29), (12, 5), (29, 0)):
        assert_allclose(found[:, m, n], uniform[:, abs(m - n)] / (0.7 / 0.5), rtol=1e-9)


def test_coefficients_far_away_are_those_of_a_point_force():
    borders = np.array([0.0, 1e-3, 500.0, 500.2])
    found = column_coefficients(400, 0.5, borders)
    y = middles(borders)
    assert_allclose(found[0, 0, 2], 1.0 / (np.pi * (y[2] - y[0])) * 0.5, rtol=1e-6)
    assert_allclose(found[399, 0, 0], 0.5 / (np.pi * 399 * 0.5), rtol=1e-5)
    assert found.min() > 0.0


def test_series_of_far_rows_is_as_close_as_it_says():
    """Narrow and wide columns, rows longer and shorter than these; the error falls with the fourth power."""
    for spacing, widths in ((0.38, np.geomspace(6e-4, 0.04, 40)), (0.02, np.linspace(0.02, 0.1, 30))):
        borders = np.concatenate([[0.0], np.cumsum(widths)])
        exact, errors = column_coefficients(60, spacing, borders, far=np.inf), []
        for tolerance in (1e-4, 1e-5, 1e-6):
            found = column_coefficients(60, spacing, borders, far=far_from(tolerance))
            errors.append(np.abs(found / exact - 1.0).max() / tolerance)
        assert 0.1 < max(errors) < 1.0


@pytest.mark.parametrize(
    "options",
    [{}, {"max_pressure": 900.0}, {"max_pressure": 500.0}, {"slice_compliance": spread(X)}],
    ids=["elastic", "capped", "flat", "slices"],
)
def test_even_columns_have_the_solution_of_a_uniform_grid(options):
    """To what the tolerance leaves in a pressure: some hundred times as much in single cells of a capped contact."""
    borders = np.linspace(-HALF, HALF, CELLS + 1)
    found = graded(borders=borders, **options)
    uniform = solve_contact(ellipsoid(X, X), (DX, DX), E_STAR, load=LOAD, tolerance=TOLERANCE, warn=False, **options)
    assert_allclose(found.pressure, uniform.pressure, atol=1e-4 * uniform.pressure.max())
    assert_allclose(found.pressure.max(), uniform.pressure.max(), rtol=1e-6)
    assert_allclose(found.approach, uniform.approach, rtol=1e-6)
    assert_allclose(found.load, LOAD, rtol=ROUNDING)


def test_hertz_on_graded_columns():
    circle = hertz.point_contact(LOAD, (0.1, 0.1), E_STAR)
    found = graded(lambda x, y: (x[:, None] ** 2 + y**2) / 20.0)
    assert_allclose(found.pressure.max(), circle.max_pressure, rtol=2e-3)  # 26 cells across, 60 columns
    assert_allclose(found.approach, circle.approach, rtol=1e-3)


def test_symmetry_is_kept():
    pressure = graded().pressure
    assert_allclose(pressure, pressure[::-1], atol=1e-5 * pressure.max())
    assert_allclose(pressure, pressure[:, ::-1], atol=1e-5 * pressure.max())


def test_units_do_not_matter():
    """Metres and pascals give the same numbers."""
    problem = GradedProblem(ellipsoid(X, middles(GRADED)) * 1e-3, DX * 1e-3, GRADED * 1e-3, E_STAR * 1e6, LOAD)
    assert_allclose(solve_graded(problem, tolerance=TOLERANCE).pressure * 1e-6, graded().pressure, atol=1e-3)


def test_offset_of_the_gap_moves_the_approach_alone():
    plain, moved = graded(), graded(lambda x, y: ellipsoid(x, y) + 1e3)
    assert_allclose(moved.pressure, plain.pressure, atol=1e-4 * plain.pressure.max())
    assert_allclose(moved.approach_under_load, plain.approach_under_load, rtol=1e-6)


def test_nothing_is_carried_without_material():
    found = graded(lambda x, y: np.where(y > 0.05, np.inf, ellipsoid(x, y)))
    assert (found.pressure[:, middles(GRADED) > 0.05] == 0.0).all()
    assert np.isinf(found.gap[:, middles(GRADED) > 0.05]).all()
    assert_allclose(found.load, LOAD, rtol=ROUNDING)


@pytest.mark.parametrize("axis", [0, 1])
def test_bending_is_that_of_a_gap_which_bends_as_much(axis):
    y = X if axis == 0 else middles(GRADED)
    bent = graded(slice_compliance=spread(y), slice_axis=axis)
    forces = (bent.pressure * bent.problem.cell_areas).sum(axis=1 - axis)
    bending = spread(y) @ forces
    plain = graded(lambda x, y: ellipsoid(x, y) + (bending[:, None] if axis == 0 else bending))
    assert_allclose(plain.pressure, bent.pressure, atol=1e-4 * bent.pressure.max())
    assert_allclose(plain.approach, bent.approach, rtol=1e-6)


def test_slices_along_either_axis_are_the_same_of_the_transposed_contact():
    borders = np.linspace(-HALF, HALF, CELLS + 1)
    along = graded(borders=borders, slice_compliance=spread(X))
    turned = graded(lambda x, y: ellipsoid(y, x).T, borders, slice_compliance=spread(X), slice_axis=0)
    assert_allclose(turned.pressure.T, along.pressure, atol=1e-5 * along.pressure.max())


def test_iterations_are_some_tens_at_most_whatever_the_columns():
    for most in (20, 40, 80):
        borders = column_borders(-HALF, HALF, [FineZone(0.05, 0.02 / most, 0.01)], 0.05)
        assert graded(borders=borders, tolerance=1e-6).iterations <= 40


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize(("rows", "finest", "start"), [(46, 1e-3, 0.05), (55, 3e-4, 0.02), (12, 1e-3, 1.0)])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-5, 1e-6])
def test_pressures_of_fine_cells_are_known_as_closely_as_those_that_carry_the_load(rows, finest, start, tolerance):
    """A long contact that ends on two rounded edges: columns from 0.3 um to 2 mm. 200 tolerances of the largest."""
    x, borders = (
        (np.arange(rows) + 0.5) / rows * 0.5 - 0.25,
        column_borders(-12.0, 10.1, [FineZone(10.0, finest, 8.0 * finest)], 2.0),
    )
    y = middles(borders)
    gap = x[:, None] ** 2 / 20.0 + y**2 / 4e4 + np.maximum(y - 10.0, 0.0) ** 2 / 0.6
    gap += np.maximum(x[:, None] - start, 0.0) ** 2 / 0.4
    problem = GradedProblem(gap, 0.5 / rows, borders, E_STAR, 3000.0)
    found, closely = (solve_graded(problem, tolerance=each).pressure for each in (tolerance, 1e-9))
    assert np.abs(found - closely).max() < 200.0 * tolerance * closely.max()


def test_start_from_a_solution_needs_no_iteration():
    found = graded()
    again = solve_graded(found.problem, tolerance=2.0 * TOLERANCE, initial_pressure=found.pressure)
    assert again.iterations == 0
    assert_allclose(again.pressure, found.pressure, rtol=1e-9)


def test_start_that_leads_nowhere_is_given_up_for_coarser_columns(monkeypatch):
    """As one carried over from unlike cells did, in 500 iterations."""
    monkeypatch.setattr("loaded_tca.contact.graded.MOST_FROM_START", 2)
    found = graded()
    corner = np.where((X[:, None] < -0.2) & (middles(GRADED) < -0.2), 1.0, 0.0)
    again = solve_graded(found.problem, tolerance=TOLERANCE, initial_pressure=corner)
    assert again.iterations == 2 + found.iterations
    assert_allclose(again.pressure, found.pressure, rtol=0.0, atol=200.0 * TOLERANCE * found.pressure.max())


def test_single_lowest_cell_is_a_start():
    """One cell far below the others, which take over at the cap."""
    gap = np.full((16, 16), 0.5)
    gap[5, 5] = 0.0
    problem = GradedProblem(gap, 1.0, np.arange(17.0) ** 1.2, E_STAR, 1e3, max_pressure=100.0)
    found = solve_graded(problem)
    assert_allclose(found.load, 1e3, rtol=1e-9)
    assert found.pressure[5, 5] == 100.0
    lone = solve_graded(GradedProblem(gap, 1.0, np.arange(17.0) ** 1.2, E_STAR, 1.0))
    assert_allclose(lone.load, 1.0, rtol=ROUNDING)
    assert np.count_nonzero(lone.pressure) == 1


def test_no_load_is_no_pressure():
    found = graded(lambda x, y: ellipsoid(x, y) + 0.5, load=0.0)
    assert found.status is ContactStatus.NO_LOAD
    assert found.pressure.max() == found.load == found.approach_under_load == 0.0
    assert found.gap.min() == 0.0


def rounded_punch(cells_on_arc, widest, growth=1.3):
    """Flat punch with rounded ends, one cell of a great length along it: the plane problem."""
    punch = RoundedPunch(0.1, 0.2, 0.11, E_STAR)
    zones = [FineZone(side * 0.1, 0.01 / cells_on_arc, 0.015) for side in (-1.0, 1.0)]
    borders = column_borders(-0.15, 0.15, zones, widest, growth)
    y, length = middles(borders), 1000.0
    problem = GradedProblem(punch.gap(y)[None], length, borders, E_STAR, punch.line_load * length)
    return punch, y, solve_graded(problem, tolerance=TOLERANCE)


def test_pressure_of_a_rounded_punch():
    """Closed form: the pressure everywhere on the flat part, and the peak on the rounding."""
    punch, y, found = rounded_punch(20, 0.01, 1.2)
    flat = np.abs(y) < 0.098
    assert_allclose(found.pressure[0][flat], punch.pressure(y)[flat], rtol=2e-3)
    assert_allclose(found.pressure.max(), 2185.0, rtol=2e-3)
    assert_allclose(np.abs(y[found.pressure[0].argmax()]), 0.10302, atol=0.01 / 20)


def test_error_of_the_pressure_falls_with_the_columns():
    """Root mean square: 1.5, being of first order in a few cells only, where the rounding and the contact end."""
    errors = []
    for refined in (1, 2, 4):
        punch, y, found = rounded_punch(8 * refined, 0.02 / refined, 1.3 ** (1.0 / refined))
        inside = np.abs(y) < 0.11 - 3e-3
        errors.append(np.sqrt(np.mean((found.pressure[0][inside] / punch.pressure(y)[inside] - 1.0) ** 2)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.min() > 1.0
    assert errors[-1] < 1e-3


def test_fine_columns_agree_with_a_fine_uniform_grid():
    """A paraboloid that ends in a rounding: 256 x 512 even cells, and 36 x 60 graded ones."""

    def gap(x, y):
        return x[:, None] ** 2 / 20.0 + y**2 / 200.0 + np.maximum(y - 0.2, 0.0) ** 2 / 0.4

    x, y = ((np.arange(n) + 0.5) / n * length - start for n, length, start in ((256, 0.6, 0.3), (512, 1.1, 0.8)))
    spacing = (0.6 / 256, 1.1 / 512)
    fine = solve_contact(gap(x, y), spacing, E_STAR, load=300.0, warn=False)
    borders = column_borders(-0.8, 0.3, [FineZone(0.2, spacing[1], 0.03)], 0.05)
    found = graded(gap, borders, load=300.0, tolerance=1e-6)
    assert found.pressure.size < 0.03 * fine.pressure.size
    assert_allclose(found.pressure.max(), fine.pressure.max(), rtol=5e-3)
    assert_allclose(found.approach, fine.approach, rtol=1e-3)


GOOD = {"gap": np.zeros((3, 4)), "spacing": 1.0, "borders": [0.0, 1.0, 2.0, 4.0, 8.0], "load": 1.0}


test_problems_that_cannot_be_are_refused = refusals(
    lambda changed: GradedProblem(**({"contact_modulus": E_STAR} | GOOD | changed)),
    ({"gap": np.full((3, 4), np.nan)}, "^gap: 12 cells are NaN"),
    ({"gap": np.full((3, 4), np.inf)}, "^gap: no cell holds material"),
    ({"gap": np.full((3, 4), -np.inf)}, "^gap: minus infinity is no gap$"),
    ({"gap": np.zeros(4)}, "^gap: an array of shape"),
    ({"gap": "flat"}, "^gap: an array of finite numbers"),
    ({"borders": [0.0, 1.0, 2.0, 4.0]}, "^borders: 4 columns have 5, not 4$"),
    ({"borders": [0.0, 1.0, 1.0, 4.0, 8.0]}, "^borders: at least two finite numbers, each above the one before"),
    ({"borders": [0.0, 1.0, np.nan, 4.0, 8.0]}, "^borders: at least two"),
    ({"borders": [[0.0, 1.0]]}, "^borders: at least two"),
    ({"spacing": 0.0}, r"^spacing\[0\]: 0.0 is not between"),
    ({"spacing": np.nan}, r"^spacing\[0\]: nan is not between"),
    ({"contact_modulus": -1.0}, "^contact_modulus: -1.0 is not a number from"),
    ({"load": -1.0}, "^load: -1.0 N is neither 0 nor"),
    ({"load": np.nan}, "^load: nan N"),
    ({"load": None}, "^load: nan N"),
    ({"max_pressure": 0.0}, "^max_pressure: 0.0 MPa is not positive$"),
    ({"max_pressure": 1e-3}, "^load: 1.0 N is more than max_pressure on all material can carry, 0.024 N$"),
    ({"slice_compliance": np.zeros((3, 3))}, r"^slice_compliance: shape \(4, 4\) is needed, not \(3, 3\)$"),
    ({"slice_compliance": np.zeros((4, 4)), "slice_axis": 0}, r"^slice_compliance: shape \(3, 3\) is needed"),
    ({"slice_compliance": np.full((4, 4), np.nan)}, "^slice_compliance: 16 values are not finite$"),
    ({"slice_axis": 2}, "^slice_axis: 2 is neither 0 nor 1$"),
)


def test_arrays_of_a_problem_are_copies_that_stay():
    gap = np.zeros((3, 4))
    problem = GradedProblem(**(GOOD | {"gap": gap}), contact_modulus=E_STAR)
    gap[:] = 1.0
    assert problem.gap.max() == 0.0
    assert not any(array.flags.writeable for array in (problem.gap, problem.borders))


test_options_that_cannot_be_are_refused = refusals(
    lambda options: solve_graded(GradedProblem(**GOOD, contact_modulus=E_STAR), **options),
    ({"tolerance": 0.0}, "^tolerance: 0.0 is not between 0 and 1$"),
    ({"on_failure": "ignore"}, "^on_failure: 'ignore'"),
    ({"initial_pressure": np.zeros((2, 2))}, r"^initial_pressure: its shape \(2, 2\) is not that of the gap"),
    ({"initial_pressure": np.full((3, 4), np.nan)}, "^initial_pressure: holds negative"),
)


@pytest.mark.parametrize(("material", "position"), [("below", 0.35), ("above", 0.25)])
def test_free_edge_is_that_of_a_uniform_grid(material, position):
    borders = np.linspace(-HALF, HALF, CELLS + 1)
    edge = FreeEdge(1, position, material, 0.6)
    beyond = (middles(borders) + HALF > position) == (material == "below")

    def ends(x, y):
        return np.where(beyond, np.inf, ellipsoid(x, y))

    found = graded(ends, borders, free_edges=[edge])
    gap = ends(X, middles(borders))
    whole = solve_contact(gap, (DX, DX), E_STAR, load=LOAD, tolerance=TOLERANCE, free_edges=[edge], warn=False)
    assert_allclose(found.pressure, whole.pressure, atol=1e-4 * whole.pressure.max())  # the root of the residual
    assert_allclose(found.approach, whole.approach, rtol=1e-6)
    assert found.approach > graded(ends, borders).approach


def displacements(borders, edges, reference, length=1e5):
    """Displacements times E* by unit forces per length on each of the columns, which are long: plane strain."""
    problem = GradedProblem(
        np.zeros((1, borders.size - 1)), length, borders, E_STAR, 1.0, free_edges=edges, reference=reference
    )
    grids = GradedGrids.of_problem(problem)
    return np.array([grids.displaced(unit[None, None])[0][0, 0] for unit in np.eye(borders.size - 1)]).T


@pytest.mark.parametrize("degrees", [105.0, 115.0, 135.0, 150.0])
def test_image_with_a_reference_tilts_the_surface_as_a_wedge(degrees):
    """One of two like bodies: what a force adds, to what it adds where it is."""
    angle, borders, load = np.radians(degrees), np.linspace(-2.0, 0.2, 221), 99  # the load stands at 1.0, the apex at 0
    edge = FreeEdge(1, 2.0, "below", 0.5 * extra_displacement(angle))
    half_space, both = displacements(borders, [], None), displacements(borders, [edge], middles(borders)[load])
    added, apart = both - half_space, -middles(borders)
    assert_allclose(added, added.T, atol=CANCELLING)
    last = np.flatnonzero(apart > 0.0)[-1]  # what lies beyond the apex gives way as it, and acts as there
    assert_allclose(added[last + 1 :], np.broadcast_to(added[last], added[last + 1 :].shape), atol=CANCELLING)
    assert_allclose(added[load, load], 0.0, atol=CANCELLING)
    tilt = np.diff(added[[load + 1, load - 1], load])[0] / (apart[load - 1] - apart[load + 1])
    assert_allclose(tilt, -edge.factor / (np.pi * apart[load]), rtol=1e-4)  # of the wedge, exactly
    places = apart > 0.25
    exact = 0.5 * wedge.extra_displacement(apart[places], apart[load], angle)
    exact -= 0.5 * wedge.extra_displacement(apart[load], apart[load], angle)
    assert_allclose(added[places, load], exact, atol=0.055 * np.ptp(exact))  # 105 deg: 5 %


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_image_of_a_body_in_space_is_that_of_plane_strain_under_a_load_all_along_the_edge(nu):
    """Whatever Poisson's ratio, which plane strain does not know: 1 % of the range is left, by S in a straight line."""
    angle, borders, load = 0.5 * np.pi, np.linspace(-2.0, 0.0, 201), 99  # the load stands 1.0 before the edge
    edge = FreeEdge(1, 2.0, "below", 0.5 * extra_displacement(angle), factors_across(angle, nu, 0.5))
    added = displacements(borders, [edge], None) - displacements(borders, [], None)
    assert_allclose(added, added.T, atol=1e-4 * np.ptp(added))  # cells of the midpoint rule beside the edge
    places = -middles(borders)
    exact = 0.5 * wedge.extra_displacement(places, places[load], angle)
    obtained = added[:, load] - added[load, load]
    assert_allclose(obtained, exact - exact[load], atol=0.01 * np.ptp(exact))


def test_image_of_a_body_in_space_has_the_factors_of_points_far_apart():
    """By a unit force on one cell: right across the edge, and far apart along it."""
    borders, edge = np.linspace(-2.0, 0.0, 81), FreeEdge(1, 2.0, "below", 0.9, (0.3, 0.5))
    kernels = [Kernel(200, 0.025, borders, edges).whole for edges in ((edge,), ())]
    added = scipy.fft.idct(kernels[0] - kernels[1], type=1, axis=0)
    places = -middles(borders)
    both = places[:, None] + places
    across = added[0] * np.pi * both / 0.025
    expected = 0.3 + 0.2 * 4.0 * places[:, None] * places / both**2
    far = both > 12.0 * 0.025  # cells away, from where on forces on a cell are those of a point to 1/(24 12^2) a factor
    assert_allclose(across[far], expected[far], rtol=2e-3)
    assert_allclose(added[190, -1, -1] * np.pi * 190, 0.9, rtol=1e-4)


@pytest.mark.parametrize("factor", [0.3, 0.6])
def test_contact_beside_a_free_edge_with_a_reference(factor):
    """Graded columns against even ones; the load moves off the edge, and all it gives way is little."""
    edge = FreeEdge(1, HALF + 0.22, "below", factor)

    def ends(x, y):
        return np.where(y > 0.22, np.inf, ellipsoid(x, y))

    plain, found = graded(ends), graded(ends, free_edges=[edge], reference=0.0)
    even = graded(ends, np.linspace(-HALF, HALF, 121), free_edges=[edge], reference=0.0)
    assert found.status is ContactStatus.CONVERGED
    assert_allclose(found.load, LOAD, rtol=1e-9)
    assert_allclose(found.approach, even.approach, rtol=5e-3)
    assert_allclose(found.pressure.max(), even.pressure.max(), rtol=1e-2)
    centre = found.pressure.sum(axis=0) * found.problem.widths @ found.problem.middles * DX / LOAD
    assert -0.05 < centre < -0.005
    assert_allclose(found.approach, plain.approach, rtol=0.03 * factor)


test_free_edges_that_cannot_be_are_refused = refusals(
    lambda options: GradedProblem(**GOOD, contact_modulus=E_STAR, **options),
    ({"free_edges": [1.0]}, "^free_edges: .* is not a sequence of FreeEdge$"),
    ({"free_edges": [FreeEdge(0, 1.0, "below", 1.0)]}, r"^free_edges\[0\].axis: 0 is not 1, across the columns$"),
    ({"free_edges": [FreeEdge(1, 1.0, "below", -1.0)]}, r"^free_edges\[0\].factor: "),
    ({"reference": np.nan}, "^reference: nan mm is not finite$"),
)


def test_too_large_a_problem_is_refused_before_it_is_made():
    told = columns_memory_problem(1000, 1000, available=1e9)
    assert told == "1000 columns of 1000 cells need 44.7 GiB, the machine has 0.931 GiB"
    assert columns_memory_problem(64, 64, available=65 * 64**2 * BYTES_PER_PAIR) is None
    with pytest.raises(InputError, match=r"^gap: 2000 columns of 1000000 cells need"):
        GradedProblem(np.broadcast_to(0.0, (1_000_000, 2000)), 1.0, np.arange(2001.0), E_STAR, 1.0)


def test_last_iterate_comes_with_the_error(monkeypatch):
    monkeypatch.setattr("loaded_tca.contact.graded.MOST_ITERATIONS", 1)
    with pytest.raises(ConvergenceError, match=r"^contact on graded columns not converged: residual") as caught:
        graded()
    last = caught.value.last
    assert last.status is ContactStatus.NOT_CONVERGED
    assert_allclose(last.load, LOAD, rtol=1e-9)
    returned = solve_graded(last.problem, tolerance=TOLERANCE, on_failure="return")
    assert_allclose(returned.pressure, last.pressure)
