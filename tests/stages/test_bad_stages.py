"""Stage files that cannot be analysed: one sentence each, in the words of the stage."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.results import MeshCycle
from loaded_tca.results.files import read_dataset, write_dataset
from loaded_tca.scene import read_scene
from loaded_tca.stages import StageResult, parse_stage
from tests.refusals import refused_calls
from tests.samples.stages import analysed

EXAMPLES = Path(__file__).parents[2] / "examples" / "stages"
TEXT = (EXAMPLES / "helical_automotive.toml").read_text(encoding="utf-8")
WITHOUT_PINS = {"stage__pin_tangential_um": None}


def changed(**keys):
    return parse_stage(TEXT).with_changes({name.replace("__", "."): value for name, value in keys.items()})


def test_changes_of_a_section_and_its_keys_leave_the_given_section_alone():
    section = {"sun_speed_rpm": 100.0}
    stage = changed(operation=section, operation__application_factor=1.2)
    assert stage.operation.application_factor == 1.2
    assert section == {"sun_speed_rpm": 100.0}


def meshes(**keys):
    return changed(**keys).meshes


def on_angles(*angles, **keys):
    return changed(stage__planets=None, stage__planet_angles_deg=angles, **WITHOUT_PINS, **keys)


test_bad_stage_is_refused = refused_calls(
    (lambda: changed(load__sun_torque_Nm=0.0, analysis__torques_Nm=None), "load.sun_torque_Nm: found 0; allowed above"),
    (lambda: changed(analysis__torques_Nm=[0.0, 10.0]), "analysis.torques_Nm: found 0; allowed above 0: a stage"),
    (
        lambda: changed(sun__pitch__runout_um=10.0),
        "sun.pitch: found a section; not allowed: teeth of a stage are alike",
    ),
    (lambda: changed(sun__shaft__start_mm=0.0), r"^sun\.shaft: found a section; not allowed: [^\n]*$"),  # nor its keys
    (
        lambda: changed(rating={"required_flank_safety": 1.0, "required_root_safety": 1.4}),
        "rating.life_hours: missing; needed unless load cases have hours",
    ),
    (
        lambda: on_angles(0.0, 90.0, 172.8),
        "stage.planet_angles_deg: found planets on one side of a floating sun.*187.2 deg",
    ),
    (lambda: parse_stage('stage = "wind_spur.toml"'), "not a stage but a study of wind_spur.toml"),
    (lambda: read_scene(EXAMPLES / "wind_spur.toml"), "not the scene of a pair but a planetary stage; run it with"),
    (lambda: meshes(sun__bore_diameter_mm=60.0), "sun: bore_diameter_mm: 60 mm is not below"),
    (lambda: meshes(planet__tip_diameter_mm=60.0), "planet: the tip circle, diameter 60.0000 mm", GeometryError),
    (lambda: meshes(ring__tip_diameter_mm=90.0), "ring: the tip circle, diameter 90.0000 mm", GeometryError),
)


def test_planets_all_around_may_hold_a_floating_sun():
    assert len(on_angles(0.0, 90.0, 180.0).stage.angles) == 3
    assert len(on_angles(0.0, 90.0, 172.8, stage__floating_sun=False).stage.angles) == 3


def test_file_of_a_flank_lies_beside_the_stage():
    outside = TEXT.replace(
        "[planet.modifications]", '[planet.flank]\nform = "measured"\nfile = "/etc/x.csv"\n[planet.modifications]'
    )
    with pytest.raises(InputError, match=r"planet.flank.file: found .*; allowed a file in the folder"):
        parse_stage(outside)


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    result, given = analysed()
    place = tmp_path_factory.mktemp("stage")
    result.save(place)
    return place, result, given


def test_warnings_name_their_mesh(saved):
    _, result, given = saved
    names = {sentence.partition(":")[0] for sentence in result.warnings}
    assert names <= {"sun (pinion) and planet (wheel)", "planet (pinion) and ring (wheel)"}
    assert given
    assert given == list(result.warnings)


def test_files_that_are_no_stage_are_refused(saved, tmp_path):
    place, _, _ = saved
    assert StageResult.load(place / "stage.nc").stage.title
    shutil.copytree(place, tmp_path, dirs_exist_ok=True)
    with pytest.raises(InputError, match=r"a planetary stage, not the result of a mesh cycle"):
        MeshCycle.load(place / "stage.nc")
    shutil.copy(place / "ring_mesh.nc", tmp_path / "sun_mesh.nc")
    with pytest.raises(InputError, match=r"sun_mesh.nc: the mesh cycle of another stage than stage.nc"):
        StageResult.load(tmp_path)
    file = read_dataset(place / "stage.nc")
    lacking = file.drop_attrs(deep=False).assign_attrs(kind="stage")
    write_dataset(tmp_path / "stage.nc", lacking)
    with pytest.raises(InputError, match=r"stage.nc: not the result of a stage"):
        StageResult.load(tmp_path)
    write_dataset(tmp_path / "stage.nc", file.drop_vars("planet_share"))
    with pytest.raises(InputError, match=r"planet_share: missing"):
        StageResult.load(tmp_path)
    write_dataset(tmp_path / "stage.nc", file.isel(planet=[0, 1]))
    with pytest.raises(InputError, match=r"planet: expected 4"):
        StageResult.load(tmp_path)


def test_mesh_cycles_are_those_of_a_stage_by_the_shifts_of_their_gears(saved, tmp_path):
    """The sun's shift, 0, may be given or not; a planet with another one is another planet."""
    place, result, _ = saved
    for shifts in ({"pinion.profile_shift": None}, {"wheel.profile_shift": 0.21}):
        scene = result.sun_mesh.scene.with_changes(shifts)
        shutil.copytree(place, tmp_path / "stage", dirs_exist_ok=True)
        replace(result.sun_mesh, scene=scene).save(tmp_path / "stage" / "sun_mesh.nc")
        if scene.pinion.profile_shift is None:
            assert StageResult.load(tmp_path / "stage").sun_mesh.scene == scene
        else:
            with pytest.raises(InputError, match=r"sun_mesh.nc: the mesh cycle of another stage than stage.nc"):
                StageResult.load(tmp_path / "stage")
