"""The whole story in one function: from a scene to the loaded contact over the positions of a pitch."""

from __future__ import annotations

import math
import warnings
from importlib.metadata import version

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import tooth_compliance
from loaded_tca.compliance.compliance import BORE
from loaded_tca.errors import AccuracyWarning
from loaded_tca.loaded.cycle import Carried, Contacts, Progress, carried_by_all, carried_by_one, farthest_apart
from loaded_tca.loaded.free_edges import oblique_ends
from loaded_tca.loaded.pair_coupling import BendingModel
from loaded_tca.loaded.tooth_contact import GridChoice, LoadedContact
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.contacts import NUMBERS, PairContacts, PressureMap
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene
from loaded_tca.tooth import tooth_forms
from loaded_tca.unloaded import heelwards, trace_contact, trace_teeth
from loaded_tca.unloaded.tooth_cycle import REACH

THICKEST_CONTACT = 0.25
"""Half width of a contact, over the module, above which a tooth is no half-space: it is 1.6 modules thick."""


def analyse(scene: Scene, progress: Progress | None = None) -> MeshCycle:
    """Analyse a scene: at every position of a pitch one tooth pair carries the load, or all that touch share it.

    Parameters
    ----------
    scene : Scene
    progress : callable, optional
        Called as ``progress(done, total)`` after every torque and position.

    Returns
    -------
    MeshCycle

    Raises
    ------
    InputError, GeometryError
        If the scene's parts do not fit each other, or the flanks never touch.
    ConvergenceError
        If a contact, or the balance of the tooth pairs, is not solved to the tolerance.

    Warns
    -----
    AccuracyWarning
        If the contact reaches an edge of a flank, or the model is at another limit.
    """
    pair = scene.pair()
    angles = _positions(pair, scene.analysis.positions)
    torques, grid = np.asarray(scene.torques), _grid_choice(scene)
    if scene.analysis.load_sharing:
        mesh = trace_teeth(pair, angles)
        carried = carried_by_all(pair, mesh, torques, grid, _bending(scene, pair, farthest_apart(mesh)), progress)
    else:
        path = trace_contact(pair, angles)
        carried = carried_by_one(pair, path, torques, grid, _bending(scene, pair), progress)
    _warn_of_accuracy(pair, grid, carried.contacts)
    if scene.analysis.load_sharing:
        _warn_of_reach(pair, carried)
    return _mesh_cycle(scene, pair, carried)


def _positions(pair: GearPair, count: int) -> Array:
    return np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, count) if count > 1 else np.zeros(1)


def _grid_choice(scene: Scene) -> GridChoice:
    wanted = scene.analysis
    if wanted.cells is not None:
        cells = (wanted.cells[0], wanted.cells[1])
        return GridChoice(cells=cells, tolerance=wanted.tolerance, free_edges=wanted.free_edges)
    return GridChoice(accuracy=wanted.accuracy, tolerance=wanted.tolerance, free_edges=wanted.free_edges)


def _bending(scene: Scene, pair: GearPair, neighbours: int = 0) -> BendingModel | None:
    """Bending of the teeth, where loaded ones are up to so many pitches apart; None if the scene asks for none."""
    if scene.analysis.compliance == "contact":
        return None
    backs = scene.pair("negative" if pair.sense > 0 else "positive")
    bores = getattr(scene.pinion, BORE), getattr(scene.wheel, BORE)
    forms = tooth_forms(scene.mesh())
    return tooth_compliance(forms, pair, backs, bore_diameters=bores, neighbours=max(neighbours, 1))


def _warn_of_accuracy(pair: GearPair, grid: GridChoice, contacts: Contacts) -> None:
    """One AccuracyWarning for each reason to doubt, with the number of maps it concerns."""
    solved = [loaded for rows in contacts for row in rows for loaded in row if loaded is not None]
    reasons: dict[str, int] = {}
    for loaded in solved:
        for reason in _accuracy_warnings(pair, grid, loaded):
            reasons[reason] = reasons.get(reason, 0) + 1
    alone = len(contacts) == 1 and all(len(row) == 1 for row in contacts[0])
    what = "positions" if alone else "pressure maps"
    for reason, count in reasons.items():
        warnings.warn(f"{reason} (at {count} of {len(solved)} {what})", AccuracyWarning, stacklevel=3)


def _warn_of_reach(pair: GearPair, carried: Carried) -> None:
    """An AccuracyWarning if the deflection is more than the gap within which tooth pairs are looked for."""
    deflection = float(np.nanmax(carried.rotation, initial=0.0)) * pair.base_radii[1]
    if deflection > REACH * pair.module:
        warnings.warn(
            f"the load moves the flanks towards each other by up to {deflection:.3g} mm, more than {REACH:g} modules: "
            "tooth pairs that are further apart without load are not looked for",
            AccuracyWarning,
            stacklevel=3,
        )


def _accuracy_warnings(pair: GearPair, grid: GridChoice, loaded: LoadedContact) -> list[str]:
    solution = loaded.solution
    found = []
    if loaded.at_edge:
        edge = "the contact reaches an edge of a flank: Hertz does not hold, and pressure there grows with the grid"
        found.append(edge + ("" if grid.free_edges else "; ends that yield are left out (analysis.free_edges)"))
        oblique = oblique_ends(pair, loaded.contact, loaded.separation) if grid.free_edges else ()
        found += [f"the {end} is oblique to the contact and taken for that of a half-space" for end in oblique]
    if loaded.at_relief_start:
        found.append("the contact lies across the start of a linear relief: its peak pressure grows with the grid")
    smooth = not (loaded.at_edge or loaded.at_relief_start)
    if grid.cells is None and smooth and solution.error_estimate.peak_pressure > grid.accuracy:
        found.append(f"the estimated error stays above the accuracy of {grid.accuracy:g}")
    if solution.reaches_border:
        found.append("the contact reaches the box")
    if solution.load > 0.0 and solution.cells_across[0] < 8:
        found.append("fewer than 8 cells lie across the contact")
    if 0.5 * loaded.extent[0] > THICKEST_CONTACT * pair.module:
        found.append("the contact is so wide that the tooth is no half-space")
    return found


def _mesh_cycle(scene: Scene, pair: GearPair, carried: Carried) -> MeshCycle:
    contacts = _pair_contacts(pair, carried)
    path, highest = carried.path, contacts.highest

    def squeeze(values: Array) -> Array:
        return values if len(carried.torque) > 1 else values[0]

    lengths = 1e3 * pair.base_radii[0] * pair.base_radii[1] * pair.face_width
    with np.errstate(divide="ignore", invalid="ignore"):
        secant = np.where(carried.rotation > 0.0, carried.torque[:, None] / carried.rotation, math.nan)
    return MeshCycle(
        title=scene.title,
        scene_toml=scene.to_toml(),
        version=version("loaded_tca"),
        path=path,
        torque=carried.torque,
        pairs=carried.pairs,
        load_share=squeeze(np.array(carried.share)),
        maps=tuple(
            tuple(row[column] for row, column in zip(rows, columns, strict=True))
            for rows, columns in zip(contacts.maps, highest.tolist(), strict=True)
        ),
        wheel_base_radius=pair.base_radii[1],
        face_width=pair.face_width,
        max_pressure=math.nan if pair.max_pressure is None else pair.max_pressure,
        transmission_error=squeeze(path.transmission_error - pair.driving * carried.rotation),
        mesh_stiffness=squeeze(carried.torque_rate / lengths),
        secant_stiffness=squeeze(secant / lengths),
        pair_contacts=contacts if scene.analysis.load_sharing else None,
        **{name: squeeze(contacts.at_position(name)) for name in NUMBERS},
    )


def _pair_contacts(pair: GearPair, carried: Carried) -> PairContacts:
    numbers = [[[_numbers(pair, loaded) for loaded in row] for row in rows] for rows in carried.contacts]
    names = next(entry for rows in numbers for row in rows for entry in row if entry)

    def table(name: str) -> Array:
        missing = type(names[name])() if not isinstance(names[name], float) else math.nan
        return np.array([[[entry.get(name, missing) for entry in row] for row in rows] for rows in numbers])

    tables = {name: table(name) for name in names}
    apart = np.isnan(tables["approach"])
    tables["deflection"] = np.where(apart, math.nan, carried.tooth_deflection)
    tables["normal_force"] = np.where(apart & ~np.isnan(carried.share), 0.0, tables["normal_force"])
    maps = tuple(tuple(tuple(_pressure_map(one) for one in row) for row in rows) for rows in carried.contacts)
    return PairContacts(**tables, pairs=carried.pairs, paths=carried.paths, maps=maps)


def _pressure_map(loaded: LoadedContact | None) -> PressureMap | None:
    if loaded is None:
        return None
    grid, solution = loaded.separation, loaded.solution
    return PressureMap(grid.x, grid.y, grid.spacing, solution.pressure, solution.gap, grid.origin, grid.axes)


def _numbers(pair: GearPair, loaded: LoadedContact | None) -> dict[str, float | bool | int]:
    """The numbers of one pressure map, by the names of the fields of ContactNumbers."""
    if loaded is None:
        return {}
    solution, hertz = loaded.solution, loaded.hertz
    width, length = loaded.extent
    peak_radius, peak_axial = loaded.peak_place
    longest = _longest(pair, loaded)
    return {
        "normal_force": solution.load,
        "peak_pressure": loaded.peak_pressure,
        "central_pressure": loaded.central_pressure,
        "peak_radius": peak_radius,
        "peak_axial": peak_axial,
        "hertz_pressure": hertz.max_pressure if hertz else math.nan,
        "hertz_semi_minor": hertz.semi_minor if hertz else math.nan,
        "hertz_semi_major": hertz.semi_major if hertz else math.nan,
        "contact_width": width,
        "contact_length": min(length, longest),
        "line_load": loaded.line_load,
        "face_load_factor": loaded.line_load * longest / solution.load if solution.load > 0.0 else math.nan,
        "approach": loaded.contact_deformation,
        "on_edge": loaded.at_edge,
        "at_relief_start": loaded.at_relief_start,
        "cells_across": solution.pressure.shape[0],
        "cells_along": solution.pressure.shape[1],
        "iterations": solution.iterations,
        "residual": solution.residual,
    }


def _longest(pair: GearPair, loaded: LoadedContact) -> float:
    """Length over which the face reaches in the direction of the contact [mm]."""
    slope = abs(float(loaded.separation.axes[1] @ heelwards(pair, loaded.contact)))
    return pair.face_width / slope if slope > 0.0 else math.inf
