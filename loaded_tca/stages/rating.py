"""Rating of a planetary stage: both meshes with K_gamma, planets with reversed bending, lives by gear."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, give_accuracy_warning
from loaded_tca.plain import plain
from loaded_tca.rating import Rating, rating_of
from loaded_tca.rating.inputs import Duty, missing_sections
from loaded_tca.rating.quantities import CASE, NUMBERS
from loaded_tca.rating.rating import NOT_COUNTED, OfCases, all_figures, rows_of
from loaded_tca.rating.roots import REVERSED
from loaded_tca.reference.iso6336_3_strength import mean_stress_sensitivities
from loaded_tca.results import MeshCycle
from loaded_tca.results.declared import Number
from loaded_tca.results.figure import Figures
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.rating import ANALYSIS, RatingSection, StrengthSection
from loaded_tca.scene.section import contents
from loaded_tca.scene.sections import Operation
from loaded_tca.stages.sections import RING_MESH, SUN_MESH, Stage, in_words_of, words_of
from loaded_tca.stages.warnings import WHOSE

if TYPE_CHECKING:
    import xarray

    from loaded_tca.stages.result import StageResult

MEMBERS = "sun", "planet", "ring"
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

    def __repr__(self) -> str:
        flank, root = self.flank_safety.min(), self.root_safety.min()
        return f"StageRating({len(self.torque)} torques, least S_H {plain(flank, 3)}, least S_F {plain(root, 3)})"

    @property
    def stage(self) -> Stage:
        """Stage of the result."""
        return self.result.stage

    @property
    def modes(self) -> tuple[str, ...]:
        """Kinds of failure that are rated."""
        return self.sun_mesh.modes

    @property
    def scope(self) -> str:
        """Speeds, hours and what is required, in words."""
        wanted, operation = self.stage.rating, self.stage.operation
        assert wanted is not None  # refused before
        assert wanted.life_hours is not None
        assert operation is not None
        return (
            f"ISO 6336-2:2019 and -3:2006, sun at {plain(operation.sun_speed_rpm, 6)} rpm, "
            f"{plain(relative_speed(self.stage))} against the carrier, for {plain(wanted.life_hours, 6)} h; required "
            f"S_H {plain(wanted.required_flank_safety, 6)}, S_F {plain(wanted.required_root_safety, 6)}; "
            "sun | planet | ring"
        )

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
            rows.append((f"{gears['pinion']} and {gears['wheel']}, under {whose}", *("" for _ in figures)))
            rows += [(f"  {words_of(gears, label)}", *cells) for label, *cells in rating.rows(rating.key_figures())]
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


def relative_speed(stage: Stage) -> float:
    """Speed of the sun against the carrier [rpm]: the ring stands still, n_sun z_r/(z_s + z_r)."""
    assert stage.operation is not None
    sun, _, ring = stage.teeth
    return stage.operation.sun_speed_rpm * ring / (sun + ring)


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
    stage = result.stage
    _require_sections(stage)
    assert stage.rating is not None
    given = stage.rating.mesh_load_factor
    factor = result.mesh_load_factor if given == ANALYSIS else np.full(len(result.torque), float(given))
    ratings = _of_meshes(result, factor)
    warned = (
        words_of(gears, sentence)
        for gears, rating in zip(MESHES.values(), ratings, strict=True)
        for sentence in rating.warnings or ()
    )
    sentences = list(dict.fromkeys(warned))
    for sentence in sentences if warn else ():
        give_accuracy_warning(sentence, stacklevel=3)
    arrays = _of_gears(*ratings) | {"torque": np.asarray(result.torque)}
    about: dict[str, Any] = {"version": ratings[0].version, "warnings": "\n".join(sentences)}
    dataset = StageRating.dataset_of(arrays, **about).assign_coords(gear=[*MEMBERS], mode=[*ratings[0].modes])
    return StageRating(result, *ratings, dataset)


def _require_sections(stage: Stage) -> None:
    """Refuse a stage without a section that its rating needs, with every one."""
    sections = {f"{gear}.strength": getattr(stage, gear).strength for gear in MEMBERS}
    sections |= {"rating": stage.rating, "operation": stage.operation, "lubricant": stage.lubricant}
    if problems := missing_sections(sections, operation="strength, cycles and K_v depend on sun_speed_rpm"):
        raise InputError(problems)


def _of_meshes(result: StageResult, factor: Array) -> tuple[Rating, Rating]:
    """Ratings of both meshes under even shares of the torques."""
    stage, planets = result.stage, len(result.stage.stage.angles)
    speed, (sun, planet, _) = relative_speed(stage), stage.teeth
    widths = [mesh.common_face_width for mesh in stage.meshes]
    ratio = REVERSED * min(widths) / max(widths)
    assert stage.planet.strength is not None
    bent, mean = _reversed(stage.planet.strength, ratio)
    cycles = (
        _under_even_shares(result, result.sun_mesh, stage.sun_scene, speed, (stage.sun.strength, bent)),
        _under_even_shares(
            result, result.ring_mesh, stage.ring_scene, speed * sun / planet, (bent, stage.ring.strength)
        ),
    )
    at_sun, at_ring = _computed_ratios(*cycles) if stage.analysis.root_stress else (None, None)
    with in_words_of(SUN_MESH):
        of_sun = rating_of(
            cycles[0],
            duty=Duty(factor, (planets, 1), mean_stress_factors=(None, mean), stress_ratios=(None, at_sun)),
            warn=False,
        )
    with in_words_of(RING_MESH):
        of_ring = rating_of(
            cycles[1],
            duty=Duty(factor, (1, planets), True, mean_stress_factors=(mean, None), stress_ratios=(at_ring, None)),
            warn=False,
        )
    return of_sun, of_ring


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


def _under_even_shares(
    result: StageResult,
    cycle: MeshCycle,
    scene: CylindricalScene,
    speed: float,
    strengths: tuple[StrengthSection | None, StrengthSection | None],
) -> MeshCycle:
    """Mesh cycle under the even shares of all torques alone, whose scene says what a rating needs."""
    stage, planets = result.stage, len(result.stage.stage.angles)
    radii = cycle.gear_pair.base_radii[0] / stage.meshes[0].pinion.base_radius
    even = np.asarray(result.torque) / planets * radii
    torques = cycle.dataset["torque"].values
    places = np.abs(torques / even[:, None] - 1.0).argmin(axis=1)
    assert stage.rating is not None
    assert stage.operation is not None
    values = {name: value for name, value in contents(stage.rating).items() if name != "mesh_load_factor"}
    operation = Operation(
        pinion_speed_rpm=speed,
        application_factor=stage.operation.application_factor,
        dynamic_factor=stage.operation.dynamic_factor,
    )
    analysis = replace(cycle.scene.analysis, torques_Nm=tuple((1e-3 * torques[places]).tolist()))
    rated = replace(
        scene,
        pinion=replace(scene.pinion, strength=strengths[0]),
        wheel=replace(scene.wheel, strength=strengths[1]),
        operation=operation,
        lubricant=stage.lubricant,
        rating=RatingSection(**values),
        analysis=analysis,
    )
    return replace(
        cycle,
        scene=rated,
        dataset=cycle.dataset.isel(torque=places),
        maps=tuple(cycle.maps[place] for place in places),
        states=None,
    )


def _of_gears(of_sun: Rating, of_ring: Rating) -> dict[str, Array]:
    """Numbers of sun, planet and ring (t, 3, ...); of the planet the worse one of both meshes."""

    def joined(name: str, worse: Callable[[Array, Array], Array] = np.minimum) -> Array:
        first, second = of_sun.values(name), of_ring.values(name)
        return np.stack([first[:, 0], worse(first[:, 1], second[:, 0]), second[:, 1]], axis=1)

    least = {name: joined(name) for name in (*_LEAST, "life_hours", "cycles") if of_sun.has(name)}
    return least | {"damage": joined("damage", np.maximum)} | {name: of_sun.values(name) for name in _LOADS}
