"""Local safeties over the flanks and the roots of both gears, and all safeties beside those required."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

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
from loaded_tca.plots.pressure_map import FIELDS, POINTS_OF_A_FIELD
from loaded_tca.plots.root_stress import GEAR_COLOURS
from loaded_tca.plots.style import ACCENT, COLOURS, load
from loaded_tca.rating.places import FlankSafeties, RootSafeties, flank_safeties, root_safeties, worst_case

if TYPE_CHECKING:
    from loaded_tca.rating import Rating

OF_SPECTRUM = "of all bins in the required life; strokes: each bin alone"
LARGEST = 2.5
"""Safety over the least one from which colours do not differ any more."""
SAFETIES = {
    "flank": "pitting, {}-2",
    "local_flank": "pitting, local",
    "root": "tooth breakage, {}-3",
    "local_root": "tooth breakage, local",
}
"""Kinds of failure of a rating, and what pictures call them after a standard."""


def plot_flank_safety(rating: Rating, case: int | None = None) -> Figure:
    """Smallest local safety against pitting that each place of both flanks has over the cycle, on one scale of colours.

    Parameters
    ----------
    rating : Rating
    case : int, optional
        Index of the case; default: that of the smallest local safety among torques that were solved.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the rating has no such case, or the case no places.
    """
    case = worst_case(rating, "local_flank_safety") if case is None else case
    places, required = flank_safeties(rating, case), _required(rating, "flank")
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
    style.set_title(figure, rating.result, f"local safety of the flanks, {_case(rating, case)}", *_about(required))
    return figure


def plot_root_safety(rating: Rating, case: int | None = None) -> Figure:
    """Local safety against tooth breakage over fillet and face of both gears, and its smallest over the face.

    Parameters
    ----------
    rating : Rating
        Of a result with root stress.
    case : int, optional
        Index of the case; default: that of the smallest local safety among torques that were solved.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the rating has no such case, or the case no places.
    NotAskedError
        If the scene does not ask for root stress.
    """
    case = worst_case(rating, "local_root_safety") if case is None else case
    both, required = [root_safeties(rating, case, gear) for gear in range(len(GEARS))], _required(rating, "root")
    scale, colours = _scale(np.concatenate([one.safety.ravel() for one in both]), required)
    figure = Figure(figsize=(11.0, 7.5), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.6, 1.0))
    maps = [figure.add_subplot(grid[0, column]) for column in range(2)]
    for axes, name, one in zip(maps, GEARS, both, strict=True):
        _draw_fillets(axes, one, scale, colours)
        axes.set_title(name, fontsize="medium")
        axes.set(xlabel="tangent angle [deg]: back of the tooth | side in contact", ylabel=_axial(name))
    figure.colorbar(ScalarMappable(scale, colours), ax=maps, label="local safety against breakage", extend="both")
    below: Axes = figure.add_subplot(grid[1, :])
    for name, one, colour in zip(GEARS, both, GEAR_COLOURS, strict=True):
        places, least = one.over_face()
        below.plot(places, np.where(np.isfinite(least), least, np.nan), color=colour, label=name)
    below.axhline(required, color="black", linestyle="--", label=f"required {plain(required)}")
    below.set(xlabel="axial position on each gear [mm]", ylabel="smallest over the fillets")
    below.set_ylim(0.0, float(scale.vmax or LARGEST))
    below.grid(alpha=0.3)
    below.legend(fontsize="small", ncols=3)
    style.set_title(figure, rating.result, f"local safety of the roots, {_case(rating, case)}", *_about(required))
    return figure


def plot_safeties(rating: Rating) -> Figure:
    """Safeties of the standard and local ones of both gears, in every case or of a spectrum, beside those required.

    Parameters
    ----------
    rating : Rating

    Returns
    -------
    matplotlib.figure.Figure
    """
    modes = [mode for mode in SAFETIES if mode in rating.modes and np.isfinite(rating.values(f"{mode}_safety")).any()]
    figure = Figure(figsize=(8.5, 1.8 + 0.75 * len(modes)), layout="constrained")
    axes, bars = figure.add_subplot(), rating.safeties_and_lives()[0]
    for row, mode in enumerate(modes):
        required = _required(rating, "root" if "root" in mode else "flank")
        for gear, colour in enumerate(GEAR_COLOURS):
            values = rating.values(f"{mode}_safety")[:, gear]
            values = values[np.isfinite(values)]
            if not values.size:  # a rim thinner than the standard allows
                continue
            at, least = row + (gear - 0.5) * 0.36, float(np.nanmin(bars[:, gear, rating.modes.index(mode)]))
            axes.barh(at, least, 0.34, color=colour, label=GEARS[gear] if row == 0 else "")
            axes.plot(values, np.full(len(values), at), "|", color="black", markersize=7.0)
            axes.text(0.0, at, f"  {plain(least)}", va="center", fontsize="small", color="white", weight="bold")
        label = "required" if row == 0 else ""
        axes.plot([required, required], [row - 0.42, row + 0.42], color="black", linewidth=2.5, label=label)
    axes.set_yticks(range(len(modes)), [SAFETIES[mode].format(rating.standard) for mode in modes])
    axes.invert_yaxis()
    of_bars = OF_SPECTRUM if rating.has("spectrum_safety") else "the least of all cases; strokes: each case"
    axes.set_xlabel(f"safety, {of_bars}")
    every = np.concatenate([rating.values(f"{mode}_safety").ravel() for mode in modes])
    axes.set_xlim(0.0, 1.15 * float(every[np.isfinite(every)].max()))
    axes.grid(axis="x", alpha=0.3)
    axes.set_axisbelow(True)
    return style.finished(figure, axes, rating.result, "safeties beside those required", rating.scope)


def _required(rating: Rating, kind: str) -> float:
    """Required safety of flanks or roots."""
    return float(getattr(rating.scene.rating, f"required_{kind}_safety"))


def _scale(safety: Array, required: float) -> tuple[Normalize, Colormap]:
    """Scale of colours from the required safety, or from a smaller least one on, and colours: below it an accent."""
    known = safety[np.isfinite(safety)]
    least = float(known.min()) if known.size else required
    colours = colormaps[f"{COLOURS}_r"].with_extremes(under=ACCENT)
    return Normalize(required, max(LARGEST * least, 1.5 * required)), colours


def _about(required: float) -> tuple[str, ...]:
    return (
        f"required {plain(required)}, below it orange; the smallest of all positions",
        "cross: where it is smallest",
    )


def _case(rating: Rating, case: int) -> str:
    torque = int(np.abs(rating.result.torque - rating.torque[case]).argmin())
    return load(rating.result, torque)


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
    """Both sides of a tooth, the back mirrored to the left; a field between nodes has the least of its four."""
    for side, sign in ((0, 1.0), (1, -1.0)):
        nodes = one.safety[side]
        fields = np.fmin.reduce([nodes[:-1, :-1], nodes[1:, :-1], nodes[:-1, 1:], nodes[1:, 1:]])
        angle = sign * np.degrees(one.tangent_angle[side])
        axes.pcolormesh(angle, one.axial[side], fields, cmap=colours, norm=scale, rasterized=True)
    axes.axvspan(-10.0, 10.0, color=style.NO_MATERIAL)
    axes.text(0.0, 0.5, "tooth", transform=axes.get_xaxis_transform(), ha="center", va="center", rotation=90.0)
    at = one.deciding()
    x = (1.0, -1.0)[at[0]] * math.degrees(one.tangent_angle[at])
    _mark(axes, np.array([x, one.axial[at]]), float(one.safety[at]))


class RatingPicture(NamedTuple):
    """A picture of a rating: its line of the help, its caption in reports, a number that it needs, what draws it.

    One of places is drawn where a case has these: a bin that is not reversed, of a torque that was solved.
    """

    line: str
    caption: str
    needs: str
    draw: Callable[[Rating], Figure]
    of_places: bool = False


SAFETY_PICTURES = {
    "safeties": RatingPicture(
        "safeties of the standard and local ones beside those required",
        "Of both gears the least of all cases, or that of the whole spectrum; where the local one is below that of the "
        "standard, the contact of the analysis carries its load less evenly than the standard assumes, or its pressure "
        "lacks Z_eps.",
        "flank_safety",
        plot_safeties,
    ),
    "flank_safety": RatingPicture(
        "local safety against pitting over both flanks, in the worst case",
        "The smallest safety that each place of the flanks has over the mesh cycle.",
        "local_flank_safety",
        plot_flank_safety,
        of_places=True,
    ),
    "root_safety": RatingPicture(
        "local safety against breakage over fillet and face of both gears, in the worst case",
        "With the extremes of a whole turn at each place, and below its smallest over the face.",
        "local_root_safety",
        plot_root_safety,
        of_places=True,
    ),
}
"""Name -> picture of safeties that the command draws."""
