r"""The torque shared over the tooth pairs that can be in contact at one position: one rotation, one force for each.

Load turns the wheel back by a rotation theta against its unloaded place. The rotation beyond the initial separation
theta_k of tooth pair k, times the lever of its contact about the wheel's axis, is its deflection: the contact
deformation and the tooth deflection under all forces:

.. math:: l_{2k} (\theta - \theta_k) = \delta_k(F_k) + \sum_j C_{kj} F_j \quad\text{where } F_k > 0, \qquad
          \sum_k l_{1k} F_k = T_1 .

A pair that is not in contact carries nothing. The torque grows with the rotation, so that there is one answer.

The contact law delta_k(F) is known from solved contacts alone. It counts from where the grid of the pair touches
first, which lies below the zero of its gaps where the grid has grown, or above where it is coarse. Between solutions
it is a power of the force, 2/3 for points and nearly 1 for lines, at first after Hertz, its exponent later that
between two that lie far enough apart: balance the powers, solve every pair under its force, correct the powers, until
the deformations agree and the rotation closes no pair that was left apart. The forces of the last solutions fulfil the
balance of the torque to rounding; what is left is a difference in the rotation that each pair asks for, ``residual``.

The lever is that of the contact point for the whole contact. It is the same at every point of two involute helicoids
(its own normal given); on bevel gears it grows with the cone distance, and the force is taken at the contact point.

References
----------
Conry & Seireg 1973, J. Eng. Ind. 95, 1115-1122 (compatibility of the tooth pairs); Vijayakar 1991, Int. J. Numer.
Meth. Eng. 31, 525-545 (contact by the half-space, teeth by finite elements); Johnson 1985, Contact Mechanics, eq. 4.23.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import combinations

import numpy as np
import scipy

from loaded_tca.arrays import Array
from loaded_tca.compliance.model import BendingModel, SumOfParts
from loaded_tca.errors import ConvergenceError, InputError, named
from loaded_tca.loaded.balance import PowerLaw, balance
from loaded_tca.loaded.first_guess import ExpectedLine, first_law
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.together import Bend, Gap, Line, Steps, Trace, run_alone, with_gears
from loaded_tca.loaded.tooth_contact import FIRST_CELLS, Coupling, GridChoice, contact_under_load, expected_pressure
from loaded_tca.loaded.tooth_pairs import Share, SharedLoad, ToothPair
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair
from loaded_tca.plain import plain, signed
from loaded_tca.separation import Separation

SMALLEST_SHARED = 1e-12
"""Forces below this times E* m_n^2 are not shared, but taken for none: what the pairs deform then is near the rounding
of their gaps and initial separations (1 uN at module 3; a line deforms by 1e-12 mm)."""
MOST_BALANCES = 40
"""Balances before giving up; two to four are the rule."""
SWINGING = 8
"""Balances after which forces go half the way only, or where the pressure has a cap their rotation is looked for."""
ROTATION = 1e-11
"""Relative accuracy of that rotation, and so of the torques balanced."""
AGREEMENT = 5e-2
"""Wanted agreement of the rotations, relative, over the accuracy of the peak pressure."""
AGREEMENT_ON_CELLS = 1e-5
"""The same where the cells are given."""
SETTLED = 10.0
"""Change of how the slices of a pair are displaced, over its deflection, in agreements: it only moves force about."""
LINE_ERROR = 1e-3
"""Distance over the module from the centres of the pressure to where its forces bend the teeth, the mean over the
force: 2 um on module 2, less than 1 nm of transmission error. Forces that swing keep their places."""
SAME_BOX, GUESSED_BOX = (0.75, 1.25), (0.9, 1.1)
"""Loads over the one a box was made for, between which it is kept, if the contact does not reach its border; the second
for forces by which teeth bend as guessed: kept, slopes of analyses on 64 cells scattered by 1 %."""
FAR = 2.0
"""Initial separation, over the rotation, of pairs that others do not bend into contact: by less than they close."""


def share_load(
    pair: GearPair,
    tooth_pairs: Sequence[ToothPair],
    torque: float,
    grid: GridChoice,
    *,
    bending: BendingModel | None = None,
) -> SharedLoad:
    """Share a torque over the tooth pairs of one position.

    Parameters
    ----------
    pair : GearPair
    tooth_pairs : sequence of ToothPair
        Every pair that may come into contact, one at least without initial separation; see :func:`tooth_pairs_at`.
    torque : float [N mm]
        Of the pinion, >= 0. One that is next to none, below about 1e-12 E* m_n^2 times the lever of the leading pair,
        is taken for none: what it closes is rounding.
    grid : GridChoice
        How finely each contact is resolved.
    bending : BendingModel, optional
        Of the teeth beneath the contacts; default: none.

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
    >>> from loaded_tca.loaded.tooth_pairs import tooth_pairs_at
    >>> from loaded_tca.unloaded import trace_teeth
    >>> gear = CylindricalGear(teeth=30, normal_module=3.0, face_width=25.0)
    >>> crowned = (FlankModifications(lead_crowning=0.005), FlankModifications())
    >>> pair = cylindrical_pair(CylindricalMesh(gear, gear), modifications=crowned)
    >>> candidates = tooth_pairs_at(trace_teeth(pair, [0.5 * pair.pitch]), 0)
    >>> shared = share_load(pair, candidates, 130e3, GridChoice(accuracy=1e-2))
    >>> [round(share.torque / 130e3, 3) for share in shared.shares]
    [0.5, 0.5]
    """
    return run_alone(pair, load_sharing_steps(pair, tooth_pairs, torque, grid, bending))


def load_sharing_steps(
    pair: GearPair,
    tooth_pairs: Sequence[ToothPair],
    torque: float,
    grid: GridChoice,
    bending: BendingModel | None = None,
    displacement: Coupling | None = None,
) -> Steps[SharedLoad]:
    """Share a torque over the tooth pairs of one position, step by step; see :func:`share_load`.

    ``displacement``: that of the slices of a grid, of whichever pair, that does not depend on the forces.
    """
    if not 0.0 <= torque < math.inf:
        raise InputError(f"torque: {torque!r} N mm is not a finite number >= 0")
    if not tooth_pairs:
        raise InputError("tooth_pairs: none given; a torque needs one tooth pair at least that can be in contact")
    leading = min(tooth_pairs, key=lambda tooth_pair: tooth_pair.initial_separation)
    smallest = SMALLEST_SHARED * pair.contact_modulus * pair.module**2
    if torque <= smallest * leading.contact.pinion_lever:
        steps = contact_under_load(leading.gears or pair, leading.contact, 0.0, grid)
        loaded = yield from with_gears(leading.gears, steps)
        return SharedLoad(0.0, 0.0, (Share(leading, loaded, 0.0),), 0.0, 0)
    return (yield from _Balance(pair, tooth_pairs, torque, grid, bending, displacement).steps())


class _Balance:
    """Alternates between the balance of the contact laws and contacts solved under the forces, which correct them."""

    def __init__(
        self,
        pair: GearPair,
        tooth_pairs: Sequence[ToothPair],
        torque: float,
        grid: GridChoice,
        bending: BendingModel | None,
        displacement: Coupling | None = None,
    ) -> None:
        # in one order, whatever the numbers: a pitch later the same steps, each of the next pair
        tooth_pairs = tuple(sorted(tooth_pairs, key=lambda tooth_pair: tooth_pair.pair, reverse=True))
        self.pair, self.tooth_pairs, self.torque, self.grid = pair, tooth_pairs, torque, grid
        self.displacement = displacement
        self.mean_displacement = np.zeros(len(tooth_pairs))  # [mm], over the force of each pair
        self.bending, self.forces_on_grid_axis = bending, grid.forces_on_grid_axis
        self.teeth_bend = (bending.on_rigid_supports if isinstance(bending, SumOfParts) else bending) is not None
        self.separations = np.array([tooth_pair.initial_separation for tooth_pair in tooth_pairs])
        self.first_gaps = np.zeros(len(tooth_pairs))  # [mm], where the grid of a pair touches first: it grows, is cut
        contacts = [tooth_pair.contact for tooth_pair in tooth_pairs]
        self.levers = np.array([(contact.pinion_lever, contact.wheel_lever) for contact in contacts]).T
        firsts = [
            first_law(tooth_pair.gears or pair, tooth_pair.contact, torque / tooth_pair.contact.pinion_lever)
            for tooth_pair in tooth_pairs
        ]
        self.laws, self.half_lengths = [law for law, _ in firsts], [length for _, length in firsts]
        self.solved: list[LoadedContact | None] = [None] * len(tooth_pairs)
        self.compliance = np.zeros((len(contacts), len(contacts)))
        self.grids_of_unloaded_pairs: dict[int, Separation] = {}  # of pairs that carried nothing yet
        self.deflections: dict[tuple[int, int], tuple[ContactGrid, LoadedContact, Array]] = {}
        usual = AGREEMENT_ON_CELLS if grid.cells is not None else AGREEMENT * grid.accuracy
        self.agreement = usual if grid.agreement is None else grid.agreement

    def steps(self) -> Steps[SharedLoad]:
        shared: SharedLoad | None = None
        forces, cap = np.zeros(len(self.laws)), self.pair.max_pressure
        if self.bending is not None:
            self.compliance = yield from self._first_compliance(self.bending)
        for count in range(1, MOST_BALANCES + 1):
            self.forces_on_grid_axis = self.forces_on_grid_axis or count > SWINGING
            if cap is not None and shared is not None and count > SWINGING and count % SWINGING != 1:
                forces = yield from self._solve_at_common_rotation(shared)
            else:  # also now and then there, since pairs that are apart may come under load
                before, known = forces, None if shared is None else forces
                forces = balance(self.laws, self._first_rotations, self.levers, self.torque, self.compliance, known)
                if count > SWINGING and cap is None:
                    forces = 0.5 * (before + forces)
                if count == 1:
                    yield from self._move_to_middles(forces)
                box = GUESSED_BOX if count == 2 and self.teeth_bend and not self.grid.forces_on_grid_axis else SAME_BOX
                for index in np.flatnonzero(forces).tolist():
                    yield from self._solve(index, forces, box)
            self.compliance = yield from self._corrected()
            shared = self._shared(forces, count)
            if shared.residual <= self.agreement and self._settled(forces, shared.rotation):
                return shared
        assert shared is not None
        limit = (
            ""
            if cap is None
            else f"; with max_pressure {plain(cap, 6)} MPa contacts near their limit deform without end"
        )
        raise ConvergenceError(
            f"load sharing not converged: the rotations of the tooth pairs differ by {shared.residual:.1e} > "
            f"{self.agreement:.1e} of the rotation after {MOST_BALANCES} balances{limit}",
            last=shared,
        )

    def _move_to_middles(self, forces: Array) -> Steps[None]:
        """Trace the pairs that the forces of the first balance close at the middles of their ways.

        The gears of a pair that touches go on towards each other by the rotation less the initial separation. Traced
        with the wheel alone taken back by that way, a contact lies elsewhere than with the pinion taken back; in the
        middle it lies where both do their half, and what is left is of third order. Contacts stay there: moved once
        more where a later rotation differs by more than some limit, they would jump as a scene passes that limit.
        """
        heaviest = int(forces.argmax())
        deflection = self.laws[heaviest].deformation_under(forces[heaviest]) + self.compliance[heaviest] @ forces
        rotation = float(self._first_rotations[heaviest] + deflection / self.levers[1, heaviest])
        by_gears: dict[int, list[int]] = {}
        for index in np.flatnonzero(self.separations < rotation).tolist():
            by_gears.setdefault(id(self.tooth_pairs[index].gears), []).append(index)
        moved = list(self.tooth_pairs)
        for indices in by_gears.values():
            contacts = [moved[index].contact for index in indices]
            halves = 0.5 * self.pair.driving * (rotation - self.separations[indices])
            angles = [
                contact.pinion_angle - half * contact.wheel_lever / contact.pinion_lever
                for contact, half in zip(contacts, halves.tolist(), strict=True)
            ]
            middles = yield Trace(contacts, angles, moved[indices[0]].gears)
            for index, contact, middle in zip(indices, contacts, middles, strict=True):
                if middle is not contact and middle.in_contact:
                    moved[index] = moved[index].at_middle(middle)
                    self.levers[1, index] = middle.wheel_lever
                    self.grids_of_unloaded_pairs.pop(index, None)
        self.tooth_pairs = tuple(moved)

    def _first_compliance(self, bending: BendingModel) -> Steps[Array]:
        """Compliance (k, k) [mm/N] of the pairs under line loads that fall to both ends, as of ellipses."""
        lines: list[tuple[int, ContactGrid]] = []
        shares: list[Array] = []
        for index, tooth_pair in enumerate(self.tooth_pairs):
            if self.grid.forces_on_grid_axis:
                grid = yield from self._grid_apart(index)
                force = expected_pressure(grid).sum(axis=0)
                lines.append((tooth_pair.pair, grid))
            else:
                line: ExpectedLine = yield Line(tooth_pair.contact, self.half_lengths[index], tooth_pair.gears)
                force = line.force
                lines.append((tooth_pair.pair, line))
            shares.append(force / force.sum())
        if self.on_moved_gears:
            displaced = [self._displaced(line) for _, line in lines]
            self.mean_displacement = np.array([share @ moved for share, moved in zip(shares, displaced, strict=True)])
        within = []
        for slices, share in zip(lines, shares, strict=True):
            within.append(share @ (yield Bend(bending, *slices)) @ share)
        compliance = np.diag(within)
        for (i, slices), (j, other_slices) in combinations(enumerate(lines), 2):
            if self._coupled(i, j):
                compliance[i, j] = compliance[j, i] = shares[i] @ bending.deflection(slices, other_slices, shares[j])
        return compliance

    def _grid_apart(self, index: int) -> Steps[Separation]:
        """Grid of a pair that carried nothing yet, in the box that it would have under all of the torque."""
        if index not in self.grids_of_unloaded_pairs:
            contact, gears = self.tooth_pairs[index].contact, self.tooth_pairs[index].gears
            self.grids_of_unloaded_pairs[index] = yield Gap(
                contact, FIRST_CELLS, load=self.laws[index].load, gears=gears
            )
        return self.grids_of_unloaded_pairs[index]

    def _solve(self, index: int, forces: Array, same_box: tuple[float, float]) -> Steps[None]:
        """Solve a pair under its force, on the grid it has if that still fits, and correct its law."""
        force, before, law = float(forces[index]), self.solved[index], self.laws[index]
        tooth_pair, coupling = self.tooth_pairs[index], partial(self._coupling, index, forces)
        try:
            loaded: LoadedContact | None = None
            if before is not None and not before.solution.reaches_border:
                least, most = (factor * before.solution.load for factor in same_box)
                if least <= force <= most:
                    if self.bending is not None and not self.forces_on_grid_axis:
                        before = yield from before.with_bending_lines(self.bending, tooth_pair.pair, self.pair.module)
                    loaded = yield from before.at_load(force, coupling(before.separation))
            if loaded is None or loaded.solution.reaches_border:
                contact, number, gears = tooth_pair.contact, tooth_pair.pair, tooth_pair.gears or self.pair
                with named(f"tooth pair {signed(number)}"):
                    steps = contact_under_load(
                        gears,
                        contact,
                        force,
                        self.grid,
                        self.bending,
                        number,
                        coupling,
                        solved_again=not self.forces_on_grid_axis,
                    )
                    loaded = yield from with_gears(tooth_pair.gears, steps)
        except ConvergenceError as error:
            raise ConvergenceError(f"tooth pair {signed(tooth_pair.pair)}: {error}", error.last) from error
        self.solved[index], self.first_gaps[index] = loaded, loaded.separation.cut_gap.min()
        deformation = loaded.contact_deformation - self.first_gaps[index]
        if loaded.solution.load > 0.0 and deformation > 0.0:
            first = before is None
            self.laws[index] = PowerLaw(force, deformation, law.exponent) if first else law.through(force, deformation)

    def _solve_at_common_rotation(self, shared: SharedLoad) -> Steps[Array]:
        """Solve the carrying pairs on their grids at the rotation that balances the torque; forces (k,).

        At a cap whole rows of cells yield at once: the deformation jumps as the force grows, so that forces swing to
        and fro, but the force grows steadily with the deformation.
        """
        numbers = {tooth_pair.pair: index for index, tooth_pair in enumerate(self.tooth_pairs)}
        before = [(numbers[share.tooth_pair.pair], share.loaded) for share in shared.shares]
        given = np.array([0.0 if loaded is None else loaded.solution.load for loaded in self.solved])
        coupling = {index: self._coupling(index, given, loaded.separation) for index, loaded in before}

        def solved_at(rotation: float) -> dict[int, LoadedContact]:
            approach = self.levers[1] * (rotation - self.separations)
            return {index: loaded.at_approach(float(approach[index]), coupling[index]) for index, loaded in before}

        def torque_missing(rotation: float) -> float:
            solved = solved_at(rotation).items()
            return self.torque - sum(float(self.levers[0, index]) * loaded.solution.load for index, loaded in solved)

        asked = [share.rotation for share in shared.shares]
        low, high = min(asked), max(asked)
        while torque_missing(low) < 0.0:
            low -= max(high - low, self.agreement * high)
        while torque_missing(high) > 0.0:
            high += max(high - low, self.agreement * high)
        rotation = float(scipy.optimize.brentq(torque_missing, low, high, xtol=ROTATION * high, rtol=ROTATION))
        forces = np.zeros(len(self.solved))
        for index, loaded in solved_at(rotation).items():
            self.solved[index], forces[index] = loaded, loaded.solution.load
        for index, loaded in self._loaded():
            if loaded.solution.reaches_border:
                yield from self._solve(index, forces, SAME_BOX)  # in a larger box
        return forces

    @property
    def _first_rotations(self) -> Array:
        """Rotations (k,) [rad] at which the grids of the pairs touch; contact laws count from there."""
        return np.asarray(self.separations + (self.first_gaps + self.mean_displacement) / self.levers[1])

    def _loaded(self) -> Iterator[tuple[int, LoadedContact]]:
        """Place and contact of the pairs that were solved under a load."""
        return ((n, loaded) for n, loaded in enumerate(self.solved) if loaded is not None and loaded.solution.load > 0)

    @property
    def on_moved_gears(self) -> bool:
        """Whether slices are displaced by what has moved the gears."""
        return self.displacement is not None

    def _displaced(self, grid: ContactGrid) -> Array:
        """Displacement of the slices of a grid (ny,) [mm] that does not depend on the forces; an array of its own."""
        displaced = None if self.displacement is None else self.displacement(grid)
        return np.zeros(len(grid.y)) if displaced is None else displaced.copy()

    def _coupling(self, index: int, forces: Array, grid: ContactGrid) -> Array | None:
        """Displacement of a pair's slices (ny,) [mm] by the forces of the others; None if nothing bends.

        The force of another pair is spread over its slices as in its last solution.
        """
        displaced = self._displaced(grid)
        if self.bending is None:
            return displaced if self.on_moved_gears else None
        for n, other in self._loaded():
            if n != index and forces[n] > 0.0:
                displaced += forces[n] * self._deflection(index, grid, n, other)
        return displaced

    def _coupled(self, index: int, other: int) -> bool:
        """Whether both pairs are in the model of the teeth; of those that are not, one may be loaded."""
        apart = abs(self.tooth_pairs[index].pair - self.tooth_pairs[other].pair)
        return self.bending is not None and apart <= self.bending.neighbours

    def _deflection(self, index: int, grid: ContactGrid, other: int, loaded: LoadedContact) -> Array:
        """Deflection (m,) [mm/N] of the slices of a pair's grid by the force of another one, spread as in its solution.

        Kept as long as grid and solution are the last ones that were asked for.
        """
        assert self.bending is not None
        known = self.deflections.get((index, other))
        if known is None or known[0] is not grid or known[1] is not loaded:
            pair, other_pair = self.tooth_pairs[index].pair, self.tooth_pairs[other].pair
            under = (other_pair, loaded.separation)
            known = grid, loaded, self.bending.deflection((pair, grid), under, loaded.slice_shares)
            self.deflections[index, other] = known
        return known[2]

    def _corrected(self) -> Steps[Array]:
        """Compliance (k, k) [mm/N], that of the pairs solved so far the mean over the forces on their slices."""
        compliance = self.compliance.copy()
        if self.bending is None:
            return compliance
        for index, loaded in self._loaded():
            compliance[index, index] = loaded.own_tooth_deflection / loaded.solution.load
            self.mean_displacement[index] = loaded.slice_shares @ self._displaced(loaded.separation)
        for (index, loaded), (other, other_loaded) in combinations(self._loaded(), 2):
            displaced = self._deflection(index, loaded.separation, other, other_loaded)
            compliance[index, other] = compliance[other, index] = loaded.slice_shares @ displaced
        loaded_pairs = dict(self._loaded())
        turned = [
            self.separations[n] + loaded.solution.approach / self.levers[1, n] for n, loaded in loaded_pairs.items()
        ]
        near = self.on_moved_gears | self.grid.forces_on_grid_axis | (self.separations <= FAR * max(turned))
        places: dict[int, int] = {}
        for index in np.flatnonzero(near).tolist():
            if index not in loaded_pairs:
                grid = yield from self._grid_apart(index)
                places[index] = self._correct_apart(index, grid, loaded_pairs, compliance)
        if self.on_moved_gears and places and np.linalg.eigvalsh(compliance)[0] < 0.0:
            self._correct_between_apart(places, compliance)
        return compliance

    def _correct_apart(
        self, index: int, separation: Separation, loaded_pairs: dict[int, LoadedContact], compliance: Array
    ) -> int:
        """Correct the compliance (k, k) of a pair that carries nothing, where the others let it touch first.

        Returns the slice of that place.
        """
        bent = {
            other: self._deflection(index, separation, other, two)
            for other, two in loaded_pairs.items()
            if self._coupled(index, other)
        }
        displacement = self._displaced(separation)
        distance = separation.cut_gap.min(axis=0) + displacement
        for other, displaced in bent.items():
            distance = distance + loaded_pairs[other].solution.load * displaced
        place = int(distance.argmin())  # where it comes into contact first, bent away by the others as it is
        for other, displaced in bent.items():
            compliance[index, other] = compliance[other, index] = displaced[place]
        self.mean_displacement[index] = displacement[place]
        return place

    def _correct_between_apart(self, places: dict[int, int], compliance: Array) -> None:
        """Take the compliance (k, k) between pairs that carry nothing at the places where they touch first, too.

        That of line loads instead, beside places elsewhere on a gear whose support tilts, is of no body: two forces
        could move each other further than themselves, and no balance would be found.
        """
        assert self.bending is not None
        grids = {index: (self.tooth_pairs[index].pair, self.grids_of_unloaded_pairs[index]) for index in places}
        for index, place in places.items():
            compliance[index, index] = self.bending.within(*grids[index])[place, place]
        for index, other in combinations(places, 2):
            if self._coupled(index, other):
                one_force = np.eye(len(grids[other][1].y))[places[other]]
                displaced = self.bending.deflection(grids[index], grids[other], one_force)[places[index]]
                compliance[index, other] = compliance[other, index] = displaced

    def _settled(self, forces: Array, rotation: float) -> bool:
        """Whether the rotation closes no pair that carries nothing, and all were solved as the others still bend them.

        A constant on top of all slices of a pair is of no account: it moves no force about.
        """
        deflection = self.levers[1] * (rotation - self._first_rotations) - self.compliance @ forces
        allowed = self.agreement * self._scale(rotation, forces) * self.levers[1]
        if not (deflection <= allowed)[forces == 0.0].all():
            return False
        for index, loaded in self._loaded():
            if forces[index] > 0.0 and loaded.coupling_deflection is not None:
                now = self._coupling(index, forces, loaded.separation)
                assert now is not None  # as when it was solved
                moved = (now - loaded.coupling_deflection)[loaded.slice_force > 0.0]
                if np.ptp(moved) > SETTLED * allowed[index]:
                    return False
                if not self.forces_on_grid_axis and loaded.line_error(self.pair.module) > LINE_ERROR * self.pair.module:
                    return False
        return True

    def _scale(self, rotation: float, forces: Array) -> float:
        """Rotation [rad] to compare differences with; of the contacts alone where gears have moved by it before."""
        if not self.on_moved_gears:
            return rotation
        pressed = [
            (n, loaded.contact_deformation / self.levers[1, n]) for n, loaded in self._loaded() if forces[n] > 0.0
        ]
        return max(rotation, float(sum(forces[n] * turn for n, turn in pressed) / forces.sum()))

    def _shared(self, forces: Array, count: int) -> SharedLoad:
        carrying = np.array([index for index, _ in self._loaded() if forces[index] > 0.0])[::-1]
        deflections = self.compliance @ forces + self.mean_displacement
        shares = []
        for index in carrying.tolist():
            loaded = self.solved[index]
            assert loaded is not None
            shares.append(Share(self.tooth_pairs[index], loaded, float(deflections[index])))
        asked = np.array([share.rotation for share in shares])
        rotation = float(asked @ forces[carrying] / forces[carrying].sum())
        residual = float(np.abs(asked - rotation).max()) / self._scale(rotation, forces)
        return SharedLoad(self.torque, rotation, tuple(shares), residual, count)
