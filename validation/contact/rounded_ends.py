"""Peaks at rounded ends of contacts that cross them: images on the cells against Hetenyi's quarter-space.

A cylinder of which both bodies, or one, end at right angles in a rounding, narrow or wide over the half width a of the
contact. The quarter-space is solved with its own operator of pressures and its own active set; the gap is the same.
Radii of arcs are small against the bodies: beneath an arc the material goes on as without it, in both solutions.

Source: Hetenyi 1960, J. Appl. Mech. 27, 289-296, as ``validation.contact.free_edge`` has it.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from loaded_tca.contact import FreeEdge, RoundedEdge, edge_pressures, factors_across
from loaded_tca.contact.edges import extra_displacement
from validation.contact.free_edge import SOURCE, quarter_space
from validation.table import Row

Array = NDArray[np.float64]

PRESSURE, LENGTH, STEP, ROWS = 4.2e-3, 12.0, 0.12, 10
"""Peak pressure of the cylinder in plane strain over E*, its length, and cells along the edge: their length, and how
many on one of two sides that are alike. Lengths are in half widths of the contact."""
FINE, EVEN, GROWTH, COARSE = 5.0, 12, 1.3, 0.5
"""Cells of the quarter-space on the pressed part, how many are as fine on either side of the beginning of the arc, the
ratio of one to the next, and the widest."""
RADII = (0.02, 0.1, 0.3, 1.0)
CASES = {("both bodies", 0.3): 6e-2, ("one body", 0.3): 6e-2, ("both bodies", 0.25): 1e-1}
"""Bodies that end, Poisson's ratio, and how well the peak is to be met: the factor is that of nu = 0.3 to 2 %."""


def gap(x: Array, y: Array, radius: float, arcs: int) -> Array:
    """A cylinder that ends at y = 0, with the arcs of one or of both bodies."""
    beyond = np.maximum(radius - y, 0.0)
    arc = beyond**2 / (radius + np.sqrt(np.maximum(radius**2 - beyond**2, 0.0)))
    return np.asarray(PRESSURE * x[:, None] ** 2 + arcs * arc)


def pressed(radius: float) -> float:
    """About how far an arc is pressed: a notch as deep as the radius, of half the radius, under the pressure."""
    intensity = 1.1215 * PRESSURE * np.sqrt(0.5 * radius)
    return float(0.5 * (3.0 * np.sqrt(2.0) * np.pi * intensity * 0.5 * radius) ** (2.0 / 3.0))


def bounds(radius: float) -> Array:
    """Bounds of cells off the end, fine where the arc begins."""
    fine = pressed(radius) / FINE
    widths = fine * np.concatenate([np.ones(EVEN), GROWTH ** np.arange(1, 60)])
    inner, outer = (np.cumsum(np.minimum(widths, widest)) for widest in (COARSE, 0.25))
    towards_end = radius - outer[outer < radius - 0.3 * fine]
    return np.concatenate([[0.0], towards_end[::-1], [radius], radius + inner[inner < LENGTH - radius], [LENGTH]])


@cache
def exact_peak(radius: float, ends: str, poisson_ratio: float) -> float:
    """Peak pressure near the end over that of the cylinder, where bodies are quarter-spaces or one is a half-space."""
    edges, arcs = bounds(radius), 2 if ends == "both bodies" else 1
    space, x = quarter_space(poisson_ratio, edges, STEP), STEP * np.arange(ROWS)
    coefficients = 0.5 * arcs * space.exact() + (1.0 - 0.5 * arcs) * space.own
    apart, sum_of = np.abs(x[:, None] - x) / STEP, (x[:, None] + x) / STEP
    there = [part.round().astype(int) for part in (apart, sum_of)]
    of_both = coefficients[:, :, there[0]] + np.where(x == 0.0, 0.0, 1.0) * coefficients[:, :, there[1]]
    matrix = of_both.transpose(2, 0, 3, 1).reshape(ROWS * len(space.y), -1)
    areas = (np.where(x == 0.0, 1.0, 2.0)[:, None] * STEP * np.diff(edges)).ravel()
    pressure = solved(matrix, gap(x, space.y, radius, arcs).ravel(), areas, 0.5 * np.pi * PRESSURE * LENGTH)
    near = pressure.reshape(ROWS, -1)[:, space.y < radius + 1.0]
    return float(near.max()) / PRESSURE


def solved(matrix: Array, heights: Array, areas: Array, load: float) -> Array:
    """Pressures over E* under a load: cells that pull are let go, then those that overlap are taken in."""
    inside = heights < np.quantile(heights, 0.9)
    for _ in range(100):
        cells = inside.nonzero()[0]
        even, of_gap = np.linalg.solve(
            matrix[np.ix_(cells, cells)], np.stack([np.ones(cells.size), heights[cells]], 1)
        ).T
        approach = (load + areas[cells] @ of_gap) / (areas[cells] @ even)
        pressure = np.zeros(heights.size)
        pressure[cells] = approach * even - of_gap
        pulled = pressure < 0.0
        overlaps = ~inside & (matrix @ np.maximum(pressure, 0.0) + heights < approach - 1e-12)
        if not pulled.any() and not overlaps.any():
            return pressure
        inside = inside & ~pulled if pulled.any() else inside | overlaps
    raise RuntimeError("cells of the quarter-space do not settle")


def peak_by_images(radius: float, ends: str, poisson_ratio: float, *, images: bool = True) -> float:
    """The same by images on the cells, or as a half-space."""
    arcs, angle = 2 if ends == "both bodies" else 1, 0.5 * np.pi
    factors = factors_across(angle, poisson_ratio, 0.5 * arcs)
    end = FreeEdge(1, 0.0, "above", 0.5 * arcs * extra_displacement(angle), factors)
    edge = RoundedEdge((0.0, radius), (0.0, -1.0), radius)
    (peak,) = edge_pressures(
        lambda x, y: gap(x, y, radius, arcs),
        ((-1.4, 1.4), (0.0, LENGTH)),
        [edge],
        0.5 * np.pi * PRESSURE * LENGTH,
        1.0,
        cells=(24, 24),
        free_edges=[end] if images else [],
    )
    return peak.pressure / PRESSURE


def rows() -> list[Row]:
    """Peaks over that of the cylinder in plane strain."""
    table = []
    for (ends, poisson_ratio), tolerance in CASES.items():
        for radius in RADII:
            case = f"rounded end of {ends}, r/a {radius:g}, nu {poisson_ratio:g}"
            exact = exact_peak(radius, ends, poisson_ratio)
            by_images = peak_by_images(radius, ends, poisson_ratio)
            table.append(Row(case, SOURCE, "peak, image on the cells", exact, by_images, tolerance))
            if poisson_ratio == 0.3:
                half_space = peak_by_images(radius, ends, poisson_ratio, images=False)
                table.append(Row(case, SOURCE, "peak, half-space", exact, half_space, None))
    return table
