"""Pairs of a pinion and a rack, and their mounting errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.rack import Rack, rack_mesh
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import Mounting, involute_pair
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense
from loaded_tca.tooth.rack import RackTooth


def rack_pair(
    pinion: CylindricalGear,
    rack: Rack,
    distance: float | None = None,
    *,
    modifications: tuple[FlankModifications, FlankModifications] = (FlankModifications(), FlankModifications()),
    mounting: Mounting = Mounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    driving: Driving = "pinion",
    sense: Sense = "positive",
) -> GearPair:
    """Pair of a pinion and a rack.

    Parameters
    ----------
    pinion : CylindricalGear
    rack : Rack
    distance : float [mm], optional
        From the axis of the pinion to the reference line; None: without backlash but for allowances.
    modifications : (FlankModifications, FlankModifications)
        Of pinion and rack. Starts of reliefs are diameters of the gear that stands for the rack.
    mounting : Mounting
        Errors of the rack's position; it turns about the point of its reference line at mid-face.
    materials : (Material, Material)
        Of pinion and rack.
    driving : {"pinion", "wheel"}
        The rack is the wheel.
    sense : {"positive", "negative"}
        "negative": the pinion turns about -z and touches with its other flank.

    Raises
    ------
    InputError
        If driving or sense is not one of the two, a relief starts off the active profile, or pinion and rack do not
        fit each other.
    GeometryError
        If they have no common flank.

    Examples
    --------
    >>> pinion = CylindricalGear(teeth=20, normal_module=3.0, face_width=25.0)
    >>> rack_pair(pinion, Rack(normal_module=3.0, face_width=25.0, height=20.0)).teeth
    (20, 2000000)
    """
    mesh = rack_mesh(pinion, rack, distance, mounting.axial_offset)
    wheel = RackTooth(
        mesh.wheel,
        mesh.wheel_working_radius,
        mesh.wheel_active_profile,
        modifications[1],
        bed_depth=rack.bed_depth,
        length=rack.length,
    )
    place = replace(mounting, axial_offset=mesh.axial_offset)
    standing = mesh.working_centre_distance - rack.radius + place.centre_distance_error
    middle, turn = np.array([standing, 0.0, place.axial_offset]), place.turn
    return involute_pair(
        mesh,
        wheel,
        None,
        (middle + rack.radius * turn[:, 0], np.diag([-1.0, -1.0, 1.0]) @ turn.T),
        modifications=modifications[0],
        materials=materials,
        driving=driving,
        sense=sense,
    )
