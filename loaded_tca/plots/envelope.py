"""The highest pressure that each place of both flanks sees while the teeth pass through the mesh."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from loaded_tca.arrays import Array, Mask
from loaded_tca.plots import style
from loaded_tca.plots.flanks import ToPicture, both_flanks, colour_scale, loaded_maps
from loaded_tca.plots.style import COLOURS, chosen_torque, load, range_of_positions
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.separation import slice_middles

FIELDS = 240
"""Fields of the picture of a flank in each direction, each coloured by the highest pressure in it."""
POINTS_OF_A_FIELD = 1.5
"""Points of a pressure map in the length of a field: more than one, so that no field between two points stays empty."""


def plot_pressure_envelope(result: MeshCycle, torque: int | None = None) -> Figure:
    """Highest pressure that each place of both flanks sees over the cycle, from the maps of all pairs.

    Between two positions the contact moves evenly from one place to the other, and its pressure changes evenly.

    Parameters
    ----------
    result : MeshCycle
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque.
    """
    torque = chosen_torque(result, torque)
    figure, _ = _envelopes(result, [torque])
    style.set_title(figure, result, f"pressure envelope, {load(result, torque)}", range_of_positions(result))
    return figure


def plot_contact_patterns(result: MeshCycle) -> Figure:
    """Loaded contact pattern under each torque on one scale: the highest pressure that each place of both flanks sees.

    A row for each torque, of many torques four from the least to the largest; each row is
    :func:`plot_pressure_envelope` under its torque.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    shown = style.torques_with_panels(result)
    figure, panels = _envelopes(result, shown)
    for torque, axes in zip(shown, panels[::2], strict=True):
        axes.set_ylabel(f"{style.torque_label(result, torque)}\n{axes.get_ylabel()}")
    style.set_title(figure, result, f"loaded contact patterns, {style.loads(result)}", range_of_positions(result))
    return figure


def _envelopes(result: MeshCycle, torques: list[int]) -> tuple[Figure, list[Axes]]:
    """Both flanks with their pressure envelope in a row for each torque, without a title."""
    maps = [one for torque in torques for one in loaded_maps(result, torque)]
    scale, extend = colour_scale(result, maps)

    def draw(torque: int, axes: Axes, to_picture: ToPicture) -> list[Artist]:
        low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
        borders, seen = pressure_seen(result, torque, to_picture, low, high)
        return [axes.pcolormesh(*borders, seen, cmap=COLOURS, norm=scale, rasterized=True)]

    figure, panels = both_flanks(result, *(partial(draw, torque) for torque in torques))
    figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, label="highest contact pressure [MPa]", extend=extend)
    return figure, panels


def _passing(result: MeshCycle, torque: int, to_picture: ToPicture, field: Array) -> Iterator[tuple[Array, Array]]:
    """Places (k, 2) in the picture of a flank and the pressure (k,) that they see.

    Of each map all cells, and from each position to the next the ridge of the pressure, which no place between sees
    anything higher than.
    """
    for passage in zip(*result.maps[torque], strict=True):
        before = None
        for one in passage:
            if one is None or not one.pressure.any():
                before = None
                continue
            loaded = one.pressure > 0.0
            cells = to_picture(points_of_cells(one, loaded, to_picture, field))
            yield cells.reshape(-1, 2), np.repeat(one.pressure[loaded], cells.shape[1])
            points, height = _ridge(one)
            ridge = to_picture(points), height
            if before is not None:
                moved = np.abs(ridge[0] - before[0]) / field
                part = np.linspace(0.0, 1.0, 2 + int(POINTS_OF_A_FIELD * moved.max()))[:, None]
                places, heights = (a + np.multiply.outer(part[:, 0], b - a) for a, b in zip(before, ridge, strict=True))
                yield places.reshape(-1, 2), heights.ravel()
            before = ridge


def points_of_cells(one: PressureMap, cells: Mask, to_picture: ToPicture, field: Array) -> Array:
    """Points (n, m, 3) within the n cells of a mask (nx, ny), m in each: so close that no field stays empty."""
    corners = to_picture(one.corners)
    across, along = (
        1 + int(POINTS_OF_A_FIELD * (np.abs(np.diff(corners, axis=axis)) / field).max()) for axis in (0, 1)
    )
    rows, columns = np.nonzero(cells)
    (dx, dy), (u, v) = one.spacing, ((np.arange(count) + 0.5) / count - 0.5 for count in (across, along))
    x = (one.x[rows, None, None] + dx * u[:, None] + np.zeros(along)).reshape(len(rows), -1, 1)
    y = (one.y[columns, None, None] + dy * v + np.zeros((across, 1))).reshape(len(rows), -1, 1)
    return one.origin + x * one.axes[0] + y * one.axes[1]


def _ridge(one: PressureMap) -> tuple[Array, Array]:
    """Points (n, 3) evenly along the middle of the pressure, from one end of the contact to the other, and its height.

    The ends are those of the cells, not their centres, so that no stripe is left at the end of a face.
    """
    loaded, across = slice_middles(one.x, one.pressure)
    half = 0.5 * one.spacing[1]
    y = np.linspace(one.y[loaded[0]] - half, one.y[loaded[-1]] + half, 2 * FIELDS)
    x, height = (np.interp(y, one.y[loaded], values) for values in (across, one.pressure[:, loaded].max(axis=0)))
    return one.origin + x[:, None] * one.axes[0] + y[:, None] * one.axes[1], height


def pressure_seen(
    result: MeshCycle, torque: int, to_picture: ToPicture, low: Array, high: Array
) -> tuple[Array, Array]:
    """Highest pressure that each place of a flank sees, NaN where none, on fields between two corners of a picture.

    Borders (2, n + 1) of the fields come first, in the units of the picture.
    """
    field = (high - low) / FIELDS
    highest = np.zeros((FIELDS, FIELDS))
    for places, pressure in _passing(result, torque, to_picture, field):
        column, row = np.floor((places - low) / field).astype(int).T
        inside = (column >= 0) & (column < FIELDS) & (row >= 0) & (row < FIELDS)
        np.maximum.at(highest, (row[inside], column[inside]), pressure[inside])
    return np.linspace(low, high, FIELDS + 1).T, np.where(highest > 0.0, highest, np.nan)
