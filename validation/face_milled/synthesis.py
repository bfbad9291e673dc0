"""Settings by local synthesis beside what was asked for, by the five contact equations of the surfaces that they cut.

The pair of ``examples/scenes/face_milled_blank.toml``, on its axes that meet. All that the equations get are the
numbers that ``loaded-tca settings`` writes, and the pitch cones of teeth and shaft angle; what they are compared with
is what the scene asks for. The motion curve is a parabola at the mean point alone: its second derivative is that of
differences over a hundredth of a pitch to either side, whose fourth derivative leaves 3e-6 of it; chords of the path
leave 0.001 deg.
"""

from __future__ import annotations

from math import atan2, cos, degrees, pi, radians, sin, sqrt
from pathlib import Path

import numpy as np

from loaded_tca.scene import read_scene
from loaded_tca.scene.blank_face_milled import BlankFaceMilledScene
from validation.face_milled.hypoid_axes import Housing, Sheet, Surface
from validation.table import Row

SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "face_milled_blank.toml"
CASE, EQUATIONS = "local synthesis 14/39", "asked for; five equations"
STEP = 0.01
"""Parts of a pitch."""
MARKING = 0.00635
"""Approach at which the length of the contact ellipse is asked for [mm]."""
BOTH = {"pair.settings.both_flanks": True}
OTHER = {"concave": "convex", "convex": "concave"}
OF_MOTION, OF_PATH, OF_LENGTH = 1e-5, 2e-3, 4e-6
"""Relative; [deg]; relative: three times what differences and chords leave."""


def rows() -> list[Row]:
    """The concave flank alone, then both flanks of the pinion in one pass."""
    return [*short_rows(), *_of("concave", "both, concave", BOTH), *_of("convex", "both, convex", BOTH)]


def short_rows() -> list[Row]:
    """The concave flank."""
    return _of("concave", "concave", {})


def _of(flank: str, name: str, changes: dict[str, object]) -> list[Row]:
    scene = read_scene(SCENE).with_changes(changes)
    assert isinstance(scene, BlankFaceMilledScene)
    asked = scene.geometry.settings
    path_asked = asked.path_angle_deg if flank == "concave" else 180.0 - (asked.path_angle_deg or 0.0)
    housing = _housing(scene, flank)
    # a left-hand pinion that drives with its concave flank turns about -z
    sense = -1.0 if flank == "concave" else 1.0
    pitch = 2.0 * pi / scene.pinion.teeth
    turns = sense * STEP * pitch * np.array([-1.0, 0.0, 1.0])
    contacts = [housing.contact(float(turn)) for turn in turns]
    second = np.diff([sense * one[6] for one in contacts], 2)[0] / (STEP * pitch) ** 2
    fall = degrees(-second * pitch**2 / 8.0) * 3600.0
    wide, narrow = (housing.curvatures(0.0, contacts[1], stencil)[1] for stencil in (0.1, 0.05))
    along = (4.0 * narrow - wide) / 3.0  # the error of second order taken off
    length = sqrt(8.0 * MARKING / along)
    case = f"{CASE}, {name}"
    return [
        Row(case, EQUATIONS, "fall of the motion curve [arcsec]", asked.motion_fall_arcsec or 0.0, fall, OF_MOTION),
        Row(
            case,
            EQUATIONS,
            "path of contact [deg]",
            path_asked or 0.0,
            _path_angle(housing, contacts),
            OF_PATH / (path_asked or 1.0),
        ),
        Row(case, EQUATIONS, "length of the contact ellipse [mm]", asked.contact_length_mm or 0.0, length, OF_LENGTH),
    ]


def _path_angle(housing: Housing, contacts: list[np.ndarray]) -> float:
    """Direction of the path on the pinion, from its tooth trace at the heel over the tip [deg]."""
    pinion, delta = housing.surfaces[0], housing.sheet.pitch_angles[0]
    first, middle, last = (pinion.point(*one[:3]) for one in contacts)
    rho, z = housing.sheet.places[0]
    toe, heel = (pinion.point(*pinion.at(rho * part, z * part, contacts[1][:3])) for part in (1.0 - 1e-4, 1.0 + 1e-4))
    trace, normal = (heel - toe) / np.linalg.norm(heel - toe), pinion.normal(contacts[1][:3])
    up = np.cross(normal, trace)
    azimuth = np.arctan2(middle[1], middle[0])
    outwards = np.array([np.cos(azimuth) * cos(delta), np.sin(azimuth) * cos(delta), -sin(delta)])
    up *= np.sign(up @ outwards)
    return degrees(atan2((last - first) @ up, (last - first) @ trace)) % 180.0


def _housing(scene: BlankFaceMilledScene, flank: str) -> Housing:
    teeth = scene.pinion.teeth, scene.wheel.teeth
    first = atan2(*teeth)
    blank = scene.cut.pinion.blank
    mean = blank.outer_cone_distance_mm - 0.5 * blank.face_width_mm
    sheet = Sheet(teeth, 0.0, (first, 0.5 * pi - first), (mean, mean))
    return Housing(sheet, _surface(scene.cut.pinion, flank), _surface(scene.cut.wheel, OTHER[flank]))


def _surface(gear: object, flank: str) -> Surface:
    """Surface of a gear after the numbers of its sections."""
    machine, cutter, hand = gear.machine, gear.cutter, gear.blank.hand  # type: ignore[attr-defined]
    blade = getattr(cutter, flank)
    turn = cutter.number / 6.0 * (1.0 if flank == "convex" else -1.0)
    return Surface(
        flank == "concave",
        hand == "left",
        {
            "radial": machine.radial_mm,
            "machine_centre_to_back": machine.machine_centre_to_back_mm,
            "sliding_base": machine.sliding_base_mm,
            "blank_offset": machine.blank_offset_mm,
            "cradle_angle": radians(machine.cradle_angle_deg),
            "root_angle": radians(machine.root_angle_deg),
            "tilt": radians(machine.tilt_deg),
            "swivel": radians(machine.swivel_deg),
            "ratio_of_roll": machine.ratio_of_roll,
            "modified_roll_2c": machine.modified_roll_2c,
            "helical_motion": machine.helical_motion_mm_per_rad,
            "point_radius": blade.point_radius_mm,
            "blade_angle": radians(blade.blade_angle_deg + turn),
        },
    )
