"""What a solution says about itself."""

import dataclasses
import math

import numpy as np
import pytest

from loaded_tca.contact import ContactStatus, solve_contact
from loaded_tca.contact.solution import CoarserGrid

E_STAR = 115e3


def ball(n=40, width=0.02, **options):
    x = (np.arange(n) - (n - 1) / 2) * width
    gap = 0.05 * (x[:, None] ** 2 + x**2)
    return solve_contact(gap, (width, width), E_STAR, **({"load": 50.0, "warn": False} | options))


def test_repr_is_one_short_line():
    text = repr(ball())
    assert text.startswith("ContactSolution(40x40 cells, load 50 N")
    assert "converged" in text
    assert "\n" not in text


def test_status_is_a_sentence_for_the_user():
    assert all(status.value.endswith(".") and " " in status.value for status in ContactStatus)
    assert ball().status is ContactStatus.CONVERGED


def test_cells_across_are_those_under_pressure():
    solution = ball()
    rows, columns = np.nonzero(solution.pressure)
    assert solution.cells_across == (np.ptp(rows) + 1, np.ptp(columns) + 1)
    assert ball(load=0.0).cells_across == (0, 0)


def test_border_and_material_edge_are_told_apart():
    inside, wide = ball(), ball(load=5e4)
    assert not inside.bounded
    assert wide.reaches_border
    assert wide.bounded
    gap = np.zeros((40, 40))
    gap[:5], gap[-5:], gap[:, :5], gap[:, -5:] = (np.inf,) * 4
    punch = solve_contact(gap, (0.1, 0.1), E_STAR, load=10.0)
    assert punch.reaches_material_edge
    assert not punch.reaches_border
    assert punch.accuracy_warnings == ()


def test_peak_of_a_capped_contact_is_the_cap():
    # of cells that are clipped at the cap
    assert ball(max_pressure=500.0).peak_pressure == pytest.approx(500.0, rel=1e-12)


def test_accuracy_warnings_name_both_reasons():
    narrow = solve_contact(np.zeros((3, 30)), (0.1, 0.1), E_STAR, load=1.0, warn=False)
    assert len(narrow.accuracy_warnings) == 2
    assert "reaches the box" in narrow.accuracy_warnings[0]
    assert "3 cells across" in narrow.accuracy_warnings[1]


def test_estimate_grows_to_first_order_at_a_border():
    wide = ball(load=5e4)
    largest = wide.pressure.max()
    estimate = dataclasses.replace(wide, coarser=CoarserGrid(0.9 * largest, wide.approach)).error_estimate
    assert estimate.peak_pressure == pytest.approx(0.1)
    assert estimate.approach == 0.0
    inside = ball()
    coarser = CoarserGrid(0.9 * inside.pressure.max(), inside.approach)
    assert dataclasses.replace(inside, coarser=coarser).error_estimate.peak_pressure == pytest.approx(0.1 / 6.0)


def test_solution_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        ball().approach = 0.0


def test_single_grid_carries_no_estimate():
    assert math.isnan(ball(n=20, width=0.04).error_estimate.approach)
