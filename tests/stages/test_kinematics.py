"""Phases of planets against an enumeration of their teeth, and which planets can be put in."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
from loaded_tca.stages.kinematics import mesh_phases, nearest_angle, neutralised, possible_angles, spacing_problems

ROUNDING = 1e-12  # rad; a whole number of steps of a turn, and places of several turns
THREE = tuple(2.0 * math.pi * np.arange(3) / 3)


def meshes(teeth=(18, 36, 93), shifts=(0.389, 0.5039, 0.1171), distance=584.0 / 7.0):
    sun, planet = (CylindricalGear(z, 3.0, 25.0, profile_shift=x) for z, x in zip(teeth[:2], shifts[:2], strict=True))
    ring = RingGear(-teeth[2], 3.0, 25.0, profile_shift=shifts[2])
    return CylindricalMesh(sun, planet, distance), InternalMesh(planet, ring, distance)


@pytest.mark.parametrize("sun_drives", [True, False])
@pytest.mark.parametrize("angle", [0.0, 2.0 * math.pi * 11 / 111, 2.0 * math.pi / 3.0])
def test_phases_are_those_of_teeth_that_are_counted(sun_drives, angle):
    """Every flank of sun, planet and ring is placed in the plane; the next one to reach each pitch point tells."""
    sun_mesh, ring_mesh = meshes()
    sun, planet, ring = sun_mesh.pinion, sun_mesh.wheel, ring_mesh.ring
    radii = sun_mesh.wheel_working_radius, ring_mesh.pinion_working_radius
    half = [0.5 * planet.tooth_thickness_at(radius) / radius for radius in radii]
    push = 1.0 if sun_drives else -1.0  # which flank of a sun tooth carries: ahead of it, or behind
    # a flank of the sun stands at azimuth 0 where the sun has not turned: planet 0 is at its pitch point
    pitch = [2.0 * math.pi / z for z in (sun.teeth, planet.teeth, ring.tooth_count)]
    to_sun = -angle % pitch[0]  # by how much a sun's flank is ahead of the planet's line of centres
    sun_phase = to_sun / pitch[0]
    # the planet's flank is there at the same time: the planet turns backwards, in the frame of the carrier
    flank_at_sun = math.pi - to_sun * sun.teeth / planet.teeth  # azimuth about the planet, its line of centres at 0
    middle = flank_at_sun - push * half[0]
    flank_at_ring = middle - push * half[1] + pitch[1] * np.arange(planet.teeth)
    behind = flank_at_ring % pitch[1]  # still to go, turning backwards
    ring_phase = -behind[0] / pitch[1]
    first, second = mesh_phases(sun_mesh, ring_mesh, (0.0, angle), sun_drives)
    assert_allclose(_apart(first[1], sun_phase), 0.0, atol=1e-9)
    assert_allclose(_apart(second[1], ring_phase), 0.0, atol=1e-9)


def _apart(one, other):
    """Difference of two phases, to the nearest whole cycle."""
    return (one - other + 0.5) % 1.0 - 0.5


def test_planets_in_phase_have_one_phase():
    sun, ring = mesh_phases(*meshes(), THREE, True)
    assert_allclose(sun, 0.0)
    assert_allclose(ring, ring[0], atol=1e-9)


@pytest.mark.parametrize(
    ("sun_teeth", "order", "cancels"),
    [(18, 1, (False, True)), (19, 1, (True, False)), (20, 1, (True, False)), (19, 3, (False, True))],
)
def test_orders_of_three_planets(sun_teeth, order, cancels):
    assert neutralised(order, THREE, sun_teeth) == cancels


def test_four_planets_may_cancel_rotation_and_translation():
    four = tuple(0.5 * math.pi * np.arange(4))
    assert neutralised(1, four, 30) == (True, True)
    assert neutralised(2, four, 30) == (False, True)


def test_planets_that_cannot_be_put_in_are_told_the_nearest_angles():
    (problem,) = spacing_problems((0.0, math.radians(119.0), math.radians(240.0)), (18, 36, 93), 584.0, 100.0)
    assert "cannot be put in at 119.0000 deg" in problem
    assert "nearest that are possible are 120.0000 deg" in problem
    assert_allclose(nearest_angle(math.radians(119.0), (18, 36, 93)), math.radians(120.0))
    assert not spacing_problems(THREE, (18, 36, 93), 584.0, 100.0)


@pytest.mark.parametrize(("turned", "order"), [(0.0, (0, 1, 2, 3)), (0.3, (0, 3, 2, 1)), (-2.0, (2, 1, 0, 3))])
def test_places_of_planets_that_stand_opposite_are_opposite(turned, order):
    """18 + 92 teeth: a quarter turn is 27.5 places, so that 27 and 28 are equally near for both planets beside."""
    wanted = [turned + 0.5 * math.pi * n for n in order]
    places = np.array(possible_angles(wanted, (18, 37, 92)))
    assert_allclose(
        np.abs(places - wanted), [0.0 if n % 2 == order[0] % 2 else math.pi / 110 for n in order], atol=ROUNDING
    )
    assert_allclose(np.exp(1j * places).sum(), 0.0, atol=1e-12)  # a turn of 1e-15 a planet
    (problem,) = spacing_problems(wanted, (18, 37, 92), 584.0, 100.0)
    assert f"{math.degrees(places[1]):.4f}, {math.degrees(places[3]):.4f} deg, multiples" in problem


def test_neighbours_that_touch_are_refused():
    (problem,) = spacing_problems((0.0, 2.0 * math.pi * 37 / 111), (18, 36, 93), 100.0, 200.0)
    assert "neighbouring planets touch: their axes are 173.2051 mm apart, their tip diameter is 200.0000" in problem
