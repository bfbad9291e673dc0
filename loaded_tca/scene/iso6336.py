"""What ISO 6336 gives for the contact of a cylindrical pair, from its macro geometry alone."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, nan, prod

from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalMesh
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference import iso6336

FITTED_SHIFTS = -0.5, 2.0
"""Sums of profile shifts for which the standard's series of the single stiffness is fitted."""


@dataclass(frozen=True, kw_only=True)
class ContactStandard:
    """Contact factors and stiffnesses of ISO 6336-1 and -2; NaN where they give none, as for bevel gears.

    Attributes
    ----------
    stress_per_root_torque : float [MPa/(N mm)^0.5]
        sigma_H0 over the root of the pinion torque.
    single_contact : (float, float)
        Z_B of the pinion, Z_D of the wheel.
    contact_ratio, helix_angle : float
        Z_eps, Z_beta.
    single_stiffness, mesh_stiffness : float [N/(mm um)]
        c' and c_gamma_alpha under more than 100 N/mm, of solid discs.
    largest_transverse_load_factor : float
        Upper bound of K_Halpha.
    """

    stress_per_root_torque: float = nan
    single_contact: tuple[float, float] = (nan, nan)
    contact_ratio: float = nan
    helix_angle: float = nan
    single_stiffness: float = nan
    mesh_stiffness: float = nan
    largest_transverse_load_factor: float = nan


def contact_standard(mesh: CylindricalMesh, width: float, materials: tuple[Material, Material]) -> ContactStandard:
    """Values of the standard for a pair with a common face width [mm]."""
    gear, alpha, beta = mesh.pinion, mesh.transverse_contact_ratio, mesh.overlap_ratio * width / mesh.common_face_width
    try:
        by_ratio = iso6336.contact_ratio_factor(alpha, beta)
        single_contact = _single_contact(mesh, beta)
    except InputError:  # a contact ratio up to 1 or from 4 on
        return ContactStandard()
    by_helix = iso6336.helix_angle_factor(gear.helix_angle)
    by_shape = iso6336.zone_factor(gear.transverse_pressure_angle, mesh.working_pressure_angle, gear.base_helix_angle)
    factors = prod((by_shape, iso6336.elasticity_factor(contact_modulus(*materials)), by_ratio, by_helix))
    diameter = 2.0 * gear.reference_radius
    single = _single_stiffness(mesh, materials)
    return ContactStandard(
        stress_per_root_torque=iso6336.nominal_contact_stress(
            2.0 / diameter, diameter, width, mesh.gear_ratio, factors
        ),
        single_contact=single_contact,
        contact_ratio=by_ratio,
        helix_angle=by_helix,
        single_stiffness=single,
        mesh_stiffness=iso6336.mesh_stiffness(single, alpha) if single > 0.0 else nan,
        largest_transverse_load_factor=iso6336.largest_transverse_load_factor(alpha, beta),
    )


def _single_contact(mesh: CylindricalMesh, overlap_ratio: float) -> tuple[float, float]:
    """Z_B and Z_D, of the ends of the path of contact that is used."""
    path, gears = mesh.path_of_contact, (mesh.pinion, mesh.wheel)
    ends = path.E, path.T2 - path.A
    first, second = (hypot(end, gear.base_radius) / gear.base_radius for gear, end in zip(gears, ends, strict=True))
    return iso6336.single_contact_factors(
        (mesh.pinion.teeth, mesh.wheel.teeth),
        (first, second),
        mesh.working_pressure_angle,
        mesh.transverse_contact_ratio,
        overlap_ratio,
    )


def _single_stiffness(mesh: CylindricalMesh, materials: tuple[Material, Material]) -> float:
    """c' of both materials; NaN for profile shifts beyond those that the standard has fitted."""
    gear, shifts = mesh.pinion, (mesh.pinion.profile_shift, mesh.wheel.profile_shift)
    if not FITTED_SHIFTS[0] <= sum(shifts) <= FITTED_SHIFTS[1]:
        return nan
    first, second = (
        iso6336.virtual_teeth(one.teeth, one.helix_angle, one.pressure_angle) for one in (mesh.pinion, mesh.wheel)
    )
    moduli = [material.youngs_modulus for material in materials]
    return iso6336.single_stiffness(
        iso6336.theoretical_single_stiffness((first, second), shifts),
        gear.helix_angle,
        basic_rack_factor=iso6336.basic_rack_factor(gear.dedendum_coefficient, gear.pressure_angle),
        youngs_modulus=2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]),
    )
