"""Semi-analytical loaded tooth contact analysis of gears."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca import (
        baselines,
        compliance,
        contact,
        flank_maps,
        flanks,
        gears,
        output,
        pairs,
        plots,
        reference,
        results,
        scene,
        separation,
        tooth,
        unloaded,
    )
    from loaded_tca.analysis import analyse
    from loaded_tca.contact import solve_contact
    from loaded_tca.errors import AccuracyWarning, ConvergenceError, GeometryError, InputError, LoadedTCAError
    from loaded_tca.results import MeshCycle, load_result
    from loaded_tca.scene import Scene, parse_scene, read_scene
    from loaded_tca.separation import sample_separation
    from loaded_tca.unloaded import trace_contact
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "AccuracyWarning",
    "ConvergenceError",
    "GeometryError",
    "InputError",
    "LoadedTCAError",
    "MeshCycle",
    "Scene",
    "analyse",
    "baselines",
    "compliance",
    "contact",
    "flank_maps",
    "flanks",
    "gears",
    "load_result",
    "output",
    "pairs",
    "parse_scene",
    "plots",
    "read_scene",
    "reference",
    "results",
    "sample_separation",
    "scene",
    "separation",
    "solve_contact",
    "tooth",
    "trace_contact",
    "unloaded",
]
