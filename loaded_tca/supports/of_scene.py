"""The supports that a scene asks for: matrices, and shafts on bearings."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import named, require
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import Scene
from loaded_tca.scene.build import build_materials, in_base_units
from loaded_tca.scene.sections import GearSection
from loaded_tca.scene.shafts import BearingSection
from loaded_tca.scene.shafts import ShaftSection as ShaftKeys
from loaded_tca.supports.bearing import AnyBearing, Bearing
from loaded_tca.supports.rolling import BallBearing, RollerBearing
from loaded_tca.supports.shaft import Shaft, ShaftLoad, ShaftSection
from loaded_tca.supports.support import Support, SupportCompliance

STATIONS = 9
"""Places over the face at which teeth follow their shaft: with 17 K_Hbeta of a slender pinion is 0.2 % less."""
ROLLING_KEYS = {
    "at": "at",
    "pitch_diameter": "pitch_diameter",
    "contact_angle": "contact_angle",
    "side": "side",
    "radial_clearance": "clearance",
    "preload": "preload",
    "dynamic_load_rating": "rating",
    "roller_length": "length",
    "inner_groove_ratio": "inner_groove",
    "outer_groove_ratio": "outer_groove",
}
"""Keys of a rolling bearing without their units -> what they are called there."""


def supports_of(scene: Scene) -> tuple[Support, Support]:
    """Supports of pinion and wheel; the support of a gear without a section is rigid.

    Raises
    ------
    InputError
        If something lies beside a shaft, or its bearings do not hold it.
    """
    pinion, wheel = (_support_of(scene, gear) for gear in range(2))
    return pinion, wheel


def support_compliance(scene: Scene, pair: GearPair) -> SupportCompliance | None:
    """Compliance of the supports under load; None where the scene has no supports.

    Parameters
    ----------
    scene : Scene
    pair : GearPair
        Of the scene, at rest.
    """
    if not scene.is_supported:
        return None
    return SupportCompliance(pair, supports_of(scene), np.stack([np.eye(3), pair.wheel_axes]))


def shafts_of(scene: Scene) -> tuple[Shaft | None, Shaft | None]:
    """Shafts of pinion and wheel; None for a gear without a shaft.

    Raises
    ------
    InputError
        As of :class:`Shaft`, with the section.
    """
    pinion, wheel = (_shaft_of(scene, gear) for gear in range(2))
    return pinion, wheel


def _shaft_of(scene: Scene, gear: int) -> Shaft | None:
    keys = (scene.pinion, scene.wheel)[gear].shaft
    if keys is None:
        return None
    with named(f"{GEARS[gear]}.shaft"):
        return Shaft(
            keys.start_mm,
            [ShaftSection(**in_base_units(part)) for part in keys.sections],
            build_materials(scene.materials)[gear],
            keys.torque_at_mm,
            [_bearing_of(one) for one in keys.bearings],
            [ShaftLoad(one.at_mm, _load(one.force_N, one.moment_Nm)) for one in keys.loads],
        )


def _bearing_of(keys: BearingSection) -> AnyBearing:
    if keys.type is None:
        return Bearing(keys.at_mm, ShaftKeys.matrix_of(keys))
    given = in_base_units(keys)
    values: dict[str, Any] = {
        "elements": given[f"{keys.type}s"],
        "diameter": given[f"{keys.type}_diameter"],
        **{name: given[key] for key, name in ROLLING_KEYS.items() if key in given},
    }
    return BallBearing(**values) if keys.type == "ball" else RollerBearing(**values)


def _load(force: tuple[float, ...], moment: tuple[float, ...]) -> Array:
    return np.array([*force, *(1e3 * one for one in moment)])


def _support_of(scene: Scene, gear: int) -> Support:
    section: GearSection = (scene.pinion, scene.wheel)[gear]
    middle, shaft = scene.face_middles[gear], _shaft_of(scene, gear)
    if shaft is None:
        return Support(middle, np.zeros((6, 6)) if section.support is None else section.support.matrix)
    keys = section.shaft
    assert keys is not None
    stations = np.array([middle])
    if keys.gear == "along":
        width = getattr(section, "face_width_mm", None)
        cylindrical = width is not None and not np.isnan(scene.transverse_angles[0])
        where = f'{GEARS[gear]}.shaft.gear: found "along"; allowed "rigid" for bevel gears'
        require((cylindrical, where))
        stations = middle + np.linspace(-0.5 * float(width or 0.0), 0.5 * float(width or 0.0), STATIONS)
    return _on_shaft(shaft, GEARS[gear], middle, stations, bool(keys.loads), np.zeros(6 * len(stations)))


def _on_shaft(shaft: Shaft, gear: str, middle: float, stations: Array, loaded: bool, under: Array) -> Support:
    """Support by a shaft, linear near loads of the stations; ``loaded``: by other loads, too."""
    with named(f"{gear}.shaft"):
        motions = shaft.solved(stations.tolist(), under)
    of_stations = motions.at_places.reshape(6 * len(stations), -1)
    return Support(
        middle,
        0.5 * (of_stations[:, :-1] + of_stations[:, :-1].T),
        stations,
        of_stations[:, -1] if loaded or not shaft.is_linear else None,
        motions.on_bearings,
        motions.at_bearings,
        shaft.bearings,
        None if shaft.is_linear else partial(_on_shaft, shaft, gear, middle, stations, loaded),
    )
