"""Tribology of loaded contacts: loss, temperatures, film thickness, scuffing and micropitting, read off a result."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.tribology.call import tribology_of
    from loaded_tca.tribology.conditions import Lubricant
    from loaded_tca.tribology.tribology import Tribology
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = ["Lubricant", "Tribology", "tribology_of"]
