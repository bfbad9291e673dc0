"""Where grids lie: along the contact under load, as long as its material, and larger only where they have to be."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene, sample_separation, trace_contact
from loaded_tca.contact import ContactProblem, solve_problem
from loaded_tca.flanks import FlankModifications
from loaded_tca.separation import Separation, slice_middles
from loaded_tca.separation.box import ASKEW, Box
from loaded_tca.separation.sample import sample_separations
from loaded_tca.unloaded import relative_curvature
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair, sam_paper

ROOT = Path(__file__).parents[2]
BOX = Box((1.0, 4.0), np.eye(3))


def short_relief():
    """Contact in a short relief of a misaligned helical pair, and a force of one of its tooth pairs [N]."""
    pair = read_scene(ROOT / "validation" / "loaded" / "ev_stage.toml").pair()
    return pair, trace_contact(pair, [-0.5 * pair.pitch])[0], 4000.0


def solved(pair, separation, load):
    problem = ContactProblem(
        separation.cut_gap, separation.spacing, pair.contact_modulus, load=load, cover=separation.cover
    )
    return solve_problem(problem)


def in_box(pair, contact, cells, box):
    (separation,) = sample_separations(pair, [contact], cells=[cells], loads=[None], boxes=[box])
    assert isinstance(separation, Separation)
    return separation


def test_grid_lies_along_a_contact_that_is_askew_on_the_curvatures():
    pair, contact, load = short_relief()
    along = sample_separation(pair, contact, cells=(64, 64), load=load)
    principal = relative_curvature(pair, contact).axes
    on_curvatures = in_box(pair, contact, (64, 64), Box((2.0, 12.0), principal))
    slopes, widths = [], []
    for grid in (along, on_curvatures):
        pressure = solved(pair, grid, load).pressure
        carrying, middles = slice_middles(grid.x, pressure)
        slopes.append(abs(np.polyfit(grid.y[carrying], middles, 1, w=np.sqrt(pressure.sum(axis=0)[carrying]))[0]))
        widths.append(np.ptp(grid.x[pressure.any(axis=1)]))
    # the strips tell the axis to ASKEW of the width over the length; on the curvatures the line leaves it by far
    assert slopes[0] < ASKEW * widths[0] / along.box.half_lengths[1] < 0.2 * slopes[1]
    assert widths[0] < 0.5 * widths[1]
    # products of unit vectors, some dozen roundings
    assert_allclose(along.axes @ along.axes.T, np.eye(3), rtol=0, atol=1e-12)
    assert_allclose(along.axes[2], principal[2], rtol=0, atol=1e-12)
    across = along.axes[0] @ principal[0]
    rotated = across**2 * on_curvatures.curvatures[0] + (1.0 - across**2) * on_curvatures.curvatures[1]
    assert_allclose(along.curvatures[0], rotated, rtol=1e-12)  # Euler's theorem; a few roundings of the cosine


@pytest.mark.parametrize("helix_deg", [0.0, 20.0])
def test_grid_of_an_ellipse_lies_along_its_curvatures(helix_deg):
    pair = sam_paper(helix_deg)
    contact = trace_contact(pair, [0.0])[0]
    separation = sample_separation(pair, contact, cells=(16, 16), load=1000.0)
    assert (separation.axes == relative_curvature(pair, contact).axes).all()
    assert separation.box.middle == (0.0, 0.0)


def test_turned_grid_gives_the_same_contact():
    pair, contact, load = short_relief()
    box = sample_separation(pair, contact, cells=(16, 16), load=load).box
    angle = np.radians(10.0)
    turn = np.array([[np.cos(angle), np.sin(angle), 0.0], [-np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    length = box.half_lengths[1]
    x, y = turn[:2, :2] @ box.middle
    wide = Box((box.half_lengths[0] + length * np.sin(angle), length), turn @ box.axes, (float(x), float(y)))
    straight, turned = (
        solved(pair, in_box(pair, contact, *grid), load) for grid in (((32, 128), box), ((160, 128), wide))
    )
    # the turned grid has 8 cells across the contact, and its ends are cut askew: 4e-4, falling with the cells
    assert_allclose(turned.approach, straight.approach, rtol=1e-3)
    assert_allclose(turned.pressure.max(), straight.pressure.max(), rtol=0.05)


def test_box_ends_a_cell_beyond_the_tip():
    teeth = cylindrical_mesh((20, 40))
    pair = gear_pair(FlankModifications(lead_crowning=1e-5), teeth=(20, 40))
    end = 2.0 * teeth.pinion.tip_radius
    path = trace_contact(pair, np.linspace(0.0, 1.0, 21) * pair.pitch)
    contact = next(one for one in (path[n] for n in range(21)) if one.on_edge and one.pinion_radius > 0.499 * end)
    separation = sample_separation(pair, contact, cells=(16, 16), load=500.0)
    on_material = np.isfinite(separation.cut_gap).any(axis=1)
    assert not on_material[[0, -1]].all()
    assert on_material.sum() >= 14
    # the tip runs along the border of two cells, to a thousandth of the box; crowning bends it by a tenth of a cell
    cover = separation.cover[on_material]
    assert cover[:, cover.any(axis=0)].min() > 0.85


def test_box_that_its_contact_does_not_fill_is_as_long_either_way():
    """Though the flank ends in it on one side alone: that the contact stops before takes no part in its cells."""
    pair = sam_paper(helix_deg=15.0)
    grid = sample_separation(pair, trace_contact(pair, [0.65 * pair.pitch])[0], cells=(16, 32), load=400.0)
    missing = np.isinf(grid.gap).sum(axis=0)
    assert missing[16:].any()
    assert not missing[:16].any()
    assert_allclose(grid.box.middle, 0.0, atol=1e-9)


def test_grown_box_keeps_the_ends_that_do_not_grow():
    grown = BOX.grown(((False, True), (True, False)), 1.5)
    for axis, moved, kept in ((0, 1.0, -1.0), (1, -1.0, 1.0)):
        length, middle = grown.half_lengths[axis], grown.middle[axis]
        assert_allclose(middle + kept * length, kept * BOX.half_lengths[axis])
        assert_allclose(middle + moved * length, moved * 1.5 * BOX.half_lengths[axis])
    both = BOX.grown(((True, True), (True, True)), 2.0)
    assert (both.half_lengths, both.middle) == ((2.0, 8.0), (0.0, 0.0))


def test_box_holds_what_lies_within_it():
    assert BOX.holds(BOX)
    assert BOX.holds(replace(BOX, half_lengths=(0.5, 1.0), middle=(-0.5, 3.0)))
    assert not BOX.holds(replace(BOX, half_lengths=(0.5, 1.0), middle=(0.6, 0.0)))
    assert not BOX.holds(replace(BOX, half_lengths=(0.5, 4.1)))


def test_box_of_a_grid_is_the_box_it_was_made_in():
    pair, contact, _ = short_relief()
    box = Box((0.3, 2.0), relative_curvature(pair, contact).axes, (0.1, -1.0))
    found = in_box(pair, contact, (6, 10), box).box
    assert_allclose(found.half_lengths, box.half_lengths)
    assert_allclose(found.middle, box.middle)


@pytest.mark.parametrize("load", [100.0, 1000.0, 4000.0])
@pytest.mark.parametrize("cells", [(16, 16), (16, 32), (24, 17)])
def test_contact_point_lies_on_a_border_of_cells(cells, load):
    """Or in the middle of one, if their number is odd."""
    pair, contact, _ = short_relief()
    separation = sample_separation(pair, contact, cells=cells, load=load)
    for places, step, number in zip((separation.x, separation.y), separation.spacing, cells, strict=True):
        borders = places[0] / step - 0.5 * ((number + 1) % 2)
        assert_allclose(borders, np.round(borders), atol=1e-9)  # cells: places are sums of a hundred of them
