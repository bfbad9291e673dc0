r"""Generated flanks of face-milled bevel gears: exact by the equations of generation, or as a B-spline of them.

The flank is turned about the axis of its gear until it holds the pitch point at the mean cone distance R_m of its blank
(theta = 0).
Between form line, face cone, toe and heel every point is found from the generating equations
(:mod:`loaded_tca.flanks.cradle`). Beyond these edges there is no flank, but searches step over them: there Theta goes
on as the B-spline does, as a parabola from the edge.

What a generated flank sweeps out of the other gear is its conjugate, here to second order at a place. With the azimuth
:math:`\Phi(\varrho, \alpha, z)` by which a point of space lies off the wheel's flank, in coordinates of the pinion, and
the ratio u = z1/z2, a point of the pinion is in contact where :math:`\Phi_\alpha = -u`, and the envelope has there

.. math:: \Theta_i = \frac{\Phi_i}{u}, \qquad
          \Theta_{ij} = \frac{1}{u}\left(\Phi_{ij} - \frac{\Phi_{i\alpha} \Phi_{j\alpha}}{\Phi_{\alpha\alpha}}\right).

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, section 6.4 (envelopes); here by the azimuth of a point.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import cos, hypot, sin
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Mask
from loaded_tca.errors import GeometryError
from loaded_tca.flanks.base import ConeFrame, Jet, Region
from loaded_tca.flanks.bevel import NODES, ToothRegion, chebyshev_nodes, face_cone_angles
from loaded_tca.flanks.cradle import CradleGeneration, GeneratedPoints
from loaded_tca.flanks.spline import FitError, SplineFlank
from loaded_tca.flanks.tensor_spline import TensorSpline, fit
from loaded_tca.gears.face_milled import FaceMilledGear, FlankName
from loaded_tca.gears.hypoid import OffsetFrame
from loaded_tca.plain import plain

MOST_FLANKS = 8
"""Flanks that are kept for variants of the micro-geometry."""
SPLINE_POINTS = (41, 33)
"""Chebyshev-Lobatto points of the B-spline along the profile and lengthwise: it is within 1e-7 mm of usual flanks. The
generated surface may turn back just below the form line, which takes more points along the profile."""
SPLINE_DEGREE = 5
ON_EDGE = 1e-7
"""Part of the flank's height and width by which points on its edges may miss them."""
CHECK_POINTS = (9, 5)
"""Points along the profile and lengthwise that have to be there before a flank is one."""
EDGE_HEIGHTS = 64
"""Heights at which an undercut edge is looked for."""


@dataclass(frozen=True)
class FlankAngles:
    """Angles of a flank at its pitch point.

    Attributes
    ----------
    spiral : float [rad]
        beta, positive for a right-hand gear.
    pressure, transverse_pressure : float [rad]
        Normal pressure angle, and that in the section across the pitch line.
    """

    spiral: float
    pressure: float
    transverse_pressure: float


@checked
class GeneratedFlank(ToothRegion):
    """Exact flank of a face-milled gear, generated or formate.

    Parameters
    ----------
    gear : FaceMilledGear
    flank : {"concave", "convex"}

    Raises
    ------
    InputError
        If the cutter has no blade for this flank.
    GeometryError
        If the cutter does not cut the whole flank, or undercuts it.

    References
    ----------
    Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21.

    Examples
    --------
    >>> from loaded_tca.gears import BevelBlank
    >>> from loaded_tca.gears.basic_settings import spread_blade
    >>> blank = BevelBlank((20, 30), 5.0, 22.0, spiral_angle=math.radians(35), cutter_radius=50.0, taper="duplex")
    >>> flank = GeneratedFlank(spread_blade(blank)[1], "concave")
    >>> round(math.degrees(flank.angles.spiral), 1), flank.as_spline().check_error.largest < 1e-7
    (35.1, True)
    """

    def __init__(self, gear: FaceMilledGear, flank: FlankName) -> None:
        blank, self.gear, self.flank = gear.blank, gear, flank
        self.generation = CradleGeneration(gear.cutter.blade(flank), flank, gear.machine)
        self._mirror = float(gear.mirror)
        super().__init__(
            gear.side(flank),
            blank.pitch_angle,
            blank.cone_distances,
            (blank.face_angle, blank.face_apex),
            self._form_angles(),
        )
        self._require(*(part.ravel() for part in self.grid(*CHECK_POINTS)))
        self._zero = 0.0
        self._zero = float(self._require(*self._pitch_point).theta.value[0])

    @property
    def owner(self) -> str:
        """Gear and flank, as messages call them."""
        return f"{self.gear.name}, {self.flank} flank"

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:  # noqa: ARG002 (it has no relief start)
        """Theta of the generated flank; beyond its edges that of the B-spline."""
        rho, z = np.broadcast_arrays(np.asarray(rho, dtype=float), np.asarray(z, dtype=float))
        flat = rho.ravel(), z.ravel()
        on = self.inside(*flat, ON_EDGE * min(self.extent))
        parts = np.empty((6, rho.size))
        if on.any():
            parts[:, on] = _stack(self._exact(flat[0][on], flat[1][on]))
        if not on.all():
            parts[:, ~on] = _stack(self._spline_flank.theta(flat[0][~on], flat[1][~on]))
        value, slope_rho, slope_z, *bends = parts.reshape(6, *rho.shape)
        return Jet(value, slope_rho, slope_z, bends)

    def gradient_norm(self, rho: Array, z: Array) -> Jet:
        """|grad F| [1/mm]: its B-spline over the flank's coordinates."""
        profile, lengthwise = self.profile_coordinate(rho, z), self.lengthwise_coordinate(rho, z)
        return self._gradient_spline(profile.value, lengthwise.value).compose(profile, lengthwise)

    def as_spline(self, points: tuple[int, int] = SPLINE_POINTS) -> SplineFlank:
        """Quintic B-spline of this flank through Chebyshev-Lobatto points along the profile and lengthwise.

        Returns
        -------
        SplineFlank
            ``check_error``: how far it is from the exact flank midway between the points [mm].
        """
        lines = self._lines(points)
        midway = [0.5 * (line[1:] + line[:-1]) for line in lines]  # where the B-spline is furthest from the flank
        exact = [self._at_nodes if points == SPLINE_POINTS else self._exact_on(lines), self._exact_on(midway)]
        bare = SplineFlank(Region(self), self._fitted(exact[0][2].value.reshape(points)), FitError(0.0, 0.0))
        errors = [FitError.of((bare.theta(rho, z).value - jet.value) / _gradient(rho, jet)) for rho, z, jet in exact]
        return SplineFlank(Region(self), bare.spline, *errors)

    @cached_property
    def angles(self) -> FlankAngles:
        """Spiral and pressure angles at the pitch point."""
        rho, z = self._pitch_point
        jet, delta = self._exact(rho, z), self.gear.blank.pitch_angle
        slopes = float(jet.rho[0]), float(jet.z[0])
        along = float(rho[0]) * (slopes[0] * math.sin(delta) + slopes[1] * math.cos(delta))
        up = float(rho[0]) * abs(slopes[0] * math.cos(delta) - slopes[1] * math.sin(delta))
        return FlankAngles(math.atan(along), math.atan(up / math.hypot(1.0, along)), math.atan(up))

    def _form_angles(self) -> Array:
        """Cone angles (NODES,) of the form line; refuses a line that the cutter does not cut, or undercuts."""
        blank = self.gear.blank
        distance = chebyshev_nodes(blank.cone_distances, NODES)
        angles, points = self.generation.at_height(self.generation.blade.form_height, distance)
        if not points.converged.all():
            raise self._not_cut(distance, angles, points.converged)
        tips = face_cone_angles((blank.face_angle, blank.face_apex), distance)
        if not (angles < tips).all():
            worst = int(np.argmax(angles - tips))
            place = self._place(distance[worst], tips[worst])
            raise GeometryError(f"{self.owner}: no flank is left: the form line lies above the face cone {place}")
        if not points.found.all():
            raise self._undercut(float(distance[np.argmin(points.sharpness)]))
        return angles

    def _undercut(self, distance: float) -> GeometryError:
        """What to say of an undercut edge at a cone distance."""
        form, blank = self.generation.blade.form_height, self.gear.blank
        depths = np.linspace(0.0, distance * (blank.face_angle - blank.root_angle), EDGE_HEIGHTS)
        cuts = [self.generation.at_height(form + depth, np.array([distance])) for depth in depths]
        turned = np.array([points.converged[0] and points.sharpness[0] <= 0.0 for _, points in cuts])
        last = max(0, int(np.argmin(turned)) - 1)
        place = self._place(distance, cuts[last][0][0])
        return GeometryError(
            f"{self.owner}: undercut: the generated surface turns back in an edge {place}, on the blade at least "
            f"{plain(depths[last], 2)} mm above its rounded tip; cut less deep (sliding_base), or use a larger "
            "blade_angle or edge_radius"
        )

    def _not_cut(self, distance: Array, angle: Array, cut: Mask) -> GeometryError:
        """What to say of points that the cutter does not reach."""
        worst = int(np.argmin(cut))
        missing = f"{int((~cut).sum())} of {cut.size} points of the flank"
        return GeometryError(
            f"{self.owner}: the cutter does not cut {missing}, first {self._place(distance[worst], angle[worst])}; do "
            "radial, cradle_angle, root_angle and point_radius belong to this blank?"
        )

    def _place(self, distance: float, angle: float) -> str:
        """A cone distance and a cone angle in words, before this flank has its frame."""
        frame = ConeFrame(self.gear.blank.pitch_angle, self.gear.blank.middle_cone_distance)
        return frame.place(distance * math.sin(angle), distance * math.cos(angle))

    def _require(self, rho: Array, z: Array) -> GeneratedPoints:
        """Points of the right-hand member; GeometryError if one is missing."""
        points = self.generation.solve(rho, z)
        if not points.found.all():
            raise self._not_cut(np.hypot(rho, z), np.arctan2(rho, z), points.found)
        return points

    def _exact(self, rho: Array, z: Array) -> Jet:
        """Theta of points (n,) on the flank, of this hand and turned to the pitch point."""
        return (self._require(rho, z).theta + Jet(-self._zero)) * self._mirror

    @property
    def _pitch_point(self) -> tuple[Array, Array]:
        blank, delta = self.gear.blank, self.gear.blank.pitch_angle
        distance = self.mean_cone_distance if blank.calculation_cone_distance is None else blank.mean_cone_distance
        return np.array([distance * math.sin(delta)]), np.array([distance * math.cos(delta)])

    @cached_property
    def _spline_flank(self) -> SplineFlank:
        return self.as_spline()

    @cached_property
    def _gradient_spline(self) -> TensorSpline:
        rho, _, jet = self._at_nodes
        return self._fitted(_gradient(rho, jet).reshape(SPLINE_POINTS))

    @cached_property
    def _at_nodes(self) -> tuple[Array, Array, Jet]:
        """Points (n,) of the grid of the B-splines, and Theta there."""
        return self._exact_on(self._lines(SPLINE_POINTS))

    def _exact_on(self, lines: Sequence[Array]) -> tuple[Array, Array, Jet]:
        """Points (n,) of the grid of lines of the profile coordinate and the cone distance, and Theta there."""
        rho, z = (part.ravel() for part in self.places(*lines))
        return rho, z, self._exact(rho, z)

    def _lines(self, points: tuple[int, int]) -> tuple[Array, Array]:
        """Profile coordinates and cone distances of the grid lines."""
        return chebyshev_nodes((0.0, self.mean_height), points[0]), chebyshev_nodes(self.cone_distances, points[1])

    def _fitted(self, values: Array) -> TensorSpline:
        """B-spline through values at the nodes."""
        profile, distance = self._lines((values.shape[0], values.shape[1]))
        grid = np.meshgrid(profile, distance - self.mean_cone_distance, indexing="ij")
        return fit(grid[0], grid[1], values, (SPLINE_DEGREE, SPLINE_DEGREE))

    def __repr__(self) -> str:
        return f"GeneratedFlank({self.owner})"


@lru_cache(maxsize=MOST_FLANKS)
def generated_flank(gear: FaceMilledGear, flank: FlankName) -> GeneratedFlank:
    """Exact flank of a gear, made once for its thickness, its angles and its teeth."""
    return GeneratedFlank(gear, flank)


def tooth_angle(gear: FaceMilledGear, rho: Array, z: Array) -> Array:
    """Angle of the tooth between its two flanks at (rho, z), (n,) each, both cut at one machine setting [rad].

    Negative where they have crossed; a whole pitch where one of them is not cut at all.
    """
    names: tuple[FlankName, FlankName] = ("concave", "convex")
    cuts = [CradleGeneration(gear.cutter.blade(name), name, gear.machine).solve(rho, z) for name in names]
    slot = cuts[1].theta.value - cuts[0].theta.value
    return 2.0 * math.pi / gear.teeth - np.where(cuts[0].found & cuts[1].found, slot, 0.0)


@lru_cache(maxsize=MOST_FLANKS)
def tooth_angle_at(gear: FaceMilledGear, rho: float, z: float) -> float:
    """Angle of the tooth at one point [rad], which its form and the sheets of its geometry ask for in turn."""
    return float(tooth_angle(gear, np.array([rho]), np.array([z]))[0])


def _gradient(rho: Array, theta: Jet) -> Array:
    """|grad F| of a surface [1/mm]."""
    return np.sqrt(1.0 / rho**2 + theta.rho**2 + theta.z**2)


def _stack(jet: Jet) -> Array:
    """The six parts of a jet (6, n)."""
    return np.stack([jet.value, jet.rho, jet.z, *jet.bends])


MOST_STEPS = 50
RESOLVED = 1e-14
"""Steps of Newton's method, and the one that ends it [rad]."""


def conjugate_flank(
    wheel: GeneratedFlank, frame: OffsetFrame, ratio: float, rho: float, z: float
) -> tuple[Array, Array]:
    """Slopes and second derivatives of the flank that is conjugate to the wheel's, in the frame of the pinion.

    Parameters
    ----------
    wheel : GeneratedFlank
    frame : OffsetFrame
        Of the wheel, without errors.
    ratio : float
        z1/z2.
    rho, z : float [mm]
        Place on the pinion.

    Returns
    -------
    (2,) array [rad/mm], (3,) array [rad/mm^2]
        By (rho, z), and by (rho rho, rho z, z z).

    Raises
    ------
    GeometryError
        If no turn brings the wheel into contact there.
    """
    azimuth = 0.0
    for _ in range(MOST_STEPS):
        slopes, bends = _off_the_wheel(wheel, frame, rho, azimuth, z)
        step = -(slopes[1] + ratio) / bends[1, 1]
        azimuth += step
        if abs(step) < RESOLVED:
            break
    else:
        raise GeometryError(
            f"{wheel.owner}: it is in contact nowhere at rho = {plain(rho, 6)}, z = {plain(z, 6)} mm of the pinion"
        )
    envelope = (bends - np.outer(bends[1], bends[1]) / bends[1, 1]) / ratio
    return slopes[[0, 2]] / ratio, np.array([envelope[0, 0], envelope[0, 2], envelope[2, 2]])


def _off_the_wheel(
    wheel: GeneratedFlank, frame: OffsetFrame, rho: float, azimuth: float, z: float
) -> tuple[Array, Array]:
    """Gradient (3,) and second derivatives (3, 3) of Phi by (rho, alpha, z) of the pinion."""
    radial = np.array([cos(azimuth), sin(azimuth), 0.0])
    around, axial = np.array([-radial[1], radial[0], 0.0]), np.array([0.0, 0.0, 1.0])
    x, y, height = frame.axes @ (rho * radial + z * axial - frame.origin)
    radius = hypot(x, y)
    out, turned = np.array([x, y, 0.0]) / radius, np.array([-y, x, 0.0]) / radius
    theta = wheel.theta(np.array([radius]), np.array([height]))
    by_rho, by_z, (rho_rho, rho_z, z_z) = theta.rho[0], theta.z[0], (part[0] for part in theta.bends)
    gradient = turned / radius - by_rho * out - by_z * axial
    bends = np.outer(out, turned) * (-1.0 / radius**2) - rho_z * np.outer(out, axial)
    bends = bends + bends.T
    bends -= rho_rho * np.outer(out, out) + z_z * np.outer(axial, axial) + by_rho / radius * np.outer(turned, turned)
    gradient, bends = frame.axes.T @ gradient, frame.axes.T @ bends @ frame.axes
    ways = np.array([radial, rho * around, axial])
    curved = ways @ bends @ ways.T
    curved[0, 1] += around @ gradient
    curved[1, 0] += around @ gradient
    curved[1, 1] -= rho * radial @ gradient
    return ways @ gradient, curved
