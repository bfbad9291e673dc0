r"""Machine settings of a generated pinion by local synthesis: what the contact at the mean point is to be.

The wheel is given. The settings of the pinion are those next to the ones given (the basic ones of
:mod:`loaded_tca.gears.basic_settings`) at which

- the flank asked for has, at the mean point, the slopes and bends of
  :meth:`~loaded_tca.pairs.mean_point.MeanField.flank_for`: it touches the wheel there, with the second derivative of
  the motion curve, the direction of the path and the length of the contact ellipse asked for (five equations);
- the other flank, cut in the same pass (completing), touches its mating flank at the mean point (two equations), or
  has what is asked of it as well (five);
- the centre of roll cuts the mean point, the blades reach as deep as before and the tooth is as thick as asked for.

Ten settings do the first: radial setting, cradle angle, machine centre to back, sliding base, blank offset, ratio of
roll, and point radius and angle of both blades. Where both flanks have demands, or the ten find nothing, root angle,
tilt, swivel, modified roll 2C and helical motion join them, and the root line keeps its slope; of all solutions
Newton's method takes the one nearest to the start. All is in mm and rad, signs are those of
:mod:`loaded_tca.gears.face_milled`.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, section 21.5; Litvin & Zhang 1991, Local synthesis and tooth
contact analysis of face-milled spiral bevel gears, NASA CR 4342. Unknowns there are found one after the other in closed
form; here they are the roots of the equations of generation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.face_milled import tooth_angle as tooth_angle_of
from loaded_tca.gears.face_milled import FaceMilledGear, FlankName
from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.pairs.mean_point import (
    OTHER_FLANK,
    LocalFlank,
    MeanContact,
    MeanField,
    generated_at,
    local_flank,
    mean_point,
)

SCALES = {
    "radial": 1.0,
    "cradle_angle": 0.02,
    "machine_centre_to_back": 1.0,
    "sliding_base": 1.0,
    "blank_offset": 1.0,
    "ratio_of_roll": 0.05,
    "root_angle": 0.02,
    "tilt_along": 0.05,
    "tilt_across": 0.05,
    "modified_roll_2c": 0.05,
    "helical_motion": 3.0,
    "concave.point_radius": 3.0,
    "convex.point_radius": 3.0,
    "concave.blade_angle": 0.05,
    "convex.blade_angle": 0.05,
}
"""Settings that may change, with the steps that weigh alike [mm], [rad]; lengths are for a mean cone distance of 80 mm.
"""
FOR_BOTH = "root_angle", "tilt_along", "tilt_across", "modified_roll_2c", "helical_motion"
"""Those that change only where the others cannot do it."""
LENGTHS = "radial", "machine_centre_to_back", "sliding_base", "blank_offset", "helical_motion", "point_radius"
USUAL_DISTANCE = 80.0
MOST_STEPS, HALVINGS, MOST_TRIALS = 15, 6, 200
"""Of Newton's method, and calls of the search by least squares."""
FAR, NEAR = 1e3, 1e-8
"""What is left where nothing is cut; relative change that ends the search by least squares, whose end is a start."""
RESOLVED = 1e-11
"""Residuals (scaled to the mean cone distance) that end the iteration, far below what machines are set to."""
DIFFERENCE = 1e-5
SINGULAR = 1e-10
"""Step of the differences, and the part of the largest singular value below which a direction is left alone."""


def local_synthesis(
    pinion: FaceMilledGear,
    wheel: FaceMilledGear,
    aim: MeanContact,
    *,
    pinion_flank: FlankName = "concave",
    other_aim: MeanContact | None = None,
    tooth_angle: float | None = None,
    place: tuple[Array, Array] | None = None,
) -> FaceMilledGear:
    """Return the pinion with the settings at which it touches the wheel as asked for.

    Parameters
    ----------
    pinion : FaceMilledGear
        Settings to start from; generated, with both blades.
    wheel : FaceMilledGear
        It stays as it is.
    aim : MeanContact
        Of ``pinion_flank``.
    pinion_flank : {"concave", "convex"}
        The drive side.
    other_aim : MeanContact, optional
        Of the other flank, cut with the same settings; None: it touches at the mean point, and that is all.
    tooth_angle : float [rad], optional
        Of the pinion's tooth at the mean point; None: that of the settings to start from.
    place : (3,) and (3, 3) array, optional
        Origin and axes, in rows, of the wheel frame in the frame of the pinion; None: apexes that meet under the sum
        of the pitch angles.

    Raises
    ------
    InputError
        If the pinion is not generated or lacks a blade.
    GeometryError
        If no flank of the pinion touches so, or no settings for it are found.

    Examples
    --------
    >>> from math import degrees, radians
    >>> from loaded_tca.gears import BevelBlank, duplex_spread_blade
    >>> blank = BevelBlank((20, 30), 5.0, 22.0, spiral_angle=radians(35), cutter_radius=80.0, taper="duplex")
    >>> start, wheel = duplex_spread_blade(blank)
    >>> aim = MeanContact(motion_fall=radians(10 / 3600), path_angle=radians(110), contact_length=9.0)
    >>> pinion = local_synthesis(start, wheel, aim)
    >>> reached = mean_contact(pinion, wheel, "concave")
    >>> round(degrees(reached.path_angle), 6), round(reached.contact_length, 6)
    (110.0, 9.0)
    """
    if not pinion.machine.rolls or pinion.cutter.concave is None or pinion.cutter.convex is None:
        raise InputError("pinion: local synthesis needs a generated gear whose cutter has both blades")
    asked = _Asked.of(pinion, wheel, (aim, other_aim), pinion_flank, tooth_angle, place)
    few = tuple(name for name in SCALES if name not in FOR_BOTH)
    settings = _solve(pinion, asked, few) if other_aim is None else None
    settings = settings or _solve(pinion, asked, tuple(SCALES))
    if settings is None:
        raise GeometryError(
            "pinion: no machine settings are found that give the contact asked for; ask for less (a path_angle nearer"
            " to that of the settings to start from, another contact_length or motion_fall), or take a cutter radius"
            " nearer to the mean cone distance"
        )
    return settings


def mean_contact(
    pinion: FaceMilledGear, wheel: FaceMilledGear, pinion_flank: FlankName, place: tuple[Array, Array] | None = None
) -> MeanContact:
    """How a flank of the pinion touches its mating flank at the mean point.

    Normals that differ there (see :func:`mean_tilt`) are taken as one: the contact lies beside the mean point then.

    Raises
    ------
    GeometryError
        If the flanks cut into each other there, or the wheel runs ahead.
    """
    field, local = _at_mean_point(pinion, wheel, pinion_flank, place)
    return field.contact(local, pinion.teeth)


def mean_tilt(
    pinion: FaceMilledGear, wheel: FaceMilledGear, pinion_flank: FlankName, place: tuple[Array, Array] | None = None
) -> float:
    """Angle between the normals of both flanks at the mean point, which are one where they touch there [rad]."""
    field, local = _at_mean_point(pinion, wheel, pinion_flank, place)
    return field.tilt(local)


def _at_mean_point(
    pinion: FaceMilledGear, wheel: FaceMilledGear, flank: FlankName, place: tuple[Array, Array] | None
) -> tuple[MeanField, LocalFlank]:
    field = MeanField.of(pinion, wheel, flank, place or _meeting(pinion, wheel))
    rho, z = (np.array([part]) for part in mean_point(pinion))
    return field, local_flank(pinion, generated_at(pinion, flank, rho, z))


def with_tooth_angle(gear: FaceMilledGear, angle: float) -> FaceMilledGear:
    """Return a gear cut by blades so far apart that its tooth has an angle at the mean point [rad].

    Parameters
    ----------
    gear : FaceMilledGear
        With both blades; their mean radius stays.
    angle : float [rad]

    Raises
    ------
    GeometryError
        If the cutter does not cut the mean point.
    """
    (rho, z), cutter = mean_point(gear), gear.cutter
    assert cutter.concave is not None
    assert cutter.convex is not None
    concave, convex = cutter.concave, cutter.convex

    def wider(by: float) -> FaceMilledGear:
        outside = replace(concave, point_radius=concave.point_radius + 0.5 * by)
        inside = replace(convex, point_radius=convex.point_radius - 0.5 * by)
        return replace(gear, cutter=replace(cutter, concave=outside, convex=inside))

    def miss(by: float) -> float:
        return float(tooth_angle_of(wider(by), np.array([rho]), np.array([z]))[0]) - angle

    try:
        from scipy.optimize import newton  # not of every scene

        return wider(float(newton(miss, 0.0, x1=1e-3 * rho, tol=1e-12 * rho)))
    except (RuntimeError, InputError):
        raise GeometryError(f"{gear.name}: no point width leaves a tooth as thick as asked for") from None


def _meeting(pinion: FaceMilledGear, wheel: FaceMilledGear) -> tuple[Array, Array]:
    return BevelMounting().place(pinion.blank.pitch_angle + wheel.blank.pitch_angle)


@dataclass(frozen=True, eq=False)
class _Asked:
    """What the settings of the pinion are to fulfil.

    Attributes
    ----------
    flanks : dict
        Flank of the pinion -> how it is at the mean point; without ``bends`` where those are free.
    rho, z : (3,) array [mm]
        Points of the pitch cone at mid-face, toe and heel.
    heights : (2,) array [mm]
        Of the blades at mid-face, and how much higher at the heel than at the toe; means of both flanks.
    tooth_angle : float [rad]
    """

    flanks: dict[FlankName, tuple[LocalFlank, bool]]
    drive: FlankName
    rho: Array
    z: Array
    heights: Array
    tooth_angle: float

    @classmethod
    def of(
        cls,
        pinion: FaceMilledGear,
        wheel: FaceMilledGear,
        aims: tuple[MeanContact, MeanContact | None],
        drive: FlankName,
        tooth_angle: float | None,
        place: tuple[Array, Array] | None,
    ) -> _Asked:
        flanks: dict[FlankName, tuple[LocalFlank, bool]] = {}
        for flank, aim in zip((drive, OTHER_FLANK[drive]), aims, strict=True):
            field = MeanField.of(pinion, wheel, flank, place or _meeting(pinion, wheel))
            local = LocalFlank(field.slopes, np.zeros(3)) if aim is None else field.flank_for(aim, pinion.teeth)
            flanks[flank] = local, aim is not None
        blank = pinion.blank
        distances = np.array([blank.mean_cone_distance, *blank.cone_distances])
        rho, z = distances * math.sin(blank.pitch_angle), distances * math.cos(blank.pitch_angle)
        start = cls(flanks, drive, rho, z, np.zeros(2), 0.0)
        heights, angle = start._measures(pinion)[1:]
        return replace(start, heights=heights, tooth_angle=angle if tooth_angle is None else tooth_angle)

    def _measures(self, pinion: FaceMilledGear) -> tuple[dict[FlankName, tuple[LocalFlank, float]], Array, float]:
        """Local flanks with the turns of the cradle that cut them, heights of the blades, angle of the tooth."""
        cuts = {flank: generated_at(pinion, flank, self.rho, self.z) for flank in self.flanks}
        if not all(cut.found.all() for cut in cuts.values()):
            raise _NotCutError
        height = 0.5 * (cuts["concave"].height + cuts["convex"].height)
        slot = float(cuts["convex"].theta.value[0] - cuts["concave"].theta.value[0])
        of_flanks = {flank: (local_flank(pinion, cut), float(cut.cradle[0])) for flank, cut in cuts.items()}
        return of_flanks, np.array([height[0], height[2] - height[1]]), 2.0 * math.pi / pinion.teeth - slot

    def misses(self, pinion: FaceMilledGear, root_line: bool) -> Array:
        """What is left of every equation, over lengths of the size of the mean point's radius."""
        flanks, heights, angle = self._measures(pinion)
        size, rows = float(self.rho[0]), []
        for flank, (wanted, has_bends) in self.flanks.items():
            there = flanks[flank][0]
            rows.append((there.slopes - wanted.slopes) * size)
            if has_bends:
                rows.append((there.bends - wanted.bends) * size**2)
        lengths = (heights - self.heights) / size
        rows.append(np.array([flanks[self.drive][1], lengths[0], angle - self.tooth_angle]))
        if root_line:
            rows.append(lengths[1:])
        return np.concatenate(rows)


class _NotCutError(Exception):
    """Settings that do not cut the mean point, toe or heel."""


class _Equations:
    """What is left of the equations over changes of some settings, each in its scale."""

    def __init__(self, pinion: FaceMilledGear, asked: _Asked, names: tuple[str, ...]) -> None:
        size = pinion.blank.mean_cone_distance / USUAL_DISTANCE
        scales = [SCALES[name] * (size if name.rpartition(".")[2] in LENGTHS else 1.0) for name in names]
        self.pinion, self.asked, self.names, self.scales = pinion, asked, names, np.array(scales)
        self.count = asked.misses(pinion, self._root_line).size

    @property
    def _root_line(self) -> bool:
        return "root_angle" in self.names

    def gear(self, changes: Array) -> FaceMilledGear:
        """The pinion with its settings changed."""
        return _changed(self.pinion, dict(zip(self.names, (changes * self.scales).tolist(), strict=True)))

    def misses(self, changes: Array) -> Array:
        """What is left; FAR everywhere where the mean point is not cut, or a blade stands beyond its range."""
        try:
            return self.asked.misses(self.gear(changes), self._root_line)
        except (_NotCutError, InputError):
            return np.full(self.count, FAR)

    def slopes(self, changes: Array) -> Array:
        """Differences of what is left by every change."""
        steps = DIFFERENCE * np.eye(len(self.names))
        both = [self.misses(changes + step) - self.misses(changes - step) for step in steps]
        return np.stack(both, axis=1) / (2.0 * DIFFERENCE)


def _solve(pinion: FaceMilledGear, asked: _Asked, names: tuple[str, ...]) -> FaceMilledGear | None:
    """Newton's method to the nearest solution, and where it leads nowhere least squares, of more reach."""
    equations = _Equations(pinion, asked, names)
    start = np.zeros(len(names))
    solution = _newton(equations, start, nearest=True)
    if solution is None and len(names) == len(SCALES):
        from scipy.optimize import least_squares

        reached = least_squares(equations.misses, start, xtol=NEAR, ftol=NEAR, gtol=NEAR, max_nfev=MOST_TRIALS)
        solution = _newton(equations, reached.x, nearest=False)
    return None if solution is None else equations.gear(solution)


def _newton(equations: _Equations, changes: Array, *, nearest: bool) -> Array | None:
    """Root of the equations by steps that are halved while they lead away.

    Of several solutions of the linear equations it takes the one ``nearest`` to no change at all, or to where it is.
    """
    left = equations.misses(changes)
    for _ in range(MOST_STEPS):
        if _size(left) <= RESOLVED:
            return changes
        slopes = equations.slopes(changes)
        kept = changes if nearest else 0.0 * changes
        step = np.linalg.lstsq(slopes, slopes @ kept - left, rcond=SINGULAR)[0] - kept
        trials = ((changes + 0.5**halving * step) for halving in range(HALVINGS))
        better = next(((trial, new) for trial in trials if _size(new := equations.misses(trial)) < _size(left)), None)
        if better is None:
            return None
        changes, left = better
    return None


def _size(misses: Array) -> float:
    return float(np.linalg.norm(misses))


def _changed(pinion: FaceMilledGear, changes: dict[str, float]) -> FaceMilledGear:
    """The gear with settings changed by so much; tilt and swivel by the parts of the tilt."""
    machine, cutter = pinion.machine, pinion.cutter
    along = machine.tilt * math.cos(machine.swivel) + changes.get("tilt_along", 0.0)
    across = machine.tilt * math.sin(machine.swivel) + changes.get("tilt_across", 0.0)
    values = {name: getattr(machine, name) + change for name, change in changes.items() if hasattr(machine, name)}
    if "tilt_along" in changes:
        values |= {"tilt": math.hypot(along, across), "swivel": math.atan2(across, along)}
    blades = {}
    for flank in OTHER_FLANK:
        blade = cutter.concave if flank == "concave" else cutter.convex
        assert blade is not None  # looked at before
        blades[flank] = replace(
            blade,
            point_radius=blade.point_radius + changes[f"{flank}.point_radius"],
            blade_angle=blade.blade_angle + changes[f"{flank}.blade_angle"],
        )
    cut = replace(cutter, concave=blades["concave"], convex=blades["convex"])
    return replace(pinion, machine=replace(machine, **values), cutter=cut)
