"""V-H check: the contact pattern over a grid of two mounting errors, as a roll testing machine shows it.

The gears of a bevel pair are moved in steps by V (the offset) and H (along an axis); each time the marking compound
tells where they touch. How far the pattern goes for a tenth of a millimetre, and when it runs onto an edge, says how a
pair bears its mounting. For parallel axes the errors of the axes take their place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, GearName, finite_row
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flank_maps.pattern import COMPOUND, ContactPattern, contact_pattern
from loaded_tca.flanks.base import FlankFrame
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.unloaded.teeth import trace_teeth

POSITIONS = 31
"""Positions per pitch of each pattern: between two of them the gap of a pair of module 3 mm rises by 1 um."""
GRID = (31, 41)
FINER = 8
"""The gap between two points is interpolated at so many steps to find the centre of a pattern."""
BEYOND = 2.0
"""Gap [compounds] that stands for all larger ones, so that an interpolated pattern ends between two points."""

Build = Callable[[float, float], GearPair]
"""The pair under two mounting errors, v and h."""


@dataclass(frozen=True, eq=False)
class VHCheck:
    """Contact patterns over a grid of two mounting errors.

    Attributes
    ----------
    v, h : (m,), (n,) array
        The errors, in the unit of whoever asked.
    patterns : m tuples of n ContactPattern
        All of one gear, on one grid, with one compound.
    frame : FlankFrame
        How the flank is shown.
    centre : (m, n, 2) array [mm]
        Centre of area of each pattern, as the frame shows it: lengthwise, and the height or the diameter. NaN if the
        pattern passes between the points of the grid.
    size : (m, n, 2) array [mm]
        How far each pattern reaches, lengthwise and along the profile; NaN as the centre.
    edge_share : (m, n) array
        Part of the positions of a pitch at which the leading contact lies on the edge of a flank.
    """

    v: Array
    h: Array
    patterns: tuple[tuple[ContactPattern, ...], ...]
    frame: FlankFrame
    centre: Array
    size: Array
    edge_share: Array

    @property
    def nominal(self) -> tuple[int, int]:
        """Row and column of the cell nearest to no error."""
        return int(np.abs(self.v).argmin()), int(np.abs(self.h).argmin())

    @property
    def shift(self) -> Array:
        """How far each centre lies from that of the nominal cell: (m, n, 2) [mm]."""
        return self.centre - self.centre[self.nominal]

    def __repr__(self) -> str:
        gear, edge = self.patterns[0][0].gear, int((self.edge_share > 0.0).sum())
        return f"VHCheck({len(self.v)} x {len(self.h)} patterns on the {gear}, {edge} with edge contact)"


@checked
def vh_check(
    build: Build,
    v: ArrayLike,
    h: ArrayLike,
    *,
    gear: GearName = "pinion",
    compound: float = COMPOUND,
    grid: tuple[int, int] = GRID,
    positions: int = POSITIONS,
) -> VHCheck:
    """Contact pattern for each pair of mounting errors.

    Parameters
    ----------
    build : callable
        ``build(v, h)``: the GearPair under two errors; of scenes for example
        ``lambda v, h: scene.with_changes({"mounting.offset_mm": v, "mounting.pinion_axial_mm": h}).pair()``.
    v, h : (m,), (n,) array
        The errors.
    gear : {"pinion", "wheel"}
        Whose flank.
    compound : float [mm]
        Thickness of the marking compound.
    grid : (int, int)
        Points of each pattern along the profile and along the face.
    positions : int
        Positions over one pitch, at least 2.

    Returns
    -------
    VHCheck

    Raises
    ------
    InputError
        If an argument is out of range, or ``build`` refuses an error.
    GeometryError
        If no tooth touches somewhere, told with the errors.

    Examples
    --------
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> crowned = (FlankModifications(lead_crowning=0.05), FlankModifications())
    >>> def build(v, h):
    ...     return cylindrical_pair(mesh, modifications=crowned, mounting=Mounting(in_plane=v, out_of_plane=h))
    >>> vh_check(build, [0.0], [-1e-3, 0.0, 1e-3]).shift[0, :, 0].round(2).tolist()
    [-1.46, 0.0, 1.46]
    """
    rows, columns = finite_row("v", v), finite_row("h", h)
    if not isinstance(positions, int | np.integer) or positions < 2:
        raise InputError(f"positions: {positions!r} is not a whole number >= 2")
    patterns, edge_share, shape = [], [], (len(rows), len(columns))
    for first, second in product(rows.tolist(), columns.tolist()):
        try:
            pair = build(first, second)
            mesh = trace_teeth(pair, np.linspace(-0.5, 0.5, positions) * pair.pitch)
            patterns.append(contact_pattern(pair, mesh, gear=gear, compound=compound, grid=grid))
        except GeometryError as error:
            raise GeometryError(f"v = {plain(first, 6)}, h = {plain(second, 6)}: {error}") from error
        edge_share.append(mesh.leading_contact.on_edge.mean())
    frame = (pair.pinion if gear == "pinion" else pair.wheel).flank.frame
    both = np.array([centre_and_size(pattern, frame) for pattern in patterns]).reshape(*shape, 2, 2)
    lines = tuple(tuple(patterns[k : k + shape[1]]) for k in range(0, len(patterns), shape[1]))
    return VHCheck(rows, columns, lines, frame, both[..., 0, :], both[..., 1, :], np.reshape(edge_share, shape))


def centre_and_size(pattern: ContactPattern, frame: FlankFrame) -> tuple[Array, Array]:
    """Centre of area (2,) and extent (2,) [mm] of a contact pattern as a frame shows the flank.

    NaN if no point of its grid touches.
    """
    gap = np.minimum(pattern.gap, BEYOND * pattern.compound)
    x, y, gap = (
        scipy.ndimage.zoom(part, FINER, order=1) for part in (*frame.to_picture(pattern.radius, pattern.axial), gap)
    )
    (x_up, x_along), (y_up, y_along) = np.gradient(x), np.gradient(y)
    marked = gap <= pattern.compound
    weight = marked * np.abs(x_along * y_up - x_up * y_along)
    weight[[0, -1]] *= 0.5
    weight[:, [0, -1]] *= 0.5
    total = weight.sum()
    if not total > 0.0:
        return np.full(2, np.nan), np.full(2, np.nan)
    centre = np.array([(weight * x).sum(), (weight * y).sum()]) / total
    return centre, np.array([np.ptp(x[marked]), np.ptp(y[marked])])
