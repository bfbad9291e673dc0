r"""Machine settings of face-milled hypoid and spiral bevel pairs by local synthesis, from their blanks.

The wheel is cut by the spread blade method, at rest (formate) or rolling with its crown gear: blade angles, point width
and the place of the cutter are such that both flanks have their pressure angles, the tooth its thickness and the flank
of the drive side its spiral angle at the calculation point P.

The pinion is generated, both flanks with the same machine settings. What a flank should be is the conjugate of the
wheel's (:mod:`loaded_tca.flanks.face_milled`) less a mismatch.

A mismatch removes :math:`c_p (2 y/h)^2 + c_l (2 l/b)^2 + c_t (2 y/h)(2 l/b)` from it, y up the profile and l lengthwise
from P, over working depth h and face width b.

Nine conditions hold at P: slopes and second derivatives of the drive flank, slopes of the coast flank, the thickness of
the tooth and the depth of the cut. What freedom the machine has beyond them (tilt, helical motion, machine root angle)
brings the second derivatives of the coast flank near to its mismatch and keeps the depth along the face, at the price
of larger settings: the sum of the squares of all is the smallest. Slots that do not fit the taper of the blank show in
the depth; a duplex taper is meant for such pinions.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, sections 6.4 (envelopes), 21.4 and 22.4 (local synthesis): the
idea; conditions and unknowns here are others.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from math import atan, atan2, cos, hypot, pi, sin

import numpy as np
import scipy

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError, require
from loaded_tca.flanks.base import Jet
from loaded_tca.flanks.cradle import CradleGeneration, GeneratedPoints
from loaded_tca.flanks.face_milled import GeneratedFlank, conjugate_flank
from loaded_tca.gears.face_milled import (
    BLADE_SIGNS,
    Blade,
    Cutter,
    FaceMilledBlank,
    FaceMilledGear,
    FlankName,
    Generation,
    MachineSettings,
)
from loaded_tca.gears.hypoid_blank import HypoidBlank
from loaded_tca.plain import plain

Gears = tuple[FaceMilledGear, FaceMilledGear]
"""Of pinion and wheel."""
FLANKS: tuple[FlankName, FlankName] = ("concave", "convex")
"""Of the pinion: drive and coast side."""

MET = 1e-10
"""Residual of the conditions [mm, and mm per half depth or half width] below which settings meet them."""
SETTLED = 1e-6
"""Steps below this, over what settings change easily by, end the search."""
MOST_STEPS = 100
LARGEST_STEP = 0.3


@dataclass(frozen=True)
class Mismatch:
    """Material removed from a flank of the pinion that is conjugate to the wheel, as a parabola about P.

    Attributes
    ----------
    profile : float [mm]
        At the ends of the working depth; positive: crowned.
    lengthwise : float [mm]
        At toe and heel.
    twist : float [mm]
        More at the tip of the heel and the root of the toe, less at the other corners.
    """

    profile: float = 0.010
    lengthwise: float = 0.030
    twist: float = 0.0


def synthesised_gears(
    blank: HypoidBlank,
    pinion_hand: str = "left",
    mismatch: Mismatch = Mismatch(),
    coast_mismatch: Mismatch = Mismatch(0.010, 0.060),
    *,
    wheel: Generation = "generated",
    edge_radii: tuple[float, float] = (0.0, 0.0),
) -> Gears:
    """Pinion and wheel of a face-milled pair, with settings by local synthesis.

    Parameters
    ----------
    blank : HypoidBlank
    pinion_hand : {"left", "right"}
        The wheel has the other.
    mismatch : Mismatch
        Of the drive side: concave flank of the pinion, convex flank of the wheel. It is met.
    coast_mismatch : Mismatch
        Of the other side, which is approached.
    wheel : {"generated", "formate"}
        How the wheel is cut.
    edge_radii : (float, float) [mm]
        Of the blade tips of pinion and wheel.

    Returns
    -------
    (FaceMilledGear, FaceMilledGear)
        Of pinion and wheel, for :func:`loaded_tca.pairs.face_milled_pair` with the offset and the shaft angle of the
        cones of the blank.

    Raises
    ------
    InputError
        If the hand is not one of the two, or the kind of generation.
    GeometryError
        If no settings meet the conditions.

    Examples
    --------
    The second pair of annex F of ISO 23509:

    >>> from math import degrees, radians
    >>> from loaded_tca.gears import HypoidBlank, pitch_cones_by_method_1
    >>> cones = pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, radians(50), 63.5)
    >>> blank = HypoidBlank((13, 42), cones, 30.0, 63.5, profile_shift=0.3)
    >>> pinion, wheel = synthesised_gears(blank)
    >>> flank = GeneratedFlank(pinion, "concave")
    >>> round(degrees(flank.angles.spiral), 1), round(degrees(flank.angles.pressure), 1)
    (-50.0, 17.7)
    """
    require(
        (pinion_hand in ("left", "right"), f"pinion_hand: {pinion_hand!r} is not 'left' or 'right'"),
        (wheel in ("generated", "formate"), f"wheel: {wheel!r} is not 'generated' or 'formate'"),
    )
    # settings are those of right-hand members: a right-hand pinion stands for both
    mating = _wheel(blank, wheel, edge_radii[1])
    pinion = _Pinion(blank, mating, (mismatch, coast_mismatch), edge_radii[0]).solved(STRENGTHS[wheel])
    require(
        *(
            (overlap is None, f"edge_radii: found {plain(radius, 6)} mm of the {gear.name}; {overlap}")
            for gear, radius in zip((pinion, mating), edge_radii, strict=True)
            for overlap in [gear.cutter.overlap_of_tips]
        )
    )
    if pinion_hand == "right":
        return pinion, mating
    return replace(pinion, blank=replace(pinion.blank, hand="left")), replace(
        mating, blank=replace(mating.blank, hand="right")
    )


def _outline(blank: HypoidBlank, member: int) -> FaceMilledBlank:
    """Outline of a gear, apexes counted from that of its pitch cone; pinion right-hand, wheel left-hand."""
    gear, beyond = (blank.pinion, blank.wheel)[member], blank.cones.apexes[member]
    toe, mean, heel = gear.cone_distances
    return FaceMilledBlank(
        outer_cone_distance=heel,
        face_width=heel - toe,
        pitch_angle=gear.pitch_angle,
        face_angle=gear.face_angle,
        root_angle=gear.root_angle,
        hand="right" if member == 0 else "left",
        face_apex=gear.face_apex - beyond,
        root_apex=gear.root_apex - beyond,
        calculation_cone_distance=mean,
    )


def _at(blank: FaceMilledBlank, *distances: float) -> tuple[Array, Array]:
    """(rho, z) of points of the pitch cone at cone distances."""
    along = np.array(distances)
    return along * sin(blank.pitch_angle), along * cos(blank.pitch_angle)


def _wheel(blank: HypoidBlank, generation: Generation, edge_radius: float) -> FaceMilledGear:
    """Left-hand wheel cut by spread blades that give its angles and thickness at P."""
    outline, gear, radius = _outline(blank, 1), blank.wheel, blank.cutter_radius
    along = outline.mean_cone_distance * cos(outline.pitch_angle - outline.root_angle)
    rho, z = _at(outline, outline.mean_cone_distance)
    rolls = cos(outline.pitch_angle - outline.root_angle) / sin(outline.pitch_angle)

    def cut(unknowns: Array) -> FaceMilledGear:
        outside, inside, width, spiral = (float(one) for one in unknowns)
        across, ahead = radius * cos(spiral), along - radius * sin(spiral)
        machine = MachineSettings(
            radial=hypot(across, ahead),
            cradle_angle=atan2(across, ahead),
            root_angle=outline.root_angle,
            ratio_of_roll=rolls if generation == "generated" else 0.0,
            sliding_base=outline.root_apex * sin(outline.root_angle),
            generation=generation,
        )
        blades = (
            Blade(radius + 0.5 * width, outside, edge_radius=edge_radius),
            Blade(radius - 0.5 * width, inside, edge_radius=edge_radius),
        )
        return FaceMilledGear(gear.teeth, outline, Cutter(*blades), machine, "wheel")

    drive, coast = blank.generated_pressure_angles
    spiral = gear.spiral_angles[1]

    def residuals(unknowns: Array) -> Array:
        points = _cuts(cut(unknowns), rho, z)
        (on_coast, _), (on_drive, drive_spiral) = (_angles(outline, one.theta) for one in points)
        tooth = 2.0 * pi / gear.teeth - float(points[1].theta.value[0] - points[0].theta.value[0])
        thickness = tooth * float(rho[0]) * cos(spiral)
        return np.array(
            [
                on_coast - coast,
                on_drive - drive,
                (thickness - gear.mean_normal_thickness) / radius,
                drive_spiral - spiral,
            ]
        )

    solution = scipy.optimize.root(residuals, [coast, drive, gear.mean_slot_width, spiral], tol=1e-13)
    if np.abs(residuals(solution.x)).max() > MET:
        raise GeometryError(
            f"wheel: no blades give its angles and thickness at the calculation point: {solution.message}"
        )
    return cut(solution.x)


def _cuts(gear: FaceMilledGear, rho: Array, z: Array) -> tuple[GeneratedPoints, GeneratedPoints]:
    """Points of the concave and the convex flank of the right-hand member."""
    concave, convex = (CradleGeneration(gear.cutter.blade(name), name, gear.machine).solve(rho, z) for name in FLANKS)
    return concave, convex


def _angles(blank: FaceMilledBlank, theta: Jet) -> tuple[float, float]:
    """Normal pressure angle and spiral angle of a right-hand member at its first point, on the pitch cone at P."""
    delta, rho = blank.pitch_angle, blank.mean_cone_distance * sin(blank.pitch_angle)
    along = rho * float(theta.rho[0] * sin(delta) + theta.z[0] * cos(delta))
    up = rho * abs(float(theta.rho[0] * cos(delta) - theta.z[0] * sin(delta)))
    return atan(up / hypot(1.0, along)), atan(along)


EASY = np.array([3.0, 0.2, 5.0, 5.0, 5.0, 0.02, 2.0, 0.05, 0.05, 2.0, 2.0, 0.1, 0.1])
"""By how much the unknowns of the pinion change as easily as each other [mm, rad]: radial, ratio of roll, blank offset,
machine centre to back, sliding base, root angle, helical motion, tilt about the radial line and along it, point radii
of outside and inside blade, their angles."""
ROOT, LEAST_ROOT = 5, 0.01
"""Place of the machine root angle among them, and the least that it becomes [rad]."""
DIFFERENCE = 1e-6
"""Step of differences, in parts of them."""
HARD = 9
"""Conditions that are met."""
WEIGHTS = np.array([5.0, 20.0, 20.0, 20.0])
"""1/mm: of the change of depth along half the face, and of what the coast flank misses its mismatch by."""
STRENGTHS: dict[Generation, tuple[float, ...]] = {"generated": (1.0, 0.25), "formate": (16.0, 4.0, 1.0)}
"""Factors of these weights, tried one after the other: the pinion of a formate wheel is cut by a tilted cutter that
stands for it, far from the start, and with the full weight its settings may leave the machine."""


class _Pinion:
    """Right-hand pinion for a left-hand wheel: unknowns, conditions, and what is to be small beside them."""

    def __init__(
        self, blank: HypoidBlank, wheel: FaceMilledGear, mismatches: tuple[Mismatch, Mismatch], edge_radius: float
    ) -> None:
        self.outline, self.gear, self.edge_radius = _outline(blank, 0), blank.pinion, edge_radius
        outline = self.outline
        self.place = _at(outline, outline.mean_cone_distance, *outline.cone_distances)
        rho, z = (float(part[0]) for part in self.place)
        self.thickness = blank.pinion.mean_normal_thickness / (rho * cos(blank.pinion.spiral_angles[1]))
        root, delta = outline.root_angle, outline.pitch_angle
        self.depths = self.place[0] * cos(root) - (self.place[1] + outline.root_apex) * sin(root)
        frame, ratio = blank.cones.frame(1), blank.teeth[0] / blank.teeth[1]
        up, along = np.array([cos(delta), -sin(delta)]), np.array([sin(delta), cos(delta)])
        self.ways = np.array([up * blank.working_depth, along * outline.face_width]) / 2.0
        self.targets = []
        for flank, mating, mismatch in zip(FLANKS, FLANKS[::-1], mismatches, strict=True):
            slopes, bends = conjugate_flank(GeneratedFlank(wheel, mating), frame, ratio, rho, z)
            length = BLADE_SIGNS[flank] * hypot(1.0 / rho, *slopes)
            self.targets.append((slopes, bends, length, mismatch))
        self.start, self.cradle_angle = self._start(blank)

    def _start(self, blank: HypoidBlank) -> tuple[Array, float]:
        """Settings with which the pinion rolls with the crown gear of the wheel, and the cradle angle."""
        outline, cones, radius = self.outline, blank.cones, blank.cutter_radius
        spiral, mean = self.gear.spiral_angles[1], cones.mean_cone_distances[1]
        along = outline.mean_cone_distance * cos(outline.pitch_angle - outline.root_angle)
        crossing = along - mean * cos(cones.offset_angle)
        offset = mean * sin(cones.offset_angle)
        across, ahead = radius * cos(spiral) + offset, along - radius * sin(spiral) - crossing
        back = -crossing / cos(outline.root_angle)
        base = (outline.root_apex - back) * sin(outline.root_angle)
        roll = blank.teeth[1] / blank.teeth[0] / sin(cones.pitch_angles[1])
        half = 0.5 * self.gear.mean_slot_width
        machine = [hypot(across, ahead), roll, offset, back, base, outline.root_angle, 0.0, 0.0, 0.0]
        blades = [radius + half, radius - half, *blank.generated_pressure_angles]
        return np.array(machine + blades), atan2(across, ahead)

    def cut(self, unknowns: Array) -> FaceMilledGear:
        """Pinion with these settings."""
        radial, roll, offset, back, base, root, helical, about, along, outer, inner, outside, inside = map(
            float, unknowns
        )
        machine = MachineSettings(
            radial=radial,
            cradle_angle=self.cradle_angle,
            root_angle=root,
            ratio_of_roll=roll,
            machine_centre_to_back=back,
            sliding_base=base,
            blank_offset=offset,
            tilt=hypot(about, along),
            swivel=atan2(along, about) if about or along else 0.0,
            helical_motion=helical,
        )
        cutter = Cutter(
            Blade(outer, outside, edge_radius=self.edge_radius), Blade(inner, inside, edge_radius=self.edge_radius)
        )
        return FaceMilledGear(self.gear.teeth, self.outline, cutter, machine, "pinion")

    def conditions(self, unknowns: Array) -> Array:
        """What must be zero (9,), then what should be: change of depth, departures of the coast flank (4,) [mm].

        Raises
        ------
        GeometryError
            If the settings are none of a machine, or a blade cuts nothing there.
        """
        try:
            points = _cuts(self.cut(unknowns), *self.place)
        except InputError as error:
            raise GeometryError(f"pinion: no settings of a machine meet the conditions: {error}") from None
        if not all(one.converged.all() for one in points):
            raise GeometryError("pinion: on the way to its settings a blade cuts nothing; change the blank or mismatch")
        drive, coast = (self._departures(*pair) for pair in zip(points, self.targets, strict=True))
        tooth = 2.0 * pi / self.gear.teeth - float(points[1].theta.value[0] - points[0].theta.value[0])
        depths = 0.5 * (points[0].height + points[1].height) - self.depths
        thickness = float(self.place[0][0]) * (tooth - self.thickness)
        change = 0.5 * (depths[2] - depths[1])
        return np.array([*drive, *coast[:2], thickness, depths[0], change, *coast[2:]])

    def _departures(self, points: GeneratedPoints, target: tuple[Array, Array, float, Mismatch]) -> Array:
        """How far a flank is from its target: slopes and bends over half depth and half width (5,) [mm]."""
        slopes, bends, length, mismatch = target
        theta = points.theta
        less_slopes = (slopes - np.array([theta.rho[0], theta.z[0]])) / length
        rho_rho, rho_z, z_z = (bends - np.array([part[0] for part in theta.bends])) / length
        curved = self.ways @ np.array([[rho_rho, rho_z], [rho_z, z_z]]) @ self.ways.T
        removed = np.array([0.5 * curved[0, 0], 0.5 * curved[1, 1], curved[0, 1]])
        wanted = np.array([mismatch.profile, mismatch.lengthwise, mismatch.twist])
        return np.concatenate([self.ways @ less_slopes, removed - wanted])

    def solved(self, strengths: tuple[float, ...]) -> FaceMilledGear:
        """Pinion whose settings meet the conditions, and are otherwise a compromise.

        Raises
        ------
        GeometryError
            If they meet them with none of the weights.
        """
        for strength in strengths[:-1]:
            with suppress(GeometryError):
                return self._centred(self._compromise(strength * WEIGHTS))
        return self._centred(self._compromise(strengths[-1] * WEIGHTS))

    def _compromise(self, weights: Array) -> Array:
        """Unknowns that meet the conditions and have the smallest sum of squares of the rest (13,)."""
        unknowns, moving = self.start, np.ones(EASY.size)
        for _ in range(MOST_STEPS):
            values, slopes = self.conditions(unknowns), self._slopes(unknowns) * moving
            step = -np.linalg.lstsq(slopes[:HARD], values[:HARD], rcond=None)[0]
            free = scipy.linalg.null_space(slopes[:HARD])
            soft = np.vstack([weights[:, None] * slopes[HARD:], np.eye(EASY.size)])
            left = np.concatenate([weights * values[HARD:], (unknowns - self.start) / EASY]) + soft @ step
            step = (step - free @ np.linalg.lstsq(soft @ free, left, rcond=None)[0]) * moving
            size = float(np.abs(step).max())
            unknowns = unknowns + EASY * step * min(1.0, LARGEST_STEP / size)
            if unknowns[ROOT] < LEAST_ROOT:
                unknowns[ROOT], moving[ROOT] = LEAST_ROOT, 0.0
            if size < SETTLED:
                break
        for _ in range(3):  # the last digits of the conditions alone
            met = self.conditions(unknowns)[:HARD]
            slopes = self._slopes(unknowns)[:HARD] * moving
            unknowns = unknowns - EASY * np.linalg.lstsq(slopes, met, rcond=None)[0]
        miss = float(np.abs(self.conditions(unknowns)[:HARD]).max())
        if miss > MET:
            raise GeometryError(
                f"pinion: no settings meet all conditions at the calculation point; the largest error is "
                f"{plain(miss, 3)} mm; change the mismatch, the taper or the radius of the cutter"
            )
        return unknowns

    def _slopes(self, unknowns: Array) -> Array:
        """Derivatives (13, 13) of the conditions by the unknowns, over ``EASY``."""
        steps = DIFFERENCE * np.diag(EASY)
        changes = [self.conditions(unknowns + step) - self.conditions(unknowns - step) for step in steps]
        return np.array(changes).T / (2.0 * DIFFERENCE)

    def _centred(self, unknowns: Array) -> FaceMilledGear:
        """The same pinion with the centre of roll where its flanks are cut at P."""
        gear = self.cut(unknowns)
        turn = 0.5 * sum(float(points.cradle[0]) for points in _cuts(gear, *self.place))
        machine = gear.machine
        moved = replace(
            machine,
            cradle_angle=machine.cradle_angle + turn,
            sliding_base=machine.sliding_base + machine.helical_motion * turn,
        )
        return replace(gear, machine=moved)
