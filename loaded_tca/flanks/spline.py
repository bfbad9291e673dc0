r"""B-spline flanks: fitted to a grid of points of any flank, or to a measured topography.

.. math:: \Theta = \Theta_n(\rho, z) + S\big(p(\rho, z),\, l(\rho, z)\big)

S is a tensor B-spline over the coordinates of a nominal flank, p along the profile (roll length, unwound arc) and l
lengthwise. In them flanks are smooth even where the profile bends without bound, at the base circle; edges, grid and
coordinates stay those of the nominal flank. A flank that is *fitted* has no other surface than its spline
(Theta_n = 0); one that is *measured* deviates from its nominal surface by the spline, so that a coarse grid of small
deviations keeps the exact macro geometry. Grids of points in rows and columns that no spline fits are refused.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError, give_accuracy_warning
from loaded_tca.flanks.base import DerivedFlank, Flank, Jet, Region, unmodified
from loaded_tca.flanks.tensor_spline import TensorSpline, fit
from loaded_tca.flanks.topography import Topography, excess_problems
from loaded_tca.plain import plain

FEWEST_POINTS = {3: 4, 5: 6}
"""Degree of a B-spline -> points, or coefficients, that it needs in its direction."""
OFF_FLANK = 0.05
"""Part of the flank's height by which points may lie beyond its edges."""
UNCOVERED = 0.15
"""Part of the flank's height or width beyond the outermost points, at one end, from which on a warning is due."""
LEAST_COVERED = 0.5
"""Part of the flank's height and width that the points have to cover."""
DIRECTIONS = ("profile", "lengthwise")


@dataclass(frozen=True, eq=False)
class StructuredGrid:
    """Coordinates of points on a flank, both growing along their axis.

    Attributes
    ----------
    radius, axial : (n, m) array [mm]
        Cylindrical coordinates, as given.
    profile, lengthwise : (n, m) array
        Coordinates of the flank, in the order in which they grow.
    reversed_axes : tuple of int
        Axes along which the points were given the other way round.
    """

    radius: Array
    axial: Array
    profile: Array
    lengthwise: Array
    reversed_axes: tuple[int, ...]

    @classmethod
    def of(cls, flank: Flank, radius: Array, axial: Array) -> StructuredGrid:
        """Grid of the points (radius, axial) [mm], (n, m) each."""
        coordinates = flank_coordinates(flank, radius, axial)
        back = tuple(axis for axis, at in enumerate(coordinates) if _ends(at, axis)[1] < _ends(at, axis)[0])
        profile, lengthwise = (np.flip(at, back) for at in coordinates)
        return cls(radius, axial, profile, lengthwise, back)

    def ordered(self, values: Array) -> Array:
        """Values (n, m) at the points, in the order of ``profile`` and ``lengthwise``."""
        return np.flip(np.broadcast_to(values, self.radius.shape), self.reversed_axes)

    def degrees(self, wanted: int | None) -> tuple[int, int]:
        """Degrees along the profile and lengthwise; default: the highest that the points allow."""
        first, second = (5 if count >= FEWEST_POINTS[5] else 3 for count in self.radius.shape)
        return (first, second) if wanted is None else (wanted, wanted)

    def problems(self, flank: Flank, degrees: tuple[int, int], counts: tuple[int, int]) -> list[str]:
        """Everything that keeps the points from being fitted, a sentence each."""
        return self._too_coarse(degrees, counts) or [
            *self._off_the_flank(flank),
            *(self._disorder() or self._folds() or self._too_small(flank)),
        ]

    def warn_if_uncovered(self, flank: Flank) -> None:
        """Warn where the fit is continued far beyond the points."""
        for name, ends in zip(DIRECTIONS, self._uncovered(flank), strict=True):
            if max(ends) > UNCOVERED:
                names = flank.frame.edges[1::-1] if name == DIRECTIONS[0] else flank.frame.edges[2:]
                left = " and ".join(
                    f"{100.0 * max(end, 0.0):.0f} % at the {edge}" for end, edge in zip(ends, names, strict=True)
                )
                give_accuracy_warning(kinds.UNCOVERED.sentence(direction=name, left=left))

    def _too_coarse(self, degrees: tuple[int, int], counts: tuple[int, int]) -> list[str]:
        problems = []
        for name, degree, count, points in zip(DIRECTIONS, degrees, counts, self.radius.shape, strict=True):
            least = FEWEST_POINTS.get(degree)
            if least is None:
                problems.append(f"degree: {degree!r}; allowed {' or '.join(map(str, FEWEST_POINTS))}")
            elif points < least:
                problems.append(f"{name}: {points} points are too coarse; a B-spline of degree {degree} needs {least}")
            elif not least <= count <= points:
                allowed = f"{least} (degree {degree}) to {points}, the number of points"
                problems.append(f"coefficients: {count} ({name}); allowed {allowed}")
        return problems

    def _off_the_flank(self, flank: Flank) -> list[str]:
        """Points beyond the edges: of another gear, in another frame or in other units."""
        problems = []
        for name, edge in zip(flank.frame.edges, flank.edges(self.radius, self.axial), strict=True):
            beyond = -np.broadcast_to(edge.value, self.radius.shape)
            count = int((beyond > OFF_FLANK * min(flank.extent)).sum())
            if count:
                points = f"{count} of {beyond.size} points lie off the flank, up to {plain(beyond.max())} mm"
                problems.append(f"{points} beyond the {name}: wrong gear, frame or unit?")
        return problems

    def _disorder(self) -> list[str]:
        """Lines out of order."""
        problems = []
        for axis, (name, at) in enumerate(zip(DIRECTIONS, (self.profile, self.lengthwise), strict=True)):
            steps = np.diff(at.mean(axis=1 - axis))
            if not (steps > 0.0).all():
                line = int(np.argmax(steps <= 0.0)) + 1
                problems.append(
                    f"points are out of order: the {name} coordinate does not grow, or fall, all along axis {axis} "
                    f"(lines {line} and {line + 1}); axes are (profile, lengthwise)"
                )
        return problems

    def _folds(self) -> list[str]:
        """Cells that are turned over."""
        u, v = (at / np.ptp(at) for at in (self.profile, self.lengthwise))
        along, across = (np.diff(u, axis=0), np.diff(v, axis=0)), (np.diff(u, axis=1), np.diff(v, axis=1))
        # the four corners of each cell
        areas = [
            along[0][:, j] * across[1][i, :] - along[1][:, j] * across[0][i, :]
            for i in (slice(None, -1), slice(1, None))
            for j in (slice(None, -1), slice(1, None))
        ]
        folded = np.min(areas, axis=0) <= 0.0
        if not folded.any():
            return []
        row, column = (int(part) for part in np.argwhere(folded)[0])
        radius, axial = (plain(self.ordered(one)[row, column]) for one in (self.radius, self.axial))
        where = f"{int(folded.sum())} of {folded.size} cells, first at radius {radius}, axial {axial} mm"
        return [f"points are folded, or lie on each other: {where}"]

    def _too_small(self, flank: Flank) -> list[str]:
        return [
            f"{name}: the points cover {100.0 * (1.0 - sum(ends)):.0f} % of the flank; at least "
            f"{100.0 * LEAST_COVERED:.0f} % is needed"
            for name, ends in zip(DIRECTIONS, self._uncovered(flank), strict=True)
            if 1.0 - sum(ends) < LEAST_COVERED
        ]

    def _uncovered(self, flank: Flank) -> list[tuple[float, float]]:
        """Parts of the flank before the first and after the last line, along the profile and lengthwise."""
        whole = flank_coordinates(flank, *flank.grid(9, 9))
        parts = []
        for axis, (at, region) in enumerate(zip((self.profile, self.lengthwise), whole, strict=True)):
            first, last = _ends(at, axis)
            low, high = region.min(), region.max()
            parts.append((float((first - low) / (high - low)), float((high - last) / (high - low))))
        return parts


def flank_coordinates(flank: Flank, rho: Array, z: Array) -> tuple[Array, Array]:
    """Profile and lengthwise coordinate at points (rho, z), arrays of their shape."""
    shape = np.broadcast(rho, z).shape
    jets = flank.profile_coordinate(rho, z), flank.lengthwise_coordinate(rho, z)
    first, second = (np.broadcast_to(jet.value, shape) for jet in jets)
    return first, second


def _ends(at: Array, axis: int) -> tuple[float, float]:
    """Means of the first and of the last line."""
    lines = at if axis == 0 else at.T
    return float(lines[0].mean()), float(lines[-1].mean())


DEFAULT_POINTS = (33, 33)
"""Points of a fitted flank along the profile and lengthwise."""
FIT_TOLERANCE = 1e-4
"""Distance [mm] between a flank and its B-spline beyond which a warning says so."""
SWING = 0.1
"""Part of the span of measured deviations by which those of the flank may leave their range. The range holds that of a
biquadratic surface, which follows slopes, crownings and twist up to the edges; what leaves it by as much as this is
ruled by the noise, or the waves, of the outermost points."""
PITCH_POINT_STEPS = 50


@dataclass(frozen=True)
class FitError:
    """Distance along the normal between a B-spline flank and the points it stands for.

    Attributes
    ----------
    largest, rms : float [mm]
    """

    largest: float
    rms: float

    @classmethod
    def of(cls, distances: Array) -> FitError:
        """From the distances at the points [mm]."""
        return cls(float(np.abs(distances).max()), float(np.sqrt((distances**2).mean())))

    def __str__(self) -> str:
        return f"{plain(1e3 * self.largest, 3)} um at most, {plain(1e3 * self.rms, 3)} um rms"


@checked
class SplineFlank(DerivedFlank):
    """Theta of a nominal flank plus a tensor B-spline over its profile and lengthwise coordinates.

    Parameters
    ----------
    nominal : Flank
        Gives region, coordinates, |grad F| and the surface that the spline deviates from; a ``Region`` has none.
    spline : TensorSpline
        Deviation of Theta [rad] over (profile coordinate, lengthwise coordinate).
    fit_error : FitError
        At the points that the spline was fitted to.
    check_error : FitError, optional
        Midway between the points, where the flank is known there.
    """

    def __init__(
        self, nominal: Flank, spline: TensorSpline, fit_error: FitError, check_error: FitError | None = None
    ) -> None:
        super().__init__(nominal)
        self.spline, self.fit_error, self.check_error = spline, fit_error, check_error

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:
        """Theta of the nominal flank plus the spline."""
        profile, lengthwise = self.profile_coordinate(rho, z), self.lengthwise_coordinate(rho, z)
        deviation = self.spline(profile.value, lengthwise.value).compose(profile, lengthwise)
        return self.nominal.theta(rho, z, beyond) + deviation

    def relief_starts(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Relief starts of the nominal flank."""
        return self.nominal.relief_starts(rho, z)

    def distance_to(self, other: Flank, rho: Array, z: Array) -> Array:
        """Distance [mm] along the normal from another flank of the same gear, positive where this one has more."""
        turn = self.theta(rho, z).value - other.theta(rho, z).value
        return self.side * turn / other.gradient_norm(rho, z).value

    def __repr__(self) -> str:
        counts = " x ".join(str(count) for count in self.spline.coefficients.shape)
        return f"SplineFlank({counts} coefficients, fit error {self.fit_error})"


def fitted(flank: Flank, points: tuple[int, int] = DEFAULT_POINTS, degree: int = 5) -> SplineFlank:
    """B-spline flank through a grid of points of any flank; its zero of theta stays where it is.

    Parameters
    ----------
    flank : Flank
    points : (int, int)
        Along the profile and lengthwise, evenly spaced in the flank's own coordinates; above the degree.
    degree : int
        5: curvatures are twice continuously differentiable; 3 is enough for the shape.

    Returns
    -------
    SplineFlank
        With ``fit_error`` at the points and ``check_error`` midway between them.

    Warns
    -----
    AccuracyWarning
        If the B-spline misses the flank by more than 0.1 um: a relief start (the start of a linear relief) is rounded
        off.

    Raises
    ------
    InputError
        If there are fewer points than the degree needs.

    References
    ----------
    Piegl & Tiller 1997, The NURBS Book, section 9.2 (surface interpolation).

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> wheel = fitted(cylindrical_pair(CylindricalMesh(*gears)).wheel.flank)
    >>> wheel.check_error.largest < 1e-9
    True
    """
    least = FEWEST_POINTS.get(degree)
    if least is None:
        raise InputError(f"degree: {degree!r}; allowed {' or '.join(map(str, FEWEST_POINTS))}")
    if min(points) < least:
        raise InputError(f"points: {points[0]} x {points[1]} are too coarse for degree {degree}; at least {least} each")
    region, (rho, z) = Region(flank), flank.grid(*points)
    spline = fit(*flank_coordinates(flank, rho, z), flank.theta(rho, z).value, (degree, degree))
    bare = SplineFlank(region, spline, FitError(0.0, 0.0))
    between = (part[1::2, 1::2] for part in flank.grid(2 * points[0] - 1, 2 * points[1] - 1))
    check = FitError.of(bare.distance_to(flank, *between))
    if check.largest > FIT_TOLERANCE:
        message = kinds.COARSE_FIT.sentence(points=f"{points[0]} x {points[1]}", error=check)
        give_accuracy_warning(message)
    return SplineFlank(region, spline, FitError.of(bare.distance_to(flank, rho, z)), check)


def smoothing_coefficients(points: tuple[int, int], degree: int | None = None) -> tuple[int, int]:
    """B-spline coefficients along the profile and lengthwise that smooth a measurement of so many points.

    Half as many as points and two, but as many as the degree needs, and no more than there are points: what is left
    follows crowning, slopes, twist and reliefs that several points see, and 0.6 of the noise.

    Examples
    --------
    >>> smoothing_coefficients((9, 15)), smoothing_coefficients((5, 9), 3), smoothing_coefficients((4, 6))
    ((6, 9), (4, 6), (4, 6))
    """
    first, second = (
        min(count, max(count // 2 + 2, FEWEST_POINTS[degree or (5 if count >= FEWEST_POINTS[5] else 3)]))
        for count in points
    )
    return first, second


def measured(
    nominal: Flank,
    topography: Topography,
    *,
    degree: int | None = None,
    coefficients: tuple[int, int] | None = None,
    turned: bool = True,
) -> SplineFlank:
    """Flank of a measured topography: the nominal one, deviating as measured.

    Beyond the outermost points the deviation goes on as a parabola. Put it into a pair by
    ``pair.with_flanks(wheel=measured(pair.wheel.flank, topography))``.

    Parameters
    ----------
    nominal : Flank
        The flank that the deviations were measured from; its modifications, if it has any, are part of it.
    topography : Topography
        ``MeasuredPoints`` or ``MeasuredDeviations``, or what ``read_topography`` returns.
    degree : int, optional
        3 or 5 in both directions. Default: 5 from six points on, else 3.
    coefficients : (int, int), optional
        Fewer B-spline coefficients than points along the profile and lengthwise: a fit of least squares that smooths
        the noise of measurement, told by ``fit_error``. Default: through every point.
    turned : bool
        Turn the flank about its axis until it holds the pitch point (theta = 0). False: keep the zero of the data.

    Returns
    -------
    SplineFlank

    Warns
    -----
    AccuracyWarning
        If the outermost points leave more than 15 % of the flank uncovered at an end, or the flank leaves the range of
        the measured deviations, where it is continued beyond them, by more than 10 % of their span and 0.1 um.

    Raises
    ------
    InputError
        If the grid is too coarse, folded, unordered, off the flank or covers less than half of it, or if the points
        are further from the nominal flank than a deviation can be; all problems at once.
    GeometryError
        If the flank has no pitch point to be turned to.

    Examples
    --------
    >>> from loaded_tca.flanks.topography import MeasuredDeviations
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> nominal = cylindrical_pair(CylindricalMesh(*gears)).wheel.flank
    >>> radius, axial = nominal.grid(5, 9)
    >>> hollow = measured(nominal, MeasuredDeviations(radius, axial, 0.01 * (axial / 12.5) ** 2))
    >>> round(float(hollow.distance_to(nominal, radius, axial)[2, 8]), 9)
    0.01
    """
    topography.require_no_weights()
    data = StructuredGrid.of(nominal, topography.radius, topography.axial)
    degrees, counts = data.degrees(degree), coefficients or (data.radius.shape[0], data.radius.shape[1])
    problems = data.problems(nominal, degrees, counts)
    if problems:
        raise InputError(problems)
    data.warn_if_uncovered(nominal)
    excess = topography.excess_over(nominal, turned)
    problems = excess_problems(nominal, excess)
    if problems:
        raise InputError(problems)
    angles = nominal.side * nominal.gradient_norm(topography.radius, topography.axial).value
    wanted = data.ordered(excess * angles)
    spline = fit(data.profile, data.lengthwise, wanted, degrees, counts)
    missed = (spline(data.profile, data.lengthwise).value - wanted) / data.ordered(angles)
    _warn_if_swinging(nominal, excess, spline, fit(data.profile, data.lengthwise, wanted, (2, 2), (3, 3)))
    if turned:
        bare = SplineFlank(nominal, spline, FitError(0.0, 0.0))
        spline = spline.shifted(-float(bare.theta(*pitch_point(bare)).value))
    return SplineFlank(nominal, spline, FitError.of(missed))


def _warn_if_swinging(nominal: Flank, excess: Array, spline: TensorSpline, smooth: TensorSpline) -> None:
    """Warn where the deviations of a flank leave those of its points and of a smooth surface through them."""
    rho, z = nominal.grid(*DEFAULT_POINTS)
    at = flank_coordinates(nominal, rho, z)
    angles = nominal.side * nominal.gradient_norm(rho, z).value
    splined, smoothed = (one(*at).value / angles for one in (spline, smooth))
    known = np.concatenate([excess.ravel(), smoothed.ravel()])
    beyond, span = max(known.min() - splined.min(), splined.max() - known.max()), float(np.ptp(excess))
    if beyond > max(SWING * span, FIT_TOLERANCE):
        from_to = (f"{plain(1e3 * one.min(), 3)} to {plain(1e3 * one.max(), 3)} um" for one in (excess, splined))
        give_accuracy_warning(kinds.SWINGS.sentence(points=next(from_to), flank=next(from_to)))


def pitch_point(flank: Flank) -> tuple[Array, Array]:
    """(rho, z) of the point with theta = 0 in the middle of the face, on the flank without modifications [mm].

    Raises
    ------
    GeometryError
        If the flank, continued beyond its edges, has none.
    """
    flank = unmodified(flank)
    middle = np.array([float(part[1, 1]) for part in flank.grid(3, 3)])
    place = middle.copy()
    for _ in range(PITCH_POINT_STEPS):
        jets = flank.theta(place[0], place[1]), flank.lengthwise_coordinate(place[0], place[1])
        slopes = np.array([[jet.rho, jet.z] for jet in jets], dtype=float)
        step = np.linalg.solve(slopes, [-float(jet.value) for jet in jets])
        place += step * min(1.0, float((0.5 * np.asarray(flank.extent) / np.maximum(np.abs(step), 1e-300)).min()))
        if np.abs(step).max() < 1e-12 * flank.extent[0]:
            return np.array(place[0]), np.array(place[1])
    where = flank.frame.place(*middle)
    raise GeometryError(f"the flank around {where} has no pitch point (theta = 0 in the middle of the face)")
