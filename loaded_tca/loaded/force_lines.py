r"""Forces at the centres of pressure of the slices: what teeth bend more as these move across the contact.

The slices of a contact load the teeth at x_c(y), the centres of their pressure, which depend on the forces f_c of the
cells. With the compliance C of the slices, R its derivative by the place of the slice that is displaced, and F the
forces on the slices,

.. math:: d(C F)_i = \Bigl(\sum_k R_{ik} F_k\Bigr) dx_i + \sum_j R_{ji} F_j\,dx_j, \qquad
          dx_j = \sum_{c \in j} (x_c - x_j)\,df_c / F_j .
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.model import BendingModel
from loaded_tca.loaded.sensitivity import LoadedGrid
from loaded_tca.separation import Separation

STEP = 1e-2
"""By which the line of the forces is shifted to see how the bending changes, over the width of its grid."""


@dataclass(frozen=True, eq=False)
class _Doubled:
    """Slices of a grid under load, and the same ones shifted across."""

    y: Array
    origin: Array
    axes: Array
    force_line: Array

    @classmethod
    def of(cls, grid: Separation, loaded: Indices, step: float) -> _Doubled:
        line = np.concatenate([grid.force_line[loaded], grid.force_line[loaded] + step])
        return cls(np.tile(grid.y[loaded], 2), grid.origin, grid.axes, line)


def bending_by_shift(grids: Sequence[LoadedGrid], state: Indices, bending: BendingModel) -> csr_array:
    """Deflection of the slices of all grids, in one row, by the shift of each across its contact, the forces held.

    Parameters
    ----------
    grids : sequence of LoadedGrid
    state : (grids,) array
        That each belongs to.
    bending : BendingModel

    Returns
    -------
    (slices, slices) sparse array
        Of one state only the slices depend on each other.
    """
    forces = [grid.slice_force for grid in grids]
    ends = np.cumsum([force.size for force in forces])
    blocks: dict[tuple[int, int], Array] = {}
    for i, grid in enumerate(grids):
        separation, loaded = grid.separation, np.flatnonzero(forces[i])
        count, force = loaded.size, forces[i][loaded]
        step = STEP * separation.spacing[0] * len(separation.x)
        both = bending.within(grid.number, _Doubled.of(separation, loaded, step))
        by_place = (both[count:, :count] - both[:count, :count]) / step
        own = np.zeros(forces[i].size)
        own[loaded] = by_place @ force
        blocks[i, i] = np.zeros((own.size, own.size))
        blocks[i, i][np.ix_(loaded, loaded)] = by_place.T * force
        beyond = replace(separation, force_line=separation.force_line + step)
        for j in np.flatnonzero(state == state[i]).tolist():
            if j != i:
                other = grids[j].number, grids[j].separation
                between = bending.between((grid.number, beyond), other) - bending.between(
                    (grid.number, separation), other
                )
                own += between @ forces[j] / step
                blocks[j, i] = between.T * forces[i] / step
        blocks[i, i] += np.diag(own)
    rows, columns, values = [], [], []
    for (i, j), block in blocks.items():
        at, under = (place.ravel() for place in np.indices(block.shape))
        rows.append(at + (ends[i] - block.shape[0]))
        columns.append(under + (ends[j] - block.shape[1]))
        values.append(block.ravel())
    size = int(ends[-1])
    places = np.concatenate(rows), np.concatenate(columns)
    return csr_array((np.concatenate(values), places), shape=(size, size))
