"""The whole analysis in one function: from a scene to the loaded contact over the positions of a pitch."""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.compliance import RootStress, model_of, require_teeth, root_stress_model, way_out_told
from loaded_tca.compliance.torsion import body_torsion
from loaded_tca.errors import give_accuracy_warning, named, noted_accuracy_warnings, require
from loaded_tca.loaded.cycle import Progress, carried_by_all, carried_by_one, farthest_apart
from loaded_tca.loaded.effort import expected_effort
from loaded_tca.loaded.rounded_edges import pressures_at_rounded_edges
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.collect import mesh_cycle
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.warnings import warn_of_accuracy, warn_of_gears
from loaded_tca.scene import Scene
from loaded_tca.threads import one_blas_thread
from loaded_tca.unloaded import trace_contact, trace_teeth

THICKEST_LAYER = 1.2
"""Of elements across a face, over the module: from there on root stress under a short contact is 2 % too low and more
(a load of 2.7 modules: 2.5 % on 1.3 modules, 9 % on 1.9, 16 % on 2.6)."""


def analyse(scene: Scene, progress: Progress | None = None) -> MeshCycle:
    """Analyse a scene: at every position of a pitch one tooth pair carries the load, or all in contact share it.

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
        If the scene's parts do not fit each other, whole gears cannot turn, the flanks are never in contact, or the
        grids or models of root stress that it asks for exceed the memory of the machine.
    ConvergenceError
        If a contact, or the balance of the tooth pairs, is not solved to the tolerance.

    Warns
    -----
    AccuracyWarning
        If whole gears jam, a tooth is pointed, a rim is thin, the contact reaches an edge of a flank, or the model is
        at another limit.
    """
    # products of small matrices: on several threads of BLAS they take longer, and on some processors round otherwise
    with one_blas_thread():
        with noted_accuracy_warnings() as told:
            pair, wanted, effort = scene.pair(), scene.analysis, expected_effort(scene)
            require((not effort.is_refused, f"analysis.cells: {wanted.cells}: {effort}"))
            warn_of_gears(scene, pair)
            count, torques = wanted.positions, np.asarray(scene.torques)
            angles = np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, count) if count > 1 else np.zeros(1)
            grid = GridChoice(
                cells=None if wanted.cells is None else (wanted.cells[0], wanted.cells[1]),
                accuracy=wanted.accuracy,
                tolerance=wanted.tolerance,
                free_edges=wanted.free_edges,
            )
            roots = roots_of(scene, pair)
            if wanted.load_sharing:
                mesh = trace_teeth(pair, angles)
                bending = model_of(scene, pair, farthest_apart(mesh))
                carried = carried_by_all(pair, mesh, torques, grid, bending, progress)
            else:
                path = trace_contact(pair, angles)
                bending = model_of(scene, pair, 1)
                carried = carried_by_one(pair, path, torques, grid, bending, progress)
            torsion = 0.0 if bending is None else sum(body_torsion(pair))
            at_edges = pressures_at_rounded_edges(
                pair, carried, bending, free_edges=wanted.free_edges, every=wanted.edge_pressures == "all"
            )
            warn_of_accuracy(pair, grid, carried, at_edges, load_sharing=wanted.load_sharing, body_torsion=torsion)
        date = datetime.now(UTC).isoformat(timespec="seconds")
        return mesh_cycle(scene, pair, carried, at_edges, roots, warnings=told, date=date)


def roots_of(scene: Scene, pair: GearPair) -> tuple[RootStress, ...]:
    """Root stress of unit forces on pinion and wheel; nothing if the scene does not ask for it."""
    if not scene.analysis.root_stress:
        return ()
    require_teeth(pair, scene.analysis.without_bodies)
    found = []
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        with way_out_told("analysis.root_stress = false"), named(name):
            found.append(root_stress_model(gear))
        if (layer := found[-1].layer / pair.module) > THICKEST_LAYER:
            give_accuracy_warning(kinds.FACE_ELEMENTS.sentence(gear=name, width=layer))
    return tuple(found)
