"""Roots that tools with protuberance cut: the tool rolled over the gear point by point, limits, the notch."""

from math import cos, pi, radians, sin, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalGear
from loaded_tca.gears.protuberance import notch_factor
from tests.refusals import refused_calls

ROUNDING = 1e-12  # of some dozen functions and products on lengths of 30 mm
ANGLE = radians(20.0)


def gear(teeth=25, helix=0.0, **given):
    return CylindricalGear(teeth, 2.0, 20.0, helix_angle=helix, **{"profile_shift": 0.1, **given})


def ground(teeth=25, protuberance=0.10, stock=0.06, **given):
    return gear(teeth, protuberance=protuberance, grinding_stock=stock, **given)


def outline_of_tool(one, angle):
    """Half widths and heights above the reference line of a tooth of the tool: rounding and flank of a protuberance."""
    radius, depth = one.rack_tip_radius, one.dedendum_coefficient * one.normal_module
    undercut = one.protuberance - one.grinding_stock
    half = pi / 4.0 * one.normal_module - (depth - radius * (1.0 - sin(ANGLE))) * tan(ANGLE)
    centre = half + undercut / cos(ANGLE) - radius * cos(ANGLE), radius - depth
    slope = np.linspace(0.5 * pi, angle, 160)
    arc = centre[0] + radius * np.cos(slope), centre[1] - radius * np.sin(slope)
    length = np.linspace(0.0, 1.5, 60)
    return (
        np.concatenate([arc[0], arc[0][-1] + length * sin(angle)]),
        np.concatenate([arc[1], arc[1][-1] + length * cos(angle)]) + one.normal_module * one.generating_profile_shift,
    )


@pytest.mark.parametrize(("teeth", "angle"), [(19, 10.0), (60, 10.0), (150, 15.0)])
def test_root_is_what_the_tool_leaves_as_it_rolls(teeth, angle):
    """No point of the tool passes through the outline, and all of it is touched, in the parts below the flank."""
    one = ground(teeth, protuberance_angle=radians(angle))
    width, height = outline_of_tool(one, radians(angle))
    turn = np.linspace(-1.2, 0.4, 1001)[:, None] * 8.0 / teeth
    x, y = one.reference_radius + height, width - one.reference_radius * turn
    place = np.hypot(x, y), np.arctan2(y, x) + turn  # from the middle of the space
    radius, angles = one.root_fillet(801)
    space = pi / teeth - np.interp(place[0], radius[::-1], angles[::-1])
    inside = (place[0] < radius[0] - 1e-3) & (place[0] > radius[-1] + 0.01)  # below, angles run off along the root
    free = (space - place[1]) * place[0]
    assert free[inside].min() > -2e-5  # chords of the outline between 801 points
    reached = [free[inside & (np.abs(place[0] - each) < 0.02)].min() for each in radius[40:-200:80]]
    assert max(reached) < 2e-3  # steps of the tool


@pytest.mark.parametrize("helix", [0.0, 0.3])
def test_flank_ends_where_the_root_crosses_it(helix):
    one = ground(helix=helix)
    radius, angle = one.root_fillet(5)
    assert_allclose(radius[0], one.form_radius, rtol=ROUNDING)
    assert_allclose(angle[0], 0.5 * one.tooth_thickness_at(radius[0]) / radius[0], rtol=1e-9)
    assert one.form_radius > gear(helix=helix).form_radius
    assert_allclose(radius[-1], gear(helix=helix).root_radius, rtol=ROUNDING)
    assert one.meets_in_corner


def test_root_without_undercut_is_that_of_the_rack_to_the_bit():
    """Without protuberance, and with one that the stock takes away."""
    plain, none, equal = gear(), ground(protuberance=0.0, stock=0.0), ground(protuberance=0.06)
    for one in (none, equal):
        assert (one.root_fillet(7)[1] == plain.root_fillet(7)[1]).all()
        assert one.form_radius == plain.form_radius


def test_small_undercut_tends_to_none():
    """The crossing tends to the form circle of the rack with the root of the undercut: curves that touch there."""
    off = [ground(protuberance=0.06 + depth).form_radius - gear().form_radius for depth in (1e-4, 1e-6)]
    assert_allclose(off[0] / off[1], 10.0, rtol=0.05)
    assert off[1] < 0.01


def test_notch_begins_at_the_form_circle_and_fades_into_the_fillet():
    one, plain = ground(protuberance=0.02), gear()
    assert one.form_radius == plain.form_radius
    radius, angle = one.root_fillet(201)
    assert_allclose(angle[0], 0.5 * one.tooth_thickness_at(radius[0]) / radius[0], rtol=ROUNDING)
    thicker = 0.04 / cos(ANGLE) / plain.reference_radius  # of half the tooth, as the rack is narrower
    assert_allclose(angle[-1] - plain.root_fillet(3)[1][-1], thicker, rtol=1e-9)
    tangent = np.stack(one.root_fillet_tangent(201))
    step = np.stack([np.diff(radius), 0.5 * (radius[1:] + radius[:-1]) * np.diff(angle)])
    middle = 0.5 * (tangent[:, 1:] + tangent[:, :-1])
    assert_allclose(middle, step / np.linalg.norm(step, axis=0), atol=2e-3)  # of chords: the step of the grid squared


def test_notch_factor_of_no_notch_is_one():
    assert notch_factor(0.0, 1.0) == 1.0
    assert notch_factor(0.1, 1.0) > notch_factor(0.1, 2.0) > 1.0
    assert notch_factor(10.0, 1.0) == notch_factor(0.1, 0.0) == float("inf")


def test_protuberance_may_not_take_the_whole_flank():
    with pytest.raises(
        GeometryError, match=r"protuberance: the undercut of 0.39 mm .* does not come back to the flank"
    ):
        assert ground(150, protuberance=0.4, stock=0.01, protuberance_angle=radians(19.5)).form_radius


test_protuberance_refuses = refused_calls(
    (lambda: ground(stock=0.0), "^gear: protuberance: 0.1 mm needs a grinding_stock"),
    (lambda: ground(protuberance=0.6), "^gear: protuberance: 0.6 mm is not from 0 to a quarter of a module"),
    (lambda: ground(stock=-0.01), "^gear: grinding_stock: -0.01 mm is not from 0"),
    (lambda: ground(protuberance_angle=0.4), "^gear: protuberance_angle: 0.4 rad is not between 0 and the pressure"),
)
