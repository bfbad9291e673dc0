"""Run of the crowned pair: line load along the face, layer by layer."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from validation.calculix.case import FACE_WIDTH
from validation.calculix.crowned import CROWNING, LAYERS, SPATIAL_MESHING, crowned_deck
from validation.calculix.evaluate import fit_half_ellipse
from validation.calculix.model import Meshing
from validation.calculix.run import Run, run
from validation.calculix.tooth_form import Array

FIRST_LAG = {"crowned": 0.01345, "flat": 0.0102}
"""Guesses of the setback that places the wheel [mm]; the results do not depend on them."""
AMOUNT = {"crowned": CROWNING, "flat": 0.0}
"""Lead crowning of the pinion [mm]."""
PEAK_LAYERS = 6
"""Layers beside mid-face whose mean line loads give the even parabola of fourth order with the peak."""


@dataclass(frozen=True)
class CrownedResult:
    """The crowned pair at the pitch point.

    Attributes
    ----------
    transmission_error : float [um]
        r_b2 (phi2 - z1/z2 phi1).
    height : list of float [mm]
        Middle of each layer of the half face.
    line_load : list of float [N/mm]
        Mean over the layer.
    covered_width : list of float [mm]
        Area under pressure over the height of the layer.
    peak_line_load : float [N/mm]
        At mid-face, from a parabola of fourth order.
    total : float [N]
        Of the whole face.
    mid_pressure : float [MPa]
        Of the half ellipse through the pressures at mid-face.
    mid_half_width : float [mm]
    nodes, iterations : int
    seconds : float
        Processor time of the program on one core.
    """

    transmission_error: float
    height: list[float]
    line_load: list[float]
    covered_width: list[float]
    peak_line_load: float
    total: float
    mid_pressure: float
    mid_half_width: float
    nodes: int
    iterations: int
    seconds: float


def run_crowned(
    work: Path, name: str = "crowned", layers: int = LAYERS, meshing: Meshing = SPATIAL_MESHING
) -> CrownedResult:
    """Results of the crowned pair or the flat one, run unless they are in the directory already.

    Parameters
    ----------
    work : Path
        Directory for the files.
    name : {"crowned", "flat"}
    layers : int
    meshing : Meshing
    """
    kept = work / f"{name}_{layers}.json"
    if kept.exists():
        return CrownedResult(**json.loads(kept.read_text()))
    position, deck = crowned_deck(FIRST_LAG[name], meshing, layers, AMOUNT[name])
    done = run(deck.text(), kept.with_suffix(""), list(range(layers)), len(deck.load_steps))
    step = 0.5 * FACE_WIDTH / layers
    force = np.array([done.forces[-1][layer].normal_force for layer in range(layers)])
    deflection = float(done.hub_displacement[-1]) / position.pinion.bore_radius * position.pinion.base_radius
    pressure, half_width = _at_mid_face(done, position.pinion.base_radius)
    result = CrownedResult(
        transmission_error=-1e3 * (position.setback + deflection),
        height=(step * (np.arange(layers) + 0.5)).tolist(),
        line_load=(force / step).tolist(),
        covered_width=[done.forces[-1][layer].area / step for layer in range(layers)],
        peak_line_load=peak_of_layers(force / step, step),
        total=2.0 * float(force.sum()),
        mid_pressure=pressure,
        mid_half_width=half_width,
        nodes=deck.wheel.last_node,
        iterations=done.iterations,
        seconds=done.seconds,
    )
    kept.write_text(json.dumps(asdict(result)))
    return result


def peak_of_layers(line_load: Array, step: float) -> float:
    """Value at mid-face of the even polynomial of fourth order whose means over the first layers are given.

    Parameters
    ----------
    line_load : (layers,) array [N/mm]
        Means over layers of equal height from mid-face on.
    step : float [mm]
        Height of a layer.

    Examples
    --------
    >>> round(peak_of_layers(np.array([100.0 - 1.0 / 3.0, 100.0 - 7.0 / 3.0, 100.0 - 19.0 / 3.0]), 1.0), 9)
    100.0
    """
    count = min(PEAK_LAYERS, line_load.size)
    ends = step * np.arange(count + 1)
    means = np.stack([np.diff(ends ** (power + 1)) / ((power + 1) * step) for power in (0, 2, 4)], axis=-1)
    return float(np.linalg.lstsq(means, line_load[:count], rcond=None)[0][0])


def _at_mid_face(done: Run, base_radius: float) -> tuple[float, float]:
    """Largest pressure and half width at z = 0; NaN if hardly anything touches there."""
    middle = (np.abs(done.points[:, 2]) < 1e-6) & (done.pressures[-1] > 0.0)
    if not middle.any():
        return math.nan, math.nan
    arc = (done.points[middle, 0] ** 2 + done.points[middle, 1] ** 2 - base_radius**2) / (2.0 * base_radius)
    _, half_width, pressure = fit_half_ellipse(arc, done.pressures[-1][middle])
    return pressure, half_width
