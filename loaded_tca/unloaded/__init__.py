"""Unloaded tooth contact analysis."""
