"""Comparisons of the subject face milled."""
