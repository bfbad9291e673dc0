r"""The torque shared over the tooth pairs that can touch at one position: one common rotation, one force for each.

Load lets the wheel lag by a rotation theta against its unloaded place. That closes tooth pair k, whose own flanks
touch at the lag theta_k, by the lever of its contact about the wheel's axis times what is left of the rotation, and
the closing is the approach of its contact and the deflection of the teeth:

.. math:: l_{2k} (\theta - \theta_k) = \delta_k(F_k) + \sum_j C_{kj} F_j \quad\text{where } F_k > 0, \qquad
          \sum_k l_{1k} F_k = T_1 .

A pair that is apart carries nothing. The torque grows with the rotation, so that there is one answer.

The contact law delta_k(F) is known from presses alone. Between them it is a power of the force, 2/3 for points and
nearly 1 for lines, its exponent taken from the last two presses: balance the powers, press every pair with its force,
correct the powers, until the approaches agree. The forces of the last press fulfil the balance of the torque to
rounding; what is left is a difference in the rotation that each pair asks for, ``residual``.

The lever is that of the contact point for the whole contact. It is the same at every point of two involute helicoids
(its own normal given); on bevel gears it grows with the cone distance, and the force is taken at the contact point.

References
----------
Conry & Seireg 1973, J. Eng. Ind. 95, 1115-1122 (compatibility of the tooth pairs); Vijayakar 1991, Int. J. Numer.
Meth. Eng. 31, 525-545 (contact by the half-space, teeth by finite elements); Johnson 1985, Contact Mechanics, eq. 4.23.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, product
from typing import Protocol

import numpy as np

from loaded_tca.contact.edges import FreeEdge
from loaded_tca.contact_laws import PowerLaw, balance
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.loaded_contact import Beneath, GridChoice, LoadedContact, press
from loaded_tca.pair import GearPair
from loaded_tca.separation import Separation
from loaded_tca.unloaded import ContactPoint, MeshPath

MOST_BALANCES = 40
"""Balances before giving up; two to four are the rule."""
AGREEMENT = 5e-2
"""Wanted agreement of the rotations, relative, over the accuracy of the peak pressure."""
AGREEMENT_ON_CELLS = 1e-5
"""The same where the cells are given."""
SETTLED = 10.0
"""Change of how the columns of a pair are displaced, over its closing, in agreements: it only moves force about."""
SAME_BOX = (0.75, 1.25)
"""Loads over the one a box was made for, between which the contact still fills it well."""
SOFTEST_START = 4.0
"""First guess of an approach: so many times F/(E* b), as slender contacts of gears have it."""


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


@dataclass(frozen=True, eq=False)
class Touch:
    """A tooth pair that may carry load at a position.

    Attributes
    ----------
    pair : int
        Its number.
    contact : ContactPoint
        Its first touch, unloaded, in the angles of its own tooth.
    lag : float [rad]
        Rotation of the wheel at which it touches; zero for the leading pair.
    """

    pair: int
    contact: ContactPoint
    lag: float


@dataclass(frozen=True, eq=False)
class Share:
    """What one tooth pair carries.

    Attributes
    ----------
    touch : Touch
    loaded : LoadedContact
        Its contact under its force.
    deflection : float [mm]
        What of its closing bends the teeth, not the contact.
    """

    touch: Touch
    loaded: LoadedContact
    deflection: float

    @property
    def force(self) -> float:
        """Normal force [N]."""
        return self.loaded.solution.load

    @property
    def torque(self) -> float:
        """Its part of the pinion torque [N mm]."""
        return float(self.force * self.touch.contact.pinion_lever)

    @property
    def law(self) -> PowerLaw:
        """Approach of its flanks near its force, which must not be zero."""
        bending = self.loaded.own_deflection / self.force
        slope = 1.0 / self.loaded.stiffness - bending
        return PowerLaw.along(self.force, self.loaded.approach, slope)

    @property
    def rotation(self) -> float:
        """Rotation that its closing asks for [rad]."""
        closing = self.loaded.approach + self.deflection
        return float(self.touch.lag + closing / self.touch.contact.wheel_lever)


@dataclass(frozen=True)
class Laws:
    """How tooth pairs yield near the forces that they carry.

    Attributes
    ----------
    contact : mapping of int to PowerLaw
        Approach over the force, by the number of the pair.
    bending : mapping of (int, int) to float [mm/N]
        Mean compliance of the teeth of the first pair under the second.
    """

    contact: Mapping[int, PowerLaw] = field(default_factory=dict)
    bending: Mapping[tuple[int, int], float] = field(default_factory=dict)

    def updated(self, later: Laws) -> Laws:
        """Return these laws and later ones, which count where both know a pair."""
        return Laws({**self.contact, **later.contact}, {**self.bending, **later.bending})


@dataclass(frozen=True, eq=False)
class SharedLoad:
    """Equilibrium of the tooth pairs of one position under one torque.

    Attributes
    ----------
    torque : float [N mm]
        Of the pinion.
    rotation : float [rad]
        By how much the load lets the wheel lag; zero without load.
    shares : tuple of Share
        Of the k pairs that carry load; without load the leading one.
    compliance : (k, k) array [mm/N]
        Of their teeth, the mean over the forces.
    residual : float
        Largest difference of the rotation that a pair asks for from the common one, over the rotation.
    balances : int
        How often the forces were balanced.
    """

    torque: float
    rotation: float
    shares: tuple[Share, ...]
    compliance: Array
    residual: float
    balances: int

    @property
    def laws(self) -> Laws:
        """What a neighbouring position or torque may start from."""
        numbers = [share.touch.pair for share in self.shares]
        bending = dict(zip(product(numbers, numbers), self.compliance.ravel().tolist(), strict=True))
        return Laws({share.touch.pair: share.law for share in self.shares if share.force > 0.0}, bending)

    @property
    def torque_rate(self) -> float:
        """Tangent dT1/d rotation of the whole mesh [N mm/rad]; zero without load."""
        if self.torque == 0.0:
            return 0.0
        contacts = [share.touch.contact for share in self.shares]
        closings = self.compliance.copy()
        np.fill_diagonal(closings, [1.0 / share.loaded.stiffness for share in self.shares])
        forces = np.linalg.solve(closings, [contact.wheel_lever for contact in contacts])
        return float(forces @ [contact.pinion_lever for contact in contacts])


def share_load(
    pair: GearPair,
    touches: Sequence[Touch],
    torque: float,
    grid: GridChoice,
    *,
    compliance: TeethYield | None = None,
    start: Laws = Laws(),
) -> SharedLoad:
    """Share a torque over the tooth pairs of one position.

    Parameters
    ----------
    pair : GearPair
    touches : sequence of Touch
        Every pair that may touch, one at least with no lag; see :func:`touches_at`.
    torque : float [N mm]
        Of the pinion, >= 0.
    grid : GridChoice
        How finely each contact is resolved.
    compliance : TeethYield, optional
        What yields beside the contacts; default: nothing.
    start : Laws
        Those of a neighbouring position or torque; default: none are known.

    Returns
    -------
    SharedLoad

    Raises
    ------
    InputError
        If the torque is negative or not finite, no pair is given, or a contact cannot carry its force.
    ConvergenceError
        If a contact, or the balance, does not converge.

    Examples
    --------
    Two tooth pairs of a spur gear, a half pitch either side of the pitch point, carry one half each:

    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pair import cylindrical_pair
    >>> from loaded_tca.unloaded import trace_teeth
    >>> gear = CylindricalGear(teeth=30, normal_module=3.0, face_width=25.0)
    >>> crowned = (FlankModifications(lead_crowning=0.005), FlankModifications())
    >>> pair = cylindrical_pair(CylindricalMesh(gear, gear), modifications=crowned)
    >>> touches = touches_at(trace_teeth(pair, [0.5 * pair.pitch]), 0)
    >>> shared = share_load(pair, touches, 130e3, GridChoice(accuracy=1e-2))
    >>> [round(share.torque / 130e3, 3) for share in shared.shares]
    [0.5, 0.5]
    """
    if not 0.0 <= torque < math.inf:
        raise InputError(f"torque: {torque!r} N mm is not a finite number >= 0")
    if not touches:
        raise InputError("touches: none given; a torque needs one tooth pair at least that can touch")
    if torque == 0.0:
        leading = min(touches, key=lambda touch: touch.lag)
        share = Share(leading, press(pair, leading.contact, 0.0, grid), 0.0)
        return SharedLoad(0.0, 0.0, (share,), np.zeros((1, 1)), 0.0, 0)
    return _Balance(pair, touches, torque, grid, compliance, start).run()


@dataclass(frozen=True, eq=False)
class _Coupling:
    """Compliance (m, n) [mm/N] of the columns of one grid under those of another."""

    at: Separation
    under: Separation
    compliance: Array


def _shares(loaded: LoadedContact) -> Array:
    """Shares of the columns in the force of a contact, (ny,)."""
    force = loaded.column_force
    return np.asarray(force / force.sum())


class _Balance:
    """Alternates between the balance of the contact laws and presses that correct them."""

    def __init__(
        self,
        pair: GearPair,
        touches: Sequence[Touch],
        torque: float,
        grid: GridChoice,
        compliance: TeethYield | None,
        start: Laws,
    ) -> None:
        self.pair, self.touches, self.torque, self.grid, self.teeth = pair, tuple(touches), torque, grid, compliance
        self.lags = np.array([touch.lag for touch in touches])
        self.levers = np.array([(touch.contact.pinion_lever, touch.contact.wheel_lever) for touch in touches]).T
        self.laws = [start.contact.get(touch.pair) or self._borrowed(start.contact, touch) for touch in touches]
        self.pressed: list[LoadedContact | None] = [None] * len(touches)
        numbers = [touch.pair for touch in touches]
        self.matrix = np.array([[start.bending.get((one, other), 0.0) for other in numbers] for one in numbers])
        self.couplings: dict[tuple[int, int], _Coupling] = {}
        self.agreement = AGREEMENT_ON_CELLS if grid.cells is not None else AGREEMENT * grid.accuracy

    def _borrowed(self, start: Mapping[int, PowerLaw], touch: Touch) -> PowerLaw:
        """Law of the nearest pair that has one; else that of a slender contact over the face."""
        if start:
            return start[min(start, key=lambda other: abs(other - touch.pair))]
        load = self.torque / touch.contact.pinion_lever
        return PowerLaw(load, SOFTEST_START * load / (self.pair.contact_modulus * self.pair.face_width))

    def run(self) -> SharedLoad:
        residual = math.inf
        for count in range(1, MOST_BALANCES + 1):
            forces = balance(self.laws, self.lags, self.levers, self.torque, self.matrix)
            for index in np.flatnonzero(forces):
                self._press(int(index), forces)
            self._take_compliance()
            shared = self._shared(forces, count)
            residual = shared.residual
            if residual <= self.agreement and self._settled(forces, shared.rotation):
                return shared
        raise ConvergenceError(
            f"load sharing not converged: the tooth pairs' rotations differ by {residual:.1e} > {self.agreement:.1e} "
            f"of the rotation after {MOST_BALANCES} balances at pinion angle "
            f"{self.touches[0].contact.pinion_angle:.6g} rad",
            last=shared,
        )

    def _press(self, index: int, forces: Array) -> None:
        """Press a pair with its force, on the grid it has if that still fits, and correct its law."""
        force, before, law = float(forces[index]), self.pressed[index], self.laws[index]
        if before is not None and SAME_BOX[0] * before.solution.load <= force <= SAME_BOX[1] * before.solution.load:
            lift = None if self.teeth is None else self._lift(index, before.separation, forces)
            loaded = before.under(force, lift)
        else:
            beneath = None if self.teeth is None else self._beneath(index, forces, self.teeth)
            loaded = press(self.pair, self.touches[index].contact, force, self.grid, beneath)
        self.pressed[index] = loaded
        approach = loaded.approach
        if loaded.solution.load > 0.0 and approach > 0.0:
            self.laws[index] = (
                replace(law, load=force, approach=approach) if before is None else law.through(force, approach)
            )

    def _beneath(self, index: int, forces: Array, teeth: TeethYield) -> Beneath:
        """What yields beneath a contact while the others carry their forces."""
        return Beneath(
            own=lambda separation, edges: teeth.within(self.touches[index].pair, separation, edges),
            lift=lambda separation: self._lift(index, separation, forces),
        )

    def _lift(self, index: int, separation: Separation, forces: Array) -> Array:
        """Displacement of the columns of a grid (ny,) [mm] by what the other pairs carry."""
        lift = np.zeros(len(separation.y))
        for other, loaded in enumerate(self.pressed):
            if other != index and loaded is not None and forces[other] > 0.0:
                lift += forces[other] * (self._coupling(index, separation, other, loaded) @ _shares(loaded))
        return lift

    def _coupling(self, index: int, separation: Separation, other: int, loaded: LoadedContact) -> Array:
        """Compliance of the columns of a grid under those of another contact, known as long as both grids stay."""
        assert self.teeth is not None
        kept = self.couplings.get((index, other))
        if kept is None or kept.at is not separation or kept.under is not loaded.separation:
            numbers = self.touches[index].pair, self.touches[other].pair
            found = self.teeth.between((numbers[0], separation), (numbers[1], loaded.separation))
            kept = self.couplings[index, other] = _Coupling(separation, loaded.separation, found)
        return kept.compliance

    def _take_compliance(self) -> None:
        """Correct the compliances of all pairs that were pressed, the mean over their forces."""
        if self.teeth is None:
            return
        known = [(index, loaded) for index, loaded in enumerate(self.pressed) if loaded is not None]
        for index, loaded in known:
            self.matrix[index, index] = loaded.own_deflection / loaded.solution.load
        for (index, one), (other, two) in combinations(known, 2):
            coupling = _shares(one) @ self._coupling(index, one.separation, other, two) @ _shares(two)
            self.matrix[index, other] = self.matrix[other, index] = coupling

    def _settled(self, forces: Array, rotation: float) -> bool:
        """Whether the pairs were pressed on columns displaced as the others displace them now, but for a constant."""
        for index, loaded in enumerate(self.pressed):
            if self.teeth is None or loaded is None or loaded.lift is None or not forces[index]:
                continue
            moved = (self._lift(index, loaded.separation, forces) - loaded.lift)[loaded.column_force > 0.0]
            if np.ptp(moved) > SETTLED * self.agreement * self.levers[1, index] * rotation:
                return False
        return True

    def _shared(self, forces: Array, count: int) -> SharedLoad:
        carrying = np.flatnonzero(forces)
        deflections = self.matrix @ forces
        shares = []
        for index in carrying:
            loaded = self.pressed[index]
            assert loaded is not None
            shares.append(Share(self.touches[index], loaded, float(deflections[index])))
        asked = np.array([share.rotation for share in shares])
        rotation = float(asked @ forces[carrying] / forces[carrying].sum())
        residual = float(np.abs(asked - rotation).max()) / rotation
        part = self.matrix[np.ix_(carrying, carrying)]
        return SharedLoad(self.torque, rotation, tuple(shares), part, residual, count)


def touches_at(mesh: MeshPath, position: int) -> tuple[Touch, ...]:
    """Tooth pairs that can touch at a position, with their lags: those within reach, corner contacts included.

    Parameters
    ----------
    mesh : MeshPath
        Unloaded contact of all teeth, :func:`loaded_tca.unloaded.trace_teeth`.
    position : int
        Index of the pinion angle.
    """
    lags = mesh.lag[:, position]
    found = zip(mesh.pairs.tolist(), mesh.paths, lags.tolist(), strict=True)
    return tuple(Touch(number, path[position], max(lag, 0.0)) for number, path, lag in found if math.isfinite(lag))
