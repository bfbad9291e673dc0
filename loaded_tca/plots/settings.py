"""Deviations of measured flanks before and after corrections of the settings that cut them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.flank_maps.settings_fit import FlankDeviations, SettingsFit
from loaded_tca.plain import plain
from loaded_tca.plots.style import write_title
from loaded_tca.units import MICROMETRES

DIVERGING = "RdBu_r"
"""More material red, less blue, none white."""
SMALLEST_SPAN_um = 0.01


def plot_measured_settings(fit: SettingsFit) -> Figure:
    """Deviations over each measured flank, tip on top: left as measured, right what the corrections leave.

    All panels have one scale of colours. Dots are the measured points, hollow those of weight zero.

    Parameters
    ----------
    fit : SettingsFit

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(11.0, 1.2 + 2.6 * len(fit.flanks)), layout="constrained")
    panels = figure.subplots(len(fit.flanks), 2, squeeze=False, sharex="row", sharey="row")
    largest = MICROMETRES * max(float(np.abs(values).max()) for one in fit.flanks for values in (one.before, one.after))
    scale = Normalize(-max(largest, SMALLEST_SPAN_um), max(largest, SMALLEST_SPAN_um))
    for row, one in zip(panels, fit.flanks, strict=True):
        for axes, values, when in zip(row, (one.before, one.after), ("as measured", "after corrections"), strict=True):
            _draw(axes, one, MICROMETRES * values, scale)
            numbers = (
                f"rms {plain(MICROMETRES * one.rms(values), 3)}, largest "
                f"{plain(MICROMETRES * np.abs(values).max(), 3)} µm"
            )
            axes.set_title(f"{one.measured.name}, {when}: {numbers}", fontsize="small")
            axes.set_xlabel(one.nominal.frame.labels[0], fontsize="small")
        row[0].set_ylabel(one.nominal.frame.labels[1].replace(" [", "\n["), fontsize="small")
    label = "deviation, positive: more material [µm]"
    figure.colorbar(ScalarMappable(scale, DIVERGING), ax=panels.ravel().tolist(), label=label)
    write_title(figure, fit.scene.title, f"deviations of measured flanks, {len(fit.keys)} settings corrected")
    return figure


def _draw(axes: Axes, one: FlankDeviations, values: Array, scale: Normalize) -> None:
    topography, weighted = one.measured.topography, one.measured.weights > 0.0
    x, y = one.nominal.frame.to_picture(topography.radius, topography.axial)
    levels = np.linspace(scale.vmin or 0.0, scale.vmax or 0.0, 25)
    if min(values.shape) > 1:
        axes.contourf(x, y, values, levels, cmap=DIVERGING, norm=scale)
    axes.plot(x[weighted], y[weighted], ".", color="black", markersize=2.0)
    axes.plot(x[~weighted], y[~weighted], "o", color="black", markersize=3.0, markerfacecolor="none")
