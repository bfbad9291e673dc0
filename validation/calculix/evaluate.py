"""From the files of a run to the numbers that are kept."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from validation.calculix.deck import THICKNESS, PlaneDeck
from validation.calculix.mesh_position import Position
from validation.calculix.model import touching_pairs
from validation.calculix.run import Run
from validation.calculix.tooth_form import Array

FIT_ABOVE = 0.5
"""Nodes with more than this part of the largest pressure shape the parabola of its square."""
AT_CORNER = 0.02
"""A contact that comes this close to a tip circle [mm] is one of the tip corner."""
FACE_OF_NOTHING = 1e-3
"""Tooth pairs with less than this share of the torque count as apart."""


@dataclass(frozen=True)
class PairResult:
    """What one tooth pair carries.

    Attributes
    ----------
    pair : int
    load_share : float
        Of the pinion's torque.
    line_load : float [N/mm]
        Normal force.
    peak_pressure : float [MPa]
        Largest of the nodes.
    fitted_pressure, half_width : float [MPa], [mm]
        Of the half ellipse through the pressures.
    pinion_radius, wheel_radius : float [mm]
        Where the fitted pressure is largest.
    corner : str
        "pinion" or "wheel" if the contact reaches the tip corner of that gear, else "no".
    """

    pair: int
    load_share: float
    line_load: float
    peak_pressure: float
    fitted_pressure: float
    half_width: float
    pinion_radius: float
    wheel_radius: float
    corner: str


@dataclass(frozen=True)
class PositionResult:
    """Loaded mesh at one position.

    Attributes
    ----------
    pinion_angle : float [rad]
        phi1 under load.
    transmission_error : float [um]
        r_b2 (phi2 - z1/z2 phi1), negative: the wheel is behind.
    mesh_stiffness : float [N/(mm um)]
        Between 96 and 100 % of the torque.
    pairs : tuple of PairResult
    """

    pinion_angle: float
    transmission_error: float
    mesh_stiffness: float
    pairs: tuple[PairResult, ...]


def evaluate(position: Position, deck: PlaneDeck, run: Run) -> PositionResult:
    """Results of a run in the units in which they are kept."""
    turned = run.hub_displacement / position.pinion.bore_radius
    deflection = turned * position.pinion.base_radius
    torque = deck.hub_force * position.pinion.bore_radius
    return PositionResult(
        pinion_angle=position.pinion_angle + float(turned[-1]),
        transmission_error=-1e3 * (position.setback + float(deflection[-1])),
        mesh_stiffness=_stiffness(deck, position, deflection),
        pairs=tuple(
            _pair(position, pair, run, torque)
            for pair in deck.flanks
            if abs(run.forces[-1][pair].pinion_torque) > FACE_OF_NOTHING * torque
        ),
    )


def fit_half_ellipse(place: Array, pressure: Array) -> tuple[float, float, float]:
    """Parabola through p^2: centre, half width [mm] and largest pressure [MPa]; NaN where it opens upwards.

    Parameters
    ----------
    place : (n,) array [mm]
    pressure : (n,) array [MPa]
    """
    upper = pressure > FIT_ABOVE * pressure.max()
    middle = place[upper].mean()
    if upper.sum() < 4:
        return middle, math.nan, math.nan
    square, slope, constant = np.polyfit(place[upper] - middle, pressure[upper] ** 2, 2)
    if square >= 0.0:
        return middle, math.nan, math.nan
    centre = -0.5 * slope / square
    highest = constant + 0.5 * slope * centre
    return middle + centre, math.sqrt(-highest / square), math.sqrt(highest)


def _stiffness(deck: PlaneDeck, position: Position, deflection: Array) -> float:
    """Line load over deflection between the last two steps [N/(mm um)]; NaN with one step alone."""
    if len(deck.load_steps) < 2:
        return math.nan
    force = deck.hub_force * position.pinion.bore_radius / position.pinion.base_radius / THICKNESS
    return force * (deck.load_steps[-1] - deck.load_steps[-2]) / (1e3 * float(deflection[-1] - deflection[-2]))


def _pair(position: Position, pair: int, run: Run, torque: float) -> PairResult:
    """Results of one tooth pair from the last step."""
    force = run.forces[-1][pair]
    angle = position.pinion_tooth(pair)
    own = _tooth_of(run.points, angle, position) & (run.pressures[-1] > 0.0)
    points, pressure = run.points[own], run.pressures[-1][own]
    radius = np.hypot(points[:, 0], points[:, 1])
    arc = (radius**2 - position.pinion.base_radius**2) / (2.0 * position.pinion.base_radius)
    centre, half_width, fitted = fit_half_ellipse(arc, pressure)
    order = np.argsort(arc)
    x, y = (np.interp(centre, arc[order], points[order, k]) for k in (0, 1))
    return PairResult(
        pair=pair,
        load_share=force.pinion_torque / torque,
        line_load=force.normal_force / THICKNESS,
        peak_pressure=float(pressure.max()),
        fitted_pressure=fitted,
        half_width=half_width,
        pinion_radius=math.hypot(x, y),
        wheel_radius=math.hypot(x - position.centre_distance, y),
        corner=_corner(position, points),
    )


def _tooth_of(points: Array, angle: float, position: Position) -> np.ndarray:
    """Which points belong to the pinion's tooth whose middle is at an angle."""
    away = np.arctan2(points[:, 1], points[:, 0]) - angle
    return np.abs((away + math.pi) % (2.0 * math.pi) - math.pi) < 0.5 * position.pinion.pitch


def _corner(position: Position, points: Array) -> str:
    """Whose tip corner the loaded points reach."""
    if np.hypot(points[:, 0], points[:, 1]).max() > position.pinion.tip_radius - AT_CORNER:
        return "pinion"
    from_wheel = np.hypot(points[:, 0] - position.centre_distance, points[:, 1])
    return "wheel" if from_wheel.max() > position.wheel.tip_radius - AT_CORNER else "no"


def truncated(position: Position, deck: PlaneDeck, run: Run) -> list[int]:
    """Pairs whose pressure reaches the last node of the contact surface although the flank goes on."""
    found = []
    for pair in touching_pairs(position):
        own = _tooth_of(run.points, position.pinion_tooth(pair), position) & (run.pressures[-1] > 0.0)
        radius = np.hypot(run.points[own, 0], run.points[own, 1])
        nodes = deck.pinion.nodes[deck.pinion.elements[deck.flanks[pair][0]][:, [0, 1]].ravel()]
        ends = np.hypot(nodes[:, 0], nodes[:, 1])
        inside = ends.min() > position.pinion.root_radius and radius.size
        if inside and (radius.min() <= ends.min() or ends.max() <= radius.max() < position.pinion.tip_radius - 1e-6):
            found.append(pair)
    return found
