"""Units of every column and key figure: an attribute of the result times a factor that is written down here.

The result holds random numbers, so that no factor hides behind a zero and no attribute behind another. A column or
figure without a line here is a failure.
"""

import csv
import dataclasses
import math
from functools import cache
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.output import write_comparison, write_dynamics
from loaded_tca.output.result_files import contacts_csv, positions_csv
from loaded_tca.output.tables import sensitivities_csv, subsurface_csv
from loaded_tca.results import compare_results
from loaded_tca.results.load_factors import face_load_factor_by_positions, face_load_factor_error
from loaded_tca.results.quantities import QUANTITIES, ROOT_QUANTITIES
from loaded_tca.results.subsurface import stress_below
from loaded_tca.studies.ranking import figures_of
from tests.samples.results import changed, changed_scene, result

DIGITS = {"rtol": 1e-8, "atol": 1e-12}
"""Nine of them are written."""
DEGREES, ARCSECONDS = 180.0 / math.pi, 648000.0 / math.pi
BASE_RADII = 1.5 * np.array([34, 57]) * math.cos(math.radians(20.0))  # mm; of the spur pair 34/57 of module 3
FACE = 25.0  # mm
LENGTH = 1e3 * BASE_RADII[1]  # um of the line of action per rad
GEARS = ("pinion", "wheel")
ROOT_RADII = 1.5 * np.array([34, 57]) - 1.25 * 3.0  # mm
SHEAR_MODULUS = 206000.0 / 2.6  # MPa
BODY_TORSION = 1e3 * np.sum(
    BASE_RADII**2 * ((0.55 * ROOT_RADII) ** -2 - ROOT_RADII**-2) / (4.0 * np.pi * SHEAR_MODULUS)
)
"""Twist of rings from the bores that are held to the root circles, per line load [um mm/N]."""

EVERYWHERE = {
    "pinion_torque_Nm": ("torque", 1e-3),
    "position": ("number", 1.0),
    "pinion_angle_deg": ("pinion_angle", DEGREES),
}
CONTACT_POINT = {
    "contact_point_pinion_diameter_mm": ("pinion_radius", 2.0),
    "contact_point_pinion_axial_mm": ("pinion_axial", 1.0),
    "contact_point_wheel_diameter_mm": ("wheel_radius", 2.0),
    "contact_point_wheel_axial_mm": ("wheel_axial", 1.0),
}
OF_POSITIONS = {
    "transmission_error_arcsec": ("transmission_error", ARCSECONDS),
    "transmission_error_um": ("transmission_error", LENGTH),
    "transmission_error_by_grids_arcsec": ("transmission_error_by_grids", ARCSECONDS),
    "transmission_error_by_grids_um": ("transmission_error_by_grids", LENGTH),
    "mesh_stiffness_N_per_mm_um": ("mesh_stiffness", 1.0),
    "secant_stiffness_N_per_mm_um": ("secant_stiffness", 1.0),
    "loaded_pairs": ("loaded_pairs", 1.0),
}
OF_PAIRS = {
    "normal_force_N": ("normal_force", 1.0, "force"),
    "peak_pressure_MPa": ("peak_pressure", 1.0, "peak"),
    "edge_pressure_MPa": ("edge_pressure", 1.0, "edge"),
    "edge_is_rounded": ("edge_is_rounded", 1.0, "edge"),
    "edge_pressure_error": ("edge_pressure_error", 1.0, "edge"),
    "edge_pinion_diameter_mm": ("edge_radius", 2.0, "edge"),
    "edge_pinion_axial_mm": ("edge_axial", 1.0, "edge"),
    "central_pressure_MPa": ("central_pressure", 1.0, "force"),
    "peak_pinion_diameter_mm": ("peak_radius", 2.0, "peak"),
    "peak_pinion_axial_mm": ("peak_axial", 1.0, "peak"),
    "hertz_pressure_MPa": ("hertz_pressure", 1.0, "force"),
    "hertz_width_mm": ("hertz_semi_minor", 2.0, "force"),
    "hertz_length_mm": ("hertz_semi_major", 2.0, "force"),
    "contact_width_mm": ("contact_width", 1.0, "force"),
    "contact_length_mm": ("contact_length", 1.0, "force"),
    "line_load_N_per_mm": ("line_load", 1.0, "force"),
    "line_load_ratio": ("line_load_ratio", 1.0, "force"),
    "contact_deformation_um": ("contact_deformation", 1e3, "force"),
    "tooth_deflection_um": ("tooth_deflection", 1e3, "force"),
    "on_edge": ("on_edge", 1.0, "peak"),
    "on_relief_start": ("on_relief_start", 1.0, "peak"),
    "cells_across": ("cells_across", 1.0, "peak"),
    "cells_along": ("cells_along", 1.0, "peak"),
    "discretisation_error": ("discretisation_error", 1.0, "peak"),
    "iterations": ("iterations", 1.0, "peak"),
    "residual": ("residual", 1.0, "peak"),
}
"""Column -> attribute, factor, and the pair that stands for a position: of the largest force, peak or edge pressure."""
OF_ROOTS = {
    "root_tension_MPa": ("root_tension", 1.0),
    "root_compression_MPa": ("root_compression", 1.0),
    "root_tension_angle_deg": ("root_tension_angle", DEGREES),
    "root_compression_angle_deg": ("root_compression_angle", DEGREES),
    "root_tension_axial_mm": ("root_tension_axial", 1.0),
    "root_compression_axial_mm": ("root_compression_axial", 1.0),
}
"""The same behind the name of a gear."""


def random_of(array, rng):
    """Numbers of the same type and shape: from 1 to 2, whole ones from 1 to 30, flags."""
    if array.dtype.kind == "b":
        return rng.random(array.shape) < 0.5
    return rng.integers(1, 31, array.shape) if array.dtype.kind == "i" else rng.uniform(1.0, 2.0, array.shape)


@cache
def filled(seed=1):
    """A mesh cycle of a spur pair whose arrays are random; some contacts are without load, some without Hertz."""
    rng, cycle = np.random.default_rng(seed), result("mesh_cycle_spur", positions=9, torques=(40.0, 260.0))
    kept = {"torque", "pair", "pinion_angle", "wheel_base_radius", "face_width"}
    numbers = {name: random_of(np.asarray(getattr(cycle, name)), rng) for name in QUANTITIES if name not in kept}
    numbers["normal_force"][:, ::3, 1] = 0.0
    highest = numbers["peak_pressure"].reshape(2, -1).argmax(axis=1)
    numbers["hertz_pressure"].reshape(2, -1)[[0, 1], highest] = np.nan
    sizes = {"torque": 2, "position": 9, "gear": 2, "index": 4}
    roots = {}
    for name, (axes, *_) in ROOT_QUANTITIES.items():
        values = rng.uniform(1.0, 2.0, [sizes[axis] for axis in axes]) * (-1.0 if name == "root_compression" else 1.0)
        roots[name] = axes, np.where(values > 1.5, 1, 0) if name.endswith("place") else values
    paths = [
        dataclasses.replace(
            path, **{entry.name: random_of(getattr(path, entry.name), rng) for entry in dataclasses.fields(path)}
        )
        for path in (cycle.path, *cycle.paths)
    ]
    cycle = changed_scene(changed(cycle, **numbers), {"analysis.compliance": "contact+tooth"})
    return dataclasses.replace(cycle, dataset=cycle.dataset.assign(roots), path=paths[0], paths=tuple(paths[1:]))


def over_all(cycle, values, axes):
    """Values with the named axes, over torques, positions and pairs."""
    shape = {"torque": (-1, 1, 1), "position": (1, -1, 1), "pair": (1, 1, -1)}
    if len(axes) == 1:
        values = np.reshape(values, shape[axes[0]])
    elif axes == ("position", "pair"):
        values = values[None]
    elif axes == ("torque", "position"):
        values = values[..., None]
    return np.broadcast_to(values, cycle.normal_force.shape).astype(float)


def column_everywhere(cycle, attribute):
    values = np.arange(1, 10) if attribute == "number" else getattr(cycle, attribute)
    return over_all(cycle, values, ("torque",) if attribute == "torque" else ("position",))


def expected_positions():
    """Columns of ``positions.csv`` (torque, position): values, and how they are written here."""
    cycle = filled()
    columns = {name: column_everywhere(cycle, of)[..., 0] * factor for name, (of, factor) in EVERYWHERE.items()}
    unloaded = {
        "unloaded_transmission_error_arcsec": ("unloaded_transmission_error", ARCSECONDS),
        "unloaded_transmission_error_um": ("unloaded_transmission_error", LENGTH),
    }
    columns |= {name: np.tile(factor * getattr(cycle.path, of), (2, 1)) for name, (of, factor) in CONTACT_POINT.items()}
    columns |= {name: np.tile(factor * getattr(cycle, of), (2, 1)) for name, (of, factor) in unloaded.items()}
    columns |= {name: factor * getattr(cycle, of) for name, (of, factor) in OF_POSITIONS.items()}
    highest = {"force": cycle.normal_force, "peak": cycle.peak_pressure, "edge": cycle.edge_pressure}
    for name, (of, factor, by) in OF_PAIRS.items():
        chosen = highest[by].argmax(axis=-1)[..., None]
        columns[name] = factor * np.take_along_axis(getattr(cycle, of), chosen, axis=-1)[..., 0]
    columns |= {f"load_share_pair_{number}": cycle.load_share[..., k] for k, number in enumerate((-1, 0, 1))}
    for k, gear in enumerate(GEARS):
        columns |= {f"{gear}_{name}": factor * getattr(cycle, of)[..., k] for name, (of, factor) in OF_ROOTS.items()}
    return {name: values.ravel() for name, values in columns.items()}


def expected_contacts():
    """Columns of ``contacts.csv``: of the pairs under load."""
    cycle = filled()
    columns = {name: column_everywhere(cycle, of) * factor for name, (of, factor) in EVERYWHERE.items()}
    columns["tooth_pair"] = over_all(cycle, [-1, 0, 1], ("pair",))
    for name, (of, factor) in CONTACT_POINT.items():
        values = np.stack([factor * getattr(path, of) for path in cycle.paths], axis=-1)
        columns[name] = over_all(cycle, values, ("position", "pair"))
    columns["load_share"] = cycle.load_share
    columns |= {name: factor * getattr(cycle, of) for name, (of, factor, _) in OF_PAIRS.items()}
    return {name: values[cycle.normal_force > 0.0] for name, values in columns.items()}


AT_PEAK = {
    "peak_pressure_MPa": ("peak_pressure", 1.0),
    "pinion_diameter_at_peak_mm": ("peak_radius", 2.0),
    "pinion_axial_at_peak_mm": ("peak_axial", 1.0),
    "central_pressure_at_peak_MPa": ("central_pressure", 1.0),
    "normal_force_at_peak_N": ("normal_force", 1.0),
    "contact_length_at_peak_mm": ("contact_length", 1.0),
    "contact_width_at_peak_mm": ("contact_width", 1.0),
    "contact_deformation_at_peak_um": ("contact_deformation", 1e3),
}
AT_EDGE = {
    "edge_pressure_MPa": ("edge_pressure", 1.0),
    "edge_is_rounded": ("edge_is_rounded", 1.0),
    "edge_pressure_error": ("edge_pressure_error", 1.0),
    "normal_force_at_edge_N": ("normal_force", 1.0),
    "pinion_diameter_at_edge_mm": ("edge_radius", 2.0),
    "pinion_axial_at_edge_mm": ("edge_axial", 1.0),
}
AT_LARGEST_FORCE = {
    "line_load_at_largest_force_N_per_mm": ("line_load", 1.0),
    "line_load_ratio_at_largest_force": ("line_load_ratio", 1.0),
}
WHERE_HERTZ_HOLDS = {
    "peak_pressure_where_hertz_holds_MPa": ("peak_pressure", 1.0),
    "hertz_pressure_there_MPa": ("hertz_pressure", 1.0),
    "hertz_length_there_mm": ("hertz_semi_major", 2.0),
    "hertz_width_there_mm": ("hertz_semi_minor", 2.0),
}
POINT_AT_PEAK = {
    "pinion_angle_at_peak_deg": ("pinion_angle", DEGREES),
    "contact_point_diameter_at_peak_mm": ("pinion_radius", 2.0),
    "contact_point_axial_at_peak_mm": ("pinion_axial", 1.0),
}
POINT_AT_EDGE = {"pinion_angle_at_edge_deg": ("pinion_angle", DEGREES)}
MEANS = {
    "transmission_error_mean_arcsec": ("transmission_error", ARCSECONDS),
    "transmission_error_mean_um": ("transmission_error", LENGTH),
    "mesh_stiffness_mean_N_per_mm_um": ("mesh_stiffness", 1.0),
    "secant_stiffness_mean_N_per_mm_um": ("secant_stiffness", 1.0),
    "loaded_contact_ratio": ("loaded_pairs", 1.0),
}
OF_TORQUES = {
    "pinion_torque_Nm": ("torque", 1e-3),
    "face_load_factor": ("face_load_factor", 1.0),
    "transverse_load_factor": ("transverse_load_factor", 1.0),
}
LEAST = {
    "fewest_loaded_pairs": ("loaded_pairs", 1.0),
    "fewest_cells_across": ("cells_across", 1.0),
    "fewest_cells_along": ("cells_along", 1.0),
}
LARGEST = {
    "most_loaded_pairs": ("loaded_pairs", 1.0),
    "line_load_max_N_per_mm": ("line_load", 1.0),
    "most_cells_across": ("cells_across", 1.0),
    "most_cells_along": ("cells_along", 1.0),
    "largest_discretisation_error": ("discretisation_error", 1.0),
    "most_solver_iterations": ("iterations", 1.0),
    "worst_solver_residual": ("residual", 1.0),
}
ROOT_EXTREMES = {
    "{gear}_{root}_MPa": ("{root}", 1.0),
    "{gear}_{root}_angle_deg": ("{root}_angle", DEGREES),
    "{gear}_{root}_axial_mm": ("{root}_axial", 1.0),
}


def mean(values):
    """Over a pitch, whose ends are the same place."""
    return np.trapezoid(values, dx=1.0 / (len(values) - 1), axis=0)


def expected_figures(cycle, t):
    """Key figures under one torque."""
    found, wheel_error = {}, cycle.unloaded_transmission_error
    holds = np.where(np.isnan(cycle.hertz_pressure), -1.0, cycle.peak_pressure)
    for table, points, by in (
        (AT_PEAK, POINT_AT_PEAK, cycle.peak_pressure),
        (AT_EDGE, POINT_AT_EDGE, cycle.edge_pressure),
        (AT_LARGEST_FORCE, {}, cycle.normal_force),
        (WHERE_HERTZ_HOLDS, {}, holds),
    ):
        position, pair = np.unravel_index(by[t].argmax(), by[t].shape)
        found |= {name: factor * getattr(cycle, of)[t, position, pair] for name, (of, factor) in table.items()}
        path = cycle.paths[pair]
        found |= {name: factor * getattr(path, of)[position] for name, (of, factor) in points.items()}
    found |= {name: factor * getattr(cycle, of)[t] for name, (of, factor) in OF_TORQUES.items()}
    for reduction, table in ((mean, MEANS), (np.min, LEAST), (np.max, LARGEST)):
        found |= {name: factor * reduction(getattr(cycle, of)[t]) for name, (of, factor) in table.items()}
    for unit, factor in (("arcsec", ARCSECONDS), ("um", LENGTH)):
        found[f"transmission_error_span_{unit}"] = factor * np.ptp(cycle.transmission_error[t])
        found[f"unloaded_transmission_error_mean_{unit}"] = factor * mean(wheel_error)
        found[f"unloaded_transmission_error_span_{unit}"] = factor * np.ptp(wheel_error)
    turn = 2.0 * np.pi * np.arange(8) / 8
    for order in (1, 2, 3):
        wave = 2.0 / 8 * (cycle.transmission_error[t, :-1] * np.exp(-1j * order * turn)).sum()
        found[f"transmission_error_order_{order}_um"] = LENGTH * abs(wave)
    whole = found["mesh_stiffness_mean_N_per_mm_um"]
    found["mesh_stiffness_without_body_torsion_mean_N_per_mm_um"] = 1.0 / (1.0 / whole - BODY_TORSION)
    found["max_pressure_MPa"] = cycle.max_pressure
    by_cells = face_load_factor_error(cycle.gear_pair, cycle.path, cycle.maps[t])  # as the number is
    found["face_load_factor_error"] = by_cells
    by_positions = face_load_factor_by_positions(cycle.gear_pair, cycle.path, cycle.maps[t])  # as the number is
    found["face_load_factor_by_positions"] = by_positions
    for name, flag in (("edge_positions", "on_edge"), ("relief_start_positions", "on_relief_start")):
        found[name] = np.count_nonzero(getattr(cycle, flag)[t].any(axis=-1))
    found |= {"positions": 9, "positions_in_contact": np.count_nonzero(cycle.path.in_contact)}
    found["line_positions"] = np.any([path.on_line for path in cycle.paths], axis=0).sum()
    highest = np.maximum(cycle.peak_pressure, cycle.edge_pressure)[t]
    found["capped_positions"] = np.count_nonzero((highest >= cycle.max_pressure).any(axis=-1))
    return {**found, **expected_iso_figures(cycle.torque[t]), **expected_root_figures(cycle, t)}


def expected_iso_figures(torque):
    """Key figures of ISO 6336-1 and -2: Hertz at the pitch point, and curvatures at B and D."""
    sine, cosine = math.sin(math.radians(20.0)), math.cos(math.radians(20.0))
    pitch, whole = 3.0 * math.pi * cosine, BASE_RADII.sum() * sine / cosine
    tips = np.sqrt((1.5 * np.array([34, 57]) + 3.0) ** 2 - BASE_RADII**2)
    ratio = (tips.sum() - whole) / pitch
    radii = BASE_RADII * sine / cosine
    single = [math.sqrt(radii.prod() / ((tip - pitch) * (whole - tip + pitch))) for tip in tips]
    length = math.sqrt((4.0 - ratio) / 3.0)
    modulus = 206000.0 / (2.0 * (1.0 - 0.3**2))
    hertz = math.sqrt(torque / BASE_RADII[0] / FACE * modulus / math.pi * (1.0 / radii).sum())
    stiffness = 0.8 * (1.0 - 0.5 * 0.05) / (0.04723 + 0.15551 / 34 + 0.25791 / 57)
    return {
        "nominal_contact_stress_iso_6336_MPa": length * hertz,
        "pinion_single_contact_factor_iso_6336": max(1.0, single[0]),
        "wheel_single_contact_factor_iso_6336": max(1.0, single[1]),
        "contact_ratio_factor_iso_6336": length,
        "contact_helix_angle_factor_iso_6336": 1.0,
        "single_stiffness_iso_6336_N_per_mm_um": stiffness,
        "mesh_stiffness_iso_6336_N_per_mm_um": stiffness * (0.75 * ratio + 0.25),
        "largest_transverse_load_factor_iso_6336": 1.0 / length**2,
    }


def expected_root_figures(cycle, t):
    """Key figures of root stress under one torque."""
    height_over_width = 2.25 * 3.0 / FACE
    face_factor = cycle.face_load_factor[t] ** (1.0 / (1.0 + height_over_width + height_over_width**2))
    found = {"root_face_load_factor_iso_6336": face_factor}
    for k, gear in enumerate(GEARS):
        for root in ("root_tension", "root_compression"):
            position = np.abs(getattr(cycle, root)[t, :, k]).argmax()
            for name, (of, factor) in ROOT_EXTREMES.items():
                value = factor * getattr(cycle, of.format(root=root))[t, position, k]
                found[name.format(gear=gear, root=root)] = value
            found[f"pinion_angle_at_{gear}_{root}_deg"] = DEGREES * cycle.pinion_angle[position]
            found[f"{gear}_{root}_on_back"] = getattr(cycle, f"{root}_place")[t, position, k, 1] == 1
        found[f"{gear}_rim_thickness_factor_iso_6336"] = 1.0  # rims of 0.45 root radii are 3 and 5 heights thick
        found[f"{gear}_root_stress_ratio"] = cycle.root_stress_ratio[t, k]
        names, factors = ("form", "stress_correction", "helix_angle"), cycle.scene.root_factors[k]
        found |= {f"{gear}_{name}_factor_iso_6336": one for name, one in zip(names, factors, strict=True)}
        # F_t/(b m_n) Y_F Y_S Y_beta, the force on the reference circle of the pinion
        nominal = cycle.torque[t] / (1.5 * 34) / (FACE * 3.0) * math.prod(factors)
        found[f"{gear}_nominal_root_stress_iso_6336_MPa"] = nominal
        found[f"{gear}_root_stress_iso_6336_MPa"] = nominal * face_factor
    return found


def rows_of(text):
    """Numbers of a table by its columns; NaN for an empty cell."""
    header, *rows = csv.reader(line for line in text.splitlines() if not line.startswith("#"))
    return {
        name: np.array([float(cell) if cell else np.nan for cell in cells])
        for name, cells in zip(header, zip(*rows, strict=True), strict=True)
        if name not in WORDS
    }


WORDS = {"edges", "key", "figure"}
"""Columns without numbers."""


def positions():
    return rows_of(positions_csv(filled())), expected_positions()


def contacts():
    return rows_of(contacts_csv(filled())), expected_contacts()


def figures():
    by_torque = filled().key_figures()
    expected = [expected_figures(filled(), t) for t in range(2)]
    assert expected[0].keys() == expected[1].keys()
    return ({name: [one[name] for one in rows] for name in rows[0]} for rows in (by_torque, expected))


def dynamics():
    """Both tables and all scalars: SI units."""
    cycle, found = filled(), filled().to_dynamics()
    metres = 1e-3 * BASE_RADII[1]
    stiffness = 1e6 * FACE * cycle.mesh_stiffness  # 1 N/(mm um) is 1e6 N/m for each mm of the face
    curves = {
        ("transmission_error", "_m"): metres * cycle.transmission_error,
        ("mesh_stiffness", "_N_per_m"): stiffness,
        ("loaded_pairs", ""): cycle.loaded_pairs.astype(float),
    }
    phase = np.remainder(34 * cycle.pinion_angle[:-1] / (2.0 * np.pi), 1.0)
    ascending = np.argsort(phase)
    expected = {
        "pinion_torque_Nm": 1e-3 * cycle.torque,
        "mesh_phase": phase[ascending],
        "pinion_angle_rad": 2.0 * np.pi / 34 * phase[ascending],
        "order": np.arange(4),
        "loaded_contact_ratio": [mean(pairs) for pairs in cycle.loaded_pairs[:, [*range(8), 0]]],
        "unloaded_transmission_error_m": metres * cycle.unloaded_transmission_error[:-1][ascending],
        "transmission_error_rad": cycle.transmission_error[:, :-1][:, ascending],
        "torsional_stiffness_Nm_per_rad": metres**2 * stiffness[:, :-1][:, ascending],
        "normal_force_per_torque_N_per_Nm": (cycle.normal_force.sum(axis=-1) / (1e-3 * cycle.torque[:, None]))[:, :-1][
            :, ascending
        ],
        "pinion_teeth": 34,
        "wheel_teeth": 57,
        "mesh_frequency_Hz_per_pinion_rev_per_s": 34,
        "pinion_base_radius_m": 1e-3 * BASE_RADII[0],
        "wheel_base_radius_m": metres,
        "face_width_m": 1e-3 * FACE,
        "pitches": 1,
        "periodic": 1,
        "working_pressure_angle_rad": math.radians(20.0),
        "pinion_base_helix_angle_rad": 0.0,
    }
    for (name, unit), curve in curves.items():
        turns = np.exp(-1j * np.arange(4)[:, None] * 34 * cycle.pinion_angle[:-1])
        waves = curve[:, :-1] @ turns.T / 8 * np.array([1.0, 2.0, 2.0, 2.0])
        expected[f"{name}{unit}"] = curve[:, :-1][:, ascending]
        expected[f"{name}_amplitude{unit}"] = np.abs(waves)
        expected[f"{name}_phase_rad"] = np.angle(waves)
    return {str(name): one.values for name, one in found.variables.items()}, expected


def sensitivities():
    """Of a real result: slopes of the figures, per unit and per tolerance of two keys."""
    tolerances = {"pinion.modifications.lead_crowning_um": 2.0, "load.pinion_torque_Nm": 5.0}
    cycle = result("mesh_cycle_spur", positions=9, torques=(40.0, 260.0))
    found, spread = cycle.sensitivities([*tolerances]), np.array([*tolerances.values()])
    columns = {"pinion_torque_Nm": np.repeat([40.0, 260.0], 2), "tolerance": np.tile(spread, 2)}
    slopes = {name: np.zeros((2, 2)) for name in SLOPES}
    for t, (error, slope) in enumerate(zip(cycle.transmission_error, found.transmission_error, strict=True)):
        turn = np.exp(-2j * np.pi * np.arange(8) / 8)
        wave, moved = error[:-1] @ turn, slope[:-1].T @ turn
        of_peak = np.unravel_index(np.nanargmax(cycle.peak_pressure[t]), cycle.peak_pressure[t].shape)
        values = (
            LENGTH * mean(slope),
            LENGTH * (slope[error.argmax()] - slope[error.argmin()]),
            LENGTH * 2.0 / 8 * (moved * wave.conj()).real / abs(wave),
            found.face_load_factor[t],
            found.peak_pressure[t][of_peak],
        )
        for name, value in zip(SLOPES, values, strict=True):
            slopes[name][t] = value
    columns |= {f"{name}_per_unit": values.ravel() for name, values in slopes.items()}
    columns |= {f"{name}_per_tolerance": (values * spread).ravel() for name, values in slopes.items()}
    return rows_of(sensitivities_csv(found, tolerances)), columns


SLOPES = (
    "transmission_error_mean_um",
    "transmission_error_span_um",
    "transmission_error_order_1_um",
    "face_load_factor",
    "peak_pressure_MPa",
)


def subsurface():
    """Below the highest cell of a point contact; mm and MPa as they are."""
    below = stress_below(result(positions=1))
    pressure, stress = below.pressure_map.pressure, below.stress
    cell = np.unravel_index(pressure.argmax(), pressure.shape)
    components = ("sigma_x", "sigma_y", "sigma_z", "tau_xy", "tau_xz", "tau_yz", "von_mises", "max_shear")
    columns = {f"{name}_MPa": getattr(stress, name)[:, *cell] for name in components}
    for name in components[-2:]:
        columns[f"largest_{name}_MPa"] = getattr(stress, name).reshape(len(stress.depths), -1).max(axis=1)
    return rows_of(subsurface_csv(below)), {"depth_mm": stress.depths, **columns}


def comparison():
    """Key figures of two results, row by row."""
    cycles = filled(1), filled(2)
    compared = compare_results(dict(zip("ab", cycles, strict=True)))
    with TemporaryDirectory() as folder:
        table, _ = write_comparison(compared, folder)
        text = table.read_text()
    figures = [[expected_figures(cycle, t) for t in range(2)] for cycle in cycles]
    names = [name for name in figures[0][0] if name != "pinion_torque_Nm"]
    listed = [row["figure"] for row in csv.DictReader(text.splitlines())]
    assert sorted(listed) == sorted(2 * names)
    half = len(names)
    first, second = (
        np.array([of_torques[n // half][name] for n, name in enumerate(listed)], dtype=float) for of_torques in figures
    )
    no_zero = np.array([not ("pinion_angle_at" in name or "_axial_" in name) for name in listed]) & (first != 0.0)
    relative = np.full(first.size, np.nan)
    np.divide(np.abs(second) - np.abs(first), np.abs(first), out=relative, where=no_zero & (first * second >= 0.0))
    expected = {"pinion_torque_Nm": np.repeat([40.0, 260.0], half), "a: value": first, "b: value": second}
    errors = compared.figures["difference_error"].sel(result="b").values.ravel()
    columns = {"b: difference": second - first, "b: relative_difference": relative, "b: difference_error": errors}
    return rows_of(text), {**expected, **columns}


def study():
    """Key figures as studies keep them."""
    expected = [expected_figures(filled(), t) for t in range(2)]
    return figures_of(filled()), {name: [one[name] for one in expected] for name in expected[0]}


@pytest.mark.parametrize(
    "table", [positions, contacts, figures, dynamics, sensitivities, subsurface, comparison, study]
)
def test_every_number_is_an_attribute_times_its_factor(table):
    found, expected = table()
    assert sorted(found) == sorted(expected)
    wrong = [name for name, value in expected.items() if not np.allclose(found[name], value, equal_nan=True, **DIGITS)]
    assert wrong == []


def test_tables_for_dynamics_have_the_numbers_of_their_dataset(tmp_path):
    """Twelve digits, the torques one after the other; columns are of the mesh phase or of the orders."""
    _, expected = dynamics()
    tables = [rows_of(path.read_text()) for path in write_dynamics(filled(), tmp_path / "dynamics.csv")]
    assert sorted({*tables[0], *tables[1]}) == sorted(
        name for name in expected if np.ndim(expected[name]) > 0 and name != "loaded_contact_ratio"
    )
    for table, length in zip(tables, (8, 4), strict=True):
        for name, found in table.items():
            values = np.asarray(expected[name])
            whole = np.broadcast_to(values[:, None] if name == "pinion_torque_Nm" else values, (2, length))
            # half a unit of the last digit, 5e-12; atol: what is zero
            assert_allclose(found, whole.ravel(), rtol=1e-11, atol=1e-12, err_msg=name)
