"""The scene itself: defaults, canonical text, functional changes, and the pair that it builds."""

import pickle
from dataclasses import FrozenInstanceError, fields, replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.material import Material
from loaded_tca.scene import (
    Analysis,
    CylindricalScene,
    ElasticMaterial,
    Load,
    Modifications,
    Scene,
    parse_scene,
    read_scene,
    scene_from_table,
)
from loaded_tca.scene import section as sections
from loaded_tca.scene.build import in_base_units
from loaded_tca.scene.cylindrical import GearSection, Geometry, MountingErrors
from loaded_tca.unloaded import trace_contact
from tests.refusals import refused_calls
from tests.samples.gear_pairs import transmission_error_at

ROOT = Path(__file__).parents[2]

SCENES = ROOT / "examples" / "scenes"
ROUNDING = 1e-14  # one multiplication by a unit
DRIVES = [
    ("pinion", "positive", 1),
    ("pinion", "negative", -1),
    ("wheel", "positive", -1),
    ("wheel", "negative", 1),
]
"""Driving gear, sense, and the flanks in contact: s = +1 or -1."""

EVERY_KEY = {
    "title": 'Naïve "quoted" \\ title, 5 µm, ∞',
    "pair.pressure_angle_deg": 17.5,
    "pair.centre_distance_mm": 142.0,
    "pair.driving": "wheel",
    "pair.sense": "negative",
    "pair.dedendum_coefficient": 1.4,
    "pair.root_radius_coefficient": 0.25,
    "pinion.hand": "left",
    "wheel.hand": "right",
    "pinion.profile_shift": 0.1 + 0.2,
    "pinion.tip_diameter_mm": 111.6,
    "pinion.bore_diameter_mm": 40.0,
    "pinion.modifications.lead_crowning_um": 5.0,
    "pinion.modifications.lead_crowning_form": "logarithmic",
    "pinion.modifications.end_relief_um": 4.0,
    "pinion.modifications.end_relief_length_mm": 3.0,
    "pinion.modifications.end_relief_lower_um": 0.0,
    "pinion.modifications.end_relief_lower_length_mm": 2.5,
    "pinion.modifications.end_relief_upper_um": 6.0,
    "pinion.modifications.end_relief_upper_length_mm": 4.5,
    "pinion.modifications.profile_crowning_um": 2.0,
    "pinion.modifications.tip_relief_um": 20.0,
    "pinion.modifications.tip_relief_start_mm": 109.0,
    "pinion.modifications.tip_relief_form": "linear",
    "pinion.modifications.root_relief_um": 10.0,
    "pinion.modifications.root_relief_start_mm": 103.0,
    "pinion.modifications.root_relief_form": "linear",
    "pinion.modifications.helix_slope_um": -3.0,
    "pinion.modifications.profile_slope_um": -2.0,
    "pinion.modifications.twist_um": -4.0,
    "pinion.modifications.polynomial_mm": [1e-3, -2e-4, 0, 1e-5, 1e-4, 2e-3],
    "pinion.flank.form": "bspline",
    "pinion.flank.points": [21, 25],
    "pinion.flank.degree": 3,
    "wheel.modifications.tip_relief_um": 12.0,
    "wheel.modifications.tip_relief_start_roll_deg": 24.5,
    "wheel.modifications.root_relief_um": 8.0,
    "wheel.modifications.root_relief_start_length_mm": 29.0,
    "pinion.material.youngs_modulus_MPa": 210000,
    "pinion.material.poisson_ratio": 0.28,
    "pinion.material.max_pressure_MPa": 4000,
    "mounting.in_plane_deg": 0.01,
    "mounting.out_of_plane_deg": -0.02,
    "mounting.centre_distance_error_mm": 0.03,
    "mounting.axial_offset_mm": -1e-7,
    "mounting.misalignment_um": -15.0,
    "analysis.positions": 1,
    "analysis.accuracy": 1e-2,
    "analysis.cells": [32, 64],
    "analysis.tolerance": 1e-8,
    "analysis.torques_Nm": [0, 20, 130.5],
}


def test_defaults_are_those_of_the_documentation(scene):
    assert scene.geometry.pressure_angle_deg == 20.0
    assert scene.geometry.centre_distance_mm is None
    assert (scene.geometry.driving, scene.geometry.sense) == ("pinion", "positive")
    assert (scene.geometry.dedendum_coefficient, scene.geometry.root_radius_coefficient) == (1.25, 0.38)
    assert scene.pinion.modifications == Modifications()
    assert scene.mounting == MountingErrors()
    assert scene.analysis == Analysis(
        positions=21,
        accuracy=1e-2,
        cells=None,
        tolerance=1e-6,
        load_sharing=True,
        compliance="contact+tooth",
        free_edges=True,
    )


def test_cells_stand_beside_the_accuracy_that_they_override(small):
    analysis = parse_scene(small + "[analysis]\naccuracy = 1e-2\ncells = [32, 16]").analysis
    assert (analysis.accuracy, analysis.cells) == (1e-2, (32, 16))


def test_whole_numbers_become_floats_where_floats_are_meant(scene):
    assert isinstance(scene.geometry.normal_module_mm, float)
    assert isinstance(scene.pinion.teeth, int)


def test_numpy_numbers_become_plain_ones(scene):
    changed = scene.with_changes({"pinion.teeth": np.int64(35), "load.pinion_torque_Nm": np.float32(0.5)})
    assert type(changed.pinion.teeth) is int
    assert type(changed.load.pinion_torque_Nm) is float


def test_zero_torque_is_allowed(scene):
    assert scene.with_changes({"load.pinion_torque_Nm": 0}).torques == (0.0,)


def test_torques_are_the_one_of_the_load_unless_listed(scene):
    assert scene.torques == (130000.0,)
    assert scene.with_changes({"analysis.torques_Nm": [20.0, 130]}).torques == (20000.0, 130000.0)


def test_hands_are_opposite(scene):
    assert scene.hands[0] == "right"
    assert scene.with_changes({"pinion.hand": "left"}).hands[0] == "left"
    assert scene.with_changes({"wheel.hand": "right"}).hands[0] == "left"
    assert scene.with_changes({"wheel.hand": "left"}).hands[0] == "right"


def test_hand_of_a_spur_gear_has_no_meaning(scene):
    spur = scene.with_changes({"pair.helix_angle_deg": 0.0, "pinion.hand": "left"})
    assert spur.mesh().pinion.helix_angle == spur.mesh().wheel.helix_angle == 0.0


def test_own_material_overrides_the_common_one(scene):
    brass = ElasticMaterial(youngs_modulus_MPa=1e5, poisson_ratio=0.35)
    changed = replace(scene, wheel=replace(scene.wheel, material=brass))
    assert changed.materials == (scene.material, brass)
    each = replace(changed, pinion=replace(scene.pinion, material=brass), material=None)
    assert each.materials == (brass, brass)


@pytest.mark.parametrize("name", ["helical", "straight_bevel", "face_milled_19x62"])
def test_each_gear_of_a_pair_has_the_material_of_its_section(name):
    brass = {"youngs_modulus_MPa": 1e5, "poisson_ratio": 0.35}
    pair = read_scene(SCENES / f"{name}.toml").with_changes({"wheel.material": brass}).pair()
    assert (pair.pinion.material, pair.wheel.material) == (Material(206000.0, 0.3), Material(1e5, 0.35))


def test_text_of_the_smallest_scene_has_every_key(scene):
    text = scene.to_toml()
    for section in (Geometry, GearSection, Modifications, MountingErrors, ElasticMaterial, Load, Analysis):
        for field in fields(section):
            assert field.name in text


def test_text_makes_the_same_scene(scene):
    assert parse_scene(scene.to_toml()) == scene


def test_text_with_every_key_set_makes_the_same_scene(scene):
    full = scene.with_changes(EVERY_KEY)
    again = parse_scene(full.to_toml())
    assert again == full
    assert hash(again) == hash(full)
    assert again.to_toml() == full.to_toml()


def test_scene_survives_pickling(scene):
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_type_picks_the_family(scene):
    assert type(scene) is CylindricalScene
    assert isinstance(scene, Scene)


def test_sections_made_already_are_taken_from_a_table(scene, table):
    made = {"pair": scene.geometry, "pinion": scene.pinion, "load": scene.load}
    assert scene_from_table({**table, **made}) == scene


def test_scene_is_frozen(scene):
    with pytest.raises(FrozenInstanceError):
        scene.pinion.teeth = 3


def test_replace_may_leave_a_default(scene):
    assert replace(scene, mounting=MountingErrors(in_plane_deg=1.0)).mounting.in_plane_deg == 1.0


def test_changes_leave_the_scene_as_it_is(scene):
    changed = scene.with_changes({"pinion.teeth": 35})
    assert (scene.pinion.teeth, changed.pinion.teeth) == (34, 35)
    assert changed.with_changes({"pinion.teeth": 34}) == scene


def test_sections_without_a_change_are_not_checked_again(scene, monkeypatch):
    checked, check = [], sections.check
    monkeypatch.setattr(sections, "check", lambda kind, *rest: checked.append(kind.__name__) or check(kind, *rest))
    changed = scene.with_changes({"pinion.modifications.lead_crowning_um": 5.0})
    assert set(checked) == {"CylindricalScene", "GearSection", "Modifications"}
    assert changed.wheel is scene.wheel
    assert changed.pinion.flank is scene.pinion.flank


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pinion.teth": 35}, 'pinion.teth: unknown key; did you mean "pinion.teeth"?'),
        ({"pinion.teeth.number": 35}, "pinion.teeth: found a table; allowed a whole number"),
        ({"pinion.teeth": None}, "pinion.teeth: missing"),
        ({"analysis.cells": (8, 0)}, "analysis.cells: found [8, 0]"),
    ],
)
def test_changes_are_checked(scene, changes, message):
    with pytest.raises(InputError) as raised:
        scene.with_changes(changes)
    assert str(raised.value).startswith(message)


@pytest.mark.parametrize(("driving", "sense", "side"), DRIVES)
def test_misalignment_is_the_parting_in_the_plane_of_action_over_the_common_face(scene, driving, sense, side):
    """First touch of each transverse section, as a length on the line of action: flanks s = +1 close at z > 0."""
    pair = scene.with_changes(
        {"mounting.misalignment_um": 20.0, "pair.driving": driving, "pair.sense": sense, "pair.helix_angle_deg": 0.0}
    ).pair()
    rho = np.linspace(49.5, 53.0, 2001)  # of the pinion, about its pitch circle of 51 mm

    def first_touch(z):
        error, _ = transmission_error_at(pair, 0.0, rho, np.full_like(rho, z))
        return (pair.driving * error).max()

    # over 18 of the 20 mm that both faces cover; the rest is of second order in an angle of 1e-3
    parting = pair.base_radii[1] * (first_touch(9.0) - first_touch(-9.0))
    assert_allclose(parting, side * 0.02 * 18.0 / 20.0, rtol=1e-3)


def test_misalignment_adds_to_the_out_of_plane_error(scene):
    """Helical pair without profile shift: tan(alpha_wt) = tan 20/cos 15, b = 20 mm."""
    alpha = np.arctan(np.tan(np.deg2rad(20.0)) / np.cos(np.deg2rad(15.0)))
    errors = {"mounting.out_of_plane_deg": 0.01, "mounting.in_plane_deg": 0.02, "mounting.misalignment_um": -30.0}
    pair = scene.with_changes(errors).pair()
    tilt = np.deg2rad(0.01) - 0.03 / (20.0 * np.cos(alpha))
    assert_allclose(pair.wheel_axes[2, 1], -np.sin(tilt), rtol=1e-9)  # alpha_wt comes from a square root
    assert_allclose(pair.wheel_axes[2, 0], np.sin(np.deg2rad(0.02)) * np.cos(tilt), rtol=1e-9)


def test_units_are_converted_by_the_end_of_the_key():
    modifications = in_base_units(Modifications(tip_relief_um=20.0, tip_relief_start_mm=109.0))
    assert_allclose(modifications["tip_relief"], 0.02, rtol=ROUNDING)
    assert modifications["tip_relief_start"] == 109.0
    assert modifications["tip_relief_form"] == "parabolic"
    assert "end_relief_lower" not in modifications  # not given: as at both ends
    starts = in_base_units(Modifications(tip_relief_start_roll_deg=18.0, root_relief_start_length_mm=17.0))
    assert_allclose(starts["tip_relief_start_roll"], 0.1 * np.pi, rtol=ROUNDING)
    assert starts["root_relief_start_length"] == 17.0
    assert_allclose(in_base_units(MountingErrors(in_plane_deg=9.0))["in_plane"], np.pi / 20, rtol=ROUNDING)
    assert in_base_units(Load(pinion_torque_Nm=2.0)) == {"pinion_torque": 2000.0}


def test_mesh_has_the_geometry_of_the_scene(scene):
    mesh = scene.with_changes(EVERY_KEY).mesh()
    assert (mesh.pinion.teeth, mesh.wheel.teeth) == (34, 57)
    assert (mesh.pinion.name, mesh.wheel.name) == ("pinion", "wheel")
    assert mesh.pinion.helix_angle == -mesh.wheel.helix_angle == -np.deg2rad(15.0)
    assert_allclose(mesh.pinion.pressure_angle, np.deg2rad(17.5), rtol=ROUNDING)
    assert mesh.pinion.profile_shift == 0.1 + 0.2
    assert (mesh.pinion.tip_diameter, mesh.wheel.tip_diameter) == (111.6, None)
    assert (mesh.pinion.face_width, mesh.wheel.face_width) == (25.0, 20.0)
    assert (mesh.pinion.dedendum_coefficient, mesh.wheel.root_radius_coefficient) == (1.4, 0.25)
    assert mesh.pinion.bore_diameter == 40.0
    assert mesh.centre_distance == 142.0


def test_pair_stands_where_the_scene_puts_it(scene):
    pair = scene.with_changes(
        {
            "pair.driving": "wheel",
            "pair.sense": "negative",
            "mounting.centre_distance_error_mm": 0.5,
            "mounting.axial_offset_mm": 0.25,
            "wheel.material": {"youngs_modulus_MPa": 1e5, "poisson_ratio": 0.25, "max_pressure_MPa": 900.0},
        }
    ).pair()
    assert pair.teeth == (34, 57)
    assert (pair.driving, pair.sense) == (-1, -1)
    centre_distance = scene.mesh().working_centre_distance
    assert_allclose(pair.wheel_origin, [centre_distance + 0.5, 0.0, 0.25], rtol=ROUNDING)
    assert [gear.material.youngs_modulus for gear in (pair.pinion, pair.wheel)] == [206000.0, 1e5]
    assert pair.max_pressure == 900.0


@pytest.mark.parametrize(
    ("error", "axis"),
    [("in_plane_deg", [1.0, 0.0]), ("out_of_plane_deg", [0.0, -1.0])],
)
def test_pair_tilts_the_axis_of_the_wheel_as_defined(scene, error, axis):
    pair = scene.with_changes({f"mounting.{error}": 1.0}).pair()
    tilt = np.deg2rad(1.0)
    assert_allclose(pair.wheel_axes[2], [*np.sin(tilt) * np.array(axis), np.cos(tilt)], atol=ROUNDING)


@pytest.mark.parametrize(("member", "other"), [("pinion", "wheel"), ("wheel", "pinion")])
def test_pair_has_the_modifications_of_each_gear(scene, member, other):
    nominal, crowned = scene.pair(), scene.with_changes({f"{member}.modifications.lead_crowning_um": 5.0}).pair()
    rho, z = np.array([scene.mesh().pinion_working_radius, scene.mesh().wheel_working_radius]), 10.0
    radius = rho[0] if member == "pinion" else rho[1]
    flank = getattr(crowned, member).flank
    removed = getattr(nominal, member).flank.theta(radius, z).value - flank.theta(radius, z).value
    width = {"pinion": 25.0, "wheel": 20.0}[member]
    expected = 5e-3 * (2 * z / width) ** 2 * flank.gradient_norm(radius, z).value
    assert_allclose(np.abs(removed), expected, rtol=1e-9)
    assert getattr(crowned, other).flank.theta(radius, z).value == getattr(nominal, other).flank.theta(radius, z).value


test_scene_model_refuses = refused_calls(
    (Scene, "abstract", TypeError),
    (lambda scene: replace(scene.pinion, teeth=2), r"^teeth: found 2; allowed a whole number from 3 to 10000$"),
    (lambda scene: replace(scene, material=None), r"^material: missing"),
    (lambda scene: replace(scene, wheel=scene.mounting), r"^wheel: found .*; allowed a section \[wheel\]$"),
    (
        lambda scene: scene.with_changes({"mounting.misalignment_um": -1e4, "wheel.face_width_mm": 5.0}).pair(),
        r"^mounting.misalignment_um: found -10000; over the common face width of 5 mm .* -122.5, allowed up to 45$",
    ),
    (lambda scene: scene.with_changes({"pinion.bore_diameter_mm": 104.0}).pair(), "pinion: bore_diameter"),
)


def test_fzg_example_has_its_published_geometry():
    mesh = read_scene(SCENES / "fzg_c14.toml").mesh()
    # Published: 22.43934 deg, which follows from the profile shifts; the rounded 91.5 mm gives 22.43879 deg.
    assert_allclose(np.rad2deg(mesh.working_pressure_angle), 22.43934, rtol=0, atol=6e-4)
    # published to 2 decimals of a mm, 2 decimals of a contact ratio
    assert_allclose(mesh.path_of_contact.AE, 19.43, rtol=0, atol=0.5e-2)
    assert_allclose(mesh.transverse_contact_ratio, 1.46, rtol=0, atol=0.5e-2)


@pytest.mark.parametrize("name", ["spur", "helical", "fzg_c14", "misaligned"])
def test_example_makes_a_pair_and_holds_the_pitch_point(name):
    scene = read_scene(SCENES / f"{name}.toml")
    assert scene.pair().teeth == (scene.pinion.teeth, scene.wheel.teeth)
    assert scene.analysis.positions % 2 == 1


def test_incompressible_material_of_either_gear_is_refused_where_teeth_bend_only(scene):
    own = {"youngs_modulus_MPa": 10.0, "poisson_ratio": 0.5}
    assert scene.with_changes({"wheel.material": own, "analysis.compliance": "contact"}).pair().wheel
    with pytest.raises(InputError, match=r"^wheel.material.poisson_ratio: found 0.5; allowed up to 0.49 with"):
        scene.with_changes({"wheel.material": own, "analysis.compliance": "contact+tooth"})
    soft = scene.with_changes({"wheel.material": own | {"poisson_ratio": 0.49}, "analysis.compliance": "contact+tooth"})
    assert soft.materials[1].poisson_ratio == 0.49


@pytest.mark.parametrize("name", ["helical", "spiral_bevel", "duplex_30x20"])
@pytest.mark.parametrize("sense", ["x", "", 1, True])
def test_sense_that_is_none_is_refused_by_every_family(name, sense):
    with pytest.raises(InputError, match=r"^sense: .* is not 'positive' or 'negative'$"):
        read_scene(SCENES / f"{name}.toml").pair(sense)


def test_misaligned_example_touches_at_the_edge_of_the_face():
    path = trace_contact(read_scene(SCENES / "misaligned.toml").pair())
    assert path.on_edge.all()
    assert_allclose(path.pinion_axial, 12.5, atol=0.01)  # the tilted wheel ends up to 0.006 mm earlier


def test_misaligned_example_has_the_misalignment_of_its_comment():
    scene = read_scene(SCENES / "misaligned.toml")
    other = scene.with_changes({"mounting.out_of_plane_deg": 0.0, "mounting.misalignment_um": 32.8})
    assert_allclose(other.pair().wheel_axes, scene.pair().wheel_axes, atol=1e-6)  # 25 mm tan(0.08 deg) cos(20 deg)


@pytest.mark.parametrize(
    "changes", [{"mounting.out_of_plane_deg": 0.02}, {"pinion.modifications.lead_crowning_um": 20.0}]
)
def test_misaligned_example_stays_on_the_face_as_its_comment_says(changes):
    path = trace_contact(read_scene(SCENES / "misaligned.toml").with_changes(changes).pair())
    assert not path.on_edge.any()
    assert_allclose(path.pinion_axial, 5.1, atol=0.05)
