"""Tooth thickness of cylindrical gears in scenes: the keys that give it, the gear that follows, its rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, TypeVar

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
from loaded_tca.gears.tooth_measures import allowance_of_balls, allowance_of_span
from loaded_tca.plain import plain
from loaded_tca.scene.blank import BlankGearSection
from loaded_tca.scene.keys import Whole, key
from loaded_tca.scene.rows import Cell, Label, fixed
from loaded_tca.scene.section import Rule
from loaded_tca.scene.sections import DIAMETER_mm, SLOPE_um

if TYPE_CHECKING:
    from loaded_tca.scene.model import Row


def one_thickness(allowance: float | None, span: float | None, balls: float | None) -> str | None:
    """What is wrong where more than one key gives the tooth thickness."""
    keys = {"thickness_allowance_um": allowance, "span_measurement_mm": span, "ball_measurement_mm": balls}
    given = [f"{name} = {plain(value, 6)}" for name, value in keys.items() if value is not None]
    return f"found {' beside '.join(given)}; give one of them" if len(given) > 1 else None


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
        "or measure M_dK over two balls, between them in a ring; the same over pins if teeth are straight",
        None,
        "not measured",
    )
    ball_diameter_mm: float | None = key(DIAMETER_mm, "diameter D_M of the balls", None, "of `ball_measurement_mm`")

    rules: ClassVar[tuple[Rule, ...]] = (
        *BlankGearSection.rules,
        Rule(("thickness_allowance_um", "span_measurement_mm", "ball_measurement_mm"), one_thickness),
        needs("span_teeth", "span_measurement_mm"),
        needs("ball_diameter_mm", "ball_measurement_mm", back=True),
    )


GearType = TypeVar("GearType", CylindricalGear, RingGear)


def as_measured(gear: GearType, own: MeasuredSection) -> GearType:
    """Gear with the thickness of its teeth that a span or balls tell, if they do."""
    if own.span_measurement_mm is not None:
        teeth = own.span_teeth or gear.span_teeth
        measured = replace(gear, thickness_allowance=allowance_of_span(gear, own.span_measurement_mm, teeth))
        measured.span_measurement(teeth)  # refuses a span that touches no flank
        return measured
    if own.ball_measurement_mm is not None and own.ball_diameter_mm is not None:
        allowance = allowance_of_balls(gear, own.ball_measurement_mm, own.ball_diameter_mm)
        measured = replace(gear, thickness_allowance=allowance)
        measured.ball_measurement(own.ball_diameter_mm)
        return measured
    return gear


def thickness_rows(mesh: CylindricalMesh | InternalMesh, balls: Sequence[float | None]) -> list[Row]:
    """Tooth thickness of both gears and how it is measured; "-" of a gear without a span, and below it why."""
    gears: tuple[CylindricalGear, CylindricalGear | RingGear] = mesh.pinion, mesh.wheel
    internal = isinstance(mesh, InternalMesh)
    spans = [_span(gear) for gear in gears]
    alterations = (round(gear.tip_alteration / gear.normal_module, 4) for gear in gears)
    rows = [
        ("tip alteration coefficient k", *(fixed(one, 4) for one in alterations)),
        ("tooth thickness s_n [mm]", *(fixed(gear.normal_tooth_thickness, 4) for gear in gears)),
        (Label(f"span W_k over k teeth{' (spaces)' if internal else ''} [mm]", "span"), *(span for span, _ in spans)),
        *((f"  none of the {name}", why) for name, (_, why) in zip(GEARS, spans, strict=True) if why),
    ]
    if any(gear.thickness_allowance for gear in gears):
        rows[1:1] = [
            ("thickness allowance A_sn [um]", *(fixed(1e3 * gear.thickness_allowance, 1) for gear in gears)),
            ("generating profile shift x_E", *(fixed(gear.generating_profile_shift, 4) for gear in gears)),
        ]
    if any(balls):
        measures = (fixed(g.ball_measurement(size), 4) if size else "-" for g, size in zip(gears, balls, strict=True))
        rows.append((f"measure over {'(between) ' if internal else ''}balls M_dK [mm]", *measures))
    return rows


def _span(gear: CylindricalGear | RingGear) -> tuple[str, str]:
    """Span over the usual number of teeth with that number, or "-" and the reason."""
    teeth = gear.span_teeth
    try:
        span = gear.span_measurement(teeth)
    except InputError as error:
        return "-", "; ".join(problem.removeprefix(f"{gear.name}: ").partition(": ")[2] for problem in error.problems)
    return Cell(f"{span:z.4f} ({teeth})", {"W_k_mm": span, "k": teeth}), ""
