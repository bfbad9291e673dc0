"""From two flanks and the form of a tooth to its complete surface."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array, count_problems
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import RoundedFlank, sharp
from loaded_tca.tooth.families import ToothForm
from loaded_tca.tooth.fillet import ArcFillet, Fillet, FilletCurve, Profile, in_space, profile_of
from loaded_tca.tooth.surface import ToothSurface

OVERLAP = 1e-3
"""Part of a pitch by which fillets may pass each other: modifications turn those of a full rounding by microns."""
HALVINGS = 20
"""Steps that look for the largest arc that fits: to a millionth of the one that was asked for."""
RIM = 0.5
"""Thickness of the rim below a closed tooth, over the height of the tooth."""


@dataclass(frozen=True)
class Resolution:
    """Points along the parts of a tooth.

    Parameters
    ----------
    flank, fillet, land : int
        Along the profile of each flank, fillet and land.
    lengthwise : int
        Across the face.

    Raises
    ------
    InputError
        If a number is not a whole one from 2 on.
    """

    flank: int = 33
    fillet: int = 17
    land: int = 4
    lengthwise: int = 33

    def __post_init__(self) -> None:
        problems = count_problems(vars(self), 2)
        if problems:
            raise InputError(problems)


def build_tooth(flanks: tuple[Flank, Flank], form: ToothForm, resolution: Resolution = Resolution()) -> ToothSurface:
    """Complete tooth between two flanks; the middle of the tooth at mid-face stands at the azimuth 0.

    Parameters
    ----------
    flanks : (Flank, Flank)
        Of the sides s = +1 and s = -1, each in its own frame, where Theta = 0 at the pitch point of mid-face.
    form : ToothForm
    resolution : Resolution

    Raises
    ------
    InputError
        If the flanks are not of the two sides of a tooth, or a fillet radius does not fit.
    GeometryError
        If the tooth is pointed or cut off by its undercut, or there is no space between the teeth.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pinion = cylindrical_pair(mesh).pinion
    >>> build_tooth(pinion.flanks, pinion.form)
    ToothSurface(106 x 33 points, one of 34 teeth)
    """
    if tuple(flank.side for flank in flanks) != (1, -1):
        raise InputError(f"flanks: their sides are {', '.join(str(flank.side) for flank in flanks)}, not 1, -1")
    counts = resolution.flank, resolution.lengthwise
    sides = [profile_of(flank, form.sections, form.half_thickness_angle, counts) for flank in flanks]
    coordinate, land = sides[0].coordinate, resolution.land
    space = _Space(sides, form.root_radius(coordinate), 2.0 * math.pi / form.teeth, resolution.fillet)
    (plus_radius, plus), (minus_radius, minus) = space.halves(_fitting(space, form))
    if any(isinstance(flank, RoundedFlank) for flank in flanks):
        build_tooth((sharp(flanks[0]), sharp(flanks[1])), form, resolution)  # what cannot exist with sharp edges
        lacking = np.maximum(-0.5 * (plus + minus)[: resolution.flank], 0.0)
        plus[: resolution.flank] += lacking  # in its corners a tooth is thinner than the arcs of all edges need
        minus[: resolution.flank] += lacking
    else:
        _check_thickness(plus + minus, coordinate, resolution)
    right = 0.5 * (space.pitch + plus[-1] - minus[-1])
    left = right - space.pitch
    root, tip = (np.broadcast_to(radius, (land, len(coordinate))) for radius in (space.root, plus_radius[0]))
    azimuths = [
        np.linspace(left, -minus[-1], land),
        -minus[::-1],
        np.linspace(-minus[0], plus[0], land),
        plus,
        np.linspace(plus[-1], right, land),
    ]
    radii = [root, minus_radius[::-1], tip, plus_radius, root]
    theta, radius = (np.concatenate([rows[0], *(row[1:] for row in rows[1:])]) for rows in (azimuths, radii))
    height = sides[0].radius[-1] - space.root
    foot = np.tile(np.maximum(space.root - RIM * height, 0.5 * space.root), (2, 1))  # never beyond the axis
    steps = [land, resolution.fillet, resolution.flank]
    return ToothSurface(
        in_space(form.sections, radius, theta, coordinate),
        in_space(form.sections, foot, np.stack([left, right]), coordinate),
        tuple(np.cumsum([0, *(count - 1 for count in (*steps, land, *steps[::-1]))]).tolist()),
        form.teeth,
        form.half_thickness_angle,
    )


@dataclass(frozen=True, eq=False)
class _Space:
    """The space between two teeth before its fillets are known: its sides, root circles, pitch, points of a fillet."""

    sides: Sequence[Profile]
    root: Array
    pitch: float
    points: int

    def halves(self, fillet: Fillet) -> list[tuple[Array, Array]]:
        """Radius [mm] and angle from the middle [rad] (k, m) of both sides of a tooth, from the tip to the root."""
        return [_outline(side, fillet.curve(side, self.root, self.points), self.root) for side in self.sides]

    def has_room(self, fillet: Fillet) -> bool:
        """Whether the fillets of a space leave each other room."""
        try:
            (_, plus), (_, minus) = self.halves(fillet)
        except GeometryError:
            return False
        return bool((self.pitch - plus[-1] - minus[-1] >= -OVERLAP * self.pitch).all())


def _outline(profile: Profile, curve: FilletCurve, root: Array) -> tuple[Array, Array]:
    """Flank from the tip down to where the fillet starts, then the fillet."""
    low, high = profile.radius[0], profile.radius[-1]
    flank = high - (high - profile.radius[::-1]) * (high - curve.start) / (high - low)
    flank[-1] = curve.start
    angle, _ = profile.angle(flank)
    fillet = np.hypot(curve.points[..., 0], curve.points[..., 1])
    fillet[-1] = root
    azimuth = np.arctan2(curve.points[..., 1], curve.points[..., 0])
    turn = np.remainder(azimuth - angle[-1] + math.pi, 2.0 * math.pi) - math.pi
    return np.concatenate([flank, fillet[1:]]), np.concatenate([angle, (angle[-1] + turn)[1:]])


def _fitting(space: _Space, form: ToothForm) -> Fillet:
    """The fillet of the form, or the largest arc that fits where that is allowed."""
    fillet = form.fillet
    if space.has_room(fillet):
        return fillet
    if not isinstance(fillet, ArcFillet):
        raise GeometryError("the fillets of neighbouring teeth pass each other: no space is left at the root")
    small, large = 0.0, fillet.radius
    for _ in range(HALVINGS):
        middle = 0.5 * (small + large)
        fits = space.has_room(replace(fillet, radius=middle))
        small, large = (middle, large) if fits else (small, middle)
    if small == 0.0:
        space.halves(replace(fillet, radius=large))
        raise GeometryError("no fillet fits between neighbouring teeth: no space is left at the root")
    if not form.largest_that_fits:
        raise InputError(
            f"fillet_radius: {fillet.radius:.6g} mm does not fit into the space between two teeth; the largest that "
            f"does is {small:.4g} mm"
        )
    return replace(fillet, radius=small)


def _check_thickness(thickness: Array, coordinate: Array, resolution: Resolution) -> None:
    """Refuse a tooth that has no thickness (k, m) somewhere."""
    place, section = np.unravel_index(int(thickness.argmin()), thickness.shape)
    if thickness[place, section] > 0.0:
        return
    where = f"in the section at {coordinate[section]:.6g} mm"
    if place < resolution.flank:
        raise GeometryError(f"pointed tooth: its two flanks meet below the tip, {where}")
    raise GeometryError(f"the undercut of both sides cuts off the tooth, {where}")
