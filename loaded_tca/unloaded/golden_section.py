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
Seed 001, "Contact point determination via the golden ratio method"; Kiefer 1953, Proc. AMS 4, 502-506.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from loaded_tca.errors import ConvergenceError, GeometryError, InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.pair import GearPair

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
SECTIONS = 56
"""Golden sections of one search: 2e-12 of the flank is left, so that a contact on a border is placed as well."""
PENALTY = 4.0
"""Gap [mm] added for each mm beyond a border: the gap itself falls by less than one."""
MOST_TURNS = 30
CLOSED = 1e-13
"""Gap, relative to r_b2, that counts as none, and wheel angle [rad] below which a bracket is closed."""
COVERED = 1e-6
"""Distance beyond a border, relative to the flank's height, below which a point counts as on the flank."""

Bools = NDArray[np.bool_]


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
    touches : (n,) bool array
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
    touches: Bools
    evaluations: int

    def __repr__(self) -> str:
        touching = int(self.touches.sum())
        return f"GoldenSectionResult({len(self.touches)} positions, {touching} touch, {self.evaluations} gaps each)"


def search_golden_section(pair: GearPair, pinion_angles: ArrayLike) -> GoldenSectionResult:
    """Wheel angle at which the flanks of one tooth pair just touch, at each pinion angle.

    Parameters
    ----------
    pair : GearPair
    pinion_angles : (n,) array [rad]

    Returns
    -------
    GoldenSectionResult

    Raises
    ------
    InputError
        If an angle is not finite or the array not one-dimensional.
    GeometryError
        If the flanks cover a common region at no position, or do not come to touch within half a pitch of the wheel.
    ConvergenceError
        If the gap is not closed after ``MOST_TURNS`` turns of the wheel; carries the last result.

    References
    ----------
    Seed 001, with the signed gap in place of the distance.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.pair import cylindrical_pair
    >>> mesh = CylindricalMesh(*[CylindricalGear(z, 3.0, 25.0) for z in (34, 57)])
    >>> crowned = FlankModifications(lead_crowning=0.005)
    >>> pair = cylindrical_pair(mesh, modifications=(crowned, FlankModifications()))
    >>> found = search_golden_section(pair, [0.0])
    >>> abs(float(found.wheel_angle[0])) < 1e-12
    True
    """
    phi1 = np.asarray(pinion_angles, dtype=float)
    if phi1.ndim != 1 or not phi1.size or not np.isfinite(phi1).all():
        raise InputError(f"pinion_angles: shape {phi1.shape} with finite numbers only in one dimension is asked for")
    search = _Search(pair, phi1)
    wheel_angle, (gap, rho, z) = _touching_angle(search, search.covered())
    touches = search.covered()
    result = GoldenSectionResult(
        phi1,
        np.where(touches, wheel_angle, np.nan),
        np.where(touches[:, None], search.points(rho, z)[0], np.nan),
        *(np.where(touches, part, np.nan) for part in (rho, z, gap)),
        touches,
        search.evaluations,
    )
    return result
