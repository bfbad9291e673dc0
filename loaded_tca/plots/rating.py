"""Ratings: S-N curves with the load cases on them, and the damage that each of these does."""

from __future__ import annotations

from collections.abc import Sequence
from operator import methodcaller

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from loaded_tca.arrays import Array
from loaded_tca.double_helical.rating import DoubleHelicalRating
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.picture import Picture, figures_of
from loaded_tca.plots.safety import SAFETY_PICTURES, plot_safeties
from loaded_tca.plots.style import DISTINCT_COLOURS, NO_MATERIAL
from loaded_tca.rating.lives import Endurance
from loaded_tca.rating.rating import WORDS, OfCases
from loaded_tca.rating.spectrum import OfSpectrum
from loaded_tca.scene.double_helical import HALVES

SHOWN_CYCLES = 1e2, 1e11
"""Of the axis of load cycles, at least."""
MOST_BARS = 40
"""Of a panel of damage: bins of more torques are put together in equal steps of torque."""
LEAST_BAR, OF_ONE_DECADE = 1e-6, 0.1
"""Of the largest damage: what is drawn of smaller ones, and from where on down bars need a logarithmic axis."""
FEWEST_CYCLES = 1.0
GEAR_STYLES = (
    (DISTINCT_COLOURS[0], "o", "-", ""),
    (DISTINCT_COLOURS[1], "s", "--", "///"),
    (DISTINCT_COLOURS[5], "^", ":", "..."),
)
"""Colour, marker, line and hatch of each gear."""
PANEL = 3.6
"""Height [inch]."""


def plot_sn_curves(rating: OfCases) -> Figure:
    """S-N curves of all gears with the load cases at their load cycles and stresses times the required safety.

    Curves that differ from case to case, by the velocity factor or by Y_M of reversed bins, are those of the case of
    the largest damage. The other stresses are scaled by the strength of that curve over their own one at their load
    cycles, as the axis then says: so all lie above or below the curve as they use up more or less than the life.

    Parameters
    ----------
    rating : Rating or StageRating

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, panels = _panels(rating)
    for (mode, of_gears), axes in zip(rating.endurances.items(), panels, strict=True):
        for place, endurance in enumerate(of_gears):
            _draw_curve(axes, endurance, rating.MEMBERS[place], place)
        scaled = (
            "" if all(endurance.has_one_curve for endurance in of_gears) else "\nscaled to the strength of the curve"
        )
        axes.set(xscale="log", yscale="log", ylabel=f"stress · required safety [MPa]{scaled}", xlabel="load cycles [-]")
        _finish(axes, WORDS[mode])
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter(lambda value, _: plain(value))
        axes.yaxis.set_minor_formatter(NullFormatter())
    return _finished(figure, panels, rating, f"S-N curves with {_cases(rating)}")


def plot_damage(rating: OfCases) -> Figure:
    """Damage of the load cases over their torques, of all gears, a panel for each kind of failure.

    Parameters
    ----------
    rating : Rating or StageRating

    Returns
    -------
    matplotlib.figure.Figure
        Of a spectrum of more than 40 torques, bins stand together in 40 equal steps of torque. Where damages of a kind
        of failure differ by more than a decade, the axes of all panels with damage are logarithmic, each down to a
        millionth of its largest.
    """
    figure, panels = _panels(rating)
    drawn: list[Array] = []
    for n, (mode, axes) in enumerate(zip(rating.modes, panels, strict=True)):
        places, width, damage = _bars(rating, rating.damage[:, :, n])
        step = 0.9 * width / len(rating.MEMBERS)
        for k, gear in enumerate(rating.MEMBERS):
            colour, *_, hatch = GEAR_STYLES[k]
            shown = np.where(np.isfinite(damage[:, k]), damage[:, k], 0.0)
            offset = (k - 0.5 * (len(rating.MEMBERS) - 1)) * step
            axes.bar(places + offset, shown, 0.93 * step, color=colour, label=gear, hatch=hatch, edgecolor="white")
            broken = places[np.isinf(damage[:, k])] + offset
            if broken.size:
                top = axes.get_xaxis_transform()
                label = f"{gear}: above the static strength"
                axes.plot(broken, np.full(broken.size, 0.97), "v", color=colour, transform=top, label=label)
        label = rating.NUMBERS["torque"].label
        if len(places) == 1:  # bars beside it would be at torques of their own
            axes.set_xticks(places, [plain(places[0], 6)])
        axes.set(xlabel=f"{label} [N m]", ylabel=f"damage in {plain(rating.life_required, 6)} h [-]")
        drawn.append(damage[np.isfinite(damage)])
        if not (damage > 0.0).any():
            style.tell(axes, "no damage: stresses below the end of the curve")
        _finish(axes, WORDS[mode])
    _scale(panels, drawn)
    several = isinstance(rating, OfSpectrum)
    what = f"damage of {_cases(rating)}" if several else "damage under each torque alone"
    return _finished(figure, panels, rating, what)


def _cases(rating: OfCases) -> str:
    """How many bins or torques a rating has, in words."""
    kind = "bin" if isinstance(rating, OfSpectrum) else "torque"
    return f"{len(rating.torque)} {kind}{'s' * (len(rating.torque) > 1)}"


def _scale(panels: Sequence[Axes], damages: Sequence[Array]) -> None:
    """Axes of one kind, on which bars of all sizes can be read, but for those that are nothing beside the largest."""
    largest = [float(damage.max(initial=0.0)) for damage in damages]
    least = [
        float(damage[damage > LEAST_BAR * most].min(initial=most))
        for damage, most in zip(damages, largest, strict=True)
    ]
    is_wide = any(0.0 < low <= OF_ONE_DECADE * high for low, high in zip(least, largest, strict=True))
    for axes, low, high in zip(panels, least, largest, strict=True):
        if not is_wide or high == 0.0:
            axes.set_ylim(bottom=0.0)
        else:
            axes.set_yscale("log")
            axes.set_ylim(0.5 * low, 2.0 * high)


def _panels(rating: OfCases) -> tuple[Figure, list[Axes]]:
    """A figure with a panel for each kind of failure."""
    count = len(rating.modes)
    rows = -(-count // 2)
    figure = Figure(figsize=(9.6, PANEL * rows), layout="constrained")
    panels = np.ravel(figure.subplots(rows, 2)).tolist()
    for axes in panels[count:]:
        axes.set_visible(False)
    return figure, panels[:count]


def _draw_curve(axes: Axes, endurance: Endurance, gear: str, place: int) -> None:
    """The curve of a gear, and its load cases."""
    colour, marker, line, _ = GEAR_STYLES[place]
    curve = endurance.worst_curve()
    ends = min(SHOWN_CYCLES[0], curve.cycles[0]), max(SHOWN_CYCLES[1], curve.cycles[-1])
    cycles = np.array([ends[0], *curve.cycles, ends[1]])
    axes.plot(cycles, curve.strength(cycles), line, color=colour, label=gear)
    loading = (endurance.stress > 0.0) & (endurance.cycles >= FEWEST_CYCLES)
    stress = endurance.stress_at(curve)[loading]
    size = 5.0 if loading.sum() <= MOST_BARS else 2.5
    axes.plot(
        endurance.cycles[loading], stress, marker, color=colour, markersize=size, alpha=0.7, label=f"{gear}: load"
    )


def _bars(rating: OfCases, damage: Array) -> tuple[Array, float, Array]:
    """Places and width [N m] of bars, and the damage (bar, gear) of the cases (c, gear) that each of them has."""
    torque = 1e-3 * rating.torque
    distinct, which = np.unique(torque, return_inverse=True)
    if len(distinct) <= MOST_BARS:
        places, width = distinct, float(np.diff(distinct).min()) if len(distinct) > 1 else max(1.0, 0.1 * distinct[0])
    else:
        edges = np.linspace(0.0, torque.max(), MOST_BARS + 1)
        places, width = 0.5 * (edges[1:] + edges[:-1]), float(edges[1])
        which = np.clip(np.searchsorted(edges, torque, "left") - 1, 0, MOST_BARS - 1)
    together = np.zeros((len(places), damage.shape[1]))
    np.add.at(together, which, np.nan_to_num(damage, nan=0.0, posinf=np.inf))
    return places, width, together


def _finish(axes: Axes, title: str) -> None:
    axes.set_title(title, fontsize="medium")
    axes.grid(color=NO_MATERIAL, linewidth=0.5)
    axes.set_axisbelow(True)


def _finished(figure: Figure, panels: list[Axes], rating: OfCases, what: str) -> Figure:
    """Return the figure with one legend of all panels, and its title."""
    keys = {label: key for axes in panels for key, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    figure.legend(keys.values(), keys.keys(), loc="outside lower center", ncols=4, fontsize="small")
    style.write_title(figure, rating.title, what, rating.scope.rpartition("; ")[0])
    return figure


RATING_PICTURES: dict[str, Picture[OfCases]] = {
    **SAFETY_PICTURES,
    "rating_sn_curves": Picture(
        "S-N curves with the load cases on them, a panel for each kind of failure",
        "S-N curves after ISO 6336-6 of all gears, with each load case at its load cycles in the required life and at "
        "its stress times the required safety: points above their curve use up more than the life. Where the strength "
        "differs from case to case, stresses are scaled to the strength of the curve.",
        plot_sn_curves,
        methodcaller("has", "damage"),
    ),
    "rating_damage": Picture(
        "damage of the load cases over their torques",
        "Damage of each load case in the required life at the required safeties. Under a load spectrum "
        "the damages add up, and 1 is the end of the life; without a load spectrum each torque stands for itself.",
        plot_damage,
        methodcaller("has", "damage"),
    ),
}
"""Pictures of the command, by the names of their files."""


def _of_half(name: str, picture: Picture[OfCases]) -> Picture[DoubleHelicalRating]:
    """A picture of the rating of one half of a double helical pair, which has it where the half is rated."""
    return Picture(
        f"half {name}: {picture.line}",
        f"Half {name}: {picture.caption}",
        lambda rating: picture.draw(rating.of_halves[name]),
        lambda rating: name in rating.of_halves and picture.has(rating.of_halves[name]),
    )


HALVES_RATING_PICTURES: dict[str, Picture[DoubleHelicalRating]] = {
    "safeties": Picture(
        "the smaller safeties of both halves beside the required ones",
        "Smallest safety of each gear over both halves and all cases; under a load spectrum the smaller safety of all "
        "bins together. Below: the safeties of each half.",
        plot_safeties,
    ),
    **{f"half_{name}_{file}": _of_half(name, picture) for name in HALVES for file, picture in RATING_PICTURES.items()},
}
"""The same of a double helical pair: the smaller safeties, and all pictures of each half under its share."""


def rating_figures(rating: OfCases) -> dict[str, Figure]:
    """Draw every picture that a rating has.

    Parameters
    ----------
    rating : Rating, StageRating or DoubleHelicalRating

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        By the names of ``RATING_PICTURES``; those of places where a case of a pair has these. Of a double helical pair
        by the names of ``HALVES_RATING_PICTURES``, those of each half that carries load.
    """
    if isinstance(rating, DoubleHelicalRating):
        return figures_of(HALVES_RATING_PICTURES, rating)
    return figures_of(RATING_PICTURES, rating)
