"""What the reduced-TCA dissertation says of the helical pair under mounting errors, its Figures 23 to 30."""

from math import degrees, radians

import numpy as np

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.teeth import trace_teeth
from validation.unloaded.mounting_error_pairs import FORMS, HELICAL, Gears, hertz_pressure, pressures_along, shift
from validation.unloaded.mounting_error_trends import ALIKE, STEEPER, Trend
from validation.unloaded.reduced_tca_tables import LINES, amount


def trends() -> list[Trend]:
    """Every statement on the helical pair that a computation can judge, in the figures' order."""
    return [
        _crowning_for_continuity(),
        _area_of_forms(),
        *trends_of_forms(),
        *_trends_of_paths(),
        _onset_of_edge_contact(),
        *trends_of_helical_pressure(),
    ]


def equally_curved(form: str, parabola: float, face_width: float) -> float:
    """Amount [mm] at which a form is as curved in the middle of the face as a parabola of another amount [mm]."""
    if form == "logarithmic":
        return STEEPER * parabola
    if form == "circular":
        radius = (0.5 * face_width) ** 2 / (2.0 * parabola)
        return radius - (radius**2 - (0.5 * face_width) ** 2) ** 0.5
    return parabola


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


def _area_of_forms() -> Trend:
    mounting = Mounting(out_of_plane=radians(0.2))
    lines = [
        trace_contact(HELICAL.pair(mounting, lead_crowning_form=form), [0.0, 0.01]).transmission_error for form in FORMS
    ]
    areas = [0.5 * float(line[1] - line[0]) for line in lines]
    spread = (max(areas) - min(areas)) / max(areas)
    return Trend(
        "24, 26",
        "helical: logarithmic crowning has the smallest area S of the transmission function",
        spread > 0.01,
        f"the function is one straight line whatever the crowning: areas differ by {spread:.1e}, the printed ones, "
        "below, by 2 and 21 %",
    )


def trends_of_forms() -> list[Trend]:
    """Figures 25 and 27: shift of the path with the three forms, and with the first constants of Tables 3 and 4."""
    mounting = Mounting(in_plane=radians(0.2))
    amounts = {
        "equal": dict.fromkeys(FORMS, HELICAL.crowning),
        "curved": {form: equally_curved(form, HELICAL.crowning, HELICAL.face_width) for form in FORMS},
    }
    away = {}
    for name, chosen in amounts.items():
        shifts = {
            form: shift(HELICAL, mounting, lead_crowning=value, lead_crowning_form=form)
            for form, value in chosen.items()
        }
        away[name] = {form: value / shifts["parabolic"] - 1.0 for form, value in shifts.items()}
    listed = {
        name: ", ".join(f"{form} {100.0 * part[form]:+.3g} %" for form in ("circular", "logarithmic"))
        for name, part in away.items()
    }
    printed = {
        (line.error, abs(line.angle)): {
            form: abs(
                shift(
                    HELICAL,
                    Mounting(**{line.error: radians(line.angle)}),
                    lead_crowning=amount(line, form),
                    lead_crowning_form=form,
                )
            )
            for form in FORMS
        }
        for line in LINES[::3]
    }
    nearer = {
        angle: part["circular"] / part["parabolic"] - 1.0
        for (error, angle), part in printed.items()
        if error == "in_plane"
    }
    farther = {
        angle: part["logarithmic"] / part["parabolic"] - 1.0
        for (error, angle), part in printed.items()
        if error == "out_of_plane"
    }
    constants, logarithms = (
        ", ".join(f"{angle:g} deg {value:+.2%}" for angle, value in part.items()) for part in (nearer, farther)
    )
    against = "shift against that of the parabola at 0.2 deg:"
    return [
        Trend(
            "25",
            "helical: the forms give similar paths, if they remove the same at the ends of the face",
            max(map(abs, away["equal"].values())) < ALIKE,
            f"{against} {listed['equal']}, being flatter in the middle",
        ),
        Trend(
            "25",
            "helical: the forms give similar paths, if they are equally curved in the middle of the face",
            max(map(abs, away["curved"].values())) < ALIKE,
            f"{against} {listed['curved']}; logarithmic {STEEPER:.2f} times as much at the ends",
        ),
        Trend(
            "25",
            "helical: the path with a circle is nearer to the middle at 0.1 and 0.2 deg",
            max(nearer[0.1], nearer[0.2]) < 0.0,
            f"against the parabola, with the first constants of Table 3: {constants}; the constants decide, and of the "
            "logarithm one is not printed",
        ),
        Trend(
            "27",
            "helical: the logarithmic path is noticeably farther from the middle at 0.2 deg, but not at 0.05 and 0.1",
            farther[0.2] > ALIKE > max(abs(farther[0.05]), abs(farther[0.1])),
            f"against the parabola, with the first constants of Table 4: {logarithms}; at 0.2 deg its a1 is too "
            "small for any a2 to give the curvature of the parabola",
        ),
    ]


def _trends_of_paths() -> list[Trend]:
    names = ("in_plane", "out_of_plane")
    angles = (0.05, 0.1, 0.2)
    table = {
        (name, form): [shift(HELICAL, Mounting(**{name: radians(a)}), lead_crowning_form=form) for a in angles]
        for name in names
        for form in FORMS
    }
    grows = all((np.diff(np.abs(row)) > 0.0).all() for row in table.values())
    ratio = abs(table["out_of_plane", "parabolic"][2] / table["in_plane", "parabolic"][2])
    spur = Gears("spur", HELICAL.teeth, 0.0, HELICAL.face_width, HELICAL.crowning, HELICAL.load, HELICAL.material)
    mounting = Mounting(out_of_plane=radians(0.2))
    larger = shift(HELICAL, mounting) / shift(spur, mounting)
    return [
        Trend("25, 27", "helical: the path moves away from the middle as the angle grows", grows, "all three forms"),
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


def trends_of_helical_pressure() -> list[Trend]:
    """Figures 29 and 30: pressure over the out-of-plane error with the three forms, and along the path."""
    amounts = {
        "removing the same at the ends of the face": dict.fromkeys(FORMS, HELICAL.crowning),
        "equally curved": {form: equally_curved(form, HELICAL.crowning, HELICAL.face_width) for form in FORMS},
        "with the first constants of Table 4": {form: amount(LINES[15], form) for form in FORMS},
    }
    at_last = {name: {form: _pitch_point(0.2, form, part[form]) for form in FORMS} for name, part in amounts.items()}
    highest = [part["logarithmic"] > 1.01 * max(part["circular"], part["parabolic"]) for part in at_last.values()]
    listed = "; ".join(
        f"{name}: {', '.join(f'{form} {value:.0f}' for form, value in part.items())}" for name, part in at_last.items()
    )
    table = [{form: _pitch_point(line.angle, form, amount(line, form)) for form in FORMS} for line in LINES[9::3]]
    falls = all(table[0][form] > table[1][form] > table[2][form] for form in FORMS)
    change = {
        form: at_last["removing the same at the ends of the face"][form] / _pitch_point(0.01, form, HELICAL.crowning)
        - 1.0
        for form in FORMS
    }
    alone = ", ".join(f"{form} {value:+.1%}" for form, value in change.items())
    lowest = [min(part, key=part.__getitem__) for part in table]
    close = max(abs(part["circular"] / part["parabolic"] - 1.0) for part in table)
    helical = pressures_along(HELICAL, Mounting(out_of_plane=radians(0.2)), lead_crowning_form="circular")
    foot, head = (float(helical[k] / helical[len(helical) // 2] - 1.0) for k in (0, -1))
    along = f"{head:+.1%} towards the tip, {foot:+.1%} towards the root of the pinion, against the pitch point"
    return [
        Trend(
            "29",
            "helical: the pressure falls as the angle grows",
            falls,
            f"{'; '.join(_listed(part) for part in table)} MPa at 0.05, 0.1, 0.2 deg with the first constants of Table "
            f"4, which shrink; at one crowning, from 0.01 to 0.2 deg: {alone}",
        ),
        Trend(
            "29",
            "helical: the pressure is lowest with the parabola at 0.05, the circle at 0.1, the parabola at 0.2 deg",
            lowest == ["parabolic", "circular", "parabolic"],
            f"with the first constants of Table 4: {', '.join(lowest)}; circle and parabola are at most {close:.2%} "
            "apart, which the rounding of the constants decides",
        ),
        Trend(
            "29",
            "helical: at 0.2 deg the logarithmic crowning has a significantly higher pressure than the others",
            any(highest),
            f"MPa, {listed}: lower or the same, whatever is kept equal",
        ),
        Trend("30", "helical: the pressure is higher in the upper part of the tooth", head > foot, along),
        Trend(
            "30",
            "helical: and falls along the path from there to the lower part",
            bool((np.diff(helical) > 0.0).all()),
            f"{along}: lowest between them" if min(head, foot) > 0.0 else along,
        ),
    ]


def _pitch_point(angle_deg: float, form: str, crowning: float) -> float:
    """Hertz pressure of the helical pair [MPa] at phi1 = 0 under an out-of-plane error."""
    pair = HELICAL.pair(Mounting(out_of_plane=radians(angle_deg)), lead_crowning=crowning, lead_crowning_form=form)
    return hertz_pressure(pair, trace_contact(pair, [0.0])[0], HELICAL.load)


def _listed(pressures: dict[str, float]) -> str:
    return ", ".join(f"{form} {value:.0f}" for form, value in pressures.items())
