"""Where first order ends since a tooth pair comes under load or leaves it within the tolerance of a key.

A pair without load touches where the wheel has gone back to the unloaded transmission error of that pair. Until then
its flanks stay apart by the lever times the rotation that is left, and by what the forces of the other pairs bend its
teeth away. Unloaded contact is traced on both sides of every key, since edges may hold it; the loaded transmission
error and the shares of loaded pairs follow their derivatives.

On supports all of this is that of the gears as they stand under each torque: keys change the pair as far as the mean
load moves it by them, and the other motions by the forces open the flanks as the bending of the teeth does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.errors import GeometryError, give_accuracy_warning
from loaded_tca.loaded.first_guess import expected_lines, first_law
from loaded_tca.results.derivatives import JoinedSensitivities
from loaded_tca.results.support_growth import UnderOneTorque
from loaded_tca.units import ending_of
from loaded_tca.unloaded import trace_contact

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
    way : (n,) array [mm]
        Of the flanks towards each other by the load, from where the leading pair touches.
    exponent : (n,) array
        With which the contact of a pair gives way under its force.
    slopes : (keys, n) array [rad per unit of the key]
        Of the unloaded transmission error of the pair.
    """

    places: Indices
    lever: Array
    opening: Array
    way: Array
    exponent: Array
    slopes: Array


def idle_pairs(sensitivities: Sensitivities) -> IdlePairs:
    """Tooth pairs that carry nothing where others do, as near to each other as the load turns the gears at most."""
    result, pair = sensitivities.result, sensitivities.result.gear_pair
    in_contact = np.stack([path.in_contact for path in result.paths], axis=-1)
    loaded = np.zeros(result.transmission_error.shape, dtype=bool)
    loaded[*sensitivities.places] = True
    places = np.array(np.nonzero(loaded[..., None] & in_contact & ~(result.load_share > 0.0)))
    contacts = [result.paths[column][position] for _, position, column in places.T.tolist()]
    lever = np.array([contact.wheel_lever for contact in contacts])
    apart = np.array([contact.transmission_error for contact in contacts])
    opening = pair.driving * lever * (result.transmission_error[*places[:2]] - apart)
    way = pair.driving * lever * (result.path.transmission_error[places[1]] - result.transmission_error[*places[:2]])
    near = np.flatnonzero(opening < way)
    places, lever, opening, way = places[:, near], lever[near], opening[near], way[near]
    contacts = [contacts[n] for n in near.tolist()]
    loads = [result.torque[t] / one.pinion_lever for t, one in zip(places[0], contacts, strict=True)]
    laws = [first_law(pair, contact, load) for contact, load in zip(contacts, loads, strict=True)]
    slopes = _unloaded_slopes(sensitivities, places)
    idle = IdlePairs(places, lever, opening, way, np.array([law.exponent for law, _ in laws]), slopes)
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
        if isinstance(result, UnderOneTorque):
            opening[n] += np.interp(0.0, line.y, result.displacement(line))
    return idle


def _unloaded_slopes(sensitivities: Sensitivities, places: Indices) -> Array:
    """Derivatives (keys, n) of the unloaded transmission errors of tooth pairs at places (3, n) to the keys."""
    result, slopes = sensitivities.result, np.zeros((len(sensitivities.keys), places.shape[1]))
    for column in np.unique(places[2]).tolist():
        those = places[2] == column
        turned = result.pinion_angle[places[1, those]] - result.pair[column] * result.gear_pair.pitch
        angles, at = np.unique(turned, return_inverse=True)  # as if the pair were the one at the pitch point
        for number, change in enumerate(sensitivities.changes):
            if change is not None:
                try:
                    low, high = (trace_contact(pair, angles, warn=False) for pair in (change.below, change.above))
                except GeometryError:
                    continue  # out of reach on one side: nothing comes there
                slopes[number, those] = ((high.transmission_error - low.transmission_error) / change.difference)[at]
    return slopes


def warn_of_pairs(sensitivities: Sensitivities, tolerances: Mapping[str, float]) -> None:
    """Tell which key brings a tooth pair under load, or takes one from it, within its tolerance (AccuracyWarning).

    Not where one pair carries all by the scene.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    """
    if not sensitivities.result.scene.analysis.load_sharing:
        return
    parts = sensitivities.parts if isinstance(sensitivities, JoinedSensitivities) else (sensitivities,)
    by_key: dict[str, tuple[float, float]] = {}
    for part in parts:
        if part is None:
            continue
        idle = idle_pairs(part)
        for number, key in enumerate(part.keys):
            for step in (-tolerances[key], tolerances[key]):
                for change, share in (*_coming(part, idle, number, step), *_leaving(part, number, step)):
                    if share > max(LEAST_SHARE, by_key.get(key, (0.0, 0.0))[1]):
                        by_key[key] = change, share
    if by_key:
        key = max(by_key, key=lambda one: by_key[one][1])
        words = {"key": key, "unit": ending_of(key), "count": len(by_key), "keys": len(sensitivities.keys)}
        change, share = by_key[key]
        give_accuracy_warning(kinds.PAIR_COMES_OR_GOES.sentence(change=change, share=share, **words))


def _coming(sensitivities: Sensitivities, idle: IdlePairs, number: int, step: float) -> Iterator[tuple[float, float]]:
    """Changes of a key at which idle pairs touch, and the most that they carry at its end, as stiff as the others."""
    driving, (torque, position, _) = sensitivities.result.gear_pair.driving, idle.places
    growth = sensitivities.transmission_error[torque, position, number] - idle.slopes[number]
    there = idle.opening + step * driving * idle.lever * growth
    for before, after, way, exponent in zip(idle.opening.clip(0.0), there, idle.way, idle.exponent, strict=True):
        if after < 0.0:
            yield step * before / (before - after), (-after / way) ** (1.0 / exponent)


def _leaving(sensitivities: Sensitivities, number: int, step: float) -> Iterator[tuple[float, float]]:
    """Changes of a key at which loaded pairs carry nothing any more, and how far below that first order goes."""
    shares = sensitivities.result.load_share
    slopes = sensitivities.load_share[..., number]
    for share, slope in zip(shares[shares > 0.0], slopes[shares > 0.0], strict=True):
        if share + step * slope < 0.0:
            yield -share / slope, -(share + step * slope)
