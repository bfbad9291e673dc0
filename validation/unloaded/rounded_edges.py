"""First touch of flanks with rounded edges: a thousand random misaligned positions, certified, and what they cost.

Pairs of spur, helical and spiral bevel gears with random crownings, mounting errors and radii from 0.01 mm to 0.3
normal modules; random positions within a pitch of the pitch point, so that contacts lie on the flanks, on arcs of tips
and face ends, and on several arcs. A contact is certified if no point of either flank lies higher than it: a grid and
rows along the edges, eleven over each arc, far denser than the scan of the search. Times are of the same positions with
sharp and with rounded edges, one after the other, the median over the pairs; those of pairs all of whose contacts lie
on arcs besides.

Run from the root of the repository: ``python -m validation.unloaded.rounded_edges``.
"""

import math
from statistics import median

import numpy as np
from numpy.typing import NDArray

from loaded_tca.errors import ConvergenceError
from loaded_tca.flanks import Flank, FlankModifications
from loaded_tca.flanks.rounding import EdgeRounding, RoundedFlank
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.scan import on_arcs
from loaded_tca.unloaded.search import FirstTouch, first_touch
from validation.table import Row, render
from validation.unloaded.random_starts import RUNS, timed

Array = NDArray[np.float64]
PAIRS, POSITIONS = 100, 10
ABOVE = 1e-12
"""Height above a contact, over r_b2, that is rounding."""
OVER_ARC, ALONG = 11, 301
"""Rows of points over each arc, and points of each."""
CASE, SOURCE = "rounded edges, first touch", "definition"


def random_pair(rng: np.random.Generator) -> GearPair:
    """A misaligned pair with random crownings and sharp edges; one of five is a spiral bevel pair."""
    changes = tuple(
        FlankModifications(lead_crowning=rng.uniform(0.0, 0.02), profile_crowning=rng.uniform(0.0, 0.02))
        for _ in range(2)
    )
    driving, sense = rng.choice(["pinion", "wheel"]), rng.choice(["positive", "negative"])
    tilt = np.radians(rng.uniform(-0.5, 0.5, 2))
    if rng.random() < 0.2:
        mesh = bevel_mesh(
            (20, 40), outer_module=4.0, face_width=20.0, spiral_angle=math.radians(rng.uniform(0.0, 35.0))
        )
        bevel = BevelMounting(offset=rng.uniform(-0.1, 0.1), shaft_angle_error=tilt[0])
        return bevel_pair(mesh, modifications=changes, mounting=bevel, driving=driving, sense=sense)
    helix = math.radians(rng.choice([0.0, 12.0, 25.0]))
    gears = [CylindricalGear(z, 3.0, 25.0, helix_angle=sign * helix) for z, sign in ((34, 1.0), (57, -1.0))]
    mounting = Mounting(tilt[0], tilt[1], rng.uniform(-0.1, 0.1), rng.uniform(-2.0, 2.0))
    mesh = CylindricalMesh(*gears)
    return cylindrical_pair(mesh, modifications=changes, mounting=mounting, driving=driving, sense=sense)


def random_radii(rng: np.random.Generator, module: float) -> list[EdgeRounding]:
    """Radii of both gears, evenly in their logarithm."""
    radii = np.exp(rng.uniform(math.log(0.01), math.log(0.3 * module), (2, 2)))
    return [EdgeRounding(*one) for one in radii.tolist()]


def dense_points(flank: Flank) -> tuple[Array, Array]:
    """Points of a flank: a grid, and rows over each arc."""
    found = [tuple(part.ravel() for part in flank.grid(60, 60))]
    if isinstance(flank, RoundedFlank):
        lines = flank.grid(2, ALONG), flank.grid(ALONG, 2)
        edges = [np.concatenate([line[k].ravel() for line in lines]) for k in (0, 1)]
        begin = flank.off_arcs(*edges)
        for share in np.linspace(0.0, 1.0, OVER_ARC):
            found.append(tuple(edge + share * (one - edge) for edge, one in zip(edges, begin, strict=True)))
    rho, z = (np.concatenate([part[k] for part in found]) for k in (0, 1))
    return rho, z


def highest_above(pair: GearPair, angles: Array, touch: FirstTouch) -> Array:
    """How far the highest of the dense points lies above each first touch [mm]; inf where one was missed."""
    field, (rho, z) = EaseOff(pair), dense_points(pair.pinion.flank)
    above = np.full(len(angles), -np.inf)
    for row, angle in enumerate(angles):
        value, edges = field.heights(np.full(rho.shape, angle), rho, z)
        highest = value[edges.min(axis=-1) >= 0.0].max(initial=-np.inf)
        if np.isfinite(highest):
            above[row] = highest - touch.value[row]
    return above


def rows() -> list[Row]:
    """Failures, the worst point above a contact, and the cost."""
    rng = np.random.default_rng(20240607)
    failures, uncertified, worst, count, on = 0, 0, -math.inf, 0, 0
    times: list[tuple[float, float]] = []
    on_arcs_alone: list[tuple[float, float]] = []
    for _ in range(PAIRS):
        sharp = random_pair(rng)
        rounded = sharp.rounded(*random_radii(rng, sharp.module))
        angles = rng.uniform(-1.0, 1.0, POSITIONS) * sharp.pitch
        _, before = timed(lambda pair=sharp, phi1=angles: first_touch(pair, phi1), RUNS)
        try:
            touch, after = timed(lambda pair=rounded, phi1=angles: first_touch(pair, phi1), RUNS)
        except ConvergenceError:
            failures += POSITIONS
            continue
        count += int(touch.in_contact.sum())
        above = highest_above(rounded, angles, touch) / rounded.base_radii[1]
        uncertified += int((above > ABOVE).sum())
        worst = max(worst, float(above.max()))
        there = np.flatnonzero(touch.in_contact)
        arcs = on_arcs(EaseOff(rounded, touch.beyond[there]), angles[there], touch.rho[there], touch.z[there])
        on += int(arcs.any(axis=-1).sum())
        times.append((before, after))
        if there.size and arcs.any(axis=-1).all():
            on_arcs_alone.append((before, after))
    slower, slowest = (median(b for _, b in part) / median(a for a, _ in part) for part in (times, on_arcs_alone))
    told = f"{count} of {PAIRS * POSITIONS} positions in contact, {on} of them on arcs"
    return [
        Row(CASE, SOURCE, "positions without a first touch that converged", 0.0, failures, 0.0, note=told),
        Row(CASE, SOURCE, "positions at which a point lies above the contact", 0.0, uncertified, 0.0, note=told),
        Row(CASE, SOURCE, "highest point above a contact, over r_b2", 0.0, max(worst, 0.0), ABOVE),
        _cost("time over that with sharp edges", slower, len(times)),
        _cost("the same, every contact on an arc", slowest, len(on_arcs_alone)),
    ]


def _cost(quantity: str, ratio: float, pairs: int) -> Row:
    note = f"medians of {pairs} pairs, {POSITIONS} positions each"
    return Row(CASE, "this machine", quantity, 1.0, ratio, None, note=note)


if __name__ == "__main__":
    table = rows()
    print(render(table))
    print("\n".join(row.note for row in table if row.note))
