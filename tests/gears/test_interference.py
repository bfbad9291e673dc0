"""Room that whole gears leave each other, and what is said where there is none."""

from math import atan, cos, hypot, radians, sin, sqrt, tan
from pathlib import Path

from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.gears.cylindrical_mesh import RIGID, ROUNDING, Room, interferences
from loaded_tca.scene import read_scene
from tests.refusals import refusals

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
MODULE, PLACE = 3.0, "at mid-face"
SOUND = Room(0.0, (0.5, 0.5), (0.75, 0.75))
ANGLE = radians(20.0)


def spur(distance):
    gears = [CylindricalGear(z, MODULE, 25.0, name=name) for z, name in ((34, "pinion"), (57, "wheel"))]
    return CylindricalMesh(*gears, distance)


def test_room_of_standard_gears_is_that_of_the_rack_that_cuts_them():
    """Flanks end where the straight part of the rack does, roots a quarter of a module below the mating tip."""
    room = spur(136.5).room
    assert_allclose(room.backlash, 0.0, atol=1e-11)  # mm; thicknesses of some mm cancel
    assert_allclose(room.below_root, 0.25 * MODULE, rtol=1e-9)
    base, tip = 1.5 * 57 * cos(ANGLE), 1.5 * 57 + MODULE
    mating_tip = 136.5 * sin(ANGLE) - sqrt(tip**2 - base**2)
    form = 1.5 * 34 * sin(ANGLE) - MODULE * (1.25 - 0.38 * (1.0 - sin(ANGLE))) / sin(ANGLE)
    assert_allclose(room.below_form[0], mating_tip - form, rtol=1e-9)


def test_gears_that_stand_nearer_lose_backlash_and_clearance():
    """2 da tan(alpha_wt) of backlash, but for its second order."""
    room = spur(136.49).room
    assert_allclose(room.backlash, -0.02 * tan(ANGLE), rtol=1e-3)
    assert_allclose(room.below_root, 0.74, rtol=1e-9)


def test_clearance_of_bevel_gears_is_that_of_their_cones_at_the_toe():
    """Dedenda of 1.25 and addenda of 1 outer modules over R_e = m/2 hypot(z1, z2)."""
    distance = 2.0 * hypot(20.0, 40.0)
    angle = atan(1.25 * 4.0 / distance) - atan(4.0 / distance)
    assert_allclose(bevel_mesh((20, 40), 4.0, 20.0).room.below_root, (distance - 20.0) * angle, rtol=1e-9)


def test_clearance_of_a_face_milled_pair_is_that_of_its_construction():
    """Addenda of the mended duplex pair are the mate's dedenda less 0.564 mm."""
    mesh = read_scene(SCENES / "duplex_30x20_mended.toml").mesh()
    assert_allclose(mesh.tip_clearances, 0.564, atol=2e-3)  # across the cones, at the end where it is least


def test_tip_beyond_the_base_circle_is_below_the_form_circle():
    """Diameters grow again there: the room is counted on the line of action."""
    mesh = bevel_mesh((14, 39), 5.0, 20.0)
    assert mesh.fillet_interference == (True, False)
    (sentence,) = interferences(mesh.room, 4.0, PLACE)
    assert sentence.startswith("fillet interference: the tip of the wheel reaches below the form circle of the pinion")


def test_what_jams_is_named_with_its_place_and_size():
    room = Room(-0.02, (0.1, -0.03), (0.75, 0.0))
    backlash, tip = interferences(room, MODULE, PLACE)
    assert backlash.startswith("negative backlash: ")
    assert backlash.endswith(" (at mid-face by 0.0200 mm)")
    assert "the tip of the pinion reaches below the form circle of the wheel" in tip
    assert tip.endswith(" (at mid-face by 0.0300 mm on the line of action)")


def test_rounding_of_printed_numbers_jams_nothing():
    least = -ROUNDING * MODULE
    assert interferences(Room(0.99 * least, (0.99 * least, 0.5), (0.99 * least, 0.5)), MODULE, PLACE) == []
    assert len(interferences(Room(1.01 * least, (1.01 * least, 0.5), (0.5, 0.5)), MODULE, PLACE)) == 2


test_gears_of_which_nothing_can_turn_are_refused = refusals(
    lambda change: interferences(SOUND._replace(**change), MODULE, PLACE),
    ({"backlash": -1.01 * RIGID * MODULE}, "cannot turn at mid-face: teeth are 0.606 mm thicker than the spaces"),
    ({"below_root": (-0.1, 0.5)}, "the tip of the wheel reaches 0.1 mm into the root of the pinion$"),
    ({"below_root": (0.5, -0.1)}, "the tip of the pinion reaches 0.1 mm into the root of the wheel$"),
    error=GeometryError,
)
