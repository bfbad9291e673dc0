"""Compliance beneath the half-spaces, slice by slice of a grid: bending that spreads a load along the contact.

A slice is the cells of one place along the contact (the second axis).
"""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.convolution import Convolution
from loaded_tca.contact.edges import MirroredConvolution

# A compliance is symmetric; the rounding of how it was computed is not.
SYMMETRY = 1e-9


class ConvolutionOverSlices:
    """Displacement by a convolution, and of whole slices under the forces on slices.

    Parameters
    ----------
    convolve : Convolution or MirroredConvolution
        Of the half-spaces.
    compliance : (target slices, loaded slices) array
        Displacement of a slice under a unit sum of pressures on another, in the units of the convolution.
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


def merge_slices(compliance: Array) -> Array:
    """Compliance where pairs of slices are one: the mean over both; an odd last one stays alone."""
    starts = np.arange(0, len(compliance), 2)
    sizes = np.diff(np.append(starts, len(compliance)))
    summed = np.add.reduceat(np.add.reduceat(compliance, starts, axis=0), starts, axis=1)
    return np.asarray(summed / (sizes[:, None] * sizes))


def check_slices(compliance: Array | None, shape: tuple[int, ...]) -> list[str]:
    """Problems of a slice compliance for a grid of a shape."""
    if compliance is None:
        return []
    if compliance.shape != (shape[-1], shape[-1]) or not np.isfinite(compliance).all():
        return [f"slice_compliance: finite {(shape[-1], shape[-1])} is needed, not {compliance.shape}"]
    if np.abs(compliance - compliance.T).max() > SYMMETRY * np.abs(compliance).max():
        return ["slice_compliance: is not symmetric"]
    return []
