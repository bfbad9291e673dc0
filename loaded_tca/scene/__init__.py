"""Scene files and the scenes they describe.

A scene file is TOML with the unit in every key; ``read_scene`` makes a ``Scene`` of it, or tells every
problem at once. All values are checked and kept in the engineer's units; ``Scene.pair`` converts them. Each family of
gear pairs is a module here, with its sections and its class of scenes; ``pair.type`` picks it. A new family is such a
module, with ``@family`` and its types over its class, and an entry of ``MODULES`` in ``scene/variants.py``.
"""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.scene import bevel, blank_face_milled, cylindrical, double_helical, face_milled, internal
    from loaded_tca.scene.bevel import BevelScene
    from loaded_tca.scene.blank_face_milled import BlankFaceMilledScene
    from loaded_tca.scene.cylindrical import CylindricalScene
    from loaded_tca.scene.double_helical import DoubleHelicalScene
    from loaded_tca.scene.face_milled import FaceMilledScene, hypoid_table
    from loaded_tca.scene.flank_form import FlankForm, Measurement
    from loaded_tca.scene.internal import InternalScene
    from loaded_tca.scene.key_reference import describe_keys
    from loaded_tca.scene.load import Load, LoadCase
    from loaded_tca.scene.model import Scene
    from loaded_tca.scene.parse import parse_scene, read_scene, scene_from_table
    from loaded_tca.scene.sections import Analysis, ElasticMaterial, Modifications
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "Analysis",
    "BevelScene",
    "BlankFaceMilledScene",
    "CylindricalScene",
    "DoubleHelicalScene",
    "ElasticMaterial",
    "FaceMilledScene",
    "FlankForm",
    "InternalScene",
    "Load",
    "LoadCase",
    "Measurement",
    "Modifications",
    "Scene",
    "bevel",
    "blank_face_milled",
    "cylindrical",
    "describe_keys",
    "double_helical",
    "face_milled",
    "hypoid_table",
    "internal",
    "parse_scene",
    "read_scene",
    "scene_from_table",
]
