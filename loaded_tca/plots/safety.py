"""Local safeties over the flanks and the roots of both gears, and all safeties beside those required."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from operator import methodcaller
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from loaded_tca.arrays import GEARS, Array
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.flanks import ToPicture, both_flanks
from loaded_tca.plots.picture import Picture
from loaded_tca.plots.pressure_map import FIELDS, POINTS_OF_A_FIELD
from loaded_tca.plots.root_stress import GEAR_COLOURS
from loaded_tca.plots.style import ACCENT, COLOURS, DISTINCT_COLOURS, load
from loaded_tca.rating import Rating
from loaded_tca.rating.lives import COAST, FLANK, LOCAL_FLANK, LOCAL_ROOT, ROOT
from loaded_tca.rating.places import (
    FlankSafeties,
    RootSafeties,
    flank_safeties,
    is_shown,
    root_safeties,
    torque_of,
    worst_case,
)
from loaded_tca.rating.spectrum import OfSpectrum
from loaded_tca.results.summary import shown_torque
from loaded_tca.scene.load import ROUNDED

if TYPE_CHECKING:
    from loaded_tca.rating.rating import OfCases

BAR_COLOURS = (*GEAR_COLOURS, DISTINCT_COLOURS[5])
LARGEST = 2.5
"""Safety over the least one from which colours do not differ any more."""
SAFETIES = {
    FLANK: "pitting, {}-2",
    LOCAL_FLANK: "pitting, local",
    ROOT: "tooth breakage, {}-3",
    LOCAL_ROOT: "tooth breakage, local",
    COAST[FLANK]: "coast flank, {}-2",
    COAST[LOCAL_FLANK]: "coast flank, local",
}
"""Kinds of failure, and what pictures call the safety against each, with the standard."""


def plot_flank_safety(rating: Rating, case: int | None = None) -> Figure:
    """Smallest local safety against pitting that each place of both flanks has over the cycle, on one scale of colours.

    Parameters
    ----------
    rating : Rating
    case : int, optional
        Index of the case; default: that of the smallest local safety, of a load spectrum the bin of the largest
        damage. Between analysed torques the places are those under the nearest one.

    Returns
    -------
    matplotlib.figure.Figure
        Of a load spectrum the title has the safety of all bins together, too.

    Raises
    ------
    InputError
        If the rating has no such case, or the case no places.
    """
    case, why = worst_case(rating, "local_flank_safety") if case is None else (case, "")
    places, required = flank_safeties(rating, case), rating.required.required_safety(FLANK)
    scale, colours = _scale(places.safety, required)
    gears = iter(range(len(GEARS)))  # panels come in this order

    def draw(axes: Axes, to_picture: ToPicture) -> list[Artist]:
        gear = next(gears)
        _mark(axes, to_picture(places.point[places.deciding(gear)]), float(np.nanmin(places.safety[gear])))
        borders, least = _least_seen(axes, places, gear, to_picture)
        return [axes.pcolormesh(*borders, least, cmap=colours, norm=scale, rasterized=True)]

    figure, panels = both_flanks(rating.result, draw)
    mappable = ScalarMappable(scale, colours)
    figure.colorbar(mappable, ax=panels, label="local safety against pitting", extend="both")
    style.set_title(
        figure,
        rating.result,
        f"local safety of the flanks, {_load(rating, case)}",
        *_about(rating, case, LOCAL_FLANK, why),
    )
    return figure


def plot_root_safety(rating: Rating, case: int | None = None) -> Figure:
    """Local safety against tooth breakage over fillet and face of both gears, and its smallest along the face of each.

    Parameters
    ----------
    rating : Rating
        Of a result with root stress.
    case : int, optional
        Index of the case; default: that of the smallest local safety, of a load spectrum the bin of the largest
        damage. Between analysed torques the places are those under the nearest one.

    Returns
    -------
    matplotlib.figure.Figure
        Of a load spectrum the title has the safety of all bins together, too.

    Raises
    ------
    InputError
        If the rating has no such case, or the case no places.
    NotAskedError
        If the scene does not ask for root stress.
    """
    case, why = worst_case(rating, "local_root_safety") if case is None else (case, "")
    both = [root_safeties(rating, case, gear) for gear in range(len(GEARS))]
    required = rating.required.required_safety(ROOT)
    scale, colours = _scale(np.concatenate([one.safety.ravel() for one in both]), required)
    figure = Figure(figsize=(11.0, 7.5), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.6, 1.0))
    maps = [figure.add_subplot(grid[0, column]) for column in range(2)]
    for axes, name, one in zip(maps, GEARS, both, strict=True):
        _draw_fillets(axes, one, scale, colours)
        axes.set_title(name, fontsize="medium")
        axes.set(xlabel="tangent angle [deg]: back of the tooth | side in contact", ylabel=_axial(name))
    figure.colorbar(ScalarMappable(scale, colours), ax=maps, label="local safety against breakage", extend="both")
    for column, (name, one) in enumerate(zip(GEARS, both, strict=True)):
        below: Axes = figure.add_subplot(grid[1, column])
        places, least = one.over_face()
        below.plot(places, np.where(np.isfinite(least), least, np.nan), color=GEAR_COLOURS[column])
        below.axhline(required, color="black", linestyle="--", label=f"required {plain(required)}")
        below.set(xlabel=_axial(name), ylabel="smallest over the fillets")
        below.set_ylim(0.0, float(scale.vmax or LARGEST))
        below.grid(alpha=0.3)
        below.legend(fontsize="small")
    style.set_title(
        figure,
        rating.result,
        f"local safety of the roots, {_load(rating, case)}",
        *_about(rating, case, LOCAL_ROOT, why),
    )
    return figure


def plot_safeties(rating: OfCases) -> Figure:
    """Safeties of the standard and local safeties of all gears beside the required ones, and the safeties of each case.

    Parameters
    ----------
    rating : Rating, StageRating or DoubleHelicalRating

    Returns
    -------
    matplotlib.figure.Figure
        A bar is the least safety of all torques, or the safety under all bins of a load spectrum together.
    """
    least = dict(zip(rating.modes, np.moveaxis(rating.safeties_and_lives()[0].min(axis=0), -1, 0), strict=True))
    names = [mode for mode in SAFETIES if mode in least and np.isfinite(least[mode]).any()]
    figure = Figure(figsize=(8.5, 1.8 + 0.75 * len(names)), layout="constrained")
    axes, step = figure.add_subplot(), 0.72 / len(rating.MEMBERS)
    for row, name in enumerate(names):
        required = rating.required.required_safety(name)
        for gear, member in enumerate(rating.MEMBERS):
            safety, values = float(least[name][gear]), rating.safety_alone(name)[:, gear]
            if not np.isfinite(safety):  # a rim thinner than the standard allows
                continue
            at, label = row + (gear - 0.5 * (len(rating.MEMBERS) - 1)) * step, member if row == 0 else ""
            axes.barh(at, safety, 0.94 * step, color=BAR_COLOURS[gear], label=label)
            values = values[np.isfinite(values)]
            axes.plot(values, np.full(len(values), at), "|", color="black", markersize=7.0)
            axes.text(0.0, at, f"  {plain(safety)}", va="center", fontsize="small", color="white", weight="bold")
        label = "required" if row == 0 else ""
        axes.plot([required, required], [row - 0.42, row + 0.42], color="black", linewidth=2.5, label=label)
    axes.set_yticks(range(len(names)), [SAFETIES[name].format(rating.standard) for name in names])
    axes.invert_yaxis()
    of_bins = "safety of all bins together; strokes: each bin alone"
    axes.set_xlabel(of_bins if isinstance(rating, OfSpectrum) else "safety, the least of all cases; strokes: each case")
    every = np.concatenate([rating.safety_alone(name).ravel() for name in names])
    axes.set_xlim(0.0, 1.15 * float(every[np.isfinite(every)].max()))
    axes.grid(axis="x", alpha=0.3)
    axes.set_axisbelow(True)
    about = "safeties beside those required", rating.scope
    return style.finished_under(figure, axes, rating.title, *about, columns=1 + len(rating.MEMBERS))


def _scale(safety: Array, required: float) -> tuple[Normalize, Colormap]:
    """Scale of colours from the required safety, or from a smaller least one on, and colours: below it an accent."""
    known = safety[np.isfinite(safety)]
    least = float(known.min()) if known.size else required
    colours = colormaps[f"{COLOURS}_r"].with_extremes(under=ACCENT)
    return Normalize(required, max(LARGEST * least, 1.5 * required)), colours


def _load(rating: Rating, case: int) -> str:
    """Torque of a case, with the number of its bin in a load spectrum, as notes and tables count them."""
    if not rating.inputs.cases.is_spectrum:
        return load(rating.result, torque_of(rating, case))
    return f"pinion torque {shown_torque(rating.torque[case])} (bin {case + 1} of {len(rating.torque)})"


def _about(rating: Rating, case: int, mode: str, why: str) -> tuple[str, ...]:
    """Lines on what is drawn, why of that case, and what all bins of a load spectrum do together."""
    required, torque = rating.required.required_safety(mode), float(rating.torque[case])
    analysed = float(rating.result.torque[torque_of(rating, case)])
    between = f"places as under {shown_torque(analysed)}, the nearest analysed torque; stresses interpolated"
    return (
        *filter(None, [why, _together(rating, mode)]),
        *([] if math.isclose(torque, analysed, rel_tol=ROUNDED) else [between]),
        f"required {plain(required)}, below it orange; the smallest of all positions",
        "cross: where it is smallest" + (" in this bin" if rating.inputs.cases.is_spectrum else ""),
    )


def _together(rating: Rating, mode: str) -> str:
    """Safety of all bins of a load spectrum together, of both gears; nothing without a spectrum."""
    if not isinstance(rating, OfSpectrum):
        return ""
    safeties = rating.safeties_and_lives()[0][0, :, rating.modes.index(mode)]
    both = " | ".join(f"{name} {plain(float(safety))}" for name, safety in zip(GEARS, safeties, strict=True))
    return f"safety of all bins together: {both}"


def _axial(gear: str) -> str:
    return f"axial position on the {gear} [mm]"


def _lines(places: FlankSafeties, gear: int, to_picture: ToPicture) -> Iterator[list[tuple[Array, Array]]]:
    """Contacts of each tooth pair at consecutive positions: places (k, 2) in the picture and safeties (k,)."""
    along = np.linspace(0.0, 1.0, 2 * FIELDS)
    for column in np.unique(places.column):
        lines: list[tuple[Array, Array]] = []
        before = 0
        for position in np.unique(places.position[places.column == column]):
            own = np.flatnonzero((places.column == column) & (places.position == position))
            ends = places.point[own[[0, -1]]] + np.array([[-1.0], [1.0]]) * places.tangent[own[[0, -1]]]
            points = to_picture(np.concatenate([ends[:1], places.point[own], ends[1:]]))
            values = places.safety[gear][own[[0, *range(len(own)), -1]]]
            at = np.linspace(0.0, 1.0, len(own) + 1)
            at = np.concatenate([at[:1], 0.5 * (at[1:] + at[:-1]), at[-1:]])
            line = np.stack([np.interp(along, at, part) for part in points.T], axis=-1), np.interp(along, at, values)
            if lines and position != before + 1:
                yield lines
                lines = []
            lines.append(line)
            before = position
        yield lines


def _least_seen(axes: Axes, places: FlankSafeties, gear: int, to_picture: ToPicture) -> tuple[Array, Array]:
    """Smallest safety that each place of a flank has, NaN where no contact passes, and borders of the fields.

    Between two positions a contact moves evenly from one place to the other, and its pressure changes evenly.
    """
    low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
    field, highest = (high - low) / FIELDS, np.zeros((FIELDS, FIELDS))
    for lines in _lines(places, gear, to_picture):
        for (start, safe), (end, safe_at_end) in pairwise([lines[0], *lines]):
            steps = 2 + int(POINTS_OF_A_FIELD * (np.abs(end - start) / field).max())
            part = np.linspace(0.0, 1.0, steps)
            moved = start + np.multiply.outer(part, end - start)
            stress = 1.0 / safe + np.multiply.outer(part, 1.0 / safe_at_end - 1.0 / safe)
            column, row = np.floor((moved.reshape(-1, 2) - low) / field).astype(int).T
            inside = (column >= 0) & (column < FIELDS) & (row >= 0) & (row < FIELDS)
            np.maximum.at(highest, (row[inside], column[inside]), stress.ravel()[inside])
    reached = highest > 0.0
    least = np.divide(1.0, highest, out=np.full(highest.shape, np.nan), where=reached)
    return np.linspace(low, high, FIELDS + 1).T, least


def _mark(axes: Axes, at: Array, value: float) -> None:
    """A cross with the number of the smallest safety."""
    axes.plot(*at, "x", color="black", markersize=8.0, markeredgewidth=2.0, zorder=10.0)
    text = axes.annotate(
        plain(value), (float(at[0]), float(at[1])), (7.0, 5.0), textcoords="offset points", zorder=10.0
    )
    text.set_path_effects([withStroke(linewidth=3.0, foreground="white")])


def _draw_fillets(axes: Axes, one: RootSafeties, scale: Normalize, colours: Colormap) -> None:
    """Both sides of a tooth, the back mirrored to the left; a field between nodes has the least of its four.

    Fields that nothing draws have the last colour of the scale, as all safe ones: infinite values would be white.
    """
    for side, sign in ((0, 1.0), (1, -1.0)):
        nodes = one.safety[side]
        fields = np.fmin.reduce([nodes[:-1, :-1], nodes[1:, :-1], nodes[:-1, 1:], nodes[1:, 1:]])
        fields = np.where(np.isposinf(fields), scale.vmax, fields)
        angle = sign * np.degrees(one.tangent_angle[side])
        axes.pcolormesh(angle, one.axial[side], fields, cmap=colours, norm=scale, rasterized=True)
    axes.axvspan(-10.0, 10.0, color=style.NO_MATERIAL)
    axes.text(0.0, 0.5, "tooth", transform=axes.get_xaxis_transform(), ha="center", va="center", rotation=90.0)
    at = one.deciding()
    x = (1.0, -1.0)[at[0]] * math.degrees(one.tangent_angle[at])
    _mark(axes, np.array([x, one.axial[at]]), float(one.safety[at]))


def _has_places(name: str, rating: OfCases) -> bool:
    """Whether a case of a pair has places with this safety."""
    return rating.has(name) and isinstance(rating, Rating) and bool(is_shown(rating).any())


SAFETY_PICTURES: dict[str, Picture[OfCases]] = {
    "safeties": Picture(
        "safeties of the standard and local safeties beside the required ones",
        "Smallest safety of each gear over all cases; under a load spectrum the safety of all bins together. "
        "Where the local safety is below the safety of the standard, the analysed contact carries its load less "
        "evenly than the standard assumes, or the local pressure lacks Z_eps.",
        plot_safeties,
        methodcaller("has", "flank_safety"),
    ),
    "flank_safety": Picture(
        "local safety against pitting over both flanks, in the case that decides",
        "The smallest safety that each place of the flanks has over the mesh cycle.",
        plot_flank_safety,
        partial(_has_places, "local_flank_safety"),
    ),
    "root_safety": Picture(
        "local safety against breakage over fillet and face of both gears, in the case that decides",
        "Safety with the extreme stresses of a whole turn at each place; below, its smallest values along the face of "
        "each gear.",
        plot_root_safety,
        partial(_has_places, "local_root_safety"),
    ),
}
"""Name -> picture of safeties that the command draws."""
