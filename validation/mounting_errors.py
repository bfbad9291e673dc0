"""What each mounting error does to contact path, transmission error and Hertz pressure.

The trends of the dissertation (Figures 17 to 30) for its spur pair 25/25 and its helical pair 40/37 with three forms of
lead crowning, each with a verdict, and a table of every error. The
dissertation compares forms of crowning of unlike amounts; here all forms remove the same at the ends of the face.

Run from the root of the repository: ``python -m validation.mounting_errors --out docs``.
"""

import argparse
import sys
from dataclasses import dataclass, fields
from math import cos, degrees, radians, sin, tan
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material
from loaded_tca.pair import GearPair, Mounting, cylindrical_pair
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded import ContactPoint, relative_curvature, trace_contact
from loaded_tca.unloaded.teeth import trace_teeth
from validation.table import Row

Array = NDArray[np.float64]
CASE = "Seed 000 mounting errors"
ARCSEC = degrees(3600.0)
FORMS = ("parabolic", "circular", "logarithmic")
ERRORS = ("in_plane", "out_of_plane", "centre_distance_error", "axial_offset")
POSITIONS = 21
ALIKE = 0.1
"""Relative difference of two heights up to which "similar" and "not significantly different" are said to hold."""
ROUNDING = 1e-9
"""Rounding of heights and places [mm]."""


@dataclass(frozen=True)
class Gears:
    """One of the two pairs of the dissertation, module 1 mm, 20 deg."""

    name: str
    teeth: tuple[int, int]
    helix_deg: float
    face_width: float
    crowning: float
    load: float
    material: Material

    @property
    def mesh(self) -> CylindricalMesh:
        """Macro geometry, pinion right-hand."""
        hands = zip(self.teeth, (1.0, -1.0), strict=True)
        return CylindricalMesh(
            *(CylindricalGear(z, 1.0, self.face_width, helix_angle=s * radians(self.helix_deg)) for z, s in hands)
        )

    def pair(self, mounting: Mounting | None = None, **modifications: float | str) -> GearPair:
        """The pair with its lead crowning on the pinion, unless other modifications are given."""
        chosen = {"lead_crowning": self.crowning, **modifications}
        return cylindrical_pair(
            self.mesh,
            modifications=(FlankModifications(**chosen), FlankModifications()),
            mounting=mounting or Mounting(),
            materials=(self.material, self.material),
        )


SPUR = Gears("spur 25/25", (25, 25), 0.0, 10.0, 0.0025 * 5.0**2, 11.2, Material(200e3, 0.3))
"""a1 = 0.0025/mm; F = 56e-6 of E m^2."""
HELICAL = Gears("helical 40/37", (40, 37), 14.0, 20.0, 0.0051 * 10.0**2, 200.0, Material(206e3, 0.3))
"""c1 = 0.0051/mm, the smallest of Table 3."""
PICTURED = {SPUR: SPUR.crowning, HELICAL: 0.03}
"""Lead crowning [mm] of the picture: with 510 um the paths of the helical pair lie on each other."""
LARGEST = {
    SPUR: dict(zip(ERRORS, (0.0175, 0.0175, 0.2, 0.2), strict=True)),
    HELICAL: dict(zip(ERRORS, (radians(0.2), radians(0.2), 0.2, 0.2), strict=True)),
}


@dataclass(frozen=True)
class Trend:
    """A statement of the source, whether it holds here, and the numbers that say so."""

    figure: str
    statement: str
    holds: bool
    because: str


@dataclass(frozen=True)
class Effect:
    """What one mounting error does to one pair."""

    gears: str
    form: str
    error: str
    shift: float
    peak_to_peak: float
    pressure: float
    continuous: bool


def hertz_pressure(pair: GearPair, contact: ContactPoint, load: float) -> float:
    """Largest pressure after Hertz [MPa]; NaN where it does not hold."""
    if contact.on_edge or contact.on_line:
        return float("nan")
    k = relative_curvature(pair, contact)
    return point_contact(load, (k.across, k.along), pair.contact_modulus).max_pressure


def effect(gears: Gears, form: str, error: str, amount: float) -> Effect:
    """Shift at the pitch point against the aligned pair [mm], TE [arcsec], Hertz pressure [MPa]."""
    pair = gears.pair(Mounting(**{error: amount} if amount else {}), lead_crowning_form=form)
    contact = trace_contact(pair, [0.0])[0]
    mesh = trace_teeth(pair)
    pressure = hertz_pressure(pair, contact, gears.load)
    return Effect(
        gears.name, form, error, contact.pinion_axial, mesh.peak_to_peak * ARCSEC, pressure, mesh.is_continuous
    )


def effects() -> list[Effect]:
    """Every error at its largest, each pair, each form of crowning, after the aligned pair."""
    cases = [(gears, form) for gears in (SPUR, HELICAL) for form in FORMS]
    found = []
    for gears, form in cases:
        found.append(effect(gears, form, "none", 0.0))
        found += [effect(gears, form, error, LARGEST[gears][error]) for error in ERRORS]
    return found


def shift(gears: Gears, mounting: Mounting, **modifications: float | str) -> float:
    """Axial coordinate of the contact at phi1 = 0 on the pinion [mm]."""
    return float(trace_contact(gears.pair(mounting, **modifications), [0.0]).pinion_axial[0])


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


def rows() -> list[Row]:
    """Numbers that the source's inputs fix: the laws of a misaligned crowned pair."""
    found = []
    mesh = HELICAL.mesh
    alpha = mesh.working_pressure_angle
    inward, across = (
        shift(HELICAL, Mounting(**{name: radians(0.2)}), lead_crowning=c1 * 100.0)
        for name, c1 in (("in_plane", 0.0051), ("out_of_plane", 0.00143))
    )
    base_helix = mesh.pinion.base_helix_angle
    laws = (sin(alpha) / 0.0051, cos(alpha) / 0.00143)
    for name, law, printed, obtained in zip(
        ("in-plane", "out-of-plane"), laws, (1.3, 5.0), (inward, across), strict=True
    ):
        expected = radians(0.2) * law / (2.0 * cos(base_helix))
        label = f"{name} 0.2 deg: shift of the contact [mm]"
        found.append(Row(CASE, "f/(2 c1 cos(beta_b)), first order", label, expected, abs(obtained), 2e-3))
        found.append(Row(CASE, "as printed (does not follow)", label, printed, abs(obtained), None))
    small = radians(0.001)
    slopes = [_slope(Mounting(**{name: small})) for name in ("in_plane", "out_of_plane")]
    label = "TE slope, in-plane over out-of-plane"
    found.append(Row(CASE, "-tan(alpha_wt), first order", label, -tan(alpha), slopes[0] / slopes[1], 2e-3))
    spur = shift(SPUR, Mounting(out_of_plane=small)) * 2.0 * 0.0025
    found.append(
        Row(
            CASE,
            "delta cos(alpha), first order",
            "spur: shift times 2 c1 [rad]",
            small * cos(radians(20.0)),
            spur,
            1e-3,
        )
    )
    tilted = shift(SPUR, Mounting(in_plane=small)) * 2.0 * 0.0025
    found.append(
        Row(
            CASE,
            "-gamma sin(alpha), first order",
            "spur: shift times 2 c1 [rad]",
            -small * sin(radians(20.0)),
            tilted,
            1e-3,
        )
    )
    return found


def _slope(mounting: Mounting) -> float:
    line = trace_contact(HELICAL.pair(mounting), [0.0, 0.01]).transmission_error
    return float(line[1] - line[0]) / 0.01


def draw_paths() -> Figure:
    """Contact path on the pinion flank and transmission error for each error, both pairs."""
    figure = Figure(figsize=(12.0, 8.0), layout="constrained")
    styles = zip(("none", *ERRORS), ("k", "#0072b2", "#d55e00", "#009e73", "#cc79a7"), "os^Dv", strict=True)
    panels = figure.subplots(2, 2)
    for error, colour, marker in styles:
        for gears, (flank, motion) in zip((SPUR, HELICAL), panels, strict=True):
            amount = {} if error == "none" else {error: LARGEST[gears][error]}
            pair = gears.pair(Mounting(**amount), lead_crowning=PICTURED[gears], profile_crowning=0.01)
            mesh = trace_teeth(pair)
            path = mesh.leading_contact
            style = {
                "color": colour,
                "marker": marker,
                "markersize": 4,
                "label": error.replace("_", " ") if amount else "aligned",
            }
            flank.plot(path.pinion_axial, 2.0 * path.pinion_radius, linestyle="", **style)
            lag = (mesh.transmission_error - mesh.transmission_error.max()) * ARCSEC
            motion.plot(np.degrees(mesh.pinion_angle), lag, markevery=2, **style)
    for gears, (flank, motion) in zip((SPUR, HELICAL), panels, strict=True):
        lead = f"lead crowning {1e3 * PICTURED[gears]:g} µm"
        flank.set(xlim=(-0.5 * gears.face_width, 0.5 * gears.face_width), title=f"{gears.name}, {lead}: contact path")
        flank.set(xlabel="z on the pinion [mm]", ylabel="diameter on the pinion [mm]")
        motion.set_title(
            f"errors {degrees(LARGEST[gears]['in_plane']):.2g} deg and {LARGEST[gears]['axial_offset']} mm"
        )
        motion.set(xlabel="pinion angle [deg]", ylabel="transmission error less its largest [arcsec]")
    figure.legend(*panels[0, 1].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    figure.suptitle("Mounting errors of pairs of module 1 mm with profile crowning 10 µm, unloaded")
    return figure


def main() -> int:
    """Print trends and effects, save the pictures; 0 in any case: a trend that does not hold is a finding."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(), help="directory of the pictures")
    directory = parser.parse_args().out
    for trend in trends():
        verdict = "holds" if trend.holds else "does not hold"
        print(f"Figure {trend.figure}: {trend.statement}: {verdict}: {trend.because}")
    print("\n" + "  ".join(f"{field.name:>22}" for field in fields(Effect)))
    for one in effects():
        numbers = f"{one.shift:22.4f}  {one.peak_to_peak:22.4f}  {one.pressure:22.2f}  {one.continuous!s:>22}"
        print(f"{one.gears:>22}  {one.form:>22}  {one.error:>22}  {numbers}")
    draw_paths().savefig(directory / "mounting_errors.png", dpi=90)
    return 0


if __name__ == "__main__":
    sys.exit(main())
