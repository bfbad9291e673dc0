"""Flank tolerances of cylindrical gears by tolerance class, after ISO 1328-1:2013.

The edition of 2013 (ANSI/AGMA ISO 1328-1-B14, JIS B 1702-1:2016 and GB/T 10095.1-2022 have the same numbers) gives
formulas instead of the tables of 1995: each tolerance follows from diameter, module and face width themselves, not from
the ranges they lie in. Its classes 1 to 11 are not the grades 0 to 12 of 1995.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, floor, hypot, inf, pi, sqrt

from loaded_tca.arguments import checked
from loaded_tca.errors import require, require_positive
from loaded_tca.plain import plain

TOLERANCE_CLASSES = range(1, 12)
_REFERENCE_CLASS = 5  # the formulas are those of this class; each step from class to class is a factor sqrt(2)
_TEETH = (5, 1000)
_DIAMETERS = (5.0, 15000.0)
_MODULES = (0.5, 70.0)
_FACE_WIDTHS = (4.0, 1200.0)
_LARGEST_HELIX = 45.0


@dataclass(frozen=True)
class FlankTolerances:
    """Tolerances of the flanks of one gear [um].

    Those of slopes bound the amount to both sides: a slope may be between minus and plus the tolerance. All others
    bound a range from the lowest to the highest deviation.

    Parameters
    ----------
    single_pitch : float [um]
        f_pT.
    cumulative_pitch : float [um]
        F_pT, over all teeth.
    profile_slope, profile_form, total_profile : float [um]
        f_HalphaT, f_falphaT, F_alphaT.
    helix_slope, helix_form, total_helix : float [um]
        f_HbetaT, f_fbetaT, F_betaT, over the face width.
    """

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float
    total_profile: float
    helix_slope: float
    helix_form: float
    total_helix: float


@checked
def flank_tolerances(
    teeth: int,
    normal_module: float,
    face_width: float,
    tolerance_class: int,
    helix_angle: float = 0.0,
    rounded: bool = True,
) -> FlankTolerances:
    r"""Tolerances of pitch, profile and helix of a gear of a flank tolerance class.

    With the reference diameter d, the normal module m_n and the face width b in mm, in um for class A:

    .. math::
        f_{pT} &= (0.001\,d + 0.4\,m_n + 5)\,\sqrt{2}^{\,A - 5} \\
        F_{pT} &= (0.002\,d + 0.55 \sqrt{d} + 0.7\,m_n + 12)\,\sqrt{2}^{\,A - 5} \\
        f_{H\alpha T} &= (0.4\,m_n + 0.001\,d + 4)\,\sqrt{2}^{\,A - 5} \\
        f_{f\alpha T} &= (0.55\,m_n + 5)\,\sqrt{2}^{\,A - 5} \\
        f_{H\beta T} &= (0.05 \sqrt{d} + 0.35 \sqrt{b} + 4)\,\sqrt{2}^{\,A - 5} \\
        f_{f\beta T} &= (0.07 \sqrt{d} + 0.45 \sqrt{b} + 4)\,\sqrt{2}^{\,A - 5}

    and :math:`F_{\alpha T}`, :math:`F_{\beta T}` are the roots of the sums of the squares of slope and form, before
    these are rounded.

    Parameters
    ----------
    teeth : int
        From 5 to 1000.
    normal_module : float [mm]
        From 0.5 to 70.
    face_width : float [mm]
        From 4 to 1200.
    tolerance_class : int
        From 1, the finest, to 11.
    helix_angle : float [rad]
        Up to 45 deg, of either sign.
    rounded : bool
        As a drawing has them: to 1 um above 10, to 0.5 um from 5 to 10, to 0.1 um below.

    Returns
    -------
    FlankTolerances

    Raises
    ------
    InputError
        Where the formulas do not hold: outside the ranges above, or with a reference diameter that is not between 5 and
        15000 mm. The standard forbids to extrapolate.

    References
    ----------
    ISO 1328-1:2013, 5.2 (range, steps, rounding) and eqs. 5 to 12.

    Examples
    --------
    >>> gear = flank_tolerances(40, 3.0, 30.0, 6)
    >>> gear.single_pitch, gear.cumulative_pitch, gear.total_profile, gear.helix_slope
    (9.0, 29.0, 12.0, 9.0)
    """
    require_positive(normal_module=normal_module)
    tilt = abs(helix_angle)
    require(
        (tolerance_class in TOLERANCE_CLASSES, f"tolerance_class: {tolerance_class} is not one of 1 to 11"),
        (tilt < 0.5 * pi, f"helix_angle: {helix_angle} rad is not between -90 and 90 deg"),
    )
    diameter = teeth * normal_module / cos(tilt)
    require(
        _within("teeth", teeth, _TEETH),
        _within("normal_module", normal_module, _MODULES, " mm"),
        _within("reference diameter", diameter, _DIAMETERS, " mm"),
        _within("face_width", face_width, _FACE_WIDTHS, " mm"),
        _within("helix_angle", degrees(tilt), (-inf, _LARGEST_HELIX), " deg"),
    )
    step = 2.0 ** (0.5 * (tolerance_class - _REFERENCE_CLASS))
    root, breadth = sqrt(diameter), sqrt(face_width)
    profile_slope = step * (0.4 * normal_module + 0.001 * diameter + 4.0)
    profile_form = step * (0.55 * normal_module + 5.0)
    helix_slope = step * (0.05 * root + 0.35 * breadth + 4.0)
    helix_form = step * (0.07 * root + 0.45 * breadth + 4.0)
    values = (
        step * (0.001 * diameter + 0.4 * normal_module + 5.0),
        step * (0.002 * diameter + 0.55 * root + 0.7 * normal_module + 12.0),
        profile_slope,
        profile_form,
        hypot(profile_slope, profile_form),
        helix_slope,
        helix_form,
        hypot(helix_slope, helix_form),
    )
    return FlankTolerances(*map(_as_on_drawings, values) if rounded else values)


def _within(name: str, value: float, limits: tuple[float, float], unit: str = "") -> tuple[bool, str]:
    """Check of a range of validity, and its problem."""
    low, high = limits
    allowed = f"up to {plain(high, 6)}{unit}" if low == -inf else f"{plain(low, 6)} to {plain(high, 6)}{unit}"
    return low <= value <= high, f"{name}: {plain(value, 6)}{unit}, where ISO 1328-1 holds for {allowed}"


def _as_on_drawings(value: float) -> float:
    """Value rounded as ISO 1328-1, 5.2.3 asks; halves go up."""
    parts = 1 if value > 10.0 else 2 if value >= 5.0 else 10
    return floor(value * parts + 0.5) / parts
