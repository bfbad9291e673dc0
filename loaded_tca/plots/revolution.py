"""Pictures of a whole revolution: transmission error, its orders, the share of every tooth, all torques."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.picture import Picture, figures_of
from loaded_tca.results.quantities import GEARS
from loaded_tca.results.revolution import OverTurns, Revolution
from loaded_tca.results.summary import shown_torque

RIGID = "0.35"
KINDS = {"other": "0.75", "wheel": "#0072b2", "pinion": "#009e73", "both": "#cc79a7", "mesh": "#d55e00"}
"""Colours of orders, from the lowest layer up: others, of the rotation of each gear with their sidebands, those that
belong to both gears, the mesh."""
MOST_ORDERS = 3.5
"""Mesh orders that are shown."""
BESIDE_MESH = 0.3
"""Pitches before and after the mesh of a tooth pair that are shown."""
LEAST_SHOWN = 1e-4
"""Amplitude [um] below which orders are not told from each other."""


def _scope(revolution: OverTurns) -> str:
    return f"{revolution.pitches} pitches, {revolution.per_pitch} positions each"


def plot_revolution_error(revolution: OverTurns) -> Figure:
    """Transmission error over the revolution: rigid, and under each torque less its mean.

    Parameters
    ----------
    revolution : Revolution

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.0, 6.0), layout="constrained")
    rigid, loaded = figure.subplots(2, 1, sharex=True)
    turns = revolution.dataset["pinion_angle"].values / (2.0 * np.pi) * revolution.teeth[0]
    rigid.plot(turns, revolution.error_um(), color=RIGID, linewidth=1.0, label="without load")
    for torque in np.argsort(revolution.torque).tolist():
        error = revolution.error_um(torque)
        label = f"pinion torque {shown_torque(revolution.torque[torque])}"
        loaded.plot(
            turns,
            error - error.mean(),
            color=style.torque_colour(torque, len(revolution.torque)),
            linewidth=1.0,
            label=label,
        )
    rigid.set_ylabel("rigid [µm]")
    loaded.set_ylabel("loaded, less its mean [µm]")
    loaded.set_xlabel("pitches since the first position")
    for axes in (rigid, loaded):
        style.widen(axes, 0.02)
        axes.grid(alpha=0.3)
        axes.margins(x=0.0)
    handles, labels = (
        one + two for one, two in zip(*(a.get_legend_handles_labels() for a in (rigid, loaded)), strict=True)
    )
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize="small")
    span = "F_i'" if revolution.is_closed else f"span of {revolution.pitches} pitches, no whole turn:"
    spans = f"{span} {plain(revolution.total_deviation(), 3)} µm rigid"
    style.write_title(
        figure,
        revolution.scene.title,
        "transmission error over the revolution at the wheel's base circle",
        _scope(revolution),
        spans,
    )
    return figure


def plot_revolution_spectrum(revolution: OverTurns, torque: int | None = None) -> Figure:
    """Orders of the transmission error, mesh orders, sidebands and orders of rotation told apart.

    The title says which gear's orders are no orders of the revolution.

    Parameters
    ----------
    revolution : Revolution
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = style.torque_or_largest(revolution.torque, torque)
    figure = Figure(figsize=(9.0, 5.0), layout="constrained")
    axes = figure.add_subplot()
    spectrum = revolution.spectrum(torque)
    teeth = revolution.teeth[revolution.counted_by]
    shown = spectrum.order <= MOST_ORDERS * teeth
    order, amplitude, kind = spectrum.order[shown], spectrum.amplitude[shown], spectrum.kind[shown]
    groups = np.array([_group(one) for one in kind.tolist()])
    labels = {"mesh": "mesh orders", "wheel": "rotation of the wheel and its sidebands"}
    labels |= {"pinion": "rotation of the pinion and its sidebands", "other": "other orders"}
    labels |= {"both": "orders of both gears and their sidebands"}
    rigid = np.maximum(revolution.spectrum(rigid=True).amplitude[shown], LEAST_SHOWN)
    amplitude = np.maximum(amplitude, LEAST_SHOWN)
    for (group, colour), marker in zip(KINDS.items(), ".s^Do", strict=True):
        rows = groups == group
        if not rows.any():
            continue
        if group != "other":  # of a hunting period they are hundreds
            axes.vlines(order[rows], LEAST_SHOWN, amplitude[rows], colour, linewidth=3.0 if group == "mesh" else 1.2)
        size = 1.5 if group == "other" else 4.0
        axes.plot(order[rows], amplitude[rows], marker, color=colour, markersize=size, label=labels[group])
    named = groups != "other"
    axes.plot(order[named], rigid[named], "_", color="black", markersize=5.0, label="without load")
    axes.set_yscale("log")
    axes.set_ylim(LEAST_SHOWN, 3.0 * max(amplitude.max(initial=10.0 * LEAST_SHOWN), rigid.max(initial=0.0)))
    gear = GEARS[revolution.counted_by]
    axes.set_xlabel(f"order of the {gear}'s rotation ({gear}: {teeth} teeth)")
    axes.set_ylabel("amplitude at the wheel's base circle [µm]")
    axes.grid(alpha=0.3)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    about = f"orders of the transmission error, pinion torque {shown_torque(revolution.torque[torque])}"
    leaking = [
        f"no whole turn of the {gear}: its orders leak into the orders beside them"
        for gear in revolution.leaking_orders()
    ]
    style.write_title(figure, revolution.scene.title, about, _scope(revolution), *leaking)
    return figure


def _group(kind: str) -> str:
    """Group of the colours that a kind of order belongs to."""
    gears = [word for word in kind.split() if word in GEARS]
    if gears:
        return gears[0] if len(gears) == 1 else "both"
    return "mesh" if kind else "other"


def plot_revolution_shares(revolution: Revolution, torque: int | None = None) -> Figure:
    """Share of all tooth pairs as a band over their mesh, and the highest pressure of each tooth of both gears.

    Parameters
    ----------
    revolution : Revolution
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = style.torque_or_largest(revolution.torque, torque)
    figure = Figure(figsize=(9.0, 8.0), layout="constrained")
    curves, *teeth = figure.subplots(3, 1, height_ratios=(4.0, 3.0, 3.0))
    data = revolution.dataset
    share, zero = data["load_share"].values[torque], data["pair"].values.tolist()
    turn = np.arange(len(share)) // revolution.per_pitch
    phase = np.arange(len(share)) % revolution.per_pitch / revolution.per_pitch
    own = phase[:, None] - np.array(zero)  # pitches since the pair was at the pitch point
    numbers = turn[:, None] + np.array(zero)
    places = np.unique(own)
    rows = np.full((int(np.ptp(numbers)) + 1, len(places)), np.nan)
    rows[numbers - numbers.min(), np.searchsorted(places, own)] = share
    whole = rows[np.isfinite(rows).all(axis=1)]
    shown = whole if len(whole) else rows
    known = np.isfinite(shown).any(axis=0)
    low, high, mean = (function(shown[:, known], axis=0) for function in (np.nanmin, np.nanmax, np.nanmean))
    curves.fill_between(places[known], low, high, color="#56b4e9", alpha=0.5, label="all tooth pairs")
    curves.plot(places[known], mean, color="#0072b2", label="mean")
    curves.set_xlabel("pitches since the tooth pair was at the pitch point")
    curves.set_ylabel("share of the torque")
    curves.set_ylim(0.0, 1.05)
    under_load = places[known][high > 0.0]
    if under_load.size:
        curves.set_xlim(under_load[0] - BESIDE_MESH, under_load[-1] + BESIDE_MESH)
    curves.legend(fontsize="small", ncols=3, loc="best")
    teeth[1].sharey(teeth[0])
    for axes, gear, colour, marker in zip(teeth, GEARS, ("#009e73", "#d55e00"), "so", strict=True):
        highest = revolution.by_tooth(gear)["peak_pressure"].values[torque]
        axes.plot(np.arange(len(highest)), highest, marker + "-", color=colour, markersize=4.0, linewidth=0.8)
        axes.xaxis.set_major_locator(MaxNLocator("auto", integer=True, steps=[1, 2, 5, 10]))
        axes.set_xlabel(f"tooth of the {gear}, from 0")
        axes.set_ylabel("peak pressure,\nhighest [MPa]")
    for axes in (curves, *teeth):
        axes.grid(alpha=0.3)
    about = f"share and pressure of every tooth, pinion torque {shown_torque(revolution.torque[torque])}"
    style.write_title(figure, revolution.scene.title, about, _scope(revolution))
    return figure


def plot_revolution_waterfall(revolution: Revolution) -> Figure:
    """Orders of the transmission error over the torque, as a map of the logarithm of their amplitudes.

    Parameters
    ----------
    revolution : Revolution

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the revolution has one torque, whose orders ``plot_revolution_spectrum`` draws.
    """
    require(
        (len(revolution.torque) > 1, "torque: the revolution has one; allowed two or more, to draw orders over them")
    )
    figure = Figure(figsize=(9.0, 5.0), layout="constrained")
    axes = figure.add_subplot()
    ascending = np.argsort(revolution.torque, kind="stable").tolist()
    spectra = [revolution.spectrum(torque) for torque in ascending]
    teeth = revolution.teeth[revolution.counted_by]
    shown = spectra[0].order <= MOST_ORDERS * teeth
    order = spectra[0].order[shown]
    amplitude = np.log10(np.maximum([one.amplitude[shown] for one in spectra], LEAST_SHOWN))
    mesh = axes.pcolormesh(order, np.arange(len(ascending)), amplitude, cmap=style.COLOURS, shading="nearest")
    axes.set_yticks(range(len(ascending)), [plain(1e-3 * revolution.torque[torque]) for torque in ascending])
    gear = GEARS[revolution.counted_by]
    axes.set_xlabel(f"order of the {gear}'s rotation ({gear}: {teeth} teeth)")
    axes.set_ylabel("pinion torque [N m]")
    bar = figure.colorbar(mesh, ax=axes)
    bar.set_label("log10 of the amplitude in µm")
    style.write_title(
        figure, revolution.scene.title, "orders of the transmission error over the torque", _scope(revolution)
    )
    return figure


REVOLUTION_PICTURES: dict[str, Picture[Any]] = {
    "revolution_error": Picture(
        "transmission error over the revolution, rigid and under each torque",
        "Above: without load. Below: under each torque, less its mean.",
        plot_revolution_error,
    ),
    "revolution_spectrum": Picture(
        "orders of the transmission error under the largest torque",
        "Orders of the tooth mesh, and of the rotation of both gears with sidebands.",
        plot_revolution_spectrum,
    ),
    "revolution_shares": Picture(
        "share of every tooth as a band, highest pressure of every tooth",
        "The band holds the shares of all tooth pairs over their mesh.",
        plot_revolution_shares,
    ),
    "revolution_waterfall": Picture(
        "orders over the torque; with two torques or more",
        "Orders of the transmission error under each torque.",
        plot_revolution_waterfall,
        lambda revolution: len(revolution.torque) > 1,
    ),
}
"""Pictures of the command, by the names of their files."""


def revolution_figures(revolution: Revolution) -> dict[str, Figure]:
    """Draw every picture of a revolution; the picture over the torque needs two torques.

    Parameters
    ----------
    revolution : Revolution

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        By the names of ``REVOLUTION_PICTURES``.
    """
    return figures_of(REVOLUTION_PICTURES, revolution)
