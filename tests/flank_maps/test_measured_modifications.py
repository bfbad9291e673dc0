"""Modifications of measured flanks: those that were put in come back, whatever they count from."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import InputError, parse_scene, read_scene
from loaded_tca.flank_maps import measured_modifications
from loaded_tca.flanks import MeasuredDeviations, MeasuredPoints
from loaded_tca.flanks.topography import parse_topography

PUT_IN = {
    "helix_slope_um": -3.0,
    "profile_slope_um": 2.0,
    "lead_crowning_um": 9.0,
    "profile_crowning_um": 4.0,
    "twist_um": 5.0,
}
DESIGN = {"lead_crowning_um": 6.0, "helix_slope_um": 1.0}
EXACT = 1e-6
"""um; sums of terms that are linear in their amounts: rounding, and 1e-4 um of points in space, of second order."""


def with_amounts(scene, amounts, gear="wheel"):
    return scene.with_changes({f"{gear}.modifications.{key}": value for key, value in amounts.items()})


def removed(scene, amounts, gear="wheel", points=(7, 11)):
    """Places on a flank and what modifications remove there [mm]."""
    flank = getattr(with_amounts(scene, amounts, gear).pair(), gear).flank
    rho, z = (part[1:-1, 1:-1] for part in flank.grid(*points))
    return rho, z, flank.removal(rho, z).value


SCENES = {name: read_scene(f"examples/scenes/{name}.toml") for name in ("helical", "spiral_bevel")}


@pytest.mark.parametrize("name", SCENES)
def test_modifications_that_were_put_in_come_back(name):
    scene = with_amounts(SCENES[name], dict.fromkeys(PUT_IN, 0.0))
    rho, z, delta = removed(scene, PUT_IN)
    flank = scene.pair().wheel.flank
    excess = -delta + 2e-5 / flank.gradient_norm(rho, z).value  # and a turn
    bare = measured_modifications(scene, "wheel", MeasuredDeviations(rho, z, excess))
    assert_allclose(bare.measured, [*PUT_IN.values()], atol=EXACT)
    assert np.abs(bare.left).max() < 1e-9
    designed = with_amounts(scene, DESIGN)
    rest = excess + removed(scene, DESIGN)[2]
    for measured_from, deviations in (("unmodified", excess), ("modified", rest)):
        made = measured_modifications(
            designed, "wheel", MeasuredDeviations(rho, z, deviations), measured_from=measured_from
        )
        assert_allclose(made.measured, [*PUT_IN.values()], atol=EXACT)
        assert made.design.tolist() == [DESIGN.get(key, 0.0) for key in made.keys]
    assert made.written.wheel.modifications.lead_crowning_um == pytest.approx(9.0, abs=EXACT)


def test_points_in_space_count_from_nothing():
    scene = with_amounts(SCENES["helical"], dict.fromkeys(PUT_IN, 0.0))
    flank = with_amounts(scene, PUT_IN).pair().wheel.flank
    rho, z = (part[1:-1, 1:-1] for part in flank.grid(7, 11))
    theta = flank.theta(rho, z).value + 1.0
    points = MeasuredPoints(np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=-1))
    designed = with_amounts(scene, DESIGN)
    for measured_from in ("modified", "unmodified"):
        made = measured_modifications(designed, "wheel", points, measured_from=measured_from)
        assert_allclose(made.measured, [*PUT_IN.values()], atol=1e-4)


def test_lines_have_no_twist_and_noise_has_standard_deviations():
    scene = with_amounts(SCENES["helical"], dict.fromkeys(PUT_IN, 0.0))
    amounts = {key: value for key, value in PUT_IN.items() if key != "twist_um"}
    rho, z, delta = removed(scene, amounts, points=(17, 23))
    noise = 0.2 * np.random.default_rng(3).standard_normal(delta.shape)
    rows = [f"profile,{rho[i, 10]},{z[i, 10]},{-1e3 * delta[i, 10] + noise[i, 10]}" for i in range(rho.shape[0])]
    rows += [f"helix,{rho[7, j]},{z[7, j]},{-1e3 * delta[7, j] + noise[7, j]}" for j in range(rho.shape[1])]
    made = measured_modifications(
        scene, "wheel", parse_topography("\n".join(["line,radius_mm,axial_mm,deviation_um", *rows]))
    )
    assert made.keys == tuple(amounts)
    assert_allclose(made.measured, [*amounts.values()], atol=0.4)  # of 15 and 21 points; seeded
    assert "form deviations left: rms 0.2" in made.summary()


def test_lines_of_a_scene_and_of_a_file_have_the_same_standard_deviations(tmp_path):
    """A comment says nothing of how a flank was measured: its columns do."""
    scene = with_amounts(SCENES["helical"], dict.fromkeys(PUT_IN, 0.0))
    rho, z, delta = removed(scene, {"lead_crowning_um": 9.0}, points=(12, 12))
    rows = [f"profile,{rho[i, 5]},{z[i, 5]},{-delta[i, 5] / 25.4e-6 + (-1) ** i}" for i in range(rho.shape[0])]
    rows += [f"helix,{rho[5, j]},{z[5, j]},{-delta[5, j] / 25.4e-6 - (-1) ** j}" for j in range(rho.shape[1])]
    text = "\n".join(["line,radius_mm,axial_mm,deviation_uin", *rows])
    (tmp_path / "lines.csv").write_text(text, encoding="utf-8")
    by_file = measured_modifications(scene, "wheel", parse_topography(text))
    kept = scene.with_changes({"wheel.flank": {"form": "measured", "file": str(tmp_path / "lines.csv")}})
    assert kept.wheel.flank.measurement.two_lines
    again = measured_modifications(parse_scene(kept.to_toml()), "wheel")
    assert again.keys == by_file.keys
    assert "twist_um" not in again.keys
    assert_allclose(again.deviation, by_file.deviation, rtol=1e-6)  # of 12 digits that a scene keeps
    assert_allclose(by_file.measured[2], 9.0, atol=0.1)  # um; beside a waviness of 25 nm
    grid = [f"{rho[i, j]},{z[i, j]},{-1e3 * delta[i, j]}" for j in range(rho.shape[1]) for i in range(rho.shape[0])]
    size = f"# points = {rho.shape[0]} x {rho.shape[1]}"
    points = parse_topography("\n".join(["# lines = 10", size, "radius_mm,axial_mm,deviation_um", *grid]))
    assert "twist_um" in measured_modifications(scene, "wheel", points).keys


def test_flank_of_the_scene_is_taken_and_others_are_refused():
    scene = read_scene("examples/scenes/measured_flank.toml")
    assert measured_modifications(scene, "wheel").measured[2] == pytest.approx(8.0, abs=0.2)  # that was made
    with pytest.raises(InputError, match=r"pinion[.]flank: no measurement"):
        measured_modifications(scene, "pinion")
    with pytest.raises(InputError, match=r"pair.double_helical: found true; .* scene.half_scenes\(0.0\)"):
        measured_modifications(read_scene("examples/scenes/double_helical.toml"), "wheel")
    with pytest.raises(InputError, match="gear: 'gear' is not 'pinion' or 'wheel'"):
        measured_modifications(scene, "gear")
    with pytest.raises(InputError, match="measured_from: 'x' is not 'modified' or 'unmodified'"):
        measured_modifications(scene, "wheel", measured_from="x")
    rho, z, delta = removed(SCENES["helical"], PUT_IN)
    with pytest.raises(InputError, match=r"wheel.flank: 45 of 45 points lie beside the flank"):
        measured_modifications(scene, "wheel", MeasuredDeviations(rho, z + 50.0, delta))
    with pytest.raises(InputError, match=r"wheel.flank: 9 points do not distinguish .*; measure more lines"):
        measured_modifications(scene, "wheel", MeasuredDeviations(rho[:1], z[:1], delta[:1]))
    hollow = measured_modifications(scene, "wheel", MeasuredDeviations(rho, z, 1e-4 * z**2))
    with pytest.raises(InputError, match="lead_crowning_um"):
        _ = hollow.written


def test_command_shows_modifications_and_writes_them(run, tmp_path):
    out = tmp_path / "written.toml"
    code, text, err = run("measured", "examples/scenes/measured_flank.toml", "--out", str(out))
    assert (code, err) == (0, [])
    assert text.splitlines()[0].split() == ["wheel", "[um]", "design", "measured", "+-", "std", "difference"]
    wheel = read_scene(out).wheel
    assert wheel.flank.form == "analytic"
    assert wheel.modifications.lead_crowning_um == pytest.approx(8.0, abs=0.2)
    code, _, err = run("measured", "examples/scenes/helical.toml", "--file", "examples/scenes/duplex_wheel_convex.csv")
    assert code == 2
    assert "points lie beside the flank" in err[0]
    assert run("measured", "examples/scenes/helical.toml")[2] == [
        "loaded-tca: --gear: missing; allowed pinion or wheel, whose flank is measured"
    ]
