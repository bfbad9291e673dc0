"""Pictures of a double helical pair: load over both halves side by side, shares, axial motion, transmission error."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.arrays import index_checks
from loaded_tca.double_helical import DoubleHelicalResult, DoubleHelicalRevolution
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.picture import Picture, captions_of, figures_of
from loaded_tca.plots.pressure_map import envelopes_of
from loaded_tca.plots.revolution import REVOLUTION_PICTURES
from loaded_tca.results.summary import shown_torque
from loaded_tca.scene.double_helical import HALVES, SIGNS

LEAST_um = 0.02
"""Least height of a panel of motions and errors."""


def _finished(figure: Figure, result: DoubleHelicalResult | DoubleHelicalRevolution, shown: str, *rest: str) -> Figure:
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize="small")
    style.write_title(figure, result.scene.title, shown, *rest)
    return figure


def plot_halves_face_load(result: DoubleHelicalResult, torque: int | None = None) -> Figure:
    """Load over the face of both halves, beside each other as they lie on the pinion: half b, the groove, half a.

    Normal force of all tooth pairs per width, the mean over a pitch, under the analysed torque of each half that is
    nearest to its mean share, scaled to that, where the floating gear stands under the torque.

    Parameters
    ----------
    result : DoubleHelicalResult
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = style.torque_or_largest(result.torque, torque)
    figure, axes = style.one_panel()
    scene, shares = result.scene, result.torque_share[torque].mean(axis=0)
    for half, (name, sign) in enumerate(zip(HALVES, SIGNS, strict=True)):
        load, borders = result.face_load[torque, half], result.face_border[torque, half]
        places, values = (borders, load) if sign > 0 else (-borders[::-1], load[::-1])
        factor = plain(result.face_load_factor[torque, half], 3)
        label = f"half {name}, share {plain(100.0 * shares[half], 3)} %, K_Hβ = {factor}"
        axes.stairs(values, places, color=style.DISTINCT_COLOURS[half], label=label, fill=True, alpha=0.5)
    groove = 0.5 * scene.geometry.gap_mm
    axes.axvspan(-groove, groove, color="0.85", label="groove")
    axes.set(xlabel="place along the pinion from the middle of its groove, half a to the right [mm]")
    axes.set_ylabel("normal force per face width [N/mm]")
    axes.set_ylim(bottom=0.0)
    return _finished(figure, result, f"load over both halves, pinion torque {shown_torque(result.torque[torque])}")


def _over_the_pitch(
    result: DoubleHelicalResult | DoubleHelicalRevolution, number: Callable[[int], np.ndarray], label: str, shown: str
) -> Figure:
    """Curves over the pinion angle, one for each torque."""
    figure, axes = style.one_panel()
    angle = np.degrees(result.pinion_angle)
    for torque, drawn in style.rising_torques(result.torque):
        axes.plot(angle, number(torque), **drawn)
    axes.set_ylabel(label)
    style.widen(axes, LEAST_um)
    axes.ticklabel_format(useOffset=False)
    return _finished(figure, result, shown)


def plot_halves_axial_motion(result: DoubleHelicalResult | DoubleHelicalRevolution) -> Figure:
    """Motion of the floating gear along its axis over a pitch, or over a whole revolution, under each torque.

    Parameters
    ----------
    result : DoubleHelicalResult or DoubleHelicalRevolution

    Returns
    -------
    matplotlib.figure.Figure
    """
    gear = result.scene.geometry.floating
    over = "a pitch" if isinstance(result, DoubleHelicalResult) else f"{result.pitches} pitches"
    label, shown = f"motion of the {gear} towards half a [µm]", f"axial motion of the {gear} over {over}"
    return _over_the_pitch(result, lambda torque: 1e3 * result.axial_motion[torque], label, shown)


def plot_halves_error(result: DoubleHelicalResult) -> Figure:
    """Transmission error of both halves together, less its mean, under each torque.

    Parameters
    ----------
    result : DoubleHelicalResult

    Returns
    -------
    matplotlib.figure.Figure
    """

    def error(torque: int) -> np.ndarray:
        values = result.um_per_rad * result.transmission_error[torque]
        return np.asarray(values - values.mean())

    return _over_the_pitch(
        result, error, "transmission error less its mean [µm]", "transmission error at the base circle of the wheel"
    )


def plot_half_envelope(result: DoubleHelicalResult, half: int, torque: int | None = None) -> Figure:
    """Highest pressure that each place of both flanks of a half sees over the cycle, the contact pattern under load.

    Under the analysed torque of the half that is nearest to its mean share, where the floating gear stands.

    Parameters
    ----------
    result : DoubleHelicalResult
    half : int
        0 for half a, 1 for half b.
    torque : int, optional
        Index of the torque of both halves; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such half or torque.
    """
    require(*index_checks(half=(half, len(HALVES))))
    torque = style.torque_or_largest(result.torque, torque)
    cycle = result.halves_by_place[result.place_of_torque[torque]][half]
    share = float(result.torque_share[torque].mean(axis=0)[half])
    nearest = int(np.abs(cycle.torque - share * result.torque[torque]).argmin())
    figure, _ = envelopes_of(cycle, [nearest])
    whole, carried = (shown_torque(part * float(result.torque[torque])) for part in (1.0, share))
    style.write_title(
        figure,
        result.scene.title,
        f"pressure envelope of half {HALVES[half]} under {shown_torque(cycle.torque[nearest])}",
        f"analysed torque of the half nearest to its mean share, {carried} of {whole}",
    )
    return figure


def plot_halves_shares(result: DoubleHelicalResult, torque: int | None = None) -> Figure:
    """Shares of both halves in the torque over a pitch.

    Parameters
    ----------
    result : DoubleHelicalResult
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = style.torque_or_largest(result.torque, torque)
    figure, axes = style.one_panel()
    for half, name in enumerate(HALVES):
        axes.plot(
            np.degrees(result.pinion_angle),
            100.0 * result.torque_share[torque, :, half],
            color=style.DISTINCT_COLOURS[half],
            marker=style.MARKERS[half],
            linewidth=2.6 - half,  # even shares lie on each other
            label=f"half {name}",
        )
    axes.set_ylabel("share of the torque [%]")
    style.widen(axes, 1.0)
    axes.ticklabel_format(useOffset=False)
    return _finished(figure, result, f"shares of the halves, pinion torque {shown_torque(result.torque[torque])}")


def _floats(result: DoubleHelicalResult | DoubleHelicalRevolution) -> bool:
    return result.scene.geometry.floating != "none"


def _carries(result: DoubleHelicalResult, half: int) -> bool:
    """Whether a half carries a part of the largest torque."""
    return bool(result.torque_share[style.torque_or_largest(result.torque, None)][:, half].max() > 0.0)


DOUBLE_HELICAL_PICTURES: dict[str, Picture[DoubleHelicalResult]] = {
    "halves_face_load": Picture(
        "load over both halves beside each other, under the largest torque; of two positions or more",
        "Normal force per face width along the pinion, mean over a pitch, under the largest torque.",
        plot_halves_face_load,
        lambda result: result.dataset.sizes["position"] > 1,
    ),
    **{
        f"half_envelope_{name}": Picture(
            f"highest pressure on both flanks of half {name} over the cycle, under its share of the largest torque",
            f"Contact pattern of half {name} under load: the highest pressure that each place of its flanks sees.",
            partial(plot_half_envelope, half=half),
            partial(_carries, half=half),
        )
        for half, name in enumerate(HALVES)
    },
    "halves_shares": Picture(
        "shares of both halves over the pitch, under the largest torque",
        "Equal shares if a gear floats freely; if both gears are held, the half with the smaller gap carries more.",
        plot_halves_shares,
    ),
    "halves_error": Picture(
        "transmission error of both halves together less its mean, all torques",
        "Excitation by both halves together; axial motion of a floating gear evens out how the halves differ.",
        plot_halves_error,
    ),
    "halves_axial_motion": Picture(
        "motion of the gear along its axis over the pitch, all torques; if a gear floats",
        "Mean: place where the axial forces balance. Span: shuttling with each tooth mesh.",
        plot_halves_axial_motion,
        _floats,
    ),
}
"""Pictures of ``loaded-tca run`` by the names of their files."""
DOUBLE_HELICAL_CAPTIONS = captions_of(DOUBLE_HELICAL_PICTURES)
"""How each picture is read, in reports."""


def double_helical_figures(result: DoubleHelicalResult) -> dict[str, Figure]:
    """Draw every picture that the result of a double helical pair has.

    Parameters
    ----------
    result : DoubleHelicalResult

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        By the names of ``DOUBLE_HELICAL_PICTURES``.
    """
    return figures_of(DOUBLE_HELICAL_PICTURES, result)


HALVES_REVOLUTION_PICTURES: dict[str, Picture[DoubleHelicalRevolution]] = {
    "halves_revolution_error": REVOLUTION_PICTURES["revolution_error"],
    "halves_revolution_spectrum": REVOLUTION_PICTURES["revolution_spectrum"],
    "halves_revolution_axial_motion": Picture(
        "motion of the gear along its axis over the revolution, all torques; if a gear floats",
        "How far apex runout and pitch deviations make the floating gear shuttle.",
        plot_halves_axial_motion,
        _floats,
    ),
}
"""Pictures of ``loaded-tca revolution`` of a double helical pair by the names of their files."""


def halves_revolution_figures(revolution: DoubleHelicalRevolution) -> dict[str, Figure]:
    """Draw every picture that a whole revolution of a double helical pair has.

    Parameters
    ----------
    revolution : DoubleHelicalRevolution

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        By the names of ``HALVES_REVOLUTION_PICTURES``.
    """
    return figures_of(HALVES_REVOLUTION_PICTURES, revolution)
