r"""Basic machine settings of face-milled spiral bevel gears, in closed form from their blanks.

The cutter stands upright on the root plane of the blank, its radius and the spiral angle are right at the mean point,
and the gear rolls with its crown gear: nothing is optimised, and contact analysis says what to change. With the
projection :math:`X = R_m \cos\theta_f` of the mean cone distance on the root plane:

.. math::
   S_r = \sqrt{X^2 + r_{c0}^2 - 2 X r_{c0} \sin\beta_m}, \qquad
   \tan q = \frac{r_{c0}\cos\beta_m}{X - r_{c0}\sin\beta_m}, \qquad
   \gamma_m = \delta_f, \qquad m = \frac{\cos\theta_f}{\sin\delta}, \qquad X_B = t_{zR} \sin\delta_f .

The sliding base brings the root line into the plane of the blade tips where the root cone has an apex of its own, at
t_zR beyond that of the pitch cone, and leaves the latter on the axis of the cradle, where the gear can roll on its
pitch cone. (A machine centre to back of t_zR, found in some summaries, reaches the root line too, but moves the pitch
apex off that axis by t_zR cos(delta_f).)

- **Spread blade**: both flanks of a slot are cut at once, with blades of the mean pressure angle.
- **Duplex spread blade**: both gears of the pair so, and the blade angles make up for the tilt of the root planes
  against the pitch plane, which the flanks of a slot see with opposite signs: by the number of the blade group.

Lengths are in mm, angles in rad; signs are those of :mod:`loaded_tca.gears.face_milled`.
"""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, sin
from typing import Literal

from loaded_tca.errors import require
from loaded_tca.gears.bevel_blank import BevelBlank
from loaded_tca.gears.blank_gear import BlankGear
from loaded_tca.gears.face_milled import (
    MINUTES_PER_NUMBER,
    Blade,
    Cutter,
    FaceMilledBlank,
    FaceMilledGear,
    MachineSettings,
)

Hand = Literal["right", "left"]


Gears = tuple[FaceMilledGear, FaceMilledGear]
"""Of pinion and wheel."""


def spread_blade(blank: BevelBlank, pinion_hand: Hand = "left", edge_radius: float = 0.0) -> Gears:
    """Basic settings of the spread blade method: blades of the normal pressure angle.

    Parameters
    ----------
    blank : BevelBlank
        With a cutter radius.
    pinion_hand : {"left", "right"}
        The wheel has the other.
    edge_radius : float [mm]
        Of all blade tips.

    Returns
    -------
    (FaceMilledGear, FaceMilledGear)
        Of pinion and wheel. The blades of each stand apart by the width of its slot at mid-face (``point_width``).

    Raises
    ------
    InputError
        If the blank has no cutter radius, or the hand is not one of the two.

    References
    ----------
    Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21; the published settings of SpyGO's 19 x 62.

    Examples
    --------
    >>> from math import radians
    >>> blank = BevelBlank((20, 30), 5.0, 22.0, spiral_angle=radians(35), cutter_radius=50.0, taper="duplex")
    >>> pinion, wheel = spread_blade(blank)
    >>> round(wheel.machine.radial, 4), round(degrees(wheel.machine.cradle_angle), 4)
    (64.9847, 39.0697)
    """
    return _gears(blank, pinion_hand, edge_radius, 0.0)


def duplex_spread_blade(
    blank: BevelBlank, pinion_hand: Hand = "left", edge_radius: float = 0.0, number: float | None = None
) -> Gears:
    """Basic settings of the duplex spread blade method: blades of one group for both gears.

    Meant for a blank with a duplex taper, whose slots are as wide at the toe as at the heel.

    Parameters
    ----------
    blank, pinion_hand, edge_radius
        As for :func:`spread_blade`.
    number : float, optional
        Of the blade group; default: :func:`cutter_number` rounded to a half, as cutters are stocked.

    Returns
    -------
    (FaceMilledGear, FaceMilledGear)
        Of pinion and wheel.

    Raises
    ------
    InputError
        As :func:`spread_blade`.

    Examples
    --------
    >>> from math import radians
    >>> blank = BevelBlank((20, 30), 5.0, 22.0, spiral_angle=radians(35), cutter_radius=50.0, taper="duplex")
    >>> duplex_spread_blade(blank)[0].cutter.number
    2.5
    """
    number = round(2.0 * cutter_number(blank)) / 2.0 if number is None else number
    return _gears(blank, pinion_hand, edge_radius, number)


def cutter_number(blank: BevelBlank) -> float:
    r"""Number of the blade group at which both flanks of a pair miss conjugate pressure angles by the same.

    .. math:: N \cdot 10' = \tfrac{1}{2}(\theta_{f1} + \theta_{f2}) \sin\beta_m

    The root planes of the two gears are tilted against each other by the sum of the dedendum angles, about an axis
    across the pitch line; the tooth normals lean towards the pitch line with the sine of the spiral angle. Each of the
    two gears takes half.

    Parameters
    ----------
    blank : BevelBlank

    Returns
    -------
    float
        To be rounded to a stocked one, often a whole number or a half.

    References
    ----------
    Gleason, Gear Encyclopedia, "cutter number": the correction of the finishing blades is ten minutes times the
    number, added to the mean pressure angle on inside blades and subtracted on outside blades.

    Examples
    --------
    The pair of the duplex paper, whose cutter is of group 11:

    >>> from math import radians
    >>> angles = radians(33.690068 - 31.09059), radians(56.309932 - 52.51677)
    >>> blank = BevelBlank((20, 30), 5.0, 20.0, spiral_angle=radians(35), cutter_radius=80.0, wheel_angles=angles)
    >>> round(cutter_number(blank), 3)
    11.0
    """
    tilt = sum(blank.dedendum_angles) * sin(blank.spiral_angle)
    return 0.5 * degrees(tilt) * 60.0 / MINUTES_PER_NUMBER


def basic_machine_settings(gear: BlankGear, cutter_radius: float) -> MachineSettings:
    """Machine settings of one gear.

    Parameters
    ----------
    gear : BlankGear
    cutter_radius : float [mm]
        r_c0, nominal: the mean of the point radii of outside and inside blade.

    Returns
    -------
    MachineSettings

    References
    ----------
    Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21.
    """
    along = gear.cone_distances[1] * cos(gear.dedendum_angle)
    spiral = gear.spiral_angles[1]
    across, ahead = cutter_radius * cos(spiral), along - cutter_radius * sin(spiral)
    return MachineSettings(
        radial=hypot(across, ahead),
        cradle_angle=atan2(across, ahead),
        root_angle=gear.root_angle,
        ratio_of_roll=cos(gear.dedendum_angle) / sin(gear.pitch_angle),
        sliding_base=gear.root_apex * sin(gear.root_angle),
    )


def point_width(gear: BlankGear) -> float:
    """Distance of the blade tips that cut both flanks of a slot: its width at mid-face, at the bottom [mm].

    Where the slot tapers, a cutter that is to pass through without touching both flanks must be narrower than
    ``min(gear.slot_widths)``.
    """
    return float(gear.slot_widths[1])


def _gears(blank: BevelBlank, pinion_hand: Hand, edge_radius: float, number: float) -> Gears:
    radius = blank.cutter_radius
    require(
        (radius is not None, "cutter_radius: missing; a face-milled gear needs the radius of its cutter"),
        (pinion_hand in ("left", "right"), f"pinion_hand: {pinion_hand!r} is not 'left' or 'right'"),
    )
    assert radius is not None

    def cut(gear: BlankGear, hand: Hand) -> FaceMilledGear:
        toe, mean, heel = gear.cone_distances
        own = blank.has_own_faces
        outline = FaceMilledBlank(
            outer_cone_distance=heel if own else blank.outer_cone_distance,
            face_width=heel - toe if own else blank.face_width,
            pitch_angle=gear.pitch_angle,
            face_angle=gear.face_angle,
            root_angle=gear.root_angle,
            hand=hand,
            face_apex=gear.face_apex,
            root_apex=gear.root_apex,
            calculation_cone_distance=mean if own else None,
        )
        outside, inside = (
            Blade(radius + offset, gear.pressure_angle, edge_radius=edge_radius)
            for offset in (0.5 * point_width(gear), -0.5 * point_width(gear))
        )
        cutter = Cutter(concave=outside, convex=inside, number=number)
        return FaceMilledGear(gear.teeth, outline, cutter, basic_machine_settings(gear, radius), gear.name)

    return cut(blank.pinion, pinion_hand), cut(blank.wheel, "right" if pinion_hand == "left" else "left")
