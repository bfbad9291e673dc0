"""Undercut gears in the mesh: form circles of rolled racks, what is left of the path of contact, room of tips."""

from math import cos, pi, radians, sin, sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
from loaded_tca.gears.cylindrical_mesh import interferences
from loaded_tca.gears.undercut import fillet_room, undercut_sentences, undercuts
from validation.cylindrical.undercut import ROLLED, rolled_form_radius

ROUNDING = 1e-12  # of lengths of a path up to ten times as long, which are subtracted
ANGLE = radians(20.0)
SHARP = {"root_radius_coefficient": 0.0}


def gear(teeth, module=1.0, **changes):
    return CylindricalGear(teeth, module, 10.0, **changes)


def mesh(*teeth, **changes):
    return CylindricalMesh(gear(teeth[0], name="pinion", **changes), gear(teeth[1], name="wheel"))


@pytest.mark.parametrize(
    ("teeth", "changes"),
    [
        (8, {}),
        (10, {"helix_angle": 0.3}),
        (12, {"rounding": 0.2, "shift": 0.1}),
        (14, {"rounding": 0.0}),
        (10, {"left": 0.05}),
    ],
)
def test_form_circle_is_where_a_rolled_rack_leaves_the_involute(teeth, changes):
    own = {
        "helix_angle": changes.get("helix_angle", 0.0),
        "root_radius_coefficient": changes.get("rounding", 0.38),
        "profile_shift": changes.get("shift", 0.0),
        "protuberance": 2.0 * changes.get("left", 0.0),
        "grinding_stock": changes.get("left", 0.0),
    }
    assert_allclose(gear(teeth, **own).form_radius, rolled_form_radius(teeth, **changes), rtol=ROLLED)


def test_flank_begins_at_half_of_what_the_rack_reaches_beyond_the_base_circle():
    """Where the undercut is slight.

    The involute is (s^2/2, s^3/3) beside its start, and the end s0 < 0 of the rack's flank leaves along the tangent of
    the mirrored branch: (s - s0)^2 (2 s + s0) = 0 has it cross at -s0/2.
    """
    limit = gear(10).smallest_profile_shift
    ratios = []
    for below in (1e-2, 1e-3):
        cut = gear(10, profile_shift=limit - below)
        ratios.append(-cut.roll_length(cut.form_radius) / cut.rack_form_roll_length)
    errors = 0.5 - np.array(ratios)
    assert_allclose(errors[0] / errors[1], 10.0, rtol=0.1)  # of first order
    assert abs(errors[1]) < 1e-3


@pytest.mark.parametrize(("teeth", "wheel"), [(10, 24), (12, 40), (14, 100)])
def test_path_of_contact_begins_where_the_rolled_rack_leaves_the_involute(teeth, wheel):
    """The wheel reaches beyond T1, so that a whole involute would have contact from there on."""
    pair = mesh(teeth, wheel)
    base = 0.5 * teeth * cos(ANGLE)
    start = sqrt(rolled_form_radius(teeth) ** 2 - base**2)
    end = sqrt((0.5 * teeth + 1.0) ** 2 - base**2)
    pitch = pi * cos(ANGLE)
    cut, none = undercuts(pair)
    assert none is None
    near = {"rtol": ROLLED * (base / start) ** 2}  # a difference of squares
    assert_allclose(pair.path_of_contact.A, start, **near)
    assert_allclose([cut.ratio, cut.whole_ratio], [(end - start) / pitch, end / pitch], **near)
    assert_allclose([cut.lost_length, cut.lost_share], [start, start / end], **near)
    assert cut.wanted_radius == pair.pinion.base_radius


def test_undercuts_of_both_gears_cut_both_ends_of_the_path():
    pair = mesh(12, 12)
    pinion, wheel = undercuts(pair)
    assert pinion == wheel
    path, start = pair.path_of_contact, pair.pinion.roll_length(pair.pinion.form_radius)
    assert_allclose([path.A, path.T2 - path.E], start, rtol=ROUNDING)
    assert_allclose(pinion.ratio / pinion.whole_ratio, 1.0 - 2.0 * pinion.lost_share, rtol=ROUNDING)


def test_undercut_takes_nothing_where_the_mating_tip_ends_above_it():
    """From the beginning on, and where the wheel has no more addendum than the flank that is left."""
    limit = gear(12).smallest_profile_shift
    shifts = limit - np.array([0.2, 0.1, 1e-2, -1e-9])
    cuts = [undercuts(mesh(12, 100, profile_shift=shift))[0] for shift in shifts]
    lost = [0.0 if cut is None else cut.lost_length for cut in cuts]
    assert lost == sorted(lost, reverse=True)
    assert [length > 0.0 for length in lost] == [True, True, False, False]
    short = CylindricalMesh(gear(12), gear(40, addendum_coefficient=0.5))
    assert short.pinion.is_undercut
    assert undercuts(short) == (None, None)
    assert undercut_sentences(short, "anywhere") == []


@pytest.mark.parametrize(("addendum", "chamfer"), [(1.25, 0.0), (1.25, 0.05), (1.2, 0.0), (1.3, 0.0)])
def test_tip_has_the_room_that_the_rack_of_its_depth_leaves(addendum, chamfer):
    """A wheel of 1e5 teeth is the sharp-cornered rack that cut the fillet, where it reaches as deep; room falls off."""
    wheel = gear(100_000, addendum_coefficient=addendum, dedendum_coefficient=1.4, tip_chamfer=chamfer, **SHARP)
    room = fillet_room(CylindricalMesh(gear(10, **SHARP), wheel), 0)
    if (addendum, chamfer) == (1.25, 0.0):
        assert abs(room) < 3e-5  # half of it between the points along the curves, half the curvature of the wheel
    elif addendum > 1.25:
        assert room < -0.05  # of 0.05 deeper
    else:
        assert room > 1e-3


def test_tip_in_an_undercut_fillet_interferes_and_one_that_turns_free_does_not():
    free = mesh(10, 40)
    assert interferences(free.room, 1.0, "here") == []
    wheel = gear(1000, addendum_coefficient=1.24, dedendum_coefficient=1.4)
    jammed = CylindricalMesh(gear(10), wheel)  # its sharp corners, where the rack that cut the pinion is round
    (fillet,) = interferences(jammed.room, 1.0, "here")
    assert fillet.startswith("fillet interference: the tip of the wheel reaches into the undercut fillet of the pinion")
    assert fillet.endswith("mm along its circle)")
    assert fillet_room(mesh(20, 40), 0) is None


def test_planet_without_shift_loses_what_the_ring_would_use():
    pinion = gear(12, 3.0, name="pinion")
    pair = InternalMesh(pinion, RingGear(-60, 3.0, 10.0, tip_diameter=176.5))
    cut, none = undercuts(pair)
    assert none is None
    assert_allclose(pair.path_of_contact.A, pinion.roll_length(pinion.form_radius), rtol=ROUNDING)
    tip = sqrt(88.25**2 - (90.0 * cos(ANGLE)) ** 2) - 72.0 * sin(ANGLE)
    assert_allclose(cut.lost_length, pinion.roll_length(pinion.form_radius) - tip, rtol=1e-9)
    assert pair.room.in_fillet[0] > 0.0
    (sentence,) = undercut_sentences(pair, "here")
    assert "the flank of the pinion at diameter 33.9081 mm, where the tip of the wheel would use" in sentence


def test_sentence_has_sizes_and_the_shift_that_avoids_the_undercut():
    (sentence,) = undercut_sentences(mesh(10, 40), "at 25 mm")
    cut = undercuts(mesh(10, 40))[0]
    for part in (
        f"diameter {2.0 * cut.form_radius:.4f} mm",
        f"down to {2.0 * cut.wanted_radius:.4f} mm",
        f"{cut.lost_length:.4f} mm of the path of contact are lost, {cut.lost_share:.1%}",
        f"is {cut.ratio:.4f} instead of {cut.whole_ratio:.4f} (at 25 mm)",
    ):
        assert part in sentence
    enough = float(sentence.split("a profile_shift of ")[1].split(" ")[0])
    assert not gear(10, profile_shift=enough).is_undercut
    assert gear(10, profile_shift=enough - 2e-4).is_undercut


def test_undercuts_that_leave_no_flank_are_refused():
    with pytest.raises(GeometryError, match=r"pinion and wheel: no common flank .* usable flanks end 0\.03"):
        mesh(4, 4)
