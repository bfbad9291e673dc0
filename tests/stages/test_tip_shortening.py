"""Computed tip shortening of stages: planets have two mates, and their tips are one."""

from math import cos, radians
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from loaded_tca.stages import parse_stage
from tests.refusals import refused_calls

TEXT = (Path(__file__).parents[2] / "examples" / "stages" / "helical_automotive.toml").read_text(encoding="utf-8")
MODULE, DISTANCE = 1.5, 41.0
SHIFTED = {
    "pair.centre_distance_mm": DISTANCE,
    "planet.profile_shift": 0.4,
    "ring.profile_shift": None,
    "ring.tip_diameter_mm": None,
    "sun.modifications.tip_relief_um": 0.0,
    "planet.modifications.tip_relief_um": 0.0,
}


def stage(**changes):
    return parse_stage(TEXT).with_changes(SHIFTED | {name.replace("__", "."): value for name, value in changes.items()})


def test_tips_of_sun_and_planets_keep_the_clearance():
    """k m_n = a - a_d - m_n (x1 + x2): both tips of the mesh with the sun are h_fP - h_aP from the roots."""
    of_sun, of_ring = stage(pair__tip_shortening="computed").meshes
    rolled = 0.5 * (30 + 20) * MODULE / cos(radians(20.0))
    shortening = DISTANCE - rolled - MODULE * (of_sun.pinion.profile_shift + 0.4)
    assert shortening < -0.05
    gears = of_sun.pinion, of_sun.wheel, of_ring.pinion, of_ring.wheel
    # rounding of lengths of a hundred millimetres; the ring, which the formula lengthens, has what it had
    assert_allclose([gear.tip_alteration for gear in gears], [*[shortening] * 3, 0.0], atol=1e-9)
    assert_allclose(of_sun.tip_clearances, 0.25 * MODULE, atol=1e-9)


def test_stage_without_shortening_is_the_one_of_before():
    assert stage(pair__tip_shortening="none").meshes == stage().meshes


@pytest.mark.parametrize(
    ("tips", "whose"), [({"ring__tip_diameter_mm": 110.2}, 3), ({"sun__tip_alteration_coefficient": -0.2}, 0)]
)
def test_tip_of_a_gear_stands_beside_those_that_are_computed(tips, whose):
    """The formula has profile shifts and the centre distance alone: a given tip changes no other."""
    meshes = [stage(pair__tip_shortening="computed", **given).meshes for given in ({}, tips)]
    computed, given = ((sun.pinion, sun.wheel, ring.pinion, ring.wheel) for sun, ring in meshes)
    for number, (before, after) in enumerate(zip(computed, given, strict=True)):
        assert (before == after) == (number != whose)
    # 110.2 mm as given; k m_n = -0.2 m_n
    tip = 2.0 * given[3].tip_radius if whose == 3 else given[0].tip_alteration
    assert_allclose(tip, 110.2 if whose == 3 else -0.2 * MODULE, rtol=1e-12)


test_tips_of_all_gears_leave_none_to_compute = refused_calls(
    (
        lambda: stage(
            pair__tip_shortening="computed", ring__tip_diameter_mm=110.2, planet__topping=True, sun__topping=True
        ),
        '^pair.tip_shortening: found "computed" beside a tip of every gear; leave one',
    ),
)
