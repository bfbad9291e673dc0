r"""Rounded edges of a flank: arcs that lead over from the flank to the tip land and to the ends of the face.

Edges are surfaces of revolution (tip cylinder or cone, end planes or spheres), so that a point of the flank that is
turned about the axis keeps its distance D from them. In the section across an edge, x along the flank and the depth
below it, with the material angle w, S = sin w, T = -cot w, the arc of radius r begins t = r cot(w/2) before the edge,
and material removed to the depth delta at s = t - D/S fulfils :math:`(s + \delta T)^2 + (r - \delta)^2 = r^2`:

.. math:: \delta = \frac{s^2}{A + \sqrt{A^2 - s^2/S^2}}, \qquad A = r - s T, \qquad s > 0 .

The flank becomes Theta - s_side delta |grad F|, as with every modification: lengths across the edge are counted along
the tangent of the flank, so that the arc bends away from the flank by 1/r. After a turn of min(40 deg, 0.7 (pi - w))
it goes on as its Taylor parabola, since at the far end of the arc the removal grows without bound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import require
from loaded_tca.flanks.base import EDGE_NAMES, DerivedFlank, Flank, Jet, outward_normal, unmodified
from loaded_tca.flanks.bevel import NODES, DistanceCurve, chebyshev_nodes
from loaded_tca.flanks.tensor_spline import SplineDerivatives
from loaded_tca.plain import plain

LEAST_RADIUS = 0.01
"""Smallest radius [mm] of a rounded edge: below it an edge is sharp."""
TIP, LOWER, UPPER = (EDGE_NAMES.index(name) for name in ("tip", "lower side", "upper side"))
LARGEST_TURN, MOST_OF_TURN = math.radians(40.0), 0.7
"""Turn from the flank [rad], and part of the whole turn, up to which the arc is exact."""
ALONG_EDGE = 33
"""Points along an edge at which the angle of the material is taken."""
SAME_ANGLE = 1e-6
"""Change of the cotangent of the material angle along an edge that is none: at a base cone Theta is known no closer."""
FAR_OUT, FINER = 1.2, 64
"""Part of a flank beside an edge that is drawn finely, over the reach of the arc there, and how finely."""
MARGIN = 1e-9
"""Part of its radius by which an arc may begin farther from the edge than seen at the points along it."""


@dataclass(frozen=True)
class EdgeRounding:
    """Radii of the rounded edges of a gear's teeth.

    Parameters
    ----------
    tip, side : float [mm]
        Of both tip edges, and of both ends of the face; 0: sharp.

    Raises
    ------
    InputError
        If a radius is neither 0 nor at least 0.01 mm.

    Examples
    --------
    >>> EdgeRounding(tip=0.2)
    EdgeRounding(tip=0.2, side=0.0)
    """

    tip: float = 0.0
    side: float = 0.0

    def __post_init__(self) -> None:
        allowed = f"allowed 0 (sharp), or from {plain(LEAST_RADIUS, 6)} mm on"
        require(
            *(
                (radius == 0.0 or LEAST_RADIUS <= radius < math.inf, f"{name}: found {plain(radius, 6)} mm; {allowed}")
                for name, radius in (("tip", self.tip), ("side", self.side))
            )
        )

    def __bool__(self) -> bool:
        return self.tip > 0.0 or self.side > 0.0


def edge_places(flank: Flank, edge: int, count: int = ALONG_EDGE) -> tuple[Array, Array]:
    """(rho, z) of points (count,) along an edge of a flank, evenly in its own coordinate [mm]."""
    shape, row = {TIP: ((2, count), -1), LOWER: ((count, 2), 0), UPPER: ((count, 2), -1)}[edge]
    rho, z = flank.grid(*shape)
    return (rho[row], z[row]) if edge == TIP else (rho[:, row], z[:, row])


def material_cosines(flank: Flank, edge: int, rho: Array, z: Array) -> Array:
    """Cosine of the angle w of the material between the flank without modifications and an edge, at places on it."""
    flank = unmodified(flank)
    distance = flank.edges(rho, z)[edge]
    normal = outward_normal(flank, rho, z)
    return np.asarray(normal[..., 0] * distance.rho + normal[..., 2] * distance.z)


@dataclass(frozen=True, eq=False)
class Arc:
    """The arc along one edge.

    Attributes
    ----------
    edge : int
        Index in ``EDGE_NAMES``.
    radius : float [mm]
    tangent : float or DistanceCurve
        T = -cot w: the same all along the edge, or over the coordinate along it.
    turn : float [rad]
        Up to which the arc is exact.
    reach : float [mm]
        Largest distance from the edge at which the arc begins.
    """

    edge: int
    radius: float
    tangent: float | DistanceCurve
    turn: float
    reach: float

    @classmethod
    def along(cls, flank: Flank, edge: int, radius: float) -> Arc:
        """The arc of a radius [mm] along an edge of a flank."""
        nominal = unmodified(flank)
        rho, z = edge_places(nominal, edge)
        cosine = material_cosines(nominal, edge, rho, z)
        widest = math.acos(float(cosine.min()))
        tangents = -cosine / np.sqrt(1.0 - cosine**2)
        tangent: float | DistanceCurve = float(np.median(tangents))
        if np.ptp(tangents) > SAME_ANGLE:
            along = _coordinate(nominal, edge, rho, z).value
            ends = float(along[0]), float(along[-1])
            tangent = DistanceCurve(ends, Chebyshev.fit(along, tangents, NODES - 1)(chebyshev_nodes(ends, NODES)))
        turn = min(LARGEST_TURN, MOST_OF_TURN * (math.pi - widest))
        return cls(edge, radius, tangent, turn, radius * (1.0 + float(cosine.max()) + MARGIN))

    def past_tangent(self, flank: Flank, rho: Array, z: Array, distance: Jet) -> tuple[Jet, Jet]:
        """Length s [mm] along the flank from where the arc begins towards the edge, and T, at ``distance`` from it."""
        if isinstance(self.tangent, float):
            inverse_sine, radius = math.hypot(1.0, self.tangent), self.radius
            along = distance * -inverse_sine + Jet(radius * (inverse_sine - self.tangent))
            return along, Jet(self.tangent)
        tangent = self.tangent(_coordinate(flank, self.edge, rho, z))
        root = np.sqrt(1.0 + tangent.value**2)
        inverse = tangent.compose(root, tangent.value / root, lambda: 1.0 / root**3)
        return (distance * -1.0 + Jet(self.radius)).times(inverse) + tangent * -self.radius, tangent

    def depth(self, along: Jet, tangent: Jet) -> Jet:
        """Material removed delta(s, T) [mm]; nothing before the arc begins."""
        r, turn, t = self.radius, self.turn, np.asarray(tangent.value)
        sine, cosine = math.sin(turn), math.cos(turn)
        last = r * (sine - t * (1.0 - cosine))
        s = np.clip(along.value, 0.0, last)
        beyond = np.maximum(along.value - last, 0.0)
        start = r - s * t
        root = np.sqrt(start**2 - s**2 * (1.0 + t**2))
        depth = s**2 / (start + root)
        slope = (s + depth * t) / root
        bend = (1.0 + 2.0 * t * slope + (1.0 + t**2) * slope**2) / root
        bend = np.where(along.value > 0.0, bend, 0.0)
        steeper = bend * beyond
        value = depth + beyond * (slope + 0.5 * steeper)
        if isinstance(self.tangent, float):
            return along.compose(value, slope + steeper, bend)
        # Taylor's parabola from the last point of the exact arc on; that point moves with T by -depth there
        twist = slope**2 + 3.0 * slope * steeper + bend * depth
        derivatives = SplineDerivatives(
            value,
            slope + steeper,
            beyond * slope * (slope + 1.5 * steeper) + depth * (slope + steeper),
            bend,
            twist,
            2.0 * slope**2 * (slope * beyond + depth)
            + bend * (6.0 * slope * beyond * (slope * beyond + depth) + depth**2),
        )
        return derivatives.compose(along, tangent)


@checked
class RoundedFlank(DerivedFlank):
    """A flank with rounded edges.

    Parameters
    ----------
    nominal : Flank
        The flank with sharp edges, its modifications included.
    rounding : EdgeRounding

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> flank = cylindrical_pair(CylindricalMesh(*gears)).pinion.flank
    >>> at_tip = RoundedFlank(flank, EdgeRounding(tip=0.2)).removal(np.array([53.9, 54.0]), np.array([0.0, 0.0]))
    >>> at_tip.value.round(6).tolist()
    [0.000199, 0.081634]
    """

    def __init__(self, nominal: Flank, rounding: EdgeRounding) -> None:
        super().__init__(nominal)
        self.rounding = rounding
        radii = {TIP: rounding.tip, LOWER: rounding.side, UPPER: rounding.side}
        self.arcs = tuple(Arc.along(nominal, edge, radius) for edge, radius in radii.items() if radius > 0.0)

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:
        """Theta of the flank with its edges rounded."""
        return reduce(Jet.__add__, self._removed(rho, z, as_angle=True), self.nominal.theta(rho, z, beyond))

    def removal(self, rho: Array, z: Array) -> Jet:
        """Material removed [mm] by the arcs of all edges together."""
        return reduce(Jet.__add__, self._removed(rho, z), Jet(np.zeros(np.broadcast(rho, z).shape)))

    def relief_starts(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Relief starts of the sharp flank."""
        return self.nominal.relief_starts(rho, z)

    def past_tangents(self, rho: Array, z: Array) -> list[Array]:
        """Lengths s (...) [mm] from where the arc of each edge begins towards the edge; -inf at sharp edges."""
        shape, jets = np.broadcast(rho, z).shape, self.edges(rho, z)
        lengths = [np.full(shape, -np.inf) for _ in EDGE_NAMES]
        for arc in self.arcs:
            lengths[arc.edge][...] = arc.past_tangent(self, rho, z, jets[arc.edge])[0].value
        return lengths

    def ways_onto_arcs(self, rho: Array, z: Array, slopes: Array) -> Array:
        """Ways (n, 4) [mm] away from the edges to where the arcs, seen along the edge's surface, have given slopes.

        Parameters
        ----------
        rho, z : (n,) array [mm]
        slopes : (n, 4) array
            Removal per distance from each edge.

        Returns
        -------
        (n, 4) array
            Zero where a point lies on no arc.
        """
        jets, ways = self.edges(rho, z), np.zeros(slopes.shape)
        for arc in self.arcs:
            along, tangent = arc.past_tangent(self, rho, z, jets[arc.edge])
            t = np.asarray(tangent.value)
            sine = 1.0 / np.sqrt(1.0 + t**2)
            slope = slopes[:, arc.edge] * sine
            turn = np.minimum(np.arctan2(slope, 1.0 + t * slope), arc.turn)
            wanted = arc.radius * (np.sin(turn) - t * (1.0 - np.cos(turn)))
            ways[:, arc.edge] = np.where(along.value > 0.0, (along.value - wanted) * sine, 0.0)
        return ways

    def off_arcs(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """(rho, z) of points, those nearer to an edge moved away from it to where its arc begins [mm]."""
        for arc in self.arcs:
            rho, z = self.off_arc(arc, rho, z)
        return rho, z

    def off_arc(self, arc: Arc, rho: Array, z: Array) -> tuple[Array, Array]:
        """(rho, z) of points near the arc of one edge, moved away from it to where the arc begins [mm]."""
        distance = self.edges(rho, z)[arc.edge]
        along, tangent = arc.past_tangent(self, rho, z, distance)
        step = np.maximum(along.value, 0.0) / np.sqrt(1.0 + np.asarray(tangent.value) ** 2)
        return rho + step * distance.rho, z + step * distance.z

    def drawn_grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """(rho, z) over the region as of ``grid``, with a third of the points on arcs, each (profile, lengthwise)."""
        height, width = (float(length) for length in self.extent)
        reach = max((arc.reach for arc in self.arcs if arc.edge == TIP), default=0.0)
        up, side = _shares(profile, 0.0, FAR_OUT * reach / height), FAR_OUT * self.rounding.side / width
        along = _shares(lengthwise, side, side)  # the same for both flanks of a tooth
        rho, z = self.grid(FINER * (profile - 1) + 1, FINER * (lengthwise - 1) + 1)
        picked = np.ix_(*(np.rint(share * FINER * (share.size - 1)).astype(int) for share in (up, along)))
        return rho[picked], z[picked]

    def _removed(self, rho: Array, z: Array, *, as_angle: bool = False) -> list[Jet]:
        """Removal [mm], or change of Theta [rad], by every arc that some of the points lie on, over all points."""
        shape, removals = np.broadcast(rho, z).shape, []
        jets = self.edges(rho, z)
        for arc in self.arcs:
            distance = jets[arc.edge]
            on = np.flatnonzero(np.broadcast_to(distance.value < arc.reach, shape))
            if on.size:
                rows, columns = (np.broadcast_to(part, shape).ravel()[on] for part in (rho, z))
                own = _part(distance, shape, on)
                depth = arc.depth(*arc.past_tangent(self, rows, columns, own))
                if as_angle:
                    depth = depth.times(self.gradient_norm(rows, columns) * -float(self.side))
                removals.append(_spread(depth, shape, on))
        return removals

    def __repr__(self) -> str:
        return (
            f"RoundedFlank({self.nominal!r}, tip {plain(self.rounding.tip, 6)} mm, sides "
            f"{plain(self.rounding.side, 6)} mm)"
        )


def _shares(count: int, low: float, high: float) -> Array:
    """Places (count,) from 0 to 1: a third of the steps in a part ``low`` and ``high`` at either end, if any is."""
    steps = count - 1
    first, last = (min(round(steps / 3), round(0.5 * steps)) if part > 0.0 else 0 for part in (low, high))
    low, high = min(low, first / steps), min(high, last / steps)
    ends = [0.0, first, steps - last, steps], [0.0, low, 1.0 - high, 1.0]
    return np.interp(np.arange(count), *ends) if steps > 2 else np.linspace(0.0, 1.0, count)


def sharp(flank: Flank) -> Flank:
    """The flank without the rounding of its edges."""
    return flank.nominal if isinstance(flank, RoundedFlank) else flank


def _coordinate(flank: Flank, edge: int, rho: Array, z: Array) -> Jet:
    """Coordinate along an edge."""
    return flank.lengthwise_coordinate(rho, z) if edge == TIP else flank.profile_coordinate(rho, z)


def _part(jet: Jet, shape: Sequence[int], on: Indices) -> Jet:
    """A jet at some of its points."""

    def at(part: Any) -> Any:
        return np.broadcast_to(part, shape).ravel()[on] if np.ndim(part) else part

    return Jet(at(jet.value), at(jet.rho), at(jet.z), lambda: [at(bend) for bend in jet.bends])


def _spread(jet: Jet, shape: Sequence[int], on: Indices) -> Jet:
    """A jet at some points, zero at the others."""

    def over(part: Any) -> Any:
        if np.ndim(part) == 0 and part == 0.0:
            return 0.0
        full = np.zeros(shape)
        full.reshape(-1)[on] = part
        return full

    return Jet(over(jet.value), over(jet.rho), over(jet.z), lambda: [over(bend) for bend in jet.bends])
