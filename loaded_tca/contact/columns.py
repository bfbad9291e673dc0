r"""Columns of graded width beside rounded edges, as fine as the pressed part of each rounding asks for.

Where a flat part of the half width a goes over into a rounding of the radius R, a load P per length of the edge presses
a strip of the rounding of the width

.. math:: d = \frac{a}{2} \left(\frac{3 P R}{E^* a^2}\right)^{2/3}

some micrometres, in which the pressure rises to its peak and falls to zero. With m cells on it across the edge the
relative error of the peak is 0.12/m^2 at the most where a column begins with the rounding
(``docs/studies/rounded_edge.md``); away from the edge columns grow.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array, Indices, real
from loaded_tca.errors import require, require_positive
from loaded_tca.plain import plain

GROWTH = 1.3
"""Width of a column over that of its neighbour nearer to the edge."""
EVEN = 1.5
"""Half width of the part around the edge where columns are even, over d: the pressed part and some reserve."""
SAMPLES = 4000
"""Places at which the density of columns is told between two edges."""
MOST_COLUMNS = 2000


ROUNDING = 1e-6
"""Part of a cell that asks for no other one: lengths in the ratio of whole numbers of cells end on a border, but for
the tolerance of solutions."""


def whole_cells(count: ArrayLike) -> Indices:
    """Fewest whole cells for numbers of cells that lengths ask for, whatever the unit of these.

    Examples
    --------
    >>> whole_cells([19.3, 20.0 - 1e-9, 20.0 + 1e-9]).tolist()
    [20, 20, 20]
    """
    return np.asarray(np.ceil(np.asarray(count) - ROUNDING).astype(int))


def pressed_width(line_load: float, radius: float, half_width: float, contact_modulus: float) -> float:
    r"""Width d of the pressed part of a rounding beside a flat part.

    It is the limit of a small d/a of the closed form of a flat punch with rounded ends.

    Parameters
    ----------
    line_load : float [N/mm]
        P, per length of the edge.
    radius : float [mm]
        R, of the rounding.
    half_width : float [mm]
        a, of the flat part.
    contact_modulus : float [MPa]
        E*.

    Returns
    -------
    float [mm]

    Raises
    ------
    InputError
        If an argument is not positive and finite.

    References
    ----------
    Ciavarella, Hills & Monno 1998, Proc. Inst. Mech. Eng. C 212, 319-328.

    Examples
    --------
    >>> round(pressed_width(174.53, 0.2, 0.1, 113187.0), 6)  # closed form: 0.01
    0.010228
    """
    require_positive(line_load=line_load, radius=radius, half_width=half_width, contact_modulus=contact_modulus)
    return 0.5 * half_width * (3.0 * line_load * radius / (contact_modulus * half_width**2)) ** (2.0 / 3.0)


@dataclass(frozen=True)
class FineZone:
    """Where columns are fine.

    Parameters
    ----------
    place : float [mm]
        Where the rounding begins; a border between columns.
    width : float [mm]
        Of the finest columns.
    reach : float [mm]
        Distance from the place within which columns are as fine as that.
    """

    place: float
    width: float
    reach: float


def column_borders(low: float, high: float, zones: Sequence[FineZone], widest: float, growth: float = GROWTH) -> Array:
    """Borders of columns that are fine in some zones and grow away from them.

    Parameters
    ----------
    low, high : float [mm]
        Ends of the box.
    zones : sequence of FineZone
        Those whose places lie outside the box count as far as they reach or grow into it.
    widest : float [mm]
        Largest width of a column.
    growth : float
        Largest width of a column over that of its neighbour, above 1.

    Returns
    -------
    (ny + 1,) array [mm]
        From ``low`` to ``high``; the places of the zones within are among them, but for those nearer to that of another
        zone than half of their columns' width. No column is wider than asked for.

    Raises
    ------
    InputError
        With every problem of the arguments, and if there would be more than 2000 columns.

    Examples
    --------
    >>> column_borders(0.0, 4.0, [FineZone(3.0, 0.1, 0.1)], 2.0, growth=2.0).round(2).tolist()
    [0.0, 1.48, 2.23, 2.61, 2.8, 2.9, 3.0, 3.09, 3.17, 3.3, 3.55, 4.0]
    """
    wrong = [zone for zone in zones if not _sound(zone)]
    require(
        (-math.inf < real(low) < real(high) < math.inf, f"low, high: {low} and {high} mm are not in order and finite"),
        (not wrong, f"zones: a place is not finite, a width not positive or a reach negative in {wrong}"),
        (0.0 < real(widest) < math.inf, f"widest: {widest} mm is not positive and finite"),
        (1.0 < real(growth) < math.inf, f"growth: {growth} is not above 1"),
    )
    places = [low]
    for zone in sorted(zones, key=lambda zone: zone.place):
        if low < zone.place < high and (len(places) == 1 or zone.place - places[-1] >= 0.5 * zone.width):
            places.append(zone.place)
    places.append(high)
    borders = [np.array([low])]
    for start, stop in pairwise(places):
        # Where a zone ends the density of columns changes fast; samples are dense beside both ends.
        part = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, SAMPLES))
        ends = [zone.place + side * zone.reach for zone in zones for side in (-1.0, 1.0)]
        y = np.union1d(start + (stop - start) * part, [end for end in ends if start < end < stop])
        density = np.full(y.size, 1.0 / widest)
        for zone in zones:
            beyond = np.maximum(np.abs(y - zone.place) - zone.reach, 0.0)
            # Columns w, w g, w g^2 ... stand ln(1 + (g - 1) D/w)/ln g on a distance D.
            grown = (growth - 1.0) / math.log(growth) / (zone.width + (growth - 1.0) * beyond)
            density = np.maximum(density, np.where(beyond > 0.0, grown, 1.0 / zone.width))
        count = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(y))))
        columns = max(1, int(whole_cells(count[-1])))
        require(
            (
                columns <= MOST_COLUMNS,
                f"zones: {columns} columns from {plain(start, 6)} to {plain(stop, 6)} mm are above 2000",
            )
        )
        borders.append(np.interp(np.linspace(0.0, count[-1], columns + 1)[1:-1], count, y))
        borders.append(np.array([stop]))
    return np.concatenate(borders)


def _sound(zone: FineZone) -> bool:
    """Whether a zone is one."""
    return (
        isinstance(zone, FineZone)
        and math.isfinite(real(zone.place))
        and bool(0.0 < real(zone.width) < math.inf and 0.0 <= real(zone.reach) < math.inf)
    )
