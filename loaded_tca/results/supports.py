"""What a result has of gears on supports that give way: their motions, and the stiffness of the whole drive."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.loaded.moved_gears import standing_under
from loaded_tca.supports import RollingBearing, SupportCompliance, shafts_of, support_compliance
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loaded_tca.loaded.cycle import CycleSolution
    from loaded_tca.loaded.standing import LoadedStanding, StandingCycle
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.results.numbers import CycleNumbers

LARGEST_WAY, LARGEST_TILT = 0.1, 5e-3
"""Motions over the module, and tilts [rad], above which supports are softer than those of gears that mesh."""

LARGEST_MOMENT = 5e-3
"""Part of the torque that the axial moment of the forces on a pinion's supports may lack; of cylindrical and straight
bevel pairs it lacks 1e-4 and less, of a spiral bevel pair 1e-3, of a hypoid pair 1.5e-2."""


def support_arrays(pair: GearPair, cycles: Sequence[LoadedStanding], *, pressure_angle: float) -> dict[str, Array]:
    """Arrays of ``SUPPORT_QUANTITIES``; of ``BEARING_QUANTITIES`` of gears with shafts, ``ROLLING_QUANTITIES`` of some.

    Parameters
    ----------
    pair : GearPair
        At rest.
    cycles : sequence of StandingCycle
        By torque on supports that give way; there is nothing of rigid gears.
    pressure_angle : float [rad]
        Working transverse one; NaN: axes that meet have no misalignment in a plane of action.
    """
    if not cycles[0].loads:
        return {}
    motions = [_motions(pair, one) for one in cycles]
    forces = {
        f"{gear}_bearing_force": np.stack(
            [[_parts(one).supports[n].bearing_forces(load) for load in one.loads[n]] for one in cycles]
        )
        for n, gear in enumerate(GEARS)
        if _parts(cycles[0]).supports[n].on_bearings is not None
    }
    return (
        forces
        | _of_rolling_bearings(cycles)
        | {
            "pinion_motion": np.stack([one[0] for one in motions]),
            "wheel_motion": np.stack([one[1] for one in motions]),
            "misalignment": MICROMETRES * np.stack([_misalignment(pair, pressure_angle, one) for one in motions]),
            "wind_up": -pair.driving * np.stack([_wind_up(one) for one in cycles]),
            "drive_stiffness": np.concatenate([one.drive_rate for one in cycles]) * (1.0 / pair.rate_of_stiffness),
            **{
                f"{gear}_support_load": np.stack([held[n] for one in cycles if (held := one.standing.loads)])
                for n, gear in enumerate(GEARS)
            },
        }
    )


def _of_rolling_bearings(cycles: Sequence[LoadedStanding]) -> dict[str, Array]:
    """Arrays of ``ROLLING_QUANTITIES`` of the gears whose shafts have rolling bearings; NaN of linear ones beside."""
    arrays: dict[str, Array] = {}
    for n, gear in enumerate(GEARS):
        supports = [_parts(one).supports[n] for one in cycles]
        bearings = supports[0].bearings
        if not any(isinstance(bearing, RollingBearing) for bearing in bearings):
            continue
        motions = np.stack(
            [[own.bearing_motions(load) for load in one.loads[n]] for own, one in zip(supports, cycles, strict=True)]
        )
        forces, pressures = np.full((2, *motions.shape[:3]), math.nan)
        lives = np.full((len(cycles), len(bearings)), math.nan)
        for t, k in np.ndindex(lives.shape):
            bearing, own = bearings[k], motions[t, :, k]
            loaded = ~np.isnan(own).any(axis=1)
            if not isinstance(bearing, RollingBearing) or not loaded.any():
                continue
            forces[t, loaded, k] = [bearing.element_forces(motion).max() for motion in own[loaded]]
            pressures[t, loaded, k] = [bearing.largest_pressure(motion) for motion in own[loaded]]
            lives[t, k] = bearing.life(own[loaded].mean(axis=0))
        arrays |= {
            f"{gear}_bearing_motion": motions,
            f"{gear}_element_force": forces,
            f"{gear}_element_pressure": pressures,
            f"{gear}_bearing_life": lives,
        }
    return arrays


def element_forces(result: CycleNumbers, gear: str, torque: int) -> dict[int, tuple[RollingBearing, Array]]:
    """Rolling bearings of the shaft of a gear, by their places in the list, and forces (position, element) [N] in them.

    Parameters
    ----------
    result : MeshCycle
    gear : str
        "pinion" or "wheel".
    torque : int
        Index of the torque.

    Raises
    ------
    NotAskedError
        If the shaft of the gear has no rolling bearings.
    """
    motions = getattr(result, f"{gear}_bearing_motion")[torque]
    shaft = shafts_of(result.scene)[GEARS.index(gear)]
    assert shaft is not None
    return {
        k: (bearing, np.stack([bearing.element_forces(np.nan_to_num(motion)) for motion in motions[:, k]]))
        for k, bearing in enumerate(shaft.bearings)
        if isinstance(bearing, RollingBearing)
    }


def loads_of_stations(result: MeshCycle, torque: int) -> tuple[Array, Array]:
    """Loads (n, 6 m) [N, N mm] of the stations of pinion and wheel at the positions, read off the pressure maps.

    Parameters
    ----------
    result : MeshCycle
        Of gears on supports.
    torque : int
        Index of the torque.
    """
    supports = support_compliance(result.scene, result.gear_pair)
    assert supports is not None
    pinion, wheel = (result.dataset[f"{gear}_support_load"].values[torque] for gear in GEARS)
    there = standing_under(supports.linear_near((pinion, wheel)), (pinion, wheel))
    loads = np.zeros((len(result.path), pinion.size)), np.zeros((len(result.path), wheel.size))
    for n, maps in enumerate(result.maps[torque]):
        for one in maps:
            if one is not None:
                for of_gear, unit in zip(loads, there.loads(one), strict=True):
                    of_gear[n] += one.slice_force @ unit
    return loads


def warn_of_supports(pair: GearPair, cycles: Sequence[LoadedStanding]) -> None:
    """Give an AccuracyWarning if gears on supports move far, or forces on these do not balance the torques."""
    supported = [one for one in cycles if one.loads]
    if not supported:
        return
    warn_of_motions(pair, supported)
    parts = [0.0]
    for one in supported:
        (torque,) = one.standing.torques.tolist()
        moments = one.loads[0].reshape(len(one.loads[0]), -1, 6)[..., 5].sum(axis=-1)
        if torque > 0.0 and np.isfinite(moments).any():
            parts.append(abs(abs(float(np.nanmean(moments))) / torque - 1.0))
    if max(parts) > LARGEST_MOMENT:
        give_accuracy_warning(kinds.SUPPORT_MOMENT.sentence(part=max(parts)))


def warn_of_motions(pair: GearPair, cycles: Sequence[LoadedStanding]) -> None:
    """Give an AccuracyWarning if gears on supports move so far that their units are in doubt.

    What shafts are wound up by turns the gears about their axes, as meshing does, and is no such motion.
    """
    motions = np.abs(np.stack([_motions_of_gears(one) for one in cycles]))
    way, tilt = (float(np.nanmax(part, initial=0.0)) for part in (motions[..., :3], motions[..., 3:5]))
    if way > LARGEST_WAY * pair.module or tilt > LARGEST_TILT:
        give_accuracy_warning(
            kinds.LARGE_MOTIONS.sentence(way=way, tilt=1e3 * tilt, modules=LARGEST_WAY, most=1e3 * LARGEST_TILT),
        )


def secant_on_rigid_supports(carried: CycleSolution, cycles: Sequence[StandingCycle]) -> Array:
    """Torque over the rotation (torque, position) [N mm/rad] without what the supports give way.

    Parameters
    ----------
    carried : CycleSolution
        Under all torques, its rotation with the supports.
    cycles : sequence of StandingCycle
        By torque.
    """
    work = np.concatenate([_work_on_supports(one) for one in cycles])
    secant = np.full(carried.rotation.shape, math.nan)
    for (t, n), rotation in np.ndenumerate(carried.rotation):
        there = [one for one in carried.contacts[t][n] if one is not None]
        moment = sum(one.solution.load * one.contact.wheel_lever for one in there)
        if moment > 0.0:
            by_teeth = rotation - work[t, n] / moment
            secant[t, n] = carried.torque[t] / by_teeth if by_teeth > 0.0 else math.nan
    return secant


def _work_on_supports(one: StandingCycle) -> Array:
    """Loads times the motions of the supports from where they are at rest on (t, n) [N mm]; zero of rigid gears."""
    work = np.zeros(one.carried.rotation.shape)
    for loads, support in zip(one.loads, _parts(one).supports if one.loads else (), strict=True):
        turned = np.zeros(loads.shape[1])
        beyond = turned if support.law is None else support.moved(turned) - support.at_rest
        work += np.einsum("ni,ij,nj->n", loads, support.compliance, loads) + loads @ beyond
    return work


def _wind_up(one: LoadedStanding) -> Array:
    """How far the wheel stays behind (n,) [rad] by what both gears turn about their axes, from no torque on."""
    torques = np.abs(one.loads[1].reshape(len(one.loads[1]), -1, 6)[..., 5].sum(axis=1))
    work = np.zeros(len(torques))
    for support, loads in zip(_parts(one).supports, one.loads, strict=True):
        moved = np.stack([support.moved(load) for load in loads]) - support.at_rest
        work += (loads * moved).reshape(len(loads), -1, 6)[..., 5].sum(axis=1)
    return np.asarray(work / np.where(torques > 0.0, torques, 1.0))


def _parts(one: LoadedStanding) -> SupportCompliance:
    supports = one.standing.supports
    assert supports is not None
    return supports


def _motions(at_rest: GearPair, one: LoadedStanding) -> Array:
    """Motions (2, n, 6) of the middles of both faces [mm, rad], in the axes of the fixed frame."""
    frames = np.eye(3), at_rest.wheel_axes
    motions = [
        np.concatenate([own[:, :3] @ axes, own[:, 3:] @ axes], axis=-1)
        for own, axes in zip(_motions_of_gears(one), frames, strict=True)
    ]
    return np.stack(motions)


def _motions_of_gears(one: LoadedStanding) -> Array:
    """The same in the axes of each gear's own frame, z its axis."""
    return np.stack(
        [
            [support.at_middle(support.moved(load)) for load in loads]
            for support, loads in zip(_parts(one).supports, one.loads, strict=True)
        ]
    )


def _misalignment(pair: GearPair, pressure_angle: float, motions: Array) -> Array:
    """F_beta (n,) [mm] over the common face by motions (2, n, 6), as mounting errors count it.

    The tilts of the wheel against the pinion about x and y turn its axis in the plane of action, whose normal is that
    of the flanks in contact: b (r_x cos(alpha_wt) - s r_y sin(alpha_wt)).
    """
    about_x, about_y = (motions[1] - motions[0])[:, 3:5].T
    side = pair.sense * pair.driving
    in_plane_of_action = about_x * math.cos(pressure_angle) - side * about_y * math.sin(pressure_angle)
    return np.asarray(pair.face_width * in_plane_of_action)
