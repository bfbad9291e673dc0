"""Free edges of a contact from tips and sides of both gears: where they lie, and what they do to the pressure."""

import dataclasses
import math
import warnings
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, read_scene, sample_separation, trace_contact
from loaded_tca.contact.edges import quarter_space_factor, wedge_factor
from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.loaded.free_edges import oblique_ends, tooth_edges
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from tests.samples.gear_pairs import gear_pair

LOAD = 2700.0
SCENES = Path(__file__).parents[2] / "examples" / "scenes"


def edges_of(pair, load=LOAD, cells=(16, 16), pitches=0.0):
    contact = trace_contact(pair, [pitches * pair.pitch])[0]
    separation = sample_separation(pair, contact, cells=cells, load=load)
    return tooth_edges(pair, contact, separation), separation


def test_sides_of_equal_faces_are_one_edge_at_either_end():
    edges, separation = edges_of(gear_pair(width=12.0))
    middle = 0.5 * separation.gap.shape[1] * separation.spacing[1]
    assert [edge.axis for edge in edges] == [1, 1]
    assert {edge.material for edge in edges} == {"below", "above"}
    for edge in edges:
        assert_allclose(abs(edge.position - middle), 6.0, atol=1e-9)
        assert_allclose(edge.factor, quarter_space_factor(0.3))


def test_side_of_one_gear_alone_counts_with_its_share_of_the_compliance():
    gears = [CylindricalGear(z, 3.0, width) for z, width in ((34, 12.0), (57, 15.0))]
    edges, _ = edges_of(cylindrical_pair(CylindricalMesh(*gears)))
    assert_allclose([edge.factor for edge in edges], 0.5 * quarter_space_factor(0.3))
    assert len(edges) == 4  # the pinion's two, and the wheel's two 1.5 mm farther out


@pytest.mark.parametrize("narrower", [0, 1])
def test_side_of_the_narrower_gear_counts_with_its_own_material(narrower):
    """Its share of the compliance is (1 - nu^2)/E over the sum of both; the free end follows its own nu."""
    widths = (12.0, 15.0) if narrower == 0 else (15.0, 12.0)
    gears = [CylindricalGear(z, 3.0, width) for z, width in zip((34, 57), widths, strict=True)]
    constants = (206000.0, 0.3), (110000.0, 0.34)
    materials = tuple(Material(*one) for one in constants)
    edges, separation = edges_of(cylindrical_pair(CylindricalMesh(*gears), materials=materials))
    middle = 0.5 * separation.gap.shape[1] * separation.spacing[1]
    inner = sorted(edges, key=lambda edge: abs(edge.position - middle))[:2]
    yielding = [(1.0 - nu**2) / modulus for modulus, nu in constants]
    share, nu = yielding[narrower] / sum(yielding), constants[narrower][1]
    assert_allclose([edge.factor for edge in inner], share * quarter_space_factor(nu))


def test_sides_out_of_reach_of_the_contact_are_left_out():
    edges, _ = edges_of(gear_pair(FlankModifications(lead_crowning=0.2), width=60.0), load=10.0)
    assert edges == ()


@pytest.mark.parametrize("helix_deg", [0.0, 15.0, -15.0])
def test_edges_lie_where_the_material_of_the_grid_ends(helix_deg):
    pair = gear_pair(width=8.0, helix_deg=helix_deg)
    edges, separation = edges_of(pair, cells=(16, 64))
    there = np.flatnonzero(np.isfinite(separation.gap[separation.gap.shape[0] // 2]))
    step = separation.spacing[1]
    ends = sorted(edge.position for edge in edges)
    assert_allclose(ends, [there[0] * step, (there[-1] + 1) * step], atol=1.01 * step)


def test_sides_that_yield_take_the_spike_off_the_ends_of_a_line_contact():
    """Both gears end together: theory has no spike there, but a pressure that falls towards the side."""
    pair = gear_pair(width=8.0)
    contact = trace_contact(pair, [0.0])[0]
    grid = GridChoice(cells=(16, 64))
    stiff, yielding = (
        solve_under_load(pair, contact, LOAD, dataclasses.replace(grid, free_edges=on)) for on in (False, True)
    )
    ends = []
    for loaded in (stiff, yielding):
        line = loaded.solution.pressure.max(axis=0)
        line = line[line > 0.0]
        ends.append(max(line[0], line[-1]) / line[len(line) // 2])
    assert ends[0] > 1.05  # a half-space that ends: a spike that grows with the grid
    assert ends[1] < 1.0
    assert yielding.solution.approach > stiff.solution.approach
    assert_allclose(yielding.solution.load, LOAD, rtol=1e-9)


def test_contact_away_from_the_sides_does_not_feel_them():
    pair = gear_pair(FlankModifications(lead_crowning=0.2), width=60.0)
    contact = trace_contact(pair, [0.0])[0]
    plain, free = (
        solve_under_load(pair, contact, 10.0, GridChoice(cells=(16, 16), free_edges=on)) for on in (False, True)
    )
    assert_allclose(free.solution.pressure, plain.solution.pressure, rtol=0, atol=0)


def test_toe_and_heel_of_a_straight_bevel_pair_are_edges():
    pair = bevel_pair(bevel_mesh((39, 32), outer_module=2.5, face_width=14.0))
    edges, separation = edges_of(pair, load=1500.0)
    middle = 0.5 * separation.gap.shape[1] * separation.spacing[1]
    assert_allclose(sorted(edge.position - middle for edge in edges), [-7.0, 7.0], atol=0.02)


def test_sides_of_helical_teeth_count_with_their_sharp_and_blunt_angles():
    """One gear ends there at a right angle plus, the other at one minus the base helix angle."""
    pair = gear_pair(width=8.0, helix_deg=15.0)
    edges, _ = edges_of(pair)
    turn = abs(pair.pinion.flank.base_helix_angle)
    both = sum(0.5 * wedge_factor(0.5 * math.pi + sign * turn, 0.3) for sign in (1.0, -1.0))
    assert_allclose([edge.factor for edge in edges], both)
    assert both > quarter_space_factor(0.3)


def test_steepest_helix_is_not_refused():
    pair = gear_pair(width=4.0, helix_deg=59.9)
    assert len(edges_of(pair, load=50.0)[0]) > 0


def tips_of(pair, pitches, **options):
    edges, separation = edges_of(pair, pitches=pitches, **options)
    return [edge for edge in edges if edge.axis == 0], separation


def tip_factor(pair, member):
    """Half the compliance, at a right angle and the pressure angle at the tip."""
    flank = (pair.pinion.flank, pair.wheel.flank)[member]
    return 0.5 * wedge_factor(0.5 * math.pi + math.acos(flank.base_radius / flank.radii[1]), 0.3)


@pytest.mark.parametrize(("pitches", "member"), [(0.82, 0), (-0.86, 1)])
def test_tip_of_a_spur_gear_is_an_edge_along_the_contact(pitches, member):
    pair = gear_pair()
    (edge,), separation = tips_of(pair, pitches, cells=(64, 16))
    assert_allclose(edge.factor, tip_factor(pair, member), rtol=1e-9)
    material = np.flatnonzero(np.isfinite(separation.gap).any(axis=1))
    ends = {"below": material[-1] + 1, "above": material[0]}
    assert 0 < ends[edge.material] < 64, "the tip lies in the box"
    # the grid tells it to a cell
    assert_allclose(edge.position / separation.spacing[0], ends[edge.material], atol=1.0)


def test_tips_of_equal_gears_are_mirrored_at_mirrored_positions():
    pair = gear_pair(teeth=(30, 30))
    (pinion,), separation = tips_of(pair, 0.7)
    (wheel,), _ = tips_of(pair, -0.7)
    assert_allclose(pinion.factor, wheel.factor, rtol=1e-9)
    middle = 0.5 * separation.gap.shape[0] * separation.spacing[0]
    assert_allclose(pinion.position - middle, middle - wheel.position, rtol=1e-6)
    assert {pinion.material, wheel.material} == {"below", "above"}


def test_tip_comes_into_reach_without_a_step():
    """From half a module on its factor grows, to all of it at a quarter."""
    pair = gear_pair()
    positions = np.linspace(0.4, 0.75, 15)
    factors = [sum(edge.factor for edge in tips_of(pair, q)[0]) for q in positions]
    assert factors[0] == 0.0
    assert (np.diff(factors) >= -1e-12).all()
    assert max(np.diff(factors)) < 0.3 * factors[-1]
    assert_allclose(factors[-1], tip_factor(pair, 0), rtol=1e-9)


def test_reach_of_a_tip_is_that_of_the_module_not_of_the_box():
    pair = gear_pair()
    (small,), _ = tips_of(pair, 0.6, load=400.0)
    (large,), _ = tips_of(pair, 0.6, load=2000.0)
    assert_allclose(small.factor, large.factor, rtol=1e-9)


@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
def test_lightest_contacts_do_not_reach_for_far_images(helix_deg):
    """A contact of nanometres beside a tip at tenths of a millimetre: not millions of cells."""
    pair = gear_pair(helix_deg=helix_deg)
    contact = trace_contact(pair, [0.75 * pair.pitch])[0]
    loaded = solve_under_load(pair, contact, 1e-6, GridChoice(cells=(16, 16), free_edges=True))
    assert_allclose(loaded.solution.load, 1e-6, rtol=1e-9)


def test_roots_are_no_edges():
    """Where the pinion touches with its root there is the wheel's tip alone: the fillet goes on."""
    pair = gear_pair()
    contact = trace_contact(pair, [-0.85 * pair.pitch])[0]
    assert contact.pinion_radius - pair.pinion.flank.radii[0] < 0.2 * pair.module
    tips, _ = tips_of(pair, -0.85)
    assert_allclose([edge.factor for edge in tips], tip_factor(pair, 1), rtol=1e-9)


@pytest.mark.parametrize("pitches", [0.82, 0.9])
def test_tip_that_yields_lowers_the_pressure_and_lets_the_teeth_approach(pitches):
    """Beside the tip and on it; crowned and wide, so that no side is in reach."""
    pair = gear_pair(FlankModifications(lead_crowning=0.03), width=40.0)
    contact = trace_contact(pair, [pitches * pair.pitch])[0]
    grid = GridChoice(cells=(48, 16))
    stiff, yielding = (
        solve_under_load(pair, contact, 100.0, dataclasses.replace(grid, free_edges=on)) for on in (False, True)
    )
    (edge,) = yielding.solution.problem.free_edges
    assert edge.axis == 0
    assert yielding.solution.pressure.max() < stiff.solution.pressure.max()
    assert yielding.solution.approach > 1.05 * stiff.solution.approach
    assert_allclose(yielding.solution.load, 100.0, rtol=1e-9)


def test_face_cone_of_a_straight_bevel_gear_is_an_edge():
    pair = bevel_pair(bevel_mesh((39, 32), outer_module=2.5, face_width=14.0))
    tips, _ = tips_of(pair, 0.85, load=100.0)
    assert len(tips) == 1
    # material between 105 and 125 degrees, half the compliance
    assert 0.5 * wedge_factor(math.radians(125.0), 0.3) < tips[0].factor < 0.5 * wedge_factor(math.radians(105.0), 0.3)


@pytest.mark.parametrize(("pitches", "member", "helix_deg"), [(0.6, 0, 15.0), (0.9, 0, -15.0), (-0.8, 1, 25.0)])
def test_tip_of_a_helical_gear_crosses_the_contact_where_its_material_ends(pitches, member, helix_deg):
    pair = gear_pair(helix_deg=helix_deg)
    (edge,), separation = tips_of(pair, pitches, cells=(64, 48))
    flank, spacing = (pair.pinion.flank, pair.wheel.flank)[member], separation.spacing
    # normal of the helicoid and of the tip cylinder: cos(beta_b) sin(transverse pressure angle at the tip)
    leaning = math.cos(flank.base_helix_angle) * math.sin(math.acos(flank.base_radius / flank.radii[1]))
    assert_allclose(edge.factor, 0.5 * wedge_factor(math.acos(-leaning), 0.3), rtol=1e-9)
    material = np.isfinite(separation.gap)
    place = (edge.position + edge.slope * (np.arange(48) + 0.5) * spacing[1]) / spacing[0]
    ends = material.sum(axis=0) if edge.material == "below" else 64 - material.sum(axis=0)
    cut = material.any(axis=0) & ~material.all(axis=0)
    assert cut.sum() > 3
    # a cell, and the tip cylinder is no plane over some millimetres
    assert_allclose(place[cut], ends[cut], atol=2.0)


def test_tip_of_a_helical_gear_that_yields_lowers_the_pressure_and_lets_the_teeth_approach():
    pair = gear_pair(FlankModifications(lead_crowning=0.03), helix_deg=15.0, width=40.0)
    contact = trace_contact(pair, [0.9 * pair.pitch])[0]
    grid = GridChoice(cells=(32, 32))
    stiff, yielding = (
        solve_under_load(pair, contact, 300.0, dataclasses.replace(grid, free_edges=on)) for on in (False, True)
    )
    assert [edge.axis for edge in yielding.solution.problem.free_edges] == [0]
    assert yielding.solution.pressure.max() < stiff.solution.pressure.max()
    assert yielding.solution.approach > 1.03 * stiff.solution.approach
    assert_allclose(yielding.solution.load, 300.0, rtol=1e-9)


def test_tip_is_in_reach_where_the_end_of_a_long_contact_reaches_it():
    """The middle of the line is far below the tip, beyond the reach of an edge along it."""
    pair = gear_pair(helix_deg=20.0, width=60.0)
    contact = trace_contact(pair, [0.3 * pair.pitch])[0]
    assert pair.pinion.flank.radii[1] - contact.pinion_radius > 0.5 * pair.module
    (edge, *_), separation = tips_of(pair, 0.3, cells=(16, 64))
    assert np.isinf(separation.gap).any()
    assert edge.slope != 0.0


@pytest.mark.parametrize("name", ["helical", "straight_bevel", "spiral_bevel", "face_milled_19x62"])
def test_edges_stand_or_are_named_for_every_kind_of_gear(name):
    """Nothing is refused on the way through mesh."""
    pair = read_scene(SCENES / f"{name}.toml").pair()
    for contact in trace_contact(pair, np.linspace(-0.9, 0.9, 5) * pair.pitch, warn=False):
        separation = sample_separation(pair, contact, cells=(16, 16), load=300.0)
        edges = tooth_edges(pair, contact, separation)
        assert all(0.0 < edge.factor < 20.0 for edge in edges)
        assert not any("root" in end for end in oblique_ends(pair, contact, separation))


def test_end_that_is_too_sharp_is_named_with_the_key_that_makes_it_an_edge(monkeypatch):
    monkeypatch.setattr("loaded_tca.contact.edges.SHARPEST", math.radians(80.0))
    told = r"^analysis.free_edges: end of the face at z [<>] 0 of the (pinion|wheel): angle: 7\d\.\d+ degrees is not"
    with pytest.raises(InputError, match=told):
        edges_of(gear_pair(helix_deg=15.0))


def test_end_that_no_edge_stands_for_is_told(monkeypatch):
    monkeypatch.setattr("loaded_tca.results.warnings.oblique_ends", lambda *_: ("toe of the pinion",))
    scene = read_scene(SCENES / "helical.toml").with_changes(
        {"analysis.free_edges": True, "analysis.positions": 3, "analysis.cells": (16, 16)}
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        analyse(scene)
    assert any("the toe of the pinion is oblique to the contact" in str(sentence.message) for sentence in caught)


def test_ends_turned_between_the_axes_are_left_out_and_named():
    pair = gear_pair(width=8.0)
    contact = trace_contact(pair, [0.0])[0]
    separation = sample_separation(pair, contact, cells=(16, 16), load=LOAD)
    turn = math.radians(45.0)
    rotation = np.array([[math.cos(turn), math.sin(turn), 0.0], [-math.sin(turn), math.cos(turn), 0.0], [0, 0, 1.0]])
    turned = dataclasses.replace(separation, axes=rotation @ separation.axes)
    assert tooth_edges(pair, contact, turned) == ()
    sides = {f"end of the face at z {where} of the {gear}" for where in ("< 0", "> 0") for gear in ("pinion", "wheel")}
    assert sides <= set(oblique_ends(pair, contact, turned))
