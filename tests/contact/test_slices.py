"""Bending beneath the half-spaces, slice by slice: limits, symmetry, equivalence with a gap that bends, energy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import ContactProblem, solve_contact, solve_to_accuracy
from loaded_tca.contact.edges import FreeEdge
from loaded_tca.contact.levels import merged
from loaded_tca.contact.solver import contact_stiffness
from tests.refusals import refusals

E_STAR = 113e3
LOAD = 2000.0
TOLERANCE = 1e-9
BOX = (0.25, 10.0)
"""Half lengths [mm] of a box around a slender contact of some 12 mm."""


def slender(cells):
    """Gap of radii 10 mm across and 2.5 m along, and the spacing."""
    x, y = ((np.arange(n) + 0.5) * 2.0 * half / n - half for n, half in zip(cells, BOX, strict=True))
    return x[:, None] ** 2 / 20.0 + y**2 / 5e3, tuple(2.0 * half / n for n, half in zip(cells, BOX, strict=True))


def spread(cells, stiff=4e-6, length=3.0):
    """Compliance of slices that bend less, the further they are apart."""
    y = (np.arange(cells[1]) + 0.5) * 2.0 * BOX[1] / cells[1]
    return stiff * np.exp(-np.abs(y[:, None] - y) / length)


def solve(cells=(32, 48), slices=None, **options):
    gap, spacing = slender(cells)
    return solve_contact(
        gap, spacing, E_STAR, load=LOAD, tolerance=TOLERANCE, slice_compliance=slices, warn=False, **options
    )


def test_rigid_slices_change_nothing():
    plain, rigid = solve(), solve(slices=np.zeros((48, 48)))
    assert_allclose(rigid.pressure, plain.pressure, atol=1e-7 * plain.peak_pressure)
    assert_allclose(rigid.approach, plain.approach, rtol=1e-9)


def test_slices_that_all_move_alike_only_add_to_the_approach():
    plain, moved = solve(), solve(slices=np.full((48, 48), 3e-6))
    assert_allclose(moved.pressure, plain.pressure, atol=1e-6 * plain.peak_pressure)
    assert_allclose(moved.approach, plain.approach + 3e-6 * LOAD, rtol=1e-8)


@pytest.mark.parametrize("cells", [(32, 48), (33, 51), (64, 128)])
def test_bending_is_that_of_a_gap_which_bends_as_much(cells):
    """Half-spaces alone, over the gap that the bending leaves, have the same answer."""
    slices = spread(cells)
    bent = solve(cells, slices)
    gap, spacing = slender(cells)
    bending = slices @ bent.pressure.sum(axis=0) * bent.cell_area
    plain = solve_contact(gap + bending, spacing, E_STAR, load=LOAD, tolerance=TOLERANCE, warn=False)
    assert_allclose(plain.pressure, bent.pressure, atol=1e-5 * bent.peak_pressure)
    assert_allclose(plain.approach, bent.approach, rtol=1e-7)
    assert_allclose(bent.gap, plain.gap, atol=1e-6 * bent.approach)


def test_bending_spreads_the_load():
    """A slice moves most under its own force: the middle gives way, and the ends come to bear."""
    bent, plain = solve(slices=spread((32, 48))), solve()
    assert bent.pressure.max() < 0.95 * plain.pressure.max()
    assert bent.cells_across[1] > plain.cells_across[1]
    assert not bent.reaches_border


def test_symmetric_slices_keep_the_pressure_symmetric():
    pressure = solve(slices=spread((32, 48))).pressure
    assert_allclose(pressure, pressure[::-1, ::-1], atol=1e-6 * pressure.max())


def test_stiffness_is_the_slope_of_the_load():
    slices = spread((32, 48))
    gap, spacing = slender((32, 48))
    here = solve(slices=slices)
    step = 1e-5 * here.approach
    loads = [
        solve_contact(
            gap, spacing, E_STAR, approach=here.approach + s, tolerance=1e-10, slice_compliance=slices, warn=False
        ).load
        for s in (-step, step)
    ]
    assert_allclose(contact_stiffness(here), (loads[1] - loads[0]) / (2.0 * step), rtol=1e-4)
    assert contact_stiffness(here) < contact_stiffness(solve())


def test_prescribed_approach_and_cap_know_of_the_slices():
    slices = spread((32, 48))
    gap, spacing = slender((32, 48))
    free = solve(slices=slices)
    back = solve_contact(
        gap, spacing, E_STAR, approach=free.approach, tolerance=TOLERANCE, slice_compliance=slices, warn=False
    )
    assert_allclose(back.load, LOAD, rtol=1e-6)
    capped = solve(slices=slices, max_pressure=0.7 * free.pressure.max())
    assert_allclose(capped.pressure.max(), 0.7 * free.pressure.max())
    assert_allclose(capped.pressure.sum() * capped.cell_area, LOAD, rtol=1e-9)
    assert capped.approach > free.approach


def test_slices_go_with_free_edges():
    edges = (FreeEdge(1, 2.0, "above", 1.7),)
    slices = spread((32, 48))
    bent = solve(slices=slices, free_edges=edges)
    assert (bent.pressure[:, :6] == 0.0).all()
    gap, spacing = slender((32, 48))
    bending = slices @ bent.pressure.sum(axis=0) * bent.cell_area
    plain = solve_contact(gap + bending, spacing, E_STAR, load=LOAD, tolerance=TOLERANCE, free_edges=edges, warn=False)
    assert_allclose(plain.pressure, bent.pressure, atol=1e-5 * bent.pressure.max())


def test_grid_is_refined_with_its_slices():
    """Finer and finer grids, each with its own slices, end where one fine grid does."""

    def problem(cells):
        return ContactProblem(*slender(cells), E_STAR, load=LOAD, slice_compliance=spread(cells))

    adaptive = solve_to_accuracy(problem, accuracy=2e-3, warn=False)
    fine = solve((128, 256), spread((128, 256)))
    assert len(adaptive.problem.slice_compliance) == adaptive.pressure.shape[1]
    assert_allclose(adaptive.peak_pressure, fine.peak_pressure, rtol=2e-3)
    assert_allclose(adaptive.approach, fine.approach, rtol=2e-3)


@pytest.mark.parametrize("count", [48, 49])
def test_merged_slices_have_the_mean_of_both(count):
    slices = spread((1, count))
    means = merged(slices, (2, 2))
    assert means.shape == (-(-count // 2),) * 2
    assert_allclose(means[3, 5], slices[6:8, 10:12].mean())
    assert_allclose(means[-1, -1], slices[-1, -1] if count % 2 else slices[-2:, -2:].mean())
    assert_allclose(means, means.T)


test_slices_that_fit_no_grid_are_refused = refusals(
    lambda slices: solve(slices=slices),
    (np.zeros((3, 3)), r"^slice_compliance: shape \(48, 48\) is needed, not \(3, 3\)$"),
    (np.full((48, 48), np.nan), "^slice_compliance: 2304 values are not finite$"),
    (np.ma.masked_greater(np.eye(48), 0.0), "^slice_compliance: a masked array"),
    ("soft", "^slice_compliance: an array of finite numbers is asked for, not 'soft'$"),
    (np.triu(np.ones((48, 48))), "slice_compliance: is not symmetric"),
)
