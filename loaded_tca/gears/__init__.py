"""Macro geometry of gears."""
