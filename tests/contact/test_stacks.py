"""Contact problems solved together: each as by itself, whatever stands beside it, and each with its own end."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.contact import ContactProblem, ContactStatus, FreeEdge, solve_problem, solve_problems, solver
from loaded_tca.contact.convolution import Convolution, Preconditioner
from loaded_tca.contact.descent import Descent
from loaded_tca.contact.grid import Grids
from loaded_tca.contact.love import influence_coefficients, own_coefficient
from loaded_tca.errors import ConvergenceError, InputError
from tests.samples.contact_conditions import contact_conditions

ROUNDING = 1e-12
"""Of loads, scaled and added up over some thousand cells: 4e-16 was seen; coefficients were the same."""
E_STAR = 115e3
KINDS = ("plain", "rough", "cap", "slices", "cover", "cap and slices", "slices and cover", "approach", "edge", "none")


def contact(kind, seed, cells=(32, 24)):
    """Problem of a kind on cells of an aspect of its own."""
    rng = np.random.default_rng(seed)
    dx, dy = 0.02 * rng.uniform(0.5, 1.5), 0.02 * 10.0 ** rng.uniform(-1.0, 1.5)
    x, y = ((np.arange(n) - n / 2 + rng.random()) * step for n, step in zip(cells, (dx, dy), strict=True))
    across, along = rng.uniform(0.02, 0.2), rng.uniform(0.1, 1.0) * 0.1 * (dx / dy) ** 2
    gap = 0.5 * (across * x[:, None] ** 2 + along * y**2)
    load, options = 300.0 * rng.uniform(0.3, 1.0) * dx * dy / 4e-4, {}
    if kind == "rough":
        gap = gap + 1e-5 * rng.standard_normal(cells)
    if "cap" in kind:
        options["max_pressure"] = load / (0.1 * cells[0] * cells[1] * dx * dy)
    if "slices" in kind:
        options["slice_compliance"] = 1e-8 / dy * np.exp(-np.abs(y[:, None] - y) / (8.0 * dy))
    if "cover" in kind:
        cover = np.clip(0.7 * cells[1] + 0.13 * np.arange(cells[0])[:, None] - np.arange(cells[1]), 0.0, 1.0)
        gap, options["cover"] = np.where(cover > 0.0, gap, np.inf), cover
    if kind == "edge":
        options["free_edges"] = (FreeEdge(1, 0.6 * cells[1] * dy, "below", 1.7),)
    if kind == "approach":
        return ContactProblem(gap, (dx, dy), E_STAR, approach=float(gap.min()) + rng.uniform(1e-4, 1e-3))
    return ContactProblem(gap, (dx, dy), E_STAR, load=0.0 if kind == "none" else load, **options)


def solved(problems, tolerance=1e-8, starts=None, **options):
    return solve_problems(problems, [tolerance] * len(problems), starts or [None] * len(problems), **options)


def assert_same(one, other):
    """To the last bit, and found in the same way."""
    assert_array_equal(one.pressure, other.pressure)
    assert_array_equal(one.gap, other.gap)
    for name in ("approach", "load", "residual", "iterations", "convolutions", "status", "problem"):
        assert getattr(one, name) == getattr(other, name), name
    assert (one.coarser is None) == (other.coarser is None)
    if one.coarser is not None:
        assert_array_equal(one.coarser.pressure, other.coarser.pressure)
        assert one.coarser.approach_change == other.coarser.approach_change


@pytest.mark.thorough
@settings(max_examples=15, deadline=None)
@given(
    kinds=st.lists(st.sampled_from(KINDS), min_size=2, max_size=12),
    cells=st.sampled_from([(16, 16), (32, 24), (17, 23), (40, 32), (64, 64)]),
    seed=st.integers(0, 99),
)
def test_solution_in_a_stack_is_that_of_the_problem_alone(kinds, cells, seed):
    problems = [contact(kind, seed + k, cells) for k, kind in enumerate(kinds)]
    for problem, found in zip(problems, solved(problems), strict=True):
        assert_same(found, solve_problem(problem, tolerance=1e-8))


def test_order_in_the_stack_does_not_matter():
    problems = [contact(kind, k) for k, kind in enumerate(KINDS * 2)]
    order = np.random.default_rng(4).permutation(len(problems))
    found, shuffled = solved(problems), solved([problems[k] for k in order])
    for place, k in enumerate(order):
        assert_same(shuffled[place], found[k])


def test_starts_and_tolerances_are_those_of_each():
    """Given pressures and none, close and loose tolerances in one call."""
    problems = [contact("plain", k) for k in range(6)]
    near = [found.pressure for found in solved([contact("plain", k) for k in range(1, 7)])]
    starts = [near[k] if k % 2 else None for k in range(6)]
    tolerances = [1e-4, 1e-4, 1e-9, 1e-9, 1e-6, 1e-6]
    found = solve_problems(problems, tolerances, starts)
    for k, problem in enumerate(problems):
        assert found[k].residual <= tolerances[k]
        assert (found[k].coarser is None) == bool(k % 2)
        assert_same(found[k], solve_problem(problem, tolerance=tolerances[k], initial_pressure=starts[k]))


def test_conditions_hold_for_every_problem_of_a_stack():
    problems = [contact(kind, k) for k, kind in enumerate(("plain", "rough", "cap", "approach") * 5)]
    for problem, found in zip(problems, solved(problems), strict=True):
        assert found.status is ContactStatus.CONVERGED
        assert contact_conditions(found, problem.gap) < 1e-7  # of the approach; rounding of a cap put exactly
        if problem.load is not None:
            assert_allclose(found.pressure.sum() * found.cell_area, problem.load, rtol=ROUNDING)


def test_problems_of_several_shapes_and_none_at_all():
    problems = [contact("plain", k, cells) for k, cells in enumerate([(16, 16), (24, 16), (16, 16), (70, 50)])]
    assert [found.problem for found in solved(problems)] == problems
    assert solve_problems([], [], []) == []


def test_one_that_fails_is_told_and_leaves_the_others_solved(monkeypatch):
    problems = [contact("plain", k) for k in range(5)]
    starts = [found.pressure for found in solved(problems)]
    starts[3] = np.ones_like(starts[3])
    monkeypatch.setattr(solver, "MOST_ITERATIONS", 2)
    found = solved(problems, starts=starts, on_failure="return")
    assert [each.status is ContactStatus.CONVERGED for each in found] == [True, True, True, False, True]
    assert found[3].iterations == 2
    assert found[3].residual > 1e-8
    with pytest.raises(ConvergenceError, match=r"^contact 3 not converged: residual .* after 2 iterations") as caught:
        solved(problems, starts=starts)
    assert_same(caught.value.last, found[3])


def test_refusal_tells_the_problem():
    problems = [contact("plain", k) for k in range(3)]
    with pytest.raises(InputError) as caught:
        solve_problems(problems, [1e-6, 2.0, 1e-6], [None, None, np.ones((3, 3))])
    assert caught.value.problems == (
        "problem 1: tolerance: 2.0 is not between 0 and 1",
        "problem 2: initial_pressure: its shape (3, 3) is not that of the gap, (32, 24)",
    )


def test_problems_that_are_solved_leave_the_stack():
    """Those left are fewer and fewer, and what was found for the first ones stays."""
    grids = Grids.of([contact("rough" if k % 4 == 0 else "plain", k) for k in range(8)])
    grids = grids.part(grids.whole)
    start = grids.fitted(np.zeros(grids.gap.shape))
    descent, sizes = Descent(grids, start), []
    keep = descent._keep
    descent._keep = lambda left: sizes.append(left.size) or keep(left)
    descent.run(np.full(8, 1e-7), np.full(8, 500))
    assert sizes
    assert sizes == sorted(sizes, reverse=True)
    assert (descent.residual <= 1e-7).all()
    assert len(set(descent.iterations)) > 1
    for k in range(8):
        alone = Descent(grids.select(np.array([k])), grids.fitted(np.zeros(grids.gap.shape))[[k]])
        alone.run(np.array([1e-7]), np.array([500]))
        # exact, also below: each problem of a stack takes the steps that it takes alone
        assert_array_equal(alone.pressure[0], descent.pressure[k])


@pytest.mark.parametrize("limit", [1024, 4 * 1024])
def test_stacks_are_split_where_they_grow_too_large(limit, monkeypatch):
    problems = [contact("plain", k) for k in range(9)]
    whole, sizes = solved(problems), []
    monkeypatch.setattr(solver, "STACK_CELLS", limit)
    solve_stack = solver._solve_stack
    monkeypatch.setattr(solver, "_solve_stack", lambda some, *rest: sizes.append(len(some)) or solve_stack(some, *rest))
    for one, other in zip(solved(problems), whole, strict=True):
        assert_same(one, other)
    assert max(sizes) <= limit // 768
    assert sum(sizes) == 9


@pytest.mark.parametrize("make", [Convolution, Preconditioner])
@pytest.mark.parametrize("shape", [(16, 16), (17, 23), (33, 5), (64, 64), (150, 90)])
def test_transforms_of_a_stack_are_those_of_each(make, shape, rng):
    """More problems than one block of the transforms holds, of an aspect each."""
    aspects = rng.uniform(0.1, 10.0, 19)
    values = rng.standard_normal((19, *shape)).astype(np.float32)
    found = make(shape, aspects)(values, np.empty_like(values))
    for k in range(19):
        alone = make(shape, aspects[[k]])(values[[k]], np.empty((1, *shape), dtype=np.float32))
        assert_array_equal(found[k], alone[0])
    some = np.array([0, 7, 18])
    assert_array_equal(make(shape, aspects)(values[some], np.empty((3, *shape), dtype="f4"), some), found[some])


def test_coefficients_of_many_aspects_are_those_of_each():
    aspects = np.array([0.05, 1.0, 7.0])
    for shape in ((9, 12), (130, 4)):
        for aspect, found in zip(aspects.tolist(), influence_coefficients(shape, aspects), strict=True):
            assert_allclose(found, influence_coefficients(shape, aspect), rtol=ROUNDING)
    # the same terms, by loops of another length
    assert_allclose(own_coefficient(aspects), influence_coefficients((1, 1), aspects)[:, 0, 0], rtol=ROUNDING)
