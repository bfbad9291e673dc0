"""Contact of two elastic half-spaces over a gap given on a grid."""

from loaded_tca.contact.adaptive import solve_to_accuracy
from loaded_tca.contact.solution import ContactSolution, ContactStatus, ErrorEstimate
from loaded_tca.contact.solver import contact_stiffness, solve_contact

__all__ = [
    "ContactSolution",
    "ContactStatus",
    "ErrorEstimate",
    "contact_stiffness",
    "solve_contact",
    "solve_to_accuracy",
]
