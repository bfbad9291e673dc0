"""What the reduced-TCA dissertation says of the spur pair under mounting errors, its Figures 10 to 22."""

from dataclasses import replace
from math import hypot

import numpy as np

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded.teeth import MeshPath, trace_teeth
from validation.unloaded.mounting_error_pairs import ARCSEC, ERRORS, LARGEST, POSITIONS, SPUR, pressures_along
from validation.unloaded.mounting_error_trends import ALIKE, Trend

SIDES = [2, 3, 6, 7]
"""Columns of a contact's edges: the sides of pinion and wheel."""
RELIEF = {
    f"{end}_relief{what}": value
    for end, start in (("tip", 25.6), ("root", 24.6))
    for what, value in (("", 0.02), ("_start", start))
}
"""Parabolic tip and root relief of the spur pair [mm], starts as diameters: assumed."""


def trends() -> list[Trend]:
    """Every statement on the spur pair that a computation can judge, in the figures' order."""
    return [*trends_without_relief(), *_trends_of_misaligned_pair(), *trends_of_spur_pressure()]


def trends_without_relief() -> list[Trend]:
    """Figures 10, 11, 15 and 16: the spur pair under an in-plane error, unmodified and with parabolas alone."""
    mounting = Mounting(in_plane=LARGEST[SPUR]["in_plane"])
    bare = trace_teeth(SPUR.pair(mounting, lead_crowning=0.0))
    across = trace_teeth(SPUR.pair(Mounting(out_of_plane=LARGEST[SPUR]["out_of_plane"]), lead_crowning=0.0))
    sides = bare.leading_contact.edges[:, SIDES].any(axis=-1)
    profile = SPUR.mesh.pinion_active_profile
    halves = {
        "lead_crowning": 0.5 * SPUR.face_width,
        "profile_crowning": 0.5 * (profile.end_roll_length - profile.start_roll_length),
    }
    along = {
        (a1, name): trace_teeth(SPUR.pair(mounting, **{name: a1 * half**2}))
        for a1 in (0.00125, 0.01675)
        for name, half in halves.items()
    }
    listed = {
        a1: "; ".join(
            f"as {name.replace('_', ' ')} {1e3 * a1 * half**2:.0f} um: {_motion(along[a1, name])}"
            for name, half in halves.items()
        )
        for a1 in (0.00125, 0.01675)
    }
    return [
        Trend(
            "10",
            "spur: an angular error of unmodified gears makes the transmission discontinuous",
            not bare.is_continuous,
            f"in-plane: {_motion(bare)}; not so out-of-plane: {_motion(across)}",
        ),
        Trend(
            "11",
            "spur: and puts the path on the edge of the flank, in-plane",
            bool(sides.all()),
            f"on a side for {sides.mean():.0%} of the pitch, z = "
            f"{bare.leading_contact.pinion_axial[POSITIONS // 2]:+.2f} mm of ±{0.5 * SPUR.face_width:g}",
        ),
        Trend(
            "15",
            "spur: a parabola a1 = 0.00125/mm is not enough: the transmission is discontinuous",
            not along[0.00125, "lead_crowning"].is_continuous,
            listed[0.00125],
        ),
        Trend(
            "16",
            "spur: a1 = 0.01675/mm is enough: the transmission is continuous",
            along[0.01675, "lead_crowning"].is_continuous,
            f"{listed[0.01675]}. Lead crowning alone is never enough; along the profile the amount of Figure 15 is",
        ),
    ]


def _motion(mesh: MeshPath) -> str:
    return f"{'' if mesh.is_continuous else 'dis'}continuous, {mesh.peak_to_peak * ARCSEC:.3g} arcsec"


def _trends_of_misaligned_pair() -> list[Trend]:
    plain = {error: trace_teeth(SPUR.pair(Mounting(**{error: LARGEST[SPUR][error]}))) for error in ERRORS}
    aligned, across = SPUR.pair(), LARGEST[SPUR]["axial_offset"]
    plain["offset_along_y"] = trace_teeth(replace(aligned, wheel_origin=aligned.wheel_origin + across * np.eye(3)[1]))
    mounts = {"in": Mounting(in_plane=0.0175), "out": Mounting(out_of_plane=0.0175), "both": Mounting(0.0175, 0.0175)}
    meshes = {name: trace_teeth(SPUR.pair(mounting, **RELIEF)) for name, mounting in mounts.items()}
    sides = [bool(mesh.leading_contact.edges[:, SIDES].any()) for mesh in plain.values()]
    heights = {name: mesh.peak_to_peak * ARCSEC for name, mesh in meshes.items()}
    shifts = ", ".join(
        f"{error.replace('_', ' ')} {round(mesh.leading_contact.pinion_axial[POSITIONS // 2], 2) + 0.0:+.2f}"
        for error, mesh in plain.items()
    )
    linear = (*ERRORS[2:], "offset_along_y")
    size = {
        error: f"{error.replace('_', ' ')} {round(mesh.peak_to_peak * ARCSEC, 6):.2g}" for error, mesh in plain.items()
    }
    unlike = {name: heights[name] / heights["out"] - 1.0 for name in ("in", "both")}
    relieved = f"parabolic reliefs of 20 um (assumed): {heights['out']:.4g} arcsec out-of-plane,"
    turned = plain["offset_along_y"].mean * ARCSEC
    both = (
        "the source calls ΔH an axial offset (along z), out of plane, along y: along z it moves the wheel under the "
        f"crowning of the pinion; along y it turns the line of centres, a constant {turned:.0f} arcsec, and opens the "
        f"centre distance by {1e3 * (hypot(aligned.wheel_origin[0], across) - aligned.wheel_origin[0]):.2g} um: "
        "neither disturbs the motion"
    )
    return [
        Trend(
            "17", "spur: lead crowning keeps every misaligned contact off the sides", not any(sides), f"z = {shifts} mm"
        ),
        *(
            Trend(
                "17",
                f"spur: but leads to a discontinuous transmission under {kind} errors",
                not any(plain[error].is_continuous for error in errors),
                f"peak to peak {', '.join(size[error] for error in errors)} arcsec{more}",
            )
            for kind, errors, more in (
                ("angular", ERRORS[:2], ""),
                ("linear", linear, f"; {both}"),
            )
        ),
        Trend(
            "18, 19",
            "spur: tip and root relief makes the transmission continuous",
            all(mesh.is_continuous for mesh in meshes.values()),
            "for both angles and both together; parabolic reliefs of 20 um (assumed)",
        ),
        Trend(
            "19",
            f"spur: the transmission function is alike for both angles, to {ALIKE:.0%}",
            abs(unlike["in"]) < ALIKE,
            f"{relieved} {unlike['in']:+.1%} in-plane",
        ),
        Trend(
            "20",
            f"spur: both angles together hardly change the transmission function, to {ALIKE:.0%}",
            abs(unlike["both"]) < ALIKE,
            f"{relieved} {unlike['both']:+.1%} with both",
        ),
    ]


def trends_of_spur_pressure() -> list[Trend]:
    """Figures 21 and 22: pressure along the path under an in-plane error, without and with tip and root relief."""
    found = []
    for figure, what, modifications in (("21", "lead crowning", {}), ("22", "lead crowning and relief", RELIEF)):
        pressure = pressures_along(SPUR, Mounting(in_plane=0.0175), **modifications)
        foot, head = (float(pressure[k] / pressure[len(pressure) // 2] - 1.0) for k in (0, -1))
        found.append(
            Trend(
                figure,
                f"spur, {what}: the pressure is highest at the top and the bottom of the tooth",
                min(foot, head) > 0.0,
                f"{foot:+.1%} towards the root, {head:+.1%} towards the tip of the pinion, against the pitch point",
            )
        )
    return found
