"""Pairs with rounded edges: which radii are refused, and what they share with the pairs with sharp ones."""

import math

import pytest

from loaded_tca.errors import InputError
from loaded_tca.flanks.rounding import EdgeRounding, RoundedFlank
from loaded_tca.scene import parse_scene, read_scene
from tests.samples.gear_pairs import gear_pair
from tests.samples.results import SCENES
from tests.scene.conftest import SMALL

KEYS = [f"{gear}.{edge}_rounding_mm" for gear in ("pinion", "wheel") for edge in ("tip", "side")]
FAMILIES = ("helical", "straight_bevel", "spiral_bevel", "duplex_30x20", "bspline_bevel", "measured_flank")


@pytest.mark.parametrize("name", FAMILIES)
def test_every_kind_of_gear_may_have_rounded_edges(name):
    scene = read_scene(SCENES / f"{name}.toml")
    pair = scene.with_changes(dict.fromkeys(KEYS, 0.1)).pair()
    for gear in (pair.pinion, pair.wheel):
        assert isinstance(gear.flank, RoundedFlank)
        assert isinstance(gear.back, RoundedFlank)
        assert gear.flank.rounding == EdgeRounding(0.1, 0.1)
        assert not isinstance(gear.sharp.flank, RoundedFlank)


@pytest.mark.parametrize("name", FAMILIES)
def test_edges_are_sharp_unless_a_radius_is_given(name):
    scene = read_scene(SCENES / f"{name}.toml")
    for one in (scene, scene.with_changes(dict.fromkeys(KEYS, 0.0))):
        pair = one.pair()
        assert pair.sharp is pair
        assert not isinstance(pair.pinion.flank, RoundedFlank)


def test_pair_without_radii_is_the_pair():
    pair = gear_pair()
    assert pair.rounded() is pair
    assert pair.rounded(wheel=EdgeRounding(tip=0.1)).pinion is pair.pinion


def test_teeth_are_unlike_but_models_of_their_bending_are_shared():
    """Bending and root stress are found for ``geometry.unmodified``."""
    pair = gear_pair()
    one, other = (pair.rounded(pinion=EdgeRounding(tip=radius)).pinion for radius in (0.1, 0.2))
    assert one.geometry != other.geometry
    assert one.geometry.unmodified == other.geometry.unmodified == pair.pinion.geometry.unmodified
    assert hash(one.geometry.unmodified) == hash(pair.pinion.geometry.unmodified)
    assert one.nominal_flank is pair.pinion.nominal_flank


@pytest.mark.parametrize("key", KEYS)
@pytest.mark.parametrize("value", [0.009, -0.1, math.nan])
def test_radius_below_a_hundredth_of_a_millimetre_is_refused(key, value):
    with pytest.raises(InputError) as refused:
        parse_scene(SMALL).with_changes({key: value})
    (problem,) = refused.value.problems
    assert problem.startswith(f"{key}: found ")
    assert problem.endswith("; allowed 0, or a number from 0.01 to 1000")


def test_radius_above_a_third_of_a_module_is_refused_for_every_gear_at_once():
    scene = parse_scene(SMALL).with_changes(dict.fromkeys(KEYS, 0.91))
    with pytest.raises(InputError) as refused:
        scene.pair()
    assert refused.value.problems == tuple(
        f"{key}: found 0.91; allowed up to 0.9 mm, 0.3 normal modules" for key in KEYS
    )


def test_module_of_the_limit_is_the_normal_one():
    scene = parse_scene(SMALL).with_changes(dict.fromkeys(KEYS, 0.9))
    assert isinstance(scene.pair().pinion.flank, RoundedFlank)


def test_arcs_that_meet_on_the_land_are_refused():
    """Pinion of 14 teeth with x = 0.6: thickness at the tip by the involute formula, tangent r tan((pi - w)/2)."""
    pair = gear_pair(teeth=(14, 57), shifts=(0.6, 0.0))
    gear = pair.pinion.geometry.gear
    pressure = math.acos(gear.base_radius / gear.tip_radius)
    land = gear.tooth_thickness_at(gear.tip_radius)
    most = 0.5 * land / math.tan(0.5 * (0.5 * math.pi - pressure))  # w = pi/2 + alpha_a
    assert most < 0.3 * 3.0, "else the module is the limit"
    assert pair.rounded(pinion=EdgeRounding(tip=0.999 * most)).pinion is not pair.pinion
    with pytest.raises(InputError) as refused:
        pair.rounded(pinion=EdgeRounding(tip=1.001 * most))
    (problem,) = refused.value.problems
    assert problem == (
        f"pinion.tip_rounding_mm: found {1.001 * most:g}; allowed up to {most:.4g} mm, with which the arcs of both "
        f"flanks meet on the tip land, {land:.4g} mm wide"
    )


def test_side_arcs_that_leave_no_flank_are_refused():
    """On spur teeth each of them reaches over its radius."""
    pair = gear_pair(width=0.5)
    assert pair.rounded(wheel=EdgeRounding(side=0.249)).wheel is not pair.wheel
    told = r"^wheel.side_rounding_mm: found 0.251; allowed up to 0.25 mm, .*no flank is left.*0.5 mm apart$"
    with pytest.raises(InputError, match=told):
        pair.rounded(wheel=EdgeRounding(side=0.251))


def test_tip_arc_that_leaves_no_flank_is_refused():
    """A stub tooth: the arc reaches down r (1 - sin(alpha_a)) from the tip."""
    scene = parse_scene(SMALL).with_changes({"pair.helix_angle_deg": 0.0})
    root = 2.0 * scene.pair().pinion.nominal_flank.radii[0]
    stub = scene.with_changes({"pinion.tip_diameter_mm": root + 0.4})
    gear = stub.mesh().pinion
    sine = math.sqrt(1.0 - (gear.base_radius / gear.tip_radius) ** 2)
    most = (gear.tip_radius - gear.form_radius) / (1.0 - sine)
    assert most < 0.9, "else the module is the limit"
    assert isinstance(stub.with_changes({"pinion.tip_rounding_mm": 0.999 * most}).pair().pinion.flank, RoundedFlank)
    told = r"^pinion.tip_rounding_mm: found .*; allowed up to .* mm, with which no flank is left above the root edge"
    with pytest.raises(InputError, match=told):
        stub.with_changes({"pinion.tip_rounding_mm": 1.001 * most}).pair()
