"""Unloaded tooth contact analysis: where the flanks touch first, and what the wheel stays behind."""

from loaded_tca.unloaded.curvature import RelativeCurvature, heelwards, relative_curvature
from loaded_tca.unloaded.path import ContactPath, ContactPoint, trace_contact
from loaded_tca.unloaded.teeth import MeshPath, trace_teeth

__all__ = [
    "ContactPath",
    "ContactPoint",
    "MeshPath",
    "RelativeCurvature",
    "heelwards",
    "relative_curvature",
    "trace_contact",
    "trace_teeth",
]
