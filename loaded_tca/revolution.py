"""Whole revolutions in one function: from a scene to what every tooth carries, each at its own place."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import version
from typing import TYPE_CHECKING, overload

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.analysis import grid_of, roots_of
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.compliance import RootStress, model_of
from loaded_tca.compliance.model import HeldBodies, held_bodies, with_enough_teeth
from loaded_tca.effort import Effort, expected_effort
from loaded_tca.errors import give_accuracy_warning, noted_accuracy_warnings, require
from loaded_tca.loaded.cycle import Progress
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.moved_gears import loads_at, pitches_apart
from loaded_tca.loaded.revolution import STATES_AT_A_TIME, RevolutionPart, solve_revolution
from loaded_tca.loaded.standing import POSITIONS, GearsUnderTorques, Standing, pair_span
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.collect import Place, numbers_and_maps
from loaded_tca.results.gear_warnings import warn_of_gears
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.revolution import OF_TEETH, Revolution, open_turns
from loaded_tca.results.root_stress import root_stress_of_gear
from loaded_tca.results.supports import support_arrays, warn_of_supports
from loaded_tca.results.warnings import at_places, place_of, reasons_of, rotation_reasons
from loaded_tca.scene import Scene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.scene.pitch import Revolution as RevolutionSection
from loaded_tca.supports import support_compliance
from loaded_tca.threads import one_blas_thread
from loaded_tca.unloaded.revolution import RevolutionPath, trace_revolution

if TYPE_CHECKING:
    from loaded_tca.double_helical.revolution import DoubleHelicalRevolution

KEPT = "normal_force", "peak_pressure", "on_edge"
"""Numbers of single contacts that a revolution keeps."""


def expected_revolution_effort(scene: Scene) -> Effort:
    """Estimate what a whole revolution takes; see :func:`loaded_tca.effort.expected_effort`.

    The time is that of the states of all its positions; the memory that of those which are solved together.
    """
    asked, torques = _asked(scene), len(scene.torques)
    states = asked.count((scene.pinion.teeth, abs(scene.wheel.teeth))) * asked.positions_per_pitch
    some = max(1, min(states, STATES_AT_A_TIME // torques))
    first, part = (
        expected_effort(scene.with_changes({"analysis.positions": count, "analysis.load_sharing": True}))
        for count in (1, max(2, some))
    )
    of_state = (part.states - first.states) / (max(2, some) - 1)
    return replace(part, contacts=2 * states * torques, states=first.states + of_state * (states - 1))


@overload
def analyse_revolution(  # type: ignore[overload-overlap]
    scene: DoubleHelicalScene, progress: Progress | None = None
) -> DoubleHelicalRevolution: ...
@overload
def analyse_revolution(scene: Scene, progress: Progress | None = None, *, maps: Sequence[int] = ()) -> Revolution: ...
@checked
def analyse_revolution(
    scene: Scene, progress: Progress | None = None, *, maps: Sequence[int] = ()
) -> Revolution | DoubleHelicalRevolution:
    """Analyse a whole revolution: at every position of every pitch all tooth pairs in contact share the load.

    Index deviations and runout of ``[pinion.pitch]`` and ``[wheel.pitch]`` separate the tooth pairs before the load
    does; ``[revolution]`` says which pitches follow each other, by default those of a turn of the wheel.

    Parameters
    ----------
    scene : Scene
    progress : callable, optional
        Called as ``progress(done, total)`` with the states, torques times positions.
    maps : sequence of int
        Positions whose pressure maps the result keeps, as indices; not of a double helical pair.

    Returns
    -------
    Revolution
        Of a double helical pair :class:`loaded_tca.double_helical.DoubleHelicalRevolution`, as
        :func:`loaded_tca.double_helical.analyse_double_helical_revolution` makes it.

    Raises
    ------
    InputError, GeometryError
        As of :func:`loaded_tca.analyse`, and if an index deviation is larger than 0.05 modules, or load sharing is off.
    ConvergenceError
        If a contact, or the balance of the tooth pairs, is not solved to the tolerance.

    Warns
    -----
    AccuracyWarning
        As of :func:`loaded_tca.analyse`, and if the revolution is no whole turn of a gear whose teeth deviate.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> changes = {"analysis.compliance": "contact", "analysis.torques_Nm": [20.0], "wheel.pitch.runout_um": 10.0}
    >>> changes |= {"revolution.pitches": 1, "revolution.positions_per_pitch": 2}
    >>> scene = read_scene("examples/scenes/mesh_cycle_spur.toml").with_changes(changes)
    >>> import warnings
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore")
    ...     revolution = analyse_revolution(scene)
    >>> revolution.dataset["transmission_error"].shape
    (1, 2)
    """
    if isinstance(scene, DoubleHelicalScene):
        from loaded_tca.double_helical.revolution import analyse_double_helical_revolution

        require((not len(maps), f"maps: found {[*maps]}; allowed (): no maps are kept of a double helical pair"))
        return analyse_double_helical_revolution(scene, progress)
    with one_blas_thread():
        with noted_accuracy_warnings() as warned:
            pair, wanted, asked = scene.pair(), scene.analysis, _asked(scene)
            require(
                (wanted.load_sharing, "analysis.load_sharing: found false; allowed true in a whole revolution"),
                (not (effort := expected_revolution_effort(scene)).is_refused, f"analysis.cells: {effort}"),
            )
            pitches = asked.count(pair.teeth)
            count = pitches * asked.positions_per_pitch
            wrong = [n for n in maps if not (isinstance(n, int | np.integer) and 0 <= n < count)]
            require((not wrong, f"maps: {wrong[:3]} are no positions; allowed 0 to {count - 1}"))
            warn_of_gears(scene, pair, whole_revolution=True)
            for gear in open_turns(scene, pitches):
                give_accuracy_warning(kinds.OPEN_REVOLUTION.sentence(pitches=pitches, gear=gear))
            grid = grid_of(scene)
            path = _trace(scene, pair, pitches)
            numbers = _over_revolution(scene, pair, path, grid, frozenset(maps), progress)
            arrays = _joined(scene, path, numbers)
            for sentence in _sentences(pair, numbers, held_bodies(scene, pair)):
                give_accuracy_warning(sentence)
        about = {
            "version": version("loaded_tca"),
            "date": datetime.now(UTC).isoformat(timespec="seconds"),
            "warnings": "\n".join(dict.fromkeys(warned)),
        }
        kept = {
            (t + first, n): row for first, of_standing in _in_order(numbers) for (t, n), row in of_standing.maps.items()
        }
        return Revolution(scene=scene, dataset=Revolution.dataset_of(arrays, **about), maps=kept)


def _asked(scene: Scene) -> RevolutionSection:
    scene.require_turns("a whole revolution")
    return scene.revolution or RevolutionSection()


def _trace(scene: Scene, pair: GearPair, pitches: int, standing: Standing | None = None) -> RevolutionPath:
    """Unloaded contact over so many pitches of a pair of the scene, and of its pairings of teeth with own flanks.

    ``standing``: where the gears of these stand, as the pair does; default: at rest.
    """
    asked, flanks = _asked(scene), scene.tooth_flanks()
    if flanks is not None and standing is not None:
        flanks = replace(flanks, gears={kinds: standing.moved(gears) for kinds, gears in flanks.gears.items()})
    deviations, first_teeth = scene.tooth_deviations(pair), asked.first_teeth(pair.teeth)
    return trace_revolution(pair, deviations, pitches, asked.positions_per_pitch, first_teeth, flanks)


def _over_revolution(
    scene: Scene,
    pair: GearPair,
    unloaded: RevolutionPath,
    grid: GridChoice,
    maps: frozenset[int],
    progress: Progress | None,
) -> list[_Numbers]:
    """Numbers of the gears as they stand: on supports moved by the mean load of a pitch of teeth that are alike."""
    torques, supports, roots = scene.torques, support_compliance(scene, pair), roots_of(scene, pair)
    angles, pitches = pair.pitch * np.linspace(-0.5, 0.5, POSITIONS + 1), _asked(scene).count(pair.teeth)

    def under(apart: int) -> list[_Numbers]:
        gears, numbers, done = GearsUnderTorques(pair, model_of(scene, pair, apart), angles, grid), [], 0
        for standing in gears.standing(torques):
            path = unloaded if standing.loads is None else _trace(scene, standing.pair, pitches, standing)
            report = None if progress is None else partial(_report, progress, done, len(path) * len(torques))
            of_standing = _Numbers(standing, path, grid, roots, maps)
            for part in solve_revolution(path, standing, grid, report):
                of_standing.add(part)
            numbers.append(of_standing)
            done += len(path) * standing.torques.size
        return numbers

    numbers = with_enough_teeth(pitches_apart(pair, supports, torques), under)
    warn_of_supports(pair, numbers)
    return numbers


def _report(progress: Progress, before: int, whole: int, done: int, _: int) -> None:
    """Report the states of some torques among those of all."""
    progress(before + done, whole)


OF_NO_PAIR: dict[str, float | bool] = {
    "load_share": 0.0,
    "normal_force": 0.0,
    "peak_pressure": math.nan,
    "tooth_deflection": math.nan,
    "on_edge": False,
}
"""Numbers of tooth pairs that are out of reach."""


def _joined(scene: Scene, path: RevolutionPath, numbers: Sequence[_Numbers]) -> dict[str, Array]:
    """Arrays of all torques, whose gears stand elsewhere: of all tooth pairs that one of them, or none, brings near."""
    parts = [of_standing.whole() for of_standing in numbers]
    paths = [path, *(of_standing.path for of_standing in numbers)]
    pairs, torques = np.unique(np.concatenate([traced.pairs for traced in paths])), len(scene.torques)
    arrays = dict(parts[0])
    for name, values in parts[0].items():
        if name in OF_NO_PAIR:
            arrays[name] = np.full((torques, len(path), len(pairs)), OF_NO_PAIR[name], dtype=values.dtype)
            for (first, of_standing), part in zip(_in_order(numbers), parts, strict=True):
                rows = slice(first, first + of_standing.torques.size)
                arrays[name][rows][..., np.searchsorted(pairs, of_standing.path.pairs)] = part[name]
        elif name not in AS_AT_REST:
            arrays[name] = np.concatenate([part[name] for part in parts])
    for name in ("pinion_tooth", "wheel_tooth"):
        arrays[name] = np.zeros((len(path), len(pairs)), dtype=int)
        for own in paths:
            arrays[name][:, np.searchsorted(pairs, own.pairs)] = getattr(own, name)
    supported = support_arrays(path.pair, numbers, pressure_angle=scene.transverse_angles[0])
    return arrays | supported | {"pair": pairs, "rigid_transmission_error": path.transmission_error}


def _in_order(numbers: Sequence[_Numbers]) -> Iterator[tuple[int, _Numbers]]:
    """Each with the index of its first torque among all."""
    first = 0
    for of_standing in numbers:
        yield first, of_standing
        first += of_standing.torques.size


def _sentences(pair: GearPair, numbers: Sequence[_Numbers], bodies: HeldBodies) -> Iterator[str]:
    """Accuracy warnings of all contacts under all torques, each reason once."""
    places: dict[str, list[str]] = {}
    for of_standing in numbers:
        for torque, forces in zip(of_standing.torques.tolist(), of_standing.arrays["normal_force"], strict=True):
            if torque > 0.0 and not forces.any():
                yield kinds.NO_TORQUE.sentence(torque=1e-3 * torque)
        for reason, at in of_standing.places.items():
            places.setdefault(reason, []).extend(at)
    solved = sum(of_standing.solved for of_standing in numbers)
    yield from (at_places(reason, at, solved) for reason, at in places.items())
    torques = np.concatenate([of_standing.torques for of_standing in numbers])
    rotation, rate = (
        np.concatenate([of_standing.arrays[name] for of_standing in numbers]) for name in ("rotation", "stiffness")
    )
    yield from rotation_reasons(pair, torques, rotation, rate, bodies)


AS_AT_REST = {"pinion_angle", "pair", "wheel_base_radius", "face_width", *OF_TEETH, "rigid_transmission_error"}
"""Numbers that are the same under all torques."""


@dataclass(eq=False)
class _Numbers:
    """Numbers of a revolution of gears as they stand, filled part by part."""

    standing: Standing
    path: RevolutionPath
    grid: GridChoice
    roots: tuple[RootStress, ...]
    wanted_maps: frozenset[int]
    maps: dict[tuple[int, int], tuple[PressureMap | None, ...]] = field(default_factory=dict)
    places: dict[str, list[str]] = field(default_factory=dict)
    solved: int = 0

    def __post_init__(self) -> None:
        self.pair, self.torques, loads = self.path.pair, self.standing.torques, self.standing.loads or ()
        shape = len(self.torques), len(self.path), len(self.path.pairs)
        self.drive_rate = np.full(shape[:2], math.nan)
        self.loads = tuple(np.full((shape[1], of_gear.size), math.nan) for of_gear in loads)
        cycle, gears = shape[:2], (*shape[:2], 2)
        self.arrays: dict[str, Array] = {
            "rotation": np.full(cycle, math.nan),
            "stiffness": np.full(cycle, math.nan),
            "load_share": np.zeros(shape),
            "normal_force": np.zeros(shape),
            "peak_pressure": np.full(shape, math.nan),
            "tooth_deflection": np.full(shape, math.nan),
            "on_edge": np.zeros(shape, dtype=bool),
        }
        if self.roots:
            self.arrays |= {name: np.full(gears, math.nan) for name in ("root_tension", "root_compression")}
            self.arrays["root_tension_tooth"] = np.full(gears, -1)

    @property
    def pitches_apart(self) -> int:
        """How many pitches two tooth pairs that carry load at a position are apart at the most."""
        return pair_span(self.path.pairs, self.arrays["load_share"])

    def add(self, part: RevolutionPart) -> None:
        """Take what a part of the positions has of each contact, and let the contacts go."""
        begin, shape = part.positions.start, (len(self.torques), len(part.positions), len(self.path.pairs))
        rows = slice(begin, part.positions.stop)
        contacts: dict[Place, LoadedContact | None] = dict.fromkeys(np.ndindex(shape))
        by_gears: dict[int, tuple[GearPair, dict[Place, LoadedContact | None]]] = {}
        columns = {number: column for column, number in enumerate(self.path.pairs.tolist())}
        for (t, n), shared in part.shared.items():
            self.arrays["rotation"][t, begin + n] = shared.rotation
            for share in shared.shares:
                k = columns[share.tooth_pair.pair]
                contacts[t, n, k] = share.loaded
                gears = share.tooth_pair.gears or self.pair
                by_gears.setdefault(id(gears), (gears, {}))[1][t, n, k] = share.loaded
                at = t, begin + n, k
                self.arrays["load_share"][at] = share.torque / self.torques[t] if shared.torque > 0.0 else 1.0
                self.arrays["tooth_deflection"][at] = share.tooth_deflection
        self.arrays["stiffness"][:, rows], self.drive_rate[:, rows] = part.stiffness, part.drive_stiffness
        if self.standing.supports is not None:
            loaded = [[share.loaded for share in part.shared[0, n].shares] for n in range(shape[1])]
            for of_gear, loads in zip(self.loads, loads_at(self.standing.supports, loaded), strict=True):
                of_gear[rows] = loads
        maps: dict[Place, PressureMap | None] = dict.fromkeys(contacts)
        for pair, own in by_gears.values():
            numbers, own_maps = numbers_and_maps([pair] * shape[0], own, dict.fromkeys(own), shape)
            maps |= own_maps
            known = ~np.isnan(numbers["normal_force"])
            for name in KEPT:
                self.arrays[name][:, rows][known] = numbers[name][known]
        self._note(contacts, begin)
        for t in range(shape[0]):
            for n in self.wanted_maps & set(part.positions):
                self.maps[t, n] = tuple(maps[t, n - begin, k] for k in range(shape[2]))
        if self.roots:
            stacked = tuple(
                tuple(tuple(maps[t, n, k] for k in range(shape[2])) for n in range(shape[1])) for t in range(shape[0])
            )
            self._add_roots(rows, stacked)

    def _note(self, contacts: dict[Place, LoadedContact | None], begin: int) -> None:
        """Note what limits the accuracy of each contact."""
        for (t, n, k), loaded in contacts.items():
            if loaded is None:
                continue
            self.solved += 1
            angle = float(self.path.pinion_angle[begin + n])
            for reason in reasons_of(self.pair, self.grid, loaded):
                place = place_of(float(self.torques[t]), angle, int(self.path.pairs[k]))
                self.places.setdefault(reason, []).append(place)

    def _add_roots(self, rows: slice, maps: tuple[tuple[tuple[PressureMap | None, ...], ...], ...]) -> None:
        """Root stress of both gears at some positions: a tooth's number counts from that of tooth pair 0."""
        known = np.ones((len(self.torques), rows.stop - rows.start), dtype=bool)
        numbers, zero = self.path.pairs.tolist(), self.path.pairs.tolist().index(0)
        for gear, model in enumerate(self.roots):
            stresses = root_stress_of_gear(self.pair, gear, model, numbers, known, maps)
            for name in ("root_tension", "root_compression"):
                self.arrays[name][:, rows, gear] = stresses[name]
            tooth = (self.path.pinion_tooth, self.path.wheel_tooth)[gear][rows, zero]
            steps = -self.pair.sense if gear == 0 else self.pair.sense
            counted = tooth + steps * stresses["root_tension_place"][..., 0]
            self.arrays["root_tension_tooth"][:, rows, gear] = counted % self.pair.teeth[gear]

    def whole(self) -> dict[str, Array]:
        """Arrays of ``REVOLUTION_QUANTITIES``, those of root stress if asked for."""
        pair, path, arrays = self.pair, self.path, dict(self.arrays)
        rotation, stiffness = arrays.pop("rotation"), arrays.pop("stiffness")
        return arrays | {
            "torque": self.torques,
            "pinion_angle": path.pinion_angle,
            "pair": path.pairs,
            "wheel_base_radius": np.float64(pair.base_radii[1]),
            "face_width": np.float64(pair.face_width),
            "pinion_tooth": path.pinion_tooth,
            "wheel_tooth": path.wheel_tooth,
            "rigid_transmission_error": path.transmission_error,
            "transmission_error": path.transmission_error - pair.driving * rotation,
            "mesh_stiffness": stiffness / pair.rate_of_stiffness,
            "loaded_pairs": (arrays["normal_force"] > 0.0).sum(axis=-1),
        }
