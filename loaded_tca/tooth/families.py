"""What a family of gears tells of the teeth of one gear: flanks of both sides, modifications, form, what it is held by.

The form is what shapes a tooth beside its flanks: how far apart they stand, the root surface, the fillet. Spur and
helical gears, straight and spiral bevel gears are here; rings and face-milled gears have modules of their own.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.bevel import SphericalInvoluteFlank
from loaded_tca.flanks.cylindrical import InvoluteFlank
from loaded_tca.flanks.modification import FlankModifications, modified
from loaded_tca.gears import BevelGear, CylindricalGear
from loaded_tca.gears.cylindrical_mesh import ActiveProfile
from loaded_tca.gears.involute import InvoluteGear
from loaded_tca.plain import plain
from loaded_tca.tooth.fillet import ApexSpheres, ArcFillet, Fillet, RackFillet, Sections, TransversePlanes

DEFAULT_BORE = 0.55
"""Bore of a gear that has none given, or journals of a solid gear, over the root diameter."""
SMALLEST_BORE, LARGEST_BORE = 0.05, 0.98
"""Bores over the smallest root diameter. A larger one leaves no rim below the teeth; at a smaller one a gear twists
about its bore twenty times as far as its teeth bend, and no shaft is so thin."""


class Held(ABC):
    """Cylinder of a gear that is held rigid where its teeth bend."""

    @abstractmethod
    def radius(self, diameter: float | None, root: Array) -> Array:
        """Radius (k,) of the cylinder in sections whose root circles have radii ``root`` (k,) [mm].

        Parameters
        ----------
        diameter : float [mm], optional
            As given; None: the default.
        root : (k,) array [mm]

        Raises
        ------
        InputError
            If it leaves no rim below the teeth.
        """

    def pitches_beyond(self, root: Array, held: Array, teeth: int) -> int | None:  # noqa: ARG002 (of whole rings)
        """Pitches of the body that count beside the modelled teeth; None: the body is a whole ring.

        Parameters
        ----------
        root, held : (k,) array [mm]
            Radii of root circles and cylinder in sections.
        teeth : int
        """
        return None


@dataclass(frozen=True)
class Bore(Held):
    """The bore of an external gear, or the journals of a solid one, whose diameter is given as 0.

    Examples
    --------
    >>> Bore().radius(None, np.array([50.0]))
    array([27.5])
    """

    def radius(self, diameter: float | None, root: Array) -> Array:
        """Radius (k,) of the bore or the journals [mm]; a bore that is too thin to hold the gear by is refused, too."""
        if diameter is None or diameter == 0.0:
            return DEFAULT_BORE * root
        smallest = 2.0 * root.min()
        if not SMALLEST_BORE * smallest <= diameter < LARGEST_BORE * smallest:
            thin = "it is held rigid, and the body would twist about so thin a bore far more than the teeth bend"
            raise InputError(
                f"bore_diameter: {plain(diameter, 6)} mm is not between {plain(SMALLEST_BORE, 6)} and "
                f"{plain(LARGEST_BORE, 6)} times the smallest root diameter, {plain(smallest, 6)} mm, nor 0, a solid "
                "gear: " + (thin if diameter < smallest * SMALLEST_BORE else "no rim is left below the teeth")
            )
        return np.full_like(root, 0.5 * diameter)


@dataclass(frozen=True)
class StraightRow:
    """Teeth of a rack, which stand side by side along a straight line.

    Attributes
    ----------
    reference_radius : float [mm]
        From the axis of the gear that stands for the rack to the reference line.
    pitch : float [mm]
        Along this line, in the transverse section.
    teeth : int, optional
        Whole teeth of the toothed part; None: its length is not given.
    """

    reference_radius: float
    pitch: float
    teeth: int | None = None


@dataclass(frozen=True)
class ToothForm:
    """Form of a tooth without its flanks: thickness, root surface and fillet.

    Attributes
    ----------
    teeth : int
        Number of teeth z.
    half_thickness_angle : float [rad]
        From the middle of the tooth to either flank where Theta = 0.
    sections : Sections
    root_radius : callable
        Coordinates (m,) of sections [mm] -> radii (m,) of the images of their root circles [mm].
    fillet : Fillet
    largest_that_fits : bool
        Whether an arc that does not fit into the space is made smaller, instead of an error.
    held : Held
        What the gear is held by.
    row : StraightRow, optional
        Of the teeth of a rack; None: the teeth stand about the axis.
    """

    teeth: int
    half_thickness_angle: float
    sections: Sections
    root_radius: Callable[[Array], Array]
    fillet: Fillet
    largest_that_fits: bool = False
    held: Held = Bore()
    row: StraightRow | None = None

    def with_arc(self, radius: float) -> ToothForm:
        """The form with arcs of a radius [mm], at the mean section, instead of the fillet that belongs to the gear.

        Raises
        ------
        InputError
            If the radius is not positive and finite.
        """
        arc = replace(self.fillet, radius=radius) if isinstance(self.fillet, ArcFillet) else ArcFillet(radius)
        return replace(self, fillet=arc, largest_that_fits=False)


@dataclass(frozen=True)
class RootCylinder:
    """Root circles of a cylindrical gear.

    Parameters
    ----------
    radius : float [mm]
    """

    radius: float

    def __call__(self, coordinate: Array) -> Array:
        """Radius in every section (m,)."""
        return np.full(np.shape(coordinate), self.radius)


@dataclass(frozen=True)
class RootCone:
    r"""Root circles on spheres about the gear's apex, :math:`u = \delta_f - \arcsin(z_0 \sin\delta_f/R)`.

    Parameters
    ----------
    angle : float [rad]
        delta_f, between axis and cone.
    apex : float [mm]
        z_0, where the cone meets the axis, in the gear's own frame.
    """

    angle: float
    apex: float = 0.0

    def __call__(self, coordinate: Array) -> Array:
        """Radius 2 R tan(u/2) of the images (m,)."""
        cone_angle = self.angle - np.arcsin(self.apex * math.sin(self.angle) / coordinate)
        return 2.0 * coordinate * np.tan(0.5 * cone_angle)


class ToothGeometry(ABC):
    """The teeth of one gear by their equations; each family of gears has its subclass."""

    @property
    @abstractmethod
    def unmodified(self) -> ToothGeometry:
        """These teeth without modifications; equal ones have equal nominal flanks and forms."""

    @abstractmethod
    def nominal(self, side: int) -> Flank:
        """Flank of the side s = +1 or -1 without modifications, with Theta = 0 at the pitch point of mid-face."""

    @abstractmethod
    def modified(self, nominal: Flank) -> Flank:
        """A flank of :meth:`nominal` with the modifications of the gear.

        Raises
        ------
        InputError
            If a relief starts off the active profile, or is longer than half the face.
        """

    @abstractmethod
    def form(self) -> ToothForm:
        """All of a tooth but its flanks: thickness, root surface, fillet."""


@dataclass(frozen=True)
class InvoluteTooth(ToothGeometry):
    """Involute teeth of an external gear or a ring.

    Parameters
    ----------
    gear : InvoluteGear
    working_radius : float [mm]
        Radius of the working circle, where Theta = 0 at mid-face.
    active : ActiveProfile
        Over which profile modifications run.
    modifications : FlankModifications
    """

    gear: InvoluteGear
    working_radius: float
    active: ActiveProfile
    modifications: FlankModifications = FlankModifications()

    flank: ClassVar[type[InvoluteFlank]] = InvoluteFlank

    @property
    def unmodified(self) -> ToothGeometry:
        """These teeth without modifications."""
        return replace(self, modifications=FlankModifications())

    def nominal(self, side: int) -> Flank:
        """Involute flank of a side."""
        gear = self.gear
        radii = gear.form_radius, gear.tip_form_radius
        return self.flank(gear.base_radius, gear.base_helix_angle, side, self.working_radius, radii, gear.face_width)

    def modified(self, nominal: Flank) -> Flank:
        """The flank with its modifications; profile modifications run over the roll length."""
        return modified(
            nominal,
            self.modifications,
            self.gear.face_width,
            (2.0 * self.active.start_radius, 2.0 * self.active.end_radius),
            lambda diameter: self.gear.roll_length(0.5 * diameter) / nominal.profile_unit,
            owner=self.gear.name,
        )

    @property
    def half_thickness_angle(self) -> float:
        """Half the angle of a tooth at the working circle [rad]."""
        return 0.5 * self.gear.tooth_thickness_at(self.working_radius) / self.working_radius


@dataclass(frozen=True)
class CylindricalTooth(InvoluteTooth):
    """Involute teeth of a cylindrical gear, with the fillet that its basic rack cuts.

    Parameters
    ----------
    gear : CylindricalGear
    working_radius, active, modifications
        As of every ``InvoluteTooth``.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalMesh
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> mesh = CylindricalMesh(*gears)
    >>> form = CylindricalTooth(gears[0], mesh.pinion_working_radius, mesh.pinion_active_profile).form()
    >>> round(form.half_thickness_angle * 34, 6)  # without profile shift half a tooth is a quarter of a pitch
    1.570796
    """

    gear: CylindricalGear

    def form(self) -> ToothForm:
        """Transverse sections, root cylinder and the fillet of the rack."""
        root, fillet = RootCylinder(self.gear.root_radius), RackFillet(self.gear)
        return ToothForm(self.gear.teeth, self.half_thickness_angle, TransversePlanes(), root, fillet)


FILLET_RADIUS_COEFFICIENT = 0.38
"""Radius of the fillet of bevel gears in mean normal modules, as that of the basic rack of ISO 53, profile A."""


@dataclass(frozen=True)
class BevelTooth(ToothGeometry):
    """Spherical involute teeth of a bevel gear, with arcs as fillets.

    Parameters
    ----------
    gear : BevelGear
    active : (float, float) [rad]
        Cone angles between which profile modifications run.
    modifications : FlankModifications
    """

    gear: BevelGear
    active: tuple[float, float]
    modifications: FlankModifications = FlankModifications()

    @property
    def unmodified(self) -> ToothGeometry:
        """These teeth without modifications."""
        return replace(self, modifications=FlankModifications())

    def nominal(self, side: int) -> Flank:
        """Spherical involute flank of a side."""
        gear = self.gear
        (form, below), (face, above) = gear.cones
        return SphericalInvoluteFlank(
            gear.pitch_angle,
            gear.pressure_angle,
            gear.spiral_angle,
            side,
            (form, face),
            (gear.inner_cone_distance, gear.outer_cone_distance),
            (below, above),
            gear.calculation_distance,
            gear.cutter_circle,
        )

    def modified(self, nominal: Flank) -> Flank:
        """The flank with its modifications; profile modifications run over the unwound arc."""
        gear = self.gear
        return modified(
            nominal,
            self.modifications,
            gear.face_width,
            (gear.diameter_at(self.active[0]), gear.diameter_at(self.active[1])),
            lambda diameter: gear.unwound_arc(gear.cone_angle_at_diameter(diameter)),
            owner=gear.name,
        )

    def form(self) -> ToothForm:
        """Spheres about the apex, root cone, and arcs of 0.38 mean normal modules or the largest that fit."""
        gear = self.gear
        fillet = ArcFillet(FILLET_RADIUS_COEFFICIENT * gear.mean_normal_module, gear.mean_cone_distance)
        root = RootCone(gear.root_cone_angle if gear.root_angle is None else gear.root_angle, -gear.root_apex)
        return ToothForm(gear.teeth, gear.half_thickness_angle, ApexSpheres(), root, fillet, largest_that_fits=True)
