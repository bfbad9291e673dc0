"""The bending model of an analysis: what gives way beneath the contacts, beside the half-spaces, as a sum of parts.

``PARTS`` is the one place that names them. A further compliance, of shafts for instance, is a function that makes its
part for a scene, and its name there: analyses, designs and the sensitivities of results from a file all ask
:func:`model_of`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, Self, TypeVar

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.body import body_torsion
from loaded_tca.compliance.compliance import rim_compliance, tooth_compliance
from loaded_tca.compliance.teeth import way_out_told
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair, MovedSlices
from loaded_tca.scene import Scene
from loaded_tca.scene.build import arguments_by_keys
from loaded_tca.supports import SupportCompliance, support_compliance

Solved = TypeVar("Solved", bound="_OfPairs")
THINNER = 0.5
"""Tooth heights by which a rim is thinner than that of the usual bore, from where its effect is found."""


class BendingModel(Protocol):
    """Bending, shear and foundation of teeth and bodies beneath the contacts, for instance by finite elements.

    Tooth pairs are told by their numbers: 0 is in contact at the pitch point at phi1 = 0, +1 comes into mesh after it.
    The grid of a contact stands in the angles of its own tooth: pair k as if it were pair 0, k pitches ago. Its slices
    are cells of one place along the contact.
    """

    @property
    def neighbours(self) -> int:
        """How many pitches two loaded tooth pairs may be apart."""

    def within(self, number: int, grid: ContactGrid, under: ContactGrid | None = None) -> Array:
        """Deflection of every slice under a unit force on each, (ny, ny) [mm/N], symmetric.

        On top of two half-spaces under the same pressures. ``under``: other slices of the contact, which carry the
        forces.
        """

    def within_each(self, contacts: Sequence[tuple[int, ContactGrid]]) -> list[Array]:
        """Results of :meth:`within` for the numbers and grids of several contacts; none depends on the others."""
        return [self.within(number, grid) for number, grid in contacts]

    def between(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid]) -> Array:
        """Deflection of every slice of one contact under a unit force on each slice of another [mm/N].

        Its transpose is that of ``between(under, at)``.
        """

    def deflection(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid], forces: Array) -> Array:
        """Deflection (m,) [mm] of the slices of one contact under forces (n,) [N] on those of another.

        The product of ``between`` with the forces; a model that has it without the matrix is asked for no matrix.
        """
        matrix = self.between(at, under) if at[0] < under[0] else self.between(under, at).T
        return np.asarray(matrix @ forces)


class BendingPart(BendingModel, Protocol):
    """A bending model whose gears can stand elsewhere."""

    def mounted(self, pair: GearPair) -> Self:
        """These bodies in a pair whose wheel stands elsewhere."""

    def deflection_growth(
        self, contacts: Sequence[tuple[int, ContactGrid]], state: Indices, forces: Array, moved: Sequence[MovedSlices]
    ) -> Array:
        """Growth (keys, n) [mm per unit] of the deflection of slices under forces as they are, as gears and grids move.

        Parameters
        ----------
        contacts : sequence of (int, ContactGrid)
            Numbers and grids of contacts of many states, state by state.
        state : (contacts,) int array
            That each belongs to: contacts of one state deflect each other.
        forces : (n,) array [N]
            On the slices of all contacts, in one row; where there are none, the growth is left out.
        moved : sequence of MovedSlices
            With each key, the slices of all contacts.
        """


@dataclass(frozen=True, eq=False)
class SumOfParts(BendingModel):
    """Deflections of several parts under the same forces, added up.

    Attributes
    ----------
    parts : tuple of BendingPart
        At least one.
    """

    parts: tuple[BendingPart, ...]

    @property
    def neighbours(self) -> int:
        """How many pitches two loaded tooth pairs may be apart and deflect each other: what any part allows."""
        return max(part.neighbours for part in self.parts)

    def within(self, number: int, grid: ContactGrid, under: ContactGrid | None = None) -> Array:
        """Deflection of every slice under a unit force on each, or on each of ``under`` [mm/N]."""
        return _sum([part.within(number, grid, under) for part in self.parts])

    def within_each(self, contacts: Sequence[tuple[int, ContactGrid]]) -> list[Array]:
        """Results of :meth:`within` for the numbers and grids of several contacts."""
        return [
            _sum([*of_parts]) for of_parts in zip(*(part.within_each(contacts) for part in self.parts), strict=True)
        ]

    def between(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid]) -> Array:
        """Deflection of every slice of one contact under a unit force on each slice of another [mm/N]."""
        parts = self._parts_between(at[0], under[0])
        return _sum([part.between(at, under) for part in parts]) if parts else np.zeros((len(at[1].y), len(under[1].y)))

    def deflection(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid], forces: Array) -> Array:
        """Deflection (m,) [mm] of the slices of one contact under forces (n,) [N] on those of another."""
        parts = self._parts_between(at[0], under[0])
        return _sum([part.deflection(at, under, forces) for part in parts]) if parts else np.zeros(len(at[1].y))

    def _parts_between(self, one: int, other: int) -> list[BendingPart]:
        """Parts in which a force on one tooth pair moves the other: teeth so far apart may be in no model of teeth."""
        return [part for part in self.parts if abs(one - other) <= part.neighbours]

    @property
    def supports(self) -> SupportCompliance | None:
        """Its part that is the supports, if there is one."""
        return next((part for part in self.parts if isinstance(part, SupportCompliance)), None)

    @property
    def coupled_pitches(self) -> int:
        """How many pitches two tooth pairs may be apart that its teeth couple; 0 where no teeth bend."""
        return 0 if (teeth := self.on_rigid_supports) is None else teeth.neighbours

    def on_supports(self, supports: SupportCompliance) -> SumOfParts:
        """These parts with other supports."""
        return SumOfParts(tuple(supports if isinstance(part, SupportCompliance) else part for part in self.parts))

    @property
    def on_rigid_supports(self) -> SumOfParts | None:
        """The other parts; None without any."""
        parts = tuple(part for part in self.parts if not isinstance(part, SupportCompliance))
        return SumOfParts(parts) if parts else None

    @property
    def giving_way(self) -> SumOfParts | None:
        """The parts without supports that are rigid, so that these are as none; None where none is left."""
        return self.on_rigid_supports if self.supports is not None and self.supports.is_rigid else self

    def mounted(self, pair: GearPair) -> SumOfParts:
        """These parts in a pair whose wheel stands elsewhere."""
        return SumOfParts(tuple(part.mounted(pair) for part in self.parts))

    def deflection_growth(
        self, contacts: Sequence[tuple[int, ContactGrid]], state: Indices, forces: Array, moved: Sequence[MovedSlices]
    ) -> Array:
        """Growth (keys, n) [mm per unit] of the deflection of slices, as of :class:`BendingPart`."""
        return _sum([part.deflection_growth(contacts, state, forces, moved) for part in self.parts])


def _sum(deflections: list[Array]) -> Array:
    first, *others = deflections
    for deflection in others:
        first = first + deflection
    return first


def teeth_and_bodies(scene: Scene, pair: GearPair, neighbours: int) -> BendingPart | None:
    """Teeth, foundations and gear bodies by finite elements; None where the scene lets the flanks alone give way."""
    if not scene.analysis.teeth_bend:
        return None
    with arguments_by_keys(type(scene)), way_out_told():
        return tooth_compliance(pair, neighbours=neighbours)


@dataclass(frozen=True)
class HeldBodies:
    """What bores that are held rigid do in :func:`teeth_and_bodies`, both gears together.

    Attributes
    ----------
    torsion : float [mm/N]
        Twist of the bodies, see ``body_torsion``.
    stiffening : float [mm/N]
        How much less they give way, at the base circle per force there, than if the bores were not given.
    usual_bores : (float, float) [mm]
        Those of gears that have none: seats of shafts, or the default.
    """

    torsion: float = 0.0
    stiffening: float = 0.0
    usual_bores: tuple[float, float] = (0.0, 0.0)


def held_bodies(scene: Scene, pair: GearPair) -> HeldBodies:
    """What the bores of a scene's pair do; their effect is found where a rim is thinner by half a tooth height."""
    if not scene.analysis.teeth_bend:
        return HeldBodies()
    usual, difference = scene.without_bores(pair), 0.0
    rims = [[gear.rim_over_height for gear in (one.pinion, one.wheel)] for one in (usual, pair)]
    if max(there - here for there, here in zip(*rims, strict=True)) > THINNER:
        difference = max(0.0, sum(rim_compliance(usual)) - sum(rim_compliance(pair)))
    return HeldBodies(sum(body_torsion(pair)), difference, usual.rigid_bores)


def shafts_and_bearings(scene: Scene, pair: GearPair, _: int) -> BendingPart | None:
    """Supports of both gears; None where the scene has none."""
    return support_compliance(scene, pair)


PARTS: tuple[Callable[[Scene, GearPair, int], BendingPart | None], ...] = (teeth_and_bodies, shafts_and_bearings)
"""What a bending model is the sum of: each makes its part, or None where the scene does not ask for it."""


def model_of(scene: Scene, pair: GearPair, neighbours: int) -> SumOfParts | None:
    """Bending model that a scene asks for.

    Parameters
    ----------
    scene : Scene
    pair : GearPair
        Of the scene.
    neighbours : int
        How many pitches two loaded tooth pairs are apart at the most; one is modelled at least.

    Returns
    -------
    SumOfParts or None
        None if the scene asks for no part.

    Raises
    ------
    InputError, GeometryError
        If a gear body that the scene asks for cannot be built; the setting that needs none is named.

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> scene = parse_scene(DEMO_SCENE.read_text()).with_changes({"analysis.compliance": "contact"})
    >>> model_of(scene, scene.pair(), 1) is None
    True
    """
    parts = [part for make in PARTS if (part := make(scene, pair, max(neighbours, 1))) is not None]
    return SumOfParts(tuple(parts)) if parts else None


class _OfPairs(Protocol):
    """What is known of tooth pairs under load."""

    @property
    def pitches_apart(self) -> int:
        """How many pitches two of them that carry load together are apart at the most."""


def with_enough_teeth(estimated: int, make: Callable[[int], list[Solved]]) -> list[Solved]:
    """What is solved with a bending model, its teeth as many as those between tooth pairs that carry load together.

    Where gears move under load, how far such pairs are apart is only an estimate before they have. Of pairs further
    apart than the model of the teeth it has what supports couple alone, so that all is solved again with a larger one.

    Parameters
    ----------
    estimated : int
        How many pitches tooth pairs under load are apart at the most, before they are solved.
    make : callable
        Solves with a model of so many neighbours of a loaded tooth; each part knows its ``pitches_apart``.
    """
    modelled = max(estimated, 1)
    solved = make(modelled)
    while (apart := max(one.pitches_apart for one in solved)) > modelled:
        modelled, solved = apart, make(apart)
    return solved
