"""Bending of the teeth beneath several contacts: each tooth pair's own, and by what the other pairs carry."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from loaded_tca.arrays import Array
from loaded_tca.compliance.compliance import ContactGrid
from loaded_tca.separation import Separation


class BendingModel(Protocol):
    """Bending, shear and foundation of teeth and bodies beneath the contacts, for instance by finite elements.

    Tooth pairs are told by their numbers: 0 is in contact at the pitch point at phi1 = 0, +1 comes into mesh after it.
    The grid of a contact stands in the angles of its own tooth: pair k as if it were pair 0, k pitches ago. Its slices
    are cells of one place along the contact.
    """

    @property
    def neighbours(self) -> int:
        """How many pitches two loaded tooth pairs may be apart."""

    def within(self, number: int, grid: ContactGrid) -> Array:
        """Deflection of every slice under a unit force on each, (ny, ny) [mm/N], symmetric.

        On top of two half-spaces under the same pressures.
        """

    def between(self, at: tuple[int, Separation], under: tuple[int, Separation]) -> Array:
        """Deflection of every slice of one contact under a unit force on each slice of another [mm/N].

        Its transpose is that of ``between(under, at)``.
        """


Coupling = Callable[[Separation], Array | None]
"""Displacement of the slices of a tooth pair's grid (ny,) [mm] by what the other pairs carry; None if nothing bends."""
