"""Scenes of bevel gears: their messages, their text, and the pairs that they build."""

import itertools
from dataclasses import fields, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import outward_normal
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.scene import BevelScene, CylindricalScene, parse_scene, scene_from_table
from loaded_tca.scene.bevel import GearSection, Geometry, MountingErrors
from tests.refusals import refusals
from tests.samples.scene_tables import changed

ANGLES = ("pressure_angle_deg", "normal_pressure_angle_deg")
ROUNDING = 1e-13  # a few multiplications by units and trigonometric functions

EVERY_KEY = {
    "pair.shaft_angle_deg": 75.0,
    "pair.normal_pressure_angle_deg": 18.5,
    "pair.driving": "wheel",
    "pair.pinion_flank": "convex",
    "pinion.hand": "left",
    "wheel.hand": "right",
    "pinion.profile_shift": 0.2,
    "wheel.profile_shift": -0.2,
    "pinion.face_angle_deg": 24.0,
    "pinion.root_angle_deg": 18.0,
    "pinion.bore_diameter_mm": 10.0,
    "pinion.modifications.lead_crowning_um": 20.0,
    "wheel.modifications.profile_crowning_um": 7.0,
    "mounting.offset_mm": 0.1,
    "mounting.pinion_axial_mm": -0.2,
    "mounting.wheel_axial_mm": 0.3,
    "mounting.shaft_angle_error_deg": 0.05,
    "analysis.positions": 3,
}


ONE_PROBLEM = [
    (
        {"pair.outer_module_mm": None},
        "pair.outer_module_mm: missing; allowed one of outer_module_mm, mean_normal_module_mm, wheel_outer_diameter_mm",
    ),
    ({"pair.outer_module_mm": 0}, "pair.outer_module_mm: found 0; allowed a number above 0, up to 1000"),
    ({"pair.shaft_angle_deg": 180.0}, "pair.shaft_angle_deg: found 180.0; allowed a number from 1 to 179"),
    ({"pair.pressure_angle_deg": 50.0}, "pair.pressure_angle_deg: found 50.0; allowed a number from 1 to 44"),
    (
        {"pair.normal_pressure_angle_deg": 20.0, "pair.pressure_angle_deg": 24.0},
        "pair.normal_pressure_angle_deg: found 20 beside pressure_angle_deg = 24; give one of the two",
    ),
    (
        {"pair.normal_pressure_angle_deg": 0.5},
        "pair.normal_pressure_angle_deg: found 0.5; allowed a number from 1 to 44",
    ),
    (
        {"pair.normal_pressure_angle_deg": 30.0, "pair.spiral_angle_deg": 59.0},
        "pair.normal_pressure_angle_deg: found 30; with spiral_angle_deg = 59 allowed up to 27.2502, which is 45 deg "
        "of transverse pressure angle",
    ),
    ({"pair.spiral_angle_deg": -35.0}, "pair.spiral_angle_deg: found -35.0; allowed a number from 0 to 59"),
    ({"pair.spiral_angle_deg": None}, 'pair.spiral_angle_deg: missing; a "spiral_bevel" pair needs it, 0 to 59'),
    (
        {"pair.type": "straight_bevel"},
        'pair.spiral_angle_deg: found 35; allowed 0 for a "straight_bevel" pair; give type = "spiral_bevel" for other '
        "angles",
    ),
    ({"pair.pinion_flank": "drive"}, 'pair.pinion_flank: found "drive"; allowed "concave" or "convex"'),
    (
        {"pair.pinion_flank": "concave", "pair.sense": "positive"},
        'pair.pinion_flank: found "concave" beside sense = "positive"; give one of the two',
    ),
    (
        {"pair.type": "straight_bevel", "pair.spiral_angle_deg": None, "pair.pinion_flank": "convex"},
        'pair.pinion_flank: found "convex", but straight teeth have no concave or convex flank; give sense instead',
    ),
    (
        {"pair.normal_module_mm": 3.0},
        'pair.normal_module_mm: unknown key; did you mean "pair.mean_normal_module_mm"?',
    ),
    ({"pinion.face_angle_deg": 0.0}, "pinion.face_angle_deg: found 0.0; allowed a number above 0, up to 179"),
    ({"pinion.root_angle_deg": 180}, "pinion.root_angle_deg: found 180; allowed a number above 0, up to 179"),
    (
        {"wheel.face_width_mm": 18.0},
        "wheel.face_width_mm: found 18; allowed pinion.face_width_mm = 20: both gears end on the same spheres",
    ),
    (
        {"pinion.hand": "left", "wheel.hand": "left"},
        'wheel.hand: found "left" on both gears; allowed "right", the hand that the pinion does not have',
    ),
    (
        {"wheel.modifications.end_relief_um": 3.0, "wheel.modifications.end_relief_length_mm": 11.0},
        "wheel.modifications.end_relief_length_mm: found 11; allowed up to 0.5 face_width_mm = 10",
    ),
    ({"mounting.offset_mm": 1001.0}, "mounting.offset_mm: found 1001.0; allowed a number from -1000 to 1000"),
    ({"mounting.pinion_axial_mm": "1"}, 'mounting.pinion_axial_mm: found "1"; allowed a number from -1000 to 1000'),
    ({"mounting.wheel_axial_mm": True}, "mounting.wheel_axial_mm: found true; allowed a number from -1000 to 1000"),
    (
        {"mounting.shaft_angle_error_deg": 11.0},
        "mounting.shaft_angle_error_deg: found 11.0; allowed a number from -10 to 10",
    ),
    (
        {"mounting.shaft_angle_error_deg": 5.0, "pair.shaft_angle_deg": 176.0},
        "mounting.shaft_angle_error_deg: found 5; with pair.shaft_angle_deg = 176 it must stay between 0 and 180",
    ),
    (
        {"mounting.in_plane_deg": 0.1},
        "mounting.in_plane_deg: unknown key; allowed offset_mm, pinion_axial_mm, wheel_axial_mm, shaft_angle_error_deg",
    ),
]


test_message_names_the_key_and_what_is_allowed = refusals(
    lambda changes, spiral_table: scene_from_table(changed(spiral_table, changes)), *ONE_PROBLEM, plain=True
)


def test_scene_of_no_known_type_is_told_its_other_problems_too(spiral_table):
    """The family that knows the most of its keys says what they are."""
    with pytest.raises(InputError) as raised:
        scene_from_table(changed(spiral_table, {"pair.type": "spiral", "mounting.offset_mm": 1e9, "load": None}))
    assert [line.split(":")[0] for line in raised.value.problems] == [
        "pair.type",
        "mounting.offset_mm",
        "load.pinion_torque_Nm",
    ]
    assert 'did you mean "spiral_bevel"?' in raised.value.problems[0]


CANNOT_BE = [
    (
        {"pinion.bore_diameter_mm": 60.0},
        InputError,
        r"pinion: bore_diameter_mm: 60 mm is not below .* at the toe, 55.0812 mm",
    ),
    ({"pinion.face_angle_deg": 20.0}, InputError, "pinion: face cone, 20.0000 deg, is not above the pitch cone"),
    ({"wheel.root_angle_deg": 70.0}, InputError, "wheel: root cone, 70.0000 deg, is not below the pitch cone"),
    ({"pinion.face_width_mm": 90.0, "wheel.face_width_mm": 90.0}, GeometryError, "reaches the apex"),
    ({"pinion.face_angle_deg": 36.0}, GeometryError, "pinion: .*pointed tooth"),
    (
        {"pinion.modifications.tip_relief_um": 5.0, "pinion.modifications.tip_relief_start_mm": 200.0},
        InputError,
        r"pinion\.modifications\.tip_relief_start_mm \(diameter on the active profile\): 200 mm is not between",
    ),
]


@pytest.mark.parametrize(("changes", "error", "message"), CANNOT_BE)
def test_geometry_that_cannot_be_is_told_by_the_gears(spiral, changes, error, message):
    with pytest.raises(error, match=message):
        spiral.with_changes(changes).pair()


# Defaults, text


def test_defaults_are_those_of_the_documentation(spiral):
    assert (spiral.geometry.shaft_angle_deg, np.degrees(spiral.mesh().pinion.pressure_angle)) == (90.0, 20.0)
    assert (spiral.geometry.driving, spiral.geometry.sense, spiral.sense) == ("pinion", None, "positive")
    assert (spiral.pinion.face_angle_deg, spiral.pinion.root_angle_deg) == (None, None)
    assert spiral.mounting == MountingErrors()


def test_straight_pair_may_say_that_its_spiral_angle_is_zero(spiral):
    straight = spiral.with_changes({"pair.type": "straight_bevel", "pair.spiral_angle_deg": None})
    assert straight.with_changes({"pair.spiral_angle_deg": 0.0}).pair().base_radii == straight.pair().base_radii
    assert straight.contact_sides == ("straight", "straight")


def test_text_of_the_smallest_scene_has_every_key(spiral):
    text = spiral.to_toml()
    for section in (Geometry, GearSection, MountingErrors):
        assert all(field.name in text for field in fields(section))
    assert text.index("[pair]") < text.index("[pinion]") < text.index("[mounting]") < text.index("[analysis]")


def test_text_with_every_key_set_makes_the_same_scene(spiral):
    full = spiral.with_changes(EVERY_KEY)
    assert full.geometry.type == "spiral_bevel"
    assert parse_scene(full.to_toml()) == full
    assert parse_scene(spiral.to_toml()) == spiral


def test_changes_may_lead_to_another_family(spiral, scene):
    parallel = {"pair": {"type": "cylindrical", "normal_module_mm": 3.0}, "mounting": {}}
    gears = {f"{gear}.{name}_angle_deg": None for gear in ("pinion", "wheel") for name in ("face", "root")}
    assert type(spiral) is BevelScene
    assert type(spiral.with_changes(parallel)) is CylindricalScene
    assert spiral.with_changes({**parallel, **gears}) == spiral.with_changes(parallel)  # None: not given
    with pytest.raises(InputError, match=r"pair\.normal_module_mm: unknown key"):
        scene.with_changes({"pair.type": "straight_bevel"})


# The pair


@pytest.mark.parametrize("hand", ["left", "right"])
def test_normal_pressure_angle_is_that_of_the_section_across_the_teeth(spiral, hand):
    """At the mean pitch point the flank's normal leans by alpha_n out of the plane that touches the pitch cone."""
    pair = spiral.with_changes({"pair.normal_pressure_angle_deg": 20.0, "pinion.hand": hand}).pair()
    mesh = spiral.mesh()
    delta, distance = mesh.pinion.pitch_angle, mesh.pinion.mean_cone_distance
    normal = outward_normal(pair.pinion.flank, np.array(distance * np.sin(delta)), np.array(distance * np.cos(delta)))
    out_of_the_cone = np.array([np.cos(delta), 0.0, -np.sin(delta)])
    assert_allclose(np.degrees(np.arcsin(normal @ out_of_the_cone)), 20.0, rtol=1e-9)


def test_normal_pressure_angle_of_straight_teeth_is_the_transverse_one(spiral):
    straight = {"pair.type": "straight_bevel", "pair.spiral_angle_deg": None}
    both = [spiral.with_changes({**straight, f"pair.{name}": 30.0}) for name in ANGLES]
    assert_allclose(both[0].mesh().pinion.pressure_angle, both[1].mesh().pinion.pressure_angle, rtol=ROUNDING)


def test_pair_is_the_one_made_by_hand(spiral):
    pressure_angles = {"pair.normal_pressure_angle_deg": None, "pair.pressure_angle_deg": 22.5}
    brass = {"youngs_modulus_MPa": 1e5, "poisson_ratio": 0.25}
    full = spiral.with_changes({**EVERY_KEY, **pressure_angles, "wheel.material": brass})
    mesh = bevel_mesh(
        (20, 40),
        4.0,
        20.0,
        shaft_angle=np.radians(75.0),
        pressure_angle=np.radians(22.5),
        spiral_angle=-np.radians(35.0),
        profile_shifts=(0.2, -0.2),
        face_angles=(np.radians(24.0), None),
        root_angles=(np.radians(18.0), None),
    )
    expected = bevel_pair(
        mesh,
        modifications=(FlankModifications(lead_crowning=0.02), FlankModifications(profile_crowning=0.007)),
        mounting=BevelMounting(0.1, -0.2, 0.3, np.radians(0.05)),
        driving="wheel",
        sense="negative",  # the convex flank of a left-hand pinion has s = +1, and the wheel drives
    )
    found = full.pair()
    assert (found.teeth, found.driving, found.sense) == ((20, 40), -1, -1)
    assert_allclose(found.wheel_origin, expected.wheel_origin, atol=ROUNDING)
    assert_allclose(found.wheel_axes, expected.wheel_axes, atol=ROUNDING)
    assert [gear.material.youngs_modulus for gear in (found.pinion, found.wheel)] == [206000.0, 1e5]
    for member in ("pinion", "wheel"):
        mine, other = getattr(found, member).flank, getattr(expected, member).flank
        rho, z = other.grid(5, 4)
        assert_allclose(mine.grid(5, 4)[0], rho, rtol=ROUNDING)
        assert_allclose(mine.theta(rho, z).value, other.theta(rho, z).value, atol=ROUNDING)


def lengthwise_bow(flank, mesh):
    """How far the middle of the tooth stands out of the chord from toe to heel on the pitch cone, along the normal."""
    distance = np.array(
        [mesh.pinion.inner_cone_distance, mesh.pinion.mean_cone_distance, mesh.pinion.outer_cone_distance]
    )
    rho, z = distance * np.sin(mesh.pinion.pitch_angle), distance * np.cos(mesh.pinion.pitch_angle)
    theta = flank.theta(rho, z).value
    toe, middle, heel = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=-1)
    chord = (heel - toe) / np.linalg.norm(heel - toe)
    out = (middle - toe) - ((middle - toe) @ chord) * chord
    radial, around, axial = outward_normal(flank, rho[1], z[1])
    return out @ np.array([radial, around, axial])  # theta = 0 in the middle


@pytest.mark.parametrize(
    ("side", "hand", "driving"), list(itertools.product(["concave", "convex"], ["right", "left"], ["pinion", "wheel"]))
)
def test_pinion_flank_is_the_one_that_touches(spiral, side, hand, driving):
    """A concave flank is hollow from toe to heel: its middle lies behind the chord."""
    wanted = {"pair.pinion_flank": side, "pinion.hand": hand, "pair.driving": driving}
    scene = spiral.with_changes(wanted)
    bow = lengthwise_bow(scene.pair().pinion.flank, scene.mesh())
    assert (bow < 0.0) == (side == "concave")
    assert scene.contact_sides[0] == side
    assert scene.contact_sides[1] != side
    assert scene.flank_names[0] == f"{side} flank of the pinion"
    by_sense = scene.with_changes({"pair.pinion_flank": None, "pair.sense": scene.sense})
    assert by_sense.contact_sides == scene.contact_sides


@pytest.mark.parametrize("hand", ["right", "left"])
def test_hand_turns_the_spiral(spiral, hand):
    mesh = spiral.with_changes({"pinion.hand": hand}).mesh()
    assert_allclose(np.degrees(mesh.pinion.spiral_angle), 35.0 if hand == "right" else -35.0)
    assert mesh.wheel.spiral_angle == -mesh.pinion.spiral_angle


def test_active_starts_are_where_the_tip_of_the_mate_ends(spiral):
    mesh, pair = spiral.mesh(), spiral.pair()
    for start, flank, (cone, _) in zip(
        spiral.active_starts(), (pair.pinion.flank, pair.wheel.flank), mesh.active_cones, strict=True
    ):
        coordinate = flank.profile_coordinate(np.array(50.0 * np.sin(cone)), np.array(50.0 * np.cos(cone))).value
        assert_allclose(coordinate, start, rtol=1e-9)  # the cone angle has lost digits near the base cone


# Forces


def forces(scene, torque=1e5):
    """Label up to the unit -> value [N]."""
    return {row[0].split(" [")[0]: float(row[1]) for row in scene.force_rows([torque])}


@pytest.mark.parametrize(("hand", "flank"), list(itertools.product(["left", "right"], ["concave", "convex"])))
@pytest.mark.parametrize("driving", ["pinion", "wheel"])
def test_forces_are_those_of_the_textbook(spiral, hand, flank, driving):
    """F_ax = F_t (tan(alpha_t) sin(delta) + k tan(beta) cos(delta)), k = +1 on the concave flank; likewise radial."""
    scene = spiral.with_changes({"pinion.hand": hand, "pair.pinion_flank": flank, "pair.driving": driving})
    found, mesh = forces(scene), scene.mesh()
    delta, alpha, beta = mesh.pinion.pitch_angle, np.radians(20.0), np.radians(35.0)
    tangential = 1e5 / (mesh.pinion.mean_cone_distance * np.sin(delta))
    spiral_part = np.tan(beta) * (1.0 if flank == "concave" else -1.0)
    axial = tangential * (np.tan(alpha) * np.sin(delta) + spiral_part * np.cos(delta))
    radial = tangential * (np.tan(alpha) * np.cos(delta) - spiral_part * np.sin(delta))
    digits = {"atol": 0.051}  # one decimal is shown
    assert_allclose(found["mean tangential force F_mt"], tangential, **digits)
    assert_allclose(found["axial force on the pinion, from its apex"], axial, **digits)
    assert_allclose(found["radial force on the pinion, to its axis"], radial, **digits)


def test_forces_balance_at_a_right_shaft_angle(spiral):
    """What pushes the pinion along its axis pulls the wheel towards its own, and the other way round."""
    found = forces(spiral)
    assert_allclose(
        found["axial force on the pinion, from its apex"], found["radial force on the wheel, to its axis"], atol=0.11
    )
    assert_allclose(
        found["axial force on the wheel, from its apex"], found["radial force on the pinion, to its axis"], atol=0.11
    )


def test_replace_checks_again(spiral):
    with pytest.raises(InputError, match=r"wheel\.face_width_mm: found 18"):
        replace(spiral, wheel=replace(spiral.wheel, face_width_mm=18.0))
