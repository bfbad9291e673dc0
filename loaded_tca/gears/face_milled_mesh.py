"""Two face-milled gears that mesh, and the angle between their axes."""

from __future__ import annotations

from dataclasses import dataclass

from loaded_tca.gears.face_milled import FaceMilledGear


@dataclass(frozen=True)
class FaceMilledMesh:
    """Both members of a face-milled pair.

    Parameters
    ----------
    pinion, wheel : FaceMilledGear
    shaft_angle : float [rad]
        Sigma.
    """

    pinion: FaceMilledGear
    wheel: FaceMilledGear
    shaft_angle: float

    @property
    def gears(self) -> tuple[FaceMilledGear, FaceMilledGear]:
        """Pinion and wheel."""
        return self.pinion, self.wheel
