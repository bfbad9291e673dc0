"""What must hold of every scene: invariances, laws of mechanics and continuity, as a table of functions.

Each takes a ``Subject``, a scene with its analysis, and returns what is off: by quantity, in parts of what is allowed.
The docstring of each says how the scene is turned into another one; its row in ``validation.laws`` has the scenes that
it is for. Constants say what is allowed, and why. Transmission errors and their differences are seen over the peak to
peak of the curve, or over a fifth of the deflection where that is more; shares as they are; pressures relative to the
largest one of the scene.
"""

import math
import tempfile
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, cast

import numpy as np

from loaded_tca import AccuracyWarning, MeshCycle, analyse, analyse_revolution, load_result
from loaded_tca.analysis import grid_of
from loaded_tca.arrays import GEARS, Array, Indices
from loaded_tca.compliance import model_of
from loaded_tca.double_helical import DoubleHelicalResult, analyse_double_helical
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.loaded.standing import GearsUnderTorques, all_torques
from loaded_tca.results.collect import mesh_cycle
from loaded_tca.results.sensitivities import TORQUE
from loaded_tca.results.tolerances import default_tolerances
from loaded_tca.scene import Scene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.scene.rack import RackScene
from loaded_tca.scene.section import as_table
from loaded_tca.separation.pair_change import number_at
from loaded_tca.unloaded import trace_teeth
from loaded_tca.unloaded.tooth_cycle import pitches_within_reach
from validation.halves import HalvesAsPairs
from validation.random_scenes import FeaturedScene, featured_scene
from validation.scene_transforms import exchanged, mirrored_across, mirrored_along, scaled

CHEAP = {"positions": 3, "accuracy": 1e-2}
"""Settings of the analyses: half a pitch is between two positions."""
COARSE: dict[str, Any] = {"positions": 3, "cells": [8, 16], "accuracy": None}
"""The same of quicker ones, for laws that compare states on alike grids: few cells, whose errors nothing estimates."""
LEAST_SPAN = 0.2
"""Of the deflection: a peak to peak below it counts as that, since rotations agree to 5e-4 of themselves."""
LITTLE_LOAD = 0.02
"""Share below which pressures are not compared: contacts that only just touch."""
CYLINDRICAL, BEVEL = ("spur", "helical", "internal"), ("straight_bevel", "spiral_bevel")
RACK, HALVES = ("rack",), ("double_helical",)
Off = dict[str, float]
"""Quantity -> how far it is off, over what is allowed."""

SOLVED_ANEW = (5e-3, 2e-3, 1e-2)
"""Transmission error, share, peak pressure of contacts that are solved anew for an accuracy of 1e-2: the peak is
known to that; a grid that is just fine enough in one of two scenes is refined in the other, which moves approaches by
less."""
SAME_TORQUE = (1e-3, 5e-4, 1e-3)
"""The same of states that start from other ones: the balance ends where rotations agree to 5e-2 times the accuracy."""
SAME_STEPS = 1e-6
"""Of the span, and share, of states that are solved by the same steps: rounding, far above what it was seen to be."""
GRIDS = 1e-2
"""Share by grids: the accuracy that was asked for."""
FROM_FILE = 1e-6
"""Files keep every digit; states that are solved again from them are solved to 1e-6."""
NO_SHARE = 1e-5
"""Change of a share within a key's tolerance below which its digits are not compared: a pair that carries alone has
derivatives that are differences of numbers near 1, rounded to 1e-12."""
BALANCED = 1e-6
"""Forces of the last solutions balance the torque to the tolerance of the contact solver."""
ENERGY = 0.01
"""Rotations agree to 5e-4, of which the work has the difference of two, three times that; beside errors of grids as
they are told, the mean over the forces."""
ON_BEARINGS = 5e-3
"""Above it an analysis warns: forces have the direction of the normal at the contact point."""
STIFFNESS = 0.03
"""Tangents scatter with the cells that are in contact, by some percent (docs/how_it_works/load_sharing.md)."""
DERIVATIVES, LARGEST_WARNED = 0.05, 0.5
"""Of the largest; warnings speak of up to a quarter, at kinks of as much as there is on either side."""
SMALLEST_ROUNDING = 0.01
"""Radius that scenes may have beside none [mm]."""
JUMP = 0.015
"""Of the range of a curve, of what is called a jump."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A scene of a seed, and what is computed of it but once."""

    featured: FeaturedScene

    @classmethod
    def of(cls, seed: int, settings: Mapping[str, Any] = CHEAP) -> "Subject":
        """Of a seed, by cheap settings of the section [analysis]."""
        return cls(featured_scene(seed, **settings))

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.featured.scene

    @cached_property
    def result(self) -> MeshCycle:
        """Its analysis."""
        return analysed(self.scene)

    @cached_property
    def rng(self) -> np.random.Generator:
        """For what an invariance chooses by itself: a key, an axis."""
        return np.random.default_rng([self.featured.seed, 1])

    def has(self, *features: str) -> bool:
        """Whether the scene has one of these features."""
        return any(name in self.featured.features for name in features)


def analysed(scene: Scene) -> MeshCycle:
    """Analysis of a scene whose warnings are kept in its dataset; of two halves with the names of a mesh cycle."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        if isinstance(scene, DoubleHelicalScene):
            return cast("MeshCycle", HalvesAsPairs(analyse_double_helical(scene)))
        return analyse(scene)


def module_of(scene: Scene) -> float:
    """Module of the gears, of two halves as well [mm]."""
    return scene.mesh().pinion.normal_module if isinstance(scene, DoubleHelicalScene) else scene.pair().module


# What two results differ by


def span(result: MeshCycle) -> Array:
    """Size that transmission errors are seen in, of each torque (torque, 1) [rad]."""
    error = np.asarray(result.transmission_error)
    deflection = np.abs(error - result.unloaded_transmission_error).max(axis=1, keepdims=True)
    return np.maximum(np.ptp(error, axis=1, keepdims=True), LEAST_SPAN * deflection)


def told(result: MeshCycle) -> Array:
    """Estimated errors of the grids of each state, the mean over its forces (torque, position)."""
    return np.asarray(np.nansum(result.load_share * result.discretisation_error, axis=-1))


def of_pairs(result: MeshCycle, name: str, pairs: Array | Indices) -> Array:
    """A quantity of tooth pairs by their numbers (torque, position, pair), zero of those that carry nothing."""
    values = np.nan_to_num(np.asarray(getattr(result, name)))
    columns = {int(number): k for k, number in enumerate(result.pair)}
    nothing = np.zeros(values.shape[:2])
    return np.stack([values[..., columns[int(k)]] if int(k) in columns else nothing for k in pairs], axis=-1)


EVERY = slice(None), slice(None)
"""Torques and positions of a result: all."""


def difference(
    one: MeshCycle,
    other: MeshCycle,
    allowed: tuple[float, float, float],
    here: Any = EVERY,
    there: Any = EVERY,
    scale: float = 1.0,
) -> Off:
    """By how much transmission errors, shares and peak pressures of two results differ, over what is allowed.

    Peaks of contacts that are solved anew are known to the errors that are told of their grids, where these are more.
    ``here``, ``there``: states of each. ``scale``: of motions of the other one, which are seen as rotations.
    """
    pairs = np.union1d(one.pair, other.pair)
    shares, peaks, errors = (
        [of_pairs(result, name, pairs)[at] for result, at in ((one, here), (other, there))]
        for name in ("load_share", "peak_pressure", "discretisation_error")
    )
    counted = (shares[0] > LITTLE_LOAD) & (shares[1] > LITTLE_LOAD)
    known = np.maximum(errors[0] * peaks[0], errors[1] * peaks[1]) if allowed == SOLVED_ANEW else 0.0
    moved = np.where(counted, np.abs(peaks[1] - peaks[0]), 0.0)
    size = span(one)[here[0]] * allowed[0]
    off = {
        "transmission error": np.abs(other.transmission_error[there] - one.transmission_error[here]) / size,
        "load share": np.abs(shares[1] - shares[0]) / allowed[1],
        "peak pressure": moved / np.maximum(allowed[2] * peaks[0].max(), known),
    }
    if isinstance(one, HalvesAsPairs):
        turned = (other.axial_motion[there] * scale - one.axial_motion[here]) * one.turn_by_motion
        off["axial motion"] = np.abs(turned) / size
    return {name: float(part.max()) for name, part in off.items()}


# The same pair of gears in other words


def lengths_doubled(subject: Subject) -> Off:
    """All lengths twice, forces four times, torques eight times as large: the same angles, shares and pressures."""
    return difference(subject.result, analysed(scaled(subject.scene)), SOLVED_ANEW, scale=0.5)


def mirror_across(subject: Subject) -> Off:
    """In a mirror that has both axes: the other hands, turning the other way."""
    return difference(subject.result, analysed(mirrored_across(subject.scene)), SOLVED_ANEW)


def mirror_along(subject: Subject) -> Off:
    """In a mirror across both axes: what is upper and lower changes over."""
    return difference(subject.result, analysed(mirrored_along(subject.scene)), SOLVED_ANEW)


def gears_exchanged(subject: Subject) -> Off:
    """Seen from the wheel, at the angle where it stands without load, under the moment that the teeth turn it with.

    There load turns the pinion, on by some angle; in the scene itself the pinion is put to that place, where load turns
    the wheel back to where it stood: the gears stand to each other as before. Rotations are compared, since a tilt
    about the middle of the other face turns the gear, too; they may differ by the errors told of both grids as well.
    """
    result, scene, other = subject.result, subject.scene, exchanged(subject.scene)
    ratio = result.gear_pair.ratio
    levers = np.stack([path.wheel_lever for path in result.paths], axis=-1)
    moments = np.nansum(result.normal_force * levers, axis=-1)[-1]
    unloaded, angles = np.asarray(result.unloaded_transmission_error), np.asarray(result.pinion_angle)
    off = []
    for n, moment in enumerate(moments.tolist()):
        seen, _, torque = state_alone(other, ratio * angles[n] + unloaded[n], moment)
        here, there, _ = state_alone(scene, angles[n] + seen.rotation, torque)
        seen = seen._replace(rotation=unloaded[n] - there - ratio * seen.rotation)
        away = np.array(here.differences(seen)) / here.sizes(result)
        away[0] -= 2.0 * told(result)[-1, n] * abs(here.rotation) / float(span(result)[-1, 0])
        off.append(np.maximum(away, 0.0) / SOLVED_ANEW)
    names = "rotation", "load share", "peak pressure"
    return dict(zip(names, np.max(off, axis=0).tolist(), strict=True))


class State(NamedTuple):
    """One position under one torque: rotation by the load [rad], forces [N] and peak pressures [MPa] by tooth pair."""

    rotation: float
    forces: dict[int, float]
    peaks: dict[int, float]

    def differences(self, other: "State") -> tuple[float, float, float]:
        """Largest differences of rotation, forces, and peaks of pairs that carry load in both."""
        pairs, least = self.forces.keys() | other.forces.keys(), LITTLE_LOAD * sum(self.forces.values())
        forces = [abs(self.forces.get(pair, 0.0) - other.forces.get(pair, 0.0)) for pair in pairs]
        loaded = [k for k in pairs if min(self.forces.get(k, 0.0), other.forces.get(k, 0.0)) > least]
        peaks = [abs(self.peaks[pair] - other.peaks[pair]) for pair in loaded]
        return abs(self.rotation - other.rotation), max(forces), max(peaks, default=0.0)

    def sizes(self, result: MeshCycle) -> tuple[float, float, float]:
        """What they are seen in."""
        return float(span(result)[-1, 0]), sum(self.forces.values()), max(self.peaks.values())


def _state(result: MeshCycle, torque: int, position: int) -> State:
    """A state of a result."""
    forces, peaks = (
        dict(zip(result.pair.tolist(), np.nan_to_num(values[torque, position]).tolist(), strict=True))
        for values in (np.asarray(result.normal_force), np.asarray(result.peak_pressure))
    )
    rotation = result.transmission_error[torque, position] - result.unloaded_transmission_error[position]
    return State(float(rotation), forces, peaks)


def state_alone(scene: Scene, angle: float, torque: float) -> tuple[State, float, float]:
    """A state of gears that are held, at a pinion angle [rad] under a torque [N mm] of its own.

    With the unloaded transmission error [rad] and the moment of the forces about the axis of the wheel [N mm].
    """
    pair = scene.pair()
    mesh = trace_teeth(pair, np.array([angle]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        bending = model_of(scene, pair, pitches_within_reach(pair))
        cycles = GearsUnderTorques(pair, bending, mesh.pinion_angle, grid_of(scene)).mesh_cycles([torque])
        carried = all_torques(mesh, cycles)
        state = _state(mesh_cycle(scene, pair, carried, {}, {}, (), cycles), 0, 0)
    loaded = [one for one in carried.contacts[0][0] if one is not None]
    moment = sum(one.solution.load * one.contact.wheel_lever for one in loaded)
    return state, float(mesh.transmission_error[0]), moment


def revolution_doubled(subject: Subject) -> Off:
    """Teeth at their own places, all lengths twice as large: two positions of a pitch of a whole revolution."""
    changes = {"revolution.pitches": 1, "revolution.positions_per_pitch": 2, "revolution.first_pair": 1}
    scenes = [one.with_changes(changes) for one in (subject.scene, scaled(subject.scene))]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        first, second = (analyse_revolution(scene).dataset for scene in scenes)
    errors = [np.asarray(one["transmission_error"]) for one in (first, second)]
    shares = [np.asarray(one["load_share"]) for one in (first, second)]
    return {
        "transmission error": float(np.abs(errors[1] - errors[0]).max() / span(subject.result).min()) / SOLVED_ANEW[0],
        "load share": float(np.nanmax(np.abs(shares[1] - shares[0]))) / SOLVED_ANEW[1],
    }


def pitch_later(subject: Subject) -> Off:
    """The last position of a pitch is its first one: every tooth pair has taken the place of the one before it."""
    result = subject.result
    pairs = np.arange(result.pair.min() - 1, result.pair.max() + 2)
    shares, error = of_pairs(result, "load_share", pairs), result.transmission_error
    return {
        "transmission error": float(np.abs((error[:, -1] - error[:, 0]) / span(result)[:, 0]).max()) / SAME_STEPS,
        "load share": float(np.abs(shares[:, -1, 1:] - shares[:, 0, :-1]).max()) / SAME_STEPS,
    }


def torque_in_a_list(subject: Subject) -> Off:
    """A torque among others gives what it gives alone.

    Halves that are held are analysed under other torques then, between which what they carry lies: of small torques one
    half may carry all, of large ones a part.
    """
    result, scene = subject.result, subject.scene
    torque = 1e-3 * float(result.torque[-1])
    last, first = (-1, slice(None)), (0, slice(None))
    if not isinstance(scene, DoubleHelicalScene) or scene.floats_freely:
        several = [0.4 * torque, torque] if len(result.torque) == 1 else [torque]
        return difference(result, _under(scene, several), SAME_TORQUE, last, last)
    other, small = _under(scene, [0.1 * torque, torque]), _under(scene, [0.1 * torque])
    of_large, of_small = (
        difference(result, other, SOLVED_ANEW, last, last),
        difference(small, other, SOLVED_ANEW, first, first),
    )
    return {name: max(off, of_small[name]) for name, off in of_large.items()}


def _under(scene: Scene, torques: Sequence[float]) -> MeshCycle:
    """Result of a scene under torques [N m]."""
    return analysed(scene.with_changes({"analysis.torques_Nm": [*torques]}))


def positions_among_others(subject: Subject) -> Off:
    """Positions among twice as many are what they are among few.

    Gears on supports stand where the mean load of the positions moves them, so that contacts are solved anew.
    """
    count = subject.scene.analysis.positions
    finer = analysed(subject.scene.with_changes({"analysis.positions": 2 * count - 1}))
    moves = subject.scene.is_supported or subject.featured.family in HALVES
    allowed = SOLVED_ANEW if moves else SAME_TORQUE
    return difference(subject.result, finer, allowed, there=(slice(None), slice(None, None, 2)))


def zeros_as_none(subject: Subject) -> Off:
    """Sections of zeros are none: modifications, roundings, deviations, supports that do not give way."""
    scene: Any = subject.scene
    changes: dict[str, Any] = {}
    for gear in GEARS:
        own = getattr(scene, gear)
        changes |= {f"{gear}.{edge}_rounding_mm": getattr(own, f"{edge}_rounding_mm") for edge in ("tip", "side")}
        changes |= {
            f"{gear}.modifications.{name}": getattr(own.modifications, name) for name in ("twist_um", "polynomial_mm")
        }
        if isinstance(scene, RackScene):
            continue  # which has neither pitch deviations nor a second support
        if own.pitch is None:
            changes |= {f"{gear}.pitch.index_um": [0.0] * abs(own.teeth), f"{gear}.pitch.runout_um": 0.0}
        if isinstance(scene, DoubleHelicalScene):
            changes[f"{gear}.half_b"] = _as_half_a(scene, gear)
        elif own.support is None and own.shaft is None:
            changes[f"{gear}.support.compliance"] = [[0.0] * 6] * 6
        if getattr(own, "thickness_allowance_um", 0.0) is None:
            changes |= {f"{gear}.thickness_allowance_um": 0.0, f"{gear}.tip_chamfer_mm": own.tip_chamfer_mm}
    return difference(subject.result, analysed(scene.with_changes(changes)), SAME_TORQUE)


def _as_half_a(scene: Scene, gear: str) -> dict[str, Any]:
    """What half b has, and all else as half a has it."""
    own = as_table(scene)[gear]
    return {name: own[name] for name in ("modifications", "flank")} | own.get("half_b", {})


def memory_and_file(subject: Subject) -> Off:
    """A result from its file has the numbers and derivatives that it has in memory."""
    result: Any = subject.result
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        loaded = _from_file(result, Path(folder))
        off = {
            f"figure {name}": _unlike(value, loaded.key_figures()[0][name])
            for name, value in result.key_figures()[0].items()
        }
        tolerances = tolerances_of(subject.scene)
        keys = subject.rng.choice([*tolerances], min(3, len(tolerances)), replace=False).tolist()
        slopes = [one.sensitivities(keys) for one in (result, loaded)]
        for name in ("transmission_error", "peak_pressure", "line_load", "face_load_factor", "peak_to_peak"):
            if hasattr(slopes[0], name):  # two halves have no load factor together
                off[f"derivatives of the {name}"] = _unlike(*(getattr(one, name) for one in slopes))
        widths = np.array([tolerances[key] for key in slopes[0].keys])
        shares = [one.load_share * widths for one in slopes]
        off["derivatives of the load_share"] = _unlike(*shares, least=NO_SHARE)
    return {name: part / FROM_FILE for name, part in off.items()}


def _from_file(result: Any, folder: Path) -> Any:
    """A result as it is read from the file, or files, that it is written into."""
    if isinstance(result, HalvesAsPairs):
        result.save(folder)
        return HalvesAsPairs(DoubleHelicalResult.load(folder))
    path = folder / "result.nc"
    result.save(path)
    return load_result(path)


def tolerances_of(scene: Scene) -> dict[str, float]:
    """Keys that have derivatives, with their usual tolerances; of two halves where their apex lies, too."""
    halves = isinstance(scene, DoubleHelicalScene)
    return default_tolerances(scene) | (default_tolerances(scene, ["pair.apex_offset_mm"]) if halves else {})


def _unlike(one: Any, other: Any, least: float = 0.0) -> float:
    """Largest difference of two arrays over the largest number, or over ``least``; infinite where one is NaN alone."""
    first, second = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    known = np.isfinite(first)
    if first.shape != second.shape or (known != np.isfinite(second)).any():
        return math.inf
    if not known.any() or not (largest := max(least, float(np.abs(first[known]).max()))):
        return 0.0
    return float(np.abs(first - second)[known].max()) / largest


def finer_grids(subject: Subject) -> Off:
    """Numbers of two accuracies differ by no more than the errors told of both; load shares by a part of the whole."""
    fine = analysed(subject.scene.with_changes({"analysis.accuracy": 0.2 * subject.scene.analysis.accuracy}))
    result = subject.result
    pairs = np.union1d(result.pair, fine.pair)
    shares, peaks, errors = (
        [of_pairs(one, name, pairs) for one in (result, fine)]
        for name in ("load_share", "peak_pressure", "discretisation_error")
    )
    counted = (np.minimum(*shares) > LITTLE_LOAD) & (errors[0] > 0.0)
    allowed = errors[0] * peaks[0] + errors[1] * peaks[1] + LITTLE_LOAD * 1e-2 * peaks[0].max()
    off = np.where(counted, np.abs(peaks[1] - peaks[0]) / allowed, 0.0)
    turned = np.abs(fine.transmission_error - result.transmission_error)
    by_grids = sum(one.transmission_error_by_grids.max(axis=1, keepdims=True) for one in (result, fine))
    return {
        "peak pressure over the errors told": float(off.max()),
        "transmission error": float((turned / (by_grids + SAME_TORQUE[0] * span(result))).max()),
        "load share": float(np.abs(shares[1] - shares[0]).max()) / GRIDS,
    }


# Laws of mechanics


def torque_balanced(subject: Subject) -> Off:
    """Normal forces times their levers are the torque."""
    result = subject.result
    levers = np.stack([path.pinion_lever for path in result.paths], axis=-1)
    moments = np.nansum(result.normal_force * levers, axis=-1)
    return {"torque": float(np.abs(moments / result.torque[:, None] - 1.0).max()) / BALANCED}


def energy_kept(subject: Subject) -> Off:
    """From three quarters of a torque to five quarters the work of the wheel's moment is what deformation stores.

    The work is that of both ends less the integral of the rotation over the moment, after Simpson.
    """
    torques = 1e-3 * float(subject.result.torque[-1]) * np.array([0.75, 1.0, 1.25])
    result = analysed(subject.scene.with_changes({"analysis.torques_Nm": torques.tolist()}))
    levers = np.stack([path.wheel_lever for path in result.paths], axis=-1)
    moment = np.nansum(result.normal_force * levers, axis=-1)
    rotation = -result.gear_pair.driving * (result.transmission_error - result.unloaded_transmission_error)
    between = (moment[2] - moment[0]) * (rotation[0] + 4.0 * rotation[1] + rotation[2]) / 6.0
    work = moment[2] * rotation[2] - moment[0] * rotation[0] - between
    stored = stored_in(result)
    allowed = ENERGY + told(result).max(axis=0)
    return {"work": float((np.abs((stored[2] - stored[0]) / work - 1.0) / allowed).max())}


def stored_in(result: MeshCycle) -> Array:
    """Half of what pressures times the closing of the gaps beneath them sum up to, (torque, position) [N mm].

    On cells that edges cut, and whose middles may lie outside the flank, the gap is that of the flanks continued.
    """
    assert result.states is not None
    (states,) = result.states[1]
    work = np.zeros(len(states.grids))
    columns = {int(number): k for k, number in enumerate(result.pair)}
    for n, grids in enumerate(states.grids):
        t, position = divmod(n, len(result.path))
        for grid in grids:
            unloaded = result.paths[columns[grid.number]].transmission_error[position]
            rotation = -result.gear_pair.driving * (result.transmission_error[t, position] - unloaded)
            pressed = grid.pressure > 0.0
            closing = rotation * grid.contact.wheel_lever - grid.separation.cut_gap[pressed]
            work[n] += 0.5 * float(grid.pressure[pressed] @ closing) * math.prod(grid.separation.spacing)
    return work.reshape(result.transmission_error.shape)


def moments_on_shafts(subject: Subject) -> Off:
    """Forces on what holds the gears balance those of the teeth: the torque, and each other."""
    result = subject.result
    off = {}
    for gear, torque in ((GEARS[0], result.torque),):
        if f"{gear}_support_load" not in result.dataset:
            continue
        loads = np.asarray(getattr(result, f"{gear}_support_load")).reshape(len(result.torque), -1, 6)
        off[f"moment about the axis of the {gear}"] = float(
            np.abs(np.abs(loads[..., 5].sum(axis=1)) / torque - 1.0).max()
        )
    for gear in GEARS:
        if f"{gear}_bearing_force" not in result.dataset:
            continue
        force = np.asarray(getattr(result, f"{gear}_bearing_force")).sum(axis=2)[..., :3]
        normal = np.nansum(result.normal_force, axis=-1)
        if len(result.pair) == 1 or subject.scene.analysis.load_sharing:
            off[f"forces on the bearings of the {gear}"] = float(
                np.abs(np.linalg.norm(force, axis=-1) / normal - 1.0).max()
            )
    return {name: part / ON_BEARINGS for name, part in off.items()}


def stiffness_and_rotation(subject: Subject) -> Off:
    """Torque over rotation between two torques lies between the tangents at both: load makes the drive stiffer.

    On supports that by the torque, with which the gears go on to stand elsewhere: drive_stiffness is the tangent
    where they stand, and leaves out 3.4 % of seed 173 (2.1, 0.53 and 0.13 % under 0.5, 0.1 and 0.02 of its torque).
    """
    torque = 1e-3 * float(subject.result.torque[-1])
    result = analysed(subject.scene.with_changes({"analysis.torques_Nm": [0.95 * torque, 1.05 * torque]}))
    turned = np.abs(np.diff(result.transmission_error, axis=0)[0])
    lengths = 1e3 * result.gear_pair.base_radii[0] * result.gear_pair.base_radii[1] * float(result.face_width)
    chord = np.diff(result.torque)[0] / turned / lengths
    stiffness = result.mesh_stiffness
    if subject.scene.is_supported:
        stiffness = 1e3 / np.abs(result.sensitivities([TORQUE]).transmission_error[..., 0]) / lengths  # by N m
    low, high = stiffness.min(axis=0), stiffness.max(axis=0)
    return {"stiffness": float(np.maximum(low / chord - 1.0, chord / high - 1.0).max()) / STIFFNESS}


def derivatives_and_differences(subject: Subject) -> Off:
    """Derivatives to a key beside differences of analyses on both sides, unless those of twice the step are others."""
    tolerances = {key: size for key, size in tolerances_of(subject.scene).items() if key != TORQUE}
    key = str(subject.rng.choice([*tolerances]))
    step = 0.1 * tolerances[key]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        with noted_accuracy_warnings(given=False) as warned:
            slopes = subject.result.sensitivities([key])
            own = {
                name: getattr(slopes, name)[..., 0] for name in ("transmission_error", "load_share", "peak_pressure")
            }
    near, far, off = _differences(subject, key, step), {}, {}
    for name, slope in own.items():
        size = span(subject.result).max() if name == "transmission_error" else np.nanmax(getattr(subject.result, name))
        scale = max(_largest(near[name]), 1e-2 * float(size) / tolerances[key])
        if (error := _largest(slope - near[name]) / scale) > DERIVATIVES:
            far = far or _differences(subject, key, 2.0 * step)
            if _largest(far[name] - near[name]) > DERIVATIVES * scale:
                continue  # differences scatter themselves
            if warned and error < LARGEST_WARNED:
                continue
        off[f"{name} by {key}"] = error / DERIVATIVES
    return off


def _largest(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.abs(known).max()) if known.size else 0.0


def _differences(subject: Subject, key: str, step: float) -> dict[str, Array]:
    """Slopes of transmission errors, shares and peak pressures between analyses a step of a key to either side.

    Where a tooth pair that carries nothing in the scene comes under load on one side, they are those to the other side:
    its force grows from nothing with about the power 3/2 of the key, which puts slopes over both sides off by the root
    of the step, while the derivative is that without it.
    """
    value, here = number_at(subject.scene, key), subject.result
    low, high = (analysed(subject.scene.with_changes({key: value + by})) for by in (-step, step))
    results = low, here, high
    numbers = np.unique(np.concatenate([one.pair for one in results]))
    left, carrying, right = (of_pairs(one, "load_share", numbers) > 0.0 for one in results)
    more_left, more_right = ((side & ~carrying).any(axis=-1, keepdims=True) for side in (left, right))
    width = step * np.where(more_left == more_right, 2.0, 1.0)
    slopes = {}
    for name in ("transmission_error", "load_share", "peak_pressure"):
        of_states = name == "transmission_error"
        below, at, above = (
            one.transmission_error[..., None] if of_states else of_pairs(one, name, here.pair) for one in results
        )
        first = np.where(more_left & ~more_right, at, below)
        second = np.where(more_right & ~more_left, at, above)
        known = of_states | ((first > 0.0) & (second > 0.0))
        slope = np.where(known, (second - first) / width, math.nan)
        slopes[name] = slope[..., 0] if of_states else slope
    return slopes


# Continuity


class Axis(NamedTuple):
    """What a scene is varied by beside the torque: its name, families, and keys that change with a part (0 to 1)."""

    name: str
    families: tuple[str, ...]
    changes: Callable[[Subject, float], dict[str, Any]]


def _along(
    key: str, low: float, high: float, *, over_module: bool = False
) -> Callable[[Subject, float], dict[str, Any]]:
    def changes(subject: Subject, part: float) -> dict[str, Any]:
        unit = module_of(subject.scene) if over_module else 1.0
        return {key: unit * (low + part * (high - low))}

    return changes


def _rounding_from_zero(subject: Subject, part: float) -> dict[str, Any]:
    least, most = SMALLEST_ROUNDING, 0.15 * subject.scene.pair().module
    radius = least + part * (most - least) if part > 0.0 else 0.0
    return {f"{gear}.tip_rounding_mm": radius for gear in GEARS}


def _relief_start(subject: Subject, part: float) -> dict[str, Any]:
    """The tip relief of the pinion that starts 0.2 to 0.4 of the active profile before the tip."""
    flank, low = subject.scene.pair().pinion.flank, subject.scene.active_starts()[0]
    tip = float(flank.profile_coordinate(*flank.grid(3, 3)).value[-1, 1])
    start = tip - (tip - low) * (0.2 + 0.2 * part)
    name = "pinion.modifications.tip_relief"
    return {f"{name}_um": 10.0, f"{name}_form": "parabolic", f"{name}_start_mm": 0.0, f"{name}_start_roll_deg": 0.0,
            f"{name}_start_length_mm": start * flank.profile_unit}  # fmt: skip


AXES = (
    Axis("misalignment", (*CYLINDRICAL, *RACK, *HALVES), _along("mounting.misalignment_um", -20.0, 20.0)),
    Axis("misalignment", (*BEVEL, "face_milled"), _along("mounting.offset_mm", -0.01, 0.01, over_module=True)),
    Axis("relief start", (*CYLINDRICAL[:2], *BEVEL, *RACK), _relief_start),
    Axis("tip diameter", (*CYLINDRICAL[:2], *RACK), _along("pinion.tip_alteration_coefficient", -0.15, 0.0)),
    Axis("rounding from zero", (*CYLINDRICAL, *BEVEL, *RACK), _rounding_from_zero),
    Axis("shaft angle", BEVEL, _along("mounting.shaft_angle_error_deg", -0.03, 0.03)),
    Axis("centre distance", (*CYLINDRICAL, *RACK, *HALVES),
         _along("mounting.centre_distance_error_mm", 0.0, 0.05, over_module=True)),
    Axis("apex offset", HALVES, _along("pair.apex_offset_mm", -5e-3, 5e-3, over_module=True)),
    Axis("addendum of the rack", RACK, _along("wheel.addendum_mm", 0.8, 1.0, over_module=True)),
)  # fmt: skip
VALUES = 41


def continuous(subject: Subject) -> Off:
    """Transmission error, shares and peak pressure over 41 values of a number of the scene have no jumps."""
    axes = [None, *(axis for axis in AXES if subject.featured.family in axis.families)]
    axis = axes[int(subject.rng.integers(len(axes)))]
    return continuous_over(subject, axis)


def continuous_over(subject: Subject, axis: Axis | None) -> Off:
    """The same over an axis; None: the torque, from half to one and a half."""
    torque, parts = 1e-3 * float(subject.result.torque[-1]), np.linspace(0.0, 1.0, VALUES)
    changes = {"positions": 1, "compliance": "contact", "torques_Nm": [torque]}
    scene = subject.scene.with_changes({f"analysis.{name}": value for name, value in changes.items()})
    if axis is None:
        results = [analysed(scene.with_changes({"analysis.torques_Nm": (torque * (0.5 + parts)).tolist()}))]
    else:
        results = [analysed(scene.with_changes(axis.changes(subject, float(part)))) for part in parts]
    deflection, error, peak, *shares = np.concatenate([_numbers(result) for result in results]).T
    name = "torque" if axis is None else axis.name
    known = scene.analysis.accuracy * float(peak.max())  # by which peaks may scatter
    jumps = {
        "transmission error": largest_jump(error, LEAST_SPAN * float(np.abs(deflection).max())),
        "peak pressure": largest_jump(peak, known / JUMP),
        "load share": max(largest_jump(values, LEAST_SPAN) for values in shares),
    }
    return {f"{quantity} over the {name}": jump / JUMP for quantity, jump in jumps.items()}


def _numbers(result: MeshCycle) -> Array:
    """Deflection, transmission error, peak pressure and shares at the only position, in a row for each torque."""
    error, peak = result.transmission_error[:, 0], np.where(result.load_share > LITTLE_LOAD, result.peak_pressure, 0.0)
    shares = of_pairs(result, "load_share", np.arange(-3, 4))[:, 0]
    deflection = error - result.unloaded_transmission_error[0]
    return np.column_stack([deflection, error, np.nanmax(peak, axis=(1, 2)), shares])


def largest_jump(values: Array, least: float) -> float:
    """Largest jump of a curve over its range, or over a least one; see ``validation.loaded.jumps``."""
    steps = np.diff(values)
    before, after = steps[1:-1] - steps[:-2], steps[1:-1] - steps[2:]
    jumps = np.where(before * after > 0.0, np.minimum(np.abs(before), np.abs(after)), 0.0)
    return float(jumps.max()) / max(float(np.ptp(values)), least)
