r"""Change of the gap of two flanks with a key of the scene, where the common normal meets each flank.

A flank stands where F = theta - Theta vanishes. If Theta grows by dTheta and the gear moves by dr, the point on the
normal n moves along it by

.. math:: ds = \frac{d\Theta + \nabla F \cdot dr}{\nabla F \cdot n},
          \qquad dh = ds_\text{wheel} - ds_\text{pinion},

with no flank met anew: for a modification of the shape f, dTheta = -s f |grad F_nominal| da. dTheta is the central
difference of Theta at the points that are met, between the flanks of the scene a step either side of its value, and
dr that of the places of the wheel. Theta is an explicit function, linear in nearly every amount, so that the
difference is the derivative to about 1e-9, of fitted and measured flanks and of machine settings as of involutes.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from numbers import Real

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import AccuracyWarning, GeometryError, InputError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import Scene
from loaded_tca.scene.section import Section, contents
from loaded_tca.separation.normal_gap import FlankPoints, NormalGap
from loaded_tca.separation.sample import Separation
from loaded_tca.unloaded import ContactPoint

STEPS = {"um": 1.0, "deg": 1e-4, "mm": 1e-4}
"""Step of a key by the unit at its end. Amounts enter linearly; with the others the difference is wrong by less than
1e-9, and rounding, 1e-16 of an angle, is less than that too."""
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


@dataclass(frozen=True, eq=False)
class GapChange:
    """Derivatives of the gap of one contact on its grid, zero where there is no material.

    Attributes
    ----------
    by_key : (keys, nx, ny) array
        Growth of the gap [mm] per unit of each key, both gears held at their angles.
    by_place : (2, nx, ny) array
        Slope of the gap along x and y of the grid [1].
    """

    by_key: Array
    by_place: Array


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
    pair, found, problems = scene.pair(), [], []
    for key in keys:
        try:
            found.append(_pair_change(scene, pair, key))
        except (InputError, GeometryError) as error:
            problems += [f"{key}: {problem}" for problem in getattr(error, "problems", (str(error),))]
    if problems:
        raise InputError(problems)
    return found


def _pair_change(scene: Scene, pair: GearPair, key: str) -> PairChange:
    value = value_at(scene, key)
    step, reason = STEPS[key.rpartition("_")[2]], None
    if key.split(".")[1] in SECTIONS[1:]:
        step *= OF_SETTINGS
    sides = [(value, pair), (value, pair)]
    for side, trial in enumerate((value - step, value + step)):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)  # told of the scene itself
                sides[side] = trial, scene.with_changes({key: trial}).pair()
        except (InputError, GeometryError) as error:
            reason = error
    (low, below), (high, above) = sides
    if reason is not None and low == high:
        raise reason
    return PairChange(key, below, above, high - low)


def value_at(scene: Scene, key: str) -> float:
    """Value of a key that shapes or moves flanks; InputError if it does not."""
    *sections, name = key.split(".")
    value: object = scene
    for part in (*sections, name):
        inner = contents(value) if isinstance(value, Section) else {}
        if part not in inner:
            raise InputError("unknown key")
        value = inner[part]
    moves = sections == ["mounting"]
    shapes = len(sections) > 1 and sections[0] in ("pinion", "wheel") and sections[1] in SECTIONS
    if not (moves or shapes) or name.rpartition("_")[2] not in STEPS:
        told = ", ".join(f"[pinion.{section}]" for section in SECTIONS)
        raise InputError(
            f"does not change the gap alone; allowed are lengths and angles of [mounting], {told}, and of the wheel"
        )
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"found {value!r:.60}; allowed a key whose value is one number")
    return float(value)


def gap_change(
    pair: GearPair, contact: ContactPoint, separation: Separation, changes: Sequence[PairChange]
) -> GapChange:
    """Derivatives of the gap of a contact on its grid.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
        Whose gears are held at their angles.
    separation : Separation
        Its grid.
    changes : sequence of PairChange

    Returns
    -------
    GapChange
    """
    there = np.isfinite(separation.cut_gap)
    gap = NormalGap(pair, contact, separation.axes)
    points = gap.flank_points(separation.x[None, :, None], separation.y[None, None, :])
    first, second = (_inside(one, there) for one in points)
    by_key, by_place = np.zeros((len(changes), *there.shape)), np.zeros((2, *there.shape))
    for number, change in enumerate(changes):
        by_key[number, there] = _grown(change, pair, first, second)
    # the rest of the slope of a flank is that of the plane itself
    for axis, direction in enumerate(separation.axes[:2]):
        at_wheel = second.gradient @ (pair.wheel_axes @ direction) / second.steepness
        by_place[axis, there] = first.gradient @ direction / first.steepness - at_wheel
    return GapChange(by_key, by_place)


def _inside(points: FlankPoints, there: Array) -> FlankPoints:
    """Those of the cells (nx, ny) with material, in one row."""
    return FlankPoints(*(part[0][there] for part in vars(points).values()))


def _grown(change: PairChange, pair: GearPair, pinion: FlankPoints, wheel: FlankPoints) -> Array:
    """Growth of the gap [mm] per unit of a key."""
    owner, growth = change.key.partition(".")[0], np.zeros(pinion.rho.shape)
    if owner == "pinion":
        growth -= _turned(change, "pinion", pinion) / pinion.steepness
    elif owner == "wheel":
        growth += _turned(change, "wheel", wheel) / wheel.steepness
    else:
        below, above = change.below, change.above
        turn, shift = above.wheel_axes - below.wheel_axes, above.wheel_origin - below.wheel_origin
        moved = pair.wheel_axes @ shift - wheel.point @ pair.wheel_axes @ turn.T  # in the frame of the wheel
        growth += (wheel.gradient * moved).sum(axis=-1) / (change.difference * wheel.steepness)
    return growth


def _turned(change: PairChange, gear: str, points: FlankPoints) -> Array:
    """DTheta per unit of the key at points of a flank [rad]."""
    low, high = (getattr(side, gear).flank.theta(points.rho, points.z).value for side in (change.below, change.above))
    return np.asarray((high - low) / change.difference)
