"""The mesh cycle: what the tooth pairs carry, and how far the wheel lags, over the positions of a pitch."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from loaded_tca.flanks.jet import Array
from loaded_tca.unloaded import ContactPath


def quantity(unit: str, text: str) -> Any:
    """A field of numbers per torque and position, with what result files and tables say of it."""
    return field(metadata={"unit": unit, "text": text})


@dataclass(frozen=True, eq=False)
class PressureMap:
    """Pressure and gap of one position on its grid.

    Attributes
    ----------
    x, y : (nx,), (ny,) array [mm]
        Cell centres across (largest relative curvature) and along the contact, from the contact point.
    pressure : (nx, ny) array [MPa]
    gap : (nx, ny) array [mm]
        Deformed gap; +inf where a flank ends.
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        x, y and the normal out of the pinion, in rows, in the fixed frame.
    """

    x: Array
    y: Array
    pressure: Array
    gap: Array
    origin: Array
    axes: Array

    @property
    def spacing(self) -> tuple[float, float]:
        """Cell sizes (dx, dy) [mm]."""
        return float(self.x[1] - self.x[0]), float(self.y[1] - self.y[0])


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Loaded contact over the positions of a pitch.

    Arrays are (n,) over the positions, with several torques (m, n). NaN where the tooth pair does not touch.

    Attributes
    ----------
    title, scene_toml, version : str
        Of the scene, its whole text, and the package version that made the result.
    path : ContactPath
        The unloaded contact.
    torque : (m,) array [N mm]
        Pinion torques.
    pairs : (pairs,) int array
        Tooth pairs that share the load: 0 is the pair at phi1, +1 the next one.
    load_share : (..., n, pairs) array
        Share of each pair; rows sum to 1.
    maps : tuple of tuple of PressureMap or None
        ``maps[torque][position]``; None where nothing touches.
    """

    title: str
    scene_toml: str
    version: str
    path: ContactPath
    torque: Array
    pairs: Array
    load_share: Array
    maps: tuple[tuple[PressureMap | None, ...], ...]
    transmission_error: Array = quantity("rad", "loaded transmission error, absolute")
    normal_force: Array = quantity("N", "normal force on the tooth pair")
    peak_pressure: Array = quantity("MPa", "peak contact pressure, largest cell")
    hertz_pressure: Array = quantity("MPa", "peak pressure after Hertz; NaN where Hertz does not hold")
    hertz_semi_minor: Array = quantity("mm", "semi-axis of the Hertz ellipse across the contact")
    hertz_semi_major: Array = quantity("mm", "semi-axis of the Hertz ellipse along the contact")
    contact_width: Array = quantity("mm", "width of the contact across, from the pressure map")
    contact_length: Array = quantity("mm", "length of the contact, from the pressure map")
    approach: Array = quantity("mm", "approach of the two flanks along the normal")
    mesh_stiffness: Array = quantity("N/(mm um)", "tangent mesh stiffness of the face width")
    on_edge: Array = quantity("1", "whether the contact reaches a border of a flank")
    iterations: Array = quantity("1", "iterations of the contact solver")
    residual: Array = quantity("1", "residual of the contact solver")

    @property
    def pinion_angle(self) -> Array:
        """phi1 of the positions (n,) [rad]."""
        return self.path.pinion_angle
