"""The sections of a scene of two cylindrical gears, key by key."""

# ruff: noqa: N815  -- names are the keys of the file, units included; the calls make dataclass fields

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from loaded_tca.scene.keys import Choice, List, Number, Whole, above_zero, key
from loaded_tca.scene.section import Rule, Section, subsection

"""Relative error of the peak pressure that is aimed at where a scene asks for neither accuracy nor cells."""

Hand = Literal["right", "left"]

AMOUNT_um = Number(0.0, 10000.0)
SLOPE_um = Number(-10000.0, 10000.0)
DIAMETER_mm = above_zero(100000.0)
RELIEF_FORM = Choice(("parabolic", "linear"))
ERROR_deg = Number(-10.0, 10.0)
ERROR_mm = Number(-1000.0, 1000.0)
TORQUE_Nm = Number(0.0, 1e9)


def _needs(amount_key: str, companion_key: str) -> Rule:
    """Rule: an amount above zero needs its companion above zero."""

    def complain(companion: float, amount: float) -> str | None:
        if amount > 0.0 and companion == 0.0:
            return f"missing or 0; {amount_key} = {amount:g} needs a value above 0"
        return None

    return Rule((companion_key, amount_key), complain)


def _below(smaller_key: str, larger_key: str, factor: float = 1.0) -> Rule:
    """Rule: a length stays below (a factor times) another one, where both are given."""
    limit = larger_key if factor == 1.0 else f"{factor:g} {larger_key}"

    def complain(smaller: float | None, larger: float | None) -> str | None:
        if smaller is not None and larger is not None and smaller > factor * larger:
            return f"found {smaller:g}; allowed up to {limit} = {factor * larger:g}"
        return None

    return Rule((smaller_key, larger_key), complain)


@dataclass(frozen=True, kw_only=True)
class Geometry(Section):
    """[pair]: what both gears have in common."""

    type: Literal["cylindrical"] = key(Choice(("cylindrical",)), "kind of gear pair")
    normal_module_mm: float = key(above_zero(1000.0), "normal module m_n")
    pressure_angle_deg: float = key(Number(1.0, 44.0), "normal pressure angle alpha_n", 20.0)
    helix_angle_deg: float = key(
        Number(0.0, 59.0), "helix angle beta at the reference circle; its sign is in `pinion.hand`", 0.0
    )
    centre_distance_mm: float | None = key(
        DIAMETER_mm, "working centre distance a", None, "follows from the profile shifts, without backlash"
    )
    driving: Literal["pinion", "wheel"] = key(Choice(("pinion", "wheel")), "the gear that drives", "pinion")
    sense: Literal["positive", "negative"] = key(
        Choice(("positive", "negative")),
        "sense of rotation; negative: the pinion turns the other way and pushes with its other flank",
        "positive",
    )
    dedendum_coefficient: float = key(
        above_zero(5.0), "dedendum of the basic rack (ISO 53 profile A) in modules, h_fP/m_n", 1.25
    )
    root_radius_coefficient: float = key(Number(0.0, 1.0), "root radius of the basic rack in modules, rho_fP/m_n", 0.38)


@dataclass(frozen=True, kw_only=True)
class Modifications(Section):
    """[pinion.modifications], [wheel.modifications]: amounts of material removed along the normal."""

    lead_crowning_um: float = key(AMOUNT_um, "lead crowning C_beta, at the ends of the face", 0.0)
    lead_crowning_form: str = key(
        Choice(("parabolic", "circular", "logarithmic")), "form of the lead crowning", "parabolic"
    )
    end_relief_um: float = key(AMOUNT_um, "end relief C_betaI = C_betaII at both ends, parabolic", 0.0)
    end_relief_length_mm: float = key(
        Number(0.0, 10000.0), "length of the end relief at each end, up to half the face width", 0.0
    )
    profile_crowning_um: float = key(AMOUNT_um, "profile crowning C_alpha, at the ends of the active profile", 0.0)
    tip_relief_um: float = key(AMOUNT_um, "tip relief C_alpha_a, at the tip; above 0 it needs its start", 0.0)
    tip_relief_start_mm: float = key(Number(0.0, 100000.0), "diameter at which the tip relief starts", 0.0)
    tip_relief_form: str = key(RELIEF_FORM, "form of the tip relief over the roll length", "parabolic")
    root_relief_um: float = key(
        AMOUNT_um,
        "root relief C_alpha_f, at the start of the active profile; above 0 it needs its start",
        0.0,
    )
    root_relief_start_mm: float = key(Number(0.0, 100000.0), "diameter at which the root relief starts", 0.0)
    root_relief_form: str = key(RELIEF_FORM, "form of the root relief over the roll length", "parabolic")
    helix_slope_um: float = key(SLOPE_um, "helix slope C_H_beta over the face width; may be negative", 0.0)
    profile_slope_um: float = key(SLOPE_um, "profile slope C_H_alpha over the active profile; may be negative", 0.0)

    rules: ClassVar[tuple[Rule, ...]] = (
        _needs("end_relief_um", "end_relief_length_mm"),
        _needs("tip_relief_um", "tip_relief_start_mm"),
        _needs("root_relief_um", "root_relief_start_mm"),
    )


@dataclass(frozen=True, kw_only=True)
class ElasticMaterial(Section):
    """[material], or [pinion.material] and [wheel.material]."""

    youngs_modulus_MPa: float = key(above_zero(1e7), "Young's modulus E")
    poisson_ratio: float = key(Number(0.0, 0.5), "Poisson's ratio nu")
    max_pressure_MPa: float | None = key(
        above_zero(1e7), "pressure at which the surface yields (plastic cap)", None, "elastic"
    )


@dataclass(frozen=True, kw_only=True)
class Gear(Section):
    """[pinion], [wheel]: what each gear has of its own."""

    teeth: int = key(Whole(3, 10000), "number of teeth z")
    face_width_mm: float = key(above_zero(10000.0), "face width b")
    hand: Hand | None = key(
        Choice(("right", "left")),
        "hand of the helix (without meaning for a spur gear)",
        None,
        "right for the pinion, and the other for the wheel",
    )
    profile_shift: float = key(Number(-5.0, 5.0), "profile shift coefficient x", 0.0)
    tip_diameter_mm: float | None = key(DIAMETER_mm, "tip diameter d_a", None, "d + 2 m_n (1 + x)")
    bore_diameter_mm: float | None = key(DIAMETER_mm, "bore diameter, for the tooth compliance", None, "no bore")
    modifications: Modifications = subsection(Modifications, "material removed from the flanks")
    material: ElasticMaterial | None = subsection(
        ElasticMaterial, "material of this gear, instead of the common one", optional=True
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        _below("bore_diameter_mm", "tip_diameter_mm"),
        _below("modifications.end_relief_length_mm", "face_width_mm", 0.5),
        _below("modifications.tip_relief_start_mm", "tip_diameter_mm"),
        _below("modifications.root_relief_start_mm", "tip_diameter_mm"),
    )


@dataclass(frozen=True, kw_only=True)
class MountingErrors(Section):
    """[mounting]: how the wheel is displaced from its nominal place."""

    in_plane_deg: float = key(ERROR_deg, "axis error in the plane of the axes; positive: the axes part at z > 0", 0.0)
    out_of_plane_deg: float = key(
        ERROR_deg,
        "axis error across that plane; positive: at z > 0 the wheel moves against the driving flank",
        0.0,
    )
    centre_distance_error_mm: float = key(ERROR_mm, "centre distance error; positive: apart", 0.0)
    axial_offset_mm: float = key(ERROR_mm, "axial displacement of the wheel, positive towards +z", 0.0)


@dataclass(frozen=True, kw_only=True)
class Load(Section):
    """[load]: what the pair carries."""

    pinion_torque_Nm: float = key(TORQUE_Nm, "magnitude of the torque on the pinion")


@dataclass(frozen=True, kw_only=True)
class Analysis(Section):
    """[analysis]: how finely it is computed."""

    positions: int = key(
        Whole(1, 10000), "mesh positions over one pitch, both ends included; 1 = the pitch point alone", 21
    )
    accuracy: float = key(
        Number(1e-6, 0.5), "wanted relative error of the peak pressure; chooses the grid unless cells do", 1e-3
    )
    cells: tuple[int, int] | None = key(
        List(Whole(4, 1000000), 2, 2),
        "cells across and along the contact; chooses the grid instead of the accuracy",
        None,
        "follows from accuracy",
    )
    tolerance: float = key(Number(1e-14, 0.1), "relative tolerance of the contact solver", 1e-6)
    load_sharing: bool = key(
        Choice((False,), later=(True,)),
        "whether several tooth pairs share the torque; false: one carries all",
        False,
    )
    compliance: str = key(Choice(("contact",), later=("contact+tooth",)), "what yields under load", "contact")
    torques_Nm: tuple[float, ...] | None = key(
        List(TORQUE_Nm, 1, 1000), "several pinion torques, all analysed", None, "the one of [load]"
    )
