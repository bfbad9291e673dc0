"""The pictures of the page docs/how_it_works/rounded_edges.md.

Run from the root of the repository: ``python -m docs.how_it_works.rounded_edges``.
"""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.interpolate import griddata

from loaded_tca import AccuracyWarning, Scene, analyse, read_scene
from loaded_tca.contact import EdgePressure, edge_pressures

Array = NDArray[np.float64]
FOLDER = Path(__file__).parent
SCENES = FOLDER.parents[1] / "examples" / "scenes"
HELICAL = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(
    {"analysis.positions": 1, "analysis.torques_Nm": [260.0]}
)
SPUR = read_scene(SCENES / "mesh_cycle_finite_elements.toml").with_changes(
    {"analysis.positions": 1, "load.pinion_torque_Nm": 200.0}
)
TIPS = "pinion.tip_rounding_mm", "wheel.tip_rounding_mm"
SIDES = "pinion.side_rounding_mm", "wheel.side_rounding_mm"
RELIEF = "pinion.modifications.end_relief_um", "pinion.modifications.end_relief_length_mm"
AT_TIP = 1
"""The tooth pair whose contact ends at the tip edge of the wheel."""
GRIDS = 32, 64, 128
"""Cells along each axis."""
REFERENCE = 0.1
"""Radius [mm] at which r^(-1/3) meets the pressure."""
BLUE, ORANGE, GREEN, PINK = "#0072b2", "#d55e00", "#009e73", "#cc79a7"


@contextmanager
def columns_kept() -> Iterator[list[tuple[EdgePressure, Array]]]:
    """What analyses find at rounded edges, with the corners of the columns' cells."""
    kept: list[tuple[EdgePressure, Array]] = []

    def keep(gap: Any, box: Any, *arguments: Any, **options: Any) -> list[EdgePressure]:
        found = edge_pressures(gap, box, *arguments, **options)
        contact, problem = gap.__self__, found[0].solution.problem
        grid, x = contact.loaded.separation, box[0][0] + problem.spacing * np.arange(problem.cells[0] + 1)
        points = corners(grid.origin, contact.turn @ grid.axes[:2], x, problem.borders)
        kept.extend((one, points) for one in found if np.isfinite(one.pressure))
        return found

    with patch("loaded_tca.edges.rounded.edge_pressures", keep), warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        yield kept


def corners(origin: Array, axes: Array, x: Array, y: Array) -> Array:
    """Crossings of lines through x and y along two axes, in the fixed frame: (nx, ny, 3)."""
    return np.asarray(origin + x[:, None, None] * axes[0] + y[:, None] * axes[1])


def solved(scene: Scene, changes: dict[str, Any], number: int) -> tuple[Array, Array, float]:
    """Pressure of a tooth pair, corners of its cells and its edge pressure: of columns where there are any."""
    with columns_kept() as kept:
        result = analyse(scene.with_changes(changes))
    column = int(np.flatnonzero(result.pair == number)[0])
    edge = float(result.edge_pressure[0, 0, column])
    for found, points in kept:
        if found.pressure == edge:
            return found.solution.pressure, points, edge
    one = result.maps[0][0][column]
    x, y = (np.append(at - 0.5 * h, at[-1] + 0.5 * h) for at, h in zip((one.x, one.y), one.spacing, strict=True))
    return np.where(np.isinf(one.gap), np.nan, one.pressure), corners(one.origin, one.axes, x, y), edge


def middles(values: Array) -> Array:
    """Means of the four corners of cells."""
    return 0.25 * (values[1:, 1:] + values[:-1, 1:] + values[1:, :-1] + values[:-1, :-1])


def from_wheel_tip(points: Array) -> Array:
    """Length of the wheel's involute between its sharp tip edge and points (nx, ny, 3) [mm]; positive on the flank."""
    pair, tip = HELICAL.pair(), HELICAL.mesh().wheel.tip_radius
    return np.asarray((tip**2 - pair.to_wheel(points)[0] ** 2) / (2.0 * pair.base_radii[1]))


def tip() -> Figure:
    """Pressure of a tooth pair at the wheel's tip edge: maps, and along the profile through the peak."""
    cases = [(f"sharp, {cells} x {cells} cells", {"analysis.cells": (cells, cells)}) for cells in GRIDS[::2]]
    cases += [(f"rounded, {radius:g} mm", dict.fromkeys(TIPS, radius)) for radius in (0.1, 0.2, 0.5)]
    figure = Figure(figsize=(12.0, 6.0), layout="constrained")
    maps, cuts = figure.subplots(2, len(cases), sharex="row", sharey="row")
    for (label, changes), above, below in zip(cases, maps, cuts, strict=True):
        pressure, points, edge = solved(HELICAL, changes, AT_TIP)
        axial, depth = points[..., 2], from_wheel_tip(points)
        above.set_facecolor("0.9")
        drawn = above.pcolormesh(
            axial, depth, np.where(pressure > 0.0, pressure, np.nan), norm=Normalize(0.0, 4000.0), cmap="magma_r"
        )
        above.set(title=f"{label}\n{edge:.0f} MPa", xlabel="along the face [mm]", xlim=(2.0, 10.0), ylim=(0.5, -0.03))
        axial, depth, known = middles(axial), middles(depth), np.isfinite(pressure)
        place = axial.flat[int(np.nanargmax(pressure))], np.linspace(0.0, 0.5, 1001)
        cut = griddata((axial[known], depth[known]), pressure[known], place, rescale=True)
        below.plot(place[1], cut, color=BLUE)
        below.set(xlabel="from the tip edge [mm]", xlim=(-0.03, 0.5), ylim=(0.0, 4200.0))
        below.grid(alpha=0.3)
    maps[0].set_ylabel("from the sharp tip edge,\nalong the profile [mm]")
    cuts[0].set_ylabel("pressure through the peak [MPa]")
    figure.colorbar(drawn, ax=maps, label="pressure [MPa]")
    return figure


def over_the_radius() -> Figure:
    """Edge pressure at the same tip over the radius of its rounding."""
    radii = np.array([0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8])
    found = np.array([solved(HELICAL, dict.fromkeys(TIPS, float(radius)), AT_TIP)[2] for radius in radii])
    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    axes.loglog(radii, found, "o-", color=BLUE, label="rounded tip")
    through = found[radii == REFERENCE] * (radii / REFERENCE) ** (-1.0 / 3.0)
    axes.loglog(radii, through, "--", color="black", label="proportional to r$^{-1/3}$")
    for cells, style in zip(GRIDS, (":", "-.", "-"), strict=True):
        sharp = solved(HELICAL, {"analysis.cells": (cells, cells)}, AT_TIP)[2]
        axes.axhline(sharp, color=ORANGE, linestyle=style, label=f"sharp tip, {cells} x {cells} cells")
    ticks = [0.02, 0.05, 0.1, 0.2, 0.5, 0.8]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    heights = [1500, 2000, 3000, 4000, 5000, 7000]
    axes.set_yticks(heights, [str(height) for height in heights])
    axes.minorticks_off()
    axes.set(xlabel="tip rounding r [mm]", ylabel="pressure at the tip edge [MPa]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    return figure


def face_end() -> Figure:
    """Pressure along the face of a spur pair near the one of its flush ends that has the finer columns."""
    figure = Figure(figsize=(11.0, 4.5), layout="constrained")
    left, right = figure.subplots(1, 2)
    for cells, style in zip(GRIDS, (":", "--", "-"), strict=True):
        _draw_along(left, {"analysis.cells": (32, cells)}, f"sharp, {cells} cells along", ORANGE, style)
    rounded: dict[str, Any] = dict.fromkeys(SIDES, 0.2) | {"analysis.cells": (32, 128)}
    _draw_along(left, rounded, "side rounding 0.2 mm", BLUE, "-")
    for (amount, length), colour in (((0.0, 0.0), BLUE), ((5.0, 2.0), PINK), ((10.0, 2.0), GREEN)):
        label = f"end relief {amount:g} µm over {length:g} mm" if amount else "no end relief"
        _draw_along(right, rounded | dict(zip(RELIEF, (amount, length), strict=True)), label, colour, "-")
    left.set_title("flush face ends without end relief")
    right.set_title("side rounding 0.2 mm, end relief on the pinion")
    for axes in (left, right):
        axes.set(xlabel="from mid-face [mm]", xlim=(7.0, 10.05), ylim=(0.0, 5200.0))
        axes.grid(alpha=0.3)
        axes.legend(loc="upper left", fontsize="small")
    left.set_ylabel("largest pressure across the contact [MPa]")
    return figure


def _draw_along(axes: Axes, changes: dict[str, Any], label: str, colour: str, style: str) -> None:
    pressure, points, _ = solved(SPUR, changes, 0)
    axial = middles(points[..., 2])
    across = 0 if np.ptp(axial[:, 0]) < np.ptp(axial[0]) else 1
    axial, highest = axial.mean(axis=across), np.nan_to_num(pressure).max(axis=across)
    axial = axial * np.sign(axial[np.argmin(np.abs(np.diff(axial)))])
    pressed = highest > 0.0
    axes.plot(axial[pressed], highest[pressed], color=colour, linestyle=style, label=label)


def main() -> None:
    """Draw all pictures."""
    figures = {
        "rounded_edges_tip": tip(),
        "rounded_edges_radius": over_the_radius(),
        "rounded_edges_face_end": face_end(),
    }
    for name, figure in figures.items():
        figure.savefig(FOLDER / f"{name}.png", dpi=90)


if __name__ == "__main__":
    main()
