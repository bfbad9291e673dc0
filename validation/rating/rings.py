"""Factors of rings and planets after ISO 6336 against the reports of KISSsoft on the NREL 5 MW gearbox, stages 1 and 2.

Reports of KISSsoft 03/2017A after ISO 6336:2006, method B, beside a public model of the drive train
(gfsReboucas/Drivetrain, @NREL_5MW/stage_01.rtf and stage_02.rtf): planets and rings of both stages, spur gears. From
teeth, diameters and centre distance of the scene: critical sections, Y_F, Y_S, nominal stresses, Z factors. The rings
are cut by pinion-type cutters of 36 and 30 teeth. Tolerances are half a last digit, a whole one of the lever h_Fe, two
of stresses: the report bends teeth with tips and a contact ratio in the middle of their tolerances, here they are
nominal.

``rating.stages`` has the safeties of the whole stages.
"""

import numpy as np

from loaded_tca.scene import InternalScene, parse_scene
from validation.table import Row

SOURCE = "KISSsoft 03/2017A"
SCENE = """
[pair]
type = "cylindrical"
normal_module_mm = {module}
centre_distance_mm = {distance}
[pinion]
teeth = {teeth[0]}
face_width_mm = {width}
profile_shift = {shifts[0]}
tip_diameter_mm = {tips[0]}
[wheel]
teeth = {teeth[1]}
face_width_mm = {width}
profile_shift = {shifts[1]}
tip_diameter_mm = {tips[1]}
root_diameter_mm = {root}
outer_diameter_mm = {outside}
[wheel.cutter]
teeth = {cutter}
tip_radius_coefficient = 0.3
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = {torque}
"""
STAGES = {
    "NREL 5 MW, stage 1": {
        "module": 45.0, "distance": 863.0, "teeth": (17, -56), "width": 491.0, "shifts": (0.8021, -0.5013),
        "tips": (905.470, 2475.118), "root": 2677.618, "outside": 2994.24, "cutter": 36,
        "torque": 779.454877 * 0.5 * 765.0,
    },
    "NREL 5 MW, stage 2": {
        "module": 21.0, "distance": 584.0, "teeth": (36, -93), "width": 550.0, "shifts": (0.5039, 0.1171),
        "tips": (815.663, 1906.081), "root": 2000.581, "outside": 2148.82, "cutter": 30,
        "torque": 285.900438 * 0.5 * 756.0,
    },
}  # fmt: skip
PRINTED = {
    "NREL 5 MW, stage 1": {
        "planet": (2.314, 1.101, 0.382, 29.87, 1.14, 2.38), "ring": (2.875, 1.742, 0.494, 19.59, 1.27, 2.13),
        "stresses": (588.62, 95.70, 95.32), "factors": (0.952, 1.00, 1.00), "stiffness": (13.289, 16.063),
    },
    "NREL 5 MW, stage 2": {
        "planet": (2.271, 0.880, 0.414, 22.21, 1.01, 2.48), "ring": (2.703, 1.444, 0.418, 18.63, 1.20, 2.34),
        "stresses": (312.44, 61.98, 69.12), "factors": (0.891, 1.00, 1.00), "stiffness": (14.053, 20.563),
    },
}  # fmt: skip
SECTION = "s_Fn/m_n", "h_Fe/m_n", "rho_F/m_n", "alpha_Fen [deg]", "Y_F", "Y_S"
DIGITS = 1e-3, 2e-3, 1e-3, 2e-2, 1e-2, 1e-2
GEAR_BODY = 0.862


def scene(stage: str) -> InternalScene:
    """Planet and ring of a stage under the nominal load of one planet."""
    pair = parse_scene(SCENE.format(**STAGES[stage]))
    assert isinstance(pair, InternalScene)
    return pair


def rows() -> list[Row]:
    """Compare every number."""
    return [row for stage in STAGES for row in _of_stage(stage)]


def _of_stage(stage: str) -> list[Row]:
    pair, printed = scene(stage), PRINTED[stage]
    compared = []
    for gear, section in zip(("planet", "ring"), pair.root_sections, strict=True):
        assert section is not None
        obtained = (
            section.thickness, section.lever, section.radius, float(np.degrees(section.load_angle)),
            section.form_factor, section.stress_correction_factor,
        )  # fmt: skip
        numbers = zip(SECTION, printed[gear], obtained, DIGITS, strict=True)
        compared += [_row(stage, f"{gear} at the ring: {name}", *values) for name, *values in numbers]
    standard, torque = pair.contact_standard, 1e3 * pair.load.pinion_torque_Nm
    roots = [torque * each for each in pair.nominal_root_stress]
    names = "sigma_H0 [MPa]", "planet at the ring: sigma_F0 [MPa]", "ring: sigma_F0 [MPa]"
    obtained = standard.stress_per_root_torque * torque**0.5, *roots
    compared += [
        _row(stage, name, expected, value, 4e-2)
        for name, expected, value in zip(names, printed["stresses"], obtained, strict=True)
    ]
    factors = standard.contact_ratio, *standard.single_contact
    for name, expected, value, digit in zip(
        ("Z_eps", "Z_B", "Z_D of the ring"), printed["factors"], factors, (1e-3, 1e-2, 1e-2), strict=True
    ):
        compared.append(_row(stage, f"planet and ring: {name}", expected, value, digit))
    stiffness = standard.single_stiffness, standard.mesh_stiffness
    for name, expected, value in zip(("c'", "c_gamma_alpha"), printed["stiffness"], stiffness, strict=True):
        digit = expected * 1e-3 / GEAR_BODY  # half a last digit of C_R, which is printed with three
        label = f"planet and ring: {name} [N/(mm um)]"
        compared.append(_row(stage, label, expected, GEAR_BODY * value, digit, "C_R 0.862"))
    return compared


def _row(stage: str, quantity: str, expected: float, obtained: float, digit: float, assumed: str = "") -> Row:
    return Row(stage, SOURCE, quantity, expected, obtained, 0.5001 * digit / abs(expected), assumed)
