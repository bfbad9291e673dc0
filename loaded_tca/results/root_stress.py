"""Root stress of both gears over the mesh cycle: its extremes, and where along fillets and faces they lie.

Normal forces of all slices of the pressure maps load the models of :mod:`loaded_tca.compliance.root_stress`; loads of
all tooth pairs add up at the root of each tooth. All that stands in a result is found from its maps.

Key figures of root stress, beside those of ISO 6336-3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.compliance as compliance
from loaded_tca.arrays import GEARS, Array, Indices
from loaded_tca.reference.iso6336_3 import (
    THINNEST_RIM,
    THINNEST_RING,
    face_load_factor,
    rim_thickness_factor,
    ring_rim_factor,
)
from loaded_tca.results.quantities import ON_FILLETS, PLACE, ROOT_QUANTITIES
from loaded_tca.threads import one_blas_thread

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from loaded_tca.compliance import FlankLine, RootStress
    from loaded_tca.loaded.loaded_grid import LoadedGrid
    from loaded_tca.pairs.gear import Gear
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.results.pressure_map import Maps, PressureMap

STATES_AT_A_TIME = 32
"""Positions whose stress is held in memory at once, 10 to 20 MB of each tooth."""


@dataclass(frozen=True, eq=False)
class RootStressMap:
    """Root stress of one gear over fillet and face, for both sides of a tooth, the one in contact first.

    Attributes
    ----------
    tangent_angle : (2, stations, p) array [rad]
        Between the fillet and the middle of the tooth.
    point : (2, stations, p, 3) array [mm]
        Places in the frame of the tooth, whose third coordinate is the gear's own z.
    at_tension : (torque, 2, stations, p) array [MPa]
        Of the tooth with the largest tension, at the position where it has it.
    largest, smallest : (torque, 2, stations, p) array [MPa]
        Envelopes: extremes that a tooth sees in its whole turn. Out of mesh it has no stress.
    """

    tangent_angle: Array
    point: Array
    at_tension: Array
    largest: Array
    smallest: Array


def root_stress_maps(result: CycleNumbers) -> tuple[RootStressMap, RootStressMap]:
    """Root stress of pinion and wheel over fillet and face; NotAskedError of a result that has none."""
    pinion, wheel = (RootStressMap(*(getattr(result, f"{gear}_{name}") for name in ON_FILLETS)) for gear in GEARS)
    return pinion, wheel


def root_stress_arrays(
    pair: GearPair,
    models: Sequence[RootStress],
    numbers: Sequence[int],
    known: NDArray[np.bool_],
    maps: Maps,
    moved: Sequence[GearPair] = (),
) -> dict[str, Array]:
    """Arrays of ``ROOT_PARTS`` of what the tooth pairs carry.

    Parameters
    ----------
    pair : GearPair
    models : (RootStress, RootStress)
        Of pinion and wheel.
    numbers : sequence of int
        Of the tooth pairs.
    known : (torque, position) bool array
        Where a tooth pair is in contact; elsewhere all is NaN.
    maps : Maps
    moved : sequence of GearPair
        The gears as they stand under each torque, where they move; default: as in ``pair``.
    """
    with one_blas_thread():  # the matrices are small: threads waiting for each other cost more
        by_gear = [
            root_stress_of_gear(pair, gear, model, numbers, known, maps, moved) for gear, model in enumerate(models)
        ]
    arrays = {name: np.stack([one[name] for one in by_gear], axis=-1) for name in ROOT_QUANTITIES if name in by_gear[0]}
    for name in ("root_tension_place", "root_compression_place"):
        arrays[name] = np.moveaxis(arrays[name], -1, -2)
    return arrays | {
        f"{gear}_{name}": one[name] for gear, one in zip(GEARS, by_gear, strict=True) for name in ON_FILLETS
    }


def root_stress_of_gear(
    pair: GearPair,
    gear: int,
    model: RootStress,
    numbers: Sequence[int],
    known: NDArray[np.bool_],
    maps: Maps,
    moved: Sequence[GearPair] = (),
) -> dict[str, Array]:
    """Arrays of one gear: those of :func:`root_stress_arrays` without the axis of the gears."""
    fillets = model.tangent_angle.shape
    extreme = {sign: np.where(known, 0.0, math.nan) for sign in (1, -1)}  # magnitudes of tension and compression
    place = {sign: np.full((*known.shape, len(PLACE)), -1) for sign in extreme}
    blank = np.where(known.any(axis=1), 0.0, math.nan)[:, None, None, None]
    at_tension, largest, smallest = blank + np.zeros((3, len(known), *fillets))
    for t, positions, tooth, stress in _stresses(moved or [pair] * len(maps), gear, model, numbers, maps):
        largest[t] = np.maximum(largest[t], stress.max(axis=0))
        smallest[t] = np.minimum(smallest[t], stress.min(axis=0))
        for sign, so_far in extreme.items():
            signed = sign * stress
            where = np.stack(np.unravel_index(signed.reshape(len(stress), -1).argmax(axis=-1), fillets), axis=-1)
            value = np.array([_top(*one) for one in zip(signed, where, strict=True)])
            if sign > 0 and value.max() > np.nanmax(so_far[t]):
                at_tension[t] = stress[value.argmax()]
            more = value > so_far[t, positions]
            chosen = positions[more]
            so_far[t, chosen] = value[more]
            place[sign][t, chosen, 0] = tooth
            place[sign][t, chosen, 1:] = where[more]
    on_fillets = model.tangent_angle, model.point, at_tension, largest, smallest
    arrays = dict(zip(ON_FILLETS, on_fillets, strict=True))
    for sign, name in ((1, "root_tension"), (-1, "root_compression")):
        there, stressed = tuple(np.moveaxis(place[sign], -1, 0)[1:]), extreme[sign] > 0.0
        arrays[name] = sign * extreme[sign] + 0.0
        arrays[f"{name}_angle"] = np.where(stressed, model.tangent_angle[there], math.nan)
        arrays[f"{name}_axial"] = np.where(stressed, model.point[(*there, 2)], math.nan)
        arrays[f"{name}_place"] = place[sign]
    return arrays | {"root_stress_ratio": _ratio(arrays["root_stress_largest"], arrays["root_stress_smallest"])}


def _stresses(
    pairs: Sequence[GearPair], gear: int, model: RootStress, numbers: Sequence[int], maps: Maps
) -> Iterator[tuple[int, Indices, int, Array]]:
    """Torque, positions (n,) under load, tooth, and its stress there (n, 2, stations, p), for every tooth with any."""
    for t, (pair, rows) in enumerate(zip(pairs, maps, strict=True)):
        loaded = np.array([n for n, row in enumerate(rows) if any(row)], dtype=int)
        for first in range(0, len(loaded), STATES_AT_A_TIME):
            positions = loaded[first : first + STATES_AT_A_TIME]
            loads = list(_loads(pair, gear, model, numbers, [rows[n] for n in positions]))
            teeth = [tooth for tooth, *_ in loads]
            count = min(np.ptp(teeth) + 1 + 2 * model.neighbours, pair.teeth[gear])
            for tooth in range(min(teeth) - model.neighbours, min(teeth) - model.neighbours + count):
                yield t, positions, tooth, model.stresses(tooth, loads)


def _loads(
    pair: GearPair, gear: int, model: RootStress, numbers: Sequence[int], rows: Sequence[Sequence[PressureMap | None]]
) -> Iterator[tuple[int, Array, Array]]:
    """Loaded teeth, and forces at the places of the model's table (states, ...) that stand for those of the maps."""
    for k, number in enumerate(numbers):
        both: list[Array] = []
        for state, row in enumerate(rows):
            if (one := row[k]) is not None:
                line = compliance.flank_lines(pair, number, one)[gear]
                forces = model.forces_of_table(line, one.slice_force)
                both = both or [np.zeros((len(rows), len(force))) for force in forces]
                both[0][state], both[1][state] = forces
        if both:
            yield line.tooth, both[0], both[1]


def stress_at_extreme(
    pair: GearPair,
    gear: int,
    model: RootStress,
    grids: Sequence[LoadedGrid],
    place: Sequence[int],
    *,
    at_node: bool = False,
) -> tuple[list[tuple[FlankLine, Array]], Callable[[FlankLine], Array]]:
    """Loads of a gear at one position, and how the stress about an extreme follows from forces.

    Through the stress about the place go parabolas along the fillet and along the face; by what their tops exceed it
    counts, so that the stress is smooth as the extreme moves.

    Parameters
    ----------
    pair : GearPair
    gear : int
        0 the pinion, 1 the wheel.
    model : RootStress
        Of that gear.
    grids : sequence of LoadedGrid
        Of the tooth pairs under which the extreme lies there.
    place : sequence of int
        As of ``root_tension_place``: tooth, side, station, along the face.
    at_node : bool
        Whether the stress at the place itself is meant, without parabolas.

    Returns
    -------
    list of (FlankLine, (m,) array [N])
        Line of each grid on its flank, and the forces there.
    callable
        Of any line: the stress per force on it (m,) [MPa/N].
    """
    loads = [(compliance.flank_lines(pair, grid.number, grid.separation)[gear], grid.slice_force) for grid in grids]
    tooth, side, *middle = place
    near = _next_to(middle, model.tangent_angle.shape[1:])
    stress = sum(model.per_force(tooth, line, side, *near) @ forces for line, forces in loads)
    weights = _weights_of_top(np.abs(stress))
    if at_node:
        weights = np.zeros(weights.shape)
        weights[tuple(int(np.flatnonzero(beside == at)[0]) for beside, at in zip(near, middle, strict=True))] = 1.0
    return loads, lambda line: np.tensordot(weights, model.per_force(tooth, line, side, *near), 2)


def _next_to(place: Sequence[int], shape: tuple[int, ...]) -> list[Indices]:
    """Indices along each axis of a place and those beside it, as far as there are any."""
    return [np.arange(max(at - 1, 0), min(at + 2, count)) for at, count in zip(place, shape, strict=True)]


def _weights_of_top(values: Array) -> Array:
    """Weights of values about their largest one (up to 3, up to 3) in the sum of it and of what parabolas exceed it."""
    from loaded_tca.contact.patch import top_weights  # transforms, which an overview needs not

    at, across = np.unravel_index(int(values.argmax()), values.shape)
    weights = np.zeros(values.shape)
    weights[at, across] = -1.0
    for through, own in ((values[:, across], weights[:, across]), (values[at], weights[at])):
        own += top_weights(through) if through.size == 3 else np.eye(through.size)[through.argmax()]
    return weights


def _top(values: Array, place: Sequence[int]) -> float:
    """Top of values (2, stations, p) about their largest one."""
    side, *middle = place
    near = values[side][np.ix_(*_next_to(middle, values.shape[1:]))]
    return float((_weights_of_top(near) * near).sum())


def _ratio(largest: Array, smallest: Array) -> Array:
    """Smallest over largest stress (torque,) at the place of the largest tension of envelopes (torque, ...)."""
    high, low = (envelope.reshape(len(envelope), -1) for envelope in (largest, smallest))
    place = np.arange(len(high)), np.where(np.isnan(high), 0.0, high).argmax(axis=-1)
    return np.divide(low[place], high[place], out=np.full(len(high), math.nan), where=high[place] > 0.0)


FACTORS = "form", "stress_correction", "helix_angle"
"""Of ISO 6336-3, as their key figures are named."""
RIM_LABEL = "    Y_B of thin rims, not in it: pinion | wheel"


def root_figures(result: CycleNumbers, torque: int) -> dict[str, float]:
    """Return the figures of root stress under one torque, by names that end in their unit; NaN: not known.

    Parameters
    ----------
    result : MeshCycle
        Of a scene that asks for root stress.
    torque : int
        Index of the torque.
    """
    figures: dict[str, float] = {}
    nominal = [float(result.torque[torque]) * per_torque for per_torque in result.scene.nominal_root_stress]
    ratio, factor = result.scene.tooth_height_over_width, float(result.face_load_factor[torque])
    of_roots = math.nan if math.isnan(ratio + factor) else float(face_load_factor(max(1.0, factor), ratio))
    gears = result.gear_pair.pinion, result.gear_pair.wheel
    for gear, name in enumerate(GEARS):
        rim = math.nan if math.isnan(ratio) else rim_factor(gears[gear], result.gear_pair.module)
        figures[f"{name}_rim_thickness_factor_iso_6336"] = rim
        figures |= _extreme(result, torque, gear, "root_tension") | _extreme(result, torque, gear, "root_compression")
        figures[f"{name}_root_stress_ratio"] = float(result.root_stress_ratio[torque, gear])
        figures[f"{name}_nominal_root_stress_iso_6336_MPa"] = nominal[gear]
        factors = zip(FACTORS, result.scene.root_factors[gear], strict=True)
        figures |= {f"{name}_{what}_factor_iso_6336": value for what, value in factors}
        figures[f"{name}_root_stress_iso_6336_MPa"] = nominal[gear] * of_roots
    return figures | {"root_face_load_factor_iso_6336": of_roots}


def rim_factor(gear: Gear, normal_module: float) -> float:
    """Rim thickness factor Y_B of a gear with a bore, given or by default; NaN for a rim too thin for the standard."""
    if gear.is_ring:
        rim = gear.rim_thickness / normal_module
        return ring_rim_factor(rim) if rim > THINNEST_RING else math.nan
    rim = gear.rim_over_height
    return rim_thickness_factor(rim) if rim > THINNEST_RIM else math.nan


def _extreme(result: CycleNumbers, torque: int, gear: int, name: str) -> dict[str, float]:
    """Largest tension or compression of a gear over the positions, and where it is."""
    stress, figure = getattr(result, name)[torque, :, gear], f"{GEARS[gear]}_{name}"
    position = int(np.where(np.isnan(stress), -1.0, np.abs(stress)).argmax())

    def there(part: str) -> float:
        return float(getattr(result, f"{name}{part}")[torque, position, gear])

    place = getattr(result, f"{name}_place")[torque, position, gear]
    stressed = bool(abs(stress[position]) > 0.0)
    return {
        f"{figure}_MPa": there(""),
        f"pinion_angle_at_{figure}_deg": math.degrees(result.pinion_angle[position]) if stressed else math.nan,
        f"{figure}_angle_deg": math.degrees(there("_angle")),
        f"{figure}_axial_mm": there("_axial"),
        f"{figure}_on_back": bool(place[PLACE.index("side")] == 1),
    }
