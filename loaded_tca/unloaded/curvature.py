r"""Relative curvature of the two flanks at a contact point, from the Hessian of the ease-off alone.

Near the contact the gap along the normal is the fall of the ease-off times the lever of the normal force about the
wheel's axis over r_b2. In coordinates xi of the tangent plane, with J = d xi/d(rho, z),

.. math:: B = -\frac{l_2}{r_{b2}} J^{-T} \Bigl( \nabla^2 e - \sum_k e_{,\xi_k} \nabla^2 \xi_k \Bigr) J^{-1}

is the difference of the curvature tensors of the two flanks (Johnson 1985, eq. 4.3: gap = x.B.x/2).
"""

from __future__ import annotations

from dataclasses import dataclass
from weakref import ReferenceType, WeakKeyDictionary, ref

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.flanks.base import lengthwise_direction
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis
from loaded_tca.unloaded.ease_off import EaseOff
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


_KEPT: WeakKeyDictionary[ContactPoint, tuple[ReferenceType[GearPair], RelativeCurvature]] = WeakKeyDictionary()
"""Curvatures of the contact points in use: every grid of a contact asks for them again."""


def relative_curvature(pair: GearPair, contact: ContactPoint) -> RelativeCurvature:
    """Principal relative curvatures at a contact point; kept as long as the contact point is."""
    kept = _KEPT.get(contact)
    if kept is None or kept[0]() is not pair:
        kept = _KEPT[contact] = ref(pair), _curvature(pair, contact)
    return kept[1]


def _curvature(pair: GearPair, contact: ContactPoint) -> RelativeCurvature:
    lengthwise = heelwards(pair, contact)
    second = lengthwise - (contact.normal @ lengthwise) * contact.normal
    second /= np.linalg.norm(second)
    plane = np.stack([_cross(second, contact.normal), second])
    field = EaseOff(pair)
    angle, rho, z = (np.atleast_1d(v) for v in (contact.pinion_angle, contact.pinion_radius, contact.pinion_axial))
    station = field.station(angle, rho, z)
    in_wheel = plane @ station.wheel_basis[0].T
    inverse, drifts = np.linalg.inv(in_wheel @ station.slopes[..., 0]), in_wheel @ station.bends[..., 0]
    drift = inverse.T @ field.gradient(station)[0] @ drifts
    bend = field.hessian(station)[0] - np.array([[drift[0], drift[1]], [drift[1], drift[2]]])
    tensor = -(contact.wheel_lever / pair.base_radii[1]) * (inverse.T @ bend @ inverse)
    values, vectors = np.linalg.eigh(0.5 * (tensor + tensor.T))
    along = vectors[:, 0] @ plane
    along = along if along @ lengthwise >= 0.0 else -along
    axes = np.stack([_cross(along, contact.normal), along, contact.normal])
    axes.flags.writeable = False  # every grid of the contact shares them
    return RelativeCurvature(float(values[1]), float(values[0]), axes)


def heelwards(pair: GearPair, contact: ContactPoint) -> Array:
    """Direction (3,) in the fixed frame in which the pinion's lengthwise coordinate grows by one mm per mm."""
    basis = cylindrical_basis(np.arctan2(contact.point[1], contact.point[0]))
    rho, z = np.array(contact.pinion_radius), np.array(contact.pinion_axial)
    return lengthwise_direction(pair.pinion.flank, rho, z) @ basis


def _cross(a: Array, b: Array) -> Array:
    """Cross product of two single vectors."""
    (a1, a2, a3), (b1, b2, b3) = a.tolist(), b.tolist()
    return np.array([a2 * b3 - a3 * b2, a3 * b1 - a1 * b3, a1 * b2 - a2 * b1])
