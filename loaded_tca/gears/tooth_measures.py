"""Measures of cylindrical gears over spans, balls and pins, and the tooth thickness that follows (ISO 21771, 21773).

Lengths are in mm, angles in rad. The allowance A_sn is how much thicker than nominal a tooth is in the normal section
at the reference cylinder: negative, with backlash.

Rings are measured from inside: over the spaces of a ring with straight teeth, and between balls. With the sign of the
number of teeth, s = +1 of an external gear and -1 of a ring, both have the same equations.
"""

from __future__ import annotations

from math import acos, cos, hypot, inf, pi, sin, sqrt, tan
from typing import TYPE_CHECKING, Literal

from loaded_tca.errors import InputError, require
from loaded_tca.gears.involute import InvoluteGear, inverse_involute, involute
from loaded_tca.plain import plain

LARGEST_ALLOWANCE = 0.5
"""Of either sign, over the module: a third of the thickness of a tooth. Measured over another number of teeth a span
differs by a base pitch, 3 modules."""
Body = Literal["ball", "pin"]
"""What lies in two spaces where a measure is taken over them."""


class MeasuredGear(InvoluteGear):
    """Gear whose tooth thickness is measured: an external gear or a ring with an allowance A_sn."""

    thickness_allowance: float
    addendum_coefficient: float
    tip_alteration_coefficient: float
    topping: bool
    tip_chamfer: float
    tip_chamfer_angle: float | None

    if TYPE_CHECKING:  # a property of each gear

        @property
        def root_radius(self) -> float:
            """abs(r_f) [mm]."""

        @property
        def half_thickness_angle_at_base(self) -> float:
            """Half tooth thickness angle at the base circle [rad]."""

    @property
    def generating_profile_shift(self) -> float:
        """x_E = x + A_sn/(2 m_n tan(alpha_n)), with which the teeth are cut (ISO 21771, 7.4)."""
        return self.profile_shift + 0.5 * self.thickness_allowance / (self.normal_module * tan(self.pressure_angle))

    @property
    def addendum(self) -> float:
        """Height of the tip above the reference circle where no tip diameter is given, h_aP/m_n + x + k [m_n]."""
        if self.topping:
            return self.addendum_coefficient + self.generating_profile_shift
        return self.addendum_coefficient + self.profile_shift + self.tip_alteration_coefficient

    @property
    def tip_form_radius(self) -> float:
        """abs(r_Fa), where the flank ends: at the chamfer, or at the tip [mm]."""
        return self.tip_radius - _side(self) * self.tip_chamfer

    @property
    def tooth_thickness(self) -> float:
        """Transverse tooth thickness s_t at the reference cylinder, an arc [mm]."""
        return self.transverse_module * (0.5 * pi + 2.0 * self.generating_profile_shift * tan(self.pressure_angle))

    @property
    def normal_tooth_thickness(self) -> float:
        """s_n = s_t cos(beta) at the reference cylinder, an arc [mm]."""
        return self.tooth_thickness * cos(self.helix_angle)

    @property
    def span_teeth(self) -> int:
        """Number of teeth k that a span is best taken over, of spaces of a ring; it touches nearest to d + 2 x m_n."""
        return span_teeth(self)

    def span_measurement(self, teeth: int | None = None) -> float:
        """Span W_k over teeth or spaces, :attr:`span_teeth` by default [mm]; InputError where it touches no flank.

        Examples
        --------
        >>> from loaded_tca.gears import CylindricalGear
        >>> gear = CylindricalGear(teeth=25, normal_module=2.0, face_width=20.0)
        >>> gear.span_teeth, round(gear.span_measurement(), 4)
        (3, 15.4609)
        """
        return span_measurement(self, self.span_teeth if teeth is None else teeth)

    def ball_measurement(self, diameter: float) -> float:
        """Measure M_dK over two balls in opposite spaces, of a ring between them [mm]; InputError off the flanks.

        Examples
        --------
        >>> from loaded_tca.gears import CylindricalGear, RingGear
        >>> gear = CylindricalGear(teeth=20, normal_module=2.0, face_width=20.0)
        >>> round(gear.ball_measurement(3.5), 4)
        44.9293
        >>> round(RingGear(teeth=-60, normal_module=3.0, face_width=20.0).ball_measurement(5.0), 4)
        173.2626
        """
        return _measurement_over(self, "ball", diameter)

    def pin_measurement(self, diameter: float) -> float:
        """Measure M_dR over two pins in opposite spaces, of a ring between them [mm]; InputError off the flanks.

        Examples
        --------
        >>> from loaded_tca.gears import CylindricalGear
        >>> gear = CylindricalGear(teeth=21, normal_module=2.0, face_width=20.0, helix_angle=0.3)
        >>> round(gear.ball_measurement(3.5), 4), round(gear.pin_measurement(3.5), 4)
        (48.7886, 48.9156)
        """
        return _measurement_over(self, "pin", diameter)


def _side(gear: MeasuredGear) -> int:
    """+1 of an external gear, -1 of a ring, which is measured from inside."""
    return 1 if gear.teeth > 0 else -1


def allowance_of_thickness(gear: MeasuredGear, thickness: float) -> float:
    """Allowance A_sn of a gear whose normal tooth thickness s_n is given [mm]; that of ``gear`` itself does not count.

    Parameters
    ----------
    gear : CylindricalGear or RingGear
    thickness : float [mm]
        In the normal section at the reference cylinder, an arc.

    Raises
    ------
    InputError
        If the allowance is above half a module.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gear = CylindricalGear(teeth=25, normal_module=2.0, face_width=20.0)
    >>> round(1e3 * allowance_of_thickness(gear, 3.1016), 1)  # um
    -40.0
    """
    nominal = gear.normal_module * (0.5 * pi + 2.0 * gear.profile_shift * tan(gear.pressure_angle))
    return _allowance(gear, thickness - nominal, f"normal_tooth_thickness: {plain(thickness, 6)} mm", nominal)


def span_teeth(gear: MeasuredGear) -> int:
    r"""Number of teeth k over which a span touches the flanks nearest to the diameter d + 2 x m_n.

    .. math:: k = \frac{z}{\pi}\left(\frac{\tan\alpha_v}{\cos^2\beta_b} - \frac{2 x}{z} \tan\alpha_n
              - \mathrm{inv}\,\alpha_t\right) + \frac{1}{2},\qquad \cos\alpha_v = \frac{d_b}{d + 2 x m_n}

    rounded to a whole number, at least 1. Of a ring, with positive numbers of teeth and diameters, x counts with a
    minus.

    References
    ----------
    DIN 3960:1987 and DIN 21773:2014, span measurement.
    """
    touched = max(gear.base_radius, gear.reference_radius + _side(gear) * gear.profile_shift * gear.normal_module)
    tangent = gear.roll_length(touched) / gear.base_radius
    shift = 2.0 * gear.profile_shift / gear.teeth * tan(gear.pressure_angle)
    turn = tangent / cos(gear.base_helix_angle) ** 2 - shift - involute(gear.transverse_pressure_angle)
    return max(1, round(gear.tooth_count / pi * turn + 0.5))


def span_measurement(gear: MeasuredGear, teeth: int) -> float:
    r"""Span W_k between parallel planes that touch the outer flanks of k teeth [mm].

    .. math:: W_k = m_n \cos\alpha_n \left(\pi (k - 1/2) + \lvert z\rvert\,\mathrm{inv}\,\alpha_t\right)
              + 2 s x_E m_n \sin\alpha_n

    Of a ring (s = -1) with straight teeth: between the flanks that face each other over k spaces, along their common
    normal. Helical flanks of a ring are hollow along that normal: they have none.

    Raises
    ------
    InputError
        If k is no number of teeth, the planes touch beside the flanks, the span is longer than the face of a helical
        gear lets it be, or the ring is helical.

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


def allowance_of_span(gear: MeasuredGear, span: float, teeth: int) -> float:
    """Allowance A_sn of a gear whose span over k teeth is measured [mm]; that of ``gear`` itself does not count.

    Raises
    ------
    InputError
        If k is no number of teeth, the allowance is above half a module, or the ring is helical.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gear = CylindricalGear(teeth=25, normal_module=2.0, face_width=20.0)
    >>> round(1e3 * allowance_of_span(gear, 15.4233, 3))  # um
    -40
    """
    nominal = _span(gear, teeth, gear.profile_shift)
    allowance = _side(gear) * (span - nominal) / cos(gear.pressure_angle)
    return _allowance(gear, allowance, f"span_measurement: {plain(span, 6)} mm over {teeth} teeth", nominal)


def _span(gear: MeasuredGear, teeth: int, shift: float) -> float:
    """W_k of any profile shift."""
    whole = teeth == int(teeth) if abs(teeth) < inf else False
    most = gear.tooth_count - 1
    require(
        (whole and 1 <= teeth <= most, f"span_teeth: {teeth} is not a whole number from 1 to {most}"),
        (
            gear.teeth > 0 or gear.helix_angle == 0.0,
            "span_measurement: no span touches the helical teeth of a ring, which are hollow; measure between balls",
        ),
        owner=gear.name,
    )
    pitches = pi * (teeth - 0.5) + gear.tooth_count * involute(gear.transverse_pressure_angle)
    thicker = 2.0 * _side(gear) * shift * sin(gear.pressure_angle)
    return gear.normal_module * (cos(gear.pressure_angle) * pitches + thicker)


def _measurement_over(gear: MeasuredGear, body: Body, diameter: float) -> float:
    r"""Measure M_dK over two balls, or M_dR over two pins, in opposite spaces [mm]; of a ring between them.

    .. math:: \mathrm{inv}\,\alpha_K = s \left(\psi_b + \frac{D_M}{\lvert z\rvert m_n \cos\alpha_n}
              - \frac{\pi}{\lvert z\rvert}\right),\qquad
              M_{dK} = d_K \cos\delta + s D_M,\qquad d_K = \frac{d_b}{\cos\alpha_K}

    with s = 1 of an external gear and -1 of a ring, delta = 0 for an even number of teeth, pi/(2 z) for an odd one, and
    :math:`\psi_b = s_t/d + s\,\mathrm{inv}\,\alpha_t` of the teeth with their allowance. A pin lies along the helix
    of its space and touches the flanks where a ball of its diameter does. Straight teeth, and an even number of helical
    ones, have the same measure over both. Of an odd number of helical teeth the pins stand opposite each other half an
    axial pitch apart along the face, M_dR = d_K + D_M, while balls lie in one transverse plane.

    Raises
    ------
    InputError
        If balls or pins touch beside the flanks, rest on the root, or do not stand out of the tips; of pins also if a
        ring is helical, where they touch at their ends, or the face is too narrow for pins that stand opposite.

    References
    ----------
    ISO 21771:2007; DIN 3960:1987; DIN 21773:2014.
    """
    opposite, side = _opposite(gear, body), _side(gear)
    centre = _centre(gear, body, diameter)
    tangent = sqrt((centre - gear.base_radius) * (centre + gear.base_radius))
    contact = tangent - 0.5 * side * diameter * cos(gear.base_helix_angle)
    what = f"{body}_diameter: a {body} of {plain(diameter, 6)} mm"
    require(_touches(gear, hypot(gear.base_radius, contact) if contact > 0.0 else 0.0, what), owner=gear.name)
    room = side * (centre - gear.root_radius), side * (centre - gear.tip_radius)
    require(
        (room[0] > 0.5 * diameter, f"{what} rests on the root and not on the flanks"),
        (room[1] > -0.5 * diameter, f"{what} does not stand out of the tips"),
        owner=gear.name,
    )
    return 2.0 * centre * opposite + side * diameter


def allowance_of_balls(gear: MeasuredGear, measurement: float, diameter: float) -> float:
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
    return _allowance_over(gear, "ball", measurement, diameter)


def allowance_of_pins(gear: MeasuredGear, measurement: float, diameter: float) -> float:
    """Allowance A_sn of a gear that is measured over two pins [mm]; that of ``gear`` itself does not count.

    Raises
    ------
    InputError
        As :func:`allowance_of_balls`; also if a ring is helical, or the face too narrow for pins that stand opposite.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gear = CylindricalGear(teeth=21, normal_module=2.0, face_width=20.0, helix_angle=0.3)
    >>> round(1e3 * allowance_of_pins(gear, 48.8234, 3.5))  # um
    -40
    """
    return _allowance_over(gear, "pin", measurement, diameter)


def _allowance_over(gear: MeasuredGear, body: Body, measurement: float, diameter: float) -> float:
    side, between, opposite = _side(gear), "over" if gear.teeth > 0 else "between", _opposite(gear, body)
    centre = 0.5 * (measurement - side * diameter) / opposite
    what = f"{body}_measurement: {plain(measurement, 6)} mm {between} {body}s of {plain(diameter, 6)} mm"
    require(
        (0.0 < diameter < inf, f"{body}_diameter: {diameter} mm is not positive and finite"),
        (
            gear.base_radius < centre < inf,
            f"{what} puts the {body}s inside the base circle, diameter {plain(2.0 * gear.base_radius, 6)} mm",
        ),
        owner=gear.name,
    )
    widening = _half_angle_of_ball(gear, diameter)
    half = side * involute(acos(gear.base_radius / centre)) - widening + pi / gear.tooth_count
    nominal = gear.half_thickness_angle_at_base - gear.thickness_allowance / (
        2.0 * gear.reference_radius * cos(gear.helix_angle)
    )
    allowance = 2.0 * gear.reference_radius * cos(gear.helix_angle) * (half - nominal)
    value = side * (nominal + widening - pi / gear.tooth_count)
    expected = 2.0 * gear.base_radius / cos(inverse_involute(max(0.0, value))) * opposite + side * diameter
    return _allowance(gear, allowance, what, expected)


def _centre(gear: MeasuredGear, body: Body, diameter: float) -> float:
    """Radius of the centres of balls or pins that touch both flanks of their space."""
    require((0.0 < diameter < inf, f"{body}_diameter: {diameter} mm is not positive and finite"), owner=gear.name)
    angle = gear.half_thickness_angle_at_base + _half_angle_of_ball(gear, diameter) - pi / gear.tooth_count
    value = _side(gear) * angle
    if value <= 0.0:
        fate = "falls between the flanks" if gear.teeth > 0 else "does not go between the flanks"
        raise InputError(f"{gear.name}: {body}_diameter: a {body} of {plain(diameter, 6)} mm {fate}")
    return gear.base_radius / cos(inverse_involute(value))


def _half_angle_of_ball(gear: MeasuredGear, diameter: float) -> float:
    """Angle by which a ball moves its contact from its centre, on the base circle: D_M/(z m_n cos(alpha_n))."""
    return diameter / (gear.tooth_count * gear.normal_module * cos(gear.pressure_angle))


def _opposite(gear: MeasuredGear, body: Body) -> float:
    """What remains of the radius across the axis; below 1 where no two spaces are opposite."""
    if body == "pin" and gear.helix_angle != 0.0:
        require(
            (
                gear.teeth > 0,
                "pin_measurement: pins between the helical teeth of a ring, which are hollow, touch at their ends; "
                "measure between balls",
            ),
            owner=gear.name,
        )
        if gear.teeth % 2 == 1:
            apart = 0.5 * pi * gear.normal_module / abs(sin(gear.helix_angle))
            require(
                (
                    apart < gear.face_width,
                    "pin_measurement: pins in the spaces of an odd number of helical teeth stand opposite half an "
                    f"axial pitch apart along the face, {plain(apart)} mm, and the face width is "
                    f"{plain(gear.face_width, 6)} mm; measure over balls",
                ),
                owner=gear.name,
            )
            return 1.0
    return 1.0 if gear.teeth % 2 == 0 else cos(0.5 * pi / gear.tooth_count)


def _touches(gear: MeasuredGear, radius: float, what: str) -> tuple[bool, str]:
    """Check of a contact point: on the flank, between form and tip circle."""
    low, high = sorted((gear.form_radius, gear.tip_form_radius))
    place = f"at diameter {plain(2.0 * radius, 6)} mm" if radius > 0.0 else "below the base circle"
    flank = f"the flanks reach from {plain(2.0 * low, 6)} to {plain(2.0 * high, 6)} mm"
    return low <= radius <= high, f"{what} touches no flank: it would be {place}, and {flank}"


def _allowance(gear: MeasuredGear, allowance: float, what: str, nominal: float) -> float:
    """Return an allowance that can be one."""
    largest, sense = LARGEST_ALLOWANCE * gear.normal_module, "thicker" if allowance > 0.0 else "thinner"
    require(
        (
            abs(allowance) <= largest,
            f"{what} makes the teeth {plain(abs(allowance))} mm {sense} than nominal, where it is {plain(nominal, 6)} "
            f"mm; allowed up to half a module, {plain(largest, 6)} mm",
        ),
        owner=gear.name,
    )
    return allowance
