"""Rolling bearings by their inner geometry: numbers of others, force and tangent of one potential, lives."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.supports import BallBearing, RollerBearing, RollingBearing
from loaded_tca.supports.bearing import Seat, balanced
from loaded_tca.supports.bearing_life import ball_factor, ball_life, ball_rating, roller_factor, roller_life

SMALL = BallBearing(at=0.0, elements=7, diameter=11.5, pitch_diameter=43.5, rating=23400.0)
"""That of which MASTA's numbers are known (printed in the tests of github.com/minzhun/ISO16281)."""
PROGRAM, OF_LIFE = 1e-4, 1e-4
"""Digits of a commercial program, whose solver ends at about as much."""
DIFFERENCES = 1e-6
BEARINGS = {
    "ball": SMALL,
    "with clearance": replace(SMALL, clearance=0.01),
    "angular": replace(SMALL, contact_angle=math.radians(40.0), side=-1, preload=0.005),
    "roller": RollerBearing(at=0.0, elements=14, diameter=10.0, pitch_diameter=65.0, length=12.0, clearance=0.01),
    "long roller": RollerBearing(at=0.0, elements=20, diameter=4.0, pitch_diameter=40.0, length=16.0),
    "tapered": RollerBearing(
        at=0.0, elements=14, diameter=10.0, pitch_diameter=65.0, length=12.0, contact_angle=math.radians(15.0), side=-1
    ),
}
MOTIONS = [
    np.array([0.03, -0.01, 0.005, 2e-4, -1e-4, 0.0]),
    np.array([-0.01, 0.02, -0.03, -4e-4, 3e-4, 0.0]),
]


def under(bearing: RollingBearing, load: Array) -> Array:
    """Motion of a bearing alone that the load turns against next to nothing."""
    slack = np.diag([0.0, 0.0, 1e-3, 1.0, 1.0, 0.0])
    return balanced(slack, load, np.arange(5), [Seat(bearing, slice(0, 6))])[0]


@pytest.mark.parametrize(
    ("clearance", "load", "motion", "life"),
    [
        (0.0, (1000.0, 0.0), (15.1101e-3, 0.0), 13163.019),
        (0.0, (0.0, 1000.0), (0.0, 133.5381e-3), 2222.7318),
        (0.01, (1000.0, 0.0), (21.223e-3, 0.0), 10795.7948),
        (0.01, (0.0, 1000.0), (0.0, 149.1717e-3), 3115.8781),
        (0.01, (1000.0, 1000.0), (19.5923e-3, 146.4603e-3), 1630.5367),
    ],
)
def test_balls_give_way_and_last_as_a_commercial_program_has_them(
    clearance: float, load: tuple[float, float], motion: tuple[float, float], life: float
) -> None:
    bearing, (radial, axial) = replace(SMALL, clearance=clearance), load
    moved = under(bearing, np.array([radial, 0.0, axial, 0.0, 0.0, 0.0]))
    assert_allclose(moved[[0, 2]], motion, rtol=PROGRAM, atol=1e-9)
    assert_allclose(bearing.life(moved), life, rtol=OF_LIFE)


def test_balls_tilt_nearly_as_a_commercial_program_has_them() -> None:
    """Its moment has the pitch radius for a lever, ours that of the groove, as the energy has it."""
    moved = under(SMALL, np.array([0.0, 0.0, 0.0, 1000.0, 0.0, 0.0]))
    assert_allclose(moved[3], 3.6957e-3, rtol=0.015)


@pytest.mark.parametrize(
    ("bearing", "number"),
    [
        (BallBearing(at=0.0, elements=200, diameter=1.0, pitch_diameter=100.0), 4.37),
        (RollerBearing(at=0.0, elements=200, diameter=1.0, pitch_diameter=100.0, length=40.0), 4.08),
    ],
)
def test_most_loaded_element_has_stribecks_part_of_a_radial_load(bearing: RollingBearing, number: float) -> None:
    """Rollers so long and loaded that the profile of their ends is of no account."""
    load = 3e5 if isinstance(bearing, RollerBearing) else 3000.0
    moved = under(bearing, np.array([0.0, load, 0.0, 0.0, 0.0, 0.0]))
    assert_allclose(bearing.element_forces(moved).max() * bearing.elements / load, number, rtol=0.002)


@pytest.mark.parametrize("name", BEARINGS)
@pytest.mark.parametrize("motion", MOTIONS)
def test_force_and_tangent_are_derivatives_of_the_energy(name: str, motion: Array) -> None:
    bearing, steps = BEARINGS[name], np.array([1e-7, 1e-7, 1e-7, 1e-9, 1e-9, 1e-9])
    sides = [
        [bearing.reaction(motion + sign * step * np.eye(6)[k]) for sign in (1, -1)] for k, step in enumerate(steps)
    ]
    reaction = bearing.reaction(motion)
    slopes = np.array([(up.energy - down.energy) / (2.0 * step) for (up, down), step in zip(sides, steps, strict=True)])
    tangent = np.array([(up.force - down.force) / (2.0 * step) for (up, down), step in zip(sides, steps, strict=True)])
    assert_allclose(slopes, reaction.force, atol=DIFFERENCES * np.abs(reaction.force).max())
    scale = np.sqrt(np.outer(*[np.maximum(reaction.tangent.diagonal(), 1.0)] * 2))
    assert (np.abs(tangent - reaction.tangent) < 1e-4 * scale).all()  # slices at the end of the load come and go
    assert_allclose(reaction.tangent, reaction.tangent.T, rtol=0.0, atol=0.0)
    assert np.linalg.eigvalsh(reaction.tangent / scale).min() > -1e-12  # of numbers up to one: rounding


@pytest.mark.parametrize("name", BEARINGS)
def test_mirrored_bearing_has_mirrored_forces(name: str) -> None:
    bearing, mirror = BEARINGS[name], np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    other = replace(bearing, side=-bearing.side)
    force = other.reaction(mirror * MOTIONS[0]).force
    expected = mirror * bearing.reaction(MOTIONS[0]).force
    # atol: sums over elements of which parts cancel
    assert_allclose(force, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())


def test_elements_are_apart_within_the_clearance() -> None:
    for name in ("with clearance", "roller"):
        reaction = BEARINGS[name].reaction(np.array([0.004, 0.0, 0.0, 0.0, 0.0, 0.0]))
        assert reaction.energy == 0.0
        assert not reaction.force.any()
        assert not reaction.tangent.any()
        assert BEARINGS[name].life(np.zeros(6)) == math.inf
        assert BEARINGS[name].largest_pressure(np.zeros(6)) == 0.0


def test_first_element_is_on_the_x_axis() -> None:
    forces = BEARINGS["with clearance"].element_forces(np.array([0.006, 0.0, 0.0, 0.0, 0.0, 0.0]))
    assert_allclose(forces[1:], 0.0)
    assert forces[0] > 0.0


def test_contact_angle_sets_the_thrust_over_the_radial_force_of_tapered_rollers() -> None:
    bearing, pressed = BEARINGS["tapered"], np.array([0.0, 0.0, -0.02, 0.0, 0.0, 0.0])
    thrust = bearing.element_forces(pressed).sum() * math.sin(math.radians(15.0))
    assert_allclose(bearing.reaction(pressed).force[2], -thrust)
    assert not bearing.reaction(np.array([0.0, 0.0, 0.02, 0.0, 0.0, 0.0])).force.any()  # pulled off


def test_preload_is_a_motion_in_the_sense_of_the_side() -> None:
    for name in ("angular", "tapered"):
        bearing = replace(BEARINGS[name], preload=0.0)
        pressed = replace(bearing, preload=0.01).reaction(np.zeros(6)).force
        moved = bearing.reaction(np.array([0.0, 0.0, -0.01, 0.0, 0.0, 0.0])).force
        assert_allclose(pressed, moved, rtol=1e-9, atol=1e-9)


def test_force_of_a_roller_is_that_of_the_standard_without_its_profile() -> None:
    """c_L delta^(10/9) of the whole roller, less what the profile takes off its ends."""
    bearing, deflection = BEARINGS["long roller"], 0.05
    largest = bearing.element_forces(np.array([deflection, 0.0, 0.0, 0.0, 0.0, 0.0])).max()
    whole = 35948.0 * 16.0 ** (8.0 / 9.0) * deflection ** (10.0 / 9.0)
    assert 0.9 * whole < largest < whole


def test_tilted_balls_have_the_centre_of_the_inner_groove_for_their_lever() -> None:
    """A ball alone presses through the centre of its inner groove, D_pw/2 + r_i - D_w/2 off the axis."""
    bearing = replace(SMALL, elements=4, clearance=0.02)
    motion = np.array([0.0, 0.02, 0.02, 0.0, 0.0, 0.0])
    assert np.flatnonzero(bearing.element_forces(motion)).tolist() == [1]  # that on the y axis
    force = bearing.reaction(motion).force
    assert_allclose(force[3] / force[2], 0.5 * 43.5 + (0.52 - 0.5) * 11.5, rtol=1e-9)


def test_profile_of_long_rollers_takes_off_their_ends_alike() -> None:
    """ISO/TS 16281: it begins 1.25 diameters from either end, however long the roller is."""
    short, long = (replace(BEARINGS["long roller"], length=length) for length in (16.0, 48.0))
    assert_allclose(long.profile[0], short.profile[1], rtol=1e-9)  # both 0.8 mm from the end
    assert not long.profile[4:-4].any()  # farther than 5 mm from both


def test_pressure_is_hertz_at_the_inner_ring() -> None:
    ball, deflection = SMALL, np.array([0.0, 0.0, 0.1335381, 0.0, 0.0, 0.0])
    grown = ball.largest_pressure(2.0 * deflection) / ball.largest_pressure(deflection)
    force = ball.element_forces(2.0 * deflection).max() / ball.element_forces(deflection).max()
    assert_allclose(grown, force ** (1.0 / 3.0), rtol=1e-9)
    wide = replace(ball, outer_groove=0.6)  # the outer ring counts for nothing but the force
    force = wide.element_forces(deflection).max() / ball.element_forces(deflection).max()
    assert_allclose(
        wide.largest_pressure(deflection), force ** (1.0 / 3.0) * ball.largest_pressure(deflection), rtol=1e-9
    )
    roller = BEARINGS["long roller"]
    line = roller.slice_forces(MOTIONS[0]).max() * 30.0 / 16.0
    steel = 210000.0 / (2.0 * 0.91)
    radius = 0.5 * 4.0 * (1.0 - 4.0 / 40.0)
    assert_allclose(roller.largest_pressure(MOTIONS[0]), math.sqrt(line * steel / (math.pi * radius)), rtol=1e-9)


@pytest.mark.parametrize(
    ("gamma", "balls", "rollers"),
    [(0.05, 46.7, 74.1), (0.1, 55.5, 84.2), (0.16, 59.6, 88.5), (0.2, 59.9, 88.7)],
)
def test_factors_are_those_of_the_tables_of_iso_281(gamma: float, balls: float, rollers: float) -> None:
    assert round(ball_factor(gamma, 0.52, 0.53), 1) == balls
    assert round(roller_factor(gamma), 1) == rollers


def test_large_balls_and_wide_grooves_have_lower_ratings() -> None:
    small, large = (ball_rating(9, size, 5.0 * size, 0.0, 0.52, 0.53) for size in (25.4, 25.5))
    assert_allclose(large, small, rtol=0.01)
    twice = ball_rating(9, 50.8, 5.0 * 50.8, 0.0, 0.52, 0.53)
    assert_allclose(twice / small, 2.0**1.4, rtol=1e-3)  # 3.647 of ISO 281 is 25.4^0.4 to its last digit
    assert ball_rating(9, 12.0, 60.0, 0.0, 0.53, 0.56) < 0.9 * ball_rating(9, 12.0, 60.0, 0.0, 0.52, 0.53)


def test_lives_fall_with_powers_of_the_load() -> None:
    forces = np.abs(np.random.default_rng(1).normal(size=9))
    lives = [ball_life(by * forces, 1e3, 0.2, 0.0, 0.52, 0.53) for by in (1.0, 2.0)]
    assert_allclose(lives[0] / lives[1], 8.0, rtol=1e-9)
    slices = np.abs(np.random.default_rng(2).normal(size=(14, 30)))
    lives = [roller_life(by * slices, 1e3, 0.15, 0.0) for by in (1.0, 2.0)]
    assert_allclose(lives[0] / lives[1], 16.0, rtol=1e-9)


@pytest.mark.parametrize("name", ["ball", "roller"])
def test_bearings_under_their_rating_last_about_a_million_revolutions(name: str) -> None:
    """Half of the ring loaded, ISO 281 means a life of one; profiles and single elements make it another."""
    bearing = replace(BEARINGS[name], clearance=0.0, rating=None)
    moved = under(bearing, np.array([bearing.dynamic_rating, 0.0, 0.0, 0.0, 0.0, 0.0]))
    assert 0.5 < bearing.life(moved) < 2.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"elements": 2}, "elements: found 2; allowed 3 and more"),
        ({"contact_angle": 1.0}, "contact_angle: found 57.2958 deg; allowed from 0 to 45"),
        ({"diameter": 19.0}, "diameter: 7 elements of 19 mm touch each other on a pitch diameter of 43.5 mm"),
        ({"inner_groove": 0.5}, "inner_groove: found 0.5; allowed above 0.5"),
    ],
)
def test_bearings_that_cannot_be_are_refused(values: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        replace(SMALL, **values)
