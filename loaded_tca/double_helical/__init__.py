"""Double helical pairs: two halves that share a torque and an axial position, above the analyses of both."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.double_helical.analyse import analyse_double_helical
    from loaded_tca.double_helical.rating import DoubleHelicalRating
    from loaded_tca.double_helical.result import DoubleHelicalResult
    from loaded_tca.double_helical.revolution import DoubleHelicalRevolution, analyse_double_helical_revolution
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "DoubleHelicalRating",
    "DoubleHelicalResult",
    "DoubleHelicalRevolution",
    "analyse_double_helical",
    "analyse_double_helical_revolution",
]
