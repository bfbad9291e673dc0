import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.gears.cylindrical import transverse_profile
from loaded_tca.tooth import PATCHES, Resolution
from loaded_tca.tooth.surface import CLOSING
from tests.refusals import refused_calls
from tests.samples.teeth import CROWNED, MESHES, tooth_of

ROUNDING = 1e-12
"""Of volumes, sums over some thousand triangles: 1e-15 was seen."""


def shoelace(points):
    x, y = points.T
    return 0.5 * float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum())


@pytest.mark.quick_cases(every=5)
@pytest.mark.parametrize("copies", [1, 3, None])
@pytest.mark.parametrize("name", MESHES)
def test_closed_teeth_have_no_open_edge(name, copies):
    tooth = tooth_of(MESHES[name], 0, CROWNED)
    solid = tooth.triangles(copies or tooth.teeth, closed=True)
    assert solid.is_closed
    assert solid.volume > 0.0


@pytest.mark.parametrize("name", MESHES)
def test_open_teeth_are_open_at_their_borders_only(name):
    tooth = tooth_of(MESHES[name])
    seams = tooth.triangles().seams("patch")
    n, m, _ = tooth.outline.shape
    inner = (len(PATCHES) - 1) * (m - 1)
    assert len(seams) == 2 * (n - 1) + 2 * (m - 1) + inner
    assert not tooth.triangles().is_closed


@pytest.mark.parametrize("name", ["spur", "straight bevel"])
def test_volume_of_the_ring_is_that_of_its_teeth(name):
    """Flat cuts through straight teeth: nothing is lost between neighbours."""
    tooth = tooth_of(MESHES[name])
    one, ring = (tooth.triangles(copies, closed=True).volume for copies in (1, tooth.teeth))
    assert_allclose(ring, tooth.teeth * one, rtol=ROUNDING)


def test_volume_of_a_spur_tooth_is_its_section_times_the_face_width():
    gear, errors = MESHES["spur"].pinion, []
    for points in (33, 65):
        tooth = tooth_of(MESHES["spur"], resolution=Resolution(points, points, points, 3))
        foot, outline = tooth.foot[:, 0, :2], tooth.outline[:, 0, :2]
        section = abs(shoelace(np.concatenate([foot[::-1], outline, foot[1:]])))
        assert_allclose(tooth.triangles(closed=True).volume, section * gear.face_width, rtol=ROUNDING)
        inner = float(np.linalg.norm(foot[0]))
        half = transverse_profile(gear, 2001, inner)
        rim = 0.5 * inner**2 * (2.0 * math.pi / gear.teeth - math.sin(2.0 * math.pi / gear.teeth))  # arc over chord
        errors.append(abs(section - 2.0 * shoelace(half) - rim))
    assert errors[1] < 0.3 * errors[0]  # second order: chords for curves
    assert errors[1] < 1e-3


def test_normals_point_out_of_the_tooth():
    """Out of the flanks along their azimuthal part, out of the lands away from the axis."""
    mesh = tooth_of(MESHES["spiral bevel"]).triangles()
    middle, normal = mesh.corners.mean(axis=1), mesh.normals
    azimuthal = middle[:, 0] * normal[:, 1] - middle[:, 1] * normal[:, 0]
    of = {name: mesh.cell_data["patch"] == number for number, name in enumerate(PATCHES)}
    assert (azimuthal[of["flank +"]] > 0.0).all()
    assert (azimuthal[of["flank -"]] < 0.0).all()
    radial = (middle[:, :2] * normal[:, :2]).sum(axis=1)
    for name in ("tip land", "root land -", "root land +"):
        assert (radial[of[name]] > 0.0).all()


def test_ends_of_a_closed_spur_tooth_are_flat_and_face_outwards():
    mesh = tooth_of(MESHES["spur"]).triangles(closed=True)
    for name, way in (("lower side", -1.0), ("upper side", 1.0)):
        end = mesh.cell_data["patch"] == CLOSING[name]
        assert_allclose(mesh.corners[end][..., 2], way * 12.5)
        assert (way * mesh.normals[end][:, 2] >= 0.0).all()


def test_turned_tooth_keeps_its_form():
    tooth = tooth_of(MESHES["helical"])
    turned = tooth.turned(0.3)
    assert_allclose(turned.outline[..., 2], tooth.outline[..., 2])
    before, after = (np.arctan2(one.outline[..., 1], one.outline[..., 0]) for one in (tooth, turned))
    assert_allclose(np.remainder(after - before, 2.0 * math.pi), 0.3)
    assert_allclose(turned.turned(-0.3).outline, tooth.outline, atol=1e-13)  # mm; turned forth and back: 2e-16 seen


test_surface_refuses = refused_calls(
    (lambda: tooth_of(MESHES["spur"]).patch("top"), r"'top' is not one of 'root land -', .*'root land \+'"),
    (lambda copies: tooth_of(MESHES["spur"]).triangles(copies), r"copies: .* is not between 1 and 24", [0, 25]),
)


def test_repr_is_short():
    assert repr(tooth_of(MESHES["spur"])) == "ToothSurface(35 x 5 points, one of 24 teeth)"
