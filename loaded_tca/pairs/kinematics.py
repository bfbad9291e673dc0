r"""How the surfaces of two gears move in the tangent plane of a contact.

A rigid body that turns moves the points of a plane like a plane that turns within itself: with the velocity c at the
origin and the part w of the angular velocity along the normal, in coordinates (x, y) of the plane,

.. math:: v_x = c_x - w\,y, \qquad v_y = c_y + w\,x .

For involutes v_x is the angular velocity times the radius of curvature of the profile, of helical ones too, whose x is
the normal of the plane of action.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.pairs.gear_pair import GearPair


@dataclass(frozen=True, eq=False)
class PlaneMotion:
    """Velocities of a surface in the tangent planes of m contacts, per rad/s of its gear.

    Attributes
    ----------
    origin : (m, 2) array [mm]
        c at the origin of each plane, along x and y.
    turn : (m,) array
        w about the normal.
    """

    origin: Array
    turn: Array

    def less(self, other: PlaneMotion, ratio: float) -> PlaneMotion:
        """The motion less a multiple of another."""
        return PlaneMotion(self.origin - ratio * other.origin, self.turn - ratio * other.turn)

    def across(self, contact: int, y: Array) -> Array:
        """v_x [mm] at places along one contact."""
        return np.asarray(self.origin[contact, 0] - self.turn[contact] * y)

    def along(self, contact: int, x: Array) -> Array:
        """v_y [mm] at places across one contact."""
        return np.asarray(self.origin[contact, 1] + self.turn[contact] * x)


def surface_motions(pair: GearPair, origins: Array, axes: Array) -> tuple[PlaneMotion, PlaneMotion]:
    """Motions of the surfaces of pinion and wheel in tangent planes, each gear in its sense of motion.

    Parameters
    ----------
    pair : GearPair
    origins : (m, 3) array [mm]
        Of the planes, in the fixed frame.
    axes : (m, 3, 3) array
        x, y and the normal of each, in rows.

    Returns
    -------
    PlaneMotion, PlaneMotion

    Examples
    --------
    At the pitch point both surfaces move alike, the pinion's by its roll length:

    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.unloaded import relative_curvature, trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh)
    >>> contact = trace_contact(pair, [0.0])[0]
    >>> pinion, wheel = surface_motions(pair, contact.point[None], relative_curvature(pair, contact).axes[None])
    >>> round(abs(float(pinion.origin[0, 0])), 3), round(mesh.path_of_contact.C, 3)
    (17.443, 17.443)
    >>> bool(np.allclose(pinion.origin, pair.ratio * wheel.origin))
    True
    """
    motions = []
    for axis, centre in (
        (np.array([0.0, 0.0, float(pair.sense)]), np.zeros(3)),
        (-pair.sense * pair.wheel_axes[2], pair.wheel_origin),
    ):
        velocity = np.cross(axis, origins - centre)
        in_plane = np.einsum("mi,mki->mk", velocity, axes[:, :2])
        motions.append(PlaneMotion(in_plane, axes[:, 2] @ axis))
    return motions[0], motions[1]
