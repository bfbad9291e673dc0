"""Macro geometry of gears."""

from loaded_tca.gears.bevel import BevelGear, BevelMesh, bevel_mesh
from loaded_tca.gears.bevel_blank import BevelBlank
from loaded_tca.gears.blank_gear import BlankGear
from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.cylindrical_mesh import CylindricalMesh

__all__ = ["BevelBlank", "BevelGear", "BevelMesh", "BlankGear", "CylindricalGear", "CylindricalMesh", "bevel_mesh"]
