"""Deflection lines of the shafts of a scene and forces on their bearings, without any contact solved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, named
from loaded_tca.loaded.moved_gears import loads_at_first_contact, moved_by
from loaded_tca.supports import Shaft, shafts_of, support_compliance

if TYPE_CHECKING:
    from loaded_tca.arrays import Array
    from loaded_tca.scene import Scene

PLACES = 61
"""Along a shaft, beside its nodes."""


@dataclass(frozen=True, eq=False)
class ShaftLine:
    """A shaft under a torque.

    Attributes
    ----------
    gear : str
        "pinion" or "wheel".
    torque : float [N mm]
        Of the pinion.
    shaft : Shaft
    middle : float [mm]
        Axial coordinate of the middle of the face.
    face_width : float [mm]
        Common face width.
    places : (n,) array [mm]
        Axial coordinates, ascending.
    motions : (n, 6) array [mm, rad]
        Along x, y, z and about them, axes of the gear's own frame.
    bearing_forces : (bearings, 6) array [N, N mm]
        On the bearings.
    bearing_motions : (bearings, 6) array [mm, rad]
        Of the shaft in its bearings.
    """

    gear: str
    torque: float
    shaft: Shaft
    middle: float
    face_width: float
    places: Array
    motions: Array
    bearing_forces: Array
    bearing_motions: Array


@checked
def shaft_lines(scene: Scene) -> tuple[ShaftLine, ...]:
    """Shafts of a scene under each of its torques, gear by gear.

    The whole normal force acts where the unloaded flanks touch at the pinion angle 0.

    Raises
    ------
    InputError
        If the scene has no shaft, or one that is not held.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> lines = shaft_lines(read_scene("examples/scenes/helical_on_shafts.toml"))
    >>> [(line.gear, line.torque) for line in lines[:2]]
    [('pinion', 40000.0), ('pinion', 130000.0)]
    >>> lines[1].bearing_forces[:, :3].sum(axis=0).round()  # -F_r, -F_t, and the axial force
    array([ -928., -2462.,   660.])
    """
    if not any(gear.shaft for gear in (scene.pinion, scene.wheel)):
        raise InputError("pinion.shaft: missing; a line of deflection needs [pinion.shaft] or [wheel.shaft]")
    pair = scene.pair()
    supports = support_compliance(scene, pair)
    assert supports is not None
    at_rest = moved_by(supports, tuple(np.zeros(len(one.compliance)) for one in supports.supports))  # type: ignore[arg-type]
    lines = []
    for n, (gear, shaft) in enumerate(zip(("pinion", "wheel"), shafts_of(scene), strict=True)):
        if shaft is None:
            continue
        support = supports.supports[n]
        places = np.linspace(shaft.start, shaft.end, PLACES)
        every = [*support.places.tolist(), *places.tolist()]
        own = 6 * len(support.places)
        columns = [*range(own), -1]
        solved = shaft.solved(every)
        for torque in scene.torques:
            load = loads_at_first_contact(supports, at_rest, torque)[n]
            if not shaft.is_linear:
                with named(f"{gear}.shaft"):
                    solved = shaft.solved(every, np.append(load, np.zeros(6 * len(places))))
            loads = np.append(load, 1.0)
            lines.append(
                ShaftLine(
                    gear,
                    torque,
                    shaft,
                    support.middle,
                    pair.face_width,
                    solved.nodes,
                    solved.at_nodes[..., columns] @ loads,
                    solved.on_bearings[..., columns] @ loads,
                    solved.at_bearings[..., columns] @ loads,
                )
            )
    return tuple(lines)
