"""Macro geometry of gears."""

from loaded_tca.gears.cylindrical import CylindricalGear, CylindricalMesh

__all__ = ["CylindricalGear", "CylindricalMesh"]
