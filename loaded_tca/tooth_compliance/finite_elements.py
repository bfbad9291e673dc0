"""Quadratic serendipity elements on a logical mesh: numbers of the nodes, matrices of the elements.

Shape functions and quadrature are those of scikit-fem; the rest is what a logical mesh allows, all elements at once. It
works in the plane (plane strain) and in space alike. Degrees of freedom are dimension * node + component.

References
----------
Gustafsson, McBain 2020, scikit-fem: A Python package for finite element assembly, JOSS 5(52), 2369.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.errors import GeometryError
from loaded_tca.flanks.jet import Array
from loaded_tca.material import Material

Indices = NDArray[np.int_]
QUADRATURE_ORDER = 4
"""Three points in each direction."""


@dataclass(frozen=True, eq=False)
class Discretisation:
    """Elements between nodes on a grid of whole coordinates, two to an element.

    Attributes
    ----------
    number : int array
        Numbers of the nodes by their whole coordinates; -1 where there is none.
    points : (nodes, d) array [mm]
        Where they stand.
    elements : (n, k) int array
        Nodes of each element.
    lowest : (n, d) int array
        Lowest whole coordinates of each element.
    products : (n, k d, k d) array [mm^(d - 2)]
        Integrals of the products of the derivatives of any two shape functions, over each element.
    """

    number: Indices
    points: Array
    elements: Indices
    lowest: Indices
    products: Array

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return int(self.points.shape[1])

    @property
    def dofs(self) -> Indices:
        """Degrees of freedom of each element (n, k d)."""
        d = self.dimension
        return (d * self.elements[:, :, None] + np.arange(d)).reshape(len(self.elements), -1)

    def stiffness(self, material: Material) -> Array:
        r"""Stiffness matrices (n, k d, k d) of the elements [N/mm]; in the plane per mm of width, strain being plane.

        .. math:: K_{ia,jb} = \int \lambda\,\phi_{i,a}\phi_{j,b} + \mu\,\phi_{i,b}\phi_{j,a}
                  + \mu\,\delta_{ab} \nabla\phi_i\cdot\nabla\phi_j
        """
        n, k, d = *self.elements.shape, self.dimension
        shear = 0.5 * material.youngs_modulus / (1.0 + material.poisson_ratio)
        lame = 2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio)
        products = self.products.reshape(n, k, d, k, d)
        matrices = lame * products + shear * products.transpose(0, 1, 4, 3, 2)
        trace = shear * sum(products[:, :, a, :, a] for a in range(d))
        for a in range(d):
            matrices[:, :, a, :, a] += trace
        return matrices.reshape(n, k * d, k * d)


def discretise(points: Array, lowest: Indices) -> Discretisation:
    """Number the nodes of a logical mesh and integrate over its elements.

    Parameters
    ----------
    points : (..., d) array [mm]
        Nodes by their d whole coordinates, of which the first closes to a ring.
    lowest : (n, d) int array
        Lowest node of each element; its others are up to 2 further.

    Raises
    ------
    GeometryError
        If an element is turned inside out.
    """
    shape, d = points.shape[:-1], points.shape[-1]
    element = _element(d)
    nodes = np.rint(2.0 * np.asarray(element.doflocs)).astype(int) + lowest[:, None]
    nodes[..., 0] %= shape[0]
    used, elements = np.unique(np.ravel_multi_index(tuple(np.moveaxis(nodes, -1, 0)), shape), return_inverse=True)
    number = np.full(shape, -1)
    number.reshape(-1)[used] = np.arange(len(used))
    found = points.reshape(-1, d)[used]
    elements = elements.reshape(nodes.shape[:2])
    return Discretisation(number, found, elements, lowest, _products(element, found[elements]))


def _element(dimension: int) -> Any:
    """Serendipity element of scikit-fem."""
    from skfem import ElementHexS2, ElementQuadS2  # on use: it takes half a second

    return {2: ElementQuadS2, 3: ElementHexS2}[dimension]()


def _products(element: Any, corners: Array) -> Array:
    """Integrals (n, k d, k d) of products of derivatives, from the nodes (n, k, d) of the elements."""
    from skfem.quadrature import get_quadrature

    places, weights = get_quadrature(element, QUADRATURE_ORDER)
    n, k, d = corners.shape
    local = np.stack([element.lbasis(places, i)[1] for i in range(k)])  # (k, d, q)
    jacobian = (corners.transpose(0, 2, 1).reshape(n * d, k) @ local.reshape(k, -1)).reshape(n, d, d, -1)
    jacobian = np.ascontiguousarray(jacobian.transpose(0, 3, 2, 1))  # (n, q, local, global)
    determinant = np.linalg.det(jacobian)
    if not (np.isfinite(determinant).all() and (determinant * np.sign(determinant[0, 0]) > 0.0).all()):
        raise GeometryError("the mesh of the gear body turns an element inside out; change its density")
    gradient = np.linalg.solve(jacobian, np.broadcast_to(local.transpose(2, 1, 0), (n, len(weights), d, k)))
    gradient = np.ascontiguousarray(gradient.transpose(0, 3, 2, 1)).reshape(n, k * d, -1)
    return (gradient * (np.abs(determinant) * weights)[:, None]) @ gradient.transpose(0, 2, 1)
