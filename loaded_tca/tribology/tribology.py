"""Tribology of a result under a speed, an oil and a roughness: numbers of the mesh, of tooth pairs and of slices."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arrays import GEARS, Array, GearName, Indices, place_checks
from loaded_tca.errors import NotAskedError, require
from loaded_tca.reference.iso6336_20 import scuffing_safety, scuffing_temperature
from loaded_tca.results.declared import Row
from loaded_tca.results.figure import Figures
from loaded_tca.results.files import TRIBOLOGY
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.result import Result
from loaded_tca.results.summary import summary_of
from loaded_tca.results.tables import Columns
from loaded_tca.scene import Scene
from loaded_tca.tribology.conditions import Conditions
from loaded_tca.tribology.evaluate import MILLI, Evaluation, pitch_weights
from loaded_tca.tribology.quantities import (
    COLUMNS,
    EXTREMES,
    LEAST,
    NEEDS,
    NUMBERS,
    OF_PITCH,
    QUANTITIES,
    SCUFFING,
    TORQUE,
    WITH_PLACES,
    over_speed,
    place_of,
)
from loaded_tca.tribology.slices import Slices, cells_of_flank, cylindrical_mesh, slices_of
from loaded_tca.tribology.summary import places_in_words, unknown_in_words
from loaded_tca.tribology.warnings import accuracy_sentences
from loaded_tca.units import as_ending

if TYPE_CHECKING:
    import pandas
    import xarray

CELLS = (24, 32)
"""Of the grid of a flank along the profile and lengthwise."""
FEWEST = 5
"""Positions of a mean over a pitch: of three or four the loss factor of a spur pair is a quarter too small."""


@dataclass(frozen=True, eq=False)
class UnderTorque(Row):
    """Tribology under one torque at one speed, by their indices."""

    speed: int

    def __getattr__(self, name: str) -> Any:
        return self.result.by_speed(name)[self.speed][self.row]


@dataclass(frozen=True, eq=False, repr=False)
class Tribology(Result):
    """Loss, temperatures, films and safeties of a result; every name of ``QUANTITIES`` is an attribute.

    With a list of speeds arrays that depend on the speed have it as their first axis. NaN where a pair carries nothing.
    What lacks an input is no part of the dataset; as an attribute it raises a NotAskedError that names the input.

    Attributes
    ----------
    result : MeshCycle
    conditions : Conditions
        Speed, oil, roughness and factors, as given or from the scene.
    """

    KIND: ClassVar = TRIBOLOGY
    WHAT: ClassVar = "tribology"
    TITLE: ClassVar = "Tribology"
    FILE: ClassVar = "tribology.nc"
    TABLES: ClassVar = {"tribology.csv": "figures", "tribology_slices.csv": "slices"}
    NUMBERS: ClassVar = NUMBERS

    result: CycleNumbers
    conditions: Conditions
    _kept: dict[str, Array] = field(default_factory=dict)
    _extremes: dict[str, tuple[Array, Indices]] = field(default_factory=dict)

    def __repr__(self) -> str:
        speeds = f"{self.conditions.speeds.size} speeds" if self.conditions.several else "one speed"
        return f"Tribology({len(self.sweep)} slices, {len(self.result.torque)} torques, {speeds})"

    @cached_property
    def sweep(self) -> Slices:
        """The slices of the result, for one rad/s of the pinion."""
        return slices_of(self.result)

    @cached_property
    def _shape(self) -> tuple[int, ...]:
        """Numbers of torques, positions and tooth pairs."""
        return tuple(self.result.load_share.shape)

    @cached_property
    def _numbers(self) -> Evaluation:
        return Evaluation(self.result, self.sweep, self.conditions)

    def __getattr__(self, name: str) -> Any:
        if name == "scuffing_temperature":  # its NotAskedError is an AttributeError, after which Python asks here
            self._require(name, SCUFFING)
        return super().__getattr__(name)

    def has(self, name: str) -> bool:
        """Whether a number lacks nothing."""
        return not self.lacking(name)

    @property
    def scene(self) -> Scene:
        """Scene of the result."""
        return self.result.scene

    @cached_property
    def missing(self) -> frozenset[str]:
        """Which of ``NEEDS`` the result and the arguments lack."""
        given, analysis = self.conditions, self.result.scene.analysis
        cylindrical = cylindrical_mesh(self.result) is not None
        lacks = {
            "load_sharing": not analysis.load_sharing,
            "positions": len(self.result.path) < FEWEST,
            "speed": not np.isfinite(given.speeds).all(),
            "lubricant": given.lubricant is None,
            "roughness": given.roughness is None,
            "friction": given.friction is None,
            "bulk": given.bulk_temperature is None and not cylindrical,
            "load_stage": given.load_stage is None,
            "permissible": given.permissible_film_ratio is None,
        }
        return frozenset(name for name, lack in lacks.items() if lack)

    def lacking(self, name: str) -> str:
        """What a number lacks, as its error says it; nothing if it is known."""
        return self._lacking(self.NUMBERS[name].needs)

    def by_speed(self, name: str) -> Array:
        """A number under each torque, or a place of one, (speed, torque), whatever it depends on."""
        values = np.asarray(getattr(self, name), dtype=float)
        return np.broadcast_to(values, (self.conditions.speeds.size, len(self.result.torque)))

    def knows(self, name: str) -> bool:
        """Whether a number of ``QUANTITIES`` is known: it lacks no input, and there is load."""
        return not self.lacking(name) and len(self.sweep) > 0

    def on_flanks(self, name: str, torque: int, speed: int) -> tuple[Array, Array, Array]:
        """A column of the slices under one torque, with their middles and half their lengths in the fixed frame."""
        self.check(torque, speed)
        require((name in COLUMNS, f"name: {name!r:.60}; allowed {', '.join(COLUMNS)}"))
        self._require(name, COLUMNS[name][2])
        some = self.sweep.of_torque(torque)
        return self._column(name, speed)[some].astype(float), self.sweep.point[some], self.sweep.tangent[some]

    def extreme_on_edge(self, name: str) -> bool:
        """Whether an extreme of ``EXTREMES`` lies in a slice at an edge of a flank, under any torque and speed."""
        _, places = self._extreme(name)
        return bool(self.sweep.on_edge[places[places >= 0]].any())

    def with_speeds(self, name: str) -> Array:
        """A number of ``QUANTITIES`` that depends on the speed, with that as its first axis even of one speed."""
        self._require(name, self.NUMBERS[name].needs)
        values = self.values(name)
        return values if self.conditions.several else values[None]

    def _lacking(self, needs: frozenset[str]) -> str:
        """What a number with these needs lacks, as the error says it; nothing if it lacks none."""
        needs = needs | self._of_arguments(needs)
        return next((sentence for need, sentence in NEEDS.items() if need in needs & self.missing), "")

    def _of_arguments(self, needs: frozenset[str]) -> frozenset[str]:
        """Needs that follow from those by the arguments: of the coefficient of friction, of a bulk temperature."""
        follow: set[str] = set()
        if "bulk" in needs and self.conditions.bulk_temperature is None:
            follow |= {"speed", "lubricant", "friction", "load_sharing", "positions"}
        if "friction" in needs | follow and isinstance(self.conditions.friction, str):
            follow |= {"speed", "lubricant", "roughness"}
        return frozenset(follow)

    def _require(self, name: str, needs: frozenset[str]) -> None:
        if sentence := self._lacking(needs):
            raise NotAskedError(f"{name}: {sentence}")

    def values(self, name: str) -> Array:
        """A number or place, with the axis of speeds where several are given."""
        if name == "torque":
            return np.asarray(self.result.torque)
        extreme, end = place_of(name)
        if extreme:
            return self._place(extreme, end)
        if name not in self._kept:
            self._kept[name] = self._found(name)
        values = self._kept[name]
        return values if self.conditions.several or not over_speed(self.NUMBERS[name]) else values[0]

    def _found(self, name: str) -> Array:
        """A number of ``QUANTITIES``, with the axis of speeds where it depends on them."""
        numbers, parts = self._numbers, self.sweep
        if name in EXTREMES:
            return self._extreme(name)[0]
        if name in self._of_mesh:
            return np.asarray(self._of_mesh[name]())
        if name == "friction_torque":
            rows = numbers.friction[None] * parts.torques[:, None]
            return np.stack([self._per_pair(np.add.reduceat(row, parts.starts, axis=-1)) for row in rows], axis=-1)
        if name in ("sum_velocity", "rolling_velocity", "specific_sliding"):
            of_pairs: dict[str, Callable[[], Array]] = {
                "sum_velocity": lambda: numbers.sum_velocity[:, self._sliding_most],
                "rolling_velocity": lambda: numbers.rolling[:, :, self._sliding_most],
                "specific_sliding": lambda: parts.specific_sliding[:, None, self._sliding_most],
            }
            values = of_pairs[name]()
            if values.ndim == 2:
                return self._per_pair(values)
            both = np.stack([self._per_pair(rows) for rows in values], axis=-1)
            return both if over_speed(self.NUMBERS[name]) else both[0]
        values = getattr(numbers, name)
        reduced = np.fmin if name in LEAST else np.fmax
        return self._per_pair(reduced.reduceat(values, parts.starts, axis=-1) if len(parts) else values)

    @property
    def _of_mesh(self) -> dict[str, Any]:
        """Numbers of the whole mesh -> what finds them."""
        numbers, given, torque = self._numbers, self.conditions, self.result.torque
        return {
            "loss_factor": lambda: numbers.mean_loss,
            "mean_friction": lambda: numbers.mean_friction,
            "bulk_temperature": lambda: numbers.bulk_temperature,
            "mean_friction_power": lambda: MILLI * numbers.omega * numbers.mean_friction_work * torque,
            "efficiency": lambda: 1.0 - numbers.mean_friction_work,
            "friction_power": lambda: MILLI * numbers.omega[..., None] * numbers.friction_work,
            "scuffing_safety": lambda: scuffing_safety(
                self.scuffing_temperature, numbers.oil.oil_temperature, self._extreme("largest_contact_temperature")[0]
            ),
            "micropitting_safety": lambda: self._extreme("least_film_ratio")[0] / (given.permissible_film_ratio or 1.0),
        }

    @property
    def loss_factor_of_half(self) -> Array:
        """Loss factor (torque,) of every second position, which tells its error; NaN where their number is even."""
        self._require("loss_factor_of_half", QUANTITIES["loss_factor"].needs)
        return self._numbers.mean_loss_of_half

    @property
    def scuffing_temperature(self) -> float:
        """Scuffing temperature of the oil by its load stage, ISO/TR 13989-1 [C].

        Raises
        ------
        NotAskedError
            Without lubricant or load stage.
        """
        self._require("scuffing_temperature", SCUFFING)
        oil = self._numbers.oil
        viscosity = float(oil.viscosity(oil.oil_temperature))
        return scuffing_temperature(self.conditions.load_stage or 0.0, viscosity, oil.friction_factor)

    @cached_property
    def _sliding_most(self) -> Indices:
        """Slice of each contact that slides most."""
        parts = np.split(self.sweep.sliding, self.sweep.starts[1:]) if len(self.sweep) else []
        return np.array(
            [begin + int(part.argmax()) for begin, part in zip(self.sweep.starts.tolist(), parts, strict=True)],
            dtype=int,
        )

    def _per_pair(self, values: Array) -> Array:
        """Values (s, contacts) as an array (s, torque, position, pair), NaN where a pair carries nothing."""
        parts = self.sweep
        whole = np.full((values.shape[0], *self._shape), math.nan)
        first = parts.starts
        whole[:, parts.torque[first], parts.position[first], parts.column[first]] = values
        return whole

    def _extreme(self, name: str) -> tuple[Array, Indices]:
        """Extreme under each torque (s, torque), and its slice; NaN and -1 without load."""
        if name in self._extremes:
            return self._extremes[name]
        values, torques = getattr(self._numbers, EXTREMES[name]), self._shape[0]
        worst = -values if EXTREMES[name] in LEAST else values
        extremes = np.full((len(values), torques), math.nan)
        places = np.full(extremes.shape, -1)
        for torque in range(torques):
            some = self.sweep.of_torque(torque)
            if some.size and np.isfinite(worst[:, some]).any(axis=1).all():
                places[:, torque] = some[np.nanargmax(worst[:, some], axis=1)]
                extremes[:, torque] = np.take_along_axis(values, places[:, torque, None], axis=1)[:, 0]
        self._extremes[name] = extremes, places
        return extremes, places

    def _place(self, extreme: str, end: str) -> Array:
        """Where an extreme lies: position, pair, radius or axial coordinate, of each torque."""
        _, places = self._extreme(extreme)
        parts = self.sweep
        of_slices = {"position": parts.position, "radius": parts.radius, "axial": parts.axial}.get(end)
        of_slices = self.result.pair[parts.column] if of_slices is None else of_slices
        values = np.where(places >= 0, np.append(of_slices, math.nan).astype(float)[places], math.nan)
        return values if self.conditions.several else values[0]

    @cached_property
    def dataset(self) -> xarray.Dataset:
        """All numbers that are known, with their units, as ``MeshCycle.dataset`` has those of the contact."""
        import xarray

        variables: dict[str, Any] = {}
        for name in filter(self.has, [name for name in self.NUMBERS if name != "torque"]):
            before = ("speed",) if self.conditions.several and over_speed(self.NUMBERS[name]) else ()
            about = {"units": self.NUMBERS[name].unit, "long_name": self.NUMBERS[name].text}
            variables[name] = (before + self.NUMBERS[name].dims, self.values(name), about)
        of_contact = self.result.dataset
        coordinates: dict[str, Any] = {name: of_contact[name] for name in ("torque", "pinion_angle", "pair")}
        coordinates["gear"] = ("gear", [*GEARS])
        if self.conditions.several:
            speed = {"units": "1/min", "long_name": "speed of the pinion"}
            coordinates["speed"] = ("speed", self.conditions.speeds, speed)
        about = {"title": self.title, "version": self.result.version, "warnings": "\n".join(self.warnings)}
        return xarray.Dataset(variables, coordinates, about)

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Sentences of accuracy warnings: where a number is at a limit of its standard or of the positions."""
        return tuple(dict.fromkeys(accuracy_sentences(self)))

    def under(self, torque: int, speed: int = 0) -> UnderTorque:
        """What figures are read off: the numbers under a torque at a speed, by their indices."""
        return UnderTorque(self, torque, speed)

    def slices(self, torque: int = 0, speed: int = 0) -> pandas.DataFrame:
        """Table of all slices under one torque.

        Parameters
        ----------
        torque, speed : int
            Indices; the speed of a list.

        Returns
        -------
        pandas.DataFrame
            A row for each slice; of ``COLUMNS`` those that are known. Lengths in mm, films in um, line loads and wear
            in N/mm, pressures in MPa, velocities in m/s, pressure times velocity in MPa m/s, powers in W, flash
            temperatures in K, contact temperatures in C. Pressure is that of the nominal torque; films and flash
            temperatures take it times the root of K_A K_v. ``to_pandas("slices")`` has the slices of all torques at the
            first speed, with the units in its heads, as files have them.

        Raises
        ------
        InputError
            If there is no such torque or speed.
        """
        import pandas

        self.check(torque, speed)
        some = self.sweep.of_torque(torque)
        columns = {name: self._column(name, speed)[some] for name in COLUMNS if not self._lacking(COLUMNS[name][2])}
        return pandas.DataFrame(columns)

    def check(self, torque: int, speed: int) -> None:
        """Refuse indices of a torque and a speed that there are not."""
        speeds = self.conditions.speeds.size
        require(*place_checks(torque=(torque, len(self.result.torque)), speed=(speed, speeds)))

    def _column(self, name: str, speed: int) -> Array:
        """A column of the table of slices, of all torques."""
        parts = self.sweep
        gear = 0 if name.startswith("pinion") else 1
        of_slices: dict[str, Callable[[], Array]] = {
            "pair": lambda: self.result.pair[parts.column],
            "pinion_radius": lambda: parts.radius,
            "pinion_axial": lambda: parts.axial,
            "pinion_specific_sliding": lambda: parts.specific_sliding[0],
            "wheel_specific_sliding": lambda: parts.specific_sliding[1],
            "pinion_wear": lambda: parts.line_load * np.abs(parts.specific_sliding[0]),
            "wheel_wear": lambda: parts.line_load * np.abs(parts.specific_sliding[1]),
            "pinion_rolling_velocity": lambda: self._numbers.rolling[gear][speed],
            "wheel_rolling_velocity": lambda: self._numbers.rolling[gear][speed],
        }
        if name in of_slices:
            return np.asarray(of_slices[name]())
        return np.asarray(getattr(parts, name) if hasattr(parts, name) else getattr(self._numbers, name)[speed])

    def over_flank(
        self, name: str, torque: int = 0, gear: GearName = "pinion", *, speed: int = 0, cells: tuple[int, int] = CELLS
    ) -> xarray.DataArray:
        """Extreme that each place of a flank sees over the mesh: the least of films, the largest of all others.

        Parameters
        ----------
        name : str
            Of ``COLUMNS``; of ``friction_power`` the mean over the pitch of all that falls into a cell.
        torque : int
            Index.
        gear : {"pinion", "wheel"}
        speed : int
            Index of the speed of a list.
        cells : (int, int)
            Of the grid along the profile and lengthwise.

        Returns
        -------
        xarray.DataArray
            Over ``height`` and ``lengthwise``, the coordinates of the flank in pictures: diameter and axial place of
            cylindrical gears. NaN where no slice passes.

        Raises
        ------
        InputError
            For another name, gear, torque or number of cells.
        NotAskedError
            If it lacks an input.
        """
        import xarray

        self.check(torque, speed)
        whole = isinstance(cells, tuple | list) and len(cells) == 2
        whole = whole and all(isinstance(one, int | np.integer) and one >= 1 for one in cells)
        require(
            (isinstance(name, str) and name in COLUMNS, f"name: {name!r:.60}; allowed {', '.join(COLUMNS)}"),
            (gear in GEARS, f"gear: {gear!r:.60}; allowed 'pinion' or 'wheel'"),
            (whole, f"cells: {cells!r:.60}; allowed two whole numbers from 1 on"),
        )
        self._require(name, COLUMNS[name][2] | (OF_PITCH if name == "friction_power" else set()))
        parts, some = self.sweep, self.sweep.of_torque(torque)
        rho, z = (parts.radius, parts.axial) if gear == "pinion" else (parts.wheel_radius, parts.wheel_axial)
        index, edges = cells_of_flank(getattr(self.result.gear_pair, gear).flank, rho[some], z[some], cells)
        values = self._column(name, speed)[some]
        if name == "friction_power":
            grid = np.zeros(cells)
            np.add.at(grid, index, values * pitch_weights(len(self.result.path))[parts.position[some]])
            reached = np.zeros(cells, dtype=bool)
            reached[index] = True
            grid = np.where(reached, grid, math.nan)
        else:
            grid = np.full(cells, math.nan)
            (np.fmin if name in LEAST else np.fmax).at(grid, index, values.astype(float))
        middles = [0.5 * (edge[:-1] + edge[1:]) for edge in edges]
        about = {"units": COLUMNS[name][0], "long_name": COLUMNS[name][1]}
        coordinates = {"height": middles[0], "lengthwise": middles[1]}
        return xarray.DataArray(grid, coordinates, ("height", "lengthwise"), name, about)

    @property
    def scope(self) -> str:
        """Speed, oil and roughness, in words."""
        return self.conditions.in_words(0)

    def rows(self, figures: Sequence[Figures], speed: int = 0) -> list[tuple[str, ...]]:
        """Lines of the summary, with places below some extremes."""
        places = {self.NUMBERS[name].head(name): name for name in WITH_PLACES}
        rows = zip(self.figures, super().rows(figures), strict=True)
        below = ((row, places_in_words(self, places[name], speed) if name in places else ()) for name, row in rows)
        return [line for row, more in below for line in (row, *more)]

    def summary(self, speed: int = 0) -> str:
        """Return what the mesh comes to under each torque, in a few lines, and what is missing for more.

        Parameters
        ----------
        speed : int
            Index of the speed of a list.

        Raises
        ------
        InputError
            If there is no such speed.
        """
        self.check(0, speed)
        rows = self.rows(self.key_figures(speed), speed)
        return summary_of(self.title or self.TITLE, self.conditions.in_words(speed), rows, self.sentences())

    def sentences(self) -> dict[str, tuple[str, ...]]:
        """What is not known and why, and accuracy warnings."""
        return {"not known": tuple(unknown_in_words(self)), "warning": self.warnings}

    def tables(self) -> dict[str, Callable[[], Columns]]:
        """Tables of the mesh, a row for each speed and torque, and of all slices at the first speed."""
        index = "pinion_speed_rpm", self.NUMBERS["torque"].head("torque")
        return {"figures": lambda: Columns(self.to_table(), index), "slices": lambda: slices_table(self)}

    def key_figures(self, speed: int = 0) -> tuple[dict[str, float], ...]:
        """Return the numbers of the mesh that are known under each torque, by names that end in their unit.

        Parameters
        ----------
        speed : int
            Index of the speed of a list.
        """
        rows = (self.under(torque, speed) for torque in range(len(self.result.torque)))
        return tuple({name: figure.of(row) for name, figure in self.figures.items()} for row in rows)

    def to_table(self) -> dict[str, Array]:
        """Return what is known of the mesh at each speed and torque, and where extremes lie, as columns."""
        shape = self.conditions.speeds.size, len(self.result.torque)
        columns = {"pinion_speed_rpm": np.broadcast_to(self.conditions.speeds[:, None], shape)}
        for name, number in self.NUMBERS.items():
            if number.dims == TORQUE and self.has(name):
                head = number.head(name)
                columns[head] = number.factor(head) * self.by_speed(name)
        return {head: values.ravel() for head, values in columns.items()}

    def stored(self) -> xarray.Dataset:
        """The dataset as files have it: gears are 0, the pinion, and 1, the wheel."""
        return self.dataset.drop_vars("gear")


def slices_table(tribology: Tribology) -> Columns:
    """A row for each slice of each contact under each torque, at the first speed."""
    columns: dict[str, list[float]] = {}
    for torque, moment in enumerate(tribology.result.torque):
        table = tribology.slices(torque)
        columns.setdefault("pinion_torque_Nm", []).extend([1e-3 * float(moment)] * len(table))
        for name in map(str, table):
            ending = as_ending(COLUMNS[name][0])
            head = f"{name}_{ending}" if ending else name
            columns.setdefault(head, []).extend(table[name].astype(float).tolist())
    return Columns(columns, ("pinion_torque_Nm",))
