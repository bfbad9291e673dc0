"""Images in edges at an angle to the grid: against sums written out, exact reflections and planes of symmetry."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import FreeEdge, edge_of_plane, solve_contact
from loaded_tca.contact.edges import MirroredConvolution, mirrors
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.contact.oblique import ObliqueImage, ObliqueMirror
from loaded_tca.errors import InputError
from loaded_tca.reference import hertz

E_STAR, LOAD = 115e3, 100.0
# Transforms of some hundred cells against a sum, relative to the largest value.
ROUNDING = 1e-13
SHAPE, ASPECT = (9, 7), 1.7

MIRRORS = [
    ObliqueMirror(0, 6.2, 0.4, True, 0.7),
    ObliqueMirror(0, 4.0, -0.9, False, 1.7),
    ObliqueMirror(1, 2.0, 0.5, True, 0.7),
    ObliqueMirror(1, 3.0, -0.3, False, 1.7),
    ObliqueMirror(0, 14.3, 0.3, True, 1.0),
]


def matrix(shape, aspect, mirror):
    """Influence matrix of the image, written out: every cell before the edge is shared out over two straight cells."""
    reach = influence_coefficients((60, 60), aspect)
    cells = list(np.ndindex(shape))
    shared = {}
    for cell in cells:
        place = mirror.first + mirror.slope * (cell[1 - mirror.axis] + 0.5)
        deep = (place - cell[mirror.axis] - 0.5) * (1.0 if mirror.below else -1.0) - 0.5
        if deep >= -0.5:
            part = deep - math.floor(deep)
            shared[cell] = {max(0, math.floor(deep)): 1.0 - part}
            shared[cell][math.floor(deep) + 1] = shared[cell].get(math.floor(deep) + 1, 0.0) + part
    whole = np.zeros((len(cells), len(cells)))
    for m, one in enumerate(cells):
        for n, other in enumerate(cells):
            row = abs(one[1 - mirror.axis] - other[1 - mirror.axis])
            for here, a in shared.get(one, {}).items():
                for there, b in shared.get(other, {}).items():
                    apart = (here + there + 1, row) if mirror.axis == 0 else (row, here + there + 1)
                    whole[m, n] += mirror.factor * a * b * reach[apart]
    return whole


@pytest.mark.parametrize("mirror", MIRRORS)
@pytest.mark.parametrize(("dtype", "error"), [("float64", ROUNDING), ("float32", 1e-6)])
def test_displacement_is_the_sum_over_images(mirror, dtype, error):
    pressure = np.random.default_rng(1).random(SHAPE).astype(dtype)
    found = np.zeros(SHAPE)
    ObliqueImage(SHAPE, ASPECT, mirror, dtype).add(pressure, found)
    expected = matrix(SHAPE, ASPECT, mirror) @ pressure.ravel()
    assert expected.max() > 0.0
    assert_allclose(found.ravel(), expected, atol=error * expected.max())


@pytest.mark.parametrize("mirror", MIRRORS)
def test_influence_matrix_is_symmetric_and_positive_semidefinite(mirror):
    columns = []
    image = ObliqueImage(SHAPE, ASPECT, mirror)
    for unit in np.eye(math.prod(SHAPE)):
        columns.append(np.zeros(SHAPE))
        image.add(unit.reshape(SHAPE), columns[-1])
    whole = np.array([column.ravel() for column in columns])
    assert_allclose(whole, whole.T, atol=ROUNDING * whole.max())
    assert np.linalg.eigvalsh(whole).min() > -1e-12 * whole.max()


@pytest.mark.parametrize("mirror", MIRRORS)
def test_displacement_of_a_window_is_that_of_the_whole_pressure(mirror):
    pressure, window = np.zeros(SHAPE), (slice(1, 5), slice(2, 6))
    pressure[window] = np.random.default_rng(2).random((4, 4))
    whole = MirroredConvolution(SHAPE, ASPECT, (mirror,))(pressure, np.empty(SHAPE))
    part = MirroredConvolution(SHAPE, ASPECT, (mirror,), window)(pressure[window], np.empty(SHAPE))
    assert_allclose(part, whole, atol=ROUNDING * whole.max())


def test_edge_counted_from_a_window_is_the_same_edge():
    edge, spacing = FreeEdge(0, 0.6, "below", 0.7, slope=0.05), (0.1, 0.4)
    (whole,), (part,) = mirrors((edge,), spacing), mirrors((edge,), spacing, (2, 3))
    row = np.arange(4) + 0.5
    assert_allclose(part.first + part.slope * row, whole.first + whole.slope * (row + 3) - 2)


def test_edge_without_slope_is_a_straight_one():
    """Cut between cells: the oblique image at a slope of rounding is the straight image."""
    pressure = np.random.default_rng(3).random(SHAPE)
    straight, oblique = (
        mirrors((FreeEdge(0, 9.0, "below", 1.3, slope=slope),), (1.0, ASPECT)) for slope in (0.0, 1e-9)
    )
    assert type(straight[0]) is not type(oblique[0])
    one, other = (MirroredConvolution(SHAPE, ASPECT, edges)(pressure, np.empty(SHAPE)) for edges in (straight, oblique))
    assert_allclose(other, one, atol=ROUNDING * one.max())


@pytest.mark.parametrize("degrees", [5.0, 10.0, 15.0])
def test_image_lies_where_the_edge_reflects_the_load(degrees):
    """A point force and a point some cells beside it, both before the edge: the distance to its reflection."""
    angle, width = math.radians(degrees), 0.01
    edge = edge_of_plane((math.cos(angle), math.sin(angle), 0.0), 0.4, (width, width), (121, 121), 1.0, straight=False)
    pressure, found = np.zeros((121, 121)), np.zeros((121, 121))
    pressure[60, 60] = 1.0
    ObliqueImage((121, 121), 1.0, *mirrors((edge,), (width, width))).add(pressure, found)
    image = 0.8 * np.array([math.cos(angle), math.sin(angle)])
    for cell in [(60, 60), (70, 60), (60, 80), (60, 40), (40, 75)]:
        place = (np.array(cell) - 60.0) * width
        exact = width / (math.pi * math.hypot(*(place - image)))
        # whole cells (1 % here) and lengths along the edge, 1 - cos of its angle
        assert_allclose(found[cell], exact, rtol=0.015 + 1.5 * (1.0 - math.cos(angle)))


@pytest.mark.parametrize("degrees", [8.0, -15.0, 98.0])
def test_half_of_a_round_contact_is_mirrored_in_any_line_through_its_middle(degrees):
    """Factor one makes the edge a plane of symmetry: half the load, the same approach and the same pressure."""
    contact = hertz.point_contact(LOAD, (0.1, 0.1), E_STAR)
    cells, width = 64, 3.0 * contact.semi_major / 64
    x = (np.arange(cells) - 31.5) * width
    gap, normal = (x[:, None] ** 2 + x**2) / 20.0, [math.cos(math.radians(degrees)), math.sin(math.radians(degrees))]
    edge = edge_of_plane((*normal, 0.0), 0.0, (width, width), gap.shape, 1.0, straight=False)
    half = solve_contact(gap, (width, width), E_STAR, load=0.5 * LOAD, tolerance=1e-8, free_edges=[edge], warn=False)
    # whole cells along the cut, 1 of 43 across, and the cosine of the angle
    assert_allclose(half.approach, contact.approach, rtol=1.5e-2)
    beyond = normal[0] * x[:, None] + normal[1] * x > width
    assert not half.pressure[beyond].any()
    radius = np.hypot(x[:, None], x)
    expected = contact.max_pressure * np.sqrt(np.maximum(0.0, 1.0 - (radius / contact.semi_major) ** 2))
    inside = (normal[0] * x[:, None] + normal[1] * x < -4.0 * width) & (radius < 0.9 * contact.semi_major)
    assert_allclose(half.pressure[inside], expected[inside], atol=0.05 * contact.max_pressure)


def test_oblique_edge_takes_pressure_off_and_adds_to_the_approach():
    x = (np.arange(32) - 15.5) * 0.01
    gap, spacing = np.repeat(x[:, None] ** 2 / 20.0, 40, axis=1), (0.01, 0.1)
    edge = FreeEdge(0, 0.05, "below", 0.4, slope=0.08)
    plain, found = (
        solve_contact(gap, spacing, E_STAR, load=300.0, free_edges=[replace(edge, factor=factor)], warn=False)
        for factor in (0.0, 0.4)
    )
    assert found.pressure.max() < plain.pressure.max()
    assert found.approach > 1.02 * plain.approach
    assert_allclose(found.load, 300.0, rtol=1e-12)
    place = 0.05 + 0.08 * (np.arange(40) + 0.5) * 0.1
    assert not found.pressure[(np.arange(32)[:, None] + 0.5) * 0.01 > place].any()


def test_slope_that_is_no_number_is_named():
    edge = FreeEdge(0, 0.05, "below", 0.4, slope=math.inf)
    with pytest.raises(InputError, match=r"free_edges\[0\].slope: inf"):
        solve_contact(np.zeros((8, 8)), (0.01, 0.01), E_STAR, load=1.0, free_edges=[edge])
