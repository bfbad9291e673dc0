"""The surface of a complete tooth, from two flanks and the form of the tooth, its patches, and its triangles.

In every section the outline runs from the middle of one space over the tooth to the middle of the next, in the sense
of +theta. All patches are pieces of this outline: neighbours share the very points of their common edge. Triangles have
numbers on them, as viewers take them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, count_problems, keep_copies
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import RoundedFlank, sharp
from loaded_tca.plain import plain
from loaded_tca.tooth.families import StraightRow, ToothForm
from loaded_tca.tooth.fillet import ArcFillet, Fillet, FilletCurve, Profile, in_space, profile_of


@checked
@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Vertices, triangles and data on either.

    Parameters
    ----------
    vertices : (v, 3) array [mm]
    triangles : (t, 3) int array
        Indices of corners, counter-clockwise seen from outside.
    point_data, cell_data : mapping
        Name (unit in it) -> (v,) or (t,) array.

    Raises
    ------
    InputError
        If shapes do not fit, a vertex is not finite, or an index points to none.

    Examples
    --------
    >>> corners = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    >>> TriangleMesh(corners, np.array([[0, 1, 2]])).area
    1.0
    """

    vertices: Array
    triangles: NDArray[np.int_]
    point_data: Mapping[str, Array] = field(default_factory=dict)
    cell_data: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        problems = [
            f"{name}: shape {array.shape} is not (n, 3)"
            for name, array in (("vertices", self.vertices), ("triangles", self.triangles))
            if array.ndim != 2 or array.shape[1] != 3
        ]
        if not problems and not np.isfinite(self.vertices).all():
            problems.append("vertices: not all are finite")
        if not problems and self.triangles.size and not 0 <= self.triangles.min() <= self.triangles.max() < self.size:
            problems.append(f"triangles: indices are not within 0 to {self.size - 1}")
        for kind, data, count in (("point", self.point_data, self.size), ("cell", self.cell_data, len(self.triangles))):
            for name, values in data.items():
                if values.shape != (count,):
                    problems.append(f"{kind} data {name}: shape {values.shape} is not ({count},)")
        if problems:
            raise InputError(problems)
        keep_copies(self)

    @property
    def size(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def corners(self) -> Array:
        """Corners of every triangle, (t, 3, 3) [mm]."""
        return self.vertices[self.triangles]

    @property
    def normals(self) -> Array:
        """Normals (t, 3), as long as the triangle's area [mm^2]."""
        corners = self.corners
        return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    @property
    def area(self) -> float:
        """Area [mm^2]."""
        return float(np.linalg.norm(self.normals, axis=1).sum())

    @property
    def volume(self) -> float:
        """Volume inside [mm^3], of a closed surface: the theorem of Gauss."""
        return float((self.corners.mean(axis=1) * self.normals).sum() / 3.0)

    @property
    def is_closed(self) -> bool:
        """Whether every edge belongs to two triangles, which run along it in opposite directions."""
        edges = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        there, back = (_keys(pairs, self.size) for pairs in (edges, edges[:, ::-1]))
        return len(np.unique(there)) == len(there) and np.array_equal(np.sort(there), np.sort(back))

    def seams(self, name: str) -> Array:
        """Edges (k, 2, 3) at the border of the surface, or between cells that differ in ``cell_data[name]`` [mm]."""
        edges = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        values = np.tile(self.cell_data[name], 3)
        keys = _keys(np.sort(edges, axis=1), self.size)
        order = np.argsort(keys, kind="stable")
        keys, values, edges = keys[order], values[order], edges[order]
        paired = np.append(keys[1:] == keys[:-1], False)
        second = np.insert(paired[:-1], 0, False)
        differs = paired & (values != np.roll(values, -1))
        return self.vertices[edges[differs | ~(paired | second)]]

    def moved(self, origin: Array, axes: Array) -> TriangleMesh:
        """Return the mesh in the frame in which its own has this ``origin`` (3,) and these ``axes`` (3, 3), in rows.

        Left-handed axes mirror the mesh: the corners of its triangles then follow each other the other way round, so
        that the outside stays outside.
        """
        turned = self.triangles if np.linalg.det(axes) > 0.0 else self.triangles[:, ::-1]
        return replace(self, vertices=origin + self.vertices @ axes, triangles=turned)

    def __repr__(self) -> str:
        return f"TriangleMesh({self.size} vertices, {len(self.triangles)} triangles)"


def _keys(edges: NDArray[np.int_], size: int) -> NDArray[Any]:
    """One number per directed edge."""
    return edges[:, 0].astype(np.int64) * size + edges[:, 1]


def grid_triangles(index: NDArray[np.int_]) -> NDArray[np.int_]:
    """Triangles of a structured surface: two per cell of indices (n, m), without those that have two equal corners.

    The outside is where the first axis crossed with the second one points to.
    """
    corners = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    halves = [np.stack([corners[a], corners[b], corners[c]], axis=-1) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    triangles: NDArray[np.int_] = np.stack(halves, axis=-2).reshape(-1, 3)
    same = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)
    return triangles[~same]


PATCHES = ("root land -", "fillet -", "flank -", "tip land", "flank +", "fillet +", "root land +")
"""Patches along the outline; "+" is the side s = +1, whose outward normal has a positive azimuthal part."""
CLOSING = {"lower side": -1, "upper side": -2, "foot": -3, "cut": -4}
"""Numbers of the patches that close a tooth: ends of the face, inside of the rim, cuts towards its neighbours."""


@dataclass(frozen=True, eq=False)
class ToothSurface:
    """One tooth in the frame of its gear.

    Attributes
    ----------
    outline : (n, m, 3) array [mm]
        Along the outline, from space to space, and across the face.
    foot : (2, m, 3) array [mm]
        Below both ends of the outline, where a closed tooth ends inside the rim.
    joints : (8,) tuple of int
        Where along the outline the patches of ``PATCHES`` begin and end.
    teeth : int
        Number of teeth of the gear.
    half_thickness_angle : float [rad]
        From the middle of the tooth to the point of either flank where Theta = 0.
    row : StraightRow, optional
        Of the teeth of a rack; None: the teeth stand about the axis.
    """

    outline: Array
    foot: Array
    joints: tuple[int, ...]
    teeth: int
    half_thickness_angle: float
    row: StraightRow | None = None

    def patch(self, name: str) -> Array:
        """Points (k, m, 3) of one of ``PATCHES`` [mm]; InputError if there is none of this name."""
        if name not in PATCHES:
            raise InputError(f"name: {name!r} is not one of {', '.join(map(repr, PATCHES))}")
        number = PATCHES.index(name)
        return self.outline[self.joints[number] : self.joints[number + 1] + 1]

    def turned(self, angle: float) -> ToothSurface:
        """Return the tooth turned about the gear's axis by ``angle`` [rad]."""
        turn = _turn(angle)
        return replace(self, outline=self.outline @ turn, foot=self.foot @ turn)

    def triangles(self, copies: int = 1, *, closed: bool = False) -> TriangleMesh:
        """Triangles of one tooth or several.

        Parameters
        ----------
        copies : int
            Teeth, each a pitch further; all of the gear's: a ring. Those of a rack stand along a straight line.
        closed : bool
            Whether to close both ends of the face, the inside of the rim, and the cuts towards further teeth.

        Returns
        -------
        TriangleMesh
            ``cell_data["patch"]``: the index in ``PATCHES``, or a number of ``CLOSING``.

        Raises
        ------
        InputError
            If the gear has not so many teeth.
        """
        if not 1 <= copies <= self.teeth:
            raise InputError(f"copies: {copies} is not between 1 and {self.teeth}, the number of teeth")
        vertices, outline, foot = self._repeated(copies)
        last, parts = len(self.outline) - 1, []
        for copy in range(copies):
            tooth = outline[copy * last : (copy + 1) * last + 1]
            ends = zip(self.joints, self.joints[1:], strict=False)
            parts += [(grid_triangles(tooth[a : b + 1]), number) for number, (a, b) in enumerate(ends)]
            parts += _closing(tooth, foot[copy : copy + 2], self.joints[1], self.joints[3]) if closed else []
        if closed and copies < self.teeth:
            cuts = np.stack([foot[0], outline[0]]), np.stack([outline[-1], foot[-1]])
            parts += [(grid_triangles(index), CLOSING["cut"]) for index in cuts]
        used, triangles = np.unique(np.concatenate([of_part for of_part, _ in parts]), return_inverse=True)
        patch = np.concatenate([np.full(len(of_part), number) for of_part, number in parts])
        return TriangleMesh(vertices[used], triangles.reshape(-1, 3), cell_data={"patch": patch})

    def solid(self, *, whole_gear: bool = False) -> TriangleMesh:
        """Closed surface of one tooth on its rim, or of the whole gear, in the gear's own frame.

        The origin of a rack's own frame lies on its reference line, in the middle of the first tooth at mid-face: x
        points out of the teeth, y along the travel. A whole rack has the whole teeth of its toothed part.

        Parameters
        ----------
        whole_gear : bool

        Raises
        ------
        InputError
            If a whole rack is asked for whose length is not given.
        """
        if self.row is None:
            return self.triangles(self.teeth if whole_gear else 1, closed=True)
        teeth = self.row.teeth if whole_gear else 1
        if teeth is None:
            raise InputError("whole gears: found a rack of no given length; give wheel.length_mm, or take one tooth")
        return self.triangles(teeth, closed=True).moved(np.array([-self.row.reference_radius, 0.0, 0.0]), np.eye(3))

    def _repeated(self, copies: int) -> tuple[Array, Indices, Indices]:
        """Vertices of several teeth, and their indices along all outlines and along the feet of all borders."""
        last, ring = len(self.outline) - 1, copies == self.teeth
        outline = [self._further(self.outline[:last], copy) for copy in range(copies)]
        foot = [self._further(self.foot[:1], copy) for copy in range(copies)]
        if not ring:
            outline.append(self._further(self.outline[last:], copies - 1))
            foot.append(self._further(self.foot[1:], copies - 1))
        points = np.concatenate(outline + foot)
        index = np.arange(points[..., 0].size).reshape(points.shape[:2])
        along, below = np.split(index, [sum(map(len, outline))])
        if ring:
            along, below = (np.concatenate([rows, rows[:1]]) for rows in (along, below))
        return points.reshape(-1, 3), along, below

    def _further(self, points: Array, pitches: int) -> Array:
        """Points (..., 3) of the tooth on that some pitches further [mm]."""
        if self.row is None:
            return points @ _turn(2.0 * math.pi * pitches / self.teeth)
        return points + np.array([0.0, self.row.pitch * pitches, 0.0])

    def __repr__(self) -> str:
        n, m, _ = self.outline.shape
        return f"ToothSurface({n} x {m} points, one of {self.teeth} teeth)"


def _turn(angle: float) -> Array:
    """Turn about z for points in rows (3, 3)."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _closing(tooth: Indices, foot: Indices, root: int, tip: int) -> list[tuple[Indices, int]]:
    """Triangles of both ends of the face and of the foot of one tooth.

    The ends are strips from side to side, from where the root lands end (``root``) to below the tip land (from ``tip``
    on), and fans to the points of these lands: strips between points of a land would have no area where the land is
    straight, as on a rack.
    """
    strips = np.concatenate([foot[None], np.stack([tooth[root:tip], tooth[::-1][root:tip]], axis=1)])
    lands = tooth[: root + 1], tooth[-root - 1 :]
    fans = [np.stack([np.broadcast_to(below, along.shape), along]) for below, along in zip(foot, lands, strict=True)]
    top = tooth[tip : len(tooth) - tip]
    below = np.concatenate([np.broadcast_to(tooth[tip - 1], top.shape), tooth[-tip : len(tooth) - tip + 1]])
    ends = strips, *fans, np.stack([below, np.concatenate([top, top[-1:]])])  # upwards, from left to right
    triangles_at = [("lower side", index[:, ::-1, 0]) for index in ends]
    triangles_at += [("upper side", index[:, :, -1]) for index in ends]
    return [(grid_triangles(index), CLOSING[name]) for name, index in (*triangles_at, ("foot", foot[::-1]))]


OVERLAP = 1e-3
"""Part of a pitch by which fillets may pass each other: modifications turn those of a full rounding by microns."""
HALVINGS = 20
"""Steps that look for the largest arc that fits: to a millionth of the one that was asked for."""
RIM = 0.5
"""Thickness of the rim below a closed tooth, over the height of the tooth."""


@dataclass(frozen=True)
class Resolution:
    """Points along the parts of a tooth.

    Parameters
    ----------
    flank, fillet, land : int
        Along the profile of each flank, fillet and land.
    lengthwise : int
        Across the face.

    Raises
    ------
    InputError
        If a number is not a whole one from 2 on.
    """

    flank: int = 33
    fillet: int = 17
    land: int = 4
    lengthwise: int = 33

    def __post_init__(self) -> None:
        problems = count_problems(vars(self), 2)
        if problems:
            raise InputError(problems)


def build_tooth(flanks: tuple[Flank, Flank], form: ToothForm, resolution: Resolution = Resolution()) -> ToothSurface:
    """Complete tooth between two flanks; the middle of the tooth at mid-face stands at the azimuth 0.

    Parameters
    ----------
    flanks : (Flank, Flank)
        Of the sides s = +1 and s = -1, each in its own frame, where Theta = 0 at the pitch point of mid-face.
    form : ToothForm
    resolution : Resolution

    Raises
    ------
    InputError
        If the flanks are not of the two sides of a tooth, or a fillet radius does not fit.
    GeometryError
        If the tooth is pointed or cut off by its undercut, or there is no space between the teeth.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pinion = cylindrical_pair(mesh).pinion
    >>> build_tooth(pinion.flanks, pinion.form)
    ToothSurface(106 x 33 points, one of 34 teeth)
    """
    if tuple(flank.side for flank in flanks) != (1, -1):
        raise InputError(f"flanks: their sides are {', '.join(str(flank.side) for flank in flanks)}, not 1, -1")
    counts = resolution.flank, resolution.lengthwise
    sides = [profile_of(flank, form.sections, form.half_thickness_angle, counts) for flank in flanks]
    coordinate, land = sides[0].coordinate, resolution.land
    space = _Space(sides, form.root_radius(coordinate), 2.0 * math.pi / form.teeth, resolution.fillet)
    (plus_radius, plus), (minus_radius, minus) = _fitting(space, form)
    if any(isinstance(flank, RoundedFlank) for flank in flanks):
        build_tooth((sharp(flanks[0]), sharp(flanks[1])), form, resolution)  # what cannot exist with sharp edges
        lacking = np.maximum(-0.5 * (plus + minus)[: resolution.flank], 0.0)
        plus[: resolution.flank] += lacking  # in its corners a tooth is thinner than the arcs of all edges need
        minus[: resolution.flank] += lacking
    else:
        _check_thickness(plus + minus, coordinate, resolution)
    right = 0.5 * (space.pitch + plus[-1] - minus[-1])
    left = right - space.pitch
    root, tip = (np.broadcast_to(radius, (land, len(coordinate))) for radius in (space.root, plus_radius[0]))
    azimuths = [
        np.linspace(left, -minus[-1], land),
        -minus[::-1],
        np.linspace(-minus[0], plus[0], land),
        plus,
        np.linspace(plus[-1], right, land),
    ]
    radii = [root, minus_radius[::-1], tip, plus_radius, root]
    theta, radius = (np.concatenate([rows[0], *(row[1:] for row in rows[1:])]) for rows in (azimuths, radii))
    height = sides[0].radius[-1] - space.root
    foot = np.tile(np.maximum(space.root - RIM * height, 0.5 * space.root), (2, 1))  # never beyond the axis
    steps = [land, resolution.fillet, resolution.flank]
    return ToothSurface(
        in_space(form.sections, radius, theta, coordinate),
        in_space(form.sections, foot, np.stack([left, right]), coordinate),
        tuple(np.cumsum([0, *(count - 1 for count in (*steps, land, *steps[::-1]))]).tolist()),
        form.teeth,
        form.half_thickness_angle,
        form.row,
    )


Halves = list[tuple[Array, Array]]
"""Radius [mm] and angle from the middle [rad] (k, m) of both sides of a tooth, from the tip to the root."""


@dataclass(frozen=True, eq=False)
class _Space:
    """The space between two teeth before its fillets are known: its sides, root circles, pitch, points of a fillet."""

    sides: Sequence[Profile]
    root: Array
    pitch: float
    points: int

    def halves(self, fillet: Fillet) -> Halves:
        """Radius [mm] and angle from the middle [rad] (k, m) of both sides of a tooth, from the tip to the root."""
        return [_outline(side, fillet.curve(side, self.root, self.points), self.root) for side in self.sides]

    def halves_with_room(self, fillet: Fillet) -> Halves | None:
        """The same, if there are such fillets, and those of a space leave each other room."""
        try:
            (_, plus), (_, minus) = halves = self.halves(fillet)
        except GeometryError:
            return None
        return halves if (self.pitch - plus[-1] - minus[-1] >= -OVERLAP * self.pitch).all() else None


def _outline(profile: Profile, curve: FilletCurve, root: Array) -> tuple[Array, Array]:
    """Flank from the tip down to where the fillet starts, then the fillet."""
    low, high = profile.radius[0], profile.radius[-1]
    flank = high - (high - profile.radius[::-1]) * (high - curve.start) / (high - low)
    flank[-1] = curve.start
    angle, _ = profile.angle(flank)
    fillet = np.hypot(curve.points[..., 0], curve.points[..., 1])
    fillet[-1] = root
    azimuth = np.arctan2(curve.points[..., 1], curve.points[..., 0])
    turn = np.remainder(azimuth - angle[-1] + math.pi, 2.0 * math.pi) - math.pi
    return np.concatenate([flank, fillet[1:]]), np.concatenate([angle, (angle[-1] + turn)[1:]])


def _fitting(space: _Space, form: ToothForm) -> Halves:
    """Both sides of a tooth with the fillet of the form, or with the largest arc that fits where that is allowed."""
    fillet = form.fillet
    fitting = space.halves_with_room(fillet)
    if fitting is not None:
        return fitting
    if not isinstance(fillet, ArcFillet):
        raise GeometryError("the fillets of neighbouring teeth pass each other: no space is left at the root")
    small, large = 0.0, fillet.radius
    for _ in range(HALVINGS):
        middle = 0.5 * (small + large)
        halves = space.halves_with_room(replace(fillet, radius=middle))
        small, large, fitting = (small, middle, fitting) if halves is None else (middle, large, halves)
    if fitting is None:
        space.halves(replace(fillet, radius=large))
        raise GeometryError("no fillet fits between neighbouring teeth: no space is left at the root")
    if not form.largest_that_fits:
        raise InputError(
            f"fillet_radius: {plain(fillet.radius, 6)} mm does not fit into the space between two teeth; the largest "
            f"that does is {plain(small)} mm"
        )
    return fitting


def _check_thickness(thickness: Array, coordinate: Array, resolution: Resolution) -> None:
    """Refuse a tooth that has no thickness (k, m) somewhere."""
    place, section = np.unravel_index(int(thickness.argmin()), thickness.shape)
    if thickness[place, section] > 0.0:
        return
    where = f"in the section at {plain(coordinate[section], 6)} mm"
    if place < resolution.flank:
        raise GeometryError(f"pointed tooth: its two flanks meet below the tip, {where}")
    raise GeometryError(f"the undercut of both sides cuts off the tooth, {where}")
