import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.tooth import ApexSpheres, InvertedPlanes, TransversePlanes

FAMILIES = [TransversePlanes(), ApexSpheres(), InvertedPlanes(40.0)]
ROUNDING = 1e-13  # of a few functions: 6e-16 seen, at lengths near zero 3e-15 mm
DIFFERENCE = 1e-8  # central differences over 1e-4 mm


@pytest.fixture
def places(rng):
    """Points (rho, z) in front of and behind the plane through the apex."""
    return rng.uniform(5.0, 60.0, 50), rng.uniform(-40.0, 60.0, 50)


@pytest.mark.parametrize("sections", FAMILIES)
def test_point_is_the_one_whose_image_was_taken(sections, places):
    rho, z = places
    back = sections.point(sections.radius(rho, z), sections.coordinate(rho, z))
    assert_allclose(back, (rho, z), rtol=ROUNDING, atol=1e-12)  # atol: mm, near zero


@pytest.mark.parametrize("sections", FAMILIES)
def test_direction_is_the_derivative_of_the_point(sections, places):
    radius, coordinate = sections.radius(*places), sections.coordinate(*places)
    ahead, behind = (np.array(sections.point(radius + step, coordinate)) for step in (1e-4, -1e-4))
    assert_allclose(sections.direction(radius, coordinate), (ahead - behind) / 2e-4, atol=DIFFERENCE)


@pytest.mark.parametrize("sections", FAMILIES)
def test_image_keeps_angles(sections, places):
    """The same scale along the meridian and around the axis."""
    radius, coordinate = sections.radius(*places), sections.coordinate(*places)
    along = np.hypot(*sections.direction(radius, coordinate))
    around = sections.point(radius, coordinate)[0] / radius
    assert_allclose(along, around, rtol=ROUNDING)


@pytest.mark.parametrize("sections", FAMILIES)
def test_radius_beyond_is_as_far_as_asked_along_the_meridian(sections):
    radius, coordinate = np.array([20.0]), np.array([50.0])
    end = sections.radius_beyond(radius, coordinate, np.array([3.0]))
    fine = np.linspace(radius[0], end[0], 2001)
    rho, z = sections.point(fine, coordinate)
    assert_allclose(np.hypot(np.diff(rho), np.diff(z)).sum(), 3.0, rtol=1e-8)  # chords for arcs


def test_circle_on_a_sphere_has_a_circle_as_image():
    """An arbitrary circle about the point u = 0.7, theta = 0.3: its image has the centre and radius of three of it."""
    distance, cap, turn = 50.0, 0.1, np.linspace(0.0, 2.0 * math.pi, 40)
    centre = np.array([math.sin(0.7) * math.cos(0.3), math.sin(0.7) * math.sin(0.3), math.cos(0.7)])
    side = np.cross(centre, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side)
    ring = np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * np.cross(centre, side)
    x, y, z = distance * (math.cos(cap) * centre + math.sin(cap) * ring).T
    radius = ApexSpheres().radius(np.hypot(x, y), z)
    flat = radius[:, None] * np.stack([x, y], axis=1) / np.hypot(x, y)[:, None]
    system = np.column_stack([2.0 * flat, np.ones(len(flat))])
    solution, residual, *_ = np.linalg.lstsq(system, (flat**2).sum(axis=1))
    # the square of a length in squared mm: a place to 1e-9 of the distance, 2e-24 seen
    assert residual[0] < 1e-18 * distance**4
    assert np.isfinite(solution).all()


def test_planes_of_a_ring_have_their_roots_inside_and_their_tips_outside():
    planes = InvertedPlanes(40.0)
    image = planes.radius(np.array([50.0, 40.0, 30.0]), np.zeros(3))
    assert (np.diff(image) > 0.0).all()
    assert image[1] == 40.0
    assert_allclose(planes.in_true_size(image, np.zeros(3)), [50.0, 40.0, 30.0])
    assert np.isfinite(planes.point(np.array(0.0), np.array(0.0))[0])  # the middle of the image is infinitely far
