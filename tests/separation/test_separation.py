"""The separation matrix: exact gaps, where flanks end, and a box that holds the contact under any load."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from loaded_tca import (
    AccuracyWarning,
    GeometryError,
    read_scene,
    sample_separation,
    solve_contact,
    trace_contact,
)
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.reference import hertz
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.sample import _covers, cells_for_accuracy
from tests.refusals import refusals
from tests.samples.gear_pairs import SAM_PAPER_TORQUE, cylindrical_mesh, gear_pair, pairs, sam_paper
from tests.samples.results import SCENES

GAP = 1e-11  # mm: rounding of coordinates of 100 mm, thrown together over some operations


def at_pitch_point(pair):
    return trace_contact(pair, [0.0])[0]


def separation_of(pair, turn=0.0, **options):
    contact = trace_contact(pair, [turn * pair.pitch])[0]
    return contact, sample_separation(pair, contact, **({"cells": (32, 32), "load": 2700.0} | options))


def height_of(flank, turn, to_own, start, normal):
    """Distance along the normal from the tangent plane to a flank [mm], by bracketing, and (rho, z) there."""

    def excess(height):
        x, y, z = to_own(start + height * normal)
        theta = flank.theta(np.array(math.hypot(x, y)), np.array(z)).value + turn
        return math.remainder(float(theta) - math.atan2(y, x), math.tau)

    if excess(-0.5) * excess(0.5) > 0.0:
        return math.nan, (np.array(0.0), np.array(math.inf))  # bent away, far outside the flank
    height = brentq(excess, -0.5, 0.5, xtol=1e-15, rtol=1e-15)
    x, y, z = to_own(start + height * normal)
    return height, (np.array(math.hypot(x, y)), np.array(z))


def brute_force_gap(pair, contact, separation, i, j):
    x, y, normal = separation.axes
    start = separation.origin + separation.x[i] * x + separation.y[j] * y

    def wheel_frame(point):
        return pair.wheel_axes @ (point - pair.wheel_origin)

    low, own = height_of(pair.pinion.flank, pair.sense * contact.pinion_angle, lambda p: p, start, normal)
    high, other = height_of(pair.wheel.flank, -pair.sense * contact.wheel_angle, wheel_frame, start, normal)
    there = pair.pinion.flank.inside(*own) and pair.wheel.flank.inside(*other)
    return high - low if there else math.inf


# The gap


@pytest.mark.thorough
@given(pairs(), st.floats(-0.4, 0.4))
@settings(max_examples=12)
def test_gap_equals_the_distance_found_by_bracketing(pair, turn):
    contact, separation = separation_of(pair, turn, box=(0.3, 4.0), load=None, cells=(6, 6))
    for i, j in ((0, 0), (2, 3), (5, 1), (3, 5)):
        expected = brute_force_gap(pair, contact, separation, i, j)
        if math.isinf(expected) or math.isinf(separation.gap[i, j]):
            assert math.isinf(expected) == math.isinf(separation.gap[i, j])
        else:
            assert_allclose(separation.gap[i, j], expected, atol=GAP)


@pytest.mark.thorough
@given(pairs(), st.floats(-0.4, 0.4))
@settings(max_examples=12)
def test_gap_is_nothing_at_the_contact_point_and_nowhere_negative(pair, turn):
    _, separation = separation_of(pair, turn, box=(0.2, 4.0), load=None, cells=(17, 17))
    assert_allclose(separation.gap[8, 8], 0.0, atol=GAP)
    assert separation.gap.min() >= -1e-8  # the field is flat to first order: the exact gap differs by its square


def test_contact_point_lies_between_the_middle_cells_of_an_even_grid():
    _, separation = separation_of(sam_paper(), cells=(8, 6))
    assert_allclose(separation.x[3:5], [-0.5 * separation.spacing[0], 0.5 * separation.spacing[0]])
    assert_allclose(separation.y[2:4], [-0.5 * separation.spacing[1], 0.5 * separation.spacing[1]])
    assert_allclose(np.diff(separation.x), separation.spacing[0])
    assert_allclose(np.diff(separation.y), separation.spacing[1])


@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
@pytest.mark.parametrize("turn", [-0.2, 0.0, 0.3])
def test_second_differences_of_the_gap_are_the_principal_curvatures(helix_deg, turn):
    pair = gear_pair(
        FlankModifications(lead_crowning=0.02), FlankModifications(profile_crowning=0.01), helix_deg=helix_deg
    )
    _, separation = separation_of(pair, turn, box=(0.03, 0.3), load=None, cells=(3, 3))
    dx, dy = separation.spacing
    gap = separation.gap
    across = (gap[2, 1] - 2.0 * gap[1, 1] + gap[0, 1]) / dx**2
    along = (gap[1, 2] - 2.0 * gap[1, 1] + gap[1, 0]) / dy**2
    twist = (gap[2, 2] - gap[2, 0] - gap[0, 2] + gap[0, 0]) / (4.0 * dx * dy)
    assert_allclose(across, separation.curvatures[0], rtol=1e-5)  # fourth derivatives times dx^2, rounding 1e-13/dx^2
    assert_allclose(along, separation.curvatures[1], rtol=1e-3)
    assert_allclose(twist, 0.0, atol=1e-5 * separation.curvatures[0])


def test_gap_of_a_crowned_spur_pair_is_symmetric_along_the_face():
    _, separation = separation_of(sam_paper(), turn=0.1)
    assert_allclose(separation.gap, separation.gap[:, ::-1], atol=GAP)


@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
def test_gap_of_equal_gears_at_the_pitch_point_is_symmetric_under_half_a_turn(helix_deg):
    crowned = FlankModifications(lead_crowning=0.005)
    _, separation = separation_of(gear_pair(crowned, crowned, teeth=(40, 40), helix_deg=helix_deg))
    # half a turn about the x axis of the pair lets the gears change places; to third order in the gap
    assert_allclose(separation.gap, separation.gap[::-1, ::-1], atol=1e-9)


@pytest.mark.parametrize(("helix_deg", "pressure", "semi_major"), [(0.0, 748.54, 11.977), (15.0, 706.85, 12.206)])
def test_hertz_of_the_sam_paper_pairs_has_the_reference_pressure(helix_deg, pressure, semi_major):
    pair, mesh = sam_paper(helix_deg), cylindrical_mesh(helix_deg=helix_deg)
    load = mesh.normal_force(SAM_PAPER_TORQUE)
    _, separation = separation_of(pair, load=load)
    found = hertz.point_contact(load, separation.curvatures, pair.contact_modulus)
    assert_allclose(found.max_pressure, pressure, atol=0.01)
    assert_allclose(found.semi_major, semi_major, atol=1e-3)


# Where a flank ends


def test_gap_is_infinite_beyond_the_sides_of_the_face():
    _, separation = separation_of(sam_paper(), box=(0.2, 20.0), load=None, cells=(5, 81))
    beyond = np.abs(separation.y) > 12.5 + 1e-6
    assert np.isinf(separation.gap[:, beyond]).all()
    assert np.isfinite(separation.gap[:, ~beyond]).all()


def test_gap_is_infinite_beyond_the_tip_of_either_gear_and_below_the_form_circle():
    pair, mesh = sam_paper(), cylindrical_mesh()
    contact, separation = separation_of(pair, box=(6.0, 1.0), load=None, cells=(121, 3))
    points = separation.origin + separation.x[:, None] * separation.axes[0]
    finite = np.isfinite(separation.gap[:, 1])
    assert 0 < finite.sum() < len(finite)
    assert np.ptp(np.flatnonzero(finite)) + 1 == finite.sum(), "one stretch"
    for last in np.flatnonzero(finite)[[0, -1]]:
        expected = brute_force_gap(pair, contact, separation, int(last), 1)
        assert_allclose(separation.gap[last, 1], expected, atol=GAP)
        outside = int(last) + (1 if last > 60 else -1)
        assert math.isinf(brute_force_gap(pair, contact, separation, outside, 1))
    # far out no flank of either gear is above the plane
    radius = np.hypot(points[..., 0], points[..., 1])
    assert np.isinf(separation.gap[radius > mesh.pinion.tip_radius + 3.0, 1]).all()


# The box


ROUNDED = FlankModifications(profile_crowning=0.013)
CONTACTS = {
    "point": (lambda: sam_paper(15.0), 0.0),
    "circle": (lambda: gear_pair(FlankModifications(lead_crowning=2.0)), 0.1),
    "line": (lambda: gear_pair(), 0.0),
    "helical line": (lambda: gear_pair(helix_deg=15.0), 0.1),
    "misaligned edge": (lambda: sam_paper(mounting=Mounting(out_of_plane=0.005)), 0.0),
    "tip edge": (lambda: sam_paper(), 0.9),
    "tip line": (lambda: gear_pair(), -0.9),
    "helical corner": (lambda: gear_pair(ROUNDED, ROUNDED, helix_deg=28.0, teeth=(31, 57)), -0.026),
    "bevel line": (lambda: bevel_pair(bevel_mesh((20, 30), 3.0, 18.0)), 0.1),
}


@pytest.mark.quick_cases(every=5)
@pytest.mark.filterwarnings("ignore:pinion.modifications.lead_crowning")
@pytest.mark.parametrize("name", CONTACTS)
@pytest.mark.parametrize("load", [1e-3, 1.0, 1e3, 1e5])
def test_box_holds_the_contact_and_is_not_much_larger(name, load):
    make, turn = CONTACTS[name]
    pair = make()
    _, separation = separation_of(pair, turn, load=load, cells=(48, 48))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        solution = solve_contact(separation.gap, separation.spacing, pair.contact_modulus, load=load, tolerance=1e-4)
    assert not solution.reaches_border
    # half of the box across, a fifth on an edge; along, a wedge at the end of a face is short beside its box
    assert solution.cells_across[0] >= (10 if "edge" in name or "tip" in name else 24)
    assert solution.cells_across[1] >= (4 if name == "misaligned edge" else 36)


@pytest.mark.quick_cases(every=5)
@pytest.mark.filterwarnings("ignore:pinion.modifications.lead_crowning")
@pytest.mark.parametrize("name", CONTACTS)
@pytest.mark.parametrize("factor", [1e-3, 0.4, 2.5, 1e3])
def test_box_hardly_depends_on_the_guess_it_starts_from(name, factor):
    make, turn = CONTACTS[name]
    pair = make()
    contact, separation = separation_of(pair, turn, load=100.0, cells=(16, 16))
    guess = (factor * separation.box.half_lengths[0], factor * separation.box.half_lengths[1])
    guessed = sample_separation(pair, contact, load=100.0, cells=(16, 16), guess=guess)
    # lengths are rounded up to half a cell of a coarse grid, which a contact fills to between 0.4 and 0.8
    assert_allclose(guessed.box.half_lengths, separation.box.half_lengths, rtol=0.25)


@pytest.mark.parametrize(
    ("name", "load"),
    [("line", 1e3), ("helical line", 1e3), ("tip line", 1e3), ("bevel line", 1e3), ("helical corner", 9e3)],
)
def test_box_ends_one_cell_beyond_the_end_of_the_material(name, load):
    make, turn = CONTACTS[name]
    pair = make()
    contact, separation = separation_of(pair, turn, load=load, cells=(16, 16))
    gap = NormalGap(pair, contact, separation.axes)
    box, cell = separation.box, separation.spacing[1]
    x = box.middle[0] + np.linspace(-1.0, 1.0, 65)[:, None] * box.half_lengths[0]
    left = []
    for sign in (-1.0, 1.0):
        end = box.middle[1] + sign * box.half_lengths[1]
        places = end - sign * cell * np.linspace(0.0, 2.0, 2001)
        left.append(np.argmax(gap.at(x, places)[1].max(axis=0) >= 0.0) / 1000.0)  # cells without material
    # a whole cell on either side, and less than another where the contact point lies on a border between two
    assert_allclose(min(left), 1.0, atol=2e-3)
    assert max(left) < 2.0
    assert np.isinf(separation.gap[:, [0, -1]]).all()


def test_box_does_not_change_with_the_rounding_of_the_load():
    """Of a contact that is estimated to be as long to the one side as to the other, but ends with the flank on one."""
    pair = read_scene(SCENES / "mesh_cycle_helical.toml").pair()
    contact = trace_contact(pair, [-0.71875 * pair.pitch])[0]
    loads = 1975.78 * (1.0 + np.finfo(float).eps * np.arange(-12, 13))
    boxes = [sample_separation(pair, contact, cells=(16, 16), load=load).box.half_lengths for load in loads.tolist()]
    assert_allclose(boxes, np.broadcast_to(boxes[0], (len(boxes), 2)), rtol=1e-9)  # far above rounding, below a cell


def test_end_of_the_material_of_a_spur_pair_is_that_of_the_face():
    _, separation = separation_of(gear_pair(), load=1e3, cells=(16, 16))
    assert_allclose(separation.box.half_lengths[1] * 14.0 / 16.0, 12.5, rtol=2e-6)  # looked for to 1e-6 of the box


def test_cells_for_accuracy_are_even_and_grow_with_the_root_of_the_accuracy():
    cells = [cells_for_accuracy(accuracy) for accuracy in (0.5, 1e-3, 1e-5, 1e-7)]
    assert all(count % 2 == 0 for count in cells)
    assert cells[0] >= 8
    assert_allclose(cells[3] / cells[2], 10.0, rtol=0.02)  # whole, even numbers
    assert cells == sorted(cells)


def test_given_box_and_cells_are_kept():
    _, separation = separation_of(sam_paper(), box=(0.4, 8.0), load=None, cells=(10, 20))
    assert separation.gap.shape == (10, 20)
    assert_allclose(separation.spacing, (0.08, 0.8))
    assert repr(separation) == "Separation(10 x 20 cells of 0.08 x 0.8 mm)"


def test_load_of_zero_gets_a_box_so_small_that_its_smallest_gap_is_rounding():
    _, separation = separation_of(sam_paper(), load=0.0)
    assert separation.gap.min() < 1e-9


# Failure paths


test_argument_out_of_its_range_is_refused = refusals(
    lambda options: sample_separation(sam_paper(), at_pitch_point(sam_paper()), **options),
    ({}, "load: none given; a load [N] or a box [mm] is needed to size the grid"),
    ({"load": -1.0}, "load: -1.0 N is not a finite number >= 0"),
    ({"load": math.nan}, "load: nan N is not a finite number >= 0"),
    ({"load": math.inf}, "load: inf N is not a finite number >= 0"),
    ({"load": 1.0, "cells": (0, 4)}, "cells: (0, 4) are not two whole numbers >= 1"),
    ({"load": 1.0, "cells": (4,)}, "cells: (4,) are not two whole numbers >= 1"),
    ({"load": 1.0, "cells": (4.5, 4)}, "cells: (4.5, 4) are not two whole numbers >= 1"),
    ({"box": (0.0, 1.0)}, "box: (0.0, 1.0) are not two positive lengths [mm]"),
    ({"box": (1.0, math.inf)}, "box: (1.0, inf) are not two positive lengths [mm]"),
    ({"load": 1.0, "guess": (0.0, 1.0)}, "guess: (0.0, 1.0) are not two positive lengths [mm]"),
    ({"load": 1.0, "accuracy": 0.0}, "accuracy: 0.0 is not between 1e-8 and 1"),
    plain=True,
)


def test_position_that_does_not_touch_is_refused():
    pair = sam_paper()
    contact = trace_contact(pair, [0.0, 1.5])[1]
    with pytest.raises(GeometryError, match=r"no common flank: .* is not in contact at pinion angle 1.5 rad"):
        sample_separation(pair, contact, load=1.0)


def test_contact_point_off_the_flanks_is_refused():
    pair = sam_paper()
    contact = at_pitch_point(pair)
    away = replace(contact, point=contact.point + [0.0, 0.0, 100.0])  # noqa: RUF005 (a sum)
    with pytest.raises(GeometryError, match="no flank around the contact point at pinion angle 0 rad"):
        sample_separation(pair, away, load=1.0)


def test_material_of_cut_cells_adds_up_to_the_face():
    """The contact point stands off the middle of the face, so that the nearer end lies within a cell."""
    mounting = Mounting(out_of_plane=1e-4)
    pair = gear_pair(FlankModifications(lead_crowning=0.005), mounting=mounting)
    for cells in (24, 28, 32, 40):
        contact, separation = separation_of(pair, load=9e3, cells=(cells, cells))
        assert abs(contact.point[2]) > 1.0
        assert_allclose(separation.cover.sum(axis=1) * separation.spacing[1], 25.0, rtol=2e-4)
        inside = np.isfinite(separation.gap)
        assert (inside == (separation.cover >= 0.5)).all()
        assert ((separation.cover > 0.0) == np.isfinite(separation.cut_gap)).all()
        assert (separation.gap[inside] == separation.cut_gap[inside]).all()


@pytest.mark.parametrize("name", ["helical corner", "bevel line"])
def test_cover_is_the_part_of_the_cell_within_the_edges(name):
    """Beside 40 x 40 points in every cell; oblique cuts of slender cells are known to some hundredths."""
    make, turn = CONTACTS[name]
    pair = make()
    contact, fitting = separation_of(pair, turn, load=9e3, cells=(16, 16))
    across, along = fitting.box.half_lengths
    separation = sample_separation(pair, contact, cells=(16, 16), box=(across, 1.07 * along))
    gap, fine = NormalGap(pair, contact, separation.axes), (np.arange(40) + 0.5) / 40.0 - 0.5
    x, y = (
        (centres[:, None] + fine * step).ravel()
        for centres, step in zip((separation.x, separation.y), separation.spacing, strict=True)
    )
    inside = (gap.at(x[:, None], y)[1] >= 0.0).reshape(16, 40, 16, 40).mean(axis=(1, 3))
    cut = (inside > 0.0) & (inside < 1.0)
    assert cut.any()
    assert_allclose(separation.cover, inside, rtol=0.0, atol=0.13)
    assert_allclose(separation.cover.sum(), inside.sum(), rtol=2e-3)


def test_cover_of_cells_that_an_oblique_edge_cuts_follows_its_distance_up_to_the_end_of_the_grid():
    """Edges with the normal (0.6, 0.8) run through cells of 1 mm within 0.7 mm of their middles."""
    place = np.arange(4.0)
    distance = 4.2 - 0.6 * place[:, None] - 0.8 * place
    covers = _covers(distance[None, None], np.ones((1, 2)))[0]
    expected = np.clip(0.5 + distance / 1.4, 0.0, 1.0)
    assert_allclose(covers, expected, rtol=0, atol=1e-12)  # parts of a cell from distances of 4 mm: 1e-16 seen
    assert 0.0 < expected[3, 3] < 1.0


def test_cover_of_cells_that_a_bent_edge_cuts_is_the_same_in_a_mirror():
    places = np.arange(8.0) - 3.5
    distance = np.hypot(places[:, None] + 1.0, places + 2.0) - 3.3  # from a circle
    covers = [_covers(sides[None, None], np.ones((1, 2)))[0] for sides in (distance, distance[::-1], distance[:, ::-1])]
    assert ((covers[0] > 0.0) & (covers[0] < 1.0)).any()
    assert_allclose(covers[1][::-1], covers[0], rtol=0, atol=1e-12)  # sums in another order
    assert_allclose(covers[2][:, ::-1], covers[0], rtol=0, atol=1e-12)
