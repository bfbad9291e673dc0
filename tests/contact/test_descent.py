"""The projected conjugate gradients on one grid: projections, judgement, and the monotone descent."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.contact import descent
from loaded_tca.contact.convolution import Convolution
from loaded_tca.contact.descent import Descent, judge
from loaded_tca.contact.grid import Grid, shifted_to_sum


def paraboloid(n=24, total=1.0, cap=np.inf, approach=0.0):
    x = (np.arange(n) - (n - 1) / 2) / n
    return Grid(x[:, None] ** 2 + x**2, (1.0, 1.0), total, approach, cap)


def energy(grid, pressure):
    image = Convolution(grid.gap.shape, grid.aspect)(pressure, np.empty(grid.gap.shape))
    level = grid.gap if grid.total is not None else grid.gap - grid.approach
    return float((pressure * (0.5 * image + level)).sum())


@given(
    values=st.lists(st.floats(-10.0, 10.0), min_size=1, max_size=40),
    cap=st.floats(0.1, 5.0),
    fill=st.floats(0.001, 0.999),
)
def test_projection_is_the_nearest_point(values, cap, fill):
    """Bounds and sum hold, and p - values is one constant where p is between the bounds: the conditions of it."""
    values = np.array(values)
    total = fill * cap * values.size
    projected = shifted_to_sum(values, total, cap)
    assert projected.min() >= 0.0
    assert projected.max() <= cap
    assert_allclose(projected.sum(), total, rtol=1e-12, atol=1e-15 * np.abs(values).sum())
    shift = values - projected
    inner = (projected > 0.0) & (projected < cap)
    if inner.any():
        level = shift[inner].mean()
        assert_allclose(shift[inner], level, atol=1e-12)
        assert (shift[projected == 0.0] <= level + 1e-12).all()
        assert (shift[projected == cap] >= level - 1e-12).all()


def test_energy_never_rises():
    for grid in (paraboloid(total=0.3), paraboloid(total=0.3, cap=0.002), paraboloid(total=None, approach=0.1)):
        start = np.zeros(grid.gap.shape)
        if grid.total is not None:
            start[:] = grid.total / start.size
        search = Descent(grid, start)
        energies = [energy(grid, start)]
        for _ in range(12):
            search.run(0.0, 1)
            energies.append(energy(grid, search.pressure))
        # single precision of the steps is all that may show
        assert (np.diff(energies) <= 1e-6 * abs(energies[-1])).all()


def test_run_stops_at_the_limit_and_goes_on():
    search = Descent(paraboloid(), np.full((24, 24), 1.0 / 576))
    first = search.run(1e-9, 2)
    assert search.iterations == 2
    assert first.residual > 1e-9
    assert search.run(1e-9, 100).residual <= 1e-9
    assert search.convolutions > search.iterations
    assert Descent(paraboloid(), np.full((24, 24), 1.0 / 576)).convolutions == 1


def test_judgement_of_a_penetrating_start():
    grid = paraboloid(n=4)
    pressure = np.zeros((4, 4))
    pressure[0, 0] = 1.0
    excess = Convolution((4, 4), 1.0)(pressure, np.empty((4, 4))) + grid.gap
    state = judge(grid, pressure, excess)
    assert state.free[0, 0]
    assert state.free.sum() > 1
    assert state.residual == pytest.approx(-excess.min() / state.approach)


def test_judgement_with_every_cell_at_a_bound():
    """Any approach between the two limits is right; nothing is violated."""
    grid = Grid(np.array([[0.0, 5.0]]), (1.0, 1.0), 1.0, 0.0, 1.0)
    pressure = np.array([[1.0, 0.0]])
    level = Convolution((1, 2), 1.0)(pressure, np.empty((1, 2))) + grid.gap
    low, high = level[0]
    state = judge(grid, pressure, level)
    assert low <= state.approach <= high
    assert state.residual == 0.0


def test_settled_pressure_has_the_sum_and_keeps_the_cap():
    for cap in (np.inf, 0.003):
        grid = paraboloid(total=0.5, cap=cap)
        search = Descent(grid, np.full((24, 24), 0.5 / 576))
        search.run(1e-6, 50)
        settled = search.settle()
        assert_allclose(settled.sum(), 0.5, rtol=1e-14)
        assert settled.max() <= cap


def test_scalar_product_is_the_same_with_and_without_blas(rng):
    small, large = (rng.random((2, n, n)) for n in (20, 200))
    for one, other in (small, large):
        assert_allclose(descent.dot(one, other), (one * other).sum(), rtol=1e-12)


def test_next_to_no_pressure_over_an_open_gap_is_dropped():
    """Its share in the energy is below the rounding of single precision: no step would find it."""
    grid = paraboloid(total=0.1)
    found = Descent(grid, np.full(grid.gap.shape, 0.1 / grid.gap.size))
    found.run(1e-6, 50)
    assert found.pressure[0, 0] == 0.0
    assert not found._drop_dust()
    found.pressure[0, 0] = 1e-10 * found.pressure.max()
    assert found._drop_dust()
    assert found.pressure[0, 0] == 0.0
