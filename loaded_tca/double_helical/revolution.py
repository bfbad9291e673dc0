"""Whole revolutions of double helical pairs: the balance of both halves at every position, each tooth at its place."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array
from loaded_tca.double_helical.analyse import (
    HalfAnalysis,
    Place,
    Progress,
    StatesDone,
    balance_arrays,
    carried_by,
    joined,
    largest_of_pairs,
    largest_place,
    of_halves,
    settled,
)
from loaded_tca.double_helical.laws import gears_of
from loaded_tca.double_helical.result import FIGURES, NUMBERS, PAIR_REVOLUTION_FILE, OfHalves
from loaded_tca.effort import Effort
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.results.declared import Number
from loaded_tca.results.figure import Figure
from loaded_tca.results.files import HALVES_OVER_TURNS
from loaded_tca.results.result import figures_of
from loaded_tca.results.revolution import FIGURES as OF_TURNS
from loaded_tca.results.revolution import OverTurns, Revolution, Spectrum, orders_table
from loaded_tca.results.tables import Columns
from loaded_tca.revolution import analyse_revolution, expected_revolution_effort
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.scene.pitch import Revolution as RevolutionSection
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray

    from loaded_tca.results.revolution import UnderTorque

ON_RIGID_AXES = (
    "found a section; not allowed in whole revolutions of double helical pairs, whose gears stand on rigid axes; "
    "analyse a pitch with shafts by 'loaded-tca run' or loaded_tca.double_helical.analyse_double_helical"
)
_LEFT_OUT = "line_load", "face_load_factor", "face_load", "face_border", "place"
HALVES_REVOLUTION_NUMBERS: dict[str, Number] = {
    **{name: number for name, number in NUMBERS.items() if name not in _LEFT_OUT},
    "pinion_angle": NUMBERS["pinion_angle"].changed(text="angle of the pinion phi1, from 0 at the first position"),
    "rigid_transmission_error": Number(
        ("position",),
        "rad",
        "transmission error without load, absolute, of both halves together",
        columns=("rigid_transmission_error_um",),
    ),
}
"""Numbers of a revolution of a double helical pair."""


def _first_order(of: str, under: UnderTorque) -> float:
    """Amplitude of the first order of a gear or of the mesh in the axial motion; NaN: there is none."""
    return float(under.result.order_amplitude(under.result.axial_spectrum(under.row), of))


HALVES_REVOLUTION_FIGURES: dict[str, Figure] = {
    **figures_of({"torque": NUMBERS["torque"]}),
    **{name: figure for name, figure in OF_TURNS.items() if "single_flank" in name or name == "first_mesh_order_um"},
    **{name: figure for name, figure in FIGURES.items() if not any(left in name for left in (*_LEFT_OUT, "root"))},
    "axial_motion_span_um": replace(FIGURES["axial_motion_span_um"], label="  over the revolution, peak to peak"),
    **{
        f"axial_motion_{of}_1_um": Figure(
            of=partial(_first_order, of), label=f"axial motion: amplitude of order {of} 1"
        )
        for of in (*GEARS, "mesh")
    },
}
"""Key figures by their names."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class DoubleHelicalRevolution(OverTurns, OfHalves):
    """Both halves of a double helical pair over a whole revolution, under each torque.

    Attributes
    ----------
    scene : DoubleHelicalScene
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``HALVES_REVOLUTION_NUMBERS`` with their units, over torque [N mm], position and half.
    half_a, half_b : Revolution
        Of each half, under the torques between which its shares lie; where a floating gear stands apart under several
        torques, those under the largest.
    """

    KIND: ClassVar = HALVES_OVER_TURNS
    WHAT: ClassVar = "a whole revolution of a double helical pair"
    TITLE: ClassVar = "Whole revolution of a double helical pair"
    NUMBERS: ClassVar = HALVES_REVOLUTION_NUMBERS
    COORDINATES: ClassVar = ("torque", "pinion_angle")
    FIGURES: ClassVar = HALVES_REVOLUTION_FIGURES
    FILE: ClassVar = PAIR_REVOLUTION_FILE
    JSON: ClassVar = "double_helical_revolution.json"
    TABLES: ClassVar = {"double_helical_revolution.csv": "positions", "double_helical_orders.csv": "orders"}
    PARTS: ClassVar = {"half_a": "half_a_revolution.nc", "half_b": "half_b_revolution.nc"}
    PART: ClassVar = Revolution

    scene: DoubleHelicalScene
    dataset: xarray.Dataset
    half_a: Revolution
    half_b: Revolution

    def __repr__(self) -> str:
        return f"DoubleHelicalRevolution({self.pitches} pitches x {self.per_pitch} positions)"

    @property
    def halves(self) -> tuple[Revolution, Revolution]:
        """Revolutions of half a and half b."""
        return self.half_a, self.half_b

    def axial_spectrum(self, torque: int) -> Spectrum:
        """Amplitudes [um] of the axial motion of the floating gear over the orders of a gear, as ``spectrum`` has them.

        Parameters
        ----------
        torque : int
            Index of the torque.

        Returns
        -------
        Spectrum
        """
        return self.orders_of(MICROMETRES * self.axial_motion[torque])

    def tables(self) -> dict[str, Callable[[], Columns]]:
        """Tables of the revolution by their names; that of orders of the transmission error and the motion, too."""
        return {**super().tables(), "orders": self._orders}

    def _orders(self) -> Columns:
        orders = orders_table(self)
        motions = {
            f"axial_motion_at_{plain(1e-3 * torque, 6)}_Nm_um": self.axial_spectrum(t).amplitude
            for t, torque in enumerate(self.torque)
        }
        return orders._replace(values={**orders.values, **motions})


@checked
def analyse_double_helical_revolution(
    scene: DoubleHelicalScene, progress: Progress | None = None
) -> DoubleHelicalRevolution:
    """Analyse a whole revolution of a double helical pair: at every position both halves share the torque.

    Teeth of both halves stand at their own places by ``[pinion.pitch]``, ``[pinion.half_b.pitch]`` and
    ``pinion.apex_runout_um``, and by those of the wheel; the floating gear shuttles along its axis so that the axial
    forces of its halves balance at every position.

    Parameters
    ----------
    scene : DoubleHelicalScene
    progress : callable, optional
        Called as ``progress(done, total)`` with the states of both halves; where shares differ, the total grows.

    Returns
    -------
    DoubleHelicalRevolution

    Raises
    ------
    InputError, GeometryError, ConvergenceError
        As of :func:`loaded_tca.analyse_revolution` for both halves, and if the floating gear does not settle.

    Warns
    -----
    AccuracyWarning
        As there, and as of :func:`analyse_double_helical`.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> quick = {"analysis.compliance": "contact", "load.pinion_torque_Nm": 20.0, "analysis.cells": [8, 8]}
    >>> quick |= {"pinion.half_b": None, "pair.apex_offset_mm": 0.01, "revolution.pitches": 1}
    >>> scene = read_scene("examples/scenes/double_helical.toml").with_changes(quick)
    >>> import warnings
    >>> with warnings.catch_warnings(action="ignore"):  # of few cells
    ...     revolution = analyse_double_helical_revolution(scene.with_changes({"revolution.positions_per_pitch": 1}))
    >>> revolution.axial_motion.round(6).tolist()
    [[0.01]]
    """
    shafts = zip(GEARS, scene.have_shafts, strict=True)
    require(*((not has_shaft, f"{gear}.shaft: {ON_RIGID_AXES}") for gear, has_shaft in shafts))
    way = HalfAnalysis(analyse_revolution, _positions)
    places = settled(scene, scene.mounting.axial_offset_mm, StatesDone(progress), way)
    dataset = joined(DoubleHelicalRevolution, scene, places, [_arrays(place) for place in places])
    half_a, half_b = largest_place(places).cycles
    return DoubleHelicalRevolution(scene=scene, dataset=dataset, half_a=half_a, half_b=half_b)


def expected_halves_revolution_effort(scene: DoubleHelicalScene) -> Effort:
    """Estimate of what a revolution takes where halves share evenly."""
    effort = expected_revolution_effort(scene.half_scenes(scene.mounting.axial_offset_mm)[0])
    return replace(effort, contacts=2 * effort.contacts, states=2.0 * effort.states)


def _positions(scene: Any) -> int:
    """Positions of a revolution of a half."""
    asked = scene.revolution or RevolutionSection()
    return int(asked.count((scene.pinion.teeth, scene.wheel.teeth)) * asked.positions_per_pitch)


def _arrays(place: Place) -> dict[str, Array]:
    """Arrays of the result at one place."""
    pressures = [largest_of_pairs(cycle, "peak_pressure") for cycle in place.cycles]
    return balance_arrays(place) | {
        "peak_pressure": of_halves(place.cycles, pressures, carried_by(place)),
        "rigid_transmission_error": _rigid(place),
    }


def _rigid(place: Place) -> Array:
    """Transmission error of both halves without load (n,) [rad]: where both touch, or the first one between held gears.

    A spring along the axis carries nothing without load, and holds.
    """
    scene, pair = place.scene, gears_of(place.cycles[0])
    length = -pair.driving * pair.base_radii[1]
    ways = [
        length * half.rigid_transmission_error - scene.axial_rate * half.scene.mounting.axial_offset_mm + parted
        for half, parted in zip(place.cycles, scene.parted, strict=True)
    ]
    whole: Array = np.mean(ways, axis=0) if scene.floats_freely else np.min(ways, axis=0)
    return np.asarray(whole / length)
