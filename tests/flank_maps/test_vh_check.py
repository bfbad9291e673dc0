import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flank_maps.pattern import ContactPattern
from loaded_tca.flank_maps.vh_check import FINER, centre_and_size, vh_check
from loaded_tca.flanks import CylinderFrame, FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.cylindrical import Mounting
from tests.samples.gear_pairs import gear_pair

CROWNING = 0.05
POSITIONS = 11
NONE = FlankModifications()
ANGLE = 1e-3
CURVATURE = 2.0 * CROWNING / 12.5**2  # of the lead parabola
WIDTH_OF_A_STEP = 0.05
"""mm: the interpolated grid has steps of 25/40/8 mm."""


def spur(v, h, **changes):
    return gear_pair(
        FlankModifications(lead_crowning=CROWNING), mounting=Mounting(in_plane=v, out_of_plane=h), **changes
    )


def spiral(offset, axial):
    mesh = bevel_mesh((20, 31), outer_module=4.0, face_width=22.0, spiral_angle=math.radians(30.0))
    crowned = FlankModifications(lead_crowning=0.04, profile_crowning=0.02)
    return bevel_pair(mesh, modifications=(crowned, NONE), mounting=BevelMounting(offset, axial))


@pytest.fixture(scope="module")
def check():
    return vh_check(spur, [-ANGLE, 0.0, ANGLE], [-ANGLE, 0.0, ANGLE], positions=POSITIONS)


def test_pattern_of_a_spur_pair_goes_by_the_slope_over_the_curvature(check):
    """f = delta cos(alpha) - gamma sin(alpha) moves the bottom of the lead parabola by f/c'."""
    alpha = math.radians(20.0)
    slope = check.h * math.cos(alpha) - check.v[:, None] * math.sin(alpha)
    assert_allclose(check.shift[..., 0], slope / CURVATURE, atol=WIDTH_OF_A_STEP)


def test_pattern_of_a_spur_pair_keeps_its_height(check):
    assert_allclose(check.shift[..., 1], 0.0, atol=0.1)


def test_shift_is_counted_from_no_error(check):
    assert check.nominal == (1, 1)
    assert_allclose(check.shift[1, 1], 0.0, atol=0.0)


def test_wheel_shows_the_same_shift_as_the_pinion(check):
    wheel = vh_check(spur, [0.0], [0.0, ANGLE], gear="wheel", positions=POSITIONS)
    assert wheel.patterns[0][0].gear == "wheel"
    assert_allclose(wheel.shift[0, 1, 0], check.shift[1, 2, 0], atol=2.0 * WIDTH_OF_A_STEP)


def test_large_error_runs_onto_the_edge():
    pushed = vh_check(spur, [0.0], [0.0, 0.02], positions=POSITIONS)
    assert pushed.edge_share[0, 1] == 1.0
    assert pushed.centre[0, 1, 0] > 10.0


@pytest.mark.thorough
def test_offset_and_displacement_of_a_spiral_pair_act_to_first_order():
    found = vh_check(spiral, [-0.02, 0.0, 0.02], [-0.02, 0.0, 0.02], positions=POSITIONS, grid=(21, 31))
    for one, other in ((found.shift[0, 1], found.shift[2, 1]), (found.shift[1, 0], found.shift[1, 2])):
        assert abs(one[0]) > 0.1
        assert_allclose(one[0], -other[0], rtol=0.2)
    combined = found.shift[2, 1, 0] + found.shift[1, 2, 0]
    assert_allclose(found.shift[2, 2, 0], combined, atol=0.2 * np.abs(found.shift[..., 0]).max())


def marked(gap, compound=1.0):
    axial, radius = np.meshgrid(np.linspace(-10.0, 10.0, 41), np.linspace(50.0, 54.0, 21))
    return ContactPattern("pinion", compound, radius, axial, radius, gap(radius, axial))


def test_centre_of_a_whole_flank_is_its_middle():
    centre, size = centre_and_size(marked(lambda radius, _: 0.0 * radius), CylinderFrame())
    assert_allclose(centre, (0.0, 104.0), atol=1e-9)
    assert_allclose(size, (20.0, 8.0), rtol=1e-12)  # of the grid, which has the ends of the flank


def test_centre_of_a_band_lies_on_its_axis():
    """Gap a parabola of z about 2.3 mm, off the lines of the grid; the compound is as thick 3 mm from there.

    The ends lie within a step of the interpolated grid, and chords of steps of 0.5 mm above it by 0.25^2/9, which at
    the slope of 2/3 there is 0.0105 mm.
    """
    centre, size = centre_and_size(marked(lambda _, axial: (axial - 2.3) ** 2 / 9.0), CylinderFrame())
    assert_allclose(centre, (2.3, 104.0), atol=0.02)
    assert_allclose(size, (6.0, 8.0), atol=2.0 * (0.5 / FINER + 0.0105))


def test_pattern_that_misses_the_grid_has_no_centre():
    assert np.isnan(centre_and_size(marked(lambda radius, _: np.full_like(radius, np.inf)), CylinderFrame())).all()


def test_shown_by_its_size(check):
    assert repr(check).startswith("VHCheck(3 x 3 patterns on the pinion")


@pytest.mark.parametrize("positions", [1, 5.0, "many"])
def test_positions_that_are_no_number_are_refused(positions):
    with pytest.raises(InputError, match="positions"):
        vh_check(spur, [0.0], [0.0], positions=positions)


@pytest.mark.parametrize("errors", [[], [math.nan], [[0.0]], ["a"]])
def test_errors_that_are_no_row_of_numbers_are_refused(errors):
    for which in ((errors, [0.0]), ([0.0], errors)):
        with pytest.raises(InputError):
            vh_check(spur, *which)


def test_errors_that_part_the_gears_are_told():
    with pytest.raises(GeometryError, match=r"v = 0, h = 30: .*no common flank"):
        vh_check(lambda v, h: gear_pair(mounting=Mounting(v, centre_distance_error=h)), [0.0], [0.0, 30.0])
