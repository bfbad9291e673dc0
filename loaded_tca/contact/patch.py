"""Peak, area and semi-axes of a contact, finer than its cells: all from the square of the pressure.

Across a smooth edge the pressure grows as the root of the distance to it; its square is smooth there, and under
an ellipse it is a quadratic.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.contact.levels import continue_outside, split, window_around

# The fit is that of a quadratic if it leaves this part of the squared peak unexplained (root mean square).
GOOD_FIT = 2e-3
# Along a line of cells the top is that of a parabola if p^2 bends at the largest cell and at those beside it alike, to
# this factor: not on a ridge, where the curvature of the gap jumps.
LIKE_BENDS = 2.0
# Twice as many cells as the quadratic has coefficients.
FEWEST = 12
# Cells on a line, or on another conic, tell no quadratic; rounding leaves this part of the largest eigenvalue.
RANK = 1e-14
# Rows and columns that enter the fit at most: more change its result by less than the solver's tolerance does.
SAMPLES = 48
# A cell is cut into 4 x 4 to find how much of it is in contact.
HALVINGS = 2


def peak_pressure(pressure: Array) -> float:
    """Largest pressure: the top of a quadratic through p^2 over p > p_max/2, or of parabolas, or the largest cell.

    Where no quadratic fits, parabolas along both axes run through the largest cell and those beside it.
    """
    largest = float(pressure.max())
    if largest == 0.0:
        return 0.0
    part = pressure / largest
    if (quadratic := _quadratic_of(part)) is not None:
        return largest * math.sqrt(quadratic[0])
    return largest * math.sqrt((_weights_of_parabolas(part**2) * part**2).sum())


def peak_weights(pressure: Array) -> Array:
    """Weights w (nx, ny) of the cells in the square of the peak pressure, which is the sum of w p^2.

    The peak does not change with the place of the top, where its quadratic is level: its derivative by the pressures is
    w p over the peak, as long as the cells of the fit stay the same.
    """
    largest = float(pressure.max())
    part = pressure / largest if largest > 0.0 else pressure
    if (quadratic := _quadratic_of(part)) is None:
        return _weights_of_parabolas(part**2)
    weights = np.zeros(part.shape)
    _, of_cells, cells = quadratic
    weights[cells] = of_cells()
    return weights


def top_weights(values: Array) -> Array:
    """Weights (3,) of three values at even distances, the middle one the largest, in the top of their parabola.

    They are its derivative by the values too: at its top a parabola is level.

    Examples
    --------
    >>> top_weights(np.array([1.0, 3.0, 3.0]))
    array([-0.125,  0.75 ,  0.375])
    """
    before, after = values[1] - values[0], values[1] - values[2]
    place = 0.5 * (before - after) / (before + after) if before + after > 0.0 else 0.0
    return np.array([0.5 * place * (place - 1.0), 1.0 - place**2, 0.5 * place * (place + 1.0)])


def top_between(places: Array, values: Array, k: int) -> tuple[float, float]:
    """Top of the parabola through the squares of three pressures: its place, and its root over the middle one."""
    if not 0 < k < values.size - 1:
        return float(places[k]), 1.0
    s, square = places[k - 1 : k + 2] - places[k], (values[k - 1 : k + 2] / values[k]) ** 2
    before, after = (square[0] - 1.0) / s[0], (square[2] - 1.0) / s[2]
    bend = (after - before) / (s[2] - s[0])
    slope = before - bend * s[0]
    if bend >= 0.0:
        return float(places[k]), 1.0
    return float(places[k] - 0.5 * slope / bend), math.sqrt(1.0 - 0.25 * slope**2 / bend)


def _weights_of_parabolas(square: Array) -> Array:
    """Weights (nx, ny) of squared pressures in what parabolas along both axes add to the largest of them.

    Nothing along an axis on which the top is none of a parabola.
    """
    weights = np.zeros(square.shape)
    row, column = np.unravel_index(int(square.argmax()), square.shape)
    weights[row, column] = 1.0
    for line, own, k in ((square[:, column], weights[:, column], row), (square[row], weights[row], column)):
        near = line[max(0, k - 2) : k + 3]
        bends = 2.0 * near[1:-1] - near[:-2] - near[2:]
        if k >= 2 and near.size == 5 and near.min() > 0.0 and LIKE_BENDS * bends.min() > bends.max():
            own[k - 1 : k + 2] += top_weights(near[1:4]) - (0.0, 1.0, 0.0)
    return weights


def _quadratic_of(pressure: Array) -> tuple[float, Callable[[], Array], tuple[Indices, Indices]] | None:
    """Top of a quadratic through the squares of pressures (nx, ny), the largest of them 1; None if none fits.

    Also returns a function that returns the weights (n,) of the cells of the fit in it, and these cells.
    """
    square, x, y, cells = _upper_part(pressure)
    if square.size < FEWEST:
        return None
    terms = np.ones((6, x.size))
    terms[1:] = x, y, 0.5 * x * x, x * y, 0.5 * y * y
    # Not by BLAS: its threads wait for each other on a busy machine.
    scales, modes = np.linalg.eigh(np.einsum("ik,jk->ij", terms, terms))
    if scales[0] <= RANK * scales[-1]:
        return None
    fitted = modes @ (modes.T @ np.einsum("ik,k->i", terms, square) / scales)
    misfit = np.einsum("i,ik->k", fitted, terms) - square
    _, by_x, by_y, xx, xy, yy = fitted.tolist()
    bend = xx * yy - xy * xy
    if misfit @ misfit > GOOD_FIT**2 * square.size or xx >= 0.0 or bend <= 0.0:
        return None
    x_top, y_top = (xy * by_y - yy * by_x) / bend, (xy * by_x - xx * by_y) / bend
    if max(abs(x_top), abs(y_top)) > 1.0:
        return None
    at_top = np.array([1.0, x_top, y_top, 0.5 * x_top**2, x_top * y_top, 0.5 * y_top**2])
    return float(at_top @ fitted), lambda: np.einsum("i,ik->k", modes @ (modes.T @ at_top / scales), terms), cells


def area_and_semi_axes(pressure: Array, spacing: tuple[float, float], cover: Array) -> tuple[float, float, float]:
    """Area [mm^2], semi-minor and semi-major axis [mm] of the contact, its edge where p^2 passes through zero.

    ``cover`` is the part of each cell that has material: nothing beyond it counts. The axes are those of the ellipse
    with the same second moments of area, at any angle to the grid.
    """
    window, parts = window_around(pressure > 0.0), 2**HALVINGS
    square = continue_outside(pressure[window] ** 2)
    for _ in range(HALVINGS):
        square = split(split(square, -2), -1)
    inside = (square > 0.0) * cover[window].repeat(parts, axis=0).repeat(parts, axis=1)
    sums, cells = (inside.sum(axis=1), inside.sum(axis=0)), inside.sum()
    width, length = (size / parts for size in spacing)
    x, y = (np.arange(n) - np.arange(n) @ own / cells for n, own in zip(inside.shape, sums, strict=True))
    moments = np.array([[x * x @ sums[0], 0.0], [x @ (inside @ y), y * y @ sums[1]]]) / cells + np.eye(2) / 12.0
    minor, major = 2.0 * np.sqrt(np.linalg.eigvalsh(moments * np.outer((width, length), (width, length))))
    return float(cells) * width * length, float(minor), float(major)


def _upper_part(pressure: Array) -> tuple[Array, Array, Array, tuple[Indices, Indices]]:
    """Square of the pressures above a half, their places, both axes scaled to -1 ... 1, and cells; thinned if many."""
    high = pressure > 0.5
    rows, columns = (np.nonzero(high.any(axis=axis))[0] for axis in (1, 0))
    rows, columns = (index[:: -(-index.size // SAMPLES)] for index in (rows, columns))
    row, column = high[rows][:, columns].nonzero()
    cells = rows[row], columns[column]
    return pressure[cells] ** 2, _centred(rows)[row], _centred(columns)[column], cells


def _centred(index: NDArray[np.intp]) -> Array:
    """Positions scaled to -1 ... 1."""
    low, high = int(index[0]), int(index[-1])
    return np.asarray((2.0 * index - (low + high)) / max(1, high - low), dtype=np.float64)


def reaches_border(pressure: Array) -> bool:
    """Whether the outermost cells of the grid carry pressure."""
    return bool(pressure[[0, -1]].any() or pressure[:, [0, -1]].any())


def ends_at_material(pressure: Array, void: Mask) -> bool:
    """Whether the contact goes on to where the material ends.

    At a smooth end of a contact p^2 falls linearly with the distance. Where the last cell beside a void has less than a
    third of the p^2 of the cell before it, that line reaches zero inside the last cell: the contact ends of itself.
    """
    if not void.any():
        return False
    square = np.zeros((pressure.shape[0] + 2, pressure.shape[1] + 2))  # no pressure before the first cell
    square[1:-1, 1:-1] = pressure * pressure
    for squares, beyond in ((square[:, 1:-1], void), (square[1:-1].T, void.T)):
        last = np.where(squares[1:-1] > 0.0, 3.0 * squares[1:-1], -1.0)
        if (beyond[1:] & (last >= squares[:-2])[:-1]).any() or (beyond[:-1] & (last >= squares[2:])[1:]).any():
            return True
    return False


def widths(pressure: Array, cover: Array) -> Array:
    """Width (ny,) of the contact on each line of cells across, in cells, its ends found as in ``values_at_ends``.

    Zero where a line has no pressure. The outermost cells of the grid carry none.
    """
    square, parts = continue_outside(pressure**2).T, cover.T
    pressed, lines, cells = square > 0.0, np.arange(len(square)), np.zeros(len(square))
    for step, end in ((-1, pressed.argmax(axis=1)), (1, square.shape[1] - 1 - pressed[:, ::-1].argmax(axis=1))):
        end = np.where(pressed.any(axis=1), end, 1)
        inside, beyond = square[lines, end], square[lines, end + step]
        farthest = np.where(parts[lines, end + step] > 0.0, 1.0, parts[lines, end] - 0.5)
        cells += step * end + np.minimum(inside / np.where(pressed.any(axis=1), inside - beyond, 1.0), farthest)
    return np.where(pressed.any(axis=1), cells, 0.0)


def values_at_ends(pressure: Array, values: Array, cover: Array, axes: tuple[int, ...] = (0, 1)) -> Array:
    """Values (n,), known at the centres of the cells, at the ends of the contact between these centres.

    The square of the pressure falls linearly to zero at an end, but no farther away than the next centre; or than the
    end of the material, ``cover`` being the part of each cell that has some. Only ends along ``axes`` are told.
    """
    square = continue_outside(pressure**2)
    values_of = []
    for axis in axes:
        levels, known, parts = (array.swapaxes(0, axis) for array in (square, values, cover))
        for inner, outer in ((slice(-1), slice(1, None)), (slice(1, None), slice(-1))):
            ends = (levels[inner] > 0.0) & (levels[outer] <= 0.0)
            inside, beyond = levels[inner][ends], levels[outer][ends]
            farthest = np.where(parts[outer][ends] > 0.0, 1.0, parts[inner][ends] - 0.5)
            part = np.minimum(inside / (inside - beyond), farthest)
            values_of.append(known[inner][ends] + part * (known[outer][ends] - known[inner][ends]))
    return np.concatenate(values_of)
