"""Scatter to first order beside that of a Monte Carlo study: where first order holds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.study_panels import SAME, panels_of, told_of_variants
from loaded_tca.plots.style import ACCENT, COLOURS, chosen_torque, label_of, load
from loaded_tca.results.figures import key_figures
from loaded_tca.results.sensitivities import Sensitivities
from loaded_tca.results.tolerances import key_figure_slopes
from loaded_tca.studies.ranking import figure_values, varied_keys

if TYPE_CHECKING:
    import xarray

TORQUE = "pinion_torque_Nm"
WIDTHS = np.linspace(-3.5, 3.5, 141)
"""Standard deviations at which the normal distribution is drawn."""
MOST_BARS = 30


def plot_first_order_scatter(sensitivities: Sensitivities, study: xarray.Dataset, torque: int | None = None) -> Figure:
    """Scatter of key figures: histogram of a study, and the normal distribution that first order expects.

    The standard deviations of the keys are those of the samples of the study. A panel for each figure that both have,
    with the standard deviations of both.

    Parameters
    ----------
    sensitivities : Sensitivities
        Of the result in the middle of the scatter, to all keys that the study varies.
    study : xarray.Dataset
        Of :func:`loaded_tca.studies.run_study`, its keys independent of each other, under the torques of the result.
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque, or the study varies another key, or has other torques, or none of the figures.
    """
    from scipy.stats import norm  # half a second, which other pictures do not need

    result, keys = sensitivities.result, varied_keys(study)
    torque = chosen_torque(result, torque)
    torques = figure_values(study, TORQUE)
    others = [key for key in keys if key not in sensitivities.keys]
    same = torques.shape[1] == len(result.torque) and bool(
        np.allclose(torques[np.isfinite(torques).all(axis=1)], 1e-3 * result.torque, rtol=SAME)
    )
    require(
        (not others, f"study: varies {', '.join(others)}, without derivatives in the sensitivities"),
        (same, "study: its torques are not those of the result"),
    )
    spread = np.array([float(np.std(study[key].values, ddof=1)) if key in keys else 0.0 for key in sensitivities.keys])
    slopes = {name: values[torque] for name, values in key_figure_slopes(sensitivities).items()}
    sigmas = {name: math.sqrt(float(((values * spread) ** 2).sum())) for name, values in slopes.items()}
    scattered = {name: figure_values(study, name)[:, torque] for name in sigmas if name in study}
    shown = [name for name, values in scattered.items() if np.isfinite(values).any() and math.isfinite(sigmas[name])]
    require((bool(shown), f"study: has none of {', '.join(sigmas)}"))
    middle = key_figures(result, torque)
    drawing, panels = panels_of(len(shown), (6.0, 3.6))
    for axes, name in zip(panels, shown, strict=True):
        values = scattered[name][np.isfinite(scattered[name])]
        bars = min(MOST_BARS, max(5, math.ceil(2.0 * np.cbrt(len(values)))))
        light = to_hex(colormaps[COLOURS](0.6))
        axes.hist(values, bins=bars, density=True, color=light, edgecolor="white", label="study")
        if sigmas[name] > 0.0:
            places = middle[name] + sigmas[name] * WIDTHS
            axes.plot(places, norm.pdf(places, middle[name], sigmas[name]), color=ACCENT, label="first order")
        axes.set(xlabel=label_of(name), yticks=[], ylabel="density")
        by_study = float(np.std(values, ddof=1)) if len(values) > 1 else math.nan
        title = f"standard deviation {plain(sigmas[name], 3)} to first order, {plain(by_study, 3)} in the study"
        axes.set_title(title, fontsize="small")
    drawing.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize="small")
    style.set_title(drawing, result, f"scatter by {len(keys)} keys, {load(result, torque)}", told_of_variants(study))
    return drawing
