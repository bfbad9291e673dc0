"""Stresses, strengths, safeties and lives of a solved mesh: after ISO 6336-2 and -3, and at the worst places."""

from __future__ import annotations

from math import copysign, nan
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import named
from loaded_tca.rating.loads import load_factors
from loaded_tca.rating.roots import deciding_places, local_root_factors, root_of
from loaded_tca.rating.vibration import vibration
from loaded_tca.reference import iso6336, iso6336_1, iso6336_2, iso6336_3
from loaded_tca.results.root_stress import rim_factor
from loaded_tca.tribology.slices import slices_of

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import CommonInputs, RatingInputs
    from loaded_tca.reference.iso6336_6 import SNCurve

Arrays = dict[str, Array]


def evaluated(inputs: RatingInputs) -> tuple[Arrays, tuple[str, ...], bool]:
    """Arrays of ``NUMBERS`` by their names, notes, and whether the largest pressure of a torque lies at an edge."""
    loads, notes = load_factors(inputs)
    stresses = _contact_stresses(inputs, loads)
    flanks = strength_of_flanks(inputs)
    rated, curves = _of_flanks(inputs, stresses, flanks)
    roots, root_notes = _of_roots(inputs, loads)
    local, at_edge = local_flanks(inputs, loads, flanks.strength, curves)
    arrays = {"torque": np.asarray(inputs.torque), "cycles": both(inputs, inputs.cycles)}
    arrays |= loads | vibration(inputs) | stresses | rated | roots | local
    mesh, ring = inputs.mesh, inputs.mesh.wheel.teeth < 0
    scope = iso6336_1.scope_notes(
        pressure_angle=mesh.pinion.pressure_angle,
        helix_angle=mesh.pinion.helix_angle,
        transverse_contact_ratio=mesh.transverse_contact_ratio,
        profile_shifts=(0.0, 0.0) if ring else (mesh.pinion.profile_shift, mesh.wheel.profile_shift),
    )
    return arrays, tuple(dict.fromkeys((*scope, *notes, *flanks.notes, *root_notes))), at_edge


def both(inputs: CommonInputs, values: object) -> Array:
    """Values of both gears, or one of both, for each torque (t, 2)."""
    return np.array(np.broadcast_to(np.asarray(values, dtype=float), (len(inputs.torque), 2)))


def _contact_stresses(inputs: RatingInputs, loads: Arrays) -> Arrays:
    """Contact stress of the standard and its factors."""
    mesh, standard, gear = inputs.mesh, inputs.scene.contact_standard, inputs.mesh.pinion
    ones = np.ones(len(inputs.torque))
    nominal = standard.stress_per_root_torque * np.sqrt(inputs.torque)
    product = loads["K_A"] * loads["K_gamma"] * loads["K_v"] * loads["K_Hbeta"] * loads["K_Halpha"]
    stresses = [iso6336_2.contact_stress(nominal, factor, product) for factor in standard.single_contact]
    zone = iso6336.zone_factor(gear.transverse_pressure_angle, mesh.working_pressure_angle, gear.base_helix_angle)
    return {
        "Z_H": ones * zone,
        "Z_E": ones * iso6336.elasticity_factor(inputs.result.gear_pair.contact_modulus),
        "Z_eps": ones * standard.contact_ratio,
        "Z_beta": ones * standard.helix_angle,
        "Z_BD": both(inputs, standard.single_contact),
        "sigma_H0": nominal,
        "sigma_H": np.stack(stresses, axis=-1),
    }


def strength_of_flanks(inputs: RatingInputs) -> iso6336_2.FlankFactors:
    """What both flanks withstand."""
    mesh, wanted = inputs.mesh, inputs.rating
    gears = [
        iso6336_2.FlankStrength(strength.limits[0], strength.kind_of_material, strength.flank_Rz_um, strength.brinell)
        for strength in inputs.strengths
    ]
    bases = 2.0 * mesh.pinion.base_radius, copysign(2.0 * mesh.wheel.base_radius, mesh.wheel.teeth)
    with named("rating of flanks"):
        return iso6336_2.flank_factors(
            gears[0],
            gears[1],
            relative_radius=iso6336_2.relative_radius(bases, mesh.working_pressure_angle),
            velocity=inputs.velocity,
            viscosity_40=inputs.lubricant.viscosity_40_mm2_s,
            cycles=inputs.cycles,
            gear_ratio=max(mesh.gear_ratio, 1.0 / mesh.gear_ratio),
            limited_pitting=wanted.limited_pitting,
            long_life_factor=wanted.long_life_factor,
        )


def _of_flanks(
    inputs: RatingInputs, stresses: Arrays, factors: iso6336_2.FlankFactors
) -> tuple[Arrays, tuple[SNCurve, SNCurve]]:
    """Strength, safety and life of flanks after ISO 6336-2, and their curves."""
    required = inputs.rating.required_flank_safety
    arrays = {
        "sigma_H_lim": factors.limit_stresses,
        "Z_NT": factors.Z_NT,
        "Z_L": factors.Z_L,
        "Z_v": factors.Z_v,
        "Z_R": factors.Z_R,
        "Z_W_reference": factors.Z_W,
        "Z_W_static": factors.Z_W_static,
        "Z_X": factors.Z_X,
        "sigma_HG": factors.strength,
    }
    whole = {name: both(inputs, values) for name, values in arrays.items()}
    whole["flank_safety"] = whole["sigma_HG"] / stresses["sigma_H"]
    whole["flank_life"] = lives(inputs, factors.curves, required * stresses["sigma_H"])
    return whole, factors.curves


def lives(inputs: CommonInputs, curves: tuple[SNCurve, ...], stresses: Array) -> Array:
    """Hours (t, 2) that stresses (t, 2) are borne."""
    columns = [curve.life(stress) for curve, stress in zip(curves, stresses.T, strict=True)]
    return np.stack(columns, axis=-1) / inputs.cycles_per_hour


def _of_roots(inputs: RatingInputs, loads: Arrays) -> tuple[Arrays, tuple[str, ...]]:
    """Root stress, strength, safety and life of both gears after ISO 6336-3, and by the computed root tension."""
    columns: list[Arrays] = []
    notes: list[str] = []
    for place in range(len(GEARS)):
        values, remarks = _of_root(inputs, loads, place)
        columns.append(values)
        notes += [f"{GEARS[place]}: {remark}" for remark in remarks]
    count = (len(inputs.torque),)
    arrays = {
        name: np.stack([np.broadcast_to(values[name], count) for values in columns], axis=-1) for name in columns[0]
    }
    return arrays, tuple(notes)


def _of_root(inputs: RatingInputs, loads: Arrays, place: int) -> tuple[Arrays, tuple[str, ...]]:
    """Numbers of the root of one gear (t,), and notes."""
    scene, strength = inputs.scene, inputs.strengths[place]
    gear = (inputs.result.gear_pair.pinion, inputs.result.gear_pair.wheel)[place]
    of_class = inputs.rating.tolerance_class
    rim = rim_factor(gear, inputs.mesh.pinion.normal_module)
    deep = iso6336_3.deep_tooth_factor(inputs.virtual_contact_ratio, of_class) if of_class else 1.0
    form, correction, helix = scene.root_factors[place]
    nominal = scene.nominal_root_stress[place] * inputs.torque * rim * deep
    stress = nominal * loads["K_A"] * loads["K_gamma"] * loads["K_v"] * loads["K_Fbeta"] * loads["K_Falpha"]
    made_of, common = root_of(inputs, place)
    factors = iso6336_3.root_factors(made_of, stress_ratio=strength.root_stress_ratio, **common)
    required, per_hour = inputs.rating.required_root_safety, inputs.cycles_per_hour[place]
    arrays: Arrays = {
        name: np.asarray(value, dtype=float)
        for name, value in {
            "Y_F": form, "Y_S": correction, "Y_beta": helix, "Y_B": rim, "Y_DT": deep, "sigma_F0": nominal,
            "sigma_F": stress, "sigma_F_lim": strength.limits[1], "Y_ST": factors.Y_ST, "Y_NT": factors.Y_NT,
            "Y_delta_relT": factors.Y_delta_relT, "Y_delta_relT_static": factors.Y_delta_relT_static,
            "Y_R_relT": factors.Y_R_relT, "Y_X": factors.Y_X, "Y_M": factors.Y_M, "sigma_FG": factors.strength,
            "root_safety": factors.strength / stress,
        }.items()
    }  # fmt: skip
    rated = np.isfinite(stress)
    arrays["root_life"] = np.where(rated, factors.curve.life(np.where(rated, required * stress, 0.0)) / per_hour, nan)
    notes = factors.notes if rated.all() else (*factors.notes, "Y_B: the rim is thinner than the standard allows")
    if not scene.analysis.root_stress:
        return arrays, notes
    local, more = local_root(inputs, loads, place)
    return arrays | local, (*notes, *more)


def local_root(inputs: CommonInputs, loads: Arrays, place: int) -> tuple[Arrays, tuple[str, ...]]:
    """Safety and life of the root of one gear at the place with the smallest safety (t,), and notes."""
    worst = deciding_places(inputs, place)
    tension = worst.tension * loads["K_A"] * loads["K_gamma"] * loads["K_v"]
    ratio, factors, notes = local_root_factors(inputs, place, worst.ratio, np.arange(len(tension)))
    required, per_hour = inputs.rating.required_root_safety, inputs.cycles_per_hour[place]
    return {
        "local_root_stress": tension,
        "local_root_angle": worst.tangent_angle,
        "local_root_axial": worst.axial,
        "local_stress_ratio": ratio,
        "local_Y_M": factors.Y_M,
        "local_sigma_FG": factors.strength,
        "local_root_safety": factors.strength / tension,
        "local_root_life": factors.curve.life(required * tension) / per_hour,
    }, notes


def local_flanks(
    inputs: CommonInputs, loads: Arrays, strength: Array, curves: tuple[SNCurve, SNCurve]
) -> tuple[Arrays, bool]:
    """Largest contact pressure of slices, its place, safety and life of both gears; whether one lies at an edge."""
    sweep, count = slices_of(inputs.result), len(inputs.torque)
    pressure, places, at_edge = np.full(count, nan), np.full((2, count, 2), nan), False
    for torque in range(count):
        some = sweep.of_torque(torque)
        some = some[np.isfinite(sweep.pressure[some])]
        worst = int(some[sweep.pressure[some].argmax()])
        pressure[torque] = sweep.pressure[worst]
        places[0, torque] = sweep.radius[worst], sweep.wheel_radius[worst]
        places[1, torque] = sweep.axial[worst], sweep.wheel_axial[worst]
        at_edge = at_edge or bool(sweep.on_edge[worst])
    stress = pressure * np.sqrt(loads["K_A"] * loads["K_gamma"] * loads["K_v"])
    required = inputs.rating.required_flank_safety
    return {
        "local_flank_stress": stress,
        "local_flank_radius": places[0],
        "local_flank_axial": places[1],
        "local_flank_safety": strength / stress[:, None],
        "local_flank_life": lives(inputs, curves, required * np.stack([stress, stress], axis=-1)),
    }, at_edge
