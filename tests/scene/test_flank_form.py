"""Sections [pinion.flank] and [wheel.flank]: fitted and measured flanks of every family, and files of points."""

import os
import tomllib
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import AccuracyWarning, InputError, analyse, load_result, read_scene, trace_contact
from loaded_tca.flanks import FlankModifications, SplineFlank, measured, read_topography
from loaded_tca.scene import CylindricalScene, FlankForm, Measurement, parse_scene, scene_from_table
from loaded_tca.scene.build import build_modifications
from tests.refusals import refusals
from tests.samples.results import ONE_PAIR
from tests.samples.scene_tables import changed

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
FITTED = 1e-10  # rad; a B-spline through 33 x 33 points is within 1e-6 um of the flank
DIGITS = 1e-9  # mm; a scene keeps 12 digits of a coordinate of about 100 mm
GRID = [[20.0 + line] * 4 for line in range(4)]
EDGES = dict.fromkeys(("axial_mm", "radius_mm", "deviation_um"), GRID)


def in_contact(scene):
    return trace_contact(scene.pair(), np.linspace(-0.4, 0.4, 5) * scene.pair().pitch)


def crowned(scene):
    return scene.with_changes(
        {
            "pinion.modifications.lead_crowning_um": 10.0,
            "wheel.modifications.profile_crowning_um": 5.0,
            "wheel.modifications.twist_um": 4.0,
        }
    )


def csv_of(topography, columns=("radius_mm", "axial_mm", "deviation_um"), text="{:.17g},{:.17g},{:.17g}"):
    """Text of a file of points (n, m, 3)."""
    rows = [text.format(*point) for point in np.moveaxis(topography, 0, 1).reshape(-1, 3)]
    shape = f"# points = {topography.shape[0]} x {topography.shape[1]}"
    return "\n".join([shape, ",".join(columns), *rows, ""])


def deviations(scene, member="wheel", points=(7, 9)):
    """Radius, axial position [mm] and crowning [um] at points of a flank."""
    flank = getattr(scene.pair(), member).flank
    rho, z = flank.grid(*points)
    along = flank.lengthwise_coordinate(rho, z).value
    return np.stack([rho, z, -8.0 * (along / np.ptp(along) * 2.0) ** 2], axis=-1)


@pytest.fixture
def measured_file(scene, tmp_path):
    path = tmp_path / "wheel.csv"
    path.write_text(csv_of(deviations(scene)), encoding="utf-8")
    return path


# Fitted flanks


@pytest.mark.parametrize("family", ["scene", "spiral"])
def test_fitted_pair_touches_where_the_analytic_one_does(family, request):
    """Points of the modified flank, moved along the normal, then a B-spline through them."""
    analytic = crowned(request.getfixturevalue(family))
    fitted = analytic.with_changes({"pinion.flank.form": "bspline", "wheel.flank.form": "bspline"})
    assert isinstance(fitted.pair().pinion.flank, SplineFlank)
    assert_allclose(in_contact(fitted).transmission_error, in_contact(analytic).transmission_error, rtol=0, atol=FITTED)


def test_fitted_flank_has_the_points_and_degree_of_the_scene(scene):
    pair = scene.with_changes({"wheel.flank": {"form": "bspline", "points": [9, 12], "degree": 3}}).pair()
    assert pair.wheel.flank.spline.coefficients.shape == (9, 12)
    assert pair.wheel.flank.spline.degrees == (3, 3)
    assert not isinstance(pair.pinion.flank, SplineFlank)


def test_fitted_flanks_are_both_sides_of_the_tooth(scene):
    fitted = scene.with_changes({"wheel.flank.form": "bspline"})
    assert all(isinstance(fitted.pair(sense).wheel.flank, SplineFlank) for sense in ("positive", "negative"))


def test_relief_start_that_a_fit_rounds_off_is_a_warning(scene):
    relief = {"tip_relief_um": 20.0, "tip_relief_start_mm": 109.0, "tip_relief_form": "linear"}
    fitted = scene.with_changes({"pinion.modifications": relief, "pinion.flank.form": "bspline"})
    with pytest.warns(AccuracyWarning, match="33 x 33 points misses the flank"):
        fitted.pair()


# Measured flanks


def test_measured_pair_is_the_one_made_by_hand(scene, measured_file):
    found = scene.with_changes({"wheel.flank": {"form": "measured", "file": str(measured_file)}}).pair()
    by_hand = measured(scene.pair().wheel.flank, read_topography(measured_file))
    rho, z = by_hand.grid(6, 6)
    assert_allclose(rho * (found.wheel.flank.theta(rho, z).value - by_hand.theta(rho, z).value), 0.0, atol=DIGITS)


def test_measured_crowning_does_what_crowning_does(scene, measured_file):
    """Under misalignment, which moves the contact to where the crowning is not zero."""
    tilted = scene.with_changes({"mounting.misalignment_um": 20.0})
    found = in_contact(tilted.with_changes({"wheel.flank": {"form": "measured", "file": str(measured_file)}}))
    exact = in_contact(tilted.with_changes({"wheel.modifications.lead_crowning_um": 8.0}))
    assert exact.transmission_error.min() > 1e-5
    # rad; a spline holds a parabola: 7e-18 seen
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=1e-14)


def test_deviations_are_counted_from_the_modified_flank(scene, measured_file):
    half = {"wheel.flank": {"form": "measured", "file": str(measured_file)}, "wheel.modifications.helix_slope_um": 5.0}
    exact = {"wheel.modifications.helix_slope_um": 5.0, "wheel.modifications.lead_crowning_um": 8.0}
    found, expected = (in_contact(scene.with_changes(changes)) for changes in (half, exact))
    assert_allclose(found.pinion_axial, expected.pinion_axial, rtol=0, atol=1e-6)
    # turned until it holds the pitch point, half of the slope is gone
    assert_allclose(np.ptp(found.transmission_error), np.ptp(expected.transmission_error), rtol=0, atol=1e-11)


@pytest.mark.parametrize("family", ["scene", "spiral"])
def test_points_in_space_and_deviations_are_the_same_flank(family, request, tmp_path):
    """Points of a crowned flank, its tooth standing anywhere, against the crowning itself."""
    plain = request.getfixturevalue(family)
    exact = plain.with_changes({"wheel.modifications.lead_crowning_um": 8.0})
    flank = exact.pair().wheel.flank
    rho, z = flank.grid(9, 11)
    angle = flank.theta(rho, z).value + 2.0
    path = tmp_path / "points.csv"
    points = np.stack([rho * np.cos(angle), rho * np.sin(angle), z], axis=-1)
    path.write_text(csv_of(points, ("x_mm", "y_mm", "z_mm")), encoding="utf-8")
    found = plain.with_changes({"wheel.flank": {"form": "measured", "file": str(path)}})
    assert found.wheel.flank.measurement.radius_mm is None
    assert parse_scene(found.to_toml()) == found
    # 1e-10 mm of a point over a radius of 50 mm; of a bevel flank 1/R is no polynomial
    assert_allclose(in_contact(found).transmission_error, in_contact(exact).transmission_error, rtol=0, atol=2e-10)


def test_fewer_coefficients_smooth_the_noise(scene, tmp_path, rng):
    points = deviations(scene, points=(12, 15))
    points[..., 2] += rng.normal(0.0, 0.2, points.shape[:2])
    path = tmp_path / "noisy.csv"
    path.write_text(csv_of(points), encoding="utf-8")
    wanted = {"form": "measured", "file": str(path), "coefficients": [6, 7], "degree": 3}
    wheel = scene.with_changes({"wheel.flank": wanted}).pair().wheel.flank
    assert wheel.spline.degrees == (3, 3)
    # 42 coefficients of 180 points leave sqrt(1 - 42/180) of the noise, here to 20 %
    assert_allclose(wheel.fit_error.rms, 2e-4 * np.sqrt(1.0 - 42 / 180), rtol=0.2)


def test_noise_is_smoothed_by_default_and_followed_where_asked(scene, tmp_path, rng):
    points = deviations(scene, points=(12, 15))
    points[..., 2] += rng.normal(0.0, 0.2, points.shape[:2])
    path = tmp_path / "noisy.csv"
    path.write_text(csv_of(points), encoding="utf-8")
    wanted = {"form": "measured", "file": str(path)}
    smooth = scene.with_changes({"wheel.flank": wanted}).pair().wheel.flank
    assert smooth.spline.coefficients.shape == (8, 9)
    assert_allclose(smooth.fit_error.rms, 2e-4 * np.sqrt(1.0 - 72 / 180), rtol=0.2)
    through = scene.with_changes({"wheel.flank": wanted | {"coefficients": [12, 15]}}).pair().wheel.flank
    assert through.fit_error.rms < 1e-3 * smooth.fit_error.rms


def test_other_flank_of_a_measured_tooth_follows_from_the_equations(scene, measured_file):
    found = scene.with_changes({"wheel.flank": {"form": "measured", "file": str(measured_file)}})
    assert isinstance(found.pair("positive").wheel.flank, SplineFlank)
    assert not isinstance(found.pair("negative").wheel.flank, SplineFlank)


# Files


def written(folder, text, csv):
    """A scene in a folder with the points beside it."""
    folder.mkdir()
    (folder / "wheel.csv").write_text(csv, encoding="utf-8")
    scene = folder / "scene.toml"
    scene.write_text(text, encoding="utf-8")
    return scene


MEASURED = '[wheel.flank]\nform = "measured"\nfile = "wheel.csv"\n'


def test_file_is_looked_for_beside_the_scene(small, scene, tmp_path, monkeypatch):
    path = written(tmp_path / "there", small + MEASURED, csv_of(deviations(scene)))
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert read_scene(path).wheel.flank.measurement.shape == (7, 9)
    assert read_scene(Path("..", "there", "scene.toml")) == read_scene(path)
    with pytest.raises(InputError, match=r"^wheel\.flank\.file: wheel\.csv: cannot be read"):
        parse_scene(small + MEASURED)
    assert parse_scene(small + MEASURED, folder=path.parent) == read_scene(path)
    monkeypatch.chdir(path.parent)
    assert parse_scene(small + MEASURED) == scene_from_table(tomllib.loads(small + MEASURED)) == read_scene(path)


def test_scene_needs_the_file_no_more_once_it_is_read(small, scene, tmp_path):
    path = written(tmp_path / "there", small + MEASURED, csv_of(deviations(scene)))
    first = read_scene(path)
    (path.parent / "wheel.csv").unlink()
    again = parse_scene(first.to_toml())
    assert again == first
    assert again.wheel.flank.measurement.source == "wheel.csv"
    assert again.wheel.flank.file is None
    rho, z = first.pair().wheel.flank.grid(5, 5)
    # exact: every digit is written, the same operations
    assert_array_equal(again.pair().wheel.flank.theta(rho, z).value, first.pair().wheel.flank.theta(rho, z).value)


def test_another_file_takes_the_place_of_the_points_of_the_first(scene, measured_file):
    first = scene.with_changes({"wheel.flank": {"form": "measured", "file": str(measured_file)}})
    second = measured_file.with_name("second.csv")
    second.write_text(csv_of(deviations(scene, points=(6, 8))), encoding="utf-8")
    measurement = first.with_changes({"wheel.flank.file": str(second)}).wheel.flank.measurement
    assert (measurement.shape, measurement.source) == ((6, 8), "second.csv")
    inside = {"wheel.flank.measurement.source": "points of a gauge"}
    for more in ({"wheel.flank.measurement": measurement}, inside):
        both = {"wheel.flank.file": str(second), **more}
        for changes in (both, dict(reversed(both.items()))):  # in either order
            with pytest.raises(InputError, match=r"^wheel\.flank\.file: found .* beside a section measurement"):
                first.with_changes(changes)
    with_tooth = first.with_changes({"wheel.tooth": [{"number": 3, "flank": first.wheel.flank}]})
    (tooth,) = with_tooth.with_changes({"wheel.tooth.0.flank.file": str(second)}).wheel.tooth
    assert tooth.flank.measurement == measurement


def test_result_of_a_measured_flank_opens_without_the_file(small, scene, tmp_path):
    path = written(tmp_path / "there", small + MEASURED, csv_of(deviations(scene)))
    first = read_scene(path).with_changes({**ONE_PAIR, "analysis.positions": 1, "analysis.cells": (16, 16)})
    analyse(first).save(tmp_path / "result.nc")
    (path.parent / "wheel.csv").unlink()
    assert load_result(tmp_path / "result.nc").scene == first


def test_largest_measurement_survives_its_own_text(scene, rng):
    """Two gears with 100 x 100 points of all digits: within the limits of a scene file."""
    grids = {name: rng.uniform(1.0, 9e4, (100, 100)).tolist() for name in EDGES}
    form = {"form": "measured", "measurement": grids}
    full = scene.with_changes({"pinion.flank": form, "wheel.flank": form})
    assert parse_scene(full.to_toml()) == full


def test_section_made_in_python_reads_its_file(measured_file):
    form = FlankForm(form="measured", file=str(measured_file))
    assert form.file is None
    assert form.measurement.shape == (7, 9)
    with pytest.raises(InputError, match=r"^file: none\.csv: cannot be read"):
        FlankForm(form="measured", file="none.csv")


def refused(small, folder, csv, extra=""):
    """Problems of a scene whose file holds a text, less its folder."""
    with pytest.raises(InputError) as raised:
        read_scene(written(folder / "there", small + MEASURED + extra, csv))
    return [line.replace(str(folder / "there") + os.sep, "") for line in raised.value.problems]


def test_problems_of_a_file_are_told_all_at_once_and_with_those_of_the_scene(small, tmp_path):
    csv = "# points = 2 x 1\nradius_mm,axial_mm,deviation_um\n50,1\n50,x,3\n"
    assert refused(small, tmp_path, csv, "[pinion.modifications]\ntwist_um = true\n") == [
        "pinion.modifications.twist_um: found true; allowed a number from -10000 to 10000",
        "wheel.flank.file: wheel.csv: line 3: 2 values; the header names 3 columns",
        "wheel.flank.file: wheel.csv: line 4, column 2: axial_mm is not a finite number",
    ]


def test_grid_that_no_scene_holds_is_told_with_its_file(small, tmp_path):
    csv = csv_of(np.ones((3, 101, 3)))
    problems = refused(small, tmp_path, csv)
    assert len(problems) == 3
    assert problems[0].startswith("wheel.flank.file: wheel.csv: radius_mm: found [a list, a list, a list]; allowed a")


def test_directory_is_told(scene, tmp_path):
    with pytest.raises(InputError, match=r"wheel\.flank\.file: .*: is not a file"):
        scene.with_changes({"wheel.flank": {"form": "measured", "file": str(tmp_path)}})


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a system without named pipes")
def test_pipe_is_not_waited_for(scene, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="pipe: is not a file"):
        scene.with_changes({"wheel.flank": {"form": "measured", "file": str(tmp_path / "pipe")}})


def test_points_of_another_gear_are_told_when_the_gears_are_made(scene, measured_file):
    other = scene.with_changes({"pinion.flank": {"form": "measured", "file": str(measured_file)}})
    with pytest.raises(InputError, match=r"^pinion\.flank: \d+ of 63 points lie off the flank"):
        other.pair()


def test_measurement_too_coarse_for_its_degree_is_told_when_the_gears_are_made(scene, tmp_path):
    path = tmp_path / "coarse.csv"
    path.write_text(csv_of(deviations(scene, points=(4, 9))), encoding="utf-8")
    coarse = scene.with_changes({"wheel.flank": {"form": "measured", "file": str(path), "degree": 5}})
    with pytest.raises(InputError, match=r"^wheel\.flank: profile: 4 points are too coarse"):
        coarse.pair()


# Messages

FLANK = "wheel.flank"
POINTS = "wheel.flank.measurement"

ONE_PROBLEM = [
    (
        {"form": "spline"},
        f'{FLANK}.form: found "spline"; allowed "analytic" or "bspline" or "measured"; did you mean "bspline"?',
    ),
    ({"points": [33, 33]}, f'{FLANK}.points: does not apply to form = "analytic"; allowed with "bspline"'),
    ({"degree": 5}, f'{FLANK}.degree: does not apply to form = "analytic"; allowed with "bspline" or "measured"'),
    (
        {"form": "bspline", "file": "x.csv"},
        f'{FLANK}.file: does not apply to form = "bspline"; allowed with "measured"',
    ),
    (
        {"form": "bspline", "coefficients": [9, 9]},
        f'{FLANK}.coefficients: does not apply to form = "bspline"; allowed with "measured"',
    ),
    ({"measurement": EDGES}, f'{FLANK}.measurement: does not apply to form = "analytic"; allowed with "measured"'),
    ({"form": "bspline", "degree": 4}, f"{FLANK}.degree: found 4; allowed 3 or 5"),
    ({"form": "bspline", "points": [5, 33]}, f"{FLANK}.points: found [5, 33]; allowed from 6 on, for degree = 5"),
    (
        {"form": "bspline", "points": [3, 33], "degree": 3},
        f"{FLANK}.points: found [3, 33]; allowed a list of 2 values, each a whole number from 4 to 100 "
        "(found 3; allowed a whole number from 4 to 100)",
    ),
    (
        {"form": "measured"},
        f'{FLANK}.file: missing; form = "measured" needs a file of points, or a section measurement',
    ),
    (
        {"form": "measured", "file": "x.csv", "measurement": EDGES},
        f'{FLANK}.file: found "x.csv" beside a section measurement; give one of the two',
    ),
    (
        {"form": "measured", "file": "two\nlines"},
        rf'{FLANK}.file: found "two\nlines"; allowed one line of text of up to 1000 characters',
    ),
    (
        {"form": "measured", "measurement": {"radius_mm": GRID, "x_mm": GRID}},
        f"{POINTS}.radius_mm: given are radius_mm, x_mm; allowed radius_mm, axial_mm, deviation_um or x_mm, y_mm, z_mm",
    ),
    (
        {"form": "measured", "measurement": {}},
        f"{POINTS}.radius_mm: given are no points; allowed radius_mm, axial_mm, deviation_um or x_mm, y_mm, z_mm",
    ),
    (
        {"form": "measured", "measurement": {**EDGES, "axial_mm": [*GRID, [1.0] * 4]}},
        f"{POINTS}.radius_mm: found 4 x 4 and 5 x 4 points in one measurement",
    ),
]


test_message_names_the_key_and_what_is_allowed = refusals(
    lambda flank, table: scene_from_table(changed(table, {"wheel.flank": flank})), *ONE_PROBLEM, plain=True
)


IN_LISTS = "allowed a list of 4 to 100 lists of one length, 4 to 100 values, each a number above 0, up to 100000"


@pytest.mark.parametrize(
    ("values", "found"),
    [
        (3.0, f"found 3.0; {IN_LISTS}"),
        ([1.0, 2.0], f"found [1.0, 2.0]; {IN_LISTS}"),
        ([], f"found []; {IN_LISTS}"),
        ([[]] * 4, f"found [a list, a list, a list, a list]; {IN_LISTS}"),
        ([*GRID, [1.0] * 101], f"found [a list, a list, a list, a list, ...]; {IN_LISTS}"),
        ([*GRID, [1.0] * 5], f"found [a list, a list, a list, a list, ...]; {IN_LISTS} (the lists hold 4, 4, 4, 4, 5)"),
        ([*GRID, [1.0, 1.0, 1.0, True]], "(found true; allowed a number above 0, up to 100000)"),
        ([*GRID, [1.0, 1.0, 1.0, float("nan")]], "(found nan; allowed a number above 0, up to 100000)"),
        ([*GRID, [1.0, 1.0, 1.0, 0.0]], "(found 0.0; allowed a number above 0, up to 100000)"),
        ([*GRID, [1.0, 1.0, 1.0, 2e5]], "(found 200000.0; allowed a number above 0, up to 100000)"),
        ([*GRID, [1.0, 1.0, 1.0, 10**400]], "(found a whole number of 1329 bits; allowed a number above 0"),
        ([*GRID, [1.0, 1.0, 1.0, [1.0]]], "(found [1.0]; allowed a number above 0, up to 100000)"),
    ],
)
def test_grid_that_is_none_is_refused_with_its_first_wrong_entry(values, found):
    with pytest.raises(InputError) as raised:
        Measurement(radius_mm=values, axial_mm=GRID, deviation_um=GRID)
    (problem,) = raised.value.problems
    assert found in problem


def test_whole_numbers_in_a_grid_become_floats():
    made = Measurement(radius_mm=[[1, 2, 3, 4]] * 4, axial_mm=GRID, deviation_um=GRID)
    assert made == Measurement(radius_mm=[[1.0, 2.0, 3.0, 4.0]] * 4, axial_mm=GRID, deviation_um=GRID)
    assert type(made.radius_mm[0][0]) is float


# Twist and polynomial


def test_twist_and_polynomial_reach_the_flanks_in_millimetres(scene):
    polynomial = (1e-3, -2e-4, 3e-4, 1e-5, 1e-4, 2e-3)
    changed = scene.with_changes(
        {"pinion.modifications.twist_um": -4.0, "wheel.modifications.polynomial_mm": list(polynomial)}
    )
    pinion, wheel = build_modifications(changed.pinion, changed.wheel)
    assert (pinion.twist, wheel.polynomial) == (pytest.approx(-0.004), polynomial)
    assert wheel == FlankModifications(polynomial=polynomial)


def test_polynomial_of_the_crowning_is_the_crowning(scene):
    """a5 = C_beta/(b/2)^2, over the face width of 25 mm."""
    by_polynomial, by_crowning = (
        scene.with_changes({f"pinion.modifications.{key}": value})
        for key, value in (("polynomial_mm", (0, 0, 0, 0, 0.01 / 12.5**2, 0)), ("lead_crowning_um", 10.0))
    )
    assert isinstance(by_polynomial, CylindricalScene)
    assert_allclose(
        # rad; of angles of order 0.1
        in_contact(by_polynomial).transmission_error,
        in_contact(by_crowning).transmission_error,
        rtol=0,
        atol=1e-14,
    )


@pytest.mark.parametrize("value", [0.001, [0.0] * 5, [0.0] * 7, [0.0] * 5 + [101.0], [0.0] * 5 + ["1"]])
def test_polynomial_of_other_than_six_numbers_is_refused(table, value):
    table["wheel"]["modifications"] = {"polynomial_mm": value}
    with pytest.raises(InputError, match=r"wheel\.modifications\.polynomial_mm: found .*; allowed a list of 6 values"):
        scene_from_table(table)
