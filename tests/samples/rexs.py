"""REXS models that the tests share: one made for them, and what is needed of two public ones.

The numbers of the public models are those of "SEW_3-stage_cylindrical_gearbox_1.0.rexs" and
"FVA_Planetary_stage_-_Minus_gearing_1.1.rexs" in fva-net/rexs-api-java (Apache-2.0); the files themselves are not here.
"""

import io
import json
import zipfile
from dataclasses import replace
from pathlib import Path

from loaded_tca.exchange import Attribute, Component, Model, read_rexs
from loaded_tca.exchange.model import Relation

EXAMPLE = Path(__file__).parents[2] / "examples" / "models" / "two_stage_gearbox.rexs"
RIGID = 9.999999999999999e22


def example() -> Model:
    return read_rexs(EXAMPLE)


def changed(model=None, attributes=None, more=(), relations=(), without=(), version=None) -> Model:
    """Model with other attributes, "ID.name" -> (value, unit) or None, more parts, and without relations of a type."""
    model = example() if model is None else model
    components = {**model.components, **{one.id: one for one in more}}
    for path, value in (attributes or {}).items():
        one, name = path.split(".")
        own = {key: each for key, each in components[one].attributes.items() if key != name}
        if value is not None:
            own[name] = Attribute(*value)
        components[one] = replace(components[one], attributes=own)
    kept = tuple(one for one in model.relations if one.type not in without)
    return replace(model, components=components, relations=(*kept, *relations), version=version or model.version)


def part(number, kind, name="", **attributes) -> Component:
    """Component; an attribute is (value, unit), or a number or text without one."""
    own = {key: Attribute(*value) if _has_unit(value) else Attribute(value) for key, value in attributes.items()}
    return Component(str(number), kind, name, own)


def _has_unit(value):
    return isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str)


def relation(kind, order=0, **roles) -> Relation:
    return Relation(kind, {role: str(one) for role, one in roles.items()}, order)


def as_json(model: Model) -> bytes:
    """Content of a file in JSON."""

    def listed(attributes):
        return [{"id": name, "unit": one.unit, **_value(one.value)} for name, one in attributes.items()]

    content = {
        "version": model.version,
        "relations": [
            {
                "id": n,
                "type": one.type,
                **({"order": one.order} if one.order else {}),
                "refs": [{"id": int(of), "role": role} for role, of in one.roles.items()],
            }
            for n, one in enumerate(model.relations)
        ],
        "components": [
            {"id": int(one.id), "type": one.type, "name": one.name or None, "attributes": listed(one.attributes)}
            for one in model.components.values()
        ],
        "load_spectrum": {
            "id": 1,
            "load_cases": [
                {
                    "id": int(case.id),
                    "components": [{"id": int(of), "attributes": listed(a)} for of, a in case.components.items()],
                }
                for case in model.load_cases
            ],
        },
    }
    return json.dumps({"model": content}).encode()


def _value(value):
    if isinstance(value, tuple):
        return {"floating_point_array": [float(one) for one in value]}
    if value in ("true", "false"):
        return {"boolean": value == "true"}
    try:
        return {"floating_point": float(value)}
    except ValueError:
        return {"enum": value}


def as_zip(*files) -> bytes:
    """Content of a zip of (name, content)."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in files:
            archive.writestr(name, content)
    return buffer.getvalue()


def _pose(x, y=0.0, z=0.0):
    return {
        "support_vector": ((x, y, z), "mm"),
        "u_axis_vector": ((1.0, 0.0, 0.0), "mm"),
        "w_axis_vector": ((0.0, 0.0, 1.0), "mm"),
        "reference_component_for_position": 1.0,
    }


ANW = ((40.0, 19.0), (11.5, 22.0), (2.3, 25.0), (1.3, 23.9), (18.9, 25.0), (30.3, 30.0), (15.2, 25.0), (22.5, 22.0))
# id: lower end in space, sections (length, diameter), bearings (id, axial force absorption, place on the shaft)
SEW_SHAFTS = {
    4: (
        (0.0, 0.0, 0.0),
        (*ANW, (4.0, 14.0), (15.9, 10.0), (1.1, 9.6), (1.5, 10.0)),
        ((20, "both_directions", 65.5), (21, "no_direction", 111.8)),
    ),
    5: (
        (137.5, 47.02148907341676, -24.45362069957225),
        ((2.5, 14.8), (10.0, 15.0), (13.5, 16.0), (23.0, 14.0), (10.5, 15.0)),
        ((32, "negative", 6.5), (33, "positive", 54.5)),
    ),
    36: (
        (128.5, 50.33350037591513, 32.45007497243242),
        (
            (7.0, 14.6),
            (14.0, 15.0),
            (52.0, 20.0),
            (5.0, 25.91),
            (41.0, 18.403),
            (9.0, 25.91),
            (12.0, 17.0),
            (3.0, 16.8),
        ),
        ((49, "negative", 13.5), (50, "no_direction", 66.0), (51, "positive", 135.0)),
    ),
    54: (
        (182.7, -19.008575782311063, -1.026431327759056),
        ((4.0, 35.0), (1.6, 33.0), (20.4, 35.0), (39.0, 40.0), (44.0, 39.5), (22.0, 40.0), (19.0, 47.0), (70.0, 35.0)),
        ((66, "no_direction", 16.8), (67, "both_directions", 119.5)),
    ),
}
# id: shaft, teeth, module, helix angle, face width, lower end on the shaft, profile shift
SEW_GEARS = {
    23: (4, 23, 1.0, 30.0, 16.0, 146.0, 0.581),
    34: (5, 67, 1.0, -30.0, 11.0, 13.5, 0.5131),
    38: (5, 13, 1.25, -10.0, 23.0, 26.0, 0.521),
    52: (36, 76, 1.25, 10.0, 15.0, 41.5, -0.094),
    56: (36, 14, 1.5, 10.0, 41.0, 78.0, 0.536),
    69: (54, 87, 1.5, -10.0, 36.0, 26.3, -0.4815),
}
# id: gears, centre distance, angle
SEW_STAGES = {
    6: (23, 34, 53.0, 117.47677801890632),
    37: (38, 52, 57.0, 3.3310739238719993),
    55: (56, 69, 77.0, -115.77001197095069),
}
SEW_TORQUE = 4.724562306435156


def sew(placed=True) -> Model:
    """SEW three-stage gearbox, version 1.0: three stages in a row, catalogue bearings that are rigid."""
    parts = [part(1, "gear_unit"), part(2, "gear_casing")]
    relations = []
    for number, (origin, sections, bearings) in SEW_SHAFTS.items():
        speed = {"rotational_speed": (1400.0, "1 / min")} if number == 4 else {}
        parts.append(part(number, "shaft", **(_pose(*origin) if placed else {}), **speed))
        place = 0.0
        for n, (length, diameter) in enumerate(sections):
            ends = {f"outer_diameter_{end}": (diameter, "mm") for end in ("begin", "end")}
            own = part(
                1000 * number + n, "shaft_section", u_coordinate_on_shaft=(place, "mm"), length=(length, "mm"), **ends
            )
            parts.append(own)
            relations.append(relation("assembly", assembly=number, part=own.id))
            place += length
        for one, holds, at in bearings:
            parts.append(
                part(
                    one,
                    "rolling_bearing_with_catalog_geometry",
                    u_coordinate_on_shaft_inner_side=(at, "mm"),
                    radial_stiffness=(RIGID, "N / m"),
                    axial_stiffness=(0.0, "N / m"),
                    bending_stiffness=(0.0, "N mm / rad"),
                    axial_force_absorption=holds,
                    bearing_type="radial_grooved_ball_bearing",
                )
            )
            relations.append(relation("side", assembly=one, inner_part=number, outer_part=2))
    for number, (shaft, teeth, module, helix, width, low, shift) in SEW_GEARS.items():
        x, y, z = SEW_SHAFTS[shaft][0]
        parts.append(
            part(
                number,
                "cylindrical_gear",
                number_of_teeth=float(teeth),
                normal_module=(module, "mm"),
                helix_angle_reference_diameter=(helix, "°"),
                face_width=(width, "mm"),
                u_coordinate_on_shaft=(low, "mm"),
                **(_pose(x + low + 0.5 * width, y, z) if placed else {}),
            )
        )
        flank = part(
            300 + number, "flank_geometry", normal_pressure_angle=(20.0, "°"), addendum_modification_coefficient=shift
        )
        parts.append(flank)
        relations.append(relation("assembly", assembly=shaft, part=number))
        relations.append(relation("flank", gear=number, left=flank.id, right=flank.id))
    for number, (first, second, distance, angle) in SEW_STAGES.items():
        at = {"center_distance": (distance, "mm"), "rotating_angle_around_neg_u_axis": (angle, "°")}
        parts.append(part(number, "cylindrical_stage", f"Stirnradstufe [{number}]", **at))
        relations.append(relation("stage", stage=number, gear_1=first, gear_2=second))
    torque = {"torque_around_u_axis": (SEW_TORQUE, "N m")}
    parts.append(part(22, "external_load", u_coordinate_on_shaft=(20.0, "mm"), transmits_torque="true", **torque))
    parts.append(part(68, "external_load", u_coordinate_on_shaft=(185.0, "mm"), transmits_torque="true"))
    relations += [relation("assembly", assembly=4, part=22), relation("assembly", assembly=54, part=68)]
    return Model("1.0", {one.id: one for one in parts}, tuple(relations), (), "sew.rexs")


def planetary(version="1.1", modified=False) -> Model:
    """FVA planetary stage, 17/22/61 with three planets: sun, planets and ring with their shafts.

    With modifications it has those of the file of version 1.4 on the flanks of the sun.
    """
    flank_kind = "cylindrical_gear_flank" if version >= "1.3" else "flank_geometry"
    parts = [part(1, "gear_unit"), part(2, "gear_casing"), part(9, "planetary_stage"), part(3, "planet_carrier")]
    steel = {"elastic_modulus": (210000.0, "N / mm^2"), "poisson_ratio": 0.3, "density": (7.85, "kg / dm^3")}
    parts += [part(86, "material", **steel), part(88, "material", **steel)]
    parts.append(part(83, "rack_shaped_tool", addendum_coefficient_reference_profile=1.25, tip_radius_factor=0.25))
    parts.append(
        part(
            85,
            "cutter_wheel_tool",
            number_of_teeth=23.0,
            addendum_coefficient_reference_profile=1.25,
            tip_radius_factor=0.0,
        )
    )
    relations = []

    def shaft(number, origin, length, outer, inner, **more):
        parts.append(part(number, "shaft", **_pose(*origin), **more))
        ends = {
            f"{side}_diameter_{end}": (d, "mm")
            for side, d in (("outer", outer), ("inner", inner))
            for end in ("begin", "end")
        }
        parts.append(
            part(1000 + number, "shaft_section", u_coordinate_on_shaft=(0.0, "mm"), length=(length, "mm"), **ends)
        )
        relations.append(relation("assembly", assembly=number, part=1000 + number))

    def gear(number, kind, teeth, on, origin, shift, material, tool):
        parts.append(
            part(
                number,
                kind,
                number_of_teeth=float(teeth),
                normal_module=(4.0, "mm"),
                helix_angle_reference_diameter=(0.0, "°"),
                face_width=(50.0, "mm"),
                u_coordinate_on_shaft=(25.0, "mm"),
                **_pose(*origin),
            )
        )
        relations.append(relation("assembly", assembly=on, part=number))
        relations.append(relation("reference", origin=number, referenced=material))
        flanks = [10 * number, 10 * number + 1]
        for one in flanks:
            own = {} if shift is None else {"addendum_modification_coefficient": shift}
            parts.append(part(one, flank_kind, normal_pressure_angle=(20.0, "°"), **own))
        relations.extend(_cut(version, number, flanks, tool))
        relations.append(relation("flank", gear=number, left=flanks[0], right=flanks[1]))

    shaft(34, (100.0,), 150.0, 34.0, 0.0, rotational_speed=(1500.0, "1 / min"))
    gear(53, "cylindrical_gear", 17, 34, (125.0,), None, 86, 83)
    shaft(62, (100.0,), 50.0, 280.0, 265.0)
    gear(58, "ring_gear", 61, 62, (125.0,), None, 88, 85)
    parts.append(part(65, "switchable_coupling"))
    relations.append(relation("side", assembly=65, inner_part=62, outer_part=2))
    bearing = {
        "radial_stiffness": (1e20, "N / m"),
        "axial_stiffness": (1e20, "N / m"),
        "bending_stiffness": (0.0, "N mm / rad"),
    }
    for number, at, holds in ((36, 75.0, "both_directions"), (37, 127.5, "no_direction")):
        parts.append(
            part(
                number,
                "concept_bearing",
                u_coordinate_on_shaft_inner_side=(at, "mm"),
                axial_force_absorption=holds,
                **bearing,
            )
        )
        relations.append(relation("side", assembly=number, inner_part=34, outer_part=2))
    places = ((0.0, 78.0), (67.54998149518622, -39.0), (-67.54998149518622, -39.0))
    for n, (y, z) in enumerate(places):
        shaft(229 + n, (100.0, y, z), 50.0, 58.0, 57.0)
        gear(247 + n, "cylindrical_gear", 22, 229 + n, (125.0, y, z), 0.0, 86, 83)
        shaft(235 + n, (92.0, y, z), 66.0, 43.2, 0.0)
        relations.append(relation("assembly", assembly=3, part=235 + n))
        for number, at, holds in ((232 + n, 12.5, "both_directions"), (244 + n, 37.5, "no_direction")):
            place = {
                "u_coordinate_on_shaft_inner_side": (at + 8.0, "mm"),
                "u_coordinate_on_shaft_outer_side": (at, "mm"),
            }
            parts.append(part(number, "concept_bearing", axial_force_absorption=holds, **place, **bearing))
            relations.append(relation("side", assembly=number, inner_part=235 + n, outer_part=229 + n))
        for number, gears in ((211 + n, (53, 247 + n)), (220 + n, (247 + n, 58))):
            parts.append(part(number, "cylindrical_stage", center_distance=(78.0, "mm")))
            relations.append(relation("stage", stage=number, gear_1=gears[0], gear_2=gears[1]))
            relations.append(relation("assembly", assembly=9, part=number))
    parts.append(
        part(
            38,
            "external_load",
            u_coordinate_on_shaft=(150.0, "mm"),
            transmits_torque="true",
            torque_around_u_axis=(1591.5494309189535, "N m"),
        )
    )
    relations.append(relation("assembly", assembly=34, part=38))
    if modified:
        _modify_sun(parts, relations)
    return Model(version, {one.id: one for one in parts}, tuple(relations), (), "planetary.rexs")


def _cut(version, gear, flanks, tool):
    """Relations of a tool: to the gear in the first versions, to its flanks since 1.3."""
    if version < "1.3":
        return [relation("ordered_reference", 1, origin=gear, referenced=tool)]
    return [relation("manufacturing_step", 1, workpiece=one, tool=tool) for one in flanks]


def _modify_sun(parts, relations):
    """Add the modifications of the sun in the file of version 1.4, of both its flanks."""
    amounts = {f"helix_crowning_amount_{face}": (0.005, "mm") for face in ("datum_face", "non_datum_face")}
    at = {
        f"coordinate_where_helix_crowning_is_specified_{face}": (25.0, "mm")
        for face in ("datum_face", "non_datum_face")
    }
    parts.append(part(340, "helix_crowning", **amounts, **at))
    profile = {
        "profile_crowning_at_tip": (0.005, "mm"),
        "diameter_where_profile_crowning_tip_is_specified": (76.0, "mm"),
        "profile_crowning_at_root": (0.005, "mm"),
        "diameter_where_profile_crowning_root_is_specified": (64.06386045216821, "mm"),
    }
    parts.append(part(341, "profile_crowning", **profile))
    ends = {"helix_evaluation_start": (-25.0, "mm"), "helix_evaluation_end": (25.0, "mm")}
    parts.append(part(342, "helix_slope", helix_slope=(0.006, "mm"), **ends))
    parts.append(part(343, "helix_slope", helix_slope=(-0.006, "mm"), **ends))
    for flank, slope in ((530, 342), (531, 343)):
        relations += [relation("reference", origin=flank, referenced=one) for one in (340, 341, slope)]
