"""Comparisons of the subject bevel."""
