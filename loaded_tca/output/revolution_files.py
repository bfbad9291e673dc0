"""Files of a whole revolution: the result, its figures, and tables of positions, teeth and orders."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.output.result_files import csv_table, json_text, known
from loaded_tca.results.files import Buffer, FilePath, replace_together
from loaded_tca.results.revolution import Revolution

FILES = "revolution.nc", "revolution.json", "revolution.csv", "teeth.csv", "orders.csv"
"""Names of the files."""


def write_revolution(revolution: Revolution, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write a revolution and its tables, all files or none.

    Parameters
    ----------
    revolution : Revolution
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    texts = (
        revolution_json(revolution),
        csv_table(revolution.to_table()),
        teeth_csv(revolution),
        orders_csv(revolution),
    )
    contents = [revolution.to_netcdf(), *(text.encode() for text in texts)]
    return replace_together(directory, {**dict(zip(FILES, contents, strict=True)), **more})


def revolution_json(revolution: Revolution) -> str:
    """Return the figures of each torque as JSON, null where one is not known."""
    rows = [
        {"pinion_torque_Nm": 1e-3 * float(torque), **{name: known(value, name) for name, value in figures.items()}}
        for torque, figures in zip(revolution.torque, revolution.key_figures(), strict=True)
    ]
    content = {"title": revolution.scene.title, "torques": rows, "warnings": list(revolution.warnings)}
    return json_text(content)


def teeth_csv(revolution: Revolution) -> str:
    """Return a row for each torque, gear and tooth: the largest share, force and pressure of the tooth."""
    columns: dict[str, list[object]] = {
        name: [] for name in ("pinion_torque_Nm", "gear", "tooth", "load_share", "normal_force_N", "peak_pressure_MPa")
    }
    for t, torque in enumerate(revolution.torque):
        for gear in GEARS:
            teeth = revolution.by_tooth(gear)
            count = teeth.sizes["tooth"]
            parts = [[1e-3 * torque] * count, [gear] * count, range(count)]
            parts += [teeth[name].values[t] for name in ("load_share", "normal_force", "peak_pressure")]
            for column, values in zip(columns.values(), parts, strict=True):
                column.extend(values)
    return csv_table(columns)


def orders_csv(revolution: Revolution) -> str:
    """Return a row for each order of the transmission error: rigid, and under each torque."""
    rigid = revolution.spectrum(rigid=True)
    gear = GEARS[revolution.counted_by]
    columns = {f"order_of_{gear}": rigid.order, "kind": np.array(rigid.kind, dtype=object)}
    columns["rigid_amplitude_um"] = rigid.amplitude
    for t, torque in enumerate(revolution.torque):
        columns[f"amplitude_at_{1e-3 * torque:.6g}_Nm_um"] = revolution.spectrum(t).amplitude
    return csv_table(columns)
