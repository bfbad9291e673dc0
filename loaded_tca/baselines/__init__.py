"""Methods of the literature, kept to compare with: nothing else of the package imports them."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.baselines.bidirectional import BidirectionalStart, Guess, StartValues
    from loaded_tca.baselines.conventional import ConventionalResult, solve_conventional, solve_with_scipy_root
    from loaded_tca.baselines.generating_line import GeneratingLine, LinePoints
    from loaded_tca.baselines.golden_section import GoldenSectionResult, search_golden_section
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "BidirectionalStart",
    "ConventionalResult",
    "GeneratingLine",
    "GoldenSectionResult",
    "Guess",
    "LinePoints",
    "StartValues",
    "search_golden_section",
    "solve_conventional",
    "solve_with_scipy_root",
]
