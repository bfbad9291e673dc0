"""Tolerance classes of ISO 1328-1 as scatter of the keys of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from loaded_tca.errors import named
from loaded_tca.gears.involute_mesh import InvoluteMesh
from loaded_tca.reference.iso1328 import flank_tolerances
from loaded_tca.scene.section import values_of

if TYPE_CHECKING:
    from loaded_tca.scene.model import Scene

DEVIATIONS_IN_A_TOLERANCE = 3.0
"""Standard deviations from the nominal slope to its tolerance: 99.7 % of the gears are of the class, as of a process
that is capable of it and no better."""
SLOPES = {"helix_slope_um": "helix_slope", "profile_slope_um": "profile_slope"}
"""Key of the modifications -> the tolerance that bounds its deviation, to either side."""


def slope_tolerances(mesh: InvoluteMesh, tolerance_class: int) -> dict[str, float]:
    """Tolerances f_HbetaT and f_HalphaT of both gears by the keys that they bound, as drawings have them [um].

    Raises
    ------
    InputError
        Outside the classes and ranges of ISO 1328-1, with the gear.
    """
    bounds: dict[str, float] = {}
    for name, gear in (("pinion", mesh.pinion), ("wheel", mesh.wheel)):
        with named(name):
            tolerances = flank_tolerances(
                abs(gear.teeth), gear.normal_module, gear.face_width, tolerance_class, gear.helix_angle
            )
        bounds |= {f"{name}.modifications.{key}": getattr(tolerances, bound) for key, bound in SLOPES.items()}
    return bounds


def scatter_of_class(scene: Scene, tolerance_class: int, *, deviations: bool = False) -> dict[str, Any]:
    """Return normal distributions of the slopes of a scene's gears that are of a class; see the scene's method."""
    from scipy.stats import norm  # half a second, which scenes without scatter do not need

    nominal = {} if deviations else values_of(scene)
    return {
        key: norm(nominal.get(key, 0.0), bound / DEVIATIONS_IN_A_TOLERANCE)
        for key, bound in scene.slope_tolerances(tolerance_class).items()
    }
