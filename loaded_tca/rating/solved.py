"""What a rating takes of a solved mesh, under its torques and between them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.tribology.slices import slices_of

OF_ROOT = 1.0
OF_FLANK = 0.5
"""Powers of the torque that root tension and pressure of a line contact grow with: what is left is interpolated."""


@dataclass(frozen=True, eq=False)
class SolvedLoads:
    """Load factors and largest local stresses under some torques (c,).

    Attributes
    ----------
    torque : (c,) array [N mm]
        Ascending, of those that were solved.
    face_load_factor, transverse_load_factor : (c,) array
    pressure : (c,) array [MPa]
        Largest pressure of a line contact over all slices of all contacts.
    places : (2, c, 2) array [mm]
        Radius and axial coordinate of its place, on pinion and wheel; between torques that of the nearest.
    at_edge : (c,) array of bool
        Whether that slice lies at an edge of a flank; likewise.
    root_tension, root_stress_ratio : (c, 2) array, or None
        Largest tension of the roots of both gears [MPa], smallest over largest stress of its place.
    """

    torque: Array
    face_load_factor: Array
    transverse_load_factor: Array
    pressure: Array
    places: Array
    at_edge: Mask
    root_tension: Array | None = None
    root_stress_ratio: Array | None = None

    def at(self, torques: Array) -> SolvedLoads:
        """The same under other torques, none above the largest: as solved, or interpolated.

        Factors, and stresses over the power of the torque that they grow with, are monotone cubics (PCHIP) between
        their solved values, logarithms over the logarithm of the torque; below the smallest torque they go on straight.
        """
        nearest = self._nearest(torques)
        exact = self._of(nearest)
        if np.array_equal(exact.torque, torques):
            return exact
        stresses = None if self.root_tension is None else self._between(self.root_tension, torques, OF_ROOT)
        return replace(
            exact,
            torque=torques,
            face_load_factor=self._between(self.face_load_factor, torques),
            transverse_load_factor=self._between(self.transverse_load_factor, torques),
            pressure=self._between(self.pressure, torques, OF_FLANK),
            root_tension=stresses,
            root_stress_ratio=None
            if self.root_stress_ratio is None
            else self._straight(self.root_stress_ratio, torques),
        )

    def every_second(self) -> SolvedLoads:
        """The same with every second torque left out, but for the first and the last."""
        places = np.unique([*range(0, len(self.torque), 2), len(self.torque) - 1])
        return self._of(places)

    def _nearest(self, torques: Array) -> Indices:
        """Index of the solved torque next to each."""
        return np.abs(self.torque[:, None] - torques).argmin(axis=0)

    def _of(self, some: Indices) -> SolvedLoads:
        """As solved under some of the torques, by index."""
        return SolvedLoads(
            self.torque[some],
            self.face_load_factor[some],
            self.transverse_load_factor[some],
            self.pressure[some],
            self.places[:, some],
            self.at_edge[some],
            None if self.root_tension is None else self.root_tension[some],
            None if self.root_stress_ratio is None else self.root_stress_ratio[some],
        )

    def _between(self, values: Array, torques: Array, power: float = 0.0) -> Array:
        """Positive values (n, ...) that grow about as a power of the torque, under other torques (c, ...)."""
        shape = -1, *[1] * (values.ndim - 1)
        nodes, wanted = np.log(self.torque), np.log(torques)
        rest = np.log(values) - power * nodes.reshape(shape)
        inside = np.maximum(wanted, nodes[0])
        if len(nodes) == 1:
            logarithms = np.broadcast_to(rest, (len(torques), *values.shape[1:]))
        else:
            logarithms = scipy.interpolate.PchipInterpolator(nodes, rest)(inside)
            slope = (rest[1] - rest[0]) / (nodes[1] - nodes[0])
            logarithms = logarithms + slope * (wanted - inside).reshape(shape)
        return np.asarray(np.exp(logarithms + power * wanted.reshape(shape)))

    def _straight(self, values: Array, torques: Array) -> Array:
        """Values (n, gear) of any sign, straight over the logarithm of the torque."""
        nodes, wanted = np.log(self.torque), np.log(torques)
        return np.stack([np.interp(wanted, nodes, column) for column in values.T], axis=-1)


def solved_loads(result: CycleNumbers) -> SolvedLoads:
    """Loads of a result under the torques that it was solved for, each once, ascending."""
    torque, order = np.unique(np.asarray(result.torque), return_index=True)
    pressure, places, at_edge = _largest_pressures(result)
    roots = result.scene.analysis.root_stress
    return SolvedLoads(
        torque,
        np.asarray(result.face_load_factor)[order],
        np.asarray(result.transverse_load_factor)[order],
        pressure[order],
        places[:, order],
        at_edge[order],
        np.nanmax(result.root_tension, axis=1)[order] if roots else None,
        np.asarray(result.root_stress_ratio)[order] if roots else None,
    )


def _largest_pressures(result: CycleNumbers) -> tuple[Array, Array, Mask]:
    """Largest contact pressure of slices under each torque (t,), its places (2, t, 2), whether they lie at an edge."""
    sweep, count = slices_of(result), len(result.torque)
    pressure, places, at_edge = np.full(count, np.nan), np.full((2, count, 2), np.nan), np.zeros(count, dtype=bool)
    for torque in range(count):
        some = sweep.of_torque(torque)
        some = some[np.isfinite(sweep.pressure[some])]
        worst = int(some[sweep.pressure[some].argmax()])
        pressure[torque] = sweep.pressure[worst]
        places[0, torque] = sweep.radius[worst], sweep.wheel_radius[worst]
        places[1, torque] = sweep.axial[worst], sweep.wheel_axial[worst]
        at_edge[torque] = sweep.on_edge[worst]
    return pressure, places, at_edge
