"""What a family of gears tells of the teeth of one gear: flanks of both sides, modifications, form."""

from __future__ import annotations

from abc import ABC, abstractmethod

from loaded_tca.flanks.base import Flank
from loaded_tca.tooth.form import ToothForm


class ToothGeometry(ABC):
    """The teeth of one gear by their equations; each family of gears has its subclass."""

    @property
    @abstractmethod
    def unmodified(self) -> ToothGeometry:
        """The same teeth without modifications; equal ones have equal nominal flanks and forms."""

    @abstractmethod
    def nominal(self, side: int) -> Flank:
        """Flank of the side s = +1 or -1 without modifications, with Theta = 0 at the pitch point of mid-face."""

    @abstractmethod
    def modified(self, nominal: Flank) -> Flank:
        """A flank of :meth:`nominal` with the modifications of the gear.

        Raises
        ------
        InputError
            If a relief starts off the active profile, or is longer than half the face.
        """

    @abstractmethod
    def form(self) -> ToothForm:
        """All of a tooth but its flanks: thickness, root surface, fillet."""
