"""The figures of a design, each declared once: smooth functions of errors or pressures, with their derivatives.

Those that are smoothed, and so another number than the key figure of a result, have a name of their own.

Result of a design: what its dataset holds, and its file.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import GEARS, Array, real
from loaded_tca.compliance import RootStress
from loaded_tca.errors import InputError, require
from loaded_tca.loaded.held_contacts import HeldContacts
from loaded_tca.loaded.sensitivity import LoadedGrid
from loaded_tca.pairs.kinematics import surface_motions
from loaded_tca.results.face_slopes import face_load_factor_slopes
from loaded_tca.results.figure_slopes import EXPONENT, pressure_norm
from loaded_tca.results.files import DESIGN, FilePath, Part, read_dataset, write_dataset
from loaded_tca.results.load_factors import load_factors
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.root_stress import root_stress_of_gear, stress_at_extreme

if TYPE_CHECKING:
    import xarray

SMOOTHING = 0.01
"""tau of the span [um]: it exceeds the span by 2 tau ln(N) at the most."""
ROOT_EXPONENT = 50.0
"""Of the norm of the root tension over the positions: 3 % above the largest if four of them are alike."""

OBJECTIVES = ("mean", "mean + k sigma", "percentile")

Roots = Sequence[RootStress]
"""Root stress of unit forces on pinion and wheel; nothing where the scene does not ask for it."""
Positions = Sequence[Sequence[LoadedGrid]]
"""Loaded contacts of each position, the last one of the scene left out."""


def pressure(_: Roots, __: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """Norm of the pressure [MPa] of all cells that have no end of a flank beside them, and its derivatives."""
    return mean_pressure_norm([[_map_of(grid) for grid in position] for position in positions], at_edges=False)


def edge_pressure(_: Roots, __: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """The same of the cells that have one beside them."""
    return mean_pressure_norm([[_map_of(grid) for grid in position] for position in positions], at_edges=True)


def face_load_factor(_: Roots, held: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """K_Hbeta and its derivatives, the strip with the largest force held."""
    maps = [tuple(_map_of(grid) for grid in position) for position in positions]
    path, closed = held.mesh.leading_contact, (*maps, ())  # of load factors the last position does not count
    factor = float(load_factors(held.pair, path, (closed,), math.nan)[0][0])
    slopes = face_load_factor_slopes(held.pair, path, closed)
    return factor, [one for row in slopes for one in row if one is not None]


def loss_factor(_: Roots, held: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """Load loss factor H_VL, the mean over the positions, and its derivatives: the sliding velocities of the cells."""
    grids = [grid for position in positions for grid in position]
    origins, axes = (
        np.array([getattr(grid.separation, name) for grid in grids]).reshape(-1, *shape)
        for name, shape in (("origin", (3,)), ("axes", (3, 3)))
    )
    pinion, wheel = surface_motions(held.pair, origins, axes)
    sliding, number, loss, slopes = pinion.less(wheel, held.pair.ratio), 0, 0.0, []
    for position in positions:
        forces = [grid.pressure * math.prod(grid.separation.spacing) for grid in position]
        levers = [abs(grid.contact.pinion_lever) for grid in position]
        torque = sum(lever * float(force.sum()) for lever, force in zip(levers, forces, strict=True))
        for grid, force in zip(position, forces, strict=True):
            across = sliding.across(number, grid.separation.y)
            speed = np.hypot(across, sliding.along(number, grid.separation.x)[:, None])
            slopes.append(speed / (torque * len(positions)))
            loss += float((force * slopes[-1]).sum())
            number += 1
    return loss, slopes


def root_tension(gear: int, roots: Roots, held: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """Smooth maximum over the positions of the root tension of a gear [MPa], and its derivatives."""
    root, numbers = roots[gear], sorted({grid.number for position in positions for grid in position})
    rows = [{grid.number: _map_of(grid) for grid in position} for position in positions]
    maps = (tuple(tuple(row.get(number) for number in numbers) for row in rows),)
    stresses = root_stress_of_gear(held.pair, gear, root, numbers, np.ones((1, len(rows)), dtype=bool), maps)
    tension, slopes = np.zeros(len(positions)), []
    for n, position in enumerate(positions):
        place = stresses["root_tension_place"][0, n].tolist()
        loads, per_force = stress_at_extreme(held.pair, gear, root, position, place)
        by_slice = [per_force(line) for line, _ in loads]
        tension[n] = sum(own @ forces for own, (_, forces) in zip(by_slice, loads, strict=True))
        slopes.append([np.broadcast_to(own, grid.active.shape) for own, grid in zip(by_slice, position, strict=True)])
    norm = root_tension_norm(tension)
    weights = (tension / norm) ** (ROOT_EXPONENT - 1.0)
    return norm, [weight * own for weight, row in zip(weights, slopes, strict=True) for own in row]


def root_tension_norm(tension: Array) -> float:
    """Norm of the root tension of the positions (n,) [MPa]: its largest one, or more by up to ln n over the exponent.

    Examples
    --------
    >>> round(root_tension_norm(np.array([200.0, 300.0, 290.0])), 1)
    301.0
    """
    largest = float(tension.max())
    return largest * float(((tension / largest) ** ROOT_EXPONENT).sum()) ** (1.0 / ROOT_EXPONENT)


def _map_of(grid: LoadedGrid) -> PressureMap:
    one = grid.separation
    return PressureMap(one.x, one.y, one.spacing, grid.pressure, one.gap, one.origin, one.axes, one.force_line)


def mean_pressure_norm(positions: Sequence[Sequence[PressureMap]], *, at_edges: bool) -> tuple[float, list[Array]]:
    """Norm [MPa] of the pressures of cells beside the ends of the flanks, or of all others, as a mean over positions.

    Also returns its derivatives by the forces of the cells of all maps [1/mm^2].
    """
    by_force = []
    for one in (one for position in positions for one in position):
        kept = np.where(one.beside_end == at_edges, one.pressure, 0.0)
        by_force.append(pressure_norm(kept, np.ones(kept.shape), one.spacing))
    largest = max((norm for norm, _ in by_force), default=0.0)
    if largest == 0.0:
        return 0.0, [slopes for _, slopes in by_force]
    norm = largest * (sum((own / largest) ** EXPONENT for own, _ in by_force) / len(positions)) ** (1.0 / EXPONENT)
    return norm, [slopes * (own / norm) ** (EXPONENT - 1.0) / len(positions) for own, slopes in by_force]


def span(errors: Array, _: float) -> tuple[float, Array]:
    """Largest less smallest of errors (n,), and its derivatives, those at these two places."""
    weights = np.zeros(errors.size)
    weights[errors.argmax()] += 1.0
    weights[errors.argmin()] -= 1.0
    return float(np.ptp(errors)), weights


def smooth_span(errors: Array, smoothing: float) -> tuple[float, Array]:
    """The same with smooth maxima, which are larger by up to ``smoothing`` ln n each.

    Examples
    --------
    >>> value, weights = smooth_span(np.array([0.0, 0.3, 0.3]), 0.01)
    >>> round(value, 6), weights.round(6)
    (0.306931, array([-1. ,  0.5,  0.5]))
    """
    value, weights = 0.0, np.zeros(errors.size)
    for sign in (1.0, -1.0):
        top = float((sign * errors).max())
        parts = np.exp((sign * errors - top) / smoothing)
        value += top + smoothing * float(np.log(parts.sum()))
        weights += sign * parts / parts.sum()
    return value, weights


def mean(errors: Array, _: float) -> tuple[float, Array]:
    """Mean of errors (n,), and its derivatives."""
    return float(errors.mean()), np.full(errors.size, 1.0 / errors.size)


@dataclass(frozen=True)
class FigureOfErrors:
    """A figure of the transmission errors of the positions of a pitch [um], with its derivatives by these.

    Attributes
    ----------
    unit, text : str
        What it measures.
    of : callable
        Of errors (n,) [um] and tau of the smooth span [um]: value and derivatives (n,).
    """

    unit: str
    text: str
    of: Callable[[Array, float], tuple[float, Array]]
    is_of_roots = False
    is_confirmed = True


@dataclass(frozen=True)
class FigureOfForces:
    """A figure of the forces of cells, with its derivatives by these.

    Attributes
    ----------
    unit, text : str
        What it measures.
    of : callable
        Of models of root stress, held contacts and positions: value and derivatives, an array for each contact.
    is_of_roots : bool
        Whether only scenes that ask for root stress have it.
    is_confirmed : bool
        Whether a limit on it must hold in the full analysis, too.
    note : str
        Beside a limit in a report.
    """

    unit: str
    text: str
    of: Callable[[Roots, HeldContacts, Positions], tuple[float, list[Array]]]
    is_of_roots: bool = False
    is_confirmed: bool = True
    note: str = ""


FIGURES: dict[str, FigureOfErrors | FigureOfForces] = {
    "span_um": FigureOfErrors("um", "peak-to-peak loaded transmission error at the wheel's base circle", span),
    "smooth_span_um": FigureOfErrors(
        "um", "smooth peak-to-peak loaded transmission error at the wheel's base circle", smooth_span
    ),
    "mean_transmission_error_um": FigureOfErrors(
        "um", "mean loaded transmission error at the wheel's base circle", mean
    ),
    "pressure_MPa": FigureOfForces(
        "MPa",
        "norm of the pressure away from the ends of the flanks",
        pressure,
        note=", above or below the peak pressure by up to a third",
    ),
    "edge_pressure_norm_MPa": FigureOfForces(  # by the analysis a number of the grid where edges are sharp
        "MPa", "norm of the pressure beside the ends of the flanks", edge_pressure, is_confirmed=False
    ),
    "face_load_factor": FigureOfForces("1", "K_Hbeta", face_load_factor),
    "loss_factor": FigureOfForces("1", "load loss factor H_VL", loss_factor, is_confirmed=False),
    **{
        f"{name}_root_tension_norm_MPa": FigureOfForces(
            "MPa", f"root tension of the {name}, smooth maximum", partial(root_tension, gear), is_of_roots=True
        )
        for gear, name in enumerate(GEARS)
    },
}
"""Name, which ends in the unit -> figure of a design under one torque with one sample."""


@dataclass(frozen=True)
class Objective:
    """What is minimised: a figure, mean over the torques, as it scatters over the samples.

    Attributes
    ----------
    kind : {"mean", "mean + k sigma", "percentile"}
    k : float
        Standard deviations on top of the mean.
    percentile : float
        From 0 to 100.
    figure : str
        One of ``FIGURES``.
    """

    kind: str = "mean + k sigma"
    k: float = 1.0
    percentile: float = 90.0
    figure: str = "smooth_span_um"

    def __post_init__(self) -> None:
        require(
            (self.kind in OBJECTIVES, f"objective: {self.kind!r:.60}; allowed {', '.join(map(repr, OBJECTIVES))}"),
            (self.figure in FIGURES, f"figure: {self.figure!r:.60}; allowed {', '.join(FIGURES)}"),
            (0.0 <= real(self.k) < math.inf, f"k: {self.k!r:.60}; allowed a finite number from 0 on"),
            (0.0 <= real(self.percentile) <= 100.0, f"percentile: {self.percentile!r:.60}; allowed 0 to 100"),
        )

    @property
    def told(self) -> str:
        """In words."""
        if self.kind == "percentile":
            return f"percentile {self.percentile:g}"
        return self.kind if self.kind == "mean" else f"mean + {self.k:g} sigma"

    def of(self, figures: Array) -> tuple[float, Array]:
        """Value of figures (sample, torque), and its derivatives to them."""
        values = figures.mean(axis=1)
        if self.kind == "percentile":
            order, place = np.argsort(values), 0.01 * self.percentile * (values.size - 1)
            low, part = int(place), place - int(place)
            weights = np.zeros(values.size)
            weights[order[low]] += 1.0 - part
            weights[order[min(low + 1, values.size - 1)]] += part
            value = float(weights @ values)
        else:
            weights, value, sigma = np.full(values.size, 1.0 / values.size), float(values.mean()), float(values.std())
            if self.kind == "mean + k sigma":
                value += self.k * sigma
                weights += self.k * (values - values.mean()) / (values.size * sigma) if sigma > 0.0 else 0.0
        return value, np.broadcast_to(weights[:, None] / figures.shape[1], figures.shape)


@dataclass(frozen=True)
class Limit:
    """Highest value of a figure under some torques, with every sample."""

    figure: str
    torques: tuple[int, ...]
    highest: float


TEXTS, NUMBERS = ("scene_toml", "warnings", "objective", "limits"), ("value", "objective", "held_objective")
"""Attributes and variables that every result has, besides its figure."""

ANALYSED = "design", "sample", "torque", "position"
PARTS: dict[str, Part] = {
    "value": (("design", "key"), "1", "value of the key, in the unit at the end of its name"),
    "range": (("key", "bound"), "1", "lowest and highest value of the key"),
    "scatter": (("sample", "scatter_key"), "1", "value of the key, or its deviation from that of the design"),
    "transmission_error": (ANALYSED, "rad", "loaded transmission error"),
    "peak_pressure": (ANALYSED, "MPa", "largest peak pressure of the tooth pairs"),
    "transverse_load_factor": (ANALYSED[:3], "1", "K_Halpha"),
    **{name: (ANALYSED[:3], figure.unit, figure.text) for name, figure in FIGURES.items()},
    "objective": (ANALYSED[:1], "", "what was minimised, by the full analysis"),
    "held_transmission_error": (
        (*ANALYSED[:3], "held_position"),
        "rad",
        "loaded transmission error on held contacts, without the last position, the first one of the next pitch",
    ),
    **{
        f"held_{name}": (ANALYSED[:3], figure.unit, f"{figure.text}, on held contacts")
        for name, figure in FIGURES.items()
    },
    "held_objective": (ANALYSED[:1], "", "what was minimised, on held contacts"),
    "history_x": (("evaluation", "key"), "1", "value of the key"),
    "history_objective": (("evaluation",), "", "objective on held contacts"),
    "history_excess": (("evaluation",), "1", "part by which a figure exceeds its limit; negative within all limits"),
}
"""What the dataset of a result holds."""


EARLIER = {
    "edge_pressure_MPa": "edge_pressure_norm_MPa",
    **{f"{name}_root_tension_MPa": f"{name}_root_tension_norm_MPa" for name in GEARS},
}
"""Names of figures in files before version 0.3 -> their names now."""


@dataclass(frozen=True, eq=False)
class DesignResult:
    """Result of a design: start and optimum, with the figures of both by the whole analysis.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over ``design`` ("start", "optimum"), sample, torque, position and key: ``value`` of the keys, analysed
        ``transmission_error`` [rad], ``peak_pressure`` [MPa], load factors and ``FIGURES``; those on held contacts as
        ``held_...``; ``history_x``, ``history_objective`` and ``history_excess`` over the evaluations; ``range`` of the
        keys and ``scatter``; ``attrs`` has in words ``limits``, ``distributions`` of the scatter, ``seeds`` and
        ``warnings``, each with the number of analyses that it concerns.
    """

    dataset: xarray.Dataset

    def __repr__(self) -> str:
        before, after = self.objective
        warnings = self.dataset.attrs["warnings"].count("\n") + 1 if self.dataset.attrs["warnings"] else 0
        values = ", ".join(f"{key} = {value:.4g}" for key, value in self.optimum.items())
        figure = f"{self.dataset.attrs['objective']} of {self.dataset.attrs['figure']}"
        warned = f", {warnings} accuracy warnings in dataset.attrs" if warnings else ""
        return f"DesignResult({figure}: {before:.4g} -> {after:.4g}, {values}{warned})"

    @property
    def start(self) -> dict[str, float]:
        """Values of the keys where the design started."""
        return self._values("start")

    @property
    def optimum(self) -> dict[str, float]:
        """Values of the keys that were found."""
        return self._values("optimum")

    def _values(self, design: str) -> dict[str, float]:
        values = self.dataset["value"].sel(design=design).values.tolist()
        return dict(zip(self.dataset["key"].values.tolist(), values, strict=True))

    @property
    def objective(self) -> tuple[float, float]:
        """Objective of start and optimum by the full analysis."""
        before, after = self.dataset["objective"].values.tolist()
        return before, after

    @property
    def held_objective(self) -> tuple[float, float]:
        """Objective of start and optimum on held contacts."""
        before, after = self.dataset["held_objective"].values.tolist()
        return before, after

    @property
    def evaluations(self) -> int:
        """How many designs were evaluated."""
        return int(self.dataset.sizes["evaluation"])

    def save(self, path: FilePath) -> None:
        """Write the result to a NetCDF-3 file, to be read by :func:`load_design`."""
        write_dataset(path, self.dataset)


def load_design(path: FilePath) -> DesignResult:
    """Read the result of a design.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, is no design, or lacks what all designs have.
    """
    dataset = read_dataset(path)
    if dataset.attrs.get("kind") != DESIGN:
        raise InputError(f"{path}: a result of loaded_tca, but no design; read it with load_result or load_study")
    renamed = {held + before: held + now for held in ("", "held_") for before, now in EARLIER.items()}
    dataset = dataset.rename({before: now for before, now in renamed.items() if before in dataset})
    for name in ("figure", "limits"):
        if isinstance(text := dataset.attrs.get(name), str):
            lines = (line.split(" ", 1) for line in text.splitlines())
            dataset.attrs[name] = "\n".join(" ".join([EARLIER.get(word, word), *rest]) for word, *rest in lines)
    figure = dataset.attrs.get("figure")
    require(
        *((isinstance(dataset.attrs.get(name), str), f"{name}: missing, or no text") for name in TEXTS),
        *((name in dataset, f"{name}: missing") for name in NUMBERS),
        (str(figure) in FIGURES, f"figure: {figure!r:.60}; allowed {', '.join(FIGURES)}"),
        owner=f"{path}: not the result of a design",
    )
    return DesignResult(dataset)
