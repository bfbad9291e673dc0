"""Pictures of a result, each with its units, load and position; figures are made without any global state."""

from __future__ import annotations

from pathlib import Path

from loaded_tca.mesh_cycle import MeshCycle
from loaded_tca.plots.curves import plot_peak_pressure, plot_transmission_error
from loaded_tca.plots.flanks import plot_contact_path
from loaded_tca.plots.pressure_map import plot_pressure_map
from loaded_tca.plots.style import highest_torque, save_figure
from loaded_tca.storage import FilePath, remove

__all__ = [
    "PICTURES",
    "plot_all",
    "plot_contact_path",
    "plot_peak_pressure",
    "plot_pressure_map",
    "plot_transmission_error",
    "save_figure",
]

PICTURES = (
    "contact_path",
    "transmission_error",
    "peak_pressure",
    "pressure_map",
    "pressure_map_border",
    "pressure_map_hertz",
)
"""Names of all pictures that there may be, without their ending."""


def plot_all(
    result: MeshCycle, directory: FilePath, *, torque: int | None = None, position: int | None = None
) -> tuple[Path, ...]:
    """Save every picture as PNG into an existing directory, each whole or not at all.

    Pictures of these names that the result does not have, as an earlier one may have left, are removed.

    Parameters
    ----------
    result : MeshCycle
    directory : str or path
    torque : int, optional
        Index of the torque of maps and flanks; default: the largest one.
    position : int, optional
        Index of the position of the pressure map; default: those of the highest pressures.

    Returns
    -------
    tuple of Path
        ``contact_path.png``, ``transmission_error.png``, ``peak_pressure.png``; if anything touches,
        ``pressure_map.png`` of the peak pressure; if a higher one lies at a border or a crease in another position,
        ``pressure_map_border.png``; if Hertz holds in other positions only, ``pressure_map_hertz.png`` of the highest
        pressure where it holds.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    torque = highest_torque(result) if torque is None else torque
    figures = {
        "contact_path": plot_contact_path(result, torque),
        "transmission_error": plot_transmission_error(result),
        "peak_pressure": plot_peak_pressure(result),
    }
    for name, place in _map_positions(result, torque, position).items():
        figures[name] = plot_pressure_map(result, place, torque)
    files = {name: Path(directory) / f"{name}.png" for name in PICTURES}
    for name, file in files.items():
        if name in figures:
            save_figure(figures[name], file)
        else:
            remove(file)
    return tuple(files[name] for name in figures)


def _map_positions(result: MeshCycle, torque: int, position: int | None) -> dict[str, int]:
    """Picture -> position of each pressure map to be drawn."""
    if position is not None:
        return {"pressure_map": position}
    peak, border = result.peak_position(torque), result.border_position(torque)
    smooth = result.peak_position(torque, where_hertz_holds=True)
    hertz_at_peak = peak is not None and result.by_torque("hertz_pressure")[torque, peak] > 0.0
    wanted = {
        "pressure_map": peak,
        "pressure_map_border": None if border == peak else border,
        "pressure_map_hertz": None if hertz_at_peak else smooth,
    }
    return {name: place for name, place in wanted.items() if place is not None}
