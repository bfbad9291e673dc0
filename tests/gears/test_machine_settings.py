"""Machine settings, blanks and gears of face milling: what follows from them, and what is refused."""

import math
from dataclasses import replace

import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.gears import FaceMilledBlank, MachineSettings
from tests.samples.face_milled import published_pinion, published_wheel


def test_settings_out_of_range_are_all_named():
    with pytest.raises(InputError) as caught:
        MachineSettings(-1.0, math.nan, 4.0, ratio_of_roll=0.0, tilt=2.0)
    assert [problem.split(":")[0] for problem in caught.value.problems] == [
        "cradle_angle",
        "radial",
        "root_angle",
        "tilt",
        "ratio_of_roll",
    ]


def test_unknown_generation_is_refused():
    with pytest.raises(InputError, match="generation: 'rolled' is not 'generated' or 'formate'"):
        MachineSettings(90.0, 0.9, 0.3, 3.0, generation="rolled")


def test_formate_gear_needs_no_ratio_of_roll():
    assert not MachineSettings(90.0, 0.9, 0.3, generation="formate").rolls


def test_blank_knows_its_face():
    blank = FaceMilledBlank(100.0, 30.0, 0.5, 0.55, 0.45)
    assert_allclose(blank.cone_distances, (70.0, 100.0))
    assert blank.mean_cone_distance == 85.0


def test_blank_out_of_order_is_refused_with_every_problem():
    with pytest.raises(InputError) as caught:
        FaceMilledBlank(100.0, 130.0, 0.5, 0.45, 0.55, hand="both", face_apex=math.inf)
    assert [problem.split(":")[0] for problem in caught.value.problems] == [
        "face_apex",
        "hand",
        "face_width",
        "root_angle",
    ]


def test_blank_of_next_to_no_face_is_refused():
    with pytest.raises(InputError, match=r"^face_width: 1e-300 mm is below 0.001 outer_cone_distance, 0.1 mm$"):
        FaceMilledBlank(100.0, 1e-300, 0.5, 0.55, 0.45)


def test_teeth_are_counted_in_whole_numbers_from_three_on():
    with pytest.raises(InputError, match=r"pinion: teeth: 2 is not a whole number"):
        replace(published_pinion(), teeth=2)


def test_concave_flank_faces_the_positive_sense_on_a_right_hand_gear_only():
    left, right = published_pinion(), published_wheel()
    assert (right.side("concave"), right.side("convex"), left.side("concave"), left.side("convex")) == (1, -1, -1, 1)
    for gear in (left, right):
        assert all(gear.flank_name(gear.side(flank)) == flank for flank in ("concave", "convex"))
