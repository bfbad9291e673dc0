"""How the derivatives of a result are found: its contact problems made again, of the gears as they stand.

On supports they are found torque by torque, each in the gears as they stand under it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.compliance.model import SumOfParts, model_of
from loaded_tca.edges.free import edge_compliances
from loaded_tca.errors import InputError, require
from loaded_tca.loaded.force_lines import bending_by_shift
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.sensitivity import LoadedStates, Tangents, loaded_states
from loaded_tca.loaded.tooth_contact import contact_problem
from loaded_tca.loaded.tooth_pairs import ToothPair, tooth_pairs_at
from loaded_tca.results.figure_slopes import (
    EXPONENT,
)
from loaded_tca.results.gap_growth import GapGrowth, MotionGrowth, gap_growth, motion_growth
from loaded_tca.results.sensitivities import FEW, LINEAR, NEWTON_MILLIMETRES, TORQUE, Sensitivities
from loaded_tca.results.support_growth import (
    OnSlices,
    UnderOneTorque,
    as_gears_stand,
    changes_at_rest,
    growth_on_supports,
)
from loaded_tca.results.warnings import warn_of_contacts
from loaded_tca.separation.sample import Separation
from loaded_tca.threads import one_blas_thread
from loaded_tca.unloaded import ContactPoint, RelativeCurvature, trace_contact, trace_teeth
from loaded_tca.unloaded.curvature import relative_curvatures
from loaded_tca.unloaded.path import angles_through, trace_near

if TYPE_CHECKING:
    from loaded_tca.arrays import Array, Indices
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.results.pressure_map import PressureMap
    from loaded_tca.separation.pair_change import PairChange

SAME = 1e-6
"""Distance of two contact points, over the module, that are the same."""


def states_of_maps(result: CycleNumbers) -> LoadedStates:
    """Contact problems that the pressure maps of a result solve, and how they answer.

    Parameters
    ----------
    result : MeshCycle or UnderOneTorque
        Of gears that stand alike under all its torques.

    Raises
    ------
    InputError
        If the maps do not belong to the scene of the result.
    """
    pair, wanted, numbers = result.gear_pair, result.scene.analysis, result.pair.tolist()
    unloaded = _first_contacts(pair, result.pinion_angle, alone=not wanted.load_sharing)
    if isinstance(result, UnderOneTorque):
        at_rest = model_of(result.scene, result.scene.pair(), result.coupled_pitches)
        assert at_rest is not None
        bending: SumOfParts | None = at_rest.on_supports(result.supports).mounted(pair)
    else:
        bending = model_of(result.scene, pair, result.coupled_pitches)
    places = np.argwhere(result.normal_force > 0.0).tolist()
    maps = [one for t, n, k in places if (one := result.maps[t][n][k]) is not None]
    firsts = [unloaded[n][numbers[k]] for _, n, k in places if numbers[k] in unloaded[n]]
    contacts = _contacts_of_maps(pair, firsts, maps) if len(firsts) == len(maps) else []
    if len(contacts) < len(maps) or any(
        not np.allclose(one.origin, contact.point, rtol=0.0, atol=SAME * pair.module)
        for one, contact in zip(maps, contacts, strict=True)
    ):
        raise InputError("sensitivities: the pressure maps of the result do not belong to its scene")
    curvatures = relative_curvatures(pair, contacts)
    separations = [_separation(*one) for one in zip(maps, curvatures, strict=True)]
    ends = edge_compliances(pair, separations) if wanted.free_edges else [None] * len(maps)
    positions = len(result.path)
    states: list[list[LoadedGrid]] = [[] for _ in range(len(result.torque) * positions)]
    for (t, n, k), one, contact, separation, end in zip(places, maps, contacts, separations, ends, strict=True):
        if isinstance(end, InputError):
            raise end
        bent = None if bending is None else bending.within(numbers[k], separation)
        problem = contact_problem(pair, separation, float(result.normal_force[t, n, k]), bent, end)
        states[t * positions + n].append(LoadedGrid(numbers[k], contact, separation, problem, one.pressure, bent))
    return loaded_states(states, bending)


def _contacts_of_maps(pair: GearPair, firsts: Sequence[ToothPair], maps: Sequence[PressureMap]) -> list[ContactPoint]:
    """Contacts that maps have grown from, at the middles of the ways of pairs that load turns from first contact."""
    if not firsts:
        return []
    near = np.array([(one.contact.pinion_angle, one.contact.wheel_angle) for one in firsts]).T
    angles = angles_through(pair, near, np.array([one.origin for one in maps]))[0]
    path = trace_near(pair, [one.contact for one in firsts], angles.tolist())
    return [one.at_middle(path[n]).contact for n, one in enumerate(firsts)]


def _first_contacts(pair: GearPair, angles: Array, *, alone: bool) -> list[dict[int, ToothPair]]:
    """Tooth pairs at first contact by position and number."""
    if alone:
        path = trace_contact(pair, angles)
        return [{0: ToothPair(0, path[n], 0.0)} for n in range(len(path))]
    mesh = trace_teeth(pair, angles)
    return [{one.pair: one for one in tooth_pairs_at(mesh, n)} for n in range(len(mesh))]


def _separation(one: PressureMap, curvature: RelativeCurvature) -> Separation:
    """Grid of a map, with the gap under load, which is of no account here."""
    cut_gap = np.where(one.cover > 0.0, 0.0, np.inf)
    place = one.x, one.y, one.spacing, one.origin, one.axes, curvature.along_axes(one.axes)
    return Separation(one.gap, *place, one.cover, cut_gap, one.force_line)


def _by_torque(name: str) -> cached_property[Any]:
    """Attribute of sensitivities that has the torque first, put together of those of each torque."""
    joined = cached_property(lambda self: self.of_torques(name))
    joined.__doc__ = getattr(Sensitivities, name).__doc__
    return joined


@dataclass(frozen=True, eq=False, repr=False)
class JoinedSensitivities(Sensitivities):
    """Derivatives of a result whose gears stand elsewhere under each torque, of those under each by themselves.

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
    with_motions: Callable[..., MotionGrowth] = field(init=False)
    parts: tuple[Sensitivities | None, ...]

    transmission_error = _by_torque("transmission_error")
    transmission_error_kinks = _by_torque("transmission_error_kinks")
    transmission_error_by_grids = _by_torque("transmission_error_by_grids")
    load_share = _by_torque("load_share")
    load_share_by_grids = _by_torque("load_share_by_grids")
    on_cut_slices = _by_torque("on_cut_slices")
    at_corners = _by_torque("at_corners")
    across_relief_starts = _by_torque("across_relief_starts")
    beside_curvature_jumps = _by_torque("beside_curvature_jumps")
    nearly_plastic = _by_torque("nearly_plastic")
    line_load = _by_torque("line_load")
    peak_pressure = _by_torque("peak_pressure")
    face_load_factor = _by_torque("face_load_factor")
    face_load_factor_kinks = _by_torque("face_load_factor_kinks")
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


NO_LOAD = "sensitivities: no tooth pair of the result carries load"


def sensitivities(result: CycleNumbers, keys: Sequence[str]) -> Sensitivities:
    """Derivatives of a result with respect to keys of its scene; see :meth:`MeshCycle.sensitivities`."""
    listed = isinstance(keys, Iterable) and not isinstance(keys, str | bytes)
    require((listed, f"keys: {keys!r:.80}; allowed is a list of keys"))
    keys = [*keys]
    require(
        (bool(keys), "keys: none given"),
        *((isinstance(key, str), f"keys: {key!r:.60} is no text; allowed are keys of the scene") for key in keys),
        *((keys.count(key) < 2, f"keys: {key} is given twice") for key in dict.fromkeys(map(str, keys))),
    )
    with one_blas_thread():
        changes = changes_at_rest(result.scene, [key for key in keys if key != TORQUE])
        made = _as_gears_stand(result, keys, changes)
    if not all(change.holds_lines for change in changes.values()):
        warn_of_contacts(result, kinds.RELIEF_START_BESIDE.sentence(), made.across_relief_starts)
    if result.gear_pair.max_pressure is not None:
        warn_of_contacts(result, kinds.NEARLY_PLASTIC.sentence(cells=FEW), made.nearly_plastic)
    return made


def _as_gears_stand(result: CycleNumbers, keys: Sequence[str], changes: Mapping[str, PairChange]) -> Sensitivities:
    """Derivatives of a result, found of all torques under which the gears stand alike at once."""
    solved, kept = result.states or (None, ())
    parts: list[Sensitivities | None] = []
    for number, one in enumerate(as_gears_stand(result)):
        states = kept[number] if solved == result.scene else states_of_maps(one)
        parts.append(_sensitivities(one, states, keys, changes) if any(states.grids) else None)
    require((any(parts), NO_LOAD))
    (first, *_) = parts
    return (
        first if first is not None and first.result is result else JoinedSensitivities(tuple(keys), result, (*parts,))
    )


def _sensitivities(
    result: CycleNumbers, states: LoadedStates, keys: Sequence[str], changes: Mapping[str, PairChange]
) -> Sensitivities:
    """Derivatives where gears stand alike under all torques."""
    bending, tangents = states.bending, states.tangents(LINEAR)
    assert bending is None or isinstance(bending, SumOfParts)
    on_supports = result if isinstance(result, UnderOneTorque) else None
    if bending is not None:
        displacement = None if on_supports is None else on_supports.displacement
        tangents = tangents.with_lines(bending_by_shift(tangents.grids, tangents.state, bending, displacement))
    loaded = np.flatnonzero([len(state) for state in states.grids])
    places = np.array(np.unravel_index(loaded, result.transmission_error.shape))
    columns = np.array([result.pair.tolist().index(grid.number) for grid in tangents.grids])
    at = *places[:, tangents.state], columns
    if on_supports is None:
        named = [key for key in keys if key in changes]
        growth = gap_growth(result, tangents, bending, at, [changes[key] for key in named])
        growth = growth.at_keys([keys.index(key) for key in named], len(keys))
        whole = tuple(changes.get(key) for key in keys)
        with_motions = partial(motion_growth, result, tangents, bending)
    else:
        assert bending is not None
        raised = np.array([[NEWTON_MILLIMETRES if key == TORQUE else 0.0] for key in keys])
        on_slices = OnSlices(on_supports, tangents)
        growth, whole = growth_on_supports(on_supports, tangents, bending, on_slices, at, keys, changes, raised)
        with_motions = partial(motion_growth, result, tangents, bending.on_rigid_supports, on_slices.by_motions)
    return Sensitivities(tuple(keys), result, tangents, places, columns, growth, whole, with_motions)
