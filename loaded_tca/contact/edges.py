r"""Edges of half-spaces in the plane of a grid: free ones, beside which a body is softer, and rounded ones.

Pressure on a half-space would leave stresses on the plane where the body really ends. The same pressure mirrored in
that plane takes the shear off it and doubles the displacement of the half-space there; the rest is tension across
the plane, twice that of the half-space, and taking it off softens the edge again. Both together are close to
a single image of the pressure, multiplied by a factor psi that depends on Poisson's ratio and on the angle of the
material between the surface and the plane (90 deg at the face end of a spur tooth, more at its tip):

.. math:: u = K (p + \psi\, p_{mirrored})

The influence matrix stays symmetric, and it stays positive definite for every psi >= 0: with K = T + psi H, H is the
kernel 1/r of cells and images, a sum of decaying exponentials of the distance from the plane.

References
----------
Hetenyi 1960, J. Appl. Mech. 27, 289-296 (quarter-space by overlapping half-spaces); Keer, Lee & Mura 1983, Int. J.
Solids Struct. 19, 337-352 (the same in three dimensions); Guilbault 2011, J. Tribol. 133, 031402 (one image and a
factor; the factor here is fitted anew); Michell 1902, Proc. London Math. Soc. 34, 134-146 (force at the apex of a
wedge; Timoshenko & Goodier 1970, Theory of Elasticity, art. 38).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from loaded_tca.arrays import Array, real
from loaded_tca.contact.convolution import ALL, Convolution, Rows, Window
from loaded_tca.errors import InputError
from loaded_tca.plain import plain

# psi = c0 + c1 nu + c2 nu^2, between what Hetenyi's solution gives for Hertz circles of radius a centred 0 to 1.5 a
# from the edge (1.30 to 1.34 at nu = 0, 1.76 to 1.81 at 0.3) and for strips that end at it (1.21 to 1.25 and 1.70 to
# 1.72); see validation/contact/free_edge.py.
FACTOR = (1.28, 0.44, 3.7)
# Of the ratio by the angle of a wedge: at angles of 30 to 150 deg and nu = 0.3 between what strips along the edge and
# across it ask for, see validation/contact/wedge.py.
POWER = 1.07
SHARPEST = math.radians(30.0)
ALIGNED = 1e-3
"""Sine of the angle between an edge and the columns up to which their borders follow it."""
VARIATION, MEAN_PLACE = 0.4, 0.9
"""psi right across an edge of 90 deg is that of the mean place and VARIATION (S - MEAN_PLACE)."""
MOST_FACTOR = 0.6
"""Of the image at the edge of a wedge, up to which the iteration converges: 103 deg of like materials."""
# Part of a cell by which the place of an edge may miss half cells and count as there.
WHOLE = 1e-9


@dataclass(frozen=True)
class FreeEdge:
    """A straight edge along an axis of the grid, where one body or both end.

    Parameters
    ----------
    axis : {0, 1}
        The axis that the edge is crossed along: 0 for an edge x = const, 1 for y = const.
    position : float [mm]
        Distance from the outer border of the first cell along that axis.
    material : {"below", "above"}
        On which side of the position the bodies are; the cells beyond carry nothing.
    factor : float
        psi, not negative; see :func:`wedge_factor`. Zero: a half-space that merely carries nothing beyond.
    across : (float, float), optional
        psi of places right across the edge from each other, for S = 0 and for S = 1, on columns of unlike widths
        alone; see :func:`factors_across`. ``factor`` is then that of places far apart along the edge.
    """

    axis: int
    position: float
    material: Literal["below", "above"]
    factor: float
    across: tuple[float, float] | None = None


@dataclass(frozen=True)
class RoundedEdge:
    """A straight line in the plane of a grid, beyond which a surface is rounded.

    Parameters
    ----------
    place : (float, float) [mm]
        A point of the line where the rounding begins.
    normal : (float, float)
        Across the line, towards the end of the surface; of any length.
    radius : float [mm]
        Of the rounding.
    angle : float, optional [rad]
        Of the material between the surface and the land beyond the rounding, from pi/6 to pi: the surface is softer
        towards the edge and tilts. Of a half-space if absent.
    share : float
        Of the body that ends in the compliance, E* (1 - nu1^2)/E1: a half of like materials.
    """

    place: tuple[float, float]
    normal: tuple[float, float]
    radius: float
    angle: float | None = None
    share: float = 0.5

    @property
    def direction(self) -> Array:
        """The normal as a unit vector (2,)."""
        return np.array(self.normal, dtype=float) / math.hypot(*self.normal)

    def free_edge(self, low: float) -> FreeEdge | None:
        """The apex of its wedge, from the first border of the columns on; None without one or across them."""
        if self.angle is None or abs(self.normal[0]) > ALIGNED * math.hypot(*self.normal):
            return None
        side = math.copysign(1.0, self.normal[1])
        apex = self.place[1] + side * self.radius * math.tan(0.5 * (math.pi - self.angle))
        factor = min(self.share * extra_displacement(self.angle), MOST_FACTOR)
        return FreeEdge(1, apex - low, "below" if side > 0.0 else "above", factor)


@dataclass(frozen=True)
class Mirror:
    """A free edge in whole numbers: cell j of a window has its image at ``double - 1 - j``."""

    axis: int
    double: int
    factor: float


def quarter_space_factor(poisson_ratio: float, share: float = 1.0) -> float:
    r"""Factor psi of the mirrored pressure for a body that ends at right angles to its surface.

    .. math:: \psi = s (1.28 + 0.44 \nu + 3.7 \nu^2)

    It gives the mean displacement of a quarter-space under contacts that reach the edge or are cut by it within 2 %,
    and 6 % too much displacement at the edge itself, for nu = 0.3 (``docs/studies/contact_solver.md``).

    Parameters
    ----------
    poisson_ratio, share
        As for :func:`wedge_factor`.

    Returns
    -------
    float

    Examples
    --------
    >>> round(quarter_space_factor(0.3), 3)
    1.745
    >>> round(quarter_space_factor(0.3, share=0.5), 4)
    0.8725
    """
    return wedge_factor(0.5 * math.pi, poisson_ratio, share)


def wedge_factor(angle: float, poisson_ratio: float, share: float = 1.0) -> float:
    r"""Factor psi of the mirrored pressure for a body that ends at an edge of any angle.

    .. math:: \psi = s (1.28 + 0.44 \nu + 3.7 \nu^2) \left(\frac{m(\omega)}{m(90^\circ)}\right)^{1.07}, \qquad
              m = \pi \frac{\omega + \sin\omega \cos\omega}{\omega^2 - \sin^2\omega} - 1

    1 + m is how much softer than a half-space a wedge is, seen from afar, under a line load normal to its face at
    its edge (Michell); the power is fitted. At 105 to 135 deg and nu = 0.3 it gives the mean displacement under
    contacts that reach the edge within 4 % (``docs/studies/contact_solver.md``).

    Parameters
    ----------
    angle : float [rad]
        omega, of the material between the loaded surface and the other one, from pi/6 to pi: pi/2 at the face end of
        a spur tooth, pi/2 and the pressure angle there at its tip, pi for a surface that goes on.
    poisson_ratio : float
        Of the body that ends, between 0 and 0.5.
    share : float
        Share s of the bodies that end there in the compliance, between 0 and 1: E* (1 - nu1^2)/E1 where body 1 alone
        ends. Where both end at one angle, s is 1; at angles of their own their factors add up.

    Returns
    -------
    float

    Raises
    ------
    InputError
        With every problem of the arguments.

    Examples
    --------
    >>> round(wedge_factor(math.radians(115.0), 0.3), 3)
    0.396
    >>> round(wedge_factor(math.pi, 0.3), 9)
    0.0
    """
    problems = []
    if not SHARPEST <= angle <= math.pi:
        problems.append(f"angle: {plain(math.degrees(angle), 6)} degrees is not between 30 and 180 degrees")
    if not 0.0 <= poisson_ratio <= 0.5:
        problems.append(f"poisson_ratio: {poisson_ratio} is not between 0 and 0.5")
    if not 0.0 <= share <= 1.0:
        problems.append(f"share: {share} is not between 0 and 1")
    if problems:
        raise InputError(problems)
    constant, linear, quadratic = FACTOR
    square = constant + poisson_ratio * (linear + poisson_ratio * quadratic)
    return share * square * (extra_displacement(angle) / AT_RIGHT_ANGLES) ** POWER


def factors_across(angle: float, poisson_ratio: float, share: float = 1.0) -> tuple[float, float]:
    r"""Factors psi of places right across an edge from each other, for S = 0 and for S = 1.

    .. math:: \psi(S) = \psi_\omega \left(1 + \frac{0.4}{\psi_{90^\circ}} (S - 0.9)\right), \qquad
              S = \frac{4 d d'}{(d + d')^2}

    d and d' are the distances of both places from the edge. A quarter-space, solved slice by slice for Poisson's ratios
    of 0 to 0.45, has this factor for a narrow line load across its edge. A place that is away by x along the edge, too,
    has the factor psi(S) + (m - psi(S)) x^2/R^2, R^2 = x^2 + (d + d')^2, with m of :func:`extra_displacement`: a load
    all along the edge then displaces as in plane strain, whose dependence on S is 0.38 to 0.40 S at 90 deg. The peak of
    a contact that crosses the rounded ends of both bodies is within 5 % of that of a quarter-space for nu = 0.3
    (``validation/contact/rounded_ends.py``).

    Parameters
    ----------
    angle, poisson_ratio, share
        As for :func:`wedge_factor`.

    Returns
    -------
    (float, float)

    Examples
    --------
    >>> [round(psi, 3) for psi in factors_across(0.5 * math.pi, 0.3)]
    [1.385, 1.785]
    """
    psi, scale = wedge_factor(angle, poisson_ratio, share), VARIATION / quarter_space_factor(poisson_ratio)
    return psi * (1.0 - scale * MEAN_PLACE), psi * (1.0 + scale * (1.0 - MEAN_PLACE))


def extra_displacement(angle: float) -> float:
    r"""Displacement of a wedge beyond that of a half-space, over the latter, under a line load at the edge.

    It is m of :func:`wedge_factor`, and the factor of an image that tilts the surface as in plane strain: a line load
    P, s from the edge, adds the tilt m P/(pi E* s) where it is, and -2 m/(pi E*) P ln(x) far away, as the image
    -2 m/(pi E*) P ln(x + s) does. Between s/4 and 4 s the image is within 3 % of the range of the exact displacement
    (:func:`loaded_tca.reference.wedge.extra_displacement`) from 105 deg on, at 90 deg within 5 %.

    Parameters
    ----------
    angle : float [rad]
        omega, of the material.

    Returns
    -------
    float

    References
    ----------
    Michell 1902, Proc. London Math. Soc. 34, 134-146.

    Examples
    --------
    >>> round(extra_displacement(math.radians(115.0)), 3)
    0.591
    """
    sine, cosine = math.sin(angle), math.cos(angle)
    return max(0.0, math.pi * (angle + sine * cosine) / (angle * angle - sine * sine) - 1.0)


AT_RIGHT_ANGLES = extra_displacement(0.5 * math.pi)


def check_edges(edges: Sequence[FreeEdge]) -> list[str]:
    """Problems of the free edges."""
    if not (isinstance(edges, Sequence) and all(isinstance(edge, FreeEdge) for edge in edges)):
        return [f"free_edges: {edges!r:.60} is not a sequence of FreeEdge"]
    problems = []
    for k, edge in enumerate(edges):
        if edge.axis not in (0, 1):
            problems.append(f"free_edges[{k}].axis: {edge.axis} is neither 0 nor 1")
        if not math.isfinite(real(edge.position)):
            problems.append(f"free_edges[{k}].position: {edge.position} mm is not finite")
        if edge.material not in ("below", "above"):
            problems.append(f'free_edges[{k}].material: {edge.material!r} is neither "below" nor "above"')
        if not 0.0 <= real(edge.factor) < math.inf:
            problems.append(f"free_edges[{k}].factor: {edge.factor} is negative or not finite")
        across = edge.across
        if across is not None and not (len(across) == 2 and all(0.0 <= real(psi) < math.inf for psi in across)):
            problems.append(f"free_edges[{k}].across: {across!r:.60} are not two finite numbers from 0 on")
    return problems


def check_even(edges: Sequence[FreeEdge]) -> list[str]:
    """Problems of the free edges on an even grid, whose images have one factor."""
    return [
        f"free_edges[{k}].across: {edge.across} counts on columns of unlike widths alone"
        for k, edge in enumerate(edges)
        if edge.across is not None
    ]


def without_material_beyond(
    gap: NDArray[np.float64], spacing: tuple[float, float], edges: tuple[FreeEdge, ...]
) -> NDArray[np.float64]:
    """The gap, infinite where the centre of a cell lies beyond an edge."""
    for edge in edges:
        middle = (np.ogrid[: gap.shape[0], : gap.shape[1]][edge.axis] + 0.5) * spacing[edge.axis]
        gap = np.where(middle > edge.position if edge.material == "below" else middle < edge.position, np.inf, gap)
    return gap


def mirrors(
    edges: tuple[FreeEdge, ...], spacing: tuple[float, float], starts: tuple[int, int] = (0, 0)
) -> tuple[Mirror, ...]:
    """The edges on a grid of a spacing, counted from a cell of it."""
    images = []
    for edge in edges:
        double = 2.0 * edge.position / spacing[edge.axis] - 2 * starts[edge.axis]
        first = math.floor(double + WHOLE)
        part = double - first
        shares = (1.0,) if part <= WHOLE else (1.0 - part, part)  # between half cells: those at either side
        images += [Mirror(edge.axis, first + n, share * edge.factor) for n, share in enumerate(shares)]
    return tuple(images)


def amplification(edges: tuple[FreeEdge, ...]) -> float:
    """Bound on how much the images add to a displacement: the factors of all of them, the pressure itself included."""
    by_axis = [1.0 + sum(edge.factor for edge in edges if edge.axis == axis) for axis in (0, 1)]
    return by_axis[0] * by_axis[1]


class MirroredConvolution:
    """Displacement of ``target`` cells under the pressure on a window of them and its images: of a stack of one.

    A corner of two edges across different axes mirrors the image too; edges across the same axis give one image
    each.

    Parameters
    ----------
    target, aspects, window, dtype, threads
        As for :class:`Convolution`, of one problem.
    edges : tuple of Mirror
        Counted from the first cell of the target.
    """

    def __init__(
        self,
        target: tuple[int, int],
        aspects: ArrayLike,
        edges: tuple[Mirror, ...],
        window: Window | None = None,
        dtype: str = "float64",
        threads: int = 2,
    ) -> None:
        starts = (0, 0) if window is None else (window[0].start, window[1].start)
        stops = target if window is None else (window[0].stop, window[1].stop)
        self._images = _images(edges, starts, stops)
        least = [min(place[axis][0] for place, _, _ in self._images) for axis in (0, 1)]
        most = [max(place[axis][1] for place, _, _ in self._images) for axis in (0, 1)]
        self._least, self._dtype = least, dtype
        self._loaded = np.zeros((1, most[0] - least[0], most[1] - least[1]), dtype=dtype)
        # Images below the first cell: the grid is counted from the first of them.
        shift = [max(0, -first) for first in least]
        extended = (target[0] + shift[0], target[1] + shift[1])
        within = tuple(slice(a + s, b + s) for a, b, s in zip(least, most, shift, strict=True))
        self._convolve = Convolution(extended, aspects, (within[0], within[1]), dtype, threads)
        self._displaced = np.empty((1, *extended), dtype=dtype)
        self._target = (slice(None), slice(shift[0], None), slice(shift[1], None))

    def __call__(self, pressure: Array, out: Array, _: Rows = ALL) -> Array:
        """Write the displacement into ``out`` and return it."""
        self._loaded[:] = 0.0
        for place, flips, factor in self._images:
            rows, columns = (slice(a - first, b - first) for (a, b), first in zip(place, self._least, strict=True))
            self._loaded[:, rows, columns] += factor * pressure[:, :: flips[0], :: flips[1]]
        self._convolve(self._loaded, self._displaced)
        np.copyto(out, self._displaced[self._target], casting="same_kind")
        return out


Image = tuple[tuple[tuple[int, int], tuple[int, int]], tuple[int, int], float]


def _images(edges: tuple[Mirror, ...], starts: tuple[int, int], stops: tuple[int, int]) -> list[Image]:
    """Place of the pressure and of every image of it, the direction it is read in along each axis, and its factor."""
    images: list[Image] = []
    corners = (pair for pair in combinations(edges, 2) if pair[0].axis != pair[1].axis)
    for reflections in ((), *((edge,) for edge in edges), *corners):
        place, flips, factor = [(starts[0], stops[0]), (starts[1], stops[1])], [1, 1], 1.0
        for edge in reflections:
            first, last = place[edge.axis]
            place[edge.axis], flips[edge.axis] = (edge.double - last, edge.double - first), -1
            factor *= edge.factor
        images.append(((place[0], place[1]), (flips[0], flips[1]), factor))
    return images
