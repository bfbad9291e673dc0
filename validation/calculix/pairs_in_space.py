"""Two pairs in space against finite elements: crowned, and flat with a load up to the ends of the face.

Source: the kept runs of ``validation.calculix`` in space; spur 25/37 of 20 mm width at the pitch point, 100 N m.
"""

from __future__ import annotations

import json
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.scene import parse_scene
from validation.calculix.case import FACE_WIDTH
from validation.calculix.comparison import SCENE
from validation.calculix.crowned import LAYERS
from validation.calculix.tables import CROWNED_FILE, FLAT_FILE, MESH_FILE, read_table
from validation.table import Row

SOURCE = "finite elements in space (CalculiX)"
LINE_LOAD, AT_THE_END, ERROR, PRESSURE = 2e-3, 3e-2, 6e-3, 4e-3
"""Of line loads in the middle of the face, and towards its end; of the others three times what is seen: finite elements
half as large change error and pressure by 0.2 and 0.1 %."""
ONE_POSITION: dict[str, object] = {
    "analysis.positions": 1,
    "analysis.load_sharing": True,
    "analysis.compliance": "contact+tooth",
}
CROWNING: dict[str, object] = {"pinion.modifications.lead_crowning_um": 10.0}
FLAT: dict[str, object] = {"analysis.free_edges": True, "analysis.cells": [32, 96]}
"""A load up to the free ends of the face; the grid ends with the face."""


@dataclass(frozen=True)
class InSpace:
    """A pair 20 mm wide at the pitch point under 100 N m.

    Attributes
    ----------
    peak_line_load : float [N/mm]
        Of the crowned pair: at mid-face.
    line_load : tuple of float [N/mm]
        Means over layers of equal height, from mid-face to the end of the face.
    pressure : float [MPa]
        At mid-face.
    transmission_error : float [um]
    seconds : float
        Processor time, compliance and all.
    """

    peak_line_load: float
    line_load: tuple[float, ...]
    pressure: float
    transmission_error: float
    seconds: float


def read_in_space(path: Path) -> InSpace | None:
    """Kept pair in space; None where it is not there.

    Parameters
    ----------
    path : Path
    """
    if not path.exists():
        return None
    kept = json.loads(path.read_text())
    numbers = (kept[name] for name in ("mid_pressure", "transmission_error", "seconds"))
    return InSpace(kept["peak_line_load"], tuple(kept["line_load"]), *numbers)


def softness_of_free_ends() -> float:
    """Transmission error of the kept flat pair over that of its elements in plane strain."""
    flat = read_in_space(FLAT_FILE)
    (plane,) = (
        row for row in read_table(MESH_FILE) if (row["variant"], row["way"]) == ("unmodified", "of_the_crowned_pair")
    )
    assert flat is not None
    return flat.transmission_error / float(plane["transmission_error_um"])


def in_space(changes: dict[str, object]) -> InSpace:
    """Compute a pair under 100 N m.

    Parameters
    ----------
    changes : dict
        What sets its scene apart from the plain one: :data:`CROWNING` or :data:`FLAT`.
    """
    start = time.process_time()
    scene = parse_scene(SCENE.format(face_width=FACE_WIDTH)).with_changes({**ONE_POSITION, **changes})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the flat pair carries load up to the ends of the face
        result = analyse(scene)
    seconds = time.process_time() - start
    error = 1e3 * result.wheel_base_radius * result.transmission_error.item()
    one = result.maps[0][0][0]
    assert one is not None
    force = one.pressure.sum(axis=0) * one.spacing[0] * one.spacing[1]
    ends = np.linspace(0.0, 0.5 * FACE_WIDTH, LAYERS + 1)
    carried = np.interp(ends, one.y + 0.5 * one.spacing[1], np.cumsum(force))
    return InSpace(
        peak_line_load=result.line_load.item(),
        line_load=tuple((np.diff(carried) / np.diff(ends)).tolist()),
        pressure=result.central_pressure.item(),
        transmission_error=error,
        seconds=seconds,
    )


def rows() -> list[Row]:
    """Rows of the pairs in space that are kept."""
    found: list[Row] = []
    for name, (file, changes, rows_of_pair) in PAIRS.items():
        if reference := read_in_space(file):
            found += rows_of_pair(f"{name} pair, pitch point, 100 N m", reference, in_space(changes))
    return found


def rows_of_crowned(case: str, kept: InSpace, ours: InSpace) -> list[Row]:
    """Rows of the crowned pair.

    Parameters
    ----------
    case : str
    kept, ours : InSpace
    """
    return [
        Row(case, SOURCE, "peak line load [N/mm]", kept.peak_line_load, ours.peak_line_load, LINE_LOAD),
        Row(case, SOURCE, "peak pressure [MPa]", kept.pressure, ours.pressure, PRESSURE),
        _row_of_transmission_error(case, kept, ours),
    ]


def rows_of_flat(case: str, kept: InSpace, ours: InSpace) -> list[Row]:
    """Rows of the flat pair, whose load is largest a little before the end of the face.

    Parameters
    ----------
    case : str
    kept, ours : InSpace
    """
    places = {"at mid-face": 0, "largest": int(np.argmax(kept.line_load)), "at the end of the face": -1}
    loads = [
        Row(
            case,
            SOURCE,
            f"line load {where} [N/mm]",
            kept.line_load[n],
            ours.line_load[n],
            AT_THE_END if n else LINE_LOAD,
        )
        for where, n in places.items()
    ]
    return [*loads, _row_of_transmission_error(case, kept, ours)]


def _row_of_transmission_error(case: str, kept: InSpace, ours: InSpace) -> Row:
    """Transmission error in space."""
    errors = kept.transmission_error, ours.transmission_error
    return Row(case, SOURCE, "transmission error [um]", *errors, ERROR)


PAIRS = {"crowned": (CROWNED_FILE, CROWNING, rows_of_crowned), "flat": (FLAT_FILE, FLAT, rows_of_flat)}
"""Pairs in space: their file, what sets our scene apart, and their rows."""
