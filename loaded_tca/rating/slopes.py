r"""Derivatives of safeties, damage and lives to keys of the scene, by the chain rule.

Of what a rating takes of the analysis, K_Hbeta, the pressure p of the slice and the tension of the root that decide,
derivatives follow from the solved contact problem, under each torque that was solved. All else is a closed form of
these, of the key and of the torque: load factors, nominal stresses, strengths, under a load spectrum the stresses
between the torques, Miner sums, lives, and the safety at which the sum is 1. It is evaluated twice, to both sides of
the key with what the analysis gives moved along its derivatives, so that the difference is the total derivative. With
factors that are given, under torques that stand for themselves,

.. math::
    \frac{d \ln S_H}{da} = -\tfrac12\,\frac{d \ln K_{H\beta}}{da},\qquad
    \frac{d \ln S_F}{da} = -\frac{d \ln K_{F\beta}}{da},\qquad
    \frac{d \ln S_{H,local}}{da} = -\frac{d \ln p}{da},\qquad
    \frac{d \ln S_{F,local}}{da} = -\frac{d \ln \sigma}{da}

and of a spectrum with the damage :math:`D_i(S \sigma_i)` of its bins, whose sum is 1 at the safety S,

.. math::
    \frac{d \ln S}{da} = -\frac{\sum_i D_i'\, \sigma_i\, d \ln \sigma_i/da}{\sum_i D_i'\, \sigma_i} .

Held are the slice, the root's place and its stress ratio, and K_Halpha of the analysis of cylindrical pairs; that of
bevel pairs follows the largest share of a tooth pair.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError, give_accuracy_warning
from loaded_tca.rating.call import numbers_of
from loaded_tca.rating.inputs import RatingInputs
from loaded_tca.results.derivatives import JoinedSensitivities
from loaded_tca.results.face_slopes import AS_LARGE, TOLD
from loaded_tca.results.gap_growth import curvature_growth
from loaded_tca.results.sensitivities import NEWTON_MILLIMETRES, TORQUE, Sensitivities
from loaded_tca.results.slice_pressure import largest_slice_pressures
from loaded_tca.results.warnings import warn_of_contacts
from loaded_tca.scene.rating import ANALYSIS
from loaded_tca.separation.pair_change import value_at
from loaded_tca.tribology.contact_slices import largest_pressures
from loaded_tca.units import ending_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray

    from loaded_tca.rating.inputs import CommonInputs
    from loaded_tca.rating.rating import Rating
    from loaded_tca.rating.solved import SolvedLoads

STEP = 1e-4
"""Of a key, over its value or its unit: closed forms are smooth, so that their differences have eight digits."""
ALIKE = 0.03
"""Part by which the largest stress of the next contact is less, up to which derivatives there are found, too: of a
helical pair 1.1 % are left by 0.4 um of profile crowning, beyond which they are some 29 times as large."""
NEAR = {"um": 1.0, "mm": 0.01, "deg": 0.005}
"""Changes of a key that any gear has, by its unit: beyond 1 % contacts are told that are reached by these."""
AT_ONCE = 1e-3
"""Of the tension at a place: what it is less where it has its largest at another position."""
SAFETIES = "flank_safety", "root_safety", "local_flank_safety", "local_root_safety"
DIFFERENTIATED = *SAFETIES, "damage", "life_hours", "miner_sum", "spectrum_safety"


def rating_slopes(rating: Rating, sensitivities: Sensitivities) -> xarray.Dataset:
    """Derivatives of the numbers of a rating by those of its result, see ``Rating.sensitivities``."""
    import xarray

    inputs, keys = rating.inputs, sensitivities.keys
    growth = _growth(inputs, sensitivities)
    held = isinstance(inputs, RatingInputs) and inputs.rating.transverse_load_factor == ANALYSIS
    if held and (rating.K_Halpha == inputs.loads.transverse_load_factor).any():  # not at a bound of the standard
        give_accuracy_warning(kinds.TRANSVERSE_HELD.sentence())
    columns = []
    for number, key in enumerate(keys):
        part = {name: slopes[..., number] for name, slopes in growth.items()}
        sides = [_at(inputs, key, sign, part) for sign in (1.0, -1.0)]
        columns.append({name: _difference(name, sides) for name in DIFFERENTIATED if rating.has(name)})
    arrays = {
        name: ((*rating.NUMBERS[name].dims, "key"), np.stack([column[name] for column in columns], axis=-1))
        for name in columns[0]
    }
    coordinates = {"torque": ("case", rating.torque), "gear": [*GEARS], "mode": [*rating.modes], "key": [*keys]}
    return xarray.Dataset(arrays, coordinates)


def _growth(inputs: CommonInputs, sensitivities: Sensitivities) -> dict[str, Array]:
    """Derivatives of the arrays of ``SolvedLoads`` (t, [gear,] keys), under the torques that it has, by their names."""
    solved, result = inputs.solved, inputs.result
    rows = [int(np.flatnonzero(np.asarray(result.torque) == torque)[0]) for torque in solved.torque]
    growth = {"torque": np.array([[NEWTON_MILLIMETRES * (key == TORQUE) for key in sensitivities.keys]] * len(rows))}
    growth["pressure"] = solved.pressure[:, None] * _pressure_slopes(sensitivities)[rows]
    if inputs.rating.face_load_factor == ANALYSIS:
        above = solved.face_load_factor[:, None] > 1.0
        growth["face_load_factor"] = np.where(above, sensitivities.face_load_factor[rows], 0.0)
    if inputs.rating.transverse_load_factor == ANALYSIS and not isinstance(inputs, RatingInputs):
        growth["transverse_load_factor"] = _share_slopes(sensitivities)[rows]
    if solved.root_tension is not None:
        assert solved.largest_root_tension is not None
        relative = _tension_slopes(sensitivities)[rows]
        there = relative + _beside_largest(solved, sensitivities, rows)
        growth["root_tension"] = solved.root_tension[..., None] * there
        growth["largest_root_tension"] = solved.largest_root_tension[..., None] * relative
    return growth


def _share_slopes(sensitivities: Sensitivities) -> Array:
    """Derivatives (t, keys) of the largest share of a tooth pair in the load, at the position that has it."""
    shares, slopes = np.nan_to_num(sensitivities.result.load_share), sensitivities.load_share
    flat = shares.reshape(len(shares), -1).argmax(axis=1)
    return np.nan_to_num(slopes.reshape(len(slopes), -1, slopes.shape[-1])[np.arange(len(flat)), flat])


def _at(inputs: CommonInputs, key: str, sign: float, growth: dict[str, Array]) -> tuple[dict[str, Array], float]:
    """Numbers of the rating with a key moved to one side, and how far; ``growth``: derivatives of the solved loads."""
    scene: Any = inputs.scene
    value = 1e-3 * float(inputs.torque.max()) if key == TORQUE else value_at(scene, key)
    step = sign * STEP * (abs(value) or 1.0)
    if key != TORQUE:
        try:
            scene = scene.with_changes({key: value + step})
        except InputError:  # the end of its range: the difference is that to the other side
            step = 0.0
    moved: Any = {name: getattr(inputs.solved, name) + step * slopes for name, slopes in growth.items()}
    cases = inputs.cases
    if key == TORQUE:
        cases = replace(cases, torque=cases.torque + NEWTON_MILLIMETRES * step)
    numbers, _, _ = numbers_of(inputs.of_scene(scene, cases=cases, solved=replace(inputs.solved, **moved)))
    return numbers, step


def _difference(name: str, sides: Sequence[tuple[dict[str, Array], float]]) -> Array:
    """Derivative of a number by its values on both sides of a key; NaN where one is not finite."""
    (above, over), (below, under) = ((numbers[name], step) for numbers, step in sides)
    finite = np.isfinite(above) & np.isfinite(below)
    return np.where(finite, (np.where(finite, above, 0.0) - np.where(finite, below, 0.0)) / (over - under), np.nan)


def _under(sensitivities: Sensitivities, torque: int) -> tuple[Sensitivities, int]:
    """Derivatives under one torque, and its index among theirs: gears on supports stand elsewhere under each."""
    if isinstance(sensitivities, JoinedSensitivities):
        part = sensitivities.parts[torque]
        assert part is not None  # ratings refuse torques that load nothing
        return part, 0
    return sensitivities, torque


def _pressure_slopes(sensitivities: Sensitivities) -> Array:
    """Relative derivatives (t, keys) of the pressure of the slice that decides, which stays where it is."""
    result = sensitivities.result
    largest, count = largest_pressures(result), len(result.torque)
    slopes = np.zeros((2, count, len(sensitivities.keys)))
    deciding = np.zeros(result.load_share.shape, dtype=bool)
    deciding[np.arange(count), largest.position[0], largest.column[0]] = True
    for torque in range(count):
        under, row = _under(sensitivities, torque)
        for number in range(2 if largest.lacking[torque] < ALIKE else 1):
            place = row, int(largest.position[number, torque]), int(largest.column[number, torque])
            slopes[number:, torque] = _of_contact(under, place)
    _warn_of_kinks("local safety of flanks", sensitivities.keys, slopes, largest.lacking)
    if any(key != TORQUE for key in sensitivities.keys):
        marks = {
            kinds.PEAK_SLOPES: sensitivities.at_corners,
            kinds.PEAK_BESIDE_JUMP: sensitivities.beside_curvature_jumps,
        }
        for kind, places in marks.items():
            warn_of_contacts(result, kind.sentence(), places & deciding)
    return slopes[0]


def _warn_of_kinks(figure: str, keys: Sequence[str], slopes: Array, lacking: Array) -> None:
    """Tell where derivatives of the contact that decides, and of the next one (2, n, keys), differ; NaN: not known."""
    first, second = np.nan_to_num(slopes)
    largest = np.maximum(np.abs(first), np.abs(second)).clip(min=np.finfo(float).tiny)
    apart, short = np.abs(second - first), lacking.reshape(-1, 1)
    near = np.array([NEAR.get(ending_of(key), 0.0) for key in keys])
    sizes = np.where((short < AS_LARGE) | (short < near * apart), apart / largest, 0.0).max(axis=0)
    if (sizes > TOLD).any():
        worst = int(sizes.argmax())
        words = {"key": keys[worst], "count": np.count_nonzero(sizes > TOLD), "keys": len(keys)}
        sentence = kinds.CONTACTS_ALIKE.sentence(figure=figure, lacking=lacking.min(), size=sizes[worst], **words)
        give_accuracy_warning(sentence)


def _of_contact(under: Sensitivities, place: tuple[int, int, int]) -> Array:
    """Relative derivatives (keys,) of the largest slice pressure of the contact of a state and tooth pair."""
    tangents, pair = under.tangents, under.result.gear_pair
    state_of = under.places[:, tangents.state]
    (here,) = np.flatnonzero((state_of[0] == place[0]) & (state_of[1] == place[1]) & (under.pairs == place[2]))
    number = int(here)
    grid = tangents.grids[number]
    (peak,) = largest_slice_pressures(pair, [(grid.contact, grid.separation, grid.pressure)])
    row = tangents.gathered(
        np.broadcast_to(peak.slopes if k == number else 0.0, one.active.shape) for k, one in enumerate(tangents.grids)
    )
    change = tangents.functional_change(row, under.growth.gaps, under.torques)[:, tangents.state[number]]
    if not peak.slopes.any():  # at the cap, where the derivatives of the line load are not those of the pressure
        return np.full(len(under.keys), np.nan)
    curvature = curvature_growth(pair, [grid], [peak], under.changes, under.growth.of_grids([number]))[:, 0]
    return np.asarray(change / peak.pressure + 0.5 * curvature)


def _tension_slopes(sensitivities: Sensitivities) -> Array:
    """Relative derivatives (t, gear, keys) of the largest root tension at the position that has it."""
    tension = np.nan_to_num(sensitivities.result.root_tension)
    order = tension.argsort(axis=1)
    rows, gears = np.ogrid[: len(tension), : tension.shape[2]]
    first, second = order[:, -1], order[:, -2]
    largest = tension[rows, first, gears]
    lacking = 1.0 - tension[rows, second, gears] / largest
    second = np.where(lacking < ALIKE, second, first)
    slopes = np.stack([sensitivities.root_tension[rows, at, gears] / largest[..., None] for at in (first, second)])
    _warn_of_kinks("local safety of roots", sensitivities.keys, slopes.reshape(2, -1, slopes.shape[-1]), lacking)
    return slopes[0]


def _beside_largest(solved: SolvedLoads, sensitivities: Sensitivities, rows: Sequence[int]) -> Array:
    """What the relative derivatives (t, gear, keys) of root tension have more at the place that decides.

    That lies beside the largest tension where stress is reversed less; a place that has its largest stress at another
    position than the largest tension follows that.
    """
    result, assumed = sensitivities.result, solved.root_nodes
    assert assumed is not None
    more = np.zeros((*assumed.shape[:2], len(sensitivities.keys)))
    for number, gear in np.ndindex(assumed.shape[:2]):
        torque, deciding = rows[number], assumed[number, gear]
        tension = np.nan_to_num(result.root_stress[gear].largest[torque])
        largest = np.array(np.unravel_index(int(tension.argmax()), tension.shape))
        if (deciding == largest).all():
            continue
        position = int(np.nan_to_num(result.root_tension[torque, :, gear]).argmax())
        tooth = int(result.root_tension_place[torque, position, gear, 0])
        under, row = _under(sensitivities, torque)
        (stress, there), (_, at_top) = (
            under.root_stress_at(gear, row, position, [tooth, *node.tolist()]) for node in (deciding, largest)
        )
        if abs(stress - tension[tuple(deciding)]) < AT_ONCE * stress:
            more[number, gear] = there / stress - at_top / tension[tuple(largest)]
    return more
