"""The numbers of a mesh cycle: its dataset, paths and pressure maps, and what is looked up in them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.errors import InputError, NotAskedError
from loaded_tca.results.declared import PAIRS, Numbers
from loaded_tca.results.quantities import (
    COORDINATES,
    CYCLE_NUMBERS,
    OF_THE_EDGE,
    OF_THE_PEAK,
    ROLLING_QUANTITIES,
    ROOT_STRESS,
)
from loaded_tca.unloaded.teeth import harmonic_coefficients

if TYPE_CHECKING:
    import xarray
    from numpy.typing import NDArray

    from loaded_tca.arrays import Array
    from loaded_tca.loaded.sensitivity import LoadedStates
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.pressure_map import Maps
    from loaded_tca.scene import Scene
    from loaded_tca.unloaded import ContactPath


def index_or_largest(torques: Array, torque: int | None = None) -> int:
    """Index of a torque among all, by default of the largest."""
    return int(np.argmax(torques)) if torque is None else torque


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class CycleNumbers(Numbers):
    """Numbers of the loaded contact over the positions of a pitch, under each torque, and what is looked up in them.

    What is computed from these numbers is computed when it is asked for, so that it follows what is written into the
    dataset. Attributes are those of :class:`loaded_tca.results.MeshCycle`, which adds texts, files and derivatives.
    """

    NUMBERS: ClassVar = CYCLE_NUMBERS
    COORDINATES: ClassVar = COORDINATES

    scene: Scene
    dataset: xarray.Dataset
    path: ContactPath
    paths: tuple[ContactPath, ...]
    maps: Maps
    states: tuple[Scene, tuple[LoadedStates, ...]] | None = field(default=None, repr=False, compare=False)

    def __getattr__(self, name: str) -> Any:
        if name == "root_stress":  # whose NotAskedError is an AttributeError, after which Python asks here
            name = next(iter(ROOT_STRESS))
            raise NotAskedError(f"root_stress: {self.lacking(name)}")
        return super().__getattr__(name)

    @cached_property
    def gear_pair(self) -> GearPair:
        """The gears of the scene in space."""
        return self.scene.pair()

    @property
    def has_root_stress(self) -> bool:
        """Whether the analysis found root stress: its scene asked for it."""
        return "root_tension" in self.dataset

    @property
    def has_rolling_bearings(self) -> bool:
        """Whether a shaft of the scene has rolling bearings by their inner geometry."""
        return any(name in self.dataset for name in ROLLING_QUANTITIES)

    def without_body_torsion(self, stiffness: float) -> float:
        """Mesh stiffness without the twist of the gear bodies, to be compared with c_gamma of ISO 6336-1.

        Parameters
        ----------
        stiffness : float [N/(mm um)]
            With it, for instance a mean of ``mesh_stiffness``.

        Returns
        -------
        float [N/(mm um)]
            NaN where teeth do not bend.
        """
        if not self.scene.analysis.teeth_bend or not stiffness > 0.0:
            return math.nan
        from loaded_tca.compliance.body import body_torsion  # finite elements, which an overview needs not

        return 1.0 / (1.0 / stiffness - 1e3 * self.face_width * sum(body_torsion(self.gear_pair)))

    @property
    def bending(self) -> str:
        """Whether teeth bend, in words."""
        return self.scene.analysis.bending

    @property
    def peak_column(self) -> NDArray[np.int_]:
        """Index of the pair with the highest peak pressure, (torque, position)."""
        return _column_of_largest(self.peak_pressure)

    def at_position(self, name: str) -> Array:
        """Return one number for each position, that of one of its tooth pairs: (torque, position).

        Numbers of ``OF_THE_PEAK`` belong to the pair with the highest peak pressure, those of the edge to the pair with
        the highest edge pressure, all others to the pair with the largest force: a tip corner may have the highest
        edge pressure under next to none.

        Parameters
        ----------
        name : str
            Of an array (torque, position, pair).

        Raises
        ------
        InputError
            For any other name.
        """
        if not isinstance(name, str) or name not in self.dataset or self.dataset[name].dims != PAIRS:
            known = f"; result.{name} has its numbers as they are" if name in self.NUMBERS else ""
            raise InputError(f"name: {name!r} is no array (torque, position, pair) of the result{known}")
        values = self.dataset[name].values
        if name in OF_THE_PEAK:
            columns = self.peak_column
        elif name in OF_THE_EDGE:
            columns = _column_of_largest(self.edge_pressure)
        else:  # without load, of the pair in contact
            columns = np.where(np.isnan(self.peak_pressure), -1.0, self.normal_force).argmax(axis=-1)
        return np.take_along_axis(values, columns[..., None], axis=-1)[..., 0]

    def harmonics(self, count: int) -> Array:
        """Return the amplitudes of the orders 1 to ``count`` of the tooth mesh of the loaded transmission error.

        Parameters
        ----------
        count : int
            Of orders, at least 1.

        Returns
        -------
        (m, count) array [rad]
            For each torque; NaN where one pair carries the whole load, since its error has no period, and for orders
            of which the positions are too few.
        """
        return np.abs(self._harmonic_coefficients(count))

    def harmonic_phases(self, count: int) -> Array:
        """Return the phases of the orders 1 to ``count`` of the tooth mesh of the loaded transmission error.

        TE(phi1) = mean + sum of amplitude_k cos(k z1 phi1 + phase_k), with the amplitudes of ``harmonics``. Phases
        count from the pinion angle 0, as those of the unloaded ``MeshPath.harmonics`` do.

        Parameters
        ----------
        count : int
            Of orders, at least 1.

        Returns
        -------
        (m, count) array [rad]
            From -pi to pi; NaN where the amplitude is. That of an amplitude near zero is rounding.
        """
        return np.angle(self._harmonic_coefficients(count))

    @property
    def places_of_mesh(self) -> int:
        """Positions that are places of their own: where pairs share the load both ends of a pitch are one."""
        return len(self.pinion_angle) - int(self.scene.analysis.load_sharing and len(self.pinion_angle) > 1)

    def _harmonic_coefficients(self, count: int) -> NDArray[np.complex128]:
        """Complex amplitudes (m, count) [rad] of the orders, phases from the pinion angle 0."""
        if not isinstance(count, int | np.integer) or count < 1:
            raise InputError(f"count: {count!r} is not a whole number from 1 on")
        periodic = self.scene.analysis.load_sharing
        begin = float(self.pinion_angle[0]) / self.gear_pair.pitch
        curves = self.transmission_error[:, : None if periodic else 0]
        return np.stack([harmonic_coefficients(curve, count, begin) for curve in curves])

    def peak_contact(self, torque: int, *, where_hertz_holds: bool = False) -> tuple[int, int] | None:
        """Return indices of position and pair with the highest peak pressure; None if no contact qualifies."""
        known = np.isfinite(self.hertz_pressure) | (not where_hertz_holds)
        return _place_of_largest(np.where(known, self.peak_pressure, math.nan)[torque])

    def edge_contact(self, torque: int) -> tuple[int, int] | None:
        """Return indices of position and pair with the highest edge pressure; None where no edge is reached."""
        return _place_of_largest(self.edge_pressure[torque])

    def most_loaded_contact(self, torque: int) -> tuple[int, int] | None:
        """Return indices of position and pair with the largest force; None if nothing is in contact."""
        return _place_of_largest(np.where(np.isnan(self.peak_pressure), math.nan, self.normal_force)[torque])


def _column_of_largest(values: Array) -> NDArray[np.int_]:
    """Index along the last axis of the largest finite value; the first one where none is."""
    return np.asarray(np.where(np.isfinite(values), values, -math.inf).argmax(axis=-1))


def _place_of_largest(values: Array) -> tuple[int, int] | None:
    """Indices of the largest finite value of an array (positions, pairs); None if there is none."""
    if not np.isfinite(values).any():
        return None
    position, pair = np.unravel_index(int(np.nanargmax(values)), values.shape)
    return int(position), int(pair)
