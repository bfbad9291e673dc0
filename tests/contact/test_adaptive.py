"""The choice of the grid: errors kept, no finer than needed, borders, and every refusal."""

import math
import re
from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import ContactProblem, solve_problem, solve_to_accuracy
from loaded_tca.contact.adaptive import refinement
from loaded_tca.contact.solution import CoarserGrid, ErrorEstimate
from loaded_tca.errors import AccuracyWarning
from loaded_tca.reference import hertz
from tests.refusals import refusals

E_STAR = 115e3
LOAD = 100.0


def paraboloid(curvatures, box=1.5, edge=np.inf, **asked):
    """The problem on every grid, under ``LOAD`` if nothing else is asked, and Hertz's contact.

    No material beyond ``edge`` times the semi-minor axis.
    """
    contact = hertz.point_contact(LOAD, curvatures, E_STAR)
    small, large = sorted(curvatures)

    def sample(cells):
        spacing = (2 * box * contact.semi_minor / cells[0], 2 * box * contact.semi_major / cells[1])
        x, y = ((np.arange(n) - (n - 1) / 2) * width for n, width in zip(cells, spacing, strict=True))
        gap = 0.5 * large * x[:, None] ** 2 + 0.5 * small * y**2
        gap[x > edge * contact.semi_minor] = np.inf
        return ContactProblem(gap, spacing, E_STAR, **(asked or {"load": LOAD}))

    return sample, contact


@pytest.mark.parametrize("ratio", [1.0, 30.0])
@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
def test_error_is_below_the_accuracy(ratio, accuracy):
    sample, contact = paraboloid((0.1, 0.1 / ratio**1.5))
    solution = solve_to_accuracy(sample, accuracy=accuracy)
    assert solution.error_estimate.second_order <= accuracy
    # on a smooth gap both estimates differ by the change beside the peak: 0.6 and 0.96 over the square of the cells
    assert solution.error_estimate.peak_pressure <= 1.6 * accuracy
    assert_allclose(solution.peak_pressure, contact.max_pressure, rtol=accuracy)


def test_grid_is_the_first_that_is_fine_enough():
    sample, _ = paraboloid((0.1, 0.1))
    sizes = [solve_to_accuracy(sample, accuracy=a).pressure.size for a in (3e-2, 1e-3, 1e-5)]
    assert sizes == sorted(sizes)
    assert sizes[0] == 32 * 32
    assert sizes[-1] <= 512 * 512


def test_answer_is_that_of_its_grid():
    """Coming from coarser grids changes the way, not the answer."""
    sample, contact = paraboloid((0.1, 0.02))
    solution = solve_to_accuracy(sample, accuracy=1e-3)
    direct = solve_problem(sample(solution.pressure.shape), tolerance=1e-5)
    assert_allclose(solution.pressure, direct.pressure, atol=1e-3 * contact.max_pressure)


def test_peak_that_misses_the_accuracy_where_that_is_of_the_approach_is_said():
    """A quarter of the contact is cut away: two grids agree on the approach, the peak beside the end has no limit."""
    sample, _ = paraboloid((0.1, 0.1), edge=0.1)
    with pytest.warns(AccuracyWarning) as warned:
        solution = solve_to_accuracy(sample, accuracy=0.05)
    assert solution.error_estimate.approach <= 0.05 < solution.error_estimate.peak_pressure
    assert [str(one.message) for one in warned if "accuracy 0.05" in str(one.message)] == [
        f"the estimated error of the peak pressure, {solution.error_estimate.peak_pressure:.2g}, is above the "
        "accuracy 0.05; where the pressure has no limit, this accuracy holds for the approach"
    ]


def test_approach_control_refines_too():
    approach = hertz.point_contact(LOAD, (0.1, 0.1), E_STAR).approach
    sample, _ = paraboloid((0.1, 0.1), approach=approach)
    solution = solve_to_accuracy(sample, accuracy=1e-3)
    assert_allclose(solution.load, LOAD, rtol=1e-3)


def test_edge_of_the_material_asks_for_the_approach_and_stops_at_64_cells():
    sample, contact = paraboloid((0.1, 0.1), edge=0.3)
    with pytest.warns(AccuracyWarning) as warned:
        solution = solve_to_accuracy(sample, accuracy=1e-6)
    approach, peak, ended = (str(one.message) for one in warned)
    assert re.fullmatch(r"the estimated error of the approach, 0\.\d+, is above the accuracy 0\.000001", approach)
    assert re.match(r"the estimated error of the peak pressure, 0\.\d+, is above the accuracy 0\.000001; where", peak)
    assert "the pressure has no limit" in ended
    assert solution.pressure.shape == (64, 64)
    assert solution.approach > contact.approach


def test_bodies_that_stand_apart_have_the_estimate_of_those_that_touch():
    """The approach counts from first contact."""
    sample, _ = paraboloid((0.1, 0.1), edge=0.3)

    def apart(cells):
        return replace(sample(cells), gap=sample(cells).gap + 0.5)

    near, far = (solve_to_accuracy(one, accuracy=0.02, warn=False) for one in (sample, apart))
    assert near.pressure.shape == far.pressure.shape
    assert_allclose(far.error_estimate.approach, near.error_estimate.approach, rtol=1e-3)  # differences of approaches


def test_accuracy_warnings_are_given_unless_left_to_the_caller():
    sample, _ = paraboloid((0.1, 0.1), box=0.8)
    with pytest.warns(AccuracyWarning) as warned:
        solve_to_accuracy(sample, accuracy=1e-2)
    assert any("reaches the border of" in str(one.message) for one in warned)
    assert solve_to_accuracy(sample, accuracy=1e-2, warn=False).reaches_border


def test_accuracy_that_the_finest_grid_misses_by_little_is_told(monkeypatch):
    """On 32 cells, 21 of them across, no error is told to be below 0.6/21^2 = 1.4e-3."""
    monkeypatch.setattr("loaded_tca.contact.adaptive.MOST_CELLS", 32)
    sample, _ = paraboloid((0.1, 0.1))
    solve_to_accuracy(sample, accuracy=2e-3)
    with pytest.warns(AccuracyWarning, match=r"error of the peak pressure, 0\.001\d, is above the accuracy 0\.0008$"):
        solve_to_accuracy(sample, accuracy=8e-4)


def test_no_load_needs_no_grid():
    sample, _ = paraboloid((0.1, 0.1), load=0.0)
    assert solve_to_accuracy(sample, accuracy=1e-3).pressure.shape == (16, 16)


test_argument_that_is_none_is_refused_by_name = refusals(
    lambda change: solve_to_accuracy(**{"problem": paraboloid((0.1, 0.1))[0], "accuracy": 1e-3} | change),
    *(({"accuracy": value}, ("^accuracy: ",)) for value in (0.0, -1.0, 1.0, np.nan, "text", None)),
    *(({"tolerance": value}, ("^tolerance: ",)) for value in (np.nan, "text", None, 0.0, 2.0)),
    *(
        ({"first_cells": cells}, ("^first_cells: .* are not two whole numbers from 1 on",))
        for cells in ((16,), (16, 16, 16), (16.0, 16.0), (0, 16), (-16, 16), 16, None, "ab")
    ),
    ({"initial_pressure": "text"}, ("^initial_pressure: ",)),
    ({"threads": "text"}, ("^threads: ",)),
    ({"problem": "text"}, r"^problem: 'text' is not a function of the numbers of cells$"),
)


@pytest.mark.parametrize("first_cells", [(17, 15), (3, 5), (1, 1)])
def test_first_grid_of_any_number_of_cells_leads_to_the_same_answer(first_cells):
    sample, contact = paraboloid((0.1, 0.1))
    solution = solve_to_accuracy(sample, accuracy=1e-3, first_cells=first_cells)
    assert_allclose(solution.peak_pressure, contact.max_pressure, rtol=1e-3)


@dataclass(frozen=True)
class Solution:
    """What refinement reads of a solution: whether an edge ends the contact, and the errors of peak and approach."""

    bounded: bool
    error_estimate: ErrorEstimate
    pressure: np.ndarray
    approach: float = 1.0
    approach_under_load: float = 1.0
    coarser: CoarserGrid | None = None

    def estimate(self, _slope_jump):
        return self.error_estimate


@pytest.mark.parametrize(
    ("ended", "peak_errors", "grids"),
    [
        ((True, True), (math.nan, 0.5), 2),  # the approach alone, as long as two grids have an end
        ((True, False, False), (math.nan, 0.5, 0.001), 3),  # a coarse grid alone had one
        ((False, True, True), (math.nan, 0.5, 0.5), 3),  # the coarse one had none
        ((False, False, False), (math.nan, 0.5, 0.001), 3),
    ],
)
def test_edge_ends_a_contact_where_two_grids_agree_that_it_does(ended, peak_errors, grids):
    solved = []

    def solve(cells, _tolerance, _start):
        number = len(solved)
        estimate = ErrorEstimate(peak_errors[number], 1e-4 if number else math.nan, peak_errors[number])
        solved.append(Solution(ended[number], estimate, np.ones(cells)))
        return solved[-1]
        yield

    with pytest.raises(StopIteration) as end:
        next(refinement(solve, 1e-2, 1e-6, lambda _: True, (16, 16), None))
    assert len(solved) == grids
    assert end.value.value[0].pressure.shape == (16 * 2 ** (grids - 1),) * 2


@pytest.mark.parametrize(("second_order", "cells"), [(0.001, 64), (0.02, 1024)])
def test_peak_that_converges_to_first_order_is_refined_to_64_cells(second_order, cells):
    """Where the curvature of the gap jumps, the estimate stays above the accuracy that a smooth gap would reach."""

    def solve(cells, _tolerance, _start):
        return Solution(False, ErrorEstimate(0.03, 1e-4, second_order), np.zeros(cells))
        yield

    with pytest.raises(StopIteration) as end:
        next(refinement(solve, 1e-2, 1e-6, lambda _: True, (16, 16), None))
    assert end.value.value[0].pressure.shape == (cells, cells)
    assert end.value.value[1] == second_order


def test_refined_grid_knows_how_much_the_pressure_changed_between_the_grids_before():
    """By 8 % from the first to the second, by nothing from the second to the third."""
    pressures, errors = iter((0.92, 1.0, 1.0)), iter((math.nan, 0.5, 0.001))

    def solve(cells, _tolerance, _start):
        error = next(errors)
        return Solution(False, ErrorEstimate(error, 1e-4, error), np.full(cells, next(pressures)))
        yield

    with pytest.raises(StopIteration) as end:
        next(refinement(solve, 1e-2, 1e-6, lambda _: True, (16, 16), None))
    coarser = end.value.value[0].coarser
    assert coarser.change_beside_peak == 0.0
    assert coarser.change_before == pytest.approx(0.08)
