"""One gear of a pair: both flanks of its teeth, their form, rounded edges, its material and bore.

Tip edges and face ends that are rounded, and the radii that they have room for, come first.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import (
    LOWER,
    TIP,
    UPPER,
    EdgeRounding,
    RoundedFlank,
    edge_places,
    material_cosines,
    sharp,
)
from loaded_tca.material import Material
from loaded_tca.plain import plain
from loaded_tca.tooth.families import ToothForm, ToothGeometry

ROUNDING = 1e-12
ON_SHAFT = 0.8
"""Diameter of a shaft over that of the root up to which it is the seat of the gear; above it is one with the teeth."""
LARGEST = 0.3
"""Largest radius of a rounded edge, over the normal module."""


@dataclass(frozen=True)
class RoundedTooth(ToothGeometry):
    """Teeth with rounded edges; models of how they bend, which are of unmodified teeth, are those of sharp edges.

    Attributes
    ----------
    sharp : ToothGeometry
    rounding : EdgeRounding
    """

    sharp: ToothGeometry
    rounding: EdgeRounding

    @property
    def unmodified(self) -> ToothGeometry:
        """The teeth without modifications, with sharp edges."""
        return self.sharp.unmodified

    def nominal(self, side: int) -> Flank:
        """Flank of a side without modifications, with sharp edges."""
        return self.sharp.nominal(side)

    def modified(self, nominal: Flank) -> Flank:
        """A flank with its modifications and rounded edges."""
        return RoundedFlank(self.sharp.modified(nominal), self.rounding)

    def form(self) -> ToothForm:
        """Form of a tooth without its flanks: thickness, root surface and fillet."""
        return self.sharp.form()


def rounding_problems(geometry: ToothGeometry, flank: Flank, rounding: EdgeRounding, module: float) -> list[str]:
    """What is wrong with the radii of rounded edges, each with its key ``tip_rounding`` or ``side_rounding``.

    Parameters
    ----------
    geometry : ToothGeometry
    flank : Flank
        In contact, without modifications.
    rounding : EdgeRounding
    module : float [mm]
        Normal module.
    """
    of_module = LARGEST * module, f"{plain(LARGEST, 6)} normal modules"
    limits = {"tip": [of_module], "side": [of_module]}
    if rounding.tip > 0.0:
        root = flank.grid(2, 33)
        height = float(np.min(flank.edges(*(part[0] for part in root))[TIP].value))
        reach = 1.0 + float(material_cosines(flank, TIP, *edge_places(flank, TIP)).max())
        limits["tip"].append(
            (height / reach, f"with which no flank is left above the root edge, {plain(height)} mm below the tip")
        )
        limits["tip"] += _limit_of_land(geometry, flank)
    if rounding.side > 0.0:
        rho, z = edge_places(flank, LOWER)
        width = float(np.min(flank.edges(rho, z)[UPPER].value))
        reach = sum(1.0 + float(material_cosines(flank, end, *edge_places(flank, end)).max()) for end in (LOWER, UPPER))
        limits["side"].append(
            (width / reach, f"with which no flank is left between both face ends, {plain(width)} mm apart")
        )
    problems = []
    for name, radius in (("tip", rounding.tip), ("side", rounding.side)):
        most, why = min(limits[name])
        if radius > most * (1.0 + ROUNDING):
            problems.append(f"{name}_rounding_mm: found {plain(radius, 6)}; allowed up to {plain(most)} mm, {why}")
    return problems


def _limit_of_land(geometry: ToothGeometry, flank: Flank) -> list[tuple[float, str]]:
    """Radius [mm] with which the roundings of both flanks meet on the tip land; none where a tooth has one flank."""
    try:
        flanks, form = (flank, geometry.nominal(-flank.side)), geometry.form()
    except (InputError, GeometryError):  # as of a cutter with one blade
        return []
    rho, z = edge_places(flank, TIP)
    angle, lengths, slopes = np.full(rho.shape, 2.0 * form.half_thickness_angle), np.zeros(rho.shape), []
    for own in flanks:
        jet, distance = own.theta(rho, z), own.edges(rho, z)[TIP]
        cosine = material_cosines(own, TIP, rho, z)
        angle += own.side * jet.value
        lengths += (1.0 + cosine) / np.sqrt(1.0 - cosine**2)
        slopes.append(rho * (jet.z * distance.rho - jet.rho * distance.z))
    slope: Array = 0.5 * (slopes[0] + slopes[1])
    width = np.maximum(rho * angle, 0.0) / np.sqrt(1.0 + slope**2)
    worst = int((width / lengths).argmin())
    reason = f"with which the arcs of both flanks meet on the tip land, {plain(width[worst])} mm wide"
    return [(float(width[worst] / lengths[worst]), reason)]


@checked
@dataclass(frozen=True, eq=False)
class Gear:
    """One gear of a pair.

    The backs of the teeth and their form are made when they are asked for: unloaded contact and half-spaces need
    neither, and some cost the fit of a B-spline.

    Attributes
    ----------
    flank : Flank
        In contact, in the gear's own frame: with its modifications, fitted or measured.
    nominal_flank : Flank
        The same by its equations, without modifications; made anew where ``flank`` is replaced by one of the other
        side of the teeth.
    geometry : ToothGeometry
        What the other flank and the form of the teeth are made from.
    material : Material
    bore_diameter : float [mm], optional
        Held rigid where teeth bend; None: 0.55 of the root diameter. 0: a solid gear, held on both faces by journals of
        that diameter. Of a ring gear its outer diameter.
    """

    flank: Flank
    nominal_flank: Flank
    geometry: ToothGeometry
    material: Material = Material()
    bore_diameter: float | None = None

    def __post_init__(self) -> None:
        if self.nominal_flank.side != self.flank.side:
            object.__setattr__(self, "nominal_flank", self.geometry.nominal(self.flank.side))

    @classmethod
    def of(cls, geometry: ToothGeometry, side: int, material: Material, bore_diameter: float | None) -> Gear:
        """Gear in contact with its flank of the side s = +1 or -1."""
        nominal = geometry.nominal(side)
        return cls(geometry.modified(nominal), nominal, geometry, material, bore_diameter)

    def on_seat(self, diameter: float | None) -> Gear:
        """The gear with the bore that a shaft of a diameter [mm] at its middle leaves; itself without one.

        Itself, too, if the gear is a ring, or the shaft one with the teeth: thicker than 0.8 of the smallest root
        diameter.
        """
        try:
            root = 2.0 * float(self._root_radius(self._ends).min())
        except (InputError, GeometryError):  # a tooth that cannot be: told where it is to bend
            return self
        seated = diameter is not None and diameter <= ON_SHAFT * root and self.form.sections.outwards > 0.0
        return replace(self, bore_diameter=diameter) if seated else self

    def rounded(self, rounding: EdgeRounding, module: float) -> Gear:
        """The gear with rounded tip edges and face ends; itself if both are sharp.

        Parameters
        ----------
        rounding : EdgeRounding
        module : float [mm]
            Normal module of the pair.

        Raises
        ------
        InputError
            If a radius is larger than 0.3 normal modules, or leaves no flank or no tip land.
        """
        if not rounding:
            return self
        if problems := rounding_problems(self.geometry, self.nominal_flank, rounding, module):
            raise InputError(problems)
        flank, geometry = RoundedFlank(sharp(self.flank), rounding), RoundedTooth(self.geometry, rounding)
        return replace(self, flank=flank, geometry=geometry)

    @cached_property
    def sharp(self) -> Gear:
        """The gear whose flank in contact has sharp edges; itself if they are."""
        flank = sharp(self.flank)
        return self if flank is self.flank else replace(self, flank=flank)

    @cached_property
    def nominal_back(self) -> Flank:
        """The other flank by its equations, without modifications."""
        return self.geometry.nominal(-self.flank.side)

    @cached_property
    def back(self) -> Flank:
        """The other flank of the teeth, in the gear's own frame."""
        return self.geometry.modified(self.nominal_back)

    @cached_property
    def form(self) -> ToothForm:
        """Form of a tooth without its flanks: thickness, root surface and fillet."""
        return self.geometry.form()

    @property
    def flanks(self) -> tuple[Flank, Flank]:
        """Flanks of the sides s = +1 and s = -1."""
        return (self.flank, self.back) if self.flank.side > 0 else (self.back, self.flank)

    @property
    def nominal_flanks(self) -> tuple[Flank, Flank]:
        """Flanks of the sides s = +1 and s = -1 without modifications."""
        flanks = self.nominal_flank, self.nominal_back
        return flanks if self.flank.side > 0 else flanks[::-1]

    @property
    def is_solid(self) -> bool:
        """Whether the gear has no bore: it is held by its journals."""
        return self.bore_diameter == 0.0

    def bore_radius(self, coordinate: Array) -> Array:
        """Distance (k,) from the axis at which sections meet the bore [mm], given or by default, or the journals.

        Of a ring gear the outside, as everywhere where a bore is spoken of.

        Raises
        ------
        InputError
            If the bore leaves no rim below the teeth, or is too thin to hold the gear by.
        """
        return self.form.held.radius(self.bore_diameter, self._root_radius(coordinate))

    def _root_radius(self, coordinate: Array) -> Array:
        """Distance (k,) of the roots from the axis in sections [mm]."""
        return self.form.sections.point(self.form.root_radius(coordinate), coordinate)[0]

    @property
    def _ends(self) -> Array:
        """Coordinates of the sections at both ends of the tips."""
        rho, z = self.nominal_flank.grid(2, 2)
        return self.form.sections.coordinate(rho[-1], z[-1])

    @property
    def rim_over_height(self) -> float:
        """Thickness of the rim below the roots over the height of the teeth, s_R/h_t; the smallest one of a cone.

        inf for a solid gear.

        Raises
        ------
        InputError
            If the bore leaves no rim.
        """
        if self.is_solid:
            return math.inf
        rho, _ = self.nominal_flank.grid(2, 2)
        # both lengths across the axis: they lie in one direction
        height = self.form.sections.outwards * (rho[-1] - self._root_radius(self._ends))
        return float((self._rims / height).min()) if (height > 0.0).all() else math.inf

    @property
    def is_ring(self) -> bool:
        """Whether the teeth point towards the axis."""
        return self.form.sections.outwards < 0.0

    @property
    def rim_thickness(self) -> float:
        """Thickness s_R of the rim behind the roots [mm], the smallest one of a cone; inf for a solid gear.

        Raises
        ------
        InputError
            If the bore leaves no rim.
        """
        return math.inf if self.is_solid else float(self._rims.min())

    @property
    def _rims(self) -> Array:
        """Thickness of the rim behind the roots in the sections of both ends [mm]."""
        return self.form.sections.outwards * (self._root_radius(self._ends) - self.bore_radius(self._ends))

    @property
    def smallest_bore(self) -> float:
        """Diameter [mm] of the bore, given or by default, or of the journals; the smallest one of a cone, at the toe.

        Raises
        ------
        InputError
            If it leaves no rim below the teeth.
        """
        return 2.0 * float(self.bore_radius(self._ends).min())
