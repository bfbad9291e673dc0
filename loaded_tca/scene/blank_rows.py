"""What there is to tell of bevel blanks: the lines of a dimension sheet, in its order."""

from __future__ import annotations

from math import degrees
from typing import Any

from loaded_tca.gears.bevel_blank import BevelBlank
from loaded_tca.gears.blank_gear import SECTIONS
from loaded_tca.scene.model import Row


def common_blank_rows(blanks: BevelBlank, section: Any, data_type: str) -> list[Row]:
    """Return the lines of both gears together: data, depths, backlash, spiral angles, contact ratios."""
    spirals = blanks.wheel.spiral_angles if blanks.cutter_radius else (blanks.spiral_angle,) * 3
    outer, mean = (
        [blanks.backlashes[kind] for kind in kinds]
        for kinds in (("outer_normal", "outer_transverse"), ("mean_normal", "mean_transverse"))
    )
    taper = "given angles" if section.wheel_addendum_angle_deg is not None else blanks.taper
    return [
        ("blank after ISO 23509: data type, taper", data_type, taper),
        ("slots along the face", "constant" if blanks.has_constant_slots else "as the pitch"),
        ("mean working depth h_mw, whole depth h_m [mm]", *_numbers(blanks.working_depth, blanks.whole_depth)),
        ("clearance c, normal to the cones [mm]", *_numbers(blanks.clearance)),
        ("cutter radius r_c0 [mm]", f"{blanks.cutter_radius:.4f}" if blanks.cutter_radius else "none"),
        ("flanks along the face", section.lengthwise_curve.replace("_", " ") if blanks.spiral_angle else "straight"),
        ("cutter's spiral angle at heel, mean, toe [deg]", *_numbers(*map(degrees, spirals[::-1]))),
        (
            "backlash j_en, j_et2 at the heel [mm]",
            *_numbers(*outer),
        ),
        ("backlash j_mn, j_mt2 at R_m [mm]", *_numbers(*mean)),
        ("contact ratios eps_va, eps_vb by 0.85 b", *_numbers(*blanks.virtual_contact_ratios)),
    ]


def blank_rows(blanks: BevelBlank) -> list[Row]:
    """Return the lines of each gear: diameters and depths at heel, mean and toe, cones with apexes, thicknesses."""
    gears = blanks.pinion, blanks.wheel

    def along(label: str, name: str) -> list[Row]:
        first, second = (getattr(gear, name) for gear in gears)
        places = reversed(list(zip(SECTIONS, first, second, strict=True)))
        return [(f"{label}, {place} [mm]", *_numbers(pinion, wheel)) for place, pinion, wheel in places]

    def both(label: str, *values: float) -> Row:
        return (label, *_numbers(*values))

    clearances = dict(zip(SECTIONS, zip(*blanks.clearances, strict=True), strict=True))
    return [
        *along("pitch diameter d", "pitch_diameters"),
        *along("addendum h_a", "addenda"),
        *along("dedendum h_f", "dedenda"),
        *(both(f"clearance above the root, {place} [mm]", *clearances[place]) for place in SECTIONS[::-1]),
        *along("tip diameter d_a", "tip_diameters"),
        *along("root diameter d_f", "root_diameters"),
        both("whole depth at the heel, normal to the root cone [mm]", *(gear.outer_whole_depth for gear in gears)),
        *along("crown to crossing point t_x", "crown_to_crossing"),
        both("mean point to crossing point t_zm [mm]", *(gear.mean_point_to_crossing for gear in gears)),
        both("addendum angle theta_a [deg]", *(degrees(gear.addendum_angle) for gear in gears)),
        both("dedendum angle theta_f [deg]", *(degrees(gear.dedendum_angle) for gear in gears)),
        both("face angle delta_a of the cone itself [deg]", *(degrees(gear.face_angle) for gear in gears)),
        both("  its apex t_zF beyond the crossing point [mm]", *(gear.face_apex for gear in gears)),
        both("root angle delta_f of the cone itself [deg]", *(degrees(gear.root_angle) for gear in gears)),
        both("  its apex t_zR beyond the crossing point [mm]", *(gear.root_apex for gear in gears)),
        both("mean normal thickness s_mn [mm]", *(gear.mean_normal_thickness for gear in gears)),
        both("  coefficient x_sm, backlash in it", *(gear.thickness_coefficient for gear in gears)),
        both("  its chord s_mnc [mm]", *(gear.chordal_thickness for gear in gears)),
        both("  addendum above it h_amc [mm]", *(gear.chordal_addendum for gear in gears)),
        *along("normal thickness s_n", "normal_thicknesses"),
        *along("top land s_an", "tip_thicknesses"),
        *along("slot width W", "slot_widths"),
        both("largest edge radius of blades, by the slot [mm]", *(gear.edge_radius_of_slot for gear in gears)),
        both(
            "  by the mating tip in the clearance [mm]",
            *(gear.edge_radius_of_clearance(min(c)) for gear, c in zip(gears, blanks.clearances, strict=True)),
        ),
        both("profile shift x_hm", *(gear.profile_shift for gear in gears)),
        both("  least without undercut", *(gear.smallest_profile_shift for gear in gears)),
    ]


def _numbers(*values: float) -> tuple[str, ...]:
    return tuple(f"{round(value, 4) + 0.0:.4f}" for value in values)
