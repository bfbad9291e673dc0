"""The ease-off topography on the flank, with its corner values and second-order coefficients."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from loaded_tca.arrays import Array
from loaded_tca.flank_maps.ease_off_map import EaseOffMap, SecondOrder
from loaded_tca.plots.style import ACCENT, COLOURS, write_title

LEVELS = 10
SMALLEST_SPAN_um = 0.01
"""Height of the colour scale below which a map would be rounding."""
ARCMIN = math.degrees(60.0)


def plot_ease_off(ease_off: EaseOffMap, title: str = "") -> Figure:
    """Ease-off in um over the flank in its frame, the tip on top; hatched where the mating gear does not reach.

    Parameters
    ----------
    ease_off : EaseOffMap
    title : str
        Stands over the picture.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(11.0, 5.5), layout="constrained")
    axes, numbers = figure.subplots(1, 2, width_ratios=(2.6, 1.0))
    x, y = ease_off.frame.to_picture(ease_off.radius, ease_off.axial)
    height = 1e3 * ease_off.ease_off
    levels = MaxNLocator(LEVELS).tick_values(0.0, max(float(height.max()), SMALLEST_SPAN_um))
    filled = axes.contourf(x, y, height, levels, cmap=COLOURS)
    if height.max() > SMALLEST_SPAN_um:
        lines = axes.contour(x, y, height, levels[1:-1], colors="black", linewidths=0.5)
        for told in axes.clabel(lines, fmt="%.3g", fontsize="x-small"):
            told.set_path_effects([withStroke(linewidth=2.0, foreground="white")])
    if not ease_off.covered.all():
        axes.contourf(x, y, ease_off.covered, [-0.5, 0.5], colors="none", hatches=["///"])
    figure.colorbar(filled, ax=axes, label="ease-off, material removed along the normal [µm]", format="%.3g")
    _write_corners(axes, (x, y), 1e3 * ease_off.corners)
    axes.set_xlabel(ease_off.frame.labels[0])
    axes.set_ylabel(ease_off.frame.labels[1])
    _write_numbers(numbers, ease_off.second_order)
    write_title(figure, title, f"ease-off of the {ease_off.gear} against the conjugate of its mating flank")
    return figure


def _write_corners(axes: Axes, place: tuple[Array, Array], corners: Array) -> None:
    """The values in um beside the corners, inside."""
    x, y = place
    for i, j in np.ndindex(2, 2):
        at = float(x[-i, -j]), float(y[-i, -j])
        axes.annotate(
            f"{corners[i, j] + 0.0:.1f}",
            at,
            xytext=(-6.0 if j else 6.0, -6.0 if i else 6.0),
            textcoords="offset points",
            ha="right" if j else "left",
            va="top" if i else "bottom",
            color="black",
            fontweight="bold",
            bbox={"facecolor": "white", "edgecolor": ACCENT, "boxstyle": "round,pad=0.2"},
            zorder=10.0,
        )


def _write_numbers(axes: Axes, numbers: SecondOrder) -> None:
    """The second-order coefficients as a table."""
    rows = (
        ("spiral angle [arcmin]", ARCMIN * numbers.spiral_angle),
        ("pressure angle [arcmin]", ARCMIN * numbers.pressure_angle),
        ("lengthwise slope [µm]", 1e3 * numbers.lengthwise_slope),
        ("profile slope [µm]", 1e3 * numbers.profile_slope),
        ("lengthwise crowning [µm]", 1e3 * numbers.lengthwise_crowning),
        ("profile crowning [µm]", 1e3 * numbers.profile_crowning),
        ("twist [µm]", 1e3 * numbers.twist),
        ("residual, rms [µm]", 1e3 * numbers.residual),
    )
    axes.axis("off")
    cells = [[name, f"{round(value, 3) + 0.0:.3g}"] for name, value in rows]
    table = axes.table(cells, cellLoc="left", colWidths=[0.75, 0.25], edges="horizontal", loc="upper center")
    table.auto_set_font_size(False)
    table.set_fontsize(9.0)
    table.scale(1.0, 1.5)
    size = f"over {numbers.size[0]:.3g} mm of length\nand {numbers.size[1]:.3g} mm of profile"
    axes.set_title(f"second order, {size}", fontsize="small")
