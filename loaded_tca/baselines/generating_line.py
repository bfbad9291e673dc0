r"""The line along which the cutter touches the flank at the centre of roll, by the azimuth about the cutter.

At the turn zero of the cradle the cutter touches the flank along a line. Each of its points is told by the azimuth
:math:`\vartheta` about the axis of the cutter, from the root line of the machine: at the height h above the blade tips

.. math:: P(\vartheta, h) = C + r(h)\,(e_1\cos\vartheta + e_2\sin\vartheta) - h\,a, \qquad
          F_\varphi(P(\vartheta, h), \varphi = 0) = 0

with C the centre of the cutter, a its axis and the equation of meshing of :mod:`loaded_tca.flanks.cradle`, which a
straight blade makes linear in h. A method that keeps the cradle at its centre walks along this line only.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, section 21.3 (lines of contact of tool and blank).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.flanks.cradle import ALPHA, RHO, CradleGeneration, Z
from loaded_tca.gears.cutter import FlankName
from loaded_tca.gears.face_milled import FaceMilledGear

MOST_STEPS = 30
RESOLVED = 1e-12
"""Part of the radial setting below which steps in height, and what is left of the equation of meshing, are rounding."""


@dataclass(frozen=True, eq=False)
class LinePoints:
    """Points of the line, in the frame of the gear as it stands on the machine: x along the root line, z its axis.

    Attributes
    ----------
    rho, azimuth, z : (n,) array [mm, rad, mm]
        Cylindrical coordinates.
    normal : (n, 3) array
        Unit normal out of the material.
    """

    rho: Array
    azimuth: Array
    z: Array
    normal: Array

    @property
    def point(self) -> Array:
        """Places (n, 3) [mm]."""
        return np.stack([self.rho * np.cos(self.azimuth), self.rho * np.sin(self.azimuth), self.z], axis=-1)

    @property
    def moment(self) -> Array:
        """Moment (n, 3) of the normal about the origin of the gear [mm]."""
        return np.cross(self.point, self.normal)


class GeneratingLine:
    """Line of contact of cutter and flank at the centre of roll.

    Parameters
    ----------
    gear : FaceMilledGear
        One that rolls.
    flank : {"concave", "convex"}

    Raises
    ------
    InputError
        If the gear is cut without rolling: the cutter then touches the whole flank at once.

    Examples
    --------
    >>> from loaded_tca.gears import BevelBlank
    >>> from loaded_tca.gears.basic_settings import spread_blade
    >>> blank = BevelBlank((20, 30), 5.0, 20.0, spiral_angle=0.6, cutter_radius=60.0)
    >>> points = GeneratingLine(spread_blade(blank)[1], "convex").at([5.25, 5.3])
    >>> np.hypot(points.rho, points.z).round(2)  # cone distances [mm]
    array([75.57, 78.07])
    """

    def __init__(self, gear: FaceMilledGear, flank: FlankName) -> None:
        machine = gear.machine
        if not machine.rolls:
            raise InputError(
                f"{gear.name}: generation: 'formate'; without rolling the cutter touches the flank all over"
            )
        self._generation, self._hand = CradleGeneration(gear.cutter.blade(flank), flank, machine), gear.mirror
        q = machine.cradle_angle
        self._centre = machine.radial * np.array([np.cos(q), np.sin(q), 0.0])
        radial, across, along = self._generation.axis
        axis = np.array([radial * np.cos(q) - across * np.sin(q), radial * np.sin(q) + across * np.cos(q), along])
        # the axes x, y, z, in rows, turned the shortest way until z is the axis of the cutter
        self._axes = np.eye(3) - np.outer(axis, axis + np.eye(3)[2]) / (1.0 + along)
        self._axes[2] = axis

    def at(self, angle: ArrayLike) -> LinePoints:
        """Points of the line at azimuths (n,) about the cutter, from 0 to 2 pi, seen on the gear's own hand [rad].

        Raises
        ------
        ConvergenceError
            If the equation of meshing is not solved at an azimuth.
        """
        angles = self._hand * np.atleast_1d(np.asarray(angle, dtype=float))
        height, reach = np.zeros_like(angles), self._generation.machine.radial
        for _ in range(MOST_STEPS):
            step, lack = self._step(angles, height)
            if max(np.abs(step).max(), np.abs(lack).max()) <= RESOLVED * reach:
                return self._points(angles, height)
            height = height + np.clip(step, -reach, reach)
        raise ConvergenceError(
            f"equation of meshing at the centre of roll: after {MOST_STEPS} steps the height still moves by "
            f"{np.abs(step).max():.3g} mm, with {np.abs(lack).max():.3g} mm/rad left",
            last=height,
        )

    def _step(self, angle: Array, height: Array) -> tuple[Array, Array]:
        """Newton step of the heights (n,) [mm], and what is left of the equation of meshing [mm/rad].

        Where the equation does not depend on the height, there is no step.
        """
        place, slope = self._on_blade(angle, height)
        rho, alpha, z = self._on_blank(place)
        along = slope @ self._blank_axes.T
        radial, turning = np.cos(alpha), np.sin(alpha)
        cut = self._generation.cut(rho, alpha, z, np.zeros_like(rho))
        slopes = cut.meshing_slopes
        change = slopes[RHO] * (along[:, 0] * radial + along[:, 1] * turning)
        change += slopes[ALPHA] * (along[:, 1] * radial - along[:, 0] * turning) / rho
        change += slopes[Z] * along[:, 2]
        return -cut.meshing / np.where(change == 0.0, np.inf, change), cut.meshing

    def _points(self, angle: Array, height: Array) -> LinePoints:
        rho, alpha, z = self._on_blank(self._on_blade(angle, height)[0])
        cut = self._generation.cut(rho, alpha, z, np.zeros_like(rho))
        cosine, sine = np.cos(alpha), np.sin(alpha)
        radial, turning = cut.slopes[RHO], cut.slopes[ALPHA] / rho
        gradient = np.stack(
            [radial * cosine - turning * sine, self._hand * (radial * sine + turning * cosine), cut.slopes[Z]], axis=-1
        )
        normal = -gradient / np.linalg.norm(gradient, axis=-1, keepdims=True)
        return LinePoints(rho, self._hand * alpha, z, normal)

    def _on_blade(self, angle: Array, height: Array) -> tuple[Array, Array]:
        """Places (n, 3) on the blade in the machine, and their derivatives by the height."""
        blade, sign = self._generation.blade, self._generation.sign
        widening, steepness, _ = blade.widening(height)
        outward = np.cos(angle)[:, None] * self._axes[0] + np.sin(angle)[:, None] * self._axes[1]
        radius = blade.point_radius + sign * widening
        place = self._centre + radius[:, None] * outward - height[:, None] * self._axes[2]
        return place, sign * steepness[:, None] * outward - self._axes[2]

    @property
    def _blank_axes(self) -> Array:
        """Axes of the blank in rows, in the machine: across its axis from the root line, upwards, along its axis."""
        gamma = self._generation.machine.root_angle
        return np.array([[np.sin(gamma), 0.0, -np.cos(gamma)], [0.0, 1.0, 0.0], [np.cos(gamma), 0.0, np.sin(gamma)]])

    def _on_blank(self, place: Array) -> tuple[Array, Array, Array]:
        """Cylindrical coordinates of places in the machine, in the frame of the right-hand blank."""
        machine = self._generation.machine
        origin = np.array([0.0, machine.blank_offset, machine.sliding_base])
        across, upwards, along = ((place - origin) @ self._blank_axes.T).T
        return np.hypot(across, upwards), np.arctan2(upwards, across), along - machine.machine_centre_to_back
