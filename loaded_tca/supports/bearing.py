"""What a bearing does against the motion of its shaft, and bearings that are linear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from loaded_tca.arrays import Array


@dataclass(frozen=True, eq=False)
class Reaction:
    """What a bearing does against a motion of its inner ring.

    Attributes
    ----------
    energy : float [N mm]
    force : (6,) array [N, N mm]
        On the bearing.
    tangent : (6, 6) array [N, N mm over mm, rad]
        Symmetric, never negative.
    whole : (6,) array [N, N mm]
        What the parts of the force are without their signs: those of pressed bearings are large and cancel, and so
        much is their rounding.
    """

    energy: float
    force: Array
    tangent: Array
    whole: Array


class AnyBearing(Protocol):
    """A bearing of a shaft: where it is, and what it holds."""

    @property
    def at(self) -> float:
        """Its place on the axis [mm]."""

    @property
    def joint(self) -> Array:
        """Stiffness (6, 6) [N, N mm over mm, rad] of what it holds, whatever its load."""

    @property
    def takes(self) -> tuple[int, ...]:
        """Senses along z of the thrusts of the shaft that it takes: +1, -1."""

    def reaction(self, motion: Array) -> Reaction:
        """What it does against a motion (6,) of its inner ring [mm, rad]."""


@dataclass(frozen=True, eq=False)
class Bearing:
    """A linear bearing: its place on the axis [mm], and its stiffness (6, 6) [N, N mm over mm, rad], symmetric."""

    at: float
    stiffness: Array

    @property
    def joint(self) -> Array:
        """Stiffness of what it holds."""
        return self.stiffness

    @property
    def takes(self) -> tuple[int, ...]:
        """Senses along z of the thrusts that it takes: both or none."""
        return (1, -1) if self.stiffness[2, 2] > 0.0 else ()

    def reaction(self, motion: Array) -> Reaction:
        """What it does against a motion (6,)."""
        force = self.stiffness @ motion
        whole = np.abs(self.stiffness) @ np.abs(motion)
        return Reaction(0.5 * float(motion @ force), np.asarray(force), self.stiffness, whole)
