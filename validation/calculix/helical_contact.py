"""Contact of a helical tooth pair in space: compliance of the flanks by finite elements, pressure by complementarity.

Each gear is a whole ring of twenty-node hexahedra (as C3D20R of CalculiX), its bore held. Its stiffness is condensed to
the normal displacements of the nodes near the contact, so that tooth, foundation, body and local deformation are one
field; nothing is a half-space. Pressure is constant on cells along the line of first touch: cells press, or stay apart.
There is no friction.

Run from the root of the repository: ``python -m validation.calculix.helical_contact``. Three meshes take ten minutes of
processor time, 8 GiB, and the package pypardiso, which nothing else needs. Writes two tables of data/.
"""

from __future__ import annotations

import argparse
import ctypes
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array, csr_array, triu

from validation.calculix.helical_mesh import (
    LOADED_HEIGHTS,
    TEETH,
    TORQUE,
    HelicalMeshing,
    HelicalPosition,
    LineRing,
    cosine_at_base,
    course,
    line_ring,
    unmodified,
)
from validation.calculix.ring import serendipity
from validation.calculix.ring_solved import assembled, freedoms_of
from validation.calculix.section import Ints
from validation.calculix.steel import POISSON_RATIO, YOUNGS_MODULUS
from validation.calculix.tables import DATA, provenance, write_table
from validation.calculix.tooth_form import Array

FILE, LINES_FILE = DATA / "helical_relief.csv", DATA / "helical_relief_lines.csv"
POSITIONS, MIDDLE = (120, 122, 123, 124, 126), 123
"""Steps of 1/128 pitch from phi1 = -pi/z on; and the one whose line of first touch the meshes follow."""
MESHINGS = {
    "coarse": HelicalMeshing(across=0.12, along=0.6),
    "medium": HelicalMeshing(across=0.08, along=0.5),
    "fine": HelicalMeshing(across=0.055, along=0.4),
}
TOUCHING, UNDER_LOAD = 0.0097, 0.0435
"""Setbacks of the wheel [mm] at which gaps are taken: the flanks just touch, as in a linear analysis, or overlap where
the load leaves the gears."""
REACH = 0.32
"""Half width of the cells about the line of first touch, along the profile [mm]."""
SHIFT = 0.16
"""Of that line between the positions, and a margin [mm]."""
GAUSS = np.polynomial.legendre.leggauss(3)
MOST_TURNS = 100
SCHUR_COMPLEMENT = {0: 1, 1: 2, 9: 8, 23: 1, 35: 1}
"""Parameters of Pardiso, counted from 0: given here, nested dissection, pivots, two levels, Schur complement."""

NOTES = (
    "Helical pair 25/25, m_n 3 mm, alpha_n 20 deg, beta 27 deg (pinion left-handed), no profile shift, face 12 mm;",
    "root cut by a rack with h_fP 1.25 m and a tip rounding of 0.38 m; bore 0.55 x root diameter, held;",
    f"E {YOUNGS_MODULUS:g} MPa, nu {POISSON_RATIO:g}; no friction. Both gears: parabolic tip relief of 40 um over the",
    "last 1.5 mm of the path of contact; pinion: parabolic lead crowning of 20 um at the ends of the face, helix slope",
    "of 20 um, material off at z > 0. One tooth pair carries 100 N m. Whole rings of hexahedra with 20 nodes and",
    "2 x 2 x 2 points; position i stands at phi1 = (i/64 - 1) pi/25. transmission_error_um is r_b2 (phi2 - phi1)",
    "against the unmodified pair. across_mm, along_mm: elements under the contact; cell_mm: width of the cells of",
    "constant pressure (on halves of elements its peak scatters); setback_mm: of the wheel where gaps are taken;",
    "nodes, seconds of processor time: both gears.",
)
LINES_NOTE = (
    "On the finest mesh and cells: force of each layer of the face, and roll length on the pinion at its centre."
)


def pinion_angle(position: int) -> float:
    """phi1 [rad]."""
    return (position / 64.0 - 1.0) * np.pi / TEETH


def arc_of(radius: Array) -> Array:
    """Length along the profile of the involute from the base circle, s = (r^2 - r_b^2)/(2 r_b) [mm]."""
    base = unmodified().base_radius
    return np.asarray((radius**2 - base**2) / (2.0 * base))


def radius_of(arc: Array) -> Array:
    """Radius at a length along the profile [mm]."""
    base = unmodified().base_radius
    return np.asarray(np.sqrt(base**2 + 2.0 * base * np.maximum(arc, 0.0)))


@dataclass(frozen=True)
class Flank:
    """Loaded flank of a ring: compliance of its nodes near the contact under normal forces.

    Attributes
    ----------
    levels : (layers + 1,) array [mm]
    faces : (layers, n, 8) int array
        Nodes of the faces from the tip down, in the order of ``serendipity``: along the profile, along the face.
    radii : (layers, n, 8) array [mm]
    place : (nodes,) int array
        Of a node in the compliance; -1: it has none.
    compliance : (m, m) array [mm/N]
    """

    levels: Array
    faces: Ints
    radii: Array
    place: Ints
    compliance: Array

    def shares(self, layer: int, height: float, radius: Array) -> tuple[Ints, Array]:
        """Places (k, 8) of the nodes around points of a height in the compliance, and their shape functions there."""
        low, high = self.levels[layer : layer + 2]
        v = 2.0 * (height - low) / (high - low) - 1.0
        first, middle, last = (self.radii[layer] @ serendipity(u, v)[0] for u in (-1.0, 0.0, 1.0))
        face = np.clip(np.searchsorted(-first, -radius) - 1, 0, len(first) - 1)
        slope, bend = 0.5 * (last - first)[face], (0.5 * (first + last) - middle)[face]
        u = np.zeros(len(radius))
        for _ in range(20):  # of a parabola that is nearly straight
            u = (radius - middle[face] - bend * u * u) / slope
        return self.place[self.faces[layer, face]], np.array([serendipity(part, v)[0] for part in u.tolist()])


def unloaded_flank(ring: LineRing, points: Array) -> Flank:
    """Flank of tooth 0 whose places are its nodes (n, 3), without compliance."""
    section = ring.bottom
    sides = section.elements[section.flanks[0]]
    sides = sides[np.argsort(-np.hypot(*section.nodes[sides[:, 4]].T))][:, [0, 1, 4]]
    upright = np.searchsorted(ring.corners, sides[:, :2])
    layers = [
        np.column_stack(
            [
                low[sides[:, :2]],
                high[sides[:, 1::-1]],
                low[sides[:, 2]],
                between[upright[:, 1]],
                high[sides[:, 2]],
                between[upright[:, 0]],
            ]
        )
        for layer in range(ring.layers)
        for low, high, between in [(ring.plane(layer), ring.plane(layer + 1), ring.between(layer))]
    ]
    faces = np.array(layers) - ring.first_node
    radius = np.hypot(points[:, 0], points[:, 1])
    return Flank(ring.levels, faces, radius[faces], np.arange(len(points)), np.zeros((0, 0)))


def flank_of(ring: LineRing, line: Callable[[float], float], reach: float) -> Flank:
    """Flank of a ring whose nodes within a reach [mm] of a line of radii have a compliance."""
    points = ring.coordinates()[:, 1:]
    flank = unloaded_flank(ring, points)
    nodes, (low, high) = np.unique(flank.faces), LOADED_HEIGHTS
    height = points[nodes, 2]
    away = arc_of(np.hypot(*points[nodes, :2].T)) - arc_of(np.array([line(z) for z in height.tolist()]))
    loaded = nodes[(np.abs(away) < reach) & (height > low - 1e-6) & (height < high + 1e-6)]
    place = np.full(len(points), -1)
    place[loaded] = np.arange(len(loaded))
    stiffness, _ = assembled(points, ring.hexahedra()[:, 1:] - ring.first_node)
    held, normals = freedoms_of(ring.bore() - ring.first_node), inward_normals(points[loaded], ring.twist)
    return replace(
        flank, place=place, compliance=normal_compliance(stiffness, held, freedoms_of(loaded[:, None]), normals)
    )


def inward_normals(points: Array, twist: float) -> Array:
    """Unit normals (n, 3) of the involute flank at the larger angle, into the material."""
    base, radius = unmodified().base_radius, np.hypot(points[:, 0], points[:, 1])
    outward = points[:, :2] / radius[:, None]
    onward = np.stack([-outward[:, 1], outward[:, 0]], axis=-1)
    cosine = base / radius
    plane = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))[:, None] * outward + cosine[:, None] * onward
    return np.column_stack([-plane, np.full(len(points), twist * base)]) / np.hypot(1.0, twist * base)


def normal_compliance(stiffness: csr_array, held: Ints, freedoms: Ints, normals: Array) -> Array:
    """Normal displacements (m, m) of m nodes under unit normal forces on each [mm/N].

    Parameters
    ----------
    stiffness : (n, n) sparse array [N/mm]
    held : int array
        Freedoms without displacement.
    freedoms : (m, 3) int array
        Of the loaded nodes along x, y, z.
    normals : (m, 3) array
        Directions of the forces, none of them in the plane z = 0.
    """
    free = np.setdiff1d(np.arange(stiffness.shape[0]), held)
    at = np.searchsorted(free, freedoms)
    others = np.setdiff1d(np.arange(len(free)), at)
    in_plane = np.broadcast_to(np.eye(3)[:, :2], (len(at), 3, 2))
    frames = np.linalg.qr(np.concatenate([normals[:, :, None], in_plane], axis=2))[0]
    frames[:, :, 0] = normals
    rows = np.concatenate([np.repeat(at, 3, axis=1).ravel(), others])
    columns = np.concatenate([np.tile(at, (1, 3)).ravel(), others])
    turned = coo_array((np.concatenate([frames.ravel(), np.ones(len(others))]), (rows, columns)))
    inner = turned.T @ stiffness[free][:, free] @ turned
    return np.asarray(np.linalg.inv(condensed(triu(inner, format="csr"), at[:, 0])))


def condensed(upper: csr_array, kept: Ints) -> Array:
    """Stiffness (m, m) of the kept freedoms while all others are free of load (Schur complement), by Pardiso.

    Parameters
    ----------
    upper : (n, n) sparse array
        Upper triangle of a symmetric positive definite matrix.
    kept : (m,) int array
    """
    from pypardiso import PyPardisoSolver

    solver, size = PyPardisoSolver(mtype=2), upper.shape[0]
    chosen = np.zeros(size, dtype=np.int32)
    chosen[kept] = 1
    for place, value in SCHUR_COMPLEMENT.items():
        solver.iparm[place] = value
    starts, columns = (np.asarray(part + 1, dtype=np.int32) for part in (upper.indptr, upper.indices))
    result, unused, failed = np.zeros((len(kept), len(kept))), np.zeros(size), ctypes.c_int32(0)

    def whole(value: int) -> object:
        return ctypes.byref(ctypes.c_int32(value))

    def numbers(values: Array | Ints) -> object:
        return values.ctypes.data_as(ctypes.POINTER(np.ctypeslib.as_ctypes_type(values.dtype)))

    analysis_and_factors = 12
    solver._mkl_pardiso(
        solver.pt.ctypes.data_as(ctypes.POINTER(solver._pt_type[0])), whole(1), whole(1), whole(2),
        whole(analysis_and_factors), whole(size), numbers(upper.data), numbers(starts), numbers(columns),
        numbers(chosen), whole(1), numbers(solver.iparm), whole(0), numbers(unused), numbers(result),
        ctypes.byref(failed),
    )  # fmt: skip
    if failed.value:
        raise RuntimeError(f"Pardiso: error {failed.value}")
    solver.free_memory(everything=True)
    return result


@dataclass(frozen=True)
class Cells:
    """Cells of the contact at one position, layer after layer.

    Attributes
    ----------
    layer : (n,) int array
    roll, height : (n,) arrays [mm]
        Middles: roll length on the pinion, and height.
    area : (n,) array [mm^2]
    gap : (n,) array [mm]
        Along the normal, the mean over a cell, at the pinion angle and the setback.
    loads : pair of sparse arrays
        Forces on the nodes of pinion and wheel under unit pressure (m, n) [mm^2].
    """

    layer: Ints
    roll: Array
    height: Array
    area: Array
    gap: Array
    loads: tuple[csr_array, csr_array]

    @property
    def outermost(self) -> Array:
        """Cells (n,) at either end of a layer: they must carry nothing."""
        ends = np.diff(self.layer) > 0
        return np.append(True, ends) | np.append(ends, True)


def cells(position: HelicalPosition, flanks: tuple[Flank, Flank], width: float) -> Cells:
    """Cells of a width [mm] along the line of first touch, in every fine layer."""
    levels, (low, high) = flanks[0].levels, LOADED_HEIGHTS
    count, steps = 0, np.arange(-round(REACH / width), round(REACH / width)) * width
    table: list[tuple[float, ...]] = []
    entries: tuple[list[Array], list[Array]] = ([], [])
    for layer in np.flatnonzero((levels[:-1] > low - 1e-6) & (levels[1:] < high + 1e-6)).tolist():
        for start in steps.tolist():
            cell = _cell(position, flanks, layer, start, width)
            if cell is not None:
                table.append((layer, *cell[0]))
                for of_gear, (places, forces) in zip(entries, cell[1], strict=True):
                    of_gear.append(np.stack([places, np.full(len(places), count), forces]))
                count += 1
    loads = []
    for of_gear, flank in zip(entries, flanks, strict=True):
        rows, columns, forces = np.concatenate(of_gear, axis=1)
        shape = len(flank.compliance), count
        loads.append(coo_array((forces, (rows.astype(int), columns.astype(int))), shape=shape).tocsr())
    layers, *others = np.array(table).T
    return Cells(layers.astype(int), *others, loads=(loads[0], loads[1]))


def _cell(
    position: HelicalPosition, flanks: tuple[Flank, Flank], layer: int, start: float, width: float
) -> tuple[tuple[float, float, float, float], list[tuple[Array, Array]]] | None:
    """Roll, height, area and gap of a cell, places and forces of both gears; None beyond flanks and compliances."""
    bottom, top = flanks[0].levels[layer : layer + 2]
    (parts, weights), cosine, gap = GAUSS, cosine_at_base(), 0.0
    loads: tuple[list[Array], list[Array]] = ([], [])
    for height, weight in zip(0.5 * (bottom + top + (top - bottom) * parts), 0.5 * weights, strict=True):
        here = course(position, float(height))
        radius = radius_of(arc_of(here.touched[0]) + start + 0.5 * width * (1.0 + parts))
        if radius[0] < here.pinion[0] or radius[-1] > here.pinion[-1]:
            return None
        share = 0.5 * weight * weights
        gap += float(share @ np.interp(radius, here.pinion, here.gap)) * cosine
        for of_gear, flank, at in zip(loads, flanks, (radius, np.interp(radius, here.pinion, here.wheel)), strict=True):
            places, shapes = flank.shares(layer, float(height), at)
            if places.min() < 0:
                return None
            of_gear.append(np.stack([places.ravel(), (shapes * share[:, None]).ravel()]))
    area, middle = width * (top - bottom) / cosine, 0.5 * (bottom + top)
    arc = arc_of(course(position, middle).touched[0]) + start + 0.5 * width
    roll = float(np.sqrt(2.0 * unmodified().base_radius * arc))
    both = [np.concatenate(of_gear, axis=1) for of_gear in loads]
    return (roll, middle, area, gap), [(places, area * forces) for places, forces in both]


def pressures(compliance: Array, gap: Array, area: Array, force: float) -> tuple[Array, float]:
    """Pressure [MPa] of cells that press or stay apart, and the normal approach of the bodies [mm].

    Parameters
    ----------
    compliance : (n, n) array
        Displacement integrated over one cell under unit pressure on another [mm^3/MPa].
    gap, area : (n,) arrays [mm], [mm^2]
    force : float [N]
    """
    presses = gap < np.quantile(gap, 0.3)
    for _ in range(MOST_TURNS):
        inner = compliance[np.ix_(presses, presses)]
        even, uneven = np.linalg.solve(inner, np.stack([area, area * gap], axis=-1)[presses]).T
        approach = float((force + area[presses] @ uneven) / (area[presses] @ even))
        pressure = np.zeros(len(gap))
        pressure[presses] = approach * even - uneven
        apart = gap + compliance @ pressure / area - approach
        wanted = np.where(presses, pressure > 0.0, apart < 0.0)
        if (wanted == presses).all():
            return pressure, approach
        presses = wanted
    raise RuntimeError(f"the contact is not settled after {MOST_TURNS} turns")


def both_flanks(meshing: HelicalMeshing) -> tuple[Flank, Flank]:
    """Flanks of pinion and wheel, fine along their line of first touch at the middle position."""
    position = HelicalPosition(pinion_angle(MIDDLE), TOUCHING)
    flanks = []
    for gear, hand in enumerate((-1, 1)):

        def line(height: float, gear: int = gear) -> float:
            return course(position, height).touched[gear]

        flanks.append(flank_of(line_ring(line, hand, meshing), line, REACH + SHIFT + 2.0 * meshing.across))
    return flanks[0], flanks[1]


def loaded(
    position: int, flanks: tuple[Flank, Flank], width: float, setback: float = TOUCHING
) -> tuple[dict[str, float], list[dict[str, float]]]:
    """Transmission error and peak pressure at a position, and the line load with its place layer by layer."""
    grid = cells(HelicalPosition(pinion_angle(position), setback), flanks, width)
    compliance = sum(load.T @ flank.compliance @ load for load, flank in zip(grid.loads, flanks, strict=True))
    force = 1e3 * TORQUE / (unmodified().base_radius * cosine_at_base())
    pressure, approach = pressures(np.asarray(compliance), grid.gap, grid.area, force)
    if pressure[grid.outermost].any():
        raise RuntimeError("the contact is wider than its cells")
    state = {
        "position": position,
        "pinion_angle_rad": pinion_angle(position),
        "transmission_error_um": -1e3 * (setback + approach / cosine_at_base()),
        "peak_pressure_MPa": float(pressure.max()),
    }
    lines = []
    for layer in np.unique(grid.layer).tolist():
        carried = np.where(grid.layer == layer, pressure * grid.area, 0.0)
        low, high = flanks[0].levels[layer : layer + 2]
        if carried.any():
            roll = float(carried @ grid.roll / carried.sum())
            lines.append(
                {"position": position, "low_mm": low, "high_mm": high, "force_N": carried.sum(), "roll_mm": roll}
            )
    return state, lines


def keep(directory: Path = DATA) -> None:
    """Solve on all meshes, and write both tables."""
    states: list[dict[str, object]] = []
    lines: list[dict[str, float]] = []
    for name, meshing in MESHINGS.items():
        start = time.process_time()
        flanks = both_flanks(meshing)
        of_mesh = {"nodes": sum(len(flank.place) for flank in flanks), "seconds": time.process_time() - start}
        half = 0.5 * meshing.across
        for cell, setback in ((meshing.across, TOUCHING), (half, UNDER_LOAD), (half, TOUCHING)):
            sizes = {"mesh": name, "across_mm": meshing.across, "along_mm": meshing.along, "cell_mm": cell}
            solved = [loaded(position, flanks, cell, setback) for position in POSITIONS]
            states += [sizes | {"setback_mm": setback} | state | of_mesh for state, _ in solved]
        lines = [line for _, of_position in solved for line in of_position]
    head = provenance("validation.calculix.helical_contact", NOTES, ())
    head[0] = head[0].replace("make reference-fem", "python -m validation.calculix.helical_contact")
    write_table(directory / FILE.name, head, states)
    write_table(directory / LINES_FILE.name, [*head, LINES_NOTE], lines)


def main() -> None:
    """Solve, and keep the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=DATA, help="directory of the tables")
    keep(parser.parse_args().out)


if __name__ == "__main__":
    main()
