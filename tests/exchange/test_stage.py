"""Gears, flanks, tools and materials of a REXS stage; what is missing or contradicts itself; what is reported."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.exchange import import_stage
from loaded_tca.scene import parse_scene, read_scene
from tests.samples.rexs import changed, example, part, planetary, relation

ROUNDING = 1e-12  # of a few products and sums of lengths of 100 mm


def scene_of(attributes=None, stage="10", **more):
    return import_stage(changed(attributes=attributes, **more), stage).scene


def test_the_scene_file_is_read_again(tmp_path) -> None:
    imported = import_stage(example(), "10")
    file = tmp_path / "scene.toml"
    file.write_text(imported.to_toml(), encoding="utf-8")
    assert read_scene(file) == imported.scene


def test_geometry_of_the_example_is_that_of_closed_forms() -> None:
    """21/55, m 2.5, 12 deg, a 98, x1 0.25: the other profile shift leaves no backlash."""
    mesh = scene_of().mesh()
    helix = math.radians(12.0)
    transverse = math.atan(math.tan(math.radians(20.0)) / math.cos(helix))
    pitch = [2.5 * z / math.cos(helix) for z in (21, 55)]
    working = math.acos(0.5 * sum(pitch) * math.cos(transverse) / 98.0)
    assert_allclose(mesh.working_pressure_angle, working, rtol=1e-9)
    shift_sum = 76.0 * ((math.tan(working) - working) - (math.tan(transverse) - transverse))
    shift_sum /= 2.0 * math.tan(math.radians(20.0))
    assert_allclose(mesh.wheel.profile_shift, shift_sum - 0.25, rtol=1e-9)
    assert_allclose(2.0 * mesh.pinion.tip_radius, pitch[0] + 5.0 * 1.25, rtol=1e-9)
    assert_allclose(2.0 * mesh.pinion.root_radius, pitch[0] - 5.0 * (1.4 - 0.25), rtol=1e-9)  # the tool's addendum: 1.4


def test_tip_diameters_of_files_are_taken() -> None:
    assert_allclose(2.0 * scene_of(stage="11").mesh().wheel.tip_radius, 224.0, rtol=ROUNDING)


def test_addendum_of_the_basic_profile_lengthens_the_teeth() -> None:
    scene = scene_of(
        {"41.addendum_coefficient_basic_profile": (1.1, "none"), "42.addendum_coefficient_basic_profile": (1.1, "none")}
    )
    d = 2.5 * 21 / math.cos(math.radians(12.0))
    assert_allclose(2.0 * scene.mesh().pinion.tip_radius, d + 5.0 * (1.1 + 0.25), rtol=1e-9)


def test_profile_shift_in_mm_is_over_the_module() -> None:
    shift = {f"{n}.addendum_modification_coefficient": None for n in (41, 42)}
    shift |= {f"{n}.addendum_modification": (0.5, "mm") for n in (41, 42)}
    assert scene_of(shift).pinion.profile_shift == pytest.approx(0.2)


def test_finished_teeth_are_thinner_by_their_profile_shift() -> None:
    finished = {f"{n}.addendum_modification_coefficient_after_finishing": (0.23, "none") for n in (41, 42)}
    scene = scene_of(finished)
    expected = 2.0 * 2.5 * math.tan(math.radians(20.0)) * (0.23 - 0.25) * 1e3
    assert scene.pinion.thickness_allowance_um == pytest.approx(expected, abs=1e-6)
    assert_allclose(scene.mesh().pinion.generating_profile_shift, 0.23, rtol=1e-6)


def test_tip_radius_of_the_tool_in_mm_is_over_the_module() -> None:
    scene = scene_of({"51.tip_radius_factor": None, "51.tip_radius": (0.5, "mm")})
    assert scene.geometry.root_radius_coefficient == pytest.approx(0.2)


def test_tools_of_both_gears_may_differ() -> None:
    model = example()
    steps = [
        one
        for one in model.relations
        if one.type == "manufacturing_step" and one.roles["workpiece"] not in ("43", "44")
    ]
    other = [relation("manufacturing_step", 1, workpiece=flank, tool=52) for flank in (43, 44)]
    imported = import_stage(changed(model, without=["manufacturing_step"], relations=[*steps, *other]), "10")
    assert imported.scene.geometry.dedendum_coefficient == 1.4
    tool = model.components["52"]
    assert imported.scene.mesh().wheel.dedendum_coefficient == tool.number("addendum_coefficient_reference_profile")
    assert imported.scene.pinion.dedendum_coefficient is None
    assert not any("rack_shaped_tool 52" in one and "profile" in one for one in imported.not_taken)


TOOL = {"addendum_coefficient_reference_profile": 1.3, "tip_radius_factor": 0.2}


@pytest.mark.parametrize("lacking", [["tip_radius_factor"], [*TOOL], None], ids=["tip radius", "both", "tool"])
def test_wheel_has_its_tool_where_that_of_the_pinion_says_less(lacking) -> None:
    """The pinion has what it lacks of the tool of the wheel, and the list says so."""
    model = example()
    pinion, wheel = ("41", "42"), ("43", "44")
    steps = [
        one
        for one in model.relations
        if one.type == "manufacturing_step" and one.roles["workpiece"] not in (wheel if lacking else pinion + wheel)
    ]
    other = [relation("manufacturing_step", 1, workpiece=int(flank), tool=52) for flank in wheel]
    attributes = {f"52.{name}": (value, "none") for name, value in TOOL.items()}
    attributes |= {f"51.{name}": None for name in lacking or ()}
    model = changed(model, attributes=attributes, without=["manufacturing_step"], relations=[*steps, *other])
    imported = import_stage(model, "10")
    mesh = imported.scene.mesh()
    assert (mesh.wheel.dedendum_coefficient, mesh.wheel.root_radius_coefficient) == (1.3, 0.2)
    assert mesh.pinion.dedendum_coefficient == (1.4 if lacking == ["tip_radius_factor"] else 1.3)
    assert mesh.pinion.root_radius_coefficient == 0.2
    notes = [one for one in imported.read_as if one.startswith("cylindrical_gear 21: no tool with ")]
    assert len(notes) == len(lacking or TOOL)
    assert notes[-1].endswith(
        "no tool with tip_radius_factor; root_radius_coefficient 0.2 is taken from the tool of the other gear"
    )


def test_grinding_after_hobbing_leaves_the_second_tool() -> None:
    grinding = [relation("manufacturing_step", 2, workpiece=flank, tool=52) for flank in (41, 42)]
    imported = import_stage(changed(relations=grinding), "10")
    assert imported.scene.geometry.dedendum_coefficient == 1.4
    assert any("rack_shaped_tool 52" in one and "a further tool" in one for one in imported.not_taken)


def test_stages_without_tools_have_the_basic_rack() -> None:
    scene = scene_of(without=["manufacturing_step"])
    assert (scene.geometry.dedendum_coefficient, scene.geometry.root_radius_coefficient) == (1.25, 0.38)


def test_pressure_angle_of_the_tool_holds_where_flanks_have_none() -> None:
    flanks = {f"{n}.normal_pressure_angle": None for n in range(41, 45)}
    assert scene_of(flanks | {"51.normal_pressure_angle": (22.5, "deg")}).geometry.pressure_angle_deg == 22.5


def test_materials_that_differ_are_those_of_the_gears() -> None:
    model = example()
    others = [one for one in model.relations if one.type == "reference" and one.roles["origin"] != "22"]
    bronze = part(71, "material", elastic_modulus=(115000.0, "MPa"), poisson_ratio=0.34)
    model = changed(
        model,
        more=[bronze],
        without=["reference"],
        relations=[*others, relation("reference", origin=22, referenced=71)],
    )
    scene = import_stage(model, "10").scene
    assert scene.material is None
    assert [(one.youngs_modulus_MPa, one.poisson_ratio) for one in scene.materials] == [
        (206000.0, 0.3),
        (115000.0, 0.34),
    ]


def test_half_a_material_is_steel_and_named() -> None:
    imported = import_stage(changed(attributes={"70.poisson_ratio": None}), "10")
    assert imported.scene.material.youngs_modulus_MPa == 206000.0
    assert any(
        "material 70" in one and "not both elastic_modulus and poisson_ratio" in one for one in imported.not_taken
    )
    assert (
        "cylindrical_gear 21: no material with elastic constants; it is steel, E 206000 MPa, nu 0.3" in imported.read_as
    )


def test_centre_distance_by_the_places_of_the_gears() -> None:
    imported = import_stage(changed(attributes={"10.center_distance": None}), "10")
    assert imported.scene.geometry.centre_distance_mm == 98.0
    assert any("no center_distance; taken from the places" in one for one in imported.read_as)
    imported = import_stage(changed(attributes={"10.center_distance": (98.4, "mm")}), "10")
    assert imported.scene.geometry.centre_distance_mm == 98.4
    assert any("center_distance is taken; the gears are placed 98 mm apart" in one for one in imported.read_as)


def test_the_gear_with_fewer_teeth_is_the_pinion() -> None:
    """A stage that speeds up: gear_1 drives and has more teeth."""
    model = example()
    stages = [one for one in model.relations if one.type == "stage" and one.roles["stage"] != "10"]
    turned = relation("stage", stage=10, gear_1=22, gear_2=21)
    imported = import_stage(changed(model, without=["stage"], relations=[*stages, turned]), "10")
    assert imported.scene == import_stage(model, "10").scene


def test_bores_of_gears_are_their_inner_diameters_or_the_shaft() -> None:
    assert scene_of().wheel.bore_diameter_mm == 50.0  # of the gear
    scene = scene_of({"22.inner_diameter": None})
    assert scene.wheel.bore_diameter_mm == 50.0  # of the shaft below it
    assert scene.pinion.bore_diameter_mm is None  # 40 of 46 mm: the pinion is cut into its shaft


@pytest.mark.parametrize("torque", [0.0, math.nan, math.inf])
def test_a_torque_of_nothing_is_refused(torque) -> None:
    with pytest.raises(InputError, match=f"torque_Nm: found {torque}; allowed other than 0"):
        import_stage(example(), "10", torque_Nm=torque)


def test_a_stated_loaded_flank_tells_the_side_without_torque() -> None:
    silent = {"97.torque_around_u_axis": None, "3.rotational_speed": None}
    for flank, sense in (("right", "positive"), ("left", "negative")):
        model = changed(attributes=silent | {"31.loaded_tooth_flank": (flank, "none")})
        scene = import_stage(model, "10", torque_Nm=100.0).scene
        assert (scene.sense, scene.driving) == (sense, "pinion")
    assumed = import_stage(changed(attributes=silent), "10", torque_Nm=100.0)
    assert any("neither torque nor loaded flank has a sign" in one for one in assumed.read_as)


def test_a_loaded_flank_against_the_torque_is_named() -> None:
    imported = import_stage(changed(attributes={"31.loaded_tooth_flank": ("left", "none")}), "10")
    assert any(
        "the file says that the left flank is loaded; the torque would load the right one" in one
        for one in imported.read_as
    )
    assert imported.table["pinion"]["modifications"] == {"lead_crowning_um": 7.0}


def test_a_driving_gear_is_that_of_the_file_without_a_speed() -> None:
    slow = {"3.rotational_speed": None, "31.is_driving_gear": ("false", "none"), "32.is_driving_gear": ("true", "none")}
    scene = scene_of(slow)
    assert (scene.driving, scene.sense) == ("wheel", "negative")  # the same flanks carry: s = +1
    assert scene.operation is None


def test_modifications_of_the_flank_without_load_are_named() -> None:
    """The right flank of pinion 1 is the loaded one; the left one has 7 um of crowning of its own."""
    model = example()
    crowning = "helix_crowning_amount_datum_face 0.007 mm, helix_crowning_amount_non_datum_face 0.007 mm"
    of_flank = "cylindrical_gear_flank 41: modifications of the flank without load, which differ from the loaded one"
    assert f"{of_flank}: helix_crowning ({crowning})" in import_stage(model, "10").not_taken
    others = [one for one in model.relations if one.type == "reference" and one.roles["origin"] != "41"]
    none = import_stage(changed(without=["reference"], relations=others), "10").not_taken
    assert f"{of_flank}: none" in none
    of_right = [one.roles["referenced"] for one in others if one.roles["origin"] == "42"]
    same = [relation("reference", origin=41, referenced=one) for one in of_right]
    alike = import_stage(changed(without=["reference"], relations=[*others, *same]), "10").not_taken
    assert not any(one.startswith(of_flank) for one in alike)


def test_flanks_that_differ_are_named() -> None:
    imported = import_stage(changed(attributes={"41.addendum_modification_coefficient": (0.3, "none")}), "10")
    assert imported.scene.pinion.profile_shift == 0.25
    sentence = "cylindrical_gear_flank 41: the flank without load has another addendum_modification_coefficient"
    assert sentence in imported.not_taken


def test_everything_that_is_not_taken_is_listed_with_id_and_attribute() -> None:
    attributes = {
        "10.mesh_load_factor": (1.1, "none"),
        "91.preload_force": (100, "N"),
        "42.tooth_tip_chamfer": (0.2, "mm"),
    }
    imported = import_stage(changed(attributes=attributes), "10")
    for sentence in (
        'cylindrical_stage 10 "First stage": mesh_load_factor',
        "concept_bearing 91: preload_force",
        "cylindrical_gear_flank 42: tooth_tip_chamfer",
        "profile_twist 64: no modification that a scene has (profile_twist)",
    ):
        assert sentence in imported.not_taken
        assert f"#   {sentence}" in imported.to_toml().splitlines()
        assert f"  {sentence}" in imported.summary().splitlines()
    assert re.search(r"parts of the model beside this stage: .*2 concept_bearing", imported.not_taken[-1])


def test_names_with_line_breaks_stay_within_their_comment() -> None:
    model = example()
    lines = part(21, "cylindrical_gear", "a\nb = 1\r\n[x]")
    named = changed(model, more=[type(lines)("21", lines.type, lines.name, model.components["21"].attributes)])
    imported = import_stage(changed(named, {"21.chamfer_at_tooth_end": (1.0, "mm")}), "10")
    assert parse_scene(imported.to_toml()) == imported.scene


REFUSED = {
    "unknown stage": ({}, "12", "stage 12: not found; allowed 10, 11"),
    "id of a gear": ({}, "21", "stage 21: not found; allowed 10, 11"),
    "modules": ({"22.normal_module": (3.0, "mm")}, "10", "normal_module: found 2.5 and 3 of its gears"),
    "no module": ({"22.normal_module": None}, "10", "cylindrical_gear 22: normal_module: missing; a scene needs it"),
    "helix angles": ({"22.helix_angle_reference_diameter": (-13.0, "deg")}, "10", "found 12 and -13 deg of"),
    "hands": ({"22.helix_angle_reference_diameter": (12.0, "deg")}, "10", "opposite signs: the gears of an external"),
    "no pressure angle": (
        {f"{n}.normal_pressure_angle": None for n in (41, 42, 43, 44, 51)},
        "10",
        "normal_pressure_angle: missing; neither the flanks nor the tools of cylindrical_gear 21 and cylindrical",
    ),
    "pressure angles": (
        {f"{n}.normal_pressure_angle": (17.5, "deg") for n in (43, 44)},
        "10",
        "normal_pressure_angle: found 20 and 17.5 deg",
    ),
    "value beyond a scene": ({"21.face_width": (-3.0, "mm")}, "10", r"stage 10: pinion\.face_width_mm: found -3"),
}


@pytest.mark.parametrize("kind", ["worm", "bevel"])
@pytest.mark.parametrize("beside", ["10, 11", "none, the model has no cylindrical stage of two gears"])
def test_stages_of_other_kinds_are_named_with_what_is_covered(kind: str, beside: str) -> None:
    model = changed(more=[part(90, f"{kind}_stage")])
    if beside.startswith("none"):
        model = replace(model, components={"90": model.components["90"]}, relations=())
    message = rf"^stage 90: {kind} stages are not covered; .* of cylindrical stages .* of two gears: {beside}$"
    with pytest.raises(InputError, match=message):
        import_stage(model, "90")


@pytest.mark.parametrize(("attributes", "stage", "message"), REFUSED.values(), ids=REFUSED)
def test_what_no_scene_can_be_is_refused(attributes: dict, stage: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        import_stage(changed(attributes=attributes), stage)


def test_gears_that_cannot_mesh_are_refused_with_their_stage() -> None:
    with pytest.raises((GeometryError, InputError), match="stage 10: "):
        import_stage(changed(attributes={"10.center_distance": (60.0, "mm")}), "10")


def test_stages_without_gears_are_refused() -> None:
    bare = part(12, "cylindrical_stage")
    with pytest.raises(InputError, match=r"stage 12: its relation has no gear_1 and gear_2; .*: 10, 11"):
        import_stage(changed(more=[bare]), "12")


def test_a_bevel_gear_on_a_shaft_leaves_its_torque_open() -> None:
    bevel = part(99, "bevel_gear")
    model = changed(more=[bevel], relations=[relation("assembly", assembly=3, part=99)])
    with pytest.raises(InputError, match="give --torque"):
        import_stage(model, "10")


def test_hand_of_a_ring_is_that_of_its_planet() -> None:
    helical = {
        f"{gear}.helix_angle_reference_diameter": (angle, "°")
        for gear, angle in ((53, 10.0), (247, -10.0), (58, -10.0))
    }
    others = {f"{gear}.helix_angle_reference_diameter": (-10.0, "°") for gear in (248, 249)}
    distance = {f"{stage}.center_distance": (79.5, "mm") for stage in range(211, 223) if stage not in range(214, 220)}
    scene = import_stage(changed(planetary(), helical | others | distance), "220").scene
    assert scene.hands == ("left", "left")


def test_root_diameter_of_a_gear_whose_tool_has_no_dedendum_is_taken() -> None:
    """Where the tool has one, the root follows from this, as before."""
    root, no_dedendum = {"21.root_diameter": (48.0, "mm")}, {"51.addendum_coefficient_reference_profile": None}
    assert scene_of(root) == scene_of()
    imported = import_stage(changed(attributes=root | no_dedendum), "10")
    assert_allclose(2.0 * imported.scene.mesh().pinion.root_radius, 48.0, rtol=ROUNDING)
    assert not any("21" in one and "root_diameter" in one for one in imported.not_taken)


def test_root_diameter_that_contradicts_the_tool_is_named_with_what_is_taken() -> None:
    """By the tool of pinion 21, h_fP = 1.4: d_f = d - 2 m_n (1.4 - x)."""
    pinion = scene_of().mesh().pinion
    root = 2.0 * pinion.reference_radius - 2.0 * pinion.normal_module * (1.4 - pinion.generating_profile_shift)
    told = f"the addendum of the tool is taken, which cuts a root diameter of {root:.6g} mm; root_diameter, 44 mm, "
    imported = import_stage(changed(attributes={"21.root_diameter": (44.0, "mm")}), "10")
    assert imported.scene == scene_of()
    assert [told in note for note in imported.read_as if "root_diameter" in note] == [True]
    for alike in (root, root + 0.01):
        agrees = import_stage(changed(attributes={"21.root_diameter": (alike, "mm")}), "10")
        assert not any("root_diameter" in note for note in agrees.read_as)


RING_TOOLS = {
    "that of its cutter": ({"85.addendum_coefficient_reference_profile": (1.4, "none")}, 1.4, []),
    "that of the pinion's tool": (
        {"85.addendum_coefficient_reference_profile": None},
        1.25,
        [
            "ring_gear 58: no tool with addendum_coefficient_reference_profile; dedendum_coefficient 1.25 is taken "
            "from the tool of the other gear"
        ],
    ),
    "its root diameter": (
        {"85.addendum_coefficient_reference_profile": None, "58.root_diameter": (-255.0, "mm")},
        None,
        [],
    ),
}


@pytest.mark.parametrize(("attributes", "dedendum", "notes"), RING_TOOLS.values(), ids=RING_TOOLS)
def test_dedendum_of_a_ring(attributes, dedendum, notes) -> None:
    """|d_f| = |d| + 2 m_n (h_fP - x_E), or as the model has it; what is not the ring's is in the list."""
    imported = import_stage(changed(planetary(), attributes), "220")
    ring = imported.scene.mesh().wheel
    expected = 255.0 if dedendum is None else 4.0 * (61 + 2.0 * (dedendum - ring.profile_shift))
    assert_allclose(2.0 * ring.root_radius, expected, rtol=ROUNDING)
    assert [one for one in imported.read_as if "tool" in one] == notes
