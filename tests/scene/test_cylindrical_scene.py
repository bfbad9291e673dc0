"""What scenes of cylindrical gears leave to be found: the profile shift of one gear from the centre distance."""

import math

import pytest
from numpy.testing import assert_allclose

from loaded_tca import InputError, parse_scene, read_scene
from tests.samples.results import SCENES

WIDER = 138.0
"""Centre distance [mm] of a spur pair 34/57 of module 3, whose sum of shifts is 0.52 without backlash: by hand,
cos(alpha_w) = 136.5 cos(20 deg)/138, (34 + 57)(inv alpha_w - inv 20 deg)/(2 tan 20 deg)."""
SUM = 0.519985
ROUNDING = 1e-9  # mm; decimals of angles and distances in scenes


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


THIN = -0.12
"""Allowance of the wheel's teeth [mm]."""
SPUR = {
    "pair.normal_module_mm": 2.0,
    "pair.centre_distance_mm": 82.4,
    "pinion.teeth": 20,
    "pinion.profile_shift": 0.3,
    "wheel.teeth": 60,
}
GROUND = {
    "pair.normal_module_mm": 4.0,
    "pair.helix_angle_deg": 12.0,
    "pair.centre_distance_mm": 136.5,
    "pair.tip_shortening": "computed",
    "pinion.teeth": 19,
    "pinion.profile_shift": 0.45,
    "pinion.protuberance_um": 220.0,
    "pinion.grinding_stock_um": 150.0,
    "pinion.face_width_mm": 38.0,
    "wheel.teeth": 46,
    "wheel.face_width_mm": 38.0,
}


@pytest.mark.parametrize(("changes", "teeth"), [(SPUR, 9), (GROUND, 7)])
def test_span_is_measured_on_teeth_with_the_shift_that_the_centre_distance_leaves(changes, teeth):
    """Closed forms of ISO 21771: x1 + x2, and W_k of that x2 and an allowance, which the scene has to find again."""
    module, count, normal = changes["pair.normal_module_mm"], changes["wheel.teeth"], math.radians(20.0)
    helix, total = math.radians(changes.get("pair.helix_angle_deg", 0.0)), count + changes["pinion.teeth"]
    angle = math.atan(math.tan(normal) / math.cos(helix))
    working = math.acos(0.5 * total * module * math.cos(angle) / math.cos(helix) / changes["pair.centre_distance_mm"])
    rest = math.tan(working) - working - math.tan(angle) + angle
    shift = 0.5 * total * rest / math.tan(normal) - changes["pinion.profile_shift"]
    span = module * math.cos(normal) * (math.pi * (teeth - 0.5) + count * (math.tan(angle) - angle))
    span += 2.0 * shift * module * math.sin(normal) + THIN * math.cos(normal)
    measured = read_scene(SCENES / "spur.toml").with_changes({**changes, "wheel.span_measurement_mm": span})
    wheel = measured.mesh().wheel
    assert wheel.span_teeth == teeth
    assert_allclose([wheel.profile_shift, wheel.thickness_allowance], [shift, THIN], atol=ROUNDING)


def test_refused_measure_names_the_shift_that_the_centre_distance_asks_for():
    scene = read_scene(SCENES / "spur.toml").with_changes({**SPUR, "wheel.span_measurement_mm": 45.0})
    with pytest.raises(InputError, match=r"^wheel: span_measurement_mm: 45 mm over 9 teeth") as refusal:
        scene.mesh()
    assert refusal.value.__notes__ == [
        "pair.centre_distance_mm = 82.4 and the given profile_shift ask for 1.0236 on the other gear"
    ]
