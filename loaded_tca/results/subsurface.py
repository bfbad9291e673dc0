"""The stresses below one pressure map of a result: where they are largest, and what Hertz says of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from loaded_tca.arrays import GEARS, Array, GearName, index_checks
from loaded_tca.contact import SubsurfaceStress, subsurface_stress
from loaded_tca.contact.subsurface import graded_depths
from loaded_tca.edges.places import arcs_at, relief_start_distances
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.reference.hertz import LineContact, PointContact
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.results.summary import shown_torque
from loaded_tca.results.support_growth import gears_under_torque

if TYPE_CHECKING:
    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.results.pressure_map import PressureMap

Quantity = Literal["max_shear", "von_mises"]
NAMES: dict[Quantity, str] = {
    "max_shear": "greatest shear stress",
    "von_mises": "equivalent stress after von Mises",
}
DEPTHS = 31
"""Depths that are looked at unless told otherwise."""
ON_START = 1e-6
"""Distance over the module from a relief start within which a contact point lies on it: traced, it does to rounding."""


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


class HertzShear(NamedTuple):
    """Greatest shear stress below a contact after Hertz.

    Attributes
    ----------
    value : float [MPa]
    depth : float [mm]
    pressure : float [MPa]
        p_0 of the same contact.
    half_width : float [mm]
        b of the same contact: the smaller semi-axis of the ellipse, or half the width of the strip.
    """

    value: float
    depth: float
    pressure: float
    half_width: float


@dataclass(frozen=True, eq=False)
class StressBelow:
    """Stresses below the flank of one gear, under one pressure map of a result.

    Attributes
    ----------
    result : MeshCycle
    torque, position, column : int
        Indices of the map in ``result.maps``.
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
        return int(self.result.pair[self.column])

    @property
    def _at(self) -> tuple[int, int, int]:
        return self.torque, self.position, self.column

    @property
    def pressure_map(self) -> PressureMap:
        """The pressure that makes the stresses."""
        one = self.result.maps[self.torque][self.position][self.column]
        assert one is not None
        return one

    @property
    def half_width(self) -> float:
        """Half the width of the contact [mm], of the slice beside a spike where there is one."""
        if (along := self.beside_spike) is not None:
            return 0.5 * self.pressure_map.spacing[0] * float((self.pressure_map.pressure[:, along] > 0.0).sum())
        return 0.5 * float(self.result.contact_width[self._at])

    @property
    def beside_spike(self) -> int | None:
        """Slice of the map through the contact point where the peak lies at an edge and is mesh-dependent.

        None where the largest cell is no spike, or where the contact point itself lies within one: on an edge or a
        relief start, or nearer to an edge than half the contact is wide; or where its slice carries nothing.
        """
        result, one = self.result, self.pressure_map
        if not (self._peaks_at_edge or result.on_relief_start[self._at]) or self._is_on_arc_or_start:
            return None
        if result.on_edge[self._at] and one.flank_ends_within(0.5 * float(result.contact_width[self._at])):
            return None
        along = int(np.argmin(np.abs(one.y)))
        return along if one.pressure[:, along].any() else None

    @property
    def _is_on_arc_or_start(self) -> bool:
        """Whether the contact point under load lies on the arc of an edge or on a relief start."""
        pair = gears_under_torque(self.result, self.torque)[0].gear_pair
        point = self.pressure_map.origin
        from_starts = np.abs(relief_start_distances(pair, *pair.on_flanks(point)))
        return bool(arcs_at(pair, point).any() or (from_starts <= ON_START * pair.module).any())

    @property
    def _is_of_an_edge(self) -> bool:
        """Whether the numbers are those of a spike at an edge, since the contact point lies within it, too."""
        return self._peaks_at_edge and self.beside_spike is None

    @property
    def _peaks_at_edge(self) -> bool:
        """Whether the largest cell lies at an edge, where it is mesh-dependent."""
        one = self.pressure_map
        return bool(self.result.on_edge[self._at] and one.pressure[one.edge_cell] == one.pressure.max())

    @property
    def highest_pressure(self) -> tuple[int, int]:
        """Indices of the cell with the highest pressure, of the slice beside a spike where there is one."""
        pressure, beside = self.pressure_map.pressure, self.beside_spike
        if beside is not None:
            return int(pressure[:, beside].argmax()), beside
        across, along = np.unravel_index(int(pressure.argmax()), pressure.shape)
        return int(across), int(along)

    def largest(self, quantity: Quantity, *, anywhere: bool = False) -> LargestStress:
        """Return value, depth and place of the largest ``max_shear`` or ``von_mises``.

        Parameters
        ----------
        quantity : {"max_shear", "von_mises"}
        anywhere : bool
            Below a spike at an edge too, where stresses are mesh-dependent; default: ``beside_spike``.

        Returns
        -------
        LargestStress
        """
        values, beside = getattr(self.stress, quantity), None if anywhere else self.beside_spike
        level, across, along = getattr(self.stress, f"{quantity}_at")
        if beside is not None:
            level, across = map(int, np.unravel_index(int(values[:, :, beside].argmax()), values.shape[:2]))
            along = beside
        one = self.pressure_map
        x, y, z = one.origin + one.x[across] * one.axes[0] + one.y[along] * one.axes[1]
        depth = depth_of_largest(self.stress.depths, values[:, across, along])
        return LargestStress(float(values[level, across, along]), depth, math.hypot(x, y), float(z))

    @property
    def hertz_shear(self) -> HertzShear | None:
        """Greatest shear after Hertz, with its depth and the pressure and half width of the same contact.

        Of the contact ellipse, 0.310 p_0 below a circle, 0.325 p_0 below one of 2.5:1, 0.300 p_0 below a slender one;
        below a line contact, of a long line. None where Hertz does not hold.
        """
        result, at = self.result, self._at
        names = ("normal_force", "hertz_semi_major", "hertz_semi_minor", "hertz_pressure")
        load, major, minor, pressure = (float(getattr(result, name)[at]) for name in names)
        if math.isnan(pressure):
            return None
        # The stresses follow from the pressure and the axes; line load, modulus and approach do not matter for them.
        over_mean = pressure * math.pi * major * minor / load  # 3/2 of an ellipse; 1 of a line of the length 2 major
        if over_mean < 1.25:
            shear = LineContact(math.nan, math.nan, minor, pressure).subsurface_shear()
        else:
            ellipse = PointContact(load, math.nan, major, minor, pressure, math.nan)
            shear = ellipse.subsurface_shear(self.stress.poisson_ratio)
        return HertzShear(*shear, pressure, minor)

    @property
    def where(self) -> tuple[str, str]:
        """Load and position of the map, and the flank, in words."""
        result, peak = self.result, float(self.pressure_map.pressure[self.highest_pressure])
        across = "" if self.beside_spike is None else " across the contact point"
        across += " at the edge, mesh-dependent," if self._is_of_an_edge else ""
        angle = round(math.degrees(result.pinion_angle[self.position]), 3) + 0.0
        return (
            f"pinion torque {shown_torque(result.torque[self.torque])}, position {self.position + 1} of "
            f"{len(result.path)}, tooth pair {self.pair}, pinion angle {plain(angle)} deg",
            f"flank of the {self.gear}, Poisson's ratio {plain(self.stress.poisson_ratio, 6)}: highest "
            f"pressure{across} {plain(peak)} MPa, half width b {plain(self.half_width)} mm",
        )

    def summary(self) -> str:
        """Return what is largest, how deep and where, beside what Hertz says, in a few lines."""
        frame = self.result.gear_pair.pinion.flank.frame
        peak = float(self.pressure_map.pressure[self.highest_pressure])
        lines = [self.result.scene.title or "Stresses below the surface", *self.where]
        for quantity, name in NAMES.items():
            largest = self.largest(quantity)
            relative = f"{largest.value / peak:z.3f} of the pressure at {largest.depth / self.half_width:z.2f} b"
            lines.append(f"{name:<34}{plain(largest.value):>8} MPa at {plain(largest.depth)} mm: {relative}")
            lines.append(f"  on the pinion at {frame.place(largest.radius, largest.axial)}")
        if (hertz := self.hertz_shear) is not None:
            relative = f"{hertz.value / hertz.pressure:z.3f} of p0 at {hertz.depth / hertz.half_width:z.2f} b"
            own = f"p0 {plain(hertz.pressure)} MPa, b {plain(hertz.half_width)} mm"
            what = "greatest shear stress after Hertz"
            lines.append(
                f"{what:<34}{plain(hertz.value):>8} MPa at {plain(hertz.depth)} mm: {relative} of its own, {own}"
            )
        if self.result.on_edge[self._at]:
            note = "note: the contact reaches an edge, where pressure and stress are mesh-dependent"
            if self.beside_spike is not None:
                peak, shear = float(self.pressure_map.pressure.max()), self.largest("max_shear", anywhere=True).value
                note += (
                    "; the numbers above hold across the contact point. At the edge the cells "
                    f"have up to {plain(peak)} MPa and {plain(shear)} MPa of shear"
                )
            elif self._is_of_an_edge:
                without = float(self.result.peak_pressure[self._at])
                note += (
                    "; the numbers above are those of the edge, since the contact point lies within it or carries no "
                    f"load: do not rate these numbers. Without the edge the contact has {plain(without)} MPa"
                )
            lines.append(note)
        return "\n".join(lines)


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
        Index along the path; default: that of the peak pressure of the summary, of the pair if one is asked
        for.
    pair : int, optional
        Number of the tooth pair, one of ``result.pair``; default: that with the highest peak pressure.
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
    one = result.maps[torque][position][column]
    if one is None or not one.pressure.any():
        raise InputError(
            f"no stress: tooth pair {result.pair[column]} carries no load at position {position + 1} under "
            f"{shown_torque(result.torque[torque])}"
        )
    half_width = 0.5 * float(result.contact_width[torque, position, column])
    material = result.scene.materials[GEARS.index(gear)]
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
    pairs = result.pair.tolist()
    known = f"the result has {', '.join(map(str, pairs))}"
    require(
        *index_checks(torque=(torque, len(result.torque)), position=(position, len(result.path))),
        (pair is None or pair in pairs, f"pair: {pair!r} carries no load anywhere; {known}"),
    )
    torque = index_or_largest(result.torque, torque)
    if pair is None:
        place = result.peak_contact(torque) if position is None else (position, result.peak_column[torque, position])
        if place is None:
            raise InputError("no stress: nothing is in contact at any position")
        return torque, *place
    column = pairs.index(pair)
    if position is None:
        position = int(np.where(np.isfinite(peak := result.peak_pressure[torque, :, column]), peak, -1.0).argmax())
    return torque, position, column
