"""The result of a whole revolution: every tooth at its own place, what it carries, and the orders of both gears.

Figures of single-flank testing (ISO 1328-1, ISO/TR 10064-1): the total composite deviation is the span of the
transmission error over the revolution, the tooth-to-tooth deviation its largest span within a pitch; both as lengths
at the base circle of the wheel.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from loaded_tca.arrays import GEARS, Array, index_checks
from loaded_tca.errors import require
from loaded_tca.plain import plain
from loaded_tca.results.declared import CYCLE, OVER_CYCLE, Number, Row
from loaded_tca.results.dynamics import dynamics_of_revolution
from loaded_tca.results.figure import ROOT, Figure
from loaded_tca.results.files import REVOLUTION
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.results.quantities import COORDINATES, CYCLE_NUMBERS, OF_SUPPORTS
from loaded_tca.results.result import AnalysisResult, figures_of
from loaded_tca.results.tables import Columns
from loaded_tca.scene.pitch import Revolution as RevolutionSection
from loaded_tca.units import without_unit

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray

    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.pressure_map import PressureMap
    from loaded_tca.scene import Scene

REVOLUTION_FILE = "revolution.nc"
"""Name of the file of a revolution."""
ALIKE = 1e-6
"""Relative difference of numbers of two tooth pairs that are alike: states a pitch apart, on the same grids, are solved
to rounding and to the tolerance of the balance."""
INDEX_DEVIATION = {"units": "um", "long_name": "index deviation of a tooth, along the transverse line of action"}
SIDEBANDS = 5
"""Orders of a gear beside a mesh order that are named its sidebands."""

OF_TEETH = {
    f"{gear}_tooth": Number(("position", "pair"), "1", f"tooth of the {gear}, from 0", columns=(f"{gear}_tooth",))
    for gear in GEARS
}
REVOLUTION_QUANTITIES: dict[str, Number] = {
    "torque": CYCLE_NUMBERS["torque"].changed(label="pinion torque"),
    "pinion_angle": CYCLE_NUMBERS["pinion_angle"].changed(
        text="angle of the pinion phi1, from 0 at the first position"
    ),
    "pair": Number(("pair",), "1", "tooth pair: 0 comes to the pitch point where the pitch begins, +1 after it"),
    **{name: CYCLE_NUMBERS[name] for name in ("wheel_base_radius", "face_width")},
    **OF_TEETH,
    "rigid_transmission_error": Number(
        ("position",), "rad", "transmission error without load, absolute", columns=("rigid_transmission_error_um",)
    ),
    "transmission_error": CYCLE_NUMBERS["transmission_error"].changed(columns=("transmission_error_um",)),
    **{name: CYCLE_NUMBERS[name] for name in ("mesh_stiffness", "loaded_pairs")},
    "load_share": CYCLE_NUMBERS["load_share"].changed(columns=("load_share_pair_{}",)),
    "normal_force": CYCLE_NUMBERS["normal_force"].changed(columns=()),
    "peak_pressure": CYCLE_NUMBERS["peak_pressure"].changed(columns=("peak_pressure_pair_{}_MPa",)),
    **{name: CYCLE_NUMBERS[name].changed(columns=()) for name in ("tooth_deflection", "on_edge")},
    **OF_SUPPORTS,
    **{name: CYCLE_NUMBERS[name] for name in ("root_tension", "root_compression")},
    "root_tension_tooth": Number(
        OVER_CYCLE,
        "1",
        "tooth of the pinion and of the wheel that has the largest tension, from 0",
        asked=CYCLE_NUMBERS["root_tension"].asked,
    ),
}
"""Numbers of a revolution: those that all have, of gears on supports, of root stress."""


class Spectrum(NamedTuple):
    """Amplitudes of the transmission error, or of another curve, over the orders of a gear.

    Attributes
    ----------
    order : (k,) array
        Cycles in a turn of the wheel, where the revolution is whole turns of it; else of the pinion.
    amplitude : (k,) array [um]
        Of the transmission error at the base circle of the wheel.
    kind : (k,) array of str
        "mesh 1", "mesh 2", ...; "mesh 1 -2 wheel", "mesh 1 +1 pinion": sidebands; "wheel 1", "pinion 3": orders of
        rotation; "pinion 1 = wheel 2", "mesh 1 -1 pinion = -2 wheel": of both gears; "" where an order is neither. An
        order of both gears of which one alone deviates has the name of that gear.
    """

    order: Array
    amplitude: Array
    kind: Array


class UnderTorque(Row):
    """A revolution under one torque."""

    @cached_property
    def amplitudes(self) -> dict[str, float]:
        """Amplitudes of the transmission error [um] by the kinds of their orders."""
        spectrum = self.result.spectrum(self.row)
        return dict(zip(spectrum.kind.tolist(), spectrum.amplitude.tolist(), strict=True))

    def place(self, name: str, *end: int) -> tuple[int, ...]:
        """Indices of the largest number of an array (position, ...), at an end of its axes.

        Of tooth pairs that have it alike, as those that carry all of the torque, the one with the highest pressure; of
        those that have this alike as well, the first.
        """
        values = getattr(self, name)[(..., *end)]
        alike = np.ones(values.shape, dtype=bool)
        for numbers in (values, self.peak_pressure) if values.shape == self.peak_pressure.shape else (values,):
            known = np.where(alike & np.isfinite(numbers), numbers, -math.inf)
            alike = known >= known.max() - ALIKE * abs(known.max(initial=0.0))
        return (*map(int, np.unravel_index(int(alike.argmax()), alike.shape)), *end)

    def largest(self, name: str, *end: int) -> float:
        """The largest number itself."""
        values = getattr(self, name)[(..., *end)]
        return float(np.nanmax(values)) if np.isfinite(values).any() else math.nan


def _deviation(name: str, *, rigid: bool = False) -> Figure:
    """Composite deviation by the name of the method that has it."""
    return Figure(of=lambda under: getattr(under.result, name)(None if rigid else under.row))


def _largest_of_pairs(figure: str, name: str) -> dict[str, Figure]:
    """The largest number of tooth pairs, and the teeth of the pair that has it."""
    return {
        figure: Figure(of=lambda under: under.largest(name)),
        **{f"{gear}_tooth_of_{without_unit(figure)}": Figure(of=partial(_tooth, gear, name)) for gear in GEARS},
    }


def _tooth(gear: str, name: str, under: UnderTorque) -> int:
    return int(getattr(under.result, f"{gear}_tooth")[under.place(name)])


def _root_tension(k: int) -> dict[str, Figure]:
    """The largest root tension of a gear, and the tooth that has it."""
    return {
        f"{GEARS[k]}_root_tension_MPa": Figure(of=lambda under: under.largest(ROOT, k), needs=ROOT),
        f"{GEARS[k]}_tooth_of_root_tension": Figure(
            of=lambda under: int(under.root_tension_tooth[under.place(ROOT, k)]), needs=ROOT
        ),
    }


FIGURES: dict[str, Figure] = {
    **figures_of(REVOLUTION_QUANTITIES),
    "total_single_flank_deviation_um": _deviation("total_deviation"),
    "tooth_to_tooth_single_flank_deviation_um": _deviation("tooth_to_tooth_deviation"),
    "rigid_total_single_flank_deviation_um": _deviation("total_deviation", rigid=True),
    "rigid_tooth_to_tooth_single_flank_deviation_um": _deviation("tooth_to_tooth_deviation", rigid=True),
    "first_mesh_order_um": Figure(
        of=lambda under: under.result.order_amplitude(under.result.spectrum(under.row), "mesh")
    ),
    "largest_sideband_um": Figure(
        of=lambda under: max(
            (size for kind, size in under.amplitudes.items() if kind.startswith("mesh 1 ")), default=math.nan
        )
    ),
    **_largest_of_pairs("largest_load_share", "load_share"),
    **_largest_of_pairs("peak_pressure_MPa", "peak_pressure"),
    **_root_tension(0),
    **_root_tension(1),
}
"""Key figures of a revolution by their names."""


class OverTurns(AnalysisResult):
    """Curves over the positions of a whole revolution, under each torque, and their orders of both gears."""

    scene: Scene

    @cached_property
    def teeth(self) -> tuple[int, int]:
        """Numbers of teeth of pinion and wheel."""
        return self.scene.pinion.teeth, abs(self.scene.wheel.teeth)

    @property
    def _asked(self) -> RevolutionSection:
        return self.scene.revolution or RevolutionSection()

    @property
    def pitches(self) -> int:
        """Pitches that the revolution has."""
        return self._asked.count(self.teeth)

    @property
    def per_pitch(self) -> int:
        """Positions in each pitch."""
        return self._asked.positions_per_pitch

    @property
    def counted_by(self) -> int:
        """Gear whose orders the spectrum counts: 1, the wheel, unless the pinion alone makes whole turns."""
        return 0 if self.pitches % self.teeth[1] and self.pitches % self.teeth[0] == 0 else 1

    def error_um(self, torque: int | None = None) -> Array:
        """Transmission error (n,) [um] at the base circle of the wheel; without a torque the rigid one."""
        require(*index_checks(torque=(torque, len(self.torque))))
        if torque is None:
            return self.um_per_rad * self.dataset["rigid_transmission_error"].values
        return self.um_per_rad * self.dataset["transmission_error"].values[torque]

    def spectrum(self, torque: int | None = None, *, rigid: bool = False) -> Spectrum:
        """Amplitudes of the transmission error over the orders of a gear, mesh orders and sidebands named.

        Parameters
        ----------
        torque : int, optional
            Index of the torque; default: the largest one.
        rigid : bool
            Whether the transmission error without load is meant instead.

        Returns
        -------
        Spectrum
            Up to half as many orders as positions. Where a gear deviates, of which the revolution is no whole turn,
            amplitudes leak into neighbouring orders.
        """
        torque = index_or_largest(self.torque, torque)
        return self.orders_of(self.error_um(None if rigid else torque))

    def orders_of(self, curve: Array) -> Spectrum:
        """Amplitudes of a curve over the positions (n,), in its unit; see ``spectrum``."""
        cycles = np.arange(1, (len(curve) - 1) // 2 + 1)
        amplitude = 2.0 / len(curve) * np.abs(np.fft.rfft(curve))[cycles]
        kind = np.array([self._kind(count) for count in cycles.tolist()], dtype=str)
        return Spectrum(cycles * self.teeth[self.counted_by] / self.pitches, amplitude, kind)

    def _kind(self, cycles: int) -> str:
        """What an order is called that has so many cycles in the revolution."""
        if cycles % self.pitches == 0:
            return f"mesh {cycles // self.pitches}"
        mesh = round(cycles / self.pitches)
        beside = self._turns(cycles - mesh * self.pitches) if mesh else {}
        if any(abs(turns) <= SIDEBANDS for turns in beside.values()):
            return f"mesh {mesh} " + " = ".join(f"{turns:+d} {gear}" for gear, turns in beside.items())
        return " = ".join(f"{gear} {turns}" for gear, turns in self._turns(cycles).items())

    def _turns(self, cycles: int) -> dict[str, int]:
        """Orders of rotation that have so many cycles in the revolution: of gears that deviate, if any has one."""
        orders: dict[str, int] = {}
        for gear, teeth in zip(GEARS, self.teeth, strict=True):
            turns, rest = divmod(cycles * teeth, self.pitches)
            if rest == 0:
                orders[gear] = turns
        deviating = {gear: orders[gear] for gear in orders if getattr(self.scene, gear).teeth_differ}
        return deviating or orders

    def order_amplitude(self, spectrum: Spectrum, of: str, order: int = 1) -> float:
        """Amplitude of an order of rotation of the pinion or of the wheel, or of the tooth mesh; NaN: there is none."""
        per_turn = (*self.teeth, 1)[(*GEARS, "mesh").index(of)]
        cycles, rest = divmod(order * self.pitches, per_turn)
        return float(spectrum.amplitude[cycles - 1]) if rest == 0 and cycles <= len(spectrum.amplitude) else math.nan

    def leaking_orders(self) -> dict[str, Array]:
        """Orders of rotation of each gear that deviates, and of which the revolution is no whole turn.

        The revolution has no such order: its amplitude leaks into the orders beside it.

        Returns
        -------
        dict of str to (k,) array
            By gears: for each order of ``spectrum`` the nearest order of the gear's own rotation that the revolution
            does not have, up to half the way to the next order of ``spectrum``; NaN: none.
        """
        cycles = np.arange(1, (self.pitches * self.per_pitch - 1) // 2 + 1)
        leaking = {}
        for gear in self.open_gears:
            teeth = self.teeth[GEARS.index(gear)]
            beside = np.round(cycles * teeth / self.pitches).astype(int) + np.array([[0], [-1], [1]])
            away = np.abs(beside * self.pitches / teeth - cycles)
            leaks = (beside > 0) & (beside * self.pitches % teeth != 0) & (away <= 0.5)
            nearest = np.where(leaks, away, math.inf).argmin(axis=0), np.arange(len(cycles))
            leaking[gear] = np.where(leaks[nearest], beside[nearest], math.nan)
        return leaking

    def labels(self) -> dict[str, str]:
        """As of results; of part of a turn no deviation is the total one."""
        labels = super().labels()
        if self.is_closed:
            return labels
        part = f"single flank deviation over {self.pitches} pitches"
        return {name: label.replace("total single flank deviation", part) for name, label in labels.items()}

    def total_deviation(self, torque: int | None = None) -> float:
        """Total single-flank composite deviation F_i' [um], at the base circle; without a torque of rigid teeth."""
        return float(np.ptp(self.error_um(torque)))

    def tooth_to_tooth_deviation(self, torque: int | None = None) -> float:
        """Tooth-to-tooth single-flank composite deviation f_i' [um]: the largest span within a pitch, as above."""
        curve = self.error_um(torque)
        closed = np.concatenate([curve, curve[: self.per_pitch]]) if self.is_closed else curve
        window = min(self.per_pitch + 1, len(closed))
        return float(np.ptp(sliding_window_view(closed, window), axis=-1).max())

    @property
    def is_closed(self) -> bool:
        """Whether the revolution is whole turns of every gear whose teeth deviate."""
        return not self.open_gears

    @property
    def open_gears(self) -> list[str]:
        """Gears whose teeth deviate, and of which the revolution is no whole turn."""
        return open_turns(self.scene, self.pitches)

    def under(self, torque: int) -> UnderTorque:
        """What figures are read off: the revolution under a torque, by its index."""
        return UnderTorque(self, torque)

    @property
    def scope(self) -> str:
        """Pitches and positions, in words."""
        return f"{self.pitches} pitches, {self.per_pitch} positions each, teeth counted from 0"


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Revolution(OverTurns):
    """Loaded contact over the positions of a whole revolution, under each torque.

    Attributes
    ----------
    scene : Scene
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``REVOLUTION_QUANTITIES``, of gears on supports also motions of both gears and forces on bearings,
        with their units, over torque [N mm], position (``pinion_angle`` [rad]) and
        pair; NaN where a pair carries nothing, but its force and share, which are zero.
    maps : mapping
        Pressure maps by the indices of torque and position, for each pair one or None, of the positions whose maps were
        asked for; files do not have them.
    """

    KIND: ClassVar = REVOLUTION
    WHAT: ClassVar = "a whole revolution"
    TITLE: ClassVar = "Whole revolution"
    FILE: ClassVar = REVOLUTION_FILE
    JSON: ClassVar = "revolution.json"
    TABLES: ClassVar = {"revolution.csv": "positions", "teeth.csv": "teeth", "orders.csv": "orders"}
    NUMBERS: ClassVar = REVOLUTION_QUANTITIES
    COORDINATES: ClassVar = COORDINATES
    FIGURES: ClassVar = FIGURES

    scene: Scene
    dataset: xarray.Dataset
    maps: Mapping[tuple[int, int], tuple[PressureMap | None, ...]] = field(default_factory=dict)

    def __repr__(self) -> str:
        torques, positions = (self.dataset.sizes[name] for name in CYCLE)
        return f"Revolution({self.pitches} pitches x {self.per_pitch} positions, {torques} torques, {positions} each)"

    @cached_property
    def gear_pair(self) -> GearPair:
        """The gears of the scene in space."""
        return self.scene.pair()

    def findings(self) -> tuple[str, ...]:
        """Return a sentence for each torque whose peak pressure lies in slices at an edge.

        At which pinion angle, on which teeth, how much they carry, and the largest pressure of contacts away from
        edges. The pressure at the edge itself is none of the numbers of a revolution.
        """
        return tuple(filter(None, (_peak_finding(self.under(t)) for t in range(len(self.torque)))))

    def sentences(self) -> dict[str, tuple[str, ...]]:
        """What edges do to the peak pressure, and accuracy warnings."""
        return {"note": self.notes(), "finding": self.findings(), "warning": self.warnings or ()}

    def beside_figures(self) -> dict[str, Any]:
        """Findings and warnings."""
        return {"findings": self.findings(), **super().beside_figures()}

    def by_tooth(self, gear: str = "wheel") -> xarray.Dataset:
        """Return what each tooth of a gear carries at the most in the revolution.

        Parameters
        ----------
        gear : {"pinion", "wheel"}

        Returns
        -------
        xarray.Dataset
            Over ``torque`` and ``tooth``: ``load_share``, ``normal_force`` [N] and ``peak_pressure`` [MPa], the largest
            of each tooth, and ``pinion_angle`` [rad] where the pressure is highest; NaN of teeth that carry nothing.
            Over ``tooth``: ``index_deviation`` [um], of the scene or drawn at random for its tolerance class; positive:
            the flank is set back from its mating flank.
        """
        import xarray

        require((gear in GEARS, f"gear: {gear!r:.60} is not 'pinion' or 'wheel'"))
        tooth = self.dataset[f"{gear}_tooth"].values.ravel()
        number, torques = GEARS.index(gear), len(self.torque)
        count = self.teeth[number]
        names = "load_share", "normal_force", "peak_pressure"
        values = {name: self.dataset[name].values.reshape(torques, -1) for name in names}
        loaded = values["normal_force"] > 0.0
        largest: dict[str, Array] = {}
        for name, of_pairs in values.items():
            most = np.full((torques, count), -np.inf)
            known = np.where(loaded & np.isfinite(of_pairs), of_pairs, -np.inf)
            for t in range(torques):
                np.maximum.at(most[t], tooth, known[t])
            largest[name] = np.where(np.isinf(most), np.nan, most)
        angle = np.repeat(self.dataset["pinion_angle"].values, self.dataset.sizes["pair"])
        where = np.full((torques, count), np.nan)
        for t, k in zip(*np.nonzero(values["peak_pressure"] == largest["peak_pressure"][:, tooth]), strict=True):
            where[t, tooth[k]] = np.fmin(where[t, tooth[k]], angle[k])
        parts: dict[str, Any] = {
            name: (("torque", "tooth"), array, self.dataset[name].attrs) for name, array in largest.items()
        }
        parts["pinion_angle"] = (("torque", "tooth"), where, self.dataset["pinion_angle"].attrs)
        parts["index_deviation"] = (("tooth",), 1e3 * self._index_deviations[number], INDEX_DEVIATION)
        return xarray.Dataset(parts, {"torque": self.torque, "tooth": np.arange(count)})

    @cached_property
    def _index_deviations(self) -> tuple[Array, Array]:
        """Index deviations [mm] of the teeth of pinion (z1,) and wheel (z2,)."""
        pinion, wheel = self.scene.tooth_deviations(self.gear_pair)
        return pinion.index, wheel.index

    def tables(self) -> dict[str, Callable[[], Columns]]:
        """Tables of the revolution by their names; those of teeth and orders, too."""
        return {**super().tables(), "teeth": lambda: teeth_table(self), "orders": lambda: orders_table(self)}

    def at_position(self, name: str) -> Array:
        """Numbers of tooth pair 0, or of the one next to it, at each position."""
        return self.values(name)[..., int(np.abs(self.pair).argmin())]

    def to_dynamics(self) -> xarray.Dataset:
        """Return curves over the revolution and their Fourier coefficients in SI units, for models of gear dynamics.

        Names, units and conventions are those of :meth:`loaded_tca.MeshCycle.to_dynamics`, whose curves are over one
        pitch.

        Returns
        -------
        xarray.Dataset
            Over ``pinion_torque_Nm`` and ``mesh_phase``, which runs from 0 to ``pitches``, and over the torque and
            ``order``. Orders are those of the tooth mesh in steps of 1/``pitches``: a curve is x(phi1) = amplitude_0 +
            sum of amplitude_k cos(k z1 phi1 + phase_k). ``order_of_pinion`` and ``order_of_wheel`` have them in
            cycles per turn, ``kind`` their names as ``spectrum`` has them. ``first_pinion_tooth`` and
            ``first_wheel_tooth`` are at the pitch point at the pinion angle 0. ``periodic`` is 0 where the pitches are
            no whole turn of a gear whose teeth deviate, as ``attrs["conventions"]`` says, else 1.

        Raises
        ------
        InputError
            If the revolution has one position alone.
        """
        return dynamics_of_revolution(self)


def _peak_finding(under: UnderTorque) -> str:
    """Where the peak pressure lies, if that is at an edge; nothing elsewhere."""
    pressure, place, at_edge = under.peak_pressure, under.place("peak_pressure"), under.on_edge > 0
    if not at_edge[place]:
        return ""
    away = pressure[~at_edge]
    teeth = [_tooth(gear, "peak_pressure", under) for gear in GEARS]
    most = (
        f"the largest of contacts away from edges is {plain(np.nanmax(away))} MPa"
        if np.isfinite(away).any()
        else "all contacts reach an edge"
    )
    angle = math.degrees(float(under.result.pinion_angle[place[0]]))
    return (
        f"the peak pressure {plain(pressure[place])} MPa at {plain(1e-3 * float(under.torque), 6)} N m lies in slices "
        f"at an edge, at pinion angle {plain(angle)} deg on tooth {teeth[0]} of the pinion and tooth {teeth[1]} of the "
        f"wheel, which carry {plain(100.0 * float(under.load_share[place]), 3)} % of the torque; {most}; a revolution "
        "has neither the name of the edge nor the pressure at the edge itself: the pressure map of that position, "
        f"analyse_revolution(scene, maps=[{place[0]}]), shows the edge"
    )


def open_turns(scene: Scene, pitches: int) -> list[str]:
    """Gears with deviations of which so many pitches are no whole turn."""
    gears = zip(GEARS, (scene.pinion, scene.wheel), strict=True)
    return [name for name, gear in gears if gear.teeth_differ and pitches % gear.teeth]


def teeth_table(revolution: Revolution) -> Columns:
    """A row for each torque, gear and tooth of a revolution: index deviation, largest share, force and pressure."""
    names = "load_share", "normal_force_N", "peak_pressure_MPa", "index_deviation_um"
    columns: dict[str, list[object]] = {name: [] for name in ("pinion_torque_Nm", "gear", "tooth", *names)}
    for t, torque in enumerate(revolution.torque):
        for gear in GEARS:
            teeth = revolution.by_tooth(gear)
            count = teeth.sizes["tooth"]
            parts = [[1e-3 * torque] * count, [gear] * count, range(count)]
            parts += [teeth[name].values[t] for name in ("load_share", "normal_force", "peak_pressure")]
            parts.append([*teeth["index_deviation"].values])
            for column, values in zip(columns.values(), parts, strict=True):
                column.extend(values)
    return Columns(columns, ("pinion_torque_Nm", "gear", "tooth"))


def orders_table(revolution: OverTurns) -> Columns:
    """A row for each order of the transmission error of a revolution: rigid, and under each torque.

    Where the revolution is no whole turn of a gear that deviates, a column has the orders of this gear that leak.
    """
    rigid = revolution.spectrum(rigid=True)
    order = f"order_of_{GEARS[revolution.counted_by]}"
    columns: dict[str, Any] = {order: rigid.order, "kind": np.array(rigid.kind, dtype=object)}
    columns |= {f"leaking_order_of_{gear}": orders for gear, orders in revolution.leaking_orders().items()}
    columns["rigid_amplitude_um"] = rigid.amplitude
    for t, torque in enumerate(revolution.torque):
        columns[f"amplitude_at_{plain(1e-3 * torque, 6)}_Nm_um"] = revolution.spectrum(t).amplitude
    return Columns(columns, (order,))
