"""Tables for programs of rotor and gear dynamics: curves over the pitch, and their Fourier coefficients."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from loaded_tca.output.report import csv_table
from loaded_tca.results import MeshCycle
from loaded_tca.results.dynamics import OVER_ORDERS, OVER_PITCH, QUANTITIES
from loaded_tca.results.files import FilePath, replace_together

if TYPE_CHECKING:
    import xarray

TABLE = "dynamics.csv"
"""Name of the first table, where none is given."""


def write_dynamics(result: MeshCycle, path: FilePath) -> tuple[Path, ...]:
    """Write two tables of a result in SI units for models of gear dynamics, both or none.

    One has a row for each torque and mesh phase, the other, with ``_orders`` at the end of its name, a row for each
    torque and order of the tooth mesh. Lines that begin with ``#`` say what the columns are and give what is no table.

    Parameters
    ----------
    result : MeshCycle
    path : str or path
        Of the first table, as ``dynamics.csv``; the folder is made if it does not exist.

    Returns
    -------
    tuple of Path
        The two files.

    Raises
    ------
    InputError
        As ``MeshCycle.to_dynamics``, or if they cannot be written.
    """
    dynamics, (first, orders) = result.to_dynamics(), tables_at(Path(path))
    tables = {first.name: _table(dynamics, OVER_PITCH), orders.name: _table(dynamics, OVER_ORDERS)}
    return replace_together(first.parent, {name: text.encode() for name, text in tables.items()})


def tables_at(first: Path) -> tuple[Path, Path]:
    """Return the files of both tables, given that of the first."""
    return first, first.with_name(f"{first.stem}_orders{first.suffix}")


def _table(dynamics: xarray.Dataset, dimensions: tuple[str, str]) -> str:
    """The columns of these two dimensions, below comments on them, on all scalars and on what depends on the torque."""
    own = [name for name, (axes, _, _) in QUANTITIES.items() if axes in (dimensions[1:], dimensions)]
    columns = [*dimensions, *(name for name in own if name not in dimensions)]
    lines = ["Gear mesh for dynamics, in SI units", *_told(dynamics), "columns:", *_described(dynamics, columns)]
    head = "".join(f"# {line}\n" for line in lines)
    filled = {name: dynamics[name].broadcast_like(dynamics[columns[-1]]).transpose(*dimensions) for name in columns}
    return head + csv_table({name: [_cell(value) for value in one.values.flat] for name, one in filled.items()})


def _told(dynamics: xarray.Dataset) -> Iterator[str]:
    """Title, conventions and scalars; of each torque the contact ratio."""
    yield f"loaded_tca {dynamics.attrs['version']}: {dynamics.attrs['title']}"
    yield from dynamics.attrs["conventions"].splitlines()
    for name, one in dynamics.data_vars.items():
        if not one.dims:
            yield f"{name} = {_cell(one.item())}: {one.attrs['long_name']}"
    ratio = dynamics["loaded_contact_ratio"]
    for torque, value in zip(dynamics["pinion_torque_Nm"].values, ratio.values, strict=True):
        yield f"loaded_contact_ratio = {_cell(value)} under {_cell(torque)} N m: {ratio.attrs['long_name']}"


def _described(dynamics: xarray.Dataset, columns: Sequence[str]) -> Iterator[str]:
    for name in columns:
        yield f"  {name}: {dynamics[name].attrs['long_name']}"


def _cell(value: float) -> str:
    """Twelve digits; nothing where unknown."""
    return f"{value:.12g}" if math.isfinite(value) else ""
