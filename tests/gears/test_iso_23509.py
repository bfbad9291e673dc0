"""Blanks of many pairs beside formulas of the standard written apart (iso23509.py here); annex F.2 as printed."""

from math import cos, degrees, pi, radians, sin, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears import BevelBlank, BlankGear
from tests.gears import iso23509

TAPERS = ["standard", "uniform", "duplex", "modified"]
PAIRS = 60
"""Of each taper."""
ROUNDING = 1e-9
"""Of formulas in another order: differences of two lengths lose some digits."""
OF_GEARS = (
    "pitch_angle",
    "face_angle",
    "root_angle",
    "addenda",
    "dedenda",
    "pitch_diameters",
    "tip_diameters",
    "root_diameters",
    "crown_to_crossing",
    "face_apex",
    "root_apex",
    "mean_point_to_crossing",
    "thickness_coefficient",
    "mean_normal_thickness",
    "virtual_diameter",
    "chordal_thickness",
    "chordal_addendum",
)
OF_PAIR = "mean_cone_distance", "outer_cone_distance", "mean_normal_module", "clearance", "dedendum_angles"


def random_pair(rng, taper):
    """Arguments of the formulas, shaft angles of 30 to 140 deg."""
    z = int(rng.integers(8, 40)), int(rng.integers(15, 80))
    return {
        "z": (min(z), max(z)),
        "m_et": rng.uniform(1.0, 8.0),
        "b": 0.0,
        "sigma": radians(rng.uniform(30.0, 140.0)),
        "alpha": radians(rng.choice([16.0, 20.0, 22.5, 25.0])),
        "beta": radians(rng.uniform(0.0, 42.0)),
        "r_c0": None,
        "x_hm": rng.uniform(-0.1, 0.5),
        "k_hap": rng.uniform(0.8, 1.05),
        "k_hfp": rng.uniform(1.1, 1.3),
        "x_smn": rng.uniform(-0.05, 0.08),
        "j_en": rng.uniform(0.0, 0.2),
        "taper": taper,
        "c_be2": rng.uniform(0.4, 0.6),
    }


def blank_of(pair):
    return BevelBlank(
        pair["z"],
        pair["m_et"],
        pair["b"],
        shaft_angle=pair["sigma"],
        pressure_angle=pair["alpha"],
        spiral_angle=pair["beta"],
        cutter_radius=pair["r_c0"],
        profile_shift=pair["x_hm"],
        thickness_modification=pair["x_smn"],
        addendum_factor=pair["k_hap"],
        dedendum_factor=pair["k_hfp"],
        outer_normal_backlash=pair["j_en"],
        taper=pair["taper"],
        allow_undercut=True,
        pinion_face_width=pair["b1"],
        outer_share=pair["c_be2"],
    )


@pytest.mark.parametrize("taper", TAPERS)
def test_blanks_of_random_pairs_are_those_of_the_formulas(taper):
    """Pairs that cannot exist are left out; at least half of them can."""
    rng, made = np.random.default_rng(TAPERS.index(taper)), 0
    for _ in range(PAIRS):
        pair = random_pair(rng, taper)
        delta = iso23509.atan(sin(pair["sigma"]) / (cos(pair["sigma"]) + pair["z"][1] / pair["z"][0]))
        outer = 0.5 * pair["z"][0] * pair["m_et"] / sin(delta)
        pair |= {"b": rng.uniform(0.1, 0.3) * outer, "r_c0": outer * rng.uniform(0.7, 1.6)}
        pair["b1"] = pair["b"] * rng.uniform(1.0, 1.1)
        try:
            blank = blank_of(pair)
        except (GeometryError, InputError):
            continue
        made += 1
        sheet = iso23509.sheet(**pair)
        for name in OF_PAIR:
            # atol, also below: rad, angles that may be zero
            assert_allclose(getattr(blank, name), sheet[name], rtol=ROUNDING, atol=1e-12, err_msg=name)
        if sheet["virtual_contact_ratios"] is not None:
            assert_allclose(blank.virtual_contact_ratios, sheet["virtual_contact_ratios"], rtol=ROUNDING)
        for gear, formulas in zip((blank.pinion, blank.wheel), sheet["gears"], strict=True):
            for name in OF_GEARS:
                if formulas[name] is not None:
                    length = 1e-11 * sheet["outer_cone_distance"]
                    assert_allclose(getattr(gear, name), formulas[name], rtol=ROUNDING, atol=length, err_msg=name)
            assert_allclose(gear.spiral_angles, formulas["spiral_angles"], rtol=ROUNDING, atol=1e-12)
            # the tip at the heel lies off the face cone by c (1 - cos theta), as depths of the pinion do
            off = sheet["clearance"] * (1.0 - cos(max(map(abs, sheet["dedendum_angles"])))) + 1e-9
            assert_allclose(gear.outer_whole_depth, iso23509.whole_depth_at_heel(formulas), atol=5.0 * off)
            if taper == "duplex" and formulas["pitch_angle"] < radians(89.0):
                slot, thick, lands = iso23509.spread_blade_slots(formulas, gear.teeth, pair["alpha"])
                assert_allclose(gear.slot_widths, slot, rtol=1e-8)
                assert_allclose(gear.normal_thicknesses, thick, rtol=1e-8)
                assert_allclose(gear.tip_thicknesses, lands, rtol=1e-6, atol=1e-9)
    assert made > PAIRS // 2


def test_numbers_of_annex_f2_that_other_tests_leave_out():
    """d_mn1 as printed; the others from printed ones, in their last digits.

    t_zm from d_m/2 and delta; x_sm from s_mn, m_mn and x_hm; the whole depth h_t1 from printed cones.
    """
    blank = BevelBlank.from_wheel_diameter(
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
    assert_allclose(blank.pinion.virtual_diameter, 82.241, atol=1e-3)
    for gear, diameter, angle, thickness, shift in (
        (blank.pinion, 54.919, 19.7468, 6.465, 0.505),
        (blank.wheel, 152.987, 70.2532, 3.511, -0.505),
    ):
        assert_allclose(gear.mean_point_to_crossing, 0.5 * diameter / tan(radians(angle)), atol=2e-3)
        coefficient = 0.5 * thickness / 3.2133 - 0.25 * pi - shift * tan(radians(20.0))
        assert_allclose(gear.thickness_coefficient, coefficient, atol=2e-4)
    printed = {"crown_to_crossing": (0.0, 0.0, 86.324), "root_apex": 2.094, "root_angle": radians(17.6126)}
    printed["tip_diameters"] = 0.0, 0.0, 75.324
    assert_allclose(blank.pinion.outer_whole_depth, iso23509.whole_depth_at_heel(printed), atol=7e-3)  # c (1 - cos)


def test_slot_of_the_pinion_of_agma_929_is_the_printed_one():
    """AGMA 929-B22, annex D: W_m1 from m_mn, s_mn1, h_fm1 and both pressure angles, which no offset changes.

    Drive and coast side have 18.1448 and 21.8552 deg: the slot narrows by the sum of their tangents.
    """
    both = radians(18.1448), radians(21.8552)
    module, delta = 4.49574, radians(16.8693)
    distance = 0.5 * 11 * module / sin(delta)  # straight teeth of this normal pitch
    gear = BlankGear(
        name="pinion",
        teeth=11,
        pitch_angle=delta,
        pressure_angle=iso23509.atan(0.5 * sum(map(tan, both))),
        cone_distances=(distance - 20.0, distance, distance + 20.0),
        spiral_angles=(0.0, 0.0, 0.0),
        mean_addendum=7.27566,
        mean_dedendum=3.18216,
        addendum_angle=radians(4.6277),
        dedendum_angle=radians(1.5349),
        mean_normal_thickness=9.11957,
        profile_shift=0.0,
        smallest_profile_shift=0.0,
        face_apex=0.0,
        root_apex=0.0,
        constant_slots=True,
    )
    assert_allclose(gear.mean_slot_width, 2.68503, atol=3e-5)  # angles of four digits: 1e-5 of 3.2 mm
    assert_allclose(gear.slot_widths, gear.mean_slot_width, rtol=1e-12)


def test_degrees_of_annex_f2():
    """The formulas themselves give the printed cones."""
    sheet = iso23509.sheet(
        z=(14, 39),
        m_et=176.893 / 39,
        b=25.4,
        sigma=radians(90.0),
        alpha=radians(20.0),
        beta=radians(35.0),
        r_c0=114.3,
        x_hm=2.0 * (0.5 - 0.24737),
        k_hap=1.0,
        k_hfp=1.25,
        x_smn=0.04575,
        j_en=0.127,
        taper="duplex",
    )
    angles = [degrees(gear[name]) for gear in sheet["gears"] for name in ("face_angle", "root_angle")]
    assert_allclose(angles, (26.2402, 17.6126, 72.3874, 63.7598), atol=2e-4)
    assert_allclose(sheet["virtual_contact_ratios"], (1.165, 1.227), atol=5e-4)
