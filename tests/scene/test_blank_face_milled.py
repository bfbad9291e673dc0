"""Face-milled scenes given by [pair.blank]: settings by each method, what is asked of the contact, what is refused."""

import math
import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.face_milled import tooth_angle
from loaded_tca.pairs.mean_point import MARKING
from loaded_tca.reference.hertz import point_contact
from loaded_tca.scene import BlankFaceMilledScene, FaceMilledScene, parse_scene, read_scene
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.curvature import relative_curvature
from tests.samples.results import SCENES

EXAMPLE = SCENES / "face_milled_blank.toml"
SHORT = """
[pair]
type = "face_milled"
mean_normal_module_mm = 3.0
spiral_angle_deg = 32.0
[pair.blank]
cutter_radius_mm = 80.0
taper = "modified"
[pair.settings]
method = "local_synthesis"
[pinion]
teeth = 17
face_width_mm = 22.0
[wheel]
teeth = 41
face_width_mm = 22.0
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 150.0
"""


@pytest.fixture(scope="module")
def example():
    return read_scene(EXAMPLE)


def row(scene, label):
    """Cells of a line of the geometry table."""
    return next(cells for name, *cells in scene.geometry_rows() if name.strip() == label)


@pytest.mark.thorough
def test_contact_of_the_scene_is_as_its_settings_ask(example):
    """Second derivative of the motion curve by differences, whose fourth derivative leaves 1e-3; curvature exactly."""
    pair, settings = example.pair(), example.geometry.settings
    step = 0.02 * pair.pitch
    path = trace_contact(pair, np.array([-step, 0.0, step]))
    second = np.diff(path.transmission_error, 2)[0] / step**2
    fall = math.degrees(-second * pair.pitch**2 / 8.0) * 3600.0
    assert_allclose(fall, settings.motion_fall_arcsec, rtol=3e-3)
    length = math.sqrt(8.0 * MARKING / relative_curvature(pair, path[1]).along)
    assert_allclose(length, settings.contact_length_mm, rtol=1e-5)
    asked = settings.motion_fall_arcsec, settings.path_angle_deg, settings.contact_length_mm
    labels = (
        "fall of the motion curve at half a pitch [arcsec]",
        "path of contact from the tooth trace [deg]",
        "length of the contact ellipse, 6.35 um [mm]",
    )
    assert [float(row(example, label)[0]) for label in labels] == [*asked]
    assert row(example, "contact at the mean point, flanks of the pinion") == ["concave", "convex"]


@pytest.mark.thorough
def test_scene_of_few_keys_is_analysed_as_a_hertzian_contact():
    """At the mean point under a small torque, of an ellipse 3 mm long: the asked accuracy of its peak is 1 %."""
    scene = parse_scene(SHORT).with_changes({"load.pinion_torque_Nm": 2.0, "analysis.positions": 1})
    assert isinstance(scene, BlankFaceMilledScene)
    result = analyse(scene.with_changes({"analysis.load_sharing": False}))
    pair = scene.pair()
    curvature = relative_curvature(pair, trace_contact(pair, [0.0])[0])
    hertz = point_contact(float(result.normal_force.max()), (curvature.across, curvature.along), pair.contact_modulus)
    assert_allclose(result.peak_pressure.max(), hertz.max_pressure, rtol=1e-2)
    assert scene.contact_sides == ("concave", "convex")
    assert scene.hands == ("right", "left")


def test_teeth_are_as_thick_as_the_blank_says(example):
    for gear, blank in zip(example.mesh().gears, (example.blanks().pinion, example.blanks().wheel), strict=True):
        rho = 0.5 * blank.pitch_diameters[1]
        z = blank.cone_distances[1] * math.cos(blank.pitch_angle)
        angle = float(tooth_angle(gear, np.array([rho]), np.array([z]))[0])
        assert_allclose(rho * angle * math.cos(blank.spiral_angles[1]), blank.mean_normal_thickness, rtol=1e-9)


@pytest.mark.parametrize("method", ["duplex_spread_blade", "spread_blade"])
def test_basic_settings_are_those_of_the_spiral_bevel_scene(method):
    """A scene of one type is one of the other by its type alone."""
    bevel = read_scene(SCENES / "spiral_bevel_blank.toml")
    scene = bevel.with_changes({"pair.type": "face_milled", "pair.settings": {"method": method}})
    assert isinstance(scene, BlankFaceMilledScene)
    assert scene.cut == bevel.face_milled(method)
    assert scene.blanks() == bevel.blanks()


def test_scene_and_its_file_are_one(example):
    assert parse_scene(example.to_toml()) == example
    assert isinstance(parse_scene(example.cut.to_toml()), FaceMilledScene)


def test_scene_without_its_blank_needs_all_settings(example):
    with pytest.raises(InputError, match=r"pinion\.machine\.radial_mm: missing"):
        example.with_changes({"pair.blank": None})


@pytest.mark.thorough
def test_coast_side_is_the_other_flank_of_the_same_cut(example):
    """What is asked for belongs to the flank that the scene names; the other side of the teeth is cut with it."""
    asked = example.with_changes({"pair.settings.both_flanks": True})
    coast = asked.with_changes({"pair.pinion_flank": "convex", "pair.settings.path_angle_deg": 60.0})
    for scene in (asked, coast):
        contact = [float(cell) for cell in row(scene, "length of the contact ellipse, 6.35 um [mm]")]
        assert_allclose(contact, 10.0, rtol=1e-6)
        path = [float(cell) for cell in row(scene, "path of contact from the tooth trace [deg]")]
        assert_allclose(sum(path), 180.0, rtol=1e-6)


@pytest.mark.thorough
def test_usual_contact_of_the_convex_flank_is_the_mirror_image(example):
    usual = {"pair.settings.path_angle_deg": None, "pair.settings.motion_fall_arcsec": None}
    usual["pair.settings.contact_length_mm"] = None
    paths = [
        row(example.with_changes(usual | {"pair.pinion_flank": flank}), "path of contact from the tooth trace [deg]")[0]
        for flank in ("concave", "convex")
    ]
    assert paths == ["120.000", "60.000"]
    length = row(example.with_changes(usual), "length of the contact ellipse, 6.35 um [mm]")[0]
    assert_allclose(float(length), 0.4 * 25.4, atol=1e-3)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"pair.blank.cutter_radius_mm": None}, "pair.blank.cutter_radius_mm: missing; "),
        ({"pair.spiral_angle_deg": None}, "pair.spiral_angle_deg: missing"),
        (
            {"pair.settings.method": "spread_blade"},
            'pair.settings.motion_fall_arcsec: found 12.0; allowed with method = "local_synthesis" alone',
        ),
        (
            {"pair.settings": {"method": "spread_blade", "cutter_number": 7.0}},
            'pair.settings.cutter_number: found 7; not allowed with method = "spread_blade"',
        ),
        ({"pair.settings.path_angle_deg": 0.0}, "pair.settings.path_angle_deg: found 0.0; allowed a number from 5 to"),
        ({"pair.offset_mm": 15.0}, r"pair.offset_mm: found 15; with \[pair.blank\] axes meet: give the settings of a"),
        ({"pair.settings.methods": "x"}, "pair.settings.methods: unknown key; did you mean .pair.settings.method"),
        (
            {"pair.blank.lengthwise_curve": "cutter_circle"},
            'pair.blank.lengthwise_curve: found "cutter_circle"; not allowed with face-milled gears',
        ),
        ({"pinion.profile_shift": 0.2}, r"pinion.profile_shift: found 0.2; not allowed with \[pair.blank\]"),
    ],
)
def test_what_does_not_fit_is_refused_by_its_key(example, changes, told):
    with pytest.raises(InputError, match=told):
        example.with_changes(changes)


def test_contact_that_cannot_be_is_refused_by_its_section(example):
    scene = example.with_changes({"pair.settings.path_angle_deg": 175.0, "pair.settings.contact_length_mm": 2.0})
    with pytest.raises(GeometryError, match=r"pair\.settings: path_angle_deg: a path at 175 deg .* a path more across"):
        scene.pair()


@pytest.mark.parametrize("method", ["local_synthesis", "duplex_spread_blade"])
def test_unequal_faces_are_cut_about_one_calculation_point(example, method):
    changes = {"pinion.face_width_mm": 27.4, "pair.blank.outer_face_share": 0.45}
    if method != "local_synthesis":
        changes["pair.settings"] = {"method": method}
    scene = example.with_changes(changes)
    pair, blanks = scene.pair(), scene.blanks()
    for gear, blank in ((pair.pinion, blanks.pinion), (pair.wheel, blanks.wheel)):
        rho, z = gear.flank.grid(5, 5)
        distances = np.hypot(rho, z)[2]
        assert_allclose((distances[0], distances[-1]), blank.cone_distances[::2], rtol=1e-9)
    path = trace_contact(pair, [0.0])
    if method == "local_synthesis":  # at the calculation point, not in the middle of either face
        assert_allclose(np.hypot(path.pinion_radius, path.pinion_axial), blanks.mean_cone_distance, rtol=1e-6)
        assert_allclose(path.transmission_error, 0.0, atol=1e-9)
    assert pair.face_width == pytest.approx(25.4)
    assert parse_scene(scene.cut.to_toml()) == scene.cut


def test_internal_bevel_gears_are_refused(example):
    scene = example.with_changes({"pair.shaft_angle_deg": 150.0, "pair.blank.allow_undercut": True})
    with pytest.raises(GeometryError, match=r"wheel: a root angle of 1\d\d\.\d+ deg is that of an internal bevel gear"):
        scene.pair()


def test_blades_rounded_over_more_than_the_slot_are_refused(example):
    scene = example.with_changes({"pair.settings.edge_radius_mm": 1.4})
    with pytest.raises(
        InputError, match=r"pair\.settings\.edge_radius_mm: found 1\.4; allowed up to 1\.3491: both blades"
    ):
        scene.pair()


def test_command_writes_all_settings(run, tmp_path, example):
    code, out, _ = run("settings", EXAMPLE, "--out", tmp_path / "cut.toml")
    assert code == 0
    assert "cut.toml" in out
    assert read_scene(tmp_path / "cut.toml") == example.cut
    code, *_ = run("settings", EXAMPLE, "--method", "spread_blade", "--out", tmp_path / "basic.toml")
    assert code == 0
    basic = read_scene(tmp_path / "basic.toml")
    assert basic.pinion.cutter.number == 0.0
    assert basic.pinion.cutter.concave.edge_radius_mm == 0.5


def test_command_synthesises_settings_of_a_spiral_bevel_scene(run, tmp_path):
    text = (SCENES / "spiral_bevel_blank.toml").read_text(encoding="utf-8")
    file = tmp_path / "blank.toml"
    file.write_text(text.replace("_crowning_um = ", "_crowning_um = 0.0 # "), encoding="utf-8")
    code, *_ = run("settings", file, "--method", "local_synthesis", "--out", tmp_path / "cut.toml")
    assert code == 0
    path = trace_contact(read_scene(tmp_path / "cut.toml").pair(), [0.0])
    assert_allclose(path.transmission_error, 0.0, atol=1e-9)


@pytest.mark.thorough
def test_normals_of_basic_settings_are_told_apart(example):
    """Blades of a group bring both flanks near to each other; a uniform depth has no such settings: degrees apart."""
    basic = {"pair.settings": {"method": "duplex_spread_blade"}}
    label = "normals of both flanks there apart by [arcmin]"
    apart = [
        [float(cell) for cell in row(example.with_changes(changes), label)]
        for changes in ({}, basic, basic | {"pair.blank.taper": "uniform"})
    ]
    assert max(apart[0]) == 0.0
    assert 0.5 < max(apart[1]) < 10.0
    assert max(apart[2]) > 60.0


def test_scene_can_be_sent_to_another_process(example):
    again = pickle.loads(pickle.dumps(example))
    assert again == example
    assert again.cut == example.cut


@pytest.mark.thorough
def test_what_is_cut_and_the_sheet_agree_in_one_name_each(example):
    """s_mn as cut is that of the sheet, what it leaves of the pitch is j_mn over cos(alpha_n); depths stand once."""
    sheet = [float(cell) for cell in row(example, "mean normal thickness s_mn [mm]")]
    cut = [float(cell) for cell in row(example, "normal tooth thickness s_mn as cut [mm]")]
    assert_allclose(cut, sheet, rtol=1e-3)  # the spiral angles of both flanks differ, their mean is 0.05 deg off 35 deg
    (left,) = (float(cell) for cell in row(example, "normal pitch at R_m less both s_mn [mm]"))
    (backlash, _) = (float(cell) for cell in row(example, "backlash j_mn, j_mt2 at R_m [mm]"))
    assert_allclose(left * math.cos(math.radians(20.0)), backlash, atol=2e-4)
    labels = [one[0] for one in example.geometry_rows() if one[0]]
    assert len({*labels}) == len(labels)
    assert not any(label.startswith("mean addendum") for label in labels)


def test_a_flank_that_does_not_carry_at_the_mean_point_is_told(example):
    assert row(example, "they carry there, not at their edges alone") == ["yes", "yes"]
    changes = {
        "pair.wheel_outer_diameter_mm": None,
        "pair.outer_module_mm": 5.2,
        "pair.spiral_angle_deg": 32.0,
        "pair.blank.taper": "modified",
        "pair.settings.motion_fall_arcsec": 15.0,
        "pair.settings.path_angle_deg": 70.0,
        "pair.settings.contact_length_mm": 12.0,
        "pinion.teeth": 12,
        "wheel.teeth": 43,
        "pinion.face_width_mm": 34.0,
        "wheel.face_width_mm": 34.0,
    }
    steep = example.with_changes(changes)
    assert row(steep, "they carry there, not at their edges alone") == ["yes", "no"]
    assert row(steep, "fall of the motion curve at half a pitch [arcsec]")[1] == "none"
