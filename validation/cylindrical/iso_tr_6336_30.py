"""ISO/TR 6336-30:2017, example 1: geometry, contact stress factors and mesh stiffness of a helical pair.

m_n 8 mm, alpha_n 20 deg, z 17/103, beta 15.8 deg, b 100 mm, a_w 500 mm, x 0.145/0, d_a 159.66/872.35 mm,
T1 9000 N m, steel of 206 GPa and 0.3.

The angles and contact ratios are not printed there: they were computed independently from the inputs. The dedendum
1.4 m_n of ISO 53 profile D is inferred; with it all three stiffnesses agree with the print to the last digit.
"""

from math import degrees, radians

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference import iso6336
from validation.table import Row

CASE = "ISO/TR 6336-30 ex. 1"
PUBLISHED = "ISO/TR 6336-30:2017"
COMPUTED = "independent computation"
TORQUE = 9.0e6
DEDENDUM = 1.4
RACK = "h_fP = 1.4 m_n (ISO 53 profile D)"


def pair() -> CylindricalMesh:
    """Build the gears of the example."""
    helix = radians(15.8)
    pinion = CylindricalGear(
        17, 8.0, 100.0, helix_angle=helix, profile_shift=0.145, tip_diameter=159.66,
        dedendum_coefficient=DEDENDUM, root_radius_coefficient=0.39, name="pinion",
    )  # fmt: skip
    wheel = CylindricalGear(
        103, 8.0, 100.0, helix_angle=-helix, tip_diameter=872.35,
        dedendum_coefficient=DEDENDUM, root_radius_coefficient=0.39, name="wheel",
    )  # fmt: skip
    return CylindricalMesh(pinion, wheel, centre_distance=500.0)


def rows() -> list[Row]:
    """Compare every number; the tolerance is half a unit of its last digit."""
    mesh = pair()
    return [*_geometry(mesh), *_contact_stress(mesh), *_stiffness(mesh)]


def _row(quantity: str, expected: float, obtained: float, digit: float, source: str, assumed: str = "") -> Row:
    return Row(CASE, source, quantity, expected, obtained, 0.5 * digit / expected, assumed)


def _geometry(mesh: CylindricalMesh) -> list[Row]:
    angle = degrees(mesh.working_pressure_angle)
    return [
        _row("working pressure angle [deg]", 21.066100, angle, 1e-6, COMPUTED),
        _row("transverse contact ratio", 1.549090, mesh.transverse_contact_ratio, 1e-6, COMPUTED),
        _row("overlap ratio", 1.083369, mesh.overlap_ratio, 1e-6, COMPUTED),
    ]


def _contact_stress(mesh: CylindricalMesh) -> list[Row]:
    pinion = mesh.pinion
    force = TORQUE / pinion.reference_radius
    zone = iso6336.zone_factor(pinion.transverse_pressure_angle, mesh.working_pressure_angle, pinion.base_helix_angle)
    elasticity = iso6336.elasticity_factor(contact_modulus(Material(), Material()))
    ratio = iso6336.contact_ratio_factor(mesh.transverse_contact_ratio, mesh.overlap_ratio)
    helix = iso6336.helix_angle_factor(pinion.helix_angle)
    stress = iso6336.nominal_contact_stress(
        force, 2.0 * pinion.reference_radius, mesh.common_face_width, mesh.gear_ratio, zone * elasticity * ratio * helix
    )
    return [
        _row("tangential force F_t [N]", 127352.0, force, 1.0, PUBLISHED),
        _row("zone factor Z_H", 2.39533, zone, 1e-5, PUBLISHED),
        _row("elasticity factor Z_E [MPa^0.5]", 189.81170, elasticity, 1e-5, PUBLISHED),
        _row("contact ratio factor Z_eps", 0.803, ratio, 1e-3, PUBLISHED),
        _row("helix angle factor Z_beta", 1.01944, helix, 1e-5, PUBLISHED),
        _row("nominal contact stress sigma_H0 [MPa]", 1206.58207, stress, 1e-5, PUBLISHED),
    ]


def _stiffness(mesh: CylindricalMesh) -> list[Row]:
    pinion, wheel = mesh.pinion, mesh.wheel
    teeth = [iso6336.virtual_teeth(gear.teeth, gear.helix_angle, gear.pressure_angle) for gear in (pinion, wheel)]
    theoretical = iso6336.theoretical_single_stiffness(
        (teeth[0], teeth[1]), (pinion.profile_shift, wheel.profile_shift)
    )
    rack = iso6336.basic_rack_factor(DEDENDUM, pinion.pressure_angle)
    single = iso6336.single_stiffness(theoretical, pinion.helix_angle, basic_rack_factor=rack)
    mean = iso6336.mesh_stiffness(single, mesh.transverse_contact_ratio)
    return [
        _row("virtual teeth z_n1", 18.905, teeth[0], 1e-3, PUBLISHED),
        _row("virtual teeth z_n2", 114.543, teeth[1], 1e-3, PUBLISHED),
        _row("theoretical single stiffness c'_th [N/(mm um)]", 17.85584, theoretical, 1e-5, PUBLISHED),
        _row("single stiffness c' [N/(mm um)]", 12.37047, single, 1e-5, PUBLISHED, RACK),
        _row("mesh stiffness c_gamma_alpha [N/(mm um)]", 17.46485, mean, 1e-5, PUBLISHED, RACK),
    ]
