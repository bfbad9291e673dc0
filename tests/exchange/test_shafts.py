"""Shafts, bearings and loads of REXS models as sections of a scene."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.exchange import import_stage
from loaded_tca.loaded.shaft_lines import shaft_lines
from tests.samples.rexs import changed, example, part, relation

ROUNDING = 1e-12  # of factors of units, sums of eight lengths, and turns


def bearings(model, gear="pinion", stage="10"):
    return getattr(import_stage(model, stage).scene, gear).shaft.bearings


def test_sections_start_at_the_middle_of_the_face() -> None:
    shaft = import_stage(example(), "10").scene.pinion.shaft
    assert (shaft.start_mm, shaft.torque_at_mm) == (-105.0, -105.0)
    assert [(one.length_mm, one.outer_diameter_mm) for one in shaft.sections] == [(60, 30), (90, 40), (50, 35)]
    assert [one.at_mm for one in shaft.bearings] == [-75.0, 70.0]


def test_a_shaft_that_points_the_other_way_is_turned() -> None:
    """u of the output shaft points against that of the others: its middle is at u = 110 mm of 240 mm."""
    shaft = import_stage(example(), "11").scene.wheel.shaft
    assert (shaft.start_mm, shaft.torque_at_mm) == (-130.0, -130.0)  # the torque leaves at u = 240 mm
    assert [(one.at_mm, one.axial_stiffness_N_per_um) for one in shaft.bearings] == [(-80.0, 200.0), (80.0, 0.0)]


def test_cones_become_cylinders_of_the_same_length() -> None:
    imported = import_stage(example(), "10")
    sections = imported.scene.wheel.shaft.sections
    cone = sections[2:10]
    assert_allclose(sum(one.length_mm for one in cone), 10.0, rtol=ROUNDING)
    assert_allclose([cone[0].outer_diameter_mm, cone[-1].outer_diameter_mm], [50.25, 53.75], rtol=ROUNDING)
    assert "shaft 4: its cones are 8 cylinders each, of the diameters at their middles" in imported.read_as
    backwards = import_stage(changed(attributes={"89.outer_diameter_end": ("64", "mm")}), "11").scene.wheel.shaft
    assert backwards.sections[0].outer_diameter_mm > backwards.sections[-1].outer_diameter_mm


def test_stiffnesses_have_the_units_of_the_scene() -> None:
    first, second = bearings(example(), "wheel")
    assert (first.radial_stiffness_N_per_um, first.axial_stiffness_N_per_um) == (400.0, 150.0)  # of 4e8, 1.5e8 N/m
    assert first.tilting_stiffness_Nm_per_mrad == 20.0  # of 2e7 N mm/rad
    assert (second.radial_stiffness_N_per_um, second.axial_stiffness_N_per_um) == (500.0, 0.0)


def test_rigid_bearings_have_a_stiffness_that_leaves_digits_for_the_shaft() -> None:
    rigid = {f"{one}.radial_stiffness": ("1e23", "N / m") for one in (91, 92)}
    imported = import_stage(changed(attributes=rigid), "10")
    assert imported.scene.pinion.shaft.bearings[0].radial_stiffness_N_per_um == 1e6
    assert "concept_bearing 91: rigid directions have 1000000 N/um, 10000000 N m/mrad" in imported.read_as
    stiffer, softer = (
        shaft_lines(import_stage(changed(attributes=dict.fromkeys(rigid, (v, "N / m"))), "10").scene)[0]
        for v in ("1e23", "1e14")
    )
    # bearings of 1e5 N/um instead of 1e6 move by 0.03 um more, the shaft bends by 15 um
    assert_allclose(stiffer.motions, softer.motions, atol=1e-4)
    assert np.abs(stiffer.motions[:, :2]).max() > 5e-3


def test_bearings_without_thrust_take_none() -> None:
    axial = {"92.axial_stiffness": ("1e8", "N / m")}
    assert [one.axial_stiffness_N_per_um for one in bearings(changed(attributes=axial))] == [100.0, 0.0]
    both = axial | {"92.axial_force_absorption": ("both_directions", "none")}
    assert [one.axial_stiffness_N_per_um for one in bearings(changed(attributes=both))] == [100.0, 100.0]


def test_radial_stiffness_of_a_bearing_that_holds_the_axis_alone_is_none() -> None:
    thrust = {"91.radial_force_absorption": ("false", "none"), "91.bending_stiffness": ("1e9", "N mm / rad")}
    first = bearings(changed(attributes=thrust))[0]
    assert (first.radial_stiffness_N_per_um, first.axial_stiffness_N_per_um) == (0.0, 100.0)


FORCES, MOTIONS = ("f_u", "f_v", "f_w", "m_v", "m_w"), ("d_u", "d_v", "d_w", "rot_v", "rot_w")
OLD = {"d_u": "d_u", "d_v": "d_v", "d_w": "d_w", "rot_v": "d_v_rot", "rot_w": "d_w_rot"}


def operating_point(matrix, old=False, bearing=91):
    """Attributes of the stiffness of a bearing [N/m, N/rad, N, N mm/rad]."""
    attributes = {}
    for n, force in enumerate(FORCES):
        for m, motion in enumerate(MOTIONS):
            name = f"{'dF' if n < 3 else 'dM'}_{force[-1]}_{OLD[motion]}" if old else f"{force}_{motion}"
            unit = [["N / m", "N / rad"], ["N", "N mm / rad"]][n >= 3][m >= 3]
            attributes[f"{bearing}.operating_point_stiffness_{name}"] = (float(matrix[n][m]), unit)
    return attributes


@pytest.mark.parametrize("old", [False, True])
def test_operating_points_are_turned_into_the_frame_of_the_gear(old: bool) -> None:
    """The wheel of stage 10 is at +w of its pinion: x = w, y = -v, z = u."""
    matrix = np.diag([3e8, 1e8, 2e8, 4e7, 5e7])
    matrix[1, 4] = matrix[4, 1] = 6e5  # F_v by the rotation about w: N/rad
    matrix[2, 3] = matrix[3, 2] = -7e5
    rows = np.array(bearings(changed(attributes=operating_point(matrix, old)))[0].stiffness)
    expected = np.diag([2e5, 1e5, 3e5, 5e7, 4e7])  # x, y, z, about x = w, about y = -v
    expected[1, 3] = expected[3, 1] = -6e5  # F_y = -F_v by the rotation about x = w
    expected[0, 4] = expected[4, 0] = 7e5  # F_x = F_w by that about y = -v
    assert_allclose(rows, expected, rtol=ROUNDING)


def test_operating_points_are_turned_the_way_of_the_axes() -> None:
    """The wheel of stage 11 is at +v of its pinion: x = v, y = w, z = u, a turn that is not its own inverse."""
    stiffness = operating_point(np.diag([3e8, 1e8, 2e8, 4e7, 5e7]), bearing=93)
    rows = np.array(bearings(changed(attributes=stiffness), stage="11")[0].stiffness)
    assert_allclose(rows, np.diag([1e5, 2e5, 3e5, 4e7, 5e7]), rtol=ROUNDING, atol=1e-6)


def test_half_an_operating_point_is_none() -> None:
    attributes = operating_point(np.diag([3e8, 1e8, 2e8, 4e7, 5e7]))
    attributes["91.operating_point_stiffness_m_w_rot_w"] = None
    assert bearings(changed(attributes=attributes))[0].radial_stiffness_N_per_um == 200.0


CATALOGUE = {
    "91.radial_stiffness": None,
    "91.axial_stiffness": ("0", "N / m"),
    "91.bending_stiffness": ("0", "N mm / rad"),
}


def test_bearings_without_stiffness_leave_the_shaft_out_and_are_named() -> None:
    imported = import_stage(changed(attributes=CATALOGUE), "10")
    assert imported.scene.pinion.shaft is None
    assert imported.scene.wheel.shaft is not None
    sentence = next(one for one in imported.not_taken if one.startswith("shaft 3"))
    assert "neither stiffness nor inner geometry of concept_bearing 91" in sentence
    assert sentence.endswith("pinion without a support")


WITHOUT = {
    "sections that overlap": (
        {"82.u_coordinate_on_shaft": ("50", "mm")},
        "its sections leave a gap or overlap: one ends at u = 60 mm, the next begins at 50",
    ),
    "an inner diameter above the outer one": ({"82.inner_diameter_begin": ("50", "mm")}, "sections"),
    "a bearing beside it": ({"92.u_coordinate_on_shaft_inner_side": ("250", "mm")}, "beside the shaft"),
    "nothing that holds its axis": ({"91.axial_stiffness": ("0", "N / m")}, "free along its axis"),
}


@pytest.mark.parametrize(("attributes", "reason"), WITHOUT.values(), ids=WITHOUT)
def test_shafts_that_cannot_be_are_left_out_with_their_reason(attributes: dict, reason: str) -> None:
    imported = import_stage(changed(attributes=attributes), "10")
    assert imported.scene.pinion.shaft is None
    assert any(one.startswith('shaft 3 "Input shaft":') and reason in one for one in imported.not_taken)


def test_shafts_without_bearings_or_sections_are_left_out() -> None:
    without = import_stage(changed(without=["side"]), "10")
    assert any("shaft 3" in one and "it has no bearings" in one for one in without.not_taken)
    model = example()
    relations = tuple(one for one in model.relations if one.roles.get("part") not in ("81", "82", "83"))
    without = import_stage(
        changed(model, without=["assembly"], relations=[r for r in relations if r.type == "assembly"]), "10"
    )
    assert any("shaft 3" in one and "it has no sections" in one for one in without.not_taken)


def test_a_gear_on_no_shaft_is_rigid() -> None:
    model = example()
    relations = [one for one in model.relations if one.type == "assembly" and one.roles["part"] != "21"]
    imported = import_stage(changed(model, without=["assembly"], relations=relations), "10", torque_Nm=150.0)
    assert imported.scene.pinion.shaft is None
    assert 'cylindrical_gear 21 "Pinion 1": it is on no shaft; pinion without a support' in imported.not_taken


def test_bearings_in_another_shaft_are_held_rigidly() -> None:
    model = example()
    sides = [one for one in model.relations if one.type == "side" and one.roles["assembly"] != "92"]
    inside = relation("side", assembly=92, inner_part=5, outer_part=3)
    place = {"92.u_coordinate_on_shaft_outer_side": ("180", "mm")}
    imported = import_stage(changed(model, place, without=["side"], relations=[*sides, inside]), "10")
    assert [one.at_mm for one in imported.scene.pinion.shaft.bearings] == [-75.0, 75.0]
    assert "concept_bearing 92: its other side, shaft 5, is rigid in the scene" in imported.read_as


def test_what_holds_a_shaft_and_is_no_bearing_is_named() -> None:
    coupling = part(99, "coupling", "Coupling", radial_stiffness=(1e9, "N / m"))
    side = relation("side", assembly=99, inner_part=3, outer_part=2)
    imported = import_stage(changed(more=[coupling], relations=[side]), "10", torque_Nm=150.0)
    assert 'coupling 99 "Coupling": no bearing; what it holds is not in the scene' in imported.not_taken


def test_forces_of_external_loads_are_turned() -> None:
    """At u = 0 of the input shaft; x = w, y = -v, z = u."""
    force = {f"97.force_{axis}_direction": (value, "N") for axis, value in zip("uvw", (10, 20, 30), strict=True)}
    force |= {"97.torque_around_v_axis": (4, "N m"), "97.torque_around_w_axis": (5, "N m")}
    load = import_stage(changed(attributes=force), "10").scene.pinion.shaft.loads[0]
    assert (load.at_mm, load.force_N, load.moment_Nm) == (-105.0, (30.0, -20.0, 10.0), (5.0, -4.0, 0.0))


def test_torque_enters_where_most_of_it_is() -> None:
    """A pump on the input shaft takes 20 of 150 N m: its torque is a load, that of the motor is held."""
    pump = part(99, "external_load", u_coordinate_on_shaft=(190.0, "mm"), torque_around_u_axis=(-20.0, "N m"))
    model = changed(more=[pump], relations=[relation("assembly", assembly=3, part=99)])
    scene = import_stage(model, "10").scene
    assert_allclose(scene.load.pinion_torque_Nm, 130.0, rtol=1e-9)
    assert scene.pinion.shaft.torque_at_mm == -105.0
    assert [(one.at_mm, one.moment_Nm) for one in scene.pinion.shaft.loads] == [(85.0, (0.0, 0.0, -20.0))]


def test_torque_at_the_output_alone_is_enough() -> None:
    backwards = {"97.torque_around_u_axis": None, "98.torque_around_u_axis": ("1000", "N m")}
    scene = import_stage(changed(attributes=backwards), "10").scene
    # u of the output shaft points against the others: outside teeth turn it as the input shaft, seen along u
    assert_allclose(scene.load.pinion_torque_Nm, 1000.0 * 21.0 * 19.0 / (55.0 * 61.0), rtol=1e-9)


def test_a_shaft_without_any_load_turns_about_the_gear() -> None:
    model = example()
    relations = [one for one in model.relations if one.type == "assembly" and one.roles["part"] != "97"]
    imported = import_stage(changed(model, without=["assembly"], relations=relations), "10", torque_Nm=150.0)
    assert imported.scene.pinion.shaft.torque_at_mm == 0.0
    assert "shaft 3: no place where its torque enters or leaves; taken at mid-face" in imported.read_as


def test_torque_that_does_not_follow_is_asked_for() -> None:
    with pytest.raises(InputError, match=r"stage 10: torque: missing in the stage, .*; give --torque"):
        import_stage(changed(attributes={"97.torque_around_u_axis": None}), "10")
    scene = import_stage(changed(attributes={"97.torque_around_u_axis": None}), "10", torque_Nm=80.0).scene
    assert scene.load.pinion_torque_Nm == 80.0


def test_torque_of_the_stage_goes_before_the_balance() -> None:
    """A file with results has losses in it."""
    scene = import_stage(changed(attributes={"34.torque": ("1240", "N m")}), "11").scene
    assert_allclose(scene.load.pinion_torque_Nm, 1240.0 * 19.0 / 61.0, rtol=1e-9)
    scene = import_stage(changed(attributes={"33.torque": ("-390", "N m")}), "11").scene
    assert scene.load.pinion_torque_Nm == 390.0


def test_torque_asked_for_scales_the_forces_of_other_stages() -> None:
    """Gears in equilibrium under twice the torque: the scene of the model whose motor gives 300 N m instead of 150."""
    imported = import_stage(example(), "10", torque_Nm=300.0)
    doubled = import_stage(changed(attributes={"97.torque_around_u_axis": ("300", "N m")}), "10").scene
    loads, expected = imported.scene.wheel.shaft.loads, doubled.wheel.shaft.loads
    assert len(loads) == 1
    assert_allclose(loads[0].force_N, expected[0].force_N, atol=2e-6)  # written with six digits after the point
    assert_allclose(loads[0].moment_Nm, expected[0].moment_Nm, atol=2e-6)
    assert imported.scene.load.pinion_torque_Nm == doubled.load.pinion_torque_Nm
    note = "stage 10: torques of other stages and loads are 2 times those of the file, "
    assert f"{note}the torque asked for over that of the file, 150 N m" in imported.read_as
    assert not any("times those of the file" in one for one in import_stage(example(), "10", torque_Nm=150.0).read_as)


def test_torque_asked_for_scales_torques_of_loads_and_leaves_their_forces() -> None:
    """A pump on the input shaft takes 20 of 150 N m and presses with 40 N: half of 130 N m leaves it 10."""
    pump = part(
        99,
        "external_load",
        u_coordinate_on_shaft=(190.0, "mm"),
        torque_around_u_axis=(-20.0, "N m"),
        force_u_direction=(40.0, "N"),
    )
    model = changed(more=[pump], relations=[relation("assembly", assembly=3, part=99)])
    imported = import_stage(model, "10", torque_Nm=65.0)
    load = imported.scene.pinion.shaft.loads[0]
    assert_allclose(load.moment_Nm, (0.0, 0.0, -10.0), atol=1e-6)
    assert load.force_N == (0.0, 0.0, 40.0)
    assert "external_load 99: its forces, and its moments across the axis, are those of the file" in imported.read_as


def test_torques_of_other_stages_stay_where_the_file_has_none_of_the_stage() -> None:
    imported = import_stage(changed(attributes={"97.torque_around_u_axis": None}), "10", torque_Nm=80.0)
    note = "stage 10: torques of other stages and loads are those of the file, which has no torque of the stage"
    assert note in imported.read_as


def test_loads_of_a_stage_of_unknown_torque_are_named() -> None:
    torque = {"97.torque_around_u_axis": None, "31.torque": ("150", "N m")}
    imported = import_stage(changed(attributes=torque), "10")
    assert imported.scene.load.pinion_torque_Nm == 150.0
    assert imported.scene.wheel.shaft.loads == ()
    assert 'cylindrical_gear 23 "Pinion 2": its load in stage 11, of unknown torque' in imported.not_taken


def test_which_of_several_loads_hold_is_told() -> None:
    own = "torques and speeds: those of the components themselves, of none of the load cases 1:1, 1:2"
    assert own in import_stage(example(), "11").read_as
    chosen = import_stage(example(), "11", load_case="2").read_as
    assert own not in chosen
    assert "torques and speeds: those of the load case 2" in chosen


def test_a_load_case_gives_torque_and_speed() -> None:
    scene = import_stage(example(), "11", load_case="2").scene
    assert_allclose(scene.load.pinion_torque_Nm, 60.0 * 55.0 / 21.0, rtol=1e-9)
    assert_allclose(scene.operation.pinion_speed_rpm, 3000.0 * 21.0 / 55.0, rtol=1e-9)
    assert (scene.sense, scene.driving) == ("positive", "pinion")  # against that of the model: negative


def test_another_material_of_the_shaft_is_named() -> None:
    iron = part(71, "material", elastic_modulus=(170000.0, "N / mm^2"), poisson_ratio=0.28)
    model = example()
    others = [one for one in model.relations if one.type == "reference" and one.roles["origin"] != "3"]
    model = changed(
        model, more=[iron], without=["reference"], relations=[*others, relation("reference", origin=3, referenced=71)]
    )
    imported = import_stage(model, "10")
    assert any("shaft 3" in one and "its material, E 170000 MPa" in one for one in imported.not_taken)


def test_distances_of_places_are_taken_in_other_frames() -> None:
    """The second stage given in the frame of the intermediate shaft: the same scene."""
    frame = {
        "23.reference_component_for_position": (4, "none"),
        "23.support_vector": ((130.0, 0.0, 0.0), "mm"),
        "24.reference_component_for_position": (23, "none"),
        "24.support_vector": ((0.0, 143.0, 0.0), "mm"),
    }
    for stage in ("10", "11"):
        assert import_stage(changed(attributes=frame), stage).scene == import_stage(example(), stage).scene


POSES = {
    "axes not at right angles": ({"3.w_axis_vector": ((1.0, 0.0, 1.0), "mm")}, "allowed vectors at right angles"),
    "in itself": (
        {f"{a}.reference_component_for_position": (b, "none") for a, b in ((21, 22), (22, 21))},
        "reference_component_for_position: given in itself",
    ),
    "crossed axes": (
        {"4.u_axis_vector": ((0.0, 1.0, 0.0), "mm")},
        "cylindrical_stage 10: found axes that are not parallel",
    ),
    "one axis": (
        {"22.support_vector": ((105.0, 0.0, 0.0), "mm")},
        "cylindrical_stage 10: found both gears on one axis",
    ),
}


@pytest.mark.parametrize(("attributes", "message"), POSES.values(), ids=POSES)
def test_places_that_cannot_be_are_refused(attributes: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        import_stage(changed(attributes=attributes), "10")


def test_a_stage_that_cannot_be_read_spoils_no_other() -> None:
    imported = import_stage(changed(attributes={"24.number_of_teeth": None}), "10", torque_Nm=150.0)
    assert any('cylindrical_stage 11 "Second stage": its forces: ' in one for one in imported.not_taken)
    assert math.isclose(imported.scene.load.pinion_torque_Nm, 150.0)
    with pytest.raises(InputError, match="cylindrical_gear 24: number_of_teeth: missing"):
        import_stage(changed(attributes={"24.number_of_teeth": None}), "11")
