from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from skfem import ElementHexS2, ElementQuadS2

from loaded_tca.compliance import gear_compliance
from loaded_tca.compliance.finite_elements import FACES, discretise, following, nodes_of
from loaded_tca.compliance.influence import forget
from loaded_tca.compliance.layout import RingLayout
from loaded_tca.material import Material
from tests.samples.bodies import COARSE, between, line, pinion, within

STEEL = Material()
ROUNDING = 1e-10  # energies and forces, sums over some thousand nodes of which parts cancel
OFFSETS = np.rint(2.0 * np.asarray(ElementHexS2().doflocs)).astype(int)
LOWEST = np.array([[0, 0, 0], [2, 0, 0], [2, 0, 2], [4, 0, 0]])
SPANS = np.array([2, 1, 1, 2])
THICKER = 2e-3
"""Change of the compliance by thicker layers beside the tooth: 0.06 % at most in ten layers."""


def row(rng, bend):
    """A row of three elements, of which the middle one is two; nodes may be off the middle of their edges."""
    grid = np.meshgrid(np.linspace(0.0, 3.0, 7), np.linspace(0.0, 1.0, 3), np.linspace(0.0, 2.0, 5), indexing="ij")
    points = np.stack(grid, axis=-1)
    points[3, ..., 0] += bend * rng.standard_normal(points[3].shape[:-1])
    points[2:5:2, :, 1:4:2] += bend * rng.standard_normal((2, 3, 2, 3))  # nodes that hang: of no account
    return discretise(np.concatenate([points, np.full((2, 3, 5, 3), np.nan)]), LOWEST, spans=SPANS)


def energy(mesh, displacement):
    flat = displacement.ravel()[mesh.dofs]
    return np.einsum("na,nab,nb->", flat, mesh.stiffness(STEEL)[mesh.kinds], flat)


@pytest.mark.parametrize("bend", [0.0, 0.03])
def test_rigid_and_even_motions_pass_between_thick_and_thin(rng, bend):
    mesh = row(rng, bend)
    x, y, z = mesh.points.T
    nu, modulus = STEEL.poisson_ratio, STEEL.youngs_modulus
    per_volume = modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    assert_allclose(energy(mesh, np.stack([x, 0.0 * x, 0.0 * x], axis=-1)), 6.0 * per_volume, rtol=ROUNDING)
    assert_allclose(energy(mesh, np.stack([0.0 * x, -z, y], axis=-1)), 0.0, atol=ROUNDING * per_volume)


def test_nodes_that_hang_are_no_unknowns(rng):
    mesh = row(rng, 0.0)
    hanging = np.zeros(mesh.number.shape, dtype=bool)
    hanging[2:5:2, :, 1:4:2] = True
    hanging[2:5:2, 1, 2] = True  # the middle of a thick face
    assert (mesh.number[hanging] == -1).all()
    assert len(mesh.points) == 20 + 6 + 20  # the thick ones, and edges along the row of the thin ones


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("half", [1, 2])
def test_a_thin_face_moves_as_the_thick_one_does(number, half):
    """Every displacement that eight nodes of a face can have, at the nodes of one half of it."""
    axis, value = FACES[number]
    code = np.zeros((1, 4), dtype=int)
    code[0, number] = half
    shares = following(code, OFFSETS, ElementQuadS2())[0]
    face = OFFSETS[:, axis] == value
    own, thick = OFFSETS[face, :] * [1.0, 1.0, 0.5] + [0.0, 0.0, half - 1.0], OFFSETS[face]
    for a, b in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2)):
        moved, expected = (p[:, 1 - axis] ** a * p[:, 2] ** b for p in (thick.astype(float), own))
        assert_allclose(shares[np.ix_(face, face)] @ moved, expected, atol=ROUNDING)
    assert_allclose(shares[~face], np.eye(20)[~face])


def test_faces_are_found_around_the_ring():
    lowest = np.array([[6, 0, 4], [0, 0, 4], [0, 0, 6]])
    _, hanging = nodes_of(lowest, np.array([2, 1, 1]), OFFSETS, 8)
    assert hanging.tolist() == [[0, 0, 0, 0], [1, 0, 0, 0], [2, 0, 0, 0]]


@pytest.mark.thorough
def test_thick_layers_beside_the_tooth_change_little(monkeypatch):
    gear, found = pinion(), []
    for bricks in (RingLayout.bricks, property(_thin)):
        forget()
        monkeypatch.setattr(RingLayout, "bricks", bricks)
        model = gear_compliance(gear, replace(COARSE, lengthwise=8))
        lines = line(model, 0.3), line(model, 0.7, tooth=1)
        alone = [within(model, height, part) for height in (0.1, 0.5, 0.9) for part in (0.3, 1.0)]
        found.append([*alone, between(model, *lines)])
    forget()
    assert_allclose(found[0], found[1], rtol=THICKER)


def _thin(layout):
    """All layers of elements alike."""
    section, layers = layout.elements, np.arange(layout.density.lengthwise)
    lowest = np.column_stack([np.tile(section, (len(layers), 1)), np.repeat(2 * layers, len(section))])
    return lowest, np.ones(len(lowest), dtype=int), np.tile(layout.blocks, len(layers))
