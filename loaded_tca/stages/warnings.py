"""Accuracy warnings of a stage: those of its two mesh cycles, of the loads that a planet comes to carry."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.plain import plain
from loaded_tca.results.warnings import is_under_torque
from loaded_tca.stages.sections import RING_MESH, SUN_MESH

MESHES = tuple(" and ".join(f"{name} ({gear})" for gear, name in gears.items()) for gears in (SUN_MESH, RING_MESH))
"""Names of both meshes, of sun and ring."""
WHOSE = "the sun's torque on one planet", "the torque of a planet at the ring"
"""What the torques of both mesh cycles are."""


@dataclass(frozen=True)
class MeshWarnings:
    """Warnings of both mesh cycles of a stage, for any largest share of a planet.

    Attributes
    ----------
    of_meshes : tuple of tuple of tuple of (str or None)
        For both meshes: for each reason one sentence, or one for each force of the mesh cycles in rising order, on
        contacts under it and all smaller ones; None: no reason there.
    """

    of_meshes: tuple[tuple[tuple[str | None, ...], ...], ...]

    @classmethod
    def of(cls, *meshes: Iterable[str]) -> MeshWarnings:
        """Of the sentences that the analyses of both meshes gave."""
        return cls(tuple(tuple(getattr(one, "up_to", (one,)) for one in dict.fromkeys(mesh)) for mesh in meshes))

    def to_text(self) -> str:
        """As text, for a file."""
        return json.dumps(self.of_meshes)

    @classmethod
    def from_text(cls, text: str) -> MeshWarnings:
        """Of the text that ``to_text`` made."""
        return cls(tuple(tuple(map(tuple, mesh)) for mesh in json.loads(text)))

    def under(self, forces: Array, largest: float, torques: Sequence[float]) -> list[str]:
        """Sentences on contacts under forces up to the first one that is not below the largest of a planet.

        Parameters
        ----------
        forces : (k,) array [N]
            Of the mesh cycles, rising.
        largest : float [N]
            Of a planet.
        torques : (float, float) [N mm]
            Those of the pinions of both meshes under it.

        Examples
        --------
        >>> place = "(at 1 of 9 pressure maps; the first: 50 N m)"
        >>> warned = MeshWarnings((((None, f"too wide {place}"),), ()))
        >>> warned.under(np.array([500.0, 1000.0]), 400.0, (20e3, 30e3))
        []
        >>> print(warned.under(np.array([500.0, 1000.0]), 600.0, (30e3, 45e3))[0][33:])
        too wide (at 1 of 9 pressure maps; the first: 50 N m; N m: the sun's torque on one planet, up to 30)
        """
        last = min(int(np.searchsorted(forces, largest * (1.0 - 1e-9))), len(forces) - 1)
        sentences = []
        for mesh, own, whose, torque in zip(MESHES, self.of_meshes, WHOSE, torques, strict=True):
            for up_to in own:
                sentence = up_to[0] if len(up_to) == 1 else up_to[last]
                if sentence is not None:
                    load = f"; N m: {whose}, up to {plain(1e-3 * torque)})"
                    sentences.append(f"{mesh}: {sentence[:-1] + load if is_under_torque(sentence) else sentence}")
        return sentences
