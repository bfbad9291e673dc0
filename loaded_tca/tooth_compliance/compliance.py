"""Compliance of the teeth and bodies of a gear pair, over all tooth pairs that carry load at the same time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.loaded_contact import LoadedContact
from loaded_tca.pair import GearPair
from loaded_tca.reference.weber_banaschek import ring_wind_up
from loaded_tca.tooth.form import ToothForm
from loaded_tca.tooth_compliance.body import GearTooth
from loaded_tca.tooth_compliance.influence import GearCompliance, LineForce, gear_compliance
from loaded_tca.tooth_compliance.layout import MeshDensity

LAYERS_PER_HEIGHT = 2.5
"""Layers of elements across a face as wide as the teeth are high; between the two numbers below."""
FEWEST_LAYERS, MOST_LAYERS = 6, 24
NAMES = ("pinion", "wheel")


@dataclass(frozen=True, eq=False)
class PairForce:
    """How the force of one tooth pair is spread over its line of contact.

    Attributes
    ----------
    pair : int
        Number of the tooth pair: 0 is the one at phi1, +1 the next one.
    pinion, wheel : (array, array) [mm]
        (rho, z) of the m places on either flank, each in its gear's own frame.
    distance : (m, m) array [mm]
        Between the places.
    weight : (m,) array
        Share of the force at each place; the sum is 1.
    """

    pair: int
    pinion: tuple[Array, Array]
    wheel: tuple[Array, Array]
    distance: Array
    weight: Array


def pair_force(pair: GearPair, number: int, points: Array, force: Array) -> PairForce:
    """Spread of a tooth pair's force from points in the fixed frame.

    Parameters
    ----------
    pair : GearPair
    number : int
        Of the tooth pair.
    points : (m, 3) array [mm]
        In the fixed frame, the gears turned by the pair's own angles; m cells or lines across the contact.
    force : (m,) array
        Force at each, in any unit, >= 0.

    Raises
    ------
    InputError
        If there is no force, one is negative or not finite, or the shapes do not fit.
    """
    points, force = np.asarray(points, dtype=float), np.asarray(force, dtype=float)
    problems = []
    if points.ndim != 2 or points.shape[1] != 3 or force.shape != points.shape[:1] or not np.isfinite(points).all():
        problems.append(f"points: finite (m, 3) and a force (m,) are needed, not {points.shape} and {force.shape}")
    if not (np.isfinite(force).all() and (force >= 0.0).all() and force.sum() > 0.0):
        problems.append("force: must be finite, nowhere negative, and positive somewhere")
    if problems:
        raise InputError(problems)
    loaded = force > 0.0
    points, force = points[loaded], force[loaded]
    distance = np.linalg.norm(points[:, None] - points, axis=-1)
    on_pinion, (radius, _, axial) = np.hypot(points[:, 0], points[:, 1]), pair.to_wheel(points)
    return PairForce(number, (on_pinion, points[:, 2]), (radius, axial), distance, force / force.sum())


def force_of_contact(pair: GearPair, number: int, loaded: LoadedContact) -> PairForce:
    """Spread of the force of a pressed contact along its longer axis; each cross-section acts in its middle.

    Without load: all of it at the contact point, where the first load will be.
    """
    pressure = loaded.solution.pressure
    force = pressure.sum(axis=0)
    if not force.any():
        return pair_force(pair, number, loaded.contact.point[None], np.ones(1))
    share = pressure / np.where(force > 0.0, force, 1.0)
    return pair_force(pair, number, np.einsum("xy,xyc->yc", share, loaded.separation.points), force)


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
    def wind_up(self) -> tuple[float, float]:
        """Of pinion and wheel: what the twist of the ring between bore and root adds, as a closed form [mm/N].

        It is a part of :meth:`matrix`, told to show what a bore diameter does; of bevel gears that of the mean section.
        """
        gears = zip((self.pinion, self.wheel), self.pair.base_radii, strict=True)
        return tuple(_wind_up(gear, base_radius) for gear, base_radius in gears)  # type: ignore[return-value]

    def matrix(self, pairs: Sequence[int], contacts: Sequence[LoadedContact]) -> Array:
        """Return :meth:`matrix_of` the forces of pressed contacts.

        Parameters
        ----------
        pairs : sequence of int, (n,)
            Numbers of the tooth pairs.
        contacts : sequence of LoadedContact, (n,)
            Pressed, each in its own angles: as if its pair were pair 0.

        Returns
        -------
        (n, n) array [mm/N]

        Raises
        ------
        InputError
            As :meth:`matrix_of`.
        """
        forces = [force_of_contact(self.pair, *one) for one in zip(pairs, contacts, strict=True)]
        return self.matrix_of(forces)

    def matrix_of(self, forces: Sequence[PairForce]) -> Array:
        """Displacement along the line of action at each tooth pair per normal force at each, both gears together.

        It comes on top of the approach of two half-spaces under the same forces: delta = approach(F) + C F.

        Parameters
        ----------
        forces : sequence of n PairForce
            Of different tooth pairs.

        Returns
        -------
        (n, n) array [mm/N]
            Symmetric. Row and column i belong to ``forces[i]``.

        Raises
        ------
        InputError
            If a tooth pair comes twice, two are further apart than the modelled teeth, or weights do not add up to 1.
        """
        numbers = [force.pair for force in forces]
        if len(set(numbers)) < len(numbers):
            raise InputError(f"forces: a tooth pair comes twice in {numbers}")
        sense = self.pair.sense
        spread = [(force.distance, force.weight) for force in forces]
        on_pinion = [LineForce(-sense * f.pair, *f.pinion, *also) for f, also in zip(forces, spread, strict=True)]
        on_wheel = [LineForce(sense * f.pair, *f.wheel, *also) for f, also in zip(forces, spread, strict=True)]
        return self.pinion.matrix(on_pinion) + self.wheel.matrix(on_wheel)


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
    >>> from loaded_tca.pair import cylindrical_pair
    >>> from loaded_tca.tooth import tooth_forms
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=10.0) for z in (25, 37)))
    >>> pair, backs = (cylindrical_pair(mesh, sense=sense) for sense in ("positive", "negative"))
    >>> compliance = tooth_compliance(tooth_forms(mesh), pair, backs)
    >>> along = np.array([[0.0, 0.0, z] for z in np.linspace(-4.5, 4.5, 10)])
    >>> points = trace_contact(pair, [0.0])[0].point * [1.0, 1.0, 0.0] + along
    >>> compliance.matrix_of([pair_force(pair, 0, points, np.ones(10))]).round(8)
    array([[4.24e-06]])
    """
    if pair.pinion.side == backs.pinion.side:
        raise InputError("backs: this pair touches with the same flanks; the one in the other sense is needed")
    both = sorted((pair, backs), key=lambda one: -one.pinion.side)
    flanks = (both[0].pinion, both[1].pinion), (both[0].wheel, both[1].wheel)
    gears = [GearTooth(*parts) for parts in zip(flanks, forms, pair.materials, bore_diameters, strict=True)]
    touching = (pair.pinion.side, pair.wheel.side)
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


def _wind_up(gear: GearCompliance, base_radius: float) -> float:
    """Displacement along the line of action per force [mm/N] by the twist of the ring."""
    nodes = gear.frame.nodes
    middle, width = len(nodes.coordinate) // 2, float(np.ptp(nodes.coordinate))
    radii, _ = nodes.sections.point(nodes.radius[0, [0, nodes.layout.base_row], middle], nodes.coordinate[middle])
    return base_radius**2 * ring_wind_up(float(radii[0]), float(radii[1]), gear.frame.gear.material) / width


def default_density(gear: GearTooth) -> MeshDensity:
    """Density whose layers follow the face width, in heights of the tooth."""
    rho, z = gear.flanks[0].grid(2, 2)
    coordinate = gear.form.sections.coordinate(rho, z)
    height = float(np.hypot(rho[1] - rho[0], z[1] - z[0]).mean())
    layers = round(LAYERS_PER_HEIGHT * float(np.ptp(coordinate)) / height)
    return MeshDensity(lengthwise=min(max(layers, FEWEST_LAYERS), MOST_LAYERS))
