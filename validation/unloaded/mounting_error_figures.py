"""Numbers that the reduced-TCA dissertation prints of its Figures 24, 26 and 29, beside computed ones.

None can be judged, only shown: window and units of the areas S are not said, nor the crowning at the two smallest
angles of Figure 29, nor the pressure p_0 of the aligned, unmodified pair to which its SR = p/p_0 refer. Taken here: the
areas of Tables 3 and 4, over the turn of these tables, in arcsec times deg; the first constants of Table 4 at
0.05 deg, multiplied by 0.05 deg over the angle; p_0 of the contact line through the pitch point, over the whole face
and under the whole load.
"""

from dataclasses import dataclass
from functools import cache
from math import degrees, radians

import numpy as np

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.reference.hertz import line_contact
from loaded_tca.unloaded import relative_curvature, trace_contact
from validation.table import Row
from validation.unloaded.mounting_error_pairs import ARCSEC, CASE, FORMS, HELICAL, hertz_pressure
from validation.unloaded.reduced_tca_tables import LINES, TURN, amount, path

AREAS = {
    "24": (LINES[6], {"circular": 0.220082, "parabolic": 0.223297, "logarithmic": 0.218083}),
    "26": (LINES[15], {"circular": 0.645048, "parabolic": 0.642903, "logarithmic": 0.509613}),
}
"""Figure -> line of Table 3 or 4 (0.2 deg, the first of three), printed areas S, all negative."""
STRESS_RATIOS = (
    (0.01, "circular", 15.0962),
    (0.01, "parabolic", 15.1661),
    (0.01, "logarithmic", 15.1803),
    (0.02, "circular", 12.6628),
    (0.02, "logarithmic", 12.4127),
    (0.05, "parabolic", 10.0767),
    (0.05, "logarithmic", 10.1105),
)
"""Out-of-plane error [deg], form, SR as printed in the text on Figure 29."""
SMALLEST = LINES[9]
"""Line of Table 4 whose constants are taken: 0.05 deg, the first of three."""


@dataclass(frozen=True)
class Printed:
    """A printed number of a figure beside the computed one, and what had to be assumed."""

    figure: str
    quantity: str
    printed: float
    computed: float
    assumed: str


def areas() -> list[Printed]:
    """Area S between the transmission function and its value at the pitch point [arcsec deg]."""
    found = []
    for figure, (line, numbers) in AREAS.items():
        for form in FORMS:
            error = path(line, form).transmission_error
            area = 0.5 * abs(float(error[1] - error[0])) * ARCSEC * degrees(TURN)
            quantity = f"{line.error.replace('_', '-')} {line.angle:+.1f} deg, {form}: area S [arcsec deg]"
            found.append(Printed(figure, quantity, numbers[form], area, f"over {TURN:g} rad, as {line.table}"))
    return found


@cache
def unmodified_pressure() -> float:
    """Hertz pressure p_0 [MPa] of the aligned helical pair without crowning, on its contact line at phi1 = 0."""
    pair = HELICAL.pair(lead_crowning=0.0)
    contact = trace_contact(pair, [0.0])[0]
    length = float(np.linalg.norm(np.diff(contact.line_ends, axis=0)))
    across = relative_curvature(pair, contact).across
    return line_contact(HELICAL.load / length, across, pair.contact_modulus).max_pressure


def stress_ratios() -> list[Printed]:
    """SR of Figure 29 at phi1 = 0."""
    found = []
    for angle, form, printed in STRESS_RATIOS:
        crowning = amount(SMALLEST, form) * SMALLEST.angle / angle
        mounting = Mounting(out_of_plane=radians(angle))
        pair = HELICAL.pair(mounting, lead_crowning=crowning, lead_crowning_form=form)
        pressure = hertz_pressure(pair, trace_contact(pair, [0.0])[0], HELICAL.load)
        known = angle == SMALLEST.angle
        assumed = "crowning of Table 4" if known else "crowning of Table 4 at 0.05 deg, inversely as the angle"
        quantity = f"out-of-plane {angle:g} deg, {form}: SR"
        found.append(Printed("29", quantity, printed, pressure / unmodified_pressure(), f"{assumed}; p_0 of a line"))
    return found


def rows() -> list[Row]:
    """All of them, without a verdict."""
    return [
        Row(CASE, f"as printed, Figure {one.figure}", one.quantity, one.printed, one.computed, None, one.assumed)
        for one in (*areas(), *stress_ratios())
    ]


def lines() -> list[str]:
    """Cells of a table, one line a number."""
    return [
        f"{one.figure} | {one.quantity} | {one.printed:.5g} | {one.computed:.4g} | {one.computed / one.printed:.3f} "
        f"| {one.assumed}"
        for one in (*areas(), *stress_ratios())
    ]
