"""From sections in the engineer's units to gears in space: the one place where units are converted."""

from __future__ import annotations

import math
from typing import Any

from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material
from loaded_tca.pair import GearPair, Mounting, cylindrical_pair
from loaded_tca.scene.section import Section, as_table
from loaded_tca.scene.sections import ElasticMaterial, Gear, Geometry, MountingErrors

UNITS = {"mm": 1.0, "um": 1e-3, "deg": math.pi / 180.0, "MPa": 1.0, "Nm": 1e3}
"""Unit at the end of a key -> factor to mm, rad, MPa and N mm."""


def in_base_units(section: Section) -> dict[str, Any]:
    """Return the values of a section in mm, rad, MPa and N mm, by names without unit; without keys not given.

    Examples
    --------
    >>> in_base_units(ElasticMaterial(youngs_modulus_MPa=206000, poisson_ratio=0.3))
    {'youngs_modulus': 206000.0, 'poisson_ratio': 0.3}
    """
    values = {}
    for key, value in as_table(section).items():
        name, _, unit = key.rpartition("_")
        if unit not in UNITS:
            values[key] = value
        elif isinstance(value, tuple):
            values[name] = tuple(entry * UNITS[unit] for entry in value)
        else:
            values[name] = value * UNITS[unit]
    return values


def build_cylindrical_mesh(geometry: Geometry, gears: tuple[Gear, Gear], hand_sign: int) -> CylindricalMesh:
    """Return the macro geometry of two cylindrical gears; ``hand_sign`` +1: the pinion is right-handed."""
    common = in_base_units(geometry)
    rack = {
        name: common[name]
        for name in ("normal_module", "pressure_angle", "dedendum_coefficient", "root_radius_coefficient")
    }
    members: list[CylindricalGear] = []
    for gear, name, sign in zip(gears, ("pinion", "wheel"), (hand_sign, -hand_sign), strict=True):
        own = in_base_units(gear)
        for key in ("hand", "modifications", "material"):
            own.pop(key, None)
        members.append(CylindricalGear(**rack, **own, helix_angle=sign * common["helix_angle"], name=name))
    pinion, wheel = members
    return CylindricalMesh(pinion, wheel, centre_distance=common.get("centre_distance"))


def build_cylindrical_pair(
    geometry: Geometry,
    gears: tuple[Gear, Gear],
    hand_sign: int,
    mounting: MountingErrors,
    materials: tuple[ElasticMaterial, ElasticMaterial],
) -> GearPair:
    """Return two cylindrical gears in space."""
    first, second = (FlankModifications(**in_base_units(gear.modifications)) for gear in gears)
    return cylindrical_pair(
        build_cylindrical_mesh(geometry, gears, hand_sign),
        modifications=(first, second),
        mounting=Mounting(**in_base_units(mounting)),
        materials=(Material(**in_base_units(materials[0])), Material(**in_base_units(materials[1]))),
        driving=geometry.driving,
        sense=geometry.sense,
    )
