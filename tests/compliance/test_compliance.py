import math
import pickle
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import root_scalar

from loaded_tca.compliance import MeshDensity, default_density, flank_lines, tooth_compliance
from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear_pair import MovedSlices
from loaded_tca.reference.iso6336 import theoretical_single_stiffness
from loaded_tca.reference.weber_banaschek import ring_torsion
from loaded_tca.scene import read_scene
from loaded_tca.separation import sample_separation
from loaded_tca.unloaded import trace_contact
from tests.samples.bodies import pinion, spur_mesh, within

COARSE = MeshDensity(lengthwise=4)
SCENES = Path(__file__).parents[2] / "examples" / "scenes"
PITCH = 2.0 * math.pi / 25
STANDARD = 0.1
"""The standard's stiffness is an average of measurements."""
ROUNDING = 1e-9  # solutions with stiffness matrices of finite elements, in another order
MET = 1e-7
"""Lengths [mm], to which flanks are met."""
CONVERGED = 0.02


@cache
def made(helix_angle=0.0, sense="positive"):
    mesh = spur_mesh(helix_angle=math.radians(helix_angle))
    return tooth_compliance(cylindrical_pair(mesh, sense=sense), density=COARSE)


@cache
def made_of_bevels():
    mesh = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0, spiral_angle=math.radians(30.0))
    return tooth_compliance(bevel_pair(mesh), density=COARSE)


@cache
def made_of_face_milled(density=COARSE):
    pair = read_scene(SCENES / "face_milled_19x62_matched.toml").pair()
    return tooth_compliance(pair, density=density)


FAMILIES = pytest.mark.parametrize(
    "make",
    [made, lambda: made(20.0), made_of_bevels, made_of_face_milled],
    ids=["spur", "helical", "bevel", "face-milled"],
)


def grids(compliance, *parts, cells=(8, 32), length=10.0):
    """Grids of contacts at parts of a pitch from the pitch point."""
    path = trace_contact(compliance.pair, np.array(parts) * compliance.pair.pitch)
    return [sample_separation(compliance.pair, path[n], cells=cells, box=(0.2, length)) for n in range(len(parts))]


def matrix(compliance, grids_by_pair):
    """Mean compliance of tooth pairs under forces spread evenly over their grids."""
    known = sorted(grids_by_pair.items())
    return np.array(
        [
            [
                (compliance.within(i, one) if i == j else compliance.between((i, one), (j, other))).mean()
                for j, other in known
            ]
            for i, one in known
        ]
    )


def test_bending_does_not_depend_on_the_axes_of_the_grid():
    """The same forces at the same places, on a grid whose slices lie along them and on one turned by ten degrees."""
    compliance, turn = made(20.0), math.radians(10.0)
    (straight,) = grids(compliance, 0.0)
    turned_axes = straight.axes.copy()
    turned_axes[0] = math.cos(turn) * straight.axes[0] - math.sin(turn) * straight.axes[1]
    turned_axes[1] = math.sin(turn) * straight.axes[0] + math.cos(turn) * straight.axes[1]
    askew = replace(straight, axes=turned_axes, y=straight.y * math.cos(turn), force_line=-straight.y * math.sin(turn))
    assert_allclose(compliance.within(0, askew), compliance.within(0, straight), rtol=ROUNDING)
    (next_pair,) = grids(compliance, 0.5)
    one, other = (compliance.between((0, grid), (1, next_pair)) for grid in (askew, straight))
    assert_allclose(one, other, rtol=ROUNDING)


def test_stiffness_of_a_tooth_pair_is_that_of_the_standard():
    """ISO 6336-1: 0.8 c'_th in single contact, N/(mm um)."""
    compliance = made()
    contact = trace_contact(compliance.pair, [0.0])[0]
    loaded = solve_under_load(compliance.pair, contact, 2000.0, GridChoice(cells=(16, 32)), compliance)
    stiffness = 1e-3 * 2000.0 / (loaded.solution.approach * compliance.pair.face_width)
    assert_allclose(stiffness, 0.8 * theoretical_single_stiffness((25, 37), (0.0, 0.0)), rtol=STANDARD)


@pytest.mark.quick_cases("bevel")
@FAMILIES
def test_compliance_is_symmetric_and_positive_definite(make):
    compliance = make()
    first, second = grids(compliance, 0.4, -0.4, length=4.0)
    assert_allclose(compliance.within(0, first), compliance.within(0, first).T, rtol=ROUNDING)
    forth, back = compliance.between((0, first), (1, second)), compliance.between((1, second), (0, first))
    assert_allclose(forth, back.T, rtol=ROUNDING)
    assert np.linalg.eigvalsh(matrix(compliance, {0: first, 1: second})).min() > 0.0


@pytest.mark.quick_cases("spur", "helical", "bevel")
@FAMILIES
def test_compliance_knows_which_tooth_comes_next(make):
    """Pair +1 is on the other side of both teeth than pair -1: numbers may be turned round, neighbours not."""
    compliance = make()
    first, second = grids(compliance, 0.4, -0.4)
    forwards = compliance.between((0, first), (1, second))
    assert_allclose(compliance.between((7, first), (8, second)), forwards)
    assert_allclose(compliance.between((1, second), (0, first)), forwards.T)
    assert abs(compliance.between((1, first), (0, second)).mean() - forwards.mean()) > 1e-3 * forwards.mean()


def bent(compliance, contacts, state, forces):
    """Deflection of slices under forces on those of all contacts of the same state, by the matrices."""
    forces, deflections = np.split(forces, np.cumsum([len(grid.y) for _, grid in contacts])[:-1]), []
    for at, own in zip(contacts, state, strict=True):
        grown = np.zeros(len(at[1].y))
        for under, other, force in zip(contacts, state, forces, strict=True):
            if under[0] == at[0] and own == other:
                grown += compliance.within(*at) @ force
            elif own == other and abs(under[0] - at[0]) <= compliance.neighbours:
                grown += compliance.between(at, under) @ force
        deflections.append(grown)
    return np.concatenate(deflections)


def turned(pair, shift, turn):
    """The pair whose wheel has moved [mm] and turned about the axes of the fixed frame [rad]."""
    x, y, z = turn
    rotation = np.eye(3) + np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return replace(pair, wheel_origin=pair.wheel_origin + shift, wheel_axes=pair.wheel_axes @ rotation.T)


@pytest.mark.quick_cases("helical", "bevel")
@FAMILIES
def test_deflection_grows_as_differences_say_where_the_wheel_and_the_grids_move(make, rng):
    """Lines that run over the tip, a tooth pair too far from the others to couple, slices without force."""
    compliance, step = make(), 1e-5
    pair, numbers, state = compliance.pair, (0, 1, 3, 0), np.array([0, 0, 0, 1])
    known = [*grids(compliance, 0.4, cells=(8, 20)), *grids(compliance, -0.4, 0.1, -0.1, cells=(8, 24), length=4.0)]
    forces = rng.random(20 + 3 * 24)
    forces[[3, 25]] = 0.0
    # of 1 mm and 0.01 rad: by larger ways lines cross places between which the local term is interpolated
    ways = rng.normal(size=(2, 2, 3)) * [[1.0], [1e-2]]
    keys = [
        MovedSlices((turned(pair, *(-0.5 * step * way)), known), (turned(pair, *(0.5 * step * way)), known), step)
        for way in ways
    ]
    shifts = rng.normal(size=(len(known), 3))
    below, above = (
        [replace(grid, origin=grid.origin + part * step * way) for grid, way in zip(known, shifts, strict=True)]
        for part in (-0.5, 0.5)
    )
    keys.append(MovedSlices((pair, below), (pair, above), step))
    found = compliance.deflection_growth([*zip(numbers, known, strict=True)], state, forces, keys)
    for one, growth in zip(keys, found, strict=True):
        low, high = (
            bent(compliance.mounted(gears), [*zip(numbers, map(replace, there), strict=True)], state, forces)
            for gears, there in (one.low, one.high)
        )
        expected = np.where(forces > 0.0, (high - low) / step, 0.0)
        # the deflection is known to 1e-15 of its 1e-5 mm, and differences over 1e-5 mm leave the square of that
        assert_allclose(growth, expected, rtol=0, atol=1e-6 * np.abs(expected).max())


@pytest.mark.thorough
def test_compliance_of_face_milled_gears_is_converged():
    """On a mesh of about half as many elements more in every direction of the section; its fillets are sharp."""
    densities = MeshDensity(lengthwise=6), MeshDensity(6, 8, 3, 5, 6, 6, 1)
    coarse, fine = (made_of_face_milled(density) for density in densities)
    found = [one.within(0, grids(one, 0.0)[0]).mean() for one in (coarse, fine)]
    assert_allclose(found[0], found[1], rtol=CONVERGED)


def test_face_milled_teeth_bend_more_at_their_ends_and_under_the_modulus_of_half():
    """Toe and heel are free: an even line near either gives way more than in the middle of the face."""
    gear = made_of_face_milled().wheel
    middle, toe, heel = (within(gear, 0.5, 0.2, place) for place in (0.5, 0.1, 0.9))
    assert min(toe, heel) > 1.1 * middle
    pair = made_of_face_milled().pair
    soft = replace(pair, wheel=replace(pair.wheel, material=Material(103000.0, 0.3)))
    assert_allclose(within(tooth_compliance(soft, density=COARSE).wheel, 0.5), 2.0 * within(gear, 0.5), rtol=ROUNDING)


@pytest.mark.thorough
def test_compliance_of_the_other_sense_is_the_same():
    both = made(20.0), made(20.0, "negative")
    found = [matrix(one, dict(enumerate(grids(one, 0.4, -0.4)))) for one in both]
    assert_allclose(found[1], found[0], rtol=1e-4)  # the meshes and grids are no exact mirror images


@pytest.mark.thorough
def test_a_smaller_bore_makes_the_pair_softer():
    mesh = spur_mesh(bore_diameters=(15.0, None))
    small = tooth_compliance(cylindrical_pair(mesh), density=COARSE)
    grid = grids(small, 0.0)[0]
    assert small.within(0, grid).mean() > made().within(0, grid).mean()
    assert small.pair.rigid_bores[0] == 15.0
    assert_allclose(made().pair.rigid_bores, [0.55 * 2.0 * gear.root_radius for gear in (mesh.pinion, mesh.wheel)])


def test_body_torsion_is_a_part_of_the_compliance():
    compliance = made()
    assert 0.0 < sum(compliance.body_torsion) < 0.2 * compliance.within(0, grids(compliance, 0.0)[0]).mean()
    pinion_radius = spur_mesh().pinion.root_radius
    expected = ring_torsion(0.55 * pinion_radius, pinion_radius) * spur_mesh().pinion.base_radius ** 2 / 20.0
    assert_allclose(compliance.body_torsion[0], expected)


@pytest.mark.parametrize("soft", [0, 1])
def test_each_gear_bends_with_its_own_modulus(soft):
    """Of two equal gears at the pitch point each gives half of the compliance; half the modulus doubles its part."""
    mesh = CylindricalMesh(*(CylindricalGear(25, 3.0, 20.0) for _ in range(2)))
    moduli = np.array([[206000.0, 206000.0], [206000.0, 206000.0]])
    moduli[1, soft] *= 0.5
    plain, mixed = (
        tooth_compliance(cylindrical_pair(mesh, materials=(Material(first), Material(second))), density=COARSE)
        for first, second in moduli
    )
    before, after = (one.within(0, grids(one, 0.0)[0]) for one in (plain, mixed))
    assert_allclose(after, 1.5 * before, rtol=1e-4)  # the meshes of two flanks of one gear are no mirror images
    torsion = np.array(plain.body_torsion)
    torsion[soft] *= 2.0
    assert_allclose(mixed.body_torsion, torsion, rtol=ROUNDING)


def test_layers_follow_the_face_width():
    layers = [default_density(pinion(width=width)).lengthwise for width in (1.0, 20.0, 40.0, 1000.0)]
    assert layers == [6, 10, 20, 24]


def test_compliance_survives_pickling():
    compliance = made()
    grid = grids(compliance, 0.0)[0]
    again = pickle.loads(pickle.dumps(compliance))
    assert_allclose(again.within(0, grid), compliance.within(0, grid))


def test_a_bore_that_reaches_the_teeth_names_its_gear():
    pair = cylindrical_pair(spur_mesh(bore_diameters=(None, 103.0)))
    with pytest.raises(InputError, match=r"wheel: bore_diameter: .* no rim is left"):
        tooth_compliance(pair, density=COARSE)


@pytest.mark.parametrize(("member", "ratio"), [("pinion", 0.5), ("wheel", 0.4901)])
def test_material_that_keeps_its_volume_is_refused(member, ratio):
    """Finite elements of displacements lock: without a bound they divide by zero at 0.5."""
    materials = [Material(poisson_ratio=ratio if name == member else 0.49) for name in ("pinion", "wheel")]
    pair = cylindrical_pair(spur_mesh(), materials=tuple(materials))
    with pytest.raises(
        InputError, match=f"^{member}: poisson_ratio: {ratio} is above 0.49: finite elements would lock$"
    ):
        tooth_compliance(pair, density=COARSE)


@pytest.mark.parametrize("made_of", [made_of_bevels, made_of_face_milled])
def test_forces_act_on_the_flanks_however_far_from_the_contact_point(made_of):
    """Flanks of spiral teeth leave the tangent plane of their contact point; roots along its normal, one by one."""
    pair = made_of().pair
    contact = trace_contact(pair, [0.0])[0]
    grid = sample_separation(pair, contact, cells=(8, 9), box=(0.1, 0.6 * pair.face_width))
    on_pinion, on_wheel = flank_lines(pair, 0, grid)
    farthest = 0.0
    for n, y in enumerate(grid.y):
        start = grid.origin + grid.force_line[n] * grid.axes[0] + y * grid.axes[1]

        def off(way, start=start):
            x, y, z = start + way * contact.normal
            theta = pair.pinion.flank.theta(np.array(np.hypot(x, y)), np.array(z)).value
            return math.remainder(math.atan2(y, x) - float(theta) - pair.sense * contact.pinion_angle, 2.0 * math.pi)

        way = root_scalar(off, bracket=(-2.0, 2.0), xtol=1e-12).root
        point, farthest = start + way * contact.normal, max(farthest, abs(way))
        radius, _, axial = pair.to_wheel(point)
        assert_allclose((on_pinion.rho[n], on_pinion.z[n]), (np.hypot(*point[:2]), point[2]), rtol=0, atol=MET)
        assert_allclose((on_wheel.rho[n], on_wheel.z[n]), (radius, axial), rtol=0, atol=MET)
    assert farthest > 0.05


def test_mirrored_gears_have_the_same_layers():
    """Flanks of hypoid gears are not of one height, and the hand exchanges them."""
    scene = read_scene("examples/scenes/hypoid_13x42.toml")
    mirrored = scene.with_changes({"pinion.blank.hand": "right", "wheel.blank.hand": "left"})
    layers = [
        [default_density(gear).lengthwise for gear in (pair.pinion, pair.wheel)]
        for pair in (scene.pair(), mirrored.pair())
    ]
    assert layers[0] == layers[1]


@pytest.mark.quick_cases("bevel")
@FAMILIES
def test_compliance_of_a_contact_does_not_depend_on_those_beside_it(make):
    """To the last bit, with other slices and on other teeth; lines that were found before are taken as they are."""
    compliance = make()
    first, second = grids(compliance, 0.4, -0.4, length=4.0)
    (coarse,) = grids(compliance, 0.1, cells=(8, 16), length=4.0)
    contacts = [(0, first), (1, coarse), (1, second), (0, second)]
    together = compliance.within_each(contacts)
    for (number, grid), matrix in zip(contacts, together, strict=True):
        assert_array_equal(compliance.within(number, replace(grid)), matrix)
        assert_array_equal(compliance.within(number, grid), matrix)
