"""Where on a flank a loaded contact leaves its mark over all positions: centre, size and highest pressure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array, GearName
from loaded_tca.results.support_growth import gears_under_torque

if TYPE_CHECKING:
    from loaded_tca.results.mesh_cycle import MeshCycle


@dataclass(frozen=True, eq=False)
class LoadedPattern:
    """Marks of all positions and tooth pairs under one torque on a flank, as its frame shows it.

    Attributes
    ----------
    centre : (2,) array [mm]
        Of all normal forces: lengthwise, and along the profile; NaN where nothing is in contact.
    size : (2,) array [mm]
        From the first to the last cell under pressure; NaN where nothing is in contact.
    peak_pressure : float [MPa]
        Highest of all positions; NaN where nothing is in contact.
    """

    centre: Array
    size: Array
    peak_pressure: float


def loaded_pattern(result: MeshCycle, torque: int, gear: GearName) -> LoadedPattern:
    """Return the loaded pattern of a result under a torque, by its index, on a flank."""
    maps = [one for row in result.maps[torque] for one in row if one is not None and one.pressure.any()]
    if not maps:
        return LoadedPattern(np.full(2, math.nan), np.full(2, math.nan), math.nan)
    pair = gears_under_torque(result, torque)[0].gear_pair
    frame = getattr(pair, gear).flank.frame
    on_flank = pair.on_pinion if gear == "pinion" else pair.on_wheel
    pressure = [one.pressure > 0.0 for one in maps]
    points = np.concatenate([one.points[under] for one, under in zip(maps, pressure, strict=True)])
    forces = np.concatenate(
        [one.pressure[under] * np.prod(one.spacing) for one, under in zip(maps, pressure, strict=True)]
    )
    places = np.stack(frame.to_picture(*on_flank(points)), axis=-1)
    peak = float(np.nanmax(result.peak_pressure[torque], initial=0.0))
    return LoadedPattern(forces @ places / forces.sum(), np.ptp(places, axis=0), peak)
