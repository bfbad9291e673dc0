"""Bending of the teeth beneath several contacts: each tooth pair's own, and by what the other pairs carry."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact import FreeEdge
from loaded_tca.separation import Separation


class BendingModel(Protocol):
    """Bending, shear and foundation of teeth and bodies beneath the contacts, for instance by finite elements.

    Tooth pairs are told by their numbers: 0 is in contact at the pitch point at phi1 = 0, +1 comes into mesh after it.
    The grid of a contact stands in the angles of its own tooth: pair k as if it were pair 0, k pitches ago. Its slices
    are cells of one place along the contact.
    """

    def within(self, number: int, separation: Separation, edges: Sequence[FreeEdge] = ()) -> Array:
        """Deflection of every slice under a unit force on each, (ny, ny) [mm/N], symmetric.

        On top of two half-spaces under the same pressures, corrected for free ``edges``.
        """

    def between(self, at: tuple[int, Separation], under: tuple[int, Separation]) -> Array:
        """Deflection of every slice of one contact under a unit force on each slice of another [mm/N].

        Its transpose is that of ``between(under, at)``.
        """


@dataclass(frozen=True, eq=False)
class SliceForces:
    """Forces of a tooth pair on the slices of its grid.

    Attributes
    ----------
    number : int
        Of the tooth pair.
    separation : Separation
    force : (ny,) array [N]
    """

    number: int
    separation: Separation
    force: Array


def coupling_deflection(
    bending: BendingModel, number: int, separation: Separation, others: Iterable[SliceForces]
) -> Array:
    """Displacement of the slices of a tooth pair's grid (ny,) [mm] by what other pairs carry."""
    found = np.zeros(len(separation.y))
    for other in others:
        found += bending.between((number, separation), (other.number, other.separation)) @ other.force
    return found


class KeptCouplings:
    """A bending model that keeps the coupling of two tooth pairs for as long as their grids stay the same.

    Parameters
    ----------
    bending : BendingModel
    """

    def __init__(self, bending: BendingModel) -> None:
        self.within = bending.within
        self._between = bending.between
        self._kept: dict[tuple[int, int], tuple[Separation, Separation, Array]] = {}

    def between(self, at: tuple[int, Separation], under: tuple[int, Separation]) -> Array:
        """Deflections of one contact's slices under forces on another's, as the model has them."""
        kept = self._kept.get((at[0], under[0]))
        if kept is None or kept[0] is not at[1] or kept[1] is not under[1]:
            kept = self._kept[at[0], under[0]] = at[1], under[1], self._between(at, under)
        return kept[2]
