import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.flank_maps.ease_off_map import flank_lengths, second_order
from loaded_tca.flanks import InvoluteFlank
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from tests.samples.gear_pairs import gear_pair

ROUNDING = 1e-12  # of products of a few factors
coefficient = st.floats(-1.0, 1.0)


def bevel():
    return bevel_pair(bevel_mesh((20, 31), outer_module=4.0, face_width=22.0, spiral_angle=math.radians(30.0)))


@given(st.lists(coefficient, min_size=6, max_size=6), st.sampled_from([gear_pair().pinion.flank, bevel().wheel.flank]))
def test_polynomial_is_its_own_second_order(amounts, flank):
    rho, z = flank.grid(7, 9)
    x, y = flank_lengths(flank, rho, z)
    x, y = x - 0.5 * (x.max() + x.min()), y - 0.5 * (y.max() + y.min())
    terms = (np.ones_like(x), x, y, x * y, x**2, y**2)
    found = second_order(flank, rho, z, sum(a * term for a, term in zip(amounts, terms, strict=True)))
    # also below: least squares over products of lengths up to 11 mm, 8e-14 seen
    assert_allclose(found.polynomial, amounts, rtol=0, atol=1e-10)
    assert found.residual < 1e-9


def test_amounts_are_those_at_the_ends():
    flank = gear_pair().pinion.flank
    rho, z = flank.grid(9, 9)
    x, y = flank_lengths(flank, rho, z)
    t, u = x / 12.5, (2.0 * y - y.max() - y.min()) / np.ptp(y)
    found = second_order(flank, rho, z, 0.010 * t**2 + 0.020 * u**2 + 0.003 * t + 0.004 * u + 0.005 * t * u)
    assert_allclose(found.lengthwise_crowning, 0.010, rtol=1e-9)
    assert_allclose(found.profile_crowning, 0.020, rtol=1e-9)
    assert_allclose(found.lengthwise_slope, 0.006, rtol=1e-9)
    assert_allclose(found.profile_slope, 0.008, rtol=1e-9)
    assert_allclose(found.twist, 0.020, rtol=1e-9)
    assert_allclose(found.size, (25.0, np.ptp(y)), rtol=ROUNDING)
    assert_allclose(found.origin, (0.0, 0.5 * (y.max() + y.min())), atol=1e-9)


def test_what_is_left_over_is_the_residual():
    flank = gear_pair().pinion.flank
    rho, z = flank.grid(5, 41)
    assert_allclose(second_order(flank, rho, z, np.abs(z / 12.5)).residual, math.sqrt(1.0 / 192.0), rtol=0.05)
    # |t| less its parabola 3/16 + 15/16 t^2, mean square over the face: 1/192


def removed_from(flank, other, rho, z):
    """What the other flank lacks of the first, along the normal [mm]."""
    turn = flank.theta(rho, z).value - other.theta(rho, z).value
    return flank.side * turn / flank.gradient_norm(rho, z).value


@pytest.mark.parametrize("count", [8, 9])
@pytest.mark.parametrize("error", [1e-4, -1e-4])
def test_pressure_angle_is_that_of_another_base_circle(error, count):
    """On a spur gear: cos alpha = r_b/r, so a larger angle is a smaller base circle."""
    flank = gear_pair().pinion.flank
    angle, pitch = math.radians(20.0), 51.0
    base = pitch * math.cos(angle + error)
    other = InvoluteFlank(base, 0.0, flank.side, pitch, flank.radii, flank.face_width)
    rho, z = flank.grid(count, 5)
    found = second_order(flank, rho, z, removed_from(flank, other, rho, z))
    middle = found.origin[1] / flank.base_radius  # tangent of the pressure angle in the middle
    # first order; the middle of an even grid lies between its points
    assert_allclose(found.pressure_angle, error * math.tan(angle) / middle, rtol=5e-3)


def test_spiral_angle_is_that_of_another_lead():
    """The normal of a helical flank turns by d beta cos(alpha_n) lengthwise."""
    flank = gear_pair(helix_deg=15.0).pinion.flank
    beta, error, normal_angle = math.radians(15.0), 1e-4, math.radians(20.0)
    transverse = math.atan(math.tan(normal_angle) / math.cos(beta))
    base_angle = math.atan(math.tan(beta + error) * math.cos(transverse))
    pitch = flank.base_radius / math.cos(transverse)
    other = InvoluteFlank(flank.base_radius, base_angle, flank.side, pitch, flank.radii, flank.face_width)
    rho, z = flank.grid(9, 9)
    found = second_order(flank, rho, z, removed_from(flank, other, rho, z))
    assert_allclose(abs(found.spiral_angle), error * math.cos(normal_angle), rtol=0.01)
    assert_allclose(found.pressure_angle, 0.0, atol=1e-3 * error)


def test_shown_by_its_numbers():
    flank = gear_pair().pinion.flank
    rho, z = flank.grid(5, 5)
    shown = repr(second_order(flank, rho, z, 0.01 * (z / 12.5) ** 2 + 1e-3 * z))
    assert shown == (
        "SecondOrder(spiral angle 3.44 arcmin, pressure angle 0 arcmin, crownings 10 um and 0 um, twist 0 um)"
    )
