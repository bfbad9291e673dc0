"""Chamfers of tip edges: where flanks end, what is left of the tip, and what a mesh takes of it."""

import re
from math import cos, pi, radians, sin

import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
from loaded_tca.gears.chamfer import chamfered_land
from tests.refusals import refused_calls

ROUNDING = 1e-12  # of a length of 0.3 mm, the difference of radii of 30 mm: some 2e-14 of it


def gear(teeth=25, **given):
    return CylindricalGear(teeth, 2.0, 20.0, **given)


def ring(**given):
    return RingGear(-60, 2.0, 20.0, **given)


@pytest.mark.parametrize(("make", "side"), [(gear, 1.0), (ring, -1.0)])
@pytest.mark.parametrize("angle", [30.0, 60.0])
def test_chamfer_is_a_straight_line_from_the_flank_to_the_tip(make, side, angle):
    """Its ends, turned back from the land and the flank, lie on a line of the angle that is given."""
    one = make(tip_chamfer=0.3, tip_chamfer_angle=radians(angle))
    assert_allclose(side * (one.tip_radius - one.tip_form_radius), 0.3, rtol=ROUNDING)
    ends = []
    for radius, half in (
        (one.tip_form_radius, 0.5 * one.tooth_thickness_at(one.tip_form_radius) / one.tip_form_radius),
        (one.tip_radius, 0.5 * chamfered_land(one) / one.tip_radius),
    ):
        ends.append((radius * cos(half), radius * sin(half)))
    (x1, y1), (x2, y2) = ends
    assert_allclose((y1 - y2) * cos(radians(angle)), side * (x2 - x1) * sin(radians(angle)), rtol=1e-9)


def test_chamfers_shorten_the_path_of_contact_as_shorter_tips_do():
    chamfered = gear(tip_chamfer=0.2)
    short = gear(tip_diameter=2.0 * chamfered.tip_form_radius)
    pairs = [CylindricalMesh(one, gear(34)) for one in (chamfered, short)]
    assert pairs[0].path_of_contact == pairs[1].path_of_contact
    assert pairs[0].wheel_active_profile == pairs[1].wheel_active_profile
    assert pairs[0].tip_clearances[1] == CylindricalMesh(gear(), gear(34)).tip_clearances[1]
    rings = [InternalMesh(gear(), one) for one in (ring(tip_chamfer=0.2), ring(tip_diameter=116.4))]
    assert_allclose(rings[0].transverse_contact_ratio, rings[1].transverse_contact_ratio, rtol=ROUNDING)
    assert rings[0].tip_clearances[0] == InternalMesh(gear(), ring()).tip_clearances[0]


def test_no_chamfer_changes_no_digit():
    assert gear(tip_chamfer=0.0) == gear()
    assert gear().tip_form_radius == gear().tip_radius
    assert ring().tip_form_radius == ring().tip_radius


test_chamfer_refuses = refused_calls(
    (lambda: gear(tip_chamfer=-0.1), "^gear: tip_chamfer: -0.1 mm is not from 0 to below a module, 2 mm"),
    (lambda: ring(tip_chamfer=2.0), "^ring: tip_chamfer: 2 mm is not from 0 to below a module"),
    (lambda: gear(tip_chamfer=0.1, tip_chamfer_angle=0.5 * pi), "^gear: tip_chamfer_angle: 1.57.* is not between 0"),
)


@pytest.mark.parametrize("make", [gear, ring])
def test_chamfer_that_is_too_flat_is_told_from_which_angle_it_fits(make):
    with pytest.raises(GeometryError, match="stands out of the flank") as refusal:
        make(tip_chamfer=0.2, tip_chamfer_angle=0.02)
    least = float(re.search(r"an angle above (\d+\.\d\d) deg fits", str(refusal.value))[1])
    assert chamfered_land(make(tip_chamfer=0.2, tip_chamfer_angle=radians(least + 0.01))) > 0.0  # two decimals
    with pytest.raises(GeometryError, match="stands out of the flank"):
        make(tip_chamfer=0.2, tip_chamfer_angle=radians(least - 0.01))


@pytest.mark.parametrize(
    ("one", "problem"),
    [
        (lambda: gear(tip_chamfer=0.8, tip_chamfer_angle=1.3), "tip_chamfer: 0.8 mm leaves nothing of the tip"),
        (
            lambda: gear(tip_chamfer=0.2, tip_chamfer_angle=0.2),
            "tip_chamfer_angle: the chamfer stands out of the flank",
        ),
        (
            lambda: gear(10, profile_shift=0.5, tip_diameter=21.2, tip_chamfer=1.6),
            "tip_chamfer: 1.6 mm leaves no flank",
        ),
    ],
)
def test_chamfer_that_is_none_is_a_matter_of_geometry(one, problem):
    with pytest.raises(GeometryError, match=problem):
        one()
