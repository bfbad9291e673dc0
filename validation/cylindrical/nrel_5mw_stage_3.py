"""Tooth thickness of the high-speed stage of NREL's 5 MW reference gearbox, as a report of KISSsoft prints it.

m_n 14 mm, alpha_n 20 deg, z 24/95, beta 10 deg, b 360 mm, a_w 861 mm, x1 0.4800, tips shortened by 0.938 mm; tooth
thickness DIN 3967 cd25, upper and lower allowance of each gear. x2, printed as 0.6691, is what leaves no backlash.

The allowances, once as they are printed, once from the printed span, once from the printed measure over balls, agree to
the printed digits; so do the generating profile shifts, the roots and form circles that follow, and the backlash of
both ends of the tolerances. The printed normal backlash is j_wt cos(alpha_n) cos(beta) there and no row here.
"""

from dataclasses import replace
from math import radians

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.gears.involute import profile_shift_sum
from loaded_tca.gears.tooth_measures import allowance_of_balls, allowance_of_span
from validation.table import Row

CASE = "NREL 5 MW, stage 3"
PUBLISHED = "KISSsoft 03/2017 report"
CENTRE_DISTANCE = 861.0
SHIFT = 0.48
ALLOWANCES = (-0.130, -0.190), (-0.240, -0.340)
BALLS = 28.0, 25.0
TEETH = 4, 13
SPANS = (154.167, 154.045, 153.989), (542.490, 542.264, 542.171)
OVER_BALLS = (397.284, 397.035, 396.921), (1404.574, 1403.997, 1403.756)
SHIFTS = (0.4672, 0.4614), (0.6455, 0.6357)
ROOTS = (319.266, 319.101), (1333.592, 1333.318)
FORMS = (328.754, 328.645), (1340.862, 1340.603)
LIMITS = "upper", "lower"
NOTE = "x2 from the centre distance: printed with four digits"


def pair() -> tuple[CylindricalGear, CylindricalGear]:
    """Build the nominal gears, without allowances."""
    tips, bores = (380.747, 1395.376), (179.1, 1193.32)
    gears = [
        CylindricalGear(
            z, 14.0, 360.0, helix_angle=sign * radians(10.0), profile_shift=SHIFT, tip_diameter=tip, bore_diameter=bore
        )
        for z, sign, tip, bore in zip((24, 95), (1.0, -1.0), tips, bores, strict=True)
    ]
    angles = {"pressure_angle": radians(20.0), "helix_angle": radians(10.0)}
    rest = profile_shift_sum((24, 95), 14.0, **angles, centre_distance=CENTRE_DISTANCE) - SHIFT
    return gears[0], replace(gears[1], profile_shift=rest)


def rows() -> list[Row]:
    """Compare every number; tolerances are half a last digit, of allowances that of what they come from."""
    found = []
    for index, (name, nominal) in enumerate(zip(("pinion", "wheel"), pair(), strict=True)):
        found += _nominal(name, nominal, index)
        for limit, end in enumerate(LIMITS):
            found += _thinned(f"{name}, {end} allowance: ", nominal, index, limit)
    return [*found, *_backlash()]


def _row(quantity: str, expected: float, obtained: float, digit: float) -> Row:
    return Row(CASE, PUBLISHED, quantity, expected, obtained, 0.5001 * digit / abs(expected), note=NOTE)


def _nominal(name: str, gear: CylindricalGear, index: int) -> list[Row]:
    return [
        _row(f"{name}: teeth k of the span", TEETH[index], gear.span_teeth, 1.0),
        _row(f"{name}: span W_k [mm]", SPANS[index][0], gear.span_measurement(), 1e-3),
        _row(f"{name}: over balls M_dK [mm]", OVER_BALLS[index][0], gear.ball_measurement(BALLS[index]), 1e-3),
    ]


def _thinned(place: str, nominal: CylindricalGear, index: int, limit: int) -> list[Row]:
    allowance, span, balls = ALLOWANCES[index][limit], SPANS[index][limit + 1], OVER_BALLS[index][limit + 1]
    gear = replace(nominal, thickness_allowance=allowance)
    by_span = allowance_of_span(nominal, span, TEETH[index])
    by_balls = allowance_of_balls(nominal, balls, BALLS[index])
    return [
        _row(f"{place}span W_k [mm]", span, gear.span_measurement(), 1e-3),
        _row(f"{place}over balls M_dK [mm]", balls, gear.ball_measurement(BALLS[index]), 1e-3),
        _row(f"{place}A_sn from the span [mm]", allowance, by_span, 1.1e-3),
        _row(f"{place}A_sn from the balls [mm]", allowance, by_balls, 1e-3),
        _row(f"{place}generating profile shift x_E", SHIFTS[index][limit], gear.generating_profile_shift, 1e-4),
        _row(f"{place}root diameter [mm]", ROOTS[index][limit], 2.0 * gear.root_radius, 1e-3),
        _row(f"{place}root form diameter [mm]", FORMS[index][limit], 2.0 * gear.form_radius, 1e-3),
    ]


def _backlash() -> list[Row]:
    """Both ends of the tolerances: thickest teeth at the smallest centre distance, and the other way round."""
    ends = ((0, -0.028, 0.359, "least"), (1, 0.028, 0.571, "largest"))
    found = []
    for limit, error, expected, which in ends:
        gears = (replace(gear, thickness_allowance=both[limit]) for gear, both in zip(pair(), ALLOWANCES, strict=True))
        mesh = CylindricalMesh(*gears, centre_distance=CENTRE_DISTANCE + error)
        found.append(_row(f"{which} backlash j_wt [mm]", expected, mesh.backlash, 1e-3))
    return found
