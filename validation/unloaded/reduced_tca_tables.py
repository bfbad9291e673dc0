"""Tables 3 and 4 of the reduced-TCA dissertation complete: the circular and logarithmic columns, too.

The helical pair 40/37 of ``reduced_tca_misalignment``, which judges the parabolic column and the slopes. The forms are
the reduced-TCA dissertation, eqs. 10 to 12, with y = v - v0 from the middle of the face and b = 20 mm:

- parabolic c1 y^2;
- circular R - sqrt(R^2 - y^2), R = (4 C_c^2 + b^2)/(8 C_c): C_c is the drop at the ends of the face;
- logarithmic a1 Log(1/(1 - a2 (y/v0)^2)): a2 is not printed, nor v0, nor the base of the logarithm.

What the printed constants mean is judged three ways. (1) Circular and parabolic constants of one line have the same
curvature in the middle, 1/R = 2 c1: they are what they say. (2) The same curvature from the logarithm asks for
a2 = c1 v0^2/a1 with the natural logarithm and v0 = b/2; this is below 1, as it must be for a finite flank, in all
lines but the last three of Table 4, where no a2 gives it: there the logarithmic crowning is another, flatter one.
(With the decimal logarithm every line would ask for a2 > 1: it cannot be meant.) (3) Lead crowning alone does not
change the slope of the transmission error, so that all columns should print one number. They do, up to a scatter that
a straight line cannot have (the last line of each error is 2 to 3 % below its first one), but for the last three
logarithmic entries of Table 4, 13 to 18 % off, and less so the three above: these are shown, not judged.

None of the amounts can be meant as a modification in practice: 0.14 to 2.7 mm are removed at the ends of teeth of
module 1 mm, whose transverse thickness is 1.6 mm; an engineer's crowning is a hundredth of it.
"""

from dataclasses import dataclass
from functools import cache
from math import log, pi, radians
from typing import Literal

import numpy as np

from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.modification import LOGARITHMIC_STEEPNESS
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.unloaded import ContactPath, trace_contact
from validation.table import Row

CASE = "reduced-TCA dissertation, helical 40/37"
ARCSEC = np.degrees(1.0) * 3600.0
FACE_WIDTH, MODULE = 20.0, 1.0
TURN = 0.01
"""Pinion angle [rad] to which the printed maxima belong: inferred, see ``reduced_tca_misalignment``."""
PRINTED = 0.045
"""The source's own scatter: its maxima belong to 0.0096 to 0.0101 rad."""
SAME_CURVATURE = 0.03
"""Largest difference between the circular and parabolic constants of a line (the second of Table 3)."""
ASSUMED = "maximum taken at 0.01 rad, sign ignored"
STEEPNESS = f"{ASSUMED}; a2 = {LOGARITHMIC_STEEPNESS} (not printed), natural logarithm, v0 = b/2"

Error = Literal["in_plane", "out_of_plane"]
Form = Literal["parabolic", "circular", "logarithmic"]


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

    @property
    def logarithm_is_flatter(self) -> bool:
        """Whether no a2 < 1 gives the logarithm the curvature of the parabola."""
        return self.parabolic[0] * (0.5 * FACE_WIDTH) ** 2 / self.logarithmic[0] >= 1.0


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
    """Both columns, line by line; what the constants mean; and the printed shifts, which do not follow from them."""
    found = [row for line in LINES for row in (_maximum(line, "circular"), _maximum(line, "logarithmic"))]
    found += [row for line in LINES for row in (_circular_curvature(line), _logarithmic_steepness(line))]
    found.append(_largest_removal())
    return found + [_shift(*entry) for entry in SHIFTS]


def amount(line: Line, form: Form) -> float:
    """Drop at the ends of the face [mm] that gives a column's constant its meaning."""
    if form == "parabolic":
        return line.parabolic[0] * (0.5 * FACE_WIDTH) ** 2
    if form == "circular":
        return line.circular[0]
    return -line.logarithmic[0] * log(1.0 - LOGARITHMIC_STEEPNESS)


@cache
def path(line: Line, form: Form) -> ContactPath:
    """Contact at the pitch point and 0.01 rad later."""
    gears = [CylindricalGear(z, MODULE, FACE_WIDTH, helix_angle=s * radians(14.0)) for z, s in ((40, 1), (37, -1))]
    crowning = FlankModifications(lead_crowning=amount(line, form), lead_crowning_form=form)
    mounting = Mounting(**{line.error: radians(line.angle)})
    pair = cylindrical_pair(
        CylindricalMesh(gears[0], gears[1]), modifications=(crowning, FlankModifications()), mounting=mounting
    )
    return trace_contact(pair, [0.0, TURN])


def _maximum(line: Line, form: Literal["circular", "logarithmic"]) -> Row:
    expected = getattr(line, form)[1]
    error = path(line, form).transmission_error
    obtained = abs(float(error[1] - error[0])) * ARCSEC
    flat = form == "logarithmic" and line.angle >= 0.1
    label = f"{line.label}, {form}: |TE(0.01) - TE(0)| [arcsec]"
    assumed = STEEPNESS if form == "logarithmic" else ASSUMED
    return Row(CASE, f"as printed, {line.table}", label, expected, obtained, None if flat else PRINTED, assumed)


def _circular_curvature(line: Line) -> Row:
    drop = line.circular[0]
    radius = (4.0 * drop**2 + FACE_WIDTH**2) / (8.0 * drop)
    label = f"{line.label}: c1 = 1/(2 R) of the same curvature [1/mm]"
    return Row(CASE, f"as printed, {line.table}", label, line.parabolic[0], 0.5 / radius, SAME_CURVATURE)


def _logarithmic_steepness(line: Line) -> Row:
    steepness = line.parabolic[0] * (0.5 * FACE_WIDTH) ** 2 / line.logarithmic[0]
    verdict = "impossible: the flank ends inside the face" if line.logarithm_is_flatter else "possible"
    label = f"{line.label}, a1 {line.logarithmic[0]:g} mm: a2 of the same curvature, below 1 ({verdict})"
    return Row(CASE, f"{line.table}, eq. 12", label, 1.0, steepness, None, "natural logarithm, v0 = b/2")


def _largest_removal() -> Row:
    thickness = 0.5 * pi * MODULE / np.cos(radians(14.0))
    removal = max(amount(line, "circular") for line in LINES)
    label = "largest circular crowning beside the transverse thickness of the tooth [mm]"
    return Row(CASE, "Table 3 cannot be meant as a modification in practice", label, float(thickness), removal, None)


def _shift(line: Line, form: Form, expected: float) -> Row:
    obtained = abs(float(path(line, form).pinion_axial[0]))
    label = f"{line.error} {line.angle:+.2f} deg, {form}: distance of the contact from the middle of the face [mm]"
    assumed = "does not follow from the printed constants; at the pitch point"
    return Row(CASE, f"text below {line.table}", label, expected, obtained, None, assumed)
