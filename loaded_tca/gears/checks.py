"""What is wrong with the numbers that a gear is given by, each looked at by itself."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isfinite, radians
from typing import Any

SMALLEST_PRESSURE_ANGLE, LARGEST_PRESSURE_ANGLE = radians(1), radians(45)
LARGEST_SPIRAL_ANGLE = radians(60)
"""Of helices too."""


def teeth_checks(*teeth: float) -> Iterator[tuple[bool, str]]:
    """Checks for ``require``: every number of teeth is a whole one from 3 on."""
    for count in teeth:
        whole = isfinite(count) and count == int(count) and count >= 3
        yield whole, f"teeth: {count} is not a whole number from 3 on"


def input_checks(gear: Any, positive: tuple[str, ...], finite: tuple[str, ...]) -> Iterator[tuple[bool, str]]:
    """Checks of lengths that are to be positive (where they are given), of finite numbers, of the pressure angle."""
    for key in positive:
        value = getattr(gear, key)
        yield value is None or 0.0 < value < inf, f"{key}: {value} is not positive and finite"
    for key in finite:
        yield isfinite(getattr(gear, key)), f"{key}: {getattr(gear, key)} is not finite"
    angle = gear.pressure_angle
    allowed = SMALLEST_PRESSURE_ANGLE <= angle <= LARGEST_PRESSURE_ANGLE
    yield allowed, f"pressure_angle: {angle:.6g} rad is not between 0.0175 and 0.785 rad (1 to 45 deg)"
