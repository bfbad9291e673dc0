"""A helical pair with short tip reliefs in space, before and behind a former step of its transmission error.

Source: the kept runs of ``validation.calculix.helical_contact``, finite elements with contact. At positions 120 to 123
the unloaded contact point lies at z = -1.5 mm, at 124 and 126 on the start of the pinion's tip relief. With the forces
of the slices on the axis of the curvatures at that point, the transmission error had a step between 123 and 124.

Tolerances: of the transmission error what the setback of the wheel at which gaps are taken changes (0.34 %), since a
linear analysis does not say which it is, and the meshes (0.04 %); of its changes over the positions twice what the
finest of three meshes changes in the step beside the next one. Line loads and places are means over layers 0.4 mm wide,
which cut the slices of the package askew.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca import AccuracyWarning, read_scene
from loaded_tca.compliance import tooth_compliance
from loaded_tca.loaded.cycle import OnePairsCycle, solve_cycles
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.plots.style import DISTINCT_COLOURS
from loaded_tca.unloaded import trace_contact
from validation.calculix.helical_contact import FILE, LINES_FILE, POSITIONS, TOUCHING, UNDER_LOAD, pinion_angle
from validation.calculix.tables import read_table
from validation.calculix.tooth_form import Array
from validation.page import Page, formatted, machine, table, write_page
from validation.table import Row, render

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CASE, SOURCE = "helical pair with short reliefs, in space", "finite elements with contact in space"
SCENE = Path(__file__).with_suffix(".toml")
FINEST = "fine"
BEFORE, BEHIND = 123, 124
"""Positions on both sides of the former step."""
FORMER = (-43.0997, -43.6208, -43.9028, -44.5812, -45.1919)
"""Transmission error of revision 66bc52a by this scene's defaults [um]: forces of slices on the axis of curvatures."""
COLOUR, FORMER_COLOUR = DISTINCT_COLOURS[:2]
ERROR, STEP, LINE_LOAD, PLACE = 0.005, 0.025, 0.02, 0.03
"""Relative; [um]; over the largest; [mm] of the roll length, on a contact 0.7 mm of it wide."""
CARRIES = 0.1
"""Part of the largest line load above which a layer is compared: the contact ends within the outermost ones."""
PAGE = """\
# A short tip relief in space against finite elements

Written by `python -m validation.calculix.helical_relief`. Machine: {machine}.

If the unloaded contact point lies on the start of a short tip relief, the curvatures at that point are those of one
side of the start, and the axis of curvatures does not follow the loaded line of contact. With the force of every slice
on this axis the transmission error had a step between two positions; with the force at the [centre of the
pressure](../how_it_works/tooth_compliance.md#where-a-force-acts) it has no step. Finite elements with contact on both
sides of the step decided which of the two is right.

**The pair**: 25/25 teeth, m_n 3 mm, beta 27 deg, face 12 mm, 40 um of parabolic tip relief over the last 1.5 mm of the
path of contact, 20 um of lead crowning and 20 um of helix slope on the pinion; one tooth pair carries 100 N m. The
contact is 7 mm long and ends before faces and tips. Positions are 1/128 of a pitch apart; the unloaded contact point
leaves z = -1.5 mm behind position 123 and follows the start of the relief.

**The finite elements**: both gears as whole rings with held bores, twenty-node hexahedra, graded towards the loaded
line. The stiffness is condensed to the normal displacements of the nodes near the contact; the pressure on cells of
half an element is the solution of a complementarity problem. There is no half-space, no slice and no bending line in
it, and nothing of the package; gaps are those of the two flanks turned onto each other
(`python -m validation.calculix.helical_contact`).

## Transmission error

![Transmission error over the positions, and the line load and its place at position 124](helical_relief_fem.png)

In um; in brackets what is beyond the finite elements.

{errors}

From position 123 to 124 the transmission error changes by {step_fem:.3f} um by finite elements, by {step_here:.3f} um
here, and by {step_former:.3f} um with the former forces. Over the five positions the difference from the finite
elements varies by {range_here:.3f} um here, by {range_former:.3f} um with the former forces, and by {range_held:.3f} um
with forces in the middle of the cells: today's grids lie along the loaded contact, so that these have no step either,
but the contact leaves the grid's axis more and more. `free_edges = false` changes the transmission error by
{by_edges:+.3f} um: too little to say here which axis free edges should follow.

## Meshes

Elements across the contact have the size *across*, layers along the face *along*; the half width of the contact is
0.2 mm. *Setback*: of the wheel where gaps are taken; the flanks just touch, as in a linear analysis, or overlap where
the load leaves the gears. The latter moves the line of contact by 0.03 mm of roll, less than half a position.

{meshes}

From the second finest mesh to the finest the transmission error changes by {of_error:.3f} um at most, its step by
{of_step:.3f} um; the other setback changes them by {by_setback:.3f} and {step_by_setback:.3f} um.

## Pressure along the face

Position 124, means over the layers of the finite elements: line load per length of face, and roll length on the
pinion at its centre.

{lines}

## Rows

```
{rows}
```
"""


@dataclass(frozen=True)
class Loaded:
    """Transmission errors and lines of pressure at all positions.

    Attributes
    ----------
    transmission_error : (positions,) array [um]
    lines : dict of (4, layers) arrays
        By position: lower and upper height of the layers [mm], line load [N/mm], roll length at its centre [mm].
    """

    transmission_error: Array
    lines: Mapping[int, Array]

    def step(self) -> float:
        """Change of the transmission error across the former step [um]."""
        before, behind = (POSITIONS.index(position) for position in (BEFORE, BEHIND))
        return float(self.transmission_error[behind] - self.transmission_error[before])


def kept(mesh: str = FINEST, setback: float = TOUCHING) -> Loaded:
    """Kept run on a mesh with cells of half an element; lines are those of the finest mesh with touching flanks."""
    rows = [row for row in read_table(FILE) if row["mesh"] == mesh and way(row) == (0.5, setback)]
    lines = {}
    for position in POSITIONS:
        chosen = [row for row in read_table(LINES_FILE) if row["position"] == position]
        low, high, force, roll = (
            np.array([float(row[name]) for row in chosen]) for name in ("low_mm", "high_mm", "force_N", "roll_mm")
        )
        lines[position] = np.stack([low, high, force / (high - low), roll])
    return Loaded(np.array([float(row["transmission_error_um"]) for row in rows]), lines)


@cache
def here(free_edges: bool = True, forces_on_grid_axis: bool = False) -> Loaded:
    """Result of the package at all positions, its lines on the layers of the kept ones.

    Parameters
    ----------
    free_edges : bool
    forces_on_grid_axis : bool
        Whether the forces of the slices act in the middle of the cells.
    """
    scene = read_scene(SCENE)
    pair = scene.pair()
    path = trace_contact(pair, np.array([pinion_angle(position) for position in POSITIONS]))
    grid = GridChoice(free_edges=free_edges, forces_on_grid_axis=forces_on_grid_axis)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        carried = solve_cycles([OnePairsCycle(pair, path, np.asarray(scene.torques), grid, tooth_compliance(pair))])[0]
    contacts = [contact for (contact,) in carried.contacts[0] if contact is not None]
    error = 1e3 * pair.base_radii[1] * (path.transmission_error - carried.rotation[0])
    reference = kept().lines
    lines = {
        position: on_layers(contact, float(pair.base_radii[0]), reference[position])
        for position, contact in zip(POSITIONS, contacts, strict=True)
    }
    return Loaded(error, lines)


def on_layers(contact: LoadedContact, base_radius: float, layers: Array) -> Array:
    """Line load and roll length of a contact's slices over given layers, with their heights (4, layers)."""
    grid, pressure = contact.separation, contact.solution.pressure
    force = pressure.sum(axis=0) * grid.spacing[0] * grid.spacing[1]
    slices = np.flatnonzero(force > 0.0)
    across = grid.x @ pressure[:, slices] / pressure[:, slices].sum(axis=0)
    places = grid.origin + np.outer(across, grid.axes[0]) + np.outer(grid.y[slices], grid.axes[1])
    order = np.argsort(places[:, 2])
    height, carried = places[order, 2], np.append(0.0, np.cumsum(force[slices][order]))
    middles = 0.5 * (height[1:] + height[:-1])
    ends = np.concatenate([[2.0 * height[0] - middles[0]], middles, [2.0 * height[-1] - middles[-1]]])
    low, high = layers[:2]
    load = (np.interp(high, ends, carried) - np.interp(low, ends, carried)) / (high - low)
    roll = np.sqrt(np.hypot(*places[order, :2].T) ** 2 - base_radius**2)
    return np.stack([low, high, load, np.interp(0.5 * (low + high), height, roll)])


def way(row: Mapping[str, float | str]) -> tuple[float, float]:
    """Width of the cells over that of the elements, and the setback, of a kept row."""
    return round(float(row["cell_mm"]) / float(row["across_mm"]), 6), float(row["setback_mm"])


def change(other: Loaded) -> tuple[float, float]:
    """Largest difference of another kept run from the finest [um]: of a transmission error, and of the step."""
    finest = kept()
    return float(abs(finest.transmission_error - other.transmission_error).max()), abs(finest.step() - other.step())


def spread(transmission_error: Array) -> float:
    """Range over the positions of the difference from the finite elements [um]."""
    return float(np.ptp(transmission_error - kept().transmission_error))


def rows() -> list[Row]:
    """Rows of transmission errors, and of the line load and its place along the face."""
    reference, ours = kept(), here()
    result = [
        Row(CASE, SOURCE, f"TE, position {position} [um]", expected, obtained, ERROR)
        for position, expected, obtained in zip(
            POSITIONS, reference.transmission_error.tolist(), ours.transmission_error.tolist(), strict=True
        )
    ]
    beyond = ours.step() - reference.step()
    name = f"step of TE from position {BEFORE} to {BEHIND}: beyond that of finite elements [um]"
    result.append(Row(CASE, SOURCE, name, 0.0, beyond, STEP))
    name = "TE less that of finite elements: range over the positions [um]"
    result.append(Row(CASE, SOURCE, name, 0.0, spread(ours.transmission_error), STEP))
    for position in (BEFORE, BEHIND):
        line, other = reference.lines[position], ours.lines[position]
        carries = line[2] > CARRIES * line[2].max()
        load = float(abs(other - line)[2, carries].max() / line[2].max())
        roll = float(abs(other - line)[3, carries].max())
        result += [
            Row(CASE, SOURCE, f"line load over its largest, position {position}: worst layer", 0.0, load, LINE_LOAD),
            Row(CASE, SOURCE, f"place of the load, position {position}: worst layer [mm of roll]", 0.0, roll, PLACE),
        ]
    return result


def page() -> Page:
    """Page and picture."""
    reference, ours = kept(), here()
    held, flanks = here(forces_on_grid_axis=True), here(free_edges=False)
    (of_error, of_step), (by_setback, step_by_setback) = change(kept("medium")), change(kept(setback=UNDER_LOAD))
    columns = {
        "finite elements": reference.transmission_error,
        "here": ours.transmission_error,
        "here, forces in the middle of the cells": held.transmission_error,
        "here, forces of slices on the axis of curvatures (revision 66bc52a)": np.array(FORMER),
    }
    errors = table(
        ["position", *columns],
        (
            [position, f"{values[0]:.3f}", *(f"{value:.3f} ({value - values[0]:+.3f})" for value in values[1:])]
            for position, *values in zip(POSITIONS, *columns.values(), strict=True)
        ),
    )
    line, other = reference.lines[BEHIND].T, ours.lines[BEHIND].T
    text = PAGE.format(
        machine=machine(numpy=True),
        errors=errors,
        step_fem=reference.step(),
        step_here=ours.step(),
        range_here=spread(ours.transmission_error),
        range_former=spread(np.array(FORMER)),
        range_held=spread(held.transmission_error),
        step_former=FORMER[POSITIONS.index(BEHIND)] - FORMER[POSITIONS.index(BEFORE)],
        of_error=of_error,
        of_step=of_step,
        by_setback=by_setback,
        step_by_setback=step_by_setback,
        by_edges=float((flanks.transmission_error - ours.transmission_error).mean()),
        meshes=meshes(),
        lines=table(
            "z [mm] | line load, finite elements [N/mm] | here | roll length, finite elements [mm] | here",
            (
                formatted(".2f", 0.5 * (low + high)) + formatted(".1f", load, its[2]) + formatted(".3f", roll, its[3])
                for (low, high, load, roll), its in zip(line.tolist(), other.tolist(), strict=True)
            ),
        ),
        rows=render(rows()),
    )
    return Page("helical_relief_fem", text, {"helical_relief_fem": picture(reference, ours)})


def meshes() -> str:
    """Table of the meshes: size, transmission errors, largest pressure, time."""
    kept_rows = read_table(FILE)
    names = dict.fromkeys((row["mesh"], *way(row)) for row in kept_rows)
    lines = []
    for mesh, part, setback in names:
        chosen = [row for row in kept_rows if (row["mesh"], *way(row)) == (mesh, part, setback)]
        sizes = [f"{chosen[0][size]:g}" for size in ("across_mm", "along_mm", "cell_mm")]
        rest = [f"{1e3 * setback:.1f}", f"{chosen[0]['nodes']:.0f}", f"{chosen[0]['seconds']:.0f}"]
        lines.append([mesh, *sizes, *rest, *(f"{row['transmission_error_um']:.3f}" for row in chosen)])
    sizes_and_more = ["mesh", "across", "along", "cells [mm]", "setback [um]", "nodes", "s"]
    return table([*sizes_and_more, *(f"TE {position} [um]" for position in POSITIONS)], lines)


def picture(reference: Loaded, ours: Loaded) -> Figure:
    """Transmission error over the positions; line load and its place along the face behind the former step."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 3.6), layout="constrained")
    error, load, place = figure.subplots(1, 3)
    error.plot(POSITIONS, FORMER, "--", color=FORMER_COLOUR, label="forces of slices on one axis")
    error.plot(POSITIONS, ours.transmission_error, color=COLOUR, label="loaded_tca")
    error.plot(POSITIONS, reference.transmission_error, "ko", label="finite elements")
    error.set(xlabel="position", ylabel="transmission error [µm]")
    error.legend(loc="upper right", fontsize=9)
    low, high, loads, rolls = reference.lines[BEHIND]
    height, carries = 0.5 * (low + high), loads > CARRIES * loads.max()
    for axes, k, values, label in ((load, 2, loads, "line load [N/mm]"), (place, 3, rolls, "roll length [mm]")):
        chosen = carries if k == 3 else np.ones_like(carries)
        axes.plot(height[chosen], ours.lines[BEHIND][k][chosen], color=COLOUR)
        axes.plot(height[chosen], values[chosen], "ko")
        axes.set(xlabel="z [mm]", ylabel=label)
    for axes in (error, load, place):
        axes.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    write_page(__doc__, page)
