"""Sensitivities of gears on supports: torque by torque, each in the gears as they stand under it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.model import SumOfParts
from loaded_tca.errors import require
from loaded_tca.loaded.force_lines import bending_by_shift
from loaded_tca.loaded.sensitivity import LoadedStates, Tangents
from loaded_tca.loaded.supported import given_motions
from loaded_tca.results.figure_slopes import EXPONENT
from loaded_tca.results.gap_growth import GapGrowth
from loaded_tca.results.loaded_grids import states_of_maps
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.sensitivities import LINEAR, NEWTON_MILLIMETRES, NO_LOAD, TORQUE, Sensitivities
from loaded_tca.results.support_growth import (
    UnderOneTorque,
    changes_at_rest,
    growth_on_supports,
    under_one_torque,
)
from loaded_tca.separation.pair_change import PairChange


def _by_torque(name: str) -> cached_property[Any]:
    """Attribute of sensitivities that has the torque first, put together of those of each torque."""
    joined = cached_property(lambda self: self.of_torques(name))
    joined.__doc__ = getattr(Sensitivities, name).__doc__
    return joined


@dataclass(frozen=True, eq=False, repr=False)
class SensitivitiesOnSupports(Sensitivities):
    """Derivatives of a result on supports, which holds those under each torque by themselves.

    Attributes
    ----------
    parts : tuple of Sensitivities or None
        By torque, each of a result with that one; None where no tooth pair carries load. What a state or a grid has is
        in these alone.
    """

    tangents: Tangents = field(init=False)
    places: Indices = field(init=False)
    pairs: Indices = field(init=False)
    growth: GapGrowth = field(init=False)
    changes: tuple[PairChange | None, ...] = field(init=False)
    parts: tuple[Sensitivities | None, ...]

    transmission_error = _by_torque("transmission_error")
    transmission_error_kinks = _by_torque("transmission_error_kinks")
    load_share = _by_torque("load_share")
    on_cut_slices = _by_torque("on_cut_slices")
    at_corners = _by_torque("at_corners")
    across_relief_starts = _by_torque("across_relief_starts")
    line_load = _by_torque("line_load")
    peak_pressure = _by_torque("peak_pressure")
    face_load_factor = _by_torque("face_load_factor")
    root_tension = _by_torque("root_tension")
    root_compression = _by_torque("root_compression")

    def __repr__(self) -> str:
        states = sum(one.places.shape[1] for one in self.parts if one is not None)
        return f"Sensitivities({len(self.keys)} keys, {states} states)"

    def of_torques(self, name: str) -> Array:
        """An array of all torques, of those of each: NaN, or false, under those that load nothing."""
        return self._joined([None if one is None else getattr(one, name) for one in self.parts])

    def pressure_norm(self, exponent: float = EXPONENT) -> Array:
        """As of :meth:`Sensitivities.pressure_norm`."""
        return self._joined([None if one is None else one.pressure_norm(exponent) for one in self.parts])

    @cached_property
    def weight_maps(self) -> tuple[tuple[tuple[Array | None, ...], ...], ...]:
        """As of :class:`Sensitivities`."""
        _, positions, pairs = self.result.load_share.shape
        none = ((None,) * pairs,) * positions
        return tuple(none if one is None else one.weight_maps[0] for one in self.parts)

    @staticmethod
    def _joined(arrays: Sequence[Array | None]) -> Array:
        like = next(one for one in arrays if one is not None)
        none = np.full(like.shape, np.nan if like.dtype.kind == "f" else 0, dtype=like.dtype)
        return np.concatenate([none if one is None else one for one in arrays])


def sensitivities_on_supports(result: CycleNumbers, keys: Sequence[str]) -> tuple[SensitivitiesOnSupports, bool]:
    """Derivatives of a result on supports, and whether a key moves lines on the flanks through contacts."""
    at_rest = changes_at_rest(result.scene, [key for key in keys if key != TORQUE])
    solved, kept = result.states or (None, ())
    parts = []
    for t in range(len(result.torque)):
        one = under_one_torque(result, t)
        states = kept[t] if solved == result.scene else states_of_maps(one, one.supports)
        parts.append(_of_torque(one, states, keys, at_rest) if any(states.grids) else None)
    require((any(parts), NO_LOAD))
    made = SensitivitiesOnSupports(tuple(keys), result, tuple(parts))
    return made, any(not change.holds_lines for change in at_rest.values())


def _of_torque(
    result: UnderOneTorque, states: LoadedStates, keys: Sequence[str], at_rest: Mapping[str, PairChange]
) -> Sensitivities:
    """Derivatives under one torque."""
    bending = states.bending
    assert isinstance(bending, SumOfParts)
    tangents = states.tangents(LINEAR)
    given = partial(result.supports.opened, motions=given_motions(result.supports, result.held))
    tangents = tangents.with_lines(bending_by_shift(tangents.grids, tangents.state, bending, given))
    columns = np.array([result.pair.tolist().index(grid.number) for grid in tangents.grids])
    of_torque = np.flatnonzero([len(state) for state in states.grids])
    places = np.stack([np.zeros_like(of_torque), of_torque])
    raised = np.array([[NEWTON_MILLIMETRES if key == TORQUE else 0.0] for key in keys])
    growth, changes = growth_on_supports(
        result,
        tangents,
        bending,
        (*places[:, tangents.state], columns),
        keys,
        at_rest,
        raised,
    )
    return Sensitivities(tuple(keys), result, tangents, places, columns, growth, changes)
