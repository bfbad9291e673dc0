"""Hertz contact against its limits, its scaling and published numbers."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import dblquad
from scipy.special import ellipe, ellipk

from loaded_tca.errors import InputError
from loaded_tca.reference import hertz
from tests.refusals import refusals

EXACT = 1e-13  # closed forms on both sides, a few rounding errors apart
ROOT_SOLVED = 1e-12  # the ratio of the axes comes from a root finder
STEEL = 206000.0 / (2.0 * (1.0 - 0.3**2))

curvatures = st.floats(1e-6, 10.0)


def legendre_ratio(q):
    """Ratio of curvatures in the classical form with K(m), E(m)."""
    m = 1.0 - q * q
    return (ellipe(m) / q**2 - ellipk(m)) / (ellipk(m) - ellipe(m))


def test_point_contact_agrees_with_sphere_formulas():
    load, radius = 100.0, 10.0
    contact = hertz.point_contact(load, (1 / radius, 1 / radius), STEEL)
    a = (0.75 * load * radius / STEEL) ** (1 / 3)
    assert_allclose([contact.semi_major, contact.semi_minor], a, rtol=EXACT)
    assert_allclose(contact.approach, a**2 / radius, rtol=EXACT)
    assert_allclose(contact.max_pressure, 1.5 * load / (math.pi * a**2), rtol=EXACT)
    # the numbers as printed, to their last digit
    assert_allclose(contact.max_pressure, 1353.415, atol=5e-4)
    assert_allclose(contact.semi_major, 0.187826, atol=5e-7)


def test_point_contact_gives_the_crowned_spur_pair():
    contact = hertz.point_contact(2712.6, (1 / 10.9259, 1 / 15625.0), STEEL)
    # inputs are given to five digits
    assert_allclose(contact.max_pressure, 748.54, rtol=5e-5)
    assert_allclose([contact.semi_major, contact.semi_minor], [11.977, 0.1445], rtol=3e-4)


@pytest.mark.parametrize("q", [0.9, 0.5, 0.1, 1e-2, 1e-3])
def test_axis_ratio_agrees_with_legendre_form(q):
    contact = hertz.point_contact(1.0, (1.0, 1.0 / legendre_ratio(q)), STEEL)
    # the classical form loses digits where K and E are close
    assert_allclose(1.0 / contact.ratio, q, rtol=1e-11)


@pytest.mark.parametrize("aspect", [1e4, 1e6])
def test_slender_ellipse_tends_to_line_contact(aspect):
    """The middle of a slender ellipse is a line contact under its local line load."""
    curvature_ratio = aspect**2 / (math.log(4 * aspect) - 1.0)
    contact = hertz.point_contact(50.0, (0.2, 0.2 / curvature_ratio), STEEL)
    line_load = math.pi / 2 * contact.max_pressure * contact.semi_minor
    line = hertz.line_contact(line_load, 0.2, STEEL)
    assert_allclose(contact.ratio, aspect, rtol=1e-3)
    # the strip is disturbed by (b/a)^2 log(a/b)
    assert_allclose(contact.max_pressure, line.max_pressure, rtol=10 * math.log(aspect) / aspect**2 + ROOT_SOLVED)


@pytest.mark.parametrize("excess", [0.0, 1e-15, 1e-12, 1e-8, 1e-4])
def test_nearly_equal_curvatures_give_nearly_a_circle(excess):
    contact = hertz.point_contact(10.0, (0.1, 0.1 * (1 + excess)), STEEL)
    # atol: the logarithm of a ratio of one
    assert_allclose(math.log(contact.ratio), 2.0 / 3.0 * math.log1p(excess), rtol=1e-3, atol=1e-14)


@given(load=st.floats(1e-3, 1e6), k1=curvatures, k2=curvatures, factor=st.floats(0.1, 10.0))
def test_point_contact_scales_as_hertz_says(load, k1, k2, factor):
    one = hertz.point_contact(load, (k1, k2), STEEL)
    swapped = hertz.point_contact(load, (k2, k1), STEEL)
    more = hertz.point_contact(load * factor**3, (k1, k2), STEEL)
    assert one == swapped
    assert_allclose(more.max_pressure, one.max_pressure * factor, rtol=ROOT_SOLVED)
    assert_allclose(more.approach, one.approach * factor**2, rtol=ROOT_SOLVED)
    assert_allclose(one.mean_pressure, 2.0 / 3.0 * one.max_pressure, rtol=ROOT_SOLVED)


@given(k1=curvatures, k2=curvatures)
def test_displacement_under_the_ellipse_is_the_parabola(k1, k2):
    """Energy: the integral of p (approach - gap) is twice the elastic energy 2/5 F approach."""
    contact = hertz.point_contact(7.0, (k1, k2), STEEL)
    small, large = sorted((k1, k2))
    a, b = contact.semi_major, contact.semi_minor
    energy = 2.0 / 5.0 * contact.load * contact.approach
    mean_square = contact.load * (small * a**2 + large * b**2) / 10.0
    assert_allclose(contact.load * contact.approach - mean_square, 2.0 * energy, rtol=ROOT_SOLVED)


def test_pressure_integrates_to_the_load():
    contact = hertz.point_contact(300.0, (0.05, 0.2), STEEL)

    def quarter(t, s):
        x, y = contact.semi_minor * s * math.cos(t), contact.semi_major * s * math.sin(t)
        return float(contact.pressure(x, y)) * s * contact.semi_minor * contact.semi_major

    integral, _ = dblquad(quarter, 0.0, 1.0, 0.0, math.pi / 2)
    assert_allclose(4.0 * integral, 300.0, rtol=1e-8)  # quadrature of a root at the edge
    assert contact.pressure(1.001 * contact.semi_minor, 0.0) == 0.0


def test_stiffness_is_the_derivative_of_load_by_approach():
    step = 1e-4
    low, mid, high = (hertz.point_contact(100.0 * (1 + s), (0.1, 0.3), STEEL) for s in (-step, 0.0, step))
    slope = (high.load - low.load) / (high.approach - low.approach)
    assert_allclose(mid.stiffness, slope, rtol=step**2)


def test_axis_stresses_of_a_circle_agree_with_the_closed_form():
    contact = hertz.point_contact(100.0, (0.1, 0.1), STEEL)
    a, p0, nu = contact.semi_minor, contact.max_pressure, 0.3
    for zeta in (0.05, 0.48, 1.0, 3.0):
        across, along, normal = contact.axis_stresses(zeta * a, nu)
        radial = -p0 * ((1 + nu) * (1 - zeta * math.atan(1 / zeta)) - 0.5 / (1 + zeta**2))
        assert_allclose([across, along], radial, rtol=1e-11)  # terms cancel as zeta grows: 9e-15 seen
        assert_allclose(normal, -p0 / (1 + zeta**2), rtol=1e-12)  # closed forms; two terms cancel inside: 2e-16 seen


def test_subsurface_shear_of_a_circle_is_where_the_textbook_says():
    contact = hertz.point_contact(100.0, (0.1, 0.1), STEEL)
    shear, depth = contact.subsurface_shear(poisson_ratio=0.3)
    # printed to two digits: 0.31 p0 at 0.48 a
    assert_allclose(shear / contact.max_pressure, 0.31, atol=5e-3)
    assert_allclose(depth / contact.semi_minor, 0.48, atol=5e-3)


def test_subsurface_shear_of_a_slender_ellipse_tends_to_the_line():
    contact = hertz.point_contact(100.0, (1.0, 1e-12), STEEL)
    shear, depth = contact.subsurface_shear()
    line = hertz.line_contact(1.0, 1.0, STEEL)
    # the stress along the line differs by b/a; the place of a maximum is known to the root of that only
    assert_allclose(
        shear / contact.max_pressure, line.subsurface_shear()[0] / line.max_pressure, rtol=1 / contact.ratio
    )
    assert_allclose(depth / contact.semi_minor, line.subsurface_shear()[1] / line.half_width, rtol=1e-4)


def test_line_contact_agrees_with_published_gear_value():
    """FZG C14 at the pitch point: 1347.3 MPa and a half width of 199.567 um."""
    r_b1, r_b2, alpha = (
        36.0 * math.cos(math.radians(20)),
        54.0 * math.cos(math.radians(20)),
        math.radians(22.43934),
    )
    rho1, rho2 = r_b1 * math.tan(alpha), r_b2 * math.tan(alpha)
    line = hertz.line_contact(5912.1 / 14.0, 1 / rho1 + 1 / rho2, STEEL)
    assert_allclose(line.max_pressure, 1347.252, rtol=1e-5)  # the force is printed with five digits
    assert_allclose(line.half_width, 0.199567, rtol=2e-4)  # the two printed values agree to 1e-4 only


def test_line_pressure_integrates_to_the_line_load():
    line = hertz.line_contact(500.0, 0.1, STEEL)
    angle = np.linspace(0.0, math.pi, 4001)
    integral = np.trapezoid(line.pressure(line.half_width * np.cos(angle)) * np.sin(angle), angle) * line.half_width
    assert_allclose(integral, 500.0, rtol=1e-6)  # trapezium rule of 4000 steps
    assert_allclose(line.mean_pressure, math.pi / 4 * line.max_pressure, rtol=EXACT)


test_point_contact_refuses = refusals(
    hertz.point_contact,
    (0.0, (0.1, 0.1), STEEL, "load"),
    (-1.0, (0.1, 0.1), STEEL, "load"),
    (math.nan, (0.1, 0.1), STEEL, "load"),
    (1.0, (0.0, 0.1), STEEL, "curvature_1"),
    (1.0, (0.1, math.inf), STEEL, "curvature_2"),
    (1.0, (0.1, 0.1), 0.0, "contact_modulus"),
)


def test_line_contact_tells_every_problem_at_once():
    with pytest.raises(InputError) as caught:
        hertz.line_contact(-1.0, 0.0, math.nan)
    assert len(caught.value.problems) == 3


def test_point_contact_can_be_pickled():
    contact = hertz.point_contact(1.0, (0.1, 0.2), STEEL)
    assert pickle.loads(pickle.dumps(contact)) == contact
