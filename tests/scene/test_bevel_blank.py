"""Blanks of ISO 23509 in scenes; the numbers of annex F.2 are the printed ones."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears.basic_settings import duplex_spread_blade, spread_blade
from loaded_tca.gears.blank_factors import usual_factors
from loaded_tca.pairs import mating_teeth
from loaded_tca.pairs.bevel import face_milled_pair
from loaded_tca.scene import parse_scene, read_scene
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.curvature import relative_curvature
from tests.samples.results import SCENES

ROUNDING = 1e-12  # relative, rad or mm: some dozen operations on angles of order one and lengths of 100 mm
F2 = """
title = "annex F.2"
[pair]
type = "spiral_bevel"
wheel_outer_diameter_mm = 176.893
spiral_angle_deg = 35.0
[pair.blank]
taper = "duplex"
cutter_radius_mm = 114.3
outer_normal_backlash_mm = 0.127
[pinion]
teeth = 14
face_width_mm = 25.4
hand = "left"
[wheel]
teeth = 39
face_width_mm = 25.4
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 300.0
"""


def annex_f2(**changes):
    return parse_scene(F2).with_changes(changes)


def row(scene, label):
    """Cells of a line of the geometry table."""
    (cells,) = [cells for name, *cells in scene.geometry_rows() if name == label]
    return [float(cell) for cell in cells]


@pytest.mark.parametrize(
    ("label", "printed"),
    [
        ("mean normal module m_mn [mm]", (3.213,)),
        ("contact ratios eps_va, eps_vb by 0.85 b", (1.165, 1.227)),
        ("face angle delta_a of the cone itself [deg]", (26.24, 72.387)),
        ("root angle delta_f of the cone itself [deg]", (17.613, 63.76)),
        ("addendum h_a, mean point [mm]", (4.836, 1.591)),
        ("addendum h_a, heel [mm]", (6.281, 2.064)),
        ("dedendum h_f, mean point [mm]", (2.394, 5.639)),
        ("mean working depth h_mw, whole depth h_m [mm]", (6.427, 7.230)),
        ("clearance c, normal to the cones [mm]", (0.803,)),
    ],
)
def test_sheet_of_annex_f2_has_the_printed_numbers(label, printed):
    """By default: the usual factors of annex C are those of the sample, 0.24737 and 0.0915."""
    assert_allclose(row(annex_f2(), label), printed, atol=1.5e-3)  # last digits, of factors that are rounded


def test_forces_of_annex_f2_are_those_of_iso_tr_10300_30():
    scene = annex_f2()
    forces = {label: float(cell) for label, cell, *_ in scene.force_rows(scene.torques)}
    assert forces["mean tangential force F_mt [N]"] == 10925.3
    assert forces["normal force F_n [N]"] == 14193.3


def test_drawing_values_of_type_one_are_the_same_blank():
    """Both types of data of one pair (table 4): 0.505 and 0.04575 are rounded."""
    two = annex_f2()
    changes = {"pair.blank.profile_shift": 0.505, "pair.blank.thickness_modification": 0.04575}
    one = annex_f2(**changes)
    assert one.geometry.blank.data_type == "I"
    for name in ("mean_addendum", "mean_normal_thickness", "face_apex", "root_angle"):
        first, second = ([getattr(gear, name) for gear in (s.blanks().pinion, s.blanks().wheel)] for s in (one, two))
        assert_allclose(first, second, rtol=2e-3)


def test_slot_width_stands_for_the_thickness_factor():
    """W_m2 = 2.41761 mm is x_smn = 0.045750 of the sample, where slots are without backlash."""
    scene = annex_f2(**{"pair.blank.wheel_slot_width_mm": 2.41761})
    assert_allclose(scene.blanks().thickness_modification, 0.04575, atol=1e-5)


@pytest.mark.parametrize("taper", ["standard", "uniform", "duplex", "modified"])
def test_flank_ends_on_the_cones_of_the_blank(taper):
    scene = annex_f2(**{"pair.blank.taper": taper})
    pair, blanks = scene.pair(), scene.blanks()
    for gear, blank in ((pair.pinion, blanks.pinion), (pair.wheel, blanks.wheel)):
        rho, z = gear.flank.grid(7, 5)
        tip = rho[-1] * math.cos(blank.face_angle) - (z[-1] + blank.face_apex) * math.sin(blank.face_angle)
        assert_allclose(tip, 0.0, atol=ROUNDING * blank.cone_distances[2])
        edges = np.stack([np.broadcast_to(edge.value, rho.shape) for edge in gear.flank.edges(rho, z)])
        assert edges.min() > -1e-9
        root = rho[0] * math.cos(blank.root_angle) - (z[0] + blank.root_apex) * math.sin(blank.root_angle)
        assert root.min() > -1e-9  # on the root cone, or above it where the base cone is


@pytest.mark.parametrize("taper", ["standard", "uniform", "duplex", "modified"])
def test_clearance_is_the_same_along_the_face(taper):
    """Face cones run parallel to the mating gear's root cones; seen from the common apex of the axes."""
    blanks = annex_f2(**{"pair.blank.taper": taper}).blanks()
    for gear, mating in ((blanks.pinion, blanks.wheel), (blanks.wheel, blanks.pinion)):
        assert_allclose(gear.root_angle + mating.face_angle, math.radians(90.0), atol=ROUNDING)
        gap = -gear.root_apex * math.sin(gear.root_angle) - mating.face_apex * math.sin(mating.face_angle)
        assert_allclose(gap, blanks.clearance, rtol=1e-9)


@pytest.mark.parametrize("method", [spread_blade, duplex_spread_blade])
def test_face_milled_scene_of_a_blank_is_the_pair_of_its_settings(method):
    """Angles go through degrees and back: rounding times the cone distance."""
    scene = annex_f2(**{"pinion.modifications.lead_crowning_um": 5.0})
    cut = scene.face_milled(method.__name__)
    assert (cut.hands, cut.sense, cut.driving) == (scene.hands, scene.sense, scene.driving)
    assert cut.pinion.modifications.lead_crowning_um == 5.0
    by_hand = face_milled_pair(
        *method(scene.blanks(), "left"), pinion_flank=cut.contact_sides[0], exact=False, driving="pinion"
    )
    plain = cut.with_changes({"pinion.modifications.lead_crowning_um": 0.0}).pair()
    for one, other in ((plain.pinion.flank, by_hand.pinion.flank), (plain.wheel.flank, by_hand.wheel.flank)):
        rho, z = other.grid(5, 5)
        assert_allclose(rho * one.theta(rho, z).value, rho * other.theta(rho, z).value, rtol=0.0, atol=1e-9)
    path = trace_contact(cut.pair(), [0.0])
    assert path.in_contact.all()


def test_face_milled_scene_needs_a_cutter_and_a_known_method():
    with pytest.raises(InputError, match=r"pair\.blank\.cutter_radius_mm: missing; machine settings follow"):
        annex_f2(**{"pair.blank.cutter_radius_mm": None, "pair.blank.taper": "standard"}).face_milled()
    with pytest.raises(InputError, match="method: 'formate' is not one of duplex_spread_blade, spread_blade"):
        annex_f2().face_milled("formate")


def test_command_writes_the_face_milled_scene(run, tmp_path):
    (tmp_path / "blank.toml").write_text(F2, encoding="utf-8")
    code, out, _ = run("settings", tmp_path / "blank.toml", "--out", tmp_path / "cut.toml")
    assert code == 0
    assert "cut.toml" in out
    assert read_scene(tmp_path / "cut.toml") == annex_f2().face_milled()
    code, _, errors = run("settings", SCENES / "spur.toml", "--out", tmp_path / "other.toml")
    assert code == 2
    assert "pair.type: allowed straight_bevel, spiral_bevel or face_milled, with [pair.blank]" in errors[0]


def test_flanks_of_a_blank_are_conjugate():
    pair = annex_f2().pair()
    path = trace_contact(pair, np.linspace(-0.4, 0.4, 5) * pair.pitch)
    assert path.in_contact.all()
    assert_allclose(path.transmission_error, 0.0, atol=ROUNDING)


def test_whole_teeth_of_a_blank_can_be_built():
    teeth = mating_teeth(annex_f2().pair())
    assert teeth.pinion is not None
    assert teeth.wheel is not None


def test_constant_slots_of_the_duplex_taper():
    blanks = annex_f2().blanks()
    for gear in (blanks.pinion, blanks.wheel):
        assert_allclose(gear.slot_widths, gear.mean_slot_width, rtol=ROUNDING)
    assert not annex_f2(**{"pair.blank.taper": "standard"}).blanks().has_constant_slots


def test_sizes_are_the_same_by_module_and_diameter():
    sizes = {
        "pair.wheel_outer_diameter_mm": 176.893,
        "pair.outer_module_mm": 176.893 / 39,
        "pair.mean_normal_module_mm": annex_f2().blanks().mean_normal_module,
    }
    for name, value in sizes.items():
        scene = annex_f2(**(dict.fromkeys(sizes) | {name: value}))
        assert_allclose(scene.outer_module, 176.893 / 39, rtol=ROUNDING)


@pytest.mark.parametrize(
    ("kind", "formula"),
    [
        (
            "outer_transverse",
            lambda j, b: j * math.cos(b.spiral_angle_at(b.cone_distances[2])) * math.cos(b.pressure_angle),
        ),
        ("mean_normal", None),
        ("mean_transverse", None),
    ],
)
def test_backlash_of_every_kind_takes_as_much_from_both_teeth(kind, formula):
    """At mid-face j_mn is taken from normal thickness along the pitch cone, j_mt2 from the transverse one."""
    name = f"pair.blank.{kind}_backlash_mm"
    plain = annex_f2(**{"pair.blank.outer_normal_backlash_mm": None}).blanks()
    narrow = annex_f2(**{"pair.blank.outer_normal_backlash_mm": None, name: 0.2}).blanks()
    taken = [
        getattr(plain, gear).mean_normal_thickness - getattr(narrow, gear).mean_normal_thickness
        for gear in ("pinion", "wheel")
    ]
    assert_allclose(taken[0], taken[1], rtol=1e-9)
    if formula is not None:
        assert_allclose(narrow.outer_normal_backlash, formula(0.2, plain), rtol=ROUNDING)
    elif kind == "mean_normal":
        assert_allclose(sum(taken) * math.cos(plain.pressure_angle), 0.2, rtol=1e-9)
    else:
        assert_allclose(sum(taken) / math.cos(plain.spiral_angle), 0.2, rtol=1e-9)


def test_equivalent_ratio_of_other_shaft_angles_is_that_of_the_pitch_cones():
    """A miter pair is one at any shaft angle."""
    assert_allclose(usual_factors((20, 20), math.radians(60.0))["addendum_share"], 0.5, rtol=ROUNDING)


KINDS = {
    "straight_bevel": {
        "pair.spiral_angle_deg": None,
        "pair.blank.cutter_radius_mm": None,
        "pair.blank.taper": "standard",
    },
    "spiral_bevel": {},
    "face_milled": {"pair.blank.taper": "standard"},
}


def crown(kind, teeth, shaft_angle_deg, **changes):
    """Pair with a crown wheel at a shaft angle of 120 deg, where the wheel has twice the teeth of the pinion."""
    sizes = {"pair.wheel_outer_diameter_mm": 2.12 * teeth[1], "pair.shaft_angle_deg": shaft_angle_deg}
    sizes |= {
        "pinion.teeth": teeth[0],
        "wheel.teeth": teeth[1],
        "pinion.face_width_mm": 8.0,
        "wheel.face_width_mm": 8.0,
    }
    sizes |= {"pair.type": kind, "pair.blank.cutter_radius_mm": 40.0, **KINDS[kind], **changes}
    if kind == "straight_bevel":
        sizes["pinion.hand"] = None
    return annex_f2(**sizes)


@pytest.mark.parametrize("kind", KINDS)
def test_blanks_pass_the_crown_wheel_without_a_jump(kind):
    """Steps of tips and lands over 41 shaft angles halve with the step of the angle: a jump would stay what it is."""

    scene = crown(kind, (18, 36), 120.0)

    def largest_steps(width):
        rows = []
        for angle in 120.0 + width * np.linspace(-1.0, 1.0, 41):
            blanks = replace(scene, geometry=replace(scene.geometry, shaft_angle_deg=float(angle))).blanks()
            rows.append(
                np.concatenate([(*gear.tip_diameters, *gear.tip_thicknesses) for gear in (blanks.pinion, blanks.wheel)])
            )
        return np.abs(np.diff(rows, axis=0)).max(axis=0)

    wide, narrow = largest_steps(0.4), largest_steps(0.2)
    assert np.all(narrow < 0.7 * wide + 1e-9)  # mm; a curve that is straight halves them, to rounding of 60 mm
    assert wide.max() < 0.02


def test_usual_factors_of_a_crown_wheel_are_bounded():
    """c_ham ends at 0.21; k_t at the top of its parabola, by its derivative, or at the ratio of the teeth if larger."""
    for teeth in ((18, 36), (12, 40), (9, 90)):
        z1, ratios = teeth[0], np.linspace(1.0, 20.0, 1901)
        thickness = -0.088 + 0.092 * ratios - 0.004 * ratios**2 + 0.0016 * (z1 - 30) * (ratios - 1.0)
        expected = thickness[max(thickness.argmax(), round(100 * (teeth[1] / teeth[0] - 1.0)))]
        wheel_at_90 = math.acos(-teeth[0] / teeth[1])
        for beyond in (0.0, 1e-6, 0.05):
            factors = usual_factors(teeth, wheel_at_90 + beyond)
            assert_allclose([factors["addendum_share"], factors["thickness"]], [0.21, expected], atol=1e-9)


WIDE = (50, 100)
"""Teeth whose usual factors leave no slot of the pinion beside a crown wheel."""


def test_refusal_of_a_crown_wheel_names_the_thickness_factor():
    with pytest.raises(GeometryError, match=r"slot closes .*; pair\.blank\.thickness_factor: missing; .* 0\.841, "):
        crown("straight_bevel", WIDE, 120.0).blanks()


def test_factors_and_slot_widths_that_are_given_do_not_meet_the_usual_ones():
    by_factor = crown("straight_bevel", WIDE, 120.0, **{"pair.blank.thickness_factor": 0.1}).blanks()
    module, dedendum, pressure = by_factor.mean_normal_module, by_factor.dedendum_factor, by_factor.pressure_angle
    width = 2.0 * module * (0.05 + 0.25 * math.pi - dedendum * math.tan(pressure))  # of the wheel, at R_m
    by_slot = crown("straight_bevel", WIDE, 120.0, **{"pair.blank.wheel_slot_width_mm": width}).blanks()
    assert_allclose(by_slot.thickness_modification, 0.05, rtol=ROUNDING)
    assert (
        crown("straight_bevel", WIDE, 120.0, **{"pair.blank.profile_shift": 0.3}).blanks().thickness_modification == 0.0
    )


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"pair.outer_module_mm": 4.5}, "pair.outer_module_mm: given are outer_module_mm and wheel_outer_diameter_mm"),
        ({"pair.wheel_outer_diameter_mm": None}, "pair.outer_module_mm: missing; allowed one of outer_module_mm"),
        (
            {"pair.blank.profile_shift": 0.3, "pair.blank.depth_factor": 2.0},
            r"pair.blank.profile_shift: given beside depth_factor; allowed keys of data type I \(profile_shift",
        ),
        (
            {"pair.blank.thickness_factor": 0.1, "pair.blank.wheel_slot_width_mm": 2.0},
            "given are thickness_factor and wheel_slot_width_mm; allowed one of",
        ),
        (
            {"pair.blank.mean_normal_backlash_mm": 0.1},
            "given are outer_normal_backlash_mm and mean_normal_backlash_mm",
        ),
        ({"pair.blank.cutter_radius_mm": None}, 'pair.blank.cutter_radius_mm: missing; taper = "duplex" follows'),
        ({"pair.blank.wheel_addendum_angle_deg": 2.0}, "both cones of the wheel, or neither"),
        ({"pinion.profile_shift": 0.2}, r"pinion.profile_shift: found 0.2; not allowed with \[pair.blank\]"),
        (
            {"wheel.face_angle_deg": 71.0},
            r"wheel.face_angle_deg: found 71; with \[pair.blank\] allowed with wheel.face_apex",
        ),
        ({"pinion.face_apex_mm": 1.0}, "pinion.face_apex_mm: found 1; allowed with face_angle_deg"),
        ({"pair.blank.cutter_radius_mm": 30.0}, "pair.blank: cutter_radius_mm: 30.0 mm; a duplex taper needs at least"),
        (
            {"pair.blank.profile_shift": 0.5, "pair.blank.dedendum_factor": 0.9},
            "pair.blank: dedendum_factor: 0.9 is not above addendum_factor",
        ),
        (
            {"pair.blank.taper": "standard", "pinion.teeth": 39, "wheel.teeth": 15},
            # 0.21 + 0.29 (39/15)^2, at 90 deg
            r"pair.blank: mean_addendum_factor: missing; .* is 2.17 for a pinion of 39 teeth",
        ),
    ],
)
def test_what_does_not_fit_is_refused_by_its_key(changes, told):
    with pytest.raises(InputError, match=told):
        annex_f2(**changes).mesh()


def test_pinion_larger_than_the_wheel_is_taken_with_a_mean_addendum_factor():
    changes = {"pair.blank.taper": "standard", "pinion.teeth": 39, "wheel.teeth": 15}
    blanks = annex_f2(**changes, **{"pair.blank.mean_addendum_factor": 0.5}).blanks()
    assert blanks.profile_shift == 0.0  # half of the working depth to either gear


def test_teeth_that_cannot_exist_are_refused():
    with pytest.raises(GeometryError, match="undercut"):
        annex_f2(**{"pair.blank.profile_shift": -0.5}).mesh()


def test_scene_without_blank_says_how_deep_its_teeth_are():
    """By outer modules: 1/cos 35 as deep as the standard's, nearly (cones through the apex at R_m)."""
    plain = annex_f2(**{"pair.blank": None})
    depth, standard = row(plain, "working depth at mid-face h_mw; after ISO 23509 [mm]")
    assert_allclose(depth / standard, 1.0 / math.cos(math.radians(35.0)), rtol=1e-3)


def test_cones_of_a_drawing_without_their_apexes_leave_no_clearance_and_are_warned_of():
    """The angles of a sheet double as depths about one apex; the clearances are told."""
    blanks = annex_f2(**{"pair.blank.taper": "standard"}).blanks()
    angles = {
        f"{name}.{cone}_angle_deg": math.degrees(getattr(getattr(blanks, name), f"{cone}_angle"))
        for name in ("pinion", "wheel")
        for cone in ("face", "root")
    }
    changes = {"pair.blank": None, "pair.type": "straight_bevel", "pair.spiral_angle_deg": None} | angles
    straight = annex_f2(**changes)
    assert_allclose(straight.tip_clearances, 0.0, atol=1e-9)
    apexes = {
        key.replace("angle_deg", "apex_mm"): getattr(
            getattr(blanks, key.split(".")[0]), key.split(".")[1][:4] + "_apex"
        )
        for key in angles
    }
    assert_allclose(annex_f2(**(changes | apexes)).tip_clearances, blanks.clearance, rtol=2e-2)  # on the sphere


MEASURED = {
    "pinion.mean_addendum_mm": 4.836,
    "pinion.mean_dedendum_mm": 2.394,
    "pinion.mean_normal_thickness_mm": 6.465,
    "wheel.mean_addendum_mm": 1.591,
    "wheel.mean_dedendum_mm": 5.639,
    "wheel.mean_normal_thickness_mm": 3.511,
    "pair.blank.outer_normal_backlash_mm": None,
}
"""Means that annex F.2 prints."""


def test_measured_means_of_annex_f2_give_the_rest_of_its_sheet():
    """Rounded to 0.0005 mm, of which the backlash takes three."""
    scene = annex_f2(**MEASURED)
    assert row(scene, "backlash j_en, j_et2 at the heel [mm]")[0] == pytest.approx(0.127, abs=2e-3)
    assert_allclose(row(scene, "addendum h_a, heel [mm]"), (6.281, 2.064), atol=1.5e-3)
    assert_allclose(row(scene, "mean normal thickness s_mn [mm]"), (6.465, 3.511), atol=1e-4)
    assert_allclose(row(scene, "contact ratios eps_va, eps_vb by 0.85 b"), (1.165, 1.227), atol=1e-3)
    cells = {name: cells for name, *cells in scene.geometry_rows()}
    assert cells["blank after ISO 23509: data type, taper"] == ["measured", "duplex"]
    assert cells["slots along the face"] == ["constant"]


@pytest.mark.parametrize("taper", ["standard", "uniform", "duplex", "modified"])
def test_means_of_a_blank_give_the_same_blank(taper):
    blanks = annex_f2(**{"pair.blank.taper": taper}).blanks()
    changes = {"pair.blank.taper": taper, "pair.blank.outer_normal_backlash_mm": None}
    for name in ("pinion", "wheel"):
        gear = getattr(blanks, name)
        changes |= {f"{name}.{key}_mm": getattr(gear, key) for key in ("mean_addendum", "mean_dedendum")}
        changes[f"{name}.mean_normal_thickness_mm"] = gear.mean_normal_thickness
    again = annex_f2(**changes).blanks()
    for name in ("pinion", "wheel"):
        for key in ("addenda", "dedenda", "normal_thicknesses", "face_apex", "root_angle", "slot_widths"):
            assert_allclose(getattr(getattr(again, name), key), getattr(getattr(blanks, name), key), rtol=1e-9)


def test_cones_of_a_drawing_are_those_of_the_blank():
    """Given with their apexes they are the ones that the taper has; depths at R_m to c (1 - cos theta)."""
    plain = annex_f2()
    changes = {}
    for name in ("pinion", "wheel"):
        gear = getattr(plain.blanks(), name)
        for cone in ("face", "root"):
            changes[f"{name}.{cone}_angle_deg"] = math.degrees(getattr(gear, f"{cone}_angle"))
            changes[f"{name}.{cone}_apex_mm"] = getattr(gear, f"{cone}_apex")
    drawn = annex_f2(**changes)
    for first, second in ((drawn.pair().pinion, plain.pair().pinion), (drawn.pair().wheel, plain.pair().wheel)):
        for one, other in zip(first.flank.grid(5, 5), second.flank.grid(5, 5), strict=True):
            assert_allclose(one, other, rtol=ROUNDING)
    assert_allclose(row(drawn, "addendum h_a, mean point [mm]"), row(plain, "addendum h_a, mean point [mm]"), atol=6e-3)


def test_cone_of_another_pair_leaves_no_clearance_and_is_refused():
    """The face cone of a drawing with its apex 1.9 mm too far from the teeth: tips stand 1.9 sin(delta_a) higher."""
    angle = math.degrees(annex_f2().blanks().pinion.face_angle)
    with pytest.raises(GeometryError, match=r"wheel: the clearance above its root is -0\.\d+ mm at the toe"):
        annex_f2(**{"pinion.face_angle_deg": angle, "pinion.face_apex_mm": -8.05}).pair()


UNEQUAL = {"pinion.face_width_mm": 27.4, "wheel.face_width_mm": 25.4, "pair.blank.outer_face_share": 0.45}


def test_unequal_faces_meet_at_one_calculation_point():
    """R_m = R_e2 - c_be2 b2; each gear ends c_be2 b beyond it."""
    scene = annex_f2(**UNEQUAL)
    blanks, mesh = scene.blanks(), scene.mesh()
    outer = 0.5 * 176.893 / math.sin(blanks.pitch_angles[1])
    mean = outer - 0.45 * 25.4
    assert_allclose(blanks.wheel.cone_distances, (outer - 25.4, mean, outer), rtol=ROUNDING)
    assert_allclose(blanks.pinion.cone_distances, (mean - 0.55 * 27.4, mean, mean + 0.45 * 27.4), rtol=ROUNDING)
    assert_allclose(mesh.pinion.mean_normal_module, blanks.mean_normal_module, rtol=ROUNDING)
    assert_allclose(mesh.wheel.mean_normal_module, 3.9227 / 81.273 * mean * math.cos(math.radians(35.0)), rtol=1e-4)
    for gear, blank in ((mesh.pinion, blanks.pinion), (mesh.wheel, blanks.wheel)):
        assert_allclose((gear.inner_cone_distance, gear.outer_cone_distance), blank.cone_distances[::2], rtol=ROUNDING)


def test_flanks_of_unequal_faces_are_conjugate_and_touch_at_the_calculation_point():
    pair = annex_f2(**UNEQUAL).pair()
    path = trace_contact(pair, np.linspace(-0.4, 0.4, 5) * pair.pitch)
    assert path.in_contact.all()
    assert_allclose(path.transmission_error, 0.0, atol=ROUNDING)
    crowned = annex_f2(**UNEQUAL, **{"wheel.modifications.lead_crowning_um": 20.0}).pair()
    middle = trace_contact(crowned, [0.0])
    distance = np.hypot(middle.wheel_radius, middle.wheel_axial)
    assert_allclose(distance, 0.5 * sum(crowned.wheel.flank.frame.mean_cone_distance for _ in range(2)), atol=0.5)
    assert_allclose(pair.face_width, 25.4)
    assert mating_teeth(pair).pinion is not None


def test_equal_faces_about_their_middles_are_as_before():
    """The calculation point in the middle of faces of one width changes no number."""
    plain, told = annex_f2(), annex_f2(**{"pair.blank.outer_face_share": 0.5})
    assert told.mesh() == plain.mesh()
    assert told.mesh().pinion.calculation_distance is None


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"pinion.mean_addendum_mm": 4.8}, "need mean_addendum_mm and mean_dedendum_mm of both gears"),
        (
            MEASURED | {"pair.blank.profile_shift": 0.5},
            "pinion.mean_addendum_mm: measured depths beside pair.blank.profile_shift, of data type I; give one",
        ),
        (
            MEASURED | {"pair.blank.depth_factor": 2.0},
            "pinion.mean_addendum_mm: measured depths beside pair.blank.depth_factor, of data type II; give one",
        ),
        (
            MEASURED | {"pair.blank.mean_normal_backlash_mm": 0.1},
            "measured thicknesses beside pair.blank.mean_normal_backlash_mm, which follows from them",
        ),
        (
            MEASURED | {"wheel.mean_normal_thickness_mm": None},
            "measured thicknesses need both gears",
        ),
        (
            MEASURED | {"pair.blank": None},
            r"pinion.mean_addendum_mm: found 4.836; allowed with a section \[pair.blank\]",
        ),
        ({"pair.blank.clearance_factor": 0.0}, "pair.blank.clearance_factor: found 0.0; allowed a number above 0"),
    ],
)
def test_measured_means_that_do_not_fit_are_refused_by_their_keys(changes, told):
    with pytest.raises(InputError, match=told):
        annex_f2(**changes)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"pinion.mean_dedendum_mm": 1.5}, "pair.blank: mean_dedendum_mm: no clearance is left, h_fm1 - h_am2 = -0.09"),
        ({"pinion.mean_dedendum_mm": 2.6}, "pair.blank: mean_dedendum_mm: the clearances h_fm1 - h_am2 = 1.009 mm and"),
        (
            {"pinion.mean_normal_thickness_mm": 7.0},
            "pair.blank: mean_normal_thickness_mm: 7 and 3.511 mm together are more than the mean normal pitch, 10.09",
        ),
    ],
)
def test_measured_teeth_that_overlap_are_refused(changes, told):
    with pytest.raises(InputError, match=told):
        annex_f2(**(MEASURED | changes)).mesh()


def test_undercut_is_taken_where_it_is_allowed():
    shift = {"pair.blank.profile_shift": -0.5}
    with pytest.raises(GeometryError, match=r"pinion: undercut with a profile shift x_hm of -0\.5"):
        annex_f2(**shift).mesh()
    assert annex_f2(**shift, **{"pair.blank.allow_undercut": True}).blanks().pinion.is_undercut


def test_largest_edge_radii_are_those_of_slot_and_clearance():
    """By construction: a circle that touches the flank at alpha_n and the bottom of the slot."""
    gear = annex_f2().blanks().pinion
    radius, alpha = gear.edge_radius_of_slot, math.radians(20.0)
    # from the corner of bottom and flank to the foot of the circle: r (1 - sin alpha)/cos alpha
    assert_allclose(2.0 * radius * (1.0 - math.sin(alpha)) / math.cos(alpha), gear.slot_widths.min(), rtol=ROUNDING)
    assert_allclose(gear.edge_radius_of_clearance(0.8) * (1.0 - math.sin(alpha)), 0.8, rtol=ROUNDING)


def test_radius_of_relative_curvature_of_annex_f2_is_that_of_iso_tr_10300_30():
    """rho_rel 12.459 mm at the mean point, normal to the contact line; a trace of crowning holds the contact there."""
    pair = annex_f2(**{"pinion.modifications.lead_crowning_um": 0.01}).pair()
    curvature = relative_curvature(pair, trace_contact(pair, [0.0])[0])
    assert_allclose(1.0 / curvature.across, 12.459, atol=1e-3)


def test_flanks_along_the_circle_of_the_cutter_are_conjugate_and_have_its_spiral_angles():
    """beta_e 36.846 and beta_i 33.946 deg of annex F.2, on the flanks; its eps_vb of the whole face 1.443."""
    scene = annex_f2(**{"pair.blank.lengthwise_curve": "cutter_circle"})
    pair = scene.pair()
    path = trace_contact(pair, np.linspace(-0.4, 0.4, 5) * pair.pitch)
    assert_allclose(path.transmission_error, 0.0, atol=ROUNDING)
    for gear, delta in ((pair.pinion, 19.7468), (pair.wheel, 70.2532)):
        sine, cosine = math.sin(math.radians(delta)), math.cos(math.radians(delta))
        for distance, printed in ((93.9726, 36.846), (81.273, 35.0), (68.5726, 33.946)):
            rho, z = np.array(distance * sine), np.array(distance * cosine)
            theta = gear.nominal_flank.theta(rho, z)
            along = float(rho * (theta.rho * sine + theta.z * cosine))
            assert_allclose(abs(math.degrees(math.atan(along))), printed, atol=1e-3)
    assert row(scene, "overlap ratio eps_beta")[0] == pytest.approx(1.443, abs=0.03)  # the standard's of R_m alone
    assert mating_teeth(pair).pinion is not None


def test_circle_of_a_large_cutter_is_no_logarithmic_spiral():
    told = {name: cells for name, *cells in annex_f2().geometry_rows()}["flanks along the face"]
    assert told == ["logarithmic"]
    with pytest.raises(InputError, match=r'pair\.blank\.lengthwise_curve: found "cutter_circle"; allowed with cutter'):
        annex_f2(
            **{
                "pair.blank.lengthwise_curve": "cutter_circle",
                "pair.blank.cutter_radius_mm": None,
                "pair.blank.taper": "standard",
            }
        )


def test_straight_teeth_run_along_no_circle():
    straight = {"pair.type": "straight_bevel", "pair.spiral_angle_deg": None, "pair.blank.taper": "standard"}
    assert {name: cells for name, *cells in annex_f2(**straight).geometry_rows()}["flanks along the face"] == [
        "straight"
    ]
    with pytest.raises(InputError, match=r"pair\.blank\.lengthwise_curve: .* a spiral_angle_deg above 0 alone"):
        annex_f2(**straight, **{"pair.blank.lengthwise_curve": "cutter_circle"})


def test_standard_of_the_geometry_is_told_where_it_is_that_of_the_blanks():
    assert annex_f2().geometry_standard == "ISO 23509"
    assert annex_f2(**{"pair.blank": None}).geometry_standard == "depths by outer modules, about one apex"
