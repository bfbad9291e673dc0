"""Files of the stresses below a pressure map: all points in NetCDF-3, those below the highest pressure in a table."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from loaded_tca.results.files import FilePath, Variable, replacing, write_netcdf
from loaded_tca.results.stress_below import StressBelow

FIELDS, TABLE = "subsurface.nc", "subsurface.csv"
"""Names of the two files."""

STRESSES = {
    "sigma_x": "normal stress across the contact, tension positive",
    "sigma_y": "normal stress along the contact, tension positive",
    "sigma_z": "normal stress along the normal, tension positive",
    "tau_xy": "shear stress across, along",
    "tau_xz": "shear stress across, into the body",
    "tau_yz": "shear stress along, into the body",
    "von_mises": "equivalent stress after von Mises",
    "max_shear": "greatest shear stress, half the difference of the outer principal stresses",
}
"""Field of ``SubsurfaceStress`` -> what the file says of it."""


def write_subsurface(below: StressBelow, directory: FilePath) -> tuple[Path, Path]:
    """Write ``subsurface.nc`` and ``subsurface.csv``, each whole or not at all.

    Parameters
    ----------
    below : StressBelow
    directory : str or path
        Exists.

    Returns
    -------
    (Path, Path)

    Raises
    ------
    InputError
        If they cannot be written.
    """
    fields, table = Path(directory) / FIELDS, Path(directory) / TABLE
    result = below.result
    texts = {"title": result.title, "scene_toml": result.scene_toml, "version": result.version, "gear": below.gear}
    write_netcdf(fields, _variables(below), texts)
    with replacing(table) as temporary:
        temporary.write_text(subsurface_csv(below), encoding="utf-8", newline="")
    return fields, table


def _variables(below: StressBelow) -> dict[str, Variable]:
    one, stress, result = below.pressure_map, below.stress, below.result
    grid = ("depth", "across", "along")
    scalars = {
        "pinion_torque": (result.torque[below.torque], "N mm", "pinion torque"),
        "pinion_angle": (result.pinion_angle[below.position], "rad", "angle of the pinion phi1"),
        "position": (below.position + 1, "1", "position of the result, from 1"),
        "pair": (below.pair, "1", "tooth pair: 0 is the pair at phi1, 1 the next one"),
        "poisson_ratio": (stress.poisson_ratio, "1", "Poisson's ratio of the body looked at"),
    }
    return {
        **{name: Variable((), np.asarray(value), unit, text) for name, (value, unit, text) in scalars.items()},
        "depth": Variable(("depth",), stress.depths, "mm", "distance below the flank"),
        "x": Variable(("across",), one.x, "mm", "cell centres across the contact, from the contact point"),
        "y": Variable(("along",), one.y, "mm", "cell centres along the contact, from the contact point"),
        "pressure": Variable(grid[1:], one.pressure, "MPa", "contact pressure"),
        **{name: Variable(grid, getattr(stress, name), "MPa", text) for name, text in STRESSES.items()},
    }


def subsurface_csv(below: StressBelow) -> str:
    """Return the stresses at each depth below the highest pressure, and the largest of the whole depth; mm, MPa.

    Where the peak is a spike at an edge, the highest pressure is that across the contact point.
    """
    stress = below.stress
    row, column = below.highest_pressure
    columns = {"depth_mm": stress.depths}
    columns |= {f"{name}_MPa": getattr(stress, name)[:, row, column] for name in STRESSES}
    columns |= {f"largest_{name}_MPa": getattr(stress, name).max(axis=(1, 2)) for name in ("von_mises", "max_shear")}
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([f"{value:.9g}" for value in values] for values in zip(*columns.values(), strict=True))
    return text.getvalue()
