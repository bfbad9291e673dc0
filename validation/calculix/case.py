"""The case: gears, loads and positions of the reference."""

import math

from validation.calculix.mesh_position import Position
from validation.calculix.tooth_form import ToothForm

CENTRE_DISTANCE = 93.0
FACE_WIDTH = 20.0
TORQUES = (20.0, 100.0, 200.0)
"""Pinion torques [N m]."""
POSITIONS = 24
RELIEF = 0.015
"""Tip relief of both gears [mm], parabolic over the roll length."""
VARIANTS = {
    "unmodified": (ToothForm(25), ToothForm(37)),
    "tip_relief": (ToothForm(25, relief=RELIEF, relief_start=76.2), ToothForm(37, relief=RELIEF, relief_start=112.45)),
}


def pinion_angle(index: int) -> float:
    """phi1 of a position: POSITIONS equal steps from -pi/z1 over one pitch, its end left out [rad]."""
    return (2.0 * index / POSITIONS - 1.0) * math.pi / VARIANTS["unmodified"][0].teeth


def line_load(torque: float) -> float:
    """Torque over base radius and face width [N/mm].

    Parameters
    ----------
    torque : float [N m]
    """
    return 1e3 * torque / (VARIANTS["unmodified"][0].base_radius * FACE_WIDTH)


def position(variant: str, index: int, setback: float) -> Position:
    """Gears of a variant at a position, the wheel behind by a setback [mm]."""
    return Position(*VARIANTS[variant], CENTRE_DISTANCE, pinion_angle(index), setback)
