"""What each tooth pair carries at each position under each torque: numbers, paths, pressure maps, and their files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.results.files import Part, Variable, pack, unpack
from loaded_tca.unloaded import ContactPath

CAPPED = 1.0 - 1e-6
"""Part of the cap on the pressure from which a peak equals it."""


def quantity(unit: str, text: str) -> Any:
    """A field of numbers per torque and position, with what result files and tables say of it."""
    return field(metadata={"unit": unit, "text": text})


@dataclass(frozen=True, eq=False)
class PressureMap:
    """Pressure and gap of one position on its grid.

    Attributes
    ----------
    x, y : (nx,), (ny,) array [mm]
        Cell centres across (largest relative curvature) and along the contact, from the contact point.
    spacing : (float, float) [mm]
        Cell sizes (dx, dy).
    pressure : (nx, ny) array [MPa]
    gap : (nx, ny) array [mm]
        Deformed gap; +inf where a flank ends.
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        x, y and the normal out of the pinion, in rows, in the fixed frame.
    """

    x: Array
    y: Array
    spacing: tuple[float, float]
    pressure: Array
    gap: Array
    origin: Array
    axes: Array

    @property
    def corners(self) -> Array:
        """Corners (nx + 1, ny + 1, 3) of the cells in the tangent plane, in the fixed frame [mm]."""
        x, y = (
            np.append(centres, centres[-1] + step) - 0.5 * step
            for centres, step in zip((self.x, self.y), self.spacing, strict=True)
        )
        return self.origin + x[:, None, None] * self.axes[0] + y[:, None] * self.axes[1]


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactNumbers:
    """Numbers of a contact, one per torque and position, or one per torque, position and tooth pair."""

    normal_force: Array = quantity("N", "normal force on the tooth pair")
    peak_pressure: Array = quantity(
        "MPa", "peak contact pressure; at an edge or relief start the largest cell, which grows with the grid"
    )
    central_pressure: Array = quantity("MPa", "contact pressure beside the unloaded contact point")
    peak_radius: Array = quantity("mm", "radius on the pinion of the cell with the largest pressure")
    peak_axial: Array = quantity("mm", "axial coordinate on the pinion of the cell with the largest pressure")
    hertz_pressure: Array = quantity(
        "MPa", "peak pressure after Hertz for the curvatures at the contact point; NaN where Hertz does not hold"
    )
    hertz_semi_minor: Array = quantity("mm", "semi-axis of the Hertz ellipse across the contact")
    hertz_semi_major: Array = quantity("mm", "semi-axis of the Hertz ellipse along the contact")
    contact_width: Array = quantity("mm", "full width of the contact across, from the pressure map")
    contact_length: Array = quantity("mm", "full length of the contact, from the pressure map, but not beyond the face")
    line_load: Array = quantity(
        "N/mm", "largest force per length along the contact; at an end it grows with the grid unless free_edges"
    )
    face_load_factor: Array = quantity("1", "largest line load over the force spread evenly along the whole face")
    approach: Array = quantity("mm", "approach of the two flanks along the normal")
    deflection: Array = quantity("mm", "deflection of the teeth along the normal, beside the approach")
    on_edge: Array = quantity("1", "whether the contact reaches an edge of a flank")
    at_relief_start: Array = quantity("1", "whether the start of a linear relief lies in the contact")
    cells_across: Array = quantity("1", "cells of the grid across the contact")
    cells_along: Array = quantity("1", "cells of the grid along the contact")
    iterations: Array = quantity("1", "iterations of the contact solver")
    residual: Array = quantity("1", "residual of the contact solver")


OF_THE_PEAK = frozenset({"peak_pressure", "peak_radius", "peak_axial", "on_edge", "at_relief_start"}) | frozenset(
    {"cells_across", "cells_along", "iterations", "residual"}
)
"""Numbers of a position that belong to its highest peak pressure."""
NUMBERS = {entry.name: (entry.metadata["unit"], entry.metadata["text"]) for entry in fields(ContactNumbers)}
"""Field of ``ContactNumbers`` -> unit and text."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PairContacts(ContactNumbers):
    """Contacts of every tooth pair. Arrays are (m, n, pairs) over torques, positions and tooth pairs.

    NaN where a pair carries nothing, but its ``normal_force``, which is zero.

    Attributes
    ----------
    pairs : (pairs,) int array
        0 is the pair at phi1, +1 the next one.
    paths : tuple of ContactPath
        Unloaded contact of each pair, in the angles of the gears; NaN where it is out of reach.
    maps : tuple of tuple of tuple of PressureMap or None
        ``maps[torque][position][pair]``; None where a pair carries nothing.
    """

    pairs: NDArray[np.int_]
    paths: tuple[ContactPath, ...]
    maps: tuple[tuple[tuple[PressureMap | None, ...], ...], ...]

    @property
    def peak_at_edge(self) -> Array:
        """Whether the largest cell lies at the end of a flank, or a relief start in the contact: bool, (m, n, pairs).

        There theory has an infinite pressure, and the peak grows with the grid, up to a cap if there is one.
        """
        at_end = [[[one is not None and _peaks_at_end(one) for one in row] for row in rows] for rows in self.maps]
        return np.asarray(np.array(at_end).reshape(self.peak_pressure.shape) | (self.at_relief_start > 0))

    @property
    def inner_pressure(self) -> Array:
        """Highest pressure that is no matter of the grid [MPa], (m, n, pairs).

        The peak; where that grows with the grid, the pressure beside the contact point; NaN where the contact point
        itself lies on an edge or a relief start, or nearer to an edge than half the contact is wide: the spike reaches
        it.
        """
        held = np.stack([path.on_edge | path.on_relief_start for path in self.paths], axis=1) | self._within_spike
        return np.where(self.peak_at_edge, np.where(held, math.nan, self.central_pressure), self.peak_pressure)

    @property
    def _within_spike(self) -> Array:
        """Whether a flank ends nearer to the contact point than half the contact is wide: bool, (m, n, pairs)."""
        within = np.zeros(self.peak_pressure.shape, dtype=bool)
        for at in map(tuple, np.argwhere(self.on_edge > 0).tolist()):
            one = _nested(self.maps, at)
            within[at] = one is not None and _ends_within(one, 0.5 * self.contact_width[at])
        return within

    @property
    def highest_inner(self) -> NDArray[np.int_]:
        """Column of the pair with the highest inner pressure, where none has one of the highest peak, (m, n)."""
        known = np.nan_to_num(self.inner_pressure, nan=-math.inf)
        return np.where(np.isfinite(known).any(axis=-1), known.argmax(axis=-1), self.highest)

    def at_inner(self, values: Array) -> Array:
        """Pick from (m, n, pairs) what belongs to the pair with the highest inner pressure, (m, n)."""
        return _picked(values, self.highest_inner)

    @property
    def highest(self) -> NDArray[np.int_]:
        """Column of the pair with the highest peak pressure, (m, n)."""
        known = np.where(np.isfinite(self.peak_pressure), self.peak_pressure, -math.inf)
        return np.asarray(known.argmax(axis=-1))

    def at_highest(self, values: Array) -> Array:
        """Pick from (m, n, pairs) what belongs to the pair with the highest peak pressure, (m, n)."""
        return _picked(values, self.highest)

    @property
    def most_loaded(self) -> NDArray[np.int_]:
        """Column of the pair with the largest force, (m, n)."""
        return np.asarray(np.nan_to_num(self.normal_force, nan=-1.0).argmax(axis=-1))

    def at_position(self, name: str) -> Array:
        """Pick a number of every position, (m, n): of :data:`OF_THE_PEAK` from the pair with the highest peak pressure.

        The others belong to the pair with the largest force: a tip corner may have the highest peak under next to none.
        """
        chosen = self.highest if name in OF_THE_PEAK else self.most_loaded
        return _picked(getattr(self, name), chosen)

    def row(self, torque: int, max_pressure: float) -> dict[str, Array]:
        """Every number under one torque, one after the other over positions and pairs, (n pairs,)."""
        values = {name: getattr(self, name) for name in (*NUMBERS, "inner_pressure", "peak_at_edge")}
        values["capped"] = self.peak_pressure >= CAPPED * max_pressure
        return {name: part[torque].ravel() for name, part in values.items()}

    @property
    def path(self) -> ContactPath:
        """The paths one after the other, in the order of ``row``."""
        parts = {
            entry.name: np.stack([getattr(path, entry.name) for path in self.paths], axis=1)
            for entry in fields(ContactPath)
        }
        return ContactPath(**{name: part.reshape(-1, *part.shape[2:]) for name, part in parts.items()})


CYCLE = ("torque", "position")
VECTOR = ("vector",)


def _at_positions(*parts: tuple[str, tuple[str, ...], str, str]) -> dict[str, Part]:
    return {name: (("position", *further), unit, text) for name, further, unit, text in parts}


PATH_PARTS = _at_positions(
    ("pinion_angle", (), "rad", "angle of the pinion phi1"),
    ("wheel_angle", (), "rad", "unloaded angle of the wheel phi2"),
    ("transmission_error", (), "rad", "unloaded transmission error, absolute"),
    ("point", VECTOR, "mm", "unloaded contact point in the fixed frame"),
    ("normal", VECTOR, "1", "unit normal out of the pinion"),
    ("pinion_radius", (), "mm", "radius of the contact point on the pinion"),
    ("pinion_axial", (), "mm", "axial coordinate of the contact point on the pinion"),
    ("wheel_radius", (), "mm", "radius of the contact point on the wheel"),
    ("wheel_axial", (), "mm", "axial coordinate of the contact point on the wheel"),
    ("pinion_lever", (), "mm", "torque of a unit normal force about the axis of the pinion"),
    ("wheel_lever", (), "mm", "torque of a unit normal force about the axis of the wheel"),
    ("in_contact", (), "1", "whether the tooth pair touches"),
    ("on_edge", (), "1", "whether the unloaded contact lies on an edge of a flank"),
    ("on_relief_start", (), "1", "whether the unloaded contact lies on the start of a linear relief"),
    ("on_line", (), "1", "whether the unloaded contact is a line"),
    ("line_ends", ("end", *VECTOR), "mm", "ends of the line in the fixed frame"),
    (
        "edges",
        ("edge",),
        "1",
        "edges that hold the point, pinion then wheel: tip, root, lower side (toe), upper side (heel)",
    ),
    ("iterations", (), "1", "Newton steps of the unloaded contact"),
    ("residual", (), "1", "sine of the angle between the two normals"),
)

MAP_PARTS: dict[str, Part] = {
    "x": (("across",), "mm", "cell centres across the contact, from the contact point"),
    "y": (("along",), "mm", "cell centres along the contact, from the contact point"),
    "spacing": (("axis",), "mm", "cell sizes across and along"),
    "pressure": (("across", "along"), "MPa", "contact pressure, NaN beyond the grid of the position"),
    "gap": (("across", "along"), "mm", "deformed gap, infinite where a flank ends, NaN beyond the grid"),
    "origin": (VECTOR, "mm", "contact point in the fixed frame"),
    "axes": (("row", *VECTOR), "1", "directions across, along and normal out of the pinion, in rows"),
}
"""Parts of a pressure map; in a file each has the axes torque and position before its own."""


PAIRS = (*CYCLE, "pair")


def contact_parts(axes: tuple[str, ...]) -> dict[str, Part]:
    """Parts that ``ContactNumbers`` have, over some axes."""
    return {name: (axes, unit, text) for name, (unit, text) in NUMBERS.items()}


def map_variables(maps: Any, shape: tuple[int, ...], axes: tuple[str, ...], prefix: str) -> dict[str, Variable]:
    """Nested tuples of maps as one array per part, padded with NaN to the largest grid.

    Parameters
    ----------
    maps : nested tuple of PressureMap or None
        As deep as ``shape`` is long.
    shape, axes : tuple
        Lengths and names of their axes.
    prefix : str
        Before the names in the file.
    """
    flat = {place: _nested(maps, place) for place in np.ndindex(shape)}
    present = [one for one in flat.values() if one is not None]
    sizes = {"axis": 2, "row": 3, "vector": 3}
    sizes["across"] = max((len(one.x) for one in present), default=1)
    sizes["along"] = max((len(one.y) for one in present), default=1)
    variables = {}
    for name, (own, unit, text) in MAP_PARTS.items():
        stack = np.full((*shape, *(sizes[axis] for axis in own)), np.nan)
        for place, one in flat.items():
            if one is not None:
                part = np.asarray(getattr(one, name))
                stack[(*place, *map(slice, part.shape))] = part
        variables[f"{prefix}{name}"] = Variable((*axes, *_renamed(own, prefix)), stack, unit, text)
    return variables


def maps_from(variables: Mapping[str, Variable], axes: tuple[str, ...], prefix: str) -> Any:
    """Nested tuples of maps that ``map_variables`` stored; InputError if a part is missing."""
    parts = {name: ((*axes, *_renamed(part[0], prefix)), *part[1:]) for name, part in MAP_PARTS.items()}
    stacks = unpack(variables, parts, prefix)

    def nested(place: tuple[int, ...]) -> Any:
        if len(place) == len(axes):
            return _trimmed(stacks, place)
        return tuple(nested((*place, index)) for index in range(stacks["x"].shape[len(place)]))

    return nested(())


def _renamed(axes: tuple[str, ...], prefix: str) -> tuple[str, ...]:
    """Axes of a map, with what the prefix has before ``map_``: other maps may have other lengths."""
    owner = prefix.removesuffix("map_")
    return tuple(f"{owner}{axis}" if axis in ("across", "along") else axis for axis in axes)


def _nested(maps: Any, place: tuple[int, ...]) -> PressureMap | None:
    for index in place:
        maps = maps[index]
    return maps


def _trimmed(stacks: Mapping[str, Array], place: tuple[int, ...]) -> PressureMap | None:
    """The map at a place without its padding; None if there is nothing else."""
    counts = {"across": int(np.isfinite(stacks["x"][place]).sum()), "along": int(np.isfinite(stacks["y"][place]).sum())}
    if not all(counts.values()):
        return None
    parts: dict[str, Any] = {
        name: stacks[name][place][tuple(slice(counts.get(axis)) for axis in own)]
        for name, (own, _, _) in MAP_PARTS.items()
    }
    dx, dy = parts["spacing"]
    return PressureMap(**{**parts, "spacing": (float(dx), float(dy))})


def pack_contacts(contacts: PairContacts) -> dict[str, Variable]:
    """Variables of a result file, their names after ``pair_``."""
    stacked = {name: np.stack([getattr(path, name) for path in contacts.paths]) for name in PATH_PARTS}
    paths = {
        f"pair_path_{name}": Variable(("pair", *axes), stacked[name], unit, text)
        for name, (axes, unit, text) in PATH_PARTS.items()
    }
    maps = map_variables(contacts.maps, contacts.peak_pressure.shape, PAIRS, "pair_map_")
    return {**pack(contacts, contact_parts(PAIRS), "pair_"), **paths, **maps}


def unpack_contacts(variables: Mapping[str, Variable], pairs: NDArray[np.int_]) -> PairContacts | None:
    """Contacts that ``pack_contacts`` stored; None if there are none, InputError if a part is missing."""
    if not any(name.startswith("pair_") for name in variables):
        return None
    parts = {name: (("pair", *axes), unit, text) for name, (axes, unit, text) in PATH_PARTS.items()}
    stacked = unpack(variables, parts, "pair_path_")
    return PairContacts(
        **unpack(variables, contact_parts(PAIRS), "pair_"),
        pairs=pairs,
        paths=tuple(ContactPath(**{name: part[k] for name, part in stacked.items()}) for k in range(len(pairs))),
        maps=maps_from(variables, PAIRS, "pair_map_"),
    )


def _ends_within(one: PressureMap, distance: float) -> bool:
    """Whether there are cells without material, their edges counted, nearer to the contact point than so many mm."""
    x, y = (
        np.maximum(np.abs(centres) - 0.5 * step, 0.0) for centres, step in zip((one.x, one.y), one.spacing, strict=True)
    )
    return bool((np.isinf(one.gap) & (np.hypot(x[:, None], y) < distance)).any())


def _picked(values: Array, columns: NDArray[np.int_]) -> Array:
    """Values (m, n) in columns (m, n) of (m, n, pairs)."""
    return np.take_along_axis(values, columns[..., None], axis=-1)[..., 0]


def _peaks_at_end(one: PressureMap) -> bool:
    """Whether the largest cell is one of those beside cells without material, or at the end of the grid."""
    across, along = np.unravel_index(int(one.pressure.argmax()), one.pressure.shape)
    inside = 0 < across < len(one.x) - 1 and 0 < along < len(one.y) - 1
    around = one.gap[max(across - 1, 0) : across + 2, max(along - 1, 0) : along + 2]
    return bool(one.pressure.any() and (not inside or np.isinf(around).any()))
