"""Tooth flanks, each a function theta = Theta(rho, z)."""

from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.involute import InvoluteFlank
from loaded_tca.flanks.modification import FlankModifications, ModifiedFlank
from loaded_tca.flanks.spherical_involute import SphericalInvoluteFlank

__all__ = ["Flank", "FlankModifications", "InvoluteFlank", "ModifiedFlank", "SphericalInvoluteFlank"]
