import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

from loaded_tca.errors import GeometryError
from loaded_tca.material import Material
from loaded_tca.tooth_compliance.dissection import factorise
from loaded_tca.tooth_compliance.finite_elements import discretise

ROUNDING = 1e-9


def ring(columns=12, rows=4):
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * columns, endpoint=False)[:, None]
    radius = np.linspace(1.0, 2.0, 2 * rows + 1)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    lowest = 2 * np.stack(np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"), axis=-1).reshape(-1, 2)
    return discretise(points, lowest)


def free_unknowns(mesh):
    free = np.ones((len(mesh.points), 2), dtype=bool)
    free[mesh.number[:, 0][mesh.number[:, 0] >= 0]] = False
    return free.ravel()


def test_solution_is_that_of_a_sparse_solver(rng):
    mesh = ring()
    matrices, free = mesh.stiffness(Material()), free_unknowns(mesh)
    loads = rng.standard_normal((len(free), 3))
    found = factorise(matrices, mesh.dofs, mesh.lowest // 2, free).solve(loads)
    width = mesh.dofs.shape[1]
    rows, columns = np.repeat(mesh.dofs, width, axis=1).ravel(), np.tile(mesh.dofs, (1, width)).ravel()
    whole = coo_array((matrices.ravel(), (rows, columns))).tocsr()
    expected = spsolve(whole[free][:, free].tocsc(), loads[free])
    assert_allclose(found[free], expected, atol=ROUNDING * np.abs(expected).max())
    assert not found[~free].any()


def test_a_body_that_is_not_held_is_refused():
    mesh = ring()
    free = np.ones(2 * len(mesh.points), dtype=bool)
    with pytest.raises(GeometryError, match="not held"):
        factorise(mesh.stiffness(Material()), mesh.dofs, mesh.lowest // 2, free)
