"""What a rating takes of a solved mesh, under its torques and between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS, Array, Indices
from loaded_tca.rating.roots import deciding_places, largest_places
from loaded_tca.results.key_figures import mean_over_a_pitch, span_of
from loaded_tca.scene.spiral import SpiralScene
from loaded_tca.tribology.contact_slices import largest_pressures

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import CommonInputs, Duty
    from loaded_tca.results.numbers import CycleNumbers

OF_ROOT = 1.0
OF_FLANK = 0.5
"""Powers of the torque that root tension and pressure of a line contact grow with: what is left is interpolated."""
FACTORS = "face_load_factor", "transverse_load_factor", "mesh_load_factor"
OVER_GEARS = "places", "root_places", "largest_root_places"
"""Arrays whose torques are the second axis."""


@dataclass(frozen=True, eq=False)
class SolvedLoads:
    """Load factors and largest local stresses under some torques (c,).

    Attributes
    ----------
    torque : (c,) array [N mm]
        Ascending, of those that were solved.
    face_load_factor : (c,) array
    transverse_load_factor : (c,) array
        Of bevel pairs the largest share of a tooth pair in the load, which K_Halpha follows from by Z_LS.
    mesh_load_factor : (c,) array
        K_gamma.
    pressure : (c,) array [MPa]
        Largest pressure of an elastic line contact over all slices of all contacts, whatever the cap, edges left out:
        strengths of flanks are such pressures.
    places : (2, c, 2) array [mm]
        Radius and axial coordinate of its place, on pinion and wheel; between torques that of the nearest.
    root_tension, root_stress_ratio : (c, 2) array, or None
        Largest tension of a turn [MPa] where the roots of both gears decide, smallest over largest stress there.
    largest_root_tension : (c, 2) array, or None
        Of all places [MPa]: what decides where stress is reversed everywhere alike.
    root_places, largest_root_places : (2, c, 2) array, or None
        Tangent angle [rad] and axial coordinate [mm] of these places, of both gears; those of the nearest.
    mate_stress_ratios : (c, 2) array, or None
        Smallest over largest root stress of a turn of both gears, where other mates add to those of the mesh; NaN:
        none do.
    root_nodes : (c, 2, 3) array of int, or None
        Its side, station and place along the face; likewise.
    excitation : mapping of str to (c,) array
        Mean mesh stiffness [N/(mm um)], span and first order of the transmission error [um].
    """

    torque: Array
    face_load_factor: Array
    transverse_load_factor: Array
    mesh_load_factor: Array
    pressure: Array
    places: Array
    root_tension: Array | None = None
    root_stress_ratio: Array | None = None
    largest_root_tension: Array | None = None
    root_places: Array | None = None
    largest_root_places: Array | None = None
    mate_stress_ratios: Array | None = None
    root_nodes: Indices | None = None
    excitation: dict[str, Array] = field(default_factory=dict)

    @classmethod
    def of_factors(
        cls, torque: Array, face_load_factor: Array, transverse_load_factor: Array, mesh_load_factor: Array
    ) -> SolvedLoads:
        """Load factors alone, with stresses that are not known."""
        unknown, places = np.full(len(torque), nan), np.full((2, len(torque), 2), nan)
        return cls(torque, face_load_factor, transverse_load_factor, mesh_load_factor, unknown, places)

    def at(self, torques: Array) -> SolvedLoads:
        """The same under other torques, none above the largest but by rounding: as solved, or interpolated.

        Factors, and stresses over the power of the torque that they grow with, are monotone cubics (PCHIP) between
        their solved values, logarithms over the logarithm of the torque; below the smallest torque they go on straight,
        above the largest they stay.
        """
        nearest = self.nearest(torques)
        exact = self._of(nearest)
        if np.array_equal(exact.torque, torques):
            return exact
        parts: dict[str, Any] = {name: self._between(getattr(self, name), torques) for name in FACTORS}
        if self.mate_stress_ratios is not None:
            parts["mate_stress_ratios"] = self._straight(self.mate_stress_ratios, torques)
        if self.root_tension is not None and self.root_stress_ratio is not None:
            assert self.largest_root_tension is not None
            parts |= {
                "root_tension": self._between(self.root_tension, torques, OF_ROOT),
                "largest_root_tension": self._between(self.largest_root_tension, torques, OF_ROOT),
                "root_stress_ratio": self._straight(self.root_stress_ratio, torques),
            }
        return replace(
            exact,
            torque=torques,
            pressure=self._between(self.pressure, torques, OF_FLANK),
            excitation={
                name: self._straight(values[:, None], torques)[:, 0] for name, values in self.excitation.items()
            },
            **parts,
        )

    def by_nearest(self, torques: Array) -> SolvedLoads:
        """The same under other torques (c,), each as solved under the nearest one, over the powers of the torque."""
        return SolvedLoads.joined(
            [self._of(row[None]).at(torque[None]) for row, torque in zip(self.nearest(torques), torques, strict=True)]
        )

    @classmethod
    def joined(cls, parts: Sequence[SolvedLoads]) -> SolvedLoads:
        """Loads under the torques of all parts, ascending; a number that a part does not have is left out."""
        order = np.argsort(np.concatenate([part.torque for part in parts]))
        values: dict[str, Any] = {}
        for name in (each.name for each in fields(cls) if each.name != "excitation"):
            columns = [getattr(part, name) for part in parts]
            known = all(column is not None for column in columns)
            values[name] = np.concatenate(columns, axis=int(name in OVER_GEARS)) if known else None
        excitation = {name: np.concatenate([part.excitation[name] for part in parts]) for name in parts[0].excitation}
        return cls(**values, excitation=excitation)._of(order)

    def every_second(self, first: int = 0) -> SolvedLoads:
        """The same with every second torque left out, from the ``first`` on, but for the last."""
        places = np.unique([*range(first, len(self.torque), 2), len(self.torque) - 1])
        return self._of(places)

    def nearest(self, torques: Array) -> Indices:
        """Index of the solved torque next to each: places under others are those under this one."""
        return np.abs(self.torque[:, None] - torques).argmin(axis=0)

    def _of(self, some: Indices) -> SolvedLoads:
        """As solved under some of the torques, by index."""
        values: dict[str, Any] = {each.name: getattr(self, each.name) for each in fields(self)}
        excitation = {name: numbers[some] for name, numbers in values.pop("excitation").items()}
        chosen: dict[str, Any] = {
            name: None if numbers is None else numbers[:, some] if name in OVER_GEARS else numbers[some]
            for name, numbers in values.items()
        }
        return SolvedLoads(**chosen, excitation=excitation)

    def _between(self, values: Array, torques: Array, power: float = 0.0) -> Array:
        """Positive values (n, ...) that grow about as a power of the torque, under others (c, ...); NaN if any is."""
        if not np.isfinite(values).all():
            return np.full((len(torques), *values.shape[1:]), nan)
        shape = -1, *[1] * (values.ndim - 1)
        nodes, wanted = np.log(self.torque), np.log(torques)
        rest = np.log(values) - power * nodes.reshape(shape)
        inside = np.clip(wanted, nodes[0], nodes[-1])
        if len(nodes) == 1:
            logarithms = np.broadcast_to(rest, (len(torques), *values.shape[1:]))
        else:
            from scipy.interpolate import PchipInterpolator

            logarithms = PchipInterpolator(nodes, rest)(inside)
            slope = (rest[1] - rest[0]) / (nodes[1] - nodes[0])
            logarithms = logarithms + slope * np.minimum(wanted - nodes[0], 0.0).reshape(shape)
        return np.asarray(np.exp(logarithms + power * wanted.reshape(shape)))

    def _straight(self, values: Array, torques: Array) -> Array:
        """Values (n, gear) of any sign, straight over the logarithm of the torque."""
        nodes, wanted = np.log(self.torque), np.log(torques)
        return np.stack([np.interp(wanted, nodes, column) for column in values.T], axis=-1)


def solved_factors(result: CycleNumbers, duty: Duty) -> SolvedLoads:
    """Load factors of a result under its torques; of bevel pairs the largest share in place of K_Halpha."""
    of_bevel, torque = isinstance(result.scene, SpiralScene), np.asarray(result.torque)
    transverse = np.nanmax(result.load_share, axis=(1, 2)) if of_bevel else np.asarray(result.transverse_load_factor)
    factors = np.asarray(result.face_load_factor), transverse, duty.mesh_load_factor * np.ones(len(torque))
    of_mates = [np.full(len(torque), nan) if one is None else one for one in duty.stress_ratios]
    return replace(SolvedLoads.of_factors(torque, *factors), mate_stress_ratios=np.stack(of_mates, axis=-1))


def solved_loads(inputs: CommonInputs) -> SolvedLoads:
    """Loads of a result under the torques that it was solved for, each once, ascending; ``inputs`` have the factors."""
    result = inputs.result
    _, order = np.unique(np.asarray(result.torque), return_index=True)
    largest = largest_pressures(result)
    whole = replace(
        inputs.solved,
        pressure=largest.pressure,
        places=np.stack([largest.radius.T, largest.axial.T]),
        excitation=_excitation(result),
    )
    if inputs.scene.analysis.root_stress:
        alone = replace(inputs, cases=inputs.cases.alone(np.asarray(result.torque)))
        pinion, wheel = (deciding_places(alone, gear) for gear in range(len(GEARS)))
        whole = replace(
            whole,
            root_tension=np.stack([pinion.tension, wheel.tension], axis=-1),
            root_stress_ratio=np.stack([pinion.ratio, wheel.ratio], axis=-1),
            largest_root_tension=np.nanmax(result.root_tension, axis=1),
            root_places=np.array([[pinion.tangent_angle, wheel.tangent_angle], [pinion.axial, wheel.axial]]).swapaxes(
                1, 2
            ),
            largest_root_places=np.array([largest_places(alone, gear) for gear in range(len(GEARS))]).transpose(
                1, 2, 0
            ),
            root_nodes=np.stack([pinion.node, wheel.node], axis=1),
        )
    return whole._of(order)


def _excitation(result: CycleNumbers) -> dict[str, Array]:
    """Mean mesh stiffness [N/(mm um)], span and first order of the transmission error [um] (t,), by their names."""
    spans = [span_of(error, result.places_of_mesh) for error in result.transmission_error]
    return {
        "mesh_stiffness": np.array([mean_over_a_pitch(each) for each in result.mesh_stiffness]),
        "transmission_error_span": result.um_per_rad * np.array(spans),
        "transmission_error_order_1": result.um_per_rad * result.harmonics(1)[:, 0],
    }
