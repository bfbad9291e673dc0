"""Sensitivities of a result: its derivatives to modifications, mounting errors and the torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import tooth_compliance
from loaded_tca.contact import ContactProblem
from loaded_tca.errors import InputError, require
from loaded_tca.loaded.cycle import farthest_apart
from loaded_tca.loaded.free_edges import edge_compliance
from loaded_tca.loaded.load_sharing import ToothPair, tooth_pairs_at
from loaded_tca.loaded.pair_coupling import BendingModel
from loaded_tca.loaded.sensitivity import LoadedGrid, Tangent, followed_changes
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


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """Derivatives of a result to keys of its scene; NaN where nothing is in contact or nothing is loaded.

    Attributes
    ----------
    keys : tuple of str
        As of ``scene.with_changes``; the unit of each is in its name.
    transmission_error : (torque, position, key) array [rad per unit of the key]
        Of the loaded, absolute transmission error.
    load_share : (torque, position, pair, key) array [1 per unit of the key]
        Of the shares in the torque; zero where a pair carries nothing.
    line_load : (torque, position, pair, key) array [N/mm per unit of the key]
        Of the largest force per length along each contact, between the slices of its grid.
    result : MeshCycle
        What they are derivatives of.
    """

    keys: tuple[str, ...]
    transmission_error: Array
    load_share: Array
    line_load: Array
    result: MeshCycle

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
        """Derivative of the peak-to-peak transmission error, (torque, key) [rad per unit]; NaN with one position.

        That of the highest position less that of the lowest one.
        """
        errors, slopes = self.result.transmission_error, self.transmission_error
        found = np.full((len(errors), len(self.keys)), np.nan)
        for t, error in enumerate(errors):
            if np.isfinite(error).sum() > 1:
                found[t] = slopes[t, np.nanargmax(error)] - slopes[t, np.nanargmin(error)]
        return found

    def harmonics(self, count: int) -> Array:
        """Derivatives of the amplitudes of ``MeshCycle.harmonics``, (torque, order, key) [rad per unit]; NaN where they are."""
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
    both = [[_unloaded(side, angles, alone)[0] for side in (change.below, change.above)] for change in changes]
    bending = None if wanted.compliance == "contact" else tooth_compliance(pair, neighbours=apart)
    error = np.full((*result.transmission_error.shape, len(keys)), np.nan)
    share, line = np.full((2, *result.load_share.shape, len(keys)), np.nan)
    for t, n in np.ndindex(error.shape[:2]):
        share[t, n][~np.isnan(result.load_share[t, n])] = 0.0
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
        tangent = Tangent(grids, bending)
        grown = [gap_change(pair, grid.contact, grid.separation, changes) for grid in grids]
        followed = followed_changes(pair, grids, grown, bending, wanted.free_edges)
        # The levers are those of the unloaded contact points, which move too.
        levers = np.array(
            [[_lever_change(c, sides, n, g.number) for c, sides in zip(changes, both, strict=True)] for g in grids]
        )
        levers = levers.reshape(len(grids), len(changes), 2)
        back = pair.driving * (result.path.transmission_error[n] - result.transmission_error[t, n])
        beyond = np.array([back - unloaded[n][grid.number].initial_separation for grid in grids])
        forces = np.array([grid.pressure.sum() * grid.problem.cell_area for grid in grids])
        gaps = tangent.gathered(
            [rest - (own[:, 1] * turn)[:, None, None] for rest, own, turn in zip(followed, levers, beyond, strict=True)]
        )
        lost, torque = -(forces @ levers[:, :, 0]), float(result.torque[t])
        error[t, n, :] = -pair.driving * NEWTON_MILLIMETRES * tangent.rotation_by_torque
        error[t, n, at] = -pair.driving * tangent.rotation_change(gaps, lost)
        for i, (place, part) in enumerate(zip(places, tangent.parts, strict=True)):
            slopes = np.zeros(tangent.pinion_levers.shape)
            slopes[part] = tangent.pinion_levers[part] / torque
            by_gap, by_torque = tangent.functional_change(slopes, gaps, lost)
            share[t, n, place, :] = NEWTON_MILLIMETRES * (by_torque - result.load_share[t, n, place] / torque)
            share[t, n, place, at] = by_gap + levers[i, :, 0] * forces[i] / torque
            slopes[part] = _line_load_slopes(grids[i])
            by_gap, by_torque = tangent.functional_change(slopes, gaps, lost)
            line[t, n, place, :] = NEWTON_MILLIMETRES * by_torque
            line[t, n, place, at] = by_gap
    return Sensitivities(tuple(keys), error, share, line, result)


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
    compliance = None if bending is None else bending.within(number, separation)
    ends = edge_compliance(pair, separation) if result.scene.analysis.free_edges else None
    if ends is not None:
        compliance = ends if compliance is None else compliance + ends
    problem = ContactProblem(
        separation.cut_gap,
        separation.spacing,
        pair.contact_modulus,
        load=float(one.pressure.sum()) * dx * dy,
        max_pressure=pair.max_pressure,
        slice_compliance=compliance,
        cover=separation.cover,
    )
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
