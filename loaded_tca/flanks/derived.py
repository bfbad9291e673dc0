"""Flanks made from another one, whose region, coordinates and |grad F| they keep."""

from __future__ import annotations

from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.jet import Jet


class DerivedFlank(Flank):
    """What a flank takes over from the nominal one: everything but Theta and the relief starts.

    Parameters
    ----------
    nominal : Flank
    """

    def __init__(self, nominal: Flank) -> None:
        self.nominal = nominal
        self.side, self.extent, self.frame = nominal.side, nominal.extent, nominal.frame
        self.profile_unit = nominal.profile_unit

    def edges(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Edges of the nominal flank."""
        return self.nominal.edges(rho, z)

    def grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """Grid of the nominal flank."""
        return self.nominal.grid(profile, lengthwise)

    def profile_coordinate(self, rho: Array, z: Array) -> Jet:
        """Profile coordinate of the nominal flank."""
        return self.nominal.profile_coordinate(rho, z)

    def lengthwise_coordinate(self, rho: Array, z: Array) -> Jet:
        """Lengthwise coordinate of the nominal flank."""
        return self.nominal.lengthwise_coordinate(rho, z)

    def gradient_norm(self, rho: Array, z: Array) -> Jet:
        """|grad F| of the nominal flank."""
        return self.nominal.gradient_norm(rho, z)


class Region(DerivedFlank):
    """The region of a flank and its coordinates, without its surface: Theta = 0."""

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:  # noqa: ARG002 (it has no relief start)
        """Nothing."""
        return Jet(np.zeros(np.broadcast(rho, z).shape))


def unmodified(flank: Flank) -> Flank:
    """The flank at the bottom of all that was derived from it."""
    while isinstance(flank, DerivedFlank):
        flank = flank.nominal
    return flank
