r"""Rolling bearings by their inner geometry: forces of all elements by the motion of the inner ring, and their tangent.

The outer ring stands, the inner one moves with the shaft by x, y, z and about x and y. Element j, the first of them on
the gear's x axis, is pressed together by

.. math:: \delta_j = \sqrt{a_r^2 + a_z^2} - A, \quad
          a_r = A \cos\alpha - s/2 + \delta_r, \quad
          a_z = \pm A \sin\alpha + \delta_z + R_i (r_x \sin\varphi - r_y \cos\varphi)

where it is a ball between grooves whose centres are A apart; slice k of a roller, at the place p on its raceway with
the normal n, by

.. math:: \delta_{jk} = n \cdot (u + r \times p) - \tfrac{s}{2} \cos\alpha - 2 P(x_k).

Elements that are apart carry nothing, others :math:`c \delta^{3/2}` and :math:`c_s \delta^{10/9}`. Force and tangent
are first and second derivatives of one potential, :math:`\sum c \delta^{e+1} / (e+1)`: the tangent is symmetric.

References
----------
ISO/TS 16281:2008, equations 9-12 (balls) and 36-44 (rollers, their profiles); ISO/TS 16281 has no axial forces in
tapered rollers: these follow from the normal of the raceway.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.reference.hertz import line_contact, point_contact
from loaded_tca.supports.bearing import Reaction
from loaded_tca.supports.bearing_life import ball_life, ball_rating, roller_life, roller_rating

YOUNGS_MODULUS, POISSON_RATIO = 210000.0, 0.3
"""Of the steel of balls and their rings [MPa]; what rollers give way is in the constant of the standard."""
CONTACT_MODULUS = YOUNGS_MODULUS / (2.0 * (1.0 - POISSON_RATIO**2))
OF_BALLS, OF_ROLLERS = 1.5, 10.0 / 9.0
"""Exponents of the force over the deflection."""
OF_LENGTH = 35948.0
"""Force of a steel roller of 1 mm under a deflection of 1 mm [N]."""
SLICES = 30
"""Of a roller; ISO/TS 16281 asks for 30 at least."""
USUAL_DEFLECTION = 0.01
"""At which the stiffness of a joint stands for that of a bearing [mm]."""
STEEPEST = math.radians(45.0)
"""Contact angle up to which bearings are radial ones in ISO 281."""


@dataclass(frozen=True, eq=False, kw_only=True)
class RollingBearing(ABC):
    """A row of rolling elements between two rings.

    Parameters
    ----------
    at : float [mm]
        Its place on the axis.
    elements : int
    diameter, pitch_diameter : float [mm]
        Of an element, and of the circle of their middles.
    contact_angle : float [rad]
        Between the line of contact and the radial plane.
    side : int
        +1 if it takes a thrust of the shaft along z, -1 against z; without a contact angle of no account to clearances.
    clearance : float [mm]
        Radial one of the mounted bearing; negative: pressed together radially.
    preload : float [mm]
        By how much its rings are set against each other along the axis, in the sense of ``side``.
    rating : float, optional [N]
        Basic dynamic radial load rating; default: that of its geometry after ISO 281.

    Raises
    ------
    InputError
        If the elements do not fit between the rings.
    """

    at: float
    elements: int
    diameter: float
    pitch_diameter: float
    contact_angle: float = 0.0
    side: int = 1
    clearance: float = 0.0
    preload: float = 0.0
    rating: float | None = None

    def __post_init__(self) -> None:
        require(
            (self.elements >= 3, f"elements: found {self.elements}; allowed 3 and more"),
            (
                0.0 <= self.contact_angle <= STEEPEST,
                f"contact_angle: found {plain(math.degrees(self.contact_angle), 6)} deg; allowed from 0 to 45",
            ),
            (
                self.diameter < self.pitch_diameter * math.sin(math.pi / self.elements),
                f"diameter: {self.elements} elements of {plain(self.diameter, 6)} mm touch each other on a pitch "
                f"diameter of {plain(self.pitch_diameter, 6)} mm; allowed below "
                f"{plain(self.pitch_diameter * math.sin(math.pi / self.elements))} mm",
            ),
        )

    @cached_property
    def angles(self) -> Array:
        """Places of the elements around the ring (n,) [rad], from the gear's x axis on towards y."""
        return 2.0 * math.pi / self.elements * np.arange(self.elements, dtype=float)

    @property
    def gamma(self) -> float:
        """Diameter of an element over the pitch diameter, in the radial plane."""
        return self.diameter * math.cos(self.contact_angle) / self.pitch_diameter

    @property
    def takes(self) -> tuple[int, ...]:
        """Senses along z of the thrusts that it takes."""
        return (self.side,)

    @property
    def joint(self) -> Array:
        """Stiffness (6, 6) [N/mm] of a joint in its place: what it holds, whatever its load and clearance."""
        stiff = 0.5 * self.elements * self._stiffness(USUAL_DEFLECTION)
        return np.diag([stiff, stiff, stiff if self.takes else 0.0, 0.0, 0.0, 0.0])

    @property
    @abstractmethod
    def dynamic_rating(self) -> float:
        """Basic dynamic radial load rating C [N], given or after ISO 281."""

    @abstractmethod
    def _stiffness(self, deflection: float) -> float:
        """Tangent stiffness of an element at a deflection [N/mm]."""

    @abstractmethod
    def reaction(self, motion: Array) -> Reaction:
        """What it does against a motion (6,) of its inner ring [mm, rad]."""

    @abstractmethod
    def element_forces(self, motion: Array) -> Array:
        """Forces (n,) [N] of all elements under a motion (6,)."""

    @abstractmethod
    def largest_pressure(self, motion: Array) -> float:
        """Largest contact pressure [MPa] under a motion (6,), at the inner ring."""

    @abstractmethod
    def life(self, motion: Array) -> float:
        """Basic reference rating life [million revolutions] under a motion (6,); inf without load."""


@checked
@dataclass(frozen=True, eq=False, kw_only=True)
class BallBearing(RollingBearing):
    """A row of balls: deep groove without a contact angle, angular contact with one.

    Parameters
    ----------
    inner_groove, outer_groove : float
        Radii of the grooves over the diameter of a ball.

    Examples
    --------
    Under a radial load of 1 kN a commercial program finds 15.110 um for this one:

    >>> bearing = BallBearing(at=0.0, elements=7, diameter=11.5, pitch_diameter=43.5)
    >>> round(float(bearing.reaction(np.array([0.01511, 0.0, 0.0, 0.0, 0.0, 0.0])).force[0]))
    1000
    """

    inner_groove: float = 0.52
    outer_groove: float = 0.53

    def __post_init__(self) -> None:
        super().__post_init__()
        require(
            *(
                (0.5 < ratio <= 1.0, f"{name}: found {plain(ratio, 6)}; allowed above 0.5, up to 1")
                for name, ratio in (("inner_groove", self.inner_groove), ("outer_groove", self.outer_groove))
            )
        )

    @property
    def takes(self) -> tuple[int, ...]:
        """Senses along z of the thrusts that it takes."""
        return (self.side,) if self.contact_angle else (1, -1)

    @property
    def groove_distance(self) -> float:
        """Distance A of the centres of both grooves around a ball [mm]."""
        return (self.inner_groove + self.outer_groove - 1.0) * self.diameter

    @cached_property
    def constant(self) -> float:
        """Force of a ball over its deflection to the power 3/2 [N/mm^1.5], of both contacts."""
        contacts = [
            point_contact(1.0, (2.0 / self.diameter * rolling, 2.0 / self.diameter - 1.0 / radius), CONTACT_MODULUS)
            for rolling, radius in (
                (1.0 / (1.0 - self.gamma), self.inner_groove * self.diameter),
                (1.0 / (1.0 + self.gamma), self.outer_groove * self.diameter),
            )
        ]
        return float(sum(one.approach for one in contacts) ** -OF_BALLS)

    @property
    def dynamic_rating(self) -> float:
        """Basic dynamic radial load rating C [N], given or after ISO 281."""
        if self.rating is not None:
            return self.rating
        return ball_rating(
            self.elements, self.diameter, self.pitch_diameter, self.contact_angle, self.inner_groove, self.outer_groove
        )

    def _stiffness(self, deflection: float) -> float:
        return OF_BALLS * self.constant * deflection ** (OF_BALLS - 1.0)

    @cached_property
    def _directions(self) -> tuple[Array, Array]:
        """Derivatives (n, 6) of the radial and of the axial way of the inner groove at every ball over the motion."""
        sine, cosine, zero = np.sin(self.angles), np.cos(self.angles), np.zeros(self.elements)
        middle = 0.5 * self.pitch_diameter
        middle += (self.inner_groove - 0.5) * self.diameter * math.cos(self.contact_angle)
        radial = np.stack([cosine, sine, zero, zero, zero, zero], axis=-1)
        axial = np.stack([zero, zero, 1.0 + zero, middle * sine, -middle * cosine, zero], axis=-1)
        return radial, axial

    def _ways(self, motion: Array) -> tuple[Array, Array, Array]:
        """Radial, axial and whole distance (n,) of the centres of both grooves at every ball [mm]."""
        radial, axial = self._directions
        free = self.groove_distance
        out = free * math.cos(self.contact_angle) - 0.5 * self.clearance + radial @ motion
        along = self.side * (free * math.sin(self.contact_angle) + self.preload) + axial @ motion
        return out, along, np.hypot(out, along)

    def _deflections(self, distance: Array) -> Array:
        return np.maximum(distance - self.groove_distance, 0.0)

    def reaction(self, motion: Array) -> Reaction:
        """What it does against a motion (6,) of its inner ring [mm, rad]."""
        radial, axial = self._directions
        out, along, distance = self._ways(motion)
        pressed = self._deflections(distance)
        safe = np.where(pressed > 0.0, distance, 1.0)
        normals = (out / safe)[:, None] * radial + (along / safe)[:, None] * axial
        forces = self.constant * pressed**OF_BALLS
        stiffness = OF_BALLS * self.constant * np.sqrt(pressed)
        turning = forces / safe
        tangent = (normals.T * (stiffness - turning)) @ normals
        tangent += (radial.T * turning) @ radial + (axial.T * turning) @ axial
        energy = float(forces @ pressed) / (OF_BALLS + 1.0)
        whole = (forces + stiffness * distance) @ np.abs(normals)  # a deflection is a difference of distances
        return Reaction(energy, forces @ normals, 0.5 * (tangent + tangent.T), whole)

    def element_forces(self, motion: Array) -> Array:
        """Forces (n,) [N] of all balls under a motion (6,)."""
        return np.asarray(self.constant * self._deflections(self._ways(motion)[2]) ** OF_BALLS)

    def largest_pressure(self, motion: Array) -> float:
        """Largest contact pressure [MPa] under a motion (6,), at the inner ring."""
        force = float(self.element_forces(motion).max())
        if force == 0.0:
            return 0.0
        curvatures = (
            2.0 / (self.diameter * (1.0 - self.gamma)),
            (2.0 - 1.0 / self.inner_groove) / self.diameter,
        )
        return point_contact(force, curvatures, CONTACT_MODULUS).max_pressure

    def life(self, motion: Array) -> float:
        """Basic reference rating life [million revolutions] under a motion (6,); inf without load."""
        return ball_life(
            self.element_forces(motion),
            self.dynamic_rating,
            self.gamma,
            self.contact_angle,
            self.inner_groove,
            self.outer_groove,
        )


@checked
@dataclass(frozen=True, eq=False, kw_only=True)
class RollerBearing(RollingBearing):
    """A row of rollers: cylindrical without a contact angle, tapered with one.

    Parameters
    ----------
    length : float [mm]
        Effective length of a roller.

    Examples
    --------
    >>> bearing = RollerBearing(at=0.0, elements=14, diameter=10.0, pitch_diameter=60.0, length=12.0)
    >>> bearing.reaction(np.array([0.01, 0.0, 0.0, 0.0, 0.0, 0.0])).force.round()[:3]
    array([4054.,    0.,    0.])
    """

    length: float

    @property
    def takes(self) -> tuple[int, ...]:
        """Senses along z of the thrusts that it takes."""
        return (self.side,) if self.contact_angle else ()

    @property
    def constant(self) -> float:
        """Force of a slice over its deflection to the power 10/9 [N/mm^(10/9)]."""
        return OF_LENGTH * self.length ** (8.0 / 9.0) / SLICES

    @property
    def dynamic_rating(self) -> float:
        """Basic dynamic radial load rating C [N], given or after ISO 281."""
        if self.rating is not None:
            return self.rating
        return roller_rating(self.elements, self.diameter, self.pitch_diameter, self.contact_angle, self.length)

    def _stiffness(self, deflection: float) -> float:
        return OF_ROLLERS * SLICES * self.constant * deflection ** (OF_ROLLERS - 1.0)

    @cached_property
    def places(self) -> Array:
        """Middles of the slices along a roller (slices,) [mm]."""
        return ((np.arange(SLICES) + 0.5) / SLICES - 0.5) * self.length

    @cached_property
    def profile(self) -> Array:
        """What the profile takes off a roller at each slice (slices,) [mm]."""
        place = 2.0 * np.abs(self.places)
        if self.contact_angle:
            return np.asarray(-0.00045 * self.diameter * np.log(1.0 - (place / self.length) ** 2))
        if self.length <= 2.5 * self.diameter:
            return np.asarray(-0.00035 * self.diameter * np.log(1.0 - (place / self.length) ** 2))
        ends = 2.5 * self.diameter
        from_ends = np.maximum(place - (self.length - ends), 0.0) / ends
        return np.asarray(-0.0005 * self.diameter * np.log(1.0 - from_ends**2))

    @cached_property
    def _normals(self) -> Array:
        """Derivatives (n slices, 6) of the deflections of all slices over the motion."""
        sine, cosine = math.sin(self.contact_angle), math.cos(self.contact_angle)
        out = 0.5 * self.pitch_diameter - self.side * sine * self.places
        around = np.stack([np.cos(self.angles), np.sin(self.angles)], axis=-1)[:, None]
        height = np.broadcast_to((cosine * self.places)[:, None], (self.elements, SLICES, 1))
        points = np.concatenate([out[:, None] * around, height], axis=-1)
        normals = np.concatenate([cosine * around, np.full((self.elements, 1, 1), self.side * sine)], axis=-1)
        normals = np.broadcast_to(normals, points.shape)
        return np.concatenate([normals, np.cross(points, normals)], axis=-1).reshape(-1, 6)

    def _deflections(self, motion: Array) -> Array:
        """Deflections (n slices,) [mm]."""
        sine, cosine = math.sin(self.contact_angle), math.cos(self.contact_angle)
        given = self.preload * sine - 0.5 * self.clearance * cosine - 2.0 * np.tile(self.profile, self.elements)
        return np.maximum(self._normals @ motion + given, 0.0)

    def reaction(self, motion: Array) -> Reaction:
        """What it does against a motion (6,) of its inner ring [mm, rad]."""
        pressed = self._deflections(motion)
        loaded = pressed > 0.0
        pressed, normals = pressed[loaded], self._normals[loaded]
        forces = self.constant * pressed**OF_ROLLERS
        tangent = (normals.T * (OF_ROLLERS * forces / pressed)) @ normals
        energy = float(forces @ pressed) / (OF_ROLLERS + 1.0)
        return Reaction(energy, forces @ normals, 0.5 * (tangent + tangent.T), forces @ np.abs(normals))

    def slice_forces(self, motion: Array) -> Array:
        """Forces (n, slices) [N] along all rollers under a motion (6,)."""
        return np.asarray(self.constant * self._deflections(motion).reshape(-1, SLICES) ** OF_ROLLERS)

    def element_forces(self, motion: Array) -> Array:
        """Forces (n,) [N] of all rollers under a motion (6,)."""
        return np.asarray(self.slice_forces(motion).sum(axis=1))

    def largest_pressure(self, motion: Array) -> float:
        """Largest contact pressure [MPa] under a motion (6,), at the inner ring."""
        line_load = float(self.slice_forces(motion).max()) * SLICES / self.length
        if line_load == 0.0:
            return 0.0
        return line_contact(line_load, 2.0 / (self.diameter * (1.0 - self.gamma)), CONTACT_MODULUS).max_pressure

    def life(self, motion: Array) -> float:
        """Basic reference rating life [million revolutions] under a motion (6,); inf without load."""
        return roller_life(self.slice_forces(motion), self.dynamic_rating, self.gamma, self.contact_angle)
