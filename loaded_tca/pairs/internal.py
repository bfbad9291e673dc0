"""Pairs of a pinion and a ring gear.

The frame of the ring without errors is that of the pinion turned by 180 degrees about the x axis and moved by the
centre distance towards -x: origin (-a, 0, 0), axes (1, 0, 0), (0, -1, 0), (0, 0, -1). The ring turns with the pinion,
about +z, which is -z of its own frame: so all that holds for the wheel of an external pair holds for it, word for word.
"""

from __future__ import annotations

import numpy as np

from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears import InternalMesh
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import Mounting, involute_pair
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense
from loaded_tca.tooth.ring import RingTooth


def internal_pair(
    mesh: InternalMesh,
    *,
    modifications: tuple[FlankModifications, FlankModifications] = (FlankModifications(), FlankModifications()),
    mounting: Mounting = Mounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    driving: Driving = "pinion",
    sense: Sense = "positive",
) -> GearPair:
    """Pair of a pinion and a ring gear.

    Parameters
    ----------
    mesh : InternalMesh
        Macro geometry.
    modifications : (FlankModifications, FlankModifications)
        Of pinion and ring. Lower and upper ends of the face are those of the pinion, also of the ring.
    mounting : Mounting
        Errors of the ring's position in the fixed frame. A positive ``centre_distance_error`` moves the ring towards
        +x, teeth apart, and makes the centre distance smaller; where ``in_plane`` is positive the teeth part at z > 0.
    materials : (Material, Material)
        Of pinion and ring.
    driving : {"pinion", "wheel"}
    sense : {"positive", "negative"}
        "negative": the pinion turns about -z and touches with its other flank.

    Raises
    ------
    InputError
        If driving or sense is not one of the two, or a relief starts off the active profile.
    GeometryError
        If the teeth wind a whole turn around a gear over its face width, or the faces have less than a thousandth of
        the module in common.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, RingGear
    >>> pinion = CylindricalGear(teeth=25, normal_module=3.0, face_width=25.0)
    >>> internal_pair(InternalMesh(pinion, RingGear(teeth=-60, normal_module=3.0, face_width=25.0)))
    GearPair(25/60, module 3 mm, face 25 mm)
    """
    wheel = RingTooth(mesh.ring, mesh.wheel_working_radius, mesh.wheel_active_profile, modifications[1])
    origin = np.array([mounting.centre_distance_error - mesh.working_centre_distance, 0.0, mounting.axial_offset])
    return involute_pair(
        mesh,
        wheel,
        mesh.ring.outer_diameter,
        (origin, np.diag([1.0, -1.0, -1.0]) @ mounting.turn.T),
        modifications=modifications[0],
        axial_offset=mounting.axial_offset,
        materials=materials,
        driving=driving,
        sense=sense,
    )
