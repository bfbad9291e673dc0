"""Page and picture of the bidirectional start: ``python -m validation.face_milled.duplex_document``."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from loaded_tca.baselines.bidirectional import BidirectionalStart, Guess
from loaded_tca.flank_maps import contact_pattern
from loaded_tca.flanks.face_milled import GeneratedFlank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plots.style import DOTS_PER_INCH
from loaded_tca.unloaded import trace_contact
from validation.face_milled.duplex_paper import (
    COMPONENTS,
    GIVEN,
    MISPRINTS,
    PRINTED,
    Study,
    outcomes,
    start_values,
    starts,
    studies,
)
from validation.face_milled.pairs import DUPLEX_ASSUMED, MENDED_RADIAL, duplex_paper_gears, error_from_top
from validation.page import Page, machine, table, write_page

NAME = "bidirectional_start"
"""Of the page and its picture."""
COLOURS = {"forward": "#0072b2", "reverse": "#d55e00", "mean": "#009e73"}
PATTERN = "#cfe3f2"
MARKERS = {"forward": "^", "reverse": "v", "mean": "D"}
PARTS = tuple(np.linspace(-0.5, 0.5, 41))


TEXT = """\
# The bidirectional start of duplex spread blade pairs

Written by `python -m validation.face_milled.duplex_document`. Machine: {machine}.

Source: the duplex paper and its duplex spread blade pair 20 x 30. Its machine settings name no reference point, so that
the paper constructs a start for the five contact equations: *forward* from the gear, *reverse* from the pinion, and the
mean of both. `loaded_tca.baselines.BidirectionalStart` does what it describes; `loaded_tca.gears.duplex_spread_blade`
gives the settings that follow from a blank.

1. Cradles at the centre of roll: each flank is seen along one line, by the azimuth theta about its cutter. theta of a
   calculation point (X_L, R_L) on the pitch cone at mid-face. The paper asks for two coordinates with one unknown; here
   the line is met in cone distance.
2. The turn phi' of that gear from the equation of meshing n . v12 = 0, in closed form.
3. theta and phi' of the mating gear from opposite normals.

## The paper's numbers

Steps 2 and 3 depend on machine root angles, ratios of roll and blade angles only (blade group 11: 18 deg 10' outside,
21 deg 50' inside), so that they can be checked although the paper leaves out face width and cradle angle. Azimuths on
each gear's own hand, turns right-handed about each axis from apex to heel; reverse from the printed theta_p, forward
from the theta_g to which the printed theta_p belongs. **All printed digits are reproduced once two misprints are
corrected** (turns are cut off, not rounded):

{values}

From the printed theta_g 5.349393, theta_p would be {wrong_azimuth:.6f} and phi1' {wrong_turn:.2e}, not the printed
0.896671 and -6.3e-4.

## What these settings give

{assumed}

{printed}

{mended}

![Pinion flanks, starts, contact paths and transmission errors]({picture})

## Which method converges from it

At the pinion angle of each start: plain Newton on the five equations (with two of the three components of the normals),
the reduced solver from the pinion's point, and the first touch that the scan of the ease-off finds without any start.
*Gap*: between the two points of the start; *off*: wheel angle of the start less that of the contact. *Off the flanks*:
the equations are solved where there is no tooth.

{solvers}

- The start is sufficient: wherever flanks touch inside their edges, the five equations converge from all three of its
  versions, in {five} steps. The mean is no better than its two parts.
- It is a start for the normals, not for the points: they lie some millimetres apart, since nothing in the construction
  brings them together (each gear stands with a slot where its machine cut one), and the wheel angle is degrees off.
- Where flanks touch on an edge there is no common normal, so that no start helps: the five equations diverge or end off
  the flanks with a residual of zero. The printed settings themselves are such a pair.
- The reduced solver converges from the same points in {reduced} steps, also on edges, and the scan of the ease-off
  makes the start unnecessary: it needs neither the settings nor a reference point, only the flanks.
- The pair from the duplex blank touches in the middle of the flank on both sides: its settings are closed forms, its
  spiral angles differ by {spiral:.3f} deg at most and its pressure angles by {pressure:.3f} deg (the number of the
  blade group is rounded to a half).
"""
PRINTED_PAIR = (
    "**The pair of the paper does not mesh sensibly.** Its root angles belong to a spiral angle of 35 deg, and its one "
    "radial setting to another taper, so that the two spiral angles miss each other by {drive:+.2f} deg on the drive "
    "and {coast:+.2f} deg on the coast side. The transmission error of a tooth pair has its top where the toe ends: "
    '{place}, in the corner of the face cone. A "well-centred path" with a "low-amplitude, parabolic-like" '
    "transmission error does not follow from the settings that the paper prints."
)
MENDED_PAIR = (
    "**Mended pair D**: the pinion's radial setting {radial} mm instead of 58.38392, all else as printed. The top lies "
    "{place}, and half a pitch before and after it the transmission error has fallen by {before:.2f} and {after:.2f} "
    "arcsec: this is what the paper describes."
)
WIDTH = 118


def document() -> str:
    """The whole page."""
    gears = duplex_paper_gears()
    wrong = BidirectionalStart(gears, Study("", gears).pair()).forward(MISPRINTS["forward theta_g"][0])
    solvers, five, reduced = _solvers()
    duplex = [_misses(study) for study in studies() if study.name.startswith("duplex")]
    return TEXT.format(
        machine=machine(numpy=True),
        values=_values(),
        wrong_azimuth=wrong.pinion_azimuth,
        wrong_turn=wrong.pinion_turn,
        assumed=fill(f"Assumed, where the paper says nothing: {DUPLEX_ASSUMED}.", WIDTH),
        printed=_printed_pair(),
        mended=_mended_pair(),
        picture=f"{NAME}.png",
        solvers=solvers,
        five=_range(five),
        reduced=_range(reduced),
        spiral=max(abs(spiral) for spiral, _ in duplex),
        pressure=max(abs(pressure) for _, pressure in duplex),
    )


def _values() -> str:
    """Table of the start values."""
    values = start_values()
    cells = []
    for quantity, printed in PRINTED.items():
        shown, mended = MISPRINTS.get(quantity, (printed, printed))
        remark = f"misprint, read {mended}" if quantity in MISPRINTS else "given" if quantity in GIVEN else ""
        cells.append(f"{quantity} | {shown:.7g} | {values[quantity]:.7g} | {remark}")
    return table("quantity | printed | computed |", cells)


def _printed_pair() -> str:
    study = Study("", duplex_paper_gears())
    misses = (_misses(Study("", study.gears, flank))[0] for flank in ("concave", "convex"))
    return fill(PRINTED_PAIR.format(drive=next(misses), coast=next(misses), place=_top_of(study)[0]), WIDTH)


def _mended_pair() -> str:
    place, fall = _top_of(Study("", duplex_paper_gears(MENDED_RADIAL)))
    return fill(MENDED_PAIR.format(radial=MENDED_RADIAL, place=place, before=-fall[0], after=-fall[1]), WIDTH)


def _top_of(study: Study) -> tuple[str, NDArray[np.float64]]:
    """Where the top of the transmission error lies on the pinion, and the fall half a pitch before and after it."""
    pair = study.pair()
    _, fall, top = error_from_top(pair, (-0.5, 0.5))
    return pair.pinion.flank.frame.place(float(top.pinion_radius[0]), float(top.pinion_axial[0])), fall


def _misses(study: Study) -> tuple[float, float]:
    """Spiral and normal pressure angle of the pinion less those of the wheel [deg]."""
    side = study.gears[0].side(study.flank)
    pinion, wheel = (GeneratedFlank(gear, gear.flank_name(side)).angles for gear in study.gears)
    return degrees(abs(pinion.spiral) - abs(wheel.spiral)), degrees(pinion.pressure - wheel.pressure)


def _solvers() -> tuple[str, list[int], list[int]]:
    """Table of both solvers from each start, and the steps of those that converged: five equations, reduced."""
    heads, cells = " | ".join(f"five, {name}" for name in COMPONENTS), []
    steps: tuple[list[int], list[int]] = ([], [])
    for study in studies():
        for name, out in outcomes(study).items():
            steps[0].extend(int(text.split()[0]) for text in out.conventional.values() if text.endswith("steps"))
            steps[1].extend([] if out.reduced is None else [out.reduced])
            ended = "fails" if out.reduced is None else f"{out.reduced} steps"
            where = "on an edge" if out.on_edge else "inside"
            start = study.name, name, f"{out.distance:.2f}", f"{out.wheel_angle_off:+.2f}"
            cells.append((*start, *out.conventional.values(), ended, where))
    return table(f"pair | start | gap [mm] | off [deg] | {heads} | reduced | the contact", cells), *steps


def _range(steps: list[int]) -> str:
    return f"{min(steps)} to {max(steps)}"


def picture() -> Figure:
    """Flanks with starts and paths, and the transmission errors, of the paper's pair and of the mended one."""
    figure = Figure(figsize=(11.0, 7.6), layout="constrained")
    above, below = figure.subplots(2, 2)
    for column, (title, radial) in enumerate(
        (("printed settings", 58.38392), (f"mended pair D: pinion radial {MENDED_RADIAL} mm", MENDED_RADIAL))
    ):
        study = Study(title, duplex_paper_gears(radial))
        pair = study.pair()
        _draw_flank(above[column], study, pair)
        _draw_error(below[column], pair)
    figure.suptitle("Duplex paper, 20 x 30, drive side: bidirectional start, contact of one tooth pair, unloaded")
    return figure


def _draw_flank(axes: Axes, study: Study, pair: GearPair) -> None:
    """Pinion flank with the pattern, the path of contact and the starts."""
    frame = pair.pinion.flank.frame
    corners = np.stack(frame.to_picture(*pair.pinion.flank.grid(2, 17)), axis=-1)
    axes.add_patch(Polygon(np.concatenate([corners[0], corners[1][::-1]]), facecolor="0.95", edgecolor="0.5"))
    pattern = contact_pattern(pair)
    axes.contourf(*frame.to_picture(pattern.radius, pattern.axial), pattern.touched, [0.5, 1.5], colors=[PATTERN])
    axes.fill([], [], color=PATTERN, label="contact pattern")
    path = trace_contact(pair, error_from_top(pair, PARTS)[0] + 2.0 * np.array(PARTS) * pair.pitch, warn=False)
    place = frame.to_picture(path.pinion_radius, path.pinion_axial)
    axes.plot(*(part[~path.on_edge] for part in place), "k.", markersize=4, label="contact")
    axes.plot(*(part[path.on_edge] for part in place), "kx", markersize=4, label="contact on an edge")
    for name, guess in starts(study, pair).items():
        axes.plot(*_place(pair, guess), MARKERS[name], color=COLOURS[name], markersize=7, label=f"start, {name}")
    axes.set(xlabel=frame.labels[0], ylabel=frame.labels[1], title=study.name)
    axes.legend(loc="upper center", fontsize="small", ncols=2)
    axes.set_ylim(top=corners[..., 1].max() + 3.5)
    axes.set_aspect("equal")


def _place(pair: GearPair, guess: Guess) -> Sequence[NDArray[np.float64]]:
    return pair.pinion.flank.frame.to_picture(guess.unknowns[:1], guess.unknowns[1:2])


def _draw_error(axes: Axes, pair: GearPair) -> None:
    """Transmission error of one tooth pair about its top."""
    top, fall, _ = error_from_top(pair, PARTS)
    angles = degrees(top) + np.degrees(np.array(PARTS) * pair.pitch)
    path = trace_contact(pair, top + np.array(PARTS) * pair.pitch, warn=False)
    axes.plot(angles, fall, "k-")
    axes.plot(angles[path.on_edge], fall[path.on_edge], "kx", markersize=4)
    axes.set(xlabel="pinion angle [deg], one pitch", ylabel="transmission error from its top [arcsec]")
    axes.margins(y=0.1)
    axes.annotate(f"{fall[0]:.2f}", (angles[0], fall[0]), textcoords="offset points", xytext=(14, -14))
    axes.annotate(f"{fall[-1]:.2f}", (angles[-1], fall[-1]), textcoords="offset points", xytext=(-54, -4))


if __name__ == "__main__":
    write_page(__doc__, lambda: Page(NAME, document(), {NAME: picture()}, DOTS_PER_INCH))
