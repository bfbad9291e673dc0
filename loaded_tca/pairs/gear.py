"""One gear of a pair: both flanks of its teeth, their form, its material and bore."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import EdgeRounding, RoundedFlank, sharp
from loaded_tca.material import Material
from loaded_tca.tooth.families import ToothForm, ToothGeometry
from loaded_tca.tooth.rounded import RoundedTooth, rounding_problems


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
        root, _ = self.form.sections.point(self.form.root_radius(coordinate), coordinate)
        return self.form.held.radius(self.bore_diameter, root)

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
        sections = self.form.sections
        rho, z = self.nominal_flank.grid(2, 2)
        ends = sections.coordinate(rho[-1], z[-1])
        root, _ = sections.point(self.form.root_radius(ends), ends)
        outwards = sections.outwards
        height = outwards * (rho[-1] - root)  # both lengths across the axis: they lie in one direction
        rim = outwards * (root - self.bore_radius(ends))
        return float((rim / height).min()) if (height > 0.0).all() else math.inf

    @property
    def smallest_bore(self) -> float:
        """Diameter [mm] of the bore, given or by default, or of the journals; the smallest one of a cone, at the toe.

        Raises
        ------
        InputError
            If it leaves no rim below the teeth.
        """
        ends = self.form.sections.coordinate(*self.nominal_flank.grid(2, 2))[-1]
        return 2.0 * float(self.bore_radius(ends).min())
