"""Settings from measured flanks: errors that are known, limits, and settings that nobody can tell apart."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, InputError, read_scene
from loaded_tca.flank_maps import MeasuredFlank, fit_settings, read_measured_flank
from loaded_tca.flank_maps.settings_fit import KEYS
from loaded_tca.flanks import GeneratedFlank, MeasuredDeviations, MeasuredPoints
from loaded_tca.flanks.setting_slopes import cut_at, setting_of, with_settings
from loaded_tca.gears.face_milled import BLADE_SIGNS
from loaded_tca.units import factor_of

FOUND = 1e-6
"""Relative, of errors that are found: deviations have 1e-12 of them, settings that are told apart a thousandth."""
FLANKS = ("concave", "convex")
ERRORS = {
    "machine.radial": 0.05,
    "machine.root_angle": math.radians(0.04),
    "machine.ratio_of_roll": 0.002,
    "machine.blank_offset": -0.06,
    "machine.sliding_base": 0.03,
}
"""Deviations of 10 um."""


@pytest.fixture(scope="module")
def scene():
    return read_scene("examples/scenes/duplex_30x20_mended.toml")


@pytest.fixture(scope="module")
def generated(scene):
    return {
        (gear.name, flank): GeneratedFlank(gear, flank)
        for gear, flanks in ((scene.mesh().pinion, FLANKS[:1]), (scene.mesh().wheel, FLANKS))
        for flank in flanks
    }


def wrongly_cut(gear, errors):
    return with_settings(gear, {name: setting_of(gear, name) + error for name, error in errors.items()})


def measured(generated, place, errors, turn=2e-5, noise=0.0, weights=None):
    """Deviations that errors of settings make, and a turn of the flank by which it stands elsewhere."""
    flank = generated[place]
    rho, z = (part[1:-1, 1:-1] for part in flank.grid(7, 9))
    asked, cut = (
        cut_at(gear, place[1], rho.ravel(), z.ravel())[0].reshape(rho.shape)
        for gear in (flank.gear, wrongly_cut(flank.gear, errors))
    )
    excess = (BLADE_SIGNS[place[1]] * (cut - asked) + flank.side * turn) / flank.gradient_norm(rho, z).value
    excess += noise * np.random.default_rng(7).standard_normal(rho.shape)
    return MeasuredFlank(*place, MeasuredDeviations(rho, z, excess, weights=weights))


def keys_of(gear, names):
    return [f"{gear}.{KEYS[name]}" for name in names]


def errors_found(fit):
    return {key: -change / factor_of(key) for key, change in zip(fit.keys, fit.corrections, strict=True)}


def test_known_errors_of_a_spread_blade_wheel_are_found(scene, generated):
    """By both flanks at once, which one machine cuts."""
    flanks = [measured(generated, ("wheel", flank), ERRORS) for flank in FLANKS]
    fit = fit_settings(scene, flanks, keys_of("wheel", ERRORS))
    assert_allclose([*errors_found(fit).values()], [*ERRORS.values()], rtol=FOUND)
    assert max(np.abs(one.after).max() for one in fit.flanks) < 1e-11  # mm; places of 100 mm are subtracted
    assert min(one.rms(one.before) for one in fit.flanks) > 1e-3
    corrected = fit.corrected.mesh().wheel
    assert corrected.machine.radial == pytest.approx(scene.mesh().wheel.machine.radial - ERRORS["machine.radial"])
    wrong, place = wrongly_cut(scene.mesh().wheel, ERRORS), middle(generated)
    as_cut, left = (cut_at(gear, "concave", *place)[0] for gear in (fit.as_cut.mesh().wheel, wrong))
    assert_allclose(as_cut, left, rtol=1e-9)


def middle(generated):
    rho, z = generated["wheel", "concave"].grid(3, 3)
    return rho[1], z[1]


def test_errors_of_both_gears_blades_and_points_in_space_are_found(scene, generated):
    """Points of a left-hand pinion that another program might make: of its flank, at an azimuth of its own."""
    errors = {"machine.radial": 0.03, "cutter.concave.blade_angle": math.radians(0.05), "machine.helical_motion": 0.1}
    wrong = GeneratedFlank(wrongly_cut(scene.mesh().pinion, errors), "concave")
    rho, z = (part[1:-1, 1:-1] for part in wrong.grid(7, 9))
    azimuth = wrong.theta(rho, z).value + 0.7
    points = np.stack([rho * np.cos(azimuth), rho * np.sin(azimuth), z], axis=-1)
    flanks = [
        MeasuredFlank("pinion", "concave", MeasuredPoints(points)),
        measured(generated, ("wheel", "convex"), {"machine.radial": -0.02}),
    ]
    fit = fit_settings(scene, flanks, [*keys_of("pinion", errors), "wheel.machine.radial_mm"])
    assert_allclose([*errors_found(fit).values()], [*errors.values(), -0.02], rtol=FOUND)


def test_thickness_of_the_tooth_counts_where_both_flanks_turn_as_one(scene, generated):
    """The point width: blades further apart by 0.04 mm make the tooth of a wheel thinner, and turn its flanks apart."""
    errors = {"cutter.concave.point_radius": 0.02, "cutter.convex.point_radius": -0.02}
    flanks = [measured(generated, ("wheel", flank), errors) for flank in FLANKS]
    keys = keys_of("wheel", errors)
    fits = {turned: fit_settings(scene, flanks, keys, turned=turned) for turned in ("flank", "tooth")}
    for fit in fits.values():
        assert_allclose([*errors_found(fit).values()], [*errors.values()], rtol=FOUND)
    thinner = 0.02 * math.cos(math.radians(20.0))  # of the slot's flank across itself
    rms = {turned: fit.flanks[0].rms(fit.flanks[0].before) for turned, fit in fits.items()}
    assert rms["tooth"] == pytest.approx(thinner, rel=0.1)  # the blade group and the taper change the angle
    assert rms["flank"] < 0.05 * thinner


def as_points(generated, flank, azimuth, nominal):
    """The same measured flank as points in space; its nominal flank stands at an azimuth that the file chose."""
    surface, topography = generated[flank.gear, flank.flank], flank.topography
    rho, z = topography.radius, topography.axial
    of_nominal = surface.theta(rho, z).value + azimuth
    of_points = of_nominal + surface.side * topography.excess * surface.gradient_norm(rho, z).value
    xyz = [np.stack([rho * np.cos(at), rho * np.sin(at), z], axis=-1) for at in (of_points, of_nominal)]
    return replace(flank, topography=MeasuredPoints(xyz[0], nominal=xyz[1] if nominal else None))


def test_thickness_of_points_in_space_counts_from_their_nominal_points(scene, generated):
    """One blade too far out; without nominal points nothing says where the nominal flanks stand to each other."""
    errors = {"cutter.convex.point_radius": 0.05}
    flanks = [measured(generated, ("wheel", flank), errors if flank == "convex" else {}) for flank in FLANKS]
    keys = keys_of("wheel", errors)
    points = [as_points(generated, one, azimuth, True) for one, azimuth in zip(flanks, (0.7, -2.0), strict=True)]
    fit = fit_settings(scene, points, keys, turned="tooth")
    assert_allclose([*errors_found(fit).values()], [*errors.values()], rtol=FOUND)
    bare = as_points(generated, flanks[1], 0.7, False)
    with pytest.raises(InputError, match=r'turned: "tooth" needs .* points of the wheel, convex flank do not tell'):
        fit_settings(scene, [flanks[0], bare], keys, turned="tooth")


def test_correction_stops_at_its_limit_and_the_others_make_the_best_of_it(scene, generated):
    """What is left is orthogonal to what the free settings can do, and pushes the limited one outwards."""
    names = [*ERRORS][:3]
    flanks = [measured(generated, ("wheel", flank), ERRORS) for flank in FLANKS]
    limits = dict.fromkeys(keys_of("wheel", names)) | {"wheel.machine.radial_mm": 0.01}
    fit = fit_settings(scene, flanks, limits)
    assert fit.corrections[0] == -0.01
    assert fit.at_limit.tolist() == [True, False, False]
    assert fit.deviation[0] == 0.0 < fit.deviation[1]
    parts = []
    for one in fit.flanks:
        rho, z = (part.ravel() for part in (one.measured.topography.radius, one.measured.topography.axial))
        slopes = cut_at(fit.as_cut.mesh().wheel, one.measured.flank, rho, z, names)[1]
        parts.append(BLADE_SIGNS[one.measured.flank] * slopes / one.nominal.gradient_norm(rho, z).value)
    slopes = np.concatenate(parts, axis=1)
    products = slopes @ np.concatenate([one.after.ravel() for one in fit.flanks]) / np.linalg.norm(slopes, axis=1)
    assert_allclose(products[1:], 0.0, atol=1e-9)  # mm; steps settle at 1e-11
    assert abs(products[0]) > 1e-3


def test_noise_gives_standard_deviations_and_points_of_weight_zero_none(scene, generated):
    """A point that lies 50 um off its flank is left out of the fit and shown."""
    weights = np.ones((5, 7))
    weights[2, 3] = 0.0
    place = ("wheel", "convex")
    flank = measured(generated, place, {"machine.radial": 0.05}, weights=weights)
    spoilt = flank.topography.excess.copy()
    spoilt[2, 3] += 0.05
    exact = fit_settings(
        scene, [replace(flank, topography=replace(flank.topography, excess=spoilt))], ["wheel.machine.radial_mm"]
    )
    assert exact.corrections[0] == pytest.approx(-0.05, rel=FOUND)
    assert exact.flanks[0].after[2, 3] == pytest.approx(0.05, abs=1e-6)
    weights = np.zeros((5, 7))
    weights[0, 0] = weights[4, 6] = 1.0  # as many points as unknowns: the setting and the turn
    few = fit_settings(
        scene, [measured(generated, place, {"machine.radial": 0.05}, weights=weights)], ["wheel.machine.radial_mm"]
    )
    assert few.corrections[0] == pytest.approx(-0.05, rel=FOUND)
    assert np.isnan(few.deviation[0])
    noise = 1e-3
    noisy = fit_settings(
        scene, [measured(generated, place, {"machine.radial": 0.05}, noise=noise)], ["wheel.machine.radial_mm"]
    )
    assert abs(noisy.corrections[0] + 0.05) < 3.0 * noisy.deviation[0]
    assert noisy.flanks[0].rms(noisy.flanks[0].after) == pytest.approx(noise, rel=0.3)  # of 35 points


def test_settings_that_do_the_same_are_refused_by_their_names(scene, generated):
    """The number of a blade group is an angle of both blades, which the scene gives, too."""
    flanks = [measured(generated, ("wheel", flank), {}) for flank in FLANKS]
    names = ["cutter.number", "machine.radial", *(f"cutter.{flank}.blade_angle" for flank in FLANKS)]
    with pytest.raises(InputError, match="do the same to the measured flanks, leave one out of: ") as caught:
        fit_settings(scene, flanks, keys_of("wheel", names))
    told = str(caught.value)
    assert [key in told for key in keys_of("wheel", names)] == [True, False, True, True]
    keys = keys_of("wheel", [names[0], *names[2:]])
    number, concave, convex = (float(told.split(f"{key} ")[1].split(",")[0]) for key in keys)
    assert number / 6.0 == pytest.approx(concave, rel=1e-2)  # six units a degree
    assert number / 6.0 == pytest.approx(-convex, rel=1e-2)


def test_settings_that_hardly_change_the_flank_together_are_warned_of(scene, generated):
    names = [*[*ERRORS][:4], "machine.helical_motion", "machine.modified_roll_2c"]
    words = "together the following changes alter the flanks by only 0.0.* um, though each"
    with pytest.warns(AccuracyWarning, match=words):
        fit = fit_settings(scene, [measured(generated, ("wheel", "concave"), {})], keys_of("wheel", names))
    assert fit.effect < 1e-4
    errors = {name: change / factor_of(key) for name, key, change in zip(names, fit.keys, fit.weakest, strict=True)}
    changes = (errors, *({name: error} for name, error in errors.items()))
    rms = [rms_but_for_a_turn(generated, ("wheel", "concave"), change) for change in changes]
    assert rms[0] == pytest.approx(fit.effect, rel=0.05)  # to first order
    assert max(rms[1:]) == pytest.approx(0.01, rel=0.05)


def rms_but_for_a_turn(generated, place, errors):
    topography = measured(generated, place, errors, turn=0.0).topography
    turned = 1.0 / generated[place].gradient_norm(topography.radius, topography.axial).value
    excess = topography.excess - turned * (turned * topography.excess).sum() / (turned**2).sum()
    return np.sqrt((excess**2).mean())


def call(scene, generated, settings=("wheel.machine.radial_mm",), flanks=None, **more):
    given = [measured(generated, ("wheel", "concave"), {})] if flanks is None else flanks
    return fit_settings(scene.with_changes(more.pop("changes", {})), given, settings, **more)


def refused(words, **more):
    return (lambda scene, generated: call(scene, generated, **more)), words


@pytest.mark.parametrize(
    ("words", "arguments"),
    [
        ("measured: no flank is given", {"flanks": []}),
        ("settings: none is given", {"settings": []}),
        ("turned: 'both' is not 'flank' or 'tooth'", {"turned": "both"}),
        ("wheel.machine.radial_mm is given twice", {"settings": ["wheel.machine.radial_mm"] * 2}),
        ("a largest change of 0 is not positive", {"settings": {"wheel.machine.radial_mm": 0}}),
        ('did you mean "wheel.machine.radial_mm"', {"settings": ["wheel.machine.radial"]}),
        ("no flank of the pinion is measured", {"settings": ["pinion.machine.radial_mm"]}),
        ("the convex flank of the wheel is not measured", {"settings": ["wheel.cutter.convex.point_radius_mm"]}),
        ("the blade is straight, or missing", {"settings": ["wheel.cutter.concave.blade_radius_mm"]}),
        ("cradle_angle_deg: only turns the measured", {"settings": ["wheel.machine.cradle_angle_deg"]}),
        (
            'generation = "formate"',
            {
                "settings": ["wheel.machine.helical_motion_mm_per_rad"],
                "changes": {"wheel.machine.generation": "formate"},
            },
        ),
    ],
)
def test_input_that_is_refused(scene, generated, words, arguments):
    with pytest.raises(InputError) as caught:
        call(scene, generated, **arguments)
    assert words in str(caught.value)


def test_points_beside_the_flank_and_scenes_without_settings_are_refused(scene, generated):
    flank = measured(generated, ("wheel", "concave"), {})
    moved = replace(flank.topography, axial=flank.topography.axial + 10.0)
    with pytest.raises(InputError, match=r"measured, wheel, concave flank: .* lie beside the flank, the farthest"):
        call(scene, generated, flanks=[replace(flank, topography=moved)])
    with pytest.raises(InputError, match="the concave flank of the wheel is given twice"):
        call(scene, generated, flanks=[flank, flank])
    with pytest.raises(InputError, match="no machine settings; allowed face_milled"):
        fit_settings(read_scene("examples/scenes/spiral_bevel.toml"), [flank], ["wheel.machine.radial_mm"])


FILE = """# gear = wheel
# flank = concave
profile_index,lengthwise_index,radius_mm,axial_mm,deviation_um,weight
"""


def text_of(flank):
    topography = flank.topography
    rows = [
        f"{i},{j},{topography.radius[i, j]},{topography.axial[i, j]},{1e3 * topography.excess[i, j]},{1 + (i == 2)}"
        for i, j in np.ndindex(*topography.radius.shape)
    ]
    return FILE + "\n".join(rows) + "\n"


@pytest.fixture
def file(tmp_path, generated):
    path = tmp_path / "flank.csv"
    path.write_text(text_of(measured(generated, ("wheel", "concave"), {"machine.radial": 0.05})))
    return path


def test_file_says_its_flank_and_weights(file):
    flank = read_measured_flank(file)
    with pytest.raises(InputError, match="gear: pinion; the file says wheel"):
        read_measured_flank(file, gear="pinion")
    assert (flank.gear, flank.flank, flank.weights[1:3, 0].tolist()) == ("wheel", "concave", [1.0, 2.0])
    file.write_text(file.read_text().replace("# flank = concave\n", ""))
    with pytest.raises(InputError, match="flank: missing; a comment '# flank = "):
        read_measured_flank(file)
    assert read_measured_flank(file, flank="convex").flank == "convex"


@pytest.mark.usefixtures("file", "blank_pictures")
def test_command_writes_scene_tables_and_picture(run, tmp_path, monkeypatch):
    source = read_scene("examples/scenes/duplex_30x20_mended.toml")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(source.to_toml())
    options = ["settings", "scene.toml", "--measured", "flank.csv", "--out", "new.toml"]
    code, out, err = run(*options, "--settings", "wheel.machine.radial_mm=0.1", "wheel.machine.sliding_base_mm")
    assert (code, err) == (0, [])
    assert re.search(r"^wheel.machine.radial_mm +\d+\.\d+ +-0.050000 ", out, re.MULTILINE)
    assert out.endswith("Written to .: new.toml, new_corrections.csv, new_deviations.csv, new_deviations.png\n")
    radial = source.wheel.machine.radial_mm
    assert read_scene("new.toml").wheel.machine.radial_mm == pytest.approx(radial - 0.05, rel=1e-9)
    table = (tmp_path / "new_corrections.csv").read_text().splitlines()
    assert table[0] == "setting,unit,value,correction,standard_deviation,limit,at_limit,corrected"
    assert table[1].split(",")[:2] == ["wheel.machine.radial_mm", "mm"]
    assert table[1].split(",")[5:7] == ["0.1", "0"]
    points = (tmp_path / "new_deviations.csv").read_text().splitlines()
    assert len(points) == 1 + 35
    assert run(*options, "--as-cut")[0] == 0
    assert read_scene("new.toml").wheel.machine.radial_mm > radial + 0.04


REFUSED = {
    "method": (["--method", "spread_blade"], "only for bevel blanks; not allowed with --measured"),
    "twice": (["--settings", "a.b", "a.b"], "--settings a.b: given twice"),
    "limit": (["--settings", "a.b=0"], "the limit a number above 0"),
}


@pytest.mark.usefixtures("file")
@pytest.mark.parametrize("name", REFUSED)
def test_command_line_that_is_refused(run, tmp_path, monkeypatch, name):
    scene = read_scene("examples/scenes/duplex_30x20_mended.toml")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(scene.to_toml())
    more, words = REFUSED[name]
    code, _, err = run("settings", "scene.toml", "--measured", "flank.csv", "--out", "new.toml", *more)
    assert code == 2
    assert words in err[0]
    assert not (tmp_path / "new.toml").exists()


def test_options_of_measured_flanks_need_one(run, tmp_path):
    options = "examples/scenes/face_milled_blank.toml", "--out", str(tmp_path / "a.toml")
    code, _, err = run("settings", *options, "--as-cut")
    assert (code, err) == (2, ["loaded-tca: --as-cut: needs --measured"])
