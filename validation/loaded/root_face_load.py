"""What an uneven load along the face does to the root stress: finite elements beside ISO 6336-3.

Spur pinion 25 of 25/37, 20 mm wide. The largest root tension under an uneven load stands over that under the same force
spread evenly, and beside it K_Fbeta = K_Hbeta^N_F, K_Hbeta the largest line load over its mean. Twice:

- at the highest point of single contact, under the line load of the kept pair of finite elements whose pinion is
  crowned by 10 um, and under one that rises from nothing at one end of the face, as of a misaligned pair: kept rings of
  finite elements have both ratios, and K_Fbeta of both loads is a closed form;
- at the pitch point under 100 N m, with the loads of the pairs of the package themselves.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import FlankLine, RootStress, tooth_compliance
from loaded_tca.errors import AccuracyWarning
from loaded_tca.loaded.cycle import AllPairsCycle, solve_cycles
from loaded_tca.reference import iso6336_3
from loaded_tca.scene import parse_scene
from loaded_tca.unloaded import trace_teeth
from validation.calculix import ring_solved
from validation.calculix.case import FACE_WIDTH
from validation.calculix.comparison import GRID, NEIGHBOURS, SCENE
from validation.calculix.pairs_in_space import CROWNING, read_in_space
from validation.calculix.tables import CROWNED_FILE
from validation.calculix.tooth_form import ToothForm
from validation.loaded.root_stress_space import SOURCE as RINGS
from validation.loaded.root_stress_space import model_of, read_rings
from validation.table import Row

CASE = "root stress under an uneven load"
ISO, SOLVED = "ISO 6336-3, K_Fbeta", "finite elements in space (ring_solved)"
TORQUE = 100.0
"""Of the pairs [N m]."""
SINGLE_CONTACT = 37.978
"""Radius of the highest point of single contact [mm]."""
PAIRS: dict[str, dict[str, object]] = {
    "crowned 10 um": CROWNING,
    "misaligned 10 um": {"mounting.misalignment_um": 10.0},
}
OF_RATIO, RING = 0.007, 0.007
"""Of the ring solved here, whose mesh leaves 0.1 % in the ratio, and of that of CalculiX."""
OF_FACTOR = 4e-4
"""The mean of the kept line load of layers is that of the force to 0.02 %."""
STRIPS = 30
"""Of the face, between which ISO's largest line load is sought."""


@dataclass(frozen=True)
class Uneven:
    """Root tension of tooth 0 of the pinion.

    Attributes
    ----------
    along : (n,) array [mm]
        Along the face.
    tension, even : (n,) array [MPa]
        Largest of every section under the load, and under the same force spread evenly.
    contact_factor : float
        K_Hbeta of the load.
    """

    along: Array
    tension: Array
    even: Array
    contact_factor: float

    @property
    def ratio(self) -> float:
        """Largest tension over that under an even load."""
        return float(self.tension.max() / self.even.max())

    @property
    def iso_factor(self) -> float:
        """K_Fbeta."""
        height = 2.25 * 3.0  # of the tooth, h_aP + h_fP modules
        return float(iso6336_3.face_load_factor(self.contact_factor, height / FACE_WIDTH))


def under_line(roots: RootStress, line: FlankLine, forces: Array, ends: Array) -> Uneven:
    """Tension under forces (m,) [N] on parts of the face between ends (m + 1,) [mm]."""
    spread = forces.sum() * np.diff(ends) / np.ptp(ends)
    tension, even = (roots.stress(0, [(line, load)])[0].max(axis=0) for load in (forces, spread))
    strips = np.linspace(ends[0], ends[-1], STRIPS + 1)
    carried = np.diff(np.interp(strips, ends, np.append(0.0, np.cumsum(forces))))
    along = np.linspace(-0.5, 0.5, len(tension)) * FACE_WIDTH
    return Uneven(along, tension, even, float(carried.max() / carried.mean()))


def at_single_contact(line_load: Array, heights: Array) -> Uneven:
    """Load given at heights (m,) of the face, on the highest points of single contact; K_Hbeta from its very peak."""
    ends = np.linspace(-0.5 * FACE_WIDTH, 0.5 * FACE_WIDTH, 401)
    middle = 0.5 * (ends[1:] + ends[:-1])
    load = np.interp(middle, heights, line_load)
    line = FlankLine(0, np.full(len(middle), SINGLE_CONTACT), middle)
    found = under_line(model_of("spur"), line, load * np.diff(ends), ends)
    return Uneven(found.along, found.tension, found.even, float(np.max(line_load) / load.mean()))


def of_the_crowned_pair() -> Uneven | None:
    """Under the kept line load of the crowned pair of finite elements."""
    kept = read_in_space(CROWNED_FILE)
    if kept is None:
        return None
    half = (np.arange(len(kept.line_load)) + 0.5) * 0.5 * FACE_WIDTH / len(kept.line_load)
    upper = np.append(kept.line_load, max(2.0 * kept.line_load[-1] - kept.line_load[-2], 0.0))
    heights = np.append(half, 0.5 * FACE_WIDTH)
    return at_single_contact(
        np.concatenate([upper[::-1], [kept.peak_line_load], upper]), np.concatenate([-heights[::-1], [0.0], heights])
    )


def of_a_misaligned_pair() -> Uneven:
    """Under a line load that rises from nothing at one end of the face."""
    return at_single_contact(np.array([0.0, 2.0]), np.array([-0.5, 0.5]) * FACE_WIDTH)


def of_the_pair(changes: dict[str, object]) -> Uneven:
    """At the pitch point under the load of the package's own contact of tooth pair 0."""
    scene = parse_scene(SCENE.format(face_width=FACE_WIDTH)).with_changes(changes)
    pair = scene.pair()
    bending = tooth_compliance(pair, neighbours=NEIGHBOURS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the load ends with the face
        carried = solve_cycles(
            [AllPairsCycle(pair, trace_teeth(pair, np.zeros(1)), np.array([1e3 * TORQUE]), GRID, bending)]
        )[0]
    loaded = carried.contacts[0][0][carried.pairs.tolist().index(0)]
    assert loaded is not None
    line, _ = bending.lines(0, loaded.separation)
    step_x, step = loaded.separation.spacing
    forces = loaded.solution.pressure.sum(axis=0) * step_x * step
    low, high = (line.z + sign * 0.5 * abs(line.z[1] - line.z[0]) for sign in (-1.0, 1.0))
    ends = np.linspace(-0.5 * FACE_WIDTH, 0.5 * FACE_WIDTH, 201)
    order = np.argsort(low)
    total = np.append(0.0, np.cumsum(forces[order]))
    on_face = np.diff(np.interp(ends, np.append(low[order], high[order][-1]), total))
    middle = 0.5 * (ends[1:] + ends[:-1])
    radius = np.interp(middle, line.z[order], line.rho[order])
    return under_line(model_of("spur"), FlankLine(0, radius, middle), on_face, ends)


def rows() -> list[Row]:
    """Ratios and factors of all loads."""
    return [*rows_of_pairs(), *short_rows()]


def short_rows() -> list[Row]:
    """Those with a verdict: ratios and factors under the kept line loads."""
    found: list[Row] = []
    for name, one in (("crowned", of_the_crowned_pair()), ("misaligned", of_a_misaligned_pair())):
        if one is not None:
            found += rows_of(name, one)
    kept = read_rings()
    if kept:
        largest = {load: max(float(row["tension_MPa"]) for row in kept["spur", load]) for load in ("even", "uneven")}
        words = f"{LINES['misaligned']}: largest tension over that of an even load"
        found.append(Row(CASE, RINGS, words, largest["uneven"] / largest["even"], of_a_misaligned_pair().ratio, RING))
    return found


LINES = {"crowned": "line load of the crowned pair, HPSTC", "misaligned": "line load 0 to twice the mean, HPSTC"}


def rows_of(name: str, one: Uneven) -> Iterator[Row]:
    """Ratio and K_Fbeta of a load at the highest point of single contact."""
    kept = ring_solved.read()
    words, load = LINES[name], {"crowned": ring_solved.CROWNED, "misaligned": ring_solved.UNEVEN}[name]
    ratio = kept[load] / kept[ring_solved.EVEN]
    yield Row(CASE, SOLVED, f"{words}: largest tension over that of an even load", ratio, one.ratio, OF_RATIO)
    factor = largest_over_mean(name) ** (9.0 / 13.0)  # N_F of b/h = 3, the least one of the standard
    yield Row(CASE, ISO, f"{words}: K_Fbeta", factor, one.iso_factor, OF_FACTOR)


def largest_over_mean(name: str) -> float:
    """K_Hbeta of a load: twice the mean, and the kept peak over the torque on base radius and face."""
    pair = read_in_space(CROWNED_FILE)
    if name == "misaligned" or pair is None:
        return 2.0
    return pair.peak_line_load / (1e3 * TORQUE / ToothForm(25).base_radius / FACE_WIDTH)


def rows_of_pairs() -> Iterator[Row]:
    """Ratio of pairs of the package beside K_Fbeta of the same load."""
    for name, changes in PAIRS.items():
        one = of_the_pair(changes)
        words = f"pair {name}, pitch point: largest tension over that of an even load"
        yield Row(CASE, ISO, words, one.iso_factor, one.ratio, None, note=f"K_Hbeta {one.contact_factor:.3f}")
