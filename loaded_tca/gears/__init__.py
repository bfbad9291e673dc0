"""Macro geometry of gears."""

from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.cylindrical_mesh import CylindricalMesh

__all__ = ["CylindricalGear", "CylindricalMesh"]
