"""What is wrong with the numbers that a gear is given by, each looked at by itself."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, inf, isclose, isfinite, pi, radians
from typing import Any

from loaded_tca.arrays import real
from loaded_tca.plain import plain

SMALLEST_PRESSURE_ANGLE, LARGEST_PRESSURE_ANGLE = radians(1), radians(45)
LARGEST_SPIRAL_ANGLE = radians(60)
"""Of helices too."""
LEAST_FACE = 1e-3
"""Smallest face width over the module: a face of less is no tooth, and its pressure no number."""
_EQUAL = 1e-12


def teeth_checks(*teeth: float) -> Iterator[tuple[bool, str]]:
    """Checks for ``require``: every number of teeth is a whole one from 3 on."""
    for count in teeth:
        whole = isfinite(real(count)) and count == int(count) and count >= 3
        yield whole, f"teeth: {count} is not a whole number from 3 on"


def bore_check(bore_diameter: float | None) -> tuple[bool, str]:
    """Check of a bore diameter, where it is given: 0 is a solid gear."""
    fits = bore_diameter is None or 0.0 <= real(bore_diameter) < inf
    return fits, f"bore_diameter: {bore_diameter} is neither 0 (a solid gear) nor positive and finite"


def input_checks(gear: Any, positive: tuple[str, ...], finite: tuple[str, ...]) -> Iterator[tuple[bool, str]]:
    """Checks of lengths that are to be positive (where they are given), of finite numbers, of the pressure angle."""
    for key in positive:
        value = getattr(gear, key)
        yield value is None or 0.0 < real(value) < inf, f"{key}: {value} is not positive and finite"
    for key in finite:
        yield isfinite(real(getattr(gear, key))), f"{key}: {getattr(gear, key)} is not finite"
    angle = real(gear.pressure_angle)
    allowed = SMALLEST_PRESSURE_ANGLE <= angle <= LARGEST_PRESSURE_ANGLE
    yield allowed, f"pressure_angle: {plain(angle, 6)} rad is not between 0.0175 and 0.785 rad (1 to 45 deg)"


def face_check(face_width: float, length: float, name: str) -> tuple[bool, str]:
    """Check of a face width against the module, or another length, that is called so."""
    least = LEAST_FACE * length
    short = 0.0 < real(face_width) < least
    return not short, f"face_width: {face_width} mm is below {plain(LEAST_FACE, 6)} {name}, {plain(least)} mm"


def topping_check(gear: Any) -> tuple[bool, str]:
    """Check of a tool that cuts the tips, too: nothing else says where they are."""
    free = gear.tip_diameter is None and gear.tip_alteration_coefficient == 0.0
    return free or not gear.topping, "topping: true beside a tip_diameter or a tip_alteration_coefficient"


def half_turn_checks(**angles: float | None) -> Iterator[tuple[bool, str]]:
    """Checks of angles, where they are given: each lies between 0 and 180 deg."""
    for key, angle in angles.items():
        if angle is not None:
            yield 0.0 < real(angle) < pi, f"{key}: {plain(real(angle), 6)} rad is not between 0 and 3.142 rad (180 deg)"


def spiral_check(key: str, angle: float) -> tuple[bool, str]:
    """Check of a helix or spiral angle of either hand."""
    return abs(
        real(angle)
    ) < LARGEST_SPIRAL_ANGLE, f"{key}: {plain(real(angle), 6)} rad is not within 1.047 rad (60 deg)"


def pair_checks(pinion: Any, wheel: Any, lengths: tuple[str, ...], spiral: str) -> Iterator[tuple[bool, str]]:
    """Checks of the lengths and the pressure angle that a pair has in common, and of its hands."""
    for key in lengths:
        one, other = getattr(pinion, key), getattr(wheel, key)
        yield isclose(one, other, rel_tol=_EQUAL), f"{key}: {one} and {other} mm must be equal"
    for key, sign, demand in (("pressure_angle", 1.0, "equal"), (spiral, -1.0, "opposite hands of one angle")):
        one, other = degrees(getattr(pinion, key)), degrees(getattr(wheel, key))
        yield (
            isclose(one, sign * other, rel_tol=_EQUAL),
            f"{key}: {plain(one, 6)} and {plain(other, 6)} deg must be {demand}",
        )
