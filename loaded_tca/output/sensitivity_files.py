"""Files and text of sensitivities: all of them in NetCDF-3, those of the key figures in a table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from loaded_tca.output.report import csv_table
from loaded_tca.results.figures import FIGURES, key_figures
from loaded_tca.results.files import Buffer, FilePath, netcdf_of, replace_together
from loaded_tca.results.sensitivities import Sensitivities
from loaded_tca.results.summary import shown
from loaded_tca.results.tolerances import key_figure_slopes
from loaded_tca.units import unit_of

ALL, TABLE = "sensitivities.nc", "sensitivities.csv"
"""Names of the two files."""
WIDTH = 15


def write_sensitivities(
    found: Sensitivities, tolerances: Mapping[str, float], directory: FilePath, more: Mapping[str, Buffer] = {}
) -> tuple[Path, ...]:
    """Write ``sensitivities.nc`` and ``sensitivities.csv``, all files or none.

    Parameters
    ----------
    found : Sensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the same sensitivities.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    result = found.result
    spreads = ("key", [tolerances[key] for key in found.keys], {"long_name": "standard deviation, in units of the key"})
    texts = {"title": result.scene.title, "scene_toml": result.scene.to_toml(), "version": result.version}
    whole = found.dataset.assign_coords(tolerance=spreads).assign_attrs(texts)
    return replace_together(
        directory, {ALL: netcdf_of(whole), TABLE: sensitivities_csv(found, tolerances).encode(), **more}
    )


def sensitivities_csv(found: Sensitivities, tolerances: Mapping[str, float]) -> str:
    """Return one row per torque and key: the changes of key figures by a unit of the key, and by its tolerance."""
    keys, torques = found.keys, 1e-3 * found.result.torque
    spread = np.array([tolerances[key] for key in keys])
    columns: dict[str, list[str]] = {
        "pinion_torque_Nm": [f"{torque:.9g}" for torque in torques for _ in keys],
        "key": [key for _ in torques for key in keys],
        "tolerance": [f"{one:.9g}" for _ in torques for one in spread],
    }
    slopes = key_figure_slopes(found)
    for name, values in slopes.items():
        columns[f"{name}_per_unit"] = _cells(values)
    for name, values in slopes.items():
        columns[f"{name}_per_tolerance"] = _cells(values * spread)
    return csv_table(columns)


def _cells(values: np.ndarray) -> list[str]:
    """Nine digits, nothing where unknown; small ones are no rounding: they are per unit."""
    return [f"{value:.9g}" if math.isfinite(value) else "" for value in values.ravel()]


def sensitivities_text(found: Sensitivities, tolerances: Mapping[str, float], torque: int) -> str:
    """Return the changes of the key figures under one torque as text: per unit of each key, and per tolerance.

    Parameters
    ----------
    found : Sensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    torque : int
        Index of the torque.
    """
    figures = key_figures(found.result, torque)
    slopes = {name: values[torque] for name, values in key_figure_slopes(found).items()}
    spread = np.array([tolerances[key] for key in found.keys])
    together = [math.sqrt(float(((values * spread) ** 2).sum())) for values in slopes.values()]
    rows: list[tuple[str, list[str]]] = [
        (
            f"pinion torque {figures['pinion_torque_Nm']:.6g} N m",
            [slope.head for name in slopes if (slope := FIGURES[name].slope)],
        ),
        ("", [f"[{unit_of(name) or '-'}]" for name in slopes]),
        ("this result", [shown(figures[name], name) for name in slopes]),
        ("change per unit of", []),
        *((f"  {key}", [_digits(values[k]) for values in slopes.values()]) for k, key in enumerate(found.keys)),
        ("change per tolerance (standard deviation) of", []),
        *(
            (f"  {key} = {one:g}", [_digits(values[k] * one) for values in slopes.values()])
            for k, (key, one) in enumerate(zip(found.keys, spread.tolist(), strict=True))
        ),
        ("  all of them, independent", [_digits(value, sign="") for value in together]),
    ]
    labels = max(len(label) for label, _ in rows)
    lines = [f"{label:<{labels}}" + "".join(f"{cell:>{WIDTH}}" for cell in cells) for label, cells in rows]
    return "\n".join([found.result.scene.title or "Sensitivities", *(line.rstrip() for line in lines)])


def _digits(value: float, sign: str = "+") -> str:
    """Three digits, a dash where unknown."""
    return f"{value:{sign}.3g}" if math.isfinite(value) else "-"
