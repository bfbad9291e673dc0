"""Maps over a whole flank: ease-off topography, contact pattern, V-H check."""

from loaded_tca.flank_maps.ease_off_map import EaseOffMap, SecondOrder, ease_off_map
from loaded_tca.flank_maps.measured_modifications import MeasuredModifications, measured_modifications
from loaded_tca.flank_maps.pattern import ContactArea, ContactPattern, contact_area, contact_pattern
from loaded_tca.flank_maps.settings_fit import FlankDeviations, SettingsFit, fit_settings, read_measured_flank
from loaded_tca.flank_maps.settings_problem import MeasuredFlank
from loaded_tca.flank_maps.vh_check import VHCheck, vh_check

__all__ = [
    "ContactArea",
    "ContactPattern",
    "EaseOffMap",
    "FlankDeviations",
    "MeasuredFlank",
    "MeasuredModifications",
    "SecondOrder",
    "SettingsFit",
    "VHCheck",
    "contact_area",
    "contact_pattern",
    "ease_off_map",
    "fit_settings",
    "measured_modifications",
    "read_measured_flank",
    "vh_check",
]
