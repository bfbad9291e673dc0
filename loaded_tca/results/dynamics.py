"""What models of gear dynamics take from a mesh cycle or a whole revolution, in SI units.

Stiffness, transmission error and pairs in contact over one pitch or over the pitches of the revolution.
"""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.errors import require
from loaded_tca.results.files import Part, variables_of
from loaded_tca.unloaded.teeth import harmonic_coefficients

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray

    from loaded_tca.arrays import Array
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.results.revolution import Revolution

TORQUE, PHASE, ORDER = "pinion_torque_Nm", "mesh_phase", "order"
OVER_PITCH, OVER_ORDERS = (TORQUE, PHASE), (TORQUE, ORDER)
SERIES = {"transmission_error": "m", "mesh_stiffness": "N_per_m", "loaded_pairs": ""}
"""Curves over the pitches that have Fourier coefficients, and the unit at the end of their names."""

PARTS: dict[str, Part] = {
    "pinion_teeth": ((), "1", "number of teeth of the pinion z1"),
    "wheel_teeth": ((), "1", "number of teeth of the wheel z2"),
    "mesh_frequency_Hz_per_pinion_rev_per_s": ((), "1", "tooth-mesh frequency over the speed of the pinion in rev/s"),
    "pinion_base_radius_m": ((), "m", "base radius of the pinion r_b1; of bevel gears at mid-face"),
    "wheel_base_radius_m": ((), "m", "base radius of the wheel r_b2; of bevel gears at mid-face"),
    "face_width_m": ((), "m", "common face width"),
    "pitches": ((), "1", "pitches of the tables, over which the mesh phase runs"),
    "periodic": (
        (),
        "1",
        "1 where the curves repeat after these pitches; 0 where these are no whole turn of a gear whose teeth deviate",
    ),
    "first_pinion_tooth": ((), "1", "tooth of the pinion at the pitch point at phi1 = 0, counted from 0"),
    "first_wheel_tooth": ((), "1", "tooth of the wheel at the pitch point at phi1 = 0, counted from 0"),
    "working_pressure_angle_rad": ((), "rad", "working transverse pressure angle alpha_wt, without mounting errors"),
    "pinion_base_helix_angle_rad": (
        (),
        "rad",
        "base helix angle beta_b of the pinion, positive: right hand, 0: spur gears; the wheel has the other hand",
    ),
    TORQUE: ((TORQUE,), "N m", "pinion torque T1"),
    PHASE: ((PHASE,), "1", "mesh phase, z1 phi1/(2 pi) modulo the pitches"),
    "pinion_angle_rad": ((PHASE,), "rad", "angle of the pinion phi1 in these pitches from 0"),
    ORDER: ((ORDER,), "1", "order of the tooth mesh k, in steps of 1/pitches; 0: the mean, with its sign"),
    "order_of_pinion": ((ORDER,), "1", "the order in cycles per turn of the pinion, k z1"),
    "order_of_wheel": ((ORDER,), "1", "the order in cycles per turn of the wheel, k z2"),
    "kind": (
        (ORDER,),
        "",
        "mesh 1: first order of the tooth mesh; mesh 1 -2 wheel: its sideband two orders of the wheel below; "
        "wheel 3: third order of rotation of the wheel; pinion 1 = wheel 2: of both gears; empty: none of these",
    ),
    "loaded_contact_ratio": ((TORQUE,), "1", "tooth pairs under load, mean over the pitches"),
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

LINE = 118
"""Characters of a line of the conventions."""
CONVENTIONS = """\
Fourier series: x(phi1) = amplitude_0 + sum over k of amplitude_k cos(k z1 phi1 + phase_k)
The unmodified, aligned pair touches at the pitch point of mid-face at phi1 = phi2 = 0; both angles grow in the motion.
The transmission error is absolute: 0 for that pair, negative where the wheel stays behind.
The mesh stiffness is a tangent, positive: d(T1/r_b1) = k |d(r_b2 TE)|; about the pinion's axis it is k r_b1^2."""
ON_SUPPORTS = """\
The transmission errors contain how shafts and bearings give way under the mean load; the mesh stiffness does not, so
that here it is no derivative of r_b2 TE: a model of the shafts has that part. Take the curve of the transmission error
less its mean, or analyse the scene without its shafts."""
NOT_PERIODIC = """\
Not periodic: {pitches} pitches are no whole turn of the {gears}, whose teeth deviate.
The curves jump where they are repeated, and orders of the {gears} leak into the orders beside them."""


def dynamics_of(result: CycleNumbers) -> xarray.Dataset:
    """Return what models of gear dynamics take from a mesh cycle; see ``MeshCycle.to_dynamics``."""
    count, sharing = len(result.path), result.scene.analysis.load_sharing
    require(
        (sharing, "analysis.load_sharing: found false; one tooth pair alone has no period, dynamics need true"),
        (count > 1, f"analysis.positions: found {count}; dynamics need the curves over a pitch, from 2 positions on"),
    )
    begin = float(result.pinion_angle[0]) / result.gear_pair.pitch
    curves = _curves_of(result, result.unloaded_transmission_error, count - 1, begin)  # the last is the first again
    return _dataset_of(result, {"pitches": 1, "periodic": 1} | curves)


def dynamics_of_revolution(revolution: Revolution) -> xarray.Dataset:
    """Return what models of gear dynamics take from a whole revolution; see ``Revolution.to_dynamics``."""
    count, pitches = len(revolution.pinion_angle), revolution.pitches
    require((count > 1, f"revolution: found {count} position; dynamics need curves, from 2 positions on"))
    curves = _curves_of(revolution, revolution.rigid_transmission_error, count, pitches=pitches)
    first = {f"first_{gear}_tooth": revolution.at_position(f"{gear}_tooth")[0] for gear in GEARS}
    orders = {f"order_of_{gear}": curves[ORDER] * teeth for gear, teeth in zip(GEARS, revolution.teeth, strict=True)}
    kinds = {"kind": np.array(["mean", *revolution.spectrum(rigid=True).kind.tolist()])}
    arrays = {"pitches": pitches, "periodic": int(revolution.is_closed)} | first | curves | orders | kinds
    gears = " and of the ".join(revolution.open_gears)
    return _dataset_of(revolution, arrays, NOT_PERIODIC.format(pitches=pitches, gears=gears) if gears else "")


def _dataset_of(result: CycleNumbers | Revolution, curves: Mapping[str, Any], caveat: str = "") -> xarray.Dataset:
    """The dataset of curves, with the numbers of the gears as far as these have them, and with conventions."""
    import xarray

    arrays = {**curves, **_constants_of(result)}
    there = {name: part for name, part in PARTS.items() if name in arrays}
    known = {name: part for name, part in there.items() if part[0] or math.isfinite(arrays[name])}
    variables = variables_of(known, arrays)
    coordinates = {name: variables.pop(name) for name in COORDINATES}
    return xarray.Dataset(variables, coordinates, _attributes_of(result, caveat))


def _constants_of(result: CycleNumbers | Revolution) -> dict[str, Any]:
    """Numbers of the gears, by the names of ``PARTS``; lengths in m."""
    pair, (pressure_angle, base_helix) = result.gear_pair, result.scene.transverse_angles
    return {
        "pinion_teeth": pair.teeth[0],
        "wheel_teeth": pair.teeth[1],
        "pinion_base_radius_m": 1e-3 * pair.base_radii[0],
        "wheel_base_radius_m": 1e-3 * pair.base_radii[1],
        "mesh_frequency_Hz_per_pinion_rev_per_s": pair.teeth[0],
        "face_width_m": 1e-3 * result.face_width,
        "working_pressure_angle_rad": pressure_angle,
        "pinion_base_helix_angle_rad": base_helix,
    }


def _curves_of(
    result: CycleNumbers | Revolution, unloaded: Array, count: int, begin: float = 0.0, pitches: int = 1
) -> dict[str, Any]:
    """Curves over the pitches and their Fourier coefficients, by the names of ``PARTS``, with what they run over.

    ``count`` positions divide the pitches evenly, the first one at ``begin`` in pitches from the pinion angle 0;
    ``unloaded``: transmission error without load (count,) or more [rad].
    """
    pair, torque = result.gear_pair, 1e-3 * result.torque
    radius = 1e-3 * pair.base_radii[1]
    phase = np.remainder(begin + pitches * np.arange(count) / count, pitches)
    ascending = np.argsort(phase)

    def over_pitches(values: Array) -> Array:
        """Numbers of the positions in the order of the mesh phase."""
        return values[..., :count][..., ascending]

    stiffness = 1e6 * result.face_width * result.mesh_stiffness
    per_torque = 1.0 / np.where(torque > 0.0, torque, math.nan)
    curves = {
        "transmission_error": radius * result.transmission_error[:, :count],
        "mesh_stiffness": stiffness[:, :count],
        "loaded_pairs": result.loaded_pairs[:, :count].astype(float),
    }
    return {
        TORQUE: torque,
        PHASE: phase[ascending],
        "pinion_angle_rad": pair.pitch * phase[ascending],
        "loaded_contact_ratio": curves["loaded_pairs"].mean(axis=-1),
        "unloaded_transmission_error_m": over_pitches(radius * unloaded),
        "transmission_error_rad": over_pitches(result.transmission_error),
        "torsional_stiffness_Nm_per_rad": over_pitches(radius**2 * stiffness),
        "normal_force_per_torque_N_per_Nm": over_pitches(result.normal_force.sum(axis=-1) * per_torque[:, None]),
        **{f"{name}{ending(name)}": over_pitches(curve) for name, curve in curves.items()},
        **_fourier_series(curves, begin / pitches, pitches),
    }


def _attributes_of(result: CycleNumbers | Revolution, caveat: str) -> dict[str, str]:
    """What stands beside the numbers: where they are from, and what their signs mean."""
    driving, analysis = "pinion" if result.gear_pair.driving > 0 else "wheel", result.scene.analysis
    held = ", from bores that are held rigid" if analysis.teeth_bend else ""
    of_half = textwrap.fill(f"Only {result.left_out}.", LINE) if result.left_out else ""
    supported = ON_SUPPORTS if result.scene.is_supported else ""
    about = CONVENTIONS, f"The {driving} drives; {analysis.bending}{held}."
    lines = *about, *filter(None, (of_half, supported, caveat))
    return {"title": result.scene.title, "version": result.version, "conventions": "\n".join(lines)}


def ending(name: str) -> str:
    """Unit of a curve of ``SERIES`` as its names end in it."""
    return f"_{SERIES[name]}" if SERIES[name] else ""


def _fourier_series(curves: Mapping[str, Array], begin: float, pitches: int) -> dict[str, Array]:
    """Orders of the tooth mesh from 0 on, amplitudes and phases of curves (torque, position) by the names of tables.

    The curves are a period of so many pitches without its end, which begins at ``begin`` in periods from the pinion
    angle 0.
    """
    highest = (next(iter(curves.values())).shape[-1] - 1) // 2
    arrays: dict[str, Array] = {ORDER: np.arange(highest + 1) / pitches}
    for name, curve in curves.items():
        closed = np.hstack([curve, curve[:, :1]])
        coefficients = np.stack([harmonic_coefficients(row, highest, begin) for row in closed])
        mean = curve.mean(axis=-1, keepdims=True)
        arrays[f"{name}_amplitude{ending(name)}"] = np.hstack([mean, np.abs(coefficients)])
        arrays[f"{name}_phase_rad"] = np.hstack([np.zeros_like(mean), np.angle(coefficients)])
    return arrays
