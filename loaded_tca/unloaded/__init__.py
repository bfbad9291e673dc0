"""Unloaded tooth contact analysis: contact points, contact path, transmission error."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.unloaded.curvature import RelativeCurvature, heelwards, relative_curvature
    from loaded_tca.unloaded.ease_off import EaseOff
    from loaded_tca.unloaded.path import ContactPath, ContactPoint, trace_contact
    from loaded_tca.unloaded.reduced import climb
    from loaded_tca.unloaded.teeth import MeshPath, trace_teeth
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = [
    "ContactPath",
    "ContactPoint",
    "EaseOff",
    "MeshPath",
    "RelativeCurvature",
    "climb",
    "heelwards",
    "relative_curvature",
    "trace_contact",
    "trace_teeth",
]
