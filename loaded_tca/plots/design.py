"""Pictures of a design: transmission error, pressure and load factors before and after, and how robust they are.

All take a dataset as designs give it, with the variables

- ``transmission_error`` (design, sample, torque, position) [rad], over one pitch, both ends included;
- ``peak_pressure`` (design, sample, torque, position) [MPa], the highest of all pairs;
- ``span_um`` (design, sample, torque), the peak-to-peak transmission error at the wheel's base circle;
- ``face_load_factor`` (design, sample, torque);

the coordinates ``design`` (names, such as "start" and "optimum") and ``torque`` [N mm], and the attribute
``scene_toml``. Samples are those of the scatter. A robustness curve is ``objective`` (design, multiple), with the
coordinate ``multiple`` of the scatter; its name and unit may be the attributes ``long_name`` and ``units``.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.style import DISTINCT_COLOURS, MARKERS
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.summary import shown_torque
from loaded_tca.scene import Scene, parse_scene

if TYPE_CHECKING:
    import xarray

    from loaded_tca.studies.design import DesignResult

COLOURS = DISTINCT_COLOURS[1], DISTINCT_COLOURS[0], *DISTINCT_COLOURS[2:]
TORQUE_AXIS = "pinion torque [N m]"
SMALLEST_SPAN_UM = 1e-3
LONGEST_LABEL = 48
"""Characters in a line beside an axis."""
BASE_CIRCLE = "at the wheel's base circle [µm]"


def plot_before_and_after(design: xarray.Dataset | DesignResult, torque: int | None = None) -> Figure:
    """Transmission error and peak pressure over the positions, load factor and peak-to-peak over the torque.

    Lines are the mean of the samples, bands all of them.

    Parameters
    ----------
    design : DesignResult or xarray.Dataset
        What ``studies.optimise`` returns, or a dataset as the top of this module describes it.
    torque : int, optional
        Index of the torque of the curves over the positions; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If a variable is missing, or there is no such torque.
    """
    design = _with(design, "transmission_error", "peak_pressure", "span_um", "face_load_factor")
    scene = _scene(design)
    pair = scene.pair()
    torques = 1e-3 * design["torque"].values
    torque = style.torque_or_largest(torques, torque)
    figure = Figure(figsize=(11.0, 8.0), layout="constrained")
    (error, pressure), (factor, span) = figure.subplots(2, 2)
    angle = np.degrees(pair.pitch) * np.linspace(-0.5, 0.5, design.sizes["position"])
    length, under = 1e3 * pair.base_radii[1], shown_torque(1e3 * torques[torque])
    _draw(error, design, "transmission_error", angle, lambda values: _less_mean(length * values[:, torque]))
    _draw(pressure, design, "peak_pressure", angle, lambda values: values[:, torque])
    _draw(factor, design, "face_load_factor", torques)
    _draw(span, design, "span_um", torques)
    for axes, across, label in (
        (error, f"pinion angle [deg], under {under}", f"transmission error less its mean\n{BASE_CIRCLE}"),
        (pressure, f"pinion angle [deg], under {under}", "peak pressure [MPa]"),
        (factor, TORQUE_AXIS, "face load factor K_Hβ"),
        (span, TORQUE_AXIS, f"peak-to-peak transmission error\n{BASE_CIRCLE}"),
    ):
        axes.set(xlabel=across, ylabel=label)
    for axes in (error, span):
        style.widen(axes, SMALLEST_SPAN_UM)
    span.set_ylim(bottom=0.0)
    return _finished(figure, design, error, scene.title, f"before and after: {_designs(design)}")


def plot_peak_to_peak_over_torque(design: xarray.Dataset | DesignResult) -> Figure:
    """Peak-to-peak transmission error over the torque: mean of the samples, and the band of all of them.

    Parameters
    ----------
    design : DesignResult or xarray.Dataset
        What ``studies.optimise`` returns, or a dataset as the top of this module describes it.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If a variable is missing.
    """
    design = _with(design, "span_um")
    figure, axes = style.one_panel()
    _draw(axes, design, "span_um", 1e-3 * design["torque"].values)
    axes.set(xlabel=TORQUE_AXIS, ylabel=f"peak-to-peak transmission error\n{BASE_CIRCLE}")
    style.widen(axes, SMALLEST_SPAN_UM)
    axes.set_ylim(bottom=0.0)
    about = f"peak-to-peak transmission error over the torque, {_designs(design)}"
    return _finished(figure, design, axes, _scene(design).title, about)


def plot_robustness(design: xarray.Dataset) -> Figure:
    """Robustness curve: the objective of each design over the multiple of the scatter; at 0 there is no scatter.

    Parameters
    ----------
    design : xarray.Dataset
        What ``studies.robustness`` returns.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If it has no objective over a multiple of the scatter.
    """
    design = _with(design, "objective")
    require(("multiple" in design.dims, "design: no robustness curve; allowed what studies.robustness returns"))
    objective = design["objective"].transpose("design", "multiple")
    figure, axes = style.one_panel()
    for name, curve, (colour, marker) in zip(_names(design), objective.values, _styles(), strict=False):
        axes.plot(design["multiple"].values, curve, color=colour, marker=marker, markersize=5.0, label=name)
    words, unit = (objective.attrs.get(name, "") for name in ("long_name", "units"))
    axes.set_xlabel("scatter, as a multiple of that of the design")
    label = (words or "objective") + (f" [{unit.replace('um', 'µm')}]" if unit not in ("", "1") else "")
    axes.set_ylabel(textwrap.fill(label, LONGEST_LABEL))
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    return _finished(figure, design, axes, "", f"robustness, {_designs(design)}")


def _with(design: xarray.Dataset | DesignResult, *names: str) -> xarray.Dataset:
    """The dataset, of a result of a design its own, if it has the variables."""
    given: Any = design
    dataset: xarray.Dataset = getattr(given, "dataset", given)
    missing = [name for name in names if name not in dataset]
    require((not missing, f"design: {', '.join(missing)} missing; the dataset of a design has them"))
    return dataset


def _draw(
    axes: Axes, design: xarray.Dataset, name: str, places: Array, changed: Callable[[Array], Array] = np.asarray
) -> None:
    """A line at the mean of the samples for each design, and a band from the least to the largest.

    The last axis is that of the places; values (sample, ...) of a design are changed before.
    """
    names, is_one = _names(design), len(places) == 1
    if is_one:  # the designs stand side by side
        axes.set_xticks(places, [plain(float(places[0]), 6)])
        axes.set_xlim(places[0] - len(names), places[0] + len(names))
    for k, (label, of_design, (colour, marker)) in enumerate(zip(names, design[name], _styles(), strict=False)):
        at = places + (k - 0.5 * (len(names) - 1)) * is_one
        dims = [dim for dim in ("sample", "torque", "position") if dim in of_design.dims]
        values = changed(of_design.transpose(*dims).values)
        if len(values) > 1:
            low, high = values.min(axis=0), values.max(axis=0)
            border = to_rgba(colour, 0.6)  # bands that lie over each other are told apart by it
            axes.fill_between(at, low, high, facecolor=to_rgba(colour, 0.2), edgecolor=border, linewidth=0.8)
            if is_one:  # a band needs two
                axes.vlines(at, low, high, color=colour, alpha=0.4, linewidth=4.0)
        axes.plot(at, values.mean(axis=0), color=colour, marker=marker, markersize=4.0, label=label)
    axes.grid(alpha=0.3)


def _finished(figure: Figure, design: xarray.Dataset, axes: Axes, scene: str, shown: str) -> Figure:
    """The figure with the legend of a panel below, and its title."""
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    samples = design.sizes.get("sample", 1)
    note = f"lines: mean, bands: range of {samples} samples of the scatter"
    with_bands = axes.collections and samples > 1
    style.write_title(figure, scene, shown, *([note] if with_bands else []))
    return figure


def _names(design: xarray.Dataset) -> list[str]:
    """Names as legends take them: no TeX, none hidden."""
    return [f" {name}".replace("$", r"\$") for name in design["design"].values]


def _designs(design: xarray.Dataset) -> str:
    return " and ".join(str(name) for name in design["design"].values)


def _styles() -> cycle[tuple[str, str]]:
    return cycle(zip(COLOURS, MARKERS, strict=False))


def _scene(design: xarray.Dataset) -> Scene:
    """The scene that was designed."""
    return parse_scene(str(design.attrs.get("scene_toml", "")), source="scene_toml", folder=None)


def _less_mean(values: Array) -> Array:
    """Curves (sample, position) about their means over a pitch."""
    return values - np.array([mean_over_a_pitch(curve) for curve in values])[:, None]
