"""Unloaded tooth contact analysis: where the flanks touch first, and what the wheel lags behind."""

from loaded_tca.unloaded.curvature import RelativeCurvature, heelwards, relative_curvature
from loaded_tca.unloaded.path import ContactPath, ContactPoint, trace_contact
from loaded_tca.unloaded.pattern import ContactArea, ContactPattern, contact_area, contact_pattern
from loaded_tca.unloaded.teeth import MeshPath, trace_teeth

__all__ = [
    "ContactArea",
    "ContactPath",
    "ContactPattern",
    "ContactPoint",
    "MeshPath",
    "RelativeCurvature",
    "contact_area",
    "contact_pattern",
    "heelwards",
    "relative_curvature",
    "trace_contact",
    "trace_teeth",
]
