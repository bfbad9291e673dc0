"""The pressure between two half-spaces on its grid, without gears."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

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


def plot_solution(solution: ContactSolution, hertz: PointContact | LineContact | None = None) -> Figure:
    """Pressure of a contact solution: a map of the grid, and the two lines through its highest cell.

    Places count from the middle of the grid. Cells without material are grey, without pressure white.

    Parameters
    ----------
    solution : ContactSolution
        Of :func:`loaded_tca.solve_contact` or :func:`loaded_tca.contact.solve_problem`.
    hertz : PointContact or LineContact, optional
        Drawn beside it, its minor axis along the first axis of the grid, its middle in that of the grid; a line without
        ends along the second axis.

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
    borders = [(np.arange(count + 1) - 0.5 * count) * step for count, step in zip(pressure.shape, steps, strict=True)]
    places = [0.5 * (ends[1:] + ends[:-1]) for ends in borders]
    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    panels = figure.subplots(1, 3, width_ratios=(1.2, 1.0, 1.0))
    area = panels[0]
    area.set_facecolor(NO_MATERIAL)
    material = np.where(np.isinf(solution.gap), np.nan, 0.0)
    area.pcolormesh(borders[1], borders[0], material, cmap="Greys", vmin=0.0, vmax=1.0, rasterized=True)
    lengths = [ends[-1] - ends[0] for ends in borders]
    alike = max(lengths) <= ALIKE * min(lengths)
    scale = 1.0 if alike else scale_factor(lengths[1], lengths[0])[0]
    area.set_aspect(scale)
    larger = f" (drawn {plain(scale, 6)} times larger)" if scale != 1.0 else ""
    area.set(xlabel="second axis [mm]", ylabel=f"first axis [mm]{larger}")
    if pressure.any():
        loaded = np.where(pressure > 0.0, pressure, np.nan)
        drawn = area.pcolormesh(borders[1], borders[0], loaded, cmap=COLOURS, vmin=0.0, rasterized=True)
        figure.colorbar(drawn, ax=area)
        area.set_title(PRESSURE, fontsize="small")
    else:
        tell(area, NO_LOAD)
    top = np.unravel_index(int(pressure.argmax()), pressure.shape)
    sections = pressure[:, top[1]], pressure[top[0]]
    names = "first axis [mm]", "second axis [mm]"
    for k, (axes, place, section, name) in enumerate(zip(panels[1:], places, sections, names, strict=True)):
        axes.plot(place, section, "o-", markersize=3.0, linewidth=0.8, color="black", label="solution")
        if hertz is not None:
            fine = np.linspace(place[0], place[-1], FINE)
            across, along = (fine, np.zeros_like(fine)) if k == 0 else (np.zeros_like(fine), fine)
            curve = hertz.pressure(across) if isinstance(hertz, LineContact) else hertz.pressure(across, along)
            axes.plot(fine, curve, color=ACCENT, label=f"Hertz, peak {plain(hertz.max_pressure, 5)} MPa")
        at = float(places[1 - k][top[1 - k]])
        axes.set_title(f"at {plain(at, 3)} mm of the {('second', 'first')[k]} axis", fontsize="small")
        axes.set(xlabel=name, ylabel=PRESSURE)
        from_zero(axes)
        axes.grid(alpha=0.3)
    if hertz is not None:
        figure.legend(*panels[1].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize="small")
    figure.suptitle(
        f"peak pressure {plain(solution.peak_pressure, 5)} MPa, load {plain(solution.load, 5)} N, "
        f"approach {plain(solution.approach, 5)} mm; {pressure.shape[0]} x {pressure.shape[1]} cells",
        fontsize="medium",
    )
    return figure
