"""What a double helical pair amounts to before any contact is computed: its halves, forces, the geometry of each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.double_helical.analyse import expected_double_helical_effort
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.output.overview import mounting_rows, scene_sections, spectrum_rows, torques_with_columns
from loaded_tca.output.overview_text import Overview
from loaded_tca.plain import plain
from loaded_tca.results.gear_warnings import warn_of_gears
from loaded_tca.scene.double_helical import HALVES
from loaded_tca.scene.rows import fixed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from loaded_tca.scene.double_helical import DoubleHelicalScene
    from loaded_tca.scene.model import Row

OF_EACH = "mounting errors, edges and modifications", "flanks described by points"
"""Subjects of an overview that each half has of its own; the others are those of half a."""
HELD = "Each half is a gear of its own on a rigid bore: rim, web and groove between the halves do not bend or twist."
"""What a double helical pair without shafts does not model."""


def describe_double_helical(scene: DoubleHelicalScene) -> str:
    """Return halves, forces and geometry of a double helical pair, a line each, with warnings on whole gears.

    Raises
    ------
    InputError, GeometryError
        If gears of a half cannot exist, mesh or turn.
    """
    return overview_of_double_helical(scene).text


def overview_of_double_helical(scene: DoubleHelicalScene) -> Overview:
    """Return what ``describe_double_helical`` says, before it is text."""
    rows, halves = pair_rows(scene), geometry_of_halves(scene)
    of_pair = {"pair": rows} | ({"bearings": [*bearing_rows_of_halves(scene)]} if scene.is_supported else {})
    seconds = plain(expected_double_helical_effort(scene).seconds, 2)
    return Overview(
        scene.title or "Double helical pair",
        of_pair,
        {f"{name}, z from the groove outwards": sections for name, sections, _ in halves},
        {"seconds": seconds},
        ("analysis of even shares, about [s]", seconds),
        [held_in_words(scene)],
        [f"{name}: {sentence}" for name, _, sentences in halves for sentence in sentences],
    )


def held_in_words(scene: DoubleHelicalScene) -> str:
    """What bends and twists under both halves, and what does not."""
    shafts = [name for name in GEARS if getattr(scene, name).shaft is not None]
    if not shafts:
        return HELD
    of_gears = "The shafts of both gears bend and twist"
    if len(shafts) == 1:
        of_gears = f"The shaft of the {shafts[0]} bends and twists"
    rigid = "".join(f", and the {name} has a rigid bore" for name in GEARS if name not in shafts)
    return f"Each half is a gear of its own. {of_gears} under and between the halves; rims and webs do not{rigid}."


def geometry_of_halves(
    scene: DoubleHelicalScene, positions: int | None = None
) -> list[tuple[str, dict[str, list[Row]], list[str]]]:
    """Name of each half, its overview by subjects, of half b those that may differ, and its warnings on whole gears.

    ``positions`` as of :func:`loaded_tca.output.overview.scene_sections`.
    """
    geometry = []
    for half, own in enumerate(scene.half_scenes(scene.mounting.axial_offset_mm)):
        with noted_accuracy_warnings(given=False) as sentences:
            warn_of_gears(own, own.pair())
            sections = scene_sections(own, positions, mounted=False)
        shown = {
            name: rows
            for name, rows in sections.items()
            if name != "bearings" and (not half or name in OF_EACH)  # both halves load these
        }
        geometry.append((f"half {HALVES[half]}", shown, list(dict.fromkeys(sentences))))
    return geometry


def bearing_rows_of_halves(scene: DoubleHelicalScene) -> Iterator[Row]:
    """Forces on the bearings of shafts with even shares, each half where its flanks touch, a cell for each torque."""
    from loaded_tca.double_helical.shafts import first_bearing_forces  # loaded contacts: others do not need them

    axial = scene.mounting.axial_offset_mm
    forces = [first_bearing_forces(scene, axial, torque) for torque in torques_with_columns(scene.torques)]
    for gear in forces[0]:
        for n, bearing in enumerate(getattr(scene, gear).shaft.bearings):
            cells = (fixed(float(np.linalg.norm(of_gears[gear][n, :3])), 1) for of_gears in forces)
            yield f"{gear}, bearing {n} at {plain(bearing.at_mm, 6)} mm: force [N]", *cells


def pair_rows(scene: DoubleHelicalScene) -> list[Row]:
    """Of both halves together: widths, hands, how the gears stand, torques and axial forces."""
    geometry, gears = scene.geometry, (scene.pinion, scene.wheel)
    shown = torques_with_columns(scene.torques)
    mesh = scene.mesh()
    axial = [0.5 * torque / mesh.pinion.base_radius * abs(scene.axial_rate) for torque in shown]
    held = geometry.axial_stiffness_N_per_um
    runouts = [gear.apex_runout_um for gear in gears]
    floats = f"{geometry.floating}, on {plain(held)} N/um" if held else geometry.floating
    return [
        ("", "pinion", "wheel"),
        ("overall face width, with the groove [mm]", *(fixed(gear.face_width_mm, 4) for gear in gears)),
        ("face width of a half [mm]", *(fixed(scene.half_width(gear), 4) for gear in gears)),
        ("hand of half a, at z > 0", *scene.hands),
        ("groove [mm]", fixed(geometry.gap_mm, 4)),
        ("floating along its axis", floats),
        ("apex of the wheel towards half a [mm]", fixed(geometry.apex_offset_mm, 4)),
        *mounting_rows(scene),
        *([("apex runout, peak to peak [um]", *(plain(runout, 6) for runout in runouts))] if any(runouts) else []),
        ("pinion torque of both halves [N m]", *(f"{plain(1e-3 * torque, 6)}" for torque in shown)),
        *spectrum_rows(scene.load),
        ("axial force of a half, even shares [N]", *(fixed(force, 1) for force in axial)),
    ]
