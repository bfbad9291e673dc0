"""Stresses, strengths, safeties and lives of a solved mesh: after ISO 6336-2 and -3, and at the worst places."""

from __future__ import annotations

from collections.abc import Callable
from math import copysign
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import named
from loaded_tca.rating.lives import FLANK, LOCAL_FLANK, LOCAL_ROOT, MODES, ROOT, Endurance, Endurances
from loaded_tca.rating.loads import load_factors
from loaded_tca.rating.roots import local_root_factors, pressed_by_others, root_of, under_loads_of_both_flanks
from loaded_tca.rating.solved import OF_FLANK, OF_ROOT
from loaded_tca.rating.vibration import vibration
from loaded_tca.reference import iso6336, iso6336_1, iso6336_2, iso6336_3
from loaded_tca.results.root_stress import rim_factor

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import CommonInputs, RatingInputs
    from loaded_tca.reference.iso6336_6 import SNCurve

Arrays = dict[str, Array]
Evaluated = tuple[Arrays, Endurances, tuple[str, ...]]
"""Arrays of ``NUMBERS`` by their names but for damage and lives, what these follow from, and notes."""
OfRoot = tuple[Arrays, dict[str, Endurance], tuple[str, ...]]
"""The same of the root of one gear."""


def evaluated(inputs: RatingInputs) -> Evaluated:
    """Numbers after ISO 6336, and by the local stresses."""
    loads, notes = load_factors(inputs)
    stresses = _contact_stresses(inputs, loads)
    flanks = strength_of_flanks(inputs)
    rated = of_flanks(inputs, flanks, stresses["sigma_H"])
    roots, endurances, root_notes = of_both_roots(inputs, lambda place: _of_root(inputs, loads, place))
    local = local_flanks(inputs, loads, flanks.strength)
    mesh, ring = inputs.mesh, inputs.mesh.wheel.teeth < 0
    scope = iso6336_1.scope_notes(
        pressure_angle=mesh.pinion.pressure_angle,
        helix_angle=mesh.pinion.helix_angle,
        transverse_contact_ratio=mesh.transverse_contact_ratio,
        profile_shifts=(0.0, 0.0) if ring else (mesh.pinion.profile_shift, mesh.wheel.profile_shift),
    )
    arrays = {"torque": np.asarray(inputs.torque), "cycles": inputs.cycles}
    arrays |= loads | vibration(inputs) | stresses | rated | roots | local
    endurances |= endurances_of_flanks(inputs, flanks.curves, arrays)
    return arrays, in_order(endurances), tuple(dict.fromkeys((*scope, *notes, *flanks.notes, *root_notes)))


def in_order(endurances: dict[str, tuple[Endurance, Endurance]]) -> Endurances:
    """Kinds of failure in the order of ``MODES``."""
    return {mode: endurances[mode] for mode in MODES if mode in endurances}


def both(inputs: CommonInputs, values: object) -> Array:
    """Values of both gears (2, ...), or one of both, for each case (c, 2)."""
    return np.array(np.broadcast_to(np.asarray(values, dtype=float).T, (len(inputs.torque), 2)))


def on_drive(inputs: CommonInputs, stress: Array) -> Array:
    """Stress (c, ...) of the flanks that are analysed: 0 where a case loads the others."""
    idle = inputs.cases.on_other_flanks
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
        "sigma_H": on_drive(inputs, np.stack(stresses, axis=-1)),
    }


def strength_of_flanks(inputs: RatingInputs) -> iso6336_2.FlankFactors:
    """What both flanks withstand."""
    mesh = inputs.mesh
    bases = 2.0 * mesh.pinion.base_radius, copysign(2.0 * mesh.wheel.base_radius, mesh.wheel.teeth)
    with named("rating of flanks"):
        return iso6336_2.flank_factors(
            *flank_strengths(inputs),
            relative_radius=iso6336_2.relative_radius(bases, mesh.working_pressure_angle),
            gear_ratio=mesh.gear_ratio,
            **flank_conditions(inputs),
        )


def flank_strengths(inputs: CommonInputs) -> tuple[iso6336_2.FlankStrength, iso6336_2.FlankStrength]:
    """Materials and surfaces of both flanks."""
    pinion, wheel = (
        iso6336_2.FlankStrength(strength.limits[0], strength.kind_of_material, strength.flank_Rz_um, strength.brinell)
        for strength in inputs.strengths
    )
    return pinion, wheel


def flank_conditions(inputs: CommonInputs) -> dict[str, Any]:
    """What the strength of flanks depends on, whatever the kind of gears."""
    return {
        "velocity": inputs.velocity,
        "viscosity_40": inputs.lubricant.viscosity_40_mm2_s,
        "cycles": inputs.cycles.T,
        "limited_pitting": inputs.rating.limited_pitting,
        "long_life_factor": inputs.rating.long_life_factor,
    }


def of_flanks(inputs: CommonInputs, factors: iso6336_2.FlankFactors, stress: Array) -> Arrays:
    """Factors of strength and safety of flanks (c, 2); ``stress`` is sigma_H."""
    arrays = {
        "sigma_H_lim": factors.limit_stresses,
        "Z_NT": factors.Z_NT,
        "Z_L": factors.Z_L,
        "Z_v": np.stack([factors.Z_v, factors.Z_v]),
        "Z_R": factors.Z_R,
        "Z_W_reference": np.broadcast_to(np.reshape(factors.Z_W, (2, -1)), (2, len(inputs.torque))),
        "Z_W_static": factors.Z_W_static,
        "Z_X": factors.Z_X,
        "sigma_HG_static": factors.static_strength,
        "sigma_HG_reference": factors.reference_strength,
        "sigma_HG": factors.strength,
    }
    whole = {name: both(inputs, values) for name, values in arrays.items()}
    whole["flank_safety"] = _safety(whole["sigma_HG"], stress)
    return whole


def endurances_of_flanks(
    inputs: CommonInputs, curves: tuple[SNCurve, SNCurve], arrays: Arrays
) -> dict[str, tuple[Endurance, Endurance]]:
    """What damage of the flanks of both gears follows from, by sigma_H and by the local stress."""
    required = inputs.rating.required_flank_safety

    def of(stresses: Array) -> tuple[Endurance, Endurance]:
        pinion, wheel = (
            Endurance(curve, stresses[:, place], inputs.cycles[:, place], required, OF_FLANK)
            for place, curve in enumerate(curves)
        )
        return pinion, wheel

    local = both(inputs, np.stack([arrays["local_flank_stress"]] * len(GEARS)))
    return {FLANK: of(arrays["sigma_H"]), LOCAL_FLANK: of(local)}


def of_both_roots(
    inputs: CommonInputs, of_root: Callable[[int], OfRoot]
) -> tuple[Arrays, dict[str, tuple[Endurance, Endurance]], tuple[str, ...]]:
    """Numbers (c, 2), endurances and notes of both roots, from those of the pinion, 0, and the wheel, 1."""
    columns, endurances, remarks = zip(*(of_root(place) for place in range(len(GEARS))), strict=True)
    count = (len(inputs.torque),)
    arrays = {
        name: np.stack([np.broadcast_to(values[name], count) for values in columns], axis=-1) for name in columns[0]
    }
    pinion, wheel = endurances
    notes = tuple(f"{gear}: {note}" for gear, some in zip(GEARS, remarks, strict=True) for note in some)
    return arrays, {mode: (pinion[mode], wheel[mode]) for mode in pinion}, notes


def _of_root(inputs: RatingInputs, loads: Arrays, place: int) -> OfRoot:
    """Root of one gear after ISO 6336-3, and by the computed root tension."""
    scene = inputs.scene
    gear = (inputs.result.gear_pair.pinion, inputs.result.gear_pair.wheel)[place]
    of_class = inputs.rating.tolerance_class
    rim = rim_factor(gear, inputs.mesh.pinion.normal_module)
    deep = iso6336_3.deep_tooth_factor(inputs.virtual_contact_ratio, of_class) if of_class else 1.0
    form, correction, helix = scene.root_factors[place]
    nominal = scene.nominal_root_stress[place] * inputs.torque * rim * deep
    stress = nominal * loads["K_A"] * loads["K_gamma"] * loads["K_v"] * loads["K_Fbeta"] * loads["K_Falpha"]
    standard, endurances, notes = of_root(inputs, loads, place, stress)
    factors = {"Y_F": form, "Y_S": correction, "Y_beta": helix, "Y_B": rim, "Y_DT": deep, "sigma_F0": nominal}
    if not np.isfinite(stress).all():
        notes = (*notes, "Y_B: the rim is thinner than the standard allows")
    return {name: np.asarray(value, dtype=float) for name, value in factors.items()} | standard, endurances, notes


def of_root(inputs: CommonInputs, loads: Arrays, place: int, stress: Array) -> OfRoot:
    """Strength and safety of the root of one gear (c,) with sigma_F, and by the computed root tension."""
    made_of, common = root_of(inputs, place)
    cycles = inputs.cycles[:, place]
    ratio = under_loads_of_both_flanks(inputs, inputs.strengths[place].root_stress_ratio)
    factors = iso6336_3.root_factors(made_of, cycles=cycles, stress_ratio=ratio, **common)
    arrays = {
        name: np.asarray(value, dtype=float)
        for name, value in {
            "sigma_F": stress, "sigma_F_lim": made_of.limit_stress, "Y_ST": factors.Y_ST, "Y_NT": factors.Y_NT,
            "Y_delta_relT": factors.Y_delta_relT, "Y_delta_relT_static": factors.Y_delta_relT_static,
            "Y_R_relT": factors.Y_R_relT, "Y_X": factors.Y_X, "Y_M": factors.Y_M, "Y_M_static": factors.Y_M_static,
            "sigma_FG_static": factors.static_strength, "sigma_FG_reference": factors.reference_strength,
            "sigma_FG": factors.strength, "root_safety": _safety(factors.strength, stress),
        }.items()
    }  # fmt: skip
    endurances = {ROOT: _endurance_of_root(inputs, place, factors, stress)}
    if not inputs.scene.analysis.root_stress:
        return arrays, endurances, factors.notes
    local, endurances[LOCAL_ROOT], more = _local_root(inputs, loads, place)
    return arrays | local, endurances, (*factors.notes, *more)


def _endurance_of_root(inputs: CommonInputs, place: int, factors: iso6336_3.RootFactors, stress: Array) -> Endurance:
    """What damage of the root of one gear follows from."""
    required = inputs.rating.required_root_safety
    return Endurance(factors.curve, stress, inputs.cycles[:, place], required, OF_ROOT)


def _local_root(inputs: CommonInputs, loads: Arrays, place: int) -> tuple[Arrays, Endurance, tuple[str, ...]]:
    """Safety of the root of one gear at the place that decides (c,), what its damage follows from, and notes.

    That is where the mesh alone has the smallest, or, where loads of the other flanks press all places more than the
    mesh does, that of the largest tension.
    """
    solved = inputs.loads
    assert solved.root_tension is not None  # asked before
    assert solved.largest_root_tension is not None
    assert solved.root_stress_ratio is not None
    assert solved.root_places is not None
    assert solved.largest_root_places is not None
    every, ratios = np.arange(len(inputs.torque)), solved.root_stress_ratio[:, place]
    by_others = pressed_by_others(inputs, place)
    ratio, factors, notes = local_root_factors(inputs, place, np.where(by_others, 0.0, ratios), every)
    tension = np.where(by_others, solved.largest_root_tension[:, place], solved.root_tension[:, place])
    tension = np.where(inputs.torque > 0.0, tension, 0.0) * loads["K_A"] * loads["K_gamma"] * loads["K_v"]
    angle, axial = np.where(by_others, solved.largest_root_places[..., place], solved.root_places[..., place])
    return (
        {
            "local_root_stress": tension,
            "local_root_angle": angle,
            "local_root_axial": axial,
            "local_stress_ratio": ratio,
            "local_Y_M": factors.Y_M,
            "local_Y_M_static": factors.Y_M_static,
            "local_sigma_FG": factors.strength,
            "local_root_safety": _safety(factors.strength, tension),
        },
        _endurance_of_root(inputs, place, factors, tension),
        notes,
    )


def local_flanks(inputs: CommonInputs, loads: Arrays, strength: Array) -> Arrays:
    """Largest contact pressure of slices with its place, and safety of both gears; ``strength``: sigma_HG (2, ...)."""
    pressure = on_drive(inputs, np.where(inputs.torque > 0.0, inputs.loads.pressure, 0.0))
    stress = pressure * np.sqrt(loads["K_A"] * loads["K_gamma"] * loads["K_v"])
    radius, axial = inputs.loads.places
    return {
        "local_flank_stress": stress,
        "local_flank_radius": radius - np.array([0.0, inputs.scene.rack_radius or 0.0]),
        "local_flank_axial": axial,
        "local_flank_safety": _safety(both(inputs, strength), stress[:, None]),
    }
