"""Where first order ends: another position becomes the highest or the lowest, and the figure follows that.

Peak to peak, peak pressure and root tension are those of one position, or of two. With the values v of all and their
derivatives s, another one is as high as the highest after a change of the key by (v_max - v)/(s - s_max).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.units import ending_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from loaded_tca.results.sensitivities import Sensitivities

TOLD = 0.05
"""Part of a derivative from which on another one beyond is told."""


def changes_to_another(values: Array, slopes: Array) -> tuple[Array, Array]:
    """How far a key may change before another value is the largest, to first order.

    Parameters
    ----------
    values : (n,) array
        NaN where there is none.
    slopes : (n, key) array
        Their derivatives.

    Returns
    -------
    changes : (2, key) array
        The nearest change below and above zero, in the unit of the key; infinite where there is none.
    kinks : (2, key) array
        Derivative of the largest value beyond it, less that before; zero where there is none.

    Examples
    --------
    >>> changes, kinks = changes_to_another(np.array([3.0, 2.0, 1.0]), np.array([[0.0], [10.0], [-4.0]]))
    >>> changes.ravel(), kinks.ravel()
    (array([-0.5,  0.1]), array([-4., 10.]))
    """
    top, keys = int(np.nanargmax(values)), np.arange(slopes.shape[1])
    short, apart = (values[top] - values)[:, None], slopes - slopes[top]
    changes, kinks = np.full((2, keys.size), math.inf), np.zeros((2, keys.size))
    for side, sign in enumerate((-1.0, 1.0)):
        leaves = np.isfinite(short) & (sign * apart > 0.0)
        reached = np.where(leaves, short / np.where(leaves, sign * apart, 1.0), math.inf)
        nearest = reached.argmin(axis=0)
        there = np.isfinite(reached[nearest, keys])
        changes[side] = sign * reached[nearest, keys]
        kinks[side] = np.where(there, apart[nearest, keys], 0.0)
    return changes, kinks


def warn_of_positions(sensitivities: Sensitivities, tolerances: Mapping[str, float]) -> None:
    """Tell of each figure which key reaches another position within its tolerance, by an AccuracyWarning.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    """
    within = np.array([tolerances[key] for key in sensitivities.keys])
    for name, parts in _figures(sensitivities):
        nearest, sizes = np.full(within.size, math.inf), np.zeros(within.size)
        for torque in range(len(sensitivities.result.torque)):
            known = [(values[torque], slopes[torque]) for values, slopes in parts if np.isfinite(values[torque]).any()]
            slope = sum((own[int(np.nanargmax(values))] for values, own in known), np.zeros(within.size))
            for values, own in known:
                changes, kinks = changes_to_another(values, own)
                parted = np.abs(kinks) / np.maximum(np.abs(slope), np.abs(slope + kinks)).clip(np.finfo(float).tiny)
                for change, size in zip(changes, parted, strict=True):
                    nearer = (size > TOLD) & (np.abs(change) <= within) & (np.abs(change) < np.abs(nearest))
                    nearest, sizes = np.where(nearer, change, nearest), np.where(nearer, size, sizes)
        if sizes.any():
            first = int((np.abs(nearest) / within.clip(np.finfo(float).tiny)).argmin())
            key = sensitivities.keys[first]
            words = {"key": key, "unit": ending_of(key), "count": np.count_nonzero(sizes), "keys": within.size}
            told = {"figure": name, "change": nearest[first], "size": sizes[first], **words}
            give_accuracy_warning(kinds.ANOTHER_POSITION.sentence(**told))


def _figures(sensitivities: Sensitivities) -> Iterator[tuple[str, list[tuple[Array, Array]]]]:
    """Names of figures, and values (torque, n) and derivatives (torque, n, key) whose largest ones they are the sum of.

    The last position of several is left out, the first one of the next pitch.
    """
    result = sensitivities.result
    count, keys = len(result.torque), len(sensitivities.keys)
    pitch = slice(max(1, len(result.path) - 1))
    errors, slopes = result.transmission_error[:, pitch], sensitivities.transmission_error[:, pitch]
    if errors.shape[1] > 1:
        length = result.um_per_rad
        yield "peak to peak", [(sign * length * errors, sign * length * slopes) for sign in (1.0, -1.0)]
    pressures, by_key = result.peak_pressure[:, pitch], sensitivities.peak_pressure[:, pitch]
    yield "peak pressure", [(pressures.reshape(count, -1), by_key.reshape(count, -1, keys))]
    if result.has_root_stress:
        for gear, name in enumerate(GEARS):
            tensions = result.root_tension[:, pitch, gear], sensitivities.root_tension[:, pitch, gear]
            yield f"root tension of the {name}", [tensions]
