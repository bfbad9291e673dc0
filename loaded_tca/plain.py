"""Numbers in sentences, as a person writes them."""

from __future__ import annotations

import math
import string
from collections.abc import Sequence
from typing import Any

LEAST, MOST = 1e-6, 1e9
"""Sizes between which no number has an exponent."""
EXACT = 17
"""Digits that tell any two numbers apart."""


def plain(value: float, digits: int = 4, sign: str = "") -> str:
    """Number with some significant digits: no exponent for what a person reads without one, no minus before a zero.

    Parameters
    ----------
    value : float
    digits : int
        Significant ones.
    sign : {"", "+"}
        Whether positive numbers have a plus.

    Examples
    --------
    >>> plain(128.0, 2), plain(0.00002, 2), plain(-0.0), plain(118204.0, 2), plain(3.0, 2, "+"), plain(2e-9)
    ('130', '0.00002', '0', '120000', '+3', '2e-9')
    """
    rounded = float(f"{value:.{digits}g}") + 0.0  # no minus before a zero
    if rounded and math.isfinite(rounded) and LEAST <= abs(rounded) < MOST:
        places = max(digits - 1 - math.floor(math.log10(abs(rounded))), 0)
        text = f"{rounded:{sign}.{places}f}"
        return text.rstrip("0").rstrip(".") if places else text
    mantissa, exponent, power = f"{rounded:{sign}.{digits}g}".partition("e")
    return f"{mantissa}e{int(power)}" if exponent else mantissa


def table_cell(value: object) -> str:
    """Cell of a table: a number with four digits, a dash where it is not known (NaN), a word as it is.

    Parameters
    ----------
    value : object

    Examples
    --------
    >>> table_cell(0.25), table_cell(float("nan")), table_cell("right")
    ('0.25', '-', 'right')
    """
    if isinstance(value, float):
        return "-" if math.isnan(value) else plain(value)
    return str(value)


def apart(values: Sequence[float], digits: int = 6) -> list[str]:
    """Numbers of one sentence with some significant digits, or as many as tell different ones apart.

    Examples
    --------
    >>> apart([1000.0001, 1000.0]), apart([1.5, 1.5])
    (['1000.0001', '1000'], ['1.5', '1.5'])
    """
    for count in range(digits, EXACT):
        texts = [plain(value, count) for value in values]
        if len({*texts}) == len({*values}):
            return texts
    return [plain(value, EXACT) for value in values]


LONGEST_LIFE = 1e6
"""Hours, or millions of revolutions, beyond which a life is one that the part does not see the end of."""


def lasting(life: float) -> str:
    """Life in sentences and tables, with four digits; a longer one as catalogues have it.

    Examples
    --------
    >>> lasting(51234.0), lasting(3.21e11), lasting(math.inf)
    ('51230', '>1e6', 'inf')
    """
    return ">1e6" if LONGEST_LIFE < life < math.inf else plain(life)


def signed(number: int) -> str:
    """Return the number of a tooth pair as summaries and pictures show it: 0, +1, -1."""
    return f"{number:+d}" if number else "0"


class Sentence(string.Formatter):
    """Formatter of sentences: numbers in general format (``g``) are plain."""

    def format_field(self, value: Any, format_spec: str) -> str:
        """Field of a sentence; format specifications are those of Python."""
        if not format_spec.endswith("g") or isinstance(value, str):
            return super().format_field(value, format_spec)
        sign, _, digits = format_spec.removesuffix("g").partition(".")
        return plain(float(value), int(digits or 6), sign)
