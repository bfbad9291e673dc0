"""The bidirectional start: the paper's digits, what each step must fulfil, conjugate gears, and where it ends."""

from dataclasses import replace
from functools import cache
from math import atan2, cos

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.baselines.bidirectional import BidirectionalStart, GeneratingLine
from loaded_tca.baselines.conventional import contact_equations, solve_conventional
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.pairs.bevel import BevelMounting, face_milled_pair
from loaded_tca.unloaded import trace_contact
from tests.samples.face_milled import on_machine, published_wheel
from validation.face_milled.pairs import (
    MENDED_RADIAL,
    conjugate_gears,
    duplex_gears,
    duplex_paper_gears,
    matched_spygo_gears,
    spygo_gears,
)

HALF_DIGIT = 0.5e-6  # rad, of the paper's azimuths
ROUNDING = 1e-12  # rad or parts of a unit vector; a dozen turns of angles up to 2 pi: 2e-15 seen
SAME_CONTACT = 1e-9  # rad; y and z of the normals leave their root nearly double, the equations are solved to 1e-12
PAIRS = {
    "duplex paper": (duplex_paper_gears(), "concave"),
    "mended": (duplex_paper_gears(MENDED_RADIAL), "concave"),
    "published, coast": (spygo_gears(), "convex"),
    "duplex, coast": (duplex_gears(), "convex"),
}
every_pair = pytest.mark.parametrize(("gears", "flank"), PAIRS.values(), ids=PAIRS)
OFF = BevelMounting(offset=0.2, pinion_axial=-0.1, wheel_axial=0.15, shaft_angle_error=0.002)


@cache
def start_of(gears, flank="concave", mounting=BevelMounting()):
    pair = face_milled_pair(*gears, pinion_flank=flank, mounting=mounting)
    return BidirectionalStart(gears, pair), pair


@pytest.fixture(scope="module")
def paper_start():
    return start_of(duplex_paper_gears())[0]


def test_reverse_start_has_the_digits_of_the_paper(paper_start):
    values = paper_start.reverse(0.979223)
    assert_allclose(values.wheel_azimuth, 5.271278, rtol=0, atol=HALF_DIGIT)
    assert_allclose(values.pinion_turn, 2.8177e-3, rtol=0, atol=0.5e-7)
    assert_allclose(values.wheel_turn, -2.721e-3, rtol=0, atol=0.5e-6)


def test_forward_start_has_the_digits_of_the_paper_from_the_mended_azimuth(paper_start):
    values = paper_start.forward(5.346931)
    assert_allclose(values.pinion_azimuth, 0.896671, rtol=0, atol=HALF_DIGIT)
    assert_allclose(values.wheel_turn, 7.9436e-3, rtol=0, atol=0.5e-7)
    assert_allclose(values.pinion_turn, -6.30e-4, rtol=0, atol=0.5e-6)


def test_mean_start_has_the_digits_of_the_paper_but_for_the_misprinted_azimuth(paper_start):
    values = paper_start.forward(5.346931).mean(paper_start.reverse(0.979223))
    assert_allclose(values.wheel_azimuth, 5.309104, rtol=0, atol=HALF_DIGIT)
    assert_allclose(values.pinion_azimuth, 0.937947, rtol=0, atol=HALF_DIGIT)
    assert_allclose(values.wheel_turn, 2.611e-3, rtol=0, atol=1e-6)  # digits cut off, not rounded
    assert_allclose(values.pinion_turn, 1.090e-3, rtol=0, atol=1e-5)


def test_printed_forward_azimuth_is_a_misprint(paper_start):
    """The rest of its column lies 1000 times farther off than its digits allow."""
    values = paper_start.forward(5.349393)
    assert abs(values.pinion_azimuth - 0.896671) > 1000 * 1e-6
    assert abs(values.pinion_turn + 6.30e-4) > 100 * 1e-6


def test_steps_after_the_first_depend_on_neither_radial_setting_nor_cutter_radius():
    """Axes that meet: the normal and its moment follow from root angles, ratios of roll and blade angles."""
    other = []
    for gear in duplex_paper_gears():
        machine = replace(gear.machine, radial=1.01 * gear.machine.radial)
        blade = replace(gear.cutter.concave, point_radius=1.01 * gear.cutter.concave.point_radius)
        other.append(replace(gear, machine=machine, cutter=replace(gear.cutter, concave=blade, convex=blade)))
    one, changed = (start_of(gears)[0].forward(5.346931) for gears in (duplex_paper_gears(), tuple(other)))
    assert_allclose(
        [changed.pinion_azimuth, changed.pinion_turn, changed.wheel_turn],
        [one.pinion_azimuth, one.pinion_turn, one.wheel_turn],
        rtol=0,
        atol=ROUNDING,
    )


def standing(pair, values, member, gears):
    """Point and normal of one gear in the fixed frame at a start."""
    flank = (pair.pinion.flank, pair.wheel.flank)[member]
    line = GeneratingLine(gears[member], gears[member].flank_name(flank.side))
    azimuth, turn = (
        (values.pinion_azimuth, values.pinion_turn),
        (values.wheel_azimuth, values.wheel_turn),
    )[member]
    found = line.at(azimuth)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    axes, origin = ((np.eye(3), np.zeros(3)), (pair.wheel_axes, pair.wheel_origin))[member]
    return rotation @ found.point[0] @ axes + origin, rotation @ found.normal[0] @ axes


@every_pair
@pytest.mark.parametrize("mounting", [BevelMounting(), OFF], ids=["aligned", "misaligned"])
def test_start_fulfils_the_meshing_equation_and_has_opposite_normals(gears, flank, mounting):
    start, pair = start_of(gears, flank, mounting)
    for values, member in ((start.forward(), 1), (start.reverse(), 0)):
        point, normal = standing(pair, values, member, gears)
        first = np.cross([0.0, 0.0, 1.0], point)
        second = np.cross(-pair.ratio * pair.wheel_axes[2], point - pair.wheel_origin)
        assert_allclose(normal @ (first - second), 0.0, rtol=0, atol=ROUNDING * np.linalg.norm(first))
        assert_allclose(standing(pair, values, 1 - member, gears)[1], -normal, rtol=0, atol=ROUNDING)


@every_pair
def test_calculation_point_has_the_mean_cone_distance(gears, flank):
    start, _ = start_of(gears, flank)
    for guess, first in ((start.guess(start.reverse()), 0), (start.guess(start.forward()), 2)):
        distance = np.hypot(*guess.unknowns[first : first + 2])
        assert_allclose(distance, gears[0].blank.mean_cone_distance, rtol=ROUNDING)


@every_pair
def test_guess_tells_the_distance_of_its_points(gears, flank):
    start, pair = start_of(gears, flank)
    values = start.mean()
    guess = start.guess(values)
    points = [standing(pair, values, member, gears)[0] for member in (0, 1)]
    misfit, _ = contact_equations(pair, np.array([guess.pinion_angle]), guess.unknowns[None])
    # places of 100 mm are subtracted: 2e-15 seen
    assert_allclose(guess.distance, np.linalg.norm(points[0] - points[1]), rtol=1e-10)
    # the flanks of the pair are B-splines, 1e-7 mm off the generated ones
    assert_allclose(np.linalg.norm(misfit[0, :3]) * pair.base_radii[1], guess.distance, rtol=0, atol=1e-5)


@pytest.mark.thorough
def test_start_of_conjugate_gears_is_a_contact_already():
    """Two gears of uniform depth cut by one crown gear touch along a line; both starts lie on it."""
    gears = conjugate_gears()
    start, pair = start_of(gears)
    path = trace_contact(pair, np.linspace(-0.5, 0.5, 9) * pair.pitch, warn=False)
    assert_allclose(path.transmission_error, 0.0, rtol=0, atol=1e-9)
    for values in (start.forward(), start.reverse(), start.mean()):
        assert_allclose([values.pinion_turn, values.wheel_turn], 0.0, rtol=0, atol=ROUNDING)
        assert start.guess(values).distance < 1e-10  # mm; places of 100 mm are subtracted


def test_mirrored_pair_has_the_mirrored_start():
    gears = matched_spygo_gears()
    hands = {"left": "right", "right": "left"}
    mirrored = tuple(replace(gear, blank=replace(gear.blank, hand=hands[gear.blank.hand])) for gear in gears)
    (start, _), (other, _) = start_of(gears), start_of(mirrored)
    values, opposite = start.mean(), other.mean()
    assert_allclose(opposite.pinion_azimuth, 2.0 * np.pi - values.pinion_azimuth, rtol=ROUNDING)
    assert_allclose(
        [opposite.pinion_turn, opposite.wheel_turn], [-values.pinion_turn, -values.wheel_turn], atol=ROUNDING
    )
    one, two = start.guess(values), other.guess(opposite)
    # mm and rad, also below: the same operations with other signs
    assert_allclose(one.unknowns, two.unknowns, rtol=0, atol=1e-9)
    assert_allclose(one.pinion_angle, two.pinion_angle, rtol=0, atol=1e-10)


@pytest.mark.quick_cases(every=5)
@pytest.mark.parametrize("kind", ["forward", "reverse", "mean"])
@pytest.mark.parametrize("components", [(1, 2), (0, 2)])
@pytest.mark.parametrize(
    ("gears", "flank"),
    [(duplex_paper_gears(MENDED_RADIAL), "concave"), (duplex_gears(), "concave"), (duplex_gears(), "convex")],
    ids=["mended", "duplex, drive", "duplex, coast"],
)
def test_five_equations_get_home_where_the_flanks_touch_inside(gears, flank, components, kind):
    start, pair = start_of(gears, flank)
    guess = start.guess(getattr(start, kind)())
    found = solve_conventional(pair, [guess.pinion_angle], guess.unknowns[None], components)
    touch = trace_contact(pair, [guess.pinion_angle], warn=False)
    assert found.is_contact.all()
    assert_allclose(found.wheel_angle, touch.wheel_angle, rtol=0, atol=SAME_CONTACT)


def test_five_equations_find_no_contact_with_the_printed_settings(paper_start):
    pair = face_milled_pair(*duplex_paper_gears())
    for values in (paper_start.forward(), paper_start.reverse(), paper_start.mean()):
        guess = paper_start.guess(values)
        for components in ((1, 2), (0, 2)):
            found = solve_conventional(pair, [guess.pinion_angle], guess.unknowns[None], components)
            assert not found.is_contact.any()
        assert trace_contact(pair, [guess.pinion_angle], warn=False).on_edge.all()


def test_generating_line_off_the_mean_cone_distance_is_told():
    """A cradle angle of zero puts the centre of roll where the cutter has left the face."""
    gears = tuple(on_machine(gear, cradle_angle=0.0) for gear in duplex_paper_gears())
    start, _ = start_of(gears)
    with pytest.raises(GeometryError, match=r"wheel: no start .* cone distance .* off the mean one"):
        start.forward()


def test_normal_that_the_mate_does_not_have_is_told(paper_start):
    with pytest.raises(
        GeometryError, match=r"wheel: no start .* axial part of the normal .* off that of its mating gear"
    ):
        paper_start.reverse(2.2)


def test_normal_that_never_meshes_is_told():
    """A pinion rolled by half its ratio: the moment of its normal lies too near to its axis."""
    pinion, wheel = duplex_paper_gears()
    pair = face_milled_pair(pinion, wheel)
    slow = on_machine(pinion, ratio_of_roll=0.5 * pinion.machine.ratio_of_roll)
    with pytest.raises(GeometryError, match="pinion: its normal at the centre of roll never comes into mesh"):
        BidirectionalStart((slow, wheel), pair).reverse()


def test_formate_gear_is_refused():
    pinion = matched_spygo_gears()[0]
    formate = on_machine(published_wheel(), generation="formate", ratio_of_roll=0.0)
    with pytest.raises(InputError, match="formate"):
        BidirectionalStart((pinion, formate), face_milled_pair(pinion, published_wheel()))


def test_azimuth_of_the_mean_point_is_that_of_its_foot_on_the_cutter():
    """The circle of the nominal cutter passes the mean point; the start is sought about it."""
    gears = matched_spygo_gears()
    start, _ = start_of(gears)
    machine, blank = gears[1].machine, gears[1].blank
    along = blank.mean_cone_distance * cos(blank.pitch_angle - blank.root_angle)
    centre = machine.radial * np.exp(1j * machine.cradle_angle)
    assert_allclose(abs(along - centre), 95.25, rtol=1e-8)
    middle = atan2(-centre.imag, along - centre.real) % (2.0 * np.pi)
    assert abs(start.forward().wheel_azimuth - middle) < 0.1
