import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.output.overview import describe_scene
from loaded_tca.scene import read_scene

SCENES = Path(__file__).parents[2] / "examples" / "scenes"


def described(name="helical", **changes):
    scene = read_scene(SCENES / f"{name}.toml")
    return describe_scene(scene.with_changes({key.replace("__", "."): value for key, value in changes.items()}))


def cells(text, label):
    (row,) = (line for line in text.splitlines() if line.startswith(label))
    return row[44:].split()


def notes(text):
    return [line for line in text.splitlines() if line.startswith(("note: ", "warning: "))]


def test_single_contact_lies_between_the_points_b_and_d():
    text = described("spur")
    mesh = read_scene(SCENES / "spur.toml").mesh()
    high, low = (
        [float(cell) for cell in cells(text, f"{which} single tooth contact")] for which in ("highest", "lowest")
    )
    base = mesh.pinion.base_radius
    roll = [(0.25 * diameter**2 - base**2) ** 0.5 for diameter in (high[0], low[0])]
    points = [mesh.path_of_contact.D, mesh.path_of_contact.B]
    assert_allclose(roll, points, rtol=1e-4)  # four decimals
    wheel = [(0.25 * diameter**2 - mesh.wheel.base_radius**2) ** 0.5 for diameter in (low[1], high[1])]
    assert_allclose(wheel, [mesh.path_of_contact.T2 - point for point in points], rtol=1e-4)


def test_no_single_contact_where_two_pairs_touch_always():
    tips = {"pinion__tip_diameter_mm": 109.8, "wheel__tip_diameter_mm": 178.8, "pair__dedendum_coefficient": 1.31}
    text = described("spur", pair__pressure_angle_deg=14.0, **tips)
    assert float(cells(text, "transverse contact ratio")[0]) > 2.0
    assert "single tooth contact" not in text


@pytest.mark.thorough
def test_estimate_is_shown_and_noted_where_it_exceeds_the_memory(monkeypatch):
    label = "analysis on idle cores, about: [s], [GiB]"
    counts = (20, 2000, 10000)
    texts = [described(analysis__compliance="contact", analysis__positions=count) for count in counts]
    seconds, memory = (np.array([float(cells(text, label)[column]) for text in texts]) for column in (0, 1))
    # imports, files and pictures take as long whatever the positions; two digits are within 5 %, a difference of
    # numbers of which one is five times the other within 7.5 %
    growth = np.diff(seconds) / np.diff(counts)
    assert growth[1] == pytest.approx(growth[0], rel=0.13)
    assert growth[0] > 0.0
    assert (np.diff(memory) > 0.0).all()
    monkeypatch.setattr("loaded_tca.effort.machine_memory", lambda: 2.0**29)
    assert any(
        "4000 contacts of" in note and "the machine has 0.5 GiB" in note
        for note in notes(described(analysis__positions=2000))
    )


def test_forces_are_those_of_the_torque():
    text = described("helical", analysis__torques_Nm=(13.0, 130.0))
    assert cells(text, "pinion torque [N m]") == ["13", "130"]
    low, high = (float(cell) for cell in cells(text, "base tangential force"))
    assert_allclose(high, 2.0 * 130e3 / float(cells(text, "base diameter")[0]), rtol=1e-4)
    assert_allclose(high / low, 10.0, rtol=1e-3)


def test_many_torques_are_shown_by_their_ends():
    text = described(analysis__torques_Nm=tuple(range(1, 8)))
    assert cells(text, "7 pinion torques from, to [N m]") == ["1", "7"]


@pytest.mark.thorough
def test_what_departs_from_nominal_is_shown_by_its_key():
    text = described("misaligned", pinion__modifications__lead_crowning_form="circular")
    assert cells(text, "mounting.out_of_plane_deg") == ["0.08"]
    assert cells(text, "pinion.modifications.lead_crowning_um") == ["5.0"]
    assert cells(text, "pinion.modifications.lead_crowning_form") == ["circular"]
    assert cells(text, "wheel.modifications") == ["none"]
    assert cells(described(), "mounting errors") == ["none"]


def test_cap_is_shown_where_there_is_one():
    assert cells(described(material__max_pressure_MPa=2500.0), "cap on the pressure") == ["2500"]
    assert "cap on the pressure" not in described()


def test_pair_without_backlash_shows_none_and_no_note():
    assert cells(described(), "backlash") == ["0.0000"]
    assert notes(described()) == []


@pytest.mark.thorough
def test_profile_shift_sum_that_a_centre_distance_needs_is_shown_beside_the_given_one():
    """sum = (z1 + z2)(inv alpha_wt - inv alpha_t)/(2 tan alpha_n); FZG C pair: published x = 0.1817 and 0.1715."""
    text = described("fzg_c14", pair__centre_distance_mm=91.6)
    base, alpha = 4.5 * 40 * math.cos(math.radians(20.0)), math.radians(20.0)
    working = math.acos(base / (2.0 * 91.6))
    needed = 20.0 * (math.tan(working) - working - math.tan(alpha) + alpha) / math.tan(alpha)
    given, without_backlash = (float(cell) for cell in cells(text, "profile shift sum: given, without backlash"))
    assert_allclose([given, without_backlash], [0.3532, needed], atol=6e-5)  # four decimals
    # j_wt = p_wt - s_w1 - s_w2 = 2 m (sum needed - sum given) tan(alpha) cos(alpha)/cos(alpha_wt)
    backlash = 9.0 * (needed - 0.3532) * math.tan(alpha) * math.cos(alpha) / math.cos(working)
    assert_allclose(float(cells(text, "backlash j_wt")[0]), backlash, atol=6e-5)
    assert cells(described("helical"), "profile shift sum") == ["0.0000", "0.0000"]


def test_overlap_is_that_of_the_mounted_gears():
    """Of a pair without backlash at 141.3153 mm, which an error brings nearer or mends."""
    (nominal,) = notes(described(pair__centre_distance_mm=141.3))
    assert "negative backlash" in nominal
    assert "(at the centre distance of 141.3000 mm by 0.0114 mm)" in nominal
    (mounted,) = notes(described(pair__centre_distance_mm=141.3, mounting__centre_distance_error_mm=-0.05))
    assert "(at the mounted centre distance of 141.2500 mm by" in mounted
    assert notes(described(pair__centre_distance_mm=141.3, mounting__centre_distance_error_mm=0.1)) == []


def test_mounting_that_parts_the_gears_is_refused():
    with pytest.raises(GeometryError, match=r"at the mounted centre distance of 171\.3.* no common flank"):
        described(mounting__centre_distance_error_mm=30.0)


def test_gears_that_cannot_mesh_are_an_error():
    with pytest.raises(GeometryError, match="no common flank"):
        described(pair__centre_distance_mm=500.0)


def test_bevel_pair_shows_the_printed_cones_of_its_source():
    """Reduced-TCA dissertation, Table 5: face angles 52.90/41.64 deg, and root angles, which it calls base angles."""
    text = described("straight_bevel")
    assert_allclose([float(cell) for cell in cells(text, "face angle delta_a")], [52.90, 41.64], atol=5e-3)
    assert_allclose([float(cell) for cell in cells(text, "root angle delta_f")], [47.79, 36.53], atol=5e-3)
    assert cells(text, "cone distances R_e, R_m, R_i [mm]") == ["63.0600", "56.0600", "49.0600"]
    assert cells(text, "flank in contact") == ["straight", "straight"]
    assert cells(text, "normal force F_n [N]") == ["1500.3"]


def test_active_profile_of_a_bevel_pair_starts_between_root_and_pitch_cone():
    text = described("spiral_bevel")
    labels = ("root angle", "root form cone angle", "start of active profile", "pitch angle", "face angle")
    angles = [[float(cell) for cell in cells(text, label)] for label in labels]
    for member in (0, 1):
        found = [row[member] for row in angles]
        assert found == sorted(found)
    assert cells(text, "mating tip reaches below the form cone") == ["no", "no"]


def test_bevel_pair_whose_flank_ends_too_high_says_so():
    cones = {f"{gear}__{cone}_angle_deg": None for gear in ("pinion", "wheel") for cone in ("face", "root")}
    text = described("straight_bevel", pinion__teeth=14, wheel__teeth=39, **cones)
    assert cells(text, "mating tip reaches below the form cone") == ["yes", "no"]
    assert any("the tip of the wheel reaches below the form circle of the pinion" in note for note in notes(text))
    with pytest.raises(
        GeometryError, match=r"cannot turn at mid-face .*: the tip of the wheel reaches .* into the root"
    ):
        described("straight_bevel", pinion__root_angle_deg=50.2)


def test_spiral_pair_shows_hands_flanks_and_what_departs_from_nominal():
    text = described("spiral_bevel", mounting__offset_mm=0.02)
    assert cells(text, "hand of the spiral") == ["left", "right"]
    assert cells(text, "flank in contact") == ["concave", "convex"]
    assert cells(text, "mounting.offset_mm") == ["0.02"]
    assert cells(text, "pinion.modifications.lead_crowning_um") == ["10.0"]
    normal = float(cells(text, "pressure angles alpha_t, alpha_n [deg]")[1])
    assert_allclose(math.tan(math.radians(normal)), math.tan(math.radians(20)) * math.cos(math.radians(35)), rtol=1e-5)


@pytest.mark.parametrize(("prefix", "stated"), [("", "transverse"), ("normal_", "normal")])
def test_pressure_angle_that_a_bevel_scene_states_is_named(prefix, stated):
    text = described("spiral_bevel", **{"pair__pressure_angle_deg": None, f"pair__{prefix}pressure_angle_deg": 20.0})
    assert cells(text, "pressure angle that the scene states") == [stated]
    angles = dict(zip(("transverse", "normal"), cells(text, "pressure angles alpha_t, alpha_n [deg]"), strict=True))
    assert angles[stated] == "20.0000"
    assert cells(described("spiral_bevel", pair__pressure_angle_deg=None), "pressure angle that")[0] == "transverse"


def test_profile_shifts_of_one_sign_let_bevel_teeth_overlap():
    """s = m (pi/2 + 2 x tan(alpha)) on both mean pitch circles, m_mt = m_et R_m/R_e."""
    text = described("straight_bevel", pinion__profile_shift=0.1, wheel__profile_shift=-0.3)
    module = 2.5 * 56.06 / 63.06
    backlash = 2.0 * 0.2 * module * math.tan(math.radians(20.0))
    assert_allclose(float(cells(text, "backlash j_mt at the mean pitch circles [mm]")[0]), backlash, atol=6e-5)
    assert cells(described("straight_bevel"), "backlash j_mt") == ["0.0000"]


def test_fitted_flanks_show_how_closely_they_follow_their_points():
    text = described("bspline_bevel")
    assert cells(text, "pinion.flank.form") == cells(text, "wheel.flank.form") == ["bspline"]
    for gear in ("pinion", "wheel"):
        assert float(cells(text, f"{gear}: fit at points, largest, rms [um]")[0]) < 1e-9
        largest, rms = (float(cell) for cell in cells(text, f"{gear}: fit between them, largest, rms [um]"))
        assert 0.0 < rms < largest < 1e-4
    assert "measured points" not in text


def test_measured_flank_shows_its_points_and_deviations():
    text = described("measured_flank")
    assert "pinion.flank.form" not in text
    assert cells(text, "wheel.flank.form") == ["measured"]
    assert cells(text, "wheel: measured points") == ["9", "x", "15"]
    low, high = (float(cell) for cell in cells(text, "wheel: deviations of flank, from, to [um]"))
    assert -15.0 < low < -11.0 < 0.0 < high < 1.0  # 8 um and 3 um of crowning with slopes and waves
    inner = [float(cell) for cell in cells(text, "wheel: deviations at points, from, to [um]")]
    assert low - 0.01 <= inner[0] < inner[1] <= high + 0.01  # the flank goes on beyond them
    rms = float(cells(text, "wheel: fit at points, largest, rms [um]")[1])
    assert rms < 0.2  # what smoothing leaves out: noise of 0.15 um
    assert "between them" not in text


def test_analysis_is_shown_as_it_is_asked_for():
    text = described("mesh_cycle_helical")
    assert cells(text, "load sharing, free edges, compliance") == ["on", "on", "contact+tooth"]
    assert cells(text, "positions, torques") == ["33", "3"]
    assert "bores" in text
    text = described("spur")
    assert cells(text, "load sharing, free edges, compliance") == ["off", "off", "contact"]
    assert "bores or journals" not in text  # nothing is held where the flanks alone yield


def test_bores_are_shown_where_teeth_bend():
    text = described("mesh_cycle_finite_elements", pinion__bore_diameter_mm=30.0)
    given, default = cells(text, "bores or journals held rigid")
    assert given == "30.0000"
    assert_allclose(float(default), 0.55 * 103.5, rtol=1e-6)  # m (z - 2.5)


def test_path_of_contact_has_the_points_of_iso_21771_beside_those_of_the_flanks():
    """Without relief they are the same; relief of the wheel's tip moves A up the pinion's flank, and with it D."""
    modifications = {f"{gear}__modifications__tip_relief_um": 0.0 for gear in ("pinion", "wheel")}
    path = read_scene(SCENES / "mesh_cycle_spur.toml").mesh().path_of_contact
    base = 0.5 * 34 * 3.0 * math.cos(math.radians(20.0))
    plain, relieved = described("mesh_cycle_spur", **modifications), described("mesh_cycle_spur")
    for letter in "ABCDE":
        length = getattr(path, letter)
        expected = [length, math.degrees(length / base), 2.0 * math.hypot(length, base)]
        for text in (plain, relieved):
            found = [float(cell) for cell in cells(text, f"  {letter}, ISO 21771")]
            assert_allclose(found, expected, atol=1e-4)  # four decimals
        if letter != "C":
            found = [float(cell) for cell in cells(plain, f"  {letter}, unloaded contact point")]
            assert_allclose(found, expected, rtol=2e-3)  # ends found to 5e-5 of four pitches
    for letter in "AD":
        assert float(cells(relieved, f"  {letter}, unloaded contact point")[0]) > getattr(path, letter) + 0.1


def test_path_of_contact_that_lies_on_an_edge_has_nominal_points_alone():
    text = described("misaligned")
    assert cells(text, "  A, ISO 21771")
    assert "unloaded contact point" not in text
    assert "path of contact of the pinion" not in described("straight_bevel")


@pytest.mark.quick_cases("changes1-mounting.misalignment_um: -0.012 um is less than 0.1 um")
@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"pinion.modifications.lead_crowning_um": 0.005},
            "pinion.modifications.lead_crowning_um: 0.005 um is less than 0.1 um, which nobody makes; is its unit",
        ),
        ({"mounting.misalignment_um": -0.012}, "mounting.misalignment_um: -0.012 um is less than 0.1 um"),
        ({"load.pinion_torque_Nm": 130e3}, "load.pinion_torque_Nm: 130000 N m is a torque with a sigma_H0 of"),
        ({"load.pinion_torque_Nm": 130e3}, "load.pinion_torque_Nm: 130000 N m is a torque with a sigma_F0 of"),
    ],
)
def test_numbers_of_another_unit_are_asked_about_before_any_contact(changes, told):
    scene = read_scene(SCENES / "helical.toml")
    assert "is its unit right?" not in describe_scene(scene)
    assert f"warning: {told}" in describe_scene(scene.with_changes(changes))


def test_profile_shifts_of_both_gears_are_shown_and_what_asks_for_one_that_cannot_be():
    scene = read_scene(SCENES / "helical.toml").with_changes({"pinion.profile_shift": 0.3, "wheel.profile_shift": None})
    given = scene.with_changes({"pair.centre_distance_mm": scene.mesh().working_centre_distance + 0.4})
    shifts = [float(cell) for cell in cells(describe_scene(given), "profile shift x")]
    assert shifts[0] == 0.3
    assert_allclose(shifts[1], given.mesh().wheel.profile_shift, atol=5e-5)
    with pytest.raises((InputError, GeometryError)) as raised:
        scene.with_changes({"pair.centre_distance_mm": 170.0}).mesh()
    assert any(
        "pair.centre_distance_mm = 170 and the given profile_shift ask for" in one for one in raised.value.__notes__
    )


def test_pitch_deviations_are_those_of_the_teeth():
    """By hand: of 1 2 -1 0 ... the largest step is 3, the range 3; a class fills its tolerances of ISO 1328-1."""
    steps = [1.0, 2.0, -1.0, *[0.0] * 57]
    text = described("helical", wheel__teeth=60, wheel__pitch__index_um=steps, wheel__pitch__runout_um=4.0)
    row = "f_p, F_p at base circle, runout [um]"
    assert cells(text, f"wheel: {row}") == ["3.00", "3.00", "4.00"]
    assert f"pinion: {row}" not in text
    drawn = described("helical", pinion__pitch__tolerance_class=6, pinion__pitch__seed=3)
    single, total, runout = map(float, cells(drawn, f"pinion: {row}"))
    gear = read_scene(SCENES / "helical.toml").mesh().pinion
    sizes = 2.0 * gear.reference_radius, gear.normal_module
    # f_pT = 0.001 d + 0.4 m_n + 5, F_pT = 0.002 d + 0.55 sqrt(d) + 0.7 m_n + 12 of class 5, times sqrt(2)
    nominal = 0.001 * sizes[0] + 0.4 * sizes[1] + 5.0, 0.002 * sizes[0] + 0.55 * sizes[0] ** 0.5 + 0.7 * sizes[1] + 12.0
    # ISO rounds to 0.5 or 1 um; index deviations are along the line of action
    on_arc = np.array([single, total]) / np.cos(gear.transverse_pressure_angle)
    assert_allclose(on_arc, [2.0**0.5 * size for size in nominal], atol=0.51)
    assert runout == 0.0
