"""Blanks of hypoid pairs: printed numbers of annex F and annex D, tapers, backlash, what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import BevelBlank, HypoidBlank, HypoidCones, PitchConeParameters
from loaded_tca.gears.bevel import pitch_angles
from tests.gears.test_hypoid import annex_d, annex_f3, deg
from tests.refusals import refused_calls


def sample(**changes):
    """The second pair of annex F of ISO 23509:2016: data type II with c_ham 0.35, k_t 0.1; j_et2 0.2 mm."""
    values = {
        "teeth": (13, 42),
        "pitch_cones": annex_f3(),
        "face_width": 30.0,
        "cutter_radius": 63.5,
        "profile_shift": 0.3,
        "thickness_modification": 0.05,
        "wheel_angles": deg(1.0, 4.0),
        "backlash": 0.2,
    }
    return HypoidBlank(**(values | changes))


# 1.5 of the last digit; lengths on the pinion's cone 3e-3, as R_m1 of the standard's iteration is 0.002 mm off its end
PRINTED = [
    ("m_mn", lambda b: b.mean_normal_module, 2.640, 1.5e-3),
    ("alpha_nD, alpha_nC", lambda b: np.degrees(b.generated_pressure_angles), (17.747, 22.253), 1.5e-3),
    ("h_mw, c", lambda b: (b.working_depth, b.clearance), (5.280, 0.660), 1.5e-3),
    ("R_i2, R_e2", lambda b: np.array(b.wheel_cone_distances)[[0, 2]], (61.468, 91.468), 1.5e-3),
    ("h_am", lambda b: b.mean_addenda, (3.432, 1.848), 1.5e-3),
    ("h_fm", lambda b: b.mean_dedenda, (2.508, 4.092), 1.5e-3),
    ("delta_a1, delta_f1", lambda b: np.degrees([b.pinion.face_angle, b.pinion.root_angle]), (25.232, 20.303), 1.5e-3),
    ("delta_a2, delta_f2", lambda b: np.degrees([b.wheel.face_angle, b.wheel.root_angle]), (69.323, 64.324), 1.5e-3),
    ("b_1", lambda b: b.pinion_face_width, 31.910, 1.5e-3),
    ("R_i1, R_e1", lambda b: np.array(b.pinion_cone_distances)[[0, 2]], (57.697, 89.608), 3e-3),
    (
        "R_i21, R_e21",
        lambda b: [b.on_wheel(r) for r in np.array(b.pinion_cone_distances)[[0, 2]]],
        (60.907, 92.163),
        2e-3,
    ),
    ("beta_1", lambda b: np.degrees(b.spiral_angles[0]), (44.879, 49.998, 57.544), 2.5e-3),
    ("beta_2", lambda b: np.degrees(b.spiral_angles[1]), (30.826, 38.609, 47.674), 2.5e-3),
    ("h_ae", lambda b: (b.pinion.addenda[2], b.wheel.addenda[2]), (4.541, 2.112), 1.5e-3),
    ("h_fi", lambda b: (b.pinion.dedenda[0], b.wheel.dedenda[0]), (2.236, 3.052), 1.5e-3),
    ("s_mn", lambda b: (b.pinion.mean_normal_thickness, b.wheel.mean_normal_thickness), (4.922, 3.241), 1.5e-3),
    ("d_ae", lambda b: (b.pinion.tip_diameters[2], b.wheel.tip_diameters[2]), (73.528, 171.560), 1.5e-3),
    ("d_fi", lambda b: (b.pinion.root_diameters[0], b.wheel.root_diameters[0]), (37.730, 111.989), 2e-3),
]


@pytest.mark.parametrize(
    ("obtained", "printed", "digit"), [row[1:] for row in PRINTED], ids=[row[0] for row in PRINTED]
)
def test_dimension_of_annex_f3_is_the_printed_one(obtained, printed, digit):
    assert_allclose(obtained(sample()), printed, atol=digit)


@pytest.mark.parametrize("gear", [0, 1])
def test_crowns_of_annex_f3_lie_where_the_apexes_of_the_face_cones_say(gear):
    blank = sample()
    own = (blank.pinion, blank.wheel)[gear]
    printed = ((54.135, 83.070), (19.653, 30.247))[gear]  # t_xi, t_xo from the crossing point
    crowns = own.crown_to_crossing[[0, 2]] - blank.cones.apexes[gear]
    assert_allclose(crowns, printed, atol=2e-3)
    # the face cone through both crowns has its apex at t_zF, but for c (1 - cos(theta_f2)) of the depth
    assert_allclose(own.tip_diameters[[0, 2]] / 2.0 / math.tan(own.face_angle) - crowns, own.face_apex, atol=0.02)


def test_spiral_angles_of_annex_d_are_the_printed_ones():
    blank = sample(
        teeth=(11, 45),
        pitch_cones=PitchConeParameters(annex_d(), deg(48.37777, 30.4101), (143.57 - 123.105) / 40.64),
        face_width=40.64,
        cutter_radius=114.3,
        wheel_angles=None,
    )
    digit = math.radians(1.5e-5)
    assert_allclose(blank.mean_normal_module, 4.49574, rtol=1e-5)  # R_m2 has six digits
    assert_allclose([blank.on_wheel(151.294), blank.on_wheel(151.294 - 46.712)], [145.60856, 101.24881], atol=2e-5)
    found = [blank.pinion_spiral_angle_at(151.294), blank.pinion_spiral_angle_at(151.294 - 46.712)]
    assert_allclose(found, deg(52.68011, 45.83196), atol=2.0 * digit)
    assert_allclose(np.array(blank.spiral_angles[1])[[0, 2]], deg(24.30501, 36.89265), atol=digit)


def test_clearance_of_the_blanks_is_found_by_the_cones():
    """Face and root cones come as near as the clearance, wherever."""
    from loaded_tca.flanks.hypoid_synthesis import _outline
    from loaded_tca.gears import Blade, Cutter, FaceMilledGear, HypoidMesh, MachineSettings

    blank = sample()
    cutter, machine = Cutter(Blade(63.5, 0.3)), MachineSettings(60.0, 1.0, 0.3, 1.0)
    gears = [
        FaceMilledGear(teeth, _outline(blank, member), cutter, machine) for member, teeth in enumerate(blank.teeth)
    ]
    mesh = HypoidMesh(*gears, blank.cones.shaft_angle, blank.cones)
    assert_allclose(mesh.tip_clearances, blank.clearance, rtol=1e-3)  # a line of the cones, between points
    assert_allclose(mesh.offset, 15.0)


def bevel(taper):
    """The first pair of annex F, without an offset, as a limit of hypoids."""
    options = {"spiral_angle": math.radians(35.0), "cutter_radius": 114.3, "profile_shift": 0.505, "taper": taper}
    return BevelBlank.from_wheel_diameter((14, 39), 176.893, 25.4, thickness_modification=0.045, **options)


@pytest.mark.parametrize("taper", ["duplex", "standard", "uniform"])
def test_without_an_offset_a_hypoid_blank_is_a_bevel_blank(taper):
    expected = bevel(taper)
    cones = HypoidCones(pitch_angles((14, 39), 0.5 * math.pi), (expected.mean_cone_distance,) * 2, 0.0)
    found = HypoidBlank(
        (14, 39),
        PitchConeParameters(cones, deg(35.0, 35.0), 0.5),
        25.4,
        114.3,
        limit_factor=0.0,
        profile_shift=0.505,
        thickness_modification=0.045,
        taper=taper,
    )
    for one, other in ((found.pinion, expected.pinion), (found.wheel, expected.wheel)):
        for name in ("face_angle", "root_angle", "face_apex", "root_apex", "mean_normal_thickness", "spiral_angles"):
            # mm or rad; lengths of some 100 mm are subtracted: 4e-15 seen
            assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-12, atol=1e-12, err_msg=name)
        assert_allclose(one.cone_distances, other.cone_distances)


@pytest.mark.parametrize("kind", ["outer_normal", "outer_transverse", "mean_normal", "mean_transverse"])
def test_kinds_of_backlash_are_the_same_backlash(kind):
    wide = sample(backlash_kind="outer_normal")
    outer = wide.outer_normal_backlash
    assert_allclose(outer, 0.2)
    per_unit = sample(backlash=1.0, backlash_kind=kind).outer_normal_backlash
    same = sample(backlash=0.2 / per_unit, backlash_kind=kind)
    assert_allclose(same.outer_normal_backlash, 0.2)
    assert_allclose(same.pinion.mean_normal_thickness, wide.pinion.mean_normal_thickness)


ON_PAPER = replace(annex_f3(), face_width=None, cutter_radius=None)
"""Pitch cones as of a drawing, which does not say what they were found with."""

test_blank_refuses = refused_calls(
    (lambda: sample(face_width=-1.0), "face_width: -1.0 is not positive"),
    (lambda: sample(pressure_angles=(0.3, 1.0)), r"pressure_angles: \(0.3, 1.0\) rad are not between"),
    (lambda: sample(dedendum_factor=0.9), "dedendum_factor: 0 < addendum_factor 1.0 <= 0.9 does not hold"),
    (lambda: sample(wheel_angles=(1.0, 0.0)), "wheel_angles: .* are not within"),
    (lambda: sample(backlash=-0.1), "backlash: -0.1 mm is negative"),
    (lambda: sample(taper="modified"), "taper: 'modified' is not one of duplex, standard, uniform"),
    (lambda: sample(face_width=50.0), "face_width: found 50 mm; allowed 30 mm, with which the pitch cones were found"),
    (lambda: sample(cutter_radius=60.0), r"cutter_radius: found 60 mm; allowed 63\.5 mm, with which"),
    (lambda: sample(teeth=(11, 45)), "teeth: found 11 and 45, which do not roll on these pitch cones"),
    (
        lambda: sample(pitch_cones=ON_PAPER, face_width=125.0),
        "face_width: 125 mm reaches below the offset",
        GeometryError,
    ),
    (
        lambda: sample(pitch_cones=ON_PAPER, cutter_radius=25.0),
        "cutter_radius 25.0 mm: its circle does not cross",
        GeometryError,
    ),
    (lambda: sample(profile_shift=1.1), "no addendum is left|pointed", GeometryError),
    (lambda: sample(wheel_angles=deg(-3.0, 4.0)), "root angle .* are not in order", GeometryError),
)


def test_design_angles_without_the_limit_angle_stay():
    assert_allclose(replace(sample(), limit_factor=0.0).generated_pressure_angles, deg(20.0, 20.0))
