"""The result of what the tooth pairs carry: the one place that reads loaded contacts."""

from __future__ import annotations

import math
from importlib.metadata import version

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.loaded.cycle import Carried
from loaded_tca.loaded.tooth_contact import LoadedContact
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.mesh_cycle import MeshCycle, dataset_of
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.scene import Scene
from loaded_tca.unloaded import heelwards


def mesh_cycle(scene: Scene, pair: GearPair, carried: Carried) -> MeshCycle:
    """Collect the result of an analysis, its tooth pairs in the order of the mesh.

    Parameters
    ----------
    scene : Scene
    pair : GearPair
        Of the scene.
    carried : Carried
    """
    order = np.argsort(carried.pairs)
    share = carried.share[..., order]
    contacts = {(t, n, k): carried.contacts[t][n][order[k]] for t, n, k in np.ndindex(share.shape)}
    numbers: dict[str, Array] = {}
    for place, loaded in contacts.items():
        for name, number in ({} if loaded is None else _numbers(pair, loaded)).items():
            missing = math.nan if isinstance(number, float) else type(number)()
            numbers.setdefault(name, np.full(share.shape, missing))[place] = number
    apart = np.isnan(numbers["contact_deformation"])
    numbers["normal_force"] = np.where(apart & ~np.isnan(share), 0.0, numbers["normal_force"])
    lengths = 1e3 * pair.base_radii[0] * pair.base_radii[1] * pair.face_width
    with np.errstate(divide="ignore", invalid="ignore"):
        secant = np.where(carried.rotation > 0.0, carried.torque[:, None] / carried.rotation, math.nan)
    path = carried.path
    arrays = {
        **numbers,
        "torque": carried.torque,
        "pair": carried.pairs[order],
        "pinion_angle": path.pinion_angle,
        "wheel_base_radius": pair.base_radii[1],
        "face_width": pair.face_width,
        "max_pressure": math.nan if pair.max_pressure is None else pair.max_pressure,
        "unloaded_transmission_error": path.transmission_error,
        "transmission_error": path.transmission_error - pair.driving * carried.rotation,
        "mesh_stiffness": carried.torque_rate / lengths,
        "secant_stiffness": secant / lengths,
        "loaded_pairs": (numbers["normal_force"] > 0.0).sum(axis=-1),
        "load_share": share,
        "tooth_deflection": np.where(apart, math.nan, carried.tooth_deflection[..., order]),
    }
    torques, positions, pairs = (range(length) for length in share.shape)
    return MeshCycle(
        scene=scene,
        dataset=dataset_of(arrays, version("loaded_tca")),
        path=path,
        paths=tuple(carried.paths[k] for k in order),
        maps=tuple(tuple(tuple(_pressure_map(contacts[t, n, k]) for k in pairs) for n in positions) for t in torques),
    )


def _pressure_map(loaded: LoadedContact | None) -> PressureMap | None:
    if loaded is None:
        return None
    grid, solution = loaded.separation, loaded.solution
    gap = np.where(np.isfinite(grid.gap), solution.gap, np.inf)
    return PressureMap(grid.x, grid.y, grid.spacing, solution.pressure, gap, grid.origin, grid.axes)


def _numbers(pair: GearPair, loaded: LoadedContact) -> dict[str, float | bool | int]:
    """What a result has of one loaded contact, by the names of its dataset."""
    solution, hertz = loaded.solution, loaded.hertz
    width, length = loaded.extent
    radius, axial = loaded.peak_place
    slope = abs(float(loaded.separation.axes[1] @ heelwards(pair, loaded.contact)))
    longest = pair.face_width / slope if slope > 0.0 else math.inf  # what of the contact's direction the face holds
    return {
        "normal_force": solution.load,
        "peak_pressure": loaded.peak_pressure,
        "central_pressure": loaded.central_pressure,
        "peak_radius": radius,
        "peak_axial": axial,
        "hertz_pressure": hertz.max_pressure if hertz else math.nan,
        "hertz_semi_minor": hertz.semi_minor if hertz else math.nan,
        "hertz_semi_major": hertz.semi_major if hertz else math.nan,
        "contact_width": width,
        "contact_length": min(length, longest),
        "line_load": loaded.line_load,
        "line_load_ratio": loaded.line_load * longest / solution.load if solution.load > 0.0 else math.nan,
        "contact_deformation": loaded.contact_deformation,
        "on_edge": loaded.at_edge,
        "on_relief_start": loaded.at_relief_start,
        "cells_across": solution.pressure.shape[0],
        "cells_along": solution.pressure.shape[1],
        "iterations": solution.iterations,
        "residual": solution.residual,
    }
