import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalGear
from loaded_tca.gears.cylindrical import half_tooth, transverse_profile

ROUNDING = 1e-12
"""mm or rad, of lengths of 100 mm and angles below one: 7e-17 rad was seen."""
GEARS = {
    "spur": CylindricalGear(24, 3.0, 25.0),
    "helical": CylindricalGear(20, 3.0, 25.0, helix_angle=math.radians(25.0), profile_shift=0.3),
    "sharp rack": CylindricalGear(30, 2.0, 10.0, root_radius_coefficient=0.0),
    "full rounding": CylindricalGear(40, 2.0, 10.0, root_radius_coefficient=9.0),
    "undercut": CylindricalGear(12, 3.0, 10.0),
    "far outside": CylindricalGear(60, 2.0, 10.0, profile_shift=1.4),
}


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


@pytest.mark.parametrize("gear", GEARS.values(), ids=GEARS)
def test_parts_follow_each_other_and_end_on_their_circles(gear):
    parts = half_tooth(gear, 17)
    assert list(parts) == ["tip_land", "flank", "fillet", "root_land"]
    rows = list(parts.values())
    for first, second in pairwise(rows):
        assert_allclose(first[-1], second[0], atol=1e-9)
    ends = [math.hypot(*part[-1]) for part in rows]
    assert_allclose(ends, [gear.tip_radius, gear.form_radius, gear.root_radius, gear.root_radius], rtol=1e-9)
    assert_allclose(rows[0][0], [gear.tip_radius, 0.0], atol=ROUNDING)
    assert_allclose(math.atan2(*rows[-1][-1][::-1]), math.pi / gear.teeth, rtol=ROUNDING)


def test_half_of_the_thickness_lies_on_the_reference_circle():
    gear = GEARS["helical"]
    x, y = half_tooth(gear, 2001)["flank"].T
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    half = np.interp(gear.reference_radius, radius[::-1], angle[::-1])
    assert_allclose(2.0 * half * gear.reference_radius, gear.tooth_thickness, rtol=1e-7)


@pytest.mark.parametrize("name", ["spur", "helical", "full rounding", "far outside"])
def test_fillet_is_tangent_to_involute_and_root_circle(name):
    gear = GEARS[name]
    radial, circumferential = (part[[0, -1]] for part in gear.root_fillet_tangent(9))
    roll = gear.roll_length(gear.form_radius)
    along = np.array([-gear.base_radius, roll]) / gear.form_radius  # the involute, towards the root
    assert abs(radial[0] * along[1] - circumferential[0] * along[0]) < 1e-9
    assert_allclose((radial[1], circumferential[1]), (0.0, 1.0), atol=ROUNDING)


@pytest.mark.parametrize("gear", GEARS.values(), ids=GEARS)
def test_tangents_of_the_fillet_are_those_of_its_points(gear):
    """Central differences, of second order: four times closer on half the steps."""
    errors = []
    for count in (401, 801):
        radius, angle = gear.root_fillet(count)
        points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
        radial, around = gear.root_fillet_tangent(count)
        outward, sideways = unit(points), unit(points)[:, ::-1] * [-1.0, 1.0]
        exact = (radial[:, None] * outward + around[:, None] * sideways)[1:-1]
        chords = unit(points[2:] - points[:-2])
        errors.append(np.abs(chords[:, 0] * exact[:, 1] - chords[:, 1] * exact[:, 0]).max())
    assert errors[1] < 0.3 * errors[0]
    assert errors[1] < 1e-3


@pytest.mark.parametrize("gear", GEARS.values(), ids=GEARS)
def test_outline_is_closed_and_runs_counter_clockwise(gear):
    outline = transverse_profile(gear, 33)
    assert_allclose(outline[0], outline[-1])
    assert len(outline) == 4 * 32 + 1 + 33 + 1
    x, y = outline.T
    area = 0.5 * float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum())
    low, high = (0.5 * math.pi / gear.teeth * radius**2 for radius in (gear.root_radius, gear.tip_radius))
    inner = 0.5 * math.pi / gear.teeth * math.hypot(*outline[-2]) ** 2
    assert low - inner < area < high - inner


def test_outline_goes_down_to_the_bore_or_as_asked():
    bored = CylindricalGear(24, 3.0, 25.0, bore_diameter=30.0)
    assert_allclose(transverse_profile(bored, 5)[-2], [15.0, 0.0], atol=ROUNDING)
    assert_allclose(transverse_profile(bored, 5, inner_radius=20.0)[-2], [20.0, 0.0], atol=ROUNDING)
    gear = GEARS["spur"]
    assert_allclose(transverse_profile(gear, 5)[-2], [gear.root_radius - 6.0, 0.0], atol=ROUNDING)


@pytest.mark.parametrize("inner", [0.0, -1.0, 32.25, math.nan, math.inf])
def test_inner_radius_outside_the_body_is_refused(inner):
    with pytest.raises(InputError, match=r"inner_radius: .* is not between 0 and 32\.25 mm"):
        transverse_profile(GEARS["spur"], 5, inner)


def test_fewer_than_two_points_are_refused():
    with pytest.raises(InputError, match="points: 1 is below 2"):
        half_tooth(GEARS["spur"], 1)
