"""Cases on which contact solvers go wrong, each with its answer; the table of docs/studies/contact_solver.md."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.contact import ContactStatus, solve_contact
from loaded_tca.errors import InputError
from loaded_tca.reference import hertz, punch
from tests.samples.contact_conditions import contact_conditions

ROUNDING = 1e-12
"""Of loads, scaled and added up over some thousand cells, and of closed forms: 1e-15 was seen."""
E_STAR = 115e3
LOAD = 100.0
TOLERANCE = 1e-8


def centred(n, width):
    return (np.arange(n) - (n - 1) / 2) * width


def radius_squared(n, width):
    x = centred(n, width)
    return x[:, None] ** 2 + x**2


def solve(gap, spacing, **options):
    """Solve without warnings and check the contact conditions on the whole grid, apart from the solver."""
    options = {"tolerance": TOLERANCE, "warn": False} | options
    solution = solve_contact(gap, spacing, E_STAR, **options)
    assert solution.status is ContactStatus.CONVERGED
    material = np.where(np.isinf(gap), 1e3 * max(1.0, np.abs(gap[np.isfinite(gap)]).max()), gap)
    assert contact_conditions(solution, material) < 10.0 * options["tolerance"]
    return solution


def curvatures_of_ratio(ratio):
    """Curvatures whose ellipse has the axes 1 : ratio, found from the ratio of a ratio."""
    low, high = 1.0, ratio**2
    for _ in range(100):
        middle = math.sqrt(low * high)
        found = hertz.point_contact(1.0, (1.0, 1.0 / middle), E_STAR).ratio
        low, high = (middle, high) if found < ratio else (low, middle)
    return 0.1, 0.1 / middle


def ellipse(cells, curvatures, load=LOAD, box=3.0):
    contact = hertz.point_contact(load, curvatures, E_STAR)
    spacing = (box * contact.semi_minor / cells[0], box * contact.semi_major / cells[1])
    x, y = centred(cells[0], spacing[0]), centred(cells[1], spacing[1])
    return 0.5 * max(curvatures) * x[:, None] ** 2 + 0.5 * min(curvatures) * y**2, spacing, contact


@pytest.mark.parametrize("ratio", [100.0, 1000.0])
def test_slender_ellipse_on_slender_cells(ratio):
    gap, spacing, contact = ellipse((48, 96), curvatures_of_ratio(ratio))
    solution = solve(gap, spacing, load=LOAD)
    # 32 cells across, 64 along: 6e-4 measured for the largest cell, a third of it for the peak between the cells
    assert_allclose(solution.pressure.max(), contact.max_pressure, rtol=1e-3)
    assert_allclose(solution.peak_pressure, contact.max_pressure, rtol=3e-4)
    assert_allclose(solution.approach, contact.approach, rtol=2e-4)


def test_circle_on_cells_of_aspect_51():
    gap, spacing, contact = ellipse((51 * 24, 24), (0.1, 0.1))
    solution = solve(gap, spacing, load=LOAD, tolerance=1e-6)
    assert_allclose(solution.peak_pressure, contact.max_pressure, rtol=1e-3)
    assert_allclose(solution.approach, contact.approach, rtol=1e-3)  # 16 cells in the coarse direction


def test_tiny_load_on_the_middle_of_four_cells():
    gap, spacing, _ = ellipse((64, 64), (0.1, 0.1))
    solution = solve(gap, spacing, load=1e-9 * LOAD)
    assert_allclose(solution.pressure[31:33, 31:33], 1e-9 * LOAD / (4.0 * spacing[0] * spacing[1]), rtol=1e-6)
    assert np.count_nonzero(solution.pressure) == 4


def test_load_that_fills_the_box():
    gap, spacing, _ = ellipse((64, 64), (0.1, 0.1))
    solution = solve(gap, spacing, load=1e3 * LOAD)
    assert solution.in_contact.all()
    assert "reaches the border of" in solution.accuracy_warnings[0]


def test_cylinder_through_the_box_is_a_line_contact_in_the_middle():
    n, length, height = 128, 40.0, 0.01
    gap = np.repeat(height * centred(n, 10.0 / n)[:, None] ** 2, n, axis=1)
    line = hertz.line_contact(math.pi * E_STAR * height, 2.0 * height, E_STAR)
    solution = solve(gap, (10.0 / n, length / n), load=length * line.line_load)
    middle = solution.pressure[:, n // 2]
    # the ends draw load to themselves: 1515 MPa in the middle instead of 1626 of the endless line
    assert_allclose(middle.max(), 1515.0, rtol=2e-3)
    assert_allclose(np.count_nonzero(middle) * 10.0 / n / 2.0, 1.33, atol=10.0 / n / 2.0)  # half a cell
    assert solution.reaches_border


def test_middle_of_a_long_line_contact_is_hertz_under_its_own_line_load():
    n = 128
    gap = np.repeat(0.01 * centred(n, 4.0 / n)[:, None] ** 2, 64, axis=1)
    solution = solve(gap, (4.0 / n, 400.0 / 64), load=400.0 * 1000.0)
    middle = solution.pressure[:, 32]
    line = hertz.line_contact(middle.sum() * 4.0 / n, 0.02, E_STAR)
    # 30 cells across: 3e-4 by the table of errors, and the half width over the distance to the ends, squared
    assert_allclose(middle.max(), line.max_pressure, rtol=1e-3)


def test_two_patches_share_the_load():
    width = 6.0 / 512
    x, y = centred(512, width)[:, None], centred(256, width)
    gap = np.minimum((x - 1.5) ** 2 + y**2, (x + 1.5) ** 2 + y**2 + 0.3e-3 * 50.0) / 50.0
    solution = solve(gap, (width, width), load=60.0, tolerance=1e-6)
    first, second = solution.pressure[256:], solution.pressure[:256]
    # the answers are known to their last digit; half a thousandth is what 35 and 31 cells across allow
    assert_allclose(first.sum() / solution.pressure.sum(), 0.60094, rtol=5e-4)
    assert_allclose([first.max(), second.max()], [528.4, 461.0], rtol=2e-3)
    assert_allclose(solution.approach, 1.3246e-3, rtol=5e-4)


@pytest.mark.parametrize(("coefficient", "exponent", "error"), [(1e-3, 8.0, 2e-4), (0.01, 1.0, 1e-4)])
def test_profiles_of_revolution(coefficient, exponent, error):
    reference = punch.power_law(1.0, coefficient, exponent, E_STAR)
    width = 3.0 / 128
    gap = coefficient * radius_squared(128, width) ** (exponent / 2.0)
    solution = solve(gap, (width, width), load=reference.load)
    assert_allclose(solution.approach, reference.approach, rtol=error)
    # counting cells leaves the edge uncertain by less than half of one; the radius has 43
    assert_allclose(math.sqrt(solution.contact_area / math.pi), 1.0, rtol=0.01)


@pytest.mark.parametrize("outside", [math.inf, 1e30, 1.0])
def test_flat_circular_punch_converges_at_first_order(outside):
    errors = []
    for n in (64, 128):
        gap = np.where(radius_squared(n, 3.0 / n) < 1.0, 0.0, outside)
        solution = solve(gap, (3.0 / n, 3.0 / n), load=LOAD)
        assert not solution.pressure[gap > 0.0].any()
        area = np.count_nonzero(gap == 0.0) * solution.cell_area
        reference = punch.flat_circular(LOAD, math.sqrt(area / math.pi), E_STAR)
        errors.append(abs(solution.approach / reference.approach - 1.0))
    assert errors[1] < 3e-3
    assert errors[1] < 0.75 * errors[0]


def test_flat_square_punch_that_fills_the_box():
    approach = []
    for n in (64, 128):
        approach.append(solve(np.zeros((n, n)), (1.0 / n, 1.0 / n), load=LOAD).approach)
    extrapolated = 1.0 / (2.0 / approach[1] - 1.0 / approach[0])  # of the stiffness, first order
    assert_allclose(LOAD / (E_STAR * extrapolated), punch.SQUARE_PUNCH, rtol=1e-4)


@pytest.mark.parametrize("offset", [1e6, -1e6])
def test_large_offset_of_the_gap(offset):
    gap, spacing, _ = ellipse((64, 64), (0.1, 0.1))
    plain, shifted = (solve(gap + shift, spacing, load=LOAD, tolerance=1e-6) for shift in (0.0, offset))
    # the sum keeps ten digits of 1e-6 mm: 1e-10 mm of an approach of 3.5e-3 mm
    assert_allclose(shifted.pressure, plain.pressure, atol=1e-5 * plain.pressure.max())
    assert shifted.approach == pytest.approx(offset + plain.approach, abs=1e-9)


@pytest.mark.parametrize("place", [(30, 30), (0, 0), (63, 10)])
def test_start_from_a_single_cell(place):
    gap, spacing, contact = ellipse((64, 64), (0.1, 0.1))
    start = np.zeros_like(gap)
    start[place] = 1.0
    solution = solve(gap, spacing, load=LOAD, initial_pressure=start)
    assert_allclose(solution.peak_pressure, contact.max_pressure, rtol=3e-4)


def test_start_where_there_is_no_material():
    gap, spacing, _ = ellipse((64, 64), (0.1, 0.1))
    gap[:20] = np.inf
    start = np.zeros_like(gap)
    start[5, 5] = 1.0
    plain = solve(gap, spacing, load=LOAD)
    assert_allclose(solve(gap, spacing, load=LOAD, initial_pressure=start).approach, plain.approach, rtol=1e-6)


def test_metres_and_pascals_give_the_same_numbers():
    gap, spacing, _ = ellipse((48, 48), (0.1, 0.03))
    one = solve(gap, spacing, load=LOAD)
    other = solve_contact(gap / 1e3, (spacing[0] / 1e3, spacing[1] / 1e3), E_STAR * 1e6, load=LOAD, tolerance=TOLERANCE)
    assert_allclose(other.pressure / 1e6, one.pressure, atol=1e-6 * one.pressure.max())
    assert other.iterations == one.iterations


@pytest.mark.parametrize("share", [0.9, 0.5, 0.3])
def test_cap_on_the_pressure_is_met_exactly(share):
    gap, spacing, contact = ellipse((64, 64), (0.1, 0.1))
    cap = share * contact.max_pressure
    solution = solve(gap, spacing, load=LOAD, max_pressure=cap)
    assert solution.pressure.max() == pytest.approx(cap, rel=1e-15)  # clipped at the cap
    assert_allclose(solution.pressure.sum() * solution.cell_area, LOAD, rtol=ROUNDING)


@pytest.mark.parametrize("filled", [0.9, 0.99, 0.9999])
def test_cap_nearly_filled(filled):
    gap, spacing, _ = ellipse((64, 64), (0.1, 0.1))
    area = gap.size * spacing[0] * spacing[1]
    solution = solve(gap, spacing, load=filled * area * 100.0, max_pressure=100.0)
    assert_allclose(solution.pressure.mean(), filled * 100.0, rtol=ROUNDING)


@pytest.mark.parametrize("load", [1e-3, 1.0, 1e3])
def test_cap_that_fills_a_whole_number_of_cells(load, rng):
    """Every cell is at a bound but for rounding: no cell between the bounds to read the approach from."""
    gap = 1e-3 * rng.random((30, 26))
    solution = solve(gap, (0.01, 0.01), load=load, max_pressure=load / (546 * 1e-4), tolerance=1e-6)
    assert_allclose(solution.pressure.sum() * solution.cell_area, load, rtol=ROUNDING)


def test_cap_overfilled_is_refused():
    gap, spacing, _ = ellipse((64, 64), (0.1, 0.1))
    area = gap.size * spacing[0] * spacing[1]
    with pytest.raises(InputError, match="more than max_pressure"):
        solve(gap, spacing, load=1.0001 * area * 100.0, max_pressure=100.0)


def rough(rng, n, height, roll_off=1.8):
    """Surface of random heights with a power-law spectrum, of the root mean square height given."""
    frequency = np.fft.fftfreq(n) * n
    wave = np.hypot(frequency[:, None], frequency)
    wave[0, 0] = np.inf
    surface = np.fft.ifft2(np.fft.fft2(rng.standard_normal((n, n))) * wave**-roll_off).real
    return height * surface / surface.std()


@pytest.mark.parametrize("load", [1.0, 100.0, 1e4])
@pytest.mark.parametrize("crown", [0.0, 0.05])
def test_rough_surface(load, crown, rng):
    n = 128
    gap = rough(rng, n, 1e-3) + crown * radius_squared(n, 4.0 / n)
    solution = solve(gap, (4.0 / n, 4.0 / n), load=load)
    assert_allclose(solution.pressure.sum() * solution.cell_area, load, rtol=ROUNDING)


def test_far_asperity_of_one_cell_is_found():
    """It is blurred away on every coarse grid and lies outside the window around the contact."""
    gap, spacing, _ = ellipse((256, 256), (0.1, 0.1), box=6.0)
    gap[5, 5] = -2e-4
    solution = solve(gap, spacing, load=LOAD)
    assert solution.pressure[5, 5] > 0.0


def test_contact_of_a_single_cell():
    gap = np.full((20, 20), np.inf)
    gap[7, 8] = 0.3
    solution = solve(gap, (0.1, 0.1), load=LOAD)
    assert_allclose(solution.pressure[7, 8], LOAD / 0.01, rtol=ROUNDING)
    # Love's coefficient of a square on its own centre
    own = 4.0 * math.log(1.0 + math.sqrt(2.0)) / math.pi * 0.1 / E_STAR
    assert_allclose(solution.approach, 0.3 + own * LOAD / 0.01, rtol=ROUNDING)


@pytest.mark.parametrize("n", [1, 2, 3, 15, 64, 200])
def test_grids_of_one_row(n):
    gap = 0.05 * centred(n, 0.02)[None, :] ** 2
    one = solve(gap, (0.01, 0.02), load=1.0)
    other = solve(gap.T, (0.02, 0.01), load=1.0)
    assert_allclose(one.pressure, other.pressure.T, rtol=1e-5, atol=1e-6 * one.pressure.max())


@pytest.mark.thorough
@given(
    seed=st.integers(0, 2**32 - 1),
    shape=st.tuples(st.integers(1, 50), st.integers(1, 50)),
    aspect=st.sampled_from([0.01, 0.3, 1.0, 7.0, 1000.0]),
    load=st.floats(-3.0, 6.0).map(lambda power: 10.0**power),
    void=st.sampled_from([0.0, 0.3]),
    fill=st.sampled_from([None, 0.1, 0.7]),
)
@example(seed=0, shape=(3, 5), aspect=1.0, load=10.0**3.796875, void=0.3, fill=0.7)
@settings(max_examples=60)
def test_contact_conditions_hold_on_random_surfaces(seed, shape, aspect, load, void, fill):
    """White noise with holes: the roughest surface there is, any shape, load and cell."""
    rng = np.random.default_rng(seed)
    gap = 1e-3 * rng.random(shape)
    gap[rng.random(shape) < void] = np.inf
    gap.flat[rng.integers(gap.size)] = 0.0
    cap = None if fill is None else load / (fill * np.count_nonzero(np.isfinite(gap)) * 1e-4 * aspect)
    solution = solve(gap, (0.01, 0.01 * aspect), load=load, max_pressure=cap, tolerance=1e-6)
    assert_allclose(solution.pressure.sum() * solution.cell_area, load, rtol=ROUNDING)
    assert not solution.pressure[np.isinf(gap)].any()


@given(power=st.floats(-6.0, 6.0))
@settings(max_examples=20)
def test_pressure_grows_with_the_cube_root_of_the_load(power):
    load = 10.0**power
    gap, spacing, contact = ellipse((32, 40), (0.1, 0.04), load=load)
    solution = solve(gap, spacing, load=load, tolerance=1e-6)
    unit_gap, unit_spacing, unit = ellipse((32, 40), (0.1, 0.04), load=1.0)
    unit_solution = solve(unit_gap, unit_spacing, load=1.0, tolerance=1e-6)
    # the same grid but for its scale: equal up to the tolerance, which leaves 1e-5 of the peak
    assert_allclose(solution.peak_pressure / load ** (1 / 3), unit_solution.peak_pressure, rtol=1e-5)
    assert_allclose(contact.max_pressure / load ** (1 / 3), unit.max_pressure, rtol=ROUNDING)


@given(seed=st.integers(0, 2**32 - 1), load=st.floats(0.1, 1e4))
@settings(max_examples=20)
def test_load_and_approach_are_inverse_on_rough_surfaces(seed, load):
    gap = rough(np.random.default_rng(seed), 32, 1e-3)
    by_load = solve(gap, (0.05, 0.05), load=load)
    by_approach = solve(gap, (0.05, 0.05), approach=by_load.approach)
    assert_allclose(by_approach.load, load, rtol=1e-5)
    assert_allclose(by_approach.pressure, by_load.pressure, atol=1e-4 * by_load.pressure.max())
