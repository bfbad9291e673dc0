"""Tooth thickness of cylindrical gears in scenes: the keys that give it, the gear that follows, its rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
from loaded_tca.gears.tooth_measures import (
    MeasuredGear,
    allowance_of_balls,
    allowance_of_pins,
    allowance_of_span,
    allowance_of_thickness,
)
from loaded_tca.plain import plain
from loaded_tca.scene.blank import BlankGearSection
from loaded_tca.scene.keys import Whole, key
from loaded_tca.scene.rows import Cell, Label, fixed
from loaded_tca.scene.section import Rule
from loaded_tca.scene.sections import DIAMETER_mm, SLOPE_um

if TYPE_CHECKING:
    from loaded_tca.scene.model import Row


def _one_of(other: str, value: float | None, beside: float | None) -> str | None:
    """What is wrong where two keys give the tooth thickness."""
    if value is None or beside is None:
        return None
    return f"found {plain(value, 6)} beside {other} = {plain(beside, 6)}; give one of them"


THICKNESS = (
    "thickness_allowance_um",
    "normal_tooth_thickness_mm",
    "span_measurement_mm",
    "ball_measurement_mm",
    "pin_measurement_mm",
)
"""Keys of which one gives the tooth thickness."""
MEASURES = THICKNESS[1:]
"""Those of which the allowance follows by way of a gear with nominal thickness."""


def needs(key: str, other: str, *, back: bool = False) -> Rule:
    """Rule: a key has a meaning beside another one only; ``back``: and the other one beside it."""

    def complain(value: float | None, partner: float | None) -> str | None:
        if value is not None and partner is None:
            return f"found {plain(value, 6)}; it needs {other}"
        if back and value is None and partner is not None:
            return f"missing; {other} = {plain(partner, 6)} needs it"
        return None

    return Rule((key, other), complain)


@dataclass(frozen=True, kw_only=True)
class MeasuredSection(BlankGearSection):
    """Section of an external gear or a ring whose tooth thickness is given or measured."""

    thickness_allowance_um: float | None = key(
        SLOPE_um,
        "allowance A_sn of the tooth thickness in the normal section at the reference circle, negative for thinner "
        "teeth, up to half a module: flanks and root are cut with x_E",
        None,
        "0",
    )
    normal_tooth_thickness_mm: float | None = key(
        DIAMETER_mm,
        "or the thickness s_n itself in the normal section at the reference circle, an arc",
        None,
        "m_n (pi/2 + 2 x tan(alpha_n))",
    )
    span_measurement_mm: float | None = key(
        DIAMETER_mm,
        "or span W_k of these teeth; of a ring, whose teeth must be straight, between the flanks over k spaces",
        None,
        "not measured",
    )
    span_teeth: int | None = key(
        Whole(1, 10000), "number of teeth k of the span, of spaces of a ring", None, "touches nearest to d + 2 x m_n"
    )
    ball_measurement_mm: float | None = key(
        DIAMETER_mm,
        "or measure M_dK over two balls, between them in a ring",
        None,
        "not measured",
    )
    ball_diameter_mm: float | None = key(DIAMETER_mm, "diameter D_M of the balls", None, "of `ball_measurement_mm`")
    pin_measurement_mm: float | None = key(
        DIAMETER_mm,
        "or measure M_dR over two pins, between them in a ring, whose teeth must be straight; other than M_dK for an "
        "odd number of helical teeth",
        None,
        "not measured",
    )
    pin_diameter_mm: float | None = key(DIAMETER_mm, "diameter D_M of the pins", None, "of `pin_measurement_mm`")

    rules: ClassVar[tuple[Rule, ...]] = (
        *BlankGearSection.rules,
        *(Rule(pair, partial(_one_of, pair[1])) for pair in combinations(THICKNESS, 2)),
        needs("span_teeth", "span_measurement_mm"),
        needs("ball_diameter_mm", "ball_measurement_mm", back=True),
        needs("pin_diameter_mm", "pin_measurement_mm", back=True),
    )


GearType = TypeVar("GearType", CylindricalGear, RingGear)


def gear_of(values: Mapping[str, Any], own: MeasuredSection) -> CylindricalGear:
    """External gear of the keys of its section; one with measured teeth has its root and bore checked as measured.

    Thickness is measured on flanks, wherever the root lies. The root diameter of a gear asks for a dedendum that
    depends on the thickness, so that a gear of nominal thickness would need another one.
    """
    if all(getattr(own, key) is None for key in MEASURES):
        return CylindricalGear(**values)
    inside = {key: values[key] for key in ("root_diameter", "bore_diameter") if key in values}
    nominal = CylindricalGear(**{key: value for key, value in values.items() if key not in inside})
    return as_measured(nominal, own, **inside)


def as_measured(gear: GearType, own: MeasuredSection, **inside: Any) -> GearType:
    """Gear with the thickness of its teeth that is given, or that a span, balls or pins tell, if they do.

    ``inside``: fields that this gear has, and the one with nominal thickness does not.
    """

    def with_allowance(allowance: float) -> GearType:
        return replace(gear, thickness_allowance=allowance, **inside)

    if own.normal_tooth_thickness_mm is not None:
        return with_allowance(allowance_of_thickness(gear, own.normal_tooth_thickness_mm))
    if own.span_measurement_mm is not None:
        teeth = own.span_teeth or gear.span_teeth
        measured = with_allowance(allowance_of_span(gear, own.span_measurement_mm, teeth))
        measured.span_measurement(teeth)  # refuses a span that touches no flank
        return measured
    for measurement, diameter, allowance_of, measured_over in (
        (own.ball_measurement_mm, own.ball_diameter_mm, allowance_of_balls, MeasuredGear.ball_measurement),
        (own.pin_measurement_mm, own.pin_diameter_mm, allowance_of_pins, MeasuredGear.pin_measurement),
    ):
        if measurement is not None and diameter is not None:
            measured = with_allowance(allowance_of(gear, measurement, diameter))
            measured_over(measured, diameter)  # refuses balls and pins that touch no flank
            return measured
    return gear


MOST_THICKER, MOST_THINNER = 0.01, 0.1
"""Allowances over the module above and below which a question is asked. x of a drawing is rounded to 0.01 at the most,
0.004 modules of thickness; backlash takes some hundredths of a module."""


MOST_BACKLASH = 0.2
"""Normal backlash over the module above which a question is asked: gears have some hundredths, and at a pressure angle
of 20 degrees so much is a sum of profile shifts that is off by 0.3. ISO/TR 10064-2 has at least 0.04 to 0.1 from module
1 on, (2/3)(0.06 mm + 0.0005 a + 0.03 m_n)/m_n."""


def odd_backlash(mesh: CylindricalMesh | InternalMesh) -> list[str]:
    """A sentence on gears with a backlash that looks like profile shifts that are not given."""
    if mesh.normal_backlash <= MOST_BACKLASH * mesh.pinion.normal_module:
        return []
    return [
        kinds.WIDE_BACKLASH.sentence(
            backlash=mesh.normal_backlash,
            modules=mesh.normal_backlash / mesh.pinion.normal_module,
            distance=mesh.working_centre_distance,
            given=mesh.pinion.profile_shift + mesh.wheel.profile_shift,
            wanted=mesh.profile_shift_sum_without_backlash,
        )
    ]


def odd_thickness(gear: CylindricalGear | RingGear, shift: float | None, *, follows: bool) -> list[str]:
    """A sentence on a gear with an allowance that looks like a profile shift that is not given.

    Parameters
    ----------
    gear : CylindricalGear or RingGear
    shift : float, optional
        Profile shift of the scene.
    follows : bool
        Whether one that is not given follows from the centre distance; else thin teeth are asked about, too.
    """
    allowance, module = gear.thickness_allowance, gear.normal_module
    absent = shift is None and not follows
    if allowance <= MOST_THICKER * module and not (absent and allowance < -MOST_THINNER * module):
        return []
    by_default = "which follows from the centre distance" if follows else "the default, since none is given"
    return [
        kinds.THICKNESS.sentence(
            gear=gear.name,
            allowance=1e3 * allowance,
            shift=gear.profile_shift,
            source=by_default if shift is None else "which is given",
            generating=gear.generating_profile_shift,
        )
    ]


def thickness_rows(mesh: CylindricalMesh | InternalMesh, own: tuple[MeasuredSection, MeasuredSection]) -> list[Row]:
    """Tooth thickness of both gears and how it is measured; "-" of a gear without a span, and below it why."""
    gears: tuple[CylindricalGear, CylindricalGear | RingGear] = mesh.pinion, mesh.wheel
    internal = isinstance(mesh, InternalMesh)
    spans = [_span(gear) for gear in gears]
    alterations = (round(gear.tip_alteration / gear.normal_module, 4) for gear in gears)
    rows = [
        ("tip alteration coefficient k", *(fixed(one, 4) for one in alterations)),
        ("tooth thickness s_n [mm]", *(fixed(gear.normal_tooth_thickness, 4) for gear in gears)),
        (Label(f"span W_k over k teeth{' (spaces)' if internal else ''} [mm]", "span"), *(span for span, _ in spans)),
        *((f"  no span W_k of the {name}", why) for name, (_, why) in zip(GEARS, spans, strict=True) if why),
    ]
    if any(gear.thickness_allowance for gear in gears):
        rows[1:1] = [
            ("thickness allowance A_sn [um]", *(fixed(1e3 * gear.thickness_allowance, 1) for gear in gears)),
            ("generating profile shift x_E", *(fixed(gear.generating_profile_shift, 4) for gear in gears)),
        ]
    diameters = [section.ball_diameter_mm or section.pin_diameter_mm for section in own]
    if any(diameters):
        over = f"over {'(between) ' if internal else ''}"
        for label, measures in (
            (f"measure {over}balls M_dK [mm]", (gear.ball_measurement for gear in gears)),
            (f"measure {over}pins M_dR [mm]", (gear.pin_measurement for gear in gears)),
        ):
            rows.append((label, *map(_measure, measures, diameters)))
    return rows


def _measure(measurement: Callable[[float], float], diameter: float | None) -> Cell | str:
    """Measure over balls or pins of a diameter; "-" of a gear that has none."""
    try:
        return "-" if diameter is None else fixed(measurement(diameter), 4)
    except InputError:
        return "-"


def _span(gear: CylindricalGear | RingGear) -> tuple[str, str]:
    """Span over the usual number of teeth with that number, or "-" and the reason."""
    teeth = gear.span_teeth
    try:
        span = gear.span_measurement(teeth)
    except InputError as error:
        return "-", "; ".join(problem.removeprefix(f"{gear.name}: ").partition(": ")[2] for problem in error.problems)
    return Cell(f"{span:z.4f} ({teeth})", {"W_k_mm": span, "k": teeth}), ""
