"""Load factors of ISO 6336-1 for a solved mesh: of the analysis, given, or by method B."""

from __future__ import annotations

from math import cos, hypot
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import named
from loaded_tca.rating.vibration import resonance_ratio, standard_stiffness
from loaded_tca.reference import iso6336, iso6336_1
from loaded_tca.reference.iso1328 import flank_tolerances
from loaded_tca.reference.iso6336_3 import face_load_factor
from loaded_tca.scene.rating import ANALYSIS, METHOD_B

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import CommonInputs, RatingInputs


def load_factors(inputs: RatingInputs) -> tuple[dict[str, Array], tuple[str, ...]]:
    """K_A, K_gamma, K_v with what it follows from, K_Hbeta, K_Halpha, K_Fbeta and K_Falpha (c,), and notes.

    K_Hbeta of the analysis counts from 1 on; K_Halpha and K_Falpha of the analysis are held within the bounds of the
    standard.
    """
    wanted = inputs.rating
    ones = np.ones(len(inputs.torque))
    dynamic = ones * inputs.operation.dynamic_factor
    notes: tuple[str, ...] = ()
    parts: dict[str, Array] = {}
    if wanted.dynamic_factor == METHOD_B:
        dynamic, parts, notes = _dynamic_factor(inputs)
    face = flank_face_load_factor(inputs)
    flank, root = _transverse_factors(inputs, dynamic * face)
    height = inputs.scene.tooth_height_over_width
    factors = {
        "K_A": ones * inputs.operation.application_factor,
        "K_gamma": ones * inputs.loads.mesh_load_factor,
        **parts,
        "K_v": dynamic,
        "K_Hbeta": face,
        "K_Halpha": ones * flank,
        "K_Fbeta": face_load_factor(face, height),
        "K_Falpha": ones * root,
    }
    return factors, notes


def flank_face_load_factor(inputs: CommonInputs) -> Array:
    """K_Hbeta (c,): of the analysis, from 1 on, or given."""
    if inputs.duty.case_face_load_factor is not None:
        return inputs.duty.case_face_load_factor
    wanted, ones = inputs.rating.face_load_factor, np.ones(len(inputs.torque))
    return np.maximum(ones * (inputs.loads.face_load_factor if wanted == ANALYSIS else float(wanted)), 1.0)


def _deviations(inputs: RatingInputs) -> tuple[float, float]:
    """f_pb and f_f_alpha of the tolerance class, the larger of both gears [um]."""
    assert inputs.rating.tolerance_class is not None
    pitches, profiles = [], []
    for name, gear in zip(GEARS, (inputs.mesh.pinion, inputs.mesh.wheel), strict=True):
        with named(f"rating.tolerance_class: {name}"):
            tolerances = flank_tolerances(
                gear.tooth_count, gear.normal_module, gear.face_width, inputs.rating.tolerance_class, gear.helix_angle
            )
        pitches.append(tolerances.single_pitch * cos(gear.transverse_pressure_angle))
        profiles.append(tolerances.profile_form)
    return max(pitches), max(profiles)


def run_in(inputs: CommonInputs, deviation: float) -> Array:
    """Running-in allowance for a deviation (c,), the mean of both gears [um]."""
    pinion, wheel = (
        iso6336_1.running_in_allowance(strength.kind_of_material, deviation, strength.limits[0], inputs.velocity)
        for strength in inputs.strengths
    )
    return 0.5 * (pinion + wheel)


def _tip_relief(inputs: RatingInputs) -> float:
    """C_a [um]: tip relief with root relief of the mating gear, the smaller of both; at least that of running in."""
    pinion, wheel = inputs.scene.pinion.modifications, inputs.scene.wheel.modifications
    designed = min(
        pinion.tip_relief_um + wheel.root_relief_um,
        wheel.tip_relief_um + pinion.root_relief_um,
    )
    run_in = 0.5 * sum(iso6336_1.running_in_relief(strength.limits[0]) for strength in inputs.strengths)
    return max(designed, run_in)


def _dynamic_factor(inputs: RatingInputs) -> tuple[Array, dict[str, Array], tuple[str, ...]]:
    """K_v (c,) by method B, what it follows from by the names of ``NUMBERS``, and notes with their cases."""
    standard, mesh = inputs.standard, inputs.mesh
    shares = iso6336.share_of_stiffness(inputs.load)
    pitch, profile = _deviations(inputs)
    ratio, stiffness = mesh.gear_ratio, standard.single_stiffness * shares
    allowances, relief = (run_in(inputs, pitch), run_in(inputs, profile)), _tip_relief(inputs)
    factor = iso6336_1.dynamic_factor(
        resonance_ratio(inputs, standard_stiffness(inputs)),
        inputs.load,
        single_stiffness=stiffness,
        total_contact_ratio=mesh.total_contact_ratio,
        pitch_deviation=pitch - allowances[0],
        profile_deviation=profile - allowances[1],
        tip_relief=relief,
        speed_parameter=inputs.velocity * mesh.pinion.teeth / 100.0 * ratio / hypot(1.0, ratio),
    )
    parts: dict[str, Array | float] = {
        "specific_load": inputs.load, "single_stiffness": stiffness, "f_pb": pitch, "y_p": allowances[0],
        "f_falpha": profile, "y_f": allowances[1], "C_a": relief, "B_p": factor.B_p, "B_f": factor.B_f,
        "B_k": factor.B_k,
    }  # fmt: skip
    count = (len(inputs.torque),)
    whole = {name: np.array(np.broadcast_to(values, count)) for name, values in parts.items()}
    return factor.K_v, whole, inputs.notes_of_cases(factor.notes, factor.noted)


def _transverse_factors(inputs: RatingInputs, load_factor: Array) -> tuple[Array, Array]:
    """K_Halpha and K_Falpha (c,); ``load_factor`` is K_v K_Hbeta."""
    wanted, mesh, standard = inputs.rating.transverse_load_factor, inputs.mesh, inputs.standard
    if wanted == ANALYSIS:
        of_analysis = inputs.loads.transverse_load_factor
        ratios = mesh.transverse_contact_ratio, mesh.overlap_ratio, inputs.virtual_contact_ratio
        bounds = standard.largest_transverse_load_factor, iso6336_1.largest_root_load_factor(*ratios)
        flank, root = (np.clip(of_analysis, 1.0, max(1.0, bound)) for bound in bounds)
        return flank, root
    if wanted != METHOD_B:
        return np.asarray(float(wanted)), np.asarray(float(wanted))
    pitch, profile = _deviations(inputs)
    return iso6336_1.transverse_load_factors(
        inputs.load * load_factor,
        mesh_stiffness=standard.mesh_stiffness * iso6336.share_of_stiffness(inputs.load),
        deviation=max(pitch, profile) - run_in(inputs, pitch),
        transverse_contact_ratio=mesh.transverse_contact_ratio,
        overlap_ratio=mesh.overlap_ratio,
        virtual_contact_ratio=inputs.virtual_contact_ratio,
    )
