"""Undercut gears in the mesh: what their flanks lack of the path of contact, and the room of tips behind them.

A basic rack that reaches beyond the end T of the line of action cuts a trochoid that crosses the involute. There, at
the root form circle, the flank ends in a corner, and the path of contact with it. The tip of the mating gear, which
would use a whole involute further down, turns in the space behind it. Lengths are in mm, angles in rad, in the
transverse section.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS
from loaded_tca.gears.chamfer import tip_half_angle
from loaded_tca.gears.cylindrical import CylindricalGear

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loaded_tca.gears.cylindrical_mesh import CylindricalMesh
    from loaded_tca.gears.internal_mesh import InternalMesh
    from loaded_tca.gears.ring import RingGear

NEGLIGIBLE = 1e-4
"""In modules: a lower piece of undercut flank is below what gear making can hold (0.3 um at module 3)."""
POINTS = 500
"""Along a fillet, and along the path of a tip in it: between them a fillet is off by 1e-5 modules."""


@dataclass(frozen=True)
class Undercut:
    """Part of the path of contact that an undercut removes.

    Attributes
    ----------
    form_radius : float [mm]
        Where the trochoid crosses the involute.
    wanted_radius : float [mm]
        Where the tip of the mating gear would end on a whole involute; at least the base circle.
    lost_length : float [mm]
        The part of the line of action between them.
    lost_share : float
        The same over the path of contact that whole involutes of both gears would have.
    whole_ratio, ratio : float
        Transverse contact ratio of whole involutes, and what the undercuts of both gears leave of it.
    """

    form_radius: float
    wanted_radius: float
    lost_length: float
    lost_share: float
    whole_ratio: float
    ratio: float


def undercuts(mesh: CylindricalMesh | InternalMesh) -> tuple[Undercut | None, Undercut | None]:
    """Undercuts of pinion and wheel; None for a gear whose undercut takes nothing that the mating gear would use.

    Parameters
    ----------
    mesh : CylindricalMesh or InternalMesh

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalMesh
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (12, 40)))
    >>> pinion, wheel = undercuts(mesh)
    >>> round(2.0 * pinion.form_radius, 3), round(pinion.whole_ratio, 3), round(pinion.ratio, 3), wheel
    (33.908, 1.405, 1.275, None)
    """
    gears, rolls = (mesh.pinion, mesh.wheel), mesh.mating_tip_rolls
    lost = [_lost_length(gear, roll) for gear, roll in zip(gears, rolls, strict=True)]
    length = mesh.path_of_contact.AE
    whole = length + sum(lost)
    pinion, wheel = (
        Undercut(
            form_radius=gear.form_radius,
            wanted_radius=gear.radius_at_roll_length(max(0.0, roll)),
            lost_length=rest,
            lost_share=rest / whole,
            whole_ratio=whole / mesh.pinion.base_pitch,
            ratio=length / mesh.pinion.base_pitch,
        )
        if rest > 0.0
        else None
        for gear, roll, rest in zip(gears, rolls, lost, strict=True)
    )
    return pinion, wheel


def _lost_length(gear: CylindricalGear | RingGear, roll: float) -> float:
    """Length of the line of action that an undercut takes of a flank used down to a roll length [mm]."""
    if not isinstance(gear, CylindricalGear) or not gear.is_undercut:
        return 0.0
    wanted = max(0.0, roll)
    height = gear.form_radius - gear.radius_at_roll_length(wanted)
    return gear.roll_length(gear.form_radius) - wanted if height > NEGLIGIBLE * gear.normal_module else 0.0


def undercut_sentences(
    mesh: CylindricalMesh | InternalMesh, place: str, names: tuple[str, str] = GEARS
) -> Sequence[str]:
    """Sentences on what undercuts take of the path of contact, with their sizes.

    Parameters
    ----------
    mesh : CylindricalMesh or InternalMesh
    place : str
        Where they do, in words.
    names : (str, str)
        What the sentences call both gears.
    """
    sentences, gears = [], (mesh.pinion, mesh.wheel)
    for name, gear, mating, cut in zip(names, gears, names[::-1], undercuts(mesh), strict=True):
        if cut is None or not isinstance(gear, CylindricalGear):
            continue
        sentences.append(
            kinds.UNDERCUT.sentence(
                gear=name,
                mating=mating,
                form=2.0 * cut.form_radius,
                wanted=2.0 * cut.wanted_radius,
                lost=cut.lost_length,
                share=cut.lost_share,
                whole=cut.whole_ratio,
                ratio=cut.ratio,
                shift=ceil(1e4 * gear.smallest_profile_shift) / 1e4,
                place=place,
            )
        )
    return sentences


def fillet_room(mesh: CylindricalMesh | InternalMesh, which: int) -> float | None:
    """Least room between an undercut fillet and the tip of the mating gear that turns in it, along the circle [mm].

    Negative: the tip reaches into the fillet; None: the gear is not undercut, or the tip stays above its form circle.
    Both corners of a chamfered tip count. It moves as the gears turn without slip from the line of action to the line
    of centres, and lies behind the flank of its mate by its angle to the middle of the tooth, less that of the fillet.

    Parameters
    ----------
    mesh : CylindricalMesh or InternalMesh
    which : int
        0: the fillet of the pinion; 1: of the wheel.
    """
    gear, mating = (mesh.pinion, mesh.wheel)[:: 1 - 2 * which]
    if not isinstance(gear, CylindricalGear) or not gear.is_undercut:
        return None
    sign = 1.0 if mating.teeth > 0 else -1.0
    angle, roll = mesh.working_pressure_angle, mesh.mating_tip_rolls[which]
    contact = gear.base_radius * np.exp(1j * angle) + roll * np.exp(1j * (angle - 0.5 * np.pi))
    axis = sign * mesh.working_centre_distance
    middle = angle - roll / gear.base_radius + gear.half_thickness_angle_at_base  # of the tooth, at that contact
    start, tip = mating.tip_form_radius, mating.tip_radius
    inwards = 0.5 * mating.tooth_thickness_at(start) / start - tip_half_angle(mating)
    corners = {start: contact - axis, tip: tip * np.exp(1j * (np.angle(contact - axis) + sign * inwards))}
    fillet_radius, fillet_angle = gear.root_fillet(POINTS)
    rooms = []
    for corner in corners.values():
        to_centres = np.angle(-sign * corner)  # angle of the mating gear until the corner points to the gear's axis
        turn = np.linspace(0.0, -sign * to_centres * mating.tooth_count / gear.teeth, POINTS)
        place = (axis + corner * np.exp(1j * sign * turn * gear.teeth / mating.tooth_count)) * np.exp(1j * turn)
        radius, behind = np.abs(place), middle - np.angle(place)
        inside = (radius > fillet_radius[-1]) & (radius < fillet_radius[0])
        room = radius * (behind - np.interp(radius, fillet_radius[::-1], fillet_angle[::-1]))
        rooms += room[inside].tolist()
    return min(rooms, default=None)
