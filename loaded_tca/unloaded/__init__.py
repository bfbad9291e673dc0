"""Unloaded tooth contact analysis: where the flanks touch first, and what the wheel lags behind."""

from loaded_tca.unloaded.path import ContactPath, ContactPoint, trace_contact

__all__ = ["ContactPath", "ContactPoint", "trace_contact"]
