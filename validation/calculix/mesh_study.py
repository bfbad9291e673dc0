"""What the mesh and the penalty change: positions with one and with two tooth pairs, run in several ways."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from validation.calculix.campaign import Record, first_setback, run_position
from validation.calculix.crowned import SPATIAL_MESHING
from validation.calculix.model import Meshing
from validation.calculix.steel import PENALTY

CASES = (("unmodified", 100.0, 12), ("tip_relief", 100.0, 0))
"""Variant, torque [N m] and position: the pitch point with one pair, and an end of the pitch with two."""
WAYS = {
    "standard": (Meshing(), PENALTY),
    "coarser": (Meshing().finer(0.7), PENALTY),
    "finer": (Meshing().finer(1.5), PENALTY),
    "twice_as_fine": (Meshing().finer(2.0), PENALTY),
    "penalty_doubled": (Meshing(), 2.0 * PENALTY),
    "of_the_crowned_pair": (SPATIAL_MESHING, PENALTY),
}


def run_study(work: Path) -> Iterator[dict[str, object]]:
    """Rows of the study: way, size of the mesh, and the results that matter."""
    for variant, torque, index in CASES:
        for way, (meshing, penalty) in WAYS.items():
            setback = first_setback(variant, torque, index)
            yield _row(way, meshing, run_position(variant, torque, index, setback, work, meshing, penalty, f"_{way}"))


def _row(way: str, meshing: Meshing, record: Record) -> dict[str, object]:
    """One way of one case; pressures of the pair that carries most."""
    leading = max(record["pairs"], key=lambda pair: pair["load_share"])
    return {
        "variant": record["variant"],
        "torque_Nm": record["torque"],
        "position": record["index"],
        "way": way,
        "elements_per_half_width": meshing.per_half_width,
        "nodes": record["nodes"],
        "transmission_error_um": record["transmission_error"],
        "mesh_stiffness_N_per_mm_um": record["mesh_stiffness"],
        "largest_load_share": leading["load_share"],
        "peak_pressure_MPa": leading["peak_pressure"],
        "fitted_pressure_MPa": leading["fitted_pressure"],
        "half_width_mm": leading["half_width"],
        "seconds": record["seconds"],
    }
