"""What gears of a REXS model withstand as sections [pinion.strength], [wheel.strength], and its load spectrum.

Names and units of attributes are those of the schemas 1.0 to 1.7 (fva-net/rexs-api-java): up to 1.2 endurance limits
are those of gears, later those of materials; 1.7 has stress numbers of ISO 6336-5:2016 beside them. Duration and share
of a load case are those of the gear unit in it, ``load_duration`` up to 1.4 and ``operating_time`` later.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from loaded_tca.errors import require
from loaded_tca.exchange.gearbox import Gearbox
from loaded_tca.exchange.gears import operation_of
from loaded_tca.exchange.model import PRESSURE, SMALL_LENGTH, Component, Model, Reading
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_5 import MATERIALS, material_kind
from loaded_tca.scene.load import SUM_OF_SHARES
from loaded_tca.scene.rating import StrengthSection
from loaded_tca.scene.section import check

LIMITS = {
    "sigma_H_lim_MPa": ("allowable_stress_number_contact_iso_6336_2016", "endurance_limit_flank"),
    "sigma_F_lim_MPa": ("nominal_stress_number_tooth_root_iso_6336_2016", "endurance_limit_root"),
}
"""Key -> attributes of a material or a gear, the first one that is there."""
HARDNESS = {
    "hardness_HV": ("surface_hardness_vickers", {"HV": 1.0}),
    "hardness_HRC": ("surface_hardness_rockwell", {"HRC": 1.0}),
    "hardness_HBW": ("surface_hardness_brinell", {"HB": 1.0, "HBW": 1.0}),
}
ROUGHNESS = {"flank_Rz_um": "arithmetic_average_roughness_flank", "root_Rz_um": "arithmetic_average_roughness_root"}
RZ_OVER_RA = 6.0
"""As ISO 6336-2 and -3 take it."""
KIND = "heat_treated_material_type_iso_6336"
KIND_OF_TYPE = {
    "black_malleable_cast_iron": "GTS",
    "case_hardened_wrought_steel": "Eh",
    "flame_or_induction_hardened_steel": "IF",
    "grey_cast_iron": "GG",
    "nitrided_steel": "NT",
    "nitrided_through_hardened_steel": "NV",
    "nitrocaburized_wrought_steel": "NV nitrocarburized",
    "nodular_cast_iron_ferritic_structure": "GGG ferritic",
    "nodular_cast_iron_perlitic_or_bainitic_structure": "GGG",
    "normalized_cast_steel": "St cast",
    "normalized_wrought_low_carbon_steel": "St",
    "through_hardened_cast_steel": "V alloy cast",
    "through_hardened_wrought_steel": "V alloy",
}
"""Choice of a file, as it is spelt there -> kind of material of ISO 6336-5."""
ALLOY = "through_hardened_cast_steel", "through_hardened_wrought_steel"
SOFT = "V", "St", "GGG", "GGG ferritic", "GTS", "GG"
"""Families of which the root takes a proof stress."""
SHARE, HOURS = {"%": 0.01, "none": 1.0, "": 1.0}, {"h": 1.0, "min": 1.0 / 60.0, "s": 1.0 / 3600.0}


def strength_section(reading: Reading, gear: Component) -> dict[str, Any] | None:
    """Return the strength of a gear; None where the file has none of a kind, limits and roughness that is complete.

    Parameters
    ----------
    reading : Reading
    gear : Component
    """
    materials = reading.model.related("reference", "origin", gear.id, "referenced")
    material = next((one for one in materials if one.type == "material"), None)
    if material is None:
        return None
    table = _kind_of(material) | _limits(material, gear) | _hardness(material)
    if not ({"kind", "material"} & {*table}) or not _says_strength(material, gear):
        return None
    table |= _proof_stress(material, table)
    roughness = {key: gear.number(name, SMALL_LENGTH) for key, name in ROUGHNESS.items()}
    table |= {key: RZ_OVER_RA * value for key, value in roughness.items() if value}
    if missing := [key for key in ROUGHNESS if key not in table]:
        told = ", ".join(f"{key} = {value if isinstance(value, str) else plain(value)}" for key, value in table.items())
        reading.leave(gear, f"its strength ({told}): a scene needs {' and '.join(missing)}, too")
        return None
    _, problems, _ = check(StrengthSection, table)
    if problems:
        reading.leave(gear, f"its strength: {'; '.join(problems)}")
        return None
    _take(reading, material, gear)
    reading.note(f"{gear}: Rz is {plain(RZ_OVER_RA, 6)} times the average roughness")
    if material.text(_type_of(material)) in ALLOY:
        reading.note(f"{material}: a through-hardened steel, taken as alloyed")
    return table


def _says_strength(material: Component, gear: Component) -> bool:
    """Whether a file says more of a material than its name: one of the attributes that are read here."""
    names = {name for one in LIMITS.values() for name in one} | {name for name, _ in HARDNESS.values()}
    return bool(({_type_of(material)} | names) & {*material.attributes} or names & {*gear.attributes})


def _type_of(material: Component) -> str:
    return next((name for name in sorted(material.attributes, reverse=True) if name.startswith(KIND)), KIND)


def _kind_of(material: Component) -> dict[str, Any]:
    """Name of a steel that is known, or the kind of material."""
    if kind := KIND_OF_TYPE.get(material.text(_type_of(material))):
        return {"kind": kind}
    known = {name.lower(): name for name in MATERIALS}
    names = (material.text("material_designation"), material.name.strip().lower())
    return next(({"material": known[name]} for name in names if name in known), {})


def _limits(material: Component, gear: Component) -> dict[str, Any]:
    """Both endurance limits; none where the file has not both."""
    limits = {}
    for key, names in LIMITS.items():
        values = (one.number(name, PRESSURE) for name in names for one in (material, gear))
        if value := next((each for each in values if each), None):
            limits[key] = value
    return limits if len(limits) == len(LIMITS) else {}


def _hardness(material: Component) -> dict[str, Any]:
    for key, (name, units) in HARDNESS.items():
        if value := material.number(name, units):
            return {key: value}
    return {}


def _proof_stress(material: Component, table: Mapping[str, Any]) -> dict[str, Any]:
    """Yield strength of materials whose roots take one."""
    kind = table["kind"] if "kind" in table else MATERIALS[table["material"]][0]
    value = material.number("yield_strength", PRESSURE)
    return {"proof_stress_MPa": value} if value and material_kind(kind).family in SOFT else {}


def _take(reading: Reading, material: Component, gear: Component) -> None:
    names = (*(name for one in LIMITS.values() for name in one), "yield_strength", "material_designation")
    reading.take(material, *names, *(name for name, _ in HARDNESS.values()), _type_of(material))
    reading.take(gear, *(name for one in LIMITS.values() for name in one), *ROUGHNESS.values())


@dataclass(frozen=True)
class LoadBin:
    """A load case of a spectrum, on the pinion of a stage.

    Attributes
    ----------
    case : str
        "SPECTRUM:ID".
    torque : float [N m]
        Magnitude.
    speed : float [1/min] or None
        Magnitude.
    hours : float or None
    share : float or None
        Of the time of all, from 0 to 1.
    reversed : bool
        Whether it loads the other flanks, by default those that the first case does not load.
    """

    case: str
    torque: float
    speed: float | None
    hours: float | None
    share: float | None
    reversed: bool


def load_spectrum(model: Model, stage: str, side: int = 0) -> tuple[LoadBin, ...]:
    """Return torque, speed and duration of every load case of a model on the pinion of a cylindrical stage.

    Parameters
    ----------
    model : Model
    stage : str
        Id of its component.
    side : int
        Of the teeth, 1 or -1, whose load is not reversed; 0: that of the first case.

    Returns
    -------
    tuple of LoadBin
        None of a model without load cases. A case that loads no tooth is left out.

    Raises
    ------
    InputError
        If there is no such stage, or a share or duration is negative.

    Examples
    --------
    >>> from loaded_tca.exchange import read_rexs
    >>> bins = load_spectrum(read_rexs("examples/models/two_stage_gearbox.rexs"), "10")
    >>> [(one.case, one.torque, one.speed, one.reversed) for one in bins]
    [('1:1', 150.0, 1500.0, False), ('1:2', 60.0, 3000.0, True)]
    """
    bins: list[LoadBin] = []
    first = side
    for case in model.load_cases:
        name = f"{case.spectrum}:{case.id}"
        under = model.with_load_case(name)
        gearbox = Gearbox(Reading(under))
        chosen = gearbox.stage(stage)
        if gearbox.tooth_torques.get(stage) == 0.0:
            continue
        run = operation_of(gearbox, chosen, None)
        first = first or run.side
        units = under.of_type("gear_unit")
        hours, share = (_of_unit(units, names, unit) for names, unit in TIMES)
        bins.append(LoadBin(name, run.torque, run.speed, hours, share, run.side != first))
    return tuple(bins)


def cases_of_spectrum(bins: Sequence[LoadBin]) -> list[dict[str, Any]]:
    """Keys of ``[[load.case]]`` of bins that last hours, all of them, or have shares: what these leave is an idle bin.

    None of bins that say neither, and of bins that all load the other flanks.
    """
    for name in ("hours", "share"):
        times = [getattr(one, name) for one in bins]
        if any(time is None for time in times) or not sum(times) > 0.0 or all(one.reversed for one in bins):
            continue
        rows = [
            {"pinion_torque_Nm": one.torque, name: time}
            | ({"pinion_speed_rpm": one.speed} if one.speed else {})
            | ({"reversed": True} if one.reversed else {})
            for one, time in zip(bins, times, strict=True)
        ]
        rest = 1.0 - sum(times)
        idle = {"pinion_torque_Nm": 0.0, name: rest}
        return [*rows, idle] if name == "share" and rest > SUM_OF_SHARES else rows
    return []


TIMES: tuple[tuple[tuple[str, ...], Mapping[str, float]], ...] = (
    (("operating_time", "load_duration"), HOURS),
    (("operating_time_fraction", "load_duration_fraction"), SHARE),
)


def has_times(model: Model) -> bool:
    """Whether a load case of a model says how long it lasts."""
    names = {name for these, _ in TIMES for name in these}
    return any(names & {*own} for case in model.load_cases for own in case.components.values())


def _of_unit(units: list[Component], names: tuple[str, ...], factors: Mapping[str, float]) -> float | None:
    """A time of the gear unit, the first of some names that it has."""
    for unit in units:
        for name in names:
            if (value := unit.number(name, factors)) is not None:
                require((value >= 0.0, f"{unit}: {name}: found {plain(value, 6)}; allowed from 0 on"))
                return value
    return None
