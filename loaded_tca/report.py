"""What an analysis leaves behind: the whole result, its key figures, and a table of the positions."""

from __future__ import annotations

import csv
import io
import json
import math
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from loaded_tca.errors import InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.mesh_cycle import ARCSEC, MeshCycle
from loaded_tca.storage import FilePath, replacing

RESULT, SUMMARY, POSITIONS = "result.nc", "summary.json", "positions.csv"
"""Names of the three files."""

ENGINEERS_UNITS = {"rad": (ARCSEC, "arcsec"), "N mm": (1e-3, "Nm"), "N/(mm um)": (1.0, "N_per_mm_um"), "1": (1.0, "")}
"""Unit of a result -> factor to, and name of, the unit in the table; others stay as they are."""


def write_report(result: MeshCycle, directory: FilePath) -> tuple[Path, Path, Path]:
    """Write ``result.nc``, ``summary.json`` and ``positions.csv``, each whole or not at all.

    Parameters
    ----------
    result : MeshCycle
    directory : str or path
        Made if it does not exist.

    Returns
    -------
    (Path, Path, Path)
        The three files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    folder = Path(directory)
    make_directory(folder)
    paths = folder / RESULT, folder / SUMMARY, folder / POSITIONS
    result.save(paths[0])
    for path, text in zip(paths[1:], (summary_json(result), positions_csv(result)), strict=True):
        with replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8", newline="")
    return paths


def make_directory(directory: Path) -> None:
    """Make a directory and those above it; InputError if that cannot be done."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{directory}: cannot be made a directory: {error.strerror}") from error


def summary_json(result: MeshCycle) -> str:
    """Return the key figures as JSON, their units in the names; null: not known."""
    content = {
        "title": result.title,
        "loaded_tca_version": result.version,
        "tooth_pairs_sharing_load": len(result.pairs),
        "face_width_mm": result.face_width,
        "wheel_base_radius_mm": result.wheel_base_radius,
        "torques": [
            {name: value if math.isfinite(value) else None for name, value in figures.items()}
            for figures in result.key_figures()
        ],
    }
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def positions_csv(result: MeshCycle) -> str:
    """Return one row per torque and position, units in the header; an empty cell: not known."""
    columns = _columns(result)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*(map(_cell, values.ravel()) for values in columns.values()), strict=True))
    return text.getvalue()


def _columns(result: MeshCycle) -> dict[str, Array]:
    """Header -> (m, n) array."""
    shape = len(result.torque), len(result.path)
    torque = np.repeat(result.torque[:, None], shape[1], axis=1)
    position = np.arange(1, shape[1] + 1)
    loaded = {}
    for entry in fields(result):
        if entry.metadata:
            factor, unit = _engineers_unit(entry.metadata["unit"])
            loaded[entry.name + unit] = result.by_torque(entry.name) * factor
    path = result.path
    per_position = {
        "position": position,
        "pinion_angle_deg": np.degrees(path.pinion_angle),
        "pinion_diameter_mm": 2.0 * path.pinion_radius,
        "pinion_axial_mm": path.pinion_axial,
        "wheel_diameter_mm": 2.0 * path.wheel_radius,
        "wheel_axial_mm": path.wheel_axial,
        "unloaded_transmission_error_arcsec": path.transmission_error * ARCSEC,
        "unloaded_transmission_error_um": path.transmission_error * result.wheel_base_radius * 1e3,
    }
    loaded["transmission_error_um"] = result.by_torque("transmission_error") * result.wheel_base_radius * 1e3
    shares = result.load_share.reshape(*shape, len(result.pairs))
    return {
        "pinion_torque_Nm": torque * 1e-3,
        **{name: np.broadcast_to(values, shape) for name, values in per_position.items()},
        **loaded,
        **{f"load_share_pair_{pair}": shares[..., column] for column, pair in enumerate(result.pairs)},
    }


def _engineers_unit(unit: str) -> tuple[float, str]:
    """Factor to the unit of the table, and what a header says of it."""
    factor, name = ENGINEERS_UNITS.get(unit, (1.0, unit))
    return factor, f"_{name}" if name else ""


def _cell(value: Any) -> str:
    """Nine digits, or nothing where the number is not known."""
    return f"{value:.9g}" if math.isfinite(value) else ""
