"""Tooth compliance by finite elements: bending, shear, foundation, coupling of neighbouring teeth; root stress."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.compliance.compliance import (
        ToothCompliance,
        default_density,
        flank_lines,
        tooth_compliance,
    )
    from loaded_tca.compliance.influence import FlankLine, GearCompliance, gear_compliance
    from loaded_tca.compliance.layout import MeshDensity
    from loaded_tca.compliance.model import BendingModel, model_of
    from loaded_tca.compliance.root_stress import RootStress, root_stress_model
    from loaded_tca.compliance.teeth import require_teeth, warn_of_teeth, way_out_told
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "BendingModel",
    "FlankLine",
    "GearCompliance",
    "MeshDensity",
    "RootStress",
    "ToothCompliance",
    "default_density",
    "flank_lines",
    "gear_compliance",
    "model_of",
    "require_teeth",
    "root_stress_model",
    "tooth_compliance",
    "warn_of_teeth",
    "way_out_told",
]
