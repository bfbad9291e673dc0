"""Scenes of a pinion and a rack: from the file to results along the rack."""

from __future__ import annotations

import re
import warnings
from math import atan, cos, degrees, pi, radians, sin, sqrt, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from loaded_tca import MeshCycle, Scene, analyse, analyse_revolution, parse_scene, read_scene
from loaded_tca.errors import AccuracyWarning, InputError, NotAskedError
from loaded_tca.scene import CylindricalScene
from loaded_tca.scene.key_reference import scene_reference
from validation.cylindrical.undercut import rolled_form_radius

ROUNDING = 1e-12  # of a few products
EXAMPLE = read_scene(Path(__file__).parents[2] / "examples" / "scenes" / "rack_and_pinion.toml")
SPUR = EXAMPLE.with_changes(
    {
        "pair.helix_angle_deg": 0.0,
        "pinion.modifications": {},
        "wheel.modifications": {},
        "mounting": {},
        "analysis": {"positions": 1, "cells": [8, 8], "compliance": "contact", "load_sharing": False},
    }
)
"""A spur pinion on a rack without modifications: a line contact, in its middle position."""
RADIUS, BASE = 30.0, 30.0 * cos(radians(20.0))
HARD = {"material": "18CrNiMo7-6", "flank_Rz_um": 4.8, "root_Rz_um": 20.0}
RATING = {
    "required_flank_safety": 1.0,
    "required_root_safety": 1.4,
    "life_hours": 100.0,
    "dynamic_factor": "given",
    "transverse_load_factor": 1.0,
}
RATED = {
    "pinion.strength": HARD,
    "wheel.strength": HARD,
    "wheel.length_mm": 500.0,
    "operation": {"pinion_speed_rpm": 150.0},
    "lubricant": {"viscosity_40_mm2_s": 220.0, "viscosity_100_mm2_s": 19.0, "oil_temperature_C": 70.0},
    "rating": RATING,
}


def with_wheel(teeth: int) -> dict[str, Any]:
    """Changes that put a wheel in the place of the rack."""
    wheel = {"teeth": teeth, "face_width_mm": 29.0}
    return {"pair": {"type": "cylindrical", "normal_module_mm": 3.0}, "wheel": wheel}


OF_RACKS = {"wheel.height_mm": 26.0, "wheel.length_mm": 500.0}
"""Keys that the wheel of a pair does not have."""


def test_rack_becomes_a_wheel_and_a_wheel_a_rack_by_changes_alone() -> None:
    """None takes the keys of a rack away; keys of a wheel that were never given do not stand in the way of a rack."""
    wheel = EXAMPLE.with_changes({"wheel.teeth": 57} | dict.fromkeys(OF_RACKS))
    assert type(wheel) is CylindricalScene
    assert wheel.wheel.teeth == 57
    assert wheel.wheel.modifications == EXAMPLE.wheel.modifications
    assert wheel.with_changes({"wheel.teeth": "rack", **OF_RACKS}) == EXAMPLE


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"wheel.teeth": 57}, r"wheel\.height_mm: unknown key"),  # a value is not lost unasked
        ({"wheel.teeth": 57, **OF_RACKS}, r"wheel\.length_mm: unknown key"),
        ({"wheel.teeth": 57, **dict.fromkeys(OF_RACKS), "wheel.hight_mm": None}, r"wheel\.hight_mm: unknown key"),
    ],
)
def test_keys_that_a_wheel_does_not_have_are_refused_with_values_and_unknown_ones_always(
    changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        EXAMPLE.with_changes(changes)


def solved(scene: Scene) -> MeshCycle:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # of so few cells
        return analyse(scene)


def test_line_contact_at_the_pitch_point_is_that_of_a_plane_and_a_cylinder() -> None:
    """Hertz, Johnson 1985, eq. 4.45: p0 = sqrt(F E*/(pi b rho)), with the curvature of the pinion alone.

    The gear that stands for the rack adds z1/z2 = 1e-5 of it, of which pressures have half.
    """
    result = solved(SPUR)
    modulus = 206000.0 / (2.0 * (1.0 - 0.3**2))
    pressure = sqrt(250e3 / BASE * modulus / (pi * 29.0 * RADIUS * sin(radians(20.0))))
    assert result.hertz_pressure[0, 0, 0] == pytest.approx(pressure, rel=1e-5)


def test_wheels_of_more_and_more_teeth_tend_to_the_rack() -> None:
    """The difference of their pressures goes with 1/z2: from 2500 to 10000 teeth it is a quarter, to 1 %."""
    rack = float(solved(SPUR).hertz_pressure[0, 0, 0])
    far, near = (
        float(solved(SPUR.with_changes(with_wheel(teeth))).hertz_pressure[0, 0, 0]) - rack for teeth in (2500, 10000)
    )
    assert far / near == pytest.approx(4.0, rel=0.01)


def test_numbers_along_the_rack() -> None:
    """It travels r_1 phi1 and stays behind by e tan(alpha_t) without load, e apart; F = T/r_1."""
    changes = {"pinion.modifications.lead_crowning_um": 5.0, "mounting.centre_distance_error_mm": 0.1}
    result = solved(SPUR.with_changes(changes | {"analysis.positions": 3, "analysis.torques_Nm": [1e-3, 30.0]}))
    assert result.rack_travel == pytest.approx(RADIUS * np.array([-pi / 20.0, 0.0, pi / 20.0]), abs=1e-9)
    assert result.rack_force == pytest.approx([1.0 / RADIUS, 30e3 / RADIUS], rel=ROUNDING)
    figures = result.key_figures()
    assert figures[0]["rack_transmission_error_mean_um"] == pytest.approx(-100.0 * tan(radians(20.0)), abs=0.01)
    along = cos(radians(20.0)) * figures[1]["rack_transmission_error_mean_um"]
    assert along == pytest.approx(figures[1]["transmission_error_mean_um"], rel=1e-5)  # on the path of contact
    assert np.isnan(figures[1]["transmission_error_mean_arcsec"])  # a rack does not turn
    assert "transmission error along the rack, mean | peak to peak [um]" in result.summary()


def test_profile_shift_follows_the_distance() -> None:
    """Of a pinion without one of its own: what leaves no backlash but that of the allowance, 60 um."""
    mesh = SPUR.with_changes({"pair.distance_mm": 30.9}).mesh()
    assert mesh.pinion.profile_shift == pytest.approx(0.3, rel=1e-9)
    assert mesh.backlash == pytest.approx(0.06, abs=1e-6)  # of 1e-5 of the shift, the limit


def test_check_has_the_pressure_angle_of_the_basic_rack_at_any_distance() -> None:
    """tan(alpha_t) = tan(alpha_n)/cos(beta), which no distance and no profile shift change."""
    for helix, angle in ((0.0, "20.0000"), (15.0, f"{degrees(atan(tan(radians(20.0)) / cos(radians(15.0)))):.4f}")):
        scene = SPUR.with_changes(
            {"pair.distance_mm": None, "pinion.profile_shift": 0.4, "pair.helix_angle_deg": helix}
        )
        rows = {name: cells for name, *cells in scene.geometry_rows()}
        assert rows["transverse pressure angle alpha_t [deg]"] == [angle]


def test_thickness_of_the_pinion_is_asked_about_where_it_looks_like_a_shift() -> None:
    """Of module 3: a hundredth of it is 30 um."""
    assert SPUR.missing_shifts() == []
    (sentence,) = SPUR.with_changes({"pinion.thickness_allowance_um": 200.0}).missing_shifts()
    shift = 0.2 / (2.0 * 3.0 * tan(radians(20.0)))
    assert f"with profile_shift = {shift:.4f} the same teeth have no allowance" in sentence


def test_reliefs_of_the_rack_start_below_its_tip_line() -> None:
    """Half the tip relief, where it is linear, is removed half way between start and tip line."""
    changes = {"tip_relief_um": 20.0, "tip_relief_start_mm": 2.0, "tip_relief_form": "linear"}
    scene = SPUR.with_changes({f"wheel.modifications.{key}": value for key, value in changes.items()})
    flank = scene.pair().wheel
    tip = scene.mesh().wheel.tip_radius
    rho = tip - np.array([2.5, 1.0, 0.0])
    angle = flank.flank.theta(rho, 0.0 * rho).value - flank.nominal_flank.theta(rho, 0.0 * rho).value
    removed = np.abs(angle) * scene.mesh().wheel.base_radius
    assert 1e3 * removed == pytest.approx([0.0, 10.0, 20.0], abs=1e-3)  # roundings of angles of 1e-6
    with pytest.raises(InputError, match=r"wheel.modifications.tip_relief_start_mm: found 6; allowed below 5\.\d"):
        scene.with_changes({"wheel.modifications.tip_relief_start_mm": 6.0}).pair()


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("pair.centre_distance_mm", 100.0, "pair.centre_distance_mm: found 100; a rack has no axis: give distance_mm"),
        ("wheel.bore_diameter_mm", 20.0, "wheel.bore_diameter_mm: found; a rack has none"),
        ("wheel.profile_shift", 0.1, "wheel.profile_shift: found; a rack has none: give pair.distance_mm"),
        ("wheel.support", {"stiffness": np.eye(6).tolist()}, "wheel.support: found; a rack has none"),
        ("wheel.pitch", {"runout_um": 5.0}, "wheel.pitch: found; a rack has none"),
        ("pinion.pitch", {"runout_um": 5.0}, "pinion.pitch: found; not allowed with a rack: whole revolutions"),
        ("revolution", {"pitches": 2}, "revolution: found; not allowed with a rack"),
        ("wheel.flank.form", "bspline", 'wheel.flank.form: found "bspline"; allowed "analytic"'),
        (
            "wheel.modifications.tip_relief_start_length_mm",
            2.0,
            "wheel.modifications.tip_relief_start_length_mm: found",
        ),
        ("wheel.teeth", "Rack", 'wheel.teeth: found "Rack"; allowed "rack"'),
        ("wheel.height_mm", None, "wheel.height_mm: missing"),
        (
            "rating",
            RATING | {"tolerance_class": 6},
            "rating.tolerance_class: found 6; not allowed with a rack, of which",
        ),
    ],
)
def test_what_a_rack_does_not_have_is_refused_by_its_key(key: str, value: Any, message: str) -> None:
    with pytest.raises(InputError) as refused:
        SPUR.with_changes({key: value})
    assert any(problem.startswith(message) for problem in refused.value.problems), refused.value.problems


def test_rating_of_a_rack_needs_its_length() -> None:
    with pytest.raises(InputError, match=r"^wheel\.length_mm: missing; \[rating\] needs this length"):
        SPUR.with_changes(RATED | {"wheel.length_mm": None})


def test_whole_revolutions_tolerances_and_numbers_of_wheels_are_refused() -> None:
    with pytest.raises(InputError, match=r'wheel\.teeth: found "rack"; allowed a number of teeth'):
        analyse_revolution(SPUR)
    with pytest.raises(InputError, match=r'wheel\.teeth: found "rack"; ISO 1328-1'):
        SPUR.scatter_of_class(6)
    with pytest.raises(InputError, match=r'wheel\.teeth: found "rack"; ISO 1328-1'):
        SPUR.pitch_tolerances(0, 6)
    result = solved(SPUR.with_changes(with_wheel(40)))
    with pytest.raises(NotAskedError, match="rack_force: the wheel is no rack"):
        _ = result.rack_force


def test_example_is_the_rack_that_its_text_says() -> None:
    """Its transverse pitch is 10 mm, and overview and file have it back."""
    assert pi * 3.0 / cos(radians(EXAMPLE.geometry.helix_angle_deg)) == pytest.approx(10.0, abs=1e-4)
    assert any("force along the rack" in row[0] for row in EXAMPLE.force_rows([1.0]))


@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells, and a face without crowning
def test_rating_of_a_rack_is_that_of_a_wheel_without_end() -> None:
    """ISO 6336-2 with (u + 1)/u = 1: sigma_H0 = Z_H Z_E Z_eps sqrt(F_t/(d_1 b)); a tooth is loaded once in a stroke."""
    analysis = {"positions": 5, "cells": [6, 8], "compliance": "contact", "free_edges": False}
    rating = solved(SPUR.with_changes(RATED | {"analysis": analysis})).rating()
    zone = sqrt(2.0 / (cos(radians(20.0)) * sin(radians(20.0))))
    elasticity = sqrt(206000.0 / (2.0 * pi * (1.0 - 0.3**2)))
    ratio = sqrt((4.0 - SPUR.mesh().transverse_contact_ratio) / 3.0)
    stress = zone * elasticity * ratio * sqrt(250e3 / RADIUS / (2.0 * RADIUS * 29.0))
    within = 1e-5  # z1/z2 = 1e-5 of the gear that stands for the rack, of which stresses have half
    assert rating.sigma_H0 == pytest.approx(stress, rel=within)
    turns = 60.0 * 150.0 * 100.0
    assert rating.cycles == pytest.approx(np.array([[turns, turns * 20.0 * 3.0 * pi / 500.0]]), rel=1e-9)
    assert abs(rating.local_flank_radius[0, 1]) < 3.0  # from the reference line, within the teeth
    assert any("of the pinion" in note or "reference line" in note for note in rating.notes())


def test_root_factors_of_wheels_come_to_those_of_the_rack() -> None:
    """Y_F and Y_S of the wheel, of first order in 1/z2: 0.0025 and 0.011 apart at 4000 teeth."""
    nominal = SPUR.with_changes({"wheel.thickness_allowance_um": None})
    coarse, fine = (np.array(nominal.with_changes(with_wheel(z)).root_factors[1]) for z in (4000, 8000))
    # the critical section of the gear that stands for the rack is rounded by 3e-5 modules, 1e-11 of its diameter
    assert nominal.root_factors[1] == pytest.approx(2.0 * fine - coarse, abs=1e-4)


def test_undercut_of_a_pinion_on_a_rack_is_warned_of_with_its_size():
    """The basic rack cuts below z = 2/sin^2(20 deg) = 17.1 teeth; a whole involute would be used down to its base."""
    few = SPUR.with_changes({"pinion.teeth": 14})
    (sentence,) = few.interferences()
    base, tip, form = 21.0 * cos(radians(20.0)), 24.0, 3.0 * rolled_form_radius(14)
    whole = sqrt(tip**2 - base**2)
    expected = (whole - sqrt(form**2 - base**2)) / (3.0 * pi * cos(radians(20.0)))
    assert sentence.startswith("undercut: the trochoid of the fillet ends the flank of the pinion at diameter")
    assert "the tip of the rack would use" in sentence
    ratio, of_whole = map(float, re.findall(r"contact ratio is ([\d.]+) instead of ([\d.]+)", sentence)[0])
    assert of_whole == pytest.approx(whole / (3.0 * pi * cos(radians(20.0))), abs=1e-4)  # as printed
    assert ratio == pytest.approx(expected, abs=5e-4)  # the rolled rack has points 5e-4 of its rounding apart
    assert SPUR.with_changes({"pinion.teeth": 18}).interferences() == []


def test_reference_of_keys_has_none_that_a_rack_refuses():
    (rack,) = [each for each in scene_reference() if each.path == "wheel" and "the rack" in each.about]
    names = {row.name for row in rack.rows}
    assert not names & {"bore_diameter_mm", "tooth", "profile_shift"}
    assert {"height_mm", "length_mm", "teeth", "face_width_mm"} <= names


def test_written_rack_has_no_line_on_keys_that_it_refuses():
    """A line of them would say that they could be given."""
    wheel = EXAMPLE.to_toml().partition("[wheel]")[2].partition("[mounting]")[0]
    assert not [name for name in ("bore_diameter_mm", "profile_shift", "tooth is", "wheel.shaft") if name in wheel]
    assert "centre_distance_mm" not in EXAMPLE.to_toml()
    assert parse_scene(EXAMPLE.to_toml()) == EXAMPLE
