"""The pressure of one position in the tangent plane.

The stresses below a contact, in a plane across it.

The highest pressure that each place of both flanks sees while the teeth pass through the mesh.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Patch, Rectangle
from matplotlib.ticker import MaxNLocator

from loaded_tca.arrays import Array, Mask, real
from loaded_tca.contact import SubsurfaceStress
from loaded_tca.edges.places import edge_distances
from loaded_tca.errors import require
from loaded_tca.flanks.base import FlankFrame
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.flanks import ToPicture, both_flanks, colour_scale, highest_of_maps, loaded_maps
from loaded_tca.plots.style import (
    ACCENT,
    COLOURS,
    NO_LOAD,
    NO_MATERIAL,
    chosen_torque,
    load,
    place,
    range_of_positions,
    set_title,
    tell,
)
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.subsurface import NAMES, Quantity, StressBelow, depth_of_largest
from loaded_tca.results.support_growth import gears_under_torque
from loaded_tca.separation import slice_middles
from loaded_tca.separation.flank_places import FlankPlaces

PRESSURE = "contact pressure [MPa]"
TICKS = 5
"""Steps across a map, at most."""


def plot_pressure_map(
    result: MeshCycle,
    position: int | None = None,
    torque: int | None = None,
    column: int | None = None,
    *,
    highest: float | None = None,
) -> Figure:
    """Contact pressure of one tooth pair at one position in the tangent plane, with the area after Hertz.

    Cells without material are grey, cells without pressure white. The pinion's tip is on top, the heel (or z > 0) on
    the right. The direction across is drawn larger than the one along by a factor that the axis tells.

    Parameters
    ----------
    result : MeshCycle
    position : int, optional
        Index along the path; default: that of the peak pressure, ``result.peak_contact``.
    torque : int, optional
        Index of the torque; default: the largest torque.
    column : int, optional
        Index of the tooth pair in ``result.pair``; default: that with the highest peak pressure at the position.
    highest : float [MPa], optional
        Pressure at the upper end of the colours; default: the highest peak pressure of the result under all its
        torques, so that maps of several torques compare, or as much more as the map, or one at the peak under a torque,
        needs: of a contact at an edge or a relief start at most 5 % of the cells under pressure lie beyond, of others
        none.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque, position or tooth pair, or the pressure is not positive.
    IndexError
        If nothing is in contact at that position.
    """
    torque = chosen_torque(result, torque, position, column)
    if highest is not None:
        require((0.0 < real(highest) < math.inf, f"highest: {highest!r:.60} is not positive and finite"))
    at = result.peak_contact(torque) if position is None else (position, int(result.peak_column[torque, position]))
    if at is not None and column is not None:
        at = at[0], column
    one = None if at is None else result.maps[torque][at[0]][at[1]]
    if at is None or one is None:
        raise IndexError("no pressure map: the tooth pair is not in contact at this position")
    scale, height = scale_factor(len(one.y) * one.spacing[1], len(one.x) * one.spacing[0])
    figure = Figure(figsize=(9.0, 1.8 + height), layout="constrained")
    axes = figure.add_subplot()
    highest = highest_of_maps(result, *at) if highest is None else highest
    draw_map(axes, result, torque, at, highest, scale)
    if one.pressure.any():
        peak = float(one.pressure.max())
        label = PRESSURE + (f"\n(single cells: up to {peak:z.0f})" if highest < peak else "")
        colours = ScalarMappable(Normalize(0.0, highest), COLOURS)
        figure.colorbar(colours, ax=axes, label=label, extend="max" if highest < peak else "neither")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    frame = result.gear_pair.pinion.flank.frame
    what = "contact pressure" if one.pressure.any() else "no contact pressure"
    lines = [*place(result, at[0], frame, at[1]), *_edge(result, torque, at)]
    set_title(figure, result, f"{what}, {load(result, torque)}", *lines)
    return figure


def _edge(result: MeshCycle, torque: int, at: tuple[int, int]) -> list[str]:
    """The pressure at an edge that a contact reaches, and why a sharp one may exceed all cells of the map."""
    pressure = float(result.edge_pressure[torque][at])
    if not math.isfinite(pressure):
        return []
    rounded = bool(result.edge_is_rounded[torque][at])
    return [
        f"pressure at {'a rounded' if rounded else 'a sharp'} edge {plain(pressure)} MPa"
        + ("" if rounded else ", mesh-dependent: force of a cell that the edge cuts, over the area of its material")
    ]


def draw_map(
    axes: Axes, result: MeshCycle, torque: int, at: tuple[int, int], highest: float, scale: float
) -> PressureMap:
    """Draw the pressure of a contact, with its area after Hertz and its unloaded contact point, and name the axes.

    The contact is at indices of position and pair; its colours go up to the highest pressure, and across it is drawn
    larger by the scale.
    """
    one = result.maps[torque][at[0]][at[1]]
    assert one is not None
    _draw_pressure(axes, gears_under_torque(result, torque)[0].gear_pair, one, highest)
    names = ("hertz_semi_minor", "hertz_semi_major", "hertz_pressure")
    minor, major, pressure = (float(getattr(result, name)[torque][at]) for name in names)
    if math.isfinite(pressure):
        label = f"after Hertz, peak pressure {plain(pressure)} MPa"
        drawn: dict[str, Any] = {"fill": False, "color": ACCENT, "linestyle": "--", "label": label}
        line, size = bool(result.paths[at[1]].on_line[at[0]]), (2.0 * major, 2.0 * minor)
        area: Patch = Rectangle((-major, -minor), *size, **drawn) if line else Ellipse((0.0, 0.0), *size, **drawn)
        axes.add_patch(area)
    across, along = one.axes[:2] @ (result.paths[at[1]].point[at[0]] - one.origin)  # gears on supports stand elsewhere
    axes.plot(along, across, "+", color=ACCENT, label="unloaded contact point")
    axes.set_aspect(scale)
    axes.yaxis.set_major_locator(MaxNLocator(TICKS))  # as many before the layout shrinks the panel as after it
    _label_axes(axes, one, scale, result.gear_pair.pinion.flank.frame)
    return one


def _label_axes(axes: Axes, one: PressureMap, scale: float, frame: FlankFrame) -> None:
    """Names of the axes, which are turned so that the pinion's tip is on top and the heel (or z > 0) on the right."""
    dx, dy = one.spacing
    points = one.origin + np.stack([np.zeros(3), dy * one.axes[1], dx * one.axes[0]])
    (here, right, _), (level, _, above) = frame.to_picture(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
    axes.xaxis.set_inverted(bool(right < here))
    axes.yaxis.set_inverted(bool(above < level))
    axes.set_xlabel(f"along the contact [mm], {frame.heelwards} on the right")
    axes.set_ylabel(
        "across the contact [mm]\n(pinion's tip on top)"
        + (f"\n(drawn {plain(scale, 6)} times larger)" if scale != 1.0 else "")
    )


def _draw_pressure(axes: Axes, pair: GearPair, one: PressureMap, highest: float) -> None:
    """Pressure of each cell, in colours up to the highest; white without pressure, grey where there is no material.

    Cells that an edge of a flank cuts are covered as far as it leaves no material.
    """
    x, y = one.borders
    void = np.isinf(one.gap)
    ground = colormaps["Greys"].with_extremes(bad=NO_MATERIAL)
    axes.pcolormesh(y, x, np.where(void, np.nan, 0.0), cmap=ground, vmin=0.0, vmax=1.0, rasterized=True)
    if void.any():
        axes.plot([], [], "s", color=NO_MATERIAL, label="no material")
    if not one.pressure.any():
        tell(axes, NO_LOAD)
        return
    loaded = np.where(one.pressure > 0.0, one.pressure, np.nan)
    axes.pcolormesh(y, x, loaded, cmap=COLOURS, norm=Normalize(0.0, highest), rasterized=True)
    if void.any():
        beyond = edge_distances(pair, *FlankPlaces(pair, one).at(x[:, None], y)).min(axis=-1)
        if beyond.min() < 0.0:
            axes.contourf(y, x, beyond, [beyond.min(), 0.0], colors=[NO_MATERIAL])


def scale_factor(length: float, width: float) -> tuple[float, float]:
    """How much larger to draw the direction across of a map, and its height [inch] where it is 7 inches long."""
    wanted = 0.5 * length / width
    power = 10.0 ** math.floor(math.log10(wanted))
    scale = max(factor * power for factor in (1.0, 2.0, 5.0) if factor * power <= wanted)
    return scale, 7.0 * scale * width / length


LINES = 8
DEEPEST_DRAWN = 0.1
WIDTH_in, AROUND_in = 7.2, 2.6
"""Width of the section of a stress, and height of what stands above and below it."""
OF_FIRST_AXIS = "first axis, from the middle of the grid [mm]"


def plot_subsurface(stress: SubsurfaceStress, quantity: Quantity = "max_shear", column: int | None = None) -> Figure:
    """Depth against the first axis of the grid of a pressure, in the plane that holds the largest value.

    Parameters
    ----------
    stress : SubsurfaceStress
        At two depths at least.
    quantity : {"max_shear", "von_mises"}
    column : int, optional
        Index along the second axis of another plane.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        For another quantity, for less than two depths or two cells across, or where there is no stress.

    Examples
    --------
    >>> import numpy as np
    >>> from loaded_tca.contact import subsurface_stress
    >>> stress = subsurface_stress(np.full((8, 8), 100.0), (0.1, 0.1), np.linspace(0.0, 1.0, 11))
    >>> plot_subsurface(stress).axes[0].get_ylabel()
    'depth [mm]'
    """
    _check(stress, quantity)
    values = stress.max_shear if quantity == "max_shear" else stress.von_mises
    column = int(np.unravel_index(int(np.argmax(values)), values.shape)[2]) if column is None else column
    row = int(values[:, :, column].max(axis=0).argmax())
    largest = float(values[:, :, column].max())
    order = np.argsort(stress.depths)
    across = (np.arange(values.shape[1]) - 0.5 * (values.shape[1] - 1)) * stress.spacing[0]
    ratio = float(np.ptp(stress.depths) / np.ptp(across))
    figure = Figure(figsize=(8.0, min(AROUND_in + WIDTH_in * ratio, 6.5)), layout="compressed")
    axes = figure.add_subplot()
    norm, section = Normalize(0.0, largest), values[order, :, column]
    filled = axes.contourf(across, stress.depths[order], section, 4 * LINES, cmap=COLOURS, norm=norm)
    axes.contour(across, stress.depths[order], section, LINES, colors="white", linewidths=0.5)
    figure.colorbar(filled, ax=axes, location="bottom", label=f"{NAMES[quantity]} [MPa]", aspect=50.0)
    depth = depth_of_largest(stress.depths, values[:, row, column])
    label = f"{plain(largest)} MPa at a depth of {plain(depth, 3)} mm"
    axes.plot(across[row], depth, "+", color=ACCENT, markersize=10.0, label=label)
    axes.invert_yaxis()
    axes.set_aspect("equal" if ratio > DEEPEST_DRAWN else "auto")
    axes.set_xlabel(OF_FIRST_AXIS)
    axes.set_ylabel("depth [mm]")
    figure.legend(loc="outside lower center", fontsize="small")
    figure.suptitle(f"Below the surface: {NAMES[quantity]}, Poisson's ratio {plain(stress.poisson_ratio, 6)}")
    return figure


def plot_stress_below(below: StressBelow, quantity: Quantity = "max_shear") -> Figure:
    """Stress below one pressure map of a result: depth against the direction across, where the stress is largest.

    Parameters
    ----------
    below : StressBelow
        Of :func:`loaded_tca.results.subsurface.stress_below`.
    quantity : {"max_shear", "von_mises"}

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        For another quantity.
    """
    figure = plot_subsurface(below.stress, quantity, below.beside_spike)
    figure.axes[0].set_xlabel("across the contact, from the middle of the grid [mm]")
    set_title(figure, below.result, f"below the surface: {NAMES[quantity]}", *below.where)
    return figure


def _check(stress: SubsurfaceStress, quantity: str) -> None:
    deep = np.unique(stress.depths).size >= 2 and stress.sigma_z.shape[1] >= 2
    require(
        (quantity in NAMES, f"quantity: {quantity!r} is none of {', '.join(NAMES)}"),
        (deep, "stress: a section needs two depths and two cells across"),
        (bool(stress.max_shear.any()), "stress: there is none anywhere, nothing to draw"),
    )


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
    figure, _ = envelopes_of(result, [torque])
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
    figure, panels = envelopes_of(result, shown)
    for torque, axes in zip(shown, panels[::2], strict=True):
        axes.set_ylabel(f"{style.torque_label(result, torque)}\n{axes.get_ylabel()}")
    about = f"loaded contact patterns, {style.loads(result, len(shown))}"
    style.set_title(figure, result, about, range_of_positions(result))
    return figure


def envelopes_of(result: MeshCycle, torques: list[int]) -> tuple[Figure, list[Axes]]:
    """Both flanks with their pressure envelope in a row for each torque, without a title."""
    maps = [one for torque in torques for one in loaded_maps(result, torque)]
    scale, extend = colour_scale(result, maps)
    figure, panels = both_flanks(result, *(partial(draw_envelope, result, torque, scale) for torque in torques))
    figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, label="highest contact pressure [MPa]", extend=extend)
    return figure, panels


def draw_envelope(result: MeshCycle, torque: int, scale: Normalize, axes: Axes, to_picture: ToPicture) -> list[Artist]:
    """Draw the highest pressure that each place of a flank sees under a torque."""
    low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
    borders, seen = pressure_seen(result, torque, to_picture, low, high)
    return [axes.pcolormesh(*borders, seen, cmap=COLOURS, norm=scale, rasterized=True)]


def _passing(result: MeshCycle, torque: int, to_picture: ToPicture, field: Array) -> Iterator[tuple[Array, Array]]:
    """Places (k, 2) in the picture of a flank and the pressure (k,) that they see.

    Of each map all cells, and from each position to the next the ridge of the pressure, which no place between sees
    anything higher than.
    """
    pair = gears_under_torque(result, torque)[0].gear_pair
    for passage in zip(*result.maps[torque], strict=True):
        before = None
        for one in passage:
            if one is None or not one.pressure.any():
                before = None
                continue
            loaded = one.pressure > 0.0
            cells = points_of_cells(one, loaded, to_picture, field)
            pressure = np.repeat(one.pressure[loaded], cells.shape[1]).reshape(cells.shape[:2])
            places = to_picture(cells)
            cut = one.cover[loaded] < 1.0
            if cut.any():  # these reach beyond the flanks
                within = np.ones(pressure.shape, dtype=bool)
                within[cut] = edge_distances(pair, *pair.on_flanks(cells[cut])).min(axis=-1) >= 0.0
                places, pressure = places[within], pressure[within]
            yield places.reshape(-1, 2), pressure.ravel()
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


_KEPT: WeakKeyDictionary[MeshCycle, dict[tuple[object, ...], tuple[Array, Array]]] = WeakKeyDictionary()
"""What flanks see, which several pictures draw, by results; and by torque, gear and corners of the picture."""


def pressure_seen(
    result: MeshCycle, torque: int, to_picture: ToPicture, low: Array, high: Array
) -> tuple[Array, Array]:
    """Highest pressure that each place of a flank sees, NaN where none, on fields between two corners of a picture.

    Borders (2, n + 1) of the fields come first, in the units of the picture. Both are kept with the result.
    """
    kept, key = _KEPT.setdefault(result, {}), (torque, to_picture.gear, *low, *high)
    if key not in kept:
        kept[key] = np.linspace(low, high, FIELDS + 1).T, _highest_seen(result, torque, to_picture, low, high)
    return kept[key]


def _highest_seen(result: MeshCycle, torque: int, to_picture: ToPicture, low: Array, high: Array) -> Array:
    """The pressure (FIELDS, FIELDS) of ``pressure_seen``."""
    field, highest = (high - low) / FIELDS, np.zeros((FIELDS, FIELDS))
    for places, pressure in _passing(result, torque, to_picture, field):
        column, row = np.floor((places - low) / field).astype(int).T
        inside = (column >= 0) & (column < FIELDS) & (row >= 0) & (row < FIELDS)
        np.maximum.at(highest, (row[inside], column[inside]), pressure[inside])
    return np.where(highest > 0.0, highest, np.nan)
