"""Where on the flanks removed material changes the transmission error."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import QuadMesh
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from scipy.ndimage import gaussian_filter

from loaded_tca.arrays import Array
from loaded_tca.plots import style
from loaded_tca.plots.envelope import POINTS_OF_A_FIELD, points_of_cells
from loaded_tca.plots.flanks import ToPicture, both_flanks
from loaded_tca.plots.style import COLOURS, chosen_torque, load, range_of_positions
from loaded_tca.results.sensitivities import Sensitivities

FIELDS = 160
"""Fields of the picture of a flank in each direction, each coloured by the mean over it."""
FIELDS_OF_SPIKES = 0.005
"""Part of the fields that may lie beyond the scale of colours: single cells at edges count for much."""
LEAST_SHOWN = 0.02
"""Part of the scale of colours below which a field stays white."""
BLUR = 1.0
"""Fields over which weights are spread, so that the points of cells that move across make no pattern of their own."""


def plot_removal_weights(found: Sensitivities, torque: int | None = None) -> Figure:
    """Where material removed from either flank counts: the change of the mean transmission error per area.

    The weight is the growth of the pressure with the torque, over the mean of the positions. Its integral over a flank
    is the change by a removal of 1 um everywhere: the base radius of the wheel over its lever, about 1 um. Between
    two positions the weights move and change evenly from one to the other.

    Parameters
    ----------
    found : Sensitivities
        To any keys: the weights are those of the result.
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
    result = found.result
    torque = chosen_torque(result, torque)
    meshes: list[QuadMesh] = []

    def draw(axes: Axes, to_picture: ToPicture) -> list[Artist]:
        corners = np.transpose([axes.get_xlim(), axes.get_ylim()])
        borders, weights = removal_weights(found, torque, to_picture, *corners)
        meshes.append(axes.pcolormesh(*borders, weights, cmap=COLOURS, rasterized=True))
        return [meshes[-1]]

    figure, panels = both_flanks(result, draw)
    drawn = [np.asarray(mesh.get_array()) for mesh in meshes]
    counting = np.concatenate([weights[weights != 0.0] for weights in drawn] + [np.zeros(1)])
    low, high = np.quantile(counting, (FIELDS_OF_SPIKES, 1.0 - FIELDS_OF_SPIKES)).tolist()
    scale = Normalize(min(low, 0.0), high or 1.0)
    for mesh, weights in zip(meshes, drawn, strict=True):
        mesh.set_array(np.where(np.abs(weights) > LEAST_SHOWN * high, weights, np.nan))
        mesh.set_norm(scale)
    if not counting.any():
        style.tell(panels[0], style.NO_LOAD)
    figure.colorbar(
        ScalarMappable(scale, COLOURS),
        ax=panels,
        label="change of the mean transmission error at the\nwheel's base circle by 1 µm less material on 1 mm² [µm]",
        extend="max" if counting.max() > high else "neither",
    )
    about = f"where removed material counts, {load(result, torque)}", range_of_positions(result)
    style.set_title(figure, result, *about)
    return figure


def removal_weights(
    found: Sensitivities, torque: int, to_picture: ToPicture, low: Array, high: Array
) -> tuple[Array, Array]:
    """Change of the mean transmission error [um] per um of removal and mm2 of a flank, on fields of its picture.

    Borders (2, n + 1) of the fields between two corners of the picture come first, in the units of the picture; then
    the weights (n, n), rows along the height. The area is that of the tangent plane.
    """
    field = (high - low) / FIELDS
    total = np.zeros((FIELDS, FIELDS))
    for places, weights in _passing(found, torque, to_picture, field):
        at = (places - low) / field - 0.5
        first = np.floor(at)
        beyond = at - first
        for corner in np.ndindex(2, 2):  # a point counts in the four fields whose middles are around it
            column, row = (first + np.array(corner)).astype(int).T
            part = np.abs(1.0 - np.array(corner) - beyond).prod(axis=1)
            inside = (column >= 0) & (column < FIELDS) & (row >= 0) & (row < FIELDS)
            np.add.at(total, (row[inside], column[inside]), (weights * part)[inside])
    return np.linspace(low, high, FIELDS + 1).T, gaussian_filter(total, BLUR, truncate=2.0)


def _passing(found: Sensitivities, torque: int, to_picture: ToPicture, field: Array) -> Iterator[tuple[Array, Array]]:
    """Places (m, 2) in the picture of a flank, and what each adds (m,) to the weight of its field per area."""
    result = found.result
    intervals = max(1, len(result.path) - 1)
    for pair, path in enumerate(result.paths):
        middles = to_picture(path.point)
        for position, row in enumerate(found.weight_maps[torque]):
            weight, one = row[pair], result.maps[torque][position][pair]
            if weight is None or one is None:
                continue
            counts = weight != 0.0
            places = to_picture(points_of_cells(one, counts, to_picture, field))
            corners = to_picture(one.corners)
            sides = np.diff(corners, axis=0)[:, :-1], np.diff(corners, axis=1)[:-1]
            area = np.abs(sides[0][..., 0] * sides[1][..., 1] - sides[0][..., 1] * sides[1][..., 0])[counts]
            per_area = weight[counts] * area / (field.prod() * math.prod(one.spacing))
            values = result.wheel_base_radius * np.repeat(per_area / places.shape[1], places.shape[1])
            places = places.reshape(-1, 2)
            if len(result.path) == 1:
                yield places, values
            for beside in (position - 1, position + 1):  # half an interval before, and one behind
                if 0 <= beside < len(result.path):
                    move = middles[beside] - middles[position]
                    move = move if np.isfinite(move).all() else np.zeros(2)
                    steps = 2 + int(POINTS_OF_A_FIELD * (np.abs(move) / field).max())
                    for part in (np.arange(steps) + 0.5) / steps:
                        yield places + part * move, values * (1.0 - part) / (steps * intervals)
