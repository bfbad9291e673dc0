"""Pictures of a result, each with its units, load and position; figures are made without any global state."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.arguments import checked
from loaded_tca.lazy import lazy_names
from loaded_tca.loaded.shaft_lines import shaft_lines
from loaded_tca.plots.at_a_glance import plot_at_a_glance
from loaded_tca.plots.curves import plot_peak_pressure, plot_transmission_error
from loaded_tca.plots.flanks import plot_contact_path, plot_full_mesh
from loaded_tca.plots.picture import Picture, captions_of, figures_of
from loaded_tca.plots.pressure_map import (
    plot_contact_patterns,
    plot_pressure_envelope,
    plot_pressure_map,
    plot_stress_below,
    plot_subsurface,
)
from loaded_tca.plots.root_stress import plot_root_stress, plot_root_stress_cycle, plot_root_stress_over_torque
from loaded_tca.plots.shafts import plot_shafts
from loaded_tca.plots.sharing import (
    plot_face_load,
    plot_harmonics,
    plot_line_load,
    plot_line_load_distribution,
    plot_load_share,
    plot_mesh_stiffness,
    plot_path_pressure,
)
from loaded_tca.plots.style import chosen_torque, png_of, pngs_of, save_figure
from loaded_tca.plots.supports import plot_bearing_loads, plot_face_load_on_supports, plot_misalignment
from loaded_tca.results.files import FilePath, replace_together
from loaded_tca.results.mesh_cycle import MeshCycle

if TYPE_CHECKING:  # those of other results than mesh cycles, with all that they show
    from loaded_tca.plots.comparison import plot_compared_maps, plot_comparison
    from loaded_tca.plots.comparison_subjects import (
        COMPARISON_PICTURES,
        comparison_figures,
        plot_compared_face_load,
        plot_compared_patterns,
        plot_compared_root_stress,
    )
    from loaded_tca.plots.design import plot_before_and_after, plot_peak_to_peak_over_torque, plot_robustness
    from loaded_tca.plots.double_helical import (
        DOUBLE_HELICAL_CAPTIONS,
        DOUBLE_HELICAL_PICTURES,
        double_helical_figures,
        halves_revolution_figures,
        plot_half_envelope,
        plot_halves_axial_motion,
        plot_halves_error,
        plot_halves_face_load,
        plot_halves_shares,
    )
    from loaded_tca.plots.first_look import plot_first_look
    from loaded_tca.plots.first_order import plot_first_order_scatter
    from loaded_tca.plots.mesh import plot_teeth_in_mesh
    from loaded_tca.plots.rating import (
        HALVES_RATING_PICTURES,
        RATING_PICTURES,
        plot_damage,
        plot_sn_curves,
        rating_figures,
    )
    from loaded_tca.plots.revolution import (
        REVOLUTION_PICTURES,
        plot_revolution_error,
        plot_revolution_shares,
        plot_revolution_spectrum,
        plot_revolution_waterfall,
    )
    from loaded_tca.plots.safety import plot_flank_safety, plot_root_safety, plot_safeties
    from loaded_tca.plots.sensitivities import (
        plot_removal_weights,
        plot_sensitivity_curves,
        plot_tornado,
        plot_transmission_error_band,
    )
    from loaded_tca.plots.settings import plot_measured_settings
    from loaded_tca.plots.solution import plot_solution
    from loaded_tca.plots.stage import (
        STAGE_CAPTIONS,
        STAGE_PICTURES,
        plot_stage_error,
        plot_stage_load_factor,
        plot_stage_orders,
        plot_stage_phases,
        plot_stage_shares,
        plot_stage_sun_orbit,
        stage_figures,
    )
    from loaded_tca.plots.study import (
        plot_study,
        plot_study_heat_map,
        plot_study_lines,
    )
    from loaded_tca.plots.study_panels import plot_study_ranking
    from loaded_tca.plots.study_scatter import plot_study_histogram, plot_study_over_torque, plot_study_scatter_matrix
    from loaded_tca.plots.three_d import draw_teeth, plot_teeth, show_teeth
    from loaded_tca.plots.tribology import (
        TRIBOLOGY_PICTURES,
        plot_contact_temperature,
        plot_efficiency,
        plot_film_ratio,
        plot_friction_power,
        plot_over_flank,
        plot_sliding_velocities,
        tribology_figures,
    )
    from loaded_tca.plots.vh_check import plot_ease_off, plot_loaded_vh_check, plot_vh_check
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "COMPARISON_PICTURES",
    "DOUBLE_HELICAL_CAPTIONS",
    "DOUBLE_HELICAL_PICTURES",
    "HALVES_RATING_PICTURES",
    "MORE_PICTURES",
    "PICTURES",
    "RATING_PICTURES",
    "REVOLUTION_PICTURES",
    "STAGE_CAPTIONS",
    "STAGE_PICTURES",
    "TRIBOLOGY_PICTURES",
    "comparison_figures",
    "double_helical_figures",
    "draw_teeth",
    "halves_revolution_figures",
    "plot_all",
    "plot_at_a_glance",
    "plot_bearing_loads",
    "plot_before_and_after",
    "plot_compared_face_load",
    "plot_compared_maps",
    "plot_compared_patterns",
    "plot_compared_root_stress",
    "plot_comparison",
    "plot_contact_path",
    "plot_contact_patterns",
    "plot_contact_temperature",
    "plot_damage",
    "plot_ease_off",
    "plot_efficiency",
    "plot_face_load",
    "plot_face_load_on_supports",
    "plot_film_ratio",
    "plot_first_look",
    "plot_first_order_scatter",
    "plot_flank_safety",
    "plot_friction_power",
    "plot_full_mesh",
    "plot_half_envelope",
    "plot_halves_axial_motion",
    "plot_halves_error",
    "plot_halves_face_load",
    "plot_halves_shares",
    "plot_harmonics",
    "plot_line_load",
    "plot_line_load_distribution",
    "plot_load_share",
    "plot_loaded_vh_check",
    "plot_measured_settings",
    "plot_mesh_stiffness",
    "plot_misalignment",
    "plot_over_flank",
    "plot_path_pressure",
    "plot_peak_pressure",
    "plot_peak_to_peak_over_torque",
    "plot_pressure_envelope",
    "plot_pressure_map",
    "plot_removal_weights",
    "plot_revolution_error",
    "plot_revolution_shares",
    "plot_revolution_spectrum",
    "plot_revolution_waterfall",
    "plot_robustness",
    "plot_root_safety",
    "plot_root_stress",
    "plot_root_stress_cycle",
    "plot_root_stress_over_torque",
    "plot_safeties",
    "plot_sensitivity_curves",
    "plot_shafts",
    "plot_sliding_velocities",
    "plot_sn_curves",
    "plot_solution",
    "plot_stage_error",
    "plot_stage_load_factor",
    "plot_stage_orders",
    "plot_stage_phases",
    "plot_stage_shares",
    "plot_stage_sun_orbit",
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
    "plot_teeth_in_mesh",
    "plot_tornado",
    "plot_transmission_error",
    "plot_transmission_error_band",
    "plot_vh_check",
    "png_of",
    "rating_figures",
    "result_figures",
    "save_figure",
    "show_teeth",
    "stage_figures",
    "tribology_figures",
]


class Shown(NamedTuple):
    """What is shown of a result: maps and flanks under one torque, by index; else all, or the one that is asked for."""

    result: MeshCycle
    asked: int | None
    torque: int
    position: int | None

    def map_at(self, place: tuple[int, int] | None) -> Figure:
        """The pressure map at a position and tooth pair."""
        assert place is not None  # those without have no picture
        return plot_pressure_map(self.result, place[0], self.torque, place[1])

    @property
    def peak(self) -> tuple[int, int] | None:
        """Where the peak pressure is, or that of the position asked for."""
        if self.position is None:
            return self.result.peak_contact(self.torque)
        return self.position, int(self.result.peak_column[self.torque, self.position])

    @property
    def edge(self) -> tuple[int, int] | None:
        """Where a higher pressure is at an edge in another position."""
        edge = self.result.edge_contact(self.torque)
        return None if self.position is not None or edge == self.result.peak_contact(self.torque) else edge

    @property
    def hertz(self) -> tuple[int, int] | None:
        """Where the highest pressure is for which Hertz holds, unless it does at the peak."""
        peak = self.result.peak_contact(self.torque)
        holds = peak is not None and self.result.hertz_pressure[self.torque][peak] > 0.0
        smooth = self.result.peak_contact(self.torque, where_hertz_holds=True)
        return None if self.position is not None or holds else smooth


def _has_torques(shown: Shown) -> bool:
    return len(shown.result.torque) > 1


ALWAYS: dict[str, Picture[Shown]] = {
    "contact_path": Picture(
        "where the flanks carry pressure, under the largest torque",
        "Where the flanks carry pressure at some positions, and the unloaded contact points of all.",
        lambda one: plot_contact_path(one.result, one.torque),
    ),
    "transmission_error": Picture(
        "over the positions, all torques",
        "Above: absolute; below: less its mean over a pitch. Unloaded: the transmission error of rigid flanks.",
        lambda one: plot_transmission_error(one.result),
    ),
    "peak_pressure": Picture(
        "over the positions, all torques",
        "Broad dashed lines: pressure after Hertz, where Hertz holds. Filled pentagons: pressure at a rounded edge. "
        "Crosses: mesh-dependent pressure at a sharp edge; triangles: such pressures above the axis.",
        lambda one: plot_peak_pressure(one.result),
    ),
    "pressure_map": Picture(
        "at the position of the peak pressure, under the largest torque",
        "At the position of the peak pressure, in the tangent plane. White: no pressure, grey: no "
        "material. The scale across may be larger.",
        lambda one: one.map_at(one.peak),
        lambda one: one.peak is not None,
    ),
    "pressure_map_edge": Picture(
        "only if a contact at another position has the highest edge pressure",
        "At the position of the highest pressure at an edge. At a sharp edge the pressure of single "
        "cells depends on the mesh.",
        lambda one: one.map_at(one.edge),
        lambda one: one.edge is not None,
    ),
    "pressure_map_hertz": Picture(
        "only if Hertz holds, but not where the peak pressure is",
        "At the highest peak pressure where Hertz holds, with the area after Hertz.",
        lambda one: one.map_at(one.hertz),
        lambda one: one.hertz is not None,
    ),
}
SHARED: dict[str, Picture[Shown]] = {
    "at_a_glance": Picture(
        "pressure, load over the face, transmission error, orders, stress or shares on one sheet, largest torque",
        "What the other pictures show in full, under one torque.",
        lambda one: plot_at_a_glance(one.result, one.torque),
    ),
    "load_share": Picture(
        "of each tooth pair, all torques",
        "Share of each tooth pair in the torque, and how many pairs carry load.",
        lambda one: plot_load_share(one.result, one.asked),
    ),
    "harmonics": Picture(
        "orders of the tooth mesh in the transmission error, all torques",
        "Amplitudes and phases of the orders of the tooth mesh in the loaded transmission error.",
        lambda one: plot_harmonics(one.result),
    ),
    "mesh_stiffness": Picture(
        "over the positions, all torques",
        "Solid: derivative of the force over the face width with respect to the transmission error. Dotted: secant "
        "from no load.",
        lambda one: plot_mesh_stiffness(one.result),
    ),
    "line_load": Picture(
        "over the positions, all torques",
        "Largest force per length along the contact of the most loaded pair; at a sharp face end mesh-dependent.",
        lambda one: plot_line_load(one.result),
    ),
    "line_load_distribution": Picture(
        "along the contacts on the flanks, under the largest torque",
        "Force per length along the contacts of all positions, where they lie on the flanks.",
        lambda one: plot_line_load_distribution(one.result, one.torque),
    ),
    "face_load": Picture(
        "load over the face width with K_Hbeta, all torques",
        "Normal force of all tooth pairs per face width, the mean over a pitch. Its largest value "
        "over its mean is K_Hβ.",
        lambda one: plot_face_load(one.result),
    ),
    "pressure_envelope": Picture(
        "the highest pressure on the flanks, under the largest torque",
        "The highest pressure that each place of the flanks sees over the mesh cycle.",
        lambda one: plot_pressure_envelope(one.result, one.torque),
    ),
    "path_pressure": Picture(
        "from the beginning to the end of contact, all torques",
        "Peak pressure of a tooth pair from the beginning to the end of its contact.",
        lambda one: plot_path_pressure(one.result),
    ),
}
ROOTS: dict[str, Picture[Shown]] = {
    "root_stress": Picture(
        "over fillet and face of both gears, with its envelopes, under the largest torque",
        "Tangential stress over fillet and face: at the largest tension, and as envelopes over the mesh.",
        lambda one: plot_root_stress(one.result, one.torque),
    ),
    "root_stress_cycle": Picture(
        "tension and compression over the positions, all torques",
        "Largest tension and compression at the roots over the positions.",
        lambda one: plot_root_stress_cycle(one.result),
        lambda one: len(one.result.path) > 1,
    ),
    "root_stress_over_torque": Picture(
        "tension and compression over several torques",
        "Largest tension and compression at the roots over the torque.",
        lambda one: plot_root_stress_over_torque(one.result),
        _has_torques,
    ),
}
ON_SUPPORTS: dict[str, Picture[Shown]] = {
    "misalignment": Picture(
        "misalignment of cylindrical gears over the torque, with its band over the pitch",
        "Misalignment by the supports of both gears, with the signs of mounting.misalignment_um, which is left out.",
        lambda one: plot_misalignment(one.result),
        lambda one: _has_torques(one) and bool(np.isfinite(one.result.misalignment).any()),
    ),
    "bearing_loads": Picture(
        "forces of all elements around the rings of rolling bearings, under the largest torque",
        "Forces of rolling elements around their rings, the first element on the x axis of the gear's own frame, and "
        "the basic reference rating life.",
        lambda one: plot_bearing_loads(one.result, one.torque),
        lambda one: one.result.has_rolling_bearings,
    ),
    "shaft": Picture(
        "shafts with gears and bearings, and their deflection in two planes, all torques",
        "Shafts under the normal force where the unloaded flanks touch, without contact.",
        lambda one: plot_shafts(shaft_lines(one.result.scene), one.result.scene.title),
        lambda one: any(one.result.scene.have_shafts),
    ),
}
ON_REQUEST: dict[str, Picture[Shown]] = {
    "contact_patterns": Picture(
        "the highest pressure on the flanks under each of several torques, on one scale",
        "The pressure envelope under each torque, all on one scale of colours.",
        lambda one: plot_contact_patterns(one.result),
        _has_torques,
    ),
    "full_mesh": Picture(
        "all tooth pairs at the position of pressure_map.png on the flanks",
        "All tooth pairs in contact at one position, with their shares of the torque.",
        lambda one: plot_full_mesh(one.result, one.position, one.torque),
        lambda one: one.result.peak_contact(one.torque) is not None,
    ),
}
"""Pictures that every result has; where tooth pairs share the load; with root stress; on supports; on request alone."""
PICTURES = (*ALWAYS, *SHARED, *ROOTS, *ON_SUPPORTS)
"""Names of the pictures that a result has, without their ending."""
MORE_PICTURES = tuple(ON_REQUEST)
"""Names of those that are drawn on request."""
CAPTIONS = captions_of({**ALWAYS, **SHARED, **ROOTS, **ON_SUPPORTS, **ON_REQUEST})
"""How each picture is read."""


@checked
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
    contents = pngs_of(figures)
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
        highest pressure where it holds. Where tooth pairs share the load: ``at_a_glance``, ``load_share``,
        ``harmonics``, ``mesh_stiffness``, ``line_load``, ``line_load_distribution``, ``face_load``,
        ``pressure_envelope``, ``path_pressure``. With root stress: ``root_stress``; of several positions
        ``root_stress_cycle``; of several torques ``root_stress_over_torque``. On supports:
        ``misalignment`` of cylindrical gears under several torques, ``bearing_loads`` of rolling bearings, ``shaft`` of
        gears with shafts. With ``more``: under several torques ``contact_patterns``, and ``full_mesh``.

    Raises
    ------
    InputError
        If the result has no such torque or position.
    """
    shown = Shown(result, torque, chosen_torque(result, torque, position), position)
    shares_load = result.scene.analysis.load_sharing and len(result.path) > 1
    groups = (
        (ALWAYS, True),
        (SHARED, shares_load),
        (ON_REQUEST, shares_load and more),
        (ROOTS, result.has_root_stress),
        (ON_SUPPORTS, result.scene.is_supported),
    )
    return {name: figure for group, wanted in groups if wanted for name, figure in figures_of(group, shown).items()}
