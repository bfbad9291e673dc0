"""Undercut gears against a rack that is rolled point by point, and against the limit of a slight undercut.

No printed form circle or contact ratio of an undercut gear was found. The form circle of the package is a root of the
trochoid by the law of gearing; here every point of the rack's tip passes a radius twice as it rolls, and the half tooth
that all leave is compared with the involute. Contact ratios follow, as the wheel reaches beyond the line of action.

Where the undercut is slight the involute is (s^2/2, s^3/3) beside its start, and the end s0 < 0 of the rack's flank
leaves along the tangent of the mirrored branch: (s - s0)^2 (2 s + s0) = 0 has them cross at -s0/2.
"""

from math import cos, pi, radians, sin, sqrt, tan

import numpy as np

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.roots import find_root
from validation.table import Row

CASE, ROLLING, LIMIT = "undercut", "rack rolled point by point", "closed form of a slight undercut"
ANGLE = radians(20.0)
TEETH, WHEEL = (8, 10, 12, 14), 40
SLIGHT, FIRST_ORDER = 1e-3, 1e-3
"""Profile shift below the limit, and its effect: in proportion to it, 5.6e-3 at a shift of 1e-2."""
ROLLED = 1e-8
"""Of a radius: 2000 points along the rounding of a rack miss the deepest by the square of their distance."""


def rows() -> list[Row]:
    """Form circles and contact ratios of few teeth."""
    table = []
    for teeth in TEETH:
        gear, radius = CylindricalGear(teeth, 1.0, 10.0), rolled_form_radius(teeth)
        table.append(Row(CASE, ROLLING, f"z {teeth}: d_Ff [mm]", 2.0 * radius, 2.0 * gear.form_radius, ROLLED))
        base = 0.5 * teeth * cos(ANGLE)
        start, end = sqrt(radius**2 - base**2), sqrt((0.5 * teeth + 1.0) ** 2 - base**2)
        ratio = CylindricalMesh(gear, CylindricalGear(WHEEL, 1.0, 10.0)).transverse_contact_ratio
        what = f"z {teeth}/{WHEEL}: transverse contact ratio"
        table.append(Row(CASE, ROLLING, what, (end - start) / (pi * cos(ANGLE)), ratio, ROLLED * (base / start) ** 2))
    helical = CylindricalGear(10, 1.0, 10.0, helix_angle=0.3)
    radius = rolled_form_radius(10, helix_angle=0.3)
    table.append(Row(CASE, ROLLING, "z 10, beta 0.3 rad: d_Ff [mm]", 2.0 * radius, 2.0 * helical.form_radius, ROLLED))
    shift = CylindricalGear(10, 1.0, 10.0).smallest_profile_shift - SLIGHT
    slight = CylindricalGear(10, 1.0, 10.0, profile_shift=shift)
    begins = -slight.roll_length(slight.form_radius) / slight.rack_form_roll_length
    table.append(Row(CASE, LIMIT, "z 10: roll length of d_Ff over that of the rack", 0.5, begins, FIRST_ORDER))
    return table


def rolled_form_radius(teeth, *, helix_angle=0.0, rounding=0.38, shift=0.0, left=0.0):
    """Where a rounded rack of module 1 that rolls on the reference circle leaves the involute of its flank.

    Each point of its tip passes a radius twice; the half tooth that it leaves is the least of all. A protuberance of
    half the pressure angle cuts by ``left`` into the ground flank.
    """
    angle, reference = np.arctan(tan(ANGLE) / cos(helix_angle)), 0.5 * teeth / cos(helix_angle)
    least = ANGLE if left == 0.0 else 0.5 * ANGLE
    normal, up = np.linspace(least, 0.5 * pi, 2000), np.linspace(0.0, 0.5 if left else 0.0, 2000)
    beside = pi / 4.0 - 1.25 * tan(ANGLE) + (left + rounding * (sin(ANGLE) - 1.0)) / cos(ANGLE)
    x = np.append(beside + rounding * np.cos(normal), beside + rounding * cos(least) + up * tan(least))
    x /= cos(helix_angle)
    y = np.append(-rounding * np.sin(normal), up - rounding * sin(least)) + reference + shift - (1.25 - rounding)
    base, thickness = reference * cos(angle), (pi / 2.0 + 2.0 * shift * tan(ANGLE)) / cos(helix_angle)

    def cut(radius):
        across = np.sqrt(np.maximum(radius**2 - y**2, 0.0)) * np.array([[1.0], [-1.0]])
        half = pi / teeth - np.arctan2(across, y) + (across - x) / reference
        roll = sqrt((radius / base) ** 2 - 1.0)
        flank = 0.5 * thickness / reference + tan(angle) - angle - (roll - np.arctan(roll))
        return float(half[:, np.abs(y) < radius].min() - flank)

    return find_root(cut, base * (1.0 + 1e-9), reference)
