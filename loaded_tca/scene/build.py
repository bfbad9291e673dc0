"""From sections in the engineer's units to what the numerics take: the one place where units are converted."""

from __future__ import annotations

import math
from typing import Any

from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.material import Material
from loaded_tca.scene.section import Section, as_table
from loaded_tca.scene.sections import ElasticMaterial, Gear

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


def build_modifications(pinion: Gear, wheel: Gear) -> tuple[FlankModifications, FlankModifications]:
    """Return the modifications of both flanks."""
    return (
        FlankModifications(**in_base_units(pinion.modifications)),
        FlankModifications(**in_base_units(wheel.modifications)),
    )


def build_materials(materials: tuple[ElasticMaterial, ElasticMaterial]) -> tuple[Material, Material]:
    """Return the materials of both gears."""
    return Material(**in_base_units(materials[0])), Material(**in_base_units(materials[1]))
