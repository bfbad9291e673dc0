"""Planetary stages against closed forms of linear ones, axes that are really displaced, and symmetry.

- Linear meshes have shares in closed form, with the sun rigid and floating: to rounding, 1e-12.
- A pin that is displaced outwards takes e_r (sin alpha_s - sin alpha_r) from the approach: both meshes are traced with
  their centre distances changed by as much, to second order in the error.
- Orders that equal planets cancel vanish beside those of one path, and planets in phase leave all of them: to what
  balances end at, 1e-9.
"""

import math
import warnings
from pathlib import Path

import numpy as np

from loaded_tca.errors import AccuracyWarning
from loaded_tca.stages import Stage, StageResult, analyse_stage, read_stage, rebalanced
from loaded_tca.stages.balance import balance, directions_of, pin_errors
from loaded_tca.unloaded import trace_teeth
from validation.table import Row

CASE = "planetary stages"
STAGES = Path(__file__).parents[2] / "examples" / "stages"
FLANKS = {"analysis.compliance": "contact", "analysis.free_edges": False, "analysis.accuracy": 0.1}
STIFFNESS, TOTAL = 4e5, 4000.0  # N/mm, N
PIN = 0.02  # mm
LINEAR, SYMMETRIC, SECOND_ORDER = 1e-12, 1e-9, 5e-4


def rows() -> list[Row]:
    """Rows of all."""
    return [*linear_rows(), *pin_rows(), *order_rows()]


def short_rows() -> list[Row]:
    """Those without mesh cycles; the tests of stages have the orders that cancel."""
    return [*linear_rows(), *pin_rows()]


def linear_rows() -> list[Row]:
    """Shares of five planets with linear meshes, and pins off by some micrometres."""
    errors = 1e-3 * np.array([2.0, -1.0, 0.5, 0.0, -1.5])
    psi = 2.0 * math.pi * np.arange(5) / 5
    force = np.array([0.0, 500.0, 2000.0, 8000.0])
    directions = directions_of(psi, math.radians(22.0), True)
    base = np.column_stack([np.ones(5), np.cos(psi), np.sin(psi)])
    left = {
        "rigid": errors - errors.mean(),
        "floating": errors - base @ np.linalg.lstsq(base, errors, rcond=None)[0],
    }
    table = []
    for name, support in (("rigid", math.inf), ("floating", 0.0)):
        shares = balance(force, np.outer(np.ones(5), force / STIFFNESS), directions, errors, TOTAL, support).force
        largest = float((TOTAL / 5 - STIFFNESS * left[name]).max())
        what = f"largest share of a linear stage, sun {name} [N]"
        table.append(Row(CASE, "closed form", what, largest, float(shares.max()), LINEAR))
    return table


def pin_rows() -> list[Row]:
    """Approach that a pin displaced outwards takes away [um], and the same by traced meshes of displaced axes."""
    plain = {f"{gear}.modifications": None for gear in ("sun", "planet", "ring")}
    stage = read_stage(STAGES / "wind_spur.toml").with_changes({**plain, "stage.driving": "sun"})
    sun_mesh, ring_mesh = stage.sun_scene.mesh(), stage.ring_scene.mesh()
    angles = sun_mesh.working_pressure_angle, ring_mesh.working_pressure_angle
    table = []
    for amount in (PIN, -PIN):
        apart = 0.0
        for scene, error in ((stage.sun_scene, amount), (stage.ring_scene, -amount)):
            pair = scene.with_changes({"mounting.centre_distance_error_mm": error}).pair()
            apart -= pair.driving * pair.base_radii[1] * float(trace_teeth(pair).transmission_error.mean())
        expected = float(pin_errors(np.zeros(1), np.array([amount]), angles, True)[0])
        what = f"approach taken by a pin {1e3 * amount:+.0f} um outwards [um]"
        table.append(Row(CASE, "axes displaced", what, 1e3 * apart, 1e3 * expected, SECOND_ORDER))
    return table


def order_rows() -> list[Row]:
    """Orders of a stage of four planets in two phases, and the ripple of one whose planets are in phase."""
    phased = _analysed(read_stage(STAGES / "helical_automotive.toml"), [300.0])
    phased = rebalanced(phased, {"stage.pin_tangential_um": None})
    orders = phased.orders()
    largest = max(one.one_path for one in orders)
    cancelled = max(one.stage for one in orders if one.torsion_cancels)
    together = _analysed(read_stage(STAGES / "wind_spur.toml"), [162e3])
    together = rebalanced(together, {"stage.pin_tangential_um": None})
    stage, path = (float(np.ptp(together.error_um(0, one_path=one))) for one in (False, True))
    return [
        Row(
            CASE,
            "symmetry",
            "largest cancelled order over the largest of one path",
            0.0,
            cancelled / largest,
            SYMMETRIC,
        ),
        Row(CASE, "symmetry", "ripple of three planets in phase [um]", path, stage, SYMMETRIC),
    ]


def _analysed(stage: Stage, torques: list[float]) -> StageResult:
    """Flanks alone at nine positions, whose contacts reach edges."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse_stage(stage.with_changes({**FLANKS, "analysis.positions": 9, "analysis.torques_Nm": torques}))
