"""[pair.settings] of face-milled gears that are given by their blanks: how machine settings and cutters follow."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, degrees, pi, radians
from typing import ClassVar, Literal, get_args

from loaded_tca.errors import GeometryError, require
from loaded_tca.gears.basic_settings import Gears, duplex_spread_blade, spread_blade
from loaded_tca.gears.bevel_blank import BevelBlank
from loaded_tca.gears.face_milled import FlankName
from loaded_tca.pairs.mean_point import OTHER_FLANK, MeanContact
from loaded_tca.pairs.synthesis import local_synthesis, mean_contact, mean_tilt, with_tooth_angle
from loaded_tca.plain import plain
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Hand, Row
from loaded_tca.scene.section import Rule, Section, rule
from loaded_tca.units import UNITS

Method = Literal["duplex_spread_blade", "spread_blade", "local_synthesis"]
METHODS: tuple[Method, ...] = get_args(Method)
USUAL_PATH_deg = 120.0
"""Of the concave flank of the pinion; 180 deg less it of the convex one."""
USUAL_LENGTH = 0.4
"""Part of the face width that the contact ellipse takes."""
USUAL_FALL_arcsec = 10.0


def _only_of(method: Method, *names: str) -> tuple[Rule, ...]:
    """Rules: keys that one method alone takes."""
    return tuple(
        rule(
            (name, "method"),
            lambda value, given: value is None or given == method,
            f'found {{0}}; allowed with method = "{method}" alone, not with "{{1}}"',
        )
        for name in names
    )


@dataclass(frozen=True, kw_only=True)
class Settings(Section):
    """[pair.settings]: machine settings and cutters of both gears, made of their blanks."""

    method: Method = key(
        Choice(METHODS),
        "basic settings in closed form; or the pinion by local synthesis, for the contact asked for at the mean point, "
        "and the wheel by `duplex_spread_blade`",
        "duplex_spread_blade",
    )
    edge_radius_mm: float = key(Number(0.0, 1000.0), "radius of the rounded tips of all blades", 0.0)
    cutter_number: float | None = key(
        Number(-200.0, 200.0),
        "number of the blade group of a duplex_spread_blade pair",
        None,
        "by the tilt of the root planes, to a half",
    )
    motion_fall_arcsec: float | None = key(
        Number(0.0, 3600.0),
        "local_synthesis: lag of the wheel half a pitch away from the mean point, by the parabola that fits the motion "
        "curve there",
        None,
        f"{plain(USUAL_FALL_arcsec, 6)}",
    )
    path_angle_deg: float | None = key(
        Number(5.0, 175.0),
        "local_synthesis: direction of the path of contact at the mean point of the pinion's flank, from the tooth "
        "trace at the heel (0) over the tip (90) to the toe (180)",
        None,
        f"{plain(USUAL_PATH_deg, 6)} on the concave flank, {plain(180.0 - USUAL_PATH_deg, 6)} on the convex one",
    )
    contact_length_mm: float | None = key(
        above_zero(10000.0),
        "local_synthesis: length of the contact ellipse at the mean point under an approach of 6.35 um (compound)",
        None,
        f"{plain(USUAL_LENGTH, 6)} of the face width",
    )
    both_flanks: bool | None = key(
        Choice((False, True)),
        "local_synthesis: whether the other flank of the pinion, cut in the same pass, has this contact, too (with the "
        "path mirrored), which takes tilt and helical motion; false: the other flank only touches at the mean point",
        None,
        "false",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *_only_of("local_synthesis", "motion_fall_arcsec", "path_angle_deg", "contact_length_mm", "both_flanks"),
        rule(
            ("cutter_number", "method"),
            lambda number, method: number is None or method != "spread_blade",
            'found {0:g}; not allowed with method = "{1}", whose blades have the normal pressure angle',
        ),
    )

    def aim(self, blanks: BevelBlank, flank: FlankName) -> MeanContact:
        """Contact that is asked of a flank of the pinion."""
        fall = USUAL_FALL_arcsec if self.motion_fall_arcsec is None else self.motion_fall_arcsec
        path = self.path_angle_deg
        if path is None:
            path = USUAL_PATH_deg if flank == "concave" else 180.0 - USUAL_PATH_deg
        return MeanContact(
            motion_fall=UNITS["arcsec"].factor * fall,
            path_angle=radians(path),
            contact_length=self.contact_length_mm or USUAL_LENGTH * min(blanks.face_widths),
        )

    def gears(self, blanks: BevelBlank, pinion_hand: Hand, flank: FlankName) -> Gears:
        """Return pinion and wheel with their cutters and machine settings.

        Parameters
        ----------
        blanks : BevelBlank
            With a cutter radius.
        pinion_hand : {"right", "left"}
        flank : {"concave", "convex"}
            Of the pinion, whose contact is asked for.

        Raises
        ------
        InputError
            If the blanks have no cutter radius.
        GeometryError
            If there are no such settings.
        """
        radius, ways = blanks.cutter_radius, {"spread_blade": spread_blade}
        require(
            (
                radius is not None,
                "pair.blank.cutter_radius_mm: missing; machine settings follow from blanks and their cutter",
            ),
        )
        internal = next((gear for gear in (blanks.pinion, blanks.wheel) if gear.root_angle >= 0.5 * pi), None)
        if internal is not None:
            raise GeometryError(
                f"{internal.name}: a root angle of {degrees(internal.root_angle):.2f} deg is that of an internal bevel"
                " gear, into which a cutter on a cradle does not reach; take a smaller shaft angle or ratio"
            )
        largest = min(gear.edge_radius_of_slot for gear in (blanks.pinion, blanks.wheel))
        require(
            (
                self.edge_radius_mm <= largest,
                f"pair.settings.edge_radius_mm: found {plain(self.edge_radius_mm, 6)}; allowed up to {largest:.4f}: "
                "both blades of a slot would be rounded over more than its width",
            ),
        )
        if self.method in ways:
            return ways[self.method](blanks, pinion_hand, self.edge_radius_mm)
        basic = duplex_spread_blade(blanks, pinion_hand, self.edge_radius_mm, self.cutter_number)
        if self.method == "duplex_spread_blade":
            return basic
        start, wheel = basic
        aim = self.aim(blanks, flank)
        thicknesses = [
            2.0 * gear.mean_normal_thickness / (gear.pitch_diameters[1] * cos(blanks.spiral_angle))
            for gear in (blanks.pinion, blanks.wheel)
        ]
        try:
            wheel = with_tooth_angle(wheel, thicknesses[1])
            pinion = local_synthesis(
                start,
                wheel,
                aim,
                pinion_flank=flank,
                other_aim=_mirrored(aim) if self.both_flanks else None,
                tooth_angle=thicknesses[0],
            )
        except GeometryError as error:
            raise GeometryError(f"pair.settings: {error}") from None
        return pinion, wheel


def _mirrored(aim: MeanContact) -> MeanContact:
    """The same contact of the other flank of a tooth."""
    return replace(aim, path_angle=radians(180.0) - aim.path_angle)


def mean_contact_rows(gears: Gears, flank: FlankName) -> list[Row]:
    """Return what the settings make of the contact at the mean point, of both flanks of the pinion."""
    flanks = flank, OTHER_FLANK[flank]
    tilts = (f"{60.0 * degrees(mean_tilt(*gears, each)):.3f}" for each in flanks)
    rows: list[tuple[str, ...]] = []
    for each in flanks:
        try:
            contact = mean_contact(*gears, each)
        except GeometryError:
            rows.append(("no", "none", "none", "none"))
            continue
        fall = contact.motion_fall / UNITS["arcsec"].factor
        rows.append(("yes", f"{fall:.3f}", f"{degrees(contact.path_angle):.3f}", f"{contact.contact_length:.3f}"))
    labels = (
        "  they carry there, not at their edges alone",
        "  fall of the motion curve at half a pitch [arcsec]",
        "  path of contact from the tooth trace [deg]",
        "  length of the contact ellipse, 6.35 um [mm]",
    )
    return [
        ("contact at the mean point, flanks of the pinion", *flanks),
        ("  normals of both flanks there apart by [arcmin]", *tilts),
        *((label, *cells) for label, cells in zip(labels, zip(*rows, strict=True), strict=True)),
    ]
