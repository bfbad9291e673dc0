"""The sections that scenes of every family share, key by key.

Last those on how a pair runs and what oil it has: the defaults of tribology, of which an analysis takes nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from loaded_tca.arrays import GEARS, Indices
from loaded_tca.flanks.modification import NO_POLYNOMIAL
from loaded_tca.flanks.rounding import LEAST_RADIUS
from loaded_tca.material import LARGEST_RATIO_IN_BENDING, SOFTEST
from loaded_tca.plain import plain
from loaded_tca.scene.flank_form import FlankForm
from loaded_tca.scene.keys import Choice, Either, Line, List, Number, Whole, ZeroOr, above_zero, key
from loaded_tca.scene.load import TORQUE_Nm
from loaded_tca.scene.pitch import Pitch
from loaded_tca.scene.rating import StrengthSection
from loaded_tca.scene.section import Rule, Section, Tables, subsection
from loaded_tca.scene.shafts import ShaftSection, SupportSection

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
ROUNDING_mm = ZeroOr(Number(LEAST_RADIUS, 1000.0))
DRIVING = Choice(GEARS)
SENSE = Choice(("positive", "negative"))


def one_start(relief: str) -> Rule:
    """Rule: a relief starts at a diameter, a roll angle or a length, and one above zero has such a start."""
    mm, roll, length = (f"{relief}_start_{unit}" for unit in ("mm", "roll_deg", "length_mm"))

    def complain(diameter: float, angle: float, distance: float, amount: float) -> str | None:
        starts = ((mm, diameter), (roll, angle), (length, distance))
        given = [f"{name} = {plain(start, 6)}" for name, start in starts if start > 0.0]
        if len(given) > 1:
            return f"found {' beside '.join(given)}; give one of them"
        if amount > 0.0 and not given:
            return f"missing or 0; {relief}_um = {plain(amount, 6)} needs a value above 0, or {roll} or {length}"
        return None

    return Rule((mm, roll, length, f"{relief}_um"), complain)


def _end_lengths(length: float, amount: float, *own: float | None) -> str | None:
    """What is wrong where an end is relieved over no length; ``own`` are amount and length of lower and upper end."""
    for end, own_amount, own_length in zip(("lower", "upper"), own[::2], own[1::2], strict=True):
        name, removed = ("end_relief_um", amount) if own_amount is None else (f"end_relief_{end}_um", own_amount)
        if removed > 0.0 and length == 0.0 and own_length is None:
            return f"missing or 0; {name} = {plain(removed, 6)} needs a value above 0, or end_relief_{end}_length_mm"
    return None


def below(smaller_key: str, larger_key: str, factor: float = 1.0) -> Rule:
    """Rule: a length stays below (a factor times) another one, where both are given."""
    limit = larger_key if factor == 1.0 else f"{plain(factor, 6)} {larger_key}"

    def complain(smaller: float | None, larger: float | None) -> str | None:
        if smaller is not None and larger is not None and smaller > factor * larger:
            return f"found {plain(smaller, 6)}; allowed up to {limit} = {plain(factor * larger, 6)}"
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
    end_relief_lower_length_mm: float | None = key(END_mm, "length of this relief", None, "`end_relief_length_mm`")
    end_relief_upper_um: float | None = key(
        AMOUNT_um, "end relief C_betaII at the upper end (z > 0; heel)", None, "`end_relief_um`"
    )
    end_relief_upper_length_mm: float | None = key(END_mm, "length of this relief", None, "`end_relief_length_mm`")
    profile_crowning_um: float = key(AMOUNT_um, "profile crowning C_alpha, at the ends of the active profile", 0.0)
    tip_relief_um: float = key(AMOUNT_um, "tip relief C_alpha_a, at the tip; above 0 it needs its start", 0.0)
    tip_relief_start_mm: float = key(
        START_mm, "diameter at which the tip relief starts (bevel gears: 2 R_m sin u)", 0.0
    )
    tip_relief_start_roll_deg: float = key(
        START_deg,
        "or roll angle of this start, tan(alpha_y) (bevel gears: unwound arc over sin(delta_b); face-milled gears: "
        "none)",
        0.0,
    )
    tip_relief_start_length_mm: float = key(
        START_mm,
        "or roll length of this start, counted on the path of contact from T1, on a wheel from T2 (bevel gears: the "
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
    root_relief_start_roll_deg: float = key(START_deg, "or roll angle of this start", 0.0)
    root_relief_start_length_mm: float = key(START_mm, "or roll length of this start", 0.0)
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
        of_one_unit=False,
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
    density_kg_m3: float = key(above_zero(30000.0), "density, for flash temperatures", 7850.0)
    heat_capacity_J_kgK: float = key(above_zero(10000.0), "heat capacity, for flash temperatures", 484.0)


@dataclass(frozen=True, kw_only=True)
class Tooth(Section):
    """[[pinion.tooth]], [[wheel.tooth]]: flanks of one tooth, instead of those of the gear."""

    number: int = key(Whole(0, 9999), "number of the tooth, from 0")
    modifications: Modifications | None = subsection(
        Modifications, "material removed from the flanks of this tooth, in place of that of the gear", optional=True
    )
    flank: FlankForm | None = subsection(
        FlankForm, "how the flanks of this tooth are described, in place of those of the gear", optional=True
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
        "where teeth bend, the shaft diameter at mid-face, up to 0.8 root diameters; else 0.55 root diameters",
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
        ShaftSection, "the shaft of the gear; without shaft and support: rigid", optional=True
    )
    support: SupportSection | None = subsection(
        SupportSection, "how far the gear moves as a whole under load; without this section: rigid", optional=True
    )
    pitch: Pitch | None = subsection(Pitch, "pitch deviations of the teeth, for whole revolutions", optional=True)
    strength: StrengthSection | None = subsection(
        StrengthSection, "what the gear withstands, for rating", optional=True
    )
    tooth: tuple[Tooth, ...] | None = key(
        Tables(Tooth, 0, 10000),
        "teeth whose flanks differ from the others, for whole revolutions: `[[pinion.tooth]]`, `[[wheel.tooth]]` with "
        "`number`, from 0, and sections `modifications` or `flank` in place of those of the gear",
        None,
        "all teeth have the flanks of the gear",
    )

    @property
    def teeth_differ(self) -> bool:
        """Whether a tooth has another place, or other flanks, than another tooth."""
        if self.tooth and np.ptp(self.kinds_of_teeth()[0]):
            return True
        return self.pitch is not None and self.pitch.is_given

    @property
    def index_deviations(self) -> tuple[str, ...]:
        """Keys of the pitch deviations that are of one side of the teeth, in the section of the gear."""
        return () if self.pitch is None else tuple(f"pitch.{key}" for key in self.pitch.given_index)

    @property
    def measured_flanks(self) -> tuple[str, ...]:
        """Keys of the flanks that are measured, those of single teeth too, in the section of the gear."""
        of_teeth = ((f"tooth[{n}].flank", tooth.flank) for n, tooth in enumerate(self.tooth or ()))
        flanks = (("flank", self.flank), *of_teeth)
        return tuple(f"{key}.form" for key, flank in flanks if flank is not None and flank.form == "measured")

    def kinds_of_teeth(self) -> tuple[Indices, list[dict[str, Section]]]:
        """Kind of every tooth (teeth,), 0 where it is as the gear, and the sections that each kind has of its own."""
        kinds: list[dict[str, Section]] = [{}]
        of_teeth = np.zeros(abs(self.teeth), dtype=int)
        for tooth in self.tooth or ():
            if all(getattr(self, name) == section for name, section in tooth.own.items()):
                continue
            if tooth.own not in kinds:
                kinds.append(tooth.own)
            of_teeth[tooth.number] = kinds.index(tooth.own)
        return of_teeth, kinds


@dataclass(frozen=True, kw_only=True)
class Analysis(Section):
    """[analysis]: positions, grids and models."""

    positions: int = key(
        Whole(1, 10000), "mesh positions over one pitch, both ends included; 1 = the pitch point alone", 21
    )
    accuracy: float = key(
        Number(1e-6, 0.5), "wanted relative error of the peak pressure; chooses the grid unless `cells` are given", 1e-2
    )
    cells: tuple[int, int] | None = key(
        List(Whole(4, 1000000), 2, 2),
        "cells across and along the contact, instead of a grid by `accuracy`",
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
        "whether several tooth pairs share the torque; false: one tooth pair carries all of it",
        True,
    )
    compliance: str = key(
        Choice(("contact", "contact+tooth")),
        "what deforms under load: the flanks, or the teeth and bodies, too",
        "contact+tooth",
    )
    edge_pressures: str = key(
        Choice(("largest", "all")),
        "contacts whose pressure at rounded edges is computed: those that can have the largest under their torque, or "
        "all",
        "largest",
    )
    root_stress: bool = key(
        Choice((False, True)),
        "whether root stress is computed, by finite elements of both gears",
        False,
    )
    torques_Nm: tuple[float, ...] | None = key(
        List(TORQUE_Nm, 1, 1000),
        "several pinion torques, analysed instead of the torque of [load] or of the torques chosen for its spectrum",
        None,
        "the torque of [load], or those of its spectrum",
    )

    @property
    def teeth_bend(self) -> bool:
        """Whether teeth and gear bodies give way, by finite elements, and not the flanks alone."""
        return self.compliance != "contact"

    @property
    def bending(self) -> str:
        """Whether teeth bend, in words."""
        return "teeth bend" if self.teeth_bend else "teeth do not bend"

    @property
    def without_bodies(self) -> str:
        """Settings with which no gear body is meshed; empty where none is."""
        ways = ['analysis.compliance = "contact"'] if self.teeth_bend else []
        return " and ".join([*ways, *(["analysis.root_stress = false"] if self.root_stress else [])])


FACTOR = Number(1.0, 100.0)
BASES = "mineral", "polyalphaolefin", "polyglycol", "water-soluble polyglycol", "ester"
"""Kinds of base oils; ``loaded_tca.tribology`` has what each sets."""
TEMPERATURE_C = Number(-50.0, 200.0)


@dataclass(frozen=True, kw_only=True)
class Operation(Section):
    """[operation]: how the pair runs, for tribology and rating; the analysis takes nothing of it."""

    pinion_speed_rpm: float = key(above_zero(1e6), "speed of the pinion")
    application_factor: float = key(FACTOR, "application factor K_A", 1.0)
    dynamic_factor: float = key(FACTOR, "dynamic factor K_v", 1.0)


@dataclass(frozen=True, kw_only=True)
class LubricantSection(Section):
    """[lubricant]: the oil, and what tribology is to take of it; the analysis takes nothing of it."""

    viscosity_40_mm2_s: float = key(
        Number(1.0, 1e5, above=True), "kinematic viscosity at 40 °C, which is all that ratings take"
    )
    viscosity_100_mm2_s: float | None = key(
        Number(1.0, 1e5, above=True), "kinematic viscosity at 100 °C", None, "tribology has no oil"
    )
    density_15_kg_m3: float = key(Number(600.0, 1400.0), "density at 15 °C", 890.0)
    base: str = key(Choice(BASES), "kind of the base oil", "mineral")
    oil_temperature_C: float | None = key(
        TEMPERATURE_C, "temperature of the oil that comes to the mesh", None, "as `viscosity_100_mm2_s`"
    )
    pressure_viscosity_38_mm2_N: float | None = key(
        above_zero(1.0), "pressure-viscosity coefficient at 38 °C", None, "by the base"
    )
    lubricant_factor: float | None = key(
        Number(0.1, 3.0), "lubricant factor X_L of coefficients of friction", None, "by the base"
    )
    bulk_temperature_C: float | None = key(
        Number(-50.0, 500.0), "bulk temperature of the teeth", None, "computed, of cylindrical gears"
    )
    supply: str = key(Choice(("dip", "spray", "submerged")), "how the oil comes to the gears", "dip")
    friction: str | float | None = key(
        Either((Choice(("mean", "local", "Xu-Kahraman")), Number(0.0, 1.0))),
        "coefficient of friction: mean of ISO/TS 6336-22 (cylindrical gears), of each slice, or a number",
        None,
        "mean, of cylindrical gears",
    )
    scuffing_load_stage: int | None = key(
        Whole(1, 14), "load stage of the oil in the FZG test A/8.3/90", None, "no safety against scuffing"
    )
    permissible_film_ratio: float | None = key(
        above_zero(100.0), "permissible film ratio lambda_GFP", None, "no safety against micropitting"
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(
            ("viscosity_100_mm2_s", "viscosity_40_mm2_s"),
            lambda hot, cold: (
                None
                if hot is None or hot < cold
                else f"found {plain(hot, 6)}; allowed below viscosity_40_mm2_s = {plain(cold, 6)}: oils thin with heat"
            ),
        ),
    )
