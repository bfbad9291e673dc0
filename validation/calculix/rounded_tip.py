"""The rounded tip of a tooth on a flank: graded columns against finite elements in plane strain.

A flank that ends in a rounding of 0.2 mm, 115 or 150 deg to the land beyond it, is pressed by one of 10 mm radius whose
nearest point lies 0.05 mm before the rounding. Both bodies are rings about a core, some 3.5 mm large: the tip's core
is held, that of the other moves straight towards it. ``python -m validation.calculix.rounded_tip`` repeats the runs (a
minute each; it needs ``ccx``) and writes the table of pressures that is kept, with which the rows compare. Half-spaces
do not tilt as the tip does: without an angle of the edge they show what that is worth.

Elements half as large at the rounding change the peaks by 0.0, 0.4 and 0.7 % (115 deg under 100 and 200 N/mm, 150 deg),
at 200 N/mm with corrections of some 2 nm left; all elements half as large, but for the smallest, 0.05 %. The
penalty lowers the peak under 100 N/mm by about 0.9 %, told from one of 3e8 MPa/mm.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable
from io import StringIO
from pathlib import Path

import numpy as np

from loaded_tca.contact import EdgePressure, RoundedEdge, edge_pressures
from validation.calculix.deck import (
    THICKNESS,
    write_contact_pairs,
    write_material,
    write_set,
    write_steps,
    write_turning_together,
)
from validation.calculix.run import Run, program_version, run
from validation.calculix.section import Ints
from validation.calculix.steel import CONTACT_MODULUS, POISSON_RATIO, YOUNGS_MODULUS
from validation.calculix.tables import DATA, read_table, write_table
from validation.calculix.tooth_form import Array
from validation.table import Row

RADIUS = 0.2
FLANK_RADIUS, OFFSET = 10.0, 0.05
RUNS = ((115.0, 100.0), (115.0, 200.0), (150.0, 200.0))
"""Angle [deg] between flank and land, and line load [N/mm]."""
PENALTY = 1e9
"""MPa/mm: ten times that of the other decks, since the rounding is pressed by some tenths of a micrometre only."""
BODY, LENGTH = 3.0, 4.0
"""Distance of the cores from the surface, and length of its sides [mm]."""
FINEST, GROWTH, DEEPER = 1e-3, 0.12, 1.2
"""Size of the elements at the rounding [mm], its growth per length from there, and that of layer to layer."""
COARSEST = 0.3
FILE = DATA / "calculix_rounded_tip.csv"
SOURCE = "finite elements in the plane (CalculiX)"
ASKED = 3e-2
CELLS_ON_ARC = 10.0
"""Of the half-spaces."""


def along(low: float, high: float, fine: tuple[float, float]) -> Array:
    """Places from one end to the other, finest within two places, coarser with the distance from them; n odd."""
    s = np.unique(np.concatenate([np.linspace(low, high, 20001), np.linspace(*fine, 2001)]))
    beyond = np.maximum(np.maximum(fine[0] - s, s - fine[1]), 0.0)
    density = 1.0 / np.minimum(FINEST + GROWTH * beyond, COARSEST)
    count = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(s))))
    return np.interp(np.linspace(0.0, count[-1], 2 * math.ceil(count[-1]) + 1), count, s)


def tip_curve(s: Array, tip_angle: float) -> Array:
    """Points of the surface by the length from where the rounding begins: flank, rounding, land."""
    turn = math.pi - tip_angle
    angle = np.clip(s / RADIUS, 0.0, turn)
    rest = np.maximum(s - RADIUS * turn, 0.0)
    x = np.minimum(s, 0.0) + RADIUS * np.sin(angle) + rest * math.cos(turn)
    return np.column_stack([x, RADIUS * (1.0 - np.cos(angle)) + rest * math.sin(turn)])


def flank_curve(s: Array) -> Array:
    """Points of the other surface, which lies below."""
    return np.column_stack([s, -((s + OFFSET) ** 2) / (2.0 * FLANK_RADIUS)])


def ring(surface: Array, pole: Array) -> tuple[Array, Ints, Ints, Ints]:
    """Nodes, elements, loaded elements and core nodes of the body between a surface, closed by a circle, and a core.

    ``surface`` (2 n + 1, 2) runs counter-clockwise about the pole; elements of eight nodes, their first side on it.
    """
    first, last = (np.arctan2(*(surface[k] - pole)[::-1]) for k in (0, -1))
    radii = [float(np.hypot(*(surface[k] - pole))) for k in (0, -1)]
    turn = (first - last) % (2.0 * math.pi)
    part = np.linspace(0.0, 1.0, 2 * math.ceil(turn * radii[0] / COARSEST) + 1)[1:-1]
    angles = last + turn * part
    circle = pole + (radii[1] + (radii[0] - radii[1]) * part)[:, None] * np.column_stack(
        [np.cos(angles), np.sin(angles)]
    )
    outer = np.concatenate([surface, circle])
    core = pole + (BODY / 3.0) * (outer - pole) / np.hypot(*(outer - pole).T)[:, None]
    depth = [0.0]
    step = FINEST
    while depth[-1] < 1.0:
        depth += [depth[-1] + 0.5 * step / BODY, depth[-1] + step / BODY]
        step = min(DEEPER * step, COARSEST)
    layers = np.array(depth) / depth[-1]
    around, deep = len(outer), len(layers)
    nodes = (outer[:, None] + layers[:, None] * (core - outer)[:, None]).reshape(-1, 2)

    def at(i: Ints, j: Ints) -> Ints:
        return (i % around) * deep + j

    i, j = (k.ravel() for k in np.meshgrid(np.arange(0, around, 2), np.arange(0, deep - 1, 2), indexing="ij"))
    # Counter-clockwise: inwards is to the left of the surface.
    corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = np.column_stack([at(i + di, j + dj) for di, dj in corners])
    loaded = np.flatnonzero((j == 0) & (i < len(surface) - 1))
    used = np.unique(elements)
    number = np.full(len(nodes), -1)
    number[used] = np.arange(used.size)
    held = number[np.arange(around) * deep + deep - 1]
    return nodes[used], number[elements], loaded, held[held >= 0]


def deck(tip_angle: float, line_load: float) -> str:
    """The whole input deck; bodies and names as in the decks of gears: P the tip, W the flank."""
    turn, inward = math.pi - tip_angle, math.pi - 0.5 * tip_angle
    tip_pole = np.array([0.0, RADIUS]) + BODY * np.array([math.cos(inward), math.sin(inward)])
    tip = tip_curve(along(-LENGTH, LENGTH + RADIUS * turn, (-0.01, 0.03)), tip_angle)
    flank = flank_curve(along(-LENGTH, LENGTH, (-0.01, 0.03))[::-1])
    bodies = [ring(tip, tip_pole), ring(flank, np.array([-OFFSET, -BODY]))]
    out = StringIO()
    out.write("*NODE,NSET=NALL\n")
    first = 1
    starts = []
    for nodes, *_ in bodies:
        starts.append(first)
        np.savetxt(out, np.column_stack([first + np.arange(len(nodes)), nodes]), fmt="%d,%.12g,%.12g,0")
        first += len(nodes)
    out.write("*ELEMENT,TYPE=CPE8R,ELSET=EALL\n")
    first, surfaces = 1, StringIO()
    for (_, elements, loaded, _), start, name in zip(bodies, starts, "PW", strict=True):
        table = np.column_stack([first + np.arange(len(elements)), elements + start])
        np.savetxt(out, table, fmt="%d", delimiter=",")
        surfaces.write(f"*SURFACE,NAME={name}0,TYPE=ELEMENT\n")
        surfaces.writelines(f"{first + element},S1\n" for element in _near(elements, loaded, bodies[name == "W"][0]))
        first += len(elements)
    write_material(out, f"{THICKNESS}\n")
    out.write(surfaces.getvalue())
    write_contact_pairs(out, [0], PENALTY)
    held, moved = (body[3] + start for body, start in zip(bodies, starts, strict=True))
    write_set(out, "HELD", held)
    write_set(out, "MOVED", moved)
    write_turning_together(out, moved)
    out.write("*BOUNDARY\nHELD,1,2\nMOVED,1,1\n")
    write_steps(out, int(moved[0]), line_load * THICKNESS, (1.0,), [0])
    return out.getvalue()


def _near(elements: Ints, loaded: Ints, nodes: Array) -> Iterable[int]:
    """Loaded elements within a millimetre of the contact."""
    return [int(k) for k in loaded if abs(float(nodes[elements[k, 0], 0])) < 1.0]


def keep(work: Path) -> None:
    """Run every load and write the table of pressures."""
    table = []
    for degrees, load in RUNS:
        found = run(deck(math.radians(degrees), load), work / f"rounded_tip_{degrees:g}_{load:g}", [0], 1)
        table += table_rows(degrees, load, found)
    write_table(FILE, head(program_version()), table)


def table_rows(degrees: float, load: float, found: Run) -> list[dict[str, object]]:
    """Rows of one run: nodes of the surface and their pressures."""
    force = found.forces[0][0]
    front = np.abs(found.points[:, 2]) < 0.5 * THICKNESS  # both faces of the slice carry nodes; one tells
    x, pressure = found.points[front, 0], found.pressures[0][front]
    order = np.argsort(x)
    common = {
        "tip_angle_deg": degrees,
        "line_load_N_per_mm": load,
        "load_centre_mm": -force.pinion_torque / force.normal_force,
        "seconds": found.seconds,
    }
    return [{**common, "x_mm": float(x[k]), "pressure_MPa": float(pressure[k])} for k in order]


def head(program: str) -> list[str]:
    """Comment lines above the table."""
    return [
        f"Computed by {program}; repeated by: python -m validation.calculix.rounded_tip",
        f"Plane strain, CPE8R, elements of {1e3 * FINEST:g} um at the rounding of {RADIUS:g} mm, which begins at",
        f"x = 0; on a flank of {FLANK_RADIUS:g} mm radius, nearest {OFFSET:g} mm before the rounding;",
        f"E {YOUNGS_MODULUS:g} MPa, nu {POISSON_RATIO:g}, no friction; "
        f"face-to-face penalty contact, {PENALTY:g} MPa/mm.",
        "load_centre: of the pressures.",
    ]


def peak_of_columns(line_load: float, tip_angle: float | None) -> EdgePressure:
    """The same contact on graded columns, two rows of a great length along it; half-spaces without an angle."""
    length = 1000.0

    def gap(rows: Array, x: Array) -> Array:
        beyond = np.clip(x, 0.0, 0.9 * RADIUS)
        across = (x + OFFSET) ** 2 / (2.0 * FLANK_RADIUS) + RADIUS - np.sqrt(RADIUS**2 - beyond**2)
        return np.where(np.abs(rows) < 0.5 * length, 0.0, np.inf)[:, None] + across

    edge = RoundedEdge((0.0, 0.0), (0.0, 1.0), RADIUS, tip_angle)
    box = ((-length, length), (-0.5, 0.12))
    load = line_load * length
    (found,) = edge_pressures(
        gap, box, [edge], load, CONTACT_MODULUS, cells=(4, 64), cells_on_arc=CELLS_ON_ARC, tolerance=1e-9
    )
    return found


def centre(found: EdgePressure) -> float:
    """Centre of the pressures across the edge [mm]."""
    force = found.solution.pressure.sum(axis=0) * found.solution.problem.widths
    return float(force @ found.solution.problem.middles / force.sum())


def rows() -> list[Row]:
    """Peak at the rounding: of half-spaces, and of a wedge of the tip's angle."""
    kept, table = read_table(FILE), []
    for degrees, load in RUNS:
        mine = [row for row in kept if (row["tip_angle_deg"], row["line_load_N_per_mm"]) == (degrees, load)]
        peak, place = max(float(row["pressure_MPa"]) for row in mine), float(mine[0]["load_centre_mm"])
        case = f"rounded tip of {degrees:g} deg on a flank, {load:g} N/mm"
        plain, wedge = (peak_of_columns(load, angle) for angle in (None, math.radians(degrees)))
        note = f"centre of the load at {{:.4f}} mm, of the elements at {place:.4f} mm"
        table += [
            Row(case, SOURCE, "peak, half-spaces [MPa]", peak, plain.pressure, None, note=note.format(centre(plain))),
            Row(case, SOURCE, "peak, wedge [MPa]", peak, wedge.pressure, ASKED, note=note.format(centre(wedge))),
        ]
    return table


def main() -> None:
    """Run, and keep the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=Path, default=Path("reference-fem-runs"), help="directory of the runs")
    keep(parser.parse_args().work)


if __name__ == "__main__":
    main()
