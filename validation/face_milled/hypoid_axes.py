"""Two face-milled gears on axes with an offset, solved by their five contact equations: nothing of the package in it.

Surfaces are points of the cutters' cones in the course of the cradle, each with its own equation of meshing, in place
of flanks theta = Theta(rho, z). The axes stand as in a housing, at right angles, with their common normal along y and
the gears at the distances of a dimension sheet from it, in place of pitch cones that touch in a plane. What a sheet and
two summaries of settings print is all that goes in. Derivatives are by complex steps; lengths in mm, angles in rad.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, cos, pi, sin, sqrt, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import fsolve

Vector = NDArray[Any]
TINY = 1e-30
"""Complex step."""


@dataclass(frozen=True)
class Surface:
    """Surface that one blade of a cutter generates on a gear.

    Attributes
    ----------
    outside : bool
        Outside blade, which cuts the concave flank.
    left_hand : bool
    settings : dict
        Of the machine and the blade; machine centre to back from the crossing point of the axis.
    """

    outside: bool
    left_hand: bool
    settings: dict[str, float]

    def point(self, height: Any, around: Any, roll: Any) -> Vector:
        """Point of the blank [mm], z along its axis from the crossing point, for a height above the blade tip."""
        s = self.settings
        turn = s["cradle_angle"] + roll
        radial = np.array([np.cos(turn), np.sin(turn), 0.0 * turn])
        tangent = np.array([-np.sin(turn), np.cos(turn), 0.0 * turn])
        upright = np.array([0.0, 0.0, 1.0])
        lean = cos(s["swivel"]) * tangent - sin(s["swivel"]) * radial
        axis = sin(s["tilt"]) * lean + cos(s["tilt"]) * upright
        first = cos(s["tilt"]) * lean - sin(s["tilt"]) * upright
        second = np.cross(axis, first)
        radius = s["point_radius"] + (1.0 if self.outside else -1.0) * height * tan(s["blade_angle"])
        in_machine = s["radial"] * radial + radius * (np.cos(around) * first + np.sin(around) * second) - height * axis
        x, y, z = in_machine - np.array([0.0, s["blank_offset"], s["sliding_base"] + s["helical_motion"] * roll])
        sine, cosine = sin(s["root_angle"]), cos(s["root_angle"])
        out, along = x * sine - z * cosine, x * cosine + z * sine - s["machine_centre_to_back"]
        psi = s["ratio_of_roll"] * (roll - 0.5 * s.get("modified_roll_2c", 0.0) * roll**2)
        turned = np.array([out * np.cos(psi) + y * np.sin(psi), y * np.cos(psi) - out * np.sin(psi), along])
        return turned * np.array([1.0, -1.0, 1.0]) if self.left_hand else turned

    def ways(self, unknowns: Vector) -> Vector:
        """Derivatives (3, 3) of the point by height, azimuth on the cutter and roll, in rows."""
        steps = [self.point(*(unknowns + 1j * TINY * unit)).imag / TINY for unit in np.eye(3)]
        return np.array(steps)

    def meshing(self, unknowns: Vector) -> float:
        """What vanishes where the roll moves the cone within itself."""
        return float(np.linalg.det(self.ways(unknowns)))

    def normal(self, unknowns: Vector) -> Vector:
        """Unit normal of the cone, and of the surface where the equation of meshing holds."""
        ways = self.ways(unknowns)
        normal: Vector = np.cross(ways[0], ways[1])
        return normal / np.linalg.norm(normal)

    def at(self, rho: float, z: float, start: Vector) -> Vector:
        """Unknowns of the point of the surface at (rho, z)."""

        def misses(unknowns: Vector) -> list[float]:
            x, y, along = self.point(*unknowns)
            return [np.hypot(x, y) - rho, along - z, self.meshing(unknowns)]

        return _solved(misses, start)


def _solved(misses: Any, start: Vector) -> Vector:
    """Root of equations, refined by steps of Newton's method."""
    root = np.asarray(fsolve(misses, start, xtol=1e-14, full_output=True)[0])
    for _ in range(3):
        slopes = np.array(
            [(np.array(misses(root + step)) - misses(root - step)) / 2e-6 for step in 1e-6 * np.eye(len(root))]
        )
        root = root - np.linalg.solve(slopes.T, misses(root))
    return root


@dataclass(frozen=True)
class Sheet:
    """A dimension sheet: axes at right angles, the pitch cones, and where P lies from the crossing points.

    Attributes
    ----------
    teeth : (int, int)
    offset : float [mm]
        a, positive, the pinion left-hand.
    pitch_angles, mean_cone_distances : (float, float) [rad], [mm]
    """

    teeth: tuple[int, int]
    offset: float
    pitch_angles: tuple[float, float]
    mean_cone_distances: tuple[float, float]

    @property
    def places(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """(rho, z) of P on pinion and wheel, z from the crossing points (ISO 23509, formulas 113, 129 to 131)."""
        (d1, d2), (r1, r2) = self.pitch_angles, self.mean_cone_distances
        first, second = r1 * sin(d1), r2 * sin(d2)
        zeta = asin(self.offset / (second + first * cos(d2) / cos(d1)))
        return (first, second * cos(zeta)), (second, first * sin(d2) / cos(d1))


@dataclass(frozen=True)
class Errors:
    """Mounting errors: offset, pinion and wheel along their axes [mm], shaft angle [rad]."""

    offset: float = 0.0
    pinion: float = 0.0
    wheel: float = 0.0
    angle: float = 0.0


class Housing:
    """A left-hand pinion about z and a right-hand wheel about x, their axes an offset apart along y.

    Parameters
    ----------
    sheet : Sheet
    pinion, wheel : Surface
    errors : Errors
    """

    def __init__(self, sheet: Sheet, pinion: Surface, wheel: Surface, errors: Errors = Errors()) -> None:
        self.sheet, self.surfaces = sheet, (pinion, wheel)
        (first, along_pinion), (second, along_wheel) = sheet.places
        # P over the pinion's axis: as far along x as it lies from the crossing point of the wheel, and between the axes
        beside = sqrt(max(first**2 - along_wheel**2, 0.0))  # of axes that meet but for rounding
        self.azimuth = float(np.arctan2(beside, along_wheel))
        centre = np.array([0.0, beside + sqrt(max(second**2 - along_pinion**2, 0.0)), 0.0])
        self.offset = centre[1]
        normal = np.array([0.0, 1.0, 0.0])
        centre = centre + errors.offset * normal
        angle = 0.5 * pi + errors.angle
        axis = np.array([sin(angle), 0.0, cos(angle)])
        to_point = np.array([0.0, beside - self.offset, along_pinion]) / second
        # the wheel's frame without errors: z along x, x towards P
        turn = np.array(
            [[cos(errors.angle), 0.0, sin(errors.angle)], [0.0, 1.0, 0.0], [-sin(errors.angle), 0.0, cos(errors.angle)]]
        )
        out = turn @ to_point
        self.axes = np.array([out, np.cross(axis, out), axis])
        self.origin = centre + errors.wheel * axis - np.array([0.0, 0.0, errors.pinion])
        self.references = [
            one.at(*place, _first_guess(one, *place)) for one, place in zip(self.surfaces, sheet.places, strict=True)
        ]
        self.zeros = [
            float(np.arctan2(*one.point(*at)[1::-1])) for one, at in zip(self.surfaces, self.references, strict=True)
        ]

    def points(self, unknowns: Vector, angles: tuple[float, float]) -> tuple[Vector, Vector]:
        """Points of both gears in the housing; the gears turned by angles about +z and -x."""
        pinion, wheel = self.surfaces
        first = _turned(pinion.point(*unknowns[:3]), self.azimuth - self.zeros[0] + angles[0])
        second = _turned(wheel.point(*unknowns[3:6]), -self.zeros[1] - angles[1])
        return first, second @ self.axes + self.origin

    def normals(self, unknowns: Vector, angles: tuple[float, float]) -> tuple[Vector, Vector]:
        """Normals of both surfaces in the housing."""
        pinion, wheel = self.surfaces
        first = _turned(pinion.normal(unknowns[:3]), self.azimuth - self.zeros[0] + angles[0])
        return first, _turned(wheel.normal(unknowns[3:6]), -self.zeros[1] - angles[1]) @ self.axes

    def contact(self, turn: float, start: Vector | None = None) -> Vector:
        """Unknowns (7,) of the contact at a turn of the pinion about +z: two surfaces, turn of the wheel."""
        if start is None:
            start = np.concatenate([*self.references, [turn * self.sheet.teeth[0] / self.sheet.teeth[1]]])

        def misses(unknowns: Vector) -> Vector:
            angles = turn, unknowns[6]
            first, second = self.points(unknowns, angles)
            one, other = self.normals(unknowns, angles)
            across = _across(one)
            meshing = [surface.meshing(unknowns[3 * k : 3 * k + 3]) for k, surface in enumerate(self.surfaces)]
            return np.array([*(first - second), *(across @ other), *meshing])

        return _solved(misses, start)

    def edge_contact(self, turn: float, face_cone: tuple[float, float], start: Vector) -> Vector:
        """Unknowns of the contact of the wheel's tip edge, on the cone (delta_a, t_zF) of its blank."""
        angle, apex = face_cone
        wheel = self.surfaces[1]
        cone = np.array([cos(angle), -sin(angle)])

        def misses(unknowns: Vector) -> Vector:
            angles = turn, unknowns[6]
            first, second = self.points(unknowns, angles)
            x, y, z = wheel.point(*unknowns[3:6])
            rho = np.hypot(x, y)
            normal = wheel.normal(unknowns[3:6])
            edge = np.cross(normal, np.array([cone[0] * x / rho, cone[0] * y / rho, cone[1]]))
            edge = _turned(edge, -self.zeros[1] - angles[1]) @ self.axes
            along = edge @ self.normals(unknowns, angles)[0]
            meshing = [surface.meshing(unknowns[3 * k : 3 * k + 3]) for k, surface in enumerate(self.surfaces)]
            return np.array([*(first - second), along, cone @ [rho, z + apex], *meshing])

        return _solved(misses, start)

    def places(self, unknowns: Vector) -> Vector:
        """(rho, z) of the contact on pinion and wheel, z from the crossing points (4,) [mm]."""
        parts = []
        for k, surface in enumerate(self.surfaces):
            x, y, z = surface.point(*unknowns[3 * k : 3 * k + 3])
            parts += [np.hypot(x, y), z]
        return np.array(parts)

    def curvatures(self, turn: float, unknowns: Vector, step: float = 0.1) -> Vector:
        """Principal relative curvatures (2,) at a contact [1/mm], the larger first, by differences over a stencil."""
        angles = turn, unknowns[6]
        centre, normal = self.points(unknowns, angles)[0], self.normals(unknowns, angles)[0]
        across = _across(normal)

        def gap(x: float, y: float) -> float:
            heights = []
            for k in (0, 1):

                def misses(own: Vector, k: int = k) -> Vector:
                    moved = unknowns.copy()
                    moved[3 * k : 3 * k + 3] = own
                    apart = self.points(moved, angles)[k] - centre
                    return np.array([across[0] @ apart - x, across[1] @ apart - y, self.surfaces[k].meshing(own)])

                moved = unknowns.copy()
                moved[3 * k : 3 * k + 3] = _solved(misses, unknowns[3 * k : 3 * k + 3])
                heights.append(normal @ (self.points(moved, angles)[k] - centre))
            return float(heights[1] - heights[0])

        middle = gap(0.0, 0.0)
        xx = (gap(step, 0.0) + gap(-step, 0.0) - 2.0 * middle) / step**2
        yy = (gap(0.0, step) + gap(0.0, -step) - 2.0 * middle) / step**2
        xy = (gap(step, step) + gap(-step, -step) - gap(step, -step) - gap(-step, step)) / (4.0 * step**2)
        values = np.abs(np.linalg.eigvalsh([[xx, xy], [xy, yy]]))
        return np.sort(values)[::-1]


def _first_guess(surface: Surface, rho: float, z: float) -> Vector:
    """Height, azimuth on the cutter and roll near (rho, z), from a coarse search at the centre of roll."""
    best, least = np.zeros(3), np.inf
    for height in np.linspace(0.5, 6.0, 12):
        for around in np.linspace(-pi, pi, 721):
            x, y, along = surface.point(height, around, 0.0)
            off = (np.hypot(x, y) - rho) ** 2 + (along - z) ** 2
            if off < least:
                best, least = np.array([height, around, 0.0]), off
    return best


def _turned(vector: Vector, angle: float) -> Vector:
    x, y, z = vector
    return np.array([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle), z])


def _across(normal: Vector) -> Vector:
    """Two directions across a normal (2, 3)."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first)])
