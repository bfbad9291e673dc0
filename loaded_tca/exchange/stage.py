"""A stage of a REXS model as a scene: what is taken, how it was understood, and what is not."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError, named
from loaded_tca.exchange.gearbox import Gearbox, Stage
from loaded_tca.exchange.gears import (
    STEEL,
    axis_sign,
    datum_sign,
    flank_of,
    gear_section,
    material_section,
    operation_of,
    pair_section,
)
from loaded_tca.exchange.model import LENGTH, Component, Model, Reading
from loaded_tca.exchange.modifications import Teeth, modification_keys
from loaded_tca.exchange.shafts import diameter_at, rest_of, shaft_section
from loaded_tca.exchange.strength import cases_of_spectrum, has_times, load_spectrum, strength_section
from loaded_tca.pairs.gear import ON_SHAFT
from loaded_tca.plain import plain
from loaded_tca.scene import Scene, scene_from_table
from loaded_tca.scene.keys import literal
from loaded_tca.supports import shafts_of


@dataclass(frozen=True, eq=False)
class ImportedStage:
    """A stage as a scene.

    Attributes
    ----------
    scene : Scene
    table : mapping
        What of its keys the model gives.
    read_as : tuple of str
        How the file was understood where it leaves that open, and what was assumed.
    not_taken : tuple of str
        What a scene cannot have, and what was not read, with the ids of the components and names of attributes.
    source : str
        Name of the file, its version, and the stage.
    """

    scene: Scene
    table: Mapping[str, Any]
    read_as: tuple[str, ...]
    not_taken: tuple[str, ...]
    source: str

    def to_toml(self) -> str:
        """Return a scene file: the keys that the model gives, and above them what was not taken."""
        lists = (("Read as:", self.read_as), ("Not taken:", self.not_taken))
        lines = [f"# From {self.source}."]
        for head, sentences in lists:
            if sentences:
                lines += ["#", f"# {head}", *(f"#   {_one_line(one)}" for one in sentences)]
        return "\n".join([*lines, "", *_toml(self.table)]) + "\n"

    def summary(self) -> str:
        """Return what was understood and what was not taken, as text."""
        lines = [self.source]
        for head, sentences in (("read as", self.read_as), ("not taken", self.not_taken)):
            lines += [head, *(f"  {one}" for one in sentences)] if sentences else []
        return "\n".join(lines)


def describe_stages(model: Model) -> str:
    """Return the stages of a model as text: id, type, name and gears.

    Parameters
    ----------
    model : Model
    """
    stages = [one for one in model.components.values() if one.type.endswith("stage")]
    if not stages:
        return f"{model.source}: no stages"
    lines = [f"{model.source}: REXS {model.version}; stages"]
    for one in stages:
        gears = [gear for role in ("gear_1", "gear_2") for gear in model.related("stage", "stage", one.id, role)]
        teeth = ", ".join(f"{gear} with {_teeth(gear)} teeth" for gear in gears)
        lines.append(
            f"  {one.id}: {one.type}" + (f' "{one.name}"' if one.name else "") + (f": {teeth}" if teeth else "")
        )
    if model.load_cases:
        lines.append(f"load cases: {_cases(model)}")
    return "\n".join(lines)


def _cases(model: Model) -> str:
    return ", ".join(f"{one.spectrum}:{one.id}" for one in model.load_cases)


def _note_loads(reading: Reading, load_case: str | None, bins: int) -> None:
    """Note which torques and speeds hold, where the model has more than those of its components."""
    if load_case is not None:
        reading.note(f"torques and speeds: those of the load case {load_case}")
    elif bins:
        reading.note(f"load spectrum of {bins} bins: load cases {_cases(reading.model)}, which have durations")
    elif reading.model.load_cases:
        reading.note(
            f"torques and speeds: those of the components themselves, of none of the load cases {_cases(reading.model)}"
        )


def _note_constant(reading: Reading, stage: Stage, table: Mapping[str, Any], torque: float) -> None:
    """Note what a scene has alike in all bins of a spectrum: loads on the shafts, modifications of both flanks."""
    for name, shaft in zip(GEARS, stage.shafts, strict=True):
        if table[name].get("shaft", {}).get("loads"):
            under = f"those under the torques of the components themselves, {plain(torque, 6)} N m on the pinion"
            reading.note(f"{shaft}: its loads are the same in every bin of the spectrum, {under}")
    if any(case.get("reversed") for case in table["load"]["case"]):
        reading.note("reversed bins load the other flanks; the scene gives these the modifications of the loaded ones")


def _teeth(gear: Component) -> str:
    number = gear.number("number_of_teeth")
    return "?" if number is None else f"{plain(number, 6)}"


def import_stage(
    model: Model, stage: str, *, load_case: str | None = None, torque_Nm: float | None = None
) -> ImportedStage:
    """Make a scene of a cylindrical stage.

    Parameters
    ----------
    model : Model
    stage : str
        Id of its component.
    load_case : str, optional
        Id of a load case, the torques and speeds of which hold; default: all of them as a load spectrum, if each has a
        duration or a share of the time, else those of the components themselves.
    torque_Nm : float, optional
        Torque on the pinion [N m], instead of that of the model. Torques of other stages and of loads on the shafts
        change by the same factor; forces that the model gives to loads stay.

    Returns
    -------
    ImportedStage

    Raises
    ------
    InputError
        If there is no such stage or load case, a number is missing or has another unit, or the scene cannot be; with
        the id of the component and the name of the attribute, or the key of the scene.
    GeometryError
        If the gears cannot exist or cannot mesh.

    Examples
    --------
    >>> from loaded_tca.exchange import read_rexs
    >>> model = read_rexs("examples/models/two_stage_gearbox.rexs")
    >>> imported = import_stage(model, "10")
    >>> imported.scene.pair()
    GearPair(21/55, module 2.5 mm, face 28 mm)
    """
    model = model if load_case is None else model.with_load_case(load_case)
    reading = Reading(model)
    gearbox = Gearbox(reading)
    chosen = gearbox.stage(stage)
    reading.touch([chosen.component, *chosen.gears])
    run = operation_of(gearbox, chosen, torque_Nm)
    of_one = load_case is not None or torque_Nm is not None
    cases = [] if of_one or not has_times(model) else cases_of_spectrum(load_spectrum(model, stage, run.side))
    _note_loads(reading, load_case, len(cases))
    flanks = [flank_of(gearbox, chosen, gear, run.side) for gear in (0, 1)]
    table: dict[str, Any] = {"title": _title(chosen), "pair": pair_section(gearbox, chosen, flanks, run)}
    for n, name in enumerate(GEARS):
        table[name] = gear_section(gearbox, chosen, n, flanks[n], table["pair"])
        if strength := strength_section(reading, chosen.gears[n]):
            table[name]["strength"] = strength
    table |= _materials(reading, chosen, table)
    table["load"] = {"case": cases} if cases else {"pinion_torque_Nm": run.torque}
    if run.speed:
        table["operation"] = {"pinion_speed_rpm": run.speed}
    offset = _axial_offset(reading, chosen)
    if offset:
        table["mounting"] = {"axial_offset_mm": offset}
    with named(f"stage {stage}"):
        mesh = scene_from_table(table).mesh()
        _add_bores(gearbox, chosen, table, mesh)
        _add_modifications(gearbox, chosen, flanks, table, mesh)
        scene = scene_from_table(table)
        for n in range(len(GEARS)):
            scene = _with_shaft(gearbox, chosen, n, table, scene, run.torque_factor)
    if cases:
        _note_constant(reading, chosen, table, run.torque)
    return ImportedStage(
        scene,
        table,
        tuple(reading.read_as),
        tuple(rest_of(reading)),
        f"{os.path.basename(model.source)}, REXS {model.version}, {chosen.component.label}",
    )


def _title(stage: Stage) -> str:
    return _one_line(stage.component.name or f"stage {stage.id}")[:200]


def _one_line(text: str) -> str:
    return " ".join("".join(one if one.isprintable() else " " for one in text).split())


def _materials(reading: Reading, stage: Stage, table: dict[str, Any]) -> dict[str, Any]:
    """Section [material], or those of the gears, which join the table."""
    sections = [material_section(reading, gear) for gear in stage.gears]
    for gear, section in zip(stage.gears, sections, strict=True):
        if section is None:
            reading.note(f"{gear}: no material with elastic constants; it is steel, E 206000 MPa, nu 0.3")
    materials = [STEEL if section is None else section for section in sections]
    if materials[0] == materials[1]:
        return {"material": materials[0]}
    for name, section in zip(GEARS, materials, strict=True):
        table[name]["material"] = section
    return {}


def _axial_offset(reading: Reading, stage: Stage) -> float:
    if not stage.placed:
        reading.note(f"{stage.component}: the gears have no places in space; the middles of their faces are level")
        return 0.0
    return round(stage.axial_offset, 9) + 0.0


def _add_bores(gearbox: Gearbox, stage: Stage, table: dict[str, Any], mesh: Any) -> None:
    """Add what holds the bodies of the gears: the shaft at the middle of the face where it lies below the root."""
    for n, (name, gear) in enumerate(zip(GEARS, (mesh.pinion, getattr(mesh, "wheel", None)), strict=True)):
        diameter = diameter_at(gearbox, stage, n)
        if diameter is None or "bore_diameter_mm" in table[name]:
            continue
        if stage.internal and n == 1:
            if diameter > 2.0 * gear.root_radius:
                table[name]["outer_diameter_mm"] = diameter
        elif diameter <= ON_SHAFT * 2.0 * gear.root_radius:
            table[name]["bore_diameter_mm"] = diameter
            gearbox.reading.note(f"{stage.gears[n]}: its bore is the shaft below it, {plain(diameter, 6)} mm")


def _add_modifications(
    gearbox: Gearbox, stage: Stage, flanks: list[Component | None], table: dict[str, Any], mesh: Any
) -> None:
    for n, (name, flank) in enumerate(zip(GEARS, flanks, strict=True)):
        if flank is None:
            continue
        gear = (mesh.pinion, mesh.wheel)[n]
        active = (mesh.pinion_active_profile, mesh.wheel_active_profile)[n]
        teeth = Teeth(
            stage.gears[n].required("face_width", LENGTH),
            2.0 * gear.base_radius,
            gear.roll_length(gear.tip_radius),
            active.start_roll_length,
            axis_sign(gearbox, stage, n) * datum_sign(gearbox.reading, stage.gears[n]),
            ring=stage.internal and n == 1,
        )
        keys = modification_keys(gearbox.reading, flank, teeth)
        if keys:
            table[name]["modifications"] = keys


def _with_shaft(
    gearbox: Gearbox, stage: Stage, gear: int, table: dict[str, Any], scene: Scene, torque_factor: float
) -> Scene:
    """Scene with the shaft of a gear, if it can be: one that its bearings do not hold is left."""
    section = shaft_section(gearbox, stage, gear, torque_factor)
    name, shaft = GEARS[gear], stage.shafts[gear]
    if section is None or shaft is None:
        return scene
    material, of_gear = material_section(gearbox.reading, shaft), scene.materials[gear]
    if material and (material["youngs_modulus_MPa"], material["poisson_ratio"]) != (
        of_gear.youngs_modulus_MPa,
        of_gear.poisson_ratio,
    ):
        gearbox.reading.leave(
            shaft, f"its material, E {plain(material['youngs_modulus_MPa'], 6)} MPa: it has that of the gear"
        )
    trial = {**table, name: {**table[name], "shaft": section}}
    try:
        on_shaft = scene_from_table(trial)
        shafts_of(on_shaft)
    except InputError as error:
        gearbox.reading.leave(shaft, f"{'; '.join(error.problems)}; {name} without a support")
        return scene
    table[name] = trial[name]
    return on_shaft


def _toml(table: Mapping[str, Any], path: str = "") -> list[str]:
    """Lines of tables: keys first, then sections, and lists of tables with a header for each."""
    lines, sections = [], []
    for name, value in table.items():
        where = f"{path}{name}"
        if isinstance(value, Mapping):
            sections += ["", f"[{where}]", *_toml(value, f"{where}.")]
        elif name in ("bearings", "loads", "case"):
            for one in value:
                sections += ["", f"[[{where}]]", *_toml(one, f"{where}.")]
        elif name == "sections":
            rows = [", ".join(f"{key} = {literal(each)}" for key, each in one.items()) for one in value]
            lines += [f"{name} = [", *(f"    {{{row}}}," for row in rows), "]"]
        else:
            lines.append(f"{name} = {literal(value)}")
    return lines + sections
