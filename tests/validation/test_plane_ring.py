"""The plane reference of the root stress: its elements, its loads, and its kept table."""

import math

import numpy as np
import pytest

from validation.calculix import plane_ring
from validation.calculix.tables import read_table

ROUNDING = 1e-12
COARSE = 0.32
# The largest stresses on elements sixteen times as wide as the kept ones: 1.5 % at the tip's load, 0.9 % and less else.
OF_COARSE = 0.02


def test_shape_functions_are_those_of_a_quadratic_quadrilateral():
    value, slope = plane_ring.shapes(0.3, -0.6)
    u, v = plane_ring.CORNERS.T
    for field, expected, along in ((u * 0 + 1, 1.0, (0, 0)), (u * v, -0.18, (-0.6, 0.3)), (u**2, 0.09, (0.6, 0.0))):
        assert value @ field == pytest.approx(expected)
        np.testing.assert_allclose(field @ slope, along, atol=ROUNDING)


def test_load_is_the_line_load_along_the_line_of_action():
    model, form = plane_ring.ring(COARSE), plane_ring.pinion()
    for radius in plane_ring.loaded_radii().values():
        forces = model.load(radius).reshape(-1, 2)
        x, y = model.mesh.nodes.T
        assert np.linalg.norm(forces.sum(axis=0)) == pytest.approx(plane_ring.LINE_LOAD, rel=ROUNDING)
        moment = float((x * forces[:, 1] - y * forces[:, 0]).sum())
        # Normals of an interpolated flank.
        assert -moment == pytest.approx(plane_ring.LINE_LOAD * form.base_radius, rel=2e-3)


def test_coarse_mesh_has_nearly_the_kept_stresses():
    kept = plane_ring.read()
    for row in plane_ring.measured(COARSE):
        if row["tooth"] == 0:
            name = "tension_MPa" if row["side"] == "loaded" else "compression_MPa"
            assert row[name] == pytest.approx(kept[row["load"], 0, row["side"]][name], rel=OF_COARSE)


def test_kept_meshes_converge():
    coarser, finest = (
        [row for row in read_table(plane_ring.FILE) if row["fillet_mm"] == size] for size in plane_ring.FILLETS[1:]
    )
    for one, other in zip(coarser, finest, strict=True):
        largest = "tension_MPa" if one["tension_MPa"] > -one["compression_MPa"] else "compression_MPa"
        if abs(other[largest]) > 20.0:  # beside the loaded tooth
            assert one[largest] == pytest.approx(other[largest], rel=2.5e-3)
    assert {row["load"] for row in finest} == set(plane_ring.loaded_radii())
    assert math.isclose(plane_ring.loaded_radii()["tip"], 40.5)
