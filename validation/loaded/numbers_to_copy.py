"""The numbers of a summary that are copied first, and what they depend on: misalignment, box, grid, defaults.

Load factors of a helical pair without modifications over its misalignment; contact deformation with free edges over
the size of the box, and the state a pitch later; peak pressure at sharp edges over the grid; key figures of the example
scenes with today's defaults and the earlier ones. What an earlier revision gave stands beside them.

Run from the root of the repository: ``python -m validation.loaded.numbers_to_copy``; writes a page.
"""

import warnings
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene, sample_separation, solve_contact, trace_contact
from loaded_tca.arrays import Array
from loaded_tca.edges.free import edge_compliance
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import DoubleHelicalScene, Scene
from validation.loaded import mesh_stiffness
from validation.page import SCENES, SPACED, Page, formatted, machine, table, write_page
from validation.table import Row

CASE, ITSELF = "numbers to copy", "itself on other grids"
EARLIER = {"load_sharing": False, "compliance": "contact", "free_edges": False}
TODAY = {"load_sharing": True, "compliance": "contact+tooth", "free_edges": True}
POSITIONS, GRIDS, FINEST = 13, (32, 64), 128
MISALIGNMENTS = (-16.0, -12.0, -8.0, -4.0, 0.0, 4.0, 8.0, 12.0, 16.0)  # um, in the plane of action over 30 mm
BOXES, CELLS = (0.85, 1.0, 1.5, 2.0), 40  # cells along either axis of the box x 1; their size is that of all
FIGURES = (
    ("peak_pressure_MPa", "peak pressure [MPa]"),
    ("transmission_error_span_um", "transmission error, peak to peak [um]"),
    ("mesh_stiffness_mean_N_per_mm_um", "mesh stiffness [N/(mm um)]"),
    ("face_load_factor", "K_Hbeta"),
)
STEP = 0.02  # of the torque, to either side: derivative of the rotation
ON_GRIDS = 0.03
# Beside a sharp end the force on a given length converges with the root of the width of the cells: the bound that the
# page states for flanks alone.
FLANKS_ALONE_ON_GRIDS = 0.045
# What free edges add to the deformation of half-spaces: three times the largest change. The box x 0.85 of the crowned
# helical pair cuts the deformation of half-spaces itself; the earlier revision changed by 1.3e-3 and more.
IN_ANY_BOX, CUT_BY_THE_BOX = 6e-6, {"helical": 3e-4}
# The standard has a linear line load and 1 for an aligned pair, which has 1.18 where teeth bend and bodies tilt.
OF_STANDARD = 0.25
LEAST_RISE = 0.1  # of K_Hbeta over 8 um, away from its least value; the standard has 0.26

# What stands behind a colon was measured once with revision 00c770a, "before": free edges that reached as far as the
# box, and in the summary the highest cell, or the cells beside the contact point, for the peak pressure.
IN_BOXES = {  # scene, torque [N m], pitches from the pitch point: contact deformation [um] over the boxes
    ("helical", 130.0, 0.0): (7.033, 7.033, 7.154, 7.337),
    ("misaligned", 130.0, 0.0): (13.276, 13.293, 13.293, 13.293),
    ("spiral_bevel", 0.4, 0.2): (1.872, 1.982, 2.116, 2.120),
    ("face_milled_19x62_matched", 300.0, -0.6): (36.828, 37.330, 37.933, 38.171),
}
A_PITCH_LATER = {  # scene, torque [N m]: what a_pitch_later returns
    ("helical", 130.0): (53.794, 53.792, 1.014),
    ("mesh_cycle_spur", 130.0): (50.910, 50.910, 1.004),
    ("straight_bevel", 50.0): (124.539, 124.539, 1.004),
    ("spiral_bevel", 0.8): (384.311, 384.302, 1.195),
    ("face_milled_19x62_matched", 300.0): (236.481, 235.494, 1.289),
}
AT_EDGES = {  # peak pressure of the summary and highest cell [MPa] over the grids
    "23/81, 16 um out of line": ((15078, 15078), (23532, 23532), (36680, 36680)),
    "34/57, 260 N m": ((818, 2684), (819, 3732), (819, 5119)),
}
FACTORS_BEFORE = """\
| misalignment [um] | line load ratio, 32 x 32 | 64 x 64 | flanks alone, no free edges, 32 x 32 | 64 x 64 | peak \
pressure [MPa], 32 x 32 | 64 x 64 |
| --- | --- | --- | --- | --- | --- | --- |
| -16 | 1.526 | 1.532 | 3.935 | 4.964 | 4537 | 1022 |
| -8 | 1.323 | 1.325 | 2.531 | 2.932 | 12216 | 21559 |
| 0 | 1.339 | 1.313 | 1.472 | 1.492 | 930 | 932 |
| 8 | 1.483 | 1.574 | 2.700 | 3.261 | 14714 | 22850 |
| 16 | 1.799 | 1.900 | 3.881 | 4.682 | 15078 | 23532 |"""


def solved(scene: Scene, **analysis: Any) -> MeshCycle:
    """Analyse a scene with other keys of ``analysis``; contacts on sharp edges are meant here, without a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse(scene.with_changes({f"analysis.{key}": value for key, value in analysis.items()}))


@cache
def helical(cells: int) -> MeshCycle:
    """The helical pair 34/57 with crownings, whose contacts reach the tips under 260 N m."""
    grid = {"positions": POSITIONS, "accuracy": None, "cells": (cells, cells), "torques_Nm": [260.0]}
    return solved(read_scene(SCENES / "mesh_cycle_helical.toml"), **TODAY, **grid)


@cache
def misaligned(
    misalignment_um: float, cells: int, compliance: str = "contact+tooth", positions: int = POSITIONS
) -> MeshCycle:
    """The helical pair 23/81 without modifications out of line, 250 N m."""
    gears: dict[str, Any] = {
        "pair.normal_module_mm": 2.5,
        "pair.pressure_angle_deg": 17.5,
        "pair.helix_angle_deg": 28.0,
    }
    gears |= {"pair.centre_distance_mm": 147.5, "pinion.modifications": {}, "load.pinion_torque_Nm": 250.0}
    for gear, values in (("pinion", (23, 32.0, 0.30)), ("wheel", (81, 30.0, -0.1929))):
        gears |= dict(zip((f"{gear}.teeth", f"{gear}.face_width_mm", f"{gear}.profile_shift"), values, strict=True))
    scene = read_scene(SCENES / "helical.toml").with_changes(
        gears | {"mounting.misalignment_um": misalignment_um, "analysis.accuracy": None}
    )
    return solved(scene, **{**TODAY, "compliance": compliance}, positions=positions, cells=(cells, cells))


def in_boxes(name: str, torque_Nm: float, pitches: float, free_edges: bool = True) -> Array:
    """Contact deformation [um] of one contact under one force, over the size of its box."""
    pair, found = read_scene(SCENES / f"{name}.toml").pair(), []
    contact = trace_contact(pair, [pitches * pair.pitch], warn=False)[0]
    load = 1e3 * torque_Nm / contact.pinion_lever
    fitting = sample_separation(pair, contact, cells=(CELLS, CELLS), load=load).box
    across, along = (half + abs(place) for half, place in zip(fitting.half_lengths, fitting.middle, strict=True))
    for factor in BOXES:
        box, count = (factor * across, factor * along), round(factor * CELLS)
        grid = sample_separation(pair, contact, cells=(count, count), box=box)
        options: dict[str, Any] = {"slice_compliance": edge_compliance(pair, grid) if free_edges else None}
        options |= {"load": load, "tolerance": 1e-8, "warn": False}
        solution = solve_contact(grid.gap, grid.spacing, pair.contact_modulus, **options)
        found.append(1e3 * solution.approach)
    return np.array(found)


def a_pitch_later(name: str, torque_Nm: float) -> tuple[float, float, float]:
    """Rotation under load [urad], that a pitch later, and the mesh stiffness over the derivative of the rotation.

    Flanks alone; of the stiffness that ratio of three positions which is farthest from 1.
    """
    torques = [(1.0 + step) * torque_Nm for step in (-STEP, 0.0, STEP)]
    grid = {"positions": 3, "accuracy": None, "cells": (24, 32), "torques_Nm": torques}
    cycle = solved(read_scene(SCENES / f"{name}.toml"), **{**TODAY, "compliance": "contact"}, **grid)
    rotation = np.abs(cycle.transmission_error - cycle.unloaded_transmission_error)
    force = 2e3 * STEP * torque_Nm / cycle.gear_pair.base_radii[0] / cycle.face_width
    ratios = cycle.mesh_stiffness[1] * 1e3 * cycle.wheel_base_radius * (rotation[2] - rotation[0]) / force
    first, _, last = 1e6 * rotation[1]
    return float(first), float(last), float(ratios[np.abs(ratios - 1.0).argmax()])


def load_factors() -> str:
    """Load factors and peak pressure over the misalignment, on two grids."""
    grids = "32 x 32 | 64 x 64"
    head = f"misalignment [um] | K_Hbeta, {grids} | change | flanks alone, {grids} | change"
    lines = []
    for um in MISALIGNMENTS:
        line = [f"{um:g}"]
        for compliance in ("contact+tooth", "contact"):
            coarse, fine = (float(misaligned(um, cells, compliance).face_load_factor[0]) for cells in GRIDS)
            line += [*formatted(".3f", coarse, fine), f"{fine / coarse - 1.0:+.1%}"]
        both = _on_grids(um)
        across = formatted(".3f", *(one.transverse_load_factor[0] for one in both))
        lines.append([*line, *across, *formatted(".0f", *map(_peak, both))])
    return table(f"{head} | K_Halpha, {grids} | peak pressure [MPa], {grids}", lines, SPACED)


def boxes() -> str:
    """Contact deformation over the size of the box: half-spaces, free edges, free edges before."""
    lines = []
    for case, before in IN_BOXES.items():
        name = f"`{case[0]}.toml`, {case[1]:g} N m, {case[2]:g} pitches"
        spaces = in_boxes(*case, free_edges=False), in_boxes(*case), np.array(before)
        for words, values in zip(("half-spaces", "free edges", "free edges, before"), spaces, strict=True):
            lines.append([name, words, *formatted(".3f", *values), f"{_spread(values):.2%}"])
    return table(f"contact | | {' | '.join(f'box x {factor:g}' for factor in BOXES)} | spread", lines, SPACED)


def repeated() -> str:
    """Rotation a pitch later and stiffness, beside those of before."""
    lines = [
        [f"`{case[0]}.toml`, {case[1]:g} N m", *formatted(".3f", *a_pitch_later(*case), *before)]
        for case, before in A_PITCH_LATER.items()
    ]
    head = "rotation [urad] | a pitch later | stiffness ratio"
    return table(f"pair | {head} | before: {head}", lines, SPACED)


def at_sharp_edges() -> str:
    """Peak pressure, edge pressure and highest cell over the grid, beside those of before."""
    lines = []
    for name, before in AT_EDGES.items():
        for cells, earlier in zip((*GRIDS, FINEST), before, strict=True):
            cycle = helical(cells) if name.startswith("34/57") else misaligned(16.0, cells)
            cell = max(float(one.pressure.max()) for row in cycle.maps[0] for one in row if one is not None)
            lines.append([name, cells, *formatted(".0f", _peak(cycle), np.nanmax(cycle.edge_pressure), cell), *earlier])
    head = "pair | cells along each axis | peak pressure [MPa] | edge pressure [MPa] | highest cell [MPa]"
    return table(f"{head} | before: peak pressure [MPa] | highest cell [MPa]", lines, SPACED)


def examples() -> str:
    """Key figures of the example scenes that keep the defaults, with the earlier ones and today's."""
    figures = []
    for file in sorted(SCENES.glob("*.toml")):
        scene = read_scene(file)
        if isinstance(scene, DoubleHelicalScene) or any(
            getattr(scene.analysis, key) != value for key, value in TODAY.items()
        ):
            continue
        earlier, today = solved(scene, **EARLIER), solved(scene, **TODAY)
        line = [f"`{file.name}`"]
        for (key, _), style in zip(FIGURES, (".0f", ".2f", ".1f", ".2f"), strict=True):
            line += formatted(style, *(cycle.key_figures()[-1][key] for cycle in (earlier, today)))
        figures.append(line)
    head = " | ".join(f"{name}, earlier | today" for _, name in FIGURES)
    return table(f"scene | {head}", figures, SPACED)


def standard_face_load_factor(misalignment_um: float) -> float:
    """K_Hbeta of the pair 23/81 by ISO 6336-1: 1 + F_beta c_gamma_beta b / (2 F_m) as long as it is below 2."""
    mesh = mesh_stiffness.REAL.mesh
    stiffness = 0.85 * mesh_stiffness.standard(mesh)  # c_gamma_beta [N/(mm um)]
    line_load = 250e3 / mesh.pinion.reference_radius / 30.0  # F_m / b [N/mm]
    return 1.0 + 0.5 * abs(misalignment_um) * stiffness / line_load


def load_factor_rows() -> Iterator[Row]:
    """K_Hbeta over the misalignment: how it rises away from its least value, and its size by ISO 6336-1."""
    factors = np.array([misaligned(um, GRIDS[0]).face_load_factor[0] for um in MISALIGNMENTS[::2]])
    least = int(factors.argmin())
    rises = np.concatenate([-np.diff(factors[: least + 1]), np.diff(factors[least:])])
    quantity = "K_Hbeta of 23/81: falls away from its least value, -16 to 16 um"
    yield Row(CASE, ITSELF, quantity, 0.0, float(np.maximum(-rises, 0.0).sum()), 0.0)
    # The least value lies between two of the values: on its own side one step may rise by little.
    quantity = f"K_Hbeta of 23/81: steps of 8 um that rise by more than {LEAST_RISE:g}, all but one of {rises.size}"
    yield Row(CASE, ITSELF, quantity, rises.size - 1.0, float(np.count_nonzero(rises > LEAST_RISE)), 0.0)
    yield _row_of_standard()


def _row_of_standard(positions: int = POSITIONS) -> Row:
    loaded = (misaligned(um, GRIDS[0], positions=positions) for um in (MISALIGNMENTS[0], MISALIGNMENTS[-1]))
    ends = [float(one.face_load_factor[0]) for one in loaded]
    quantity = "K_Hbeta of 23/81, mean of 16 um out of line to either side"
    standard = standard_face_load_factor(MISALIGNMENTS[-1])
    return Row(CASE, "ISO 6336-1, c_gamma_beta", quantity, standard, float(np.mean(ends)), OF_STANDARD)


def added_by_free_edges(contact: tuple[str, float, float]) -> float:
    """Spread over the boxes of what free edges add to the contact deformation, over the deformation."""
    half_spaces = in_boxes(*contact, free_edges=False)
    return float(np.ptp(in_boxes(*contact) - half_spaces) / half_spaces[1])


def rows() -> list[Row]:
    """Load factor over misalignment and grid, peak pressure over the grid, contact deformation over the box."""
    found = list(load_factor_rows())
    for um in (0.0, 16.0):
        coarse, fine = ((one.face_load_factor[0], _peak(one)) for one in _on_grids(um))
        for what, one, other in zip(("K_Hbeta", "peak pressure"), coarse, fine, strict=True):
            quantity = f"{what} of 23/81, {um:g} um out of line: change from 32 to 64 cells"
            found.append(Row(CASE, ITSELF, quantity, 0.0, other / one - 1.0, ON_GRIDS))
        one, other = (misaligned(um, cells, "contact").face_load_factor[0] for cells in GRIDS)
        quantity = f"K_Hbeta of 23/81, flanks alone, {um:g} um out of line: change from 32 to 64 cells"
        found.append(Row(CASE, ITSELF, quantity, 0.0, other / one - 1.0, FLANKS_ALONE_ON_GRIDS))
    return [*found, *map(_row_of_boxes, IN_BOXES)]


def short_rows() -> list[Row]:
    """Load factor far out of line at few positions, contact deformation over the box of one contact."""
    return [_row_of_standard(5), _row_of_boxes(("misaligned", 130.0, 0.0))]


def _row_of_boxes(contact: tuple[str, float, float]) -> Row:
    quantity = f"contact deformation of {contact[0]}: spread of what free edges add over boxes x 0.85 to 2"
    allowed = CUT_BY_THE_BOX.get(contact[0], IN_ANY_BOX)
    return Row(CASE, ITSELF, quantity, 0.0, added_by_free_edges(contact), allowed)


def _on_grids(misalignment_um: float) -> list[MeshCycle]:
    return [misaligned(misalignment_um, cells) for cells in GRIDS]


def _peak(cycle: MeshCycle) -> float:
    return float(np.nanmax(cycle.peak_pressure))


def _spread(values: Array) -> float:
    return float(np.ptp(values) / values[1])


def page() -> str:
    """Measure everything; the page."""
    return f"""# Numbers that are copied from a summary

Written by `python -m validation.loaded.numbers_to_copy`. Machine: {machine(numpy=True)}. "Before"
is revision 00c770a: free edges whose reach followed the box, the highest cell (or the cells beside the contact point)
for the peak pressure, no K_Hbeta.
[Results](../guide/results.md) says what each number is.

## Load factors against misalignment

Helical pair 23/81, m_n 2.5, alpha_n 17.5 deg, beta 28 deg, a 147.5 mm, faces 32 and 30 mm, no modifications, 250 N m,
{POSITIONS} positions; `misalignment_um` is measured in the plane of action over 30 mm.

{load_factors()}

K_Hbeta rises on both sides of its least value. From 32 to 64 cells along each axis it may change by 3 %, with flanks
alone by 4.5 %, since then more load lies at sharp ends, where a strip converges slowly. With flanks alone the least
value is at a misalignment near zero. Bending of teeth and bodies lowers the effect of misalignment and moves the least
value, because the axial force of a helical gear tilts the bodies.

Instead of K_Hbeta, the earlier revision has the line load of the pair with the largest force, divided by that of an
even load (today `line_load_ratio`). Without free edges this ratio depends on the grid:

{FACTORS_BEFORE}

## Free edges against the box

One contact under one force, on cells of one size; contact deformation [um]. The box x 1 is the one that an analysis
takes; the box x 0.85 cuts off the ends of the longest contact.

{boxes()}

The next table is for a shared load with flanks alone, on 24 x 32 cells: the rotation at the first position and at the
last one, which is the same state a pitch later, and the mesh stiffness divided by the derivative of the rotation over
4 % of the torque (the worst of three positions). The contact lines of the helical pair end at tips within cells: on 64
x 96 cells its ratio is 1.002.

{repeated()}

## Pressure at sharp edges against the grid

{at_sharp_edges()}

Where the edge cuts the cell, the edge pressure is above the highest cell of the map: the map divides the force by the
whole cell, the edge pressure by the part with material.

## Example scenes, earlier defaults and today's

Earlier: one tooth pair carries the load, flanks alone, no free edges. Scenes that switch one of today's defaults off
are left out. Largest torque of each scene; lengths at the wheel's base circle.

{examples()}
"""


if __name__ == "__main__":
    write_page(__doc__, lambda: Page("numbers_to_copy", page()))
