"""What a stage amounts to before any contact is computed: planets, torques, phases, the gears of both meshes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.output.overview import scene_sections, spectrum_rows, torques_with_columns
from loaded_tca.output.overview_text import Overview
from loaded_tca.plain import plain
from loaded_tca.results.gear_warnings import warn_of_gears
from loaded_tca.scene.rows import Label, fixed
from loaded_tca.stages.analyse import expected_stage_effort
from loaded_tca.stages.kinematics import mesh_phases, neighbours_apart, neutralised
from loaded_tca.stages.result import MOST_ORDERS
from loaded_tca.stages.sections import RING_MESH, SUN_MESH, in_words_of

if TYPE_CHECKING:
    from loaded_tca.scene.model import Row
    from loaded_tca.stages import Stage

HELD = "Bores of sun and planets and the outside of the ring are held rigid; planet rims, carrier and pins do not bend."
"""What a stage does not model, for reports and the check of a file."""


def describe_stage(stage: Stage) -> str:
    """Return planets, torques, phases and geometry of a stage, a line each, with the warnings that concern its gears.

    Raises
    ------
    InputError, GeometryError
        If gears of the stage cannot exist, mesh or turn, or planets cannot be put in.
    """
    return overview_of_stage(stage).text


def overview_of_stage(stage: Stage) -> Overview:
    """Return what ``describe_stage`` says, before it is text."""
    stage.require_assembly()
    sections, meshes = stage_sections(stage), geometry_of_meshes(stage)
    seconds = plain(expected_stage_effort(stage).seconds, 2)
    return Overview(
        stage.title or "Planetary stage",
        sections,
        {name: {"geometry": rows} for name, rows, _ in meshes},
        {"seconds": seconds},
        ("analysis on idle cores, about [s]", seconds),
        [HELD],
        [f"{name}: {sentence}" for name, _, sentences in meshes for sentence in sentences],
    )


def stage_sections(stage: Stage) -> dict[str, list[Row]]:
    """Return the lines of an overview by their subjects, each a label and its cells.

    The first one of the phases names the columns below it.
    """
    return {"stage": _stage_rows(stage), "torques": _torque_rows(stage), "phases": phase_rows(stage)}


def geometry_of_meshes(stage: Stage) -> list[tuple[str, list[Row], list[str]]]:
    """Name of each mesh, the rows of its geometry, and its warnings that concern whole gears."""
    geometry = []
    for scene, gears in ((stage.sun_scene, SUN_MESH), (stage.ring_scene, RING_MESH)):
        with in_words_of(gears), noted_accuracy_warnings(given=False) as sentences:
            warn_of_gears(scene, scene.pair())
            rows = scene_sections(scene)["geometry"]
        name = " and ".join(f"{member} ({gear})" for gear, member in gears.items())
        geometry.append((name, rows, list(dict.fromkeys(sentences))))
    return geometry


def _stage_rows(stage: Stage) -> list[Row]:
    """What the stage is made of, and how its members are held."""
    asked, (z_s, z_p, z_r) = stage.stage, stage.teeth
    planet = stage.meshes[0].wheel
    pins = ("tangentially", asked.pin_tangential_um), ("outwards", asked.pin_radial_um)
    rows: list[Row] = [
        (Label("teeth of sun, planet and ring", "teeth", "sun", "planet", "ring"), f"{z_s}", f"{z_p}", f"{z_r}"),
        ("ratio of sun to carrier, the ring held", fixed(1.0 + z_r / z_s, 4)),
        ("driving", asked.driving),
        ("planets at [deg]", *(fixed(math.degrees(angle), 4) for angle in asked.angles)),
        ("they can be put in every [deg]", fixed(360.0 / (z_s + z_r), 4)),
        ("centre distance of both meshes [mm]", fixed(stage.centre_distance, 4)),
    ]
    if len(asked.angles) > 1:
        room = neighbours_apart(asked.angles, stage.centre_distance) - 2.0 * planet.tip_radius
        rows.append(("neighbouring planets apart [mm]", fixed(room, 4)))
    rows.append(("support of the sun", _support(stage)))
    rows += [(f"pins displaced {how} [um]", *(f"{plain(pin, 6)}" for pin in given)) for how, given in pins if given]
    return rows


def _support(stage: Stage) -> str:
    """How the sun is held, in words."""
    stiffness = stage.stage.support_stiffness
    if math.isinf(stiffness):
        return "rigid"
    return "floating" if stiffness == 0.0 else f"{plain(1e-3 * stiffness, 6)} N/um"


def _torque_rows(stage: Stage) -> list[Row]:
    """Torques of all members, and the force of a planet with an even share; of many torques the least and the largest.

    With the signs of the loads that the stage puts on its surroundings left out.
    """
    shown, (z_s, _, z_r) = torques_with_columns(stage.sun_torques), stage.teeth
    base = stage.meshes[0].pinion.base_radius
    return [
        ("sun torque [N m]", *(f"{plain(1e-3 * torque, 6)}" for torque in shown)),
        *spectrum_rows(stage.load),
        ("carrier torque [N m]", *(f"{plain(1e-3 * torque * (1.0 + z_r / z_s), 6)}" for torque in shown)),
        ("ring torque [N m]", *(f"{plain(1e-3 * torque * z_r / z_s, 6)}" for torque in shown)),
        (
            "force of an even share at the base circles [N]",
            *(fixed(_even(stage, torque) / base, 1) for torque in shown),
        ),
    ]


def _even(stage: Stage, torque: float) -> float:
    return torque / len(stage.stage.angles)


def phase_rows(stage: Stage) -> list[Row]:
    """Phases of the meshes of each planet, and the orders that equal planets cancel."""
    angles = stage.stage.angles
    phases = mesh_phases(*stage.meshes, angles, stage.stage.driving == "sun")
    cancelled = [neutralised(order, angles, stage.sun.teeth) for order in range(1, MOST_ORDERS + 1)]
    orders = [", ".join(str(k + 1) for k, one in enumerate(cancelled) if one[which]) or "none" for which in range(2)]
    return [
        ("phases of the meshes, in mesh cycles", "sun's", "ring's"),
        *(
            (f"  planet {planet}", fixed(sun, 4), fixed(ring, 4))
            for planet, (sun, ring) in enumerate(zip(*(one.tolist() for one in phases), strict=True))
        ),
        ("orders of the mesh that equal planets cancel", f"rotation: {orders[0]}", f"forces on the sun: {orders[1]}"),
    ]
