"""FZG C14 spur gears, as published with GEARpie: nominal root stress of ISO 6336-3, method B.

Of the gears of ``fzg_c14_geometry``, T1 200 N m, fillets of 0.375 modules. GEARpie takes F_t on the operating pitch
circle, a 91.5 mm, and the contact ratio of the working angle that follows from the profile shifts.
"""

from loaded_tca.gears import CylindricalMesh
from loaded_tca.reference.iso6336_3 import nominal_root_stress, root_section
from validation.cylindrical.fzg_c14_geometry import SOURCE, TORQUE, pair
from validation.table import Row

CASE = "FZG C14"
FORM, CORRECTION, STRESS = (1.689, 1.583), (1.851, 1.917), (271.19, 263.17)


def rows() -> list[Row]:
    """Factors and stress of both gears; the tolerance is half a unit of the last digit."""
    mesh = pair()
    ratio = CylindricalMesh(mesh.pinion, mesh.wheel).transverse_contact_ratio
    force, found = TORQUE / mesh.pinion_working_radius, []
    for n, gear in enumerate((mesh.pinion, mesh.wheel)):
        module, width, tip = gear.normal_module, gear.face_width, 2.0 * gear.tip_radius / gear.normal_module
        section = root_section(gear.teeth, gear.profile_shift, tip, ratio, root_radius_coefficient=0.375)
        form, correction = section.form_factor, section.stress_correction_factor
        stress = nominal_root_stress(force, width, module, form * correction)
        found += [
            _row(f"{gear.name} form factor Y_F", FORM[n], form, 1e-3),
            _row(f"{gear.name} stress correction factor Y_S", CORRECTION[n], correction, 1e-3),
            _row(f"{gear.name} nominal root stress [MPa]", STRESS[n], stress, 0.01),
        ]
    return found


def _row(quantity: str, expected: float, obtained: float, digit: float) -> Row:
    return Row(CASE, SOURCE, quantity, expected, obtained, 0.5 * digit / expected)
