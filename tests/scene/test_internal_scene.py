"""Scenes of internal pairs: which class a file becomes, its geometry, its refusals."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, parse_scene
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.reference.iso6336_3 import root_section
from loaded_tca.results.gear_warnings import warn_of_gears
from loaded_tca.scene import CylindricalScene, InternalScene, describe_keys, read_scene
from tests.refusals import refused_calls
from tests.samples.internal_pairs import SCENE
from tests.samples.results import SCENES


@pytest.fixture(scope="module")
def scene():
    return parse_scene(SCENE)


def changed(**keys):
    return parse_scene(SCENE).with_changes({name.replace("__", "."): value for name, value in keys.items()})


def test_negative_number_of_teeth_makes_an_internal_scene(scene):
    assert type(scene) is InternalScene
    assert scene.pair().teeth == (25, 60)
    assert parse_scene(scene.to_toml()) == scene


def test_change_of_the_sign_changes_the_class_of_the_scene(scene):
    external = scene.with_changes({"wheel.teeth": 60, "wheel.tip_diameter_mm": None})
    assert type(external) is CylindricalScene
    assert type(external.with_changes({"wheel.teeth": -60})) is InternalScene
    assert type(scene.with_changes({"load.pinion_torque_Nm": 10.0})) is InternalScene


def test_hand_of_either_gear_is_that_of_both(scene):
    assert scene.hands == ("right", "right")
    assert changed(wheel__hand="left").hands == ("left", "left")
    mesh = changed(pinion__hand="left").mesh()
    assert mesh.pinion.helix_angle == mesh.ring.helix_angle < 0.0


def test_missing_shift_is_what_leaves_no_backlash():
    given = changed(pair__centre_distance_mm=53.0)
    assert_allclose(given.mesh().backlash, 0.0, atol=1e-9)
    assert given.mesh().pinion.profile_shift == 0.3
    assert given.mesh().ring.profile_shift != 0.0


def test_geometry_table_has_the_three_interferences_and_the_outside(scene):
    rows = {row[0]: row[1:] for row in scene.geometry_rows()}
    assert rows["teeth z"] == ("25", "-60")
    assert rows["profile shift x"] == ("0.3000", "0.0000")
    for name in ("involute interference: ring's tip to T1 [mm]", "overlap interference at the tips [mm]"):
        assert rows[name][0].endswith("free")
    assert "radial assembly [mm]" in rows
    assert rows["outer diameter of the ring [mm]"][1] == f"{2.0 * scene.mesh().ring.outer_radius:.4f}"
    assert float(rows["tip diameter d_a [mm]"][1]) == 181.5


def test_radial_assembly_that_is_not_possible_is_a_note():
    rows = {
        row[0]: row[1:]
        for row in changed(wheel__teeth=-35, wheel__tip_diameter_mm=104.5, pinion__profile_shift=0.0).geometry_rows()
    }
    assert rows["radial assembly [mm]"][0].endswith("overlap: along the axis only")


def test_radial_assembly_says_how_the_pinion_has_to_stand():
    pair = {"pair.helix_angle_deg": 0.0, "pinion.profile_shift": 0.0, "pinion.teeth": 30, "wheel.tip_diameter_mm": None}
    for teeth, words in (
        (-46, "free.*, with a space of the pinion towards.* 0.0100 overlap"),
        (-47, "free.*mesh alone$"),
    ):
        scene = parse_scene(SCENE).with_changes({**pair, "wheel.teeth": teeth})
        rows = {row[0]: row[1:] for row in scene.geometry_rows()}
        assert re.search(words, rows["radial assembly [mm]"][0])


def test_cutter_shapes_the_fillet():
    assert changed(wheel__cutter={"teeth": 20}).mesh().ring.cutter.teeth == 20
    assert changed(wheel__cutter={"teeth": 20}).mesh().ring.form_radius != parse_scene(SCENE).mesh().ring.form_radius


def test_nominal_stresses_and_stiffness_of_the_nrel_stage_are_those_that_kisssoft_prints():
    """Planet and ring of stage 2, F_t 285900 N; stiffness with C_R 0.862, printed with three digits."""
    scene = read_scene(SCENES / "planet_ring.toml")
    torque, standard = 285900.438 * 378.0, scene.contact_standard
    # contact ratio and diameters are printed with four and six digits
    assert_allclose(standard.stress_per_root_torque * torque**0.5, 312.44, atol=1e-2)
    assert_allclose(torque * np.array(scene.nominal_root_stress), [61.98, 69.12], atol=2e-2)
    assert_allclose(0.862 * standard.single_stiffness, 14.053, rtol=6e-4)
    assert_allclose(0.862 * standard.mesh_stiffness, 20.563, rtol=6e-4)
    assert_allclose(standard.contact_ratio, 0.891, atol=5e-4)
    assert_allclose(scene.tooth_height_over_width, 47.250 / 550.0, rtol=1e-4)


def test_root_section_of_a_ring_without_cutter_has_its_arcs():
    ring = changed(wheel__root_diameter_mm=None).mesh().ring
    section = changed(wheel__root_diameter_mm=None).root_sections[1]
    rack = root_section(
        ring.teeth, ring.profile_shift, 2.0 * ring.tip_radius / ring.normal_module,
        changed().mesh().transverse_contact_ratio, helix_angle=ring.helix_angle,
        root_radius_coefficient=ring.fillet_radius / ring.normal_module,
    )  # fmt: skip
    assert_allclose([section.thickness, section.radius], [rack.thickness, rack.radius], rtol=1e-12)  # rounding


def test_teeth_apart_make_the_centre_distance_smaller():
    scene = changed(mounting__centre_distance_error_mm=0.2)
    assert_allclose(scene.pair().wheel_origin[0], 0.2 - scene.mesh().working_centre_distance)
    assert list(scene.interferences()) == []


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
def test_load_is_shared_and_teeth_bend(scene):
    result = analyse(scene)
    assert_allclose(result.load_share.sum(axis=-1), 1.0, rtol=1e-6)
    assert (result.transmission_error < 0.0).all()
    stiff = analyse(scene.with_changes({"analysis.compliance": "contact"}))
    assert (abs(stiff.transmission_error) < abs(result.transmission_error)).all()


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
def test_thicker_rim_held_outside_gives_way_more():
    thin, thick = (analyse(changed(wheel__outer_diameter_mm=d, analysis__positions=1)) for d in (205.0, 300.0))
    assert abs(thick.transmission_error[0, 0]) > abs(thin.transmission_error[0, 0])


test_bad_scenes_are_refused = refused_calls(
    (lambda: changed(wheel__teeth=-25), "wheel.teeth: found -25; allowed below -25"),
    (lambda: changed(wheel__teeth=-2), "wheel.teeth: found -2; allowed a whole number from -10000 to -3"),
    (lambda: changed(pinion__teeth=-25), "pinion.teeth: found -25; allowed a whole number from 3 to 10000"),
    (lambda: changed(wheel__bore_diameter_mm=20.0), "wheel.bore_diameter_mm: found 20; a ring gear has no bore"),
    (lambda: changed(wheel__hand="left", pinion__hand="right"), 'wheel.hand: found "left" and "right" of the pinion'),
    (lambda: changed(wheel__outer_diameter_mm=150.0), "tip_diameter_mm: found 181.5; allowed up to outer_diameter_mm"),
    (
        lambda: changed(wheel__modifications={"tip_relief_um": 5.0, "tip_relief_start_mm": 180.0}),
        "tip_relief_start_mm: found 180; allowed from tip_diameter_mm = 181.5 on: a ring's tip lies inside",
    ),
    (lambda: changed(wheel__cutter={"teeth": 70}).pair(), "cutter.teeth: 70 is not below 60"),
    (lambda: changed(wheel__cutter={"teeth": 70, "shift": 1}), "wheel.cutter.shift: unknown key"),
    (
        lambda: warn_of_gears(changed(wheel__outer_diameter_mm=195.0), changed(wheel__outer_diameter_mm=195.0).pair()),
        "outer_diameter_mm: 195 mm is not between",
    ),
)

test_gears_that_cannot_mesh_are_refused = refused_calls(
    (lambda: changed(wheel__tip_diameter_mm=176.0, pinion__profile_shift=0.0).pair(), "involute interference"),
    (lambda: changed(pair__centre_distance_mm=40.0).pair(), "centre_distance_mm: 40 mm is not above"),
    (
        lambda: changed(wheel__teeth=-30, wheel__tip_diameter_mm=88.0, pinion__profile_shift=0.0).interferences(),
        "overlap interference",
    ),
    error=GeometryError,
)


def test_reference_of_keys_describes_the_ring():
    text = describe_keys()
    assert "### `[wheel]`: the ring gear (an internal pair: `wheel.teeth` is negative)" in text
    assert "### `[wheel.cutter]`" in text
    assert "`outer_diameter_mm`" in text


def test_every_problem_of_a_ring_is_told():
    with pytest.raises(InputError) as caught:
        parse_scene(SCENE.replace("teeth = -60", "teeth = -60\nouter_diameter_mm = -1.0\nbore_diameter_mm = 5.0"))
    assert len(caught.value.problems) == 2


def test_pitch_deviations_of_a_ring_are_as_many_as_its_teeth():
    assert changed(wheel__pitch={"index_um": [0.0] * 59 + [2.0]}).has_pitch_deviations
    with pytest.raises(InputError, match="found 25 values; allowed 60"):
        changed(wheel__pitch={"index_um": [0.0] * 24 + [2.0]})
    tolerances = changed().pitch_tolerances(1, 6)
    assert 0.0 < tolerances[0] < tolerances[1]
