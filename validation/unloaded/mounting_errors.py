"""What each mounting error does to contact path, transmission error and Hertz pressure of cylindrical pairs.

The statements of the reduced-TCA dissertation (Figures 10 to 30) on its spur pair 25/25 and its helical pair 40/37 with
three forms of lead crowning, each with a verdict; the numbers it prints beside computed ones; a table of every error.

Run from the root of the repository: ``python -m validation.unloaded.mounting_errors``.
"""

from dataclasses import dataclass
from math import cos, degrees, radians, sin, tan

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.teeth import trace_teeth
from validation.page import Page, lines, machine, write_page
from validation.table import Row
from validation.unloaded.helical_trends import trends as helical_trends
from validation.unloaded.mounting_error_figures import lines as printed_lines
from validation.unloaded.mounting_error_figures import rows as printed_rows
from validation.unloaded.mounting_error_figures import unmodified_pressure
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
from validation.unloaded.mounting_error_trends import verdicts
from validation.unloaded.spur_trends import trends as spur_trends

OF_SHIFTS = 1e-7
"""Of shifts of 6e-6 rad and more, whose contacts are found to some 1e-13 rad; 7e-9 is seen."""
OF_SLOPES = 1.5e-4
"""Of slopes over 0.01 rad, whose contacts move along the flank; 5e-5 is seen."""


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
    found.append(Row(CASE, "-tan(alpha_wt), first order", label, -tan(alpha), slopes[0] / slopes[1], OF_SLOPES))
    spur = shift(SPUR, Mounting(out_of_plane=small)) * 2.0 * 0.0025
    found.append(
        Row(
            CASE,
            "delta cos(alpha), first order",
            "spur: shift times 2 c1 [rad]",
            small * cos(radians(20.0)),
            spur,
            OF_SHIFTS,
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
            OF_SHIFTS,
        )
    )
    return [*found, *printed_rows()]


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


def _cells(one: Effect) -> str:
    continuous = "yes" if one.continuous else "no"
    return (
        f"{one.gears} | {one.form} | {one.error.replace('_', ' ')} | {round(one.shift, 3) + 0.0:+.3f} | "
        f"{max(one.peak_to_peak, 0.0):.2f} | {one.pressure:.0f} | {continuous}"
    )


TEXT = """# Spur and helical pairs under mounting errors

Written by `python -m validation.unloaded.mounting_errors`. Machine: {machine}.

Unloaded contact of all teeth over one pitch; pressures after Hertz, one tooth pair carrying the whole load. Figures 10
to 30 of the [reduced-TCA dissertation](../reference/sources.md) show pictures, most of them without numbers: each
statement of its text is judged here by a number. Its bevel pairs have [a page of their own](bevel_studies.md), and so
has [the convergence from random starts](unloaded_convergence.md).

Assumed, where the source says nothing: the pinion drives, and has all modifications; lead crowning of the spur pair
{spur:g} um at the ends of the face (its a1 = 0.0025/mm), of the helical pair {helical:g} um (the smallest c1 of its
Table 3), parabolic unless a form is named; errors of the spur pair {angle:.2g} deg and {length:g} mm. "Continuous": one
tooth pair takes over from the other without edge contact.

## Figures 10 to 30

| figure | statement | verdict | because |
|---|---|---|---|
{trends}

![Contact paths and transmission errors of both pairs](cylindrical_studies.png)

## Printed numbers of Figures 24, 26 and 29

S is the area under the transmission function, printed without window or unit (and negative); SR = p/p_0 is the pressure
over that of the aligned, unmodified pair, which is not printed; here p_0 = {p0:.0f} MPa, of a contact line over the
whole face under the whole load.

| figure | quantity | printed | computed | computed/printed | assumed |
|---|---|---|---|---|---|
{printed}

The areas of one figure cannot differ: lead crowning leaves a straight line whose slope depends on the error alone. The
stress ratios fall with the angle as the printed ones do, at about half their size: a p_0 of half the size would give
them.

## Every error

All forms remove the same at the ends of the face. Shift and pressure at phi1 = 0; peak to peak of the transmission
error of all teeth:

| pair | form | error | z on the pinion [mm] | peak to peak [arcsec] | pressure [MPa] | continuous |
|---|---|---|---|---|---|---|
{effects}
"""


def document() -> str:
    """The page, with its tables."""
    return TEXT.format(
        machine=machine(numpy=True),
        spur=1e3 * SPUR.crowning,
        helical=1e3 * HELICAL.crowning,
        angle=degrees(LARGEST[SPUR]["in_plane"]),
        length=LARGEST[SPUR]["axial_offset"],
        trends="\n".join(verdicts([*spur_trends(), *helical_trends()])),
        p0=unmodified_pressure(),
        printed=lines(printed_lines()),
        effects=lines(map(_cells, effects())),
    )


if __name__ == "__main__":
    write_page(__doc__, lambda: Page("cylindrical_studies", document(), {"cylindrical_studies": draw_paths()}))
