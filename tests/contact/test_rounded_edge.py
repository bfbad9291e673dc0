"""Peak pressure at rounded edges: closed form, fine uniform grids, several and oblique edges, estimate, failures."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import FreeEdge, RoundedEdge, edge_pressures, solve_contact
from loaded_tca.contact.rounded_edge import CELLS_ON_ARC, ROWS_ON_ARC, EdgePressure, PressedArc, _Wedges
from loaded_tca.errors import ConvergenceError
from loaded_tca.reference.punch import RoundedPunch
from tests.refusals import refusals
from validation.contact import rounded_ends

ROUNDING = 1e-12
"""Of closed forms of a few operations, which gave the same number on every processor tried."""
E_STAR = 113187.0
RADIUS = 0.2
BOX = ((-0.15, 0.15), (-2.0, 2.1))
FACE = RoundedEdge((0.0, 2.0), (0.0, 1.0), RADIUS)
BOTH = [RoundedEdge((0.0, side * 2.0), (0.0, side), RADIUS) for side in (-1.0, 1.0)]
# The same on columns three times as fine.
FINE = 15.0


def face_end(x, y, radius=RADIUS):
    """A cylinder of radius 10 mm that ends at y = 2 with a rounding."""
    return x[:, None] ** 2 / 20.0 + np.maximum(y - 2.0, 0.0) ** 2 / (2.0 * radius)


def cylinder(x, y):
    """The same with two ends."""
    return face_end(x, np.abs(y))


def peak(gap=face_end, box=BOX, edge=FACE, load=500.0, **options):
    (found,) = edge_pressures(gap, box, [edge], load, E_STAR, **options)
    return found


def test_flat_punch_with_rounded_ends():
    """Rows of a great length make the problem plane: closed form."""
    punch = RoundedPunch(0.1, RADIUS, 0.11, E_STAR)
    length = 1000.0
    edges = [RoundedEdge((0.0, side * 0.1), (0.0, side), RADIUS) for side in (-1.0, 1.0)]
    box = ((-0.5 * length, 0.5 * length), (-0.15, 0.15))

    def gap(x, y):
        return punch.gap(y) + np.where(np.abs(x) < 0.25 * length, 0.0, np.inf)[:, None]

    found = edge_pressures(gap, box, edges, punch.line_load * 0.5 * length, E_STAR, cells=(4, 32))
    place, largest = punch.peak()
    for one, edge in zip(found, edges, strict=True):
        # Two rows of a fourth of the length each: what the ends of the rows change falls with their slenderness.
        assert_allclose(one.pressure, largest, rtol=one.error)
        assert_allclose(one.place[1], edge.normal[1] * place, atol=3e-4)
        assert_allclose(one.pressed_width, 0.01, rtol=0.2)
        assert one.error < 0.01
        assert one.cells_on_arc > 3.5


def test_edge_crossed_by_a_jump_of_the_slope_has_no_limit():
    """A roof along the cylinder: the wedge has the pressure E* J/(2 pi) ln(1/s) at its ridge, more on finer rows.

    Halves of rows add E* J ln 2/(2 pi), 125 MPa with J = 0.01: at a peak of 4 GPa that is above 1 %, a tenth of it not.
    """

    def roof(jump):
        return lambda x, y: face_end(x, y) + 0.5 * jump * np.abs(x)[:, None]

    coarse, fine = (peak(roof(0.01), cells=(cells, 32), accuracy=1.0) for cells in (41, 123))
    assert coarse.error == fine.error == math.inf
    assert_allclose(fine.pressure - coarse.pressure, E_STAR * 0.01 / (2.0 * math.pi) * math.log(3.0), rtol=0.25)
    slight, none = (peak(roof(jump)) for jump in (0.001, 0.0))
    assert none.error < slight.error < 0.02


def test_edge_that_meets_a_sharp_end_has_no_limit():
    """A cylinder on a rounded edge along its axis, with sharp ends; with a crown the contact ends before them."""
    edge, box = RoundedEdge((0.0, 0.02), (0.0, 1.0), RADIUS), ((-2.5, 2.5), (-0.2, 0.1))

    def ending(crown):
        def gap(x, y):
            profile = y**2 / 20.0 + np.maximum(y - 0.02, 0.0) ** 2 / (2.0 * RADIUS) + crown * x[:, None] ** 2
            return np.where(np.abs(x[:, None]) < 2.0, profile, np.inf)

        return gap

    cells = (20, 40, 80)
    sharp, crowned = ([peak(ending(c), box, edge, cells=(n, 32)) for n in cells] for c in (0.0, 3e-3))
    assert sharp[0].pressure < 0.95 * sharp[1].pressure < 0.9 * sharp[2].pressure
    assert [one.error for one in sharp] == [math.inf] * 3
    assert_allclose([one.pressure for one in crowned], crowned[-1].pressure, rtol=crowned[0].error)
    assert crowned[0].error < 0.01


@pytest.mark.parametrize(("left", "is_sharp"), [(0.01, True), (0.05, False)])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_arc_that_a_sharp_end_cuts_is_sharp_where_it_is_pressed_up_to_there(left, is_sharp, side):
    """Another body ends so far [mm] past the beginning of the arc: the gap there is left^2/2R, 0.25 or 6 um."""

    def gap(x, y):
        return np.where(side * y < 2.0 + left, face_end(x, side * y), np.inf)

    box = (BOX[0], tuple(sorted(side * end for end in BOX[1])))
    found = peak(gap, box, RoundedEdge((0.0, side * 2.0), (0.0, side), RADIUS))
    assert found.ends_sharp == is_sharp
    assert (found.error == math.inf) == is_sharp


@pytest.mark.thorough
def test_estimate_covers_the_error_at_a_face_end():
    exact = peak(cells_on_arc=FINE).pressure
    for cells_on_arc in (3.0, 5.0, 7.0):
        found = peak(cells_on_arc=cells_on_arc)
        assert abs(found.pressure / exact - 1.0) <= found.error
    assert peak().error < 0.01


def test_two_ends_are_alike():
    first, second = edge_pressures(cylinder, ((-0.15, 0.15), (-2.1, 2.1)), BOTH, 500.0, E_STAR)
    assert_allclose(first.pressure, second.pressure, rtol=1e-3)
    assert_allclose(first.place[1], -second.place[1], rtol=1e-3)
    assert first.solution is second.solution


def test_fine_uniform_grid_agrees():
    x, y = ((np.arange(n) + 0.5) / n * 0.6 for n in (96, 2048))
    x, y, load = x - 0.3, y + 1.5, 60.0

    def gap(x, y):
        return face_end(x, y) + (y - 2.0) ** 2 / 20.0

    fine = solve_contact(gap(x, y), (0.6 / 96, 0.6 / 2048), E_STAR, load=load, warn=False)
    found = peak(gap, ((-0.3, 0.3), (1.5, 2.1)), load=load)
    assert not fine.reaches_border
    assert_allclose(found.pressure, fine.pressure.max(), rtol=5e-3)
    assert_allclose(found.solution.approach, fine.approach, rtol=2e-3)


def test_peak_falls_with_the_third_root_of_the_radius():
    """Under narrow roundings: a rounding of a part of the contact's width shifts its load too."""
    small, large = (
        peak(lambda x, y, r=r: face_end(x, y, r), edge=RoundedEdge((0.0, 2.0), (0.0, 1.0), r), cells_on_arc=8.0)
        for r in (0.002, 0.016)
    )
    assert_allclose(np.log(large.pressure / small.pressure) / np.log(8.0), -1.0 / 3.0, rtol=0.05)


def test_cap_is_kept():
    found = peak(max_pressure=2000.0)
    assert found.pressure == 2000.0
    assert found.solution.pressure.max() == 2000.0
    assert_allclose(found.solution.load, 500.0, rtol=1e-9)


def test_bending_takes_load_from_the_end():
    def slices(y, widths):
        assert_allclose(widths.sum(), BOX[1][1] - BOX[1][0])
        return 2e-5 * np.exp(-np.abs(y[:, None] - y) / 1.0) * np.exp(0.3 * (y[:, None] + y))

    assert peak(slice_compliance=slices).pressure < 0.95 * peak().pressure


def test_slices_without_material_have_no_compliance():
    """A law of slices that is not positive definite beyond the end of the material: what is there carries nothing."""

    def ending(x, y):
        return face_end(x, y) + np.where(y > 2.0 + RADIUS, np.inf, 0.0)

    def law(beyond):
        def slices(y, _):
            outside = y > 2.0 + RADIUS
            return np.where(outside[:, None] | outside, beyond, 2e-5 * np.exp(-np.abs(y[:, None] - y)))

        return slices

    box = (BOX[0], (-2.0, 4.0))
    peaks = [peak(ending, box, slice_compliance=law(beyond)) for beyond in (-1e-3, 0.0)]
    assert_allclose(peaks[0].pressure, peaks[1].pressure, rtol=ROUNDING)
    laws = peaks[0].solution.problem.slice_compliance
    assert np.linalg.eigvalsh(laws).min() > -ROUNDING * laws.max()


def test_slices_along_the_edge_have_the_rows():
    seen = []

    def slices(x, widths):
        seen.append((x, widths))
        return 1e-6 * np.exp(-np.abs(x[:, None] - x))

    peak(slice_compliance=slices, slice_axis=0)
    x, widths = seen[-1]
    assert_allclose(widths, np.full(x.size, 0.3 / x.size))
    assert_allclose(x.mean(), 0.0, atol=1e-15)  # columns within 0.15 mm that cancel: 2e-18 seen


@pytest.mark.thorough
@pytest.mark.parametrize("sine", [0.1, pytest.param(0.5, marks=pytest.mark.thorough)])
def test_oblique_edge_has_an_estimate_that_covers_its_error(sine):
    normal = np.array([sine, math.sqrt(1.0 - sine**2)])

    def gap(x, y):
        beyond = np.maximum(x[:, None] * normal[0] + (y - 1.0) * normal[1], 0.0)
        return x[:, None] ** 2 / 20.0 + y**2 / 2000.0 + beyond**2 / (2.0 * RADIUS)

    edge, box = RoundedEdge((0.0, 1.0), tuple(3.0 * normal), RADIUS), ((-0.3, 0.3), (-3.0, 1.8))
    found, fine = (peak(gap, box, edge, 300.0, cells_on_arc=m) for m in (4.0, 9.0))
    assert abs(found.pressure / fine.pressure - 1.0) <= found.error
    assert fine.error < 0.03
    across = (np.array(found.place) - (0.0, 1.0)) @ normal
    assert 0.0 < across < found.pressed_width


@pytest.mark.thorough
def test_edge_along_the_columns_is_met_by_fine_rows():
    """Without exchanging x and y: dearer, and with a larger estimate."""
    turned = peak(
        lambda x, y: face_end(y, x).T, BOX[::-1], RoundedEdge((2.0, 0.0), (1.0, 0.0), RADIUS), cells_on_arc=3.0
    )
    exact = peak(cells_on_arc=FINE).pressure
    assert abs(turned.pressure / exact - 1.0) <= turned.error
    assert len(turned.solution.pressure) > 300


@pytest.mark.thorough
def test_few_cells_on_an_oblique_edge_are_told(monkeypatch):
    monkeypatch.setattr("loaded_tca.contact.rounded_edge.MOST_ROWS", 32)

    def gap(x, y):
        return x[:, None] ** 2 / 20.0 + y**2 / 2000.0 + np.maximum(x[:, None] + y - 1.0, 0.0) ** 2 / (4.0 * RADIUS)

    found = peak(gap, ((-0.3, 0.3), (-3.0, 1.8)), RoundedEdge((0.0, 1.0), (1.0, 1.0), RADIUS), 300.0)
    assert found.error > 0.03
    assert found.cells_on_arc < 3.0


def test_edge_that_is_not_reached_has_no_pressure():
    far = RoundedEdge((0.0, -30.0), (0.0, -1.0), RADIUS)
    near, none = edge_pressures(face_end, BOX, [FACE, far], 500.0, E_STAR)
    assert math.isnan(none.pressure)
    assert none.pressed_width == none.cells_on_arc == 0.0
    assert near.pressure > 2000.0


def test_end_of_the_box_is_told():
    assert peak(box=((-0.02, 0.02), (-2.0, 2.1))).error == math.inf


def tip(x, y, scale=1.0):
    """A flank of 10 mm radius, crowned along an edge at y = 0 with a rounding, nearest 0.05 mm before it."""
    across = (y + 0.05 * scale) ** 2 / 20.0 + np.maximum(y, 0.0) ** 2 / (2.0 * RADIUS)
    return (x[:, None] ** 2 / 2000.0 + across) / scale


def tip_peak(degrees=115.0, scale=1.0, side=1.0, options=None, **edge):
    angle = None if degrees is None else math.radians(degrees)
    end = RoundedEdge((0.0, 0.0), (0.0, side), RADIUS * scale, angle, **edge)
    box = ((-2.5 * scale, 2.5 * scale), tuple(sorted((-0.5 * side * scale, 0.12 * side * scale))))
    return peak(lambda x, y: tip(x, side * y, scale), box, end, 400.0 * scale**2, **(options or {}))


def test_a_wedge_of_two_right_angles_is_a_half_space():
    plain = tip_peak(None)
    assert_allclose(tip_peak(180.0).pressure, plain.pressure, rtol=1e-6)
    assert_allclose(tip_peak(115.0, share=0.0).pressure, plain.pressure, rtol=1e-6)


def test_faces_of_a_wedge_meet_where_they_would_without_the_rounding():
    ends = [RoundedEdge((0.0, 2.0), (0.0, side), 0.2, 0.5 * math.pi, 0.2).free_edge(-2.0) for side in (3.0, -3.0)]
    assert_allclose([end.position for end in ends], [4.2, 3.8], rtol=ROUNDING)
    assert [end.material for end in ends] == ["below", "above"]
    # Hetenyi in plane strain: the side returns 2/pi of a load, and twice that falls on the top again.
    assert_allclose(5.0 * ends[0].factor, 2.0 / (1.0 - (2.0 / math.pi) ** 2) - 1.0, rtol=ROUNDING)
    assert RoundedEdge((0.0, 2.0), (0.0, 1.0), 0.2, 1.4).free_edge(0.0).factor == 0.6  # as far as it converges


def test_load_beyond_the_rounding_of_a_wedge_is_one_where_that_begins():
    """The tilt is counted from the middle of the load, which lies before both roundings at the most."""
    ends = [RoundedEdge((0.0, place), (0.0, place), 0.2, 2.0) for place in (-2.0, 3.0)]
    wedges = _Wedges.of(ends, -5.0)
    assert [wedges.reference(centre) for centre in (-2.5, 1.0, 3.5)] == [-2.0, 1.0, 3.0]


def test_the_sharper_the_wedge_the_more_it_tilts_off_its_edge():
    found = [tip_peak(degrees) for degrees in (None, 150.0, 125.0, 105.0)]
    assert (np.diff([one.pressure for one in found]) < 0.0).all()
    assert_allclose([one.solution.load for one in found], 400.0, rtol=1e-9)
    assert tip_peak(share=1.0).pressure < tip_peak().pressure


def test_wedges_of_all_sizes_and_on_either_side_are_alike():
    found = tip_peak()
    assert_allclose(tip_peak(scale=8.0).pressure, found.pressure, rtol=1e-6)
    other = tip_peak(side=-1.0)
    assert_allclose(other.pressure, found.pressure, rtol=1e-6)
    assert_allclose(other.place[1], -found.place[1], rtol=1e-4)


def askew(load=7e3, rows=9, radius=20.0, angle=math.radians(115.0)):
    """A cylinder that lies askew over an edge with a rounding of 0.02 mm: it touches there and is pressed far off."""

    def gap(x, y):
        across = y + 0.3 * x[:, None]
        return x[:, None] ** 2 / 4000.0 + across**2 / (2.0 * radius) + np.maximum(y, 0.0) ** 2 / 0.04

    edge = RoundedEdge((0.0, 0.0), (0.0, 1.0), 0.02, angle)
    box = ((-6.0, 6.0), (-2.0, 0.09))
    return peak(gap, box, edge, load=load, cells=(rows, 24), tolerance=1e-5, slice_axis=0)


@pytest.mark.parametrize(("load", "rows"), [(50e3, 9), (7e3, 32)])
def test_contact_that_first_touches_on_the_edge_of_a_wedge_is_solved(load, rows):
    """Forces may be said to add nothing beneath them where the load will be; at the edge itself that is too much."""
    solution = askew(load, rows).solution
    assert solution.residual <= 1e-5
    assert_allclose(solution.load, load, rtol=ROUNDING)
    assert solution.problem.reference < -0.1


@pytest.mark.parametrize("options", [{"load": 50e3}, {"radius": 5.0}])
def test_pressure_beside_the_apex_of_a_wedge_is_below_that_of_a_half_space(options):
    """The wedge is the softer the nearer its edge is, and as soft beyond the place where its faces would meet.

    With a step there the few cells beyond it take several times the pressure, and the more the finer they are.
    """
    wedge, half_space = askew(**options), askew(**options, angle=None)
    assert wedge.pressure < half_space.pressure
    assert wedge.error < 0.02


def test_angle_counts_along_the_columns_and_not_beside_slices_that_tell_the_tilt():
    def slices(places, _):
        return 1e-6 * np.exp(-np.abs(places[:, None] - places))

    for axis, kept in ((1, True), (0, False)):
        options = {"slice_compliance": slices, "slice_axis": axis}
        plain, wedge = tip_peak(None, options=options).pressure, tip_peak(options=options).pressure
        assert (plain == wedge) is kept
    askew = [RoundedEdge((0.0, 1.0), (0.1, 1.0), RADIUS, angle) for angle in (None, 2.0)]
    assert askew[1].free_edge(0.0) is None
    assert peak(edge=askew[0], cells_on_arc=3.0).pressure == peak(edge=askew[1], cells_on_arc=3.0).pressure


@pytest.mark.parametrize("ends", ["both bodies", "one body"])
def test_peak_at_a_rounded_end_is_that_of_quarter_spaces(ends):
    """Of a tenth of the half width: the image is within 6 % of what it stands for, as ``validation`` has it."""
    exact = rounded_ends.exact_peak(0.1, ends, 0.3)
    assert_allclose(rounded_ends.peak_by_images(0.1, ends, 0.3), exact, rtol=0.06)
    assert rounded_ends.peak_by_images(0.1, ends, 0.3, images=False) > 1.5 * exact


test_arguments_that_cannot_be_are_refused = refusals(
    lambda changed: edge_pressures(
        **({"gap": face_end, "box": BOX, "edges": [FACE], "load": 500.0, "contact_modulus": E_STAR} | changed)
    ),
    ({"gap": 1.0}, "^gap: 1.0 is not a function of x and y$"),
    ({"gap": lambda x, y: np.full((x.size, y.size), np.nan)}, "^gap: [0-9]+ cells are NaN"),
    ({"gap": lambda *_: np.zeros((2, 2))}, "^borders: 2 columns have 3, not"),
    ({"box": ((0.0, 1.0), (1.0, 0.0))}, "^box: "),
    ({"box": ((0.0, np.nan), (0.0, 1.0))}, "^box: "),
    ({"box": (0.0, 1.0)}, "^box: "),
    ({"free_edges": [FreeEdge(1, 1.0, "below", 1.0)]}, r"^free_edges\[0\].across: None are not two finite numbers"),
    ({"free_edges": [FreeEdge(1, math.nan, "below", 1.0, (1.0, 1.0))]}, r"^free_edges\[0\].position: nan"),
    ({"edges": []}, r"^edges: \[\] is not a sequence of RoundedEdge$"),
    ({"edges": [1.0]}, "^edges: "),
    ({"edges": [RoundedEdge((0.0, 1.0), (0.0, 0.0), 0.2)]}, r"^edges\[0\]: "),
    ({"edges": [RoundedEdge((0.0, np.nan), (0.0, 1.0), 0.2)]}, r"^edges\[0\]: "),
    ({"edges": [FACE, RoundedEdge((0.0, 1.0), (0.0, 1.0), 0.0)]}, r"^edges\[1\]: "),
    (
        {"edges": [FACE, RoundedEdge((0.0, 1.0), (0.0, 1.0), 0.2, 0.1)]},
        r"^edges\[1\].angle: 0.1 rad is not between",
    ),
    ({"edges": [RoundedEdge((0.0, 1.0), (0.0, 1.0), 0.2, math.nan)]}, r"^edges\[0\].angle: nan rad"),
    ({"edges": [RoundedEdge((0.0, 1.0), (0.0, 1.0), 0.2, 2.0, 1.1)]}, r"^edges\[0\].share: 1.1 is not between"),
    ({"load": 0.0}, "^load: 0.0 N is not positive and finite$"),
    ({"load": np.nan}, "^load: nan N is not"),
    ({"contact_modulus": -1.0}, "^contact_modulus: -1.0 MPa"),
    ({"cells": (32, 3)}, r"^cells: \(32, 3\) are not two whole numbers from 4 on$"),
    ({"cells": 32}, "^cells: 32 are not"),
    ({"cells_on_arc": 1.0}, "^cells_on_arc: 1.0 is not between 2 and 100$"),
    ({"slice_compliance": lambda y, _: np.zeros((y.size, 2))}, "^slice_compliance: shape"),
    ({"slice_axis": 2}, "^slice_axis: 2 is neither 0 nor 1$"),
    ({"tolerance": 0.0}, "^tolerance: 0.0 is not between 0 and 1$"),
    ({"max_pressure": 1.0}, "^load: 500.0 N is more than max_pressure"),
)


def test_failure_of_the_solver_is_told(monkeypatch):
    monkeypatch.setattr("loaded_tca.contact.graded.MOST_ITERATIONS", 1)
    with pytest.raises(ConvergenceError, match=r"^contact on graded columns not converged") as caught:
        peak()
    assert caught.value.last.pressure.max() > 0.0


def test_error_at_an_edge_is_no_less_than_what_finer_cells_leave_of_the_coarser_one():
    """Two solutions agree by chance, of which the coarser one was far from one coarser still."""
    coarser = EdgePressure(100.0, (0.0, 0.0), 0.064, False, 0.01, 5.0, 9, None)
    finer = replace(coarser, pressure=100.1, error=0.002, cells_on_arc=8.0)
    assert finer.compared_with(coarser).error == pytest.approx(0.064 * (5.0 / 8.0) ** 2, rel=ROUNDING)
    assert replace(finer, pressure=110.0).compared_with(coarser).error == pytest.approx(1.0 / 11.0, rel=ROUNDING)
    assert finer.compared_with(replace(coarser, error=math.inf)).error == 0.002


def test_rows_of_a_box_of_whole_rows_do_not_depend_on_rounding():
    """Lengths of boxes are multiples of cells: in another unit of length pressures at edges moved by 0.2 to 5 %."""
    arc = PressedArc(np.zeros(2), np.array([0.0, 1.0]), 0.1, 0.0, 1.0, length=0.7)
    row = 0.7 * CELLS_ON_ARC / ROWS_ON_ARC / 5.0
    assert [arc.rows(5.0, 12.0 * row * part) for part in (1.0 - 1e-9, 1.0 + 1e-9, 12.2 / 12.0)] == [12, 12, 13]
