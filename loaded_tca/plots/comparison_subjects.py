"""Two or more results in one picture for each subject: load over the face, contact patterns, root stress.

All pictures of a comparison, by the names of their files.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from loaded_tca.arrays import GEARS
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.comparison import (
    MOST_IN_A_ROW,
    PANEL_INCHES,
    Results,
    abscissa_of,
    label_of_result,
    plot_compared_maps,
    plot_comparison,
    styles_of,
    title_of,
    under_torque,
)
from loaded_tca.plots.flanks import draw_on_pinion, loaded_maps
from loaded_tca.plots.picture import Picture, figures_of
from loaded_tca.plots.pressure_map import draw_envelope
from loaded_tca.plots.root_stress import COMPRESSION, TENSION
from loaded_tca.plots.sharing import a_pitch_of
from loaded_tca.plots.style import COLOURS
from loaded_tca.results.comparison import Comparison, compare_results
from loaded_tca.results.load_factors import face_forces

BELOW_PANELS = 1.4
"""Inches of a picture of flanks below and above its panels."""
FEWEST = 2
"""Results with root stress that a picture of it takes."""


def plot_compared_face_load(results: Results, torque: float | None = None) -> Figure:
    """Load over the face width of two or more results, under one torque, with K_Hbeta.

    Normal force of all tooth pairs per width, the mean over a pitch. Of flanks whose face is counted otherwise, as that
    of a bevel gear beside that of a cylindrical one, over the part of the face.

    Parameters
    ----------
    results : mapping of str to MeshCycle, sequence of MeshCycle, or Comparison
        As :func:`loaded_tca.results.compare_results` takes them; their names are in the legend.
    torque : float [N mm], optional
        One that all results have; default: the largest of these.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there are fewer than two results, they do not share the torque, or one has a single position.
    """
    comparison = results if isinstance(results, Comparison) else compare_results(results)
    shared, named = comparison.index_of(torque), comparison.results
    require(a_pitch_of(*named.values()))
    labels = {result.gear_pair.pinion.flank.frame.labels[0] for result in named.values()}
    figure = Figure(figsize=(9.0, 5.5), layout="constrained")
    axes = figure.add_subplot()
    for (name, result), k, (colour, _, width) in zip(
        named.items(), comparison.indices[shared].tolist(), styles_of(len(named)), strict=True
    ):
        borders, forces = face_forces(result.gear_pair, result.path, result.maps[k])
        load = forces / (len(result.path) - 1) / np.diff(borders)
        places = borders if len(labels) == 1 else 100.0 * (borders - borders[0]) / (borders[-1] - borders[0])
        factor = float(result.face_load_factor[k])
        known = "" if math.isnan(factor) else f", K_Hβ = {plain(factor, 3)}"
        axes.stairs(load, places, color=colour, linewidth=width, label=label_of_result(name) + known, baseline=None)
    axes.set(xlabel=labels.pop() if len(labels) == 1 else "part of the face of the pinion [%]")
    axes.set_ylabel("normal force per face width [N/mm]")
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    about = f"load over the face width, {under_torque(comparison, shared)}"
    style.write_title(figure, title_of(named), about, "mean over a pitch, all tooth pairs")
    return figure


def plot_compared_patterns(results: Results, torque: float | None = None) -> Figure:
    """Contact patterns of two or more results side by side on the pinion's flank, on one scale of colours.

    The highest pressure that each place of the flank sees over the positions. All flanks have one scale of lengths.

    Parameters
    ----------
    results, torque
        As of :func:`plot_compared_face_load`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there are fewer than two results, or they do not share the torque.
    """
    comparison = results if isinstance(results, Comparison) else compare_results(results)
    shared, named = comparison.index_of(torque), comparison.results
    cases = [(name, result, k) for (name, result), k in zip(named.items(), comparison.indices[shared], strict=True)]
    columns = min(len(named), max(MOST_IN_A_ROW, math.ceil(math.sqrt(len(named)))))
    rows = math.ceil(len(named) / columns)
    figure = Figure(figsize=(PANEL_INCHES * columns, BELOW_PANELS + 3.4 * rows), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    highest = max(float(np.nanmax(result.peak_pressure[k], initial=0.0)) for _, result, k in cases) or 1.0
    scale = Normalize(0.0, highest)
    for axes, (name, result, k) in zip(panels, cases, strict=False):
        draw_on_pinion(axes, result, partial(draw_envelope, result, int(k), scale))
        axes.set_title(f"{name}\n{axes.get_title()}", fontsize="small", parse_math=False)
    for axes in panels[len(named) :]:
        axes.remove()
    panels = panels[: len(named)]
    _give_one_scale(panels)
    beyond = any(one.pressure.max() > highest for _, result, k in cases for one in loaded_maps(result, int(k)))
    bar = ScalarMappable(scale, COLOURS)
    extend = "max" if beyond else "neither"
    figure.colorbar(bar, ax=panels, label="highest contact pressure [MPa]", extend=extend)
    style.write_title(figure, title_of(named), f"contact patterns, {under_torque(comparison, shared)}")
    return figure


def _give_one_scale(panels: Sequence[Axes]) -> None:
    """Give all panels the spans of the largest, about their own middles."""
    for ends, bounded in ((Axes.get_xbound, Axes.set_xbound), (Axes.get_ybound, Axes.set_ybound)):
        bounds = np.array([ends(axes) for axes in panels])
        half = 0.5 * float(np.ptp(bounds, axis=1).max())
        for axes, middle in zip(panels, bounds.mean(axis=1).tolist(), strict=True):
            bounded(axes, middle - half, middle + half)


def plot_compared_root_stress(results: Results, torque: float | None = None) -> Figure:
    """Largest tension and compression at the roots of two or more results over the positions, under one torque.

    Pinion and wheel on one scale. Angles are in degrees, of pinions with different numbers of teeth in pitches. Results
    without root stress are left out.

    Parameters
    ----------
    results, torque
        As of :func:`plot_compared_face_load`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there are fewer than two results, they do not share the torque, or fewer than two have root stress.
    """
    comparison = results if isinstance(results, Comparison) else compare_results(results)
    shared, named = comparison.index_of(torque), comparison.results
    count = len(_with_roots(comparison))
    require((count >= FEWEST, f"root stress: {count} of the results have it; a comparison takes two or more"))
    unit, scales = abscissa_of(named)
    figure = Figure(figsize=(11.0, 5.5), layout="constrained")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for (name, result), k, (colour, marker, width), scale in zip(
        named.items(), comparison.indices[shared].tolist(), styles_of(len(named)), scales, strict=True
    ):
        if not result.has_root_stress:
            continue
        look = {"color": colour, "marker": marker, "linewidth": width, "markersize": 4.0}
        angle = scale * result.pinion_angle
        for gear, axes in enumerate(panels):
            axes.plot(angle, result.root_tension[k, :, gear], TENSION, label=label_of_result(name), **look)
            axes.plot(angle, result.root_compression[k, :, gear], COMPRESSION, **look)
    for name, axes in zip(GEARS, panels, strict=True):
        axes.axhline(0.0, color="black", linewidth=0.8)
        axes.set_title(name, fontsize="medium")
        axes.set_xlabel(f"pinion angle {unit}")
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("root stress [MPa]")
    panels[0].plot([], [], TENSION, color="black", label="largest tension")
    panels[0].plot([], [], COMPRESSION, color="black", label="largest compression")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    without = ", ".join(name for name, result in named.items() if not result.has_root_stress)
    about = f"root stress over the mesh, {under_torque(comparison, shared)}"
    style.write_title(figure, title_of(named), about, f"without root stress: {without}" if without else "")
    return figure


def _with_roots(comparison: Comparison) -> list[str]:
    """Names of the results that have root stress."""
    return [name for name, result in comparison.results.items() if result.has_root_stress]


def _has_a_pitch(comparison: Comparison) -> bool:
    return a_pitch_of(*comparison.results.values())[0]


COMPARISON_PICTURES: dict[str, Picture[Comparison]] = {
    "comparison": Picture(
        "transmission error, its harmonics, stiffness, pressure and load share, over each other",
        "Transmission error absolute and less its mean, its orders, mesh stiffness; peak pressure and share of every "
        "tooth pair at the angle of its own teeth.",
        plot_comparison,
    ),
    "compared_maps": Picture(
        "pressure maps side by side on one scale",
        "Each at the position of its own peak pressure, in the tangent plane, on one scale of colours and one of "
        "lengths. White: no pressure, grey: no material.",
        plot_compared_maps,
    ),
    "compared_patterns": Picture(
        "contact patterns on the pinion's flank side by side on one scale",
        "The highest pressure that each place of the pinion's flank sees over the mesh cycle, on one scale of colours "
        "and one of lengths. Beyond the scale lie pressures at edges, mesh-dependent at sharp ones.",
        plot_compared_patterns,
    ),
    "compared_face_load": Picture(
        "load over the face width with K_Hbeta; of two positions or more",
        "Normal force of all tooth pairs per face width, the mean over a pitch. Its largest value over its mean is "
        "K_Hβ.",
        plot_compared_face_load,
        _has_a_pitch,
    ),
    "compared_root_stress": Picture(
        "root stress over the positions; where two results or more have it",
        "Largest tension (solid) and compression (dashed) at the roots over the positions.",
        plot_compared_root_stress,
        lambda comparison: len(_with_roots(comparison)) >= FEWEST,
    ),
}
"""Pictures of a comparison by the names of their files."""


def comparison_figures(results: Results, torque: float | None = None, position: int | None = None) -> dict[str, Figure]:
    """Draw every picture that a comparison has, under one torque.

    Parameters
    ----------
    results : mapping of str to MeshCycle, sequence of MeshCycle, or Comparison
        As :func:`loaded_tca.results.compare_results` takes them.
    torque : float [N mm], optional
        One that all results have; default: the largest of these.
    position : int, optional
        Of the pressure maps, as :func:`plot_compared_maps` takes it.

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        By the names of ``COMPARISON_PICTURES``.

    Raises
    ------
    InputError
        If there are fewer than two results, they do not share the torque, or the first has no such position.
    """
    comparison = results if isinstance(results, Comparison) else compare_results(results)
    maps = COMPARISON_PICTURES["compared_maps"]._replace(draw=partial(plot_compared_maps, position=position))
    return figures_of(COMPARISON_PICTURES | {"compared_maps": maps}, comparison, torque)
