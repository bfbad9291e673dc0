r"""Change of the gap of two flanks with a key of the scene, where the common normal meets each flank.

A flank stands where F = theta - Theta vanishes. If Theta grows by dTheta and the gear moves by dr, the point on the
normal n moves along it by

.. math:: ds = \frac{d\Theta + \nabla F \cdot dr}{\nabla F \cdot n},
          \qquad dh = ds_\text{wheel} - ds_\text{pinion},

with no flank met anew. For a modification of the shape f, dTheta = -s f |grad F_nominal| da: only the terms that
the key changes are computed. Of fitted and measured flanks and of machine settings dTheta is the central difference
of Theta between the flanks a step either side, and dr that of the places of the wheel. Theta is an explicit function,
linear in nearly every amount, so that the difference is the derivative to about 1e-9.

The contact point moves by s [mm] in the tangent plane, to where the gap with the wheel turned back into contact is
least, and the normal there is the pinion's:

.. math:: s = -B^{-1} \nabla \Bigl(dh - dh_0 \frac{l_2(x)}{l_2}\Bigr), \qquad
          dn = (\nabla n_\text{pinion}) s - \nabla ds_\text{pinion},

B the relative curvature. The levers (r x n).e follow.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Real

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.errors import AccuracyWarning, GeometryError, InputError
from loaded_tca.flanks.modification import removal_change
from loaded_tca.flanks.spline import SplineFlank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import Scene
from loaded_tca.scene.section import Section, contents
from loaded_tca.separation.normal_gap import TOGETHER, FlankPoints, NormalGap
from loaded_tca.separation.sample import Separation
from loaded_tca.unloaded import ContactPoint
from loaded_tca.unloaded.curvature import relative_curvatures

STEPS = {"um": 1.0, "deg": 1e-4, "mm": 1e-4}
"""Step of a key by the unit at its end. Amounts enter linearly; with the others the difference is wrong by less than
1e-9, and rounding, 1e-16 of an angle, is less than that too."""
OF_SETTINGS = 100.0
"""The same, so many times as large, of machine settings and cutters: generated flanks are known to 1e-11 mm."""
BESIDE = 1e-3
"""Distance of the points beside the contact point that slopes are taken of, over the module."""
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


@dataclass(frozen=True, eq=False)
class ContactChanges:
    """Derivatives of many contacts on their grids.

    Attributes
    ----------
    gaps : (keys, n) array [mm per unit of the key]
        Growth of the gaps at chosen cells of all grids, in one row, with the gears held at their angles.
    lever_parts : (n,) array
        Lever of the wheel's flank at each cell over that at the contact point of its grid: how much it moves if the
        wheel is turned.
    at_contact : (keys, contacts) array [mm per unit of the key]
        Growth of the gap at the contact points.
    levers : (2, keys, contacts) array [mm per unit of the key]
        Growth of the levers about the axes of pinion and wheel, as the contact point moves; zero where it lies on an
        edge or on a relief start, which hold it.
    shifts : (keys, contacts) array [mm per unit of the key]
        By which the contact point moves across the contact, along x of its grid; zero likewise.
    """

    gaps: Array
    lever_parts: Array
    at_contact: Array
    levers: Array
    shifts: Array


def contact_changes(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    separations: Sequence[Separation],
    cells: Sequence[Mask],
    changes: Sequence[PairChange],
) -> ContactChanges:
    """Derivatives of contacts to keys of the scene.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of ContactPoint
        Whose gears are held at their angles.
    separations : sequence of Separation
        The grid of each.
    cells : sequence of (nx, ny) bool array
        Cells of each grid that are asked for, all with material.
    changes : sequence of PairChange

    Returns
    -------
    ContactChanges
    """
    gap = NormalGap(pair, contacts, np.array([one.axes for one in separations]))
    steep, at_contact, levers, shifts = _at_contact_points(pair, contacts, separations, changes)
    places = [
        (grid.x[across], grid.y[along])
        for grid, (across, along) in zip(separations, (np.nonzero(one) for one in cells), strict=True)
    ]
    contact = np.repeat(np.arange(len(places)), [x.size for x, _ in places])
    x, y = (np.concatenate(part)[:, None] for part in zip(*places, strict=True))
    gaps, lever_parts = np.zeros((len(changes), contact.size)), np.zeros(contact.size)
    for first in range(0, contact.size, TOGETHER):
        part = slice(first, first + TOGETHER)
        pinion, wheel = gap.of(contact[part]).flank_points(x[part], y[part])
        grown = _grown(pair, changes, pinion, wheel)
        gaps[:, part], lever_parts[part] = (grown[1] - grown[0])[..., 0], (steep[contact[part]] / wheel.steepness[:, 0])
    return ContactChanges(gaps, lever_parts, at_contact, levers, shifts)


def _at_contact_points(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    separations: Sequence[Separation],
    changes: Sequence[PairChange],
) -> tuple[Array, Array, Array, Array]:
    """Steepness of the wheel's flank (contacts,), and ``at_contact``, ``levers`` and ``shifts`` of the changes."""
    curvatures, beside = relative_curvatures(pair, contacts), BESIDE * pair.module
    gap = NormalGap(pair, contacts, np.array([one.axes for one in curvatures]))
    x, y = (beside * np.tile(part, (len(contacts), 1)) for part in ([0.0, -1.0, 1.0, 0.0, 0.0], [0.0, 0, 0, -1.0, 1.0]))
    pinion, wheel = gap.flank_points(x, y)
    grown = _grown(pair, changes, pinion, wheel)
    steep, at_contact = wheel.steepness[:, 0], (grown[1] - grown[0])[..., 0]
    left = grown[1] - grown[0] - at_contact[..., None] * (steep[:, None] / wheel.steepness)

    def slope(values: Array, axis: int = -1) -> Array:
        """Derivatives by x and y, in the place of the five points."""
        low, high = (values.take([first, first + 2], axis=axis) for first in (1, 2))
        return np.asarray((high - low) / (2.0 * beside))

    bends = np.array([(one.across, one.along) for one in curvatures])
    free = np.array([not (one.on_edge or one.on_relief_start) for one in contacts])
    bent = free[:, None] & (bends > 0.0)
    bent[:, 1] &= [not one.on_line for one in contacts]
    shift = np.where(bent, -slope(left) / np.where(bent, bends, 1.0), 0.0)  # (keys, contacts, 2)
    normal = pinion.gradient / np.linalg.norm(pinion.gradient, axis=-1, keepdims=True)
    normal *= np.sign(pinion.steepness)[..., None]
    plane = np.array([one.axes[:2] for one in curvatures])  # (contacts, 2, 3)
    turned = np.einsum("kcs,csi->kci", shift, slope(normal, axis=1)) - np.einsum("kcs,csi->kci", slope(grown[0]), plane)
    moved = np.einsum("kcs,csi->kci", shift, plane)
    point, out = np.array([one.point for one in contacts]), np.array([one.axes[2] for one in separations])
    levers = np.zeros((2, *at_contact.shape))
    for gear, (origin, axis) in enumerate(
        ((np.zeros(3), np.array([0.0, 0.0, 1.0])), (pair.wheel_origin, pair.wheel_axes[2]))
    ):
        arm = point - origin
        sense = np.sign(np.cross(arm, out) @ axis)
        levers[gear] = (np.cross(moved, out) + np.cross(arm, turned)) @ axis
        for key, change in enumerate(changes if gear == 1 else ()):
            shifted, tilted = change.moved_wheel
            levers[gear, key] += np.cross(arm, out) @ tilted[2] - np.cross(shifted, out) @ axis
        levers[gear] *= np.where(free, sense, 0.0)
    shifts = np.einsum("kci,ci->kc", moved, np.array([one.axes[0] for one in separations]))
    return steep, at_contact, levers, shifts


def _grown(pair: GearPair, changes: Sequence[PairChange], pinion: FlankPoints, wheel: FlankPoints) -> Array:
    """Growth ds of the flanks of pinion and wheel along the normal (2, keys, ...) [mm per unit of the key]."""
    grown = np.zeros((2, len(changes), *pinion.rho.shape))
    for gear, (name, own, points) in enumerate((("pinion", pair.pinion, pinion), ("wheel", pair.wheel, wheel))):
        per_turn = 1.0 / points.steepness
        per_length = -own.flank.side * own.flank.gradient_norm(points.rho, points.z).value * per_turn
        for key, change in enumerate(changes):
            if not change.key.startswith(name):
                continue
            below, above = (getattr(side, name) for side in (change.below, change.above))
            edges = below.sharp.flank, above.sharp.flank  # the arcs of rounded edges are those of unmodified flanks
            if change.of_modifications and not isinstance(edges[1], SplineFlank):
                grown[gear, key] = removal_change(*edges, points.rho, points.z) * per_length
            else:
                low, high = (one.flank.theta(points.rho, points.z).value for one in (below, above))
                grown[gear, key] = (high - low) * per_turn
            grown[gear, key] /= change.difference
    for key, change in enumerate(changes):
        if change.key.startswith("mounting"):
            shift, turn = change.moved_wheel
            moved = pair.wheel_axes @ shift - wheel.point @ pair.wheel_axes @ turn.T  # in the frame of the wheel
            grown[1, key] = (wheel.gradient * moved).sum(axis=-1) / wheel.steepness
    return grown
