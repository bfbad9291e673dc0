r"""Neighbouring teeth: which tooth pair leads, and the transmission error that a whole gear pair has unloaded.

All tooth pairs are one field, seen a pitch later or earlier. Pair 0 touches at the pitch point at phi1 = 0, pair +1 is
the one that comes into mesh after it, pair -1 the one that came before it:

.. math:: \mathrm{TE}_k(\varphi_1) = \mathrm{TE}_0(\varphi_1 - k\,2\pi/z_1), \qquad
          \varphi_{2,k}(\varphi_1) = \varphi_{2,0}(\varphi_1 - k\,2\pi/z_1) + k\,2\pi/z_2 .

No tooth may pass through its mate, so the wheel stands where the first pair touches: the transmission error is the
envelope of these curves, the upper one if the pinion drives, the lower one if the wheel does. Where a contact has run
onto the tip of a tooth, the curve goes on, steeply: the corner contact belongs to it, and the envelope itself never
jumps. What the literature calls a discontinuous transmission function is a transfer at which the curves of surface
contact do not cross inside both their ranges, so that a tooth edge bridges the step.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from loaded_tca.errors import AccuracyWarning, GeometryError, InputError
from loaded_tca.flanks.base import BORDER_NAMES
from loaded_tca.flanks.jet import Array
from loaded_tca.pair import GearPair
from loaded_tca.unloaded.path import POSITIONS, ContactPath, ContactPoint, trace_contact
from loaded_tca.unloaded.search import first_touch

REACH = 0.05
"""Lag behind the leading pair, as a length at r_b2 over the module, beyond which a tooth pair counts as apart: no load
that gears bear closes it."""
SAMPLES = 4
"""Positions per pitch at which the reach is looked for."""
COINCIDE = 1e-13
"""Difference of transmission errors [rad] that is rounding: the pair nearer to its pitch point then leads."""
MOST_TEETH = 10**9
"""Tooth pairs are numbered below this, turns of the pinion away."""
UNIFORM = 1e-6
"""Unevenness of the positions, relative to their step, within which they count as uniform."""
TRANSFER = 1e-11
"""Accuracy of a transfer point [rad]."""
SECTIONS, SECTION_PASSES = 16, 4
"""The end of a surface contact is found by cutting a pitch into 16 parts, four times over."""


@dataclass(frozen=True, eq=False)
class Transfer:
    """Where one tooth pair hands over to another.

    Attributes
    ----------
    pinion_angle : float [rad]
    transmission_error : float [rad]
    pairs : (int, int)
        The leading pair before and after.
    contacts : (ContactPoint, ContactPoint)
        Of the two pairs, each in its own angles.
    """

    pinion_angle: float
    transmission_error: float
    pairs: tuple[int, int]
    contacts: tuple[ContactPoint, ContactPoint]

    @property
    def is_continuous(self) -> bool:
        """Whether the curves cross inside both their ranges: both contacts rest on the same borders, or on none."""
        first, second = (_borders_held(contact.edges) for contact in self.contacts)
        return bool((first == second).all())


@dataclass(frozen=True, eq=False)
class Harmonics:
    """Orders 1, 2, ... of the tooth mesh: TE = mean + sum of amplitude cos(order z1 phi1 + phase).

    Attributes
    ----------
    order : (count,) int array
    amplitude, phase : (count,) array [rad]
    """

    order: NDArray[np.int_]
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
        no common region, or a lag of more than 0.05 modules.
    leading_pair : (n,) int array
        The pair that touches. Of curves that coincide, the one nearer to its pitch point.
    transmission_error : (n,) array [rad]
        phi2 - (z1/z2) phi1 of the gears: the envelope.
    """

    pair: GearPair
    pinion_angle: Array
    pairs: NDArray[np.int_]
    paths: tuple[ContactPath, ...]
    leading_pair: NDArray[np.int_]
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
    def lag(self) -> Array:
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

    @property
    def peak_to_peak(self) -> float:
        """Largest minus smallest transmission error over the positions [rad]."""
        return float(np.ptp(self.transmission_error))

    @property
    def mean(self) -> float:
        """Mean over one pitch [rad]; InputError unless the positions divide a pitch evenly."""
        return float(self.transmission_error[: self._count_per_pitch()].mean())

    @property
    def area(self) -> float:
        """Area S between the transmission error and zero over one pitch of phi1, signed [rad^2] (Seed 000, 4.2)."""
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
            raise InputError(f"count: {count} orders of {per_pitch} positions per pitch; 1 to {(per_pitch - 1) // 2}")
        order = np.arange(1, count + 1)
        spectrum = np.fft.rfft(self.transmission_error[:per_pitch])[order] * (2.0 / per_pitch)
        turned = spectrum * np.exp(-2j * math.pi * order * self.pinion_angle[0] / self.pair.pitch)
        return Harmonics(order, np.abs(turned), np.angle(turned))

    def contact_ratio(self, tolerance: float = 1e-3) -> float:
        """Unloaded actual contact ratio: how many pairs touch on average, to within a tolerance.

        Parameters
        ----------
        tolerance : float [mm]
            Lag as a length at the wheel's base circle up to which a pair counts as touching. Flanks that leave each
            other one by one (profile crowning, misalignment) have a ratio near 1 for no tolerance, which grows with
            it. Unmodified, aligned ones give eps_gamma, and a little more by the corner contact that follows. Between
            positions the lag is taken as a straight line: the ratio is good to about one over their number.

        Raises
        ------
        InputError
            If the positions do not divide a pitch evenly, or the tolerance is negative or not finite.
        """
        if not 0.0 <= tolerance < math.inf:
            raise InputError(f"tolerance: {tolerance} mm is not a finite length >= 0")
        count = self._count_per_pitch()
        limit = tolerance / self.pair.base_radii[1] + COINCIDE
        rows = np.argsort(-self.pairs)
        lag = np.nan_to_num(self.lag[rows, :count], nan=REACH).ravel()
        lag = np.concatenate([[REACH], lag, [REACH]])
        low, high = np.minimum(lag[1:], lag[:-1]), np.maximum(lag[1:], lag[:-1])
        share = (limit - low) / np.where(high > low, high - low, 1.0)
        return float(np.where(high <= limit, 1.0, np.clip(share, 0.0, 1.0)).sum()) / count

    @cached_property
    def transfers(self) -> tuple[Transfer, ...]:
        """Where the leading pair changes, in the order of phi1; each found by root finding."""
        changes = np.flatnonzero(np.diff(self.leading_pair))
        found = []
        for row in changes:
            ends = (float(self.pinion_angle[row]), float(self.pinion_angle[row + 1]))
            found += self._transfers_between(*ends, int(self.leading_pair[row]), int(self.leading_pair[row + 1]))
        return tuple(found)

    @cached_property
    def jumps(self) -> Array:
        """Step of the transmission error of surface contact at each transfer [rad].

        Zero where the curves cross inside both their ranges. Otherwise the change between the end of the surface
        contact of the one pair and the begin of that of the other, bridged by an edge; NaN if there is none within a
        pitch.
        """
        return np.array([_jump(self.pair, transfer.contacts) for transfer in self.transfers])

    @property
    def is_continuous(self) -> bool:
        """Whether every transfer is a crossing of two curves inside both their ranges."""
        return all(transfer.is_continuous for transfer in self.transfers)

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
            f"pinion_angles: {len(self)} positions do not divide a pitch of {self.pair.pitch:.6g} rad into equal steps"
        )

    def _transfers_between(self, low: float, high: float, old: int, new: int) -> list[Transfer]:
        """Transfers between two angles with different leading pairs; halved until the pairs are neighbours."""
        if abs(new - old) == 1 or high - low < TRANSFER:
            return [self._transfer(low, high, old, new)]
        middle = 0.5 * (low + high)
        heights = _heights(self.pair, middle - self.pairs * self.pair.pitch)
        lead = int(self.pairs[_leading(self.pair, heights[:, None], np.array([middle]), self.pairs)[0]])
        first = self._transfers_between(low, middle, old, lead) if lead != old else []
        return first + (self._transfers_between(middle, high, lead, new) if lead != new else [])

    def _transfer(self, low: float, high: float, old: int, new: int) -> Transfer:
        pitch, ends = self.pair.pitch, np.array([old, new])

        def difference(angle: float) -> float:
            first, second = _heights(self.pair, angle - ends * pitch)
            return float(first - second)

        edges = [difference(low), difference(high)]
        if max(map(abs, edges)) <= COINCIDE * self.pair.base_radii[1]:
            angle = float(np.clip(0.5 * (old + new) * pitch, low, high))
        elif edges[0] * edges[1] >= 0.0:
            angle = (low, high)[int(np.argmin(np.abs(edges)))]
        else:
            angle = float(brentq(difference, low, high, xtol=TRANSFER))
        path = trace_contact(self.pair, angle - ends * pitch, warn=False)
        contacts = (path[0], path[1])
        return Transfer(angle, path[0].transmission_error, (old, new), contacts)


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
        If the leading contact rests on a root form circle, below which the flank is another.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pair import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> mesh = trace_teeth(cylindrical_pair(CylindricalMesh(*gears)))
    >>> mesh.peak_to_peak < 1e-14, mesh.is_continuous
    (True, True)
    """
    phi1 = _checked_angles(pair, pinion_angles)
    chosen = None if teeth is None else _checked_teeth(teeth)
    low, high = _window(pair)
    pairs = _teeth_between(phi1, low, high, pair.pitch) if chosen is None else chosen
    own = phi1 - pairs[:, None] * pair.pitch
    rows = np.flatnonzero((own >= low) & (own <= high))
    if not rows.size:
        raise GeometryError(f"no common flank: none of the tooth pairs {pairs.tolist()} comes into reach")
    paths = _split(trace_contact(pair, own.ravel()[rows], warn=False), rows, own)
    heights = np.stack([pair.driving * path.transmission_error for path in paths])
    heights = np.where(np.isnan(heights), -np.inf, heights) * pair.base_radii[1]
    column = _leading(pair, heights, phi1, pairs)
    top = heights[column, np.arange(len(phi1))]
    if (apart := np.isinf(top)).any():
        raise GeometryError(
            f"none of the tooth pairs {pairs.tolist()} touches at {int(apart.sum())} of {len(phi1)} positions, first "
            f"at pinion angle {phi1[apart][0]:.6g} rad"
        )
    mesh = MeshPath(pair, phi1, pairs, paths, pairs[column], pair.driving * top / pair.base_radii[1])
    _warn_of_fillets(mesh)
    return mesh


def _checked_angles(pair: GearPair, pinion_angles: ArrayLike | None) -> Array:
    if pinion_angles is None:
        return np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, POSITIONS)
    phi1 = np.asarray(pinion_angles, dtype=float)
    if phi1.ndim != 1 or not phi1.size or not np.isfinite(phi1).all() or (np.diff(phi1) <= 0.0).any():
        raise InputError(
            f"pinion_angles: shape {phi1.shape}; finite, increasing numbers in one dimension are asked for"
        )
    return phi1


def _checked_teeth(teeth: Iterable[int]) -> NDArray[np.int_]:
    chosen = list(teeth) if isinstance(teeth, Iterable) else [teeth]
    whole = all(isinstance(k, int | np.integer) and abs(k) < MOST_TEETH for k in chosen)
    if not whole or not chosen or len(set(chosen)) < len(chosen):
        raise InputError(f"teeth: {chosen}; whole numbers are asked for, at least one, none twice")
    return np.array(chosen, dtype=int)


def _teeth_between(phi1: Array, low: float, high: float, pitch: float) -> NDArray[np.int_]:
    """Tooth pairs that come within reach over the angles, in the order 0, +1, -1, ..."""
    first, last = math.ceil((phi1[0] - high) / pitch), math.floor((phi1[-1] - low) / pitch)
    return np.array(sorted(range(first, last + 1), key=lambda k: (abs(k), -k)), dtype=int)


def _window(pair: GearPair) -> tuple[float, float]:
    """Own pinion angles [rad] between which a tooth pair is within reach of the leading one, and a step more."""
    step, first = pair.pitch / SAMPLES, -2

    def pitches(start: int, count: int) -> Array:
        own = step * np.arange(start * SAMPLES, (start + count) * SAMPLES)
        return _heights(pair, own).reshape(count, SAMPLES)

    heights = pitches(first, 5)
    while True:
        near = np.isfinite(heights) & (heights >= heights.max(axis=0) - REACH * pair.module)
        if not near[[0, -1]].any():
            break
        if near[-1].any():
            heights = np.concatenate([heights, pitches(first + len(heights), 1)])
        if near[0].any():
            first -= 1
            heights = np.concatenate([pitches(first, 1), heights])
    if not near.any():
        raise GeometryError(
            "no common flank: the flanks of no tooth pair cover a common region; check tip diameters, centre distance "
            "and axial offset"
        )
    touching = step * (first * SAMPLES + np.flatnonzero(near))
    return float(touching[0]) - step, float(touching[-1]) + step


def _heights(pair: GearPair, own: Array) -> Array:
    """Ease-off [mm] of the first touch at own pinion angles; -inf where the flanks share no region."""
    touch = first_touch(pair, own)
    return np.where(touch.touches, touch.value, -np.inf)


def _leading(pair: GearPair, heights: Array, phi1: Array, pairs: NDArray[np.int_]) -> NDArray[np.int_]:
    """Column of the leading pair (n,) for heights (m, n) [mm]."""
    distance = np.abs(phi1 / pair.pitch - pairs[:, None]) + UNIFORM * pairs[:, None]
    tie = heights >= heights.max(axis=0) - COINCIDE * pair.base_radii[1]
    return np.asarray(np.where(tie, distance, np.inf).argmin(axis=0))


def _split(path: ContactPath, rows: NDArray[np.int_], own: Array) -> tuple[ContactPath, ...]:
    """One path per tooth, (n,) rows each, from the rows found of all of them."""
    parts = {}
    for field in fields(ContactPath):
        part = getattr(path, field.name)
        full = np.full((own.size, *part.shape[1:]), np.nan if part.dtype.kind == "f" else 0, dtype=part.dtype)
        full[rows] = part
        parts[field.name] = full.reshape(*own.shape, *part.shape[1:])
    parts["pinion_angle"] = own
    return tuple(ContactPath(**{name: part[k] for name, part in parts.items()}) for k in range(len(own)))


def _warn_of_fillets(mesh: MeshPath) -> None:
    edges, root = mesh.leading_contact.edges, BORDER_NAMES.index("root")
    count = int((edges[:, root] | edges[:, len(BORDER_NAMES) + root]).sum())
    if count:
        message = (
            f"fillet interference: at {count} of {len(mesh)} positions the leading contact lies on a root form circle"
        )
        warnings.warn(message + ", below which the flank is not an involute", AccuracyWarning, stacklevel=3)


def _jump(pair: GearPair, contacts: tuple[ContactPoint, ContactPoint]) -> float:
    """Change of the transmission error over the edge contact at a transfer [rad]."""
    held = [_borders_held(contact.edges) for contact in contacts]
    if (held[0] == held[1]).all():
        return 0.0
    common = held[0] & held[1]
    before, after = (_end_of(pair, one, common, way) for one, way in zip(contacts, (-1.0, 1.0), strict=True))
    return after - before


def _borders_held(edges: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tips and roots of both gears, then the sides of either: where two faces end together, their edges alternate."""
    pinion, wheel = edges[..., : len(BORDER_NAMES)], edges[..., len(BORDER_NAMES) :]
    return np.concatenate([pinion[..., :2], wheel[..., :2], pinion[..., 2:] | wheel[..., 2:]], axis=-1)


def _end_of(pair: GearPair, contact: ContactPoint, borders: NDArray[np.bool_], way: float) -> float:
    """Transmission error where a contact rests on ``borders`` alone again, going one way; NaN if not within a pitch."""
    start, length = contact.pinion_angle, way * pair.pitch
    for _ in range(SECTION_PASSES):
        path = trace_contact(pair, start + length * np.linspace(0.0, 1.0, SECTIONS + 1), warn=False)
        free = path.touches & (_borders_held(path.edges) == borders).all(axis=-1)
        if not free.any():
            return math.nan
        first = int(free.argmax())
        if first == 0:
            break
        start, length = float(path.pinion_angle[first - 1]), length / SECTIONS
    return float(path.transmission_error[first])
