import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks import FlankModifications, InvoluteFlank
from loaded_tca.flanks.spline import fitted
from loaded_tca.gears import CylindricalGear, bevel_mesh
from loaded_tca.tooth import (
    ArcFillet,
    RackFillet,
    Resolution,
    RootCone,
    RootCylinder,
    ToothForm,
    TransversePlanes,
    build_tooth,
)
from tests.samples.gear_pairs import cylindrical_mesh, meshes
from tests.samples.teeth import COARSE, CROWNED, MESHES, NONE, RELIEVED, crossings, flanks_of, form_of, image, tooth_of

ROUNDING = 1e-12  # of lengths of 100 mm or angles of order one: 4e-16 seen


@pytest.mark.parametrize("member", [0, 1])
@pytest.mark.parametrize("name", ["spur", "helical"])
def test_thickness_at_the_reference_circle_is_that_of_the_gear(name, member):
    mesh = MESHES[name]
    gear = (mesh.pinion, mesh.wheel)[member]
    tooth = tooth_of(mesh, member, resolution=Resolution(flank=401, lengthwise=3))
    angles = []
    for side in "-+":
        points = tooth.patch(f"flank {side}")[:, 1]
        radius, angle = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
        order = np.argsort(radius)
        angles.append(np.interp(gear.reference_radius, radius[order], angle[order]))
    assert_allclose((angles[1] - angles[0]) * gear.reference_radius, gear.tooth_thickness, rtol=1e-5)  # linear between


@pytest.mark.parametrize("name", ["spur", "helical"])
def test_tip_land_is_as_wide_as_the_tooth_at_its_tip(name):
    gear = MESHES[name].wheel
    land = tooth_of(MESHES[name], 1).patch("tip land")
    width = np.arctan2(land[-1, :, 1], land[-1, :, 0]) - np.arctan2(land[0, :, 1], land[0, :, 0])
    assert_allclose(np.remainder(width, 2 * math.pi) * gear.tip_radius, gear.tooth_thickness_at(gear.tip_radius))


@pytest.mark.parametrize("name", ["straight bevel", "miter gear"])
def test_tip_land_of_a_bevel_gear_lies_on_the_face_cone(name):
    gear = MESHES[name].pinion
    land = tooth_of(MESHES[name]).patch("tip land")
    assert_allclose(np.arctan2(np.hypot(land[..., 0], land[..., 1]), land[..., 2]), gear.tip_angle, rtol=ROUNDING)
    width = np.arctan2(land[-1, :, 1], land[-1, :, 0]) - np.arctan2(land[0, :, 1], land[0, :, 0])
    assert_allclose(width, 2.0 * gear.half_thickness_angle_at(gear.tip_angle), rtol=1e-10)  # 1e-14 seen


@pytest.mark.parametrize("name", MESHES)
def test_root_land_lies_on_the_root_surface(name):
    mesh = MESHES[name]
    form = form_of(mesh)
    for side in "-+":
        land = tooth_of(mesh).patch(f"root land {side}")
        rho, z = np.hypot(land[..., 0], land[..., 1]), land[..., 2]
        wanted = form.root_radius(form.sections.coordinate(rho, z))
        assert_allclose(form.sections.radius(rho, z), wanted, rtol=ROUNDING)


@pytest.mark.parametrize("modifications", [NONE, RELIEVED], ids=["unmodified", "relieved"])
@pytest.mark.parametrize("name", MESHES)
def test_patches_lie_on_their_flanks(name, modifications):
    mesh = MESHES[name]
    tooth, half = tooth_of(mesh, 0, modifications), form_of(mesh).half_thickness_angle
    for flank, side in zip(flanks_of(mesh, 0, modifications), "+-", strict=True):
        x, y, z = np.moveaxis(tooth.patch(f"flank {side}"), -1, 0)
        theta = flank.theta(np.hypot(x, y), z).value + flank.side * half
        off = np.remainder(theta - np.arctan2(y, x) + math.pi, 2.0 * math.pi) - math.pi
        assert np.abs(off).max() < ROUNDING


@pytest.mark.parametrize("name", MESHES)
def test_neighbouring_patches_share_their_edges(name):
    tooth = tooth_of(MESHES[name])
    names = ["root land -", "fillet -", "flank -", "tip land", "flank +", "fillet +", "root land +"]
    for first, second in pairwise(names):
        assert_array_equal(tooth.patch(first)[-1], tooth.patch(second)[0])  # exact, also below: rows of one table
    assert_array_equal(tooth.patch(names[0])[0], tooth.outline[0])
    assert_array_equal(tooth.patch(names[-1])[-1], tooth.outline[-1])


@pytest.mark.parametrize("name", MESHES)
def test_next_tooth_begins_where_this_one_ends(name):
    tooth = tooth_of(MESHES[name], 0, CROWNED)
    following = tooth.turned(2.0 * math.pi / tooth.teeth)
    assert_allclose(following.outline[0], tooth.outline[-1], atol=ROUNDING)
    assert_allclose(following.foot[0], tooth.foot[1], atol=ROUNDING)


@pytest.mark.parametrize("name", MESHES)
def test_outline_does_not_cross_itself(name):
    mesh = MESHES[name]
    radius, angle = image(tooth_of(mesh, 0, RELIEVED).outline, form_of(mesh).sections)
    for section in range(radius.shape[1]):
        middle = angle[:, section].mean()
        polar = radius[:, section], angle[:, section] - middle
        assert crossings(np.column_stack([polar[0] * np.cos(polar[1]), polar[0] * np.sin(polar[1])])) == 0


def test_crossings_are_counted():
    """A loop crosses itself once: what the test above relies on."""
    assert crossings(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, -1.0]])) == 1


@pytest.mark.parametrize("name", ["spur", "straight bevel"])
def test_straight_tooth_is_its_own_mirror_image(name):
    outline = tooth_of(MESHES[name], 0, CROWNED).outline
    assert_allclose(outline[::-1] * [1.0, -1.0, 1.0], outline, atol=ROUNDING)


@pytest.mark.parametrize("name", ["straight bevel", "spiral bevel"])
def test_sections_of_an_unmodified_bevel_tooth_are_similar(name):
    """All cones share the apex: every section is the first one, magnified and turned."""
    tooth = tooth_of(MESHES[name]).outline
    distance = np.linalg.norm(tooth, axis=-1)
    height = tooth[..., 2] / distance
    assert_allclose(height, height[:, :1] + 0.0 * height, atol=ROUNDING)
    angle = np.unwrap(np.arctan2(tooth[..., 1], tooth[..., 0]), axis=0)
    assert_allclose(angle - angle[:1], angle[:, :1] - angle[:1, :1] + 0.0 * angle, rtol=0, atol=ROUNDING)


def test_bevel_tooth_of_small_pitch_angle_is_the_cylindrical_one():
    """A wheel of 1200 teeth is all but a rack: the pinion's cone is all but a cylinder."""
    radius, bevel = 0.6, bevel_mesh((24, 1200), 3.0, 1.0)
    spur = CylindricalGear(teeth=24, normal_module=3.0, face_width=1.0)
    edges, half = (spur.base_radius, spur.tip_radius), 0.5 * spur.tooth_thickness / spur.reference_radius
    plus, minus = (InvoluteFlank(spur.base_radius, 0.0, side, spur.reference_radius, edges, 1.0) for side in (1, -1))
    form = ToothForm(24, half, TransversePlanes(), RootCylinder(spur.root_radius), ArcFillet(radius))
    flat = image(build_tooth((plus, minus), form, COARSE).outline, form.sections)
    cone = image(tooth_of(bevel, 0, fillet_radius=radius).outline, form_of(bevel).sections)
    assert_allclose(cone[0][:, -1], flat[0][:, -1], rtol=4e-4)  # the square of the pitch angle
    assert_allclose(cone[1][:, -1], flat[1][:, -1], atol=4e-4)


def test_root_cone_off_the_apex_is_met_by_every_sphere():
    cone, distance = RootCone(math.radians(30.0), apex=2.0), np.array([40.0, 50.0, 60.0])
    rho, z = form_of(MESHES["miter gear"]).sections.point(cone(distance), distance)
    assert_allclose(rho, (z - 2.0) * math.tan(math.radians(30.0)), rtol=ROUNDING)
    assert_allclose(np.hypot(rho, z), distance, rtol=ROUNDING)


def test_fitted_flanks_give_the_same_tooth():
    mesh = MESHES["spiral bevel"]
    plus, minus = flanks_of(mesh, 0, CROWNED)
    form = form_of(mesh)
    exact = build_tooth((plus, minus), form, COARSE)
    splines = build_tooth((fitted(plus, (17, 17)), fitted(minus, (17, 17))), form, COARSE)
    for name in ("flank +", "flank -", "fillet +"):
        assert_allclose(splines.patch(name), exact.patch(name), atol=1e-4)  # accuracy of the fit beside the base cone


@given(mesh=meshes(), crowning=st.floats(0.0, 0.05))
@settings(max_examples=15)
def test_random_cylindrical_teeth_are_closed(mesh, crowning):
    for member in (0, 1):
        tooth = tooth_of(mesh, member, FlankModifications(lead_crowning=crowning))
        solid = tooth.triangles(closed=True)
        assert solid.is_closed
        assert solid.volume > 0.0


@pytest.mark.thorough
@given(
    teeth=st.tuples(st.integers(10, 50), st.integers(15, 60)),
    shaft=st.floats(45.0, 120.0),
    spiral=st.floats(-40.0, 40.0),
    part=st.floats(0.1, 0.3),
)
@settings(max_examples=12)
def test_random_bevel_teeth_are_closed(teeth, shaft, spiral, part):
    angles = {"shaft_angle": math.radians(shaft), "spiral_angle": math.radians(spiral)}
    cone_distance = bevel_mesh(teeth, 3.0, 1.0, shaft_angle=angles["shaft_angle"]).pinion.outer_cone_distance
    mesh = bevel_mesh(teeth, 3.0, part * cone_distance, **angles)
    for member in (0, 1):
        solid = tooth_of(mesh, member, CROWNED).triangles(closed=True)
        assert solid.is_closed
        assert solid.volume > 0.0


def test_default_arc_shrinks_to_what_fits():
    """A dedendum as deep as this leaves less room than 0.38 modules need."""
    mesh = bevel_mesh((20, 30), 3.0, 12.0, profile_shifts=(-0.45, 0.45))
    form = form_of(mesh)
    wide = replace(form, fillet=ArcFillet(4.0, form.fillet.coordinate))
    tooth = build_tooth(flanks_of(mesh), wide, COARSE)
    land = tooth.patch("root land +")
    assert (
        np.linalg.norm(land[-1] - land[0], axis=-1).max() < 1e-2
    )  # an overlap of a thousandth of a pitch counts as none
    assert tooth.triangles(closed=True).is_closed


@pytest.mark.parametrize("name", ["spur", "straight bevel"])
def test_fillet_radius_too_large_names_the_largest(name):
    mesh = MESHES[name]
    with pytest.raises(InputError, match=r"fillet_radius: 3 mm does not fit .* largest that does is (\S+) mm") as error:
        tooth_of(mesh, fillet_radius=3.0)
    largest = float(str(error.value).split()[-2])
    tooth_of(mesh, fillet_radius=0.999 * largest)
    with pytest.raises(InputError, match="fillet_radius"):
        tooth_of(mesh, fillet_radius=1.01 * largest)


def test_teeth_without_space_are_refused():
    form = form_of(MESHES["spur"], fillet_radius=0.5)
    with pytest.raises(GeometryError, match="no space is left at the root"):
        build_tooth(flanks_of(MESHES["spur"]), replace(form, teeth=60), COARSE)
    rack = form_of(MESHES["spur"])
    with pytest.raises(GeometryError, match="fillets of neighbouring teeth pass each other"):
        build_tooth(flanks_of(MESHES["spur"]), replace(rack, teeth=60), COARSE)


@pytest.mark.filterwarnings("ignore:(pinion|wheel).modifications.helix_slope")
def test_tooth_pointed_by_its_modification_is_refused_and_told_where():
    """Tip relief of half the land's width on either side at mid-face would do; helix slopes do so at one end."""
    mesh = cylindrical_mesh((24, 57), shifts=(0.6, 0.0))
    gear = mesh.pinion
    much = FlankModifications(helix_slope=0.75 * gear.tooth_thickness_at(gear.tip_radius))
    with pytest.raises(GeometryError, match=r"pointed tooth: .* in the section at 12\.5 mm"):
        tooth_of(mesh, 0, much)


def test_undercut_that_cuts_off_the_tooth_is_refused():
    gear = CylindricalGear(teeth=5, normal_module=3.0, face_width=10.0, profile_shift=-0.6)
    radii, half = (gear.form_radius, gear.tip_radius), 0.5 * gear.tooth_thickness / gear.reference_radius
    plus, minus = (InvoluteFlank(gear.base_radius, 0.0, side, gear.reference_radius, radii, 10.0) for side in (1, -1))
    form = ToothForm(5, half, TransversePlanes(), RootCylinder(gear.root_radius), RackFillet(gear))
    with pytest.raises(GeometryError, match="undercut of both sides cuts off the tooth"):
        build_tooth((plus, minus), form, COARSE)


def test_flanks_of_one_side_are_refused():
    plus, _ = flanks_of(MESHES["spur"])
    with pytest.raises(InputError, match="sides are 1, 1, not 1, -1"):
        build_tooth((plus, plus), form_of(MESHES["spur"]))


def test_grid_off_the_sections_is_refused():
    """Bevel flanks do not end in transverse planes."""
    form = replace(form_of(MESHES["straight bevel"]), sections=form_of(MESHES["spur"]).sections)
    with pytest.raises(GeometryError, match="do not lie on the sections"):
        build_tooth(flanks_of(MESHES["straight bevel"]), form)


def test_resolution_tells_every_number_that_is_too_small():
    with pytest.raises(InputError) as error:
        Resolution(flank=1, fillet=2.5, land=3, lengthwise=0)
    assert [problem.split(":")[0] for problem in error.value.problems] == ["flank", "fillet", "lengthwise"]
