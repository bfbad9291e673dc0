"""The mesh of two cylindrical gears on parallel axes: working circles, active profiles, contact ratios (ISO 21771).

Lengths are in mm, angles in rad; the path of contact is that of the transverse section.
Below stands the interference of whole gears, which the contact of one flank of each does not notice.
"""

# ruff: noqa: N802  -- the points of the path of contact keep their letters

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf, isfinite, pi
from typing import NamedTuple

import loaded_tca.warning_kinds as kinds
from loaded_tca.errors import GeometryError, require
from loaded_tca.gears.checks import pair_checks
from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.involute import InvoluteMesh
from loaded_tca.gears.undercut import fillet_room
from loaded_tca.plain import plain


@dataclass(frozen=True)
class ActiveProfile:
    """The part of a flank that the mating gear uses at nominal mounting.

    Parameters
    ----------
    start_radius, end_radius : float [mm]
        d_Nf/2, where the mating gear's tip ends on this flank, or the form circle if larger; d_Na/2, the own tip form
        circle.
    start_roll_length, end_roll_length : float [mm]
        The same as lengths on the line of action.
    fillet_interference : bool
        The mating gear's tip reaches below the form circle.
    """

    start_radius: float
    end_radius: float
    start_roll_length: float
    end_roll_length: float
    fillet_interference: bool


@dataclass(frozen=True)
class PathOfContact:
    """Points of the path of contact in the transverse section, as lengths from T1 on the line of action [mm].

    T1, T2: the line of action touches the base circles. A, E: contact starts and ends (pinion driving). B, D:
    beginning and end of single contact, a base pitch before E and behind A. C: pitch point.
    """

    A: float
    B: float
    C: float
    D: float
    E: float
    T2: float
    T1: float = 0.0

    @property
    def T1T2(self) -> float:
        """Whole line of action between the base circles [mm]."""
        return self.T2 - self.T1

    @property
    def AB(self) -> float:
        """Length of the first double contact, negative for a contact ratio below 1 [mm]."""
        return self.B - self.A

    @property
    def AC(self) -> float:
        """Length of approach [mm]."""
        return self.C - self.A

    @property
    def AD(self) -> float:
        """A base pitch [mm]."""
        return self.D - self.A

    @property
    def AE(self) -> float:
        """Length of the path of contact g_alpha [mm]."""
        return self.E - self.A


@dataclass(frozen=True)
class CylindricalMesh(InvoluteMesh):
    """Two cylindrical gears on parallel axes.

    Parameters
    ----------
    pinion, wheel : CylindricalGear
        Of one normal module and normal pressure angle, with opposite hands.
    centre_distance : float [mm], optional
        a; None: the one without backlash (:attr:`working_centre_distance`). Never refused for its backlash.
    axial_offset : float [mm]
        Mid-face of the wheel from that of the pinion, towards +z: it shortens the common face.

    Raises
    ------
    InputError
        If the gears do not fit each other.
    GeometryError
        If the centre distance or undercuts leave no common flank.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.

    Examples
    --------
    >>> from math import degrees
    >>> pinion = CylindricalGear(teeth=16, normal_module=4.5, face_width=14.0, profile_shift=0.1817)
    >>> wheel = CylindricalGear(teeth=24, normal_module=4.5, face_width=14.0, profile_shift=0.1715)
    >>> mesh = CylindricalMesh(pinion, wheel, centre_distance=91.5)
    >>> round(mesh.transverse_contact_ratio, 2), round(degrees(mesh.working_pressure_angle), 5)
    (1.46, 22.43879)
    """

    pinion: CylindricalGear
    wheel: CylindricalGear
    centre_distance: float | None = None
    axial_offset: float = 0.0

    def __post_init__(self) -> None:
        first, second, distance = self.pinion, self.wheel, self.centre_distance
        require(
            *pair_checks(first, second, ("normal_module",), "helix_angle"),
            (distance is None or 0.0 < distance < inf, f"centre_distance: {distance} mm is not positive and finite"),
            (isfinite(self.axial_offset), f"axial_offset: {self.axial_offset} mm is not finite"),
        )
        self._check_centre_distance()
        self.check_common_flank()

    def _check_centre_distance(self) -> None:
        """Refuse base circles that overlap or only touch."""
        smallest = self.base_distance
        if self.centre_distance is None and self._involute_without_backlash <= 0.0:
            raise GeometryError(
                f"profile_shift: for the sum {plain(self._profile_shift_sum, 6)} no centre distance is without"
                f" backlash; give a centre_distance above {smallest:.4f} mm"
            )
        if self.working_centre_distance <= smallest:
            raise GeometryError(
                f"centre_distance: {plain(self.working_centre_distance, 6)} mm is not above {smallest:.4f} mm,"
                " the sum of the base radii"
            )

    def _roll_length_at_tip_of(self, mating: CylindricalGear) -> float:
        """Roll length on a gear where the tip of its mating gear touches; negative beyond the base circle [mm]."""
        return self.line_of_action - mating.roll_length(mating.tip_form_radius)

    @property
    def mating_tip_rolls(self) -> tuple[float, float]:
        """Roll lengths on pinion and wheel where the tip of the mating gear touches [mm]."""
        return self._roll_length_at_tip_of(self.wheel), self._roll_length_at_tip_of(self.pinion)

    @property
    def base_distance(self) -> float:
        """Centre distance r_b1 + r_b2 at which the base circles touch [mm]."""
        return self.pinion.base_radius + self.wheel.base_radius

    @property
    def gear_ratio(self) -> float:
        """Gear ratio u = z2/z1."""
        return self.wheel.teeth / self.pinion.teeth

    @property
    def pinion_working_radius(self) -> float:
        """r_w1 = a z1/(z1 + z2) [mm]."""
        return self.working_centre_distance / (1.0 + self.gear_ratio)

    @property
    def wheel_working_radius(self) -> float:
        """r_w2 = a z2/(z1 + z2) [mm]."""
        return self.working_centre_distance * self.gear_ratio / (1.0 + self.gear_ratio)

    def backlash_at(self, centre_distance: float) -> float:
        """Backlash at another centre distance, above the sum of the base radii [mm]."""
        pinion_radius = centre_distance / (1.0 + self.gear_ratio)
        pitch = 2.0 * pi * pinion_radius / self.pinion.teeth
        first = self.pinion.tooth_thickness_at(pinion_radius)
        return pitch - first - self.wheel.tooth_thickness_at(centre_distance - pinion_radius)

    @property
    def room(self) -> Room:
        """Room that the whole gears leave each other."""
        pinion, wheel = (
            roll - gear.roll_length(gear.form_radius)
            for gear, roll in zip((self.pinion, self.wheel), self.mating_tip_rolls, strict=True)
        )
        in_fillet = fillet_room(self, 0), fillet_room(self, 1)
        return Room(self.backlash, (pinion, wheel), self.tip_clearances, in_fillet)

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Radial clearance between the roots of pinion and wheel and the mating gear's tip c [mm]."""
        distance = self.working_centre_distance
        return (
            distance - self.pinion.root_radius - self.wheel.tip_radius,
            distance - self.wheel.root_radius - self.pinion.tip_radius,
        )

    @property
    def pinion_active_profile(self) -> ActiveProfile:
        """Part of the pinion's flank that the wheel uses."""
        return self._active_profile(self.pinion, self.wheel)

    @property
    def wheel_active_profile(self) -> ActiveProfile:
        """Part of the wheel's flank that the pinion uses."""
        return self._active_profile(self.wheel, self.pinion)

    def _active_profile(self, gear: CylindricalGear, mating: CylindricalGear) -> ActiveProfile:
        form, wanted = gear.roll_length(gear.form_radius), self._roll_length_at_tip_of(mating)
        start = max(form, wanted)
        return ActiveProfile(
            start_radius=gear.radius_at_roll_length(start),
            end_radius=gear.tip_form_radius,
            start_roll_length=start,
            end_roll_length=gear.roll_length(gear.tip_form_radius),
            fillet_interference=wanted < form,
        )

    @property
    def path_of_contact(self) -> PathOfContact:
        """Points T1, A, B, C, D, E, T2 on the line of action."""
        start = self.pinion_active_profile.start_roll_length
        end = self.line_of_action - self.wheel_active_profile.start_roll_length
        return PathOfContact(
            A=start,
            B=end - self.pinion.base_pitch,
            C=self.line_of_action / (1.0 + self.gear_ratio),
            D=start + self.pinion.base_pitch,
            E=end,
            T2=self.line_of_action,
        )


ROUNDING = 1e-4
"""Overlap over the module that is none: profile shifts printed with four digits leave 0.07 um at module 4.5."""
RIGID = 0.2
"""Overlap of teeth over the module to which none give way: both flanks of a tooth would have to by a tenth of a module,
with a stress at their roots of a fiftieth of Young's modulus, whatever the material."""
BOTH_WAYS = ("pinion", "wheel"), ("wheel", "pinion")
AT_MID_FACE = "at mid-face without mounting errors"
"""Place of the room of gears on meeting axes."""


class Room(NamedTuple):
    """Room that whole gears leave each other in the mesh [mm]; negative: they interfere there.

    Attributes
    ----------
    backlash : float
        Spaces less teeth, at the working or mean pitch circles.
    below_form : (float, float)
        How far the tip of the mating gear ends above the form circle of pinion and wheel, on the line of action.
    below_root : (float, float)
        How far above their roots.
    in_fillet : (float or None, float or None)
        Least room of that tip in the fillets of undercut gears, as of :func:`~loaded_tca.gears.undercut.fillet_room`;
        None where it need not go there.
    """

    backlash: float
    below_form: tuple[float, float]
    below_root: tuple[float, float]
    in_fillet: tuple[float | None, float | None] = (None, None)


def interferences(room: Room, module: float, place: str, *, nominal: bool = False) -> Sequence[str]:
    """Sentences on what jams gears that turn all the same where their teeth give way.

    Parameters
    ----------
    room : Room
    module : float [mm]
        Normal module.
    place : str
        Where the room is that of the gears, for instance a centre distance.
    nominal : bool
        Whether the teeth are nominal ones that fill each other's spaces, so that nothing is known of the backlash of
        gears that are made after them: their teeth are thinner by tolerances of the tooth thickness.

    Raises
    ------
    GeometryError
        If nothing can turn: teeth overlap by more than 0.2 modules, or tips reach into the mating gear's root.

    Examples
    --------
    >>> len(interferences(Room(-0.02, (0.1, -0.003), (0.7, 0.7)), 3.0, "at the centre distance of 141 mm"))
    2
    """
    if problems := [*_what_stops(room, module)]:
        raise GeometryError(f"the gears cannot turn {place}: {'; '.join(problems)}")
    return [f"{sentence} ({place} by {value})" for sentence, value in _what_jams(room, module, nominal)]


def _what_jams(room: Room, module: float, nominal: bool) -> Iterator[tuple[str, str]]:
    """What interferes, and by how much."""
    if room.backlash < -ROUNDING * module and not nominal:
        yield kinds.BACKLASH.sentence(), f"{-room.backlash:.4f} mm"
    for (name, mating), length, rest in zip(BOTH_WAYS, room.below_form, room.in_fillet, strict=True):
        if rest is not None:
            if rest < -ROUNDING * module:
                what = f"the tip of the {mating} reaches into the undercut fillet of the {name}"
                yield kinds.FILLET.sentence(what=what), f"{-rest:.4f} mm along its circle"
        elif length < -ROUNDING * module:
            what = f"the tip of the {mating} reaches below the form circle of the {name}, where its flank ends"
            yield kinds.FILLET.sentence(what=what), f"{-length:.4f} mm on the line of action"


def _what_stops(room: Room, module: float) -> Iterator[str]:
    """Why nothing can turn."""
    if room.backlash < -RIGID * module:
        yield (
            f"teeth are {plain(-room.backlash)} mm thicker than the spaces of the mating gear, more than "
            f"{plain(RIGID, 6)} modules, by which no teeth deflect"
        )
    for (name, mating), length in zip(BOTH_WAYS, room.below_root, strict=True):
        if length < -ROUNDING * module:
            yield f"the tip of the {mating} reaches {plain(-length)} mm into the root of the {name}"
