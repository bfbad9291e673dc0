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
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.involute import InvoluteFlank
from loaded_tca.flanks.jet import Array
from loaded_tca.flanks.modification import FlankModifications, modified
from loaded_tca.gears import CylindricalMesh
from loaded_tca.material import Material, contact_modulus

Driving = Literal["pinion", "wheel"]
Sense = Literal["positive", "negative"]
LARGEST_ANGLE = math.radians(45.0)
"""Angular errors stay below this [rad]: the axes are those of parallel gears, which still face each other."""


def require_finite(errors: Any, units: tuple[str, ...]) -> None:
    """Refuse a dataclass of mounting errors of which one is not finite, naming each with its unit."""
    values = [
        (entry.name, getattr(errors, entry.name), unit) for entry, unit in zip(fields(errors), units, strict=True)
    ]
    problems = [f"{name}: {value!r} {unit} is not finite" for name, value, unit in values if not _is_finite(value)]
    if problems:
        raise InputError(problems)


def _is_finite(value: Any) -> bool:
    return isinstance(value, int | float | np.number) and math.isfinite(value)


def numbers(name: str, values: ArrayLike) -> Array:
    """An argument as an array of floats; InputError if it is none."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name}: an array of finite numbers is asked for, not {values!r:.60}") from None


def finite_row(name: str, values: ArrayLike) -> Array:
    """An argument as a row (n,) of finite numbers, at least one; InputError if it is none."""
    row = numbers(name, values)
    if row.ndim != 1 or not row.size or not np.isfinite(row).all():
        raise InputError(f"{name}: shape {row.shape} with finite numbers only in one dimension is asked for")
    return row


@dataclass(frozen=True)
class Mounting:
    """Mounting errors of parallel axes.

    Parameters
    ----------
    in_plane : float [rad]
        gamma, in the plane of the axes; positive when the wheel's axis leaves the pinion at z > 0.
    out_of_plane : float [rad]
        delta, across that plane; positive when the wheel moves towards -y at z > 0.
    centre_distance_error : float [mm]
        Positive: apart.
    axial_offset : float [mm]
        Positive: wheel towards +z.

    Raises
    ------
    InputError
        If a value is not finite, or an angle not between -45 and 45 deg.
    """

    in_plane: float = 0.0
    out_of_plane: float = 0.0
    centre_distance_error: float = 0.0
    axial_offset: float = 0.0

    def __post_init__(self) -> None:
        require_finite(self, ("rad", "rad", "mm", "mm"))
        limit = f"is not between -{math.degrees(LARGEST_ANGLE):.3g} and {math.degrees(LARGEST_ANGLE):.3g} deg"
        angles = {"in_plane": self.in_plane, "out_of_plane": self.out_of_plane}
        problems = [
            f"{name}: {angle:.6g} rad, {math.degrees(angle):.6g} deg, {limit}: the axes are nearly parallel"
            for name, angle in angles.items()
            if abs(angle) >= LARGEST_ANGLE
        ]
        if problems:
            raise InputError(problems)

    def place_parallel(self, centre_distance: float) -> tuple[Array, Array]:
        """Origin (3,) and axes (3, 3), in rows, of the wheel frame: R_y(gamma) R_x(delta) about its mid-face."""
        gamma, delta = self.in_plane, self.out_of_plane
        about_x = np.array(
            [[1, 0, 0], [0, math.cos(delta), -math.sin(delta)], [0, math.sin(delta), math.cos(delta)]],
            dtype=float,
        )
        about_y = np.array(
            [[math.cos(gamma), 0, math.sin(gamma)], [0, 1, 0], [-math.sin(gamma), 0, math.cos(gamma)]],
            dtype=float,
        )
        nominal = np.diag([-1.0, -1.0, 1.0])
        origin = np.array([centre_distance + self.centre_distance_error, 0.0, self.axial_offset])
        return origin, nominal @ (about_y @ about_x).T


@dataclass(frozen=True, eq=False)
class GearPair:
    """Two flanks that may touch, and where their gears stand.

    Attributes
    ----------
    pinion, wheel : Flank
        The flanks in contact, each in its gear's own frame.
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
    materials : (Material, Material)
    module : float [mm]
        Normal module: the length that small distances are compared with.
    base_radii : (float, float) [mm]
        r_b1 and r_b2, which turn torques into tangential forces and angles into lengths.
    face_width : float [mm]
        Common face width.
    """

    pinion: Flank
    wheel: Flank
    teeth: tuple[int, int]
    wheel_origin: Array
    wheel_axes: Array
    sense: int
    driving: int
    materials: tuple[Material, Material]
    module: float
    base_radii: tuple[float, float]
    face_width: float

    @property
    def ratio(self) -> float:
        """z1/z2, the mean of d phi2/d phi1."""
        return self.teeth[0] / self.teeth[1]

    @property
    def pitch(self) -> float:
        """Angular pitch of the pinion, 2 pi/z1 [rad]."""
        return 2.0 * math.pi / self.teeth[0]

    @property
    def contact_modulus(self) -> float:
        """E* of the two materials [MPa]."""
        return contact_modulus(*self.materials)

    @property
    def max_pressure(self) -> float | None:
        """Pressure cap of the softer material [MPa]; None if both are elastic."""
        caps = [material.max_pressure for material in self.materials if material.max_pressure is not None]
        return min(caps) if caps else None

    def to_wheel(self, point: Array) -> tuple[Array, Array, Array]:
        """Cylindrical coordinates (rho, theta, z) of points (..., 3) in the wheel frame."""
        x, y, z = np.moveaxis((point - self.wheel_origin) @ self.wheel_axes.T, -1, 0)
        return np.hypot(x, y), np.arctan2(y, x), z

    def wheel_basis(self, theta: Array) -> Array:
        """e_rho, e_theta, e_z of the wheel at the azimuth theta, in rows, in the fixed frame: (..., 3, 3)."""
        return cylindrical_basis(theta) @ self.wheel_axes

    def __repr__(self) -> str:
        return f"GearPair({self.teeth[0]}/{self.teeth[1]}, module {self.module:g} mm, face {self.face_width:g} mm)"


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
    if driving not in ("pinion", "wheel"):
        raise InputError(f"driving: {driving!r} is not 'pinion' or 'wheel'")
    if sense not in ("positive", "negative"):
        raise InputError(f"sense: {sense!r} is not 'positive' or 'negative'")
    return (1 if sense == "positive" else -1), (1 if driving == "pinion" else -1)


def cylindrical_pair(
    mesh: CylindricalMesh,
    *,
    modifications: tuple[FlankModifications, FlankModifications] = (
        FlankModifications(),
        FlankModifications(),
    ),
    mounting: Mounting = Mounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    driving: Driving = "pinion",
    sense: Sense = "positive",
) -> GearPair:
    """Pair of external spur or helical gears.

    Parameters
    ----------
    mesh : CylindricalMesh
        Macro geometry.
    modifications : (FlankModifications, FlankModifications)
        Of pinion and wheel.
    mounting : Mounting
        Errors of the wheel's position.
    materials : (Material, Material)
        Of pinion and wheel.
    driving : {"pinion", "wheel"}
    sense : {"positive", "negative"}
        "negative": the pinion turns about -z and touches with its other flank.

    Raises
    ------
    InputError
        If driving or sense is not one of the two, or a relief starts off the active profile.
    GeometryError
        If the teeth wind a whole turn around a gear over its face width.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> cylindrical_pair(CylindricalMesh(*gears))
    GearPair(34/57, module 3 mm, face 25 mm)
    """
    turning, drive = signs_of(driving, sense)
    side = turning * drive
    _require_less_than_a_turn(mesh)
    flanks = [_involute_flank(mesh, member, side, modifications[member]) for member in (0, 1)]
    origin, axes = mounting.place_parallel(mesh.working_centre_distance)
    return GearPair(
        pinion=flanks[0],
        wheel=flanks[1],
        teeth=(mesh.pinion.teeth, mesh.wheel.teeth),
        wheel_origin=origin,
        wheel_axes=axes,
        sense=turning,
        driving=drive,
        materials=materials,
        module=mesh.pinion.normal_module,
        base_radii=(mesh.pinion.base_radius, mesh.wheel.base_radius),
        face_width=min(mesh.pinion.face_width, mesh.wheel.face_width),
    )


def _require_less_than_a_turn(mesh: CylindricalMesh) -> None:
    """Refuse teeth that wind around their gear: in one position they would be in mesh at two places."""
    for gear in (mesh.pinion, mesh.wheel):
        turn = gear.face_width * abs(math.tan(gear.base_helix_angle)) / gear.base_radius
        if turn >= 2.0 * math.pi:
            raise GeometryError(
                f"{gear.name}: its teeth wind {turn / (2.0 * math.pi):.3g} times around the gear over its face width, "
                f"{gear.face_width:.6g} mm; less than one turn is allowed"
            )


def _involute_flank(mesh: CylindricalMesh, member: int, side: int, modifications: FlankModifications) -> Flank:
    gear = (mesh.pinion, mesh.wheel)[member]
    working_radius = (mesh.pinion_working_radius, mesh.wheel_working_radius)[member]
    active = (mesh.pinion_active_profile, mesh.wheel_active_profile)[member]
    nominal = InvoluteFlank(
        gear.base_radius,
        gear.base_helix_angle,
        side,
        working_radius,
        (gear.form_radius, gear.tip_radius),
        gear.face_width,
    )
    diameters = (2.0 * active.start_radius, 2.0 * active.end_radius)

    def roll_length(diameter: float) -> float:
        return gear.roll_length(0.5 * diameter)

    return modified(nominal, modifications, gear.face_width, diameters, roll_length, owner=gear.name)
