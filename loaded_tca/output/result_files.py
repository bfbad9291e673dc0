"""What an analysis leaves behind: the whole result, its key figures, tables of the positions and of all contacts."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS
from loaded_tca.results.files import Buffer, FilePath, Part, replace_together
from loaded_tca.results.key_figures import ARCSEC
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.quantities import (
    BEARING_QUANTITIES,
    CYCLE,
    MAP_PARTS,
    OVER_CYCLE,
    PAIRS,
    PATH_PARTS,
    QUANTITIES,
    ROLLING_QUANTITIES,
    ROOT_MAPS,
    ROOT_QUANTITIES,
    SUPPORT_QUANTITIES,
)
from loaded_tca.results.summary import without_rounding
from loaded_tca.results.warnings import EDGES, reached_edges
from loaded_tca.units import as_ending, factor_of

RESULT, SUMMARY, POSITIONS, CONTACTS = "result.nc", "summary.json", "positions.csv", "contacts.csv"
"""Names of the files; the last one is there only where tooth pairs share the load."""

ENGINEERS_UNITS = {"rad": "arcsec", "N mm": "Nm"}
"""Unit of a result -> ending of its column, where tables have another unit."""
COLUMNS = {
    "hertz_semi_minor": ("hertz_width_mm", 2.0),
    "hertz_semi_major": ("hertz_length_mm", 2.0),
    "contact_deformation": ("contact_deformation_um", 1.0),
    "tooth_deflection": ("tooth_deflection_um", 1.0),
    "peak_radius": ("peak_pinion_diameter_mm", 2.0),
    "peak_axial": ("peak_pinion_axial_mm", 1.0),
    "edge_radius": ("edge_pinion_diameter_mm", 2.0),
    "edge_axial": ("edge_pinion_axial_mm", 1.0),
    "root_tension_angle": ("root_tension_angle_deg", 1.0),
    "root_compression_angle": ("root_compression_angle_deg", 1.0),
    "pinion_angle": ("pinion_angle_deg", 1.0),
    "torque": ("pinion_torque_Nm", 1.0),
    "pair": ("tooth_pair", 1.0),
}
"""Name -> column, and how many times the number, where this does not follow from the unit: full widths, diameters."""


@checked
def write_report(result: MeshCycle, directory: FilePath, outdated: Iterable[str] = ()) -> tuple[Path, ...]:
    """Write ``result.nc``, ``summary.json`` and ``positions.csv``, all of them or none.

    Where tooth pairs share the load ``contacts.csv`` too; elsewhere one that an earlier result left is removed.

    Parameters
    ----------
    result : MeshCycle
    directory : str or path
        Made if it does not exist.
    outdated : iterable of str
        Names of files that an earlier result may have left there: removed before the new ones take their places.

    Returns
    -------
    tuple of Path
        The three or four files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    texts = {SUMMARY: summary_json(result), POSITIONS: positions_csv(result)}
    if result.scene.analysis.load_sharing:
        texts[CONTACTS] = contacts_csv(result)
    contents: dict[str, Buffer] = {RESULT: result.to_netcdf(), **{name: text.encode() for name, text in texts.items()}}
    return replace_together(directory, contents, {*outdated, CONTACTS} - {*contents})


def summary_json(result: MeshCycle) -> str:
    """Return the key figures as JSON, their units in the names; null: not known, or infinite as an error may be."""
    content = {
        "title": result.scene.title,
        "loaded_tca_version": result.version,
        "tooth_pairs_sharing_load": len(result.pair),
        "face_width_mm": result.face_width,
        "wheel_base_radius_mm": result.wheel_base_radius,
        "mesh_stiffness_is": f"d(F_bt/b)/d(r_b2 TE); {result.bending}",
        "rigid_bore_diameters_mm": result.scene.rigid_bores,
        "accuracy_warnings": result.warnings,
        "findings": result.findings(),
        "torques": [
            {
                **{name: known(value, name) for name, value in figures.items()},
                "tooth_pair_at_peak": None if place is None else int(result.pair[place[1]]),
            }
            for torque, figures in enumerate(result.key_figures())
            for place in (result.peak_contact(torque),)
        ],
    }
    return json_text(content)


def known(value: float, name: str) -> float | None:
    """Return a number as JSON has it: without what is rounding; None if it is not known."""
    if isinstance(value, bool | int):
        return value
    return without_rounding(value, name) if math.isfinite(value) else None


def positions_csv(result: MeshCycle) -> str:
    """Return one row per torque and position, units in the header; an empty cell: not known."""
    path, shape = result.path, result.transmission_error.shape
    columns = {
        "pinion_torque_Nm": 1e-3 * result.torque[:, None],
        "position": np.arange(1, len(path) + 1),
        "pinion_angle_deg": np.degrees(path.pinion_angle),
        "contact_point_pinion_diameter_mm": 2.0 * path.pinion_radius,
        "contact_point_pinion_axial_mm": path.pinion_axial,
        "contact_point_wheel_diameter_mm": 2.0 * path.wheel_radius,
        "contact_point_wheel_axial_mm": path.wheel_axial,
        "unloaded_transmission_error_arcsec": path.transmission_error * ARCSEC,
        "unloaded_transmission_error_um": result.um_per_rad * path.transmission_error,
    }
    for name, (dimensions, unit, _) in QUANTITIES.items():
        if dimensions in (CYCLE, PAIRS) and name != "load_share":
            column, factor = _column(name, unit)
            columns[column] = (result.at_position(name) if dimensions == PAIRS else getattr(result, name)) * factor
    columns["transmission_error_um"] = result.um_per_rad * result.transmission_error
    columns |= {f"load_share_pair_{number}": result.load_share[..., k] for k, number in enumerate(result.pair)}
    for name, (dimensions, unit, _) in SUPPORT_QUANTITIES.items():
        if dimensions == CYCLE and result.scene.is_supported:
            column, factor = _column(name, unit)
            columns[column] = getattr(result, name) * factor
    for name, (dimensions, unit, _) in ROOT_QUANTITIES.items():
        if dimensions == OVER_CYCLE and result.has_root_stress:
            column, factor = _column(name, unit)
            columns |= {f"{gear}_{column}": factor * getattr(result, name)[..., k] for k, gear in enumerate(GEARS)}
    return csv_table({name: np.broadcast_to(values, shape).ravel() for name, values in columns.items()})


def contacts_csv(result: MeshCycle) -> str:
    """Return one row per torque, position and tooth pair under load, units in the header; an empty cell: not known.

    The pairs of a position stand in the order of the mesh. The last column names the edges that the contact reaches,
    the tip of a gear or a face end.
    """
    columns = {
        "pinion_torque_Nm": 1e-3 * result.torque[:, None, None],
        "position": np.arange(1, len(result.path) + 1)[:, None],
        "pinion_angle_deg": np.degrees(result.pinion_angle)[:, None],
        "tooth_pair": result.pair,
    }
    for gear in GEARS:
        for name, part, factor in (("diameter_mm", "radius", 2.0), ("axial_mm", "axial", 1.0)):
            values = [factor * getattr(path, f"{gear}_{part}") for path in result.paths]
            columns[f"contact_point_{gear}_{name}"] = np.stack(values, axis=-1)
    for name, (dimensions, unit, _) in QUANTITIES.items():
        if dimensions == PAIRS:
            column, factor = _column(name, unit)
            columns[column] = getattr(result, name) * factor
    rows = result.normal_force > 0.0
    reached = reached_edges(result)[rows]
    words = [" + ".join(name for name, one in zip(EDGES, row, strict=True) if one) for row in reached]
    under_load = {name: np.broadcast_to(values, rows.shape)[rows] for name, values in columns.items()}
    return csv_table({**under_load, "edges": np.array(words, dtype=object)})


def json_text(content: Mapping[str, Any]) -> str:
    """Return content as JSON, as :func:`write_report` writes it."""
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def csv_table(columns: Mapping[str, Iterable[Any]]) -> str:
    """Return columns of one length as CSV, numbers as :func:`write_report` writes them, words as they are."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    cells = ([cell(value, name) for value in values] for name, values in columns.items())
    writer.writerows(zip(*cells, strict=True))
    return text.getvalue()


def _column(name: str, unit: str) -> tuple[str, float]:
    """Header of a number, and the factor to the unit that it tells."""
    ending = ENGINEERS_UNITS.get(unit) or as_ending(unit)
    column, times = COLUMNS.get(name, (f"{name}_{ending}" if ending else name, 1.0))
    return column, times * (1.0 if unit == "um" else factor_of(column))


def cell(value: Any, name: str) -> str:
    """Return a number as tables have it: nine digits, zero for rounding, nothing where unknown; words as they are."""
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{without_rounding(value, name):.9g}"


def describe_results() -> str:
    """Return the reference of a result in Markdown: one table for the dataset, the paths and the maps.

    Examples
    --------
    >>> print(describe_results().splitlines()[4])
    | `torque` | (torque) | N mm | pinion torque | `pinion_torque_Nm` |
    """
    columns = {name: _column(name, unit)[0] for name, (axes, unit, _) in QUANTITIES.items() if axes}
    columns["load_share"] += "`, `load_share_pair_0`, `..."
    lines = ["### The result and `result.dataset`", "", *_described(QUANTITIES, columns)]
    in_tables = {
        name: "`, `".join(f"{gear}_{_column(name, unit)[0]}" for gear in GEARS)
        for name, (axes, unit, _) in ROOT_QUANTITIES.items()
        if axes == OVER_CYCLE
    }
    of_supports = {
        name: _column(name, unit)[0] for name, (axes, unit, _) in SUPPORT_QUANTITIES.items() if axes == CYCLE
    }
    lines += [
        "",
        "### Supports, where the scene has them",
        "",
        *_described(SUPPORT_QUANTITIES | BEARING_QUANTITIES | ROLLING_QUANTITIES, of_supports),
    ]
    lines += [
        "",
        "### Root stress, where the scene asks for it",
        "",
        *_described(ROOT_QUANTITIES | ROOT_MAPS, in_tables),
    ]
    lines += ["", "### `result.path` and `result.paths[pair]`: the unloaded contact", "", *_described(PATH_PARTS)]
    lines += ["", "### `result.maps[torque][position][pair]`: one pressure map", "", *_described(MAP_PARTS)]
    return "\n".join(lines) + "\n"


def _described(parts: Mapping[str, Part], columns: Mapping[str, str] | None = None) -> list[str]:
    """A table of arrays, with their columns in the tables of a result where these are given."""
    titles = ["name", "axes", "unit", "what it is", *(["in the tables"] if columns else [])]
    rows = [titles, ["---"] * len(titles)]
    for name, (axes, unit, text) in parts.items():
        column = (columns or {}).get(name, "")
        cells = [f"`{name}`", f"({', '.join(axes)})" if axes else "", "-" if unit == "1" else unit, text]
        rows.append([*cells, *([f"`{column}`" if column else ""] if columns else [])])
    return [f"| {' | '.join(cells)} |" for cells in rows]
