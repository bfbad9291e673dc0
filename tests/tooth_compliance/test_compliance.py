import math
import pickle
from functools import cache

import numpy as np
import pytest
from bodies import both_senses, pinion, spur_mesh
from numpy.testing import assert_allclose

from loaded_tca.bevel_pair import bevel_pair
from loaded_tca.errors import InputError
from loaded_tca.gears import bevel_mesh
from loaded_tca.loaded_contact import GridChoice, press
from loaded_tca.reference.iso6336 import theoretical_single_stiffness
from loaded_tca.reference.weber_banaschek import ring_wind_up
from loaded_tca.tooth import tooth_forms
from loaded_tca.tooth_compliance import MeshDensity, default_density, force_of_contact, pair_force, tooth_compliance
from loaded_tca.unloaded import trace_contact

COARSE = MeshDensity(lengthwise=4)
PITCH = 2.0 * math.pi / 25
STANDARD = 0.1
"""The standard's stiffness is an average of measurements."""


@cache
def made(helix_angle=0.0, sense=0):
    mesh = spur_mesh(helix_angle=math.radians(helix_angle))
    senses = both_senses(mesh)
    return tooth_compliance(tooth_forms(mesh), senses[sense], senses[1 - sense], density=COARSE)


@cache
def made_of_bevels():
    mesh = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0, spiral_angle=math.radians(30.0))
    pair, backs = (bevel_pair(mesh, sense=sense) for sense in ("positive", "negative"))
    return tooth_compliance(tooth_forms(mesh), pair, backs, density=COARSE)


def contacts(compliance, *parts, load=2000.0):
    """Pressed contacts at parts of a pitch from the pitch point."""
    path = trace_contact(compliance.pair, np.array(parts) * compliance.pair.pitch)
    return [press(compliance.pair, path[n], load, GridChoice(cells=(16, 32))) for n in range(len(parts))]


def test_stiffness_of_a_tooth_pair_is_that_of_the_standard():
    """ISO 6336-1: 0.8 c'_th in single contact, N/(mm um)."""
    compliance = made()
    loaded = contacts(compliance, 0.0)
    deflection = loaded[0].solution.approach / 2000.0 + compliance.matrix([0], loaded)[0, 0]
    stiffness = 1e-3 / (deflection * compliance.pair.face_width)
    assert_allclose(stiffness, 0.8 * theoretical_single_stiffness((25, 37), (0.0, 0.0)), rtol=STANDARD)


@pytest.mark.parametrize("make", [made, lambda: made(20.0), made_of_bevels], ids=["spur", "helical", "bevel"])
def test_matrix_is_symmetric_and_positive_definite(make):
    compliance = make()
    matrix = compliance.matrix([0, 1], contacts(compliance, 0.4, -0.4))
    assert matrix[0, 1] == matrix[1, 0] > 0.0
    assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_matrix_knows_which_tooth_comes_next():
    """Pair +1 is on the other side of both teeth than pair -1: numbers may be turned round, neighbours not."""
    compliance = made()
    first, second = contacts(compliance, 0.4, -0.4)
    forwards = compliance.matrix([0, 1], [first, second])
    assert_allclose(compliance.matrix([7, 8], [first, second]), forwards)
    assert_allclose(compliance.matrix([1, 0], [second, first]), forwards[::-1, ::-1])
    assert abs(compliance.matrix([1, 0], [first, second])[0, 1] - forwards[0, 1]) > 1e-3 * forwards[0, 1]


def test_matrix_of_the_other_sense_is_the_same():
    both = made(20.0), made(20.0, 1)
    matrices = [compliance.matrix([0, 1], contacts(compliance, 0.4, -0.4)) for compliance in both]
    assert_allclose(matrices[1], matrices[0], rtol=1e-4)  # the meshes and grids are no exact mirror images


def test_force_of_a_contact_lies_where_its_pressure_is():
    compliance = made()
    force = force_of_contact(compliance.pair, 3, contacts(compliance, 0.0)[0])
    rho, z = force.pinion
    assert force.pair == 3
    assert_allclose(force.weight.sum(), 1.0)
    assert_allclose(rho, 37.5, atol=1e-3)
    assert_allclose(force.weight @ z, 0.0, atol=1e-6)
    assert np.abs(z).max() <= 10.0
    assert force.distance.shape == (len(z), len(z))


def test_force_without_load_lies_on_the_contact_point():
    compliance = made()
    loaded = contacts(compliance, 0.0, load=0.0)[0]
    force = force_of_contact(compliance.pair, 0, loaded)
    assert_allclose(force.weight, [1.0])
    assert_allclose(force.pinion[0], loaded.contact.pinion_radius)


def test_a_smaller_bore_makes_the_pair_softer():
    mesh = spur_mesh()
    pair, backs = both_senses(mesh)
    small = tooth_compliance(tooth_forms(mesh), pair, backs, bore_diameters=(15.0, None), density=COARSE)
    loaded = contacts(small, 0.0)
    assert small.matrix([0], loaded)[0, 0] > made().matrix([0], loaded)[0, 0]
    assert small.bore_diameters[0] == 15.0
    assert_allclose(made().bore_diameters, [0.55 * 2.0 * gear.root_radius for gear in (mesh.pinion, mesh.wheel)])


def test_wind_up_is_a_part_of_the_compliance():
    compliance = made()
    loaded = contacts(compliance, 0.0)
    assert 0.0 < sum(compliance.wind_up) < 0.2 * compliance.matrix([0], loaded)[0, 0]
    pinion_radius = spur_mesh().pinion.root_radius
    expected = ring_wind_up(0.55 * pinion_radius, pinion_radius) * spur_mesh().pinion.base_radius ** 2 / 20.0
    assert_allclose(compliance.wind_up[0], expected)


def test_layers_follow_the_face_width():
    layers = [default_density(pinion(width=width)).lengthwise for width in (1.0, 20.0, 40.0, 1000.0)]
    assert layers == [6, 10, 20, 24]


def test_compliance_survives_pickling():
    compliance = made()
    loaded = contacts(compliance, 0.0)
    again = pickle.loads(pickle.dumps(compliance))
    assert_allclose(again.matrix([0], loaded), compliance.matrix([0], loaded))


def test_the_same_tooth_pair_twice_is_refused():
    compliance = made()
    with pytest.raises(InputError, match="twice"):
        compliance.matrix([1, 1], contacts(compliance, 0.4, -0.4))


def test_pairs_of_the_same_flanks_are_refused():
    mesh = spur_mesh()
    pair, _ = both_senses(mesh)
    with pytest.raises(InputError, match="backs"):
        tooth_compliance(tooth_forms(mesh), pair, pair)


def test_a_bore_that_reaches_the_teeth_names_its_gear():
    mesh = spur_mesh()
    pair, backs = both_senses(mesh)
    with pytest.raises(InputError, match="wheel: bore_diameter"):
        tooth_compliance(tooth_forms(mesh), pair, backs, bore_diameters=(None, 110.0), density=COARSE)


def test_forces_tell_every_problem():
    with pytest.raises(InputError, match=r"points: .*\nforce: "):
        pair_force(made().pair, 0, np.zeros((3, 2)), np.zeros(3))
