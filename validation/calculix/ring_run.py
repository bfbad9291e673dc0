"""Runs of the rings in space: a spur and a helical pinion under an even and an uneven line load."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from validation.calculix.case import FACE_WIDTH
from validation.calculix.ring import RingMeshing, loaded_ring
from validation.calculix.run import execute, nodal_stresses
from validation.calculix.tooth_form import ToothForm

LINE_LOAD = 100.0
"""Normal force per length of face, its mean [N/mm]."""
LOADS = {"even": 0.0, "uneven": 1.0}
"""Relative change of the line load from mid-face to the end of the face: the uneven one rises from 0 to twice the
mean."""
HELICES = {"spur": 0.0, "helical": 20.0}
"""Helix angles [deg]."""
ROLLS = {"spur": 14.16257, "helical": 17.4}
"""Roll length of the loaded line at mid-face [mm]; of the spur pinion that of the highest point of single contact with
a wheel of 37 teeth."""
WAYS = {"standard": RingMeshing(), "finer": RingMeshing(fillet=0.17, flank=0.6, beside=2.0, end=0.4, layer=1.7)}
ANGLES = np.arange(15.0, 80.5, 0.5)
"""Tangent angles of the kept curves [deg]."""

Record = dict[str, Any]


def pinion(name: str) -> ToothForm:
    """Form of the spur or the helical pinion."""
    return ToothForm(25, helix_angle=math.radians(HELICES[name]))


def loaded_line(name: str) -> tuple[float, float]:
    """Roll length of the loaded line at mid-face [mm] and its change along +z: the generator of the helical flank."""
    form = pinion(name)
    return ROLLS[name], form.base_radius * math.tan(form.helix_angle) / form.pitch_radius


def run_ring(work: Path, name: str, way: str) -> Record:
    """Stress of both fillets under both loads; run unless it is in the directory already.

    Parameters
    ----------
    work : Path
        Directory for the files.
    name : {"spur", "helical"}
    way : {"standard", "finer"}
    """
    kept = work / f"ring_{name}_{way}.json"
    if kept.exists():
        return json.loads(kept.read_text())
    form, rolls = pinion(name), loaded_line(name)
    loaded = loaded_ring(form, FACE_WIDTH, math.hypot(form.base_radius, rolls[0]), WAYS[way])
    loads = {load: loaded.forces(rolls, (LINE_LOAD, change)) for load, change in LOADS.items()}
    stem = kept.with_suffix("")
    _, seconds = execute(loaded.text(loads), stem)
    record: Record = {
        "name": name,
        "way": way,
        "height": loaded.ring.levels.tolist(),
        "nodes": loaded.ring.last_node,
        "seconds": seconds,
    }
    for load, nodal in zip(loads, nodal_stresses(stem.with_suffix(".frd")), strict=True):
        angle, sides = loaded.stress(nodal)
        degrees = np.degrees(angle)
        record[load] = {
            side: {
                "stress": np.stack([np.interp(ANGLES, degrees, column) for column in values.T], axis=-1).tolist(),
                "extreme": (sign * (sign * values).max(axis=0)).tolist(),
                "angle": degrees[(sign * values).argmax(axis=0)].tolist(),
            }
            for side, sign, values in (("loaded", 1.0, sides[0]), ("back", -1.0, sides[1]))
        }
    kept.write_text(json.dumps(record))
    for suffix in (".frd", ".12d"):
        stem.with_suffix(suffix).unlink(missing_ok=True)
    print(f"ring {name}, {way}: {_largest(record)}, {record['nodes']} nodes, {seconds:.0f} s", flush=True)
    return record


def _largest(record: Record) -> str:
    return ", ".join(
        f"{load} {max(record[load]['loaded']['extreme']):.2f} {min(record[load]['back']['extreme']):.2f}"
        for load in LOADS
    )
