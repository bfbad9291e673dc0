"""Tooth compliance by finite elements: bending, shear, foundation, coupling of neighbouring teeth."""

from loaded_tca.tooth_compliance.body import DEFAULT_BORE, GearTooth
from loaded_tca.tooth_compliance.compliance import (
    PairForce,
    ToothCompliance,
    default_density,
    force_of_contact,
    pair_force,
    tooth_compliance,
)
from loaded_tca.tooth_compliance.influence import GearCompliance, LineForce, gear_compliance
from loaded_tca.tooth_compliance.layout import MeshDensity

__all__ = [
    "DEFAULT_BORE",
    "GearCompliance",
    "GearTooth",
    "LineForce",
    "MeshDensity",
    "PairForce",
    "ToothCompliance",
    "default_density",
    "force_of_contact",
    "gear_compliance",
    "pair_force",
    "tooth_compliance",
]
