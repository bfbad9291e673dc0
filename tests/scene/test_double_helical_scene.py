"""Scenes of double helical pairs: what their keys mean for the halves, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import InputError, parse_scene, read_scene
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.section import as_table
from loaded_tca.unloaded import trace_contact
from tests.refusals import refusals

RADIAL = {"radial_stiffness_N_per_um": 500.0}
SHAFT = {
    "start_mm": -100.0,
    "torque_at_mm": -100.0,
    "sections": [{"length_mm": 200.0, "outer_diameter_mm": 60.0}],
}


@pytest.fixture(scope="module")
def scene():
    return read_scene("examples/scenes/double_helical.toml")


def test_halves_have_half_the_face_less_the_groove(scene):
    first, second = scene.half_scenes(0.0)
    assert (first.pinion.face_width_mm, second.wheel.face_width_mm) == (40.0, 40.0)
    assert first.torques == second.torques == (800000.0,)
    slopes = [half.pinion.modifications.helix_slope_um for half in (first, second)]
    assert slopes == [0.0, 8.0]
    assert second.wheel.modifications == first.wheel.modifications


def test_faces_of_unlike_widths_lie_beside_each_other(scene):
    wide = scene.with_changes({"pinion.face_width_mm": 106.0, "mounting.axial_offset_mm": 0.5})
    # the grooves are alike, so that the wider pinion begins where the wheel does, and ends farther out
    offsets = [half.mounting.axial_offset_mm for half in wide.half_scenes(0.5)]
    assert_allclose(offsets, [0.5 - 1.5, -0.5 - 1.5])
    assert [half.mesh().common_face_width for half in wide.half_scenes(0.0)] == [40.0, 40.0]


def test_axis_errors_of_the_whole_wheel_move_and_turn_its_halves(scene):
    errors = {"mounting.in_plane_deg": 0.2, "mounting.out_of_plane_deg": -0.3, "mounting.misalignment_um": 40.0}
    tilted = scene.with_changes(errors)
    skew = 0.04 / (100.0 * math.cos(scene.mesh().working_pressure_angle))
    whole = Mounting(in_plane=math.radians(0.2), out_of_plane=math.radians(-0.3) + skew)
    distance, lever = scene.mesh().working_centre_distance, 30.0
    origin, axes = whole.place_parallel(distance)
    for sign, half in zip((1.0, -1.0), tilted.halves, strict=True):
        mirror = np.array([1.0, 1.0, sign])
        middle = mirror * (origin + sign * lever * axes[2])
        # moved across, y, it is in `parted`; along z it is moved by a cosine
        assert_allclose(half.wheel_origin[0], middle[0], rtol=1e-9)
        assert_allclose(half.wheel_axes[2], mirror * axes[2] * sign, atol=1e-12)  # unit vectors
    moved = lever * axes[2][1] * math.cos(scene.mesh().working_pressure_angle)
    assert_allclose(
        np.subtract(tilted.parted, scene.parted), [moved, -moved], rtol=2e-5
    )  # of the sine of one angle, the other's cosine


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("driving", ["pinion", "wheel"])
def test_motions_of_the_wheel_part_flanks_as_contact_points_do(scene, hand, sense, driving):
    plain = {"pinion.modifications": None, "pinion.half_b": None, "wheel.modifications": None, "pair.sense": sense}
    one = scene.with_changes({**plain, "pinion.hand": hand, "pair.driving": driving})
    pair, step = one.halves[0], 0.01
    length = -pair.driving * pair.base_radii[1]
    at_rest, along, across = (
        length
        * trace_contact(
            replace(pair, wheel_origin=pair.wheel_origin + step * np.array(way)), np.zeros(1)
        ).transmission_error[0]
        for way in ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
    )
    assert_allclose((along - at_rest) / step, one.axial_rate, rtol=1e-6)  # of a helix, exactly
    tilted = one.with_changes({"mounting.out_of_plane_deg": 0.01})
    moved = -30.0 * math.sin(math.radians(0.01))
    # the line of centres turns by the step over the centre distance, 5e-5
    assert_allclose((across - at_rest) / step, (tilted.parted[0] - one.parted[0]) / moved, rtol=1e-3)


def test_apex_and_place_of_the_wheel_part_flanks_alike_and_half_b_has_its_own(scene):
    by_apex = scene.with_changes({"pair.apex_offset_mm": 0.05})
    by_place = scene.with_changes({"pair.apex_offset_mm": 0.0, "mounting.axial_offset_mm": 0.05})
    assert by_apex.parted == by_place.parted
    assert by_apex.parted[0] == pytest.approx(0.05 * scene.axial_rate) == -by_apex.parted[1]
    own = scene.with_changes({"mounting.half_b": {"axial_offset_mm": 0.01, "in_plane_deg": 0.1}})
    assert_allclose(np.subtract(own.parted, scene.parted), [0.0, 0.01 * scene.axial_rate])
    assert [half.mounting.in_plane_deg for half in own.half_scenes(0.0)] == [0.0, 0.1]
    assert own.half_scenes(0.0)[1].mounting.axial_offset_mm == 0.01


def test_a_ring_with_halves_is_told_of_its_teeth(scene):
    with pytest.raises(InputError, match=r"^wheel\.teeth: found -60"):
        scene.with_changes({"wheel.teeth": -60})


def test_keys_of_halves_that_are_none_leave_a_pair_without_halves(scene):
    keys = ("double_helical", "gap_mm", "apex_offset_mm", "floating", "axial_stiffness_N_per_um")
    single = scene.with_changes({**{f"pair.{key}": None for key in keys}, "pinion.half_b": None})
    assert type(single) is CylindricalScene
    assert single.pinion.face_width_mm == scene.pinion.face_width_mm  # now without a groove


def test_keys_that_made_halves_of_a_pair_make_one_pair_again_without_them(scene):
    """Defaults of the other keys of halves are no keys that were given; one that is given is told to need them."""
    keys = ("double_helical", "gap_mm", "apex_offset_mm", "floating", "axial_stiffness_N_per_um")
    single = scene.with_changes({**{f"pair.{key}": None for key in keys}, "pinion.half_b": None})
    halves = single.with_changes({"pair.double_helical": True, "pair.gap_mm": 20.0})
    back = {"pair.double_helical": None, "pair.gap_mm": None}
    assert halves.with_changes(back) == single
    with pytest.raises(InputError, match=r"^pair\.double_helical: missing"):
        halves.with_changes({**back, "pair.floating": "pinion"})
    with pytest.raises(InputError, match=r"^pair\.double_helical: missing"):
        halves.with_changes({"pair.floating": "wheel"}).with_changes(back)
    whole = {**as_table(single)["pair"], "floating": "pinion"}
    with pytest.raises(InputError, match=r"^pair\.double_helical: missing"):
        halves.with_changes({"pair": whole})


def test_text_makes_the_scene_again_and_keys_of_halves_make_it_another_one(scene):
    assert parse_scene(scene.to_toml()) == scene
    keys = ["gap_mm", "apex_offset_mm", "floating", "axial_stiffness_N_per_um", "double_helical"]
    keys += ["apex_runout_um", "apex_runout_phase_deg"]
    text = scene.to_toml()
    lines = [line for line in text.splitlines() if line.split(" = ")[0] not in keys]
    plain = parse_scene("\n".join(lines[: lines.index("[pinion.half_b]")] + lines[lines.index("[wheel]") :]))
    assert type(plain) is CylindricalScene
    assert plain.with_changes({"pair.double_helical": True, "pair.gap_mm": 20.0}).geometry.floating == "pinion"


test_refused = refusals(
    lambda changes, scene: scene.with_changes(changes),
    ({"pair.double_helical": False}, "pair.double_helical: found false; allowed true, or leave it"),
    ({"pair.double_helical": None}, "pair.double_helical: missing; allowed false or true"),
    ({"pair.gap_mm": 0.0}, "pair.gap_mm: found 0"),
    ({"pair.gap_mm": 100.0}, "pair.gap_mm: found 100; allowed below the overall face width, 100"),
    ({"pair.helix_angle_deg": 0.0}, "pair.helix_angle_deg: found 0; allowed above 0: the halves of spur teeth"),
    ({"pair.floating": "both"}, 'pair.floating: found "both"; allowed "pinion" or "wheel" or "none"'),
    (
        {"pair.floating": "none", "pair.axial_stiffness_N_per_um": 3.0},
        'pair.axial_stiffness_N_per_um: found 3 beside floating = "none"; it holds the gear that floats',
    ),
    ({"wheel.teeth": -60}, "wheel.teeth: found -60"),
    (
        {"pinion.modifications.end_relief_length_mm": 21.0},
        "half a: pinion.modifications.end_relief_length_mm: found 21",
    ),
    (
        {"pinion.half_b": {"modifications": {"end_relief_length_mm": 21.0}}},
        "half b: pinion.modifications.end_relief_length_mm: found 21; allowed up to 0.5 face_width_mm = 20",
    ),
    ({"analysis.load_sharing": False}, "analysis.load_sharing: found false; allowed true: the tooth pairs of both"),
    ({"load.pinion_torque_Nm": 0.0}, "load.pinion_torque_Nm: found a torque of 0; allowed above 0"),
    ({"analysis.torques_Nm": [0.0, 5.0]}, "analysis.torques_Nm: found a torque of 0; allowed above 0"),
    (
        {"wheel.support": {"stiffness": [[1e6 * (i == j) for j in range(6)] for i in range(6)]}},
        "wheel.support: found a section; not allowed of halves: a matrix takes the loads of one mesh at one place",
    ),
    *(
        (
            {"pinion.shaft": {**SHAFT, "bearings": [{"at_mm": -90.0, **RADIAL}, {"at_mm": 90.0, **bearing}]}},
            "pinion.shaft: found bearings at 90 mm that hold the floating gear along its axis; allowed are bearings "
            "without axial stiffness or contact angle, with pair.axial_stiffness_N_per_um",
        )
        for bearing in (
            {**RADIAL, "axial_stiffness_N_per_um": 1.0},
            {"type": "ball", "balls": 9, "ball_diameter_mm": 16.0, "pitch_diameter_mm": 90.0},
            {"stiffness": [[1e5 * (i == j) for j in range(6)] for i in range(6)]},
        )
    ),
)
test_one_pair_of_two_halves_is_refused = refusals(
    lambda scene: scene.pair(),
    ("pair.double_helical: found true; allowed false here, where one pair of flanks is needed",),
)


def test_one_pair_of_two_halves_on_shafts_is_refused_with_the_way_to_the_forces_on_bearings(scene):
    bearings = [{"at_mm": -90.0, **RADIAL, "axial_stiffness_N_per_um": 100.0}, {"at_mm": 90.0, **RADIAL}]
    on_shaft = scene.with_changes({"wheel.shaft": SHAFT | {"bearings": bearings}})
    with pytest.raises(
        InputError,
        match=r"forces on bearings: those of even shares are in 'loaded-tca check', .* double_helical_bearings\.csv",
    ):
        on_shaft.pair()
    with pytest.raises(InputError, match=r"scene\.half_scenes\(0\.0\) with measured flanks$"):
        scene.pair()
