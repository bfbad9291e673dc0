"""The gap between two flanks on a grid in the tangent plane of their contact point."""

from loaded_tca.separation.sample import Separation, cells_for_accuracy, sample_separation

__all__ = ["Separation", "cells_for_accuracy", "sample_separation"]
