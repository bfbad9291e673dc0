import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.tooth import TriangleMesh
from loaded_tca.tooth.surface import grid_triangles
from tests.refusals import refusals

CORNERS = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
TETRAHEDRON = TriangleMesh(CORNERS, FACES)


def test_tetrahedron_has_its_volume_and_area():
    assert_allclose(TETRAHEDRON.volume, 1.0)
    assert_allclose(TETRAHEDRON.area, 0.5 * (6.0 + 3.0 + 2.0 + 7.0))  # the slanted face: sqrt(2^2 + 3^2 + 6^2)
    assert TETRAHEDRON.is_closed


def test_volume_does_not_depend_on_the_place():
    axes = np.linalg.qr(np.arange(9.0).reshape(3, 3) + np.eye(3))[0]
    axes *= np.sign(np.linalg.det(axes))
    moved = TETRAHEDRON.moved(np.array([5.0, -7.0, 11.0]), axes)
    assert_allclose(moved.volume, 1.0, rtol=1e-12)  # twelve triangles, moved by some units: 9e-16 seen
    assert_allclose((moved.vertices[1] - moved.vertices[0]), 3.0 * axes[0])


@pytest.mark.parametrize(
    "faces",
    [FACES[:3], np.concatenate([FACES[:3], FACES[3:, ::-1]]), np.concatenate([FACES, FACES[:1]])],
    ids=["a hole", "a face turned over", "a face twice"],
)
def test_surface_with_a_fault_is_not_closed(faces):
    assert not TriangleMesh(CORNERS, faces).is_closed


def test_mirrored_mesh_keeps_its_outside_and_its_volume():
    mirrored = TETRAHEDRON.moved(np.array([0.0, 0.0, 2.0]), np.diag([1.0, 1.0, -1.0]))
    assert_allclose(mirrored.volume, 1.0)
    assert mirrored.is_closed
    assert_allclose(mirrored.vertices[3], [0.0, 0.0, 1.0])


def test_seams_are_borders_and_changes():
    corners = np.array([[x, y, 0.0] for x in range(3) for y in range(2)], dtype=float)
    faces = grid_triangles(np.arange(6).reshape(3, 2))
    mesh = TriangleMesh(corners, faces, cell_data={"patch": np.array([0, 0, 1, 1])})
    seams = mesh.seams("patch")
    assert len(seams) == 6 + 1
    inside = [seam for seam in seams if (seam[:, 0] == 1.0).all()]
    assert len(inside) == 1


def test_grid_triangles_leave_out_those_without_area():
    """A strip that ends in a point: one triangle less."""
    assert_array_equal(grid_triangles(np.array([[0, 1], [2, 2]])), [[0, 2, 1]])
    assert len(grid_triangles(np.array([[0, 1], [2, 3]]))) == 2


test_misshapen_parts_are_refused = refusals(
    lambda changes: TriangleMesh(**{"vertices": CORNERS, "triangles": FACES, **changes}),
    ({"vertices": CORNERS[:, :2]}, r"vertices: shape \(4, 2\) is not \(n, 3\)"),
    ({"triangles": FACES.ravel()}, r"triangles: shape \(12,\) is not"),
    ({"vertices": np.where(CORNERS == 3.0, np.nan, CORNERS)}, "vertices: not all are finite"),
    ({"triangles": FACES + 1}, "triangles: indices are not within 0 to 3"),
    ({"triangles": FACES - 1}, "triangles: indices are not within 0 to 3"),
    ({"point_data": {"height": np.zeros(3)}}, r"point data height: shape \(3,\) is not \(4,\)"),
    ({"cell_data": {"patch": np.zeros((4, 1))}}, r"cell data patch: shape \(4, 1\) is not \(4,\)"),
)


def test_repr_is_short():
    assert repr(TETRAHEDRON) == "TriangleMesh(4 vertices, 4 triangles)"
