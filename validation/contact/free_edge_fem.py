"""A quarter-space beside a half-space by finite elements: ``python -m validation.contact.free_edge_fem``.

It takes some minutes.

Half a Hertz circle of radius 1 is pressed on the edge; both blocks are cut in half by the plane of symmetry and held
far away. Linear hexahedra, even beside the circle and growing away from it, the same for both, so that their errors
cancel in the ratio. By the formula the ratio is 1 + psi on the edge.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import diags_array
from scipy.sparse.linalg import cg
from skfem import Basis, ElementHex1, ElementVector, FacetBasis, LinearForm, MeshHex
from skfem.models.elasticity import lame_parameters, linear_elasticity

from loaded_tca.contact import quarter_space_factor

Array = NDArray[np.float64]

STEP, EVEN_TO, GROWTH, FARTHEST = 0.15, 1.2, 1.3, 20.0


def graded() -> Array:
    """Bounds of the elements from zero outwards."""
    bounds = list(np.arange(0.0, EVEN_TO + 0.5 * STEP, STEP))
    while bounds[-1] < FARTHEST:
        bounds.append(bounds[-1] + GROWTH * (bounds[-1] - bounds[-2]))
    return np.array(bounds)


def displacement(across: Array, poisson_ratio: float) -> tuple[float, float]:
    """Displacement (times E) at the middle of the circle and weighted with the pressure; ``across`` leaves the edge."""
    outward = graded()
    mesh = MeshHex.init_tensor(outward, across, outward)
    element = ElementVector(ElementHex1())
    basis = Basis(mesh, element)
    top = FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: np.isclose(x[2], 0.0)), intorder=8)
    stiffness, load = linear_elasticity(*lame_parameters(1.0, poisson_ratio)).assemble(basis), _pressure.assemble(top)
    far = outward[-1] - 1e-9
    held = basis.get_dofs(lambda x: (x[0] > far) | (np.abs(x[1]) > far) | (x[2] > far)).all()
    symmetric = basis.get_dofs(lambda x: np.isclose(x[0], 0.0)).all("u^1")
    free = basis.complement_dofs(np.union1d(held, symmetric))
    inner = stiffness[free][:, free]
    solved, failed = cg(inner, load[free], rtol=1e-7, M=diags_array(1.0 / inner.diagonal()))
    assert not failed, "conjugate gradients did not converge"
    moved = np.zeros(load.size)
    moved[free] = solved
    middle = int(np.argmin((mesh.p**2).sum(axis=0)))
    return float(moved[basis.nodal_dofs[2, middle]]), float(load @ moved)


@LinearForm
def _pressure(v, w):  # type: ignore[no-untyped-def]
    """Hertz pressure on the half of the circle inside the edge."""
    return np.sqrt(np.maximum(0.0, 1.0 - w.x[0] ** 2 - w.x[1] ** 2)) * (w.x[1] > 0.0) * v[2]


def main() -> None:
    """Print the ratios of the displacements of both blocks."""
    outward = graded()
    for nu in (0.0, 0.3):
        quarter = displacement(outward, nu)
        half = displacement(np.concatenate((-outward[:0:-1], outward)), nu)
        edge, mean = (one / other for one, other in zip(quarter, half, strict=True))
        print(f"nu {nu:g}: on the edge {edge:.3f} (1 + psi: {1.0 + quarter_space_factor(nu):.3f}), mean {mean:.3f}")


if __name__ == "__main__":
    main()
