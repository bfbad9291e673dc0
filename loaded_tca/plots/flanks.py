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
    for axes, name, (flank, start, points) in zip(panels, scene.flank_names, sides, strict=True):
        outline = draw_flank(axes, name, flank, start)
        for one in maps:
            _draw_area(axes, outline, one, flank.frame.to_picture(*on_gear(pair, flank, one.corners)), scale)
        for point in points:
            axes.plot(*flank.frame.to_picture(*point), ".", color=ACCENT, markersize=4.0)
    if maps:
        beyond = any(one.pressure.max() > scale.vmax for one in maps)
        bar = ScalarMappable(scale, COLOURS)
        figure.colorbar(bar, ax=panels, label="contact pressure [MPa]", extend="max" if beyond else "neither")
    unreached = any(_unreached(flank, start) > LEAST_SEEN for flank, start, _ in sides)
    _explain(figure, len(drawn), len(result.path), unreached)
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


def _explain(figure: Figure, drawn: int, positions: int, unreached: bool) -> None:
    """The legend of the picture of the flanks."""
    handles: list[Artist] = [
        Line2D([], [], color=ACCENT, marker=".", linestyle="", label=CONTACT_POINTS),
    ]
    if unreached:
        handles.append(
            Patch(facecolor=NOT_REACHED, edgecolor="black", label="flank that the mating gear does not reach")
        )
    pressure = f"pressure drawn at {drawn} of {positions} positions"
    figure.legend(
        handles=handles, title=pressure, loc="outside lower center", ncols=2, fontsize="small", title_fontsize="small"
    )


def _unreached(flank: Flank, start: float) -> float:
    """Part of the height of a flank below profile coordinate ``start``."""
    coordinate = flank.profile_coordinate(*flank.grid(*FINENESS)).value
    return (start - float(coordinate.min())) / float(np.ptp(coordinate))


def _profile_start(flank: Flank) -> float:
    """Smallest profile coordinate of a flank."""
    return float(flank.profile_coordinate(*flank.grid(*FINENESS)).value.min())


def draw_flank(axes: Axes, name: str, flank: Flank, start: float) -> Polygon:
    """The flank from root to tip, with the part from profile coordinate ``start`` on in white; returns its outline."""
    outline = _region(flank, _profile_start(flank), NOT_REACHED)
    for piece in (outline, _region(flank, start, "white")):
        axes.add_patch(piece)
    lower, upper = outline.get_xy().min(axis=0), outline.get_xy().max(axis=0)
    margin = 0.08 * (upper - lower)
    axes.set_xlim(lower[0] - margin[0], upper[0] + margin[0])
    axes.set_ylim(lower[1] - margin[1], upper[1] + margin[1])
    span = flank.frame.profile_span(*_profile_ends(flank, start))
    axes.set_title(f"{name}, active from {span}", fontsize="small")
    axes.set_xlabel(flank.frame.labels[0])
    axes.set_ylabel(flank.frame.labels[1])
    return outline


def _from_coordinate(flank: Flank, lowest: float) -> tuple[Array, Array]:
    """(rho, z) along the line on which the profile coordinate is ``lowest``, each (lengthwise,)."""
    rho, z = flank.grid(*FINENESS)
    along = flank.profile_coordinate(rho, z).value
    found = [[np.interp(lowest, along[:, k], part[:, k]) for k in range(FINENESS[1])] for part in (rho, z)]
    return np.array(found[0]), np.array(found[1])


def _region(flank: Flank, lowest: float, colour: str) -> Polygon:
    """Outline of the flank above the line on which the profile coordinate is ``lowest``."""
    rho, z = flank.grid(*FINENESS)
    bottom, top = _from_coordinate(flank, lowest), (rho[-1], z[-1])
    around = (np.concatenate([first, last[::-1]]) for first, last in zip(bottom, top, strict=True))
    return Polygon(np.stack(flank.frame.to_picture(*around), axis=-1), facecolor=colour, edgecolor="black")


def _profile_ends(flank: Flank, start: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """(rho, z) in the middle of the face, where the active profile starts, and at the tip."""
    middle = FINENESS[1] // 2
    rho, z = flank.grid(*FINENESS)
    first = _from_coordinate(flank, start)
    return (float(first[0][middle]), float(first[1][middle])), (float(rho[-1, middle]), float(z[-1, middle]))


def _draw_area(axes: Axes, outline: Patch, one: PressureMap, corners: tuple[Array, Array], scale: Normalize) -> None:
    """The cells under pressure of one position, within the outline of the flank."""
    loaded = np.where(one.pressure > 0.0, one.pressure, np.nan)
    cells = axes.pcolormesh(*corners, loaded, cmap=COLOURS, norm=scale, rasterized=True)
    cells.set_clip_path(outline)


def on_gear(pair: GearPair, flank: Flank, point: Array) -> tuple[Array, Array]:
    """Radius and axial coordinate (...) of points (..., 3) on the gear of a flank."""
    if flank is pair.pinion.flank:
        return np.hypot(point[..., 0], point[..., 1]), point[..., 2]
    radius, _, axial = pair.to_wheel(point)
    return radius, axial
