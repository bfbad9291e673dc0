"""Pictures of a result, each with its units, load and position; figures are made without any global state."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from loaded_tca.plots.comparison import plot_compared_maps, plot_comparison
from loaded_tca.plots.curves import plot_peak_pressure, plot_transmission_error
from loaded_tca.plots.design import plot_before_and_after, plot_peak_to_peak_over_torque, plot_robustness
from loaded_tca.plots.ease_off import plot_ease_off
from loaded_tca.plots.envelope import plot_contact_patterns, plot_pressure_envelope
from loaded_tca.plots.first_order import plot_first_order_scatter
from loaded_tca.plots.flanks import plot_contact_path, plot_full_mesh
from loaded_tca.plots.pressure_map import plot_pressure_map
from loaded_tca.plots.removal import plot_removal_weights
from loaded_tca.plots.root_stress import plot_root_stress, plot_root_stress_cycle, plot_root_stress_over_torque
from loaded_tca.plots.sensitivities import plot_sensitivity_curves, plot_tornado, plot_transmission_error_band
from loaded_tca.plots.sharing import (
    plot_face_load,
    plot_harmonics,
    plot_line_load,
    plot_line_load_distribution,
    plot_load_share,
    plot_mesh_stiffness,
    plot_path_pressure,
)
from loaded_tca.plots.study import (
    plot_study,
    plot_study_heat_map,
    plot_study_lines,
)
from loaded_tca.plots.study_ranking import plot_study_ranking
from loaded_tca.plots.study_scatter import plot_study_histogram, plot_study_over_torque, plot_study_scatter_matrix
from loaded_tca.plots.style import chosen_torque, png_of, save_figure
from loaded_tca.plots.subsurface import plot_stress_below, plot_subsurface
from loaded_tca.plots.three_d import draw_teeth, plot_teeth, show_teeth
from loaded_tca.plots.vh_check import plot_loaded_vh_check, plot_vh_check
from loaded_tca.results.files import FilePath, replace_together
from loaded_tca.results.mesh_cycle import MeshCycle

__all__ = [
    "MORE_PICTURES",
    "PICTURES",
    "draw_teeth",
    "plot_all",
    "plot_before_and_after",
    "plot_compared_maps",
    "plot_comparison",
    "plot_contact_path",
    "plot_contact_patterns",
    "plot_ease_off",
    "plot_face_load",
    "plot_first_order_scatter",
    "plot_full_mesh",
    "plot_harmonics",
    "plot_line_load",
    "plot_line_load_distribution",
    "plot_load_share",
    "plot_loaded_vh_check",
    "plot_mesh_stiffness",
    "plot_path_pressure",
    "plot_peak_pressure",
    "plot_peak_to_peak_over_torque",
    "plot_pressure_envelope",
    "plot_pressure_map",
    "plot_removal_weights",
    "plot_robustness",
    "plot_root_stress",
    "plot_root_stress_cycle",
    "plot_root_stress_over_torque",
    "plot_sensitivity_curves",
    "plot_stress_below",
    "plot_study",
    "plot_study_heat_map",
    "plot_study_histogram",
    "plot_study_lines",
    "plot_study_over_torque",
    "plot_study_ranking",
    "plot_study_scatter_matrix",
    "plot_subsurface",
    "plot_teeth",
    "plot_tornado",
    "plot_transmission_error",
    "plot_transmission_error_band",
    "plot_vh_check",
    "png_of",
    "result_figures",
    "save_figure",
    "show_teeth",
]

PICTURES = (
    "contact_path",
    "transmission_error",
    "peak_pressure",
    "pressure_map",
    "pressure_map_edge",
    "pressure_map_hertz",
    "load_share",
    "harmonics",
    "mesh_stiffness",
    "line_load",
    "line_load_distribution",
    "face_load",
    "pressure_envelope",
    "path_pressure",
    "root_stress",
    "root_stress_cycle",
    "root_stress_over_torque",
)
"""Names of the pictures that a result has, without their ending."""
MORE_PICTURES = ("contact_patterns", "full_mesh")
"""Names of those that are drawn on request."""


def plot_all(
    result: MeshCycle,
    directory: FilePath,
    *,
    torque: int | None = None,
    position: int | None = None,
    more: bool = False,
) -> tuple[Path, ...]:
    """Save the pictures of :func:`result_figures` as PNG into a directory, all of them or none.

    Pictures of these names that are not drawn, as an earlier result may have left, are removed.

    Parameters
    ----------
    result : MeshCycle
    directory : str or path
        Made if it does not exist.
    torque : int, optional
        Index of the torque of maps and flanks, and of the only load shares; default: the largest one, and all.
    position : int, optional
        Index of the position of the pressure map, and of the full mesh; default: those of the highest pressures.
    more : bool
        Draw ``MORE_PICTURES`` too, where tooth pairs share the load.

    Returns
    -------
    tuple of Path

    Raises
    ------
    InputError
        If the result has no such torque or position, or a file cannot be written.
    """
    figures = result_figures(result, torque=torque, position=position, more=more)
    contents = {f"{name}.png": png_of(figure) for name, figure in figures.items()}
    return replace_together(directory, contents, {f"{name}.png" for name in (*PICTURES, *MORE_PICTURES)} - {*contents})


def result_figures(
    result: MeshCycle, *, torque: int | None = None, position: int | None = None, more: bool = False
) -> dict[str, Figure]:
    """Draw every picture of a result.

    Parameters
    ----------
    result, torque, position, more
        As of :func:`plot_all`.

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        ``contact_path``, ``transmission_error``, ``peak_pressure``; if anything is in contact,
        ``pressure_map`` of the peak pressure; if a higher one lies at an edge or a relief start in another
        position, ``pressure_map_edge``; if Hertz holds in other positions only, ``pressure_map_hertz`` of the
        highest pressure where it holds. Where tooth pairs share the load: ``load_share``, ``harmonics``,
        ``mesh_stiffness``, ``line_load``, ``line_load_distribution``, ``face_load``, ``pressure_envelope``,
        ``path_pressure``. With root stress: ``root_stress``; of several positions ``root_stress_cycle``; of
        several torques ``root_stress_over_torque``. With ``more``: under several torques
        ``contact_patterns``, and ``full_mesh``.

    Raises
    ------
    InputError
        If the result has no such torque or position.
    """
    asked, torque = torque, chosen_torque(result, torque, position)
    figures = {
        "contact_path": plot_contact_path(result, torque),
        "transmission_error": plot_transmission_error(result),
        "peak_pressure": plot_peak_pressure(result),
    }
    peak, edge = result.peak_contact(torque), result.edge_contact(torque)
    smooth = result.peak_contact(torque, where_hertz_holds=True)
    hertz_at_peak = peak is not None and result.hertz_pressure[torque][peak] > 0.0
    places = {
        "pressure_map": peak,
        "pressure_map_edge": None if edge == peak else edge,
        "pressure_map_hertz": None if hertz_at_peak else smooth,
    }
    if position is not None:
        places = {"pressure_map": (position, int(result.peak_column[torque, position]))}
    for name, place in places.items():
        if place is not None:
            figures[name] = plot_pressure_map(result, place[0], torque, place[1])
    if result.scene.analysis.load_sharing and len(result.path) > 1:
        figures |= {
            "load_share": plot_load_share(result, asked),
            "harmonics": plot_harmonics(result),
            "mesh_stiffness": plot_mesh_stiffness(result),
            "line_load": plot_line_load(result),
            "line_load_distribution": plot_line_load_distribution(result, torque),
            "face_load": plot_face_load(result),
            "pressure_envelope": plot_pressure_envelope(result, torque),
            "path_pressure": plot_path_pressure(result),
        }
        if more and len(result.torque) > 1:
            figures["contact_patterns"] = plot_contact_patterns(result)
        if more and peak is not None:
            figures["full_mesh"] = plot_full_mesh(result, position, torque)
    if result.has_root_stress:
        figures["root_stress"] = plot_root_stress(result, torque)
        if len(result.path) > 1:
            figures["root_stress_cycle"] = plot_root_stress_cycle(result)
        if len(result.torque) > 1:
            figures["root_stress_over_torque"] = plot_root_stress_over_torque(result)
    return figures
