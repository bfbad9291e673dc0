"""The gap between two flanks on a grid in the tangent plane of their contact point."""

from typing import TYPE_CHECKING

from loaded_tca.lazy import lazy_names

if TYPE_CHECKING:
    from loaded_tca.separation.sample import Separation, cells_for_accuracy, sample_separation, slice_middles
else:
    __getattr__, __dir__ = lazy_names(__name__)

__all__ = ["Separation", "cells_for_accuracy", "sample_separation", "slice_middles"]
