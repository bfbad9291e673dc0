"""Comparisons with numbers from outside the project, and studies of speed against error."""
