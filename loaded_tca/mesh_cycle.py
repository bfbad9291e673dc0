"""The mesh cycle: what the tooth pairs carry, and how far the wheel lags, over the positions of a pitch."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from loaded_tca.errors import InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.key_figures import highest_border_peak, highest_peak, highest_where_hertz_holds, key_figures
from loaded_tca.storage import FilePath, Part, Variable, pack, read_netcdf, unpack, write_netcdf
from loaded_tca.summary import summary_text
from loaded_tca.unloaded import ContactPath

CAPPED = 1.0 - 1e-6
"""Part of the cap on the pressure from which a peak equals it."""
DERIVED = ("inner_pressure", "peak_at_border", "capped")
"""Properties that have a number per torque and position, as the fields of quantities do."""


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


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Loaded contact over the positions of a pitch.

    Arrays are (n,) over the positions, with several torques (m, n). NaN where the tooth pair does not touch.

    Attributes
    ----------
    title, scene_toml, version : str
        Of the scene, its whole text, and the package version that made the result.
    path : ContactPath
        The unloaded contact.
    torque : (m,) array [N mm]
        Pinion torques.
    pairs : (pairs,) int array
        Tooth pairs that share the load: 0 is the pair at phi1, +1 the next one.
    load_share : (..., n, pairs) array
        Share of each pair; rows sum to 1.
    maps : tuple of tuple of PressureMap or None
        ``maps[torque][position]``; None where nothing touches.
    wheel_base_radius, face_width : float [mm]
        r_b2 and the common face width: what turns the transmission error into a length and forces into line loads.
    max_pressure : float [MPa]
        Cap on the pressure; NaN: elastic.
    """

    title: str
    scene_toml: str
    version: str
    path: ContactPath
    torque: Array
    pairs: Array
    load_share: Array
    maps: tuple[tuple[PressureMap | None, ...], ...]
    wheel_base_radius: float
    face_width: float
    max_pressure: float
    transmission_error: Array = quantity("rad", "loaded transmission error, absolute")
    normal_force: Array = quantity("N", "normal force on the tooth pair")
    peak_pressure: Array = quantity(
        "MPa", "peak contact pressure; at a border or crease the largest cell, which grows with the grid"
    )
    central_pressure: Array = quantity("MPa", "contact pressure beside the unloaded contact point")
    peak_radius: Array = quantity("mm", "radius on the pinion of the cell with the largest pressure")
    peak_axial: Array = quantity("mm", "axial coordinate on the pinion of the cell with the largest pressure")
    hertz_pressure: Array = quantity("MPa", "peak pressure after Hertz; NaN where Hertz does not hold")
    hertz_semi_minor: Array = quantity("mm", "semi-axis of the Hertz ellipse across the contact")
    hertz_semi_major: Array = quantity("mm", "semi-axis of the Hertz ellipse along the contact")
    contact_width: Array = quantity("mm", "full width of the contact across, from the pressure map")
    contact_length: Array = quantity("mm", "full length of the contact, from the pressure map, but not beyond the face")
    approach: Array = quantity("mm", "approach of the two flanks along the normal")
    mesh_stiffness: Array = quantity(
        "N/(mm um)", "contact stiffness of one tooth pair (no bending), tangent, over the face width"
    )
    on_edge: Array = quantity("1", "whether the contact reaches a border of a flank")
    at_crease: Array = quantity("1", "whether the start of a linear relief lies in the contact")
    cells_across: Array = quantity("1", "cells of the grid across the contact")
    cells_along: Array = quantity("1", "cells of the grid along the contact")
    iterations: Array = quantity("1", "iterations of the contact solver")
    residual: Array = quantity("1", "residual of the contact solver")

    @property
    def pinion_angle(self) -> Array:
        """phi1 of the positions (n,) [rad]."""
        return self.path.pinion_angle

    def __repr__(self) -> str:
        peak = np.nanmax(self.peak_pressure, initial=0.0)
        torques = f"{len(self.torque)} torque" + "s" * (len(self.torque) > 1)
        return f"MeshCycle({len(self.path)} positions, {torques}, peak {peak:.6g} MPa)"

    def by_torque(self, name: str) -> Array:
        """Return a field of numbers per torque and position as an (m, n) array, for a single torque too."""
        return np.asarray(getattr(self, name)).reshape(len(self.torque), len(self.path))

    @property
    def peak_at_border(self) -> Array:
        """Whether the largest cell lies at the end of a flank, or a crease in the contact: bool, (..., n).

        There theory has an infinite pressure, and the peak grows with the grid, up to a cap if there is one.
        """
        at_end = np.array([[one is not None and _peaks_at_end(one) for one in row] for row in self.maps])
        return np.asarray(at_end.reshape(self.peak_pressure.shape) | (self.at_crease > 0))

    @property
    def capped(self) -> Array:
        """Whether the peak equals the cap on the pressure: bool, (..., n)."""
        return np.asarray(self.peak_pressure >= CAPPED * self.max_pressure)

    @property
    def inner_pressure(self) -> Array:
        """Highest pressure that is no matter of the grid [MPa], (..., n).

        The peak; where that grows with the grid, the pressure beside the contact point; NaN where the contact point
        itself lies on a border or a crease.
        """
        beside = np.where(self.path.on_edge | self.path.on_crease, math.nan, self.central_pressure)
        return np.where(self.peak_at_border, beside, self.peak_pressure)

    def peak_position(self, torque: int, *, where_hertz_holds: bool = False) -> int | None:
        """Return the index of the position with the highest pressure, of those asked for; None if there is none.

        By default that of ``inner_pressure``, or of the central pressure where every contact point lies on a border.
        """
        row = self._row(torque)
        return highest_where_hertz_holds(row) if where_hertz_holds else highest_peak(row)

    def border_position(self, torque: int) -> int | None:
        """Return the index of the position with the highest peak at a border or crease; None if there is none."""
        return highest_border_peak(self._row(torque))

    def _row(self, torque: int) -> dict[str, Array]:
        """Every field of numbers per position under one torque, and those that follow from them."""
        names = (*(entry.name for entry in fields(self) if entry.metadata), *DERIVED)
        return {name: self.by_torque(name)[torque] for name in names}

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures of the whole cycle for each torque, by names that end in their unit.

        ``peak_pressure_MPa`` is the highest ``inner_pressure``; "at_peak": at its position; "at_border": at that of
        the highest peak at a border or crease; "there": at that of the highest pressure where Hertz holds. Means
        are over the positions. NaN: not known.
        """
        scalars = {name: getattr(self, name) for name in ("wheel_base_radius", "max_pressure")}
        return tuple(
            {"pinion_torque_Nm": 1e-3 * float(torque), **key_figures(self.path, self._row(index), **scalars)}
            for index, torque in enumerate(self.torque)
        )

    def summary(self) -> str:
        """Return the key figures in the engineer's units: about 20 lines, one column per torque."""
        return summary_text(self.title, _scope(self), self.key_figures())

    def save(self, path: FilePath) -> None:
        """Write everything to a NetCDF-3 file, whole or not at all; ``load`` reads it back unchanged.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        variables = {**pack(self, cycle_parts(self.transmission_error.ndim)), **pack(self.path, PATH_PARTS, "path_")}
        write_netcdf(path, {**variables, **_map_variables(self)}, {name: getattr(self, name) for name in TEXTS})

    @classmethod
    def load(cls, path: FilePath) -> MeshCycle:
        """Read a file that ``save`` wrote.

        Raises
        ------
        InputError
            If it cannot be read, is damaged, or is no such file.
        """
        variables, attributes = read_netcdf(path)
        texts: dict[str, Any] = {name: attributes.get(name, "") for name in TEXTS}
        try:
            return cls(**texts, **_fields_from(variables))
        except InputError as error:
            raise InputError([f"{path}: not the result of a mesh cycle", *error.problems]) from None


TEXTS = ("title", "scene_toml", "version")
"""Attributes of a result file."""

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
    ("touches", (), "1", "whether the tooth pair touches"),
    ("on_edge", (), "1", "whether the unloaded contact lies on a border of a flank"),
    ("on_crease", (), "1", "whether the unloaded contact lies on the start of a linear relief"),
    ("on_line", (), "1", "whether the unloaded contact is a line"),
    ("line_ends", ("end", *VECTOR), "mm", "ends of the line in the fixed frame"),
    (
        "edges",
        ("border",),
        "1",
        "borders that hold the point, pinion then wheel: tip, root, lower side (toe), upper side (heel)",
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


def cycle_parts(axes: int) -> dict[str, Part]:
    """Parts of the cycle itself; ``axes``: 2 where the torques have an axis, 1 where there is one torque without."""
    leading = CYCLE[-axes:]
    quantities = {
        entry.name: (leading, entry.metadata["unit"], entry.metadata["text"])
        for entry in fields(MeshCycle)
        if entry.metadata
    }
    return {
        "torque": (("torque",), "N mm", "pinion torque"),
        "pairs": (("pair",), "1", "tooth pairs: 0 is the pair at phi1, 1 the next one"),
        "load_share": ((*leading, "pair"), "1", "share of each tooth pair in the load"),
        "wheel_base_radius": ((), "mm", "base radius of the wheel"),
        "face_width": ((), "mm", "common face width"),
        "max_pressure": ((), "MPa", "cap on the pressure; NaN: elastic"),
        **quantities,
    }


def _map_variables(cycle: MeshCycle) -> dict[str, Variable]:
    """All maps in one array per part, padded with NaN to the largest grid."""
    present = [one for row in cycle.maps for one in row if one is not None]
    sizes = {"axis": 2, "row": 3, "vector": 3}
    sizes["across"] = max((len(one.x) for one in present), default=1)
    sizes["along"] = max((len(one.y) for one in present), default=1)
    variables = {}
    for name, (own, unit, text) in MAP_PARTS.items():
        stack = np.full((len(cycle.torque), len(cycle.path), *(sizes[axis] for axis in own)), np.nan)
        for place in np.ndindex(stack.shape[:2]):
            one = cycle.maps[place[0]][place[1]]
            if one is not None:
                part = np.asarray(getattr(one, name))
                stack[(*place, *map(slice, part.shape))] = part
        variables[f"map_{name}"] = Variable((*CYCLE, *own), stack, unit, text)
    return variables


def _fields_from(variables: Mapping[str, Variable]) -> dict[str, Any]:
    """Every field of a cycle but its texts; InputError if a part is missing."""
    axes = 1 if "transmission_error" in variables and variables["transmission_error"].data.ndim == 1 else 2
    own = unpack(variables, cycle_parts(axes))
    stacks = unpack(variables, {name: ((*CYCLE, *part[0]), *part[1:]) for name, part in MAP_PARTS.items()}, "map_")
    torques, positions = stacks["x"].shape[:2]
    return {
        **own,
        **{name: float(own[name]) for name in ("wheel_base_radius", "face_width", "max_pressure")},
        "path": ContactPath(**unpack(variables, PATH_PARTS, "path_")),
        "maps": tuple(tuple(_trimmed(stacks, (t, n)) for n in range(positions)) for t in range(torques)),
    }


def _trimmed(stacks: Mapping[str, Array], place: tuple[int, int]) -> PressureMap | None:
    """The map of a torque and position without its padding; None if there is nothing else."""
    counts = {"across": int(np.isfinite(stacks["x"][place]).sum()), "along": int(np.isfinite(stacks["y"][place]).sum())}
    if not all(counts.values()):
        return None
    parts: dict[str, Any] = {
        name: stacks[name][place][tuple(slice(counts.get(axis)) for axis in own)]
        for name, (own, _, _) in MAP_PARTS.items()
    }
    dx, dy = parts["spacing"]
    return PressureMap(**{**parts, "spacing": (float(dx), float(dy))})


def _peaks_at_end(one: PressureMap) -> bool:
    """Whether the largest cell is one of those beside cells without material."""
    across, along = np.unravel_index(int(one.pressure.argmax()), one.pressure.shape)
    around = one.gap[max(across - 1, 0) : across + 2, max(along - 1, 0) : along + 2]
    return bool(one.pressure.any() and np.isinf(around).any())


def _scope(cycle: MeshCycle) -> str:
    first, last = (math.degrees(cycle.pinion_angle[end]) for end in (0, -1))
    count, pairs = len(cycle.path), len(cycle.pairs)
    where = f"{count} positions, pinion angle {first:.4g} to {last:.4g} deg" if count > 1 else "1 position"
    one_pair = "one tooth pair carries the whole load (load sharing off)"
    return f"{where}; {one_pair if pairs == 1 else f'{pairs} tooth pairs share the load'}"
