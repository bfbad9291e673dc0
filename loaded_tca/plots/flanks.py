"""The path of contact on both flanks, with what they carry."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from matplotlib.path import Path

from loaded_tca.arrays import GEARS, Array
from loaded_tca.flanks.base import Flank, Point
from loaded_tca.flanks.rounding import RoundedFlank, edge_places
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain, signed
from loaded_tca.plots.style import (
    ACCENT,
    COLOURS,
    NOT_REACHED,
    chosen_torque,
    load,
    position_label,
    range_of_positions,
    set_title,
)
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import PressureMap

if TYPE_CHECKING:
    from loaded_tca.flank_maps.conjugate import GearName

CONTACT_POINTS = "unloaded contact points of all positions and pairs"
BEGIN_OF_ARC: dict[str, Any] = {"color": "black", "linestyle": "--", "linewidth": 0.6}
MOST_AREAS = 7
PALE = "#dfe3ee"
"""Of contacts whose pressure is not drawn."""
PATCH = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]
"""Codes of a patch with four corners."""
SHADES = 256
"""Colours of a scale: as many as Matplotlib's have."""
CELLS_OF_SPIKES = 0.05
"""Part of the cells of a map under pressure that may lie beyond its scale of colours."""
LEAST_SEEN = 0.01
"""Part of the height of a flank from which an area of it is seen."""
FINENESS = (129, 33)
"""Points along the profile and lengthwise from which the outline of a flank is drawn."""
MARGIN = 0.08
"""About the outline of a flank, over its size."""


@dataclass(frozen=True)
class ToPicture:
    """Takes points (..., 3) of the fixed frame to their places (..., 2) in the picture of a gear's flank."""

    pair: GearPair
    gear: GearName

    def __call__(self, points: Array) -> Array:
        """Return the places of points."""
        on_flank = (self.pair.on_pinion, self.pair.on_wheel)[GEARS.index(self.gear)]
        return np.stack(getattr(self.pair, self.gear).flank.frame.to_picture(*on_flank(points)), axis=-1)


def plot_contact_path(result: MeshCycle, torque: int | None = None) -> Figure:
    """Path of contact on both flanks, each as its frame shows it, with the pressure of some positions.

    Pale are the contacts of the other positions. White is the part of a flank that the mating gear reaches at nominal
    mounting.

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
    scene, pair = result.scene, result.gear_pair
    last = len(result.path) - 1
    positions = sorted({round(last * part / (MOST_AREAS - 1)) for part in range(MOST_AREAS)})
    drawn = [row for row in (loaded_maps(result, torque, [position]) for position in positions) if row]
    maps = [one for row in drawn for one in row]
    others = loaded_maps(result, torque, [position for position in range(last + 1) if position not in positions])
    scale, extend = colour_scale(result, maps)

    def draw(axes: Axes, to_picture: ToPicture) -> list[Artist]:
        for path in result.paths:
            axes.plot(*to_picture(path.point).T, ".", color=ACCENT, markersize=4.0)
        return [*_draw_pale(axes, to_picture, others), *_draw_areas(axes, to_picture, maps, scale)]

    figure, panels = both_flanks(result, draw)
    if maps:
        figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, label="contact pressure [MPa]", extend=extend)
    handles: list[Artist] = [Line2D([], [], color=ACCENT, marker=".", linestyle="", label=CONTACT_POINTS)]
    flanks = pair.pinion.flank, pair.wheel.flank
    heights = [flank.profile_coordinate(*flank.grid(*FINENESS)).value for flank in flanks]
    actives = zip(scene.active_starts(), scene.active_ends(), heights, strict=True)
    apart = [max(start - float(one.min()), float(one.max()) - end) for start, end, one in actives]
    if any(part > LEAST_SEEN * float(np.ptp(height)) for part, height in zip(apart, heights, strict=True)):
        not_reached = "flank that the mating gear does not reach"
        handles.append(Patch(facecolor=NOT_REACHED, edgecolor="black", label=not_reached))
    if pair.sharp is not pair:
        handles.append(Line2D([], [], **BEGIN_OF_ARC, label="where the arc of a rounded edge begins"))
    pressure = f"pressure drawn at {len(drawn)} of {len(result.path)} positions"
    pressure += ", contacts of the others pale" if others else ""
    figure.legend(
        handles=handles, title=pressure, loc="outside lower center", ncols=2, fontsize="small", title_fontsize="small"
    )
    what = "contact on the flanks" if maps else "no load, no pressure on the flanks"
    set_title(figure, result, f"{what}, {load(result, torque)}", range_of_positions(result))
    return figure


def plot_full_mesh(result: MeshCycle, position: int | None = None, torque: int | None = None) -> Figure:
    """Pressure of all tooth pairs at one position, each where it lies on both flanks, with its share of the torque.

    All teeth of a gear are alike, so that one flank shows what every tooth in the mesh carries.

    Parameters
    ----------
    result : MeshCycle
    position : int, optional
        Index along the path; default: that of the peak pressure, ``result.peak_contact``.
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque or position.
    IndexError
        If nothing is in contact at that position.
    """
    torque = chosen_torque(result, torque, position)
    peak = result.peak_contact(torque)
    if position is None and peak is not None:
        position = peak[0]
    if position is None or not result.path.in_contact[position]:
        raise IndexError("no mesh to show: no tooth pair is in contact at this position")
    maps = loaded_maps(result, torque, [position])
    scale, extend = colour_scale(result, maps)

    def draw(axes: Axes, to_picture: ToPicture) -> list[Artist]:
        for number, share, one in zip(
            result.pair.tolist(), result.load_share[torque, position], result.maps[torque][position], strict=True
        ):
            if one is None:
                continue
            at, along = to_picture(np.stack([one.origin, one.origin + one.spacing[1] * one.axes[1]]))
            axes.plot(*at, "+", color=ACCENT)
            rising = math.copysign(1.0, np.prod(along - at))
            upwards = 1.0 if at[1] < np.mean(axes.get_ylim()) else -1.0
            axes.annotate(
                f"pair {signed(number)}: {plain(100.0 * share, 3)} %",
                at,
                xytext=(-45.0 * rising * upwards, 24.0 * upwards),  # beside the contact, towards mid-height
                textcoords="offset points",
                ha="center",
                va="center",
                fontsize="small",
                arrowprops={"arrowstyle": "-", "color": "0.6"},
                bbox={"facecolor": "white", "edgecolor": "0.6", "boxstyle": "round,pad=0.2"},
                zorder=10.0,
            )
        return _draw_areas(axes, to_picture, maps, scale)

    figure, panels = both_flanks(result, draw)
    if maps:
        figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, label="contact pressure [MPa]", extend=extend)
    contact_point = Line2D([], [], color=ACCENT, marker="+", linestyle="", label="unloaded contact point of the pair")
    figure.legend(handles=[contact_point], loc="outside lower center", fontsize="small")
    what = "all tooth pairs with their shares of the torque" if maps else "no load, no pressure on the flanks"
    set_title(figure, result, f"{what}, {load(result, torque)}", position_label(result, position))
    return figure


def _draw_areas(axes: Axes, to_picture: ToPicture, maps: Sequence[PressureMap], scale: Normalize) -> list[Artist]:
    """Cells under pressure where they lie on a flank, of all maps as one mesh.

    Maps, each as far as it has pressure, stand one after the other; cells that join or fill them up are left out.
    """
    if not maps:
        return []
    parts = [_under_pressure(one) for one in maps]
    widest = max(pressure.shape[1] for _, pressure in parts)
    corners, values = [], []
    for points, pressure in parts:
        missing = widest - pressure.shape[1]
        corners.append(np.pad(points, ((0, 0), (0, missing), (0, 0)), mode="edge"))
        loaded = np.where(pressure > 0.0, pressure, np.nan)
        values.append(np.pad(loaded, ((0, 1), (0, missing)), constant_values=np.nan))
    x, y = np.moveaxis(to_picture(np.concatenate(corners)), -1, 0)
    return [axes.pcolormesh(x, y, np.concatenate(values)[:-1], cmap=COLOURS, norm=scale, rasterized=True)]


def _under_pressure(one: PressureMap) -> tuple[Array, Array]:
    """Corners (m + 1, n + 1, 3) and pressure (m, n) of the smallest rectangle with all cells under pressure."""
    rows, columns = (np.flatnonzero((one.pressure > 0.0).any(axis=axis)) for axis in (1, 0))
    ends = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    x, y = (border[end.start : end.stop + 1] for border, end in zip(one.borders, ends, strict=True))
    return one.origin + x[:, None, None] * one.axes[0] + y[:, None] * one.axes[1], one.pressure[ends]


def _draw_pale(axes: Axes, to_picture: ToPicture, maps: Sequence[PressureMap]) -> list[Artist]:
    """Cells under pressure where they lie on a flank, all in one pale colour: a patch for each row of cells across.

    The patches of a map are one path: no two of them overlap, and single ones take ten times as long.
    """
    if not maps:
        return []
    paths = []
    for one in maps:
        ends = np.diff(np.pad(one.pressure > 0.0, ((1, 1), (0, 0))).astype(int), axis=0).T
        (column, first), (_, last) = np.nonzero(ends == 1), np.nonzero(ends == -1)
        x, y = one.borders
        across = np.stack([x[first], x[last], x[last], x[first], x[first]], axis=-1)
        along = np.stack([y[column], y[column], y[column + 1], y[column + 1], y[column]], axis=-1)
        corners = one.origin + across[..., None] * one.axes[0] + along[..., None] * one.axes[1]
        paths.append(Path(to_picture(corners).reshape(-1, 2), PATCH * len(column)))
    patches = PathCollection(paths, facecolors=PALE, linewidths=0.0, antialiaseds=False, rasterized=True)
    axes.add_collection(patches, autolim=False)
    return [patches]


def draw_segments(
    axes: Axes, places: Array, values: Array, scale: Normalize, colours: str = COLOURS, width: float = 2.0
) -> LineCollection:
    """Draw segments from place to place (n, 2, 2) in the colours of their values (n,), in their order.

    Those in a row that have one colour are one line with gaps: single ones take several times as long.
    """
    shade = np.minimum((SHADES * np.asarray(scale(values))).astype(int), SHADES - 1)
    begins = np.flatnonzero(np.diff(shade)) + 1
    with_gaps = np.pad(places, ((0, 0), (0, 1), (0, 0)), constant_values=np.nan)
    lines = [part.reshape(-1, 2) for part in np.split(with_gaps, begins)] if len(places) else []
    collection = LineCollection(lines, cmap=colours, norm=scale, linewidths=width, rasterized=True)
    collection.set_array(values[[0, *begins]] if len(places) else values)
    axes.add_collection(collection, autolim=False)
    return collection


def loaded_maps(result: MeshCycle, torque: int, positions: Sequence[int] | None = None) -> list[PressureMap]:
    """Maps under pressure, of all pairs, at all positions or some."""
    rows = result.maps[torque] if positions is None else [result.maps[torque][position] for position in positions]
    return [one for row in rows for one in row if one is not None and one.pressure.any()]


def colour_scale(result: MeshCycle, maps: Sequence[PressureMap]) -> tuple[Normalize, Literal["max", "neither"]]:
    """Scale of colours up to the highest peak pressure under any torque; arrow of its bar if a cell lies beyond."""
    highest = float(np.nanmax(result.peak_pressure, initial=0.0)) or 1.0
    beyond = any(one.pressure.max() > highest for one in maps)
    return Normalize(0.0, highest), "max" if beyond else "neither"


def highest_of_maps(result: MeshCycle, position: int, column: int, torques: Iterable[int] | None = None) -> float:
    """Pressure [MPa] up to which the colours of maps go, the same under all torques of a result or under some.

    It is the highest peak pressure, unless cells at the peaks or in the maps of one tooth pair at one position are
    above it: on a tip corner most are. Then it is what all but a small part of these cells stay below.
    """
    torques = range(len(result.torque)) if torques is None else [*torques]
    highest = max(float(np.nanmax(result.peak_pressure[torque], initial=0.0)) for torque in torques)
    for at in {place for torque in torques if (place := result.peak_contact(torque))} | {(position, column)}:
        for torque in torques:
            one = result.maps[torque][at[0]][at[1]]
            if one is None or not one.pressure.any():
                continue
            spiky = result.on_edge[torque][at] or result.on_relief_start[torque][at]
            part = 1.0 - CELLS_OF_SPIKES if spiky else 1.0
            highest = max(highest, float(np.quantile(one.pressure[one.pressure > 0.0], part)))
    return highest


def both_flanks(
    result: CycleNumbers, *draw: Callable[[Axes, ToPicture], Sequence[Artist]]
) -> tuple[Figure, list[Axes]]:
    """A panel for each flank, with what is drawn on it cut off at its outline; a row for each function that draws.

    The function is called with the axes and what takes points to the picture; it returns what is to be cut off.
    """
    figure = Figure(figsize=(11.0, 2.0 + 3.5 * len(draw)), layout="constrained")
    scene, pair = result.scene, result.gear_pair
    panels = figure.subplots(len(draw), 2, squeeze=False, sharex="col", sharey="col")

    sides = ((pair.pinion.flank, ToPicture(pair, "pinion")), (pair.wheel.flank, ToPicture(pair, "wheel")))
    actives = zip(scene.active_starts(), scene.active_ends(), strict=True)
    described = zip(panels.T, scene.flank_names, actives, sides, strict=True)
    for column, name, active, (flank, to_picture) in described:
        for axes, draw_on in zip(column, draw, strict=True):
            _draw_on_flank(axes, draw_on, to_picture, name, flank, active)
        for above, below in pairwise(column):
            above.set_xlabel("")
            below.set_title("")
    return figure, panels.ravel().tolist()


def draw_on_pinion(axes: Axes, result: CycleNumbers, draw: Callable[[Axes, ToPicture], Sequence[Artist]]) -> None:
    """The pinion's flank alone, with what is drawn on it; see :func:`both_flanks`."""
    pair, scene = result.gear_pair, result.scene
    about = scene.flank_names[0], pair.pinion.flank, (scene.active_starts()[0], scene.active_ends()[0])
    _draw_on_flank(axes, draw, ToPicture(pair, "pinion"), *about)


def _draw_on_flank(
    axes: Axes,
    draw: Callable[[Axes, ToPicture], Sequence[Artist]],
    to_picture: ToPicture,
    name: str,
    flank: Flank,
    active: Point,
) -> None:
    outline = draw_flank(axes, name, flank, active)
    for drawn in draw(axes, to_picture):
        drawn.set_clip_path(outline)


def draw_flank(axes: Axes, name: str, flank: Flank, active: Point) -> Polygon:
    """The flank from root to tip, its part between the profile coordinates ``active`` in white; returns its outline."""
    outlines, ends = flank_outlines(flank, active)
    regions = [
        Polygon(corners, facecolor=colour, edgecolor="black")
        for corners, colour in zip(outlines, (NOT_REACHED, "white"), strict=True)
    ]
    for region in regions:
        axes.add_patch(region)
    _draw_arcs(axes, flank)
    low, high = limits_of_flank(outlines[0])
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_title(f"{name}, active from {flank.frame.profile_span(*ends)}", fontsize="small")
    axes.set_xlabel(flank.frame.labels[0])
    axes.set_ylabel(flank.frame.labels[1])
    return regions[0]


def flank_outlines(flank: Flank, active: Point) -> tuple[tuple[Array, Array], tuple[Point, Point]]:
    """Outlines (n, 2) in its picture of a flank, and of the part between the profile coordinates ``active``.

    The ends (rho, z) of the profile of that part in the middle of the face come after them.
    """
    rho, z = flank.grid(*FINENESS)
    along = flank.profile_coordinate(rho, z).value
    columns = range(along.shape[1])
    begin, end = (
        [np.array([np.interp(place, along[:, k], part[:, k]) for k in columns]) for part in (rho, z)]
        for place in active
    )
    outlines = []
    for bottom, top in (((rho[0], z[0]), (rho[-1], z[-1])), (begin, end)):
        around = (np.concatenate([first, last[::-1]]) for first, last in zip(bottom, top, strict=True))
        outlines.append(np.stack(flank.frame.to_picture(*around), axis=-1))
    middle = FINENESS[1] // 2
    first, last = ((float(radius[middle]), float(axial[middle])) for radius, axial in (begin, end))
    return (outlines[0], outlines[1]), (first, last)


def limits_of_flank(outline: Array) -> tuple[Array, Array]:
    """Lower and upper corner (2,) of the picture of a flank, with a margin about its outline (n, 2)."""
    lower, upper = outline.min(axis=0), outline.max(axis=0)
    margin = MARGIN * (upper - lower)
    return lower - margin, upper + margin


def _draw_arcs(axes: Axes, flank: Flank) -> None:
    """Dashed lines where the arcs of rounded edges begin."""
    if isinstance(flank, RoundedFlank):
        for arc in flank.arcs:
            places = flank.off_arc(arc, *edge_places(flank, arc.edge, max(FINENESS)))
            axes.plot(*flank.frame.to_picture(*places), **BEGIN_OF_ARC)
