"""What is written to files and the terminal: reports, tables, comparisons, teeth, stresses, sensitivities, dynamics."""

from loaded_tca.output.comparison_files import write_comparison
from loaded_tca.output.dynamics_files import write_dynamics
from loaded_tca.output.overview import describe_scene
from loaded_tca.output.report import describe_results, write_report
from loaded_tca.output.sensitivity_files import sensitivities_text, write_sensitivities
from loaded_tca.output.subsurface_files import write_subsurface
from loaded_tca.output.surface_files import write_stl, write_teeth, write_vtk
from loaded_tca.output.teeth_in_space import teeth_in_space

__all__ = [
    "describe_results",
    "describe_scene",
    "sensitivities_text",
    "teeth_in_space",
    "write_comparison",
    "write_dynamics",
    "write_report",
    "write_sensitivities",
    "write_stl",
    "write_subsurface",
    "write_teeth",
    "write_vtk",
]
