"""Compliance beneath the half-spaces, slice by slice of a grid: bending that spreads a load along the contact.

A slice is the cells of one place along the contact (the second axis).
"""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array

# A compliance is symmetric; the rounding of how it was computed is not.
SYMMETRY = 1e-9


def merge_slices(compliance: Array) -> Array:
    """Compliance where pairs of slices are one: the mean over both; an odd last one stays alone."""
    return merged(merged(compliance, -2), -1)


def merged(values: Array, axis: int) -> Array:
    """Means over pairs along one of the last two axes, -2 or -1; an odd last one stays alone."""
    starts = np.arange(0, values.shape[axis], 2)
    sizes = np.diff(np.append(starts, values.shape[axis]))
    return np.asarray(np.add.reduceat(values, starts, axis=axis) / (sizes[:, None] if axis == -2 else sizes))


def check_slices(compliance: Array | None, shape: tuple[int, ...]) -> list[str]:
    """Problems of a slice compliance for a grid of a shape."""
    if compliance is None:
        return []
    if compliance.shape != (shape[-1], shape[-1]):
        return [f"slice_compliance: shape {(shape[-1], shape[-1])} is needed, not {compliance.shape}"]
    if not np.isfinite(compliance).all():
        return [f"slice_compliance: {int((~np.isfinite(compliance)).sum())} values are not finite"]
    if np.abs(compliance - compliance.T).max() > SYMMETRY * np.abs(compliance).max():
        return ["slice_compliance: is not symmetric"]
    return []
