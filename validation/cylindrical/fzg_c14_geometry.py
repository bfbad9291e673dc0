"""FZG C14 spur gears, as published with GEARpie: geometry, normal force, Hertz pressure at the pitch point.

alpha 20 deg, m 4.5 mm, z 16/24, x 0.1817/0.1715, a 91.5 mm, b 14 mm, E 206 GPa, nu 0.3, T1 200 N m.

Two numbers carry fewer digits than they show. The working pressure angle 22.43934 deg follows neither from the
centre distance (22.43879) nor from the profile shifts (22.43891): compared to the digits that the two inputs share.
GEARpie evaluates its contact width at the point of its path nearest to C and prints half of the half width
of Johnson 1985: compared to what such a step of the path is worth.
"""

from math import degrees, sin

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference.hertz import LineContact, line_contact
from validation.table import Row

CASE = "FZG C14"
SOURCE = "GEARpie"
TORQUE = 200.0e3


def pair() -> CylindricalMesh:
    """Build the gears."""
    pinion = CylindricalGear(16, 4.5, 14.0, profile_shift=0.1817, name="pinion")
    wheel = CylindricalGear(24, 4.5, 14.0, profile_shift=0.1715, name="wheel")
    return CylindricalMesh(pinion, wheel, centre_distance=91.5)


def hertz_at_pitch_point(mesh: CylindricalMesh) -> LineContact:
    """Line contact at C, one tooth pair carrying the whole load over the whole face."""
    slope = sin(mesh.working_pressure_angle)
    curvature = 1.0 / (mesh.pinion_working_radius * slope) + 1.0 / (mesh.wheel_working_radius * slope)
    line_load = mesh.normal_force(TORQUE) / mesh.common_face_width
    return line_contact(line_load, curvature, contact_modulus(Material(), Material()))


def rows() -> list[Row]:
    """Compare every number; the tolerance is half a unit of its last digit unless said otherwise above."""
    mesh = pair()
    path, hertz = mesh.path_of_contact, hertz_at_pitch_point(mesh)
    return [
        _row("working pressure angle [deg]", 22.43934, degrees(mesh.working_pressure_angle), 2e-3),
        _row("T1T2 [mm]", 34.93, path.T1T2, 0.01),
        _row("AB [mm]", 6.14, path.AB, 0.01),
        _row("AC [mm]", 9.68, path.AC, 0.01),
        _row("AD [mm]", 13.28, path.AD, 0.01),
        _row("AE [mm]", 19.43, path.AE, 0.01),
        _row("pinion tip radius [mm]", 41.318, mesh.pinion.tip_radius, 1e-3),
        _row("wheel tip radius [mm]", 59.272, mesh.wheel.tip_radius, 1e-3),
        _row("transverse contact ratio", 1.46, mesh.transverse_contact_ratio, 0.01),
        _row("normal force F_bn [N]", 5912.1, mesh.normal_force(TORQUE), 0.1),
        _row("Hertz pressure at C [MPa]", 1347.3, hertz.max_pressure, 0.1),
        _row("Hertz half width at C [um]", 199.567, 1e3 * hertz.half_width, 0.1),
    ]


def _row(quantity: str, expected: float, obtained: float, digit: float) -> Row:
    return Row(CASE, SOURCE, quantity, expected, obtained, 0.5 * digit / expected)
