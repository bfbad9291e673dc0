"""The result of what the tooth pairs carry: the one place that reads loaded contacts."""

from __future__ import annotations

import math
from dataclasses import replace
from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.edges.rounded import NOT_REACHED, CellForces, PeakAtEdge
from loaded_tca.loaded.loaded_contact import EQUAL, LoadedContact
from loaded_tca.reference.hertz import line_contact
from loaded_tca.results.load_factors import forces_of_columns, load_factors, strip_borders
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.pressure_map import PressureMap, place_on_material, sharp_edge_cell
from loaded_tca.results.root_stress import root_stress_arrays
from loaded_tca.results.slice_pressure import InnerPeak, SlicePeak, rough_peaks
from loaded_tca.results.supports import secant_on_rigid_supports, support_arrays
from loaded_tca.results.warnings import warn_of_root_stress
from loaded_tca.unloaded import heelwards

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from loaded_tca.arrays import Array
    from loaded_tca.compliance import RootStress
    from loaded_tca.loaded.cycle import CycleSolution
    from loaded_tca.loaded.standing import StandingCycle
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.scene import Scene

Place = tuple[int, int, int]
"""Indices of torque, position and pair of a result."""


def mesh_cycle(
    scene: Scene,
    pair: GearPair,
    carried: CycleSolution,
    at_rounded_edges: Mapping[tuple[int, int, int], PeakAtEdge],
    on_columns: Mapping[tuple[int, int, int], Sequence[CellForces]],
    roots: Sequence[RootStress],
    cycles: Sequence[StandingCycle],
    *,
    warnings: Sequence[str] = (),
    date: str = "",
) -> MeshCycle:
    """Collect the result of an analysis, its tooth pairs in the order of the mesh.

    Parameters
    ----------
    scene : Scene
    pair : GearPair
        Of the scene.
    carried : CycleSolution
    at_rounded_edges : mapping
        Peaks there by the indices of torque, position and tooth pair, as ``carried`` has them.
    on_columns : mapping
        Loads along contacts on columns and on coarser ones, likewise; of contacts whose cells do not resolve them.
    roots : sequence of RootStress
        Of pinion and wheel, where the scene asks for root stress.
    cycles : sequence of StandingCycle
        Where the gears stand, in the order of the torques; ``carried`` is all of them.
    warnings : sequence of str
        Sentences of the accuracy warnings of the analysis; each is kept once.
    date : str
        Of the analysis, after ISO 8601.
    """
    order = np.argsort(carried.pairs)
    share = carried.share[..., order]
    contacts = {(t, n, k): carried.contacts[t][n][order[k]] for t, n, k in np.ndindex(share.shape)}
    at_edges = {(t, n, k): at_rounded_edges.get((t, n, int(order[k]))) for t, n, k in contacts}
    moved = [one.standing.pair for one in cycles for _ in one.standing.torques]
    numbers, maps = numbers_and_maps(moved, contacts, at_edges, share.shape)
    apart = np.isnan(numbers["contact_deformation"])
    numbers["normal_force"] = np.where(apart & ~np.isnan(share), 0.0, numbers["normal_force"])
    path, (torques, positions, pairs) = carried.path, (range(length) for length in share.shape)
    borders = strip_borders(pair, path)
    for t, n, k in maps:
        if (one := maps[t, n, k]) is not None and (loads := on_columns.get((t, n, int(order[k])))) is not None:
            maps[t, n, k] = replace(one, strip_force=forces_of_columns(pair, loads, borders))
    stacked = tuple(tuple(tuple(maps[t, n, k] for k in pairs) for n in positions) for t in torques)
    face_load_factor, transverse_load_factor = load_factors(pair, path, stacked, scene.mean_contact_length)
    arrays = {
        **numbers,
        "torque": carried.torque,
        "pair": carried.pairs[order],
        "pinion_angle": path.pinion_angle,
        "wheel_base_radius": pair.base_radii[1],
        "face_width": pair.face_width,
        "coupled_pitches": 0 if (bending := cycles[0].standing.bending) is None else bending.coupled_pitches,
        "max_pressure": math.nan if pair.max_pressure is None else pair.max_pressure,
        "unloaded_transmission_error": path.transmission_error,
        "face_load_factor": face_load_factor,
        "transverse_load_factor": transverse_load_factor,
        "transmission_error": path.transmission_error - pair.driving * carried.rotation,
        "transmission_error_by_grids": _rotation_errors(contacts, share),
        "mesh_stiffness": np.concatenate([one.mesh_rate for one in cycles]) / pair.rate_of_stiffness,
        "secant_stiffness": secant_on_rigid_supports(carried, cycles) / pair.rate_of_stiffness,
        **support_arrays(pair, cycles, pressure_angle=scene.transverse_angles[0]),
        "loaded_pairs": (numbers["normal_force"] > 0.0).sum(axis=-1),
        "load_share": share,
        "tooth_deflection": np.where(apart, math.nan, carried.tooth_deflection[..., order]),
    }
    arrays |= rack_arrays(scene, pair, arrays)
    if roots:
        in_contact = ~np.isnan(arrays["normal_force"]).all(axis=-1)
        arrays |= root_stress_arrays(pair, roots, arrays["pair"].tolist(), in_contact, stacked, moved)
        warn_of_root_stress(carried.torque, arrays["root_tension"], arrays["root_compression"])
    return MeshCycle(
        scene=scene,
        dataset=MeshCycle.dataset_of(
            arrays, version=version("loaded_tca"), date=date, warnings="\n".join(dict.fromkeys(warnings))
        ),
        path=path,
        paths=tuple(carried.paths[k] for k in order),
        maps=stacked,
        states=(scene, tuple(one.carried.states for one in cycles)),
    )


def _rotation_errors(contacts: Mapping[Place, LoadedContact | None], share: Array) -> Array:
    """Estimated errors of the rotations of the wheel under load by the grids, (torque, position) [rad].

    What a contact needs for its load moves the rotation by the part that it has in the stiffness of all, which is about
    its share; ways of unlike contacts are not told to cancel.
    """
    errors = np.zeros(share.shape)
    for place, loaded in contacts.items():
        if loaded is not None:
            errors[place] = loaded.approach_error / loaded.contact.wheel_lever
    return np.asarray(np.where(share > 0.0, share * errors, 0.0).sum(axis=-1))


def rack_arrays(scene: Scene, pair: GearPair, arrays: Mapping[str, Array]) -> dict[str, Array]:
    """Arrays of a result whose wheel is a rack, by their names, from others; none of wheels."""
    if (radius := scene.rack_radius) is None:
        return {}
    per_angle = pair.ratio * radius
    return {
        "rack_travel": per_angle * arrays["pinion_angle"],
        "rack_transmission_error": radius * arrays["transmission_error"],
        "rack_force": np.asarray(arrays["torque"]) / per_angle,
    }


def numbers_and_maps(
    pairs: Sequence[GearPair],
    contacts: Mapping[Place, LoadedContact | None],
    at_edges: Mapping[Place, PeakAtEdge | None],
    shape: tuple[int, ...],
) -> tuple[dict[str, Array], dict[Place, PressureMap | None]]:
    """Arrays (torque, position, pair) of what a result has of each contact, by their names; its pressure maps.

    Parameters
    ----------
    pairs : sequence of GearPair
        The gears as they stand under each torque.
    contacts : mapping
        Of each place; None where a pair carries nothing.
    at_edges : mapping
        Peaks at rounded edges of each place; None where none is known.
    shape : tuple of int
        Of the arrays.
    """
    numbers: dict[str, Array] = {}
    maps: dict[Place, PressureMap | None] = dict.fromkeys(contacts)
    under_load = {place: one for place, one in contacts.items() if one is not None and one.solution.load > 0.0}
    rough = {place: loaded for place, loaded in under_load.items() if loaded.is_rough}
    peaks: dict[Place, SlicePeak | InnerPeak] = {}
    for pair in dict.fromkeys(pairs):
        there = {place: loaded for place, loaded in rough.items() if pairs[place[0]] is pair}
        under = [(one.contact, one.separation, one.solution.pressure) for one in there.values()]
        peaks |= zip(there, rough_peaks(pair, under), strict=True)
    for place, loaded in contacts.items():
        if loaded is None:
            continue
        one, pair = _pressure_map(loaded), pairs[place[0]]
        maps[place] = one
        of_contact = _numbers(pair, loaded, one, peaks.get(place)) | _at_edge(pair, loaded, one, at_edges[place])
        for name, number in of_contact.items():
            if name not in numbers:
                numbers[name] = np.full(shape, math.nan if isinstance(number, float) else type(number)())
            numbers[name][place] = number
    return numbers, maps


def _pressure_map(loaded: LoadedContact) -> PressureMap:
    grid, solution = loaded.separation, loaded.solution
    gap = np.where(np.isfinite(grid.gap), solution.gap, np.inf)
    place = grid.origin, grid.axes, grid.force_line
    return PressureMap(grid.x, grid.y, grid.spacing, solution.pressure, gap, grid.cover, *place)


def _numbers(
    pair: GearPair, loaded: LoadedContact, one: PressureMap, rough: SlicePeak | InnerPeak | None
) -> dict[str, float | bool | int]:
    """What a result has of one loaded contact, by the names of its dataset; the peak is ``rough`` if given."""
    solution = loaded.solution
    width, length = loaded.extent
    peak, (radius, axial), error = solution.peak_pressure, loaded.peak_place, loaded.peak_error
    if rough is not None:
        peak, (radius, axial) = rough.pressure, one.place(*rough.place)
        error = float(np.maximum(error, rough.error))
    slope = abs(float(loaded.separation.axes[1] @ heelwards(pair, loaded.contact)))
    longest = pair.face_width / slope if slope > 0.0 else math.inf  # what of the contact's direction the face holds
    length = min(length, longest)
    hertz = _hertz(pair, loaded, length)
    return {
        "normal_force": solution.load,
        "peak_pressure": peak,
        "central_pressure": loaded.central_pressure,
        "peak_radius": radius,
        "peak_axial": axial,
        "hertz_pressure": hertz[0],
        "hertz_semi_minor": hertz[1],
        "hertz_semi_major": hertz[2],
        "contact_width": width,
        "contact_length": length,
        "line_load": loaded.line_load,
        "line_load_ratio": loaded.line_load * longest / solution.load if solution.load > 0.0 else math.nan,
        "contact_deformation": loaded.contact_deformation,
        "on_edge": loaded.at_edge,
        "on_relief_start": loaded.at_relief_start,
        "cells_across": solution.pressure.shape[0],
        "cells_along": solution.pressure.shape[1],
        "discretisation_error": error if solution.load > 0.0 else math.nan,
        "iterations": solution.iterations,
        "residual": solution.residual,
    }


def _at_edge(
    pair: GearPair, loaded: LoadedContact, one: PressureMap, rounded: PeakAtEdge | None
) -> dict[str, float | bool]:
    """Pressure of a loaded contact at an edge: that of a sharp one only where no rounded one can have a larger one."""
    peak = rounded or NOT_REACHED
    pressure, place, error = peak.pressure, peak.place, peak.error
    at_arc = loaded.at_arc
    if loaded.at_edge:
        of_material = replace(one, pressure=loaded.solution.pressure_on_material)
        across, along = sharp_edge_cell(pair, of_material)
        cell = float(of_material.pressure[across, along])
        if not at_arc or cell > (1.0 + EQUAL) * peak.bound:  # both are equal at the cap
            place = place_on_material(pair, one, (across, along)) if loaded.solution.load > 0.0 else (0.0, 0.0)
            pressure, error, at_arc = cell, math.nan, False
    radius, axial = one.place(*place)
    return {
        "edge_pressure": pressure,
        "edge_is_rounded": at_arc and not peak.ends_sharp,
        "edge_pressure_error": error,
        "edge_radius": radius,
        "edge_axial": axial,
    }


def _hertz(pair: GearPair, loaded: LoadedContact, length: float) -> tuple[float, float, float]:
    """Pressure after Hertz [MPa] and semi-axes across and along [mm]; NaN where Hertz does not hold.

    Of a line it is that of its force spread evenly over the loaded length, which the ends of the flanks bound; a line
    that lies on an edge or a relief start, or is so near to a tip that this bounds its width, has none.
    """
    if (ellipse := loaded.hertz) is not None:
        return ellipse.max_pressure, ellipse.semi_minor, ellipse.semi_major
    contact, load = loaded.contact, loaded.solution.load
    if not contact.on_line or contact.on_edge or loaded.at_relief_start or load <= 0.0:
        return math.nan, math.nan, math.nan
    line = line_contact(load / length, loaded.separation.curvatures[0], pair.contact_modulus)
    middle = np.array_split(loaded.separation.gap, 2, axis=1)[0][:, -1]
    if np.isinf(middle[np.abs(loaded.separation.x) <= line.half_width]).any():
        return math.nan, math.nan, math.nan
    return line.max_pressure, line.half_width, 0.5 * length
