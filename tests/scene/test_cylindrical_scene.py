"""What scenes of cylindrical gears leave to be found: the profile shift of one gear from the centre distance."""

import pytest

from loaded_tca import parse_scene, read_scene
from tests.samples.results import SCENES

WIDER = 138.0
"""Centre distance [mm] of a spur pair 34/57 of module 3, whose sum of shifts is 0.52 without backlash: by hand,
cos(alpha_w) = 136.5 cos(20 deg)/138, (34 + 57)(inv alpha_w - inv 20 deg)/(2 tan 20 deg)."""
SUM = 0.519985
ROUNDING = 1e-9


def shifts(**given):
    changes = {f"{gear}.profile_shift": value for gear, value in given.items()}
    mesh = read_scene(SCENES / "spur.toml").with_changes({"pair.centre_distance_mm": WIDER, **changes}).mesh()
    return mesh.pinion.profile_shift, mesh.wheel.profile_shift, mesh.backlash


@pytest.mark.parametrize(
    ("given", "expected"),
    [({"pinion": 0.3}, (0.3, SUM - 0.3)), ({"wheel": -0.1}, (SUM + 0.1, -0.1)), ({"pinion": 0.0}, (0.0, SUM))],
)
def test_shift_that_is_not_given_leaves_no_backlash_at_the_centre_distance(given, expected):
    *found, backlash = shifts(**given)
    assert found == pytest.approx(expected, abs=1e-6)
    assert abs(backlash) < ROUNDING


def test_shifts_of_neither_or_of_both_are_as_given():
    assert shifts()[:2] == (0.0, 0.0)
    assert shifts()[2] > 0.0
    assert shifts(pinion=0.2, wheel=0.1)[:2] == (0.2, 0.1)


def test_without_a_centre_distance_no_shift_follows():
    mesh = read_scene(SCENES / "spur.toml").with_changes({"pinion.profile_shift": 0.3}).mesh()
    assert (mesh.pinion.profile_shift, mesh.wheel.profile_shift) == (0.3, 0.0)


def test_scene_that_is_written_and_read_has_the_same_shifts():
    scene = read_scene(SCENES / "spur.toml").with_changes(
        {"pair.centre_distance_mm": WIDER, "pinion.profile_shift": 0.3}
    )
    again = parse_scene(scene.to_toml())
    assert again == scene
    assert again.wheel.profile_shift is None
