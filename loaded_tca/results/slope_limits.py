"""Where derivatives of load shares and of peak pressures hold less: they depend on the grid, or have a kink.

A derivative counts where a usual change of its key changes the figure by a part that anybody sees.
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
"""The same, so many times as large, where a relief starts or how long it is."""
TOLD = 0.05
"""Part of a derivative from which on it is told that another grid, or the other side of a kink, has another one."""
LEAST = 1e-3
"""Part of a figure, by a usual change of a key: derivatives that change it by less are seen in the size of this."""
ALIKE, AS_LARGE = 0.03, 0.01
"""Relative difference of two peak pressures of a contact up to which derivatives are found of both, and up to which
the kink is near for every key; beyond the latter for keys whose usual change reaches it."""


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
    """Size (key,) by which differences of derivatives (torque, position, pair, key) are seen.

    That of the largest derivative, or of one by which a usual change takes a thousandth of the largest number of the
    figure.
    """
    usual = np.array([usual_tolerance(key) for key in keys])
    return np.maximum(_largest(slopes), LEAST * float(np.nan_to_num(figure).max()) / usual)


def warn_of_share_grids(keys: Sequence[str], shares: Array, slopes: Array, by_grids: Array, stacklevel: int) -> None:
    """Tell which derivatives (torque, position, pair, key) of load shares depend on the grids by ``by_grids``."""
    sizes = _largest(by_grids)
    above = sizes > TOLD * seen_size(keys, shares, slopes)
    if above.any():
        own = int(np.where(above, sizes * [usual_tolerance(key) for key in keys], -1.0).argmax())
        counted = {"key": keys[own], "count": np.count_nonzero(above), "keys": len(keys)}
        sentence = kinds.SHARES_BY_GRIDS.sentence(
            size=sizes[own], largest=_largest(slopes)[own], unit=ending_of(keys[own]), **counted
        )
        give_accuracy_warning(sentence, stacklevel=stacklevel + 1)


def warn_of_alike_peaks(
    keys: Sequence[str], pressures: Array, lacking: Array, slopes: Array, others: Array, stacklevel: int
) -> None:
    """Tell where derivatives of peak pressures have a kink since another place of the contact has nearly as much.

    ``lacking`` (torque, position, pair): what the other peak lacks, relative, NaN where there is none; ``slopes``,
    ``others`` (..., key): derivatives of both.
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
        give_accuracy_warning(sentence, stacklevel=stacklevel + 1)


def _largest(slopes: Array) -> Array:
    """Largest sizes (key,) of numbers (..., key); zero where all are NaN."""
    return np.asarray(np.abs(np.nan_to_num(slopes)).max(axis=tuple(range(slopes.ndim - 1))))
