"""Errors that results tell of their peak pressures, beside those against fine grids, over random contacts of all families.

Each contact carries all of a random torque by itself, at a random position, with teeth that bend and free edges, once
to a random accuracy, as an analysis does, and once on a grid of 96 x 384 cells in the same box.
"""
