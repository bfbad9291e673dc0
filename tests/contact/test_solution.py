"""What a solution says about itself."""

import dataclasses
import math

import numpy as np
import pytest

from loaded_tca.contact import ContactStatus, solve_contact
from loaded_tca.contact.levels import prolong
from loaded_tca.contact.solution import CoarserGrid
from loaded_tca.errors import AccuracyWarning

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
    with pytest.warns(AccuracyWarning, match="reaches an end of the material, where the pressure has no limit"):
        punch = solve_contact(gap, (0.1, 0.1), E_STAR, load=10.0)
    assert punch.reaches_material_edge
    assert not punch.reaches_border
    assert len(punch.accuracy_warnings) == 1
    assert solve_contact(gap, (0.1, 0.1), E_STAR, load=10.0, max_pressure=50.0).accuracy_warnings == ()


def test_peak_of_a_capped_contact_is_the_cap():
    # of cells that are clipped at the cap
    assert ball(max_pressure=500.0).peak_pressure == pytest.approx(500.0, rel=1e-12)


def test_accuracy_warnings_name_both_reasons():
    narrow = solve_contact(np.zeros((3, 30)), (0.1, 0.1), E_STAR, load=1.0, warn=False)
    assert len(narrow.accuracy_warnings) == 2
    assert "reaches the border of" in narrow.accuracy_warnings[0]
    assert "3 cells across" in narrow.accuracy_warnings[1]


def with_coarser(solution, factor):
    """The solution beside one on a grid half as fine with so many times its pressures, and the same approach."""
    pairs = solution.pressure.reshape(solution.pressure.shape[0] // 2, 2, -1, 2)
    return dataclasses.replace(solution, coarser=CoarserGrid(factor * pairs.mean(axis=(1, 3)), solution.pressure, 0.0))


def test_estimate_grows_to_first_order_at_a_border():
    wide = ball(load=5e4)
    assert wide.bounded
    coarser = CoarserGrid(0.9 * wide.pressure[::2, ::2], 0.9 * wide.pressure / wide.pressure[::2, ::2].max(), 0.25)
    estimate = dataclasses.replace(wide, coarser=coarser).error_estimate
    change = wide.pressure.max() / wide.pressure[::2, ::2].max() ** 2 - 1.0
    assert estimate.peak_pressure == estimate.second_order == pytest.approx(abs(change))
    assert estimate.approach == 0.25


def test_estimates_of_a_smooth_peak_are_parts_of_its_change():
    """All pressures are a tenth lower on the coarser grid: half and a third of that."""
    estimate = with_coarser(ball(), 0.9).error_estimate
    # of 40 x 40 cells, on which the top of a circle is level to 1 %
    assert estimate.peak_pressure == pytest.approx(0.05, abs=0.005)
    assert estimate.second_order == pytest.approx(0.1 / 3.0, abs=0.003)


def test_estimate_sees_a_change_beside_a_peak_that_stays():
    inside = ball()
    level = with_coarser(inside, 1.0)
    row = int(inside.pressure.max(axis=1).argmax()) // 2
    tilted = level.coarser.pressure.copy()
    tilted[row - 1] *= 0.8
    estimate = dataclasses.replace(inside, coarser=dataclasses.replace(level.coarser, pressure=tilted)).error_estimate
    # five parts in 32 of the square of that row are in the cells beside the peak
    assert estimate.peak_pressure == pytest.approx(0.5 * 0.5 * (1.0 - 0.8**2) * 5.0 / 32.0, rel=0.1)
    assert estimate.second_order < 0.4 * estimate.peak_pressure


def test_estimate_remembers_the_change_before_two_grids_that_agree():
    inside = ball()
    coarser = dataclasses.replace(with_coarser(inside, 1.0).coarser, change_before=0.2)
    estimate = dataclasses.replace(inside, coarser=coarser).error_estimate
    assert estimate.peak_pressure == pytest.approx(0.15 * 0.2)
    assert estimate.second_order < 0.5 * estimate.peak_pressure


@pytest.mark.parametrize("slope", [0.0, 0.4, -0.4])
def test_change_beside_a_peak_is_that_of_whole_grids(slope):
    """A contact that is three coarse cells wide, and runs across its grid askew: its ends are beside the peak."""
    across, along = (np.arange(n) - (n - 1) / 2 for n in (24, 28))
    coarse = np.sqrt(np.maximum(1.0 - ((across[:, None] - slope * along) / 1.7) ** 2 - (along / 11.0) ** 2, 0.0))
    fine = np.sqrt(prolong(coarse, (48, 56), (2, 2)) * np.random.default_rng(3).uniform(0.9, 1.1, (48, 56)))
    changes = np.abs(prolong(coarse, fine.shape, (2, 2)) - fine)
    row, column = np.unravel_index(fine.argmax(), fine.shape)
    largest = changes[row - 1 : row + 2, column - 1 : column + 2].max() / fine.max()
    assert CoarserGrid(coarse, fine, 0.0).change_beside_peak == largest


def test_peak_at_the_cap_has_the_least_error():
    capped = ball(max_pressure=500.0)
    estimate = with_coarser(capped, 1.0).error_estimate
    assert estimate.peak_pressure == 0.6 / min(capped.cells_across) ** 2


def noisy_ball(amplitude):
    """A ball on a surface whose every cell has a height of its own."""
    x = (np.arange(128) - 63.5) * 0.6 / 128
    return (x[:, None] ** 2 + x**2) / 20.0 + amplitude * np.random.default_rng(7).standard_normal((128, 128))


def test_peak_that_two_grids_do_not_agree_on_is_warned_of():
    """Heights of single cells: averaged over four cells they halve, and with them the peak pressure far above Hertz."""
    gap, spacing = noisy_ball(2e-4), (0.6 / 128, 0.6 / 128)
    with pytest.warns(AccuracyWarning, match=r"estimated error of the peak pressure is \d+ %, above 3 %"):
        rough = solve_contact(gap, spacing, E_STAR, load=100.0)
    halved = solve_contact(gap.reshape(64, 2, 64, 2).mean(axis=(1, 3)), (0.6 / 64,) * 2, E_STAR, load=100.0, warn=False)
    assert halved.peak_pressure < 0.75 * rough.peak_pressure
    assert solve_contact(noisy_ball(0.0), spacing, E_STAR, load=100.0).accuracy_warnings == ()
    capped = solve_contact(gap, spacing, E_STAR, load=100.0, max_pressure=2000.0)
    assert capped.accuracy_warnings == ()  # the peak is the cap, whatever the grid


def test_single_cell_in_contact_is_one_cell():
    spike = np.ones((20, 20))
    spike[9, 9] = 0.0
    (sentence,) = solve_contact(spike, (0.1, 0.1), E_STAR, load=1.0, warn=False).grid_warnings
    assert sentence.startswith("the contact is 1 cell across")


def test_solution_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        ball().approach = 0.0


def test_single_grid_carries_no_estimate():
    assert math.isnan(ball(n=20, width=0.04).error_estimate.approach)
