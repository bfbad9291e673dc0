"""The tangents of states: against dense problems solved anew, closed forms, limits."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import read_scene
from loaded_tca.contact import ContactProblem, contact_stiffness
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.errors import ConvergenceError
from loaded_tca.loaded.cycle import OnePairsCycle, solve_cycles
from loaded_tca.loaded.load_sharing import share_load
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.sensitivity import Tangents, loaded_states
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.loaded.tooth_pairs import tooth_pairs_at
from loaded_tca.results.gap_growth import growth_at_cap
from loaded_tca.separation.gap_change import contact_changes
from loaded_tca.separation.pair_change import pair_changes
from loaded_tca.unloaded import trace_contact, trace_teeth
from tests.samples.results import SCENES

TRANSMISSION_ERROR, OTHERS = 1e-8, 1e-6
"""Agreement asked for with dense problems whose set of active cells stays."""
RATE = 3e-6
"""Of the rate of the torque, whose linear systems are solved to 1e-6."""
MODULUS, TORQUE = 113187.0, 6000.0  # MPa, N mm
SHAPE, SPACING = (10, 9), (0.02, 0.15)
CAP = 540.0
"""Pressure [MPa] that 12 of 126 loaded cells have; without it the largest is 601 MPa."""
LEVERS = {0: (47.0, 80.0), 1: (46.0, 81.0)}  # mm, of pinion and wheel: as of a bevel pair


class DensePairs:
    """Two tooth pairs with slices that bend each other, and cut cells: K as a matrix, and active sets by hand."""

    def __init__(self, cap=None):
        x, y = (d * (np.arange(n) - 0.5 * (n - 1)) for n, d in zip(SHAPE, SPACING, strict=True))
        self.gaps = [
            x[:, None] ** 2 / 20.0 + (y - shift) ** 2 / 900.0 + lift for shift, lift in ((0.1, 0), (-0.2, 1e-4))
        ]
        cover = np.ones(SHAPE)
        cover[:, -3] = 0.4
        cover[:, -2:] = 0.0
        self.covers = [cover, None]
        apart = np.abs(y[:, None] - y)
        bend = 2e-7 * np.exp(-apart / 0.7)
        self.between_matrix = 6e-8 * np.exp(-np.abs(y[:, None] - y - 0.1) / 0.9)
        self.problems = [
            ContactProblem(
                np.where(np.ones(SHAPE) if cover is None else cover, gap, np.inf),
                SPACING,
                MODULUS,
                load=1.0,
                max_pressure=cap,
                slice_compliance=bend,
                cover=cover,
            )
            for gap, cover in zip(self.gaps, self.covers, strict=True)
        ]
        self.matrix = self._matrix(bend)
        self.gap = np.concatenate([gap.ravel() for gap in self.gaps])
        self.material = np.concatenate([np.isfinite(problem.gap).ravel() for problem in self.problems])
        size = SHAPE[0] * SHAPE[1]
        self.pinion, self.wheel = (np.repeat([LEVERS[k][gear] for k in (0, 1)], size) for gear in (0, 1))
        area = SPACING[0] * SPACING[1]
        parts = np.concatenate([np.ones(size) if cover is None else cover.ravel() for cover in self.covers])
        self.cap = np.inf if cap is None else cap * area * parts
        self.area = area

    def between(self, at, under):
        return self.between_matrix if at[0] > under[0] else self.between_matrix.T

    def _matrix(self, bend):
        dx, dy = SPACING
        love = influence_coefficients(SHAPE, np.array([dy / dx]))[0]
        i, j = (part.ravel() for part in np.indices(SHAPE))
        apart = np.abs(i[:, None] - i), np.abs(j[:, None] - j)
        half_space = love[apart] / (dy * MODULUS)
        blocks = []
        for cover in self.covers:
            crowded = np.ones(half_space.shape)
            if cover is not None:
                part = cover.ravel()
                cut = (part > 0.0) & (part < 1.0)
                both = cut[:, None] & cut & (apart[1] == 0)
                inverse = 1.0 / np.where(cut, part, 1.0)
                crowded += 0.94 * both * (np.minimum(inverse[:, None], inverse) - 1.0)
            blocks.append(half_space * crowded + bend[j[:, None], j])
        other = self.between_matrix[j[:, None], j]  # of pair 1 under pair 0
        return np.block([[blocks[0], other.T], [other, blocks[1]]])

    def solve(self, torque=TORQUE, gap=None, cap=None):
        """Forces, rotation and active cells: pulling cells dropped, penetrating ones added, capped ones held."""
        gap = self.gap if gap is None else gap
        cap = np.broadcast_to(self.cap if cap is None else cap, gap.shape)
        active, held = self.material.copy(), np.zeros(gap.shape, dtype=bool)
        for _ in range(100):
            forces, n = np.where(held, cap, 0.0), int(active.sum())
            left = np.zeros((n + 1, n + 1))
            left[:n, :n] = self.matrix[np.ix_(active, active)]
            left[:n, n], left[n, :n] = -self.wheel[active], self.pinion[active]
            right = np.append(-(gap + self.matrix @ forces)[active], torque - self.pinion @ forces)
            solution = np.linalg.solve(left, right)
            forces[active], rotation = solution[:n], solution[n]
            opening = gap + self.matrix @ np.where(np.isfinite(forces), forces, 0.0) - self.wheel * rotation
            over = active & (forces > cap)
            drop = active & (forces <= 0.0)
            add = self.material & ~active & ~held & (opening < 0.0)
            release = held & (opening > 0.0)
            if not (over | drop | add | release).any():
                return forces, rotation, active
            active, held = (active | add | release) & ~(drop | over), (held | over) & ~release
        raise AssertionError("no active set found")

    def tangent(self, torques=(TORQUE,)):
        return Tangents([self.grids(torque) for torque in torques], self)

    def grids(self, torque):
        forces, _, _ = self.solve(torque)
        pressures = np.split(forces / self.area, 2)
        capped = [problem.cap for problem in self.problems]
        pressures = [
            np.where(one.reshape(SHAPE) >= (1 - 1e-12) * cap, cap, one.reshape(SHAPE))
            for one, cap in zip(pressures, capped, strict=True)
        ]
        grids = []
        for number, (problem, pressure) in enumerate(zip(self.problems, pressures, strict=True)):
            pinion, wheel = LEVERS[number]
            contact = SimpleNamespace(pinion_lever=pinion, wheel_lever=wheel)
            grids.append(LoadedGrid(number, contact, None, problem, pressure))
        return grids


@cache
def dense(cap=None):
    return DensePairs(cap)


@pytest.fixture(params=[None, CAP], ids=["elastic", "capped"])
def pairs(request):
    return dense(request.param)


def changed(pairs, step=1e-6):
    """A change of the gap, and the states a step of it either side, with the same active cells."""
    change = np.random.default_rng(7).normal(size=pairs.gap.shape)
    states = [pairs.solve(gap=pairs.gap + sign * step * change) for sign in (-1.0, 1.0)]
    active = pairs.solve()[2]
    assert all((state[2] == active).all() for state in states), "no cell enters or leaves"
    return change, states, active, 2.0 * step


def test_dense_problem_has_pairs_that_share_and_cells_of_every_kind(pairs):
    forces, _, active = pairs.solve()
    assert all(part.any() for part in np.split(active, 2))
    assert (pairs.material & ~active).any()
    at_cap = pairs.material & (forces == pairs.cap)
    assert at_cap.any() == np.isfinite(pairs.cap).any()


def test_rotation_changes_with_the_gaps_as_the_dense_problem_solved_anew(pairs):
    change, (below, above), active, step = changed(pairs)
    expected = (above[1] - below[1]) / step
    assert_allclose(pairs.tangent().rotation_change(change[active]), expected, rtol=TRANSMISSION_ERROR)


def force_change(tangent, gaps):
    """Changes (n,) of the forces by changes (n,) of the gaps under the same torques: J_f is each force alone."""
    return np.array([tangent.functional_change(one, gaps)[0] for one in np.eye(gaps.size)])


def test_rotation_changes_with_the_torque_as_the_dense_problem_solved_anew(pairs):
    step = 0.5
    rotations = [pairs.solve(TORQUE + sign * step)[1] for sign in (-1.0, 1.0)]
    assert_allclose(pairs.tangent().stiffness, 2.0 * step / np.ptp(rotations), rtol=TRANSMISSION_ERROR)


def test_forces_at_the_cap_that_grow_turn_the_pairs_as_the_dense_problem_solved_anew():
    pairs, step = dense(CAP), 1e-4
    forces, _, active = pairs.solve()
    at_cap = pairs.material & (forces == pairs.cap)
    growth = np.where(at_cap, pairs.cap * np.random.default_rng(3).uniform(size=forces.size), 0.0)
    below, above = (pairs.solve(cap=pairs.cap + sign * step * growth) for sign in (-1.0, 1.0))
    assert all((state[2] == active).all() for state in (below, above)), "no cell enters or leaves"
    tangent = pairs.tangent()
    gaps = tangent.displaced_by([part.reshape(SHAPE) for part in np.split(growth, 2)])
    found = tangent.rotation_change(gaps, -pairs.pinion @ growth)
    assert_allclose(found, (above[1] - below[1]) / (2.0 * step), rtol=TRANSMISSION_ERROR)


def test_force_of_a_cell_at_the_cap_grows_with_its_part_of_material_and_no_other():
    grid = next(one for one in dense(CAP).grids(TORQUE) if (one.pressed & ~one.active).any())
    growth, step = np.random.default_rng(4).uniform(size=SHAPE), 1e-3
    half = np.where(np.isfinite(grid.problem.gap), 0.5, 0.0)
    less, more = (
        replace(grid.problem, cover=half * (1.0 + sign * step * growth)).cap * grid.problem.cell_area
        for sign in (-1.0, 1.0)
    )
    expected = np.where(grid.pressed & ~grid.active, (more - less) / step, 0.0)  # of covers that grow by that much
    found = growth_at_cap(grid, growth[None, grid.pressed])
    assert_allclose(found[0], expected, rtol=1e-9)  # a difference over 1e-3 of numbers rounded at 1e-16


@pytest.mark.quick_cases("capped")
def test_forces_change_with_gaps_and_torque_as_in_the_dense_problem(pairs):
    change, (below, above), active, step = changed(pairs)
    expected, tangent = ((above[0] - below[0]) / step)[active], pairs.tangent()
    assert_allclose(force_change(tangent, change[active]), expected, rtol=0, atol=OTHERS * np.abs(expected).max())
    steeper = [pairs.solve(TORQUE + sign * 0.5)[0][active] for sign in (-1.0, 1.0)]
    by_torque = steeper[1] - steeper[0]
    assert_allclose(
        tangent.by_rotation / tangent.spread(tangent.stiffness),
        by_torque,
        rtol=0,
        atol=OTHERS * np.abs(by_torque).max(),
    )


def test_numbers_of_the_forces_change_by_their_adjoint_as_by_the_forces(pairs):
    change, (below, above), active, step = changed(pairs)
    power, tangent, forces = 8.0, pairs.tangent(), pairs.solve()[0][active]
    scale = forces.max()
    slopes = power * (forces / scale) ** (power - 1.0) / scale
    expected = slopes @ ((above[0] - below[0]) / step)[active]
    gaps = np.stack([change[active], 0.0 * change[active]])
    found = tangent.functional_change(slopes, gaps, np.array([[0.0], [1.0]]))
    assert_allclose(found[:, 0], [expected, slopes @ tangent.by_rotation / tangent.stiffness[0]], rtol=OTHERS)


def test_share_of_a_pair_changes_as_the_dense_problem_solved_anew(pairs):
    change, (below, above), active, step = changed(pairs)
    first = np.arange(pairs.gap.size) < pairs.gap.size // 2
    slopes = np.where(first, pairs.pinion, 0.0) / TORQUE
    expected = slopes @ (above[0] - below[0]) / step
    found = pairs.tangent().functional_change(slopes[active], change[active])
    assert_allclose(found, expected, rtol=OTHERS)


@pytest.mark.quick_cases("elastic")
def test_torque_stays_under_changes_of_the_gaps(pairs):
    change, _, active, _ = changed(pairs)
    tangent = pairs.tangent()
    moved = tangent.pinion_levers * force_change(tangent, change[active])
    assert abs(moved.sum()) < 1e-8 * np.abs(moved).sum()


def test_removal_even_over_all_flanks_turns_the_wheel_by_itself_over_the_lever(pairs):
    tangent = pairs.tangent()
    assert_allclose(tangent.weights @ tangent.wheel_levers / tangent.stiffness, 1.0, rtol=TRANSMISSION_ERROR)


def test_states_are_found_together_as_each_alone(pairs):
    torques = (0.6 * TORQUE, TORQUE)
    together = pairs.tangent(torques)
    alone = [pairs.tangent((torque,)) for torque in torques]
    assert_allclose(together.stiffness, [one.stiffness[0] for one in alone], rtol=TRANSMISSION_ERROR)
    weights = np.concatenate([one.weights for one in alone])
    assert_allclose(together.weights, weights, rtol=0, atol=OTHERS * weights.max())


def test_rate_of_the_torque_is_that_of_the_dense_problem_solved_anew(pairs):
    step = 0.5
    rotations = [pairs.solve(TORQUE + sign * step)[1] for sign in (-1.0, 1.0)]
    assert_allclose(loaded_states([pairs.grids(TORQUE)], pairs).stiffness, 2.0 * step / np.ptp(rotations), rtol=RATE)


def test_rates_are_the_same_to_the_last_bit_whatever_is_found_together(pairs, monkeypatch):
    states = [pairs.grids(part * TORQUE) for part in (0.3, 0.6, 0.8, 1.0)]
    together = loaded_states(states, pairs).stiffness
    monkeypatch.setattr("loaded_tca.loaded.sensitivity.CELLS_TOGETHER", 1)
    assert_array_equal(loaded_states(states, pairs).stiffness, together)


def test_contacts_without_a_cell_between_the_bounds_have_no_part_in_the_rate():
    pairs = dense(CAP)
    first, second = pairs.grids(TORQUE)
    capped, none = (replace(first, pressure=p * np.isfinite(first.problem.gap)) for p in (first.problem.cap, 0.0))
    states = [[capped], [second], [capped, none], [capped, second, none], []]
    rate = loaded_states([[second]]).stiffness[0]
    # exact: each state by itself
    assert_array_equal(loaded_states(states, pairs).stiffness, [0.0, rate, 0.0, rate, 0.0])
    assert rate > 0.0
    assert_array_equal(loaded_states([]).stiffness, [])


def test_rate_of_one_contact_is_that_of_a_flat_punch_of_its_cells():
    pair = read_scene(SCENES / "mesh_cycle_bevel.toml").pair()
    path = trace_contact(pair, pair.pitch * np.array([-0.1, 0.2]))
    carried = solve_cycles(
        [OnePairsCycle(pair, path, np.array([30e3, 0.0, 90e3]), GridChoice(cells=(32, 32), tolerance=1e-8))]
    )[0]
    levers = path.pinion_lever * path.wheel_lever
    punches = [[levers[n] * contact_stiffness(carried.contacts[t][n][0].solution) for n in (0, 1)] for t in (0, 2)]
    assert_allclose(carried.torque_rate[[0, 2]], punches, rtol=RATE)
    assert_array_equal(carried.torque_rate[1], 0.0)


def test_linear_system_that_is_not_solved_in_time_is_an_error(monkeypatch):
    monkeypatch.setattr("loaded_tca.loaded.sensitivity.MOST_ITERATIONS", 2)
    with pytest.raises(ConvergenceError, match=r"tangents: a linear system of .* in 2 iterations"):
        dense().tangent()


@pytest.mark.parametrize("turn", [-0.3, 0.1, 0.45])
def test_helical_pair_turns_with_centre_distance_and_axial_offset_by_closed_forms(turn):
    # involutes stay conjugate: the line of action moves by sin(alpha_wt) and tan(beta_b) per mm, whatever the load
    scene = read_scene(SCENES / "mesh_cycle_helical.toml")
    pair, gear = scene.pair(), scene.mesh().pinion
    candidates = tooth_pairs_at(trace_teeth(pair, [turn * pair.pitch]), 0)
    shared = share_load(pair, candidates, 130e3, GridChoice(cells=(32, 32)))
    grids = [LoadedGrid.of(share.tooth_pair.pair, share.loaded) for share in shared.shares]
    tangent = Tangents([grids])
    changes = pair_changes(scene, ["mounting.centre_distance_error_mm", "mounting.axial_offset_mm"])
    contacts, separations = [grid.contact for grid in grids], [grid.separation for grid in grids]
    grown = contact_changes(pair, contacts, separations, [grid.active for grid in grids], changes).held_gaps
    found = -pair.driving * tangent.rotation_change(grown)[:, 0] * pair.base_radii[1]
    closed = [-np.sin(scene.mesh().working_pressure_angle), np.tan(abs(gear.base_helix_angle))]
    assert_allclose(found, closed, rtol=1e-3)
