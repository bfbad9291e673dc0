r"""Golden-section search for the wheel angle at which the smallest gap between the flanks is nothing.

At given angles of both gears a point P of the pinion flank has the signed distance from the wheel flank

.. math:: g = s_2\,\frac{F_2(P)}{|\mathrm{grad}\,F_2|}, \qquad
          F_2 = \theta_2 - \Theta_2(\rho_2, z_2) + \sigma\varphi_2,

positive outside the wheel's material: exact in its sign and where it vanishes, and to first order elsewhere. The
smallest gap over the region that both flanks cover grows steadily as the wheel turns away, so its zero is the contact,
on the flank or on an edge. It is found by regula falsi on phi2; each smallest gap by golden sections, those along the
profile inside one along the face. No derivative is used.

The source searches the smallest *unsigned* distance over phi2. That has no single minimum: it is zero at every angle
at which the flanks interpenetrate. With its sign the search is sound. A golden section finds one basin: flanks that
touch in several (a hollow modification, two reliefs) are a matter for ``reduced``.

This is a reference to compare with: it shares the flanks with ``reduced`` and nothing else.

References
----------
The miter-gear paper (docs/reference/sources.md), "Contact point determination via the golden ratio method"; Kiefer
1953, Proc. AMS 4, 502-506.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, Mask, finite_row
from loaded_tca.errors import ConvergenceError, GeometryError, InputError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
SECTIONS = 44
"""Golden sections of one search: 6e-10 of the flank is left, so that a contact on an edge is placed as well. In the
interior, where the gap is level, 30 give the same angle."""
PENALTY = 4.0
"""Gap [mm] added for each mm beyond an edge: the gap itself falls by less than one."""
MOST_TURNS = 30
CLOSED = 1e-11
"""Gap, relative to r_b2, that counts as none: what the sections leave at an edge."""
COVERED = 1e-9
"""Distance beyond an edge, relative to the flank's height, that counts as rounding."""

FULL_TURN = 2.0 * math.pi


@dataclass(frozen=True, eq=False)
class GoldenSectionResult:
    """Contacts found by golden sections, n positions; NaN where the flanks cover no common region.

    Attributes
    ----------
    pinion_angle, wheel_angle : (n,) array [rad]
        phi1 and phi2.
    point : (n, 3) array [mm]
        In the fixed frame.
    pinion_radius, pinion_axial : (n,) array [mm]
        (rho, z) of the point on the pinion flank.
    gap : (n,) array [mm]
        Smallest gap left at the angle found.
    in_contact : (n,) bool array
        Whether the flanks cover a common region.
    evaluations : int
        Gaps computed for each position.
    """

    pinion_angle: Array
    wheel_angle: Array
    point: Array
    pinion_radius: Array
    pinion_axial: Array
    gap: Array
    in_contact: Mask
    evaluations: int

    def __repr__(self) -> str:
        touching = int(self.in_contact.sum())
        return f"GoldenSectionResult({len(self.in_contact)} positions, {touching} touch, {self.evaluations} gaps each)"


@checked
def search_golden_section(pair: GearPair, pinion_angles: ArrayLike, *, sections: int = SECTIONS) -> GoldenSectionResult:
    """Wheel angle at which the flanks of one tooth pair just touch, at each pinion angle.

    Parameters
    ----------
    pair : GearPair
    pinion_angles : (n,) array [rad]
    sections : int
        Golden sections of each search along the profile and along the face.

    Returns
    -------
    GoldenSectionResult

    Raises
    ------
    InputError
        If an angle is not finite, the array not one-dimensional, or the sections no whole number >= 1.
    GeometryError
        If the flanks cover a common region at no position, or do not come to touch within half a pitch of the wheel.
    ConvergenceError
        If a gap is not closed after ``MOST_TURNS`` turns of the wheel; carries the wheel angles and the gaps.

    References
    ----------
    The miter-gear paper, with the signed gap in place of the distance.

    Examples
    --------
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*[CylindricalGear(z, 3.0, 25.0) for z in (34, 57)])
    >>> crowned = FlankModifications(lead_crowning=0.005)
    >>> pair = cylindrical_pair(mesh, modifications=(crowned, FlankModifications()))
    >>> abs(float(search_golden_section(pair, [0.0], sections=30).wheel_angle[0])) < 1e-11
    True
    """
    phi1 = finite_row("pinion_angles", pinion_angles)
    if not isinstance(sections, int | np.integer) or sections < 1:
        raise InputError(f"sections: {sections!r} is not a whole number >= 1")
    search = _Search(pair, phi1, sections)
    in_contact = search.covered()
    if not in_contact.any():
        raise GeometryError(f"no common flank: at none of the {len(phi1)} pinion angles do the flanks cover a region")
    rows = np.flatnonzero(in_contact)
    wheel_angle, gap, rho, z = (np.full(len(phi1), np.nan) for _ in range(4))
    wheel_angle[rows], gap[rows] = _close(search, rows)
    rho[rows], z[rows] = search.narrowest(rows, wheel_angle[rows])[1:]
    point = np.full((len(phi1), 3), np.nan)
    point[rows] = search.points(rows, rho[rows], z[rows])
    return GoldenSectionResult(phi1, wheel_angle, point, rho, z, gap, in_contact, search.evaluations)


class _Search:
    """Gaps and edges of a pair at given pinion angles (n,), and how often they were asked for."""

    def __init__(self, pair: GearPair, phi1: Array, sections: int) -> None:
        self.pair, self.phi1, self.sections = pair, phi1, sections
        self.evaluations = 0

    def points(self, rows: Indices, rho: Array, z: Array) -> Array:
        """Points of the pinion flank in the fixed frame (k, 3) [mm]."""
        theta = self.pair.pinion.flank.theta(rho, z).value + self.pair.sense * self.phi1[rows]
        return np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=-1)

    def gap(self, rows: Indices, phi2: Array, rho: Array, z: Array) -> Array:
        """Signed distance of the points from the wheel flank, and the penalty beyond the edges (k,) [mm]."""
        self.evaluations += 1
        flank = self.pair.wheel.flank
        radius, azimuth, axial = self.pair.to_wheel(self.points(rows, rho, z))
        jet = flank.theta(radius, axial)
        behind = azimuth - jet.value + self.pair.sense * phi2
        behind -= FULL_TURN * np.round(behind / FULL_TURN)  # azimuths are known up to whole turns
        distance = flank.side * behind / np.sqrt(radius**-2.0 + jet.rho**2 + jet.z**2)
        return distance + PENALTY * self._beyond(rho, z, radius, axial)

    def covered(self) -> Mask:
        """Whether both flanks cover a common region at each position (n,): it does not depend on phi2."""
        rows = np.arange(len(self.phi1))

        def beyond(rho: Array, z: Array) -> Array:
            self.evaluations += 1
            radius, _, axial = self.pair.to_wheel(self.points(rows, rho, z))
            return self._beyond(rho, z, radius, axial)

        return self._lowest(rows, beyond)[0] <= COVERED * self.pair.pinion.flank.extent[0]

    def narrowest(self, rows: Indices, phi2: Array) -> tuple[Array, Array, Array]:
        """Smallest gap at the wheel angles (k,) [mm], and where on the pinion flank: rho, z (k,) [mm]."""
        return self._lowest(rows, lambda rho, z: self.gap(rows, phi2, rho, z))

    def _beyond(self, rho: Array, z: Array, radius: Array, axial: Array) -> Array:
        edges = [*self.pair.pinion.flank.edges(rho, z), *self.pair.wheel.flank.edges(radius, axial)]
        return np.asarray(sum(np.maximum(0.0, -edge.value) for edge in edges))

    def _lowest(self, rows: Indices, function: Callable[[Array, Array], Array]) -> tuple[Array, Array, Array]:
        """Minimum over the flank, and rho, z: sections along the profile inside one along the face."""
        corners = [np.full((len(rows), part.size), part.ravel()) for part in self.pair.pinion.flank.grid(2, 2)]
        ends = [(part.min(axis=1), part.max(axis=1)) for part in corners]

        def across(z: Array) -> tuple[Array, Array]:
            return _golden(lambda rho: function(rho, z), *ends[0], self.sections)

        z, value = _golden(lambda z: across(z)[1], *ends[1], self.sections)
        return value, across(z)[0], z


def _golden(function: Callable[[Array], Array], low: Array, high: Array, sections: int) -> tuple[Array, Array]:
    """Where functions (k,) with one minimum each are smallest between their ends, and how small: (k,) each."""
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = function(left), function(right)
    for _ in range(sections):
        falls = at_right < at_left
        low, high = np.where(falls, left, low), np.where(falls, high, right)
        fresh = np.where(falls, low + GOLDEN * (high - low), high - GOLDEN * (high - low))
        at_fresh = function(fresh)
        left, right = np.where(falls, right, fresh), np.where(falls, fresh, left)
        at_left, at_right = np.where(falls, at_right, at_fresh), np.where(falls, at_fresh, at_left)
    falls = at_right < at_left
    return np.where(falls, right, left), np.where(falls, at_right, at_left)


def _close(search: _Search, rows: Indices) -> tuple[Array, Array]:
    """Wheel angles (k,) [rad] at which the smallest gap vanishes, and what is left of it (k,) [mm]: regula falsi."""
    pair, phi1 = search.pair, search.phi1[rows]
    turned = FULL_TURN * np.round(phi1 / FULL_TURN)  # whole turns bring the same tooth of the pinion back
    mean = pair.ratio * (phi1 - turned) + FULL_TURN * np.round(pair.ratio * turned / FULL_TURN)
    half_pitch = math.pi / pair.teeth[1]
    ends = np.stack([mean - pair.driving * half_pitch, mean + pair.driving * half_pitch])
    gaps = search.narrowest(np.tile(rows, 2), ends.ravel())[0].reshape(ends.shape)
    wrong = (gaps[0] > 0.0) | (gaps[1] < 0.0)
    if wrong.any():
        angle = float(phi1[np.argmax(wrong)])
        raise GeometryError(
            f"the flanks do not come to touch within half a pitch of the wheel at pinion angle {plain(angle, 6)} rad: "
            f"the smallest gap goes from {plain(gaps[0][wrong][0], 3)} to {plain(gaps[1][wrong][0], 3)} mm"
        )
    angle, gap = ends[0].copy(), gaps[0].copy()
    open_rows, closed = np.arange(len(rows)), CLOSED * pair.base_radii[1]
    last = np.full(len(rows), -1)
    for _ in range(MOST_TURNS):
        (low, high), (under, over) = ends[:, open_rows], gaps[:, open_rows]
        angle[open_rows] = low - under * (high - low) / (over - under)
        gap[open_rows] = now = search.narrowest(rows[open_rows], angle[open_rows])[0]
        side = (now > 0.0).astype(int)
        ends[side, open_rows], gaps[side, open_rows] = angle[open_rows], now
        gaps[1 - side, open_rows] *= np.where(side == last[open_rows], 0.5, 1.0)  # Illinois: an end that stays
        last[open_rows] = side
        open_rows = open_rows[np.abs(now) > closed]
        if not open_rows.size:
            return angle, gap
    message = f"golden section: a gap of {plain(np.abs(gap).max(), 3)} mm is left after {MOST_TURNS} turns of the wheel"
    raise ConvergenceError(message, (angle, gap))
