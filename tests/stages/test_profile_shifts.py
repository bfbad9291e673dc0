"""Profile shifts of stages whose centre distance is given: one planet, and no backlash where shifts follow."""

from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.stages import parse_stage
from tests.refusals import refused_calls

TEXT = (Path(__file__).parents[2] / "examples" / "stages" / "helical_automotive.toml").read_text(encoding="utf-8")
GIVEN = {
    "pair.centre_distance_mm": 40.2,  # 0.29 above the sum of the reference radii
    "sun.profile_shift": None,
    "planet.profile_shift": None,
    "ring.profile_shift": None,
    "ring.tip_diameter_mm": None,
}


def stage(**shifts):
    others = {f"{name}.profile_shift": shift for name, shift in shifts.items()}
    return parse_stage(TEXT).with_changes(GIVEN | others)


@pytest.mark.parametrize("shifts", [{"sun": 0.15}, {"planet": 0.1}, {"ring": -0.1}, {}, {"sun": 0.1, "planet": 0.05}])
def test_planet_is_one_gear_in_both_meshes(shifts):
    of_sun, of_ring = stage(**shifts).meshes
    for of_gear in ("profile_shift", "tip_radius", "root_radius", "normal_tooth_thickness"):
        assert getattr(of_sun.wheel, of_gear) == getattr(of_ring.pinion, of_gear)


@pytest.mark.parametrize("shifts", [{"sun": 0.15}, {"planet": 0.1}, {"ring": -0.1}])
def test_shifts_that_follow_leave_no_backlash(shifts):
    """Of one given shift, the other two follow, each from a mesh; a nanometre is rounding."""
    for mesh in stage(**shifts).meshes:
        assert_allclose(mesh.backlash_at(mesh.working_centre_distance), 0.0, atol=1e-6)


def test_without_any_shift_all_are_nought_and_a_wide_backlash_is_told():
    whole = stage()
    module = whole.geometry.normal_module_mm
    assert whole.profile_shifts == (0.0, 0.0, 0.0)
    assert whole.sun_scene.missing_shifts() == []  # 0.29 mm of 1.5
    apart = whole.with_changes({"pair.centre_distance_mm": 39.91 + 0.7 * module})
    (sentence,) = apart.sun_scene.missing_shifts()
    assert sentence.startswith("wide backlash")


def test_given_shifts_keep_their_backlash():
    """A gear that follows is of its own mesh alone: the sun stands with the shift that is given."""
    of_sun, of_ring = stage(sun=0.1, planet=0.05).meshes
    assert (of_sun.pinion.profile_shift, of_sun.wheel.profile_shift) == (0.1, 0.05)
    assert of_sun.backlash_at(of_sun.working_centre_distance) > 0.01
    assert_allclose(of_ring.backlash_at(of_ring.working_centre_distance), 0.0, atol=1e-6)
    assert stage().profile_shifts == (0.0, 0.0, 0.0)


def test_planets_of_which_the_sun_alone_is_given_have_computed_tips():
    of_sun, of_ring = stage(sun=0.15).with_changes({"pair.tip_shortening": "computed"}).meshes
    assert of_sun.wheel.tip_radius == of_ring.pinion.tip_radius
    assert_allclose(of_sun.tip_clearances[0], 0.25 * 1.5, atol=1e-9)  # of the basic rack


def test_refused_gear_says_which_shifts_the_centre_distance_asks_for():
    with pytest.raises(InputError, match=r"^sun: bore_diameter_mm: 60 mm is not below") as refused:
        _ = stage(planet=0.1, ring=-0.1).with_changes({"sun.bore_diameter_mm": 60.0}).meshes
    assert len(refused.value.__notes__) == 1
    assert refused.value.__notes__[0].startswith("pair.centre_distance_mm = 40.2 and the profile shifts that are given")
    assert refused.value.__notes__[0].endswith(" on the sun")


test_shifts_that_no_stage_has_are_refused = refused_calls(
    (
        lambda: stage(sun=0.1, ring=-0.2),
        "^planet.profile_shift: missing; pair.centre_distance_mm asks for one value with sun",
    ),
    (
        lambda: stage(sun=0.1).with_changes({"pair.centre_distance_mm": 60.0}).meshes,
        "pair.centre_distance_mm: found 60; .* on the planet, allowed -5 to 5",
        GeometryError,
    ),
    (
        lambda: stage(sun=0.1).with_changes({"pair.centre_distance_mm": 20.0}).meshes,
        "^centre_distance_mm: 20 mm is not above",
        GeometryError,
    ),
)
