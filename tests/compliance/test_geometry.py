import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.compliance import MeshDensity
from loaded_tca.compliance.body import ToothFrame, gear_body, gear_nodes
from loaded_tca.compliance.geometry import body_nodes
from loaded_tca.compliance.layout import RingLayout
from loaded_tca.errors import InputError
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair, face_milled_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.scene import read_scene
from loaded_tca.tooth import Resolution, build_tooth
from tests.samples.bodies import pinion, spur_mesh
from tests.samples.face_milled import published_pinion, published_wheel

ON_FLANK = 2e-4
"""mm: flanks are resampled on the straight pieces of a fine outline."""
BETWEEN_NODES = 0.05
"""mm: quadratic between the nodes."""
LEANING = 0.1
"""mm, of teeth 4 mm thick: between a concave and a convex flank the middle leans, depths go to a radial plane."""
DENSITY = MeshDensity(lengthwise=2)
SCENES = Path(__file__).parents[2] / "examples" / "scenes"


def gears(side=1):
    sense = "positive" if side > 0 else "negative"
    mesh = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0, spiral_angle=math.radians(30.0))
    return {
        "spur": pinion(side=side),
        "helical": cylindrical_pair(spur_mesh(helix_angle=math.radians(20.0)), sense=sense).pinion,
        "bevel": bevel_pair(mesh, sense=sense).pinion,
        "face-milled": face_milled_gear(side),
    }


@cache
def face_milled_gear(side):
    flanks = ("concave", "convex")
    pairs = (face_milled_pair(published_pinion(), published_wheel(), pinion_flank=flank) for flank in flanks)
    return next(pair.pinion for pair in pairs if pair.pinion.flank.side == side)


@pytest.mark.parametrize("kind", gears())
@pytest.mark.parametrize("side", [1, -1])
def test_nodes_of_the_flank_lie_on_it(kind, side):
    gear = gears(side)[kind]
    frame = ToothFrame(gear, gear_nodes(gear, DENSITY))
    density, nodes = DENSITY, frame.nodes
    column = 2 * density.land + (2 * density.through if side > 0 else 0)
    first = 2 * (density.rim + density.fillet)
    radius, angle = nodes.radius[column, first:], nodes.angle[column, first:]
    rho, z = nodes.sections.point(radius, nodes.coordinate)
    azimuth = frame.flank.theta(rho, z).value + side * gear.form.half_thickness_angle
    assert_allclose(rho * (angle - azimuth), 0.0, atol=ON_FLANK)


@pytest.mark.parametrize("kind", gears())
def test_places_of_a_flank_are_found_again(kind):
    gear = gears()[kind]
    frame = ToothFrame(gear, gear_nodes(gear, DENSITY))
    height, length = (grid.ravel() for grid in np.meshgrid([0.1, 0.5, 0.9], [0.2, 0.7]))
    places = frame.places(height, length)
    found = frame.parts(np.hypot(places.point[:, 0], places.point[:, 1]), places.point[:, 2])
    assert_allclose(found, [height, length], atol=1e-9)
    numbers = np.arange(frame.nodes.radius.size).reshape(frame.nodes.radius.shape)
    points = frame.nodes.points.reshape(-1, 3)
    for surface, expected in ((frame.on_flank(places, numbers), places.point), (None, places.middle)):
        surface = surface or frame.on_middle(places, 0, numbers)
        reached = np.einsum("ms,msc->mc", surface.shares, points[surface.nodes])
        assert_allclose(reached, expected, atol=LEANING if kind == "face-milled" else BETWEEN_NODES)


def test_bore_is_that_of_the_gear_or_the_default():
    for bore, expected in ((None, 0.55 * 67.5), (30.0, 30.0)):
        gear = pinion(bore)
        nodes = gear_nodes(gear, DENSITY)
        assert_allclose(gear.smallest_bore, expected)
        assert_allclose(nodes.radius[:, 0], 0.5 * expected, rtol=1e-12)  # half a diameter


@pytest.mark.parametrize("kind", gears())
def test_elements_at_a_small_bore_are_thin(kind):
    """They reach between radii of a ratio of 1.6; tops of the rim lie a little above the root that it is taken from."""
    gear = replace(gears()[kind], bore_diameter=10.0)
    nodes = gear_nodes(gear, DENSITY)
    radius = np.hypot(*np.moveaxis(nodes.points, -1, 0)[:2])[:, : nodes.layout.base_row + 1]
    assert_allclose(radius[:, 0], 5.0)
    assert (np.diff(radius, axis=1) > 0.0).all()
    assert (radius[:, 2::2] / radius[:, :-2:2]).max() < 1.05 * 1.6
    assert nodes.layout.base_row > 2 * DENSITY.rim
    gear_body(nodes, gear.material)  # no element is turned inside out


@pytest.mark.parametrize("bore", [67.4, 70.0])
def test_a_bore_without_a_rim_is_refused(bore):
    with pytest.raises(InputError, match=r"bore_diameter: .* no rim is left"):
        gear_nodes(replace(pinion(), bore_diameter=bore), DENSITY)


def test_sections_that_do_not_fit_the_layout_are_refused():
    gear = pinion()
    tooth = build_tooth(gear.flanks, gear.form, Resolution(lengthwise=4))
    with pytest.raises(InputError, match="4 sections, 5 are needed"):
        body_nodes(tooth, gear.form.sections, np.full(5, 20.0), RingLayout(25, DENSITY))


def test_a_sharp_fillet_does_not_fold_the_body():
    """Edges of elements that turned by 66 deg at the foot of this pinion folded over."""
    scene = read_scene(SCENES / "face_milled_19x62_matched.toml")
    gear = scene.pair().pinion
    mesh, _ = gear_body(gear_nodes(gear, replace(DENSITY, land=2)), gear.material)
    assert len(mesh.elements) > 100


def test_layers_below_the_surface_are_as_thin_as_asked_for():
    density = MeshDensity(through=6, rim=5, lengthwise=2, grading=3.0, skin=0.01)
    gear = pinion()
    nodes, first = gear_nodes(gear, density), 2 * density.land
    tooth = nodes.angle[first : first + 13 : 2, nodes.layout.base_row + 2 * density.fillet + 4, 0]
    assert_allclose(np.diff(tooth) / np.diff(tooth)[0], [1.0, 3.0, 9.0, 9.0, 3.0, 1.0], rtol=1e-9)
    root = spur_mesh().pinion.root_radius
    rim = nodes.radius[0, : nodes.layout.base_row + 1 : 2, 0]
    assert_allclose(rim[-1] - rim[-2], 0.01 * 2.0 * math.pi / 25 * root, rtol=1e-4)
    assert_allclose(np.diff(rim)[1:] / np.diff(rim)[:-1], 1.0 / nodes.layout.growth, rtol=1e-9)
    assert_allclose(rim[[0, -1]], [0.55 * root, root])


def test_rim_too_thin_for_its_uppermost_layer_has_even_layers():
    density = MeshDensity(rim=4, lengthwise=2, skin=0.1)
    nodes = gear_nodes(pinion(bore_diameter=65.0), density)
    assert nodes.layout.growth == 1.0
    assert_allclose(np.diff(nodes.radius[0, : nodes.layout.base_row + 1, 0], 2), 0.0, atol=1e-9)


def test_fillet_ends_between_two_elements_below_thin_layers():
    """Beyond it all nodes lie on the root circle, before it none does."""
    gear, density = pinion(), MeshDensity(land=4, lengthwise=2, skin=0.01)
    nodes = gear_nodes(gear, density, 257)
    layout = nodes.layout
    first = layout.sector(0).first + 2 * (density.land + density.through)
    radius, angle = (
        values[first : first + 2 * density.land + 1, layout.base_row, 0] for values in (nodes.radius, nodes.angle)
    )
    root = spur_mesh().pinion.root_radius
    assert (radius[:6] > root + 1e-4).all()
    assert_allclose(radius[6:], root, rtol=1e-9)
    assert angle[6] < angle[8]


def test_ends_of_the_face_have_layers_half_as_thick():
    nodes = gear_nodes(pinion(), MeshDensity(lengthwise=8, thin_ends=True))
    assert_allclose(np.diff(nodes.coordinate[::2]), 20.0 / 12 * np.array([1, 1, 2, 2, 2, 2, 1, 1]))
    assert_allclose(nodes.coordinate[[0, -1]], [-10.0, 10.0])
