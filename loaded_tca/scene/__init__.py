"""Scene files and the scenes they describe.

A scene file is TOML with the unit in every key; ``read_scene`` makes a ``Scene`` of it, or tells every
problem at once. All values are checked and kept in the engineer's units; ``Scene.pair`` converts them.
"""

from loaded_tca.scene.describe import describe_keys
from loaded_tca.scene.model import Scene, scene_from_table
from loaded_tca.scene.parse import parse_scene, read_scene
from loaded_tca.scene.sections import (
    Analysis,
    ElasticMaterial,
    Gear,
    Geometry,
    Load,
    Modifications,
    MountingErrors,
)

__all__ = [
    "Analysis",
    "ElasticMaterial",
    "Gear",
    "Geometry",
    "Load",
    "Modifications",
    "MountingErrors",
    "Scene",
    "describe_keys",
    "parse_scene",
    "read_scene",
    "scene_from_table",
]
