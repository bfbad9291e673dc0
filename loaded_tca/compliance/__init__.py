"""Tooth compliance by finite elements: bending, shear, foundation, coupling of neighbouring teeth."""

from loaded_tca.compliance.compliance import ToothCompliance, default_density, tooth_compliance
from loaded_tca.compliance.influence import FlankLine, GearCompliance, gear_compliance
from loaded_tca.compliance.layout import MeshDensity

__all__ = [
    "FlankLine",
    "GearCompliance",
    "MeshDensity",
    "ToothCompliance",
    "default_density",
    "gear_compliance",
    "tooth_compliance",
]
