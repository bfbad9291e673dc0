"""What shapes a tooth beside its flanks: how far apart they stand, the root surface, the fillet."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.tooth.fillet import ArcFillet, Fillet
from loaded_tca.tooth.sections import Sections


@dataclass(frozen=True)
class ToothForm:
    """Form of a tooth without its flanks: thickness, root surface and fillet.

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

    def with_arc(self, radius: float) -> ToothForm:
        """The form with arcs of a radius [mm], at the mean section, instead of the fillet that belongs to the gear.

        Raises
        ------
        InputError
            If the radius is not positive and finite.
        """
        arc = replace(self.fillet, radius=radius) if isinstance(self.fillet, ArcFillet) else ArcFillet(radius)
        return replace(self, fillet=arc, largest_that_fits=False)


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
