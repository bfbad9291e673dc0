r"""Flank modifications: crownings, reliefs, slopes, as amounts of material removed along the normal.

Nearly every modification is a function of one coordinate, the roll length along the profile or the distance from the
middle of the face, so each is a ``Term``: an amount times a shape of t = (coordinate - origin)/length. The one that
takes both is the bi-directional ``Polynomial``, twist included. They add up to delta(rho, z) > 0 where material is
off, and the flank becomes Theta - s delta |grad F| with |grad F| of the unmodified flank.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Literal, get_args

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import real
from loaded_tca.errors import InputError, give_accuracy_warning
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.removal import (
    CircularArc,
    ModifiedFlank,
    Polynomial,
    Shape,
    Term,
    linear,
    logarithmic,
    one_sided_parabola,
    parabola,
)
from loaded_tca.plain import plain

CrowningForm = Literal["parabolic", "circular", "logarithmic"]
ReliefForm = Literal["parabolic", "linear"]

_FORMS = {
    "lead_crowning_form": get_args(CrowningForm),
    "tip_relief_form": get_args(ReliefForm),
    "root_relief_form": get_args(ReliefForm),
}

_OF_ONE_END = tuple(f"end_relief_{end}{what}" for end in ("lower", "upper") for what in ("", "_length"))
"""None where they are as at both ends."""

NO_POLYNOMIAL = (0.0,) * 6
"""a1 to a6 of no correction."""

LARGEST_AMOUNT = 1.0
"""Amount [mm] beyond which a warning says so: gears have some hundredths of a millimetre."""

MOST = 2.0
"""What all modifications may remove or add together, over the longer side of the flank: crownings of the literature
that bring a contact to the middle at any price are about as thick as the flank is long."""
CHECKED = (9, 9)
"""Points at which the sum of all is looked at, along the profile and lengthwise, the edges included."""


@dataclass(frozen=True)
class FlankModifications:
    """Amounts of the standard modifications, in mm removed along the normal (ISO 21771 names beside).

    Parameters
    ----------
    lead_crowning : float [mm]
        C_beta, at the ends of the face; ``lead_crowning_form``: parabolic, circular or logarithmic.
    end_relief, end_relief_length : float [mm]
        C_betaI = C_betaII at both ends, parabolic over the length.
    end_relief_lower, end_relief_upper, end_relief_lower_length, end_relief_upper_length : float [mm], optional
        The same of one end, the lower one at small z (toe); None: as at both ends.
    profile_crowning : float [mm]
        C_alpha, at both ends of the active profile.
    tip_relief, tip_relief_start : float [mm]
        C_alpha_a at the tip; the **diameter** where it starts. ``tip_relief_form``: parabolic or linear in
        the roll length.
    tip_relief_start_roll : float [rad], tip_relief_start_length : float [mm]
        Roll angle xi = tan(alpha_y) or roll length r_b xi where it starts, instead of the diameter; zero: not given.
        On a bevel gear w/sin(delta_b) and R_m w of the unwound arc w; the length on a generated flank is counted from
        its form line at mid-face, and it has no roll angle.
    root_relief, root_relief_start, root_relief_start_roll, root_relief_start_length
        C_alpha_f at the start of the active profile; where it starts, likewise.
    helix_slope, profile_slope : float [mm]
        C_H_beta and C_H_alpha; may be negative.
    twist : float [mm]
        S_beta: the helix slope at the tip less that at the start of the active profile, over the face width; nothing
        on the lines through the middle of the flank. S_alpha, the profile slope at the upper end of the face less
        that at the lower end, is the same number. May be negative.
    polynomial : 6 floats [mm, 1, 1, 1/mm, 1/mm, 1/mm]
        a1 to a6 of a1 + a2 x + a3 y + a4 x y + a5 x^2 + a6 y^2, with x [mm] the distance from the middle of the face
        (the cone distance R - R_m of a bevel gear) and y [mm] the roll length a - a_m from the middle of the active
        profile (the unwound arc R_m (w - w_m) of a bevel gear). Crownings C_beta and C_alpha over the face width b
        and the active profile L are a5 = C_beta/(b/2)^2 and a6 = C_alpha/(L/2)^2, a twist S is a4 = S/(b L).

    Raises
    ------
    InputError
        If an amount is not finite, a form is unknown, a relief has two starts or the polynomial has not six
        coefficients.

    References
    ----------
    ISO 21771, clause 5 (flank modifications; roll angle and roll length). Polynomial: the bi-directional correction
    that studies of straight bevel gears with fitted flanks use.

    Examples
    --------
    >>> FlankModifications(polynomial=(0.0, 0.0, 0.0, 0.0, 1e-4, 2e-3)).polynomial[4]
    0.0001
    """

    lead_crowning: float = 0.0
    lead_crowning_form: CrowningForm = "parabolic"
    end_relief: float = 0.0
    end_relief_length: float = 0.0
    end_relief_lower: float | None = None
    end_relief_lower_length: float | None = None
    end_relief_upper: float | None = None
    end_relief_upper_length: float | None = None
    profile_crowning: float = 0.0
    tip_relief: float = 0.0
    tip_relief_start: float = 0.0
    tip_relief_start_roll: float = 0.0
    tip_relief_start_length: float = 0.0
    tip_relief_form: ReliefForm = "parabolic"
    root_relief: float = 0.0
    root_relief_start: float = 0.0
    root_relief_start_roll: float = 0.0
    root_relief_start_length: float = 0.0
    root_relief_form: ReliefForm = "parabolic"
    helix_slope: float = 0.0
    profile_slope: float = 0.0
    twist: float = 0.0
    polynomial: tuple[float, ...] = NO_POLYNOMIAL

    def __post_init__(self) -> None:
        problems = []
        for name, value in ((entry.name, getattr(self, entry.name)) for entry in fields(self)):
            forms = _FORMS.get(name)
            if name == "polynomial":
                values = np.asarray(value)
                if not (values.shape == (6,) and values.dtype.kind in "if" and np.isfinite(values).all()):
                    problems.append(f"polynomial: {value!r:.100} is not six finite numbers, a1 to a6")
            elif value is None and name in _OF_ONE_END:
                continue
            elif forms is None and not math.isfinite(real(value)):
                problems.append(f"{name}: {value} {'rad' if name.endswith('_roll') else 'mm'} is not finite")
            elif forms is not None and value not in forms:
                problems.append(f"{name}: {str(value)!r} is not {', '.join(map(repr, forms[:-1]))} or {forms[-1]!r}")
        for relief in ("tip_relief", "root_relief"):
            starts = {name: value for name in _starts_of(relief) if (value := getattr(self, name)) != 0.0}
            if len(starts) > 1:
                given = ", ".join(f"{name} = {value}" for name, value in starts.items())
                problems.append(f"{relief}_start: found {given}; give one of them")
        if problems:
            raise InputError(problems)
        object.__setattr__(self, "polynomial", tuple(float(value) for value in self.polynomial))

    def terms(
        self,
        face_width: float,
        diameters: tuple[float, float],
        coordinate: Callable[[float], float],
        profile_unit: float = 1.0,
        roll_unit: float | None = None,
    ) -> tuple[Term | Polynomial, ...]:
        """Terms of every amount that is not zero.

        Parameters
        ----------
        face_width : float [mm]
        diameters : (float, float) [mm]
            Start of the active profile, and tip.
        coordinate : callable
            Diameter [mm] -> profile coordinate.
        profile_unit : float [mm]
            Length of one unit of the profile coordinate.
        roll_unit : float, optional
            Profile coordinate at a roll angle of 1 rad; None: there is no roll angle.

        Raises
        ------
        InputError
            If a relief starts off the active profile, or at a roll angle that the flank does not have, or is longer
            than half the face.
        """
        start, tip = (coordinate(diameter) for diameter in diameters)
        middle, length = 0.5 * (start + tip), tip - start
        candidates = (
            *self._lengthwise(face_width),
            Term("profile", self.profile_crowning, middle, 0.5 * length, parabola),
            Term("profile", self.profile_slope, start, length, linear),
            *self._reliefs(diameters, coordinate, profile_unit, roll_unit),
        )
        terms = tuple(term for term in candidates if term.amount != 0.0)
        a1, a2, a3, a4, a5, a6 = self.polynomial
        coefficients = a1, a2, a3, a4 + self.twist / (face_width * length * profile_unit), a5, a6
        return (*terms, Polynomial(coefficients, middle, profile_unit)) if any(coefficients) else terms

    def _lengthwise(self, width: float) -> list[Term]:
        half, crowning = 0.5 * width, self.lead_crowning
        shapes: dict[str, Shape] = {"parabolic": parabola, "logarithmic": logarithmic}
        if self.lead_crowning_form == "circular" and crowning != 0.0:
            if abs(crowning) > half:
                message = (
                    f"lead_crowning: {plain(crowning, 6)} mm is more than a circular arc over "
                    f"{plain(width, 6)} mm can fall"
                )
                raise InputError(message)
            shapes["circular"] = CircularArc(abs(crowning), half)
        shape = shapes.get(self.lead_crowning_form, parabola)
        terms = [
            Term("lengthwise", crowning, 0.0, half, shape),
            Term("lengthwise", self.helix_slope, -half, width, linear),
        ]
        for end, relief, length, outward in (
            ("lower", self.end_relief_lower, self.end_relief_lower_length, -1.0),
            ("upper", self.end_relief_upper, self.end_relief_upper_length, 1.0),
        ):
            amount = self.end_relief if relief is None else relief
            name, over = f"end_relief_{end}_length", length
            if over is None:
                name, over = "end_relief_length", self.end_relief_length
            if amount != 0.0:
                _require_between(name, over, 0.0, half * (1.0 + 1e-12))
                terms.append(Term("lengthwise", amount, outward * (half - over), outward * over, one_sided_parabola))
        return terms

    def _reliefs(
        self,
        diameters: tuple[float, float],
        coordinate: Callable[[float], float],
        profile_unit: float,
        roll_unit: float | None,
    ) -> list[Term]:
        ends = coordinate(diameters[0]), coordinate(diameters[1])

        def start(relief: str) -> float:
            """Profile coordinate at which a relief starts, however that is given."""
            diameter, roll, length = (getattr(self, name) for name in _starts_of(relief))
            if roll != 0.0:
                name = f"{relief}_start_roll"
                if roll_unit is None:
                    problem = f"{name}: the flank is no involute and has no roll angle; give {relief}_start"
                    raise InputError(f"{problem} (a diameter) or {relief}_start_length")
                low, high = (math.degrees(end / roll_unit) for end in ends)
                _require_between(f"{name} (roll angle on the active profile)", math.degrees(roll), low, high, "deg")
                return float(roll * roll_unit)
            if length != 0.0:
                low, high = (end * profile_unit for end in ends)
                _require_between(f"{relief}_start_length (roll length on the active profile)", length, low, high)
                return float(length / profile_unit)
            _require_between(f"{relief}_start (diameter on the active profile)", diameter, *diameters)
            return coordinate(diameter)

        terms = []
        for name, form, end in (
            ("tip_relief", self.tip_relief_form, ends[1]),
            ("root_relief", self.root_relief_form, ends[0]),
        ):
            amount = getattr(self, name)
            if amount != 0.0:
                origin, shape = start(name), one_sided_parabola if form == "parabolic" else None
                terms.append(Term("profile", amount, origin, end - origin, shape))
        return terms


AMOUNTS = tuple(
    entry.name
    for entry in fields(FlankModifications)
    if not entry.name.endswith(("_form", "_length", "_start", "_roll")) and entry.name != "polynomial"
)
"""Fields that are amounts of material; the others say of what form they are, and where they begin."""


def _starts_of(relief: str) -> tuple[str, str, str]:
    """Names of the three ways to say where a relief starts: diameter, roll angle, roll length."""
    return f"{relief}_start", f"{relief}_start_roll", f"{relief}_start_length"


def _require_between(name: str, value: float, first: float, second: float, unit: str = "mm") -> None:
    """Refuse a value that is not between two others, in either order: of a ring the tip has the smaller diameter."""
    low, high = min(first, second), max(first, second)
    if not low < value < high:
        raise InputError(f"{name}: {plain(value, 6)} {unit} is not between {plain(low, 6)} and {plain(high, 6)} {unit}")


def modified(
    nominal: Flank,
    modifications: FlankModifications,
    face_width: float,
    diameters: tuple[float, float],
    coordinate: Callable[[float], float],
    *,
    owner: str,
) -> Flank:
    """The flank with its modifications, or the nominal one if there are none.

    Parameters
    ----------
    nominal : Flank
    modifications : FlankModifications
    face_width, diameters, coordinate
        As for ``FlankModifications.terms``.
    owner : str
        Name of the gear, before every problem.

    Raises
    ------
    InputError
        If a relief starts off the active profile or is longer than half the face, or if more is removed somewhere, or
        added, than the flank is long.

    Warns
    -----
    AccuracyWarning
        If an amount is more than 1 mm.
    """
    try:
        terms = modifications.terms(face_width, diameters, coordinate, nominal.profile_unit, nominal.roll_unit)
    except InputError as error:
        raise InputError(f"{owner}.modifications.{problem}" for problem in error.problems) from None
    if not terms:
        return nominal
    flank = ModifiedFlank(nominal, terms)
    most, limit = float(np.abs(flank.removal(*nominal.grid(*CHECKED)).value).max()), MOST * max(nominal.extent)
    if not most <= limit:
        warning = f"{owner}.modifications: together they remove or add up to {plain(most)} mm"
        raise InputError(f"{warning}; allowed up to {plain(limit)} mm, {plain(MOST, 6)} longer sides of the flank")
    for name in AMOUNTS:
        amount = getattr(modifications, name) or 0.0  # None: as at both ends
        if abs(amount) > LARGEST_AMOUNT:
            message = kinds.UNIT.sentence(key=f"{owner}.modifications.{name}", amount=amount, most=LARGEST_AMOUNT)
            give_accuracy_warning(message)
    return flank
