r"""Supports: the motions of both gears under the forces on their teeth, and what these do to the gaps.

A gear has stations on its axis, one if it moves as a whole. A unit normal force at slice i loads the stations by a_i
(6 numbers each): the force -n on the pinion, +n on the wheel, and the moment (p_i - station) x force, the share of each
station linear between them. Under the loads W = sum of a_j f_j the stations of a gear move by

.. math:: q = C W + q_0,

q_0 by other loads on its shaft, and the gap of slice i grows by a_i . q. So every slice gives way under a unit force
on any other one, of whichever tooth pair, by

.. math:: a_i^{T} C a_j,

of pinion and wheel together: a symmetric compliance of low rank. All loads and motions of a gear are in the axes of its
own frame, which do not turn with it; the grid of a contact lies in its true place in space, whatever the number of its
tooth pair.

References
----------
Przemieniecki 1968, Theory of Matrix Structural Analysis, chapter 6 (flexibilities of supported structures).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, keep_copies
from loaded_tca.errors import require
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair, MovedSlices
from loaded_tca.supports.bearing import AnyBearing

AXIS = np.array([0.0, 0.0, 1.0])
KEPT = 256
"""Grids whose loads are kept, since a balance asks for them again and again."""


@checked
@dataclass(frozen=True, eq=False)
class Support:
    """What holds a gear, in the axes of its own frame.

    Parameters
    ----------
    middle : float [mm]
        Axial coordinate of the middle of the face, whose motion is that of the gear.
    compliance : (6 m, 6 m) array [mm, rad, N, N mm]
        Motions of the stations under forces and moments on them: x, y, z, about x, y, z of each; symmetric.
    stations : (m,) array, optional [mm]
        Axial coordinates, ascending; default: the middle alone.
    motion : (6 m,) array, optional [mm, rad]
        Motions of the stations without any force on the teeth; default: none.
    on_bearings : (bearings, 6, 6 m + 1) array, optional [N, N mm]
        Forces and moments on bearings under unit loads of the stations, in columns, and under other loads.
    at_bearings : (bearings, 6, 6 m + 1) array, optional [mm, rad]
        Motions of the shaft in its bearings, as the forces on them.
    bearings : sequence of bearings
        Of its shaft.
    law : callable, optional
        Makes the support that is linear near loads (6 m,) of the stations, with their exact motions, as rolling
        bearings need it; default: this one is linear.

    Raises
    ------
    InputError
        If the shapes do not fit each other.

    Examples
    --------
    >>> support = Support(0.0, np.diag([1e-5, 1e-5, 0.0, 0.0, 0.0, 0.0]))
    >>> support.at_middle(support.moved(np.array([100.0, 0.0, 0.0, 0.0, 0.0, 0.0])))[:2]
    array([0.001, 0.   ])
    """

    middle: float
    compliance: Array
    stations: Array | None = None
    motion: Array | None = None
    on_bearings: Array | None = None
    at_bearings: Array | None = None
    bearings: Sequence[AnyBearing] = ()
    law: Callable[[Array], Support] | None = None

    def __post_init__(self) -> None:
        size = 6 * len(self.places)
        shape = () if self.motion is None else self.motion.shape
        require(
            (
                self.compliance.shape == (size, size),
                f"compliance: shape {self.compliance.shape}, expected {size} twice",
            ),
            (shape in ((), (size,)), f"motion: shape {shape}, expected ({size},)"),
        )
        keep_copies(self)

    @property
    def places(self) -> Array:
        """Axial coordinates of the stations (m,) [mm]."""
        return np.array([self.middle]) if self.stations is None else self.stations

    def linear_near(self, loads: Array) -> Support:
        """The support that is linear near loads (6 m,) of the stations; itself if it is linear."""
        return self if self.law is None else self.law(loads)

    @property
    def at_rest(self) -> Array:
        """Motions of the stations (6 m,) [mm, rad] under other loads alone."""
        unloaded = np.zeros(len(self.compliance))
        return self.linear_near(unloaded).moved(unloaded)

    def moved(self, loads: Array) -> Array:
        """Motions of the stations (6 m,) [mm, rad] under loads (6 m,) [N, N mm] beside the other ones."""
        moved = self.compliance @ loads
        return np.asarray(moved if self.motion is None else moved + self.motion)

    def bearing_forces(self, loads: Array) -> Array:
        """Forces and moments on the bearings (bearings, 6) [N, N mm] under loads (6 m,), other loads included."""
        assert self.on_bearings is not None
        return np.asarray(self.on_bearings @ np.append(loads, 1.0))

    def bearing_motions(self, loads: Array) -> Array:
        """Motions of the shaft in its bearings (bearings, 6) [mm, rad] under loads (6 m,), other loads included."""
        assert self.at_bearings is not None
        return np.asarray(self.at_bearings @ np.append(loads, 1.0))

    def at_middle(self, motions: Array) -> Array:
        """Motion (6,) of the middle of the face by those of the stations (6 m,)."""
        return np.asarray(self.shares(np.array([self.middle]))[0] @ motions.reshape(-1, 6))

    def with_middle(self, motion: Array) -> Array:
        """Motions of the stations (6 m,) on a rigid body whose middle of the face moves by (6,)."""
        moved = np.tile(motion, (len(self.places), 1))
        beyond = self.places - self.middle
        moved[:, 0] += motion[4] * beyond
        moved[:, 1] -= motion[3] * beyond
        return moved.ravel()

    def shares(self, axial: Array) -> Array:
        """Shares (n, m) of the stations in forces at axial coordinates (n,) [mm]; all of the last one beyond it."""
        numbers = np.arange(len(self.places))
        return np.maximum(1.0 - np.abs(np.interp(axial, self.places, numbers)[:, None] - numbers), 0.0)

    def loads(self, points: Array, force: Array) -> Array:
        """Loads (n, 6 m) on the stations by a force (3,) [N] at each of points (n, 3) [mm] of the gear's own frame."""
        x, y, z = force
        turning = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])  # points @ turning: points x force
        loads = np.empty((len(points), len(self.places), 6))
        loads[..., :3] = force
        loads[..., 3:] = (points @ turning)[:, None]
        loads[..., 3] += self.places * y
        loads[..., 4] -= self.places * x
        if len(self.places) > 1:
            loads *= self.shares(points[:, 2])[..., None]
        return loads.reshape(len(points), -1)


def rotation(vector: Array) -> Array:
    """Matrix (3, 3) of the rotation by a vector [rad] (Rodrigues).

    Examples
    --------
    >>> rotation(np.array([0.0, 0.0, np.pi / 2])).round(12) @ [1.0, 0.0, 0.0]
    array([0., 1., 0.])
    """
    angle = float(np.linalg.norm(vector))
    x, y, z = vector
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    first, second = np.sinc(angle / np.pi), 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
    return np.asarray(np.eye(3) + first * cross + second * cross @ cross)


def moved_pair(pair: GearPair, supports: tuple[Support, Support], motions: Sequence[Array]) -> GearPair:
    """The pair whose gears have moved as rigid bodies; the fixed frame stays with the pinion.

    Parameters
    ----------
    pair : GearPair
    supports : (Support, Support)
        Of pinion and wheel.
    motions : two arrays (6,) [mm, rad]
        Of the middles of the faces of pinion and wheel, in the axes of each gear's own frame.

    Examples
    --------
    A wheel that moves along its own x by 0.1 mm comes nearer:

    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> pair, rigid = parse_scene(DEMO_SCENE.read_text()).pair(), Support(0.0, np.zeros((6, 6)))
    >>> nearer = moved_pair(pair, (rigid, rigid), [np.zeros(6), np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0])])
    >>> (nearer.wheel_origin - pair.wheel_origin).round(9) + 0.0
    array([-0.1,  0. ,  0. ])
    """
    (pinion, wheel), axes = motions, pair.wheel_axes
    on_pinion, on_wheel = (support.middle * AXIS for support in supports)
    turn, own_turn = rotation(pinion[3:]), rotation(wheel[3:])
    origin = pair.wheel_origin + (on_wheel + wheel[:3] - own_turn @ on_wheel) @ axes
    moved_axes = own_turn.T @ axes  # rows: the turned axes, in the fixed frame
    return replace(
        pair,
        wheel_origin=(origin - on_pinion - pinion[:3]) @ turn + on_pinion,
        wheel_axes=moved_axes @ turn,
    )


@checked
@dataclass(frozen=True, eq=False)
class SupportCompliance:
    """The part of a bending model that is the supports of both gears.

    Attributes
    ----------
    pair : GearPair
        As its gears stand.
    supports : (Support, Support)
        Of pinion and wheel.
    axes : (2, 3, 3) array
        Axes of the own frames of both gears at rest, in rows, in the fixed frame of the pair: where the gears have
        moved, that turns with the pinion.
    """

    pair: GearPair
    supports: tuple[Support, Support]
    axes: Array
    _loads: dict[int, tuple[ContactGrid, tuple[Array, Array]]] = field(default_factory=dict, init=False, repr=False)

    @property
    def neighbours(self) -> int:
        """How many pitches two loaded tooth pairs may be apart: supports know no teeth."""
        return max(self.pair.teeth)

    def mounted(self, pair: GearPair) -> SupportCompliance:
        """These supports in a pair whose wheel stands elsewhere."""
        return replace(self, pair=pair)

    def moved(self, motions: Sequence[Array]) -> SupportCompliance:
        """These supports in the pair whose gears have moved by (6,) each, in the axes of each gear's own frame.

        The fixed frame of the moved pair turns with the pinion, the axes of loads and motions do not.
        """
        pinion, _ = motions
        return replace(self, pair=moved_pair(self.pair, self.supports, motions), axes=self.axes @ rotation(pinion[3:]))

    def bodies(self, loads: Sequence[Array]) -> tuple[Array, Array]:
        """Motions (6,) of the middles of both faces under loads (6 m,) of the stations of pinion and wheel."""
        pinion, wheel = (
            support.at_middle(support.moved(load)) for support, load in zip(self.supports, loads, strict=True)
        )
        return pinion, wheel

    @property
    def is_rigid(self) -> bool:
        """Whether no load moves the gears."""
        return not any(one.compliance.any() or one.motion is not None or one.law for one in self.supports)

    @property
    def is_linear(self) -> bool:
        """Whether the motions grow with the loads, whatever these are."""
        return all(support.law is None for support in self.supports)

    def linear_near(self, loads: Sequence[Array]) -> SupportCompliance:
        """The supports that are linear near loads (6 m,) of pinion and wheel; these if they are linear."""
        if self.is_linear:
            return self
        pinion, wheel = (support.linear_near(load) for support, load in zip(self.supports, loads, strict=True))
        return replace(self, supports=(pinion, wheel))

    def loads(self, grid: ContactGrid) -> tuple[Array, Array]:
        """Loads of pinion and wheel (ny, 6 m) each by a unit normal force on every slice of a contact [1, mm]."""
        known = self._loads.get(id(grid))
        if known is None:
            points = grid.origin + grid.force_line[:, None] * grid.axes[0] + grid.y[:, None] * grid.axes[1]
            (pinion, wheel), (of_pinion, of_wheel), normal = self.supports, self.axes, grid.axes[2]
            on_pinion, on_wheel = pinion.middle * AXIS, wheel.middle * AXIS  # middles of the faces, as the gears stand
            of_middles = points - on_pinion, points - self.pair.wheel_origin - on_wheel @ self.pair.wheel_axes
            both = (
                pinion.loads(of_middles[0] @ of_pinion.T + on_pinion, -of_pinion @ normal),
                wheel.loads(of_middles[1] @ of_wheel.T + on_wheel, of_wheel @ normal),
            )
            if len(self._loads) >= KEPT:
                self._loads.clear()
            known = self._loads[id(grid)] = grid, both
        return known[1]

    def within(self, number: int, grid: ContactGrid, under: ContactGrid | None = None) -> Array:  # noqa: ARG002
        """Deflection of every slice under a unit force on each, or on each of ``under`` [mm/N]."""
        return self._between(grid, grid if under is None else under)

    def within_each(self, contacts: Sequence[tuple[int, ContactGrid]]) -> list[Array]:
        """Results of :meth:`within` for the numbers and grids of several contacts."""
        return [self._between(grid, grid) for _, grid in contacts]

    def between(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid]) -> Array:
        """Deflection of every slice of one contact under a unit force on each slice of another [mm/N]."""
        return self._between(at[1], under[1])

    def deflection(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid], forces: Array) -> Array:
        """Deflection (m,) [mm] of the slices of one contact under forces (n,) [N] on those of another."""
        there, here = self.loads(at[1]), self.loads(under[1])
        pinion, wheel = (
            a @ (support.compliance @ (forces @ b)) for a, b, support in zip(there, here, self.supports, strict=True)
        )
        return np.asarray(pinion + wheel)

    def deflection_growth(
        self,
        contacts: Sequence[tuple[int, ContactGrid]],
        state: Indices,
        forces: Array,
        moved: Sequence[MovedSlices],
    ) -> Array:
        """Growth (keys, n) [mm per unit] of the deflection of slices under forces as they are, as gears and grids move.

        Parameters are those of :class:`loaded_tca.compliance.model.BendingPart`.
        """
        of_slices, growth = np.repeat(state, [len(grid.y) for _, grid in contacts]), []
        first, states = np.flatnonzero(np.diff(of_slices, prepend=-1)), np.unique(of_slices, return_inverse=True)[1]
        here = self._loads_of([grid for _, grid in contacts])
        for low, high, difference in moved:
            below, above = (self.mounted(pair)._loads_of(grids) for pair, grids in (low, high))
            deflection = np.zeros(forces.size)
            for support, unit, one, other in zip(self.supports, here, below, above, strict=True):
                grown = (other - one) / difference
                on_support, more = (np.add.reduceat(forces[:, None] * by, first) for by in (unit, grown))
                deflection += (grown * (on_support @ support.compliance)[states]).sum(axis=1)
                deflection += (unit * (more @ support.compliance)[states]).sum(axis=1)
            growth.append(np.where(forces != 0.0, deflection, 0.0))
        return np.array(growth).reshape(-1, forces.size)

    def _loads_of(self, grids: Sequence[ContactGrid]) -> tuple[Array, Array]:
        """Loads (n, 6 m) of both gears as of :meth:`loads`, of the slices of all grids."""
        pinion, wheel = (np.concatenate(loads) for loads in zip(*map(self.loads, grids), strict=True))
        return pinion, wheel

    def gap_by_motion(self, grid: ContactGrid, motions: Sequence[Array]) -> Array:
        """How far the gap of every slice (ny,) [mm] grows by motions (6 m,) of the stations of both gears."""
        pinion, wheel = (loads @ motion for loads, motion in zip(self.loads(grid), motions, strict=True))
        return np.asarray(pinion + wheel)

    def gap_by_rigid_motion(self, grid: ContactGrid, motions: Sequence[Array]) -> Array:
        """The same by motions (6,) of both gears as rigid bodies, with the middles of their faces."""
        return self.gap_by_motion(
            grid, [support.with_middle(motion) for support, motion in zip(self.supports, motions, strict=True)]
        )

    def _between(self, at: ContactGrid, under: ContactGrid) -> Array:
        there, here = self.loads(at), self.loads(under)
        pinion, wheel = (a @ support.compliance @ b.T for a, b, support in zip(there, here, self.supports, strict=True))
        return np.asarray(pinion + wheel)
