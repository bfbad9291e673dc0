"""What is written to files and the terminal: reports, tables, comparisons, teeth, stresses, sensitivities, dynamics."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.output.overview import describe_scene
    from loaded_tca.output.result_fields import describe_results
    from loaded_tca.output.result_files import (
        write_rating,
        write_report,
        write_result,
        write_revolution,
        write_stage,
        write_tribology,
    )
    from loaded_tca.output.rexs import write_rexs
    from loaded_tca.output.surface_files import write_stl, write_teeth, write_vtk
    from loaded_tca.output.tables import (
        sensitivities_text,
        write_comparison,
        write_dynamics,
        write_sensitivities,
        write_subsurface,
    )
    from loaded_tca.results.teeth import teeth_in_space
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "describe_results",
    "describe_scene",
    "sensitivities_text",
    "teeth_in_space",
    "write_comparison",
    "write_dynamics",
    "write_rating",
    "write_report",
    "write_result",
    "write_revolution",
    "write_rexs",
    "write_sensitivities",
    "write_stage",
    "write_stl",
    "write_subsurface",
    "write_teeth",
    "write_tribology",
    "write_vtk",
]
