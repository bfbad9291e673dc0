"""A contact problem is what was given, checked, and stays so."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.contact import ContactProblem, FreeEdge, solve_contact, solve_problem
from tests.refusals import refusals, refused_calls

E_STAR = 115e3


def ball(n=24):
    x = (np.arange(n) - (n - 1) / 2) * 0.03
    return 0.05 * (x[:, None] ** 2 + x**2) + 0.3


def test_arrays_are_copies_that_cannot_be_written_to():
    gap, slices = ball(), np.zeros((24, 24))
    problem = ContactProblem(gap, (0.03, 0.03), E_STAR, load=50.0, slice_compliance=slices)
    gap[:], slices[:] = -1.0, -1.0
    assert_array_equal(problem.gap, ball())
    assert not problem.slice_compliance.any()
    for array in (problem.gap, problem.slice_compliance):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1.0


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda problem: pickle.loads(pickle.dumps(problem))])
def test_copies_and_what_pickle_brings_back_cannot_be_written_to_either(again):
    edge = FreeEdge(1, 0.5, "below", 1.0)
    problem = ContactProblem(
        ball(), (0.03, 0.03), E_STAR, load=50.0, free_edges=[edge], slice_compliance=np.zeros((24, 24))
    )
    found = again(problem)
    assert_array_equal(found.gap, problem.gap)
    assert (found.load, found.free_edges, found.spacing) == (50.0, (edge,), (0.03, 0.03))
    for array in (found.gap, found.slice_compliance):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1.0


def test_solution_keeps_the_problem_as_it_was():
    before = ball()
    solution = solve_contact(ball(), (0.03, 0.03), E_STAR, load=50.0, max_pressure=900.0)
    assert_array_equal(solution.problem.gap, before)
    assert solution.problem.load == 50.0
    assert solution.problem.cap == solution.problem.max_pressure == 900.0
    assert solution.problem.first_contact == before.min()
    again = solve_problem(solution.problem)
    assert_array_equal(again.pressure, solution.pressure)  # the same problem once more: the same steps


def test_load_is_changed_by_replacement():
    solution = solve_contact(ball(), (0.03, 0.03), E_STAR, load=50.0)
    other = solve_problem(dataclasses.replace(solution.problem, load=60.0), initial_pressure=solution.pressure)
    direct = solve_contact(ball(), (0.03, 0.03), E_STAR, load=60.0)
    assert abs(other.approach / direct.approach - 1.0) < 1e-5
    assert solution.problem.load == 50.0


def test_gap_is_infinite_beyond_free_edges():
    problem = ContactProblem(ball(), (0.03, 0.03), E_STAR, load=50.0, free_edges=[FreeEdge(0, 0.36, "below", 1.0)])
    assert np.isinf(problem.gap[12:]).all()
    assert_array_equal(problem.gap[:12], ball()[:12])


test_refusal_names_every_problem_and_comes_before_the_solution = refused_calls(
    (
        lambda: ContactProblem([[np.nan]], (0.0, -1.0), 0.0, load=1.0),
        (r"^spacing\[0\]: ", r"^spacing\[1\]: ", "^contact_modulus: ", "^gap: "),
    ),
    (lambda: ContactProblem(ball(), (0.03, 0.03), E_STAR), "exactly one"),
)
test_masked_number_is_none = refusals(
    lambda options: solve_contact(ball(), (0.03, 0.03), E_STAR, **options),
    ({"load": np.ma.masked}, "^load: "),
    ({"approach": np.ma.masked}, "^approach: "),
    ({"load": 10.0, "max_pressure": np.ma.masked}, "^max_pressure: "),
)


@pytest.mark.parametrize("cover", [None, np.full((24, 24), 0.5)])
def test_cap_that_one_cell_under_the_whole_load_would_not_reach_changes_nothing(cover):
    """Alone it would be pressed by the load over its material."""
    most = 50.0 / 0.03**2 / (1.0 if cover is None else 0.5)
    free = solve_problem(ContactProblem(ball(), (0.03, 0.03), E_STAR, load=50.0, cover=cover), tolerance=1e-10)
    for cap, near in ((1.001 * most, False), (0.999 * most, True)):
        problem = ContactProblem(ball(), (0.03, 0.03), E_STAR, load=50.0, max_pressure=cap, cover=cover)
        assert problem.cap_is_near is near
        found = solve_problem(problem, tolerance=1e-10).pressure
        assert_allclose(found, free.pressure, atol=1e-6 * free.pressure.max() if near else 0.0, rtol=0.0)
