"""Files of tribology: the dataset, a row for each speed and torque, and a row for each slice."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from loaded_tca.output.result_files import csv_table
from loaded_tca.results.files import Buffer, FilePath, replace_together
from loaded_tca.tribology import Tribology
from loaded_tca.tribology.quantities import COLUMNS, EXTREMES, PLACES, QUANTITIES, TORQUE
from loaded_tca.units import as_ending

DATA, TABLE, SLICES = FILES = "tribology.nc", "tribology.csv", "tribology_slices.csv"
"""Names of the files."""


def write_tribology(tribology: Tribology, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write ``tribology.nc``, ``tribology.csv`` and ``tribology_slices.csv``, all files or none.

    Parameters
    ----------
    tribology : Tribology
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
    contents = tribology.to_netcdf(), tribology_csv(tribology).encode(), slices_csv(tribology).encode()
    return replace_together(directory, {**dict(zip(FILES, contents, strict=True)), **more})


def tribology_csv(tribology: Tribology) -> str:
    """Return a row for each speed and torque: numbers of the mesh that are known, and where extremes lie."""
    result, speeds = tribology.result, tribology.conditions.speeds
    torques = range(len(result.torque))
    columns: dict[str, list[float]] = {
        "pinion_speed_rpm": [float(speed) for speed in speeds for _ in torques],
        "pinion_torque_Nm": [1e-3 * float(torque) for _ in speeds for torque in result.torque],
    }
    for name, quantity in QUANTITIES.items():
        if quantity.dims != TORQUE or tribology.lacking(name):
            continue
        columns[_column(name, quantity.unit)] = tribology.by_speed(name).ravel().tolist()
        for end, (unit, _) in PLACES.items() if name in EXTREMES else ():
            columns[_column(f"{name}_{end}", unit)] = tribology.by_speed(f"{name}_{end}").ravel().tolist()
    return csv_table(columns)


def slices_csv(tribology: Tribology) -> str:
    """Return a row for each slice of each contact under each torque, at the first speed."""
    columns: dict[str, list[float]] = {}
    for torque, moment in enumerate(tribology.result.torque):
        table = tribology.slices(torque)
        columns.setdefault("pinion_torque_Nm", []).extend([1e-3 * float(moment)] * len(table))
        for name in table:
            columns.setdefault(_column(str(name), COLUMNS[str(name)][0]), []).extend(table[name].astype(float).tolist())
    return csv_table(columns)


def _column(name: str, unit: str) -> str:
    """Head of a column: its name with its unit."""
    return f"{name}_{ending}" if (ending := as_ending(unit)) else name
