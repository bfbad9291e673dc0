"""Teeth of a gear or a ring in plane strain: their section in its true form, triangulated by Delaunay's rule.

Quadratic elements, fine at the flanks and fillets of one tooth; the bore or the outside is held. Nothing of it is the
package's own model of a tooth but the curves: involute, fillet, circles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray
from scipy.sparse.linalg import SuperLU, splu
from scipy.spatial import Delaunay, cKDTree
from skfem import Basis, ElementTriP2, ElementVector, MeshTri
from skfem.models.elasticity import lame_parameters, linear_elasticity

from loaded_tca.gears import CylindricalGear, RingGear
from loaded_tca.material import Material
from loaded_tca.tooth.fillet import polar

Array = NDArray[np.float64]

STEEL = Material(206000.0, 0.3)
TEETH_BESIDE = 5
SIZES = ((1.2, math.inf), (0.4, 2.5), (0.12, 0.6), (0.05, 0.16))
"""Sizes of elements [mm] within distances [mm] of the fine border, and from the next smaller one on; nearer still
elements are as large as the step along the border."""
FINE, COARSE = 0.04, 0.35  # steps along the flanks of the fine tooth and of the others [mm]
WITHOUT_AREA = 1e-7  # mm^2: of corners on one line


def flank_angle(gear: CylindricalGear | RingGear, radius: Array) -> Array:
    """Half thickness angle of the tooth at radii [rad]."""
    roll = np.sqrt(np.maximum(radius**2 - gear.base_radius**2, 0.0)) / gear.base_radius
    side = 1.0 if isinstance(gear, RingGear) else -1.0
    return np.asarray(gear.half_thickness_angle_at_base + side * (roll - np.arctan(roll)))


def half_outline(gear: CylindricalGear | RingGear, step: float) -> Array:
    """Radius and half angle (n, 2) of half a tooth, from the middle of its tip to the middle of the space."""
    height = abs(gear.form_radius - gear.tip_radius)
    flank = np.linspace(gear.tip_radius, gear.form_radius, max(4, math.ceil(height / step)))
    radius, angle = gear.root_fillet(max(6, math.ceil(2.5 / step)))
    tip, land = flank_angle(gear, flank[:1])[0], math.pi / gear.tooth_count
    parts = [
        np.stack([np.full(5, gear.tip_radius), np.linspace(0.0, tip, 5)], axis=1)[:-1],
        np.stack([flank, flank_angle(gear, flank)], axis=1)[:-1],
        np.stack([radius, angle], axis=1),
        np.stack([np.full(5, gear.root_radius), np.linspace(angle[-1], land, 5)], axis=1)[1:],
    ]
    return np.concatenate(parts)


@dataclass(frozen=True, eq=False)
class PlaneTeeth:
    """Triangulated teeth, the fine one about the x axis.

    Attributes
    ----------
    gear : CylindricalGear or RingGear
    mesh : MeshTri
    basis : Basis
        Of displacements.
    factor : SuperLU
        Of the stiffness of what is free.
    free : array of int
        Degrees of freedom that are not held.
    """

    gear: CylindricalGear | RingGear
    mesh: MeshTri
    basis: Basis
    factor: SuperLU
    free: NDArray[np.int64]

    @classmethod
    def of(cls, gear: CylindricalGear | RingGear, held_radius: float, fine_step: float = FINE) -> PlaneTeeth:
        """Eleven teeth, held at a radius [mm]: the bore of a gear, the outside of a ring."""
        border, fine = [], np.empty((0, 2))
        for tooth in range(-TEETH_BESIDE, TEETH_BESIDE + 1):
            half = half_outline(gear, fine_step if tooth == 0 else COARSE)
            whole = np.concatenate([half[::-1] * [1.0, -1.0], half[1:]])
            whole[:, 1] += 2.0 * math.pi * tooth / gear.tooth_count
            border.append(whole[:-1] if tooth < TEETH_BESIDE else whole)
            if tooth == 0:
                fine = whole
        teeth = np.concatenate(border)
        ends = teeth[0, 1], teeth[-1, 1]
        count = 24 * (2 * TEETH_BESIDE + 1)
        held = np.stack([np.full(count, held_radius), np.linspace(ends[1], ends[0], count)], axis=1)
        mesh = _triangulated(polar(*np.concatenate([teeth, held]).T), polar(*fine.T), fine_step)
        basis = Basis(mesh, ElementVector(ElementTriP2()))
        stiffness = linear_elasticity(*lame_parameters(STEEL.youngs_modulus, STEEL.poisson_ratio)).assemble(basis)
        near = 1e-4 * held_radius
        fixed = basis.get_dofs(lambda x: np.abs(np.hypot(*x) - held_radius) < near).all()
        free = basis.complement_dofs(fixed)
        factor = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0)
        return cls(gear, mesh, basis, factor, free)

    def displacement(self, load: Array) -> Array:
        """Displacements (n,) or (n, k) under nodal forces of the same shape."""
        moved = np.zeros_like(load)
        moved[self.free] = self.factor.solve(np.ascontiguousarray(load[self.free]))
        return moved


def _triangulated(line: Array, fine: Array, fine_step: float) -> MeshTri:
    """Triangles within a closed line (n, 2), small beside a fine one (m, 2)."""
    polygon, tree, everywhere = Path(line), cKDTree(fine), cKDTree(line)
    points = [line]
    low, high = line.min(axis=0), line.max(axis=0)
    sizes = SIZES if fine_step >= FINE else (*SIZES, (1.25 * fine_step, 4.0 * fine_step))
    for (size, reach), (_, nearer) in zip(sizes, (*sizes[1:], (0.0, 0.0)), strict=True):
        if math.isfinite(reach):  # a part of the section alone
            first, last = np.maximum(low, fine.min(axis=0) - reach), np.minimum(high, fine.max(axis=0) + reach)
        else:
            first, last = low, high
        x, y = np.meshgrid(*(np.arange(a, b, size) for a, b in zip(first, last, strict=True)), indexing="ij")
        grid = np.stack([x + 0.5 * size * (np.arange(x.shape[1]) % 2), y], axis=-1).reshape(-1, 2)
        grid = grid[polygon.contains_points(grid)]
        distance = tree.query(grid)[0]
        grid = grid[(distance < reach) & (distance >= nearer) & (everywhere.query(grid)[0] > 0.45 * size)]
        points.append(grid)
    place = np.concatenate(points)
    triangles = Delaunay(place).simplices
    triangles = triangles[polygon.contains_points(place[triangles].mean(axis=1))]
    corners = place[triangles]
    sides = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.abs(sides[0][:, 0] * sides[1][:, 1] - sides[0][:, 1] * sides[1][:, 0])
    return MeshTri(place.T.copy(), triangles[area > WITHOUT_AREA].T.copy()).remove_unused_nodes()
