"""Scenes of hypoid pairs: keys, what is counted from the crossing points, messages, rows."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.gears import pitch_cones_by_method_1
from loaded_tca.scene import hypoid_table, parse_scene, read_scene, scene_from_table
from loaded_tca.unloaded import trace_contact
from tests.refusals import refusals
from tests.samples.hypoid import hypoid_blank, hypoid_gears, hypoid_pair
from tests.samples.scene_tables import changed

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
REST = {
    "material": {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3},
    "load": {"pinion_torque_Nm": 250.0},
}


@pytest.fixture
def table():
    return hypoid_table(hypoid_gears(), hypoid_blank().cones) | REST


@pytest.fixture(scope="module")
def scene():
    return scene_from_table(hypoid_table(hypoid_gears(), hypoid_blank().cones) | REST)


test_message_names_the_key_and_what_is_allowed = refusals(
    lambda changes, table: scene_from_table(changed(table, changes)),
    (
        {"pair.offset_mm": 14.0},
        "pair.offset_mm: found 14; with pair.shaft_angle_deg = 90 and these pitch cones the axes close with "
        "pinion.blank.pitch_angle_deg = 21.3383, found 21.2877, allowed within 0.01 of it",
    ),
    (
        {"pair.offset_mm": 100.0},
        "pair.offset_mm: found 100; too large for these pitch cones; allowed below 75.9573 mm",
    ),
    (
        {"pinion.blank.pitch_angle_deg": 21.5},
        "pair.offset_mm: found 15; with pair.shaft_angle_deg = 90 and these pitch cones the axes close with "
        "pinion.blank.pitch_angle_deg = 21.2877, found 21.5, allowed within 0.01 of it",
    ),
    (
        {"pinion.blank.calculation_cone_distance_mm": 100.0},
        "pinion.blank.calculation_cone_distance_mm: found 100; allowed on the face, between 57.6996 and "
        "outer_cone_distance_mm = 89.6096",
    ),
    (
        {
            "wheel.blank.pitch_angle_deg": 120.0,
            "wheel.blank.face_angle_deg": 121.0,
            "wheel.blank.root_angle_deg": 119.0,
        },
        "pair.offset_mm: found 15; with pair.shaft_angle_deg = 90 no pinion of pitch_angle_deg = 21.2877 stands beside "
        "wheel.blank.pitch_angle_deg = 120",
    ),
    ({"pair.offset_mm": 2000.0}, "pair.offset_mm: found 2000.0; allowed a number from -1000 to 1000"),
    (
        {"wheel.blank.hand": "left"},
        'wheel.blank.hand: found "left" on both gears; allowed "right", the hand that the pinion does not have',
    ),
    plain=True,
)


def test_axes_that_meet_have_one_calculation_point(table):
    with pytest.raises(InputError) as raised:
        scene_from_table(changed(table, {"pair.offset_mm": 0.0}))
    told = [problem.split(":")[0] for problem in raised.value.problems]
    assert told == [
        "wheel.blank.outer_cone_distance_mm",  # gears that touch at one R_m may have faces of their own
        "wheel.blank.face_width_mm",
        "wheel.blank.calculation_cone_distance_mm",
        "pinion.blank.pitch_angle_deg",
        "wheel.blank.pitch_angle_deg",
    ]


def test_offset_against_the_spiral_angles_is_told_by_its_key(scene):
    with pytest.raises(InputError, match=r"^pair\.offset_mm: -15 mm; the flanks have spiral angles .* change the sign"):
        scene.with_changes({"pair.offset_mm": -15.0}).pair()


def test_scene_of_gears_is_their_pair(scene):
    pair, expected = scene.pair(), hypoid_pair()
    assert_allclose(pair.wheel_origin, expected.wheel_origin, rtol=0, atol=1e-10)  # mm; of 15 mm: none seen
    assert_allclose(pair.base_radii, expected.base_radii)
    angles = np.array([-0.2, 0.0, 0.2])
    found, wanted = (trace_contact(one, angles).transmission_error for one in (pair, expected))
    assert_allclose(found, wanted, atol=1e-11)


def test_apexes_and_machine_centre_count_from_the_crossing_points(scene, table):
    mesh = scene.mesh()
    for gear, made, beyond in zip(("pinion", "wheel"), mesh.gears, mesh.cones.apexes, strict=True):
        section = table[gear]
        assert_allclose(made.blank.face_apex + beyond, section["blank"]["face_apex_mm"])
        assert_allclose(made.machine.machine_centre_to_back + beyond, section["machine"]["machine_centre_to_back_mm"])
    # of the sheet: the root cone of the pinion touches the face cone of the wheel at the clearance
    assert_allclose(mesh.tip_clearances, hypoid_blank().clearance, rtol=1e-3)


def test_text_of_a_scene_makes_the_same_scene(scene):
    assert parse_scene(scene.to_toml()) == scene
    assert "offset_mm = 15.0" in scene.to_toml()


def test_table_has_the_axes_that_the_pitch_cones_were_asked_for():
    """Not 89.99999999999999 deg and 25.000000000000004 mm."""
    cones = pitch_cones_by_method_1((11, 45), 25.0, 205.0, 31.0, math.radians(48.0), 76.2).cones
    pair = hypoid_table(hypoid_gears(), cones)["pair"]
    assert (pair["shaft_angle_deg"], pair["offset_mm"]) == (90.0, 25.0)


def test_rows_tell_the_cones_on_their_axes(scene):
    rows = {label: cells for label, *cells in scene.geometry_rows()}
    assert rows["hypoid offset a [mm]"] == ["15.0000"]
    assert rows["offset angles zeta_m, zeta_mp [deg]"] == ["10.6031", "11.3896"]  # F.3: 10.603, 11.390
    assert_allclose([float(cell) for cell in rows["crossing point to P, t_zm [mm]"]], [69.727, 26.621], atol=1.5e-3)
    assert rows["pinion less wheel: spiral - zeta_mp, pressure"] == ["0.0000", "0.0000"]
    assert_allclose(float(rows["mean normal module m_mn, of the wheel [mm]"][0]), 2.640, atol=1.5e-3)  # F.3
    assert not scene.interferences()


def test_forces_are_those_of_iso_tr_10300_30(scene):
    forces = {label: float(cell) for label, cell in scene.force_rows([250e3])}
    assert_allclose(forces["mean tangential force F_mt [N]"], 9366.1, rtol=2e-5)  # printed d_m1 has five digits
    assert_allclose(forces["normal force F_n [N]"], 15298.7, rtol=2e-5)


@pytest.mark.parametrize("flank", ["concave", "convex"])
def test_forces_of_pinion_and_wheel_are_in_equilibrium(scene, flank):
    """In P both flanks have one normal: the forces of the rows, brought into one frame, cancel."""
    shown = scene.with_changes({"pair.pinion_flank": flank})
    forces = [float(cell) for _, cell in shown.force_rows([250e3])]
    tangential, normal, pinion_axial, pinion_radial, wheel_axial, wheel_radial = forces
    assert_allclose(math.hypot(tangential, pinion_axial, pinion_radial), normal, rtol=1e-4)
    wheel_tangential = math.sqrt(normal**2 - wheel_axial**2 - wheel_radial**2)
    radii = [
        float(cell)
        for label, *cells in shown.geometry_rows()
        for cell in cells
        if label == "mean point, radius rho [mm]"
    ]
    assert_allclose(wheel_tangential * radii[1], tangential * radii[0] * 42 / 13, rtol=2e-3)


@pytest.mark.thorough
def test_example_is_what_its_script_makes():
    import importlib.util

    path = SCENES.parent / "make_hypoid.py"
    module = importlib.util.module_from_spec(importlib.util.spec_from_file_location(path.stem, path))
    module.__spec__.loader.exec_module(module)
    text = (SCENES / "hypoid_13x42.toml").read_text(encoding="utf-8")
    written, made = tomllib.loads(text), tomllib.loads(module.main())

    def numbers(table):
        for value in table.values():
            if isinstance(value, dict):
                yield from numbers(value)
            elif isinstance(value, float):
                yield value

    # settings of another machine's arithmetic differ where small settings are as good as each other
    assert_allclose(list(numbers(made)), list(numbers(written)), atol=2e-3)
    assert text.startswith(module.HEADER)
    read_scene(SCENES / "hypoid_13x42.toml")
