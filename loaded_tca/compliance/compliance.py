"""Compliance of the teeth and bodies of a gear pair, over all tooth pairs that carry load at the same time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance.body import GearTooth
from loaded_tca.compliance.influence import FlankLine, GearCompliance, Image, gear_compliance
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.contact.edges import FreeEdge, edge_images
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.weber_banaschek import ring_torsion
from loaded_tca.scene import Scene
from loaded_tca.separation import Separation
from loaded_tca.tooth import tooth_forms
from loaded_tca.tooth.form import ToothForm

LAYERS_PER_HEIGHT = 2.5
"""Layers of elements across a face as wide as the teeth are high; between the two numbers below."""
FEWEST_LAYERS, MOST_LAYERS = 6, 24
NAMES = ("pinion", "wheel")
BORE = "bore_diameter_mm"
"""Key of a gear that each family of scenes has of its own."""


@dataclass(frozen=True, eq=False)
class ToothCompliance:
    """Bending, shear and foundation of both gears, beside the half-spaces of the contact solver.

    Attributes
    ----------
    pair : GearPair
    pinion, wheel : GearCompliance
    """

    pair: GearPair
    pinion: GearCompliance
    wheel: GearCompliance

    @property
    def bore_diameters(self) -> tuple[float, float]:
        """Diameters held rigid [mm], as given or by default (of a bevel gear by default: at the toe)."""
        return self.pinion.frame.nodes.bore_diameter, self.wheel.frame.nodes.bore_diameter

    @property
    def body_torsion(self) -> tuple[float, float]:
        """Twist of the gear body between bore and root of pinion and wheel, in closed form [mm/N].

        It is a part of :meth:`within`, told to show what a bore diameter does; of bevel gears that of the mean section.
        """
        gears = zip((self.pinion, self.wheel), self.pair.base_radii, strict=True)
        return tuple(_body_torsion(gear, base_radius) for gear, base_radius in gears)  # type: ignore[return-value]

    def within(self, number: int, separation: Separation, edges: Sequence[FreeEdge] = ()) -> Array:
        """Deflection of every slice of a contact's grid per force on each, both gears together.

        It comes on top of the displacement of the two half-spaces that carry the same pressures.

        Parameters
        ----------
        number : int
            Of the tooth pair: 0 is in contact at the pitch point at phi1 = 0, +1 comes into mesh after it.
        separation : Separation
            Grid of its contact, in the angles of its own tooth: as if it were pair 0.
        edges : sequence of FreeEdge
            For which the half-spaces are corrected.

        Returns
        -------
        (ny, ny) array [mm/N]
            Symmetric.
        """
        along = separation.y
        distance, images = np.abs(along[:, None] - along), _images(separation, edges)
        lines = zip((self.pinion, self.wheel), self._lines(number, separation), strict=True)
        pinion, wheel = (gear.within(line, distance, images) for gear, line in lines)
        return np.asarray(pinion + wheel)

    def between(self, at: tuple[int, Separation], under: tuple[int, Separation]) -> Array:
        """Deflection of every slice of one contact's grid per force on each slice of another's.

        Parameters
        ----------
        at, under : (int, Separation)
            Numbers of two different tooth pairs and grids of their contacts, as in :meth:`within`.

        Returns
        -------
        (m, n) array [mm/N]
            Its transpose is that of ``between(under, at)``.

        Raises
        ------
        InputError
            If the pairs are further apart than the modelled teeth.
        """
        there, here = self._lines(*at), self._lines(*under)
        return self.pinion.between(there[0], here[0]) + self.wheel.between(there[1], here[1])

    def _lines(self, number: int, separation: Separation) -> tuple[FlankLine, FlankLine]:
        """Middles of the slices of a grid on both flanks."""
        points = separation.origin + separation.y[:, None] * separation.axes[1]
        radius, _, axial = self.pair.to_wheel(points)
        tooth = self.pair.sense * number
        on_pinion = FlankLine(-tooth, np.hypot(points[:, 0], points[:, 1]), points[:, 2])
        return on_pinion, FlankLine(tooth, radius, axial)


def _images(separation: Separation, edges: Sequence[FreeEdge]) -> list[Image]:
    """Distances (ny, ny) of the middles of slices from their images in free edges, and the factors of these."""
    half_across, half_along = separation.half_lengths
    found = []
    for chosen in edge_images(edges):
        across: Array | float = 0.0
        along = separation.y
        for edge in chosen:
            if edge.axis == 0:
                place = edge.position - half_across + edge.slope * (separation.y + half_along)
                across = place[:, None] + place
            else:
                along = 2.0 * (edge.position - half_along) - along
        factor = math.prod(edge.factor for edge in chosen)
        found.append((np.hypot(across, separation.y[:, None] - along), factor))
    return found


def tooth_compliance(
    forms: tuple[ToothForm, ToothForm],
    pair: GearPair,
    backs: GearPair,
    *,
    bore_diameters: tuple[float | None, float | None] = (None, None),
    neighbours: int = 1,
    density: MeshDensity | None = None,
) -> ToothCompliance:
    """Make the finite element models of both gears.

    Parameters
    ----------
    forms : (ToothForm, ToothForm)
        Of pinion and wheel, see :func:`loaded_tca.tooth.tooth_forms`.
    pair : GearPair
    backs : GearPair
        The same gears in contact with their other flanks: the pair in the other sense of rotation.
    bore_diameters : (float or None, float or None) [mm]
        Held rigid; None: 0.55 of the root diameter.
    neighbours : int
        How many pitches two loaded tooth pairs may be apart.
    density : MeshDensity, optional
        Default: 4 elements through the tooth, 6 up the flank, and as many across the face as its width asks for.

    Raises
    ------
    InputError
        If both pairs touch with the same flanks, or a bore reaches the teeth; the gear is named.
    GeometryError
        If a tooth is pointed or cut off; the gear is named.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.separation import sample_separation
    >>> from loaded_tca.tooth import tooth_forms
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=10.0) for z in (25, 37)))
    >>> pair, backs = (cylindrical_pair(mesh, sense=sense) for sense in ("positive", "negative"))
    >>> compliance = tooth_compliance(tooth_forms(mesh), pair, backs)
    >>> separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(4, 10), box=(0.2, 5.0))
    >>> float(compliance.within(0, separation).mean().round(8))  # of an even force
    4.23e-06
    """
    if pair.pinion.flank.side == backs.pinion.flank.side:
        raise InputError("backs: this pair touches with the same flanks; the one in the other sense is needed")
    both = sorted((pair, backs), key=lambda one: -one.pinion.flank.side)
    flanks = (both[0].pinion.flank, both[1].pinion.flank), (both[0].wheel.flank, both[1].wheel.flank)
    gears = [
        GearTooth(*parts)
        for parts in zip(flanks, forms, (pair.pinion.material, pair.wheel.material), bore_diameters, strict=True)
    ]
    touching = (pair.pinion.flank.side, pair.wheel.flank.side)
    found = []
    for name, gear, side in zip(NAMES, gears, touching, strict=True):
        try:
            chosen = replace(density or default_density(gear), neighbours=neighbours)
            found.append(gear_compliance(gear, side, chosen))
        except InputError as error:
            raise InputError(f"{name}: {problem}" for problem in error.problems) from None
        except GeometryError as error:
            raise GeometryError(f"{name}: {error}") from None
    return ToothCompliance(pair, *found)


def _body_torsion(gear: GearCompliance, base_radius: float) -> float:
    """Displacement along the line of action per force [mm/N] by the twist of the ring."""
    nodes = gear.frame.nodes
    middle, width = len(nodes.coordinate) // 2, float(np.ptp(nodes.coordinate))
    radii, _ = nodes.sections.point(nodes.radius[0, [0, nodes.layout.base_row], middle], nodes.coordinate[middle])
    return base_radius**2 * ring_torsion(float(radii[0]), float(radii[1]), gear.frame.gear.material) / width


def default_density(gear: GearTooth) -> MeshDensity:
    """Density whose layers follow the face width, in heights of the tooth."""
    rho, z = gear.flanks[0].grid(2, 2)
    coordinate = gear.form.sections.coordinate(rho, z)
    height = float(np.hypot(rho[1] - rho[0], z[1] - z[0]).mean())
    layers = round(LAYERS_PER_HEIGHT * float(np.ptp(coordinate)) / height)
    return MeshDensity(lengthwise=min(max(layers, FEWEST_LAYERS), MOST_LAYERS))


GEARS = ("pinion", "wheel")


def rigid_bores(scene: Scene) -> tuple[float, float] | None:
    """Bore diameters of pinion and wheel [mm], given or by default; the smallest one of a cone.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    (float, float) or None
        None where the scene does not ask for teeth that bend: no bore is held then.

    Raises
    ------
    InputError
        If a bore leaves no rim below the teeth, as the analysis would; every gear that it holds for is named.
    GeometryError
        If a tooth is pointed or cut off.

    Examples
    --------
    >>> from loaded_tca.scene import parse_scene
    >>> scene = parse_scene('''
    ... pair = {type = "cylindrical", normal_module_mm = 3.0}
    ... pinion = {teeth = 25, face_width_mm = 20.0}
    ... wheel = {teeth = 37, face_width_mm = 20.0, bore_diameter_mm = 40.0}
    ... material = {youngs_modulus_MPa = 206000.0, poisson_ratio = 0.3}
    ... load = {pinion_torque_Nm = 40.0}
    ... analysis = {load_sharing = true, compliance = "contact+tooth"}''')
    >>> [round(bore, 3) for bore in rigid_bores(scene)]
    [37.125, 40.0]
    """
    if scene.analysis.compliance == "contact":
        return None
    pair = scene.pair()
    both = sorted(
        (pair, scene.pair("negative" if pair.sense > 0 else "positive")), key=lambda one: -one.pinion.flank.side
    )
    forms, problems, bores = tooth_forms(scene.mesh()), [], []
    for member, name in enumerate(GEARS):
        given: float | None = getattr(getattr(scene, name), BORE)
        flanks = getattr(both[0], name).flank, getattr(both[1], name).flank
        try:
            tooth = GearTooth(flanks, forms[member], getattr(pair, name).material, given)
            bores.append(tooth.nodes(MeshDensity()).bore_diameter)
        except InputError as error:
            problems += [f"{name}: {problem}" for problem in error.problems]
    if problems:
        raise InputError(problems)
    return bores[0], bores[1]
