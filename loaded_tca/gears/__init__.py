"""Macro geometry of gears, and the cutters and machine settings that cut them."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.gears.basic_settings import duplex_spread_blade, spread_blade
    from loaded_tca.gears.bevel import BevelGear
    from loaded_tca.gears.bevel_blank import BevelBlank
    from loaded_tca.gears.bevel_meshes import BevelMesh, bevel_mesh
    from loaded_tca.gears.blank_gear import BlankGear
    from loaded_tca.gears.cylindrical import CylindricalGear, transverse_profile
    from loaded_tca.gears.cylindrical_mesh import CylindricalMesh
    from loaded_tca.gears.face_milled import (
        Blade,
        Cutter,
        FaceMilledBlank,
        FaceMilledGear,
        FaceMilledMesh,
        MachineSettings,
    )
    from loaded_tca.gears.hypoid import HypoidCones, HypoidMesh
    from loaded_tca.gears.hypoid_blank import HypoidBlank
    from loaded_tca.gears.internal_mesh import InternalMesh
    from loaded_tca.gears.pitch_cones import PitchConeParameters, pitch_cones_by_method_1
    from loaded_tca.gears.rack import Rack, rack_mesh
    from loaded_tca.gears.ring import PinionCutter, RingGear
    from loaded_tca.gears.undercut import Undercut, undercuts
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "BevelBlank",
    "BevelGear",
    "BevelMesh",
    "Blade",
    "BlankGear",
    "Cutter",
    "CylindricalGear",
    "CylindricalMesh",
    "FaceMilledBlank",
    "FaceMilledGear",
    "FaceMilledMesh",
    "HypoidBlank",
    "HypoidCones",
    "HypoidMesh",
    "InternalMesh",
    "MachineSettings",
    "PinionCutter",
    "PitchConeParameters",
    "Rack",
    "RingGear",
    "Undercut",
    "bevel_mesh",
    "duplex_spread_blade",
    "pitch_cones_by_method_1",
    "rack_mesh",
    "spread_blade",
    "transverse_profile",
    "undercuts",
]
