"""Comparisons of the subject loaded."""
