"""What rating takes of a scene: materials and surfaces of both gears, what is required, which factors are taken."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, ClassVar

from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_3_strength import mean_stress_sensitivities, slip_layer
from loaded_tca.reference.iso6336_5 import (
    KINDS,
    MATERIALS,
    QUALITIES,
    AllowableStresses,
    allowable_stresses,
    converted_hardness,
    material_kind,
    named_material,
)
from loaded_tca.reference.iso6336_6 import LONG_LIFE
from loaded_tca.scene.keys import Choice, Either, Number, Whole, above_zero, key
from loaded_tca.scene.section import Rule, Section, rule

if TYPE_CHECKING:
    from loaded_tca.scene.model import Scene

# ruff: noqa: N815  -- names are the keys of the file, units included; the calls make dataclass fields

SCALES = "HV", "HBW", "HRC"
HARDNESS = tuple(f"hardness_{scale}" for scale in SCALES)
STRESS_MPa = above_zero(1e4)
ROUGHNESS_um = above_zero(1000.0)
LOAD_FACTOR = Number(1.0, 100.0)
METHOD_B, ANALYSIS, GIVEN = "method B", "analysis", "given"


def _kind(material: str | None, kind: str | None) -> str:
    return MATERIALS[material][0] if material else str(kind)


def _of_table(
    material: str | None, kind: str | None, quality: str, hardness: float | None, scale: str | None
) -> AllowableStresses:
    """Allowable stress numbers of ISO 6336-5."""
    if material:
        return named_material(material, quality, hardness=hardness, scale=scale)
    if hardness is None:
        raise InputError("hardness: not given")
    return allowable_stresses(str(kind), quality, hardness, scale=scale)


def _no_hardness(
    key: str, value: str | None, other: str | None, quality: str, stress: float | None, *hardness: float | None
) -> str | None:
    """What is wrong where the stresses of a material, or of a kind, depend on a hardness that is not given."""
    if stress is not None or any(one is not None for one in hardness) or value is None or other is not None:
        return None
    try:
        material, kind = (value, None) if key == "material" else (None, value)
        _of_table(material, kind, quality, None, None)
    except InputError:
        keys = ", ".join(HARDNESS)
        return f'found "{value}", whose stresses depend on the hardness; give one of {keys}'
    return None


def _off_line(
    scale: str, given: float | None, material: str | None, kind: str | None, quality: str, stress: float | None
) -> str | None:
    """What is wrong with a hardness that the stresses are taken of."""
    if given is None or stress is not None or (material is None) == (kind is None):
        return None
    try:
        _of_table(material, kind, quality, given, scale)
    except InputError as error:
        return "found " + "; ".join(error.problems).removeprefix("hardness: ")
    return None


def _refused(call: Callable[..., object], material: str | None, kind: str | None, value: float | None) -> str | None:
    """What a factor of root strength says against a kind of material and a value."""
    if (material is None) == (kind is None):
        return None
    try:
        call(_kind(material, kind), value)
    except InputError as error:
        return "; ".join(error.problems).partition(": ")[2]
    return None


def _slips(value: float | None, material: str | None, kind: str | None) -> str | None:
    return _refused(slip_layer, material, kind, value)


def _reverses(ratio: float, material: str | None, kind: str | None) -> str | None:
    problem = None if ratio == 0.0 else _refused(lambda each, _: mean_stress_sensitivities(each), material, kind, None)
    return problem and f"found {plain(ratio, 6)}, {problem.partition(';')[0]}; allowed 0"


@dataclass(frozen=True, kw_only=True)
class StrengthSection(Section):
    """[pinion.strength], [wheel.strength]: what a gear withstands, for rating; the analysis takes nothing of it."""

    material: str | None = key(
        Choice(tuple(MATERIALS)), "name of a steel or cast iron in its usual heat treatment", None, "`kind`"
    )
    kind: str | None = key(
        Choice(tuple(KINDS)), "kind of material of ISO 6336-5, in the place of a name", None, "that of `material`"
    )
    quality: str = key(Choice(QUALITIES), "quality of material and heat treatment of ISO 6336-5", "MQ")
    hardness_HV: float | None = key(
        above_zero(1500.0), "surface hardness after Vickers; or one of the other scales", None,
        "for steels by name: 700 HV case-hardened, 750 HV nitriding",
    )  # fmt: skip
    hardness_HBW: float | None = key(above_zero(1500.0), "or after Brinell", None, "as above")
    hardness_HRC: float | None = key(above_zero(100.0), "or after Rockwell", None, "as above")
    sigma_H_lim_MPa: float | None = key(
        STRESS_MPa, "allowable stress number of flanks; give sigma_F_lim_MPa, too", None, "that of ISO 6336-5"
    )
    sigma_F_lim_MPa: float | None = key(
        STRESS_MPa, "nominal allowable stress number of roots; give sigma_H_lim_MPa, too", None, "that of ISO 6336-5"
    )
    proof_stress_MPa: float | None = key(
        STRESS_MPa, "yield point, proof stress or, of grey cast iron, tensile strength; counts at the root", None,
        "none; hardened and nitrided teeth need none",
    )  # fmt: skip
    flank_Rz_um: float = key(ROUGHNESS_um, "roughness Rz of the flanks after running in, about 6 Ra")
    root_Rz_um: float = key(ROUGHNESS_um, "roughness Rz of the fillets")
    root_stress_ratio: float = key(
        Number(-1.2, 0.0),
        "smallest over largest root stress of a load cycle, for Y_M: 0 one direction, -1 reversed",
        0.0,
    )

    alternatives: ClassVar[tuple[str, ...]] = HARDNESS
    rules: ClassVar[tuple[Rule, ...]] = (
        rule(
            ("material", "kind"),
            lambda material, kind: (material is None) != (kind is None),
            "missing, or found beside kind; give material or kind",
        ),
        rule(
            HARDNESS,
            lambda *given: sum(one is not None for one in given) <= 1,
            f"found beside another scale; give one of {', '.join(HARDNESS)}",
        ),
        rule(
            ("sigma_H_lim_MPa", "sigma_F_lim_MPa"),
            lambda flank, root: (flank is None) == (root is None),
            "found one of sigma_H_lim_MPa and sigma_F_lim_MPa; give both, or none for the stresses of ISO 6336-5",
        ),
        *(
            Rule((*names, "quality", "sigma_H_lim_MPa", *HARDNESS), partial(_no_hardness, names[0]))
            for names in (("material", "kind"), ("kind", "material"))
        ),
        *(
            Rule((f"hardness_{scale}", "material", "kind", "quality", "sigma_H_lim_MPa"), partial(_off_line, scale))
            for scale in SCALES
        ),
        Rule(("proof_stress_MPa", "material", "kind"), _slips),
        Rule(("root_stress_ratio", "material", "kind"), _reverses),
    )

    @property
    def kind_of_material(self) -> str:
        """Kind of ISO 6336-5, given or of the named material."""
        return _kind(self.material, self.kind)

    @cached_property
    def limits(self) -> tuple[float, float]:
        """sigma_H_lim and sigma_F_lim, given or of ISO 6336-5 [MPa]."""
        if self.sigma_H_lim_MPa is not None and self.sigma_F_lim_MPa is not None:
            return self.sigma_H_lim_MPa, self.sigma_F_lim_MPa
        hardness, scale = self._hardness or (None, None)
        found = _of_table(self.material, self.kind, self.quality, hardness, scale)
        return found.contact, found.nominal_root

    @property
    def brinell(self) -> float | None:
        """Hardness in HBW of through-hardened and structural steels, which Z_W depends on; None of others."""
        if self._hardness is None or material_kind(self.kind_of_material).family not in ("V", "St"):
            return None
        return converted_hardness(*self._hardness, "HBW")

    @property
    def _hardness(self) -> tuple[float, str] | None:
        values = zip((self.hardness_HV, self.hardness_HBW, self.hardness_HRC), SCALES, strict=True)
        return next(((value, scale) for value, scale in values if value is not None), None)


@dataclass(frozen=True, kw_only=True)
class RatingSection(Section):
    """[rating]: what is required of the pair, and which factors are taken; the analysis takes nothing of it."""

    required_flank_safety: float = key(above_zero(100.0), "required safety against pitting S_Hmin")
    required_root_safety: float = key(above_zero(100.0), "required safety against tooth breakage S_Fmin")
    life_hours: float | None = key(
        above_zero(1e8),
        "required life: hours under each torque alone, or of a load spectrum, whose bins repeat over it",
        None,
        "the hours of the load cases together",
    )
    dynamic_factor: str = key(
        Choice((METHOD_B, GIVEN)), "dynamic factor K_v of ISO 6336-1, or operation.dynamic_factor", METHOD_B
    )
    face_load_factor: str | float = key(
        Either((Choice((ANALYSIS,)), LOAD_FACTOR)), "face load factor K_Hbeta: of the analysis, or a number", ANALYSIS
    )
    transverse_load_factor: str | float = key(
        Either((Choice((METHOD_B, ANALYSIS)), LOAD_FACTOR)),
        "transverse load factors K_Halpha and K_Falpha: of ISO 6336-1, of the analysis, or a number for both",
        METHOD_B,
    )
    tolerance_class: int | None = key(
        Whole(1, 11),
        "tolerance class of both gears after ISO 1328-1:2013, of bevel gears accuracy grade from 2 on of "
        "ISO 17485:2006, for factors by method B",
        None,
        "none",
    )
    profile_crowning: str = key(
        Choice(("low", "high")), "profile crowning of bevel gears, for Z_LS of ISO 10300-2: e_LS 3 or 1.5", "low"
    )
    limited_pitting: bool = key(Choice((False, True)), "whether some pits are allowed", False)
    long_life_factor: float = key(Number(LONG_LIFE, 1.0), "Z_NT and Y_NT at 1e10 load cycles", LONG_LIFE)

    rules: ClassVar[tuple[Rule, ...]] = (
        rule(
            ("tolerance_class", "dynamic_factor", "transverse_load_factor"),
            lambda number, dynamic, transverse: number is not None or METHOD_B not in (dynamic, transverse),
            f'missing; needed for factors by "{METHOD_B}"; or give dynamic_factor = "{GIVEN}" and '
            "transverse_load_factor = a number",
        ),
    )

    def required_safety(self, mode: str) -> float:
        """Required safety against a kind of failure, of flanks or roots."""
        return self.required_root_safety if mode.endswith("root") else self.required_flank_safety


def is_rated(scene: Scene) -> bool:
    """Whether a scene says what its gears withstand and what is required of them."""
    return scene.pinion.strength is not None and scene.wheel.strength is not None and scene.rating is not None
