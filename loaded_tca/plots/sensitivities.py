"""Pictures of sensitivities: what tolerances do to key figures and to the transmission error, to first order.

Where on the flanks removed material changes the transmission error.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle

import numpy as np
import scipy
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import QuadMesh
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.flanks import ToPicture, both_flanks
from loaded_tca.plots.pressure_map import POINTS_OF_A_FIELD, points_of_cells
from loaded_tca.plots.study_panels import panels_of, without_unit
from loaded_tca.plots.style import (
    COLOURS,
    DISTINCT_COLOURS,
    MARKERS,
    chosen_torque,
    label_of,
    load,
    loads,
    range_of_positions,
)
from loaded_tca.results.figures import key_figures
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.sensitivities import Sensitivities
from loaded_tca.results.summary import shown
from loaded_tca.results.tolerances import default_tolerances, key_figure_slopes

FIELDS = 160
"""Fields of the picture of a flank in each direction, each coloured by the mean over it."""
FIELDS_OF_SPIKES = 0.005
"""Part of the fields that may lie beyond the scale of colours: single cells at edges count for much."""
MEAN = "transmission_error_mean_um"
LEAST_SHOWN = 0.02
"""Part of the scale of colours below which a field stays white."""
BLUR = 1.0
"""Fields over which weights are spread, so that the points of cells that move across make no pattern of their own."""


def plot_removal_weights(sensitivities: Sensitivities, torque: int | None = None) -> Figure:
    """Where material removed from either flank counts: the change of the mean transmission error per area.

    The weight is the growth of the pressure with the torque, over the mean of the positions. Its integral over a flank
    is the change by a removal of 1 um everywhere: the base radius of the wheel over its lever, about 1 um. Between
    two positions the weights move and change evenly from one to the other.

    Parameters
    ----------
    sensitivities : Sensitivities
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
    result = sensitivities.result
    torque = chosen_torque(result, torque)
    meshes: list[QuadMesh] = []

    def draw(axes: Axes, to_picture: ToPicture) -> list[Artist]:
        corners = np.transpose([axes.get_xlim(), axes.get_ylim()])
        borders, weights = removal_weights(sensitivities, torque, to_picture, *corners)
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
    sensitivities: Sensitivities, torque: int, to_picture: ToPicture, low: Array, high: Array
) -> tuple[Array, Array]:
    """Change of the mean transmission error [um] per um of removal and mm2 of a flank, on fields of its picture.

    Borders (2, n + 1) of the fields between two corners of the picture come first, in the units of the picture; then
    the weights (n, n), rows along the height. The area is that of the tangent plane.
    """
    field = (high - low) / FIELDS
    total = np.zeros((FIELDS, FIELDS))
    for places, weights in _passing(sensitivities, torque, to_picture, field):
        at = (places - low) / field - 0.5
        first = np.floor(at)
        beyond = at - first
        for corner in np.ndindex(2, 2):  # a point counts in the four fields whose middles are around it
            column, row = (first + np.array(corner)).astype(int).T
            part = np.abs(1.0 - np.array(corner) - beyond).prod(axis=1)
            inside = (column >= 0) & (column < FIELDS) & (row >= 0) & (row < FIELDS)
            np.add.at(total, (row[inside], column[inside]), (weights * part)[inside])
    return np.linspace(low, high, FIELDS + 1).T, scipy.ndimage.gaussian_filter(total, BLUR, truncate=2.0)


def _passing(
    sensitivities: Sensitivities, torque: int, to_picture: ToPicture, field: Array
) -> Iterator[tuple[Array, Array]]:
    """Places (m, 2) in the picture of a flank, and what each adds (m,) to the weight of its field per area."""
    result = sensitivities.result
    intervals = max(1, len(result.path) - 1)
    for pair, path in enumerate(result.paths):
        middles = to_picture(path.point)
        for position, row in enumerate(sensitivities.weight_maps[torque]):
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


RAISED, LOWERED = "#0072b2", "#e69f00"
"""Of a key that is raised, and lowered, by its tolerance: told apart by colour-blind readers and in grey."""
MOST_BARS = 12
MOST_CURVES = 8
CURVE_COLOURS = (*DISTINCT_COLOURS, "black", "0.55")
SMALLEST_SPAN_UM = 1e-4
BANDS = ((1.0, 0.45), (2.0, 0.2))
"""Standard deviations either side, and how opaque the band is."""
BASE_CIRCLE = "at the wheel's base circle [µm]"


SENSITIVITY_PICTURES = "tornado", "sensitivity_curves", "transmission_error_band", "removal_weights"
"""Names of the pictures of sensitivities, without their ending."""


WITHOUT_MOUNTING = "mounting errors move whole gears: they turn the wheel by a constant, and are left out here"
"""Why a panel has fewer keys than the others."""
WITH_MOUNTING = (
    "bands on the left contain mounting errors, which turn the wheel by a constant; the tornado leaves them out of the "
    "mean transmission error"
)
"""Why the absolute transmission error scatters more than its mean does in the tornado."""
MOUNTING = "mounting."
"""Beginning of the keys of mounting errors."""


def sensitivity_pictures(
    sensitivities: Sensitivities, tolerances: Mapping[str, float], torque: int
) -> dict[str, Figure]:
    """Return all pictures of sensitivities under one torque by the names of their files, bands under all torques."""
    figures = (
        plot_tornado(sensitivities, tolerances, torque=torque),
        plot_sensitivity_curves(sensitivities, tolerances, torque),
        plot_transmission_error_band(sensitivities, tolerances),
        plot_removal_weights(sensitivities, torque),
    )
    return dict(zip(SENSITIVITY_PICTURES, figures, strict=True))


def plot_tornado(
    sensitivities: Sensitivities,
    tolerances: Mapping[str, float] | None = None,
    figures: Sequence[str] | None = None,
    torque: int | None = None,
    *,
    rigid_motions: bool = False,
) -> Figure:
    """Tornado chart: what each key does to key figures when it is raised, or lowered, by its tolerance.

    A panel for each figure, its bars sorted by their lengths; of many keys those with the longest. First order:
    sensitivity times tolerance.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float, optional
        Standard deviations of the keys, in their units; default: ``default_tolerances``.
    figures : sequence of str, optional
        Names of :func:`loaded_tca.results.key_figure_slopes`; default: all that are known.
    torque : int, optional
        Index of the torque; default: the largest one.
    rigid_motions : bool
        Whether the mean transmission error shows mounting errors, too: as motions of whole gears they turn the wheel by
        a constant that dwarfs all other bars and makes no noise.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque, a figure is not one of these, or a key has no tolerance.
    """
    result = sensitivities.result
    torque = chosen_torque(result, torque)
    spread = _spread(sensitivities, tolerances)
    changes = {name: values[torque] * spread for name, values in key_figure_slopes(sensitivities).items()}
    unknown = [name for name in figures or () if name not in changes]
    require((not unknown, f"figures: {', '.join(unknown)} unknown; allowed {', '.join(changes)}"))
    chosen = figures or [name for name, values in changes.items() if np.isfinite(values).any()]
    if not chosen:
        raise InputError(f"nothing is under load with {style.torque_label(result, torque)}: no derivatives")
    now = key_figures(result, torque)
    labels = [_with_tolerance(key, one) for key, one in zip(sensitivities.keys, spread.tolist(), strict=True)]
    rigid = np.array([key.startswith(MOUNTING) for key in sensitivities.keys])
    left_out_of_mean = bool(rigid.any()) and not rigid_motions and not rigid.all() and MEAN in chosen
    if left_out_of_mean:
        changes[MEAN] = np.where(rigid, np.nan, changes[MEAN])
    bars = min(len(labels), MOST_BARS)
    drawing, panels = panels_of(len(chosen), (6.5, 1.0 + 0.3 * max(bars, 3)))
    for axes, name in zip(panels, chosen, strict=True):
        _draw_tornado(axes, changes[name], labels)
        without = left_out_of_mean and name == MEAN
        together = math.sqrt(float((changes[name][~rigid] ** 2).sum() if without else (changes[name] ** 2).sum()))
        label = label_of(name)
        unit = label.partition(" [")[2].rstrip("]")
        by = "keys but mounting errors" if without else "all keys"
        title = f"now {shown(now[name], name)} {unit}, standard deviation by {by} {plain(together, 3)} {unit}"
        why = f"\n{WITHOUT_MOUNTING}" if without else ""
        axes.set_title(" ".join(title.split()).replace(" ,", ",") + why, fontsize="small")
        axes.set_xlabel(f"change of the {label}")
    drawing.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize="small")
    left_out = f", {bars} of {len(labels)} keys" * (bars < len(labels))
    about = f"sensitivity times tolerance{left_out}, {load(result, torque)}", "lengths at the wheel's base circle"
    style.set_title(drawing, result, *about)
    return drawing


def _draw_tornado(axes: Axes, changes: Array, labels: Sequence[str]) -> None:
    """Bars either side of zero, the longest on top; a word where nothing is known."""
    axes.grid(alpha=0.3, axis="x")
    axes.axvline(0.0, color="black", linewidth=0.8)
    known = np.flatnonzero(np.isfinite(changes))
    if not known.size:
        axes.set_yticks([])
        style.tell(axes, "not known")
    order = known[np.argsort(-np.abs(changes[known]), kind="stable")][:MOST_BARS]
    places = np.arange(len(order))
    axes.barh(places, changes[order], color=RAISED, label="key raised by its tolerance")
    axes.barh(places, -changes[order], color=LOWERED, label="key lowered by its tolerance")
    axes.set_yticks(places, [labels[k] for k in order], fontsize="small")
    axes.invert_yaxis()
    longest = float(np.abs(changes[order]).max(initial=0.0)) or 1.0
    axes.set_xlim(-1.05 * longest, 1.05 * longest)
    axes.xaxis.set_major_locator(MaxNLocator(5))


def plot_sensitivity_curves(
    sensitivities: Sensitivities, tolerances: Mapping[str, float] | None = None, torque: int | None = None
) -> Figure:
    """Change of the transmission error over the positions by the tolerance of each key: absolute, and about its mean.

    Of many keys those whose curves vary most.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float, optional
        Standard deviations of the keys, in their units; default: ``default_tolerances``.
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque, or a key no tolerance.
    """
    result = sensitivities.result
    torque = chosen_torque(result, torque)
    spread = _spread(sensitivities, tolerances)
    curves = 1e3 * result.wheel_base_radius * sensitivities.transmission_error[torque] * spread
    figure = Figure(figsize=(8.0, 7.0), layout="constrained")
    absolute, about_mean = figure.subplots(2, 1, sharex=True)
    known = np.isfinite(curves).all(axis=1)
    swings = np.ptp(curves[known], axis=0) if known.any() else np.zeros(len(spread))
    drawn = np.sort(np.argsort(-swings, kind="stable")[:MOST_CURVES])
    angle = np.degrees(result.pinion_angle)
    for k, colour, marker in zip(drawn.tolist(), CURVE_COLOURS, cycle(MARKERS), strict=False):
        label, curve = _with_tolerance(sensitivities.keys[k], float(spread[k]), "+"), curves[:, k]
        absolute.plot(angle, curve, color=colour, marker=marker, markersize=4.0, label=label)
        about_mean.plot(angle, curve - mean_over_a_pitch(curve), color=colour, marker=marker, markersize=4.0)
    absolute.set_ylabel(f"change of the transmission error\n{BASE_CIRCLE}")
    about_mean.set_ylabel("change less its mean [µm]")
    about_mean.set_xlabel("pinion angle [deg]")
    if not known.any():
        style.tell(absolute, style.NO_LOAD)
    for axes in (absolute, about_mean):
        style.widen(axes, SMALLEST_SPAN_UM)
        axes.grid(alpha=0.3)
    figure.legend(*absolute.get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize="small")
    which = f"{len(drawn)} of {len(spread)} keys" if len(drawn) < len(spread) else "each key"
    about = f"change by the tolerance of {which}, {load(result, torque)}", range_of_positions(result)
    style.set_title(figure, result, *about)
    return figure


def plot_transmission_error_band(
    sensitivities: Sensitivities, tolerances: Mapping[str, float] | None = None, torque: int | None = None
) -> Figure:
    """Transmission error over the positions with bands of one and two standard deviations, absolute and about its mean.

    A row for each torque, of many torques four. The bands are those of independent keys, to first order.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float, optional
        Standard deviations of the keys, in their units; default: ``default_tolerances``.
    torque : int, optional
        Index of the only torque to show.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque, or a key no tolerance.
    """
    result = sensitivities.result
    given = dict(zip(sensitivities.keys, _spread(sensitivities, tolerances).tolist(), strict=True))
    shown_torques = style.torques_with_panels(result) if torque is None else [chosen_torque(result, torque)]
    length = 1e3 * result.wheel_base_radius
    sigma = length * sensitivities.spread(given)["transmission_error"].values
    figure = Figure(figsize=(10.0, 2.2 + 2.3 * len(shown_torques)), layout="constrained")
    rows = figure.subplots(len(shown_torques), 2, squeeze=False, sharex=True)
    colours = {index: colour for index, _, colour, _ in style.torque_styles(result)}
    angle = np.degrees(result.pinion_angle)
    for index, (absolute, about_mean) in zip(shown_torques, rows.tolist(), strict=True):
        curve = length * result.transmission_error[index]
        slopes = length * sensitivities.transmission_error[index] * list(given.values())
        about = slopes - [mean_over_a_pitch(slope) for slope in slopes.T]
        _draw_band(absolute, angle, curve, sigma[index], colours[index])
        swing = curve - mean_over_a_pitch(curve)
        _draw_band(about_mean, angle, swing, np.sqrt((about**2).sum(axis=-1)), colours[index])
        absolute.set_ylabel(f"transmission error\n{BASE_CIRCLE}")
        about_mean.set_ylabel("transmission error\nless its mean [µm]")
        if len(result.torque) > 1:
            absolute.set_title(style.torque_label(result, index), fontsize="small")
    for axes in rows[-1]:
        axes.set_xlabel("pinion angle [deg]")
    handles = _legend_of_bands(rows[0, 0])
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize="small")
    under = loads(result, len(shown_torques)) if torque is None else load(result, torque)
    what = f"scatter by the tolerances of {len(given)} key{'s' * (len(given) > 1)}, to first order"
    rigid = [key.startswith(MOUNTING) for key in given]
    more = [WITH_MOUNTING] if any(rigid) and not all(rigid) else []
    style.set_title(figure, result, f"{what}, {under}", range_of_positions(result), *more)
    return figure


def _draw_band(axes: Axes, angle: Array, curve: Array, sigma: Array, colour: str) -> None:
    """A curve with its bands."""
    for times, opacity in BANDS:
        axes.fill_between(angle, curve - times * sigma, curve + times * sigma, color=colour, alpha=opacity, linewidth=0)
    axes.plot(angle, curve, color="black", marker=".", markersize=4.0, linewidth=1.2)
    style.widen(axes, SMALLEST_SPAN_UM)
    axes.grid(alpha=0.3)


def _legend_of_bands(axes: Axes) -> list[Artist]:
    """Handles for the result and its bands in the legend, those of one panel."""
    (line,), bands = axes.lines, axes.collections
    line.set_label("this result")
    for band, (times, _) in zip(bands, BANDS, strict=True):
        band.set_label(f"± {plain(times, 6)} standard deviation{'s' * (times > 1.0)}")
    return [line, *bands]


def _spread(sensitivities: Sensitivities, tolerances: Mapping[str, float] | None) -> Array:
    """Standard deviations (keys,)."""
    result: CycleNumbers = sensitivities.result
    known = default_tolerances(result.scene, sensitivities.keys) if tolerances is None else tolerances
    missing = [key for key in sensitivities.keys if key not in known]
    require((not missing, f"tolerances: none given for {', '.join(missing)}"))
    return np.array([known[key] for key in sensitivities.keys])


def _with_tolerance(key: str, tolerance: float, sign: str = "±") -> str:
    """A key in words with its tolerance and unit."""
    label = label_of(key)
    return f"{without_unit(label)} {sign} {plain(tolerance)} {label.partition(' [')[2].rstrip(']')}".rstrip()
