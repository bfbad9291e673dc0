"""Quadratic serendipity elements on a logical mesh: numbers of the nodes, matrices of the elements.

Shape functions and quadrature are those of scikit-fem; the rest is what a logical mesh allows, all elements at once. It
works in the plane (plane strain) and in space alike. Degrees of freedom are dimension * node + component.

Along the last axis an element may be twice as thick as its neighbours. Where a thin one shares a face with a thick one,
its nodes on that face are no unknowns: they take the displacement that the shape functions of the thick one say, and
stand where these are, so that displacements go on without a gap. Thick elements start at every other layer of thin
ones. With them beside the resolved tooth a tooth model takes 27 to 48 % less time and 30 to 40 % less memory than with
all layers alike; its displacements change by 6e-4 of the largest at most.

References
----------
Gustafsson, McBain 2020, scikit-fem: A Python package for finite element assembly, JOSS 5(52), 2369.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import GeometryError
from loaded_tca.material import Material

FACES = ((0, 0), (0, 2), (1, 0), (1, 2))
"""Faces of an element that thick and thin ones may share: the coordinate that does not change, and its value."""
QUADRATURE_ORDER = 4
"""Three points in each direction."""
SAME_FORM = 1e-9
"""Elements are of one kind if their nodes agree to this part of the largest of them: far above rounding."""


def nodes_of(lowest: Indices, spans: Indices, offsets: Indices, columns: int) -> tuple[Indices, Indices]:
    """Whole coordinates (n, k, 3) of the nodes that say where elements go, and on which faces (n, 4) they hang.

    Parameters
    ----------
    lowest : (n, 3) int array
        Lowest node of each element.
    spans : (n,) int array
        1 of a thin one, 2 of a thick one.
    offsets : (k, 3) int array
        Nodes of an element, 0 to 2 from the lowest.
    columns : int
        After which the first coordinate starts anew.

    Returns
    -------
    nodes : (n, k, 3) int array
    hanging : (n, 4) int array
        For each of ``FACES`` 0, or 1 and 2 for a thin element on the first and second half of a thick face.
    """
    nodes = lowest[:, None] + offsets * np.column_stack([np.ones((len(spans), 2), dtype=int), spans])[:, None]
    limits, numbers = lowest.max(axis=0) + 3, []
    for axis, value in FACES:  # a number for the face of a thick element, or for that of which a thin one's is a half
        middle = lowest[:, :2] + 1
        middle[:, axis] += value - 1
        numbers.append((middle[:, 0] % columns * limits[1] + middle[:, 1]) * limits[2] + lowest[:, 2] // 4)
    faces, thick = np.stack(numbers, axis=1), spans == 2
    shared = np.isin(faces, faces[thick]) & ~thick[:, None]
    hanging = np.where(shared, 1 + lowest[:, 2:] // 2 % 2, 0)
    for n, (axis, value) in enumerate(FACES):
        on_face = offsets[:, axis] == value
        start = 4 * (lowest[shared[:, n], 2:] // 4)
        nodes[np.ix_(shared[:, n], on_face, [2])] = (start + 2 * offsets[on_face, 2])[..., None]
    nodes[..., 0] %= columns
    return nodes, hanging


def following(hanging: Indices, offsets: Indices, quad: Any) -> Array:
    """Shares (n, k, k) of the nodes that say where an element goes in each of its own nodes.

    Parameters
    ----------
    hanging : (n, 4) int array
        As :func:`nodes_of` tells.
    offsets : (k, 3) int array
    quad : element of scikit-fem
        Shape functions of a face.
    """
    codes, which = np.unique(hanging, axis=0, return_inverse=True)
    shares = np.tile(np.eye(len(offsets)), (len(codes), 1, 1))
    order = node_offsets(quad)
    for share, code in zip(shares, codes, strict=True):
        for (axis, value), half in zip(FACES, code, strict=True):
            if half:
                face = np.flatnonzero(offsets[:, axis] == value)
                along, across = offsets[face, 1 - axis], offsets[face, 2]
                places = np.stack([0.5 * along, 0.5 * (half - 1) + 0.25 * across])
                shape = np.stack([quad.lbasis(places, i)[0] for i in range(len(order))], axis=-1)
                same = (order[:, None] == np.stack([along, across], axis=-1)).all(axis=-1).argmax(axis=0)
                share[np.ix_(face, face)] = shape[:, same]
    return shares[which.ravel()]


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
    kinds : (n,) int array
        Which of q kinds each element is; elements of one kind have the same form.
    corners : (q, k, d) array [mm]
        Nodes of one element of each kind, in the frame of its first column.
    turns : (q, k) array [rad]
        From there to the frames in which the displacements of the nodes are counted.
    shares : (q, k, k) array
        Of these in the displacements of the element's own nodes: the identity where none hangs on a thicker element.
    """

    number: Indices
    points: Array
    elements: Indices
    lowest: Indices
    kinds: Indices
    corners: Array
    turns: Array
    shares: Array

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
        r"""Stiffness matrices (q, k d, k d) of the kinds [N/mm]; in the plane per mm of width, strain being plane.

        .. math:: K_{ia,jb} = \int \lambda\,\phi_{i,a}\phi_{j,b} + \mu\,\phi_{i,b}\phi_{j,a}
                  + \mu\,\delta_{ab} \nabla\phi_i\cdot\nabla\phi_j

        The integrals over the elements are as large as the matrices, a quarter of the memory of a model of a helical
        gear: none is kept.

        Raises
        ------
        GeometryError
            If an element is turned inside out.
        """
        k, d = self.elements.shape[1], self.dimension
        shear = 0.5 * material.youngs_modulus / (1.0 + material.poisson_ratio)
        lame = 2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio)
        products = _products(_element(d), self.corners).reshape(-1, k, d, k, d)
        matrices = lame * products + shear * products.transpose(0, 1, 4, 3, 2)
        trace = shear * sum(products[:, :, a, :, a] for a in range(d))
        for a in range(d):
            matrices[:, :, a, :, a] += trace
        matrices = matrices.reshape(-1, k * d, k * d)
        other = np.flatnonzero(self.turns.any(axis=1) | (self.shares != np.eye(k)).any(axis=(1, 2)))
        change = self._to_own_nodes(other)
        matrices[other] = change.transpose(0, 2, 1) @ matrices[other] @ change
        return matrices

    def _to_own_nodes(self, kinds: Indices) -> Array:
        """Matrices (n, k d, k d) from degrees of freedom of elements of some kinds to their own nodes and frame."""
        k, d = self.elements.shape[1], self.dimension
        turns = _turn(self.turns[kinds], d)
        return (self.shares[kinds, :, None, :, None] * turns.transpose(0, 2, 1, 3)[:, None]).reshape(-1, k * d, k * d)

    def free_surface_stress(
        self, elements: Indices, places: Array, along: Indices, material: Material
    ) -> tuple[Array, scipy.sparse.csr_array]:
        r"""Points on a free surface, and the stress there across the lengthwise lines, as rows of a matrix.

        .. math:: \sigma_t = \frac{E}{1 - \nu^2} (\varepsilon_t + \nu \varepsilon_l)

        l is the direction of the last local axis, t the tangent of the surface normal to it; in the plane, strain being
        plane, :math:`\varepsilon_l = 0`. No derivative across the surface enters.

        Parameters
        ----------
        elements : (m,) int array
            Of the pitch whose frame is not turned.
        places : (m, d) array
            Local coordinates, 0 to 1 along each edge.
        along : (m,) int array
            Local axis that runs in the surface across the lengthwise lines.
        material : Material

        Returns
        -------
        (m, d) array [mm]
        (m, d nodes) sparse array [MPa/mm]
        """
        k, d = self.elements.shape[1], self.dimension
        element, each = _element(d), np.arange(len(elements))
        kinds = self.kinds[elements]
        nodes = self.shares[kinds] @ self.points[self.elements[elements]]
        shape, local = (
            np.stack([np.broadcast_to(element.lbasis(places.T, i)[n], (*((d,) * n), len(each))).T for i in range(k)], 1)
            for n in (0, 1)
        )
        tangents = np.einsum("mka,mkx->max", local, nodes)
        across, slope = tangents[each, along], local[each, :, along]
        stress = np.zeros((len(each), k, d))
        if d == 3:
            lengthwise = tangents[:, 2]
            square = (lengthwise**2).sum(axis=1)[:, None]
            part = (across * lengthwise).sum(axis=1)[:, None] / square
            across, slope = across - part * lengthwise, slope - part * local[:, :, 2]
            stress += material.poisson_ratio * (local[:, :, 2] / square)[..., None] * lengthwise[:, None]
        stress += (slope / (across**2).sum(axis=1)[:, None])[..., None] * across[:, None]
        stress *= material.plane_strain_modulus
        own, which = np.unique(kinds, return_inverse=True)
        values = np.einsum("mi,mij->mj", stress.reshape(len(each), -1), self._to_own_nodes(own)[which])
        starts = np.arange(len(each) + 1) * k * d
        rows = scipy.sparse.csr_array(
            (values.ravel(), self.dofs[elements].ravel(), starts), shape=(len(each), self.points.size)
        )
        return np.einsum("mk,mkx->mx", shape, nodes), rows


def discretise(
    points: Array, lowest: Indices, turns: Array | None = None, spans: Indices | None = None
) -> Discretisation:
    """Number the nodes of a logical mesh and find which of its elements have the same form.

    Parameters
    ----------
    points : (..., d) array [mm]
        Nodes by their d whole coordinates, of which the first closes to a ring.
    lowest : (n, d) int array
        Lowest node of each element; its others are up to 2 further.
    turns : (columns,) array [rad], optional
        About the origin or the last axis, by which the frame is turned in which displacements of a column are counted.
    spans : (n,) int array, optional
        In space: 2 where an element is twice as thick along the last axis, and starts at a multiple of 4; default: 1.
    """
    shape, d = points.shape[:-1], points.shape[-1]
    element = _element(d)
    offsets = node_offsets(element)
    if spans is None:
        nodes, hanging = offsets + lowest[:, None], np.zeros((len(lowest), len(FACES)), dtype=int)
        nodes[..., 0] %= shape[0]
    else:
        nodes, hanging = nodes_of(lowest, spans, offsets, shape[0])
    used, elements = np.unique(np.ravel_multi_index(tuple(np.moveaxis(nodes, -1, 0)), shape), return_inverse=True)
    number = np.full(shape, -1)
    number.reshape(-1)[used] = np.arange(len(used))
    kept_points = points.reshape(-1, d)[used]
    elements = elements.reshape(nodes.shape[:2])
    frames = np.zeros(shape[0]) if turns is None else turns
    first = frames[lowest[:, 0] % shape[0]]
    corners = np.einsum("nba,nkb->nka", _turn(first, d), kept_points[elements])
    onwards = np.remainder(frames[nodes[..., 0]] - first[:, None], 2.0 * math.pi)
    form = corners - corners[:, :1] * (np.arange(d) == 2)  # wherever it lies along the axis
    form /= np.ptp(corners, axis=1).max()
    form = np.concatenate([form, onwards[..., None]], axis=-1).reshape(len(form), -1)
    rounded = np.concatenate([np.rint(form / SAME_FORM).astype(int), hanging], axis=1)
    seen: dict[bytes, int] = {}
    kinds = np.array([seen.setdefault(row.tobytes(), len(seen)) for row in rounded])
    one = np.unique(kinds, return_index=True)[1]
    shares = following(hanging[one], offsets, _element(2))
    return Discretisation(number, kept_points, elements, lowest, kinds, shares @ corners[one], onwards[one], shares)


def _turn(angle: Array, dimension: int) -> Array:
    """Turns (..., d, d) about the origin or the last axis: from components in turned frames to those before."""
    turn = np.zeros((*angle.shape, dimension, dimension))
    turn[..., range(dimension), range(dimension)] = 1.0
    cosine, sine = np.cos(angle), np.sin(angle)
    turn[..., 0, 0], turn[..., 0, 1], turn[..., 1, 0], turn[..., 1, 1] = cosine, -sine, sine, cosine
    return turn


def _element(dimension: int) -> Any:
    """Serendipity element of scikit-fem."""
    from skfem import ElementHexS2, ElementQuadS2  # on use: it takes half a second

    return {2: ElementQuadS2, 3: ElementHexS2}[dimension]()


def node_offsets(element: Any) -> Indices:
    """Nodes (k, d) of an element of scikit-fem, 0 to 2 from the lowest."""
    return np.rint(2.0 * np.asarray(element.doflocs)).astype(int)


def _products(element: Any, corners: Array) -> Array:
    """Integrals (n, k d, k d) of the products of the derivatives of any two shape functions [mm^(d - 2)].

    Over elements with nodes at ``corners`` (n, k, d).
    """
    from skfem.quadrature import get_quadrature

    places, weights = get_quadrature(element, QUADRATURE_ORDER)
    n, k, d = corners.shape
    local = np.stack([element.lbasis(places, i)[1] for i in range(k)])  # (k, d, q)
    jacobian = (corners.transpose(0, 2, 1).reshape(n * d, k) @ local.reshape(k, -1)).reshape(n, d, d, -1)
    jacobian = np.ascontiguousarray(jacobian.transpose(0, 3, 2, 1))  # (n, q, local, global)
    determinant = np.linalg.det(jacobian)
    if not (np.isfinite(determinant).all() and (determinant * np.sign(determinant[0, 0]) > 0.0).all()):
        raise GeometryError("the mesh of the gear body turns an element inside out; change its density")
    gradient = np.linalg.inv(jacobian) @ local.transpose(2, 1, 0)
    gradient = np.ascontiguousarray(gradient.transpose(0, 3, 2, 1)).reshape(n, k * d, -1)
    return (gradient * (np.abs(determinant) * weights)[:, None]) @ gradient.transpose(0, 2, 1)
