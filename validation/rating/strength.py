"""Factors, strengths and safeties after ISO 6336 against the numbers that three sources print.

NREL 5 MW, stage 3: report of KISSsoft 03/2017A after ISO 6336:2006, method B (gfsReboucas/Drivetrain,
NREL_5MW/stage_03.rtf); the whole way from the teeth of ``cylindrical.nrel_5mw_stage_3`` to the safeties of both gears.
18CrNiMo7-6 with 1500 and 430 MPa, R_z 4.8 and 20 um, ISO VG 220, 175200 h at 1165.9 1/min, K_A 1.25. Taken as printed:
K_Hbeta 1.150, the gear body C_R 0.898, the reduced mass 0.36503 kg/mm (diameters of its own), f_pb 15.9 and f_f_alpha
22 um. The report rates without the allowances of the tooth thickness, but bends its teeth with tips and a contact ratio
in the middle of their tolerances: 0.05 mm less, and 1.460 (inferred). Half a last digit of 1.460 moves sigma_F0 by 0.05
MPa, twice that is allowed.

The same report's stage 2: planet (36 teeth) and ring (93 teeth of 34CrNiMo6, 240 HBW, 700 and 290 MPa), whose strengths
follow from printed speeds, roughness and notches; Z_W of the ring, Y_M 0.7 of the planet.

ISO/TR 6336-30, example 1: Z_L, Z_v, Z_R, Z_NT, Z_B, Z_D, K_Fbeta, strengths and pitting safeties, as the program
Drivetrain prints them (MATISO_6336.m); it prints no root stress, and none of the other seven examples.

ISO 6336-6:2019, annex C: bins 3 to 44 of its spectrum, S_H = 1.374 where the life is used up (as the program Drivetrain
prints table C.2). Its S-N curve goes on above the static strength, by 1 % of stress. Where teeth break there, as
elsewhere in this package, the safety is that of the static strength.
"""

from math import radians

import numpy as np

from loaded_tca.gears import CylindricalMesh
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference import iso6336, iso6336_1, iso6336_2, iso6336_3, iso6336_6
from validation.cylindrical.iso_tr_6336_30 import PUBLISHED as TR
from validation.cylindrical.iso_tr_6336_30 import pair as example_1
from validation.cylindrical.nrel_5mw_stage_3 import CENTRE_DISTANCE, pair
from validation.table import Row

KISSSOFT, STAGE, SECOND = "KISSsoft 03/2017A", "NREL 5 MW, stage 3", "NREL 5 MW, stage 2"
SPECTRUM_SOURCE, ANNEX_C = "ISO 6336-6:2019, table C.2", "ISO 6336-6 annex C"
TORQUE, SPEED, HOURS, APPLICATION, FACE_LOAD = 40953.0e3, 1165.9, 175200.0, 1.25, 1.150
MEAN_CONTACT_RATIO = 1.460
ASSUMED = "K_Hbeta, C_R, m_red, deviations"
SPECTRUM = (
    (2203, 2349), (1285, 2344), (825.9, 2344), (1285, 2340), (2570, 2335), (1285, 2330), (825.9, 2326), (1744, 2321),
    (2570, 2316), (3028, 2312), (2203, 2307), (2203, 2297), (1744, 2293), (2386, 2283), (4772, 2274), (4313, 2264),
    (5690, 2250), (8076, 2240), (6057, 2225), (14960, 2211), (16520, 2191), (7617, 2176), (18350, 2156),
    (19460, 2131), (9544, 2110), (21840, 2084), (23220, 2053), (18350, 2021), (18900, 1988), (27260, 1955),
    (29000, 1916), (30650, 1870), (32300, 1823), (25150, 1785), (26250, 1742), (37080, 1693), (39370, 1643),
    (41210, 1593), (42950, 1534), (27810, 1467), (16150, 1398), (1101, 1318),
)  # fmt: skip
"""Load cycles in 30 years and sigma_H times S_H [MPa] of bins 3 to 44."""


def rows() -> list[Row]:
    """Compare every number: to half a last digit, or one where inputs are printed with four or five digits."""
    return [*_stage_3(), *_stage_2(), *_example_1(), *_spectrum()]


def _loads(mesh: CylindricalMesh, ratio: float) -> tuple[list[Row], float, tuple[float, float]]:
    """K factors of stage 3: rows, K_v, and (K_Halpha, K_Falpha)."""
    pinion, wheel = mesh.pinion, mesh.wheel
    teeth = [iso6336.virtual_teeth(gear.teeth, gear.helix_angle, radians(20.0)) for gear in (pinion, wheel)]
    theoretical = iso6336.theoretical_single_stiffness(
        (teeth[0], teeth[1]), (pinion.profile_shift, wheel.profile_shift)
    )
    stiffness = iso6336.single_stiffness(
        theoretical, pinion.helix_angle, basic_rack_factor=iso6336.basic_rack_factor(1.25), gear_blank_factor=0.898
    )
    whole = iso6336.mesh_stiffness(stiffness, mesh.transverse_contact_ratio)
    speed = iso6336_1.resonance_speed(24, whole, 0.36503)
    load = APPLICATION * TORQUE / pinion.reference_radius / 360.0
    velocity = 2.0e-3 * np.pi * pinion.reference_radius * SPEED / 60.0
    pitch, profile = (float(iso6336_1.running_in_allowance("Eh", each, 1500.0, velocity)) for each in (15.9, 22.0))
    dynamic = iso6336_1.dynamic_factor(
        SPEED / speed, load, single_stiffness=stiffness, total_contact_ratio=mesh.transverse_contact_ratio + ratio,
        pitch_deviation=15.9 - pitch, profile_deviation=22.0 - profile, tip_relief=iso6336_1.running_in_relief(1500.0),
    )  # fmt: skip
    factor = float(dynamic.K_v)
    base = np.cos(np.arcsin(np.sin(pinion.helix_angle) * np.cos(radians(20.0))))
    flank, root = iso6336_1.transverse_load_factors(
        load * factor * FACE_LOAD, mesh_stiffness=whole, deviation=22.0 - pitch,
        transverse_contact_ratio=mesh.transverse_contact_ratio, overlap_ratio=ratio,
        virtual_contact_ratio=mesh.transverse_contact_ratio / base**2,
    )  # fmt: skip
    compared = [
        _row(STAGE, "single stiffness c' [N/(mm um)]", 13.832, stiffness, 1e-3, ASSUMED),
        _row(STAGE, "resonance ratio N", 0.410, SPEED / speed, 1e-3, ASSUMED),
        _row(STAGE, "dynamic factor K_v", 1.092, factor, 2e-3, ASSUMED),
        _row(STAGE, "transverse load factor K_Halpha", 1.069, float(flank), 2e-3, ASSUMED),
    ]
    return compared, factor, (float(flank), float(root))


def _stage_3() -> list[Row]:
    gears = pair()
    mesh, ratio = (
        CylindricalMesh(*gears, centre_distance=CENTRE_DISTANCE),
        360.0 * np.sin(radians(10.0)) / (14.0 * np.pi),
    )
    compared, dynamic, transverse = _loads(mesh, ratio)
    alpha, cycles = mesh.transverse_contact_ratio, SPEED * 60.0 * HOURS * np.array([1.0, 24 / 95])
    steel = Material()
    factors = iso6336.zone_factor(
        gears[0].transverse_pressure_angle, mesh.working_pressure_angle, gears[0].base_helix_angle
    )
    factors *= iso6336.elasticity_factor(contact_modulus(steel, steel)) * iso6336.contact_ratio_factor(alpha, ratio)
    factors *= iso6336.helix_angle_factor(radians(10.0))
    force = TORQUE / gears[0].reference_radius
    nominal = iso6336.nominal_contact_stress(force, 2.0 * gears[0].reference_radius, 360.0, 95 / 24, factors)
    load = APPLICATION * dynamic * FACE_LOAD * transverse[0]
    gear = iso6336_2.FlankStrength(1500.0, "Eh", 4.8)
    bases = tuple(2.0 * each.base_radius for each in gears)
    strength = iso6336_2.flank_factors(
        gear, gear, relative_radius=iso6336_2.relative_radius((bases[0], bases[1]), mesh.working_pressure_angle),
        velocity=2e-3 * np.pi * gears[0].reference_radius * SPEED / 60.0, viscosity_40=220.0, cycles=cycles,
        gear_ratio=95 / 24,
    )  # fmt: skip
    safeties = strength.safety(iso6336_2.contact_stress(nominal, 1.0, load))
    compared.append(_row(STAGE, "nominal contact stress sigma_H0 [MPa]", 570.79, nominal, 1e-2))
    for place, (printed, safety) in enumerate(((1338.30, 1.81), (1387.31, 1.88))):
        name = ("pinion", "wheel")[place]
        compared.append(_row(STAGE, f"{name}: sigma_HG [MPa]", printed, float(strength.strength[place]), 2e-2))
        compared.append(_row(STAGE, f"{name}: pitting safety S_H", safety, float(safeties[place]), 1e-2, ASSUMED))
    return [*compared, *_roots(mesh, ratio, dynamic, transverse[1], cycles)]


def _roots(mesh: CylindricalMesh, ratio: float, dynamic: float, transverse: float, cycles: np.ndarray) -> list[Row]:
    """Root strengths and safeties of stage 3."""
    compared, printed = [], ((117.92, 637.15, 3.26), (127.69, 654.72, 3.09))
    for place, gear in enumerate((mesh.pinion, mesh.wheel)):
        section = iso6336_3.root_section(
            gear.teeth, gear.profile_shift, (2.0 * gear.tip_radius - 0.05) / 14.0, MEAN_CONTACT_RATIO,
            helix_angle=gear.helix_angle,
        )  # fmt: skip
        factors = section.form_factor * section.stress_correction_factor
        factors *= iso6336_3.helix_angle_factor(gear.helix_angle, ratio)
        nominal = iso6336_3.nominal_root_stress(TORQUE / mesh.pinion.reference_radius, 360.0, 14.0, factors)
        strength = iso6336_3.root_factors(
            iso6336_3.RootStrength(430.0, "Eh", 20.0), notch_parameter=section.notch_parameter,
            stress_correction_factor=section.stress_correction_factor, normal_module=14.0, cycles=cycles[place],
        )  # fmt: skip
        face = float(iso6336_3.face_load_factor(FACE_LOAD, 30.562 / 360.0))
        safety = strength.safety(nominal * APPLICATION * dynamic * face * transverse)
        name, (stress, limit, safe) = ("pinion", "wheel")[place], printed[place]
        compared += [
            _row(STAGE, f"{name}: nominal root stress sigma_F0 [MPa]", stress, nominal, 0.2, "tips and contact ratio"),
            _row(STAGE, f"{name}: sigma_FG [MPa]", limit, float(strength.strength), 1e-2),
            _row(STAGE, f"{name}: root safety S_F", safe, float(safety), 1e-2, ASSUMED),
        ]
    return compared


def _stage_2() -> list[Row]:
    planet = iso6336_2.FlankStrength(1500.0, "Eh", 4.8)
    ring = iso6336_2.FlankStrength(700.0, "V alloy", 8.0, 240.0)
    cycles = np.array([1.2971e9, 1.5063e9])
    flanks = iso6336_2.flank_factors(
        planet, ring, relative_radius=iso6336_2.relative_radius((710.408, -1835.220), radians(15.630)), velocity=4.88,
        viscosity_40=220.0, cycles=cycles, gear_ratio=93 / 36,
    )  # fmt: skip
    compared = [
        *_stage_2_stiffness(),
        _row(SECOND, "ring: work hardening factor Z_W", 1.135, float(flanks.Z_W[1]), 1e-3),
        _row(SECOND, "planet: sigma_HG [MPa]", 1388.39, float(flanks.strength[0]), 0.5),
        _row(SECOND, "ring: sigma_HG [MPa]", 732.21, float(flanks.strength[1]), 0.3),
    ]
    for name, kind, limit, notch, correction, mean, printed, place in (
        ("planet", "Eh", 430.0, 2.271 / 0.828, 2.18, 0.7, 429.38, 0),
        ("ring", "V alloy", 290.0, 2.703 / 0.836, 2.34, 1.0, 444.89, 1),
    ):
        root = iso6336_3.root_factors(
            iso6336_3.RootStrength(limit, kind, 20.0, 1000.0), notch_parameter=notch, cycles=cycles[place],
            stress_correction_factor=correction, normal_module=21.0, mean_stress_factor=mean,
        )  # fmt: skip
        compared.append(_row(SECOND, f"{name}: sigma_FG [MPa]", printed, float(root.strength), 0.2))
    return compared


def _stage_2_stiffness() -> list[Row]:
    """Stiffness and reduced masses of sun (18 teeth), planet and ring, as discs of tips, roots and bores."""
    sun, planet = (iso6336_1.disc_inertia(*each, 7830.0) for each in ((387.338, 194.32), (770.163, 576.96)))
    radii = 177.602, 355.204
    compared = [
        _row(
            SECOND,
            "sun and planet: m_red [kg/mm]",
            0.1534,
            iso6336_1.reduced_mass((sun, planet), radii, meshes=(3, 1)),
            1e-4,
        ),
        _row(SECOND, "planet and ring: m_red [kg/mm]", 1.4684, planet / radii[1] ** 2, 1e-4),
    ]
    for name, teeth, shifts, printed in (
        ("sun and planet", (18.0, 36.0), (0.3890, 0.5039), 12.240),
        ("planet and ring", (36.0, np.inf), (0.5039, 0.1171), 14.053),
    ):
        theoretical = iso6336.theoretical_single_stiffness(teeth, shifts)
        stiffness = iso6336.single_stiffness(theoretical, 0.0, basic_rack_factor=0.975, gear_blank_factor=0.862)
        compared.append(
            _row(SECOND, f"{name}: c' [N/(mm um)]", printed, stiffness, 0.015, "C_R, printed with three digits")
        )
    return [*compared, *_stage_2_dynamics()]


def _stage_2_dynamics() -> list[Row]:
    """K_v of both meshes by method B, of printed stiffnesses, reduced masses, deviations and running in."""
    rows, load, relief = [], 519.82 * APPLICATION * 1.10, {"Eh": 1500.0, "V alloy": 700.0}
    for name, teeth, speed, stiffness, mass, ratio, deviations, kinds, printed in (
        ("sun and planet", 18, 246.7, (12.240, 15.640), 0.1534, 1.370, (17.9, 23.0), ("Eh", "Eh"), (0.046, 1.02)),
        ("planet and ring", 36, 123.4, (14.053, 20.563), 1.4684, 1.618, (20.7, 27.0), ("Eh", "V alloy"), (0.124, 1.06)),
    ):
        run_in = [
            0.5 * sum(float(iso6336_1.running_in_allowance(kind, each, relief[kind], 4.88)) for kind in kinds)
            for each in deviations
        ]
        resonance = speed / iso6336_1.resonance_speed(teeth, stiffness[1], mass)
        factor = iso6336_1.dynamic_factor(
            resonance, load, single_stiffness=stiffness[0], total_contact_ratio=ratio,
            pitch_deviation=deviations[0] - run_in[0], profile_deviation=deviations[1] - run_in[1],
            tip_relief=0.5 * sum(iso6336_1.running_in_relief(relief[kind]) for kind in kinds),
        )  # fmt: skip
        rows += [
            _row(SECOND, f"{name}: resonance ratio N", printed[0], resonance, 1e-3),
            _row(SECOND, f"{name}: dynamic factor K_v", printed[1], float(factor.K_v), 1e-2),
        ]
    return rows


def _example_1() -> list[Row]:
    gear = iso6336_2.FlankStrength(1500.0, "Eh", 6.0)
    factors = iso6336_2.flank_factors(
        gear, gear, relative_radius=21.857, velocity=2.664, viscosity_40=320.0, cycles=[1.08e9, 1.08e9 * 17 / 103],
        gear_ratio=103 / 17,
    )  # fmt: skip
    case, safeties = "ISO/TR 6336-30 ex. 1", factors.safety(1301.35343)
    mesh = example_1()
    height = (mesh.pinion.tip_radius - mesh.pinion.root_radius) / mesh.common_face_width
    root = iso6336_3.face_load_factor(1.16, height)
    single = iso6336.single_contact_factors(
        (17, 103), tuple(gear.tip_radius / gear.base_radius for gear in (mesh.pinion, mesh.wheel)),
        mesh.working_pressure_angle, mesh.transverse_contact_ratio, mesh.overlap_ratio,
    )  # fmt: skip
    return [
        Row(case, TR, "pinion: life factor Z_NT", 0.910, float(factors.Z_NT[0]), 6e-4),
        Row(case, TR, "wheel: life factor Z_NT", 0.962, float(factors.Z_NT[1]), 6e-4),
        Row(case, TR, "single contact factor Z_B", 1.0, single[0], 1e-9),
        Row(case, TR, "single contact factor Z_D", 1.0, single[1], 1e-9),
        Row(case, TR, "face load factor K_Fbeta", 1.12803, root, 4e-4, "K_Hbeta 1.160, printed as 1.16"),
        Row(case, TR, "lubricant factor Z_L", 1.04739, factors.Z_L, 5e-6),
        Row(case, TR, "velocity factor Z_v", 0.96911, float(factors.Z_v), 5e-6),
        Row(case, TR, "roughness factor Z_R", 0.96599, factors.Z_R, 5e-6),
        Row(case, TR, "pinion: sigma_HP [MPa]", 1338.48050, float(factors.strength[0]), 1e-5),
        Row(case, TR, "wheel: sigma_HP [MPa]", 1414.52551, float(factors.strength[1]), 1e-5),
        Row(case, TR, "pinion: pitting safety S_H", 1.02853, float(safeties[0]), 1e-5),
        Row(case, TR, "wheel: pitting safety S_H", 1.08696, float(safeties[1]), 1e-5),
    ]


def _spectrum() -> list[Row]:
    cycles, stresses = np.array(SPECTRUM).T
    reference = 1500.0 * 1.02 * 0.943 * 1.01
    on, broken = (iso6336_6.flank_curve("Eh", static_limit=limit).scaled(reference) for limit in (False, True))
    applied = stresses / 1.374
    safety = iso6336_6.spectrum_safety(on, applied, cycles)
    static = iso6336_6.spectrum_safety(broken, applied, cycles)
    stricter = "teeth break above the static strength"
    return [
        Row(
            ANNEX_C,
            SPECTRUM_SOURCE,
            "damage at sigma_H S_H",
            1.0,
            float(iso6336_6.miner_sum(on, stresses, cycles)),
            5e-3,
        ),
        Row(ANNEX_C, SPECTRUM_SOURCE, "safety S_H of the spectrum", 1.374, safety, 5e-4),
        Row(ANNEX_C, SPECTRUM_SOURCE, "safety S_H, static strength counts", 1.374, static, None, note=stricter),
    ]


def _row(case: str, quantity: str, expected: float, obtained: float, digit: float, assumed: str = "") -> Row:
    return Row(case, KISSSOFT, quantity, expected, obtained, 0.5001 * digit / abs(expected), assumed)
