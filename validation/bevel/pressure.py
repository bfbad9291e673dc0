"""Pressure maps of the reduced-TCA dissertation's bevel pairs over the rotation, beside Hertz, and at edges.

One tooth pair carries the whole load: the straight pair 39/32 under 1.5 kN, the spiral pair 17/17 under
55.5e-6 E m b = 55.9 N. The source prints no crownings for these; assumed are those below, on the pinion. Beyond half a
pitch from the pitch point, where the neighbouring pairs carry too, the contact nears the tips of both gears; there, and
where an offset E takes it to the heel, the box holds cells without material: the half-space gives a spike along the
edge which no grid resolves, so that the largest cell is only shown.

Run from the root of the repository: ``python -m validation.bevel.pressure``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter, MultipleLocator
from numpy.typing import NDArray

from loaded_tca.flanks import FlankModifications
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import PointContact, point_contact
from loaded_tca.unloaded import trace_contact
from validation.bevel.pairs import SPIRAL, STRAIGHT, BevelGears
from validation.bevel.pictures import COLOURS, draw_flank
from validation.page import Page, lines, machine, write_page
from validation.table import Row

Array = NDArray[np.float64]
TURNS = (-0.9, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 0.9)
"""Positions, in pitches from the pitch point."""
DRAWN = (-0.9, -0.5, 0.0, 0.5, 0.9)
WITHIN_HERTZ = 0.01
"""Between the map and Hertz: the grid's 1e-3, and the bending of the flanks over the ellipse."""
GRID = GridChoice(accuracy=1e-3)


@dataclass(frozen=True)
class Case:
    """A pair with the crowning of its pinion [um] and the offset E [mm]."""

    gears: BevelGears
    lead_um: float
    profile_um: float
    offset: float = 0.0

    @property
    def name(self) -> str:
        """What tables and pictures call it."""
        return f"{self.gears.name}, E {self.offset:g} mm" if self.offset else self.gears.name

    @property
    def assumed(self) -> str:
        """What the source does not print."""
        return f"pinion crowned {self.lead_um:g} um lengthwise, {self.profile_um:g} um along the profile"

    @property
    def pair(self) -> GearPair:
        """The pair."""
        crowned = FlankModifications(lead_crowning=1e-3 * self.lead_um, profile_crowning=1e-3 * self.profile_um)
        return self.gears.pair(BevelMounting(offset=self.offset), crowned)


CASES = (Case(STRAIGHT, 20.0, 10.0), Case(STRAIGHT, 20.0, 10.0, 0.25), Case(SPIRAL, 10.0, 4.0))


@dataclass(frozen=True, eq=False)
class Pressed:
    """One position under load, and the contact after Hertz of its curvatures, whether it holds or not."""

    turn: float
    loaded: LoadedContact
    hertz: PointContact

    @property
    def holds(self) -> bool:
        """Whether Hertz's assumptions hold."""
        return self.loaded.hertz is not None

    @property
    def where(self) -> str:
        """What the contact meets."""
        if self.holds:
            return "within both flanks"
        return "on an edge" if self.loaded.contact.on_edge else "cut by an edge"


@cache
def solved(case: Case) -> tuple[Pressed, ...]:
    """Every position of a case."""
    pair, load = case.pair, case.gears.load
    path = trace_contact(pair, np.array(TURNS) * pair.pitch, warn=False)
    found = []
    for turn, row in zip(TURNS, range(len(path)), strict=True):
        loaded = solve_under_load(pair, path[row], load, GRID)
        hertz = point_contact(load, loaded.separation.curvatures, pair.contact_modulus)
        found.append(Pressed(turn, loaded, hertz))
    return tuple(found)


def rows() -> list[Row]:
    """Hertz within 1 % where it holds; elsewhere the difference."""
    return [row for case in CASES for one in solved(case) for row in _rows_of(case, one)]


def _rows_of(case: Case, one: Pressed) -> list[Row]:
    def row(source: str, quantity: str, expected: float, obtained: float, tolerance: float | None) -> Row:
        return Row(case.name, source, f"{one.turn:+.2f} pitch: {quantity}", expected, obtained, tolerance, case.assumed)

    peak, source = one.loaded.peak_pressure, "Hertz, from the relative curvatures"
    if one.holds:
        along = one.loaded.solution.semi_axes[1]
        return [
            row(source, "peak pressure [MPa]", one.hertz.max_pressure, peak, WITHIN_HERTZ),
            row(source, "semi-major axis [mm]", one.hertz.semi_major, along, WITHIN_HERTZ),
        ]
    return [row(f"{source}: {one.where}", "largest cell [MPa]", one.hertz.max_pressure, peak, None)]


TEXT = """# Pressure of bevel pairs over the rotation

Written by `python -m validation.bevel.pressure`. Machine: {machine}.

The pairs are those of the reduced-TCA dissertation, one tooth pair carries the whole load:
{loads}.
Assumed: {assumed}.

Positions are counted in pitches from the pitch point; R - R_m is positive towards the heel, the height is above the
pitch cone of the pinion. Where the contact lies within both flanks the map is Hertz's to {worst:.2g} %. Where a flank
ends within the contact, Hertz does not hold: less material carries the load, and the half-space, which has no free
side, gives a spike along the edge, which is mesh-dependent: the table has the largest cell there.

![Pressure maps on the pinion, and pressure over the rotation](bevel_pressure.png)

| pair | pitches | R - R_m [mm] | height [mm] | contact | map [MPa] | Hertz [MPa] | map/Hertz | semi-axes (Hertz) [mm] |
|---|---|---|---|---|---|---|---|---|
{lines}
"""


def document() -> str:
    """The page."""
    deviations = [abs(row.error) for row in rows() if row.tolerance == WITHIN_HERTZ]
    loads = sorted({f"{case.gears.name} {case.gears.load:.4g} N" for case in CASES})
    return TEXT.format(
        machine=machine(numpy=True),
        loads=", ".join(loads),
        assumed=";\n".join(sorted({f"{case.gears.name}, {case.assumed}" for case in CASES})),
        worst=100.0 * max(deviations),
        lines=lines(_cells(case, one) for case in CASES for one in solved(case)),
    )


def _cells(case: Case, one: Pressed) -> str:
    along, above = _place(case, one)
    peak, hertz = one.loaded.peak_pressure, one.hertz
    axes = f"{hertz.semi_minor:.4f} x {hertz.semi_major:.3f}"
    return (
        f"{case.name} | {one.turn:+.2f} | {along:+.2f} | {above:+.2f} | {one.where} | {peak:.1f} "
        f"| {hertz.max_pressure:.1f} | {peak / hertz.max_pressure:.4f} | {axes}"
    )


def _place(case: Case, one: Pressed) -> tuple[Array, Array]:
    contact = one.loaded.contact
    return case.gears.place(np.array(contact.pinion_radius), np.array(contact.pinion_axial))


def picture() -> Figure:
    """Maps on the flank of the pinion; pressure over the rotation beside them."""
    figure = Figure(figsize=(12.0, 3.6 * len(CASES)), layout="constrained")
    panels = figure.subplots(len(CASES), 2, squeeze=False, width_ratios=(1.6, 1.0))
    for (flank, over), case in zip(panels, CASES, strict=True):
        _draw_maps(figure, flank, case)
        _draw_over(over, case)
    figure.suptitle(
        "One tooth pair under the whole load: contact pressure on the pinion, toe left, heel right, tip on top"
    )
    return figure


def _draw_maps(figure: Figure, axes: Axes, case: Case) -> None:
    """Cells under pressure; the scale ends where Hertz does, so that spikes do not hide the rest."""
    draw_flank(axes, case.gears)
    found = [one for one in solved(case) if one.turn in DRAWN]
    scale = Normalize(0.0, max(one.hertz.max_pressure for one in found))
    for one in found:
        pressure = one.loaded.solution.pressure
        cells = np.where(pressure > 0.0, pressure, np.nan)
        axes.pcolormesh(*_corners(case, one), cells, cmap="viridis", norm=scale, rasterized=True)
        axes.plot(*_ellipse(case, one), "--", color=COLOURS[2], linewidth=0.9)
    axes.plot([], [], "--", color=COLOURS[2], label="ellipse after Hertz")
    axes.legend(fontsize="small", loc="lower left")
    axes.set_title(f"{case.name}, {case.gears.load:.4g} N", fontsize="medium")
    figure.colorbar(ScalarMappable(scale, "viridis"), ax=axes, extend="max", label="contact pressure [MPa]")


def _corners(case: Case, one: Pressed) -> tuple[Array, Array]:
    """Corners of the cells on the pinion."""
    separation = one.loaded.separation
    x, y = (
        np.append(part, part[-1] + step) - 0.5 * step
        for part, step in zip((separation.x, separation.y), separation.spacing, strict=True)
    )
    return _on_pinion(case, one, x[:, None], y)


def _ellipse(case: Case, one: Pressed) -> tuple[Array, Array]:
    turn = np.linspace(0.0, 2.0 * np.pi, 97)
    return _on_pinion(case, one, one.hertz.semi_minor * np.cos(turn), one.hertz.semi_major * np.sin(turn))


def _on_pinion(case: Case, one: Pressed, x: Array, y: Array) -> tuple[Array, Array]:
    separation = one.loaded.separation
    point = separation.origin + x[..., None] * separation.axes[0] + y[..., None] * separation.axes[1]
    return case.gears.place(np.hypot(point[..., 0], point[..., 1]), point[..., 2])


def _draw_over(axes: Axes, case: Case) -> None:
    """Pressure of the maps and after Hertz over the rotation."""
    found = solved(case)
    turns, hertz = np.array(TURNS), np.array([one.hertz.max_pressure for one in found])
    peaks, holds = (np.array([part(one) for one in found]) for part in (_peak, _holds))
    axes.plot(turns, hertz, color=COLOURS[2], linewidth=1.0, label="Hertz, from the curvatures")
    axes.plot(turns[holds], peaks[holds], "o", color=COLOURS[1], label="map, within both flanks")
    axes.plot(turns[~holds], peaks[~holds], "x", color=COLOURS[0], label="largest cell of the map, at an edge")
    axes.set_yscale("log")
    for one in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        one(LogFormatter(minor_thresholds=(2.0, 0.5)))
    axes.xaxis.set_major_locator(MultipleLocator(0.4))
    axes.set(xlabel="position [pitches from the pitch point]", ylabel="contact pressure [MPa]")
    axes.legend(fontsize="small")


def _peak(one: Pressed) -> float:
    return one.loaded.peak_pressure


def _holds(one: Pressed) -> bool:
    return one.holds


if __name__ == "__main__":
    write_page(__doc__, lambda: Page("bevel_pressure", document(), {"bevel_pressure": picture()}))
