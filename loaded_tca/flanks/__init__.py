"""Tooth flanks, each a function theta = Theta(rho, z)."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.flanks.base import ConeFrame, CylinderFrame, Flank, FlankFrame
    from loaded_tca.flanks.bevel import SphericalInvoluteFlank
    from loaded_tca.flanks.cylindrical import InvoluteFlank
    from loaded_tca.flanks.face_milled import FlankAngles, GeneratedFlank
    from loaded_tca.flanks.hypoid_synthesis import Mismatch, synthesised_gears
    from loaded_tca.flanks.modification import FlankModifications
    from loaded_tca.flanks.removal import ModifiedFlank
    from loaded_tca.flanks.rounding import EdgeRounding, RoundedFlank
    from loaded_tca.flanks.spline import SplineFlank, fitted, measured
    from loaded_tca.flanks.topography import MeasuredDeviations, MeasuredPoints, Topography, read_topography
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "ConeFrame",
    "CylinderFrame",
    "EdgeRounding",
    "Flank",
    "FlankAngles",
    "FlankFrame",
    "FlankModifications",
    "GeneratedFlank",
    "InvoluteFlank",
    "MeasuredDeviations",
    "MeasuredPoints",
    "Mismatch",
    "ModifiedFlank",
    "RoundedFlank",
    "SphericalInvoluteFlank",
    "SplineFlank",
    "Topography",
    "fitted",
    "measured",
    "read_topography",
    "synthesised_gears",
]
