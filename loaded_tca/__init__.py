"""Semi-analytical loaded tooth contact analysis of gears."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.analysis import analyse
    from loaded_tca.contact import solve_contact
    from loaded_tca.errors import (
        AccuracyWarning,
        ConvergenceError,
        DamageWarning,
        GeometryError,
        InputError,
        LoadedTCAError,
        NotAskedError,
    )
    from loaded_tca.loaded.shaft_lines import shaft_lines
    from loaded_tca.results import MeshCycle, Revolution, load_result
    from loaded_tca.revolution import analyse_revolution
    from loaded_tca.scene import Scene, parse_scene, read_scene
    from loaded_tca.separation import sample_separation
    from loaded_tca.unloaded import trace_contact

    __version__: str
else:
    _load, __dir__ = lazy_names(__name__)

    def __getattr__(name: str) -> object:
        if name == "__version__":
            from importlib.metadata import version

            return version("loaded_tca")
        return _load(name)


__all__ = [
    "AccuracyWarning",
    "ConvergenceError",
    "DamageWarning",
    "GeometryError",
    "InputError",
    "LoadedTCAError",
    "MeshCycle",
    "NotAskedError",
    "Revolution",
    "Scene",
    "analyse",
    "analyse_revolution",
    "load_result",
    "parse_scene",
    "read_scene",
    "sample_separation",
    "shaft_lines",
    "solve_contact",
    "trace_contact",
]
