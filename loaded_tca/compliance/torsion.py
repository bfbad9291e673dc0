r"""Body torsion: the twist of gear bodies between what is held and the root circle, a part of every mesh stiffness.

Stiffnesses of slices and of ISO 6336-1 do not contain it:

.. math:: 1/c_{without} = 1/c - b\,(t_1 + t_2)
"""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.weber_banaschek import ring_torsion

CELLS = 12
"""Elements along each part of half the section of a solid body."""


def body_torsion(pair: GearPair) -> tuple[float, float]:
    """Displacement of both gears along the transverse line of action by the twist of their bodies per force [mm/N].

    That of a ring in closed form, of a solid gear by :func:`solid_torsion`; of bevel gears that of the mean section.

    Raises
    ------
    InputError
        If a bore leaves no rim below the teeth.
    """
    pinion, wheel = (
        base_radius**2 * _twist(gear)
        for gear, base_radius in zip((pair.pinion, pair.wheel), pair.base_radii, strict=True)
    )
    return pinion, wheel


def _twist(gear: Gear) -> float:
    """Rotation of the root circle per torque [rad/(N mm)]."""
    ends = np.unique(gear.form.sections.coordinate(*gear.nominal_flank.grid(2, 2)))
    middle, width = np.array([0.5 * (ends[0] + ends[-1])]), float(ends[-1] - ends[0])
    root = float(gear.form.sections.point(gear.form.root_radius(middle), middle)[0][0])
    held = float(gear.bore_radius(middle)[0])
    return (
        solid_torsion(held, root, width, gear.material)
        if gear.is_solid
        else (ring_torsion(held, root, gear.material) / width)
    )


def solid_torsion(journal_radius: float, outer_radius: float, width: float, material: Material = Material()) -> float:
    r"""Mean rotation of the outside of a cylinder, loaded evenly there and held by journals at both ends.

    Sections turn by :math:`\psi = u_\theta/r`, for which

    .. math:: \frac{\partial}{\partial r} r^3 \frac{\partial\psi}{\partial r} + r^3 \frac{\partial^2\psi}{\partial z^2}
              = 0, \qquad \psi = 0 \text{ on the journals}, \qquad
              2 \pi G\,r_o^3\,\frac{\partial\psi}{\partial r} = \frac{T}{b} \text{ outside}.

    By finite elements of half the section.

    Parameters
    ----------
    journal_radius, outer_radius, width : float [mm]
    material : Material

    Returns
    -------
    float [rad/(N mm)]

    References
    ----------
    Timoshenko, Goodier 1970, Theory of Elasticity, 3rd ed., art. 119 (torsion of shafts of variable diameter).

    Examples
    --------
    >>> round(1e9 * solid_torsion(20.0, 35.0, 20.0), 4)
    0.162
    """
    from skfem import Basis, BilinearForm, ElementQuad2, FacetBasis, LinearForm, MeshQuad, condense, solve

    # Lengths over the outer radius; elements grow finer towards the edge of the journals.
    edge, end = journal_radius / outer_radius, 0.5 * width / outer_radius
    part = np.linspace(0.0, 1.0, CELLS + 1)
    radii = np.concatenate([edge * (2.0 - part[:-1]) * part[:-1], edge + (1.0 - edge) * part**2])
    mesh = MeshQuad.init_tensor(radii, end * part**2)
    basis, element = Basis(mesh, ElementQuad2(), intorder=6), ElementQuad2()
    outside = FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: x[0] > 1.0 - 1e-9))
    stiffness = BilinearForm(lambda u, v, w: 4.0 * math.pi * w.x[0] ** 3 * (u.grad * v.grad).sum(axis=0))
    load = LinearForm(lambda v, _: v / end).assemble(outside)
    held = basis.get_dofs(lambda x: (x[1] < 1e-9) & (x[0] < edge + 1e-9))
    turned = float(load @ solve(*condense(stiffness.assemble(basis), load, D=held)))
    shear_modulus = 0.5 * material.youngs_modulus / (1.0 + material.poisson_ratio)
    return turned / (shear_modulus * outer_radius**3)
