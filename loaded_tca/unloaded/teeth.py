r"""Neighbouring teeth: which tooth pair leads, and the transmission error that a whole gear pair has unloaded.

All tooth pairs are one field, seen a pitch later or earlier. Pair 0 touches at the pitch point at phi1 = 0, pair +1 is
the one that comes into mesh after it, pair -1 the one that came before it:

.. math:: \mathrm{TE}_k(\varphi_1) = \mathrm{TE}_0(\varphi_1 - k\,2\pi/z_1), \qquad
          \varphi_{2,k}(\varphi_1) = \varphi_{2,0}(\varphi_1 - k\,2\pi/z_1) + k\,2\pi/z_2 .

No tooth may pass through its mating gear, so the wheel stands where the first pair touches: the transmission error is
the envelope of these curves, the upper one if the pinion drives, the lower one if the wheel does. Where a contact has
run onto the tip of a tooth, the curve goes on, steeply: the corner contact belongs to it, and the envelope itself never
jumps. What the literature calls a discontinuous transmission function is a transfer at which the curves of surface
contact do not cross inside both their ranges, so that a tooth edge bridges the step.

Orders of the tooth mesh in a curve over one pitch: their complex amplitudes, phases from the pinion angle 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import cached_property
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, finite_row
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.unloaded.path import ContactPath, default_angles, trace_contact, warn_of_fillets
from loaded_tca.unloaded.search import spread
from loaded_tca.unloaded.tooth_cycle import (
    COINCIDE,
    REACH,
    ToothCycle,
    Transfer,
    find_transfers,
    leading,
    reach,
    teeth_between,
    tooth_cycle,
)


def harmonic_coefficients(curve: Array, count: int, begin: float = 0.0) -> NDArray[np.complex128]:
    r"""Complex amplitudes of the orders 1 to ``count`` of a periodic curve.

    .. math:: c_k = \frac{2}{N} \sum_{n=0}^{N-1} e_n \exp(-2 \pi i k (n / N + t_0))

    so that e(t) = mean + sum of \|c_k\| cos(2 pi k t + arg c_k), t from t_0 to t_0 + 1 over the period. The transform
    rounds each c_k by a few eps of the largest \|e\|: an amplitude by that, a phase by that over its amplitude.

    Parameters
    ----------
    curve : (N + 1,) array
        At even positions over one period, both ends included.
    count : int
    begin : float
        t_0, where the first position lies in periods: of the tooth mesh its pinion angle over the pitch.

    Returns
    -------
    (count,) complex array
        In the unit of the curve; NaN for orders of which the positions are too few, and for a curve with a gap.

    Examples
    --------
    >>> wave = harmonic_coefficients(np.cos(np.linspace(0.0, 2.0 * np.pi, 9) + 0.5), 4)
    >>> np.abs(wave).round(12), np.angle(wave[0]).round(12)
    (array([ 1.,  0.,  0., nan]), np.float64(0.5))
    """
    period = curve[:-1]
    coefficients = np.full(count, complex(math.nan, math.nan))
    known = min(count, (len(period) - 1) // 2)
    if known > 0 and np.isfinite(period).all():
        orders = np.arange(1, known + 1)
        coefficients[:known] = 2.0 / len(period) * np.fft.rfft(period)[orders] * np.exp(-2j * math.pi * begin * orders)
    return coefficients


MOST_TEETH = 10**9
"""Tooth pairs are numbered below this, turns of the pinion away."""
UNIFORM = 1e-6
"""Unevenness of the positions, relative to their step, within which they count as uniform."""


@dataclass(frozen=True, eq=False)
class Harmonics:
    """Orders 1, 2, ... of the tooth mesh: TE = mean + sum of amplitude cos(order z1 phi1 + phase).

    Attributes
    ----------
    order : (count,) int array
    amplitude, phase : (count,) array [rad]
    """

    order: Indices
    amplitude: Array
    phase: Array


@dataclass(frozen=True, eq=False)
class MeshPath:
    """Unloaded contact of all teeth over the pinion angles, n positions.

    Attributes
    ----------
    pair : GearPair
    pinion_angle : (n,) array [rad]
        phi1, increasing.
    pairs : (m,) int array
        Tooth pairs: 0 is the one that touches at the pitch point at phi1 = 0, +1 comes into mesh after it.
    paths : tuple of m ContactPath
        Of each tooth pair, in its own angles: pinion angle phi1 - k pitch, as if it were pair 0. NaN where it is apart:
        no common region, or an initial separation of more than 0.05 modules.
    leading_pair : (n,) int array
        The pair that touches. Of curves that coincide, the one nearer to its pitch point.
    transmission_error : (n,) array [rad]
        phi2 - (z1/z2) phi1 of the gears: the envelope.
    """

    pair: GearPair
    pinion_angle: Array
    pairs: Indices
    paths: tuple[ContactPath, ...]
    leading_pair: Indices
    transmission_error: Array

    def __len__(self) -> int:
        return len(self.pinion_angle)

    def __repr__(self) -> str:
        return f"MeshPath({len(self)} positions, tooth pairs {sorted(self.pairs.tolist())})"

    @property
    def wheel_angle(self) -> Array:
        """phi2 of the gears (n,) [rad]."""
        return self.transmission_error + self.pair.ratio * self.pinion_angle

    @property
    def initial_separation(self) -> Array:
        """How far each pair is from touching: (m, n) [rad], zero for the leading one, NaN where apart."""
        own = np.stack([path.transmission_error for path in self.paths])
        return self.pair.driving * (self.transmission_error - own)

    @property
    def leading_contact(self) -> ContactPath:
        """Contact of the leading pair at each position, in that pair's own angles."""
        column = (self.pairs[:, None] == self.leading_pair).argmax(axis=0)
        rows = np.arange(len(self))
        parts = {field.name: np.stack([getattr(p, field.name) for p in self.paths]) for field in fields(ContactPath)}
        return ContactPath(**{name: part[column, rows] for name, part in parts.items()})

    @cached_property
    def peak_to_peak(self) -> float:
        """Largest minus smallest transmission error from the first position to the last [rad].

        Over that range, whatever lies between the positions: transfers and summits are found by root finding.
        """
        low, high = float(self.pinion_angle[0]), float(self.pinion_angle[-1])
        peaks = self._cycle.peaks(low, high, self.pairs) * self.pair.driving / self.pair.base_radii[1]
        transfers = [transfer.transmission_error for transfer in self.transfers]
        return float(np.ptp(np.concatenate([self.transmission_error, transfers, peaks])))

    @property
    def mean(self) -> float:
        """Mean over one pitch [rad]; InputError unless the positions divide a pitch evenly."""
        return float(self.transmission_error[: self._count_per_pitch()].mean())

    @property
    def area(self) -> float:
        """Signed area S under the transmission error over a pitch of phi1 [rad^2] (reduced-TCA dissertation, 4.2)."""
        return self.mean * self.pair.pitch

    def harmonics(self, count: int) -> Harmonics:
        """Orders 1 to ``count`` of the tooth mesh, from one pitch, its end not counted twice.

        Raises
        ------
        InputError
            If the positions do not divide a pitch evenly, or are too few for the orders asked for.
        """
        per_pitch = self._count_per_pitch()
        if not isinstance(count, int | np.integer) or not 1 <= count < 0.5 * per_pitch:
            most = (per_pitch - 1) // 2
            raise InputError(f"count: found {count}; allowed 1 to {most} with {per_pitch} positions per pitch")
        order = np.arange(1, count + 1)
        closed = self.transmission_error[np.arange(per_pitch + 1) % per_pitch]
        coefficients = harmonic_coefficients(closed, count, float(self.pinion_angle[0]) / self.pair.pitch)
        return Harmonics(order, np.abs(coefficients), np.angle(coefficients))

    def contact_ratio(self, tolerance: float = 1e-3) -> float:
        """Unloaded actual contact ratio: how many pairs touch on average, to within a tolerance; at least 1.

        It belongs to the gear pair, all of its teeth and a whole pitch, and does not depend on the positions.

        Parameters
        ----------
        tolerance : float [mm]
            Initial separation at the wheel's base circle up to which a pair counts as in contact, at most 0.05
            modules.
            Flanks that leave each other one by one (profile crowning, misalignment) have a ratio of 1 for no
            tolerance, which grows with it. Unmodified, aligned ones give eps_gamma, and a little more by the corner
            contact that follows.

        Raises
        ------
        InputError
            If the tolerance is negative, not finite, or beyond the reach within which teeth are traced.
        """
        most = REACH * self.pair.module
        if not isinstance(tolerance, Real) or not 0.0 <= tolerance <= most:
            raise InputError(
                f"tolerance: {tolerance!r} mm is not a length from 0 to {plain(most, 6)} mm, {REACH} modules"
            )
        return max(1.0, self._cycle.share_in_contact(tolerance + COINCIDE * self.pair.base_radii[1]))

    @cached_property
    def transfers(self) -> tuple[Transfer, ...]:
        """Where the leading pair changes between the first and the last position, in the order of phi1.

        Each is found by root finding, and does not depend on the positions between.
        """
        return find_transfers(self._cycle, float(self.pinion_angle[0]), float(self.pinion_angle[-1]), self.pairs)

    @cached_property
    def jumps(self) -> Array:
        """Step of the transmission error of surface contact at each transfer [rad].

        Zero where the curves cross inside both their ranges. Otherwise the change between the end of the surface
        contact of the one pair and the begin of that of the other, bridged by an edge; NaN if there is none within a
        pitch.
        """
        return np.array([transfer.jump(self.pair) for transfer in self.transfers])

    @cached_property
    def is_continuous(self) -> bool:
        """Whether every transfer is a crossing of two curves inside both their ranges (``Transfer.is_continuous``).

        It belongs to the gear pair: all of its teeth over a whole pitch, whatever the positions.
        """
        half, own = 0.5 * self.pair.pitch, self._cycle.own
        teeth = teeth_between(-half, half, (float(own[0]), float(own[-1])), self.pair.pitch)
        return all(transfer.is_continuous for transfer in find_transfers(self._cycle, -half, half, teeth))

    @cached_property
    def _cycle(self) -> ToothCycle:
        return tooth_cycle(self.pair)

    def _count_per_pitch(self) -> int:
        """Positions per pitch, if they are uniform and cover one."""
        steps = np.diff(self.pinion_angle)
        if len(steps):
            step = float(steps.mean())
            count = round(self.pair.pitch / step)
            off = max(float(np.abs(steps - step).max()), abs(count * step - self.pair.pitch) / max(count, 1))
            if 1 < count <= len(self) and off <= UNIFORM * step:
                return count
        raise InputError(
            f"pinion_angles: {len(self)} positions do not divide a pitch of {plain(self.pair.pitch, 6)} rad "
            "into equal steps"
        )


@checked
def trace_teeth(pair: GearPair, pinion_angles: ArrayLike | None = None, teeth: Iterable[int] | None = None) -> MeshPath:
    """Unloaded contact of all teeth that can touch.

    Parameters
    ----------
    pair : GearPair
    pinion_angles : (n,) array [rad], optional
        phi1, increasing; default: 21 positions over one pitch about phi1 = 0, both ends included.
    teeth : iterable of int, optional
        Tooth pairs, 0 the one at phi1, +1 the next to come into mesh; default: all that come within reach of the
        leading one, in the order 0, +1, -1, +2, ...

    Returns
    -------
    MeshPath

    Raises
    ------
    InputError
        If the angles are not finite and increasing, or no tooth is given, or one twice.
    GeometryError
        If at some position none of the teeth touches.

    Warns
    -----
    AccuracyWarning
        If the leading contact rests on the root edge of a flank, below which the tooth goes on as its fillet.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> mesh = trace_teeth(cylindrical_pair(CylindricalMesh(*gears)))
    >>> mesh.peak_to_peak < 1e-14, mesh.is_continuous
    (True, True)
    """
    phi1 = default_angles(pair) if pinion_angles is None else finite_row("pinion_angles", pinion_angles)
    if (np.diff(phi1) <= 0.0).any():
        raise InputError("pinion_angles: not increasing; allowed increasing angles")
    chosen = None if teeth is None else _checked_teeth(teeth)  # before the reach is looked for
    low, high = reach(pair)
    pairs = teeth_between(phi1[0], phi1[-1], (low, high), pair.pitch) if chosen is None else chosen
    own = phi1 - pairs[:, None] * pair.pitch
    rows = np.flatnonzero((own >= low) & (own <= high))
    if not rows.size:
        raise GeometryError(f"no common flank: none of the tooth pairs {pairs.tolist()} comes into reach")
    path = trace_contact(pair, own.ravel()[rows], warn=False)
    heights = np.full(own.shape, -np.inf)
    heights.flat[rows] = np.where(path.in_contact, pair.driving * path.transmission_error * pair.base_radii[1], -np.inf)
    column = leading(pair, heights, phi1, pairs)
    top = heights[column, np.arange(len(phi1))]
    if (apart := np.isinf(top)).any():
        raise GeometryError(
            f"none of the tooth pairs {pairs.tolist()} touches at {int(apart.sum())} of {len(phi1)} positions, first "
            f"at pinion angle {plain(phi1[apart][0], 6)} rad"
        )
    near = np.flatnonzero(heights >= top - REACH * pair.module)
    traced = path[np.searchsorted(rows, near)]
    parts = {entry.name: spread(getattr(traced, entry.name), near, own.size) for entry in fields(ContactPath)}
    parts["pinion_angle"] = own.ravel()
    teeth_apart = ContactPath(**parts)
    paths = tuple(teeth_apart[k * len(phi1) : (k + 1) * len(phi1)] for k in range(len(pairs)))
    mesh = MeshPath(pair, phi1, pairs, paths, pairs[column], pair.driving * top / pair.base_radii[1])
    warn_of_fillets(pair, mesh.leading_contact, "leading contact")
    return mesh


def _checked_teeth(teeth: Iterable[int]) -> Indices:
    chosen = list(teeth) if isinstance(teeth, Iterable) else [teeth]
    whole = all(isinstance(k, int | np.integer) and not isinstance(k, bool) and abs(k) < MOST_TEETH for k in chosen)
    if not whole or not chosen or len(set(chosen)) < len(chosen):
        raise InputError(f"teeth: {chosen}; whole numbers are asked for, at least one, none twice")
    return np.array(chosen, dtype=int)
