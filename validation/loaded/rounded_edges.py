"""Pressure at rounded edges of gears: finer and finer columns and grids, radii, bounds, time.

Nothing outside the package tells these pressures, so they are compared with themselves: on columns two to four times as
fine, and on grids of several finenesses on which the tooth pairs share the load. Contacts that carry more than a
twentieth of their position's force are asked to be within 3 %, and within their own estimate, none excepted. Where the
face ends are sharp the estimate has to be infinite: rows of half-spaces show that the pressure has no limit there.

The table has one scene for each kind of edge, and of it the two contacts with the highest bounds; the page and
``python -m validation --whole loaded.rounded_edges`` have all.

A spur tip under one force has a peak that falls with a power of its radius, near the -1/3 of narrow roundings, which
``validation/contact/rounded_edge.py`` reaches. That the limit of small radii is the sharp edge is in
``tests/results/test_rounded_edges.py``.

Run from the root of the repository: ``python -m validation.loaded.rounded_edges``; writes a page.
"""

import math
import time
import warnings
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import dataclass
from functools import cache, cached_property, partial
from typing import Any
from unittest.mock import patch

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.arrays import Array
from loaded_tca.compliance.model import BendingModel
from loaded_tca.contact import edge_pressures, rounded_edge
from loaded_tca.edges import rounded as edges_of_gears
from loaded_tca.edges.arcs import ReachedArc, arcs_in_cycle, reached_arcs
from loaded_tca.edges.rounded import PeakAtEdge, pressure_at_rounded_edge
from loaded_tca.loaded.cycle import CycleSolution
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene
from loaded_tca.threads import one_thread
from validation.page import SCENES, Page, formatted, machine, medians, table, take_times, write_page
from validation.table import Row, render

Place = tuple[int, int, int]


ASKED, LEAST_SHARE = 0.03, 0.05
MOST_CONTACTS, CONTACTS_IN_TABLE = 4, 2
AT_CORNERS = 0.07
"""Where a rounded tip meets a sharp face end, as ``docs/how_it_works/rounded_edges.md`` says."""
OTHER_LARGEST = 5e-3
"""What the default may leave out of the largest pressure: a sixth of what is asked of a pressure."""
ON_GRIDS = 0.02
FINENESSES = (0.6, 1.0, 1.6)
RADII = (0.05, 0.1, 0.2, 0.3, 0.5)
RUNS = 3
FINER, SOURCE = "finest columns", "definition"

SPUR: dict[str, Any] = {
    "pair.normal_module_mm": 3.0,
    "pinion.teeth": 25,
    "wheel.teeth": 37,
    "pinion.face_width_mm": 20.0,
    "wheel.face_width_mm": 20.0,
    "pinion.modifications": {},
    "wheel.modifications": {},
    "load.pinion_torque_Nm": 200.0,
    "analysis.torques_Nm": None,
    "analysis.positions": 25,
}
"""Pair 25/37 of module 3 without modifications."""
CROWNED = SPUR | {"pinion.modifications.lead_crowning_um": 5.0}
"""Whose contacts do not reach the ends of the face, which are sharp where tips are rounded."""
PITCH_POINT = SPUR | {"analysis.positions": 1, "analysis.load_sharing": False, "analysis.compliance": "contact"}
HELICAL = {"analysis.positions": 9, "analysis.torques_Nm": [260.0]}
SKEW = HELICAL | {"mounting.out_of_plane_deg": 0.03, "pinion.modifications.lead_crowning_um": 0.0}


def rounded(tip: float = 0.0, side: float = 0.0) -> dict[str, Any]:
    """Changes of a scene: radii [mm] of both gears."""
    return {
        f"{gear}.{edge}_rounding_mm": radius
        for gear in ("pinion", "wheel")
        for edge, radius in (("tip", tip), ("side", side))
    }


@dataclass(frozen=True, eq=False)
class Case:
    """A scene whose contacts reach rounded edges, and how many times as fine its finest columns are."""

    name: str
    file: str
    changes: dict[str, Any]
    finest: float = 4.0
    sharp_ends: bool = False
    """Whether lines of contact at a rounded edge end in a sharp corner: without a limit."""

    @property
    def scene(self) -> Scene:
        """What is analysed."""
        return read_scene(SCENES / f"{self.file}.toml").with_changes(self.changes)


CASES = (
    Case("spur tip, r 0.2", "mesh_cycle_spur", CROWNED | rounded(tip=0.2)),
    Case("spur tip, r 0.1", "mesh_cycle_spur", CROWNED | rounded(tip=0.1)),
    Case("spur tip, sharp ends, r 0.2", "mesh_cycle_spur", SPUR | rounded(tip=0.2), sharp_ends=True),
    Case("helical tip, r 0.2", "mesh_cycle_helical", HELICAL | rounded(tip=0.2), 3.0),
    Case("helical tip, r 0.05", "mesh_cycle_helical", HELICAL | rounded(tip=0.05), 3.0),
    Case("flush ends, r 0.2", "mesh_cycle_spur", PITCH_POINT | rounded(side=0.2)),
    Case(
        "flush ends, r 0.2, no free edges",
        "mesh_cycle_spur",
        PITCH_POINT | rounded(side=0.2) | {"analysis.free_edges": False},
    ),
    Case("misaligned, r 0.2", "misaligned", {"analysis.positions": 3} | rounded(0.2, 0.2), 3.0),
    Case(
        "misaligned, r 0.2, no free edges",
        "misaligned",
        {"analysis.positions": 3, "analysis.free_edges": False} | rounded(0.2, 0.2),
        3.0,
    ),
    Case("helical, tip and end cross, r 0.2", "mesh_cycle_helical", SKEW | rounded(0.2, 0.2), 2.2),
    Case("spiral bevel, r 0.1", "mesh_cycle_bevel", {"analysis.positions": 9} | rounded(0.1, 0.1), 4.0),
    Case("face-milled, r 0.2", "face_milled_19x62", {"analysis.positions": 9} | rounded(0.2, 0.2), 3.2),
)


@dataclass(frozen=True)
class Solved:
    """An analysis, and what its pressures at rounded edges were found from."""

    cycle: MeshCycle
    pair: GearPair
    carried: CycleSolution
    bending: BendingModel | None
    free_edges: bool

    @classmethod
    def of(cls, scene: Scene) -> "Solved":
        """Analyse a scene; contacts at edges are meant here, without a warning."""
        name = "loaded_tca.analysis.pressures_at_rounded_edges"
        with warnings.catch_warnings(), patch(name, wraps=edges_of_gears.pressures_at_rounded_edges) as found:
            warnings.simplefilter("ignore", AccuracyWarning)
            cycle = analyse(scene)
        return cls(cycle, *found.call_args.args, found.call_args.kwargs["free_edges"])

    @cached_property
    def reached(self) -> dict[Place, tuple[LoadedContact, list[ReachedArc]]]:
        """Contacts that reach rounded edges, by torque, position and tooth pair, the highest bound first."""
        found = {
            (t, n, k): (loaded, edges)
            for (t, n, k), edges in arcs_in_cycle(self.pair, self.carried).items()
            if (loaded := self.carried.contacts[t][n][k]) is not None
        }
        return dict(sorted(found.items(), key=lambda item: -item[1][1][0].bound))

    def share(self, place: Place) -> float:
        """Part of a contact in the normal force of its position."""
        forces = [0.0 if one is None else one.solution.load for one in self.carried.contacts[place[0]][place[1]]]
        return forces[place[2]] / sum(forces)

    def peak(self, place: Place, fineness: float | None = None) -> PeakAtEdge:
        """Peak of a contact as an analysis finds it, or on columns so many times as fine as its first ones."""
        loaded, edges = self.reached[place]
        number = int(self.carried.pairs[place[2]])
        with nullcontext() if fineness is None else finer_columns(fineness):
            return pressure_at_rounded_edge(self.pair, loaded, edges, self.bending, number, free_edges=self.free_edges)


@contextmanager
def finer_columns(fineness: float) -> Iterator[None]:
    """Columns so many times as fine beside edges and away from them, as many more at the most, and none finer."""
    finer: dict[Any, dict[str, Any]] = {
        edges_of_gears: {
            "CELLS_ACROSS": fineness * edges_of_gears.CELLS_ACROSS,
            "CELLS_ALONG": fineness * edges_of_gears.CELLS_ALONG,
            "edge_pressures": partial(
                edge_pressures, cells_on_arc=fineness * rounded_edge.CELLS_ON_ARC, accuracy=math.inf
            ),
        },
        rounded_edge: {
            "MOST_ROWS": math.ceil(fineness * rounded_edge.MOST_ROWS),
            "MOST_FINE": math.ceil(fineness * rounded_edge.MOST_FINE),
        },
    }
    with ExitStack() as stack:
        for module, names in finer.items():
            stack.enter_context(patch.multiple(module, **names))
        yield


@dataclass(frozen=True)
class Refined:
    """Peaks of a contact on finer and finer columns."""

    case: str
    share: float
    bound: float
    found: PeakAtEdge
    """By an analysis."""
    peaks: tuple[float, ...]
    """[MPa] by fineness, the last of them on the finest columns."""

    @property
    def errors(self) -> Array:
        """Of all but the finest, relative to it."""
        return np.array(self.peaks[:-1]) / self.peaks[-1] - 1.0

    @property
    def error(self) -> float:
        """Of an analysis."""
        return self.found.pressure / self.peaks[-1] - 1.0


@cache
def refined(case: Case, most: int = MOST_CONTACTS, finenesses: tuple[float, ...] = FINENESSES) -> tuple[Refined, ...]:
    """Contacts of a case that carry more than a twentieth, so many at the most, those with the highest bounds."""
    solved, found = Solved.of(case.scene), []
    loaded = [place for place in solved.reached if solved.share(place) > LEAST_SHARE]
    for place in loaded[:most]:
        found.append(
            Refined(
                case.name,
                solved.share(place),
                solved.reached[place][1][0].bound,
                solved.peak(place),
                tuple(solved.peak(place, fineness).pressure for fineness in (*finenesses, case.finest)),
            )
        )
    return tuple(found)


def order(contacts: Iterable[Refined]) -> float:
    """Order of convergence: slope of the mean square errors over the width of the columns."""
    errors = np.sqrt(np.mean([one.errors**2 for one in contacts], axis=0))
    return -float(np.polyfit(np.log(FINENESSES), np.log(errors), 1)[0])


IN_TABLE = (
    "spur tip, r 0.1",
    "spur tip, sharp ends, r 0.2",
    "helical tip, r 0.05",
    "flush ends, r 0.2",
    "misaligned, r 0.2",
    "helical, tip and end cross, r 0.2",
    "spiral bevel, r 0.1",
    "face-milled, r 0.2",
)
"""Names of cases: each kind of edge and gear once, of two radii that with the larger error, free ends as by default."""


def rows_of_columns() -> list[Row]:
    """Errors of every contact against the finest columns, what of them is beyond their estimates, and the order."""
    found = []
    for case in CASES:
        contacts = refined(case)
        found += [*_rows_of(case, contacts), Row(case.name, FINER, "order of convergence", 2.0, order(contacts), None)]
    return [*found, row_of_corner()]


def rows_of_some_columns() -> list[Row]:
    """Errors of some contacts, and what of them is beyond their estimates."""
    some = (case for case in CASES if case.name in IN_TABLE)
    return [*(row for case in some for row in _rows_of(case, refined(case, CONTACTS_IN_TABLE, ()))), row_of_corner()]


def _rows_of(case: Case, contacts: tuple[Refined, ...]) -> list[Row]:
    worst = max(contacts, key=lambda one: abs(one.error))
    note = f"{worst.found.pressure:.0f} MPa, finest {worst.peaks[-1]:.0f} MPa"
    allowed = AT_CORNERS if case.sharp_ends else ASKED
    found = [Row(case.name, FINER, "largest error of the peak", 0.0, abs(worst.error), allowed, note=note)]
    without = sum(not math.isfinite(one.found.error) for one in contacts)
    expected = float(len(contacts)) if case.sharp_ends else 0.0
    words = f"contacts without an estimate, of {len(contacts)}"
    found.append(Row(case.name, SOURCE, words, expected, float(without), 0.0))
    if not case.sharp_ends:
        beyond = sum(abs(one.error) > one.found.error for one in contacts)
        nearest = max(abs(one.error) / one.found.error for one in contacts)
        words, note = f"contacts whose error is above its estimate, of {len(contacts)}", f"{nearest:.2f} of it"
        found.append(Row(case.name, FINER, words, 0.0, float(beyond), 0.0, note=f"at the most {note}"))
    return found


CORNER_ROWS, LEAST_RISE = (14, 28, 56, 112, 224, 448), 0.01


@cache
def corner_peaks() -> tuple[float, ...]:
    """Peak [MPa] of a line at a rounded tip that ends in sharp corners of half-spaces, over the rows along the tip."""
    case = next(case for case in CASES if case.sharp_ends)
    solved = Solved.of(case.scene.with_changes({"analysis.free_edges": False}))
    place = next(place for place in solved.reached if solved.share(place) > LEAST_SHARE)

    def on_rows(rows: int) -> float:
        def pressures(*arguments: Any, **options: Any) -> Any:
            return edge_pressures(*arguments, **{**options, "cells": (rows, 16), "accuracy": math.inf})

        with (
            patch.object(edges_of_gears, "edge_pressures", pressures),
            patch.object(rounded_edge, "MOST_ROWS", CORNER_ROWS[-1]),
        ):
            return solved.peak(place).pressure

    return tuple(on_rows(rows) for rows in CORNER_ROWS)


def row_of_corner() -> Row:
    """Whether the pressure at a sharp corner grows whenever the rows are halved."""
    peaks = np.array(corner_peaks())
    rises = int((peaks[1:] > (1.0 + LEAST_RISE) * peaks[:-1]).sum())
    quantity = f"sharp corner of half-spaces: rises by more than {LEAST_RISE:.0%} with twice as many rows"
    note = ", ".join(f"{peak:.0f}" for peak in peaks) + f" MPa on {CORNER_ROWS[0]} to {CORNER_ROWS[-1]} rows"
    return Row("spur tip, sharp ends, r 0.2", "no limit", quantity, len(peaks) - 1.0, float(rises), 0.0, note=note)


GRIDS: dict[str, dict[str, Any]] = {
    **{f"{n} x {n}": {"analysis.cells": (n, n), "analysis.accuracy": None} for n in (24, 48, 96)},
    **{f"accuracy {one:g}": {"analysis.cells": None, "analysis.accuracy": one} for one in (1e-2, 1e-3)},
}
ON_SEVERAL = ("spur tip, r 0.2", "helical tip, r 0.2", "misaligned, r 0.2", "face-milled, r 0.2")


@cache
def over_grids(name: str, grids: tuple[str, ...]) -> dict[str, float]:
    """Largest pressure [MPa] at a rounded edge by the grid on which the tooth pairs share the load."""
    scene = next(case.scene for case in CASES if case.name == name)
    cycles = {grid: Solved.of(scene.with_changes(GRIDS[grid])).cycle for grid in grids}
    return {grid: float(np.nanmax(cycle.edge_pressure[cycle.edge_is_rounded])) for grid, cycle in cycles.items()}


def rows_of_grids(names: Iterable[str] = ON_SEVERAL, grids: tuple[str, ...] = tuple(GRIDS)) -> list[Row]:
    """Largest pressures at edges of grids and accuracies, beside those of the finest grid."""
    return [
        Row(f"{name}, {grid}", "96 x 96", "edge pressure [MPa]", found["96 x 96"], found[grid], ON_GRIDS)
        for name, found in ((name, over_grids(name, grids)) for name in names)
        for grid in grids
        if grid != "96 x 96"
    ]


@cache
def over_radii() -> dict[float, tuple[float, float]]:
    """Largest pressure [MPa] of a spur tip over its radius: in the mesh, and under the force of the smallest radius."""
    spur = read_scene(SCENES / "mesh_cycle_spur.toml").with_changes(CROWNED)
    every = {radius: Solved.of(spur.with_changes(rounded(tip=radius))) for radius in RADII}
    place = next(at for at in every[RADII[0]].reached if all(at in one.reached for one in every.values()))
    force, found = every[RADII[0]].reached[place][0].solution.load, {}
    for radius, solved in every.items():
        number, contact = int(solved.carried.pairs[place[2]]), solved.reached[place][0].contact
        grid = GridChoice((48, 48), free_edges=solved.free_edges)
        held = solve_under_load(solved.pair, contact, force, grid, solved.bending, number)
        edges = reached_arcs(solved.pair, held)
        one = pressure_at_rounded_edge(solved.pair, held, edges, solved.bending, number, free_edges=solved.free_edges)
        cycle = solved.cycle
        found[radius] = float(np.nanmax(cycle.edge_pressure[cycle.edge_is_rounded])), one.pressure
    return found


def exponents(pressures: Iterable[float]) -> Array:
    """Exponents of pressures over the radii, from one radius to the next."""
    return np.diff(np.log(list(pressures))) / np.diff(np.log(RADII))


def rows_of_radii() -> list[Row]:
    """Exponents over the radii under one force: shown, since where the arc begins moves with its radius."""
    found, limit = exponents(held for _, held in over_radii().values()), "limit of narrow roundings"
    return [
        Row("spur tip, one force", limit, f"exponent, r {first:g} to {last:g}", -1.0 / 3.0, one, None)
        for first, last, one in zip(RADII, RADII[1:], found.tolist(), strict=False)
    ]


SURVEY: dict[str, tuple[str, dict[str, Any]]] = {
    "spur": ("mesh_cycle_spur", CROWNED),
    "helical": ("mesh_cycle_helical", HELICAL),
    "helical askew": ("mesh_cycle_helical", SKEW),
    "misaligned": ("misaligned", {}),
    "spiral bevel": ("mesh_cycle_bevel", {"analysis.torques_Nm": None}),
    "straight bevel": ("straight_bevel", {"load.pinion_torque_Nm": 400.0, "analysis.torques_Nm": None}),
    "face-milled": ("face_milled_19x62", {}),
}
SURVEY_RADII, SURVEY_GRIDS = (0.02, 0.1, 0.5), ("24 x 24", "accuracy 0.001")


@cache
def survey(name: str, radii: tuple[float, ...], grids: tuple[str, ...]) -> tuple[tuple[float, float, float], ...]:
    """By contact: pressure over its bound, estimated error, and what the default misses of the largest pressure.

    Beyond the estimated error of that: where edges cross on 24 x 24 cells, a rounding of 0.02 mm is known to 28 %.
    """
    file, changes = SURVEY[name]
    found = []
    for radius in radii:
        for grid in grids:
            scene = read_scene(SCENES / f"{file}.toml").with_changes(changes | GRIDS[grid] | {"analysis.positions": 3})
            radius = min(radius, 0.29 * scene.pair().module)
            solved = Solved.of(scene.with_changes(rounded(radius, radius)))
            every = {place: solved.peak(place) for place in solved.reached}
            for t in range(solved.cycle.torque.size):
                peaks = [one for place, one in every.items() if place[0] == t and not math.isnan(one.pressure)]
                if not peaks:
                    continue
                largest = max(peaks, key=lambda one: one.pressure)
                told = np.nanmax(
                    np.where(solved.cycle.edge_is_rounded[t], solved.cycle.edge_pressure[t], 0.0), initial=0.0
                )
                missed = max(1.0 - float(told) / largest.pressure - largest.error, 0.0)
                for place, one in every.items():
                    if place[0] == t and not math.isnan(one.pressure):
                        bound = solved.reached[place][1][0].bound
                        found.append((one.pressure / bound, one.error, missed))
    return tuple(found)


def rows_of_survey(radii: tuple[float, ...] = SURVEY_RADII, grids: tuple[str, ...] = SURVEY_GRIDS) -> list[Row]:
    """Largest ratio of found pressures to their bounds, and what the default leaves out."""
    table = []
    for name in SURVEY:
        numbers = np.array(survey(name, radii, grids)).reshape(-1, 3)
        ratio, told = float(numbers[:, 0].max()), f"of {len(numbers)} contacts"
        less = float(numbers[:, 2].max())
        table += [
            Row(
                f"{name}, found over bound",
                "bound",
                "above 1",
                0.0,
                max(ratio - 1.0, 0.0),
                0.0,
                note=f"{ratio:.3f}, {told}",
            ),
            # Where edges cross, the default makes columns for those alone that can hold the largest pressure.
            Row(f"{name}, all contacts", "largest", "another largest pressure", 0.0, less, OTHER_LARGEST),
        ]
    return table


@cache
def times() -> dict[str, float]:
    """Processor time [s] of a mesh cycle, medians of runs that take turns: sharp, rounded, and all contacts solved."""
    scene = read_scene(SCENES / "mesh_cycle_helical.toml")
    blunt = scene.with_changes(rounded(tip=0.2))
    scenes = {"sharp": scene, "rounded": blunt, "all": blunt.with_changes({"analysis.edge_pressures": "all"})}
    with one_thread(), warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        analyse(scene)  # models of the teeth are known from here on
        calls = {name: partial(analyse, one) for name, one in scenes.items()}
        return medians(take_times(calls, RUNS, time.process_time))


def rows() -> list[Row]:
    """Some columns, grids and bounds."""
    on_grids = rows_of_grids(("helical tip, r 0.2", "misaligned, r 0.2"), ("24 x 24", "accuracy 0.01", "96 x 96"))
    return [*rows_of_some_columns(), *on_grids, *rows_of_survey(SURVEY_RADII[1:2], SURVEY_GRIDS[:1])]


def whole_rows() -> list[Row]:
    """Columns, grids, radii, bounds."""
    return [*rows_of_columns(), *rows_of_grids(), *rows_of_radii(), *rows_of_survey()]


def table_of_columns() -> str:
    """Peaks on finer and finer columns."""
    several = " | ".join(f"x {one:g}, MPa" for one in FINENESSES)
    lines = []
    for case in CASES:
        for one in refined(case):
            cells = [f"{one.share:.2f}", *formatted(".0f", one.bound, *one.peaks, one.found.pressure)]
            lines.append([one.case, *cells, f"{100.0 * one.error:+.2f}", f"{100.0 * one.found.error:.1f}"])
    head = f"contact | share of the force | bound MPa | {several} | finest, MPa | analysis, MPa | error % | estimate %"
    return table(head, lines)


def table_of_grids() -> str:
    """Largest pressures over the grids."""
    return table(
        ["contact", *GRIDS],
        ([name, *formatted(".0f", *over_grids(name, tuple(GRIDS)).values())] for name in ON_SEVERAL),
    )


def table_of_radii() -> str:
    """Pressures of a spur tip over its radius, and exponents from one radius to the next."""
    lines = []
    mesh, held = zip(*over_radii().values(), strict=True)
    slopes = [["", ""], *(formatted(".3f", a, b) for a, b in zip(exponents(mesh), exponents(held), strict=True))]
    for radius, first, second, (a, b) in zip(RADII, mesh, held, slopes, strict=True):
        lines.append([f"{radius:g}", f"{first:.0f}", a, f"{second:.0f}", b])
    return table("radius mm | in the mesh, MPa | exponent | under one force, MPa | exponent", lines)


def table_of_survey() -> str:
    """Pressures over their bounds."""
    lines = []
    for name in SURVEY:
        every = np.array(survey(name, SURVEY_RADII, SURVEY_GRIDS)).reshape(-1, 3)
        close = every[:, 1] <= rounded_edge.LARGE_ERROR
        ratios, others = every[close, 0], every[~close, 0]
        cells = [len(every), *formatted(".2f", ratios.min(), np.median(ratios), ratios.max())]
        lines.append([name, *cells, f"{others.max():.2f}" if others.size else "none"])
    return table("gears | contacts | least | median | largest | largest, estimated error above 3 %", lines)


TEXT = """# Pressure at rounded edges of gears

Written by `python -m validation.loaded.rounded_edges`; [peak pressure at rounded edges](rounded_edge.md) has the
contacts without gears and the closed form.

{machine}; one thread.

## Finer and finer columns

Contacts of mesh cycles that carry more than a twentieth of their position's force, up to four of each scene, those with
the highest bound first. Columns are so many times as fine as the first ones of an analysis, beside the edge and
away from it; the finest ones two to four times. The error is that of an analysis against the finest columns, beside
it what it estimates: the change from coarser columns, and at least {by_cells} over the number of cells on the pressed
part of the rounding, {crossing} where two edges cross. Share is that of the position's force.

{columns}

With sharp ends the line of contact at a rounded tip ends in a sharp corner. There half-spaces have a pressure without
a limit: {corner} MPa on {first} to {last} rows along the tip. With free edges the pressure there is lower, but still
depends on the rows by up to 7 %. The estimated error is infinite: give the face ends a radius, too.

## Grids

Largest pressure [MPa] at a rounded edge in a mesh cycle, by the grid on which the tooth pairs share
the load.

{grids}

## Radius

Tip of the crowned spur pair: the largest pressure of 25 positions, and that of one contact under the same force.

{radii}

In the limit of narrow roundings the exponent is -1/3. With a larger rounding the arc begins farther from the tip, so
that more of the contact is cut off. In the end the whole contact lies on the arc, like that of a cylinder (-1/2). In
the mesh the load also moves to other teeth, and the position with the largest pressure changes.

## Found pressures over their bounds

Gears with all edges rounded by {several} mm (no more than 0.29 modules), 24 x 24 cells and an accuracy of 1e-3.
Contacts are left out whose bound is below the largest pressure found.

{survey}

## Time

The helical mesh cycle of three torques and 33 positions, processor time: {sharp:.2f} s with sharp edges,
{most_time:.2f} s with tips rounded by 0.2 mm ({ratio:.2f} times), {every:.2f} s with `edge_pressures = "all"`
({ratio_all:.2f} times); medians of {runs} runs that take turns.
"""


def page() -> Page:
    """Measure everything; print the rows, too."""
    sharp, most, every = times().values()
    text = TEXT.format(
        machine=machine(),
        by_cells=f"{100.0 * edges_of_gears.LEFT_BY_CELLS:.0f} %",
        crossing=f"{100.0 * edges_of_gears.LEFT_BESIDE_CROSSING:.0f} %",
        columns=table_of_columns(),
        corner=", ".join(f"{peak:.0f}" for peak in corner_peaks()),
        first=CORNER_ROWS[0],
        last=CORNER_ROWS[-1],
        grids=table_of_grids(),
        radii=table_of_radii(),
        survey=table_of_survey(),
        several=", ".join(f"{one:g}" for one in SURVEY_RADII),
        sharp=sharp,
        most_time=most,
        ratio=most / sharp,
        every=every,
        ratio_all=every / sharp,
        runs=RUNS,
    )
    print(render(whole_rows()))
    return Page("rounded_edges_of_gears", text)


if __name__ == "__main__":
    write_page(__doc__, page)
