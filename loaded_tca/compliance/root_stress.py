r"""Stress at the roots of the teeth of one gear under forces on its flanks, by finite elements in space.

Root stress is linear in the forces of the contacts, so that one table holds it: stress at places of both fillets of a
tooth under unit forces all over the flanks in contact of the same tooth and of its neighbours. The mesh is that of the
tooth compliance but for thin layers below the surface: the layers of thick elements miss the largest stress by 5 to
14 %. Fillets are free surfaces, so that the strain of the surface gives the stress across the lengthwise lines of the
tooth, and no derivative across thin elements enters:

.. math:: \sigma_t = \frac{E}{1 - \nu^2} (\varepsilon_t + \nu \varepsilon_l)

It is found where quadratic elements have the strain best, at two places of each edge along the profile, and splines go
through these. Notches and the spread of the load along the face are part of it: no factor multiplies it.

References
----------
Barlow 1976, Optimal stress locations in finite element models, Int. J. Numer. Meth. Engng 10, 243-251.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import scipy
from numpy.polynomial.chebyshev import chebpts2, chebvander

from loaded_tca.apart import apart
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.body import FlankPlaces, ToothFrame, gear_body, gear_nodes
from loaded_tca.compliance.compliance import default_density, require_bending
from loaded_tca.compliance.finite_elements import Discretisation
from loaded_tca.compliance.flexibility import LEAST_LENGTHS, LENGTHS_PER_LAYER, key_of
from loaded_tca.compliance.geometry import BodyNodes, tangent_angles
from loaded_tca.compliance.influence import FlankLine, lagrange_coefficients, shares_of_grid
from loaded_tca.compliance.kept import MOST_IN_MEMORY, kept
from loaded_tca.compliance.layout import LARGEST_GRADING, MeshDensity
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.tooth.families import ToothGeometry
from loaded_tca.tooth.surface import Resolution, build_tooth

DENSITY = MeshDensity(through=8, flank=6, fillet=4, land=5, rim=6, neighbours=2, grading=2.5, skin=0.04 / math.pi)
"""Elements of a section: layers through the tooth of 1 : 2.5 : 6 : 16 from both flanks, the rim's uppermost layer of
0.04 modules."""
LAYER_OVER_RADIUS, THINNEST, SHARPEST = 0.2, 0.002, 0.05
"""Thickness of the outermost layers over the radius of a fillet that is so sharp that they are thinner than usual; the
least over the pitch; and the part of a fillet that may be sharper than that radius."""
STRAIGHT = 1e-9
"""Turn of the tangent between two places of a fillet that counts as none [rad]."""
OUTLINE = 257
"""Points along each flank and fillet between which nodes are drawn."""
BEST = 0.5 + np.array([-0.5, 0.5]) / math.sqrt(3.0)
"""Where along an edge quadratic elements have the strain best."""
HEIGHTS, LOWEST, OFFSET = 8, 0.03, 0.15
"""Places along the profile that are loaded: Chebyshev points of log(0.15 + h), h from 0.03 to 1. Stress under a force
changes the faster with its height the nearer it is to the fillet."""
HEIGHTS_BESIDE, LENGTHS_BESIDE = 5, 1.0
"""The same on the neighbours of a tooth, whose forces are further away, and places along the face for each layer."""
LEAST_ANGLE, TOP = math.radians(15.0), 0.125
"""Tangent angle and part of the fillet, as elements follow it, from which on stress is told: above either, a force low
on the flank has local stress, not bending."""
SINGLE_ERROR, HARDLY_COMPRESSIBLE = 5e-3, 2.5
"""Relative error of displacements up to which fronts are of single precision, and so many times 1 - 2 nu of it where
that is less: most of the error is a rotation of the whole tooth, and stress is within 2e-4 of its largest value
(``validation.loaded.root_stress_precision``)."""
STATIONS, PER_LAYER = 91, 4
"""Places along a fillet and in each layer of elements along the face, between which nothing is interpolated any more:
the largest of them is within 0.05 % of the maximum."""


@dataclass(frozen=True, eq=False)
class RootInfluence:
    """What finite elements say of the root stress of one gear.

    Attributes
    ----------
    stress : (2, n, m, a b) array [MPa/N]
        On the side of the flank in contact and on the back of tooth 0, at places along the profile and along the face,
        under unit forces on its own flank, at Chebyshev points of the range of log(0.15 + height) and of the face.
    stress_beside : (teeth, 2, n, m, c d) array [MPa/N]
        The same under forces at fewer places of the teeth ``-neighbours`` to ``+neighbours``; none on tooth 0.
    counts : (2, 2) int array
        a, b; c, d.
    along_face : (m,) array
        Parts of the face width, as :func:`read_planes` says.
    point : (2, n, m, 3) array [mm]
        In the frame of the tooth.
    tangent_angle : (2, n, m) array [rad]
        Between the profile of a section and the middle of the tooth.
    """

    stress: Array
    stress_beside: Array
    counts: Indices
    along_face: Array
    point: Array
    tangent_angle: Array


@checked
@dataclass(frozen=True, eq=False)
class RootStress:
    """Root stress of one gear, made once.

    Attributes
    ----------
    frame : ToothFrame
    table : RootInfluence
    """

    frame: ToothFrame
    table: RootInfluence

    @property
    def neighbours(self) -> int:
        """Teeth on either side of a loaded one whose stress is known."""
        return len(self.table.stress_beside) // 2

    @property
    def layer(self) -> float:
        """Mean width of the elements across the face [mm]."""
        return float(np.ptp(self.frame.nodes.coordinate)) / self.frame.nodes.layout.density.lengthwise

    @cached_property
    def tangent_angle(self) -> Array:
        """Between fillet and middle of the tooth at all places (2, stations, p) [rad]; first the flank in contact."""
        return self._at_places(self.table.tangent_angle[..., None])[0]

    @cached_property
    def point(self) -> Array:
        """All places (2, stations, p, 3) in the frame of the tooth [mm]."""
        return np.moveaxis(self._at_places(self.table.point), 0, -1)

    def stress(self, tooth: int, loads: Iterable[tuple[FlankLine, Array]]) -> Array:
        """Stress at the root of one tooth [MPa], tension positive.

        Parameters
        ----------
        tooth : int
            Tooth of the gear, counted in the sense of +theta.
        loads : iterable of (FlankLine, (m,) array)
            Places on flanks in contact, and the normal forces there [N]; those on teeth further away than the
            neighbours of the model leave no stress.

        Returns
        -------
        (2, stations, p) array
            On the side of the flank in contact and on the back; from a tangent angle of 15 degrees, or the end of the
            flank, down to the middle of the space; along the face, both ends included.
        """
        states = []
        for line, forces in loads:
            own, beside = self.forces_of_table(line, forces)
            states.append((line.tooth, own[None], beside[None]))
        return self.stresses(tooth, states)[0]

    def forces_of_table(self, line: FlankLine, forces: Array) -> tuple[Array, Array]:
        """Forces at the places of the table, (a b,) and (c d,), that stand for those at the places of a line.

        The first load the roots of their own tooth, the second those of its neighbours.
        """
        return forces @ self._shares(line, 0), forces @ self._shares(line, 1)

    def stresses(self, tooth: int, loads: Sequence[tuple[int, Array, Array]]) -> Array:
        """Stress at the root of one tooth in many states at once [MPa]: (states, 2, stations, p) as of :meth:`stress`.

        Parameters
        ----------
        tooth : int
        loads : sequence of (int, (states, a b) array, (states, c d) array)
            Loaded teeth, and what :meth:`forces_of_table` makes of the forces on them.
        """
        shape = self.table.stress.shape[:-1]
        total = np.zeros((math.prod(shape), len(loads[0][1]) if loads else 1))
        for loaded, *forces in loads:
            away = self._away(tooth, loaded)
            if abs(away) <= self.neighbours:
                stress = self._stress(away)
                total += stress.reshape(len(total), -1) @ forces[int(away != 0)].T
        return self._at_places(total.reshape(*shape, -1))

    def per_force(self, tooth: int, line: FlankLine, side: int, stations: Indices, along: Indices) -> Array:
        """Stress at some places of those of :meth:`stress` per force on a line [MPa/N].

        Parameters
        ----------
        tooth : int
        line : FlankLine
            m places.
        side : int
            0 that of the flank in contact, 1 the back.
        stations, along : (s,), (a,) int array
            Along the fillet and along the face.

        Returns
        -------
        (s, a, m) array
        """
        away = self._away(tooth, line.tooth)
        if abs(away) > self.neighbours:
            return np.zeros((len(stations), len(along), len(line.rho)))
        in_sections = self._along_profile[side][:, stations] @ self._stress(away)[side].swapaxes(0, 1)  # (m, s, q)
        of_table = np.tensordot(self._along_face[along], in_sections, 1)  # (a, s, q)
        return np.asarray((of_table @ self._shares(line, int(away != 0)).T).swapaxes(0, 1))

    def _away(self, tooth: int, loaded: int) -> int:
        """How many pitches a loaded tooth stands behind another."""
        teeth = self.frame.gear.form.teeth
        return (loaded - tooth + teeth // 2) % teeth - teeth // 2

    def _stress(self, away: int) -> Array:
        """Stress (2, n, m, q) under forces at the places of the table, on a tooth so many pitches away."""
        beside = [tooth for tooth in range(-self.neighbours, self.neighbours + 1) if tooth]
        return self.table.stress_beside[beside.index(away)] if away else self.table.stress

    def _shares(self, line: FlankLine, beside: int) -> Array:
        """Shares (places of a line, q) of the places of the table, those of neighbours if ``beside``."""
        height, length = self.frame.parts(line.rho, line.z)
        across, along = (
            chebvander(2.0 * part - 1.0, len(coefficients) - 1) @ coefficients
            for part, coefficients in zip((_part_of_range(height), length), self._interpolation[beside], strict=True)
        )
        return shares_of_grid(across, along)

    @cached_property
    def _interpolation(self) -> list[list[Array]]:
        """Chebyshev coefficients of the Lagrange polynomials of heights and lengths; of the places on neighbours."""
        return [[lagrange_coefficients(chebpts2(count)) for count in counts] for counts in self.table.counts]

    def _at_places(self, values: Array) -> Array:
        """Values (states, 2, stations, p) at all places, by splines between those of the table (2, n, m, states)."""
        in_sections = self._along_profile @ values.swapaxes(1, 2)  # (2, m, stations, states)
        return np.einsum("pm,smqt->tsqp", self._along_face, in_sections, optimize=True)

    @cached_property
    def _along_profile(self) -> Array:
        """Shares (2, m, stations, n) of the places of the table along the profile in the stations."""
        sides, n, m = self.table.tangent_angle.shape
        fillet = self.frame.nodes.layout.density.fillet
        shares = np.empty((sides, m, STATIONS, n))
        for side in range(sides):
            for k in range(m):
                steps = np.linalg.norm(np.diff(self.table.point[side, :, k], axis=0), axis=1)
                arc = np.append(0.0, np.cumsum(steps))
                start = first_told(arc, self.table.tangent_angle[side, :, k], fillet)
                shares[side, k] = scipy.interpolate.CubicSpline(arc, np.eye(n))(np.linspace(start, arc[-1], STATIONS))
        return shares

    @cached_property
    def _along_face(self) -> Array:
        """Shares (p, m) of the places of the table along the face in all places along it."""
        known = self.table.along_face
        wanted = np.linspace(0.0, 1.0, PER_LAYER * self.frame.nodes.layout.density.lengthwise + 1)
        return np.asarray(scipy.interpolate.CubicSpline(known, np.eye(len(known)))(wanted))


def root_stress_model(gear: Gear, density: MeshDensity | None = None) -> RootStress:
    """Root stress of a gear body under unit forces all over its flanks, computed or from the kept models.

    Gears whose flanks differ in their modifications alone share one model: the last few are kept in memory, more of
    them on disk, as those of the tooth compliance.

    Parameters
    ----------
    gear : Gear
    density : MeshDensity, optional
        Default: thin layers below the surface, and as many across the face as its width asks for.

    Raises
    ------
    InputError
        If the bore reaches the teeth, Poisson's ratio is above 0.49, or the machine has not the memory.
    GeometryError
        If the tooth is pointed or cut off, or the mesh is turned inside out.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=10.0) for z in (25, 37)))
    >>> roots = root_stress_model(cylindrical_pair(mesh).pinion)
    >>> line = FlankLine(0, np.full(9, 37.978), np.linspace(-4.0, 4.0, 9))  # highest point of single contact
    >>> stress = roots.stress(0, [(line, np.full(9, 1000.0 / 9.0))])  # 1000 N
    >>> tension = stress[0].max()
    >>> round(float(tension), -1)  # MPa
    90.0
    """
    require_bending(gear.material)
    density = density or stress_density(gear)
    return _model(gear.geometry.unmodified, gear.flank.side, gear.material, gear.bore_diameter, density)


def stress_density(gear: Gear) -> MeshDensity:
    """Thin layers below the surface, and as many across the face as its width asks for, thin ones at its ends.

    Sharp fillets have thinner layers, a part of their radius.
    """
    layers = 2 * math.ceil(0.5 * default_density(gear).lengthwise) + 2
    density = replace(DENSITY, lengthwise=layers, thin_ends=True)
    skin = round(min(DENSITY.skin, max(LAYER_OVER_RADIUS * sharpest(gear.geometry.unmodified), THINNEST)), 6)
    if skin > 0.99 * DENSITY.skin:
        return density
    powers = np.arange(DENSITY.through // 2)
    thinner = (DENSITY.grading**powers).sum() * DENSITY.skin / skin  # half the tooth over its outermost layer
    grading = scipy.optimize.brentq(lambda grading: (grading**powers).sum() - thinner, 1.0, LARGEST_GRADING)
    return replace(density, skin=skin, grading=round(grading, 6))


@lru_cache(maxsize=MOST_IN_MEMORY)
def sharpest(teeth: ToothGeometry) -> float:
    """Smallest radius of both fillets in all sections, over the pitch along the root circle."""
    form, resolution = teeth.form(), Resolution(flank=9, fillet=129, land=3, lengthwise=5)
    tooth = build_tooth((teeth.nominal(1), teeth.nominal(-1)), form, resolution)
    x, y, z = np.moveaxis(tooth.outline, -1, 0)
    radius = form.sections.radius(np.hypot(x, y), z)
    place = radius * np.exp(1j * np.arctan2(y, x))
    radii = []
    for first, last in (tooth.joints[1:3], tooth.joints[5:7]):
        step = np.diff(place[first : last + 1], axis=0)
        turn = np.abs(np.angle(step[1:] / step[:-1]))
        radii.append(np.quantile(np.abs(step[1:]) / np.maximum(turn, STRAIGHT), SHARPEST, axis=0))
    return float((np.array(radii) / (2.0 * math.pi / tooth.teeth * radius[0])).min())


@lru_cache(maxsize=MOST_IN_MEMORY)
def _model(
    teeth: ToothGeometry, side: int, material: Material, bore_diameter: float | None, density: MeshDensity
) -> RootStress:
    """Root stress of a gear without modifications, by all that it is made of: whose are equal share one model."""
    gear = Gear.of(teeth, side, material, bore_diameter)
    frame = ToothFrame(gear, gear_nodes(gear, density, OUTLINE))
    key = key_of(frame, _loaded_places(frame, False)[-1], "root stress ")
    return RootStress(frame, kept(key, RootInfluence, lambda: apart(root_influence, frame)))


def _loaded_places(frame: ToothFrame, beside: bool) -> tuple[int, int, FlankPlaces]:
    """How many heights a and lengths b the table has, and the places (a b) that they make on a flank."""
    layers = frame.nodes.layout.density.lengthwise
    heights = HEIGHTS_BESIDE if beside else HEIGHTS
    lengths = max(LEAST_LENGTHS, math.ceil((LENGTHS_BESIDE if beside else LENGTHS_PER_LAYER) * layers))
    low, high = (math.log(OFFSET + height) for height in (LOWEST, 1.0))
    parts = np.minimum(np.exp(low + (0.5 + 0.5 * chebpts2(heights)) * (high - low)) - OFFSET, 1.0)
    grid = np.meshgrid(parts, 0.5 + 0.5 * chebpts2(lengths), indexing="ij")
    return heights, lengths, frame.places(*(part.ravel() for part in grid))


def _part_of_range(height: Array) -> Array:
    """Where heights (m,) lie in the range of log(0.15 + height)."""
    low, high = (math.log(OFFSET + end) for end in (LOWEST, 1.0))
    return (np.log(OFFSET + np.maximum(height, LOWEST)) - low) / (high - low)


def root_influence(frame: ToothFrame, *, single: bool = True) -> RootInfluence:
    """Load a gear body by unit forces all over its flanks in contact.

    Parameters
    ----------
    frame : ToothFrame
        With thin layers below the surface.
    single : bool
        Whether fronts may be of single precision where the body lets them.
    """
    material = frame.gear.material
    allowed = SINGLE_ERROR * min(1.0, HARDLY_COMPRESSIBLE * (1.0 - 2.0 * material.poisson_ratio))
    mesh, factor = gear_body(frame.nodes, material, allowed if single else 0.0)
    near, size = frame.nodes.layout.neighbours, len(mesh.points)
    *count, own = _loaded_places(frame, False)
    *count_beside, other = _loaded_places(frame, True)
    loads = [frame.on_flank(own, mesh.number).along(-own.normal, size)]
    loads += [
        frame.on_flank(other, mesh.number, tooth).along(-other.normal, size)
        for tooth in range(-near, near + 1)
        if tooth
    ]
    along_face = frame.face_parts[read_planes(frame.nodes.layout.density.lengthwise)]
    sides = [surface_places(mesh, frame.nodes, side, frame.gear.material) for side in (frame.side, -frame.side)]
    point, angle = np.stack([side[0] for side in sides]), np.stack([side[2] for side in sides])
    readings = scipy.sparse.vstack([rows for _, rows, _ in sides], format="csr")
    stress = factor.flexibility(scipy.sparse.vstack(loads, format="csr"), readings)
    stress = stress.reshape(2, len(along_face), -1, stress.shape[1]).swapaxes(1, 2)
    split = len(own.height)
    beside = stress[..., split:].reshape(*stress.shape[:-1], 2 * near, -1)
    return RootInfluence(
        np.ascontiguousarray(stress[..., :split]),
        np.ascontiguousarray(np.moveaxis(beside, -2, 0)),
        np.array([count, count_beside]),
        along_face,
        point,
        angle,
    )


def read_planes(layers: int) -> Indices:
    """Numbers (m,) of the sections of nodes in which stress is read, of layers of elements along the face.

    The ends, the middles of all layers, and where the outermost layers end: beside the ends stress rises and falls
    within two layers, and splines between middles alone miss its maximum there by 2 to 3 %.
    """
    return np.unique(np.concatenate([[0, 2, 2 * layers - 2, 2 * layers], np.arange(1, 2 * layers, 2)]))


def surface_places(
    mesh: Discretisation, nodes: BodyNodes, side: int, material: Material
) -> tuple[Array, scipy.sparse.csr_array, Array]:
    """Places where the stress of one side of tooth 0 is read: from the end of its flank to the middle of the space.

    Returns
    -------
    (n, m, 3) array [mm]
    (m n, 3 nodes) sparse array [MPa/mm]
        Stress of displacements.
    (n, m) array [rad]
        Tangent angles.
    """
    lowest, ends = nodes.layout.foot(side)
    layers = nodes.layout.density.lengthwise
    plane = read_planes(layers)
    layer = (plane - (plane > layers)) // 2  # between two of them, the one further from the end
    local = 0.5 * plane - layer
    edge, spot = np.divmod(np.arange(2 * len(lowest)), 2)
    edge, part = np.append(edge, edge[-1]), np.append(BEST[spot], 1.0)  # last the middle of the space itself
    number = np.full((*mesh.number.shape[:2], 2 * layers), -1)
    number[tuple(mesh.lowest.T)] = np.arange(len(mesh.lowest))
    elements = number[lowest[edge, 0], lowest[edge, 1]][:, 2 * layer].T  # (m, n)
    in_section = ends[edge, 0] + part[:, None] * (ends[edge, 1] - ends[edge, 0])  # (n, 2)
    m, n = elements.shape
    spots = np.concatenate([np.tile(in_section, (m, 1)), np.repeat(local, n)[:, None]], axis=1)
    along = np.abs(ends[edge, 1] - ends[edge, 0]).argmax(axis=1)
    point, rows = mesh.free_surface_stress(elements.ravel(), spots, np.tile(along, m), material)
    angle = tangent_angles(nodes, side, lowest[edge], ends[edge], part, plane)
    return point.reshape(m, n, 3).transpose(1, 0, 2), rows, angle


def first_told(arc: Array, angle: Array, fillet: int) -> float:
    """Length along the profile from which on stress is told, of lengths (n,) and tangent angles (n,) of the places.

    ``fillet`` elements are on the upper half of the fillet, two places on each.
    """
    edge = np.arange(2 * fillet)
    start = float(np.interp(2.0 * TOP * fillet, edge // 2 + BEST[edge % 2], arc[: 2 * fillet]))
    low = np.flatnonzero(angle < LEAST_ANGLE)
    if not low.size:
        return start
    last = min(int(low[-1]), len(arc) - 2)
    return max(start, float(np.interp(LEAST_ANGLE, angle[last : last + 2], arc[last : last + 2])))
