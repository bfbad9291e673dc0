r"""A face-milled bevel gear: its blank, the cutter and the machine settings that give it its flanks.

Settings are as a summary of settings lists them. Lengths are in mm, angles in rad. All signs are those of a
**right-hand** member; a left-hand member is the mirror image of the right-hand one with the same numbers. The frame of
the machine: z along the axis of the cradle, out of the cradle towards the blank; x to the right, along the root line of
the blank at the centre of roll; y upwards; origin (machine centre) where the axis of the cradle meets the plane of the
blade tips. ``docs/how_it_works/face_milling.md`` has the picture.

Face-milling cutter: the blade that cuts a flank, as a profile turned about the axis of the cutter.

With h the height above the blade tip, the cutting edge lies at the radius r(h): it grows with h on the outside blade,
which cuts the concave flank, and falls on the inside blade, which cuts the convex one.

.. math:: r(h) = r_p \pm h \tan\alpha \quad\text{(straight)}, \qquad
          r(h) = r_p \pm \left(\varrho\cos\alpha - \sqrt{\varrho^2 - (h + \varrho\sin\alpha)^2}\right)
          \quad\text{(hollow, radius } \varrho)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, inf, isfinite, pi, radians, sin, tan
from typing import Any, Literal, get_args

import numpy as np

from loaded_tca.errors import InputError, require
from loaded_tca.gears.blank_gear import height_over_pitch_cone
from loaded_tca.gears.checks import face_check, half_turn_checks, teeth_checks
from loaded_tca.plain import plain

FlankName = Literal["concave", "convex"]

MINUTES_PER_NUMBER = 10.0
"""Minutes of arc by which one unit of the cutter number corrects the blade angles."""
BLADE_SIGNS: dict[FlankName, int] = {"concave": 1, "convex": -1}
"""Whether the radius of a cutting edge grows (outside blade) or falls with the height above its tip."""
_LARGEST_BLADE_ANGLE = radians(60)
_LARGEST_SINE = 0.95


@dataclass(frozen=True)
class Blade:
    """Cutting edge of one blade.

    Parameters
    ----------
    point_radius : float [mm]
        r_p, of the (sharp) blade tip from the axis of the cutter.
    blade_angle : float [rad]
        alpha, against the axis of the cutter, at the tip; positive where the blade is narrower at its tip.
    blade_radius : float [mm], optional
        Of a hollow blade: a circular arc with its centre on the side of the workpiece, which crowns the flank along
        its profile. None: straight.
    edge_radius : float [mm]
        Of the rounding at the tip, which cuts the fillet and no part of the flank.

    Raises
    ------
    InputError
        If values are out of range; every one is told.

    References
    ----------
    Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21.
    """

    point_radius: float
    blade_angle: float
    blade_radius: float | None = None
    edge_radius: float = 0.0

    def __post_init__(self) -> None:
        upright = abs(self.blade_angle) < _LARGEST_BLADE_ANGLE
        straight_or_round = self.blade_radius is None or 0.0 < self.blade_radius < inf
        require(
            (0.0 < self.point_radius < inf, f"point_radius: {self.point_radius} mm is not positive and finite"),
            (upright, f"blade_angle: {plain(self.blade_angle, 6)} rad is not within 1.047 rad (60 deg)"),
            (straight_or_round, f"blade_radius: {self.blade_radius} mm is not positive and finite"),
            (0.0 <= self.edge_radius < inf, f"edge_radius: {self.edge_radius} mm is negative or not finite"),
        )

    @property
    def form_height(self) -> float:
        r"""Height above the tip where the rounding ends and the flank begins [mm].

        .. math:: h = r_e (1 - \sin\alpha) \frac{\varrho}{\varrho + r_e}
        """
        height = self.edge_radius * (1.0 - sin(self.blade_angle))
        if self.blade_radius is None:
            return height
        return height * self.blade_radius / (self.blade_radius + self.edge_radius)

    def widening(self, height: Any) -> tuple[Any, Any, Any]:
        """By how much the cutting edge recedes from its tip at a height [mm], with its first and second derivatives.

        Beyond the end of a circular arc the edge goes on as a tangent there.
        """
        if self.blade_radius is None:
            slope = tan(self.blade_angle)
            return slope * height, slope + 0.0 * height, 0.0 * height
        radius = self.blade_radius
        sine = height / radius + sin(self.blade_angle)
        inner = np.clip(sine, -_LARGEST_SINE, _LARGEST_SINE)
        cosine = np.sqrt(1.0 - inner**2)
        slope, beyond = inner / cosine, sine - inner
        bend = np.where(beyond == 0.0, 1.0 / (radius * cosine**3), 0.0)
        return radius * (cos(self.blade_angle) - cosine + slope * beyond), slope, bend


@dataclass(frozen=True)
class Cutter:
    """Blades of a cutter, one for each flank, and the number of the blade group.

    Parameters
    ----------
    concave, convex : Blade, optional
        Outside blade, which cuts the concave flank, and inside blade, which cuts the convex one. The two need not be
        on one cutter head. None: that flank is not asked for.
    number : float
        Of the blade group: corrects both blade angles by 10 minutes each, so that the flanks of a tapered tooth get
        the same pressure angle. The outside blade becomes steeper, the inside blade less steep.

    Raises
    ------
    InputError
        If there is no blade, or the number is not finite or turns a blade beyond its range.

    Examples
    --------
    >>> from math import degrees, radians
    >>> cutter = Cutter(Blade(45.0, radians(20)), Blade(44.0, radians(20)), number=11)
    >>> [round(60.0 * degrees(cutter.blade(flank).blade_angle)) for flank in ("concave", "convex")]  # minutes
    [1090, 1310]
    """

    concave: Blade | None = None
    convex: Blade | None = None
    number: float = 0.0

    def __post_init__(self) -> None:
        some = self.concave is not None or self.convex is not None
        require(
            (isfinite(self.number), f"number: {self.number} is not finite"),
            (some, "concave, convex: a blade is needed for at least one flank"),
        )
        for name in get_args(FlankName):
            if getattr(self, name) is not None:
                self.blade(name)

    def blade(self, flank: FlankName) -> Blade:
        """Blade that cuts a flank, its angle corrected by the number of the blade group.

        Raises
        ------
        InputError
            If the cutter has no blade for this flank.
        """
        blade: Blade | None = getattr(self, flank)
        if blade is None:
            raise InputError(f"cutter.{flank}: missing; it cuts the flank that is asked for")
        turn = radians(self.number * MINUTES_PER_NUMBER / 60.0)
        return replace(blade, blade_angle=blade.blade_angle + BLADE_SIGNS[flank] * -turn)

    @property
    def overlap_of_tips(self) -> str | None:
        """What is wrong with blades that are rounded over more than the slot between their point radii; None: nothing.

        A rounding of radius r touches the bottom of the slot r tan(45 deg - alpha/2) beside the sharp tip. Blades whose
        point radii leave no slot are those of a gear of which one flank alone is meant.
        """
        if self.concave is None or self.convex is None:
            return None
        width = self.concave.point_radius - self.convex.point_radius
        blades = [self.blade(flank) for flank in get_args(FlankName)]
        rounded = sum(blade.edge_radius * tan(0.25 * pi - 0.5 * blade.blade_angle) for blade in blades)
        if rounded <= width or width <= 0.0 or rounded == 0.0:
            return None
        return (
            f"the rounded tips of both blades take {plain(rounded)} mm of a slot of {plain(width)} mm between their "
            "point radii; allowed up to this width"
        )


Generation = Literal["generated", "formate"]


@dataclass(frozen=True)
class MachineSettings:
    r"""Where cutter and blank stand on the machine, and how they roll.

    While the cradle turns by :math:`\varphi` from the centre of roll, the blank turns in the same sense by

    .. math:: \psi = m \left(\varphi - \frac{2C}{2!}\varphi^2 - \frac{6D}{3!}\varphi^3\right)

    and slides by :math:`X_B + H \varphi`. A formate gear stands still, and its flanks are those of the cutter.

    Parameters
    ----------
    radial : float [mm]
        S_r, radial setting: from the axis of the cradle to the centre of the cutter.
    cradle_angle : float [rad]
        q, of the centre of the cutter at the centre of roll, from x towards y.
    root_angle : float [rad]
        gamma_m, machine root angle: of the blank's axis against the plane of the machine, between 0 and pi.
    ratio_of_roll : float
        m, turn of the blank over turn of the cradle; not used by a formate gear.
    machine_centre_to_back : float [mm]
        Delta X_D; positive withdraws the blank along its axis, towards its heel.
    sliding_base : float [mm]
        Delta X_B; positive moves the blank away from the blade tips, along z.
    blank_offset : float [mm]
        Delta E_m; positive moves the blank upwards, along y.
    tilt, swivel : float [rad]
        i and j, of the axis of the cutter about its centre: with e_r along the radial line and e_t = z x e_r, the axis
        has the direction :math:`\sin i\,(\cos j\, e_t - \sin j\, e_r) + \cos i\, z`.
    modified_roll_2c, modified_roll_6d : float
        2C and 6D, per rad and per square rad.
    helical_motion : float [mm/rad]
        H, growth of the sliding base with the turn of the cradle.
    generation : {"generated", "formate"}

    Raises
    ------
    InputError
        If values are out of range; every one is told.

    References
    ----------
    Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21.
    """

    radial: float
    cradle_angle: float
    root_angle: float
    ratio_of_roll: float = 0.0
    machine_centre_to_back: float = 0.0
    sliding_base: float = 0.0
    blank_offset: float = 0.0
    tilt: float = 0.0
    swivel: float = 0.0
    modified_roll_2c: float = 0.0
    modified_roll_6d: float = 0.0
    helical_motion: float = 0.0
    generation: Generation = "generated"

    def __post_init__(self) -> None:
        known = self.generation in get_args(Generation)
        rolls = not self.rolls or self.ratio_of_roll > 0.0
        require(
            *_finite_checks(self),
            (known, f"generation: {self.generation!r} is not 'generated' or 'formate'"),
            (self.radial > 0.0, f"radial: {self.radial} mm is not positive"),
            *half_turn_checks(root_angle=self.root_angle),
            (abs(self.tilt) < 0.5 * pi, f"tilt: {plain(self.tilt, 6)} rad is not within 1.571 rad (90 deg)"),
            (rolls, f"ratio_of_roll: {self.ratio_of_roll} is not positive, and the gear is generated"),
        )

    @property
    def rolls(self) -> bool:
        """Whether the blank is generated by rolling."""
        return self.generation == "generated"


@dataclass(frozen=True)
class FaceMilledBlank:
    """Outline of a blank: where its teeth end.

    Parameters
    ----------
    outer_cone_distance, face_width : float [mm]
        R_e and b, along the pitch cone.
    pitch_angle, face_angle, root_angle : float [rad]
        delta, delta_a and delta_f.
    hand : {"right", "left"}
    face_apex, root_apex : float [mm]
        How far the apexes of the face and root cones lie beyond that of the pitch cone, away from the teeth.
    calculation_cone_distance : float [mm], optional
        R_m of the calculation point, where both pitch cones touch; default: in the middle of the face.

    Raises
    ------
    InputError
        If values are out of range or the cones are not in order; every one is told.
    """

    outer_cone_distance: float
    face_width: float
    pitch_angle: float
    face_angle: float
    root_angle: float
    hand: Literal["right", "left"] = "right"
    face_apex: float = 0.0
    root_apex: float = 0.0
    calculation_cone_distance: float | None = None

    def __post_init__(self) -> None:
        width, outer = self.face_width, self.outer_cone_distance
        root, pitch, face = self.root_angle, self.pitch_angle, self.face_angle
        cones = f"0 < root {plain(root, 6)} <= pitch {plain(pitch, 6)} <= face {plain(face, 6)} < 3.142 rad (180 deg)"
        require(
            *_finite_checks(self),
            (self.hand in ("right", "left"), f"hand: {self.hand!r} is not 'right' or 'left'"),
            (0.0 < width < outer < inf, f"face_width: 0 < {width} < outer_cone_distance {outer} mm does not hold"),
            face_check(width, outer, "outer_cone_distance"),
            (0.0 < root <= pitch <= face < pi, f"root_angle: {cones} does not hold"),
        )
        mean, (inner, outer) = self.mean_cone_distance, self.cone_distances
        on_face = (
            f"calculation_cone_distance: {mean} mm is not on the face, between {plain(inner, 6)} and "
            f"{plain(outer, 6)} mm"
        )
        require((inner < mean < outer, on_face))

    @property
    def mean_cone_distance(self) -> float:
        """R_m of the calculation point; R_e - b/2 where no other is given [mm]."""
        given = self.calculation_cone_distance
        return self.middle_cone_distance if given is None else given

    @property
    def middle_cone_distance(self) -> float:
        """Cone distance of the middle of the face, R_e - b/2 [mm]."""
        return self.outer_cone_distance - 0.5 * self.face_width

    @property
    def cone_distances(self) -> tuple[float, float]:
        """Toe and heel [mm]."""
        return self.outer_cone_distance - self.face_width, self.outer_cone_distance

    def tip_height(self, distance: float) -> float:
        """Height of the face cone above the pitch cone, across it at a cone distance [mm]."""
        return height_over_pitch_cone(self.pitch_angle, (self.face_angle, self.face_apex), distance)

    def root_height(self, distance: float) -> float:
        """Height of the root cone above the pitch cone, negative for a dedendum [mm]."""
        return height_over_pitch_cone(self.pitch_angle, (self.root_angle, self.root_apex), distance)


def _finite_checks(values: MachineSettings | FaceMilledBlank) -> Iterator[tuple[bool, str]]:
    """Checks for ``require``: every number of a dataclass is finite."""
    for name, value in vars(values).items():
        yield not isinstance(value, float) or isfinite(value), f"{name}: {value} is not finite"


@dataclass(frozen=True)
class FaceMilledGear:
    """One gear of a face-milled pair: blank, cutter and machine settings.

    Parameters
    ----------
    teeth : int
        Number of teeth z, at least 3.
    blank : FaceMilledBlank
    cutter : Cutter
    machine : MachineSettings
    name : str
        What messages call this gear.
    bore_diameter : float [mm], optional
        For the compliance of the body.

    Raises
    ------
    InputError
        If the number of teeth is none, or the bore reaches the root at the toe.
    """

    teeth: int
    blank: FaceMilledBlank
    cutter: Cutter
    machine: MachineSettings
    name: str = "gear"
    bore_diameter: float | None = None

    def __post_init__(self) -> None:
        bore, largest = self.bore_diameter, 2.0 * self.blank.cone_distances[0] * sin(self.blank.root_angle)
        fits = bore is None or 0.0 <= bore < largest
        problem = (
            f"bore_diameter: {plain(bore or 0.0, 6)} mm is not below the root diameter at the toe, "
            f"{plain(largest, 6)} mm"
        )
        require(*teeth_checks(self.teeth), (fits, problem), owner=self.name)

    @property
    def mirror(self) -> int:
        """+1 for a right-hand gear, -1 for a left-hand one, which is the mirror image of a right-hand one."""
        return 1 if self.blank.hand == "right" else -1

    def side(self, flank: FlankName) -> int:
        """Sign s of the azimuthal part of the outward normal: +1 for the concave flank of a right-hand gear."""
        return self.mirror * BLADE_SIGNS[flank]

    def flank_name(self, side: int) -> FlankName:
        """The flank with a sign s."""
        return "concave" if self.side("concave") == side else "convex"


@dataclass(frozen=True)
class FaceMilledMesh:
    """Both members of a face-milled pair.

    Parameters
    ----------
    pinion, wheel : FaceMilledGear
    shaft_angle : float [rad]
        Sigma.
    """

    pinion: FaceMilledGear
    wheel: FaceMilledGear
    shaft_angle: float

    @property
    def offset(self) -> float:
        """Hypoid offset a [mm]: none where the axes meet."""
        return 0.0

    @property
    def gears(self) -> tuple[FaceMilledGear, FaceMilledGear]:
        """Pinion and wheel."""
        return self.pinion, self.wheel

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Smallest clearance between the roots of pinion and wheel and the mating gear's tip, toe or heel [mm]."""
        both_ways = (self.pinion.blank, self.wheel.blank), (self.wheel.blank, self.pinion.blank)
        pinion, wheel = (
            min(-own.root_height(distance) - mating.tip_height(distance) for distance in own.cone_distances)
            for own, mating in both_ways
        )
        return pinion, wheel
