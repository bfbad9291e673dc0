"""One gear of a pair of bevel blanks: what follows from its cones, depths and thicknesses (ISO 23509).

Lengths are in mm, angles in rad; arrays of three are values at toe, mean point and heel. Along the face the depth
follows straight cones; the tooth thickness follows the normal pitch, or where slots are of constant width what these
leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import acos, atan, copysign, cos, inf, pi, radians, sin, sqrt, tan
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import real
from loaded_tca.errors import GeometryError
from loaded_tca.gears.involute import involute

Triple = tuple[float, float, float]

LARGEST_DEPTH_ANGLE = radians(45)
"""Of addendum and dedendum angles, and of the pressure angles of hypoid flanks."""
SECTIONS = ("toe", "mean point", "heel")

# Height over radius, or angle, below which the virtual gear is a rack: cancellation would cost more than curvature.
_RACK = 1e-8


def virtual_curvature(cone_distance: float, pitch_angle: float, spiral_angle: float, pressure_angle: float) -> float:
    r"""Curvature of the virtual spur gear that the normal section of a bevel gear shows [1/mm].

    .. math:: \frac{1}{r_n} = \frac{1 - \sin^2\beta \cos^2\alpha_n}{R \tan\delta}

    Zero for a crown gear (delta 90 deg), negative (an internal gear) beyond.

    Parameters
    ----------
    cone_distance : float [mm]
        R.
    pitch_angle, spiral_angle, pressure_angle : float [rad]
        delta, beta at R, alpha_n.

    References
    ----------
    ISO 23509:2016, formula 213.

    Examples
    --------
    >>> round(2.0 / virtual_curvature(81.273, 0.344647, 0.610865, 0.349066), 2)  # annex F.2: d_mn1 82.241
    82.24
    """
    turned = (sin(spiral_angle) * cos(pressure_angle)) ** 2
    return (1.0 - turned) / (cone_distance * tan(pitch_angle))


def height_over_pitch_cone(pitch_angle: float, cone: tuple[float, float], distance: float) -> float:
    """Height of a face or root cone over the pitch cone, across that at a cone distance [mm]; negative below it.

    Parameters
    ----------
    pitch_angle : float [rad]
    cone : (float, float) [rad], [mm]
        Its angle, and how far its apex lies beyond that of the pitch cone, away from the teeth.
    distance : float [mm]
    """
    angle, apex = cone
    above = angle - pitch_angle
    return (distance * sin(above) + apex * sin(angle)) / cos(above)


def cutter_sine(cone_distance: float, mean_distance: float, spiral_angle: float, cutter_radius: float) -> float:
    r"""sin(beta) at a cone distance, where the circle of a cutter has the spiral angle at the mean one.

    .. math:: \sin\beta = \frac{2 R_m r_{c0} \sin\beta_m - R_m^2 + R^2}{2 R r_{c0}}

    Parameters
    ----------
    cone_distance, mean_distance, cutter_radius : float [mm]
        R, R_m and r_c0.
    spiral_angle : float [rad]
        beta_m.

    Returns
    -------
    float
        Of 1 and more the circle does not cross the cone distance.

    References
    ----------
    ISO 23509:2016, formula 193.
    """
    bend = (cone_distance - mean_distance) * (cone_distance + mean_distance) / (2.0 * cutter_radius)
    return (mean_distance * sin(spiral_angle) + bend) / cone_distance


class BlankPair:
    """What blanks on axes that meet and hypoid ones have in common at the calculation point: depths, thicknesses.

    References
    ----------
    ISO 23509:2016, clause 7.
    """

    addendum_factor: float
    dedendum_factor: float
    profile_shift: float
    thickness_modification: float

    if TYPE_CHECKING:  # a property of each pair

        @property
        def mean_normal_module(self) -> float:
            """m_mn [mm]."""

    @property
    def working_depth(self) -> float:
        """h_mw = 2 k_hap m_mn [mm]."""
        return 2.0 * self.addendum_factor * self.mean_normal_module

    @property
    def clearance(self) -> float:
        """c = (k_hfp - k_hap) m_mn, the same along the face [mm]."""
        return (self.dedendum_factor - self.addendum_factor) * self.mean_normal_module

    @property
    def whole_depth(self) -> float:
        """h_m = (k_hap + k_hfp) m_mn [mm]."""
        return (self.addendum_factor + self.dedendum_factor) * self.mean_normal_module

    @property
    def mean_addenda(self) -> tuple[float, float]:
        """h_am1, h_am2 [mm]."""
        module, shift = self.mean_normal_module, self.profile_shift
        return module * (self.addendum_factor + shift), module * (self.addendum_factor - shift)

    @property
    def mean_dedenda(self) -> tuple[float, float]:
        """h_fm1, h_fm2 [mm]."""
        module, shift = self.mean_normal_module, self.profile_shift
        return module * (self.dedendum_factor - shift), module * (self.dedendum_factor + shift)

    def mean_normal_thickness(self, member: int, pressure_angle: float, backlash: float) -> float:
        """s_mn of a gear [mm] with the mean normal backlash j_mn [mm] of the pair, half of it from each tooth."""
        sign, module = (1.0, -1.0)[member], self.mean_normal_module
        thickening = sign * self.thickness_modification - backlash / (4.0 * module * cos(pressure_angle))
        return module * (0.5 * pi + 2.0 * (thickening + sign * self.profile_shift * tan(pressure_angle)))


def depth_angles_check(wheel_angles: tuple[float, float] | None) -> tuple[bool, str]:
    """Check for ``require`` of theta_a2 and theta_f2, where they are given."""
    shallow = wheel_angles is None or all(abs(real(angle)) < LARGEST_DEPTH_ANGLE for angle in wheel_angles)
    return shallow, f"wheel_angles: {wheel_angles} rad are not within 0.785 rad (45 deg)"


def taper_check(taper: str, tapers: tuple[str, ...]) -> tuple[bool, str]:
    """Check for ``require`` of how the depth falls from heel to toe."""
    return taper in tapers, f"taper: {taper!r} is not one of {', '.join(tapers)}"


@dataclass(frozen=True)
class BlankGear:
    """One gear of a :class:`BevelBlank`, complete: cones, depths, thicknesses.

    Parameters
    ----------
    name : str
    teeth : int
    pitch_angle, pressure_angle : float [rad]
        delta and alpha_n.
    cone_distances, spiral_angles : (float, float, float) [mm], [rad]
        R and beta at toe, mean point, heel.
    mean_addendum, mean_dedendum : float [mm]
        h_am and h_fm, normal to the pitch cone.
    addendum_angle, dedendum_angle : float [rad]
        theta_a and theta_f.
    mean_normal_thickness : float [mm]
        s_mn, on the pitch cone.
    profile_shift, smallest_profile_shift : float
        x_hm and the value below which the teeth are undercut (clause 8), in mean normal modules.
    face_apex, root_apex : float [mm]
        t_zF and t_zR: how far the apex of the cone lies beyond the crossing point of the axes, away from the teeth.
    constant_slots : bool
        Whether slots are of constant width, as one spread-blade cutter leaves them where the taper is duplex.
    """

    name: str
    teeth: int
    pitch_angle: float
    pressure_angle: float
    cone_distances: Triple
    spiral_angles: Triple
    mean_addendum: float
    mean_dedendum: float
    addendum_angle: float
    dedendum_angle: float
    mean_normal_thickness: float
    profile_shift: float
    smallest_profile_shift: float
    face_apex: float
    root_apex: float
    constant_slots: bool = False

    @property
    def face_angle(self) -> float:
        """delta_a = delta + theta_a [rad]."""
        return self.pitch_angle + self.addendum_angle

    @property
    def root_angle(self) -> float:
        """delta_f = delta - theta_f [rad]."""
        return self.pitch_angle - self.dedendum_angle

    @property
    def is_undercut(self) -> bool:
        """Whether a generating tool cuts into the flank, at toe or heel."""
        return self.profile_shift < self.smallest_profile_shift

    @property
    def pitch_diameters(self) -> NDArray[np.float64]:
        """d_i, d_m, d_e = 2 R sin(delta) [mm]."""
        return 2.0 * sin(self.pitch_angle) * np.array(self.cone_distances)

    @property
    def addenda(self) -> NDArray[np.float64]:
        """h_ai, h_am, h_ae, normal to the pitch cone [mm]."""
        return self.mean_addendum + self._from_mid_face * tan(self.addendum_angle)

    @property
    def dedenda(self) -> NDArray[np.float64]:
        """h_fi, h_fm, h_fe, normal to the pitch cone [mm]."""
        return self.mean_dedendum + self._from_mid_face * tan(self.dedendum_angle)

    @property
    def _from_mid_face(self) -> NDArray[np.float64]:
        return np.array(self.cone_distances) - self.cone_distances[1]

    @property
    def tip_diameters(self) -> NDArray[np.float64]:
        """d_ai, d_am, d_ae = d + 2 h_a cos(delta) [mm]."""
        return self.pitch_diameters + 2.0 * cos(self.pitch_angle) * self.addenda

    @property
    def root_diameters(self) -> NDArray[np.float64]:
        """d_fi, d_fm, d_fe = d - 2 h_f cos(delta) [mm]."""
        return self.pitch_diameters - 2.0 * cos(self.pitch_angle) * self.dedenda

    @property
    def mean_point_to_crossing(self) -> float:
        """t_zm = R_m cos(delta): calculation point from the crossing point of the axes, along the own axis [mm]."""
        return self.cone_distances[1] * cos(self.pitch_angle)

    @property
    def outer_whole_depth(self) -> float:
        r"""h_t, whole depth at the heel, normal to the root cone [mm].

        .. math:: h_t = \frac{t_{xo} + t_{zF}}{\cos\delta_a} \sin(\theta_a + \theta_f)
                  - (t_{zR} - t_{zF}) \sin\delta_f
        """
        along = (float(self.crown_to_crossing[2]) + self.face_apex) / cos(self.face_angle)
        between = sin(self.addendum_angle + self.dedendum_angle)
        return along * between - (self.root_apex - self.face_apex) * sin(self.root_angle)

    @property
    def thickness_coefficient(self) -> float:
        """x_sm: what thickens the tooth beyond pi/2 and profile shift, over two mean normal modules; backlash in it."""
        module = float(self.normal_pitches[1]) / pi
        thick = 0.5 * self.mean_normal_thickness / module
        return thick - 0.25 * pi - self.profile_shift * tan(self.pressure_angle)

    @property
    def virtual_diameter(self) -> float:
        """d_mn of the virtual spur gear in the mean normal section; infinite of a crown gear [mm]."""
        bend = float(self.virtual_curvatures[1])
        return 2.0 / bend if bend else inf

    @property
    def crown_to_crossing(self) -> NDArray[np.float64]:
        """t_xi, t_xm, t_xo: tip from the crossing point of the axes, along the own axis [mm]."""
        return cos(self.pitch_angle) * np.array(self.cone_distances) - sin(self.pitch_angle) * self.addenda

    @property
    def normal_pitches(self) -> NDArray[np.float64]:
        """p_n = pi d cos(beta)/z [mm]."""
        return pi * self.pitch_diameters * np.cos(self.spiral_angles) / self.teeth

    @property
    def normal_thicknesses(self) -> NDArray[np.float64]:
        """s_n on the pitch cone: what slots of constant width leave, else in proportion to the normal pitch [mm]."""
        proportional = self.mean_normal_thickness / self.normal_pitches[1] * self.normal_pitches
        if not self.constant_slots:
            return proportional
        slots = self.normal_pitches - 2.0 * tan(self.pressure_angle) * self.dedenda
        return slots - (slots[1] - self.mean_normal_thickness)

    @property
    def mean_slot_width(self) -> float:
        """W_m, width of the slot at its bottom at the mean point, the theoretical point width of a cutter [mm]."""
        return float(self.slot_widths[1])

    @property
    def mean_transverse_thickness(self) -> float:
        """s_mt = s_mn/cos(beta_m) [mm]."""
        return self.mean_normal_thickness / cos(self.spiral_angles[1])

    @property
    def virtual_curvatures(self) -> NDArray[np.float64]:
        """1/r_n of the virtual spur gear in the normal section, not positive from a pitch angle of 90 deg on [1/mm]."""
        pairs = zip(self.cone_distances, self.spiral_angles, strict=True)
        pitch, pressure = self.pitch_angle, self.pressure_angle
        return np.array([virtual_curvature(distance, pitch, spiral, pressure) for distance, spiral in pairs])

    @property
    def tip_thicknesses(self) -> NDArray[np.float64]:
        """s_an, normal tooth thickness at the tip of the virtual spur gear; negative: pointed tooth [mm]."""
        rows = zip(self.addenda, self.normal_thicknesses, self.virtual_curvatures, strict=True)
        return np.array([_thickness_at(*row, self.pressure_angle) for row in rows])

    @property
    def slot_widths(self) -> NDArray[np.float64]:
        """Width of the slot at its bottom, p_n - s_n - 2 h_f tan(alpha_n), the widest tool that fits [mm]."""
        return self.normal_pitches - self.normal_thicknesses - 2.0 * tan(self.pressure_angle) * self.dedenda

    @property
    def chordal_thickness(self) -> float:
        """s_mnc, mean normal chord: d_mn sin(s_mn/d_mn) with d_mn = 2 r_n [mm]."""
        bend = 0.5 * self.virtual_curvatures[1]
        angle = self.mean_normal_thickness * bend
        return self.mean_normal_thickness if abs(angle) < _RACK else sin(angle) / bend

    @property
    def chordal_addendum(self) -> float:
        """h_amc, mean addendum above that chord: h_am + d_mn cos(delta) (1 - cos(s_mn/d_mn))/2 [mm]."""
        bend = 0.5 * self.virtual_curvatures[1]
        angle = self.mean_normal_thickness * bend
        rise = 0.0 if abs(angle) < _RACK else sin(0.5 * angle) ** 2 / bend
        return self.mean_addendum + cos(self.pitch_angle) * rise

    def with_cones(self, face: tuple[float, float] | None = None, root: tuple[float, float] | None = None) -> BlankGear:
        """Return the gear between other cones, given by angle [rad] and t_z [mm]; its depths follow from them."""
        changes: dict[str, Any] = {}
        for name, cone, sign in (("addendum", face, 1.0), ("dedendum", root, -1.0)):
            if cone is not None:
                angle, apex = cone
                above = angle - self.pitch_angle
                height = height_over_pitch_cone(self.pitch_angle, cone, self.cone_distances[1])
                changes |= {f"{name}_angle": sign * above, f"mean_{name}": sign * height}
                changes["face_apex" if face is cone else "root_apex"] = apex
        return replace(self, **changes) if changes else self

    @property
    def edge_radius_of_slot(self) -> float:
        r"""Largest radius of the blade tips that fit side by side on the bottom of the slot where it is narrowest [mm].

        .. math:: r = \frac{W}{2 \tan(45° - \alpha_n/2)}
        """
        return 0.5 * float(self.slot_widths.min()) / tan(0.25 * pi - 0.5 * self.pressure_angle)

    def edge_radius_of_clearance(self, clearance: float) -> float:
        r"""Largest radius of the blade tips whose rounding stays below the mating gear's tip, c above the root [mm].

        .. math:: r = \frac{c}{1 - \sin\alpha_n}
        """
        return clearance / (1.0 - sin(self.pressure_angle))

    def check(self, allow_undercut: bool) -> None:
        """Raise GeometryError where this gear cannot exist; the message says where, and what to change."""
        self._require("no addendum is left", self.addenda, "reduce profile shift, taper or face width")
        self._require("no dedendum is left", self.dedenda, "reduce profile shift, taper or face width")
        self._require("pointed tooth: no tip is left", self.tip_thicknesses, "reduce profile shift or addendum")
        self._require("the slot closes above its root: no width is left", self.slot_widths, "reduce dedendum or taper")
        if self.is_undercut and not allow_undercut:
            raise GeometryError(
                f"{self.name}: undercut with a profile shift x_hm of {self.profile_shift:.4f}; with these cones the"
                f" least is {self.smallest_profile_shift:.4f} (or allow_undercut, for teeth that are not generated)"
            )

    def _require(self, fault: str, lengths: NDArray[np.float64], remedy: str) -> None:
        """Refuse lengths that are not positive everywhere."""
        if not lengths.min() > 0.0:
            place = SECTIONS[int(lengths.argmin())]
            raise GeometryError(f"{self.name}: {fault} ({lengths.min():.4f} mm) at the {place}; {remedy}")


def _thickness_at(height: float, thickness: float, curvature: float, pressure_angle: float) -> float:
    """Tooth thickness of a spur gear at a height above the circle of given thickness and curvature [mm].

    An internal gear keeps the thickness of its base circle beyond it, where its flank ends.
    """
    growth = 1.0 + curvature * height
    if abs(growth - 1.0) < _RACK:
        return thickness - 2.0 * height * tan(pressure_angle)
    end = acos(cos(pressure_angle) / growth) if growth > cos(pressure_angle) else 0.0
    return growth * (thickness + 2.0 * (involute(pressure_angle) - involute(end)) / curvature)


def virtual_contact_ratios(
    diameters: Sequence[float], addenda: Sequence[float], angles: tuple[float, float], module: float, width: float
) -> tuple[float, float]:
    """Profile and overlap contact ratio of the virtual cylindrical gears of a pair (ISO 10300-1:2014, annex A).

    Parameters
    ----------
    diameters, addenda : two floats [mm]
        Of the virtual gears in the transverse section; the diameter of an internal one is negative.
    angles : (float, float) [rad]
        Normal pressure angle, spiral angle.
    module : float [mm]
        Normal.
    width : float [mm]
        Effective face width.
    """
    normal, spiral = angles
    pressure = atan(tan(normal) / cos(spiral))
    length = 0.0
    for diameter, addendum in zip(diameters, addenda, strict=True):
        tip, base = diameter + 2.0 * addendum, diameter * cos(pressure)
        length += 0.5 * (copysign(sqrt(max(tip**2 - base**2, 0.0)), diameter) - diameter * sin(pressure))
    return length * cos(spiral) / (pi * module * cos(pressure)), width * sin(spiral) / (pi * module)
