"""The torque shared over the tooth pairs: balance, compatibility, energy, limits and symmetry."""

import itertools
import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from loaded_tca import read_scene
from loaded_tca.compliance.model import BendingModel
from loaded_tca.errors import ConvergenceError
from loaded_tca.flanks import FlankModifications
from loaded_tca.loaded.cycle import OnePairsCycle, in_gear_angles
from loaded_tca.loaded.load_sharing import share_load
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.loaded.tooth_pairs import ToothPair, tooth_pairs_at
from loaded_tca.material import Material
from loaded_tca.separation import sample_separation
from loaded_tca.separation.sample import sample_separations
from loaded_tca.unloaded import trace_contact, trace_teeth
from loaded_tca.unloaded.path import contact_span, trace_near
from tests.refusals import refused_calls
from tests.samples.gear_pairs import NONE, gear_pair, sam_paper
from tests.samples.results import FLANKS_ALONE, SCENES
from tests.samples.tangents import torque_rate
from validation.invariances import state_alone
from validation.scene_transforms import exchanged

TORQUE = 130e3
GRID = GridChoice(cells=(24, 24))
EQUILIBRIUM = 1e-8
"""Asked for: the torques of the pairs sum up to that of the pinion."""
COMPATIBLE = 1e-5
"""Agreement of the rotations where the cells are given."""
NEAR_HALF = 0.03
"""Asked for: how far the sharing of a spur pair without crowning may be from half and half."""
CENTRE = math.pi / 34


@cache
def shared(pair_of, phi1, torque=TORQUE, bending=None):
    pair = pair_of()
    more = {} if bending is None else {"bending": bending}
    return share_load(pair, tooth_pairs_at(trace_teeth(pair, [phi1]), 0), torque, GRID, **more)


def spur():
    return sam_paper()


def helical():
    return sam_paper(helix_deg=15.0)


def uncrowned_spur():
    return gear_pair(NONE, NONE)


def uncrowned_helical():
    return gear_pair(NONE, NONE, helix_deg=15.0)


POSITIONS = (-0.9 * CENTRE, -0.3 * CENTRE, 0.0, 0.5 * CENTRE)


@pytest.mark.parametrize("pair_of", [spur, helical])
@pytest.mark.parametrize("phi1", POSITIONS)
def test_pressures_balance_the_torque(pair_of, phi1):
    total = 0.0
    for share in shared(pair_of, phi1).shares:
        solution = share.loaded.solution
        total += solution.pressure.sum() * solution.cell_area * share.tooth_pair.contact.pinion_lever
    assert_allclose(total, TORQUE, rtol=EQUILIBRIUM)


@pytest.mark.parametrize("pair_of", [spur, helical])
@pytest.mark.parametrize("phi1", POSITIONS)
def test_loaded_pairs_ask_for_one_rotation_and_the_others_are_apart(pair_of, phi1):
    found, pair = shared(pair_of, phi1), pair_of()
    assert_allclose([share.rotation for share in found.shares], found.rotation, rtol=COMPATIBLE)
    assert found.residual <= COMPATIBLE
    loaded = {share.tooth_pair.pair for share in found.shares}
    for tooth_pair in tooth_pairs_at(trace_teeth(pair, [phi1]), 0):
        assert (tooth_pair.pair in loaded) == (tooth_pair.initial_separation < found.rotation)


def test_two_pairs_of_a_symmetric_position_carry_one_half_each():
    pair = gear_pair(FlankModifications(lead_crowning=0.005), NONE, teeth=(30, 30))
    found = share_load(pair, tooth_pairs_at(trace_teeth(pair, [0.5 * pair.pitch]), 0), TORQUE, GRID)
    assert [share.tooth_pair.pair for share in found.shares] == [0, 1]
    assert_allclose([share.torque / TORQUE for share in found.shares], 0.5, atol=1e-6)


@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")
@pytest.mark.parametrize("phi1", [-0.95 * CENTRE, -0.7 * CENTRE, 0.8 * CENTRE])
def test_spur_pairs_without_crowning_carry_nearly_one_half_each(phi1):
    found = shared(uncrowned_spur, phi1)
    assert len(found.shares) == 2
    assert_allclose([share.torque / TORQUE for share in found.shares], 0.5, atol=NEAR_HALF)


LENGTHS = 0.02
"""Ends of the lines, oblique at the tips, are a little stiffer than the formula of a long line has them."""


@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")
@pytest.mark.parametrize("part", [-0.5, 0.8])
def test_helical_pairs_without_crowning_share_by_the_lengths_of_their_lines(part):
    """A line of length l and width w deforms by F/l (ln(4 l/w) - 1) times the same for all."""
    found = shared(uncrowned_helical, part * CENTRE)
    lengths = np.array([np.linalg.norm(np.diff(share.tooth_pair.contact.line_ends, axis=0)) for share in found.shares])
    widths = [share.loaded.extent[0] for share in found.shares]
    stiffness = lengths / (np.log(4.0 * lengths / widths) - 1.0)
    assert len(lengths) == 2
    assert_allclose([share.torque / TORQUE for share in found.shares], stiffness / stiffness.sum(), atol=LENGTHS)


def elastic_energy(found):
    """Half the work of the pressures over the displacements [N mm]."""
    energy = 0.0
    for share in found.shares:
        solution = share.loaded.solution
        loaded = solution.in_contact
        displacement = solution.approach + solution.gap[loaded] - solution.problem.gap[loaded]
        energy += 0.5 * float(solution.pressure[loaded] @ displacement) * solution.cell_area
    return energy


@pytest.mark.thorough
def test_torque_is_the_derivative_of_the_elastic_energy_along_the_rotation():
    """The wheel turns against a pinion that stands: its torque is that of the pinion over the ratio."""
    phi1, step = -0.3 * CENTRE, 0.02
    pair = helical()
    tooth_pairs, grid = tooth_pairs_at(trace_teeth(pair, [phi1]), 0), GridChoice(cells=(48, 48))
    low, high = (share_load(pair, tooth_pairs, (1.0 + sign * step) * TORQUE, grid) for sign in (-1, 1))
    slope = (elastic_energy(high) - elastic_energy(low)) / (high.rotation - low.rotation)
    assert_allclose(slope, TORQUE / pair.ratio, rtol=5e-3)  # grids of two loads differ by about 1e-3


@pytest.mark.parametrize("raised", [-0.004, 0.02])
def test_zero_from_which_gaps_count_moves_no_force(raised, monkeypatch):
    """A distance [mm] between the initial separation and the gaps of a pair: grids that grow touch below their zero."""
    pair = spur()
    first, *others = tooth_pairs_at(trace_teeth(pair, [0.8 * CENTRE]), 0)
    expected = [share.force for share in shared(spur, 0.8 * CENTRE).shares]
    moved = replace(first, initial_separation=first.initial_separation - raised / first.contact.wheel_lever)

    def sampled(pair_of, contacts, **options):
        for contact, grid in zip(contacts, sample_separations(pair_of, contacts, **options), strict=True):
            of_first = abs(contact.pinion_angle - first.contact.pinion_angle) < 0.5 * pair.pitch
            by = raised if of_first else 0.0
            yield replace(grid, gap=grid.gap + by, cut_gap=grid.cut_gap + by)

    at_once = "loaded_tca.loaded.together.sample_separations"
    monkeypatch.setattr(at_once, lambda *given, **options: list(sampled(*given, **options)))
    forces = [share.force for share in share_load(pair, [moved, *others], TORQUE, GRID).shares]
    assert len(forces) == 2
    assert_allclose(forces, expected, rtol=10.0 * COMPATIBLE)


@pytest.mark.parametrize(("pitches", "allowed"), [(-0.25, 4e-4), (0.4, 1.5e-4)])
def test_pinion_and_wheel_in_each_others_place_stand_to_each_other_as_before(pitches, allowed):
    """At first a tip carries more than a third beyond the path of contact.

    Contacts traced with the wheel alone turned back differ by 1e-3 at the tip, and peaks elsewhere by 4e-4. What is
    left is of third order in the way at the tip, elsewhere a quarter: the first guess of the way is too short.
    """
    scene = read_scene(SCENES / "fzg_c14.toml").with_changes({**FLANKS_ALONE, "analysis.cells": (24, 24)})
    ratio, (torque,) = scene.pair().ratio, scene.torques
    angle = pitches * scene.pair().pitch
    seen, _, torque = state_alone(exchanged(scene), ratio * angle, torque / ratio)
    here, unloaded, _ = state_alone(scene, angle + seen.rotation, torque)
    assert min(here.forces.values()) > 0.3 * sum(here.forces.values())
    rotation, force, peak = here.differences(seen._replace(rotation=-unloaded - ratio * seen.rotation))
    assert rotation < allowed * abs(here.rotation)
    assert force < allowed * sum(here.forces.values())
    assert peak < allowed * max(here.peaks.values())


@pytest.mark.parametrize("before", [True, False])
def test_tip_at_the_middle_of_its_way_overlaps_an_involute_by_the_base_radius_times_the_turn(before):
    """Of the gear on whose flank the tip of the other one runs, back to where they just touch."""
    pair, way = read_scene(SCENES / "fzg_c14.toml").pair(), 1e-3
    at_root, at_tip = contact_span(pair)
    angle = at_root.pinion_angle - 0.02 if before else at_tip.pinion_angle + 0.02
    first = trace_contact(pair, [angle], warn=False)[0]
    ratio = first.wheel_lever / first.pinion_lever
    middle = trace_near(pair, [first], [angle - 0.5 * way * ratio])
    tooth_pair = ToothPair(0, first, 0.0).at_middle(middle[0])

    def beyond(turned):
        path = trace_contact(pair, [turned], warn=False)
        return path.wheel_angle[0] - first.wheel_angle + way

    turned = angle - brentq(beyond, angle - 3.0 * way * ratio, angle)
    exact = pair.base_radii[0] * turned if before else pair.base_radii[1] * way
    off = abs(tooth_pair.contact.wheel_lever * way - exact)
    assert off < (
        0.01 * abs(first.wheel_lever * way - exact) if before else 1e-12
    )  # of the other flank it is third order


def test_small_torque_tends_to_the_unloaded_contact():
    pair = helical()
    tooth_pairs = tooth_pairs_at(trace_teeth(pair, [0.2 * CENTRE]), 0)
    rotations = [share_load(pair, tooth_pairs, torque, GRID).rotation for torque in (0.0, 1e-2, 1e2)]
    assert rotations[0] == 0.0
    assert rotations[0] < rotations[1] < rotations[2]
    assert rotations[1] * pair.base_radii[1] < 1e-6


def test_more_pairs_carry_load_as_it_grows():
    pair = helical()
    tooth_pairs = tooth_pairs_at(trace_teeth(pair, [0.0]), 0)
    counts = [len(share_load(pair, tooth_pairs, torque, GRID).shares) for torque in (1e2, 2e4, 13e4)]
    assert counts[0] == 1
    assert counts == sorted(counts)
    assert counts[-1] == 3


def test_tangent_of_the_torque_is_that_of_neighbouring_torques():
    pair = helical()
    tooth_pairs, grid = tooth_pairs_at(trace_teeth(pair, [-0.6 * CENTRE]), 0), GridChoice(cells=(48, 48))
    low, here, high = (share_load(pair, tooth_pairs, factor * TORQUE, grid) for factor in (0.9, 1.0, 1.1))
    chord = (high.torque - low.torque) / (high.rotation - low.rotation)
    assert_allclose(torque_rate(here), chord, rtol=2e-2)  # contacts that end at an edge grow by whole cells


def test_pairs_apart_are_not_closed_by_the_rotation():
    """What the first balance, without the springs, leaves apart comes under load as these give way."""
    pair, torque, own = helical(), 300.0, 1e-3
    tooth_pairs = tooth_pairs_at(trace_teeth(pair, [0.0]), 0)
    assert len(share_load(pair, tooth_pairs, torque, GRID).shares) == 1
    found = share_load(pair, tooth_pairs, torque, GRID, bending=Springs(own))
    assert len(found.shares) == 3
    loaded = {share.tooth_pair.pair for share in found.shares}
    for tooth_pair in tooth_pairs:
        assert (tooth_pair.initial_separation < found.rotation) == (tooth_pair.pair in loaded)


@pytest.mark.parametrize("torque", [1e-13, 1e-9, 1e-6])
@pytest.mark.parametrize("springs", [None, (2e-6, 1e-6)])
def test_next_to_no_torque_is_carried_by_the_leading_pair(torque, springs):
    pair = helical()
    tooth_pairs = tooth_pairs_at(trace_teeth(pair, [0.2 * CENTRE]), 0)
    bending = None if springs is None else Springs(*springs)
    found = share_load(pair, tooth_pairs, torque, GRID, bending=bending)
    assert len(found.shares) == 1
    assert 0.0 <= found.rotation < 1e-8
    assert torque_rate(found, bending) >= 0.0


@pytest.mark.parametrize("torque", [1e-297, 1e-9, 1e-6])
@pytest.mark.parametrize("pair_of", [spur, uncrowned_helical])
def test_next_to_no_torque_is_none(pair_of, torque):
    """Two pairs in contact, whose gaps are rounding: 1e-300, 1e-12 and 1e-9 N m did not converge, or overflowed."""
    found = shared(pair_of, -0.9 * CENTRE, torque)
    assert found.torque == found.rotation == torque_rate(found) == 0.0
    assert [share.force for share in found.shares] == [0.0]


@pytest.mark.parametrize("torque", [1e-4, 1e-2])
def test_small_torques_of_point_contacts_are_those_of_large_ones_scaled(torque):
    """Rotations go with the torque to 2/3 where no further pair comes under load."""
    small, large = (shared(spur, 0.0, value) for value in (torque, 1e3 * torque))
    assert_allclose(large.rotation / small.rotation, 100.0, rtol=1e-3)


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("cap", [50.0, 70.0, 85.0, 100.0, 120.0])
@pytest.mark.parametrize("bending", [None, (2e-6, 3e-7)])
def test_pairs_at_their_cap_share_the_torque(cap, bending):
    """Whole rows of cells yield at once there: the deformation jumps over the force."""
    pair = gear_pair(FlankModifications(lead_crowning=0.005), materials=(Material(max_pressure=cap),) * 2)
    found = share_load(
        pair,
        tooth_pairs_at(trace_teeth(pair, [-0.75 * CENTRE]), 0),
        TORQUE,
        GRID,
        bending=None if bending is None else Springs(*bending),
    )
    assert len(found.shares) == 2
    assert_allclose(sum(share.torque for share in found.shares), TORQUE, rtol=EQUILIBRIUM)
    assert_allclose([share.rotation for share in found.shares], found.rotation, rtol=COMPATIBLE)
    for share in found.shares:
        solution = share.loaded.solution
        assert solution.pressure.max() <= cap
        assert_allclose(solution.pressure.sum() * solution.cell_area, share.force, rtol=EQUILIBRIUM)
        assert solution.residual <= 1e-6


class Springs(BendingModel):
    """Every pair deflects by some amount more, and a little by the load of the others."""

    neighbours = 2

    def __init__(self, own, coupling=0.0):
        self.own, self.coupling = own, coupling

    def within(self, number, separation, edges=()):
        assert isinstance(number, int)
        assert edges == ()
        return np.full((len(separation.y),) * 2, self.own)

    def between(self, at, under):
        assert at[0] != under[0]
        return np.full((len(at[1].y), len(under[1].y)), self.coupling)


def test_soft_teeth_share_by_their_initial_separations_alone():
    """Springs far softer than the contacts: forces follow from the initial separations by a linear balance."""
    pair, phi1, own = helical(), -0.6 * CENTRE, 1e-3
    tooth_pairs = tooth_pairs_at(trace_teeth(pair, [phi1]), 0)
    found = share_load(pair, tooth_pairs, TORQUE, GRID, bending=Springs(own))
    levers = np.array([(s.tooth_pair.contact.pinion_lever, s.tooth_pair.contact.wheel_lever) for s in found.shares]).T
    separations = np.array([s.tooth_pair.initial_separation for s in found.shares])
    rotation = (TORQUE * own + (levers[0] * levers[1] * separations).sum()) / (levers[0] * levers[1]).sum()
    expected = levers[1] * (rotation - separations) / own
    assert_allclose([s.force for s in found.shares], expected, rtol=2e-2)  # a contact deforms by 2e-6 mm/N


def test_deflections_of_the_teeth_are_part_of_the_total():
    pair, phi1 = spur(), -0.9 * CENTRE
    tooth_pairs = tooth_pairs_at(trace_teeth(pair, [phi1]), 0)
    own, coupling = 2e-6, 3e-7
    found = share_load(pair, tooth_pairs, TORQUE, GRID, bending=Springs(own, coupling))
    forces = np.array([share.force for share in found.shares])
    assert len(forces) == 2
    assert_allclose(
        [share.tooth_deflection for share in found.shares], own * forces + coupling * forces[::-1], rtol=1e-9
    )
    assert_allclose([share.rotation for share in found.shares], found.rotation, rtol=COMPATIBLE)
    assert found.rotation > shared(spur, phi1).rotation
    assert torque_rate(found, Springs(own, coupling)) < torque_rate(shared(spur, phi1))


class Tilting(Springs):
    """Teeth whose deflection tilts the next tooth against its contact, by nothing in the middle of the face."""

    def between(self, at, under):
        assert at[0] < under[0]
        return np.outer(np.ones(len(at[1].y)), self.coupling * under[1].y)


@pytest.mark.parametrize(("part", "carrying"), [(0.5, 2), (1.5, 1)])
def test_pair_comes_under_load_where_its_neighbour_bends_it_towards_the_mate(part, carrying):
    """It closes as soon as its nearest slice does, while others and the mean of them are still apart."""
    pair = spur()
    first, second = sorted(tooth_pairs_at(trace_teeth(pair, [-0.9 * CENTRE]), 0), key=lambda one: one.pair)
    first, bending = replace(first, initial_separation=0.0), Tilting(1e-6, 1e-7)
    alone = share_load(pair, (first,), TORQUE, GRID, bending=bending)
    face = sample_separation(pair, second.contact, cells=(24, 200), box=(0.2, 0.5 * pair.face_width))
    nearest = (face.gap.min(axis=0) + bending.coupling * alone.shares[0].force * face.y).min()
    assert nearest < -5e-4  # mm: far beyond what the balance tells apart
    closed = replace(second, initial_separation=alone.rotation - part * nearest / second.contact.wheel_lever)
    found = share_load(pair, (first, closed), TORQUE, GRID, bending=bending)
    assert len(found.shares) == carrying


class Recorded(Springs):
    """Springs that keep of which pairs they were asked."""

    def __init__(self, own, coupling):
        super().__init__(own, coupling)
        self.numbers = []

    def within(self, number, separation, edges=()):
        self.numbers.append(number)
        return super().within(number, separation, edges)


def test_pair_two_pitches_away_is_kept_apart_by_what_all_pairs_share():
    """The bodies turn under any pair's load by as much below the others, so that the far pair is never closed."""
    pair, own = spur(), 1e-5
    first, second = sorted(tooth_pairs_at(trace_teeth(pair, [-0.9 * CENTRE]), 0), key=lambda one: one.pair)
    first = replace(first, initial_separation=0.0)
    turn = own * (TORQUE / first.contact.pinion_lever) / first.contact.wheel_lever
    far, bending = replace(second, pair=first.pair + 2, initial_separation=0.5 * turn), Recorded(own, own)
    found = share_load(pair, (first, far), TORQUE, GRID, bending=bending)
    assert [share.tooth_pair.pair for share in found.shares] == [first.pair]
    assert bending.numbers.count(far.pair) == 1  # of the first compliance; it was never solved


class Restless(BendingModel):
    """Teeth that are softer or stiffer every time they are asked."""

    neighbours = 2

    def __init__(self):
        self.compliances = itertools.cycle([1e-6, 3e-6, 2e-6])

    def within(self, number, separation, edges=()):
        assert isinstance(number, int)
        assert edges == ()
        return np.full((len(separation.y),) * 2, next(self.compliances))

    def between(self, at, under):
        return np.zeros((len(at[1].y), len(under[1].y)))


@pytest.mark.thorough
def test_balance_that_is_never_found_is_told_with_the_last_one(monkeypatch):
    monkeypatch.setattr("loaded_tca.loaded.load_sharing.SAME_BOX", (2.0, 3.0))  # every force on a grid of its own
    pair = spur()
    tooth_pairs = tooth_pairs_at(trace_teeth(pair, [-0.9 * CENTRE]), 0)
    with pytest.raises(ConvergenceError, match=r"load sharing not converged.*after 40 balances") as caught:
        share_load(pair, tooth_pairs, TORQUE, GRID, bending=Restless())
    assert len(caught.value.last.shares) == 2


@pytest.mark.parametrize("driving", ["pinion", "wheel"])
@pytest.mark.parametrize("sense", ["positive", "negative"])
def test_sharing_does_not_depend_on_who_drives_or_how(driving, sense):
    """At the symmetric position of equal gears every drive shares the load alike."""
    pair = gear_pair(FlankModifications(lead_crowning=0.005), NONE, teeth=(30, 30), driving=driving, sense=sense)
    found = share_load(pair, tooth_pairs_at(trace_teeth(pair, [0.5 * pair.pitch]), 0), TORQUE, GRID)
    assert_allclose([share.torque / TORQUE for share in found.shares], 0.5, atol=1e-6)


test_load_sharing_refuses = refused_calls(
    (lambda torque: shared(spur, 0.0, torque), "torque", [-1.0, math.nan, math.inf]),
    (lambda: share_load(spur(), (), TORQUE, GRID), "tooth_pairs: none given"),
)


def test_candidates_are_those_within_reach():
    mesh = trace_teeth(helical(), [-CENTRE, 0.0])
    for position in (0, 1):
        found = tooth_pairs_at(mesh, position)
        assert all(
            isinstance(tooth_pair, ToothPair) and tooth_pair.initial_separation >= 0.0 and tooth_pair.contact.in_contact
            for tooth_pair in found
        )
        assert len(found) == np.isfinite(mesh.initial_separation[:, position]).sum()


def test_paths_of_all_pairs_are_told_in_the_angles_of_the_gears():
    """Teeth of involutes without modifications touch wherever they are: every pair with the wheel in the same place."""
    pair = gear_pair(NONE, NONE)
    angles = np.array([0.4, 0.5]) * pair.pitch
    leading, paths = in_gear_angles(trace_teeth(pair, angles))
    touching = [path for path in paths.values() if not path.on_edge.any()]
    assert len(touching) > 1
    for path in (leading, *touching):
        assert_allclose(path.pinion_angle, angles, rtol=1e-12)  # pitches are taken off and added
        assert_allclose(path.wheel_angle, pair.ratio * angles, atol=1e-9)


def test_deflection_of_a_single_pair_has_what_displaces_its_slices():
    """As supports do: the same for all slices is the mean of any force over them."""
    pair = uncrowned_spur()
    path = trace_contact(pair, [0.0])
    loaded = solve_under_load(pair, path[0], 2000.0, GridChoice(cells=(16, 16)))
    displaced = replace(loaded, coupling_deflection=np.full(loaded.separation.y.size, 0.003))
    carried = OnePairsCycle(pair, path, np.array([TORQUE]), GRID).carried([displaced])
    assert_allclose(carried.tooth_deflection, 0.003)
