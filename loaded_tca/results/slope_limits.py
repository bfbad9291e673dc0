"""Warnings about derivatives of load shares that depend on the grid or end at a kink, and of peak pressures at a kink.

Derivatives with which a usual change of the key changes the figure by less than a thousandth cause no warning.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.units import ending_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loaded_tca.arrays import Array

USUAL = {"um": 1.0, "mm": 0.01, "deg": 0.01}
"""Usual standard deviation of a key by the unit at the end of its name."""
OF_RELIEF_ENDS = 10.0
"""Factor of the usual standard deviation for starts and lengths of reliefs."""
TOLD = 0.05
"""Relative difference of a derivative on another grid, or beyond a kink, above which there is a warning."""
LEAST = 1e-3
"""Part of the largest value of a figure: smaller changes by a usual change of a key are compared with this part."""
ALIKE, AS_LARGE = 0.03, 0.01
"""Relative differences of two peak pressures of a contact: below the first, derivatives of both are computed; below the
second, there is a warning for every key, and above it only for keys whose usual change reaches the kink."""


def usual_tolerance(key: str) -> float:
    """Usual standard deviation of a key of a modification or of a mounting error, in its unit.

    Examples
    --------
    >>> usual_tolerance("mounting.in_plane_deg"), usual_tolerance("pinion.modifications.tip_relief_start_mm")
    (0.01, 0.1)
    """
    name = key.rpartition(".")[2]
    of_relief_end = "relief" in name and not name.endswith("_um")
    return USUAL.get(name.rpartition("_")[2], 1.0) * (OF_RELIEF_ENDS if of_relief_end else 1.0)


def seen_size(keys: Sequence[str], figure: Array, slopes: Array) -> Array:
    """Sizes (key,) that differences of derivatives (torque, position, pair, key) are compared with.

    The largest derivative, but at least the derivative with which a usual change of the key changes the figure by a
    thousandth of its largest value.
    """
    usual = np.array([usual_tolerance(key) for key in keys])
    return np.maximum(_largest(slopes), LEAST * float(np.nan_to_num(figure).max()) / usual)


def warn_of_share_grids(keys: Sequence[str], shares: Array, slopes: Array, by_grids: Array) -> None:
    """Warn of derivatives (torque, position, pair, key) of load shares that depend on the grids by ``by_grids``."""
    sizes = _largest(by_grids)
    above = sizes > TOLD * seen_size(keys, shares, slopes)
    if above.any():
        own = int(np.where(above, sizes * [usual_tolerance(key) for key in keys], -1.0).argmax())
        counted = {"key": keys[own], "count": np.count_nonzero(above), "keys": len(keys)}
        sentence = kinds.SHARES_BY_GRIDS.sentence(
            size=sizes[own], largest=_largest(slopes)[own], unit=ending_of(keys[own]), **counted
        )
        give_accuracy_warning(sentence)


def warn_of_leaving_pairs(keys: Sequence[str], shares: Array, slopes: Array) -> None:
    """Warn of tooth pairs that lose their load within a usual change of a key, where load shares have a kink.

    ``slopes`` (torque, position, pair, key) are the derivatives of the ``shares``. No share falls below zero, so that
    the mean slope over the usual change is at most the share over that change: by what the derivative exceeds this, it
    is off at least. Keys without a usual change, as the torque, cause no warning.
    """
    usual = np.array([usual_tolerance(key) if ending_of(key) in USUAL else 0.0 for key in keys])
    carried = np.nan_to_num(shares)[..., None]
    below = np.where(carried > 0.0, usual * np.abs(np.nan_to_num(slopes)) - carried, 0.0)
    sizes = usual * seen_size(keys, shares, slopes)
    parts = np.divide(below, sizes, out=np.zeros(below.shape), where=sizes > 0.0)
    worst = parts.max(axis=(0, 1, 2))
    if (worst > TOLD).any():
        own = int(worst.argmax())
        place = np.unravel_index(int(parts[..., own].argmax()), shares.shape)
        sentence = kinds.PAIR_LEAVES.sentence(
            share=1e2 * shares[place],
            change=-shares[place] / slopes[place][own],
            usual=usual[own],
            size=worst[own],
            unit=ending_of(keys[own]),
            key=keys[own],
            count=np.count_nonzero(worst > TOLD),
            keys=len(keys),
        )
        give_accuracy_warning(sentence)


def warn_of_alike_peaks(keys: Sequence[str], pressures: Array, lacking: Array, slopes: Array, others: Array) -> None:
    """Warn of kinks of peak pressures: another place of the contact has nearly the largest pressure.

    ``lacking`` (torque, position, pair): relative difference between the largest pressure and the pressure at the other
    place, NaN without such a place; ``slopes``, ``others`` (..., key): derivatives at the two places.
    """
    usual = np.array([usual_tolerance(key) for key in keys])
    apart, short = np.abs(others - slopes), (lacking * pressures)[..., None]
    near = (lacking[..., None] < AS_LARGE) | (short < usual * apart)
    parts = np.where(near, np.nan_to_num(apart), 0.0) / np.maximum(seen_size(keys, pressures, slopes), _largest(others))
    worst = parts.max(axis=(0, 1, 2))
    if (worst > TOLD).any():
        own = int(worst.argmax())
        place = np.unravel_index(int(parts[..., own].argmax()), lacking.shape)
        counted = {"key": keys[own], "count": np.count_nonzero(worst > TOLD), "keys": len(keys)}
        sentence = kinds.PEAKS_ALIKE.sentence(
            lacking=lacking[place],
            slope=slopes[place][own],
            other=others[place][own],
            unit=ending_of(keys[own]),
            **counted,
        )
        give_accuracy_warning(sentence)


def _largest(slopes: Array) -> Array:
    """Largest sizes (key,) of numbers (..., key); zero where all are NaN."""
    return np.asarray(np.abs(np.nan_to_num(slopes)).max(axis=tuple(range(slopes.ndim - 1))))
