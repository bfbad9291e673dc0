"""Stresses, strengths, safeties and lives of a solved mesh: after ISO 6336-2 and -3, and at the worst places."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError, named
from loaded_tca.rating.lives import FLANK, LOCAL_FLANK, LOCAL_ROOT, MODES, ROOT, Endurance, Endurances
from loaded_tca.rating.loads import load_factors
from loaded_tca.rating.solved import OF_FLANK, OF_ROOT
from loaded_tca.reference import iso6336, iso6336_1, iso6336_2, iso6336_3
from loaded_tca.results.root_stress import rim_factor

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import RatingInputs
    from loaded_tca.reference.iso6336_6 import SNCurve

Arrays = dict[str, Array]
REVERSED = -1.2
"""Smallest over largest root stress where both flanks of a tooth carry the same load (ISO 6336-3, annex B)."""


def evaluated(inputs: RatingInputs) -> tuple[Arrays, Endurances, tuple[str, ...]]:
    """Arrays of ``NUMBERS`` by their names but for damage and lives, what these follow from, and notes."""
    loads, notes = load_factors(inputs)
    stresses = _contact_stresses(inputs, loads)
    flanks = _flank_factors(inputs)
    rated = _of_flanks(inputs, stresses, flanks)
    roots, endurances, root_notes = _of_roots(inputs, loads)
    local = _local_flanks(inputs, loads, flanks)
    endurances |= {
        FLANK: _endurances_of_flanks(inputs, flanks.curves, stresses["sigma_H"]),
        LOCAL_FLANK: _endurances_of_flanks(inputs, flanks.curves, local["local_flank_stress"][:, None]),
    }
    arrays = {"torque": np.asarray(inputs.torque), "cycles": inputs.cycles}
    arrays |= loads | stresses | rated | roots | local
    mesh = inputs.mesh
    scope = iso6336_1.scope_notes(
        pressure_angle=mesh.pinion.pressure_angle,
        helix_angle=mesh.pinion.helix_angle,
        transverse_contact_ratio=mesh.transverse_contact_ratio,
        profile_shifts=(mesh.pinion.profile_shift, mesh.wheel.profile_shift),
    )
    ordered = {mode: endurances[mode] for mode in MODES if mode in endurances}
    return arrays, ordered, tuple(dict.fromkeys((*scope, *notes, *flanks.notes, *root_notes)))


def _both(inputs: RatingInputs, values: object) -> Array:
    """Values of both gears (2, ...), or one of both, for each case (c, 2)."""
    return np.array(np.broadcast_to(np.asarray(values, dtype=float).T, (len(inputs.torque), 2)))


def _on_drive(inputs: RatingInputs, stress: Array) -> Array:
    """Stress (c, ...) of the flanks that are analysed: 0 where a case loads the others."""
    idle = inputs.cases.reversed
    return np.where(idle.reshape(-1, *[1] * (stress.ndim - 1)), 0.0, stress)


def _safety(strength: Array, stress: Array) -> Array:
    """Strength over stress; inf without stress."""
    with np.errstate(divide="ignore"):
        return np.asarray(strength / stress)


def _contact_stresses(inputs: RatingInputs, loads: Arrays) -> Arrays:
    """Contact stress of the standard and its factors."""
    mesh, standard, gear = inputs.mesh, inputs.standard, inputs.mesh.pinion
    ones = np.ones(len(inputs.torque))
    nominal = standard.stress_per_root_torque * np.sqrt(inputs.torque)
    product = loads["K_A"] * loads["K_v"] * loads["K_Hbeta"] * loads["K_Halpha"]
    stresses = [iso6336_2.contact_stress(nominal, factor, product) for factor in standard.single_contact]
    zone = iso6336.zone_factor(gear.transverse_pressure_angle, mesh.working_pressure_angle, gear.base_helix_angle)
    return {
        "Z_H": ones * zone,
        "Z_E": ones * iso6336.elasticity_factor(inputs.result.gear_pair.contact_modulus),
        "Z_eps": ones * standard.contact_ratio,
        "Z_beta": ones * standard.helix_angle,
        "Z_BD": _both(inputs, standard.single_contact),
        "sigma_H0": nominal,
        "sigma_H": _on_drive(inputs, np.stack(stresses, axis=-1)),
    }


def _flank_factors(inputs: RatingInputs) -> iso6336_2.FlankFactors:
    """What both flanks withstand."""
    mesh, wanted = inputs.mesh, inputs.rating
    gears = [
        iso6336_2.FlankStrength(strength.limits[0], strength.kind_of_material, strength.flank_Rz_um, strength.brinell)
        for strength in inputs.strengths
    ]
    bases = 2.0 * mesh.pinion.base_radius, 2.0 * mesh.wheel.base_radius
    with named("rating of flanks"):
        return iso6336_2.flank_factors(
            gears[0],
            gears[1],
            relative_radius=iso6336_2.relative_radius(bases, mesh.working_pressure_angle),
            velocity=inputs.velocity,
            viscosity_40=inputs.lubricant.viscosity_40_mm2_s,
            cycles=inputs.cycles.T,
            gear_ratio=max(mesh.gear_ratio, 1.0 / mesh.gear_ratio),
            limited_pitting=wanted.limited_pitting,
            long_life_factor=wanted.long_life_factor,
        )


def _of_flanks(inputs: RatingInputs, stresses: Arrays, factors: iso6336_2.FlankFactors) -> Arrays:
    """Strength and safety of flanks after ISO 6336-2."""
    arrays = {
        "sigma_H_lim": factors.limit_stresses,
        "Z_NT": factors.Z_NT,
        "Z_L": factors.Z_L,
        "Z_v": np.stack([factors.Z_v, factors.Z_v]),
        "Z_R": factors.Z_R,
        "Z_W_reference": np.broadcast_to(factors.Z_W.reshape(2, -1), (2, len(inputs.torque))),
        "Z_W_static": factors.Z_W_static,
        "Z_X": factors.Z_X,
        "sigma_HG": factors.strength,
    }
    whole = {name: _both(inputs, values) for name, values in arrays.items()}
    whole["flank_safety"] = _safety(whole["sigma_HG"], stresses["sigma_H"])
    return whole


def _endurances_of_flanks(
    inputs: RatingInputs, curves: tuple[SNCurve, SNCurve], stresses: Array
) -> tuple[Endurance, Endurance]:
    """What damage of the flanks of both gears follows from; stresses (c, 2), or (c, 1) of both."""
    both, required = _both(inputs, stresses.T), inputs.rating.required_flank_safety
    pinion, wheel = (
        Endurance(curve, both[:, place], inputs.cycles[:, place], required, OF_FLANK)
        for place, curve in enumerate(curves)
    )
    return pinion, wheel


def _of_roots(
    inputs: RatingInputs, loads: Arrays
) -> tuple[Arrays, dict[str, tuple[Endurance, Endurance]], tuple[str, ...]]:
    """Root stress, strength and safety of both gears after ISO 6336-3, and by the computed root tension."""
    columns: list[Arrays] = []
    endurances: list[dict[str, Endurance]] = []
    notes: list[str] = []
    for place in range(len(GEARS)):
        values, curves, remarks = _of_root(inputs, loads, place)
        columns.append(values)
        endurances.append(curves)
        notes += [f"{GEARS[place]}: {remark}" for remark in remarks]
    count = (len(inputs.torque),)
    arrays = {
        name: np.stack([np.broadcast_to(values[name], count) for values in columns], axis=-1) for name in columns[0]
    }
    pinion, wheel = endurances
    return arrays, {mode: (pinion[mode], wheel[mode]) for mode in pinion}, tuple(notes)


def _of_root(inputs: RatingInputs, loads: Arrays, place: int) -> tuple[Arrays, dict[str, Endurance], tuple[str, ...]]:
    """Numbers of the root of one gear (c,), what its damage follows from, and notes."""
    mesh, strength, section = inputs.mesh, inputs.strengths[place], inputs.scene.root_sections[place]
    assert section is not None  # refused before
    gear = (inputs.result.gear_pair.pinion, inputs.result.gear_pair.wheel)[place]
    of_class = inputs.rating.tolerance_class
    rim = rim_factor(gear)
    deep = iso6336_3.deep_tooth_factor(inputs.virtual_contact_ratio, of_class) if of_class else 1.0
    form, correction, helix = inputs.scene.root_factors[place]
    nominal = inputs.scene.nominal_root_stress[place] * inputs.torque * rim * deep
    stress = nominal * loads["K_A"] * loads["K_v"] * loads["K_Fbeta"] * loads["K_Falpha"]
    made_of = iso6336_3.RootStrength(
        strength.limits[1], strength.kind_of_material, strength.root_Rz_um, strength.proof_stress_MPa
    )
    common: dict[str, Any] = {
        "notch_parameter": section.notch_parameter,
        "stress_correction_factor": section.stress_correction_factor,
        "normal_module": mesh.pinion.normal_module,
        "cycles": inputs.cycles[:, place],
        "long_life_factor": inputs.rating.long_life_factor,
    }
    ratio = np.where(inputs.cases.reversed, REVERSED, strength.root_stress_ratio)
    factors = iso6336_3.root_factors(made_of, stress_ratio=ratio, **common)
    arrays: Arrays = {
        name: np.asarray(value, dtype=float)
        for name, value in {
            "Y_F": form, "Y_S": correction, "Y_beta": helix, "Y_B": rim, "Y_DT": deep, "sigma_F0": nominal,
            "sigma_F": stress, "sigma_F_lim": strength.limits[1], "Y_ST": factors.Y_ST, "Y_NT": factors.Y_NT,
            "Y_delta_relT": factors.Y_delta_relT, "Y_delta_relT_static": factors.Y_delta_relT_static,
            "Y_R_relT": factors.Y_R_relT, "Y_X": factors.Y_X, "Y_M": factors.Y_M, "sigma_FG": factors.strength,
            "root_safety": _safety(factors.strength, stress),
        }.items()
    }  # fmt: skip
    endurances = {ROOT: _endurance_of_root(inputs, place, factors, stress)}
    rated = bool(np.isfinite(stress).all())
    notes = factors.notes if rated else (*factors.notes, "Y_B: the rim is thinner than the standard allows")
    if inputs.loads.root_tension is None:
        return arrays, endurances, notes
    local, endurances[LOCAL_ROOT], more = _local_root(inputs, loads, place, made_of, ratio, common)
    return arrays | local, endurances, (*notes, *more)


def _endurance_of_root(inputs: RatingInputs, place: int, factors: iso6336_3.RootFactors, stress: Array) -> Endurance:
    """What damage of the root of one gear follows from."""
    required = inputs.rating.required_root_safety
    return Endurance(factors.curve, stress, inputs.cycles[:, place], required, OF_ROOT)


def _local_root(
    inputs: RatingInputs,
    loads: Arrays,
    place: int,
    made_of: iso6336_3.RootStrength,
    asked: Array,
    common: dict[str, Any],
) -> tuple[Arrays, Endurance, tuple[str, ...]]:
    """Safety of the root of one gear by the largest computed tension (c,), what its damage follows from, and notes.

    ``asked`` is the stress ratio (c,) of the scene.
    """
    tensions, ratios = inputs.loads.root_tension, inputs.loads.root_stress_ratio
    assert tensions is not None  # asked before
    assert ratios is not None
    tension = np.where(inputs.torque > 0.0, tensions[:, place], 0.0) * loads["K_A"] * loads["K_v"]
    ratio = np.clip(np.minimum(ratios[:, place], asked), REVERSED, 0.0)
    notes: tuple[str, ...] = ()
    try:
        factors = iso6336_3.root_factors(made_of, stress_ratio=ratio, **common)
    except InputError:  # cast irons, of which the standard has no sensitivity
        factors = iso6336_3.root_factors(made_of, **common)
        notes = ("local Y_M: the standard has no mean stress sensitivity of this material; 1 counts",)
    return (
        {
            "local_root_stress": tension,
            "local_stress_ratio": ratio,
            "local_Y_M": factors.Y_M,
            "local_sigma_FG": factors.strength,
            "local_root_safety": _safety(factors.strength, tension),
        },
        _endurance_of_root(inputs, place, factors, tension),
        notes,
    )


def _local_flanks(inputs: RatingInputs, loads: Arrays, factors: iso6336_2.FlankFactors) -> Arrays:
    """Largest contact pressure of slices with its place, and safety of both gears."""
    pressure = _on_drive(inputs, np.where(inputs.torque > 0.0, inputs.loads.pressure, 0.0))
    stress = pressure * np.sqrt(loads["K_A"] * loads["K_v"])
    radius, axial = inputs.loads.places
    return {
        "local_flank_stress": stress,
        "local_flank_radius": radius,
        "local_flank_axial": axial,
        "local_flank_safety": _safety(_both(inputs, factors.strength), stress[:, None]),
    }
