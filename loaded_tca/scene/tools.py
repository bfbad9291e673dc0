"""Tools of cylindrical gears in scenes: the basic rack of each gear, its tip, and what belongs to them."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, radians
from typing import TYPE_CHECKING, Any, ClassVar

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS
from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
from loaded_tca.gears.chamfer import chamfered_land
from loaded_tca.gears.tips import computed_tip_alteration
from loaded_tca.plain import plain
from loaded_tca.scene.build import parameters_of
from loaded_tca.scene.keys import Choice, Either, Number, above_zero, key
from loaded_tca.scene.rows import fixed
from loaded_tca.scene.section import Rule
from loaded_tca.scene.sections import DIAMETER_mm
from loaded_tca.scene.thickness import MeasuredSection, odd_thickness

if TYPE_CHECKING:
    from loaded_tca.scene.cylindrical import Geometry
    from loaded_tca.scene.model import Row

ADDENDUM = Number(0.1, 5.0)
DEDENDUM = above_zero(5.0)
FULL = "full"
ROOT_RADIUS = Either((Choice((FULL,)), Number(0.0, 1.0)))
TIP_SHORTENING = Choice(("none", "computed"))
PROFILE_A = 1.0, 1.25, 0.38
"""h_aP, h_fP and rho_fP of ISO 53, profile A, over the module."""


def _tip_once(
    diameter: float | None, alteration: float | None, addendum: float | None, topping: bool | None
) -> str | None:
    """What is wrong where the tip is given twice."""
    others = {
        "tip_alteration_coefficient": alteration,
        "addendum_coefficient": addendum,
        "topping": "true" if topping else None,
    }
    given = [f"{name} = {value}" for name, value in others.items() if value is not None]
    if diameter is not None and given:
        return f"found {plain(diameter, 6)} beside {' and '.join(given)}; give one of them: each says where the tip is"
    return None


def _one_root(dedendum: float | None, diameter: float | None) -> str | None:
    if dedendum is None or diameter is None:
        return None
    return (
        f"found {plain(dedendum, 6)} beside root_diameter_mm = {plain(diameter, 6)}; give one of them: each "
        "says where the root is"
    )


def _topped(topping: bool, alteration: float | None) -> str | None:
    if topping and alteration is not None:
        return (
            f"found true beside tip_alteration_coefficient = {plain(alteration, 6)}; give one of them: each "
            "cuts the tip"
        )
    return None


def _one_edge(chamfer: float, rounding: float) -> str | None:
    if chamfer > 0.0 and rounding > 0.0:
        return (
            f"found {plain(chamfer, 6)} beside tip_rounding_mm = {plain(rounding, 6)}; give one of them: "
            "each ends the flank"
        )
    return None


def _needs_chamfer(angle: float | None, chamfer: float) -> str | None:
    return None if angle is None or chamfer > 0.0 else f"found {plain(angle, 6)}; it needs tip_chamfer_mm above 0"


@dataclass(frozen=True, kw_only=True)
class CutSection(MeasuredSection):
    """Section of an external gear or a ring with a basic rack and a tip of its own."""

    tip_diameter_mm: float | None = key(DIAMETER_mm, "tip diameter d_a", None, "d + 2 m_n (h_aP + x + k)")
    tip_alteration_coefficient: float | None = key(
        Number(-2.0, 1.0),
        "tip alteration coefficient k, negative for a shortened tip, instead of `tip_diameter_mm`",
        None,
        "0, or as `pair.tip_shortening` has it",
    )
    addendum_coefficient: float | None = key(
        ADDENDUM, "addendum of the basic rack of this gear in modules, h_aP/m_n", None, "that of [pair]"
    )
    dedendum_coefficient: float | None = key(
        DEDENDUM, "dedendum of the basic rack of this gear in modules, h_fP/m_n", None, "that of [pair]"
    )
    root_diameter_mm: float | None = key(
        DIAMETER_mm, "root diameter d_f, instead of `dedendum_coefficient`", None, "d - 2 m_n (h_fP - x_E)"
    )
    root_radius_coefficient: float | str | None = key(
        ROOT_RADIUS,
        'root radius of the basic rack of this gear in modules, rho_fP/m_n; "full": the largest that fits',
        None,
        "that of [pair]",
    )
    topping: bool = key(
        Choice((False, True)),
        "whether the tool cuts the tips, too, which then follow the thickness: k m_n = A_sn/(2 tan(alpha_n))",
        False,
    )
    tip_chamfer_mm: float = key(
        Number(0.0, 1000.0),
        "height of chamfers of both tip edges along the radius, below a module: the flank ends so far below the tip",
        0.0,
    )
    tip_chamfer_angle_deg: float | None = key(
        Number(1.0, 89.0), "angle between chamfer and middle of the tooth", None, "45"
    )

    @property
    def has_own_tip(self) -> bool:
        """Whether a key of the gear says where its tip is."""
        return self.topping or self.tip_diameter_mm is not None or self.tip_alteration_coefficient is not None

    rules: ClassVar[tuple[Rule, ...]] = (
        *MeasuredSection.rules,
        Rule(("tip_chamfer_mm", "tip_rounding_mm"), _one_edge),
        Rule(("tip_chamfer_angle_deg", "tip_chamfer_mm"), _needs_chamfer),
        Rule(("tip_diameter_mm", "tip_alteration_coefficient", "addendum_coefficient", "topping"), _tip_once),
        Rule(("topping", "tip_alteration_coefficient"), _topped),
        Rule(("dedendum_coefficient", "root_diameter_mm"), _one_root),
    )


def _shortened_once(shortening: str, *values: Any) -> str | None:
    beside = [
        f"{path} = {'true' if value is True else value}"
        for path, value in zip(TIPS, values, strict=True)
        if value is not None and value is not False
    ]
    if shortening == "computed" and beside:
        return f'found "computed" beside {" and ".join(beside)}; give one of them: each says where tips are'
    return None


def needs_stock(protuberance: float | None, stock: float | None) -> str | None:
    """What is wrong with a protuberance that no grinding follows."""
    if protuberance and not stock:
        return (
            f"found {plain(protuberance, 6)} without grinding_stock_um; give the stock that it makes room for: without "
            "one it would cut into the flank"
        )
    return None


def needs_protuberance(angle: float | None, protuberance: float | None) -> str | None:
    """What is wrong with the angle of a protuberance that is not there."""
    return None if angle is None or protuberance else f"found {plain(angle, 6)}; it needs protuberance_um above 0"


TIPS = tuple(
    f"{gear}.{name}" for gear in GEARS for name in ("tip_diameter_mm", "tip_alteration_coefficient", "topping")
)
SHORTENED_ONCE = Rule(("pair.tip_shortening", *TIPS), _shortened_once)
"""Rule of scenes: a computed tip shortening stands alone."""


def cut_parameters(gear: type, geometry: Geometry, own: CutSection) -> dict[str, Any]:
    """Values that a gear takes of the section of the pair and its own, in mm and rad; its own tool comes first."""
    values = parameters_of(gear, geometry, own)
    if values["root_radius_coefficient"] == FULL:
        values["root_radius_coefficient"] = inf
    if own.tip_diameter_mm is not None:
        values["addendum_coefficient"] = 1.0  # of the rack of ISO 53, from which k of a given tip counts
    return values


def tip_alteration(geometry: Geometry, teeth: tuple[int, int], shifts: tuple[float, float]) -> float:
    """Tip alteration coefficient of both gears that keeps the clearance."""
    return computed_tip_alteration(
        teeth,
        shifts,
        geometry.normal_module_mm,
        pressure_angle=radians(geometry.pressure_angle_deg),
        helix_angle=radians(geometry.helix_angle_deg),
        centre_distance=geometry.centre_distance_mm,
    )


def shortening(geometry: Geometry, teeth: tuple[int, int], shifts: tuple[float, float]) -> dict[str, float]:
    """Tip alteration of both gears where the scene has it computed, as a parameter of gears."""
    if geometry.tip_shortening != "computed":
        return {}
    return {"tip_alteration_coefficient": tip_alteration(geometry, teeth, shifts)}


ROUNDING = 1e-9
"""Relative difference of two lengths that are one: they are solved for to some 1e-12."""
LONGEST_TIP = 0.1
"""Tip alteration over the module above which a question is asked, of a gear without a profile shift of its own: tip
diameters are rounded, and have tolerances, of less."""


def odd_tip(gear: CylindricalGear | RingGear, own: CutSection) -> list[str]:
    """A sentence on a gear whose tip diameter looks like that of a profile shift that is not given."""
    alteration = gear.tip_alteration / gear.normal_module
    if own.tip_diameter_mm is None or alteration <= LONGEST_TIP:
        return []
    return [kinds.LONG_TIP.sentence(gear=gear.name, alteration=alteration, shift=gear.profile_shift + alteration)]


def odd_teeth(gear: CylindricalGear | RingGear, own: CutSection, *, follows: bool) -> list[str]:
    """Sentences on a gear whose teeth look as if a profile shift of theirs were not given.

    ``follows``: whether one that is not given follows from the centre distance, and the tips with it.
    """
    thick = odd_thickness(gear, own.profile_shift, follows=follows)
    return thick or (odd_tip(gear, own) if own.profile_shift is None and not follows else [])


def rack_rows(mesh: CylindricalMesh | InternalMesh) -> list[Row]:
    """Basic racks of both gears, where one of them is not that of ISO 53, profile A."""
    gears: tuple[CylindricalGear, CylindricalGear | RingGear] = mesh.pinion, mesh.wheel
    racks, rows = [_rack(gear) for gear in gears], []
    if any(rack != PROFILE_A for rack in racks):
        cells = (
            f"{plain(addendum, 6)}/{plain(dedendum, 6)}/{_rounding(gear, radius)}"
            for gear, (addendum, dedendum, radius) in zip(gears, racks, strict=True)
        )
        rows.append(("basic rack: h_aP/h_fP/rho_fP [m_n]", *cells))
    tools = [gear if isinstance(gear, CylindricalGear) and gear.grinding_stock else None for gear in gears]
    if any(tools):
        cells = (_protuberance(gear) if gear else "-" for gear in tools)
        rows.append(("protuberance pr/stock q/undercut s_pr [um]", *cells))
    return rows


def chamfer_rows(mesh: CylindricalMesh | InternalMesh) -> list[Row]:
    """Tip form circles and lands of tips that are chamfered."""
    gears: tuple[CylindricalGear, CylindricalGear | RingGear] = mesh.pinion, mesh.wheel
    if not any(gear.tip_chamfer for gear in gears):
        return []
    lands = (fixed(chamfered_land(gear), 4) if gear.tip_chamfer else "-" for gear in gears)
    return [
        ("tip form diameter d_Fa [mm]", *(fixed(2.0 * gear.tip_form_radius, 4) for gear in gears)),
        ("tip land between chamfers [mm]", *lands),
    ]


def _rounding(gear: CylindricalGear | RingGear, asked: float) -> str:
    """Root radius in modules; where less fits than is asked for, the largest that does."""
    radius = (gear.fillet_radius if isinstance(gear, RingGear) else gear.rack_tip_radius) / gear.normal_module
    if asked == inf:
        return FULL
    return f"{plain(radius, 4)} ({FULL})" if radius < (1.0 - ROUNDING) * asked else plain(asked, 6)


def _protuberance(gear: CylindricalGear) -> str:
    values = gear.protuberance, gear.grinding_stock, gear.residual_undercut
    return "/".join(f"{plain(1e3 * value, 6)}" for value in values)


def _rack(gear: CylindricalGear | RingGear) -> tuple[float, float, float]:
    """h_aP, h_fP and rho_fP over the module; of a ring with a cutter the rounding of that."""
    if isinstance(gear, RingGear) and gear.cutter is not None:
        return gear.addendum_coefficient, gear.dedendum_coefficient, gear.cutter.tip_radius_coefficient
    return gear.addendum_coefficient, gear.dedendum_coefficient, gear.root_radius_coefficient
