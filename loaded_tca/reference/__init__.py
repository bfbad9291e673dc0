"""Closed forms that tests and users share: Hertz, punches, wedge, ISO 1328, 6336, 10300, Weber and Banaschek."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.reference import (
        friction,
        hertz,
        iso1328,
        iso6336,
        iso6336_1,
        iso6336_2,
        iso6336_3,
        iso6336_3_strength,
        iso6336_5,
        iso6336_6,
        iso6336_20,
        iso6336_21,
        iso6336_22,
        iso10300_1,
        iso10300_2,
        iso10300_3,
        iso17485,
        punch,
        weber_banaschek,
        wedge,
    )
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "friction",
    "hertz",
    "iso1328",
    "iso6336",
    "iso6336_1",
    "iso6336_2",
    "iso6336_3",
    "iso6336_3_strength",
    "iso6336_5",
    "iso6336_6",
    "iso6336_20",
    "iso6336_21",
    "iso6336_22",
    "iso10300_1",
    "iso10300_2",
    "iso10300_3",
    "iso17485",
    "punch",
    "weber_banaschek",
    "wedge",
]
