"""Free edges: images against sums written out, symmetry planes, limits, conditions, and every refusal."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import (
    ContactProblem,
    ContactStatus,
    FreeEdge,
    contact_stiffness,
    factors_across,
    quarter_space_factor,
    solve_contact,
    solve_to_accuracy,
    wedge_factor,
)
from loaded_tca.contact.edges import POWER, Mirror, MirroredConvolution
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.reference import hertz
from tests.refusals import refusals

E_STAR, LOAD = 115e3, 100.0
PSI = quarter_space_factor(0.3)
# Transforms of some hundred cells against a sum, relative to the largest value.
ROUNDING = 1e-13
# Two solves to a residual of 1e-9: the pressure follows to about its root.
SOLVED = 1e-4


def centred(n, width):
    return (np.arange(n) - (n - 1) / 2) * width


def bowl(shape=(40, 48), radius=10.0, width=0.012, offset=0.0):
    """Gap of a ball on a plane [mm], its middle moved along the second axis."""
    x, y = centred(shape[0], width), centred(shape[1], width) - offset
    return (x[:, None] ** 2 + y**2) / (2.0 * radius), (width, width)


def image(edge, cell):
    moved = list(cell)
    moved[edge.axis] = edge.double - 1 - cell[edge.axis]
    return tuple(moved)


def matrix(shape, aspect, edges):
    """Influence matrix with images, written out cell by cell."""
    cells = list(np.ndindex(shape))
    reach = influence_coefficients((200, 200), aspect)
    by = lambda one, other: reach[abs(one[0] - other[0]), abs(one[1] - other[1])]  # noqa: E731
    whole = np.zeros((len(cells), len(cells)))
    for i, one in enumerate(cells):
        for j, other in enumerate(cells):
            whole[i, j] = by(one, other) + sum(edge.factor * by(one, image(edge, other)) for edge in edges)
            for k, first in enumerate(edges):
                for second in edges[k + 1 :]:
                    if first.axis != second.axis:
                        corner = image(second, image(first, other))
                        whole[i, j] += first.factor * second.factor * by(one, corner)
    return whole


EDGES = [
    (Mirror(1, 14, PSI),),
    (Mirror(1, 0, PSI),),
    (Mirror(0, 13, 0.7),),
    (Mirror(0, -9, PSI), Mirror(0, 12, 0.9)),
    (Mirror(0, 0, PSI), Mirror(1, 15, 0.9)),
    (Mirror(0, -2, PSI), Mirror(0, 12, PSI), Mirror(1, -3, 0.9), Mirror(1, 14, 0.5)),
]


@pytest.mark.parametrize("edges", EDGES)
@pytest.mark.parametrize(("dtype", "error"), [("float64", ROUNDING), ("float32", 1e-6)])
def test_displacement_is_the_sum_over_pressures_and_images(edges, dtype, error):
    shape, aspect = (6, 7), 1.7
    pressure = np.random.default_rng(1).random(shape).astype(dtype)
    found = MirroredConvolution(shape, [aspect], edges, dtype=dtype)(pressure[None], np.empty((1, *shape)))
    expected = matrix(shape, aspect, edges) @ pressure.ravel()
    assert_allclose(found.ravel(), expected, atol=error * expected.max())


@pytest.mark.parametrize("edges", EDGES)
def test_displacement_of_a_window_is_that_of_the_whole_pressure(edges):
    pressure, window = np.zeros((6, 7)), (slice(1, 4), slice(2, 6))
    pressure[window] = np.random.default_rng(2).random((3, 4))
    whole = MirroredConvolution((6, 7), [0.6], edges)(pressure[None], np.empty((1, 6, 7)))
    convolve, calls = MirroredConvolution((6, 7), [0.6], edges, window), []
    once = convolve._convolve
    convolve._convolve = lambda *given: calls.append(given) or once(*given)
    part = convolve(pressure[None, *window], np.empty((1, 6, 7)))
    assert_allclose(part, whole, atol=ROUNDING * whole.max())
    assert len(calls) == 1


@pytest.mark.parametrize("edges", EDGES[:3] + EDGES[4:5])
@pytest.mark.parametrize("aspect", [0.1, 1.0, 30.0])
def test_influence_matrix_with_images_is_symmetric_and_positive_definite(edges, aspect):
    whole = matrix((6, 7), aspect, edges)
    assert_allclose(whole, whole.T, rtol=ROUNDING)  # one coefficient on both sides
    assert np.linalg.eigvalsh(whole).min() > 0.0


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("material", ["below", "above"])
def test_factor_one_is_a_plane_of_symmetry(axis, material):
    """Half of a symmetric contact, mirrored in its middle, is the whole contact."""
    gap, spacing = bowl((48, 48))
    whole = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9)
    kept = (slice(0, 24), slice(None)) if material == "below" else (slice(24, None), slice(None))
    position = 24 * spacing[0] if material == "below" else 0.0
    kept = kept if axis == 0 else kept[::-1]
    edge = FreeEdge(axis, position, material, 1.0)
    half = solve_contact(gap[kept], spacing, E_STAR, load=LOAD / 2, tolerance=1e-9, free_edges=[edge], warn=False)
    assert half.status is ContactStatus.CONVERGED
    assert_allclose(half.pressure, whole.pressure[kept], atol=SOLVED * whole.peak_pressure)
    assert_allclose(half.approach, whole.approach, rtol=1e-6)


def test_factor_one_twice_is_a_corner_of_symmetry():
    gap, spacing = bowl((48, 48))
    whole = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9)
    edges = [FreeEdge(0, 0.0, "above", 1.0), FreeEdge(1, 24 * spacing[1], "below", 1.0)]
    part = solve_contact(gap[24:, :24], spacing, E_STAR, load=LOAD / 4, tolerance=1e-9, free_edges=edges, warn=False)
    assert_allclose(part.pressure, whole.pressure[24:, :24], atol=SOLVED * whole.peak_pressure)


def test_factor_zero_is_a_half_space():
    gap, spacing = bowl()
    edge = FreeEdge(1, 48 * spacing[1], "below", 0.0)
    plain = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9)
    found = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9, free_edges=[edge])
    assert_allclose(found.pressure, plain.pressure, atol=SOLVED * plain.peak_pressure)


def test_far_edge_adds_the_approach_of_a_point_force():
    """The image of the load acts as a point force at twice the distance: psi F/(2 pi E* d)."""
    gap, spacing = bowl()
    plain = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9)
    for distance in (2.0, 4.0):
        edge = FreeEdge(1, 24 * spacing[1] + distance, "below", PSI)
        found = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9, free_edges=[edge])
        added = PSI * LOAD / (2.0 * math.pi * E_STAR * distance)
        # (a/2d)^2 of the image, and the approach of the other contact shape: below 1 %
        assert_allclose(found.approach - plain.approach, added, rtol=1e-2)


def test_edge_makes_the_contact_softer_and_takes_pressure_off_it():
    """A cylinder that ends: the spike at its end falls, the approach and the stiffness follow."""
    x = centred(32, 0.01)
    gap, spacing = np.repeat(x[:, None] ** 2 / 20.0, 40, axis=1), (0.01, 0.1)
    edge = FreeEdge(1, 4.0, "below", PSI)
    plain = solve_contact(gap, spacing, E_STAR, load=1500.0, warn=False)
    found = solve_contact(gap, spacing, E_STAR, load=1500.0, free_edges=[edge], warn=False)
    assert found.approach > 1.05 * plain.approach
    assert found.pressure[:, -1].max() < 0.9 * plain.pressure[:, -1].max()
    assert contact_stiffness(found) < 0.97 * contact_stiffness(plain)
    # beyond the middle the other end feels nothing but the tilt that the approach forbids
    assert found.pressure[:, 0].max() > plain.pressure[:, 0].max()


def test_tangent_stiffness_with_an_edge_is_the_slope_of_the_load():
    gap, spacing = bowl(offset=0.1)
    edge = FreeEdge(1, 40.5 * spacing[1], "below", PSI)
    options = {"tolerance": 1e-10, "free_edges": [edge], "warn": False}
    solution = solve_contact(gap, spacing, E_STAR, load=LOAD, **options)
    step = 1e-3 * solution.approach
    loads = [solve_contact(gap, spacing, E_STAR, approach=solution.approach + s, **options).load for s in (-step, step)]
    # a contact grows by whole cells: some percent on a contact of 24
    assert_allclose(contact_stiffness(solution), (loads[1] - loads[0]) / (2.0 * step), rtol=5e-2)


@pytest.mark.quick_cases("None-30.5", "1200.0-24.0")
@pytest.mark.parametrize("position", [24.0, 30.5, 37.2])
@pytest.mark.parametrize("cap", [None, 1200.0])
def test_contact_conditions_hold_with_an_edge_anywhere(position, cap):
    shape = (20, 24)
    gap, spacing = bowl(shape, width=0.025, offset=0.05)
    edge = FreeEdge(1, position * spacing[1] / 2.0, "below", PSI)
    options = {"max_pressure": cap, "tolerance": 1e-8, "free_edges": [edge], "warn": False}
    found = solve_contact(gap, spacing, E_STAR, load=LOAD, **options)
    unit = spacing[0] / E_STAR
    low, part = int(position), position % 1.0
    images = (Mirror(1, low, (1.0 - part) * PSI), Mirror(1, low + 1, part * PSI))  # parts of both between half cells
    whole = matrix(shape, 1.0, images)
    excess = unit * (whole @ found.pressure.ravel()).reshape(shape) + gap - found.approach
    top = math.inf if cap is None else cap
    inner = (found.pressure > 0.0) & (found.pressure < top)
    assert np.abs(excess[inner]).max() < 1e-5 * found.approach
    within = np.isfinite(found.gap) & (found.pressure == 0.0)
    assert excess[within].min() > -1e-6 * found.approach
    assert_allclose(found.gap[within], excess[within], atol=1e-12)  # mm: 1e-9 of the gap
    assert_allclose(found.pressure.sum() * spacing[0] * spacing[1], LOAD, rtol=ROUNDING)


def test_nothing_is_carried_beyond_an_edge():
    gap, spacing = bowl()
    edge = FreeEdge(1, 24.0 * spacing[1], "above", PSI)
    found = solve_contact(gap, spacing, E_STAR, load=LOAD, free_edges=[edge], warn=False)
    assert not found.pressure[:, :24].any()
    assert found.pressure[:, 24].any()
    assert np.isinf(found.gap[:, :24]).all()
    assert found.problem.free_edges == (edge,)


def test_edge_turned_round_mirrors_the_pressure():
    gap, spacing = bowl(offset=0.1)
    width = 48 * spacing[1]
    edge = FreeEdge(1, 40 * spacing[1], "below", PSI)
    turned = replace(edge, position=width - edge.position, material="above")
    one = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-9, free_edges=[edge])
    other = solve_contact(gap[:, ::-1], spacing, E_STAR, load=LOAD, tolerance=1e-9, free_edges=[turned])
    assert_allclose(other.pressure[:, ::-1], one.pressure, atol=SOLVED * one.peak_pressure)


def test_pressure_at_a_crossed_edge_converges_with_the_grid():
    """A ball cut by the edge at half its contact radius: the approach settles, by jumps of the edge of the contact."""
    contact = hertz.point_contact(LOAD, (0.1, 0.1), E_STAR)
    a, approaches = contact.semi_major, []
    for n in (16, 32, 64, 128):
        width = 4.0 * a / n
        gap, spacing = bowl((n, n), width=width)
        edge = FreeEdge(1, 2.5 * a, "below", PSI)
        found = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-8, free_edges=[edge], warn=False)
        approaches.append(found.approach)
    steps = np.abs(np.diff(approaches))
    assert (steps[1:] < steps[:-1]).all()
    assert steps[-1] < 0.5 * steps[0]
    assert steps[-1] < 1e-3 * approaches[-1]
    assert approaches[-1] > 1.2 * contact.approach


def test_accuracy_is_reached_with_an_edge():
    edge = FreeEdge(1, 0.55, "below", PSI)

    def problem(cells):
        widths = 0.6 / cells[0], 0.6 / cells[1]
        x, y = centred(cells[0], widths[0]), centred(cells[1], widths[1])
        gap = (x[:, None] ** 2 + y**2) / 20.0
        return ContactProblem(gap, widths, E_STAR, load=LOAD, free_edges=[edge])

    found = solve_to_accuracy(problem, accuracy=2e-3)
    assert found.error_estimate.peak_pressure <= 2e-3
    assert found.problem.free_edges == (edge,)


def test_factor_grows_with_poissons_ratio_and_with_the_share():
    assert quarter_space_factor(0.4) > quarter_space_factor(0.3) > quarter_space_factor(0.0) > 1.0
    assert quarter_space_factor(0.3, share=0.5) == 0.5 * quarter_space_factor(0.3)
    assert quarter_space_factor(0.3, share=0.0) == 0.0


def test_wedge_of_a_right_angle_is_the_quarter_space_and_of_two_no_edge():
    for nu in (0.0, 0.3, 0.5):
        # the right angle is the quarter space, times a ratio of one
        assert wedge_factor(0.5 * math.pi, nu, 0.5) == quarter_space_factor(nu, 0.5)
        assert_allclose(wedge_factor(math.pi, nu), 0.0, atol=1e-12)  # the sine of pi


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_factor_across_an_edge_has_its_mean_at_nine_tenths_and_falls_off_the_own_place(nu):
    """psi(S) is psi at S = 0.9, and grows by 0.4 from S = 0 to 1 at a right angle, as fitted to the quarter-space."""
    for angle in (0.5 * math.pi, 2.0):
        far, own = factors_across(angle, nu, 0.5)
        assert_allclose(far + 0.9 * (own - far), wedge_factor(angle, nu, 0.5), rtol=ROUNDING)
    assert_allclose(np.ptp(factors_across(0.5 * math.pi, nu)), 0.4, rtol=ROUNDING)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_factor_falls_with_the_angle_of_the_material(nu):
    factors = [wedge_factor(math.radians(angle), nu) for angle in range(30, 181, 5)]
    assert (np.diff(factors) < 0.0).all()
    assert factors[-1] >= 0.0


def michell(angle):
    """What a wedge yields more than a half-space under a line load normal to one face at its edge, over the latter.

    Radial stresses (a cos t + b sin t)/r balance the load, and the edge moves with it by the same a and b.
    """
    nodes, weights = np.polynomial.legendre.leggauss(40)
    turn = 0.5 * angle * (1.0 + nodes)
    rays = np.array([np.cos(turn), np.sin(turn)])
    balance = (0.5 * angle * weights * rays) @ rays.T
    return 0.5 * math.pi * np.linalg.inv(balance)[1, 1] - 1.0


@pytest.mark.parametrize("degrees", [50.0, 75.0, 105.0, 117.0, 135.0, 160.0])
def test_factor_follows_michells_wedge(degrees):
    ratio = wedge_factor(math.radians(degrees), 0.3) / quarter_space_factor(0.3)
    assert_allclose(ratio, (michell(math.radians(degrees)) / michell(0.5 * math.pi)) ** POWER, rtol=1e-9)
    # Hetenyi in plane strain: the side returns 2/pi of a load, and twice that falls on the top again
    # an inverse of condition 4: 5e-15 seen
    assert_allclose(1.0 + michell(0.5 * math.pi), 2.0 / (1.0 - (2.0 / math.pi) ** 2), rtol=ROUNDING)


@pytest.mark.parametrize("degrees", [30.0, 60.0, 120.0])
def test_contact_at_a_sharp_or_blunt_edge_converges_and_yields_more_the_sharper_it_is(degrees):
    gap, spacing = bowl(offset=0.1)
    approaches = []
    for angle in (degrees, degrees + 15.0):
        edge = FreeEdge(1, 40 * spacing[1], "below", wedge_factor(math.radians(angle), 0.3))
        found = solve_contact(gap, spacing, E_STAR, load=LOAD, tolerance=1e-8, free_edges=[edge], warn=False)
        assert found.status is ContactStatus.CONVERGED
        assert_allclose(found.pressure.sum() * spacing[0] * spacing[1], LOAD, rtol=ROUNDING)
        approaches.append(found.approach)
    assert approaches[0] > approaches[1]


test_edges_that_cannot_be_used_are_named = refusals(
    lambda change: solve_contact(
        *bowl(), E_STAR, load=LOAD, free_edges=[replace(FreeEdge(1, 0.5, "below", PSI), **change)]
    ),
    ({"axis": 2}, r"free_edges\[0\].axis: 2"),
    ({"position": math.nan}, r"free_edges\[0\].position: nan"),
    ({"material": "left"}, r"free_edges\[0\].material: 'left'"),
    ({"factor": -1.0}, r"free_edges\[0\].factor: -1.0"),
    ({"factor": math.inf}, r"free_edges\[0\].factor: inf"),
    ({"across": (1.0, 1.0)}, r"free_edges\[0\].across: \(1.0, 1.0\) counts on columns of unlike widths alone"),
    ({"across": (1.0,)}, r"free_edges\[0\].across: \(1.0,\) are not two finite numbers from 0 on"),
    ({"across": (-1.0, 1.0)}, r"free_edges\[0\].across: \(-1.0, 1.0\) are not two"),
    ({"position": -1.0}, "free_edges: no cell within them holds material"),
)
test_factor_refuses = refusals(
    wedge_factor,
    *(
        (angle, 0.3, r"angle: .* is not between 30 and 180 degrees")
        for angle in (0.0, math.radians(29.0), 3.2, math.nan)
    ),
    (0.1, 0.6, -0.1, ("^angle: ", "^poisson_ratio: ", "^share: ")),
)


def test_approach_does_not_jump_with_the_place_of_an_edge():
    """An edge beside the contact, moved by tenths of a cell: the approach falls evenly."""
    gap, spacing = bowl((20, 24), width=0.025, offset=0.05)
    places = np.arange(26.0, 27.01, 0.1)
    found = [
        solve_contact(
            gap, spacing, E_STAR, load=LOAD, free_edges=[FreeEdge(1, place * spacing[1], "below", PSI)], warn=False
        ).approach
        for place in places
    ]
    steps = np.diff(found)
    assert (steps < 0.0).all()
    assert steps.min() > 3.0 * steps.max()
