"""Bevel blanks: the spiral bevel sample 14 x 39 of ISO 23509 and the published 19 x 62 of SpyGO.

ISO 23509:2016, annex F.2: d_e2 176.893, b 25.4, beta_m 35, alpha 20, r_c0 114.3, x_hm 0.505, x_smn 0.046, j_en 0.127,
theta_a2 2.1342, theta_f2 6.4934 deg. Its input is rounded on the way (x_hm 0.50526 to 0.505), so a last digit may be
off by one. The two angles are those of a duplex taper with the unrounded c_ham 0.24737.

SpyGO: m_et 4.169, b 36.83, Sigma 95, beta_m 35, k_hap 1, k_hfp 1.25, x_hm1 0.05, standard taper. Its machine centre to
back of the pinion, -0.001306 mm, brings the apex of the root cone to the machine centre, so it is t_zR1.

The same sample as a scene of its own (examples/scenes/spiral_bevel_blank.toml), whose contact ratios and forces
ISO/TR 10300-30:2024 prints.
"""

from collections.abc import Iterable
from math import degrees, radians
from pathlib import Path

from loaded_tca.gears.bevel_blank import BevelBlank
from loaded_tca.gears.blank_factors import crown_gear_factors
from loaded_tca.gears.blank_gear import BlankGear
from loaded_tca.scene import read_scene
from validation.table import Row

EXAMPLE = Path(__file__).parents[2] / "examples" / "scenes" / "spiral_bevel_blank.toml"
SAMPLE = "ISO 23509 14 x 39"
SPYGO = "SpyGO 19 x 62"
LENGTH, ANGLE, MODULE = 1e-3, 1e-3, 1e-4  # a unit of the last printed digit


def sample() -> BevelBlank:
    """Sample of ISO 23509, from the rounded factors that its further numbers use."""
    return BevelBlank.from_wheel_diameter(
        (14, 39),
        176.893,
        25.4,
        spiral_angle=radians(35.0),
        cutter_radius=114.3,
        profile_shift=0.505,
        thickness_modification=0.046,
        outer_normal_backlash=0.127,
        wheel_angles=(radians(2.1342), radians(6.4934)),
    )


def duplex_sample() -> BevelBlank:
    """The same from its unrounded factors, with the angles left to the taper."""
    return BevelBlank.from_wheel_diameter(
        (14, 39),
        176.893,
        25.4,
        spiral_angle=radians(35.0),
        cutter_radius=114.3,
        taper="duplex",
        **crown_gear_factors(0.24737, thickness=0.0915),
    )


def spygo() -> BevelBlank:
    """Face-milled pair that SpyGO publishes."""
    return BevelBlank(
        (19, 62),
        4.169,
        36.83,
        shaft_angle=radians(95.0),
        spiral_angle=radians(35.0),
        cutter_radius=95.25,
        profile_shift=0.05,
        thickness_modification=0.0649,
        outer_normal_backlash=0.1,
    )


def rows() -> list[Row]:
    """Compare every printed number."""
    return [*_sample_rows(), *_taper_rows(), *_spygo_rows(), *_scene_rows()]


def _scene_rows() -> Iterable[Row]:
    """The sample as a scene: contact ratios and forces of ISO/TR 10300-30:2024, sample 1 (T1 300 N m)."""
    scene = read_scene(EXAMPLE)
    blanks = scene.blanks()
    profile, lengthwise = blanks.virtual_contact_ratios
    yield _row("eps_va, scene", 1.165, profile, LENGTH)
    yield _row("eps_vb, scene", 1.227, lengthwise, LENGTH)
    forces = {label: float(cells[0]) for label, *cells in scene.force_rows(scene.torques)}
    yield _row("F_mt, scene [N]", 10925.3, forces["mean tangential force F_mt [N]"], 0.1)
    yield _row("F_n, scene [N]", 14193.3, forces["normal force F_n [N]"], 0.1)


def _sample_rows() -> Iterable[Row]:
    blank = sample()
    yield _row("R_m [mm]", 81.273, blank.mean_cone_distance, LENGTH)
    yield _row("m_mt [mm]", 3.9227, blank.mean_transverse_module, MODULE)
    yield _row("m_mn [mm]", 3.2133, blank.mean_normal_module, MODULE)
    yield _row("c [mm]", 0.803, blank.clearance, LENGTH)
    yield _row("h_m [mm]", 7.230, blank.whole_depth, LENGTH)
    yield _row("beta_e [deg]", 36.846, degrees(blank.spiral_angle_at(blank.outer_cone_distance)), ANGLE)
    yield _row("beta_i [deg]", 33.946, degrees(blank.spiral_angle_at(blank.cone_distances[0])), ANGLE)
    printed = (
        ("delta [deg]", (19.7468, 70.2532), 0.1 * ANGLE, lambda gear: degrees(gear.pitch_angle)),
        ("delta_a [deg]", (26.2402, 72.3874), 0.1 * ANGLE, lambda gear: degrees(gear.face_angle)),
        ("delta_f [deg]", (17.6126, 63.7598), 0.1 * ANGLE, lambda gear: degrees(gear.root_angle)),
        ("d_m [mm]", (54.919, 152.987), LENGTH, lambda gear: gear.pitch_diameters[1]),
        ("h_am [mm]", (4.836, 1.591), LENGTH, lambda gear: gear.mean_addendum),
        ("h_fm [mm]", (2.394, 5.639), LENGTH, lambda gear: gear.mean_dedendum),
        ("h_ae [mm]", (6.281, 2.064), LENGTH, lambda gear: gear.addenda[2]),
        ("h_fe [mm]", (2.867, 7.085), LENGTH, lambda gear: gear.dedenda[2]),
        ("h_ai [mm]", (3.391, 1.117), LENGTH, lambda gear: gear.addenda[0]),
        ("d_ae [mm]", (75.324, 178.288), LENGTH, lambda gear: gear.tip_diameters[2]),
        ("d_fi [mm]", (42.721, 126.246), LENGTH, lambda gear: gear.root_diameters[0]),
        ("t_xo [mm]", (86.324, 29.808), LENGTH, lambda gear: gear.crown_to_crossing[2]),
        ("t_zF [mm]", (-9.931, -1.508), LENGTH, lambda gear: gear.face_apex),
        ("t_zR [mm]", (2.094, 3.999), 2.0 * LENGTH, lambda gear: gear.root_apex),
        ("s_mn [mm]", (6.465, 3.511), LENGTH, lambda gear: gear.mean_normal_thickness),
        ("s_mnc [mm]", (6.458, 3.511), LENGTH, lambda gear: gear.chordal_thickness),
        ("h_amc [mm]", (4.955, 1.592), LENGTH, lambda gear: gear.chordal_addendum),
    )
    for quantity, expected, digit, obtained in printed:
        for value, gear in zip(expected, (blank.pinion, blank.wheel), strict=True):
            yield _row(f"{gear.name} {quantity}", value, obtained(gear), digit)


def _taper_rows() -> Iterable[Row]:
    wheel = duplex_sample().wheel
    yield _row("theta_a2, duplex taper [deg]", 2.1342, degrees(wheel.addendum_angle), 0.1 * ANGLE)
    yield _row("theta_f2, duplex taper [deg]", 6.4934, degrees(wheel.dedendum_angle), 0.1 * ANGLE)


def _spygo_rows() -> Iterable[Row]:
    blank = spygo()
    yield Row(SPYGO, "SpyGO", "R_e [mm]", 132.33333847, blank.outer_cone_distance, 1e-10)
    printed = {
        "pinion": (17.414716635, 19.336171904, 15.640967271),
        "wheel": (77.585283365, 79.359032729, 75.663828096),
    }
    for gear in (blank.pinion, blank.wheel):
        for name, value, angle in zip(("pitch", "face", "root"), printed[gear.name], _cones(gear), strict=True):
            yield Row(SPYGO, "SpyGO", f"{gear.name} {name} angle [deg]", value, degrees(angle), 1e-10)
    assumed = "machine centre to back is the root apex t_zR"
    yield Row(SPYGO, "SpyGO", "pinion t_zR [mm]", -0.001306, blank.pinion.root_apex, 5e-4, assumed)


def _cones(gear: BlankGear) -> tuple[float, float, float]:
    return gear.pitch_angle, gear.face_angle, gear.root_angle


def _row(quantity: str, expected: float, obtained: float, digit: float) -> Row:
    return Row(SAMPLE, "ISO 23509:2016, F.2", quantity, expected, obtained, digit / abs(expected))
