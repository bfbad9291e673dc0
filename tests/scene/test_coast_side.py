import pytest
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.scene import read_scene
from tests.samples.results import SCENES

NAMES = ("helical", "straight_bevel", "spiral_bevel", "face_milled_19x62")


@pytest.mark.parametrize("name", NAMES)
def test_coast_side_turns_the_same_way_on_the_other_flanks(name):
    drive = read_scene(SCENES / f"{name}.toml")
    coast = drive.coast_side()
    assert coast.sense == drive.sense
    assert {drive.driving, coast.driving} == {"pinion", "wheel"}
    sides = [[gear.flank.side for gear in (pair.pinion, pair.wheel)] for pair in (drive.pair(), coast.pair())]
    assert sides[0] == [-side for side in sides[1]]
    assert coast.coast_side().pair().pinion.flank.side == drive.pair().pinion.flank.side


def test_pair_that_is_its_own_mirror_image_is_as_stiff_on_both_sides():
    changes = {"analysis.positions": 3, "analysis.compliance": "contact", "analysis.cells": (16, 16)}
    drive = read_scene(SCENES / "spur.toml").with_changes(changes)
    results = [analyse(scene) for scene in (drive, drive.coast_side())]
    spans = [result.transmission_error for result in results]
    assert_allclose(spans[1], -spans[0][:, ::-1], rtol=1e-5, atol=1e-12)  # the solver's tolerance


def test_measured_flanks_are_one_side():
    with pytest.raises(InputError, match=r'flank\.form: "measured" is one side of the teeth'):
        read_scene(SCENES / "measured_flank.toml").coast_side()


POINTS = {"radius_mm": [4 * [r] for r in (64.0, 66.0, 68.0, 70.0)], "axial_mm": 4 * [[-15.0, -5.0, 5.0, 15.0]]}
MEASURED = {"form": "measured", "measurement": {**POINTS, "deviation_um": 4 * [4 * [0.0]]}}
OF_PARTS = {
    "half b": ("double_helical", {"wheel.half_b": {"flank": MEASURED}}, r"wheel\.half_b\.flank\.form"),
    "tooth": (
        "helical",
        {"pinion.tooth": [{"number": 2, "modifications": {}}, {"number": 3, "flank": MEASURED}]},
        r"pinion\.tooth\[1\]\.flank\.form",
    ),
}


@pytest.mark.parametrize(("name", "changes", "key"), OF_PARTS.values(), ids=OF_PARTS)
def test_measured_flanks_of_half_b_and_of_single_teeth_are_one_side_too(name, changes, key):
    scene = read_scene(SCENES / f"{name}.toml").with_changes(changes)
    with pytest.raises(InputError, match=rf'^{key}: "measured" is one side of the teeth; allowed others$'):
        scene.coast_side()


@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("helical", ["wheel.pitch.single_um"]),
        ("double_helical", ["pinion.pitch.index_um", "pinion.half_b.pitch.index_um"]),
    ],
    ids=["single pitches", "halves"],
)
def test_index_deviations_of_one_side_are_warned_of(name, keys):
    scene = read_scene(SCENES / f"{name}.toml")
    teeth = {gear: getattr(scene, gear).teeth for gear in ("pinion", "wheel")}
    deviations = {key: [1.0, -1.0, *(teeth[key.partition(".")[0]] - 2) * [0.0]] for key in keys}
    with pytest.warns(AccuracyWarning) as given:
        scene.with_changes(deviations).coast_side()
    assert [str(one.message).partition(": ")[0] for one in given] == keys


def test_runout_and_classes_hold_for_both_sides(recwarn):
    scene = read_scene(SCENES / "helical.toml")
    scene.with_changes({"wheel.pitch.runout_um": 5.0, "pinion.pitch.tolerance_class": 5}).coast_side()
    assert not recwarn.list
