"""Pairs of gears that differ in one key of their scene."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Real

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import AccuracyWarning, GeometryError, InputError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import Scene
from loaded_tca.scene.section import Section, contents

STEPS = {"um": 1.0, "deg": 1e-4, "mm": 1e-4}
"""Step of a key by the unit at its end. Amounts enter linearly; with the others the difference is wrong by less than
1e-9, and rounding, 1e-16 of an angle, is less than that too."""
OF_MOUNTING = 1e-2
"""The same, so many times as large, of mounting errors: by 1 um of misalignment contacts go far."""
OF_SETTINGS = 100.0
"""The same, so many times as large, of machine settings and cutters: generated flanks are known to 1e-11 mm."""
SECTIONS = ("modifications", "machine", "cutter")
"""Of a gear, whose keys shape its flanks and, to first order, nothing else."""


@dataclass(frozen=True, eq=False)
class PairChange:
    """Two pairs of gears that differ in one key of their scene.

    Attributes
    ----------
    key : str
        As of ``scene.with_changes``.
    below, above : GearPair
        With a smaller and a larger value of the key.
    difference : float
        Of the two values, in the unit of the key.
    """

    key: str
    below: GearPair
    above: GearPair
    difference: float

    @property
    def of_modifications(self) -> bool:
        """Whether the pairs differ in modifications alone."""
        return self.key.split(".")[1] == "modifications"

    @property
    def holds_edges(self) -> bool:
        """Whether the regions of the flanks and the starts of their reliefs stay as they are."""
        return self.of_mounting or (self.of_modifications and self.key.endswith("_um"))

    @property
    def holds_lines(self) -> bool:
        """Whether contacts keep their places at the edges of the flanks and at the starts of reliefs."""
        return self.of_modifications and self.holds_edges

    @property
    def of_mounting(self) -> bool:
        """Whether the wheel stands elsewhere."""
        return self.key.startswith("mounting.")

    @cached_property
    def moved_wheel(self) -> tuple[Array, Array]:
        """Derivatives of the wheel's origin (3,) [mm per unit] and axes (3, 3) [1 per unit]."""
        shift, turn = (getattr(self.above, name) - getattr(self.below, name) for name in ("wheel_origin", "wheel_axes"))
        return shift / self.difference, turn / self.difference


def pair_changes(scene: Scene, keys: Sequence[str]) -> list[PairChange]:
    """Pairs of gears a step either side of the value that each key has in a scene.

    Where one side is not allowed, as amounts below zero are not, the pair of the scene takes its place.

    Parameters
    ----------
    scene : Scene
    keys : sequence of str
        Keys of modifications, machine settings and cutters of either gear and of mounting errors, as of
        ``scene.with_changes``.

    Raises
    ------
    InputError
        With every key that is unknown, is none of these or no number, or that the scene cannot vary.

    """
    pair, changes, problems = scene.pair(), [], []
    for key in keys:
        try:
            changes.append(_pair_change(scene, pair, key))
        except (InputError, GeometryError) as error:
            problems += [f"{key}: {problem}" for problem in getattr(error, "problems", (str(error),))]
    if problems:
        raise InputError(problems)
    return changes


def _pair_change(scene: Scene, pair: GearPair, key: str) -> PairChange:
    value = value_at(scene, key)
    step, reason = STEPS[key.rpartition("_")[2]], None
    if key.split(".")[1] in SECTIONS[1:]:
        step *= OF_SETTINGS
    if key.startswith("mounting."):
        step *= OF_MOUNTING
    linear = ".modifications." in key and key.endswith("_um")  # one side is enough
    sides = [(value, pair), (value, pair)]
    for side, trial in ((1, value + step), (0, value - step)):
        if linear and sides[1][0] > value:
            break
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)  # told of the scene itself
                sides[side] = trial, scene.with_changes({key: trial}).pair()
        except (InputError, GeometryError) as error:
            reason = reason or error
    (low, below), (high, above) = sides
    if reason is not None and low == high:
        raise reason
    return PairChange(key, below, above, high - low)


def _value_of(scene: Scene, key: str) -> object:
    """Whatever a scene has for a key."""
    value: object = scene
    for part in key.split("."):
        inner = contents(value) if isinstance(value, Section) else {}
        if isinstance(value, tuple) and value and isinstance(value[0], Section):
            inner = {str(n): one for n, one in enumerate(value)}
        if part not in inner:
            raise InputError("unknown key")
        value = inner[part]
    return value


def number_at(scene: Scene, key: str) -> float:
    """Value of a key; InputError if it is unknown or no number."""
    value = _value_of(scene, key)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"found {value!r:.60}; allowed a key whose value is one number")
    return float(value)


def value_at(scene: Scene, key: str) -> float:
    """Value of a key that shapes or moves flanks; InputError if it does not."""
    *sections, name = key.split(".")
    _value_of(scene, key)
    moves = sections == ["mounting"]
    shapes = len(sections) > 1 and sections[0] in GEARS and sections[1] in SECTIONS
    if not (moves or shapes) or name.rpartition("_")[2] not in STEPS:
        places = ", ".join(f"[pinion.{section}]" for section in SECTIONS)
        raise InputError(
            f"does not change the gap alone; allowed are lengths and angles of [mounting], {places}, and of the wheel"
        )
    return number_at(scene, key)
