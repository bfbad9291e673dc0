"""What the study of the local term rests on: half-spaces under waves of load, and the fit of a normal distribution."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from validation.loaded.local_term import HALF_WIDTH, STEEL, WAVES, Spread, below_wave, surface_under_wave

E, NU = STEEL.youngs_modulus, STEEL.poisson_ratio


@pytest.mark.parametrize("wave", [0.05, 0.5])
def test_wave_below_the_surface_is_a_sum_of_point_forces(wave):
    """Boussinesq (Johnson 1985, eq. 3.19): displacement along the force, at a depth and a distance from its line."""
    depth = 3.0

    def kernel(distance):
        reach = math.hypot(depth, distance)
        return (1.0 + NU) / (2.0 * math.pi * E) * (depth**2 / reach**3 + 2.0 * (1.0 - NU) / reach)

    found, _ = quad(lambda s: 2e6 * kernel(s), 0.0, np.inf, weight="cos", wvar=wave, epsabs=1e-9, limlst=500)
    assert_allclose(1e6 * below_wave(depth, wave), found, rtol=1e-6)


def test_surface_under_a_longer_wave_grows_by_its_logarithm():
    """Far longer than the strip is wide a wave is a line load, whose displacement is a logarithm."""
    near, far = (surface_under_wave(wave) for wave in (1e-3, 1e-5))
    assert_allclose(far - near, 2.0 / (math.pi * STEEL.plane_strain_modulus) * math.log(100.0), rtol=1e-6)
    assert surface_under_wave(1.0 / HALF_WIDTH) < near


def test_spread_of_a_normal_distribution_is_found_again():
    one = Spread(0.5, 0.8e-6 * np.exp(-((WAVES * 5.9) ** 2)))
    assert_allclose(one.length, 5.9, rtol=1e-9)
    assert_allclose(one.misfit(math.sqrt(2.0) * 5.9), 0.0, atol=1e-12)  # a misfit of order one at its zero
    assert one.misfit(4.0) > 0.1
