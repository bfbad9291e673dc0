"""Gears whose sources are in inches, with normal and transverse diametral pitches: as scenes in these units.

The numbers printed with an example of a textbook, and a measure over pins by a calculator for gears, which a public
repository compares its own formulas with.
"""

from math import cos, degrees, pi, tan

from loaded_tca import parse_scene
from validation.table import Row

CASE = "drawings in inches"
TEXTBOOK = "Shigley's Mechanical Engineering Design, example 13-2"
CALCULATOR = "reference calculator, as github.com/bfoster59/MOP prints it"
ASSUMED = "face width, mating gear, material, load"
INCH = 25.4
"""mm."""
SCENE = """
[pair]
type = "cylindrical"
{pair}
[pinion]
teeth = {teeth}
face_width_in = 1
[wheel]
teeth = {mating}
face_width_in = 1
[material]
youngs_modulus_psi = 30e6
poisson_ratio = 0.3
[load]
pinion_torque_lbf_in = 500
"""


def rows() -> list[Row]:
    """Compare pitches and a measure over pins."""
    return [*_textbook(), *_measure()]


def _textbook() -> list[Row]:
    """A helical gear of 18 teeth by its transverse pitch; the tolerance is half a unit of the last digit."""
    pair = "transverse_diametral_pitch_per_inch = 6\nhelix_angle_deg = 25\npressure_angle_deg = 20"
    scene = parse_scene(SCENE.format(pair=pair, teeth=18, mating=36))
    gear, module = scene.mesh().pinion, scene.geometry.normal_module_mm
    normal = pi * module / INCH
    axial = 2.0 * pi * gear.reference_radius / INCH / gear.teeth / tan(abs(gear.helix_angle))
    return [
        Row(CASE, TEXTBOOK, quantity, expected, obtained, half / expected, ASSUMED)
        for quantity, expected, obtained, half in (
            ("pitch diameter [in]", 3.0, 2.0 * gear.reference_radius / INCH, 1e-12),
            ("normal circular pitch [in]", 0.4745, normal, 0.5001e-4),
            ("axial pitch [in]", 1.123, axial, 0.5001e-3),
            ("normal diametral pitch [1/in]", 6.620, INCH / module, 0.5001e-3),
            ("transverse pressure angle [deg]", 21.88, degrees(gear.transverse_pressure_angle), 0.5001e-2),
        )
    ]


def _measure() -> list[Row]:
    """A helical gear of 127 teeth over pins, which an odd number of teeth holds opposite each other, at another height.

    So they measure d_c + D_M, where balls in one plane measure d_c cos(pi/(2 z)) + D_M. The source prints six decimals,
    and the tooth thickness pi/24 as 0.130900, 3.1e-7 more: they move the measure by 8e-7 in.
    """
    pair = "normal_diametral_pitch_per_inch = 12\nhelix_angle_deg = 10.5"
    scene = parse_scene(SCENE.format(pair=pair, teeth=127, mating=130))
    pins = 0.144 * INCH
    centres = (scene.mesh().pinion.ball_measurement(pins) - pins) / cos(pi / 254.0)
    quantity = "measure over pins of 0.144 in, z 127, P_n 12 [in]"
    return [Row(CASE, CALCULATOR, quantity, 10.967749, (centres + pins) / INCH, 1.3e-6 / 10.967749, ASSUMED)]
