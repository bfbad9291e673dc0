"""Ratings of rings: signs of the standard, reduced mass, cycles, rims."""

from dataclasses import replace
from math import pi

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.rating.inputs import inputs_of
from loaded_tca.rating.vibration import full_second_moment, reduced_mass
from tests.samples.rating import HARD, RATED
from tests.samples.tribology import shared

SOFT = {"material": "42CrMo4", "hardness_HBW": 250.0, "proof_stress_MPa": 800.0}
ROUNDING = 1e-12  # of a few products and roots


def solved(**changes):
    """Planet and ring of the NREL stage, with a rating, of whose keys some are changed."""
    whole = shared("planet_ring", positions=5, analysis__accuracy=None, analysis__cells=(4, 8))
    sections = RATED | {"wheel.strength": HARD | SOFT}
    return replace(whole, scene=whole.scene.with_changes(sections).with_changes(changes))


def test_stresses_of_a_ring_have_the_ratio_of_its_curvatures():
    rated, scene = solved(**{"rating.face_load_factor": 1.0}).rating(), solved().scene
    mesh = scene.mesh()
    pinion, ring = mesh.pinion, mesh.ring
    force = rated.torque / pinion.reference_radius / mesh.common_face_width
    ratio = ring.tooth_count / pinion.teeth
    load = force / (2.0 * pinion.reference_radius) * (ratio - 1.0) / ratio  # u negative: (u + 1)/u
    assert_allclose(rated.sigma_H0, rated.Z_H * rated.Z_E * rated.Z_eps * np.sqrt(load), rtol=ROUNDING)
    assert_array_equal(rated.Z_BD[:, 1], 1.0)
    assert (rated.Y_F[:, 1] > 0.0).all()
    assert rated.Z_W_reference[0, 1] > rated.Z_W_reference[0, 0] == 1.0
    assert_allclose(rated.cycles[:, 0] / rated.cycles[:, 1], ratio, rtol=ROUNDING)


def test_ring_is_hollow_in_the_reduced_mass():
    inputs = inputs_of(solved())
    planet, ring = inputs.mesh.pinion, inputs.mesh.wheel
    mean, outer = ring.tip_radius + ring.root_radius, 2148.82  # outer diameter of the scene
    moments = full_second_moment(planet) - pi / 32.0 * 400.0**4, pi / 32.0 * (outer**4 - mean**4)
    masses = [7.85e-6 * moment / gear.base_radius**2 for moment, gear in zip(moments, (planet, ring), strict=True)]
    assert_allclose(reduced_mass(inputs), masses[0] * masses[1] / sum(masses), rtol=ROUNDING)


def test_thin_rim_of_a_ring_raises_its_root_stress_alone():
    """s_R of 2.5 modules, for which the standard has 1.383."""
    thick, thin = solved().rating(), solved(**{"wheel.outer_diameter_mm": 2000.581 + 5.0 * 21.0}).rating()
    assert_allclose(thin.Y_B / thick.Y_B, [[1.0, 1.15 * np.log(8.324 / 2.5)]], rtol=1e-9)  # the root by its fillet
    assert_allclose(thin.sigma_F0 / thick.sigma_F0, thin.Y_B / thick.Y_B, rtol=ROUNDING)
