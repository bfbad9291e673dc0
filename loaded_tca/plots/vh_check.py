"""The V-H check: contact patterns over a grid of two mounting errors."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.flank_maps.pattern import ContactPattern
from loaded_tca.flank_maps.vh_check import BEYOND, VHCheck
from loaded_tca.flanks.frame import FlankFrame
from loaded_tca.plots.style import ACCENT, COLOURS, NOT_REACHED

CELL = (2.0, 1.35)
"""Size of a cell [inch]."""
MARGIN = 1.6
"""Beside all cells, and above and below them [inch]."""
CHARACTERS = 12.0
"""Of the title in an inch."""
LEVELS = 7
EDGE = "thick frame: edge contact within the pitch"


def plot_vh_check(check: VHCheck, names: tuple[str, str] = ("V [mm]", "H [mm]"), title: str = "") -> Figure:
    """Pattern in each cell, V upwards and H to the right; in it the tip is on top, the heel (z > 0) on the right.

    Parameters
    ----------
    check : VHCheck
    names : (str, str)
        What the two errors are called, with their units.
    title : str
        Stands over the picture.

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows, columns = len(check.v), len(check.h)
    width = MARGIN + CELL[0] * columns
    figure = Figure(figsize=(width, MARGIN + CELL[1] * rows), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    upwards, onwards = np.argsort(-check.v), np.argsort(check.h)
    first = check.patterns[0][0]
    levels = np.linspace(0.0, 1e3 * first.compound, LEVELS)
    for i, row in enumerate(upwards):
        for j, column in enumerate(onwards):
            cell = (int(row), int(column))
            drawn = _draw_cell(panels[i, j], check.patterns[row][column], check.frame, levels)
            panels[i, j].plot(*check.centre[cell], "o", color=ACCENT, markeredgecolor="white", markersize=5.0)
            on_edge = check.edge_share[cell] > 0.0
            panels[i, j].set(xticks=[], yticks=[])
            for spine in panels[i, j].spines.values():
                spine.set(color=ACCENT if on_edge else "0.6", linewidth=2.0 if on_edge else 0.8)
        panels[i, 0].set_ylabel(f"{check.v[row]:.4g}", rotation=0, ha="right", va="center")
    for j, column in enumerate(onwards):
        panels[-1, j].set_xlabel(f"{check.h[column]:.4g}")
    figure.supylabel(names[0])
    figure.supxlabel(names[1])
    figure.colorbar(drawn, ax=panels, label="smallest gap over the passage [µm]", format="%.3g")
    what = f"contact pattern on the {first.gear}, marking compound {1e3 * first.compound:.4g} µm, no load"
    inside = f"dot: its centre; in each cell the tip is on top, {check.frame.heelwards} on the right; {EDGE}"
    lines = [part for line in (title, what, inside) for part in textwrap.wrap(line, int(CHARACTERS * width))]
    figure.suptitle("\n".join(lines), fontsize="medium", parse_math=False)
    return figure


def _draw_cell(axes: Axes, pattern: ContactPattern, frame: FlankFrame, levels: Array) -> ContourSet:
    """The flank, with the gap as far as the compound marks it."""
    x, y = frame.to_picture(pattern.radius, pattern.axial)
    outline = (np.concatenate([part[0], part[:, -1], part[-1, ::-1], part[::-1, 0]]) for part in (x, y))
    axes.fill(*outline, color=NOT_REACHED, zorder=0)
    gap = 1e3 * np.clip(pattern.gap, 0.0, BEYOND * pattern.compound)
    return axes.contourf(x, y, gap, levels, cmap=COLOURS)
