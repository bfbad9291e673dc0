import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.compliance import FlankLine, MeshDensity, gear_compliance, influence
from loaded_tca.compliance.body import gear_nodes
from loaded_tca.compliance.dissection import factorise
from loaded_tca.compliance.finite_elements import discretise
from loaded_tca.compliance.flexibility import depth_displacement
from loaded_tca.compliance.kept import MOST_IN_MEMORY
from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears.cylindrical import half_tooth
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.reference.weber_banaschek import ring_torsion, tooth_deflection
from loaded_tca.scene import FlankForm
from loaded_tca.scene.build import described_gear
from tests.samples.bodies import COARSE, PLACES, WEIGHTS, WIDTH, between, line, model, pinion, spur_mesh, within

HEIGHTS = (0.1, 0.5, 0.9)
CONVERGED = 0.015
"""Change of the whole compliance on a finer mesh: half as many elements more in most directions."""
BETTI = 0.03
"""Forces act on the flank, displacements are taken in the middle of the tooth: part of the coupling of two teeth."""
CLOSED_FORM = 0.15
"""Weber and Banaschek take the body for a half-plane."""
RING = 5e-3
"""One quadratic element to a pitch."""
ROUNDING = 1e-9  # solutions with stiffness matrices of finite elements, in another order


def whole(gear, height, part=1.0):
    return WIDTH * within(gear, height, part)


def below(gear, height):
    """Displacement of the middle of the tooth per line load [mm per N/mm]."""
    one = line(gear, height)
    return WIDTH * between(gear, one, one)


@pytest.mark.thorough
@pytest.mark.parametrize("height", HEIGHTS)
def test_compliance_is_converged(height):
    fine = model(MeshDensity(6, 8, 3, 3, 6, 5, 1))
    assert_allclose(whole(model(), height), whole(fine, height), rtol=CONVERGED)


@pytest.mark.thorough
@pytest.mark.parametrize("part", [1.0, 0.4])
def test_compliance_needs_no_more_layers(part):
    fine = model(replace(COARSE, lengthwise=10))
    assert_allclose(whole(model(replace(COARSE, lengthwise=5)), 0.6, part), whole(fine, 0.6, part), rtol=CONVERGED)


def test_compliance_of_both_sides_is_the_same():
    assert_allclose([whole(model(side=-1), h) for h in HEIGHTS], [whole(model(), h) for h in HEIGHTS], rtol=1e-5)


def test_compliance_grows_towards_the_tip():
    found = [whole(model(), height) for height in np.linspace(0.0, 1.0, 6)]
    assert (np.diff(found) > 0.0).all()


def test_a_short_line_gives_way_more_than_a_long_one():
    found = [whole(model(), 0.5, part) for part in (0.1, 0.3, 0.6, 1.0)]
    assert (np.diff(found) < 0.0).all()


def test_the_end_of_the_face_gives_way_more_than_its_middle():
    gear = model()
    ends = [within(gear, 0.5, 0.2, middle) for middle in (0.1, 0.5, 0.9)]
    assert ends[0] > 1.3 * ends[1]
    assert_allclose(ends[0], ends[2], rtol=1e-6)


def test_compliance_is_inverse_to_the_modulus():
    soft = gear_compliance(pinion(material=Material(103000.0, 0.3)), COARSE)
    assert_allclose(whole(soft, 0.5), 2.0 * whole(model(), 0.5), rtol=ROUNDING)


def test_coupling_of_two_teeth_is_reciprocal():
    """The finite elements alone: forces act on the flank, displacements are taken in the middle of the tooth."""
    gear = model()
    table, near = gear.table, gear.neighbours
    shape = (len(table.heights), len(table.lengths)) * 2
    forth, back = (table.displacement[near + away].reshape(shape).mean(axis=(1, 3)) for away in (1, -1))
    assert_allclose(forth[1:, 1:], back.T[1:, 1:], rtol=BETTI)  # above the foot, whose middle is in the body
    low, high = line(gear, 0.2), line(gear, 0.8, tooth=1)
    assert_allclose(gear.between(low, high), gear.between(high, low).T, rtol=ROUNDING)


@pytest.mark.parametrize(("low", "high"), [(0.1, 0.8), (0.4, 0.5), (0.0, 1.0)])
def test_two_teeth_are_positive_definite_together(low, high):
    gear = model()
    lines = line(gear, low), line(gear, high, tooth=1)
    coupling = between(gear, *lines)
    matrix = np.array([[within(gear, low), coupling], [coupling, within(gear, high)]])
    assert np.linalg.eigvalsh(matrix).min() > 0.0
    assert 0.0 < coupling < matrix[1, 1]


def test_displacements_within_a_tooth_are_symmetric():
    gear = model()
    one = line(gear, 0.6)
    found = gear.within(one, np.abs(one.z[:, None] - one.z))
    assert_allclose(found, found.T, rtol=ROUNDING)


def test_local_term_grows_towards_a_free_end_as_in_finite_elements_in_space():
    """What the flank gives way beyond a half-space with that end, over the same at mid-face, under an even load.

    Of the pair 25/37, 20 mm wide, at the pitch point, by the elements of ``validation/loaded/face_ends_space.py``; at
    other heights of a flank it differs by 0.1.
    """
    gear = model()
    one = line(gear, 0.5)
    apart, depth = np.abs(one.z[:, None] - one.z), gear.frame.places(np.array([0.5]), np.array([0.5])).depth
    local = gear.within(one, apart) - gear.between(one, one) + depth_displacement(depth, apart, Material())
    from_end, even = one.z - one.z.min() + 0.5 * WIDTH * (1.0 + PLACES[0]), local @ WEIGHTS
    assert_allclose(np.interp([0.6, 1.95, 4.75], from_end, even) / even[20], [1.47, 1.25, 1.04], atol=0.1)


def test_a_force_moves_what_is_near_more_than_what_is_far():
    """Bending spreads along the face: what is left of it at the other end is a small part."""
    gear = model()
    one = line(gear, 0.9)
    found = gear.between(one, one)
    assert found[20, 20] > 1.2 * found[20, 0] > 0.0
    assert found[0, 0] > 3.0 * found[0, -1]


def test_between_counts_teeth_around_the_gear():
    gear = model()
    near = gear.between(line(gear, 0.3), line(gear, 0.6, tooth=1))
    around = gear.between(line(gear, 0.3, tooth=24), line(gear, 0.6, tooth=25))
    assert_allclose(around, near, rtol=ROUNDING)


@pytest.mark.parametrize("tooth", [0, 1, -1])
def test_deflection_is_the_product_of_the_compliance_with_the_forces(tooth, rng):
    gear = model()
    at, under = line(gear, 0.3), line(gear, 0.6, tooth=tooth)
    forces = rng.random(under.rho.size)
    assert_allclose(gear.deflection(at, under, forces), gear.between(at, under) @ forces, rtol=ROUNDING)


def test_teeth_too_far_apart_are_refused():
    gear = model()
    with pytest.raises(InputError, match="2 pitches apart, the model has 1"):
        gear.between(line(gear, 0.3), line(gear, 0.6, tooth=2))


def test_places_beyond_the_flank_count_as_its_edge():
    gear = model()
    one = line(gear, 0.5)
    beyond = FlankLine(0, one.rho + 100.0, one.z)
    top = line(gear, 1.0)
    assert_allclose(gear.between(beyond, beyond), gear.between(top, top), rtol=1e-9)


@pytest.mark.quick_cases("bores0")
@pytest.mark.parametrize("bores", [(40.0, 30.0), (10.0, 6.0)])
def test_body_torsion_is_that_of_a_ring(bores):
    """All teeth loaded alike: a pure torque, of which two bores take the ring between them differently."""
    density = MeshDensity(through=2, flank=3, fillet=1, land=1, rim=4, lengthwise=1, neighbours=12)
    found = []
    for bore in bores:
        gear = model(density, bore_diameter=bore)
        middle = line(gear, 0.5)
        found.append(WIDTH * sum(between(gear, middle, line(gear, 0.5, tooth=tooth)) for tooth in range(25)))
    wound = 25.0 * spur_mesh().pinion.base_radius ** 2 * ring_torsion(0.5 * bores[1], 0.5 * bores[0])
    assert_allclose(found[1] - found[0], wound, rtol=RING)


def test_space_without_lengthwise_strain_is_the_plane():
    """One layer whose nodes do not move along the axis, against plane strain elements: an identity."""
    gear = pinion()
    density = replace(COARSE, lengthwise=1)
    nodes = gear_nodes(gear, density)
    section = nodes.layout.elements
    space = discretise(nodes.points, np.column_stack([section, np.zeros(len(section), dtype=int)]))
    plane = discretise(nodes.points[:, :, 0, :2], section)
    row = nodes.layout.base_row + 2 * (density.fillet + density.flank)
    corner = 2 * density.land + 2 * density.through
    found = []
    for mesh, share in ((space, WIDTH * np.array([1.0, 4.0, 1.0]) / 6.0), (plane, [1.0])):
        free = np.ones((len(mesh.points), mesh.dimension), dtype=bool)
        free[:, 2:] = False
        held = mesh.number[:, 0].ravel()
        free[held[held >= 0]] = False
        load = np.zeros((len(mesh.points), mesh.dimension))
        load[mesh.number[corner, row].ravel(), 1] = share
        factor = factorise(mesh.stiffness(gear.material), mesh.dofs, mesh.lowest // 2, free.ravel())
        solution = factor.solve(load.reshape(-1, 1)).reshape(load.shape)
        found.append(np.mean(solution[mesh.number[corner, row].ravel(), 1]))
    assert_allclose(found[0], found[1], rtol=1e-7)


@pytest.mark.parametrize("height", HEIGHTS)
def test_deflection_is_that_of_weber_and_banaschek(height):
    gear, cylinder = model(), spur_mesh().pinion
    parts = half_tooth(cylinder, 200)
    outline = np.concatenate([parts["fillet"][:0:-1], parts["flank"][::-1]])
    steps = np.diff(outline, axis=0)
    root = int(np.argmax(-steps[:, 1] < steps[:, 0]))  # where the fillet leans by 45 deg
    place = gear.frame.places(np.array([height]), np.array([0.5]))
    load_height = float(place.middle[0, 0] - outline[root, 0])
    load_angle = math.atan2(place.normal[0, 0], place.normal[0, 1])
    y, s = outline[root:, 0] - outline[root, 0], 2.0 * outline[root:, 1]
    expected = tooth_deflection(y, s, load_height, load_angle).total
    expected += cylinder.base_radius**2 * ring_torsion(0.55 * cylinder.root_radius, cylinder.root_radius)
    found = below(gear, height)
    assert_allclose(found, expected, rtol=CLOSED_FORM)
    assert found > expected


def test_variants_of_the_micro_geometry_share_one_model(monkeypatch):
    """Also of described flanks: the model is that of the teeth by their equations, without modifications."""
    built = []

    def counted(gear, density):
        built.append(gear)
        return gear_nodes(gear, density)

    monkeypatch.setattr(influence, "gear_nodes", counted)
    influence.forget()
    gears = [pinion(), *(crowned(amount) for amount in (0.004, 0.008))]
    gears.append(described_gear(gears[1], FlankForm(form="bspline"), "pinion", 1))
    found = [gear_compliance(gear, COARSE) for gear in gears]
    assert len(built) == 1
    assert all(one is found[0] for one in found)
    influence.forget()
    apart = gear_compliance(gears[-1], COARSE)
    influence.forget()
    # exact, also below: the same model made twice
    assert_array_equal(apart.table.displacement, found[0].table.displacement)
    one = line(apart, 0.4, 0.7)
    away = np.abs(one.z[:, None] - one.z)
    assert_array_equal(apart.within(one, away), found[0].within(one, away))


def crowned(amount):
    modifications = FlankModifications(lead_crowning=amount), FlankModifications()
    return cylindrical_pair(spur_mesh(), modifications=modifications).pinion


@pytest.mark.quick_cases("neighbours")  # test_flexibility_kept.py has what the key of a model depends on
@pytest.mark.parametrize(
    "other",
    [
        lambda: gear_compliance(pinion(bore_diameter=36.0), COARSE),
        lambda: gear_compliance(pinion(side=-1), COARSE),
        lambda: gear_compliance(pinion(material=Material(205000.0, 0.3)), COARSE),
        lambda: gear_compliance(pinion(width=21.0), COARSE),
        lambda: gear_compliance(pinion(), replace(COARSE, neighbours=2)),
    ],
    ids=["bore", "side", "modulus", "width", "neighbours"],
)
def test_another_gear_has_a_model_of_its_own(other):
    assert other().table is not gear_compliance(pinion(), COARSE).table


def test_only_the_last_models_stay_in_memory():
    assert influence._model.cache_info().maxsize == MOST_IN_MEMORY
