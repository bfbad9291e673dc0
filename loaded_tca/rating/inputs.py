"""What a rating takes of a result and its scene, and what it refuses."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import cos, pi
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from loaded_tca.arrays import GEARS, Array, Mask
from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalMesh, InternalMesh
from loaded_tca.plain import apart
from loaded_tca.rating.cases import Cases, cases_of, problems_of_cases
from loaded_tca.rating.solved import SolvedLoads, solved_factors
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.rating import RatingSection, StrengthSection
from loaded_tca.scene.sections import Operation

if TYPE_CHECKING:
    from loaded_tca.reference.iso6336_3 import RootSection
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.scene import Scene
    from loaded_tca.scene.load import AnyLoad
    from loaded_tca.scene.sections import LubricantSection
    from loaded_tca.scene.standards import ContactStandard

FEWEST = 5
"""Positions over a pitch: of fewer the largest pressure and K_Hbeta miss much of the mesh."""
MOST_ROWS = 8
"""Of bins that follow each other, which a sentence names one by one."""
NEEDED = {
    "strength": "a rating needs allowable stresses: give material, or kind with its stresses",
    "rating": "this section has the required safeties and the hours",
    "lubricant": "the strength of flanks depends on viscosity_40_mm2_s",
}
"""Sections of any rating, and why they are."""
BY_COAST_SIDE = (
    "'loaded-tca rating DIR --coast OTHER' rates both sides, with the result of the coast side in OTHER, and "
    "'loaded-tca report DIR --coast OTHER' reports it"
)
"""How the flanks that reversed bins of a pair load are rated."""


def by_itself(load: AnyLoad) -> str:
    """How those of a stage and of a double helical pair are rated, whose ratings take one side alone."""
    return f"to rate them, analyse with {load.CASE.OTHER_WAY} changed and reversed swapped in every bin"


@dataclass(frozen=True, eq=False)
class Duty:
    """How the gears of a pair are loaded beside its torque: those of a planetary stage by several mates.

    Attributes
    ----------
    mesh_load_factor : array (t,) or float
        K_gamma under the torques of the result.
    meshes : (int, int)
        Mates that pinion and wheel have at once, each of which loads every tooth once in a turn against the carrier.
    wheel_is_held : bool
        Whether the wheel does not swing, as a ring in a housing.
    mean_stress_factors : (float or None, float or None)
        Y_M of pinion and wheel, where it does not follow from a stress ratio.
    stress_ratios : (array (t,) or None, array (t,) or None)
        Smallest over largest computed root stress of a turn under these, where other mates add to those of the mesh.
    cases : Cases or None
        Those of the mesh; None: those of its scene.
    torque_of : (str, float)
        The gear whose torque sentences name, and that torque over the one of the pinion.
    case_mesh_load_factor, case_face_load_factor : array (c,), optional
        K_gamma and K_Hbeta under the cases; default: as the torques of the result have them, and as the scene asks.
    other_flanks : str
        What a note says of how the other flanks are rated, which reversed bins load.
    parts : sequence of (MeshCycle, array (k,))
        Results of the mesh, each with the torques [N mm] that it stands for, where none stands for all; empty: the
        result stands for all. No torque twice.
    """

    mesh_load_factor: Array | float = 1.0
    meshes: tuple[int, int] = (1, 1)
    wheel_is_held: bool = False
    mean_stress_factors: tuple[float | None, float | None] = (None, None)
    stress_ratios: tuple[Array | None, Array | None] = (None, None)
    cases: Cases | None = None
    torque_of: tuple[str, float] = ("pinion", 1.0)
    case_mesh_load_factor: Array | None = None
    case_face_load_factor: Array | None = None
    other_flanks: str = BY_COAST_SIDE
    parts: Sequence[tuple[CycleNumbers, Array]] = ()


@dataclass(frozen=True, eq=False)
class CommonInputs(ABC):
    """A result with the sections of its scene that a rating needs, whatever the kind of gears.

    Attributes
    ----------
    result : MeshCycle
    scene : Scene
    strengths : (StrengthSection, StrengthSection)
        Of pinion and wheel.
    rating : RatingSection
    operation : Operation
    lubricant : LubricantSection
    cases : Cases
    solved : SolvedLoads
        Under the torques of the result, or those of the parts of the duty.
    duty : Duty
    nearest : SolvedLoads, optional
        Of parts of the duty, under the same torques: as solved under the nearest one that each part has.
    """

    result: CycleNumbers
    scene: Scene
    strengths: tuple[StrengthSection, StrengthSection]
    rating: RatingSection
    operation: Operation
    lubricant: LubricantSection
    cases: Cases
    solved: SolvedLoads
    duty: Duty = field(default=Duty(), kw_only=True)
    nearest: SolvedLoads | None = field(default=None, kw_only=True)
    of_bevels: ClassVar[bool] = False
    """Whether ISO 10300 counts, not ISO 6336."""

    @cached_property
    def loads(self) -> SolvedLoads:
        """Under the torques of the cases; one mate of all carries the whole torque at the most."""
        loads = self.solved.at(self.cases.factor_torque)
        if self.duty.case_mesh_load_factor is not None:
            return replace(loads, mesh_load_factor=self.duty.case_mesh_load_factor)
        most = max(float(self.solved.mesh_load_factor.max()), *self.duty.meshes)
        return replace(loads, mesh_load_factor=np.minimum(loads.mesh_load_factor, most))

    @property
    def torque(self) -> Array:
        """Pinion torques (c,) [N mm]."""
        return self.cases.torque

    def torque_in_words(self, *torques: float, gear: bool = False) -> str:
        """Pinion torques [N mm] in words, as those of the gear whose they are; named where it is not the pinion."""
        name, ratio = self.duty.torque_of
        texts = apart([1e-3 * ratio * torque for torque in torques])
        return f"{', '.join(texts)} N m" + (f" at the {name}" if gear or name != "pinion" else "")

    def cases_in_words(self, some: Mask) -> str:
        """Which cases (c,) these are: bins by their numbers, where they are few, or torques."""
        if not self.cases.is_spectrum:
            return f"under {self.torque_in_words(*self.torque[some].tolist())}"
        places = np.flatnonzero(some)
        rows = np.split(1 + places, 1 + np.flatnonzero(np.diff(places) > 1))
        if len(rows) > MOST_ROWS:
            return f"{len(places)} of {len(some)} bins"
        names = [f"{row[0]}" if len(row) == 1 else f"{row[0]} to {row[-1]}" for row in rows]
        return f"bin{'' if len(places) == 1 else 's'} {', '.join(names)} of {len(some)}"

    def notes_of_cases(self, notes: Sequence[str], noted: Sequence[Mask]) -> tuple[str, ...]:
        """Notes with the cases (c,) of which each is true; those of idle bins alone are left out."""
        concerned = [(note, some & (self.torque > 0.0)) for note, some in zip(notes, noted, strict=True)]
        return tuple(f"{note} ({self.cases_in_words(some)})" for note, some in concerned if some.any())

    @property
    @abstractmethod
    def normal_module(self) -> float:
        """Of both gears, of bevel gears in the middle of the face [mm]."""

    @property
    @abstractmethod
    def velocity(self) -> Array:
        """At the circle that the standard takes (c,) [m/s]."""

    @abstractmethod
    def root_section(self, place: int) -> RootSection:
        """Critical section of the pinion, 0, or the wheel, 1, after the standard."""

    @abstractmethod
    def of_scene(self, scene: Any, **changes: Any) -> Self:
        """The same of another scene of the same gears, with changes of other fields."""

    @property
    def cycles_per_hour(self) -> Array:
        """Load cycles of pinion and wheel in an hour of each case (c, 2)."""
        per_turn = np.array([1.0, self.scene.wheel_cycles])
        return 60.0 * self.cases.speed[:, None] * per_turn * self.duty.meshes

    @property
    def cycles(self) -> Array:
        """Load cycles N_L of pinion and wheel under each case in the life that is required (c, 2)."""
        return self.cycles_per_hour * self.cases.hours[:, None]


@dataclass(frozen=True, eq=False)
class RatingInputs(CommonInputs):
    """What a rating after ISO 6336 takes besides.

    Attributes
    ----------
    mesh : CylindricalMesh or InternalMesh
    """

    scene: CylindricalScene
    mesh: CylindricalMesh | InternalMesh

    @property
    def normal_module(self) -> float:
        """m_n [mm]."""
        return self.mesh.pinion.normal_module

    def root_section(self, place: int) -> RootSection:
        """Critical section of the pinion, 0, or the wheel, 1, after ISO 6336-3."""
        section = self.scene.root_sections[place]
        assert section is not None  # refused before
        return section

    def of_scene(self, scene: Any, **changes: Any) -> Self:
        """The same of another scene of the same gears, with changes of other fields."""
        return replace(self, scene=scene, mesh=scene.mesh(), **changes)

    @cached_property
    def standard(self) -> ContactStandard:
        """Contact factors and stiffnesses of the standard."""
        return self.scene.contact_standard

    @property
    def load(self) -> Array:
        """F_t K_A K_gamma/b (c,) [N/mm], at the reference circle, for load factors."""
        force = self.loads.mesh_load_factor * self.cases.factor_torque / self.mesh.pinion.reference_radius
        return np.asarray(force * self.operation.application_factor / self.mesh.common_face_width)

    @property
    def velocity(self) -> Array:
        """Velocity at the reference circle (c,) [m/s]."""
        return np.asarray(2e-3 * pi * self.mesh.pinion.reference_radius * self.cases.speed / 60.0)

    @property
    def virtual_contact_ratio(self) -> float:
        """eps_alpha_n."""
        return self.mesh.transverse_contact_ratio / cos(self.mesh.pinion.base_helix_angle) ** 2


def inputs_of(result: CycleNumbers, duty: Duty = Duty()) -> RatingInputs:
    """Sections of the scene of a result that a rating needs, with the load factors of the analysis.

    Raises
    ------
    InputError
        With everything that is missing or not covered.
    """
    scene = result.scene
    if not isinstance(scene, CylindricalScene):
        raise InputError(f'pair.type: "{scene.geometry.type}"; ISO 6336 is for cylindrical pairs')
    outside = [
        f"{name}: ISO 6336 gives no {what} for this pair: {why}"
        for name, what, holds, why in _outside(scene)
        if not holds
    ]
    return RatingInputs(result, scene, **common_inputs(result, outside, duty), mesh=scene.mesh(), duty=duty)


def common_inputs(result: CycleNumbers, outside: Sequence[str] = (), duty: Duty = Duty()) -> dict[str, Any]:
    """What every rating takes of a result and the sections of its scene: fields of ``CommonInputs`` but the first two.

    Raises
    ------
    InputError
        With everything that is missing or wrong, and what lies ``outside`` the standard.
    """
    scene = result.scene
    strengths = {f"{gear}.strength": getattr(scene, gear).strength for gear in GEARS}
    problems = missing_sections({**strengths, "rating": scene.rating, "lubricant": scene.lubricant})
    analysis, torques = scene.analysis, np.asarray(result.torque)
    if not analysis.load_sharing:
        problems.append(
            "analysis.load_sharing: false; a rating needs K_Hbeta of the whole mesh: set it to true and run the scene"
        )
    if len(result.path) < FEWEST:
        problems.append(f"analysis.positions: {len(result.path)}; a rating takes {FEWEST} or more: run the scene again")
    if not (torques > 0.0).all():
        problems.append("pinion torque: 0 N m; a rating takes torques above 0")
    if duty.cases is None:
        problems += problems_of_cases(scene.load, scene.operation, strengths, float(torques.max()))
    if problems := [*problems, *outside]:
        raise InputError(problems)
    cases = duty.cases or cases_of(scene, torques)
    return {
        "strengths": (scene.pinion.strength, scene.wheel.strength),
        "rating": scene.rating,
        "operation": scene.operation or Operation(pinion_speed_rpm=float(cases.speed.max())),
        "lubricant": scene.lubricant,
        "cases": cases,
        "solved": solved_factors(result, duty),
    }


def missing_sections(sections: Mapping[str, object], **reasons: str) -> list[str]:
    """Which sections of a rating are missing, and why they are needed; ``reasons`` of others than ``NEEDED``."""
    why = {**NEEDED, **reasons}
    return [f"{name}: missing; {why[name.rpartition('.')[2]]}" for name, one in sections.items() if one is None]


def _outside(scene: CylindricalScene) -> list[tuple[str, str, bool, str]]:
    """What the standard may not have for a pair: key, what, whether it has it, why not."""
    standard, rating = scene.contact_standard, scene.rating
    stiffness = bool(standard.single_stiffness > 0.0)
    shifts = "profile shifts beyond its series; give a number"
    needs = {
        "rating.dynamic_factor": rating is not None and rating.dynamic_factor == "method B",
        "rating.transverse_load_factor": rating is not None and rating.transverse_load_factor == "method B",
    }
    sections = zip(GEARS, scene.root_sections, strict=True)
    return [
        ("pair", "contact stress", bool(standard.stress_per_root_torque > 0.0), "a contact ratio below 1 or from 4 on"),
        *((key, "stiffness c'", stiffness or not needed, shifts) for key, needed in needs.items()),
        *(
            (gear, "critical section", section is not None, "no root stress after ISO 6336-3")
            for gear, section in sections
        ),
    ]
