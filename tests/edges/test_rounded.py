"""Contacts at rounded edges solved once more: the force, symmetry, order of the edges, cap, ends, what is left out."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.compliance.model import BendingModel
from loaded_tca.contact import RoundedEdge, edge_pressures, solve_contact
from loaded_tca.edges import rounded
from loaded_tca.edges.arcs import ReachedArc, largest_pressure, reached_arcs
from loaded_tca.edges.rounded import _ContactAlongEdge, pressure_at_rounded_edge
from loaded_tca.errors import AccuracyWarning, ConvergenceError, noted_accuracy_warnings
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.loaded.load_sharing import share_load
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.loaded.tooth_pairs import tooth_pairs_at
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.reference.punch import RoundedPunch
from loaded_tca.scene import read_scene
from loaded_tca.separation import sample_separation
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import trace_contact, trace_teeth
from loaded_tca.warning_kinds import EDGE_UNSOLVED, kind_of
from tests.samples.gear_pairs import NONE, gear_pair
from tests.samples.results import FLANKS_ALONE, SCENES
from validation.contact import rounded_ends

LOAD = 3000.0
SIDE, BOTH, WIDE = EdgeRounding(side=0.2), EdgeRounding(tip=0.2, side=0.2), EdgeRounding(side=0.3)
SKEW = {"teeth": (34, 57), "width": 25.0, "helix_deg": 15.0, "mounting": Mounting(0.0, math.radians(0.03))}
SKEW |= {"rounding": BOTH, "pitches": 0.5}
"""A misaligned pair at a position where the contact reaches a tip and the end of a face, which cross in it."""
# Peaks are known to the error of their columns, 0.5 % and less; those of mirrored contacts to their solver's tolerance.
MIRRORED = 1e-3


def loaded(rounding=SIDE, load=LOAD, pitches=0.0, cells=(24, 32), free_edges=False, **pair):
    """A pair with rounded edges on both gears, and its contact under one force."""
    both = gear_pair(**{"teeth": (25, 37), "width": 20.0} | pair).rounded(rounding, rounding)
    contact = trace_contact(both, [pitches * both.pitch], warn=False)[0]
    return both, solve_under_load(both, contact, load, GridChoice(cells, free_edges=free_edges))


def found(pair, one, edges=None, free_edges=False):
    edges = reached_arcs(pair, one) if edges is None else edges
    return pressure_at_rounded_edge(pair, one, edges, None, 0, free_edges=free_edges)


@pytest.fixture
def solutions(monkeypatch):
    """What was solved on columns."""
    kept = []

    def solved(*arguments, **options):
        answer = edge_pressures(*arguments, **options)
        kept.extend(answer)
        return answer

    monkeypatch.setattr(rounded, "edge_pressures", solved)
    return kept


def test_edges_are_where_the_arcs_begin():
    """An arc over a right angle begins its radius before the end of the face, 20 mm wide."""
    pair, one = loaded()
    edges = reached_arcs(pair, one)
    assert [len(edge.lines) for edge in edges] == [2, 2], "both ends, of both gears"
    for line in (line for edge in edges for line in edge.lines):
        assert_allclose(np.abs(line.place[1]), 10.0 - 0.2, rtol=1e-6)
        assert_allclose(np.abs(line.normal) / np.hypot(*line.normal), [0.0, 1.0], atol=1e-9)
        assert line.place[1] * line.normal[1] > 0.0, "towards the end"
        assert line.radius == 0.2


@pytest.mark.thorough
@pytest.mark.parametrize("free_edges", [False, True])
def test_force_is_kept(solutions, free_edges):
    pair, one = loaded(free_edges=free_edges)
    found(pair, one, free_edges=free_edges)
    assert solutions
    for each in solutions:
        problem, pressure = each.solution.problem, each.solution.pressure
        assert_allclose((pressure * problem.widths).sum() * problem.spacing, LOAD, rtol=1e-9)
        assert pressure.min() >= 0.0
        assert not pressure[np.isinf(problem.gap)].any(), "nothing beyond the flanks"
    for border in (pressure[[0, -1]], pressure[:, [0, -1]]):
        assert not border.any(), "the last box holds the contact"


@pytest.mark.thorough
@pytest.mark.parametrize("free_edges", [False, True])
def test_both_ends_of_a_symmetric_contact_have_the_same_peak(free_edges):
    pair, one = loaded(free_edges=free_edges)
    peaks = [found(pair, one, [edge], free_edges) for edge in reached_arcs(pair, one)]
    assert_allclose([peak.pressure for peak in peaks], peaks[0].pressure, rtol=MIRRORED)
    assert_allclose([abs(peak.place[1]) for peak in peaks], abs(peaks[0].place[1]), rtol=MIRRORED)
    assert {math.copysign(1.0, peak.place[1]) for peak in peaks} == {-1.0, 1.0}


@pytest.mark.thorough
def test_peak_does_not_depend_on_the_order_of_the_edges():
    """Of the tip and the end of a misaligned helical pair, too, which cross each other."""
    for options in ({}, SKEW):
        pair, one = loaded(**options)
        edges = reached_arcs(pair, one)
        assert len(edges) > 1
        first, last = found(pair, one, edges), found(pair, one, edges[::-1])
        assert_allclose(last.pressure, first.pressure, rtol=first.error + last.error)


@pytest.mark.thorough
def test_peak_beside_a_crossing_has_the_error_of_both_edges(solutions):
    """An edge that lies across the fine columns of the other one has the larger estimate."""
    peak = found(*loaded(**SKEW))
    together = [each for each in solutions if each.solution is solutions[-1].solution]
    assert len(together) > 1
    assert peak.error == max(each.error for each in together)
    assert peak.error > next(each.error for each in together if each.pressure == peak.pressure)


def test_peak_whose_grids_agree_by_chance_has_the_error_of_its_cells():
    contact = SimpleNamespace(turn=np.eye(2))
    for cells in (5.0, 20.0):
        peak = SimpleNamespace(pressure=900.0, place=(0.0, 0.0), error=0.0, cells_on_arc=cells, ends_sharp=False)
        assert_allclose(_ContactAlongEdge.turned_back(contact, peak, 0.07).error, 0.07 / cells)


def test_teeth_bend_under_the_forces_where_they_act():
    """Slices along an edge that crosses the contact at 53 degrees: the force line is that of the contact below them."""
    y = np.linspace(-4.0, 4.0, 9)
    grid = SimpleNamespace(y=y, force_line=0.2 * y, origin=np.zeros(3), axes=np.eye(3))
    bending = SimpleNamespace(within=lambda _, slices: np.diag(slices.force_line))
    contact = SimpleNamespace(
        loaded=SimpleNamespace(separation=grid), along=0.8, bending=bending, number=0, pair=None, free_edges=False
    )
    compliance = _ContactAlongEdge.slice_compliance(contact, np.array([-2.0, 0.4]), np.array([0.1, 0.1]))
    assert_allclose(compliance, np.diag([-0.5, 0.1]))


def test_mirror_image_has_the_same_peak():
    """The other hand of the helix, turned the other way."""
    peaks = [
        found(*loaded(EdgeRounding(tip=0.2), pitches=0.6, helix_deg=helix, sense=sense, pinion=NONE))
        for helix, sense in ((15.0, "positive"), (-15.0, "negative"))
    ]
    assert_allclose(peaks[1].pressure, peaks[0].pressure, rtol=MIRRORED)


@pytest.mark.thorough
def test_peak_does_not_depend_on_the_grid():
    peaks = [found(*loaded(cells=cells)) for cells in ((16, 16), (32, 48), (64, 96))]
    assert_allclose([one.pressure for one in peaks], peaks[-1].pressure, rtol=0.02)


class Tilting(BendingModel):
    """Teeth that bend most under their load, and tilt their neighbours along the face."""

    neighbours = 1

    def __init__(self, tilt):
        self.tilt = tilt

    def within(self, _, grid):
        return 2e-6 * np.exp(-0.5 * np.abs(grid.y[:, None] - grid.y))

    def between(self, at, under):
        return 4e-7 + self.tilt * (at[1].y[:, None] + under[1].y)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_peak_beside_another_pair_with_bending_is_that_of_a_fine_grid(side):
    """Teeth 6 mm wide, tilted by their neighbour: cells of 6 micrometres, the coupling as both pairs share the load."""
    pair, bending = gear_pair(teeth=(25, 37), width=6.0).rounded(WIDE, WIDE), Tilting(side * 3e-7)
    pairs = tooth_pairs_at(trace_teeth(pair, [0.5 * pair.pitch]), 0)
    shares = share_load(pair, pairs, 80e3, GridChoice((24, 32), free_edges=False), bending=bending).shares
    assert len(shares) == 2
    for one, other in (shares, shares[::-1]):
        number, edges = one.tooth_pair.pair, reached_arcs(pair, one.loaded)
        fine = sample_separation(pair, one.loaded.contact, cells=(32, 1024), box=(0.25, 3.05))
        tilted = bending.between((number, fine), (other.tooth_pair.pair, other.loaded.separation))
        displaced = tilted @ other.loaded.slice_force
        assert np.ptp(displaced) > 1e-3  # mm, of about 10 of the approach
        options = {"load": one.force, "slice_compliance": bending.within(number, fine), "warn": False}
        expected = solve_contact(fine.gap + displaced, fine.spacing, pair.contact_modulus, **options)
        assert not expected.reaches_border
        peak = pressure_at_rounded_edge(pair, one.loaded, edges, bending, number, free_edges=False)
        column = expected.pressure.max(axis=0).argmax()
        assert_allclose(peak.place[1], fine.y[column], atol=0.02)
        # one of 4096 cells along the face has 2 % more
        assert_allclose(peak.pressure, expected.pressure.max(), rtol=peak.error + 0.025)
        assert -side * peak.place[1] > 2.5, "at the end that the neighbour closes"


STEEL, PLASTIC = Material(206000.0, 0.3), Material(3000.0, 0.4)


@pytest.mark.parametrize("materials", [(STEEL, PLASTIC), (PLASTIC, STEEL), (STEEL, STEEL)])
def test_share_of_a_gear_in_the_compliance_is_that_of_its_material(materials):
    """(1 - nu^2)/E of the gear that ends, over the sum of both: steel on plastic hardly tilts, plastic does."""
    pair, one = loaded(materials=materials, load=100.0)
    compliances = [(1.0 - material.poisson_ratio**2) / material.youngs_modulus for material in materials]
    for edge in reached_arcs(pair, one):
        shares = [line.share for line in edge.lines]
        assert_allclose(shares, np.array(compliances) / sum(compliances), rtol=1e-12)  # a quotient


@pytest.mark.thorough
def test_cap_is_respected():
    cap, steel = 1500.0, Material()
    pair, one = loaded(materials=(replace(steel, max_pressure=cap), steel))
    peak = found(pair, one)
    assert_allclose(peak.pressure, cap, rtol=1e-12)  # clipped at the cap
    assert found(*loaded()).pressure > cap, "without it"


def test_edges_of_bent_flanks_are_where_the_gap_begins_to_open():
    """Flanks of a spiral bevel pair leave the tangent plane: there the edge lay 0.05 mm beside the beginning."""
    names = [f"{gear}.{edge}_rounding_mm" for gear in ("pinion", "wheel") for edge in ("tip", "side")]
    both = read_scene(SCENES / "mesh_cycle_bevel.toml").with_changes(dict.fromkeys(names, 0.1)).pair()
    contact = trace_contact(both, [-0.9 * both.pitch], warn=False)[0]
    one = solve_under_load(both, contact, 3000.0, GridChoice((24, 32)))
    edges = reached_arcs(both, one)
    assert len(edges) == 2
    for (line,) in (edge.lines for edge in edges):
        x, y = np.array(line.place)[:, None] + line.direction[:, None] * [-1e-3, 1e-3]
        gaps = [NormalGap(pair, contact, one.separation.axes) for pair in (both, both.sharp)]
        opened, sharp = (gap.at(x[None], y[None])[0][0] for gap in gaps)
        before, beyond = (opened - sharp).tolist()
        assert abs(before) < 1e-12  # mm; rounding of coordinates of 100 mm
        assert_allclose(beyond, 1e-6 / 0.2, rtol=0.15)  # along a slant of up to 20 deg


def test_edge_that_a_relief_start_crosses_has_no_bound():
    """The start of the relief of a helical pinion crosses one of the two face ends that a contact reaches."""
    relief = FlankModifications(tip_relief=0.03, tip_relief_start=106.0, tip_relief_form="linear")
    helical = {"teeth": (34, 57), "width": 25.0, "helix_deg": 15.0}
    edges = reached_arcs(*loaded(pitches=-0.3, pinion=relief, **helical))
    assert [edge.at_relief_start for edge in edges] == [True, False]
    assert [edge.limit == math.inf for edge in edges] == [True, False]


def test_contact_that_ends_before_the_arc_has_no_peak():
    pair, one = loaded(load=100.0, pinion=FlankModifications(lead_crowning=0.02))
    assert reached_arcs(pair, one) == []
    assert not one.at_arc
    beyond = ReachedArc((RoundedEdge((0.0, 9.8), (0.0, 1.0), 0.2),), 1000.0)
    assert math.isnan(found(pair, one, [beyond]).pressure)
    assert math.isnan(found(pair, one, [beyond]).error)


@pytest.mark.parametrize(("rounding", "sharp"), [(EdgeRounding(tip=0.2), True), (BOTH, False)])
def test_tip_between_sharp_face_ends_has_no_bound(rounding, sharp):
    """Nor has it where the bound of the tip alone is too low: it is looked at whatever other contacts have."""
    pair, one = loaded(rounding, pitches=0.8, pinion=NONE)
    tips = [edge for edge in reached_arcs(pair, one) if abs(edge.lines[0].direction[0]) > 0.5]
    assert [edge.ends_sharp for edge in tips] == [sharp]
    assert (tips[0].limit == math.inf) == sharp
    if sharp:
        peak = pressure_at_rounded_edge(pair, one, tips, None, 0, free_edges=False, at_least=1e6)
        assert peak == found(pair, one, tips)
        assert (peak.error, peak.ends_sharp) == (math.inf, True)


def test_edges_that_cross_are_solved_together_whatever_one_of_them_can_come_to():
    """Alone, on columns of its own, an edge beside a crossing has another pressure."""
    pair, one = loaded(**SKEW)
    edges = reached_arcs(pair, one)
    peak = found(pair, one, edges)
    low = [edges[0], *(edge._replace(bound=1.0) for edge in edges[1:])]  # MPa, next to nothing
    again = pressure_at_rounded_edge(pair, one, low, None, 0, free_edges=False, at_least=0.99 * peak.pressure)
    assert_allclose(again.pressure, peak.pressure, rtol=1e-9)
    assert again.error == peak.error


def test_flush_free_ends_rounded_less_than_the_contact_is_wide_are_uncertain():
    """The law of slices has one length across the contact; it counts where slices do not lie along the ends."""
    pair, one = loaded(free_edges=True)
    pressed = (one.solution.pressure > 0.0).sum(axis=0).max() * one.separation.spacing[0]
    (reached, *_) = reached_arcs(pair, one)
    cases = (0.3, True, 2, True), (0.3, False, 2, False), (0.5, True, 2, False), (0.3, True, 1, False)
    for part, free_edges, gears, narrow in cases:
        lines = [replace(line, radius=part * 0.5 * pressed) for line in reached.lines[:gears]]
        contact = _ContactAlongEdge(pair, one, lines[0], None, 0, free_edges)
        arcs = [ReachedArc(tuple(lines), 1e4)]
        assert not contact.has_narrow_ends(arcs, lines)
        contact.slice_axis = 0
        assert contact.has_narrow_ends(arcs, lines) is narrow


def test_pressure_at_flush_ends_does_not_depend_on_a_small_radius():
    """As beside quarter-spaces: a notch of the depth r has its intensity as sqrt(r), and the gap opens as r.

    Half-spaces have 4^(1/3) times the pressure on a quarter of the radius.
    """
    peaks = {}
    for radius in (0.01, 0.04):
        pair, one = loaded(EdgeRounding(side=radius), 4.0 * LOAD, free_edges=True, cells=(24, 64))
        peaks[radius] = [found(pair, one, free_edges=free).pressure for free in (True, False)]
    pressed = 0.5 * (one.solution.pressure > 0.0).sum(axis=0).max() * one.separation.spacing[0]
    quarter_spaces = [rounded_ends.exact_peak(radius / pressed, "both bodies", 0.3) for radius in peaks]
    flush, half_spaces = np.array(peaks[0.01]) / np.array(peaks[0.04])
    assert_allclose(flush, quarter_spaces[0] / quarter_spaces[1], rtol=0.06)  # twice 3 %, as ``validation`` has them
    assert_allclose(half_spaces, 4.0 ** (1.0 / 3.0), rtol=0.1)


def test_bound_is_that_of_a_narrow_rounding_on_coarse_cells():
    """Of a flat punch, whose pressure beside a sharp end is P/(pi sqrt(2 a s)); 1.80 is the limit of small radii."""
    punch = RoundedPunch(0.1, 0.02, 0.1005, 113187.0)
    intensity = punch.line_load / (math.pi * math.sqrt(2.0 * punch.half_width))
    told = [largest_pressure(2.0 * intensity / math.sqrt(h), h, punch.radius, 113187.0) for h in (0.01, 0.1, 1.0)]
    assert min(told) > punch.peak()[1]
    assert_allclose(told[-1], punch.peak()[1], rtol=0.02)
    assert largest_pressure(1e4, 1e-6, 0.2, 113187.0) > 1e4, "the cell is narrower than the pressed part"


@pytest.mark.thorough
def test_contacts_left_out_do_not_change_the_largest_pressure():
    """Ends of misaligned teeth, whose contacts were expected to differ by up to four times."""
    scene = read_scene(SCENES / "misaligned.toml").with_changes(
        {**FLANKS_ALONE, "analysis.load_sharing": True, "analysis.positions": 4, "analysis.accuracy": None}
        | {"analysis.cells": (28, 28)}
        | {f"{gear}.{edge}_rounding_mm": 0.2 for gear in ("pinion", "wheel") for edge in ("tip", "side")}
    )
    with noted_accuracy_warnings(given=False):  # on 28 cells the estimated error of the largest pressure is 3.2 %
        largest, every = (
            analyse(scene.with_changes({"analysis.edge_pressures": which})) for which in ("largest", "all")
        )
    assert np.isnan(largest.edge_pressure_error).sum() > np.isnan(every.edge_pressure_error).sum()
    assert_allclose(np.nanmax(largest.edge_pressure), np.nanmax(every.edge_pressure), rtol=1e-9)


def test_edge_pressure_that_does_not_converge_is_missing_and_the_mesh_cycle_stands(monkeypatch):
    monkeypatch.setattr("loaded_tca.contact.graded.MOST_ITERATIONS", 1)
    scene = read_scene(SCENES / "misaligned.toml").with_changes(
        {**FLANKS_ALONE, "analysis.load_sharing": False, "analysis.positions": 1, "pinion.side_rounding_mm": 0.2}
    )
    with pytest.warns(AccuracyWarning) as caught:
        result = analyse(scene)
    (sentence,) = (str(one.message) for one in caught if kind_of(str(one.message)) is EDGE_UNSOLVED)
    assert re.search(r"residual of [0-9.]+e[-+][0-9]+, above 1e-05 \(at 1 of 1 pressure maps", sentence), sentence
    assert np.isnan(result.edge_pressure).all()
    assert np.isnan(result.edge_pressure_error).all()
    assert_allclose(result.load_share.sum(axis=-1), 1.0, rtol=1e-12)  # the only pair
    assert result.peak_pressure.max() > 0.0


def along(**pair):
    """A misaligned pair whose contact ends on rounded face ends, those ends, and the contact in axes along them."""
    both, one = loaded(mounting=Mounting(0.0, math.radians(0.02)), **pair)
    arcs = [edge for edge in reached_arcs(both, one) if edge.crosses_contact]
    return one, arcs, _ContactAlongEdge(both, one, arcs[0].lines[0], None, 0, False)


def test_loads_on_columns_do_not_depend_on_the_box_that_holds_the_contact(monkeypatch):
    """A box of half a cell beyond the pressure cuts the contact, which is wider beside an arc: it is made larger."""
    one, arcs, contact = along()
    usual = contact.cell_forces(arcs)
    boxes, made = [], contact._box
    monkeypatch.setattr(contact, "_box", lambda margin: boxes.append(margin) or made(margin))
    monkeypatch.setattr(rounded, "MARGIN", 0.5)
    monkeypatch.setattr(rounded, "SPREAD", 0.0)
    widened = contact.cell_forces(arcs)
    assert len(boxes) > 1
    for own, other in zip(usual, widened, strict=True):
        ends = [load.ends[..., 2] for load in (own, other)]
        assert_allclose([own.forces.sum(), other.forces.sum()], one.solution.load, rtol=1e-3)  # 10 tolerances
        moments = [load.forces @ place.mean(axis=0) for load, place in zip((own, other), ends, strict=True)]
        assert abs(moments[1] - moments[0]) < 2e-3 * one.solution.load * 20.0  # of the face: cells of both boxes differ


def test_contacts_that_no_box_holds_have_no_load_on_columns(monkeypatch):
    _, arcs, contact = along()
    monkeypatch.setattr(rounded, "MARGIN", 0.5)
    monkeypatch.setattr(rounded, "SPREAD", 0.0)
    monkeypatch.setattr(rounded, "MOST_BOXES", 1)
    with pytest.raises(ConvergenceError, match="reaches the ends of its columns"):
        contact.cell_forces(arcs)
