"""The mesh cycle: what the tooth pairs carry, and how far the wheel lags, over the positions of a pitch."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from loaded_tca.errors import InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.storage import FilePath, Part, Variable, pack, read_netcdf, unpack, write_netcdf
from loaded_tca.unloaded import ContactPath

ARCSEC = math.degrees(3600.0)
"""Seconds of arc per radian."""


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
    transmission_error: Array = quantity("rad", "loaded transmission error, absolute")
    normal_force: Array = quantity("N", "normal force on the tooth pair")
    peak_pressure: Array = quantity("MPa", "peak contact pressure, largest cell")
    central_pressure: Array = quantity("MPa", "contact pressure beside the unloaded contact point")
    peak_radius: Array = quantity("mm", "radius on the pinion of the cell with the largest pressure")
    peak_axial: Array = quantity("mm", "axial coordinate on the pinion of the cell with the largest pressure")
    hertz_pressure: Array = quantity("MPa", "peak pressure after Hertz; NaN where Hertz does not hold")
    hertz_semi_minor: Array = quantity("mm", "semi-axis of the Hertz ellipse across the contact")
    hertz_semi_major: Array = quantity("mm", "semi-axis of the Hertz ellipse along the contact")
    contact_width: Array = quantity("mm", "width of the contact across, from the pressure map")
    contact_length: Array = quantity("mm", "length of the contact, from the pressure map")
    approach: Array = quantity("mm", "approach of the two flanks along the normal")
    mesh_stiffness: Array = quantity(
        "N/(mm um)", "tangent stiffness of one tooth pair over its face width, contact only"
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

    def peak_position(self, torque: int, *, where_hertz_holds: bool = False) -> int | None:
        """Return the index of the position with the highest pressure, of those asked for; None if there is none."""
        pressure = self.by_torque("peak_pressure")[torque]
        wanted = self.by_torque("hertz_pressure")[torque] if where_hertz_holds else pressure
        pressure = np.where(np.isfinite(wanted), pressure, np.nan)
        return int(np.nanargmax(pressure)) if np.isfinite(pressure).any() else None

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures of the whole cycle for each torque, by names that end in their unit.

        "at_peak": at the position of the highest pressure; "there": at that of the highest pressure where Hertz
        holds. Means are over the positions. NaN: not known.
        """
        return tuple(_key_figures(self, torque) for torque in range(len(self.torque)))

    def summary(self) -> str:
        """Return the key figures in the engineer's units: about 15 lines, one column per torque."""
        figures = self.key_figures()
        rows = [(label, [_cell(entry, names) for entry in figures]) for label, names in SUMMARY_ROWS]
        width = 2 + max(len(cell) for _, cells in rows for cell in cells)
        table = [f"{label:<44}" + "".join(f"{cell:>{width}}" for cell in cells) for label, cells in rows]
        return "\n".join([self.title or "Loaded tooth contact", _scope(self), *table, *_notes(self)])

    def save(self, path: FilePath) -> None:
        """Write everything to a NetCDF-3 file, whole or not at all; ``load`` reads it back unchanged.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        variables = {**pack(self, _own_parts(self.transmission_error.ndim)), **pack(self.path, PATH_PARTS, "path_")}
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
    ("edges", ("border",), "1", "borders that hold the point, pinion then wheel: tip, root, lower side, upper side"),
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


def _own_parts(axes: int) -> dict[str, Part]:
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
    own = unpack(variables, _own_parts(axes))
    stacks = unpack(variables, {name: ((*CYCLE, *part[0]), *part[1:]) for name, part in MAP_PARTS.items()}, "map_")
    torques, positions = stacks["x"].shape[:2]
    return {
        **own,
        "wheel_base_radius": float(own["wheel_base_radius"]),
        "face_width": float(own["face_width"]),
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


SUMMARY_ROWS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("pinion torque [N m]", ("pinion_torque_Nm",)),
    ("peak pressure [MPa]", ("peak_pressure_MPa",)),
    ("  at pinion angle [deg]", ("pinion_angle_at_peak_deg",)),
    ("  at pinion diameter | axial place [mm]", ("pinion_diameter_at_peak_mm", "pinion_axial_at_peak_mm")),
    ("  normal force on the tooth pair [N]", ("normal_force_at_peak_N",)),
    ("  contact length | width [mm]", ("contact_length_at_peak_mm", "contact_width_at_peak_mm")),
    ("highest peak where Hertz holds [MPa]", ("peak_pressure_where_hertz_holds_MPa",)),
    ("  pressure after Hertz there [MPa]", ("hertz_pressure_there_MPa",)),
    ("  ellipse after Hertz, length | width [mm]", ("hertz_length_there_mm", "hertz_width_there_mm")),
    ("transmission error, mean [arcsec | um]", ("transmission_error_mean_arcsec", "transmission_error_mean_um")),
    ("  peak to peak [arcsec | um]", ("transmission_error_span_arcsec", "transmission_error_span_um")),
    ("  unloaded, peak to peak [arcsec | um]", ("unloaded_error_span_arcsec", "unloaded_error_span_um")),
    ("mesh stiffness, mean [N/(mm um)]", ("mesh_stiffness_mean_N_per_mm_um",)),
    ("solver: most iterations | worst residual", ("most_solver_iterations", "worst_solver_residual")),
)
"""Label and key figures of each line of the summary."""


def _key_figures(cycle: MeshCycle, torque: int) -> dict[str, float]:
    row = {entry.name: cycle.by_torque(entry.name)[torque] for entry in fields(cycle) if entry.metadata}
    peak, smooth = cycle.peak_position(torque), cycle.peak_position(torque, where_hertz_holds=True)
    at_peak, there = (
        {name: math.nan if position is None else float(values[position]) for name, values in row.items()}
        for position in (peak, smooth)
    )
    place = cycle.path[peak or 0]
    return {
        "pinion_torque_Nm": 1e-3 * float(cycle.torque[torque]),
        "peak_pressure_MPa": at_peak["peak_pressure"],
        "pinion_angle_at_peak_deg": math.degrees(place.pinion_angle),
        "pinion_diameter_at_peak_mm": 2.0 * float(place.pinion_radius),
        "pinion_axial_at_peak_mm": float(place.pinion_axial),
        "normal_force_at_peak_N": at_peak["normal_force"],
        "contact_length_at_peak_mm": at_peak["contact_length"],
        "contact_width_at_peak_mm": at_peak["contact_width"],
        "approach_at_peak_um": 1e3 * at_peak["approach"],
        "peak_pressure_where_hertz_holds_MPa": there["peak_pressure"],
        "hertz_pressure_there_MPa": there["hertz_pressure"],
        "hertz_length_there_mm": 2.0 * there["hertz_semi_major"],
        "hertz_width_there_mm": 2.0 * there["hertz_semi_minor"],
        **_error_figures(cycle, "transmission_error", row["transmission_error"]),
        **_error_figures(cycle, "unloaded_error", cycle.path.transmission_error),
        "mesh_stiffness_mean_N_per_mm_um": _reduced(np.mean, row["mesh_stiffness"]),
        "most_solver_iterations": _reduced(np.max, row["iterations"]),
        "worst_solver_residual": _reduced(np.max, row["residual"]),
        "positions": len(cycle.path),
        "touching_positions": int(cycle.path.touches.sum()),
        "edge_positions": int((row["on_edge"] > 0).sum()),
        "line_positions": int(cycle.path.on_line.sum()),
    }


def _error_figures(cycle: MeshCycle, name: str, error: Array) -> dict[str, float]:
    """Mean and peak-to-peak of a transmission error, as an angle and as a length at the wheel's base circle."""
    mean, span = _reduced(np.mean, error), _reduced(np.ptp, error)
    length = 1e3 * cycle.wheel_base_radius
    return {
        f"{name}_mean_arcsec": mean * ARCSEC,
        f"{name}_mean_um": mean * length,
        f"{name}_span_arcsec": span * ARCSEC,
        f"{name}_span_um": span * length,
    }


def _reduced(reduction: Any, values: Array) -> float:
    """Mean, maximum or span of the finite values; NaN if there is none."""
    finite = values[np.isfinite(values)]
    return float(reduction(finite)) if finite.size else math.nan


def _cell(figures: Mapping[str, float], names: tuple[str, ...]) -> str:
    return " | ".join(_shown(figures[name], is_residual="residual" in name) for name in names)


def _shown(value: float, is_residual: bool) -> str:
    """Four digits; a dash for what is not known, zero for what is rounding."""
    if math.isnan(value):
        return "-"
    return f"{value:.1e}" if is_residual else f"{value if abs(value) > 1e-6 else 0.0:.4g}"


def _scope(cycle: MeshCycle) -> str:
    first, last = (math.degrees(cycle.pinion_angle[end]) for end in (0, -1))
    count, pairs = len(cycle.path), len(cycle.pairs)
    where = f"{count} positions, pinion angle {first:.4g} to {last:.4g} deg" if count > 1 else "1 position"
    one_pair = "one tooth pair carries the whole load (load sharing off)"
    return f"{where}; {one_pair if pairs == 1 else f'{pairs} tooth pairs share the load'}"


def _notes(cycle: MeshCycle) -> list[str]:
    """Sentences on what limits the figures; none for an ordinary point contact."""
    edge = (cycle.by_torque("on_edge") > 0).any(axis=0)
    sentences = (
        (~cycle.path.touches, "the tooth pair does not touch"),
        (cycle.path.on_line, "the unloaded contact is a line"),
        (edge, "the contact reaches a border of a flank: no Hertz, and the peak grows with the grid"),
    )
    count = len(cycle.path)
    return [f"note: at {rows.sum()} of {count} positions {sentence}" for rows, sentence in sentences if rows.any()]
