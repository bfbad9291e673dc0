"""Orders of the tooth mesh in a curve over one pitch: their complex amplitudes, phases from the pinion angle 0."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array


def harmonic_coefficients(curve: Array, count: int, begin: float = 0.0) -> NDArray[np.complex128]:
    r"""Complex amplitudes of the orders 1 to ``count`` of a periodic curve.

    .. math:: c_k = \frac{2}{N} \sum_{n=0}^{N-1} e_n \exp(-2 \pi i k (n / N + t_0))

    so that e(t) = mean + sum of \|c_k\| cos(2 pi k t + arg c_k), t from t_0 to t_0 + 1 over the period. The transform
    rounds each c_k by a few eps of the largest \|e\|: an amplitude by that, a phase by that over its amplitude.

    Parameters
    ----------
    curve : (N + 1,) array
        At even positions over one period, both ends included.
    count : int
    begin : float
        t_0, where the first position lies in periods: of the tooth mesh its pinion angle over the pitch.

    Returns
    -------
    (count,) complex array
        In the unit of the curve; NaN for orders of which the positions are too few, and for a curve with a gap.

    Examples
    --------
    >>> wave = harmonic_coefficients(np.cos(np.linspace(0.0, 2.0 * np.pi, 9) + 0.5), 4)
    >>> np.abs(wave).round(12), np.angle(wave[0]).round(12)
    (array([ 1.,  0.,  0., nan]), np.float64(0.5))
    """
    period = curve[:-1]
    coefficients = np.full(count, complex(math.nan, math.nan))
    known = min(count, (len(period) - 1) // 2)
    if known > 0 and np.isfinite(period).all():
        orders = np.arange(1, known + 1)
        coefficients[:known] = 2.0 / len(period) * np.fft.rfft(period)[orders] * np.exp(-2j * math.pi * begin * orders)
    return coefficients
