"""What tip edges and face ends of both gears add to the deflection of a contact's slices."""

import dataclasses
import math
from functools import cache
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene, sample_separation, trace_contact
from loaded_tca.contact import solve_contact, wedge_factor
from loaded_tca.edges.free import DEPTH, REACHES, edge_compliance, edge_compliances
from loaded_tca.edges.rounded import Columns
from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from tests.samples.gear_pairs import gear_pair
from validation.contact import free_block, free_edge

LOAD = 2700.0
SCENES = Path(__file__).parents[2] / "examples" / "scenes"
FACE_REACH, TIP_REACH = REACHES[2], REACHES[0]


def grid_of(pair, pitches=0.0, cells=(16, 34), **options):
    contact = trace_contact(pair, [pitches * pair.pitch])[0]
    return sample_separation(pair, contact, cells=cells, **(options or {"load": LOAD}))


def added_of(pair, pitches=0.0, **options):
    grid = grid_of(pair, pitches, **options)
    return edge_compliance(pair, grid), grid


def pair_of(widths=(12.0, 12.0), materials=(Material(206000.0, 0.3),) * 2):
    gears = [CylindricalGear(z, 3.0, width) for z, width in zip((34, 57), widths, strict=True)]
    return cylindrical_pair(CylindricalMesh(*gears), materials=materials)


HELIX = math.radians(15.0), -math.radians(15.0)
MIDDLE = 0.75 * math.pi
"""Of teeth of module 3 below their flanks: half the thickness on the pitch circle [mm]."""
ACROSS = 0.06
"""What stands for the width of a contact between teeth of module 3 [mm]."""
NARROW = 1e-3
"""Agreement of slices 0.02 mm wide with the places in their middle, half a millimetre from an edge."""


def displacement(depth, distance, material):
    """Of a half-space under a unit force, by depth and distance from it [mm/N]; Boussinesq."""
    radius, nu = np.hypot(depth, distance), material.poisson_ratio
    whole = (depth**2 / radius**2 + 2.0 * (1.0 - nu)) / radius
    return (1.0 + nu) / (2.0 * math.pi * material.youngs_modulus) * whole


def image_of(angle, distances, apart, reach, material=Material(206000.0, 0.3)):
    """What the image of a unit force in an end adds to a slice, as the documents have it [mm/N].

    psi(S) = psi + 0.4 (S - 0.9) of a quarter-space, scaled with the angle of the material, less the image in the middle
    of the tooth, where S = 1/2; both faded out between the end and its reach.
    """
    here, there = distances
    square = 1.28 + 0.44 * material.poisson_ratio + 3.7 * material.poisson_ratio**2
    radius = np.sqrt((here + there) ** 2 + apart**2 + ACROSS**2)
    fade = math.prod(1.0 - (d / reach) ** 2 * (3.0 - 2.0 * d / reach) for d in distances)
    surface, middle = (displacement(depth, radius, material) for depth in (0.0, MIDDLE))
    varied = (1.0 + 0.4 / square * (place - 0.9) for place in (4.0 * here * there / radius**2, 0.5))
    at_surface, below = varied
    return wedge_factor(angle, material.poisson_ratio) * fade * (at_surface * surface - below * middle)


def added_at(pair, grid, y, width=0.02):
    """Entries of narrow slices at places along a contact [mm/N]."""
    columns = Columns(np.array(y), np.full(len(y), width), grid.origin, grid.axes, np.zeros(len(y)))
    return edge_compliances(pair, [columns])[0]


@cache
def quarter_spaces():
    """Of steel, one twice as large as the other: place S across the edge, and psi there."""
    curves = []
    for farthest, cells in ((80.0, 256), (160.0, 512)):
        with patch.multiple(free_edge, STEP=0.3, FARTHEST=farthest, CELLS_ALONG=cells):
            space = free_edge.quarter_space(0.3, free_edge.graded(), 0.3)
        y, load, row, middle = space.y, np.zeros((space.y.size, cells)), 2, cells // 2
        load[row, middle] = 1.0
        added = space.displacement(load) - free_edge.convolved(space.own, load)
        factor = (added / free_edge.convolved(space.image, load))[row:, middle]
        place = 4.0 * y[row:] * y[row] / (y[row:] + y[row]) ** 2
        curves.append((place[::-1], factor[::-1]))
    return curves


def hetenyis_factor(place):
    """psi(S) by Hetenyi's method.

    Its cells end somewhere, and its loads repeat along the edge: what both change is half as much in a box twice as
    large, and is taken off.
    """
    smaller, larger = (np.interp(place, *curve) for curve in quarter_spaces())
    return 2.0 * larger - smaller


def test_image_counts_less_away_from_its_own_place_as_in_hetenyis_quarter_space():
    """Pairs of places that are as far from each other's images, 2 mm, differ by S alone: from 1 to 0.23."""
    pair, distances = pair_of((40.0, 40.0)), np.array([0.125, 0.5, 1.0, 1.5, 1.875])
    added = added_at(pair, grid_of(pair), distances - 20.0)
    fade = 1.0 - (distances / (3.0 * MIDDLE)) ** 2 * (3.0 - 2.0 * distances / (3.0 * MIDDLE))
    entries = np.array([added[k, -1 - k] / (fade[k] * fade[-1 - k]) for k in (2, 1, 0)])
    factors = entries / (2.0 * displacement(0.0, 2.0, Material(206000.0, 0.3)))  # of both gears, less what is below
    expected = hetenyis_factor([1.0, 0.75, 4.0 * 0.125 * 1.875 / 2.0**2])
    assert_allclose(factors[0] - factors[1:], expected[0] - expected[1:], rtol=0.1)  # a straight line for a curve


def test_entries_beside_an_end_are_those_of_hetenyis_quarter_space():
    """Near the end and far from it, less what they are in the middle of the tooth."""
    pair, distances = pair_of((40.0, 40.0)), np.array([0.25, 0.5, 1.0, 2.0, 4.0])
    added = added_at(pair, grid_of(pair), distances - 20.0)
    steel, radius = Material(206000.0, 0.3), distances[:, None] + distances
    place = 4.0 * distances[:, None] * distances / radius**2
    fade = 1.0 - (distances / (3.0 * MIDDLE)) ** 2 * (3.0 - 2.0 * distances / (3.0 * MIDDLE))
    image = hetenyis_factor(place) * displacement(0.0, radius, steel)
    expected = image - hetenyis_factor(0.5) * displacement(MIDDLE, radius, steel)
    error = added / (2.0 * fade[:, None] * fade) - expected
    assert (np.abs(error) < 0.04 * image).all()  # psi of contacts, which are no points: 3.5 % less


@pytest.mark.thorough
def test_block_with_free_ends_of_finite_elements_deforms_as_the_slices_say():
    rows = [row for row in free_block.rows() if row.tolerance is not None]
    assert len(rows) == 8  # five of an even load, three of a flush contact
    assert all(row.holds for row in rows)


@pytest.mark.thorough
def test_half_space_that_ends_is_none_of_the_block():
    """The comparison can fail: without free edges the deformation at the end is a third too small."""
    without = [row for row in free_block.rows() if "half-space" in row.case]
    assert any(abs(row.obtained - row.expected) > 0.3 * abs(row.expected) for row in without)


def test_ends_of_equal_faces_soften_both_ends_alike():
    added, _ = added_of(pair_of(), box=(0.3, 6.375))
    assert_allclose(added, added.T, rtol=1e-12)  # one number for both
    assert_allclose(added, added[::-1, ::-1], rtol=1e-6, atol=1e-12)  # atol: mm/N, far from both ends, of 1e-5
    assert added[1, 1] > added[2, 2] > 0.0
    assert (np.linalg.eigvalsh(added) > -0.05 * np.linalg.eigvalsh(added)[-1]).all()


def test_slices_may_be_listed_towards_either_end():
    pair = pair_of()
    grid = grid_of(pair, box=(0.3, 6.375))
    turned = Columns(grid.y[::-1], grid.widths[::-1], grid.origin, grid.axes, grid.force_line[::-1])
    forth = Columns(grid.y, grid.widths, grid.origin, grid.axes, grid.force_line)
    added, back = (edge_compliances(pair, [one])[0] for one in (forth, turned))
    assert added.any()
    assert_allclose(back[::-1, ::-1], added, rtol=1e-9, atol=1e-12 * added.max())  # atol: slices far from the end


def test_both_gears_that_end_together_soften_twice_as_much_as_one():
    both, _ = added_of(pair_of(), box=(0.3, 6.375))
    one, _ = added_of(pair_of((12.0, 40.0)), box=(0.3, 6.375))
    assert_allclose(both, 2.0 * one, rtol=1e-9)


@pytest.mark.parametrize("narrower", [0, 1])
def test_end_of_the_narrower_gear_counts_with_its_own_material(narrower):
    """In proportion to (1 - nu^2)/E where the factor is the same: Poisson's ratio is."""
    widths = (12.0, 40.0) if narrower == 0 else (40.0, 12.0)
    steel, bronze = Material(206000.0, 0.3), Material(110000.0, 0.3)
    plain, _ = added_of(pair_of(widths), box=(0.3, 6.375))
    mixed = (steel, bronze) if narrower == 1 else (bronze, steel)
    softer, _ = added_of(pair_of(widths, mixed), box=(0.3, 6.375))
    assert_allclose(softer, plain * 206.0 / 110.0, rtol=1e-9)


def test_reach_does_not_depend_on_box_or_load():
    """Slices of the same places get the same, whatever the box is."""
    pair = pair_of((20.0, 20.0))
    small, large = (added_of(pair, cells=(16, n), box=(width, 0.25 * n))[0] for n, width in ((42, 0.1), (84, 1.0)))
    assert_allclose(large[21:63, 21:63], small, rtol=1e-9)


def test_nothing_is_added_beyond_the_reach_to_the_bit():
    pair = pair_of((20.0, 20.0))
    added, grid = added_of(pair, cells=(16, 42), box=(0.3, 10.5))
    far = 10.0 - np.abs(grid.y) >= FACE_REACH * pair.module
    assert far.any()
    assert not added[far].any()
    crowned = gear_pair(FlankModifications(lead_crowning=0.2), width=60.0)
    assert added_of(crowned, load=10.0)[0] is None


def test_effect_fades_without_a_step():
    """Moved along the face in small steps, a slice feels the end less and less, down to nothing."""
    pair = pair_of((40.0, 40.0))
    fine = [added_of(pair, cells=(16, 402), box=(0.3, 20.1))]
    own = np.diagonal(fine[0][0])[1:200]
    distance = 20.0 - np.abs(fine[0][1].y)[1:200]
    reach = distance < FACE_REACH * pair.module
    assert_allclose(own[~reach], 0.0, atol=0)
    assert np.abs(np.diff(own[distance > 1.0])).max() < 0.06 * own.max()


def test_contact_beyond_reach_is_that_of_the_half_space_to_the_bit():
    pair = gear_pair(FlankModifications(lead_crowning=0.2), width=60.0)
    contact = trace_contact(pair, [0.0])[0]
    plain, free = (
        solve_under_load(pair, contact, 10.0, GridChoice(cells=(16, 16), free_edges=on)) for on in (False, True)
    )
    assert_allclose(free.solution.pressure, plain.solution.pressure, rtol=0, atol=0)


def test_free_ends_take_the_spike_off_a_line_contact():
    """Both gears end together: theory has no spike there, but a pressure that falls towards the end."""
    pair = gear_pair(width=20.0)
    contact = trace_contact(pair, [0.0])[0]
    stiff, free = (
        solve_under_load(pair, contact, LOAD, GridChoice(cells=(16, 130), free_edges=on)) for on in (False, True)
    )
    ends = []
    for loaded in (stiff, free):
        line = loaded.slice_force[loaded.slice_force > 0.0]
        ends.append(max(line[0], line[-1]) / line.mean())
    assert ends[0] > 1.5  # a half-space that ends: a spike that grows with the grid
    assert ends[1] < 1.0
    assert free.solution.approach > stiff.solution.approach
    assert_allclose(free.solution.load, LOAD, rtol=1e-9)


@pytest.mark.parametrize("crowning", [0.0, 0.004])
def test_box_does_not_change_the_contact_deformation(crowning):
    """Boxes of once and twice the length, cells of half a millimetre in both."""
    pair = gear_pair(FlankModifications(lead_crowning=crowning), width=20.0)
    found = []
    for cells in (44, 88):
        grid = grid_of(pair, cells=(48, cells), box=(0.5, 0.25 * cells))
        options = {"load": LOAD, "slice_compliance": edge_compliance(pair, grid), "warn": False}
        found.append(solve_contact(grid.gap, grid.spacing, pair.contact_modulus, **options).approach)
    assert_allclose(found[1], found[0], rtol=1e-5)


def test_toe_and_heel_of_a_straight_bevel_pair_are_ends():
    pair = bevel_pair(bevel_mesh((39, 32), outer_module=2.5, face_width=14.0))
    added, grid = added_of(pair, cells=(16, 60), box=(0.3, 7.5))
    own = np.diagonal(added)
    there = np.flatnonzero(np.isfinite(grid.gap).any(axis=0))
    assert_allclose([grid.y[there[0]], grid.y[there[-1]]], [-7.0, 7.0], atol=0.26)
    assert min(own[there[0]], own[there[-1]]) > 5.0 * own[30]


@pytest.mark.parametrize("end", [-1.0, 1.0])
@pytest.mark.parametrize("widths", [(12.0, 40.0), (40.0, 12.0), (12.0, 12.0)], ids=["pinion", "wheel", "both"])
def test_helical_end_counts_by_the_angle_of_its_material(end, widths):
    """Sharp on one gear where it is blunt on the other: the normal of the flank leans over an end that is sharp."""
    gears = [CylindricalGear(z, 3.0, w, helix_angle=turn) for z, w, turn in zip((34, 57), widths, HELIX, strict=True)]
    pair = cylindrical_pair(CylindricalMesh(*gears))
    contact, grid, distance = trace_contact(pair, [0.0])[0], grid_of(pair), 0.5
    lean = math.asin(contact.normal[2])  # out of the pinion, towards positive z
    assert_allclose(abs(math.sin(lean)), math.sin(HELIX[0]) * math.cos(math.radians(20.0)), rtol=1e-6)
    (added,) = added_at(pair, grid, [(end * (6.0 - distance) - grid.origin[2]) / grid.axes[1, 2]])[0]
    angles = (0.5 * math.pi + end * lean, 0.5 * math.pi - end * lean)
    ending = [angle for angle, width in zip(angles, widths, strict=True) if width == 12.0]
    expected = sum(image_of(angle, (distance, distance), 0.0, 3.0 * MIDDLE) for angle in ending)
    assert_allclose(added, expected, rtol=NARROW)


def test_steepest_helix_is_not_refused():
    assert added_of(gear_pair(width=4.0, helix_deg=59.9), load=50.0)[0] is not None


def test_end_that_is_too_sharp_is_named_with_the_key_that_makes_it_an_edge(monkeypatch):
    monkeypatch.setattr("loaded_tca.contact.edges.SHARPEST", math.radians(80.0))
    told = r"^analysis.free_edges: end of the face at z [<>] 0 of the (pinion|wheel): angle: 7\d\.\d+ degrees is not"
    with pytest.raises(InputError, match=told):
        added_of(gear_pair(helix_deg=15.0))


def test_grids_found_together_are_as_each_alone(monkeypatch):
    """Of other sizes and places, some with no end in reach, and worked on in parts."""
    pair = gear_pair(helix_deg=15.0)
    grids = [
        *(
            grid_of(pair, pitches, cells=cells)
            for pitches, cells in ((-0.7, (16, 9)), (0.0, (16, 34)), (0.8, (16, 16)))
        ),
        grid_of(pair, box=(0.3, 1.0)),
    ]
    alone = [edge_compliance(pair, grid) for grid in grids]
    monkeypatch.setattr("loaded_tca.edges.free.PAIRS", 50)
    together = edge_compliances(pair, grids)
    assert [one is None for one in together] == [False, False, False, True]
    for found, expected in zip(together[:3], alone[:3], strict=True):
        assert_allclose(found, expected, rtol=1e-12, atol=1e-18)  # factors of the same matrix; atol: where it is zero


def test_end_that_is_too_sharp_is_told_of_its_own_grid_alone(monkeypatch):
    pair = gear_pair(helix_deg=15.0)
    sharp, inside = grid_of(pair), grid_of(pair, box=(0.3, 1.0))
    monkeypatch.setattr("loaded_tca.contact.edges.SHARPEST", math.radians(80.0))
    before, told, after = edge_compliances(pair, [inside, sharp, inside])
    assert before is None
    assert after is None
    assert isinstance(told, InputError)


TIPS = [(0.75, 0), (-0.78, 1)]
"""Pitches at which a spur contact is beside the tip of the pinion, or of the wheel."""


def beside_a_tip(pitches, member, **modified):
    """A wide spur pair, its contact, the distance from the tip of a member and the angle of its material there.

    That is a right angle and the pressure angle, at the contact instead of at the tip itself.
    """
    pair = gear_pair(width=60.0, **modified)
    contact = trace_contact(pair, [pitches * pair.pitch])[0]
    base, tip = 0.5 * 3.0 * (34, 57)[member] * math.cos(math.radians(20.0)), 0.5 * 3.0 * (36, 59)[member]
    radius = (contact.pinion_radius, contact.wheel_radius)[member]
    return pair, contact, tip - radius, 0.5 * math.pi + math.acos(base / radius)


@pytest.mark.parametrize(("pitches", "member"), TIPS)
def test_tip_counts_by_the_angle_of_its_material(pitches, member):
    """It is blunt: the land is at more than a right angle to the flank."""
    pair, contact, distance, angle = beside_a_tip(pitches, member)
    assert 0.2 < distance < 0.5 * TIP_REACH * pair.module
    y = np.array([-2.0, -1.5, 0.0, 0.25])
    added = added_at(pair, sample_separation(pair, contact, cells=(16, 16), load=LOAD), y)
    expected = image_of(angle, (distance, distance), y[:, None] - y, 0.5 * pair.module)
    assert_allclose(added, expected, rtol=0, atol=NARROW * expected.max())


@pytest.mark.thorough
def test_tip_comes_into_reach_without_a_step():
    pair = gear_pair(FlankModifications(lead_crowning=0.03), width=60.0)
    found = [added_of(pair, pitches, box=(0.1, 9.0))[0] for pitches in np.linspace(0.35, 0.85, 101)]
    means = np.array([0.0 if added is None else added.mean() for added in found])
    assert means[0] == 0.0
    assert (np.diff(means) >= -1e-3 * means[-1]).all()  # on the tip it stays
    assert np.diff(means).max() < 0.15 * means[-1]


def test_roots_are_no_edges():
    """Where the pinion is in contact with its root there is the wheel's tip alone: the fillet goes on."""
    pair = gear_pair(FlankModifications(lead_crowning=0.03), width=60.0)
    contact = trace_contact(pair, [-0.85 * pair.pitch])[0]
    assert contact.pinion_radius - pair.pinion.nominal_flank.radii[0] < 0.2 * pair.module
    soft = dataclasses.replace(pair.pinion, material=Material(103000.0, 0.3))
    added = [added_of(dataclasses.replace(pair, pinion=one), -0.85, box=(0.1, 9.0))[0] for one in (pair.pinion, soft)]
    assert_allclose(added[1], added[0], rtol=1e-12)  # the pinion's material does not enter


@pytest.mark.parametrize(("pitches", "member"), TIPS)
def test_tip_that_is_free_takes_up_the_energy_of_its_slices(pitches, member):
    """f' C f/2, between what it is for the forces f of slices on a half-space and on one that ends."""
    pair, contact, distance, angle = beside_a_tip(pitches, member, pinion=FlankModifications(lead_crowning=0.03))
    stiff, free = (
        solve_under_load(pair, contact, 100.0, GridChoice(cells=(48, 16), free_edges=on)) for on in (False, True)
    )
    assert_allclose(free.solution.load, 100.0, rtol=1e-9)
    y, width = stiff.separation.y, stiff.separation.spacing[1]
    assert_allclose(free.separation.y, y, rtol=1e-9)
    nodes, weights = np.polynomial.legendre.leggauss(9)
    within = y + 0.5 * width * nodes[:, None]  # means over the slices, displaced and loaded
    entries = image_of(angle, (distance, distance), within[:, None, :, None] - within[:, None], 0.5 * pair.module)
    added = np.einsum("a,b,abij->ij", 0.5 * weights, 0.5 * weights, entries)
    less, more = (0.5 * force @ added @ force for force in (free.slice_force, stiff.slice_force))
    assert 0.0 < less < more < 1.05 * less
    # the package has means over slices half a millimetre wide at three places of each
    assert 0.99 * less < energy(free) - energy(stiff) < 1.01 * more


def energy(loaded):
    """Of a contact, that of the gap included, whose slope is the approach [N mm]; the elastic one is half of p' K p."""
    solution, pressed = loaded.solution, loaded.solution.pressure > 0.0
    closed = loaded.separation.gap[pressed] @ solution.pressure[pressed] * solution.cell_area
    return 0.5 * (solution.approach * solution.load + closed)


def test_lightest_contact_beside_a_tip_is_solved():
    pair = gear_pair(helix_deg=15.0)
    contact = trace_contact(pair, [0.75 * pair.pitch])[0]
    loaded = solve_under_load(pair, contact, 1e-6, GridChoice(cells=(16, 16), free_edges=True))
    assert_allclose(loaded.solution.load, 1e-6, rtol=1e-9)


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("name", ["helical", "straight_bevel", "spiral_bevel", "face_milled_19x62"])
def test_free_edges_of_every_kind_of_gear_leave_a_positive_definite_contact(name):
    """Through mesh, on edges and off: the slices of the half-space alone, in closed form, and what is added."""
    pair = read_scene(SCENES / f"{name}.toml").pair()
    for contact in trace_contact(pair, np.linspace(-0.9, 0.9, 5) * pair.pitch, warn=False):
        grid = sample_separation(pair, contact, cells=(16, 24), load=300.0)
        if (added := edge_compliance(pair, grid)) is None:
            continue
        (dx, dy), apart = grid.spacing, np.abs(grid.y[:, None] - grid.y)
        own = np.arcsinh((apart + 0.5 * dy) / (8.0 * dx)) - np.arcsinh((apart - 0.5 * dy) / (8.0 * dx))
        half_space = own / (math.pi * pair.contact_modulus * dy)  # of a line 16 cells wide
        assert np.linalg.eigvalsh(half_space + added).min() > 0.0
        assert np.isfinite(added).all()


def test_depth_is_half_a_tooth_on_the_pitch_circle():
    assert_allclose(DEPTH, 0.5 * (0.5 * math.pi))  # the pitch is pi modules, half of it tooth
