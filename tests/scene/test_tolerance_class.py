"""Tolerance classes as scatter of scenes: slopes of cylindrical gears within the tolerances of ISO 1328-1."""

import pytest

from loaded_tca import InputError, read_scene
from loaded_tca.reference.iso1328 import flank_tolerances
from loaded_tca.studies import Study
from tests.refusals import refused_calls
from tests.samples.results import SCENES

HELIX, PROFILE = "pinion.modifications.helix_slope_um", "wheel.modifications.profile_slope_um"


def scene(name="helical.toml", **changes):
    return read_scene(SCENES / name).with_changes({key.replace("__", "."): value for key, value in changes.items()})


def test_slopes_of_a_class_are_within_their_tolerances_three_times_in_a_thousand_not():
    one = scene()
    scatter, gears = one.scatter_of_class(6), one.mesh()
    for name, gear in (("pinion", gears.pinion), ("wheel", gears.wheel)):
        bounds = flank_tolerances(gear.teeth, 3.0, gear.face_width, 6, gear.helix_angle)
        for key, bound in (("helix_slope_um", bounds.helix_slope), ("profile_slope_um", bounds.profile_slope)):
            found = scatter[f"{name}.modifications.{key}"]
            assert found.cdf(bound) - found.cdf(-bound) == pytest.approx(0.9973, abs=1e-4)
    assert len(scatter) == 4


def test_scatter_lies_about_the_slopes_of_the_scene_or_about_zero():
    sloped = scene(pinion__modifications__helix_slope_um=5.0)
    assert sloped.scatter_of_class(5)[HELIX].mean() == 5.0
    assert sloped.scatter_of_class(5)[PROFILE].mean() == 0.0
    assert sloped.scatter_of_class(5, deviations=True)[HELIX].mean() == 0.0


def test_two_classes_more_are_twice_the_scatter():
    fine, coarse = (scene().slope_tolerances(cls) for cls in (8, 10))
    for key, bound in fine.items():
        assert coarse[key] == pytest.approx(2.0 * bound, abs=1.0)  # both rounded to a micrometre


def test_a_study_takes_the_scatter_as_it_is():
    study = Study(scene(), distributions=scene().scatter_of_class(7), samples=4)
    assert set(study.changes(0)) == set(scene().slope_tolerances(7))


test_tolerance_class_refuses = refused_calls(
    (lambda: scene().scatter_of_class(0), "^pinion: tolerance_class: 0 is not one of 1 to 11"),
    (
        lambda: scene("spiral_bevel.toml").scatter_of_class(6),
        "^tolerance_class: 6; ISO 1328-1 holds for cylindrical gears",
    ),
    (
        lambda: scene(wheel__face_width_mm=3.0).scatter_of_class(6),
        "^wheel: face_width: 3 mm, where ISO 1328-1 holds for 4 to 1200 mm",
    ),
    error=InputError,
)
