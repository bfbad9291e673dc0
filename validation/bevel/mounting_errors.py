"""Mounting errors of bevel gears (reduced-TCA dissertation, Figures 33 to 53): verdicts, tables, pictures.

Run from the root of the repository: ``python -m validation.bevel.mounting_errors``.
"""

from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.unloaded import trace_contact
from validation.bevel.effects import Effect, first_order_error, spiral_effect
from validation.bevel.pairs import SPIRAL, STRAIGHT, BevelGears, spiral_modifications, straight_modifications
from validation.bevel.pictures import draw_error_map, draw_spiral, draw_straight, draw_straight_crowning
from validation.bevel.spiral_trends import FULL, SIGNS, STEPS, ErrorMap, error_map, sign_table
from validation.bevel.spiral_trends import trends as spiral_trends
from validation.bevel.straight_trends import LEAD, straight_effect
from validation.bevel.straight_trends import trends as straight_trends
from validation.page import Page, lines, machine, write_page
from validation.table import Row
from validation.unloaded.mounting_error_pairs import ARCSEC, FORMS
from validation.unloaded.mounting_error_trends import verdicts

CASE = "reduced-TCA dissertation, bevel mounting errors"
SMALL = 1e-4
"""Displacement [mm] at the pitch point of the first-order law: the second order is 4e-5 of it at most."""
FIRST_ORDER = 1e-4
CONJUGATE = 1e-8
"""Rounding of a transmission error [arcsec], 5e-14 rad."""
ERRORS = ("aligned", "ΔE", "ΔA", "ΔG", "Δγ")


def rows() -> list[Row]:
    """The law of small displacements for both pairs, conjugacy under Delta gamma, and what the source prints."""
    found = []
    for gears, pinion in ((STRAIGHT, straight_modifications(LEAD)), (SPIRAL, spiral_modifications(0.02))):
        turn = SMALL / gears.mesh.pinion.mean_cone_distance
        errors = {"offset": SMALL, "pinion_axial": SMALL, "wheel_axial": SMALL, "shaft_angle_error": turn}
        for name, amount in errors.items():
            mounting = BevelMounting(**{name: amount})
            contact = trace_contact(gears.pair(mounting, pinion), [0.0])[0]
            label = f"{gears.name}, {name} {amount:.3g}: transmission error [arcsec]"
            expected = first_order_error(gears, mounting) * ARCSEC
            obtained = contact.transmission_error * ARCSEC
            found.append(Row(CASE, "tooth forces, virtual work", label, expected, obtained, FIRST_ORDER))
    label = f"{SPIRAL.name}, shaft angle 0.2 deg off: peak to peak [arcsec]"
    angular = spiral_effect(0.002, 0.0, gamma_deg=0.2).peak_to_peak
    return [*found, Row(CASE, "as printed", label, 0.0, angular, CONJUGATE), *_printed_amplitudes(SPIRAL)]


def _printed_amplitudes(gears: BevelGears) -> list[Row]:
    """The two amplitudes printed for 0.04, which the inputs do not give."""
    found = []
    for name, error, printed in (("Delta E", {"e": 0.04}, 920.0), ("Delta H", {"h": 0.04}, 820.0)):
        label = f"{gears.name}, {name} 0.04 mm: peak to peak [arcsec]"
        assumed = "relief from the pitch cone on, L_t in rad; right-hand pinion drives; Delta H = P"
        obtained = spiral_effect(*FULL, **error).peak_to_peak
        found.append(Row(CASE, "as printed (does not follow)", label, printed, obtained, None, assumed))
    return found


def _cells(name: str, one: Effect) -> str:
    lengthwise, height = (round(value, 2) + 0.0 for value in one.place)  # no -0.00 where rounding decides the sign
    mean, edge = round(one.mean, 1) + 0.0, "yes" if one.continuous else "no"
    return (
        f"{name} | {mean:.1f} | {max(one.peak_to_peak, 0.0):.1f} | {edge} | {lengthwise:+.2f} | {height:+.2f} "
        f"| {_pressure(one)}"
    )


def _pressure(one: Effect) -> str:
    share = one.on_edge.mean()
    if share == 1.0:
        return "on an edge"
    return f"{one.largest_pressure:.0f}" + (f", on an edge for {share:.0%} of the pitch" if share else "")


def straight_table() -> str:
    """Each error, form and relief of the straight pair."""
    return lines(
        _cells(
            f"{error} | {form} | {'both tips' if relieved == 'both' else 'none'}",
            straight_effect(error, LEAD, form, relieved),
        )
        for relieved in ("none", "both")
        for form in FORMS
        for error in ERRORS
    )


def spiral_table() -> str:
    """Each amount of Delta E and of Delta H of the spiral pair."""
    amounts = ((key, name, sign * step) for key, name in (("e", "ΔE"), ("h", "ΔH")) for sign in SIGNS for step in STEPS)
    changed = (_cells(f"{name} {amount:+.2f}", spiral_effect(*FULL, **{key: amount})) for key, name, amount in amounts)
    return lines([_cells("aligned", spiral_effect(*FULL)), *changed])


COLUMNS = (
    " mean TE [arcsec] | peak to peak [arcsec] | continuous | R - R_m [mm] | height [mm] | largest pressure [MPa] |"
)
TEXT = """# Bevel pairs under mounting errors

Written by `python -m validation.bevel.mounting_errors`. Machine: {machine}.

Unloaded contact of all teeth over one pitch; pressures after Hertz, one tooth pair carrying the whole load. Figures 33
to 53 of the reduced-TCA dissertation show pictures, most of them without inputs: each statement of its text is judged
here by a number. How many random starts converge is on [a page of its own](bevel_convergence.md).

Read the frame like a drawing of the tooth: R - R_m to the right (toe to heel), height above the pitch cone upwards
(root to tip), both on the pinion, in mm. The mean of the transmission error is a constant angle without consequence;
the peak to peak value is what excites vibration. "Continuous": one tooth pair takes over from the
other without edge contact.

Assumed, where the source says nothing: {assumed}

## Straight pair, Figures 33 to 39

| figure | statement | verdict | because |
|---|---|---|---|
{straight_trends}

![Paths, pressures and transmission errors of the straight pair](bevel_straight.png)

![Amounts and forms of lead crowning of the straight pair](bevel_straight_crowning.png)

Lead crowning {lead:g} um, all forms removing the same at the ends of the face:

| error | form | tip relief |{columns}
|---|---|---|---|---|---|---|---|---|
{straight}

## Spiral pair, Figures 42 to 53

ΔE and ΔH have no sign in the source: a statement holds if it does for one of them.

| figure | statement | verdict | because |
|---|---|---|---|
{spiral_trends}

One set of signs does not do for all. Sets (ΔE, ΔH) with which 45, 47 and 53 hold together: {on_pinion} if 47 is read on
the pinion, as the paths of this page are; {on_wheel} if it is read on the wheel; and with 51 as well: {with_amplitude}.

| ΔE, ΔH | {signs} |
|---|---|---|---|---|
{sign_lines}

The constant part of the transmission error follows from the normal at the pitch point alone: displacements d of the
wheel give -(n . d)/(n_y r_m2), n ~ e_y + tan(alpha) e_u - tan(beta) e_R (e_u across the pitch cone, e_R along it). It
is ΔE/(R_m sin delta) for ΔE, whatever the crowning, tan(alpha) sin(delta) + tan(beta) cos(delta) = 0.75 times that for
ΔH, and Δγ tan(alpha)/sin(delta) for Δγ, whose transmission error is zero only from peak to peak.

![Paths and transmission errors of the spiral pair](bevel_spiral.png)

![Pressure and shift over two errors](bevel_error_map.png)

c1 = {c1:g}/mm, c_t = {ct:g} mm:

| error [mm] |{columns}
|---|---|---|---|---|---|---|
{spiral}
"""

ASSUMED = """the pinion drives, right-hand with its concave
flank; straight pair: lead crowning on the pinion (2, 10, 100 um), parabolic tip relief of 20 um from halfway between
pitch and tip cone on; spiral pair, module 1 mm: everything on the pinion, parabolic tip and root relief from the pitch
cone on, c_t ((u - u_0)/L_t)^2 at the end of the flank, u the cone angle in rad, L_t = 0.16 (the active flank is 0.13
rad high, so that c_t is never reached); ΔA = P, ΔG = G, ΔH = P, Δγ lessens the shaft angle, and both signs where the
source gives none."""


def signs_together(errors: ErrorMap) -> dict[str, str]:
    """Parts of the page on the signs of Delta E and Delta H: the lines of the table, and which signs do for all."""
    table = sign_table(errors)
    both = list(next(iter(table.values())))
    names = {signs: ", ".join("+" if sign > 0 else "-" for sign in signs) for signs in both}

    def common(*figures: str) -> str:
        held = [part for statement, part in table.items() if statement.startswith(figures)]
        return " or ".join(f"({names[signs]})" for signs in both if all(part[signs] for part in held)) or "none"

    pinion, wheel = (f"47: ΔH moves the path towards the root of the {gear}" for gear in ("pinion", "wheel"))
    return {
        "on_pinion": common("45", pinion, "53"),
        "on_wheel": common("45", wheel, "53"),
        "with_amplitude": common("45", wheel, "51", "53"),
        "signs": " | ".join(names.values()),
        "sign_lines": lines(
            [statement, *("yes" if part[signs] else "no" for signs in both)] for statement, part in table.items()
        ),
    }


def document(errors: ErrorMap) -> str:
    """The page, with its tables."""
    return TEXT.format(
        machine=machine(numpy=True),
        **signs_together(errors),
        assumed=ASSUMED,
        straight_trends="\n".join(verdicts(straight_trends())),
        straight=straight_table(),
        spiral_trends="\n".join(verdicts(spiral_trends(errors))),
        spiral=spiral_table(),
        columns=COLUMNS,
        lead=LEAD,
        c1=FULL[0],
        ct=FULL[1],
    )


def page() -> Page:
    """The page with its pictures; a trend that does not hold is a finding."""
    errors = error_map()
    pictures = {
        "bevel_straight": draw_straight(),
        "bevel_straight_crowning": draw_straight_crowning(),
        "bevel_spiral": draw_spiral(),
        "bevel_error_map": draw_error_map(errors),
    }
    return Page("bevel_studies", document(errors), pictures)


if __name__ == "__main__":
    write_page(__doc__, page)
