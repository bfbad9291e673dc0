"""Pictures of a planetary stage: phases, shares of the planets, K_gamma, motion of the sun, error and orders."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.picture import Picture, captions_of, figures_of
from loaded_tca.results.summary import shown_torque
from loaded_tca.stages import StageResult, rebalanced

SHARES_OF_ERRORS = 0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0
"""Pin errors of the picture of K_gamma, over those of the stage or, without any, over a hundredth of the module."""
LEAST_ORBIT = 0.5
"""Half the side of the picture of the sun's motion at the least [µm]."""
PLAIN = 0.01
"""Pin error of planet 0 over the module that is varied where the stage has none."""


def _title(figure: Figure, result: StageResult, shown: str, *rest: str) -> Figure:
    z_s, z_p, z_r = result.stage.teeth
    about = f"{len(result.planet)} planets, teeth {z_s}/{z_p}/{z_r}, the {result.stage.stage.driving} drives"
    style.write_title(figure, result.stage.title, shown, *rest, about)
    return figure


def _cycle(result: StageResult) -> Array:
    """Positions in mesh cycles of the sun, closed."""
    count = result.dataset.sizes["position"]
    return np.arange(count + 1) / count


def plot_stage_phases(result: StageResult) -> Figure:
    """Phases of the meshes of all planets, as pointers.

    Parameters
    ----------
    result : StageResult

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(8.0, 4.8), layout="constrained")
    panels = figure.subplots(1, 2, subplot_kw={"projection": "polar"})
    meshes = (("sun and planet", result.sun_mesh_phase), ("planet and ring", result.ring_mesh_phase))
    for axes, (name, phases) in zip(panels, meshes, strict=True):
        for planet, phase in enumerate(phases.tolist()):
            colour = style.DISTINCT_COLOURS[planet % len(style.DISTINCT_COLOURS)]
            length = 1.0 - 0.12 * planet
            axes.plot([0.0, 2.0 * np.pi * phase], [0.0, length], color=colour, linewidth=2.0, label=f"planet {planet}")
            axes.plot([2.0 * np.pi * phase], [length], "o", color=colour)
        axes.set_xticks(np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False), [f"{plain(k / 8, 6)}" for k in range(8)])
        axes.set_yticks([])
        axes.set_ylim(0.0, 1.1)
        axes.set_title(name, fontsize="medium")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=6, fontsize="small")
    return _title(figure, result, "phases of the meshes [mesh cycles]", "0: the pitch point where the sun stands at 0")


def plot_stage_shares(result: StageResult, torque: int | None = None) -> Figure:
    """Share of every planet over the mesh cycle.

    Parameters
    ----------
    result : StageResult
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = style.torque_or_largest(result.torque, torque)
    figure, axes = style.one_panel()
    shares = 100.0 * np.concatenate([result.planet_share[torque], result.planet_share[torque][:1]])
    for planet, share in enumerate(shares.T):
        colour = style.DISTINCT_COLOURS[planet % len(style.DISTINCT_COLOURS)]
        # The later ones thinner: planets with one share lie on each other.
        width = 1.2 + 1.6 * (len(result.planet) - 1 - planet)
        marker = style.MARKERS[planet % 8]
        axes.plot(_cycle(result), share, color=colour, marker=marker, linewidth=width, label=f"planet {planet}")
    axes.axhline(100.0 / len(result.planet), color="0.35", linestyle=":", label="even share")
    axes.set_xlabel("mesh cycle of the sun")
    axes.set_ylabel("share of the torque [%]")
    axes.margins(x=0.0)
    style.widen(axes, 1.0)
    axes.grid(alpha=0.3)
    figure.legend(loc="outside lower center", ncols=7, fontsize="small")
    factor = f"K_gamma = {plain(result.mesh_load_factor[torque])}"
    return _title(figure, result, f"shares of the planets, sun torque {shown_torque(result.torque[torque])}", factor)


def plot_stage_load_factor(result: StageResult) -> Figure:
    """Mesh load factor K_gamma over the pin errors, under each torque.

    Parameters
    ----------
    result : StageResult

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.one_panel()
    planets = len(result.planet)
    given = np.asarray(result.stage.stage.pin_tangential_um or np.zeros(planets))
    pins = given if given.any() else 1e3 * PLAIN * result.stage.geometry.normal_module_mm * np.eye(planets)[0]
    factors = np.array(
        [
            rebalanced(result, {"stage.pin_tangential_um": (part * pins).tolist()}).mesh_load_factor
            for part in SHARES_OF_ERRORS
        ]
    )
    amount = np.asarray(SHARES_OF_ERRORS) * np.abs(pins).max()
    for torque, drawn in style.rising_torques(result.torque, "sun"):
        axes.plot(amount, factors[:, torque], **drawn)
    axes.set_xlabel("largest tangential pin error [µm]")
    axes.set_ylabel("mesh load factor K_gamma")
    style.widen(axes, 0.01)
    axes.grid(alpha=0.3)
    figure.legend(loc="outside lower center", ncols=3, fontsize="small")
    what = "all pin errors of the stage in proportion" if given.any() else "planet 0 alone"
    return _title(figure, result, "mesh load factor over the pin errors", what)


def plot_stage_sun_orbit(result: StageResult) -> Figure:
    """Orbit of the sun's axis in the frame of the carrier, under each torque.

    Parameters
    ----------
    result : StageResult

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.one_panel(6.0)
    for torque, drawn in style.rising_torques(result.torque, "sun"):
        x, y = 1e3 * np.concatenate([result.sun_motion[torque], result.sun_motion[torque][:1]]).T
        axes.plot(x, y, markersize=4.0, **drawn)
    if not result.sun_motion.any():
        style.tell(axes, "the sun is held rigid")
    places = 1e3 * result.sun_motion.reshape(-1, 2)
    low, high = places.min(axis=0), places.max(axis=0)
    at_rest = bool((low <= 0.0).all() and (high >= 0.0).all())
    for planet, angle in enumerate(result.planet_angle.tolist()):
        axes.annotate(
            f"planet {planet}" if at_rest else f"towards planet {planet}",
            (0.5 + 0.35 * np.cos(angle), 0.5 + 0.43 * np.sin(angle)),
            xycoords="axes fraction",
            ha="center",
            va="center",
            fontsize="small",
            color="0.35",
        )
    axes.set_xlabel("x, towards the angle 0 of the carrier [µm]")
    axes.set_ylabel("y [µm]")
    half = max(0.8 * float((high - low).max()), LEAST_ORBIT)
    axes.set_xlim(*(0.5 * (low + high)[0] + np.array([-half, half])))
    axes.set_ylim(*(0.5 * (low + high)[1] + np.array([-half, half])))
    axes.set_aspect("equal")
    axes.ticklabel_format(useOffset=False)
    axes.grid(alpha=0.3)
    figure.legend(loc="outside lower center", ncols=3, fontsize="small")
    middle = 0.5 * (low + high)
    away = () if at_rest else (f"around ({plain(middle[0])}, {plain(middle[1])}) µm from the axis of the carrier",)
    return _title(figure, result, "motion of the sun's axis over a mesh cycle", *away)


def plot_stage_error(result: StageResult, torque: int | None = None) -> Figure:
    """Transmission error of the stage, and of one planet alone, each less its mean.

    Parameters
    ----------
    result : StageResult
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = style.torque_or_largest(result.torque, torque)
    figure, axes = style.one_panel()
    drawn = (
        ("stage", False, "o", style.DISTINCT_COLOURS[0]),
        ("one planet alone", True, "s", style.DISTINCT_COLOURS[1]),
    )
    for label, one_path, marker, colour in drawn:
        error = result.error_um(torque, one_path=one_path)
        error = np.append(error, error[:1]) - error.mean()
        axes.plot(_cycle(result), error, color=colour, marker=marker, label=label)
    axes.set_xlabel("mesh cycle of the sun")
    axes.set_ylabel("transmission error less its mean [µm]")
    axes.margins(x=0.0)
    style.widen(axes, 0.02)
    axes.grid(alpha=0.3)
    figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    shown = f"transmission error at the sun's base circle, sun torque {shown_torque(result.torque[torque])}"
    return _title(figure, result, shown)


def plot_stage_orders(result: StageResult, torque: int | None = None) -> Figure:
    """Orders of the mesh in the transmission error of the stage and of one planet alone.

    Parameters
    ----------
    result : StageResult
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = style.torque_or_largest(result.torque, torque)
    figure, axes = style.one_panel()
    orders = result.orders(torque)
    count = np.array([one.order for one in orders])
    axes.bar(count - 0.2, [one.stage for one in orders], 0.36, color=style.DISTINCT_COLOURS[0], label="stage")
    path = [one.one_path for one in orders]
    axes.bar(count + 0.2, path, 0.36, color=style.DISTINCT_COLOURS[1], hatch="//", label="one planet alone")
    names = [f"{one.order}\ncancels" if one.torsion_cancels else f"{one.order}" for one in orders]
    axes.set_xticks(count, names)
    axes.set_xlabel('order of the mesh; "cancels": between equal planets')
    axes.set_ylabel("amplitude [µm]")
    axes.grid(alpha=0.3, axis="y")
    figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    shown = (
        f"orders of the transmission error at the sun's base circle, sun torque {shown_torque(result.torque[torque])}"
    )
    return _title(figure, result, shown)


STAGE_PICTURES: dict[str, Picture[StageResult]] = {
    "stage_phases": Picture(
        "phases of the meshes of all planets",
        "Planets in phase have the same direction. Between both dials: how far the mesh of a planet with "
        "the ring is ahead of its mesh with the sun.",
        plot_stage_phases,
    ),
    "stage_shares": Picture(
        "share of every planet, under the largest torque",
        "Share of every planet in the torque of the sun; the largest over an even share is K_gamma.",
        plot_stage_shares,
    ),
    "stage_load_factor": Picture(
        "K_gamma over the pin errors, all torques",
        "K_gamma over growing pin errors. A K_gamma above 1 falls with the torque, since deflections grow and errors "
        "do not. With three planets about a floating sun K_gamma is 1 for all pin errors.",
        plot_stage_load_factor,
    ),
    "stage_sun_orbit": Picture(
        "motion of the sun's axis, all torques; if the sun is not held rigid",
        "Motion by which the sun evens out the shares, in the frame of the carrier.",
        plot_stage_sun_orbit,
        lambda result: bool(result.sun_motion.any()),
    ),
    "stage_error": Picture(
        "transmission error of the stage beside that of one planet, under the largest torque",
        "Where the phases cancel orders, all planets together excite less than one planet alone.",
        plot_stage_error,
    ),
    "stage_orders": Picture(
        "mesh orders of the transmission errors of the stage and of one planet",
        "Amplitudes of the stage and of one planet alone; unequal shares bring orders back that equal planets cancel.",
        plot_stage_orders,
    ),
}
"""Pictures of ``loaded-tca stage`` by the names of their files."""
STAGE_CAPTIONS = captions_of(STAGE_PICTURES)
"""How each picture is read, in reports."""


def stage_figures(result: StageResult) -> dict[str, Figure]:
    """Draw every picture of a stage, without the orbit of a sun that does not move.

    Parameters
    ----------
    result : StageResult

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        By the names of ``STAGE_PICTURES``.
    """
    return figures_of(STAGE_PICTURES, result)
