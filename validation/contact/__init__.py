"""Comparisons of the subject contact."""
