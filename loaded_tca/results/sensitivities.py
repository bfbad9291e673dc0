"""Sensitivities of a result: its derivatives to modifications, mounting errors and the torque."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import Array, Indices, Mask, real
from loaded_tca.errors import require
from loaded_tca.notebooks import InNotebooks
from loaded_tca.results.face_slopes import (
    LITTLE,
    common_face_motions,
    face_load_factor_changes,
    largest_cut,
    peak_cut,
    rival_strip,
    top_strips,
    warn_of_arcs,
    warn_of_edges,
    warn_of_end_strips,
    warn_of_face_ends,
    warn_of_grids,
    warn_of_strips,
    warn_of_strips_beside,
)
from loaded_tca.results.figure_slopes import (
    EXPONENT,
    curvature_jumps_beside,
    line_load_slopes,
    peak_pressure_slopes,
    pressure_norm,
    root_slopes,
)
from loaded_tca.results.gap_growth import GapGrowth, MotionGrowth, curvature_growth
from loaded_tca.results.slice_pressure import InnerPeak, SlicePeak, other_slice_pressures, rough_peaks
from loaded_tca.results.slope_limits import ALIKE, warn_of_alike_peaks, warn_of_leaving_pairs, warn_of_share_grids
from loaded_tca.results.warnings import warn_of_contacts
from loaded_tca.separation.pair_change import is_of_modifications
from loaded_tca.threads import one_blas_thread
from loaded_tca.units import UNITS
from loaded_tca.unloaded.teeth import harmonic_coefficients

if TYPE_CHECKING:
    import xarray

    from loaded_tca.loaded.sensitivity import Tangents
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.separation.pair_change import PairChange

TORQUE = "load.pinion_torque_Nm"
NEWTON_MILLIMETRES = UNITS["Nm"].factor
"""Of a newton metre."""
LINEAR = 1e-6
"""Tolerance of the linear systems, which are known to the grid's percent."""


FEW = 200
"""Cells between the bounds, of a contact with others at the cap on the pressure, below which derivatives hold less."""


@dataclass(frozen=True, eq=False)
class Sensitivities(InNotebooks):
    """Derivatives of a result with respect to keys of its scene; NaN where nothing is in contact or nothing is loaded.

    Found when they are asked for: the transmission error costs one linear problem for each state, a torque and
    position under load; the others one more for each loaded tooth pair, however many keys there are.

    Attributes
    ----------
    keys : tuple of str
        As of ``scene.with_changes``; the unit of each is in its name.
    result : MeshCycle
        What they are derivatives of.
    tangents : Tangents
        Of all states.
    places : (2, states) int array
        Torque and position of each state, by index.
    pairs : (grids,) int array
        Tooth pair of each grid of the tangents, by index.
    growth : GapGrowth
        Of the gaps, of the torques of the pairs by that of their levers, motions of the grids.
    changes : tuple of PairChange or None
        Pairs of gears that differ in each key; none of the torque.
    with_motions : callable
        Growth with the motions of the grids, as of :func:`loaded_tca.results.gap_growth.motion_growth`.
    """

    keys: tuple[str, ...]
    result: CycleNumbers
    tangents: Tangents
    places: Indices
    pairs: Indices
    growth: GapGrowth
    changes: tuple[PairChange | None, ...]
    with_motions: Callable[[], MotionGrowth]

    def __reduce__(self) -> tuple[Callable[..., Sensitivities], tuple[CycleNumbers, tuple[str, ...]]]:
        """Found anew by pickle and copy: the linear systems are large, and quickly made."""
        from loaded_tca.results.derivatives import sensitivities  # which makes these

        return sensitivities, (self.result, self.keys)

    def __repr__(self) -> str:
        return f"Sensitivities({len(self.keys)} keys, {self.places.shape[1]} states)"

    @cached_property
    def torques(self) -> Array:
        """Growth of the torques that the forces balance with the levers as they are, (keys, states) [N mm per unit]."""
        return self._raised + self._of_levers(self.growth.lever_torques)

    def _of_levers(self, lever_torques: Array) -> Array:
        """The same of levers alone."""
        first = np.searchsorted(self.tangents.state, np.arange(self.places.shape[1]))
        return -np.add.reduceat(lever_torques, first, axis=1)

    @property
    def _raised(self) -> Array:
        """Growth of the torque of the pinion (keys, 1) [N mm per unit]."""
        return np.array([[NEWTON_MILLIMETRES if key == TORQUE else 0.0] for key in self.keys])

    @property
    def _grids(self) -> Indices:
        """Torque, position and pair of each grid, (3, grids)."""
        return np.concatenate([self.places[:, self.tangents.state], [self.pairs]])

    def _by_pair(self, values: Array) -> Array:
        """Numbers (keys, grids) as (torque, position, pair, key)."""
        by_pair = np.full((*self.result.load_share.shape, len(self.keys)), np.nan)
        by_pair[*self._grids] = values.T
        return by_pair

    @cached_property
    def _of_motions(self) -> MotionGrowth:
        return self.with_motions()

    def _of_each_pair(self, slopes: Array) -> Array:
        """Changes (keys, grids) of a number of each grid whose derivatives by its forces are ``slopes`` (n,)."""
        return self._of_each_grid(self._weights(slopes), self.growth.gaps, self.torques)

    def _weights(self, slopes: Array) -> list[tuple[Mask, Array, Array]]:
        """Grids (grids,), one of each state at the most, and derivatives of their numbers by gaps and torques.

        As of :meth:`Tangents.functional_weights`, of numbers whose derivatives by the forces are ``slopes`` (n,).
        """
        state, grid = self.tangents.state, self.tangents.grid
        place = np.arange(state.size) - np.searchsorted(state, state)
        marks = [place == number for number in range(place.max() + 1)]
        return [(own, *self.tangents.functional_weights(np.where(own[grid], slopes, 0.0))) for own in marks]

    def _of_each_grid(self, weights: list[tuple[Mask, Array, Array]], gaps: Array, torques: Array) -> Array:
        """Changes (m, grids) of numbers by changes (m, n) of the gaps and (m, states) of the torques."""
        state, changes = self.tangents.state, np.zeros((len(gaps), self.tangents.state.size))
        for own, by_gaps, by_torque in weights:
            change = self.tangents.summed(gaps * by_gaps) + by_torque * torques
            changes[:, own] = change[:, state[own]]
        return changes

    @cached_property
    def transmission_error(self) -> Array:
        """Derivatives of the loaded, absolute transmission error, (torque, position, key) [rad per unit of the key].

        That by the torque is one over ``MeshCycle.mesh_stiffness``, as an angle, which holds the places at which forces
        bend the teeth: that is 1e-4 of it.
        """
        slopes = np.full((*self.result.transmission_error.shape, len(self.keys)), np.nan)
        change = self.tangents.rotation_change(self.growth.gaps, self.torques)
        slopes[*self.places] = -self.result.gear_pair.driving * change.T
        if self.growth.kinks is not None:
            warn_of_edges(self.keys, slopes, self.transmission_error_kinks, self.result.um_per_rad)
        return slopes

    @cached_property
    def transmission_error_kinks(self) -> Array:
        """Kinks of the transmission error, (torque, position, key) [rad per unit]; zero where it has none.

        Derivatives by growing values of a key less those by falling ones, the mean of which ``transmission_error`` has:
        where edges of both gears end a contact at one place, as the ends of faces of one width, the pinion's end it to
        one side of a key and the wheel's to the other, and on one of them the contact is shorter.
        """
        kinks = np.zeros((*self.result.transmission_error.shape, len(self.keys)))
        if (apart := self.growth.kinks) is not None:
            change = self.tangents.rotation_change(apart.gaps, self._of_levers(apart.lever_torques))
            kinks[*self.places] = -self.result.gear_pair.driving * change.T
        return kinks

    @cached_property
    def transmission_error_by_grids(self) -> Array:
        """How far derivatives of the transmission error depend on the grids, (torque, position, key) [rad per unit].

        The smaller of two changes: by grids that stay in place, and by grids that move with the contact points; at
        least the change by grids of contacts that reach no edge, if these move with the contact points. With small
        cells there is no change. Zero for keys that move no grids. Takes as long as the derivatives by one mounting
        error.
        """
        by_grids = np.zeros((*self.result.transmission_error.shape, len(self.keys)))
        if self._moving.any():
            stiffness = self.tangents.stiffness
            by_gaps = self.tangents.weights / self.tangents.spread(stiffness)
            rates = self._of_motions.rates(self.tangents, by_gaps, 1.0 / stiffness)
            by_grids[*self.places] = self._by_grids(rates).T
        return by_grids

    @property
    def _moving(self) -> Mask:
        """Keys (keys,) with which grids move."""
        return np.array([change is not None and not change.of_modifications for change in self.changes])

    def _by_grids(self, rates: Array) -> Array:
        """How far derivatives of a number of each state depend on the grids (keys, states): zero where grids stay.

        ``rates`` (2, grids): growth of the number as one of its grids moves [per mm].
        """
        first = np.searchsorted(self.tangents.state, np.arange(self.places.shape[1]))
        motions = self.growth.motions[..., :2]
        left = motions - self.growth.shifts
        on_edge = (self.result.on_edge > 0)[*self._grids]
        of_grids = np.stack([motions, left, np.where(on_edge[:, None], 0.0, left)]) * rates.T
        held, followed, inner = np.abs(np.add.reduceat(of_grids.sum(axis=-1), first, axis=-1))
        return np.asarray(np.maximum(np.minimum(held, followed), inner) * self._moving[:, None])

    @cached_property
    def load_share(self) -> Array:
        """Derivatives of the load shares, (torque, position, pair, key) [1 per unit]; zero where nothing is carried.

        An AccuracyWarning says by how much derivatives depend on the grids, if this is above 5 %, and another one
        which change of a key takes the load from a tooth pair, if this is less than a usual change of the key.
        """
        state = self.tangents.state
        torque, share = self.result.torque[self.places[0]][state], self.result.load_share[*self._grids]
        gaps, lever_torques = self._with_contacts
        own = self._of_each_grid(self._of_shares, gaps, self._raised + self._of_levers(lever_torques)) + lever_torques
        slopes = self._by_pair((own - share * self._raised) / torque)
        shared = ~np.isnan(self.result.load_share) & np.isfinite(self.transmission_error).any(axis=-1, keepdims=True)
        slopes[shared & np.isnan(slopes).all(axis=-1)] = 0.0
        warn_of_share_grids(self.keys, self.result.load_share, slopes, self.load_share_by_grids)
        warn_of_leaving_pairs(self.keys, self.result.load_share, slopes)
        return slopes

    @cached_property
    def _of_shares(self) -> list[tuple[Mask, Array, Array]]:
        """Derivatives of the torques of the pairs by gaps and torques."""
        return self._weights(self.tangents.pinion_levers)

    @cached_property
    def load_share_by_grids(self) -> Array:
        """How far derivatives of the load shares depend on the grids, (torque, position, pair, key) [1 per unit].

        The estimate is that of ``transmission_error_by_grids``.
        """
        by_grids = np.zeros((len(self.keys), self.tangents.state.size))
        if self._moving.any():
            state, motions = self.tangents.state, self._of_motions
            for own, by_gaps, by_torque in self._of_shares:
                rates = motions.rates(self.tangents, by_gaps, by_torque) + own * motions.lever_torques
                by_grids[:, own] = self._by_grids(rates)[:, state[own]]
        by_pair = self._by_pair(by_grids / self.result.torque[self.places[0]][self.tangents.state])
        return np.nan_to_num(by_pair)

    @cached_property
    def on_cut_slices(self) -> Mask:
        """Whether an edge cuts the slices with the largest line load, (torque, position, pair).

        Derivatives of their line load are less exact: an AccuracyWarning says so where they are read.
        """
        return self._where(largest_cut(self.tangents.grids))

    @cached_property
    def at_corners(self) -> Mask:
        """Whether an edge cuts slices of the peak pressure, or a pair only just carries, (torque, position, pair).

        Derivatives of peak pressures are less exact there: an AccuracyWarning says so where they are read.
        """
        just_loaded = (self.result.on_edge > 0) & (self.result.load_share < LITTLE)
        return self._where(peak_cut(self.tangents.grids, self._rough_peaks)) | just_loaded

    @cached_property
    def across_relief_starts(self) -> Mask:
        """Whether the start of a linear relief runs through a contact beside its point, (torque, position, pair).

        Derivatives by keys that move contacts or starts depend on the grid by 15 to 25 % there (AccuracyWarning).
        """
        across = self.result.on_relief_start[*self._grids] > 0
        return self._where(across & [not grid.contact.on_relief_start for grid in self.tangents.grids])

    @cached_property
    def beside_curvature_jumps(self) -> Mask:
        """Whether the curvature of the gap jumps across a smooth contact beside its peak, (torque, position, pair).

        As where a parabolic relief starts. Derivatives of its peak pressure are less exact there: an AccuracyWarning
        says so where they are read.
        """
        rough = (self.result.on_edge > 0) | (self.result.on_relief_start > 0)
        pair = self.result.gear_pair
        smooth = (~rough)[*self._grids].tolist()
        grids = zip(smooth, self.tangents.grids, strict=True)
        return self._where(is_smooth and curvature_jumps_beside(pair, grid) for is_smooth, grid in grids)

    @cached_property
    def nearly_plastic(self) -> Mask:
        """Whether few cells of a contact at the cap on the pressure are below it, (torque, position, pair).

        They alone answer to keys, and derivatives follow them: an AccuracyWarning says so.
        """
        few = [bool(grid.pressed.sum() > grid.active.sum()) and grid.active.sum() < FEW for grid in self.tangents.grids]
        return self._of_changes(self._where(few))

    def _where(self, marks: Iterable[bool] | Mask) -> Mask:
        """Marks of the grids as (torque, position, pair)."""
        marked = np.zeros(self.result.load_share.shape, dtype=bool)
        marked[*self._grids] = list(marks)
        return marked

    @cached_property
    def line_load(self) -> Array:
        """Derivatives of the line load of each contact, (torque, position, pair, key) [N/mm per unit]."""
        warn_of_contacts(self.result, kinds.LINE_LOAD_SLOPES.sentence(), self._of_changes(self.on_cut_slices))
        slopes = self.tangents.gathered(
            line_load_slopes(grid.pressure, grid.problem.spacing) for grid in self.tangents.grids
        )
        return self._by_pair(self._of_each_pair(slopes))

    @cached_property
    def peak_pressure(self) -> Array:
        """Derivatives of the peak pressure of each contact, (torque, position, pair, key) [MPa per unit].

        Of a contact at an edge or a relief start that of its largest slice pressure, or of its inner cells. Where
        another place of the contact has nearly the same pressure, an AccuracyWarning has the derivative there.
        """
        jumps = kinds.PEAK_BESIDE_JUMP.sentence()
        warn_of_contacts(self.result, kinds.PEAK_SLOPES.sentence(), self._of_changes(self.at_corners))
        warn_of_contacts(self.result, jumps, self._of_changes(self.beside_curvature_jumps))
        slopes = self._of_peaks(self._rough_peaks)
        lacking, others = self._other_peaks
        if any(peak is not None for peak in others):
            peaks = [peak if other is None else other for peak, other in zip(self._rough_peaks, others, strict=True)]
            moves = [change is not None for change in self.changes]
            beyond = np.where(moves, self._of_peaks(peaks), slopes)
            warn_of_alike_peaks(self.keys, self.result.peak_pressure, lacking, slopes, beyond)
        return slopes

    def _of_peaks(self, peaks: Sequence[SlicePeak | InnerPeak | None]) -> Array:
        """Derivatives (torque, position, pair, key) of peaks of the grids."""
        pair, grids = self.result.gear_pair, self.tangents.grids
        slopes = peak_pressure_slopes(pair, [(one.contact, one.separation, one.pressure) for one in grids], peaks)
        by_pair = self._of_followed_contacts(self.tangents.gathered(slopes))
        rough = {i: peak for i, peak in enumerate(peaks) if isinstance(peak, SlicePeak)}
        if rough:
            at, tops = [*rough], [*rough.values()]
            grown = curvature_growth(pair, [grids[i] for i in at], tops, self.changes, self.growth.of_grids(at))
            by_pair[:, at] += grown * [0.5 * peak.pressure if peak.slopes.any() else 0.0 for peak in tops]
        return self._by_pair(by_pair)

    @cached_property
    def _other_peaks(self) -> tuple[Array, list[SlicePeak | None]]:
        """Second peaks of contacts, and how much smaller they are (torque, position, pair), relative; NaN without one.

        A second peak is a place away from the largest pressure with nearly the same pressure, in a contact that reaches
        an edge or a relief start.
        """
        peaks, grids = self._rough_peaks, self.tangents.grids
        others: list[SlicePeak | None] = [None] * len(grids)
        lacking = np.full(self.result.load_share.shape, np.nan)
        tops = {i: peak for i, peak in enumerate(peaks) if peak is not None}
        if tops:
            contacts = [(grids[i].contact, grids[i].separation, grids[i].pressure) for i in tops]
            next_ones = other_slice_pressures(
                self.result.gear_pair, contacts, [peak.place[1] for peak in tops.values()]
            )
            for (i, peak), other in zip(tops.items(), next_ones, strict=True):
                if other is not None and (short := 1.0 - other.pressure / peak.pressure) < ALIKE:
                    others[i], lacking[tuple(self._grids[:, i])] = other, max(short, 0.0)
        return lacking, others

    @cached_property
    def _with_contacts(self) -> tuple[Array, Array]:
        """Growth of gaps (keys, n) and of lever torques (keys, grids), as the grids of smooth contacts follow these.

        What is read off few cells changes a little with the place of a contact between them. Where a modification moves
        the contact over a grid that stays, that is no change of it: each grid is moved on with its contact.
        """
        modified = [*map(is_of_modifications, self.keys)]  # on supports their changes move gears, too
        smooth = [peak is None for peak in self._rough_peaks]
        left = self.growth.shifts - self.growth.motions[..., :2]
        left[np.logical_not(modified)] = left[:, np.logical_not(smooth)] = 0.0
        gaps, lever_torques = self.growth.gaps, self.growth.lever_torques
        if left.any():
            more = self._of_motions.moved(self.tangents, left)
            gaps, lever_torques = gaps + more[0], lever_torques + more[1]
        return gaps, lever_torques

    def _of_followed_contacts(self, slopes: Array) -> Array:
        """As of :meth:`_of_each_pair`, as the grids of smooth contacts follow these."""
        gaps, lever_torques = self._with_contacts
        return self._of_each_grid(self._weights(slopes), gaps, self._raised + self._of_levers(lever_torques))

    @cached_property
    def _rough_peaks(self) -> list[SlicePeak | InnerPeak | None]:
        """Peak of each grid that reaches an edge or a relief start; else None."""
        result, grids = self.result, self.tangents.grids
        rough = ((result.on_edge > 0) | (result.on_relief_start > 0))[*self._grids].tolist()
        uneven = [
            (one.contact, one.separation, one.pressure) for one, is_rough in zip(grids, rough, strict=True) if is_rough
        ]
        peaks = iter(rough_peaks(result.gear_pair, uneven))
        return [next(peaks) if is_rough else None for is_rough in rough]

    def _of_changes(self, marks: Mask) -> Mask:
        """Marks of contacts, if a key changes the gears: the torque alone moves none of them."""
        return marks & any(change is not None for change in self.changes)

    def pressure_norm(self, exponent: float = EXPONENT) -> Array:
        r"""Derivatives of the norm of the pressure over a position, (torque, position, key) [MPa per unit].

        Smooth where the place of the peak jumps: (integral of p^m dA over 1 mm^2)^(1/m), m the exponent.
        """
        require(
            (1.0 <= real(exponent) < math.inf, f"exponent: found {exponent!r:.60}; allowed a finite number from 1 on")
        )
        grids = self.tangents.grids
        norms, slopes = zip(
            *(pressure_norm(one.pressure, one.separation.cover, one.problem.spacing, exponent) for one in grids),
            strict=True,
        )
        largest = np.maximum.reduceat(norms, np.searchsorted(self.tangents.state, np.arange(self.places.shape[1])))
        parts = np.array(norms) / largest[self.tangents.state]
        whole = np.bincount(self.tangents.state, parts**exponent)[self.tangents.state]
        weights = (parts / whole ** (1.0 / exponent)) ** (exponent - 1.0)
        row = self.tangents.gathered(slopes) * weights[self.tangents.grid]
        changes = np.full((*self.result.transmission_error.shape, len(self.keys)), np.nan)
        changes[*self.places] = self.tangents.functional_change(row, self.growth.gaps, self.torques).T
        return changes

    @cached_property
    def face_load_factor(self) -> Array:
        """Derivatives of K_Hbeta, (torque, key) [1 per unit], the largest strip held; NaN with one position.

        Where another strip of the face carries nearly as much, an AccuracyWarning tells what its derivatives are; where
        the faces of both gears end at one place, what they are to both sides of a key.
        """
        result = self.result
        by_torque, kinks = self._of_largest_strips
        rivals = [rival_strip(result.gear_pair, result.path, rows) for rows in result.maps]
        if any(rivals):
            others, _ = self._of_strips(([None if rival is None else rival[0] for rival in rivals], 1.0))
            lacking = [rival[1] for rival in rivals if rival is not None]
            warn_of_strips(self.keys, by_torque, others - by_torque, lacking)
        if not all(rivals):
            alike = np.array([rival is not None for rival in rivals])[:, None]
            through_three = np.where(alike, by_torque, self._through_three_strips)
            warn_of_strips_beside(self.keys, by_torque, through_three)
        warn_of_face_ends(self.keys, by_torque, kinks)
        warn_of_end_strips(result, self.keys, *self._common_face)
        warn_of_arcs(result, self.keys, by_torque)
        return by_torque

    @property
    def _through_three_strips(self) -> Array:
        """Derivatives (torque, key) of the top of the parabola through the largest strip and those beside it."""
        return self._of_strips(*top_strips(self.result))[0]

    @property
    def face_load_factor_kinks(self) -> Array:
        """Derivatives of K_Hbeta by growing values of the keys less those by falling ones, (torque, key)."""
        return self._of_largest_strips[1]

    @cached_property
    def _common_face(self) -> tuple[Array, Array]:
        """Motions of the ends of the common face with the keys, and their kinks."""
        return common_face_motions(self.result, self.changes)

    @cached_property
    def _of_largest_strips(self) -> tuple[Array, Array]:
        return self._of_strips(([None] * len(self.result.torque), 1.0))

    def _of_strips(self, *of_strips: tuple[Sequence[int | None], Array | float]) -> tuple[Array, Array]:
        """Derivatives (torque, key) of a sum of the factors of strips of the face under each torque, and their kinks.

        ``of_strips``: a strip for each torque, None the largest one, and its weights (torque,) in the sum.
        """
        kinks = self.growth.no_kinks if self.growth.kinks is None else self.growth.kinks
        motions, gaps = (
            np.concatenate([getattr(one, name) for one in (self.growth, kinks)]) for name in ("motions", "gaps")
        )
        row, by_motion = np.zeros(self.tangents.grid.size), np.zeros((len(self.result.torque), len(motions)))
        for strips, weights in of_strips:
            parts = np.broadcast_to(weights, len(by_motion))
            slopes, moved = face_load_factor_changes(
                self.result, self._grids, self.tangents.grids, motions, np.concatenate(self._common_face), strips
            )
            row += self.tangents.gathered(slopes) * parts[self._grids[0]][self.tangents.grid]
            by_motion += parts[:, None] * moved
        torques = np.concatenate([self.torques, self._of_levers(kinks.lever_torques)])
        change = self.tangents.functional_change(row, gaps, torques)
        for t in range(len(by_motion)):
            by_motion[t] += change[:, self.places[0] == t].sum(axis=1)
        slopes_and_kinks = np.split(by_motion, 2, axis=1)
        return slopes_and_kinks[0], slopes_and_kinks[1]

    @cached_property
    def root_tension(self) -> Array:
        """Derivatives of the largest root tension, (torque, position, gear, key) [MPa per unit]; tooth and side held.

        NotAskedError without root stress.
        """
        return self._of_root_stress("root_tension")

    @cached_property
    def root_compression(self) -> Array:
        """Derivatives of the largest root compression, in the form of ``root_tension``; negative: compression grows."""
        return self._of_root_stress("root_compression")

    def _of_root_stress(self, name: str) -> Array:
        """Of an extreme of the root stress, (torque, position, gear, key)."""
        places = getattr(self.result, f"{name}_place")
        changes = np.full((*places.shape[:-1], len(self.keys)), np.nan)
        with one_blas_thread():
            for gear in range(places.shape[-2]):
                rows, moved_lines = root_slopes(
                    self.result.gear_pair,
                    gear,
                    self.tangents,
                    places[(*self.places, gear)].tolist(),
                    self.changes,
                    self.growth.motions,
                )
                change = self.tangents.functional_change(self.tangents.gathered(rows), self.growth.gaps, self.torques)
                changes[(*self.places, gear)] = (change + moved_lines).T
        return changes

    def root_stress_at(self, gear: int, torque: int, position: int, place: Sequence[int]) -> tuple[float, Array]:
        """Stress at a place of the root [MPa] and its derivatives (keys,) [MPa per unit].

        Parameters
        ----------
        gear, torque, position : int
            0: pinion, 1: wheel; by index.
        place : sequence of int
            As of ``root_tension_place``: tooth, side, station, along the face.
        """
        (state,) = np.flatnonzero((self.places[0] == torque) & (self.places[1] == position)).tolist()
        places = [place if number == state else None for number in range(self.places.shape[1])]
        with one_blas_thread():
            rows, moved_lines = root_slopes(
                self.result.gear_pair, gear, self.tangents, places, self.changes, self.growth.motions, at_node=True
            )
            change = self.tangents.functional_change(self.tangents.gathered(rows), self.growth.gaps, self.torques)
        parts = zip(rows, self.tangents.grids, strict=True)
        stress = sum(float((row * grid.pressure).sum()) * math.prod(grid.problem.spacing) for row, grid in parts)
        return stress, np.asarray((change + moved_lines)[:, state])

    @cached_property
    def weight_maps(self) -> tuple[tuple[tuple[Array | None, ...], ...], ...]:
        """Effect of removed material by torque, position and pair, (nx, ny) on the grids of ``result.maps`` or None.

        Rotation of the wheel [rad] by one millimetre removed at a cell alone; removed at all cells it is 1/l2, and the
        transmission error falls by as much. The weights are in the ratio of dp/dT.
        """
        maps: dict[tuple[int, ...], Array] = {}
        row = self.tangents.weights / self.tangents.spread(self.tangents.stiffness)
        for place, grid, own in zip(
            self._grids.T.tolist(), self.tangents.grids, np.split(row, self.tangents.ends[:-1]), strict=True
        ):
            maps[tuple(place)] = np.zeros(grid.active.shape)
            maps[tuple(place)][grid.active] = own
        torques, positions, pairs = (range(length) for length in self.result.load_share.shape)
        return tuple(tuple(tuple(maps.get((t, n, k)) for k in pairs) for n in positions) for t in torques)

    def spread(self, deviations: Mapping[str, float]) -> xarray.Dataset:
        """Standard deviations of the figures, to first order, for keys that scatter independently.

        Parameters
        ----------
        deviations : mapping of str to float
            Keys of these sensitivities -> standard deviation in the unit of the key, >= 0.

        Returns
        -------
        xarray.Dataset
            By the names of ``dataset``, without its dimension key. Where a figure is at its least, as the peak-to-peak
            of an optimum, or has a kink, first order tells too little: compare with a Monte Carlo study
            (:class:`loaded_tca.studies.Study`).

        Raises
        ------
        InputError
            If a key is not one of these, or a deviation no finite number >= 0.
        """
        require((isinstance(deviations, Mapping), f"deviations: {deviations!r:.60}; allowed a mapping of keys"))
        require(
            (bool(deviations), "deviations: none given; a key and its standard deviation are needed"),
            *((key in self.keys, f"{key}: is none of the keys; allowed {', '.join(self.keys)}") for key in deviations),
            *(
                (0.0 <= real(value) < math.inf, f"{key}: found {value!r:.60}; allowed a finite deviation >= 0")
                for key, value in deviations.items()
            ),
        )
        slopes = self.dataset
        parts = [slopes.sel(key=key, drop=True) * float(value) for key, value in deviations.items()]
        return sum(part**2 for part in parts) ** 0.5

    @property
    def dataset(self) -> xarray.Dataset:
        """All derivatives as a dataset with the dimensions torque, position, pair and key."""
        import xarray

        coordinates = {name: self.result.dataset[name] for name in ("torque", "pinion_angle", "pair")}
        dimensions = {
            ("torque", "position"): ("transmission_error",),
            ("torque", "position", "pair"): ("load_share", "line_load", "peak_pressure"),
            ("torque",): ("peak_to_peak", "face_load_factor"),
        }
        if self.result.has_root_stress:
            dimensions["torque", "position", "gear"] = "root_tension", "root_compression"
        arrays = {name: ((*own, "key"), getattr(self, name)) for own, names in dimensions.items() for name in names}
        return xarray.Dataset(arrays, {**coordinates, "key": list(self.keys)})

    @cached_property
    def peak_to_peak(self) -> Array:
        """Derivatives of the peak-to-peak transmission error, (torque, key) [rad per unit]; NaN at one place alone.

        That of the highest position less that of the lowest one. Where these depend on the grids an AccuracyWarning
        says by how much.
        """
        errors, slopes = self.result.transmission_error, self.transmission_error
        warn_of_grids(self.keys, slopes, self.transmission_error_by_grids, self.result.um_per_rad)
        changes = np.full((len(errors), len(self.keys)), np.nan)
        for t, error in enumerate(errors):
            if min(self.result.places_of_mesh, np.isfinite(error).sum()) > 1:
                changes[t] = slopes[t, np.nanargmax(error)] - slopes[t, np.nanargmin(error)]
        return changes

    def harmonics(self, count: int) -> Array:
        """Derivatives of the amplitudes of ``MeshCycle.harmonics``, (torque, order, key) [rad per unit], or NaN."""
        amplitudes = self.result.harmonics(count)
        changes = np.full((*amplitudes.shape, len(self.keys)), np.nan)
        for t, error in enumerate(self.result.transmission_error):
            wave = harmonic_coefficients(error, count)
            for k in range(len(self.keys)):
                slope = harmonic_coefficients(self.transmission_error[t, :, k], count)
                known = np.isfinite(amplitudes[t]) & np.isfinite(slope) & (amplitudes[t] > 0.0)
                changes[t, known, k] = (wave[known].conj() * slope[known]).real / amplitudes[t, known]
        return changes
