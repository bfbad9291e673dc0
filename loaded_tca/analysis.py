"""The whole story in one function: from a scene to the loaded contact over the positions of a pitch."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from importlib.metadata import version

import numpy as np

from loaded_tca.errors import AccuracyWarning
from loaded_tca.flanks.jet import Array
from loaded_tca.loaded_contact import GridChoice, LoadedContact, press
from loaded_tca.mesh_cycle import MeshCycle, PressureMap
from loaded_tca.pair import GearPair
from loaded_tca.scene import Scene
from loaded_tca.unloaded import ContactPath, ContactPoint, heelwards, trace_contact

Progress = Callable[[int, int], None]

THICKEST_CONTACT = 0.25
"""Half width of a contact, over the module, above which a tooth is no half-space: it is 1.6 modules thick."""


def analyse(scene: Scene, progress: Progress | None = None) -> MeshCycle:
    """Analyse a scene: one tooth pair carries the whole load at every position of a pitch.

    Parameters
    ----------
    scene : Scene
    progress : callable, optional
        Called as ``progress(done, total)`` after every pressure map.

    Returns
    -------
    MeshCycle

    Raises
    ------
    InputError, GeometryError
        If the scene's parts do not fit each other, or the flanks never touch.
    ConvergenceError
        If a contact is not solved to the tolerance.

    Warns
    -----
    AccuracyWarning
        If the contact reaches a border of a flank, or the model is at another limit.
    """
    pair = scene.pair()
    path = trace_contact(pair, _positions(pair, scene.analysis.positions))
    torques = np.asarray(scene.torques)
    grid = _grid_choice(scene)
    contacts = _load_all(pair, path, torques, grid, progress)
    _warn_of_doubts(pair, grid, contacts)
    return _mesh_cycle(scene, pair, path, torques, contacts)


def _positions(pair: GearPair, count: int) -> Array:
    return np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, count) if count > 1 else np.zeros(1)


def _grid_choice(scene: Scene) -> GridChoice:
    wanted = scene.analysis
    if wanted.cells is not None:
        return GridChoice(cells=(wanted.cells[0], wanted.cells[1]), tolerance=wanted.tolerance)
    return GridChoice(accuracy=wanted.accuracy, tolerance=wanted.tolerance)


Contacts = list[list[LoadedContact | None]]


def _load_all(
    pair: GearPair, path: ContactPath, torques: Array, grid: GridChoice, progress: Progress | None
) -> Contacts:
    """Pressure maps of every torque and position; None where the tooth pair does not touch."""
    done, contacts = 0, []
    for torque in torques:
        row: list[LoadedContact | None] = []
        for position in range(len(path)):
            contact = path[position]
            row.append(press(pair, contact, torque / contact.pinion_lever, grid) if contact.touches else None)
            done += 1
            if progress is not None:
                progress(done, len(torques) * len(path))
        contacts.append(row)
    return contacts


def _warn_of_doubts(pair: GearPair, grid: GridChoice, contacts: Contacts) -> None:
    """One AccuracyWarning for each reason to doubt, with the number of maps it concerns."""
    solved = [loaded for row in contacts for loaded in row if loaded is not None]
    reasons: dict[str, int] = {}
    for loaded in solved:
        for reason in _doubts(pair, grid, loaded):
            reasons[reason] = reasons.get(reason, 0) + 1
    what = "positions" if len(contacts) == 1 else "pressure maps"
    for reason, count in reasons.items():
        warnings.warn(f"{reason} (at {count} of {len(solved)} {what})", AccuracyWarning, stacklevel=3)


def _doubts(pair: GearPair, grid: GridChoice, loaded: LoadedContact) -> list[str]:
    solution = loaded.solution
    found = []
    if loaded.at_border:
        found.append(
            "the contact reaches a border of a flank: Hertz does not hold, and pressure there grows with the grid"
        )
    if loaded.at_crease:
        found.append("the contact lies across the start of a linear relief: its peak pressure grows with the grid")
    smooth = not (loaded.at_border or loaded.at_crease)
    if grid.cells is None and smooth and solution.error_estimate.peak_pressure > grid.accuracy:
        found.append(f"the estimated error stays above the accuracy of {grid.accuracy:g}")
    if solution.reaches_border:
        found.append("the contact reaches the box")
    if solution.load > 0.0 and solution.cells_across[0] < 8:
        found.append("fewer than 8 cells lie across the contact")
    if 0.5 * loaded.extent[0] > THICKEST_CONTACT * pair.module:
        found.append("the contact is so wide that the tooth is no half-space")
    return found


def _mesh_cycle(scene: Scene, pair: GearPair, path: ContactPath, torques: Array, contacts: Contacts) -> MeshCycle:
    numbers = [[_numbers(pair, loaded) for loaded in row] for row in contacts]
    names = next(entry for row in numbers for entry in row if entry)

    def table(name: str) -> Array:
        missing = type(names[name])() if not isinstance(names[name], float) else math.nan
        values = np.array([[entry.get(name, missing) for entry in row] for row in numbers])
        return values if len(torques) > 1 else values[0]

    shares = np.where(path.touches, 1.0, math.nan)[:, None]
    return MeshCycle(
        title=scene.title,
        scene_toml=scene.to_toml(),
        version=version("loaded_tca"),
        path=path,
        torque=torques,
        pairs=np.zeros(1, dtype=int),
        load_share=np.broadcast_to(shares, (len(torques), *shares.shape)).copy() if len(torques) > 1 else shares,
        maps=tuple(tuple(_pressure_map(loaded) for loaded in row) for row in contacts),
        wheel_base_radius=pair.base_radii[1],
        face_width=pair.face_width,
        max_pressure=math.nan if pair.max_pressure is None else pair.max_pressure,
        **{name: table(name) for name in names},
    )


def _pressure_map(loaded: LoadedContact | None) -> PressureMap | None:
    if loaded is None:
        return None
    grid, solution = loaded.separation, loaded.solution
    return PressureMap(grid.x, grid.y, grid.spacing, solution.pressure, solution.gap, grid.origin, grid.axes)


def _numbers(pair: GearPair, loaded: LoadedContact | None) -> dict[str, float | bool | int]:
    """The numbers of one pressure map, by the names of the fields of MeshCycle."""
    if loaded is None:
        return {}
    contact, solution, hertz = loaded.contact, loaded.solution, loaded.hertz
    width, length = loaded.extent
    peak_radius, peak_axial = loaded.peak_place
    return {
        "transmission_error": loaded_transmission_error(pair, contact, solution.approach),
        "normal_force": solution.load,
        "peak_pressure": loaded.peak_pressure,
        "central_pressure": loaded.central_pressure,
        "peak_radius": peak_radius,
        "peak_axial": peak_axial,
        "hertz_pressure": hertz.max_pressure if hertz else math.nan,
        "hertz_semi_minor": hertz.semi_minor if hertz else math.nan,
        "hertz_semi_major": hertz.semi_major if hertz else math.nan,
        "contact_width": width,
        "contact_length": min(length, _longest(pair, loaded)),
        "approach": solution.approach,
        "mesh_stiffness": _mesh_stiffness(pair, contact, loaded.stiffness),
        "on_edge": loaded.at_border,
        "at_crease": loaded.at_crease,
        "cells_across": solution.pressure.shape[0],
        "cells_along": solution.pressure.shape[1],
        "iterations": solution.iterations,
        "residual": solution.residual,
    }


def _longest(pair: GearPair, loaded: LoadedContact) -> float:
    """Length over which the face reaches in the direction of the contact [mm]."""
    slope = abs(float(loaded.separation.axes[1] @ heelwards(pair, loaded.contact)))
    return pair.face_width / slope if slope > 0.0 else math.inf


def loaded_transmission_error(pair: GearPair, contact: ContactPoint, approach: float) -> float:
    """Unloaded transmission error less the approach over its lever [rad]; more where the wheel drives."""
    return contact.transmission_error - pair.driving * approach / contact.wheel_lever


def _mesh_stiffness(pair: GearPair, contact: ContactPoint, stiffness: float) -> float:
    """d(F_bt/b)/d(r_b2 TE) [N/(mm um)] from dF/d approach [N/mm]."""
    levers = contact.pinion_lever / pair.base_radii[0] * contact.wheel_lever / pair.base_radii[1]
    return 1e-3 * levers * stiffness / pair.face_width
