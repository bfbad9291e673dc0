"""Shafts under load: their outlines with gear and bearings, and their deflection lines in two planes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from loaded_tca.loaded.shaft_lines import ShaftLine
from loaded_tca.plots.style import ACCENT, COLOURS, MARKERS, write_title
from loaded_tca.results.summary import shown_torque

PLANES = "x", "y"


def plot_shafts(lines: Sequence[ShaftLine], title: str = "") -> Figure:
    """Outline of every shaft with its gear and bearings, and below it how it bends along x and y of the gear's frame.

    Parameters
    ----------
    lines : sequence of ShaftLine
        Of :func:`loaded_tca.loaded.shaft_lines.shaft_lines`.
    title : str
        Stands over the picture.

    Returns
    -------
    matplotlib.figure.Figure
    """
    gears = list(dict.fromkeys(line.gear for line in lines))
    figure = Figure(figsize=(6.5 * len(gears), 8.5), layout="constrained")
    panels = figure.subplots(3, len(gears), squeeze=False, sharex="col")
    for column, gear in enumerate(gears):
        own = [line for line in lines if line.gear == gear]
        _draw_outline(panels[0, column], own[0])
        for place, plane in enumerate(PLANES):
            axes = panels[1 + place, column]
            for n, line in enumerate(own):
                colour = to_hex(colormaps[COLOURS](0.15 + 0.7 * n / max(1, len(own) - 1)))
                values = 1e3 * line.motions[:, place]
                axes.plot(line.places, values, color=colour, label=shown_torque(line.torque))
                at = [int(np.abs(line.places - bearing.at).argmin()) for bearing in line.shaft.bearings]
                axes.plot(line.places[at], values[at], MARKERS[n % len(MARKERS)], color=colour)
            axes.axvline(own[0].middle, color=ACCENT, linestyle=":", label="middle of the face")
            axes.axhline(0.0, color="0.6", linewidth=0.8)
            axes.set_ylabel(f"deflection along {plane} [µm]")
            axes.grid(alpha=0.3)
        panels[2, column].set_xlabel(f"axial coordinate of the {gear} [mm]")
    figure.legend(*panels[1, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    write_title(
        figure,
        title,
        "shafts under the normal force of unloaded flanks; markers: bearings",
        "axes of each gear's own frame, x to the pitch point",
    )
    return figure


def _draw_outline(axes: Axes, line: ShaftLine) -> None:
    """Sections of a shaft in their length and diameter, the face of the gear, and bearings as triangles below."""
    start, shaft, width = line.shaft.start, line.shaft, line.face_width
    largest = max(section.outer_diameter for section in shaft.sections)
    for section in shaft.sections:
        outer, inner = 0.5 * section.outer_diameter, 0.5 * section.inner_diameter
        for low, high in ((inner, outer), (-outer, -inner)):
            axes.add_patch(Rectangle((start, low), section.length, high - low, facecolor="0.8", edgecolor="0.3"))
        start += section.length
    axes.axvspan(line.middle - 0.5 * width, line.middle + 0.5 * width, color=ACCENT, alpha=0.25, label="face")
    places = [bearing.at for bearing in shaft.bearings]
    axes.plot(places, [-0.72 * largest] * len(places), "^", color="black", markersize=9, label="bearing")
    axes.plot(shaft.torque_at, 0.0, "x", color="black", label="coupling")
    axes.set_ylim(-0.95 * largest, 0.95 * largest)
    axes.set_ylabel("radius [mm]")
    axes.set_title(f"shaft of the {line.gear}")
    axes.legend(loc="upper center", ncols=3, fontsize="small")
