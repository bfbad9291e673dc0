"""Local synthesis: what is asked of the mean point is what unloaded contact analysis of the flanks measures there."""

from dataclasses import replace
from math import cos, degrees, pi, radians

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears import BevelBlank, duplex_spread_blade
from loaded_tca.gears.blank_factors import crown_gear_factors, usual_factors
from loaded_tca.pairs import MeanContact, face_milled_pair, local_synthesis, mean_contact
from loaded_tca.pairs.mean_point import MARKING, mean_point
from loaded_tca.pairs.synthesis import with_tooth_angle
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.curvature import relative_curvature
from tests.samples.face_milled import matched_pinion, published_wheel

ARCSEC = radians(1.0 / 3600.0)
STEP = 0.02
"""Parts of a pitch between the angles whose differences measure the motion curve: its fourth derivative leaves 1e-4."""


def start(teeth=(14, 39), taper="duplex", hand="left", shaft_angle=90.0, edge_radius=0.0, cutter=114.3):
    """Basic settings of a pair of module 4.5."""
    factors = crown_gear_factors(**usual_factors(teeth, radians(shaft_angle)))
    blank = BevelBlank(
        teeth,
        4.5,
        25.0,
        shaft_angle=radians(shaft_angle),
        spiral_angle=radians(35),
        cutter_radius=cutter,
        taper=taper,
        **factors,
    )
    return duplex_spread_blade(blank, hand, edge_radius=edge_radius)


def asked(fall=10.0, path=120.0, length=10.0):
    return MeanContact(fall * ARCSEC, radians(path), length)


def place(pair, rho, z):
    """Point of the pinion's flank in the frame of the pinion."""
    theta = float(pair.pinion.flank.theta(np.array(rho), np.array(z)).value)
    return np.array([rho * np.cos(theta), rho * np.sin(theta), z])


def measured(pinion, wheel, flank):
    """Fall, path angle and length of the ellipse as the contact of the whole flanks has them."""
    pair = face_milled_pair(pinion, wheel, pinion_flank=flank, exact=True)
    step = STEP * pair.pitch
    path = trace_contact(pair, np.array([-step, 0.0, step]), warn=False)
    error = path.transmission_error
    second = (error[0] + error[2] - 2.0 * error[1]) / step**2
    # along the flank of the pinion: the path seen from the pinion, which turns on
    first, last = (place(pair, path.pinion_radius[i], path.pinion_axial[i]) for i in (0, 2))
    (rho, z), chord = mean_point(pinion), 1e-4
    toe, heel = (place(pair, rho * part, z * part) for part in (1.0 - chord, 1.0 + chord))
    direction, trace = (end / np.linalg.norm(end) for end in (last - first, heel - toe))
    upwards = direction[0] * cos(pinion.blank.pitch_angle) > direction[2] * np.sin(pinion.blank.pitch_angle)
    angle = np.arccos(direction @ trace) if upwards else pi - np.arccos(direction @ trace)
    curvature = relative_curvature(pair, path[1]).along
    return -second * pair.pitch**2 / 8.0, angle, np.sqrt(8.0 * MARKING / curvature)


def assert_is_asked(found, wanted):
    """Differences of the motion curve leave 1e-4 of its second derivative, chords of the path 1e-3 rad."""
    assert_allclose(found[0], wanted.motion_fall, rtol=2e-3)
    assert_allclose(found[1], wanted.path_angle, atol=3e-3)
    assert_allclose(found[2], wanted.contact_length, rtol=1e-5)


@pytest.mark.parametrize(
    ("flank", "path", "options"),
    [
        ("concave", 120.0, {}),
        ("convex", 60.0, {}),
        ("concave", 95.0, {"hand": "right", "shaft_angle": 75.0}),
        ("concave", 140.0, {"taper": "modified", "teeth": (23, 31), "shaft_angle": 110.0, "cutter": 90.0}),
        ("concave", 110.0, {"taper": "standard"}),
        ("concave", 120.0, {"edge_radius": 0.5}),
    ],
)
def test_contact_at_the_mean_point_is_as_asked_for(flank, path, options):
    basic, wheel = start(**options)
    aim = asked(path=path)
    pinion = local_synthesis(basic, wheel, aim, pinion_flank=flank)
    assert_is_asked(measured(pinion, wheel, flank), aim)
    assert pinion.machine.tilt == 0.0
    assert pinion.blank == basic.blank


@pytest.mark.thorough
def test_both_flanks_of_a_tooth_are_as_asked_for_in_one_pass():
    basic, wheel = start()
    drive, coast = asked(12.0, 125.0, 11.0), asked(8.0, 60.0, 9.0)
    pinion = local_synthesis(basic, wheel, drive, other_aim=coast)
    assert_is_asked(measured(pinion, wheel, "concave"), drive)
    assert_is_asked(measured(pinion, wheel, "convex"), coast)


def test_other_flank_touches_at_its_mean_point_too():
    basic, wheel = start()
    pair = face_milled_pair(local_synthesis(basic, wheel, asked()), wheel, pinion_flank="convex", exact=True)
    path = trace_contact(pair, [0.0])
    assert_allclose(path.transmission_error, 0.0, atol=1e-10)  # rad; both flanks are solved for: 3e-16 seen
    assert_allclose([path.pinion_radius[0], path.pinion_axial[0]], mean_point(basic), atol=1e-5)


def test_local_numbers_are_those_of_the_published_fields():
    """The mean contact of pair B, whose relative curvature at its mean point stands in the guide: 3.954798e-4 1/mm."""
    contact = mean_contact(matched_pinion(), published_wheel(), "concave")
    assert_allclose(8.0 * MARKING / contact.contact_length**2, 3.954798e-4, rtol=1e-4)  # its normals differ by 1e-5


@pytest.mark.thorough
def test_motion_that_is_conjugate_to_second_order_can_be_asked_for():
    basic, wheel = start()
    pinion = local_synthesis(basic, wheel, asked(fall=0.0))
    path = trace_contact(face_milled_pair(pinion, wheel, exact=True), np.array([-0.002, 0.0, 0.002]))
    second = np.diff(path.transmission_error, 2)[0] / 0.002**2
    assert abs(second) < 1e-5  # with a fall of 10 arcsec it is 2e-3


def test_tooth_is_as_thick_as_asked_for():
    basic, wheel = start()
    (rho, z), wanted = mean_point(basic), 0.21
    from loaded_tca.flanks.face_milled import tooth_angle

    for gear in (local_synthesis(basic, wheel, asked(), tooth_angle=wanted), with_tooth_angle(basic, wanted)):
        assert_allclose(tooth_angle(gear, np.array([rho]), np.array([z])), wanted, rtol=1e-9)
    wider = with_tooth_angle(basic, wanted).cutter
    mean = 0.5 * (wider.concave.point_radius + wider.convex.point_radius)
    assert_allclose(mean, 114.3, rtol=1e-12)  # half a sum


@pytest.mark.thorough
def test_larger_pair_of_the_same_form_has_larger_settings_of_the_same_form():
    """Lengths scale with the module, angles stay."""
    settings = []
    for scale in (1.0, 3.0):
        blank = BevelBlank(
            (20, 30), 5.0 * scale, 22.0 * scale, spiral_angle=radians(35), cutter_radius=80.0 * scale, taper="duplex"
        )
        aim = asked(length=9.0 * scale**0.5)  # the approach does not scale
        settings.append(local_synthesis(*duplex_spread_blade(blank), aim).machine)
    small, large = settings
    for name in ("radial", "machine_centre_to_back", "sliding_base", "blank_offset"):
        assert_allclose(getattr(large, name), 3.0 * getattr(small, name), rtol=1e-6, atol=1e-6)
    assert_allclose(large.ratio_of_roll, small.ratio_of_roll, rtol=1e-9)
    assert_allclose(large.cradle_angle, small.cradle_angle, rtol=1e-9)


def test_ellipse_shorter_than_the_path_allows_is_refused_with_the_least_length():
    basic, wheel = start()
    with pytest.raises(GeometryError, match=r"path_angle: a path at 178 deg .* longer than .* take a path more across"):
        local_synthesis(basic, wheel, asked(path=178.0, length=2.0))


@pytest.mark.thorough
def test_uniform_depth_and_small_cutters_take_all_settings():
    """Their basic settings are far off, and few settings find nothing."""
    for basic, wheel in (start(taper="uniform"), start(taper="modified", cutter=60.0)):
        pinion = local_synthesis(basic, wheel, asked())
        assert_is_asked(measured(pinion, wheel, "concave"), asked())
        assert pinion.machine.tilt != 0.0


@pytest.mark.thorough
def test_settings_that_are_not_found_are_told(monkeypatch):
    monkeypatch.setattr("loaded_tca.pairs.synthesis.MOST_TRIALS", 30)
    basic, wheel = start()
    with pytest.raises(GeometryError, match="no machine settings are found that give the contact asked for"):
        local_synthesis(basic, wheel, asked(path=90.0, length=1.0))


def test_fall_beyond_that_of_an_edge_is_refused():
    basic, wheel = start()
    with pytest.raises(GeometryError, match=r"motion_fall: 0.009696 rad; allowed below .* the fall of an edge"):
        local_synthesis(basic, wheel, asked(fall=2000.0))


def test_formate_pinion_and_missing_blades_are_refused():
    basic, wheel = start()
    formate = replace(basic, machine=replace(basic.machine, generation="formate"))
    one_blade = replace(basic, cutter=replace(basic.cutter, convex=None))
    for gear in (formate, one_blade):
        with pytest.raises(InputError, match="needs a generated gear whose cutter has both blades"):
            local_synthesis(gear, wheel, asked())


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ((-1.0, 1.0, 10.0), "motion_fall: -1 rad is not from 0"),
        ((0.0, 0.0, 10.0), "path_angle: 0 rad is not between 0 and 3.142"),
        ((0.0, 1.0, 0.0), "contact_length: 0.0 mm is not positive"),
    ],
)
def test_contact_that_none_can_have_is_refused(values, told):
    with pytest.raises(InputError, match=told):
        MeanContact(*values)


def test_flanks_that_do_not_carry_have_no_mean_contact():
    basic, wheel = start(taper="uniform")
    with pytest.raises(GeometryError, match="do not carry at the mean point"):
        mean_contact(basic, wheel, "concave")


@pytest.mark.thorough
def test_angles_of_the_example_are_in_the_right_sense():
    """A path that leans to the toe on its way to the tip lies above 90 deg: the contact moves to smaller z."""
    basic, wheel = start()
    for path, towards in ((140.0, -1.0), (50.0, 1.0)):
        pair = face_milled_pair(local_synthesis(basic, wheel, asked(path=path)), wheel)
        contact = trace_contact(pair, np.array([-0.05, 0.05]) * pair.pitch)
        toe_to_heel = np.diff(np.hypot(contact.pinion_radius, contact.pinion_axial))[0]
        upwards = np.diff(np.arctan2(contact.pinion_radius, contact.pinion_axial))[0]
        assert np.sign(toe_to_heel * upwards) == towards, degrees(upwards)
