"""Comparisons of the subject cylindrical."""
