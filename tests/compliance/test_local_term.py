import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.compliance.flexibility import local_flexibility
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.material import Material
from tests.samples.bodies import pinion

HEIGHT, STEEL = local_flexibility(pinion())
ROUNDING = 1e-9  # solutions with stiffness matrices of finite elements
CONVERGED = 0.015
"""Change on a mesh twice as fine; the fillet's end bends most."""


def test_local_term_is_that_of_both_sides():
    assert_allclose(local_flexibility(pinion(side=-1))[1], STEEL, rtol=1e-6)  # the meshes are no mirror images


def test_local_term_is_converged():
    height, fine = local_flexibility(pinion(), MeshDensity(16, 24, 8, 8, 12, 1, 0))
    assert_allclose(STEEL[1:], np.interp(HEIGHT[1:], height, fine), rtol=CONVERGED)


def test_local_term_of_steel_has_its_known_size():
    """0.30 to 0.91e-6 mm per N/mm by elements in contact, of a patch less the half-plane."""
    assert 0.30e-6 < STEEL.min() < STEEL.max() < 0.91e-6


def test_local_term_is_inverse_to_the_modulus():
    _, soft = local_flexibility(pinion(material=Material(103000.0, 0.3)))
    assert_allclose(soft, 2.0 * STEEL, rtol=ROUNDING)


def test_local_term_is_known_at_increasing_heights_of_the_flank():
    assert HEIGHT.shape == STEEL.shape
    assert HEIGHT[0] > 0.0
    assert HEIGHT[-1] < 1.0
    assert (np.diff(HEIGHT) > 0.0).all()
