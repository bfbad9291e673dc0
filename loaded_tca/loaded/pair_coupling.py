"""Teeth that bend beneath several contacts: what each pair does to its own columns, and to those of the others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.edges import FreeEdge
from loaded_tca.loaded.tooth_contact import Beneath, LoadedContact
from loaded_tca.separation import Separation

Pressed = Sequence[LoadedContact | None]
"""Contacts of tooth pairs as they were pressed last; None where a pair never was."""


class TeethYield(Protocol):
    """What bends and shears beneath the contacts, for instance by finite elements.

    Tooth pairs are told by their numbers: 0 touches at the pitch point at phi1 = 0, +1 comes into mesh after it. The
    grid of a contact stands in the angles of its own tooth: pair k as if it were pair 0, k pitches ago. Its columns are
    cells of one place along the contact.
    """

    def within(self, number: int, separation: Separation, edges: Sequence[FreeEdge] = ()) -> Array:
        """Closing of every column that a unit force on each takes up, (ny, ny) [mm/N], symmetric.

        On top of two half-spaces under the same pressures, corrected for free ``edges``.
        """

    def between(self, at: tuple[int, Separation], under: tuple[int, Separation]) -> Array:
        """Closing of every column of one contact that a unit force on each column of another takes up [mm/N].

        Its transpose is that of ``between(under, at)``.
        """


class LoadedTeeth:
    """The teeth of a position, told by the place of their pair among those that may touch.

    Parameters
    ----------
    teeth : TeethYield
    numbers : sequence of int, (k,)
        Of the tooth pairs.
    """

    def __init__(self, teeth: TeethYield, numbers: Sequence[int]) -> None:
        self._teeth, self._numbers = teeth, numbers
        self._couplings: dict[tuple[int, int], _Coupling] = {}

    def beneath(self, index: int, pressed: Pressed, forces: Array) -> Beneath:
        """Return what yields beneath a contact while the others carry their forces (k,) [N]."""
        return Beneath(
            own=lambda separation, edges: self._teeth.within(self._numbers[index], separation, edges),
            lift=lambda separation: self.lift(index, separation, pressed, forces),
        )

    def lift(self, index: int, separation: Separation, pressed: Pressed, forces: Array) -> Array:
        """Displacement of the columns of a grid (ny,) [mm] by what the other pairs carry."""
        lift = np.zeros(len(separation.y))
        for other, loaded in _loaded(pressed):
            if other != index and forces[other] > 0.0:
                lift += forces[other] * (self._coupling(index, separation, other, loaded) @ _shares(loaded))
        return lift

    def moved(self, index: int, pressed: Pressed, forces: Array) -> float:
        """How far the others move loaded columns of a pair against each other since it was pressed [mm]."""
        loaded = pressed[index]
        if loaded is None or loaded.lift is None or not loaded.solution.load:
            return 0.0
        by_now = self.lift(index, loaded.separation, pressed, forces)
        return float(np.ptp((by_now - loaded.lift)[loaded.column_force > 0.0]))

    def correct(self, matrix: Array, pressed: Pressed) -> None:
        """Put the mean compliances over the forces of all pressed pairs into a matrix (k, k) [mm/N]."""
        for index, loaded in _loaded(pressed):
            matrix[index, index] = loaded.own_deflection / loaded.solution.load
        for (index, one), (other, two) in combinations(_loaded(pressed), 2):
            coupling = _shares(one) @ self._coupling(index, one.separation, other, two) @ _shares(two)
            matrix[index, other] = matrix[other, index] = coupling

    def _coupling(self, index: int, separation: Separation, other: int, loaded: LoadedContact) -> Array:
        """Compliance of the columns of a grid under those of another contact, known as long as both grids stay."""
        kept = self._couplings.get((index, other))
        if kept is None or kept.at is not separation or kept.under is not loaded.separation:
            numbers = self._numbers[index], self._numbers[other]
            found = self._teeth.between((numbers[0], separation), (numbers[1], loaded.separation))
            kept = self._couplings[index, other] = _Coupling(separation, loaded.separation, found)
        return kept.compliance


@dataclass(frozen=True, eq=False)
class _Coupling:
    """Compliance (m, n) [mm/N] of the columns of one grid under those of another."""

    at: Separation
    under: Separation
    compliance: Array


def _loaded(pressed: Pressed) -> Iterator[tuple[int, LoadedContact]]:
    """Place and contact of those that carry something."""
    return (
        (index, loaded) for index, loaded in enumerate(pressed) if loaded is not None and loaded.solution.load > 0.0
    )


def _shares(loaded: LoadedContact) -> Array:
    """Shares of the columns in the force of a contact, (ny,)."""
    force = loaded.column_force
    return np.asarray(force / force.sum())
