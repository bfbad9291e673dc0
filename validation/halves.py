"""Results of double helical pairs seen as those of one pair whose tooth pairs are its two halves.

So what must hold of every scene is one function for all kinds of pairs: shares of tooth pairs or of halves.
"""

from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.double_helical import DoubleHelicalResult

OTHER_NAMES = {"load_share": "torque_share"}
"""Names of a mesh cycle -> those of a double helical pair."""


class Renamed:
    """What another object has, by the names of mesh cycles."""

    def __init__(self, pair: Any) -> None:
        self.of_pair = pair

    def __getattr__(self, name: str) -> Any:
        return getattr(self.of_pair, name if hasattr(self.of_pair, name) else OTHER_NAMES.get(name, name))


class HalvesAsPairs(Renamed):
    """Result of a double helical pair by the names of mesh cycles.

    Parameters
    ----------
    result : DoubleHelicalResult
    turned : bool
        Whether half a is seen as half b, and half b as half a.
    """

    of_pair: DoubleHelicalResult
    pair = np.arange(2)
    """Numbers of the halves."""

    def __init__(self, result: DoubleHelicalResult, turned: bool = False) -> None:
        super().__init__(result)
        self.order = slice(None, None, -1 if turned else 1)
        self.load_share, self.peak_pressure = (
            np.asarray(values)[..., self.order] for values in (result.torque_share, result.peak_pressure)
        )
        self.axial_motion = np.asarray(result.axial_motion) * (-1.0 if turned else 1.0)

    @property
    def unloaded_transmission_error(self) -> Array:
        """Transmission error of the even share less the mean deflection of the halves, (position,) [rad]."""
        deflections = [(half.transmission_error - half.unloaded_transmission_error)[-1] for half in self.of_pair.halves]
        return np.asarray(self.of_pair.transmission_error[-1] - np.mean(deflections, axis=0))

    @property
    def discretisation_error(self) -> Array:
        """The largest of the torques and tooth pairs of each half (torque, position, half)."""
        errors = [np.nan_to_num(half.discretisation_error).max(axis=(0, 2)) for half in self.of_pair.halves]
        return np.broadcast_to(np.stack(errors, axis=-1)[..., self.order], self.of_pair.torque_share.shape)

    @property
    def transmission_error_by_grids(self) -> Array:
        """The largest of the torques of both halves at each position [rad]."""
        errors = [half.transmission_error_by_grids.max(axis=0) for half in self.of_pair.halves]
        return np.broadcast_to(np.max(errors, axis=0), self.of_pair.transmission_error.shape)

    @property
    def gear_pair(self) -> Any:
        """Gears of half a."""
        return self.of_pair.half_a.gear_pair

    @property
    def turn_by_motion(self) -> float:
        """Rotation of the wheel that parts its flanks as a motion along the axis does [rad/mm]."""
        return abs(self.of_pair.scene.axial_rate) / float(self.of_pair.wheel_base_radius)

    def sensitivities(self, keys: list[str]) -> Any:
        """Derivatives by the names of mesh cycles."""
        return Renamed(self.of_pair.sensitivities(keys))
