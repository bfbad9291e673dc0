"""Where an analysis is at a limit of its model or its grid: accuracy warnings, and findings on its largest pressures.

Findings name the edges that contacts reach.
"""

from __future__ import annotations

import math
from itertools import compress
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS, Array, Mask
from loaded_tca.contact.rounded_edge import LARGE_ERROR, TOLERANCE
from loaded_tca.edges.places import edge_distances
from loaded_tca.edges.rounded import LEAST_RADIUS
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.plain import plain, signed
from loaded_tca.results.gear_warnings import HARDEST_ROOT_MPa, hardest_pressure
from loaded_tca.results.pressure_map import arc_cells, mean_pressure_of
from loaded_tca.results.support_growth import gears_under_torque
from loaded_tca.separation.flank_places import FlankPlaces
from loaded_tca.unloaded.tooth_cycle import REACH

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from loaded_tca.compliance.model import HeldBodies
    from loaded_tca.edges.rounded import PeakAtEdge
    from loaded_tca.loaded.cycle import CycleSolution
    from loaded_tca.loaded.loaded_contact import LoadedContact
    from loaded_tca.loaded.tooth_contact import GridChoice
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.numbers import CycleNumbers

ROUNDING = 1e-9
"""Relative, of an estimated error: four cells beside a crossing leave 3 % exactly."""
OVER_MEAN = 4.0 / math.pi
"""Largest pressure of a line contact over the mean, which sharp edges do not move."""
THICKEST_CONTACT = 0.25
"""Half width of a contact, over the module, above which a tooth is no half-space: it is 1.6 modules thick."""

MOST_TORSION = 0.5
"""Part of the deflection from which the twist of the bodies about their bores is told."""
MOST_STIFFENED = 0.05
"""Part by which rigid bores make a mesh stiffer from which they are warned of."""
AT_MAPS = "pressure maps; the first: "
"""In sentences on contacts, before the torque and the place of the first."""
OF_THE_LARGEST = (kinds.ROUNDED_EDGE, kinds.EDGE_UNSOLVED, kinds.BODY_TWIST, kinds.RIGID_BORES, kinds.DEFLECTION)
"""Kinds whose sentences say how large it becomes under any torque."""


def warn_of_accuracy(
    pair: GearPair,
    grid: GridChoice,
    carried: CycleSolution,
    at_rounded_edges: Mapping[tuple[int, int, int], PeakAtEdge],
    *,
    mesh_rate: Array,
    load_sharing: bool,
    bodies: HeldBodies,
) -> None:
    """Give one AccuracyWarning for each reason, for the caller's caller: how many pressure maps it concerns, and which.

    Parameters
    ----------
    pair : GearPair
    grid : GridChoice
    carried : CycleSolution
    at_rounded_edges : mapping
        Peaks there by the indices of torque, position and tooth pair.
    mesh_rate : (m, n) array [N mm/rad]
        Tangent of the torque over the rotation of the wheel, of the teeth alone.
    load_sharing : bool
        Whether the pairs that were looked for depend on how far the load turns the wheel.
    bodies : HeldBodies
        What the bores do.
    """
    torques, maps = np.asarray(carried.torque, dtype=float), []
    limit = LARGE_ERROR * (1.0 + ROUNDING)
    large = {place: peak.error for place, peak in at_rounded_edges.items() if peak.error > limit}
    narrow = {place for place, peak in at_rounded_edges.items() if peak.narrow and peak.pressure > 0.0}
    unsolved = {place: peak.unsolved for place, peak in at_rounded_edges.items() if peak.unsolved > 0.0}
    for t, (torque, rows) in enumerate(zip(torques.tolist(), carried.contacts, strict=True)):
        for n, (angle, row) in enumerate(zip(carried.path.pinion_angle.tolist(), rows, strict=True)):
            for k, (number, loaded) in enumerate(zip(carried.pairs.tolist(), row, strict=True)):
                if loaded is not None:
                    reasons = reasons_of(pair, grid, loaded)
                    if (t, n, k) in narrow:
                        reasons.append(kinds.NARROW_ENDS.sentence(part=LEAST_RADIUS))
                    error, residual = (of.get((t, n, k), 0.0) for of in (large, unsolved))
                    place = place_of(torque, angle, number) if reasons or error or residual else ""
                    maps.append((torque, place, loaded.solution.load, (error, residual), reasons))

    def under(largest: float) -> dict[str, str]:
        """Sentences on the contacts under torques up to the largest, by what all of one reason have in common."""
        some = [one for one in maps if one[0] <= largest]
        worst, residual = (max((of_edge[k] for *_, of_edge, _ in some), default=0.0) for k in range(2))
        size = "without a limit" if worst == math.inf else f"{worst:.0%} at the most"
        at_rounding = (
            kinds.ROUNDED_EDGE.sentence(limit=LARGE_ERROR, size=size),
            kinds.EDGE_UNSOLVED.sentence(residual=residual, tolerance=TOLERANCE),
        )
        places: dict[str, list[str]] = {}
        for _, place, _, of_edge, reasons in some:
            for reason in [*compress(at_rounding, of_edge), *reasons]:
                places.setdefault(reason, []).append(place)
        sentences = [
            kinds.NO_TORQUE.sentence(torque=1e-3 * torque)
            for torque in torques[torques <= largest].tolist()
            if torque > 0.0 and not any(load for of, _, load, *_ in some if of == torque)
        ]
        sentences += [at_places(reason, at, len(some)) for reason, at in places.items()]
        rows = torques <= largest
        rotation = carried.rotation[rows]
        sentences += rotation_reasons(pair, torques[rows], rotation, mesh_rate[rows], bodies, load_sharing=load_sharing)
        return {_without_size(sentence): sentence for sentence in sentences}

    for sentence in sentences_of_torques(torques, under):
        give_accuracy_warning(sentence)


class SentenceOfTorques(str):
    """A sentence on contacts under several torques, and what it says of the smaller ones.

    Attributes
    ----------
    up_to : tuple of (str or None)
        For each torque in rising order: the sentence on contacts under it and all smaller ones; None: no reason there.
    """

    up_to: tuple[str | None, ...] = ()


def sentences_of_torques(torques: Array, under: Callable[[float], Mapping[str, str]]) -> list[SentenceOfTorques]:
    """Sentences on all torques [N mm], with what each says of the smaller ones.

    Parameters
    ----------
    torques : (k,) array [N mm]
    under : callable
        Sentences on torques up to a largest one, by a key that all sentences for one reason have.
    """
    parts = [under(largest) for largest in np.unique(torques).tolist()]
    sentences = []
    for key, sentence in (parts[-1] if parts else {}).items():
        one = SentenceOfTorques(sentence)
        one.up_to = tuple(part.get(key) for part in parts)
        sentences.append(one)
    return sentences


def _without_size(sentence: str) -> str:
    """A reason without its places and without a size that is the largest one under all torques."""
    known = kinds.kind_of(sentence)
    return known.words if known is not None and known in OF_THE_LARGEST else without_place(sentence)


def rotation_reasons(
    pair: GearPair,
    torques: Array,
    rotation: Array,
    mesh_rate: Array,
    bodies: HeldBodies,
    *,
    load_sharing: bool = True,
) -> list[str]:
    """Sentences on rotations (torque, position) [rad] by the load, and their rate, that are at a limit of the model."""
    sentences = []
    turned = np.where(rotation > 0.0, rotation, math.inf)
    twist = bodies.torsion * torques[:, None] / pair.base_radii[0] / (turned * pair.base_radii[1])
    stiffness = float(np.nan_to_num(mesh_rate).mean(axis=1).max()) / math.prod(pair.base_radii)
    bores = " and ".join(plain(bore) for bore in pair.rigid_bores) if bodies.torsion else ""
    if (share := bodies.stiffening * stiffness) > MOST_STIFFENED:
        usual = " and ".join(plain(bore) for bore in bodies.usual_bores)
        sentences.append(kinds.RIGID_BORES.sentence(bores=bores, usual=usual, share=share))
    if (share := float(twist.max())) > MOST_TORSION:
        sentences.append(kinds.BODY_TWIST.sentence(bores=bores, share=min(share, 1.0)))
    deflection = float(np.nanmax(rotation, initial=0.0)) * pair.base_radii[1]
    if load_sharing and deflection > REACH * pair.module:
        sentences.append(kinds.DEFLECTION.sentence(deflection=deflection, reach=REACH))
    return sentences


def warn_of_contacts(result: CycleNumbers, reason: str, where: Mask) -> None:
    """Give an AccuracyWarning with the number of contacts of a result, (torque, position, pair), that it concerns."""
    angles, pairs = result.path.pinion_angle, result.pair
    places = [place_of(result.torque[t], angles[n], pairs[k]) for t, n, k in np.argwhere(where).tolist()]
    if places:
        loaded = int(np.count_nonzero(result.load_share > 0.0))
        give_accuracy_warning(at_places(reason, places, loaded))


def place_of(torque: float, angle: float, number: int) -> str:
    """Torque [N mm], pinion angle [rad] and tooth pair of a contact in words."""
    turned = round(math.degrees(angle), 6) + 0.0  # what is left of a sum to 0 is none
    return f"{plain(1e-3 * torque, 6)} N m, pinion angle {plain(turned)} deg, tooth pair {signed(number)}"


def at_places(reason: str, places: Sequence[str], count: int) -> str:
    """A sentence with how many pressure maps of all it concerns, and the first of them."""
    return f"{reason} (at {len(places)} of {count} {AT_MAPS}{places[0]})"


def is_under_torque(sentence: str) -> bool:
    """Whether an accuracy warning ends with the torque of the first pressure map that it concerns."""
    return AT_MAPS in sentence


def warn_of_root_stress(torques: Array, tension: Array, compression: Array) -> None:
    """Give an AccuracyWarning for each gear with root stress (torque, position, gear) [MPa] beyond yield."""

    def under(largest: float) -> dict[str, str]:
        rows = torques <= largest
        stresses = np.nanmax(np.abs([tension[rows], compression[rows]]), axis=(0, 1, 2), initial=0.0)
        return {
            name: kinds.ROOT_BEYOND_YIELD.sentence(gear=name, stress=stress, most=HARDEST_ROOT_MPa)
            for name, stress in zip(GEARS, stresses.tolist(), strict=True)
            if stress > HARDEST_ROOT_MPa
        }

    for sentence in sentences_of_torques(torques, under):
        give_accuracy_warning(sentence)


def without_place(sentence: str) -> str:
    """Return an accuracy warning without how many pressure maps it concerns, which differs between analyses."""
    return sentence.split(" (at ")[0]


def reasons_of(pair: GearPair, grid: GridChoice, loaded: LoadedContact) -> list[str]:
    """Sentences on what limits the accuracy of one loaded contact."""
    solution = loaded.solution
    reasons = []
    if loaded.at_edge and not loaded.at_arc:
        reasons.append((kinds.EDGE if grid.free_edges else kinds.EDGE_NOT_FREE).sentence())
    if loaded.at_relief_start:
        reasons.append(kinds.RELIEF_START.sentence())
    # a grid is not refined for this estimate where a contact is rough, nor where the curvature of its gap jumps
    refined = loaded.is_rough or solution.error_estimate.second_order <= grid.accuracy
    allowed = max(LARGE_ERROR, grid.accuracy) if refined else grid.accuracy
    if grid.cells is None and loaded.peak_error > allowed:
        reasons.append(kinds.PEAK_ERROR.sentence(allowed=allowed))
    if loaded.peak_change > LARGE_ERROR:
        reasons.append(kinds.PEAK_MOVES.sentence(limit=LARGE_ERROR))
    if solution.reaches_border:
        reasons.append(kinds.BOX.sentence())
    if solution.load > 0.0 and solution.cells_across[0] < 8:
        reasons.append(kinds.FEW_CELLS.sentence())
    moduli = [gear.material.youngs_modulus for gear in (pair.pinion, pair.wheel)]
    if pair.max_pressure is None and OVER_MEAN * mean_pressure_of(solution.pressure) > hardest_pressure(*moduli):
        reasons.append(kinds.BEYOND_YIELD.sentence(most=hardest_pressure(*moduli), modulus=min(moduli)))
    if 0.5 * loaded.extent[0] > THICKEST_CONTACT * pair.module:
        reasons.append(kinds.WIDE.sentence())
    return reasons


EDGES = tuple(f"{gear} {edge}" for gear in GEARS for edge in EDGE_NAMES)
"""Edges in the order of ``ContactPath.edges``."""


def reached_edges(result: CycleNumbers) -> NDArray[np.bool_]:
    """Edges that each contact of a result reaches.

    Parameters
    ----------
    result : CycleNumbers

    Returns
    -------
    (m, n, pairs, 8) array of bool
        Over torques, positions, pairs, and ``EDGES``: those that hold the unloaded contact point of a pair under load,
        and those beyond which, or on whose arcs, the cells beside its pressure lie.
    """
    reached = np.zeros((*result.load_share.shape, len(EDGES)), dtype=bool)
    loaded = np.argwhere((result.normal_force > 0.0) | (result.on_edge > 0.0))
    for t, n, k in loaded.tolist():
        reached[t, n, k] = edges_of_contact(result, t, n, k)
    return reached


def _with_neighbours(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells (n, m), and those that share a side with one of them."""
    wider = cells.copy()
    for part, beside in ((cells, wider), (cells.T, wider.T)):
        beside[1:] |= part[:-1]
        beside[:-1] |= part[1:]
    return wider


def edges_of_contact(result: CycleNumbers, torque: int, position: int, column: int) -> NDArray[np.bool_]:
    """Edges (8,) that one contact of a result reaches, given by its indices; see :func:`reached_edges`."""
    result, torque = gears_under_torque(result, torque)
    pair, path = result.gear_pair, result.paths[column]
    reached = path.edges[position] & bool(result.normal_force[torque, position, column] > 0.0)
    one = result.maps[torque][position][column]
    if one is None or not result.on_edge[torque, position, column]:
        return np.asarray(reached)
    beyond = _with_neighbours(one.pressure > 0.0) & np.isinf(one.gap)
    if beyond.any():
        reached = reached | (edge_distances(pair, *FlankPlaces(pair, one).of(beyond)) < 0.0).any(axis=0)
    if pair.sharp is not pair:
        reached = reached | arc_cells(pair, one)[one.pressure > 0.0].any(axis=0)
    return np.asarray(reached)


LEAST_SHARE, SMALL_SHARE = 1e-3, 0.1
"""Shares of the torque from which an edge pressure is a finding, and below which a peak at an edge is one."""


def findings_of(result: CycleNumbers) -> tuple[str, ...]:
    """Sentences on what the largest pressures under each torque rest on; see ``MeshCycle.findings``."""
    edges = _edge_findings(result)
    by_torque = ((edges.get(t, ""), peak_finding(result, t)) for t in range(len(result.torque)))
    return tuple(sentence for sentences in by_torque for sentence in sentences if sentence)


def _edges_of_pressure(result: CycleNumbers, torque: int, position: int, column: int) -> NDArray[np.bool_]:
    """Edges (8,) that a contact reaches where its edge pressure lies: the nearest, and those within two cells of it."""
    reached = edges_of_contact(result, torque, position, column)
    one, pair = result.maps[torque][position][column], gears_under_torque(result, torque)[0].gear_pair
    if one is None or not reached.any():
        return reached
    place = np.array([result.edge_radius[torque, position, column], result.edge_axial[torque, position, column]])
    away = np.hypot(np.hypot(one.points[..., 0], one.points[..., 1]) - place[0], one.points[..., 2] - place[1])
    across, along = np.unravel_index(away.argmin(), away.shape)
    distances = edge_distances(pair, *FlankPlaces(pair, one).at(one.x[[across]], one.y[[along]]))[0]
    return np.asarray(reached & (distances <= distances[reached].min() + 2.0 * max(one.spacing)))


def highest_edges(result: CycleNumbers) -> dict[int, tuple[int, int]]:
    """Where edges have their largest pressure, of pairs that carry a thousandth of the torque: position and tooth pair.

    By torques under which it is above the peak pressure, which leaves edges out.
    """
    places = {}
    for torque, (shares, edges) in enumerate(zip(result.load_share, result.edge_pressure, strict=True)):
        pressures = np.where(shares >= LEAST_SHARE, edges, math.nan)
        if np.nanmax(pressures, initial=-math.inf) > np.nanmax(result.peak_pressure[torque], initial=0.0):
            position, column = np.unravel_index(int(np.nanargmax(pressures)), pressures.shape)
            places[torque] = int(position), int(column)
    return places


def accuracy_of_edge(result: CycleNumbers, at: tuple[int, int, int]) -> str:
    """How far to trust an edge pressure, in words."""
    if not result.edge_is_rounded[at]:
        return "mesh-dependent, since in theory the pressure at a sharp edge is infinite"
    error = float(result.edge_pressure_error[at])
    if not math.isfinite(error):
        return "without a limit, since a sharp edge or a relief start meets the rounding"
    return f"solved on columns of cells, with an estimated error of {error:.1%}"


def _remedy(result: CycleNumbers, at: tuple[int, int, int], edges: Sequence[str]) -> str:
    """What would take the load off the edges of a contact, in words.

    An edge carries no load where the flank lacks as much there as the pair deflects that carries most beside it: its
    contact deformation and the deflection of its teeth along the normal. A pair that just begins to carry deflects by
    less, but would touch there at another position. What the flanks lack there already, by crowning, counts; the load
    that leaves the edge deflects the mesh by a little more, and presses on what is left of the contact.
    """
    torque, n, k = at
    remedies = [
        f"{relief} on the {' or '.join(dict.fromkeys(name.split()[0] for name in edges if where in name))}"
        for relief, where in (("end_relief_um", "side"), ("tip_relief_um", "tip"), ("root_relief_um", "root"))
        if any(where in name for name in edges)
    ]
    deflections = np.nansum([result.contact_deformation[torque, n], result.tooth_deflection[torque, n]], axis=0)
    amount = f"{plain(1e3 * float(deflections.max()), 2)} um at the edge itself, the deflection of the mesh there"
    if result.paths[k].edges[n].any():
        amount = f"more than {amount}, since the pair first touches at this edge even without load"
    else:
        amount = f"up to about {amount}"
    mating = ", and the tip of the mating gear may need relief, too" if any("tip" in name for name in edges) else ""
    return (
        f"to unload this edge, use {' or '.join(remedies) or 'a relief'} of {amount}; analyse again with several "
        f"starts and amounts: a short relief presses where it starts, and other edges take the load of this one{mating}"
    )


def _edge_findings(result: CycleNumbers) -> dict[int, str]:
    """Sentences on the largest pressure at an edge of pairs that carry a thousandth of the torque, by torques.

    An edge pressure that the peak pressure exceeds is none. Where the pressure lies at the same edges under several
    torques, one sentence has the largest of them, and the range of the others.
    """
    alike: dict[tuple[str, ...], list[tuple[int, int, int]]] = {}
    for torque, place in highest_edges(result).items():
        at = torque, *place
        names = (name for name, one in zip(EDGES, _edges_of_pressure(result, *at), strict=True) if one)
        alike.setdefault((*names, str(bool(result.edge_is_rounded[at]))), []).append(at)
    sentences = {}
    for (*edges, _), places in alike.items():
        at = max(places, key=lambda one: float(result.edge_pressure[one]))
        others = [one for one in places if one != at]
        sentences[at[0]] = _edge_finding(result, at, edges) + _of_other_torques(result, others)
    return sentences


def _of_other_torques(result: CycleNumbers, places: Sequence[tuple[int, int, int]]) -> str:
    """Torques under which the largest pressure lies at the same edges, and the pressures there, in words."""
    if not places:
        return ""
    torques = sorted(1e-3 * float(result.torque[at[0]]) for at in places)
    pressures = sorted(float(result.edge_pressure[at]) for at in places)
    if len(places) == 1:
        return f"; under {plain(torques[0], 6)} N m the pressure at this edge is {plain(pressures[0])} MPa"
    return (
        f"; under {len(places)} other torques from {plain(torques[0], 6)} to {plain(torques[-1], 6)} N m the "
        f"pressure at this edge is {plain(pressures[0])} to {plain(pressures[-1])} MPa"
    )


def _edge_finding(result: CycleNumbers, at: tuple[int, int, int], edges: Sequence[str]) -> str:
    """A pressure at edges: where it lies, how far to trust it, and what would remove it."""
    torque = at[0]
    cap, accuracy = float(result.max_pressure), accuracy_of_edge(result, at)
    elastic = "elastic" if math.isnan(cap) else f"capped at {plain(cap, 6)} MPa"
    share = f"{plain(100.0 * result.load_share[at], 3)} % of the torque"
    largest = float(np.nanmax(result.edge_pressure[torque]))
    beyond = (
        f"; the largest edge pressure, {plain(largest)} MPa, is on a pair with less than {LEAST_SHARE:.1%} of the "
        "torque"
        if largest > result.edge_pressure[at]
        else ""
    )
    return (
        f"edge pressure {plain(result.edge_pressure[at])} MPa at {plain(1e-3 * result.torque[torque], 6)} N m on "
        f"{' + '.join(edges)} (pinion diameter {plain(2.0 * result.edge_radius[at])} mm, axial "
        f"{plain(result.edge_axial[at])} mm), where the pair carries {share}; this pressure is {elastic} and "
        f"{accuracy}; {_remedy(result, at, edges)}{beyond}"
    )


def peak_finding(result: CycleNumbers, torque: int) -> str:
    """A sentence on a peak pressure of slices at an edge in a pair that carries less than a tenth of the torque.

    Beside it stands the peak pressure of pairs that carry more. Empty: the peak pressure lies elsewhere.
    """
    place = result.peak_contact(torque)
    if place is None or not result.on_edge[torque][place] or result.load_share[torque][place] >= SMALL_SHARE:
        return ""
    others = np.where(result.load_share[torque] >= SMALL_SHARE, result.peak_pressure[torque], math.nan)
    most = (
        f"; on pairs that carry a tenth of the torque or more the peak pressure is {plain(np.nanmax(others))} MPa"
        if (others > 0.0).any()
        else ""
    )
    pressure, applied = result.peak_pressure[torque][place], plain(1e-3 * result.torque[torque], 6)
    return (
        f"the peak pressure {plain(pressure)} MPa at {applied} N m lies in slices at an edge, on a pair that "
        f"carries {plain(100.0 * result.load_share[torque][place], 3)} % of the torque{most}"
    )
