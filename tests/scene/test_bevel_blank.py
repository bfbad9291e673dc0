"""Blanks of ISO 23509 in scenes; the numbers of annex F.2 are the printed ones."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears.basic_settings import duplex_spread_blade, spread_blade
from loaded_tca.gears.bevel_blank import usual_factors
from loaded_tca.pairs import mating_teeth
from loaded_tca.pairs.bevel import face_milled_pair
from loaded_tca.scene import parse_scene, read_scene
from loaded_tca.unloaded import trace_contact
from tests.samples.results import SCENES

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
        ("addendum h_a, mid-face [mm]", (4.836, 1.591)),
        ("addendum h_a, heel [mm]", (6.281, 2.064)),
        ("dedendum h_f, mid-face [mm]", (2.394, 5.639)),
        ("working, whole depth h_mw, h_m; clearance c [mm]", (6.427, 7.230, 0.803)),
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
        assert_allclose(tip, 0.0, atol=1e-12 * blank.cone_distances[2])
        edges = np.stack([np.broadcast_to(edge.value, rho.shape) for edge in gear.flank.edges(rho, z)])
        assert edges.min() > -1e-9
        root = rho[0] * math.cos(blank.root_angle) - (z[0] + blank.root_apex) * math.sin(blank.root_angle)
        assert root.min() > -1e-9  # on the root cone, or above it where the base cone is


@pytest.mark.parametrize("taper", ["standard", "uniform", "duplex", "modified"])
def test_clearance_is_the_same_along_the_face(taper):
    """Face cones run parallel to the mating gear's root cones; seen from the common apex of the axes."""
    blanks = annex_f2(**{"pair.blank.taper": taper}).blanks()
    for gear, mating in ((blanks.pinion, blanks.wheel), (blanks.wheel, blanks.pinion)):
        assert_allclose(gear.root_angle + mating.face_angle, math.radians(90.0), atol=1e-12)
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
    assert_allclose(path.transmission_error, 0.0, atol=1e-12)


def test_whole_teeth_of_a_blank_can_be_built():
    teeth = mating_teeth(annex_f2().pair())
    assert teeth.pinion is not None
    assert teeth.wheel is not None


def test_constant_slots_of_the_duplex_taper():
    blanks = annex_f2().blanks()
    for gear in (blanks.pinion, blanks.wheel):
        assert_allclose(gear.slot_widths, gear.mean_slot_width, rtol=1e-12)
    assert not annex_f2(**{"pair.blank.taper": "standard"}).blanks().has_constant_slots


def test_sizes_are_the_same_by_module_and_diameter():
    sizes = {
        "pair.wheel_outer_diameter_mm": 176.893,
        "pair.outer_module_mm": 176.893 / 39,
        "pair.mean_normal_module_mm": annex_f2().blanks().mean_normal_module,
    }
    for name, value in sizes.items():
        scene = annex_f2(**(dict.fromkeys(sizes) | {name: value}))
        assert_allclose(scene.outer_module, 176.893 / 39, rtol=1e-12)


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
        assert_allclose(narrow.outer_normal_backlash, formula(0.2, plain), rtol=1e-12)
    elif kind == "mean_normal":
        assert_allclose(sum(taken) * math.cos(plain.pressure_angle), 0.2, rtol=1e-9)
    else:
        assert_allclose(sum(taken) / math.cos(plain.spiral_angle), 0.2, rtol=1e-9)


def test_equivalent_ratio_of_other_shaft_angles_is_that_of_the_pitch_cones():
    """A miter pair is one at any shaft angle."""
    assert_allclose(usual_factors((20, 20), math.radians(60.0))["addendum_share"], 0.5, rtol=1e-12)


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
        ({"wheel.face_angle_deg": 71.0}, r"wheel.face_angle_deg: found 71; not allowed with \[pair.blank\]"),
        ({"pinion.face_apex_mm": 1.0}, "pinion.face_apex_mm: found 1; allowed with face_angle_deg"),
        ({"pair.blank.cutter_radius_mm": 30.0}, "pair.blank: cutter_radius: 30.0 mm; a duplex taper needs at least"),
        (
            {"pair.blank.profile_shift": 0.5, "pair.blank.dedendum_factor": 0.9},
            "pair.blank: dedendum_factor: 0.9 is below addendum_factor",
        ),
    ],
)
def test_what_does_not_fit_is_refused_by_its_key(changes, told):
    with pytest.raises(InputError, match=told):
        annex_f2(**changes).mesh()


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
