"""Face-milled hypoid pairs: both members on axes with an offset, and the clearance of their tips."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.gears.face_milled import FaceMilledBlank, FaceMilledMesh
from loaded_tca.gears.hypoid import HypoidCones

ALONG, AROUND = 33, 161
"""Points along a face cone, and azimuths over which it is near the mating gear."""
REACH = 0.6
"""These azimuths to either side of the calculation point [rad]."""


@dataclass(frozen=True)
class HypoidMesh(FaceMilledMesh):
    """Both members of a face-milled hypoid pair.

    Parameters
    ----------
    pinion, wheel : FaceMilledGear
        With apexes counted from those of their pitch cones.
    shaft_angle : float [rad]
    cones : HypoidCones
        The pitch cones, which close on offset and shaft angle.
    """

    cones: HypoidCones

    @property
    def offset(self) -> float:
        """Hypoid offset a [mm]."""
        return self.cones.offset

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Smallest clearance between the roots of pinion and wheel and the mating gear's tip [mm].

        Across the root cone, over all the face: face cones touch planes at the clearance of the blank in one line, and
        stand off more elsewhere.
        """
        pinion, wheel, frame = self.pinion.blank, self.wheel.blank, self.cones.frame(self.pinion.mirror)
        on_pinion = (_face_cone(wheel) @ frame.axes) + frame.origin
        on_wheel = (_face_cone(pinion) - frame.origin) @ frame.axes.T
        return _above_root(on_pinion, pinion), _above_root(on_wheel, wheel)


def _face_cone(blank: FaceMilledBlank) -> Array:
    """Points (ALONG, AROUND, 3) of the face cone about P, in the frame of its gear."""
    distance = np.linspace(*blank.cone_distances, ALONG)
    height = np.array([blank.tip_height(one) for one in distance])
    rho = distance * sin(blank.pitch_angle) + height * cos(blank.pitch_angle)
    z = distance * cos(blank.pitch_angle) - height * sin(blank.pitch_angle)
    azimuth = np.linspace(-REACH, REACH, AROUND)
    around = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1)
    points = np.empty((ALONG, AROUND, 3))
    points[..., :2] = rho[:, None, None] * around
    points[..., 2] = z[:, None]
    return points


def _above_root(points: Array, blank: FaceMilledBlank) -> float:
    """Smallest distance [mm] from the root cone, of points (n, m, 3) that lie on the face of a gear.

    Along each row a parabola through the lowest point and its neighbours.
    """
    rho, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
    height = rho * cos(blank.root_angle) - (z + blank.root_apex) * sin(blank.root_angle)
    distance = np.hypot(rho, z)
    toe, heel = blank.cone_distances
    rows, lowest = np.arange(len(height)), np.clip(height.argmin(axis=1), 1, height.shape[1] - 2)
    before, at, after = (height[rows, lowest + step] for step in (-1, 0, 1))
    bend = before - 2.0 * at + after
    vertex = at - np.divide((after - before) ** 2, 8.0 * bend, out=np.zeros_like(bend), where=bend > 0.0)
    faces = (distance[rows, lowest] >= toe) & (distance[rows, lowest] <= heel)
    return float(vertex[faces].min()) if faces.any() else float("inf")
