"""Shafts in balance on rolling bearings: against closed forms, against differences, what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.material import Material
from loaded_tca.supports import BallBearing, Bearing, RollerBearing, Shaft, ShaftLoad, ShaftSection
from loaded_tca.supports.bearing import AnyBearing

STEEL = Material(206000.0, 0.3)
BALL = BallBearing(at=-130.0, elements=9, diameter=12.0, pitch_diameter=60.0, clearance=0.02)
ROLLER = RollerBearing(at=-40.0, elements=14, diameter=10.0, pitch_diameter=60.0, length=12.0, clearance=0.02)
TAPERED = RollerBearing(
    at=-130.0, elements=15, diameter=9.0, pitch_diameter=55.0, length=12.0, contact_angle=math.radians(14.0), side=1
)
OVERHUNG = np.array([-928.0, -2462.0, 660.0, 2000.0, -30000.0, 130000.0])
IN_BALANCE = 1e-8
"""Of the forces, to which they are in balance."""


def shaft(*bearings: AnyBearing, loads: tuple[ShaftLoad, ...] = ()) -> Shaft:
    sections = [ShaftSection(40.0, 35.0), ShaftSection(120.0, 40.0), ShaftSection(40.0, 45.0)]
    return Shaft(-180.0, sections, STEEL, -180.0, bearings, loads)


ARRANGEMENTS = {
    "ball and roller": (BALL, ROLLER),
    "two balls": (BALL, replace(BALL, at=-40.0, clearance=0.0)),
    "angular, preloaded": (
        replace(BALL, contact_angle=math.radians(40.0), side=1, clearance=0.0, preload=0.005),
        replace(BALL, at=-40.0, contact_angle=math.radians(40.0), side=-1, clearance=0.0, preload=0.005),
    ),
    "tapered, with end play": (
        replace(TAPERED, preload=-0.01),
        replace(TAPERED, at=-40.0, side=-1, preload=-0.01),
    ),
    "roller and a linear one": (ROLLER, Bearing(-130.0, np.diag([2e5, 2e5, 1e5, 0.0, 0.0, 0.0]))),
}


def motion(one: Shaft, load: Array) -> Array:
    """Exact motion of the gear, at 0, under a load there."""
    return np.asarray(one.solved([0.0], load).at_places[0] @ np.append(load, 1.0))


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_forces_on_bearings_balance_the_load(name: str) -> None:
    bearings = ARRANGEMENTS[name]
    solved = shaft(*bearings).solved([0.0], OVERHUNG)
    forces, motions = (one @ np.append(OVERHUNG, 1.0) for one in (solved.on_bearings, solved.at_bearings))
    levers = np.array([[0.0, 0.0, one.at] for one in bearings])
    assert_allclose(forces[:, :3].sum(axis=0), OVERHUNG[:3], atol=IN_BALANCE * np.abs(OVERHUNG[:3]).max())
    moments = forces[:, 3:5].sum(axis=0) + np.cross(levers, forces[:, :3])[:, :2].sum(axis=0)
    assert_allclose(moments, OVERHUNG[3:5], atol=IN_BALANCE * np.abs(OVERHUNG[:3]).max() * 180.0)
    for bearing, force, moved in zip(bearings, forces, motions, strict=True):
        assert_allclose(force, bearing.reaction(moved).force, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_compliance_is_the_slope_of_the_motions(name: str) -> None:
    one, steps = shaft(*ARRANGEMENTS[name]), np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0])
    compliance = one.solved([0.0], OVERHUNG).at_places[0][:, :-1]
    slopes = np.stack(
        [
            (motion(one, OVERHUNG + step * np.eye(6)[k]) - motion(one, OVERHUNG - step * np.eye(6)[k])) / (2.0 * step)
            for k, step in enumerate(steps)
        ],
        axis=1,
    )
    scale = np.sqrt(np.outer(*[compliance.diagonal()] * 2))
    assert (np.abs(slopes - compliance) < 1e-3 * scale).all()  # of rollers slices come and go
    assert_allclose(compliance, compliance.T, atol=1e-9 * scale.max())


@pytest.mark.parametrize("seed", range(30))
def test_shafts_find_their_balance_whatever_bearings_and_load(seed: int) -> None:
    """Loads from 1 N on, in clearances up to a tenth of a millimetre, preloads, pressed rings."""
    random = np.random.default_rng(seed)
    first, second = -180.0 + random.uniform(0.0, 80.0), -10.0 + random.uniform(0.0, 30.0)
    size, clearance = random.uniform(5.0, 20.0), random.choice([-0.01, 0.0, 0.02, 0.1])
    ball = BallBearing(at=first, elements=9, diameter=size, pitch_diameter=5.0 * size, clearance=clearance)
    roller = RollerBearing(at=second, elements=12, diameter=size, pitch_diameter=5.0 * size, length=1.5 * size)
    angle, preload = math.radians(random.uniform(10.0, 40.0)), random.choice([-0.05, 0.0, 0.02])
    set_against = replace(ball, contact_angle=angle, clearance=0.0, preload=preload)
    tapered = replace(roller, contact_angle=angle, preload=preload)
    bearings = [
        (ball, replace(roller, clearance=clearance)),
        (set_against, replace(set_against, at=second, side=-1)),
        (replace(tapered, at=first), replace(tapered, side=-1)),
    ][seed % 3]
    load = 10.0 ** random.uniform(0.0, 4.5) * random.normal(size=6) * [1.0, 1.0, 1.0, 30.0, 30.0, 30.0]
    solved = shaft(*bearings).solved([0.0], load)
    forces = (solved.on_bearings @ np.append(load, 1.0))[:, :3].sum(axis=0)
    assert_allclose(forces, load[:3], atol=1e-6 * np.abs(load).max())


def test_forces_of_bearings_are_linear_near_the_load() -> None:
    one, change = shaft(BALL, ROLLER), np.array([5.0, -3.0, 2.0, 100.0, -50.0, 0.0])
    near = one.solved([0.0], OVERHUNG)
    exact = one.solved([0.0], OVERHUNG + change)
    for name in ("on_bearings", "at_bearings"):
        linear, there = (getattr(each, name) @ np.append(OVERHUNG + change, 1.0) for each in (near, exact))
        size = np.abs(there - getattr(near, name) @ np.append(OVERHUNG, 1.0)).max()
        assert_allclose(linear, there, atol=0.01 * size)


def test_nodes_added_change_nothing() -> None:
    one = shaft(BALL, ROLLER)
    more = one.solved([0.0, -100.0, -77.0, 10.0], np.append(OVERHUNG, np.zeros(18)))
    there = more.at_places[0][:, [*range(6), -1]] @ np.append(OVERHUNG, 1.0)
    assert_allclose(there, motion(one, OVERHUNG), rtol=1e-7, atol=1e-12)  # atol: mm and rad, where nothing moves


def test_gear_in_the_middle_of_equal_bearings_sinks_as_they_do() -> None:
    """The shaft is thick and short; each bearing carries half, the first element below the force."""
    rigid = ShaftSection(20.0, 400.0)
    roller = replace(ROLLER, pitch_diameter=60.0)
    hold = Bearing(0.0, np.diag([0.0, 0.0, 1e6, 0.0, 0.0, 0.0]))
    one = Shaft(-10.0, [rigid], STEEL, 0.0, [replace(roller, at=-5.0), replace(roller, at=5.0), hold])
    load = np.array([2000.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    sunk = motion(one, load)[0]
    assert_allclose(roller.reaction(np.array([sunk, 0.0, 0.0, 0.0, 0.0, 0.0])).force[0], 1000.0, rtol=2e-3)


def test_shaft_at_rest_stays_in_the_middle_of_its_clearances() -> None:
    assert not motion(shaft(BALL, ROLLER), np.zeros(6)).any()


def test_weight_drops_the_shaft_by_its_clearance() -> None:
    weight = ShaftLoad(-85.0, np.array([-20.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
    dropped = motion(shaft(BALL, replace(ROLLER, clearance=0.02), loads=(weight,)), np.zeros(6))
    assert -0.013 < dropped[0] < -0.010  # balls beside the force, 9 of them, are a little lower


def test_preload_makes_stiffer() -> None:
    load = 0.3 * OVERHUNG
    diagonals = []
    for preload in (0.0, 0.01):
        bearings = [replace(one, preload=preload) for one in ARRANGEMENTS["angular, preloaded"]]
        diagonals.append(shaft(*bearings).solved([0.0], load).at_places[0].diagonal()[:5])
    assert (diagonals[1] < diagonals[0]).all()


def test_linear_bearings_do_not_ask_for_the_load() -> None:
    one = shaft(*(Bearing(at, np.diag([2e5, 2e5, 1e5, 0.0, 0.0, 0.0])) for at in (-130.0, -40.0)))
    near, plain = one.solved([0.0], OVERHUNG), one.solved([0.0])
    assert one.is_linear
    assert np.array_equal(near.at_nodes, plain.at_nodes)
    assert np.array_equal(near.on_bearings, plain.on_bearings)


@pytest.mark.parametrize(
    ("bearings", "message"),
    [
        ((BALL,), "1 bearing leaves the shaft free about"),
        ((BALL, replace(BALL)), "2 bearings leave the shaft free about"),
        ((ROLLER, replace(ROLLER, at=-130.0)), "2 bearings leave the shaft free along its axis"),
    ],
)
def test_rolling_bearings_that_leave_the_shaft_free_are_refused(bearings: tuple[AnyBearing, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        shaft(*bearings)


def test_thrust_that_no_bearing_takes_is_refused() -> None:
    one = shaft(replace(TAPERED, side=-1), ROLLER)
    with pytest.raises(
        InputError, match=r"none takes the axial force of 660 N; allowed are bearings of which one has side = 1"
    ):
        one.solved([0.0], OVERHUNG)


def test_bearing_whose_own_thrust_nothing_takes_is_refused() -> None:
    one = shaft(TAPERED, Bearing(-40.0, np.diag([2e5, 2e5, 0.0, 0.0, 0.0, 0.0])))
    with pytest.raises(InputError, match=r"no balance .* needs another bearing that takes its thrust"):
        one.solved([0.0], OVERHUNG * np.array([1.0, 1.0, 0.0, 1.0, 1.0, 1.0]))


@pytest.mark.parametrize("elements", [7, 8, 9, 11])
@pytest.mark.parametrize("load", [0.0, 1e-4, 1e-2])
def test_pressed_bearings_find_their_balance_under_next_to_no_load(elements: int, load: float) -> None:
    pressed = [
        BallBearing(at=at, elements=elements, diameter=14.1, pitch_diameter=74.1, clearance=-0.03)
        for at in (-130.0, -40.0)
    ]
    one = shaft(*pressed)
    forces = np.array([load, 0.3 * load, 0.0, 0.0, 0.0, 0.0])
    solved = one.solved([0.0], forces)
    on_bearings = solved.on_bearings[..., :-1] @ forces + solved.on_bearings[..., -1]
    assert_allclose(on_bearings[:, :3].sum(axis=0), forces[:3], atol=1e-8)  # elements carry 1 kN, to 1e-11
