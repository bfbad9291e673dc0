"""A gear knows the backs of its teeth: they are what touches in the other sense of rotation."""

import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.flanks import FlankModifications, SplineFlank
from loaded_tca.flanks.base import unmodified
from loaded_tca.scene import read_scene
from tests.refusals import refusals
from tests.samples.teeth import MESHES, RELIEVED, gear_of, pair_of

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
OTHER = {"positive": "negative", "negative": "positive"}
MEMBERS = pytest.mark.parametrize("member", ["pinion", "wheel"])


def assert_same_flank(found, expected):
    rho, z = expected.grid(9, 9)
    assert type(found) is type(expected)
    assert found.side == expected.side
    assert_array_equal(np.stack(found.grid(9, 9)), np.stack([rho, z]))  # exact, also below: the same flank made twice
    assert_array_equal(found.theta(rho, z).value, expected.theta(rho, z).value)


@MEMBERS
@pytest.mark.parametrize("driving", ["pinion", "wheel"])
@pytest.mark.parametrize("name", ["helical", "spiral bevel"])
def test_back_is_the_flank_in_contact_in_the_other_sense(name, driving, member):
    this, other = (
        getattr(pair_of(MESHES[name], sense, RELIEVED, driving=driving), member) for sense in ("positive", "negative")
    )
    assert_same_flank(this.back, other.flank)
    assert_same_flank(other.back, this.flank)
    assert_same_flank(this.nominal_back, other.nominal_flank)
    assert [flank.side for flank in other.flanks] == [flank.side for flank in other.nominal_flanks] == [1, -1]
    assert other.flanks[other.flank.side < 0] is other.flank
    assert other.nominal_flanks[other.flank.side < 0] is other.nominal_flank


@MEMBERS
@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("helical", {}),
        ("helical", {"pinion.flank.form": "bspline", "wheel.flank.form": "bspline"}),
        ("measured_flank", {}),
        ("face_milled_19x62_matched", {"pinion.modifications.lead_crowning_um": 5.0}),
    ],
    ids=["analytic", "fitted", "measured", "face-milled"],
)
def test_gear_of_a_scene_has_both_flanks_of_the_scene(name, changes, member):
    """A measurement belongs to the flank in contact by the scene, whichever sense is asked for."""
    scene = read_scene(SCENES / f"{name}.toml").with_changes(changes)
    this, other = (getattr(scene.pair(sense), member) for sense in (scene.sense, OTHER[scene.sense]))
    assert_same_flank(this.back, other.flank)
    assert_same_flank(other.back, this.flank)
    for gear in (this, other):
        rho, z = gear.flank.grid(5, 5)
        # rad; a fit is of the modified flank: 5e-12 seen, 3e-7 um at 50 mm
        assert unmodified(gear.flank).theta(rho, z).value == pytest.approx(
            gear.nominal_flank.theta(rho, z).value, abs=1e-11
        )


def test_measured_flank_has_an_analytic_back():
    scene = read_scene(SCENES / "measured_flank.toml")
    wheel = scene.pair().wheel
    assert isinstance(wheel.flank, SplineFlank)
    assert not isinstance(wheel.back, SplineFlank)


def test_backs_and_form_are_made_when_they_are_asked_for():
    gear = gear_of(MESHES["spur"], modifications=FlankModifications(lead_crowning=0.01))
    assert not {"back", "nominal_back", "form"} & set(vars(gear))
    assert gear.back is gear.back
    assert gear.nominal_back is gear.nominal_back
    assert gear.form is gear.form


def test_gear_survives_pickling():
    gear = gear_of(MESHES["spiral bevel"], modifications=RELIEVED)
    assert_same_flank(pickle.loads(pickle.dumps(gear)).back, gear.back)


def test_pair_with_other_flanks_keeps_its_gears():
    pair = pair_of(MESHES["spur"])
    other = pair.with_flanks(wheel=pair.wheel.back)
    assert other.pinion.flank is pair.pinion.flank
    assert other.wheel.flank is pair.wheel.back
    assert_same_flank(other.wheel.nominal_flank, pair.wheel.nominal_back)
    assert_same_flank(other.wheel.back, pair.wheel.flank)


@MEMBERS
def test_gear_whose_flank_is_replaced_by_its_back_is_that_of_the_other_sense(member):
    this, other = (getattr(pair_of(MESHES["helical"], sense, RELIEVED), member) for sense in ("positive", "negative"))
    turned = replace(this, flank=this.back)
    for name in ("flank", "back", "nominal_flank", "nominal_back"):
        assert_same_flank(getattr(turned, name), getattr(other, name))
    assert replace(this, flank=this.nominal_flank).nominal_flank is this.nominal_flank


@pytest.mark.parametrize("name", ["spur", "straight bevel"])
def test_smallest_bore_is_a_part_of_the_root_circle_at_the_toe(name):
    gear, macro = gear_of(MESHES[name]), MESHES[name].pinion
    root = macro.root_radius if name == "spur" else macro.inner_cone_distance * math.sin(macro.root_cone_angle)
    assert_allclose(gear.smallest_bore, 0.55 * 2.0 * root, rtol=1e-12)  # of a factor: 4e-16 seen


@pytest.mark.parametrize("name", ["spur", "straight bevel"])
def test_journals_of_a_solid_gear_are_as_thick_as_the_default_bore(name):
    gear = gear_of(MESHES[name])
    solid = replace(gear, bore_diameter=0.0)
    assert solid.is_solid
    assert not gear.is_solid
    assert solid.smallest_bore == gear.smallest_bore


test_bore_that_does_not_hold_the_gear_is_refused = refusals(
    lambda diameter: replace(gear_of(MESHES["spur"]), bore_diameter=diameter).smallest_bore,
    *(
        (thin, r"bore_diameter: .* mm is not between 0.05 and 0.98 times .* so thin a bore")
        for thin in (-1.0, 0.1, 3.2)
    ),
    *((wide, r"bore_diameter: .* no rim is left below the teeth") for wide in (math.nan, 64.5)),
)
