"""The path of contact on both flanks, with what they carry."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon

from loaded_tca.arrays import Array
from loaded_tca.flanks.base import Flank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plots.style import ACCENT, COLOURS, NOT_REACHED, highest_torque, load, range_of_positions, set_title
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.pressure_map import PressureMap

CONTACT_POINTS = "unloaded contact points of all positions and pairs"
MOST_AREAS = 7
LEAST_SEEN = 0.01
"""Part of the height of a flank from which an area of it is seen."""
FINENESS = (129, 33)
"""Points along the profile and lengthwise from which the outline of a flank is drawn."""


def plot_contact_path(result: MeshCycle, torque: int | None = None) -> Figure:
    """Path of contact on both flanks, each as its frame shows it, with the pressure of some positions.

    White is the part of a flank that the mating gear reaches at nominal mounting.

    Parameters
    ----------
    result : MeshCycle
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = highest_torque(result) if torque is None else torque
    figure = Figure(figsize=(11.0, 5.5), layout="constrained")
    panels = figure.subplots(1, 2)
    scene, pair, paths = result.scene, result.gear_pair, result.paths
    starts = scene.active_starts()
    sides = (
        (pair.pinion.flank, starts[0], [(path.pinion_radius, path.pinion_axial) for path in paths]),
        (pair.wheel.flank, starts[1], [(path.wheel_radius, path.wheel_axial) for path in paths]),
    )
    last = len(result.path) - 1
    positions = sorted({round(last * part / (MOST_AREAS - 1)) for part in range(MOST_AREAS)})
    drawn = [row for row in (loaded_maps(result, torque, [position]) for position in positions) if row]
    maps = [one for row in drawn for one in row]
    scale = Normalize(0.0, highest_mesh_independent_pressure(result, torque, maps))
    unreached = False
    for axes, name, (flank, start, points) in zip(panels, scene.flank_names, sides, strict=True):
        outline = draw_flank(axes, name, flank, start)
        for one in maps:
            corners = flank.frame.to_picture(*on_gear(pair, flank, one.corners))
            loaded = np.where(one.pressure > 0.0, one.pressure, np.nan)
            area = axes.pcolormesh(*corners, loaded, cmap=COLOURS, norm=scale, rasterized=True)
            area.set_clip_path(outline)
        for point in points:
            axes.plot(*flank.frame.to_picture(*point), ".", color=ACCENT, markersize=4.0)
        height = flank.profile_coordinate(*flank.grid(*FINENESS)).value
        unreached = unreached or start - float(height.min()) > LEAST_SEEN * float(np.ptp(height))
    if maps:
        beyond = any(one.pressure.max() > scale.vmax for one in maps)
        bar = ScalarMappable(scale, COLOURS)
        figure.colorbar(bar, ax=panels, label="contact pressure [MPa]", extend="max" if beyond else "neither")
    handles: list[Artist] = [Line2D([], [], color=ACCENT, marker=".", linestyle="", label=CONTACT_POINTS)]
    if unreached:
        not_reached = "flank that the mating gear does not reach"
        handles.append(Patch(facecolor=NOT_REACHED, edgecolor="black", label=not_reached))
    pressure = f"pressure drawn at {len(drawn)} of {len(result.path)} positions"
    figure.legend(
        handles=handles, title=pressure, loc="outside lower center", ncols=2, fontsize="small", title_fontsize="small"
    )
    what = "contact on the flanks" if maps else "no load, no pressure on the flanks"
    set_title(figure, result, f"{what}, {load(result, torque)}", range_of_positions(result))
    return figure


def loaded_maps(result: MeshCycle, torque: int, positions: Sequence[int] | None = None) -> list[PressureMap]:
    """Maps under pressure, of all pairs, at all positions or some."""
    rows = result.maps[torque] if positions is None else [result.maps[torque][position] for position in positions]
    return [one for row in rows for one in row if one is not None and one.pressure.any()]


def highest_mesh_independent_pressure(result: MeshCycle, torque: int, maps: list[PressureMap]) -> float:
    """Highest mesh-independent pressure [MPa], the end of a scale; the highest at all if there is none."""
    known = result.mesh_independent_pressure[torque]
    if np.isfinite(known).any():
        return float(np.nanmax(known)) or 1.0
    return max((float(one.pressure.max()) for one in maps), default=1.0)


def draw_flank(axes: Axes, name: str, flank: Flank, start: float) -> Polygon:
    """The flank from root to tip, with the part from profile coordinate ``start`` on in white; returns its outline."""
    rho, z = flank.grid(*FINENESS)
    along = flank.profile_coordinate(rho, z).value
    active = [np.array([np.interp(start, along[:, k], part[:, k]) for k in range(along.shape[1])]) for part in (rho, z)]
    regions = []
    for bottom, colour in (((rho[0], z[0]), NOT_REACHED), (active, "white")):
        around = (np.concatenate([first, last[-1, ::-1]]) for first, last in zip(bottom, (rho, z), strict=True))
        corners = np.stack(flank.frame.to_picture(*around), axis=-1)
        regions.append(Polygon(corners, facecolor=colour, edgecolor="black"))
        axes.add_patch(regions[-1])
    lower, upper = regions[0].get_xy().min(axis=0), regions[0].get_xy().max(axis=0)
    margin = 0.08 * (upper - lower)
    axes.set_xlim(lower[0] - margin[0], upper[0] + margin[0])
    axes.set_ylim(lower[1] - margin[1], upper[1] + margin[1])
    middle = FINENESS[1] // 2
    ends = [(float(radius[middle]), float(axial[middle])) for radius, axial in (active, (rho[-1], z[-1]))]
    axes.set_title(f"{name}, active from {flank.frame.profile_span(*ends)}", fontsize="small")
    axes.set_xlabel(flank.frame.labels[0])
    axes.set_ylabel(flank.frame.labels[1])
    return regions[0]


def on_gear(pair: GearPair, flank: Flank, point: Array) -> tuple[Array, Array]:
    """Radius and axial coordinate (...) of points (..., 3) on the gear of a flank."""
    if flank is pair.pinion.flank:
        return np.hypot(point[..., 0], point[..., 1]), point[..., 2]
    radius, _, axial = pair.to_wheel(point)
    return radius, axial
