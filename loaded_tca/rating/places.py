"""Local safeties at every place: of the slices of all contacts on the flanks, and over the fillets of the roots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array, Indices, Mask, index_checks
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.rating.roots import local_root_factors, pressed_by_others, stress_ratio
from loaded_tca.tribology.slices import slices_of

if TYPE_CHECKING:
    from loaded_tca.rating.rating import Rating


@dataclass(frozen=True, eq=False)
class FlankSafeties:
    """Local safety against pitting of all slices of all contacts under one torque, in one case.

    Attributes
    ----------
    safety : (2, n) array
        Of pinion and wheel: sigma_HG over the pressure of a line contact times the root of K_A K_gamma K_v. Between
        torques that were analysed, all pressures are those under the nearest one, times one factor: that between the
        largest pressures, of which the one of the case is interpolated.
    point, tangent : (n, 3) array [mm]
        Middles of the slices in the fixed frame, and half their length.
    radius, axial : (2, n) array [mm]
        Middles on pinion and wheel.
    position, column : (n,) int array
        Indices of position and tooth pair: slices of one contact follow each other along it.
    """

    safety: Array
    point: Array
    tangent: Array
    radius: Array
    axial: Array
    position: Indices
    column: Indices

    def deciding(self, gear: int) -> int:
        """Index of the slice with the smallest safety of a gear."""
        return int(np.nanargmin(self.safety[gear]))


@dataclass(frozen=True, eq=False)
class RootSafeties:
    """Local safety against tooth breakage over fillet and face of one gear, both sides of a tooth, in one case.

    Attributes
    ----------
    safety : (2, stations, p) array
        sigma_FG over the largest stress of a turn times K_A K_gamma K_v, with Y_M of the extremes of each place, and
        with what the parabola through the largest tension exceeds the places; inf where no tension is. First the side
        in contact, then the back. Between torques that were analysed, all stresses are those under the nearest one,
        times the factor between the tensions of the place that decides, and all stress ratios differ as there.
    tangent_angle : (2, stations, p) array [rad]
        Of the fillet to the middle of the tooth.
    axial : (2, stations, p) array [mm]
        On the gear itself.
    """

    safety: Array
    tangent_angle: Array
    axial: Array

    def deciding(self) -> tuple[int, int, int]:
        """Side, station and place along the face of the smallest safety."""
        side, station, along = np.unravel_index(int(np.nanargmin(self.safety)), self.safety.shape)
        return int(side), int(station), int(along)

    def over_face(self) -> tuple[Array, Array]:
        """Axial places [mm] and the smallest safety over both fillets at each."""
        return self.axial[0, self.axial.shape[1] // 2], np.nanmin(self.safety, axis=(0, 1))


@checked
def flank_safeties(rating: Rating, case: int) -> FlankSafeties:
    """Local safety against pitting at every slice.

    Parameters
    ----------
    rating : Rating
    case : int
        Index of the case.

    Returns
    -------
    FlankSafeties
        Of slices whose pressure is known; their smallest safeties are ``rating.local_flank_safety``.

    Raises
    ------
    InputError
        If the rating has no such case, or the case no places: an idle or a reversed bin, or a half whose mesh cycle
        is that of another torque.
    """
    require(*index_checks(case=(case, len(rating.torque))))
    sweep, inputs = slices_of(rating.result), rating.inputs
    some, solved = sweep.known_of_torque(torque_of(rating, case)), inputs.solved
    load = rating.K_A[case] * rating.K_gamma[case] * rating.K_v[case]
    ratio = inputs.loads.pressure[case] / solved.pressure[nearest_torque(rating, case)]
    stress = sweep.elastic_pressure[some] * ratio * np.sqrt(load)
    return FlankSafeties(
        rating.sigma_HG[case][:, None] / stress,
        sweep.point[some],
        sweep.tangent[some],
        np.stack([sweep.radius[some], sweep.wheel_radius[some]]),
        np.stack([sweep.axial[some], sweep.wheel_axial[some]]),
        sweep.position[some],
        sweep.column[some],
    )


@checked
def root_safeties(rating: Rating, case: int, gear: int) -> RootSafeties:
    """Local safety against tooth breakage over fillet and face.

    Parameters
    ----------
    rating : Rating
        Of a result with root stress.
    case : int
        Index of the case.
    gear : int
        0 the pinion, 1 the wheel.

    Returns
    -------
    RootSafeties
        Its smallest is ``rating.local_root_safety``.

    Raises
    ------
    InputError
        If the rating has no such case or gear, or the case no places.
    NotAskedError
        If the scene does not ask for root stress.
    """
    require(*index_checks(case=(case, len(rating.torque)), gear=(gear, len(GEARS))))
    torque, stress = torque_of(rating, case), rating.result.root_stress[gear]
    largest, smallest = stress.largest[torque], stress.smallest[torque]
    tense = largest > 0.0
    above = np.nanmax(rating.result.root_tension[torque, :, gear]) / np.nanmax(largest)
    factor, change = _between_torques(rating, case, gear)
    load = factor * above * rating.K_A[case] * rating.K_gamma[case] * rating.K_v[case]
    _, factors, _ = local_root_factors(rating.inputs, gear, stress_ratio(largest, smallest) + change, case)
    strength = np.broadcast_to(factors.strength, largest.shape)
    safety = np.full(largest.shape, np.inf)
    np.divide(strength, largest * load, out=safety, where=tense)
    return RootSafeties(np.where(np.isnan(largest), np.nan, safety), stress.tangent_angle, stress.point[..., 2])


def _between_torques(rating: Rating, case: int, gear: int) -> tuple[float, float]:
    """Tension in a case over that under the nearest analysed torque, where it decides, and how R differs there."""
    loads, solved, near = rating.inputs.loads, rating.inputs.solved, nearest_torque(rating, case)
    by_others = pressed_by_others(rating.inputs, gear)[case]
    tension, analysed = (each.largest_root_tension if by_others else each.root_tension for each in (loads, solved))
    assert tension is not None  # asked before
    assert analysed is not None
    assert loads.root_stress_ratio is not None
    assert solved.root_stress_ratio is not None
    change = loads.root_stress_ratio[case, gear] - solved.root_stress_ratio[near, gear]
    return float(tension[case, gear] / analysed[near, gear]), float(change)


def is_shown(rating: Rating) -> Mask:
    """Whether each case (c,) has places: one that loads the analysed flanks, and of parts of a duty this result."""
    cases, shown = rating.inputs.cases, rating.torque > 0.0
    if parts := rating.inputs.duty.parts:
        of_result = [torques for part, torques in parts if part is rating.result]
        shown &= np.isin(rating.torque, np.concatenate([*of_result, np.zeros(0)]))
        shown &= np.isin(rating.torque, rating.result.torque)
    return np.asarray(shown & ~cases.reversed)


def worst_case(rating: Rating, name: str) -> tuple[int, str]:
    """Index of the case that decides by a safety, among those that have places, and why that one, in words.

    That is the bin of the largest damage, or where none does any, and without a spectrum, that of the smallest safety.
    """
    shown = is_shown(rating)
    safety = np.where(shown, rating.values(name).min(axis=1), np.inf)
    if not rating.inputs.cases.is_spectrum:
        return int(safety.argmin()), ""
    among = "drive-side bins" if rating.inputs.cases.reversed.any() else "bins"
    among += " with a mesh cycle here" if rating.inputs.duty.parts else ""
    damage = np.nan_to_num(rating.damage[..., rating.modes.index(name.removesuffix("_safety"))]).max(axis=1)
    if (damage[shown] > 0.0).any():
        return int(np.where(shown, damage, -1.0).argmax()), f"largest damage of {among}"
    return int(safety.argmin()), f"smallest safety of {among}, which do no damage"


def nearest_torque(rating: Rating, case: int) -> int:
    """Index of the solved torque next to that of a case."""
    return int(rating.inputs.solved.nearest(rating.inputs.cases.factor_torque[case : case + 1])[0])


def torque_of(rating: Rating, case: int) -> int:
    """Index, in its result, of the analysed torque whose places a case has."""
    torque, cases = 1e-3 * float(rating.torque[case]), rating.inputs.cases
    words = "is idle" if torque == 0.0 else "is reversed" if cases.reversed[case] else "is not analysed in this result"
    require((bool(is_shown(rating)[case]), f"case: {case}, {plain(torque, 6)} N m, {words}"))
    analysed = rating.inputs.solved.torque[nearest_torque(rating, case)]
    return int(np.abs(rating.result.torque - analysed).argmin())
