r"""Involute helicoids, the flanks of spur and helical gears and of ring gears.

.. math:: \Theta = s\,[\mathrm{inv}\,\alpha_w - \mathrm{inv}\,\alpha_\rho] + z \tan\beta_b / r_b,
          \qquad \cos\alpha_\rho = r_b/\rho

turned so that the point on the working circle at mid-face has theta = 0. With the roll length
a = sqrt(rho^2 - r_b^2): inv = a/r_b - atan(a/r_b), d inv/d rho = a/(r_b rho).

The surface of a ring gear is that of an external tooth of the same base circle, seen from the other side of it, with
the bracket's opposite sign: teeth of a ring grow thicker outwards. The tip lies inside, the root outside, and the roll
length falls from the root to the tip; the coordinate of profile modifications is the roll length with a minus, which
rises to the tip as on every flank. The z axis of a ring's own frame points against that of the pinion: its lengthwise
coordinate is -z, so that the lower and the upper end of its face are those of the pinion.

References
----------
ISO 21771, 5.2 to 5.5, with the signs of internal gears; Litvin & Fuentes 2004, Gear Geometry and Applied Theory,
chapter 14.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import CylinderFrame, Flank, Jet, Point

SMALLEST_ROLL_LENGTH = 1e-6
"""Roll lengths are kept above this fraction of r_b: at the base circle itself the curvature is infinite."""


@checked
class InvoluteFlank(Flank):
    """Unmodified involute helicoid between form circle and tip circle, over the face width.

    Parameters
    ----------
    base_radius : float [mm]
    base_helix_angle : float [rad]
        beta_b, positive for a right-hand gear.
    side : int
        s, +1 or -1.
    working_radius : float [mm]
        Radius of the point with theta = 0 at z = 0.
    radii : (float, float) [mm]
        Root form circle and tip circle.
    face_width : float [mm]
    """

    def __init__(
        self,
        base_radius: float,
        base_helix_angle: float,
        side: int,
        working_radius: float,
        radii: tuple[float, float],
        face_width: float,
    ) -> None:
        if not base_radius <= radii[0] < radii[1]:
            raise InputError(f"radii: base {base_radius} <= form {radii[0]} < tip {radii[1]} mm does not hold")
        self.base_radius, self.base_helix_angle, self.side = base_radius, base_helix_angle, side
        self.radii, self.face_width = radii, face_width
        self.roll_unit = base_radius
        self.extent = (radii[1] - radii[0], face_width)
        self.frame = CylinderFrame()
        self._turn = -float(side)  # teeth grow thinner outwards
        self._twist = math.tan(base_helix_angle) / base_radius
        roll = math.sqrt(working_radius**2 - base_radius**2) / base_radius
        self._working_involute = roll - math.atan(roll)

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:  # noqa: ARG002 (it has no relief start)
        """Theta of the involute helicoid."""
        roll, turn = self._roll_length(rho), self._turn / self.base_radius
        angle, steepness = roll / self.base_radius, roll / rho
        involute = angle - np.arctan(angle) - self._working_involute
        value = self._turn * involute + self._twist * z
        return Jet(value, turn * steepness, self._twist, lambda: (turn * (1.0 / roll - steepness / rho), 0.0, 0.0))

    def edges(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Tip circle, root form circle, the two ends of the face."""
        half = 0.5 * self.face_width
        return (
            Jet(self.radii[1] - rho, rho=-1.0),
            Jet(rho - self.radii[0], rho=1.0),
            Jet(z + half, z=1.0),
            Jet(half - z, z=-1.0),
        )

    def grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """Even grid in roll length and face width: near the base circle the profile bends most."""
        start, end = self._roll_length(np.array(self.radii))
        rho = np.hypot(self.base_radius, np.linspace(start, end, profile))
        rho[[0, -1]] = self.radii
        z = np.linspace(-0.5 * self.face_width, 0.5 * self.face_width, lengthwise)
        return tuple(np.meshgrid(rho, z, indexing="ij"))  # type: ignore[return-value]

    def profile_coordinate(self, rho: Array, z: Array) -> Jet:  # noqa: ARG002 (it depends on the radius alone)
        """Roll length a = sqrt(rho^2 - r_b^2)."""
        roll = self._roll_length(rho)
        return Jet(roll, rho / roll, 0.0, lambda: (-(self.base_radius**2) / (roll * roll * roll), 0.0, 0.0))

    def lengthwise_coordinate(self, rho: Array, z: Array) -> Jet:  # noqa: ARG002
        """Z itself, counted from the middle of the face."""
        return Jet(z, z=1.0)

    def gradient_norm(self, rho: Array, z: Array) -> Jet:  # noqa: ARG002 (it is constant)
        """1/(r_b cos beta_b), the same everywhere on an involute helicoid."""
        return Jet(1.0 / (self.base_radius * math.cos(self.base_helix_angle)))

    def _roll_length(self, rho: Array) -> Array:
        smallest = SMALLEST_ROLL_LENGTH * self.base_radius
        square = (rho - self.base_radius) * (rho + self.base_radius)
        return np.sqrt(np.maximum(square, smallest**2))


@dataclass(frozen=True)
class RingFrame(CylinderFrame):
    """Axial place from mid-face along the pinion's z axis, against the diameter, which is negative for internal gears.

    Examples
    --------
    >>> RingFrame().place(51.0, 3.0)
    'diameter 102 mm, -3 mm from mid-face'
    """

    upwards = -1
    labels = ("axial position from mid-face [mm]", "diameter [mm], of a ring with a minus")

    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Axial coordinate and diameter [mm], the latter with a minus: the tip on top."""
        return -z, -2.0 * rho

    def profile_span(self, first: Point, last: Point) -> str:
        """Diameters."""
        return f"diameter {2.0 * first[0]:.2f} to {2.0 * last[0]:.2f} mm"

    def place(self, rho: float, z: float) -> str:
        """Diameter and axial position."""
        return super().place(rho, -z)


class RingFlank(InvoluteFlank):
    """Unmodified involute helicoid of a ring gear between tip circle and form circle, over the face width.

    Parameters
    ----------
    base_radius : float [mm]
    base_helix_angle : float [rad]
        beta_b, positive for a right-hand gear.
    side : int
        s, +1 or -1.
    working_radius : float [mm]
        Radius of the point with theta = 0 at z = 0.
    radii : (float, float) [mm]
        Root form circle and tip circle, the first one the larger.
    face_width : float [mm]

    Raises
    ------
    InputError
        If the radii are not in this order, or the tip lies inside the base circle.
    """

    def __init__(
        self,
        base_radius: float,
        base_helix_angle: float,
        side: int,
        working_radius: float,
        radii: tuple[float, float],
        face_width: float,
    ) -> None:
        if not base_radius <= radii[1] < radii[0]:
            raise InputError(f"radii: base {base_radius} <= tip {radii[1]} < form {radii[0]} mm does not hold")
        super().__init__(base_radius, base_helix_angle, side, working_radius, radii[::-1], face_width)
        self.radii = radii
        self.extent = (radii[0] - radii[1], face_width)
        self.frame = RingFrame()
        self._turn = float(side)
        self.profile_unit, self.roll_unit = -1.0, -base_radius

    def edges(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Tip circle, root form circle, the two ends of the face, the lower one of the pinion's z first."""
        half = 0.5 * self.face_width
        return (
            Jet(rho - self.radii[1], rho=1.0),
            Jet(self.radii[0] - rho, rho=-1.0),
            Jet(half - z, z=-1.0),
            Jet(z + half, z=1.0),
        )

    def grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """Even grid in roll length and face width, from root to tip and from the lower to the upper end of the face."""
        rho, z = super().grid(profile, lengthwise)
        return rho, -z

    def profile_coordinate(self, rho: Array, z: Array) -> Jet:
        """Roll length with a minus, -sqrt(rho^2 - r_b^2): it rises from root to tip."""
        return super().profile_coordinate(rho, z) * -1.0

    def lengthwise_coordinate(self, rho: Array, z: Array) -> Jet:  # noqa: ARG002
        """Minus z, counted from the middle of the face along the pinion's z axis."""
        return Jet(-z, z=-1.0)
