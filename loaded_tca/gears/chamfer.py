"""Chamfers of tip edges, by height and angle: where the flank ends, and what is left of the tip.

A chamfer begins on the flank at the tip form circle, its height below the tip circle, and runs straight to the tip,
inclined towards the middle of the tooth. Nothing of it touches the mating gear. Lengths are in mm, angles in rad.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import asin, atan2, cos, degrees, pi, radians, sin, sqrt
from typing import TYPE_CHECKING

from loaded_tca.arrays import real
from loaded_tca.errors import GeometryError
from loaded_tca.plain import plain

if TYPE_CHECKING:
    from loaded_tca.gears.tooth_measures import MeasuredGear

DEFAULT_ANGLE = radians(45.0)


def chamfer_checks(gear: MeasuredGear) -> Iterator[tuple[bool, str]]:
    """Checks of the numbers that give a chamfer."""
    height, angle = real(gear.tip_chamfer), gear.tip_chamfer_angle
    most = gear.normal_module
    yield (
        0.0 <= height < most,
        f"tip_chamfer: {plain(height, 6)} mm is not from 0 to below a module, {plain(most, 6)} mm",
    )
    fits = angle is None or 0.0 < real(angle) < 0.5 * pi
    yield fits, f"tip_chamfer_angle: {angle} rad is not between 0 and 1.571 rad (90 deg)"


def chamfered_land(gear: MeasuredGear) -> float:
    """Width of the tip between the chamfers of both flanks, an arc; negative where they cross below the tip [mm]."""
    start, tip = gear.tip_form_radius, gear.tip_radius
    angle = DEFAULT_ANGLE if gear.tip_chamfer_angle is None else gear.tip_chamfer_angle
    half, side = 0.5 * gear.tooth_thickness_at(start) / start, 1.0 if gear.teeth > 0 else -1.0
    x, y = start * cos(half), start * sin(half)
    along = side * x * cos(angle) - y * sin(angle)
    square = along**2 + (tip - start) * (tip + start)
    if square < 0.0:
        return -2.0 * abs(tip - start)  # never comes to the tip circle of a ring
    length = side * sqrt(square) - along
    return 2.0 * tip * asin((y - length * sin(angle)) / tip)


def tip_half_angle(gear: MeasuredGear) -> float:
    """Half the angle of the tip between its corners, those of its chamfers where it has some [rad]."""
    tip = gear.tip_radius
    return 0.5 * (chamfered_land(gear) if gear.tip_chamfer else gear.tooth_thickness_at(tip)) / tip


def _angle_of_flank(gear: MeasuredGear) -> float:
    """Angle between the middle of the tooth and the chord of the flank from the tip form circle to the tip [rad]."""
    radii = gear.tip_form_radius, gear.tip_radius
    halves = [0.5 * gear.tooth_thickness_at(radius) / radius for radius in radii]
    (x, y), (tip_x, tip_y) = ((r * cos(half), r * sin(half)) for r, half in zip(radii, halves, strict=True))
    return atan2(y - tip_y, abs(tip_x - x))


def check_chamfer(gear: MeasuredGear) -> None:
    """Refuse a chamfer that leaves no flank or no tip, or that stands out of the flank.

    Raises
    ------
    GeometryError
    """
    if gear.tip_chamfer == 0.0:
        return
    start, form = gear.tip_form_radius, gear.form_radius
    if (start - form) * gear.teeth <= 0.0:
        raise GeometryError(
            f"{gear.name}: tip_chamfer: {plain(gear.tip_chamfer, 6)} mm leaves no flank: the tip form circle, diameter "
            f"{2.0 * start:.4f} mm, does not lie beyond the root form circle, diameter {2.0 * form:.4f} mm"
        )
    land = chamfered_land(gear)
    if land <= 0.0:
        raise GeometryError(
            f"{gear.name}: tip_chamfer: {plain(gear.tip_chamfer, 6)} mm leaves nothing of the tip: the chamfers of "
            "both flanks meet below it; reduce tip_chamfer or tip_chamfer_angle"
        )
    if land >= gear.tooth_thickness_at(gear.tip_radius):
        raise GeometryError(
            f"{gear.name}: tip_chamfer_angle: the chamfer stands out of the flank, which leans further towards the "
            f"middle of the tooth; an angle above {degrees(_angle_of_flank(gear)):.2f} deg fits"
        )
