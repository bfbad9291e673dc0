r"""The conventional contact equations: five of them in five unknowns, solved by a plain Newton iteration.

At a pinion angle phi1 the flanks touch where a point of each coincides and the normals there are opposite:

.. math:: P_1(\rho_1, z_1, \varphi_1) = P_2(\rho_2, z_2, \varphi_2), \qquad
          n_1(\rho_1, z_1, \varphi_1) = -n_2(\rho_2, z_2, \varphi_2)

in the fixed frame, n out of the material. The unknowns are (rho1, z1, rho2, z2, phi2). Three equations come from the
points; unit normals give two more, and the source leaves open which two components are meant. The default is **y and
z of the fixed frame**, because it reproduces the percentage of converging starts which the source prints for its spur
pair. x and z are the better choice: the normals of parallel axes point mainly along y, so that their y component
follows from the two others, and about twice as many starts converge. (For a spur pair x and y are singular together.)

This is a reference to compare with, not the solver of the package: it shares the flanks with ``reduced`` and nothing
else. Nothing keeps it on the flanks; a contact on an edge, where the normals differ, does not solve the equations at
all; and how far it converges depends on the start, of phi2 above all.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, section 9.4; the reduced-TCA dissertation, eqs. 26-32.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, Mask, numbers
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis

UNKNOWNS = ("pinion_radius", "pinion_axial", "wheel_radius", "wheel_axial", "wheel_angle")
"""Order of the unknowns: rho1, z1, rho2, z2 [mm], phi2 [rad]."""
NORMAL_COMPONENTS = (1, 2)
"""The two components of the normals that are made equal: y and z of the fixed frame."""
MOST_STEPS = 50
RESIDUAL = 1e-12
"""Distance of the points, relative to r_b2, and difference of the normals at which the equations are solved."""
ASTRAY = 1e6
"""Unknowns larger than this multiple of r_b2 [mm] (phi2: this many radians) never come back to the flanks."""
SAME_NORMAL = 1e-5
"""Difference of the normals in their third component: the root of what the two others leave."""
ON_FLANK = 1e-9
"""Distance beyond an edge, relative to the flank's height, that still counts as on the flank: rounding."""


@dataclass(frozen=True, eq=False)
class ConventionalResult:
    """Where the iteration from each start ended, n starts.

    Attributes
    ----------
    unknowns : (n, 5) array [mm, mm, mm, mm, rad]
        Last iterate, in the order of ``UNKNOWNS``; the last finite one if the start diverged.
    wheel_angle : (n,) array [rad]
        phi2, brought within half a turn of phi1 z1/z2.
    residual : (n,) array
        Largest of the five equations: points relative to r_b2, normals as they are.
    iterations : (n,) int array
        Newton steps, or evaluations of the equations if SciPy solved them.
    converged : (n,) bool array
        Whether the five equations hold.
    tangent : (n,) bool array
        Whether the normals are opposite in their third component too: two components leave its sign open.
    inside : (n,) bool array
        Whether both points lie on their flanks: a solution elsewhere is no contact.
    """

    unknowns: Array
    wheel_angle: Array
    residual: Array
    iterations: Indices
    converged: Mask
    tangent: Mask
    inside: Mask

    @property
    def is_contact(self) -> Mask:
        """Converged, tangent, and on both flanks: (n,) bool array."""
        return self.converged & self.tangent & self.inside

    def __repr__(self) -> str:
        solved, contacts = int(self.converged.sum()), int(self.is_contact.sum())
        return f"ConventionalResult({len(self.converged)} starts, {solved} converged, {contacts} of them to a contact)"


@checked
def solve_conventional(
    pair: GearPair,
    phi1: ArrayLike,
    start: ArrayLike,
    normal_components: tuple[int, int] = NORMAL_COMPONENTS,
) -> ConventionalResult:
    """Newton iteration on the five equations, undamped, from every start at once.

    Parameters
    ----------
    pair : GearPair
    phi1 : float or (n,) array [rad]
        Pinion angle.
    start : (n, 5) array [mm, mm, mm, mm, rad]
        First guess of rho1, z1, rho2, z2, phi2, one row a start.
    normal_components : (int, int)
        The two components of the normals that are made equal: 0, 1, 2 for x, y, z of the fixed frame.

    Returns
    -------
    ConventionalResult

    Raises
    ------
    InputError
        If the start has not five columns, an entry is not finite, a radius is not positive, or the components are not
        two different ones.

    References
    ----------
    The reduced-TCA dissertation (docs/reference/sources.md), eqs. 26-32.

    Examples
    --------
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*[CylindricalGear(z, 3.0, 25.0) for z in (34, 57)])
    >>> crowned = FlankModifications(lead_crowning=0.005)
    >>> pair = cylindrical_pair(mesh, modifications=(crowned, FlankModifications()))
    >>> solve_conventional(pair, 0.0, [[51.2, 1.0, 85.2, -1.0, 0.01], [51.2, 1.0, 85.2, -1.0, 1.5]])
    ConventionalResult(2 starts, 1 converged, 1 of them to a contact)
    """
    angle, unknowns = _checked(phi1, start, normal_components)
    iterations = np.zeros(len(unknowns), dtype=int)
    rows = np.arange(len(unknowns))
    with np.errstate(all="ignore"):
        for number in range(MOST_STEPS + 1):
            values, jacobian = contact_equations(pair, angle[rows], unknowns[rows], normal_components)
            iterations[rows] = number
            step, sound = _newton_step(values, jacobian)
            trial = unknowns[rows] + step
            sound &= (np.abs(values).max(axis=-1) > RESIDUAL) & _near(pair, trial)
            rows = rows[sound]
            unknowns[rows] = trial[sound]
            if not rows.size:
                break
    return _result(pair, angle, unknowns, iterations, normal_components)


def solve_with_scipy_root(
    pair: GearPair,
    phi1: ArrayLike,
    start: ArrayLike,
    normal_components: tuple[int, int] = NORMAL_COMPONENTS,
) -> ConventionalResult:
    """What ``scipy.optimize.root`` (Powell's hybrid method) makes of the same equations and the same Jacobian.

    Parameters and errors are those of ``solve_conventional``; ``iterations`` counts evaluations of the equations. The
    lengths are handed over relative to r_b2, so that all unknowns are of one size.

    Returns
    -------
    ConventionalResult
    """
    angle, unknowns = _checked(phi1, start, normal_components)
    evaluations = np.zeros(len(unknowns), dtype=int)
    scale = np.array([pair.base_radii[1]] * 4 + [1.0])

    with np.errstate(all="ignore"):
        for row in range(len(unknowns)):

            def equations(guess: Array, here: Array = angle[row : row + 1]) -> tuple[Array, Array]:
                values, jacobian = contact_equations(pair, here, (guess * scale)[None], normal_components)
                return values[0], jacobian[0] * scale

            answer = scipy.optimize.root(
                equations, unknowns[row] / scale, jac=True, method="hybr", options={"xtol": 1e-14}
            )
            evaluations[row] = answer.nfev
            if _near(pair, (answer.x * scale)[None])[0]:
                unknowns[row] = answer.x * scale
    return _result(pair, angle, unknowns, evaluations, normal_components)


def contact_equations(
    pair: GearPair, phi1: Array, unknowns: Array, normal_components: tuple[int, int] = NORMAL_COMPONENTS
) -> tuple[Array, Array]:
    """The five equations and their Jacobian.

    Parameters
    ----------
    pair : GearPair
    phi1 : (n,) array [rad]
    unknowns : (n, 5) array [mm, mm, mm, mm, rad]
        rho1, z1, rho2, z2, phi2.
    normal_components : (int, int)
        Components of the normals, as in ``solve_conventional``.

    Returns
    -------
    values : (n, 5) array
        (P1 - P2)/r_b2, then the two components of n1 + n2.
    jacobian : (n, 5, 5) array [1/mm; last column 1/rad]
    """
    values, jacobian = _six_equations(pair, phi1, unknowns)
    chosen = np.r_[:3, np.add(3, normal_components)]
    return values[:, chosen], jacobian[:, chosen]


def _six_equations(pair: GearPair, phi1: Array, unknowns: Array) -> tuple[Array, Array]:
    """(P1 - P2)/r_b2 and all components of n1 + n2 (n, 6), and their Jacobian (n, 6, 5)."""
    pinion_radius, pinion_axial, wheel_radius, wheel_axial, phi2 = unknowns.T
    one, slopes = _surface(pair.pinion.flank, pinion_radius, pinion_axial, pair.sense * phi1)
    other, mating_slopes = _surface(pair.wheel.flank, wheel_radius, wheel_axial, -pair.sense * phi2)
    to_fixed = np.kron(np.eye(2), pair.wheel_axes)
    other, mating_slopes = other @ to_fixed, to_fixed.T @ mating_slopes * np.array([1.0, 1.0, -pair.sense])
    other[:, :3] += pair.wheel_origin
    signs, scale = np.repeat([-1.0, 1.0], 3), np.repeat([pair.base_radii[1], 1.0], 3)
    jacobian = np.concatenate([slopes[..., :2], signs[:, None] * mating_slopes], axis=-1)
    return (one + signs * other) / scale, jacobian / scale[:, None]


def _surface(flank: Flank, rho: Array, z: Array, turn: Array) -> tuple[Array, Array]:
    """Point and outward normal (n, 6) of a flank turned by an angle, in its gear's frame; their derivatives (n, 6, 3).

    The derivatives are by rho, z and the angle.
    """
    jet = flank.theta(rho, z)
    basis = cylindrical_basis(jet.value + turn)
    zero, unit = np.zeros_like(rho), np.ones_like(rho)
    gradient = _stack(-jet.rho, unit / rho, -jet.z)
    size = np.linalg.norm(gradient, axis=-1)
    normal = flank.side * gradient / size[:, None]
    bends = (
        _stack(-jet.rho_rho - jet.rho / rho, -(unit / rho**2) - jet.rho**2, -jet.rho_z * unit),
        _stack(-jet.rho_z - jet.z / rho, -jet.rho * jet.z, -jet.z_z * unit),
    )
    tilts = [flank.side * bend / size[:, None] for bend in bends]
    tilts = [tilt - normal * (normal * tilt).sum(axis=-1, keepdims=True) for tilt in tilts]
    moves = (_stack(unit, rho * jet.rho, zero), _stack(zero, rho * jet.z, unit), _stack(zero, rho, zero))
    swing = _stack(-normal[:, 1], normal[:, 0], zero)

    def turned(parts: Array) -> Array:
        return np.einsum("nk,nkj->nj", parts, basis)

    points, normals = (_stack(rho, zero, z), *moves), (normal, *tilts, swing)
    both = [np.concatenate([turned(one), turned(other)], axis=-1) for one, other in zip(points, normals, strict=True)]
    return both[0], np.stack(both[1:], axis=-1)


def _stack(*parts: Array) -> Array:
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def _newton_step(values: Array, jacobian: Array) -> tuple[Array, Mask]:
    """Newton step (n, 5), zero where the Jacobian is singular or not finite, and where it is neither (n,)."""
    sound = np.asarray(np.isfinite(values).all(axis=-1) & np.isfinite(jacobian).all(axis=(-2, -1)))
    sound[sound] = np.abs(np.linalg.det(jacobian[sound])) > 0.0
    step = np.zeros_like(values)
    step[sound] = np.linalg.solve(jacobian[sound], -values[sound][..., None])[..., 0]
    return step, sound


def _near(pair: GearPair, unknowns: Array) -> Mask:
    """Whether iterates are finite and within reach: (n,)."""
    reach = ASTRAY * np.array([pair.base_radii[1]] * 4 + [1.0])
    return (np.abs(unknowns) <= reach).all(axis=-1) & (unknowns[:, [0, 2]] != 0.0).all(axis=-1)


def _result(
    pair: GearPair, phi1: Array, unknowns: Array, iterations: Indices, normal_components: tuple[int, int]
) -> ConventionalResult:
    with np.errstate(all="ignore"):
        misfit = np.abs(_six_equations(pair, phi1, unknowns)[0])
        residual = misfit[:, np.r_[:3, np.add(3, normal_components)]].max(axis=-1)
        tangent = np.asarray(misfit[:, 3:].max(axis=-1) <= SAME_NORMAL)
        inside = np.ones(len(unknowns), dtype=bool)
        for flank, first in ((pair.pinion.flank, 0), (pair.wheel.flank, 2)):
            tolerance = ON_FLANK * flank.extent[0]
            inside &= flank.inside(unknowns[:, first], unknowns[:, first + 1], tolerance)
    residual[np.isnan(residual)] = np.inf
    mean = pair.ratio * phi1
    wheel_angle = mean + np.remainder(unknowns[:, 4] - mean + np.pi, 2.0 * np.pi) - np.pi
    return ConventionalResult(unknowns, wheel_angle, residual, iterations, residual <= RESIDUAL, tangent, inside)


def _checked(phi1: ArrayLike, start: ArrayLike, normal_components: tuple[int, int]) -> tuple[Array, Array]:
    """Pinion angles (n,) and a copy of the starts (n, 5)."""
    if not isinstance(normal_components, Sequence) or sorted(normal_components) not in ([0, 1], [0, 2], [1, 2]):
        raise InputError(f"normal_components: {normal_components} are not two different ones of 0, 1, 2 (x, y, z)")
    unknowns = numbers("start", start).copy()
    if unknowns.ndim != 2 or unknowns.shape[1] != len(UNKNOWNS) or not np.isfinite(unknowns).all():
        message = f"start: shape {unknowns.shape}; one row of five finite numbers a start is asked for: "
        raise InputError(message + ", ".join(UNKNOWNS))
    if (unknowns[:, [0, 2]] <= 0.0).any():
        raise InputError("start: the radii pinion_radius and wheel_radius must be positive")
    angle = numbers("phi1", phi1)
    if angle.shape not in ((), (len(unknowns),)) or not np.isfinite(angle).all():
        raise InputError(f"phi1: shape {angle.shape}; one finite angle, or one for each of {len(unknowns)} starts")
    return np.broadcast_to(angle, len(unknowns)), unknowns
