"""Projected, preconditioned conjugate gradients for one grid of a contact problem.

Dimensionless inside: lengths over the reference approach, pressures p dx/(E* reference).
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from loaded_tca.contact.convolution import Convolution, Preconditioner

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Grid:
    """A contact problem on one grid: minimise p.Kp/2 + h.p over 0 <= p <= cap.

    Parameters
    ----------
    gap : (nx, ny) array
        Gap h before loading, its smallest value near 0, a huge value where there is no material.
    aspect : float
        dy/dx.
    total : float or None
        Sum of the pressures; None if ``approach`` is prescribed.
    approach : float
        Prescribed approach; ignored if the total is given.
    cap : float
        Largest pressure, infinity if there is none.
    """

    gap: Array
    aspect: float
    total: float | None
    approach: float
    cap: float


@dataclass
class Iterate:
    """Pressure p and displacement u = Kp of a grid, and what follows from them.

    ``excess`` is u + h - approach (the gap of the deformed bodies), ``free`` the cells that may move: those
    strictly between the bounds, and those at a bound that the excess pushes off it.
    """

    pressure: Array
    displacement: Array
    excess: Array
    free: Mask
    approach: float = 0.0
    residual: float = np.inf
    iterations: int = 0


class Descent:
    """Projected conjugate gradients on a grid; :meth:`run` goes on from where it stands."""

    def __init__(self, grid: Grid, pressure: Array, threads: int | None) -> None:
        shape = grid.gap.shape
        self.grid = grid
        self.exact = Convolution(shape, grid.aspect, threads=threads)
        self.fast = Convolution(shape, grid.aspect, dtype="float32", threads=threads)
        self.precondition = Preconditioner(shape, grid.aspect, threads)
        self.at = Iterate(pressure, np.empty(shape), np.empty(shape), np.zeros(shape, dtype=bool))
        self._direction = np.zeros(shape, dtype=np.float32)
        self._previous: tuple[NDArray[np.float32], NDArray[np.float32]] | None = None
