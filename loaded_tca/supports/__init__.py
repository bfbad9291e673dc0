"""Supports: what holds both gears, and how they move as whole bodies under load."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.supports.bearing import Bearing
    from loaded_tca.supports.of_scene import shafts_of, support_compliance, supports_of
    from loaded_tca.supports.rolling import BallBearing, RollerBearing, RollingBearing
    from loaded_tca.supports.shaft import Shaft, ShaftLoad, ShaftSection
    from loaded_tca.supports.support import Support, SupportCompliance, moved_pair
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "BallBearing",
    "Bearing",
    "RollerBearing",
    "RollingBearing",
    "Shaft",
    "ShaftLoad",
    "ShaftSection",
    "Support",
    "SupportCompliance",
    "moved_pair",
    "shafts_of",
    "support_compliance",
    "supports_of",
]
