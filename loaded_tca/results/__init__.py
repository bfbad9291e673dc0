"""Results of an analysis: the mesh cycle, its figures and file, stresses below the flanks, comparisons."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.results.comparison import Comparison, compare_results
    from loaded_tca.results.mesh_cycle import MeshCycle, load_result
    from loaded_tca.results.pressure_map import PressureMap
    from loaded_tca.results.revolution import Revolution, Spectrum
    from loaded_tca.results.root_stress import RootStressMap
    from loaded_tca.results.sensitivities import Sensitivities
    from loaded_tca.results.subsurface import StressBelow, stress_below
    from loaded_tca.results.supports import element_forces
    from loaded_tca.results.tolerances import default_tolerances, key_figure_slopes
    from loaded_tca.results.warnings import reached_edges
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "Comparison",
    "MeshCycle",
    "PressureMap",
    "Revolution",
    "RootStressMap",
    "Sensitivities",
    "Spectrum",
    "StressBelow",
    "compare_results",
    "default_tolerances",
    "element_forces",
    "key_figure_slopes",
    "load_result",
    "reached_edges",
    "stress_below",
]
