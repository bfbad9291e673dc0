r"""Shafts under both halves of a double helical pair: each half stands on shafts that the other one loads, too.

Half h loads the stations of its shafts by W_h. Its mesh cycle has the mean load of the other half as a further load of
the shafts, so that its gears stand where both halves move them. What the load of the other half differs from that mean
moves the flanks of half a by

.. math:: u_a = w_a \cdot C_{ab} (F_b w_b - \bar W_b), \qquad w_h = W_h / F_h

along the line of action, with the motions C_ab of the stations of half a under unit loads of those of half b: by the
theorem of virtual work, to the first order in u_a. By reciprocity C_ba is its transpose, and w_a . C_ab w_b is the
coupling of both halves in their balance. Mean loads and mesh cycles are repeated until the loads move the gears no
further.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.double_helical.laws import balance_of
from loaded_tca.errors import named
from loaded_tca.loaded.moved_gears import at_rest, loads_at_first_contact
from loaded_tca.loaded.standing import CLOSE
from loaded_tca.results.supports import loads_of_stations
from loaded_tca.scene.double_helical import HALVES, DoubleHelicalScene
from loaded_tca.scene.half_shafts import MIRRORED, HalfLoads
from loaded_tca.supports import shafts_of, support_compliance, supports_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loaded_tca.double_helical.balance import Shares
    from loaded_tca.results import MeshCycle
    from loaded_tca.scene.cylindrical import CylindricalScene

Of = tuple[Array, Array]
"""Of pinion and wheel."""


def loads_at_first(
    scene: DoubleHelicalScene, axial: float, torques_Nm: Sequence[Sequence[float]] | None = None
) -> list[list[HalfLoads]]:
    """Loads of both halves under the largest torque of each [N m], even by default, where flanks touch at phi1 = 0."""
    every = []
    for name, half in zip(HALVES, scene.half_scenes(axial, torques_Nm), strict=True):
        with named(f"half {name}"):
            supports = support_compliance(half, pair := half.pair())
            assert supports is not None
            loads = loads_at_first_contact(supports, at_rest(pair, supports), max(half.torques))
        of_gears = zip(supports.supports, loads, strict=True)
        every.append([HalfLoads(support.places, load.reshape(-1, 6)) for support, load in of_gears])
    return every


def first_bearing_forces(scene: DoubleHelicalScene, axial: float, torque: float) -> dict[str, Array]:
    """Forces and moments (bearing, 6) on the bearings of each gear's shaft by :func:`loads_at_first` [N, N mm].

    Parameters
    ----------
    scene : DoubleHelicalScene
    axial : float [mm]
        Where the wheel stands along the axis.
    torque : float [N mm]
        Of both halves.
    """
    even = 2 * [[0.5e-3 * torque]]
    loads = loads_at_first(scene, axial, even)
    forces: dict[str, Array] = {}
    half, _ = scene.half_scenes(axial, even, loads)
    for name, shaft, (places, of_half) in zip(GEARS, shafts_of(half), loads[0], strict=True):
        if shaft is not None:
            with named(f"{name}.shaft"):
                solved = shaft.solved(places.tolist(), of_half.ravel())
            bearings = len(getattr(scene, name).shaft.bearings)
            forces[name] = solved.on_bearings[:bearings] @ np.append(of_half, 1.0)
    return forces


class Stations(NamedTuple):
    """Loads of the stations of a half by a unit force along the line of action, under its torques.

    Attributes
    ----------
    force : (k,) array [N]
        Along the line of action at the base circle.
    loads : two arrays (k, n, 6 m) [1, mm]
        Of pinion and wheel.
    """

    force: Array
    loads: Of

    @classmethod
    def of(cls, cycle: MeshCycle) -> Stations:
        """Of the mesh cycle of a half."""
        force = cycle.torque / cycle.gear_pair.base_radii[0]
        under = [loads_of_stations(cycle, torque) for torque in range(len(force))]
        pinion, wheel = (np.stack(loads) / force[:, None, None] for loads in zip(*under, strict=True))
        return cls(force, (pinion, wheel))

    def under(self, forces: Array) -> Of:
        """Loads by a unit force (n, 6 m) of both gears under forces (n,) [N], between those that were analysed."""
        low = np.clip(np.searchsorted(self.force, forces) - 1, 0, max(len(self.force) - 2, 0))
        high = np.minimum(low + 1, len(self.force) - 1)
        width = self.force[high] - self.force[low]
        beyond = np.clip(forces, self.force[0], self.force[-1]) - self.force[low]
        part = np.divide(beyond, width, out=np.zeros_like(forces), where=width > 0.0)[:, None]
        rows = np.arange(len(forces))
        pinion, wheel = ((1.0 - part) * of[low, rows] + part * of[high, rows] for of in self.loads)
        return pinion, wheel


@dataclass(frozen=True, eq=False)
class OnShafts:
    """Both halves on their shafts under one torque, analysed under mean loads of each other.

    Attributes
    ----------
    scene : DoubleHelicalScene
    scenes : two of CylindricalScene
        Of the halves, with the loads of each other.
    cycles : two of MeshCycle
    loads : two lists of HalfLoads
        Of each half on pinion and wheel, as the scenes have them.
    """

    scene: DoubleHelicalScene
    scenes: Sequence[CylindricalScene]
    cycles: Sequence[MeshCycle]
    loads: Sequence[Sequence[HalfLoads]]

    def balance(self) -> tuple[Shares, list[Of]]:
        """Balance of both halves under the torque, and the loads (n, 6 m) of each on its stations there."""
        stations = [Stations.of(cycle) for cycle in self.cycles]
        total = np.asarray(self.scene.torques) / self.scene.mesh().pinion.base_radius
        count = len(self.cycles[0].path)
        forces = np.full((len(HALVES), count), 0.5 * total[0])
        for _ in range(2):  # the place of the loads follows the shares
            units = [of_half.under(force) for of_half, force in zip(stations, forces, strict=True)]
            moved, coupling = self._coupling(units)
            state = balance_of(self.scene, self.cycles, np.asarray(self.scene.torques), moved, coupling)
            forces = state.force[0].T
        loads: list[Of] = []
        for (pinion, wheel), force in zip(units, forces, strict=True):
            loads.append((force[:, None] * pinion, force[:, None] * wheel))
        return state, loads

    def _coupling(self, units: Sequence[Of]) -> tuple[Of, Array]:
        """What flanks part by the mean loads of the other half less than in the mesh cycles, and the coupling (n,)."""
        count = len(units[0][0])
        moved, coupling = np.zeros((len(HALVES), count)), np.zeros(count)
        for gear, shaft in self._shafts.items():
            of_a, of_b = (of_half[gear] for of_half in units)
            mean_a, mean_b = (of_half[gear].loads.ravel() for of_half in self.loads)
            coupling += np.einsum("ni,ij,nj->n", of_a, shaft.across, of_b)
            moved[0] -= of_a @ (shaft.across @ mean_b)
            moved[1] -= of_b @ (mean_a @ shaft.across)
        return (moved[0], moved[1]), coupling

    @cached_property
    def _shafts(self) -> dict[int, _Shaft]:
        """Shafts by their gears, linear near the mean loads of both halves."""
        shafts = {}
        supports = supports_of(self.scenes[0])
        for gear, shaft in enumerate(shafts_of(self.scenes[0])):
            if shaft is None:
                continue
            lever = self.scene.lever_of((self.scene.pinion, self.scene.wheel)[gear])
            others = self.loads[1][gear].of_other_half(lever).places
            every = [*supports[gear].places.tolist(), *others.tolist()]
            near = np.zeros(6 * len(every))
            near[: near.size // 2] = self.loads[0][gear].loads.ravel()
            with named(f"{GEARS[gear]}.shaft"):
                solved = shaft.solved(every, near)
            signs = np.concatenate([np.ones(near.size // 2), np.tile(MIRRORED, len(others)), [1.0]])
            motions = solved.at_places.reshape(near.size, -1) * signs
            shafts[gear] = _Shaft(motions[: near.size // 2, near.size // 2 : -1], solved.on_bearings * signs)
        return shafts

    def is_settled(self, loads: Sequence[Of]) -> bool:
        """Whether the means of loads (n, 6 m) move the gears no further than the mesh cycles have them."""
        lever, ways = np.repeat([1.0, 0.5 * self.scene.narrow_half], 3), [0.0]
        for gear, shaft in self._shafts.items():
            for half, across in enumerate((shaft.across, shaft.across.T)):
                other = 1 - half
                change = mean_over_pitch(loads[other][gear]) - self.loads[other][gear].loads.ravel()
                support = supports_of(self.scenes[half])[gear]
                ways.append(float(np.abs(support.at_middle(across @ change) * lever).max()))
        return max(ways) <= CLOSE * self.scene.geometry.normal_module_mm

    def next_loads(self, loads: Sequence[Of]) -> list[list[HalfLoads]]:
        """Mean loads of both halves."""
        return [
            [
                HalfLoads(own.places, mean_over_pitch(of_gear).reshape(-1, 6))
                for own, of_gear in zip(of_half, new, strict=True)
            ]
            for of_half, new in zip(self.loads, loads, strict=True)
        ]

    def bearing_forces(self, loads: Sequence[Of]) -> dict[str, Array]:
        """Forces and moments (n, bearing, 6) on the bearings of the shafts, in the axes of each gear's own frame.

        Without those that stand for the axial position of a floating gear.
        """
        forces: dict[str, Array] = {}
        for gear, shaft in self._shafts.items():
            on_a, on_b = (of_half[gear] for of_half in loads)
            beyond = on_b - self.loads[1][gear].loads.ravel()
            every = np.concatenate([on_a, beyond, np.ones((len(on_a), 1))], axis=1)
            keys = (self.scene.pinion, self.scene.wheel)[gear].shaft
            assert keys is not None
            forces[GEARS[gear]] = np.einsum("bmi,ni->nbm", shaft.on_bearings[: len(keys.bearings)], every)
        return forces


class _Shaft(NamedTuple):
    """A shaft near the loads of both halves.

    Attributes
    ----------
    across : (6 m, 6 m) array [mm, rad, N, N mm]
        Motions of the stations of half a under unit loads of those of half b, as each half counts.
    on_bearings : (bearings, 6, 12 m + 1) array [N, N mm]
        Forces on bearings under unit loads of the stations of both halves, and under other loads.
    """

    across: Array
    on_bearings: Array


def mean_over_pitch(values: Array) -> Array:
    """Mean (m,) of values (n, m) over the positions of a pitch, whose end is the beginning of the next one."""
    return np.asarray(values[: max(1, len(values) - 1)].mean(axis=0))
