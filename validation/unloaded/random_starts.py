"""Two methods from the same random starts: what the studies of convergence share, whatever the gears.

Starts are drawn evenly over the flanks: on the pinion's for the reduced solver; on both, and phi2 about the answer,
for the conventional one. A start counts if it ends at the contact that ``trace_contact`` gives.
"""

import math
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from loaded_tca.baselines.conventional import ConventionalResult, solve_conventional, solve_with_scipy_root
from loaded_tca.flanks.base import Flank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import ContactPoint, trace_contact
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import climb
from validation import page
from validation.page import Result

Array = NDArray[np.float64]
SAME = 1e-9
"""Wheel angle [rad], and ease-off relative to r_b2, within which an ending is the contact."""
COMPONENTS = {"y, z": (1, 2), "x, z": (0, 2), "x, y": (0, 1)}
RUNS = 3
"""The shortest of so many runs is the time of a vectorised method."""
SHOWN = 1000
"""Starts in the pictures."""
FAR = 1e5
"""Ends farther than this [mm] are drawn at the frame."""
TICKS = (-1e5, -1e3, 0.0, 1e3, 1e5)
SCIPY_STARTS = 200
"""SciPy solves one start after the other."""
DOTS_PER_INCH = 80
COLOURS = {"converged": "#0072b2", "not converged": "#d55e00", "answer": "#000000"}
"""Okabe and Ito 2008: told apart by colour-blind readers; the markers differ, too."""


@dataclass(frozen=True)
class Draw:
    """How the start of the five equations is drawn: phi2 - answer from low to high [rad], evenly.

    The start on the wheel is drawn over its flank, or always in the middle of it.
    """

    name: str
    low: float
    high: float
    wheel_in_the_middle: bool = False

    def __str__(self) -> str:
        return self.name

    @property
    def mirrored(self) -> "Draw":
        """The same on the other side of the answer."""
        return replace(self, low=-self.high, high=-self.low)


SPREADS = (Draw("within 0.2 rad", -0.2, 0.2), Draw("within pi/2", -0.5 * math.pi, 0.5 * math.pi))


@dataclass(frozen=True)
class View:
    """Coordinates in which points of the pinion flank are drawn: lengthwise and along the profile, and their names."""

    coordinates: Callable[[Array, Array], tuple[Array, Array]] = lambda rho, z: (z, rho)
    names: tuple[str, str] = ("z", "radius")


@dataclass(frozen=True)
class Case:
    """A pair, and what the source does not say about it."""

    name: str
    pair: GearPair
    assumed: str
    starts: int = 5000
    view: View = View()
    normals: str = "y, z"
    """Components of the normals in the picture."""
    contact: ContactPoint = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "contact", trace_contact(self.pair, [0.0])[0])

    @cached_property
    def unit_starts(self) -> Array:
        """Starts (n, 5): rho1, z1, rho2, z2 [mm] over both flanks, and phi2 between -1 and 1."""
        rng = np.random.default_rng(20240607)
        shares = rng.uniform(size=(4, self.starts))
        angle = rng.uniform(-1.0, 1.0, self.starts)
        flanks = (self.pair.pinion.flank, shares[:2]), (self.pair.wheel.flank, shares[2:])
        return np.stack([*(part for flank, share in flanks for part in points_of(flank, *share)), angle], axis=-1)

    def draw(self, how: Draw) -> Array:
        """The same starts, with phi2 [rad] about the answer and the start on the wheel as drawn."""
        starts = self.unit_starts * [1.0, 1.0, 1.0, 1.0, 0.5 * (how.high - how.low)]
        starts[:, 4] += self.contact.wheel_angle + 0.5 * (how.low + how.high)
        if how.wheel_in_the_middle:
            starts[:, 2:4] = np.stack(points_of(self.pair.wheel.flank, *np.full((2, 1), 0.5)), axis=-1)
        return starts


def points_of(flank: Flank, profile: Array, lengthwise: Array) -> list[Array]:
    """Radius and axial coordinate (n,) [mm] at shares 0 to 1 of the profile and of the face, between the corners."""
    return [
        (1.0 - profile) * ((1.0 - lengthwise) * corner[0, 0] + lengthwise * corner[0, 1])
        + profile * ((1.0 - lengthwise) * corner[1, 0] + lengthwise * corner[1, 1])
        for corner in np.broadcast_arrays(*flank.grid(2, 2))
    ]


@dataclass(frozen=True)
class Outcome:
    """One method from all starts of a case."""

    method: str
    spread: str
    good: NDArray[np.bool_]
    steps: float
    seconds: float
    domain: Array
    """Starts: rho1, z1 [mm] and, if it is an unknown, phi2 [rad]."""
    range: Array
    """Ends: rho1, z1 [mm]."""

    @property
    def percentage(self) -> float:
        """Starts that ended at the contact [%]."""
        return 100.0 * float(self.good.mean())


def timed(run: Callable[[], Result], runs: int) -> tuple[Result, float]:
    """Result, and the shortest processor time of some runs [s]."""
    found, seconds = page.timed(run, runs, clock=time.process_time)
    return found, min(seconds)


def reduced(case: Case, runs: int = 1) -> Outcome:
    """Climb the ease-off from every start; phi2 is no unknown of it."""
    starts, angle = case.unit_starts, np.zeros(case.starts)
    found, seconds = timed(lambda: climb(EaseOff(case.pair), angle, starts[:, 0], starts[:, 1]), runs)
    height = case.contact.transmission_error * case.pair.base_radii[1]
    good = found.converged & (np.abs(found.value - height) <= SAME * case.pair.base_radii[1])
    ends = np.stack([found.rho, found.z], axis=-1)
    return Outcome("reduced", "-", good, float(found.iterations[good].mean()), seconds, starts[:, :2], ends)


def conventional(case: Case, spread: Draw, components: str, runs: int = 1) -> Outcome:
    """Plain Newton iteration on the five equations."""
    starts, chosen = case.draw(spread), COMPONENTS[components]
    found, seconds = timed(lambda: solve_conventional(case.pair, 0.0, starts, chosen), runs)
    return _five(f"five, normals {components}", case, spread, starts, found, seconds)


def scipy_root(case: Case, spread: Draw, components: str) -> Outcome:
    """SciPy's ``root`` on the same equations, from the first starts."""
    starts, chosen = case.draw(spread)[:SCIPY_STARTS], COMPONENTS[components]
    found, seconds = timed(lambda: solve_with_scipy_root(case.pair, 0.0, starts, chosen), 1)
    return _five(f"SciPy root, normals {components}", case, spread, starts, found, seconds)


def _five(method: str, case: Case, spread: Draw, starts: Array, found: ConventionalResult, seconds: float) -> Outcome:
    good = found.is_contact & (np.abs(found.wheel_angle - case.contact.wheel_angle) <= SAME)
    steps = float(found.iterations[good].mean()) if good.any() else math.nan
    return Outcome(method, spread.name, good, steps, seconds, starts[:, [0, 1, 4]], found.unknowns[:, :2])


def study(case: Case, components: Iterable[str]) -> list[Outcome]:
    """All methods and draws of one case."""
    found, chosen = [reduced(case, RUNS)], tuple(components)
    for spread in SPREADS:
        found += [conventional(case, spread, normals, RUNS) for normals in chosen]
        found.append(scipy_root(case, spread, case.normals))
    return found


@dataclass(frozen=True)
class Parts:
    """Parts of a page: lines of the table, links of the pictures, what is assumed, and the pictures by file."""

    lines: str
    links: str
    assumed: str
    pictures: dict[str, Figure]


def parts_of_page(stem: str, cases: Iterable[Case], components: Iterable[str]) -> Parts:
    """Study cases; the files of their pictures have a number behind the stem."""
    lines, links, assumed, pictures, chosen = [], [], [], {}, tuple(components)
    for number, case in enumerate(cases, 1):
        outcomes = study(case, chosen)
        lines.append(lines_of(case, outcomes))
        print(lines[-1], flush=True)
        pictures[f"{stem}{number}"] = picture(case, outcomes)
        links.append(f"![{case.name}: domain and range]({stem}{number}.png)\n")
        assumed.append(f"- {case.name}: {case.assumed}.")
    return Parts("\n".join(lines), "\n".join(links), "\n".join(assumed), pictures)


def lines_of(case: Case, outcomes: list[Outcome]) -> str:
    """Lines of the table, one a method and draw."""
    return page.lines(
        f"{case.name} | {one.method} | {one.spread} | {len(one.good)} | {one.percentage:.2f} | {one.steps:.2f} "
        f"| {1e3 * one.seconds:.0f} | {1e3 * one.seconds / max(1, one.good.sum()):.3g}"
        for one in outcomes
    )


def picture(case: Case, outcomes: list[Outcome]) -> Figure:
    """Above which starts converge, below where they end, relative to the contact; one column a method."""
    chosen = [one for one in outcomes if one.method in ("reduced", f"five, normals {case.normals}")]
    figure = Figure(figsize=(11.5, 6.6), layout="constrained")
    panels = figure.subplots(2, len(chosen), squeeze=False)
    along, across = case.view.names
    height, width = case.pair.pinion.flank.extent
    for (domain, ends), one in zip(panels.T, chosen, strict=True):
        spread = "" if one.spread == "-" else f", phi2 {one.spread}"
        domain.set_title(f"{one.method}{spread}\n{one.percentage:.1f} % of {len(one.good)} starts", fontsize=10)
        place, angle = _from_contact(case, one.domain), one.domain[:, 2:] - case.contact.wheel_angle
        _scatter(domain, angle[:, 0] if angle.size else place[0], place[1], one.good)
        domain.set_xlabel("phi2 - contact [rad]" if angle.size else f"{along} - contact [mm]")
        _scatter(ends, *_from_contact(case, one.range), one.good)
        ends.set_xscale("symlog", linthresh=case.pair.face_width)
        ends.set_yscale("symlog", linthresh=min(height, width))
        ends.set(xlim=(-FAR, FAR), ylim=(-FAR, FAR), xticks=TICKS, yticks=TICKS, xlabel=f"{along} - contact [mm]")
        ends.minorticks_off()
    panels[0, 0].set_ylabel(f"domain: {across} - contact [mm]")
    panels[1, 0].set_ylabel(f"range: {across} - contact [mm]")
    figure.legend(*panels[0, -1].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    starts = f"{SHOWN} starts" if case.starts == SHOWN else f"the first {SHOWN} of {case.starts} starts"
    figure.suptitle(f"{case.name}: {starts} on the pinion flank, and where they end")
    return figure


def _from_contact(case: Case, points: Array) -> tuple[Array, Array]:
    """Lengthwise and profile coordinate (n,) of points (n, 2 or more), relative to the contact [mm]."""
    contact = case.view.coordinates(np.array(case.contact.pinion_radius), np.array(case.contact.pinion_axial))
    here = case.view.coordinates(points[:, 0], points[:, 1])
    return here[0] - contact[0], here[1] - contact[1]


def _scatter(panel: Axes, x: Array, y: Array, good: NDArray[np.bool_]) -> None:
    for mask, marker, label in ((~good, "x", "not converged"), (good, "o", "converged")):
        rows = np.flatnonzero(mask[:SHOWN])
        where = [np.clip(part[rows], -FAR, FAR) for part in (x, y)]
        panel.plot(*where, marker, ms=3, color=COLOURS[label], alpha=0.7, label=label)
    panel.plot(0.0, 0.0, "+", ms=14, color=COLOURS["answer"], label="contact")
