r"""Forces at the centres of pressure of the slices: what teeth bend more as these move across the contact.

The slices of a contact load the teeth at x_c(y), the centres of their pressure, which depend on the forces f_c of the
cells. With the compliance C of the slices, R its derivative by the place of the slice that is displaced, and F the
forces on the slices,

.. math:: d(C F)_i = \Bigl(\sum_k R_{ik} F_k\Bigr) dx_i + \sum_j R_{ji} F_j\,dx_j, \qquad
          dx_j = \sum_{c \in j} (x_c - x_j)\,df_c / F_j .
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.model import BendingModel
from loaded_tca.loaded.loaded_grid import LoadedGrid, block_diagonal
from loaded_tca.pairs.gear_pair import ContactGrid
from loaded_tca.separation import Separation

Displacement = Callable[[ContactGrid], Array]
STEP = 1e-2
"""By which the line of the forces is shifted to see how the bending changes, over the width of its grid."""


@dataclass(frozen=True, eq=False)
class LoadedSlices:
    """Slices of a grid that carry forces, as :class:`loaded_tca.pairs.gear_pair.ContactGrid` has them."""

    y: Array
    origin: Array
    axes: Array
    force_line: Array

    @classmethod
    def of(cls, grid: Separation, loaded: Indices, shift: float = 0.0) -> LoadedSlices:
        """Those with the numbers ``loaded``, shifted across the contact [mm]."""
        return cls(grid.y[loaded], grid.origin, grid.axes, grid.force_line[loaded] + shift)


def bending_by_shift(
    grids: Sequence[LoadedGrid], state: Indices, bending: BendingModel, displacement: Displacement | None = None
) -> scipy.sparse.csr_array:
    """Deflection of the slices of all grids, in one row, by the shift of each across its contact, the forces held.

    Parameters
    ----------
    grids : sequence of LoadedGrid
        With the compliance of their slices by the same model; without one where that is zero.
    state : (grids,) array
        That each belongs to.
    bending : BendingModel
    displacement : callable, optional
        Displacement of the slices of a grid (ny,) [mm] beside what the forces do; default: none.

    Returns
    -------
    (slices, slices) sparse array
        Of one state only the slices that carry forces depend on each other.
    """
    in_states = np.split(np.arange(len(grids)), np.flatnonzero(np.diff(state)) + 1)
    return block_diagonal([_of_state([grids[i] for i in numbers], bending, displacement) for numbers in in_states])


def _of_state(grids: Sequence[LoadedGrid], bending: BendingModel, displacement: Displacement | None) -> Array:
    """The same of one state, (slices, slices)."""
    forces = [grid.slice_force for grid in grids]
    first = np.cumsum([0, *(force.size for force in forces)])
    loaded = [np.flatnonzero(force) for force in forces]
    steps = [STEP * grid.separation.spacing[0] * len(grid.separation.x) for grid in grids]
    held = [(grid.number, LoadedSlices.of(grid.separation, own)) for grid, own in zip(grids, loaded, strict=True)]
    beyond = [
        (grid.number, LoadedSlices.of(grid.separation, own, step))
        for grid, own, step in zip(grids, loaded, steps, strict=True)
    ]
    by_shift = np.zeros((first[-1], first[-1]))
    for i, j in product(range(len(grids)), repeat=2):
        if i == j:
            by_place, before = bending.within(grids[i].number, beyond[i][1], held[i][1]), grids[i].bending
            if before is not None:
                by_place = by_place - before[np.ix_(loaded[i], loaded[i])]
        else:
            by_place = bending.between(beyond[i], held[j]) - bending.between(held[i], held[j])
        by_place = by_place / steps[i]
        at, under = first[i] + loaded[i], first[j] + loaded[j]
        by_shift[at, at] += by_place @ forces[j][loaded[j]]
        by_shift[np.ix_(under, at)] += by_place.T * forces[i][loaded[i]]
        if i == j and displacement is not None:
            by_shift[at, at] += (displacement(beyond[i][1]) - displacement(held[i][1])) / steps[i]
    return by_shift
