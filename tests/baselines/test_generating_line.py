"""Line of contact of cutter and flank at the centre of roll: on the flank, with its normals; what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.baselines.bidirectional import GeneratingLine
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.flanks.base import outward_normal
from loaded_tca.flanks.face_milled import GeneratedFlank
from loaded_tca.pairs.gear_pair import cylindrical_basis
from tests.samples.face_milled import matched_pinion, on_machine, published_wheel

ROUNDING = 1e-9  # rad and parts of a unit vector; the generating equations are solved to 1e-12 rad
GENERAL = {  # every setting that moves the cutter at the centre of roll
    "tilt": 0.02,
    "swivel": 0.7,
    "blank_offset": 0.3,
    "sliding_base": 0.1,
    "machine_centre_to_back": -0.2,
    "modified_roll_2c": 0.02,
    "helical_motion": 0.5,
}
CASES = {
    "left, straight blade": (matched_pinion(), "concave"),
    "right, hollow blade": (published_wheel(), "convex"),
    "left, tilted and offset": (on_machine(matched_pinion(), **GENERAL), "concave"),
    "right, tilted and offset": (on_machine(published_wheel(), **GENERAL), "convex"),
}
every_case = pytest.mark.parametrize(("gear", "flank"), CASES.values(), ids=CASES)


def azimuths(gear, spread=0.06):
    """About that of the mean point on the cutter, on the gear's own hand."""
    machine, blank = gear.machine, gear.blank
    centre = machine.radial * np.exp(1j * machine.cradle_angle)
    middle = np.angle(blank.mean_cone_distance * np.cos(blank.pitch_angle - blank.root_angle) - centre)
    return gear.mirror * middle + np.linspace(-spread, spread, 9)


@every_case
def test_line_lies_on_the_generated_flank_at_the_centre_of_roll(gear, flank):
    found = GeneratingLine(gear, flank).at(azimuths(gear))
    exact = GeneratedFlank(gear, flank).generation.solve(found.rho, found.z)
    assert exact.found.all()
    assert_allclose(exact.cradle, 0.0, rtol=0, atol=1e-7)  # its root is flat where the line runs along the tooth
    assert_allclose(gear.mirror * exact.theta.value, found.azimuth, rtol=0, atol=ROUNDING)


@every_case
def test_normal_is_that_of_the_flank(gear, flank):
    found = GeneratingLine(gear, flank).at(azimuths(gear))
    generated = GeneratedFlank(gear, flank)
    inner = generated.inside(found.rho, found.z)
    assert inner.sum() >= 3
    components = outward_normal(generated, found.rho[inner], found.z[inner])
    expected = np.einsum("nk,nkj->nj", components, cylindrical_basis(found.azimuth[inner]))
    assert_allclose(found.normal[inner], expected, rtol=0, atol=1e-7)


@every_case
def test_moment_is_that_of_the_normal_about_the_apex(gear, flank):
    found = GeneratingLine(gear, flank).at(azimuths(gear))
    assert_array_equal(found.moment, np.cross(found.point, found.normal))  # the same product
    # three products of a moment and a unit vector
    assert_allclose((found.moment * found.normal).sum(axis=-1), 0.0, rtol=0, atol=1e-12 * gear.machine.radial)


@settings(max_examples=20, deadline=None)
@given(st.floats(-0.05, 0.05))
def test_normal_of_a_straight_blade_tells_the_azimuth_about_the_cutter(shift):
    """Upright cutter: the normal is (cos theta cos alpha, sin theta cos alpha, -sin alpha) on the machine."""
    gear = matched_pinion()
    angle = azimuths(gear)[4] + shift
    normal = GeneratingLine(gear, "concave").at(angle).normal[0]
    sine, cosine = np.sin(gear.machine.root_angle), np.cos(gear.machine.root_angle)
    on_machine_x = normal[0] * sine + normal[2] * cosine
    assert_allclose(np.arctan2(-normal[1], -on_machine_x), angle, rtol=0, atol=1e-12)  # rad; of order one: 2e-16 seen


def test_hands_are_mirror_images():
    left = matched_pinion()
    right = replace(left, blank=replace(left.blank, hand="right"))
    angles = azimuths(left)
    one, other = (GeneratingLine(gear, "concave").at(at) for gear, at in ((left, angles), (right, -angles)))
    # the same operations with the signs turned, to the bit
    assert_array_equal(one.rho, other.rho)
    assert_array_equal(one.azimuth, -other.azimuth)
    assert_array_equal(one.normal, other.normal * [1.0, -1.0, 1.0])


def test_azimuths_a_whole_turn_apart_are_one():
    line = GeneratingLine(matched_pinion(), "concave")
    angle = azimuths(matched_pinion())[4]
    # an angle up to 4 pi is rounded to 1e-15: 6e-16 seen
    assert_allclose(line.at(angle).rho, line.at(angle + 2.0 * np.pi).rho, rtol=1e-13)


def test_gear_that_does_not_roll_has_no_line():
    with pytest.raises(InputError, match="wheel: generation: 'formate'"):
        GeneratingLine(on_machine(published_wheel(), generation="formate", ratio_of_roll=0.0), "convex")


def test_cutter_without_the_blade_is_refused():
    with pytest.raises(InputError, match="convex: missing"):
        GeneratingLine(matched_pinion(), "convex")


def test_equation_of_meshing_without_a_root_is_told():
    """A strongly curved blade far from the mean point: Newton's method runs to and fro."""
    wheel = published_wheel()
    cutter = replace(wheel.cutter, convex=replace(wheel.cutter.convex, blade_radius=12.0))
    line = GeneratingLine(replace(wheel, cutter=cutter), "convex")
    with pytest.raises(ConvergenceError, match="still moves by"):
        line.at(azimuths(wheel)[4] + np.linspace(-np.pi, np.pi, 721))
