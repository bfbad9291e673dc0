"""Pictures of a result, each with its units, load and position; figures are made without any global state."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize, to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, Patch, Rectangle

from loaded_tca.flanks.jet import Array
from loaded_tca.gears import CylindricalGear
from loaded_tca.mesh_cycle import ARCSEC, MeshCycle, PressureMap
from loaded_tca.pair import GearPair
from loaded_tca.scene import parse_scene
from loaded_tca.storage import FilePath, replacing

COLOURS = "viridis"
"""Even in lightness, and told apart by colour-blind readers and in grey."""
ACCENT, NO_MATERIAL, NO_MATE = "#d55e00", "0.8", "0.9"
MARKERS = "osD^vP*X"
MOST_LABELS = 8
MOST_AREAS = 7
SMALLEST_SPAN_ARCSEC = 0.02
"""Height of a transmission error axis below which a curve would be rounding."""
DOTS_PER_INCH = 120


def plot_all(result: MeshCycle, directory: FilePath) -> tuple[Path, ...]:
    """Save every picture as PNG into an existing directory, each whole or not at all.

    Parameters
    ----------
    result : MeshCycle
    directory : str or path

    Returns
    -------
    tuple of Path
        ``contact_path.png``, ``transmission_error.png``, ``peak_pressure.png``; if anything touches,
        ``pressure_map.png`` of the highest pressure; if Hertz holds elsewhere only, ``pressure_map_hertz.png`` of the
        highest pressure where it holds.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    figures = {
        "contact_path": plot_contact_path(result),
        "transmission_error": plot_transmission_error(result),
        "peak_pressure": plot_peak_pressure(result),
    }
    torque = _highest_torque(result)
    highest, smooth = result.peak_position(torque), result.peak_position(torque, where_hertz_holds=True)
    if highest is not None:
        figures["pressure_map"] = plot_pressure_map(result, highest)
    if smooth not in (None, highest):
        figures["pressure_map_hertz"] = plot_pressure_map(result, smooth)
    paths = []
    for name, figure in figures.items():
        paths.append(Path(directory) / f"{name}.png")
        save_figure(figure, paths[-1])
    return tuple(paths)


def save_figure(figure: Figure, path: FilePath) -> None:
    """Save a figure as PNG, whole or not at all; InputError if that cannot be done."""
    with replacing(path) as temporary:
        figure.savefig(temporary, format="png", dpi=DOTS_PER_INCH)


def plot_pressure_map(result: MeshCycle, position: int | None = None, torque: int | None = None) -> Figure:
    """Contact pressure of one position in the tangent plane, with the ellipse after Hertz.

    Cells without material are grey, cells without pressure white. The direction across is drawn larger than the
    one along by a factor that the axis tells.

    Parameters
    ----------
    result : MeshCycle
    position : int, optional
        Index along the path; default: the highest pressure.
    torque : int, optional
        Index of the torque; default: the largest torque.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    IndexError
        If nothing touches at that position.
    """
    torque = _highest_torque(result) if torque is None else torque
    position = result.peak_position(torque) if position is None else position
    one = None if position is None else result.maps[torque][position]
    if position is None or one is None:
        raise IndexError("no pressure map: the tooth pair does not touch at this position")
    scale, height = _scale_factor(one)
    figure = Figure(figsize=(9.0, 1.8 + height), layout="constrained")
    axes = figure.add_subplot()
    _draw_pressure(figure, axes, one)
    _draw_ellipse(axes, result, (torque, position))
    if axes.get_legend_handles_labels()[0]:
        figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    axes.set_aspect(scale)
    axes.set_xlabel("along the contact [mm]")
    axes.set_ylabel("across the contact [mm]" + (f"\n(drawn {scale:g} times larger)" if scale != 1.0 else ""))
    what = "contact pressure" if one.pressure.any() else "no contact pressure"
    _title(figure, result, f"{what}, {_load(result, torque)}", _place(result, position))
    return figure


def plot_transmission_error(result: MeshCycle) -> Figure:
    """Transmission error over the positions, unloaded and under each torque: absolute, and about its mean.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(8.0, 6.5), layout="constrained")
    absolute, about_mean = figure.subplots(2, 1, sharex=True)
    errors = result.by_torque("transmission_error")
    curves = [("unloaded", "black", ".", result.path.transmission_error)]
    curves += [(*style, errors[torque]) for torque, *style in _torque_styles(result)]
    angle = np.degrees(result.pinion_angle)
    for label, colour, marker, error in curves:
        finite = error[np.isfinite(error)]
        mean = finite.mean() if finite.size else 0.0
        absolute.plot(angle, error * ARCSEC, color=colour, marker=marker, markersize=4.0, label=label)
        about_mean.plot(angle, (error - mean) * ARCSEC, color=colour, marker=marker, markersize=4.0)
    absolute.set_ylabel("transmission error [arcsec]")
    about_mean.set_ylabel("the same, less its mean [arcsec]")
    about_mean.set_xlabel("pinion angle [deg]")
    figure.legend(*absolute.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    for axes in (absolute, about_mean):
        _widen(axes, SMALLEST_SPAN_ARCSEC)
        _add_length_axis(axes, result.wheel_base_radius)
        axes.grid(alpha=0.3)
    _title(figure, result, f"transmission error, {_loads(result)}", _range(result))
    return figure


def plot_peak_pressure(result: MeshCycle) -> Figure:
    """Peak pressure over the positions for each torque, with the pressure after Hertz.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.add_subplot()
    angle = np.degrees(result.pinion_angle)
    peak, hertz = result.by_torque("peak_pressure"), result.by_torque("hertz_pressure")
    on_edge = result.by_torque("on_edge") > 0
    for torque, label, colour, marker in _torque_styles(result):
        axes.plot(angle, peak[torque], color=colour, marker=marker, markersize=5.0, label=label)
    if np.isfinite(hertz).any():
        lines = axes.plot(angle, hertz.T, color=ACCENT, linestyle="--", marker="_")
        lines[0].set_label("after Hertz")
    if on_edge.any():
        place = np.broadcast_to(angle, peak.shape)[on_edge]
        label = "contact reaches a border of a flank (peak grows with the grid)"
        axes.plot(place, peak[on_edge], "o", markersize=10.0, fillstyle="none", color="black", label=label)
    axes.set_xlabel("pinion angle [deg]")
    axes.set_ylabel("peak contact pressure [MPa]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    _widen(axes, 0.02 * max(1.0, float(np.nanmax(peak, initial=0.0))))
    _title(figure, result, f"peak contact pressure, {_loads(result)}", _range(result))
    return figure


def plot_contact_path(result: MeshCycle, torque: int | None = None) -> Figure:
    """Path of contact on both flanks, diameter against face width, with some of the areas under pressure.

    White is the part of a flank that the mate reaches at nominal mounting.

    Parameters
    ----------
    result : MeshCycle
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = _highest_torque(result) if torque is None else torque
    figure = Figure(figsize=(11.0, 5.5), layout="constrained")
    panels, drawn = figure.subplots(1, 2), 0
    scene = parse_scene(result.scene_toml)
    mesh, pair, path = scene.mesh(), scene.pair(), result.path
    sides = (
        ("pinion", mesh.pinion, mesh.pinion_active_profile.start_radius, path.pinion_radius, path.pinion_axial),
        ("wheel", mesh.wheel, mesh.wheel_active_profile.start_radius, path.wheel_radius, path.wheel_axial),
    )
    peaks = result.by_torque("peak_pressure")[torque]
    colours = ScalarMappable(Normalize(*_range_of(peaks)), COLOURS)
    for axes, (name, gear, start, radius, axial) in zip(panels, sides, strict=True):
        outline = _draw_flank(axes, name, gear, start)
        areas = _areas(result, torque, pair, name, colours)
        axes.add_collection(areas)
        areas.set_clip_path(outline)
        drawn = len(areas.get_paths())
        axes.plot(axial, 2.0 * radius, ".", color=ACCENT, markersize=4.0)
    figure.colorbar(colours, ax=panels, label="peak contact pressure of the position [MPa]")
    _explain(figure, drawn, len(path))
    _title(figure, result, f"contact on the flanks, {_load(result, torque)}", _range(result))
    return figure


def _explain(figure: Figure, drawn: int, positions: int) -> None:
    """The legend of the picture of the flanks."""
    handles = [
        Line2D([], [], color=ACCENT, marker=".", linestyle="", label="unloaded contact"),
        Patch(facecolor=colormaps[COLOURS](0.5), label=f"under pressure ({drawn} of {positions} positions)"),
        Patch(facecolor=NO_MATE, edgecolor="black", label="flank that the mate does not reach"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize="small")


def _draw_flank(axes: Axes, name: str, gear: CylindricalGear, start_radius: float) -> Patch:
    """The flank from form circle to tip, with the part that the mate reaches in white; returns its outline."""
    half = 0.5 * gear.face_width
    form, start, tip = (2.0 * radius for radius in (gear.form_radius, start_radius, gear.tip_radius))
    whole = Rectangle((-half, form), 2.0 * half, tip - form, facecolor=NO_MATE, edgecolor="black")
    axes.add_patch(whole)
    axes.add_patch(Rectangle((-half, start), 2.0 * half, tip - start, facecolor="white", edgecolor="black"))
    axes.set_xlim(-1.08 * half, 1.08 * half)
    axes.set_ylim(form - 0.08 * (tip - form), tip + 0.08 * (tip - form))
    axes.set_title(f"{name}, active flank from diameter {start:.2f} to {tip:.2f} mm", fontsize="small")
    axes.set_xlabel("axial place, from mid-face [mm]")
    axes.set_ylabel("diameter [mm]")
    return whole


def _drawn(result: MeshCycle) -> list[int]:
    """Positions whose areas are drawn: few enough to be told apart."""
    last = len(result.path) - 1
    return sorted({round(last * part / (MOST_AREAS - 1)) for part in range(MOST_AREAS)})


def _areas(result: MeshCycle, torque: int, pair: GearPair, gear: str, colours: ScalarMappable) -> PolyCollection:
    """Areas under pressure on a flank, coloured by their peak pressure."""
    outlines, peaks = [], []
    for position in _drawn(result):
        one = result.maps[torque][position]
        if one is not None and one.pressure.max() > 0.0:
            radius, axial = _on_gear(pair, gear, _outline(one))
            outlines.append(np.column_stack([axial, 2.0 * radius]))
            peaks.append(result.by_torque("peak_pressure")[torque, position])
    return PolyCollection(outlines, facecolors=colours.to_rgba(np.array(peaks)), edgecolors="none")


def _on_gear(pair: GearPair, gear: str, point: Array) -> tuple[Array, Array]:
    """Radius and axial coordinate (n,) of points (n, 3) on a gear."""
    if gear == "pinion":
        return np.hypot(point[:, 0], point[:, 1]), point[:, 2]
    radius, _, axial = pair.to_wheel(point)
    return radius, axial


def _outline(one: PressureMap) -> Array:
    """Points (n, 3) around the cells under pressure, in the fixed frame [mm]."""
    loaded = one.pressure > 0.0
    columns = np.flatnonzero(loaded.any(axis=0))
    first = loaded.argmax(axis=0)[columns]
    last = len(one.x) - 1 - loaded[::-1].argmax(axis=0)[columns]
    y = np.repeat(one.y[columns], 2) + 0.5 * one.spacing[1] * np.tile([-1.0, 1.0], len(columns))
    lower, upper = (np.repeat(one.x[rows], 2) for rows in (first, last))
    x = np.concatenate([lower - 0.5 * one.spacing[0], (upper + 0.5 * one.spacing[0])[::-1]])
    around = np.concatenate([y, y[::-1]])
    return one.origin + x[:, None] * one.axes[0] + around[:, None] * one.axes[1]


def _draw_pressure(figure: Figure, axes: Axes, one: PressureMap) -> None:
    """Pressure of each cell; white without pressure, grey without material."""
    y, x = (_borders(centres, step) for centres, step in ((one.y, one.spacing[1]), (one.x, one.spacing[0])))
    void = np.isinf(one.gap)
    axes.set_facecolor(NO_MATERIAL)
    axes.pcolormesh(y, x, np.where(void, np.nan, 0.0), cmap="Greys", vmin=0.0, vmax=1.0)
    if void.any():
        axes.plot([], [], "s", color=NO_MATERIAL, label="no material")
    loaded = np.where(one.pressure > 0.0, one.pressure, np.nan)
    scale = Normalize(0.0, max(1.0, float(one.pressure.max())))
    mesh = axes.pcolormesh(y, x, loaded, cmap=COLOURS, norm=scale)
    figure.colorbar(mesh, ax=axes, label="contact pressure [MPa]")


def _draw_ellipse(axes: Axes, result: MeshCycle, place: tuple[int, int]) -> None:
    """The contact ellipse after Hertz, where it is known."""
    names = ("hertz_semi_minor", "hertz_semi_major", "hertz_pressure")
    minor, major, pressure = (float(result.by_torque(name)[place]) for name in names)
    if math.isfinite(pressure):
        label = f"ellipse after Hertz, peak pressure {pressure:.4g} MPa"
        ellipse = Ellipse((0.0, 0.0), 2.0 * major, 2.0 * minor, fill=False, color=ACCENT, linestyle="--", label=label)
        axes.add_patch(ellipse)


def _borders(centres: Array, step: float) -> Array:
    """Borders (n + 1,) of cells of one size."""
    return np.append(centres, centres[-1] + step) - 0.5 * step


def _scale_factor(one: PressureMap) -> tuple[float, float]:
    """How much larger to draw the direction across, for a map of 7 inches by what is returned beside it."""
    length, width = len(one.y) * one.spacing[1], len(one.x) * one.spacing[0]
    wanted = 0.5 * length / width
    power = 10.0 ** math.floor(math.log10(wanted))
    scale = max(factor * power for factor in (1.0, 2.0, 5.0) if factor * power <= wanted)
    return scale, 7.0 * scale * width / length


def _torque_styles(result: MeshCycle) -> Iterator[tuple[int, str, str, str]]:
    """Index, label, colour and marker of each torque; of many torques only some have a label."""
    count = len(result.torque)
    every = math.ceil(count / MOST_LABELS)
    for torque in range(count):
        shade = 0.15 + 0.7 * torque / max(1, count - 1)
        label = _load(result, torque) if torque % every == 0 else "_unlabelled"
        yield torque, label, to_hex(colormaps[COLOURS](shade)), MARKERS[torque % len(MARKERS)]


def _add_length_axis(axes: Axes, base_radius: float) -> None:
    """A second axis with the transmission error as a length at the wheel's base circle."""
    factor = base_radius * 1e3 / ARCSEC
    functions = (lambda arcsec: arcsec * factor, lambda length: length / factor)
    axes.secondary_yaxis("right", functions=functions).set_ylabel("at the wheel's base circle [µm]")


def _widen(axes: Axes, smallest: float) -> None:
    """Give the vertical axis a span that does not blow up rounding."""
    low, high = axes.get_ylim()
    if high - low < smallest:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * smallest, middle + 0.5 * smallest)


def _range_of(values: Array) -> tuple[float, float]:
    """Least and greatest finite value, apart in any case."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    return low, max(high, low + 1.0)


def _highest_torque(result: MeshCycle) -> int:
    return int(np.argmax(result.torque))


def _load(result: MeshCycle, torque: int) -> str:
    return f"pinion torque {1e-3 * result.torque[torque]:.4g} N m"


def _loads(result: MeshCycle) -> str:
    low, high = 1e-3 * result.torque.min(), 1e-3 * result.torque.max()
    return _load(result, 0) if low == high else f"pinion torques {low:.4g} to {high:.4g} N m"


def _place(result: MeshCycle, position: int) -> str:
    where = result.path[position]
    return (
        f"position {position + 1} of {len(result.path)}: pinion angle {_degrees(where.pinion_angle)} deg, "
        f"diameter {2.0 * where.pinion_radius:.4g} mm"
    )


def _range(result: MeshCycle) -> str:
    first, last = (_degrees(result.pinion_angle[end]) for end in (0, -1))
    if len(result.path) == 1:
        return f"pinion angle {first} deg"
    return f"{len(result.path)} positions, pinion angle {first} to {last} deg"


def _degrees(angle: float) -> str:
    return f"{round(math.degrees(angle), 3) + 0.0:.4g}"


def _title(figure: Figure, result: MeshCycle, *about: str) -> None:
    """Title of the scene and what is shown; taken literally, signs of TeX too."""
    lines = [*textwrap.wrap(result.title, 90), ", ".join(about)]
    figure.suptitle("\n".join(lines), fontsize="medium", parse_math=False)
