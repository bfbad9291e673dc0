r"""Shafts on bearings: beams with shear, exact for loads at their nodes.

A section between two nodes is a beam of 12 degrees of freedom: axial force E A, torsion G I_p with I_p = 2 I, bending
in both planes with the shear deflection of Timoshenko, whose share is

.. math:: \Phi = \frac{12 E I}{\kappa G A L^2}, \qquad
          \kappa = \frac{6 (1+\nu)(1+m^2)^2}{(7+6\nu)(1+m^2)^2 + (20+12\nu) m^2}

for a ring of the inner over outer diameter m. Bearings are stiffnesses at nodes; the rotation about the axis is given
at one place. Motions at a node are x, y, z and the rotations about x, y, z, in the axes of the gear's own frame.

With rolling bearings the motions are those of the least potential energy, by Newton's method with halved steps; from
there on the shaft is linear.

References
----------
Przemieniecki 1968, Theory of Matrix Structural Analysis, section 5.6 (beam with shear); Cowper 1966, J. Appl. Mech. 33,
335-340 (shear coefficients).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, keep_copies
from loaded_tca.errors import InputError, require
from loaded_tca.material import Material
from loaded_tca.plain import plain
from loaded_tca.supports.bearing import AnyBearing, Bearing, Seat, balanced, solved

SAME_PLACE = 1e-9
"""Places closer than this over the length of the shaft are one node."""
FREE = 1e-10
"""Smallest eigenvalue of the stiffness of all bearings against motions of the whole shaft, with ones on its diagonal,
from which they hold it."""
TURNS = 1e-6
"""Part of a free motion from which it is a rotation; about a single bearing it moves the middle of the shaft, too."""
MOTIONS = "along x", "along y", "along its axis", "about x", "about y"
NO_THRUST = 1e-9
"""Of the forces on a shaft, the axial one that is none."""


@dataclass(frozen=True)
class ShaftSection:
    """A cylindrical part of a shaft, hollow or solid: length, outer and inner diameter [mm]."""

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0

    def __post_init__(self) -> None:
        require(
            (self.length > 0.0, f"length: found {plain(self.length, 6)} mm; allowed above 0"),
            (
                0.0 <= self.inner_diameter < self.outer_diameter,
                f"inner_diameter: found {plain(self.inner_diameter, 6)} mm; allowed from 0 to below the outer diameter "
                f"of {plain(self.outer_diameter, 6)} mm",
            ),
        )

    @property
    def area(self) -> float:
        """A [mm^2]."""
        return 0.25 * math.pi * (self.outer_diameter**2 - self.inner_diameter**2)

    @property
    def inertia(self) -> float:
        """Second moment of area I [mm^4]."""
        return math.pi / 64.0 * (self.outer_diameter**4 - self.inner_diameter**4)

    def shear_coefficient(self, poisson_ratio: float) -> float:
        """Kappa of the shear deflection after Cowper."""
        square = (self.inner_diameter / self.outer_diameter) ** 2
        ring = (1.0 + square) ** 2
        below = (7.0 + 6.0 * poisson_ratio) * ring + (20.0 + 12.0 * poisson_ratio) * square
        return 6.0 * (1.0 + poisson_ratio) * ring / below

    def stiffness(self, length: float, material: Material) -> Array:
        """Stiffness (12, 12) of a part of it of a length [mm], of the motions of its lower and its upper end."""
        modulus = material.youngs_modulus
        shear = 0.5 * modulus / (1.0 + material.poisson_ratio)
        matrix = np.zeros((12, 12))
        pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
        matrix[np.ix_((2, 8), (2, 8))] = modulus * self.area / length * pair
        matrix[np.ix_((5, 11), (5, 11))] = 2.0 * shear * self.inertia / length * pair
        softer = 12.0 * modulus * self.inertia
        softer /= self.shear_coefficient(material.poisson_ratio) * shear * self.area * length**2
        same, other, lever = (4.0 + softer) * length**2, (2.0 - softer) * length**2, 6.0 * length
        bending = np.array(
            [
                [12.0, lever, -12.0, lever],
                [lever, same, -lever, other],
                [-12.0, -lever, 12.0, -lever],
                [lever, other, -lever, same],
            ]
        )
        bending *= modulus * self.inertia / (length**3 * (1.0 + softer))
        matrix[np.ix_((0, 4, 6, 10), (0, 4, 6, 10))] = bending  # the slope dx/dz is the rotation about y
        signs = np.array([1.0, -1.0, 1.0, -1.0])  # and dy/dz that about x, against it
        matrix[np.ix_((1, 3, 7, 9), (1, 3, 7, 9))] = bending * np.outer(signs, signs)
        return matrix


@checked
@dataclass(frozen=True, eq=False)
class ShaftLoad:
    """A load of something else on the shaft: place [mm], and force and moment (6,) [N, N mm]."""

    at: float
    load: Array

    def __post_init__(self) -> None:
        keep_copies(self)


@checked
@dataclass(frozen=True, eq=False)
class Shaft:
    """A stepped shaft on bearings.

    Parameters
    ----------
    start : float [mm]
        Lower end, in the axial coordinate of the gear.
    sections : sequence of ShaftSection
        From there on.
    material : Material
    torque_at : float [mm]
        Where the rotation about the axis is given.
    bearings : sequence of Bearing or RollingBearing
    loads : sequence of ShaftLoad

    Raises
    ------
    InputError
        If something lies beside the shaft, or the bearings leave a motion of it free, which is named.

    Examples
    --------
    A force in the middle between two bearings that are nearly rigid:

    >>> held = [Bearing(at, np.diag([1e12, 1e12, 1e12, 0.0, 0.0, 0.0])) for at in (0.0, 200.0)]
    >>> shaft = Shaft(0.0, [ShaftSection(200.0, 20.0)], Material(206000.0, 0.3), 0.0, held)
    >>> round(float(shaft.compliance([100.0])[0, 0] * 1e6), 3)  # um/kN: F l^3/(48 E I) and shear
    105.279
    """

    start: float
    sections: Sequence[ShaftSection]
    material: Material
    torque_at: float
    bearings: Sequence[AnyBearing]
    loads: Sequence[ShaftLoad] = field(default_factory=tuple)

    def __post_init__(self) -> None:
        require((len(self.sections) > 0, "sections: none given; a shaft needs one at least"))
        places = {
            "torque_at": [self.torque_at],
            "bearings": [bearing.at for bearing in self.bearings],
            "loads": [load.at for load in self.loads],
        }
        self.require_on_shaft(places)
        self._require_held()

    @property
    def end(self) -> float:
        """Upper end [mm]."""
        return self.start + sum(section.length for section in self.sections)

    def require_on_shaft(self, places: dict[str, list[float]]) -> None:
        """Refuse places [mm] beside the shaft, by what is there."""
        slack = SAME_PLACE * (self.end - self.start)
        require(
            *(
                (
                    self.start - slack <= at <= self.end + slack,
                    f"{name}: at {plain(at, 6)} mm, beside the shaft, which goes from {plain(self.start, 6)} "
                    f"to {plain(self.end, 6)} mm",
                )
                for name, all_at in places.items()
                for at in all_at
            )
        )

    def _require_held(self) -> None:
        """Refuse bearings that let the shaft move as a rigid body, but for its rotation."""
        middle, length = 0.5 * (self.start + self.end), self.end - self.start
        scale = np.array([1.0, 1.0, 1.0, 1.0 / length, 1.0 / length])
        held = np.zeros((5, 5))
        for bearing in self.bearings:
            moved = np.zeros((6, 5))  # of the bearing's place by motions of the shaft as one body
            moved[range(5), range(5)] = 1.0
            moved[0, 4], moved[1, 3] = bearing.at - middle, middle - bearing.at
            moved = moved * scale
            held += moved.T @ bearing.joint @ moved
        roots = np.sqrt(held.diagonal())
        over = np.where(roots > 0.0, roots, 1.0)
        values, vectors = np.linalg.eigh(held / np.outer(over, over))
        if values[0] <= FREE:
            motion = np.abs(vectors[:, 0] / over)
            turns = motion[3:].max() > TURNS * motion.max()
            name = MOTIONS[3 + int(motion[3:].argmax()) if turns else int(motion.argmax())]
            leaves = "1 bearing leaves" if len(self.bearings) == 1 else f"{len(self.bearings)} bearings leave"
            raise InputError(
                f"bearings: {leaves} the shaft free {name}; allowed are bearings that hold it along x, y and its axis "
                "and against tilting about x and y"
            )

    def _nodes(self, places: Sequence[float]) -> Array:
        """Ascending places of all nodes."""
        borders = self.start + np.cumsum([0.0, *(section.length for section in self.sections)])
        others = [bearing.at for bearing in self.bearings] + [load.at for load in self.loads]
        every = np.sort(np.concatenate([borders, others, [self.torque_at], places]))
        return every[np.concatenate([[True], np.diff(every) > SAME_PLACE * (self.end - self.start)])]

    @property
    def is_linear(self) -> bool:
        """Whether it has linear bearings alone."""
        return all(isinstance(bearing, Bearing) for bearing in self.bearings)

    def solved(self, places: Sequence[float], under: Array | None = None) -> ShaftMotions:
        """How all nodes of the shaft move under unit loads at places [mm], and under its own loads.

        Parameters
        ----------
        places : sequence of float [mm]
        under : (6 m,) array, optional [N, N mm]
            Loads of the places near which the motions are linear; of account with rolling bearings only, whose motions
            under these loads are exact. Default: none.

        Raises
        ------
        InputError
            If a place lies beside the shaft, no bearing takes the thrust, or rolling bearings find no balance.
        """
        self.require_on_shaft({"gear": list(places)})
        nodes = self._nodes(places)

        def at(place: float) -> slice:
            k = int(np.abs(nodes - place).argmin())
            return slice(6 * k, 6 * k + 6)

        loads = np.zeros((6 * len(nodes), 6 * len(places) + 1))
        for n, place in enumerate(places):
            loads[at(place), 6 * n : 6 * n + 6] = np.eye(6)
        for load in self.loads:
            loads[at(load.at), -1] += load.load
        matrix, free = self._stiffness(nodes), np.delete(np.arange(6 * len(nodes)), at(self.torque_at).start + 5)
        seats = [Seat(bearing, at(bearing.at)) for bearing in self.bearings]
        given, moved = np.zeros(6 * len(places)) if under is None else under, np.zeros(6 * len(nodes))
        if self.is_linear:
            reactions = [seat.bearing.reaction(moved[seat.motions]) for seat in seats]
        else:
            whole = loads @ np.append(given, 1.0)
            self._require_thrust_taken(whole.reshape(-1, 6))
            moved, reactions = balanced(matrix, whole, free, seats)
        for seat, reaction in zip(seats, reactions, strict=True):
            matrix[seat.motions, seat.motions] += seat.stiffness(reaction)
        motions = solved(matrix, loads, free)
        if not self.is_linear:
            motions[:, -1] = moved - motions[:, :-1] @ given
        of_bearings = np.stack([motions[seat.motions] for seat in seats])
        forces = np.stack([reaction.tangent @ own for reaction, own in zip(reactions, of_bearings, strict=True)])
        if not self.is_linear:
            forces[..., -1] = np.stack([reaction.force for reaction in reactions]) - forces[..., :-1] @ given
        return ShaftMotions(
            nodes,
            motions.reshape(len(nodes), 6, -1),
            np.stack([motions[at(place)] for place in places]),
            forces,
            of_bearings,
        )

    def _stiffness(self, nodes: Array) -> Array:
        """Stiffness of the shaft itself (6 n, 6 n) over the motions of its nodes."""
        borders = self.start + np.cumsum([section.length for section in self.sections])
        matrix = np.zeros((6 * len(nodes), 6 * len(nodes)))
        for k, (low, high) in enumerate(pairwise(nodes.tolist())):
            section = self.sections[min(int(np.searchsorted(borders, 0.5 * (low + high))), len(self.sections) - 1)]
            matrix[6 * k : 6 * k + 12, 6 * k : 6 * k + 12] += section.stiffness(high - low, self.material)
        return matrix

    def _require_thrust_taken(self, loads: Array) -> None:
        """Refuse a force along z, of loads (n, 6) on all nodes, that every bearing lets go."""
        thrust = float(loads[:, 2].sum())
        wanted = int(np.sign(thrust))
        senses = {sense for bearing in self.bearings for sense in bearing.takes}
        require(
            (
                wanted in senses or abs(thrust) <= NO_THRUST * float(np.abs(loads[:, :3]).max()),
                f"bearings: none takes the axial force of {plain(thrust)} N; allowed are bearings of which one has "
                f"side = {wanted}, no contact angle, or an axial stiffness",
            )
        )

    def compliance(self, places: Sequence[float]) -> Array:
        """Motions (6 m, 6 m) [mm, rad] of m places [mm] under unit forces [N] and moments [N mm] there."""
        matrix = self.solved(places).at_places.reshape(6 * len(places), -1)[:, :-1]
        return np.asarray(0.5 * (matrix + matrix.T))


@dataclass(frozen=True, eq=False)
class ShaftMotions:
    """Motions of a shaft under unit loads at m places, in columns, and under its own loads, in the last one.

    Attributes
    ----------
    nodes : (n,) array [mm]
    at_nodes : (n, 6, 6 m + 1) array [mm, rad]
    at_places : (m, 6, 6 m + 1) array [mm, rad]
    on_bearings : (bearings, 6, 6 m + 1) array [N, N mm]
        Forces and moments on the bearings.
    at_bearings : (bearings, 6, 6 m + 1) array [mm, rad]
    """

    nodes: Array
    at_nodes: Array
    at_places: Array
    on_bearings: Array
    at_bearings: Array
