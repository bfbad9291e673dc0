"""Rolling bearings of REXS models by their inner geometry."""

from __future__ import annotations

import pytest
from numpy.testing import assert_allclose

from loaded_tca.exchange import import_stage
from loaded_tca.loaded.shaft_lines import shaft_lines
from tests.samples.rexs import changed, example, part, relation

ROW = {
    "number_of_rolling_elements": 9.0,
    "reference_diameter": (60.0, "mm"),
    "pressure_angle": (0.0, "deg"),
    "raceway_radius_of_inner_ring": (6.18, "mm"),
    "raceway_radius_of_outer_ring": (6.36, "mm"),
}
BALL = {"diameter_of_rolling_element": (12.0, "mm")}
ROLLERS = {
    "number_of_rolling_elements": 14.0,
    "reference_diameter": (60.0, "mm"),
    "significant_contact_length_inner_ring": (9.5, "mm"),
    "significant_contact_length_outer_ring": (9.8, "mm"),
}
ROLLER = {"diameter_of_rolling_element": (10.0, "mm"), "length_of_rolling_element": (10.0, "mm")}


def model(
    rows=((ROW, BALL),), kind="radial_grooved_ball_bearing", at=30.0, base=None, numbers=(191, 200), on=3, **more
):
    """The example with a rolling bearing instead of concept bearing 91 (at u = 30 mm of the input shaft)."""
    number, first = numbers
    base = example() if base is None else base
    own = {"bearing_type": kind, "u_coordinate_on_shaft_inner_side": (at, "mm"), **more}
    parts = [part(number, "rolling_bearing_with_detailed_geometry", "6208", **own)]
    relations = [relation("side", assembly=number, inner_part=on, outer_part=2)]
    for n, (row, element) in enumerate(rows):
        parts += [
            part(first + 2 * n, "rolling_bearing_row", **row),
            part(first + 2 * n + 1, "rolling_element", **element),
        ]
        relations.append(relation("ordered_assembly", n + 1, assembly=number, part=first + 2 * n))
        relations.append(relation("ordered_assembly", 1, assembly=first + 2 * n, part=first + 2 * n + 1))
    sides = [one for one in base.relations if one.type == "side" and one.roles["assembly"] != "91"]
    return changed(base, more=parts, without=["side"], relations=[*sides, *relations])


def bearing(*args, stage="10", gear="pinion", **more):
    return getattr(import_stage(model(*args, **more), stage).scene, gear).shaft.bearings[0]


def test_a_deep_groove_ball_bearing_has_its_balls() -> None:
    one = bearing(operating_radial_bearing_clearance=(8.0, "mum"), radial_dynamic_load_rating=(32.5, "kN"))
    assert (one.at_mm, one.type, one.balls, one.ball_diameter_mm, one.pitch_diameter_mm) == (
        -75.0,
        "ball",
        9,
        12.0,
        60.0,
    )
    assert (one.inner_groove_ratio, one.outer_groove_ratio) == (0.515, 0.53)
    assert (one.radial_clearance_um, one.dynamic_load_rating_N) == (8.0, 32500.0)
    assert one.contact_angle_deg is None
    assert one.radial_stiffness_N_per_um is None


@pytest.mark.parametrize("kind", ["radial_roller_bearing", "radial_needle_roller_bearing"])
def test_a_roller_bearing_has_the_length_that_touches(kind: str) -> None:
    """Together with a concept bearing that takes the thrust."""
    base = changed(
        attributes={"92.axial_stiffness": ("1e8", "N / m"), "92.axial_force_absorption": ("both_directions", "none")}
    )
    one = bearing([(ROLLERS, ROLLER)], kind, base=base)
    assert (one.type, one.rollers, one.roller_diameter_mm, one.roller_length_mm) == ("roller", 14, 10.0, 9.5)
    free = {name: value for name, value in ROLLERS.items() if not name.startswith("significant")}
    assert bearing([(free, ROLLER)], kind, base=base).roller_length_mm == 10.0


@pytest.mark.parametrize(("absorption", "side"), [("positive", 1), ("negative", -1)])
def test_a_contact_angle_takes_thrust_one_way(absorption: str, side: int) -> None:
    """On the output shaft, whose u points against z, the sides are turned."""
    row = {**ROW, "pressure_angle": (25.0, "deg"), "axial_force_absorption_of_row": absorption}
    kind = "angular_contact_ball_bearing"
    one = next(
        b for b in import_stage(model([(row, BALL)], kind), "10").table["pinion"]["shaft"]["bearings"] if "type" in b
    )
    assert (one["contact_angle_deg"], one["side"]) == (25.0, side)
    turned = model([(row, BALL)], kind, on=5, at=200.0)
    bearings = import_stage(turned, "11").table["wheel"]["shaft"]["bearings"]
    assert next(one for one in bearings if "type" in one)["side"] == -side


def test_two_rows_are_two_bearings_beside_each_other() -> None:
    """In an O arrangement on the output shaft, whose u points against z: the first row is at the larger z."""
    rows = [
        ({**ROW, "pressure_angle": (25.0, "deg"), "axial_force_absorption_of_row": side}, BALL)
        for side in ("positive", "negative")
    ]
    whole = {"distance_between_bearing_rows": (16.0, "mm"), "radial_dynamic_load_rating": (60.0, "kN")}
    double = model(rows, "angular_contact_ball_bearing", on=5, at=200.0, **whole)
    first, second = import_stage(double, "11").table["wheel"]["shaft"]["bearings"][:2]
    assert (first["at_mm"], first["side"]) == (110.0 - 208.0, 1)
    assert (second["at_mm"], second["side"]) == (110.0 - 192.0, -1)
    assert not {"dynamic_load_rating_N"} & {*first, *second}  # that of the file is of both rows together


def test_elements_are_counted_where_the_row_does_not_say() -> None:
    row = {name: value for name, value in ROW.items() if name != "number_of_rolling_elements"}
    base = model([(row, BALL)])
    more = [part(300 + n, "rolling_element", **BALL) for n in range(6)]
    elements = [relation("ordered_assembly", n + 2, assembly=200, part=300 + n) for n in range(6)]
    scene = import_stage(changed(base, more=more, relations=elements), "10").scene
    assert scene.pinion.shaft.bearings[0].balls == 7


def test_names_of_version_1_0_are_known() -> None:
    old = {
        "number_of_rolling_elements": 9.0,
        "reference_diameter": (60.0, "mm"),
        "running_path_radius_of_inner_ring": (6.18, "mm"),
        "running_path_radius_of_outer_ring": (6.36, "mm"),
    }
    one = bearing([(old, BALL)], radial_backlash=(5.0, "mum"), dynamic_capacity=(30.0, "kN"))
    assert (one.inner_groove_ratio, one.radial_clearance_um, one.dynamic_load_rating_N) == (0.515, 5.0, 30000.0)


def test_a_stated_stiffness_goes_before_the_geometry_and_a_rigid_one_does_not() -> None:
    stated = bearing(radial_stiffness=(3e8, "N / m"), axial_stiffness=(1e8, "N / m"))
    assert (stated.type, stated.radial_stiffness_N_per_um) == (None, 300.0)
    rigid = import_stage(model(radial_stiffness=(1e23, "N / m"), axial_stiffness=(0.0, "N / m")), "10")
    assert rigid.scene.pinion.shaft.bearings[0].type == "ball"
    assert "rolling_bearing_with_detailed_geometry 191: its stiffness follows from its inner geometry" in rigid.read_as


INCOMPLETE = {
    "another kind": ([(ROW, BALL)], "radial_self_aligning_ball_bearing"),
    "no pitch circle": (
        [({k: v for k, v in ROW.items() if k != "reference_diameter"}, BALL)],
        "radial_grooved_ball_bearing",
    ),
    "no diameter": ([(ROW, {})], "radial_grooved_ball_bearing"),
    "no length": ([({k: v for k, v in ROLLERS.items() if "length" not in k}, BALL)], "radial_roller_bearing"),
    "no side": ([({**ROW, "pressure_angle": (25.0, "deg")}, BALL)], "angular_contact_ball_bearing"),
    "three rows": ([(ROW, BALL)] * 3, "radial_grooved_ball_bearing"),
    "rows at one place": ([(ROW, BALL)] * 2, "radial_grooved_ball_bearing"),
    "no rows": ([], "radial_grooved_ball_bearing"),
}


@pytest.mark.parametrize(("rows", "kind"), INCOMPLETE.values(), ids=INCOMPLETE)
def test_half_a_geometry_leaves_the_shaft_out(rows: list, kind: str) -> None:
    imported = import_stage(model(rows, kind), "10")
    assert imported.scene.pinion.shaft is None
    what = 'neither stiffness nor inner geometry of rolling_bearing_with_detailed_geometry 191 "6208"'
    assert any(one.startswith("shaft 3") and what in one for one in imported.not_taken)


def test_balls_that_would_touch_are_refused_with_their_bearing() -> None:
    imported = import_stage(model([(ROW, {"diameter_of_rolling_element": (25.0, "mm")})]), "10")
    assert imported.scene.pinion.shaft is None
    assert any("would touch" in one for one in imported.not_taken)


def test_a_shaft_on_its_rolling_bearing_carries_the_same_forces() -> None:
    """Forces on the bearings are in balance with the teeth, whatever the bearings are."""
    on_rolling, linear = (
        next(one for one in shaft_lines(import_stage(one, "10").scene) if one.gear == "pinion")
        for one in (model(), example())
    )
    # teeth touch elsewhere on a shaft that tilts: the normal leans by parts of a thousandth
    assert_allclose(on_rolling.bearing_forces[:, :3].sum(axis=0), linear.bearing_forces[:, :3].sum(axis=0), rtol=5e-3)
