"""Macro geometry of gears."""

from loaded_tca.gears.bevel import BevelGear, BevelMesh, bevel_mesh
from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.cylindrical_mesh import CylindricalMesh

__all__ = ["BevelGear", "BevelMesh", "CylindricalGear", "CylindricalMesh", "bevel_mesh"]
