"""What the reduced-TCA dissertation says of its Figures 17 to 30, and whether a computation agrees."""

from dataclasses import dataclass
from math import degrees, radians

import numpy as np

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.teeth import trace_teeth
from validation.unloaded.mounting_error_pairs import (
    ARCSEC,
    ERRORS,
    FORMS,
    HELICAL,
    LARGEST,
    POSITIONS,
    SPUR,
    Array,
    Gears,
    hertz_pressure,
    shift,
)

ALIKE = 0.1
"""Relative difference of two heights up to which "similar" and "not significantly different" are said to hold."""


@dataclass(frozen=True)
class Trend:
    """A statement of the source, whether it holds here, and the numbers that say so."""

    figure: str
    statement: str
    holds: bool
    because: str


def trends() -> list[Trend]:
    """Every statement on the figures of cylindrical gears that a computation can judge."""
    return [
        *_trends_of_spur_pair(),
        _crowning_for_continuity(),
        *_trends_of_paths(),
        _area_of_forms(),
        _onset_of_edge_contact(),
        *_trends_of_pressure(),
    ]


def _trends_of_spur_pair() -> list[Trend]:
    relief = {
        f"{end}_relief{what}": value
        for end, start in (("tip", 25.6), ("root", 24.6))
        for what, value in (("", 0.02), ("_start", start))
    }
    plain = {error: trace_teeth(SPUR.pair(Mounting(**{error: LARGEST[SPUR][error]}))) for error in ERRORS}
    mounts = {"in": Mounting(in_plane=0.0175), "out": Mounting(out_of_plane=0.0175), "both": Mounting(0.0175, 0.0175)}
    meshes = {name: trace_teeth(SPUR.pair(mounting, **relief)) for name, mounting in mounts.items()}
    sides = [bool(mesh.leading_contact.edges[:, [2, 3, 6, 7]].any()) for mesh in plain.values()]
    heights = {name: mesh.peak_to_peak * ARCSEC for name, mesh in meshes.items()}
    shifts = ", ".join(f"{e} {m.leading_contact.pinion_axial[POSITIONS // 2]:+.2f} mm" for e, m in plain.items())
    size = ", ".join(f"{error} {mesh.peak_to_peak * ARCSEC:.2g}" for error, mesh in plain.items())
    unlike = {name: heights[name] / heights["out"] - 1.0 for name in ("in", "both")}
    relieved = f"parabolic reliefs of 20 um (assumed): {heights['out']:.4g} arcsec out-of-plane,"
    return [
        Trend("17", "spur: lead crowning keeps every misaligned contact off the sides", not any(sides), shifts),
        *(
            Trend(
                "17",
                f"spur: but leads to a discontinuous transmission under {kind} errors",
                not any(plain[error].is_continuous for error in errors),
                f"peak to peak {size} arcsec",
            )
            for kind, errors in (("angular", ERRORS[:2]), ("linear", ERRORS[2:]))
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


def _smallest_profile_crowning(error_deg: float) -> float:
    """Profile crowning [mm] above which the helical pair has a continuous transmission error, by bisection."""
    low, high = 0.0, 0.05
    mounting = Mounting(out_of_plane=radians(error_deg))
    for _ in range(7):
        middle = 0.5 * (low + high)
        smooth = trace_teeth(HELICAL.pair(mounting, profile_crowning=middle)).is_continuous
        low, high = (low, middle) if smooth else (middle, high)
    return high


def _crowning_for_continuity() -> Trend:
    angles = (0.05, 0.1, 0.2)
    needed = [1e3 * _smallest_profile_crowning(angle) for angle in angles]
    smooth = [
        trace_teeth(HELICAL.pair(Mounting(out_of_plane=radians(0.05)), lead_crowning=c)).is_continuous
        for c in (0.05, 0.5, 2.27)
    ]
    listed = ", ".join(f"{angle} deg {amount:.2g} um" for angle, amount in zip(angles, needed, strict=True))
    return Trend(
        "23",
        "helical: the crowning needed for a continuous function falls as the misalignment grows",
        any(smooth) and needed[-1] < needed[0],
        f"lead crowning of 50, 500, 2270 um alone: continuous {smooth}; profile crowning needed: {listed}",
    )


def _trends_of_paths() -> list[Trend]:
    names = ("in_plane", "out_of_plane")
    angles = (0.05, 0.1, 0.2)
    table = {
        (name, form): [shift(HELICAL, Mounting(**{name: radians(a)}), lead_crowning_form=form) for a in angles]
        for name in names
        for form in FORMS
    }
    grows = all((np.diff(np.abs(row)) > 0.0).all() for row in table.values())
    circle = abs(table["in_plane", "circular"][2] / table["in_plane", "parabolic"][2] - 1.0)
    logarithmic = table["in_plane", "logarithmic"][2] / table["in_plane", "parabolic"][2]
    ratio = abs(table["out_of_plane", "parabolic"][2] / table["in_plane", "parabolic"][2])
    spur = Gears("spur", HELICAL.teeth, 0.0, HELICAL.face_width, HELICAL.crowning, HELICAL.load, HELICAL.material)
    mounting = Mounting(out_of_plane=radians(0.2))
    larger = shift(HELICAL, mounting) / shift(spur, mounting)
    return [
        Trend("25, 27", "helical: the path moves away from the middle as the angle grows", grows, "all three forms"),
        Trend(
            "25",
            "helical: the forms give similar paths",
            circle < 0.01 and logarithmic < 1.1,
            f"circular within {circle:.1e} of parabolic; logarithmic {logarithmic:.2f} times as far, being flatter in "
            "the middle for the same amount at the ends",
        ),
        Trend(
            "25, 27",
            "helical: out-of-plane errors move the path more than in-plane ones",
            ratio > 1.0,
            f"{ratio:.3f} times, as 1/tan(alpha_t)",
        ),
        Trend(
            "27",
            "the path of a helical pair moves much more than that of a spur pair",
            larger > 1.5,
            f"{larger:.3f} times at the same crowning: cos(alpha_t)/(cos(alpha) cos(beta_b)) only",
        ),
    ]


def _area_of_forms() -> Trend:
    mounting = Mounting(out_of_plane=radians(0.2))
    steps = np.linspace(0.0, 0.01, 2)
    lines = [
        trace_contact(HELICAL.pair(mounting, lead_crowning_form=form), steps).transmission_error * ARCSEC
        for form in FORMS
    ]
    triangle = [0.5 * float(line[1] - line[0]) * 0.01 for line in lines]
    spread = (max(triangle) - min(triangle)) / max(triangle)
    return Trend(
        "24, 26",
        "helical: logarithmic crowning has the smallest area S of the transmission function",
        spread > 0.01,
        f"the function is one straight line whatever the crowning: areas over 0.01 rad differ by {spread:.1e}",
    )


def _onset_of_edge_contact() -> Trend:
    amount, angles = 0.02, np.radians([0.1, 0.2, 0.4, 0.8, 1.6])

    def first(form: str) -> float:
        for angle in angles:
            pair = HELICAL.pair(Mounting(out_of_plane=angle), lead_crowning=amount, lead_crowning_form=form)
            if trace_contact(pair, [0.0]).on_edge[0]:
                return degrees(angle)
        return float("inf")

    onset = {form: first(form) for form in FORMS}
    return Trend(
        "28",
        "helical: logarithmic crowning bears much larger angles before it comes to an edge",
        onset["logarithmic"] > 2.0 * onset["circular"],
        f"crowned 20 um, first on the side, of {np.degrees(angles).round(1).tolist()} deg, at {onset['circular']:.1f} "
        f"(circular) and {onset['logarithmic']:.1f} (logarithmic; inf: at none)",
    )


def _pressures(gears: Gears, mounting: Mounting, form: str, points: int = 7) -> Array:
    """Hertz pressure along the surface contact of one tooth pair [MPa]."""
    pair = gears.pair(mounting, lead_crowning_form=form)
    path = trace_contact(pair, np.linspace(-0.7, 0.7, points) * pair.pitch)
    return np.array([hertz_pressure(pair, path[i], gears.load) for i in range(points)])


def _trends_of_pressure() -> list[Trend]:
    spur = _pressures(SPUR, Mounting(in_plane=0.0175), "parabolic")
    helical = _pressures(HELICAL, Mounting(out_of_plane=radians(0.2)), "circular")
    table = {
        form: [_pressures(HELICAL, Mounting(out_of_plane=radians(a)), form, 3)[1] for a in (0.01, 0.05, 0.2)]
        for form in FORMS
    }
    change = {form: row[-1] / row[0] - 1.0 for form, row in table.items()}
    listed = ", ".join(f"{form} {value:+.1%}" for form, value in change.items())
    ends = [float(row[0] / row[len(row) // 2] - 1.0) for row in (spur, spur[::-1])]
    foot, head = (float(helical[k] / helical[len(helical) // 2] - 1.0) for k in (0, -1))
    along = f"{head:+.1%} towards the tip, {foot:+.1%} towards the root of the pinion, against the pitch point"
    return [
        Trend(
            "21, 22",
            "spur: the pressure is highest at the top and the bottom of the tooth",
            min(ends) > 0.0,
            f"{ends[0]:+.1%} towards the root, {ends[1]:+.1%} towards the tip of the pinion, against the pitch point",
        ),
        Trend(
            "29",
            "helical: the pressure falls with the angle from 0.01 deg on",
            max(change.values()) < 0.0,
            f"from 0.01 to 0.2 deg at one crowning: {listed}; in the source the crowning shrinks as the angle grows",
        ),
        Trend(
            "29",
            "helical: at 0.2 deg the logarithmic crowning has a distinctly higher pressure for its curvature",
            change["logarithmic"] > 2.0 * max(change["circular"], change["parabolic"], 0.0),
            listed,
        ),
        Trend("30", "helical: the pressure is higher in the upper part of the tooth", head > foot, along),
        Trend(
            "30",
            "helical: and falls along the path from there to the lower part",
            bool((np.diff(helical) > 0.0).all()),
            f"{along}: lowest between them" if min(head, foot) > 0.0 else along,
        ),
    ]
