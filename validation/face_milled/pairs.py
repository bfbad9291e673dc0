"""Face-milled pairs of the comparisons: SpyGO's 19 x 62, the duplex paper's 20 x 30 as printed and mended, others.

The others have settings that follow from their blanks alone.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import acos, atan2, cos, radians, sin, tan

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from loaded_tca.gears import BevelBlank
from loaded_tca.gears.basic_settings import duplex_spread_blade, spread_blade
from loaded_tca.gears.face_milled import Blade, Cutter, FaceMilledBlank, FaceMilledGear, FlankName, MachineSettings
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import ContactPath, trace_contact
from validation.bevel.iso_23509_sample import spygo

Gears = tuple[FaceMilledGear, FaceMilledGear]

DUPLEX_TEETH, DUPLEX_SPIRAL = (20, 30), 35.0
DUPLEX_ROOT, DUPLEX_ROLL = (31.09059, 52.51677), (1.802776, 1.20185)
DUPLEX_RADIAL, DUPLEX_CUTTER_RADIUS, DUPLEX_NUMBER = 58.38392, 44.45, 11
MENDED_RADIAL = 57.1394
MEAN_CONE_DISTANCE, FACE_WIDTH, CLEARANCE = 70.6007, 20.0, 0.564
CUTTER_RADIUS = 60.0
ARCSEC = np.degrees(3600.0)
DUPLEX_ASSUMED = "R_m 70.6007, b 20, point width 0, face cones parallel to the mating gear's root cones at 0.564 mm"


def duplex_paper_gears(pinion_radial: float = DUPLEX_RADIAL) -> Gears:
    """Pair of the duplex paper; with the radial setting 57.1394 of the pinion it becomes the mended pair D."""
    radials = pinion_radial, DUPLEX_RADIAL
    pinion, wheel = (_duplex_gear(member, radials[member]) for member in (0, 1))
    return pinion, wheel


def _duplex_gear(member: int, radial: float) -> FaceMilledGear:
    teeth, pitch, root = DUPLEX_TEETH[member], _duplex_pitch(member), radians(DUPLEX_ROOT[member])
    face = pitch + _duplex_pitch(1 - member) - radians(DUPLEX_ROOT[1 - member])
    along = MEAN_CONE_DISTANCE * cos(pitch - root)
    cradle = acos((radial**2 + along**2 - DUPLEX_CUTTER_RADIUS**2) / (2.0 * radial * along))
    blade = Blade(DUPLEX_CUTTER_RADIUS, radians(20.0))
    return FaceMilledGear(
        teeth,
        FaceMilledBlank(
            outer_cone_distance=MEAN_CONE_DISTANCE + 0.5 * FACE_WIDTH,
            face_width=FACE_WIDTH,
            pitch_angle=pitch,
            face_angle=face,
            root_angle=root,
            hand=("left", "right")[member],  # type: ignore[arg-type]
            face_apex=-CLEARANCE / sin(face),
        ),
        Cutter(blade, blade, DUPLEX_NUMBER),
        MachineSettings(radial, cradle, root, DUPLEX_ROLL[member]),
        name=("pinion", "wheel")[member],
    )


def _duplex_pitch(member: int) -> float:
    return atan2(DUPLEX_TEETH[member], DUPLEX_TEETH[1 - member])


def spygo_gears() -> Gears:
    """19 x 62 as published; the point radius of the wheel's inside blade is inferred from that of the outside one."""
    pinion, wheel = spread_blade(spygo())
    printed = replace(pinion.machine, machine_centre_to_back=-0.001306, sliding_base=0.0)
    return (
        replace(pinion, machine=printed, cutter=_cutter((95.951739019, 94.548260981), None, 0.20845)),
        replace(wheel, cutter=_cutter((96.439269791, 94.060730209), 500.0, 0.0)),
    )


def _cutter(point_radii: tuple[float, float], blade_radius: float | None, edge_radius: float) -> Cutter:
    outside, inside = (Blade(radius, radians(20.0), blade_radius, edge_radius) for radius in point_radii)
    return Cutter(concave=outside, convex=inside)


def matched_spygo_gears() -> Gears:
    """The matched pair B: the pinion's outside blade and radial setting chosen for the drive side."""
    pinion, wheel = spygo_gears()
    blade = Blade(93.5, radians(18.3430), None, 0.20845)
    machine = replace(pinion.machine, radial=96.8771)
    return replace(pinion, cutter=Cutter(concave=blade), machine=machine), wheel


def duplex_paper_blank() -> BevelBlank:
    """Blank with the dedendum angles of the duplex paper, and the spiral angle that they belong to."""
    angles = tuple(_duplex_pitch(member) - radians(DUPLEX_ROOT[member]) for member in (0, 1))
    return replace(duplex_blank("standard", 80.0), wheel_angles=angles)


def duplex_blank(taper: str = "duplex", cutter_radius: float = CUTTER_RADIUS) -> BevelBlank:
    """Blank 20 x 30 of the size of the duplex paper's pair, with the taper that the duplex method is meant for."""
    return BevelBlank(
        DUPLEX_TEETH,
        5.0,
        FACE_WIDTH,
        spiral_angle=radians(DUPLEX_SPIRAL),
        cutter_radius=cutter_radius,
        taper=taper,  # type: ignore[arg-type]
        allow_undercut=True,
    )


def duplex_gears() -> Gears:
    """Duplex spread blade settings straight from that blank."""
    return duplex_spread_blade(duplex_blank(), edge_radius=0.5)


def conjugate_gears() -> Gears:
    """Teeth of uniform depth whose blades, concave pinion and convex wheel, sweep one and the same crown gear."""
    blank = duplex_blank("uniform")
    pinion, wheel = spread_blade(blank)
    return (
        replace(pinion, cutter=Cutter(concave=_on_pitch_plane(pinion, "concave", -blank.pinion.mean_dedendum))),
        replace(wheel, cutter=Cutter(convex=_on_pitch_plane(wheel, "convex", blank.wheel.mean_dedendum))),
    )


def _on_pitch_plane(gear: FaceMilledGear, flank: FlankName, depth: float) -> Blade:
    """Blade whose cutting edge has the nominal cutter radius at the height of the pitch plane."""
    blade = gear.cutter.blade(flank)
    return replace(blade, point_radius=CUTTER_RADIUS + depth * tan(blade.blade_angle))


@cache
def error_from_top(pair: GearPair, parts: tuple[float, ...]) -> tuple[float, NDArray[np.float64], ContactPath]:
    """Top of the transmission error of one tooth pair, and the fall from there.

    The top is where the levers of the normal have the ratio of the teeth, d phi2/d phi1 = z1/z2. Levers that have it
    nowhere beside the largest of a coarse row of errors are wrong; then the numbers are those of a place beside it.

    Parameters
    ----------
    parts : (n,) floats
        Parts of a pitch before and after the top.

    Returns
    -------
    top : float [rad]
        Pinion angle.
    fall : (n,) array [arcsec]
    path : ContactPath
        At the top.
    """

    def excess(angle: float) -> float:
        contact = trace_contact(pair, [angle], warn=False)
        return float(contact.pinion_lever[0] / contact.wheel_lever[0]) - pair.ratio

    angles = np.linspace(-1.5, 1.5, 31) * pair.pitch
    coarse = int(np.nanargmax(trace_contact(pair, angles, warn=False).transmission_error))
    beside = angles[max(coarse - 1, 0)], angles[min(coarse + 1, len(angles) - 1)]
    changes = excess(beside[0]) * excess(beside[1]) < 0.0
    top = brentq(excess, *beside, xtol=1e-12) if changes else min(beside, key=lambda angle: abs(excess(angle)))
    error = trace_contact(pair, [top, *(top + part * pair.pitch for part in parts)], warn=False).transmission_error
    return top, (error[1:] - error[0]) * ARCSEC, trace_contact(pair, [top], warn=False)
