r"""The torque shared over the tooth pairs that can touch at one position: one common rotation, one force for each.

Load lets the wheel stay behind by a rotation theta against its unloaded place. That closes tooth pair k, whose own
flanks touch at the lag theta_k, by the lever of its contact about the wheel's axis times what is left of the rotation,
and the closing is the approach of its contact and the deflection of the teeth:

.. math:: l_{2k} (\theta - \theta_k) = \delta_k(F_k) + \sum_j C_{kj} F_j \quad\text{where } F_k > 0, \qquad
          \sum_k l_{1k} F_k = T_1 .

A pair that is apart carries nothing. The torque grows with the rotation, so that there is one answer.

The contact law delta_k(F) is known from presses alone. Between them it is a power of the force, 2/3 for points and
nearly 1 for lines, its exponent that of the tangent in a neighbouring position, or between two presses that lie far
enough apart: balance the powers, press every pair with its force, correct the powers, until the approaches agree and
the rotation closes no pair that was left apart. The forces of the last press fulfil the balance of the torque to
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
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.loaded.balance import PowerLaw, balance
from loaded_tca.loaded.pair_coupling import LoadedTeeth, TeethYield
from loaded_tca.loaded.tooth_contact import GridChoice, LoadedContact, press
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import ContactPoint, MeshPath

MOST_BALANCES = 40
"""Balances before giving up; two to four are the rule."""
SWINGING = 8
"""Balances after which forces go half the way only: near a cap on the pressure they swing to and fro."""
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


@dataclass(frozen=True, eq=False)
class ToothPair:
    """A tooth pair that may carry load at a position.

    Attributes
    ----------
    pair : int
        Its number.
    contact : ContactPoint
        Its first touch, unloaded, in the angles of its own tooth.
    initial_separation : float [rad]
        Rotation of the wheel at which it touches; zero for the leading pair.
    """

    pair: int
    contact: ContactPoint
    initial_separation: float


@dataclass(frozen=True, eq=False)
class Share:
    """What one tooth pair carries.

    Attributes
    ----------
    tooth_pair : ToothPair
    loaded : LoadedContact
        Its contact under its force.
    deflection : float [mm]
        What of its closing bends the teeth, not the contact.
    """

    tooth_pair: ToothPair
    loaded: LoadedContact
    deflection: float

    @property
    def force(self) -> float:
        """Normal force [N]."""
        return self.loaded.solution.load

    @property
    def torque(self) -> float:
        """Its part of the pinion torque [N mm]."""
        return float(self.force * self.tooth_pair.contact.pinion_lever)

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
        return float(self.tooth_pair.initial_separation + closing / self.tooth_pair.contact.wheel_lever)


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

    def compliance(self, one: int, other: int) -> float:
        """Mean compliance of two pairs [mm/N]; of unknown ones the least known, so that the matrix stays definite."""
        alike = (value for (a, b), value in self.bending.items() if (a == b) == (one == other))
        return self.bending.get((one, other), min(alike, default=0.0))

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
        By how much the load lets the wheel stay behind; zero without load.
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
        numbers = [share.tooth_pair.pair for share in self.shares]
        bending = dict(zip(product(numbers, numbers), self.compliance.ravel().tolist(), strict=True))
        return Laws({share.tooth_pair.pair: share.law for share in self.shares if share.force > 0.0}, bending)

    @property
    def torque_rate(self) -> float:
        """Tangent dT1/d rotation of the whole mesh [N mm/rad]; zero where a load is next to none."""
        stiffness = np.array([share.loaded.stiffness for share in self.shares])
        if not stiffness.all():
            return 0.0
        contacts = [share.tooth_pair.contact for share in self.shares]
        closings = self.compliance.copy()
        np.fill_diagonal(closings, 1.0 / stiffness)
        forces = np.linalg.solve(closings, [contact.wheel_lever for contact in contacts])
        return float(forces @ [contact.pinion_lever for contact in contacts])


def share_load(
    pair: GearPair,
    tooth_pairs: Sequence[ToothPair],
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
    tooth_pairs : sequence of ToothPair
        Every pair that may touch, one at least with no lag; see :func:`tooth_pairs_at`.
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
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.unloaded import trace_teeth
    >>> gear = CylindricalGear(teeth=30, normal_module=3.0, face_width=25.0)
    >>> crowned = (FlankModifications(lead_crowning=0.005), FlankModifications())
    >>> pair = cylindrical_pair(CylindricalMesh(gear, gear), modifications=crowned)
    >>> touches = tooth_pairs_at(trace_teeth(pair, [0.5 * pair.pitch]), 0)
    >>> shared = share_load(pair, touches, 130e3, GridChoice(accuracy=1e-2))
    >>> [round(share.torque / 130e3, 3) for share in shared.shares]
    [0.5, 0.5]
    """
    if not 0.0 <= torque < math.inf:
        raise InputError(f"torque: {torque!r} N mm is not a finite number >= 0")
    if not tooth_pairs:
        raise InputError("touches: none given; a torque needs one tooth pair at least that can touch")
    if torque == 0.0:
        leading = min(tooth_pairs, key=lambda tooth_pair: tooth_pair.initial_separation)
        share = Share(leading, press(pair, leading.contact, 0.0, grid), 0.0)
        return SharedLoad(0.0, 0.0, (share,), np.zeros((1, 1)), 0.0, 0)
    return _Balance(pair, tooth_pairs, torque, grid, compliance, start).run()


class _Balance:
    """Alternates between the balance of the contact laws and presses that correct them."""

    def __init__(
        self,
        pair: GearPair,
        tooth_pairs: Sequence[ToothPair],
        torque: float,
        grid: GridChoice,
        compliance: TeethYield | None,
        start: Laws,
    ) -> None:
        self.pair, self.tooth_pairs, self.torque, self.grid = pair, tuple(tooth_pairs), torque, grid
        numbers = [tooth_pair.pair for tooth_pair in tooth_pairs]
        self.teeth = None if compliance is None else LoadedTeeth(compliance, numbers)
        self.separations = np.array([tooth_pair.initial_separation for tooth_pair in tooth_pairs])
        self.levers = np.array(
            [(tooth_pair.contact.pinion_lever, tooth_pair.contact.wheel_lever) for tooth_pair in tooth_pairs]
        ).T
        self.laws = [
            start.contact.get(tooth_pair.pair) or self._borrowed(start.contact, tooth_pair)
            for tooth_pair in tooth_pairs
        ]
        self.pressed: list[LoadedContact | None] = [None] * len(tooth_pairs)
        self.matrix = np.array([[start.compliance(one, other) for other in numbers] for one in numbers])
        self.agreement = AGREEMENT_ON_CELLS if grid.cells is not None else AGREEMENT * grid.accuracy

    def _borrowed(self, start: Mapping[int, PowerLaw], tooth_pair: ToothPair) -> PowerLaw:
        """Law of the nearest pair that has one; else that of a slender contact over the face."""
        if start:
            return start[min(start, key=lambda other: abs(other - tooth_pair.pair))]
        load = self.torque / tooth_pair.contact.pinion_lever
        return PowerLaw(load, SOFTEST_START * load / (self.pair.contact_modulus * self.pair.face_width))

    def run(self) -> SharedLoad:
        residual, forces = math.inf, np.zeros(len(self.laws))
        for count in range(1, MOST_BALANCES + 1):
            before = forces
            forces = balance(self.laws, self.separations, self.levers, self.torque, self.matrix)
            if count > SWINGING:
                forces = 0.5 * (before + forces)
            for index in np.flatnonzero(forces):
                self._press(int(index), forces)
            if self.teeth is not None:
                self.teeth.correct(self.matrix, self.pressed)
            shared = self._shared(forces, count)
            residual = shared.residual
            fits = residual <= self.agreement and self._stay_apart(forces, shared.rotation)
            if fits and self._settled(forces, shared.rotation):
                return shared
        raise ConvergenceError(
            f"load sharing not converged: the tooth pairs' rotations differ by {residual:.1e} > {self.agreement:.1e} "
            f"of the rotation after {MOST_BALANCES} balances{self._cap_told()}",
            last=shared,
        )

    def _cap_told(self) -> str:
        """What a cap on the pressure has to do with it, if there is one."""
        cap = self.pair.max_pressure
        return "" if cap is None else f"; with max_pressure {cap:g} MPa contacts near their limit yield without end"

    def _press(self, index: int, forces: Array) -> None:
        """Press a pair with its force, on the grid it has if that still fits, and correct its law."""
        force, before, law = float(forces[index]), self.pressed[index], self.laws[index]
        if before is not None and SAME_BOX[0] * before.solution.load <= force <= SAME_BOX[1] * before.solution.load:
            lift = None if self.teeth is None else self.teeth.lift(index, before.separation, self.pressed, forces)
            loaded = self._tell(index, lambda: before.under(force, lift))
        else:
            beneath = None if self.teeth is None else self.teeth.beneath(index, self.pressed, forces)
            contact = self.tooth_pairs[index].contact
            loaded = self._tell(index, lambda: press(self.pair, contact, force, self.grid, beneath))
        self.pressed[index] = loaded
        approach = loaded.approach
        if loaded.solution.load > 0.0 and approach > 0.0:
            self.laws[index] = (
                replace(law, load=force, approach=approach) if before is None else law.through(force, approach)
            )

    def _tell(self, index: int, solve: Callable[[], LoadedContact]) -> LoadedContact:
        """Solve; say of which pair it is if that does not converge."""
        try:
            return solve()
        except ConvergenceError as error:
            raise ConvergenceError(f"tooth pair {self.tooth_pairs[index].pair:+d}: {error}", error.last) from error

    def _stay_apart(self, forces: Array, rotation: float) -> bool:
        """Whether the rotation closes none of the pairs that carry nothing."""
        closing = self.levers[1] * (rotation - self.separations) - self.matrix @ forces
        return bool((closing <= self.agreement * rotation * self.levers[1])[forces == 0.0].all())

    def _settled(self, forces: Array, rotation: float) -> bool:
        """Whether every pair was pressed on columns that the others still displace alike, but for a constant."""
        if self.teeth is None:
            return True
        allowed = SETTLED * self.agreement * rotation * self.levers[1]
        moved = (self.teeth.moved(int(index), self.pressed, forces) for index in np.flatnonzero(forces))
        return all(part <= most for part, most in zip(moved, allowed[forces > 0.0], strict=True))

    def _shared(self, forces: Array, count: int) -> SharedLoad:
        carrying = np.flatnonzero(forces)
        deflections = self.matrix @ forces
        shares = []
        for index in carrying:
            loaded = self.pressed[index]
            assert loaded is not None
            shares.append(Share(self.tooth_pairs[index], loaded, float(deflections[index])))
        asked = np.array([share.rotation for share in shares])
        rotation = float(asked @ forces[carrying] / forces[carrying].sum())
        residual = float(np.abs(asked - rotation).max()) / rotation
        part = self.matrix[np.ix_(carrying, carrying)]
        return SharedLoad(self.torque, rotation, tuple(shares), part, residual, count)


def tooth_pairs_at(mesh: MeshPath, position: int) -> tuple[ToothPair, ...]:
    """Tooth pairs that can touch at a position, with their lags: those within reach, corner contacts included.

    Parameters
    ----------
    mesh : MeshPath
        Unloaded contact of all teeth, :func:`loaded_tca.unloaded.trace_teeth`.
    position : int
        Index of the pinion angle.
    """
    separations = mesh.initial_separation[:, position]
    found = zip(mesh.pairs.tolist(), mesh.paths, separations.tolist(), strict=True)
    return tuple(ToothPair(number, path[position], max(gap, 0.0)) for number, path, gap in found if math.isfinite(gap))
