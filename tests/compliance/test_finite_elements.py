from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from skfem import Basis, ElementQuadS2, ElementVector, MeshQuad, MeshQuad2, asm
from skfem.models.elasticity import lame_parameters, linear_elasticity

from loaded_tca.compliance.body import gear_nodes
from loaded_tca.compliance.finite_elements import discretise
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.compliance.root_stress import surface_places
from loaded_tca.errors import GeometryError
from loaded_tca.gears import bevel_mesh
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import bevel_pair
from tests.samples.bodies import WIDTH, pinion

STEEL = Material()
ROUNDING = 1e-10  # energies, sums over some thousand nodes of which parts cancel
COARSE_OUTLINE = 5e-3
"""The outline through the nodes, straight in between, against the curved one of the elements."""
DENSITY = MeshDensity(2, 2, 1, 1, 2, 1, 0)


def body():
    nodes = gear_nodes(pinion(), DENSITY)
    lowest = nodes.layout.elements
    return discretise(nodes.points, np.column_stack([lowest, np.zeros(len(lowest), dtype=int)]))


def energies(mesh, displacement):
    flat = displacement.ravel()[mesh.dofs]
    return np.einsum("na,nab,nb->n", flat, mesh.stiffness(STEEL)[mesh.kinds], flat)


def test_rigid_motions_cost_no_energy():
    mesh = body()
    x, y, _ = mesh.points.T
    stretched = energies(mesh, np.stack([x, 0.0 * x, 0.0 * x], axis=-1)).sum()
    for motion in (np.ones((len(x), 3)), np.stack([-y, x, 0.0 * x], axis=-1)):
        assert np.abs(energies(mesh, motion)).sum() < ROUNDING * stretched


def test_energy_of_an_even_stretch_is_that_of_the_volume():
    mesh = body()
    nu, modulus = STEEL.poisson_ratio, STEEL.youngs_modulus
    per_volume = modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    gear = pinion()
    nodes = gear_nodes(gear, DENSITY)
    outline = np.concatenate([_top(nodes, sector)[:-1] for sector in nodes.layout.sectors])
    area = 0.5 * _cross(outline, np.roll(outline, -1, axis=0)).sum() - np.pi * (0.5 * gear.smallest_bore) ** 2
    energy = energies(mesh, np.stack([0.0 * mesh.points[:, 0]] * 2 + [mesh.points[:, 2]], axis=-1)).sum()
    assert_allclose(energy / per_volume, WIDTH * area, rtol=COARSE_OUTLINE)


def _top(nodes, sector):
    """Outline of a sector in order, at the first section."""
    rows = np.isfinite(nodes.radius[..., 0])
    columns = (sector.first + np.arange(2 * sector.columns + 1)) % rows.shape[0]
    points = nodes.points[:, :, 0, :2]
    if sector.density is None:
        return points[columns, nodes.layout.base_row]
    land, wide = 2 * sector.density.land, 2 * sector.density.through
    left, right, inner = columns[land], columns[land + wide], columns[land : land + wide + 1]
    base, top = nodes.layout.base_row, int(rows[left].sum()) - 1
    return np.concatenate(
        [
            points[columns[:land], base],
            points[left, base:top],
            points[inner, top],
            points[right, base:top][::-1],
            points[columns[land + wide + 1 :], base],
        ]
    )


def _cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def test_stiffness_is_that_of_the_library(rng):
    points = np.stack(np.meshgrid(np.linspace(0, 3, 7), np.linspace(0, 2, 5), indexing="ij"), axis=-1)
    points = points + 0.02 * rng.standard_normal(points.shape)
    edges = points[:-1:2, 1::2] + points[2::2, 1::2] + points[1::2, :-1:2] + points[1::2, 2::2]
    corners = points[:-1:2, :-1:2] + points[2::2, :-1:2] + points[:-1:2, 2::2] + points[2::2, 2::2]
    points[1::2, 1::2] = 0.5 * edges - 0.25 * corners  # nine nodes then say no more than eight
    open_end = np.concatenate([points, np.full((2, 5, 2), np.nan)])  # a strip, not a ring
    lowest = 2 * np.stack(np.meshgrid(np.arange(3), np.arange(2), indexing="ij"), axis=-1).reshape(-1, 2)
    mesh = discretise(open_end, lowest)
    grid = MeshQuad2.from_mesh(MeshQuad.init_tensor(np.arange(4.0), np.arange(3.0)))
    whole = np.rint(2.0 * grid.doflocs).astype(int)
    curved = MeshQuad2(np.ascontiguousarray(points[whole[0], whole[1]].T), grid.t)
    basis = Basis(curved, ElementVector(ElementQuadS2()), intorder=4)
    place = np.rint(2.0 * Basis(grid, ElementVector(ElementQuadS2())).doflocs).astype(int)
    component = np.zeros(basis.N, dtype=int)
    component[basis.split_indices()[1]] = 1
    displacement = points**2 @ np.array([[1.0, 0.3], [-0.2, 0.5]])
    vector = displacement[place[0], place[1], component]
    expected = vector @ asm(linear_elasticity(*lame_parameters(206000.0, 0.3)), basis) @ vector
    nodal = np.zeros_like(mesh.points)
    used = mesh.number >= 0
    nodal[mesh.number[used]] = np.concatenate([displacement, np.zeros((2, 5, 2))])[used]
    assert_allclose(energies(mesh, nodal).sum(), expected, rtol=ROUNDING)


def test_pitches_of_a_rim_are_of_one_kind():
    """Whatever the tooth: one column of elements, in one layer of a spur gear, serves for the whole rim."""
    nodes = gear_nodes(pinion(), replace(DENSITY, lengthwise=2))
    lowest = nodes.layout.elements
    layers = np.repeat([0, 2], len(lowest))
    mesh = discretise(nodes.points, np.column_stack([np.tile(lowest, (2, 1)), layers]), nodes.layout.turns)
    bare = np.tile(nodes.layout.blocks == nodes.layout.blocks.max(), 2)
    assert len(np.unique(mesh.kinds[bare])) == DENSITY.rim
    assert len(np.unique(mesh.kinds)) == len(np.unique(mesh.kinds[: len(lowest)]))


def test_energy_does_not_depend_on_the_frames(rng):
    nodes = gear_nodes(pinion(), DENSITY)
    lowest = nodes.layout.elements
    lowest = np.column_stack([lowest, np.zeros(len(lowest), dtype=int)])
    turned, plain = (discretise(nodes.points, lowest, turns) for turns in (nodes.layout.turns, None))
    displacement = rng.standard_normal(plain.points.shape)
    columns = np.empty(len(plain.points), dtype=int)
    columns[plain.number[plain.number >= 0]] = np.nonzero(plain.number >= 0)[0]
    cosine, sine = np.cos(nodes.layout.turns[columns]), np.sin(nodes.layout.turns[columns])
    x, y, z = displacement.T
    local = np.stack([cosine * x + sine * y, cosine * y - sine * x, z], axis=-1)
    assert_allclose(energies(turned, local), energies(plain, displacement), rtol=ROUNDING)


def test_an_element_inside_out_is_refused():
    points = np.stack(np.meshgrid(np.arange(7.0), np.arange(3.0), indexing="ij"), axis=-1)
    points[0, 0] = [3.0, 3.0]
    mesh = discretise(points, np.array([[0, 0], [2, 0]]))
    with pytest.raises(GeometryError, match="inside out"):
        mesh.stiffness(STEEL)


def strained(gear, strain, side):
    """Points (n, m, 3) and tangent angles of a foot, and the stress there of an even strain of the whole body."""
    nodes = gear_nodes(gear, MeshDensity(4, 2, 2, 3, 3, 6, 1, 2.0, 0.02, True))
    lowest, spans, _ = nodes.layout.bricks
    mesh = discretise(nodes.points, lowest, nodes.layout.turns, spans)
    columns = np.empty(len(mesh.points), dtype=int)
    columns[mesh.number[mesh.number >= 0]] = np.nonzero(mesh.number >= 0)[0]
    cosine, sine = np.cos(nodes.layout.turns[columns]), np.sin(nodes.layout.turns[columns])
    x, y, z = strain @ mesh.points.T
    displacement = np.stack([cosine * x + sine * y, cosine * y - sine * x, z], axis=-1)
    point, rows, angle = surface_places(mesh, nodes, side, STEEL)
    return point, angle, (rows @ displacement.ravel()).reshape(point.shape[1], point.shape[0]).T


@pytest.mark.parametrize("side", [1, -1])
def test_stress_of_a_free_surface_is_that_of_its_strain_across_and_along(side, rng):
    """Elements have even strains exactly, next to turned pitches and thick layers, too."""
    strain = rng.standard_normal((3, 3))
    strain += strain.T
    _, angle, stress = strained(pinion(), strain, side)
    across = np.stack([-np.cos(angle), side * np.sin(angle), 0.0 * angle], axis=-1)
    expected = np.einsum("...a,ab,...b->...", across, strain, across) + STEEL.poisson_ratio * strain[2, 2]
    expected *= STEEL.plane_strain_modulus
    assert_allclose(stress, expected, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("side", [1, -1])
def test_stress_of_a_free_surface_of_a_bevel_gear_in_an_even_growth_is_the_same_everywhere(side):
    gear = bevel_pair(bevel_mesh((20, 40), outer_module=4.0, face_width=12.0, spiral_angle=0.5)).pinion
    _, _, stress = strained(gear, np.eye(3), side)
    assert_allclose(stress, STEEL.youngs_modulus / (1.0 - STEEL.poisson_ratio), rtol=1e-9)
