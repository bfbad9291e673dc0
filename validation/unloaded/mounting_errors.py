"""What each mounting error does to contact path, transmission error and Hertz pressure.

The trends of the reduced-TCA dissertation (Figures 17 to 30) for its spur pair 25/25 and its helical pair 40/37 with
three forms of lead crowning, each with a verdict, and a table of every error. The dissertation compares forms of
crowning of unlike amounts; here all forms remove the same at the ends of the face.

Run from the root of the repository: ``python -m validation.unloaded.mounting_errors``.
"""

import argparse
import sys
from dataclasses import dataclass, fields
from math import cos, degrees, radians, sin, tan
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.teeth import trace_teeth
from validation.table import Row
from validation.unloaded.mounting_error_pairs import (
    ARCSEC,
    CASE,
    ERRORS,
    FORMS,
    HELICAL,
    LARGEST,
    PICTURED,
    SPUR,
    Gears,
    hertz_pressure,
    shift,
)
from validation.unloaded.mounting_error_trends import trends


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
    laws = (-sin(alpha) / 0.0051, cos(alpha) / 0.00143)
    for name, law, printed, obtained in zip(
        ("in-plane", "out-of-plane"), laws, (1.3, 5.0), (inward, across), strict=True
    ):
        expected = radians(0.2) * law / (2.0 * cos(base_helix))
        label = f"{name} 0.2 deg: shift of the contact [mm]"
        found.append(Row(CASE, "f/(2 c1 cos(beta_b)), first order", label, expected, obtained, 2e-3))
        found.append(Row(CASE, "as printed without sign (does not follow)", label, printed, abs(obtained), None))
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
