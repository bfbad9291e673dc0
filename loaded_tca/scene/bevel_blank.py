"""[pair.blank] of straight and spiral bevel gears: depths, thicknesses and tapers as ISO 23509 has them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees, pi, radians, tan
from typing import Any, ClassVar, Literal

from loaded_tca.errors import InputError
from loaded_tca.gears.bevel_blank import BacklashKind, BevelBlank, Taper, crown_gear_factors, usual_factors
from loaded_tca.gears.blank_gear import SECTIONS
from loaded_tca.gears.face_milled import FaceMilledGear
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Row
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


@dataclass(frozen=True, kw_only=True)
class Blank(Section):
    """[pair.blank]: teeth of data type I or II on face and root cones with apexes of their own (ISO 23509).

    Without any key of either type the teeth are those of type II with its usual factors (annex C).
    """

    taper: Taper = key(
        Choice(("standard", "uniform", "duplex", "modified")), "how the depth falls from heel to toe", "standard"
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
        Number(0.0, 1.0), "type II: k_c, clearance over the working depth", None, "0.125"
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
        face_width: float,
        *,
        shaft_angle: float,
        spiral_angle: float,
        pressure_angle: float,
        outer_module: float,
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
        }
        if angles[0] is not None and angles[1] is not None:
            # theta_f1 = theta_a2: what BevelBlank takes are the dedendum angles of pinion and wheel
            about["wheel_angles"] = (radians(angles[0]), radians(angles[1]))
        about |= self._factors(teeth, shaft_angle)
        try:
            blank = BevelBlank(teeth, outer_module, face_width, **about)
            if self.wheel_slot_width_mm is not None:
                slot = self.wheel_slot_width_mm / (2.0 * blank.mean_normal_module)
                slot += blank.dedendum_factor * tan(pressure_angle)
                blank = replace(blank, thickness_modification=slot - 0.25 * pi)
            for name, kind in BACKLASHES.items():
                if (backlash := getattr(self, name)) is not None:
                    blank = blank.with_backlash(backlash, kind)
        except InputError as error:
            raise InputError(f"pair.blank: {problem}" for problem in error.problems) from None
        return blank

    def _factors(self, teeth: tuple[int, int], shaft_angle: float) -> dict[str, float]:
        """Parameters of data type I, as given or from type II."""
        if self.data_type == "I":
            usual = {
                "profile_shift": 0.0,
                "addendum_factor": 1.0,
                "dedendum_factor": 1.25,
                "thickness_modification": 0.0,
            }
            return {name: usual[name] if getattr(self, name) is None else getattr(self, name) for name in TYPE_I}
        named = {
            "addendum_share": self.mean_addendum_factor,
            "depth": self.depth_factor,
            "clearance": self.clearance_factor,
            "thickness": self.thickness_factor,
        }
        factors = {name: value for name, value in named.items() if value is not None}
        return crown_gear_factors(**(usual_factors(teeth, shaft_angle) | factors))


def blank_rows(blanks: BevelBlank, section: Blank | None) -> list[Row]:
    """Return the rows of a dimension sheet: depths, cones with their apexes, thicknesses, slots, contact ratios."""
    gears = blanks.pinion, blanks.wheel
    kind = "given" if section is None else section.data_type
    profile, lengthwise = blanks.virtual_contact_ratios
    spirals = blanks.pinion.spiral_angles if blanks.cutter_radius else (blanks.spiral_angle,) * 3
    slots = "constant" if blanks.has_constant_slots else "as the pitch"
    rows: list[Row] = [
        ("blank after ISO 23509: data type, taper", kind, blanks.taper),
        ("slots along the face", slots),
        (
            "working, whole depth h_mw, h_m; clearance c [mm]",
            *_numbers(blanks.working_depth, blanks.whole_depth, blanks.clearance),
        ),
        ("contact ratios eps_va, eps_vb by 0.85 b", *_numbers(profile, lengthwise)),
        ("cutter's spiral angle at toe, mid, heel [deg]", *_numbers(*map(degrees, spirals))),
        ("outer normal backlash j_en [mm]", *_numbers(blanks.outer_normal_backlash)),
        ("face angle delta_a of the cone itself [deg]", *_numbers(*(degrees(gear.face_angle) for gear in gears))),
        ("  its apex t_zF beyond the crossing point [mm]", *_numbers(*(gear.face_apex for gear in gears))),
        ("root angle delta_f of the cone itself [deg]", *_numbers(*(degrees(gear.root_angle) for gear in gears))),
        ("  its apex t_zR beyond the crossing point [mm]", *_numbers(*(gear.root_apex for gear in gears))),
        ("mean normal thickness s_mn [mm]", *_numbers(*(gear.mean_normal_thickness for gear in gears))),
        ("  its chord s_mnc [mm]", *_numbers(*(gear.chordal_thickness for gear in gears))),
        ("  addendum above it h_amc [mm]", *_numbers(*(gear.chordal_addendum for gear in gears))),
    ]
    along = {
        "addendum h_a": "addenda",
        "dedendum h_f": "dedenda",
        "tip diameter d_a": "tip_diameters",
        "crown to crossing point t_x": "crown_to_crossing",
        "normal thickness s_n": "normal_thicknesses",
        "slot width W": "slot_widths",
        "top land s_an": "tip_thicknesses",
    }
    for label, name in along.items():
        first, second = (getattr(gear, name) for gear in gears)
        for place, pinion, wheel in zip(SECTIONS, first, second, strict=True):
            rows.append((f"{label}, {place} [mm]", *_numbers(pinion, wheel)))
    return rows


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


def _numbers(*values: float) -> tuple[str, ...]:
    return tuple(f"{value:.4f}" for value in values)
