r"""Two gears in space: their frames, mounting errors, senses of rotation.

Fixed frame: pinion axis = +z, origin at the pinion's mid-face, x towards the wheel. Wheel frame without errors:
origin (a, 0, 0), axes e_x2 = (-1, 0, 0), e_y2 = (0, -1, 0), e_z2 = (0, 0, 1)::

            y ^                          x2 <----o wheel axis (z2 out of the page)
              |                                  |
     pinion   o----> x                           v y2
     axis (z out of the page)  <------ a ------->

The pinion turns by ``sense * phi1`` about +z, the wheel by ``sense * phi2`` about -e_z2: both angles are positive
in the sense of motion. A point of the pinion flank stands at theta1 = Theta1 + sense phi1, a point of the wheel
flank at theta2 = Theta2 - sense phi2. Both touching flanks have the side s = sense * driving, where driving is +1
if the pinion drives and -1 if the wheel does. At phi1 = phi2 = 0 the unmodified, aligned pair touches at the pitch
point of the mid-face section. Mounting errors are counted in the fixed frame, whichever flank is in contact.
Complete teeth, as pictures and files show them, stand as they are in mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Protocol

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array, GearName, keep_copies
from loaded_tca.errors import InputError, named
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.material import contact_modulus
from loaded_tca.pairs.gear import Gear
from loaded_tca.plain import plain
from loaded_tca.tooth.surface import Resolution, ToothSurface, TriangleMesh, build_tooth, grid_triangles

if TYPE_CHECKING:
    from collections.abc import Sequence

Driving = GearName
Sense = Literal["positive", "negative"]


class ContactGrid(Protocol):
    """Where the slices of a contact lie; a separation and a pressure map are such grids."""

    @property
    def y(self) -> Array:
        """Middles of the slices along the contact (ny,) [mm], from the contact point."""

    @property
    def origin(self) -> Array:
        """The contact point (3,) in the fixed frame [mm]."""

    @property
    def axes(self) -> Array:
        """Directions across, along and normal to the contact (3, 3), in rows, in the fixed frame."""

    @property
    def force_line(self) -> Array:
        """Where across the contact the force of every slice acts (ny,) [mm], from the contact point."""


class MovedSlices(NamedTuple):
    """Pairs of gears and slices of all grids a step below and above a value of a key, and the step between."""

    low: tuple[GearPair, Sequence[ContactGrid]]
    high: tuple[GearPair, Sequence[ContactGrid]]
    difference: float


def require_finite(errors: Any, units: tuple[str, ...]) -> None:
    """Refuse a dataclass of mounting errors of which one is not finite, naming each with its unit."""
    problems = [
        f"{name}: {value!r} {unit} is not finite"
        for (name, value), unit in zip(vars(errors).items(), units, strict=True)
        if not (isinstance(value, int | float | np.number) and math.isfinite(value))
    ]
    if problems:
        raise InputError(problems)


@checked
@dataclass(frozen=True, eq=False)
class GearPair:
    """Two gears in space, with the flanks that may be in contact.

    Attributes
    ----------
    pinion, wheel : Gear
        ``pinion.flank`` and ``wheel.flank`` are in contact, each in its gear's own frame.
    teeth : (int, int)
        Numbers of teeth of pinion and wheel.
    wheel_origin : (3,) array [mm]
        Origin of the wheel frame in the fixed frame, mounting errors included.
    wheel_axes : (3, 3) array
        Axes of the wheel frame, in rows, in the fixed frame.
    sense : int
        +1: the pinion turns about +z; -1: about -z, pushing with its other flank.
    driving : int
        +1: the pinion drives; -1: the wheel does.
    module : float [mm]
        Normal module: the length that small distances are compared with.
    base_radii : (float, float) [mm]
        r_b1 and r_b2, which turn torques into tangential forces and angles into lengths.
    face_width : float [mm]
        Common face width.
    """

    pinion: Gear
    wheel: Gear
    teeth: tuple[int, int]
    wheel_origin: Array
    wheel_axes: Array
    sense: int
    driving: int
    module: float
    base_radii: tuple[float, float]
    face_width: float

    def __post_init__(self) -> None:
        keep_copies(self)

    @property
    def ratio(self) -> float:
        """z1/z2, the mean of d phi2/d phi1."""
        return self.teeth[0] / self.teeth[1]

    @property
    def pitch(self) -> float:
        """Angular pitch of the pinion, 2 pi/z1 [rad]."""
        return 2.0 * math.pi / self.teeth[0]

    @property
    def rate_of_stiffness(self) -> float:
        """d T1/d phi2 = 1e3 r_b1 r_b2 b [N mm/rad] where the mesh stiffness is 1 N/(mm um)."""
        return 1e3 * self.base_radii[0] * self.base_radii[1] * self.face_width

    @cached_property
    def contact_modulus(self) -> float:
        """E* of the two materials [MPa]."""
        return contact_modulus(self.pinion.material, self.wheel.material)

    @property
    def max_pressure(self) -> float | None:
        """Pressure cap of the softer material [MPa]; None if both are elastic."""
        caps = (self.pinion.material.max_pressure, self.wheel.material.max_pressure)
        return min((cap for cap in caps if cap is not None), default=None)

    def with_flanks(self, pinion: Flank | None = None, wheel: Flank | None = None) -> GearPair:
        """The pair with other flanks in contact, fitted or measured ones; None: the flank that is there."""
        return replace(
            self,
            pinion=replace(self.pinion, flank=pinion or self.pinion.flank),
            wheel=replace(self.wheel, flank=wheel or self.wheel.flank),
        )

    def rounded(self, pinion: EdgeRounding = EdgeRounding(), wheel: EdgeRounding = EdgeRounding()) -> GearPair:
        """The pair with rounded tip edges and face ends; itself if all are sharp.

        Raises
        ------
        InputError
            If a radius is larger than 0.3 normal modules, or leaves no flank or no tip land; of both gears at once.

        Examples
        --------
        >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
        >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
        >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
        >>> pair = cylindrical_pair(CylindricalMesh(*gears)).rounded(pinion=EdgeRounding(tip=0.2))
        >>> pair.pinion.flank.rounding
        EdgeRounding(tip=0.2, side=0.0)
        """
        gears, problems = [], []
        for name, gear, rounding in (("pinion", self.pinion, pinion), ("wheel", self.wheel, wheel)):
            try:
                gears.append(gear.rounded(rounding, self.module))
            except InputError as error:
                problems += [f"{name}.{problem}" for problem in error.problems]
        if problems:
            raise InputError(problems)
        return replace(self, pinion=gears[0], wheel=gears[1]) if pinion or wheel else self

    @cached_property
    def sharp(self) -> GearPair:
        """The pair whose flanks in contact have sharp edges; itself if they have."""
        pinion, wheel = self.pinion.sharp, self.wheel.sharp
        same = pinion is self.pinion and wheel is self.wheel
        return self if same else replace(self, pinion=pinion, wheel=wheel)

    @property
    def rigid_bores(self) -> tuple[float, float]:
        """Diameters of the bores, or journals, of both gears [mm] held where teeth bend; the smallest one of a cone.

        Raises
        ------
        InputError
            If a bore leaves no rim below the teeth; every gear that it holds for is named.
        """
        bores, problems = [], []
        for name, gear in (("pinion", self.pinion), ("wheel", self.wheel)):
            try:
                bores.append(gear.smallest_bore)
            except InputError as error:
                problems += [f"{name}: {problem}" for problem in error.problems]
        if problems:
            raise InputError(problems)
        return bores[0], bores[1]

    def to_wheel(self, point: Array) -> tuple[Array, Array, Array]:
        """Cylindrical coordinates (rho, theta, z) of points (..., 3) in the wheel frame."""
        x, y, z = self._in_wheel_frame(point)
        return np.hypot(x, y), np.arctan2(y, x), z

    def on_flanks(self, points: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Places (rho, z) on the flanks of pinion and wheel of points (..., 3) of the fixed frame [mm]."""
        return self.on_pinion(points), self.on_wheel(points)

    def on_pinion(self, points: Array) -> tuple[Array, Array]:
        """Places (rho, z) on the flank of the pinion of points (..., 3) of the fixed frame [mm]."""
        return np.hypot(points[..., 0], points[..., 1]), points[..., 2]

    def on_wheel(self, points: Array) -> tuple[Array, Array]:
        """Places (rho, z) on the flank of the wheel of points (..., 3) of the fixed frame [mm]."""
        x, y, z = self._in_wheel_frame(points)
        return np.hypot(x, y), z

    def _in_wheel_frame(self, points: Array) -> tuple[Array, Array, Array]:
        """Coordinates x, y, z of points (..., 3) of the fixed frame in that of the wheel, (...) each."""
        moved = (points - self.wheel_origin) @ self.wheel_axes.T
        return moved[..., 0], moved[..., 1], moved[..., 2]

    def wheel_basis(self, theta: Array) -> Array:
        """e_rho, e_theta, e_z of the wheel at the azimuth theta, in rows, in the fixed frame: (..., 3, 3)."""
        return cylindrical_basis(theta) @ self.wheel_axes

    def __repr__(self) -> str:
        return (
            f"GearPair({self.teeth[0]}/{self.teeth[1]}, module {plain(self.module, 6)} mm, face "
            f"{plain(self.face_width, 6)} mm)"
        )


def cylindrical_basis(theta: Array) -> Array:
    """e_rho, e_theta, e_z at the azimuth theta, in rows: (..., 3, 3)."""
    basis = np.zeros((*np.shape(theta), 3, 3))
    basis[..., 0, 0] = basis[..., 1, 1] = np.cos(theta)
    basis[..., 0, 1] = np.sin(theta)
    basis[..., 1, 0] = -basis[..., 0, 1]
    basis[..., 2, 2] = 1.0
    return basis


def signs_of(driving: Driving, sense: Sense) -> tuple[int, int]:
    """Signs of the sense of rotation and of the driving gear, as ``GearPair`` keeps them.

    Raises
    ------
    InputError
        If driving or sense is not one of the two.
    """
    if driving not in GEARS:
        raise InputError(f"driving: {driving!r} is not 'pinion' or 'wheel'")
    if sense not in ("positive", "negative"):
        raise InputError(f"sense: {sense!r} is not 'positive' or 'negative'")
    return (1 if sense == "positive" else -1), (1 if driving == "pinion" else -1)


@checked
@dataclass(frozen=True, eq=False)
class MatingTeeth:
    """One tooth of each gear, of the tooth pair in contact.

    Attributes
    ----------
    pair : GearPair
    pinion, wheel : ToothSurface
        Each in its gear's own frame, with the middle of the tooth at mid-face at the azimuth 0.
    """

    pair: GearPair
    pinion: ToothSurface
    wheel: ToothSurface

    def in_mesh(self, pinion_angle: float, wheel_angle: float) -> tuple[TriangleMesh, TriangleMesh]:
        """Both teeth in the fixed frame.

        Parameters
        ----------
        pinion_angle, wheel_angle : float [rad]
            phi1 and phi2, as a contact point has them.
        """
        pair = self.pair
        pinion = self._to_flank(self.pinion).turned(pair.sense * pinion_angle).triangles()
        wheel = self._to_flank(self.wheel).turned(-pair.sense * wheel_angle).triangles()
        return pinion, wheel.moved(pair.wheel_origin, pair.wheel_axes)

    def _to_flank(self, tooth: ToothSurface) -> ToothSurface:
        """The tooth turned until its flank in contact is that of the pair."""
        return tooth.turned(-self.pair.pinion.flank.side * tooth.half_thickness_angle)

    def on_pinion(self, rho: Array, z: Array, pinion_angle: float) -> Array:
        """Points (..., 3) of the pinion's flank in the fixed frame [mm], at its places (rho, z)."""
        theta = self.pair.pinion.flank.theta(rho, z).value + self.pair.sense * pinion_angle
        return np.stack(np.broadcast_arrays(rho * np.cos(theta), rho * np.sin(theta), z), axis=-1)

    def pressure_on_pinion(self, corners: Array, pressure: Array, pinion_angle: float) -> TriangleMesh:
        """Cells under pressure of a pressure map, laid on the pinion's flank, in the fixed frame.

        Parameters
        ----------
        corners : (nx + 1, ny + 1, 3) array [mm]
            Corners of the cells in the tangent plane, in the fixed frame.
        pressure : (nx, ny) array [MPa]
        pinion_angle : float [rad]
            phi1 of the map.

        Returns
        -------
        TriangleMesh
            ``cell_data["pressure_MPa"]``; without any triangle if there is no pressure.

        Raises
        ------
        InputError
            If the shapes do not fit.
        """
        shape = tuple(count - 1 for count in corners.shape[:2])
        if corners.ndim != 3 or corners.shape[2] != 3 or pressure.shape != shape:
            raise InputError(f"pressure: shape {pressure.shape} does not fit corners of shape {corners.shape}")
        index = np.arange((shape[0] + 1) * (shape[1] + 1)).reshape(shape[0] + 1, shape[1] + 1)
        loaded = np.repeat((pressure > 0.0).ravel(), 2)
        used, triangles = np.unique(grid_triangles(index)[loaded], return_inverse=True)
        points = corners.reshape(-1, 3)[used]
        laid = self.on_pinion(np.hypot(points[:, 0], points[:, 1]), points[:, 2], pinion_angle)
        values = np.repeat(pressure.ravel(), 2)[loaded]
        return TriangleMesh(laid, triangles.reshape(-1, 3), cell_data={"pressure_MPa": values})


def mating_teeth(
    pair: GearPair, resolution: Resolution = Resolution(), *, fillet_radius: float | None = None
) -> MatingTeeth:
    """Complete teeth of both gears of a pair.

    Parameters
    ----------
    pair : GearPair
    resolution : Resolution
    fillet_radius : float [mm], optional
        Of arcs at the root, at the mean section. Default: for cylindrical gears the fillet that the basic rack cuts;
        for face-milled gears arcs of the larger edge radius of their blades, the same from toe to heel; for other
        bevel gears, and blades without an edge radius, of 0.38 mean normal modules. A default arc that does not fit is
        made as large as does.

    Raises
    ------
    InputError
        If a fillet radius is not positive and finite, or does not fit; the gear is named.
    GeometryError
        If a tooth is pointed or cut off; the gear is named.

    Examples
    --------
    >>> from loaded_tca.gears import bevel_mesh
    >>> from loaded_tca.pairs.bevel import bevel_pair
    >>> teeth = mating_teeth(bevel_pair(bevel_mesh((20, 40), outer_module=4.0, face_width=20.0)))
    >>> teeth.in_mesh(0.0, 0.0)[0]
    TriangleMesh(3498 vertices, 6720 triangles)
    """
    teeth = []
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        with named(name):
            form = gear.form if fillet_radius is None else gear.form.with_arc(fillet_radius)
            teeth.append(build_tooth(gear.flanks, form, resolution))
    return MatingTeeth(pair, *teeth)
