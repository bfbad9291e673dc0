"""How places on a flank appear to an engineer: where along the tooth, how high on it, and what its ends are called.

Flanks are computed in the cylindrical coordinates (rho, z) of their gear. On pictures and in messages a cylindrical
gear is seen by its diameters and from mid-face, a bevel gear by its cone distances and from its pitch cone.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array

Point = tuple[float, float]
"""(rho, z) [mm]."""


class FlankFrame(ABC):
    """Coordinates of a flank in pictures and messages; in pictures the root lies at the bottom, the tip on top.

    Attributes
    ----------
    labels : (str, str)
        Of the horizontal axis (lengthwise) and the vertical one (along the profile), with their units.
    heelwards : str
        What lies to the right, where the lengthwise coordinate is large.
    edges : (str, str, str, str)
        Names of the edges, in the order of ``Flank.edges``: tip, root, left end, right end.
    """

    labels: tuple[str, str]
    heelwards: str
    edges: tuple[str, str, str, str]

    @abstractmethod
    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Lengthwise place and height (...) of points (rho, z) [mm]."""

    @abstractmethod
    def profile_span(self, first: Point, last: Point) -> str:
        """Between which diameters or cones a piece of the profile lies, given the (rho, z) of its ends."""

    @abstractmethod
    def place(self, rho: float, z: float) -> str:
        """Where on the flank a point lies."""


@dataclass(frozen=True)
class CylinderFrame(FlankFrame):
    """Axial place from mid-face, against the diameter.

    Examples
    --------
    >>> CylinderFrame().place(51.0, 3.0)
    'diameter 102 mm, 3 mm from mid-face'
    """

    labels = ("axial position from mid-face [mm]", "diameter [mm]")
    heelwards = "z > 0"
    edges = ("tip circle", "root form circle", "end of the face at z < 0", "end of the face at z > 0")

    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Axial coordinate and diameter [mm]."""
        return z, 2.0 * rho

    def profile_span(self, first: Point, last: Point) -> str:
        """Diameters."""
        return f"diameter {2.0 * first[0]:.2f} to {2.0 * last[0]:.2f} mm"

    def place(self, rho: float, z: float) -> str:
        """Diameter and axial position."""
        return f"diameter {2.0 * rho:.4g} mm, {_rounded(z)} mm from mid-face"


@dataclass(frozen=True)
class ConeFrame(FlankFrame):
    """Cone distance from the middle of the face, against the height R (u - delta) above the pitch cone.

    Parameters
    ----------
    pitch_angle : float [rad]
        delta.
    mean_cone_distance : float [mm]
        R_m, in the middle of the face.

    Examples
    --------
    >>> frame = ConeFrame(math.radians(45), 100.0)
    >>> frame.place(100.0 * math.sin(0.8), 100.0 * math.cos(0.8))
    'in the middle of the face, 1.46 mm above the pitch cone'
    """

    pitch_angle: float
    mean_cone_distance: float

    labels = ("cone distance from mid-face [mm], toe left, heel right", "height above the pitch cone [mm]")
    heelwards = "the heel"
    edges = ("face cone", "root form cone", "toe", "heel")

    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """R - R_m and R (u - delta) [mm]."""
        distance = np.hypot(rho, z)
        return distance - self.mean_cone_distance, distance * (np.arctan2(rho, z) - self.pitch_angle)

    def profile_span(self, first: Point, last: Point) -> str:
        """Cone angles."""
        angles = (math.degrees(math.atan2(*point)) for point in (first, last))
        return "cone angle " + " to ".join(f"{angle:.2f}" for angle in angles) + " deg"

    def place(self, rho: float, z: float) -> str:
        """Cone distance from the middle and height."""
        lengthwise, height = (float(part) for part in self.to_picture(np.array(rho), np.array(z)))
        side = "above" if height >= 0.0 else "below"
        end = "heel" if lengthwise >= 0.0 else "toe"
        along = _rounded(abs(lengthwise))
        where = "in the middle of the face" if along == "0" else f"{along} mm from mid-face to the {end}"
        return f"{where}, {_rounded(abs(height))} mm {side} the pitch cone"


def _rounded(length: float) -> str:
    """Three digits, not finer than a micrometre."""
    return f"{round(length, 3) + 0.0:.3g}"
