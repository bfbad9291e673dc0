"""Rating of a planetary stage: both meshes with K_gamma, planets with reversed bending, lives by gear.

Under a load spectrum both meshes are rated under its bins, with K_gamma and the stress ratios of planets at the torques
that were solved and between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, give_accuracy_warning
from loaded_tca.plain import plain
from loaded_tca.rating import Rating, rating_of
from loaded_tca.rating.cases import Cases, load_cases, problems_of_cases
from loaded_tca.rating.findings import of_all_bins
from loaded_tca.rating.inputs import Duty, by_itself, missing_sections
from loaded_tca.rating.lives import OfGears, lives_of
from loaded_tca.rating.quantities import CASE, NUMBERS, OF_SPECTRUM, SPECTRUM_NUMBERS
from loaded_tca.rating.rating import NOT_COUNTED, OfCases, all_figures, rows_of, shown_speeds
from loaded_tca.rating.roots import REVERSED
from loaded_tca.rating.spectrum import OF_PART_6, OfSpectrum, told_error
from loaded_tca.reference.iso6336_3_strength import mean_stress_sensitivities
from loaded_tca.results import MeshCycle
from loaded_tca.results.declared import Number
from loaded_tca.results.figure import Figures
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.rating import ANALYSIS, RatingSection, StrengthSection
from loaded_tca.scene.section import contents
from loaded_tca.scene.sections import Operation
from loaded_tca.stages.gears import StageGears
from loaded_tca.stages.sections import MEMBERS, RING_MESH, SUN_MESH, Stage, in_words_of, words_of
from loaded_tca.stages.warnings import WHOSE

if TYPE_CHECKING:
    import xarray

    from loaded_tca.stages.result import StageResult

MESHES = {"sun_mesh": SUN_MESH, "ring_mesh": RING_MESH}
"""Attribute of each mesh -> the gears that its pinion and wheel are."""
BENT_TO_AND_FRO = 0.7
"""Y_M of planets of materials without a mean stress sensitivity: allowable stresses of ISO 6336-5 times 0.7."""

_LEAST = "flank_safety", "root_safety", "local_flank_safety", "local_root_safety"
_LOADS = "K_A", "K_gamma"
STAGE_RATING_NUMBERS: dict[str, Number] = {
    "torque": Number(CASE, "N mm", "torque of the sun", column="sun_torque_Nm", label="sun torque"),
    **{name: NUMBERS[name] for name in (*_LOADS, "cycles")},
    **{name: NUMBERS[name] for name in (*_LEAST, "damage", "life_hours")},
}
"""Names in ``StageRating.dataset``: of a planet the worse one of both meshes counts."""
STAGE_SPECTRUM_NUMBERS: dict[str, Number] = {
    "torque": STAGE_RATING_NUMBERS["torque"],
    "sun_speed": Number(CASE, "rpm", "speed of the sun", label="sun speed"),
    **{name: SPECTRUM_NUMBERS[name] for name in ("hours", "reversed")},
    **{name: number for name, number in STAGE_RATING_NUMBERS.items() if name not in ("torque", "life_hours")},
    **{name: number for name, number in SPECTRUM_NUMBERS.items() if number.dims == OF_SPECTRUM},
    "equivalent_torque": SPECTRUM_NUMBERS["equivalent_torque"].changed(text="equivalent sun torque"),
}
"""The same of a load spectrum, whose bins are the cases."""


@dataclass(frozen=True, eq=False, repr=False)
class StageRating(OfCases):
    """Safeties and lives of a stage; every name of ``STAGE_RATING_NUMBERS`` is an attribute.

    Attributes
    ----------
    result : StageResult
    sun_mesh, ring_mesh : Rating
        Both meshes under an even share of the torque, with every factor: sun and planet, planet and ring.
    dataset : xarray.Dataset
        Numbers with their units, over ``case``, each of a ``torque`` of the sun, and ``gear``: sun, planet, ring.
    """

    TITLE: ClassVar = "Rating of a planetary stage"
    SUBJECT: ClassVar = "stage"
    NUMBERS: ClassVar = STAGE_RATING_NUMBERS
    FIGURES: ClassVar = all_figures(STAGE_RATING_NUMBERS, MEMBERS)
    MEMBERS: ClassVar = MEMBERS

    result: StageResult
    sun_mesh: Rating
    ring_mesh: Rating
    dataset: xarray.Dataset
    cases: Cases
    endurances: OfGears

    def __repr__(self) -> str:
        flank, root = self.flank_safety.min(), self.root_safety.min()
        name = type(self).__name__
        return f"{name}({len(self.torque)} torques, least S_H {plain(flank, 3)}, least S_F {plain(root, 3)})"

    @property
    def stage(self) -> Stage:
        """Stage of the result."""
        return self.result.stage

    @property
    def required(self) -> RatingSection:
        """What the stage requires."""
        wanted = self.stage.rating
        assert wanted is not None  # refused before
        return wanted

    @property
    def life_required(self) -> float:
        """The life that is required [h]."""
        return self.cases.life_hours

    @property
    def scope(self) -> str:
        """Speeds, hours and what is required, in words."""
        wanted, ratio = self.required, speed_ratio(self.stage)
        return (
            f"{self._standards}, sun at {shown_speeds(self.cases.speed)}, times {plain(ratio)} against the carrier, "
            f"for {plain(self.life_required, 6)} h; required S_H {plain(wanted.required_flank_safety, 6)}, S_F "
            f"{plain(wanted.required_root_safety, 6)}; {' | '.join(self.MEMBERS)}"
        )

    @property
    def _standards(self) -> str:
        return "ISO 6336-2:2019 and -3:2006"

    def figure_arrays(self) -> dict[str, Array]:
        """Return the figures (torque,) of the gears, and of the meshes, which begin with their names."""
        columns = super().figure_arrays()
        for mesh, gears in MESHES.items():
            of_mesh: Rating = getattr(self, mesh)
            columns |= {f"{mesh}_{_renamed(name, gears)}": values for name, values in of_mesh.figure_arrays().items()}
        return columns

    def rows(self, figures: Sequence[Figures]) -> list[tuple[str, ...]]:
        """Lines of the summary: of the gears, then of both meshes with all factors."""
        rows = rows_of(self, MEMBERS, self.modes, figures)
        for (mesh, gears), whose in zip(MESHES.items(), WHOSE, strict=True):
            rating: Rating = getattr(self, mesh)
            of_mesh = {name: f"{mesh}_{_renamed(name, gears)}" for name in rating.figure_arrays()}
            own = [{name: row[head] for name, head in of_mesh.items()} for row in figures]
            rows.append((f"{gears['pinion']} and {gears['wheel']}, under {whose}", *("" for _ in figures)))
            rows += [(f"  {words_of(gears, label)}", *cells) for label, *cells in rating.rows(own)]
        return rows

    def notes(self) -> tuple[str, ...]:
        """What lies outside the ranges of the standard, which safeties are too small, what does not count."""
        sentences = [
            f"{gears['pinion']} and {gears['wheel']}: {words_of(gears, note)}"
            for mesh, gears in MESHES.items()
            for note in getattr(self, mesh).notes()
            if note != NOT_COUNTED
        ]
        return (*sentences, NOT_COUNTED)


def _renamed(name: str, gears: dict[str, str]) -> str:
    """Name of a figure of a mesh with the gear of the stage."""
    first, _, rest = name.partition("_")
    return f"{gears[first]}_{rest}" if first in gears else name


class StageSpectrumRating(OfSpectrum, StageRating):
    """Safeties and lives of a stage under a load spectrum: cases are its bins, as of :class:`SpectrumRating`.

    ``miner_sum``, ``life_hours``, ``spectrum_safety``, ``equivalent_torque`` (of the sun) and ``interpolation_error``
    are over gears and kinds of failure. Of a planet that flank and that fillet count which have the larger damage, and
    the smaller safety of both; in reversed bins a fillet is drawn by the other mesh.
    """

    NUMBERS: ClassVar = STAGE_SPECTRUM_NUMBERS
    FIGURES: ClassVar = all_figures(STAGE_SPECTRUM_NUMBERS, MEMBERS)

    @property
    def _standards(self) -> str:
        return f"{super()._standards}, {OF_PART_6.format(len(self.torque))}"

    def notes(self) -> tuple[str, ...]:
        """What decides, what of the spectrum is assumed, which lives are too short, what does not count."""
        remarks = [
            [words_of(gears, remark) for remark in getattr(self, mesh).remarks] for mesh, gears in MESHES.items()
        ]
        common = [remark for remark in remarks[0] if remark in remarks[1]]
        of_meshes = [
            f"{gears['pinion']} and {gears['wheel']}: {remark}"
            for gears, some in zip(MESHES.values(), remarks, strict=True)
            for remark in some
            if remark not in common
        ]
        return (*of_all_bins(self), *of_meshes, *common, *self._short(), NOT_COUNTED)


def speed_ratio(stage: Stage) -> float:
    """Speed of the sun against the carrier over its own: the ring stands still, z_r/(z_s + z_r)."""
    sun, _, ring = stage.teeth
    return ring / (sun + ring)


def stage_rating_of(result: StageResult, *, warn: bool = True) -> StageRating:
    """Rating of a stage; see :meth:`loaded_tca.stages.StageResult.rating`.

    Parameters
    ----------
    result : StageResult
    warn : bool
        Whether accuracy warnings are given.

    Returns
    -------
    StageRating
    """
    stage, torques = result.stage, np.asarray(result.torque)
    _require_sections(stage, float(torques.max()))
    assert stage.rating is not None
    speed = None if stage.operation is None else stage.operation.sun_speed_rpm
    cases = load_cases(stage.load, stage.rating.life_hours, speed, torques)
    given = stage.rating.mesh_load_factor
    factor = result.mesh_load_factor if given == ANALYSIS else np.full(len(torques), float(given))
    meshes = _of_meshes(result, cases, factor)
    gears = StageGears.of(*meshes, cases)
    arrays = _of_gears(*meshes) | {"torque": cases.torque} | lives_of(cases, gears.endurances, _turns(*meshes))
    kind: type[StageRating] = StageRating
    sentences = _warned(meshes)
    if cases.is_spectrum:
        kind = StageSpectrumRating
        error = gears.interpolation_errors(*meshes)
        arrays |= {name: meshes[0].values(name) for name in ("hours", "reversed")}
        arrays |= {"sun_speed": cases.speed, "interpolation_error": error}
        arrays["spectrum_safety"][1] = gears.planet_safety
        sentences += told_error(error, len(torques))
    for sentence in sentences if warn else ():
        give_accuracy_warning(sentence)
    about: dict[str, Any] = {"version": meshes[0].version, "warnings": "\n".join(sentences)}
    dataset = kind.dataset_of(arrays, {"gear": MEMBERS, "mode": [*gears.endurances]}, **about)
    return kind(result, *meshes, dataset, cases, gears.endurances)


def _warned(meshes: tuple[Rating, Rating]) -> list[str]:
    """Warnings of both meshes in the words of the stage; that of interpolation is told of the gears."""
    of_interpolation = kinds.SPECTRUM_BETWEEN, kinds.SPECTRUM_UNKNOWN
    sentences = (
        words_of(gears, sentence)
        for gears, rating in zip(MESHES.values(), meshes, strict=True)
        for sentence in rating.warnings or ()
        if not any(kind.words in sentence for kind in of_interpolation)
    )
    return list(dict.fromkeys(sentences))


def _require_sections(stage: Stage, largest: float) -> None:
    """Refuse a stage without what its rating needs, with every problem; ``largest``: torque that was solved [N mm]."""
    strengths = {f"{gear}.strength": getattr(stage, gear).strength for gear in MEMBERS}
    problems = missing_sections({**strengths, "rating": stage.rating, "lubricant": stage.lubricant})
    by_ratio = {name: one for name, one in strengths.items() if name != "planet.strength"}
    if problems := [*problems, *problems_of_cases(stage.load, stage.operation, by_ratio, largest)]:
        raise InputError(problems)


def _of_meshes(result: StageResult, cases: Cases, factor: Array) -> tuple[Rating, Rating]:
    """Ratings of both meshes under even shares of the torques of load cases; K_gamma (t,) under those solved."""
    stage, planets = result.stage, len(result.stage.stage.angles)
    ratio, (sun, planet, _) = speed_ratio(stage), stage.teeth
    widths = [mesh.common_face_width for mesh in stage.meshes]
    assert stage.planet.strength is not None
    bent, mean = _reversed(stage.planet.strength, REVERSED * min(widths) / max(widths))
    scenes = (stage.sun_scene, (stage.sun.strength, bent)), (stage.ring_scene, (bent, stage.ring.strength))
    shares = [_EvenShare(cycle, stage) for cycle in (result.sun_mesh, result.ring_mesh)]
    own = [
        replace(cases, torque=share.of(cases.torque), speed=cases.speed * turns)
        for share, turns in zip(shares, (ratio, ratio * sun / planet), strict=True)
    ]
    cycles = [
        share.under(np.asarray(result.torque), _rated_scene(stage, scene, strengths, of_mesh))
        for share, (scene, strengths), of_mesh in zip(shares, scenes, own, strict=True)
    ]
    at_sun, at_ring = _computed_ratios(*cycles) if stage.analysis.root_stress else (None, None)
    of_sun, of_ring = (("sun", 1.0 / share.of(np.ones(1)).item()) for share in shares)
    others = by_itself(stage.load)
    duties = (
        Duty(factor, (planets, 1), False, (None, mean), (None, at_sun), own[0], of_sun, other_flanks=others),
        Duty(factor, (1, planets), True, (mean, None), (at_ring, None), own[1], of_ring, other_flanks=others),
    )
    ratings = []
    for gears, cycle, duty in zip(MESHES.values(), cycles, duties, strict=True):
        with in_words_of(gears):
            ratings.append(rating_of(cycle, duty=duty, warn=False))
    first, second = ratings
    return first, second


def _reversed(strength: StrengthSection, ratio: float) -> tuple[StrengthSection, float | None]:
    """Strength of planets under a stress ratio, and Y_M where the standard has no mean stress sensitivity."""
    try:
        mean_stress_sensitivities(strength.kind_of_material)
    except InputError:
        return strength, BENT_TO_AND_FRO
    return replace(strength, root_stress_ratio=min(ratio, strength.root_stress_ratio)), None


def _computed_ratios(of_sun: MeshCycle, of_ring: MeshCycle) -> tuple[Array, Array]:
    """Smallest over largest root stress (t,) of a planet's fillets on the side of the sun's and of the ring's mesh.

    A fillet is drawn by the mesh on its flank, and pressed by that on the other flank.
    """
    tension = [np.nanmax(cycle.root_tension[..., place], axis=1) for cycle, place in ((of_sun, 1), (of_ring, 0))]
    compression = [
        np.nanmin(cycle.root_compression[..., place], axis=1) for cycle, place in ((of_sun, 1), (of_ring, 0))
    ]
    return compression[1] / tension[0], compression[0] / tension[1]


@dataclass(frozen=True, eq=False)
class _EvenShare:
    """Torques of the pinion of a mesh under even shares of those of the sun."""

    cycle: MeshCycle
    stage: Stage

    def of(self, torques: Array) -> Array:
        """Of torques of the sun (n,) [N mm]."""
        radii = self.cycle.gear_pair.base_radii[0] / self.stage.meshes[0].pinion.base_radius
        return torques / len(self.stage.stage.angles) * radii

    def under(self, torques: Array, scene: CylindricalScene) -> MeshCycle:
        """Mesh cycle under the even shares of torques of the sun (t,) alone, of which it has those solved."""
        even, solved = self.of(torques), self.cycle.dataset["torque"]
        places = np.abs(solved.values / even[:, None] - 1.0).argmin(axis=1)
        analysis = replace(self.cycle.scene.analysis, torques_Nm=tuple((1e-3 * even).tolist()))
        # even shares as load cases have them: those solved went through N m
        under = self.cycle.dataset.isel(torque=places).assign_coords(torque=solved[places].copy(data=even))
        return replace(
            self.cycle,
            scene=replace(scene, analysis=analysis),
            dataset=under,
            maps=tuple(self.cycle.maps[place] for place in places),
            states=None,
        )


def _rated_scene(
    stage: Stage,
    scene: CylindricalScene,
    strengths: tuple[StrengthSection | None, StrengthSection | None],
    cases: Cases,
) -> CylindricalScene:
    """Scene of a mesh that says what its rating needs under its load cases, whose bins it does not have."""
    assert stage.rating is not None
    values = {name: value for name, value in contents(stage.rating).items() if name != "mesh_load_factor"}
    operation = Operation(pinion_speed_rpm=float(cases.speed.max()))
    if stage.operation is not None:
        factors = {name: getattr(stage.operation, name) for name in ("application_factor", "dynamic_factor")}
        operation = replace(operation, **factors)
    return replace(
        scene,
        pinion=replace(scene.pinion, strength=strengths[0]),
        wheel=replace(scene.wheel, strength=strengths[1]),
        operation=operation,
        lubricant=stage.lubricant,
        rating=RatingSection(**values | {"life_hours": cases.life_hours}),
    )


def _turns(of_sun: Rating, of_ring: Rating) -> Array:
    """Load cycles of sun, planet and ring in an hour of each load case (c, 3)."""
    at_sun, at_ring = of_sun.inputs.cycles_per_hour, of_ring.inputs.cycles_per_hour
    return np.stack([at_sun[:, 0], at_sun[:, 1], at_ring[:, 1]], axis=1)


def _of_gears(of_sun: Rating, of_ring: Rating) -> dict[str, Array]:
    """Numbers of load cases of sun, planet and ring (c, 3); of planets the smaller safety of both meshes."""

    def joined(name: str) -> Array:
        first, second = of_sun.values(name), of_ring.values(name)
        return np.stack([first[:, 0], np.minimum(first[:, 1], second[:, 0]), second[:, 1]], axis=1)

    least = {name: joined(name) for name in (*_LEAST, "cycles") if of_sun.has(name)}
    return least | {name: of_sun.values(name) for name in _LOADS}
