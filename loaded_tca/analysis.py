"""The whole analysis in one function: from a scene to the loaded contact over the positions of a pitch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from typing import TYPE_CHECKING, Any, overload

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.compliance import RootStress, model_of, require_teeth, root_stress_model, way_out_told
from loaded_tca.compliance.model import held_bodies, with_enough_teeth
from loaded_tca.edges.arcs import arcs_in_cycle
from loaded_tca.edges.rounded import CellForces, PeakAtEdge, loads_along_contacts, pressures_at_rounded_edges
from loaded_tca.effort import expected_effort
from loaded_tca.errors import give_accuracy_warning, named, noted_accuracy_warnings, require
from loaded_tca.loaded.cycle import Progress
from loaded_tca.loaded.moved_gears import at_rest, pitches_apart
from loaded_tca.loaded.standing import GearsUnderTorques, StandingCycle, all_torques
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.collect import Place, mesh_cycle
from loaded_tca.results.gear_warnings import warn_of_gears
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.supports import warn_of_supports
from loaded_tca.results.warnings import warn_of_accuracy
from loaded_tca.scene import Scene
from loaded_tca.scene.build import arguments_by_keys
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.supports import support_compliance
from loaded_tca.threads import one_blas_thread, side_by_side, with_jobs
from loaded_tca.unloaded import ContactPath, MeshPath, trace_contact, trace_teeth

if TYPE_CHECKING:
    from loaded_tca.double_helical.result import DoubleHelicalResult

THICKEST_LAYER = 1.2
"""Of elements across a face, over the module: from there on root stress under a short contact is 2 % too low and more
(a load of 2.7 modules: 2.5 % on 1.3 modules, 9 % on 1.9, 16 % on 2.6)."""


@overload
def analyse(scene: DoubleHelicalScene, progress: Progress | None = None) -> DoubleHelicalResult: ...  # type: ignore[overload-overlap]
@overload
def analyse(scene: Scene, progress: Progress | None = None) -> MeshCycle: ...
@checked
def analyse(scene: Scene, progress: Progress | None = None) -> MeshCycle | DoubleHelicalResult:
    """Analyse a scene: at every position of a pitch one tooth pair carries the load, or all pairs in contact share it.

    Parameters
    ----------
    scene : Scene
    progress : callable, optional
        Called as ``progress(done, total)`` after every torque and position.

    Returns
    -------
    MeshCycle
        Of a double helical pair :class:`loaded_tca.double_helical.DoubleHelicalResult`, as
        :func:`loaded_tca.double_helical.analyse_double_helical` makes it: the mesh cycles of both halves.

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
    if isinstance(scene, DoubleHelicalScene):
        from loaded_tca.double_helical.analyse import analyse_double_helical

        return analyse_double_helical(scene, progress)
    # products of small matrices: on several threads of BLAS they take longer, and on some processors round otherwise
    with one_blas_thread(), noted_accuracy_warnings() as warned:
        pair, wanted, effort = scene.pair(), scene.analysis, expected_effort(scene)
        require((not effort.is_refused, f"analysis.cells: {wanted.cells}: {effort}"))
        warn_of_gears(scene, pair)
        grid = grid_of(scene)
        with with_jobs(effort.jobs):
            *roots, (unloaded, cycles) = side_by_side(
                *_root_models(scene, pair), partial(_solved_cycles, scene, pair, grid, progress)
            )
        carried = all_torques(unloaded, cycles)
        at_edges, on_columns = _at_rounded_edges(scene, carried.pairs.tolist(), cycles)
        warn_of_accuracy(
            pair,
            grid,
            replace(carried, rotation=np.concatenate([one.carried.rotation for one in cycles])),
            at_edges,
            mesh_rate=np.concatenate([one.mesh_rate for one in cycles]),
            load_sharing=wanted.load_sharing,
            bodies=held_bodies(scene, pair),
        )
        warn_of_supports(pair, cycles)
        date = datetime.now(UTC).isoformat(timespec="seconds")
        return mesh_cycle(scene, pair, carried, at_edges, on_columns, tuple(roots), cycles, warnings=warned, date=date)


def _solved_cycles(
    scene: Scene, pair: GearPair, grid: GridChoice, progress: Progress | None
) -> tuple[ContactPath | MeshPath, list[StandingCycle]]:
    """Unloaded contact over a pitch, and the mesh cycles under all torques."""
    wanted, torques = scene.analysis, np.asarray(scene.torques)
    count = wanted.positions
    angles = np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, count) if count > 1 else np.zeros(1)
    supports = support_compliance(scene, pair)
    unloaded = (trace_teeth if wanted.load_sharing else trace_contact)(at_rest(pair, supports), angles)
    apart = pitches_apart(pair, supports, scene.torques) if wanted.load_sharing else 1

    def solved(apart: int) -> list[StandingCycle]:
        bending = model_of(scene, pair, apart)
        gears = GearsUnderTorques(pair, bending, angles, grid, load_sharing=wanted.load_sharing, at_rest=unloaded)
        return gears.mesh_cycles(torques, progress)

    return unloaded, with_enough_teeth(apart, solved)


def _at_rounded_edges(
    scene: Scene, pairs: list[int], cycles: Sequence[StandingCycle]
) -> tuple[dict[Place, PeakAtEdge], dict[Place, tuple[CellForces, CellForces]]]:
    """Peaks at rounded edges by the indices of torque, position and tooth pair, whose numbers are in the row.

    And the loads along contacts that end there.
    """
    wanted, first = scene.analysis, 0
    peaks, loads = dict[Place, PeakAtEdge](), dict[Place, tuple[CellForces, CellForces]]()
    for one in cycles:
        gears, numbers = one.standing, one.carried.pairs.tolist()
        arcs = arcs_in_cycle(gears.pair, one.carried)
        solved = gears.pair, one.carried, gears.bending
        of_cycle = pressures_at_rounded_edges(
            *solved, arcs=arcs, free_edges=wanted.free_edges, every=wanted.edge_pressures == "all"
        )
        along = loads_along_contacts(*solved, arcs=arcs, free_edges=wanted.free_edges)
        peaks |= {(first + t, n, pairs.index(numbers[k])): peak for (t, n, k), peak in of_cycle.items()}
        loads |= {(first + t, n, pairs.index(numbers[k])): load for (t, n, k), load in along.items()}
        first += len(gears.torques)
    return peaks, loads


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
    return tuple(side_by_side(*_root_models(scene, pair)))


def _root_models(scene: Scene, pair: GearPair) -> list[Callable[[], Any]]:
    """Works that make the models of root stress of pinion and wheel; none if the scene does not ask for it."""
    if not scene.analysis.root_stress:
        return []
    with arguments_by_keys(type(scene)):
        require_teeth(pair, scene.analysis.without_bodies)
    return [partial(_root_model, pair, *one) for one in (("pinion", pair.pinion), ("wheel", pair.wheel))]


def _root_model(pair: GearPair, name: str, gear: Gear) -> RootStress:
    """Root stress of unit forces on one gear, called by its name."""
    with way_out_told("analysis.root_stress = false"), named(name):
        roots = root_stress_model(gear)
    if (layer := roots.layer / pair.module) > THICKEST_LAYER:
        give_accuracy_warning(kinds.FACE_ELEMENTS.sentence(gear=name, width=layer))
    return roots
