"""Files of the stresses below a pressure map: all points in NetCDF-3, those below the highest pressure in a table."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from loaded_tca.output.report import csv_table
from loaded_tca.results.files import Buffer, FilePath, Part, netcdf_of, replace_together, variables_of
from loaded_tca.results.quantities import MAP_PARTS, QUANTITIES
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


def write_subsurface(below: StressBelow, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write ``subsurface.nc`` and ``subsurface.csv``, all files or none.

    Parameters
    ----------
    below : StressBelow
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the same stresses.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    import xarray

    one, stress, result = below.pressure_map, below.stress, below.result
    grid = ("depth", "across", "along")
    told: dict[str, tuple[Part, Any]] = {
        "pinion_torque": (((), "N mm", "pinion torque"), result.torque[below.torque]),
        "pinion_angle": (((), "rad", "angle of the pinion phi1"), result.pinion_angle[below.position]),
        "position": (((), "1", "position of the result, from 1"), below.position + 1),
        "pair": (((), *QUANTITIES["pair"][1:]), below.pair),
        "poisson_ratio": (((), "1", "Poisson's ratio of the body looked at"), stress.poisson_ratio),
        "depth": ((("depth",), "mm", "distance below the flank"), stress.depths),
        **{name: (MAP_PARTS[name], getattr(one, name)) for name in ("x", "y", "pressure")},
        **{name: ((grid, "MPa", text), getattr(stress, name)) for name, text in STRESSES.items()},
    }
    parts, arrays = ({name: entry[k] for name, entry in told.items()} for k in (0, 1))
    texts = {"title": result.scene.title, "scene_toml": result.scene.to_toml(), "version": result.version}
    fields = xarray.Dataset(variables_of(parts, arrays), attrs={**texts, "gear": below.gear})
    return replace_together(directory, {FIELDS: netcdf_of(fields), TABLE: subsurface_csv(below).encode(), **more})


def subsurface_csv(below: StressBelow) -> str:
    """Return the stresses at each depth below the highest pressure, and the largest of the whole depth; mm, MPa.

    Where the peak is a spike at an edge, the highest pressure is that across the contact point.
    """
    stress = below.stress
    row, column = below.highest_pressure
    columns = {"depth_mm": stress.depths}
    columns |= {f"{name}_MPa": getattr(stress, name)[:, row, column] for name in STRESSES}
    columns |= {f"largest_{name}_MPa": getattr(stress, name).max(axis=(1, 2)) for name in ("von_mises", "max_shear")}
    return csv_table({name: [f"{value:.9g}" for value in values] for name, values in columns.items()})
