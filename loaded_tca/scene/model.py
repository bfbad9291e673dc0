"""The scene: two gears, their mounting errors, a material, a load, and what is asked about them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalMesh
from loaded_tca.pair import GearPair
from loaded_tca.scene.build import build_cylindrical_mesh, build_cylindrical_pair, in_base_units
from loaded_tca.scene.keys import Line, key
from loaded_tca.scene.section import (
    Rule,
    Section,
    Subsection,
    as_table,
    check,
    contents,
    entries,
    made,
    subsection,
)
from loaded_tca.scene.sections import (
    Analysis,
    ElasticMaterial,
    Gear,
    Geometry,
    Hand,
    Load,
    MountingErrors,
)
from loaded_tca.scene.text import literal


def _opposite_hands(wheel: Hand | None, pinion: Hand | None) -> str | None:
    if wheel is None or wheel != pinion:
        return None
    return f'found "{wheel}" on both gears; allowed "{_opposite(wheel)}", the hand that the pinion does not have'


def _opposite(hand: Hand) -> Hand:
    return "left" if hand == "right" else "right"


def _material_of_each(common: object, pinion: object, wheel: object) -> str | None:
    if common is not None or (pinion is not None and wheel is not None):
        return None
    return "missing; give [material] for both gears, or [pinion.material] and [wheel.material]"


@dataclass(frozen=True, kw_only=True)
class Scene(Section):
    """All that an analysis needs to know, in the engineer's units, as read from a scene file.

    Values are checked however a scene is made, ``dataclasses.replace`` included; docs/scene.md has the keys.

    Attributes
    ----------
    title : str
    geometry : Geometry
        Section [pair]: what both gears have in common.
    pinion, wheel : Gear
    mounting : MountingErrors
    material : ElasticMaterial or None
        Of both gears; ``materials`` tells what holds for each.
    load : Load
    analysis : Analysis

    Examples
    --------
    >>> scene = Scene(
    ...     geometry=Geometry(type="cylindrical", normal_module_mm=3.0),
    ...     pinion=Gear(teeth=34, face_width_mm=25.0),
    ...     wheel=Gear(teeth=57, face_width_mm=25.0),
    ...     material=ElasticMaterial(youngs_modulus_MPa=206000.0, poisson_ratio=0.3),
    ...     load=Load(pinion_torque_Nm=130.0),
    ... )
    >>> scene.pair()
    GearPair(34/57, module 3 mm, face 25 mm)
    >>> scene.with_changes({"pinion.teeth": 21}).pair()
    GearPair(21/57, module 3 mm, face 25 mm)
    """

    title: str = key(Line(), "stands over reports and plots", "")
    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: Gear = subsection(Gear, "the gear that turns about +z")
    wheel: Gear = subsection(Gear, "its mate")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")
    material: ElasticMaterial | None = subsection(
        ElasticMaterial, "material of both gears; needed unless each has its own", optional=True
    )
    load: Load = subsection(Load, "what the pair carries")
    analysis: Analysis = subsection(Analysis, "how finely it is computed")

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(("wheel.hand", "pinion.hand"), _opposite_hands),
        Rule(("material", "pinion.material", "wheel.material"), _material_of_each),
    )

    @property
    def pinion_hand(self) -> Hand:
        """Hand of the pinion: as given, or opposite to the wheel, or right."""
        if self.pinion.hand is not None:
            return self.pinion.hand
        return "right" if self.wheel.hand is None else _opposite(self.wheel.hand)

    @property
    def materials(self) -> tuple[ElasticMaterial, ElasticMaterial]:
        """Material of pinion and wheel: the own one, or the common one."""
        first, second = self.pinion.material or self.material, self.wheel.material or self.material
        assert first is not None  # by the rules of the scene
        assert second is not None
        return first, second

    @property
    def torques(self) -> tuple[float, ...]:
        """Every pinion torque to analyse [N mm]."""
        several = in_base_units(self.analysis).get("torques")
        return several or (in_base_units(self.load)["pinion_torque"],)

    def mesh(self) -> CylindricalMesh:
        """Return the macro geometry: diameters, contact ratios, path of contact."""
        return build_cylindrical_mesh(self.geometry, (self.pinion, self.wheel), self._hand_sign)

    def pair(self) -> GearPair:
        """Return the two flanks in space.

        Raises
        ------
        InputError
            If values that are sound one by one do not fit each other.
        GeometryError
            If the gears cannot exist or cannot mesh.
        """
        gears = (self.pinion, self.wheel)
        return build_cylindrical_pair(self.geometry, gears, self._hand_sign, self.mounting, self.materials)

    @property
    def _hand_sign(self) -> int:
        return 1 if self.pinion_hand == "right" else -1

    def with_changes(self, changes: Mapping[str, Any]) -> Scene:
        """Return a scene with other values, all checked.

        Parameters
        ----------
        changes : mapping
            Key as in a file, with dots (``"pinion.modifications.tip_relief_um"``) -> value; None: not given.

        Raises
        ------
        InputError
            Every problem at once, as for a file.

        Examples
        --------
        A grid of one's own instead of an accuracy::

            scene.with_changes({"analysis.cells": (32, 32)})
        """
        table = as_table(self)
        for path, value in changes.items():
            *sections, name = path.split(".")
            place = table
            for section in sections:
                place[section] = place[section] if isinstance(place.get(section), dict) else {}
                place = place[section]
            place[name] = value
        return scene_from_table(table)

    def to_toml(self) -> str:
        """Return a scene file with every key; ``parse_scene`` makes the same scene of it."""
        return "\n".join(_lines(self, "")) + "\n"


def scene_from_table(table: Mapping[str, Any]) -> Scene:
    """Return the scene that nested dictionaries describe, as TOML would give them.

    Raises
    ------
    InputError
        Every problem at once.
    """
    values, problems = check(Scene, table)
    if problems:
        raise InputError(problems)
    return made(Scene, values)


def _lines(section: Section, path: str) -> list[str]:
    """Keys first, then the sections inside, each under its header."""
    keys, sections = [], []
    values = contents(section)
    for name, (_, entry) in entries(type(section)).items():
        value = values[name]
        if isinstance(value, Section):
            sections += ["", f"[{path}{name}]", *_lines(value, f"{path}{name}.")]
        elif isinstance(entry, Subsection):
            sections += ["", f"# [{path}{name}] is not given"]
        elif value is None:
            keys.append(f"# {name} is not given: {entry.absent}")
        else:
            keys.append(f"{name} = {literal(value)}")
    return keys + sections
