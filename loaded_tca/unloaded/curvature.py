r"""Relative curvature of the two flanks at a contact point, from the Hessian of the ease-off alone.

Near the contact the gap along the normal is the fall of the ease-off times the lever of the normal force about the
wheel's axis over r_b2. In coordinates xi of the tangent plane, with J = d xi/d(rho, z),

.. math:: B = -\frac{l_2}{r_{b2}} J^{-T} \Bigl( \nabla^2 e - \sum_k e_{,\xi_k} \nabla^2 \xi_k \Bigr) J^{-1}

is the difference of the curvature tensors of the two flanks (Johnson 1985, eq. 4.3: gap = x.B.x/2). Flanks with rounded
edges count as sharp ones here: on the arc of a face end, across and along would change places.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from weakref import ReferenceType, WeakKeyDictionary, ref

import numpy as np

from loaded_tca.arguments import checked
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

    @checked
    def along_axes(self, axes: Array) -> tuple[float, float]:
        """Relative curvatures [1/mm] along the first two of other axes (rows) in the same plane."""
        if axes is self.axes or np.array_equal(axes, self.axes):
            return self.across, self.along
        first, second = (axes[:2] @ self.axes[:2].T) ** 2 @ np.array([self.across, self.along])
        return float(first), float(second)


_KEPT: WeakKeyDictionary[ContactPoint, tuple[ReferenceType[GearPair], RelativeCurvature]] = WeakKeyDictionary()
"""Curvatures of the contact points in use: every grid of a contact asks for them again."""


def relative_curvature(pair: GearPair, contact: ContactPoint) -> RelativeCurvature:
    """Principal relative curvatures at a contact point; kept as long as the contact point is."""
    return relative_curvatures(pair, [contact])[0]


def relative_curvatures(pair: GearPair, contacts: Sequence[ContactPoint]) -> list[RelativeCurvature]:
    """Principal relative curvatures at many contact points at once; see :func:`relative_curvature`."""
    kept = [_KEPT.get(contact) for contact in contacts]
    missing = {c: None for c, known in zip(contacts, kept, strict=True) if known is None or known[0]() is not pair}
    if missing:
        for contact, curvatures in zip(missing, _curvatures(pair, [*missing]), strict=True):
            _KEPT[contact] = ref(pair), curvatures
    return [_KEPT[contact][1] for contact in contacts]


def _curvatures(pair: GearPair, contacts: list[ContactPoint]) -> Iterator[RelativeCurvature]:
    """Curvatures of n contact points, each in a row of its own, so that none depends on the others."""
    pair = pair.sharp
    point, normal = np.array([c.point for c in contacts]), np.array([c.normal for c in contacts])
    places = [(c.pinion_angle, c.pinion_radius, c.pinion_axial, c.wheel_lever) for c in contacts]
    angle, rho, z, lever = np.array(places).T[..., None]  # (n, 1) each
    lengthwise = _heelwards(pair, point[:, None], rho, z)[:, 0]
    second = lengthwise - (normal * lengthwise).sum(axis=-1, keepdims=True) * normal
    second /= np.linalg.norm(second, axis=-1, keepdims=True)
    plane = np.stack([np.cross(second, normal), second], axis=1)
    field = EaseOff(pair)
    station = field.station(angle, rho, z)
    in_wheel = plane @ station.wheel_basis[:, 0].mT
    slopes, bends = (np.moveaxis(parts[..., 0], -1, 0) for parts in (station.slopes, station.bends))
    inverse = np.linalg.inv(in_wheel @ slopes)
    drift = field.gradient(station) @ inverse @ (in_wheel @ bends)
    bend = field.hessian(station)[:, 0] - drift[:, 0, [[0, 1], [1, 2]]]
    tensor = -(lever / pair.base_radii[1])[..., None] * (inverse.mT @ bend @ inverse)
    values, vectors = np.linalg.eigh(0.5 * (tensor + tensor.mT))
    along = (vectors[:, None, :, 0] @ plane)[:, 0]
    along *= np.where((along * lengthwise).sum(axis=-1, keepdims=True) >= 0.0, 1.0, -1.0)
    all_axes = np.stack([np.cross(along, normal), along, normal], axis=1)
    for (smallest, largest), axes in zip(values.tolist(), all_axes, strict=True):
        axes.flags.writeable = False  # every grid of the contact shares them
        yield RelativeCurvature(largest, smallest, axes)


def heelwards(pair: GearPair, contact: ContactPoint) -> Array:
    """Direction (3,) in the fixed frame in which the pinion's lengthwise coordinate grows by one mm per mm."""
    return _heelwards(pair, contact.point, np.array(contact.pinion_radius), np.array(contact.pinion_axial))


def _heelwards(pair: GearPair, point: Array, rho: Array, z: Array) -> Array:
    """That direction at points (..., 3) of the pinion flank."""
    basis = cylindrical_basis(np.arctan2(point[..., 1], point[..., 0]))
    return np.asarray((lengthwise_direction(pair.pinion.flank, rho, z)[..., None, :] @ basis)[..., 0, :])
