"""The whole analysis in one function: from a scene to the loaded contact over the positions of a pitch.

What an analysis takes, time and memory, estimated before it starts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.compliance import RootStress, default_density, model_of, require_teeth, root_stress_model, way_out_told
from loaded_tca.compliance.model import SumOfParts, held_bodies, with_enough_teeth
from loaded_tca.contact.adaptive import MOST_CELLS
from loaded_tca.contact.checks import BYTES_PER_CELL, machine_memory
from loaded_tca.errors import GeometryError, InputError, give_accuracy_warning, named, noted_accuracy_warnings, require
from loaded_tca.loaded.cycle import Carried, Progress, carried_by_all, carried_by_one, farthest_apart
from loaded_tca.loaded.moved_gears import at_rest, pitches_apart
from loaded_tca.loaded.rounded_edges import PeakAtEdge, pressures_at_rounded_edges
from loaded_tca.loaded.supported import CarriedOnSupports, SupportedCycle, all_torques
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.results.collect import mesh_cycle
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.supports import warn_of_supports
from loaded_tca.results.warnings import warn_of_accuracy, warn_of_gears
from loaded_tca.scene import Scene
from loaded_tca.supports import support_compliance
from loaded_tca.threads import one_blas_thread
from loaded_tca.unloaded import ContactPath, MeshPath, trace_contact, trace_teeth

START_SECONDS, STATE_SECONDS, SHARED_SECONDS, SHARED_EXPONENT = 0.4, 0.015, 2.2e-3, 3.2
"""Of the first analysis of a process; of each position under each torque where teeth bend, and how that grows with the
tooth pairs in contact. These and what follows: processor time on one thread of a server's core, of the scenes of
``validation.loaded.user_scenes``."""
FLANKS_ALONE, FREE_EDGES, CAPPED, ROUNDED, ALL_ROUNDED = 0.5, 1.15, 1.5, 2.2, 3.5
"""Factors of the time of a state: where teeth do not bend, edges are free, pressure is capped, edges are rounded."""
USUAL_CELLS, OF_ACCURACY = 4400.0, 0.35
"""Cells that take as long as what does not depend on them, and the exponent of 1e-2 over an accuracy."""
SUPPORT_STATES = 6
"""States of a torque that take as long as the way to where supports let the gears stand; of linear bearings."""
TEETH_SECONDS, TEETH_EXPONENT, TEETH_BYTES = 7.5e-3, 1.5, 400e6
"""Of the finite element models of both gears: the time for the layers of elements across both faces."""
ROOT_SECONDS, ROOT_BYTES = 0.23, 75e6
"""Of a model of root stress for each layer of elements across the face, of which wide faces have more; measured with 6
to 24 layers: the memory is within a quarter of what the model itself tells, the time within a factor of two."""
PROGRAMME_BYTES, KEPT_BYTES_PER_CELL = 150e6, 150.0
"""Of the libraries, and of each cell until the result is written; measured with 1 to 15 contacts of 512 x 512 cells."""
CELLS_TIMES_ACCURACY, FEWEST_CELLS = 1.7, 1024
"""Cells that an accuracy takes, and those of the coarsest grid that can be the last; measured from 1e-2 to 1e-5."""


@dataclass(frozen=True)
class Effort:
    """What an analysis takes, roughly.

    Attributes
    ----------
    contacts : int
        Contact problems: positions times torques, twice as many where tooth pairs share the load.
    cells : int
        Of the grid of each.
    seconds : float [s]
    memory : float [bytes]
    certain : bool
        Whether the cells are given: for an accuracy they may be fewer.
    """

    contacts: int
    cells: int
    seconds: float
    memory: float
    certain: bool

    @property
    def gibibytes(self) -> float:
        """The memory in GiB."""
        return self.memory / 2**30

    @property
    def fits(self) -> bool:
        """Whether the machine has as much memory."""
        return self.memory <= machine_memory()

    @property
    def is_refused(self) -> bool:
        """Whether an analysis does not start: its memory does exceed that of the machine."""
        return self.certain and not self.fits

    def __str__(self) -> str:
        contacts = f"{self.contacts} contact" + "s" * (self.contacts > 1)
        text = f"{contacts} of {self.cells} cells: roughly {plain(self.seconds, 2)} s, {plain(self.gibibytes, 2)} GiB"
        return text if self.fits else f"{text}; the machine has {plain(machine_memory() / 2**30, 2)} GiB"


def expected_effort(scene: Scene) -> Effort:
    """Estimate what an analysis takes from the number of its contacts and their cells.

    Nothing is computed but the gears. The time is that of one processor without kept models of teeth, within a factor
    of one and a half of that of the scenes of ``docs/studies/how_long.md``; contacts that end at reliefs or lie askew
    may need many more cells for an accuracy beyond 1e-2 than assumed. The memory is right within one and a half where
    ``analysis.cells`` is given.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Effort
    """
    wanted = scene.analysis
    states = wanted.positions * len(scene.torques)
    contacts = states * (2 if wanted.load_sharing else 1)
    pairs = scene.pairs_in_contact if wanted.load_sharing else 1.0
    asked = states + (SUPPORT_STATES * len(scene.torques) if scene.is_supported else 0)
    seconds = asked * (STATE_SECONDS + SHARED_SECONDS * pairs**SHARED_EXPONENT) * _factor(scene)
    if wanted.cells is None:
        cells = round(min(max(CELLS_TIMES_ACCURACY / wanted.accuracy, FEWEST_CELLS), MOST_CELLS**2))
        seconds *= max(1.0, 1e-2 / wanted.accuracy) ** OF_ACCURACY
    else:
        cells = math.prod(wanted.cells)
        seconds *= 0.7 + cells / USUAL_CELLS
    seconds += START_SECONDS
    memory = PROGRAMME_BYTES + cells * (BYTES_PER_CELL + contacts * KEPT_BYTES_PER_CELL)
    if wanted.root_stress or wanted.teeth_bend:
        layers = _layers(scene)
        if wanted.teeth_bend:
            seconds, memory = seconds + TEETH_SECONDS * sum(layers) ** TEETH_EXPONENT, memory + TEETH_BYTES
        if wanted.root_stress:
            seconds, memory = seconds + ROOT_SECONDS * sum(layers), memory + ROOT_BYTES * max(layers)  # one by one
    return Effort(contacts, cells, seconds, memory, certain=wanted.cells is not None)


def _layers(scene: Scene) -> list[int]:
    """Layers of elements across the faces of pinion and wheel; one of a gear without whole teeth, which is refused."""
    pair, layers = scene.pair(), []
    for gear in (pair.pinion, pair.wheel):
        try:
            layers.append(default_density(gear).lengthwise)
        except (InputError, GeometryError):
            layers.append(1)
    return layers


def _factor(scene: Scene) -> float:
    """Time of a state over that of sharp edges that are not free, of elastic flanks and of teeth that bend."""
    wanted, factor = scene.analysis, 1.0
    if not wanted.teeth_bend:
        factor *= FLANKS_ALONE
    if wanted.free_edges:
        factor *= FREE_EDGES
    if any(one.max_pressure_MPa is not None for one in scene.materials):
        factor *= CAPPED
    if any(one.tip_rounding_mm or one.side_rounding_mm for one in (scene.pinion, scene.wheel)):
        factor *= ALL_ROUNDED if wanted.edge_pressures == "all" else ROUNDED
    return factor


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
