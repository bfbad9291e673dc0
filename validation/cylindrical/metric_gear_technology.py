"""Examples of a textbook on metric gears: tooth thickness and span of spur and helical gears with profile shift.

All have a normal pressure angle of 20 deg; only the numbers printed with the examples are compared.
"""

from math import radians

from loaded_tca.gears import CylindricalGear
from validation.table import Row

CASE = "metric gear technology"
PUBLISHED = "SDP/SI, Elements of Metric Gear Technology, section 10"
HELIX = radians(25.0)


def rows() -> list[Row]:
    """Compare thicknesses and spans; the tolerance is half a unit of the last digit."""
    spur, helical = CylindricalGear(12, 10.0, 50.0, profile_shift=0.3), _helical(16, 5.0, 0.2)
    measured = CylindricalGear(24, 3.0, 50.0, profile_shift=0.4), _helical(24, 3.0, 0.4)
    thicknesses = [
        _row("spur, z 12: tooth thickness s [mm]", 17.8918, spur.tooth_thickness),
        _row("helical, z 16: normal tooth thickness s_n [mm]", 8.5819, helical.normal_tooth_thickness),
    ]
    spans = [
        _row("spur, z 24: span over 4 teeth [mm]", 32.8266, measured[0].span_measurement()),
        _row("helical, z 24: span over 5 teeth [mm]", 42.0085, measured[1].span_measurement()),
    ]
    return [*thicknesses, *spans]


def _helical(teeth: int, module: float, shift: float) -> CylindricalGear:
    return CylindricalGear(teeth, module, 50.0, helix_angle=HELIX, profile_shift=shift)


def _row(quantity: str, expected: float, obtained: float) -> Row:
    return Row(CASE, PUBLISHED, quantity, expected, obtained, 0.5001e-4 / expected)
