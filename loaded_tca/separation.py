r"""The separation matrix: the gap between the flanks on a small grid in the tangent plane of a contact point.

The grid lies along the principal relative curvatures, x across (largest curvature), y along, centred on the contact
point, which falls between the middle cells of even grids. The gap is the distance of the two flanks along the
common normal; it is +inf where a flank ends.

How large a box does a contact need? The contact is cut into strips across; a strip of gap g_j carries the line load

.. math:: q_j = c\,(\delta - g_j)_+, \qquad c = \frac{\pi E^*}{2 D}, \quad D = \max(\ln(4 L/b) - 1, \pi/4),

which is exact for the slender and for the circular Hertz contact, and its half width is where the gap has risen by
2 q_j/(pi E*), as it does at the edge of a Hertzian line contact. The same rule serves points, lines and edges.

References
----------
Johnson 1985, Contact Mechanics, eqs. 4.24 to 4.28 (slender ellipse), 4.45 (line).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.jet import Array
from loaded_tca.memory import memory_problem
from loaded_tca.pair import GearPair, cylindrical_basis
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded import ContactPoint, RelativeCurvature, relative_curvature

PEAK_ERROR = 0.26
"""Relative error of the peak pressure times the square of the number of cells across a smooth contact (measured on
circles and ellipses: 1e-3 at 16 cells, 2.5e-4 at 32)."""
MARGIN = 1.25
"""Box over estimated contact."""
SPIKE_MARGIN = 1.75
"""The same across a contact that ends with its flank, where the half-space gives a spike and a wider contact."""
EDGE_MARGIN = 2.5
"""The same across a contact on an edge: over a gap that rises linearly from the edge of a flank the half-space is
twice as wide as the strips."""
CERTAINLY_INSIDE = 0.97
"""Contacts shorter than this fraction of the material are taken to end of themselves."""
PROBE = (17, 33)
"""Cells of the coarse grids on which the contact is estimated."""
SMALLEST_LOAD = 1e-6
"""Load [N] that sizes the box of an unloaded contact: small enough for its smallest gap to be rounding."""
MOST_PROBES = 16
MOST_NEWTON_STEPS = 30
ROUNDING = 1e-13
"""Newton steps shorter than this times the sum of the base radii are rounding."""


@dataclass(frozen=True, eq=False)
class Separation:
    """Gap between the flanks around a contact point.

    Attributes
    ----------
    gap : (nx, ny) array [mm]
        +inf where a flank ends; zero at the contact point.
    x, y : (nx,), (ny,) array [mm]
        Cell centres across and along.
    spacing : (float, float) [mm]
        Cell sizes (dx, dy).
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        Rows: x, y, and the normal out of the pinion.
    curvatures : (float, float) [1/mm]
        Principal relative curvatures, across and along.
    """

    gap: Array
    x: Array
    y: Array
    spacing: tuple[float, float]
    origin: Array
    axes: Array
    curvatures: tuple[float, float]

    @property
    def points(self) -> Array:
        """Cell centres in the tangent plane, in the fixed frame: (nx, ny, 3) [mm]."""
        return self.origin + self.x[:, None, None] * self.axes[0] + self.y[None, :, None] * self.axes[1]

    @property
    def material_area(self) -> float:
        """Area of the cells that have material [mm^2]."""
        return float(np.isfinite(self.gap).sum()) * self.spacing[0] * self.spacing[1]

    @property
    def half_lengths(self) -> tuple[float, float]:
        """Half lengths of the box across and along [mm]."""
        return 0.5 * self.gap.shape[0] * self.spacing[0], 0.5 * self.gap.shape[1] * self.spacing[1]

    def __repr__(self) -> str:
        nx, ny = self.gap.shape
        return f"Separation({nx} x {ny} cells of {self.spacing[0]:.3g} x {self.spacing[1]:.3g} mm)"


def cells_for_accuracy(accuracy: float) -> int:
    """Even number of cells across the box that gives the peak pressure to a relative ``accuracy``."""
    return 2 * math.ceil(0.5 * MARGIN * max(8.0, math.sqrt(PEAK_ERROR / accuracy)))


def sample_separation(
    pair: GearPair,
    contact: ContactPoint,
    *,
    cells: tuple[int, int] | None = None,
    load: float | None = None,
    accuracy: float = 1e-3,
    box: tuple[float, float] | None = None,
) -> Separation:
    """Gap between the flanks on a grid that just holds the contact.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
        One position of a contact path.
    cells : (int, int), optional
        Cells across and along; default: what ``accuracy`` asks for.
    load : float [N], optional
        Normal force that the box must hold; not needed if ``box`` is given. A load of zero gets the box of 1e-6 N.
    accuracy : float
        Relative error of the peak pressure of a smooth contact that chooses the cells.
    box : (float, float) [mm], optional
        Half lengths across and along, instead of the estimated ones.

    Returns
    -------
    Separation

    Raises
    ------
    InputError
        If an argument is out of range, or neither load nor box is given.
    GeometryError
        If the tooth pair does not touch at this position.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.pair import cylindrical_pair
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh, modifications=(FlankModifications(lead_crowning=0.005), FlankModifications()))
    >>> separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(32, 32), load=2712.6)
    >>> [round(k, 6) for k in separation.curvatures]
    [0.091526, 6.4e-05]
    """
    _check(contact, cells, load, accuracy, box)
    curvature = relative_curvature(pair, contact)
    gap = _Gap(pair, contact, curvature.axes)
    shape = (int(cells[0]), int(cells[1])) if cells is not None else (cells_for_accuracy(accuracy),) * 2
    half = (
        box
        if box is not None
        else _box_of_whole_cells(*_estimate_box(gap, curvature, contact, load if load else SMALLEST_LOAD), shape[1])
    )
    spacing = (2.0 * half[0] / shape[0], 2.0 * half[1] / shape[1])
    x, y = ((np.arange(n) - 0.5 * (n - 1)) * step for n, step in zip(shape, spacing, strict=True))
    curvatures = (curvature.across, curvature.along)
    return Separation(gap(x, y), x, y, spacing, contact.point.copy(), curvature.axes, curvatures)


def _check(
    contact: ContactPoint,
    cells: tuple[int, int] | None,
    load: float | None,
    accuracy: float,
    box: tuple[float, float] | None,
) -> None:
    if not isinstance(contact, ContactPoint):
        raise InputError(f"contact: {contact!r} is not one position of a path; take path[i]")
    problems = []
    if cells is not None and not (_two_numbers(cells) and all(n == n // 1 and 1 <= n < math.inf for n in cells)):
        problems.append(f"cells: {cells} are not two whole numbers >= 1")
    elif cells is not None and (memory := memory_problem(tuple(cells))) is not None:
        problems.append(memory)
    if load is None and box is None:
        problems.append("load: none given; a load [N] or a box [mm] is needed to size the grid")
    if load is not None and not 0.0 <= load < math.inf:
        problems.append(f"load: {load} N is not a finite number >= 0")
    if box is not None and not (_two_numbers(box) and all(0.0 < length < math.inf for length in box)):
        problems.append(f"box: {box} are not two positive lengths [mm]")
    if not 1e-8 <= accuracy < 1.0:
        problems.append(f"accuracy: {accuracy} is not between 1e-8 and 1")
    if problems:
        raise InputError(problems)
    if not contact.touches:
        raise GeometryError(
            f"no common flank: the tooth pair does not touch at pinion angle {contact.pinion_angle} rad"
        )


def _box_of_whole_cells(half: tuple[float, float], material: float, cells: int) -> tuple[float, float]:
    """Box that ends a cell beyond the end of the material where it lies inside, so that whole cells end there."""
    if material >= half[1]:
        return half
    return half[0], material * (cells / (cells - 2) if cells > 2 else 1.0)


def _two_numbers(values: object) -> bool:
    array = np.asarray(values)
    return array.shape == (2,) and array.dtype.kind in "iuf" and not np.isnan(array.astype(float)).any()


def _estimate_box(
    gap: _Gap, curvature: RelativeCurvature, contact: ContactPoint, load: float
) -> tuple[tuple[float, float], float]:
    """Half lengths across and along of a box that holds the contact under a load > 0 [N], and the end of the material.

    The end of the material is the distance along the second axis to the farthest point that both flanks still cover,
    within the box.
    """
    pair = gap.pair
    modulus = pair.contact_modulus
    longest = math.hypot(pair.face_width, *(flank.extent[0] for flank in (pair.pinion, pair.wheel)))
    window = _first_window(curvature, load, modulus, longest)
    needed = (0.0, 0.0)
    for _ in range(MOST_PROBES):
        x, y = (np.linspace(-half, half, count) for half, count in zip(window, PROBE, strict=True))
        probe = gap(x, y)
        if not np.isfinite(probe).any():
            window = (2.0 * window[0], min(2.0 * window[1], longest))
            continue
        needed = _strip_extent(probe, x, y, load, modulus)
        fits = [0.4 * have <= need <= 0.85 * have for need, have in zip(needed, window, strict=True)]
        fits[1] |= needed[1] > 0.85 * window[1] and window[1] == longest
        if all(fits):
            break
        window = (_resized(needed[0], window[0]), min(_resized(needed[1], window[1]), longest))
    material = _material_length(gap, window[0], MARGIN * needed[1])
    spiked = needed[1] > CERTAINLY_INSIDE * material
    margin = EDGE_MARGIN if contact.on_edge else SPIKE_MARGIN if spiked else MARGIN
    return (margin * needed[0], MARGIN * needed[1]), material


def _first_window(curvature: RelativeCurvature, load: float, modulus: float, longest: float) -> tuple[float, float]:
    across = max(curvature.across, 1e-6 / longest)
    along = max(curvature.along, 1e-8 * across)
    ellipse = point_contact(load, (across, along), modulus)
    return 1.5 * ellipse.semi_minor, min(1.5 * ellipse.semi_major, longest)


def _resized(needed: float, window: float) -> float:
    """A window that a contact of the needed half length fills to two thirds, growing at most fourfold."""
    return min(max(1.5 * needed, 0.1 * window), 4.0 * window) if needed < 0.85 * window else 2.0 * window


def _strip_extent(gap: Array, x: Array, y: Array, load: float, modulus: float) -> tuple[float, float]:
    """Half lengths across and along [mm] of the contact that the strip model gives on a coarse gap."""
    floor = gap.min(axis=0)
    dx, dy = x[1] - x[0], y[1] - y[0]
    length, width = y[-1], x[-1]
    for _ in range(4):
        stiffness = 0.5 * math.pi * modulus / max(math.log(4.0 * max(length / width, 1.0)) - 1.0, 0.25 * math.pi)
        line_load = stiffness * _penetration(floor, load / (stiffness * dy))
        rise = 2.0 * line_load / (math.pi * modulus)
        with np.errstate(invalid="ignore"):
            loaded = (gap - floor <= rise) & (line_load > 0.0)
        width = float(np.abs(x)[loaded.any(axis=1)].max()) + 0.5 * dx
        length = float(np.abs(y)[loaded.any(axis=0)].max()) + 0.5 * dy
    return width, length


def _penetration(floor: Array, total: float) -> Array:
    """(delta - floor)_+ with delta such that its sum is ``total``: water filling."""
    order = np.sort(floor[np.isfinite(floor)])
    levels = (total + np.cumsum(order)) / np.arange(1, len(order) + 1)
    above = np.append(order[1:], np.inf)
    delta = levels[np.argmax(levels <= above)]
    return np.maximum(delta - np.where(np.isfinite(floor), floor, np.inf), 0.0)


def _material_length(gap: _Gap, across: float, reach: float) -> float:
    """Distance along y to the farthest end of the material within ``reach``, refined to 1e-6 of it.

    Looked for over the whole width ``across`` on either side: in a corner of a flank there is none straight ahead.
    """
    x = np.linspace(-across, across, PROBE[0])
    if np.isfinite(gap(x, np.array([-reach, reach]))).any():
        return reach
    low, high = np.zeros(2), np.full(2, reach)
    for _ in range(4):
        trial = np.linspace(low, high, PROBE[1])
        has = np.isfinite(gap(x, (trial * [-1.0, 1.0]).ravel())).any(axis=0).reshape(trial.shape)
        last = np.where(has, np.arange(PROBE[1])[:, None], 0).max(axis=0)
        low, high = (
            np.take_along_axis(trial, row[None], axis=0)[0] for row in (last, np.minimum(last + 1, PROBE[1] - 1))
        )
    return float(high.max())


class _Gap:
    """Distance of the two flanks along the normal, at points of the tangent plane."""

    def __init__(self, pair: GearPair, contact: ContactPoint, axes: Array) -> None:
        self.pair, self.contact, self.axes = pair, contact, axes
        turn, identity = pair.sense, np.eye(3)
        self._frames = (
            (pair.pinion, np.zeros(3), identity, turn * contact.pinion_angle),
            (pair.wheel, pair.wheel_origin, pair.wheel_axes, -turn * contact.wheel_angle),
        )
        self._size = sum(pair.base_radii)

    def __call__(self, x: Array, y: Array) -> Array:
        """Gap (nx, ny) [mm] over the grid of x and y; +inf where a flank ends or bends away from the normal."""
        points = self.contact.point + x[:, None, None] * self.axes[0] + y[None, :, None] * self.axes[1]
        heights, exists = zip(*(self._height(points, *frame) for frame in self._frames), strict=True)
        return np.where(exists[0] & exists[1], heights[1] - heights[0], np.inf)

    def _height(self, points: Array, flank: Flank, origin: Array, frame: Array, turn: float) -> tuple[Array, Array]:
        """Height of a flank over the tangent plane along the normal [mm], and whether it is there."""
        start, normal = (points - origin) @ frame.T, self.axes[2] @ frame.T
        height = np.zeros(points.shape[:-1])
        longest = 0.25 * self.pair.module
        for _ in range(MOST_NEWTON_STEPS):
            rho, theta, z = _cylindrical(start + height[..., None] * normal)
            jet = flank.theta(rho, z)
            basis = cylindrical_basis(theta)
            slope = (basis @ normal * np.stack(np.broadcast_arrays(-jet.rho, 1.0 / rho, -jet.z), axis=-1)).sum(axis=-1)
            step = (jet.value + turn - theta) / np.where(np.abs(slope) > 1e-6 / self._size, slope, np.inf)
            height = height + np.clip(step, -longest, longest)
            if (np.abs(step) <= ROUNDING * self._size).all():
                break
        rho, _, z = _cylindrical(start + height[..., None] * normal)
        there = flank.inside(rho, z, tolerance=1e-9 * self.pair.module)
        return height, there & (np.abs(step) <= 1e3 * ROUNDING * self._size)


def _cylindrical(point: Array) -> tuple[Array, Array, Array]:
    return np.hypot(point[..., 0], point[..., 1]), np.arctan2(point[..., 1], point[..., 0]), point[..., 2]
