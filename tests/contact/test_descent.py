"""The projected conjugate gradients on one grid: projections, judgement, and the monotone descent."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.contact import descent, levels
from loaded_tca.contact.convolution import Convolution
from loaded_tca.contact.descent import Descent, dots, judge
from loaded_tca.contact.grid import Grids, each, shifted_to_sum
from loaded_tca.reference import hertz


def one_grid(gap, total=np.nan, cap=np.inf, approach=0.0):
    return Grids(gap[None], np.ones((1, 2)), *(each([value]) for value in (total, approach, cap)))


def paraboloid(n=24, total=1.0, cap=np.inf, approach=0.0):
    x = (np.arange(n) - (n - 1) / 2) / n
    return one_grid(x[:, None] ** 2 + x**2, total, cap, approach)


def evenly(grids):
    """Pressure of the right sum, the same everywhere."""
    return np.full(grids.gap.shape, np.nan_to_num(grids.total) / grids.gap.size)


def run(search, tolerance, limit):
    search.run(np.array([tolerance]), np.array([limit]))
    return float(search.residual[0])


def displaced(grids, pressure):
    return Convolution(grids.shape, grids.aspects)(pressure, np.empty(pressure.shape))


def energy(grids, pressure):
    level = grids.gap if grids.loaded else grids.gap - grids.approach[0]
    return float((pressure * (0.5 * displaced(grids, pressure) + level)).sum())


@given(
    values=st.lists(st.floats(-10.0, 10.0), min_size=1, max_size=40),
    cap=st.floats(0.1, 5.0),
    fill=st.floats(0.001, 0.999),
)
def test_projection_is_the_nearest_point(values, cap, fill):
    """Bounds and sum hold, and p - values is one constant where p is between the bounds: the conditions of it."""
    values = np.array(values)
    total = fill * cap * values.size
    everywhere = np.ones((1, 1, values.size), dtype=bool)
    projected = shifted_to_sum(values[None, None], each([total]), np.where(everywhere, cap, 0.0), everywhere)[0, 0]
    assert projected.min() >= 0.0
    assert projected.max() <= cap
    # the values and a level of up to 40 of them are added up: 1e-16 of their sum was seen
    assert_allclose(projected.sum(), total, rtol=1e-12, atol=1e-14 * np.abs(values).sum())
    shift = values - projected
    inner = (projected > 0.0) & (projected < cap)
    if inner.any():
        level = shift[inner].mean()
        assert_allclose(shift[inner], level, atol=1e-12)  # 1e-12, also below: rounding of values up to 10
        assert (shift[projected == 0.0] <= level + 1e-12).all()
        assert (shift[projected == cap] >= level - 1e-12).all()


def test_energy_never_rises():
    for grids in (paraboloid(total=0.3), paraboloid(total=0.3, cap=0.002), paraboloid(total=np.nan, approach=0.1)):
        energies = [energy(grids, evenly(grids))]
        for steps in range(1, 13):
            search = Descent(grids, evenly(grids))
            run(search, 0.0, steps)
            energies.append(energy(grids, search.pressure))
        # single precision of the steps is all that may show
        assert (np.diff(energies) <= 1e-6 * abs(energies[-1])).all()


def test_run_stops_at_the_limit():
    grids = paraboloid()
    search = Descent(grids, evenly(grids))
    assert run(search, 1e-9, 2) > 1e-9
    assert search.iterations == [2]
    on = Descent(grids, search.pressure)
    assert run(on, 1e-9, 100) <= 1e-9
    assert on.convolutions[0] > on.iterations[0]


def test_judgement_of_a_penetrating_start():
    grids = paraboloid(n=4)
    pressure = np.zeros((1, 4, 4))
    pressure[0, 0, 0] = 1.0
    excess = displaced(grids, pressure) + grids.gap
    state = judge(grids, pressure, excess)
    assert state.free[0, 0, 0]
    assert state.free.sum() > 1
    assert state.residual[0] == pytest.approx(-excess.min() / state.approach[0])


def test_judgement_with_every_cell_at_a_bound():
    """Any approach between the two limits is right; nothing is violated."""
    grids = one_grid(np.array([[0.0, 5.0]]), total=1.0, cap=1.0)
    pressure = np.array([[[1.0, 0.0]]])
    level = displaced(grids, pressure) + grids.gap
    low, high = level[0, 0]
    state = judge(grids, pressure, level)
    assert low <= state.approach[0] <= high
    assert state.residual[0] == 0.0


@pytest.mark.parametrize("cap", [np.inf, 0.003])
def test_judgement_in_parts_is_that_in_one(monkeypatch, cap):
    grids = paraboloid(total=0.5, cap=cap)
    pressure = grids.settled(np.maximum(0.1 - grids.gap, 0.0))
    excess = displaced(grids, pressure) + grids.gap
    whole = judge(grids, pressure, excess.copy())
    for module in (descent, levels):
        monkeypatch.setattr(module, "PART_CELLS", 5 * grids.shape[1])  # 24 rows: the last part is shorter
    parts = judge(grids, pressure, excess.copy())
    assert (parts.free == whole.free).all()
    assert whole.free.any()
    for name in ("approach", "residual"):  # sums of 576 cells in another order
        assert_allclose(getattr(parts, name), getattr(whole, name), rtol=1e-12)


def test_settled_pressure_has_the_sum_and_keeps_the_cap():
    for cap in (np.inf, 0.003):
        grids = paraboloid(total=0.5, cap=cap)
        search = Descent(grids, evenly(grids))
        run(search, 1e-6, 50)
        settled = grids.settled(search.pressure)
        assert_allclose(settled.sum(), 0.5, rtol=1e-14)  # scaled to it: the same number was seen
        assert settled.max() <= cap


def test_scalar_products_are_those_of_each_problem(rng):
    one, other = rng.random((2, 5, 20, 30))
    # sums of 600 products: 4e-16 seen
    assert_allclose(dots(one, other)[:, 0, 0], (one * other).sum(axis=(1, 2)), rtol=1e-12)


def test_next_to_no_pressure_over_an_open_gap_is_dropped():
    """Its share in the energy is below the rounding of single precision: no step would find it."""
    grids = paraboloid(total=0.1)
    found = Descent(grids, evenly(grids))
    run(found, 1e-6, 50)
    first = np.array([0])
    assert found._now[0, 0, 0] == 0.0
    assert not found._drop_dust(first).any()
    found._now[0, 0, 0] = 1e-10 * found._now.max()
    assert found._drop_dust(first).all()
    assert found._now[0, 0, 0] == 0.0


@pytest.mark.parametrize("total", [0.3, 1.0, 3.0])
def test_guess_for_a_sphere_is_near_hertz(total):
    """Off by no more than the cells at the edge; an even start is off by most of the peak."""
    grids = paraboloid(total=total)
    guess, contact = grids.guess()[0], hertz.point_contact(total, (2.0 / 24**2,) * 2, 1.0)
    x = np.arange(24) - 11.5
    assert_allclose(guess, contact.pressure(x[:, None], x), atol=0.15 * contact.max_pressure)
    assert_allclose(guess.max(), contact.max_pressure, rtol=0.03)
    assert_allclose(guess.sum(), total)


def test_guess_under_a_given_approach_is_no_pressure():
    assert not paraboloid(total=np.nan, approach=0.1).guess().any()


def test_guess_presses_where_nothing_else_is_said():
    """Where not one cell closes under so small a load, the lowest ones carry it."""
    guess = paraboloid(total=1e-9).guess()[0]
    assert_allclose(guess.sum(), 1e-9)
    assert guess[11:13, 11:13].min() > 0.0
