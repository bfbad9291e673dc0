"""The V-H check as a study: the errors of the unloaded check, every pair of them."""

from pathlib import Path

import pytest

from loaded_tca.errors import InputError
from loaded_tca.scene import read_scene
from loaded_tca.studies import vh_study

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
OFFSETS = {"mounting.offset_mm": 0.01, "mounting.pinion_axial_mm": -0.02}
ANGLES = {"mounting.in_plane_deg": 0.01, "mounting.out_of_plane_deg": -0.02}


@pytest.mark.parametrize(
    ("name", "errors"),
    [
        *((name, ANGLES) for name in ("helical", "spur")),
        *((name, OFFSETS) for name in ("spiral_bevel", "straight_bevel", "face_milled_19x62")),
    ],
)
def test_v_and_h_are_the_mounting_errors_of_the_family(name, errors):
    study = vh_study(read_scene(SCENES / f"{name}.toml"), v=[0.0, 0.01], h=[-0.02, 0.0, 0.02])
    assert len(study) == 6
    assert study.changes(1) == errors


@pytest.mark.parametrize("v", [[], [float("nan")]])
def test_errors_that_are_none_are_told(v):
    with pytest.raises(InputError, match=r"mounting\.in_plane_deg: "):
        vh_study(read_scene(SCENES / "spur.toml"), v, [0.0])
