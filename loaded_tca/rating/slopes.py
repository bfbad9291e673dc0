r"""Derivatives of safeties to keys of the scene: those of pressure, root tension and K_Hbeta by the chain rule.

.. math::
    \frac{d \ln S_H}{da} = -\tfrac12\,\frac{d}{da} \ln(T K_v K_{H\beta} K_{H\alpha}),\qquad
    \frac{d \ln S_F}{da} = -\frac{d}{da} \ln(T K_v K_{F\beta} K_{F\alpha})

.. math::
    \frac{d \ln S_{H,local}}{da} = -\frac{d \ln p}{da} - \tfrac12\,\frac{d \ln K_v}{da},\qquad
    \frac{d \ln S_{F,local}}{da} = -\frac{d \ln \sigma}{da} - \frac{d \ln K_v}{da}

with the pressure p of the slice and the tension of the root that decide. Pressure, tension and K_Hbeta of the analysis
follow from the solved contact problem; the factors of the standard are closed forms, differenced as K_Hbeta, the
torque and the tip relief move with the key. Strengths do not depend on keys of the micro-geometry. Held are the slice,
the root's place and stress ratio, and K_Halpha of the analysis.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError
from loaded_tca.rating.inputs import RatingInputs
from loaded_tca.rating.loads import load_factors
from loaded_tca.rating.solved import SolvedLoads
from loaded_tca.results.derivatives import JoinedSensitivities
from loaded_tca.results.gap_growth import curvature_growth
from loaded_tca.results.sensitivities import NEWTON_MILLIMETRES, TORQUE, Sensitivities
from loaded_tca.results.slice_pressure import largest_slice_pressures
from loaded_tca.scene.rating import ANALYSIS
from loaded_tca.separation.pair_change import value_at
from loaded_tca.tribology.contact_slices import largest_pressures

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray

    from loaded_tca.rating.rating import Rating

STEP = 1e-4
"""Of a key, over its value or its unit: closed forms are smooth, so that their differences have eight digits."""
SAFETIES = "flank_safety", "root_safety", "local_flank_safety", "local_root_safety"


def rating_slopes(rating: Rating, keys: Sequence[str]) -> xarray.Dataset:
    """Derivatives of the safeties of a rating; see :meth:`loaded_tca.rating.Rating.sensitivities`."""
    import xarray

    inputs = rating.inputs
    if not isinstance(inputs, RatingInputs):
        raise InputError(f'pair.type: "{rating.scene.geometry.type}"; derivatives of safeties are of cylindrical pairs')
    if inputs.cases.is_spectrum:
        raise InputError(
            "load.case: a load spectrum; derivatives of safeties are under torques that stand for themselves"
        )
    sensitivities = rating.result.sensitivities(keys)
    factors = _factor_slopes(inputs, sensitivities)
    torque = np.array([NEWTON_MILLIMETRES * (key == TORQUE) for key in keys]) / rating.torque[:, None]
    dynamic = factors["K_v"]
    relative = {
        "flank_safety": -0.5 * (torque + dynamic + factors["K_Hbeta"] + factors["K_Halpha"])[:, None],
        "root_safety": -(torque + dynamic + factors["K_Fbeta"] + factors["K_Falpha"])[:, None],
        "local_flank_safety": -(_pressure_slopes(sensitivities) + 0.5 * dynamic)[:, None],
    }
    if rating.has("local_root_safety"):
        relative["local_root_safety"] = -(_tension_slopes(sensitivities) + dynamic[:, None])
    arrays = {
        name: (("case", "gear", "key"), rating.values(name)[..., None] * slopes) for name, slopes in relative.items()
    }
    coordinates = {"torque": ("case", rating.torque), "gear": [*GEARS], "key": list(keys)}
    return xarray.Dataset(arrays, coordinates)


def _factor_slopes(inputs: RatingInputs, sensitivities: Sensitivities) -> dict[str, Array]:
    """Relative derivatives of the load factors of the standard, (t, keys), by their names."""
    face = np.zeros((len(inputs.torque), len(sensitivities.keys)))
    if inputs.rating.face_load_factor == ANALYSIS:
        face = np.where(inputs.result.face_load_factor[:, None] > 1.0, sensitivities.face_load_factor, 0.0)
    columns = []
    for number, key in enumerate(sensitivities.keys):
        above, below = (_factors_at(inputs, key, sign, face[:, number]) for sign in (1.0, -1.0))
        width = above[1] - below[1]
        columns.append({name: (np.log(above[0][name]) - np.log(below[0][name])) / width for name in above[0]})
    return {name: np.stack([column[name] for column in columns], axis=-1) for name in columns[0]}


def _factors_at(inputs: RatingInputs, key: str, sign: float, face: Array) -> tuple[dict[str, Array], float]:
    """Load factors with a key moved to one side, and how far; ``face`` are the derivatives of K_Hbeta (t,)."""
    scene: Any = inputs.scene
    result, torque = inputs.result, 0.0
    value = 1e-3 * float(inputs.torque.max()) if key == TORQUE else value_at(scene, key)
    step = sign * STEP * (abs(value) or 1.0)
    if key == TORQUE:
        torque = NEWTON_MILLIMETRES * step
    else:
        try:
            scene = scene.with_changes({key: value + step})
        except InputError:  # the end of its range: the difference is that to the other side
            step = 0.0
    torques = inputs.torque + torque
    solved = SolvedLoads.of_factors(
        torques, result.face_load_factor + step * face, np.asarray(result.transverse_load_factor)
    )
    cases = replace(inputs.cases, torque=torques)
    factors, _ = load_factors(replace(inputs, cases=cases, solved=solved, scene=scene, mesh=scene.mesh()))
    return factors, step


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
    largest = largest_pressures(result)
    slopes = np.zeros((len(result.torque), len(sensitivities.keys)))
    for torque, place in enumerate(zip(largest.position.tolist(), largest.column.tolist(), strict=True)):
        under, row = _under(sensitivities, torque)
        slopes[torque] = _of_contact(under, (row, *place))
    return slopes


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
    at = tension.argmax(axis=1)
    rows, gears = np.ogrid[: at.shape[0], : at.shape[1]]
    return np.asarray(sensitivities.root_tension[rows, at, gears] / tension[rows, at, gears][..., None])
