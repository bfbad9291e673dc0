"""A REXS model as its files have it: components with attributes in their units, relations between them, load cases.

The same for all formats and versions; what its names mean, says :mod:`loaded_tca.exchange.stage`.
"""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from loaded_tca.errors import InputError, require
from loaded_tca.input_files import number_in
from loaded_tca.plain import plain

LENGTH = {"mm": 1.0, "m": 1e3, "cm": 10.0, "mum": 1e-3}
ANGLE = {"deg": 1.0, "°": 1.0, "rad": math.degrees(1.0)}
FORCE = {"N": 1.0, "kN": 1e3, "MN": 1e6}
TORQUE = {"Nm": 1.0, "Nmm": 1e-3, "kNm": 1e3}
TILTING = {"Nmm/rad": 1.0, "Nm/rad": 1e3, "kNm/rad": 1e6}
STIFFNESS = {"N/mm": 1.0, "N/m": 1e-3, "N/mum": 1e3, "kN/mm": 1e3}
COUPLING = {"N/rad": 1.0, "N": 1.0, "kN/rad": 1e3, "Nmm/mm": 1.0, "Nm/m": 1.0}
PRESSURE = {"N/mm^2": 1.0, "MPa": 1.0, "GPa": 1e3, "Pa": 1e-6}
SMALL_LENGTH = {"mum": 1.0, "mm": 1e3, "m": 1e6}
SPEED = {"1/min": 1.0, "rpm": 1.0, "1/s": 60.0, "rad/s": 30.0 / math.pi}
POWER = {"kW": 1.0, "W": 1e-3, "MW": 1e3}
DENSITY = {"kg/dm^3": 1e3, "g/cm^3": 1e3, "kg/m^3": 1.0}
CONDUCTIVITY = {"W/(mK)": 1.0}
HEAT = {"J/(kgK)": 1.0}
NUMBER = {"none": 1.0, "": 1.0, "-": 1.0}
"""Names of units without blanks -> one of each in mm, deg, N, N m, N mm/rad, N/mm, N/rad, MPa, um, 1/min, kW, kg/m^3,
W/(m K), J/(kg K)."""

_AS_WRITTEN = {"µ": "mu", "μ": "mu", "um": "mum", "²": "^2", "³": "^3", "·": "", "*": "", "degree": "deg"}


def unit_without_blanks(unit: str) -> str:
    """Name of a unit without blanks and signs that files write in several ways.

    Examples
    --------
    >>> unit_without_blanks("N mm / rad"), unit_without_blanks("µm"), unit_without_blanks("N/mm²")
    ('Nmm/rad', 'mum', 'N/mm^2')
    """
    name = re.sub(r"\s", "", unit)
    if name in _AS_WRITTEN:
        return _AS_WRITTEN[name]
    for sign in ("µ", "μ", "²", "³", "·", "*"):
        name = name.replace(sign, _AS_WRITTEN[sign])
    return name


VERSIONS = "1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7"
"""Versions that are read; 2.0 has other names."""
LARGEST_NUMBER = 1e30
"""Of a model; rigid bearings have stiffnesses of 1e23 N/m."""
Value = str | float | bool | tuple[Any, ...]


@dataclass(frozen=True)
class Attribute:
    """A value of a component with its unit, as the file has them: values of XML stay text."""

    value: Value
    unit: str = "none"


@dataclass(frozen=True)
class Component:
    """A machine element, a part of it or what belongs to it.

    Attributes
    ----------
    id : str
    type : str
    name : str
    attributes : mapping of str to Attribute
    """

    id: str
    type: str
    name: str = ""
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    def __str__(self) -> str:
        return f"{self.type} {self.id}"

    @property
    def label(self) -> str:
        """Type, id and name, for lists."""
        return f'{self} "{self.name}"' if self.name else str(self)

    def number(self, name: str, units: Mapping[str, float] = NUMBER, default: float | None = None) -> float | None:
        """Return a number in the unit of one of ``units``; the default where it is not given.

        Raises
        ------
        InputError
            If it is no finite number, or its unit is another one.
        """
        attribute = self.attributes.get(name)
        if attribute is None or attribute.value == "":
            return default
        return _finite(self, name, attribute.value) * self._factor(name, attribute.unit, units)

    def required(self, name: str, units: Mapping[str, float] = NUMBER) -> float:
        """Return a number that must be there."""
        value = self.number(name, units)
        if value is None:
            raise InputError(f"{self}: {name}: missing; a scene needs it")
        return value

    def whole(self, name: str) -> int:
        """Return a whole number that must be there."""
        value = self.required(name)
        require((value == round(value), f"{self}: {name}: found {plain(value, 6)}; allowed a whole number"))
        return round(value)

    def numbers(self, name: str, units: Mapping[str, float], length: int) -> tuple[float, ...] | None:
        """Return an array of a length, in the unit of one of ``units``; None where it is not given.

        Files in JSON may have false in the place of an array.
        """
        attribute = self.attributes.get(name)
        if attribute is None or attribute.value is False:
            return None
        values = attribute.value if isinstance(attribute.value, tuple) else (attribute.value,)
        require((len(values) == length, f"{self}: {name}: found {len(values)} values; allowed {length}"))
        factor = self._factor(name, attribute.unit, units)
        return tuple(_finite(self, name, value) * factor for value in values)

    def text(self, name: str) -> str:
        """Return a text or the name of a choice in small letters; nothing where it is not given."""
        attribute = self.attributes.get(name)
        return attribute.value.strip().lower() if attribute and isinstance(attribute.value, str) else ""

    def flag(self, name: str) -> bool | None:
        """Return whether something holds; None where it is not given."""
        attribute = self.attributes.get(name)
        if attribute is None:
            return None
        words = {"true": True, "1": True, "false": False, "0": False}
        value = str(attribute.value).strip().lower()
        require((value in words, f"{self}: {name}: found {attribute.value!r:.40}; allowed true or false"))
        return words[value]

    def _factor(self, name: str, unit: str, units: Mapping[str, float]) -> float:
        try:
            return units[unit_without_blanks(unit)]
        except KeyError:
            allowed = " or ".join(one or "none" for one in units)
            raise InputError(f'{self}: {name}: found the unit "{unit}"; allowed {allowed}') from None


def _finite(component: Component, name: str, value: Value) -> float:
    """A number of a file, which may have it as text."""
    number = math.nan
    with contextlib.suppress(ValueError, OverflowError):
        if isinstance(value, str):
            number = number_in(value)
        elif not isinstance(value, bool | tuple):
            number = float(value)
    sound = abs(number) <= LARGEST_NUMBER  # not of NaN
    require((sound, f"{component}: {name}: found {value!r:.40}; allowed a number of up to {plain(LARGEST_NUMBER, 6)}"))
    return number


@dataclass(frozen=True)
class Relation:
    """What belongs together: its type, and the component of each role by id."""

    type: str
    roles: Mapping[str, str]
    order: int = 0


@dataclass(frozen=True)
class LoadCase:
    """Attributes that components have under a load case, by id of the component."""

    id: str
    spectrum: str
    components: Mapping[str, Mapping[str, Attribute]]


@dataclass(frozen=True, eq=False)
class Model:
    """A REXS model.

    Attributes
    ----------
    version : str
        One of ``VERSIONS``.
    components : mapping of str to Component
        By id.
    relations : tuple of Relation
    load_cases : tuple of LoadCase
    source : str
        Name of its file.

    Raises
    ------
    InputError
        If its version is not read, or a relation names a component that is not there.
    """

    version: str
    components: Mapping[str, Component]
    relations: tuple[Relation, ...] = ()
    load_cases: tuple[LoadCase, ...] = ()
    source: str = "model"

    def __post_init__(self) -> None:
        require(
            (
                self.version in VERSIONS,
                f'{self.source}: version: found "{self.version}"; allowed {VERSIONS[0]} to {VERSIONS[-1]}: names of '
                "other versions differ",
            )
        )
        problems = [
            f"{self.source}: relation {relation.type}: {role}: no component has the id {one}"
            for relation in self.relations
            for role, one in relation.roles.items()
            if one not in self.components
        ]
        if problems:
            raise InputError(problems)

    def of_type(self, *types: str) -> list[Component]:
        """Return the components of some types, in the order of the file."""
        return [one for one in self.components.values() if one.type in types]

    def related(self, kind: str, role: str, component: str, wanted: str) -> list[Component]:
        """Return the components of a role in relations of a type in which another role is a component, in order."""
        relations = [one for one in self.relations if one.type == kind and one.roles.get(role) == component]
        relations.sort(key=lambda one: one.order)
        return [self.components[one.roles[wanted]] for one in relations if wanted in one.roles]

    def with_load_case(self, wanted: str) -> Model:
        """Return the model under a load case: "ID", or "SPECTRUM:ID" where several spectra have one of the id.

        Raises
        ------
        InputError
            If there is none, with those that there are.
        """
        cases = [one for one in self.load_cases if wanted in (one.id, f"{one.spectrum}:{one.id}")]
        names = ", ".join(f"{one.spectrum}:{one.id}" for one in self.load_cases) or "none, the model has no load cases"
        require((len(cases) == 1, f"load case {wanted}: {'several' if cases else 'not found'}; allowed {names}"))
        components = dict(self.components)
        for one, attributes in cases[0].components.items():
            if one in components:
                components[one] = replace(components[one], attributes={**components[one].attributes, **attributes})
        return replace(self, components=components)


class Reading:
    """A model that is read for a stage: it counts which attributes were asked for.

    Attributes
    ----------
    model : Model
    not_taken : list of str
        Sentences on what a scene cannot have, with the id of the component.
    read_as : list of str
        Sentences on how the file was understood where it leaves that open.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.not_taken: list[str] = []
        self.read_as: list[str] = []
        self._taken: dict[str, set[str]] = {}

    def take(self, component: Component, *names: str) -> Component:
        """Return the component, some attributes of which are taken."""
        self._taken.setdefault(component.id, set()).update(names)
        return component

    def touch(self, components: Iterable[Component]) -> None:
        """Note components as those of the stage."""
        for one in components:
            self.take(one)

    def leave(self, component: Component, what: str) -> None:
        """Note what is not taken of a component, once."""
        sentence = f"{component.label}: {what}"
        if sentence not in self.not_taken:
            self.not_taken.append(sentence)

    def leave_whole(self, component: Component, why: str) -> None:
        """Note that nothing of a component is taken, with its attributes."""
        names = ", ".join(name for name in component.attributes if name not in BOOKKEEPING)
        self.take(component, *component.attributes)
        self.leave(component, f"{why} ({names})" if names else why)

    def note(self, sentence: str) -> None:
        """Note how the file was understood, once."""
        if sentence not in self.read_as:
            self.read_as.append(sentence)

    def number(
        self, component: Component, name: str, units: Mapping[str, float] = NUMBER, default: float | None = None
    ) -> float | None:
        """Return a number, which is taken then."""
        return self.take(component, name).number(name, units, default)

    def left_over(self) -> Iterator[tuple[Component, list[str]]]:
        """Components of the stage, and their attributes of which nothing was taken, in the order of the file."""
        for one in self.model.components.values():
            if one.id in self._taken:
                names = [name for name in one.attributes if name not in self._taken[one.id] | BOOKKEEPING]
                if names:
                    yield one, names

    @property
    def others(self) -> dict[str, int]:
        """Types of the components that no part of the stage is, and how many there are of each."""
        counts: dict[str, int] = {}
        for one in self.model.components.values():
            if one.id not in self._taken:
                counts[one.type] = counts.get(one.type, 0) + 1
        return counts


BOOKKEEPING = {
    "reference_component_for_position",
    "support_vector",
    "u_axis_vector",
    "w_axis_vector",
    "data_source",
    "display_color",
    "modification_date",
    "name",
    "part_number",
    "referenced_component_id",
    "revision_number",
    "sequence_number",
    "version",
}
"""Attributes that say nothing about the gearbox, or only once more where a part lies."""
