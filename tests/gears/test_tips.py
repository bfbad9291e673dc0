"""Tip circles of basic racks, topping tools and computed tip shortening."""

from dataclasses import replace
from math import cos, inf, pi, radians, sin, tan

import pytest
from numpy.testing import assert_allclose

from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
from loaded_tca.gears.tips import computed_tip_alteration
from tests.refusals import refused_calls

ROUNDING = 1e-12  # relative, or mm of lengths of 30 mm: a few products and sums
ANGLE = radians(20.0)


def gear(teeth=25, helix=0.0, **given):
    return CylindricalGear(teeth, 2.0, 40.0, helix_angle=helix, **given)


def ring(**given):
    return RingGear(-60, 2.0, 40.0, **given)


@pytest.mark.parametrize("helix", [0.0, 0.3])
def test_shortened_tips_have_the_clearance_of_gears_without_shift(helix):
    """A quarter of a module with the basic rack of ISO 53, at whatever distance leaves no backlash."""
    shifts = 0.5, 0.3
    k = computed_tip_alteration((25, 34), shifts, 2.0, pressure_angle=ANGLE, helix_angle=helix)
    given = {"tip_alteration_coefficient": k}
    mesh = CylindricalMesh(
        gear(25, helix, profile_shift=shifts[0], **given), gear(34, -helix, profile_shift=shifts[1], **given)
    )
    assert -0.2 < k < 0.0
    assert_allclose(mesh.tip_clearances, 0.25 * 2.0, rtol=1e-9)
    at_distance = computed_tip_alteration(
        (25, 34), shifts, 2.0, pressure_angle=ANGLE, helix_angle=helix, centre_distance=mesh.working_centre_distance
    )
    assert_allclose(at_distance, k, rtol=1e-9)


def test_tips_are_not_lengthened():
    """Neither where a larger distance leaves backlash nor in a ring, where the formula does."""
    assert computed_tip_alteration((25, 34), (0.0, 0.0), 2.0, pressure_angle=ANGLE, centre_distance=60.0) == 0.0
    assert computed_tip_alteration((25, -60), (0.5, 0.1), 2.0, pressure_angle=ANGLE) == 0.0
    assert computed_tip_alteration((25, 34), (0.2, -0.2), 2.0, pressure_angle=ANGLE) == pytest.approx(0.0, abs=ROUNDING)


@pytest.mark.parametrize("make", [gear, ring])
def test_topping_cuts_tips_with_the_allowance(make):
    plain = make(profile_shift=0.1, thickness_allowance=-0.1)
    topped = replace(plain, topping=True)
    assert_allclose(abs(plain.tip_radius - topped.tip_radius), 0.05 / tan(ANGLE), rtol=1e-9)
    assert abs(topped.tip_radius - topped.root_radius) < abs(plain.tip_radius - plain.root_radius)
    assert replace(topped, thickness_allowance=0.0).tip_radius == make(profile_shift=0.1).tip_radius


@pytest.mark.parametrize("make", [gear, ring])
def test_addendum_of_the_rack_is_the_height_of_the_tip(make):
    high, usual = make(addendum_coefficient=1.2), make()
    assert_allclose(abs(high.tip_radius - high.reference_radius), 2.4, rtol=ROUNDING)
    assert_allclose([high.tip_alteration, usual.tip_alteration], 0.0, atol=ROUNDING)
    assert_allclose(make(tip_alteration_coefficient=-0.1).tip_alteration, -0.2, rtol=1e-9)


def test_full_rounding_leaves_no_land_on_the_rack():
    """The arc of the rack's tip touches both its flanks and the line of its tip: pi/4 - h tan = rho (1 - sin)/cos."""
    full = gear(root_radius_coefficient=inf)
    assert_allclose(
        full.rack_tip_radius, 2.0 * (0.25 * pi - 1.25 * tan(ANGLE)) * cos(ANGLE) / (1.0 - sin(ANGLE)), rtol=ROUNDING
    )
    radius, angle = full.root_fillet(9)
    assert_allclose([radius[-1], angle[-1]], [full.root_radius, pi / 25], rtol=1e-9)
    inside = ring(root_radius_coefficient=inf)
    assert_allclose(inside.root_fillet(9)[1][-1], pi / 60, rtol=1e-9)
    assert inside.fillet_radius > ring().fillet_radius


def test_racks_of_their_own_mesh():
    """Clearances of both gears: the dedendum of one less the addendum of the other."""
    first = gear(dedendum_coefficient=1.4, root_radius_coefficient=0.2, addendum_coefficient=1.1)
    mesh = CylindricalMesh(first, gear(34))
    assert_allclose(mesh.tip_clearances, [0.8, 0.3], rtol=1e-9)
    internal = InternalMesh(first, ring(addendum_coefficient=0.8))
    assert_allclose(internal.tip_clearances, [1.2, 0.3], rtol=1e-9)


test_tips_refuse = refused_calls(
    (lambda: gear(topping=True, tip_diameter=53.0), "^gear: topping: true beside a tip_diameter"),
    (lambda: ring(topping=True, tip_alteration_coefficient=-0.1), "^ring: topping: true beside a tip_diameter"),
    (
        lambda: ring(tip_diameter=116.5, tip_alteration_coefficient=-0.1),
        "^ring: tip_alteration_coefficient: -0.1 beside a tip_diameter of 116.5 mm; give one of them",
    ),
    (lambda: gear(addendum_coefficient=0.0), "^gear: addendum_coefficient: 0.0 is not positive and finite"),
    (
        lambda: gear(root_radius_coefficient=float("nan")),
        "^gear: root_radius_coefficient: nan is negative or no number",
    ),
    (
        lambda: computed_tip_alteration((25, 34), (-2.0, -2.0), 2.0, pressure_angle=ANGLE),
        "^profile_shift: for the sum -4 no centre distance is without backlash",
    ),
)
