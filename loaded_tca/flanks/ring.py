r"""Involute helicoid of a ring gear.

.. math:: \Theta = s\,[\mathrm{inv}\,\alpha_\rho - \mathrm{inv}\,\alpha_w] + z \tan\beta_b / r_b,
          \qquad \cos\alpha_\rho = r_b/\rho

The surface is that of an external tooth of the same base circle, seen from the other side of it: teeth of a ring grow
thicker outwards. The tip lies inside, the root outside, and the roll length falls from the root to the tip; the
coordinate of profile modifications is the roll length with a minus, which rises to the tip as on every flank. The z
axis of a ring's own frame points against that of the pinion: its lengthwise coordinate is -z, so that the lower and the
upper end of its face are those of the pinion.

References
----------
ISO 21771, 5.2 to 5.5 (signs of internal gears).
"""

from __future__ import annotations

from dataclasses import dataclass

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import CylinderFrame, Jet, Point
from loaded_tca.flanks.cylindrical import InvoluteFlank


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
