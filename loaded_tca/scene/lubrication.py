"""Sections on how a pair runs and what oil it has: the defaults of tribology, of which an analysis takes nothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from loaded_tca.scene.keys import Choice, Either, Number, Whole, above_zero, key
from loaded_tca.scene.section import Rule, Section

# ruff: noqa: N815  -- names are the keys of the file, units included; the calls make dataclass fields

FACTOR = Number(1.0, 100.0)
BASES = "mineral", "polyalphaolefin", "polyglycol", "water-soluble polyglycol", "ester"
"""Kinds of base oils; ``loaded_tca.tribology`` has what each sets."""
TEMPERATURE_C = Number(-50.0, 200.0)


@dataclass(frozen=True, kw_only=True)
class Operation(Section):
    """[operation]: how the pair runs, for tribology; the analysis takes nothing of it."""

    pinion_speed_rpm: float = key(above_zero(1e6), "speed of the pinion")
    application_factor: float = key(FACTOR, "application factor K_A", 1.0)
    dynamic_factor: float = key(FACTOR, "dynamic factor K_v", 1.0)


@dataclass(frozen=True, kw_only=True)
class LubricantSection(Section):
    """[lubricant]: the oil, and what tribology is to take of it; the analysis takes nothing of it."""

    viscosity_40_mm2_s: float = key(Number(1.0, 1e5, above=True), "kinematic viscosity at 40 °C")
    viscosity_100_mm2_s: float = key(Number(1.0, 1e5, above=True), "kinematic viscosity at 100 °C")
    density_15_kg_m3: float = key(Number(600.0, 1400.0), "density at 15 °C", 890.0)
    base: str = key(Choice(BASES), "kind of the base oil", "mineral")
    oil_temperature_C: float = key(TEMPERATURE_C, "temperature of the oil that comes to the mesh")
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
                if hot < cold
                else f"found {hot:g}; allowed below viscosity_40_mm2_s = {cold:g}: oils thin with heat"
            ),
        ),
    )
