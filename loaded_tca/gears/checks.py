"""What is wrong with the numbers that a gear is given by, each looked at by itself."""

from __future__ import annotations

from math import inf, isfinite, radians
from typing import Any

SMALLEST_PRESSURE_ANGLE, LARGEST_PRESSURE_ANGLE = radians(1), radians(45)
LARGEST_SPIRAL_ANGLE = radians(60)
"""Of helices too."""


def teeth_problems(*teeth: float) -> list[str]:
    """A problem for each number of teeth that is not a whole one from 3 on."""
    return [
        f"teeth: {count} is not a whole number from 3 on"
        for count in teeth
        if not (isfinite(count) and count == int(count) and count >= 3)
    ]


def input_problems(gear: Any, positive: tuple[str, ...], finite: tuple[str, ...]) -> list[str]:
    """Problems of lengths that are to be positive (where they are given), of finite numbers, of the pressure angle."""
    values, pressure_angle = vars(gear), gear.pressure_angle
    lengths = {key: values[key] for key in positive if values[key] is not None}
    problems = [f"{key}: {value} is not positive and finite" for key, value in lengths.items() if not 0.0 < value < inf]
    problems += [f"{key}: {values[key]} is not finite" for key in finite if not isfinite(values[key])]
    if not SMALLEST_PRESSURE_ANGLE <= pressure_angle <= LARGEST_PRESSURE_ANGLE:
        problems.append(f"pressure_angle: {pressure_angle:.6g} rad is not between 0.0175 and 0.785 rad (1 to 45 deg)")
    return problems
