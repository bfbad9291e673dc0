r"""Teeth of ring gears, as external teeth seen through an inversion.

With the root radius c of the ring the image of a point at the radius rho has the radius

.. math:: r = c^2/\rho .

Angles are kept and circles stay circles: in the image a tooth of a ring grows from its root circle outwards to its
tip, and the outside of the ring is a bore. Whatever is drawn in the images of sections, complete teeth, arcs and the
nodes of finite elements, holds for rings so. The inversion mirrors; sections that are counted along -z mirror back, and
surfaces keep their outside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flanks.cylindrical import RingFlank
from loaded_tca.gears.ring import RingGear
from loaded_tca.plain import plain
from loaded_tca.tooth.families import Held, InvoluteTooth, RootCylinder, ToothForm
from loaded_tca.tooth.fillet import Fillet, FilletCurve, Profile, RackFillet, Sections

FARTHEST = 1e3
"""Images nearer to the middle than those of this many root radii are taken for theirs."""
SMALLEST_OUTSIDE, LARGEST_OUTSIDE = 1.02, 20.0
"""Outer diameters over the largest root diameter: a smaller one leaves no rim."""


@checked
@dataclass(frozen=True)
class InvertedPlanes(Sections):
    """Planes z = const of a ring gear, each seen through the inversion at its root circle.

    The coordinate that tells them apart is that of the ring's lengthwise modifications, -z.

    Parameters
    ----------
    root_radius : float [mm]
        c, the radius that stays what it is.

    Examples
    --------
    >>> planes = InvertedPlanes(50.0)
    >>> float(planes.radius(np.array(40.0), np.array(3.0))), float(planes.coordinate(np.array(40.0), np.array(3.0)))
    (62.5, -3.0)
    """

    root_radius: float

    outwards = -1

    def coordinate(self, rho: Array, z: Array) -> Array:
        """Return -z."""
        return 0.0 * rho - z

    def radius(self, rho: Array, z: Array) -> Array:
        """Return c^2/rho."""
        return self.root_radius**2 / rho + 0.0 * z

    def point(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """Return (c^2/r, -coordinate)."""
        image = np.maximum(radius, self.root_radius / FARTHEST)
        rho, z = np.broadcast_arrays(self.root_radius**2 / image, -coordinate)
        return rho, z

    def direction(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """Return (-c^2/r^2, 0)."""
        nought = 0.0 * (radius + coordinate)
        return nought - (self.root_radius / radius) ** 2, nought

    def radius_beyond(self, radius: Array, coordinate: Array, distance: Array) -> Array:
        """Return c^2/(c^2/r - distance), at most the image of a thousandth of the root radius."""
        rho = np.maximum(self.root_radius**2 / radius - distance, self.root_radius / FARTHEST)
        return self.root_radius**2 / rho + 0.0 * coordinate

    def in_true_size(self, radius: Array, coordinate: Array) -> Array:
        """Return c^2/r: a plane is its own section."""
        return self.point(radius, coordinate)[0]


@dataclass(frozen=True)
class _ImageOfRoot:
    """The fillet of a ring in the image, as :class:`RackFillet` takes those of external gears.

    The tangents towards the root are mirrored at the circle.
    """

    gear: RingGear

    meets_in_corner = False

    def root_fillet(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Radii of the image [mm], and angles from the middle of the tooth [rad]."""
        radius, angle = self.gear.root_fillet(points)
        return self.gear.root_radius**2 / radius, angle

    def root_fillet_tangent(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Radial and circumferential parts of the unit tangents of the image."""
        radial, circumferential = self.gear.root_fillet_tangent(points)
        return -radial, circumferential


@checked
@dataclass(frozen=True)
class RingFillet(Fillet):
    """Fillet at the root of a ring: an arc, or the curve that a pinion-type cutter cuts.

    Parameters
    ----------
    gear : RingGear
    """

    gear: RingGear

    def curve(self, profile: Profile, root_radius: Array, count: int) -> FilletCurve:
        """The image of the curve, turned to each section."""
        return RackFillet(_ImageOfRoot(self.gear)).curve(profile, root_radius, count)


@dataclass(frozen=True)
class Outside(Held):
    """The outside of a ring.

    Parameters
    ----------
    default_radius : float [mm]
        Where none is given.
    """

    default_radius: float

    def radius(self, diameter: float | None, root: Array) -> Array:
        """Radius (k,) of the outside [mm]."""
        outer, largest = 2.0 * self.default_radius if diameter is None else diameter, 2.0 * float(root.max())
        if not SMALLEST_OUTSIDE * largest <= outer <= LARGEST_OUTSIDE * largest:
            raise InputError(
                f"outer_diameter: {plain(outer, 6)} mm is not between {plain(SMALLEST_OUTSIDE, 6)} and "
                f"{plain(LARGEST_OUTSIDE, 6)} times the root diameter, {plain(largest, 6)} mm: where it is smaller no "
                "rim is left outside the teeth"
            )
        return np.full_like(root, 0.5 * outer)


@dataclass(frozen=True)
class RingTooth(InvoluteTooth):
    """Involute teeth of a ring gear.

    Parameters
    ----------
    gear : RingGear
    working_radius, active, modifications
        As of every ``InvoluteTooth``.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, InternalMesh
    >>> pinion = CylindricalGear(teeth=25, normal_module=3.0, face_width=25.0)
    >>> mesh = InternalMesh(pinion, RingGear(teeth=-60, normal_module=3.0, face_width=25.0))
    >>> form = RingTooth(mesh.ring, mesh.wheel_working_radius, mesh.wheel_active_profile).form()
    >>> round(form.half_thickness_angle * 60, 6)  # without profile shift half a tooth is a quarter of a pitch
    1.570796
    """

    gear: RingGear

    flank = RingFlank

    def form(self) -> ToothForm:
        """Transverse sections through the inversion, root cylinder, and the fillet of the ring."""
        gear, root = self.gear, self.gear.root_radius
        sections, held = InvertedPlanes(root), Outside(gear.outer_radius)
        angle, fillet = self.half_thickness_angle, RingFillet(gear)
        return ToothForm(gear.tooth_count, angle, sections, RootCylinder(root), fillet, held=held)
