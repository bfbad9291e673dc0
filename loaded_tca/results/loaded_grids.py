"""The contact problems behind the pressure maps of a result, made again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance.model import model_of
from loaded_tca.errors import InputError
from loaded_tca.loaded.cycle import farthest_apart
from loaded_tca.loaded.free_edges import edge_compliances
from loaded_tca.loaded.load_sharing import tooth_pairs_at
from loaded_tca.loaded.sensitivity import LoadedGrid, LoadedStates, loaded_states
from loaded_tca.loaded.tooth_contact import contact_problem
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.separation.box import Box
from loaded_tca.separation.sample import Separation, sample_separations
from loaded_tca.supports import SupportCompliance
from loaded_tca.unloaded import ContactPoint, trace_contact, trace_teeth
from loaded_tca.unloaded.curvature import relative_curvatures

SAME = 1e-6
"""Distance of two contact points, over the module, that are the same."""


def states_of_maps(result: CycleNumbers, supports: SupportCompliance | None = None) -> LoadedStates:
    """Contact problems that the pressure maps of a result solve, and how they answer.

    Parameters
    ----------
    result : MeshCycle
    supports : SupportCompliance, optional
        What the gears stand on, as it gives way where they stand; default: they are rigid.

    Raises
    ------
    InputError
        If the maps do not belong to the scene of the result.
    """
    pair, wanted, numbers = result.gear_pair, result.scene.analysis, result.pair.tolist()
    unloaded, apart = _unloaded_contacts(pair, result.pinion_angle, alone=not wanted.load_sharing)
    if supports is None:
        bending = model_of(result.scene, pair, apart)
    else:
        at_rest = model_of(result.scene, result.scene.pair(), apart)
        assert at_rest is not None
        bending = at_rest.on_supports(supports).mounted(pair)
    places = np.argwhere(result.normal_force > 0.0).tolist()
    maps = [one for t, n, k in places if (one := result.maps[t][n][k]) is not None]
    contacts = [unloaded[n][numbers[k]] for _, n, k in places if numbers[k] in unloaded[n]]
    if len(contacts) < len(maps) or any(
        not np.allclose(one.origin, contact.point, rtol=0.0, atol=SAME * pair.module)
        for one, contact in zip(maps, contacts, strict=True)
    ):
        raise InputError("sensitivities: the pressure maps of the result do not belong to its scene")
    separations = _separations(pair, contacts, maps)
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


def _unloaded_contacts(pair: GearPair, angles: Array, *, alone: bool) -> tuple[list[dict[int, ContactPoint]], int]:
    """Contacts by position and number of the tooth pair, and how many pitches those of a position are apart."""
    if alone:
        path = trace_contact(pair, angles)
        return [{0: path[n]} for n in range(len(path))], 1
    mesh = trace_teeth(pair, angles)
    contacts = [{one.pair: one.contact for one in tooth_pairs_at(mesh, n)} for n in range(len(mesh))]
    return contacts, max(farthest_apart(mesh), 1)


def _separations(pair: GearPair, contacts: Sequence[ContactPoint], maps: Sequence[PressureMap]) -> list[Separation]:
    """Grids of maps; where the flanks do not end the gap is that under load, which is of no account here."""
    bends = relative_curvatures(pair, contacts)
    ends = [bool(np.isinf(one.gap).any()) for one in maps]
    cut_maps = [one for one, cut in zip(maps, ends, strict=True) if cut]
    sampled = iter(
        sample_separations(
            pair,
            [contact for contact, cut in zip(contacts, ends, strict=True) if cut],
            cells=[one.pressure.shape for one in cut_maps],
            loads=[None] * len(cut_maps),
            boxes=[Box.of(one) for one in cut_maps],
        )
    )
    separations = []
    for one, bend, cut in zip(maps, bends, ends, strict=True):
        whole = np.ones(one.gap.shape)
        place = one.x, one.y, one.spacing, one.origin, one.axes, bend.along_axes(one.axes)
        made = next(sampled) if cut else Separation(one.gap, *place, whole, one.gap, one.force_line)
        if not isinstance(made, Separation):
            raise made
        separations.append(replace(made, force_line=one.force_line))
    return separations
