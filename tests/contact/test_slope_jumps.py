"""Jumps of the slope of a gap inside a contact are told, and their size, wherever they lie on the grid; no others."""

import math
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import ContactProblem, solve_contact, solve_problem, solve_to_accuracy
from loaded_tca.contact.slope_jumps import largest_slope_jump
from loaded_tca.errors import AccuracyWarning

E_STAR = 115e3
CELLS = 40
TIMES = 12
JUMPS = {
    "ridge": (lambda u, v: np.abs(u) + 0.0 * v, 2.0),
    "ridge of a crowned body": (lambda u, v: 0.01 * np.abs(u) + 0.03 * (u * u + v * v), 0.02),
    "start of a linear relief": (lambda u, v: np.maximum(u, 0.0) + 0.03 * v * v, 1.0),
}
SMOOTH = {
    "ellipsoid": lambda u, v: 0.02 * u * u + 0.0005 * v * v,
    "start of a parabolic relief": lambda u, v: np.maximum(u, 0.0) ** 2 + 0.01 * (u * u + v * v),
    "flat between two": lambda u, v: np.maximum(u, 0.0) ** 2 + 0.5 * np.minimum(u + 6.0, 0.0) ** 2 + 0.03 * v * v,
    "end of a parabolic relief": lambda u, v: 0.03 * (u * u + v * v) - 0.02 * np.maximum(u, 0.0) ** 2,
    "flat with a rounded rim": lambda u, v: np.maximum(np.hypot(u, v) - 6.0, 0.0) ** 2,
    "cubic": lambda u, v: np.maximum(u, 0.0) ** 3 + 0.0 * v,
    "power 3/2": lambda u, v: np.hypot(u, v) ** 1.5,
    "logarithm": lambda u, v: 0.03 * u * u - np.log(1.0 - (v / 160.0) ** 2),
    "valley": lambda u, v: 0.03 * (u * u + v * v) - 0.3 * np.abs(u),
    "rounded cone": lambda u, v: np.sqrt(u * u + v * v + 16.0**2),
}


def placed(gap, rng):
    """Slope jump of a gap as a grid tells it, at a random place and angle, on cells of a random aspect."""
    shift, aspect, angle = 8.0 * (rng.random(2) - 0.5), 10.0 ** rng.uniform(-0.6, 0.6), rng.uniform(0.0, math.pi)
    centres = np.arange(CELLS) - 0.5 * (CELLS - 1)
    x, y = (centres + shift[0])[:, None], (centres + shift[1]) * aspect
    pressed = np.hypot(centres[:, None], centres) < rng.uniform(9.0, 16.0)
    u, v = math.cos(angle) * x + math.sin(angle) * y, math.cos(angle) * y - math.sin(angle) * x
    return largest_slope_jump(gap(u, v), pressed, (1.0, aspect), 1e-4)


@pytest.mark.parametrize("name", JUMPS)
def test_jump_of_a_line_is_told_with_its_size(rng, name):
    gap, size = JUMPS[name]
    # what both axes tell of an oblique line is read at the cell where each tells most
    assert_allclose([placed(gap, rng) for _ in range(TIMES)], size, rtol=0.02)


def test_apex_of_a_cone_is_told(rng):
    told = [placed(lambda u, v: np.hypot(u, v), rng) for _ in range(TIMES)]
    # both axes cross it, with slopes that jump by 2; beside the middles of the cells by less
    assert min(told) > 1.7
    assert max(told) < 2.0 * math.sqrt(2.0) * 1.001


@pytest.mark.parametrize("name", SMOOTH)
def test_smooth_gaps_have_none(rng, name):
    assert [placed(SMOOTH[name], rng) for _ in range(TIMES)] == [0.0] * TIMES


def test_roughness_is_told_where_its_waves_have_too_few_cells(rng):
    """Shortest waves of 2 and of 8 cells: the larger ones are those of ``docs/guide/contact_alone.md``."""
    x = (np.arange(96) + 0.5) / 48.0 - 1.0
    waves = np.hypot(*np.meshgrid(np.fft.fftfreq(96), np.fft.fftfreq(96)))
    noise = np.fft.fft2(rng.standard_normal((96, 96)))
    for shortest, told in ((2.0, True), (8.0, False)):
        heights = np.fft.ifft2(np.where(waves <= 1.0 / shortest, noise * (waves + 0.02) ** -1.8, 0.0)).real
        gap = (x[:, None] ** 2 + x**2) / 40.0 + 2e-4 * heights / heights.std()
        solution = solve_problem(ContactProblem(gap, (1 / 48,) * 2, E_STAR, load=2000.0))
        assert (solution.slope_jump > 0.0) == told


def test_jumps_beside_the_contact_do_not_count():
    """The rim of a punch, as void or as a finite step, and a ridge that the contact does not reach."""
    x = (np.arange(64) + 0.5) * 2.4 / 64 - 1.2
    radius = np.hypot(x[:, None], x)
    for outside in (math.inf, 1.0):
        gap = np.where(radius < 1.0, 1e-4 * radius**2, outside)
        assert solve_problem(ContactProblem(gap, (2.4 / 64,) * 2, E_STAR, load=5e3)).slope_jump == 0.0
    ridge = radius**2 / 20.0 + 0.05 * np.maximum(x - 0.9, 0.0)
    assert solve_problem(ContactProblem(ridge, (2.4 / 64,) * 2, E_STAR, load=500.0)).slope_jump == 0.0


def roof(cells):
    """0.05 |x| + y^2/20, a ridge that runs between cells of any even number."""
    x, y = ((np.arange(n) + 0.5) * width / n - 0.5 * width for n, width in zip(cells, (1.2, 2.4), strict=True))
    gap = 0.05 * np.abs(x[:, None]) + y**2 / 20.0
    return ContactProblem(gap, (1.2 / cells[0], 2.4 / cells[1]), E_STAR, load=3000.0)


def test_pressure_of_a_ridge_grows_as_the_warning_says():
    """By E* jump ln 2/(2 pi) with every halving (Johnson 1985, section 5.2), which the estimate contains."""
    coarse, fine = (solve_problem(roof((n, n))) for n in (64, 128))
    grown = E_STAR * 0.1 * math.log(2.0) / (2.0 * math.pi)
    assert_allclose(fine.pressure.max() - coarse.pressure.max(), grown, rtol=0.02)  # and what falls with the cell
    assert coarse.error_estimate.peak_pressure >= grown / coarse.pressure.max()
    assert fine.error_estimate.peak_pressure >= grown / fine.pressure.max()
    assert f"grows by about {float(f'{grown:.3g}'):g} MPa" in coarse.accuracy_warnings[0]


def test_pressure_of_an_apex_grows_by_half_as_much_again():
    """By E* slope ln 2/2 with every halving: arcosh(a/r) of a cone."""
    peaks = []
    for count in (32, 64):
        x = (np.arange(count) + 0.5) * 0.4 / count - 0.2
        problem = ContactProblem(
            0.01 * np.hypot(x[:, None], x), (0.4 / count,) * 2, E_STAR, load=0.5 * E_STAR * math.pi * 1e-4
        )
        peaks.append(solve_problem(problem).pressure.max())
    assert_allclose(peaks[1] - peaks[0], 0.5 * E_STAR * 0.01 * math.log(2.0), rtol=0.02)  # and what falls with the cell


def test_both_solvers_warn_of_a_jump():
    problem = roof((32, 32))
    with pytest.warns(AccuracyWarning, match="the slope of the gap jumps by 100 mrad inside the contact"):
        solve_contact(problem.gap, problem.spacing, E_STAR, load=3000.0)
    with (
        pytest.warns(AccuracyWarning, match="the slope of the gap jumps by 100 mrad inside the contact"),
        pytest.warns(AccuracyWarning, match=r"peak pressure, 0\.\d+, is above the accuracy 0\.04"),
    ):
        solution = solve_to_accuracy(roof, accuracy=0.04)
    assert max(solution.pressure.shape) <= 64  # where its approach agrees, as where an edge ends a contact
    assert solution.error_estimate.approach <= 0.04 < solution.error_estimate.peak_pressure


def test_cap_that_is_reached_limits_the_pressure_of_a_jump():
    problem = roof((32, 32))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solve_contact(problem.gap, problem.spacing, E_STAR, load=3000.0, max_pressure=5000.0)
    with pytest.warns(AccuracyWarning, match="no limit"):
        solve_contact(problem.gap, problem.spacing, E_STAR, load=3000.0, max_pressure=1e6)


def test_small_jumps_are_none_of_the_pressure():
    """What adds less than a thousandth of the largest pressure with every halving."""
    x = (np.arange(64) + 0.5) / 64 - 0.5
    least = 1e-3 * 2.0 * math.pi / math.log(2.0)  # over pressure and modulus
    for part, told in ((0.8, False), (1.2, True)):
        ball = (x[:, None] ** 2 + x**2) / 20.0
        peak = solve_problem(ContactProblem(ball, (1 / 64,) * 2, E_STAR, load=500.0)).pressure.max()
        ridge = ball + 0.5 * part * least * peak / E_STAR * np.abs(x)
        solution = solve_problem(ContactProblem(ridge, (1 / 64,) * 2, E_STAR, load=500.0))
        assert (solution.slope_jump > 0.0) == told
