"""Comparisons of the subject unloaded."""
