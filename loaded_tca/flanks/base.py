r"""What a tooth flank is: one function theta = Theta(rho, z) in the gear's own cylindrical frame.

Every solver of the package sees flanks through this class alone; a new gear type is a new subclass.

The tooth has two flanks, told apart by ``side`` (s = +1: the outward normal has a positive azimuthal part).
With F = theta - Theta the unit normal out of the material is s grad F/|grad F|, where in the cylindrical
basis grad F = (-Theta_rho, 1/rho, -Theta_z).

Flanks are computed in the cylindrical coordinates (rho, z) of their gear. On pictures and in messages a cylindrical
gear is seen by its diameters and from mid-face, a bevel gear by its cone distances and from its pitch cone: its frame.

A function of (rho, z) with its first and second derivatives, and the few rules to combine them.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.plain import plain

SMALLEST_DISTANCE = 1e-3
"""Cone distances are kept above this fraction of R_m: at the apex there is no flank."""

Bends = Sequence[Any]
"""Second derivatives by rho rho, rho z and z z."""
FLAT = (0.0, 0.0, 0.0)


class Jet:
    """Value, gradient and Hessian of a function of (rho, z); arrays that broadcast against each other.

    Plain floats stand for constants, and a derivative that is the number zero costs nothing. Never changed once made.

    Parameters
    ----------
    value, rho, z : array or float
        The function and its first derivatives.
    bends : three arrays or floats, or a function that returns them
        Second derivatives by rho rho, rho z, z z. The function is called when the first of them is asked for: Newton's
        method along a normal does without.
    """

    __slots__ = ("_bends", "rho", "value", "z")

    def __init__(self, value: Any, rho: Any = 0.0, z: Any = 0.0, bends: Bends | Callable[[], Bends] = FLAT) -> None:
        self.value, self.rho, self.z, self._bends = value, rho, z, bends

    def __reduce__(self) -> tuple[type[Jet], tuple[Any, ...]]:
        """Pickle the numbers: second derivatives as such, since the function that returns them cannot be pickled."""
        return Jet, (self.value, self.rho, self.z, self.bends)

    @property
    def bends(self) -> Bends:
        """Second derivatives by rho rho, rho z, z z."""
        if callable(self._bends):
            self._bends = self._bends()
        return self._bends

    rho_rho = property(lambda self: self.bends[0], doc="Second derivative by rho.")
    rho_z = property(lambda self: self.bends[1], doc="Mixed derivative.")
    z_z = property(lambda self: self.bends[2], doc="Second derivative by z.")

    def __add__(self, other: Jet) -> Jet:
        slopes = _sum(self.rho, other.rho), _sum(self.z, other.z)
        return Jet(self.value + other.value, *slopes, lambda: [*map(_sum, self.bends, other.bends)])

    def __mul__(self, factor: Any) -> Jet:
        """Multiply by a number, or by an array that does not depend on (rho, z)."""
        slopes = _product(self.rho, factor), _product(self.z, factor)
        return Jet(self.value * factor, *slopes, lambda: [_product(part, factor) for part in self.bends])

    __rmul__ = __mul__

    def times(self, other: Jet) -> Jet:
        """Product of two functions (Leibniz)."""
        f, g = self, other

        def bends() -> Bends:
            mixed = _sum(_product(f.rho, g.z), _product(f.z, g.rho))
            slopes = 2.0 * _product(f.rho, g.rho), mixed, 2.0 * _product(f.z, g.z)
            bent = (_sum(_product(p, g.value), _product(q, f.value)) for p, q in zip(f.bends, g.bends, strict=True))
            return [*map(_sum, slopes, bent)]

        return Jet(
            f.value * g.value,
            _sum(_product(f.rho, g.value), _product(g.rho, f.value)),
            _sum(_product(f.z, g.value), _product(g.z, f.value)),
            bends,
        )

    def compose(self, value: Any, first: Any, second: Any) -> Jet:
        """f(self), given f, f' and f'' at ``self.value`` (chain rule); f'' may be a function that returns it."""

        def bends() -> Bends:
            bend = second() if callable(second) else second
            (rho_rho, rho_z, z_z), bend_rho, bend_z = self.bends, _product(self.rho, bend), _product(self.z, bend)
            return (
                _sum(_product(bend_rho, self.rho), _product(rho_rho, first)),
                _sum(_product(bend_rho, self.z), _product(rho_z, first)),
                _sum(_product(bend_z, self.z), _product(z_z, first)),
            )

        return Jet(value, _product(self.rho, first), _product(self.z, first), bends)

    def shifted_scaled(self, origin: float, length: float) -> Jet:
        """(self - origin)/length."""
        return Jet(self.value - origin, self.rho, self.z, lambda: self.bends) * (1.0 / length)


def _product(part: Any, factor: Any) -> Any:
    if (type(part) is float and part == 0.0) or (type(factor) is float and factor == 0.0):
        return 0.0
    return part * factor


def _sum(part: Any, other: Any) -> Any:
    if type(part) is float and part == 0.0:
        return other
    if type(other) is float and other == 0.0:
        return part
    return part + other


def weighted_sum(jets: Sequence[Jet], weights: Array) -> Jet:
    """Sum of ``jets[k] * weights[..., k]``; at least one jet."""
    total = jets[0] * weights[..., 0]
    for k, jet in enumerate(jets[1:], 1):
        total = total + jet * weights[..., k]
    return total


def cone_distance(rho: Array, z: Array, mean: float) -> Jet:
    """R = hypot(rho, z) [mm], kept above 1e-3 of the mean cone distance.

    Its first derivatives are sine and cosine of the cone angle.

    Examples
    --------
    >>> round(float(cone_distance(3.0, 4.0, 5.0).rho), 1)
    0.6
    """
    value = np.maximum(np.sqrt(rho * rho + z * z), SMALLEST_DISTANCE * mean)
    sine, cosine = rho / value, z / value

    def bends() -> Bends:
        along_sine, along_cosine = sine / value, cosine / value
        return cosine * along_cosine, -cosine * along_sine, sine * along_sine

    return Jet(value, sine, cosine, bends)


def of_cone_angle(rho: Array, z: Array, value: Any, first: Any, second: Any) -> Jet:
    """f(u) of the cone angle u = atan2(rho, z), given f, f' and f'' there; f'' may be a function that returns it."""
    square = rho * rho + z * z
    slope_rho, slope_z = z / square, -rho / square

    def bends() -> Bends:
        twice = 2.0 * slope_rho * slope_z
        return twice, (slope_z - slope_rho) * (slope_z + slope_rho), -twice

    return Jet(None, slope_rho, slope_z, bends).compose(value, first, second)


def cone_angle(rho: Array, z: Array) -> Jet:
    """U = atan2(rho, z) [rad].

    Examples
    --------
    >>> round(float(cone_angle(1.0, 1.0).value / np.pi), 2)
    0.25
    """
    return of_cone_angle(rho, z, np.arctan2(rho, z), 1.0, 0.0)


Point = tuple[float, float]
"""(rho, z) [mm]."""


class FlankFrame(ABC):
    """Coordinates of a flank in pictures and messages; in pictures the root lies at the bottom, the tip on top.

    Attributes
    ----------
    labels : (str, str)
        Of the horizontal axis (lengthwise) and the vertical one (along the profile), with their units.
    heelwards : str
        What lies to the right, where the lengthwise coordinate is large.
    edges : (str, str, str, str)
        Names of the edges, in the order of ``Flank.edges``: tip, root, left end, right end.
    upwards : int
        +1; -1 of ring gears, whose own axes y and z point against those of the pinion: files of points of their flanks,
        and places that are shown, have the axes of the pinion.
    """

    labels: tuple[str, str]
    heelwards: str
    edges: tuple[str, str, str, str]
    upwards: int = 1

    @abstractmethod
    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Lengthwise place and height (...) of points (rho, z) [mm]."""

    @abstractmethod
    def profile_span(self, first: Point, last: Point) -> str:
        """Between which diameters or cones a piece of the profile lies, given the (rho, z) of its ends."""

    @abstractmethod
    def place(self, rho: float, z: float) -> str:
        """Where on the flank a point lies."""


@checked
@dataclass(frozen=True)
class CylinderFrame(FlankFrame):
    """Axial place from mid-face, against the diameter.

    Examples
    --------
    >>> CylinderFrame().place(51.0, 3.0)
    'diameter 102 mm, 3 mm from mid-face'
    """

    labels = ("axial position from mid-face [mm]", "diameter [mm]")
    heelwards = "z > 0"
    edges = ("tip circle", "root form circle", "end of the face at z < 0", "end of the face at z > 0")

    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Axial coordinate and diameter [mm]."""
        return z, 2.0 * rho

    def profile_span(self, first: Point, last: Point) -> str:
        """Diameters."""
        return f"diameter {2.0 * first[0]:.2f} to {2.0 * last[0]:.2f} mm"

    def place(self, rho: float, z: float) -> str:
        """Diameter and axial position."""
        return f"diameter {plain(2.0 * rho)} mm, {_rounded(z)} mm from mid-face"


@checked
@dataclass(frozen=True)
class ConeFrame(FlankFrame):
    """Cone distance R - R_m from the mean one, against the height R (u - delta) above the pitch cone.

    Parameters
    ----------
    pitch_angle : float [rad]
        delta.
    mean_cone_distance : float [mm]
        R_m.

    Examples
    --------
    >>> frame = ConeFrame(math.radians(45), 100.0)
    >>> frame.place(100.0 * math.sin(0.8), 100.0 * math.cos(0.8))
    'at the mean cone distance, 1.46 mm above the pitch cone'
    """

    pitch_angle: float
    mean_cone_distance: float

    labels = ("cone distance R - R_m [mm], toe left, heel right", "height above the pitch cone [mm]")
    heelwards = "the heel"
    edges = ("face cone", "root form cone", "toe", "heel")

    def to_picture(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """R - R_m and R (u - delta) [mm]."""
        distance = np.hypot(rho, z)
        return distance - self.mean_cone_distance, distance * (np.arctan2(rho, z) - self.pitch_angle)

    def profile_span(self, first: Point, last: Point) -> str:
        """Cone angles."""
        angles = (math.degrees(math.atan2(*point)) for point in (first, last))
        return "cone angle " + " to ".join(f"{angle:.2f}" for angle in angles) + " deg"

    def place(self, rho: float, z: float) -> str:
        """Cone distance from the mean one and height."""
        lengthwise, height = (float(part) for part in self.to_picture(np.array(rho), np.array(z)))
        side = "above" if height >= 0.0 else "below"
        end = "heel" if lengthwise >= 0.0 else "toe"
        along = _rounded(abs(lengthwise))
        where = "at the mean cone distance" if along == "0" else f"{along} mm from R_m to the {end}"
        return f"{where}, {_rounded(abs(height))} mm {side} the pitch cone"


def _rounded(length: float) -> str:
    """Three digits, not finer than a micrometre."""
    return plain(round(length, 3), 3)


EDGE_NAMES = ("tip", "root", "lower side", "upper side")
"""Names of the edges, in the order of ``Flank.edges``; the sides are the ends of the face, lower at
small z (toe), upper at large z (heel). ``FlankFrame.edges`` has the words of each kind of gear."""


@checked
class Flank(ABC):
    """One side of a tooth: theta = Theta(rho, z) on a region of (rho, z) with four edges.

    Attributes
    ----------
    side : int
        s = +1 or -1, the sign of the azimuthal part of the outward normal.
    extent : (float, float)
        Height of the region in rho and its width in z [mm], the natural lengths of steps on the flank.
    frame : FlankFrame
        How pictures and messages show places on it.
    profile_unit : float [mm]
        Length that one unit of the profile coordinate stands for: 1 of a roll length, R_m of an arc.
    roll_unit : float or None [mm or rad]
        Profile coordinate at a roll angle of 1 rad; None: the flank is no involute.
    """

    side: int
    extent: tuple[float, float]
    frame: FlankFrame
    profile_unit: float = 1.0
    roll_unit: float | None = None

    @abstractmethod
    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:
        """Theta [rad] with its derivatives.

        Parameters
        ----------
        rho, z : (...) array [mm]
            Cylindrical coordinates in the gear's own frame.
        beyond : (..., relief starts) bool array, optional
            The side of each relief start whose smooth continuation is wanted; None: the side a point lies on.
        """

    @abstractmethod
    def edges(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Distance to each edge [mm], positive inside, in the order of ``EDGE_NAMES``."""

    def relief_starts(self, rho: Array, z: Array) -> tuple[Jet, ...]:  # noqa: ARG002 (most flanks have none)
        """Signed distance to each relief start (a line where the slope jumps) [mm], positive beyond it."""
        return ()

    @abstractmethod
    def grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """(rho, z) on a grid over the region, edges included, each (profile, lengthwise) [mm]."""

    @abstractmethod
    def profile_coordinate(self, rho: Array, z: Array) -> Jet:
        """Roll length or the unwound arc, the coordinate of profile modifications [mm or rad]."""

    @abstractmethod
    def lengthwise_coordinate(self, rho: Array, z: Array) -> Jet:
        """Distance from the middle of the face, the coordinate of lengthwise modifications [mm]."""

    @abstractmethod
    def gradient_norm(self, rho: Array, z: Array) -> Jet:
        """|grad F| of the unmodified flank [1/mm]: what turns a distance along the normal into an angle."""

    def room(self, rho: Array, z: Array) -> Any:
        """Distance to the nearest edge [mm], positive inside."""
        return reduce(np.minimum, [jet.value for jet in self.edges(rho, z)])

    def inside(self, rho: Array, z: Array, tolerance: float = 0.0) -> Any:
        """Whether (rho, z) lies in the region, edges included, to within ``tolerance`` [mm]."""
        return self.room(rho, z) >= -tolerance


def outward_normal(flank: Flank, rho: Array, z: Array) -> Array:
    """Unit normal out of the material, (..., 3), components along e_rho, e_theta, e_z of the gear's frame."""
    jet = flank.theta(rho, z)
    parts = np.broadcast_arrays(-jet.rho, 1.0 / rho, -jet.z)
    gradient = np.stack(parts, axis=-1) * flank.side
    return gradient / np.linalg.norm(gradient, axis=-1, keepdims=True)


def lengthwise_direction(flank: Flank, rho: Array, z: Array) -> Array:
    """Direction in which the lengthwise coordinate grows, (..., 3), components along e_rho, e_theta, e_z.

    That is from toe to heel, or along the axis; its length is the growth per millimetre.
    """
    jet = flank.lengthwise_coordinate(rho, z)
    return np.stack(np.broadcast_arrays(jet.rho, 0.0 * rho, jet.z), axis=-1)


class DerivedFlank(Flank):
    """What a flank takes over from the nominal one: everything but Theta and the relief starts.

    Parameters
    ----------
    nominal : Flank
    """

    def __init__(self, nominal: Flank) -> None:
        self.nominal = nominal
        self.side, self.extent, self.frame = nominal.side, nominal.extent, nominal.frame
        self.profile_unit, self.roll_unit = nominal.profile_unit, nominal.roll_unit

    def edges(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Edges of the nominal flank."""
        return self.nominal.edges(rho, z)

    def grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """Grid of the nominal flank."""
        return self.nominal.grid(profile, lengthwise)

    def profile_coordinate(self, rho: Array, z: Array) -> Jet:
        """Profile coordinate of the nominal flank."""
        return self.nominal.profile_coordinate(rho, z)

    def lengthwise_coordinate(self, rho: Array, z: Array) -> Jet:
        """Lengthwise coordinate of the nominal flank."""
        return self.nominal.lengthwise_coordinate(rho, z)

    def gradient_norm(self, rho: Array, z: Array) -> Jet:
        """|grad F| of the nominal flank."""
        return self.nominal.gradient_norm(rho, z)


class Region(DerivedFlank):
    """The region of a flank and its coordinates, without its surface: Theta = 0."""

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:  # noqa: ARG002 (it has no relief start)
        """Nothing."""
        return Jet(np.zeros(np.broadcast(rho, z).shape))


def unmodified(flank: Flank) -> Flank:
    """The flank at the bottom of all that was derived from it."""
    while isinstance(flank, DerivedFlank):
        flank = flank.nominal
    return flank
