"""Page and picture of the straight bevel pair of the miter-gear paper.

Run from the root of the repository: ``python -m validation.bevel.miter_gear_document`` (a minute).
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from loaded_tca.baselines.golden_section import search_golden_section
from loaded_tca.flank_maps import ContactArea
from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.unloaded import trace_contact
from validation.bevel.miter_gear_paper import (
    ARCSEC,
    BESIDE,
    EDGE,
    FEW,
    GEARS,
    POSITIONS,
    PRINTED,
    PROFILE,
    area_at,
    crowning_for,
    five_equations,
    golden,
    largest_error,
    pair,
    path_of,
    rows,
    slowness,
)
from validation.bevel.pictures import COLOURS, draw_flank
from validation.page import Page, lines, machine, write_page
from validation.table import render

Array = NDArray[np.float64]
OFFSETS = (0.0, 0.05, 0.1, 0.13, 0.15, 0.2, 0.3)
"""E [mm] of the table."""
FINE = 30
"""Sections of the golden-section search in the table."""
WIDE = np.linspace(-1.5, 1.5, 241)
"""Positions of the curves of transmission error, in pitches."""

TEXT = """# The straight bevel pair of the miter-gear paper: three methods, its contact pattern, its edges

Written by `python -m validation.bevel.miter_gear_document`. Machine: {machine}.

20/40 teeth, m_et 3 mm, shaft angle 90 deg, alpha 20 deg, profile shifts +0.416/-0.416, pinion crowned. Assumed, since
the source does not print it: face width 20 mm, crowning 10 um lengthwise and {profile:g} um along the profile, marking
compound 6.35 um.

![Path, transmission error, contact pattern, and the same on the heel](miter_gear_paper.png)

## Largest transmission error

The source prints about -12.5 and -12.7 arcsec (its Table 2). The lengthwise crowning does not enter; 5 um along the
profile give {motion:.2f} arcsec where neighbouring teeth take over from each other, and {one:.2f} arcsec at the ends of
-1/2 to +1/2 pitch of one pair, whose top lies a quarter of a pitch after the pitch point. The printed values need:

| printed | profile crowning, motion of the gears | profile crowning, one pair over -1/2 to +1/2 pitch |
|---|---|---|
{crownings}

Slight crownings C give, in closed form, z1/z2 C/(R_m sin delta_b) (pi sin(delta_b)/(z1 (w_a - w_m)))^2; stronger ones
less (3 % at 10 um), since the contact moves to where less is removed.

## Towards the edge

{positions} positions over one pitch. *Five equations, own start*: Newton from the contact in the middle of the pitch;
*best start*: from the answer itself. Where the contact lies on the heel the normals of the flanks differ, so the
conventional equations have no solution on the flanks, from whatever start; the extremum of the ease-off and the
golden-section search find the same contact ({few} positions compared).

| E [mm] | on an edge | five equations, own start | best start | golden section, TE [arcsec] | place [mm] |
|---|---|---|---|---|---|
{edges}

## Contact pattern

| E [mm] | contour [mm^2] | ellipse [mm^2] | semi-axes of the contour [mm] | of the ellipse [mm] |
|---|---|---|---|---|
{areas}

## B-spline flanks

Both flanks as quintic B-splines through 33 x 33 of their points: a path takes {slower:.1f} times the processor time.

## All rows

```
{rows}
```
"""


def document() -> str:
    """The page."""
    return TEXT.format(
        machine=machine(numpy=True),
        profile=1e3 * PROFILE,
        motion=largest_error(PROFILE),
        one=largest_error(PROFILE, one_pair=True),
        crownings=lines(map(_crowning_cells, PRINTED.values())),
        positions=POSITIONS,
        few=FEW,
        edges=lines(map(_edge_cells, OFFSETS)),
        areas=lines(map(_area_cells, OFFSETS)),
        slower=slowness(),
        rows=render(rows()),
    )


def _crowning_cells(error: float) -> list[str]:
    amounts = (crowning_for(error, one_pair=one_pair) for one_pair in (False, True))
    return [f"{error:g} arcsec", *(f"{1e3 * amount:.2f} um" for amount in amounts)]


def _edge_cells(offset: float) -> str:
    gears = pair(mounting=BevelMounting(offset=offset))
    path = path_of(gears)
    own, best = (five_equations(gears, path, from_answer=start).found for start in (False, True))
    angle, place = golden(gears, path_of(gears, FEW), FINE).largest
    return f"{offset:g} | {path.on_edge.sum()} | {own} | {best} | {angle:.1e} | {place:.1e}"


def _area_cells(offset: float) -> str:
    area = area_at(BevelMounting(offset=offset))
    sizes = (" x ".join(f"{axis:.3f}" for axis in axes) for axes in (area.semi_axes, area.ellipse_semi_axes))
    cut = ", cut" if area.is_cut else ""
    return f"{offset:g} | {area.area:.3f}{cut} | {area.ellipse_area:.3f} | {' | '.join(sizes)}"


def picture() -> Figure:
    """Path, transmission error and contact areas, aligned and with errors of mounting."""
    figure = Figure(figsize=(12.0, 8.0), layout="constrained")
    (path, motion), (pattern, edge) = figure.subplots(2, 2)
    _draw_paths(path)
    _draw_motion(motion, None, "aligned")
    _draw_areas(pattern)
    _draw_motion(edge, EDGE, f"E {EDGE.offset:g} mm: on the heel at every position")
    crowned = f"pinion crowned 10 µm lengthwise, {1e3 * PROFILE:g} µm along the profile"
    figure.suptitle(f"Straight bevel pair 20/40 of the miter-gear paper, m_et 3 mm, b 20 mm, {crowned}")
    return figure


def _draw_paths(axes: Axes) -> None:
    draw_flank(axes, GEARS)
    for number, (mounting, label) in enumerate(((None, "aligned"), (BESIDE, "E 0.1 mm"), (EDGE, "E 0.2 mm"))):
        gears = pair(mounting=mounting)
        path = path_of(gears)
        style = {"color": COLOURS[number], "markersize": 3.0, "linewidth": 1.0}
        axes.plot(*GEARS.path_on_pinion(path), "o-", label=label, **style)
        few = path_of(gears, FEW)
        searched = search_golden_section(gears, few.pinion_angle)
        place = GEARS.place(searched.pinion_radius, searched.pinion_axial)
        axes.plot(*place, "s", fillstyle="none", markersize=9.0, color=COLOURS[number])
    _legend_above(axes, "dots: ease-off; squares: golden section")
    axes.set_title("contact path on the pinion, toe left, heel right", fontsize="medium")


def _draw_motion(axes: Axes, mounting: BevelMounting | None, title: str) -> None:
    gears = pair(mounting=mounting)
    path, few = trace_contact(gears, WIDE * gears.pitch, warn=False), path_of(gears, FEW)
    pitch, curve = np.degrees(gears.pitch), path.transmission_error * ARCSEC
    turn = np.degrees(path.pinion_angle)
    for tooth, label in ((0, "ease-off"), (1, "neighbouring teeth"), (-1, None)):
        style = {"color": COLOURS[0], "linewidth": 1.0, "linestyle": ":" if tooth else "-", "label": label}
        axes.plot(turn + tooth * pitch, curve, **style)
    searched = search_golden_section(gears, few.pinion_angle)
    lag = (searched.wheel_angle - gears.ratio * few.pinion_angle) * ARCSEC
    axes.plot(
        np.degrees(few.pinion_angle),
        lag,
        "s",
        fillstyle="none",
        markersize=9.0,
        color=COLOURS[1],
        label="golden section",
    )
    solved = path_of(gears)
    there = np.isfinite(five_equations(gears, solved, from_answer=True).angle)
    lag = solved.transmission_error[there] * ARCSEC
    label = f"five equations: {there.sum()} of {len(there)} positions"
    axes.plot(np.degrees(solved.pinion_angle[there]), lag, "+", markersize=8.0, color=COLOURS[2], label=label)
    within = curve[np.abs(turn) <= 0.5 * pitch]
    room = 0.15 * np.ptp(within)
    axes.set(xlim=(-0.5 * pitch, 0.5 * pitch), ylim=(within.min() - 3.0 * room, within.max() + room))
    axes.set(xlabel="pinion angle [deg]", ylabel="transmission error [arcsec]")
    axes.legend(fontsize="small", loc="lower center", ncols=2, framealpha=1.0)
    axes.set_title(title, fontsize="medium")


def _draw_areas(axes: Axes) -> None:
    draw_flank(axes, GEARS)
    for number, (mounting, label) in enumerate(((None, "aligned"), (BESIDE, "E 0.1 mm"), (EDGE, "E 0.2 mm"))):
        for turn in (-0.4, 0.0, 0.4):
            _draw_area(axes, area_at(mounting, turn), COLOURS[number], label if turn == 0.0 else None)
    _legend_above(axes, "contour; dashed: ellipse of the curvatures")
    axes.set_title("contact areas under 6.35 µm of marking compound", fontsize="medium")


def _legend_above(axes: Axes, title: str) -> None:
    """A legend of three columns, in room above the flank."""
    axes.set_ylim(top=axes.get_ylim()[1] + 1.5)
    axes.legend(fontsize="small", loc="upper center", ncols=3, title=title, title_fontsize="small")


def _draw_area(axes: Axes, area: ContactArea, colour: str, label: str | None) -> None:
    closed = np.append(np.arange(len(area.pinion_radius)), 0)
    axes.plot(
        *GEARS.place(area.pinion_radius[closed], area.pinion_axial[closed]), color=colour, linewidth=1.2, label=label
    )
    x, y, z = np.append(area.ellipse_points, area.ellipse_points[:1], axis=0).T
    axes.plot(*GEARS.place(np.hypot(x, y), z), "--", color=colour, linewidth=0.9)


if __name__ == "__main__":
    write_page(__doc__, lambda: Page("miter_gear_paper", document(), {"miter_gear_paper": picture()}))
