import math

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.material import Material
from loaded_tca.reference.weber_banaschek import flank_flattening, ring_torsion, tooth_deflection
from tests.refusals import refused_calls

STEEL = Material()
PRISM = np.array([0.0, 1.0, 4.0, 10.0]), np.full(4, 2.0)


def test_bending_of_a_prism_is_that_of_a_cantilever_with_shear():
    length, modulus = 7.0, STEEL.plane_strain_modulus
    bending = 12.0 * length**3 / (3.0 * 2.0**3) / modulus
    shear = 1.2 * length / (2.0 * 0.5 * STEEL.youngs_modulus / (1.0 + STEEL.poisson_ratio))
    assert_allclose(tooth_deflection(*PRISM, length, 0.0).bending, bending + shear)


def test_coefficients_of_steel_are_the_printed_ones():
    """5.2 (y/s)^2 + y/s + 1.4 (1 + 0.294 tan^2), as printed for a Poisson ratio of 0.3 to two digits."""
    angle = math.radians(20.0)
    ratio = 3.0 / 2.0
    printed = 5.2 * ratio**2 + ratio + 1.4 * (1.0 + 0.294 * math.tan(angle) ** 2)
    found = tooth_deflection(*PRISM, 3.0, angle).foundation
    assert_allclose(found * STEEL.youngs_modulus, math.cos(angle) ** 2 * printed, rtol=0.01)


def test_deflection_of_a_taper_does_not_depend_on_how_it_is_cut():
    coarse = np.array([0.0, 10.0]), np.array([4.0, 2.0])
    fine = np.linspace(0.0, 10.0, 40), np.linspace(4.0, 2.0, 40)
    assert_allclose(tooth_deflection(*coarse, 9.0, 0.3).total, tooth_deflection(*fine, 9.0, 0.3).total, rtol=1e-4)


def test_deflection_is_free_of_scale():
    one, ten = (tooth_deflection(k * PRISM[0], k * PRISM[1], 6.0 * k, 0.2) for k in (1.0, 10.0))
    assert_allclose([one.bending, one.foundation], [ten.bending, ten.foundation])


def test_flattening_grows_by_the_logarithm_of_the_depth():
    found = [flank_flattening(0.1, depth) for depth in (1.0, 2.0, 4.0)]
    step = 2.0 * math.log(2.0) / (math.pi * STEEL.plane_strain_modulus)
    assert_allclose(np.diff(found), step)


def test_body_torsion_adds_over_rings():
    assert_allclose(ring_torsion(10.0, 30.0), ring_torsion(10.0, 17.0) + ring_torsion(17.0, 30.0))


test_weber_banaschek_refuses = refused_calls(
    (
        lambda: tooth_deflection(np.array([1.0, 2.0]), np.array([1.0, -1.0]), 1.0, 2.0),
        ("^height:", "^thickness:", "^load_angle:"),
    ),
    (lambda height: tooth_deflection(*PRISM, height, 0.0), "load_height", [0.0, 11.0]),
    (lambda width: flank_flattening(width, 1.0), "half_width", [0.0, 2.0]),
    (lambda inner: ring_torsion(inner, 1.0), "inner_radius", [0.0, 2.0]),
)
