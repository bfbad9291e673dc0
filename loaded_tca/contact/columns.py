"""What yields beneath the half-spaces, column by column of a grid: bending that spreads a load along the contact."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.convolution import Convolution, Window
from loaded_tca.contact.edges import MirroredConvolution

# A compliance is symmetric; rounding of its maker is not.
SYMMETRY = 1e-9


class YieldingColumns:
    """Displacement by a convolution, and of whole columns under the forces on columns.

    Parameters
    ----------
    convolve : Convolution or MirroredConvolution
        Of the half-spaces.
    compliance : (target columns, loaded columns) array
        Displacement of a column under a unit sum of pressures on another, in the units of the convolution.
    dtype : {"float64", "float32"}
    """

    def __init__(self, convolve: Convolution | MirroredConvolution, compliance: Array, dtype: str = "float64") -> None:
        self._convolve, self._compliance = convolve, compliance.astype(dtype)

    @property
    def count(self) -> int:
        """Convolutions so far."""
        return self._convolve.count

    def __call__(self, pressure: Array, out: Array) -> Array:
        """Write the displacement into ``out`` and return it."""
        self._convolve(pressure, out)
        out += self._compliance @ pressure.sum(axis=0, dtype=self._compliance.dtype)
        return out


def yielding(
    convolve: Convolution | MirroredConvolution, columns: Array | None, window: Window | None, dtype: str
) -> Convolution | MirroredConvolution | YieldingColumns:
    """Add the compliance (n, n) of the columns of a grid, if there is one, to its convolution of a window of it."""
    if columns is None:
        return convolve
    return YieldingColumns(convolve, columns if window is None else columns[:, window[1]], dtype)


def in_grid_units(
    columns: Array | None, window: Window | None, spacing: tuple[float, float], contact_modulus: float
) -> Array | None:
    """Compliance [mm/N] of the columns in a window, per sum of pressures p dx/E*, as a grid counts them."""
    if columns is None:
        return None
    part = slice(None) if window is None else window[1]
    return np.asarray(columns[part, part] * (spacing[1] * contact_modulus))


def merge_columns(columns: Array | None, merge: int) -> Array | None:
    """Compliance where pairs of columns are one: the mean over both; an odd last one stays alone."""
    if columns is None or merge == 1:
        return columns
    starts = np.arange(0, len(columns), merge)
    sizes = np.diff(np.append(starts, len(columns)))
    summed = np.add.reduceat(np.add.reduceat(columns, starts, axis=0), starts, axis=1)
    return np.asarray(summed / (sizes[:, None] * sizes))


def check_columns(columns: Array | None, shape: tuple[int, ...]) -> list[str]:
    """Problems of a column compliance for a grid of a shape."""
    if columns is None:
        return []
    if columns.shape != (shape[-1], shape[-1]) or not np.isfinite(columns).all():
        return [f"column_compliance: finite {(shape[-1], shape[-1])} is needed, not {columns.shape}"]
    if np.abs(columns - columns.T).max() > SYMMETRY * np.abs(columns).max():
        return ["column_compliance: is not symmetric"]
    return []
