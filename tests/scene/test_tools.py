"""Tools of each gear in scenes: racks of their own, tips, and keys as other programs spell them."""

from math import cos, pi, radians, sin, tan

import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, InputError, parse_scene, read_scene
from loaded_tca.reference.iso6336_3 import fillet_section, root_section
from loaded_tca.results.gear_warnings import warn_of_gears
from tests.refusals import refused_calls
from tests.samples.internal_pairs import SCENE
from tests.samples.results import SCENES

ROUNDING = 1e-12  # of a form factor that is iterated to rounding, and some dozen products
ANGLE = radians(20.0)


def scene(**changes):
    return read_scene(SCENES / "helical.toml").with_changes(
        {key.replace("__", "."): value for key, value in changes.items()}
    )


def internal(**changes):
    return parse_scene(SCENE).with_changes({key.replace("__", "."): value for key, value in changes.items()})


def test_tool_of_a_gear_comes_before_that_of_the_pair():
    own = scene(
        pinion__dedendum_coefficient=1.4, pinion__root_radius_coefficient=0.25, pinion__addendum_coefficient=1.1
    )
    pinion, wheel = own.mesh().pinion, own.mesh().wheel
    assert (pinion.dedendum_coefficient, pinion.root_radius_coefficient, pinion.addendum_coefficient) == (
        1.4,
        0.25,
        1.1,
    )
    assert wheel == scene().mesh().wheel
    rows = {name: cells for name, *cells in own.geometry_rows()}
    assert rows["basic rack: h_aP/h_fP/rho_fP [m_n]"] == ["1.1/1.4/0.25", "1/1.25/0.38"]
    assert not any(name.startswith("basic rack") for name, *_ in scene().geometry_rows())
    assert parse_scene(own.to_toml()) == own


def test_root_diameter_of_a_drawing_sets_the_dedendum():
    """The root that a rack with h_fP = 1.4 leaves, d - 2 m_n (1.4 - x), with the thickness by its span or as it is."""
    deeper = scene(pinion__dedendum_coefficient=1.4)
    pinion = deeper.mesh().pinion
    diameter = 2.0 * pinion.reference_radius - 2.0 * pinion.normal_module * (1.4 - pinion.profile_shift)
    by_root = scene(pinion__root_diameter_mm=diameter)
    assert_allclose(by_root.mesh().pinion.dedendum_coefficient, 1.4, rtol=ROUNDING)
    assert_allclose(by_root.mesh().pinion.form_radius, pinion.form_radius, rtol=ROUNDING)
    assert parse_scene(by_root.to_toml()) == by_root
    span = pinion.span_measurement(pinion.span_teeth) - 0.05
    measured = by_root.with_changes({"pinion.span_measurement_mm": span, "pinion.span_teeth": pinion.span_teeth})
    assert_allclose(2.0 * measured.mesh().pinion.root_radius, diameter, rtol=ROUNDING)
    assert measured.mesh().pinion.generating_profile_shift < pinion.profile_shift - 0.01


def test_root_diameter_of_thin_teeth_that_are_measured_is_that_of_the_measured_gear():
    """A rack with h_fP = 2 at x_E = x - 0.6/(2 m_n tan(alpha_n)): full thickness would need 2.27, beyond 2.16."""
    allowance, dedendum = -600.0, 2.0
    thin = scene(pinion__dedendum_coefficient=dedendum, pinion__thickness_allowance_um=allowance).mesh().pinion
    shift = thin.profile_shift + 1e-3 * allowance / (2.0 * thin.normal_module * tan(thin.pressure_angle))
    root = 2.0 * (thin.reference_radius - thin.normal_module * (dedendum - shift))
    measures = {
        "span_measurement_mm": thin.span_measurement(5),
        "normal_tooth_thickness_mm": thin.normal_tooth_thickness,
    }
    for key, measure in measures.items():
        pinion = scene(pinion__root_diameter_mm=root, **{f"pinion__{key}": measure}).mesh().pinion
        assert_allclose(pinion.dedendum_coefficient, dedendum, rtol=1e-9)  # a measure that is inverted
        assert_allclose(2.0 * pinion.root_radius, root, rtol=ROUNDING)
    with pytest.raises(InputError, match=r"root_diameter_mm: .* asks for dedendum_coefficient = 2\.2, which"):
        scene(pinion__root_diameter_mm=root - 0.4 * thin.normal_module, **{f"pinion__{key}": measure}).mesh()


def test_tool_of_the_pair_given_for_each_gear_is_the_same_pair():
    """To the bit, with the stiffness of ISO 6336-1, which takes the mean of both racks."""
    each = {f"{gear}__dedendum_coefficient": 1.3 for gear in ("pinion", "wheel")}
    apart, common = scene(**each), scene(pair__dedendum_coefficient=1.3)
    assert apart.mesh() == common.mesh()
    stiffness = [one.contact_standard.single_stiffness for one in (apart, common)]
    assert stiffness[0] == stiffness[1]
    one = scene(wheel__dedendum_coefficient=1.3).contact_standard.single_stiffness
    assert_allclose(one, 0.5 * (stiffness[0] + scene().contact_standard.single_stiffness), rtol=1e-9)


def test_full_root_radius_is_the_largest_that_fits():
    rows = {name: cells for name, *cells in scene(pair__root_radius_coefficient="full").geometry_rows()}
    assert rows["basic rack: h_aP/h_fP/rho_fP [m_n]"][0] == "1/1.25/full"
    assert internal(wheel__root_radius_coefficient="full").mesh().ring.root_radius_coefficient == float("inf")


def test_root_radius_that_does_not_fit_is_shown_as_the_largest_that_does():
    """(pi/4 - h_fP tan(alpha)) cos(alpha)/(1 - sin(alpha)) of a rack, by hand; of a cutter what the ring has."""
    asked = scene(pinion__root_radius_coefficient=0.9, wheel__root_radius_coefficient=0.3)
    rows = {name: cells for name, *cells in asked.geometry_rows()}
    fits = (pi / 4.0 - 1.25 * tan(ANGLE)) * cos(ANGLE) / (1.0 - sin(ANGLE))
    assert rows["basic rack: h_aP/h_fP/rho_fP [m_n]"] == [f"1/1.25/{fits:.4f} (full)", "1/1.25/0.3"]
    ring = internal(wheel__cutter={"teeth": 25, "tip_radius_coefficient": 0.9})
    (cell,) = (cells[1] for name, *cells in ring.geometry_rows() if name.startswith("basic rack"))
    assert cell.endswith(" (full)")
    assert float(cell.split("/")[-1].removesuffix(" (full)")) < 0.9


def test_computed_tip_shortening_keeps_the_clearance():
    shifts = {"pinion__profile_shift": 0.4, "wheel__profile_shift": 0.5}
    mesh = scene(pair__tip_shortening="computed", **shifts).mesh()
    assert_allclose(mesh.tip_clearances, 0.75, rtol=1e-9)
    by_distance = scene(
        pair__tip_shortening="computed",
        pinion__profile_shift=0.4,
        pair__centre_distance_mm=mesh.working_centre_distance,
    )
    assert_allclose(by_distance.mesh().tip_clearances, 0.75, rtol=1e-8)
    assert scene(pair__tip_shortening="none", **shifts).mesh() == scene(**shifts).mesh()
    ring = internal(wheel__tip_diameter_mm=None)
    assert ring.with_changes({"pair.tip_shortening": "computed"}).mesh() == ring.mesh()


def test_topping_follows_the_allowance():
    mesh = scene(pinion__topping=True, pinion__thickness_allowance_um=-60.0).mesh()
    assert_allclose(scene().mesh().pinion.tip_radius - mesh.pinion.tip_radius, 0.03 / 0.36397023, rtol=1e-7)


def test_protuberance_and_stock_shape_the_root_of_a_scene():
    own = scene(pinion__protuberance_um=120.0, pinion__grinding_stock_um=80.0, pinion__protuberance_angle_deg=8.0)
    gear = own.mesh().pinion
    assert_allclose([gear.protuberance, gear.grinding_stock], [0.12, 0.08])
    rows = {name: cells for name, *cells in own.geometry_rows()}
    assert rows["protuberance pr/stock q/undercut s_pr [um]"] == ["120/80/40", "-"]
    assert own.grinding_notches[0][0] == 0.0
    assert own.root_factors[0][0] > scene().root_factors[0][0]  # the root is thinner by the undercut
    assert parse_scene(own.to_toml()) == own


def test_form_factor_of_an_undercut_is_that_of_a_rack_so_much_wider():
    """E of ISO 6336-3 grows with s_pr/cos(alpha_n) as with the width that a smaller dedendum leaves."""
    wide = root_section(34, 0.0, 36.0, 1.6, residual_undercut=0.02, dedendum_coefficient=1.25)
    gap = 0.25 * pi - 1.25 * tan(ANGLE) - (0.38 * (1.0 - sin(ANGLE)) - 0.02) / cos(ANGLE)
    assert_allclose(wide.thickness, fillet_section(gap, 0.38 - 1.25, 0.38, 34)[1], rtol=ROUNDING)


def test_notch_of_grinding_is_warned_of():
    own = scene(wheel__protuberance_um=20.0, wheel__grinding_stock_um=60.0, analysis__compliance="contact")
    with pytest.warns(AccuracyWarning, match=r"wheel: the stock for grinding is 40 um larger") as caught:
        warn_of_gears(own, own.pair())
    assert len(caught) == 1


def test_chamfer_ends_flank_and_active_profile():
    own = scene(pinion__tip_chamfer_mm=0.3, pinion__tip_chamfer_angle_deg=40.0)
    mesh = own.mesh()
    end = scene().mesh().pinion.tip_radius - 0.3
    highest = own.pair().pinion.flank.grid(3, 3)[0].max()
    assert_allclose([mesh.pinion_active_profile.end_radius, highest], end, rtol=1e-9)
    rows = {name: cells for name, *cells in own.geometry_rows()}
    assert rows["tip form diameter d_Fa [mm]"][0] == f"{2.0 * end:.4f}"
    assert rows["tip land between chamfers [mm]"][1] == "-"
    assert parse_scene(own.to_toml()) == own


@pytest.mark.parametrize(
    ("path", "meant"),
    [
        ("pair.haP*", "pair.addendum_coefficient"),
        ("pinion.hfP*", "pinion.dedendum_coefficient"),
        ("wheel.rhofP*", "wheel.root_radius_coefficient"),
        ("pair.x1", "pinion.profile_shift"),
        ("pinion.x", "pinion.profile_shift"),
        ("pinion.z", "pinion.teeth"),
        ("pair.alfn", "pair.pressure_angle_deg"),
        ("wheel.MdK", "wheel.ball_measurement_mm"),
        ("wheel.MdR", "wheel.pin_measurement_mm"),
        ("pinion.tooth_thickness_in", "pinion.normal_tooth_thickness_in"),
        ("wheel.MOP_in", "wheel.pin_measurement_in"),
        ("wheel.MOP_mm", "wheel.pin_measurement_mm"),
        ("wheel.measurement_over_pins_in", "wheel.pin_measurement_in"),
        ("wheel.measurement_over_balls", "wheel.ball_measurement_mm"),
        ("pinion.tip_shortening", "pair.tip_shortening"),
    ],
)
def test_spellings_of_other_programs_are_answered_with_the_key_that_is_meant(path, meant):
    with pytest.raises(InputError, match=f'unknown key; did you mean "{meant}"'):
        scene().with_changes({path: 1.0})


def test_bevel_gears_have_their_own_name_for_an_addendum():
    with pytest.raises(InputError, match=r'unknown key; did you mean "pair\.blank.addendum_factor"'):
        read_scene(SCENES / "spiral_bevel_blank.toml").with_changes({"pair.addendum_coefficient": 1.0})


test_tools_refuse = refused_calls(
    (
        lambda: scene(pinion__protuberance_um=100.0),
        "^pinion.protuberance_um: found 100 without grinding_stock_um; give the stock",
    ),
    (
        lambda: scene(pinion__protuberance_angle_deg=10.0),
        "^pinion.protuberance_angle_deg: found 10; it needs protuberance_um above 0",
    ),
    (
        lambda: scene(pinion__protuberance_um=100.0, pinion__grinding_stock_um=900.0).mesh(),
        "^pinion: grinding_stock_um: 0.9 mm is not from 0 to a quarter of a module",
    ),
    (
        lambda: scene(pinion__tip_chamfer_mm=0.3, pinion__tip_rounding_mm=0.2),
        "^pinion.tip_chamfer_mm: found 0.3 beside tip_rounding_mm = 0.2; give one of them",
    ),
    (
        lambda: scene(pinion__tip_chamfer_angle_deg=40.0),
        "^pinion.tip_chamfer_angle_deg: found 40; it needs tip_chamfer_mm above 0",
    ),
    (
        lambda: internal(wheel__protuberance_um=100.0),
        "^wheel.protuberance_um: unknown key",
    ),
    (
        lambda: scene(pinion__tip_diameter_mm=110.0, pinion__addendum_coefficient=1.1),
        "^pinion.tip_diameter_mm: found 110 beside addendum_coefficient = 1.1; give one of them",
    ),
    (
        lambda: scene(pinion__tip_diameter_mm=110.0, pinion__topping=True),
        "^pinion.tip_diameter_mm: found 110 beside topping = true; give one of them",
    ),
    (
        lambda: scene(wheel__tip_alteration_coefficient=-0.1, wheel__topping=True),
        "^wheel.topping: found true beside tip_alteration_coefficient = -0.1",
    ),
    (
        lambda: scene(pair__tip_shortening="computed", pinion__tip_alteration_coefficient=-0.1),
        '^pair.tip_shortening: found "computed" beside pinion.tip_alteration_coefficient = -0.1',
    ),
    (
        lambda: internal(pair__tip_shortening="computed"),
        '^pair.tip_shortening: found "computed" beside wheel.tip_diameter_mm = 181.5',
    ),
    (
        lambda: internal(wheel__root_diameter_mm=195.0, wheel__dedendum_coefficient=1.3),
        "^wheel.dedendum_coefficient: found 1.3 beside root_diameter_mm = 195; give one of them",
    ),
    (
        lambda: scene(pinion__root_diameter_mm=60.0, pinion__dedendum_coefficient=1.3),
        "^pinion.dedendum_coefficient: found 1.3 beside root_diameter_mm = 60; give one of them",
    ),
    (
        lambda: scene(pinion__root_diameter_mm=80.0, pinion__tip_diameter_mm=79.0),
        "^pinion.root_diameter_mm: found 80; allowed up to tip_diameter_mm = 79",
    ),
    (
        lambda: internal(wheel__cutter={"teeth": 25}, wheel__root_radius_coefficient=0.3),
        r"^wheel.root_radius_coefficient: found 0.3 beside \[wheel.cutter\]",
    ),
    (
        lambda: scene(pinion__root_radius_coefficient="round"),
        '^pinion.root_radius_coefficient: found "round"; allowed "full"',
    ),
)
