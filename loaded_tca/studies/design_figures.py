"""The figures of a design, each declared once: smooth functions of errors or pressures, with their derivatives.

Those that are smoothed, and so another number than the key figure of a result, have a name of their own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from loaded_tca.arrays import GEARS, Array, real
from loaded_tca.compliance import RootStress
from loaded_tca.errors import require
from loaded_tca.loaded.held_contacts import HeldContacts
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.pairs.kinematics import surface_motions
from loaded_tca.plain import plain
from loaded_tca.rating.inputs import FEWEST as FEWEST_RATED
from loaded_tca.rating.utilisation import Utilisation
from loaded_tca.results.face_slopes import face_load_factor_slopes
from loaded_tca.results.figure_slopes import EXPONENT, pressure_norm
from loaded_tca.results.load_factors import load_factors
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.root_stress import root_stress_of_gear, stress_at_extreme
from loaded_tca.scene import Scene
from loaded_tca.scene.rating import is_rated
from loaded_tca.tribology.tribology import FEWEST

SMOOTHING = 0.01
"""tau of the span [um]: it exceeds the span by 2 tau ln(N) at the most."""
NEAR_END = 0.05
"""Distance over the module within which cells lie at the end of a flank. Beside a sharp end the pressure grows with
finer cells; one cell alone would leave the more of that in the norm away from ends, the finer the cells are: twofold
where a contact is a corner of the tip (cells of 4 um). From 0.03 on the norm is that of any grid to 1 %."""
ROOT_EXPONENT = 50.0
"""Of the norm of the root tension over the positions: 3 % above the largest if four of them are alike."""

OBJECTIVES = ("mean", "mean + k sigma", "percentile")

Roots = Sequence[RootStress]
"""Root stress of unit forces on pinion and wheel; nothing where the scene does not ask for it."""
Positions = Sequence[Sequence[LoadedGrid]]
"""Loaded contacts of each position, the last one of the scene left out."""


def pressure(_: Roots, held: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """Norm of the pressure [MPa] away from the ends of the flanks, and its derivatives."""
    maps = [[_map_of(grid) for grid in position] for position in positions]
    return mean_pressure_norm(maps, held.pair.module, at_edges=False)


def edge_pressure(_: Roots, held: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """Norm of the averaged pressure [MPa] at the ends of the flanks, and its derivatives."""
    maps = [[_map_of(grid) for grid in position] for position in positions]
    return mean_pressure_norm(maps, held.pair.module, at_edges=True)


def face_load_factor(_: Roots, held: HeldContacts, positions: Positions) -> tuple[float, list[Array]]:
    """K_Hbeta of the cells, on rounded face ends, too, and its derivatives, the strip with the largest force held."""
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
    place = one.origin, one.axes, one.force_line
    return PressureMap(one.x, one.y, one.spacing, grid.pressure, one.gap, one.cover, *place)


def mean_pressure_norm(
    positions: Sequence[Sequence[PressureMap]], module: float, *, at_edges: bool
) -> tuple[float, list[Array]]:
    """Norm [MPa] of the pressures at the ends of the flanks, or of all others, as a mean over positions.

    Those at the ends are averaged over squares twice as wide as the band there: the largest pressure at a sharp edge
    depends on the cells, the force on a square does not.

    Also returns its derivatives by the forces of the cells of all maps [1/mm^2].
    """
    band, by_force = NEAR_END * module, []
    for one in (one for position in positions for one in position):
        at_end = one.near_end(band)
        own = averaged(one.pressure, one.spacing, 2.0 * band) if at_edges else one.pressure
        norm, slopes = pressure_norm(np.where(at_end == at_edges, own, 0.0), np.ones(own.shape), one.spacing)
        by_force.append((norm, averaged(slopes, one.spacing, 2.0 * band) if at_edges else slopes))
    largest = max((norm for norm, _ in by_force), default=0.0)
    if largest == 0.0:
        return 0.0, [slopes for _, slopes in by_force]
    norm = largest * (sum((own / largest) ** EXPONENT for own, _ in by_force) / len(positions)) ** (1.0 / EXPONENT)
    return norm, [slopes * (own / norm) ** (EXPONENT - 1.0) / len(positions) for own, slopes in by_force]


def averaged(values: Array, spacing: tuple[float, float], width: float) -> Array:
    """Means over squares of a width [mm] about the cells (nx, ny), nothing beyond the grid; of cells, where wider.

    Its matrix is symmetric, so that it takes derivatives by means to those by values, too.

    Examples
    --------
    >>> averaged(np.array([[0.0, 0.0, 9.0, 0.0]]), (1.0, 0.1), 0.2)
    array([[0.  , 2.25, 4.5 , 2.25]])
    """
    for axis, step in enumerate(spacing):
        if width > step:
            reach = math.ceil(0.5 * width / step - 0.5)
            away = step * np.abs(np.arange(-reach, reach + 1))
            parts = np.minimum(0.5 * width - away + 0.5 * step, step) / width
            values = scipy.ndimage.convolve1d(values, parts, axis=axis, mode="constant")
    return values


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
    fewest_positions = 0
    note = ""


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
    fewest_positions : int
        Of scenes that have it.
    note : str
        Beside a limit in a report.
    """

    unit: str
    text: str
    of: Callable[[Roots, HeldContacts, Positions], tuple[float, list[Array]]]
    is_of_roots: bool = False
    fewest_positions: int = 0
    note: str = ""


def _of_root(gear: int, utilisation: Utilisation) -> float:
    return utilisation.roots[gear]


@dataclass(frozen=True)
class FigureOfStrength:
    """A figure of stress over what the gears withstand at the safety that is required, of scenes with strengths.

    Attributes
    ----------
    text : str
        What it measures.
    stress : str
        Name of the figure of stress [MPa].
    factor : callable
        Of the utilisation per unit of stress of a scene under a torque: that of this stress [1/MPa].
    is_of_roots : bool
        Whether only scenes that ask for root stress have it.
    """

    text: str
    stress: str
    factor: Callable[[Utilisation], float]
    is_of_roots: bool = False
    unit = "1"
    fewest_positions = FEWEST_RATED
    note = "; 1: the required local safety"


FIGURES: dict[str, FigureOfErrors | FigureOfForces | FigureOfStrength] = {
    "span_um": FigureOfErrors("um", "peak-to-peak loaded transmission error at the wheel's base circle", span),
    "smooth_span_um": FigureOfErrors(
        "um", "smooth peak-to-peak loaded transmission error at the wheel's base circle", smooth_span
    ),
    "mean_transmission_error_um": FigureOfErrors(
        "um", "mean loaded transmission error at the wheel's base circle", mean
    ),
    "pressure_MPa": FigureOfForces(
        "MPa",
        f"norm of the pressure, farther than {plain(NEAR_END, 6)} modules from the ends of the flanks",
        pressure,
        note="; above the peak pressure where contacts are large, below it where they are small, by up to a third",
    ),
    "edge_pressure_norm_MPa": FigureOfForces(
        "MPa",
        f"norm of the pressure within {plain(NEAR_END, 6)} modules of the ends of the flanks",
        edge_pressure,
        note=f", averaged over squares {plain(2.0 * NEAR_END, 6)} modules wide; not the largest pressure there",
    ),
    "face_load_factor": FigureOfForces("1", "K_Hbeta", face_load_factor),
    "loss_factor": FigureOfForces("1", "load loss factor H_VL", loss_factor, fewest_positions=FEWEST),
    **{
        f"{name}_root_tension_norm_MPa": FigureOfForces(
            "MPa", f"root tension of the {name}, smooth maximum", partial(root_tension, gear), is_of_roots=True
        )
        for gear, name in enumerate(GEARS)
    },
    "flank_utilisation": FigureOfStrength(
        "pressure_MPa over the pitting strength at the required safety", "pressure_MPa", lambda each: each.flank
    ),
    **{
        f"{name}_root_utilisation": FigureOfStrength(
            f"root tension of the {name} over its strength at the required safety",
            f"{name}_root_tension_norm_MPa",
            partial(_of_root, gear),
            is_of_roots=True,
        )
        for gear, name in enumerate(GEARS)
    },
}
"""Name, which ends in the unit -> figure of a design under one torque with one sample."""


def figures_of_strength(scene: Scene) -> dict[str, FigureOfStrength]:
    """Utilisations that a scene has: with strengths and [rating]; of flanks that no cap keeps from showing their load.

    Strengths of flanks are pressures of elastic surfaces, which those under a cap are below.
    """
    if not is_rated(scene):
        return {}
    figures = {name: figure for name, figure in FIGURES.items() if isinstance(figure, FigureOfStrength)}
    if any(material.max_pressure_MPa is not None for material in scene.materials):
        del figures["flank_utilisation"]
    return figures


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
            return f"percentile {plain(self.percentile, 6)}"
        return self.kind if self.kind == "mean" else f"mean + {plain(self.k, 6)} sigma"

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
