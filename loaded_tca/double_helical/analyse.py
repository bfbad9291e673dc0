"""Double helical pairs in one function: the mesh cycles of both halves under several torques, and their balance."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.analysis import analyse
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices
from loaded_tca.double_helical.balance import Shares
from loaded_tca.double_helical.laws import balance_of, between_torques, gears_of
from loaded_tca.double_helical.result import FACES, DoubleHelicalResult
from loaded_tca.double_helical.shafts import OnShafts, loads_at_first
from loaded_tca.effort import Effort, expected_effort
from loaded_tca.errors import (
    ConvergenceError,
    give_accuracy_warning,
    named,
    noted_accuracy_warnings,
)
from loaded_tca.plain import plain
from loaded_tca.results import MeshCycle
from loaded_tca.results.files import variables_of
from loaded_tca.results.load_factors import face_forces
from loaded_tca.results.quantities import HALF_QUANTITIES
from loaded_tca.results.revolution import Revolution
from loaded_tca.results.warnings import is_under_torque
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.double_helical import HALVES, SIGNS, DoubleHelicalScene
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    import xarray

    from loaded_tca.results.result import AnalysisResult

ACCURATE, WARNED = 1e-4, 1e-3
"""Estimated errors of a share and of the approach with which no more torques are analysed, and above which a warning
says so."""
NEAR = 0.02
"""Difference of two torques of which one is enough: over an even share where shares are uncertain, and over the torque
itself for the mean and the largest torque that a half carries, near which pressures and load factors are analysed."""
OUTSIDE, BEYOND = 1e-3, 0.01
"""By how much of an even share a half may carry more or less than at the torques that were analysed, and by how much
torques at the ends lie outside its shares where it does."""
LEAST = 0.05
"""Of an even share: the least torque that is analysed."""
MOST_ROUNDS = 6
"""Of analyses of both halves; two are the rule where shares differ, one where they do not."""
MOST_ON_SHAFTS = 12
"""The same of halves on shafts, under the mean loads of each other."""
USUAL_ON_SHAFTS = 3
"""Of them, as a rule."""
Progress = Callable[[int, int], None]


class HalfAnalysis(NamedTuple):
    """How a half is analysed, over a pitch or over whole turns, and at how many positions.

    Attributes
    ----------
    solve : callable
        Of the scene of a half and of a progress: its mesh cycle, or its revolution.
    positions : callable
        Of the scene of a half: how many it has.
    """

    solve: Callable[[CylindricalScene, Progress], MeshCycle | Revolution]
    positions: Callable[[CylindricalScene], int]


class _Half(NamedTuple):
    """A half that was analysed, with the accuracy warnings."""

    cycle: MeshCycle | Revolution
    warnings: list[str]


class Place(NamedTuple):
    """Both halves where the floating gear stands under the torques of a scene, and their balance there.

    Beside them forces on the bearings of shafts, (position, bearing, 6) by gear.
    """

    scene: DoubleHelicalScene
    halves: tuple[_Half, _Half]
    state: Shares
    bearing_forces: Mapping[str, Array] = {}

    @property
    def cycles(self) -> list[Any]:
        """Mesh cycles, or revolutions, of both halves."""
        return [half.cycle for half in self.halves]


@checked
def analyse_double_helical(scene: DoubleHelicalScene, progress: Progress | None = None) -> DoubleHelicalResult:
    """Analyse a double helical pair: how its halves share the torque over a pitch, and how far a gear floats.

    Torques under which the floating gear stands apart are analysed by themselves, each where it stands.

    Parameters
    ----------
    scene : DoubleHelicalScene
    progress : callable, optional
        Called as ``progress(done, total)`` with the states of both halves; where shares differ, the total grows.

    Returns
    -------
    DoubleHelicalResult

    Raises
    ------
    InputError, GeometryError
        As of :func:`loaded_tca.analyse` for both halves.
    ConvergenceError
        As there, and if the place of the floating gear does not settle.

    Warns
    -----
    AccuracyWarning
        As there, of both halves, where shares are uncertain between the torques that were analysed, and where one half
        has a measured flank and no gear floats freely.

    Examples
    --------
    >>> import warnings
    >>> from loaded_tca import read_scene
    >>> quick = {"analysis.positions": 1, "analysis.compliance": "contact", "load.pinion_torque_Nm": 20.0}
    >>> quick |= {"pinion.half_b": None, "pair.apex_offset_mm": 0.01}
    >>> scene = read_scene("examples/scenes/double_helical.toml").with_changes(quick)
    >>> with warnings.catch_warnings(action="ignore"):  # of a contact that reaches an edge
    ...     result = analyse_double_helical(scene)
    >>> result.axial_motion.round(6).tolist()
    [[0.01]]
    """
    over_a_pitch = HalfAnalysis(analyse, lambda half: half.analysis.positions)
    places = settled(scene, scene.mounting.axial_offset_mm, StatesDone(progress), over_a_pitch)
    places = sorted(places, key=lambda place: max(place.scene.torques))
    places = [places[-1], *places[:-1]]
    parts = [_arrays(place) | {"place": np.full(len(place.scene.torques), n)} for n, place in enumerate(places)]
    dataset = joined(DoubleHelicalResult, scene, places, parts)
    (half_a, half_b), *others = [_on_whole_gears(place) for place in places]
    elsewhere = tuple(others)
    return DoubleHelicalResult(scene=scene, dataset=dataset, half_a=half_a, half_b=half_b, elsewhere=elsewhere)


def settled(scene: DoubleHelicalScene, axial: float, shown: StatesDone, way: HalfAnalysis) -> list[Place]:
    """Analyses of both halves where the floating gear stands [mm]: one for all torques, or more where it moves far.

    Shafts take other loads under each torque, which is analysed by itself.
    """
    if scene.is_supported:
        rows = np.arange(len(scene.torques))[:, None]
        alone = [_under(scene, row) for row in rows] if len(rows) > 1 else [scene]
        return [_settled_on_shafts(one, axial, shown, way) for one in alone]
    torques = _even_torques(scene)
    for _ in range(MOST_ROUNDS):
        scenes = scene.half_scenes(axial, [[1e-3 * torque for torque in of_half] for of_half in torques])
        analysed = _analysed(scenes, shown, way, scene.geometry.floating)
        state = balance_of(scene, [half.cycle for half in analysed], np.asarray(scene.torques))
        places, wanted = _places(scene, state), _wanted(scene, state, torques)
        moved = float(places.mean())
        groups = _groups(places, FACES * scene.narrow_half)
        if len(groups) > 1:
            parts = (settled(_under(scene, rows), float(places[rows].mean()), shown, way) for rows in groups)
            return [place for part in parts for place in part]
        stands = float(np.abs(places - axial).max()) <= FACES * scene.narrow_half
        if stands and wanted == torques:
            break
        axial, torques = axial if stands else moved, wanted
    if not stands:
        raise _not_settled(scene, moved, MOST_ROUNDS)
    return [Place(scene, analysed, state)]


def _not_settled(scene: DoubleHelicalScene, place: float, rounds: int) -> ConvergenceError:
    """Error of a floating gear whose place [mm] changes from one analysis of both halves to the next."""
    return ConvergenceError(
        f"pair.floating: the place of the {scene.geometry.floating} along its axis, {plain(place)} mm, is not "
        f'settled in {rounds} steps; give pair.axial_stiffness_N_per_um, or pair.floating = "none"'
    )


def _settled_on_shafts(scene: DoubleHelicalScene, axial: float, shown: StatesDone, way: HalfAnalysis) -> Place:
    """Analysis of both halves under one torque, each on shafts that the other one loads, too."""
    torques, loads = _even_torques(scene), loads_at_first(scene, axial)
    for _ in range(MOST_ON_SHAFTS):
        scenes = scene.half_scenes(axial, [[1e-3 * torque for torque in of_half] for of_half in torques], loads)
        analysed = _analysed(scenes, shown, way, scene.geometry.floating)
        cycles = [half.cycle for half in analysed if isinstance(half.cycle, MeshCycle)]  # both
        on_shafts = OnShafts(scene, scenes, cycles, loads)
        state, further = on_shafts.balance()
        wanted, moved = _wanted(scene, state, torques), float(_places(scene, state)[0])
        stands = abs(moved - axial) <= FACES * scene.narrow_half
        if stands and wanted == torques and on_shafts.is_settled(further):
            return Place(scene, analysed, state, on_shafts.bearing_forces(further))
        axial, torques, loads = axial if stands else moved, wanted, on_shafts.next_loads(further)
    if not stands:
        raise _not_settled(scene, moved, MOST_ON_SHAFTS)
    raise ConvergenceError(
        f"shafts: the loads of both halves under {plain(1e-3 * scene.torques[0], 6)} N m are not settled in "
        f"{MOST_ON_SHAFTS} steps: the shafts are too soft for these gears"
    )


def expected_double_helical_effort(scene: DoubleHelicalScene) -> Effort:
    """Estimate of what an analysis takes where halves share evenly, as of :func:`loaded_tca.effort.expected_effort`."""
    first, second = scene.half_scenes(scene.mounting.axial_offset_mm)
    effort, halves = expected_effort(first), 1 if _are_alike(first, second) else len(HALVES)
    times = halves * (USUAL_ON_SHAFTS if scene.is_supported else 1)
    return replace(
        effort,
        contacts=times * effort.contacts,
        states=times * effort.states,
        teeth=times * effort.teeth,
        roots=times * effort.roots,
    )


def _on_whole_gears(place: Place) -> tuple[MeshCycle, MeshCycle]:
    """Mesh cycles of both halves that contain where their faces lie on the whole gears."""
    scene = place.scene
    levers = np.array([scene.lever_of(scene.pinion), scene.lever_of(scene.wheel)])
    first, second = (
        replace(cycle, dataset=cycle.dataset.assign(variables_of(HALF_QUANTITIES, {"mid_face": sign * levers})))
        for cycle, sign in zip(place.cycles, SIGNS, strict=True)
    )
    return first, second


def _even_torques(scene: DoubleHelicalScene) -> list[list[float]]:
    """Pinion torques of both halves [N mm] with even shares."""
    even = sorted({0.5 * torque for torque in scene.torques})
    return [even, [*even]]


class StatesDone:
    """States that are done, of all that are known to be needed."""

    def __init__(self, progress: Progress | None) -> None:
        self.progress, self.before, self.total = progress, 0, 0

    def start(self, states: int) -> None:
        """Begin with so many further states."""
        self.before, self.total = self.total, self.total + states

    def __call__(self, done: int, _: int) -> None:
        """Report the states that are done of those since the last start."""
        if self.progress is not None:
            self.progress(self.before + done, self.total)


def _analysed(
    scenes: Sequence[CylindricalScene], shown: StatesDone, way: HalfAnalysis, floating: str
) -> tuple[_Half, _Half]:
    """Both halves of a pair of which a gear floats; halves that are alike are analysed once."""
    first, second = scenes
    alike = _are_alike(first, second)
    halves: list[_Half] = []
    for half, one in enumerate(scenes[: 1 if alike else 2]):
        shown.start(len(one.torques) * way.positions(one))
        name = "both halves" if alike else f"half {HALVES[half]}"
        with named(name), noted_accuracy_warnings(given=False, alone=True) as sentences:
            cycle = way.solve(one, shown)
            cycle.dataset.attrs["left_out"] = _left_out(HALVES[half], floating)
            halves.append(_Half(cycle, [f"{name}: {_of_half(sentence)}" for sentence in sentences]))
    if alike:
        cycle = halves[0].cycle
        same = replace(cycle, scene=second, dataset=cycle.dataset.assign_attrs(left_out=_left_out(HALVES[1], floating)))
        halves.append(_Half(replace(same, states=None) if isinstance(same, MeshCycle) else same, []))
    return halves[0], halves[1]


def _left_out(half: str, floating: str) -> str:
    """Sentence on what the numbers of a half leave out."""
    whole = "the result of the pair has transmission error and stiffness of both halves together"
    if floating == "none":
        return f"half {half} of a double helical pair: the stiffness is that of this half alone; {whole}"
    return (
        f"half {half} of a double helical pair: the transmission error is that of gears held along their axes, without "
        f"the axial motion of the {floating}, which floats, and the stiffness is that of this half alone; {whole}"
    )


def _are_alike(first: CylindricalScene, second: CylindricalScene) -> bool:
    """Whether two halves are one, but for their titles."""
    return replace(first, title=second.title) == second


def _of_half(sentence: str) -> str:
    """A sentence whose torques, if it has any, are said to be those of the half."""
    return f"{sentence[:-1]}; N m: the torque of the half)" if is_under_torque(sentence) else sentence


def _places(scene: DoubleHelicalScene, state: Shares) -> Array:
    """Mean places (torque,) of the wheel along the axis over the pitch [mm]."""
    return np.asarray(scene.mounting.axial_offset_mm + state.motion.mean(axis=1))


def _groups(places: Array, span: float) -> list[Indices]:
    """Indices of places [mm] that lie within a span of each other, from the lowest place on."""
    groups: list[list[int]] = []
    for row in np.argsort(places, kind="stable").tolist():
        if not groups or places[row] - places[groups[-1][0]] > span:
            groups.append([])
        groups[-1].append(row)
    return [np.array(sorted(rows)) for rows in groups]


def _under(scene: DoubleHelicalScene, rows: Indices) -> DoubleHelicalScene:
    """The scene under some of its torques, without the load spectrum that these are of."""
    torques = [1e-3 * scene.torques[row] for row in rows.tolist()]
    load = replace(scene.load, pinion_torque_Nm=torques[-1], case=None)
    analysis = replace(scene.analysis, torques_Nm=tuple(torques))
    return replace(scene, load=load, analysis=analysis, rating=scene.rating_of_halves)


def _wanted(scene: DoubleHelicalScene, state: Shares, torques: Sequence[Sequence[float]]) -> list[list[float]]:
    """Torques of both halves [N mm] between which the shares lie, with more where these are uncertain.

    The mean and the largest torque of a half under each torque of both lie near one of them, so that its pressures and
    load factors are those of an analysis, and hardly interpolated.
    """
    radius = scene.mesh().pinion.base_radius
    uncertain = np.maximum(state.error, state.approach_error)
    wanted = []
    for half in range(len(HALVES)):
        own = [*torques[half]]
        for whole, forces, errors in zip(scene.torques, state.force[..., half], uncertain, strict=True):
            carried, even = radius * forces, 0.5 * whole
            low, mean, high = float(carried.min()), float(carried.mean()), float(carried.max())
            if high > max(own) + OUTSIDE * even:
                own.append(min(high * (1.0 + BEYOND), whole))
            if LEAST * even < low < min(own) - OUTSIDE * even:
                own.append(low * (1.0 - BEYOND))
            for torque in (high, mean):
                if torque > OUTSIDE * even:
                    _add(own, torque, NEAR * torque)
            if high > 0.0 and errors.max() > ACCURATE:
                for torque in (low, high, float(carried[errors.argmax()])):
                    _add(own, max(torque, LEAST * even), NEAR * even)
        wanted.append(sorted(own))
    return wanted


def _add(torques: list[float], asked: float, near: float) -> None:
    """Add a torque [N mm] that is not near others."""
    if all(abs(asked - other) > near for other in torques):
        torques.append(asked)


def largest_place(places: Sequence[Place]) -> Place:
    """Where the floating gear stands under the largest torque."""
    return max(places, key=lambda place: max(place.scene.torques))


def joined(
    kind: type[AnalysisResult], scene: DoubleHelicalScene, places: Sequence[Place], parts: Sequence[dict[str, Array]]
) -> xarray.Dataset:
    """Dataset of a kind of result, of its arrays at each place, with the warnings of both halves, which are given."""
    with noted_accuracy_warnings(given=False) as own:
        if (worst := max(float(place.state.error.max()) for place in places)) > WARNED:
            give_accuracy_warning(kinds.SHARES_OF_HALVES.sentence(error=worst))
        if (worst := max(float(place.state.approach_error.max()) for place in places)) > WARNED:
            give_accuracy_warning(kinds.DEFLECTION_OF_HALVES.sentence(error=worst))
        if (way := max(map(_shuttle, places))) > FACES * scene.narrow_half:
            give_accuracy_warning(kinds.SHUTTLES.sentence(gear=scene.geometry.floating, way=MICROMETRES * way))
        if not scene.floats_freely:
            for half, gear in scene.measured_halves:
                give_accuracy_warning(kinds.MEASURED_HALF.sentence(half=half, gear=gear))
    halves = [half for of_both in zip(*(place.halves for place in places), strict=True) for half in of_both]
    sentences = [*dict.fromkeys(sentence for half in halves for sentence in half.warnings), *own]
    for sentence in sentences:
        give_accuracy_warning(sentence)
    return kind.dataset_of(
        _under_all(kind, scene, parts),
        version=version("loaded_tca"),
        date=datetime.now(UTC).isoformat(timespec="seconds"),
        warnings="\n".join(sentences),
    )


def _shuttle(place: Place) -> float:
    """How far the floating gear is from its mean place over the positions at the most [mm]."""
    motion = place.state.motion
    return float(np.abs(motion - motion.mean(axis=1, keepdims=True)).max())


def _under_all(
    kind: type[AnalysisResult], scene: DoubleHelicalScene, parts: Sequence[dict[str, Array]]
) -> dict[str, Array]:
    """Arrays of a result, from those under the torques at each place."""
    torques = np.concatenate([part["torque"] for part in parts])
    rows = np.array([int(np.abs(torques - torque).argmin()) for torque in scene.torques])  # through N m
    return {
        name: np.concatenate([part[name] for part in parts])[rows] if "torque" in number.dims else parts[0][name]
        for name, number in kind.NUMBERS.items()
        if name in parts[0]
    }


def carried_by(place: Place) -> Array:
    """Torques of both halves (t, n, half) [N mm]."""
    return np.asarray(place.scene.mesh().pinion.base_radius * place.state.force)


def balance_arrays(place: Place) -> dict[str, Array]:
    """Arrays of any result at one place that follow from the balance."""
    scene, state = place.scene, place.state
    pair = gears_of(place.cycles[0])
    base = pair.base_radii
    width = 2.0 * scene.narrow_half
    axial = scene.axial_rate * state.force * np.asarray(SIGNS)
    share = state.force / state.force.sum(axis=-1, keepdims=True)
    toward = {"none": 0.0, "pinion": -1.0, "wheel": 1.0}[scene.geometry.floating]
    return {
        "torque": np.asarray(scene.torques),
        "pinion_angle": place.cycles[0].pinion_angle,
        "wheel_base_radius": np.float64(base[1]),
        "face_width": np.float64(width),
        "transmission_error": -pair.driving * state.approach / base[1],
        "mesh_stiffness": 1e-3 / (width * state.compliance),
        "torque_share": share,
        "axial_motion": toward * state.motion + 0.0,
        "axial_force": axial,
        "axial_force_left": axial.sum(axis=-1),
        "share_error": state.error,
        "share_factor": 2.0 * share.max(axis=(1, 2)),
        **{f"{gear}_bearing_force": forces[None] for gear, forces in place.bearing_forces.items()},
    }


def _arrays(place: Place) -> dict[str, Array]:
    """Arrays of the result at one place."""
    scene, cycles = place.scene, place.cycles
    arrays, carried = balance_arrays(place), carried_by(place)
    arrays["face_border"], load = _over_the_face(place, carried.mean(axis=1))
    mean = load.mean(axis=-1)
    factors = np.divide(load.max(axis=-1), mean, out=np.full_like(mean, math.nan), where=mean > 0.0)
    arrays |= {"face_load": load, "face_load_factor": factors}
    of_positions = {
        name: [largest_of_pairs(cycle, name) for cycle in cycles] for name in ("peak_pressure", "line_load")
    }
    for name, values in of_positions.items():
        arrays[name] = of_halves(cycles, values, carried)
    if scene.analysis.root_stress:
        tensions = [
            of_halves(cycles, [np.nan_to_num(cycle.root_tension[..., gear]) for cycle in cycles], carried).max(axis=1)
            for gear in range(2)
        ]
        arrays["root_tension"] = np.stack(tensions, axis=-1)
    return arrays


def _over_the_face(place: Place, carried: Array) -> tuple[Array, Array]:
    """Borders [mm] and loads [N/mm] of strips of the face (t, half, ...), under mean torques (t, half) of the halves.

    Straight between those of the torques of each half, over the torque.
    """
    scene, borders, loads = place.scene, [], []
    middle = 0.25 * (scene.pinion.face_width_mm + scene.geometry.gap_mm)
    for cycle, torques in zip(place.cycles, carried.T, strict=True):
        of_torques = [face_forces(cycle.gear_pair, cycle.path, positions) for positions in cycle.maps]
        strips = middle + of_torques[0][0]
        count = max(1, len(cycle.path) - 1)
        units = np.array([forces for _, forces in of_torques]) / (count * cycle.torque[:, None] * np.diff(strips))
        between = [np.interp(torques, cycle.torque, of_strip) for of_strip in units.T]
        borders.append(np.broadcast_to(strips, (len(torques), len(strips))))
        loads.append(torques[:, None] * np.stack(between, axis=-1))
    return np.stack(borders, axis=1), np.stack(loads, axis=1)


def largest_of_pairs(cycle: MeshCycle | Revolution, name: str) -> Array:
    """Largest value of the tooth pairs (torques, positions), 0 where nothing is loaded."""
    return np.asarray(np.nan_to_num(cycle.values(name)).max(axis=-1))


def of_halves(cycles: Sequence[MeshCycle | Revolution], values: Sequence[Array], torques: Array) -> Array:
    """Numbers between those (k, n) under the torques of the mesh cycles, 0 without load, at torques (t, n, half)."""
    return np.stack(
        [
            between_torques(cycle.torque, of_half, torques[..., half], known_at_zero=True)
            for half, (cycle, of_half) in enumerate(zip(cycles, values, strict=True))
        ],
        axis=-1,
    )
