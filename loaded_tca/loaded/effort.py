"""What an analysis takes, time and memory, estimated before it starts."""

from __future__ import annotations

import math
from dataclasses import dataclass

from loaded_tca.compliance import default_density
from loaded_tca.contact.adaptive import MOST_CELLS
from loaded_tca.contact.checks import BYTES_PER_CELL, machine_memory
from loaded_tca.scene import Scene

SECONDS_PER_CONTACT, SECONDS_PER_CELL = 0.01, 4e-6
"""Of a contact between half-spaces, measured on the example scenes on one thread of a desktop machine."""
BENDING, FREE_EDGES = 2.0, 1.3
"""Factors of that time where teeth bend and where edges are free; measured."""
TEETH_SECONDS, TEETH_BYTES = 3.0, 400e6
"""Of the finite element models of both gears; measured."""
ROOT_SECONDS, ROOT_BYTES = 0.5, 75e6
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
        text = f"{contacts} of {self.cells} cells: roughly {rounded(self.seconds)} s, {rounded(self.gibibytes)} GiB"
        return text if self.fits else f"{text}; the machine has {rounded(machine_memory() / 2**30)} GiB"


def rounded(value: float) -> str:
    """Two digits, without an exponent up to a million.

    Examples
    --------
    >>> rounded(1234.5), rounded(0.0123)
    ('1200', '0.012')
    """
    return f"{float(f'{value:.2g}'):g}"


def expected_effort(scene: Scene) -> Effort:
    """Estimate what an analysis takes from the number of its contacts and their cells.

    Where ``analysis.cells`` is given, the time is right within a factor of about three, the memory within one and a
    half. An accuracy may need several times as many cells as assumed, or fewer.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Effort
    """
    wanted = scene.analysis
    contacts = wanted.positions * len(scene.torques) * (2 if wanted.load_sharing else 1)
    if wanted.cells is None:
        cells = round(min(max(CELLS_TIMES_ACCURACY / wanted.accuracy, FEWEST_CELLS), MOST_CELLS**2))
    else:
        cells = math.prod(wanted.cells)
    seconds = contacts * (SECONDS_PER_CONTACT + SECONDS_PER_CELL * cells)
    memory = PROGRAMME_BYTES + cells * (BYTES_PER_CELL + contacts * KEPT_BYTES_PER_CELL)
    if wanted.free_edges:
        seconds *= FREE_EDGES
    if wanted.compliance != "contact":
        seconds, memory = BENDING * seconds + TEETH_SECONDS, memory + TEETH_BYTES
    if wanted.root_stress:
        pair = scene.pair()
        layers = [default_density(gear).lengthwise for gear in (pair.pinion, pair.wheel)]
        seconds, memory = seconds + ROOT_SECONDS * sum(layers), memory + ROOT_BYTES * max(layers)  # one after the other
    return Effort(contacts, cells, seconds, memory, certain=wanted.cells is not None)
