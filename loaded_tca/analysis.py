"""The whole analysis in one function: from a scene to the loaded contact over the positions of a pitch."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.compliance import RootStress, model_of, require_teeth, root_stress_model, way_out_told
from loaded_tca.compliance.model import SumOfParts, held_bodies, with_enough_teeth
from loaded_tca.edges.rounded import PeakAtEdge, pressures_at_rounded_edges
from loaded_tca.effort import expected_effort
from loaded_tca.errors import give_accuracy_warning, named, noted_accuracy_warnings, require
from loaded_tca.loaded.cycle import Carried, Progress, carried_by_all, carried_by_one, farthest_apart
from loaded_tca.loaded.moved_gears import at_rest, pitches_apart
from loaded_tca.loaded.supported import CarriedOnSupports, SupportedCycle, all_torques
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.collect import mesh_cycle
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.supports import warn_of_supports
from loaded_tca.results.warnings import warn_of_accuracy, warn_of_gears
from loaded_tca.scene import Scene
from loaded_tca.supports import support_compliance
from loaded_tca.threads import one_blas_thread
from loaded_tca.unloaded import ContactPath, MeshPath, trace_contact, trace_teeth

THICKEST_LAYER = 1.2
"""Of elements across a face, over the module: from there on root stress under a short contact is 2 % too low and more
(a load of 2.7 modules: 2.5 % on 1.3 modules, 9 % on 1.9, 16 % on 2.6)."""


@checked
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
    with one_blas_thread(), noted_accuracy_warnings() as warned:
        pair, wanted, effort = scene.pair(), scene.analysis, expected_effort(scene)
        require((not effort.is_refused, f"analysis.cells: {wanted.cells}: {effort}"))
        warn_of_gears(scene, pair)
        count, torques = wanted.positions, np.asarray(scene.torques)
        angles = np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, count) if count > 1 else np.zeros(1)
        grid = grid_of(scene)
        roots = roots_of(scene, pair)
        cycles: list[CarriedOnSupports] = []
        if scene.is_supported:
            carried, at_edges, cycles = _on_supports(scene, pair, angles, grid, progress)
            bending: SumOfParts | None = cycles[0].bending
        else:
            if wanted.load_sharing:
                mesh = trace_teeth(pair, angles)
                bending = model_of(scene, pair, farthest_apart(mesh))
                carried = carried_by_all(pair, mesh, torques, grid, bending, progress)
            else:
                path = trace_contact(pair, angles)
                bending = model_of(scene, pair, 1)
                carried = carried_by_one(pair, path, torques, grid, bending, progress)
            at_edges = pressures_at_rounded_edges(
                pair, carried, bending, free_edges=wanted.free_edges, every=wanted.edge_pressures == "all"
            )
        turned = np.concatenate([one.carried.rotation for one in cycles]) if cycles else carried.rotation
        warn_of_accuracy(
            pair,
            grid,
            replace(carried, rotation=turned),
            at_edges,
            mesh_rate=np.stack([one.mesh_rate for one in cycles]) if cycles else carried.torque_rate,
            load_sharing=wanted.load_sharing,
            bodies=held_bodies(scene, pair),
        )
        if cycles:
            warn_of_supports(pair, cycles, torques.tolist())
        date = datetime.now(UTC).isoformat(timespec="seconds")
        coupled = 0 if bending is None else bending.coupled_pitches
        return mesh_cycle(
            scene, pair, carried, at_edges, roots, cycles, coupled_pitches=coupled, warnings=warned, date=date
        )


def _on_supports(
    scene: Scene, pair: GearPair, angles: Array, grid: GridChoice, progress: Progress | None
) -> tuple[Carried, dict[tuple[int, int, int], PeakAtEdge], list[CarriedOnSupports]]:
    """What the tooth pairs carry on supports that give way, pressures at rounded edges, and both torque by torque."""
    wanted = scene.analysis
    supports = support_compliance(scene, pair)
    assert supports is not None
    unmoved: MeshPath | ContactPath
    if wanted.load_sharing:
        unmoved = trace_teeth(at_rest(supports), angles)
        apart = pitches_apart(supports, scene.torques, unmoved)
    else:
        unmoved, apart = trace_contact(at_rest(supports), angles), 1

    def under(apart: int) -> list[CarriedOnSupports]:
        bending = model_of(scene, pair, apart)
        assert bending is not None
        supported = SupportedCycle(pair, bending, angles, grid, load_sharing=wanted.load_sharing)
        return supported.under(scene.torques, progress)

    cycles = with_enough_teeth(apart, under, lambda made: max(one.pitches_apart for one in made))
    at_edges: dict[tuple[int, int, int], PeakAtEdge] = {}
    for t, one in enumerate(cycles):
        peaks = pressures_at_rounded_edges(
            one.pair, one.carried, one.bending, free_edges=wanted.free_edges, every=wanted.edge_pressures == "all"
        )
        at_edges |= {(t, n, int(one.carried.pairs[k])): peak for (_, n, k), peak in peaks.items()}
    carried = all_torques(unmoved, cycles)
    column = {number: k for k, number in enumerate(carried.pairs.tolist())}
    return carried, {(t, n, column[number]): peak for (t, n, number), peak in at_edges.items()}, cycles


def grid_of(scene: Scene) -> GridChoice:
    """How finely a scene asks for its contacts."""
    wanted = scene.analysis
    return GridChoice(
        cells=None if wanted.cells is None else (wanted.cells[0], wanted.cells[1]),
        accuracy=wanted.accuracy,
        tolerance=wanted.tolerance,
        free_edges=wanted.free_edges,
    )


def roots_of(scene: Scene, pair: GearPair) -> tuple[RootStress, ...]:
    """Root stress of unit forces on pinion and wheel; nothing if the scene does not ask for it."""
    if not scene.analysis.root_stress:
        return ()
    require_teeth(pair, scene.analysis.without_bodies)
    roots = []
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        with way_out_told("analysis.root_stress = false"), named(name):
            roots.append(root_stress_model(gear))
        if (layer := roots[-1].layer / pair.module) > THICKEST_LAYER:
            give_accuracy_warning(kinds.FACE_ELEMENTS.sentence(gear=name, width=layer))
    return tuple(roots)
