"""Complete teeth of both gears where they stand in mesh, and the pressure on the pinion's flank."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, named
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.tooth.build import Resolution, build_tooth
from loaded_tca.tooth.surface import ToothSurface
from loaded_tca.tooth.triangles import TriangleMesh, grid_triangles


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
