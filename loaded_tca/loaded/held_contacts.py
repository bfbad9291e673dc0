r"""Contacts of a scene on grids that are made once, for many shapes of its flanks: only their gaps change.

Boxes, grids, the points at which the normals of the contact meet the flanks, the compliance of teeth and free edges
belong to the flanks as they are at first. With other values of keys that shape flanks, Theta at these points changes
by dTheta, and the gap on the held grid by

.. math:: dh = \left(\frac{d\Theta}{\nabla F \cdot n}\right)_\text{wheel}
             - \left(\frac{d\Theta}{\nabla F \cdot n}\right)_\text{pinion},

which is exact to first order in the slope that the change adds: a modification of 40 um moves the points by as much
along the normal, and Theta there by less than a nanometre. The smallest gap of a contact is no longer zero: it is
taken out of the gap and counts as initial separation of the tooth pair, as a rotation of the wheel by the lever of the
contact, which is held, too. So a mesh cycle becomes a smooth function of the keys: what an analysis that makes its
boxes anew owes to their cells, 2 to 4 nm of transmission error, stays the same from shape to shape.

Where a contact grows beyond its grid, a larger one takes its place.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.compliance.model import BendingModel
from loaded_tca.edges.free import edge_compliances
from loaded_tca.errors import AccuracyWarning, InputError, LoadedTCAError
from loaded_tca.loaded.load_sharing import load_sharing_steps
from loaded_tca.loaded.together import Ends, Gap, Result, Steps, Trace
from loaded_tca.loaded.tooth_contact import Coupling, GridChoice
from loaded_tca.loaded.tooth_pairs import SharedLoad, ToothPair, tooth_pairs_at
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair
from loaded_tca.scene import Scene
from loaded_tca.separation import Separation
from loaded_tca.separation.box import Box
from loaded_tca.separation.normal_gap import TOGETHER, NormalGap
from loaded_tca.separation.pair_change import pair_changes, value_at
from loaded_tca.separation.sample import sample_separations
from loaded_tca.unloaded import ContactPoint, MeshPath

PROBE = (33, 65)
"""Cells of the coarse grids that tell where contacts may be."""
PROBE_ACROSS = 0.25
"""Half of their width across, over the module; a contact is at most half as wide."""
SLENDER = 4.7
"""ln(4 L/b) - 1 of a contact line over a face: its line load is pi E*/(2 SLENDER) times how far it is closed."""
NEAR, NEAR_LENGTH = 1.6, 0.008
"""Tooth pairs are held that so many times the rotation, and so much [mm] more, would close."""
MARGIN = 1.25
"""Box over the contacts that are expected in it."""
STRAIGHT = 1e-7
"""Change of a slope [mm over the range of a key] below which the gap is a linear function of the keys."""


@dataclass(frozen=True, eq=False)
class MetPoints:
    """Points of a flank that normals meet, in one row: (n,) each; steepness as of ``FlankPoints`` [1/mm]."""

    rho: Array
    z: Array
    steepness: Array

    def moved(self, one: GearPair, two: GearPair, gear: str) -> Array:
        """How far the flank of ``two`` stands beyond that of ``one`` along the normals (n,) [mm]."""
        before, after = (getattr(pair, gear).flank.theta(self.rho, self.z).value for pair in (one, two))
        return np.asarray((after - before) / self.steepness)


@dataclass(frozen=True, eq=False)
class HeldContact:
    """Grid of one tooth pair at one position, with what belongs to it whatever the shape of the flanks is.

    Attributes
    ----------
    tooth_pair : ToothPair
    separation : Separation
        With the flanks as they are at first.
    there : (nx, ny) bool array
        Cells with material, n of them.
    pinion, wheel : MetPoints
        Of these cells.
    ends : (ny, ny) array or None [mm/N]
        Compliance of free edges.
    slopes : (keys, nx, ny) array or None [mm per unit of the key]
        Derivatives of the gap, where these are the same for all values of the keys.
    """

    tooth_pair: ToothPair
    separation: Separation
    there: Mask
    pinion: MetPoints
    wheel: MetPoints
    ends: Array | None
    slopes: Array | None = None

    def growth(self, one: GearPair, two: GearPair, gears: Sequence[str] = ("pinion", "wheel")) -> Array:
        """Growth of the gap (nx, ny) [mm] from the flanks of one pair to those of another."""
        growth = np.zeros(self.there.shape)
        if "pinion" in gears:
            growth[self.there] -= self.pinion.moved(one, two, "pinion")
        if "wheel" in gears:
            growth[self.there] += self.wheel.moved(one, two, "wheel")
        return growth


def held(
    pair: GearPair,
    tooth_pairs: Sequence[ToothPair],
    cells: tuple[int, int],
    boxes: Sequence[Box | tuple[float, float]],
    free_edges: bool = False,
) -> list[HeldContact]:
    """Sample contacts in boxes, and meet the flanks there; with the compliance of free edges where asked for."""
    contacts = [one.contact for one in tooth_pairs]
    count = len(contacts)
    separations = []
    for one in sample_separations(pair, contacts, cells=[cells] * count, loads=[None] * count, boxes=boxes):
        if not isinstance(one, Separation):
            raise one
        separations.append(one)
    ends = edge_compliances(pair, separations) if free_edges and count else [None] * count
    contacts_held, size = [], max(1, TOGETHER // math.prod(cells))
    for first in range(0, len(contacts), size):
        some = slice(first, first + size)
        axes = np.array([one.axes for one in separations[some]])
        x, y = (np.array([getattr(one, name) for one in separations[some]]) for name in ("x", "y"))
        points = NormalGap(pair, contacts[some], axes).flank_points(x[:, :, None], y[:, None])
        for k, (separation, matrix) in enumerate(zip(separations[some], ends[some], strict=True)):
            if isinstance(matrix, InputError):
                raise matrix
            there = np.isfinite(separation.cut_gap)
            pinion, wheel = (MetPoints(one.rho[k][there], one.z[k][there], one.steepness[k][there]) for one in points)
            contacts_held.append(HeldContact(tooth_pairs[first + k], separation, there, pinion, wheel, matrix))
    return contacts_held


class _HeldBending(BendingModel):
    """A bending model that keeps what it has told of a grid, known by the array of its slices."""

    def __init__(self, model: BendingModel) -> None:
        self._model = model
        self._known: dict[tuple[int, ...], tuple[tuple[Array, ...], Array]] = {}

    @property
    def neighbours(self) -> int:
        return self._model.neighbours

    def within(self, number: int, grid: ContactGrid, under: ContactGrid | None = None) -> Array:
        there = grid if under is None else under
        key = number, id(grid.y), id(there.y)
        if key not in self._known:
            self._known[key] = (grid.y, there.y), self._model.within(number, grid, under)
        return self._known[key][1]

    def between(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid]) -> Array:
        key = at[0], id(at[1].y), under[0], id(under[1].y)
        if key not in self._known:
            self._known[key] = (at[1].y, under[1].y), self._model.between(at, under)
        return self._known[key][1]


class HeldContacts:
    """Contacts of a scene at all positions of a pitch, on held grids.

    Parameters
    ----------
    scene : Scene
        The flanks at first.
    mesh : MeshPath
        Its unloaded contact.
    ranges : mapping of str to (float, float)
        Keys that shape flanks, and the range of each.
    torque : float [N mm]
        The largest one, whose contacts the boxes hold for the scene and for each key at either end of its range.
    cells : (int, int)
        Of every grid.
    bending : BendingModel, optional
    displacement : callable, optional
        Displacement of the slices of a grid that does not depend on the forces; default: none.

    Attributes
    ----------
    start : (keys,) array
        Values of the keys in the scene.
    contacts : list of lists of ContactPoint
        Of each position.
    """

    def __init__(
        self,
        scene: Scene,
        mesh: MeshPath,
        ranges: Mapping[str, tuple[float, float]],
        torque: float,
        cells: tuple[int, int],
        bending: BendingModel | None = None,
        displacement: Coupling | None = None,
    ) -> None:
        self.displacement = displacement
        self.scene, self.pair, self.mesh, self.keys = scene, mesh.pair, mesh, tuple(ranges)
        self.start = np.array([value_at(scene, key) for key in self.keys])
        self._torque, self._cells = torque, cells
        self.bending = None if bending is None else _HeldBending(bending)
        spans, each = np.array([*ranges.values()]), np.eye(self.start.size, dtype=bool)
        shapes = [self.pair, *(self.pair_at(np.where(own, ends, self.start)) for ends in spans.T for own in each)]
        self._held: dict[ContactPoint, HeldContact] = {}
        self._is_linear = False
        self.contacts: list[list[ContactPoint]] = []
        for position in range(len(mesh)):
            contacts = self._held_at(position, shapes)
            self._held.update((one.tooth_pair.contact, one) for one in contacts)
            self.contacts.append([one.tooth_pair.contact for one in contacts])
        contacts_held = [*self._held.values()]
        first, last = (self._slopes_at(values, contacts_held) for values in (self.start, spans[:, 1]))
        bends = [np.abs(last[one] - first[one]).max(axis=(1, 2)) @ np.ptp(spans, axis=1) for one in first]
        if max(bends) <= STRAIGHT:
            self._held = {contact: replace(one, slopes=first[contact]) for contact, one in self._held.items()}
            self._is_linear = True

    def pair_at(self, values: Array) -> GearPair:
        """The gears with other values of the keys."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # told of the scene itself
            return self._scene(values).pair()

    def gaps(self, values: Array, contacts: Iterable[ContactPoint] | None = None) -> dict[ContactPoint, Array]:
        """Gaps (nx, ny) [mm] with other values of the keys, the gears held at their angles; of all contacts or some."""
        some = {contact: self._held[contact] for contact in (self._held if contacts is None else contacts)}
        pair, change = self.pair if self._is_linear else self.pair_at(values), values - self.start
        return {
            contact: one.separation.cut_gap
            + (one.growth(self.pair, pair) if one.slopes is None else np.tensordot(change, one.slopes, 1))
            for contact, one in some.items()
        }

    def slopes(self, values: Array) -> dict[ContactPoint, Array]:
        """Derivatives (keys, nx, ny) [mm per unit of the key] of :meth:`gaps`."""
        if self._is_linear:
            return {contact: one.slopes for contact, one in self._held.items() if one.slopes is not None}
        return self._slopes_at(values, [*self._held.values()])

    @property
    def pitches_apart(self) -> int:
        """How many pitches two tooth pairs held at a position are apart at the most."""
        numbers = ([self._held[contact].tooth_pair.pair for contact in at] for at in self.contacts if at)
        return max((max(one) - min(one) for one in numbers), default=0)

    def __getitem__(self, contact: ContactPoint) -> HeldContact:
        return self._held[contact]

    def holds(self, shared: SharedLoad) -> bool:
        """Whether all contacts of a state were solved on the grids that are held now."""
        loaded = [share.loaded for share in shared.shares]
        return all(one.separation.y is self._held[one.contact].separation.y for one in loaded)

    def grow(self, contact: ContactPoint, box: Box) -> None:
        """Hold a contact in a larger box from now on."""
        one = self._held[contact]
        (larger,) = self._in_boxes([one.tooth_pair], [box])
        line = np.interp(larger.separation.y, one.separation.y, one.separation.force_line)
        larger = replace(larger, separation=replace(larger.separation, force_line=line))
        if self._is_linear:
            larger = replace(larger, slopes=self._slopes_at(self.start, [larger])[contact])
        self._held[contact] = larger  # grid and slopes at once: an exception out of a signal may come anywhere

    def _scene(self, values: Array) -> Scene:
        return self.scene.with_changes(dict(zip(self.keys, values.tolist(), strict=True)))

    def _slopes_at(self, values: Array, contacts: Iterable[HeldContact]) -> dict[ContactPoint, Array]:
        changes = pair_changes(self._scene(values), self.keys)
        slopes = {}
        for one in contacts:
            grown = [one.growth(by.below, by.above, (by.key.partition(".")[0],)) / by.difference for by in changes]
            slopes[one.tooth_pair.contact] = np.array(grown)
        return slopes

    def _held_at(self, position: int, shapes: Sequence[GearPair]) -> list[HeldContact]:
        """Contacts of a position that one of the shapes may bring under load, in boxes that hold them."""
        tooth_pairs, pair = tooth_pairs_at(self.mesh, position), self.pair
        heights = (flank.extent[0] for flank in (pair.pinion.flank, pair.wheel.flank))
        box, count = (PROBE_ACROSS * pair.module, math.hypot(pair.face_width, *heights)), len(tooth_pairs)
        probes = held(pair, tooth_pairs, PROBE, [box] * count)
        closed = np.zeros((count, *PROBE), dtype=bool)
        for shape in shapes:
            gaps = np.array([one.separation.cut_gap + one.growth(pair, shape) for one in probes])
            closed |= self._overlap(probes, gaps) > 0.0
        kept, boxes = [], []
        for probe, mask in zip(probes, closed, strict=True):
            if not mask.any():
                continue
            grid = probe.separation
            low, high = np.array([_span(grid.x, mask, 0), _span(grid.y, mask, 1)]).T
            first, last = _span(grid.y, probe.there, 1)
            middle, half = 0.5 * (low + high), 0.5 * MARGIN * (high - low)
            beyond = 2.0 * half[1] / self._cells[1]  # a cell without material, where the flank ends
            bottom, top = max(middle[1] - half[1], first - beyond), min(middle[1] + half[1], last + beyond)
            kept.append(probe.tooth_pair)
            half_lengths, place = (float(half[0]), float(0.5 * (top - bottom))), 0.5 * (top + bottom)
            boxes.append(Box(half_lengths, grid.axes, (float(middle[0]), float(place))))
        # less than a cell at a corner is none
        contacts = [one for one in self._in_boxes(kept, boxes) if one.there.any()]
        if not contacts:
            return []
        overlaps = self._overlap(contacts, np.array([one.separation.cut_gap for one in contacts]))
        depths = zip(contacts, np.sqrt(overlaps), strict=True)
        return [replace(one, separation=one.separation.loaded_by(depth, pair.module)) for one, depth in depths]

    def _in_boxes(self, tooth_pairs: Sequence[ToothPair], boxes: Sequence[Box]) -> list[HeldContact]:
        """Contacts of the pair at first, with free edges as the scene asks for."""
        return held(self.pair, tooth_pairs, self._cells, boxes, self.scene.analysis.free_edges)

    def _overlap(self, probes: Sequence[HeldContact], gaps: Array) -> Array:
        """Depth (pairs, nx, ny) [mm] of cells below the edge of the contact, zero beyond it.

        Strips across carry line loads in proportion to how far they are closed, and all pairs share the torque. A pair
        that only nearly carries load counts as if it did.
        """
        contacts = [one.tooth_pair.contact for one in probes]
        levers, wheel_levers = np.array([(one.pinion_lever, one.wheel_lever) for one in contacts]).T
        apart = wheel_levers * [one.tooth_pair.initial_separation for one in probes]
        stiffness = 0.5 * math.pi * self.pair.contact_modulus / SLENDER
        lowest = gaps.min(axis=1)
        floors = lowest + apart[:, None]  # (pairs, ny), with the wheel where it is unloaded
        weights = stiffness * levers * [one.separation.spacing[1] for one in probes]
        order = np.argsort(floors, axis=None)[: np.isfinite(floors).sum()]
        heights, parts = floors.ravel()[order], np.broadcast_to(weights[:, None], floors.shape).ravel()[order]
        levels = (self._torque + np.cumsum(parts * heights)) / np.cumsum(parts)
        level = float(levels[(levels <= np.append(heights[1:], np.inf)).argmax()])
        nearly = heights[0] + NEAR * (level - heights[0]) + NEAR_LENGTH
        carries = (floors < level).any(axis=1, keepdims=True)
        closing = np.maximum(np.where(carries, level, nearly) - floors, 0.0)
        rise = closing / SLENDER
        depth = gaps - np.where(np.isfinite(lowest), lowest, 0.0)[:, None]
        return np.where((closing > 0.0)[:, None], np.maximum(rise[:, None] - depth, 0.0), 0.0)


class ShapedContacts:
    """Held contacts with one shape of the flanks, to be solved under torques.

    Parameters
    ----------
    contacts : HeldContacts
    values : (keys,) array
    """

    def __init__(self, contacts: HeldContacts, values: Array) -> None:
        self._contacts, self._values = contacts, values
        self._lowest: dict[ContactPoint, float] = {}
        self._separations: dict[ContactPoint, Separation] = {}
        self._ends: dict[Separation, Array | None] = {}
        for contact, gap in contacts.gaps(values).items():
            self._lowest[contact] = float(gap.min())
            self._keep(contact, gap)

    def _keep(self, contact: ContactPoint, gap: Array) -> Separation:
        one, raised = self._contacts[contact], gap - self._lowest[contact]
        whole = np.where(np.isfinite(one.separation.gap), raised, np.inf)
        kept = self._separations[contact] = replace(one.separation, gap=whole, cut_gap=raised)
        self._ends[kept] = one.ends
        return kept

    def shared(self, position: int, torque: float, grid: GridChoice) -> Steps[tuple[float, SharedLoad]]:
        """Share a torque [N mm] at a position: the loaded transmission error [rad], and what the pairs carry."""
        contacts, pair = self._contacts, self._contacts.pair
        there = [contacts[contact].tooth_pair for contact in contacts.contacts[position]]
        beyond = [one.initial_separation + self._lowest[one.contact] / one.contact.wheel_lever for one in there]
        first = min(beyond)
        tooth_pairs = [replace(one, initial_separation=rest - first) for one, rest in zip(there, beyond, strict=True)]
        steps = load_sharing_steps(pair, tooth_pairs, torque, grid, contacts.bending, contacts.displacement)
        answer = yield from self._answered(steps)
        unloaded = float(contacts.mesh.transmission_error[position])
        return unloaded - pair.driving * (first + answer.rotation), answer

    def _answered(self, steps: Steps[Result]) -> Steps[Result]:
        """Answer what is asked for of grids; contact problems are passed on."""
        answer: Any = None
        while True:
            try:
                request = steps.throw(answer) if isinstance(answer, LoadedTCAError) else steps.send(answer)
            except StopIteration as end:
                return end.value
            if isinstance(request, Gap):
                answer = self._grid(request)
            elif isinstance(request, Trace):
                answer = request.contacts  # on their grids, which are held
            elif isinstance(request, Ends):
                answer = self._ends[request.separation]
            else:
                try:
                    answer = yield request
                except LoadedTCAError as error:
                    answer = error

    def _grid(self, request: Gap) -> Separation:
        """The held grid of a contact, or a larger one where it has outgrown that."""
        contact, grid = request.contact, self._separations[request.contact]
        if request.box is None or grid.box.holds(request.box):
            return grid
        self._contacts.grow(contact, request.box)
        return self._keep(contact, self._contacts.gaps(self._values, [contact])[contact])


def _span(places: Array, cells: Mask, axis: int) -> tuple[float, float]:
    """Ends along an axis of the marked cells (nx, ny) whose middles are at these places, whole cells counted [mm]."""
    there, step = places[np.unique(cells.nonzero()[axis])], float(places[1] - places[0])
    return float(there[0]) - 0.5 * step, float(there[-1]) + 0.5 * step
