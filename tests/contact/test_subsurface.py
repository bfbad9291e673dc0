"""Stresses below a pressure map: Hertz in closed form, equilibrium, surface values, symmetry, and every refusal."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import solve_contact, subsurface_stress
from loaded_tca.contact.subsurface import depths_below
from loaded_tca.reference import hertz
from tests.refusals import refusals, refused_calls

COMPONENTS = ("sigma_x", "sigma_y", "sigma_z", "tau_xy", "tau_xz", "tau_yz")
P0, NU = 1000.0, 0.3
# 80 cells across the circle, pressures those at the centres of cells: measured 2e-3 of p0 at 0.1 a, 3e-4 below 0.4 a
HERTZ_ERROR = 5e-3
# Sums of some thousand products in double precision, relative to the largest stress.
ROUNDING = 1e-12


def centred(n, width):
    return (np.arange(n) - (n - 1) / 2) * width


@pytest.fixture(scope="module")
def circle():
    """Pressure of a Hertz circle of radius 1 mm on 81 x 81 cells, and the width of a cell."""
    step = 2.0 / 80
    x = centred(81, step)
    return P0 * np.sqrt(np.maximum(0.0, 1.0 - x[:, None] ** 2 - x**2)), step


@pytest.fixture(scope="module")
def random_map():
    return np.random.default_rng(3).random((7, 10)) * 100.0


def test_axis_stresses_below_a_hertz_circle(circle):
    """Johnson 1985, eqs. 3.42 to 3.45: closed form on the axis."""
    pressure, step = circle
    z = np.linspace(0.1, 3.0, 30)
    below = subsurface_stress(pressure, (step, step), z, NU)
    vertical = -P0 / (1.0 + z**2)
    radial = -P0 * ((1.0 + NU) * (1.0 - z * np.arctan(1.0 / z)) - 0.5 / (1.0 + z**2))
    assert_allclose(below.sigma_z[:, 40, 40], vertical, atol=HERTZ_ERROR * P0)
    assert_allclose(below.sigma_x[:, 40, 40], radial, atol=HERTZ_ERROR * P0)
    assert_allclose(below.sigma_y[:, 40, 40], below.sigma_x[:, 40, 40], atol=ROUNDING * P0)
    assert_allclose(below.max_shear[:, 40, 40], 0.5 * (radial - vertical), atol=HERTZ_ERROR * P0)


@pytest.mark.thorough
def test_greatest_shear_below_a_hertz_circle(circle):
    """0.310 p0 at 0.48 a for nu = 0.3 (Johnson 1985, section 4.2(a)); on the axis."""
    pressure, step = circle
    below = subsurface_stress(pressure, (step, step), np.linspace(0.0, 1.5, 151), NU)
    level, row, column = below.max_shear_at
    assert_allclose(below.max_shear.max() / P0, 0.310, atol=1e-3)
    assert_allclose(below.depths[level], 0.48, atol=0.011)
    assert (row, column) == (40, 40)
    assert below.von_mises_at == below.max_shear_at


def test_axis_stresses_below_a_hertz_ellipse():
    """Love's potentials of an ellipse, from ``hertz``, axes 1:4."""
    contact = hertz.point_contact(100.0, (0.02, 0.14), 115e3)
    minor, major = contact.semi_minor, contact.semi_major
    x, y = centred(81, minor / 40), centred(81, major / 40)
    pressure = contact.pressure(x[:, None], y[None, :])
    for depth in (0.2 * minor, 0.8 * minor, 2.0 * minor):
        below = subsurface_stress(pressure, (minor / 40, major / 40), [depth], NU)
        found = [below.sigma_x[0, 40, 40], below.sigma_y[0, 40, 40], below.sigma_z[0, 40, 40]]
        expected = contact.axis_stresses(depth, NU)
        assert_allclose(found, expected, atol=HERTZ_ERROR * contact.max_pressure)


def test_greatest_shear_below_a_line_contact():
    """0.300 p0 at 0.786 a (Johnson 1985, section 4.2(c)); the ends of the line count as depth over length."""
    x = centred(81, 1.0 / 40)
    pressure = np.repeat(P0 * np.sqrt(np.maximum(0.0, 1.0 - x**2))[:, None], 15, axis=1)
    below = subsurface_stress(pressure, (1.0 / 40, 40.0), np.linspace(0.5, 1.1, 61), NU)
    in_plane = 0.5 * np.abs(below.sigma_x - below.sigma_z)[:, 40, 7]
    assert_allclose(in_plane.max() / P0, 0.3003, atol=1e-3)
    assert_allclose(below.depths[int(np.argmax(in_plane))], 0.786, atol=0.011)
    # the line runs on along y: plane strain
    assert_allclose(below.sigma_y[:, 40, 7], NU * (below.sigma_x + below.sigma_z)[:, 40, 7], atol=2e-3 * P0)


def test_vertical_stress_carries_the_load_at_every_depth(random_map):
    """A box of 60 depths misses 1.5 (depth/box)^3 of the load of a point, less than 1e-4."""
    pressure = np.zeros((241, 241))
    pressure[117:124, 115:125] = random_map
    below = subsurface_stress(pressure, (1.0, 1.0), [0.5, 2.0], NU)
    assert_allclose(-below.sigma_z.sum(axis=(1, 2)), pressure.sum(), rtol=2e-3)


def test_surface_stresses_are_the_pressure(random_map):
    """sigma_z = -p, no shear across the surface, sigma_x + sigma_y = -(1 + 2 nu) p (Johnson 1985, eq. 3.25)."""
    below = subsurface_stress(random_map, (0.3, 0.7), [0.0], NU)
    largest = random_map.max()
    assert_allclose(below.sigma_z[0], -random_map, atol=ROUNDING * largest)
    assert_allclose(below.sigma_x[0] + below.sigma_y[0], -(1.0 + 2.0 * NU) * random_map, atol=ROUNDING * largest)
    assert_allclose(below.tau_xz[0], 0.0, atol=ROUNDING * largest)
    assert_allclose(below.tau_yz[0], 0.0, atol=ROUNDING * largest)


def test_stress_is_that_of_point_forces_far_away():
    """Boussinesq (Johnson 1985, eqs. 3.19) at ten cell widths: a cell is a point to (1/10)^2/4."""
    pressure = np.zeros((21, 17))
    pressure[3, 4] = 1.0
    below = subsurface_stress(pressure, (1.0, 1.0), [6.0], NU)
    x, y, z = 12.0, 9.0, 6.0
    rho, r2 = math.sqrt(x * x + y * y + z * z), x * x + y * y
    one, two = (1.0 - z / rho) / r2, z / rho**3
    free = (1.0 - 2.0 * NU) / r2
    expected = {
        "sigma_x": free * (one * (x * x - y * y) + two * y * y) - 3.0 * z * x * x / rho**5,
        "sigma_y": free * (one * (y * y - x * x) + two * x * x) - 3.0 * z * y * y / rho**5,
        "sigma_z": -3.0 * z**3 / rho**5,
        "tau_xy": free * (2.0 * one - two) * x * y - 3.0 * x * y * z / rho**5,
        "tau_xz": -3.0 * x * z * z / rho**5,
        "tau_yz": -3.0 * y * z * z / rho**5,
    }
    for name, value in expected.items():
        assert_allclose(getattr(below, name)[0, 15, 13], value / (2.0 * math.pi), rtol=2e-2, err_msg=name)


def test_stresses_are_in_equilibrium_inside(random_map):
    """d tau_xz/dx + d tau_yz/dy + d sigma_z/dz = 0 by central differences, whose error is that of the step squared."""
    fine = np.kron(random_map, np.ones((5, 5)))
    depth, step = 4.0, 0.2
    below = subsurface_stress(fine, (step, step), [depth - step, depth, depth + step], NU)
    by_x = (below.tau_xz[1, 2:, 1:-1] - below.tau_xz[1, :-2, 1:-1]) / (2.0 * step)
    by_y = (below.tau_yz[1, 1:-1, 2:] - below.tau_yz[1, 1:-1, :-2]) / (2.0 * step)
    by_z = (below.sigma_z[2] - below.sigma_z[0])[1:-1, 1:-1] / (2.0 * step)
    assert np.abs(by_x + by_y + by_z).max() < 0.02 * np.abs(by_z).max()


def test_stress_is_linear_in_the_pressure(random_map):
    depths = [0.1, 1.0]
    one = subsurface_stress(random_map, (1.0, 2.0), depths, NU)
    both = subsurface_stress(2.0 * random_map + random_map[::-1], (1.0, 2.0), depths, NU)
    other = subsurface_stress(random_map[::-1], (1.0, 2.0), depths, NU)
    for name in COMPONENTS:
        summed = 2.0 * getattr(one, name) + getattr(other, name)
        assert_allclose(getattr(both, name), summed, atol=ROUNDING * 1e3, err_msg=name)


@pytest.mark.parametrize("odd", [("tau_xy", "tau_xz")])
def test_stress_mirrors_with_the_pressure(random_map, odd):
    one = subsurface_stress(random_map, (1.0, 2.0), [0.4], NU)
    other = subsurface_stress(random_map[::-1], (1.0, 2.0), [0.4], NU)
    for name in COMPONENTS:
        sign = -1.0 if name in odd else 1.0
        assert_allclose(getattr(other, name), sign * getattr(one, name)[:, ::-1], atol=ROUNDING * 1e3, err_msg=name)


def test_axes_may_be_exchanged(random_map):
    one = subsurface_stress(random_map, (1.0, 2.0), [0.4], NU)
    other = subsurface_stress(random_map.T, (2.0, 1.0), [0.4], NU)
    for name, swapped in (("sigma_x", "sigma_y"), ("tau_xz", "tau_yz"), ("tau_xy", "tau_xy"), ("sigma_z", "sigma_z")):
        exchanged = np.swapaxes(getattr(other, swapped), 1, 2)
        assert_allclose(exchanged, getattr(one, name), atol=ROUNDING * 1e3, err_msg=name)


def test_stress_does_not_depend_on_the_grid_around(random_map):
    """Zero padding is complete: more empty cells change nothing."""
    alone = subsurface_stress(random_map, (1.0, 1.0), [5.0], NU)
    wide = subsurface_stress(np.pad(random_map, 6), (1.0, 1.0), [5.0], NU)
    for name in COMPONENTS:
        assert_allclose(getattr(wide, name)[:, 6:-6, 6:-6], getattr(alone, name), atol=ROUNDING * 1e3, err_msg=name)


def test_invariants_agree_with_the_principal_stresses(random_map):
    below = subsurface_stress(random_map, (1.0, 1.0), [0.3, 1.0, 8.0], NU)
    rows = (("sigma_x", "tau_xy", "tau_xz"), ("tau_xy", "sigma_y", "tau_yz"), ("tau_xz", "tau_yz", "sigma_z"))
    tensor = np.moveaxis([[getattr(below, name) for name in row] for row in rows], (0, 1), (-2, -1))
    principal = np.linalg.eigvalsh(tensor)
    low, middle, high = np.moveaxis(principal, -1, 0)
    mises = np.sqrt(0.5 * ((low - middle) ** 2 + (middle - high) ** 2 + (high - low) ** 2))
    assert_allclose(below.max_shear, 0.5 * (high - low), rtol=1e-7)
    # differences of eigenvalues, rounded by the largest: 3e-15 seen
    assert_allclose(below.von_mises, mises, rtol=1e-10)


def test_no_pressure_gives_no_stress():
    below = subsurface_stress(np.zeros((4, 5)), (1.0, 1.0), [0.0, 1.0])
    assert not below.max_shear.any()
    assert not below.von_mises.any()


def test_depths_reach_past_the_greatest_shear_of_a_solution():
    contact = hertz.point_contact(100.0, (0.1, 0.1), 115e3)
    x = centred(32, 2.5 * contact.semi_minor / 32)
    gap = 0.05 * (x[:, None] ** 2 + x**2)
    solution = solve_contact(gap, (x[1] - x[0],) * 2, 115e3, load=100.0)
    below = subsurface_stress(solution.pressure, solution.spacing, depths_below(solution))
    shear, depth = contact.subsurface_shear()
    level = below.max_shear_at[0]
    assert 0 < level < len(below.depths) - 1
    # 26 cells across the contact and steps of 0.06 a at 0.48 a
    assert_allclose(below.max_shear.max(), shear, rtol=1e-2)
    assert_allclose(below.depths[level], depth, rtol=0.1)
    assert "greatest shear" in repr(below)


test_arguments_that_cannot_be_used_are_named = refusals(
    lambda arguments: subsurface_stress(*arguments),
    (((np.ones(4)), (1.0, 1.0), [1.0]), "pressure: an array of shape"),
    ((np.ones((2, 2)), (1.0, 1.0), [[1.0]]), "depths: an array of shape"),
    ((np.ones((2, 2)), (1.0, 1.0), []), "depths: an array of shape"),
    ((np.ones((2, 2)), (0.0, 1.0), [1.0]), r"spacing\[0\]: 0.0"),
    ((np.ones((2, 2)), (1.0,), [1.0]), "spacing: "),
    ((np.full((2, 2), math.nan), (1.0, 1.0), [1.0]), "pressure: 4 cells are not finite"),
    ((np.ones((2, 2)), (1.0, 1.0), [-1.0]), "depths: hold negative"),
    ((np.ones((2, 2)), (1.0, 1.0), [1.0], 0.6), "poisson_ratio: 0.6"),
    ((np.broadcast_to(1.0, (10**5, 10**5)), (1.0, 1.0), [1.0]), "the machine has"),
)


test_subsurface_refuses = refused_calls(
    (
        lambda: subsurface_stress(np.full((2, 2), math.inf), (1.0, -1.0), [math.nan], -0.1),
        (r"^spacing\[1\]:", "^pressure:", "^depths:", "^poisson_ratio:"),
    ),
    (lambda: depths_below(solve_contact(np.ones((20, 20)), (1.0, 1.0), 115e3, load=0.0), 1), ("^count:", "^solution:")),
)
