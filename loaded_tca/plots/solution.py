"""The pressure between two half-spaces on its grid, without gears."""

from __future__ import annotations

import math

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from loaded_tca.arrays import Array
from loaded_tca.contact import ContactSolution
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.plots.pressure_map import PRESSURE, scale_factor
from loaded_tca.plots.style import ACCENT, COLOURS, NO_LOAD, NO_MATERIAL, from_zero, tell
from loaded_tca.reference.hertz import LineContact, PointContact

FINE = 400
"""Points of the curves after Hertz."""
ALIKE = 2.5
"""Ratio of the sides of a grid up to which it is drawn in one scale."""
HEIGHT = 1.5
"""Height of the map of a longer grid over that of maps across pictures, which have less room for it."""
ROUND = 0.01
"""Relative difference of the second moments of a pressure up to which the contact has no direction of its own."""
LEVEL_deg = 0.5
"""Angle between contact and grid from which it is written."""


def plot_solution(solution: ContactSolution, hertz: PointContact | LineContact | None = None) -> Figure:
    """Pressure of a contact solution: a map of the grid, and its sections through the centre of force.

    Places count from the middle of the grid; white lines on the map are those of the sections. Cells without material
    are grey, without pressure white; of cells smaller than a dot of the picture the colours are averaged.

    Parameters
    ----------
    solution : ContactSolution
        Of :func:`loaded_tca.solve_contact` or :func:`loaded_tca.contact.solve_problem`.
    hertz : PointContact or LineContact, optional
        Drawn beside it where the solution lies: its middle is the centre of force, its axes are those of the second
        moments of the pressure, the minor one with the smaller moment. The axis across a line contact is that which is
        closer to the first axis of the grid.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If ``hertz`` is none of these.

    Examples
    --------
    >>> from loaded_tca import solve_contact
    >>> from loaded_tca.reference.hertz import point_contact_gap
    >>> gap, spacing = point_contact_gap((10.0, 10.0), (0.8, 0.8), (32, 32))
    >>> figure = plot_solution(solve_contact(gap, spacing, 115385.0, load=100.0))
    >>> [axes.get_xlabel() for axes in figure.axes][1:3]
    ['first axis [mm]', 'second axis [mm]']
    """
    known = hertz is None or isinstance(hertz, PointContact | LineContact)
    require((known, f"hertz: {hertz!r:.60} is neither a PointContact nor a LineContact of reference.hertz"))
    pressure, steps = solution.pressure, solution.spacing
    x, y = ((np.arange(count) - 0.5 * (count - 1)) * step for count, step in zip(pressure.shape, steps, strict=True))
    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    panels = figure.subplots(1, 3, width_ratios=(1.2, 1.0, 1.0))
    _draw_map(panels[0], solution)
    centre, angle = _centre_and_angle(pressure, x, y, isinstance(hertz, LineContact))
    row, column = _line_through(pressure, x, centre[0]), _line_through(pressure.T, y, centre[1])
    if pressure.any():
        panels[0].axhline(x[row], color="white", linewidth=0.6)
        panels[0].axvline(y[column], color="white", linewidth=0.6)
    fine_x, fine_y = (np.linspace(place[0], place[-1], FINE) for place in (x, y))
    for axes, place, section, fine, points, name, other, at in (
        (panels[1], x, pressure[:, column], fine_x, (fine_x, y[column]), "first", "second", y[column]),
        (panels[2], y, pressure[row], fine_y, (x[row], fine_y), "second", "first", x[row]),
    ):
        axes.plot(place, section, "o-", markersize=3.0, linewidth=0.8, color="black", label="solution")
        if hertz is not None:
            curve = _after_hertz(hertz, points[0] - centre[0], points[1] - centre[1], angle)
            axes.plot(fine, curve, color=ACCENT, label=_words(hertz, angle))
        axes.set_title(f"at {plain(at, 3)} mm of the {other} axis", fontsize="small")
        axes.set(xlabel=f"{name} axis [mm]", ylabel=PRESSURE)
        from_zero(axes)
        axes.grid(alpha=0.3)
    if isinstance(hertz, PointContact):
        size, turned = (2.0 * hertz.semi_major, 2.0 * hertz.semi_minor), -math.degrees(angle)
        outline = Ellipse((centre[1], centre[0]), *size, angle=turned, fill=False, color=ACCENT, linestyle="--")
        panels[0].add_patch(outline)
    if hertz is not None:
        figure.legend(*panels[1].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize="small")
    figure.suptitle(
        f"peak pressure {plain(solution.peak_pressure, 5)} MPa, load {plain(solution.load, 5)} N, "
        f"approach {plain(solution.approach, 5)} mm; {pressure.shape[0]} x {pressure.shape[1]} cells",
        fontsize="medium",
    )
    return figure


def _draw_map(axes: Axes, solution: ContactSolution) -> None:
    """Colours of the cells, the second axis of the grid to the right; dots of the picture average them."""
    pressure, norm = solution.pressure, Normalize(0.0, float(solution.pressure.max()) or 1.0)
    colours = colormaps[COLOURS](norm(pressure))
    colours[pressure == 0.0] = to_rgba("white")
    colours[np.isinf(solution.gap)] = to_rgba(NO_MATERIAL)
    height, width = (count * step for count, step in zip(pressure.shape, solution.spacing, strict=True))
    alike = max(height, width) <= ALIKE * min(height, width)
    scale = 1.0 if alike else scale_factor(HEIGHT * width, height)[0]
    larger = f" (drawn {plain(scale, 6)} times larger)" if scale != 1.0 else ""
    extent = (-0.5 * width, 0.5 * width, -0.5 * height, 0.5 * height)
    axes.imshow(colours, extent=extent, origin="lower", aspect=scale, interpolation="antialiased")
    axes.set(xlabel="second axis [mm]", ylabel=f"first axis [mm]{larger}")
    if not pressure.any():
        tell(axes, NO_LOAD)
        return
    assert axes.figure is not None
    axes.figure.colorbar(ScalarMappable(norm, COLOURS), ax=axes)
    axes.set_title(PRESSURE, fontsize="small")


def _centre_and_angle(pressure: Array, x: Array, y: Array, line: bool) -> tuple[tuple[float, float], float]:
    """Centre of force [mm], and the angle [rad] from the first axis to the minor axis of the pressure, to the second.

    The axis across a line is within 45 degrees of the first axis: where the grid cuts the line short, the moments along
    it may be the smaller ones.
    """
    force = float(pressure.sum())
    if force == 0.0:
        return (0.0, 0.0), 0.0
    by_x, by_y = pressure.sum(axis=1) / force, pressure.sum(axis=0) / force
    centre = float(by_x @ x), float(by_y @ y)
    xx, yy = float(by_x @ (x - centre[0]) ** 2), float(by_y @ (y - centre[1]) ** 2)
    xy = float((x - centre[0]) @ pressure @ (y - centre[1])) / force
    if math.hypot(xx - yy, 2.0 * xy) <= ROUND * (xx + yy):
        return centre, 0.0
    angle = 0.5 * math.atan2(-2.0 * xy, yy - xx)
    if line and abs(angle) > 0.25 * math.pi:
        angle -= math.copysign(0.5 * math.pi, angle)
    return centre, angle


def _line_through(pressure: Array, places: Array, at: float) -> int:
    """Index of the row under pressure that is closest to a place; of the closest row where none has pressure."""
    pressed = pressure.any(axis=1)
    return int(np.where(pressed | ~pressed.any(), np.abs(places - at), np.inf).argmin())


def _after_hertz(hertz: PointContact | LineContact, x: Array | float, y: Array | float, angle: float) -> Array:
    """Pressure of a turned contact at places [mm] of the axes of the grid, from the middle of the contact."""
    across, along = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
    return hertz.pressure(across) if isinstance(hertz, LineContact) else hertz.pressure(across, along)


def _words(hertz: PointContact | LineContact, angle: float) -> str:
    """Label of the curves: peak, and the angle under which the contact lies where it is not in line with the grid."""
    peak, degrees = f"Hertz, peak {plain(hertz.max_pressure, 5)} MPa", math.degrees(angle)
    turned = f", minor axis {plain(degrees, 3)} deg from the first axis" if abs(degrees) > LEVEL_deg else ""
    return peak + turned
