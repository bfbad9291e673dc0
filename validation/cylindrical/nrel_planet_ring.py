"""Planet and ring of the second stage of the NREL 5 MW reference gearbox, against the digits of a printed report.

The KISSsoft report stands beside a public model of the drive train (gfsReboucas/Drivetrain,
@NREL_5MW/stage_02.rtf); the stage is that of Nejad, Guo, Gao, Moan 2016, Wind Energy 19, table V. Tolerances are half a
unit of the last printed digit, or a whole one where the report cuts digits off.

The reports of this stage and of the first one print how their rings are measured, without allowance and at both ends of
the tolerance DIN 3967 cd25: spans between the flanks over k spaces, measures between two balls, generating profile
shifts, tip alterations, form circles that pinion-type cutters of 30 and 36 teeth leave, and roots as the basic rack
would. Profile shifts are printed with four digits, which leaves what follows from them uncertain by as much as half a
unit of the fourth moves it.
"""

from collections.abc import Iterator
from dataclasses import replace
from math import radians, sin, tan
from pathlib import Path
from typing import NamedTuple

from loaded_tca.gears import PinionCutter, RingGear
from loaded_tca.gears.tips import computed_tip_alteration
from loaded_tca.gears.tooth_measures import allowance_of_balls, allowance_of_span
from loaded_tca.scene import read_scene
from validation.table import Row

CASE, SOURCE = "planet and ring, NREL 5 MW, stage 2", "KISSsoft report of the stage"
SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "planet_ring.toml"
MEASURES, REPORTS = "rings, NREL 5 MW: measures", "KISSsoft reports of stages 1 and 2"
ANGLE = radians(20.0)


class _Printed(NamedTuple):
    """What a report has of a ring: without allowance, and at both ends of the tolerance."""

    ring: RingGear
    spaces: int
    ball: float
    allowances: tuple[float, float]
    spans: tuple[float, float, float]
    between_balls: tuple[float, float, float]
    shifts: tuple[float, float]
    roots: tuple[float, float]
    forms: tuple[float, float]


RINGS = {
    "stage 1": _Printed(
        RingGear(-56, 45.0, 491.0, profile_shift=-0.5013, tip_diameter=2475.118, cutter=PinionCutter(36)),
        8,
        80.0,
        (-0.430, -0.590),
        (1047.070, 1047.474, 1047.624),
        (2445.378, 2446.539, 2446.970),
        (-0.5144, -0.5193),
        (2678.799, 2679.239),
        (2663.653, 2664.013),
    ),
    "stage 2": _Printed(
        RingGear(-93, 21.0, 550.0, profile_shift=0.1171, tip_diameter=1906.081, cutter=PinionCutter(30)),
        11,
        35.0,
        (-0.320, -0.450),
        (676.615, 676.916, 677.038),
        (1900.511, 1901.454, 1901.836),
        (0.0962, 0.0877),
        (2001.460, 2001.818),
        (1988.923, 1989.345),
    ),
}


def _measures(stage: str, printed: _Printed) -> list[Row]:
    """Both measures of a ring and what follows from its allowances."""
    nominal, module, digit, shift = printed.ring, printed.ring.normal_module, 0.5001e-3, 0.5e-4
    ends = [replace(nominal, thickness_allowance=allowance) for allowance in (0.0, *printed.allowances)]
    slack = digit + 2.0 * module * sin(ANGLE) * shift  # of a span; balls, across both flanks, move by more
    measured = [ring.ball_measurement(printed.ball) for ring in ends]
    per_shift = (measured[1] - measured[2]) / (ends[1].generating_profile_shift - ends[2].generating_profile_shift)
    values = [("spaces k of the span", printed.spaces, nominal.span_teeth, digit)]
    for place, ring, span, balls, over in zip(
        ("without allowance", "upper", "lower"), ends, printed.spans, printed.between_balls, measured, strict=True
    ):
        values += [
            (f"{place}: span W_k [mm]", span, ring.span_measurement(printed.spaces), slack),
            (f"{place}: between balls M_dK [mm]", balls, over, digit + abs(per_shift) * shift),
        ]
    for n, place in enumerate(("upper", "lower")):
        thickness = 2.0 * module * tan(ANGLE) * shift
        ring, allowance = ends[n + 1], printed.allowances[n]
        by_span = allowance_of_span(nominal, printed.spans[n + 1], printed.spaces)
        by_balls = allowance_of_balls(nominal, printed.between_balls[n + 1], printed.ball)
        root = 2.0 * replace(ring, cutter=None).root_radius
        values += [
            (f"{place}: A_sn from the span [mm]", allowance, by_span, 3.0 * digit + thickness),
            (f"{place}: A_sn from the balls [mm]", allowance, by_balls, 3.0 * digit + thickness),
            (f"{place}: generating shift x_E", printed.shifts[n], ring.generating_profile_shift, 2.0 * shift),
            (f"{place}: root diameter [mm]", printed.roots[n], root, digit + 2.0 * module * shift),
            (f"{place}: form diameter [mm]", printed.forms[n], 2.0 * ring.form_radius, digit + 2.0 * module * shift),
        ]
    return [
        Row(MEASURES, REPORTS, f"{stage}, {name}", expected, obtained, allowed / abs(expected))
        for name, expected, obtained, allowed in values
    ]


TIPS = {
    "stage 1, sun and planet": ((19, 17), (0.6170, 0.8021), 45.0, 863.0, -10.861),
    "stage 1, planet and ring": ((17, -56), (0.8021, -0.5013), 45.0, 863.0, 0.0),
    "stage 2, sun and planet": ((18, 36), (0.3890, 0.5039), 21.0, 584.0, -1.750),
    "stage 2, planet and ring": ((36, -93), (0.5039, 0.1171), 21.0, 584.0, 0.0),
}
"""Teeth, profile shifts, module, centre distance, and the tip alteration that is printed [mm]; of rings none."""


def _tips() -> Iterator[Row]:
    """Computed tip alterations k m_n; the tolerance is half a digit and what both digits of the shifts leave."""
    for name, (teeth, shifts, module, distance, printed) in TIPS.items():
        obtained = module * computed_tip_alteration(
            teeth, shifts, module, pressure_angle=ANGLE, centre_distance=distance
        )
        allowed = 0.5001e-3 + module * 1e-4
        yield Row(
            MEASURES, REPORTS, f"{name}: tip alteration k m_n [mm]", printed, obtained, allowed / abs(printed or 1.0)
        )


def rows() -> list[Row]:
    """Diameters and contact ratio of the pair."""
    mesh = read_scene(SCENE).mesh()
    ring, planet = mesh.ring, mesh.pinion
    values = (
        ("root form diameter of the ring d_Ff [mm]", 1987.879, 2.0 * ring.form_radius, 1e-3),
        (
            "start of the active profile of the ring d_Nf [mm]",
            1969.750,
            2.0 * mesh.wheel_active_profile.start_radius,
            5e-4,
        ),
        (
            "start of the active profile of the planet [mm]",
            738.082,
            2.0 * mesh.pinion_active_profile.start_radius,
            5e-4,
        ),
        ("root diameter of the planet d_f [mm]", 724.663, 2.0 * planet.root_radius, 1e-3),
        ("transverse contact ratio eps_alpha", 1.618, mesh.transverse_contact_ratio, 5e-4),
        ("sum of profile shifts without backlash", 0.6210, mesh.profile_shift_sum_without_backlash, 5e-5),
    )
    of_pair = [
        Row(CASE, SOURCE, name, printed, obtained, digits / printed) for name, printed, obtained, digits in values
    ]
    return [*of_pair, *_tips(), *(row for stage, printed in RINGS.items() for row in _measures(stage, printed))]
