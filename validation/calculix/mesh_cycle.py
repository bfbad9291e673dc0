"""The loaded mesh cycle against finite elements: shares, transmission error, stiffness, pressure and time.

Source: the kept runs of ``validation.calculix``, in plane strain; how both are made alike is told in
``validation.calculix.comparison``. Runs that are not kept give no rows.

Page and picture: ``python -m validation.calculix.mesh_cycle`` from the root of the repository
(a minute or two).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from loaded_tca.errors import AccuracyWarning
from loaded_tca.plots.style import DOTS_PER_INCH
from validation.calculix import pairs_in_space
from validation.calculix.case import FACE_WIDTH, POSITIONS, line_load, pinion_angle
from validation.calculix.comparison import Key, Model, Position, model, read_cycles
from validation.page import Page, lines, machine, write_page
from validation.table import Row, render

SOURCE = "finite elements, plane strain (CalculiX)"
WIDE = 100.0
"""Face [mm] whose free ends matter little beside plane strain; that of the torques, 20 mm, is compared too."""
SHARE, ERROR, STIFFNESS, PRESSURE = 2e-2, 3e-2, 3e-2, 2e-2
"""Asked: shares in parts of the torque, the others relative; of stiffness beside what the kept one is uncertain by."""
SLOPE = 2e-2
"""The same of the slope of the kept deflections, which are smooth: free ends of a wide face leave 1 %, meshes 0.2 %."""
PARTING = 0.02
"""A pair with a smaller share may come apart within the 4 % of torque over which stiffness is taken."""

FACES = (WIDE, FACE_WIDTH)
SMOOTH = "positions without tip corner"
FREE_ENDS = "plane strain has no free ends, which deflect more"

Cycles = dict[Key, list[Position]]
Pairs = Sequence[tuple[Position, Position]]
"""Positions kept and computed here."""


def rows() -> list[Row]:
    """Rows of every kept cycle, both faces, and of the pairs in space; none where nothing is kept."""
    kept = read_cycles()
    both = [row for face in FACES for row in rows_of(kept, model(face))] if kept else []
    return both + pairs_in_space.rows()


def short_rows() -> list[Row]:
    """Rows of the wide face at the largest torque of either variant, and of the pairs in space."""
    kept = read_cycles()
    torque = max((torque for _, torque in kept), default=0.0)
    some = {key: kept[key] for key in kept if key[1] == torque}
    return rows_of(some, model(WIDE), kept) + pairs_in_space.rows()


def rows_of(kept: Cycles, ours: Model, every: Cycles | None = None) -> list[Row]:
    """Rows of every cycle that is given.

    Parameters
    ----------
    kept : dict
        Positions by variant and torque.
    ours : Model
    every : dict, optional
        Those by which the stiffness of kept runs is judged, of three torques at least; default: the same.
    """
    every = kept if every is None else every
    slopes, uncertain = slopes_of(every), stiffness_errors(every)
    table: list[Row] = []
    for key, cycle in kept.items():
        pairs = _beside(ours, key, cycle)
        table += _rows_of_cycle(key, ours.face_width, pairs, uncertain.get(key[1], 0.0))
        sloped = [(replace(pairs[n][0], mesh_stiffness=slope), pairs[n][1]) for n, slope in slopes.get(key, {}).items()]
        if sloped and ours.face_width >= WIDE:
            name = "slope of the deflections [N/(mm um)]"
            table.append(_worst(_case(key, ours.face_width), name, sloped, stiffness, SLOPE))
    return table


def slopes_of(kept: Cycles) -> dict[Key, dict[int, float]]:
    """Stiffness of the unmodified pair [N/(mm um)] from the kept deflections under three torques, by index of position.

    Under a line load F' teeth deflect by F' (a - b ln F'), Hertz's line contact and bending, where no tip corner
    touches: the kept deflections follow it to 3e-4.

    Parameters
    ----------
    kept : dict
    """
    keys = sorted(key for key in kept if key[0] == "unmodified")
    force = np.array([line_load(torque) for _, torque in keys])
    found: dict[Key, dict[int, float]] = {key: {} for key in keys if len(keys) > 2}
    for n, positions in enumerate(zip(*(kept[key] for key in found), strict=True)):
        if not any(position.at_corner for position in positions):
            deflection = -np.array([position.transmission_error for position in positions])
            by_logarithm, constant = np.polyfit(np.log(force), deflection / force, 1)
            slopes = 1.0 / (constant + by_logarithm * (np.log(force) + 1.0))
            for key, slope in zip(keys, slopes.tolist(), strict=True):
                found[key][n] = slope
    return found


def stiffness_errors(kept: Cycles) -> dict[float, float]:
    """How far the kept stiffness is from the slope of the kept deflections, relative, by torque [N m].

    It is a difference over 4 % of a torque: up to 0.1, 0.8 and 1.6 % off, the more the larger the torque.

    Parameters
    ----------
    kept : dict
    """
    return {
        key[1]: max(abs(stiffness(kept[key][n]) / slope - 1.0) for n, slope in slopes.items())
        for key, slopes in slopes_of(kept).items()
        if slopes
    }


def _beside(ours: Model, key: Key, cycle: list[Position]) -> Pairs:
    """Kept positions and ours at the same pinion angles."""
    return list(zip(cycle, ours.cycle(*key, [position.pinion_angle for position in cycle]), strict=True))


def _rows_of_cycle(key: Key, face_width: float, pairs: Pairs, uncertain: float) -> list[Row]:
    """Rows of one cycle: transmission error over all positions, the rest where no tip corner touches."""
    case = _case(key, face_width)
    remark = f"{len(pairs)} positions"
    smooth = [both for both in pairs if not any(one.at_corner for one in both)]
    table = [_row(case, f"mean transmission error [um], {remark}", pairs, np.mean, ERROR)]
    if len(pairs) > 1:
        table.append(_row(case, f"its peak to peak [um], {remark}", pairs, np.ptp, ERROR))
    if smooth:
        table += [
            _row_of_shares(case, smooth),
            _worst(case, "peak pressure [MPa]", smooth, peak, PRESSURE, "taken to the mean line load"),
            _worst(case, "peak pressure at mid-face [MPa]", smooth, pressed_peak, PRESSURE, "as pressed"),
        ]
    for parting in (False, True):
        if chosen := [both for both in smooth if is_parting(*both) == parting]:
            table.append(_row_of_stiffness(case, chosen, parting, face_width < WIDE, uncertain))
    return table


def _case(key: Key, face_width: float) -> str:
    return f"mesh cycle {key[0].replace('_', ' ')}, {key[1]:g} N m, face {face_width:g} mm"


def is_parting(kept: Position, ours: Position) -> bool:
    """Whether a pair carries so little that it comes apart under slightly less torque."""
    return min(pair.share for side in (kept, ours) for pair in side.pairs.values()) < PARTING


def peak(position: Position) -> float:
    """Highest pressure of a position [MPa]."""
    return max(pair.pressure for pair in position.pairs.values())


def share_difference(kept: Position, ours: Position) -> float:
    """Largest difference of a share."""
    return max(abs(ours.share(pair) - kept.share(pair)) for pair in {*kept.pairs, *ours.pairs})


def _row(case: str, quantity: str, pairs: Pairs, figure: Callable[[list[float]], np.floating], tolerance: float) -> Row:
    """A figure of the transmission error over the positions."""
    expected, obtained = (
        float(figure([position.transmission_error for position in side])) for side in zip(*pairs, strict=True)
    )
    return Row(case, SOURCE, quantity, expected, obtained, tolerance)


def _row_of_shares(case: str, pairs: Pairs) -> Row:
    worst = max(share_difference(*both) for both in pairs)
    return Row(case, SOURCE, "largest difference of a load share", 0.0, worst, SHARE, note=SMOOTH)


def _row_of_stiffness(case: str, pairs: Pairs, parting: bool, free_ends: bool, uncertain: float) -> Row:
    """Stiffness jumps where a pair parts, and is less where the ends of a face are free: both are only shown."""
    name = "mesh stiffness [N/(mm um)]" + (", a pair parting" if parting else "")
    if parting or free_ends:
        return _worst(case, name, pairs, stiffness, None, FREE_ENDS * free_ends)
    remark = f"the kept one is {100.0 * uncertain:.1f} % from the slope of the kept deflections"
    return _worst(case, name, pairs, stiffness, STIFFNESS + uncertain, remark)


def stiffness(position: Position) -> float:
    """Mesh stiffness of a position [N/(mm um)]."""
    return position.mesh_stiffness


def _worst(
    case: str, name: str, pairs: Pairs, of: Callable[[Position], float], tolerance: float | None, remark: str = ""
) -> Row:
    """The position without tip corner where a quantity differs most."""
    kept, ours = max(pairs, key=lambda both: abs(of(both[1]) / of(both[0]) - 1.0))
    note = "; ".join(filter(None, (f"position {abs(round(kept.place))}", SMOOTH, remark)))
    return Row(case, SOURCE, f"{name}, worst position", of(kept), of(ours), tolerance, note=note)


PAGE = """# The loaded mesh cycle against finite elements

Written by `python -m validation.calculix.mesh_cycle`. Machine: {machine}.

Spur pair 25/37, m 3 mm, unmodified and with 15 um of tip relief on both gears: load sharing with
`compliance = "contact+tooth"` beside the {count} kept runs of CalculiX ([how they were made](reference_fem.md)): 2
variants, 3 torques, 24 positions over a base pitch. Every position is computed here at the pinion angle at which the
load left the finite elements.

![Transmission error, load share and peak pressure over the pitch](mesh_cycle_fem.png)

Crosses mark positions with a tip corner in contact. The pressure at the corner has no limit in theory, and the
stiffness changes with every element that comes into contact. Stiffness and pressure there, of either side, are
therefore not compared; the shares there are in brackets. Stiffness is taken between 96 and 100 % of the torque on both
sides. A pair with less than {parting:g} % of the torque loses contact in between: such positions are left out of the
column.

The kept deflections of the unmodified pair under 20, 100 and 200 N m follow Hertz's law F' (a - b ln F') to 3e-4 where
no tip corner touches. The kept stiffness is a difference over 4 % of a torque; under these torques it differs from the
slope of this law by up to {uncertain} %. This is allowed in addition to the {asked_stiffness:g} % that are asked.
Separate rows compare stiffness with the slope, with {slope:g} % allowed.

## Plane strain against a face with ends

The finite elements are in plane strain. On a real face (and here) the teeth end freely and deflect more there. The
table and the rows of `python -m validation` have a face of {wide:g} mm, where the ends matter little, and the
{narrow:g} mm of the pair, under the same line load, at all {positions} positions. The stiffness of the narrow face is
shown, not judged: at the pitch point under 100 N m the finite elements themselves deflect {softer:.1f} % more on
{narrow:g} mm in space than the same elements in plane strain. The load is not the same all along a face: the half-space
makes the ends of a line carry more than its middle, the bending of teeth that end there less. Pressure *mean load* is
that of mid-face times the root of mean over local line load (Hertz: p ~ sqrt F'), which is what plane strain has;
*mid-face* is as pressed.

Largest differences over the positions, in percent, of shares in percentage points, in brackets those of tip corners.
Asked: shares {asked_share:g}, transmission error {asked_error:g}, stiffness {asked_stiffness:g}, pressure
{asked_pressure:g}.

| face | variant | T1 [N m] | positions | shares | mean TE | peak to peak | stiffness | mean load | mid-face |
|---|---|---|---|---|---|---|---|---|---|
{table}

The softness beside plane strain falls with the width of the face, as that of free ends does.

## In space

The last rows are two pairs of 20 mm width in space, finite elements of the whole face: the pinion crowned by 10 um, and
a flat pair, whose load grows a little before it falls at the ends of the face. The flat one needs
`analysis.free_edges`: without it the layer at the end carries a tenth too much.

## Time

Processor time [s] of both on this machine, of one position and of all {count} kept ones; other work ran beside.

| | once | a position | all |
|---|---|---|---|
{times}

{factor} The SAM paper speaks of two orders of magnitude against finite elements; this is what was measured against
elements in plane strain, which have one section of the face, while the pair here has the whole face.

## Rows

```
{rows}
```
"""

NAMES = {"unmodified": "unmodified", "tip_relief": "tip relief 15 µm on both gears"}
TORQUE_COLOURS = {20.0: "#009E73", 100.0: "#0072B2", 200.0: "#D55E00"}
"""Okabe and Ito."""


def cells_of(face_width: float, key: Key, pairs: Pairs) -> list[str]:
    """Differences of one cycle as cells of a line of the page.

    Parameters
    ----------
    face_width : float [mm]
    key : (str, float)
    pairs : sequence of (Position, Position)
    """
    smooth = [both for both in pairs if not any(one.at_corner for one in both)]
    kept, ours = ([position.transmission_error for position in side] for side in zip(*pairs, strict=True))
    shares = f"{_points(smooth)} ({_points(pairs)})"
    peak_to_peak = f"{_percent(np.ptp(ours) / np.ptp(kept))}" if len(pairs) > 1 else "-"
    whole = [both for both in smooth if not is_parting(*both)]
    parts = [
        _largest([quantity(ours) / quantity(kept) for kept, ours in chosen])
        for quantity, chosen in ((stiffness, whole), (peak, smooth), (pressed_peak, smooth))
    ]
    return [
        f"{face_width:g}",
        key[0].replace("_", " "),
        f"{key[1]:g}",
        f"{len(pairs)}",
        shares,
        _percent(np.mean(ours) / np.mean(kept)),
        peak_to_peak,
        *parts,
    ]


def pressed_peak(position: Position) -> float:
    """Highest pressure of a position as it is at mid-face [MPa]."""
    return max(pair.pressed for pair in position.pairs.values())


def _points(pairs: Pairs) -> str:
    """Largest difference of a share in percentage points."""
    return f"{100.0 * max((share_difference(*both) for both in pairs), default=np.nan):.2f}"


def _percent(ratio: float) -> str:
    return f"{100.0 * (ratio - 1.0):+.2f}"


def _largest(ratios: list[float]) -> str:
    return _percent(max(ratios, key=lambda ratio: abs(ratio - 1.0))) if ratios else "-"


def times_table(kept: Cycles, models: Iterable[tuple[Model, list[Position]]]) -> tuple[str, str]:
    """Lines of the times, and what they amount to.

    Parameters
    ----------
    kept : dict
    models : iterable of (Model, list of Position)
        And all positions that each computed.
    """
    seconds = [position.seconds for cycle in kept.values() for position in cycle]
    rows, ratios = [f"CalculiX, plane strain | 0 | {np.median(seconds):.1f} | {sum(seconds):.0f}"], []
    for one, positions in models:
        own = [position.seconds for position in positions]
        total = one.seconds + sum(own)
        name = f"here, face {one.face_width:g} mm"
        rows.append(f"{name} | {one.seconds:.1f} | {np.median(own):.2f} | {total:.1f}")
        ratios.append((f"{one.face_width:g} mm", sum(seconds) / total, np.median(seconds) / np.median(own)))
    said = [
        f"Face {name}: {all_in:.0f} times as quick in all, {single:.0f} times a position."
        for name, all_in, single in ratios
    ]
    return lines(rows), " ".join(said)


def picture(kept: Cycles, ours: Model) -> Figure:
    """Transmission error, share of pair 0 and peak pressure over the pitch, a column for each variant.

    Parameters
    ----------
    kept : dict
    ours : Model
    """
    figure = Figure(figsize=(11.0, 10.0), layout="constrained")
    variants = list(dict.fromkeys(variant for variant, _ in kept))
    axes = figure.subplots(len(PANELS), len(variants), sharex=True, sharey="row", squeeze=False)
    angles = [pinion_angle(index) for index in range(POSITIONS + 1)]
    for variant, torque in kept:
        column = axes[:, variants.index(variant)]
        column[0].set_title(NAMES[variant])
        _draw(
            column,
            TORQUE_COLOURS[torque],
            f"{torque:g} N m",
            kept[variant, torque],
            ours.cycle(variant, torque, angles),
        )
    for row, (label, _) in zip(axes, PANELS, strict=True):
        row[0].set_ylabel(label)
    for below in axes[-1]:
        below.set_xlabel("pinion angle / pitch")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    title = f"lines: here, face {ours.face_width:g} mm; dots: finite elements, crosses: tip corners"
    figure.legend(handles, labels, loc="outside upper center", ncols=len(TORQUE_COLOURS), title=title)
    return figure


PANELS: tuple[tuple[str, Callable[[Position], float]], ...] = (
    ("loaded transmission error [µm]", lambda position: position.transmission_error),
    ("load share of tooth pair 0", lambda position: position.share(0)),
    ("mesh stiffness [N/(mm µm)]", stiffness),
    ("peak pressure, no corner [MPa]", lambda position: np.nan if position.at_corner else peak(position)),
)


def _draw(column: Iterable[Axes], colour: str, label: str, kept: list[Position], ours: list[Position]) -> None:
    """One torque of one variant: a line of ours, dots of the kept positions, crosses where a corner touches."""
    for axes, (_, quantity) in zip(column, PANELS, strict=True):
        axes.plot(_in_pitches(ours), [quantity(one) for one in ours], color=colour, linewidth=1.2, label=label)
        for at_corner, marker in ((False, "o"), (True, "x")):
            chosen = [one for one in kept if one.at_corner == at_corner]
            axes.plot(_in_pitches(chosen), [quantity(one) for one in chosen], marker, color=colour, markersize=4)
        axes.grid(alpha=0.3)


def _in_pitches(positions: list[Position]) -> list[float]:
    return [position.place / POSITIONS - 0.5 for position in positions]


def page() -> Page:
    """Page and picture, if there is anything to compare."""
    kept = read_cycles()
    if not kept:
        raise SystemExit("no runs are kept: make reference-fem")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return page_of(kept)


def page_of(kept: Cycles) -> Page:
    """Page and picture of kept cycles.

    Parameters
    ----------
    kept : dict
    """
    models = [model(face) for face in FACES]
    beside = [{key: _beside(one, key, cycle) for key, cycle in kept.items()} for one in models]
    computed = [[ours for pairs in by_key.values() for _, ours in pairs] for by_key in beside]
    times, factor = times_table(kept, zip(models, computed, strict=True))
    text = PAGE.format(
        machine=machine(numpy=True),
        count=sum(map(len, kept.values())),
        wide=WIDE,
        narrow=FACE_WIDTH,
        positions=POSITIONS,
        softer=100.0 * (pairs_in_space.softness_of_free_ends() - 1.0),
        parting=100.0 * PARTING,
        uncertain=", ".join(f"{100.0 * error:.1f}" for error in stiffness_errors(kept).values()),
        slope=100.0 * SLOPE,
        asked_share=100.0 * SHARE,
        asked_error=100.0 * ERROR,
        asked_stiffness=100.0 * STIFFNESS,
        asked_pressure=100.0 * PRESSURE,
        table=lines(
            cells_of(one.face_width, key, pairs)
            for one, by_key in zip(models, beside, strict=True)
            for key, pairs in by_key.items()
        ),
        times=times,
        factor=factor,
        rows=render([*(row for one in models for row in rows_of(kept, one)), *pairs_in_space.rows()]),
    )
    return Page("mesh_cycle_fem", text, {"mesh_cycle_fem": picture(kept, models[0])}, DOTS_PER_INCH)


if __name__ == "__main__":
    write_page(__doc__, page)
