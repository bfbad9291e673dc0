"""What the reduced-TCA dissertation says of the straight bevel pair under mounting errors, its Figures 33 to 39."""

from __future__ import annotations

from functools import lru_cache
from math import radians

import numpy as np

from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded import relative_curvature, trace_contact
from validation.bevel.effects import Effect, effect
from validation.bevel.pairs import NONE, STRAIGHT, TABLE_6, straight_modifications
from validation.unloaded.mounting_error_pairs import FORMS
from validation.unloaded.mounting_error_trends import STEEPER, Trend

SLIGHT, LEAD, STRONG = 2.0, 10.0, 100.0
"""Lead crowning [um], assumed: insufficient, moderate, overabundant."""
RELIEF = 20.0
"""Tip relief [um], assumed."""
ALIKE = 0.1
"""Relative difference of two pressures up to which they are not significantly different."""


@lru_cache
def straight_effect(error: str, lead: float, form: str = "parabolic", relieved: str = "none") -> Effect:
    """Effect of one error of Table 6 ("aligned": none); tip relief on none, the pinion, or both gears."""
    pinion = straight_modifications(lead, form, RELIEF if relieved != "none" else 0.0)
    wheel = straight_modifications(0.0, relief_um=RELIEF, member=1) if relieved == "both" else NONE
    return effect(STRAIGHT, STRAIGHT.pair(TABLE_6.get(error), pinion, wheel))


def trends() -> list[Trend]:
    """Every statement on the straight pair that a computation can judge."""
    return [*_slight_crowning(), *_relief(), _one_crowning_for_all(), *trends_of_strong_crowning(), *_forms()]


def _slight_crowning() -> list[Trend]:
    pushed = straight_effect("ΔA", SLIGHT)
    offset = straight_effect("ΔE", SLIGHT)
    steps = f"{SLIGHT:g} um, ΔA 0.1 mm: peak to peak {pushed.peak_to_peak:.1f} arcsec"
    return [
        Trend(
            "33",
            "insufficient crowning: curves that do not intersect",
            not pushed.continuous,
            f"{steps}, bridged by a tooth edge; but so it is with more crowning, see Figure 35",
        ),
        Trend(
            "34",
            "insufficient crowning: part of the contact lies on an edge",
            bool(pushed.on_edge.any() and not pushed.on_edge.all()),
            f"ΔA: {pushed.on_edge.mean():.0%} of a pitch on a tip, path {pushed.place[0]:+.2f} mm from the middle; "
            f"ΔE: {offset.on_side.mean():.0%} on the heel",
        ),
    ]


def _relief() -> list[Trend]:
    linear = ("ΔE", "ΔA", "ΔG")
    found = {kind: {e: straight_effect(e, LEAD, relieved=kind) for e in linear} for kind in ("none", "pinion", "both")}
    heights = {
        kind: ", ".join(f"{e} {one.peak_to_peak:.1f}{'' if one.continuous else ' (edge)'}" for e, one in part.items())
        for kind, part in found.items()
    }
    angular = straight_effect("Δγ", LEAD)
    return [
        Trend(
            "35",
            "lengthwise crowning without tip relief: intermittent transmission error",
            not any(one.continuous for one in found["none"].values()),
            f"lead {LEAD:g} um: {heights['none']} arcsec; not so under Δγ: {abs(angular.peak_to_peak):.1f} arcsec",
        ),
        Trend(
            "35",
            "tip relief, on gear 1 alone as the source first says, makes it continuous",
            all(one.continuous for one in found["pinion"].values()),
            f"{RELIEF:g} um: {heights['pinion']} arcsec: the errors that make a tooth enter with a step need the "
            "relief on the tip of the other gear",
        ),
        Trend(
            "35",
            "tip relief, on the tips of both gears, makes it continuous",
            all(one.continuous for one in found["both"].values()),
            f"{RELIEF:g} um: {heights['both']} arcsec",
        ),
    ]


def _one_crowning_for_all() -> Trend:
    offset, axial = (straight_effect(error, LEAD, relieved="both") for error in ("ΔE", "ΔG"))
    return Trend(
        "36",
        "one crowning is acceptable for one error (ΔE) and unacceptable for another (ΔG)",
        axial.peak_to_peak > 2.0 * offset.peak_to_peak,
        f"peak to peak {offset.peak_to_peak:.1f} and {axial.peak_to_peak:.1f} arcsec, although ΔE moves the path "
        f"farther: {offset.place[0]:+.2f} and {axial.place[0]:+.2f} mm",
    )


def _ellipse(lead: float) -> tuple[float, float]:
    """Pressure [MPa] and half length [mm] of the Hertz ellipse under Delta E at phi1 = 0, with relief of both gears."""
    wheel = straight_modifications(0.0, relief_um=RELIEF, member=1)
    pair = STRAIGHT.pair(TABLE_6["ΔE"], straight_modifications(lead, relief_um=RELIEF), wheel)
    curvature = relative_curvature(pair, trace_contact(pair, [0.0])[0])
    found = point_contact(STRAIGHT.load, (curvature.across, curvature.along), pair.contact_modulus)
    return found.max_pressure, found.semi_major


def trends_of_strong_crowning() -> list[Trend]:
    """Figure 37: path, ellipse and pressure under Delta E with ten times the lead crowning."""
    weak, strong = (straight_effect("ΔE", lead, relieved="both") for lead in (LEAD, STRONG))
    (low, long), (high, short) = _ellipse(LEAD), _ellipse(STRONG)
    factors = np.geomspace(1.0, 100.0, 15)
    raised = [_ellipse(factor * LEAD)[0] / low for factor in factors]
    needed = float(np.interp(1.8, raised, factors))
    return [
        Trend(
            "37",
            "strong lead crowning brings the path nearer to the middle",
            abs(strong.place[0]) < abs(weak.place[0]),
            f"ΔE: {weak.place[0]:+.2f} mm at {LEAD:g} um, {strong.place[0]:+.2f} mm at {STRONG:g} um",
        ),
        Trend(
            "37",
            "the ellipse becomes shorter and the pressure higher",
            high > low and short < long,
            f"{low:.0f} to {high:.0f} MPa, half length {long:.2f} to {short:.2f} mm from {LEAD:g} to {STRONG:g} um",
        ),
        Trend(
            "37",
            f"by nearly 80 %, if from {LEAD:g} to {STRONG:g} um (assumed)",
            abs(high / low - 1.8) < 0.05,
            f"{high / low - 1.0:+.0%}; 80 % need {needed:.0f} times the crowning, and the source prints no amounts",
        ),
    ]


def _forms() -> list[Trend]:
    away = {}
    for error in TABLE_6:
        curves = [straight_effect(error, LEAD, form, "both").transmission_error for form in FORMS]
        shapes = [curve - curve.max() for curve in curves]
        away[error] = max(float(np.abs(shape - shapes[0]).max()) for shape in shapes)
    listed = ", ".join(f"{error} {round(value, 6):.2g}" for error, value in away.items())
    equal = {form: _pressures(form, LEAD) for form in FORMS}
    matched = equal | {"logarithmic": _pressures("logarithmic", STEEPER * LEAD)}
    spread = {
        name: max(abs(values[form] / values["parabolic"] - 1.0).max() for form in FORMS)
        for name, values in (("equal", equal), ("matched", matched))
    }
    return [
        Trend(
            "38",
            "Δγ: the three forms differ by only one or two arcsec",
            away["Δγ"] <= 2.0,
            f"largest difference of the curves, each from its top: {listed} arcsec: a pair of spherical involutes "
            "stays conjugate under Δγ, whatever the form; ΔA and ΔG show what a form does",
        ),
        Trend(
            "39",
            "Δγ: the forms have much the same pressure, if they remove the same at the ends of the face",
            bool(spread["equal"] < ALIKE),
            f"logarithmic {equal['logarithmic'][0]:.0f}, parabolic {equal['parabolic'][0]:.0f} MPa "
            f"(up to {spread['equal']:.0%} apart), being flatter in the middle",
        ),
        Trend(
            "39",
            "Δγ: the forms have much the same pressure, if they are equally curved in the middle of the face",
            bool(spread["matched"] < ALIKE),
            f"up to {spread['matched']:.1%} apart from -0.2 to 0.2 deg; logarithmic {STEEPER:.2f} times as much",
        ),
    ]


def _pressures(form: str, lead: float) -> np.ndarray:
    """Pressure at phi1 = 0 under some errors of the shaft angle [MPa]."""
    found = []
    for angle in (-0.2, 0.0, 0.2):
        pair = STRAIGHT.pair(BevelMounting(shaft_angle_error=-radians(angle)), straight_modifications(lead, form))
        found.append(STRAIGHT.pressures(pair, trace_contact(pair, [0.0]))[0])
    return np.array(found)
