"""Span and ball measurements of cylindrical gears, and the tooth thickness that follows from either (ISO 21771, 21773).

Lengths are in mm, angles in rad. The allowance A_sn is how much thicker than nominal a tooth is in the normal section
at the reference cylinder: negative, with backlash.
"""

from __future__ import annotations

from math import acos, cos, hypot, inf, pi, sin, sqrt, tan
from typing import TYPE_CHECKING

from loaded_tca.errors import InputError, require
from loaded_tca.gears.involute import inverse_involute, involute
from loaded_tca.plain import plain

if TYPE_CHECKING:
    from loaded_tca.gears.cylindrical import CylindricalGear

LARGEST_ALLOWANCE = 0.5
"""Of either sign, over the module: a third of the thickness of a tooth. Measured over another number of teeth a span
differs by a base pitch, 3 modules."""


def span_teeth(gear: CylindricalGear) -> int:
    r"""Number of teeth k over which a span touches the flanks nearest to the diameter d + 2 x m_n.

    .. math:: k = \frac{z}{\pi}\left(\frac{\tan\alpha_v}{\cos^2\beta_b} - \frac{2 x}{z} \tan\alpha_n
              - \mathrm{inv}\,\alpha_t\right) + \frac{1}{2},\qquad \cos\alpha_v = \frac{d_b}{d + 2 x m_n}

    rounded to a whole number, at least 1.

    References
    ----------
    DIN 3960:1987 and DIN 21773:2014, span measurement.
    """
    touched = max(gear.base_radius, gear.reference_radius + gear.profile_shift * gear.normal_module)
    tangent = gear.roll_length(touched) / gear.base_radius
    shift = 2.0 * gear.profile_shift / gear.teeth * tan(gear.pressure_angle)
    turn = tangent / cos(gear.base_helix_angle) ** 2 - shift - involute(gear.transverse_pressure_angle)
    return max(1, round(gear.teeth / pi * turn + 0.5))


def span_measurement(gear: CylindricalGear, teeth: int) -> float:
    r"""Span W_k between parallel planes that touch the outer flanks of k teeth [mm].

    .. math:: W_k = m_n \cos\alpha_n \left(\pi (k - 1/2) + z\,\mathrm{inv}\,\alpha_t\right)
              + 2 x_E m_n \sin\alpha_n

    Raises
    ------
    InputError
        If k is no number of teeth, the planes touch beside the flanks, or the span is longer than the face of a
        helical gear lets it be.

    References
    ----------
    ISO 21771:2007; DIN 21773:2014.
    """
    span = _span(gear, teeth, gear.generating_profile_shift)
    radius = hypot(gear.base_radius, 0.5 * span * cos(gear.base_helix_angle))
    require(_touches(gear, radius, f"span_teeth: a span over {teeth} teeth"), owner=gear.name)
    needed = span * abs(sin(gear.base_helix_angle))
    require(
        (
            needed < gear.face_width,
            f"span_teeth: a span over {teeth} teeth needs a face width above {plain(needed)} mm",
        ),
        owner=gear.name,
    )
    return span


def allowance_of_span(gear: CylindricalGear, span: float, teeth: int) -> float:
    """Allowance A_sn of a gear whose span over k teeth is measured [mm]; that of ``gear`` itself does not count.

    Raises
    ------
    InputError
        If k is no number of teeth, or the allowance is above half a module.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gear = CylindricalGear(teeth=25, normal_module=2.0, face_width=20.0)
    >>> round(1e3 * allowance_of_span(gear, 15.4233, 3))  # um
    -40
    """
    nominal = _span(gear, teeth, gear.profile_shift)
    allowance = (span - nominal) / cos(gear.pressure_angle)
    return _allowance(gear, allowance, f"span_measurement: {span:.6g} mm over {teeth} teeth", nominal)


def _span(gear: CylindricalGear, teeth: int, shift: float) -> float:
    """W_k of any profile shift."""
    whole = teeth == int(teeth) if abs(teeth) < inf else False
    require(
        (whole and 1 <= teeth < gear.teeth, f"span_teeth: {teeth} is not a whole number from 1 to {gear.teeth - 1}"),
        owner=gear.name,
    )
    pitches = pi * (teeth - 0.5) + gear.teeth * involute(gear.transverse_pressure_angle)
    return gear.normal_module * (cos(gear.pressure_angle) * pitches + 2.0 * shift * sin(gear.pressure_angle))


def ball_measurement(gear: CylindricalGear, diameter: float) -> float:
    r"""Measure M_dK over two balls in spaces that are as opposite as the teeth let them [mm].

    .. math:: \mathrm{inv}\,\alpha_K = \psi_b + \frac{D_M}{z m_n \cos\alpha_n} - \frac{\pi}{z},\qquad
              M_{dK} = \frac{d_b}{\cos\alpha_K} \cos\delta + D_M

    with delta = 0 for an even number of teeth, pi/(2 z) for an odd one, and :math:`\psi_b = s_t/d +
    \mathrm{inv}\,\alpha_t` of the teeth with their allowance.

    Raises
    ------
    InputError
        If the balls touch beside the flanks, rest on the root, or do not stand out of the tips.

    References
    ----------
    ISO 21771:2007; DIN 21773:2014.
    """
    centre = _ball_centre(gear, diameter)
    tangent = sqrt((centre - gear.base_radius) * (centre + gear.base_radius))
    contact = tangent - 0.5 * diameter * cos(gear.base_helix_angle)
    what = f"ball_diameter: a ball of {diameter:.6g} mm"
    require(_touches(gear, hypot(gear.base_radius, contact) if contact > 0.0 else 0.0, what), owner=gear.name)
    require(
        (centre - 0.5 * diameter > gear.root_radius, f"{what} rests on the root and not on the flanks"),
        (centre + 0.5 * diameter > gear.tip_radius, f"{what} does not stand out of the tips"),
        owner=gear.name,
    )
    return 2.0 * centre * _opposite(gear) + diameter


def allowance_of_balls(gear: CylindricalGear, measurement: float, diameter: float) -> float:
    """Allowance A_sn of a gear that is measured over two balls [mm]; that of ``gear`` itself does not count.

    Raises
    ------
    InputError
        If the balls would lie below the base circle, or the allowance is above half a module.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gear = CylindricalGear(teeth=20, normal_module=2.0, face_width=20.0)
    >>> round(1e3 * allowance_of_balls(gear, 44.8395, 3.5))  # um
    -40
    """
    centre = 0.5 * (measurement - diameter) / _opposite(gear)
    what = f"ball_measurement: {measurement:.6g} mm over balls of {diameter:.6g} mm"
    require(
        (0.0 < diameter < inf, f"ball_diameter: {diameter} mm is not positive and finite"),
        (
            gear.base_radius < centre < inf,
            f"{what} has them inside the base circle, diameter {2.0 * gear.base_radius:.6g} mm",
        ),
        owner=gear.name,
    )
    widening = _half_angle_of_ball(gear, diameter)
    half = involute(acos(gear.base_radius / centre)) - widening + pi / gear.teeth
    nominal = gear.half_thickness_angle_at_base - gear.thickness_allowance / (
        2.0 * gear.reference_radius * cos(gear.helix_angle)
    )
    allowance = 2.0 * gear.reference_radius * cos(gear.helix_angle) * (half - nominal)
    value = nominal + widening - pi / gear.teeth
    expected = 2.0 * gear.base_radius / cos(inverse_involute(max(0.0, value))) * _opposite(gear) + diameter
    return _allowance(gear, allowance, what, expected)


def _ball_centre(gear: CylindricalGear, diameter: float) -> float:
    """Radius of the centres of balls that touch both flanks of their space."""
    require((0.0 < diameter < inf, f"ball_diameter: {diameter} mm is not positive and finite"), owner=gear.name)
    value = gear.half_thickness_angle_at_base + _half_angle_of_ball(gear, diameter) - pi / gear.teeth
    if value <= 0.0:
        raise InputError(f"{gear.name}: ball_diameter: a ball of {diameter:.6g} mm falls between the flanks")
    return gear.base_radius / cos(inverse_involute(value))


def _half_angle_of_ball(gear: CylindricalGear, diameter: float) -> float:
    """Angle by which a ball moves its contact from its centre, on the base circle: D_M/(z m_n cos(alpha_n))."""
    return diameter / (gear.teeth * gear.normal_module * cos(gear.pressure_angle))


def _opposite(gear: CylindricalGear) -> float:
    """What remains of the radius across the axis where no two spaces are opposite."""
    return 1.0 if gear.teeth % 2 == 0 else cos(0.5 * pi / gear.teeth)


def _touches(gear: CylindricalGear, radius: float, what: str) -> tuple[bool, str]:
    """Check of a contact point: on the flank, between form and tip circle."""
    low, high = gear.form_radius, gear.tip_radius
    place = f"at diameter {2.0 * radius:.6g} mm" if radius > 0.0 else "below the base circle"
    flank = f"the flanks reach from {2.0 * low:.6g} to {2.0 * high:.6g} mm"
    return low <= radius <= high, f"{what} touches no flank: it would be {place}, and {flank}"


def _allowance(gear: CylindricalGear, allowance: float, what: str, nominal: float) -> float:
    """Return an allowance that can be one."""
    largest, sense = LARGEST_ALLOWANCE * gear.normal_module, "thicker" if allowance > 0.0 else "thinner"
    require(
        (
            abs(allowance) <= largest,
            f"{what} makes the teeth {plain(abs(allowance))} mm {sense} than nominal, where it is {nominal:.6g} mm; "
            f"allowed up to half a module, {largest:.6g} mm",
        ),
        owner=gear.name,
    )
    return allowance
