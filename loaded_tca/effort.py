"""What an analysis takes, time and memory, estimated before it starts.

The time is that of its parts on one machine, by the constants below, times what :mod:`loaded_tca.machine_speed` finds
of this one, and of as many jobs as are done at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from loaded_tca.compliance.teeth import layers_across
from loaded_tca.contact.checks import BYTES_PER_CELL, MOST_CELLS, machine_memory
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.machine_speed import machine_speed
from loaded_tca.plain import plain
from loaded_tca.threads import jobs

if TYPE_CHECKING:
    from loaded_tca.scene import Scene

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
TEETH_SECONDS, TEETH_EXPONENT, TEETH_BYTES = 7.0e-3, 1.5, 400e6
"""Of the finite element models of both gears: the time for the layers of elements across both faces."""
IMPORT_SECONDS, FILES_SECONDS, PICTURE_SECONDS = 1.15, 0.15, 0.11
"""Of the command: what it imports, result and tables, and each picture."""
APART_SECONDS = 1.0
"""Of a helper, before each model of root stress: a process is started and imports what it needs."""
ROOT_SECONDS, ROOT_BYTES = 0.15, 39e6
"""Of a model of root stress for each layer of elements across the face, of which wide faces have more; measured with 6
to 24 layers: the memory is within a quarter of what the model itself tells, the time within a factor of two."""
MOST_OF_MEMORY = 0.5
"""Part of the machine's memory that models made at once may take; beyond it they are made one by one."""
PROGRAMME_BYTES, KEPT_BYTES_PER_CELL = 150e6, 150.0
"""Of the libraries, and of each cell until the result is written; measured with 1 to 15 contacts of 512 x 512 cells."""
CELLS_TIMES_ACCURACY, FEWEST_CELLS = 1.7, 1024
"""Cells that an accuracy takes, and those of the coarsest grid that can be the last; measured from 1e-2 to 1e-5."""


OF_ALL, OF_SHARED = 5, 9
"""Pictures of every result, about, and those more where tooth pairs share the load."""


@dataclass(frozen=True)
class Effort:
    """What an analysis takes, roughly.

    Attributes
    ----------
    contacts : int
        Contact problems: positions times torques, twice as many where tooth pairs share the load.
    cells : int
        Of the grid of each.
    states : float [s]
        On one thread of the machine of the constants: of all but finite element models.
    teeth, roots : tuple of float [s]
        Of the models of teeth, and of root stress, of pinion and wheel; empty: without.
    memory : float [bytes]
    certain : bool
        Whether the cells are given: for an accuracy they may be fewer.
    jobs : int
        Works done at once: as many as asked for, or one where models of all would take too much of the memory.
    around : float [s]
        What the command does besides: imports, files and pictures.
    """

    contacts: int
    cells: int
    states: float
    teeth: tuple[float, ...]
    roots: tuple[float, ...]
    memory: float
    certain: bool
    jobs: int = 1
    around: float = 0.0

    @property
    def seconds(self) -> float:
        """Time [s] on idle cores of this machine: of what is done at once that which ends last.

        As ``side_by_side`` shares it; where other programmes have the cores it takes as much longer as they leave less.
        """
        speed, helpers = machine_speed(), max(0, min(self.jobs, 1 + len(self.roots)) - 1)
        teeth = max(self.teeth, default=0.0) if self.jobs > 1 and not helpers else sum(self.teeth)
        ends = [float(speed.states) * self.states + float(speed.models) * teeth, *([0.0] * helpers)]
        for model in self.roots:
            first = ends.index(min(ends))
            ends[first] += float(speed.models) * model + (float(speed.states) * APART_SECONDS if first else 0.0)
        return max(ends) + float(speed.states) * self.around

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
        text = f"{contacts} of {self.cells} cells: roughly {plain(self.seconds, 2)} s on idle cores, "
        text += f"{plain(self.gibibytes, 2)} GiB"
        return text if self.fits else f"{text}; the machine has {plain(machine_memory() / 2**30, 2)} GiB"


def expected_effort(scene: Scene) -> Effort:
    """Estimate what an analysis takes from the number of its contacts and their cells.

    Nothing is computed but the gears. The time is that of an analysis by as many jobs as are allowed, without kept
    models of teeth; contacts that end at reliefs or lie askew
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
    teeth, roots, at_once = tuple[float, ...](), tuple[float, ...](), jobs()
    if wanted.root_stress or wanted.teeth_bend:
        layers = _layers(scene)
        if wanted.teeth_bend:
            whole = TEETH_SECONDS * sum(layers) ** TEETH_EXPONENT
            teeth, memory = tuple(whole * some / sum(layers) for some in layers), memory + TEETH_BYTES
        if wanted.root_stress:
            roots = tuple(ROOT_SECONDS * some for some in layers)
            one_by_one, together = (memory + ROOT_BYTES * some for some in (max(layers), sum(layers)))
            at_once = at_once if together <= MOST_OF_MEMORY * machine_memory() else 1
            memory = one_by_one if at_once == 1 else together
    return Effort(contacts, cells, seconds, teeth, roots, memory, certain=wanted.cells is not None, jobs=at_once)


def expected_run_effort(scene: Scene) -> Effort:
    """Estimate what the command ``run`` takes: as :func:`expected_effort`, with imports, files and pictures."""
    wanted, torques = scene.analysis, len(scene.torques)
    shared = OF_SHARED if wanted.load_sharing and wanted.positions > 1 else 0
    pictures = OF_ALL + shared + (2 + (torques > 1) if wanted.root_stress else 0)
    around = IMPORT_SECONDS + FILES_SECONDS + PICTURE_SECONDS * pictures
    return replace(expected_effort(scene), around=around)


def _layers(scene: Scene) -> list[int]:
    """Layers of elements across the faces of pinion and wheel; one of a gear without whole teeth, which is refused."""
    pair, layers = scene.pair(), []
    for gear in (pair.pinion, pair.wheel):
        try:
            layers.append(layers_across(gear))
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
