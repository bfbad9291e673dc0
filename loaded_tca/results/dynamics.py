"""What models of gear dynamics take from a mesh cycle: stiffness, transmission error, pairs in contact, in SI units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.errors import require
from loaded_tca.results.files import Part, variables_of
from loaded_tca.unloaded.teeth import harmonic_coefficients

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray

    from loaded_tca.arrays import Array
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.numbers import CycleNumbers

TORQUE, PHASE, ORDER = "pinion_torque_Nm", "mesh_phase", "order"
OVER_PITCH, OVER_ORDERS = (TORQUE, PHASE), (TORQUE, ORDER)
SERIES = {"transmission_error": "m", "mesh_stiffness": "N_per_m", "loaded_pairs": ""}
"""Curves over the pitch that have Fourier coefficients, and the unit at the end of their names."""

PARTS: dict[str, Part] = {
    "pinion_teeth": ((), "1", "number of teeth of the pinion z1"),
    "wheel_teeth": ((), "1", "number of teeth of the wheel z2"),
    "mesh_frequency_Hz_per_pinion_rev_per_s": ((), "1", "tooth-mesh frequency over the speed of the pinion in rev/s"),
    "pinion_base_radius_m": ((), "m", "base radius of the pinion r_b1; of bevel gears at mid-face"),
    "wheel_base_radius_m": ((), "m", "base radius of the wheel r_b2; of bevel gears at mid-face"),
    "face_width_m": ((), "m", "common face width"),
    "working_pressure_angle_rad": ((), "rad", "working transverse pressure angle alpha_wt, without mounting errors"),
    "pinion_base_helix_angle_rad": (
        (),
        "rad",
        "base helix angle beta_b of the pinion, positive: right hand, 0: spur gears; the wheel has the other hand",
    ),
    TORQUE: ((TORQUE,), "N m", "pinion torque T1"),
    PHASE: ((PHASE,), "1", "mesh phase, z1 phi1/(2 pi) modulo 1"),
    "pinion_angle_rad": ((PHASE,), "rad", "angle of the pinion phi1 in its first pitch from 0"),
    ORDER: ((ORDER,), "1", "order of the tooth mesh k; 0: the mean, with its sign"),
    "loaded_contact_ratio": ((TORQUE,), "1", "tooth pairs under load, mean over the pitch"),
    "unloaded_transmission_error_m": ((PHASE,), "m", "transmission error without load, times r_b2"),
    "transmission_error_rad": (OVER_PITCH, "rad", "loaded transmission error TE = phi2 - (z1/z2) phi1, at the wheel"),
    "transmission_error_m": (OVER_PITCH, "m", "r_b2 TE: along the line of action in the transverse plane"),
    "mesh_stiffness_N_per_m": (OVER_PITCH, "N/m", "tangent of T1/r_b1 to r_b2 TE, of the whole face width"),
    "torsional_stiffness_Nm_per_rad": (OVER_PITCH, "N m/rad", "mesh stiffness about the wheel axis, times r_b2^2"),
    "loaded_pairs": (OVER_PITCH, "1", "number of tooth pairs under load"),
    "normal_force_per_torque_N_per_Nm": (OVER_PITCH, "1/m", "sum of the normal forces of all pairs over T1"),
    "transmission_error_amplitude_m": (OVER_ORDERS, "m", "amplitude of r_b2 TE"),
    "transmission_error_phase_rad": (OVER_ORDERS, "rad", "phase of the transmission error"),
    "mesh_stiffness_amplitude_N_per_m": (OVER_ORDERS, "N/m", "amplitude of the mesh stiffness"),
    "mesh_stiffness_phase_rad": (OVER_ORDERS, "rad", "phase of the mesh stiffness"),
    "loaded_pairs_amplitude": (OVER_ORDERS, "1", "amplitude of the number of tooth pairs under load"),
    "loaded_pairs_phase_rad": (OVER_ORDERS, "rad", "phase of the number of tooth pairs under load"),
}
"""Name in the dataset of ``dynamics_of`` and in its tables -> dimensions, unit, long name."""
COORDINATES = (TORQUE, PHASE, "pinion_angle_rad", ORDER)

CONVENTIONS = """\
Fourier series: x(phi1) = amplitude_0 + sum over k of amplitude_k cos(k z1 phi1 + phase_k)
The unmodified, aligned pair touches at the pitch point of mid-face at phi1 = phi2 = 0; both angles grow in the motion.
The transmission error is absolute: 0 for that pair, negative where the wheel stays behind.
The mesh stiffness is a tangent, positive: d(T1/r_b1) = k |d(r_b2 TE)|; about the pinion's axis it is k r_b1^2."""


def dynamics_of(result: CycleNumbers) -> xarray.Dataset:
    """Return what models of gear dynamics take from a result; see ``MeshCycle.to_dynamics``."""
    import xarray

    count, sharing = len(result.path), result.scene.analysis.load_sharing
    require(
        (sharing, "analysis.load_sharing: found false; one tooth pair alone has no period, dynamics need true"),
        (count > 1, f"analysis.positions: found {count}; dynamics need the curves over a pitch, from 2 positions on"),
    )
    arrays = _constants_of(result) | _curves_of(result)
    known = {name: part for name, part in PARTS.items() if part[0] or math.isfinite(arrays[name])}  # not of bevels
    variables = variables_of(known, arrays)
    coordinates = {name: variables.pop(name) for name in COORDINATES}
    return xarray.Dataset(variables, coordinates, _attributes_of(result))


def teeth_and_radii(pair: GearPair) -> dict[str, float]:
    """Numbers of teeth and base radii [m], by the names of ``PARTS``."""
    return {
        "pinion_teeth": pair.teeth[0],
        "wheel_teeth": pair.teeth[1],
        "pinion_base_radius_m": 1e-3 * pair.base_radii[0],
        "wheel_base_radius_m": 1e-3 * pair.base_radii[1],
    }


def _constants_of(result: CycleNumbers) -> dict[str, Any]:
    """Numbers of the gears, by the names of ``PARTS``; lengths in m."""
    pair, (pressure_angle, base_helix) = result.gear_pair, result.scene.transverse_angles
    return {
        **teeth_and_radii(pair),
        "mesh_frequency_Hz_per_pinion_rev_per_s": pair.teeth[0],
        "face_width_m": 1e-3 * result.face_width,
        "working_pressure_angle_rad": pressure_angle,
        "pinion_base_helix_angle_rad": base_helix,
    }


def _curves_of(result: CycleNumbers) -> dict[str, Any]:
    """Curves over the pitch and their Fourier coefficients, by the names of ``PARTS``, with what they run over."""
    pair, torque, count = result.gear_pair, 1e-3 * result.torque, len(result.path)
    radius = 1e-3 * pair.base_radii[1]
    begin = float(result.pinion_angle[0]) / pair.pitch
    phase = np.remainder(begin + np.arange(count - 1) / (count - 1), 1.0)
    ascending = np.argsort(phase)

    def over_pitch(values: Array) -> Array:
        """Numbers of the positions but the last, which is the first a pitch later, in the order of the mesh phase."""
        return values[..., :-1][..., ascending]

    stiffness = 1e6 * result.face_width * result.mesh_stiffness
    per_torque = 1.0 / np.where(torque > 0.0, torque, math.nan)
    curves = {
        "transmission_error": radius * result.transmission_error,
        "mesh_stiffness": stiffness,
        "loaded_pairs": result.loaded_pairs.astype(float),
    }
    return {
        TORQUE: torque,
        PHASE: phase[ascending],
        "pinion_angle_rad": pair.pitch * phase[ascending],
        "loaded_contact_ratio": curves["loaded_pairs"][:, :-1].mean(axis=-1),
        "unloaded_transmission_error_m": over_pitch(radius * result.unloaded_transmission_error),
        "transmission_error_rad": over_pitch(result.transmission_error),
        "torsional_stiffness_Nm_per_rad": over_pitch(radius**2 * stiffness),
        "normal_force_per_torque_N_per_Nm": over_pitch(result.normal_force.sum(axis=-1) * per_torque[:, None]),
        **{f"{name}{ending(name)}": over_pitch(curve) for name, curve in curves.items()},
        **_fourier_series(curves, begin, (count - 2) // 2),
    }


def _attributes_of(result: CycleNumbers) -> dict[str, str]:
    """What stands beside the numbers: where they are from, and what their signs mean."""
    driving = "pinion" if result.gear_pair.driving > 0 else "wheel"
    held = ", from bores that are held rigid" if result.scene.analysis.teeth_bend else ""
    return {
        "title": result.scene.title,
        "version": result.version,
        "conventions": f"{CONVENTIONS}\nThe {driving} drives; {result.bending}{held}.",
    }


def ending(name: str) -> str:
    """Unit of a curve of ``SERIES`` as its names end in it."""
    return f"_{SERIES[name]}" if SERIES[name] else ""


def _fourier_series(curves: Mapping[str, Array], begin: float, highest: int) -> dict[str, Array]:
    """Orders of the tooth mesh from 0 on, amplitudes and phases of curves (torque, position) by the names of tables.

    ``begin``: the first position, in pitches from the pinion angle 0.
    """
    arrays: dict[str, Array] = {ORDER: np.arange(highest + 1, dtype=np.int32)}
    for name, curve in curves.items():
        coefficients = np.stack([harmonic_coefficients(row, highest, begin) for row in curve])
        mean = curve[:, :-1].mean(axis=-1, keepdims=True)
        arrays[f"{name}_amplitude{ending(name)}"] = np.hstack([mean, np.abs(coefficients)])
        arrays[f"{name}_phase_rad"] = np.hstack([np.zeros_like(mean), np.angle(coefficients)])
    return arrays
