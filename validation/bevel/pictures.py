"""Pictures of the bevel pairs under mounting errors, in the toe-heel and root-tip frame of the pinion."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke

from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded import ContactPath, relative_curvature, trace_contact
from validation.bevel.effects import Effect, spiral_effect, spiral_mounting
from validation.bevel.pairs import (
    HEIGHT,
    LENGTHWISE,
    NONE,
    SPIRAL,
    STRAIGHT,
    TABLE_6,
    BevelGears,
    spiral_modifications,
    straight_modifications,
)
from validation.bevel.spiral_trends import FULL, ErrorMap
from validation.bevel.straight_trends import LEAD, RELIEF, SLIGHT, STRONG, straight_effect
from validation.unloaded.mounting_error_pairs import FORMS

COLOURS = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")
"""Okabe and Ito 2008; the markers differ, too."""
MARKERS = "os^DvP"
ELLIPSES = 7


def _style(number: int, label: str) -> dict[str, str | float]:
    return {"color": COLOURS[number], "marker": MARKERS[number], "markersize": 4.0, "linewidth": 1.0, "label": label}


def draw_flank(axes: Axes, gears: BevelGears) -> None:
    """Outline of the pinion flank, between its four corners."""
    corners = np.stack(gears.place(*gears.pair().pinion.flank.grid(2, 2)), axis=-1)
    axes.add_patch(Polygon(corners[[0, 0, 1, 1], [0, 1, 1, 0]], facecolor="0.95", edgecolor="0.5"))
    axes.set(xlabel=f"{LENGTHWISE} [mm]", ylabel=f"{HEIGHT} [mm]")
    axes.margins(0.04)
    axes.autoscale_view()


def _draw_path(
    axes: Axes, gears: BevelGears, pair: GearPair, style: dict[str, str | float], *, edges: bool = False
) -> None:
    """Path of one tooth pair, and the major axes of some of its Hertz ellipses; crosses for edges if asked for."""
    path = trace_contact(pair, np.linspace(-0.9, 0.9, 43) * pair.pitch, warn=False)
    rows = np.flatnonzero(path.in_contact & ~path.on_edge)
    axes.plot(*gears.path_on_pinion(path[rows]), **(style | {"markersize": 2.5}))
    if edges:
        axes.plot(*gears.path_on_pinion(path[path.on_edge]), "x", color=style["color"], markersize=4.0)
    for row in rows[:: max(1, len(rows) // ELLIPSES)]:
        axes.plot(*_major_axis(gears, pair, path, row), color=style["color"], linewidth=0.8, alpha=0.6)


def _major_axis(gears: BevelGears, pair: GearPair, path: ContactPath, row: int) -> tuple[np.ndarray, np.ndarray]:
    contact = path[row]
    curvature = relative_curvature(pair, contact)
    ellipse = point_contact(gears.load, (curvature.across, curvature.along), pair.contact_modulus)
    ends = contact.point + np.linspace(-1.0, 1.0, 9)[:, None] * ellipse.semi_major * curvature.axes[1]
    return gears.place(np.hypot(ends[:, 0], ends[:, 1]), ends[:, 2])


def _draw_motion(axes: Axes, effects: Iterable[tuple[str, Effect]], title: str) -> None:
    """Transmission error from its top."""
    for number, (label, one) in enumerate(effects):
        curve = one.transmission_error - one.transmission_error.max()
        mark = "" if one.continuous else " (edge)"
        axes.plot(np.degrees(one.pinion_angle), curve, markevery=2, **_style(number, label + mark))
    low, high = axes.get_ylim()
    axes.set_ylim(low - 0.5 * (high - low), high)
    axes.legend(fontsize="small", loc="lower center", ncols=2)
    axes.set(xlabel="pinion angle [deg]", ylabel="transmission error, from its top [arcsec]", title=title)


def draw_straight() -> Figure:
    """Path, pressure, and transmission error with and without tip relief, for each error of Table 6."""
    figure = Figure(figsize=(12.0, 9.0), layout="constrained")
    (flank, stress), (bare, relieved) = figure.subplots(2, 2)
    cases = {"aligned": None, **TABLE_6}
    modifications = straight_modifications(LEAD, relief_um=RELIEF), straight_modifications(0.0, "parabolic", RELIEF, 1)
    draw_flank(flank, STRAIGHT)
    for number, (name, mounting) in enumerate(cases.items()):
        _draw_path(flank, STRAIGHT, STRAIGHT.pair(mounting, *modifications), _style(number, name))
        one = straight_effect(name, LEAD, relieved="both")
        stress.plot(np.degrees(one.pinion_angle), one.pressure, markevery=2, **_style(number, name))
    flank.set_title("contact paths with major axes of the Hertz ellipses")
    stress.set(
        xlabel="pinion angle [deg]", ylabel="Hertz pressure [MPa]", title=f"{STRAIGHT.load:g} N, leading contact"
    )
    for axes, kind, title in (
        (bare, "none", "no tip relief"),
        (relieved, "both", f"tip relief {RELIEF:g} µm, both gears"),
    ):
        _draw_motion(axes, [(name, straight_effect(name, LEAD, relieved=kind)) for name in cases], title)
    flank.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.suptitle(
        f"{STRAIGHT.name}, parabolic lead crowning {LEAD:g} µm; ΔE, ΔA, ΔG 0.1 mm, Δγ 0.2° (edge: a tooth edge "
        "bridges a step)"
    )
    return figure


def draw_straight_crowning() -> Figure:
    """Amounts of lead crowning under Delta E, and forms under Delta A and over the shaft angle."""
    figure = Figure(figsize=(13.5, 4.6), layout="constrained")
    flank, motion, stress = figure.subplots(1, 3)
    draw_flank(flank, STRAIGHT)
    wheel = straight_modifications(0.0, relief_um=RELIEF, member=1)
    for number, lead in enumerate((SLIGHT, LEAD, STRONG)):
        pair = STRAIGHT.pair(TABLE_6["ΔE"], straight_modifications(lead, relief_um=RELIEF), wheel)
        _draw_path(flank, STRAIGHT, pair, _style(number, f"{lead:g} µm"), edges=True)
    flank.set_title("ΔE 0.1 mm, amounts of parabolic crowning\n(crosses: edge contact)")
    flank.set_ylim(bottom=flank.get_ylim()[0] - 0.8)
    flank.legend(fontsize="small", loc="lower center", ncols=3)
    _draw_motion(
        motion, [(form, straight_effect("ΔA", LEAD, form, "both")) for form in FORMS], "ΔA 0.1 mm, three forms"
    )
    angles = np.linspace(-0.2, 0.2, 5)
    for number, form in enumerate(FORMS):
        stress.plot(angles, [_pressure_at(form, angle) for angle in angles], **_style(number, form))
    stress.set(
        xlabel="Δγ [deg]", ylabel="Hertz pressure at $\\varphi_1$ = 0 [MPa]", title=f"Δγ, three forms, {LEAD:g} µm"
    )
    stress.set_xticks((-0.2, -0.1, 0.0, 0.1, 0.2))
    stress.set_ylim(0.0, 1.1 * stress.get_ylim()[1])
    stress.legend(fontsize="small")
    figure.suptitle(f"{STRAIGHT.name}, tip relief {RELIEF:g} µm on both gears (right: none), {STRAIGHT.load:g} N")
    return figure


def _pressure_at(form: str, gamma_deg: float) -> float:
    pair = STRAIGHT.pair(spiral_mounting(gamma_deg=gamma_deg), straight_modifications(LEAD, form), NONE)
    return float(STRAIGHT.pressures(pair, trace_contact(pair, [0.0]))[0])


SPIRAL_PANELS: tuple[tuple[str, float, float, Sequence[tuple[str, dict[str, float]]]], ...] = (
    ("Δγ, no relief", 0.002, 0.0, [(f"{g:g}°", {"gamma_deg": g}) for g in (0.0, 0.1, 0.2)]),
    ("ΔE", *FULL, [(f"{e:+g} mm", {"e": e}) for e in (0.0, 0.04, 0.08, -0.04, -0.08)]),
    ("ΔH", *FULL, [(f"{h:+g} mm", {"h": h}) for h in (0.0, 0.04, 0.08, -0.04, -0.08)]),
    ("ΔE = ΔH", *FULL, [(f"{a:+g} mm", {"e": a, "h": a}) for a in (0.0, 0.04, 0.08, -0.04, -0.08)]),
)
"""Error, c1, c_t, and its amounts, as Figures 42 to 51."""


def draw_spiral() -> Figure:
    """Contact paths above, transmission errors below, for each error of the spiral pair."""
    figure = Figure(figsize=(16.0, 8.0), layout="constrained")
    flanks, motions = figure.subplots(2, 4)
    for flank, motion, (name, c1, ct, cases) in zip(flanks, motions, SPIRAL_PANELS, strict=True):
        draw_flank(flank, SPIRAL)
        for number, (label, error) in enumerate(cases):
            pair = SPIRAL.pair(spiral_mounting(**error), spiral_modifications(c1, ct))
            _draw_path(flank, SPIRAL, pair, _style(number, label))
        flank.set_title(f"{name}: c1 = {c1:g}/mm, c_t = {ct:g} mm", fontsize="medium")
        _draw_motion(motion, [(label, spiral_effect(c1, ct, **error)) for label, error in cases], name)
    motions[0].set_ylim(-1.0, 1.0)
    figure.suptitle(
        f"{SPIRAL.name}, module 1 mm, {SPIRAL.load:.1f} N: contact paths with major axes of the Hertz ellipses, and "
        "transmission error (edge: a tooth edge bridges a step)"
    )
    return figure


def draw_error_map(errors: ErrorMap) -> Figure:
    """Figure 53: pressure over that of the aligned pair, and shift of the path, over Delta E and Delta H."""
    figure = Figure(figsize=(11.0, 4.8), layout="constrained")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    texts = ("largest Hertz pressure, over that of the aligned pair", "shift of the path, toe to heel [mm]")
    values = ((errors.ratio, "viridis", "%.2f"), (errors.deviation, "cividis", "%.1f mm"))
    for axes, text, (value, colours, form) in zip(panels, texts, values, strict=True):
        mesh = axes.pcolormesh(errors.e, errors.h, value.T, cmap=colours, shading="nearest")
        figure.colorbar(mesh, ax=axes, label=text)
        lines = axes.contour(errors.e, errors.h, value.T, colors="white", linewidths=0.8)
        for label in axes.clabel(lines, fmt=form):
            label.set_path_effects([withStroke(linewidth=2.0, foreground="0.2")])
        axes.set(xlabel="ΔE [mm]", xticks=(-0.1, -0.05, 0.0, 0.05, 0.1))
    panels[0].set_ylabel("ΔH [mm]")
    figure.suptitle(f"{SPIRAL.name}, module 1 mm, c1 = 0.005/mm, c_t = 0.08 mm, {SPIRAL.load:.1f} N, over one pitch")
    return figure
