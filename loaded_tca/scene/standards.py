"""What standards say of the gears of a scene, from their macro geometry alone: ISO 6336, ISO 21771, ISO 1328-1.

NaN, or an error that says so, where a standard does not hold for a family of gears. Tolerance classes of ISO 1328-1 are
told as tolerances, and as scatter, of the keys of a scene.
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot, inf, nan, prod
from typing import Any

from loaded_tca.errors import InputError, named
from loaded_tca.gears.involute import InvoluteMesh
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference import iso6336
from loaded_tca.reference.iso1328 import flank_tolerances
from loaded_tca.scene.section import Section, values_of

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


def contact_standard(mesh: InvoluteMesh, materials: tuple[Material, Material]) -> ContactStandard:
    """Values of the standard for a pair over its common face."""
    gear, alpha, beta = mesh.pinion, mesh.transverse_contact_ratio, mesh.overlap_ratio
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
            2.0 / diameter, diameter, mesh.common_face_width, mesh.wheel.teeth / gear.teeth, factors
        ),
        single_contact=single_contact,
        contact_ratio=by_ratio,
        helix_angle=by_helix,
        single_stiffness=single,
        mesh_stiffness=iso6336.mesh_stiffness(single, alpha) if single > 0.0 else nan,
        largest_transverse_load_factor=iso6336.largest_transverse_load_factor(alpha, beta),
    )


def _single_contact(mesh: InvoluteMesh, overlap_ratio: float) -> tuple[float, float]:
    """Z_B and Z_D, of the ends of the path of contact that is used."""
    path, gears = mesh.path_of_contact, (mesh.pinion, mesh.wheel)
    ends = path.E, abs(path.T2 - path.A)
    first, second = (hypot(end, gear.base_radius) / gear.base_radius for gear, end in zip(gears, ends, strict=True))
    return iso6336.single_contact_factors(
        (mesh.pinion.teeth, mesh.wheel.teeth),
        (first, second),
        mesh.working_pressure_angle,
        mesh.transverse_contact_ratio,
        overlap_ratio,
    )


def _single_stiffness(mesh: InvoluteMesh, materials: tuple[Material, Material]) -> float:
    """c' of both materials, a ring as a rack; NaN for profile shifts beyond those that the standard has fitted.

    The smaller gear is the pinion of the series, of equal ones that of the larger shift, whichever the scene calls so.
    """
    gear, shifts = mesh.pinion, (mesh.pinion.profile_shift, mesh.wheel.profile_shift)
    if not FITTED_SHIFTS[0] <= sum(shifts) <= FITTED_SHIFTS[1]:
        return nan
    virtual = [
        iso6336.virtual_teeth(one.teeth, one.helix_angle, one.pressure_angle) if one.teeth > 0 else inf
        for one in (mesh.pinion, mesh.wheel)
    ]
    (first, of_first), (second, of_second) = sorted(
        zip(virtual, shifts, strict=True), key=lambda gear: (gear[0], -gear[1])
    )
    racks = [iso6336.basic_rack_factor(one.dedendum_coefficient, one.pressure_angle) for one in (gear, mesh.wheel)]
    moduli = [material.youngs_modulus for material in materials]
    return iso6336.single_stiffness(
        iso6336.theoretical_single_stiffness((first, second), (of_first, of_second)),
        gear.helix_angle,
        basic_rack_factor=0.5 * sum(racks),
        youngs_modulus=2.0 * moduli[0] * moduli[1] / (moduli[0] + moduli[1]),
    )


DEVIATIONS_IN_A_TOLERANCE = 3.0
"""Standard deviations from the nominal slope to its tolerance: 99.7 % of the gears are of the class, as of a process
that is capable of it and no better."""
SLOPES = {"helix_slope_um": "helix_slope", "profile_slope_um": "profile_slope"}
"""Key of the modifications -> the tolerance that bounds its deviation, to either side."""


def slope_tolerances(mesh: InvoluteMesh, tolerance_class: int) -> dict[str, float]:
    """Tolerances f_HbetaT and f_HalphaT of both gears by the keys that they bound, as drawings have them [um].

    Raises
    ------
    InputError
        Outside the classes and ranges of ISO 1328-1, with the gear.
    """
    bounds: dict[str, float] = {}
    for name, gear in (("pinion", mesh.pinion), ("wheel", mesh.wheel)):
        with named(name):
            tolerances = flank_tolerances(
                abs(gear.teeth), gear.normal_module, gear.face_width, tolerance_class, gear.helix_angle
            )
        bounds |= {f"{name}.modifications.{key}": getattr(tolerances, bound) for key, bound in SLOPES.items()}
    return bounds


@dataclass(frozen=True, kw_only=True)
class WithStandards(Section, ABC):
    """What standards say of a scene, for the gears that they hold for: families that one holds for tell their own."""

    @property
    def tip_clearances(self) -> tuple[float, ...]:
        """Clearances c of both roots and the mating gear's tip [mm]; none of bevel gears, whose blanks have them."""
        return ()

    @property
    def pairs_in_contact(self) -> float:
        """Tooth pairs that are in contact on the mean, roughly."""
        return 3.0  # of face-milled teeth, whose contact ratio is not known before their contact

    @property
    def geometry_standard(self) -> str:
        """What the rows of the geometry follow, as titles have it."""
        return "ISO 21771" if self.path_points else "ISO 23509"

    @property
    def path_points(self) -> Mapping[str, float]:
        """Points A to E of the path of contact after ISO 21771, as roll lengths of the pinion; none of bevel gears."""
        return {}

    @property
    def mean_contact_length(self) -> float:
        """Mean length of all contact lines over a pitch [mm]; NaN for gears outside ISO 6336-1."""
        return nan

    @property
    def transverse_angles(self) -> tuple[float, float]:
        """Working transverse pressure angle, and base helix angle of the pinion [rad]; NaN for bevel gears."""
        return nan, nan

    @property
    def nominal_root_stress(self) -> tuple[float, float]:
        """Nominal root stress sigma_F0 of pinion and wheel after ISO 6336-3 per pinion torque [MPa/(N mm)].

        NaN for gears of which the standard does not speak.
        """
        return nan, nan

    @property
    def contact_standard(self) -> ContactStandard:
        """Contact factors and stiffnesses of ISO 6336; all NaN for gears outside the standard."""
        return ContactStandard()

    @property
    def root_factors(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Y_F, Y_S, Y_beta of pinion and wheel after ISO 6336-3; NaN for gears outside the standard."""
        unknown = nan, nan, nan
        return unknown, unknown

    @property
    def tooth_height_over_width(self) -> float:
        """Height of the teeth over the common face width, h/b of ISO 6336-1; NaN for gears outside the standard."""
        return nan

    def slope_tolerances(self, tolerance_class: int) -> Mapping[str, float]:
        """Return the tolerances of slopes of both gears of a class, by their keys [um].

        Raises
        ------
        InputError
            If there is no standard for gears of this kind, or it has no such class.
        """
        raise InputError(f"tolerance_class: {tolerance_class}; ISO 1328-1 holds for cylindrical gears alone")

    def scatter_of_class(self, tolerance_class: int, *, deviations: bool = False) -> Mapping[str, Any]:
        """Return how helix and profile slopes of both gears scatter that are of a tolerance class of ISO 1328-1:2013.

        Each slope is normal about its value in the scene, with three standard deviations to its tolerance f_HbetaT or
        f_HalphaT to either side, and independent of the others.

        Parameters
        ----------
        tolerance_class : int
            From 1 to 11.
        deviations : bool
            About zero instead, as the scatter of ``DesignModel`` counts it.

        Returns
        -------
        mapping of str to frozen distribution of ``scipy.stats``
            Key -> its distribution [um], as ``Study`` takes it.

        Raises
        ------
        InputError
            If the gears are not cylindrical, or outside the classes and ranges of the standard.

        Examples
        --------
        >>> from loaded_tca import read_scene
        >>> scatter = read_scene("examples/scenes/helical.toml").scatter_of_class(6)
        >>> round(float(scatter["wheel.modifications.helix_slope_um"].std()), 3)
        3.0
        """
        from scipy.stats import norm  # half a second, which scenes without scatter do not need

        nominal = {} if deviations else values_of(self)
        return {
            key: norm(nominal.get(key, 0.0), bound / DEVIATIONS_IN_A_TOLERANCE)
            for key, bound in self.slope_tolerances(tolerance_class).items()
        }

    def pitch_tolerances(self, gear: int, tolerance_class: int) -> tuple[float, float]:  # noqa: ARG002
        """Return the single and the cumulative pitch tolerance of a gear [um], along the transverse line of action.

        Parameters
        ----------
        gear : int
            0 the pinion, 1 the wheel.
        tolerance_class : int
            Of ISO 1328-1:2013.

        Raises
        ------
        InputError
            Where the standard has none, as for bevel gears.
        """
        raise InputError(
            f"tolerance_class: found {tolerance_class}; ISO 1328-1 has classes of cylindrical gears "
            "alone; give index_um"
        )
