import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.compliance.local_term import local_flexibility
from loaded_tca.material import Material
from tests.samples.bodies import pinion

STEEL = local_flexibility(pinion())
ROUNDING = 1e-9
CONVERGED = 0.015
"""Change on a mesh twice as fine; the fillet's end bends most."""


def test_local_term_is_that_of_both_sides():
    assert_allclose(local_flexibility(pinion(side=-1)).value, STEEL.value, rtol=1e-6)  # the meshes are no mirror images


def test_local_term_is_converged():
    fine = local_flexibility(pinion(), MeshDensity(16, 24, 8, 8, 12, 1, 0))
    assert_allclose(STEEL.value[1:], fine.at(STEEL.height[1:]), rtol=CONVERGED)


def test_local_term_of_steel_has_its_known_size():
    """0.30 to 0.91e-6 mm per N/mm by elements in contact, of a patch less the half-plane."""
    assert 0.30e-6 < STEEL.value.min() < STEEL.value.max() < 0.91e-6


def test_local_term_is_inverse_to_the_modulus():
    soft = local_flexibility(pinion(material=Material(103000.0, 0.3)))
    assert_allclose(soft.value, 2.0 * STEEL.value, rtol=ROUNDING)


def test_local_term_ends_evenly():
    assert_allclose(STEEL.at(np.array([0.0, 1.0])), STEEL.value[[0, -1]])
