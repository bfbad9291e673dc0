"""Methods of the literature, kept to compare with: nothing else of the package imports them."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.baselines.bidirectional import BidirectionalStart, GeneratingLine
    from loaded_tca.baselines.conventional import solve_conventional
    from loaded_tca.baselines.golden_section import search_golden_section
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = ["BidirectionalStart", "GeneratingLine", "search_golden_section", "solve_conventional"]
