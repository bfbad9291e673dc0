"""The bores that are held rigid are known, and refused, before anything is computed."""

import math
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.scene import read_scene

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
ROOTS = (67.5, 103.5)  # m (z - 2.5) of 25/37, m 3


def bending(name="mesh_cycle_finite_elements", **bores):
    changes = {f"{gear}.bore_diameter_mm": bore for gear, bore in bores.items()}
    return read_scene(SCENES / f"{name}.toml").with_changes({"analysis.compliance": "contact+tooth", **changes})


def test_bores_are_those_given_or_a_part_of_the_root():
    # also below: a product
    assert_allclose(bending().rigid_bores, [0.55 * root for root in ROOTS], rtol=1e-12)
    assert bending(pinion=30.0, wheel=40.0).rigid_bores == (30.0, 40.0)


def test_a_solid_gear_is_held_by_journals_of_the_default_diameter():
    assert_allclose(bending(pinion=0.0, wheel=40.0).rigid_bores, [0.55 * ROOTS[0], 40.0], rtol=1e-12)


@pytest.mark.parametrize("name", ["mesh_cycle_finite_elements", "mesh_cycle_bevel", "face_milled_19x62_matched"])
def test_a_bore_is_not_negative(name):
    with pytest.raises(InputError, match=r"pinion\.bore_diameter_mm: found -1\.0; allowed a number from 0 to 100000"):
        bending(name, pinion=-1.0)


def test_a_gear_without_bore_is_held_at_the_seat_of_its_shaft():
    """A shaft as thick as the body is one with the teeth: 0.8 of the pinion's root, (34/cos(15 deg) - 2.5) 3 mm."""
    none = {"pinion.bore_diameter_mm": None, "wheel.bore_diameter_mm": None}
    scene = read_scene(SCENES / "helical_on_shafts.toml").with_changes(none)
    root = 3.0 * (34.0 / math.cos(math.radians(15.0)) - 2.5)
    assert scene.rigid_bores == (45.0, 60.0)
    for part, bore in ((0.79, 0.79 * root), (0.81, 0.55 * root)):
        thick = scene.with_changes({"pinion.shaft.sections.2.outer_diameter_mm": round(part * root, 6)})
        assert_allclose(thick.rigid_bores, [bore, 60.0], rtol=1e-6)
    shoulder = scene.with_changes({"pinion.shaft.start_mm": -160.0, "pinion.shaft.torque_at_mm": -150.0})
    assert shoulder.rigid_bores == (40.0, 60.0)  # the thinner part of two that meet at mid-face
    assert scene.with_changes({"pinion.bore_diameter_mm": 44.0}).rigid_bores == (44.0, 60.0)


def test_no_bore_is_held_where_the_flanks_alone_yield():
    scene = bending(pinion=67.4).with_changes({"analysis.compliance": "contact"})
    assert scene.rigid_bores is None


def test_bores_of_equal_bevel_gears_are_equal():
    """The toe, where a cone is smallest: below the root there, 17/17 at a right angle."""
    pinion, wheel = bending("mesh_cycle_bevel").rigid_bores
    assert_allclose(pinion, wheel, rtol=1e-9)
    outer, inner = 17.0, 17.0 * (12.02 - 4.8) / 12.02  # pitch diameters at heel and toe, R_e = 12.02 mm
    assert 0.4 * inner < pinion < 0.55 * inner < 0.55 * outer


@pytest.mark.parametrize("names", [("pinion",), ("wheel",), ("pinion", "wheel")])
def test_bore_that_leaves_no_rim_is_refused_by_its_gear(names):
    given = {name: 0.99 * root for name, root in zip(("pinion", "wheel"), ROOTS, strict=True) if name in names}
    with pytest.raises(InputError) as caught:
        _ = bending(**given).rigid_bores
    assert [problem.partition(":")[0] for problem in caught.value.problems] == list(names)
    assert all("no rim is left below the teeth" in problem for problem in caught.value.problems)
