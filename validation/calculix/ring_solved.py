"""The spur ring in space under line loads of any course along the face, solved here on a coarser mesh of the runs.

Twenty-node hexahedra with 2 x 2 x 2 points of integration, as C3D20R of CalculiX, in NumPy and SciPy alone; by
conjugate gradients. What an uneven load adds to the largest tension is a ratio, which the mesh changes little: for the
load from nothing to twice the mean it is within 0.1 % of that of the kept runs of CalculiX.

Run from the root of the repository: ``python -m validation.calculix.ring_solved``; writes data/ring_loads.csv.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import cg

from validation.calculix.case import FACE_WIDTH
from validation.calculix.pairs_in_space import read_in_space
from validation.calculix.ring import LoadedRing, RingMeshing, loaded_ring
from validation.calculix.ring_run import LINE_LOAD, loaded_line, pinion
from validation.calculix.section import Ints
from validation.calculix.steel import POISSON_RATIO, YOUNGS_MODULUS
from validation.calculix.tables import CROWNED_FILE, DATA, provenance, read_table, write_table
from validation.calculix.tooth_form import Array

FILE = DATA / "ring_loads.csv"
MESHING = RingMeshing(fillet=0.5, flank=1.2, beside=3.5, far=8.0, end=1.0, layer=3.4)
CLOSE = 1e-6
"""Of the forces that the solution leaves, over all forces."""
MOST_ITERATIONS = 20_000
EVEN, UNEVEN, CROWNED = "even", "uneven", "crowned"

CORNERS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
MIDDLES = [(0, -1, -1), (1, 0, -1), (0, 1, -1), (-1, 0, -1), (0, -1, 1), (1, 0, 1), (0, 1, 1), (-1, 0, 1)]
UPRIGHT = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
PLACES = np.array([*CORNERS, *MIDDLES, *UPRIGHT], dtype=float)
"""Nodes of a hexahedron, as the decks number them."""


def slopes(place: Array) -> Array:
    """Slopes (20, 3) of the shape functions at a place (3,) of the cube from -1 to 1."""
    product = 1.0 + PLACES * place
    found = np.zeros((20, 3))
    for axis in range(3):
        one, other = (product[:, k] for k in range(3) if k != axis)
        own, at = PLACES[:, axis], place[axis]
        corner = 0.125 * own * one * other * ((PLACES @ place - 2.0) + product[:, axis])
        bubbles = [k for k in range(3) if k != axis]
        middle = (
            0.25
            * own
            * np.prod(
                np.stack([np.where(PLACES[:, k] == 0.0, 1.0 - place[k] ** 2, product[:, k]) for k in bubbles]), axis=0
            )
        )
        across = -0.5 * at * one * other
        edge = (PLACES == 0.0).any(axis=1)
        found[:, axis] = np.where(edge, np.where(own == 0.0, across, middle), corner)
    return found


def elasticity() -> Array:
    """Matrix (6, 6) [MPa]: xx, yy, zz, xy, yz, zx (engineering shears)."""
    nu = POISSON_RATIO
    factor = YOUNGS_MODULUS / ((1.0 + nu) * (1.0 - 2.0 * nu))
    matrix = np.diag([1.0 - nu] * 3 + [0.5 - nu] * 3)
    matrix[:3, :3] += nu * (1.0 - np.eye(3))
    return factor * matrix


def assembled(points: Array, elements: Ints) -> tuple[csr_array, list[Array]]:
    """Stiffness (3 n, 3 n) of hexahedra without supports, and their strains (m, 6, 60) at each point of integration."""
    matrix, count, size = elasticity(), len(elements), 3 * len(points)
    stiffness, strains, gauss = np.zeros((count, 60, 60)), [], np.array(CORNERS) / math.sqrt(3.0)
    for place in gauss:
        slope = slopes(place)
        jacobian = np.einsum("ka,mkb->mab", slope, points[elements])
        x, y, z = np.moveaxis(np.einsum("mab,kb->mka", np.linalg.inv(jacobian), slope), -1, 0)
        strain = np.zeros((count, 6, 60))
        strain[:, 0, 0::3] = strain[:, 3, 1::3] = strain[:, 5, 2::3] = x
        strain[:, 1, 1::3] = strain[:, 3, 0::3] = strain[:, 4, 2::3] = y
        strain[:, 2, 2::3] = strain[:, 4, 1::3] = strain[:, 5, 0::3] = z
        stiffness += np.linalg.det(jacobian)[:, None, None] * (strain.transpose(0, 2, 1) @ matrix @ strain)
        strains.append(strain)
    freedoms = freedoms_of(elements)
    rows, columns = np.repeat(freedoms, 60, axis=1), np.tile(freedoms, (1, 60))
    whole = coo_array((stiffness.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()
    return whole, strains


def freedoms_of(nodes: Ints) -> Ints:
    """Numbers (m, 3 k) of the displacements of nodes (m, k)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], -1)


def nodal_stresses(loaded: LoadedRing, forces: Mapping[str, Mapping[int, Array]]) -> dict[str, Array]:
    """Stress of all nodes (n, 6) [MPa] by load: xx, yy, zz, xy, yz, zx; the bore is held."""
    ring = loaded.ring
    points, elements = ring.coordinates()[:, 1:], ring.hexahedra()[:, 1:] - ring.first_node
    matrix, size = elasticity(), 3 * len(points)
    whole, strains = assembled(points, elements)
    freedoms = freedoms_of(elements)
    held = freedoms_of(ring.bore() - ring.first_node)
    free = np.setdiff1d(np.arange(size), held)
    inner = whole[free][:, free]
    scale = diags_array(1.0 / inner.diagonal())
    a, b, c = math.sqrt(3.0) * PLACES.T
    signs = np.array(CORNERS)
    extrapolated = np.stack([0.125 * (1 + s * a) * (1 + t * b) * (1 + u * c) for s, t, u in signs], axis=-1)
    found = {}
    for name, nodal in forces.items():
        load = np.zeros((len(points), 3))
        load[np.array(list(nodal)) - ring.first_node] = np.array(list(nodal.values()))
        displacement = np.zeros(size)
        displacement[free], failed = cg(inner, load.ravel()[free], rtol=CLOSE, maxiter=MOST_ITERATIONS, M=scale)
        if failed:
            raise RuntimeError(f"load {name}: not solved in {MOST_ITERATIONS} iterations")
        own = displacement[freedoms]
        at_points = np.stack([(strain @ own[..., None])[..., 0] @ matrix for strain in strains], axis=1)
        total, times = np.zeros((len(points), 6)), np.zeros(len(points))
        np.add.at(total, elements, extrapolated @ at_points)
        np.add.at(times, elements, 1.0)
        found[name] = total / times[:, None]
    return found


def crowned_load() -> tuple[Array, Array]:
    """Heights [mm] and line load [N/mm] of the kept crowned pair of finite elements over the whole face."""
    kept = read_in_space(CROWNED_FILE)
    if kept is None:
        raise FileNotFoundError(CROWNED_FILE)
    upper = np.append(kept.line_load, max(2.0 * kept.line_load[-1] - kept.line_load[-2], 0.0))
    half = (np.arange(len(kept.line_load)) + 0.5) * 0.5 * FACE_WIDTH / len(kept.line_load)
    heights = np.append(half, 0.5 * FACE_WIDTH)
    load = np.concatenate([upper[::-1], [kept.peak_line_load], upper])
    return np.concatenate([-heights[::-1], [0.0], heights]), load


def line_loads() -> dict[str, Callable[[float], float]]:
    """Line loads [N/mm] over the height from mid-face [mm], all of the same force."""
    heights, load = crowned_load()
    mean = float(np.trapezoid(load, heights)) / FACE_WIDTH
    return {
        EVEN: lambda _: LINE_LOAD,
        UNEVEN: lambda height: LINE_LOAD * (1.0 + 2.0 * height / FACE_WIDTH),
        CROWNED: lambda height: LINE_LOAD * float(np.interp(height, heights, load)) / mean,
    }


def largest(meshing: RingMeshing = MESHING) -> dict[str, tuple[float, float]]:
    """Largest tension of the loaded fillet by load [MPa], and its height [mm]."""
    form, rolls = pinion("spur"), loaded_line("spur")
    loaded = loaded_ring(form, FACE_WIDTH, math.hypot(form.base_radius, rolls[0]), meshing)
    forces = {name: loaded.forces(rolls, course) for name, course in line_loads().items()}
    found = {}
    for name, nodal in nodal_stresses(loaded, forces).items():
        along = loaded.stress(nodal)[1][0].max(axis=0)
        found[name] = float(along.max()), float(loaded.ring.levels[along.argmax()])
    return found


def read(path: Path = FILE) -> dict[str, float]:
    """Kept largest tensions [MPa] by load."""
    return {str(row["load"]): float(row["tension_MPa"]) for row in read_table(path)}


def keep(path: Path = FILE) -> None:
    """Solve, write the table."""
    notes = (
        "Spur pinion of 25 teeth, m 3 mm, face 20 mm, as the kept rings, loaded along d 75.956 mm by 100 N/mm in the",
        "mean: even; uneven, from 0 at one end to 200 N/mm; crowned, the course of the line load of the kept crowned",
        f"pair. E {YOUNGS_MODULUS:g} MPa, nu {POISSON_RATIO:g}; elements of {MESHING.fillet:g} mm on the fillets.",
        "Largest tension of the loaded fillet.",
    )
    head = provenance("validation.calculix.ring_solved", (), notes)
    head[0] = head[0].replace("make reference-fem", "python -m validation.calculix.ring_solved")
    rows = [{"load": name, "tension_MPa": stress, "height_mm": at} for name, (stress, at) in largest().items()]
    write_table(path, head, rows)


def main() -> None:
    """Solve, and keep the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=FILE)
    keep(parser.parse_args().out)


if __name__ == "__main__":
    main()
