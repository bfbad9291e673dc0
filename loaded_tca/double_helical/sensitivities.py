r"""Derivatives of a double helical pair: those of both halves, by the chain rule through share and axial motion.

With u_h by which the flanks of half h give way or part more for a unit of a key under the force that it has, c_h its
compliance, and the words of :mod:`loaded_tca.double_helical.balance`, the balance differentiated once is

.. math:: x' = u_a + c_a F_a' + \kappa r' = u_b + c_b F_b' - \kappa r', \qquad F_a' + F_b' = F', \quad
          \kappa (F_a' - F_b') = K r'
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.double_helical.laws import axial_stiffness, between_torques, half_law
from loaded_tca.errors import InputError, named
from loaded_tca.notebooks import InNotebooks
from loaded_tca.results.sensitivities import NEWTON_MILLIMETRES, TORQUE
from loaded_tca.scene.double_helical import HALVES, DoubleHelicalScene
from loaded_tca.scene.section import key_at
from loaded_tca.separation.pair_change import number_at

if TYPE_CHECKING:
    from loaded_tca.double_helical.result import DoubleHelicalResult
    from loaded_tca.results.sensitivities import Sensitivities

APEX = "pair.apex_offset_mm"
STEP = 1e-3
"""Of a mounting error [um, mm, deg], over which those of the halves, which are sines of it, are differentiated: to
1e-10 of their slopes."""
ALLOWED = f"{TORQUE}, {APEX}, and keys of [mounting] and of the modifications of both gears and of their half_b"

ON_SHAFTS = (
    "both halves load the shafts, and derivatives of both halves together need rigid axes; use the derivatives of "
    "half_a or half_b, which hold the loads of the other half constant"
)


class _Half(NamedTuple):
    """Derivatives of a half: of its own keys, and how far these change with the keys of the pair (key, own key)."""

    slopes: Sensitivities
    weights: Array
    parted: Array


@dataclass(frozen=True, eq=False)
class DoubleHelicalSensitivities(InNotebooks):
    """Derivatives of a double helical pair to keys of its scene, found when they are asked for.

    Attributes
    ----------
    keys : tuple of str
        As of ``scene.with_changes``; the unit of each is in its name.
    result : DoubleHelicalResult
        What they are derivatives of. Faces stay where they were analysed: of a floating gear they stand within a
        thousandth of the width of where the balance moves them to.
    """

    keys: tuple[str, ...]
    result: DoubleHelicalResult

    @cached_property
    def _halves(self) -> tuple[_Half, _Half]:
        first, second = (self._of_half(half) for half in range(len(HALVES)))
        return first, second

    def _of_half(self, half: int) -> _Half:
        scene, cycle = self.result.scene, self.result.halves[half]
        changes = [_changes_of_half(scene, half, key) for key in self.keys]
        names = [*dict.fromkeys((TORQUE, *(name for of_key, _ in changes for name in of_key)))]
        weights = np.array([[of_key.get(name, 0.0) for name in names] for of_key, _ in changes])
        with named(f"half {HALVES[half]}"):
            return _Half(cycle.sensitivities(names), weights, np.array([parted for _, parted in changes]))

    @cached_property
    def _carried(self) -> Array:
        """Torques of both halves (t, n, half) [N mm]."""
        return np.asarray(self.result.torque_share * self.result.torque[:, None, None])

    def _at(self, half: int, values: Array) -> Array:
        """Numbers (t, n, own key) of a half under what it carries, of those (k, n, own key) under its torques."""
        cycle, torques = self.result.halves[half], self._carried[..., half]
        columns = np.moveaxis(values, -1, 0)
        return np.stack([between_torques(cycle.torque, column, torques, known_at_zero=False) for column in columns], -1)

    @cached_property
    def _balance(self) -> _Growth:
        """Growth of forces, motion and approach."""
        result = self.result
        scene, rate = result.scene, result.scene.axial_rate
        radius = scene.mesh().pinion.base_radius
        given, compliances = [], []
        for half, (of_half, cycle) in enumerate(zip(self._halves, result.halves, strict=True)):
            length = -cycle.gear_pair.driving * cycle.gear_pair.base_radii[1]
            slopes = self._at(half, of_half.slopes.transmission_error)
            given.append(length * slopes @ of_half.weights.T + of_half.parted)
            force = (self._carried[..., half] / radius).ravel()
            places = np.tile(np.arange(self._carried.shape[1]), len(self._carried))
            law = half_law(cycle, rate)
            compliances.append(law.at(force, places)[1].reshape(self._carried.shape[:2])[..., None])
        whole = np.array([NEWTON_MILLIMETRES / radius if key == TORQUE else 0.0 for key in self.keys])
        return _grown(given, compliances, whole, self._carried, rate, axial_stiffness(scene))

    @property
    def transmission_error(self) -> Array:
        """Derivatives of the transmission error, (torque, position, key) [rad per unit of the key]."""
        pair = self.result.half_a.gear_pair
        return np.asarray(-pair.driving * self._balance.approach / pair.base_radii[1])

    @property
    def peak_to_peak(self) -> Array:
        """Derivatives of the span of the transmission error over the pitch, (torque, key) [rad per unit]."""
        error, slopes = self.result.transmission_error, self.transmission_error
        rows = np.arange(len(error))
        return np.asarray(slopes[rows, error.argmax(axis=1)] - slopes[rows, error.argmin(axis=1)])

    @property
    def axial_motion(self) -> Array:
        """Derivatives of the motion of the floating gear towards half a, (torque, position, key) [mm per unit]."""
        toward = {"none": 0.0, "pinion": -1.0, "wheel": 1.0}[self.result.scene.geometry.floating]
        return np.asarray(toward * self._balance.motion)

    @property
    def torque_share(self) -> Array:
        """Derivatives of the shares, (torque, position, half, key) [1 per unit]."""
        radius, shares = self.result.scene.mesh().pinion.base_radius, self.result.torque_share[..., None]
        forces = self._balance.forces
        grown = radius * (forces - shares * forces.sum(axis=-2, keepdims=True))
        return np.asarray(grown / self.result.torque[:, None, None, None])

    @property
    def peak_pressure(self) -> Array:
        """Derivatives of the peak pressure of each half, (torque, position, half, key) [MPa per unit].

        Of the tooth pair that has it, as those of a mesh cycle, with what the change of the share adds.
        """
        return self._of_contacts("peak_pressure")

    @property
    def line_load(self) -> Array:
        """Derivatives of the largest line load of each half, (torque, position, half, key) [N/mm per unit]."""
        return self._of_contacts("line_load")

    def _of_contacts(self, name: str) -> Array:
        """Derivatives of the largest number of the contacts of each half."""
        radius, parts = self.result.scene.mesh().pinion.base_radius, []
        for half, (of_half, cycle) in enumerate(zip(self._halves, self.result.halves, strict=True)):
            most = np.nan_to_num(cycle.values(name)).argmax(axis=-1)[..., None, None]
            slopes = self._at(half, np.take_along_axis(getattr(of_half.slopes, name), most, axis=2)[..., 0, :])
            by_torque = slopes[..., :1] / NEWTON_MILLIMETRES  # the first of its keys is its torque
            parts.append(slopes @ of_half.weights.T + by_torque * radius * self._balance.forces[..., half, :])
        return np.stack(parts, axis=-2)


def double_helical_sensitivities(result: DoubleHelicalResult, keys: Sequence[str]) -> DoubleHelicalSensitivities:
    """Derivatives of a double helical pair; see :meth:`loaded_tca.double_helical.DoubleHelicalResult.sensitivities`."""
    problems = [f"{key}: given twice" for key in dict.fromkeys(keys) if keys.count(key) > 1]
    for key in dict.fromkeys(keys):
        try:
            key_at(type(result.scene), key)
        except InputError as error:
            problems += error.problems
            continue
        if key not in (TORQUE, APEX) and not key.startswith("mounting.") and ".modifications." not in key:
            problems.append(f"{key}: there are no derivatives of both halves together; allowed are {ALLOWED}")
    if result.scene.is_supported:
        problems.append(f"sensitivities: {ON_SHAFTS}")
    elif apart := result.notes_of_places():
        problems.append(f"sensitivities: {apart[0]}")
    if problems:
        raise InputError(problems)
    return DoubleHelicalSensitivities(tuple(keys), result)


class _Growth(NamedTuple):
    """Derivatives of the balance: of the forces (t, n, half, key), the motion and the approach (t, n, key)."""

    forces: Array
    motion: Array
    approach: Array


def _grown(
    given: Sequence[Array], compliances: Sequence[Array], whole: Array, carried: Array, rate: float, stiffness: float
) -> _Growth:
    """Solve the balance differentiated once; ``given``: u_h (t, n, key), ``whole``: F' (key,)."""
    (of_a, of_b), (soft_a, soft_b) = given, compliances
    if stiffness == 0.0:
        first = np.broadcast_to(0.5 * whole, of_a.shape)
        motion = (of_b + soft_b * (whole - first) - of_a - soft_a * first) / (2.0 * rate)
    else:
        yields = 2.0 * rate**2 / stiffness
        first = (of_b - of_a + (soft_b + yields) * whole) / (soft_a + soft_b + 2.0 * yields)
        first = np.where(carried[..., :1] > 0.0, first, 0.0)  # what is out of reach carries nothing
        first = np.where(carried[..., 1:] > 0.0, first, whole)
        motion = rate * (2.0 * first - whole) / stiffness
    second = whole - first
    approach = np.where(
        carried[..., :1] > 0.0, of_a + soft_a * first + rate * motion, of_b + soft_b * second - rate * motion
    )
    return _Growth(np.stack([first, second], axis=-2), motion, approach)


def _changes_of_half(scene: DoubleHelicalScene, half: int, key: str) -> tuple[dict[str, float], float]:
    """By how much keys of the scene of a half change with a key of the pair, and how far its flanks part [mm]."""
    if key == TORQUE:
        return {}, 0.0
    if key == APEX or key.startswith("mounting."):
        return _by_mounting(scene, half, key)
    gear, *rest = key.split(".")
    if rest[0] == "half_b":
        return ({".".join((gear, *rest[1:])): 1.0} if half else {}), 0.0
    of_half_b = getattr(scene, gear).half_b
    replaced = half == 1 and of_half_b is not None and of_half_b.modifications is not None
    return ({} if replaced else {key: 1.0}), 0.0


def _by_mounting(scene: DoubleHelicalScene, half: int, key: str) -> tuple[dict[str, float], float]:
    """The same of a mounting error or of the apex, with what the offset of the half takes off its deflection."""
    value = number_at(scene, key) if scene.mounting.half_b is not None or ".half_b." not in key else 0.0
    changed = [scene.with_changes({key: value + step}) for step in (-STEP, STEP)]
    ends = [end for end in changed if isinstance(end, DoubleHelicalScene)]  # both
    axial = [end.mounting.axial_offset_mm if scene.geometry.floating == "none" else 0.0 for end in ends]
    low, high = (end.mounting_of_half(half, place) for end, place in zip(ends, axial, strict=True))
    slopes = {f"mounting.{name}": (high[name] - low[name]) / (2.0 * STEP) for name in low}
    parted = (ends[1].parted[half] - ends[0].parted[half]) / (2.0 * STEP)
    offset = slopes["mounting.axial_offset_mm"]
    return {name: slope for name, slope in slopes.items() if slope != 0.0}, parted - scene.axial_rate * offset
