"""Contact of two elastic half-spaces over a gap given on a grid."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.contact.adaptive import solve_to_accuracy
    from loaded_tca.contact.edges import FreeEdge, RoundedEdge, factors_across, quarter_space_factor, wedge_factor
    from loaded_tca.contact.graded import solve_graded
    from loaded_tca.contact.problem import ContactProblem, GradedProblem
    from loaded_tca.contact.rounded_edge import EdgePressure, edge_pressures
    from loaded_tca.contact.solution import ContactSolution, ContactStatus, ErrorEstimate, GradedSolution
    from loaded_tca.contact.solver import contact_stiffness, solve_contact, solve_problem, solve_problems
    from loaded_tca.contact.subsurface import SubsurfaceStress, depths_below, subsurface_stress
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "ContactProblem",
    "ContactSolution",
    "ContactStatus",
    "EdgePressure",
    "ErrorEstimate",
    "FreeEdge",
    "GradedProblem",
    "GradedSolution",
    "RoundedEdge",
    "SubsurfaceStress",
    "contact_stiffness",
    "depths_below",
    "edge_pressures",
    "factors_across",
    "quarter_space_factor",
    "solve_contact",
    "solve_graded",
    "solve_problem",
    "solve_problems",
    "solve_to_accuracy",
    "subsurface_stress",
    "wedge_factor",
]
