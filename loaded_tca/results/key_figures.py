"""The figures of a whole mesh cycle under one torque."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.results.iso_figures import iso_figures
from loaded_tca.results.load_factors import face_load_factor_error
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.root_figures import root_figures

ARCSEC = math.degrees(3600.0)
"""Seconds of arc per radian."""

CAPPED = 1.0 - 1e-6
"""Part of the cap on the pressure from which a pressure equals it."""
ORDERS = 3
"""Orders of the tooth mesh that the key figures name."""


def mean_over_a_pitch(values: Array) -> float:
    """Mean of the finite values at even positions of which the first and the last are a pitch apart.

    Both ends are the same place of the mesh, so that each of them counts half.

    Parameters
    ----------
    values : (n,) array

    Returns
    -------
    float
        NaN if no value is finite.

    Examples
    --------
    >>> mean_over_a_pitch(np.array([4.0, 1.0, 1.0, 4.0]))
    2.0
    """
    weights = np.ones(len(values))
    if len(values) > 1:
        weights[[0, -1]] = 0.5
    known = np.isfinite(values)
    return float(np.average(values[known], weights=weights[known])) if known.any() else math.nan


def key_figures(result: CycleNumbers, torque: int) -> dict[str, float]:
    """Return the figures under one torque by names that end in their unit; NaN: not known.

    Parameters
    ----------
    result : MeshCycle
    torque : int
        Index of the torque.
    """
    peak, edge, heaviest = result.peak_contact(torque), result.edge_contact(torque), result.most_loaded_contact(torque)
    smooth = result.peak_contact(torque, where_hertz_holds=True)
    length = 1e3 * result.wheel_base_radius

    def at(place: tuple[int, int] | None, name: str) -> float:
        return math.nan if place is None else float(getattr(result, name)[torque][place])

    def contact_point(place: tuple[int, int] | None, name: str) -> float:
        return math.nan if place is None else float(getattr(result.paths[place[1]], name)[place[0]])

    def count(flags: Array) -> int:
        """Positions at which a pair has the flag."""
        return int(flags.any(axis=-1).sum())

    on_line = np.stack([path.on_line for path in result.paths], axis=-1)
    pairs = result.loaded_pairs[torque] if result.scene.analysis.load_sharing else np.full(1, math.nan)
    highest = np.fmax(result.peak_pressure, result.edge_pressure)[torque]
    return {
        "pinion_torque_Nm": 1e-3 * float(result.torque[torque]),
        "peak_pressure_MPa": at(peak, "peak_pressure"),
        "pinion_angle_at_peak_deg": math.degrees(contact_point(peak, "pinion_angle")),
        "pinion_diameter_at_peak_mm": 2.0 * at(peak, "peak_radius"),
        "pinion_axial_at_peak_mm": at(peak, "peak_axial"),
        "contact_point_diameter_at_peak_mm": 2.0 * contact_point(peak, "pinion_radius"),
        "contact_point_axial_at_peak_mm": contact_point(peak, "pinion_axial"),
        "central_pressure_at_peak_MPa": at(peak, "central_pressure"),
        "normal_force_at_peak_N": at(peak, "normal_force"),
        "contact_length_at_peak_mm": at(peak, "contact_length"),
        "contact_width_at_peak_mm": at(peak, "contact_width"),
        "contact_deformation_at_peak_um": 1e3 * at(peak, "contact_deformation"),
        "edge_pressure_MPa": at(edge, "edge_pressure"),
        "edge_is_rounded": edge is not None and bool(result.edge_is_rounded[torque][edge]),
        "edge_pressure_error": at(edge, "edge_pressure_error"),
        "normal_force_at_edge_N": at(edge, "normal_force"),
        "pinion_angle_at_edge_deg": math.degrees(contact_point(edge, "pinion_angle")),
        "pinion_diameter_at_edge_mm": 2.0 * at(edge, "edge_radius"),
        "pinion_axial_at_edge_mm": at(edge, "edge_axial"),
        "peak_pressure_where_hertz_holds_MPa": at(smooth, "peak_pressure"),
        "hertz_pressure_there_MPa": at(smooth, "hertz_pressure"),
        "hertz_length_there_mm": 2.0 * at(smooth, "hertz_semi_major"),
        "hertz_width_there_mm": 2.0 * at(smooth, "hertz_semi_minor"),
        **_error_figures("transmission_error", result.transmission_error[torque], length),
        **{
            f"transmission_error_order_{order}_um": length * float(amplitude)
            for order, amplitude in enumerate(result.harmonics(ORDERS)[torque], start=1)
        },
        **_error_figures("unloaded_transmission_error", result.unloaded_transmission_error, length),
        "mesh_stiffness_mean_N_per_mm_um": mean_over_a_pitch(result.mesh_stiffness[torque]),
        "mesh_stiffness_without_body_torsion_mean_N_per_mm_um": result.without_body_torsion(
            mean_over_a_pitch(result.mesh_stiffness[torque])
        ),
        "secant_stiffness_mean_N_per_mm_um": mean_over_a_pitch(result.secant_stiffness[torque]),
        "face_load_factor": float(result.face_load_factor[torque]),
        "face_load_factor_error": _face_load_factor_error(result, torque),
        "transverse_load_factor": float(result.transverse_load_factor[torque]),
        **iso_figures(result.scene, float(result.torque[torque]), float(result.transverse_load_factor[torque])),
        "loaded_contact_ratio": mean_over_a_pitch(pairs),
        "fewest_loaded_pairs": _reduced(np.min, pairs),
        "most_loaded_pairs": _reduced(np.max, pairs),
        "line_load_max_N_per_mm": _reduced(np.max, result.line_load[torque]),
        "line_load_at_largest_force_N_per_mm": at(heaviest, "line_load"),
        "line_load_ratio_at_largest_force": at(heaviest, "line_load_ratio"),
        "max_pressure_MPa": result.max_pressure,
        **{
            f"{word}_{name}": _reduced(reduction, cells[cells > 0])
            for word, reduction in (("fewest", np.min), ("most", np.max))
            for name in ("cells_across", "cells_along")
            for cells in (getattr(result, name)[torque],)
        },
        "largest_discretisation_error": _reduced(np.max, result.discretisation_error[torque]),
        "most_solver_iterations": _reduced(np.max, result.iterations[torque]),
        "worst_solver_residual": _reduced(np.max, result.residual[torque]),
        "positions": len(result.path),
        "positions_in_contact": int(result.path.in_contact.sum()),
        "line_positions": count(on_line & np.isfinite(result.contact_deformation[torque])),
        "edge_positions": count(result.on_edge[torque]),
        "relief_start_positions": count(result.on_relief_start[torque]),
        "capped_positions": count(highest >= CAPPED * result.max_pressure),
        **(root_figures(result, torque) if result.has_root_stress else {}),
    }


def _face_load_factor_error(result: CycleNumbers, torque: int) -> float:
    """By how much half-spaces without free edges have K_Hbeta too low; NaN where free edges soften the face ends."""
    if result.scene.analysis.free_edges:
        return math.nan
    return face_load_factor_error(result.gear_pair, result.path, result.maps[torque])


def _error_figures(name: str, error: Array, length: float) -> dict[str, float]:
    """Mean and peak-to-peak of a transmission error, as an angle and as a length: so many um per rad.

    One position has no peak-to-peak: NaN.
    """
    mean = mean_over_a_pitch(error)
    span = _reduced(np.ptp, error) if np.isfinite(error).sum() > 1 else math.nan
    return {
        f"{name}_mean_arcsec": mean * ARCSEC,
        f"{name}_mean_um": mean * length,
        f"{name}_span_arcsec": span * ARCSEC,
        f"{name}_span_um": span * length,
    }


def _reduced(reduction: Any, values: Array) -> float:
    """Least, largest or span of the finite values, whole for whole numbers; NaN if there is none."""
    finite = values[np.isfinite(values)]
    return reduction(finite).item() if finite.size else math.nan
