"""Where first order ends since a tooth pair comes under load or leaves it within the tolerance of a key.

A pair without load touches where the wheel has gone back to the unloaded transmission error of that pair. Until then
its flanks stay apart by the lever times the rotation that is left, and by what the forces of the other pairs bend its
teeth away. Unloaded contact is traced with the key at both ends of its tolerance, since edges may hold it; the loaded
transmission error and the shares of loaded pairs follow their derivatives.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.errors import AccuracyWarning, LoadedTCAError, give_accuracy_warning
from loaded_tca.loaded.first_guess import expected_lines, first_law
from loaded_tca.results.derivatives import JoinedSensitivities
from loaded_tca.results.sensitivities import TORQUE
from loaded_tca.separation.pair_change import number_at
from loaded_tca.units import ending_of
from loaded_tca.unloaded import trace_teeth

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from loaded_tca.arrays import Array, Indices
    from loaded_tca.results.sensitivities import Sensitivities

LEAST_SHARE = 0.01
"""Part of the torque by which a share is off within a tolerance, from which on it is told."""


class IdlePairs(NamedTuple):
    """Tooth pairs that carry nothing beside others that do.

    Attributes
    ----------
    places : (3, n) array of int
        Torque, position and pair, as indices.
    lever : (n,) array [mm]
        Of the wheel.
    opening : (n,) array [mm]
        Between the flanks under the load of the other pairs.
    exponent : (n,) array
        With which the contact of a pair gives way under its force.
    """

    places: Indices
    lever: Array
    opening: Array
    exponent: Array


def idle_pairs(sensitivities: Sensitivities) -> IdlePairs:
    """Tooth pairs that carry nothing where others do, and how far their flanks are apart."""
    result, pair = sensitivities.result, sensitivities.result.gear_pair
    in_contact = np.stack([path.in_contact for path in result.paths], axis=-1)
    loaded = np.zeros(result.transmission_error.shape, dtype=bool)
    loaded[*sensitivities.places] = True
    places = np.array(np.nonzero(loaded[..., None] & in_contact & ~(result.load_share > 0.0)))
    contacts = [result.paths[column][position] for _, position, column in places.T.tolist()]
    lever = np.array([contact.wheel_lever for contact in contacts])
    apart = np.array([contact.transmission_error for contact in contacts])
    opening = pair.driving * lever * (result.transmission_error[*places[:2]] - apart)
    loads = [result.torque[t] / one.pinion_lever for t, one in zip(places[0], contacts, strict=True)]
    laws = [first_law(pair, contact, load) for contact, load in zip(contacts, loads, strict=True)]
    idle = IdlePairs(places, lever, opening, np.array([law.exponent for law, _ in laws]))
    bending, tangents = sensitivities.tangents.bending, sensitivities.tangents
    if bending is None or not contacts:
        return idle
    numbers, states = result.pair[places[2]].tolist(), sensitivities.places[:, tangents.state].T
    for n, line in enumerate(expected_lines(pair, contacts, [length for _, length in laws])):
        for i in np.flatnonzero((states == places[:2, n]).all(axis=1)).tolist():
            grid = tangents.grids[i]
            if abs(grid.number - numbers[n]) <= bending.neighbours:
                bent = bending.deflection((numbers[n], line), (grid.number, grid.separation), grid.slice_force)
                opening[n] += np.interp(0.0, line.y, bent)
    return idle


def warn_of_pairs(sensitivities: Sensitivities, tolerances: Mapping[str, float]) -> None:
    """Tell which key brings a tooth pair under load, or takes one from it, within its tolerance (AccuracyWarning).

    Not where supports give way, nor where one pair carries all by the scene.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    """
    if isinstance(sensitivities, JoinedSensitivities) or not sensitivities.result.scene.analysis.load_sharing:
        return
    idle = idle_pairs(sensitivities)
    by_key: dict[str, tuple[float, float]] = {}
    for number, key in enumerate(sensitivities.keys):
        for step in (-tolerances[key], tolerances[key]):
            for change, share in (*_coming(sensitivities, idle, number, step), *_leaving(sensitivities, number, step)):
                if share > max(LEAST_SHARE, by_key.get(key, (0.0, 0.0))[1]):
                    by_key[key] = change, share
    if by_key:
        key = max(by_key, key=lambda one: by_key[one][1])
        words = {"key": key, "unit": ending_of(key), "count": len(by_key), "keys": len(sensitivities.keys)}
        change, share = by_key[key]
        give_accuracy_warning(kinds.PAIR_COMES_OR_GOES.sentence(change=change, share=share, **words), stacklevel=3)


def _coming(sensitivities: Sensitivities, idle: IdlePairs, number: int, step: float) -> Iterator[tuple[float, float]]:
    """Changes of a key at which idle pairs touch, and the most that they carry at its end, as stiff as the others."""
    result, key, (torque, position, column) = sensitivities.result, sensitivities.keys[number], idle.places
    if not column.size:
        return
    driving, growth = result.gear_pair.driving, step * sensitivities.transmission_error[torque, position, number]
    if key != TORQUE:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)  # of gears that nobody asks about
                scene = result.scene.with_changes({key: number_at(result.scene, key) + step})
                mesh = trace_teeth(scene.pair(), result.pinion_angle)
        except LoadedTCAError:
            return  # beyond what the key may be
        paths = dict(zip(mesh.pairs.tolist(), mesh.paths, strict=True))
        rows = zip(result.pair[column].tolist(), position.tolist(), column.tolist(), strict=True)
        growth -= [
            paths[pair].transmission_error[row] - result.paths[place].transmission_error[row]
            if pair in paths
            else math.inf
            for pair, row, place in rows
        ]
    rotation = driving * (result.unloaded_transmission_error[position] - result.transmission_error[torque, position])
    there = idle.opening + driving * idle.lever * growth
    whole = idle.lever * rotation
    for before, after, all_of_it, exponent in zip(idle.opening.clip(0.0), there, whole, idle.exponent, strict=True):
        if after < 0.0:
            yield step * before / (before - after), (-after / all_of_it) ** (1.0 / exponent)


def _leaving(sensitivities: Sensitivities, number: int, step: float) -> Iterator[tuple[float, float]]:
    """Changes of a key at which loaded pairs carry nothing any more, and how far below that first order goes."""
    shares = sensitivities.result.load_share
    slopes = sensitivities.load_share[..., number]
    for share, slope in zip(shares[shares > 0.0], slopes[shares > 0.0], strict=True):
        if share + step * slope < 0.0:
            yield -share / slope, -(share + step * slope)
