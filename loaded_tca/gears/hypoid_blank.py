r"""Blanks of hypoid pairs: depths, cones with their apexes, widths, spiral angles, thicknesses (ISO 23509, clause 7).

What the standard computes from the pitch cones, whatever the method that they come from. Face and root cones of the
pinion run parallel to those of the wheel in the planes that touch them, at the clearance c; with an offset a the pinion
needs more face, and its spiral angles follow from those of the wheel at the same places. Lengths are in mm, angles in
rad; arrays of three are values at toe, calculation point and heel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import asin, atan, cos, degrees, inf, isclose, pi, sin, sqrt, tan
from typing import Literal, get_args

from loaded_tca.arrays import GEARS, real
from loaded_tca.errors import GeometryError, require
from loaded_tca.gears.bevel_blank import BacklashKind
from loaded_tca.gears.blank_gear import (
    LARGEST_DEPTH_ANGLE,
    BlankGear,
    BlankPair,
    Triple,
    cutter_sine,
    depth_angles_check,
    taper_check,
)
from loaded_tca.gears.checks import teeth_checks
from loaded_tca.gears.hypoid import Both, HypoidCones
from loaded_tca.gears.pitch_cones import PitchConeParameters, limit_pressure_angle
from loaded_tca.plain import plain

Taper = Literal["duplex", "standard", "uniform"]

_ROUNDING = 1e-12
SAME = 1e-9
"""Relative, of lengths that are the same but for rounding."""
ROLLING = 0.01
"""Relative, by how much the mean normal modules of both gears may differ: iterations of ISO 23509 end at 1 %, and those
of the pair in AGMA 929, annex D, differ by 0.4 %."""


@dataclass(frozen=True)
class HypoidBlank(BlankPair):
    r"""Blanks of a face-milled hypoid pair.

    Parameters
    ----------
    teeth : (int, int)
        z1, z2.
    pitch_cones : PitchConeParameters
        Of :func:`loaded_tca.gears.pitch_cones_by_method_1`, or of a drawing.
    face_width : float [mm]
        b_2 of the wheel; that of the pinion follows.
    cutter_radius : float [mm]
        r_c0.
    pressure_angles : (float, float) [rad]
        alpha_dD, alpha_dC: nominal design pressure angles of drive and coast side.
    limit_factor : float
        f_alim: how much of the limit pressure angle the flanks take up; 1: both sides mesh alike.
    profile_shift : float
        x_hm of the pinion, in mean normal modules.
    thickness_modification : float
        x_smn of the pinion.
    addendum_factor, dedendum_factor : float
        k_hap, k_hfp.
    taper : {"duplex", "standard", "uniform"}
        How the wheel's depth falls from heel to toe; "duplex": slots of constant width for this cutter.
    wheel_angles : (float, float) [rad], optional
        theta_a2, theta_f2 instead of those of the taper.
    backlash : float [mm]
        Taken from both teeth in equal parts.
    backlash_kind : {"outer_normal", "outer_transverse", "mean_normal", "mean_transverse"}

    Raises
    ------
    InputError
        If values are out of range, gears of these numbers of teeth do not roll on the pitch cones, or the cones were
        found with another face width or cutter; every one is told.
    GeometryError
        If the cutter does not reach over the face, or a tooth or a slot is pointed.

    References
    ----------
    ISO 23509:2016, formulas 110 to 226.

    Examples
    --------
    The second pair of annex F:

    >>> from math import radians
    >>> from loaded_tca.gears import pitch_cones_by_method_1
    >>> cones = pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, radians(50), 63.5)
    >>> blank = HypoidBlank(
    ...     (13, 42), cones, 30.0, 63.5, profile_shift=0.3, wheel_angles=(radians(1), radians(4))
    ... )
    >>> round(blank.mean_normal_module, 3), round(blank.pinion_face_width, 2), round(blank.pinion.root_apex, 2)
    (2.64, 31.91, -4.81)
    """

    teeth: tuple[int, int]
    pitch_cones: PitchConeParameters
    face_width: float
    cutter_radius: float
    pressure_angles: Both = (pi / 9.0, pi / 9.0)
    limit_factor: float = 1.0
    profile_shift: float = 0.0
    thickness_modification: float = 0.0
    addendum_factor: float = 1.0
    dedendum_factor: float = 1.25
    taper: Taper = "duplex"
    wheel_angles: Both | None = None
    backlash: float = 0.0
    backlash_kind: BacklashKind = "outer_transverse"

    def __post_init__(self) -> None:
        widths = {"face_width": self.face_width, "cutter_radius": self.cutter_radius}
        require(
            *teeth_checks(*self.teeth),
            *(
                (0.0 < real(width) < inf, f"{name}: {width} is not positive and finite")
                for name, width in widths.items()
            ),
            (
                all(0.0 < real(angle) < LARGEST_DEPTH_ANGLE for angle in self.pressure_angles),
                f"pressure_angles: {self.pressure_angles} rad are not between 0 and 0.785 rad (45 deg)",
            ),
            (
                0.0 < real(self.addendum_factor) <= real(self.dedendum_factor) < inf,
                f"dedendum_factor: 0 < addendum_factor {self.addendum_factor} <= {self.dedendum_factor} does not hold",
            ),
            taper_check(self.taper, get_args(Taper)),
            depth_angles_check(self.wheel_angles),
            (0.0 <= real(self.backlash) < inf, f"backlash: {self.backlash} mm is negative or not finite"),
        )
        self._require_own_cones()
        if self.wheel_cone_distances[0] <= abs(self.cones.offset_in_pitch_plane):
            raise GeometryError(
                f"face_width: {plain(self.face_width, 6)} mm reaches below the offset in the pitch plane, "
                f"{plain(self.cones.offset_in_pitch_plane, 6)} mm; no pinion meets the toe of the wheel"
            )
        for gear in (self.pinion, self.wheel):
            gear.check(allow_undercut=True)  # of generated flanks it shows when they are made

    def _require_own_cones(self) -> None:
        """Refuse pitch cones of another pair."""
        found = {name: getattr(self.pitch_cones, name) for name in ("face_width", "cutter_radius")}
        modules = self._mean_normal_modules
        require(
            *(
                (
                    value is None or isclose(getattr(self, name), value, rel_tol=SAME),
                    f"{name}: found {plain(getattr(self, name), 6)} mm; allowed {plain(value or 0.0, 6)} mm, with "
                    "which the pitch cones were found: with another one the outer diameter of the wheel or the "
                    "curvature of its flanks is not the one asked for; find the cones anew",
                )
                for name, value in found.items()
            ),
            (
                abs(modules[0] - modules[1]) <= ROLLING * modules[1],
                f"teeth: found {self.teeth[0]} and {self.teeth[1]}, which do not roll on these pitch cones: mean "
                f"normal modules of pinion and wheel are {plain(modules[0], 6)} and {plain(modules[1], 6)} mm",
            ),
        )

    @property
    def cones(self) -> HypoidCones:
        """The pitch cones."""
        return self.pitch_cones.cones

    @property
    def mean_normal_module(self) -> float:
        """m_mn, of the wheel [mm]."""
        return self._mean_normal_modules[1]

    @property
    def _mean_normal_modules(self) -> tuple[float, float]:
        """Those of both gears [mm]."""
        return self.cones.mean_normal_modules(self.teeth, self.pitch_cones.spiral_angles)

    @cached_property
    def limit_pressure_angle(self) -> float:
        """alpha_lim [rad]."""
        return limit_pressure_angle(self.cones, self.pitch_cones.spiral_angles)

    @property
    def generated_pressure_angles(self) -> Both:
        """alpha_nD, alpha_nC: normal pressure angles of the flanks at P, drive and coast side [rad]."""
        drive, coast = self.pressure_angles
        taken = self.limit_factor * self.limit_pressure_angle
        return drive + taken, coast - taken

    @property
    def depth_angles(self) -> Both:
        """theta_a2, theta_f2 [rad]."""
        if self.wheel_angles is not None:
            return self.wheel_angles
        if self.taper == "uniform":
            return 0.0, 0.0
        mean, outer = self.wheel_cone_distances[1:]
        if self.taper == "standard":
            return atan(self.mean_dedenda[0] / mean), atan(self.mean_dedenda[1] / mean)
        spiral, pressure = self.pitch_cones.spiral_angles[1], 0.5 * sum(self.generated_pressure_angles)
        module = 2.0 * outer * sin(self.cones.pitch_angles[1]) / self.teeth[1]
        total = 0.5 * pi * module / (outer * tan(pressure) * cos(spiral))
        total *= 1.0 - mean * sin(spiral) / self.cutter_radius
        share = self.mean_addenda[1] / self.working_depth
        return total * share, total * (1.0 - share)

    @property
    def wheel_cone_distances(self) -> Triple:
        """R_i2, R_m2, R_e2 [mm]."""
        mean = self.cones.mean_cone_distances[1]
        outer = mean + self.pitch_cones.face_width_factor * self.face_width
        return outer - self.face_width, mean, outer

    @cached_property
    def _planes(self) -> tuple[Both, Both]:
        """(zeta_R, zeta_o), (delta_a1, delta_f1): offset angles in root and face plane, cones of the pinion [rad]."""
        cones = self.cones
        offset, turn, mean = cones.offset, cones.shaft_angle - 0.5 * pi, cones.mean_cone_distances[1]
        angles, pinion = [], []
        for lean in (-self.depth_angles[1], self.depth_angles[0]):
            cone = cones.pitch_angles[1] + lean
            length = mean * cos(lean) - cones.apexes[1] * cos(cone)
            helper = atan(offset * tan(turn) * cos(cone) / length)
            angles.append(asin(offset * cos(helper) * sin(cone) / length) - helper)
            pinion.append(asin(sin(turn) * sin(cone) + cos(turn) * cos(cone) * cos(angles[-1])))
        return (angles[0], angles[1]), (pinion[0], pinion[1])

    @property
    def _apexes(self) -> tuple[Both, Both]:
        """(t_zF, t_zR) of pinion and wheel beyond the crossing points [mm]."""
        cones, (theta_a, theta_f) = self.cones, self.depth_angles
        mean, beyond, pitch = cones.mean_cone_distances[1], cones.apexes[1], cones.pitch_angles[1]
        (in_root, in_face), (face, root) = self._planes
        face2 = beyond - (mean * sin(theta_a) - self.mean_addenda[1] * cos(theta_a)) / sin(pitch + theta_a)
        root2 = beyond + (mean * sin(theta_f) - self.mean_dedenda[1] * cos(theta_f)) / sin(pitch - theta_f)
        face1 = cones.offset * sin(in_root) * cos(pitch - theta_f) - root2 * sin(pitch - theta_f) - self.clearance
        root1 = cones.offset * sin(in_face) * cos(pitch + theta_a) - face2 * sin(pitch + theta_a) - self.clearance
        return (face1 / sin(face), root1 / sin(root)), (face2, root2)

    @cached_property
    def pinion_cone_distances(self) -> Triple:
        """R_i1, R_m1, R_e1: the pinion's face covers that of the wheel [mm]."""
        cones, u, factor = self.cones, self.teeth[1] / self.teeth[0], self.pitch_cones.face_width_factor
        (first, second), zeta = cones.pitch_angles, cones.offset_angle
        face = self._planes[1][0]
        theta = face - first
        helper = atan(sin(zeta) * cos(second) / (u * cos(first) + cos(second) * cos(zeta)))
        width = self.face_width * cos(helper) / cos(zeta - helper)
        more = self.working_depth * sin(self._planes[0][0]) * (1.0 - 1.0 / u)
        deeper = (self.mean_dedenda[1] - self.clearance) * sin(first)
        raised = self.mean_addenda[0] * sin(first)
        outwards = factor * width / cos(theta) * cos(face) + more - deeper
        inwards = (1.0 - factor) * width / cos(theta) * cos(face) + more + deeper
        heel = (outwards + raised) / cos(face) * cos(theta)
        toe = (inwards - raised) / (cos(first) - tan(theta) * sin(first))
        mean = cones.mean_cone_distances[0]
        return mean - toe, mean, mean + heel

    @property
    def pinion_face_width(self) -> float:
        """b_1 [mm]."""
        return self.pinion_cone_distances[2] - self.pinion_cone_distances[0]

    def wheel_spiral_angle_at(self, cone_distance: float) -> float:
        """Spiral angle of the circle of the cutter at a cone distance of the wheel [rad].

        Raises
        ------
        GeometryError
            If the circle does not cross it.
        """
        mean, spiral = self.cones.mean_cone_distances[1], self.pitch_cones.spiral_angles[1]
        sine = cutter_sine(cone_distance, mean, spiral, self.cutter_radius)
        if not abs(sine) < 1.0:
            raise GeometryError(
                f"cutter_radius {self.cutter_radius} mm: its circle does not cross the cone distance"
                f" {cone_distance:.4f} mm; use a larger cutter or a smaller face width"
            )
        return asin(sine)

    def pinion_spiral_angle_at(self, cone_distance: float) -> float:
        """Spiral angle of the pinion at one of its cone distances: that of the wheel there, and the offset angle [rad].

        Raises
        ------
        GeometryError
            If the circle of the cutter does not cross the place.
        """
        on_wheel = self.on_wheel(cone_distance)
        return self.wheel_spiral_angle_at(on_wheel) + asin(self.cones.offset_in_pitch_plane / on_wheel)

    def on_wheel(self, cone_distance: float) -> float:
        """Cone distance of the wheel where a generatrix of the pinion, in the pitch plane, has one of its own [mm]."""
        own, mean = self.cones.mean_cone_distances
        step = cone_distance - own
        return sqrt(mean**2 + step**2 + 2.0 * mean * step * cos(self.cones.offset_angle))

    @property
    def spiral_angles(self) -> tuple[Triple, Triple]:
        """Spiral angles of pinion and wheel at toe, calculation point, heel [rad]."""
        toe, _, heel = self.pinion_cone_distances
        pinion = [self.pinion_spiral_angle_at(distance) for distance in (toe, heel)]
        wheel = [self.wheel_spiral_angle_at(distance) for distance in self.wheel_cone_distances]
        middle = self.pitch_cones.spiral_angles
        return (pinion[0], middle[0], pinion[1]), (wheel[0], middle[1], wheel[2])

    @property
    def outer_normal_backlash(self) -> float:
        """j_en [mm]."""
        outer = cos(self.wheel_spiral_angle_at(self.wheel_cone_distances[2]))
        return self._backlash_at_mean * outer * self._growth / cos(self.pitch_cones.spiral_angles[1])

    @property
    def _growth(self) -> float:
        return self.wheel_cone_distances[2] / self.wheel_cone_distances[1]

    @property
    def _backlash_at_mean(self) -> float:
        """j_mn, normal at the calculation point [mm]."""
        spiral, pressure = self.pitch_cones.spiral_angles[1], 0.5 * sum(self.generated_pressure_angles)
        outer = cos(self.wheel_spiral_angle_at(self.wheel_cone_distances[2]))
        to_mean = {
            "outer_normal": cos(spiral) / outer / self._growth,
            "outer_transverse": cos(pressure) * cos(spiral) / self._growth,
            "mean_normal": 1.0,
            "mean_transverse": cos(pressure) * cos(spiral),
        }
        return self.backlash * to_mean[self.backlash_kind]

    def _gear(self, member: int) -> BlankGear:
        pressure = 0.5 * sum(self.generated_pressure_angles)
        face, root = (
            self._planes[1]
            if member == 0
            else (
                self.cones.pitch_angles[1] + self.depth_angles[0],
                self.cones.pitch_angles[1] - self.depth_angles[1],
            )
        )
        pitch = self.cones.pitch_angles[member]
        root, face = (pitch if abs(one - pitch) < _ROUNDING else one for one in (root, face))
        if not 0.0 < root <= pitch <= face < pi:
            raise GeometryError(
                f"{('pinion', 'wheel')[member]}: root angle {degrees(root):.4f} deg, pitch angle {degrees(pitch):.4f} "
                f"deg and face angle {degrees(face):.4f} deg are not in order; reduce taper or offset"
            )
        return BlankGear(
            name=GEARS[member],
            teeth=self.teeth[member],
            pitch_angle=pitch,
            pressure_angle=pressure,
            cone_distances=(self.pinion_cone_distances, self.wheel_cone_distances)[member],
            spiral_angles=self.spiral_angles[member],
            mean_addendum=self.mean_addenda[member],
            mean_dedendum=self.mean_dedenda[member],
            addendum_angle=face - pitch,
            dedendum_angle=pitch - root,
            mean_normal_thickness=self.mean_normal_thickness(member, pressure, self._backlash_at_mean),
            profile_shift=(1.0, -1.0)[member] * self.profile_shift,
            smallest_profile_shift=-inf,
            face_apex=self._apexes[member][0],
            root_apex=self._apexes[member][1],
        )

    @cached_property
    def pinion(self) -> BlankGear:
        """Blank of the pinion; its apexes are counted from the crossing point."""
        return self._gear(0)

    @cached_property
    def wheel(self) -> BlankGear:
        """Blank of the wheel; its apexes are counted from the crossing point."""
        return self._gear(1)
