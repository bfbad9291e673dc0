"""What a rating takes of a result and its scene, and what it refuses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalMesh
from loaded_tca.rating.cases import Cases, cases_of, problems_of_cases
from loaded_tca.rating.solved import SolvedLoads, solved_loads
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.rating import RatingSection, StrengthSection
from loaded_tca.scene.sections import Operation

if TYPE_CHECKING:
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.scene.sections import LubricantSection
    from loaded_tca.scene.standards import ContactStandard

FEWEST = 5
"""Positions over a pitch: of fewer the largest pressure and K_Hbeta miss much of the mesh."""
COVERED = "rating covers one operating point of external cylindrical pairs"


@dataclass(frozen=True, eq=False)
class RatingInputs:
    """A result with the sections of its scene that a rating needs.

    Attributes
    ----------
    result : MeshCycle
    scene : CylindricalScene
    mesh : CylindricalMesh
    strengths : (StrengthSection, StrengthSection)
        Of pinion and wheel.
    rating : RatingSection
    operation : Operation
    lubricant : LubricantSection
    cases : Cases
    solved : SolvedLoads
        Under the torques of the result.
    standard : ContactStandard
        Contact factors and stiffnesses of the standard.
    """

    result: CycleNumbers
    scene: CylindricalScene
    mesh: CylindricalMesh
    strengths: tuple[StrengthSection, StrengthSection]
    rating: RatingSection
    operation: Operation
    lubricant: LubricantSection
    cases: Cases
    solved: SolvedLoads
    standard: ContactStandard

    @cached_property
    def loads(self) -> SolvedLoads:
        """Under the torques of the cases."""
        return self.solved.at(self.cases.factor_torque)

    @property
    def torque(self) -> Array:
        """Pinion torques (c,) [N mm]."""
        return self.cases.torque

    @property
    def load(self) -> Array:
        """F_t K_A/b (c,) [N/mm], at the reference circle, for load factors."""
        force = self.cases.factor_torque / self.mesh.pinion.reference_radius
        return np.asarray(force * self.operation.application_factor / self.mesh.common_face_width)

    @property
    def velocity(self) -> Array:
        """Velocity at the reference circle (c,) [m/s]."""
        return np.asarray(2e-3 * pi * self.mesh.pinion.reference_radius * self.cases.speed / 60.0)

    @property
    def cycles_per_hour(self) -> Array:
        """Load cycles of pinion and wheel in an hour of each case (c, 2)."""
        ratio = self.mesh.pinion.teeth / self.mesh.wheel.teeth
        return 60.0 * self.cases.speed[:, None] * np.array([1.0, ratio])

    @property
    def cycles(self) -> Array:
        """Load cycles N_L of pinion and wheel under each case in the life that is required (c, 2)."""
        return self.cycles_per_hour * self.cases.hours[:, None]

    @property
    def virtual_contact_ratio(self) -> float:
        """eps_alpha_n."""
        return self.mesh.transverse_contact_ratio / cos(self.mesh.pinion.base_helix_angle) ** 2


def inputs_of(result: CycleNumbers) -> RatingInputs:
    """Sections of the scene of a result that a rating needs.

    Raises
    ------
    InputError
        With everything that is missing or not covered.
    """
    scene = result.scene
    if not isinstance(scene, CylindricalScene):
        raise InputError(f'pair.type: "{scene.geometry.type}"; {COVERED}')
    if scene.wheel.teeth < 0:
        raise InputError(f"wheel.teeth: {scene.wheel.teeth}, a ring; {COVERED}")
    no_limits = "missing; nothing is rated without allowable stresses: give material, or kind with its stresses"
    needed = {
        "pinion.strength": (scene.pinion.strength, no_limits),
        "wheel.strength": (scene.wheel.strength, no_limits),
        "rating": (scene.rating, "missing; it has the required safeties and the hours"),
        "lubricant": (scene.lubricant, "missing; the strength of flanks depends on viscosity_40_mm2_s"),
    }
    problems = [f"{name}: {words}" for name, (section, words) in needed.items() if section is None]
    analysis, torques = scene.analysis, np.asarray(result.torque)
    if not analysis.load_sharing:
        problems.append("analysis.load_sharing: false; K_Hbeta is that of a mesh: set it to true and run the scene")
    if len(result.path) < FEWEST:
        problems.append(f"analysis.positions: {len(result.path)}; a rating takes {FEWEST} or more: run the scene again")
    if not (torques > 0.0).all():
        problems.append("pinion torque: 0 N m; a rating takes torques above 0")
    problems += problems_of_cases(scene, float(torques.max()))
    problems += [
        f"{name}: ISO 6336 has no {what} of this pair: {why}" for name, what, holds, why in _outside(scene) if not holds
    ]
    if problems:
        raise InputError(problems)
    sections: Any = tuple(section for section, _ in needed.values())
    pinion, wheel, rating, lubricant = sections
    cases = cases_of(scene, torques)
    operation = scene.operation or Operation(pinion_speed_rpm=float(cases.speed.max()))
    loads, standard = solved_loads(result), scene.contact_standard
    return RatingInputs(
        result, scene, scene.mesh(), (pinion, wheel), rating, operation, lubricant, cases, loads, standard
    )


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
