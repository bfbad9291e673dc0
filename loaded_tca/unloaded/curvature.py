r"""Relative curvature of the two flanks at a contact point, from the Hessian of the ease-off alone.

Near the contact the gap along the normal is the fall of the ease-off times the lever of the normal force about the
wheel's axis over r_b2. In coordinates xi of the tangent plane, with J = d xi/d(rho, z),

.. math:: B = -\frac{l_2}{r_{b2}} J^{-T} \Bigl( \nabla^2 e - \sum_k e_{,\xi_k} \nabla^2 \xi_k \Bigr) J^{-1}

is the difference of the curvature tensors of the two flanks (Johnson 1985, eq. 4.3: gap = x.B.x/2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.flanks.base import lengthwise_direction
from loaded_tca.flanks.jet import Array
from loaded_tca.pair import GearPair, cylindrical_basis
from loaded_tca.unloaded.ease_off import PARTS, EaseOff
from loaded_tca.unloaded.path import ContactPoint


@dataclass(frozen=True, eq=False)
class RelativeCurvature:
    """Principal relative curvatures and their frame.

    Attributes
    ----------
    across, along : float [1/mm]
        Largest and smallest principal relative curvature.
    axes : (3, 3) array
        Rows: direction of the largest curvature, of the smallest (towards +z or the heel, as the pinion's lengthwise
        coordinate grows), and the normal out of the pinion; right-handed.
    """

    across: float
    along: float
    axes: Array


def relative_curvature(pair: GearPair, contact: ContactPoint) -> RelativeCurvature:
    """Principal relative curvatures at a contact point."""
    lengthwise = heelwards(pair, contact)
    tangent_plane = _tangent_plane(contact.normal, lengthwise)
    tensor = _tensor(pair, contact, tangent_plane)
    values, vectors = np.linalg.eigh(0.5 * (tensor + tensor.T))
    along = vectors[:, 0] @ tangent_plane
    along = along if along @ lengthwise >= 0.0 else -along
    across = np.cross(along, contact.normal)
    return RelativeCurvature(float(values[1]), float(values[0]), np.stack([across, along, contact.normal]))


def heelwards(pair: GearPair, contact: ContactPoint) -> Array:
    """Direction (3,) in the fixed frame in which the pinion's lengthwise coordinate grows by one mm per mm."""
    basis = cylindrical_basis(np.arctan2(contact.point[1], contact.point[0]))
    rho, z = np.array(contact.pinion_radius), np.array(contact.pinion_axial)
    return lengthwise_direction(pair.pinion, rho, z) @ basis


def _tangent_plane(normal: Array, lengthwise: Array) -> Array:
    """Two orthonormal directions (2, 3) across a unit normal; the second as near to ``lengthwise`` as can be."""
    lengthwise = lengthwise - (normal @ lengthwise) * normal
    lengthwise /= np.linalg.norm(lengthwise)
    return np.stack([np.cross(lengthwise, normal), lengthwise])


def _tensor(pair: GearPair, contact: ContactPoint, plane: Array) -> Array:
    """Relative curvature tensor B (2, 2) in the basis ``plane`` [1/mm]."""
    field = EaseOff(pair)
    angle, rho, z = (np.atleast_1d(v) for v in (contact.pinion_angle, contact.pinion_radius, contact.pinion_axial))
    station = field.station(angle, rho, z)
    inverse = np.linalg.inv(plane @ station.tangents[0].T)
    slope = inverse.T @ field.gradient(station)[0]
    bend = field.hessian(station)[0]
    for k, (i, j) in enumerate(PARTS):
        drift = slope @ (plane @ station.second[0, k])
        bend[i, j] -= drift
        if i != j:
            bend[j, i] -= drift
    return -(contact.wheel_lever / pair.base_radii[1]) * (inverse.T @ bend @ inverse)
