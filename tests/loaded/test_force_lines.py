"""Teeth that bend at the centres of pressure: against slopes of a bilinear compliance by hand, and dense problems."""

import warnings
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, read_scene, sample_separation, trace_contact
from loaded_tca.errors import AccuracyWarning
from loaded_tca.loaded.force_lines import bending_by_shift
from loaded_tca.loaded.sensitivity import Tangents
from tests.samples.gear_pairs import gear_pair
from tests.samples.results import SCENES

FAR = 15.0
"""Times the motion of the lines, with which they displace more than what they follow: K^-1 of it is no correction."""


class Bilinear:
    """Teeth whose compliance grows linearly with the places of both slices, more at one end of each contact."""

    HIGHER = np.array([0.3, -0.2, 0.1])  # 1/mm, in the fixed frame

    def within(self, number, grid, under=None):
        return (2.0 + number) * self.between((number, grid), (number, grid if under is None else under))

    def between(self, at, under):
        (higher, along), (other, beside) = ((self.height(grid), self.ending(grid)) for _, grid in (at, under))
        return 1e-6 * (higher[:, None] * beside + along[:, None] * other)

    def height(self, grid):
        return (grid.origin + grid.force_line[:, None] * grid.axes[0]) @ self.HIGHER

    @staticmethod
    def ending(grid):
        return 1.0 + 0.4 * grid.y


def loaded_grids(rng):
    """Two tooth pairs of a state, and one of another."""
    pair, grids = gear_pair(), []
    for number, pitches, cells in ((0, -0.3, (6, 5)), (1, 0.2, (5, 7)), (0, 0.1, (6, 4))):
        contact = trace_contact(pair, [pitches * pair.pitch])[0]
        grid = sample_separation(pair, contact, cells=cells, box=(0.2, 2.0))
        force, bending = rng.random(cells[1]), Bilinear().within(number, grid)
        grids.append(SimpleNamespace(number=number, separation=grid, slice_force=force, bending=bending))
    return grids, np.array([0, 0, 1])


def test_slices_bend_by_shifts_of_the_forces_under_their_own_load_and_that_of_other_pairs(rng):
    """Slopes of the bilinear compliance by hand, times the forces; the third pair is of another state."""
    grids, state = loaded_grids(rng)
    shifts = [rng.random(grid.slice_force.size) for grid in grids]
    found = bending_by_shift(grids, state, Bilinear()) @ np.concatenate(shifts)
    expected = []
    for j, at in enumerate(grids):
        grown = np.zeros(at.slice_force.size)
        for i, under in enumerate(grids):
            if state[i] == state[j]:
                factor = 1e-6 * (2.0 + at.number if i == j else 1.0)
                own, other = (Bilinear.HIGHER @ grid.separation.axes[0] for grid in (at, under))
                ending, beside = (Bilinear.ending(grid.separation) for grid in (at, under))
                grown += factor * (own * shifts[j] * (beside @ under.slice_force))
                grown += factor * ending * (other * shifts[i] @ under.slice_force)
        expected.append(grown)
    assert_allclose(found, np.concatenate(expected), rtol=1e-9)


@cache
def tangents(times=1.0):
    """Of two states of helical gears, under teeth whose compliance follows the places of the forces, so many times."""
    coarse = {"analysis.cells": (16, 16), "analysis.positions": 3, "analysis.compliance": "contact"}
    changes = {**coarse, "analysis.free_edges": False, "analysis.torques_Nm": (130.0,), "analysis.accuracy": None}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges
        result = analyse(read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(changes))
    states = [
        [replace(grid, bending=Bilinear().within(grid.number, grid.separation)) for grid in state]
        for state in result.states[1][0].grids
    ]
    held = Tangents(states)
    return held, held.with_lines(times * bending_by_shift(held.grids, held.state, Bilinear()))


@pytest.mark.parametrize("times", [1.0, FAR])
def test_forces_of_lines_that_follow_displace_the_cells_as_asked_and_the_transposed_system_is_adjoint(times, rng):
    held, follow = tangents(times)
    one, two = rng.normal(size=(2, held.grid.size))
    forces, adjoint = follow.solved(one), follow.solved(two, transposed=True)
    shifts = np.zeros(follow.by_shift.shape[0])
    ends = np.cumsum([grid.active.shape[1] for grid in held.grids])
    for grid, cells, end in zip(held.grids, np.split(forces, held.ends[:-1]), ends, strict=True):
        across, along = np.nonzero(grid.active)
        arms = (grid.separation.x[across] - grid.separation.force_line[along]) / grid.slice_force[along]
        shifts[end - grid.active.shape[1] : end] = np.bincount(along, arms * cells, grid.active.shape[1])
    columns = np.concatenate(
        [grid.active.nonzero()[1] + end - grid.active.shape[1] for grid, end in zip(held.grids, ends, strict=True)]
    )
    # the tolerance of the systems is 1e-10
    assert_allclose(held.displaced(forces) + (follow.by_shift @ shifts)[columns], one, rtol=0, atol=1e-7)
    assert_allclose(adjoint @ one, two @ forces, rtol=1e-7)
    assert np.abs(forces - held.solved(one)).max() > 1e-3 * np.abs(forces).max(), "the lines matter"
