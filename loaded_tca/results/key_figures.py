"""The figures of a whole mesh cycle under one torque, from its numbers per position.

A ``row`` maps the names of numbers of a contact to arrays (n k,) over the n positions and, at each, its k tooth pairs;
a ``cycle`` the names of numbers of the whole mesh to arrays (n,).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.unloaded import ContactPath

ARCSEC = math.degrees(3600.0)
"""Seconds of arc per radian."""

Row = Mapping[str, Array]


def highest_peak(row: Row) -> int | None:
    """Position of the first number: the highest inner pressure, or else the highest central pressure."""
    inner = _highest(row["inner_pressure"])
    return _highest(row["central_pressure"]) if inner is None else inner


def highest_edge_peak(row: Row) -> int | None:
    """Position of the highest peak at an edge or relief start, which grows with the grid; None if there is none."""
    return _highest(np.where(row["peak_at_edge"], row["peak_pressure"], math.nan))


def highest_where_hertz_holds(row: Row) -> int | None:
    """Position of the highest peak of those with a pressure after Hertz; None if there is none."""
    return _highest(np.where(np.isfinite(row["hertz_pressure"]), row["peak_pressure"], math.nan))


def harmonic_amplitudes(error: Array, count: int) -> Array:
    """Amplitudes of the orders 1 to ``count`` of a periodic curve.

    Parameters
    ----------
    error : (n,) array
        At even positions over one period, both ends included.
    count : int

    Returns
    -------
    (count,) array
        NaN for orders of which the positions are too few, and for a curve with a gap.

    Examples
    --------
    >>> harmonic_amplitudes(np.cos(np.linspace(0.0, 2.0 * np.pi, 9)), 4).round(12)
    array([ 1.,  0.,  0., nan])
    """
    period = error[:-1]
    amplitudes = np.full(count, math.nan)
    known = min(count, (len(period) - 1) // 2)
    if known > 0 and np.isfinite(period).all():
        amplitudes[:known] = 2.0 / len(period) * np.abs(np.fft.rfft(period))[1 : known + 1]
    return amplitudes


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


def key_figures(
    path: ContactPath, row: Row, cycle: Row, *, wheel_base_radius: float, max_pressure: float
) -> dict[str, float]:
    """Return the figures by names that end in their unit; NaN: not known.

    Parameters
    ----------
    path : ContactPath
        The unloaded contact of the n positions and their k pairs, n k in all.
    row : mapping of (n k,) arrays
    cycle : mapping of (n,) arrays
        ``transmission_error``, ``unloaded_error``, ``mesh_stiffness``, ``secant_stiffness``, ``loaded_pairs``,
        ``touches``; and ``harmonics`` (orders,).
    wheel_base_radius : float [mm]
        Turns the transmission error into a length.
    max_pressure : float [MPa]
        Cap on the pressure; NaN: elastic.
    """
    length = 1e3 * wheel_base_radius
    return {
        **_peak_figures(path, row, highest_peak(row)),
        **_edge_figures(path, row, highest_edge_peak(row)),
        **_hertz_figures(row, highest_where_hertz_holds(row)),
        **_error_figures("transmission_error", cycle["transmission_error"], wheel_base_radius),
        **{
            f"transmission_error_order_{order}_um": length * float(amplitude)
            for order, amplitude in enumerate(cycle["harmonics"], start=1)
        },
        **_error_figures("unloaded_error", cycle["unloaded_error"], wheel_base_radius),
        "mesh_stiffness_mean_N_per_mm_um": mean_over_a_pitch(cycle["mesh_stiffness"]),
        "secant_stiffness_mean_N_per_mm_um": mean_over_a_pitch(cycle["secant_stiffness"]),
        "loaded_contact_ratio": mean_over_a_pitch(cycle["loaded_pairs"]),
        "fewest_loaded_pairs": _reduced(np.min, cycle["loaded_pairs"]),
        "most_loaded_pairs": _reduced(np.max, cycle["loaded_pairs"]),
        "line_load_max_N_per_mm": _reduced(np.max, row["line_load"]),
        **_line_load_figures(row, _highest(row["normal_force"])),
        "max_pressure_MPa": max_pressure,
        **_solver_figures(row),
        **_counts(path, row, cycle),
    }


def _highest(values: Array) -> int | None:
    return int(np.nanargmax(values)) if np.isfinite(values).any() else None


def _at(values: Array, position: int | None) -> float:
    return math.nan if position is None else float(values[position])


def _peak_figures(path: ContactPath, row: Row, at: int | None) -> dict[str, float]:
    """What holds at the position of the first number; its place is the contact point where it is found beside that."""
    beside = at is not None and bool(row["peak_at_edge"][at])
    radius, axial = (path.pinion_radius, path.pinion_axial) if beside else (row["peak_radius"], row["peak_axial"])
    return {
        "peak_pressure_MPa": _at(row["central_pressure"] if beside else row["peak_pressure"], at),
        "peak_is_beside_contact_point": beside,
        "contact_point_is_at_edge": beside and math.isnan(_at(row["inner_pressure"], at)),
        "pinion_angle_at_peak_deg": math.degrees(_at(path.pinion_angle, at)),
        "pinion_diameter_at_peak_mm": 2.0 * _at(radius, at),
        "pinion_axial_at_peak_mm": _at(axial, at),
        "contact_point_diameter_at_peak_mm": 2.0 * _at(path.pinion_radius, at),
        "contact_point_axial_at_peak_mm": _at(path.pinion_axial, at),
        "central_pressure_at_peak_MPa": _at(row["central_pressure"], at),
        "normal_force_at_peak_N": _at(row["normal_force"], at),
        "contact_length_at_peak_mm": _at(row["contact_length"], at),
        "contact_width_at_peak_mm": _at(row["contact_width"], at),
        "approach_at_peak_um": 1e3 * _at(row["approach"], at),
    }


def _edge_figures(path: ContactPath, row: Row, at: int | None) -> dict[str, float]:
    """The highest peak at an edge or relief start, told beside the first number."""
    return {
        "edge_pressure_MPa": _at(row["peak_pressure"], at),
        "pinion_angle_at_edge_deg": math.degrees(_at(path.pinion_angle, at)),
        "pinion_diameter_at_edge_mm": 2.0 * _at(row["peak_radius"], at),
        "pinion_axial_at_edge_mm": _at(row["peak_axial"], at),
    }


def _hertz_figures(row: Row, at: int | None) -> dict[str, float]:
    return {
        "peak_pressure_where_hertz_holds_MPa": _at(row["peak_pressure"], at),
        "hertz_pressure_there_MPa": _at(row["hertz_pressure"], at),
        "hertz_length_there_mm": 2.0 * _at(row["hertz_semi_major"], at),
        "hertz_width_there_mm": 2.0 * _at(row["hertz_semi_minor"], at),
    }


def _line_load_figures(row: Row, at: int | None) -> dict[str, float]:
    """Line load and face load factor of the most loaded contact, and whether they grow with the grid."""
    return {
        "line_load_at_largest_force_N_per_mm": _at(row["line_load"], at),
        "face_load_factor_at_largest_force": _at(row["face_load_factor"], at),
        "largest_force_is_at_edge": at is not None and bool(row["peak_at_edge"][at]),
    }


def _error_figures(name: str, error: Array, wheel_base_radius: float) -> dict[str, float]:
    """Mean and peak-to-peak of a transmission error, as an angle and as a length at the wheel's base circle."""
    mean, span = mean_over_a_pitch(error), _reduced(np.ptp, error)
    length = 1e3 * wheel_base_radius
    return {
        f"{name}_mean_arcsec": mean * ARCSEC,
        f"{name}_mean_um": mean * length,
        f"{name}_span_arcsec": span * ARCSEC,
        f"{name}_span_um": span * length,
    }


def _solver_figures(row: Row) -> dict[str, float]:
    used = {name: row[name][row[name] > 0] for name in ("cells_across", "cells_along")}
    return {
        **{f"fewest_{name}": _reduced(np.min, cells) for name, cells in used.items()},
        **{f"most_{name}": _reduced(np.max, cells) for name, cells in used.items()},
        "most_solver_iterations": _reduced(np.max, row["iterations"]),
        "worst_solver_residual": _reduced(np.max, row["residual"]),
    }


def _counts(path: ContactPath, row: Row, cycle: Row) -> dict[str, float]:
    positions = len(cycle["in_contact"])

    def count(flags: Array) -> int:
        """Positions at which a pair has the flag."""
        return int(flags.reshape(positions, -1).any(axis=1).sum())

    return {
        "positions": positions,
        "positions_in_contact": int(cycle["in_contact"].sum()),
        "line_positions": count(path.on_line & np.isfinite(row["approach"])),
        "edge_positions": count(row["on_edge"] > 0),
        "relief_start_positions": count(row["at_relief_start"] > 0),
        "edge_peak_positions": count(row["peak_at_edge"]),
        "capped_positions": count(row["capped"]),
    }


def _reduced(reduction: Any, values: Array) -> float:
    """Least, largest or span of the finite values; NaN if there is none."""
    finite = values[np.isfinite(values)]
    return float(reduction(finite)) if finite.size else math.nan
