"""Allowable stress numbers of ISO 6336-5: lines over the hardness, by kind of material and quality.

``sigma = A x + B`` with the hardness x of the finished surface, A and B of table 1 of the edition of 2016, whose text
was not seen: the numbers are those that an open program prints from it (Mekanika, its class of materials), and where
a line has two parts they meet within 1 MPa, as they should. Stresses in MPa.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain

QUALITIES = ("ML", "MQ", "ME")
"""Quality of material and heat treatment: modest, usual and high demands."""
TEST_GEAR_CORRECTION = 2.0
"""Y_ST, stress correction factor of the gears that the allowable stresses were measured with."""
CORES = ("25 HRC", "25 HRC, J12 28 HRC", "30 HRC")
"""Core of case-hardened teeth of quality MQ: at least 25 HRC; the same, hardenability 28 HRC at 12 mm; 30 HRC."""

VICKERS_OF_ROCKWELL = (
    (240, 20.3), (260, 24.0), (280, 27.1), (300, 29.8), (320, 32.2), (340, 34.4), (360, 36.6), (380, 38.8),
    (400, 40.8), (420, 42.7), (440, 44.5), (460, 46.1), (480, 47.7), (500, 49.1), (520, 50.5), (540, 51.7),
    (560, 53.0), (580, 54.1), (600, 55.2), (620, 56.3), (640, 57.3), (660, 58.3), (680, 59.2), (700, 60.1),
    (720, 61.0), (740, 61.8), (760, 62.5), (780, 63.3), (800, 64.0), (820, 64.7), (840, 65.3), (860, 65.9),
    (880, 66.4), (900, 67.0), (920, 67.5), (940, 68.0),
)  # fmt: skip
"""HV and HRC of steel, ISO 18265, table A.1."""
BRINELL_OVER_VICKERS = 0.95
_ROUNDING = 1e-12  # of hardness that is converted
LARGEST_BRINELL = 450.0 * BRINELL_OVER_VICKERS
"""HBW of steel over HV, and up to where: ISO 18265."""
_VICKERS: dict[str, tuple[Sequence[float], Sequence[float]]] = {
    "HV": ((0.0, 1000.0), (0.0, 1000.0)),
    "HBW": ((0.0, LARGEST_BRINELL), (0.0, LARGEST_BRINELL / BRINELL_OVER_VICKERS)),
    "HRC": (tuple(each for _, each in VICKERS_OF_ROCKWELL), tuple(each for each, _ in VICKERS_OF_ROCKWELL)),
}
"""Scales: hardness, and the same in HV."""


class Line(NamedTuple):
    """A part of a line: A, B [MPa] and the hardness from which to which it holds."""

    slope: float
    offset: float
    lowest: float
    highest: float

    def stress(self, hardness: float) -> float:
        """A x + B [MPa]."""
        return self.slope * hardness + self.offset


Lines = tuple[Line, ...]


@dataclass(frozen=True)
class MaterialKind:
    """A kind of material of the standard.

    Attributes
    ----------
    words : str
    family : str
        The kind as the tables of factors have it: cast and wrought, carbon and alloy steels are one.
    scale : str
        Of the hardness of its lines, HBW or HV.
    flank, root : ((Line, ...), (Line, ...), (Line, ...))
        Lines of sigma_H_lim and sigma_F_lim for ML, MQ, ME.
    """

    words: str
    family: str
    scale: str
    flank: tuple[Lines, Lines, Lines]
    root: tuple[Lines, Lines, Lines]


def _lines(lowest: float, highest: float, *numbers: tuple[float, float]) -> tuple[Lines, Lines, Lines]:
    """Lines of ML, MQ and ME over one range; of two, the first for ML and MQ."""
    lines = tuple((Line(*pair, lowest, highest),) for pair in numbers)
    return (lines[0], lines[0], lines[1]) if len(lines) == 2 else (lines[0], lines[1], lines[2])


def _by_quality(*parts: tuple[Line, ...]) -> tuple[Lines, Lines, Lines]:
    """Lines of ML, MQ and ME with ranges of their own; of two, the first for ML and MQ."""
    return (parts[0], parts[0], parts[1]) if len(parts) == 2 else (parts[0], parts[1], parts[2])


_NITROCARBURIZED_FLANK = (Line(1.167, 425, 300, 450), Line(0.0, 950, 450, 650))
_NITROCARBURIZED_ROOT = (Line(0.653, 94, 300, 450), Line(0.0, 388, 450, 650))
KINDS: dict[str, MaterialKind] = {
    "St": MaterialKind(
        "normalized low-carbon steel, wrought", "St", "HBW",
        _lines(110, 210, (1.000, 190), (1.520, 250)), _lines(110, 210, (0.455, 69), (0.386, 147)),
    ),
    "St cast": MaterialKind(
        "normalized cast steel", "St", "HBW",
        _lines(140, 210, (0.986, 131), (1.143, 237)), _lines(140, 210, (0.313, 62), (0.254, 137)),
    ),
    "GTS": MaterialKind(
        "black malleable cast iron, pearlitic", "GTS", "HBW",
        _by_quality((Line(1.371, 143, 135, 250),), (Line(1.333, 267, 175, 250),)),
        _by_quality((Line(0.345, 77, 135, 250),), (Line(0.403, 128, 175, 250),)),
    ),
    **{
        name: MaterialKind(
            words, name, "HBW",
            _by_quality((Line(1.434, 211, 175, 300),), (Line(1.500, 250, 200, 300),)),
            _by_quality((Line(0.350, 119, 175, 300),), (Line(0.380, 134, 200, 300),)),
        )
        for name, words in (
            ("GGG", "nodular cast iron, pearlitic, bainitic"), ("GGG ferritic", "nodular cast iron, ferritic"),
        )
    },
    "GG": MaterialKind(
        "grey cast iron", "GG", "HBW",
        _by_quality((Line(1.033, 132, 150, 240),), (Line(1.465, 122, 175, 275),)),
        _by_quality((Line(0.256, 8, 150, 240),), (Line(0.200, 53, 175, 275),)),
    ),
    "V carbon": MaterialKind(
        "through-hardened carbon steel, wrought", "V", "HV",
        _lines(135, 210, (0.963, 283), (0.925, 360), (0.838, 432)),
        _lines(115, 215, (0.250, 108), (0.240, 163), (0.283, 202)),
    ),
    "V alloy": MaterialKind(
        "through-hardened alloy steel, wrought", "V", "HV",
        _by_quality((Line(1.313, 188, 200, 360),), (Line(1.313, 373, 200, 360),), (Line(2.213, 260, 200, 390),)),
        _by_quality((Line(0.423, 104, 200, 360),), (Line(0.425, 187, 200, 360),), (Line(0.358, 231, 200, 390),)),
    ),
    "V carbon cast": MaterialKind(
        "through-hardened carbon steel, cast", "V", "HV",
        _lines(130, 215, (0.831, 300), (0.951, 345)), _lines(130, 215, (0.224, 117), (0.286, 167)),
    ),
    "V alloy cast": MaterialKind(
        "through-hardened alloy steel, cast", "V", "HV",
        _lines(200, 360, (1.276, 298), (1.350, 356)), _lines(200, 360, (0.364, 161), (0.356, 186)),
    ),
    "Eh": MaterialKind(
        "case-hardened steel, wrought", "Eh", "HV",
        _by_quality((Line(0.0, 1300, 600, 800),), (Line(0.0, 1500, 660, 800),), (Line(0.0, 1650, 660, 800),)),
        _by_quality((Line(0.0, 312, 600, 800),), (Line(0.0, 425, 660, 800),), (Line(0.0, 525, 660, 800),)),
    ),
    "IF": MaterialKind(
        "flame- or induction-hardened steel, wrought and cast", "IF", "HV",
        _by_quality((Line(0.740, 602, 485, 615),), (Line(0.541, 882, 500, 615),), (Line(0.505, 1013, 500, 615),)),
        _by_quality(
            (Line(0.305, 76, 485, 615),),
            (Line(0.138, 290, 500, 570), Line(0.0, 369, 570, 615)),
            (Line(0.271, 237, 500, 615),),
        ),
    ),
    "NT": MaterialKind(
        "nitriding steel, through-hardened, nitrided", "NT", "HV",
        _lines(650, 900, (0.0, 1125), (0.0, 1250), (0.0, 1450)), _lines(650, 900, (0.0, 270), (0.0, 420), (0.0, 468)),
    ),
    "NV": MaterialKind(
        "through-hardening steel, nitrided", "NV", "HV",
        _lines(450, 650, (0.0, 788), (0.0, 998), (0.0, 1217)), _lines(450, 650, (0.0, 258), (0.0, 363), (0.0, 432)),
    ),
    "NV nitrocarburized": MaterialKind(
        "through-hardening steel, nitrocarburized", "NV nitrocarburized", "HV",
        _by_quality((Line(0.0, 650, 300, 650),), _NITROCARBURIZED_FLANK, _NITROCARBURIZED_FLANK),
        _by_quality((Line(0.0, 224, 300, 650),), _NITROCARBURIZED_ROOT, _NITROCARBURIZED_ROOT),
    ),
}  # fmt: skip
"""Kinds of material by the short names of the standard."""
_CORE_STRESSES = dict(zip(CORES, (425.0, 461.0, 500.0), strict=True))

CASE_HARDENED_HARDNESS, NITRIDED_HARDNESS = 700.0, 750.0
"""HV of steels that are named without their hardness: on lines that do not depend on it."""
MATERIALS: dict[str, tuple[str, float | None]] = {
    **dict.fromkeys(
        (
            "18CrNiMo7-6", "17CrNi6-6", "15CrNi6", "18CrNi8", "20NiCrMo2-2", "17NiCrMo6-4", "14NiCrMo13-4", "16MnCr5",
            "16MnCrS5", "20MnCr5", "20MnCrS5", "18CrMo4", "20MoCr4",
        ),
        ("Eh", CASE_HARDENED_HARDNESS),
    ),
    **dict.fromkeys(("31CrMoV9", "31CrMo12", "33CrMoV12-9", "34CrAlNi7-10"), ("NT", NITRIDED_HARDNESS)),
    **dict.fromkeys(("42CrMo4", "34CrMo4", "34CrNiMo6", "30CrNiMo8", "36CrNiMo4", "51CrV4"), ("V alloy", None)),
    **dict.fromkeys(("C35", "C45", "C60"), ("V carbon", None)),
    **dict.fromkeys(("EN-GJS-600-3", "EN-GJS-700-2", "EN-GJS-800-2"), ("GGG", None)),
    "EN-GJS-400-15": ("GGG ferritic", None),
    **dict.fromkeys(("EN-GJL-250", "EN-GJL-300"), ("GG", None)),
}  # fmt: skip
"""Kind of named materials in their usual heat treatment, and the hardness [HV] that is taken where none is given."""


@dataclass(frozen=True)
class AllowableStresses:
    """Allowable stress numbers of a material.

    Attributes
    ----------
    kind, quality : str
    hardness : float
        In the scale of the kind.
    contact : float [MPa]
        sigma_H_lim.
    nominal_root : float [MPa]
        sigma_F_lim.
    """

    kind: str
    quality: str
    hardness: float
    contact: float
    nominal_root: float

    @property
    def root(self) -> float:
        """sigma_FE = sigma_F_lim Y_ST, with Y_ST = 2 [MPa]."""
        return self.nominal_root * TEST_GEAR_CORRECTION


def material_kind(kind: str) -> MaterialKind:
    """A kind of material by its short name.

    Raises
    ------
    InputError
        With all names, if there is none of that name.

    Examples
    --------
    >>> material_kind("Eh").words
    'case-hardened steel, wrought'
    """
    if kind not in KINDS:
        raise InputError(f"kind: {kind!r} is no kind of material; allowed: {', '.join(map(repr, KINDS))}")
    return KINDS[kind]


@checked
def converted_hardness(hardness: float, scale: str, wanted: str) -> float:
    """Hardness of steel in another scale.

    Parameters
    ----------
    hardness : float
    scale, wanted : str
        HV, HBW or HRC, of the hardness and of what is returned.

    Raises
    ------
    InputError
        If a scale is unknown, or the hardness beyond the table of conversions.

    References
    ----------
    ISO 18265:2013, table A.1; HBW = 0.95 HV up to 450 HV.

    Examples
    --------
    >>> round(converted_hardness(61.0, "HRC", "HV")), converted_hardness(300.0, "HV", "HBW")
    (720, 285.0)
    """
    require(
        *(
            (each in _VICKERS, f"{name}: {each!r}; allowed: {', '.join(_VICKERS)}")
            for name, each in (("scale", scale), ("wanted", wanted))
        ),
        (0.0 < hardness < float("inf"), f"hardness: {hardness} {scale} is not positive and finite"),
    )
    if scale == wanted:
        return hardness
    (values, vickers), (targets, target_vickers) = _VICKERS[scale], _VICKERS[wanted]
    middle = float(np.interp(hardness, values, vickers))
    inside = values[0] <= hardness <= values[-1] and target_vickers[0] <= middle <= target_vickers[-1]
    low, high = max(vickers[0], target_vickers[0]), min(vickers[-1], target_vickers[-1])
    ends = (float(np.interp(end, vickers, values)) for end in (low, high))
    allowed = " to ".join(f"{plain(end, 6)}" for end in ends)
    require((inside, f"hardness: {hardness} {scale}; allowed for conversion to {wanted}: {allowed} {scale}"))
    return float(np.interp(middle, target_vickers, targets))


@checked
def allowable_stresses(
    kind: str, quality: str, hardness: float, *, scale: str | None = None, core: str = CORES[0]
) -> AllowableStresses:
    r"""Allowable stress numbers sigma_H_lim and sigma_F_lim.

    .. math:: \sigma_{H\,lim},\ \sigma_{F\,lim} = A\,x + B

    for a probability of damage of 1 %.

    Parameters
    ----------
    kind : str
        One of ``KINDS``.
    quality : str
        ML, MQ or ME.
    hardness : float
        x, of the finished surface.
    scale : str, optional
        HBW, HV or HRC; that of the kind, unless given.
    core : str
        One of ``CORES``; counts for the root of case-hardened teeth of quality MQ.

    Returns
    -------
    AllowableStresses

    Raises
    ------
    InputError
        If a name is unknown, or the hardness lies off the line.

    References
    ----------
    ISO 6336-5:2016, formula (2) and table 1.

    Examples
    --------
    >>> allowable = allowable_stresses("Eh", "MQ", 61.0, scale="HRC")
    >>> allowable.contact, allowable.nominal_root, allowable.root
    (1500.0, 425.0, 850.0)
    >>> allowable_stresses("V alloy", "MQ", 120.0)
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: hardness: 120 HV; allowed for kind 'V alloy', quality MQ: 200 to 360 HV
    """
    material = material_kind(kind)
    require(
        (quality in QUALITIES, f"quality: {quality!r}; allowed: {', '.join(QUALITIES)}"),
        (core in CORES, f"core: {core!r}; allowed: {', '.join(map(repr, CORES))}"),
        (
            core == CORES[0] or (kind == "Eh" and quality == "MQ"),
            f"core: {core!r} counts for kind 'Eh', quality MQ alone, not for {kind!r}, {quality}",
        ),
    )
    place, level = QUALITIES.index(quality), converted_hardness(hardness, scale or material.scale, material.scale)
    flank, root = material.flank[place], material.root[place]
    low, high = max(flank[0].lowest, root[0].lowest), min(flank[-1].highest, root[-1].highest)
    where = f"allowed for kind {kind!r}, quality {quality}: {plain(low, 6)} to {plain(high, 6)} {material.scale}"
    ends = float(np.clip(level, low, high))
    require((abs(level - ends) <= _ROUNDING * level, f"hardness: {plain(level, 6)} {material.scale}; {where}"))
    level = ends
    contact, bending = (next(line.stress(level) for line in lines if level <= line.highest) for lines in (flank, root))
    return AllowableStresses(
        kind, quality, level, float(contact), float(_CORE_STRESSES[core] if core != CORES[0] else bending)
    )


@checked
def named_material(
    name: str, quality: str, *, hardness: float | None = None, scale: str | None = None, core: str = CORES[0]
) -> AllowableStresses:
    """Allowable stress numbers of a steel or cast iron by its name, in its usual heat treatment.

    Parameters
    ----------
    name : str
        One of ``MATERIALS``; give ``allowable_stresses`` the kind for another heat treatment.
    quality, scale, core
        As for ``allowable_stresses``.
    hardness : float, optional
        Needed where the line depends on it; else 700 HV for case-hardened and 750 HV for nitriding steels.

    Raises
    ------
    InputError
        If the name is unknown, or the hardness is missing or off the line.

    Examples
    --------
    >>> named_material("18CrNiMo7-6", "MQ").contact, named_material("42CrMo4", "MQ", hardness=280.0).contact
    (1500.0, 740.64)
    """
    if name not in MATERIALS:
        raise InputError(f"material: {name!r} is not known; allowed: {', '.join(MATERIALS)}")
    kind, usual = MATERIALS[name]
    if hardness is None:
        if usual is None:
            raise InputError(f"hardness: not given; the stresses of {name} depend on it")
        return allowable_stresses(kind, quality, usual, scale="HV", core=core)
    return allowable_stresses(kind, quality, hardness, scale=scale, core=core)
