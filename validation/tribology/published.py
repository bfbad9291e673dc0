"""Tribology of published stages: closed forms against the numbers that two reports print.

NREL 5 MW, stage 3: report of KISSsoft 03/2017A (gfsReboucas/Drivetrain, NREL_5MW/stage_03.rtf). z 24/95, m_n 14 mm,
beta 10 deg, b 360 mm, a 861 mm, 5000 kW at 1165.9 1/min, K_A 1.25, K_V 1.092, K_Hbeta 1.15, K_Halpha 1.069,
K_Bgamma 1.274, Ra 0.6 um, mineral oil of 220 and 19 mm2/s at 80 C. Point A has the load sharing factor 0.889, so that
its dynamic pressure is taken as printed, 1014.701 MPa; B_M 13.780 N/(mm s^0.5 K).

FZG gears C14, C40, H501, H951 as GEARpie prints them: mean coefficient of friction after Schlenk, loss factor after
Ohlendorf. The roughness of C14 and C40 is 0.4 and 0.31 um, of the others 0.6 um; X_L 0.846 of its mineral oils, 0.65 of
its polyalphaolefin; the module of H951, printed 1.8, is 1.75 mm. Their paths of contact end at the
tip circles, whatever the fillets. Schlenk's formula takes the transverse radius at C and
the normal force over the least length of the contact lines.

Of the stage, the loss factor of the loaded contacts stands beside that of the standard: 15 % above it, as lines of an
overlap ratio of 1.42 lie over the whole path at once.
"""

import math
import warnings

from loaded_tca import analyse, parse_scene
from loaded_tca.errors import AccuracyWarning
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.reference import iso6336_20, iso6336_21, iso6336_22
from loaded_tca.reference.friction import schlenk
from loaded_tca.tribology import Lubricant
from validation.table import Row

STAGE, REPORT, FZG = "NREL 5 MW, stage 3", "KISSsoft 03/2017A", "GEARpie"
SPEED, POWER_kW, TORQUE = 1165.9, 5000.0, 40953.0e3
FACTORS, BEARING = 1.25 * 1.092 * 1.15 * 1.069, 1.274
ROUGHNESS, MODULUS, PRESSURE, COEFFICIENT = 0.6, 226374.0, 1014.701, 13780.0
SCENE = """
pair = {type = "cylindrical", normal_module_mm = 14.0, helix_angle_deg = 10.0, centre_distance_mm = 861.0}
pinion = {teeth = 24, face_width_mm = 360.0, profile_shift = 0.48, tip_diameter_mm = 380.747}
wheel = {teeth = 95, face_width_mm = 360.0, profile_shift = 0.6691, tip_diameter_mm = 1395.376}
material = {youngs_modulus_MPa = 206000.0, poisson_ratio = 0.3}
load = {pinion_torque_Nm = 40953.0}
analysis = {positions = 9, accuracy = 0.03}
"""
C14, H501, H951 = (
    ((16, 24), 4.5, 0.0, (0.1817, 0.1715), (41.318, 59.272)),
    ((20, 30), 3.5, 15.0, (0.1809, 0.0891), (40.336, 58.132)),
    ((38, 57), 1.75, 15.0, (1.6915, 2.0003), (38.115, 55.867)),
)
"""Teeth, module, helix angle [deg], profile shifts, tip radii; all at a centre distance of 91.5 mm."""
GEARS = {
    "C14": (C14, 14.0, 200.0, 1500.0, 13.28, 0.355, 0.846, 0.0449, 0.1986),
    "C40": (C14, 40.0, 215.5, 1800.0, 49.85, 0.355, 0.65, 0.0256, 0.1986),
    "H501": (H501, 23.0, 100.0, 1000.0, 32.67, 0.6, 0.846, 0.0420, 0.1639),
    "H951": (H951, 21.2418, 200.0, 1000.0, 32.67, 0.6, 0.846, 0.0458, 0.0739),
}
"""Gears, face width, torque [N m], speed [1/min], viscosity [mPa s], Ra [um], X_L, and the printed coefficient of
friction and loss factor."""


def oil() -> Lubricant:
    """Return the oil of the stage."""
    return Lubricant(viscosity_40=220.0, viscosity_100=19.0, density_15=890.0, oil_temperature=80.0)


def short_rows() -> list[Row]:
    """Compare the closed forms, to half a unit of the last printed digit."""
    return [*_stage(), *_scuffing(), *(row for name in GEARS for row in _gears(name))]


def rows() -> list[Row]:
    """Compare the closed forms, and the loss factor of the loaded contacts."""
    mesh = parse_scene(SCENE).mesh()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the unmodified lines end at edges, which are real heat
        result = analyse(parse_scene(SCENE))
    even = even_loss_factor(mesh)
    about = "exact loss of an even line load on the plane of action"
    return [
        *short_rows(),
        Row(STAGE, about, "loss factor of the loaded contacts", even, float(result.tribology().loss_factor[0]), 5e-3),
        Row(STAGE, about, "loss factor of the standard", even, _standard_loss(mesh), None, note="spur formula"),
    ]


def even_loss_factor(mesh: CylindricalMesh) -> float:
    """Loss factor of an even line load: the mean distance of the lines from C, over a pitch."""
    path, pitch, width = mesh.path_of_contact, mesh.pinion.base_pitch, mesh.common_face_width
    slope, steps = math.tan(abs(mesh.pinion.base_helix_angle)), 400
    total = 0.0
    for step in range(steps):
        distances = [
            abs(place - path.C)
            for k in range(-8, 9)
            for y in range(steps)
            if path.A
            <= (place := path.C + (k + (step + 0.5) / steps) * pitch + ((y + 0.5) / steps - 0.5) * width * slope)
            <= path.E
        ]
        total += sum(distances) / len(distances) / steps
    sliding = total * (1.0 + 1.0 / mesh.gear_ratio)
    return sliding / (mesh.pinion.base_radius * math.cos(mesh.pinion.base_helix_angle))


def _standard_loss(mesh: CylindricalMesh) -> float:
    path, pitch, helix = mesh.path_of_contact, mesh.pinion.base_pitch, mesh.pinion.base_helix_angle
    parts = (path.E - path.C) / pitch, (path.C - path.A) / pitch
    return iso6336_22.load_loss_factor(*parts, mesh.pinion.teeth, mesh.wheel.teeth, helix)


def _stage() -> list[Row]:
    """Film at point A of the stage, and what leads to it."""
    mesh, lubricant, omega = parse_scene(SCENE).mesh(), oil(), 2.0 * math.pi * SPEED / 60.0
    path, helix = mesh.path_of_contact, math.cos(mesh.pinion.base_helix_angle)
    at_c = path.C * (path.T2 - path.C) / path.T2 / helix
    at_a = path.A * (path.T2 - path.A) / path.T2 / helix
    load = FACTORS * TORQUE / (mesh.pinion.base_radius * mesh.common_face_width)
    oil_viscosity = float(lubricant.viscosity(80.0))
    friction = float(
        iso6336_22.mean_friction(load, 2e-3 * omega * path.C, at_c, oil_viscosity, ROUGHNESS, mesh.total_contact_ratio)
    )
    loss = _standard_loss(mesh)
    width, distance = mesh.common_face_width, mesh.working_centre_distance
    bulk = float(iso6336_22.bulk_temperature(80.0, POWER_kW, friction, loss, distance, width))
    first, second = 1e-3 * omega * path.A, 1e-3 * omega * (path.T2 - path.A) / mesh.gear_ratio
    velocities = first, second, abs(first - second)
    flash = iso6336_22.flash_temperature(friction, PRESSURE, at_a, MODULUS, *velocities, COEFFICIENT, COEFFICIENT)
    film = float(
        iso6336_22.film_thickness(at_a, MODULUS, PRESSURE, first + second, lubricant, bulk, bulk + float(flash))
    )
    return [
        _row("viscosity of the oil [mPa s]", 30.09, oil_viscosity, 0.01),
        _row(
            "pressure-viscosity coefficient at 38 C [mm2/N]", 0.02162, float(lubricant.pressure_viscosity(38.0)), 1e-5
        ),
        _row("radius of relative curvature at A [mm]", 37.122, at_a, 2e-3, "tip diameters with three digits"),
        _row("mean coefficient of friction", 0.0300, friction, 1e-4),
        _row("loss factor of the standard", 0.106, loss, 1e-3),
        _row("bulk temperature [C]", 85.0, bulk, 0.1),
        _row("viscosity at the bulk temperature [mPa s]", 25.2, float(lubricant.viscosity(bulk)), 0.1),
        _row("film thickness at A [um]", 0.632, film, 1e-3),
        _row("film ratio at A", 1.053, film / ROUGHNESS, 1e-3),
    ]


def _scuffing() -> list[Row]:
    """Scuffing of the stage by flash and integral temperature."""
    by_flash = iso6336_20.scuffing_temperature(14, 30.09)
    safety = float(iso6336_20.scuffing_safety(451.98, 80.0, 169.50))
    return [
        _row("scuffing temperature [C]", 451.98, by_flash, 0.01),
        _row("safety against scuffing, flash temperature", 4.156, safety, 1e-3),
        _row("contact ratio factor X_eps", 0.263, iso6336_21.contact_ratio_factor(0.852, 0.611), 1e-3),
        _row("integral temperature [C]", 115.75, iso6336_21.integral_temperature(80.0, 16.25), 0.02, "16.25 K printed"),
        _row("scuffing integral temperature [C]", 455.17, iso6336_21.scuffing_integral_temperature(14, 220.0), 0.01),
    ]


def _gears(name: str) -> list[Row]:
    """Friction after Schlenk and loss factor after Ohlendorf of a pair of gears."""
    (teeth, module, helix, shifts, tips), width, torque, speed, viscosity, rough, factor, friction, loss = GEARS[name]
    angles = math.radians(helix), -math.radians(helix)
    gears = [
        CylindricalGear(z, module, width, helix_angle=angle, profile_shift=x, tip_diameter=2.0 * tip)
        for z, x, tip, angle in zip(teeth, shifts, tips, angles, strict=True)
    ]
    mesh = CylindricalMesh(*gears, centre_distance=91.5)
    path = mesh.path_of_contact
    radius = path.C * (path.T2 - path.C) / path.T2
    line_load = 1e3 * torque / mesh.pinion.base_radius / math.cos(mesh.pinion.base_helix_angle) / width
    pitch, helix_at_base = mesh.pinion.base_pitch, mesh.pinion.base_helix_angle
    recess = (mesh.pinion.roll_length(tips[0]) - path.C) / pitch
    approach = (mesh.wheel.roll_length(tips[1]) - path.T2 + path.C) / pitch
    line_load /= _least_length(recess + approach, mesh.overlap_ratio, helix_at_base)
    standard = iso6336_22.load_loss_factor(recess, approach, *teeth, helix_at_base)
    velocity = 4e-3 * math.pi * speed / 60.0 * path.C
    found = float(schlenk(line_load, velocity, radius, viscosity, rough, factor))
    return [
        Row(name, FZG, "coefficient of friction after Schlenk", friction, found, 5e-5 / friction),
        Row(name, FZG, "loss factor after Ohlendorf", loss, standard, 1e-4 / loss),
    ]


def _least_length(alpha: float, beta: float, helix: float) -> float:
    """Least length of the contact lines over the face width, by the fractional parts of both contact ratios."""
    if beta == 0.0:
        return float(math.floor(alpha))
    parts = alpha % 1.0, beta % 1.0
    lacking = math.prod(parts) if sum(parts) <= 1.0 else math.prod(1.0 - part for part in parts)
    return (alpha - lacking / beta) / math.cos(helix)


def _row(quantity: str, expected: float, obtained: float, digit: float, note: str = "") -> Row:
    return Row(STAGE, REPORT, quantity, expected, obtained, 0.5 * digit / expected, note=note)
