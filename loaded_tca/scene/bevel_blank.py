"""[pair.blank] of straight and spiral bevel gears: depths, thicknesses and tapers as ISO 23509 has them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, degrees, inf, pi, radians, sin, tan
from typing import Any, ClassVar, Literal

from loaded_tca.arrays import GEARS
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.gears.bevel_blank import BacklashKind, BevelBlank, Cones, Taper
from loaded_tca.gears.blank_factors import (
    crown_gear_factors,
    equivalent_ratio,
    largest_ratio,
    measured_depths,
    measured_thicknesses,
    usual_factors,
)
from loaded_tca.gears.face_milled import FaceMilledGear
from loaded_tca.plain import plain
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.section import Rule, Section, rule

FACTOR = Number(-5.0, 5.0)
DEPTH_ANGLE_deg = Number(-44.0, 44.0)
BACKLASH_mm = Number(0.0, 100.0)
USUAL_I = {"profile_shift": 0.0, "addendum_factor": 1.0, "dedendum_factor": 1.25, "thickness_modification": 0.0}
TYPE_I = tuple(USUAL_I)
TYPE_II = "mean_addendum_factor", "depth_factor", "clearance_factor", "thickness_factor", "wheel_slot_width_mm"
BACKLASHES: dict[str, BacklashKind] = {
    "outer_normal_backlash_mm": "outer_normal",
    "outer_transverse_backlash_mm": "outer_transverse",
    "mean_normal_backlash_mm": "mean_normal",
    "mean_transverse_backlash_mm": "mean_transverse",
}


def _one_type(*values: object) -> str | None:
    given = dict(zip((*TYPE_I, *TYPE_II), values, strict=True))
    first, second = ([name for name in names if given[name] is not None] for names in (TYPE_I, TYPE_II))
    if not (first and second):
        return None
    return f"given beside {second[0]}; allowed keys of data type I ({', '.join(TYPE_I)}) or II ({', '.join(TYPE_II)})"


def _one_of(*names: str) -> Rule:
    def complain(*values: object) -> str | None:
        given = [name for name, value in zip(names, values, strict=True) if value is not None]
        return None if len(given) < 2 else f"given are {' and '.join(given)}; allowed one of {', '.join(names)}"

    return Rule(names, complain)


MEASURED = "mean_addendum_mm", "mean_dedendum_mm", "mean_normal_thickness_mm"
"""Keys of a gear that stand for the data of type I or II."""


@dataclass(frozen=True)
class Measured:
    """What the gears of a drawing have instead of data, or of what follows from them.

    Attributes
    ----------
    addenda, dedenda, thicknesses : (float, float), optional [mm]
        h_am, h_fm and s_mn of pinion and wheel.
    cones : of :class:`BevelBlank`
    """

    addenda: tuple[float, float] | None
    dedenda: tuple[float, float] | None
    thicknesses: tuple[float, float] | None
    cones: tuple[Cones, Cones]

    @classmethod
    def of(cls, pinion: Any, wheel: Any) -> Measured:
        """Of the sections of both gears."""

        def both(name: str) -> tuple[float, float] | None:
            first, second = getattr(pinion, name), getattr(wheel, name)
            return None if first is None or second is None else (first, second)

        def cone(gear: Any, name: str) -> tuple[float, float] | None:
            angle, apex = getattr(gear, f"{name}_angle_deg"), getattr(gear, f"{name}_apex_mm")
            return None if angle is None or apex is None else (radians(angle), apex)

        first, second = ((cone(gear, "face"), cone(gear, "root")) for gear in (pinion, wheel))
        addenda, dedenda, thicknesses = (both(name) for name in MEASURED)
        return cls(addenda, dedenda, thicknesses, (first, second))


def _measured_rules() -> Iterator[Rule]:
    """Rules of a scene: what a gear may have of its own beside [pair.blank]."""
    for gear in GEARS:
        yield rule(
            (f"{gear}.profile_shift", "pair.blank"),
            lambda value, blank: blank is None or not value,
            "found {0:g}; not allowed with [pair.blank]: give pair.blank.profile_shift, that of the pinion",
        )
        for cone in ("face", "root"):
            yield rule(
                (f"{gear}.{cone}_angle_deg", f"{gear}.{cone}_apex_mm", "pair.blank"),
                lambda angle, apex, blank: blank is None or angle is None or apex is not None,
                f"found {{0:g}}; with [pair.blank] allowed with {gear}.{cone}_apex_mm: cones of a drawing are angle "
                "and apex",
            )
        for name in MEASURED:
            yield rule(
                (f"{gear}.{name}", "pair.blank"),
                lambda value, blank: blank is not None or value is None,
                "found {0:g}; allowed with a section [pair.blank]",
            )
    depths = tuple(f"{gear}.{name}" for name in MEASURED[:2] for gear in GEARS)
    thicknesses = tuple(f"{gear}.{MEASURED[2]}" for gear in GEARS)
    yield Rule((*depths, "pair.blank"), _all_depths)
    yield Rule((*thicknesses, depths[0], "pair.blank"), _thicknesses)


def _all_depths(*values: Any) -> str | None:
    depths, blank = values[:4], values[4]
    if all(value is None for value in depths) or blank is None:
        return None
    if None in depths:
        return "measured depths need mean_addendum_mm and mean_dedendum_mm of both gears"
    others = [name for name in (*TYPE_I, *TYPE_II) if getattr(blank, name) is not None]
    if not others:
        return None
    kind = "I" if others[0] in TYPE_I else "II"
    return f"measured depths beside pair.blank.{others[0]}, of data type {kind}; give one of the two"


def _thicknesses(first: Any, second: Any, depth: Any, blank: Any) -> str | None:
    if (first is None and second is None) or blank is None:
        return None
    if first is None or second is None or depth is None:
        return "measured thicknesses need both gears, with mean_addendum_mm and mean_dedendum_mm"
    given = [name for name in BACKLASHES if getattr(blank, name) is not None]
    return f"measured thicknesses beside pair.blank.{given[0]}, which follows from them" if given else None


MEASURED_RULES = tuple(_measured_rules())
"""Of a scene with gears that may have a blank."""


@dataclass(frozen=True, kw_only=True)
class Blank(Section):
    """[pair.blank]: teeth of data type I or II on face and root cones with apexes of their own (ISO 23509).

    Without any key of either type the teeth are those of type II with its usual factors (annex C).
    """

    taper: Taper = key(
        Choice(("standard", "uniform", "duplex", "modified")), "how the depth falls from heel to toe", "standard"
    )
    lengthwise_curve: Literal["logarithmic", "cutter_circle"] = key(
        Choice(("logarithmic", "cutter_circle")),
        "how straight and spiral bevel flanks run along the face: a logarithmic spiral, of one spiral angle, or the "
        "circle of the cutter, through beta_m at R_m",
        "logarithmic",
    )
    outer_face_share: float = key(
        Number(0.05, 0.95),
        "c_be2, part of either face width between the calculation point R_m and the heel; both gears have one R_m",
        0.5,
    )
    allow_undercut: bool = key(
        Choice((False, True)), "whether undercut teeth are taken, as of gears that are not generated", False
    )
    cutter_radius_mm: float | None = key(
        above_zero(10000.0), "radius r_c0 of the face-milling cutter", None, "none; required for duplex and modified"
    )
    profile_shift: float | None = key(FACTOR, "type I: x_hm of the pinion, the wheel's is its negative", None, "0")
    addendum_factor: float | None = key(above_zero(3.0), "type I: k_hap", None, "1")
    dedendum_factor: float | None = key(above_zero(3.0), "type I: k_hfp", None, "1.25")
    thickness_modification: float | None = key(FACTOR, "type I: x_smn of the pinion", None, "0")
    mean_addendum_factor: float | None = key(
        Number(0.0, 1.0), "type II: c_ham, the wheel's share of the working depth", None, "0.21 + 0.29/u_a²"
    )
    depth_factor: float | None = key(above_zero(6.0), "type II: k_d, working depth in mean normal modules", None, "2")
    clearance_factor: float | None = key(
        above_zero(1.0), "type II: k_c, clearance over the working depth", None, "0.125"
    )
    thickness_factor: float | None = key(FACTOR, "type II: k_t", None, "by the ratio and z1, see `usual_factors`")
    wheel_slot_width_mm: float | None = key(
        above_zero(1000.0),
        "type II: theoretical point width W_m2 of the wheel's slots, instead of `thickness_factor`",
        None,
        "by k_t",
    )
    wheel_addendum_angle_deg: float | None = key(DEPTH_ANGLE_deg, "theta_a2 of a drawing", None, "by the taper")
    wheel_dedendum_angle_deg: float | None = key(DEPTH_ANGLE_deg, "theta_f2 of a drawing", None, "by the taper")
    outer_normal_backlash_mm: float | None = key(BACKLASH_mm, "backlash j_en", None, "0")
    outer_transverse_backlash_mm: float | None = key(BACKLASH_mm, "backlash j_et2, instead of j_en", None, "by j_en")
    mean_normal_backlash_mm: float | None = key(BACKLASH_mm, "backlash j_mn, instead of j_en", None, "by j_en")
    mean_transverse_backlash_mm: float | None = key(BACKLASH_mm, "backlash j_mt2, instead of j_en", None, "by j_en")

    rules: ClassVar[tuple[Rule, ...]] = (
        rule(
            ("lengthwise_curve", "cutter_radius_mm"),
            lambda curve, radius: radius is not None or curve == "logarithmic",
            'found "{0}"; allowed with cutter_radius_mm, the radius of that circle',
        ),
        Rule((*TYPE_I, *TYPE_II), _one_type),
        _one_of("thickness_factor", "wheel_slot_width_mm"),
        _one_of(*BACKLASHES),
        rule(
            ("wheel_addendum_angle_deg", "wheel_dedendum_angle_deg"),
            lambda *both: (both[0] is None) == (both[1] is None),
            "allowed with wheel_dedendum_angle_deg: both cones of the wheel, or neither",
        ),
        rule(
            ("cutter_radius_mm", "taper"),
            lambda radius, taper: radius is not None or taper not in ("duplex", "modified"),
            'missing; taper = "{1}" follows from the circle of a cutter',
        ),
    )

    @property
    def data_type(self) -> Literal["I", "II"]:
        """Type of the data that the section gives."""
        return "I" if any(getattr(self, name) is not None for name in TYPE_I) else "II"

    def build(
        self,
        teeth: tuple[int, int],
        face_widths: tuple[float, float],
        *,
        shaft_angle: float,
        spiral_angle: float,
        pressure_angle: float,
        outer_module: float,
        measured: Measured,
    ) -> BevelBlank:
        """Return the blanks; lengths in mm, angles in rad, as :class:`BevelBlank` takes them.

        Raises
        ------
        InputError
            If the values do not fit each other.
        GeometryError
            If the gears cannot exist.
        """
        angles = self.wheel_addendum_angle_deg, self.wheel_dedendum_angle_deg
        about: dict[str, Any] = {
            "shaft_angle": shaft_angle,
            "spiral_angle": spiral_angle,
            "pressure_angle": pressure_angle,
            "cutter_radius": self.cutter_radius_mm,
            "taper": self.taper,
            "allow_undercut": self.allow_undercut,
            "outer_share": self.outer_face_share,
            "cones": measured.cones,
        }
        if face_widths[0] != face_widths[1]:
            about["pinion_face_width"] = face_widths[0]
        if angles[0] is not None and angles[1] is not None:
            # theta_f1 = theta_a2: what BevelBlank takes are the dedendum angles of pinion and wheel
            about["wheel_angles"] = (radians(angles[0]), radians(angles[1]))
        backlashes = {kind: getattr(self, name) for name, kind in BACKLASHES.items()}
        outer = 0.5 * teeth[0] * outer_module / sin(pitch_angles(teeth, shaft_angle)[0])
        module = outer_module * cos(spiral_angle) * (1.0 - self.outer_face_share * face_widths[1] / outer)
        try:
            if measured.addenda is None or measured.dedenda is None:
                about |= self._factors(teeth, shaft_angle)
                if self.wheel_slot_width_mm is not None and module > 0.0:
                    slot = self.wheel_slot_width_mm / (2.0 * module) + about["dedendum_factor"] * tan(pressure_angle)
                    about["thickness_modification"] = slot - 0.25 * pi
            else:
                about |= measured_depths(measured.addenda, measured.dedenda, module)
                if measured.thicknesses is not None:
                    shift = about["profile_shift"]
                    about["thickness_modification"], backlashes["mean_normal"] = measured_thicknesses(
                        measured.thicknesses, shift, module, pressure_angle
                    )
            blank = BevelBlank(teeth, outer_module, face_widths[1], **about)
            for kind, backlash in backlashes.items():
                if backlash is not None:
                    blank = blank.with_backlash(backlash, kind)
        except InputError as error:
            raise InputError(f"pair.blank: {problem}" for problem in error.problems) from None
        except GeometryError as error:
            raise self._with_way_out(error, teeth, shaft_angle, measured) from None
        return blank

    def _with_way_out(
        self, error: GeometryError, teeth: tuple[int, int], shaft_angle: float, measured: Measured
    ) -> GeometryError:
        """Error that names `thickness_factor` where the usual one is no more than the bound of its formula."""
        usual = self.data_type == "II" and self.thickness_factor is None and self.wheel_slot_width_mm is None
        if measured.addenda or not usual or equivalent_ratio(teeth, shaft_angle) <= largest_ratio(teeth):
            return error
        return GeometryError(
            f"{error}; pair.blank.thickness_factor: missing; near a crown wheel the usual factor is "
            f"{plain(usual_factors(teeth, shaft_angle)['thickness'])}, the bound of its formula: give a smaller one, "
            "or pair.blank.wheel_slot_width_mm"
        )

    def _factors(self, teeth: tuple[int, int], shaft_angle: float) -> dict[str, float]:
        """Parameters of data type I, as given or from type II."""
        if self.data_type == "I":
            return {name: USUAL_I[name] if getattr(self, name) is None else getattr(self, name) for name in TYPE_I}
        named = {
            "addendum_share": self.mean_addendum_factor,
            "depth": self.depth_factor,
            "clearance": self.clearance_factor,
            "thickness": self.thickness_factor,
        }
        factors = usual_factors(teeth, shaft_angle)
        factors |= {name: value for name, value in named.items() if value is not None}
        if (share := factors["addendum_share"]) > 1.0:  # the usual one; a given one is from 0 to 1
            raise InputError(
                f"mean_addendum_factor: missing; allowed a factor from 0 to 1, the wheel's share of the working depth. "
                f"The usual one, 0.21 + 0.29/u_a², is {plain(share if share < 100.0 else inf)} for a pinion of "
                f"{teeth[0]} teeth and a wheel of {teeth[1]}: it is meant for pinions that are the smaller gear"
            )
        return crown_gear_factors(**factors)


def settings_table(gear: FaceMilledGear) -> dict[str, Any]:
    """Return blank, machine settings and cutter of a gear as the sections of a scene file have them."""
    blank, machine, cutter = gear.blank, gear.machine, gear.cutter
    lengths = {
        "blank": {"outer_cone_distance": blank.outer_cone_distance, "face_width": blank.face_width}
        | {name: getattr(blank, name) for name in ("face_apex", "root_apex")},
        "machine": {
            name: getattr(machine, name)
            for name in ("radial", "machine_centre_to_back", "sliding_base", "blank_offset")
        },
    }
    angles = {
        "blank": {name: getattr(blank, name) for name in ("pitch_angle", "face_angle", "root_angle")},
        "machine": {name: getattr(machine, name) for name in ("cradle_angle", "root_angle", "tilt", "swivel")},
    }
    table: dict[str, Any] = {
        name: {f"{key}_mm": value for key, value in lengths[name].items()}
        | {f"{key}_deg": degrees(value) for key, value in angles[name].items()}
        for name in lengths
    }
    table["blank"]["hand"] = blank.hand
    if blank.calculation_cone_distance is not None:
        table["blank"]["calculation_cone_distance_mm"] = blank.calculation_cone_distance
    table["machine"] |= {
        name: getattr(machine, name) for name in ("ratio_of_roll", "modified_roll_2c", "modified_roll_6d", "generation")
    }
    table["machine"]["helical_motion_mm_per_rad"] = machine.helical_motion
    blades = {"concave": cutter.concave, "convex": cutter.convex}
    table["cutter"] = {"number": cutter.number} | {
        flank: {
            "point_radius_mm": blade.point_radius,
            "blade_angle_deg": degrees(blade.blade_angle),
            "edge_radius_mm": blade.edge_radius,
        }
        for flank, blade in blades.items()
        if blade is not None
    }
    return table
