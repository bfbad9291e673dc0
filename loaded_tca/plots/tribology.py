"""Tribology: temperatures and films over the path of contact and over the flanks, sliding, losses."""

from __future__ import annotations

import math
from collections.abc import Iterable
from operator import methodcaller

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.flanks import ToPicture, both_flanks, draw_segments
from loaded_tca.plots.picture import Picture, figures_of
from loaded_tca.plots.sharing import OVER_THE_PATH, over_the_path
from loaded_tca.plots.style import ACCENT, COLOURS, DISTINCT_COLOURS, load, loads, range_of_positions, torque_styles
from loaded_tca.tribology import Tribology
from loaded_tca.tribology.quantities import COLUMNS

BINS = 60
"""Of the path of contact, in each of which the worst slice counts."""
FROM_T1 = "distance from T1 on the path of contact [mm]"


def plot_contact_temperature(tribology: Tribology, speed: int | None = None) -> Figure:
    """Contact temperature over the path of contact with the points A to E, and the bulk temperature, all torques.

    Of cylindrical gears each place of the path has the hottest slice there; of others each tooth pair at its angle.

    Parameters
    ----------
    tribology : Tribology
    speed : int, optional
        Index of the speed of a list; default: the highest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such speed.
    NotAskedError
        If the temperature lacks an input.
    """
    speed = _chosen(tribology, speed, fastest=True)
    figure, axes = _over_path(tribology, "contact_temperature", speed)
    bulk = _at(tribology, "bulk_temperature", speed)
    for torque, _, colour, _ in torque_styles(tribology.result):
        axes.axhline(bulk[torque], color=colour, linestyle="--", linewidth=1.0)
    axes.plot([], [], color="black", linestyle="--", linewidth=1.0, label="bulk temperature")
    axes.set_ylabel("contact temperature [°C]")
    return _finished(figure, axes, tribology, "contact temperature over the path of contact", speed)


def plot_film_ratio(tribology: Tribology, speed: int | None = None) -> Figure:
    """Film ratio over the path of contact with the points A to E, and the permissible film ratio, all torques.

    Parameters
    ----------
    tribology : Tribology
    speed : int, optional
        Index of the speed of a list; default: the lowest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such speed.
    NotAskedError
        If the film ratio lacks an input.
    """
    speed = _chosen(tribology, speed, fastest=False)
    figure, axes = _over_path(tribology, "film_ratio", speed)
    limit = tribology.conditions.permissible_film_ratio
    if limit is not None:
        axes.axhline(limit, color=ACCENT, linestyle="--", label="permissible film ratio")
    style.from_zero(axes)
    axes.set_ylabel("least film ratio λ")
    return _finished(figure, axes, tribology, "film ratio over the path of contact", speed)


def plot_over_flank(tribology: Tribology, name: str, torque: int | None = None, speed: int | None = None) -> Figure:
    """A number of all slices where they lie on both flanks, the worst on top.

    Parameters
    ----------
    tribology : Tribology
    name : str
        Of the columns of ``Tribology.slices``; of ``friction_power`` the power per length of the contact.
    torque : int, optional
        Index; default: the largest.
    speed : int, optional
        Index of the speed of a list; default: the lowest for films, else the highest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such name, torque or speed.
    NotAskedError
        If the number lacks an input.
    """
    result = tribology.result
    torque = style.chosen_torque(result, torque)
    thin = "film" in name
    speed = _chosen(tribology, speed, fastest=not thin)
    values, points, tangents = tribology.on_flanks(name, torque, speed)
    unit, label = COLUMNS[name][0], COLUMNS[name][1]
    if name == "friction_power":
        values, unit, label = values / (2.0 * np.linalg.norm(tangents, axis=1)), "W/mm", "friction power per length"
    order = np.argsort(-values if thin else values, kind="stable")
    known = order[np.isfinite(values[order])]
    segments = np.stack([points - tangents, points + tangents], axis=1)[known]
    low = float(values[known].min()) if known.size and thin else 0.0
    if name == "contact_temperature" and known.size:
        low = float(values[known].min())
    scale = Normalize(low, float(values[known].max()) if known.size else 1.0)
    colours = f"{COLOURS}_r" if thin else COLOURS

    def draw(axes: Axes, to_picture: ToPicture) -> list[Artist]:
        return [draw_segments(axes, to_picture(segments), values[known], scale, colours, 2.5)]

    figure, panels = both_flanks(result, draw)
    figure.colorbar(ScalarMappable(scale, colours), ax=panels, label=_labelled(label, unit))
    about = _speed_words(tribology, speed)
    style.set_title(figure, result, f"{label.split(',')[0]}, {load(result, torque)}", about, range_of_positions(result))
    return figure


def plot_sliding_velocities(tribology: Tribology, speed: int | None = None) -> Figure:
    """Rolling velocities of both gears and the sliding velocity over the path of contact, under the largest torque.

    Parameters
    ----------
    tribology : Tribology
    speed : int, optional
        Index of the speed of a list; default: the highest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such speed.
    NotAskedError
        Without a speed.
    """
    result, speed = tribology.result, _chosen(tribology, speed, fastest=True)
    torque, sliding = style.highest_torque(result), _at(tribology, "sliding_velocity", speed)
    figure, axes = style.one_panel()
    names = {
        "pinion_rolling_velocity": "rolling velocity of the pinion",
        "wheel_rolling_velocity": "rolling velocity of the wheel",
        "sliding_velocity": "sliding velocity",
    }
    if result.scene.path_points:
        table = tribology.slices(torque, speed)
        order = np.argsort(table["roll_length"].to_numpy(), kind="stable")
        for (name, label), colour in zip(names.items(), DISTINCT_COLOURS, strict=False):
            places, velocity = (table[column].to_numpy()[order] for column in ("roll_length", name))
            axes.plot(places, velocity, ".", color=colour, markersize=3.0, label=label)
        _mark_letters(axes, tribology)
        axes.set_xlabel(FROM_T1)
    else:
        rolling, sliding = _at(tribology, "rolling_velocity", speed)[torque], sliding[torque]
        for values, label, colour in zip(
            (rolling[..., 0], rolling[..., 1], sliding), names.values(), DISTINCT_COLOURS, strict=False
        ):
            places, curve = over_the_path(result, values)
            known = np.isfinite(curve)
            axes.plot(np.degrees(places[known]), curve[known], color=colour, label=label)
        axes.set_xlabel(f"{OVER_THE_PATH} [deg]")
    at = "" if result.scene.path_points else "where the pair slides most, "
    axes.set_ylabel(f"{at}velocity [m/s]")
    style.from_zero(axes)
    return _finished(figure, axes, tribology, "rolling and sliding velocities", speed, load(result, torque))


def plot_efficiency(tribology: Tribology) -> Figure:
    """Efficiency of the mesh over the speed, all torques; of one speed over the torque.

    Parameters
    ----------
    tribology : Tribology

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    NotAskedError
        If the efficiency lacks an input.
    """
    result, efficiency = tribology.result, 100.0 * np.atleast_2d(tribology.efficiency)
    figure, axes = style.one_panel()
    speeds = tribology.conditions.speeds
    if len(speeds) > 1:
        order = np.argsort(speeds)
        for torque, label, colour, marker in torque_styles(result):
            axes.plot(
                speeds[order], efficiency[order, torque], color=colour, marker=marker, markersize=5.0, label=label
            )
        axes.set_xlabel("speed of the pinion [1/min]")
    else:
        order = np.argsort(result.torque)
        axes.plot(1e-3 * result.torque[order], efficiency[0, order], marker="o", color=DISTINCT_COLOURS[0])
        axes.set_xlabel("pinion torque [N m]")
    axes.set_ylabel("efficiency of the mesh [%]")
    style.widen(axes, 0.02)
    axes.ticklabel_format(axis="y", useOffset=False)
    return _finished(figure, axes, tribology, f"efficiency, {loads(result)}", None, "friction of the teeth alone")


def plot_friction_power(tribology: Tribology, speed: int | None = None) -> Figure:
    """Friction power of all tooth pairs over the pitch, all torques.

    Parameters
    ----------
    tribology : Tribology
    speed : int, optional
        Index of the speed of a list; default: the highest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such speed.
    NotAskedError
        If the power lacks an input.
    """
    result, speed = tribology.result, _chosen(tribology, speed, fastest=True)
    figure, axes = style.one_panel()
    power = _at(tribology, "friction_power", speed)
    for torque, label, colour, marker in torque_styles(result):
        axes.plot(
            np.degrees(result.pinion_angle), power[torque], color=colour, marker=marker, markersize=5.0, label=label
        )
    style.from_zero(axes)
    axes.set_ylabel("friction power [W]")
    return _finished(figure, axes, tribology, f"friction power, {loads(result)}", speed)


def tribology_figures(tribology: Tribology) -> dict[str, Figure]:
    """Draw every picture of a tribology that has its inputs.

    Parameters
    ----------
    tribology : Tribology

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        By the names of ``TRIBOLOGY_PICTURES``.
    """
    return figures_of(TRIBOLOGY_PICTURES, tribology)


def _chosen(tribology: Tribology, speed: int | None, *, fastest: bool) -> int:
    """Index of a speed: the given one, or the highest or lowest."""
    speeds = tribology.conditions.speeds
    if speed is None:
        return int(np.argmax(speeds) if fastest else np.argmin(speeds))
    tribology.check(0, speed)
    return speed


def _at(tribology: Tribology, name: str, speed: int) -> Array:
    """A number of the tribology at one speed."""
    return tribology.with_speeds(name)[speed]


def _over_path(tribology: Tribology, name: str, speed: int) -> tuple[Figure, Axes]:
    """A panel with the worst of a number over the path of contact, under all torques."""
    result = tribology.result
    figure, axes = style.one_panel(5.5)
    values = _at(tribology, name, speed)
    for torque, label, colour, marker in torque_styles(result):
        if result.scene.path_points:
            places, curve = _worst_on_path(tribology, name, torque, speed)
        else:
            angles, curve = over_the_path(result, values[torque])
            places = np.degrees(angles)
        known = np.isfinite(curve)
        axes.plot(places[known], curve[known], color=colour, marker=marker, markersize=3.0, label=label)
    if result.scene.path_points:
        _mark_letters(axes, tribology)
        axes.set_xlabel(FROM_T1)
    else:
        axes.set_xlabel(f"{OVER_THE_PATH} [deg]")
    return figure, axes


def _worst_on_path(tribology: Tribology, name: str, torque: int, speed: int) -> tuple[Array, Array]:
    """Places on the path of contact [mm], and the worst slice of each."""
    table = tribology.slices(torque, speed)
    lengths, values = table["roll_length"].to_numpy(), table[name].to_numpy()
    if not lengths.size:
        return lengths, values
    edges = np.linspace(lengths.min(), lengths.max(), BINS + 1)
    bins = np.clip(np.searchsorted(edges, lengths, "right") - 1, 0, BINS - 1)
    worst, middle, count = np.full(BINS, math.nan), np.zeros(BINS), np.zeros(BINS)
    (np.fmin if "film" in name else np.fmax).at(worst, bins, values)
    np.add.at(middle, bins, lengths)
    np.add.at(count, bins, 1.0)
    return middle / np.maximum(count, 1.0), worst


def _mark_letters(axes: Axes, tribology: Tribology) -> None:
    """Dotted lines at the points A to E after ISO 21771."""
    for letter, length in tribology.result.scene.path_points.items():
        axes.axvline(length, color="0.5", linestyle=":", linewidth=1.0, zorder=0.0)
        axes.annotate(letter, (length, 1.0), xycoords=("data", "axes fraction"), ha="center", va="bottom", color="0.4")


def _finished(figure: Figure, axes: Axes, tribology: Tribology, shown: str, speed: int | None, *about: str) -> Figure:
    """The figure with its legend and title; the speed of one of several in the note."""
    words: Iterable[str] = () if speed is None else (_speed_words(tribology, speed),)
    return style.finished(figure, axes, tribology.result, shown, *words, *about, columns=2)


def _speed_words(tribology: Tribology, speed: int) -> str:
    """Speed and oil in words; nothing of those that are not given."""
    given = tribology.conditions
    rpm = given.speeds[speed]
    words = [] if math.isnan(rpm) else [f"pinion at {plain(rpm, 6)} 1/min"]
    if given.lubricant is not None:
        words.append(f"{given.lubricant.base} oil at {plain(given.lubricant.oil_temperature, 6)} °C")
    return ", ".join(words)


def _labelled(label: str, unit: str) -> str:
    """Label of a colour bar."""
    unit = unit.replace("um", "µm")
    return label if unit == "1" else f"{label} [{unit}]"


TRIBOLOGY_PICTURES: dict[str, Picture[Tribology]] = {
    "contact_temperature": Picture(
        "contact temperature over the path of contact, bulk temperature, all torques",
        "The hottest slice at each place of the path of contact; dashed: bulk temperature.",
        plot_contact_temperature,
        methodcaller("knows", "contact_temperature"),
    ),
    "film_ratio": Picture(
        "least film ratio over the path of contact with its limit, all torques",
        "Film thickness over the mean roughness, the least at each place of the path of contact.",
        plot_film_ratio,
        methodcaller("knows", "film_ratio"),
    ),
    "flank_flash_temperature": Picture(
        "flash temperature on both flanks, under the largest torque",
        "Flash temperature of the slices of all positions, where they lie on the flanks.",
        lambda one: plot_over_flank(one, "flash_temperature"),
        methodcaller("knows", "flash_temperature"),
    ),
    "flank_film_thickness": Picture(
        "film thickness on both flanks, under the largest torque",
        "Film thickness of the slices of all positions, the thinnest on top.",
        lambda one: plot_over_flank(one, "film_thickness"),
        methodcaller("knows", "film_thickness"),
    ),
    "flank_friction_power": Picture(
        "friction power on both flanks, under the largest torque",
        "Friction power per length of the contacts of all positions.",
        lambda one: plot_over_flank(one, "friction_power"),
        methodcaller("knows", "friction_power"),
    ),
    "sliding_velocities": Picture(
        "rolling velocities of both gears and sliding velocity over the path of contact",
        "Velocities of both surfaces across the contact; they are equal at the pitch point.",
        plot_sliding_velocities,
        methodcaller("knows", "sliding_velocity"),
    ),
    "efficiency": Picture(
        "efficiency of the mesh over speed and torque",
        "1 minus the ratio of the friction power of the teeth to the power at the pinion.",
        plot_efficiency,
        methodcaller("knows", "efficiency"),
    ),
    "friction_power": Picture(
        "friction power over the pitch, all torques",
        "Friction power of all tooth pairs together over the positions.",
        plot_friction_power,
        methodcaller("knows", "friction_power"),
    ),
}
"""Name -> picture of a tribology that the command draws."""
