"""From two flanks and the form of a tooth to its complete surface."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.tooth.fillet import ArcFillet, Fillet, FilletCurve
from loaded_tca.tooth.form import ToothForm
from loaded_tca.tooth.profile import Profile, profile_of
from loaded_tca.tooth.sections import Sections
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
        counts = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        problems = [
            f"{name}: {count} is not a whole number from 2 on"
            for name, count in counts.items()
            if not (isinstance(count, int | np.integer) and count >= 2)
        ]
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
    >>> from loaded_tca.tooth import tooth_forms
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> plus, minus = (cylindrical_pair(mesh, sense=sense).pinion for sense in ("positive", "negative"))
    >>> build_tooth((plus, minus), tooth_forms(mesh)[0])
    ToothSurface(106 x 33 points, one of 34 teeth)
    """
    if tuple(flank.side for flank in flanks) != (1, -1):
        raise InputError(f"flanks: their sides are {', '.join(str(flank.side) for flank in flanks)}, not 1, -1")
    counts = resolution.flank, resolution.lengthwise
    plus, minus = (profile_of(flank, form.sections, form.half_thickness_angle, counts) for flank in flanks)
    pitch = 2.0 * math.pi / form.teeth
    sides = _Sides(plus, minus, form.root_radius(plus.coordinate), pitch, resolution)
    halves = sides.with_fillet(_fitting(sides, form))
    _check_thickness(halves, plus.coordinate, resolution)
    return _assembled(sides, halves, form, resolution)


@dataclass(frozen=True, eq=False)
class _Half:
    """Outline (k, m) of one side from tip to root in the images: radius [mm], angle from the middle [rad]."""

    radius: Array
    angle: Array


@dataclass(frozen=True, eq=False)
class _Sides:
    """Both sides of a tooth before their fillets are known."""

    plus: Profile
    minus: Profile
    root: Array
    pitch: float
    resolution: Resolution

    def with_fillet(self, fillet: Fillet) -> tuple[_Half, _Half]:
        """Outlines of both sides, to the end of the fillet."""
        curves = [fillet.curve(side, self.root, self.resolution.fillet) for side in (self.plus, self.minus)]
        return _outline(self.plus, curves[0], self.root), _outline(self.minus, curves[1], self.root)

    def has_room(self, fillet: Fillet) -> bool:
        """Whether the fillets of a space leave each other room."""
        try:
            ends = [half.angle[-1] for half in self.with_fillet(fillet)]
            return bool((self.pitch - ends[0] - ends[1] >= -OVERLAP * self.pitch).all())
        except GeometryError:
            return False


def _outline(profile: Profile, curve: FilletCurve, root: Array) -> _Half:
    """Flank from the tip down to where the fillet starts, then the fillet."""
    low, high = profile.radius[0], profile.radius[-1]
    flank = high - (high - profile.radius[::-1]) * (high - curve.start) / (high - low)
    flank[-1] = curve.start
    angle, _ = profile.angle(flank)
    fillet = np.hypot(curve.points[..., 0], curve.points[..., 1])
    fillet[-1] = root
    azimuth = np.arctan2(curve.points[..., 1], curve.points[..., 0])
    turn = np.remainder(azimuth - angle[-1] + math.pi, 2.0 * math.pi) - math.pi
    return _Half(np.concatenate([flank, fillet[1:]]), np.concatenate([angle, (angle[-1] + turn)[1:]]))


def _fitting(sides: _Sides, form: ToothForm) -> Fillet:
    """The fillet of the form, or the largest arc that fits where that is allowed."""
    fillet = form.fillet
    if sides.has_room(fillet):
        return fillet
    if not isinstance(fillet, ArcFillet):
        raise GeometryError("the fillets of neighbouring teeth pass each other: no space is left at the root")
    small, large = 0.0, fillet.radius
    for _ in range(HALVINGS):
        middle = 0.5 * (small + large)
        fits = sides.has_room(replace(fillet, radius=middle))
        small, large = (middle, large) if fits else (small, middle)
    if small == 0.0:
        sides.with_fillet(replace(fillet, radius=large))
        raise GeometryError("no fillet fits between neighbouring teeth: no space is left at the root")
    if not form.largest_that_fits:
        raise InputError(
            f"fillet_radius: {fillet.radius:.6g} mm does not fit into the space between two teeth; the largest that "
            f"does is {small:.4g} mm"
        )
    return replace(fillet, radius=small)


def _check_thickness(halves: tuple[_Half, _Half], coordinate: Array, resolution: Resolution) -> None:
    """Refuse a tooth that has no thickness somewhere."""
    thickness = halves[0].angle + halves[1].angle
    place, section = np.unravel_index(int(thickness.argmin()), thickness.shape)
    if thickness[place, section] > 0.0:
        return
    where = f"in the section at {coordinate[section]:.6g} mm"
    if place < resolution.flank:
        raise GeometryError(f"pointed tooth: its two flanks meet below the tip, {where}")
    raise GeometryError(f"the undercut of both sides cuts off the tooth, {where}")


def _assembled(sides: _Sides, halves: tuple[_Half, _Half], form: ToothForm, resolution: Resolution) -> ToothSurface:
    """The outline from space to space in the gear's frame."""
    plus, minus = halves
    coordinate, land = sides.plus.coordinate, resolution.land
    right = 0.5 * (sides.pitch + plus.angle[-1] - minus.angle[-1])
    left = right - sides.pitch
    root = np.broadcast_to(sides.root, (land, len(coordinate)))
    tip = np.broadcast_to(plus.radius[0], (land, len(coordinate)))
    azimuths = [
        np.linspace(left, -minus.angle[-1], land),
        -minus.angle[::-1],
        np.linspace(-minus.angle[0], plus.angle[0], land),
        plus.angle,
        np.linspace(plus.angle[-1], right, land),
    ]
    radii = [root, minus.radius[::-1], tip, plus.radius, root]
    first = slice(1, None)
    theta, radius = (np.concatenate([rows[0], *(row[first] for row in rows[1:])]) for rows in (azimuths, radii))
    # below the root, where the rim of a closed tooth ends, never beyond the axis
    foot = np.maximum(sides.root - RIM * (sides.plus.radius[-1] - sides.root), 0.5 * sides.root)
    foot = np.broadcast_to(foot, (2, len(coordinate)))
    steps = [land, resolution.fillet, resolution.flank]
    lengths = [*steps, land, *steps[::-1]]
    joints = (0, *(int(joint) for joint in np.cumsum([length - 1 for length in lengths])))
    return ToothSurface(
        _in_space(form.sections, radius, theta, coordinate),
        _in_space(form.sections, foot, np.stack([left, right]), coordinate),
        joints,
        form.teeth,
        form.half_thickness_angle,
    )


def _in_space(sections: Sections, radius: Array, theta: Array, coordinate: Array) -> Array:
    """Points (..., 3) in the gear's frame from polar coordinates in the images."""
    rho, z = sections.point(radius, coordinate)
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=-1)
