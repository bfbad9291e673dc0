"""Graded subdivisions of a line."""

from __future__ import annotations

import math

import numpy as np

from validation.calculix.tooth_form import Array

SAMPLES = 4001


GROWTH_FROM_ENDS = 0.35
"""Growth of the element size per length away from an end that has a size of its own."""


def graded(
    length: float,
    place: float,
    core: float,
    finest: float,
    growth: float,
    coarsest: float,
    ends: tuple[float, float] = (math.inf, math.inf),
    elements: int | None = None,
) -> Array:
    """Nodes from 0 to ``length``, fine about one place and growing away from it.

    The size is ``finest`` within ``core`` of the place and grows by ``growth`` per length beyond, up to ``coarsest``;
    both ends may have sizes of their own that are smaller. The elements share the integral of its inverse evenly; there
    are as many as the sizes ask for, or a given number of them.

    Returns
    -------
    (2 n + 1,) array [mm]
        Increasing, from exactly 0 to exactly ``length``: the ends of the n elements and their midpoints.
    """
    fine = np.clip(place + core * np.linspace(-2.0, 2.0, SAMPLES), 0.0, length)
    line = np.unique(np.concatenate([np.linspace(0.0, length, SAMPLES), fine]))
    size = np.minimum(finest + growth * np.maximum(np.abs(line - place) - core, 0.0), coarsest)
    for end, away in zip(ends, (line, length - line), strict=True):
        size = np.minimum(size, end + GROWTH_FROM_ENDS * away)
    density = 1.0 / size
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(line))])
    elements = elements or max(1, math.ceil(count[-1]))
    return with_midpoints(np.interp(np.linspace(0.0, count[-1], elements + 1), count, line))


def with_midpoints(nodes: Array) -> Array:
    """The nodes and the middle between any two neighbours."""
    result = np.empty(2 * nodes.size - 1)
    result[::2] = nodes
    result[1::2] = 0.5 * (nodes[1:] + nodes[:-1])
    return result
