"""Planetary stages in one function: two mesh cycles under several torques, and the balance of all planets."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import version
from itertools import zip_longest
from typing import Any

import numpy as np
import scipy

from loaded_tca.analysis import analyse
from loaded_tca.apart import apart
from loaded_tca.arrays import Array
from loaded_tca.contact.checks import machine_memory
from loaded_tca.effort import MOST_OF_MEMORY, Effort, expected_effort
from loaded_tca.errors import give_accuracy_warning, noted_accuracy_warnings, require
from loaded_tca.results import MeshCycle
from loaded_tca.scene import Scene
from loaded_tca.stages.balance import Deflections, Shares, balance, directions_of, pin_errors
from loaded_tca.stages.kinematics import mesh_phases
from loaded_tca.stages.result import EDGES, StageResult
from loaded_tca.stages.sections import PLACE, RING_MESH, SUN_MESH, Stage, in_words_of
from loaded_tca.stages.warnings import MeshWarnings
from loaded_tca.threads import is_helper, jobs, side_by_side

PARTS = 0.15, 0.5, 1.6
"""Forces of the mesh cycles over an even share, beside it and the whole force: where planets may come to."""
NEAR = 0.15
"""Relative difference of two forces of which one is enough, unless it is an even share."""
Progress = Callable[[int, int], None]


def analyse_stage(stage: Stage, progress: Progress | None = None) -> StageResult:
    """Analyse a planetary stage: how its planets share the torque over a pitch of the sun, and what follows.

    Parameters
    ----------
    stage : Stage
    progress : callable, optional
        Called as ``progress(done, total)`` with the states of both meshes.

    Returns
    -------
    StageResult

    Raises
    ------
    InputError, GeometryError
        As of :func:`loaded_tca.analyse` for both meshes, and if the planets cannot be put in or touch each other.
    ConvergenceError
        As of :func:`loaded_tca.analyse`, and if the planets do not come into balance.

    Warns
    -----
    AccuracyWarning
        As of :func:`loaded_tca.analyse`, of both meshes under loads up to the largest share of a planet, and the next
        force of the mesh cycles above it.
    """
    stage.require_assembly()
    torques = np.asarray(stage.sun_torques)
    sun_mesh, planets = stage.meshes[0], len(stage.stage.angles)
    base_radius = sun_mesh.pinion.base_radius
    forces = _forces(torques / base_radius, planets)
    count = len(forces) * stage.analysis.positions
    scenes, shown = scenes_of(stage), _Progress(progress, count)
    works = [
        partial(_of_mesh, words, scene, shown, mesh)
        for mesh, (words, scene) in enumerate(zip((SUN_MESH, RING_MESH), scenes, strict=True))
    ]
    at_once = _at_once(*map(expected_effort, scenes))
    (of_sun, of_sun_warned), (of_ring, of_ring_warned) = side_by_side(*works) if at_once else [do() for do in works]
    shown.end()
    arrays = _shared(stage, torques, forces, (of_sun, of_ring))
    warned = MeshWarnings.of(of_sun_warned, of_ring_warned)
    sentences = warned.under(forces, *_largest_loads(stage, arrays))
    about = {
        "version": version("loaded_tca"),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "warnings": "\n".join(sentences),
        "mesh_warnings": warned.to_text(),
    }
    for sentence in sentences:
        give_accuracy_warning(sentence)
    return StageResult(stage=stage, dataset=StageResult.dataset_of(arrays, **about), sun_mesh=of_sun, ring_mesh=of_ring)


def _largest_loads(stage: Stage, arrays: Mapping[str, Array]) -> tuple[float, tuple[float, float]]:
    """Largest force at the base circles that a planet has [N], and the torques of sun and planet under it [N mm]."""
    sun = stage.meshes[0]
    largest = float((arrays["planet_share"].max(axis=(1, 2)) * arrays["torque"]).max())
    force = largest / sun.pinion.base_radius
    return force, (largest, force * sun.wheel.base_radius)


OF_BALANCE = frozenset(
    f"stage.{name}" for name in ("pin_tangential_um", "pin_radial_um", "floating_sun", "sun_support_stiffness_N_per_um")
)
"""Keys that change the balance of the planets alone."""


def rebalanced(result: StageResult, changes: Mapping[str, Any]) -> StageResult:
    """The result of a stage with other pins, or another support of the sun; both meshes stay as they are.

    For studies: a balance takes milliseconds a position, where the meshes take seconds. Its ``warnings`` are those of
    the loads up to its own largest share; none is given.

    Parameters
    ----------
    result : StageResult
    changes : mapping
        Keys ``stage.pin_tangential_um``, ``stage.pin_radial_um``, ``stage.floating_sun`` and
        ``stage.sun_support_stiffness_N_per_um``.

    Returns
    -------
    StageResult

    Raises
    ------
    InputError
        If a key changes more than the balance.
    """
    require(
        *(
            (PLACE.sub(r"stage.\1", name) in OF_BALANCE, f"{name}: needs other meshes; analyse the changed stage")
            for name in changes
        )
    )
    stage = result.stage.with_changes(changes)
    cycles = result.sun_mesh, result.ring_mesh
    forces = cycles[0].dataset["torque"].values / cycles[0].gear_pair.base_radii[0]
    about = {name: str(value) for name, value in result.dataset.attrs.items()}
    arrays = _shared(stage, result.dataset["torque"].values, forces, cycles)
    if "mesh_warnings" in about:
        warned = MeshWarnings.from_text(about["mesh_warnings"])
        about["warnings"] = "\n".join(warned.under(forces, *_largest_loads(stage, arrays)))
    return replace(result, stage=stage, dataset=StageResult.dataset_of(arrays, **about))


def _of_mesh(words: Mapping[str, str], scene: Scene, shown: _Progress, mesh: int) -> tuple[MeshCycle, list[str]]:
    """Mesh cycle of a mesh with its accuracy warnings: in a process of its own beside the other one."""
    with in_words_of(words):
        analysed = apart(_analysed, scene) if is_helper() else _analysed(scene, partial(shown, mesh))
    shown.done[mesh] = shown.states
    return analysed


def _analysed(scene: Scene, progress: Progress | None = None) -> tuple[MeshCycle, list[str]]:
    with noted_accuracy_warnings(given=False, alone=True) as sentences:
        return analyse(scene, progress), sentences


class _Progress:
    """States of both meshes that are done, of as many in each."""

    def __init__(self, progress: Progress | None, states: int) -> None:
        self.progress, self.states, self.done, self.told = progress, states, [0, 0], 0

    def __call__(self, mesh: int, done: int, _: int) -> None:
        self.done[mesh] = done
        self._tell()

    def end(self) -> None:
        """All is done; a mesh that was analysed elsewhere has not said so."""
        if self.told < 2 * self.states:
            self._tell()

    def _tell(self) -> None:
        self.told = sum(self.done)
        if self.progress is not None:
            self.progress(self.told, 2 * self.states)


def scenes_of(stage: Stage) -> tuple[Scene, Scene]:
    """Scenes of the sun's and the ring's mesh, under the torques of their pinions that a stage needs of them."""
    gears = stage.meshes[0]
    forces = _forces(np.asarray(stage.sun_torques) / gears.pinion.base_radius, len(stage.stage.angles))
    scenes = (stage.sun_scene, gears.pinion), (stage.ring_scene, gears.wheel)
    first, second = (_under(scene, forces * gear.base_radius) for scene, gear in scenes)
    return first, second


def states_of(stage: Stage) -> int:
    """How many states of both meshes an analysis of a stage has."""
    return sum(len(scene.torques) * scene.analysis.positions for scene in scenes_of(stage))


def _at_once(first: Effort, second: Effort) -> bool:
    """Whether both meshes are analysed at once: by two jobs, unless that took too much of the memory."""
    return jobs() > 1 and first.memory + second.memory <= MOST_OF_MEMORY * machine_memory()


def expected_stage_effort(stage: Stage) -> Effort:
    """Estimate of what an analysis takes, as of :func:`loaded_tca.effort.expected_effort`: that of both meshes."""
    first, second = map(expected_effort, scenes_of(stage))
    contacts = first.contacts + second.contacts
    if _at_once(first, second):
        longer = max((replace(effort, jobs=1) for effort in (first, second)), key=lambda effort: effort.seconds)
        return replace(longer, contacts=contacts, memory=first.memory + second.memory)
    return replace(
        first,
        contacts=contacts,
        states=first.states + second.states,
        teeth=tuple(map(sum, zip_longest(first.teeth, second.teeth, fillvalue=0.0))),
        roots=tuple(map(sum, zip_longest(first.roots, second.roots, fillvalue=0.0))),
        memory=max(first.memory, second.memory),
    )


def _forces(whole: Array, planets: int) -> Array:
    """Forces at the base circles [N] of the mesh cycles: parts of even shares, up to the whole ones."""
    even = whole / planets
    kept = [*even.tolist(), float(whole.max())]
    for force in np.sort(np.outer(even, [part for part in PARTS if part < planets]).ravel())[::-1].tolist():
        if all(abs(force / other - 1.0) > NEAR for other in kept):
            kept.append(force)
    return np.unique(kept)


def _under(scene: Scene, torques: Array) -> Scene:
    """A scene under pinion torques [N mm]."""
    return replace(scene, analysis=replace(scene.analysis, torques_Nm=tuple((1e-3 * torques).tolist())))


def deflections_of(cycle: MeshCycle, forces: Array) -> Deflections:
    """How far the flanks of a mesh give way, from its loaded and unloaded transmission error at the base circle.

    Parameters
    ----------
    cycle : MeshCycle
        Over one pitch, both ends included, the pitch point in the middle.
    forces : (k,) array [N]
        Of its torques, at the base circle.
    """
    pair = cycle.gear_pair
    length = -pair.driving * pair.base_radii[1]
    unloaded = cycle.dataset["unloaded_transmission_error"].values
    errors = length * np.concatenate([unloaded[None], cycle.dataset["transmission_error"].values])
    start = float(cycle.dataset["pinion_angle"].values[0]) / pair.pitch
    return Deflections(np.append(0.0, forces), errors[:, :-1], start)


def _shared(stage: Stage, torques: Array, forces: Array, cycles: tuple[MeshCycle, MeshCycle]) -> dict[str, Array]:
    """Arrays of the result."""
    asked, sun_drives = stage.stage, stage.stage.driving == "sun"
    angles, planets = asked.angles, len(asked.angles)
    sun_mesh, ring_mesh = stage.meshes
    base_radius = sun_mesh.pinion.base_radius
    pressure_angles = sun_mesh.working_pressure_angle, ring_mesh.working_pressure_angle
    phases = mesh_phases(sun_mesh, ring_mesh, angles, sun_drives)
    tables = [deflections_of(cycle, forces) for cycle in cycles]
    # as many positions as are a multiple of the planets: those of one planet are those of the next
    positions = planets * math.ceil((stage.analysis.positions - 1) / planets)
    cycle = np.arange(positions) / positions
    given = [tables[k].at(cycle[:, None] + phases[k]) for k in range(2)]  # (k, position, planet)
    total = given[0] + given[1]
    tangential, radial = (
        1e-3 * np.asarray(values or np.zeros(planets)) for values in (asked.pin_tangential_um, asked.pin_radial_um)
    )
    errors = pin_errors(tangential, radial, pressure_angles, sun_drives)
    directions = directions_of(angles, pressure_angles[0], sun_drives)
    sign = -1.0 if sun_drives else 1.0
    shape = len(torques), positions
    shares, motion = np.zeros((*shape, planets)), np.zeros((*shape, 2))
    rotation, alone = np.zeros(shape), np.zeros(shape)
    for t, torque in enumerate(torques):
        whole = torque / base_radius
        for n in range(positions):
            state: Shares = balance(tables[0].force, total[:, n].T, directions, errors, whole, asked.support_stiffness)
            shares[t, n], motion[t, n] = state.force / state.force.sum(), state.motion
            rotation[t, n] = state.rotation
            alone[t, n] = scipy.interpolate.PchipInterpolator(tables[0].force, total[:, n, 0])(whole / planets)
    factor = planets * shares.max(axis=(1, 2))
    largest = factor * torques / base_radius / planets
    return {
        "torque": torques,
        "sun_angle": cycle * 2.0 * math.pi / stage.sun.teeth,
        "planet": np.arange(planets),
        "planet_angle": np.asarray(angles),
        "sun_mesh_phase": phases[0],
        "ring_mesh_phase": phases[1],
        "sun_base_radius": np.float64(base_radius),
        "transmission_error": sign * rotation / base_radius,
        "one_path_transmission_error": sign * alone / base_radius,
        "planet_share": shares,
        "sun_motion": motion,
        "mesh_load_factor": factor,
        **_under_largest_share(stage, forces, cycles, largest),
    }


def _under_largest_share(
    stage: Stage, forces: Array, cycles: tuple[MeshCycle, MeshCycle], largest: Array
) -> dict[str, Array]:
    """Pressures and root stresses of both meshes under the largest forces (torques,) [N] of a planet."""
    names = "sun_mesh_peak_pressure", "ring_mesh_peak_pressure"
    arrays = {name: _largest(mesh, "peak_pressure", forces, largest) for name, mesh in zip(names, cycles, strict=True)}
    for name, mesh in zip(EDGES, cycles, strict=True):
        pressure = _largest(mesh, "edge_pressure", forces, largest)
        arrays[name] = np.where(pressure > 0.0, pressure, math.nan)
    if stage.analysis.root_stress:
        roots = ("sun_root_tension", "planet_root_tension_at_sun"), ("planet_root_tension_at_ring", "ring_root_tension")
        for mesh, of_gears in zip(cycles, roots, strict=True):
            for gear, name in enumerate(of_gears):
                arrays[name] = _largest(mesh, "root_tension", forces, largest, gear)
    return arrays


def _largest(cycle: MeshCycle, name: str, forces: Array, wanted: Array, gear: int | None = None) -> Array:
    """Largest value over a mesh cycle under forces (m,) [N], between those of the cycle; 0 where there is none."""
    values = cycle.dataset[name].values
    values = values if gear is None else values[..., gear]
    largest = np.nanmax(values.reshape(len(forces), -1), axis=1, initial=0.0)
    return np.asarray(scipy.interpolate.PchipInterpolator(np.append(0.0, forces), np.append(0.0, largest))(wanted))
