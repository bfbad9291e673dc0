"""Stages of the two public REXS models: geometry by hand, torques along the gearbox, shafts and loads."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.exchange import describe_stages, import_stage
from loaded_tca.loaded.shaft_lines import shaft_lines
from loaded_tca.scene import parse_scene
from tests.samples.rexs import SEW_GEARS, SEW_STAGES, SEW_TORQUE, changed, planetary, sew

HAND = 1e-9
"""Closed forms in double precision."""
AT_EDGE = 0.02
"""Force of a mesh whose shafts the other meshes tilt: flanks without crowning touch at their ends then, and the normal
there leans by up to a hundredth."""


def involute(angle: float) -> float:
    return math.tan(angle) - angle


@pytest.mark.parametrize("stage", SEW_STAGES)
def test_sew_geometry_is_that_of_closed_forms(stage: int) -> None:
    first, second, distance, _ = SEW_STAGES[stage]
    scene = import_stage(sew(), str(stage)).scene
    mesh = scene.mesh()
    rows = [SEW_GEARS[first], SEW_GEARS[second]]
    module, helix = rows[0][2], math.radians(abs(rows[0][3]))
    transverse = math.atan(math.tan(math.radians(20.0)) / math.cos(helix))
    z1, z2 = rows[0][1], rows[1][1]
    pitch = [module * z / math.cos(helix) for z in (z1, z2)]
    working = math.acos(0.5 * sum(pitch) * math.cos(transverse) / distance)
    assert_allclose(mesh.working_pressure_angle, working, rtol=HAND)
    assert_allclose(2.0 * mesh.working_centre_distance, 2.0 * distance, rtol=HAND)
    tips, bases = [], [d * math.cos(transverse) for d in pitch]
    for gear, row, d in zip((mesh.pinion, mesh.wheel), rows, pitch, strict=True):
        tip, root = d + 2.0 * module * (1.0 + row[6]), d - 2.0 * module * (1.25 - row[6])
        assert_allclose([2.0 * gear.tip_radius, 2.0 * gear.root_radius], [tip, root], rtol=HAND)
        assert gear.face_width == row[4]
        tips.append(tip)
    path = sum(math.sqrt(a**2 - b**2) for a, b in zip(tips, bases, strict=True)) / 2.0 - distance * math.sin(working)
    base_pitch = math.pi * module / math.cos(helix) * math.cos(transverse)
    assert_allclose(mesh.transverse_contact_ratio, path / base_pitch, rtol=HAND)
    shifts = rows[0][6] + rows[1][6]
    without_backlash = (z1 + z2) * (involute(working) - involute(transverse)) / (2.0 * math.tan(math.radians(20.0)))
    assert abs(shifts - without_backlash) < 1e-4  # the shifts of the file have four digits


def test_sew_torque_and_speed_go_through_the_gearbox() -> None:
    scenes = [import_stage(sew(), stage).scene for stage in ("6", "37", "55")]
    ratios = 1.0, 67.0 / 23.0, 67.0 / 23.0 * 76.0 / 13.0
    torques = [scene.load.pinion_torque_Nm for scene in scenes]
    assert_allclose(torques, [SEW_TORQUE * ratio for ratio in ratios], rtol=HAND)
    speeds = [scene.operation.pinion_speed_rpm for scene in scenes]
    assert_allclose(speeds, [1400.0 / ratio for ratio in ratios], rtol=HAND)
    assert [scene.driving for scene in scenes] == ["pinion"] * 3
    assert [scene.sense for scene in scenes] == ["positive", "negative", "positive"]  # external stages turn back
    assert [scene.hands for scene in scenes] == [("right", "left"), ("left", "right"), ("right", "left")]


def test_sew_faces_lie_beside_each_other_as_in_space() -> None:
    faces = {"6": (154.0, 156.5), "37": (175.0, 177.5), "55": (227.0, 227.0)}  # middles along the gear unit
    widths = {"6": 11.0, "37": 15.0, "55": 36.0}
    for stage, (pinion, wheel) in faces.items():
        scene = import_stage(sew(), stage).scene
        assert_allclose(scene.mounting.axial_offset_mm, wheel - pinion, atol=HAND)
        assert_allclose(scene.pair().face_width, widths[stage], rtol=HAND)


def test_sew_stage_before_loads_its_wheel_in_the_middle_of_the_common_face() -> None:
    """Faces of stage 6 end at 146 and 162, 151 and 162 mm along the gear unit; gear 38 has its middle at 175 mm."""
    load = import_stage(sew(), "37").scene.pinion.shaft.loads[0]
    assert_allclose(abs(load.at_mm), 175.0 - 156.5, atol=HAND)


def test_sew_shafts_have_their_sections_and_bearings() -> None:
    scene = import_stage(sew(), "6").scene
    shaft = scene.pinion.shaft
    assert (shaft.start_mm, shaft.torque_at_mm) == (-154.0, 20.0 - 154.0)
    assert len(shaft.sections) == 12
    assert_allclose(sum(one.length_mm for one in shaft.sections), 164.5, rtol=HAND)
    assert [one.at_mm for one in shaft.bearings] == [65.5 - 154.0, 111.8 - 154.0]
    assert [one.axial_stiffness_N_per_um > 0.0 for one in shaft.bearings] == [True, False]
    assert scene.wheel.shaft.torque_at_mm == 37.5 - 19.0 + 2.5  # middle of the common face of the next stage


@pytest.mark.parametrize(("stage", "gear", "next_gear"), [("6", "wheel", "38"), ("37", "wheel", "56")])
def test_sew_next_stage_loads_its_shaft(stage: str, gear: str, next_gear: str) -> None:
    """F_t = 2 T/d_w, F_r = F_t tan(alpha_wt), F_a = 2 T/d tan(beta) of the gear of the next stage."""
    imported = import_stage(sew(), stage)
    load = getattr(imported.scene, gear).shaft.loads[0]
    _, teeth, module, helix, *_ = SEW_GEARS[int(next_gear)]
    after = import_stage(sew(), {"38": "37", "56": "55"}[next_gear]).scene
    mesh, torque = after.mesh(), 1e3 * after.load.pinion_torque_Nm
    pitch = module * teeth / math.cos(math.radians(helix))
    tangential = torque / mesh.pinion_working_radius
    across = math.hypot(tangential, tangential * math.tan(mesh.working_pressure_angle))
    assert_allclose(math.hypot(*load.force_N[:2]), across, rtol=1e-7)  # forces have six decimals
    axial = 2.0 * torque / pitch * math.tan(math.radians(abs(helix)))
    assert_allclose(abs(load.force_N[2]), axial, rtol=1e-7)
    assert_allclose(1e3 * math.hypot(*load.moment_Nm[:2]), axial * mesh.pinion_working_radius, rtol=1e-4)
    assert load.moment_Nm[2] == 0.0  # the torque leaves there


@pytest.mark.parametrize(("before", "after"), [("6", "37"), ("37", "55")])
def test_sew_bearings_of_a_shaft_carry_the_same_whichever_stage_is_asked(before: str, after: str) -> None:
    """Sum of the forces on the bearings of the shaft that two stages share, as wheel of one and pinion of the other."""
    sums = []
    for stage, gear in ((before, "wheel"), (after, "pinion")):
        line = next(one for one in shaft_lines(import_stage(sew(), stage).scene) if one.gear == gear)
        force = line.bearing_forces[:, :3].sum(axis=0)
        sums.append((math.hypot(force[0], force[1]), force[2]))
    # of the stage that is asked flanks touch that its shafts have tilted, so that the normal leans by 1e-4
    assert_allclose(sums[0], sums[1], rtol=1e-3)


def test_sew_thrust_goes_to_the_bearing_that_takes_its_direction() -> None:
    for stage, gear, holds in (("37", "wheel", 51), ("37", "pinion", 33)):
        imported = import_stage(sew(), stage)
        shaft = getattr(imported.scene, gear).shaft
        assert [one.axial_stiffness_N_per_um > 0.0 for one in shaft.bearings].count(True) == 1
        assert any(f"geometry {holds}: axial forces of both directions" in one for one in imported.read_as)
        line = next(one for one in shaft_lines(imported.scene) if one.gear == gear)
        assert line.bearing_forces[-1, 2] > 0.0  # towards +u, which "positive" bearings hold


def test_sew_without_places_in_space_has_the_same_forces() -> None:
    """The angles of the stages tell the directions, the lower ends of the faces the places on the shafts."""
    for stage in ("6", "37", "55"):
        placed, by_angles = (import_stage(model, stage).scene for model in (sew(), sew(placed=False)))
        for gear in ("pinion", "wheel"):
            one, other = (getattr(scene, gear).shaft for scene in (placed, by_angles))
            assert_allclose([p.at_mm for p in one.bearings], [p.at_mm for p in other.bearings], atol=1e-9)
            for a, b in zip(one.loads, other.loads, strict=True):
                # the centre distances by the places differ from those of the stages by up to 1e-6 mm
                assert_allclose(a.force_N, b.force_N, rtol=1e-6, atol=1e-5)
    read_as = import_stage(sew(placed=False), "6").read_as
    assert "cylindrical_stage 6: the gears have no places in space; the middles of their faces are level" in read_as


def test_scenes_survive_their_files() -> None:
    for model, stages in ((sew(), SEW_STAGES), (planetary(), (211, 220)), (planetary("1.4", modified=True), (211,))):
        for stage in stages:
            imported = import_stage(model, str(stage))
            assert parse_scene(imported.to_toml()) == imported.scene


def test_planets_share_the_torque_of_the_sun() -> None:
    for stage in ("211", "212", "213"):
        scene = import_stage(planetary(), stage).scene
        assert_allclose(scene.load.pinion_torque_Nm, 1591.5494309189535 / 3.0, rtol=HAND)
        assert (scene.pinion.teeth, scene.wheel.teeth) == (17, 22)
        assert scene.operation.pinion_speed_rpm == 1500.0


def test_planetary_geometry_is_that_of_closed_forms() -> None:
    scene = import_stage(planetary(), "211").scene
    mesh = scene.mesh()
    assert scene.pinion.profile_shift is None  # the file has that of the planets alone; the other follows: 0
    assert_allclose(mesh.pinion.profile_shift, 0.0, atol=HAND)
    assert_allclose([2.0 * mesh.pinion.tip_radius, 2.0 * mesh.wheel.tip_radius], [76.0, 96.0], rtol=HAND)
    assert_allclose([2.0 * mesh.pinion.root_radius, 2.0 * mesh.wheel.root_radius], [58.0, 78.0], rtol=HAND)
    assert_allclose(math.degrees(mesh.working_pressure_angle), 20.0, rtol=HAND)
    bases = [4.0 * z * math.cos(math.radians(20.0)) for z in (17, 22)]
    path = sum(math.sqrt(a**2 - b**2) for a, b in zip((76.0, 96.0), bases, strict=True)) / 2.0
    path -= 78.0 * math.sin(math.radians(20.0))
    ratio = path / (4.0 * math.pi * math.cos(math.radians(20.0)))
    assert_allclose(mesh.transverse_contact_ratio, ratio, rtol=HAND)
    assert (scene.geometry.dedendum_coefficient, scene.geometry.root_radius_coefficient) == (1.25, 0.25)


def test_meshes_of_the_other_planets_hold_the_sun_in_balance() -> None:
    scene = import_stage(planetary(), "211").scene
    loads = scene.pinion.shaft.loads
    line = next(one for one in shaft_lines(scene) if one.gear == "pinion")
    one = math.hypot(*loads[0].force_N)
    assert_allclose(line.bearing_forces[:, :3].sum(axis=0) / one, 0.0, atol=AT_EDGE)
    assert_allclose([one.moment_Nm[2] for one in loads], [-1591.5494309189535 / 3.0] * 2, rtol=1e-9)
    assert scene.pinion.shaft.torque_at_mm == 125.0


def test_ring_of_a_planetary_stage_has_negative_teeth() -> None:
    imported = import_stage(planetary(), "220")
    scene = imported.scene
    assert (scene.pinion.teeth, scene.wheel.teeth) == (22, -61)
    mesh = scene.mesh()
    assert_allclose(mesh.working_centre_distance, 78.0, rtol=HAND)
    assert_allclose(2.0 * mesh.ring.tip_radius, 4.0 * 61 - 8.0, rtol=HAND)
    assert_allclose(scene.load.pinion_torque_Nm, 1591.5494309189535 / 3.0 * 22.0 / 17.0, rtol=HAND)
    assert (scene.wheel.cutter.teeth, scene.wheel.outer_diameter_mm) == (23, 280.0)
    assert any("shaft 62: the shaft of a ring gear" in one for one in imported.not_taken)


def test_sun_and_ring_press_a_planet_the_same_way() -> None:
    """Radial forces of both meshes cancel, tangential ones add, on the planet as the wheel and as the pinion."""
    torque, radius = 1e6 * 1591.5494309189535 / 3.0 / 1e3, 34.0
    tangential = torque / radius
    radial = tangential * math.tan(math.radians(20.0))
    as_wheel = import_stage(planetary(), "211").scene
    force = as_wheel.wheel.shaft.loads[0].force_N  # of the ring; the wheel's x points to the sun
    assert_allclose(np.abs(force), [radial, tangential, 0.0], rtol=1e-6)
    assert force[0] > 0.0
    line = next(one for one in shaft_lines(as_wheel) if one.gear == "wheel")
    carried = line.bearing_forces[:, :3].sum(axis=0)
    expected = np.array([0.0, 2.0 * math.copysign(tangential, force[1]), 0.0])
    assert_allclose(carried / tangential, expected / tangential, atol=AT_EDGE)
    as_pinion = import_stage(planetary(), "220").scene
    line = next(one for one in shaft_lines(as_pinion) if one.gear == "pinion")
    carried = np.abs(line.bearing_forces[:, :3].sum(axis=0)) / tangential
    assert_allclose(carried, [0.0, 2.0, 0.0], atol=AT_EDGE)


def test_modifications_of_the_sun_are_those_of_its_loaded_flank() -> None:
    scene = import_stage(planetary("1.4", modified=True), "211").scene
    keys = scene.pinion.modifications
    assert (keys.lead_crowning_um, keys.helix_slope_um) == (5.0, -6.0)  # of the right flank
    # amounts of the file are at 64.06386 and 76 mm, the active profile starts at 64.0639 by the planet's tip
    assert keys.profile_crowning_um == pytest.approx(5.0, abs=1e-4)
    assert keys.profile_slope_um == 0.0


def test_the_other_way_round_the_other_flank_is_loaded() -> None:
    backwards = {"38.torque_around_u_axis": ("-1591.5", "N m"), "34.rotational_speed": ("-1500", "1 / min")}
    scene = import_stage(changed(planetary("1.4", modified=True), backwards), "211").scene
    assert (scene.sense, scene.driving) == ("negative", "pinion")
    assert scene.pinion.modifications.helix_slope_um == 6.0


def test_a_wheel_that_drives_is_told_by_torque_and_speed() -> None:
    scene = import_stage(changed(sew(), {"22.torque_around_u_axis": ("-4.7", "N m")}), "6").scene
    assert (scene.driving, scene.sense) == ("wheel", "positive")


def test_power_and_speed_give_the_torque() -> None:
    power = {"38.torque_around_u_axis": None, "38.power": ("100", "kW")}
    scene = import_stage(changed(planetary(), power), "211").scene
    assert_allclose(scene.load.pinion_torque_Nm, 1e5 / (1500.0 * math.pi / 30.0) / 3.0, rtol=HAND)


def test_stages_are_shown_with_their_gears() -> None:
    text = describe_stages(planetary())
    assert "  9: planetary_stage" in text
    assert "  220: cylindrical_stage: cylindrical_gear 247 with 22 teeth, ring_gear 58 with 61 teeth" in text


def test_a_planetary_stage_is_no_scene() -> None:
    with pytest.raises(
        InputError, match=r"stage 9: planetary stages are not covered; import makes scenes of .* of two gears: 211, 220"
    ):
        import_stage(planetary(), "9")


def test_two_ring_gears_are_refused() -> None:
    teeth = {f"{gear}.number_of_teeth": ("-60", "none") for gear in (23, 34)}
    with pytest.raises(InputError, match="cylindrical_stage 6: both gears are ring gears"):
        import_stage(changed(sew(), teeth), "6")
