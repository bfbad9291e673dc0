r"""The bidirectional start: first values for the five contact equations, from the machine settings of both gears.

For gears whose settings name no reference point (duplex spread blade), the duplex paper guesses where the flanks touch.
Both cradles stand at the centre of roll, so that each flank is seen along its generating line only, by the azimuth
:math:`\vartheta` about the cutter; each gear turns by :math:`\varphi'` from where it stood on its machine, right-handed
about its axis from apex to heel. From one gear:

1. :math:`\vartheta` from a calculation point (X_L, R_L) on the pitch cone at mid-face. The line meets both its
   coordinates only by chance; here it is met in cone distance.
2. :math:`\varphi'` of this gear from the equation of meshing of the pair,
   :math:`f(\varphi') = n \cdot v_{12} = 0`. With the moment M of the normal about the axes,
   :math:`f = \omega_1 \cdot M_1 - \omega_2 \cdot M_2 = A\cos\varphi' + B\sin\varphi' + C`: solved in closed form.
3. :math:`\vartheta` and :math:`\varphi'` of the mating gear from opposite normals: the axial component of the normal
   tells :math:`\vartheta`, its azimuth :math:`\varphi'`.

Forward: from the wheel. Reverse: from the pinion. The start is their mean. Nothing in it makes the two points one: it
is a first guess, and whether it is good is up to the settings. The solver of this package needs none of it.

At the turn zero of the cradle the cutter touches the flank along a line. Each of its points is told by the azimuth
:math:`\vartheta` about the axis of the cutter, from the root line of the machine: at the height h above the blade tips

.. math:: P(\vartheta, h) = C + r(h)\,(e_1\cos\vartheta + e_2\sin\vartheta) - h\,a, \qquad
          F_\varphi(P(\vartheta, h), \varphi = 0) = 0

with C the centre of the cutter, a its axis and the equation of meshing of :mod:`loaded_tca.flanks.cradle`, which a
straight blade makes linear in h. A method that keeps the cradle at its centre walks along this line only.

References
----------
The duplex paper (docs/reference/sources.md); Litvin & Fuentes 2004, Gear Geometry and Applied Theory, sections 6.1,
9.4 and 21.3 (lines of contact of tool and blank).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import astuple, dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import ConvergenceError, GeometryError, InputError
from loaded_tca.flanks.cradle import ALPHA, RHO, CradleGeneration, Z
from loaded_tca.gears.face_milled import FaceMilledGear, FlankName
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain

MOST_STEPS = 30
RESOLVED = 1e-12
"""Part of the radial setting below which steps in height, and what is left of the equation of meshing, are rounding."""


@dataclass(frozen=True, eq=False)
class LinePoints:
    """Points of the line, in the frame of the gear as it stands on the machine: x along the root line, z its axis.

    Attributes
    ----------
    rho, azimuth, z : (n,) array [mm, rad, mm]
        Cylindrical coordinates.
    normal : (n, 3) array
        Unit normal out of the material.
    """

    rho: Array
    azimuth: Array
    z: Array
    normal: Array

    @property
    def point(self) -> Array:
        """Places (n, 3) [mm]."""
        return np.stack([self.rho * np.cos(self.azimuth), self.rho * np.sin(self.azimuth), self.z], axis=-1)

    @property
    def moment(self) -> Array:
        """Moment (n, 3) of the normal about the origin of the gear [mm]."""
        return np.cross(self.point, self.normal)


@checked
class GeneratingLine:
    """Line of contact of cutter and flank at the centre of roll.

    Parameters
    ----------
    gear : FaceMilledGear
        One that rolls.
    flank : {"concave", "convex"}

    Raises
    ------
    InputError
        If the gear is cut without rolling: the cutter then touches the whole flank at once.

    Examples
    --------
    >>> from loaded_tca.gears import BevelBlank
    >>> from loaded_tca.gears.basic_settings import spread_blade
    >>> blank = BevelBlank((20, 30), 5.0, 20.0, spiral_angle=0.6, cutter_radius=60.0)
    >>> points = GeneratingLine(spread_blade(blank)[1], "convex").at([5.25, 5.3])
    >>> np.hypot(points.rho, points.z).round(2)  # cone distances [mm]
    array([75.57, 78.07])
    """

    def __init__(self, gear: FaceMilledGear, flank: FlankName) -> None:
        machine = gear.machine
        if not machine.rolls:
            raise InputError(
                f"{gear.name}: generation: 'formate'; without rolling the cutter touches the flank all over"
            )
        self._generation, self._hand = CradleGeneration(gear.cutter.blade(flank), flank, machine), gear.mirror
        cosine, sine = np.cos(machine.cradle_angle), np.sin(machine.cradle_angle)
        self._centre = machine.radial * np.array([cosine, sine, 0.0])
        radial, across, along = self._generation.axis
        axis = np.array([radial * cosine - across * sine, radial * sine + across * cosine, along])
        # x and y are turned the shortest way with z, which becomes the cutter's axis
        tilt = (axis + np.array([0.0, 0.0, 1.0])) / (1.0 + along)
        self._axes = np.stack([[1.0, 0.0, 0.0] - tilt * axis[0], [0.0, 1.0, 0.0] - tilt * axis[1], axis])

    def at(self, angle: ArrayLike) -> LinePoints:
        """Points of the line at azimuths (n,) about the cutter, from 0 to 2 pi, seen on the gear's own hand [rad].

        Raises
        ------
        ConvergenceError
            If the equation of meshing is not solved at an azimuth.
        """
        angles = self._hand * np.atleast_1d(np.asarray(angle, dtype=float))
        height, reach = np.zeros_like(angles), self._generation.machine.radial
        for _ in range(MOST_STEPS):
            step, lack = self._step(angles, height)
            if max(np.abs(step).max(), np.abs(lack).max()) <= RESOLVED * reach:
                return self._points(angles, height)
            height = height + np.clip(step, -reach, reach)
        raise ConvergenceError(
            f"equation of meshing at the centre of roll: after {MOST_STEPS} steps the height still moves by "
            f"{plain(np.abs(step).max(), 3)} mm, with {plain(np.abs(lack).max(), 3)} mm/rad left",
            last=height,
        )

    def _step(self, angle: Array, height: Array) -> tuple[Array, Array]:
        """Newton step of the heights (n,) [mm], and what is left of the equation of meshing [mm/rad].

        Where the equation does not depend on the height, there is no step.
        """
        place, slope = self._on_blade(angle, height)
        rho, alpha, z = self._on_blank(place)
        along = slope @ self._blank_axes.T
        radial, turning = np.cos(alpha), np.sin(alpha)
        cut = self._generation.cut(rho, alpha, z, np.zeros_like(rho))
        slopes = cut.meshing_slopes
        change = slopes[RHO] * (along[:, 0] * radial + along[:, 1] * turning)
        change += slopes[ALPHA] * (along[:, 1] * radial - along[:, 0] * turning) / rho
        change += slopes[Z] * along[:, 2]
        return -cut.meshing / np.where(change == 0.0, np.inf, change), cut.meshing

    def _points(self, angle: Array, height: Array) -> LinePoints:
        rho, alpha, z = self._on_blank(self._on_blade(angle, height)[0])
        cut = self._generation.cut(rho, alpha, z, np.zeros_like(rho))
        cosine, sine = np.cos(alpha), np.sin(alpha)
        radial, turning = cut.slopes[RHO], cut.slopes[ALPHA] / rho
        gradient = np.stack(
            [radial * cosine - turning * sine, self._hand * (radial * sine + turning * cosine), cut.slopes[Z]], axis=-1
        )
        normal = -gradient / np.linalg.norm(gradient, axis=-1, keepdims=True)
        return LinePoints(rho, self._hand * alpha, z, normal)

    def _on_blade(self, angle: Array, height: Array) -> tuple[Array, Array]:
        """Places (n, 3) on the blade in the machine, and their derivatives by the height."""
        blade, sign = self._generation.blade, self._generation.sign
        widening, steepness, _ = blade.widening(height)
        outward = np.cos(angle)[:, None] * self._axes[0] + np.sin(angle)[:, None] * self._axes[1]
        radius = blade.point_radius + sign * widening
        place = self._centre + radius[:, None] * outward - height[:, None] * self._axes[2]
        return place, sign * steepness[:, None] * outward - self._axes[2]

    @property
    def _blank_axes(self) -> Array:
        """Axes of the blank in rows, in the machine: across its axis from the root line, upwards, along its axis."""
        gamma = self._generation.machine.root_angle
        return np.array([[np.sin(gamma), 0.0, -np.cos(gamma)], [0.0, 1.0, 0.0], [np.cos(gamma), 0.0, np.sin(gamma)]])

    def _on_blank(self, place: Array) -> tuple[Array, Array, Array]:
        """Cylindrical coordinates of places in the machine, in the frame of the right-hand blank."""
        machine = self._generation.machine
        origin = np.array([0.0, machine.blank_offset, machine.sliding_base])
        across, upwards, along = ((place - origin) @ self._blank_axes.T).T
        return np.hypot(across, upwards), np.arctan2(upwards, across), along - machine.machine_centre_to_back


REACH, SAMPLES = 0.5, 41
"""Azimuths about the cutter to either side of the mean point that are searched [rad], and at how many points."""
ROUNDING = 1e-14
"""Resolution of angles [rad]."""
GEAR_NAMES = ("pinion", "wheel")


@dataclass(frozen=True)
class StartValues:
    """First guess of the contact, as the source counts it.

    Attributes
    ----------
    wheel_azimuth, pinion_azimuth : float [rad]
        theta_g and theta_p, about the axes of the cutters, seen on each gear's own hand, 0 to 2 pi.
    wheel_turn, pinion_turn : float [rad]
        phi2' and phi1', from where each gear stood on its machine at the centre of roll.
    """

    wheel_azimuth: float
    pinion_azimuth: float
    wheel_turn: float
    pinion_turn: float

    def mean(self, other: StartValues) -> StartValues:
        """Arithmetic mean, value by value."""
        return StartValues(*np.mean([astuple(self), astuple(other)], axis=0).tolist())


@dataclass(frozen=True)
class Guess:
    """A start in the coordinates of the solvers.

    Attributes
    ----------
    pinion_angle : float [rad]
        phi1 at which the contact is to be sought.
    unknowns : (5,) array [mm, mm, mm, mm, rad]
        rho1, z1, rho2, z2, phi2: a row for :func:`~loaded_tca.baselines.conventional.solve_conventional`; the first two
        are a start of the reduced solver.
    distance : float [mm]
        Between the two points, which a contact has in common.
    """

    pinion_angle: float
    unknowns: Array
    distance: float


class BidirectionalStart:
    """Start values of a face-milled pair.

    Parameters
    ----------
    gears : (FaceMilledGear, FaceMilledGear)
        Pinion and wheel, both generated by rolling.
    pair : GearPair
        Of flanks of these two gears: says which flanks touch, and how the gears are mounted.

    Raises
    ------
    InputError
        If a gear does not roll on its machine.

    References
    ----------
    The duplex paper (docs/reference/sources.md).

    Examples
    --------
    >>> from loaded_tca.pairs.bevel import face_milled_pair
    >>> from loaded_tca.gears import BevelBlank
    >>> from loaded_tca.gears.basic_settings import duplex_spread_blade
    >>> blank = BevelBlank((20, 30), 5.0, 20.0, spiral_angle=0.6, cutter_radius=60.0, taper="duplex")
    >>> gears = duplex_spread_blade(blank, edge_radius=0.5)
    >>> start = BidirectionalStart(gears, face_milled_pair(*gears))
    >>> values = start.mean()
    >>> round(values.wheel_azimuth, 4), round(values.pinion_azimuth, 4)
    (5.3055, 0.9593)
    >>> start.guess(values).distance < 6.0
    True
    """

    def __init__(self, gears: tuple[FaceMilledGear, FaceMilledGear], pair: GearPair) -> None:
        self._pair, self._gears, self._flanks = pair, gears, (pair.pinion.flank, pair.wheel.flank)
        self._lines = [
            GeneratingLine(gear, gear.flank_name(flank.side)) for gear, flank in zip(gears, self._flanks, strict=True)
        ]
        self._origins = np.zeros(3), pair.wheel_origin
        self._axes = np.eye(3), pair.wheel_axes

    def forward(self, wheel_azimuth: float | None = None) -> StartValues:
        """From the wheel.

        Parameters
        ----------
        wheel_azimuth : float [rad], optional
            theta_g; default: of the calculation point (step 1).

        Raises
        ------
        GeometryError
            If a generating line does not reach the mean cone distance, the normal does not come into mesh, or the
            mating gear's generating line has no such normal; the message says by how much it is missed.
        """
        return self._from(1, wheel_azimuth)

    def reverse(self, pinion_azimuth: float | None = None) -> StartValues:
        """From the pinion; parameters and errors as those of :meth:`forward`."""
        return self._from(0, pinion_azimuth)

    def mean(self) -> StartValues:
        """The start of the source: mean of forward and reverse."""
        return self.forward().mean(self.reverse())

    def guess(self, values: StartValues) -> Guess:
        """Start values in the coordinates of the solvers."""
        azimuths, turns = (values.pinion_azimuth, values.wheel_azimuth), (values.pinion_turn, values.wheel_turn)
        places, angles, points = [], [], []
        for member, flank in enumerate(self._flanks):
            place = self._lines[member].at(azimuths[member])
            standing = place.azimuth[0] + turns[member]
            angles.append(_half_turn(standing - float(flank.theta(place.rho, place.z).value[0])))
            places += [place.rho[0], place.z[0]]
            own = np.array([place.rho[0] * math.cos(standing), place.rho[0] * math.sin(standing), place.z[0]])
            points.append(own @ self._axes[member] + self._origins[member])
        pinion_angle, wheel_angle = self._pair.sense * angles[0], -self._pair.sense * angles[1]
        return Guess(pinion_angle, np.array([*places, wheel_angle]), float(np.linalg.norm(points[0] - points[1])))

    def _from(self, member: int, azimuth: float | None) -> StartValues:
        line, mating_line = self._lines[member], self._lines[1 - member]

        def longer(angle: Array) -> Array:
            place = line.at(angle)
            return np.hypot(place.rho, place.z) - self._gears[member].blank.mean_cone_distance

        if azimuth is None:
            azimuth = self._root(member, longer, "cone distance {} mm off the mean one")
        place = line.at(azimuth)
        turn = self._meshing_turn(member, place.normal[0], place.moment[0])
        normal = -(_turned(place.normal[0], turn) @ self._axes[member]) @ self._axes[1 - member].T

        def steeper(angle: Array) -> Array:
            return mating_line.at(angle).normal[:, 2] - normal[2]

        mating = self._root(1 - member, steeper, "axial part of the normal {} off that of its mating gear")
        own = mating_line.at(mating).normal[0]
        mating_turn = _half_turn(math.atan2(normal[1], normal[0]) - math.atan2(own[1], own[0]))
        if member == 1:
            return StartValues(azimuth, mating, turn, mating_turn)
        return StartValues(mating, azimuth, mating_turn, turn)

    def _meshing_turn(self, member: int, normal: Array, moment: Array) -> float:
        """Turn (step 2) of a gear that brings a normal into mesh: the smallest root of n . v12 = 0."""
        mating, axes, origins = 1 - member, self._axes, self._origins
        speeds = 1.0, -self._pair.ratio
        apart = origins[member] - origins[mating]

        def sliding(turn: float) -> float:
            direction = _turned(normal, turn) @ axes[member]
            about_mating = _turned(moment, turn) @ axes[member] + np.cross(apart, direction)
            return float(speeds[member] * moment[2] - speeds[mating] * (axes[mating][2] @ about_mating))

        start, side, back = (sliding(turn) for turn in (0.0, 0.5 * math.pi, math.pi))
        middle = 0.5 * (start + back)
        cosine, sine = 0.5 * (start - back), side - middle
        size = math.hypot(cosine, sine)
        if abs(middle) > size:
            raise GeometryError(
                f"{GEAR_NAMES[member]}: its normal at the centre of roll never comes into mesh: n . v12 stays"
                f" {plain(abs(middle) - size)} mm per radian away from zero"
            )
        phase, spread = math.atan2(sine, cosine), math.acos(-middle / size)
        return min((_half_turn(phase + spread), _half_turn(phase - spread)), key=abs)

    def _root(self, member: int, excess: Callable[[Array], Array], missed: str) -> float:
        """Root of a function of the azimuth nearest to that of the mean point's foot on the root line."""
        gear = self._gears[member]
        machine, blank = gear.machine, gear.blank
        along = blank.mean_cone_distance * math.cos(blank.pitch_angle - blank.root_angle)
        ahead = along - machine.radial * math.cos(machine.cradle_angle)
        middle = gear.mirror * math.atan2(-machine.radial * math.sin(machine.cradle_angle), ahead) % (2.0 * math.pi)
        azimuths = np.linspace(middle - REACH, middle + REACH, SAMPLES)
        values = excess(azimuths)
        changes = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
        if not changes.size:
            least = plain(float(np.abs(values).min()))
            raise GeometryError(
                f"{GEAR_NAMES[member]}: no start on its generating line at the centre of roll: {missed.format(least)}"
            )
        first = changes[np.argmin(np.abs(changes + 0.5 - 0.5 * (SAMPLES - 1)))]
        root = scipy.optimize.brentq(
            lambda x: float(excess(np.array([x]))[0]), azimuths[first], azimuths[first + 1], xtol=ROUNDING
        )
        return float(root)


def _turned(vector: Array, angle: float) -> Array:
    """A vector (3,) turned about the third axis."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1], vector[2]])


def _half_turn(angle: float) -> float:
    """An angle brought to within half a turn of zero."""
    return math.remainder(angle, 2.0 * math.pi)
