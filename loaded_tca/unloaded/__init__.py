"""Unloaded tooth contact analysis: where the flanks touch first, and what the wheel lags behind."""

from loaded_tca.unloaded.curvature import RelativeCurvature, relative_curvature
from loaded_tca.unloaded.path import ContactPath, ContactPoint, trace_contact

__all__ = ["ContactPath", "ContactPoint", "RelativeCurvature", "relative_curvature", "trace_contact"]
