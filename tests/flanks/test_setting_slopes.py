"""Derivatives of generated flanks to their settings, beside differences of flanks that are cut anew."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import GeometryError
from loaded_tca.flanks.setting_slopes import OF_ROLL, SETTINGS, cut_at, setting_of, with_settings
from loaded_tca.gears import Blade, Cutter
from tests.flanks.test_cradle import EVERY_SETTING, HOLLOW, PLACES
from tests.samples.face_milled import published_pinion

RHO, Z = (part[7:10] for part in PLACES)
STRAIGHT = Blade(94.0, math.radians(19.0))
GEARS = {
    "generated": replace(published_pinion(), machine=EVERY_SETTING, cutter=Cutter(HOLLOW, STRAIGHT, 2.0)),
    "formate": replace(
        published_pinion(),
        machine=replace(EVERY_SETTING, generation="formate", tilt=0.3),
        cutter=Cutter(HOLLOW, STRAIGHT, 2.0),
    ),
}


CHANGE = 2e-5
"""rad, of Theta in a difference: what bends misses it by up to 2e-6 of it, rounding by 1e-9."""


@pytest.mark.parametrize(("kind", "flank"), [("generated", "concave"), ("generated", "convex"), ("formate", "concave")])
def test_slopes_are_those_of_flanks_that_are_cut_anew(kind, flank):
    gear = GEARS[kind]
    names = [name for name in SETTINGS if setting_of(gear, name) is not None]
    slopes = cut_at(gear, flank, RHO, Z, names)[1]
    for name, slope in zip(names, slopes, strict=True):
        value, step = setting_of(gear, name), min(CHANGE / max(np.abs(slope).max(), 1e-3), 0.05)
        up, down = (cut_at(with_settings(gear, {name: value + way * step}), flank, RHO, Z)[0] for way in (1, -1))
        assert_allclose((up - down) / (2.0 * step), slope, rtol=0.0, atol=1e-5 * np.abs(slope).max() + 1e-12)


def test_settings_of_roll_do_nothing_to_a_formate_gear_and_a_blade_nothing_to_the_other_flank():
    names = [f"machine.{name}" for name in OF_ROLL] + ["cutter.convex.point_radius", "cutter.convex.blade_angle"]
    assert not cut_at(GEARS["formate"], "concave", RHO, Z, names)[1].any()


def test_point_that_the_cutter_does_not_leave_is_told():
    with pytest.raises(GeometryError, match="concave flank: at 3 of 3 points the cutter leaves no flank"):
        cut_at(GEARS["generated"], "concave", 3.0 * RHO, 3.0 * Z)
