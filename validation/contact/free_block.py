"""A block with free ends against the half-space with its free edges; as a script, the finite elements (20 min).

A block as long as the face, 20 mm, both ends free, carries line loads of a Hertz profile over parts of its length.
What is compared is the displacement of the loaded face less that half a tooth thickness below it: beneath, teeth are
their own finite elements. Kept: its matrix, load by load. A plane section of the same elements says what the block's
sides and base change, which is not of its ends.

Source: ``python -m validation.contact.free_block``, 27-node hexahedra, 14 mm wide to either side and deep, base held.
"""

import json
import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import diags_array
from scipy.sparse.linalg import cg, splu
from skfem import (
    Basis,
    ElementHex2,
    ElementQuad2,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshHex,
    MeshQuad,
)
from skfem.models.elasticity import lame_parameters, linear_elasticity

from loaded_tca.compliance.flexibility import depth_displacement
from loaded_tca.edges.free import DEPTH, edge_compliance
from loaded_tca.material import Material
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import parse_scene
from loaded_tca.separation import Separation, sample_separation
from loaded_tca.unloaded import trace_contact
from validation.calculix.comparison import SCENE
from validation.table import Row

Array = NDArray[np.float64]

STEEL = Material(206000.0, 0.3)
ENERGY = linear_elasticity(*lame_parameters(STEEL.youngs_modulus, STEEL.poisson_ratio))
MODULE, HALF_LENGTH, WIDTH, HALF_WIDTH = 3.0, 10.0, 14.0, 0.15
"""Module of the gears whose teeth the block stands for; half length of the block, its half width and depth; half width
of the Hertz profile [mm]."""
MIDDLE = DEPTH * MODULE
KEPT = Path(__file__).parent / "data" / "free_block.json"
SOURCE = "block with free ends, finite elements"
ASKED, AT_THE_END = 2e-2, 4e-2
"""Of the mean over the face; of single places, the end among them."""
CELLS = (16, 402)
"""Of the grid that stands for the contact: 400 along the face, and one beyond either end."""


def graded(first: float, growth: float, end: float, even: int, longest: float = math.inf) -> Array:
    """Bounds of elements from zero on, the first ``even`` ones of equal length."""
    bounds = [first * k for k in range(even + 1)]
    while bounds[-1] < end:
        bounds.append(bounds[-1] + min(growth * (bounds[-1] - bounds[-2]), longest))
    return np.array(bounds) * end / bounds[-1]


def bounds() -> tuple[Array, Array, Array]:
    """Bounds of the elements across (from the plane of symmetry), along (from the free end) and down."""
    across, down = graded(0.5 * HALF_WIDTH, 1.5, WIDTH, 3), graded(HALF_WIDTH / 3.0, 1.5, WIDTH, 2)
    down[np.argmin(np.abs(down - MIDDLE))] = MIDDLE
    return across, graded(0.04, 1.4, HALF_LENGTH, 2, 1.5), down


def profile(x: Array) -> Array:
    """Hertz pressure of a unit line load."""
    return 2.0 / (math.pi * HALF_WIDTH) * np.sqrt(np.maximum(0.0, 1.0 - (x / HALF_WIDTH) ** 2))


def block() -> Array:
    """Displacement of the loaded face less that in the middle under line loads on single parts: (n, n) [mm per N/mm].

    Row: the part, averaged with the profile; column: the loaded part.
    """
    across, along, down = bounds()
    mesh, element = MeshHex.init_tensor(across, along, down), ElementVector(ElementHex2())
    basis = Basis(mesh, element, intorder=4)
    top = mesh.facets_satisfying(lambda x: np.isclose(x[2], 0.0) & (x[0] < 2.0 * HALF_WIDTH))
    face = FacetBasis(mesh, element, facets=top, intorder=14)
    held = np.unique(
        np.concatenate(
            [
                basis.get_dofs(lambda x: np.isclose(x[2], WIDTH)).all(),
                basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all("u^1"),
                basis.get_dofs(lambda x: np.isclose(x[1], HALF_LENGTH)).all("u^2"),
            ]
        )
    )
    free = basis.complement_dofs(held)
    stiffness = ENERGY.assemble(basis)[free][:, free]
    inverse = diags_array(1.0 / stiffness.diagonal())
    places = basis.doflocs
    dofs = np.concatenate([part[2] for part in (basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs)])
    dofs = np.concatenate([dofs, basis.edge_dofs[2]])
    below = dofs[np.isclose(places[0, dofs], 0.0) & np.isclose(places[2, dofs], MIDDLE)]
    below = below[np.argsort(places[1, below])]
    middles, lengths = 0.5 * (along[1:] + along[:-1]), np.diff(along)
    loads, displaced = [], []
    for first, last in pairwise(along):
        load = LinearForm(lambda v, w, a=first, b=last: profile(w.x[0]) * (w.x[1] > a) * (w.x[1] < b) * v[2])
        loads.append(load.assemble(face))
        moved = np.zeros(basis.N)
        # symmetric halves: the load of both sides is twice that on this one
        moved[free], failed = cg(stiffness, loads[-1][free], rtol=1e-8, maxiter=20000, M=inverse)
        assert not failed, "conjugate gradients did not converge"
        displaced.append(moved)
    surface = 2.0 * np.array(loads) @ np.array(displaced).T / lengths[:, None]
    middle = np.array([np.interp(middles, places[1, below], moved[below]) for moved in displaced]).T
    return np.asarray(surface - middle)


def plane() -> float:
    """The same for an endless block under an even load, from a section of the same elements [mm per N/mm]."""
    across, _, down = bounds()
    mesh, element = MeshQuad.init_tensor(across, down), ElementVector(ElementQuad2())
    basis = Basis(mesh, element, intorder=4)
    top = mesh.facets_satisfying(lambda x: np.isclose(x[1], 0.0) & (x[0] < 2.0 * HALF_WIDTH))
    face = FacetBasis(mesh, element, facets=top, intorder=14)
    load = LinearForm(lambda v, w: profile(w.x[0]) * v[1]).assemble(face)
    base = basis.get_dofs(lambda x: np.isclose(x[1], WIDTH)).all()
    free = basis.complement_dofs(np.union1d(base, basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all("u^1")))
    moved = np.zeros(basis.N)
    moved[free] = splu(
        linear_elasticity(*lame_parameters(STEEL.youngs_modulus, STEEL.poisson_ratio))
        .assemble(basis)[free][:, free]
        .tocsc()
    ).solve(load[free])
    places = basis.doflocs
    middle = np.isclose(places[0], 0.0) & np.isclose(places[1], MIDDLE)  # moves down alone
    return float(2.0 * load @ moved - moved[middle].max())


def half_plane() -> float:
    """The same of a half-plane in closed form (Johnson 1985, eqs. 2.15 and 2.19) [mm per N/mm]."""
    nu, modulus = STEEL.poisson_ratio, math.pi * STEEL.youngs_modulus
    return 2.0 * (1.0 - nu**2) / modulus * (math.log(2.0 * MIDDLE / HALF_WIDTH) + 0.25) - (1.0 + nu) / modulus


@dataclass(frozen=True)
class Deformation:
    """Displacements (n, n) [mm per N/mm] of parts of the face, less those beneath them, under line loads on each.

    ``distance`` (n,) of the parts' middles from the free end, ``length`` (n,) of the parts [mm].
    """

    distance: Array
    length: Array
    matrix: Array

    def even(self) -> Array:
        """Displacements under an even load (n,)."""
        return self.matrix.sum(axis=1)

    def flush(self) -> Array:
        """Line load that displaces all parts alike, over its mean (n,)."""
        load = np.linalg.solve(self.matrix, np.ones(self.length.size))
        return np.asarray(load * self.length.sum() / (load @ self.length))


def kept() -> Deformation:
    """What the finite elements gave."""
    found = json.loads(KEPT.read_text())
    along = np.array(found["bounds"])
    return Deformation(0.5 * (along[1:] + along[:-1]), np.diff(along), np.array(found["matrix"]))


def modelled(sides_and_base: float, free_edges: bool = True) -> Deformation:
    """Half-space and free edges of one of two equal gears, and what ``sides_and_base`` of the block add in a plane."""
    pair: GearPair = parse_scene(SCENE.format(face_width=2.0 * HALF_LENGTH)).pair()
    length = 2.0 * HALF_LENGTH / (CELLS[1] - 2)
    box = (2.0 * HALF_WIDTH, 0.5 * CELLS[1] * length)
    grid: Separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=CELLS, box=box)
    apart = np.abs(grid.y[:, None] - grid.y)
    matrix = _half_space(apart, length) - depth_displacement(np.array(MIDDLE), apart, STEEL)
    ends = edge_compliance(pair, grid)
    assert ends is not None
    matrix = matrix + (0.5 * ends if free_edges else 0.0) + sides_and_base / (2.0 * HALF_LENGTH)
    inside = slice(1, -1)
    matrix, y = matrix[inside, inside] * length, grid.y[inside]
    half = y.size // 2
    folded = matrix[:half, :half] + matrix[:half, half:][:, ::-1]
    return Deformation(y[:half] - y[0] + 0.5 * length, np.full(half, length), folded)


def _half_space(apart: Array, length: float) -> Array:
    """Displacement of slices under unit forces on each, means over the profile [mm/N]."""
    found, logarithm = np.zeros_like(apart), 0.0
    places = [np.arange(1, n + 1) * math.pi / (n + 1) for n in (12, 13)]  # Gauss and Chebyshev, no place in both
    for one in places[0]:
        for other in places[1]:
            weight = 4.0 * math.sin(one) ** 2 * math.sin(other) ** 2 / (13 * 14)
            aside = HALF_WIDTH * abs(math.cos(one) - math.cos(other))
            found += weight * (np.arcsinh((apart + 0.5 * length) / aside) - np.arcsinh((apart - 0.5 * length) / aside))
            logarithm += weight * math.log(aside)
    # of a slice under itself the quadrature misses the logarithm, whose mean is ln(b/2) - 1/4
    found[np.diag_indices_from(found)] += 2.0 * (logarithm - math.log(0.5 * HALF_WIDTH) + 0.25)
    return found * (1.0 - STEEL.poisson_ratio**2) / (math.pi * STEEL.youngs_modulus * length)


def rows() -> list[Row]:
    """Deformation under an even load over the face, and the load that deforms all of it alike."""
    reference, sides_and_base = kept(), plane() - half_plane()
    found = []
    for name, free_edges in (("free edges", True), ("half-space", False)):
        model = modelled(sides_and_base, free_edges)
        mean, asked = (float(np.average(one.even(), weights=one.length)) for one in (reference, model))
        judged = ASKED if free_edges else None
        found.append(
            Row(f"block, {name}", SOURCE, "even load, mean deformation [nm per N/mm]", 1e6 * mean, 1e6 * asked, judged)
        )
        for place in (0.1, 0.5, 2.0, 10.0):
            one, other = (np.interp(place, part.distance, part.even()) for part in (reference, model))
            what = f"even load, {place:g} mm from the end [nm per N/mm]"
            found.append(
                Row(f"block, {name}", SOURCE, what, 1e6 * one, 1e6 * other, AT_THE_END if free_edges else None)
            )
        for place in (0.1, 0.2, 0.5, 2.0):
            judged = AT_THE_END if free_edges and place > 0.1 else None  # within the half width of the contact: shown
            one, other = (np.interp(place, part.distance, part.flush()) for part in (reference, model))
            what = f"flush contact, line load {place:g} mm from the end over its mean"
            found.append(Row(f"block, {name}", SOURCE, what, one, other, judged))
    return found


def main() -> None:
    """Run the finite elements and keep their matrix."""
    KEPT.parent.mkdir(exist_ok=True)
    matrix = [[float(f"{value:.6g}") for value in row] for row in block()]
    KEPT.write_text(json.dumps({"bounds": bounds()[1].round(9).tolist(), "matrix": matrix}, indent=1) + "\n")


if __name__ == "__main__":
    main()
