"""Semi-analytical loaded tooth contact analysis of gears."""

from loaded_tca.analysis import analyse
from loaded_tca.contact import solve_contact
from loaded_tca.errors import AccuracyWarning, ConvergenceError, GeometryError, InputError, LoadedTCAError
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene, read_scene
from loaded_tca.separation import sample_separation
from loaded_tca.unloaded import trace_contact

load_result = MeshCycle.load

__all__ = [
    "AccuracyWarning",
    "ConvergenceError",
    "GeometryError",
    "InputError",
    "LoadedTCAError",
    "MeshCycle",
    "Scene",
    "analyse",
    "load_result",
    "read_scene",
    "sample_separation",
    "solve_contact",
    "trace_contact",
]
