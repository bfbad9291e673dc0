"""Rating of loaded contacts: safeties and lives of flanks and roots after ISO 6336 or 10300, and by local stresses."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.rating.call import rating_of
    from loaded_tca.rating.places import flank_safeties, root_safeties
    from loaded_tca.rating.rating import Rating
    from loaded_tca.rating.spectrum import SpectrumRating
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = ["Rating", "SpectrumRating", "flank_safeties", "rating_of", "root_safeties"]
