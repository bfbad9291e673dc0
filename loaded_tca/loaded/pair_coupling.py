"""What other tooth pairs do to a contact: they move its slices."""

from __future__ import annotations

from collections.abc import Callable

from loaded_tca.arrays import Array
from loaded_tca.separation import Separation

Coupling = Callable[[Separation], Array | None]
"""Displacement of the slices of a tooth pair's grid (ny,) [mm] by what the other pairs carry; None if nothing bends."""
