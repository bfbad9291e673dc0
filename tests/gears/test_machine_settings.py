"""Machine settings, blanks and gears of face milling: what follows from them, and what is refused."""

import math
from dataclasses import replace

from numpy.testing import assert_allclose

from loaded_tca.gears import FaceMilledBlank, MachineSettings
from tests.refusals import refused_calls
from tests.samples.face_milled import published_pinion, published_wheel


def test_formate_gear_needs_no_ratio_of_roll():
    assert not MachineSettings(90.0, 0.9, 0.3, generation="formate").rolls


def test_blank_knows_its_face():
    blank = FaceMilledBlank(100.0, 30.0, 0.5, 0.55, 0.45)
    assert_allclose(blank.cone_distances, (70.0, 100.0))
    assert blank.mean_cone_distance == 85.0


test_machine_settings_refuses = refused_calls(
    (
        lambda: MachineSettings(-1.0, math.nan, 4.0, ratio_of_roll=0.0, tilt=2.0),
        ("^cradle_angle:", "^radial:", "^root_angle:", "^tilt:", "^ratio_of_roll:"),
    ),
    (
        lambda: MachineSettings(90.0, 0.9, 0.3, 3.0, generation="rolled"),
        "generation: 'rolled' is not 'generated' or 'formate'",
    ),
    (
        lambda: FaceMilledBlank(100.0, 130.0, 0.5, 0.45, 0.55, hand="both", face_apex=math.inf),
        ("^face_apex:", "^hand:", "^face_width:", "^root_angle:"),
    ),
    (
        lambda: FaceMilledBlank(100.0, 1e-300, 0.5, 0.55, 0.45),
        r"^face_width: 1e-300 mm is below 0.001 outer_cone_distance, 0.1 mm$",
    ),
    (lambda: replace(published_pinion(), teeth=2), r"pinion: teeth: 2 is not a whole number"),
)


def test_concave_flank_faces_the_positive_sense_on_a_right_hand_gear_only():
    left, right = published_pinion(), published_wheel()
    assert (right.side("concave"), right.side("convex"), left.side("concave"), left.side("convex")) == (1, -1, -1, 1)
    for gear in (left, right):
        assert all(gear.flank_name(gear.side(flank)) == flank for flank in ("concave", "convex"))
