"""Deviations of measured flanks by errors of the settings that cut them, and the errors that explain most of them.

The problem and its method stand in :mod:`loaded_tca.flank_maps.settings_fit`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array, GearName, Mask
from loaded_tca.errors import ConvergenceError, GeometryError, InputError, give_accuracy_warning, named, require
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.setting_slopes import cut_at, setting_of, with_settings
from loaded_tca.flanks.topography import Topography, excess_problems
from loaded_tca.gears.face_milled import BLADE_SIGNS, FaceMilledGear, FlankName
from loaded_tca.plain import plain
from loaded_tca.tooth.face_milled import FaceMilledTooth
from loaded_tca.units import MICROMETRES, factor_of, without_unit

SAME = 1e-7
"""Effect of settings together, over that of each, below which they do the same to the flanks."""
WEAK = 1e-2
"""Below this a warning names them: noise of the measurement grows by the inverse in the settings."""
TYPICAL = 0.01
"""Effect of a setting by itself in what is said of those that do the same [mm], root of the mean square."""
NAMED = 0.05
"""Part of the largest one from which a setting is named."""
SETTLED = 1e-11
"""Largest effect of a setting on the flanks in the last step [mm], root of the mean square."""
MOST_STEPS, MOST_HALVINGS = 30, 8


@checked
@dataclass(frozen=True, eq=False)
class MeasuredFlank:
    """One measured flank of a face-milled gear.

    Parameters
    ----------
    gear : {"pinion", "wheel"}
    flank : {"concave", "convex"}
    topography : Topography
        ``MeasuredDeviations`` from the flank of the scene, or ``MeasuredPoints``. Its weights are those of the squares
        of the deviations; a point of weight zero is shown, but not fitted.

    Raises
    ------
    InputError
        If a name is another one.
    """

    gear: GearName
    flank: FlankName
    topography: Topography

    def __post_init__(self) -> None:
        require(
            (self.gear in GEARS, f"gear: {self.gear!r:.60} is not 'pinion' or 'wheel'"),
            (self.flank in BLADE_SIGNS, f"flank: {self.flank!r:.60} is not 'concave' or 'convex'"),
        )

    @property
    def weights(self) -> Array:
        """Weights of the points, (n, m)."""
        weights = self.topography.weights
        return np.ones(self.topography.radius.shape[:2]) if weights is None else np.asarray(weights)

    @property
    def name(self) -> str:
        """Gear and flank, as in messages."""
        return f"{self.gear}, {self.flank} flank"


@dataclass(frozen=True, eq=False)
class MeasuredPlaces:
    """Points of a measured flank in a row, their deviations, and Theta there by the settings of the scene."""

    measured: MeasuredFlank
    nominal: Flank
    rho: Array
    z: Array
    excess: Array
    """Deviations [mm]."""
    scale: Array
    """Deviation for an angle of Theta of a right-hand member [mm/rad]."""
    turning: Array
    """Deviation for a turn of the gear [mm/rad]."""
    theta: Array
    root_weight: Array

    @classmethod
    def of(cls, measured: MeasuredFlank, gear: FaceMilledGear, teeth: FaceMilledTooth) -> MeasuredPlaces:
        """Points as they lie on the nominal flank of a gear."""
        flank, topography, side = measured.flank, measured.topography, gear.side(measured.flank)
        nominal = teeth.modified(teeth.nominal(side))
        with named(f"measured, {measured.name}"):
            inside = nominal.inside(topography.radius, topography.axial, OFF_EDGE * min(nominal.extent))
            require((bool(np.all(inside)), _beside(nominal, topography, inside)))
            excess = topography.excess_over(nominal, turned=True)
            if problems := excess_problems(nominal, excess):
                raise InputError(problems)
        rho, z = topography.radius.ravel(), topography.axial.ravel()
        angles = nominal.gradient_norm(rho, z).value
        theta = cut_at(gear, flank, rho, z)[0]
        weights = np.sqrt(measured.weights.ravel())
        return cls(
            measured, nominal, rho, z, excess.ravel(), BLADE_SIGNS[flank] / angles, side / angles, theta, weights
        )

    def grid(self, values: Array) -> Array:
        """Values (n * m,) in rows and columns."""
        return values.reshape(self.measured.topography.radius.shape[:2])


OFF_EDGE = 1e-6
"""Part of the flank's height and width by which points on its edges may miss them."""


def _beside(nominal: Flank, topography: Topography, inside: Mask) -> str:
    worst = np.unravel_index(int(np.argmin(nominal.room(topography.radius, topography.axial))), inside.shape)
    place = nominal.frame.place(float(topography.radius[worst]), float(topography.axial[worst]))
    room = -float(nominal.room(topography.radius, topography.axial)[worst])
    outside = f"{int((~np.asarray(inside)).sum())} of {inside.size} points lie beside the flank"
    return f"{outside}, the farthest {plain(room, 3)} mm beyond an edge, {place}: wrong gear, apex or unit?"


class SettingsProblem:
    """Deviations of all points by errors of settings and turns of flanks."""

    def __init__(
        self,
        gears: Mapping[GearName, FaceMilledGear],
        points: tuple[MeasuredPlaces, ...],
        keys: tuple[str, ...],
        turned: str,
    ) -> None:
        self.gears, self.points, self.keys = gears, points, keys
        self.factors = np.array([factor_of(key) for key in keys])
        self.names = [(key.partition(".")[0], without_unit(key.partition(".")[2])) for key in keys]
        self.excess = np.concatenate([one.excess for one in points])
        weights = np.concatenate([one.root_weight for one in points])
        self.weight = weights / np.linalg.norm(weights)
        groups = [one.measured.gear if turned == "tooth" else one.measured.name for one in points]
        columns = [
            [one.turning * (group == own) for one, own in zip(points, groups, strict=True)]
            for group in dict.fromkeys(groups)
        ]
        self.turning = np.stack([np.concatenate(column) for column in columns], axis=1)
        basis = np.linalg.qr(self.weight[:, None] * self.turning)[0]
        self._turns = basis

    def without_turns(self, columns: Array) -> Array:
        """Weighted columns (points, k) less what turns of the flanks make of them."""
        return columns - self._turns @ (self._turns.T @ columns)

    def parts(self, values: Array) -> list[Array]:
        """Values of all points by flanks."""
        return np.split(values, np.cumsum([one.rho.size for one in self.points])[:-1])

    def cut(self, errors: Array) -> tuple[Array, Array]:
        """Deviations (points,) that errors of settings make, and their derivatives (points, settings)."""
        gears = {
            gear: with_settings(
                own,
                {
                    name: float(setting_of(own, name) or 0.0) + error
                    for (of, name), error in zip(self.names, errors.tolist(), strict=True)
                    if of == gear
                },
            )
            for gear, own in self.gears.items()
        }
        values, slopes = [], []
        for one in self.points:
            gear, flank = one.measured.gear, one.measured.flank
            free = [number for number, (of, _) in enumerate(self.names) if of == gear]
            theta, by_free = cut_at(gears[gear], flank, one.rho, one.z, [self.names[number][1] for number in free])
            by_all = np.zeros((len(self.keys), one.rho.size))
            by_all[free] = by_free
            values.append(one.scale * (theta - one.theta))
            slopes.append((one.scale * by_all).T)
        return np.concatenate(values), np.concatenate(slopes)

    def left(self, errors: Array, turns: Array) -> Array:
        """Deviations that errors and turns do not explain."""
        return self.excess - self.cut(errors)[0] - self.turning @ turns

    def best_turns(self, values: Array) -> Array:
        """Turns that leave least of values at the points."""
        return np.linalg.lstsq(self.weight[:, None] * self.turning, self.weight * values)[0]

    def directions(self) -> tuple[Array, float]:
        """Changes that together change the flanks least, and by how much; refuses settings that do the same."""
        slopes = self.weight[:, None] * self.cut(np.zeros(len(self.keys)))[1]
        free = self.without_turns(slopes)
        sizes, whole = np.linalg.norm(free, axis=0), np.linalg.norm(slopes, axis=0)
        require(
            *(
                (size > SAME * all_of, f"settings: {key}: only turns the measured flanks; leave it out")
                for key, size, all_of in zip(self.keys, sizes, whole, strict=True)
            )
        )
        _, values, ways = np.linalg.svd(free / sizes, full_matrices=False)
        tied = [self._named(way, sizes) for value, way in zip(values, ways, strict=True) if value < SAME * values[0]]
        if tied or len(values) < len(self.keys):
            words = "; ".join(tied) or f"{len(values)} points for {len(self.keys)} settings"
            raise InputError(f"settings: some of them do the same to the measured flanks, leave one out of: {words}")
        weakest = TYPICAL * ways[-1] / np.abs(ways[-1]).max()
        effect = float(values[-1] * np.linalg.norm(weakest))
        if effect < WEAK * TYPICAL:
            sentence = kinds.WEAK_SETTINGS.sentence(
                effect=plain(MICROMETRES * effect, 2), changes=self._named(ways[-1], sizes)
            )
            give_accuracy_warning(sentence)
        return weakest / sizes * self.factors, effect

    def _named(self, way: Array, sizes: Array) -> str:
        """Settings of a direction with changes that have effects of at most 10 um each."""
        changes = TYPICAL * way / np.abs(way).max() / sizes * self.factors
        parts = [
            f"{key} {plain(change, 3, '+')}"
            for key, part, change in zip(self.keys, way, changes, strict=True)
            if abs(part) >= NAMED * np.abs(way).max()
        ]
        return ", ".join(parts)

    def solved(self, limits: Array) -> tuple[Array, Array]:
        """Errors of the settings within their limits, and turns."""
        errors, turns = np.zeros(len(self.keys)), self.best_turns(self.excess)
        unbounded = np.full(self.turning.shape[1], math.inf)
        values, slopes = self.cut(errors)
        sizes = np.linalg.norm(self.without_turns(self.weight[:, None] * slopes), axis=0)
        for _ in range(MOST_STEPS):
            missed = self.weight * (self.excess - values - self.turning @ turns)
            matrix = self.weight[:, None] * np.hstack([slopes / sizes, self.turning])
            low, high = (np.concatenate([(side * limits - errors) * sizes, side * unbounded]) for side in (-1.0, 1.0))
            answer = scipy.optimize.lsq_linear(matrix, missed, bounds=(low, high), method="bvls", tol=1e-14)
            step, turn = answer.x[: errors.size] / sizes, answer.x[errors.size :]
            before = float(np.linalg.norm(missed))
            errors, turns, values, slopes = self._taken(errors, turns, step, turn, before)
            errors = np.clip(errors, -limits, limits)
            if float(np.abs(step * sizes).max()) < SETTLED:
                return errors, turns
        raise ConvergenceError(
            f"settings: the corrections do not settle in {MOST_STEPS} steps; the last one changes the flanks by "
            f"{plain(MICROMETRES * float(np.abs(step * sizes).max()), 2)} um; free fewer settings, or give them limits",
            errors * self.factors,
        )

    def _taken(
        self, errors: Array, turns: Array, step: Array, turn: Array, before: float
    ) -> tuple[Array, Array, Array, Array]:
        """Errors, turns, deviations and their derivatives after a step, or the part of it that lessens what is left."""
        last: Exception | None = None
        for halving in range(MOST_HALVINGS):
            part = 0.5**halving
            try:
                values, slopes = self.cut(errors + part * step)
            except (GeometryError, InputError) as error:  # settings of no machine, or that cut no flank
                last = error
                continue
            moved = turns + part * turn
            after = float(np.linalg.norm(self.weight * (self.excess - values - self.turning @ moved)))
            if after <= before + SETTLED:
                return errors + part * step, moved, values, slopes
        raise ConvergenceError(
            "settings: no step makes the remaining deviations smaller; free fewer settings, or give them limits"
            + (f" ({last})" if last else ""),
            errors * self.factors,
        )

    def deviation(self, errors: Array, left: Array, fixed: Mask) -> Array:
        """Standard deviations of the errors by what is left, as noise; zero of those that are fixed.

        NaN where there are no more points than unknowns, which leave nothing.
        """
        free = self.without_turns(self.weight[:, None] * self.cut(errors)[1][:, ~fixed])
        count = int((self.weight > 0.0).sum()) - free.shape[1] - self.turning.shape[1]
        result = np.where(fixed, 0.0, np.nan)
        if count > 0 and free.shape[1]:
            sizes = np.linalg.norm(free, axis=0)
            inverse = np.linalg.pinv(free / sizes) / sizes[:, None]
            result[~fixed] = np.linalg.norm(self.weight * left) / math.sqrt(count) * np.linalg.norm(inverse, axis=1)
        return result
