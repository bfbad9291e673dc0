"""Tables 3 and 4 of the reduced-TCA dissertation: the printed maxima of the transmission error, column by column.

The helical pair 40/37 of ``reduced_tca_misalignment``, which judges the slopes. The forms of crowning are the
reduced-TCA dissertation, eqs. 10 to 12, with y = v - v0 from the middle of the face and b = 20 mm:

- parabolic c1 y^2;
- circular R - sqrt(R^2 - y^2), R = (4 C_c^2 + b^2)/(8 C_c): C_c is the drop at the ends of the face;
- logarithmic a1 Log(1/(1 - a2 (y/v0)^2)): a2 is not printed, nor v0, nor the base of the logarithm.

Lead crowning alone does not change the slope of the transmission error, so that the three columns and three lines of an
error print one number: 48 rows judge no more than six slopes. The source does not say over which turn of the pinion it
took its maxima; divided by the slopes they ask for 0.0096 to 0.0101 rad. The middle, 0.00985 rad, is taken for all, and
they lie within 3 % of it, a scatter that a straight line cannot have (the last line of each error is 2 to 3 % below its
first one). The printed sign, negative throughout, is ignored. Six logarithmic entries of Table 4 (0.1 and 0.2 deg) are
shown, not judged: up to 17 % off.

What the printed constants mean: (1) Circular and parabolic constants of one line have the same curvature in the middle,
1/R = 2 c1: they are what they say. (2) The same curvature from the logarithm asks for a2 = c1 v0^2/a1 with the natural
logarithm and v0 = b/2; this is below 1, as it must be for a finite flank, in all lines but the last three of Table 4,
where no a2 gives it: there the logarithmic crowning is another, flatter one. (With the decimal logarithm every line
would ask for a2 > 1: it cannot be meant.) Taken here is k = 0.99 of docs/reference/conventions.md; the slopes do not
depend on it, the place of the contact does.

None of the amounts can be meant as a modification in practice: 0.14 to 2.7 mm are removed at the ends of teeth of
module 1 mm, whose transverse thickness is 1.6 mm; an engineer's crowning is a hundredth of it.
"""

from dataclasses import dataclass
from functools import cache
from math import cos, log, radians, sqrt
from typing import Literal

import numpy as np

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import ContactPath, trace_contact
from validation.table import Row

CASE = "reduced-TCA dissertation, helical 40/37"
ARCSEC = np.degrees(1.0) * 3600.0
FACE_WIDTH, MODULE = 20.0, 1.0
TURN = 0.00985
"""Pinion angle [rad] to which the printed maxima belong: inferred, the middle of 0.0096 to 0.0101."""
PRINTED = 0.03
"""The source's own scatter about it."""
SAME_CURVATURE = 0.03
"""Largest difference between the circular and parabolic constants of a line (the second of Table 3)."""
STEEPNESS = 0.99
"""k of docs/reference/conventions.md: a2 = k."""
FIRST_ORDER = 6e-4
"""Three times what the second order of 0.05 deg adds."""
NOTE = "48 rows, six slopes; sign ignored"
ASSUMED = f"turn of {TURN} rad (inferred)"
LOGARITHM = f"a2 = {STEEPNESS}, natural logarithm, v0 = b/2"

Error = Literal["in_plane", "out_of_plane"]
Form = Literal["parabolic", "circular", "logarithmic"]
FORMS: tuple[Form, ...] = ("parabolic", "circular", "logarithmic")


@dataclass(frozen=True)
class Line:
    """One line of a table: the error [deg], then constant and printed maximum [arcsec] of each column."""

    error: Error
    angle: float
    circular: tuple[float, float]
    parabolic: tuple[float, float]
    logarithmic: tuple[float, float]

    @property
    def label(self) -> str:
        """The error and the circular constant, which no other line has."""
        return f"{self.error} {self.angle:+.2f} deg, C_c {self.circular[0]:g} mm"

    @property
    def table(self) -> str:
        """Where it is printed."""
        return "Table 3" if self.error == "in_plane" else "Table 4"


LINES = (
    Line("in_plane", -0.05, (2.398, 0.15843), (0.0227, 0.158389), (2.515, 0.158352)),
    Line("in_plane", -0.05, (2.400, 0.15384), (0.0233, 0.159286), (2.600, 0.158858)),
    Line("in_plane", -0.05, (2.565, 0.153797), (0.0240, 0.154701), (2.669, 0.153776)),
    Line("in_plane", -0.1, (1.104, 0.31696), (0.0110, 0.316706), (1.201, 0.316326)),
    Line("in_plane", -0.1, (1.150, 0.316498), (0.0113, 0.317616), (1.236, 0.31794)),
    Line("in_plane", -0.1, (1.173, 0.316498), (0.0115, 0.31153), (1.275, 0.30746)),
    Line("in_plane", -0.2, (0.507, 0.633315), (0.0051, 0.635564), (0.537, 0.628879)),
    Line("in_plane", -0.2, (0.520, 0.637441), (0.0052, 0.636932), (0.553, 0.632365)),
    Line("in_plane", -0.2, (0.535, 0.618792), (0.0053, 0.625768), (0.572, 0.611297)),
    Line("out_of_plane", 0.05, (0.804, 0.4225422), (0.00799, 0.42257), (0.873, 0.42094)),
    Line("out_of_plane", 0.05, (0.830, 0.424252), (0.00820, 0.424946), (0.900, 0.423014)),
    Line("out_of_plane", 0.05, (0.853, 0.410921), (0.00847, 0.410987), (0.927, 0.409179)),
    Line("out_of_plane", 0.1, (0.360, 0.845263), (0.00359, 0.845918), (0.368, 0.831488)),
    Line("out_of_plane", 0.1, (0.370, 0.850059), (0.00370, 0.849776), (0.380, 0.836597)),
    Line("out_of_plane", 0.1, (0.381, 0.823004), (0.00380, 0.825234), (0.393, 0.809249)),
    Line("out_of_plane", 0.2, (0.143, 1.69059), (0.00143, 1.69062), (0.046, 1.4328)),
    Line("out_of_plane", 0.2, (0.146, 1.70474), (0.00146, 1.7048), (0.055, 1.49707)),
    Line("out_of_plane", 0.2, (0.150, 1.66515), (0.00150, 1.66508), (0.081, 1.48844)),
)
SHIFTS: tuple[tuple[Line, Form, float], ...] = (
    (LINES[6], "parabolic", 1.3),
    (LINES[15], "circular", 5.0),
    (LINES[15], "logarithmic", 6.5),
)
"""Distance [mm] of the contact from the middle of the face, as the text below Table 4 has it for 0.2 deg."""


def rows() -> list[Row]:
    """Every column, line by line; the circular constants; and the printed shifts, which do not follow from them."""
    found = [_maximum(line, form) for line in LINES for form in FORMS]
    found += [_circular_curvature(line) for line in LINES]
    found.append(_logarithmic_shift(LINES[9]))
    return found + [_shift(*entry) for entry in SHIFTS]


def amount(line: Line, form: Form) -> float:
    """Drop at the ends of the face [mm] that gives a column's constant its meaning."""
    if form == "parabolic":
        return line.parabolic[0] * (0.5 * FACE_WIDTH) ** 2
    if form == "circular":
        return line.circular[0]
    return -line.logarithmic[0] * log(1.0 - STEEPNESS)


@cache
def pair(line: Line, form: Form) -> GearPair:
    """The pair with the crowning and the error of a line."""
    gears = [CylindricalGear(z, MODULE, FACE_WIDTH, helix_angle=s * radians(14.0)) for z, s in ((40, 1), (37, -1))]
    crowning = FlankModifications(lead_crowning=amount(line, form), lead_crowning_form=form)
    return cylindrical_pair(
        CylindricalMesh(*gears),
        modifications=(crowning, FlankModifications()),
        mounting=Mounting(**{line.error: radians(line.angle)}),
    )


@cache
def path(line: Line, form: Form) -> ContactPath:
    """Contact at the pitch point and at the turn of the printed maxima."""
    return trace_contact(pair(line, form), [0.0, TURN])


def _maximum(line: Line, form: Form) -> Row:
    expected = getattr(line, form)[1]
    error = path(line, form).transmission_error
    obtained = abs(float(error[1] - error[0])) * ARCSEC
    flat = form == "logarithmic" and line.angle >= 0.1
    label = f"{line.label}, {form}: |TE({TURN}) - TE(0)| [arcsec]"
    assumed = f"{ASSUMED}; {LOGARITHM}" if form == "logarithmic" else ASSUMED
    source, note = f"as printed, {line.table}", "" if flat else NOTE
    return Row(CASE, source, label, expected, obtained, None if flat else PRINTED, assumed, note)


def _circular_curvature(line: Line) -> Row:
    """Curvature of the circular crowning at mid-face, of the flank itself, beside the parabola's."""
    flank = pair(line, "circular").pinion.flank
    bend = flank.removal(np.array(0.5 * MODULE * 40.0), np.array(0.0)).z_z
    label = f"{line.label}: c1 = 1/(2 R) of the same curvature [1/mm]"
    return Row(CASE, f"as printed, {line.table}", label, line.parabolic[0], 0.5 * float(bend), SAME_CURVATURE)


def _logarithmic_shift(line: Line) -> Row:
    """Place of the contact where the logarithm has the slope of the error, f/cos(beta_b)."""
    gears = pair(line, "logarithmic")
    contact = trace_contact(gears, [0.0])[0]
    transverse = np.arctan(np.tan(radians(20.0)) / cos(radians(14.0)))
    base_helix = np.arcsin(np.sin(radians(14.0)) * cos(radians(20.0)))
    slope, a1 = radians(line.angle) * cos(transverse) / cos(base_helix), line.logarithmic[0]
    expected = (sqrt(a1**2 + (0.5 * slope * FACE_WIDTH) ** 2 / STEEPNESS) - a1) / slope
    label = f"{line.error} {line.angle:+.2f} deg, a1 {a1:g} mm, k {STEEPNESS}: shift of the contact [mm]"
    source = "slope of a1 Log(1/(1 - k (2 y/b)^2)), first order"
    return Row(CASE, source, label, expected, float(contact.pinion_axial), FIRST_ORDER)


def _shift(line: Line, form: Form, expected: float) -> Row:
    obtained = abs(float(path(line, form).pinion_axial[0]))
    label = f"{line.error} {line.angle:+.2f} deg, {form}: distance of the contact from the middle of the face [mm]"
    note = "does not follow from the printed constants; at the pitch point"
    return Row(CASE, f"text below {line.table}", label, expected, obtained, None, note=note)
