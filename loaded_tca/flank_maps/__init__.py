"""Maps over a whole flank: ease-off topography, contact pattern, V-H check."""

from loaded_tca.flank_maps.ease_off_map import ease_off_map
from loaded_tca.flank_maps.pattern import ContactArea, ContactPattern, contact_area, contact_pattern

__all__ = ["ContactArea", "ContactPattern", "contact_area", "contact_pattern", "ease_off_map"]
