"""Pitch deviations and revolutions of scenes: files, sums, tolerance classes, what a scene keeps."""

import math

import numpy as np
import pytest

from loaded_tca import InputError, parse_scene, read_scene
from loaded_tca.reference.iso1328 import flank_tolerances
from loaded_tca.results.revolution import open_turns
from loaded_tca.scene.pitch import Pitch, Revolution, read_deviations
from tests.refusals import refused_calls

SCENE = read_scene("examples/scenes/mesh_cycle_helical.toml").with_changes({"pinion.teeth": 17, "wheel.teeth": 24})


def written(folder, text):
    path = folder / "pitch.csv"
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_index_deviations_are_the_sums_of_single_ones():
    single = (1.0, -3.0, 2.5, -0.5)
    assert Pitch(single_um=single).index(4, None).tolist() == [1.0, -2.0, 0.5, 0.0]


def test_file_of_deviations_takes_the_place_of_a_list(tmp_path):
    lines = "# measured on the wheel\ntooth, index_um\n" + "".join(f"{k}, {0.5 * k}\n" for k in range(24))
    scene = SCENE.with_changes({"wheel.pitch.file": written(tmp_path, lines)})
    assert scene.wheel.pitch.index_um == tuple(0.5 * k for k in range(24))
    assert scene.wheel.pitch.file is None
    assert parse_scene(scene.to_toml(), folder=None) == scene


def test_deviations_of_one_key_take_the_place_of_those_of_another():
    drawn = SCENE.with_changes({"wheel.pitch.tolerance_class": 7, "wheel.pitch.runout_um": 3.0})
    pitch = drawn.with_changes({"wheel.pitch.index_um": [1.0] * 24}).wheel.pitch
    assert (pitch.index_um, pitch.tolerance_class, pitch.runout_um) == ((1.0,) * 24, None, 3.0)
    assert drawn.with_changes({"wheel.pitch.index_um": None}).wheel.pitch == drawn.wheel.pitch
    numbered = drawn.with_changes({"wheel.pitch.seed": 4})
    assert numbered.with_changes({"wheel.pitch.index_um": [1.0] * 24}).wheel.pitch == pitch


def test_file_with_single_deviations(tmp_path):
    assert read_deviations(written(tmp_path, "single_um\n1\n-2\n1\n")) == ("single_um", (1.0, -2.0, 1.0))


def test_file_of_a_spreadsheet_is_read(tmp_path):
    text = '\N{BYTE ORDER MARK}"tooth";"index_\N{MICRO SIGN}m";\r\n1;1.5;\r\n2;"-2";\r\n3;.5;\r\n;;\r\n'
    assert read_deviations(written(tmp_path, text)) == ("index_um", (1.5, -2.0, 0.5))


@pytest.mark.parametrize("encoding", ["cp1252", "utf-16"])
def test_file_of_windows_is_read(tmp_path, encoding):
    lines = "sep=;", "# tooth by tooth", "tooth;index_\N{MICRO SIGN}m", "1;1.5", "2;-2", "3;.5"
    (tmp_path / "pitch.csv").write_bytes("\r\n".join(lines).encode(encoding))
    assert read_deviations(str(tmp_path / "pitch.csv")) == ("index_um", (1.5, -2.0, 0.5))


def test_scene_names_a_file_in_its_folder(tmp_path):
    written(tmp_path, "index_um\n" + "1.0\n" * 24)
    text = SCENE.to_toml().replace("# [wheel.pitch] is not given", '[wheel.pitch]\nfile = "pitch.csv"')
    (tmp_path / "scene.toml").write_text(text)
    assert read_scene(tmp_path / "scene.toml").wheel.pitch.index_um == (1.0,) * 24
    with pytest.raises(InputError, match=r"wheel\.pitch\.file: .* no file here"):
        parse_scene(text, folder=None)


@pytest.mark.parametrize("gear", [0, 1])
def test_deviations_of_a_class_fill_its_tolerances_on_the_line_of_action(gear):
    name = ("pinion", "wheel")[gear]
    scene = SCENE.with_changes({f"{name}.pitch.tolerance_class": 7, f"{name}.pitch.seed": 2, f"{name}.teeth": 60})
    index = scene.tooth_deviations(scene.pair())[gear].index
    tolerances = flank_tolerances(60, 3.0, 25.0, 7, math.radians(15.0))
    transverse = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(15.0)))
    assert 1e3 * np.ptp(index) == pytest.approx(tolerances.cumulative_pitch * math.cos(transverse), rel=1e-6)
    steps = np.abs(index - np.roll(index, 1))
    assert 1e3 * steps.max() == pytest.approx(tolerances.single_pitch * math.cos(transverse), rel=1e-6)


def test_seed_makes_the_deviations():
    scenes = [SCENE.with_changes({"wheel.pitch.tolerance_class": 6, "wheel.pitch.seed": seed}) for seed in (0, 0, 1)]
    first, again, other = (scene.tooth_deviations(scene.pair())[1].index for scene in scenes)
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_runout_is_twice_the_eccentricity():
    scene = SCENE.with_changes({"pinion.pitch.runout_um": 10.0, "pinion.pitch.runout_phase_deg": 90.0})
    pinion, wheel = scene.tooth_deviations(scene.pair())
    assert pinion.eccentricity == pytest.approx(0.005)
    assert pinion.phase == pytest.approx(0.5 * math.pi)
    assert wheel.are_none
    assert not pinion.are_none


@pytest.mark.parametrize(("pitches", "count"), [("pinion", 17), ("wheel", 24), ("hunting", 408), (5, 5)])
def test_pitches_of_a_revolution(pitches, count):
    assert Revolution(pitches=pitches).count((17, 24)) == count


@pytest.mark.parametrize(("first", "teeth"), [(0, (0, 0)), (20, (3, 20)), ([4, 9], (4, 9))])
def test_first_pair_is_a_number_or_two_teeth(first, teeth):
    assert Revolution(first_pair=first).first_teeth((17, 24)) == teeth


def test_scene_without_deviations_has_none():
    assert not SCENE.has_pitch_deviations
    assert not SCENE.with_changes({"wheel.pitch.index_um": [0.0] * 24}).has_pitch_deviations
    assert SCENE.with_changes({"wheel.pitch.tolerance_class": 3}).has_pitch_deviations


test_refusals = refused_calls(
    (lambda tmp_path: read_deviations(written(tmp_path, "tooth\n1\n")), "found the columns tooth; allowed one of"),
    (
        lambda tmp_path: read_deviations(written(tmp_path, "index_um,remark\n2,5\n1,0\n")),
        "found the columns index_um, remark; allowed one of index_um, single_um, and tooth beside it",
    ),
    (
        lambda tmp_path: read_deviations(written(tmp_path, "tooth,index_um\n3,1\n2,2\n1,3\n")),
        'line 1 of the table: found tooth "3"; allowed 1: teeth are numbered in the order of the lines',
    ),
    (
        lambda tmp_path: read_deviations(written(tmp_path, "tooth,index_um\n0,1\n2,2\n1,3\n")),
        'line 2 of the table: found tooth "2"; allowed 1',
    ),
    (lambda tmp_path: read_deviations(written(tmp_path, "")), "found the columns none; allowed one of"),
    (
        lambda tmp_path: read_deviations(written(tmp_path, "index_um,single_um\n1,1\n")),
        "found the columns index_um, single_um; allowed one of",
    ),
    (lambda tmp_path: read_deviations(written(tmp_path, "index_um\n1\nx\n3\n")), 'line 2 of the table: found "x"'),
    (lambda tmp_path: read_deviations(written(tmp_path, "index_um\n1\nnan\n3\n")), 'line 2 of the table: found "nan"'),
    (lambda tmp_path: read_deviations(written(tmp_path, "tooth,index_um\n1,1\n2\n")), "line 2 of the table: found"),
    (lambda tmp_path: read_deviations(written(tmp_path, "index_um\n1\n1_0\n")), 'line 2 of the table: found "1_0"'),
    *(
        (lambda tmp_path, text=text: read_deviations(written(tmp_path, text)), "line 2: decimal commas, it seems")
        for text in ("tooth;index_um\n1;2,5\n", "index_um\n2,5\n1,5\n-4,0\n")
    ),
    (lambda tmp_path: read_deviations(written(tmp_path, "index_um\n1\n2,5\n3\n")), "line 2 of the table: more values"),
    (lambda tmp_path: read_deviations(written(tmp_path, 'index_um\n"1\n')), "line 2: a quotation that does not end"),
    (lambda tmp_path: read_deviations(written(tmp_path, "index_um\n1\n")), "allowed a list of 3 to 10000 values"),
    (
        lambda tmp_path: Pitch(file=written(tmp_path, "single_um\n1\n2\n3\n")),
        "file: .*pitch.csv: the single pitch deviations add up to 6 um",
    ),
    (
        lambda tmp_path: SCENE.with_changes({"wheel.pitch.file": written(tmp_path, "index_um\n1\n2\n3\n")}),
        r"wheel\.pitch: index_um: found 3 values; allowed 24",
    ),
    (lambda tmp_path: Pitch(file=str(tmp_path / "absent.csv")), "file: .*absent.csv: cannot be read"),
    (
        lambda: Pitch(seed=3, runout_um=5.0),
        "seed: found 3 without tolerance_class; allowed beside tolerance_class, for its",
    ),
    (lambda: Pitch(tolerance_class=12), "tolerance_class: found 12; allowed a whole number from 1 to 11"),
)


def test_teeth_of_their_own_are_written_and_read_back():
    teeth = [{"number": 7, "modifications": {"tip_relief_um": 4.0, "tip_relief_start_mm": 176.0}}, {"number": 9}]
    scene = SCENE.with_changes({"wheel.tooth": teeth})
    assert scene.wheel.tooth[0].modifications.tip_relief_um == 4.0
    assert parse_scene(scene.to_toml(), folder=None) == scene
    text = SCENE.to_toml() + "\n[[wheel.tooth]]\nnumber = 7\nmodifications = {lead_crowning_um = 3.0}\n"
    assert parse_scene(text).wheel.tooth[0].modifications.lead_crowning_um == 3.0


@pytest.mark.parametrize(
    ("crowning", "every", "differ", "depart"),
    [(5.0, 1, False, False), (9.0, 1, False, True), (9.0, 2, True, True), (5.0, 2, False, False)],
)
def test_teeth_with_flanks_of_their_own_differ_where_these_do(crowning, every, differ, depart):
    """All or every other tooth with a crowning, the gear with 5 um, which analyses of one pitch take."""
    teeth = [{"number": k, "modifications": {"lead_crowning_um": crowning}} for k in range(0, 24, every)]
    scene = SCENE.with_changes({"wheel.modifications": {"lead_crowning_um": 5.0}, "wheel.tooth": teeth})
    assert scene.wheel.teeth_differ == differ
    assert scene.has_pitch_deviations == depart
    assert open_turns(scene, 5) == ["wheel"] * differ


def test_kinds_of_teeth_are_as_many_as_flanks_differ():
    teeth = [
        {"number": number, "modifications": {"lead_crowning_um": um}} for number, um in ((1, 3.0), (4, 5.0), (6, 3.0))
    ]
    kinds, sections = SCENE.with_changes({"wheel.tooth": teeth}).wheel.kinds_of_teeth()
    assert kinds[[0, 1, 4, 6]].tolist() == [0, 1, 2, 1]
    assert len(sections) == 3
    assert SCENE.tooth_flanks() is None


def test_measured_flank_of_one_tooth_is_read_from_the_folder_of_the_scene_alone(tmp_path):
    tooth = '\n[[wheel.tooth]]\nnumber = 2\n[wheel.tooth.flank]\nform = "measured"\nfile = "{}"\n'
    (tmp_path / "scenes").mkdir()
    with pytest.raises(InputError, match=r"wheel\.tooth\.flank\.file: .* a file in the folder of the scene"):
        parse_scene(SCENE.to_toml() + tooth.format("../flank.csv"), folder=tmp_path / "scenes")
    with pytest.raises(InputError, match=r"wheel\.tooth: table 0: flank\.file: .*scenes.flank.csv: cannot be read"):
        parse_scene(SCENE.to_toml() + tooth.format("flank.csv"), folder=tmp_path / "scenes")
