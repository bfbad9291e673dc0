"""A solid gear, bore diameter 0: it is held where its journals, 0.55 of the root diameter, adjoin both faces."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.compliance import MeshDensity, tooth_compliance
from loaded_tca.compliance import geometry as ring_geometry
from loaded_tca.compliance.body import body_torsion, gear_body, gear_nodes, solid_torsion
from loaded_tca.compliance.flexibility import local_flexibility
from loaded_tca.gears import bevel_mesh
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.reference.weber_banaschek import ring_torsion
from tests.samples.bodies import COARSE, WIDTH, between, line, model, pinion, spur_mesh, within

ROOT = 33.75
JOURNAL = 0.55 * ROOT
SHEAR_MODULUS = 206000.0 / 2.6
CONVERGED = 0.03
"""Stresses are infinite, in theory, at the edge of a rigid journal: elements of half the size are that much softer."""
SINGULAR = 0.12
"""Part of the twist that eight layers of elements miss for the same reason; 4 miss 20 %, 16 7 %."""


def whole(gear, height):
    return WIDTH * within(gear, height)


def test_nodes_are_held_on_both_faces_within_the_journals_alone():
    nodes = gear_nodes(pinion(0.0), COARSE)
    mesh, factor = gear_body(nodes, Material())
    held = np.ones(len(mesh.points), dtype=bool)
    for front in factor.fronts:
        held[front.inside // 3] = False
    rho, z = np.hypot(*mesh.points.T[:2]), mesh.points[:, 2]
    on_face = np.isclose(np.abs(z), 0.5 * WIDTH) if z.min() < 0.0 else np.isclose(z, 0.0) | np.isclose(z, WIDTH)
    assert_allclose(held, on_face & (rho < JOURNAL * (1.0 + 1e-9)))


@pytest.mark.thorough
def test_a_solid_gear_is_softer_than_one_on_a_rigid_shaft_as_thick_as_its_journals():
    """Its core deforms and is held at its ends alone; a shaft a quarter as thick is softer still."""
    for height in (0.1, 0.5, 0.9):
        stiff, solid, slender = (whole(model(bore_diameter=bore), height) for bore in (None, 0.0, 0.25 * 2.0 * JOURNAL))
        assert stiff < solid < slender


@pytest.mark.thorough
@pytest.mark.parametrize("height", [0.1, 0.5, 0.9])
def test_compliance_of_a_solid_gear_does_not_diverge_with_the_mesh(height):
    found = [
        whole(model(replace(COARSE, lengthwise=layers, rim=rim), bore_diameter=0.0), height)
        for layers, rim in ((4, 4), (8, 8))
    ]
    assert_allclose(found[0], found[1], rtol=CONVERGED)


def test_the_hole_of_the_mesh_is_of_no_account(monkeypatch):
    usual = whole(model(bore_diameter=0.0), 0.5)
    model.cache_clear()
    monkeypatch.setattr(ring_geometry, "HOLE", 0.2)
    assert_allclose(whole(model(bore_diameter=0.0), 0.5), usual, rtol=1e-3)
    model.cache_clear()


def test_the_local_term_is_that_of_the_ring():
    for solid, ring in zip(local_flexibility(pinion(0.0)), local_flexibility(pinion()), strict=True):
        assert_allclose(solid, ring, rtol=1e-12)  # the same teeth, the same operations: none seen


@pytest.mark.thorough
def test_compliance_of_a_solid_spiral_bevel_gear_is_symmetric_and_softer_than_that_of_the_ring():
    mesh = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0, spiral_angle=math.radians(30.0))
    solid = replace(mesh, pinion=replace(mesh.pinion, bore_diameter=0.0))
    found = []
    for one in (mesh, solid):
        gear = tooth_compliance(bevel_pair(one), density=COARSE).pinion
        places = line(gear, 0.5)
        found.append(gear.between(places, places))
    assert_allclose(found[1], found[1].T, rtol=1e-9)
    assert found[1].mean() > found[0].mean()


def test_a_thin_solid_disc_twists_as_a_ring_on_its_journals():
    """Sections far thinner than they are wide cannot turn between the journals."""
    assert_allclose(solid_torsion(20.0, 35.0, 0.1) * 0.1, ring_torsion(20.0, 35.0), rtol=0.01)


def test_a_long_solid_shaft_twists_as_a_bar():
    """Even torque along a bar held at both ends: on average T b/(12 G J)."""
    polar_moment = 0.5 * math.pi * 35.0**4
    assert_allclose(solid_torsion(34.999, 35.0, 700.0), 700.0 / (12.0 * SHEAR_MODULUS * polar_moment), rtol=0.01)


def test_twist_of_a_solid_body_is_inverse_to_the_modulus_and_to_the_cube_of_its_size():
    steel = solid_torsion(20.0, 35.0, 25.0)
    assert_allclose(solid_torsion(20.0, 35.0, 25.0, Material(103000.0, 0.3)), 2.0 * steel, rtol=1e-9)
    assert_allclose(solid_torsion(200.0, 350.0, 250.0), 1e-3 * steel, rtol=1e-9)


@pytest.mark.thorough
def test_body_torsion_of_a_solid_gear_is_that_of_all_its_teeth_loaded_alike(monkeypatch):
    """A pure torque on the body in space; even layers of the rim resolve the edge of the journals."""
    model.cache_clear()
    monkeypatch.setattr(ring_geometry, "GROWTH", 1.0001)
    density = MeshDensity(through=2, flank=3, fillet=1, land=1, rim=8, lengthwise=8, neighbours=12)
    found = []
    for bore in (None, 0.0):
        gear = model(density, bore_diameter=bore)
        found.append(WIDTH * sum(between(gear, line(gear, 0.5), line(gear, 0.5, tooth=tooth)) for tooth in range(25)))
    model.cache_clear()
    torsion = [
        WIDTH * body_torsion(cylindrical_pair(spur_mesh(bore_diameters=(bore, None))))[0] for bore in (None, 0.0)
    ]
    assert_allclose(found[1] - found[0], 25.0 * (torsion[1] - torsion[0]), rtol=SINGULAR)
