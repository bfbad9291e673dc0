"""What a gear is held by, and the depth of its rim between there and the roots."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError

DEFAULT_BORE = 0.55
"""Bore of a gear that has none given, or journals of a solid gear, over the root diameter."""
SMALLEST_BORE, LARGEST_BORE = 0.05, 0.98
"""Bores over the smallest root diameter. A larger one leaves no rim below the teeth; at a smaller one a gear twists
about its bore twenty times as far as its teeth bend, and no shaft is so thin."""


class Held(ABC):
    """Cylinder of a gear that is held rigid where its teeth bend."""

    @abstractmethod
    def radius(self, diameter: float | None, root: Array) -> Array:
        """Radius (k,) of the cylinder in sections whose root circles have radii ``root`` (k,) [mm].

        Parameters
        ----------
        diameter : float [mm], optional
            As given; None: the default.
        root : (k,) array [mm]

        Raises
        ------
        InputError
            If it leaves no rim below the teeth.
        """


@dataclass(frozen=True)
class Bore(Held):
    """The bore of an external gear, or the journals of a solid one, whose diameter is given as 0.

    Examples
    --------
    >>> Bore().radius(None, np.array([50.0]))
    array([27.5])
    """

    def radius(self, diameter: float | None, root: Array) -> Array:
        """Radius (k,) of the bore or the journals [mm]; a bore that is too thin to hold the gear by is refused, too."""
        if diameter is None or diameter == 0.0:
            return DEFAULT_BORE * root
        smallest = 2.0 * root.min()
        if not SMALLEST_BORE * smallest <= diameter < LARGEST_BORE * smallest:
            thin = "it is held rigid, and the body would twist about so thin a bore far more than the teeth bend"
            raise InputError(
                f"bore_diameter: {diameter:.6g} mm is not between {SMALLEST_BORE:g} and {LARGEST_BORE:g} times the "
                f"smallest root diameter, {smallest:.6g} mm, nor 0, a solid gear: "
                + (thin if diameter < smallest * SMALLEST_BORE else "no rim is left below the teeth")
            )
        return np.full_like(root, 0.5 * diameter)
