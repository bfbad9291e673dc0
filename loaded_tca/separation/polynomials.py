"""Gap and distances to the edges about a contact point as polynomials: one sample serves all grids of a contact.

A contact is small against its flanks, and within a flank of one piece the gap along the normal, and the distances to
the edges, are as good as polynomials there. They are fitted, by least squares, to the coarse grid on which the contact
is estimated, whose points are three times as many as coefficients, so that what is left over tells whether they hold:
where a relief or the arc of a rounded edge begins, where a flank is a spline, or where the normals meet no flank, they
do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial.chebyshev import cheb2poly, chebvander

from loaded_tca.arrays import Array, Indices, Mask

DEGREES = (8, 14)
"""Of the polynomials, across and along: contacts are far longer than wide."""
MISFIT = 1e-10
"""Largest that polynomials may leave over on their grid [mm]: on cells of a micrometre 1e-5 of a pressure of 1 GPa."""
ROUNDING = 4e-12
"""The same over the largest value: sums of powers lose digits, of distances in windows of a metre as many, and not as
many with every kernel of BLAS: 0.3 to 1.03e-12 were seen of a distance of 463 mm."""
OUTSIDE = 1.25
"""How far, over the grid they are fitted to, distances to edges are told: their error grows a hundredfold till there,
to a hundredth of a micrometre."""


@dataclass(frozen=True, eq=False)
class GapPolynomials:
    """Polynomials of n contacts in coordinates of their tangent planes; none depends on the others.

    Attributes
    ----------
    reach : (n, 2) array [mm]
        Half lengths across and along of the rectangles about the contact points that they are fitted in.
    coefficients : (surfaces, n, across, along) array [mm]
        Of products of powers of the places over ``reach``: of the gap, and of the distance to each edge.

    Examples
    --------
    >>> x, y = np.linspace(-1.0, 1.0, 17), np.linspace(-1.0, 1.0, 33)
    >>> gap = (0.5 * x[:, None] ** 2 + 0.01 * (2.0 * y) ** 2)[None, None]
    >>> polynomials, holds = GapPolynomials.fitted(gap, np.array([[1.0, 2.0]]))
    >>> holds.tolist(), polynomials.surfaces(np.array([[0.3]]), np.array([[1.0]])).round(12).tolist()
    ([True], [[[[0.055]]]])
    """

    reach: Array
    coefficients: Array

    @classmethod
    def fitted(cls, surfaces: Array, reach: Array) -> tuple[GapPolynomials, Mask]:
        """Polynomials of surfaces (surfaces, n, nx, ny) on even grids from end to end, and of which contacts they hold.

        Those of the others mean nothing.
        """
        (across, fit_across), (along, fit_along) = (
            _least_squares(count, degree) for count, degree in zip(surfaces.shape[2:], DEGREES, strict=True)
        )
        met = np.asarray(np.isfinite(surfaces).all(axis=(0, 2, 3)))
        surfaces = np.where(met[:, None, None], surfaces, 0.0)
        coefficients = fit_across @ surfaces @ fit_along.T
        left = np.abs(across @ coefficients @ along.T - surfaces).max(axis=(2, 3))
        allowed = MISFIT + ROUNDING * np.abs(surfaces).max(axis=(2, 3))
        return cls(reach, coefficients), met & (left <= allowed).all(axis=0)

    @classmethod
    def together(cls, each: Sequence[GapPolynomials]) -> GapPolynomials:
        """Those of several contacts as one stack."""
        if len(each) == 1:
            return each[0]
        reach = np.concatenate([one.reach for one in each])
        return cls(reach, np.concatenate([one.coefficients for one in each], axis=1))

    def hold_in(self, x: Array, y: Array) -> bool:
        """Whether places (nx,) and (ny,) [mm] of a single contact lie within reach."""
        (across, along), *_ = self.reach.tolist()
        return bool(max(-x[0], x[-1]) <= across and max(-y[0], y[-1]) <= along)

    def of(self, rows: Indices | Mask) -> GapPolynomials:
        """Those of some of the contacts, or of the same ones more than once."""
        return GapPolynomials(self.reach[rows], self.coefficients[:, rows])

    def surfaces(self, x: Array, y: Array) -> Array:
        """Gap and distances to the edges [mm] (surfaces, n, nx, ny) where x (n, nx) and y (n, ny) [mm] cross."""
        across, along = (
            _powers(places / reach[:, None], degree)
            for places, reach, degree in zip((x, y), self.reach.T, DEGREES, strict=True)
        )
        return np.asarray(across @ self.coefficients @ along.mT)


@cache
def _least_squares(count: int, degree: int) -> tuple[Array, Array]:
    """Powers of even places from -1 to 1 (count, degree + 1), and what makes their coefficients of values there.

    By Chebyshev polynomials, which lose no digits.
    """
    places = np.linspace(-1.0, 1.0, count)
    in_powers = np.zeros((degree + 1, degree + 1))
    for k, chebyshev in enumerate(np.eye(degree + 1)):
        in_powers[: k + 1, k] = cheb2poly(chebyshev[: k + 1])
    return _powers(places, degree), in_powers @ np.linalg.pinv(chebvander(places, degree))


def _powers(places: Array, degree: int) -> Array:
    """Powers (..., degree + 1) of places (...) from 0 on."""
    powers = np.ones((*places.shape, degree + 1))
    powers[..., 1:] = places[..., None]
    return np.asarray(np.multiply.accumulate(powers, axis=-1))
