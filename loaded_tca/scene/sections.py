"""The sections that scenes of every family share, key by key.

What ISO 6336 gives for the contact of a cylindrical pair, from its macro geometry alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, nan, prod
from typing import ClassVar

import numpy as np

from loaded_tca.arrays import GEARS, Indices
from loaded_tca.errors import InputError
from loaded_tca.flanks.modification import NO_POLYNOMIAL
from loaded_tca.flanks.rounding import LEAST_RADIUS
from loaded_tca.gears import CylindricalMesh
from loaded_tca.material import LARGEST_RATIO_IN_BENDING, SOFTEST, Material, contact_modulus
from loaded_tca.reference import iso6336
from loaded_tca.scene.flank_form import FlankForm
from loaded_tca.scene.keys import Choice, Line, List, Number, Whole, ZeroOr, above_zero, key
from loaded_tca.scene.pitch import Pitch
from loaded_tca.scene.section import Rule, Section, Tables, subsection
from loaded_tca.scene.shafts import ShaftSection
from loaded_tca.scene.supports import SupportSection

# ruff: noqa: N815  -- names are the keys of the file, units included; the calls make dataclass fields


AMOUNT_um = Number(0.0, 10000.0)
SLOPE_um = Number(-10000.0, 10000.0)
DIAMETER_mm = above_zero(100000.0)
RELIEF_FORM = Choice(("parabolic", "linear"))
START_deg = Number(0.0, 3600.0)
START_mm = Number(0.0, 100000.0)
END_mm = above_zero(10000.0)
ERROR_deg = Number(-10.0, 10.0)
ERROR_mm = Number(-1000.0, 1000.0)
TORQUE_Nm = Number(0.0, 1e9)
ROUNDING_mm = ZeroOr(Number(LEAST_RADIUS, 1000.0))
DRIVING = Choice(GEARS)
SENSE = Choice(("positive", "negative"))


def one_start(relief: str) -> Rule:
    """Rule: a relief starts at a diameter, a roll angle or a length, and one above zero has such a start."""
    mm, roll, length = (f"{relief}_start_{unit}" for unit in ("mm", "roll_deg", "length_mm"))

    def complain(diameter: float, angle: float, distance: float, amount: float) -> str | None:
        starts = ((mm, diameter), (roll, angle), (length, distance))
        given = [f"{name} = {start:g}" for name, start in starts if start > 0.0]
        if len(given) > 1:
            return f"found {' beside '.join(given)}; give one of them"
        if amount > 0.0 and not given:
            return f"missing or 0; {relief}_um = {amount:g} needs a value above 0, or {roll} or {length}"
        return None

    return Rule((mm, roll, length, f"{relief}_um"), complain)


def _end_lengths(length: float, amount: float, *own: float | None) -> str | None:
    """What is wrong where an end is relieved over no length; ``own`` are amount and length of lower and upper end."""
    for end, own_amount, own_length in zip(("lower", "upper"), own[::2], own[1::2], strict=True):
        name, removed = ("end_relief_um", amount) if own_amount is None else (f"end_relief_{end}_um", own_amount)
        if removed > 0.0 and length == 0.0 and own_length is None:
            return f"missing or 0; {name} = {removed:g} needs a value above 0, or end_relief_{end}_length_mm"
    return None


def below(smaller_key: str, larger_key: str, factor: float = 1.0) -> Rule:
    """Rule: a length stays below (a factor times) another one, where both are given."""
    limit = larger_key if factor == 1.0 else f"{factor:g} {larger_key}"

    def complain(smaller: float | None, larger: float | None) -> str | None:
        if smaller is not None and larger is not None and smaller > factor * larger:
            return f"found {smaller:g}; allowed up to {limit} = {factor * larger:g}"
        return None

    return Rule((smaller_key, larger_key), complain)


def end_reliefs_within(face_width_key: str) -> tuple[Rule, ...]:
    """Rules: no end relief of [pinion.modifications] is longer than half the face."""
    ends = ("", "lower_", "upper_")
    return tuple(below(f"modifications.end_relief_{end}length_mm", face_width_key, 0.5) for end in ends)


@dataclass(frozen=True, kw_only=True)
class Pair(Section):
    """[pair]: what both gears have in common; each family adds its keys."""

    type: str = key(Line(), "kind of gear pair")


@dataclass(frozen=True, kw_only=True)
class Modifications(Section):
    """[pinion.modifications], [wheel.modifications]: amounts of material removed along the normal."""

    lead_crowning_um: float = key(AMOUNT_um, "lead crowning C_beta, at the ends of the face", 0.0)
    lead_crowning_form: str = key(
        Choice(("parabolic", "circular", "logarithmic")), "form of the lead crowning", "parabolic"
    )
    end_relief_um: float = key(
        AMOUNT_um, "end relief C_betaI = C_betaII at both ends, parabolic; each end may have its own", 0.0
    )
    end_relief_length_mm: float = key(
        Number(0.0, 10000.0), "length of the end relief at each end, up to half the face width", 0.0
    )
    end_relief_lower_um: float | None = key(
        AMOUNT_um, "end relief C_betaI at the lower end (z < 0; toe)", None, "`end_relief_um`"
    )
    end_relief_lower_length_mm: float | None = key(END_mm, "its length", None, "`end_relief_length_mm`")
    end_relief_upper_um: float | None = key(
        AMOUNT_um, "end relief C_betaII at the upper end (z > 0; heel)", None, "`end_relief_um`"
    )
    end_relief_upper_length_mm: float | None = key(END_mm, "its length", None, "`end_relief_length_mm`")
    profile_crowning_um: float = key(AMOUNT_um, "profile crowning C_alpha, at the ends of the active profile", 0.0)
    tip_relief_um: float = key(AMOUNT_um, "tip relief C_alpha_a, at the tip; above 0 it needs its start", 0.0)
    tip_relief_start_mm: float = key(
        START_mm, "diameter at which the tip relief starts (bevel gears: 2 R_m sin u)", 0.0
    )
    tip_relief_start_roll_deg: float = key(
        START_deg,
        "or its roll angle, tan(alpha_y) (bevel gears: unwound arc over sin(delta_b); face-milled gears have none)",
        0.0,
    )
    tip_relief_start_length_mm: float = key(
        START_mm,
        "or its roll length, which counts on the path of contact from T1, on a wheel from T2 (bevel gears: the "
        "unwound arc times R_m; face-milled gears: from the form line at mid-face)",
        0.0,
    )
    tip_relief_form: str = key(RELIEF_FORM, "form of the tip relief over the roll length", "parabolic")
    root_relief_um: float = key(
        AMOUNT_um,
        "root relief C_alpha_f, at the start of the active profile; above 0 it needs its start",
        0.0,
    )
    root_relief_start_mm: float = key(START_mm, "diameter at which the root relief starts", 0.0)
    root_relief_start_roll_deg: float = key(START_deg, "or its roll angle", 0.0)
    root_relief_start_length_mm: float = key(START_mm, "or its roll length", 0.0)
    root_relief_form: str = key(RELIEF_FORM, "form of the root relief over the roll length", "parabolic")
    helix_slope_um: float = key(SLOPE_um, "helix slope C_H_beta over the face width; may be negative", 0.0)
    profile_slope_um: float = key(SLOPE_um, "profile slope C_H_alpha over the active profile; may be negative", 0.0)
    twist_um: float = key(
        SLOPE_um, "twist S_beta: helix slope at the tip less that at the start of the active profile; any sign", 0.0
    )
    polynomial_mm: tuple[float, ...] = key(
        List(Number(-100.0, 100.0), 6, 6),
        "a1 to a6 of a1 + a2 x + a3 y + a4 x y + a5 x^2 + a6 y^2 [mm]; x [mm] lengthwise from mid-face, y [mm] "
        "along the roll length (bevel gears: the unwound arc times R_m) from the middle of the active profile",
        NO_POLYNOMIAL,
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(
            (
                "end_relief_length_mm",
                "end_relief_um",
                "end_relief_lower_um",
                "end_relief_lower_length_mm",
                "end_relief_upper_um",
                "end_relief_upper_length_mm",
            ),
            _end_lengths,
        ),
        one_start("tip_relief"),
        one_start("root_relief"),
    )


@dataclass(frozen=True, kw_only=True)
class ElasticMaterial(Section):
    """[material], or [pinion.material] and [wheel.material]."""

    youngs_modulus_MPa: float = key(Number(SOFTEST, 1e7), "Young's modulus E")
    poisson_ratio: float = key(
        Number(0.0, 0.5), f"Poisson's ratio nu; up to {LARGEST_RATIO_IN_BENDING} where teeth bend"
    )
    max_pressure_MPa: float | None = key(
        above_zero(1e7), "pressure at which the surface yields (plastic cap)", None, "elastic"
    )
    conductivity_W_mK: float = key(above_zero(1000.0), "conductivity of heat, for flash temperatures", 50.0)
    density_kg_m3: float = key(above_zero(30000.0), "density, likewise", 7850.0)
    heat_capacity_J_kgK: float = key(above_zero(10000.0), "heat capacity, likewise", 484.0)


@dataclass(frozen=True, kw_only=True)
class Tooth(Section):
    """[[pinion.tooth]], [[wheel.tooth]]: flanks of one tooth, instead of those of the gear."""

    number: int = key(Whole(0, 9999), "number of the tooth, from 0")
    modifications: Modifications | None = subsection(
        Modifications, "material removed from its flanks, instead of that of the others", optional=True
    )
    flank: FlankForm | None = subsection(
        FlankForm, "how its flanks are described, instead of those of the others", optional=True
    )

    @property
    def own(self) -> dict[str, Section]:
        """What it has instead of the gear, by the names of the gear's sections."""
        sections = {"modifications": self.modifications, "flank": self.flank}
        return {name: section for name, section in sections.items() if section is not None}


@dataclass(frozen=True, kw_only=True)
class GearSection(Section):
    """[pinion], [wheel]: what each gear has of its own; each family adds its keys."""

    teeth: int = key(Whole(3, 10000), "number of teeth z")
    bore_diameter_mm: float | None = key(
        Number(0.0, 100000.0),
        "bore diameter, held rigid; 0: a solid gear, held by journals of 0.55 of the root diameter at both faces",
        None,
        "0.55 of the root diameter where teeth bend",
    )
    tip_rounding_mm: float = key(
        ROUNDING_mm, "radius of both tip edges of the teeth, up to 0.3 normal modules; 0: sharp", 0.0
    )
    side_rounding_mm: float = key(
        ROUNDING_mm, "radius of the edges at both ends of the face, up to 0.3 normal modules; 0: sharp", 0.0
    )
    roughness_Ra_um: float | None = key(
        above_zero(10.0),
        "arithmetic mean roughness Ra of the flanks, for tribology",
        None,
        "no film ratio, no friction",
    )
    modifications: Modifications = subsection(Modifications, "material removed from the flanks")
    flank: FlankForm = subsection(FlankForm, "how the flanks are described")
    material: ElasticMaterial | None = subsection(
        ElasticMaterial, "material of this gear, instead of the common one", optional=True
    )
    shaft: ShaftSection | None = subsection(
        ShaftSection, "the shaft that the gear sits on; without it, and without a support, rigid", optional=True
    )
    support: SupportSection | None = subsection(
        SupportSection, "how far the gear gives way as a whole; without it, rigid", optional=True
    )
    pitch: Pitch | None = subsection(
        Pitch, "where the teeth stand beside their nominal places, in whole revolutions", optional=True
    )
    tooth: tuple[Tooth, ...] | None = key(
        Tables(Tooth, 0, 10000),
        "teeth whose flanks differ from the others, in whole revolutions: `[[pinion.tooth]]`, `[[wheel.tooth]]` with "
        "`number`, from 0, and sections `modifications` or `flank` in place of those of the gear",
        None,
        "all teeth have the flanks of the gear",
    )

    @property
    def teeth_differ(self) -> bool:
        """Whether a tooth has a place or flanks of its own."""
        return bool(self.tooth) or (self.pitch is not None and self.pitch.is_given)

    def kinds_of_teeth(self) -> tuple[Indices, list[dict[str, Section]]]:
        """Kind of every tooth (teeth,), 0 where it is as the others, and the sections that each kind has of its own."""
        kinds: list[dict[str, Section]] = [{}]
        of_teeth = np.zeros(abs(self.teeth), dtype=int)
        for tooth in self.tooth or ():
            if tooth.own not in kinds:
                kinds.append(tooth.own)
            of_teeth[tooth.number] = kinds.index(tooth.own)
        return of_teeth, kinds


@dataclass(frozen=True, kw_only=True)
class Load(Section):
    """[load]: torque on the pinion."""

    pinion_torque_Nm: float = key(TORQUE_Nm, "magnitude of the torque on the pinion")


@dataclass(frozen=True, kw_only=True)
class Analysis(Section):
    """[analysis]: positions, grids and models."""

    positions: int = key(
        Whole(1, 10000), "mesh positions over one pitch, both ends included; 1 = the pitch point alone", 21
    )
    accuracy: float = key(
        Number(1e-6, 0.5), "wanted relative error of the peak pressure; chooses the grid unless cells do", 1e-2
    )
    cells: tuple[int, int] | None = key(
        List(Whole(4, 1000000), 2, 2),
        "cells across and along the contact; chooses the grid instead of the accuracy",
        None,
        "follows from accuracy",
    )
    tolerance: float = key(Number(1e-14, 0.1), "relative tolerance of the contact solver", 1e-6)
    free_edges: bool = key(
        Choice((False, True)),
        "whether the tips and face ends of the teeth deflect more than a half-space, by mirrored pressure",
        True,
    )
    load_sharing: bool = key(
        Choice((False, True)),
        "whether several tooth pairs share the torque; false: one carries all",
        True,
    )
    compliance: str = key(
        Choice(("contact", "contact+tooth")),
        "what deforms under load: the flanks, or the teeth and bodies, too",
        "contact+tooth",
    )
    edge_pressures: str = key(
        Choice(("largest", "all")),
        "which contacts at rounded edges have their pressure there found: those that can hold the largest one of their "
        "torque, or all",
        "largest",
    )
    root_stress: bool = key(
        Choice((False, True)),
        "whether the stress at the roots of the teeth is found, by finite elements of both gears",
        False,
    )
    torques_Nm: tuple[float, ...] | None = key(
        List(TORQUE_Nm, 1, 1000),
        "several pinion torques, all analysed instead of that of [load]",
        None,
        "the one of [load]",
    )

    @property
    def teeth_bend(self) -> bool:
        """Whether teeth and gear bodies give way, by finite elements, and not the flanks alone."""
        return self.compliance != "contact"

    @property
    def without_bodies(self) -> str:
        """Settings with which no gear body is meshed; empty where none is."""
        ways = ['analysis.compliance = "contact"'] if self.teeth_bend else []
        return " and ".join([*ways, *(["analysis.root_stress = false"] if self.root_stress else [])])


FITTED_SHIFTS = -0.5, 2.0
"""Sums of profile shifts for which the standard's series of the single stiffness is fitted."""


@dataclass(frozen=True, kw_only=True)
class ContactStandard:
    """Contact factors and stiffnesses of ISO 6336-1 and -2; NaN where they give none, as for bevel gears.

    Attributes
    ----------
    stress_per_root_torque : float [MPa/(N mm)^0.5]
        sigma_H0 over the root of the pinion torque.
    single_contact : (float, float)
        Z_B of the pinion, Z_D of the wheel.
    contact_ratio, helix_angle : float
        Z_eps, Z_beta.
    single_stiffness, mesh_stiffness : float [N/(mm um)]
        c' and c_gamma_alpha under more than 100 N/mm, of solid discs.
    largest_transverse_load_factor : float
        Upper bound of K_Halpha.
    """

    stress_per_root_torque: float = nan
    single_contact: tuple[float, float] = (nan, nan)
    contact_ratio: float = nan
    helix_angle: float = nan
    single_stiffness: float = nan
    mesh_stiffness: float = nan
    largest_transverse_load_factor: float = nan


def contact_standard(mesh: CylindricalMesh, width: float, materials: tuple[Material, Material]) -> ContactStandard:
    """Values of the standard for a pair with a common face width [mm]."""
    gear, alpha, beta = mesh.pinion, mesh.transverse_contact_ratio, mesh.overlap_ratio * width / mesh.common_face_width
    try:
        by_ratio = iso6336.contact_ratio_factor(alpha, beta)
        single_contact = _single_contact(mesh, beta)
    except InputError:  # a contact ratio up to 1 or from 4 on
        return ContactStandard()
    by_helix = iso6336.helix_angle_factor(gear.helix_angle)
    by_shape = iso6336.zone_factor(gear.transverse_pressure_angle, mesh.working_pressure_angle, gear.base_helix_angle)
    factors = prod((by_shape, iso6336.elasticity_factor(contact_modulus(*materials)), by_ratio, by_helix))
    diameter = 2.0 * gear.reference_radius
    single = _single_stiffness(mesh, materials)
    return ContactStandard(
        stress_per_root_torque=iso6336.nominal_contact_stress(
            2.0 / diameter, diameter, width, mesh.gear_ratio, factors
        ),
        single_contact=single_contact,
        contact_ratio=by_ratio,
        helix_angle=by_helix,
        single_stiffness=single,
        mesh_stiffness=iso6336.mesh_stiffness(single, alpha) if single > 0.0 else nan,
        largest_transverse_load_factor=iso6336.largest_transverse_load_factor(alpha, beta),
    )


def _single_contact(mesh: CylindricalMesh, overlap_ratio: float) -> tuple[float, float]:
    """Z_B and Z_D, of the ends of the path of contact that is used."""
    path, gears = mesh.path_of_contact, (mesh.pinion, mesh.wheel)
    ends = path.E, path.T2 - path.A
    first, second = (hypot(end, gear.base_radius) / gear.base_radius for gear, end in zip(gears, ends, strict=True))
    return iso6336.single_contact_factors(
        (mesh.pinion.teeth, mesh.wheel.teeth),
        (first, second),
        mesh.working_pressure_angle,
        mesh.transverse_contact_ratio,
        overlap_ratio,
    )


def _single_stiffness(mesh: CylindricalMesh, materials: tuple[Material, Material]) -> float:
    """c' of both materials; NaN for profile shifts beyond those that the standard has fitted."""
    gear, shifts = mesh.pinion, (mesh.pinion.profile_shift, mesh.wheel.profile_shift)
    if not FITTED_SHIFTS[0] <= sum(shifts) <= FITTED_SHIFTS[1]:
        return nan
    first, second = (
        iso6336.virtual_teeth(one.teeth, one.helix_angle, one.pressure_angle) for one in (mesh.pinion, mesh.wheel)
    )
    moduli = [material.youngs_modulus for material in materials]
    return iso6336.single_stiffness(
        iso6336.theoretical_single_stiffness((first, second), shifts),
        gear.helix_angle,
        basic_rack_factor=iso6336.basic_rack_factor(gear.dedendum_coefficient, gear.pressure_angle),
        youngs_modulus=2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]),
    )
