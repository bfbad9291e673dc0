"""Sensitivities of a result: its derivatives to modifications, mounting errors and the torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import tooth_compliance
from loaded_tca.contact import ContactProblem
from loaded_tca.errors import InputError
from loaded_tca.loaded.cycle import farthest_apart
from loaded_tca.loaded.free_edges import edge_compliance
from loaded_tca.loaded.load_sharing import tooth_pairs_at
from loaded_tca.loaded.pair_coupling import BendingModel
from loaded_tca.loaded.sensitivity import LoadedGrid, Tangent, followed_changes
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.separation import sample_separation
from loaded_tca.separation.gap_change import gap_change, pair_changes
from loaded_tca.unloaded import ContactPoint, trace_contact, trace_teeth

if TYPE_CHECKING:
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
    """

    keys: tuple[str, ...]
    transmission_error: Array
    load_share: Array


def sensitivities(result: MeshCycle, keys: Sequence[str]) -> Sensitivities:
    """Derivatives of a result to keys of its scene; see :meth:`MeshCycle.sensitivities`."""
    scene, pair = result.scene, result.scene.pair()
    named = [key for key in keys if key != TORQUE]
    changes, at = pair_changes(scene, named), [keys.index(key) for key in named]
    contacts, bending = _contacts(result, pair)
    error = np.full((*result.transmission_error.shape, len(keys)), np.nan)
    share = np.full((*result.load_share.shape, len(keys)), np.nan)
    for t, n in np.ndindex(error.shape[:2]):
        grids, places = [], []
        for k, number in enumerate(result.dataset["pair"].values.tolist()):
            one = result.maps[t][n][k]
            if one is not None and one.pressure.any():
                grid = _loaded_grid(result, pair, one, (number, contacts[n][number]), bending)
                if grid.active.any():
                    grids.append(grid)
                    places.append(k)
        if not grids:
            continue
        tangent = Tangent(grids, bending)
        grown = [gap_change(pair, grid.contact, grid.separation, changes) for grid in grids]
        gaps = tangent.gathered(followed_changes(pair, grids, grown, bending, scene.analysis.free_edges))
        by_torque = NEWTON_MILLIMETRES * tangent.rotation_by_torque
        by_key = np.full(len(keys), by_torque)
        by_key[at] = tangent.rotation_change(gaps)
        error[t, n] = -pair.driving * by_key
        share[t, n] = np.where(np.isnan(result.load_share[t, n])[:, None], np.nan, 0.0)
        torque = float(result.torque[t])
        for place, part in zip(places, tangent.parts, strict=True):
            slopes = np.zeros(tangent.pinion_levers.shape)
            slopes[part] = tangent.pinion_levers[part] / torque
            by_gap, of_torque = tangent.functional_change(slopes, gaps)
            own = np.full(len(keys), NEWTON_MILLIMETRES * (of_torque - result.load_share[t, n, place] / torque))
            own[at] = by_gap
            share[t, n, place] = own
    return Sensitivities(tuple(keys), error, share)


def _contacts(result: MeshCycle, pair: GearPair) -> tuple[list[dict[int, ContactPoint]], BendingModel | None]:
    """Unloaded contacts by position and tooth pair, in the angles of their own teeth, and what bends."""
    angles, wanted, apart = result.pinion_angle, result.scene.analysis, 1
    contacts: list[dict[int, ContactPoint]]
    if wanted.load_sharing:
        mesh = trace_teeth(pair, angles)
        apart = max(farthest_apart(mesh), 1)
        contacts = [{one.pair: one.contact for one in tooth_pairs_at(mesh, n)} for n in range(len(mesh))]
    else:
        contacts = [{0: contact} for contact in trace_contact(pair, angles)]
    return contacts, None if wanted.compliance == "contact" else tooth_compliance(pair, neighbours=apart)


def _loaded_grid(
    result: MeshCycle, pair: GearPair, one: PressureMap, of: tuple[int, ContactPoint], bending: BendingModel | None
) -> LoadedGrid:
    """The contact problem that a map solves, made again."""
    number, contact = of
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
