"""What shapes a tooth beside its flanks: how far apart they stand, the root surface, the fillet.

``tooth_forms`` is open: a module of a new gear type registers what its mesh asks for.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.tooth.fillet import Fillet
from loaded_tca.tooth.sections import Sections


@dataclass(frozen=True)
class ToothForm:
    """All of a tooth but its flanks.

    Attributes
    ----------
    teeth : int
        Number of teeth z.
    half_thickness_angle : float [rad]
        From the middle of the tooth to either flank where Theta = 0.
    sections : Sections
    root_radius : callable
        Coordinates (m,) of sections [mm] -> radii (m,) of the images of their root circles [mm].
    fillet : Fillet
    largest_that_fits : bool
        Whether an arc that does not fit into the space is made smaller, instead of an error.
    """

    teeth: int
    half_thickness_angle: float
    sections: Sections
    root_radius: Callable[[Array], Array]
    fillet: Fillet
    largest_that_fits: bool = False


@dataclass(frozen=True)
class RootCylinder:
    """Root circles of a cylindrical gear.

    Parameters
    ----------
    radius : float [mm]
    """

    radius: float

    def __call__(self, coordinate: Array) -> Array:
        """Radius in every section (m,)."""
        return np.full(np.shape(coordinate), self.radius)


@dataclass(frozen=True)
class RootCone:
    r"""Root circles on spheres about the gear's apex, :math:`u = \delta_f - \arcsin(z_0 \sin\delta_f/R)`.

    Parameters
    ----------
    angle : float [rad]
        delta_f, between axis and cone.
    apex : float [mm]
        z_0, where the cone meets the axis, in the gear's own frame.
    """

    angle: float
    apex: float = 0.0

    def __call__(self, coordinate: Array) -> Array:
        """Radius 2 R tan(u/2) of the images (m,)."""
        cone_angle = self.angle - np.arcsin(self.apex * math.sin(self.angle) / coordinate)
        return 2.0 * coordinate * np.tan(0.5 * cone_angle)


@singledispatch
def tooth_forms(
    mesh: object,
    *,
    fillet_radius: float | None = None,  # noqa: ARG001 (of the registered ones)
) -> tuple[ToothForm, ToothForm]:
    """What shapes the teeth of pinion and wheel, beside their flanks.

    Parameters
    ----------
    mesh : CylindricalMesh, BevelMesh or FaceMilledMesh
        Macro geometry; cylindrical gears get the fillet that their basic rack cuts, bevel gears an arc. The root of
        face-milled gears is the root cone of their blanks.
    fillet_radius : float [mm], optional
        Radius of arcs, at the mean section; default: for cylindrical gears the fillet of the rack; for face-milled
        gears the larger edge radius of their blades, the same from toe to heel; for other bevel gears, and blades
        without an edge radius, 0.38 mean normal modules. An arc that does not fit is made as large as does.

    Raises
    ------
    InputError
        If the radius is not positive and finite, or nobody has said how such gears are shaped.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> pinion, wheel = tooth_forms(CylindricalMesh(*gears))
    >>> round(pinion.half_thickness_angle * 34, 6)  # without profile shift half a tooth is a quarter of a pitch
    1.570796
    """
    raise InputError(f"mesh: no complete tooth is known for a {type(mesh).__name__}")
