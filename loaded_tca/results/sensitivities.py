"""Sensitivities of a result: its derivatives to modifications, mounting errors and the torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import tooth_compliance
from loaded_tca.errors import InputError, require
from loaded_tca.loaded.cycle import farthest_apart
from loaded_tca.loaded.free_edges import edge_compliance
from loaded_tca.loaded.load_sharing import ToothPair, tooth_pairs_at
from loaded_tca.loaded.pair_coupling import BendingModel
from loaded_tca.loaded.sensitivity import LoadedGrid, Tangent, followed_changes
from loaded_tca.loaded.tooth_contact import contact_problem
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.key_figures import harmonic_coefficients
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.separation import sample_separation
from loaded_tca.separation.gap_change import PairChange, gap_change, pair_changes
from loaded_tca.unloaded import trace_contact, trace_teeth

if TYPE_CHECKING:
    import xarray

    from loaded_tca.results.mesh_cycle import MeshCycle

TORQUE = "load.pinion_torque_Nm"
NEWTON_MILLIMETRES = 1e3
"""Of a newton metre."""
LINEAR = 1e-7
"""Tolerance of the linear systems, which are known to the grid's percent."""
LEVERS_ALIKE = 1e-2
"""Relative difference of levers that comes from the slopes of modifications alone."""


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """Derivatives of a result to keys of its scene; NaN where nothing is in contact or nothing is loaded.

    Found when they are asked for: the transmission error costs one linear problem for each state, the others one more
    for each loaded tooth pair, however many keys there are.

    Attributes
    ----------
    keys : tuple of str
        As of ``scene.with_changes``; the unit of each is in its name.
    result : MeshCycle
        What they are derivatives of.
    states : tuple of State
        Torques and positions under load.
    """

    keys: tuple[str, ...]
    result: MeshCycle
    states: tuple[State, ...]

    @cached_property
    def transmission_error(self) -> Array:
        """Of the loaded, absolute transmission error, (torque, position, key) [rad per unit of the key]."""
        found = np.full((*self.result.transmission_error.shape, len(self.keys)), np.nan)
        for state in self.states:
            change = state.tangent.rotation_change(state.gaps, state.torques)
            found[state.torque, state.position] = -self.result.gear_pair.driving * change
        return found

    @cached_property
    def load_share(self) -> Array:
        """Of the shares in the torque, (torque, position, pair, key) [1 per unit]; zero where nothing is carried."""
        found = np.full((*self.result.load_share.shape, len(self.keys)), np.nan)
        for state in self.states:
            place = state.torque, state.position
            found[place][~np.isnan(self.result.load_share[place])] = 0.0
            torque, tangent = float(self.result.torque[state.torque]), state.tangent
            for pair, part, lever in zip(state.pairs, tangent.parts, state.lever_torques, strict=True):
                slopes = np.zeros(tangent.pinion_levers.shape)
                slopes[part] = tangent.pinion_levers[part]
                own = tangent.functional_change(slopes, state.gaps, state.torques)[0] + lever
                raised = np.array([NEWTON_MILLIMETRES if key == TORQUE else 0.0 for key in self.keys])
                found[*place, pair] = (own - self.result.load_share[*place, pair] * raised) / torque
        return found

    @cached_property
    def line_load(self) -> Array:
        """Of the largest force per length along each contact, (torque, position, pair, key) [N/mm per unit]."""
        found = np.full((*self.result.load_share.shape, len(self.keys)), np.nan)
        for state in self.states:
            tangent = state.tangent
            for pair, part, grid in zip(state.pairs, tangent.parts, tangent.grids, strict=True):
                slopes = np.zeros(tangent.pinion_levers.shape)
                slopes[part] = _line_load_slopes(grid)
                change = tangent.functional_change(slopes, state.gaps, state.torques)[0]
                found[state.torque, state.position, pair] = change
        return found

    @property
    def dataset(self) -> xarray.Dataset:
        """All as a dataset with the dimensions torque, position, pair and key."""
        import xarray

        coordinates = {name: self.result.dataset[name] for name in ("torque", "pinion_angle", "pair")}
        arrays = {
            "transmission_error": (("torque", "position", "key"), self.transmission_error),
            "load_share": (("torque", "position", "pair", "key"), self.load_share),
            "line_load": (("torque", "position", "pair", "key"), self.line_load),
        }
        return xarray.Dataset(arrays, {**coordinates, "key": list(self.keys)})

    @property
    def peak_to_peak(self) -> Array:
        """Of the peak-to-peak transmission error, (torque, key) [rad per unit]; NaN with one position.

        That of the highest position less that of the lowest one.
        """
        errors, slopes = self.result.transmission_error, self.transmission_error
        found = np.full((len(errors), len(self.keys)), np.nan)
        for t, error in enumerate(errors):
            if np.isfinite(error).sum() > 1:
                found[t] = slopes[t, np.nanargmax(error)] - slopes[t, np.nanargmin(error)]
        return found

    def harmonics(self, count: int) -> Array:
        """Of the amplitudes of ``MeshCycle.harmonics``, (torque, order, key) [rad per unit]; NaN where they are."""
        amplitudes = self.result.harmonics(count)
        found = np.full((*amplitudes.shape, len(self.keys)), np.nan)
        for t, error in enumerate(self.result.transmission_error):
            wave = harmonic_coefficients(error, count)
            for k in range(len(self.keys)):
                slope = harmonic_coefficients(self.transmission_error[t, :, k], count)
                known = np.isfinite(amplitudes[t]) & np.isfinite(slope) & (amplitudes[t] > 0.0)
                found[t, known, k] = (wave[known].conj() * slope[known]).real / amplitudes[t, known]
        return found


def sensitivities(result: MeshCycle, keys: Sequence[str]) -> Sensitivities:
    """Derivatives of a result to keys of its scene; see :meth:`MeshCycle.sensitivities`."""
    require(
        (not isinstance(keys, str), f"keys: {keys!r:.80} is one text; allowed is a list of keys"),
        (len(set(keys)) == len(keys), "keys: a key is given twice"),
    )
    wanted, pair = result.scene.analysis, result.gear_pair
    named = [key for key in keys if key != TORQUE]
    changes, at = pair_changes(result.scene, named), [keys.index(key) for key in named]
    angles, alone = result.pinion_angle, not wanted.load_sharing
    unloaded, apart = _unloaded(pair, angles, alone)
    both = None
    if _levers_differ(unloaded):
        both = [[_unloaded(side, angles, alone)[0] for side in (change.below, change.above)] for change in changes]
    bending = None if wanted.compliance == "contact" else tooth_compliance(pair, neighbours=apart)
    states = []
    for t, n in np.ndindex(result.transmission_error.shape):
        grids, places = [], []
        for k, number in enumerate(result.dataset["pair"].values.tolist()):
            one = result.maps[t][n][k]
            if one is not None and one.pressure.any():
                grid = _loaded_grid(result, pair, one, unloaded[n][number], bending)
                if grid.active.any():
                    grids.append(grid)
                    places.append(k)
        if not grids:
            continue
        tangent = Tangent(grids, bending, tolerance=LINEAR)
        grown = [gap_change(pair, grid.contact, grid.separation, changes) for grid in grids]
        followed = followed_changes(pair, grids, grown, bending, wanted.free_edges)
        levers = np.zeros((2, len(grids), len(changes)))
        if both is not None:
            for place in np.ndindex(levers.shape[1:]):
                number, change = grids[place[0]].number, place[1]
                levers[:, *place] = _lever_change(changes[change], both[change], n, number)
        back = pair.driving * (result.path.transmission_error[n] - result.transmission_error[t, n])
        for rest, grid, own in zip(followed, grids, levers[1], strict=True):
            beyond = back - unloaded[n][grid.number].initial_separation
            rest -= (beyond * own)[:, None, None]
        gaps = np.zeros((len(keys), tangent.pinion_levers.size))
        gaps[at] = tangent.gathered(followed)
        forces = np.array([grid.pressure.sum() * grid.problem.cell_area for grid in grids])
        lever_torques, torques = np.zeros((len(grids), len(keys))), np.full(len(keys), NEWTON_MILLIMETRES)
        lever_torques[:, at] = forces[:, None] * levers[0]
        torques[at] = -lever_torques[:, at].sum(axis=0)
        states.append(State(t, n, tuple(places), tangent, gaps, torques, lever_torques))
    return Sensitivities(tuple(keys), result, tuple(states))


@dataclass(frozen=True, eq=False)
class State:
    """What the keys change in the equilibrium of one torque and position.

    Attributes
    ----------
    torque, position : int
        Indices.
    pairs : tuple of int
        Indices of the pairs under load.
    tangent : Tangent
    gaps : (keys, n) array [mm per unit]
        Growth of the gaps at the active cells, on grids that follow their contacts.
    torques : (keys,) array [N mm per unit]
        Growth of the torque that the forces balance with the levers as they are.
    lever_torques : (pairs, keys) array [N mm per unit]
        Growth of the torque of each pair by that of its lever: levers are those of the unloaded contact points, which
        move.
    """

    torque: int
    position: int
    pairs: tuple[int, ...]
    tangent: Tangent
    gaps: Array
    torques: Array
    lever_torques: Array


Unloaded = list[dict[int, ToothPair]]
"""Unloaded contacts by position and number of the tooth pair, in the angles of their own teeth."""


def _unloaded(pair: GearPair, angles: Array, alone: bool) -> tuple[Unloaded, int]:
    """Unloaded contacts, and how many pitches those of a position are apart."""
    if alone:
        path = trace_contact(pair, angles)
        return [{0: ToothPair(0, path[n], 0.0)} for n in range(len(path))], 1
    mesh = trace_teeth(pair, angles)
    found: Unloaded = [{one.pair: one for one in tooth_pairs_at(mesh, n)} for n in range(len(mesh))]
    return found, max(farthest_apart(mesh), 1)


def _levers_differ(unloaded: Unloaded) -> bool:
    """Whether the levers depend on the place of the contact, as on bevel gears, by more than its slopes.

    Contacts on edges have normals, and so levers, of their own.
    """
    contacts = [one.contact for at_one in unloaded for one in at_one.values() if not one.contact.on_edge]
    levers = np.array([(contact.pinion_lever, contact.wheel_lever) for contact in contacts])
    return not contacts or bool((np.ptp(levers, axis=0) > LEVERS_ALIKE * levers.max(axis=0)).any())


def _lever_change(change: PairChange, sides: Sequence[Unloaded], position: int, number: int) -> tuple[float, float]:
    """Changes of the levers about pinion and wheel [mm per unit]; none where a pair gets out of reach."""
    below, above = (side[position].get(number) for side in sides)
    if below is None or above is None:
        return 0.0, 0.0
    one, two = below.contact, above.contact
    moved = two.pinion_lever - one.pinion_lever, two.wheel_lever - one.wheel_lever
    return moved[0] / change.difference, moved[1] / change.difference


def _loaded_grid(
    result: MeshCycle, pair: GearPair, one: PressureMap, of: ToothPair, bending: BendingModel | None
) -> LoadedGrid:
    """The contact problem that a map solves, made again."""
    number, contact = of.pair, of.contact
    (nx, ny), (dx, dy) = one.pressure.shape, one.spacing
    separation = sample_separation(pair, contact, cells=(nx, ny), box=(0.5 * nx * dx, 0.5 * ny * dy))
    if not np.allclose(separation.origin, one.origin, rtol=0.0, atol=1e-6 * pair.module):
        raise InputError("sensitivities: the pressure maps of the result do not belong to its scene")
    bent = None if bending is None else bending.within(number, separation)
    ends = edge_compliance(pair, separation) if result.scene.analysis.free_edges else None
    problem = contact_problem(pair, separation, float(one.pressure.sum()) * dx * dy, bent, ends)
    return LoadedGrid(number, contact, separation, problem, one.pressure)


def _line_load_slopes(grid: LoadedGrid) -> Array:
    """Derivative [1/mm] of the largest line load to the forces of the active cells of a grid.

    The largest one is that of the parabola through the highest slice and its neighbours, since the two in the middle
    of an even grid may be alike; at an end of the contact it is that of the slice.
    """
    line = grid.pressure.sum(axis=0)
    top = int(line.argmax())
    weights = np.zeros(line.size)
    weights[top] = 1.0
    if 0 < top < line.size - 1 and min(line[top - 1], line[top + 1]) > 0.0:
        before, after = line[top] - line[top - 1], line[top] - line[top + 1]
        place = 0.5 * (before - after) / (before + after) if before + after > 0.0 else 0.0
        weights[top - 1 : top + 2] = 0.5 * place * (place - 1.0), 1.0 - place**2, 0.5 * place * (place + 1.0)
    return np.asarray(weights[grid.active.nonzero()[1]] / grid.problem.spacing[1])
