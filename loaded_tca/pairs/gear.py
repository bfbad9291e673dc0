"""One gear of a pair."""

from __future__ import annotations

from dataclasses import dataclass

from loaded_tca.flanks.base import Flank
from loaded_tca.material import Material


@dataclass(frozen=True, eq=False)
class Gear:
    """One gear of a pair.

    Attributes
    ----------
    flank : Flank
        The flank in contact, in the gear's own frame.
    material : Material
    """

    flank: Flank
    material: Material
