"""Surface displacement of a half-space under uniform pressure on a rectangle (Love 1929)."""

import math
from typing import Any

import numpy as np

from loaded_tca.arrays import Array

# Beyond this many cell widths the series replaces the four-term formula: its error, of the order of
# (cell/distance)^4/100, and the cancellation of the formula, eps (distance/cell)^2, are both below 1e-9 there.
FAR_FIELD = 60.0
# Of a place from a border it may lie on: y log(1/y) there is zero.
TINY = 1e-150
# The series takes several arrays of its size: so many rows at a time, to keep them small.
ROWS = 64


def influence_coefficients(shape: tuple[int, int], aspect: float | Array) -> Array:
    r"""Displacement at the centres of a quadrant of cells, caused by unit pressure on the cell at its corner.

    Lengths are counted in cell widths dx, and the result in dx/E*, so that one array serves every size of cell:

    .. math::
        K_{ij} = [F(x_+, y_+) - F(x_-, y_+) - F(x_+, y_-) + F(x_-, y_-)]/\pi,\quad
        F(x, y) = x\,\mathrm{asinh}(y/|x|) + y\,\mathrm{asinh}(x/|y|)

    with :math:`x_\pm = i \pm 1/2`, :math:`y_\pm = (j \pm 1/2)\,dy/dx`. Far away the four terms cancel and

    .. math::
        K_{ij} = \frac{dy/dx}{\pi r} \left[1 + \frac{3 x^2/r^2 - 1}{24 r^2}
            + \frac{dy^2}{dx^2} \frac{3 y^2/r^2 - 1}{24 r^2}\right]

    takes their place. The displacement is even in x and in y, so a quadrant is all there is.

    Parameters
    ----------
    shape : (int, int)
        Cells of the quadrant (nx, ny), both at least 1.
    aspect : float or (count,) array
        dy/dx; of several grids at once.

    Returns
    -------
    (nx, ny) or (count, nx, ny) array [dx/E*]
        Displacement at the cell (i, j) by unit pressure on the cell (0, 0).

    References
    ----------
    Love 1929, Phil. Trans. R. Soc. A 228, 377-420; Johnson 1985, Contact Mechanics, section 3.6.
    """
    if isinstance(aspect, np.ndarray):
        if max(shape) <= FAR_FIELD:
            return _near_field(shape, aspect)
        return np.stack([influence_coefficients(shape, each) for each in aspect.tolist()])
    reach = FAR_FIELD * max(1.0, aspect)
    near = (min(shape[0], int(reach) + 1), min(shape[1], int(reach / aspect) + 1))
    if near == shape:
        return _near_field(shape, aspect)
    coefficients = np.empty(shape)
    for start in range(0, shape[0], ROWS):
        rows = slice(start, min(start + ROWS, shape[0]))
        coefficients[rows] = _far_field(rows, shape[1], aspect)
    coefficients[: near[0], : near[1]] = _near_field(near, aspect)
    return coefficients


def column_coefficients(
    rows: int, spacing: float, borders: Array, places: Array | None = None, far: float = FAR_FIELD
) -> Array:
    r"""Displacement between cells of columns of unlike widths, by unit forces on them.

    Pressure on a cell of the column n, of the width w_n, displaces the centre of one of the column m, i cells of the
    width dx away along the columns, by

    .. math::
        D_{mn}(i) = \frac{1}{\pi w_n} \left[F(x_+, y_+) - F(x_-, y_+) - F(x_+, y_-) + F(x_-, y_-)\right]

    times p w_n/E*, with F of :func:`influence_coefficients`, x_+- = (i +- 1/2) dx, and y_+- the borders of the column n
    seen from the middle of m. Even columns have the coefficients of a uniform grid; only they are symmetric.

    Parameters
    ----------
    rows : int
        Cells along the columns, at least 1.
    spacing : float [mm]
        dx.
    borders : (ny + 1,) array [mm]
        Of the columns, increasing.
    places : (ny,) array, optional [mm]
        Of what is displaced, across the columns; their middles if absent.
    far : float
        Rows that are so many lengths and widths of the largest cell away have the series; see :func:`far_from`.

    Returns
    -------
    (rows, ny, ny) array
        D(i), displaced columns before pressed ones.

    References
    ----------
    Love 1929, Phil. Trans. R. Soc. A 228, 377-420.
    """
    widths, middles = np.diff(borders), 0.5 * (borders[1:] + borders[:-1])
    places = middles if places is None else places
    offsets = borders - places[:, None]
    side, size = np.sign(offsets), np.maximum(np.abs(offsets), TINY)
    apart, largest = np.abs(middles - places[:, None]), np.maximum(spacing, widths)
    coefficients = np.empty((rows, places.size, widths.size))
    near = math.ceil(min(rows, far * float(largest.max()) / spacing + 1.0))
    last = -_corner(0.5 * spacing, size)
    for row in range(near):
        corner = _corner((row + 0.5) * spacing, size)
        coefficients[row] = np.diff(side * (corner - last), axis=1) / (np.pi * widths)
        away = np.hypot(apart, row * spacing) > FAR_FIELD * largest
        if away.any():
            w = np.broadcast_to(widths, away.shape)[away]
            coefficients[row][away] = _far_column(row * spacing, apart[away], spacing, w)
        last = corner
    for row in range(near, rows):
        coefficients[row] = _far_column(row * spacing, apart, spacing, widths)
    return coefficients


def column_coefficients_across(rows: int, spacing: float, borders: Array, places: Array) -> Array:
    r"""The part y^2/R^2 of what :func:`column_coefficients` has, y the distance across the columns.

    .. math:: \frac{1}{\pi w_n} \int\!\!\int \frac{y^2}{R^3}\, dx\, dy, \qquad
              \int\!\!\int \frac{y^2}{R^3}\, dx\, dy = x\, \mathrm{arsinh} \frac{y}{|x|}

    over the corners of the cells.

    Parameters
    ----------
    rows, spacing, borders, places
        As for :func:`column_coefficients`.

    Returns
    -------
    (rows, ny, ny) array
        Displaced columns before pressed ones.
    """
    offsets, coefficients = borders - places[:, None], np.empty((rows, places.size, borders.size - 1))
    last = -0.5 * spacing * np.arcsinh(offsets / (0.5 * spacing))
    for row in range(rows):
        x = (row + 0.5) * spacing
        corner = x * np.arcsinh(offsets / x)
        coefficients[row] = np.diff(corner - last, axis=1) / (np.pi * np.diff(borders))
        last = corner
    return coefficients


def far_from(tolerance: float) -> float:
    """Cells from which on the relative error of the series is below a tolerance, or that of rounding.

    On the line of a narrow cell, where it is largest, the series lacks ``1/(80 d**4)`` at the distance of d cells.
    """
    return min(FAR_FIELD, (80.0 * tolerance) ** -0.25)


def _far_column(x: float, y: Array, spacing: float, widths: Array) -> Array:
    """The series of :func:`influence_coefficients`, by unit forces on cells x and y away."""
    inverse = 1.0 / (x * x + y * y)
    long, wide = spacing**2 / 24.0, widths**2 / 24.0
    quadrupole = (3.0 * (long - wide)) * (x * x * inverse) + (2.0 * wide - long)
    return np.asarray((spacing / np.pi) * np.sqrt(inverse) * (1.0 + quadrupole * inverse))


def _corner(x: float, y: Array) -> Array:
    """F for x > 0 and y > 0: with logarithms, which take a quarter of the time of inverse hyperbolic sines."""
    r = np.hypot(x, y)
    return np.asarray(x * np.log((y + r) / x) + y * np.log((x + r) / y))


def own_coefficient(aspect: float | Array) -> Any:
    """Displacement [dx/E*] at the centre of a cell by unit pressure on itself; of one aspect dy/dx or of several."""
    return (2.0 / np.pi) * (np.arcsinh(aspect) + aspect * np.arcsinh(1.0 / aspect))


def _near_field(shape: tuple[int, int], aspect: float | Array) -> Array:
    """Love's formula: the double difference of F over the corners of the cells."""
    x = (np.arange(shape[0] + 1) - 0.5)[:, None]
    y = (np.arange(shape[1] + 1) - 0.5) * np.asarray(aspect)[..., None, None]
    corner = x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))
    return np.asarray(np.diff(np.diff(corner, axis=-2), axis=-1) / np.pi, dtype=np.float64)


def _far_field(rows: slice, columns: int, aspect: float) -> Array:
    """Series for distances large against the cell; the cell at the corner, distance zero, gets the value 0."""
    x2 = (np.arange(rows.start, rows.stop, dtype=np.float64) ** 2)[:, None]
    y2 = ((np.arange(columns) * aspect) ** 2)[None, :]
    squared = x2 + y2
    squared[squared == 0.0] = np.inf
    inverse = 1.0 / squared
    quadrupole = (3.0 * (x2 + aspect**2 * y2) * inverse - (1.0 + aspect**2)) * inverse / 24.0
    return np.asarray((aspect / np.pi) * np.sqrt(inverse) * (1.0 + quadrupole), dtype=np.float64)
