"""The contact solver: contact conditions, symmetry and scaling, limits, convergence, and every refusal."""

import math
import pickle
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.contact import ContactStatus, FreeEdge, contact_stiffness, solve_contact, solver
from loaded_tca.contact.checks import memory_problem
from loaded_tca.errors import AccuracyWarning, ConvergenceError, InputError
from loaded_tca.reference import hertz
from tests.refusals import refusals
from tests.samples.contact_conditions import contact_conditions

ROUNDING = 1e-12
"""Of a load: pressures of some thousand cells are scaled to it and added up; 3e-16 was seen."""
E_STAR = 115e3
LOAD = 100.0
# 64 cells on a box of 1.5 times the contact: 43 cells across it; errors of second order, measured 1e-4 and below
PEAK_ERROR = 3e-4
APPROACH_ERROR = 2e-4


def centred(n, width):
    return (np.arange(n) - (n - 1) / 2) * width


def paraboloid(shape, contact, curvatures, box=3.0):
    """Gap of a paraboloid with its larger curvature along the first axis, and the spacing of its grid."""
    spacing = (box * contact.semi_minor / shape[0], box * contact.semi_major / shape[1])
    x, y = centred(shape[0], spacing[0]), centred(shape[1], spacing[1])
    small, large = sorted(curvatures)
    return 0.5 * large * x[:, None] ** 2 + 0.5 * small * y[None, :] ** 2, spacing


def hertz_problem(shape=(64, 64), curvatures=(0.1, 0.1), load=LOAD):
    contact = hertz.point_contact(load, curvatures, E_STAR)
    gap, spacing = paraboloid(shape, contact, curvatures)
    return contact, gap, spacing


@pytest.mark.parametrize("ratio", [1.0, 10.0, 100.0])
@pytest.mark.parametrize("shape", [(64, 64), (65, 70)])
def test_point_contact_agrees_with_hertz(shape, ratio):
    contact, gap, spacing = hertz_problem(shape, (0.1, 0.1 / ratio**1.5))
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD)
    assert_allclose(solution.peak_pressure, contact.max_pressure, rtol=PEAK_ERROR)
    assert_allclose(solution.approach, contact.approach, rtol=APPROACH_ERROR)
    assert_allclose(solution.pressure.sum() * solution.cell_area, LOAD, rtol=ROUNDING)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9, 1e-12])
def test_contact_conditions_hold_within_the_tolerance(tolerance):
    _, gap, spacing = hertz_problem(curvatures=(0.1, 0.02))
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=tolerance)
    assert solution.status is ContactStatus.CONVERGED
    assert solution.residual <= tolerance
    # computed twice in double precision: rounding of the displacement, 1e-15 of the approach, is all between
    assert_allclose(contact_conditions(solution, gap), solution.residual, atol=1e-13)
    assert solution.pressure.min() >= 0.0


def test_gap_is_zero_in_contact_and_positive_outside():
    _, gap, spacing = hertz_problem()
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-10)
    assert np.abs(solution.gap[solution.in_contact]).max() < 1e-6 * solution.approach  # weighted by p in the residual
    assert solution.gap[~solution.in_contact].min() > 0.0
    assert np.array_equal(solution.in_contact, solution.pressure > 0.0)


def test_pressure_error_is_of_second_order_in_the_approach():
    errors = []
    for n in (24, 48, 96):
        contact, gap, spacing = hertz_problem((n, n))
        errors.append(abs(solve_contact(gap, spacing, E_STAR, load=LOAD).approach - contact.approach))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    # the edge moves through the cells, so the order scatters around two
    assert orders.min() > 1.3


@pytest.mark.parametrize("ratio", [1.0, 30.0])
@pytest.mark.parametrize("n", [32, 64, 128])
def test_error_estimate_bounds_the_error_of_the_peak(n, ratio):
    contact, gap, spacing = hertz_problem((n, n), (0.1, 0.1 / ratio**1.5))
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-8)
    error = abs(solution.peak_pressure / contact.max_pressure - 1.0)
    # measured on 150 ellipses: 1 to 15 times the error of the fitted peak
    assert error < solution.error_estimate.peak_pressure < 50.0 * error


def test_error_estimate_of_the_approach_is_of_its_size():
    for n in (32, 64, 128):
        contact, gap, spacing = hertz_problem((n, n), (0.1, 0.01))
        solution = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-8)
        error = abs(solution.approach / contact.approach - 1.0)
        # the error itself changes sign with the place of the edge in its cell
        assert error / 10.0 < solution.error_estimate.approach < 30.0 * error


def test_one_grid_alone_has_no_error_estimate():
    _, gap, spacing = hertz_problem((30, 30))
    assert math.isnan(solve_contact(gap, spacing, E_STAR, load=LOAD).error_estimate.peak_pressure)


@given(factor=st.floats(1e-2, 1e2), unit=st.sampled_from([1.0, 1e-3, 1e3, 1e-9]), offset=st.floats(-1e3, 1e3))
@settings(max_examples=20)
def test_results_scale_with_load_units_and_offset(factor, unit, offset):
    """A load 8 times as large on a box 2 times as large: twice the pressure, four times the approach."""
    _, gap, spacing = hertz_problem((33, 40), (0.1, 0.03))
    one = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-10)
    offset *= gap.max() * factor**2 * unit
    longer = tuple(width * factor * unit for width in spacing)
    other = solve_contact(
        gap * factor**2 * unit + offset, longer, E_STAR / unit**2, load=LOAD * factor**3, tolerance=1e-10
    )
    # the tolerance leaves 1e-7 of the peak; an offset of 1000 gaps takes three digits of the gap's sixteen
    assert_allclose(other.pressure * unit**2, one.pressure * factor, rtol=0, atol=1e-7 * one.pressure.max() * factor)


def test_results_mirror_and_transpose(rng):
    gap = 1e-3 * rng.random((40, 33)) + 0.05 * (centred(40, 0.02)[:, None] ** 2 + centred(33, 0.03) ** 2)
    solve = lambda g, s: solve_contact(g, s, E_STAR, load=LOAD, tolerance=1e-10, warn=False).pressure  # noqa: E731
    pressure = solve(gap, (0.02, 0.03))
    close = 1e-6 * pressure.max()  # both within the tolerance of the one solution
    assert_allclose(solve(gap[::-1], (0.02, 0.03))[::-1], pressure, atol=close)
    assert_allclose(solve(gap[:, ::-1], (0.02, 0.03))[:, ::-1], pressure, atol=close)
    assert_allclose(solve(gap.T, (0.03, 0.02)).T, pressure, atol=close)


@pytest.mark.parametrize("cap", [None, 700.0])
def test_load_and_approach_control_are_inverse(cap):
    _, gap, spacing = hertz_problem(curvatures=(0.1, 0.02))
    gap = gap + 0.25
    by_load = solve_contact(gap, spacing, E_STAR, load=LOAD, max_pressure=cap, tolerance=1e-9)
    by_approach = solve_contact(gap, spacing, E_STAR, approach=by_load.approach, max_pressure=cap, tolerance=1e-9)
    assert_allclose(by_approach.load, LOAD, rtol=1e-6)  # a thousand times the tolerance
    assert by_approach.approach == by_load.approach
    assert_allclose(by_approach.pressure, by_load.pressure, atol=1e-5 * by_load.pressure.max())


def test_stiffness_is_the_slope_of_load_over_approach():
    contact, gap, spacing = hertz_problem((96, 96))
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-10)
    step = 1e-2 * contact.approach
    low, high = (
        solve_contact(gap, spacing, E_STAR, approach=solution.approach + s, tolerance=1e-10).load for s in (-step, step)
    )
    stiffness = contact_stiffness(solution)
    # one step adds a ring of less than a cell: the discrete slope is a staircase, a hundredth here
    assert_allclose(stiffness, (high - low) / (2.0 * step), rtol=1e-2)
    assert_allclose(stiffness, contact.stiffness, rtol=1e-2)


def test_stiffness_of_a_punch_is_load_over_approach():
    gap = np.full((48, 48), np.inf)
    gap[8:40, 8:40] = 0.0
    solution = solve_contact(gap, (0.1, 0.1), E_STAR, load=LOAD, tolerance=1e-9, warn=False)
    assert_allclose(contact_stiffness(solution, tolerance=1e-9), LOAD / solution.approach, rtol=1e-7)


def test_stiffness_is_zero_without_contact():
    assert contact_stiffness(solve_contact(np.ones((20, 20)), (1.0, 1.0), E_STAR, load=0.0)) == 0.0


def test_no_load_is_answered_with_the_smallest_gap():
    gap = np.full((20, 20), 0.7)
    gap[3, 4] = 0.5
    solution = solve_contact(gap, (1.0, 1.0), E_STAR, load=0.0)
    assert solution.status is ContactStatus.NO_LOAD
    assert solution.approach == 0.5
    assert not solution.pressure.any()
    assert_allclose(solution.gap, gap - 0.5)


@pytest.mark.parametrize("approach", [0.5, 0.3, -1.0])
def test_approach_short_of_the_gap_carries_nothing(approach):
    gap = np.full((20, 20), 0.5)
    solution = solve_contact(gap, (1.0, 1.0), E_STAR, approach=approach)
    assert solution.load == 0.0
    assert solution.approach == approach
    assert_allclose(solution.gap, gap - approach)


def test_cells_without_material_carry_nothing():
    contact, gap, spacing = hertz_problem()
    gap[:30] = np.inf
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD, warn=False)
    assert not solution.pressure[:30].any()
    assert np.isinf(solution.gap[:30]).all()
    assert np.isfinite(solution.gap[30:]).all()
    assert solution.reaches_material_edge
    assert not solution.reaches_border
    assert solution.peak_pressure == solution.pressure.max() > contact.max_pressure


def test_cap_is_kept_and_the_load_balanced():
    contact, gap, spacing = hertz_problem()
    cap = 0.7 * contact.max_pressure
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD, max_pressure=cap, tolerance=1e-9)
    assert_allclose(solution.pressure.max(), cap, rtol=1e-14)  # clipped at the cap
    assert_allclose(solution.pressure.sum() * solution.cell_area, LOAD, rtol=ROUNDING)
    assert contact_conditions(solution, gap) < 1e-8
    assert solution.approach > contact.approach


@given(cap=st.floats(350.0, 1300.0), unit=st.sampled_from([1.0, 3.0, 1e-3, 7e5]))
@settings(max_examples=20)
def test_capped_cells_are_exactly_at_the_cap(cap, unit):
    """Not a rounding error below it: the stiffness and every check tell them apart by equality."""
    _, gap, spacing = hertz_problem((24, 24))
    solution = solve_contact(
        gap, spacing, E_STAR * unit, load=LOAD * unit, max_pressure=cap * unit, tolerance=1e-9, warn=False
    )
    assert solution.pressure.max() == cap * unit
    assert contact_conditions(solution, gap) < 1e-8


def test_start_from_the_neighbouring_solution_saves_nothing_in_truth():
    """A start changes the way, never the answer."""
    contact, gap, spacing = hertz_problem()
    cold = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9)
    shifted = np.roll(cold.pressure, 2, axis=0)
    warm = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9, initial_pressure=shifted)
    assert_allclose(warm.pressure, cold.pressure, atol=1e-6 * contact.max_pressure)


def test_start_from_the_answer_needs_no_iteration():
    _, gap, spacing = hertz_problem()
    first = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9)
    again = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-6, initial_pressure=first.pressure)
    assert again.iterations == 0


def test_inputs_are_left_alone():
    _, gap, spacing = hertz_problem((32, 32))
    start = np.ones_like(gap)
    gap.setflags(write=False)
    start.setflags(write=False)
    solve_contact(gap, spacing, E_STAR, load=LOAD, initial_pressure=start)
    assert (start == 1.0).all()


OFF_SCALE = [
    ({"spacing": (1.0,)}, r"spacing: \[1.0\] is not a pair of cell widths"),
    ({"spacing": (1.0, 1.0, 1.0)}, r"spacing: \[1.0, 1.0, 1.0\] is not a pair of cell widths"),
    ({"spacing": 1.0}, "spacing: 1.0 is not a pair of cell widths"),
    ({"spacing": (1e-200, 1.0)}, r"spacing\[0\]: 1e-200 is not between 1e-20 and 1e20 mm"),
    ({"spacing": (1.0, 1e200)}, r"spacing\[1\]: 1e\+200 is not between"),
    ({"spacing": (1e-9, 1e9)}, r"spacing: \[1e-09, 1000000000.0\] are widths of a ratio above 1e12"),
    ({"contact_modulus": 1e300}, r"contact_modulus: 1e\+300 is not a number from 1e-30 to 1e30 MPa"),
    ({"contact_modulus": 1e-300}, "contact_modulus: 1e-300 is not a number from"),
    ({"load": 1e-300}, "load: 1e-300 N is neither 0 nor, on this grid, a number from 1.15e-20 to"),
    ({"load": 1e300}, r"load: 1e\+300 N is neither 0 nor"),
    ({"load": None, "approach": 1e300}, r"approach: 1e\+300 mm lies 1e\+300 mm beyond first contact; allowed up to"),
    ({"load": None, "approach": 1e-300}, "approach: 1e-300 mm lies"),
]
NO_NUMBERS = [
    *(
        ({name: values}, f"{name}: an array of finite numbers is asked for, not ")
        for name in ("gap", "spacing", "initial_pressure")
        for values in ("text", [[1.0], [1.0, 2.0]], [["1.0", "2.0"]], [None, 1.0], 1j)
    ),
    ({"gap": None}, "gap: an array of finite numbers is asked for, not None"),
    ({"spacing": None}, "spacing: an array of finite numbers is asked for, not None"),
    *(
        ({name: np.ma.masked_less(np.ones((4, 4)), 2.0)}, f"{name}: a masked array; fill what is masked")
        for name in ("gap", "initial_pressure")
    ),
    *(
        ({name: value}, f"{name}: ")
        for name in ("contact_modulus", "load", "max_pressure", "tolerance", "threads", "free_edges")
        for value in ("text", [1.0, 2.0], 1j)
    ),
    *(({name: None}, f"{name}: None ") for name in ("contact_modulus", "tolerance", "threads", "free_edges")),
    ({"load": None, "approach": "text"}, "approach: text"),
    ({"load": True}, "load: True"),
    ({"threads": 0}, "threads: 0 is not a whole number from 1 on"),
    ({"free_edges": [(0, 1.0, "below", 1.0)]}, "free_edges: .* is not a sequence of FreeEdge"),
    ({"free_edges": [FreeEdge(0, "text", "below", 1.0)]}, r"free_edges\[0\].position: text mm is not finite"),
]


def solve_changed(change):
    arguments = {"gap": np.zeros((4, 4)), "spacing": (1.0, 1.0), "contact_modulus": E_STAR, "load": 1.0} | change
    solve_contact(arguments.pop("gap"), arguments.pop("spacing"), arguments.pop("contact_modulus"), **arguments)


test_refuses = refusals(
    solve_changed,
    ({"gap": np.zeros(5)}, "not a grid of cells"),
    ({"gap": np.zeros((0, 5))}, "not a grid of cells"),
    ({"gap": np.zeros((3, 3, 3))}, "not a grid of cells"),
    ({"gap": np.array([[0.0, math.nan]])}, "1 cells are NaN"),
    ({"gap": np.array([[0.0, -math.inf]])}, "minus infinity"),
    ({"gap": np.full((4, 4), math.inf)}, "no cell holds material"),
    ({"spacing": (0.0, 1.0)}, r"spacing\[0\]: 0.0 is not between 1e-20 and"),
    ({"spacing": (1.0, math.nan)}, r"spacing\[1\]"),
    ({"contact_modulus": -1.0}, "contact_modulus"),
    ({"load": -1.0}, "^load: -1.0 N is neither 0 nor, on this grid, a number from"),
    ({"load": math.nan}, "load"),
    ({"load": None}, "exactly one"),
    ({"approach": 1.0}, "exactly one"),
    ({"load": None, "approach": math.inf}, "approach"),
    ({"max_pressure": 0.0}, "max_pressure"),
    ({"max_pressure": 1.0, "load": 16.001}, "more than max_pressure"),
    ({"tolerance": 0.0}, "tolerance"),
    ({"on_failure": "ignore"}, "on_failure"),
    ({"initial_pressure": np.ones((3, 3))}, "initial_pressure"),
    ({"initial_pressure": -np.ones((4, 4))}, "initial_pressure"),
    (
        {"gap": [[math.nan]], "spacing": (0.0, -1.0), "contact_modulus": 0.0, "tolerance": 2.0},
        (r"^spacing\[0\]: ", r"^spacing\[1\]: ", "^contact_modulus: ", "^gap: ", "^tolerance: "),
    ),
    *((change, (f"^{words}",)) for change, words in OFF_SCALE + NO_NUMBERS),
)


@pytest.mark.parametrize("modulus", [1e-30, 1e30])
@pytest.mark.parametrize("widths", [(1e-20, 1e-20), (1e20, 1e20), (1e-6, 1e6), (1e6, 1e-6)])
@pytest.mark.parametrize("demand", ["load", "approach"])
@pytest.mark.parametrize("displacement", [1.001e-25, 0.999e25])
def test_numbers_at_the_ends_of_their_ranges_are_solved(modulus, widths, demand, displacement):
    """A flat punch has no scale: its pressures in terms of the largest are the same everywhere."""
    gap, amount = np.zeros((8, 8)), displacement * (widths[1] * modulus if demand == "load" else 1.0)
    found = solve_contact(gap, widths, modulus, warn=False, **{demand: amount}).pressure
    known = solve_contact(gap, (1.0, widths[1] / widths[0]), 1.0, approach=1.0, warn=False).pressure
    assert_allclose(found / found.max(), known / known.max(), rtol=1e-4)  # the tolerance is 1e-6 of the approach


@pytest.mark.parametrize("demand", [{"load": 1.0}, {"load": 1e-15}, {"approach": 1e-3}])
@pytest.mark.parametrize("cap", [1e14, 1e300, math.inf])
def test_cap_that_nothing_can_reach_is_none(demand, cap):
    _, gap, spacing = hertz_problem()
    free, capped = (
        solve_contact(gap, spacing, E_STAR, max_pressure=each, warn=False, **demand).pressure for each in (None, cap)
    )
    assert_allclose(capped, free, rtol=ROUNDING)  # the same steps


def test_numbers_of_numpy_in_no_dimension_are_numbers():
    gap = np.zeros((4, 4))
    found = solve_contact(gap, np.ones(2), np.array(E_STAR), load=np.float32(1.0), threads=np.int64(1), warn=False)
    assert_allclose(found.pressure, solve_contact(gap, (1.0, 1.0), E_STAR, load=1.0, warn=False).pressure)


def test_grid_beyond_memory_is_refused_before_it_is_allocated():
    endless = np.broadcast_to(0.0, (10**7, 10**7))
    with pytest.raises(InputError, match="GiB"):
        solve_contact(endless, (1.0, 1.0), E_STAR, load=1.0)
    assert memory_problem((512, 512), available=2.0**30) is None
    assert "0.0977 GiB" in str(memory_problem((512, 512), available=1.0))


def test_failure_raises_with_the_last_iterate_or_returns_it(monkeypatch):
    monkeypatch.setattr(solver, "MOST_ITERATIONS", 1)
    _, gap, spacing = hertz_problem(curvatures=(0.1, 0.001))
    with pytest.raises(ConvergenceError, match="residual") as caught:
        solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9)
    last = caught.value.last
    assert last.status is ContactStatus.NOT_CONVERGED
    assert last.residual > 1e-9
    assert_allclose(last.pressure.sum() * last.cell_area, LOAD, rtol=ROUNDING)
    returned = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9, on_failure="return")
    assert_allclose(returned.pressure, last.pressure)
    assert pickle.loads(pickle.dumps(caught.value)).last.residual == last.residual  # the same number, written and read


def test_unreachable_tolerance_ends():
    _, gap, spacing = hertz_problem((32, 32))
    with pytest.raises(ConvergenceError):
        solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-18)


def test_contact_at_the_border_warns():
    contact, gap, spacing = hertz_problem()
    with pytest.warns(AccuracyWarning, match="reaches the border of"):
        solution = solve_contact(gap, spacing, E_STAR, load=10.0 * LOAD)
    assert solution.reaches_border
    assert solution.peak_pressure == solution.pressure.max()
    assert contact.max_pressure < solution.peak_pressure


def test_few_cells_across_warn():
    _, gap, spacing = hertz_problem()
    with pytest.warns(AccuracyWarning, match="cells across"):
        solution = solve_contact(gap, spacing, E_STAR, load=1e-3 * LOAD)
    assert min(solution.cells_across) < 8


def test_warnings_can_be_left_to_the_caller():
    _, gap, spacing = hertz_problem()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution = solve_contact(gap, spacing, E_STAR, load=1e-3 * LOAD, warn=False)
    assert len(solution.accuracy_warnings) == 1


def test_solution_is_frozen_short_in_print_and_picklable():
    _, gap, spacing = hertz_problem((32, 32))
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD)
    assert len(repr(solution)) < 200
    with pytest.raises(AttributeError):
        solution.load = 1.0
    copy = pickle.loads(pickle.dumps(solution))
    assert np.array_equal(copy.pressure, solution.pressure)
    assert copy.status is solution.status
    assert copy.error_estimate == solution.error_estimate
