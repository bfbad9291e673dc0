import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs import mating_teeth
from loaded_tca.tooth import PATCHES, Resolution
from loaded_tca.unloaded import trace_contact
from tests.samples.teeth import COARSE, CROWNED, MESHES, pair_of


def mated(name, sense="positive", modifications=CROWNED, resolution=COARSE, **changes):
    return mating_teeth(pair_of(MESHES[name], sense, modifications, **changes), resolution)


@pytest.mark.quick_cases(every=5)
@pytest.mark.parametrize("driving", ["pinion", "wheel"])
@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("name", ["helical", "miter gear", "spiral bevel"])
def test_teeth_touch_at_the_contact_point_without_passing_through_each_other(name, sense, driving):
    """The wheel's flank, looked at from the pinion: nowhere behind its surface, and on it at the contact point."""
    teeth = mated(name, sense, driving=driving)
    pair = teeth.pair
    contact = trace_contact(pair, [0.2 * pair.pitch])[0]
    _, wheel = teeth.in_mesh(contact.pinion_angle, contact.wheel_angle)
    flank = PATCHES.index("flank +" if pair.wheel.flank.side > 0 else "flank -")
    points = wheel.vertices[np.unique(wheel.triangles[wheel.cell_data["patch"] == flank])]
    rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    there = pair.pinion.flank.inside(rho, z)
    theta = np.arctan2(points[there, 1], points[there, 0]) - pair.sense * contact.pinion_angle
    apart = pair.pinion.flank.side * (theta - pair.pinion.flank.theta(rho[there], z[there]).value)
    assert there.any()
    assert apart.min() > -1e-12  # mm; rounding of 100 mm
    assert_allclose(
        teeth.on_pinion(np.array(contact.pinion_radius), np.array(contact.pinion_axial), contact.pinion_angle),
        contact.point,
        atol=1e-9,
    )


@pytest.mark.parametrize("name", ["spur", "straight bevel"])
def test_tooth_in_mesh_holds_the_flank_of_the_pair(name):
    teeth = mated(name)
    pinion, wheel = teeth.in_mesh(0.1, 0.07)
    pair, patch = teeth.pair, PATCHES.index("flank +")
    points = pinion.vertices[np.unique(pinion.triangles[pinion.cell_data["patch"] == patch])]
    rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    assert_allclose(teeth.on_pinion(rho, z, 0.1), points, rtol=0, atol=1e-11)  # mm; places are turned: 9e-15 seen
    points = wheel.vertices[np.unique(wheel.triangles[wheel.cell_data["patch"] == patch])]
    radius, theta, axial = pair.to_wheel(points)
    turned = np.remainder(theta + 0.07 - pair.wheel.flank.theta(radius, axial).value + math.pi, 2.0 * math.pi) - math.pi
    assert np.abs(turned).max() < 1e-12  # rad; none seen


def test_pressure_lies_on_the_flank_and_keeps_its_values():
    teeth = mated("spur")
    contact = trace_contact(teeth.pair, [0.0])[0]
    x, y = np.linspace(-0.5, 0.5, 5), np.linspace(-4.0, 4.0, 7)
    along, across = np.array([0.0, 0.0, 1.0]), np.cross([0.0, 0.0, 1.0], contact.normal)
    corners = contact.point + x[:, None, None] * across + y[:, None] * along
    pressure = np.zeros((4, 6))
    pressure[1:3, 2:5] = np.arange(1.0, 7.0).reshape(2, 3)
    mesh = teeth.pressure_on_pinion(corners, pressure, contact.pinion_angle)
    assert_allclose(np.sort(mesh.cell_data["pressure_MPa"]), np.repeat(np.arange(1.0, 7.0), 2))
    assert mesh.size == 3 * 4
    assert_allclose(mesh.area, 0.5 * 4.0, rtol=2e-2)  # 6 cells, on a curved flank
    off = (mesh.vertices - contact.point) @ contact.normal
    assert np.abs(off).max() < 0.01  # crowning and curvature over half a millimetre
    normals = mesh.normals / np.linalg.norm(mesh.normals, axis=1, keepdims=True)
    assert np.abs(np.abs(normals @ contact.normal) - 1.0).max() < 1e-3


def test_no_pressure_is_a_surface_without_triangles():
    teeth = mated("spur")
    mesh = teeth.pressure_on_pinion(np.ones((3, 3, 3)), np.zeros((2, 2)), 0.0)
    assert (mesh.size, len(mesh.triangles)) == (0, 0)


def test_pressure_that_does_not_fit_its_corners_is_refused():
    with pytest.raises(InputError, match=r"pressure: shape \(3, 3\) does not fit corners of shape \(3, 3, 3\)"):
        mated("spur").pressure_on_pinion(np.ones((3, 3, 3)), np.ones((3, 3)), 0.0)


@pytest.mark.filterwarnings("ignore:(pinion|wheel).modifications.helix_slope")
def test_errors_name_the_gear():
    pair = pair_of(MESHES["spur"])
    with pytest.raises(InputError, match="pinion: fillet_radius: 3 mm does not fit"):
        mating_teeth(pair, COARSE, fillet_radius=3.0)
    pointed = pair_of(MESHES["spur"], modifications=FlankModifications(helix_slope=3.0))
    with pytest.raises(GeometryError, match="pinion: pointed tooth"):
        mating_teeth(pointed, Resolution(lengthwise=3))
