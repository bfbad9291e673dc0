"""Modifications of a REXS flank as keys of a scene.

A scene has amounts of removed material at the ends of the face and of the active profile; a file may have them
elsewhere, and of other shapes. What has the same shape is scaled, by the roll length or along the face; what has not is
left, with its reason.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from loaded_tca.exchange.gears import DIGITS
from loaded_tca.exchange.model import LENGTH, Component, Reading
from loaded_tca.plain import plain
from loaded_tca.units import MICROMETRES

CLOSE_um = 1e-3
"""Difference of amounts that are the same."""
LEAST = 1e-3
"""Part of the face or of the profile over which an amount is given at the least; less tells nothing of it."""
POWERS = {"linear": 1, "parabolic": 2, "circular": 2}
"""Shapes of reliefs; arcs of a circle are parabolas to the fourth order of the amount over the length."""


@dataclass(frozen=True)
class Teeth:
    """What amounts of modifications rest on, of one gear.

    Attributes
    ----------
    face_width : float [mm]
    base_diameter : float [mm]
    tip_roll, start_roll : float [mm]
        Roll lengths at the tip and at the start of the active profile.
    datum : int
        -1 where the datum face is at the lower end of the face in the scene, else +1.
    ring : bool
        Whether it is a ring gear.
    """

    face_width: float
    base_diameter: float
    tip_roll: float
    start_roll: float
    datum: int
    ring: bool = False

    def roll(self, diameter: float) -> float:
        """Roll length at a diameter [mm]; 0 within the base circle."""
        return 0.5 * math.sqrt(max(diameter**2 - self.base_diameter**2, 0.0))


Keys = dict[str, float | str]


class _Left(Exception):  # noqa: N818
    """Why a modification is not taken."""


def modification_keys(reading: Reading, flank: Component, teeth: Teeth) -> Keys:
    """Return the keys of [pinion.modifications] or [wheel.modifications] that a flank has.

    Parameters
    ----------
    reading : Reading
    flank : Component
    teeth : Teeth
    """
    keys: Keys = {}
    for modification in reading.model.related("reference", "origin", flank.id, "referenced"):
        if modification.type == "material":
            continue
        reading.take(modification, "is_additive_modification")
        if modification.type not in KINDS:
            reading.leave_whole(modification, "no modification that a scene has")
            continue
        try:
            if modification.flag("is_additive_modification") is False:
                raise _Left("is_additive_modification: false; allowed true")
            if teeth.ring and modification.type in ("profile_crowning", "profile_slope", "tip_relief", "root_relief"):
                raise _Left("modifications of the profile of ring gears are not read")
            more = KINDS[modification.type](reading, modification, teeth)
        except _Left as reason:
            reading.leave_whole(modification, str(reason))
            continue
        taken = [name for name in more if name in keys and not (name.endswith("slope_um"))]
        if taken:
            reading.leave_whole(modification, f"{taken[0]} is taken by another modification")
            continue
        for name, value in more.items():
            if name.endswith("slope_um"):  # slopes of several modifications add
                keys[name] = round(float(keys.get(name, 0.0)) + float(value), DIGITS)
            else:
                keys[name] = value
    return keys


def _amount(reading: Reading, modification: Component, name: str) -> float:
    """Amount [um], 0 where it is not given."""
    return MICROMETRES * (reading.number(modification, name, LENGTH) or 0.0)


def _um(value: float) -> float:
    return round(value, DIGITS)


def _removed(value: float) -> float:
    """An amount that is removed; material added has no key."""
    if value < 0.0:
        raise _Left(f"found {plain(value, 6)} um; allowed are amounts that are removed, from 0 on")
    return _um(value)


def _helix_crowning(reading: Reading, modification: Component, teeth: Teeth) -> Keys:
    amounts = [
        _amount(reading, modification, f"helix_crowning_amount_{face}") for face in ("datum_face", "non_datum_face")
    ]
    half = 0.5 * teeth.face_width
    at = [
        abs(reading.number(modification, f"coordinate_where_helix_crowning_is_specified_{face}", LENGTH, half) or half)
        for face in ("datum_face", "non_datum_face")
    ]
    highest = reading.number(modification, "helix_highest_point", LENGTH, 0.0) or 0.0
    shape = reading.take(modification, "shape_of_helix_crowning").text("shape_of_helix_crowning")
    if abs(highest) > 1e-3 * teeth.face_width:
        raise _Left(f"helix_highest_point: found {plain(highest, 6)} mm; allowed 0, the middle of the face")
    if min(at) < LEAST * half:
        raise _Left("its amounts are given in the middle of the face")
    ends = [_removed(amount * (half / place) ** 2) for amount, place in zip(amounts, at, strict=True)]
    if abs(ends[0] - ends[1]) < CLOSE_um:
        return {"lead_crowning_um": ends[0]} | ({"lead_crowning_form": "circular"} if shape == "circular" else {})
    keys: Keys = {}  # the half of a parabola is an end relief over half the face
    for end, amount in zip(("lower", "upper"), ends[:: -teeth.datum], strict=True):
        keys |= {f"end_relief_{end}_um": amount, f"end_relief_{end}_length_mm": half}
    return keys


def _helix_slope(reading: Reading, modification: Component, teeth: Teeth) -> Keys:
    amount = _amount(reading, modification, "helix_slope")
    ends = [reading.number(modification, f"helix_evaluation_{end}", LENGTH) for end in ("start", "end")]
    reading.take(modification, "helix_evaluation_reference")
    if ends[0] is not None and ends[1] is not None:
        if abs(ends[1] - ends[0]) < LEAST * teeth.face_width:
            raise _Left("helix_evaluation_start: found at helix_evaluation_end")
        amount *= teeth.face_width / abs(ends[1] - ends[0])
    reading.note(f"{modification}: a positive helix_slope removes material towards the face opposite to the datum face")
    return {"helix_slope_um": _um(-teeth.datum * amount)}


def _end_relief(face: str) -> Callable[[Reading, Component, Teeth], Keys]:
    def keys(reading: Reading, modification: Component, teeth: Teeth) -> Keys:
        amount = _amount(reading, modification, f"end_relief_depth_{face}")
        length = reading.number(modification, f"end_relief_length_{face}", LENGTH)
        if length is None or length <= 0.0:
            raise _Left(f"end_relief_length_{face}: missing or 0; an end relief needs a length")
        if _power(reading, modification) != 2:
            raise _Left('shape_of_relief: found "linear"; end reliefs of scenes are parabolic')
        at_datum = face == "datum_face"
        end = "lower" if (teeth.datum < 0) == at_datum else "upper"
        return {f"end_relief_{end}_um": _removed(amount), f"end_relief_{end}_length_mm": length}

    return keys


def _power(reading: Reading, modification: Component) -> int:
    """Power of the shape of a relief, linear where the file does not say."""
    shape = reading.take(modification, "shape_of_relief").text("shape_of_relief") or "linear"
    if shape not in POWERS:
        raise _Left(f'shape_of_relief: found "{shape}"; allowed linear, parabolic or circular')
    return POWERS[shape]


def _relief(end: str) -> Callable[[Reading, Component, Teeth], Keys]:
    """Tip or root relief: from its start to the tip, or down to the start of the active profile."""

    def keys(reading: Reading, modification: Component, teeth: Teeth) -> Keys:
        last = teeth.tip_roll if end == "tip" else teeth.start_roll
        amount = _amount(reading, modification, f"{end}_relief_depth")
        diameter = reading.number(modification, f"{end}_relief_datum_diameter", LENGTH)
        length = reading.number(modification, f"{end}_relief_datum_length", LENGTH)
        if diameter is None and length is None:
            raise _Left(f"{end}_relief_datum_diameter: missing, and {end}_relief_datum_length, too; give one")
        inwards = -1.0 if end == "tip" else 1.0
        start = last + inwards * abs(length or 0.0) if diameter is None else teeth.roll(diameter)
        where = reading.number(modification, f"{end}_relief_evaluation_reference", LENGTH)
        power = _power(reading, modification)
        if (last - start) * inwards >= 0.0:
            raise _Left(f"it starts beyond the {'tip' if end == 'tip' else 'start of the active profile'}")
        if where is not None and (teeth.roll(where) - start) * inwards < -LEAST * abs(last - start):
            amount *= ((last - start) / (teeth.roll(where) - start)) ** power
        starts: Keys = (
            {f"{end}_relief_start_length_mm": start} if diameter is None else {f"{end}_relief_start_mm": diameter}
        )
        form = "linear" if power == 1 else "parabolic"
        return {f"{end}_relief_um": _removed(amount), **starts, f"{end}_relief_form": form}

    return keys


def _ends_of_profile(
    reading: Reading, modification: Component, teeth: Teeth, tip: str, root: str
) -> tuple[float, float]:
    """Roll lengths of the two places where a modification of the profile has its amounts."""
    places = []
    for name, default in ((tip, teeth.tip_roll), (root, teeth.start_roll)):
        diameter = reading.number(modification, name, LENGTH)
        places.append(default if diameter is None else teeth.roll(diameter))
    return places[0], places[1]


def _profile_crowning(reading: Reading, modification: Component, teeth: Teeth) -> Keys:
    amounts = [_amount(reading, modification, f"profile_crowning_at_{end}") for end in ("tip", "root")]
    where = [f"diameter_where_profile_crowning_{end}_is_specified" for end in ("tip", "root")]
    tip, root = _ends_of_profile(reading, modification, teeth, *where)
    reading.take(modification, "shape_of_profile_crowning")
    if abs(amounts[0] - amounts[1]) > CLOSE_um:
        raise _Left(
            f"found {plain(amounts[0], 6)} um at the tip and {plain(amounts[1], 6)} um at the root; allowed "
            "equal amounts"
        )
    half, own = 0.5 * (tip - root), 0.5 * (teeth.tip_roll - teeth.start_roll)
    if half < LEAST * own:
        raise _Left("its amounts are given at one place of the profile")
    shifted = 0.5 * (teeth.tip_roll + teeth.start_roll) - 0.5 * (tip + root)
    keys: Keys = {"profile_crowning_um": _removed(amounts[0] * (own / half) ** 2)}
    slope = 4.0 * amounts[0] * shifted * own / half**2  # a parabola about another middle has a slope about this one
    if abs(slope) >= CLOSE_um:
        keys["profile_slope_um"] = _um(slope)
    return keys


def _profile_slope(reading: Reading, modification: Component, teeth: Teeth) -> Keys:
    amount = _amount(reading, modification, "profile_slope")
    tip, root = _ends_of_profile(reading, modification, teeth, "profile_evaluation_end", "profile_evaluation_start")
    if tip - root < LEAST * (teeth.tip_roll - teeth.start_roll):
        raise _Left("profile_evaluation_start: found at profile_evaluation_end, or beyond")
    reading.note(f"{modification}: a positive profile_slope removes material towards the tip")
    return {"profile_slope_um": _um(amount * (teeth.tip_roll - teeth.start_roll) / (tip - root))}


KINDS: dict[str, Callable[[Reading, Component, Teeth], Keys]] = {
    "helix_crowning": _helix_crowning,
    "helix_slope": _helix_slope,
    "end_relief_datum_face": _end_relief("datum_face"),
    "end_relief_non_datum_face": _end_relief("non_datum_face"),
    "profile_crowning": _profile_crowning,
    "profile_slope": _profile_slope,
    "tip_relief": _relief("tip"),
    "root_relief": _relief("root"),
}
"""Types of components -> what makes keys of them."""
