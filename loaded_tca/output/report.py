"""What an analysis leaves behind: the whole result, its key figures, tables of the positions and of all contacts."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.results.contacts import MAP_PARTS, NUMBERS, PAIRS, PATH_PARTS, contact_parts
from loaded_tca.results.files import FilePath, Part, remove, replacing
from loaded_tca.results.key_figures import ARCSEC
from loaded_tca.results.mesh_cycle import MeshCycle, cycle_parts
from loaded_tca.results.reached_edges import NAMES as EDGES
from loaded_tca.results.reached_edges import reached_edges
from loaded_tca.results.summary import without_rounding
from loaded_tca.scene import parse_scene

RESULT, SUMMARY, POSITIONS, CONTACTS = "result.nc", "summary.json", "positions.csv", "contacts.csv"
"""Names of the files; the last one is there only where tooth pairs share the load."""

ENGINEERS_UNITS = {
    "rad": (ARCSEC, "arcsec"),
    "N mm": (1e-3, "Nm"),
    "N/(mm um)": (1.0, "N_per_mm_um"),
    "N/mm": (1.0, "N_per_mm"),
    "1": (1.0, ""),
}
"""Unit of a result -> factor to, and name of, the unit in the table; others stay as they are."""
COLUMNS = {
    "hertz_semi_minor": ("hertz_width_mm", 2.0),
    "hertz_semi_major": ("hertz_length_mm", 2.0),
    "approach": ("approach_um", 1e3),
    "deflection": ("deflection_um", 1e3),
    "peak_radius": ("peak_pinion_diameter_mm", 2.0),
    "peak_axial": ("peak_pinion_axial_mm", 1.0),
}
"""Field -> column and factor, where these do not follow from the unit: full widths, diameters, um."""


def write_report(result: MeshCycle, directory: FilePath) -> tuple[Path, ...]:
    """Write ``result.nc``, ``summary.json`` and ``positions.csv``, each whole or not at all.

    Where tooth pairs share the load ``contacts.csv`` too; elsewhere one that an earlier result left is removed.

    Parameters
    ----------
    result : MeshCycle
    directory : str or path
        Made if it does not exist.

    Returns
    -------
    tuple of Path
        The three or four files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    folder = Path(directory)
    make_directory(folder)
    texts = {SUMMARY: summary_json(result), POSITIONS: positions_csv(result)}
    if result.pair_contacts is not None:
        texts[CONTACTS] = contacts_csv(result)
    else:
        remove(folder / CONTACTS)
    result.save(folder / RESULT)
    for name, text in texts.items():
        with replacing(folder / name) as temporary:
            temporary.write_text(text, encoding="utf-8", newline="")
    return tuple(folder / name for name in (RESULT, *texts))


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
        "mesh_stiffness_is": f"d(F_bt/b)/d(r_b2 TE); {result.yielding}",
        "rigid_bore_diameters_mm": parse_scene(result.scene_toml).rigid_bores,
        "torques": [
            {**{name: _known(value, name) for name, value in figures.items()}, **_pair_at_peak(result, torque)}
            for torque, figures in enumerate(result.key_figures())
        ],
    }
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _pair_at_peak(result: MeshCycle, torque: int) -> dict[str, int | None]:
    """Tooth pair that carries the peak pressure."""
    place = result.peak_contact(torque)
    return {"tooth_pair_at_peak": None if place is None else int(result.pairs[place[1]])}


def _known(value: float, name: str) -> float | None:
    """The number without what is rounding; None if it is not known."""
    if isinstance(value, bool | int):
        return value
    return without_rounding(value, name) if math.isfinite(value) else None


def positions_csv(result: MeshCycle) -> str:
    """Return one row per torque and position, units in the header; an empty cell: not known."""
    return _table(_columns(result))


def contacts_csv(result: MeshCycle) -> str:
    """Return one row per torque, position and tooth pair under load, units in the header; an empty cell: not known.

    The pairs of a position stand in the order of the mesh. The last column names the edges that the contact reaches,
    the tip of a gear or a side of its teeth.
    """
    shape = result.contacts.normal_force.shape
    order = np.argsort(result.pairs)
    rows = (result.contacts.normal_force > 0.0)[..., order]
    every = _contact_columns(result)
    columns = {name: np.broadcast_to(values, shape)[..., order][rows] for name, values in every.items()}
    reached = reached_edges(result)[:, :, order][rows]
    words = [" + ".join(name for name, one in zip(EDGES, row, strict=True) if one) for row in reached]
    return _table({**columns, "edges": np.array(words, dtype=object)})


def _table(columns: Mapping[str, Array]) -> str:
    """Columns as CSV, one row per entry."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    cells = ([_cell(value, name) for value in values.ravel()] for name, values in columns.items())
    writer.writerows(zip(*cells, strict=True))
    return text.getvalue()


def _contact_columns(result: MeshCycle) -> dict[str, Array]:
    """Every contact: header -> array that spreads to (m, n, pairs)."""
    contacts = result.contacts
    places = {
        f"contact_point_{gear}_{name}": np.stack([factor * getattr(path, f"{gear}_{field}") for path in contacts.paths])
        for gear in ("pinion", "wheel")
        for name, field, factor in (("diameter_mm", "radius", 2.0), ("axial_mm", "axial", 1.0))
    }
    columns = {
        "pinion_torque_Nm": 1e-3 * result.torque[:, None, None],
        "position": np.arange(1, len(result.path) + 1)[:, None],
        "pinion_angle_deg": np.degrees(result.pinion_angle)[:, None],
        "tooth_pair": result.pairs,
        "load_share": result.load_share.reshape(contacts.normal_force.shape),
        **{name: values.T for name, values in places.items()},
    }
    for name, (unit, _) in NUMBERS.items():
        column, factor = _column(name, unit)
        columns[column] = getattr(contacts, name) * factor
    return {**columns, "peak_at_edge": contacts.peak_at_edge}


def _columns(result: MeshCycle) -> dict[str, Array]:
    """Header -> (m, n) array."""
    shape = len(result.torque), len(result.path)
    shares = result.load_share.reshape(*shape, len(result.pairs))
    return {
        "pinion_torque_Nm": np.repeat(1e-3 * result.torque[:, None], shape[1], axis=1),
        **{name: np.broadcast_to(values, shape) for name, values in _path_columns(result).items()},
        **_loaded_columns(result),
        **{f"load_share_pair_{result.pairs[column]}": shares[..., column] for column in np.argsort(result.pairs)},
    }


def _path_columns(result: MeshCycle) -> dict[str, Array]:
    """The unloaded contact: header -> (n,) array."""
    path = result.path
    return {
        "position": np.arange(1, len(path) + 1),
        "pinion_angle_deg": np.degrees(path.pinion_angle),
        "contact_point_pinion_diameter_mm": 2.0 * path.pinion_radius,
        "contact_point_pinion_axial_mm": path.pinion_axial,
        "contact_point_wheel_diameter_mm": 2.0 * path.wheel_radius,
        "contact_point_wheel_axial_mm": path.wheel_axial,
        "unloaded_transmission_error_arcsec": path.transmission_error * ARCSEC,
        "unloaded_transmission_error_um": path.transmission_error * result.wheel_base_radius * 1e3,
    }


def _loaded_columns(result: MeshCycle) -> dict[str, Array]:
    """The loaded contact: header -> (m, n) array."""
    columns = {}
    for entry in fields(result):
        if entry.metadata:
            name, factor = _column(entry.name, entry.metadata["unit"])
            columns[name] = result.by_torque(entry.name) * factor
    columns["peak_at_edge"] = result.by_torque("peak_at_edge")
    columns["loaded_pairs"] = result.by_torque("loaded_pairs")
    columns["transmission_error_um"] = result.by_torque("transmission_error") * result.wheel_base_radius * 1e3
    return columns


def _column(name: str, unit: str) -> tuple[str, float]:
    """Header of a field, and the factor to the unit that it tells."""
    factor, unit_name = ENGINEERS_UNITS.get(unit, (1.0, unit))
    return COLUMNS.get(name, (f"{name}_{unit_name}" if unit_name else name, factor))


def _cell(value: Any, name: str) -> str:
    """Nine digits, zero for what is rounding, or nothing where the number is not known; words as they are."""
    if isinstance(value, str):
        return value
    return f"{without_rounding(value, name):.9g}" if math.isfinite(value) else ""


def describe_results() -> str:
    """Return the reference of a result in Markdown: one table for the result, its path, its contacts and its maps.

    Examples
    --------
    >>> print(describe_results().splitlines()[4])
    | `torque` | (torque) | N mm | pinion torque | `pinion_torque_Nm` |
    """
    own = {name: _column(name, unit)[0] for name, (axes, unit, _) in cycle_parts(2).items() if "position" in axes}
    own |= {"torque": "pinion_torque_Nm", "load_share": "load_share_pair_0, ..."}
    lines = ["### The result", "", *_described(cycle_parts(2), POSITIONS, own)]
    lines += ["", "### `result.path`: the unloaded contact", "", *_described(PATH_PARTS)]
    every = {name: _column(name, unit)[0] for name, (unit, _) in NUMBERS.items()}
    lines += ["", "### `result.contacts`: every tooth pair", "", *_described(contact_parts(PAIRS), CONTACTS, every)]
    lines += ["", "### `result.maps[torque][position]`: one pressure map", "", *_described(MAP_PARTS)]
    return "\n".join(lines) + "\n"


def _described(parts: dict[str, Part], file: str = "", columns: dict[str, str] | None = None) -> list[str]:
    """A table of arrays, with their columns in a file where these are given."""
    titles = ["field", "axes", "unit", "what it is", *([f"in {file}"] if columns else [])]
    rows = [titles, ["---"] * len(titles)]
    for name, (axes, unit, text) in parts.items():
        column = (columns or {}).get(name, "")
        cells = [f"`{name}`", f"({', '.join(axes)})" if axes else "one number", "-" if unit == "1" else unit, text]
        rows.append([*cells, *([f"`{column}`" if column else ""] if columns else [])])
    return [f"| {' | '.join(cells)} |" for cells in rows]
