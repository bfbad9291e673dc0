"""Teeth of a rack, and the bed below them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.flanks.base import CylinderFrame, Flank, Point
from loaded_tca.plain import plain
from loaded_tca.tooth.families import CylindricalTooth, Held, StraightRow, ToothForm

ROUNDING = 1e-9
"""Of a pitch, by which a toothed part of whole pitches may be short."""
REACH = 4.0
"""Body beyond the teeth that are modelled, over the depth of the bed: of a wheel of 1e4 teeth 3 left out 3e-5 of the
transmission error of the whole ring, 1.5 left out 4e-4, 6 less than 1e-6."""


@dataclass(frozen=True)
class Bed(Held):
    """A plane below the teeth of a rack that is held rigid.

    Parameters
    ----------
    depth : float [mm]
        Below the root line.

    Examples
    --------
    >>> Bed(10.0).radius(None, np.array([50.0]))
    array([40.])
    """

    depth: float

    def radius(self, diameter: float | None, root: Array) -> Array:  # noqa: ARG002 (a rack has no bore)
        """Radius (k,) of the bed in the gear that stands for the rack [mm]."""
        return root - self.depth

    def pitches_beyond(self, root: Array, held: Array, teeth: int) -> int:
        """Pitches of the body that count beside the modelled teeth: the body is a piece of the ring."""
        pitch = 2.0 * math.pi * float(np.max(root)) / teeth
        return math.ceil(REACH * float(np.max(root - held)) / pitch)


@dataclass(frozen=True)
class RackFrame(CylinderFrame):
    """Axial place from mid-face, against the height above the reference line of a rack.

    Parameters
    ----------
    reference_radius : float [mm]
        Of the gear that stands for the rack.

    Examples
    --------
    >>> RackFrame(3e6).place(3e6 + 1.25, 3.0)
    '1.25 mm above the reference line, 3 mm from mid-face'
    """

    reference_radius: float

    labels = ("axial position from mid-face [mm]", "height above the reference line [mm]")
    edges = ("tip line", "root form line", "end of the face at z < 0", "end of the face at z > 0")

    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Axial coordinate and height [mm]."""
        return z, rho - self.reference_radius

    def profile_span(self, first: Point, last: Point) -> str:
        """Heights."""
        ends = (point[0] - self.reference_radius for point in (first, last))
        return "height " + " to ".join(f"{height:.2f}" for height in ends) + " mm above the reference line"

    def place(self, rho: float, z: float) -> str:
        """Height and axial position."""
        height = round(rho - self.reference_radius, 3)
        side = "above" if height >= 0.0 else "below"
        return f"{plain(abs(height))} mm {side} the reference line, {plain(round(z, 3), 3)} mm from mid-face"


@dataclass(frozen=True)
class RackTooth(CylindricalTooth):
    """Teeth of a rack on their bed.

    Parameters
    ----------
    gear : CylindricalGear
        That stands for the rack.
    working_radius, active, modifications
        As of every ``InvoluteTooth``.
    bed_depth : float [mm]
        Below the root line.
    length : float [mm], optional
        Of the toothed part, along the travel.
    """

    bed_depth: float = 0.0
    length: float | None = None

    def nominal(self, side: int) -> Flank:
        """Flank of a side, shown by heights above the reference line."""
        flank = super().nominal(side)
        flank.frame = RackFrame(self.gear.reference_radius)
        return flank

    def form(self) -> ToothForm:
        """Form of a cylindrical gear, held by its bed, whose teeth stand along the reference line."""
        radius = self.gear.reference_radius
        pitch = 2.0 * math.pi * radius / self.gear.teeth
        teeth = None if self.length is None else int(self.length / pitch + ROUNDING)
        return replace(super().form(), held=Bed(self.bed_depth), row=StraightRow(radius, pitch, teeth))
