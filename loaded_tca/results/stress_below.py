"""The stresses below one pressure map of a result: where they are largest, and what Hertz says of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact import SubsurfaceStress, subsurface_stress
from loaded_tca.contact.subsurface import graded_depths
from loaded_tca.errors import InputError
from loaded_tca.reference.hertz import LineContact, PointContact
from loaded_tca.results.contacts import PressureMap
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import parse_scene

GearName = Literal["pinion", "wheel"]
GEARS: tuple[GearName, GearName] = ("pinion", "wheel")
Quantity = Literal["max_shear", "von_mises"]
NAMES: dict[Quantity, str] = {
    "max_shear": "greatest shear stress",
    "von_mises": "equivalent stress after von Mises",
}
DEPTHS = 31
"""Depths that are looked at unless told otherwise."""


@dataclass(frozen=True)
class LargestStress:
    """Where a stress is largest.

    Attributes
    ----------
    value : float [MPa]
    depth : float [mm]
        Below the flank; between the depths looked at, where a parabola through three of them is highest.
    radius, axial : float [mm]
        Of the place on the pinion's flank above it.
    """

    value: float
    depth: float
    radius: float
    axial: float


@dataclass(frozen=True, eq=False)
class StressBelow:
    """Stresses below the flank of one gear, under one pressure map of a result.

    Attributes
    ----------
    result : MeshCycle
    torque, position, column : int
        Indices of the map in ``result.contacts.maps``.
    gear : {"pinion", "wheel"}
        Whose Poisson's ratio is taken; the pressure is that of both.
    stress : SubsurfaceStress
        On (depth, across, along) points below the cells of the map.
    """

    result: MeshCycle
    torque: int
    position: int
    column: int
    gear: GearName
    stress: SubsurfaceStress

    def __repr__(self) -> str:
        return f"StressBelow({self.gear}, position {self.position}, pair {self.pair}, {self.stress!r})"

    @property
    def pair(self) -> int:
        """Number of the tooth pair."""
        return int(self.result.pairs[self.column])

    @property
    def pressure_map(self) -> PressureMap:
        """The pressure that makes the stresses."""
        one = self.result.contacts.maps[self.torque][self.position][self.column]
        assert one is not None
        return one

    @property
    def half_width(self) -> float:
        """Half the width of the contact [mm], of the column beside a spike where there is one."""
        if (column := self.beside_spike) is not None:
            return 0.5 * self.pressure_map.spacing[0] * float((self.pressure_map.pressure[:, column] > 0.0).sum())
        return 0.5 * float(self.result.contacts.contact_width[self.torque, self.position, self.column])

    @property
    def beside_spike(self) -> int | None:
        """Column of the map through the contact point where the peak lies at an edge and grows with the grid.

        There the stresses are those below the first number of the summary. None where the peak is no spike, or where
        the contact point itself lies within it.
        """
        contacts, at = self.result.contacts, (self.torque, self.position, self.column)
        if not contacts.peak_at_edge[at] or math.isnan(contacts.inner_pressure[at]):
            return None
        return int(np.argmin(np.abs(self.pressure_map.y)))

    @property
    def highest_pressure(self) -> tuple[int, int]:
        """Row and column of the cell with the highest pressure, of the column beside a spike where there is one."""
        pressure, beside = self.pressure_map.pressure, self.beside_spike
        if beside is not None:
            return int(pressure[:, beside].argmax()), beside
        row, column = np.unravel_index(int(pressure.argmax()), pressure.shape)
        return int(row), int(column)

    def largest(self, quantity: Quantity, *, anywhere: bool = False) -> LargestStress:
        """Return value, depth and place of the largest ``max_shear`` or ``von_mises``.

        Parameters
        ----------
        quantity : {"max_shear", "von_mises"}
        anywhere : bool
            Below a spike at an edge too, where stresses grow with the grid; default: ``beside_spike``.

        Returns
        -------
        LargestStress
        """
        values, first = getattr(self.stress, quantity), None if anywhere else self.beside_spike
        level, row, column = getattr(self.stress, f"{quantity}_at")
        if first is not None:
            level, row = map(int, np.unravel_index(int(values[:, :, first].argmax()), values.shape[:2]))
            column = first
        one = self.pressure_map
        x, y, z = one.origin + one.x[row] * one.axes[0] + one.y[column] * one.axes[1]
        depth = depth_of_largest(self.stress.depths, values[:, row, column])
        return LargestStress(float(values[level, row, column]), depth, math.hypot(x, y), float(z))

    @property
    def hertz_shear(self) -> tuple[float, float, float] | None:
        """Greatest shear after Hertz [MPa], its depth [mm], and the pressure it belongs to [MPa].

        Of the contact ellipse, from 0.31 p_0 at 0.48 a below a circle to 0.300 p_0 at 0.786 b below a slender one;
        below a line contact, of a long line with the line load and the pressure of the section that holds the greatest
        shear. None where Hertz does not hold.
        """
        contacts, at = self.result.contacts, (self.torque, self.position, self.column)
        pressure = float(contacts.hertz_pressure[at])
        if math.isfinite(pressure):
            minor, major = float(contacts.hertz_semi_minor[at]), float(contacts.hertz_semi_major[at])
            # The stresses follow from the pressure and the axes; modulus and approach do not matter for them.
            ellipse = PointContact(float(contacts.normal_force[at]), math.nan, major, minor, pressure, math.nan)
            return *ellipse.subsurface_shear(self.stress.poisson_ratio), pressure
        if not bool(contacts.paths[self.column].on_line[self.position]) or contacts.at_relief_start[at]:
            return None
        one = self.pressure_map
        beside = self.beside_spike
        section = one.pressure[:, self.stress.max_shear_at[2] if beside is None else beside]
        line_load, pressure = float(section.sum()) * one.spacing[0], float(section.max())
        line = LineContact(line_load, math.nan, 2.0 * line_load / (math.pi * pressure), pressure)
        return *line.subsurface_shear(), pressure

    @property
    def where(self) -> tuple[str, str]:
        """Load and position of the map, and the flank, in words."""
        result, peak = self.result, float(self.pressure_map.pressure[self.highest_pressure])
        across = "" if self.beside_spike is None else " across the contact point"
        angle = round(math.degrees(result.pinion_angle[self.position]), 3) + 0.0
        return (
            f"pinion torque {1e-3 * result.torque[self.torque]:.4g} N m, position {self.position + 1} of "
            f"{len(result.path)}, tooth pair {self.pair}, pinion angle {angle:.4g} deg",
            f"flank of the {self.gear}, Poisson's ratio {self.stress.poisson_ratio:g}: "
            f"highest pressure{across} {peak:.4g} MPa, half width b {self.half_width:.4g} mm",
        )

    def summary(self) -> str:
        """Return what is largest, how deep and where, beside what Hertz says, in a few lines."""
        frame = parse_scene(self.result.scene_toml).pair().pinion.flank.frame
        peak = float(self.pressure_map.pressure[self.highest_pressure])
        lines = [self.result.title or "Stresses below the surface", *self.where]
        for quantity, name in NAMES.items():
            found = self.largest(quantity)
            lines.append(self._row(name, found.value, found.depth, peak))
            lines.append(f"  on the pinion at {frame.place(found.radius, found.axial)}")
        if (hertz := self.hertz_shear) is not None:
            lines.append(self._row("greatest shear stress after Hertz", *hertz))
        if self.result.contacts.on_edge[self.torque, self.position, self.column]:
            note = "note: the contact reaches an edge, where pressure and stress grow with the grid"
            lines.append(note + self._spike)
        return "\n".join(lines)

    @property
    def _spike(self) -> str:
        """What lies below a spike that the numbers leave out, in words."""
        if self.beside_spike is None:
            return ""
        peak, shear = float(self.pressure_map.pressure.max()), self.largest("max_shear", anywhere=True)
        return (
            f"; the numbers above are those across the contact point, not those of the edge: there the cells have up "
            f"to {peak:.4g} MPa and {shear.value:.4g} MPa of shear"
        )

    def _row(self, name: str, value: float, depth: float, pressure: float) -> str:
        relative = f"{value / pressure:.3f} of the pressure at {depth / self.half_width:.2f} b"
        return f"{name:<34}{value:>8.4g} MPa at {depth:.4g} mm: {relative}"


def stress_below(
    result: MeshCycle,
    torque: int | None = None,
    position: int | None = None,
    pair: int | None = None,
    *,
    gear: GearName = "pinion",
    depths: int = DEPTHS,
) -> StressBelow:
    """Stresses below one pressure map of a result, as deep as three half widths of the contact.

    Parameters
    ----------
    result : MeshCycle
        As it was computed or loaded.
    torque : int, optional
        Index of the torque; default: the largest one.
    position : int, optional
        Index along the path; default: that of the first number of the summary, the highest inner pressure, of the
        pair if one is asked for.
    pair : int, optional
        Number of the tooth pair, one of ``result.pairs``; default: that with the highest inner pressure.
    gear : {"pinion", "wheel"}
        Below whose flank.
    depths : int
        Number of depths, at least 2, closer near the surface.

    Returns
    -------
    StressBelow

    Raises
    ------
    InputError
        If there is no such torque, position or pair, or no pressure there; for less than two depths.

    Examples
    --------
    >>> from loaded_tca import analyse
    >>> from loaded_tca.scene import parse_scene
    >>> scene = parse_scene('''
    ... pair = {type = "cylindrical", normal_module_mm = 3.0}
    ... pinion = {teeth = 34, face_width_mm = 25.0, modifications = {lead_crowning_um = 5.0}}
    ... wheel = {teeth = 57, face_width_mm = 25.0}
    ... material = {youngs_modulus_MPa = 206000.0, poisson_ratio = 0.3}
    ... load = {pinion_torque_Nm = 40.0}
    ... analysis = {positions = 1, cells = [24, 16]}''')
    >>> below = stress_below(analyse(scene))
    >>> greatest = below.largest("max_shear")
    >>> round(greatest.value / float(below.pressure_map.pressure.max()), 2), round(greatest.depth / below.half_width, 1)
    (0.3, 0.8)
    """
    torque, position, column = _place(result, torque, position, pair)
    if gear not in GEARS:
        raise InputError(f"gear: {gear!r} is neither 'pinion' nor 'wheel'")
    if not isinstance(depths, int | np.integer) or depths < 2:
        raise InputError(f"depths: {depths!r} is not a whole number from 2 on")
    one = result.contacts.maps[torque][position][column]
    if one is None or not one.pressure.any():
        raise InputError(
            f"no stress: tooth pair {result.pairs[column]} carries no load at position {position + 1} under "
            f"{1e-3 * result.torque[torque]:.4g} N m"
        )
    half_width = 0.5 * float(result.contacts.contact_width[torque, position, column])
    material = parse_scene(result.scene_toml).materials[GEARS.index(gear)]
    levels = graded_depths(half_width, depths)
    stress = subsurface_stress(one.pressure, one.spacing, levels, material.poisson_ratio)
    return StressBelow(result, torque, position, column, gear, stress)


def depth_of_largest(depths: Array, values: Array) -> float:
    """Depth at which values below one place are largest: the top of a parabola through the three highest.

    Parameters
    ----------
    depths, values : (nz,) array
        Depths [mm] in any order.

    Returns
    -------
    float [mm]
        The depth of the largest value itself at either end.

    Examples
    --------
    >>> round(depth_of_largest(np.array([0.0, 1.0, 2.0]), np.array([1.0, 3.0, 2.0])), 3)
    1.167
    """
    z, first = np.unique(depths, return_index=True)
    height = values[first]
    level = int(np.argmax(height))
    if not 0 < level < len(z) - 1:
        return float(z[level])
    left, right = z[level] - z[[level - 1, level + 1]]
    before, after = height[level] - height[[level - 1, level + 1]]
    return float(z[level] - 0.5 * (left**2 * after - right**2 * before) / (left * after - right * before))


def _place(result: MeshCycle, torque: int | None, position: int | None, pair: int | None) -> tuple[int, int, int]:
    """Indices of torque, position and pair, those not given at the highest pressure; InputError with every problem."""
    pairs = result.pairs.tolist()
    problems = [
        f"{name}: {index!r} is no index from 0 to {count - 1}"
        for name, index, count in (("torque", torque, len(result.torque)), ("position", position, len(result.path)))
        if index is not None and not 0 <= index < count
    ]
    if pair is not None and pair not in pairs:
        problems.append(f"pair: {pair!r} carries no load anywhere; the result has {', '.join(map(str, sorted(pairs)))}")
    if problems:
        raise InputError(problems)
    torque = int(np.argmax(result.torque)) if torque is None else torque
    if pair is None:
        place = result.peak_contact(torque) if position is None else (position, result.highest_column(torque, position))
        if place is None:
            raise InputError("no stress: nothing touches at any position")
        return torque, *place
    column = pairs.index(pair)
    return torque, _highest_position(result, torque, column) if position is None else position, column


def _highest_position(result: MeshCycle, torque: int, column: int) -> int:
    """Position at which one pair has its highest inner pressure, or else its highest peak."""
    contacts = result.contacts
    for values in (contacts.inner_pressure, contacts.peak_pressure):
        if np.isfinite(values[torque, :, column]).any():
            return int(np.nanargmax(values[torque, :, column]))
    return 0
