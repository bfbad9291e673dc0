"""Supports of gears: their loads and motions, what they do to gaps, the pair that they move."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import parse_scene
from loaded_tca.arrays import Array
from loaded_tca.cli import DEMO_SCENE
from loaded_tca.errors import InputError
from loaded_tca.pairs.gear_pair import GearPair, MovedSlices
from loaded_tca.supports import Support, SupportCompliance, moved_pair
from loaded_tca.supports.support import rotation

ROUNDING = 1e-12  # sums of forces, turns and products of order one


@dataclass(frozen=True, eq=False)
class Slices:
    """Slices along the axis at one place."""

    y: Array
    origin: Array
    axes: Array
    force_line: Array


@pytest.fixture(scope="module")
def pair() -> GearPair:
    return parse_scene(DEMO_SCENE.read_text()).pair()


def slices_at(point: Array, normal: Array, count: int = 5) -> Slices:
    along = np.array([0.0, 0.0, 1.0])
    return Slices(
        np.linspace(-8.0, 8.0, count), point, np.stack([np.cross(along, normal), along, normal]), np.zeros(count)
    )


def random_matrix(size: int, seed: int) -> Array:
    half = np.random.default_rng(seed).normal(size=(size, size))
    return 1e-6 * half @ half.T


def test_loads_have_the_sum_of_the_forces_and_their_moment() -> None:
    support = Support(3.0, np.zeros((18, 18)), np.array([-10.0, 0.0, 12.0]))
    rng = np.random.default_rng(1)
    points, force = rng.uniform(-10.0, 10.0, (6, 3)), rng.normal(size=3)
    loads = support.loads(points, force).sum(axis=0).reshape(3, 6)
    stations = support.places[:, None] * np.array([0.0, 0.0, 1.0])
    moments = loads[:, 3:] + np.cross(stations, loads[:, :3])
    assert_allclose(loads[:, :3].sum(axis=0), 6.0 * force, atol=ROUNDING)
    assert_allclose(moments.sum(axis=0), np.cross(points, force).sum(axis=0), rtol=0, atol=1e-10)  # 4e-15 seen


def test_stations_on_a_rigid_body_do_the_work_of_its_middle() -> None:
    support, rng = Support(3.0, np.zeros((18, 18)), np.array([-10.0, 0.0, 12.0])), np.random.default_rng(2)
    points, force, motion = rng.uniform(-10.0, 10.0, (6, 3)), rng.normal(size=3), rng.normal(size=6)
    alone = Support(3.0, np.zeros((6, 6)))
    moved = support.loads(points, force) @ support.with_middle(motion)
    assert_allclose(moved, alone.loads(points, force) @ motion, atol=ROUNDING)
    assert_allclose(support.at_middle(support.with_middle(motion)), motion, atol=ROUNDING)


def test_motion_of_the_middle_lies_between_the_stations() -> None:
    support = Support(2.0, np.zeros((12, 12)), np.array([0.0, 8.0]))
    motions = np.concatenate([np.zeros(6), np.full(6, 4.0)])
    assert_allclose(support.at_middle(motions), 1.0)


def test_shapes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match=r"compliance: shape \(6, 6\), expected 12 twice"):
        Support(0.0, np.zeros((6, 6)), np.array([0.0, 1.0]))
    with pytest.raises(InputError, match=r"motion: shape \(3,\)"):
        Support(0.0, np.zeros((6, 6)), motion=np.zeros(3))


def test_compliance_is_symmetric_positive_and_of_low_rank(pair: GearPair) -> None:
    supports = Support(0.0, random_matrix(6, 1)), Support(0.0, random_matrix(6, 2))
    part = SupportCompliance(pair, supports, np.stack([np.eye(3), pair.wheel_axes]))
    normal = np.array([math.sin(0.35), math.cos(0.35), 0.0])
    one = slices_at(np.array([40.0, 3.0, 1.0]), normal, 17)
    other = slices_at(np.array([44.0, -2.0, -3.0]), normal, 19)
    both = np.block(
        [
            [part.within(0, one), part.between((0, one), (1, other))],
            [part.between((1, other), (0, one)), part.within(1, other)],
        ]
    )
    values = np.linalg.eigvalsh(both)
    assert_allclose(both, both.T, atol=ROUNDING * np.abs(both).max())
    # also below: eigenvalues that are zero are rounding of the largest
    assert values[0] > -1e-10 * values[-1]
    assert np.count_nonzero(values > 1e-10 * values[-1]) <= 12
    forces = np.arange(19.0)
    assert_allclose(part.deflection((0, one), (1, other), forces), part.between((0, one), (1, other)) @ forces)


def test_gap_grows_by_the_way_of_the_points_along_the_normal(pair: GearPair) -> None:
    rigid = Support(0.0, np.zeros((6, 6)))
    part = SupportCompliance(pair, (rigid, rigid), np.stack([np.eye(3), pair.wheel_axes]))
    normal = np.array([math.sin(0.35), math.cos(0.35), 0.0])
    grid = slices_at(np.array([40.0, 3.0, 1.0]), normal)
    shift = np.array([0.01, -0.02, 0.03])
    same = [np.concatenate([shift, np.zeros(3)]), np.concatenate([pair.wheel_axes @ shift, np.zeros(3)])]
    assert_allclose(part.gap_by_motion(grid, same), 0.0, atol=ROUNDING)
    wheel_alone = part.gap_by_motion(grid, [np.zeros(6), same[1]])
    assert_allclose(wheel_alone, normal @ shift)
    turned = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1e-3])  # about the axis: the lever of the normal force
    lever = np.cross(grid.origin - pair.wheel_origin, normal)[2]
    assert_allclose(part.gap_by_motion(grid, [np.zeros(6), turned]), 1e-3 * lever * pair.wheel_axes[2, 2], rtol=1e-9)


def test_deflection_grows_as_differences_say_where_the_wheel_and_the_slices_move(pair: GearPair) -> None:
    """Two contacts of one state and one of another; a slice without force is left out."""
    step, rng = 1e-4, np.random.default_rng(11)
    supports = (Support(1.0, random_matrix(6, 3)), Support(-2.0, random_matrix(18, 4), np.array([-10.0, 0.0, 12.0])))
    compliance = SupportCompliance(pair, supports, np.stack([np.eye(3), pair.wheel_axes]))
    normals = [np.array([np.sin(tilt), np.cos(tilt), 0.0]) for tilt in (0.3, 0.5, 0.4)]
    places = [np.array([35.0, 2.0 * n, 1.0]) for n in range(3)]
    contacts = [(n, slices_at(*where)) for n, where in enumerate(zip(places, normals, strict=True))]
    state, forces, ways = np.array([0, 0, 1]), rng.random(15), rng.normal(size=(4, 3))
    forces[7] = 0.0

    def side(part: float) -> tuple[GearPair, list[Slices]]:
        gears = replace(pair, wheel_origin=pair.wheel_origin + part * step * ways[3])
        slices = [
            replace(one, origin=one.origin + part * step * way) for (_, one), way in zip(contacts, ways, strict=False)
        ]
        return gears, slices

    def deflection(gears: GearPair, slices: list[Slices]) -> Array:
        there, (first, second, third) = compliance.mounted(gears), np.split(forces, 3)
        one, two, three = enumerate(slices)
        return np.concatenate(
            [
                there.deflection(one, one, first) + there.deflection(one, two, second),
                there.deflection(two, one, first) + there.deflection(two, two, second),
                there.deflection(three, three, third),
            ]
        )

    low, high = side(-0.5), side(0.5)
    expected = np.where(forces > 0.0, (deflection(*high) - deflection(*low)) / step, 0.0)
    (found,) = compliance.deflection_growth(contacts, state, forces, [MovedSlices(low, high, step)])
    # bilinear in the ways of both: the differences are rounded to 1e-16 of the deflection over the step
    assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())


def test_moved_pair_keeps_distances_where_both_gears_move_as_one_body(pair: GearPair) -> None:
    rigid = Support(0.0, np.zeros((6, 6)))
    turn = np.array([2e-4, -1e-4, 3e-4])
    pinion = np.concatenate([np.zeros(3), turn])
    wheel_shift = np.cross(turn, pair.wheel_origin)
    wheel = np.concatenate([pair.wheel_axes @ wheel_shift, pair.wheel_axes @ turn])
    moved = moved_pair(pair, (rigid, rigid), [pinion, wheel])
    second_order = 2.0 * float(turn @ turn) * np.linalg.norm(pair.wheel_origin)
    assert_allclose(moved.wheel_origin, pair.wheel_origin, atol=second_order)
    assert_allclose(moved.wheel_axes, pair.wheel_axes, atol=ROUNDING)


def test_loads_of_gears_that_move_as_one_body_turn_with_them(pair: GearPair) -> None:
    supports = Support(3.0, np.zeros((6, 6))), Support(-2.0, np.zeros((6, 6)))
    at_rest = SupportCompliance(pair, supports, np.stack([np.eye(3), pair.wheel_axes]))
    turn = np.array([2e-2, -1e-2, 3e-2])
    turned, axis = rotation(turn), np.array([0.0, 0.0, 1.0])
    middles = 3.0 * axis, pair.wheel_origin - 2.0 * pair.wheel_axes[2]
    motions = [
        np.concatenate([own @ (turned @ middle - middle), own @ turn])
        for own, middle in zip(at_rest.axes, middles, strict=True)
    ]
    moved = at_rest.moved(motions)
    assert_allclose(moved.pair.wheel_origin, pair.wheel_origin, rtol=0, atol=1e-10)  # mm: 9e-16 seen
    assert_allclose(moved.pair.wheel_axes, pair.wheel_axes, atol=ROUNDING)
    grid = slices_at(np.array([40.0, 3.0, 1.0]), np.array([math.sin(0.35), math.cos(0.35), 0.0]))
    for own, before, after in zip(at_rest.axes, at_rest.loads(grid), moved.loads(grid), strict=True):
        in_own_axes = np.kron(np.eye(2), own @ turned @ own.T)
        assert_allclose(after, before @ in_own_axes.T, atol=1e-9)
