"""Face-milled scenes with a hypoid offset: what their blanks have to fulfil, and the pitch cones that follow.

Apexes of face and root cones and the machine centre to back of a hypoid scene count from the crossing point of its
axis, as on a dimension sheet and a summary of settings. Inside the package they count from the pitch apex, which lies
at t_z beyond it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import degrees, radians

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError
from loaded_tca.gears.face_milled import FaceMilledGear
from loaded_tca.gears.hypoid import HypoidCones, HypoidMesh
from loaded_tca.plain import plain
from loaded_tca.scene.section import Rule

ROUNDED_deg = 0.01
"""By how much the pitch angle of a pinion may miss the one that closes the axes, as sheets round their numbers."""


def where_axes_meet(demand: Rule) -> Rule:
    """Return a rule that holds for pairs without an offset alone."""

    def complain(*values: object) -> str | None:
        return None if values[-1] else demand.complain(*values[:-1])

    return Rule((*demand.keys, "pair.offset_mm"), complain)


def mean_distance(outer: float, width: float, given: float | None) -> float:
    """Return R_m of a blank [mm]."""
    return outer - 0.5 * width if given is None else given


def _closes(offset: float, shaft_angle: float, *cones: float) -> str | None:
    """What is wrong with two blanks whose pitch cones do not touch on axes with this offset."""
    if not offset:
        return None
    (first, *pinion), (second, *wheel) = cones[:4], cones[4:]
    if _off_face(*pinion) or _off_face(*wheel):
        return None
    angles, distances = (radians(first), radians(second)), (mean_distance(*pinion), mean_distance(*wheel))
    try:
        closed = HypoidCones.closing(angles, distances, offset, radians(shaft_angle))
    except InputError as refused:
        reason = str(refused).removeprefix(f"offset: {plain(offset, 6)} mm is ")
        if reason == str(refused):
            reason = (
                f"with pair.shaft_angle_deg = {plain(shaft_angle, 6)} no pinion of pitch_angle_deg = {plain(first, 6)} "
                f"stands beside wheel.blank.pitch_angle_deg = {plain(second, 6)}"
            )
        return f"found {plain(offset, 6)}; {reason}"
    needed = degrees(closed.pitch_angles[0])
    if abs(needed - first) <= ROUNDED_deg:
        return None
    return (
        f"found {plain(offset, 6)}; with pair.shaft_angle_deg = {plain(shaft_angle, 6)} and these pitch cones the axes "
        f"close with pinion.blank.pitch_angle_deg = {needed:z.4f}, found {plain(first, 6)}, allowed within "
        f"{plain(ROUNDED_deg, 6)} of it"
    )


def _off_face(outer: float, width: float, given: float | None) -> str | None:
    """What is wrong with a calculation point that lies off the face."""
    if given is None or outer - width < given < outer:
        return None
    return (
        f"found {plain(given, 6)}; allowed on the face, between {plain(outer - width, 6)} and "
        f"outer_cone_distance_mm = {plain(outer, 6)}"
    )


CONES = ("pitch_angle_deg", "outer_cone_distance_mm", "face_width_mm", "calculation_cone_distance_mm")
CLOSED_AXES = Rule(
    (
        "pair.offset_mm",
        "pair.shaft_angle_deg",
        *(f"{gear}.blank.{name}" for gear in GEARS for name in CONES),
    ),
    _closes,
)
"""Of a face-milled scene."""

ON_FACE = Rule(
    ("calculation_cone_distance_mm", "outer_cone_distance_mm", "face_width_mm"),
    lambda given, outer, width: _off_face(outer, width, given),
)
"""Of a blank."""


@contextmanager
def offset_by_its_key() -> Iterator[None]:
    """Call the offset by its key in what is said of flanks that do not fit it."""
    try:
        yield
    except InputError as error:
        raise InputError(
            f"pair.offset_mm{problem.removeprefix('offset')}" if problem.startswith("offset:") else problem
            for problem in error.problems
        ) from None


def hypoid_mesh(
    gears: Callable[[tuple[float, float]], tuple[FaceMilledGear, FaceMilledGear]],
    angles: tuple[float, float],
    distances: tuple[float, float],
    offset: float,
    shaft_angle: float,
) -> HypoidMesh:
    """Return both gears on axes with an offset.

    Parameters
    ----------
    gears : callable
        Pitch angles [rad] -> gears, whose apexes count from the crossing points.
    angles : (float, float) [rad]
        Pitch angles; that of the pinion is made to close.
    distances : (float, float) [mm]
        R_m.
    offset : float [mm]
    shaft_angle : float [rad]
    """
    cones = HypoidCones.closing(angles, distances, offset, shaft_angle)
    pinion, wheel = (
        _from_pitch_apex(gear, beyond) for gear, beyond in zip(gears(cones.pitch_angles), cones.apexes, strict=True)
    )
    return HypoidMesh(pinion, wheel, shaft_angle, cones)


def _from_pitch_apex(gear: FaceMilledGear, beyond: float) -> FaceMilledGear:
    """The gear with what counts from the crossing point counted from the pitch apex, at t_z beyond it."""
    blank, machine = gear.blank, gear.machine
    return replace(
        gear,
        blank=replace(blank, face_apex=blank.face_apex - beyond, root_apex=blank.root_apex - beyond),
        machine=replace(machine, machine_centre_to_back=machine.machine_centre_to_back - beyond),
    )
